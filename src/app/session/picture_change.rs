//! What can be done with the picture under the plan.

use crate::edit::DrawingMoves;
use crate::edit::{self, EditError};
use crate::geometry::Point;
use crate::plan::{Measurement, Plan};

/// What a picture is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureUse {
    /// To lie under the plan, in place of one that does.
    Add,
    /// To be the one that the plan asks for.
    Relink,
}

/// A change of the picture that the drawing may follow.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PictureChange {
    /// The lengths its scale follows from.
    Measurements(Vec<Measurement>),
    /// A turn about a point of the plan, counter-clockwise.
    Turn { about: Point, angle_rad: f64 },
}

impl PictureChange {
    /// What it is called in the history.
    pub(crate) const fn title(&self) -> &'static str {
        match self {
            Self::Measurements(_) => "Set scale",
            Self::Turn { .. } => "Turn picture",
        }
    }

    pub(crate) fn apply(&self, plan: &Plan, drawing: DrawingMoves) -> Result<Plan, EditError> {
        match self {
            Self::Measurements(measurements) => edit::set_measurements(plan, measurements.clone(), drawing),
            Self::Turn { about, angle_rad } => edit::turn_picture(plan, *about, *angle_rad, drawing),
        }
    }
}
