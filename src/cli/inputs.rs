//! Plans named on the command line: files and folders.

use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::{CliError, Terminal};
use crate::formats::{self, Import};
use crate::labels::Schemes;
use crate::store::{schemes_folder, schemes_in, with_scheme_file};

/// The plan files that paths name: a file is itself, a folder all files below it that end like a
/// known format and are not for certain something else, in the order of their paths.
///
/// # Errors
/// When a path does not exist, or a folder holds no plan.
pub fn plan_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            // A file that does not exist is reported when it is read, with the others going on.
            files.push(path.clone());
            continue;
        }
        let before = files.len();
        for entry in walkdir::WalkDir::new(path).follow_links(true).sort_by_file_name() {
            let entry = entry?;
            let is_named_so = formats::is_plan_file_name(&entry.file_name().to_string_lossy());
            if entry.file_type().is_file() && is_named_so && !is_foreign(entry.path()) {
                files.push(entry.into_path());
            }
        }
        if files.len() == before {
            return Err(CliError::new(format!("{}: no plan files in this folder", path.display())));
        }
    }
    Ok(files)
}

/// Whether a file's beginning shows that it is no plan, although its name ends like one. One that
/// cannot be opened is not: reading it says why.
fn is_foreign(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(formats::HEAD_BYTES as u64).read_to_end(&mut head));
    read.is_ok() && formats::foreign_kind(path, &head).is_some()
}

/// Reads each file and hands its plans over, saying on stderr what could not be read. Gives the
/// number of files that failed.
///
/// # Errors
/// What `each` returns, or when stderr cannot be written.
pub fn for_each_plan(
    files: &[PathBuf],
    terminal: &mut Terminal,
    mut each: impl FnMut(&Path, Import, &mut Terminal) -> Result<(), CliError>,
) -> Result<usize, CliError> {
    let mut failed = 0;
    for file in files {
        match formats::read_file(file) {
            Ok(import) => each(file, import, terminal)?,
            Err(error) => {
                failed += 1;
                writeln!(terminal.err, "enfilade: {error}")?;
            }
        }
    }
    Ok(failed)
}

/// The bundled label schemes, extended by those in the user's folder and then by the files named.
///
/// # Errors
/// When one of the files cannot be read or is no label scheme.
pub fn schemes(files: &[PathBuf]) -> Result<Schemes, CliError> {
    let (own, errors) = schemes_folder().map_or_else(|| (Schemes::bundled(), Vec::new()), |own| schemes_in(&own));
    if let Some(error) = errors.into_iter().next() {
        return Err(error.into());
    }
    Ok(files.iter().try_fold(own, |schemes, file| with_scheme_file(schemes, file))?)
}

/// The one of `all` that goes by a word, as an option's value.
///
/// # Errors
/// A sentence that lists the words there are.
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
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let stem = formats::file_stem(&name);
    if storey == 0 { format!("{stem}.{ending}") } else { format!("{stem}-{}.{ending}", storey + 1) }
}
