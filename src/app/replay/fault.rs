//! Why a step of a script did not do what it says.

use std::path::PathBuf;

/// Why a step did not do what it says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// What was expected and what was found.
    pub what: String,
    /// What to do about it; may be empty.
    pub hint: String,
    /// What was written to look at.
    pub files: Vec<PathBuf>,
    /// Whether the steps that follow still mean something.
    pub goes_on: bool,
}

impl Fault {
    /// One after which the script cannot go on.
    pub(super) fn new(what: impl Into<String>) -> Self {
        Self { what: what.into(), hint: String::new(), files: Vec::new(), goes_on: false }
    }

    /// One of something that was only looked at.
    pub(super) fn unmet(what: impl Into<String>) -> Self {
        Self { goes_on: true, ..Self::new(what) }
    }

    pub(super) fn hint(self, hint: impl Into<String>) -> Self {
        Self { hint: hint.into(), ..self }
    }

    pub(super) fn files(self, files: Vec<PathBuf>) -> Self {
        Self { files, ..self }
    }
}
