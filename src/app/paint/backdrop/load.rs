//! Loading a plan's backdrop in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::base::work::Work;
use crate::plan::{Backdrop, Rectification};
use crate::store::pictures::{self, Found, LoadedPicture, PictureError};

/// The picture to load for a plan.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// The file, at the path stated by the plan.
    pub path: PathBuf,
    pub page: u32,
    /// Like [`Backdrop::content_hash`].
    pub content_hash: String,
    pub rectification: Option<Rectification>,
}

impl Wanted {
    pub(crate) fn of(backdrop: &Backdrop, folder: Option<&Path>) -> Self {
        Self {
            path: pictures::resolved_path(&backdrop.path, folder),
            page: backdrop.page,
            content_hash: backdrop.content_hash.clone(),
            rectification: backdrop.rectification.clone(),
        }
    }
}

/// The outcome of loading it.
pub(crate) enum Read {
    Shown {
        picture: Arc<LoadedPicture>,
        /// Where it was found, if not at the plan's path.
        found_at: Option<PathBuf>,
    },
    Missing {
        error: PictureError,
        /// A file with the same name but different content.
        candidate: Option<PathBuf>,
    },
    /// It lies outside the plan's folder, and nobody has asked for it.
    Outside,
}

/// Reads the picture as long as it is wanted; where it is not, looks for it in the plan's folder. `allowed`: files
/// and folders that may be read though they lie elsewhere.
pub(crate) fn read(
    wanted: &Wanted,
    backdrop: &Backdrop,
    folder: Option<&Path>,
    allowed: &[PathBuf],
    work: &Work<'_>,
) -> Read {
    if !pictures::is_allowed(&wanted.path, folder, allowed) {
        return Read::Outside;
    }
    let load = |path: &Path| pictures::load_backdrop_while(path, wanted.page, wanted.rectification.as_ref(), work);
    let error = match load(&wanted.path) {
        Ok(picture) => return Read::Shown { picture: Arc::new(picture), found_at: None },
        Err(error) => error,
    };
    if wanted.path.exists() {
        return Read::Missing { error, candidate: None };
    }
    match folder.and_then(|folder| pictures::find_picture(backdrop, folder)) {
        Some(Found { path, is_same: true }) => match load(&path) {
            Ok(picture) => Read::Shown { picture: Arc::new(picture), found_at: Some(path) },
            Err(error) => Read::Missing { error, candidate: None },
        },
        Some(Found { path, is_same: false }) => Read::Missing { error, candidate: Some(path) },
        None => Read::Missing { error, candidate: None },
    }
}
