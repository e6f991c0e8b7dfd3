//! The convex hull of points, and the smallest rectangle around them.

use super::{Point, Vector, polygon};

/// The convex hull, counter-clockwise, without points in the middle of edges (Andrew's monotone chain,
/// 1979, with exact orientation). Fewer than three points when all are collinear.
pub fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = chain(sorted.iter().copied());
    hull.extend(chain(sorted.iter().rev().copied()));
    hull
}

/// One side of the hull, without its last point, which is the first of the other side.
fn chain(points: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut side: Vec<Point> = Vec::new();
    for point in points {
        while let [.., a, b] = side[..]
            && polygon::orientation(a, b, point) <= 0.0
        {
            side.pop();
        }
        side.push(point);
    }
    side.pop();
    side
}

/// Length and width in metres (length is the larger) of the minimum-area rectangle around the points, at
/// any angle. One of its sides lies along an edge of the hull (Freeman and Shapira 1975).
pub fn smallest_rectangle(points: &[Point]) -> (f64, f64) {
    let hull = convex_hull(points);
    let mut best = (f64::INFINITY, f64::INFINITY);
    for edge in polygon::edges(&hull) {
        let Some(along) = edge.vector().unit() else { continue };
        let extent = |direction: Vector| {
            let reach = hull.iter().map(|&point| (point - edge.a).dot(direction));
            let (low, high) = reach.fold((0.0f64, 0.0f64), |(low, high), at| (low.min(at), high.max(at)));
            high - low
        };
        let (p, q) = (extent(along), extent(along.left()));
        if p * q < best.0 * best.1 {
            best = (p.max(q), p.min(q));
        }
    }
    if best.0.is_finite() { best } else { (0.0, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(coordinates: &[(f64, f64)]) -> Vec<Point> {
        coordinates.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn a_notch_is_filled_and_a_turned_rectangle_is_measured_along_its_sides() {
        let l = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0), (2.0, 0.0)]);
        assert_eq!(convex_hull(&l), points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 3.0), (0.0, 3.0)]));
        assert_eq!(smallest_rectangle(&l), (4.0, 3.0));
        let turned: Vec<Point> = points(&[(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (0.0, 2.0)])
            .into_iter()
            .map(|p| Point::default() + (p - Point::default()).rotated(0.3))
            .collect();
        let (length_m, width_m) = smallest_rectangle(&turned);
        assert!((length_m - 6.0).abs() < 1e-9 && (width_m - 2.0).abs() < 1e-9);
    }

    #[test]
    fn what_has_no_extent_has_no_rectangle() {
        for few in [points(&[]), points(&[(1.0, 1.0)]), points(&[(0.0, 0.0), (0.0, 0.0)])] {
            assert_eq!(smallest_rectangle(&few), (0.0, 0.0));
        }
        assert_eq!(smallest_rectangle(&points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])).1, 0.0);
    }
}
