//! What several subcommands take: label schemes, words, and what to read.

use std::path::{Path, PathBuf};

use super::CliError;
use crate::base::file_name::component;
use crate::formats;
use crate::labels::Schemes;
use crate::store::{SCHEME_ENDING, schemes_folder, schemes_in, with_scheme_file};

/// The bundled label schemes, extended by those in the user's folder and then by the files named.
///
/// # Errors
/// When one of the files cannot be read or is not a label scheme.
pub fn schemes(files: &[PathBuf]) -> Result<Schemes, CliError> {
    let (own, errors) = schemes_folder().map_or_else(|| (Schemes::bundled(), Vec::new()), |own| schemes_in(&own));
    if let Some(error) = errors.into_iter().next() {
        return Err(error.into());
    }
    Ok(files.iter().try_fold(own, |schemes, file| with_scheme_file(schemes, &own_scheme(file)))?)
}

/// The file of a scheme that is named by its file, or by the name it has in the user's folder of schemes.
fn own_scheme(named: &Path) -> PathBuf {
    by_name(named, SCHEME_ENDING, schemes_folder()).unwrap_or_else(|| named.to_owned())
}

/// The file that a bare name means in a folder of the user's; `None` where a file of that very path is there, or no
/// file has the name.
pub fn by_name(named: &Path, ending: &str, folder: Option<PathBuf>) -> Option<PathBuf> {
    let name = component(named.to_str()?).ok().filter(|_| !named.exists())?;
    let file = folder?.join(format!("{}{ending}", name.strip_suffix(ending).unwrap_or(name)));
    file.is_file().then_some(file)
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

/// The path to read from: `-` is stdin.
pub fn from_stdin(path: &Path) -> PathBuf {
    if path == Path::new("-") { PathBuf::from("/dev/stdin") } else { path.to_owned() }
}

/// The name of what a file holds, for the files made of it: up to its first known ending.
pub fn stem(file: &Path) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    formats::file_stem(&name).to_owned()
}
