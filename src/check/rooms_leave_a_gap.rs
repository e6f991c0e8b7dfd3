use std::collections::BTreeMap;

use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::{are_parallel, common_stretch};
use crate::geometry::{Point, Segment};
use crate::plan::titles::RoomName;
use crate::plan::{ElementId, THICKEST_WALL_M};

/// Two rooms that face each other across a gap too wide to be deliberate and too thin to be a wall: they
/// were meant to meet. Only in plans whose rooms mostly meet, their sides drawn on wall centre lines:
/// where walls are drawn as the space left between rooms, a thin gap is a thin partition.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsLeaveAGap {
    pub rooms: [RoomName; 2],
    /// Maximum width of the gap in metres.
    pub width_m: f64,
    /// Length over which they face each other, in metres.
    pub length_m: f64,
    pub at: Point,
}

/// The thinnest wall in metres: a gypsum board partition of 50 mm with its skim coats.
const THINNEST_WALL_M: f64 = 0.06;

/// A gap shorter than this, in metres, is a chamfered corner or a door jamb.
const LEAST_LENGTH_M: f64 = 0.3;

/// Pieces of a side shorter than this, in metres, are skipped: their direction is unreliable.
const LEAST_PIECE_M: f64 = 0.05;

impl Check for RoomsLeaveAGap {
    const KIND: Kind = Kind {
        name: "rooms_leave_a_gap",
        title: "Rooms leave a gap too thin for a wall",
        severity: Severity::Warning,
        remedy: "move one side onto the other, or weld the rooms' corners",
    };

    fn find(context: &Context) -> Vec<Self> {
        let tolerance_m = context.drawing_tolerance_m;
        // For each pair of rooms: the gap's length, its maximum width, and where that is.
        let mut pairs: BTreeMap<(usize, usize), (f64, f64, Point)> = BTreeMap::new();
        let (mut meeting_m, mut walled_m) = (0.0, 0.0);
        let edges = &context.edges;
        for (i, &edge) in edges.index.all().iter().enumerate() {
            if edge.length() < LEAST_PIECE_M {
                continue;
            }
            for j in edges.index.near(edge.bounds().inflated(THICKEST_WALL_M)) {
                let (room, other_room) = (edges.rooms[i], edges.rooms[j]);
                if other_room <= room {
                    continue;
                }
                let Some(facing) = facing(edge, edges.index.get(j)) else { continue };
                if facing.least_m >= -tolerance_m && facing.most_m <= tolerance_m {
                    meeting_m += facing.length_m;
                } else if facing.least_m >= THINNEST_WALL_M && facing.most_m <= THICKEST_WALL_M {
                    walled_m += facing.length_m;
                } else if facing.least_m >= -tolerance_m
                    && (facing.least_m + facing.most_m) / 2.0 > tolerance_m
                    && facing.most_m < THINNEST_WALL_M
                {
                    let entry = pairs.entry((room, other_room)).or_insert((0.0, 0.0, facing.at));
                    entry.0 += facing.length_m;
                    if facing.most_m > entry.1 {
                        (entry.1, entry.2) = (facing.most_m, facing.at);
                    }
                }
            }
        }
        // In a plan whose rooms are separated by their walls, thin partitions are drawn as gaps too.
        if walled_m > meeting_m {
            return Vec::new();
        }
        pairs
            .into_iter()
            .filter(|(_, (length_m, ..))| *length_m >= LEAST_LENGTH_M)
            .map(|((room, other), (length_m, width_m, at))| Self {
                rooms: [context.name(room), context.name(other)],
                width_m,
                length_m,
                at,
            })
            .collect()
    }

    fn size(&self) -> f64 {
        self.length_m
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: self.rooms.iter().map(|room| ElementId::Room(room.id)).collect(),
            rooms: self.rooms.iter().collect(),
            at: Some(self.at),
        }
    }

    fn what(&self) -> String {
        let [one, other] = &self.rooms;
        format!("{one} and {other} leave a gap of {:.0} mm, {:.1} m long", 1000.0 * self.width_m, self.length_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("width_m", self.width_m), ("length_m", self.length_m)]
    }
}

/// Two sides of rooms that face each other.
struct Facing {
    /// Length of the stretch over which they face, in metres.
    length_m: f64,
    /// Their smallest and largest distance in metres; below 0 if the rooms overlap.
    least_m: f64,
    most_m: f64,
    /// Halfway between their midpoints.
    at: Point,
}

/// How two sides, each with its room on its left, face each other, if they do.
fn facing(edge: Segment, other: Segment) -> Option<Facing> {
    if other.length() < LEAST_PIECE_M
        || edge.vector().dot(other.vector()) >= 0.0
        || !are_parallel(edge, other, ANGLE_TOLERANCE_RAD)
    {
        return None;
    }
    let (from, to) = common_stretch(edge, other);
    if to - from < LEAST_PIECE_M {
        return None;
    }
    let direction = edge.vector().unit()?;
    let outward = -direction.left();
    // The other side's outward distance at a position along this one.
    let apart_m = |along_m: f64| {
        let at = edge.a + direction * along_m;
        let across = other.vector();
        let t = (at - other.a).dot(direction) / across.dot(direction);
        (other.a + across * t - at).dot(outward)
    };
    let (one, two) = (apart_m(from), apart_m(to));
    let middle = edge.a + direction * ((from + to) / 2.0);
    Some(Facing {
        length_m: to - from,
        least_m: one.min(two),
        most_m: one.max(two),
        at: middle + outward * ((one + two) / 4.0),
    })
}
