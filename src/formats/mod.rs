//! Reading and writing plans in files. A format is one file here and two lines in this one: its module,
//! and its entry in [`FORMATS`]. Everything else follows from that list: the filters of dialogs,
//! `--help`, error texts and `docs/formats.md`.
//!
//! A reader never guesses silently: whatever it repairs or skips becomes a [`Note`] with its place.

pub mod authors_xml;
pub mod building_name;
pub mod dxf;
mod files;
pub mod geojson;
mod json_text;
pub mod kth_xml;
pub mod manual;
mod notes;
pub mod options;
pub mod plan_json;
mod point_openings;
pub mod registry;
mod room_schedule;
pub mod sheets;
mod text;
mod xml;

pub use files::{
    DiskFolder, FILE_LIMIT_BYTES, HEAD_BYTES, Reading, dialog_endings, file_stem, find_format, folder_format,
    foreign_kind, importer_named, is_plan_file_name, known_formats, read_bytes, read_file, read_from, stem,
};
pub use notes::{FileError, Note, NoteKind, Place, ReadError};
pub use options::{FormatOption, OptionError, Options};
pub use registry::{
    Export, Exporter, Files, Format, Head, Holds, Import, Importer, Lost, NamedBytes, NamedPlan, Preview, Recognition,
    Refused, Source,
};

/// Every known format, in the order of menus and help.
pub const FORMATS: &[&Format] = &[
    &plan_json::FORMAT,
    &authors_xml::FORMAT,
    &kth_xml::FORMAT,
    &geojson::FORMAT,
    &sheets::PDF,
    &sheets::SVG,
    &sheets::PNG,
    &dxf::FORMAT,
    &room_schedule::FORMAT,
];
