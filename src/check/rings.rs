//! Faults of a single ring.

use super::FINDINGS_LIMIT;
use crate::geometry::runs::without_notches;
use crate::geometry::segments::{SegmentIndex, crossing};
use crate::geometry::{Point, TOUCH_M, Vector, polygon};

/// Directions closer than this, in radians, count as equal when deciding whether a boundary that touches
/// itself also crosses itself: a corner shifted by [`TOUCH_M`] turns an edge of 10 cm by this much.
const SAME_DIRECTION_RAD: f64 = 0.01;

/// Where a ring crosses or touches itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingFaults {
    /// Where it passes from one side of itself to the other: the inside is not what was meant.
    pub crossings: Vec<Point>,
    /// Where it only touches itself or doubles back.
    pub touches: Vec<Point>,
}

impl RingFaults {
    /// Whether there are so many faults that the ring is unusable: it is not compared with others, and
    /// not all of its faults are listed.
    pub fn is_hopeless(&self) -> bool {
        self.crossings.len() + self.touches.len() >= FINDINGS_LIMIT
    }
}

/// Finds where a ring crosses or touches itself; details below
/// [`crate::geometry::runs::NOTCH_M`] are ignored.
pub fn ring_faults(ring: &[Point]) -> RingFaults {
    let mut faults = RingFaults::default();
    let ring = without_notches(ring);
    let n = ring.len();
    if n < 3 {
        return faults;
    }
    let index = SegmentIndex::new(polygon::edges(&ring).collect());
    // The two directions leading away from a corner of the ring, or from a point inside an edge.
    let arms_of_corner =
        |corner: usize| [ring[(corner + n - 1) % n] - ring[corner], ring[(corner + 1) % n] - ring[corner]];
    for i in 0..n {
        let edge = index.get(i);
        let mut near: Vec<usize> = index.near(edge.bounds().inflated(TOUCH_M)).filter(|&j| j > i).collect();
        near.sort_unstable();
        for j in near {
            let other = index.get(j);
            let shared = if j == i + 1 {
                Some(j)
            } else if i == 0 && j == n - 1 {
                Some(0)
            } else {
                None
            };
            if let Some(shared) = shared {
                // Neighbours always meet at their shared corner; it is a fault only if one doubles back
                // along the other.
                let (before, after) = (ring[(shared + n - 1) % n], ring[(shared + 1) % n]);
                let [first, second] = if shared == j { [edge, other] } else { [other, edge] };
                if first.distance(after) <= TOUCH_M {
                    note(&mut faults.touches, after);
                } else if second.distance(before) <= TOUCH_M {
                    note(&mut faults.touches, before);
                }
                continue;
            }
            let mut touches = false;
            let ends = [(i, j, other), ((i + 1) % n, j, other), (j, i, edge), ((j + 1) % n, i, edge)];
            for (corner, edge_index, touched) in ends {
                let at = ring[corner];
                if touched.distance(at) > TOUCH_M {
                    continue;
                }
                touches = true;
                let end = [edge_index, (edge_index + 1) % n].into_iter().find(|&end| ring[end].distance(at) <= TOUCH_M);
                let arms = match end {
                    Some(end) => arms_of_corner(end),
                    None => [touched.a - at, touched.b - at],
                };
                if interleave(arms_of_corner(corner), arms) {
                    note(&mut faults.crossings, at);
                } else {
                    note(&mut faults.touches, at);
                }
            }
            if !touches && let Some(at) = crossing(edge, other) {
                note(&mut faults.crossings, at);
            }
            if faults.is_hopeless() {
                return faults;
            }
        }
    }
    faults
}

/// Adds a place unless already noted: a corner belongs to two edges.
fn note(places: &mut Vec<Point>, at: Point) {
    if places.iter().all(|place| place.distance(at) > 2.0 * TOUCH_M) {
        places.push(at);
    }
}

/// Whether, going around the common point, the arms of one path alternate with those of the other: then
/// the paths cross there. Cannot tell when arms run along each other.
fn interleave([p, q]: [Vector; 2], [r, s]: [Vector; 2]) -> bool {
    let turn = |to: Vector| {
        let turn = p.cross(to).atan2(p.dot(to));
        if turn < 0.0 { turn + std::f64::consts::TAU } else { turn }
    };
    let opening = turn(q);
    let between = |arm: Vector| {
        let turn = turn(arm);
        let beside = |direction: f64| (turn - direction).abs() <= SAME_DIRECTION_RAD;
        if beside(0.0) || beside(std::f64::consts::TAU) || beside(opening) { None } else { Some(turn < opening) }
    };
    matches!((between(r), between(s)), (Some(one), Some(other)) if one != other)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(points: &[(f64, f64)]) -> (usize, usize) {
        let ring: Vec<Point> = points.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let turned: Vec<Point> =
            ring.iter().map(|&p| (Point::default() + (p - Point::default()).rotated(0.7)).trimmed()).collect();
        let found = ring_faults(&ring);
        let found_turned = ring_faults(&turned);
        let count = (found.crossings.len(), found.touches.len());
        assert_eq!(count, (found_turned.crossings.len(), found_turned.touches.len()), "turned {points:?}");
        count
    }

    #[test]
    fn simple_rings_have_no_faults() {
        assert_eq!(faults(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]), (0, 0));
        assert_eq!(faults(&[(0.0, 0.0), (4.0, 0.0), (2.0, 3.0)]), (0, 0));
        // Points on a straight wall, and a notch below a centimetre.
        assert_eq!(faults(&[(0.0, 0.0), (2.0, 0.0), (2.0004, 0.0003), (2.0008, 0.0), (4.0, 0.0), (4.0, 3.0)]), (0, 0));
    }

    #[test]
    fn crossings_and_touches_are_told_apart() {
        // A bow tie, its middle not a corner.
        assert_eq!(faults(&[(0.0, 0.0), (4.0, 3.0), (4.0, 0.0), (0.0, 3.0)]), (1, 0));
        // A bow tie whose middle is a corner of both strokes.
        assert_eq!(faults(&[(0.0, 0.0), (2.0, 1.5), (4.0, 3.0), (4.0, 0.0), (2.0, 1.5), (0.0, 3.0)]), (1, 0));
        // A bow tie whose middle is a corner of one stroke.
        assert_eq!(faults(&[(0.0, 0.0), (2.0, 1.5), (4.0, 3.0), (4.0, 0.0), (0.0, 3.0)]), (1, 0));
        // Two squares that touch at a corner.
        assert_eq!(
            faults(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (4.0, 2.0), (4.0, 4.0), (2.0, 4.0), (2.0, 2.0), (0.0, 2.0)]),
            (0, 1)
        );
        // A corner that touches the opposite wall.
        assert_eq!(faults(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.0, 0.0), (0.0, 3.0)]), (0, 1));
        // A spike along a wall, and one that stands out.
        assert_eq!(faults(&[(0.0, 0.0), (3.0, 0.0), (2.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]).0, 0);
        assert!(faults(&[(0.0, 0.0), (3.0, 0.0), (2.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]).1 > 0);
        assert_eq!(faults(&[(0.0, 0.0), (6.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]), (0, 1));
    }
}
