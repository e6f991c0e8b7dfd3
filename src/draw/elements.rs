//! The parts of a drawing, before zoom and colours.

use std::cmp::Ordering;

use crate::features::RoomStatus;
use crate::geometry::{Bounds, Point};
use crate::labels::{Label, normalised_function};
use crate::plan::RoomId;

/// A room as drawn.
pub(super) struct RoomDrawing {
    pub id: RoomId,
    pub name: String,
    pub function: String,
    pub status: RoomStatus,
    /// The predicted label, if a classifier was run.
    pub predicted: Option<Label>,
    /// The room without the rim along its boundary, as pieces with their holes: only for a room whose
    /// known label differs from the predicted one.
    pub within_rim: Vec<(Vec<Point>, Vec<Vec<Point>>)>,
    /// Of the boundary.
    pub area_m2: f64,
    /// Between wall faces: what is written in it.
    pub clear_m2: f64,
    /// Whether both differ: walls stand on the boundary or inside.
    pub has_walls: bool,
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
    pub bounds: Bounds,
    /// The middle of the room where it is widest: the place for its name and its graph node.
    pub centre: Point,
    /// Where its texts are placed by hand.
    pub text_at: Option<Point>,
    /// Indices of the rooms painted over it: smaller ones that overlap its bounding box.
    pub above: Vec<usize>,
    /// Indices of the openings that overlap its bounding box.
    pub openings: Vec<usize>,
}

impl RoomDrawing {
    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// Its status if the prediction were its label.
    pub fn predicted_status(&self) -> RoomStatus {
        match (self.status, self.predicted) {
            (RoomStatus::NotClassified, _) => RoomStatus::NotClassified,
            (_, Some(label)) => RoomStatus::Labelled(label),
            (_, None) => RoomStatus::Unlabelled,
        }
    }

    /// The known label, if the prediction differs.
    pub fn missed_label(&self) -> Option<Label> {
        self.status.label().filter(|known| self.predicted.is_some_and(|said| said != *known))
    }

    /// Whether it is a lift, which has sliding doors.
    pub fn is_lift(&self) -> bool {
        normalised_function(&self.function).split(' ').any(|word| matches!(word, "lift" | "elevator"))
    }

    /// Whether it is open to the sky and so not part of the building's mass: judged by its function, and
    /// only if the scheme leaves that blank.
    pub fn is_open_air(&self) -> bool {
        self.status == RoomStatus::NotClassified
            && OPEN_AIR.iter().any(|word| normalised_function(&self.function).contains(word))
    }
}

/// Words in the functions of open-air spaces.
const OPEN_AIR: [&str; 12] = [
    "balcony", "terrace", "loggia", "veranda", "patio", "garden", "yard", "deck", "outdoor", "outside", "court",
    "porch",
];

/// Painting order: large rooms first, so that one inside or over another is visible.
pub(super) fn painting_order(rooms: &[RoomDrawing], one: usize, other: usize) -> Ordering {
    rooms[other].area_m2.total_cmp(&rooms[one].area_m2).then(one.cmp(&other))
}

/// A connected piece of wall.
pub(super) struct WallDrawing {
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
}

/// A connection from room to room, or to the outside, through an opening.
pub(super) struct GraphEdge {
    pub from: Point,
    pub through: Point,
    /// The other room's centre; for the outside, the direction.
    pub to: Result<Point, crate::geometry::Vector>,
}

/// Radius of a graph node in pixels.
pub(super) const NODE_RADIUS_PX: f64 = 5.0;
