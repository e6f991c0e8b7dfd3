use std::fmt;

use super::{PASSINGS_LIMIT, TESTS_LIMIT};
use crate::geometry::COORDINATE_LIMIT_M;

/// Why segments cannot be arranged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ArrangementError {
    /// The segment with this index has an end that is not finite or lies beyond
    /// [`COORDINATE_LIMIT_M`].
    OutOfRange(usize),
    /// The segments meet too often: more than [`PASSINGS_LIMIT`] times, or finding out would take
    /// more than [`TESTS_LIMIT`] tests.
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
