//! Guide lines: endless lines to draw along. They are part of the document, so that they are still there
//! tomorrow, and no part of the building.

use std::cmp::Ordering;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

use super::edit::EditError;
use super::{COORDINATE_LIMIT_M, Extra, Plan};
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

    /// The word for files and for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal",
            Self::Vertical => "vertical",
        }
    }

    /// The coordinate of a point that a guide through it is at.
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

/// An endless line.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    pub axis: GuideAxis,
    /// Its y where it is horizontal, its x where it is vertical, in metres on the 0.1 mm grid.
    pub at_m: f64,
    pub extra: Extra,
}

impl Guide {
    /// A guide at a place, on the 0.1 mm grid.
    pub fn new(axis: GuideAxis, at_m: f64) -> Self {
        Self { axis, at_m: trim_m(at_m), extra: None }
    }

    fn is_at(&self, axis: GuideAxis, at_m: f64) -> bool {
        self.axis == axis && self.at_m == trim_m(at_m)
    }

    fn order(&self, other: &Self) -> Ordering {
        self.axis.cmp(&other.axis).then(self.at_m.total_cmp(&other.at_m))
    }
}

/// More guides than this hide the plan; no file brings more.
pub const MOST_GUIDES: usize = 1000;

/// Guides in the order of files: horizontal ones first, each axis ascending; of two at one place the
/// first.
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

    /// The plan with other guides.
    fn with_guides(&self, guides: impl IntoIterator<Item = Guide>) -> Self {
        Self { guides: sorted(guides), ..self.clone() }
    }
}

/// Adds a guide line; where there is one already, nothing changes.
///
/// # Errors
/// When it lies outside the drawing area, or there are [`MOST_GUIDES`].
pub fn add_guide(plan: &Plan, axis: GuideAxis, at_m: f64) -> Result<Plan, EditError> {
    if !(at_m.is_finite() && at_m.abs() <= COORDINATE_LIMIT_M) {
        return Err(EditError(format!("{at_m} m lies outside the drawing area of ±{COORDINATE_LIMIT_M} m")));
    }
    if plan.guides.len() >= MOST_GUIDES {
        return Err(EditError(format!("there are {MOST_GUIDES} guides already")));
    }
    Ok(plan.with_guides(plan.guides.iter().cloned().chain([Guide::new(axis, at_m)])))
}

/// Takes a guide line away.
///
/// # Errors
/// When there is none at the place.
pub fn remove_guide(plan: &Plan, axis: GuideAxis, at_m: f64) -> Result<Plan, EditError> {
    let kept: Vec<Guide> = plan.guides.iter().filter(|guide| !guide.is_at(axis, at_m)).cloned().collect();
    if kept.len() == plan.guides.len() {
        return Err(EditError(format!("there is no {axis} guide at {} m", trim_m(at_m))));
    }
    Ok(plan.with_guides(kept))
}

/// Moves a guide line along its normal; what a file says of it beside goes along.
///
/// # Errors
/// As [`remove_guide`] and [`add_guide`].
pub fn move_guide(plan: &Plan, axis: GuideAxis, from_m: f64, to_m: f64) -> Result<Plan, EditError> {
    let moved = plan.guides.iter().find(|guide| guide.is_at(axis, from_m)).cloned();
    let without = remove_guide(plan, axis, from_m)?;
    // Checks the place.
    add_guide(&without, axis, to_m)?;
    let moved = moved.map(|guide| Guide { at_m: trim_m(to_m), ..guide });
    Ok(without.with_guides(without.guides.iter().cloned().chain(moved)))
}

/// Takes all guide lines away.
pub fn clear_guides(plan: &Plan) -> Plan {
    plan.with_guides([])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guides_are_sorted_unique_and_on_the_grid() {
        let plan = Plan::default();
        let plan = add_guide(&plan, GuideAxis::Vertical, 3.0).unwrap();
        let plan = add_guide(&plan, GuideAxis::Vertical, 1.000_04).unwrap();
        let plan = add_guide(&plan, GuideAxis::Horizontal, 7.0).unwrap();
        let again = add_guide(&plan, GuideAxis::Vertical, 1.0).unwrap();
        assert_eq!(again, plan);
        let places: Vec<_> = plan.guides().iter().map(|guide| (guide.axis.name(), guide.at_m)).collect();
        assert_eq!(places, [("horizontal", 7.0), ("vertical", 1.0), ("vertical", 3.0)]);
        let moved = move_guide(&plan, GuideAxis::Vertical, 1.0, 4.0).unwrap();
        assert_eq!(moved.guides().iter().map(|guide| guide.at_m).collect::<Vec<_>>(), [7.0, 3.0, 4.0]);
        assert!(remove_guide(&plan, GuideAxis::Horizontal, 1.0).is_err());
        assert!(add_guide(&plan, GuideAxis::Horizontal, f64::NAN).is_err());
        assert!(move_guide(&plan, GuideAxis::Vertical, 1.0, 1e9).is_err());
        assert_eq!(clear_guides(&plan).guides(), []);
        assert_eq!(remove_guide(&plan, GuideAxis::Vertical, 3.0).unwrap().guides().len(), 2);
    }
}
