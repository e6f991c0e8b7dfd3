//! Turns what a robot found into an ordinary plan: rooms, the doorways between them, and the frontiers to
//! the unknown.

use std::sync::Arc;

use super::Pose;
use super::frontiers::Frontier;
use super::rooms::FoundRooms;
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Point, TOUCH_M};
use crate::plan::{
    Builder, Extra, Joint, Meta, Opening, OpeningId, OpeningKind, Place, Plan, Room, RoomId, RoomLabel, Violation,
};

/// A doorway up to this width in metres is a door (paper: 150 cm); a wider one is a free passage.
const WIDEST_DOOR_M: f64 = 1.5;

/// A frontier belongs to the room within this many metres of it.
const NEAR_ROOM_M: f64 = 0.5;

/// The plan of a map.
#[derive(Clone, Debug)]
pub struct ExploredPlan {
    pub plan: Plan,
    /// The plan's room for each found room.
    pub rooms: Vec<RoomId>,
    /// The plan's opening for each frontier; `None` if it borders no room.
    pub frontiers: Vec<Option<OpeningId>>,
}

/// Information about rooms and frontiers besides their shape.
#[derive(Clone, Debug, Default)]
pub struct Said {
    /// The label of each found room; missing entries mean none.
    pub labels: Vec<Option<RoomLabel>>,
    /// For each frontier, extra fields for its opening.
    pub behind: Vec<Extra>,
}

/// Makes a plan, in the world's frame. A frontier becomes an opening from its room to the outside.
///
/// # Errors
/// The violations of a plan's invariants: a room's boundary may collapse on the plan's grid.
pub fn plan(
    found: &FoundRooms,
    frontiers: &[Frontier],
    world_from_map: Pose,
    meta: Meta,
    said: &Said,
) -> Result<ExploredPlan, Vec<Violation>> {
    let mut builder = Builder::new(meta);
    let place = |point: &Point| world_from_map.apply(*point);
    let ring = |ring: &[Point]| without_spikes(ring).iter().map(place).collect::<Vec<Point>>();
    let mut rooms = Vec::new();
    for (index, found) in found.rooms.iter().enumerate() {
        let outer = builder.ring(ring(&found.outer));
        let holes: Vec<Arc<_>> = found.holes.iter().map(|hole| builder.ring(ring(hole))).collect();
        let holes = holes.into_iter().filter(|hole| hole.len() >= 3).collect();
        let axes = found.axes.map(|axes| (axes.major_m, axes.minor_m)).unwrap_or_default();
        let measured = serde_json::json!({
            "a": crate::geometry::trim_m(found.area_m2),
            "M": crate::geometry::trim_m(axes.0),
            "m": crate::geometry::trim_m(axes.1),
        });
        let extra = Some(Arc::new(serde_json::Map::from_iter([("robot".to_owned(), measured)])));
        let label = said.labels.get(index).copied().flatten();
        rooms.push(builder.room("", Room { outer, holes, label, extra, ..Room::default() }));
    }
    let joint = |side: Option<usize>| side.map_or(Joint::Outside, |index| Joint::Room(rooms[index]));
    for (doorway, sides) in found.doorways.iter().zip(&found.sides) {
        if sides[0].is_none() && sides[1].is_none() {
            continue;
        }
        let kind = if doorway.width_m <= WIDEST_DOOR_M { OpeningKind::Door } else { OpeningKind::Passage };
        let (from, to) = (place(&doorway.segment.a), place(&doorway.segment.b));
        let mut opening = Opening::new(kind, Place::Free { from, to });
        opening.pinned = Some([joint(sides[0]), joint(sides[1])]);
        builder.opening("", opening);
    }
    let mut at_frontiers = Vec::new();
    for (index, frontier) in frontiers.iter().enumerate() {
        let room = room_beside(found, frontier);
        let ends = (frontier.line.first(), frontier.line.last());
        let (Some(room), (Some(from), Some(to))) = (room, ends) else {
            at_frontiers.push(None);
            continue;
        };
        let (from, to) = (place(from), place(to));
        if from.distance(to) <= TOUCH_M {
            at_frontiers.push(None);
            continue;
        }
        let mut opening = Opening::new(OpeningKind::Passage, Place::Free { from, to });
        opening.pinned = Some([Joint::Room(rooms[room]), Joint::Outside]);
        opening.extra = said.behind.get(index).cloned().flatten();
        at_frontiers.push(Some(builder.opening("", opening)));
    }
    Ok(ExploredPlan { plan: builder.finish()?, rooms, frontiers: at_frontiers })
}

/// A ring without corners where it turns back on itself: what is left of a sight between two walls.
fn without_spikes(ring: &[Point]) -> Vec<Point> {
    let mut kept = ring.to_vec();
    let mut index = 0;
    while kept.len() > 3 && index < kept.len() {
        let count = kept.len();
        let (before, after) = (kept[(index + count - 1) % count], kept[(index + 1) % count]);
        let (to, on) = (before - kept[index], after - kept[index]);
        let longer_m = to.length().max(on.length());
        // How far the end of the shorter side is from the longer one.
        let is_spike = to.dot(on) > 0.0 && to.cross(on).abs() <= SPIKE_M * longer_m;
        if is_spike {
            kept.remove(index);
            index = index.saturating_sub(1);
        } else {
            index += 1;
        }
    }
    kept
}

/// Both sides of a spike are this near to each other, in metres.
const SPIKE_M: f64 = 0.01;

/// The room whose boundary contains a frontier.
fn room_beside(found: &FoundRooms, frontier: &Frontier) -> Option<usize> {
    let inside = |point: Point| {
        found.rooms.iter().position(|room| polygon::locate(&room.outer, &room.holes, point) == Location::Inside)
    };
    let steps = (NEAR_ROOM_M / 0.1) as usize;
    (0..=steps).find_map(|step| inside(frontier.middle - frontier.outward * (0.02 + 0.1 * step as f64)))
}
