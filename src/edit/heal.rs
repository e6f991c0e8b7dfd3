//! Taking out corners that only divide a straight line, where what met it there is gone.

use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::sync::Arc;

use crate::edit::overlay::plan_edges;
use crate::geometry::{GRID_M, Point, Segment, trim_m};
use crate::plan::{CornerId, OpeningId, Place, Plan, RoomId, WallId, ordered, ring_edges};

/// Takes out those of the given corners at which nothing turns or ends any more: two edges in line meet
/// there, with walls of one thickness or none, and become one. Openings stay in place; of two walls the one
/// that ends there keeps its identity, so that dividing a wall and taking the corner out again gives the same
/// plan.
pub(super) fn healed(plan: Plan, corners: impl IntoIterator<Item = CornerId>) -> Plan {
    let corners: BTreeSet<CornerId> = corners.into_iter().filter(|&id| plan.corner(id).is_some()).collect();
    if corners.is_empty() {
        return plan;
    }
    let mut near = Near::of(&plan, &corners);
    let mut next = plan;
    for corner in corners {
        if let Some(healed) = near.without(&next, corner) {
            next = healed;
        }
    }
    next
}

/// What has one of the corners to be looked at, by corner. Lists may name what has it no longer.
#[derive(Default)]
struct Near {
    walls: BTreeMap<CornerId, Vec<WallId>>,
    rooms: BTreeMap<CornerId, Vec<RoomId>>,
    openings: BTreeMap<CornerId, Vec<OpeningId>>,
    /// All edges of the plan, once they are needed.
    edges: Option<HashSet<[CornerId; 2]>>,
}

impl Near {
    fn of(plan: &Plan, corners: &BTreeSet<CornerId>) -> Self {
        let mut near = Self::default();
        for (id, wall) in plan.walls() {
            for corner in [wall.from, wall.to].into_iter().filter(|corner| corners.contains(corner)) {
                near.walls.entry(corner).or_default().push(id);
            }
        }
        for (id, room) in plan.rooms() {
            let once: BTreeSet<CornerId> = room.rings().flat_map(|ring| ring.iter().copied()).collect();
            for corner in once.into_iter().filter(|corner| corners.contains(corner)) {
                near.rooms.entry(corner).or_default().push(id);
            }
        }
        for (id, opening) in plan.openings() {
            if let Place::Hosted { from, to, .. } = opening.place {
                for corner in [from, to].into_iter().filter(|corner| corners.contains(corner)) {
                    near.openings.entry(corner).or_default().push(id);
                }
            }
        }
        near
    }

    /// The plan without a corner; `None` where it is needed.
    fn without(&mut self, plan: &Plan, corner: CornerId) -> Option<Plan> {
        let there = plan.corner(corner).filter(|there| there.extra.is_none())?;
        let far = |from: CornerId, to: CornerId| if from == corner { to } else { from };
        let mut neighbours: BTreeSet<CornerId> = BTreeSet::new();
        let mut walls: Vec<WallId> = Vec::new();
        for &id in self.walls.get(&corner).into_iter().flatten() {
            if let Some(wall) = plan.wall(id).filter(|wall| wall.from == corner || wall.to == corner) {
                neighbours.insert(far(wall.from, wall.to));
                walls.push(id);
            }
        }
        let rooms = self.rooms.get(&corner).cloned().unwrap_or_default();
        for ring in rooms.iter().filter_map(|&id| plan.room(id)).flat_map(|room| room.rings()) {
            if ring.contains(&corner) && ring.len() < 4 {
                return None;
            }
            let beside = ring_edges(ring).filter(|&(a, b)| a == corner || b == corner);
            neighbours.extend(beside.map(|(a, b)| far(a, b)));
        }
        let [a, b] = neighbours.into_iter().collect::<Vec<_>>()[..] else { return None };
        let line = Segment::new(plan.position(a)?, plan.position(b)?);
        if !is_between(line, there.position) {
            return None;
        }
        // The whole line may not be an edge yet.
        let edges =
            self.edges.get_or_insert_with(|| plan_edges(plan).map(|(p, q)| ordered(p, q)).collect::<HashSet<_>>());
        if edges.contains(&ordered(a, b)) {
            return None;
        }
        let mut next = plan.clone();
        for &id in self.openings.get(&corner).into_iter().flatten() {
            let Some(Place::Hosted { from, to, at_m, width_m }) = plan.opening(id).map(|opening| opening.place) else {
                continue;
            };
            if from != corner && to != corner {
                continue;
            }
            let other = far(from, to);
            let end = if other == a {
                b
            } else if other == b {
                a
            } else {
                return None;
            };
            // Seen from the other way round, the part behind the corner comes first.
            let (from, to, before_m) = if from == corner {
                (end, other, plan.position(end)?.distance(there.position))
            } else {
                (other, end, 0.0)
            };
            let at_m = trim_m((at_m + before_m).min(line.length()));
            Arc::make_mut(next.openings.get_mut(&id)?).place = Place::Hosted { from, to, at_m, width_m };
        }
        match walls[..] {
            [] => {}
            [first, second] => {
                let (p, q) = (plan.wall(first)?, plan.wall(second)?);
                let is_one = p.thickness_m == q.thickness_m && p.extra == q.extra;
                if !is_one || far(p.from, p.to) == far(q.from, q.to) {
                    return None;
                }
                let (kept, gone) = if q.to == corner && p.to != corner { (second, first) } else { (first, second) };
                let end = plan.wall(gone).map(|wall| far(wall.from, wall.to))?;
                let wall = next.walls.get_mut(&kept)?;
                if wall.to == corner {
                    wall.to = end;
                } else {
                    wall.from = end;
                }
                next.walls.remove(&gone);
                self.walls.entry(end).or_default().push(kept);
            }
            // One wall and an edge without, or walls on top of each other.
            _ => return None,
        }
        for id in rooms {
            let room = Arc::make_mut(next.rooms.get_mut(&id)?);
            for ring in std::iter::once(&mut room.outer).chain(&mut room.holes) {
                if ring.contains(&corner) {
                    *ring = ring.iter().copied().filter(|&other| other != corner).collect();
                }
            }
        }
        next.corners.remove(&corner);
        edges.insert(ordered(a, b));
        let moved = self.openings.remove(&corner).unwrap_or_default();
        for end in [a, b] {
            self.openings.entry(end).or_default().extend(&moved);
        }
        Some(next)
    }
}

/// Whether a point divides a line without bending it, up to the rounding to the grid.
fn is_between(line: Segment, point: Point) -> bool {
    let Some(along) = line.vector().unit() else { return false };
    let (before_m, behind_m) = ((point - line.a).dot(along), (line.b - point).dot(along));
    before_m > 0.0 && behind_m > 0.0 && (point - line.a).dot(along.left()).abs() <= GRID_M
}
