use std::fmt;

use super::{CornerId, ElementId, Joint, Place, Plan};
use crate::geometry::COORDINATE_LIMIT_M;
use crate::geometry::Point;

/// A broken invariant of the model: never a matter of taste (those are checks), always a bug in an edit
/// or a damaged file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    pub element: ElementId,
    pub what: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.element, self.what)
    }
}

impl Plan {
    /// All broken invariants, by element; empty for every plan an edit may return:
    ///
    /// - positions are finite, within [`COORDINATE_LIMIT_M`], and on the 0.1 mm grid;
    /// - a wall joins two different corners that exist, its thickness is within 0..=10 m;
    /// - a ring is empty (the outer one of a room without holes) or has at least three corners that
    ///   exist, no two neighbours equal;
    /// - a hosted opening's corners exist and differ in place, its width is above 0 and at most
    ///   1 km, its middle lies on the edge; a free opening has a length;
    /// - a pinned room exists.
    pub fn violations(&self) -> Vec<Violation> {
        let mut found = Vec::new();
        let mut say = |element, what: String| found.push(Violation { element, what });
        let on_grid = |value: f64| {
            value.is_finite() && value.abs() <= COORDINATE_LIMIT_M && crate::geometry::trim_m(value) == value
        };
        let placed = |point: Point| on_grid(point.x) && on_grid(point.y);
        for (&id, corner) in &self.corners {
            if !placed(corner.position) {
                say(
                    ElementId::Corner(id),
                    format!(
                        "position ({}, {}) is not on the grid within ±{COORDINATE_LIMIT_M} m",
                        corner.position.x, corner.position.y
                    ),
                );
            }
        }
        for (&id, wall) in &self.walls {
            let element = ElementId::Wall(id);
            for corner in [wall.from, wall.to] {
                if !self.corners.contains_key(&corner) {
                    say(element, format!("its corner {corner} does not exist"));
                }
            }
            if wall.from == wall.to {
                say(element, format!("both its ends are the corner {}", wall.from));
            }
            if !(on_grid(wall.thickness_m) && (0.0..=10.0).contains(&wall.thickness_m)) {
                say(element, format!("thickness {} m is not within 0..=10 m", wall.thickness_m));
            }
        }
        for (&id, room) in &self.rooms {
            let element = ElementId::Room(id);
            if !room.has_boundary() && !room.holes.is_empty() {
                say(element, "has holes but no outer boundary".to_owned());
            }
            for ring in room.rings() {
                if ring.is_empty() && !room.has_boundary() {
                    continue;
                }
                if ring.len() < 3 {
                    say(element, format!("a ring has {} corners; at least 3 are needed", ring.len()));
                }
                for (i, corner) in ring.iter().enumerate() {
                    if !self.corners.contains_key(corner) {
                        say(element, format!("its corner {corner} does not exist"));
                    }
                    if ring.len() > 1 && ring[(i + 1) % ring.len()] == *corner {
                        say(element, format!("the corner {corner} follows itself"));
                    }
                }
            }
        }
        for (&id, opening) in &self.openings {
            let element = ElementId::Opening(id);
            match opening.place {
                Place::Hosted { from, to, at_m, width_m } => {
                    let position = |corner: CornerId| self.position(corner);
                    match (position(from), position(to)) {
                        (Some(a), Some(b)) if a != b => {
                            // Half a grid step of slack: lengths of oblique edges are not on the grid.
                            let length_m = a.distance(b) + crate::geometry::GRID_M;
                            // An edge across the drawing area is longer than a coordinate may be.
                            if !(crate::geometry::trim_m(at_m) == at_m && (0.0..=length_m).contains(&at_m)) {
                                say(
                                    element,
                                    format!("its middle at {at_m} m lies beyond its edge of {:.4} m", a.distance(b)),
                                );
                            }
                        }
                        (Some(_), Some(_)) => say(element, "its edge has no length".to_owned()),
                        _ => say(element, format!("its edge {from} {to} does not exist")),
                    }
                    if !(on_grid(width_m) && width_m > 0.0 && width_m <= 1000.0) {
                        say(element, format!("width {width_m} m is not within 0..=1000 m"));
                    }
                }
                Place::Free { from, to } => {
                    if !(placed(from) && placed(to)) {
                        say(element, format!("position is not on the grid within ±{COORDINATE_LIMIT_M} m"));
                    } else if from == to {
                        say(element, "has no length".to_owned());
                    }
                }
            }
            for joint in opening.pinned.iter().flatten() {
                if let Joint::Room(room) = joint
                    && !self.rooms.contains_key(room)
                {
                    say(element, format!("is pinned to the room {room}, which does not exist"));
                }
            }
        }
        found
    }
}
