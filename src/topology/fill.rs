//! Rooms from walls: the edits that fill the faces which walls enclose.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::RoomShapes;
use super::arrangement::{Arrangement, NodeIndex};
use super::exact::GridPoint;
use super::faces::{Face, faces};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Point, Segment, trim_m};
use crate::plan::edit::{self, EditError};
use crate::plan::{CornerId, OpeningId, Place, Plan, Room, RoomId, WallId};

/// A face narrower than this on average (twice its area over its perimeter), in metres, is a sliver
/// between lines that should be one, not a room. The smallest of 5,355 rooms in real dwellings are
/// pipe shafts of 0.06 m², on average 0.12 m wide; lines that miss each other by a few millimetres
/// leave slivers below 0.01 m.
pub const SLIVER_WIDTH_M: f64 = 0.05;

/// What an edit that fills faces gives.
#[derive(Clone, Debug)]
pub struct Filled {
    pub plan: Plan,
    /// The new rooms.
    pub rooms: Vec<RoomId>,
}

/// A face that walls and boundaries of rooms enclose in a plan.
#[derive(Clone, Debug)]
pub struct PlanFace {
    face: Face,
    /// The outer boundary in metres, counter-clockwise.
    pub outer: Vec<Point>,
    /// The boundaries of what lies inside, clockwise.
    pub holes: Vec<Vec<Point>>,
    /// Whether walls alone enclose it; else boundaries of rooms without walls do so too.
    pub by_walls: bool,
    /// The rooms that cover it.
    pub rooms: Vec<RoomId>,
}

impl PlanFace {
    /// Area in m².
    pub fn area_m2(&self) -> f64 {
        polygon::area(&self.outer, &self.holes)
    }

    /// Whether it is too narrow for a room, see [`SLIVER_WIDTH_M`].
    pub fn is_sliver(&self) -> bool {
        let perimeter_m: f64 =
            polygon::perimeter(&self.outer) + self.holes.iter().map(|h| polygon::perimeter(h)).sum::<f64>();
        2.0 * self.area_m2() < SLIVER_WIDTH_M * perimeter_m
    }
}

/// All faces that the walls of a plan and the boundaries of its rooms enclose: to show what a click
/// would fill, and to fill it.
#[derive(Debug)]
pub struct PlanFaces<'a> {
    plan: &'a Plan,
    arrangement: Arrangement,
    /// The edges of walls and boundaries, by their corners, the smaller first: in the order of the
    /// arrangement's segments.
    edges: Vec<[CornerId; 2]>,
    faces: Vec<PlanFace>,
}

impl<'a> PlanFaces<'a> {
    /// The faces of a plan.
    ///
    /// # Errors
    /// When the walls meet more often than [`super::PASSINGS_LIMIT`].
    pub fn new(plan: &'a Plan) -> Result<Self, EditError> {
        // Whether each edge is a wall.
        let mut by_corners: BTreeMap<[CornerId; 2], bool> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            for ring in room.rings() {
                by_corners.extend(ring_edges(ring).map(|(a, b)| (ordered(a, b), false)));
            }
        }
        by_corners.extend(plan.walls().map(|(_, wall)| (ordered(wall.from, wall.to), true)));
        let (mut edges, mut segments, mut is_wall) = (Vec::new(), Vec::new(), Vec::new());
        for (&[a, b], &wall) in &by_corners {
            if let (Some(from), Some(to)) = (plan.position(a), plan.position(b)) {
                edges.push([a, b]);
                segments.push(Segment::new(from, to));
                is_wall.push(wall);
            }
        }
        let arrangement = Arrangement::new(&segments)
            .map_err(|error| EditError(format!("the faces between the walls cannot be found: {error}")))?;
        let mut walled: BTreeSet<[NodeIndex; 2]> = BTreeSet::new();
        for i in (0..edges.len()).filter(|&i| is_wall[i]) {
            walled.extend(arrangement.chain(i).windows(2).map(|pair| link(pair[0], pair[1])));
        }
        let shapes = RoomShapes::new(plan);
        let faces = faces(&arrangement)
            .into_iter()
            .map(|face| {
                let (outer, holes) = face.positions(&arrangement);
                let inside = face.interior_point(&arrangement);
                let rooms = shapes.at(inside).into_iter().map(|index| shapes.all()[index].id).collect();
                let by_walls =
                    face.rings().flat_map(|ring| ring_edges(ring)).all(|(u, v)| walled.contains(&link(u, v)));
                PlanFace { face, outer, holes, by_walls, rooms }
            })
            .collect();
        Ok(Self { plan, arrangement, edges, faces })
    }

    /// All faces, in a fixed order.
    pub fn all(&self) -> &[PlanFace] {
        &self.faces
    }

    /// Index in [`PlanFaces::all`] of the face around a point; `None` on a wall and where nothing
    /// encloses it.
    pub fn at(&self, point: Point) -> Option<usize> {
        self.faces.iter().position(|face| {
            polygon::bounds(&face.outer).contains(point)
                && polygon::locate(&face.outer, &face.holes, point) == Location::Inside
        })
    }

    /// Makes a room of each of the faces with these indices in [`PlanFaces::all`].
    ///
    /// The room's corners are those that walls and boundaries have there, and new ones where these
    /// cross. A wall or a boundary that runs through a corner without having it is split there, so
    /// that the corner is shared; its openings keep their places. The first part of a split wall
    /// keeps the wall's identity.
    ///
    /// # Errors
    /// When an index is beyond the last face.
    pub fn fill(&self, indices: &[usize]) -> Result<Filled, EditError> {
        let indices: BTreeSet<usize> = indices.iter().copied().collect();
        if let Some(beyond) = indices.iter().find(|&&index| index >= self.faces.len()) {
            return Err(EditError(format!("there is no face {beyond}")));
        }
        let chosen = || indices.iter().map(|&index| &self.faces[index].face);
        let mut corners = self.corners_at_nodes();
        let mut next = self.plan.clone();
        for &node in chosen().flat_map(Face::rings).flatten() {
            let corner = &mut corners[node as usize];
            if corner.is_none() {
                let (with_corner, id) = edit::add_corner(&next, self.arrangement.position(node))?;
                (next, *corner) = (with_corner, Some(id));
            }
        }
        let mut used = vec![false; self.arrangement.node_count()];
        for &node in chosen().flat_map(Face::rings).flatten() {
            used[node as usize] = true;
        }
        let mut splits = Splits::new();
        for (i, &ends) in self.edges.iter().enumerate() {
            let chain = self.arrangement.chain(i);
            let inner = chain.get(1..chain.len().saturating_sub(1)).unwrap_or_default();
            let inner: Vec<CornerId> =
                inner.iter().filter(|&&node| used[node as usize]).filter_map(|&node| corners[node as usize]).collect();
            if !inner.is_empty() {
                splits.insert(ends, inner);
            }
        }
        let mut next = split_edges(&next, &splits)?;
        let mut rooms = Vec::with_capacity(indices.len());
        for face in chosen() {
            let ring = |nodes: &Vec<NodeIndex>| -> Arc<[CornerId]> {
                nodes.iter().filter_map(|&node| corners[node as usize]).collect()
            };
            let room =
                Room { outer: ring(&face.outer), holes: face.holes.iter().map(ring).collect(), ..Room::default() };
            let (with_room, id) = edit::add_room(&next, room)?;
            next = with_room;
            rooms.push(id);
        }
        Ok(Filled { plan: next, rooms })
    }

    /// The plan's corner at each node, if it has one there: of several in one place one at the end
    /// of an edge, and of those the smallest.
    fn corners_at_nodes(&self) -> Vec<Option<CornerId>> {
        let nodes = self.arrangement.grid_points();
        let mut corners: Vec<Option<CornerId>> = vec![None; nodes.len()];
        let ends: BTreeSet<CornerId> = self.edges.iter().flatten().copied().collect();
        let others = self.plan.corners().map(|(id, _)| id).filter(|id| !ends.contains(id));
        for id in ends.iter().copied().chain(others) {
            let place = self.plan.position(id).and_then(GridPoint::nearest);
            if let Some(node) = place.and_then(|place| nodes.binary_search(&place).ok()) {
                corners[node].get_or_insert(id);
            }
        }
        corners
    }
}

/// Fills the face around a point with a room. Walls and the boundaries of rooms enclose it.
///
/// # Errors
/// When nothing encloses the point, or a room is there already.
pub fn fill_at(plan: &Plan, point: Point) -> Result<Filled, EditError> {
    let faces = PlanFaces::new(plan)?;
    let Some(index) = faces.at(point) else {
        return Err(EditError("no walls enclose this place: look for an end that meets no other wall".to_owned()));
    };
    if let Some(&room) = faces.all()[index].rooms.first() {
        let name = plan.room(room).map(|room| room.name.as_str()).filter(|name| !name.is_empty());
        return Err(EditError(match name {
            Some(name) => format!("the room '{name}' is here already"),
            None => "a room is here already".to_owned(),
        }));
    }
    faces.fill(&[index])
}

/// Fills every face that walls alone enclose, where no room is yet and that is no sliver. What lies
/// between drawn rooms without walls stays empty: it may be the thickness of a wall.
///
/// # Errors
/// When the walls meet more often than [`super::PASSINGS_LIMIT`].
pub fn fill_all(plan: &Plan) -> Result<Filled, EditError> {
    let faces = PlanFaces::new(plan)?;
    let empty: Vec<usize> = (0..faces.all().len())
        .filter(|&index| {
            let face = &faces.all()[index];
            face.by_walls && face.rooms.is_empty() && !face.is_sliver()
        })
        .collect();
    faces.fill(&empty)
}

/// The corners to insert into edges: by the edge's corners, the smaller first, in the order from
/// that to the larger.
type Splits = BTreeMap<[CornerId; 2], Vec<CornerId>>;

/// The corners from one end of an edge to the other, both included; `None` when it is not split.
fn split_chain(splits: &Splits, from: CornerId, to: CornerId) -> Option<Vec<CornerId>> {
    let inner = splits.get(&ordered(from, to))?;
    let mut chain = vec![from];
    if from < to {
        chain.extend(inner)
    } else {
        chain.extend(inner.iter().rev())
    }
    chain.push(to);
    Some(chain)
}

/// Splits the walls and the boundaries that have these edges, and moves their openings to the right
/// part.
fn split_edges(plan: &Plan, splits: &Splits) -> Result<Plan, EditError> {
    let mut next = plan.clone();
    let walls: Vec<(WallId, Vec<CornerId>)> =
        plan.walls().filter_map(|(id, wall)| Some((id, split_chain(splits, wall.from, wall.to)?))).collect();
    for (id, chain) in walls {
        let Some(wall) = next.walls.get_mut(&id) else { continue };
        wall.to = chain[1];
        let (thickness_m, extra) = (wall.thickness_m, wall.extra.clone());
        for pair in chain.windows(2).skip(1) {
            let (with_wall, part) = edit::add_wall(&next, pair[0], pair[1], thickness_m)?;
            next = with_wall;
            if let Some(part) = next.walls.get_mut(&part) {
                part.extra.clone_from(&extra);
            }
        }
    }
    let is_split = |ring: &[CornerId]| ring_edges(ring).any(|(a, b)| splits.contains_key(&ordered(a, b)));
    let rooms: Vec<RoomId> =
        plan.rooms().filter(|(_, room)| room.rings().any(|ring| is_split(ring))).map(|(id, _)| id).collect();
    for id in rooms {
        let Some(room) = next.rooms.get_mut(&id) else { continue };
        let room = Arc::make_mut(room);
        for ring in std::iter::once(&mut room.outer).chain(&mut room.holes) {
            *ring = ring_edges(ring)
                .flat_map(|(a, b)| {
                    let mut chain = split_chain(splits, a, b).unwrap_or_else(|| vec![a, b]);
                    chain.pop();
                    chain
                })
                .collect();
        }
    }
    let openings: Vec<(OpeningId, Place)> = plan
        .openings()
        .filter_map(|(id, opening)| Some((id, place_on_part(plan, &next, splits, opening.place)?)))
        .collect();
    for (id, place) in openings {
        if let Some(opening) = next.openings.get_mut(&id) {
            Arc::make_mut(opening).place = place;
        }
    }
    Ok(next)
}

/// Where an opening on a split edge of `before` goes in `after`: on the part nearest to its middle.
fn place_on_part(before: &Plan, after: &Plan, splits: &Splits, place: Place) -> Option<Place> {
    let Place::Hosted { from, to, at_m, width_m } = place else { return None };
    let chain = split_chain(splits, from, to)?;
    let edge = Segment::new(before.position(from)?, before.position(to)?);
    let middle = edge.a + edge.vector().unit()? * at_m;
    let parts = chain.windows(2).filter_map(|pair| {
        let part = Segment::new(after.position(pair[0])?, after.position(pair[1])?);
        Some((part.distance(middle), part, pair[0], pair[1]))
    });
    let (_, part, from, to) = parts.min_by(|p, q| p.0.total_cmp(&q.0))?;
    let at_m = trim_m(part.nearest_fraction(middle) * part.length());
    Some(Place::Hosted { from, to, at_m, width_m })
}

/// The edges of a ring, the closing one last.
fn ring_edges<T: Copy>(ring: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

fn ordered(a: CornerId, b: CornerId) -> [CornerId; 2] {
    if a < b { [a, b] } else { [b, a] }
}

fn link(u: NodeIndex, v: NodeIndex) -> [NodeIndex; 2] {
    [u.min(v), u.max(v)]
}
