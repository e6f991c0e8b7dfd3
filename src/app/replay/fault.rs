//! Why a step of a script failed.

use std::path::PathBuf;

/// Why a step failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    /// What was expected and what was found.
    pub what: String,
    /// What to do about it; may be empty.
    pub hint: String,
    /// Files written for inspection.
    pub files: Vec<PathBuf>,
    /// Whether the following steps still make sense.
    pub goes_on: bool,
}

impl Fault {
    /// A fault after which the script cannot continue.
    pub(super) fn new(what: impl Into<String>) -> Self {
        Self { what: what.into(), hint: String::new(), files: Vec::new(), goes_on: false }
    }

    /// A fault of a check that changes nothing.
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
