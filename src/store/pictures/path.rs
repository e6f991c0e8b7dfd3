//! Paths of pictures relative to their plan's folder.

use std::path::{Path, PathBuf};

use super::PictureError;
use crate::plan::Backdrop;

/// The path of a picture as stored in a plan in `folder`: relative with forward slashes; absolute if the
/// plan has no folder yet, or there is no relative path (another drive).
pub fn relative_path(picture: &Path, folder: Option<&Path>) -> String {
    let absolute = |path: &Path| {
        // An empty folder is the current one.
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
    };
    let picture = absolute(picture);
    let relative = folder.and_then(|folder| pathdiff::diff_paths(&picture, absolute(folder)));
    let path = relative.unwrap_or(picture);
    let text = path.to_string_lossy();
    if cfg!(windows) { text.replace('\\', "/") } else { text.into_owned() }
}

/// The file that the picture path of a plan in `folder` refers to.
pub fn resolved_path(path: &str, folder: Option<&Path>) -> PathBuf {
    // Joining an absolute path gives that path.
    folder.unwrap_or(Path::new("")).join(path)
}

/// Whether a picture may be read without being asked for: it lies in the plan's folder or below it, or in one
/// of the folders in `allowed`, or is one of them itself. Links are followed, so that none leads out. One that
/// is not there harms nobody.
///
/// A plan comes from anywhere, and may name any picture on the disk.
pub fn is_allowed(picture: &Path, folder: Option<&Path>, allowed: &[PathBuf]) -> bool {
    let Ok(picture) = picture.canonicalize() else { return true };
    // No folder at all is the one the program works in.
    let here = |path: &Path| if path.as_os_str().is_empty() { PathBuf::from(".") } else { path.to_owned() };
    let folders = folder.map(here).into_iter().chain(allowed.iter().map(|path| here(path)));
    folders.filter_map(|path| path.canonicalize().ok()).any(|path| picture.starts_with(path))
}

/// Why a picture that is not allowed is not read.
pub fn is_outside() -> PictureError {
    PictureError::new("lies outside the plan's folder", "show it only if you know the plan")
}

/// The same picture as seen from another folder: for a plan that is saved there.
pub fn relocated(backdrop: &Backdrop, from: Option<&Path>, to: &Path) -> Backdrop {
    let path = relative_path(&resolved_path(&backdrop.path, from), Some(to));
    Backdrop { path, ..backdrop.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn paths_follow_the_plan() {
        let backdrop = Backdrop::new("scans/ground.png", "");
        let moved = |from: Option<&str>, to: &str| relocated(&backdrop, from.map(Path::new), Path::new(to)).path;
        assert_eq!(moved(Some("/a/b"), "/a/b"), "scans/ground.png");
        assert_eq!(moved(Some("/a/b"), "/a"), "b/scans/ground.png");
        assert_eq!(moved(Some("/a/b"), "/a/c"), "../b/scans/ground.png");
        assert_eq!(relative_path(Path::new("/x/y.png"), None), "/x/y.png");
        let untitled = Backdrop::new("/a/scan.png", "");
        assert_eq!(relocated(&untitled, None, Path::new("/a")).path, "scan.png");
        assert_eq!(resolved_path("/x/y.png", Some(Path::new("/a"))), Path::new("/x/y.png"));
    }
}
