//! GeoJSON in metres: a FeatureCollection of rooms, openings and walls. `docs/geojson.md` describes
//! the properties for outsiders.

mod coordinates;
mod crs;
mod disk;
mod edges;
mod item;
mod properties;
mod read;
mod shapes;
mod units;
mod words;
mod write;

use super::options::Switch;
use super::{
    Export, Exporter, Format, FormatOption, Head, Import, Importer, Lost, NamedBytes, NamedPlan, Options, Preview,
    ReadError, Recognition, Refused, Source,
};
use crate::labels::Schemes;
use crate::plan::Plan;

/// GeoJSON in metres.
pub const FORMAT: Format = Format {
    id: "geojson",
    name: "GeoJSON",
    endings: &["geojson"],
    about: "Rooms, openings and walls as features in metres, for GIS and scripts (docs/geojson.md)",
    importer: Some(&GeoJson),
    exporter: Some(&GeoJson),
};

/// For files whose sizes look like degrees, or which GIS programs marked as longitude and latitude.
static METRES: Switch = Switch {
    name: "metres",
    default: false,
    help: "Take a file as metres, whatever its sizes suggest and its coordinate reference system says",
};

static ROOMS_ONLY: Switch =
    Switch { name: "rooms-only", default: false, help: "Leave out walls and openings, for a map of areas" };

struct GeoJson;

impl Importer for GeoJson {
    fn options(&self) -> &'static [FormatOption] {
        const { &[FormatOption::Switch(&METRES)] }
    }

    fn recognises(&self, head: &Head<'_>) -> Recognition {
        let Head::File { start, .. } = head else { return Recognition::No };
        let start = String::from_utf8_lossy(start);
        let is_object = start.trim_start_matches('\u{feff}').trim_start().starts_with('{');
        match is_object && start.contains("\"FeatureCollection\"") {
            true => Recognition::Yes,
            false if head.ends_with(FORMAT.endings) => Recognition::Perhaps,
            false => Recognition::No,
        }
    }

    fn preview(&self, source: &Source<'_>, _options: &Options) -> Result<Preview, ReadError> {
        read::preview(source.bytes()?)
    }

    fn read(&self, source: &Source<'_>, options: &Options) -> Result<Import, ReadError> {
        read::read(source.bytes()?, source.stem(), options.switch(&METRES))
    }
}

impl Exporter for GeoJson {
    fn options(&self) -> &'static [FormatOption] {
        const { &[FormatOption::Switch(&ROOMS_ONLY)] }
    }

    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, options: &Options) -> Result<Export, Refused> {
        let rooms_only = options.switch(&ROOMS_ONLY);
        let mut export = Export::default();
        for NamedPlan { stem, plan } in plans {
            let bytes = write::write(plan, schemes, rooms_only);
            export.files.push(NamedBytes { name: format!("{stem}.geojson"), bytes });
            let lost = write::lost(plan, rooms_only).into_iter();
            export.lost.extend(lost.map(|what| Lost { stem: (*stem).to_owned(), what }));
        }
        Ok(export)
    }
}

/// Reads a file's bytes; `stem` is the name for a plan without one.
///
/// # Errors
/// When the bytes are not a FeatureCollection in metres, or not a valid plan.
pub fn from_bytes(bytes: &[u8], stem: &str) -> Result<Import, ReadError> {
    read::read(bytes, stem, false)
}

/// The complete bytes of a plan's file; labels implied by functions come from `schemes`.
pub fn to_bytes(plan: &Plan, schemes: &Schemes) -> Vec<u8> {
    write::write(plan, schemes, false)
}

/// The field of an element's or plan's [`crate::plan::Extra`] that keeps GeoJSON properties with no place
/// in Enfilade, so that they are written again.
const KEPT: &str = "geojson";
