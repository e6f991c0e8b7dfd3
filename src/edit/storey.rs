//! Starting the next storey as a copy of the one below.

use std::sync::Arc;

use super::calibration::{normalised_rad, transformed};
use super::{EditError, checked_position, fail, set_backdrop};
use crate::geometry::{Point, Vector};
use crate::plan::{Backdrop, Guide, GuideAxis, Meta, Opening, Plan, Room};

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

/// Two points of a plan are taken as one below this distance in metres.
const LEAST_APART_M: f64 = 0.05;

/// A plan laid over the storey below: moved so that the first of two points comes to lie on its own of that storey, and
/// turned so that the second lies in the direction of its own. Nothing is scaled. The backdrop comes along, and so do
/// guides where the plan is not turned.
///
/// # Errors
/// When two of the points are one, or the plan would leave the drawing area.
pub fn laid_over(plan: &Plan, here: [Point; 2], below: [Point; 2]) -> Result<Plan, EditError> {
    let ([a, b], [p, q]) = (here, below);
    if a.distance(b) < LEAST_APART_M || p.distance(q) < LEAST_APART_M {
        return fail("the two points of a storey have to be apart");
    }
    let angle = |v: Vector| v.y.atan2(v.x);
    let turn_rad = normalised_rad(angle(q - p) - angle(b - a));
    let by = p - a;
    let mut next = transformed(plan, a, 1.0, turn_rad, by)?;
    if let Some(backdrop) = plan.backdrop() {
        let origin = checked_position(a + (backdrop.origin - a).rotated(turn_rad) + by)?;
        let rotation_rad = normalised_rad(backdrop.rotation_rad + turn_rad);
        next = set_backdrop(&next, Some(Backdrop { origin, rotation_rad, ..backdrop.clone() }));
    }
    // A guide runs along an axis: turned by any angle it would not.
    if turn_rad == 0.0 {
        let moved = |guide: &Guide| {
            let along = if guide.axis == GuideAxis::Horizontal { by.y } else { by.x };
            Guide::new(guide.axis, guide.at_m + along)
        };
        next = next.with_guides(plan.guides().iter().map(moved).collect::<Vec<_>>());
    }
    Ok(next)
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

    #[test]
    fn a_plan_laid_over_another_keeps_its_lengths_and_meets_both_points() {
        let plans = crate::store::bundled_plans().unwrap();
        for (_, plan) in &plans {
            let corner = |at: usize| plan.corners().nth(at).unwrap().1.position;
            let (a, b) = (corner(0), corner(plan.corners().len() - 1));
            let p = Point::new(100.0, -20.0);
            let q = p + Vector::new(0.6, 0.8) * a.distance(b);
            let next = laid_over(plan, [a, b], [p, q]).unwrap();
            assert!(next.violations().is_empty());
            let moved = |at: usize| next.corners().nth(at).unwrap().1.position;
            assert!(moved(0).distance(p) < 1e-3 && moved(plan.corners().len() - 1).distance(q) < 1e-3);
            let area =
                |plan: &Plan| crate::topology::RoomShapes::new(plan).all().iter().map(|it| it.area_m2()).sum::<f64>();
            assert!((area(plan) - area(&next)).abs() < 0.01 * area(plan));
            assert!(laid_over(plan, [a, a], [p, q]).is_err());
        }
    }
}
