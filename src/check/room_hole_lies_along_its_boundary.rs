use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::geometry::segments::{SegmentIndex, common_stretch};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M, polygon};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;
use crate::topology::RoomShape;

/// A hole of a room that runs along the room's outer boundary or along another hole: it is no hole but a
/// bay in the boundary. The area is right; the walls, and so the axes ratio, are not, and other programs
/// refuse such a polygon; also one of which a hole touches the boundary in two places, and so cuts it in two.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHoleLiesAlongItsBoundary {
    pub room: RoomName,
    /// Whether it runs along another hole, not along the outer boundary.
    pub along_a_hole: bool,
    /// How far, in metres; 0 where it only touches it.
    pub length_m: f64,
    /// In how many places it touches the outer boundary.
    pub touches: usize,
    pub at: Point,
}

/// Rings that run along each other for less than this, in metres, only touch.
const LEAST_M: f64 = 10.0 * TOUCH_M;

impl Check for RoomHoleLiesAlongItsBoundary {
    const KIND: Kind = Kind {
        name: "room_hole_lies_along_its_boundary",
        title: "Room's hole lies along its boundary",
        severity: Severity::Warning,
        remedy: "draw the boundary round it instead; make one hole of two that share a side",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let shapes = context.shapes().iter().enumerate().filter(|(_, shape)| !shape.holes.is_empty());
        for (index, shape) in shapes.filter(|(index, _)| !context.ring_faults[*index].is_hopeless()) {
            let (mut edges, mut ring_of) = (Vec::new(), Vec::new());
            for (ring, points) in shape.rings().enumerate() {
                // All counter-clockwise.
                let is_reversed = polygon::signed_area(points) < 0.0;
                let of_ring = polygon::edges(points).filter(|edge| edge.length() > LEAST_M);
                edges.extend(of_ring.map(|edge| if is_reversed { Segment::new(edge.b, edge.a) } else { edge }));
                ring_of.resize(edges.len(), ring);
            }
            let edges = SegmentIndex::new(edges);
            let mut touches = touches(shape, &edges, &ring_of);
            for hole in 1..=shape.holes.len() {
                // A hole is told once: beside the outer boundary where it runs along that, else beside a hole before it.
                let mut along: Option<(usize, f64, Point)> = None;
                let own = ring_of.partition_point(|&ring| ring < hole)..ring_of.partition_point(|&ring| ring <= hole);
                for edge in own.map(|edge| edges.get(edge)) {
                    for other in edges.near(edge.bounds().inflated(TOUCH_M)).filter(|&other| ring_of[other] < hole) {
                        let ring = ring_of[other].min(1);
                        // A hole that lies outside the room, or overlaps another, is another finding.
                        let runs_the_same_way = edge.vector().dot(edges.get(other).vector()) > 0.0;
                        let is_beside = runs_the_same_way == (ring == 0);
                        let Some((length_m, at)) = shared(edge, edges.get(other)).filter(|_| is_beside) else {
                            continue;
                        };
                        along = match along {
                            Some((least, sum_m, at)) if least == ring => Some((ring, sum_m + length_m, at)),
                            Some(best) if best.0 < ring => Some(best),
                            _ => Some((ring, length_m, at)),
                        };
                    }
                }
                let touches = std::mem::take(&mut touches[hole]);
                let room = || context.name(index);
                match (along, touches.as_slice()) {
                    (Some((ring, length_m, at)), touches) => {
                        let along_a_hole = ring > 0;
                        found.push(Self { room: room(), along_a_hole, length_m, touches: touches.len(), at });
                    }
                    (None, [at, _, ..]) => {
                        let touches = touches.len();
                        found.push(Self { room: room(), along_a_hole: false, length_m: 0.0, touches, at: *at });
                    }
                    _ => {}
                }
                if found.len() >= FINDINGS_LIMIT {
                    return found;
                }
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.length_m
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        if self.length_m == 0.0 {
            return format!("a hole of {} touches its boundary in {} places", self.room, self.touches);
        }
        let along = if self.along_a_hole { "another hole" } else { "its boundary" };
        format!("a hole of {} runs along {along} for {:.2} m", self.room, self.length_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("length_m", self.length_m), ("touches", self.touches as f64)]
    }
}

/// Where each ring of a room, by its place in [`RoomShape::rings`], touches the outer one.
fn touches(shape: &RoomShape, edges: &SegmentIndex, ring_of: &[usize]) -> Vec<Vec<Point>> {
    let mut touches: Vec<Vec<Point>> = vec![Vec::new(); 1 + shape.holes.len()];
    for (ring, points) in shape.rings().enumerate() {
        for &at in points {
            let near = edges.near(Bounds::of([at]).inflated(TOUCH_M));
            for edge in near.filter(|&edge| edges.get(edge).distance(at) <= TOUCH_M) {
                let other = ring_of[edge];
                // A corner of a hole on the outer ring, or one of the outer ring on a hole.
                let hole = if ring == 0 { other } else { ring };
                let is_new = |touches: &[Point]| touches.iter().all(|place| place.distance(at) > 2.0 * TOUCH_M);
                if ring.min(other) == 0 && hole > 0 && touches[hole].len() < FINDINGS_LIMIT && is_new(&touches[hole]) {
                    touches[hole].push(at);
                }
            }
        }
    }
    touches
}

/// The length that two edges share, within [`TOUCH_M`], and its middle.
fn shared(edge: Segment, other: Segment) -> Option<(f64, Point)> {
    let (from_m, to_m) = common_stretch(edge, other);
    let length_m = to_m - from_m;
    if length_m <= LEAST_M {
        return None;
    }
    let at = |along_m: f64| edge.a.lerp(edge.b, along_m / edge.length());
    let touches = |along_m: f64| other.distance(at(along_m)) <= TOUCH_M;
    (touches(from_m) && touches(to_m)).then(|| (length_m, at(f64::midpoint(from_m, to_m))))
}
