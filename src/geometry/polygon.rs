//! Rings and polygons as slices of points; the first point is not repeated at the end.

use robust::{Coord, orient2d};

use super::{Bounds, Point, Segment};

/// Positive when `c` lies to the left of the line from `a` to `b`, negative to the right, zero
/// exactly on it. Shewchuk's adaptive predicate (1997): the sign is exact.
pub fn orientation(a: Point, b: Point, c: Point) -> f64 {
    let coord = |p: Point| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// The edges of a ring, the closing one last.
pub fn edges(ring: &[Point]) -> impl Iterator<Item = Segment> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&a, &b)| Segment::new(a, b))
}

/// Area in m², positive for a counter-clockwise ring (the shoelace formula about the first point,
/// which keeps digits when the ring lies far from the origin).
pub fn signed_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    let twice: f64 = ring.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum();
    twice / 2.0
}

/// Area in m² of an outer ring less its holes, whatever their direction; never negative.
pub fn area<R: AsRef<[Point]>>(outer: &[Point], holes: &[R]) -> f64 {
    let holes: f64 = holes.iter().map(|hole| signed_area(hole.as_ref()).abs()).sum();
    (signed_area(outer).abs() - holes).max(0.0)
}

/// Length of a ring in metres.
pub fn perimeter(ring: &[Point]) -> f64 {
    edges(ring).map(Segment::length).sum()
}

/// The centroid of a ring's area; the mean of its points if it encloses nothing.
pub fn centroid(ring: &[Point]) -> Point {
    let Some(&origin) = ring.first() else { return Point::default() };
    let (mut twice, mut x, mut y) = (0.0, 0.0, 0.0);
    for pair in ring.windows(2) {
        let (p, q) = (pair[0] - origin, pair[1] - origin);
        let cross = p.cross(q);
        twice += cross;
        x += (p.x + q.x) * cross;
        y += (p.y + q.y) * cross;
    }
    if twice.abs() < 1e-12 {
        let n = ring.len() as f64;
        return Point::new(ring.iter().map(|p| p.x).sum::<f64>() / n, ring.iter().map(|p| p.y).sum::<f64>() / n);
    }
    Point::new(origin.x + x / (3.0 * twice), origin.y + y / (3.0 * twice))
}

/// Where a point lies relative to a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    Inside,
    Boundary,
    Outside,
}

/// Where `point` lies relative to a ring, exactly (even-odd rule).
pub fn locate_in_ring(ring: &[Point], point: Point) -> Location {
    let mut inside = false;
    for Segment { a, b } in edges(ring) {
        let upward = a.y <= point.y && b.y > point.y;
        let downward = b.y <= point.y && a.y > point.y;
        if upward || downward {
            let side = orientation(a, b, point);
            if side == 0.0 {
                return Location::Boundary;
            }
            if (side > 0.0) == upward {
                inside = !inside;
            }
        } else if a.y == point.y && b.y == point.y {
            if point.x >= a.x.min(b.x) && point.x <= a.x.max(b.x) {
                return Location::Boundary;
            }
        } else if a == point || b == point {
            return Location::Boundary;
        }
    }
    if inside { Location::Inside } else { Location::Outside }
}

/// Where `point` lies relative to an outer ring with holes; the rim of a hole is boundary.
pub fn locate<R: AsRef<[Point]>>(outer: &[Point], holes: &[R], point: Point) -> Location {
    match locate_in_ring(outer, point) {
        Location::Inside => {}
        other => return other,
    }
    for hole in holes {
        match locate_in_ring(hole.as_ref(), point) {
            Location::Inside => return Location::Outside,
            Location::Boundary => return Location::Boundary,
            Location::Outside => {}
        }
    }
    Location::Inside
}

/// Whether a ring turns only one way, once around.
pub fn is_convex(ring: &[Point]) -> bool {
    let n = ring.len();
    let turns = || (0..n).map(|i| orientation(ring[i], ring[(i + 1) % n], ring[(i + 2) % n]));
    let one_way = turns().all(|turn| turn >= 0.0) || turns().all(|turn| turn <= 0.0);
    // Once around it switches to leftward once and to rightward once; a star drawn in one stroke, more
    // often.
    let rightward: Vec<bool> =
        edges(ring).map(|edge| edge.b.x - edge.a.x).filter(|&x| x != 0.0).map(|x| x > 0.0).collect();
    let reversals = (0..rightward.len()).filter(|&i| rightward[i] != rightward[(i + 1) % rightward.len()]).count();
    one_way && reversals == 2
}

/// The bounding box of a ring.
pub fn bounds(ring: &[Point]) -> Bounds {
    Bounds::of(ring.iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [Point::new(0.0, 0.0), Point::new(2.0, 0.0), Point::new(2.0, 2.0), Point::new(0.0, 2.0)];
    const HOLE: [Point; 4] = [Point::new(0.5, 0.5), Point::new(0.5, 1.5), Point::new(1.5, 1.5), Point::new(1.5, 0.5)];

    #[test]
    fn area_subtracts_holes_of_either_direction() {
        assert_eq!(signed_area(&SQUARE), 4.0);
        assert_eq!(signed_area(&HOLE), -1.0);
        assert_eq!(area(&SQUARE, &[HOLE]), 3.0);
        assert_eq!(centroid(&SQUARE), Point::new(1.0, 1.0));
        assert_eq!(perimeter(&SQUARE), 8.0);
    }

    #[test]
    fn location_is_exact_on_edges_and_corners() {
        for (x, y, expected) in [
            (0.1, 0.1, Location::Inside),
            (0.0, 1.0, Location::Boundary),
            (1.0, 2.0, Location::Boundary),
            (2.0, 2.0, Location::Boundary),
            (0.5, 1.0, Location::Boundary),
            (1.0, 1.0, Location::Outside),
            (3.0, 0.0, Location::Outside),
            (3.0, 2.0, Location::Outside),
            (-1.0, 2.0, Location::Outside),
        ] {
            assert_eq!(locate(&SQUARE, &[HOLE], Point::new(x, y)), expected, "{x} {y}");
        }
    }
}
