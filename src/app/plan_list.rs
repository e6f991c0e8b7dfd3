//! The plans of a folder, and those that come with the program.

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use super::document::{Origin, bundled};
use crate::formats;

/// What the panel on the left lists.
#[derive(Debug, Default)]
pub(super) struct PlanList {
    pub folder: Option<PathBuf>,
    /// The plans in it, in natural order of their names.
    pub files: Vec<PathBuf>,
}

impl PlanList {
    pub(super) fn set_folder(&mut self, folder: PathBuf, files: Vec<PathBuf>) {
        self.folder = Some(folder);
        self.files = files;
    }

    /// How many plans are listed, bundled ones included.
    pub(super) fn len(&self) -> usize {
        self.files.len() + bundled().len()
    }

    /// The plan `step` places after the current one, in the list from top to bottom.
    pub(super) fn neighbour(&self, current: Option<&Origin>, step: isize) -> Option<Origin> {
        let next = match current? {
            Origin::Bundled(index) => (self.files.len() + index).checked_add_signed(step)?,
            Origin::File { path, .. } => self.files.iter().position(|file| file == path)?.checked_add_signed(step)?,
            // In front of the first.
            Origin::Untitled => usize::try_from(step - 1).ok()?,
        };
        match self.files.get(next) {
            Some(path) => Some(Origin::File { path: path.clone(), storey: 0 }),
            None => {
                let index = next.checked_sub(self.files.len())?;
                (index < bundled().len()).then_some(Origin::Bundled(index))
            }
        }
    }
}

/// More plans than this in one folder are not listed: nobody reads such a list.
const LIST_LIMIT: usize = 20_000;

/// The plan files in a folder, in natural order of their names; none when it cannot be read.
pub(super) fn plans_in(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(if folder.as_os_str().is_empty() { Path::new(".") } else { folder }) else {
        return Vec::new();
    };
    let is_plan = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        formats::is_plan_file_name(&name) && !name.starts_with('.')
    };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(folder.join(entry.ok()?.file_name())))
        .filter(is_plan)
        .filter(|path| path.is_file())
        .take(LIST_LIMIT)
        .collect();
    files.sort_by(|p, q| natural_order(&p.to_string_lossy(), &q.to_string_lossy()));
    files
}

/// The order people expect of names with numbers: `floor 9` before `floor 10`.
fn natural_order(p: &str, q: &str) -> Ordering {
    let (p_parts, q_parts) = (parts(p), parts(q));
    for (a, b) in p_parts.iter().zip(&q_parts) {
        let order = match (a.starts_with(is_digit), b.starts_with(is_digit)) {
            (true, true) => {
                let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
                a.len().cmp(&b.len()).then_with(|| a.cmp(b))
            }
            _ => a.to_lowercase().cmp(&b.to_lowercase()),
        };
        if order != Ordering::Equal {
            return order;
        }
    }
    p_parts.len().cmp(&q_parts.len()).then_with(|| p.cmp(q))
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

/// A text cut where digits begin or end.
fn parts(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut before: Option<bool> = None;
    for (at, c) in text.char_indices() {
        if before.is_some_and(|before| before != is_digit(c)) {
            parts.push(&text[start..at]);
            start = at;
        }
        before = Some(is_digit(c));
    }
    parts.push(&text[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_count() {
        let mut names = ["b 10", "b 9", "B 2", "a", "b 010", "b", "10", "9"];
        names.sort_by(|p, q| natural_order(p, q));
        assert_eq!(names, ["9", "10", "a", "b", "B 2", "b 9", "b 010", "b 10"]);
    }
}
