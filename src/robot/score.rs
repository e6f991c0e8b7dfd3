//! Compares the rooms found by a robot with those of the true plan.

use std::collections::{BTreeMap, BTreeSet};

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::world::{DoorState, World};
use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Bounds, Point};
use crate::plan::{Joint, RoomId};

/// A room counts as found if its intersection over union exceeds this.
pub const FOUND_IOU: f64 = 0.7;

/// A room takes part in a split or a merger if it covers at least this share of the other's area.
const PART_SHARE: f64 = 0.2;

/// The score of a true room.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomScore {
    pub id: RoomId,
    /// The found room that covers the most of it, by index.
    pub best: Option<usize>,
    /// Intersection over union with that room, 0..=1.
    pub iou: f64,
    pub fate: Fate,
}

/// The fate of a true room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    Found,
    /// Two or more found rooms share it.
    Split,
    /// One found room covers it and another.
    Merged,
    Missed,
}

impl Fate {
    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::Split => "split",
            Self::Merged => "merged",
            Self::Missed => "missed",
        }
    }
}

/// The agreement of found rooms and their graph with the true ones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// The rooms the robot could reach, by id.
    pub rooms: Vec<RoomScore>,
    /// Rooms of the plan the robot could not reach.
    pub unreachable: Vec<RoomId>,
    /// Found rooms that are not the best match of any true room within reach, nor lie mostly in one out of reach.
    pub invented: Vec<usize>,
    /// Pairs of reachable rooms joined by a passable opening.
    pub true_edges: BTreeSet<(RoomId, RoomId)>,
    /// Those of them that were found.
    pub right_edges: BTreeSet<(RoomId, RoomId)>,
    /// The number of found edges between rooms that are not joined.
    pub wrong_edges: usize,
    /// Those edges: pairs of found rooms by index, the lower first.
    pub wrong_pairs: BTreeSet<(usize, usize)>,
}

impl Score {
    /// Number of true rooms with a fate.
    pub fn count(&self, fate: Fate) -> usize {
        self.rooms.iter().filter(|room| room.fate == fate).count()
    }

    /// Number of found rooms that are asked for or invented: without those of which a room out of reach was seen through its door.
    pub fn counted_rooms(&self) -> usize {
        self.rooms.iter().filter_map(|room| room.best).collect::<BTreeSet<usize>>().len() + self.invented.len()
    }

    /// Share of the reachable rooms that were found, 0..=1; 1 if there are none.
    pub fn room_recall(&self) -> f64 {
        share(self.count(Fate::Found), self.rooms.len())
    }

    /// Share of the true edges that were found, 0..=1; 1 if there are none.
    pub fn edge_recall(&self) -> f64 {
        share(self.right_edges.len(), self.true_edges.len())
    }

    /// Share of the found edges that are correct, 0..=1; 1 if there are none.
    pub fn edge_precision(&self) -> f64 {
        share(self.right_edges.len(), self.right_edges.len() + self.wrong_edges)
    }
}

fn share(part: usize, of: usize) -> f64 {
    if of == 0 { 1.0 } else { part as f64 / of as f64 }
}

fn common_m2(one: &Shapes, other: &Shapes) -> f64 {
    areas::area_m2(&one.overlay(other, OverlayRule::Intersect, FillRule::NonZero))
}

fn bounds(shapes: &Shapes) -> Bounds {
    Bounds::of(shapes.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y)))
}

/// A room is reachable if the robot's centre can be on at least this share of its floor.
const REACHED_SHARE: f64 = 0.05;

/// Compares found rooms with the world's. `rooms` are their areas in the world's frame; `edges` the pairs
/// of found rooms joined by a doorway; `start` and `radius_m`, the robot's start and half its width,
/// determine what it could reach.
pub fn score(world: &World, start: Point, radius_m: f64, rooms: &[Shapes], edges: &[(usize, usize)]) -> Score {
    let passable = world.passable(radius_m);
    let reach = passable.into_iter().find(|piece| super::world::is_inside(piece, start)).unwrap_or_default();
    let boxes: Vec<Bounds> = rooms.iter().map(bounds).collect();
    let areas_m2: Vec<f64> = rooms.iter().map(areas::area_m2).collect();
    let mut result = Score::default();
    // Common areas by true room and found room.
    let mut common: Vec<Vec<(usize, f64)>> = Vec::new();
    let mut reachable: Vec<&super::world::WorldRoom> = Vec::new();
    for room in world.rooms() {
        let is_reachable = common_m2(&room.floor, &reach) > REACHED_SHARE * room.area_m2 && room.area_m2 > 0.0;
        if !is_reachable {
            result.unreachable.push(room.id);
            continue;
        }
        let around = bounds(&room.floor);
        let near = (0..rooms.len()).filter(|&i| boxes[i].intersects(around));
        let with: Vec<(usize, f64)> =
            near.map(|i| (i, common_m2(&room.floor, &rooms[i]))).filter(|(_, m2)| *m2 > 0.0).collect();
        reachable.push(room);
        common.push(with);
    }
    // The true room of each found one, within reach or not: the one it shares the most area with.
    let mut true_of: BTreeMap<usize, (f64, RoomId)> = BTreeMap::new();
    for room in world.rooms() {
        let around = bounds(&room.floor);
        for i in (0..rooms.len()).filter(|&i| boxes[i].intersects(around)) {
            let m2 = common_m2(&room.floor, &rooms[i]);
            if m2 <= 0.0 {
                continue;
            }
            let best = true_of.entry(i).or_insert((m2, room.id));
            if m2 > best.0 {
                *best = (m2, room.id);
            }
        }
    }
    let mut matched: BTreeSet<usize> = BTreeSet::new();
    for (room, with) in reachable.iter().zip(&common) {
        let best = with.iter().copied().max_by(|p, q| p.1.total_cmp(&q.1).then(q.0.cmp(&p.0)));
        let iou = best.map_or(0.0, |(i, m2)| m2 / (room.area_m2 + areas_m2[i] - m2));
        let parts = with.iter().filter(|(i, m2)| *m2 > PART_SHARE * room.area_m2 && *m2 > 0.5 * areas_m2[*i]).count();
        let is_merged = best.is_some_and(|(i, m2)| m2 > 0.5 * room.area_m2 && m2 < 0.8 * areas_m2[i]);
        let fate = match best {
            Some(_) if iou > FOUND_IOU => Fate::Found,
            Some(_) if parts > 1 => Fate::Split,
            Some(_) if is_merged => Fate::Merged,
            _ => Fate::Missed,
        };
        matched.extend(best.map(|(i, _)| i));
        result.rooms.push(RoomScore { id: room.id, best: best.map(|(i, _)| i), iou, fate });
    }
    // Rooms out of reach that were seen through their doors are not asked for, but there they are.
    let is_seen_only = |i: &usize| true_of.get(i).is_some_and(|(_, room)| result.unreachable.contains(room));
    result.invented = (0..rooms.len()).filter(|i| !matched.contains(i) && !is_seen_only(i)).collect();
    let pair = |p: RoomId, q: RoomId| if p < q { (p, q) } else { (q, p) };
    let is_reachable = |id: RoomId| reachable.iter().any(|room| room.id == id);
    let mut joined: BTreeSet<(RoomId, RoomId)> = BTreeSet::new();
    for opening in world.openings().iter().filter(|opening| opening.state != DoorState::Closed) {
        if let [Joint::Room(p), Joint::Room(q)] = opening.sides
            && p != q
        {
            joined.insert(pair(p, q));
            if opening.state == DoorState::Open && is_reachable(p) && is_reachable(q) {
                result.true_edges.insert(pair(p, q));
            }
        }
    }
    for &(i, j) in edges {
        match (true_of.get(&i), true_of.get(&j)) {
            (Some((_, p)), Some((_, q))) if p != q && result.true_edges.contains(&pair(*p, *q)) => {
                result.right_edges.insert(pair(*p, *q));
            }
            // An edge to a room out of reach, or by a door that is ajar, is not asked for, but is there.
            (Some((_, p)), Some((_, q))) if p != q && joined.contains(&pair(*p, *q)) => {}
            _ => {
                result.wrong_pairs.insert((i.min(j), i.max(j)));
            }
        }
    }
    result.wrong_edges = result.wrong_pairs.len();
    result
}
