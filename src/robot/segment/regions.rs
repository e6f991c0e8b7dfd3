//! Cuts the free space along its gaps and narrow places, and rejoins pieces that no wall separates.

use std::collections::BTreeSet;

use super::distance::{self, Distances};
use super::union::Union;
use super::{Raster, SegmentOptions};
use crate::geometry::{Point, Vector};

/// Smaller pieces, in square metres, are never rooms of their own beside a larger one: the space between
/// two cuts through the same doorway, or the depth of a niche.
pub const SMALLEST_ROOM_M2: f64 = 1.0;
/// A cut that is not narrow must continue, within [`WALL_LOOKED_AT_M`] of its ends, a wall between the same two rooms
/// of at least this length, which is also at least this share of the cut.
const LEAST_WALL_M: f64 = 0.4;
const LEAST_WALL_SHARE: f64 = 0.15;
const WALL_LOOKED_AT_M: f64 = 2.0;
/// Tolerated gaps in that wall, in cells: where it is badly scanned, or another wall meets it.
const WALL_GAP_CELLS: u32 = 6;

/// A straight cut through free space, in cells, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    pub ends: [Point; 2],
    /// The regions it separates in the end.
    pub regions: [u32; 2],
}

/// The result of cutting.
pub struct Regions {
    /// The region of every cell, from 1; 0 if it belongs to none.
    pub of_cell: Vec<u32>,
    /// The number of regions, which are numbered from 1.
    pub count: u32,
    /// The cuts between two different regions.
    pub cuts: Vec<Cut>,
}

/// Cuts the free space and joins what belongs together.
pub fn regions(
    raster: &Raster,
    distances: &Distances,
    gaps: &[[Point; 2]],
    options: &SegmentOptions,
    visited: &[usize],
) -> Regions {
    let mut is_cut = vec![false; raster.free.len()];
    for &gap in gaps {
        draw(raster, &mut is_cut, gap);
    }
    let (pieces, count) = raster.components(|cell| raster.free[cell] && !is_cut[cell]);
    let mut merger = Merger::new(raster, distances, &pieces, count, gaps, options);
    for &cell in visited {
        merger.is_visited[pieces[cell] as usize] = true;
    }
    let cells = |area_m2: f64| raster.cells(area_m2.sqrt()).powi(2);
    merger.join_small(cells(SMALLEST_ROOM_M2), false);
    merger.join_where_no_wall_parts(raster);
    // Now against rooms as closed by the remaining cuts: the aisle between two rows of open stalls counts
    // with its own width, not including them.
    merger.measure_closed(raster, &pieces);
    merger.join_where_no_wall_parts(raster);
    if options.least_unvisited_m2 > 0.0 {
        merger.join_small(cells(options.least_unvisited_m2), true);
        merger.measure_closed(raster, &pieces);
        merger.join_where_no_wall_parts(raster);
    }
    merger.finish(raster, pieces)
}

/// Marks the cells along a cut, 4-connected, plus two more into the walls at its ends: the ends are
/// accurate only to about a cell, and a single open cell would reconnect the rooms.
fn draw(raster: &Raster, is_cut: &mut [bool], [from, to]: [Point; 2]) {
    let Some(along) = (to - from).unit() else { return };
    let clamp = |value: f64, count: usize| value.floor().clamp(0.0, (count - 1) as f64) as i32;
    let cell = |point: Point| (clamp(point.x, raster.width), clamp(point.y, raster.height));
    let (mut x, mut y) = cell(from + along * -2.0);
    let (to_x, to_y) = cell(to + along * 2.0);
    let (dx, dy) = ((to_x - x).abs(), (to_y - y).abs());
    let (step_x, step_y) = ((to_x - x).signum(), (to_y - y).signum());
    let mut error = dx - dy;
    loop {
        is_cut[y as usize * raster.width + x as usize] = true;
        if (x, y) == (to_x, to_y) {
            return;
        }
        // One step along x or y, never both at once.
        if y == to_y || (x != to_x && 2 * error > -dy) {
            error -= dy;
            x += step_x;
        } else {
            error += dx;
            y += step_y;
        }
    }
}

/// Two pieces on either side of a cut.
struct Border {
    pieces: [u32; 2],
    gap: [Point; 2],
    /// The number of cells of the cut over which they face each other.
    cells: u32,
    /// The pieces on both sides of the line beyond each end, cell by cell.
    beyond: [Vec<[u32; 2]>; 2],
}

/// How strongly a wall separates two pieces beside their border, in cells.
struct Wall {
    /// Wall between these two only.
    between: u32,
    /// Wall between one of them and anything else, which may become wall between them.
    beside: u32,
}

struct Merger {
    union: Union,
    area_cells: Vec<u32>,
    /// Radius of the largest free disc, in cells.
    peak: Vec<f64>,
    /// Whether the robot was in it.
    is_visited: Vec<bool>,
    narrow_share: f64,
    borders: Vec<Border>,
    /// The borders of each set, under the set's representative.
    borders_of: Vec<Vec<u32>>,
}

impl Merger {
    fn new(
        raster: &Raster,
        distances: &Distances,
        pieces: &[u32],
        count: u32,
        gaps: &[[Point; 2]],
        options: &SegmentOptions,
    ) -> Self {
        let mut area_cells = vec![0; count as usize + 1];
        let mut deepest = vec![0; count as usize + 1];
        for (&piece, &squared) in pieces.iter().zip(&distances.squared) {
            area_cells[piece as usize] += 1;
            deepest[piece as usize] = squared.max(deepest[piece as usize]);
        }
        let mut borders = Vec::new();
        for &gap in gaps {
            borders_along(raster, pieces, gap, options.wall_reach_m, &mut borders);
        }
        borders_left_out(raster, pieces, options.wall_reach_m, &mut borders);
        let mut borders_of = vec![Vec::new(); count as usize + 1];
        for (index, border) in borders.iter().enumerate() {
            for piece in border.pieces {
                borders_of[piece as usize].push(index as u32);
            }
        }
        let peak = deepest.into_iter().map(|squared: u32| f64::from(squared).sqrt()).collect();
        Self {
            union: Union::of(count as usize + 1),
            area_cells,
            peak,
            is_visited: vec![false; count as usize + 1],
            narrow_share: options.narrow_share,
            borders,
            borders_of,
        }
    }

    /// Re-measures the largest disc inside each set, with the cuts between different sets as walls.
    fn measure_closed(&mut self, raster: &Raster, pieces: &[u32]) {
        let mut is_cut = vec![false; raster.free.len()];
        for border in 0..self.borders.len() as u32 {
            if self.sides(border).is_some() {
                draw(raster, &mut is_cut, self.borders[border as usize].gap);
            }
        }
        let open: Vec<bool> = raster.free.iter().zip(is_cut).map(|(&free, is_cut)| free && !is_cut).collect();
        let closed = distance::distances(&open, raster.width, raster.height);
        let mut deepest = vec![0; self.peak.len()];
        for (&piece, &squared) in pieces.iter().zip(&closed.squared) {
            deepest[piece as usize] = squared.max(deepest[piece as usize]);
        }
        self.peak.fill(0.0);
        for (piece, squared) in deepest.into_iter().enumerate() {
            let root = self.union.find(piece as u32) as usize;
            self.peak[root] = self.peak[root].max(f64::from(squared).sqrt());
        }
    }

    /// The two sets at a border; `None` if they have been merged.
    fn sides(&mut self, border: u32) -> Option<[u32; 2]> {
        let sides = self.borders[border as usize].pieces.map(|piece| self.union.find(piece));
        (sides[0] != sides[1]).then_some(sides)
    }

    /// Merges two sets; returns the representative.
    fn join(&mut self, [one, other]: [u32; 2]) -> u32 {
        let is_larger = self.area_cells[one as usize] >= self.area_cells[other as usize];
        let (keep, go) = if is_larger { (one, other) } else { (other, one) };
        self.union.join(keep, go);
        self.is_visited[keep as usize] |= self.is_visited[go as usize];
        self.area_cells[keep as usize] += self.area_cells[go as usize];
        self.peak[keep as usize] = self.peak[keep as usize].max(self.peak[go as usize]);
        let mut moved = std::mem::take(&mut self.borders_of[go as usize]);
        if moved.len() > self.borders_of[keep as usize].len() {
            std::mem::swap(&mut moved, &mut self.borders_of[keep as usize]);
        }
        self.borders_of[keep as usize].extend(moved);
        keep
    }

    /// Merges pieces smaller than `least` cells into the neighbour with the longest common border,
    /// smallest first; those that the robot visited only if they are not spared.
    fn join_small(&mut self, least: f64, spares_visited: bool) {
        let is_small = |merger: &Self, piece: u32| {
            let is_spared = spares_visited && merger.is_visited[piece as usize];
            f64::from(merger.area_cells[piece as usize]) < least && !is_spared
        };
        let mut queue: BTreeSet<(u32, u32)> = (1..self.area_cells.len() as u32)
            .filter(|&piece| is_small(self, piece))
            .map(|piece| (self.area_cells[piece as usize], piece))
            .collect();
        while let Some((area, piece)) = queue.pop_first() {
            if self.union.find(piece) != piece || self.area_cells[piece as usize] != area {
                continue;
            }
            let mut neighbours = std::collections::BTreeMap::<u32, u32>::new();
            for border in self.borders_of[piece as usize].clone() {
                if let Some([one, other]) = self.sides(border) {
                    let neighbour = if one == piece { other } else { one };
                    *neighbours.entry(neighbour).or_default() += self.borders[border as usize].cells;
                }
            }
            let longest =
                neighbours.into_iter().max_by_key(|&(neighbour, cells)| (cells, std::cmp::Reverse(neighbour)));
            if let Some((neighbour, _)) = longest {
                let joined = self.join([piece, neighbour]);
                if is_small(self, joined) {
                    queue.insert((self.area_cells[joined as usize], joined));
                }
            }
        }
    }

    /// Merges the sets on both sides of each border that is neither narrow nor continues a wall between
    /// them, those with the least wall beside it first: so pieces of a corridor merge before one of them
    /// could be taken for part of a room.
    fn join_where_no_wall_parts(&mut self, raster: &Raster) {
        let mut queue: BTreeSet<(i64, i64, u32)> = BTreeSet::new();
        let mut queued: Vec<Option<(i64, i64, u32)>> = vec![None; self.borders.len()];
        for border in 0..self.borders.len() as u32 {
            self.queue(raster, border, &mut queue, &mut queued);
        }
        while let Some(next) = queue.pop_first() {
            queued[next.2 as usize] = None;
            let Some(sides) = self.sides(next.2) else { continue };
            let joined = self.join(sides);
            let borders = std::mem::take(&mut self.borders_of[joined as usize]);
            let mut open = Vec::with_capacity(borders.len());
            for border in borders {
                if let Some(old) = queued[border as usize].take() {
                    queue.remove(&old);
                }
                // A border inside a set never separates anything again.
                if self.sides(border).is_some() {
                    open.push(border);
                    self.queue(raster, border, &mut queue, &mut queued);
                }
            }
            self.borders_of[joined as usize] = open;
        }
    }

    /// Queues a border if it should be removed.
    fn queue(
        &mut self,
        raster: &Raster,
        border: u32,
        queue: &mut BTreeSet<(i64, i64, u32)>,
        queued: &mut [Option<(i64, i64, u32)>],
    ) {
        let Some(sides) = self.sides(border) else { return };
        let [from, to] = self.borders[border as usize].gap;
        let length = from.distance(to).max(1.0);
        let narrower = sides.map(|side| self.peak[side as usize]).into_iter().fold(f64::INFINITY, f64::min);
        let share = length / (2.0 * narrower.max(0.5));
        let wall = self.wall(border, sides);
        let is_wall = f64::from(wall.between) >= (LEAST_WALL_SHARE * length).max(raster.cells(LEAST_WALL_M));
        if share < self.narrow_share || is_wall {
            return;
        }
        // Integers, so that the order is total.
        let by_wall = (f64::from(wall.beside) / length * 1e6) as i64;
        let place = (by_wall, (share * -1e6) as i64, border);
        queue.insert(place);
        queued[border as usize] = Some(place);
    }

    /// The wall that a border continues.
    fn wall(&mut self, border: u32, [one, other]: [u32; 2]) -> Wall {
        let mut wall = Wall { between: 0, beside: 0 };
        let union = &mut self.union;
        for beyond in &self.borders[border as usize].beyond {
            let mut missing = 0;
            for pieces in beyond {
                let [left, right] = pieces.map(|piece| if piece == 0 { 0 } else { union.find(piece) });
                if [left, right] == [one, other] || [left, right] == [other, one] {
                    wall.between += 1;
                    wall.beside += 1;
                    missing = 0;
                    continue;
                }
                let is_ours = |side: u32| side == one || side == other;
                if left != 0 && right != 0 && left != right && (is_ours(left) || is_ours(right)) {
                    wall.beside += 1;
                    missing = 0;
                    continue;
                }
                missing += 1;
                if missing > WALL_GAP_CELLS {
                    break;
                }
            }
        }
        wall
    }

    /// The regions in the order of their first cells, with the cells of cuts assigned to the nearest
    /// region.
    fn finish(mut self, raster: &Raster, mut of_cell: Vec<u32>) -> Regions {
        let mut numbers = vec![0; self.area_cells.len()];
        let mut count = 0;
        for piece in of_cell.iter_mut().filter(|piece| **piece != 0) {
            let root = self.union.find(*piece) as usize;
            if numbers[root] == 0 {
                count += 1;
                numbers[root] = count;
            }
            *piece = numbers[root];
        }
        raster.spread(&mut of_cell);
        let mut cuts = Vec::new();
        for border in 0..self.borders.len() as u32 {
            if let Some(sides) = self.sides(border) {
                let regions = sides.map(|side| numbers[side as usize]);
                let regions = [regions[0].min(regions[1]), regions[0].max(regions[1])];
                cuts.push(Cut { ends: self.borders[border as usize].gap, regions });
            }
        }
        Regions { of_cell, count, cuts }
    }
}

/// The pairs of pieces that face each other across a cut over at least two cells.
fn borders_along(raster: &Raster, pieces: &[u32], gap: [Point; 2], wall_reach_m: f64, borders: &mut Vec<Border>) {
    /// How far from the cut's line to look for its sides, in cells.
    const ASIDE: f64 = 3.0;
    let [from, to] = gap;
    let Some(along) = (to - from).unit() else { return };
    let length = from.distance(to);
    let mut facing = std::collections::BTreeMap::<[u32; 2], u32>::new();
    for step in 0..=length as u32 + 1 {
        let at = from + along * f64::from(step).min(length);
        let pair = both_sides(raster, pieces, at, along, ASIDE);
        if pair[0] != 0 && pair[1] != 0 && pair[0] != pair[1] {
            *facing.entry([pair[0].min(pair[1]), pair[0].max(pair[1])]).or_default() += 1;
        }
    }
    let facing: Vec<([u32; 2], u32)> = facing.into_iter().filter(|&(_, cells)| cells >= 2).collect();
    if facing.is_empty() {
        return;
    }
    let beyond = beyond(raster, pieces, gap, wall_reach_m);
    borders.extend(facing.into_iter().map(|(sides, cells)| Border {
        pieces: sides,
        gap,
        cells,
        beyond: beyond.clone(),
    }));
}

/// The pairs of pieces that touch without a border so far: several cuts that lie close together part pieces
/// that face each other across none of them.
fn borders_left_out(raster: &Raster, pieces: &[u32], wall_reach_m: f64, borders: &mut Vec<Border>) {
    let mut touching = pieces.to_vec();
    raster.spread(&mut touching);
    // How often each pair touches, and where first and last, row by row.
    let mut contacts = std::collections::BTreeMap::<[u32; 2], (u32, usize, usize)>::new();
    for cell in 0..touching.len() {
        for next in raster.beside(cell, &[(1, 0), (0, 1)]) {
            let (one, other) = (touching[cell], touching[next]);
            if one != 0 && other != 0 && one != other {
                let contact = contacts.entry([one.min(other), one.max(other)]).or_insert((0, cell, cell));
                *contact = (contact.0 + 1, contact.1, cell);
            }
        }
    }
    let ordered = |[one, other]: [u32; 2]| [one.min(other), one.max(other)];
    let known: BTreeSet<[u32; 2]> = borders.iter().map(|border| ordered(border.pieces)).collect();
    let middle = |cell: usize| Point::new((cell % raster.width) as f64 + 0.5, (cell / raster.width) as f64 + 0.5);
    for (pair, (cells, first, last)) in contacts {
        if cells >= 2 && !known.contains(&pair) {
            let gap = [middle(first), middle(last)];
            borders.push(Border { pieces: pair, gap, cells, beyond: beyond(raster, pieces, gap, wall_reach_m) });
        }
    }
}

/// The pieces on both sides of a gap's line beyond each of its ends, cell by cell.
fn beyond(raster: &Raster, pieces: &[u32], [from, to]: [Point; 2], wall_reach_m: f64) -> [Vec<[u32; 2]>; 2] {
    let along = (to - from).unit().unwrap_or(Vector::new(1.0, 0.0));
    let reach = raster.cells(wall_reach_m);
    [(from, -along), (to, along)].map(|(end, ahead)| {
        let steps = 1..raster.cells(WALL_LOOKED_AT_M) as u32;
        steps.map(|step| both_sides(raster, pieces, end + ahead * f64::from(step), ahead, reach)).collect()
    })
}

/// The first pieces on both sides of a line at a point of it, at most `reach` cells away; 0 for none.
fn both_sides(raster: &Raster, pieces: &[u32], at: Point, along: Vector, reach: f64) -> [u32; 2] {
    [along.left(), -along.left()].map(|aside| {
        let mut far = 0.0;
        while far <= reach {
            match raster.cell_at(at + aside * far) {
                None => return 0,
                Some(cell) if pieces[cell] != 0 => return pieces[cell],
                Some(_) => far += 0.5,
            }
        }
        0
    })
}
