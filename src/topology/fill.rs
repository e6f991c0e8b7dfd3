//! Rooms from walls: the edits that fill the faces which walls enclose.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::RoomShapes;
use super::arrangement::{Arrangement, NodeIndex};
use super::exact::GridPoint;
use super::faces::{Face, faces};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Point, Segment};
use crate::plan::edit::split::{Splits, split_edges};
use crate::plan::edit::{self, EditError};
use crate::plan::{CornerId, Plan, Room, RoomId, ordered, ring_edges};

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
        is_sliver(&self.outer, &self.holes)
    }
}

/// Whether an area is too narrow for a room, see [`SLIVER_WIDTH_M`].
pub(super) fn is_sliver(outer: &[Point], holes: &[Vec<Point>]) -> bool {
    let perimeter_m = polygon::perimeter(outer) + holes.iter().map(|hole| polygon::perimeter(hole)).sum::<f64>();
    2.0 * polygon::area(outer, holes) < SLIVER_WIDTH_M * perimeter_m
}

/// All faces that the walls of a plan and the boundaries of its rooms enclose: to show what a click
/// would fill, and to fill it.
#[derive(Debug)]
pub struct PlanFaces<'a> {
    edges: EdgeFaces<'a>,
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
        let edges = EdgeFaces::new(plan, by_corners.keys().copied())?;
        let mut walled: BTreeSet<[NodeIndex; 2]> = BTreeSet::new();
        for (i, _) in edges.edges.iter().enumerate().filter(|(_, ends)| by_corners.get(*ends) == Some(&true)) {
            walled.extend(edges.arrangement.chain(i).windows(2).map(|pair| link(pair[0], pair[1])));
        }
        let shapes = RoomShapes::new(plan);
        let faces = edges
            .faces
            .iter()
            .map(|face| {
                let (outer, holes) = face.positions(&edges.arrangement);
                let inside = face.interior_point(&edges.arrangement);
                let rooms = shapes.at(inside).into_iter().map(|index| shapes.all()[index].id).collect();
                let by_walls =
                    face.rings().flat_map(|ring| ring_edges(ring)).all(|(u, v)| walled.contains(&link(u, v)));
                PlanFace { outer, holes, by_walls, rooms }
            })
            .collect();
        Ok(Self { edges, faces })
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
        let indices: Vec<usize> = indices.into_iter().collect();
        let (mut next, boundaries) = self.edges.boundaries(&indices)?;
        let mut rooms = Vec::with_capacity(indices.len());
        for Boundary { outer, holes } in boundaries {
            let (with_room, id) = edit::add_room(&next, Room { outer, holes, ..Room::default() })?;
            next = with_room;
            rooms.push(id);
        }
        Ok(Filled { plan: next, rooms })
    }
}

/// The faces that edges between corners of a plan enclose.
#[derive(Debug)]
pub(super) struct EdgeFaces<'a> {
    plan: &'a Plan,
    arrangement: Arrangement,
    /// The edges by their corners, the smaller first, each once: in the order of the arrangement's
    /// segments.
    edges: Vec<[CornerId; 2]>,
    faces: Vec<Face>,
}

/// The rings around a face as corners.
#[derive(Clone, Debug)]
pub(super) struct Boundary {
    pub outer: Arc<[CornerId]>,
    pub holes: Vec<Arc<[CornerId]>>,
}

impl<'a> EdgeFaces<'a> {
    /// The faces between edges of a plan, which need not belong to anything yet; each edge with its
    /// smaller corner first.
    ///
    /// # Errors
    /// When the edges meet more often than [`super::PASSINGS_LIMIT`].
    pub fn new(plan: &'a Plan, edges: impl IntoIterator<Item = [CornerId; 2]>) -> Result<Self, EditError> {
        let (mut known, mut segments) = (Vec::new(), Vec::new());
        for [a, b] in edges {
            if let (Some(from), Some(to)) = (plan.position(a), plan.position(b)) {
                known.push([a, b]);
                segments.push(Segment::new(from, to));
            }
        }
        let arrangement = Arrangement::new(&segments)
            .map_err(|error| EditError(format!("the faces between the walls cannot be found: {error}")))?;
        let faces = faces(&arrangement);
        Ok(Self { plan, arrangement, edges: known, faces })
    }

    /// How many faces there are.
    pub fn count(&self) -> usize {
        self.faces.len()
    }

    /// The outer ring and the holes of a face in metres.
    pub fn positions(&self, index: usize) -> (Vec<Point>, Vec<Vec<Point>>) {
        self.faces[index].positions(&self.arrangement)
    }

    /// A point inside a face.
    pub fn interior_point(&self, index: usize) -> Point {
        self.faces[index].interior_point(&self.arrangement)
    }

    /// The indices among the edges given of those that run along the boundary of a face.
    pub fn edges_around(&self, index: usize) -> Vec<[CornerId; 2]> {
        let links: BTreeSet<[NodeIndex; 2]> =
            self.faces[index].rings().flat_map(|ring| ring_edges(ring)).map(|(u, v)| link(u, v)).collect();
        let runs_along =
            |i: usize| self.arrangement.chain(i).windows(2).any(|pair| links.contains(&link(pair[0], pair[1])));
        (0..self.edges.len()).filter(|&i| runs_along(i)).map(|i| self.edges[i]).collect()
    }

    /// The rings around faces as corners, in the order of the indices, in a plan that has all of these
    /// corners: where edges cross there are new ones, and whatever has one of the edges is split at
    /// the corners that the rings have on it.
    pub fn boundaries(&self, indices: &[usize]) -> Result<(Plan, Vec<Boundary>), EditError> {
        let chosen = || indices.iter().map(|&index| &self.faces[index]);
        let mut corners = self.corners_at_nodes();
        let mut next = self.plan.clone();
        let mut used = vec![false; self.arrangement.node_count()];
        for &node in chosen().flat_map(Face::rings).flatten() {
            used[node as usize] = true;
            let corner = &mut corners[node as usize];
            if corner.is_none() {
                let (with_corner, id) = edit::add_corner(&next, self.arrangement.position(node))?;
                (next, *corner) = (with_corner, Some(id));
            }
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
        if !splits.is_empty() {
            next = split_edges(&next, &splits)?;
        }
        let ring = |nodes: &Vec<NodeIndex>| -> Arc<[CornerId]> {
            nodes.iter().filter_map(|&node| corners[node as usize]).collect()
        };
        let boundaries = chosen()
            .map(|face| Boundary { outer: ring(&face.outer), holes: face.holes.iter().map(ring).collect() })
            .collect();
        Ok((next, boundaries))
    }

    /// The plan's corner at each node, if it has one there: of several in one place one at the end
    /// of an edge, and of those the smallest.
    fn corners_at_nodes(&self) -> Vec<Option<CornerId>> {
        let nodes = self.arrangement.grid_points();
        let mut corners: Vec<Option<CornerId>> = vec![None; nodes.len()];
        let ends: BTreeSet<CornerId> = self.edges.iter().flatten().copied().collect();
        let ends = ends.into_iter().filter_map(|id| Some((id, self.plan.position(id)?)));
        let note = |corners: &mut Vec<Option<CornerId>>, id: CornerId, position: Point| {
            let place = GridPoint::nearest(position);
            if let Some(node) = place.and_then(|place| nodes.binary_search(&place).ok()) {
                corners[node].get_or_insert(id);
            }
        };
        ends.for_each(|(id, position)| note(&mut corners, id, position));
        // Only where edges cross without a corner of their own can another corner stand on a node.
        if corners.iter().any(Option::is_none) {
            self.plan.corners().for_each(|(id, corner)| note(&mut corners, id, corner.position));
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

fn link(u: NodeIndex, v: NodeIndex) -> [NodeIndex; 2] {
    [u.min(v), u.max(v)]
}
