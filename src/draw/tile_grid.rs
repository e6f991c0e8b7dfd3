//! The grid of tiles a large plan is cut into.

use crate::geometry::{Bounds, Point, Vector};

/// Squares of equal size, row by row from the lower left.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TileGrid {
    origin: Point,
    side_m: f64,
    columns: usize,
    rows: usize,
}

/// A plan with fewer rooms, walls and openings than this is a single tile.
const LEAST_ELEMENTS: usize = 6000;

/// Rooms, walls and openings per tile, roughly.
const ELEMENTS_A_TILE: f64 = 160.0;

/// The most tiles in a row or column.
const MOST_IN_LINE: f64 = 128.0;

/// How far outside the plan the tiles start, chosen so that a wall is unlikely to lie on a border:
/// coordinates of plans are round numbers, these are not.
const OFF_GRID_M: Vector = Vector { x: 0.137_035_99, y: 0.160_217_66 };

/// Points closer than this to a border, in metres, are on it: the polygon library's raster is finer than
/// this for any building.
const ON_BORDER_M: f64 = 1e-4;

impl TileGrid {
    /// The tiles of a plan with these bounds; `None` if it is too small to be cut.
    pub fn of(bounds: Bounds, elements: usize) -> Option<Self> {
        if elements < LEAST_ELEMENTS || bounds.is_empty() {
            return None;
        }
        let tiles = elements as f64 / ELEMENTS_A_TILE;
        let (width_m, height_m) = (bounds.width().max(1.0), bounds.height().max(1.0));
        let side_m = (width_m * height_m / tiles).sqrt().max(width_m.max(height_m) / MOST_IN_LINE);
        let count = |length_m: f64| (length_m / side_m).ceil().max(1.0) as usize + 1;
        let (columns, rows) = (count(width_m), count(height_m));
        Some(Self { origin: bounds.min + -OFF_GRID_M, side_m, columns, rows })
    }

    pub fn count(&self) -> usize {
        self.columns * self.rows
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.origin.x) / self.side_m).floor().max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.origin.y) / self.side_m).floor().max(0.0) as usize).min(self.rows - 1)
    }

    /// The tile containing a point; outside points belong to the nearest tile.
    pub fn at(&self, point: Point) -> usize {
        self.row(point.y) * self.columns + self.column(point.x)
    }

    /// The tiles that meet a box.
    pub fn meeting(&self, bounds: Bounds) -> impl Iterator<Item = usize> + '_ {
        let (left, right) = (self.column(bounds.min.x), self.column(bounds.max.x));
        let end = if bounds.is_empty() { 0 } else { self.row(bounds.max.y) + 1 };
        (self.row(bounds.min.y)..end).flat_map(move |row| (left..=right).map(move |column| row * self.columns + column))
    }

    /// The square itself. Outer tiles extend as far as anything is drawn.
    pub fn bounds(&self, tile: usize) -> Bounds {
        // 100 km: the whole drawing area.
        const FAR_M: f64 = 1e5;
        let (column, row) = (tile % self.columns, tile / self.columns);
        let low = |index: usize, start: f64| start + index as f64 * self.side_m;
        let far = |index: usize, count: usize| if index + 1 == count { FAR_M } else { 0.0 };
        let near = |index: usize| if index == 0 { FAR_M } else { 0.0 };
        Bounds {
            min: Point::new(low(column, self.origin.x) - near(column), low(row, self.origin.y) - near(row)),
            max: Point::new(
                low(column + 1, self.origin.x) + far(column, self.columns),
                low(row + 1, self.origin.y) + far(row, self.rows),
            ),
        }
    }

    /// Whether a piece of a polygon's boundary is a cut between tiles.
    pub fn is_cut(&self, a: Point, b: Point) -> bool {
        let on = |p: f64, q: f64, start: f64| {
            let border = start + ((p - start) / self.side_m).round() * self.side_m;
            (p - border).abs() <= ON_BORDER_M && (q - border).abs() <= ON_BORDER_M
        };
        on(a.x, b.x, self.origin.x) || on(a.y, b.y, self.origin.y)
    }
}
