//! A file to import and its outcome.

use super::super::batch::Input;
use super::super::{CliError, Terminal};
use crate::formats::{self, Note};
use crate::plan::Plan;
use std::path::PathBuf;

/// A file to import.
pub(super) struct Job {
    pub(super) input: Input,
    /// The folder it is counted under.
    pub(super) folder: PathBuf,
    /// The path of its plan in the output folder, without the extension.
    pub(super) target: PathBuf,
}

/// A file and its outcome.
pub(super) struct File {
    pub(super) job: Job,
    pub(super) content: Content,
}

pub(super) enum Content {
    Plans {
        plans: Vec<ImportedPlan>,
        notes: Vec<Note>,
    },
    /// Not a plan, although its name ends like one: skipped.
    Foreign(String),
    Failed(formats::FileError),
}

pub(super) struct ImportedPlan {
    pub(super) plan: Plan,
    pub(super) target: PathBuf,
    pub(super) state: State,
}

/// The outcome of writing a plan's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum State {
    Waiting,
    Written,
    /// The same plan was already there.
    Unchanged,
    /// A different plan was there, and was kept.
    Kept,
    NotSaved(String),
}

impl State {
    pub(super) const fn name(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Written => "written",
            Self::Unchanged => "unchanged",
            Self::Kept => "kept",
            Self::NotSaved(_) => "not saved",
        }
    }
}

impl File {
    pub(super) fn plans(&self) -> &[ImportedPlan] {
        match &self.content {
            Content::Plans { plans, .. } => plans,
            Content::Foreign(_) | Content::Failed(_) => &[],
        }
    }

    pub(super) fn notes(&self) -> &[Note] {
        match &self.content {
            Content::Plans { notes, .. } => notes,
            Content::Foreign(_) | Content::Failed(_) => &[],
        }
    }

    /// Whether it could not be read, or one of its plans could not be saved.
    pub(super) fn is_wrong(&self) -> bool {
        matches!(self.content, Content::Failed(_))
            || self.plans().iter().any(|plan| matches!(plan.state, State::Kept | State::NotSaved(_)))
    }

    pub(super) fn report_errors(&self, terminal: &mut Terminal) -> Result<(), CliError> {
        if let Content::Failed(error) = &self.content {
            terminal.error(error)?;
        }
        for plan in self.plans() {
            match &plan.state {
                State::Kept => terminal.error(format!(
                    "{}: kept, because it differs from the result of {}; --force overwrites it",
                    plan.target.display(),
                    self.job.input.path.display()
                ))?,
                State::NotSaved(why) => terminal.error(why)?,
                State::Waiting | State::Written | State::Unchanged => {}
            }
        }
        Ok(())
    }
}
