//! Loading a plan's backdrop in the background.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::plan::Backdrop;
use crate::store::pictures::{self, Found, LoadedPicture, PictureError};

/// The picture to load for a plan.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// The file, at the path stated by the plan.
    pub path: PathBuf,
    pub page: u32,
    /// Like [`Backdrop::content_hash`].
    pub content_hash: String,
}

impl Wanted {
    pub(crate) fn of(backdrop: &Backdrop, folder: Option<&Path>) -> Self {
        Self {
            path: pictures::resolved_path(&backdrop.path, folder),
            page: backdrop.page,
            content_hash: backdrop.content_hash.clone(),
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
}

/// Reads the picture; where it is not, looks for it in the plan's folder.
pub(crate) fn read(wanted: &Wanted, backdrop: &Backdrop, folder: Option<&Path>) -> Read {
    let error = match pictures::load_picture(&wanted.path, wanted.page) {
        Ok(picture) => return Read::Shown { picture: Arc::new(picture), found_at: None },
        Err(error) => error,
    };
    if wanted.path.exists() {
        return Read::Missing { error, candidate: None };
    }
    match folder.and_then(|folder| pictures::find_picture(backdrop, folder)) {
        Some(Found { path, is_same: true }) => match pictures::load_picture(&path, wanted.page) {
            Ok(picture) => Read::Shown { picture: Arc::new(picture), found_at: Some(path) },
            Err(error) => Read::Missing { error, candidate: None },
        },
        Some(Found { path, is_same: false }) => Read::Missing { error, candidate: Some(path) },
        None => Read::Missing { error, candidate: None },
    }
}
