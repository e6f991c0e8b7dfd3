//! Rows of labelled rooms, collected from many plans.

pub mod changes;
mod collection;
pub mod csv;
pub mod edges;
pub mod fingerprint;
pub mod flats;
pub mod fold_table;
pub mod folds;
mod network;
pub mod repeats;
mod schema;
pub mod sets;
mod statistics;
pub mod table;

pub use collection::{Collection, RoomPlace};
pub use network::{Flats, Form, Measured, NetworkDoor, NetworkRoom, RoomNetwork, places_among};
pub use schema::schema;
pub use statistics::{LabelStatistics, Moments, Statistics};

use crate::features::{Features, NeighbourLabels};
use crate::labels::{Label, Schemes, Typology};
use crate::plan::Plan;
use std::collections::BTreeMap;

/// One labelled room of a dataset. With `file` and `id` it is found again; names may repeat.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The file it was read from, as it was named; empty where unknown.
    pub file: String,
    /// The room's id in its plan; with the file, the row's key. Empty where unknown.
    pub id: String,
    /// Name of the plan it stands in.
    pub plan: String,
    /// Its building: the unit that cross-validation must never split.
    pub building: String,
    pub typology: Option<Typology>,
    /// Which storey of the building; empty where unknown.
    pub storey: String,
    /// What the room is called, see `room_keys`.
    pub room: String,
    pub function: String,
    /// The true label.
    pub label: Label,
    /// Who gave the label: a word of [`crate::plan::LabelOrigin`], or [`BY_SCHEME`]; empty where unknown.
    pub label_origin: String,
    /// The fold it is tested in, from 0, where folds were given.
    pub fold: Option<usize>,
    /// What folds never split: the building, and with it the buildings of its near twins. Empty: the building alone.
    pub group: String,
    pub features: Features,
}

/// The origin of a label that follows from the room's function.
pub const BY_SCHEME: &str = "scheme";

impl Row {
    /// A row of which nothing else is known.
    pub fn new(label: Label, features: Features) -> Self {
        Self {
            file: String::new(),
            id: String::new(),
            plan: String::new(),
            building: String::new(),
            typology: None,
            storey: String::new(),
            room: String::new(),
            function: String::new(),
            label,
            label_origin: String::new(),
            fold: None,
            group: String::new(),
            features,
        }
    }
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
