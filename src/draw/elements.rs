//! What a drawing is made of, before zoom and colours.

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
    /// What a classifier says it is, where one was asked.
    pub predicted: Option<Label>,
    /// The room without a rim along its boundary, as pieces with their holes: made for a room whose
    /// known label is not the predicted one.
    pub within_rim: Vec<(Vec<Point>, Vec<Vec<Point>>)>,
    pub area_m2: f64,
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
    pub bounds: Bounds,
    /// The middle of the room where it is widest: where its name and its node go.
    pub centre: Point,
    /// Indices of the rooms painted over it: smaller ones that reach into its box.
    pub above: Vec<usize>,
    /// Indices of the openings that reach into its box.
    pub openings: Vec<usize>,
}

impl RoomDrawing {
    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// What it would be if the prediction were its label.
    pub fn predicted_status(&self) -> RoomStatus {
        match (self.status, self.predicted) {
            (RoomStatus::NotClassified, _) => RoomStatus::NotClassified,
            (_, Some(label)) => RoomStatus::Labelled(label),
            (_, None) => RoomStatus::Unlabelled,
        }
    }

    /// The known label, where the prediction is another.
    pub fn missed_label(&self) -> Option<Label> {
        self.status.label().filter(|known| self.predicted.is_some_and(|said| said != *known))
    }

    /// Whether it is a lift, whose doors slide.
    pub fn is_lift(&self) -> bool {
        normalised_function(&self.function).split(' ').any(|word| matches!(word, "lift" | "elevator"))
    }

    /// Whether it lies under the open sky, so that it is no part of the building's mass: by its
    /// function, and only where the scheme leaves that blank.
    pub fn is_open_air(&self) -> bool {
        self.status == RoomStatus::NotClassified
            && OPEN_AIR.iter().any(|word| normalised_function(&self.function).contains(word))
    }
}

/// Words in functions of what lies under the open sky.
const OPEN_AIR: [&str; 12] = [
    "balcony", "terrace", "loggia", "veranda", "patio", "garden", "yard", "deck", "outdoor", "outside", "court",
    "porch",
];

/// The order of painting: large rooms first, so that one that lies in or over another is seen.
pub(super) fn painting_order(rooms: &[RoomDrawing], one: usize, other: usize) -> Ordering {
    rooms[other].area_m2.total_cmp(&rooms[one].area_m2).then(one.cmp(&other))
}

/// A connected piece of wall.
pub(super) struct WallDrawing {
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
}

/// A way from room to room, or out, through an opening.
pub(super) struct GraphEdge {
    pub from: Point,
    pub through: Point,
    /// The other room's centre; without one it leads outside, this way.
    pub to: Result<Point, crate::geometry::Vector>,
}

/// Radius of a graph's node in pixels.
pub(super) const NODE_RADIUS_PX: f64 = 5.0;
