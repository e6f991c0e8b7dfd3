//! Routes through the free space for a round robot: a raster of the polygon with the clearance of every
//! cell, and the cheapest routes from the robot's position.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Bounds, Point, Vector};

/// Side of a cell in metres, unless the map is too large: a tenth of the narrowest doorway.
const CELL_M: f64 = 0.05;

/// The approximate limit on cells in a raster: a larger map gets larger cells.
const CELLS_LIMIT: f64 = 1.5e6;

/// Routes keep away from walls if that costs little: below this clearance in metres a step costs more.
const COMFORT_M: f64 = 0.5;

/// How far from a tight start clearance does not count, in metres: the estimate may be off by some
/// centimetres, and what is beside the robot may not have been seen well.
const ESCAPE_M: f64 = 0.6;

/// The surcharge per metre where there is not enough clearance, in metres of route.
const ESCAPE_SURCHARGE: f32 = 10.0;

/// Routes are straightened by at most this many cells: only the steps of an oblique route.
const STRAIGHT_CELLS: f64 = 0.7;

/// The raster of a free space: where the robot's centre can be, and the cost of getting there.
#[derive(Clone, Debug)]
pub struct Routes {
    origin: Point,
    cell_m: f64,
    columns: usize,
    rows: usize,
    /// Whether the cell's centre is free.
    free: Vec<bool>,
    /// Distance in metres to the nearest obstacle.
    clearance_m: Vec<f32>,
    /// Cost of the route from the start: its length in metres plus a surcharge near walls; infinite if
    /// there is none.
    cost: Vec<f32>,
    /// The previous cell on the route from the start.
    from: Vec<u32>,
}

impl Routes {
    /// The raster of a free space around `start`, before any search.
    pub fn new(free: &Shapes, start: Point) -> Self {
        Self::around(free, start, &[])
    }

    /// The same with places that are blocked whatever the free space says: where the robot touched something.
    pub fn around(free: &Shapes, start: Point, blocked: &[Point]) -> Self {
        let bounds = Bounds::of(free.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y))).with(start);
        let bounds = bounds.inflated(2.0 * CELL_M);
        let cell_m = CELL_M.max((bounds.width() * bounds.height() / CELLS_LIMIT).sqrt());
        let columns = (bounds.width() / cell_m).ceil().max(1.0) as usize;
        let rows = (bounds.height() / cell_m).ceil().max(1.0) as usize;
        let count = columns * rows;
        let mut routes = Self {
            origin: bounds.min,
            cell_m,
            columns,
            rows,
            free: vec![false; count],
            clearance_m: Vec::new(),
            cost: vec![f32::INFINITY; count],
            from: vec![u32::MAX; count],
        };
        routes.fill(free);
        for &place in blocked {
            if let Some(cell) = routes.cell(place) {
                routes.free[cell] = false;
            }
        }
        routes.clearance_m = routes.clearances();
        routes
    }

    /// The middle of a cell.
    pub fn centre(&self, cell: usize) -> Point {
        let (column, row) = (cell % self.columns, cell / self.columns);
        self.origin + Vector::new((column as f64 + 0.5) * self.cell_m, (row as f64 + 0.5) * self.cell_m)
    }

    fn cell(&self, point: Point) -> Option<usize> {
        let at = (point - self.origin) * (1.0 / self.cell_m);
        let is_in = at.x >= 0.0 && at.y >= 0.0 && at.x < self.columns as f64 && at.y < self.rows as f64;
        is_in.then(|| at.y as usize * self.columns + at.x as usize)
    }

    /// Marks the cells whose centre is inside, row by row (even-odd rule, so holes are excluded).
    fn fill(&mut self, free: &Shapes) {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.rows];
        for ring in free.iter().flatten() {
            let points = areas::points(ring);
            for (a, b) in points.iter().zip(points.iter().cycle().skip(1)) {
                let row_of = |y: f64| (y - self.origin.y) / self.cell_m - 0.5;
                let (low, high) = (row_of(a.y.min(b.y)), row_of(a.y.max(b.y)));
                let rows = low.ceil().max(0.0) as usize..(high.ceil().max(0.0) as usize).min(self.rows);
                for row in rows {
                    let y = self.origin.y + (row as f64 + 0.5) * self.cell_m;
                    crossings[row].push(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
                }
            }
        }
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let column = |x: f64| ((x - self.origin.x) / self.cell_m - 0.5).ceil().max(0.0) as usize;
                for column in column(pair[0])..column(pair[1]).min(self.columns) {
                    self.free[row * self.columns + column] = true;
                }
            }
        }
    }

    /// The distance from each free cell to the nearest blocked one, in metres, less half a cell: exact
    /// (Felzenszwalb and Huttenlocher 2012).
    fn clearances(&self) -> Vec<f32> {
        let (columns, rows) = (self.columns, self.rows);
        // Along columns first: the distance to the nearest blocked cell up and down.
        let far = (columns + rows) as f32;
        let mut along = vec![0.0_f32; columns * rows];
        for column in 0..columns {
            let mut distance = 0.0;
            for row in 0..rows {
                distance = if self.free[row * columns + column] { f32::min(distance + 1.0, far) } else { 0.0 };
                along[row * columns + column] = distance;
            }
            distance = 0.0;
            for row in (0..rows).rev() {
                distance = if self.free[row * columns + column] { f32::min(distance + 1.0, far) } else { 0.0 };
                let cell = &mut along[row * columns + column];
                *cell = cell.min(distance);
            }
        }
        let mut result = vec![0.0_f32; columns * rows];
        let mut hull: Vec<usize> = Vec::with_capacity(columns);
        let mut starts: Vec<f32> = Vec::with_capacity(columns + 1);
        for row in 0..rows {
            let squared = |q: usize| along[row * columns + q].powi(2);
            let meets = |p: usize, q: usize| {
                let (pf, qf) = (p as f32, q as f32);
                ((squared(q) + qf * qf) - (squared(p) + pf * pf)) / (2.0 * (qf - pf))
            };
            hull.clear();
            starts.clear();
            for q in 0..columns {
                let mut start = f32::NEG_INFINITY;
                while let Some(&p) = hull.last() {
                    start = meets(p, q);
                    if start > starts[hull.len() - 1] {
                        break;
                    }
                    hull.pop();
                    starts.pop();
                    start = f32::NEG_INFINITY;
                }
                hull.push(q);
                starts.push(start);
            }
            let mut k = 0;
            for q in 0..columns {
                while k + 1 < hull.len() && starts[k + 1] < q as f32 {
                    k += 1;
                }
                let p = hull[k];
                let apart = q as f32 - p as f32;
                let cells = (apart * apart + squared(p)).sqrt();
                result[row * columns + q] = (cells - 0.5).max(0.0) * self.cell_m as f32;
            }
        }
        result
    }

    /// Finds the cheapest routes for a robot of this radius in metres from `start` (Dijkstra 1959) to all
    /// cells, or until `is_enough` accepts a cell's index and cost. If the start itself is tight, after a
    /// collision say, clearance does not count until the robot is `ESCAPE_M` away from it.
    pub fn spread(&mut self, start: Point, radius_m: f64, mut is_enough: impl FnMut(usize, f64) -> bool) {
        self.cost.fill(f32::INFINITY);
        self.from.fill(u32::MAX);
        let Some(start) = self.cell(start) else { return };
        let radius = radius_m as f32;
        let mut queue = BinaryHeap::new();
        self.cost[start] = 0.0;
        queue.push((Reverse(Ordered(0.0)), Reverse(start as u32)));
        let escape_m = self.clearance_m[start];
        let cell_m = self.cell_m;
        let dx_m = |to: isize, from: usize| (to - from as isize) as f64 * cell_m;
        while let Some((Reverse(Ordered(cost)), Reverse(cell))) = queue.pop() {
            let cell = cell as usize;
            if cost > self.cost[cell] {
                continue;
            }
            if is_enough(cell, f64::from(cost)) {
                return;
            }
            let (column, row) = (cell % self.columns, cell / self.columns);
            for (dx, dy, length) in NEIGHBOURS {
                let (x, y) = (column as isize + dx, row as isize + dy);
                if x < 0 || y < 0 || x >= self.columns as isize || y >= self.rows as isize {
                    continue;
                }
                let next = y as usize * self.columns + x as usize;
                let clearance = self.clearance_m[next];
                let is_near = dx_m(x, start % self.columns).hypot(dx_m(y, start / self.columns)) <= ESCAPE_M;
                let escapes = escape_m < radius && is_near;
                let leaves = cell == start && !self.free[cell];
                if !leaves && (!self.free[next] || (clearance < radius && !escapes)) {
                    continue;
                }
                let tight = ((COMFORT_M as f32 - clearance) / COMFORT_M as f32).max(0.0);
                let surcharge = 3.0 * tight + if clearance < radius { ESCAPE_SURCHARGE } else { 0.0 };
                let step = length * self.cell_m as f32 * (1.0 + surcharge);
                if cost + step < self.cost[next] {
                    self.cost[next] = cost + step;
                    self.from[next] = cell as u32;
                    queue.push((Reverse(Ordered(cost + step)), Reverse(next as u32)));
                }
            }
        }
    }

    /// The cells about `spacing_m` apart within `reach_m` of a point that have room for a robot of this
    /// radius.
    pub fn cells_near(&self, point: Point, reach_m: f64, spacing_m: f64, radius_m: f64) -> Vec<usize> {
        let reach = (reach_m / self.cell_m).ceil() as isize;
        let stride = (spacing_m / self.cell_m).floor().max(1.0) as usize;
        let at = (point - self.origin) * (1.0 / self.cell_m);
        let (column, row) = (at.x.floor() as isize, at.y.floor() as isize);
        let mut found = Vec::new();
        for y in ((row - reach).max(0)..=(row + reach).min(self.rows as isize - 1)).step_by(stride) {
            for x in ((column - reach).max(0)..=(column + reach).min(self.columns as isize - 1)).step_by(stride) {
                let cell = y as usize * self.columns + x as usize;
                let has_room = self.free[cell] && f64::from(self.clearance_m[cell]) >= radius_m;
                if has_room && self.centre(cell).distance(point) <= reach_m {
                    found.push(cell);
                }
            }
        }
        found
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.free.len()
    }

    /// The cost of reaching a point; `None` if unreachable.
    pub fn cost(&self, point: Point) -> Option<f64> {
        let cell = self.cell(point)?;
        Some(f64::from(self.cost[cell])).filter(|cost| cost.is_finite())
    }

    /// The route from the start to a point, as points some cells apart; empty if there is none.
    pub fn way(&self, to: Point) -> Vec<Point> {
        let Some(mut cell) = self.cell(to).filter(|&cell| self.cost[cell].is_finite()) else { return Vec::new() };
        let mut cells = vec![cell];
        while self.from[cell] != u32::MAX {
            cell = self.from[cell] as usize;
            cells.push(cell);
        }
        cells.reverse();
        let points: Vec<Point> = cells.iter().map(|&cell| self.centre(cell)).collect();
        super::free_space::simplified(&points, STRAIGHT_CELLS * self.cell_m)
    }

    /// Distance in metres from a point to the nearest obstacle, to within a cell; 0 outside.
    pub fn clearance_m(&self, point: Point) -> f64 {
        self.cell(point).map_or(0.0, |cell| f64::from(self.clearance_m[cell]))
    }
}

const NEIGHBOURS: [(isize, isize, f32); 8] = [
    (1, 0, 1.0),
    (0, 1, 1.0),
    (-1, 0, 1.0),
    (0, -1, 1.0),
    (1, 1, std::f32::consts::SQRT_2),
    (-1, 1, std::f32::consts::SQRT_2),
    (-1, -1, std::f32::consts::SQRT_2),
    (1, -1, std::f32::consts::SQRT_2),
];

/// A cost with a total order: never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ordered(f32);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rooms of 4 m by 3 m, a wall of 0.2 m and a doorway of this width between them.
    fn two_rooms(door_m: f64) -> Shapes {
        let (low, high) = (1.5 - door_m / 2.0, 1.5 + door_m / 2.0);
        let ring = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, low],
            [4.2, low],
            [4.2, 0.0],
            [8.0, 0.0],
            [8.0, 3.0],
            [4.2, 3.0],
            [4.2, high],
            [4.0, high],
            [4.0, 3.0],
            [0.0, 3.0],
        ];
        vec![vec![ring.to_vec()]]
    }

    #[test]
    fn a_robot_passes_a_doorway_that_is_wide_enough() {
        let (start, end) = (Point::new(1.0, 1.0), Point::new(7.0, 2.0));
        for (door_m, passes) in [(0.9, true), (0.65, true), (0.4, false)] {
            let mut routes = Routes::new(&two_rooms(door_m), start);
            routes.spread(start, 0.25, |_, _| false);
            assert_eq!(routes.cost(end).is_some(), passes, "{door_m}");
            let way = routes.way(end);
            assert_eq!(way.is_empty(), !passes);
            for pair in way.windows(2) {
                assert!(routes.clearance_m(pair[0].midpoint(pair[1])) >= 0.2);
            }
        }
    }

    #[test]
    fn clearance_is_the_distance_to_the_wall() {
        let routes = Routes::new(&two_rooms(0.9), Point::new(1.0, 1.0));
        for (x, y, expected) in [(2.0, 1.5, 1.5), (1.0, 0.5, 0.5), (6.0, 2.7, 0.3), (4.1, 1.5, 0.45)] {
            assert!((routes.clearance_m(Point::new(x, y)) - expected).abs() < 0.06, "{x} {y}");
        }
        assert_eq!(routes.clearance_m(Point::new(-5.0, 0.0)), 0.0);
    }
}
