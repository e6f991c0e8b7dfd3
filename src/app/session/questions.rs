//! What a person is asked, and what waits for the answer.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::app::session::document::Opened;
use crate::app::session::tracing::PictureChange;
use crate::geometry::Segment;
use crate::plan::{ElementId, Plan};

/// What a person wants to do that would lose unsaved work.
#[derive(Debug)]
pub(crate) enum Intent {
    /// Show another plan, which was read meanwhile.
    Show(Box<Opened>),
    /// Show what a journal keeps.
    Recover(PathBuf),
    Close,
    Quit,
}

/// A question that must be answered before anything else.
#[derive(Debug)]
pub(crate) enum Question {
    /// The plan has unsaved changes: save, give up, or keep working?
    Unsaved(Intent),
    /// More would go than is selected: delete it all?
    Delete { selected: Vec<ElementId>, gone: BTreeSet<ElementId> },
    /// Something large would be changed, as shown: do it?
    Change(ProposedChange),
    /// Something else stands in the file to be saved: replace it?
    Replace { path: PathBuf, is_changed_since: bool, then: Option<Intent> },
    /// Give up what a program left behind?
    Discard { path: PathBuf, title: String },
    /// The picture is about to be scaled or turned: does the drawing go along?
    Drawing(PictureChange),
}

/// A change of the plan that is shown before it is made.
#[derive(Debug)]
pub(crate) struct ProposedChange {
    /// What is asked, in a sentence.
    pub(crate) title: String,
    /// What it would do.
    pub(crate) text: String,
    /// The answer that makes it, and 'cancel'.
    pub(crate) answers: &'static [(&'static str, &'static str)],
    /// What it is called in the history.
    pub(crate) step: &'static str,
    /// The plan as it would be.
    pub(crate) plan: Plan,
    /// Where it would do something; a point is a segment without length.
    pub(crate) marks: Vec<Segment>,
}
