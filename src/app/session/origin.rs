//! Where a plan came from, and the notes made when reading it.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::formats::{self, Note, NoteKind};
use crate::plan::Plan;
use crate::store;

/// The bundled plans with their file names; the first is the one to show first.
pub(crate) fn bundled() -> &'static [(&'static str, Plan)] {
    static PLANS: OnceLock<Vec<(&str, Plan)>> = OnceLock::new();
    // The tests fail if they cannot be read; if one were broken, there would be no samples.
    PLANS.get_or_init(|| store::bundled_plans().unwrap_or_default())
}

/// Where a plan came from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// One of [`bundled`], by its index.
    Bundled(usize),
    /// Created here, and in no file yet.
    Untitled,
    /// A file; `storey` counts the plans in it from 0.
    File { path: PathBuf, storey: usize },
}

impl Origin {
    /// Whether both are the same sample, or the same plan of a file however its path is written. A new plan is never another.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Bundled(p), Self::Bundled(q)) => p == q,
            (Self::File { path: p, storey: i }, Self::File { path: q, storey: j }) => {
                i == j && absolute(p) == absolute(q)
            }
            _ => false,
        }
    }

    /// The file, if it is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        match self {
            Self::Bundled(_) | Self::Untitled => None,
            Self::File { path, .. } => Some(path),
        }
    }

    /// The folder of the file.
    pub(crate) fn folder(&self) -> Option<&Path> {
        self.path().and_then(Path::parent)
    }

    /// Its title in lists.
    pub(crate) fn title(&self) -> String {
        match self {
            Self::Bundled(index) => bundled().get(*index).map_or("", |(_, plan)| &plan.meta().name).to_owned(),
            Self::Untitled => "Untitled".to_owned(),
            Self::File { path, .. } => file_name(path),
        }
    }

    /// Its file's name without the extension.
    pub(crate) fn stem(&self) -> String {
        match self {
            Self::Bundled(index) => {
                formats::file_stem(bundled().get(*index).map_or("plan", |(name, _)| name)).to_owned()
            }
            Self::Untitled => "untitled".to_owned(),
            Self::File { path, .. } => formats::file_stem(&file_name(path)).to_owned(),
        }
    }
}

/// A path from the root, so that two ways to write it are told for the same; as it is where there is no working folder.
pub(crate) fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// A path's last part.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// How many notes of each kind, in words: '3 things mended, 1 left out'.
pub(crate) fn notes_in_words(notes: &[Note]) -> String {
    let number = |kind: NoteKind| notes.iter().filter(|note| note.kind == kind).count();
    let (healed, skipped) = (number(NoteKind::Healed), number(NoteKind::Skipped));
    let things = |number: usize| if number == 1 { "thing" } else { "things" };
    match (healed, skipped) {
        (0, skipped) => format!("{skipped} {} left out", things(skipped)),
        (healed, 0) => format!("{healed} {} repaired", things(healed)),
        (healed, skipped) => format!("{healed} {} repaired, {skipped} left out", things(healed)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::Place;

    #[test]
    fn summaries_read_well() {
        let note = |kind| Note { kind, place: Place::default(), what: String::new() };
        assert_eq!(notes_in_words(&[note(NoteKind::Healed)]), "1 thing repaired");
        assert_eq!(notes_in_words(&[note(NoteKind::Skipped), note(NoteKind::Skipped)]), "2 things left out");
        assert_eq!(notes_in_words(&[note(NoteKind::Skipped), note(NoteKind::Healed)]), "1 thing repaired, 1 left out");
    }
}
