//! The contract of a file format: how it is recognised, previewed, read and written, and what a person can
//! set. [`super::FORMATS`] lists all; dialogs, help, errors and the manual are written from that list.

use std::collections::BTreeMap;

use super::options::{FormatOption, Options};
use super::{Note, Place, ReadError};
use crate::geometry::Bounds;
use crate::labels::Schemes;
use crate::plan::Plan;

/// A file format for plans.
pub struct Format {
    /// A word for the command line: `geojson`.
    pub id: &'static str,
    /// Its name for people: 'Enfilade plan'.
    pub name: &'static str,
    /// How its files end, without the leading dot, the one for new files first: `plan.json`. Empty for a
    /// format that is a folder.
    pub endings: &'static [&'static str],
    /// A sentence on what it is for.
    pub about: &'static str,
    /// `None` where the format can only be written.
    pub importer: Option<&'static dyn Importer>,
    /// `None` where the format can only be read.
    pub exporter: Option<&'static dyn Exporter>,
}

/// Reads a format.
pub trait Importer: Sync {
    /// What a person can set.
    fn options(&self) -> &'static [FormatOption] {
        &[]
    }

    /// Whether this is of the format, by its name and its beginning.
    fn recognises(&self, head: &Head<'_>) -> Recognition;

    /// What is in it, without building plans where the format tells so much before.
    ///
    /// # Errors
    /// When nothing usable can be read.
    fn preview(&self, source: &Source<'_>, options: &Options) -> Result<Preview, ReadError> {
        Ok(Preview::of(&self.read(source, options)?))
    }

    /// Reads it all.
    ///
    /// # Errors
    /// When nothing usable can be read; what can be mended or left out becomes a note instead.
    fn read(&self, source: &Source<'_>, options: &Options) -> Result<Import, ReadError>;
}

/// Writes a format.
pub trait Exporter: Sync {
    /// What a person can set.
    fn options(&self) -> &'static [FormatOption] {
        &[]
    }

    /// How many plans a file of the format holds.
    fn holds(&self) -> Holds {
        Holds::OnePlan
    }

    /// Writes plans: one at a time where the format [`Holds::OnePlan`], else all. A plan's `stem` is what
    /// its files are to be named after.
    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, options: &Options) -> Export;
}

/// How many plans a file of a format holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// One: several plans become several files.
    OnePlan,
    /// Any number: one file, or one folder of files, for all.
    ManyPlans,
}

/// What tells the format of a file or folder.
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

/// Whether something is of a format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Recognition {
    /// It is not.
    No,
    /// It is not, although its name suggests it, and what it is instead: 'XML with the root <svg>'. The
    /// import of a folder passes it over.
    Foreign(String),
    /// Nothing speaks against it but nothing certain for it either: only the name, or it is damaged.
    Perhaps,
    /// It is; if it cannot be read it is broken.
    Yes,
}

/// Where an importer reads from.
#[derive(Clone, Copy)]
pub enum Source<'a> {
    /// A file: its name without the ending, for plans without a name, and all its bytes.
    File { stem: &'a str, bytes: &'a [u8] },
    /// A folder: its name, and its files.
    Folder { stem: &'a str, files: &'a dyn Files },
}

impl<'a> Source<'a> {
    /// The name to give a plan that has none.
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

/// The files of a folder, wherever they are.
pub trait Files {
    /// Their names, sorted.
    fn names(&self) -> &[String];

    /// The bytes of one.
    ///
    /// # Errors
    /// When there is none of that name, or it cannot be read, or is too large.
    fn read(&self, name: &str) -> Result<Vec<u8>, ReadError>;
}

/// What a source gave.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// One plan a storey; at least one.
    pub plans: Vec<Plan>,
    /// What was mended or left out, in the file's order.
    pub notes: Vec<Note>,
}

/// What is in a file, before it is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// How many plans it holds.
    pub plans: usize,
    pub rooms: usize,
    pub openings: usize,
    pub walls: usize,
    /// Its parts by the format's own names (layers, kinds), with how many things are in each.
    pub layers: BTreeMap<String, usize>,
    /// The unit of its lengths, as the file states it; `None` where it does not.
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

/// A plan to be written, and what to name its files after.
#[derive(Clone, Copy, Debug)]
pub struct NamedPlan<'a> {
    pub stem: &'a str,
    pub plan: &'a Plan,
}

/// A file to be written, by its name within the folder of the export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedBytes {
    pub name: String,
    pub bytes: Vec<u8>,
}

/// What an export gave.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Export {
    pub files: Vec<NamedBytes>,
    /// What the format cannot keep, once for each kind of thing.
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

/// Several formats may be meant, and nothing tells which.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ambiguous(pub Vec<&'static str>);

/// The importer for what starts like this: of the formats that are certain, else of those that may be, the
/// ones whose endings fit first.
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

/// What this is instead, where no format recognises it and one says that it is certainly something else,
/// see [`Recognition::Foreign`].
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

/// Which of a format's endings a file's name has, upper or lower case.
pub fn ending_of(file_name: &str, endings: &[&'static str]) -> Option<&'static str> {
    let lower = file_name.to_lowercase();
    endings.iter().copied().find(|ending| lower.strip_suffix(ending).is_some_and(|rest| rest.ends_with('.')))
}
