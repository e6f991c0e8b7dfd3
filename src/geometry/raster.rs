//! Polygons on a raster: finding where a polygon has the most room.

use super::{Bounds, Point, Segment, Vector, polygon};

/// A label position: the centre of the largest inscribed circle or, where many are nearly as large (a
/// corridor), the one nearest to the centroid. Computed on a raster of 40 cells along the longer side,
/// fine enough for a name. For a convex polygon, the centroid.
pub fn centre(outer: &[Point], holes: &[Vec<Point>]) -> Point {
    let bounds = polygon::bounds(outer);
    if bounds.is_empty() {
        return Point::default();
    }
    if holes.is_empty() && polygon::is_convex(outer) {
        return polygon::centroid(outer);
    }
    let cell = bounds.width().max(bounds.height()) / 40.0;
    if cell <= 0.0 {
        return bounds.center();
    }
    let mut raster = Raster::new(bounds, cell);
    let rings: Vec<&[Point]> = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice)).collect();
    raster.keep_inside(&rings);
    let depths = raster.depths();
    let deepest = depths.iter().copied().max().unwrap_or(0);
    let middle = polygon::centroid(outer);
    let mut best: Option<(f64, Point)> = None;
    for (i, &depth) in depths.iter().enumerate() {
        // Nearly as deep: within a seventh.
        if depth == 0 || u32::from(depth) * 7 < u32::from(deepest) * 6 {
            continue;
        }
        let at = raster.cell_centre(i % raster.width, i / raster.width);
        let distance = at.distance(middle);
        if best.is_none_or(|(least, _)| distance < least - 1e-9) {
            best = Some((distance, at));
        }
    }
    match best {
        // The centroid itself if it qualifies: a rectangle's middle is not on the raster.
        Some((distance, _))
            if distance <= cell && polygon::locate(outer, holes, middle) == polygon::Location::Inside =>
        {
            middle
        }
        Some((_, at)) => at,
        None => middle,
    }
}

/// Square cells over a box, each free or blocked, each with a cost of standing there.
pub(crate) struct Raster {
    pub(crate) origin: Point,
    pub(crate) cell: f64,
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) blocked: Vec<bool>,
}

/// The most cells in a raster: a room that fills the view many times over gets coarser ones.
const MOST_CELLS: f64 = 200_000.0;

impl Raster {
    pub(crate) fn new(bounds: Bounds, cell: f64) -> Self {
        let cell = cell.max((bounds.width() * bounds.height() / MOST_CELLS).sqrt());
        // Limits boxes that are long and thin, too.
        let cell = cell.max(bounds.width().max(bounds.height()) / MOST_CELLS);
        let count = |length: f64| (length / cell).ceil().max(1.0) as usize;
        let (width, height) = (count(bounds.width()), count(bounds.height()));
        Self { origin: bounds.min, cell, width, height, blocked: vec![false; width * height] }
    }

    pub(crate) fn cell_centre(&self, column: usize, row: usize) -> Point {
        self.origin + Vector::new((column as f64 + 0.5) * self.cell, (row as f64 + 0.5) * self.cell)
    }

    pub(crate) fn column(&self, x: f64) -> f64 {
        (x - self.origin.x) / self.cell
    }

    pub(crate) fn row(&self, y: f64) -> f64 {
        (y - self.origin.y) / self.cell
    }

    /// Calls `visit` with the runs of cells (row, columns) whose centres are inside the rings by the
    /// even-odd rule.
    pub(crate) fn inside(&self, rings: &[&[Point]], mut visit: impl FnMut(usize, std::ops::Range<usize>)) {
        let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); self.height];
        for edge in rings.iter().flat_map(|ring| polygon::edges(ring)) {
            let (low, high) = if edge.a.y < edge.b.y { (edge.a, edge.b) } else { (edge.b, edge.a) };
            // Rows whose centre lies in low.y..high.y.
            let first = (self.row(low.y) - 0.5).ceil().max(0.0) as usize;
            let end = ((self.row(high.y) - 0.5).ceil().max(0.0) as usize).min(self.height);
            for (row, crossings) in crossings.iter_mut().enumerate().take(end).skip(first) {
                let y = self.origin.y + (row as f64 + 0.5) * self.cell;
                crossings.push(low.x + (high.x - low.x) * (y - low.y) / (high.y - low.y));
            }
        }
        for (row, mut crossings) in crossings.into_iter().enumerate() {
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let from = (self.column(pair[0]) - 0.5).ceil().max(0.0) as usize;
                let to = ((self.column(pair[1]) - 0.5).ceil().max(0.0) as usize).min(self.width);
                if from < to {
                    visit(row, from..to);
                }
            }
        }
    }

    /// Blocks every cell whose centre lies outside the rings.
    pub(crate) fn keep_inside(&mut self, rings: &[&[Point]]) {
        let mut blocked = vec![true; self.blocked.len()];
        self.inside(rings, |row, columns| {
            blocked[row * self.width..][columns].fill(false);
        });
        for (before, now) in self.blocked.iter_mut().zip(blocked) {
            *before |= now;
        }
    }

    /// Blocks every cell whose centre lies inside the rings.
    pub(crate) fn keep_outside(&mut self, rings: &[&[Point]]) {
        let mut blocked = std::mem::take(&mut self.blocked);
        self.inside(rings, |row, columns| {
            blocked[row * self.width..][columns].fill(true);
        });
        self.blocked = blocked;
    }

    /// Blocks the cells a segment passes through.
    pub(crate) fn block_along(&mut self, segment: Segment) {
        // Steps of half a cell meet every cell except those barely touched at a corner.
        let steps = (segment.length() / (self.cell * 0.5)).ceil().clamp(1.0, 4.0 * MOST_CELLS) as usize;
        for i in 0..=steps {
            let point = segment.a.lerp(segment.b, i as f64 / steps as f64);
            let (column, row) = (self.column(point.x).floor(), self.row(point.y).floor());
            if column >= 0.0 && row >= 0.0 && (column as usize) < self.width && (row as usize) < self.height {
                self.blocked[row as usize * self.width + column as usize] = true;
            }
        }
    }

    /// For each cell the distance to the nearest blocked one, in thirds of a cell: the 3-4 chamfer
    /// distance (Borgefors 1986). The edge of the raster counts as blocked.
    pub(crate) fn depths(&self) -> Vec<u16> {
        let (width, height) = (self.width, self.height);
        let mut depth: Vec<u16> = self.blocked.iter().map(|&blocked| if blocked { 0 } else { u16::MAX / 2 }).collect();
        let at = |depth: &[u16], column: i64, row: i64| {
            if column < 0 || row < 0 || column >= width as i64 || row >= height as i64 {
                0
            } else {
                depth[row as usize * width + column as usize]
            }
        };
        let mut pass = |rows: &mut dyn Iterator<Item = i64>, sign: i64| {
            for row in rows {
                for step in 0..width as i64 {
                    let column = if sign > 0 { step } else { width as i64 - 1 - step };
                    let least = (at(&depth, column - sign, row) + 3)
                        .min(at(&depth, column, row - sign) + 3)
                        .min(at(&depth, column - 1, row - sign) + 4)
                        .min(at(&depth, column + 1, row - sign) + 4);
                    let here = &mut depth[row as usize * width + column as usize];
                    *here = (*here).min(least);
                }
            }
        };
        pass(&mut (0..height as i64), 1);
        pass(&mut (0..height as i64).rev(), -1);
        depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn the_middle_lies_in_the_widest_part() {
        let square = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        assert_eq!(centre(&square, &[]), Point::new(2.0, 2.0));
        let corridor = ring(&[(0.0, 0.0), (20.0, 0.0), (20.0, 2.0), (0.0, 2.0)]);
        assert!(centre(&corridor, &[]).distance(Point::new(10.0, 1.0)) < 0.4);
        let l_shape = ring(&[(0.0, 0.0), (10.0, 0.0), (10.0, 2.0), (4.0, 2.0), (4.0, 6.0), (0.0, 6.0)]);
        let middle = centre(&l_shape, &[]);
        assert!(middle.x < 3.0 && middle.y > 1.0, "{middle:?}");
        let ring_room = centre(
            &ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]),
            &[ring(&[(2.0, 2.0), (7.0, 2.0), (7.0, 7.0), (2.0, 7.0)])],
        );
        assert!(!(2.0..=7.0).contains(&ring_room.x) || !(2.0..=7.0).contains(&ring_room.y), "{ring_room:?}");
        assert_eq!(centre(&[], &[]), Point::default());
    }
}
