//! Snap rounding (Hobby 1999): line pieces become chains of grid points that meet only at grid points.
//!
//! Every end and every crossing makes its pixel hot, and a piece is routed through the centres of all hot
//! pixels it meets. Two chains then share whole edges, nodes, or nothing: no edge passes through a node
//! other than its ends (if the chain's edge from u to w passed through the centre of a hot pixel v, the
//! piece itself would meet v, the pixels being translates of one convex set), and no two edges cross. No
//! chain strays further than a pixel from its piece.
//!
//! Hot pixels are found cell by cell: the plane is divided until a cell holds few pieces, or pieces that
//! run side by side. Each cell then handles its pixels alone: which are hot, and which pieces meet them.
//! The work is near-linear in pieces and crossings, wherever they lie and however long they are.

use crate::geometry::arrangement::error::ArrangementError;
use crate::geometry::arrangement::error::{PASSINGS_LIMIT, TESTS_LIMIT};
use crate::geometry::arrangement::grid::{GridPoint, Piece};

/// A cell with this few pieces is not divided further: testing all pairs costs less.
const FEW_PIECES: usize = 24;

/// Pieces run side by side when, seen along their common direction, each overlaps at most this many
/// others on average: then a sweep across finds all pairs in about the time of a sort.
const FEW_NEIGHBOURS: usize = 16;

/// The most cells a division may put a piece in, on average. More would divide faster but take more
/// memory at once.
const CELLS_PER_PIECE: f64 = 16.0;

/// Margin around cells, in pixels: well above the rounding of an `f64` at 10^9 steps (about 10^-6), so
/// that no piece misses a cell it meets.
const MARGIN: f64 = 0.01;

/// The nodes of a snapped arrangement and which pieces pass through them.
#[derive(Debug, Default)]
pub(crate) struct Snapped {
    /// The centres of the hot pixels, each once, in the order of the cells.
    pub nodes: Vec<GridPoint>,
    /// Pairs of a piece and a node it passes through, by index, each once.
    pub passings: Vec<(u32, u32)>,
}

/// The resources an arrangement may use.
#[derive(Clone, Copy, Debug)]
struct Limits {
    passings: usize,
    tests: u64,
}

/// Snaps pieces to the hot pixels of all of them.
pub(crate) fn snap(pieces: &[Piece]) -> Result<Snapped, ArrangementError> {
    snap_within(pieces, Limits { passings: PASSINGS_LIMIT, tests: TESTS_LIMIT })
}

fn snap_within(pieces: &[Piece], limits: Limits) -> Result<Snapped, ArrangementError> {
    let all: Vec<u32> = (0..pieces.len() as u32).collect();
    let Some(cell) = Cell::around(pieces) else { return Ok(Snapped::default()) };
    let mut snapper =
        Snapper { pieces, limits, snapped: Snapped::default(), tests: 0, hot: Vec::new(), swept: Vec::new() };
    snapper.settle(cell, &all)?;
    Ok(snapper.snapped)
}

/// A box of pixels: x in `x0..x1`, y likewise.
#[derive(Clone, Copy, Debug)]
struct Cell {
    x0: i64,
    y0: i64,
    x1: i64,
    y1: i64,
}

impl Cell {
    fn around(pieces: &[Piece]) -> Option<Self> {
        let x0 = pieces.iter().map(|piece| piece.a.x).min()?;
        let x1 = pieces.iter().map(|piece| piece.b.x).max()?;
        let y0 = pieces.iter().map(|piece| piece.a.y.min(piece.b.y)).min()?;
        let y1 = pieces.iter().map(|piece| piece.a.y.max(piece.b.y)).max()?;
        Some(Self { x0: x0.into(), y0: y0.into(), x1: i64::from(x1) + 1, y1: i64::from(y1) + 1 })
    }

    fn holds(self, point: GridPoint) -> bool {
        let (x, y) = (i64::from(point.x), i64::from(point.y));
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }

    fn width(self) -> i64 {
        self.x1 - self.x0
    }

    fn height(self) -> i64 {
        self.y1 - self.y0
    }

    /// The part of a piece within the cell's pixels and a small margin, as its two ends by ascending x;
    /// `None` if it misses the cell.
    fn clip(self, piece: Piece) -> Option<[(f64, f64); 2]> {
        let (x0, x1) = (self.x0 as f64 - 0.5 - MARGIN, self.x1 as f64 - 0.5 + MARGIN);
        let (y0, y1) = (self.y0 as f64 - 0.5 - MARGIN, self.y1 as f64 - 0.5 + MARGIN);
        let (ax, ay) = (f64::from(piece.a.x), f64::from(piece.a.y));
        let (dx, dy) = (f64::from(piece.b.x) - ax, f64::from(piece.b.y) - ay);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (start, step, low, high) in [(ax, dx, x0, x1), (ay, dy, y0, y1)] {
            if step == 0.0 {
                if start < low || start > high {
                    return None;
                }
            } else {
                let (p, q) = ((low - start) / step, (high - start) / step);
                from = from.max(p.min(q));
                to = to.min(p.max(q));
            }
        }
        (from <= to).then_some([(ax + dx * from, ay + dy * from), (ax + dx * to, ay + dy * to)])
    }
}

/// How the pieces of a cell are laid out.
struct Lie {
    /// Across their mean direction, as a unit vector.
    normal: (f64, f64),
    /// Whether they seem to run side by side, judged by how much of their extent along the normal they
    /// cover: clusters can fool it.
    side_by_side: bool,
    /// The number of columns and rows to divide the cell into; `None` if each part would still hold about
    /// as many pieces.
    division: Option<(i64, i64)>,
}

/// A piece in a sweep: the interval it covers along the direction of the sweep.
#[derive(Clone, Copy, Debug)]
struct Swept {
    low: f64,
    high: f64,
    piece: u32,
}

struct Snapper<'a> {
    pieces: &'a [Piece],
    limits: Limits,
    snapped: Snapped,
    tests: u64,
    /// Scratch: the hot pixels of the current cell.
    hot: Vec<GridPoint>,
    /// Scratch: the intervals of the current cell.
    swept: Vec<Swept>,
}

impl Snapper<'_> {
    /// Snaps the pixels of a cell, given all pieces that may meet one of them.
    fn settle(&mut self, cell: Cell, here: &[u32]) -> Result<(), ArrangementError> {
        if here.len() <= FEW_PIECES {
            return self.test_all(cell, here);
        }
        let lie = self.lie(cell, here);
        match lie.division {
            None => {
                self.line_up(cell, here, lie.normal);
                self.sweep(cell, here, lie.normal)
            }
            Some((columns, rows)) => {
                if lie.side_by_side {
                    self.line_up(cell, here, lie.normal);
                    if self.pairs_to_sweep() <= 2 * FEW_NEIGHBOURS * here.len() {
                        return self.sweep(cell, here, lie.normal);
                    }
                }
                self.divide(cell, here, columns, rows)
            }
        }
    }

    fn count_tests(&mut self, tests: usize) -> Result<(), ArrangementError> {
        self.tests += tests as u64;
        if self.tests > self.limits.tests || self.snapped.passings.len() > self.limits.passings {
            return Err(ArrangementError::TooDense);
        }
        Ok(())
    }

    /// Tests all pairs.
    fn test_all(&mut self, cell: Cell, here: &[u32]) -> Result<(), ArrangementError> {
        let pieces = self.pieces;
        self.ends(cell, here);
        self.count_tests(here.len() * here.len() / 2)?;
        for (i, &first) in here.iter().enumerate() {
            let first = pieces[first as usize];
            for &second in &here[i + 1..] {
                self.cross(cell, first, pieces[second as usize])?;
            }
        }
        self.hot.sort_unstable();
        self.hot.dedup();
        self.count_tests(here.len() * self.hot.len())?;
        for &centre in &self.hot {
            let node = self.snapped.nodes.len() as u32;
            self.snapped.nodes.push(centre);
            for &index in here {
                if pieces[index as usize].meets_pixel(centre) {
                    self.snapped.passings.push((index, node));
                }
            }
        }
        self.count_tests(0)
    }

    /// Starts the cell's hot pixels with the ends in it.
    fn ends(&mut self, cell: Cell, here: &[u32]) {
        self.hot.clear();
        for &index in here {
            let piece = self.pieces[index as usize];
            self.hot.extend([piece.a, piece.b].into_iter().filter(|&end| cell.holds(end)));
        }
    }

    /// Records the pixel where two pieces cross in the cell. Removes duplicates before they fill memory:
    /// many pieces may cross in one pixel.
    fn cross(&mut self, cell: Cell, first: Piece, second: Piece) -> Result<(), ArrangementError> {
        if first.boxes_meet(second)
            && let Some(point) = first.crossing(second)
            && cell.holds(point)
        {
            if self.hot.len() == self.hot.capacity() && self.hot.len() > 1 << 16 {
                self.hot.sort_unstable();
                self.hot.dedup();
                if self.hot.len() > self.limits.passings {
                    return Err(ArrangementError::TooDense);
                }
                self.hot.reserve(self.hot.len());
            }
            self.hot.push(point);
        }
        Ok(())
    }

    /// Examines how the pieces of a cell are laid out.
    fn lie(&self, cell: Cell, here: &[u32]) -> Lie {
        let (width, height) = (cell.width() as f64, cell.height() as f64);
        // Lengths across the cell, and the mean axis: angles doubled, so that both directions of a line
        // count as one.
        let (mut across_x, mut across_y, mut axis_x, mut axis_y) = (0.0, 0.0, 0.0, 0.0);
        for &index in here {
            let Some([(ax, ay), (bx, by)]) = cell.clip(self.pieces[index as usize]) else { continue };
            let (dx, dy) = (bx - ax, by - ay);
            across_x += dx;
            across_y += dy.abs();
            let length = (dx * dx + dy * dy).sqrt();
            if length > 0.0 {
                axis_x += (dx * dx - dy * dy) / length;
                axis_y += 2.0 * dx * dy / length;
            }
        }
        let angle = axis_y.atan2(axis_x) / 2.0;
        let normal = (-angle.sin(), angle.cos());
        let (mut low, mut high, mut covered) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        for &index in here {
            let Some([a, b]) = cell.clip(self.pieces[index as usize]) else { continue };
            let (p, q) = (dot(normal, a), dot(normal, b));
            low = low.min(p.min(q));
            high = high.max(p.max(q));
            covered += (p - q).abs() + 2.0 * MARGIN;
        }
        let side_by_side = covered <= FEW_NEIGHBOURS as f64 * (high - low);
        // With c columns and r rows a piece lies in about 1 + c * columns_met + r * rows_met cells.
        let count = here.len() as f64;
        let (columns_met, rows_met) = (across_x / width / count, across_y / height / count);
        let most = ((CELLS_PER_PIECE - 1.0) / 2.0).powi(2) / (columns_met * rows_met).max(1e-30);
        let cells = (count / 2.0).min(most).max(4.0);
        let columns = (cells * rows_met / columns_met.max(1e-30)).sqrt().clamp(1.0, cells.min(width));
        let rows = (cells / columns).clamp(1.0, height).floor();
        let columns = (cells / rows).clamp(1.0, width).floor();
        let in_each = (1.0 + columns * columns_met + rows * rows_met) / (columns * rows);
        Lie { normal, side_by_side, division: (in_each <= 0.7).then_some((columns as i64, rows as i64)) }
    }

    /// Sorts the intervals the pieces cover along a direction.
    fn line_up(&mut self, cell: Cell, here: &[u32], direction: (f64, f64)) {
        self.swept.clear();
        for &index in here {
            let Some([a, b]) = cell.clip(self.pieces[index as usize]) else { continue };
            let (p, q) = (dot(direction, a), dot(direction, b));
            self.swept.push(Swept { low: p.min(q) - MARGIN, high: p.max(q) + MARGIN, piece: index });
        }
        self.swept.sort_unstable_by(|p, q| p.low.total_cmp(&q.low).then(p.piece.cmp(&q.piece)));
    }

    /// The number of pairs of intervals that meet.
    fn pairs_to_sweep(&self) -> usize {
        let swept = &self.swept;
        let up_to = |high: f64| swept.partition_point(|other| other.low <= high);
        swept.iter().enumerate().map(|(i, interval)| up_to(interval.high) - i - 1).sum()
    }

    /// Tests the pairs whose intervals along `direction` meet, see [`Snapper::line_up`].
    fn sweep(&mut self, cell: Cell, here: &[u32], direction: (f64, f64)) -> Result<(), ArrangementError> {
        let pieces = self.pieces;
        let swept = std::mem::take(&mut self.swept);
        self.ends(cell, here);
        // A single pixel is either hot or not: once hot, nothing is left to find.
        let one_pixel = cell.width() == 1 && cell.height() == 1;
        for (i, first) in swept.iter().enumerate() {
            if one_pixel && !self.hot.is_empty() {
                break;
            }
            let piece = pieces[first.piece as usize];
            let mut tests = 0;
            for second in swept[i + 1..].iter().take_while(|second| second.low <= first.high) {
                tests += 1;
                self.cross(cell, piece, pieces[second.piece as usize])?;
            }
            self.count_tests(tests)?;
        }
        self.hot.sort_unstable();
        self.hot.dedup();
        let first_node = self.snapped.nodes.len();
        self.snapped.nodes.extend_from_slice(&self.hot);
        let mut along: Vec<(f64, u32)> = self
            .hot
            .iter()
            .zip(first_node as u32..)
            .map(|(centre, node)| (dot(direction, (f64::from(centre.x), f64::from(centre.y))), node))
            .collect();
        along.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        for interval in &swept {
            let piece = pieces[interval.piece as usize];
            // A pixel reaches sqrt(1/2) from its centre.
            let start = along.partition_point(|&(at, _)| at < interval.low - 1.0);
            let mut tests = 0;
            for &(_, node) in along[start..].iter().take_while(|&&(at, _)| at <= interval.high + 1.0) {
                tests += 1;
                if piece.meets_pixel(self.snapped.nodes[node as usize]) {
                    self.snapped.passings.push((interval.piece, node));
                }
            }
            self.count_tests(tests)?;
        }
        self.swept = swept;
        Ok(())
    }

    /// Handles the cells of a division one by one.
    fn divide(&mut self, cell: Cell, here: &[u32], columns: i64, rows: i64) -> Result<(), ArrangementError> {
        let step_x = (cell.width() + columns - 1) / columns;
        let step_y = (cell.height() + rows - 1) / rows;
        // Rounding the step up may leave less to cover.
        let columns = (cell.width() + step_x - 1) / step_x;
        let rows = (cell.height() + step_y - 1) / step_y;
        let mut placed: Vec<(u32, u32)> = Vec::with_capacity(here.len() * 2);
        for &index in here {
            let piece = self.pieces[index as usize];
            let Some([(ax, ay), (bx, by)]) = cell.clip(piece) else { continue };
            let column_at = |x: f64| ((x - cell.x0 as f64 + 0.5) / step_x as f64).floor() as i64;
            let row_at = |y: f64| (((y - cell.y0 as f64 + 0.5) / step_y as f64).floor() as i64).clamp(0, rows - 1);
            let (first, last) =
                (column_at(ax - MARGIN).clamp(0, columns - 1), column_at(bx + MARGIN).clamp(0, columns - 1));
            let (low_y, high_y) = (ay.min(by), ay.max(by));
            // From the true ends: those of the clipped piece are rounded, and a steep piece magnifies the
            // error.
            let (dx, dy) = piece.vector();
            let slope = if dx > 0 { dy as f64 / dx as f64 } else { 0.0 };
            let height_at = |x: f64| (f64::from(piece.a.y) + slope * (x - f64::from(piece.a.x))).clamp(low_y, high_y);
            for column in first..=last {
                // Where it enters and leaves the pixels of the column.
                let left = (cell.x0 + column * step_x) as f64 - 0.5 - MARGIN;
                let right = left + step_x as f64 + 2.0 * MARGIN;
                let from_y = if left > ax { height_at(left) } else { ay };
                let to_y = if right < bx { height_at(right) } else { by };
                let (low, high) = (row_at(from_y.min(to_y) - MARGIN), row_at(from_y.max(to_y) + MARGIN));
                for row in low..=high {
                    placed.push(((row * columns + column) as u32, index));
                }
            }
        }
        // Placing costs about as much as eight tests each.
        self.count_tests(8 * (here.len() + placed.len()))?;
        // Group by cell.
        let mut starts = vec![0_u32; (columns * rows) as usize + 1];
        for &(at, _) in &placed {
            starts[at as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        let mut grouped = vec![0_u32; placed.len()];
        for &(at, index) in &placed {
            let slot = &mut next[at as usize];
            grouped[*slot as usize] = index;
            *slot += 1;
        }
        drop((placed, next));
        for row in 0..rows {
            for column in 0..columns {
                let at = (row * columns + column) as usize;
                let inside = &grouped[starts[at] as usize..starts[at + 1] as usize];
                if inside.is_empty() {
                    continue;
                }
                let (x0, y0) = (cell.x0 + column * step_x, cell.y0 + row * step_y);
                let part = Cell { x0, y0, x1: (x0 + step_x).min(cell.x1), y1: (y0 + step_y).min(cell.y1) };
                self.settle(part, inside)?;
            }
        }
        Ok(())
    }
}

fn dot((ax, ay): (f64, f64), (bx, by): (f64, f64)) -> f64 {
    ax * bx + ay * by
}

#[cfg(test)]
mod tests {
    use crate::geometry::arrangement::snap_rounding::*;

    /// A lattice of lines that all cross: `count` of them, 1 m apart.
    fn lattice(count: i32) -> Vec<Piece> {
        let end = count * 10_000;
        let point = GridPoint::new;
        (0..count)
            .map(|i| (i % 2 == 0, i * 10_000))
            .map(
                |(upright, at)| if upright { (point(at, -1), point(at, end)) } else { (point(-1, at), point(end, at)) },
            )
            .map(|(a, b)| Piece { a, b })
            .collect()
    }

    #[test]
    fn too_many_crossings_or_tests_are_refused() {
        let pieces = lattice(200);
        let limits = Limits { passings: 30_000, tests: 10_000_000 };
        let snapped = snap_within(&pieces, limits).unwrap();
        // A node for each crossing and end; two lines pass through each crossing, one through each end.
        assert_eq!((snapped.nodes.len(), snapped.passings.len()), (10_400, 20_400));
        let refused = |limits| snap_within(&pieces, limits).unwrap_err();
        assert_eq!(refused(Limits { passings: 20_000, ..limits }), ArrangementError::TooDense);
        assert_eq!(refused(Limits { tests: 10_000, ..limits }), ArrangementError::TooDense);
    }

    #[test]
    fn thousands_of_lines_side_by_side_take_few_tests_and_a_fan_a_bounded_number() {
        let side_by_side: Vec<Piece> = (0..10_000)
            .map(|i| Piece { a: GridPoint::new(10 * i, 0), b: GridPoint::new(10_000_000 + 10 * i, 7_770_000) })
            .collect();
        let limits = Limits { passings: 30_000, tests: 1_000_000 };
        assert_eq!(snap_within(&side_by_side, limits).unwrap().passings.len(), 20_000);
        let fan: Vec<Piece> = (0..2_000)
            .map(|i| Piece { a: GridPoint::new(0, 0), b: GridPoint::new(100_000, 100 * (i - 1_000)) })
            .collect();
        // Near the common point every pair of lines is tested: 2,000,000 pairs, and as many tests again
        // for each line's pixels.
        let limits = Limits { tests: 8_000_000, ..limits };
        assert_eq!(snap_within(&fan, limits).unwrap().passings.len(), 4_000);
    }
}
