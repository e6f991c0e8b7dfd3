//! A grid of square cells for ray casting: a ray looks only at segments in the cells it crosses.

use crate::geometry::{Bounds, Point, Segment, Vector};

/// Side of a cell in metres, unless the segments need larger ones: a ray in a room crosses a dozen cells,
/// few of which hold more than two walls.
const CELL_M: f64 = 0.5;

/// The most cells, so that two segments at opposite ends of the world do not cost gigabytes.
const CELLS_LIMIT: f64 = 4e6;

/// Immutable segments, indexed for ray casting.
#[derive(Clone, Debug)]
pub struct RayGrid {
    segments: Vec<Segment>,
    origin: Point,
    cell_m: f64,
    columns: usize,
    rows: usize,
    /// Where each cell's entries start in `entries`; one more at the end.
    starts: Vec<u32>,
    entries: Vec<u32>,
}

/// A ray's hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Metres from the ray's origin.
    pub distance_m: f64,
    /// Index of the segment, as given to [`RayGrid::new`].
    pub segment: usize,
}

impl RayGrid {
    /// A grid over segments; those with a non-finite end are never hit.
    pub fn new(segments: Vec<Segment>) -> Self {
        let is_sound = |segment: &Segment| segment.a.is_finite() && segment.b.is_finite();
        let bounds = segments
            .iter()
            .filter(|s| is_sound(s))
            .fold(Bounds::EMPTY, |all, s| all.with(s.a).with(s.b))
            .inflated(1e-6);
        let (width, height) = (bounds.width(), bounds.height());
        let cell_m = CELL_M.max((width * height / CELLS_LIMIT).sqrt()).max(width.max(height) / CELLS_LIMIT);
        let columns = (width / cell_m).ceil().max(1.0) as usize;
        let rows = (height / cell_m).ceil().max(1.0) as usize;
        let origin = if bounds.is_empty() { Point::default() } else { bounds.min };
        let mut grid =
            Self { segments, origin, cell_m, columns, rows, starts: vec![0; columns * rows + 1], entries: Vec::new() };
        let mut cells: Vec<(u32, u32)> = Vec::new();
        for (index, segment) in grid.segments.iter().enumerate().filter(|(_, segment)| is_sound(segment)) {
            grid.cells_touched(*segment, |cell| cells.push((cell as u32, index as u32)));
        }
        cells.sort_unstable();
        for &(cell, index) in &cells {
            grid.starts[cell as usize + 1] += 1;
            grid.entries.push(index);
        }
        for cell in 0..columns * rows {
            grid.starts[cell + 1] += grid.starts[cell];
        }
        grid
    }

    /// The segments, in the order given.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Calls `each` for the cells whose slightly enlarged square a segment meets.
    fn cells_touched(&self, segment: Segment, mut each: impl FnMut(usize)) {
        let bounds = segment.bounds();
        let ([left, low], [right, high]) = (self.cell_of(bounds.min), self.cell_of(bounds.max));
        let half = self.cell_m * 0.5 * (1.0 + 1e-6);
        let normal = segment.vector().left();
        for row in low..=high {
            for column in left..=right {
                let centre =
                    self.origin + Vector::new((column as f64 + 0.5) * self.cell_m, (row as f64 + 0.5) * self.cell_m);
                // The line meets the square if its centre is no further from the line than the square
                // extends that way.
                let aside = normal.dot(centre - segment.a).abs();
                if aside <= half * (normal.x.abs() + normal.y.abs()) + 1e-9 {
                    each(row * self.columns + column);
                }
            }
        }
    }

    fn cell_of(&self, point: Point) -> [usize; 2] {
        let at = |along: f64, count: usize| (along / self.cell_m).floor().clamp(0.0, (count - 1) as f64) as usize;
        [at(point.x - self.origin.x, self.columns), at(point.y - self.origin.y, self.rows)]
    }

    fn in_cell(&self, column: usize, row: usize) -> &[u32] {
        let cell = row * self.columns + column;
        &self.entries[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The first segment hit by the ray from `origin` along the unit vector `direction` within `reach_m`
    /// metres. A segment through the origin is hit at 0.
    pub fn cast(&self, origin: Point, direction: Vector, reach_m: f64) -> Option<Hit> {
        let (width, height) = (self.columns as f64 * self.cell_m, self.rows as f64 * self.cell_m);
        let from = origin - self.origin;
        // Clip to the grid's box.
        let (mut enter, mut leave) = (0.0_f64, reach_m);
        for (at, along, size) in [(from.x, direction.x, width), (from.y, direction.y, height)] {
            if along.abs() < 1e-15 {
                if at < 0.0 || at > size {
                    return None;
                }
                continue;
            }
            let (near, far) = ((0.0 - at) / along, (size - at) / along);
            enter = enter.max(near.min(far));
            leave = leave.min(near.max(far));
        }
        if enter > leave {
            return None;
        }
        let start = origin + direction * enter;
        let [mut column, mut row] = self.cell_of(start).map(|index| index as isize);
        let step = |along: f64| if along > 0.0 { 1 } else { -1 };
        let (step_x, step_y) = (step(direction.x), step(direction.y));
        let crossing = |index: isize, along: f64, at: f64| {
            if along.abs() < 1e-15 {
                return f64::INFINITY;
            }
            let border = (index + isize::from(along > 0.0)) as f64 * self.cell_m;
            (border - at) / along
        };
        let mut next_x = crossing(column, direction.x, from.x);
        let mut next_y = crossing(row, direction.y, from.y);
        let (delta_x, delta_y) = (self.cell_m / direction.x.abs(), self.cell_m / direction.y.abs());
        let mut best: Option<Hit> = None;
        let mut nearest = reach_m;
        loop {
            for &index in self.in_cell(column as usize, row as usize) {
                let segment = self.segments[index as usize];
                if let Some(distance_m) = hit_m(origin, direction, segment)
                    && distance_m <= nearest
                {
                    // If two are at the same place, the first: deterministic.
                    let is_first = best.is_none_or(|hit| distance_m < hit.distance_m || (index as usize) < hit.segment);
                    if is_first {
                        best = Some(Hit { distance_m, segment: index as usize });
                        nearest = distance_m;
                    }
                }
            }
            let next = next_x.min(next_y);
            if next >= nearest || next > leave {
                return best;
            }
            if next_x < next_y {
                column += step_x;
                next_x += delta_x;
            } else {
                row += step_y;
                next_y += delta_y;
            }
            if column < 0 || row < 0 || column >= self.columns as isize || row >= self.rows as isize {
                return best;
            }
        }
    }

    /// Whether any segment blocks the line between two points.
    pub fn blocks(&self, from: Point, to: Point) -> bool {
        let way = to - from;
        way.unit().is_some_and(|direction| self.cast(from, direction, way.length()).is_some())
    }

    /// The indices of segments in the cells that a box meets, sorted, without repeats.
    pub fn near(&self, bounds: Bounds) -> Vec<usize> {
        let ([left, low], [right, high]) = (self.cell_of(bounds.min), self.cell_of(bounds.max));
        let mut found: Vec<usize> = Vec::new();
        for row in low..=high {
            for column in left..=right {
                found.extend(self.in_cell(column, row).iter().map(|&index| index as usize));
            }
        }
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Distance in metres to the nearest segment, up to `reach_m`.
    pub fn distance_m(&self, point: Point, reach_m: f64) -> f64 {
        let near = self.near(Bounds::of([point]).inflated(reach_m));
        near.into_iter().map(|index| self.segments[index].distance(point)).fold(reach_m, f64::min)
    }
}

/// The distance along the ray to a segment, if hit. Ends count, with a small tolerance, so that no ray
/// slips through a corner. A ray along a segment hits its nearer end.
pub(super) fn hit_m(origin: Point, direction: Vector, segment: Segment) -> Option<f64> {
    let along = segment.vector();
    let to = segment.a - origin;
    let denominator = direction.cross(along);
    if denominator.abs() < 1e-12 {
        let aside = direction.cross(to).abs();
        let (near, far) = (to.dot(direction), (segment.b - origin).dot(direction));
        let first = near.min(far).max(0.0);
        return (aside < 1e-9 && near.max(far) >= 0.0).then_some(first);
    }
    let on_segment = to.cross(direction) / denominator;
    let distance_m = to.cross(along) / denominator;
    ((-1e-9..=1.0 + 1e-9).contains(&on_segment) && distance_m >= 0.0).then_some(distance_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        (-8.0..8.0, -8.0..8.0).prop_map(|(x, y)| Point::new(x, y))
    }

    proptest! {
        /// The grid finds the same as testing every segment.
        #[test]
        fn a_ray_hits_what_is_nearest(
            ends in prop::collection::vec((point(), point()), 0..40),
            origin in point(), angle in 0.0..6.3, reach in 0.0..20.0,
        ) {
            let segments: Vec<Segment> = ends.iter().map(|&(a, b)| Segment::new(a, b)).collect();
            let direction = Vector::new(1.0, 0.0).rotated(angle);
            let nearest = segments.iter().filter_map(|&s| hit_m(origin, direction, s)).fold(f64::INFINITY, f64::min);
            let found = RayGrid::new(segments).cast(origin, direction, reach);
            prop_assert_eq!(found.map(|hit| hit.distance_m), (nearest <= reach).then_some(nearest));
        }
    }

    #[test]
    fn nothing_is_hit_where_nothing_is() {
        let none = RayGrid::new(Vec::new());
        assert_eq!(none.cast(Point::default(), Vector::new(1.0, 0.0), 10.0), None);
        let broken = RayGrid::new(vec![Segment::new(Point::new(f64::NAN, 0.0), Point::new(1.0, 0.0))]);
        assert_eq!(broken.cast(Point::default(), Vector::new(1.0, 0.0), 10.0), None);
        let wall = RayGrid::new(vec![Segment::new(Point::new(2.0, -1.0), Point::new(2.0, 1.0))]);
        assert!(wall.blocks(Point::new(0.0, 0.0), Point::new(3.0, 0.0)));
        assert!(!wall.blocks(Point::new(0.0, 0.0), Point::new(1.5, 0.0)));
        assert!((wall.distance_m(Point::new(0.0, 0.0), 5.0) - 2.0).abs() < 1e-12);
    }
}
