use std::fmt;

use crate::geometry::COORDINATE_LIMIT_M;

/// The most passings (of a piece through a node) an arrangement may have. A storey with 100,000 walls has
/// about a million; 10,000,000 take about half a gigabyte: there a hostile file (5,000 lines that all
/// cross) is refused.
pub const PASSINGS_LIMIT: usize = 10_000_000;

/// The most tests (of two pieces, or of a piece and a pixel) an arrangement may take: about ten seconds
/// on one core, fifty times what 100,000 walls need. Only input built for it gets there (tens of
/// thousands of lines fanning out of one point within a narrow angle).
pub const TESTS_LIMIT: u64 = 1_000_000_000;

/// Why segments cannot be arranged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ArrangementError {
    /// The segment with this index has an end that is not finite or lies beyond
    /// [`COORDINATE_LIMIT_M`].
    OutOfRange(usize),
    /// The segments meet too often: more than [`PASSINGS_LIMIT`] times, or it would take more than
    /// [`TESTS_LIMIT`] tests to find out.
    TooDense,
}

impl fmt::Display for ArrangementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange(index) => {
                write!(f, "line {index} reaches beyond the drawing area of ±{COORDINATE_LIMIT_M} m")
            }
            Self::TooDense => write!(
                f,
                "the lines meet too often (more than {PASSINGS_LIMIT} meetings, or {TESTS_LIMIT} tests to find them): \
                 leave out hatchings and other lines that are no walls"
            ),
        }
    }
}

impl std::error::Error for ArrangementError {}
