//! The parts of a drawing, before zoom and colours.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use crate::features::RoomStatus;
use crate::geometry::{Bounds, Point, polygon};
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
    /// How sure the classifier is of it, 0..=1.
    pub sureness: f64,
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

/// The lines of a hatch run up to the right, so many pixels apart at least and less than twice as many at most.
const HATCH_PX: f64 = 8.0;

/// A room has no more lines than this, however large it is on the screen.
const MOST_HATCHED: f64 = 300.0;

impl RoomDrawing {
    /// Lines of a hatch across the room. At one zoom they are those of one pattern in all rooms.
    pub fn hatch(&self, px_per_m: f64) -> Vec<[Point; 2]> {
        // Along and across the lines: the plan turned by 45 degrees.
        const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;
        let turned = |point: Point| ((point.x + point.y) * HALF, (point.y - point.x) * HALF);
        let size_m = self.bounds.width() + self.bounds.height();
        // Twice as far apart with each halving of the zoom, so that a pattern stays where it is while it scales.
        let step_m = (HATCH_PX / px_per_m).log2().ceil().exp2().max(size_m / MOST_HATCHED);
        if !(step_m.is_finite() && step_m > 0.0) {
            return Vec::new();
        }
        let mut crossings: BTreeMap<i64, Vec<f64>> = BTreeMap::new();
        for ring in self.rings() {
            for edge in polygon::edges(ring) {
                let ((along_a, across_a), (along_b, across_b)) = (turned(edge.a), turned(edge.b));
                let (low, high) = (across_a.min(across_b), across_a.max(across_b));
                // Each end belongs to one of the two edges that meet there.
                for line in (low / step_m).ceil() as i64..(high / step_m).ceil() as i64 {
                    let t = (line as f64 * step_m - across_a) / (across_b - across_a);
                    crossings.entry(line).or_default().push(along_a + (along_b - along_a) * t);
                }
            }
        }
        let back = |along: f64, across: f64| Point::new((along - across) * HALF, (along + across) * HALF);
        let mut lines = Vec::new();
        for (line, mut along) in crossings {
            along.sort_by(f64::total_cmp);
            let across = line as f64 * step_m;
            lines.extend(along.chunks_exact(2).map(|pair| [back(pair[0], across), back(pair[1], across)]));
        }
        lines
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
