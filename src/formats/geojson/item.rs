//! A FeatureCollection taken apart: each feature with the line it stands on, what it is made of, and what its
//! properties say.

use super::disk::{DiskCollection, ReadFeature, Words};
use super::properties::Properties;
use super::shapes::Shapes;
use crate::formats::json_text::{id_around, json_fault};
use crate::formats::{Note, NoteKind, Place, ReadError};
use crate::geometry::{COORDINATE_LIMIT_M, Point};

/// What to do about most broken files.
pub(super) const DAMAGED: &str = "correct it by hand (docs/geojson.md describes the properties), or export it again";

/// How the note on a feature ends that is not in the plan.
pub(super) const LEFT_OUT: &str = "; left out";

pub(super) fn note_on_file(kind: NoteKind, what: String) -> Note {
    Note { kind, place: Place::default(), what }
}

/// A file, taken apart.
pub(super) struct Parts<'a> {
    pub collection: DiskCollection<'a>,
    pub items: Vec<Item>,
    /// Features that are none, with the reason.
    pub unreadable: Vec<Note>,
}

/// The file as its parts.
pub(super) fn parts(text: &str) -> Result<Parts<'_>, ReadError> {
    let collection: DiskCollection = serde_json::from_str(text).map_err(|error| refuse_json(text, &error))?;
    let refuse = |what: String, hint: &str| Err(ReadError { place: Place::default(), what, hint: hint.to_owned() });
    match collection.kind.as_ref().map_or("", Words::as_str) {
        "FeatureCollection" => {}
        "" => return refuse("is JSON, but not GeoJSON: it has no type".to_owned(), "open a FeatureCollection"),
        other => return refuse(format!("is GeoJSON of the type '{other}'"), "open a FeatureCollection"),
    }
    let Some(raw_features) = &collection.features else {
        return refuse("has no features".to_owned(), "open a FeatureCollection with rooms");
    };
    let mut items = Vec::with_capacity(raw_features.len());
    let mut unreadable = Vec::new();
    let (mut line, mut counted) = (1, 0);
    for (index, raw) in raw_features.iter().enumerate() {
        let start = raw.get().as_ptr() as usize - text.as_ptr() as usize;
        line += text.as_bytes()[counted..start].iter().filter(|&&byte| byte == b'\n').count();
        counted = start;
        match Item::of(raw.get(), line, index) {
            Ok(item) => items.push(item),
            Err(note) => unreadable.push(note),
        }
    }
    Ok(Parts { collection, items, unreadable })
}

/// A feature and where it stands.
pub(super) struct Item {
    /// From 1.
    line: usize,
    /// From 0.
    index: usize,
    /// Empty where it has none.
    pub id: String,
    /// Of its geometry; empty where it has none.
    pub geometry_kind: String,
    pub shapes: Shapes,
    pub properties: Properties,
}

/// What a feature is in a plan.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Room,
    Opening,
    Wall,
    Other,
}

impl Item {
    /// Reads a feature.
    ///
    /// # Errors
    /// When it is none, in a note on what is left out.
    fn of(raw: &str, line: usize, index: usize) -> Result<Self, Note> {
        let feature: ReadFeature = serde_json::from_str(raw).map_err(|error| {
            let element = id_around(raw, &error, 0)
                .map_or_else(|| format!("feature number {}", index + 1), |id| format!("feature {id}"));
            let place = Place { line: Some(line + error.line().saturating_sub(1)), element };
            Note { kind: NoteKind::Skipped, place, what: format!("{}{LEFT_OUT}", json_fault(raw, &error).what) }
        })?;
        let properties = Properties::of(feature.properties);
        let id = if feature.id.is_empty() { properties.id.clone() } else { feature.id.0 };
        let shapes = Shapes::of(feature.geometry.as_ref());
        let geometry_kind = feature.geometry.map(|geometry| geometry.kind.0).unwrap_or_default();
        let mut item = Self { line, index, id, geometry_kind, shapes: Shapes::default(), properties };
        item.shapes = shapes.map_err(|what| Note {
            kind: NoteKind::Skipped,
            place: item.place(),
            what: format!("{what}{LEFT_OUT}"),
        })?;
        Ok(item)
    }

    pub fn place(&self) -> Place {
        let id = self.id.as_str();
        let element =
            if id.is_empty() { format!("feature number {}", self.index + 1) } else { format!("feature {id}") };
        Place { line: Some(self.line), element }
    }

    /// What the feature says it is; without a word, what its geometry suggests.
    pub fn role(&self) -> Role {
        match self.properties.kind.as_str() {
            "room" => Role::Room,
            "opening" => Role::Opening,
            "wall" => Role::Wall,
            "" if !self.properties.opening.is_empty() => Role::Opening,
            "" if !self.shapes.areas.is_empty() => Role::Room,
            _ => Role::Other,
        }
    }

    /// What its geometry is, in words: 'a LineString', 'a GeometryCollection of 1 point', 'no geometry'.
    pub fn geometry(&self) -> String {
        match (self.geometry_kind.as_str(), self.shapes.words()) {
            ("", _) => "no geometry".to_owned(),
            (kind, words) if words.is_empty() => format!("an empty {kind}"),
            (kind @ "GeometryCollection", words) => format!("a {kind} of {words}"),
            (kind, _) => format!("a {kind}"),
        }
    }
}

/// The first point beyond the limit of coordinates, in words.
pub(super) fn beyond(mut points: impl Iterator<Item = Point>) -> Option<String> {
    let point = points.find(|point| !is_within(*point))?;
    Some(format!("the position ({:?}, {:?}) lies beyond ±{COORDINATE_LIMIT_M} m", point.x, point.y))
}

pub(super) fn is_within(point: Point) -> bool {
    point.x.abs() <= COORDINATE_LIMIT_M && point.y.abs() <= COORDINATE_LIMIT_M
}

/// An error of the JSON reader in the file as a whole.
fn refuse_json(text: &str, error: &serde_json::Error) -> ReadError {
    let line = (error.line() > 0).then_some(error.line());
    let element = id_around(text, error, 1).map(|id| format!("feature {id}")).unwrap_or_default();
    let fault = json_fault(text, error);
    ReadError { place: Place { line, element }, what: fault.what, hint: fault.hint.unwrap_or(DAMAGED).to_owned() }
}
