//! Findings of a check that somebody has looked at and leaves as they are, each with the reason.

use std::cmp::Ordering;
use std::sync::Arc;

use super::{ElementId, Extra, Plan};

/// A finding that is left as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Ignored {
    /// The kind of finding, by its name for machines: `room_has_no_opening`.
    pub kind: String,
    /// What is concerned, sorted, each once. Empty for the plan as a whole.
    pub elements: Vec<ElementId>,
    /// Why, in somebody's own words; not empty.
    pub reason: String,
    pub extra: Extra,
}

impl Ignored {
    /// A finding of a kind about these elements.
    pub fn new(kind: &str, elements: impl IntoIterator<Item = ElementId>, reason: &str) -> Self {
        let mut elements: Vec<ElementId> = elements.into_iter().collect();
        elements.sort_unstable();
        elements.dedup();
        Self { kind: kind.to_owned(), elements, reason: reason.trim().to_owned(), extra: None }
    }

    /// Whether both are about the same finding.
    pub fn is_about(&self, other: &Self) -> bool {
        self.order(other).is_eq()
    }

    fn order(&self, other: &Self) -> Ordering {
        self.kind.cmp(&other.kind).then_with(|| self.elements.cmp(&other.elements))
    }
}

/// The most that a plan may ignore. Files may not bring more.
pub const MOST_IGNORED: usize = 10_000;

/// In file order: by kind, then by elements; of several about the same, the first is kept.
pub(crate) fn sorted(ignored: impl IntoIterator<Item = Ignored>) -> Arc<[Ignored]> {
    let mut ignored: Vec<Ignored> = ignored.into_iter().collect();
    ignored.sort_by(Ignored::order);
    ignored.dedup_by(|later, first| later.is_about(first));
    ignored.into()
}

impl Plan {
    /// The findings that are left as they are, by kind and elements.
    pub fn ignored(&self) -> &[Ignored] {
        &self.ignored
    }

    /// The plan with these instead.
    pub(crate) fn with_ignored(&self, ignored: impl IntoIterator<Item = Ignored>) -> Self {
        Self { ignored: sorted(ignored), ..self.clone() }
    }
}
