//! Gaps in the walls of a map that are no doorways: a room gets narrower there, at a pier or at a step of its outline.

use super::RayGrid;
use super::doorways::{DEEPEST_M, Doorway, WIDTH_LIMIT_M, is_same_doorway};
use crate::geometry::{Point, Segment, Vector};

/// A door of one leaf is at most this wide, in metres, and may be in a corner of its room.
const WIDEST_LEAF_M: f64 = 1.0;

/// Depth of a usual wall between rooms, in metres: up to 30 cm of masonry, and the error of a map.
const WALL_DEPTHS_M: std::ops::RangeInclusive<f64> = 0.08..=0.33;

/// At an end where the floor widens by less, in metres and as a share of the doorway's width, no wall is seen.
const LEAST_END_M: f64 = 0.1;
const END_SHARE: f64 = 0.15;

/// Floor that reaches this many widths of a passage further on both sides of it is of two rooms, however the passage lies.
const NARROW_SHARE: f64 = 2.5;

/// Whether a gap is where a room gets narrower, at a pier or at a step of its outline: it is wider than a door's leaf,
/// the floor beside it widens at one of its ends only, and its depth is not that of a wall. A pier is deeper, a step has
/// no depth. The other `doorways` count as closed. Where the floor on both sides of a thick wall widens a lot, at the
/// same end or a great deal at any, it is a passage in that wall.
pub(super) fn is_width_change(doorway: &Doorway, boundary: &RayGrid, doorways: &[Doorway]) -> bool {
    if doorway.width_m <= WIDEST_LEAF_M || WALL_DEPTHS_M.contains(&doorway.depth_m) {
        return false;
    }
    let Some(along) = doorway.segment.vector().unit() else { return false };
    let middle = doorway.segment.midpoint();
    let half_m = doorway.width_m / 2.0;
    let least_m = LEAST_END_M.max(END_SHARE * doorway.width_m);
    let others = doorways.iter().map(|other| other.segment).filter(|&other| !is_same_doorway(doorway.segment, other));
    let others: Vec<Segment> = others.collect();
    let beyond_m = |at: Point, way: Vector| {
        let wall_m = boundary.cast(at, way, WIDTH_LIMIT_M).map_or(WIDTH_LIMIT_M, |hit| hit.distance_m);
        others.iter().filter_map(|&door| super::ray_grid::hit_m(at, way, door)).fold(wall_m, f64::min) - half_m
    };
    // How much further the floor reaches past each end where it is widest, on the left and on the right.
    let sides = [along.left(), -along.left()].map(|across| {
        let ahead_m = boundary.cast(middle, across, DEEPEST_M).map_or(DEEPEST_M, |hit| hit.distance_m - 0.05);
        let steps = (ahead_m / 0.05).floor().max(0.0) as usize;
        let ends = (1..=steps).map(|step| {
            let at = middle + across * (step as f64 * 0.05);
            [beyond_m(at, -along), beyond_m(at, along)]
        });
        ends.max_by(|p, q| (p[0] + p[1]).total_cmp(&(q[0] + q[1]))).unwrap_or_default()
    });
    let width_m = doorway.width_m;
    let is_in_corner = (0..2).any(|end| sides.iter().all(|side| side[end] >= width_m));
    let is_narrow = sides.iter().all(|side| side[0].max(side[1]) >= NARROW_SHARE * width_m);
    let is_in_wall = doorway.depth_m >= *WALL_DEPTHS_M.start() && (is_in_corner || is_narrow);
    let is_framed = sides.iter().any(|side| side.iter().all(|&end_m| end_m > least_m));
    !is_in_wall && !is_framed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(a: (f64, f64), b: (f64, f64)) -> Segment {
        Segment::new(Point::new(a.0, a.1), Point::new(b.0, b.1))
    }

    /// The boundary of a floor, given counter-clockwise.
    fn floor(points: &[(f64, f64)]) -> RayGrid {
        let points: Vec<Point> = points.iter().map(|&(x, y)| Point::new(x, y)).collect();
        RayGrid::new(crate::geometry::polygon::edges(&points).collect())
    }

    fn doorway(a: (f64, f64), b: (f64, f64), depth_m: f64) -> Doorway {
        let segment = segment(a, b);
        Doorway { segment, width_m: segment.length(), depth_m, is_framed: false }
    }

    #[test]
    fn neither_a_pier_nor_a_step_is_a_doorway() {
        // A corridor of 2 m with a pier of half a metre at its lower wall.
        let pier =
            floor(&[(0.0, 0.0), (5.0, 0.0), (5.0, 0.5), (5.5, 0.5), (5.5, 0.0), (10.0, 0.0), (10.0, 2.0), (0.0, 2.0)]);
        let beside = doorway((5.25, 2.0), (5.25, 0.5), 0.5);
        assert!(is_width_change(&beside, &pier, &[]));
        // As deep as a wall, it is a passage; as narrow as a door, it may be one.
        assert!(!is_width_change(&Doorway { depth_m: 0.15, ..beside.clone() }, &pier, &[]));
        assert!(!is_width_change(&Doorway { width_m: 0.9, ..beside }, &pier, &[]));
        // Two rooms that overlap by 1.4 m at their corners.
        let step =
            floor(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (6.6, 3.0), (6.6, 6.0), (2.6, 6.0), (2.6, 3.0), (0.0, 3.0)]);
        assert!(is_width_change(&doorway((2.6, 3.0), (4.0, 3.0), 0.0), &step, &[]));
        // A double door in the middle of a thick wall.
        let wall = floor(&[
            (0.0, 0.0),
            (6.0, 0.0),
            (6.0, 3.0),
            (3.7, 3.0),
            (3.7, 3.5),
            (6.0, 3.5),
            (6.0, 6.0),
            (0.0, 6.0),
            (0.0, 3.5),
            (2.3, 3.5),
            (2.3, 3.0),
            (0.0, 3.0),
        ]);
        assert!(!is_width_change(&doorway((2.3, 3.25), (3.7, 3.25), 0.5), &wall, &[]));
    }
}
