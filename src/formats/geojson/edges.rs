//! The edges that openings lie on.

use std::collections::BTreeSet;

use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree};

use crate::formats::point_openings::{self, Ring};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M, Vector, trim_m};
use crate::plan::{Builder, CornerId, DEFAULT_DOOR_WIDTH_M, Place as OpeningPlace, RoomId, THICKEST_WALL_M};

/// How far from an edge the ends of an opening may lie to be hosted by it: what rounding to four
/// decimals and a slanted edge explain, and no more. Opening and edge then are the same line in the
/// source, so that moving one must move the other; anything further off keeps its own place.
pub(super) const HOST_TOLERANCE_M: f64 = 1e-3;

/// More edges in one place than this are no plan, and which of them is taken does not matter.
const CANDIDATES: usize = 64;

/// The edges of walls and rooms, found by place.
pub(super) struct Edges {
    tree: RTree<Edge>,
    /// The rings of rooms, and each wall as a ring of two corners.
    rings: Vec<(Vec<CornerId>, Vec<Point>)>,
}

/// An edge with its corners, and the ring it is first met in.
type Edge = GeomWithData<Line<[f64; 2]>, (CornerId, CornerId, usize)>;

/// Where a door that is a point was put.
pub(super) struct PointDoor {
    pub place: OpeningPlace,
    /// How far from the point its wall lies, in metres.
    pub off_m: f64,
    /// How far it was moved along its wall to fit, in metres.
    pub moved_m: f64,
}

impl Edges {
    pub(super) fn new(builder: &Builder) -> Self {
        let plan = builder.plan();
        let of_walls = plan.walls().map(|(_, wall)| vec![wall.from, wall.to]);
        let of_rooms = plan.rooms().flat_map(|(_, room)| room.rings().map(|ring| ring.to_vec()));
        let rings: Vec<(Vec<CornerId>, Vec<Point>)> = of_walls
            .chain(of_rooms)
            .filter(|ring| ring.len() > 1)
            .map(|ring| {
                let points = ring.iter().filter_map(|&corner| plan.position(corner)).collect();
                (ring, points)
            })
            .collect();
        let ordered = |a: CornerId, b: CornerId| if a < b { (a, b) } else { (b, a) };
        // Each ring has its own edges for doors that are points; a host is one of those between the same corners.
        let mut edges: BTreeSet<(CornerId, CornerId, usize)> = BTreeSet::new();
        for (index, (ring, _)) in rings.iter().enumerate() {
            let between = |i: usize| ordered(ring[i], ring[(i + 1) % ring.len()]);
            edges.extend((0..ring.len()).map(between).map(|(from, to)| (from, to, index)));
        }
        let lines = edges.into_iter().filter_map(|(from, to, ring)| {
            let (a, b) = (plan.position(from)?, plan.position(to)?);
            Some(GeomWithData::new(Line::new([a.x, a.y], [b.x, b.y]), (from, to, ring)))
        });
        Self { tree: RTree::bulk_load(lines.collect()), rings }
    }

    fn segment(line: &Line<[f64; 2]>) -> Segment {
        Segment::new(Point::new(line.from[0], line.from[1]), Point::new(line.to[0], line.to[1]))
    }

    /// The place on the edge that the segment from `a` to `b` lies on; the nearest if there are
    /// several.
    pub(super) fn host(&self, a: Point, b: Point) -> Option<OpeningPlace> {
        let middle = a.midpoint(b);
        let around = Bounds::of([middle]).inflated(HOST_TOLERANCE_M);
        let envelope = AABB::from_corners([around.min.x, around.min.y], [around.max.x, around.max.y]);
        let (_, edge, (from, to, _)) = self
            .tree
            .locate_in_envelope_intersecting(envelope)
            .take(CANDIDATES)
            .map(|line| {
                let edge = Self::segment(line.geom());
                (edge.distance(a).max(edge.distance(b)), edge, line.data)
            })
            .filter(|&(off_m, ..)| off_m <= HOST_TOLERANCE_M)
            .min_by(|(p, _, p_ends), (q, _, q_ends)| p.total_cmp(q).then(p_ends.cmp(q_ends)))?;
        let (edge, from, to) =
            if edge.vector().dot(b - a) < 0.0 { (Segment::new(edge.b, edge.a), to, from) } else { (edge, from, to) };
        let width_m = trim_m(a.distance(b));
        let at_m = trim_m(edge.nearest_fraction(middle) * edge.length());
        (width_m > 0.0).then_some(OpeningPlace::Hosted { from, to, at_m, width_m })
    }

    /// A door of the usual width about a point, as the authors' XML has them: on the nearest wall, slid along
    /// it until it fits. `joins` are the rooms that the file says it joins; without them the nearest wall or
    /// side of a room counts. `None` where nothing is within the thickest plausible wall.
    pub(super) fn of_point(&self, builder: &Builder, point: Point, joins: &[RoomId]) -> Option<PointDoor> {
        let plan = builder.plan();
        let outer: Vec<(Vec<CornerId>, Vec<Point>)> = joins
            .iter()
            .filter_map(|&id| plan.room(id))
            .filter(|room| room.has_boundary())
            .map(|room| (room.outer.to_vec(), plan.ring_points(&room.outer)))
            .collect();
        let rings: Vec<Ring<'_>> = if outer.is_empty() {
            let nearest = Self::segment(self.tree.nearest_neighbor([point.x, point.y])?.geom()).distance(point);
            if nearest > THICKEST_WALL_M {
                return None;
            }
            let around = Bounds::of([point]).inflated(nearest + TOUCH_M);
            let envelope = AABB::from_corners([around.min.x, around.min.y], [around.max.x, around.max.y]);
            let near: BTreeSet<usize> = self
                .tree
                .locate_in_envelope_intersecting(envelope)
                .filter(|line| Self::segment(line.geom()).distance(point) <= nearest + TOUCH_M)
                .take(CANDIDATES)
                .map(|line| line.data.2)
                .collect();
            near.into_iter().map(|index| ring_of(&self.rings[index])).collect()
        } else {
            outer.iter().map(ring_of).collect()
        };
        let placed = point_openings::place(&rings, point)?;
        let off_m = placed.off_m;
        Some(match placed.place {
            OpeningPlace::Hosted { from, to, at_m, width_m } => {
                let edge = Segment::new(plan.position(from)?, plan.position(to)?);
                let moved_m = (at_m - edge.nearest_fraction(point) * edge.length()).abs();
                let place = OpeningPlace::Hosted { from, to, at_m: trim_m(at_m), width_m };
                PointDoor { place, off_m, moved_m }
            }
            free @ OpeningPlace::Free { .. } => PointDoor { place: free, off_m, moved_m: 0.0 },
        })
    }

    /// A segment of a door's width about a point, along the edge nearest to it.
    pub(super) fn widened(&self, point: Point) -> (Point, Point) {
        let nearest = self.tree.nearest_neighbor([point.x, point.y]);
        let along = nearest.and_then(|line| Self::segment(line.geom()).vector().unit());
        let half = along.unwrap_or(Vector::new(1.0, 0.0)) * (DEFAULT_DOOR_WIDTH_M / 2.0);
        ((point - half).trimmed(), (point + half).trimmed())
    }
}

fn ring_of((corners, points): &(Vec<CornerId>, Vec<Point>)) -> Ring<'_> {
    Ring { corners, points }
}
