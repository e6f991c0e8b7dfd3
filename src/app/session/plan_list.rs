//! The plans of a folder, and the bundled ones.

use std::path::{Path, PathBuf};

use crate::app::session::origin::{Origin, bundled};
use crate::base::natural_order::NaturalKey;
use crate::store;

/// The contents of the panel on the left.
#[derive(Debug, Default)]
pub(crate) struct PlanList {
    pub folder: Option<PathBuf>,
    pub depth: Depth,
    /// The plans in it, in natural order of their names.
    pub files: Vec<PathBuf>,
}

/// Which plans of a folder are listed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Depth {
    /// Those in the folder itself: beside a file that was opened.
    #[default]
    One,
    /// All below it: of a folder that was opened.
    All,
}

impl PlanList {
    pub(crate) fn set_folder(&mut self, folder: PathBuf, depth: Depth, files: Vec<PathBuf>) {
        self.folder = Some(folder);
        self.depth = depth;
        self.files = files;
    }

    /// What is listed for a plan's folder: the same as now where that holds the folder already.
    pub(crate) fn listed_for(&self, folder: PathBuf) -> (PathBuf, Depth) {
        match &self.folder {
            Some(listed) if self.depth == Depth::All && folder.starts_with(listed) => (listed.clone(), Depth::All),
            _ => (folder, Depth::One),
        }
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

/// The plan files in a folder, in natural order of their paths; none when it cannot be read.
pub(crate) fn plans_in(folder: &Path, depth: Depth) -> Vec<PathBuf> {
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let folders_deep = if depth == Depth::All { usize::MAX } else { 1 };
    let found = store::plans_below(listed, folders_deep, |_| false).filter(|found| found.problem.is_none());
    let mut files: Vec<PathBuf> = found
        .filter(|found| found.path.exists())
        .filter_map(|found| Some(folder.join(found.path.strip_prefix(listed).ok()?)))
        .take(LIST_LIMIT)
        .collect();
    files.sort_by_cached_key(|path| NaturalKey::of(&path.to_string_lossy()));
    files
}
