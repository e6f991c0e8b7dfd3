//! The contract of a file format: how it is recognised, previewed, read and written, and its options.
//! [`super::FORMATS`] lists all formats; dialogs, help, errors and the manual are built from that list.

use std::collections::BTreeMap;

use super::options::{FormatOption, Options};
use super::{Note, Place, ReadError};
use crate::draw::paper::Laid;
use crate::geometry::Bounds;
use crate::labels::Schemes;
use crate::plan::Plan;

/// A file format for plans.
pub struct Format {
    /// Its name on the command line: `geojson`.
    pub id: &'static str,
    /// Its name for people: 'Enfilade plan'.
    pub name: &'static str,
    /// The extensions of its files without the leading dot, the one for new files first: `plan.json`.
    /// Empty if the format is a folder.
    pub endings: &'static [&'static str],
    /// A sentence about its purpose.
    pub about: &'static str,
    /// `None` if the format can only be written.
    pub importer: Option<&'static dyn Importer>,
    /// `None` if the format can only be read.
    pub exporter: Option<&'static dyn Exporter>,
}

/// Reads a format.
pub trait Importer: Sync {
    /// The options for reading.
    fn options(&self) -> &'static [FormatOption] {
        &[]
    }

    /// Whether a file or folder is of this format, judging by its name and beginning.
    fn recognises(&self, head: &Head<'_>) -> Recognition;

    /// A summary of the contents, without building plans if the format allows.
    ///
    /// # Errors
    /// When nothing usable can be read.
    fn preview(&self, source: &Source<'_>, options: &Options) -> Result<Preview, ReadError> {
        Ok(Preview::of(&self.read(source, options)?))
    }

    /// Reads everything.
    ///
    /// # Errors
    /// When nothing usable can be read; what can be repaired or skipped becomes a note instead.
    fn read(&self, source: &Source<'_>, options: &Options) -> Result<Import, ReadError>;
}

/// Writes a format.
pub trait Exporter: Sync {
    /// The options for writing.
    fn options(&self) -> &'static [FormatOption] {
        &[]
    }

    /// How many plans a file of the format holds.
    fn holds(&self) -> Holds {
        Holds::OnePlan
    }

    /// The sheet of paper that would be written for a plan, to look at before; `None` if the format has no
    /// sheets.
    fn sheet(&self, _plan: &Plan, _schemes: &Schemes, _options: &Options) -> Option<Result<Laid, Refused>> {
        None
    }

    /// Writes plans: one at a time if the format [`Holds::OnePlan`], else all at once. Files are named
    /// after a plan's `stem`.
    ///
    /// # Errors
    /// When the options do not suit a plan, such as a sheet too small for its scale.
    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, options: &Options) -> Result<Export, Refused>;
}

/// Why a plan is not written: what is wrong, and what to do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(pub String);

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refused {}

/// How many plans a file of a format holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// One: several plans become several files.
    OnePlan,
    /// Any number: one file, or one folder of files, for all.
    ManyPlans,
}

/// What a format is recognised by.
#[derive(Clone, Copy, Debug)]
pub enum Head<'a> {
    /// A file's name and up to [`super::HEAD_BYTES`] of its beginning.
    File { name: &'a str, start: &'a [u8] },
    /// The names of a folder's files, sorted.
    Folder { files: &'a [String] },
}

impl Head<'_> {
    /// Whether it is a file whose name has one of these endings.
    pub fn ends_with(&self, endings: &[&'static str]) -> bool {
        matches!(self, Head::File { name, .. } if ending_of(name, endings).is_some())
    }
}

/// Whether a file or folder is of a format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Recognition {
    /// It is not.
    No,
    /// It is not, although its name suggests it; the text says what it is: 'XML with the root `<svg>`'.
    /// Skipped when importing a folder.
    Foreign(String),
    /// Possibly, but not certainly: only the name fits, or it is damaged.
    Perhaps,
    /// It is; if it cannot be read, it is broken.
    Yes,
}

/// The source an importer reads from.
#[derive(Clone, Copy)]
pub enum Source<'a> {
    /// A file: its name without the extension, for plans without a name, and all its bytes.
    File { stem: &'a str, bytes: &'a [u8] },
    /// A folder: its name, and its files.
    Folder { stem: &'a str, files: &'a dyn Files },
}

impl<'a> Source<'a> {
    /// The name for a plan that has none.
    pub fn stem(&self) -> &'a str {
        match self {
            Self::File { stem, .. } | Self::Folder { stem, .. } => stem,
        }
    }

    /// A file's bytes.
    ///
    /// # Errors
    /// When it is a folder.
    pub fn bytes(&self) -> Result<&'a [u8], ReadError> {
        match self {
            Self::File { bytes, .. } => Ok(bytes),
            Self::Folder { .. } => Err(ReadError {
                place: Place::default(),
                what: "is a folder".to_owned(),
                hint: "name one of its files".to_owned(),
            }),
        }
    }
}

/// The files of a folder, wherever they are stored.
pub trait Files {
    /// Their names, sorted.
    fn names(&self) -> &[String];

    /// The bytes of one.
    ///
    /// # Errors
    /// When it does not exist, cannot be read, or is too large.
    fn read(&self, name: &str) -> Result<Vec<u8>, ReadError>;
}

/// The result of an import.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// One plan per storey; at least one.
    pub plans: Vec<Plan>,
    /// What was repaired or skipped, in file order.
    pub notes: Vec<Note>,
}

/// A summary of a file's contents, before it is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// How many plans it holds.
    pub plans: usize,
    pub rooms: usize,
    pub openings: usize,
    pub walls: usize,
    /// Its parts under the format's own names (layers, kinds), with the number of things in each.
    pub layers: BTreeMap<String, usize>,
    /// The unit of its lengths, if the file states it.
    pub units: Option<String>,
    /// Width and height over everything drawn, in those units, or in metres after reading.
    pub size: Option<(f64, f64)>,
}

impl Preview {
    /// The preview of what has been read.
    pub fn of(import: &Import) -> Self {
        let mut preview = Self { plans: import.plans.len(), units: Some("m".to_owned()), ..Self::default() };
        let mut bounds = Bounds::EMPTY;
        for plan in &import.plans {
            preview.rooms += plan.rooms().len();
            preview.openings += plan.openings().len();
            preview.walls += plan.walls().len();
            bounds = plan.corners().fold(bounds, |bounds, (_, corner)| bounds.with(corner.position));
        }
        preview.size = (!bounds.is_empty()).then(|| (bounds.width(), bounds.height()));
        preview
    }
}

/// A plan to be written, and the stem for its files.
#[derive(Clone, Copy, Debug)]
pub struct NamedPlan<'a> {
    pub stem: &'a str,
    pub plan: &'a Plan,
}

/// A file to be written, named relative to the export's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedBytes {
    pub name: String,
    pub bytes: Vec<u8>,
}

/// The result of an export.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Export {
    pub files: Vec<NamedBytes>,
    /// What the format cannot keep, one entry for each kind of thing.
    pub lost: Vec<Lost>,
}

/// Something that a format cannot keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lost {
    /// The plan it belongs to, by its stem.
    pub stem: String,
    /// In a few words: 'the picture that was traced', '3 guides'.
    pub what: String,
}

/// Several formats match equally well.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ambiguous(pub Vec<&'static str>);

/// The importer for a file or folder: among formats that are certain or, failing that, possible, those
/// whose extension fits come first.
///
/// # Errors
/// When several formats are equally likely: their ids.
pub fn find<'f>(formats: &[&'f Format], head: &Head<'_>) -> Result<Option<Found<'f>>, Ambiguous> {
    let mut likely: [Vec<Found<'f>>; 4] = Default::default();
    for format in formats {
        let Some(importer) = format.importer else { continue };
        let rank = match (importer.recognises(head), head.ends_with(format.endings)) {
            (Recognition::No | Recognition::Foreign(_), _) => continue,
            (Recognition::Yes, true) => 0,
            (Recognition::Yes, false) => 1,
            (Recognition::Perhaps, true) => 2,
            (Recognition::Perhaps, false) => 3,
        };
        likely[rank].push((format, importer));
    }
    match likely.iter().find(|candidates| !candidates.is_empty()).map(Vec::as_slice) {
        None => Ok(None),
        Some([only]) => Ok(Some(*only)),
        Some(several) => Err(Ambiguous(several.iter().map(|(format, _)| format.id).collect())),
    }
}

/// A format that can be read, and its reader.
pub type Found<'f> = (&'f Format, &'f dyn Importer);

/// What this is instead, if no format recognises it and one says that it is certainly something else, see
/// [`Recognition::Foreign`].
pub fn foreign_kind(formats: &[&Format], head: &Head<'_>) -> Option<String> {
    let mut foreign = None;
    for importer in formats.iter().filter_map(|format| format.importer) {
        match importer.recognises(head) {
            Recognition::No => {}
            Recognition::Foreign(kind) => foreign = foreign.or(Some(kind)),
            Recognition::Perhaps | Recognition::Yes => return None,
        }
    }
    foreign
}

/// Which of a format's extensions a file's name has, ignoring case.
pub fn ending_of(file_name: &str, endings: &[&'static str]) -> Option<&'static str> {
    let lower = file_name.to_lowercase();
    endings.iter().copied().find(|ending| lower.strip_suffix(ending).is_some_and(|rest| rest.ends_with('.')))
}
