//! Merging corners that nearly coincide.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::edit::overlay::plan_edges;
use crate::edit::split::{Splits, nearest_part, split_walls_and_rooms, without_repeated_walls};
use crate::edit::{EditError, fail};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, Point, Segment, TOUCH_M, polygon, trim_m};
use crate::plan::{CornerId, Place, Plan, Positions, RoomId, WallId, ordered};

/// The result of welding, to show before applying it.
#[derive(Clone, Debug, PartialEq)]
pub struct Weld {
    /// Corners to be replaced, each with its replacement, by id.
    pub merged: Vec<(CornerId, CornerId)>,
    /// Corners that edges nearly pass through, each with the edge to split there.
    pub onto_edges: Vec<(CornerId, [CornerId; 2])>,
    /// The welded plan.
    pub plan: Plan,
}

impl Weld {
    /// Whether there is nothing to weld.
    pub fn is_empty(&self) -> bool {
        self.merged.is_empty() && self.onto_edges.is_empty()
    }
}

/// Merges corners within a tolerance in metres of each other, then splits edges at corners within it.
///
/// Of merged corners, the one with the most edges stays in place (the first by id, if tied); others are
/// replaced by it, but never by way of a third. Walls between merged corners are removed, and of two
/// walls between the same corners the first by id stays. Boundaries lose resulting spikes. A hosted
/// opening keeps its place on what its edge becomes, or becomes free if the edge is gone.
///
/// # Errors
/// When the tolerance is not above 0, or a room would vanish or turn inside out.
pub fn weld(plan: &Plan, tolerance_m: f64) -> Result<Weld, EditError> {
    weld_some(plan, tolerance_m, None)
}

/// Welds moved corners where they came to rest, within [`TOUCH_M`]: a moved corner on another becomes
/// that one, one on an edge goes onto its line and splits it, and a corner under a moved edge splits that
/// edge. To be called when a drag ends, so that a corner exists once. What did not move stays as it is: of a
/// moved wall on one that stood there, that one stays.
///
/// # Errors
/// As [`weld`].
pub fn settle(plan: &Plan, moved: &BTreeSet<CornerId>) -> Result<Plan, EditError> {
    weld_some(&on_lines(plan, moved), TOUCH_M, Some(moved)).map(|weld| weld.plan)
}

/// The plan with those moved corners that nearly lie on an edge that did not move put onto its line: it stays
/// straight when they split it.
fn on_lines(plan: &Plan, moved: &BTreeSet<CornerId>) -> Plan {
    let (_, edges) = concerned(plan, TOUCH_M, Some(moved));
    let mut next = plan.clone();
    let mut shifted: BTreeSet<CornerId> = BTreeSet::new();
    for (corner, ends) in near_edges(&edges, TOUCH_M, Some(moved), &BTreeSet::new()).1 {
        if !moved.contains(&corner) || ends.iter().any(|end| moved.contains(end)) {
            continue;
        }
        let line = plan.position(ends[0]).zip(plan.position(ends[1])).map(|(a, b)| Segment::new(a, b));
        if let (Some(line), Some(corner_now)) = (line, next.corners.get_mut(&corner)) {
            let position = line.nearest_point(corner_now.position).trimmed();
            if position != corner_now.position {
                corner_now.position = position;
                shifted.insert(corner);
            }
        }
    }
    if shifted.is_empty() {
        return next;
    }
    for (id, opening) in plan.openings() {
        if let Place::Hosted { from, to, at_m, width_m } = opening.place
            && (shifted.contains(&from) || shifted.contains(&to))
            && let (Some(a), Some(b)) = (next.position(from), next.position(to))
            && let Some(shared) = next.openings.get_mut(&id)
        {
            let at_m = trim_m(at_m.min(a.distance(b)));
            Arc::make_mut(shared).place = Place::Hosted { from, to, at_m, width_m };
        }
    }
    next
}

/// Welds corners with each other and with what lies within a tolerance in metres of them.
///
/// # Errors
/// As [`weld`].
pub fn weld_corners(plan: &Plan, corners: &BTreeSet<CornerId>, tolerance_m: f64) -> Result<Plan, EditError> {
    weld_some(plan, tolerance_m, Some(corners)).map(|weld| weld.plan)
}

/// Welds everything, or only where one of the given corners is involved.
fn weld_some(plan: &Plan, tolerance_m: f64, only: Option<&BTreeSet<CornerId>>) -> Result<Weld, EditError> {
    if !(tolerance_m > 0.0 && tolerance_m.is_finite()) {
        return fail(format!("a tolerance is above 0 m, not {tolerance_m} m"));
    }
    let (around, mut edges) = concerned(plan, tolerance_m, only);
    let becomes = joined(plan, tolerance_m, only, around, &edges);
    // Of two walls in one place the one that did not move stays.
    let mut moved: BTreeSet<WallId> = plan
        .walls()
        .filter(|(_, wall)| only.is_some_and(|only| only.contains(&wall.from) || only.contains(&wall.to)))
        .map(|(id, _)| id)
        .collect();
    let mut next = with_openings_in_place(plan, with_joined(plan, &becomes, &moved), &becomes);
    if !becomes.is_empty() {
        let around: Option<BTreeSet<CornerId>> =
            only.map(|only| only.iter().chain(becomes.values()).copied().collect());
        edges = concerned(&next, tolerance_m, around.as_ref()).1;
    }
    // Edges that moved, also those whose ends both became others.
    let now = |id: CornerId| becomes.get(&id).copied().unwrap_or(id);
    let laid: BTreeSet<[CornerId; 2]> = match only {
        Some(only) if !becomes.is_empty() => plan_edges(plan)
            .filter(|(a, b)| only.contains(a) || only.contains(b))
            .map(|(a, b)| ordered(now(a), now(b)))
            .collect(),
        _ => BTreeSet::new(),
    };
    let (splits, onto_edges) = near_edges(&edges, tolerance_m, only, &laid);
    if !splits.is_empty() {
        let cut: BTreeSet<CornerId> =
            splits.iter().flat_map(|(ends, inner)| ends.iter().chain(inner)).copied().collect();
        let (divided, parents) = split_walls_and_rooms(&next, &splits)?;
        moved.extend(
            parents.iter().filter(|(_, parent)| moved.contains(*parent)).map(|(&part, _)| part).collect::<Vec<_>>(),
        );
        next = without_repeated_walls(divided, &cut, &moved);
    }
    let touched: BTreeSet<CornerId> = becomes.values().copied().chain(splits.values().flatten().copied()).collect();
    let rooms: Vec<RoomId> = next
        .rooms()
        .filter(|(_, room)| room.rings().any(|ring| ring.iter().any(|corner| touched.contains(corner))))
        .map(|(id, _)| id)
        .collect();
    for id in rooms {
        let (Some(before), Some(shared)) = (plan.room(id), next.rooms.get_mut(&id)) else { continue };
        let room = Arc::make_mut(shared);
        room.outer = without_spikes(&room.outer);
        room.holes = room.holes.iter().map(|hole| without_spikes(hole)).filter(|hole| hole.len() >= 3).collect();
        let area = |plan: &Plan, ring: &[CornerId]| polygon::signed_area(&plan.ring_points(ring));
        let (outer, name) = (Arc::clone(&room.outer), room.name.clone());
        if outer.len() < 3 || area(plan, &before.outer) * area(&next, &outer) <= 0.0 {
            let name = if name.is_empty() { id.to_string() } else { format!("'{name}'") };
            return fail(format!("the room {name} is narrower than {tolerance_m} m: choose a smaller tolerance"));
        }
    }
    let merged = becomes.into_iter().collect();
    Ok(Weld { merged, onto_edges, plan: next })
}

/// For each corner to be replaced, its replacement; with `only`, those join others, not the reverse.
fn joined(
    plan: &Plan,
    tolerance_m: f64,
    only: Option<&BTreeSet<CornerId>>,
    around: Bounds,
    edges: &[Edge],
) -> BTreeMap<CornerId, CornerId> {
    let mut uses: BTreeMap<CornerId, usize> = BTreeMap::new();
    for (corner, _) in edges.iter().flatten() {
        *uses.entry(*corner).or_default() += 1;
    }
    let mut order: Vec<(CornerId, Point)> =
        plan.corners().map(|(id, corner)| (id, corner.position)).filter(|&(_, at)| around.contains(at)).collect();
    let points = order.iter().map(|&(id, at)| GeomWithData::new([at.x, at.y], id)).collect();
    let tree = RTree::bulk_load(points);
    let may_go = |id: &CornerId| only.is_none_or(|only| only.contains(id));
    order.sort_by_key(|&(id, _)| {
        (only.is_some() && may_go(&id), std::cmp::Reverse(uses.get(&id).copied().unwrap_or(0)), id)
    });
    let mut becomes: BTreeMap<CornerId, CornerId> = BTreeMap::new();
    let mut stays: BTreeSet<CornerId> = BTreeSet::new();
    for (id, at) in order {
        if becomes.contains_key(&id) {
            continue;
        }
        stays.insert(id);
        for near in tree.locate_within_distance([at.x, at.y], tolerance_m * tolerance_m) {
            if may_go(&near.data) && !stays.contains(&near.data) {
                becomes.entry(near.data).or_insert(id);
            }
        }
    }
    becomes
}

/// The plan with corners merged; its openings still refer to the old ones.
fn with_joined(plan: &Plan, becomes: &BTreeMap<CornerId, CornerId>, moved: &BTreeSet<WallId>) -> Plan {
    let now = |id: CornerId| becomes.get(&id).copied().unwrap_or(id);
    let mut next = plan.clone();
    let walls: Vec<WallId> = plan
        .walls()
        .filter(|(_, wall)| becomes.contains_key(&wall.from) || becomes.contains_key(&wall.to))
        .map(|(id, _)| id)
        .collect();
    for id in walls {
        let Some(wall) = next.walls.get_mut(&id) else { continue };
        (wall.from, wall.to) = (now(wall.from), now(wall.to));
        if wall.from == wall.to {
            next.walls.remove(&id);
        }
    }
    let rooms: Vec<RoomId> = plan
        .rooms()
        .filter(|(_, room)| room.rings().any(|ring| ring.iter().any(|corner| becomes.contains_key(corner))))
        .map(|(id, _)| id)
        .collect();
    for id in rooms {
        let Some(shared) = next.rooms.get_mut(&id) else { continue };
        let room = Arc::make_mut(shared);
        for ring in std::iter::once(&mut room.outer).chain(&mut room.holes) {
            *ring = ring.iter().map(|&corner| now(corner)).collect();
        }
    }
    for id in becomes.keys() {
        next.corners.remove(id);
    }
    if becomes.is_empty() { next } else { without_repeated_walls(next, &becomes.values().copied().collect(), moved) }
}

/// The corners that edges pass within a tolerance, as splits and as a list; with `only`, those where the
/// corner or an end of the edge is one of these, and those on edges of `laid`.
fn near_edges(
    edges: &[Edge],
    tolerance_m: f64,
    only: Option<&BTreeSet<CornerId>>,
    laid: &BTreeSet<[CornerId; 2]>,
) -> (Splits, Vec<(CornerId, [CornerId; 2])>) {
    let known: Vec<([CornerId; 2], Segment)> = edges
        .iter()
        .filter(|[a, b]| a.0 != b.0)
        .map(|&[(a, from), (b, to)]| ([a, b], Segment::new(from, to)))
        .collect();
    let index = SegmentIndex::new(known.iter().map(|&(_, segment)| segment).collect());
    let corners: BTreeMap<CornerId, Point> =
        known.iter().flat_map(|&(ends, at)| ends.into_iter().zip([at.a, at.b])).collect();
    let mut along: BTreeMap<[CornerId; 2], Vec<(f64, CornerId)>> = BTreeMap::new();
    let mut list = Vec::new();
    for (corner, at) in corners {
        let mut near: Vec<usize> = index.near(Bounds::of([at]).inflated(tolerance_m)).collect();
        near.sort_unstable();
        for i in near {
            let (ends, segment) = known[i];
            let apart = at.distance(segment.a) > tolerance_m && at.distance(segment.b) > tolerance_m;
            let is_moved = |only: &BTreeSet<CornerId>| {
                [corner, ends[0], ends[1]].iter().any(|corner| only.contains(corner)) || laid.contains(&ends)
            };
            let concerned = only.is_none_or(is_moved);
            if concerned && !ends.contains(&corner) && apart && segment.distance(at) <= tolerance_m {
                along.entry(ends).or_default().push((segment.nearest_fraction(at), corner));
                list.push((corner, ends));
            }
        }
    }
    let splits = along
        .into_iter()
        .map(|(ends, mut inner)| {
            inner.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
            (ends, inner.into_iter().map(|(_, corner)| corner).collect())
        })
        .collect();
    (splits, list)
}

/// An edge by its ends and their positions, the lower id first.
type Edge = [(CornerId, Point); 2];

/// The bounding box, grown by a tolerance, of the given corners and all edges that end at one of them,
/// and the edges whose boxes meet it, each once, by the ids of their ends: nothing else can be affected.
/// Everything, if `None`.
fn concerned(plan: &Plan, tolerance_m: f64, only: Option<&BTreeSet<CornerId>>) -> (Bounds, Vec<Edge>) {
    let positions = Positions::new(plan);
    let located = |(a, b): (CornerId, CornerId)| -> Option<Edge> {
        let [a, b] = ordered(a, b);
        Some([(a, positions.get(a)?), (b, positions.get(b)?)])
    };
    let box_of = |edge: &Edge| Bounds::of(edge.map(|(_, at)| at));
    let mut edges: Vec<Edge> = plan_edges(plan).filter_map(located).collect();
    let around = match only {
        None => Bounds::of(plan.corners().map(|(_, corner)| corner.position)),
        Some(only) => {
            let ends = edges.iter().filter(|edge| edge.iter().any(|(corner, _)| only.contains(corner)));
            let ends = ends.flatten().map(|&(_, at)| at);
            let around = Bounds::of(only.iter().filter_map(|&id| positions.get(id)).chain(ends)).inflated(tolerance_m);
            edges.retain(|edge| box_of(edge).intersects(around));
            around
        }
    };
    edges.sort_unstable_by_key(|[(a, _), (b, _)]| (*a, *b));
    edges.dedup_by_key(|[(a, _), (b, _)]| (*a, *b));
    (around, edges)
}

/// A ring without consecutive repeats and without spikes that go somewhere and straight back.
fn without_spikes(ring: &[CornerId]) -> Arc<[CornerId]> {
    let mut kept: Vec<CornerId> = Vec::with_capacity(ring.len());
    for &corner in ring {
        kept.push(corner);
        while let [.., a, b] = kept[..]
            && a == b
        {
            kept.pop();
        }
        while let [.., a, _, b] = kept[..]
            && a == b
        {
            kept.truncate(kept.len() - 2);
        }
    }
    // The same across the start of the ring.
    loop {
        let n = kept.len();
        if n > 1 && kept[0] == kept[n - 1] {
            kept.pop();
        } else if n > 2 && kept[0] == kept[n - 2] {
            kept.truncate(n - 2);
        } else if n > 2 && kept[1] == kept[n - 1] {
            kept.remove(0);
            kept.pop();
        } else {
            return kept.into();
        }
    }
}

/// Moves hosted openings to what their edges became.
fn with_openings_in_place(before: &Plan, plan: Plan, becomes: &BTreeMap<CornerId, CornerId>) -> Plan {
    let now = |id: CornerId| becomes.get(&id).copied().unwrap_or(id);
    let mut next = plan;
    for (id, opening) in before.openings() {
        let Place::Hosted { from, to, width_m, .. } = opening.place else { continue };
        if now(from) == from && now(to) == to {
            continue;
        }
        let Some(segment) = before.opening_segment(opening) else { continue };
        let place = nearest_part(&next, &[now(from), now(to)], segment.midpoint(), width_m)
            .unwrap_or(Place::Free { from: segment.a.trimmed(), to: segment.b.trimmed() });
        if let Some(shared) = next.openings.get_mut(&id) {
            Arc::make_mut(shared).place = place;
        }
    }
    next
}
