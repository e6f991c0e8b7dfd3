//! Guide lines: infinite lines to draw along. They are saved with the document but are not part of the
//! building.

use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use super::{Extra, Plan};
use crate::geometry::{Point, trim_m};

/// Which way a guide runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GuideAxis {
    /// All its points have the same y.
    Horizontal,
    /// All its points have the same x.
    Vertical,
}

impl GuideAxis {
    pub const ALL: [Self; 2] = [Self::Horizontal, Self::Vertical];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal",
            Self::Vertical => "vertical",
        }
    }

    /// The coordinate of a guide through this point.
    pub const fn coordinate(self, point: Point) -> f64 {
        match self {
            Self::Horizontal => point.y,
            Self::Vertical => point.x,
        }
    }
}

impl fmt::Display for GuideAxis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for GuideAxis {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, Self::Err> {
        let found = Self::ALL.into_iter().find(|axis| axis.name() == word);
        found.ok_or_else(|| format!("'{word}' is no way of a guide: it is horizontal or vertical"))
    }
}

/// An infinite line.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    pub axis: GuideAxis,
    /// Its y if horizontal, its x if vertical, in metres on the 0.1 mm grid.
    pub at_m: f64,
    pub extra: Extra,
}

impl Guide {
    /// A guide at a coordinate, rounded to the 0.1 mm grid.
    pub fn new(axis: GuideAxis, at_m: f64) -> Self {
        Self { axis, at_m: trim_m(at_m), extra: None }
    }

    pub(crate) fn is_at(&self, axis: GuideAxis, at_m: f64) -> bool {
        self.axis == axis && self.at_m == trim_m(at_m)
    }

    fn order(&self, other: &Self) -> Ordering {
        self.axis.cmp(&other.axis).then(self.at_m.total_cmp(&other.at_m))
    }
}

/// The most guides: more would hide the plan. Files may not bring more.
pub const MOST_GUIDES: usize = 1000;

/// Guides in file order: horizontal ones first, each axis ascending; of duplicates, the first is kept.
pub(crate) fn sorted(guides: impl IntoIterator<Item = Guide>) -> Arc<[Guide]> {
    let mut guides: Vec<Guide> = guides.into_iter().collect();
    guides.sort_by(Guide::order);
    guides.dedup_by(|later, first| later.order(first).is_eq());
    guides.into()
}

impl Plan {
    /// The guide lines, horizontal ones first, each axis ascending.
    pub fn guides(&self) -> &[Guide] {
        &self.guides
    }

    /// The plan with these guides instead.
    pub(crate) fn with_guides(&self, guides: impl IntoIterator<Item = Guide>) -> Self {
        Self { guides: sorted(guides), ..self.clone() }
    }
}
