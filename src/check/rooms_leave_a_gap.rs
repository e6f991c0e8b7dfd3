use std::collections::BTreeMap;

use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::{are_parallel, common_stretch};
use crate::geometry::{Point, Segment};
use crate::plan::titles::RoomName;
use crate::plan::{ElementId, THICKEST_WALL_M};

/// Two rooms whose sides face each other across a gap too wide to be how they were drawn and too
/// thin to be a wall: they were meant to meet. Only in plans whose rooms meet on the whole, their
/// sides drawn on the walls' centre lines: in one that draws its walls as what is left between
/// rooms, a thin gap is a thin partition.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsLeaveAGap {
    pub rooms: [RoomName; 2],
    /// Width of the gap where it is widest, in metres.
    pub width_m: f64,
    /// Length along which they face each other, in metres.
    pub length_m: f64,
    pub at: Point,
}

/// The thinnest wall in metres: a gypsum board partition of 50 mm with its skim coats.
const THINNEST_WALL_M: f64 = 0.06;

/// A gap shorter than this, in metres, is a corner cut off or a door's jamb.
const LEAST_LENGTH_M: f64 = 0.3;

/// Pieces of a side shorter than this, in metres, are left out: they have no direction to rely on.
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
        // By pair of rooms: the gap's length, its width where it is widest, and where that is.
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
        // A plan whose rooms stand apart by their walls shows its thin partitions too.
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
    /// Length of the stretch along which they do, in metres.
    length_m: f64,
    /// How far apart they are where they are nearest and where they are farthest, in metres; below 0
    /// where the rooms overlap.
    least_m: f64,
    most_m: f64,
    /// Between the middles of both.
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
    // How far outward the other side lies at a distance along this one.
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
