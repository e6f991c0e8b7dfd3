//! Reports of readers: what they repaired or skipped, and why a file cannot be read.

use std::fmt;
use std::path::PathBuf;

/// One thing that a reader repaired or skipped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    pub kind: NoteKind,
    pub place: Place,
    /// What was found and what was done, in a sentence.
    pub what: String,
}

/// What a reader did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteKind {
    /// It is in the plan, repaired.
    Healed,
    /// It is not in the plan.
    Skipped,
}

impl NoteKind {
    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Healed => "healed",
            Self::Skipped => "skipped",
        }
    }
}

/// A place in a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Line from 1, if the format has lines.
    pub line: Option<usize>,
    /// The element ('space 3547daca-…'); empty for the file as a whole.
    pub element: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.element.as_str()) {
            (None, "") => f.write_str("file"),
            (None, element) => f.write_str(element),
            (Some(line), "") => write!(f, "line {line}"),
            (Some(line), element) => write!(f, "line {line}, {element}"),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}: {}", self.kind.name(), self.place, self.what)
    }
}

/// Why a file could not be read: what is wrong, where, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    pub place: Place,
    pub what: String,
    /// What the user can do about it.
    pub hint: String,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.place != Place::default() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.what)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for ReadError {}

/// A [`ReadError`] with the file it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    pub path: PathBuf,
    pub error: ReadError,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.error)
    }
}

impl std::error::Error for FileError {}
