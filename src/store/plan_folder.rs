//! The plan files of a folder: for the command line all below it, for the window those directly in it.

use std::path::{Path, PathBuf};

use walkdir::WalkDir;

use crate::formats;

/// A plan file, or a folder that is itself a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FoundPlan {
    pub path: PathBuf,
    /// Why it cannot be read, if listing the folder already shows it: no permission to enter, or links in
    /// a circle.
    pub problem: Option<String>,
}

/// The files with a plan's extension and the folders that are plans, at most `depth` levels deep (1:
/// directly in the folder), sorted by path. Hidden files, and folders for which `is_left_out` is true,
/// are skipped. A broken link named like a plan is included: reading it says what is wrong.
pub fn plans_below(
    folder: &Path,
    depth: usize,
    is_left_out: impl Fn(&Path) -> bool,
) -> impl Iterator<Item = FoundPlan> {
    let mut walk = WalkDir::new(folder).follow_links(true).max_depth(depth).sort_by_file_name().into_iter();
    std::iter::from_fn(move || {
        loop {
            match walk.next()? {
                Ok(entry) if entry.depth() == 0 => {}
                Ok(entry) => {
                    let name = entry.file_name().to_string_lossy();
                    let is_hidden = name.starts_with('.');
                    let is_folder = entry.file_type().is_dir();
                    let is_plan = !is_hidden
                        && if is_folder {
                            !is_left_out(entry.path()) && formats::folder_format(entry.path()).is_some()
                        } else {
                            entry.file_type().is_file() && formats::is_plan_file_name(&name)
                        };
                    if is_folder && depth > 1 && (is_plan || is_hidden || is_left_out(entry.path())) {
                        walk.skip_current_dir();
                    }
                    if is_plan {
                        return Some(FoundPlan { path: entry.into_path(), problem: None });
                    }
                }
                Err(error) => {
                    let Some(path) = error.path().map(Path::to_owned) else { continue };
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    let is_link = path.symlink_metadata().is_ok_and(|data| data.file_type().is_symlink());
                    if let Some(ancestor) = error.loop_ancestor() {
                        let problem = format!("leads back to {}", ancestor.display());
                        return Some(FoundPlan { path, problem: Some(problem) });
                    }
                    if !is_link {
                        let problem = error.io_error().map_or_else(|| error.to_string(), ToString::to_string);
                        return Some(FoundPlan { path, problem: Some(problem) });
                    }
                    if formats::is_plan_file_name(&name) && !name.starts_with('.') {
                        return Some(FoundPlan { path, problem: None });
                    }
                }
            }
        }
    })
}
