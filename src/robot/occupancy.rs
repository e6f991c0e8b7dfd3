//! Grid maps from what a robot saw: cells that beams passed are free, cells where they ended are not
//! (Moravec and Elfes 1985, with counts in place of probabilities).

use super::grid_map::{Cell, GridMap, MOST_CELLS};
use super::{Pose, Scan};
use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Bounds, Point};

/// Side of a cell in metres: the usual resolution of robots' maps.
pub const CELL_M: f64 = 0.05;

/// Only this much of a beam is used, in metres: further out, neighbouring beams are more than two cells
/// apart, and the heading's error moves a hit by more than a wall's thickness.
const USED_M: f64 = 12.0;

/// A cell is occupied if at least this share of the beams that met it ended there: beams that graze a wall
/// pass many of its cells, and people who walked by ended few.
const OCCUPIED_SHARE: f64 = 0.2;

/// A cell is free if at least this many beams passed it: a single one may be a false reading.
const LEAST_PASSES: u32 = 2;

/// What beams did in a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Beams {
    ended: u32,
    passed: u32,
}

/// The grid map of scans, each with the robot's pose in the map's frame; `None` if they saw nothing. Takes
/// time in proportion to the lengths of the beams.
pub fn grid_map<'a>(looks: impl Iterator<Item = (Pose, &'a [Scan])> + Clone) -> Option<GridMap> {
    let mut bounds = Bounds::EMPTY;
    let looks_at: Vec<Point> = looks.clone().map(|(map_from_robot, _)| map_from_robot.position()).collect();
    for (map_from_robot, scans) in looks.clone() {
        for scan in scans {
            let map_from_scanner = map_from_robot.compose(scan.robot_from_scanner);
            bounds = bounds.with(map_from_scanner.position());
            let used = scan.points().filter(|&(beam, _)| scan.range_m(beam).is_some_and(|range_m| range_m <= USED_M));
            bounds = used.fold(bounds, |bounds, (_, point)| bounds.with(map_from_scanner.apply(point)));
        }
    }
    if bounds.is_empty() {
        return None;
    }
    let frame = Grid::around(bounds);
    let mut beams = vec![Beams::default(); frame.width * frame.height];
    for (map_from_robot, scans) in looks {
        for scan in scans {
            let map_from_scanner = map_from_robot.compose(scan.robot_from_scanner);
            for (beam, point) in scan.points() {
                let range_m = scan.range_m(beam).unwrap_or(0.0);
                let from = map_from_scanner.position();
                let to = map_from_scanner.apply(point);
                let end = from.lerp(to, (USED_M / range_m).min(1.0));
                frame.along(from, end, |cell| beams[cell].passed += 1);
                if range_m <= USED_M
                    && let Some(cell) = frame.cell(to)
                {
                    // The last cell was passed only up to the hit.
                    beams[cell].passed = beams[cell].passed.saturating_sub(1);
                    beams[cell].ended += 1;
                }
            }
        }
    }
    let state = |beams: &Beams| {
        let met = f64::from(beams.ended + beams.passed);
        match (beams.ended, beams.passed) {
            (1.., _) if f64::from(beams.ended) >= OCCUPIED_SHARE * met => Cell::Occupied,
            (_, LEAST_PASSES..) => Cell::Free,
            _ => Cell::Unknown,
        }
    };
    let mut cells: Vec<Cell> = beams.iter().map(state).collect();
    frame.forget_unreached(&mut cells, looks_at.iter().copied());
    frame.map(cells)
}

/// The grid map of a known free space: what is not free counts as occupied. `None` if it is empty.
pub fn of_free_space(free: &Shapes) -> Option<GridMap> {
    let bounds = Bounds::of(free.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y)));
    if bounds.is_empty() {
        return None;
    }
    let frame = Grid::around(bounds);
    let mut cells = vec![Cell::Occupied; frame.width * frame.height];
    // Where the boundaries cross each row of cells' centres.
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); frame.height];
    for ring in free.iter().flatten() {
        let ring = areas::points(ring);
        for edge in crate::geometry::polygon::edges(&ring) {
            let (a, b) = (frame.in_cells(edge.a), frame.in_cells(edge.b));
            let (low, high) = (a.y.min(b.y), a.y.max(b.y));
            // A row from its lower end up to its upper, half-open, so that corners count once.
            let first = (low - 0.5).ceil().max(0.0) as usize;
            let end = ((high - 0.5).ceil().max(0.0) as usize).min(frame.height);
            for (row, crossed) in crossings.iter_mut().enumerate().take(end).skip(first) {
                crossed.push(a.x + (b.x - a.x) * (row as f64 + 0.5 - a.y) / (b.y - a.y));
            }
        }
    }
    for (row, crossed) in crossings.iter_mut().enumerate() {
        crossed.sort_by(f64::total_cmp);
        for pair in crossed.chunks_exact(2) {
            let column = |at: f64| ((at - 0.5).ceil().max(0.0) as usize).min(frame.width);
            cells[row * frame.width..][column(pair[0])..column(pair[1])].fill(Cell::Free);
        }
    }
    frame.map(cells)
}

/// A grid in the map's frame; rows from the bottom.
struct Grid {
    origin: Point,
    cell_m: f64,
    width: usize,
    height: usize,
}

impl Grid {
    /// With a margin of some cells. Where it would be too large, the cells are.
    fn around(bounds: Bounds) -> Self {
        const MARGIN_CELLS: f64 = 4.0;
        let mut cell_m = CELL_M;
        loop {
            let side = |length_m: f64| (length_m / cell_m).ceil().min(1e9) as usize + 2 * MARGIN_CELLS as usize;
            let (width, height) = (side(bounds.width()), side(bounds.height()));
            if width.saturating_mul(height) <= MOST_CELLS {
                // On multiples of a cell, so that what lies elsewhere does not shift the grid.
                let start = |at: f64| ((at / cell_m).floor() - MARGIN_CELLS) * cell_m;
                return Self { origin: Point::new(start(bounds.min.x), start(bounds.min.y)), cell_m, width, height };
            }
            cell_m *= 2.0;
        }
    }

    fn in_cells(&self, point: Point) -> Point {
        Point::new((point.x - self.origin.x) / self.cell_m, (point.y - self.origin.y) / self.cell_m)
    }

    fn cell(&self, point: Point) -> Option<usize> {
        let at = self.in_cells(point);
        let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < self.width as f64 && at.y < self.height as f64;
        inside.then(|| at.y as usize * self.width + at.x as usize)
    }

    /// Visits the cells that a line passes, from its start (Amanatides and Woo 1987).
    fn along(&self, from: Point, to: Point, mut visit: impl FnMut(usize)) {
        let (a, b) = (self.in_cells(from), self.in_cells(to));
        let (mut x, mut y) = (a.x.floor() as i64, a.y.floor() as i64);
        let (end_x, end_y) = (b.x.floor() as i64, b.y.floor() as i64);
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        let (step_x, step_y) = (dx.signum() as i64, dy.signum() as i64);
        let first = |at: f64, way: f64| {
            let left = if way > 0.0 { at.floor() + 1.0 - at } else { at - at.floor() };
            if way == 0.0 { f64::INFINITY } else { left / way.abs() }
        };
        let (mut next_x, mut next_y) = (first(a.x, dx), first(a.y, dy));
        let (each_x, each_y) = (dx.abs().recip(), dy.abs().recip());
        let count = (end_x - x).abs() + (end_y - y).abs();
        for step in 0..=count {
            if (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y) {
                visit(y as usize * self.width + x as usize);
            }
            if step == count {
                break;
            }
            if next_x < next_y {
                x += step_x;
                next_x += each_x;
            } else {
                y += step_y;
                next_y += each_y;
            }
        }
    }

    /// Makes free cells unknown that no way along free cells joins to where the robot was: what a beam saw
    /// behind glass or in a mirror.
    fn forget_unreached(&self, cells: &mut [Cell], from: impl Iterator<Item = Point>) {
        let mut reached = vec![false; cells.len()];
        let mut open: Vec<usize> = from.filter_map(|point| self.cell(point)).collect();
        while let Some(cell) = open.pop() {
            if std::mem::replace(&mut reached[cell], true) {
                continue;
            }
            let (x, y) = (cell % self.width, cell / self.width);
            let beside = [
                (x > 0).then(|| cell - 1),
                (x + 1 < self.width).then(|| cell + 1),
                (y > 0).then(|| cell - self.width),
                (y + 1 < self.height).then(|| cell + self.width),
            ];
            open.extend(beside.into_iter().flatten().filter(|&next| cells[next] == Cell::Free && !reached[next]));
        }
        for (cell, reached) in cells.iter_mut().zip(reached) {
            if *cell == Cell::Free && !reached {
                *cell = Cell::Unknown;
            }
        }
    }

    /// The map of cells given from the bottom row up.
    fn map(&self, cells: Vec<Cell>) -> Option<GridMap> {
        let from_top = cells.chunks_exact(self.width).rev().flatten().copied().collect();
        let map_from_grid = Pose::new(self.origin.x, self.origin.y, 0.0);
        GridMap::new(self.width, self.height, self.cell_m, map_from_grid, from_top).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scan from the middle of a square room of 4 m, all around.
    fn scan() -> Scan {
        let beams = 720;
        let step_rad = std::f64::consts::TAU / f64::from(beams);
        let range_m = |beam: i32| {
            let (sin, cos) = (f64::from(beam) * step_rad).sin_cos();
            2.0 / sin.abs().max(cos.abs())
        };
        Scan {
            ranges_m: (0..beams).map(range_m).collect(),
            start_rad: 0.0,
            step_rad,
            max_range_m: 20.0,
            robot_from_scanner: Pose::IDENTITY,
        }
    }

    #[test]
    fn beams_pass_free_cells_and_end_in_occupied_ones() {
        let scans = [scan()];
        let at = Pose::new(10.0, -3.0, 0.4);
        let map = grid_map([(at, &scans[..]), (at, &scans[..])].into_iter()).unwrap();
        let cell = |x: f64, y: f64| {
            let (x, y) = map.picture_from_map(at.apply(Point::new(x, y)));
            map.cells()[y as usize * map.width() + x as usize]
        };
        assert_eq!((cell(0.0, 0.0), cell(1.8, -1.8), cell(-1.9, 0.7)), (Cell::Free, Cell::Free, Cell::Free));
        // The wall runs obliquely through the cells: it is in this one or in one beside it.
        let has_wall_near = |x: f64, y: f64| {
            let steps = [-0.05, 0.0, 0.05];
            steps.iter().any(|dx| steps.iter().any(|dy| cell(x + dx, y + dy) == Cell::Occupied))
        };
        assert!(has_wall_near(2.0, 0.5) && has_wall_near(-1.0, 2.0) && !has_wall_near(1.0, 1.0));
        let free_m2 = map.cells().iter().filter(|&&cell| cell == Cell::Free).count() as f64 * CELL_M * CELL_M;
        assert!((15.0..16.0).contains(&free_m2), "{free_m2} m²");
        assert!(grid_map(std::iter::empty()).is_none());
    }

    #[test]
    fn a_free_space_with_a_hole_keeps_its_area() {
        let ring = |low: f64, high: f64, is_hole: bool| {
            let corners = [(low, low), (high, low), (high, high), (low, high)].map(|(x, y)| Point::new(x, y));
            areas::directed(&corners, !is_hole)
        };
        let map = of_free_space(&vec![vec![ring(0.0, 3.0, false), ring(1.0, 2.0, true)]]).unwrap();
        let free = map.cells().iter().filter(|&&cell| cell == Cell::Free).count();
        assert_eq!(free, 60 * 60 - 20 * 20);
    }
}
