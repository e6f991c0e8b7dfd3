//! Points, vectors, segments, boxes and polygons. Knows nothing of plans.
//!
//! Lengths are metres, areas square metres, angles radians; the y axis points up, so that a
//! counter-clockwise ring has a positive area.

pub mod areas;
pub mod arrangement;
mod bounds;
pub mod homography;
pub mod hull;
pub mod path;
mod point;
pub mod polygon;
pub mod raster;
pub mod runs;
mod segment;
pub mod segments;
pub(crate) mod tangle;
mod transform;

pub use bounds::Bounds;
pub use homography::Homography;
pub use point::{Point, Vector};
pub use segment::Segment;
pub use transform::Transform;

/// The grid on which every stored length lies: 0.1 mm.
///
/// A tenth of a millimetre is far below what anyone measures in a building, and coordinates trimmed
/// to it print with at most four decimals, which makes saving twice give the same bytes.
pub const GRID_M: f64 = 1e-4;

/// Two things this close, in metres, touch: far above the rounding to the [`GRID_M`] grid, far below
/// [`runs::NOTCH_M`], the finest detail of a boundary.
pub const TOUCH_M: f64 = 0.001;

/// Rounds a length or coordinate in metres to the grid of [`GRID_M`]; never returns negative zero.
///
/// NaN and infinities pass through: file readers refuse them and say where they are.
pub fn trim_m(value_m: f64) -> f64 {
    // `+ 0.0` turns -0.0 into 0.0, which would otherwise print differently.
    (value_m * 1e4).round() / 1e4 + 0.0
}

/// No coordinate may be further than this from the origin, in metres: 100 km is larger than any building,
/// and well within what an `f64` resolves to 0.1 mm.
pub const COORDINATE_LIMIT_M: f64 = 100_000.0;
