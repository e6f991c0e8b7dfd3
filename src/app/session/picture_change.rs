//! Changes to the backdrop.

use crate::edit::DrawingMoves;
use crate::edit::{self, EditError};
use crate::geometry::Point;
use crate::plan::{Measurement, Plan};

/// The purpose of loading a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureUse {
    /// As the plan's backdrop, replacing any present.
    Add,
    /// As the missing picture of the plan's backdrop.
    Relink,
}

/// A change of the backdrop that the drawing may follow.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PictureChange {
    /// The measurements that determine its scale.
    Measurements(Vec<Measurement>),
    /// A counter-clockwise rotation about a point of the plan.
    Turn { about: Point, angle_rad: f64 },
}

impl PictureChange {
    /// Its title in the history.
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
