//! Parallel copies of walls and boundaries.

use std::collections::{BTreeMap, BTreeSet};

use crate::edit::draw::{Drawn, draw_walls};
use crate::edit::{self, EditError, fail};
use crate::geometry::path::parallel;
use crate::geometry::{Point, Segment, polygon};
use crate::plan::{CornerId, Plan, RoomId, WallId};

/// Draws walls parallel to the given ones, at a distance in metres, on the side of the nearest one where
/// the point `towards` lies. Consecutive walls are mitred where they join, all the way round in closed
/// chains; where more than two meet, chains end. Each copy is as thick as its original; if a sharp corner
/// is cut off, all of a chain are as thick as its first.
///
/// # Errors
/// When a wall does not exist, or the distance is not above 0 or too large for one of the walls.
pub fn offset_walls(plan: &Plan, walls: &[WallId], distance_m: f64, towards: Point) -> Result<Drawn, EditError> {
    check_distance(distance_m)?;
    let mut drawn = Drawn { plan: plan.clone(), walls: Vec::new(), rooms: Vec::new() };
    for chain in chains(plan, walls)? {
        draw_parallel(plan, &mut drawn, &chain, distance_m, towards)?;
    }
    if drawn.walls.is_empty() {
        return fail("walls stand there already");
    }
    drawn.rooms.sort_unstable();
    drawn.rooms.dedup();
    Ok(drawn)
}

/// Draws walls parallel to a room's outer boundary, at a distance in metres inside or outside it.
///
/// # Errors
/// When the room does not exist or has no boundary, the distance is not above 0 or too large for one of
/// its sides, or the thickness is not within 0..=10 m.
pub fn offset_room(
    plan: &Plan,
    room: RoomId,
    distance_m: f64,
    is_inside: bool,
    thickness_m: f64,
) -> Result<Drawn, EditError> {
    edit::require_room(plan, room)?;
    check_distance(distance_m)?;
    let ring = plan.room(room).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
    draw_walls(plan, &path_beside(&ring, distance_m, is_inside)?, thickness_m)
}

fn check_distance(distance_m: f64) -> Result<(), EditError> {
    if distance_m > 0.0 && distance_m.is_finite() {
        return Ok(());
    }
    fail(format!("the distance of a parallel is above 0 m, not {distance_m} m"))
}

/// The chains that walls form.
fn chains(plan: &Plan, walls: &[WallId]) -> Result<Vec<Chain>, EditError> {
    let mut by_corner: BTreeMap<CornerId, Vec<WallId>> = BTreeMap::new();
    let mut left: BTreeSet<WallId> = walls.iter().copied().collect();
    for &id in &left {
        let Some(wall) = plan.wall(id) else { return fail(format!("{id} does not exist")) };
        for corner in [wall.from, wall.to] {
            by_corner.entry(corner).or_default().push(id);
        }
    }
    let mut chains = Vec::new();
    while let Some(start) = first_of_chain(plan, &left, &by_corner) {
        chains.push(chain_from(plan, start, &mut left, &by_corner));
    }
    Ok(chains)
}

/// The corner to start the next chain at, and the first wall from there: a dead end or a junction if
/// there is one, else any corner of a closed chain.
fn first_of_chain(
    plan: &Plan,
    left: &BTreeSet<WallId>,
    by_corner: &BTreeMap<CornerId, Vec<WallId>>,
) -> Option<(CornerId, WallId)> {
    let ends = |id: &WallId| plan.wall(*id).map(|wall| [wall.from, wall.to]).into_iter().flatten();
    let starts = left.iter().flat_map(|id| ends(id).map(move |corner| (corner, *id)));
    let is_end = |corner: &CornerId| by_corner.get(corner).is_some_and(|walls| walls.len() != 2);
    let mut closed = None;
    for (corner, id) in starts {
        if is_end(&corner) {
            return Some((corner, id));
        }
        closed.get_or_insert((corner, id));
    }
    closed
}

/// A chain of walls: its corners, one more than its walls.
struct Chain {
    corners: Vec<CornerId>,
    walls: Vec<WallId>,
}

/// The consecutive walls from a corner on, removed from those left.
fn chain_from(
    plan: &Plan,
    (start, first): (CornerId, WallId),
    left: &mut BTreeSet<WallId>,
    by_corner: &BTreeMap<CornerId, Vec<WallId>>,
) -> Chain {
    let mut chain = Chain { corners: vec![start], walls: Vec::new() };
    let (mut at, mut next) = (start, Some(first));
    while let Some(id) = next.filter(|id| left.remove(id)) {
        let Some(wall) = plan.wall(id) else { break };
        at = if wall.from == at { wall.to } else { wall.from };
        chain.corners.push(at);
        chain.walls.push(id);
        let here = by_corner.get(&at).map(Vec::as_slice).unwrap_or_default();
        next = if here.len() == 2 { here.iter().copied().find(|id| left.contains(id)) } else { None };
    }
    chain
}

/// The parallel of a chain, with the thickness of each of its pieces.
fn parallel_of(plan: &Plan, chain: &Chain, distance_m: f64, towards: Point) -> Result<Parallel, EditError> {
    let mut points = plan.ring_points(&chain.corners);
    let pieces = points.windows(2).map(|pair| Segment::new(pair[0], pair[1]));
    let nearest = pieces.min_by(|p, q| p.distance(towards).total_cmp(&q.distance(towards)));
    let Some(nearest) = nearest else { return Ok((Vec::new(), Vec::new())) };
    let is_left = polygon::orientation(nearest.a, nearest.b, towards) >= 0.0;
    let is_closed = chain.corners.len() > 3 && chain.corners.first() == chain.corners.last();
    if is_closed {
        points.pop();
    }
    let Some(mut path) = parallel(&points, is_closed, if is_left { distance_m } else { -distance_m }) else {
        return fail("the distance is too large for one of the walls");
    };
    if is_closed {
        path.extend(path.first().copied());
    }
    let thickness_m = |id: &WallId| plan.wall(*id).map_or(0.0, |wall| wall.thickness_m);
    let is_mitred = path.len() == chain.walls.len() + 1;
    let original = |i: usize| if is_mitred { chain.walls.get(i) } else { chain.walls.first() };
    let thicknesses_m = (0..path.len().saturating_sub(1)).map(|i| original(i).map_or(0.0, thickness_m)).collect();
    Ok((path, thicknesses_m))
}

/// A path, and how thick each of its pieces is, in metres.
type Parallel = (Vec<Point>, Vec<f64>);

/// Draws the parallel of a chain wall by wall, each as thick as its original.
fn draw_parallel(
    plan: &Plan,
    drawn: &mut Drawn,
    chain: &Chain,
    distance_m: f64,
    towards: Point,
) -> Result<(), EditError> {
    let (path, thicknesses_m) = parallel_of(plan, chain, distance_m, towards)?;
    for (pair, thickness_m) in path.windows(2).zip(thicknesses_m) {
        // Where there is already a wall, none is needed.
        if let Ok(more) = draw_walls(&drawn.plan, pair, thickness_m) {
            drawn.plan = more.plan;
            drawn.walls.extend(more.walls);
            drawn.rooms.extend(more.rooms);
        }
    }
    Ok(())
}

/// What [`offset_walls`] of these walls or, if there are none, [`offset_room`] of a room is measured from.
pub fn lines_to_offset(plan: &Plan, walls: &[WallId], room: Option<RoomId>) -> Vec<Segment> {
    if walls.is_empty() {
        let ring = room.and_then(|room| plan.room(room)).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
        return polygon::edges(&ring).collect();
    }
    walls.iter().filter_map(|&id| plan.wall_segment(plan.wall(id)?)).collect()
}

/// The walls that [`offset_walls`] or [`offset_room`] would draw, as segments with their thickness in metres: for a
/// preview. `thickness_m` is that of the walls beside a room.
///
/// # Errors
/// As for these two.
pub fn offset_paths(
    plan: &Plan,
    walls: &[WallId],
    room: Option<RoomId>,
    distance_m: f64,
    towards: Point,
    thickness_m: f64,
) -> Result<Vec<(Segment, f64)>, EditError> {
    check_distance(distance_m)?;
    let pieces =
        |path: &[Point]| -> Vec<Segment> { path.windows(2).map(|pair| Segment::new(pair[0], pair[1])).collect() };
    if walls.is_empty() {
        let ring = room.and_then(|room| plan.room(room)).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
        let is_inside = polygon::locate_in_ring(&ring, towards) != polygon::Location::Outside;
        let path = path_beside(&ring, distance_m, is_inside)?;
        return Ok(pieces(&path).into_iter().map(|piece| (piece, thickness_m)).collect());
    }
    let mut found = Vec::new();
    for chain in chains(plan, walls)? {
        let (path, thicknesses_m) = parallel_of(plan, &chain, distance_m, towards)?;
        found.extend(pieces(&path).into_iter().zip(thicknesses_m));
    }
    Ok(found)
}

/// The closed path beside a ring.
fn path_beside(ring: &[Point], distance_m: f64, is_inside: bool) -> Result<Vec<Point>, EditError> {
    let is_left = (polygon::signed_area(ring) > 0.0) == is_inside;
    let Some(mut path) = parallel(ring, true, if is_left { distance_m } else { -distance_m }) else {
        return fail("the distance is too large for this boundary");
    };
    path.extend(path.first().copied());
    Ok(path)
}
