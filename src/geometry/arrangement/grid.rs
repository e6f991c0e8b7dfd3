//! Points on the 0.1 mm grid as integers, with exact predicates.
//!
//! Coordinates stay within ±10⁹ steps ([`COORDINATE_LIMIT_M`]), so differences stay below 2·10⁹ and a
//! cross product of two differences below 8·10¹⁸, which fits an `i64`. Only the position of a crossing
//! needs more, and only when it falls close to halfway between two grid points.

use crate::geometry::COORDINATE_LIMIT_M;
use crate::geometry::Point;

/// Grid steps in a metre: 1 / [`crate::geometry::GRID_M`].
const STEPS_PER_M: f64 = 1e4;

/// A point of the 0.1 mm grid, in grid steps. Ordered by x, then y.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct GridPoint {
    pub x: i32,
    pub y: i32,
}

impl GridPoint {
    pub const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    /// The grid point nearest to a point in metres; `None` when it is not finite or lies beyond
    /// [`COORDINATE_LIMIT_M`].
    pub fn nearest(point: Point) -> Option<Self> {
        let steps = |metres: f64| {
            // The limit in steps, 10^9, is within an i32.
            (metres.abs() <= COORDINATE_LIMIT_M).then(|| (metres * STEPS_PER_M).round() as i32)
        };
        Some(Self::new(steps(point.x)?, steps(point.y)?))
    }

    /// The same place in metres, as [`crate::geometry::trim_m`] would write it.
    pub fn point(self) -> Point {
        Point::new(f64::from(self.x) / STEPS_PER_M, f64::from(self.y) / STEPS_PER_M)
    }

    /// The vector to another point.
    pub fn to(self, other: Self) -> (i64, i64) {
        (i64::from(other.x) - i64::from(self.x), i64::from(other.y) - i64::from(self.y))
    }
}

/// The cross product of two vectors: positive when the second points to the left of the first.
pub(crate) const fn cross((ax, ay): (i64, i64), (bx, by): (i64, i64)) -> i64 {
    ax * by - ay * bx
}

/// Positive when `c` lies to the left of the line from `a` to `b`, negative to the right, zero on it.
pub(crate) fn orientation(a: GridPoint, b: GridPoint, c: GridPoint) -> i64 {
    cross(a.to(b), a.to(c))
}

/// A straight piece between two different grid points, `a` before `b` in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece {
    pub a: GridPoint,
    pub b: GridPoint,
}

impl Piece {
    /// The vector from the first end to the second: its x is never negative.
    pub fn vector(self) -> (i64, i64) {
        self.a.to(self.b)
    }

    /// Whether the bounding boxes share a point.
    pub fn boxes_meet(self, other: Self) -> bool {
        let (low, high) = (self.a.y.min(self.b.y), self.a.y.max(self.b.y));
        let (other_low, other_high) = (other.a.y.min(other.b.y), other.a.y.max(other.b.y));
        self.a.x <= other.b.x && other.a.x <= self.b.x && low <= other_high && other_low <= high
    }

    /// The grid point whose pixel holds the crossing, if the two cross in the interior of both. Touching
    /// ends do not count: they are grid points already.
    pub fn crossing(self, other: Self) -> Option<GridPoint> {
        let along = self.vector();
        let other_along = other.vector();
        if !opposite(cross(along, self.a.to(other.a)), cross(along, self.a.to(other.b))) {
            return None;
        }
        let before = cross(other_along, other.a.to(self.a));
        let after = cross(other_along, other.a.to(self.b));
        if !opposite(before, after) {
            return None;
        }
        // The difference is the cross product of the two directions, so it does not overflow.
        let (part, whole) = (before, before - after);
        let place = |from: i32, step: i64| (i64::from(from) + rounded_product(step, part, whole)) as i32;
        Some(GridPoint::new(place(self.a.x, along.0), place(self.a.y, along.1)))
    }

    /// Whether it meets the pixel of a grid point: the unit square around it with its left and lower
    /// sides but not its right and upper ones, so that pixels tile the plane.
    pub fn meets_pixel(self, centre: GridPoint) -> bool {
        let (low, high) = (self.a.y.min(self.b.y), self.a.y.max(self.b.y));
        // The sides are half a step off the grid, where no end can be.
        if centre.x < self.a.x || centre.x > self.b.x || centre.y < low || centre.y > high {
            return false;
        }
        let (dx, dy) = self.vector();
        let middle = cross((dx, dy), self.a.to(centre));
        if middle.abs() > dx + dy.abs() {
            return false;
        }
        // The side of the line each corner of the square is on, doubled to stay an integer. The right and
        // upper sides are moved in by an infinitesimal, which decides for a line through a corner.
        let side = |doubled: i64, drawn_in: i64| if doubled == 0 { drawn_in.signum() } else { doubled.signum() };
        let sides = [
            side(2 * middle - dx + dy, 0),
            side(2 * middle - dx - dy, dy),
            side(2 * middle + dx + dy, -dx),
            side(2 * middle + dx - dy, dy - dx),
        ];
        !(sides.iter().all(|&side| side > 0) || sides.iter().all(|&side| side < 0))
    }
}

/// Whether one is positive and the other negative.
const fn opposite(a: i64, b: i64) -> bool {
    (a < 0 && b > 0) || (a > 0 && b < 0)
}

/// `factor * part / whole` rounded to the nearest integer, halves up.
fn rounded_product(factor: i64, part: i64, whole: i64) -> i64 {
    let approximate = factor as f64 * (part as f64 / whole as f64);
    // |factor| < 2^31 and |part / whole| < 1, so the four roundings above err by less than
    // 2^31 * 4 * 2^-53 < 10^-6: further from a half than that, the answer is certain.
    let floor = (approximate + 0.5).floor();
    let beyond = approximate + 0.5 - floor;
    if (1e-5..=1.0 - 1e-5).contains(&beyond) {
        return floor as i64;
    }
    let (numerator, denominator) = (2 * i128::from(factor) * i128::from(part), 2 * i128::from(whole));
    let (numerator, denominator) = if denominator < 0 { (-numerator, -denominator) } else { (numerator, denominator) };
    // Below 2^31 in magnitude, like the factor.
    (numerator + denominator / 2).div_euclid(denominator) as i64
}

#[cfg(test)]
mod tests {
    use crate::geometry::arrangement::grid::*;

    fn piece(ax: i32, ay: i32, bx: i32, by: i32) -> Piece {
        let (a, b) = (GridPoint::new(ax, ay), GridPoint::new(bx, by));
        Piece { a: a.min(b), b: a.max(b) }
    }

    #[test]
    fn products_round_exactly_with_halves_up() {
        assert_eq!(rounded_product(1, 1, 2), 1);
        assert_eq!(rounded_product(-1, 1, 2), 0);
        assert_eq!(rounded_product(3, -1, -2), 2);
        assert_eq!(rounded_product(-3, 1, 2), -1);
        // Just below and just above a half, closer than an f64 of this size can tell.
        let whole = 4_000_000_000_000_000_000;
        assert_eq!(rounded_product(1_999_999_999, whole / 2 - 1, whole), 999_999_999);
        assert_eq!(rounded_product(1_999_999_999, whole / 2, whole), 1_000_000_000);
    }

    #[test]
    fn crossings_are_inside_both_and_rounded() {
        assert_eq!(piece(0, 0, 10, 10).crossing(piece(0, 10, 10, 0)), Some(GridPoint::new(5, 5)));
        assert_eq!(piece(0, 0, 1, 1).crossing(piece(0, 1, 1, 0)), Some(GridPoint::new(1, 1)));
        assert_eq!(piece(0, 0, 10, 0).crossing(piece(5, 0, 5, 9)), None, "a touching end is no crossing");
        assert_eq!(piece(0, 0, 10, 0).crossing(piece(4, 0, 12, 0)), None, "nor is an overlap");
        let limit = 1_000_000_000;
        assert_eq!(
            piece(-limit, -limit, limit, limit).crossing(piece(-limit, limit, limit, -limit)),
            Some(GridPoint::new(0, 0))
        );
    }

    #[test]
    fn pixels_tile_the_plane() {
        // Through the corner shared by four pixels: only the upper right one counts, unless the line runs
        // through the interior of others.
        let rising = piece(0, 0, 3, 3);
        for (x, y, expected) in [(0, 0, true), (1, 1, true), (0, 1, false), (1, 0, false)] {
            assert_eq!(rising.meets_pixel(GridPoint::new(x, y)), expected, "{x} {y}");
        }
        let falling = piece(0, 1, 1, 0);
        for (x, y, expected) in [(0, 1, true), (1, 0, true), (1, 1, true), (0, 0, false)] {
            assert_eq!(falling.meets_pixel(GridPoint::new(x, y)), expected, "{x} {y}");
        }
        assert!(piece(-7, 3, 9, 3).meets_pixel(GridPoint::new(1, 3)));
        assert!(!piece(-7, 3, 9, 3).meets_pixel(GridPoint::new(1, 4)));
        assert!(!piece(-7, 3, 9, 3).meets_pixel(GridPoint::new(10, 3)));
        let limit = 1_000_000_000;
        assert!(piece(-limit, -limit, limit, limit).meets_pixel(GridPoint::new(7, 7)));
        assert!(!piece(-limit, -limit, limit, limit).meets_pixel(GridPoint::new(limit, -limit)));
    }
}
