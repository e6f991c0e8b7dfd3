//! Reading and writing plans in files. One file of source per format, one line here to register it.
//!
//! A reader never guesses silently: what it mends or leaves out becomes a [`Note`] with its place.

pub mod authors_xml;
pub mod building_name;
pub mod geojson;
mod json_text;
pub mod plan_json;

use std::fmt;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::labels::Schemes;
use crate::plan::Plan;

/// Every known format, in the order in which they are tried.
pub const FORMATS: &[&dyn Format] = &[&plan_json::PlanJson, &authors_xml::AuthorsXml, &geojson::GeoJson];

/// A file format for plans.
pub trait Format: Sync {
    /// Its name for people ('Enfilade plan').
    fn name(&self) -> &'static str;

    /// How its files end, without the leading dot, longest first (`plan.json`).
    fn extensions(&self) -> &'static [&'static str];

    /// Whether a file that starts with `head` (up to 4 KiB) is probably of this format.
    fn recognises(&self, head: &[u8]) -> bool;

    /// What kind of other file this is ('XML with the root <svg>'), when its head says that it is
    /// certainly no plan although its name ends like one: the import of a folder passes it over.
    fn foreign(&self, _head: &[u8]) -> Option<String> {
        None
    }

    /// Reads a file's bytes. `stem` is the file's name without its ending, for plans without a name.
    ///
    /// # Errors
    /// When nothing usable can be read; what can be mended or left out becomes a note instead.
    fn read(&self, bytes: &[u8], stem: &str) -> Result<Import, ReadError>;

    /// Writes a plan, or `None` where the format can only be read.
    fn write(&self, plan: &Plan, schemes: &Schemes) -> Option<Vec<u8>>;

    /// Whether [`Format::write`] gives anything.
    fn can_write(&self) -> bool {
        self.write(&Plan::default(), &Schemes::default()).is_some()
    }
}

/// What a file gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// One plan a storey; at least one.
    pub plans: Vec<Plan>,
    /// What was mended or left out, in the file's order.
    pub notes: Vec<Note>,
}

/// One thing that a reader mended or left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Note {
    pub kind: NoteKind,
    pub place: Place,
    /// What was found and what was done, in a sentence.
    pub what: String,
}

/// What a reader did.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NoteKind {
    /// The thing is in the plan, mended.
    Healed,
    /// The thing is not in the plan.
    Skipped,
}

/// Where in a file something stands.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Line from 1, where the format has lines.
    pub line: Option<usize>,
    /// The element ('space 3547daca-…'); empty when it is the whole file.
    pub element: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.line, self.element.as_str()) {
            (None, "") => f.write_str("file"),
            (None, element) => f.write_str(element),
            (Some(line), "") => write!(f, "line {line}"),
            (Some(line), element) => write!(f, "line {line}, {element}"),
        }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.kind {
            NoteKind::Healed => "healed",
            NoteKind::Skipped => "skipped",
        };
        write!(f, "{kind}: {}: {}", self.place, self.what)
    }
}

/// Why a file could not be read: what is wrong, where, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadError {
    pub place: Place,
    pub what: String,
    /// What the user can do about it.
    pub hint: String,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.place != Place::default() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.what)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for ReadError {}

/// A [`ReadError`] with the file it belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    pub path: PathBuf,
    pub error: ReadError,
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.error)
    }
}

impl std::error::Error for FileError {}

/// So much of a file's beginning tells its format.
pub const HEAD_BYTES: usize = 4096;

/// The largest file that is read: the largest real plan seen has half a megabyte.
pub const FILE_LIMIT_BYTES: u64 = 256 << 20;

/// Reads a plan file of any known format.
///
/// # Errors
/// When the file cannot be opened, is larger than [`FILE_LIMIT_BYTES`], is of no known format, or its
/// format's reader refuses it.
pub fn read_file(path: &Path) -> Result<Import, FileError> {
    read_from(path, &read_bytes(path)?)
}

/// Reads a plan of any known format from a file's bytes.
///
/// # Errors
/// When they are of no known format, or its format's reader refuses them.
pub fn read_from(path: &Path, bytes: &[u8]) -> Result<Import, FileError> {
    let file_name = file_name(path);
    let format = find_format(&file_name, bytes).ok_or_else(|| {
        fail_file(path, "is of no known plan format", "known are plan.json, the authors' XML, and GeoJSON")
    })?;
    format.read(bytes, stem(&file_name, format)).map_err(|error| FileError { path: path.to_owned(), error })
}

/// What kind of other file this is, when no format recognises it and one is sure that it is no plan
/// although its name ends like one, see [`Format::foreign`].
pub fn foreign_kind(path: &Path, bytes: &[u8]) -> Option<String> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    if FORMATS.iter().any(|format| format.recognises(head)) {
        return None;
    }
    let named = FORMATS.iter().filter(|format| extension_of(&file_name(path), **format).is_some());
    named.filter_map(|format| format.foreign(head)).next()
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// The bytes of a file that is not too large.
///
/// # Errors
/// When the file cannot be opened, or is larger than [`FILE_LIMIT_BYTES`].
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, FileError> {
    let fail = |what: String| fail_file(path, what, "check the path");
    let file = std::fs::File::open(path).map_err(|error| fail(error.to_string()))?;
    let mut bytes = Vec::new();
    // A pipe tells no size, and a file may grow while it is read.
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

/// The format of a file: by its content, then by its name.
pub fn find_format(file_name: &str, bytes: &[u8]) -> Option<&'static dyn Format> {
    let head = &bytes[..bytes.len().min(HEAD_BYTES)];
    let named = |format: &&dyn Format| extension_of(file_name, *format).is_some();
    FORMATS
        .iter()
        .find(|format| named(format) && format.recognises(head))
        .or_else(|| FORMATS.iter().find(|format| format.recognises(head)))
        .or_else(|| FORMATS.iter().find(|format| named(format)))
        .copied()
}

/// Whether a file's name ends like that of a known format: what a folder's import takes.
pub fn is_plan_file_name(file_name: &str) -> bool {
    FORMATS.iter().any(|format| extension_of(file_name, *format).is_some())
}

fn extension_of(file_name: &str, format: &dyn Format) -> Option<&'static str> {
    let lower = file_name.to_lowercase();
    format
        .extensions()
        .iter()
        .copied()
        .find(|extension| lower.strip_suffix(extension).is_some_and(|rest| rest.ends_with('.')))
}

fn stem<'a>(file_name: &'a str, format: &dyn Format) -> &'a str {
    match extension_of(file_name, format) {
        Some(extension) => &file_name[..file_name.len() - extension.len() - 1],
        None => file_name,
    }
}

/// A file's name without the ending of a known format; the whole name where it has none.
pub fn file_stem(file_name: &str) -> &str {
    FORMATS
        .iter()
        .find(|format| extension_of(file_name, **format).is_some())
        .map_or(file_name, |format| stem(file_name, *format))
}
