//! The faces enclosed by walls and room boundaries in a plan.

use std::collections::{BTreeMap, BTreeSet};

use super::RoomShapes;
use crate::geometry::arrangement::grid::GridPoint;
use crate::geometry::arrangement::{Arrangement, ArrangementError, Face, NodeIndex, faces};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Bounds, Point, Segment};
use crate::plan::{CornerId, Plan, Positions, RoomId, ordered, ring_edges};

/// A face narrower than this on average (twice its area over its perimeter), in metres, is a sliver
/// between lines that should coincide, not a room. The smallest of 5,355 rooms in real dwellings are pipe
/// shafts of 0.06 m², on average 0.12 m wide; lines that miss each other by a few millimetres leave
/// slivers below 0.01 m.
pub const SLIVER_WIDTH_M: f64 = 0.05;

/// A face enclosed by walls and room boundaries in a plan.
#[derive(Clone, Debug)]
pub struct PlanFace {
    /// The outer boundary in metres, counter-clockwise.
    pub outer: Vec<Point>,
    /// The boundaries of what is inside, clockwise.
    pub holes: Vec<Vec<Point>>,
    /// Whether walls alone enclose it, without the help of room boundaries.
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
pub(crate) fn is_sliver(outer: &[Point], holes: &[Vec<Point>]) -> bool {
    let perimeter_m = polygon::perimeter(outer) + holes.iter().map(|hole| polygon::perimeter(hole)).sum::<f64>();
    2.0 * polygon::area(outer, holes) < SLIVER_WIDTH_M * perimeter_m
}

/// All faces enclosed by the walls of a plan and the boundaries of its rooms: to show what a click would
/// fill, and to fill it.
#[derive(Debug)]
pub struct PlanFaces<'a> {
    pub(crate) edges: EdgeFaces<'a>,
    pub(crate) faces: Vec<PlanFace>,
}

impl<'a> PlanFaces<'a> {
    /// The faces of a plan.
    ///
    /// # Errors
    /// When the walls meet more often than [`crate::geometry::arrangement::PASSINGS_LIMIT`].
    pub fn new(plan: &'a Plan) -> Result<Self, ArrangementError> {
        // Whether each edge is a wall.
        let mut by_corners: BTreeMap<[CornerId; 2], bool> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            for ring in room.rings() {
                by_corners.extend(ring_edges(ring).map(|(a, b)| (ordered(a, b), false)));
            }
        }
        by_corners.extend(plan.walls().map(|(_, wall)| (ordered(wall.from, wall.to), true)));
        Self::of_edges(plan, by_corners, &RoomShapes::new(plan))
    }

    /// The faces of the part of a plan that lies in a box: those that lie in it entirely are as in
    /// [`PlanFaces::new`], others may be missing or larger.
    ///
    /// # Errors
    /// As [`PlanFaces::new`].
    pub fn within(plan: &'a Plan, bounds: Bounds) -> Result<Self, ArrangementError> {
        let positions = Positions::new(plan);
        let is_near = |a: CornerId, b: CornerId| {
            let ends = positions.get(a).zip(positions.get(b));
            ends.is_some_and(|(a, b)| Segment::new(a, b).bounds().intersects(bounds))
        };
        let mut by_corners: BTreeMap<[CornerId; 2], bool> = BTreeMap::new();
        let mut near_rooms = Vec::new();
        for (id, room) in plan.rooms() {
            let outer = Bounds::of(room.outer.iter().filter_map(|&corner| positions.get(corner)));
            if !outer.intersects(bounds) {
                continue;
            }
            near_rooms.push(id);
            for ring in room.rings() {
                let near = ring_edges(ring).filter(|&(a, b)| is_near(a, b));
                by_corners.extend(near.map(|(a, b)| (ordered(a, b), false)));
            }
        }
        let walls = plan.walls().filter(|(_, wall)| is_near(wall.from, wall.to));
        by_corners.extend(walls.map(|(_, wall)| (ordered(wall.from, wall.to), true)));
        Self::of_edges(plan, by_corners, &RoomShapes::of_rooms(plan, near_rooms))
    }

    /// The faces between edges, each with whether it is a wall.
    fn of_edges(
        plan: &'a Plan,
        by_corners: BTreeMap<[CornerId; 2], bool>,
        shapes: &RoomShapes,
    ) -> Result<Self, ArrangementError> {
        let edges = EdgeFaces::new(plan, by_corners.keys().copied())?;
        let mut walled: BTreeSet<[NodeIndex; 2]> = BTreeSet::new();
        for (i, _) in edges.edges.iter().enumerate().filter(|(_, ends)| by_corners.get(*ends) == Some(&true)) {
            walled.extend(edges.arrangement.chain(i).windows(2).map(|pair| link(pair[0], pair[1])));
        }
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

    /// A point inside a face.
    pub(crate) fn interior_point(&self, index: usize) -> Point {
        self.edges.interior_point(index)
    }

    /// Index in [`PlanFaces::all`] of the face around a point; `None` on a wall or where nothing encloses
    /// the point.
    pub fn at(&self, point: Point) -> Option<usize> {
        self.faces.iter().position(|face| {
            polygon::bounds(&face.outer).contains(point)
                && polygon::locate(&face.outer, &face.holes, point) == Location::Inside
        })
    }
}

/// The faces enclosed by edges between corners of a plan.
#[derive(Debug)]
pub(crate) struct EdgeFaces<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) arrangement: Arrangement,
    /// The edges by their corners, smaller first, without repeats: in the order of the arrangement's
    /// segments.
    pub(crate) edges: Vec<[CornerId; 2]>,
    pub(crate) faces: Vec<Face>,
}

impl<'a> EdgeFaces<'a> {
    /// The faces between edges of a plan, which need not belong to anything yet; each edge has its
    /// smaller corner first.
    ///
    /// # Errors
    /// When the edges meet more often than [`crate::geometry::arrangement::PASSINGS_LIMIT`].
    pub fn new(plan: &'a Plan, edges: impl IntoIterator<Item = [CornerId; 2]>) -> Result<Self, ArrangementError> {
        let (mut known, mut segments) = (Vec::new(), Vec::new());
        for [a, b] in edges {
            if let (Some(from), Some(to)) = (plan.position(a), plan.position(b)) {
                known.push([a, b]);
                segments.push(Segment::new(from, to));
            }
        }
        let arrangement = Arrangement::new(&segments)?;
        let faces = faces(&arrangement);
        Ok(Self { plan, arrangement, edges: known, faces })
    }

    /// The number of faces.
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

    /// The given edges that run along the boundary of a face.
    pub fn edges_around(&self, index: usize) -> Vec<[CornerId; 2]> {
        let links: BTreeSet<[NodeIndex; 2]> =
            self.faces[index].rings().flat_map(|ring| ring_edges(ring)).map(|(u, v)| link(u, v)).collect();
        let runs_along =
            |i: usize| self.arrangement.chain(i).windows(2).any(|pair| links.contains(&link(pair[0], pair[1])));
        (0..self.edges.len()).filter(|&i| runs_along(i)).map(|i| self.edges[i]).collect()
    }

    /// The plan's corner at each node, if any: of several in one place one at the end of an edge, and of
    /// those the smallest.
    pub(crate) fn corners_at_nodes(&self) -> Vec<Option<CornerId>> {
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
        // Only where edges cross without a corner of their own can another corner lie on a node.
        if corners.iter().any(Option::is_none) {
            self.plan.corners().for_each(|(id, corner)| note(&mut corners, id, corner.position));
        }
        corners
    }
}

fn link(u: NodeIndex, v: NodeIndex) -> [NodeIndex; 2] {
    [u.min(v), u.max(v)]
}
