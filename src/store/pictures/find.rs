//! Looking for a picture that is not at its plan's path.

use std::path::{Path, PathBuf};

use walkdir::WalkDir;

use super::{content_hash, is_picture_name, read_picture_bytes};
use crate::plan::Backdrop;

/// How deep to search below the plan's folder.
const DEEPEST: usize = 4;

/// The most files to examine.
const MOST_FILES: usize = 5000;

/// The most bytes to hash: a second or two.
const MOST_HASHED_BYTES: u64 = 1 << 30;

/// A picture that may be the missing one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    pub path: PathBuf,
    /// Whether its content is the same; otherwise only its name is.
    pub is_same: bool,
}

/// Looks for a missing picture in the plan's folder and below: first for a file with the same content,
/// whatever its place and name; then for one with the same name.
pub fn find_picture(backdrop: &Backdrop, folder: &Path) -> Option<Found> {
    let name = Path::new(&backdrop.path).file_name()?.to_string_lossy().to_lowercase();
    let has_name = |path: &Path| path.file_name().is_some_and(|own| own.to_string_lossy().to_lowercase() == name);
    let entries = WalkDir::new(folder).max_depth(DEEPEST).sort_by_file_name().into_iter().filter_map(Result::ok);
    let files = entries.take(MOST_FILES).filter(|entry| entry.file_type().is_file());
    let mut pictures: Vec<(PathBuf, u64)> = files
        .filter(|entry| is_picture_name(entry.path()) || has_name(entry.path()))
        .map(|entry| (entry.path().to_owned(), entry.metadata().map_or(u64::MAX, |meta| meta.len())))
        .collect();
    // The same name first, then whatever is nearest to the plan.
    pictures.sort_by_key(|(path, _)| (!has_name(path), path.components().count()));
    let mut left_bytes = MOST_HASHED_BYTES;
    for (path, bytes) in pictures.iter().filter(|_| !backdrop.content_hash.is_empty()) {
        let Some(rest) = left_bytes.checked_sub(*bytes) else { continue };
        left_bytes = rest;
        if read_picture_bytes(path).is_ok_and(|bytes| content_hash(&bytes) == backdrop.content_hash) {
            return Some(Found { path: path.clone(), is_same: true });
        }
    }
    let named = pictures.into_iter().find(|(path, _)| has_name(path));
    named.map(|(path, _)| Found { path, is_same: false })
}
