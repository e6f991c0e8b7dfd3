//! A spatial index of segments, and relations between two segments.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::polygon::orientation;
use super::{Bounds, Point, Segment};

/// Segments with a spatial index.
#[derive(Debug)]
pub struct SegmentIndex {
    segments: Vec<Segment>,
    tree: RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>,
}

impl SegmentIndex {
    pub fn new(segments: Vec<Segment>) -> Self {
        let boxes = segments.iter().enumerate().map(|(index, segment)| {
            let Bounds { min, max } = segment.bounds();
            GeomWithData::new(Rectangle::from_corners([min.x, min.y], [max.x, max.y]), index)
        });
        Self { tree: RTree::bulk_load(boxes.collect()), segments }
    }

    pub fn get(&self, index: usize) -> Segment {
        self.segments[index]
    }

    pub fn all(&self) -> &[Segment] {
        &self.segments
    }

    /// The segments whose bounding boxes meet `bounds`, in an order fixed by the index.
    pub fn near(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        let envelope = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        self.tree.locate_in_envelope_intersecting(envelope).map(|found| found.data)
    }
}

/// Where the interiors of two segments cross, if they do; touching does not count.
pub fn crossing(p: Segment, q: Segment) -> Option<Point> {
    let opposite = |s: Segment, t: Segment| {
        let (u, v) = (orientation(s.a, s.b, t.a), orientation(s.a, s.b, t.b));
        (u > 0.0 && v < 0.0) || (u < 0.0 && v > 0.0)
    };
    if !(opposite(p, q) && opposite(q, p)) {
        return None;
    }
    let denominator = p.vector().cross(q.vector());
    (denominator != 0.0).then(|| p.a.lerp(p.b, (q.a - p.a).cross(q.vector()) / denominator))
}

/// Whether two segments are parallel, in either direction, within `tolerance_rad`.
pub fn are_parallel(p: Segment, q: Segment, tolerance_rad: f64) -> bool {
    let (u, v) = (p.vector(), q.vector());
    u.cross(v).abs() <= u.dot(v).abs() * tolerance_rad.tan()
}

/// The stretch of `p` that `q` runs alongside, as distances in metres along `p`; empty (from ≥ to) if
/// there is none.
pub fn common_stretch(p: Segment, q: Segment) -> (f64, f64) {
    let Some(direction) = p.vector().unit() else { return (0.0, 0.0) };
    let (u, v) = ((q.a - p.a).dot(direction), (q.b - p.a).dot(direction));
    (u.min(v).max(0.0), u.max(v).min(p.length()))
}
