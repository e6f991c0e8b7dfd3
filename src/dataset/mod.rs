//! Rows of labelled rooms, collected from many plans.

use crate::features::Features;
use crate::labels::{Label, Typology};

/// One labelled room of a dataset.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the plan it stands in.
    pub plan: String,
    /// Its building: the unit that cross-validation must never split.
    pub building: String,
    pub typology: Option<Typology>,
    /// The room's id or name in its plan.
    pub room: String,
    pub function: String,
    /// The true label.
    pub label: Label,
    pub features: Features,
}
