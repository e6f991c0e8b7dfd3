//! Drawing walls and rooms, and splitting rooms by what is drawn across them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::fill::Boundary;
use crate::edit::overlay::{Overlay, overlay_paths, plan_edges};
use crate::edit::{self, EditError, fail};
use crate::geometry::polygon::{self, Location};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, Point, Segment, TOUCH_M};
use crate::plan::{CornerId, Joint, OpeningId, Place, Plan, Positions, Room, RoomId, WallId, ordered, ring_edges};
use crate::topology::plan_faces::{EdgeFaces, is_sliver};

/// The result of drawing.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub plan: Plan,
    /// The new walls, along the path.
    pub walls: Vec<WallId>,
    /// The rooms that were split and the new ones made of their parts, by id.
    pub rooms: Vec<RoomId>,
}

/// Draws a chain of walls along a path, closed if it ends where it starts.
///
/// The path shares corners with existing elements, see [the editing rules](crate::edit): it goes through
/// corners it meets, and splits what it crosses or touches. Stretches that already have a wall do not get
/// a second one.
///
/// A room that the walls cross from boundary to boundary, alone or together with walls that end freely in
/// it, is split. The largest part remains the room: it keeps identity, name, function, label and note.
/// Each other part becomes a new room of the same function, without a name or a label of its own. Walls
/// that end freely inside a room do not split it, nor do walls that would cut off a sliver (see
/// [`crate::topology::SLIVER_WIDTH_M`]). An opening pinned to the room is pinned to the part it touches.
///
/// # Errors
/// When the path has no length, a point lies outside the drawing area, the thickness is not within 0..=10
/// m, or there are already walls all along the path and nothing changes.
pub fn draw_walls(plan: &Plan, path: &[Point], thickness_m: f64) -> Result<Drawn, EditError> {
    let Overlay { plan: overlaid, chains } = overlay_paths(plan, &[path.to_vec()])?;
    let chain = chains.into_iter().next().unwrap_or_default();
    if chain.len() < 2 {
        return fail("a wall needs two different ends");
    }
    let (next, walls) = add_walls(&overlaid, &[(&chain, thickness_m)])?;
    let (next, rooms) = divide_rooms(&next, &edges_of(&chain), None)?;
    if walls.is_empty() && rooms.is_empty() {
        return fail("a wall stands here already");
    }
    Ok(Drawn { plan: next, walls, rooms })
}

/// Draws a room with this boundary; the first point is not repeated. Corners are shared as in
/// [`draw_walls`]; with a thickness in metres, walls are added along it where there are none. Rooms it
/// overlaps are unchanged.
///
/// # Errors
/// When the boundary crosses or touches itself, encloses nothing, lies outside the drawing area, or is
/// already that of a room.
pub fn draw_room(plan: &Plan, outer: &[Point], wall_thickness_m: Option<f64>) -> Result<(Plan, RoomId), EditError> {
    let (overlaid, ring) = overlay_ring(plan, outer)?;
    let same: BTreeSet<CornerId> = ring.iter().copied().collect();
    let is_same = |room: &Room| room.outer.len() == ring.len() && room.outer.iter().all(|corner| same.contains(corner));
    if let Some((_, room)) = overlaid.rooms().find(|(_, room)| is_same(room)) {
        return fail(format!("{} has this boundary already", named(room)));
    }
    let (next, id) = edit::add_room(&overlaid, Room { outer: ring.as_slice().into(), ..Room::default() })?;
    match wall_thickness_m {
        Some(thickness_m) => Ok((add_walls(&next, &[(&closed(&ring), thickness_m)])?.0, id)),
        None => Ok((next, id)),
    }
}

/// Splits a room along a path, without adding walls; for which part remains the room, see [`draw_walls`].
/// Returns the new rooms.
///
/// # Errors
/// When the room does not exist, or the path does not cross it from boundary to boundary.
pub fn split_room(plan: &Plan, room: RoomId, path: &[Point]) -> Result<(Plan, Vec<RoomId>), EditError> {
    split_room_by(plan, room, path, None)
}

/// As [`split_room`]; with a thickness in metres, walls are added along the line where it divides the room.
///
/// # Errors
/// As [`split_room`], and when the thickness is not within 0..=10 m.
pub fn split_room_by(
    plan: &Plan,
    room: RoomId,
    path: &[Point],
    wall_thickness_m: Option<f64>,
) -> Result<(Plan, Vec<RoomId>), EditError> {
    edit::require_room(plan, room)?;
    let Overlay { plan: overlaid, chains } = overlay_paths(plan, &[path.to_vec()])?;
    let chain = chains.into_iter().next().unwrap_or_default();
    let (next, mut rooms) = divide_rooms(&overlaid, &edges_of(&chain), Some(room))?;
    rooms.retain(|&id| id != room);
    if rooms.is_empty() {
        return fail("the line must cross the room from boundary to boundary");
    }
    let next = without_leftovers(plan, &next, added(plan, &chain));
    let parts = rooms.iter().copied().chain([room]);
    Ok((with_walls_within(plan, room, &next, &chain, parts, wall_thickness_m)?, rooms))
}

/// Adds walls along a chain of corners, where it bounds one of the parts that a room was divided into and did
/// not bound the room.
fn with_walls_within(
    before: &Plan,
    room: RoomId,
    plan: &Plan,
    chain: &[CornerId],
    parts: impl Iterator<Item = RoomId>,
    wall_thickness_m: Option<f64>,
) -> Result<Plan, EditError> {
    let (Some(thickness_m), Some(whole)) = (wall_thickness_m, before.room(room)) else { return Ok(plan.clone()) };
    let inside = Inside::new(before, whole);
    let bounds: BTreeSet<[CornerId; 2]> = parts.filter_map(|id| plan.room(id)).flat_map(room_edges).collect();
    let mut next = plan.clone();
    for pair in chain.windows(2) {
        let middle = plan.position(pair[0]).zip(plan.position(pair[1])).map(|(a, b)| a.midpoint(b));
        if bounds.contains(&ordered(pair[0], pair[1])) && middle.is_some_and(|middle| inside.holds(middle)) {
            next = add_walls(&next, &[(pair, thickness_m)])?.0;
        }
    }
    Ok(next)
}

/// Cuts an area out of a room: a courtyard or a shaft becomes a hole, or a notch at the boundary. If the
/// room falls apart, it is split as by [`draw_walls`].
///
/// # Errors
/// When the room does not exist, the boundary crosses itself or encloses nothing, the area lies outside
/// the room, or nothing of the room would be left.
pub fn cut_out(plan: &Plan, room: RoomId, outer: &[Point]) -> Result<Plan, EditError> {
    cut_out_by(plan, room, outer, None)
}

/// As [`cut_out`]; with a thickness in metres, walls are added along what becomes boundary of the room.
///
/// # Errors
/// As [`cut_out`], and when the thickness is not within 0..=10 m.
pub fn cut_out_by(
    plan: &Plan,
    room: RoomId,
    outer: &[Point],
    wall_thickness_m: Option<f64>,
) -> Result<Plan, EditError> {
    edit::require_room(plan, room)?;
    let (overlaid, ring) = overlay_ring(plan, outer)?;
    let Some(shape) = overlaid.room(room) else { return Ok(overlaid) };
    let inside = Inside::new(&overlaid, shape);
    let cut = overlaid.ring_points(&ring);
    let mut edges = room_edges(shape);
    edges.extend(edges_of(&closed(&ring)));
    let faces = EdgeFaces::new(&overlaid, edges)?;
    let in_room: Vec<usize> = (0..faces.count()).filter(|&i| inside.holds(faces.interior_point(i))).collect();
    let is_cut = |i: usize| polygon::locate_in_ring(&cut, faces.interior_point(i)) == Location::Inside;
    let left: Vec<usize> = in_room.iter().copied().filter(|&i| !is_cut(i)).collect();
    if left.len() == in_room.len() {
        return fail("this area lies outside the room");
    }
    let left: Vec<usize> = left
        .into_iter()
        .filter(|&i| {
            let (outer, holes) = faces.positions(i);
            !is_sliver(&outer, &holes)
        })
        .collect();
    if left.is_empty() {
        return fail("nothing of the room would be left");
    }
    let (next, new_rooms) = replace_by_parts(room, &faces, &left)?;
    let boundary = shape.rings().flat_map(|ring| ring.iter().copied());
    let next = without_leftovers(plan, &next, added(plan, &ring).chain(boundary));
    let parts = new_rooms.into_iter().chain([room]);
    with_walls_within(plan, room, &next, &closed(&ring), parts, wall_thickness_m)
}

/// A room's name in messages.
pub(crate) fn named(room: &Room) -> String {
    if room.name.is_empty() { "a room".to_owned() } else { format!("the room '{}'", room.name) }
}

/// Overlays the boundary of a room and returns its corners.
///
/// # Errors
/// When it crosses or touches itself, or encloses nothing.
pub(crate) fn overlay_ring(plan: &Plan, outer: &[Point]) -> Result<(Plan, Vec<CornerId>), EditError> {
    let mut path = outer.to_vec();
    path.extend(outer.first());
    let Overlay { plan: overlaid, chains } = overlay_paths(plan, &[path])?;
    let mut ring = chains.into_iter().next().unwrap_or_default();
    if ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    // Overlaid paths share a corner wherever they meet.
    if ring.len() > 3 && ring.iter().collect::<BTreeSet<_>>().len() < ring.len() {
        return fail("the boundary crosses or touches itself");
    }
    let points = overlaid.ring_points(&ring);
    // Twice the area over the perimeter is the mean width.
    if ring.len() < 3 || 2.0 * polygon::signed_area(&points).abs() < TOUCH_M * polygon::perimeter(&points) {
        return fail("the boundary encloses nothing");
    }
    Ok((overlaid, ring))
}

/// The corners of a ring with the first repeated at the end.
pub(crate) fn closed(ring: &[CornerId]) -> Vec<CornerId> {
    ring.iter().chain(ring.first()).copied().collect()
}

/// The edges along a chain of corners.
pub(crate) fn edges_of(chain: &[CornerId]) -> BTreeSet<[CornerId; 2]> {
    chain.windows(2).map(|pair| ordered(pair[0], pair[1])).collect()
}

pub(crate) fn room_edges(room: &Room) -> BTreeSet<[CornerId; 2]> {
    room.rings().flat_map(|ring| ring_edges(ring)).map(|(a, b)| ordered(a, b)).collect()
}

/// Adds walls with a thickness in metres along chains of corners where there are none yet, and returns
/// them.
pub(crate) fn add_walls(plan: &Plan, chains: &[(&[CornerId], f64)]) -> Result<(Plan, Vec<WallId>), EditError> {
    let mut missing: BTreeSet<[CornerId; 2]> = chains.iter().flat_map(|(chain, _)| edges_of(chain)).collect();
    for (_, wall) in plan.walls() {
        missing.remove(&ordered(wall.from, wall.to));
    }
    let mut next = plan.clone();
    let mut walls = Vec::new();
    for &(chain, thickness_m) in chains {
        for pair in chain.windows(2) {
            if missing.remove(&ordered(pair[0], pair[1])) {
                let (with_wall, id) = edit::add_wall(&next, pair[0], pair[1], thickness_m)?;
                next = with_wall;
                walls.push(id);
            }
        }
    }
    Ok((next, walls))
}

/// The interior of a room, for testing whether points lie in it.
pub(crate) struct Inside {
    outer: Vec<Point>,
    holes: Vec<Vec<Point>>,
    bounds: Bounds,
}

impl Inside {
    pub fn new(plan: &Plan, room: &Room) -> Self {
        let outer = plan.ring_points(&room.outer);
        let bounds = polygon::bounds(&outer);
        Self { outer, holes: room.holes.iter().map(|hole| plan.ring_points(hole)).collect(), bounds }
    }

    pub fn holds(&self, point: Point) -> bool {
        self.bounds.contains(point) && polygon::locate(&self.outer, &self.holes, point) == Location::Inside
    }
}

/// Splits the rooms that new edges cross (or only the given one), and returns the rooms split and the new
/// ones, by id.
pub(crate) fn divide_rooms(
    plan: &Plan,
    new_edges: &BTreeSet<[CornerId; 2]>,
    only: Option<RoomId>,
) -> Result<(Plan, Vec<RoomId>), EditError> {
    let middle = |&[a, b]: &[CornerId; 2]| Some(plan.position(a)?.midpoint(plan.position(b)?));
    let middles: Vec<Point> = new_edges.iter().filter_map(middle).collect();
    let around = Bounds::of(middles.iter().copied());
    let positions = Positions::new(plan);
    let crossed: Vec<RoomId> = plan
        .rooms()
        .filter(|(id, room)| {
            // Bounding boxes first: most rooms of a large plan are far away.
            only.is_none_or(|only| only == *id) && {
                let bounds = Bounds::of(room.outer.iter().filter_map(|&corner| positions.get(corner)));
                bounds.intersects(around) && middles.iter().any(|&middle| bounds.contains(middle))
            }
        })
        .map(|(id, _)| id)
        .collect();
    if crossed.is_empty() {
        return Ok((plan.clone(), Vec::new()));
    }
    let edges = NearEdges::new(plan, new_edges);
    let mut next = plan.clone();
    let mut touched = Vec::new();
    for id in crossed {
        if let Some((divided, new_rooms)) = divide_room(&next, id, &edges)? {
            next = divided;
            touched.push(id);
            touched.extend(new_rooms);
        }
    }
    touched.sort_unstable();
    Ok((next, touched))
}

/// A spatial index of the new edges and the walls of a plan: a path may cross many rooms, and each looks
/// only at what is near it.
struct NearEdges<'a> {
    new_edges: &'a BTreeSet<[CornerId; 2]>,
    edges: Vec<[CornerId; 2]>,
    index: SegmentIndex,
}

impl<'a> NearEdges<'a> {
    fn new(plan: &Plan, new_edges: &'a BTreeSet<[CornerId; 2]>) -> Self {
        let walls = plan.walls().map(|(_, wall)| ordered(wall.from, wall.to));
        let positions = Positions::new(plan);
        let known = walls.chain(new_edges.iter().copied()).filter_map(|[a, b]| {
            let segment = Segment::new(positions.get(a)?, positions.get(b)?);
            Some(([a, b], segment))
        });
        let (edges, segments): (Vec<_>, Vec<_>) = known.unzip();
        Self { new_edges, edges, index: SegmentIndex::new(segments) }
    }
}

/// Splits a room along new edges and the walls that end freely in it; `None` if it stays whole.
fn divide_room(plan: &Plan, id: RoomId, near: &NearEdges) -> Result<Option<(Plan, Vec<RoomId>)>, EditError> {
    let Some(room) = plan.room(id) else { return Ok(None) };
    let inside = Inside::new(plan, room);
    let boundary = room_edges(room);
    let within = near.index.near(inside.bounds).filter(|&i| inside.holds(near.index.get(i).midpoint()));
    let within: BTreeSet<[CornerId; 2]> =
        within.map(|i| near.edges[i]).filter(|edge| !boundary.contains(edge)).collect();
    let (mut new_within, walls): (BTreeSet<[CornerId; 2]>, BTreeSet<[CornerId; 2]>) =
        within.into_iter().partition(|edge| near.new_edges.contains(edge));
    if new_within.is_empty() {
        return Ok(None);
    }
    let mut before: BTreeSet<[CornerId; 2]> = walls.union(&boundary).copied().collect();
    let in_room = |faces: &EdgeFaces| -> Vec<usize> {
        (0..faces.count()).filter(|&i| inside.holds(faces.interior_point(i))).collect()
    };
    // Walls that already divide the room do not count: it spans them, and continues to.
    let parts_before = loop {
        let faces = EdgeFaces::new(plan, before.iter().copied())?;
        let parts = in_room(&faces);
        let mut once: BTreeSet<[CornerId; 2]> = BTreeSet::new();
        let around = parts.iter().flat_map(|&part| faces.edges_around(part));
        let dividing: Vec<[CornerId; 2]> =
            around.filter(|edge| !boundary.contains(edge) && !once.insert(*edge)).collect();
        if parts.len() < 2 || dividing.is_empty() {
            break parts.len();
        }
        for edge in dividing {
            before.remove(&edge);
        }
    };
    loop {
        let faces = EdgeFaces::new(plan, before.union(&new_within).copied())?;
        let parts = in_room(&faces);
        if parts.len() <= parts_before.max(1) {
            return Ok(None);
        }
        // A sliver is joined with what lies across the new edges around it.
        let sliver = parts.iter().copied().find(|&i| {
            let (outer, holes) = faces.positions(i);
            is_sliver(&outer, &holes) && faces.edges_around(i).iter().any(|edge| new_within.contains(edge))
        });
        let Some(sliver) = sliver else { return replace_by_parts(id, &faces, &parts).map(Some) };
        for edge in faces.edges_around(sliver) {
            new_within.remove(&edge);
        }
    }
}

/// Gives a room the largest of its parts (faces) and makes new rooms of the others; returns the new rooms
/// in the order of the parts.
fn replace_by_parts(id: RoomId, faces: &EdgeFaces, parts: &[usize]) -> Result<(Plan, Vec<RoomId>), EditError> {
    let area = |i: usize| {
        let (outer, holes) = faces.positions(i);
        polygon::area(&outer, &holes)
    };
    let mut parts = parts.to_vec();
    // Stable: ties stay in the order of the faces.
    parts.sort_by(|&p, &q| area(q).total_cmp(&area(p)));
    let (mut next, boundaries) = faces.boundaries(&parts)?;
    let function = next.room(id).map(|room| room.function.clone()).unwrap_or_default();
    let mut new_rooms = Vec::new();
    for (i, Boundary { outer, holes }) in boundaries.into_iter().enumerate() {
        if i == 0 {
            next = edit::change_room(&next, id, |room| {
                room.outer = outer;
                room.holes = holes;
            })?;
        } else {
            let room = Room { outer, holes, function: function.clone(), ..Room::default() };
            let (with_room, new_id) = edit::add_room(&next, room)?;
            next = with_room;
            new_rooms.push(new_id);
        }
    }
    Ok((pinned_to_parts(&next, id, &new_rooms), new_rooms))
}

/// Pins openings that were pinned to a split room to the part they touch.
fn pinned_to_parts(plan: &Plan, id: RoomId, new_rooms: &[RoomId]) -> Plan {
    let pinned: Vec<OpeningId> = plan
        .openings()
        .filter(|(_, opening)| opening.pinned.iter().flatten().any(|joint| joint.room() == Some(id)))
        .map(|(id, _)| id)
        .collect();
    let mut next = plan.clone();
    for opening in pinned {
        let Some(middle) = plan.opening(opening).and_then(|o| plan.opening_segment(o)).map(|s| s.midpoint()) else {
            continue;
        };
        let distance = |part: RoomId| {
            let rings = plan.room(part).into_iter().flat_map(Room::rings).map(|ring| plan.ring_points(ring));
            rings
                .flat_map(|ring| polygon::edges(&ring).collect::<Vec<_>>())
                .map(|edge| edge.distance(middle))
                .fold(f64::INFINITY, f64::min)
        };
        let parts = std::iter::once(id).chain(new_rooms.iter().copied());
        let nearest = parts.map(|part| (distance(part), part)).min_by(|p, q| p.0.total_cmp(&q.0));
        if let (Some((_, nearest)), Some(shared)) = (nearest, next.openings.get_mut(&opening))
            && nearest != id
        {
            for joint in Arc::make_mut(shared).pinned.iter_mut().flatten() {
                if *joint == Joint::Room(id) {
                    *joint = Joint::Room(nearest);
                }
            }
        }
    }
    next
}

/// `after` without the openings whose edge belonged to a wall or room in `before` and no longer does, and
/// without those of the given corners that are unused.
pub(crate) fn without_leftovers(before: &Plan, after: &Plan, corners: impl IntoIterator<Item = CornerId>) -> Plan {
    let mut unused: BTreeSet<CornerId> = corners.into_iter().collect();
    let mut hosts: BTreeMap<[CornerId; 2], Vec<OpeningId>> = BTreeMap::new();
    for (id, opening) in after.openings() {
        if let Place::Hosted { from, to, .. } = opening.place {
            hosts.entry(ordered(from, to)).or_default().push(id);
        }
    }
    let mut lost = hosts.clone();
    for (a, b) in plan_edges(after) {
        lost.remove(&ordered(a, b));
        unused.remove(&a);
        unused.remove(&b);
    }
    let mut next = after.clone();
    if !lost.is_empty() {
        let had_edge = |id: &OpeningId| {
            // An opening moved by splitting is identified by its former edge.
            let Some(Place::Hosted { from, to, .. }) = before.opening(*id).map(|opening| opening.place) else {
                return true;
            };
            plan_edges(before).any(|(a, b)| ordered(a, b) == ordered(from, to))
        };
        for (edge, openings) in lost {
            let gone: Vec<OpeningId> = openings.into_iter().filter(had_edge).collect();
            for id in &gone {
                next.openings.remove(id);
            }
            if let Some(on_edge) = hosts.get_mut(&edge) {
                on_edge.retain(|id| !gone.contains(id));
            }
        }
    }
    for (edge, _) in hosts.iter().filter(|(_, openings)| !openings.is_empty()) {
        for corner in edge {
            unused.remove(corner);
        }
    }
    for id in unused {
        next.corners.remove(&id);
    }
    next
}

/// The given corners that are not in a plan: those an edit added.
pub(crate) fn added<'a>(before: &'a Plan, corners: &'a [CornerId]) -> impl Iterator<Item = CornerId> + 'a {
    corners.iter().copied().filter(|&id| before.corner(id).is_none())
}
