//! The plans of a folder, and the bundled ones.

use std::path::{Path, PathBuf};

use crate::app::session::origin::{Origin, bundled};
use crate::base::natural_order::NaturalKey;
use crate::store;

/// The contents of the panel on the left.
#[derive(Debug, Default)]
pub(crate) struct PlanList {
    pub folder: Option<PathBuf>,
    /// The plans in it, in natural order of their names.
    pub files: Vec<PathBuf>,
}

impl PlanList {
    pub(crate) fn set_folder(&mut self, folder: PathBuf, files: Vec<PathBuf>) {
        self.folder = Some(folder);
        self.files = files;
    }

    /// How many plans are listed, bundled ones included.
    pub(crate) fn len(&self) -> usize {
        self.files.len() + bundled().len()
    }

    /// The plan `step` places after the current one, in the list from top to bottom.
    pub(crate) fn neighbour(&self, current: Option<&Origin>, step: isize) -> Option<Origin> {
        let next = match current? {
            Origin::Bundled(index) => (self.files.len() + index).checked_add_signed(step)?,
            Origin::File { path, .. } => self.files.iter().position(|file| file == path)?.checked_add_signed(step)?,
            // Before the first.
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

/// The most plans listed from one folder: nobody reads a longer list.
const LIST_LIMIT: usize = 20_000;

/// The plan files in a folder, in natural order of their names; none when it cannot be read.
pub(crate) fn plans_in(folder: &Path) -> Vec<PathBuf> {
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let found = store::plans_below(listed, 1, |_| false).filter(|found| found.problem.is_none());
    let mut files: Vec<PathBuf> = found
        .filter(|found| found.path.exists())
        .filter_map(|found| Some(folder.join(found.path.file_name()?)))
        .take(LIST_LIMIT)
        .collect();
    files.sort_by_cached_key(|path| NaturalKey::of(&path.to_string_lossy()));
    files
}
