//! Lines of a map that bridge doorways. From far along a corridor a wall's hits are further apart than a
//! doorway is wide, so that the walls on both sides of it become one line. The free space, seen from nearer,
//! says better.

use super::RayGrid;
use super::doorways::is_inside;
use crate::geometry::{Point, Segment};

/// A line is looked at in pieces of this length in metres.
const PIECE_M: f64 = 0.05;

/// A wall's face lies within this distance in metres of the boundary of the free space, which ends 2 cm
/// before it; the rest is the error of poses.
const BESIDE_M: f64 = 0.1;

/// Shorter bridges are left, in metres: no robot passes there.
const SHORTEST_M: f64 = 0.2;

/// Segments without the stretches that run through free space and where nothing was hit. `boundary` holds the
/// edges of the free space, which is to their left; `is_hit` says whether something was hit near a point.
pub fn without_bridges(segments: &[Segment], boundary: &RayGrid, is_hit: impl Fn(Point) -> bool) -> Vec<Segment> {
    let mut kept = Vec::with_capacity(segments.len());
    for segment in segments {
        let Some(along) = segment.vector().unit() else { continue };
        let length_m = segment.length();
        let count = (length_m / PIECE_M).ceil().clamp(1.0, 1e6) as usize;
        let at_m = |i: usize| length_m * i as f64 / count as f64;
        let is_bridge = |i: usize| {
            let middle = segment.a + along * (length_m * (i as f64 + 0.5) / count as f64);
            boundary.distance_m(middle, BESIDE_M) >= BESIDE_M && is_inside(boundary, middle) && !is_hit(middle)
        };
        let mut from_m = 0.0;
        let mut i = 0;
        while i < count {
            let end = (i..count).find(|&i| !is_bridge(i)).unwrap_or(count);
            if end == i {
                i += 1;
                continue;
            }
            // Up to the jambs, which are beside free space too.
            let middle_m = (at_m(i) + at_m(end)) / 2.0;
            let middle = segment.a + along * middle_m;
            let half_m = (at_m(end) - at_m(i)) / 2.0 + 2.0 * BESIDE_M;
            let jamb_m = |way| boundary.cast(middle, way, half_m).map_or(half_m - 2.0 * BESIDE_M, |hit| hit.distance_m);
            let (start_m, end_m) = (middle_m - jamb_m(-along), middle_m + jamb_m(along));
            if end_m - start_m >= SHORTEST_M {
                push(&mut kept, segment, from_m, start_m);
                from_m = from_m.max(end_m);
            }
            i = end;
        }
        push(&mut kept, segment, from_m, length_m);
    }
    kept
}

/// The part of a segment between two distances from its start, unless it is a crumb.
fn push(kept: &mut Vec<Segment>, segment: &Segment, from_m: f64, to_m: f64) {
    let Some(along) = segment.vector().unit() else { return };
    let is_whole = from_m <= 0.0 && to_m >= segment.length();
    if is_whole {
        kept.push(*segment);
    } else if to_m - from_m >= PIECE_M {
        kept.push(Segment::new(segment.a + along * from_m.max(0.0), segment.a + along * to_m));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_across_a_doorway_becomes_two() {
        // Two rooms, a wall of 0.1 m at y = 3, and a doorway from x = 2 to x = 2.9; the space ends 2 cm before walls.
        let ring = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 2.98),
            (2.88, 2.98),
            (2.88, 3.12),
            (5.0, 3.12),
            (5.0, 6.0),
            (0.0, 6.0),
            (0.0, 3.12),
            (2.02, 3.12),
            (2.02, 2.98),
            (0.0, 2.98),
        ];
        let ring = ring.map(|(x, y)| Point::new(x, y));
        let boundary = RayGrid::new(crate::geometry::polygon::edges(&ring).collect());
        let line = |from: f64, to: f64, y: f64| Segment::new(Point::new(from, y), Point::new(to, y));
        let kept = without_bridges(&[line(5.0, 0.0, 3.0)], &boundary, |_| false);
        assert_eq!(kept.len(), 2, "{kept:?}");
        assert!(kept[0].b.distance(Point::new(2.88, 3.0)) < 1e-6 && kept[1].a.distance(Point::new(2.02, 3.0)) < 1e-6);
        // Where something was hit is a wall, whatever the free space says.
        assert_eq!(without_bridges(&[line(5.0, 0.0, 3.0)], &boundary, |_| true).len(), 1);
        assert_eq!(without_bridges(&[line(0.0, 2.0, 3.0)], &boundary, |_| false).len(), 1);
    }
}
