//! Rows of labelled rooms, collected from many plans.

mod collection;
pub mod csv;
pub mod folds;
mod network;
pub mod sets;
mod statistics;
pub mod table;

pub use collection::{Collection, RoomPlace};
pub use network::{Form, NetworkDoor, NetworkRoom, RoomNetwork};
pub use statistics::{LabelStatistics, Moments, Statistics};

use crate::features::{Features, NeighbourLabels};
use crate::labels::{Label, Schemes, Typology};
use crate::plan::Plan;
use std::collections::BTreeMap;

/// One labelled room of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the plan it stands in.
    pub plan: String,
    /// Its building: the unit that cross-validation must never split.
    pub building: String,
    pub typology: Option<Typology>,
    /// What the room is called, see `room_keys`.
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
    /// Adds the counts of another plan.
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

/// The labelled rooms of a plan as rows, in the order of `room_keys`; omissions are counted in
/// `left_out`.
pub fn rows(plan: &Plan, schemes: &Schemes, neighbours: NeighbourLabels, left_out: &mut LeftOut) -> Vec<Row> {
    let network = RoomNetwork::new(plan, schemes);
    left_out.add(&network.left_out);
    let seen = network.seen_labels(&network.known_labels(), neighbours);
    network.rows_seeing(&seen).map(|row| Row { building: plan.meta().building.clone(), ..row }).collect()
}
