//! The area of a room as a robot measures it: the mean of the areas of the inner and outer quadrilaterals
//! that best approximate its walls (paper, section 3.3).
//!
//! The paper does not define these. Here they are the smallest rectangle around the room, and the largest
//! rectangle with the same directions inside it.

use crate::geometry::{Bounds, Point, Vector, hull, polygon};

/// The inner rectangle is searched for on a raster with at most this many cells per side.
const RASTER: usize = 200;

/// The mean of the areas in m² of the smallest rectangle around a ring and the largest inside it.
pub fn mean_quadrilateral_m2(outer: &[Point]) -> f64 {
    let Some(along) = direction(outer) else { return 0.0 };
    let turned: Vec<Point> = outer
        .iter()
        .map(|&point| {
            let way = point - outer[0];
            Point::new(way.dot(along), way.dot(along.left()))
        })
        .collect();
    let bounds = Bounds::of(turned.iter().copied());
    let around_m2 = bounds.width() * bounds.height();
    (around_m2 + largest_within_m2(&turned, bounds)) / 2.0
}

/// The direction of the longer side of the smallest rectangle around a ring.
fn direction(ring: &[Point]) -> Option<Vector> {
    let hull = hull::convex_hull(ring);
    let size = |along: Vector| {
        let extent = |way: Vector| {
            let places = hull.iter().map(|&point| (point - hull[0]).dot(way));
            let (low, high) = places.fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
            high - low
        };
        extent(along) * extent(along.left())
    };
    polygon::edges(&hull).filter_map(|edge| edge.vector().unit()).min_by(|&p, &q| size(p).total_cmp(&size(q)))
}

/// The area in m² of the largest axis-aligned rectangle inside a ring, on a raster: the largest rectangle
/// under a histogram, row by row.
fn largest_within_m2(ring: &[Point], bounds: Bounds) -> f64 {
    let cell_m = (bounds.width().max(bounds.height()) / RASTER as f64).max(0.02);
    let (columns, rows) = ((bounds.width() / cell_m) as usize, (bounds.height() / cell_m) as usize);
    let mut heights = vec![0_usize; columns + 1];
    let mut largest = 0;
    for row in 0..rows {
        let y = bounds.min.y + (row as f64 + 0.5) * cell_m;
        let mut crossings: Vec<f64> = polygon::edges(ring)
            .filter(|edge| (edge.a.y <= y) != (edge.b.y <= y))
            .map(|edge| edge.a.x + (edge.b.x - edge.a.x) * (y - edge.a.y) / (edge.b.y - edge.a.y))
            .collect();
        crossings.sort_by(f64::total_cmp);
        for (column, height) in heights.iter_mut().enumerate().take(columns) {
            let x = bounds.min.x + (column as f64 + 0.5) * cell_m;
            let inside = crossings.partition_point(|&crossing| crossing < x) % 2 == 1;
            *height = if inside { *height + 1 } else { 0 };
        }
        largest = largest.max(largest_under(&heights));
    }
    largest as f64 * cell_m * cell_m
}

/// The largest rectangle under a histogram that ends with 0.
fn largest_under(heights: &[usize]) -> usize {
    let mut open: Vec<(usize, usize)> = Vec::new();
    let mut largest = 0;
    for (at, &height) in heights.iter().enumerate() {
        let mut start = at;
        while let Some(&(from, top)) = open.last()
            && top >= height
        {
            largest = largest.max(top * (at - from));
            start = from;
            open.pop();
        }
        open.push((start, height));
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)], turn_rad: f64) -> Vec<Point> {
        let turned = |&(x, y): &(f64, f64)| Point::default() + Vector::new(x, y).rotated(turn_rad);
        points.iter().map(turned).collect()
    }

    #[test]
    fn a_rectangle_is_its_own_quadrilateral_and_an_l_lies_between_two() {
        for turn_rad in [0.0, 0.4] {
            let room = ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0)], turn_rad);
            assert!((mean_quadrilateral_m2(&room) - 24.0).abs() < 0.5);
            // Around it 6 x 4, inside it 6 x 2.
            let l = ring(&[(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (2.0, 2.0), (2.0, 4.0), (0.0, 4.0)], turn_rad);
            assert!((mean_quadrilateral_m2(&l) - 18.0).abs() < 0.5);
        }
        assert_eq!(mean_quadrilateral_m2(&[]), 0.0);
    }
}
