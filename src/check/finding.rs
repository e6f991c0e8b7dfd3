use std::cmp::Ordering;
use std::fmt;

use super::Context;
use crate::edit::EditError;
use crate::geometry::Point;
use crate::plan::titles::RoomName;
use crate::plan::{ElementId, Plan};

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Not necessarily wrong; worth a look.
    Info,
    /// Probably a mistake, but what is computed from the plan still means something.
    Warning,
    /// A mistake: something computed from the plan is wrong or missing.
    Error,
}

impl Severity {
    pub const ALL: [Self; 3] = [Self::Error, Self::Warning, Self::Info];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A kind of finding.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// Its name for machines: that of its source file.
    pub name: &'static str,
    /// Its name for people, as a heading above several findings.
    pub title: &'static str,
    pub severity: Severity,
    /// What to do about it.
    pub remedy: &'static str,
}

/// Where a finding is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Place<'a> {
    /// The elements involved, the ones to change first.
    pub elements: Vec<ElementId>,
    /// The rooms involved, by name.
    pub rooms: Vec<&'a RoomName>,
    /// A point to look at, in metres.
    pub at: Option<Point>,
}

/// A check: a type of finding and how to find it.
pub trait Check: Sized {
    const KIND: Kind;

    /// All findings of this kind; if there are more than [`super::FINDINGS_LIMIT`], at least that many.
    fn find(context: &Context) -> Vec<Self>;

    /// Where it is.
    fn place(&self) -> Place<'_>;

    /// What was found, in words, without a full stop.
    fn what(&self) -> String;

    /// The measured figures; names include the unit.
    fn figures(&self) -> Vec<(&'static str, f64)> {
        Vec::new()
    }

    /// The size of the fault, for listing the worst first; the measure depends on the kind.
    fn size(&self) -> f64 {
        0.0
    }

    /// What can be done about it without a doubt, as the title of a step: 'Weld the corners'. `None` where a person has
    /// to decide.
    fn fix_title(&self) -> Option<&'static str> {
        None
    }

    /// The plan with that done; `plan` is the one that was checked.
    ///
    /// # Errors
    /// When it has no fix, or the edit is refused.
    fn fixed(&self, _plan: &Plan) -> Result<Plan, EditError> {
        Err(EditError("there is no safe fix".to_owned()))
    }

    /// The severity: that of its kind, unless the figures say otherwise.
    fn severity(&self) -> Severity {
        Self::KIND.severity
    }
}

/// The order in which findings of a kind are listed: worst first, then in reading order from the top
/// left, then by element.
pub(super) fn worst_first<C: Check>(one: &C, other: &C) -> Ordering {
    let (place, other_place) = (one.place(), other.place());
    let reading = |place: &Place| place.at.map_or((f64::INFINITY, 0.0), |at| (-at.y, at.x));
    let ((down, right), (other_down, other_right)) = (reading(&place), reading(&other_place));
    other
        .size()
        .total_cmp(&one.size())
        .then_with(|| down.total_cmp(&other_down))
        .then_with(|| right.total_cmp(&other_right))
        .then_with(|| place.elements.cmp(&other_place.elements))
}
