//! Reading plan files and folders from disk, in any known format.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::options::{FormatOption, OptionError, Options};
use super::registry::{self, Ambiguous, Files, Format, Found, Head, Import, Preview, Source, ending_of};
use super::{FORMATS, FileError, Place, ReadError};

/// How much of a file's beginning is used to detect its format.
pub const HEAD_BYTES: usize = 4096;

/// The largest file that is read: the largest real plan seen has half a megabyte.
pub const FILE_LIMIT_BYTES: u64 = 256 << 20;

/// Reads a plan file, or a folder that is a plan, of any known format.
///
/// # Errors
/// When it cannot be opened, is larger than [`FILE_LIMIT_BYTES`], is of no known format, or its format's
/// reader refuses it.
pub fn read_file(path: &Path) -> Result<Import, FileError> {
    Reading::default().file(path)
}

/// Reads a plan of any known format from a file's bytes.
///
/// # Errors
/// When they are of no known format, or its format's reader refuses them.
pub fn read_from(path: &Path, bytes: &[u8]) -> Result<Import, FileError> {
    Reading::default().bytes(path, bytes)
}

/// How the user wants files to be read; by default the format is detected, without options.
#[derive(Clone, Default)]
pub struct Reading {
    /// The format to use, whatever the files look like.
    pub from: Option<Found<'static>>,
    /// Options as `NAME=VALUE`; each goes to the formats that have it.
    pub options: Vec<String>,
}

impl Reading {
    /// Checks that the options exist, and have valid values, in each format that may be read.
    ///
    /// # Errors
    /// When one is not valid.
    pub fn check(&self) -> Result<(), OptionError> {
        let found: Vec<Found<'static>> = match self.from {
            Some(found) => vec![found],
            None => FORMATS.iter().filter_map(|format| Some((*format, format.importer?))).collect(),
        };
        let known: Vec<FormatOption> = found.iter().flat_map(|(_, importer)| importer.options()).copied().collect();
        Options::check_names(&known, &self.options)?;
        found.iter().try_for_each(|(_, importer)| Options::parse(importer.options(), &self.options).map(drop))
    }

    /// Reads a file, or a folder that is a plan.
    ///
    /// # Errors
    /// As [`read_file`].
    pub fn file(&self, path: &Path) -> Result<Import, FileError> {
        self.open(path, |(_, importer), source, options| importer.read(source, options))
    }

    /// The contents of a file, or of a folder that is a plan, and its format.
    ///
    /// # Errors
    /// As [`read_file`].
    pub fn preview(&self, path: &Path) -> Result<(&'static Format, Preview), FileError> {
        self.open(path, |(format, importer), source, options| Ok((format, importer.preview(source, options)?)))
    }

    /// Reads a file's bytes.
    ///
    /// # Errors
    /// As [`read_from`].
    pub fn bytes(&self, path: &Path, bytes: &[u8]) -> Result<Import, FileError> {
        self.of_bytes(path, bytes, |(_, importer), source, options| importer.read(source, options))
    }

    fn open<T>(
        &self,
        path: &Path,
        take: impl FnOnce(Found<'static>, &Source<'_>, &Options) -> Result<T, ReadError>,
    ) -> Result<T, FileError> {
        if !path.is_dir() {
            return self.of_bytes(path, &read_bytes(path)?, take);
        }
        let folder = DiskFolder::open(path)?;
        let found = self.from.or_else(|| folder_format(path));
        let found = found.ok_or_else(|| fail_file(path, "is a folder, and no plan by itself", "name a file in it"))?;
        let stem = file_name(path);
        self.take(path, found, &Source::Folder { stem: &stem, files: &folder }, take)
    }

    fn of_bytes<T>(
        &self,
        path: &Path,
        bytes: &[u8],
        take: impl FnOnce(Found<'static>, &Source<'_>, &Options) -> Result<T, ReadError>,
    ) -> Result<T, FileError> {
        let found = self.from.map_or_else(|| find_format(path, bytes), Ok)?;
        let file_name = file_name(path);
        self.take(path, found, &Source::File { stem: stem(&file_name, found.0), bytes }, take)
    }

    fn take<T>(
        &self,
        path: &Path,
        found: Found<'static>,
        source: &Source<'_>,
        take: impl FnOnce(Found<'static>, &Source<'_>, &Options) -> Result<T, ReadError>,
    ) -> Result<T, FileError> {
        let options = Options::parse(found.1.options(), &self.options)
            .map_err(|error| fail_file(path, error.to_string(), "correct the option"))?;
        take(found, source, &options).map_err(|error| FileError { path: path.to_owned(), error })
    }
}

/// Detects the format of a file: by its beginning, or by its name if that is not enough.
///
/// # Errors
/// When no known format matches, or several do.
pub fn find_format(path: &Path, bytes: &[u8]) -> Result<Found<'static>, FileError> {
    let file_name = file_name(path);
    let head = Head::File { name: &file_name, start: &bytes[..bytes.len().min(HEAD_BYTES)] };
    match registry::find(FORMATS, &head) {
        Ok(Some(found)) => Ok(found),
        Ok(None) => {
            let what = registry::foreign_kind(FORMATS, &head)
                .map_or_else(|| "is of no known plan format".to_owned(), |kind| format!("is no plan but {kind}"));
            Err(fail_file(path, what, &known_formats()))
        }
        Err(Ambiguous(ids)) => {
            let hint = format!("import it with 'enfilade import --from {}'", ids.first().unwrap_or(&""));
            Err(fail_file(path, format!("may be of the format {}", ids.join(" or ")), &hint))
        }
    }
}

/// The readable format with this [`Format::id`].
pub fn importer_named(id: &str) -> Option<Found<'static>> {
    let format = FORMATS.iter().find(|format| format.id == id)?;
    Some((format, format.importer?))
}

/// The readable formats, for hints: 'known are Enfilade plan (.plan.json), GeoJSON (.geojson)'.
pub fn known_formats() -> String {
    let readable = FORMATS.iter().filter(|format| format.importer.is_some());
    let known: Vec<String> = readable
        .map(|format| match format.endings.first() {
            Some(ending) => format!("{} (.{ending})", format.name),
            None => format!("{} (a folder)", format.name),
        })
        .collect();
    format!("known are {}", known.join(", "))
}

/// The extensions of all readable files, for a dialog's filter; `plan.json` is followed by `json`, since
/// some systems look only at the last part.
pub fn dialog_endings() -> Vec<&'static str> {
    let mut endings = Vec::new();
    for ending in FORMATS.iter().filter(|format| format.importer.is_some()).flat_map(|format| format.endings) {
        let last = ending.rsplit_once('.').map(|(_, last)| last);
        for ending in std::iter::once(*ending).chain(last) {
            if !endings.contains(&ending) {
                endings.push(ending);
            }
        }
    }
    endings
}

/// What kind of other file this is, if no format recognises it and one is certain that it is not a plan
/// although its name ends like one, see [`registry::Recognition::Foreign`].
pub fn foreign_kind(path: &Path, bytes: &[u8]) -> Option<String> {
    let file_name = file_name(path);
    let head = Head::File { name: &file_name, start: &bytes[..bytes.len().min(HEAD_BYTES)] };
    registry::foreign_kind(FORMATS, &head)
}

/// The format of a folder that is itself a plan; `None` for a folder of plans.
pub fn folder_format(path: &Path) -> Option<Found<'static>> {
    let folder = DiskFolder::open(path).ok()?;
    // If two formats claim the same folder, that is reported when it is read.
    registry::find(FORMATS, &Head::Folder { files: folder.names() }).ok()?
}

/// A folder on disk, without its subfolders.
pub struct DiskFolder {
    path: PathBuf,
    names: Vec<String>,
}

/// The most files to list in a folder: no format has so many.
const FILES_LIMIT: usize = 100_000;

impl DiskFolder {
    /// Lists a folder.
    ///
    /// # Errors
    /// When it cannot be listed.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let entries = std::fs::read_dir(path).map_err(|error| fail_file(path, error.to_string(), "check the path"))?;
        let files = entries.take(FILES_LIMIT).flatten().filter(|entry| entry.path().is_file());
        let mut names: Vec<String> = files.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.sort();
        Ok(Self { path: path.to_owned(), names })
    }
}

impl Files for DiskFolder {
    fn names(&self) -> &[String] {
        &self.names
    }

    fn read(&self, name: &str) -> Result<Vec<u8>, ReadError> {
        let error = |what: String, hint: &str| ReadError {
            place: Place { line: None, element: name.to_owned() },
            what,
            hint: hint.to_owned(),
        };
        // Only listed files: a name inside a file cannot lead out of the folder.
        if self.names.binary_search_by(|listed| listed.as_str().cmp(name)).is_err() {
            return Err(error("is not in the folder".to_owned(), "restore it from a copy"));
        }
        read_bytes(&self.path.join(name)).map_err(|file| error(file.error.what, &file.error.hint))
    }
}

/// The bytes of a file, unless it is too large.
///
/// # Errors
/// When the file cannot be opened, or is larger than [`FILE_LIMIT_BYTES`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let fail = |what: String| fail_file(path, what, "check the path");
    let file = std::fs::File::open(path).map_err(|error| fail(error.to_string()))?;
    let mut bytes = Vec::new();
    // A pipe has no known size, and a file may grow while it is read.
    file.take(FILE_LIMIT_BYTES + 1).read_to_end(&mut bytes).map_err(|error| fail(error.to_string()))?;
    if bytes.len() as u64 > FILE_LIMIT_BYTES {
        let what = format!("is larger than the limit of {} MB", FILE_LIMIT_BYTES >> 20);
        return Err(fail_file(path, what, "split it into storeys"));
    }
    Ok(bytes)
}

fn fail_file(path: &Path, what: impl Into<String>, hint: &str) -> FileError {
    let error = ReadError { place: Place::default(), what: what.into(), hint: hint.to_owned() };
    FileError { path: path.to_owned(), error }
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Whether a file's name ends like that of a readable format: these are imported from a folder.
pub fn is_plan_file_name(file_name: &str) -> bool {
    FORMATS.iter().any(|format| format.importer.is_some() && ending_of(file_name, format.endings).is_some())
}

/// A file's name without this format's extension; the whole name if it has another.
pub fn stem<'a>(file_name: &'a str, format: &Format) -> &'a str {
    match ending_of(file_name, format.endings) {
        Some(ending) => &file_name[..file_name.len() - ending.len() - 1],
        None => file_name,
    }
}

/// A file's name without the extension of a known format; the whole name if it has none.
pub fn file_stem(file_name: &str) -> &str {
    FORMATS
        .iter()
        .find(|format| ending_of(file_name, format.endings).is_some())
        .map_or(file_name, |format| stem(file_name, format))
}
