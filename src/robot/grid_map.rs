//! Occupancy grids: free, occupied or unknown, cell by cell.

use super::Pose;
use crate::geometry::Point;

/// The maximum number of cells: 25 million, 250 m by 250 m at 0.05 m. Segmentation needs about 30 bytes
/// per cell, so this stays below a gigabyte.
pub const MOST_CELLS: usize = 25_000_000;

/// The state of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cell {
    Free,
    Occupied,
    #[default]
    Unknown,
}

/// An occupancy grid as published by `map_server`: square cells, rows from the top of the picture down.
#[derive(Clone, Debug, PartialEq)]
pub struct GridMap {
    width: usize,
    height: usize,
    /// Side of a cell in metres.
    pub resolution_m: f64,
    /// The position of the lower left corner of the lower left cell in the map's frame, and the rotation
    /// of the grid's rows.
    pub map_from_grid: Pose,
    cells: Vec<Cell>,
}

/// Why a grid is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GridMapError {
    Empty,
    TooLarge { width: usize, height: usize },
    WrongCount { cells: usize, expected: usize },
    Resolution(f64),
    Origin,
}

impl std::fmt::Display for GridMapError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Empty => f.write_str("the map has no cells"),
            Self::TooLarge { width, height } => write!(
                f,
                "a map of {width} x {height} cells is too large (at most {} million); crop it or halve its resolution",
                MOST_CELLS / 1_000_000
            ),
            Self::WrongCount { cells, expected } => write!(f, "the map has {cells} cells instead of {expected}"),
            Self::Resolution(m) => write!(
                f,
                "a resolution of {m} m a cell is not possible; give metres a cell between {LEAST_RESOLUTION_M} and {MOST_RESOLUTION_M}, 0.05 for example"
            ),
            Self::Origin => f.write_str("the map's origin is not finite or lies more than 90 km away"),
        }
    }
}

impl std::error::Error for GridMapError {}

/// Half a centimetre: finer than laser scanners measure.
const LEAST_RESOLUTION_M: f64 = 0.005;
/// A coarser grid than a doorway is wide could not separate rooms.
const MOST_RESOLUTION_M: f64 = 1.0;
/// Plans end at 100 km: further away none can be drawn.
const FARTHEST_ORIGIN_M: f64 = 90_000.0;

impl GridMap {
    /// A grid of cells given row by row from the top.
    ///
    /// # Errors
    /// When the grid is empty or larger than [`MOST_CELLS`], the number of cells does not match its
    /// sides, or resolution or origin are out of range.
    pub fn new(
        width: usize,
        height: usize,
        resolution_m: f64,
        map_from_grid: Pose,
        cells: Vec<Cell>,
    ) -> Result<Self, GridMapError> {
        Self::check_size(width, height)?;
        if cells.len() != width * height {
            return Err(GridMapError::WrongCount { cells: cells.len(), expected: width * height });
        }
        if !(LEAST_RESOLUTION_M..=MOST_RESOLUTION_M).contains(&resolution_m) {
            return Err(GridMapError::Resolution(resolution_m));
        }
        let is_near = map_from_grid.x_m.abs().max(map_from_grid.y_m.abs()) <= FARTHEST_ORIGIN_M;
        if !map_from_grid.is_finite() || !is_near {
            return Err(GridMapError::Origin);
        }
        Ok(Self { width, height, resolution_m, map_from_grid, cells })
    }

    /// Checks a grid's size, before its cells are read.
    ///
    /// # Errors
    /// When it is empty or larger than [`MOST_CELLS`].
    pub fn check_size(width: usize, height: usize) -> Result<(), GridMapError> {
        match width.checked_mul(height) {
            Some(0) => Err(GridMapError::Empty),
            Some(count) if count <= MOST_CELLS => Ok(()),
            _ => Err(GridMapError::TooLarge { width, height }),
        }
    }

    pub fn width(&self) -> usize {
        self.width
    }

    pub fn height(&self) -> usize {
        self.height
    }

    /// The cells row by row from the top.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The position of a point of the picture in the map's frame. `x` and `y` are in cells, from the
    /// upper left corner of the upper left cell, y down.
    pub fn map_from_picture(&self, x: f64, y: f64) -> Point {
        let up = self.height as f64 - y;
        self.map_from_grid.apply(Point::new(x * self.resolution_m, up * self.resolution_m))
    }

    /// The inverse of [`Self::map_from_picture`].
    pub fn picture_from_map(&self, point: Point) -> (f64, f64) {
        let at = self.map_from_grid.inverse().apply(point);
        (at.x / self.resolution_m, self.height as f64 - at.y / self.resolution_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn picture_and_map_frames_are_each_others_inverse() {
        let map = GridMap::new(4, 3, 0.05, Pose::new(-10.0, 2.0, 0.3), vec![Cell::Free; 12]).unwrap();
        let lower_left = map.map_from_picture(0.0, 3.0);
        assert!(lower_left.distance(Point::new(-10.0, 2.0)) < 1e-12);
        let (x, y) = map.picture_from_map(map.map_from_picture(1.5, 0.25));
        assert!((x - 1.5).abs() < 1e-9 && (y - 0.25).abs() < 1e-9);
    }

    #[test]
    fn grids_that_cannot_be_are_refused() {
        let of =
            |width, height, resolution| GridMap::new(width, height, resolution, Pose::IDENTITY, vec![Cell::Free; 1]);
        assert_eq!(of(0, 0, 0.05), Err(GridMapError::Empty));
        assert!(matches!(of(20_000, 20_000, 0.05), Err(GridMapError::TooLarge { .. })));
        assert!(matches!(of(usize::MAX, 2, 0.05), Err(GridMapError::TooLarge { .. })));
        assert!(matches!(of(1, 1, f64::NAN), Err(GridMapError::Resolution(_))));
        assert!(of(1, 1, 0.05).is_ok());
    }
}
