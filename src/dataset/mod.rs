//! Rows of labelled rooms, collected from many plans.

mod collection;
pub mod csv;
pub mod folds;
mod network;
mod statistics;
pub mod table;

use std::collections::BTreeMap;

pub use collection::{Collection, RoomPlace};
pub use network::{Form, NetworkDoor, NetworkRoom, RoomNetwork};
pub use statistics::{LabelStatistics, Moments, Statistics};

use crate::features::{Features, NeighbourLabels};
use crate::labels::{Label, Schemes, Typology};
use crate::plan::{Plan, RoomId};

/// One labelled room of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the plan it stands in.
    pub plan: String,
    /// Its building: the unit that cross-validation must never split.
    pub building: String,
    pub typology: Option<Typology>,
    /// What the room is called, see [`room_keys`].
    pub room: String,
    pub function: String,
    /// The true label.
    pub label: Label,
    pub features: Features,
}

/// Why rooms of plans did not become rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Rooms whose function the scheme leaves blank.
    pub not_classified: usize,
    /// Rooms without a label and without a function.
    pub without_function: usize,
    /// Rooms that enclose no area.
    pub without_area: usize,
    /// Functions that the plan's scheme does not know, by typology (empty when unknown) and
    /// function as written, with their number of rooms.
    pub unknown_functions: BTreeMap<(String, String), usize>,
}

impl LeftOut {
    /// Counts what another plan left out.
    pub fn add(&mut self, other: &Self) {
        self.not_classified += other.not_classified;
        self.without_function += other.without_function;
        self.without_area += other.without_area;
        for (function, rooms) in &other.unknown_functions {
            *self.unknown_functions.entry(function.clone()).or_default() += rooms;
        }
    }

    /// Number of rooms left out, whatever the reason.
    pub fn total(&self) -> usize {
        let unknown: usize = self.unknown_functions.values().sum();
        self.not_classified + self.without_function + self.without_area + unknown
    }
}

/// The labelled rooms of a plan as rows, in the order of [`room_keys`]; what is left out is counted
/// in `left_out`.
pub fn rows(plan: &Plan, schemes: &Schemes, neighbours: NeighbourLabels, left_out: &mut LeftOut) -> Vec<Row> {
    let network = RoomNetwork::new(plan, schemes);
    left_out.add(&network.left_out);
    let seen = network.seen_labels(&network.known_labels(), neighbours);
    network.rows_seeing(&seen).map(|row| Row { building: plan.meta().building.clone(), ..row }).collect()
}

/// What to call each room of a plan in a table: its name where no other room has the same, else what
/// it is called in its source, else its id. Sorted so that 'Room 2' comes before 'Room 10'.
pub fn room_keys(plan: &Plan) -> Vec<(RoomId, String)> {
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, room) in plan.rooms() {
        *names.entry(room.name.as_str()).or_default() += 1;
    }
    let mut keys: Vec<(RoomId, String)> = plan
        .rooms()
        .map(|(id, room)| {
            let key = if !room.name.is_empty() && names.get(room.name.as_str()) == Some(&1) {
                room.name.clone()
            } else if room.source_id.is_empty() {
                id.to_string()
            } else {
                room.source_id.clone()
            };
            (id, key)
        })
        .collect();
    keys.sort_by_cached_key(|(id, key)| (natural_key(key), *id));
    keys
}

/// A key by which texts sort as people sort them: runs of digits compare as numbers.
fn natural_key(text: &str) -> Vec<(String, u64)> {
    let mut parts: Vec<(String, u64)> = Vec::new();
    let mut rest = text;
    while !rest.is_empty() {
        let digits_from = rest.find(|c: char| c.is_ascii_digit()).unwrap_or(rest.len());
        let (word, tail) = rest.split_at(digits_from);
        let digits_to = tail.find(|c: char| !c.is_ascii_digit()).unwrap_or(tail.len());
        let (digits, after) = tail.split_at(digits_to);
        parts.push((word.to_owned(), digits.parse().unwrap_or(u64::MAX)));
        rest = after;
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::natural_key;

    #[test]
    fn numbers_sort_as_numbers() {
        let mut keys = ["R10", "R2", "R1a", "R1", "Hall", "99999999999999999999999", "2.10", "2.9"];
        keys.sort_by_cached_key(|key| natural_key(key));
        assert_eq!(keys, ["2.9", "2.10", "99999999999999999999999", "Hall", "R1", "R1a", "R2", "R10"]);
    }
}
