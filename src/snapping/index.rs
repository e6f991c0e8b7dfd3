use std::cmp::Ordering;
use std::collections::BTreeMap;

use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

use crate::geometry::{Bounds, Point, Segment};
use crate::plan::{CornerId, ElementId, Place, Plan, WallId, ordered};
use crate::topology::wall_bodies::{self, WallFaces};

/// An edge of walls and room boundaries; each pair of corners occurs once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndexedEdge {
    /// Its corners, the smaller first.
    pub corners: [CornerId; 2],
    /// From the smaller corner to the larger.
    pub segment: Segment,
    /// The wall on it.
    pub wall: Option<WallId>,
    /// The wall's thickness in metres; 0 if there is none.
    pub thickness_m: f64,
}

/// A spatial index of a plan's corners, edges, wall faces and openings.
#[derive(Debug, Default)]
pub struct PlanIndex {
    corners: RTree<IndexedCorner>,
    edges: RTree<IndexedEdge>,
    faces: BTreeMap<WallId, WallFaces>,
    face_lines: RTree<GeomWithData<Line<[f64; 2]>, WallId>>,
    /// The ends of openings: on the axis of their wall, and on its faces.
    jambs: RTree<[f64; 2]>,
    /// All corners sorted by x, and by y.
    by_x: Vec<Point>,
    by_y: Vec<Point>,
    /// Whether two walls stand between the same corners, of which the index has one.
    has_doubles: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct IndexedCorner {
    id: CornerId,
    point: Point,
}

impl RTreeObject for IndexedCorner {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_point([self.point.x, self.point.y])
    }
}

impl PointDistance for IndexedCorner {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let distance = self.point.distance(Point::new(point[0], point[1]));
        distance * distance
    }
}

impl RTreeObject for IndexedEdge {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let Segment { a, b } = self.segment;
        AABB::from_corners([a.x.min(b.x), a.y.min(b.y)], [a.x.max(b.x), a.y.max(b.y)])
    }
}

impl PointDistance for IndexedEdge {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let distance = self.segment.distance(Point::new(point[0], point[1]));
        distance * distance
    }
}

impl PlanIndex {
    /// The index of a plan.
    pub fn new(plan: &Plan) -> Self {
        let mut edges: BTreeMap<[CornerId; 2], Option<(WallId, f64)>> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            for ring in room.rings() {
                for (i, &corner) in ring.iter().enumerate() {
                    edges.entry(ordered(corner, ring[(i + 1) % ring.len()])).or_insert(None);
                }
            }
        }
        let mut has_doubles = false;
        for (id, wall) in plan.walls() {
            let before = edges.insert(ordered(wall.from, wall.to), Some((id, wall.thickness_m)));
            has_doubles |= matches!(before, Some(Some(_)));
        }
        let edges: Vec<IndexedEdge> = edges
            .into_iter()
            .filter_map(|(corners, wall)| {
                let segment = Segment::new(plan.position(corners[0])?, plan.position(corners[1])?);
                let thickness_m = wall.map_or(0.0, |(_, thickness_m)| thickness_m);
                Some(IndexedEdge { corners, segment, wall: wall.map(|(id, _)| id), thickness_m })
            })
            .collect();
        let faces = wall_bodies::faces(plan);
        let line =
            |id: WallId, face: Segment| GeomWithData::new(Line::new([face.a.x, face.a.y], [face.b.x, face.b.y]), id);
        let face_lines = faces.iter().flat_map(|(&id, faces)| [line(id, faces.left), line(id, faces.right)]).collect();
        let jambs = jambs(plan, &edges);
        let corners: Vec<IndexedCorner> =
            plan.corners().map(|(id, corner)| IndexedCorner { id, point: corner.position }).collect();
        let mut by_x: Vec<Point> = corners.iter().map(|corner| corner.point).collect();
        let mut by_y = by_x.clone();
        by_x.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        by_y.sort_by(|p, q| p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x)));
        Self {
            corners: RTree::bulk_load(corners),
            edges: RTree::bulk_load(edges),
            faces,
            face_lines: RTree::bulk_load(face_lines),
            jambs: RTree::bulk_load(jambs),
            by_x,
            by_y,
            has_doubles,
        }
    }

    /// The faces of a wall; `None` for one without a thickness.
    pub fn faces_of(&self, wall: WallId) -> Option<WallFaces> {
        self.faces.get(&wall).copied()
    }

    /// The faces of walls within a radius, nearest first.
    pub fn faces_near(&self, point: Point, radius_m: f64) -> Vec<Segment> {
        let near = self.face_lines.locate_within_distance([point.x, point.y], radius_m * radius_m);
        let mut found: Vec<(WallId, Segment)> = near
            .map(|line| {
                let Line { from, to } = *line.geom();
                (line.data, Segment::new(Point::new(from[0], from[1]), Point::new(to[0], to[1])))
            })
            .collect();
        let key = |face: &Segment| (face.a.x, face.a.y, face.b.x, face.b.y);
        found.sort_by(|(p_wall, p), (q_wall, q)| {
            let by_distance = p.distance(point).total_cmp(&q.distance(point));
            by_distance.then(p_wall.cmp(q_wall)).then(key(p).partial_cmp(&key(q)).unwrap_or(Ordering::Equal))
        });
        found.into_iter().map(|(_, face)| face).collect()
    }

    /// The ends of openings within a radius: on the axis and on the faces of their wall.
    pub fn jambs_near(&self, point: Point, radius_m: f64) -> Vec<Point> {
        let near = self.jambs.locate_within_distance([point.x, point.y], radius_m * radius_m);
        let mut found: Vec<Point> = near.map(|&[x, y]| Point::new(x, y)).collect();
        found.sort_by(|p, q| {
            p.distance(point).total_cmp(&q.distance(point)).then(p.x.total_cmp(&q.x)).then(p.y.total_cmp(&q.y))
        });
        found
    }

    /// The corners within a radius, nearest first.
    pub fn corners_near(&self, point: Point, radius_m: f64) -> Vec<(CornerId, Point)> {
        let mut found: Vec<(CornerId, Point)> = self
            .corners
            .locate_within_distance([point.x, point.y], radius_m * radius_m)
            .map(|corner| (corner.id, corner.point))
            .collect();
        found.sort_by(|p, q| p.1.distance(point).total_cmp(&q.1.distance(point)).then(p.0.cmp(&q.0)));
        found
    }

    /// The edges within a radius, nearest first.
    pub fn edges_near(&self, point: Point, radius_m: f64) -> Vec<IndexedEdge> {
        let mut found: Vec<IndexedEdge> =
            self.edges.locate_within_distance([point.x, point.y], radius_m * radius_m).copied().collect();
        let distance = |edge: &IndexedEdge| edge.segment.distance(point);
        found.sort_by(|p, q| distance(p).total_cmp(&distance(q)).then(p.corners.cmp(&q.corners)));
        found
    }

    /// The axes of the walls within a radius, with their thickness in metres.
    pub fn walls_near(&self, point: Point, radius_m: f64) -> Vec<(Segment, f64)> {
        let edges = self.edges_near(point, radius_m).into_iter();
        edges.filter(|edge| edge.wall.is_some()).map(|edge| (edge.segment, edge.thickness_m)).collect()
    }

    /// The corners in a box, and the walls whose boxes meet it; `None` where the index does not have all of them.
    pub fn elements_in(&self, bounds: Bounds) -> Option<impl Iterator<Item = ElementId> + '_> {
        let envelope = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let corners = self.corners.locate_in_envelope(envelope).map(|corner| ElementId::Corner(corner.id));
        let walls = self.edges.locate_in_envelope_intersecting(envelope).filter_map(|edge| edge.wall);
        (!self.has_doubles).then(|| corners.chain(walls.map(ElementId::Wall)))
    }

    /// The corners in a box whose x is near a value.
    pub fn corners_at_x(&self, x: f64, radius_m: f64, within: Bounds) -> Vec<Point> {
        let start = self.by_x.partition_point(|point| point.x < x - radius_m);
        let near = self.by_x[start..].iter().take_while(|point| point.x <= x + radius_m);
        near.copied().filter(|&point| within.contains(point)).collect()
    }

    /// The corners in a box whose y is near a value.
    pub fn corners_at_y(&self, y: f64, radius_m: f64, within: Bounds) -> Vec<Point> {
        let start = self.by_y.partition_point(|point| point.y < y - radius_m);
        let near = self.by_y[start..].iter().take_while(|point| point.y <= y + radius_m);
        near.copied().filter(|&point| within.contains(point)).collect()
    }
}

/// The ends of all openings, on the axis and on the faces of the wall they are in.
fn jambs(plan: &Plan, edges: &[IndexedEdge]) -> Vec<[f64; 2]> {
    let thickness_m: BTreeMap<[CornerId; 2], f64> = edges
        .iter()
        .map(|edge| (edge.corners, edge.thickness_m))
        .filter(|(_, thickness_m)| *thickness_m > 0.0)
        .collect();
    let mut jambs = Vec::new();
    for (_, opening) in plan.openings() {
        let Some(segment) = plan.opening_segment(opening) else { continue };
        let Some(left) = segment.vector().left().unit() else { continue };
        let half_m = match opening.place {
            Place::Hosted { from, to, .. } => {
                thickness_m.get(&ordered(from, to)).map_or(0.0, |thickness_m| thickness_m / 2.0)
            }
            Place::Free { .. } => 0.0,
        };
        for end in [segment.a, segment.b] {
            jambs.push([end.x, end.y]);
            if half_m > 0.0 {
                jambs.extend([end + left * half_m, end + -left * half_m].map(|face| [face.x, face.y]));
            }
        }
    }
    jambs
}
