//! The folders of a script. It reads what is beside it and never changes that: every file it opens is
//! first copied to a folder of its own, and all it saves goes there.

use std::path::{Path, PathBuf};

use super::fault::Fault;
use super::words::written;
use crate::app::session::plan_list::Depth;
use crate::base::file_name::inner_path;
use crate::formats;
use crate::store::save_bytes_fast;

/// Where a script reads and writes.
pub(super) struct Folders {
    /// The script's folder: paths in it are relative to this.
    pub script: PathBuf,
    /// The script's working folder: copies of what it opens, and what it saves.
    pub work: PathBuf,
    /// The folder with the reference pictures for its snapshots.
    pub snapshots: PathBuf,
    /// Where to keep every picture, if anywhere.
    pub kept_pictures: Option<PathBuf>,
}

impl Folders {
    /// Copies a file or a folder of plans named by a script to its working folder; a copy already there
    /// is used as it is.
    ///
    /// # Errors
    /// When it does not exist or cannot be copied.
    pub(super) fn brought_in(&self, path: &str) -> Result<PathBuf, Fault> {
        let target = self.work.join(inner(path).unwrap_or_else(|| last_two(Path::new(path))));
        if target.exists() {
            return Ok(target);
        }
        let source = self.script.join(path);
        if source.is_dir() {
            let plans = crate::app::session::plan_list::plans_in(&source, Depth::All);
            std::fs::create_dir_all(&target).map_err(|error| cannot_copy(path, &error.to_string()))?;
            for plan in plans {
                let within = plan.strip_prefix(&source).map_or_else(|_| file_name(&plan), Path::to_owned);
                copy_plan(&plan, &target.join(within)).map_err(|what| cannot_copy(path, &what))?;
            }
        } else if source.is_file() {
            copy_plan(&source, &target).map_err(|what| cannot_copy(path, &what))?;
        } else {
            let what = format!("there is no file {}", written(path));
            return Err(Fault::new(what).hint("paths start at the script's folder"));
        }
        Ok(target)
    }

    /// Copies a file beside the script to the working folder, under a name of its own.
    ///
    /// # Errors
    /// When it does not exist or cannot be copied.
    pub(super) fn brought_in_as(&self, path: &str, name: &str) -> Result<(), Fault> {
        copy(&self.script.join(path), &self.work.join(name)).map_err(|what| cannot_copy(path, &what))
    }

    /// The path in the working folder where the script saves; creates its folder.
    ///
    /// # Errors
    /// When the path leads outside.
    pub(super) fn to_write(&self, path: &str) -> Result<PathBuf, Fault> {
        let target = self.work.join(inner(path).ok_or_else(|| {
            Fault::new(format!("{} leads out of the script's own folder", written(path)))
                .hint("scripts save nowhere else; enfilade replay --output DIR keeps what they save")
        })?);
        if let Some(folder) = target.parent() {
            std::fs::create_dir_all(folder).map_err(|error| Fault::new(format!("{path}: {error}")))?;
        }
        Ok(target)
    }
}

fn cannot_copy(path: &str, what: &str) -> Fault {
    Fault::new(format!("{} cannot be read: {what}", written(path)))
}

/// A relative path that stays inside the folder it starts from.
pub(super) fn inner(path: &str) -> Option<PathBuf> {
    inner_path(path).ok()
}

fn file_name(path: &Path) -> PathBuf {
    path.file_name().map(PathBuf::from).unwrap_or_else(|| PathBuf::from("plan"))
}

/// A path's last folder and file name: files from elsewhere get folders of their own.
fn last_two(path: &Path) -> PathBuf {
    let folder = path.parent().and_then(Path::file_name).map(PathBuf::from).unwrap_or_default();
    folder.join(file_name(path))
}

/// Copies a plan, and its backdrop if that is beside it.
fn copy_plan(source: &Path, target: &Path) -> Result<(), String> {
    copy(source, target)?;
    // If it is not a plan, the window will say so.
    let plans = formats::read_file(source).map(|import| import.plans).unwrap_or_default();
    for picture in plans.iter().filter_map(|plan| plan.backdrop()).filter_map(|backdrop| inner(&backdrop.path)) {
        let beside = |path: &Path| path.parent().unwrap_or(Path::new("")).join(&picture);
        if beside(source).is_file() {
            copy(&beside(source), &beside(target))?;
        }
    }
    Ok(())
}

fn copy(source: &Path, target: &Path) -> Result<(), String> {
    let bytes = formats::read_bytes(source).map_err(|error| error.to_string())?;
    if let Some(folder) = target.parent() {
        std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    }
    save_bytes_fast(target, &bytes).map_err(|error| error.to_string())
}
