//! Starting the next storey as a copy of the one below.

use std::sync::Arc;

use crate::plan::{Meta, Opening, Plan, Room};

/// What a copied storey keeps of the rooms besides their shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Names, functions, labels and notes.
    All,
    /// Functions and labels: names are often numbers, which differ from storey to storey.
    Functions,
    /// Nothing: rooms without names and functions.
    Outlines,
}

impl Keep {
    /// Words for commands, with titles.
    pub const WORDS: &'static [(&'static str, &'static str)] = &[
        ("functions", "Functions and labels, no names"),
        ("all", "Names, functions and labels"),
        ("outlines", "Walls and outlines only"),
    ];
}

/// A plan of another storey of the same building with the same walls, rooms, openings and guides, but
/// without the backdrop and links to an imported file.
pub fn copied(plan: &Plan, storey: &str, keep: Keep) -> Plan {
    let mut next = plan.clone();
    let meta = plan.meta();
    let storey = storey.trim();
    let base = meta.building_or_name();
    let name = if base.is_empty() { storey.to_owned() } else { format!("{base}, {storey}") };
    let building = base.to_owned();
    next.meta = Arc::new(Meta { name, building, storey: storey.to_owned(), extra: None, ..meta.clone() });
    next.backdrop = None;
    next.extra = None;
    for (&id, room) in &plan.rooms {
        let mut room = Room { source_id: String::new(), extra: None, ..room.as_ref().clone() };
        if keep != Keep::All {
            room.name.clear();
            room.note.clear();
        }
        if keep == Keep::Outlines {
            room.function.clear();
            room.label = None;
        }
        next.rooms.insert(id, Arc::new(room));
    }
    for (&id, opening) in &plan.openings {
        let opening = Opening { source_id: String::new(), extra: None, ..opening.as_ref().clone() };
        next.openings.insert(id, Arc::new(opening));
    }
    next
}

#[cfg(test)]
mod tests {
    use crate::edit::storey::*;

    #[test]
    fn a_copied_storey_has_the_same_walls_and_no_names() {
        let plans = crate::store::bundled_plans().unwrap();
        for (_, plan) in &plans {
            let next = copied(plan, " 1 ", Keep::Functions);
            assert!(next.violations().is_empty());
            assert_eq!(next.meta().storey, "1");
            assert!(!next.meta().building.is_empty() && next.meta().name.ends_with(", 1"));
            assert_eq!(next.walls, plan.walls);
            assert!(next.rooms().zip(plan.rooms()).all(|((a, next), (b, room))| {
                a == b && next.function == room.function && next.outer == room.outer && next.name.is_empty()
            }));
            let all = copied(plan, "1", Keep::All);
            assert!(all.rooms().zip(plan.rooms()).all(|((_, next), (_, room))| next.name == room.name));
            let bare = copied(plan, "1", Keep::Outlines);
            assert!(bare.rooms().all(|(_, room)| room.function.is_empty() && room.label.is_none()));
        }
    }
}
