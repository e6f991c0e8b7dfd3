//! What several subcommands take: label schemes, words, and where to write.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::{CliError, Terminal};
use crate::formats;
use crate::labels::Schemes;
use crate::store::{schemes_folder, schemes_in, with_scheme_file};

/// The bundled label schemes, extended by those in the user's folder and then by the files named.
///
/// # Errors
/// When one of the files cannot be read or is not a label scheme.
pub fn schemes(files: &[PathBuf]) -> Result<Schemes, CliError> {
    let (own, errors) = schemes_folder().map_or_else(|| (Schemes::bundled(), Vec::new()), |own| schemes_in(&own));
    if let Some(error) = errors.into_iter().next() {
        return Err(error.into());
    }
    Ok(files.iter().try_fold(own, |schemes, file| with_scheme_file(schemes, file))?)
}

/// Parses one of `all` by its name.
///
/// # Errors
/// When there is no such name; the sentence lists those there are.
pub fn one_of<T: Copy>(word: &str, all: &[T], name: fn(T) -> &'static str) -> Result<T, String> {
    all.iter().copied().find(|&it| name(it) == word).ok_or_else(|| {
        let words: Vec<&str> = all.iter().map(|&it| name(it)).collect();
        format!("use one of {}", words.join(", "))
    })
}

/// Writes to a file by way of [`crate::store::save_bytes`], or to stdout where there is none.
///
/// # Errors
/// When it cannot be written.
pub fn write_result(output: Option<&Path>, bytes: &[u8], terminal: &mut Terminal) -> Result<(), CliError> {
    match output {
        Some(path) => Ok(crate::store::save_bytes(path, bytes)?),
        None => Ok(terminal.out.write_all(bytes)?),
    }
}

/// The exported file's name: the source's up to its first known ending; later storeys of one file
/// are numbered from 2.
pub fn target_name(file: &Path, storey: usize, ending: &str) -> String {
    format!("{}.{ending}", target_stem(file, storey))
}

/// The exported file's name without its ending.
pub fn target_stem(file: &Path, storey: usize) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let stem = formats::file_stem(&name);
    if storey == 0 { stem.to_owned() } else { format!("{stem}-{}", storey + 1) }
}
