//! Finds the rooms of a grid map. The paper finds rooms in line maps by mutual visibility; in furnished
//! grids of whole floors that rule splits corridors and joins rooms with wide doors, so this is a second
//! method, reported separately (`docs/robot-maps.md`).
//!
//! Clutter is removed by size; the free space is cut wherever the free end of a wall faces another wall
//! across a gap (`wall_ends`) and wherever it is narrow (`narrows`); then pieces are rejoined across
//! cuts that are neither narrow nor continue a wall between them (`regions`).

mod contours;
mod distance;
mod narrows;
mod regions;
mod union;
mod wall_ends;

use super::grid_map::{Cell, GridMap};
use crate::geometry::Point;

pub use contours::{outlines, simplified};
pub use regions::{Cut, SMALLEST_ROOM_M2};

/// The rooms of a map, cell by cell.
#[derive(Clone, Debug)]
pub struct Segmentation {
    /// The region of every cell of the map: rooms have the numbers 1 to [`Self::rooms`], patches of free
    /// space too small to be rooms have larger ones, and cells that are not free have 0.
    pub region_of_cell: Vec<u32>,
    /// The number of rooms.
    pub rooms: u32,
    /// The number of regions, patches included.
    pub regions: u32,
    /// The cuts between two rooms, in cells of the picture, y down. Several may pass through one doorway.
    pub cuts: Vec<Cut>,
}

/// How the free space is cut, and what is joined again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentOptions {
    /// A cut is considered where the free space is narrower than this share of what it is on both sides.
    pub widest_share: f64,
    /// A cut alone separates two rooms if it is narrower than this share of both: of the diameters of the
    /// largest discs inside them.
    pub narrow_share: f64,
    /// A wall separates two rooms where both are within this distance of its middle, in metres.
    pub wall_reach_m: f64,
    /// Rooms smaller than this, in square metres, join a neighbour unless the robot was in them.
    pub least_unvisited_m2: f64,
}

impl SegmentOptions {
    /// For maps of which no more is known.
    pub const MAP: Self = Self { widest_share: 0.85, narrow_share: 0.6, wall_reach_m: 0.45, least_unvisited_m2: 0.0 };

    /// For the grid of a log. What stands along the walls of a room in use makes it narrower and its walls
    /// thicker, and bays between desks look like rooms; but a robot does not enter those.
    pub const LOG: Self = Self { widest_share: 0.95, narrow_share: 0.75, wall_reach_m: 0.8, least_unvisited_m2: 4.0 };
}

/// A smaller area enclosed by walls, in square metres, is a gap between the two scanned faces of a wall,
/// not free space.
const SMALLEST_FREE_M2: f64 = 0.25;
/// Isolated obstacles with a smaller diagonal, in metres, are furniture, its legs, or noise; walls are
/// connected over longer distances.
const LARGEST_CLUTTER_M: f64 = 1.2;

/// Finds the rooms of a map.
pub fn segment(map: &GridMap) -> Segmentation {
    segment_with(map, &SegmentOptions::MAP, &[])
}

/// Finds the rooms of a map. `visited`: the cells where the robot was, by index.
pub fn segment_with(map: &GridMap, options: &SegmentOptions, visited: &[usize]) -> Segmentation {
    let is_free: Vec<bool> = map.cells().iter().map(|&cell| cell == Cell::Free).collect();
    let mut raster =
        Raster { width: map.width(), height: map.height(), resolution_m: map.resolution_m, free: is_free.clone() };
    raster.close_small_spaces();
    raster.remove_clutter();
    let distances = distance::distances(&raster.free, raster.width, raster.height);
    let mut gaps = wall_ends::gaps(&raster);
    gaps.extend(narrows::narrows(&raster, &distances, options.widest_share));
    let found = regions::regions(&raster, &distances, &gaps, options, visited);
    numbered(&raster, &is_free, found)
}

/// Rooms first, then the patches too small to be rooms, including those closed as too small to be free.
fn numbered(raster: &Raster, is_free: &[bool], found: regions::Regions) -> Segmentation {
    let mut area = vec![0u32; found.count as usize + 1];
    for &region in &found.of_cell {
        area[region as usize] += 1;
    }
    let least = raster.cells(SMALLEST_ROOM_M2.sqrt()).powi(2);
    let mut numbers = vec![0; found.count as usize + 1];
    let (mut rooms, mut regions) = (0, 0);
    for wants_rooms in [true, false] {
        for region in 1..=found.count as usize {
            if (f64::from(area[region]) >= least) == wants_rooms {
                regions += 1;
                numbers[region] = regions;
            }
        }
        if wants_rooms {
            rooms = regions;
        }
    }
    let mut region_of_cell: Vec<u32> = found.of_cell.iter().map(|&region| numbers[region as usize]).collect();
    let (pockets, count) = raster.components(|cell| is_free[cell] && region_of_cell[cell] == 0);
    for (region, pocket) in region_of_cell.iter_mut().zip(pockets).filter(|(_, pocket)| *pocket != 0) {
        *region = regions + pocket;
    }
    let cuts = found.cuts.into_iter().map(|cut| Cut { regions: cut.regions.map(|at| numbers[at as usize]), ..cut });
    let cuts = cuts.filter(|cut| cut.regions.iter().all(|&region| region <= rooms)).collect();
    Segmentation { region_of_cell, rooms, regions: regions + count, cuts }
}

/// Which cells are free, from the top, while rooms are being found.
struct Raster {
    width: usize,
    height: usize,
    resolution_m: f64,
    free: Vec<bool>,
}

impl Raster {
    /// A length in cells.
    fn cells(&self, length_m: f64) -> f64 {
        length_m / self.resolution_m
    }

    fn is_free(&self, x: i32, y: i32) -> bool {
        let inside = (0..self.width as i32).contains(&x) && (0..self.height as i32).contains(&y);
        inside && self.free[y as usize * self.width + x as usize]
    }

    fn is_free_at(&self, point: Point) -> bool {
        self.cell_at(point).is_some_and(|cell| self.free[cell])
    }

    /// The cell at a point in cells; `None` outside.
    fn cell_at(&self, point: Point) -> Option<usize> {
        let (x, y) = (point.x.floor(), point.y.floor());
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64;
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// Numbers the 4-connected components of cells from 1, in the order of their first cells, and other
    /// cells 0; also returns their number.
    fn components(&self, belongs: impl Fn(usize) -> bool) -> (Vec<u32>, u32) {
        self.components_by(&[(0, -1), (-1, 0), (1, 0), (0, 1)], belongs)
    }

    fn components_by(&self, steps: &[(i32, i32)], belongs: impl Fn(usize) -> bool) -> (Vec<u32>, u32) {
        let mut numbers = vec![0; self.free.len()];
        let mut count = 0;
        let mut open = Vec::new();
        for start in 0..self.free.len() {
            if numbers[start] != 0 || !belongs(start) {
                continue;
            }
            count += 1;
            numbers[start] = count;
            open.push(start);
            while let Some(cell) = open.pop() {
                for next in self.beside(cell, steps) {
                    if numbers[next] == 0 && belongs(next) {
                        numbers[next] = count;
                        open.push(next);
                    }
                }
            }
        }
        (numbers, count)
    }

    fn beside(&self, cell: usize, steps: &[(i32, i32)]) -> impl Iterator<Item = usize> {
        let (x, y) = ((cell % self.width) as i32, (cell / self.width) as i32);
        let (width, height) = (self.width as i32, self.height as i32);
        steps.iter().filter_map(move |&(dx, dy)| {
            let (x, y) = (x + dx, y + dy);
            ((0..width).contains(&x) && (0..height).contains(&y)).then_some((y * width + x) as usize)
        })
    }

    /// Gives free cells without a number that of the nearest numbered one, by 4-connected steps.
    fn spread(&self, numbers: &mut [u32]) {
        const STEPS: [(i32, i32); 4] = [(0, -1), (-1, 0), (1, 0), (0, 1)];
        let is_open = |numbers: &[u32], cell: usize| self.free[cell] && numbers[cell] == 0;
        let mut rim: Vec<usize> = (0..numbers.len())
            .filter(|&cell| numbers[cell] != 0 && self.beside(cell, &STEPS).any(|next| is_open(numbers, next)))
            .collect();
        while !rim.is_empty() {
            let mut next_rim = Vec::new();
            for cell in rim {
                for next in self.beside(cell, &STEPS) {
                    if is_open(numbers, next) {
                        numbers[next] = numbers[cell];
                        next_rim.push(next);
                    }
                }
            }
            rim = next_rim;
        }
    }

    fn close_small_spaces(&mut self) {
        let (spaces, count) = self.components(|cell| self.free[cell]);
        let mut area = vec![0u32; count as usize + 1];
        for &space in &spaces {
            area[space as usize] += 1;
        }
        let least = self.cells(SMALLEST_FREE_M2.sqrt()).powi(2);
        for (free, space) in self.free.iter_mut().zip(spaces) {
            *free = *free && f64::from(area[space as usize]) >= least;
        }
    }

    fn remove_clutter(&mut self) {
        const STEPS: [(i32, i32); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        let (things, count) = self.components_by(&STEPS, |cell| !self.free[cell]);
        let mut bounds = vec![[usize::MAX, usize::MAX, 0, 0]; count as usize + 1];
        for (cell, &thing) in things.iter().enumerate() {
            let (x, y) = (cell % self.width, cell / self.width);
            let [left, top, right, bottom] = bounds[thing as usize];
            bounds[thing as usize] = [left.min(x), top.min(y), right.max(x + 1), bottom.max(y + 1)];
        }
        let most = self.cells(LARGEST_CLUTTER_M);
        let is_clutter: Vec<bool> = bounds
            .iter()
            .map(|&[left, top, right, bottom]| {
                let (wide, high) = (right.saturating_sub(left) as f64, bottom.saturating_sub(top) as f64);
                wide.hypot(high) < most
            })
            .collect();
        for (free, thing) in self.free.iter_mut().zip(things) {
            *free |= thing != 0 && is_clutter[thing as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Pose;

    /// A room of 4 m by 4 m with a bay of 1.6 m by 1.6 m behind an opening of 1 m in a wall of 0.2 m.
    fn room_with_bay() -> GridMap {
        let (width, height) = (130, 90);
        let is_free = |x: usize, y: usize| {
            let within = |left, top, right, bottom| (left..right).contains(&x) && (top..bottom).contains(&y);
            within(5, 5, 85, 85) || within(85, 35, 89, 55) || within(89, 29, 121, 61)
        };
        let cells = (0..width * height).map(|cell| match is_free(cell % width, cell / width) {
            true => Cell::Free,
            false => Cell::Occupied,
        });
        GridMap::new(width, height, 0.05, Pose::IDENTITY, cells.collect()).unwrap()
    }

    #[test]
    fn a_bay_is_a_room_only_if_the_robot_was_in_it() {
        let map = room_with_bay();
        let rooms = |visited: &[usize]| segment_with(&map, &SegmentOptions::LOG, visited).rooms;
        let (room, bay) = (45 * 130 + 40, 45 * 130 + 100);
        assert_eq!((rooms(&[room]), rooms(&[room, bay])), (1, 2));
        assert_eq!(segment(&map).rooms, 2);
    }
}
