use std::path::{Path, PathBuf};

use etcetera::BaseStrategy as _;

use crate::labels::Schemes;

/// The extension of label schemes.
pub const SCHEME_ENDING: &str = ".scheme.toml";

/// The maximum size: a scheme has a few kilobytes, so anything larger is another kind of file.
const LARGEST_BYTES: u64 = 1 << 24;

/// The environment variable for another folder of the user's label schemes.
pub const SCHEMES_VARIABLE: &str = "ENFILADE_SCHEMES";

/// Why a label scheme's file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SchemeFileError {
    pub path: PathBuf,
    pub what: String,
}

impl std::fmt::Display for SchemeFileError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.what)
    }
}

impl std::error::Error for SchemeFileError {}

/// The folder of the user's own label schemes; `None` if the system has no home folder.
pub fn schemes_folder() -> Option<PathBuf> {
    match std::env::var_os(SCHEMES_VARIABLE) {
        Some(folder) => Some(folder.into()),
        None => Some(etcetera::choose_base_strategy().ok()?.data_dir().join("enfilade").join("schemes")),
    }
}

/// Schemes extended by a file.
///
/// # Errors
/// When the file cannot be read, is too large, or is not a label scheme.
pub fn with_scheme_file(schemes: Schemes, path: &Path) -> Result<Schemes, SchemeFileError> {
    let fail = |what: String| SchemeFileError { path: path.to_owned(), what };
    let size = std::fs::metadata(path).map_err(|error| fail(error.to_string()))?.len();
    if size > LARGEST_BYTES {
        return Err(fail(format!("{} MB are more than any label scheme has; is it another file?", size / 1_000_000)));
    }
    let text = std::fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
    schemes.extended_by(&text).map_err(|error| fail(error.to_string()))
}

/// The bundled label schemes, extended by those in a folder in order of their names; and the errors of
/// files that cannot be used. A folder that does not exist adds none.
pub fn schemes_in(folder: &Path) -> (Schemes, Vec<SchemeFileError>) {
    let entries = std::fs::read_dir(folder).map(|entries| entries.flatten().map(|entry| entry.path()).collect());
    let mut files: Vec<PathBuf> = entries.unwrap_or_default();
    files.retain(|path| path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(SCHEME_ENDING)));
    files.sort();
    let mut errors = Vec::new();
    let mut schemes = Schemes::bundled();
    for file in files {
        match with_scheme_file(schemes.clone(), &file) {
            Ok(extended) => schemes = extended,
            Err(error) => errors.push(error),
        }
    }
    (schemes, errors)
}
