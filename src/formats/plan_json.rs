//! `*.plan.json`: Enfilade's own format, described for outsiders in `docs/plan-file.md`.
//!
//! The disk form has types of its own, separate from the live ones. They are flat, so that every object
//! keeps the fields it does not know. Writing a plan just read gives the same bytes: elements are sorted
//! by id, one object per line, lengths on the 0.1 mm grid.

mod change;

use std::fmt::Display;
use std::str::FromStr;
use std::sync::Arc;

use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

use super::json_text::{Number, ObjectLines, decode, id_around, json_fault, line_of_id};
use super::{
    Export, Exporter, Format, Head, Import, Importer, NamedBytes, NamedPlan, Note, NoteKind, Options, Place, ReadError,
    Recognition, Refused, Source,
};
use crate::geometry::{COORDINATE_LIMIT_M, Point, Vector, trim_m};
use crate::labels::{Label, Schemes, Typology};
use crate::plan::{
    Backdrop, Corner, CornerId, Dimension, DimensionAlong, DimensionHost, DimensionId, DimensionPoint, ElementId,
    Extra, Guide, GuideAxis, Ignored, Joint, LabelOrigin, LeafSide, Measurement, Meta, Opening, OpeningId, OpeningKind,
    Place as OpeningPlace, Plan, Rectification, Room, RoomId, RoomLabel, Scale, ScaleOrigin, Swing, Wall, WallId,
    WallSide, guides, ignored,
};

pub(crate) use change::{apply_change, change_to_bytes};

/// The newest file version this program reads, and the one it writes.
pub const VERSION: u64 = 1;

/// The value of the member `format`, which distinguishes the file from other JSON.
const MAGIC: &str = "enfilade plan";

/// Enfilade's own plan file.
pub const FORMAT: Format = Format {
    id: "enfilade",
    name: "Enfilade plan",
    endings: &["plan.json"],
    about: "Everything there is to a plan, as text that version control compares well (docs/plan-file.md)",
    importer: Some(&PlanJson),
    exporter: Some(&PlanJson),
};

struct PlanJson;

impl Importer for PlanJson {
    fn recognises(&self, head: &Head<'_>) -> Recognition {
        let Head::File { start, .. } = head else { return Recognition::No };
        let start = String::from_utf8_lossy(start);
        let is_stated = start.split("\"format\"").skip(1).any(|rest| {
            let value = rest.trim_start().strip_prefix(':').unwrap_or_default().trim_start();
            value.strip_prefix('"').is_some_and(|value| value.starts_with(MAGIC))
        });
        match is_stated {
            true => Recognition::Yes,
            false if head.ends_with(FORMAT.endings) => Recognition::Perhaps,
            false => Recognition::No,
        }
    }

    fn read(&self, source: &Source<'_>, _options: &Options) -> Result<Import, ReadError> {
        let Import { mut plans, notes } = read(source.bytes()?)?;
        let mut plan = plans.pop().unwrap_or_default();
        if plan.meta().name.is_empty() && !source.stem().is_empty() {
            let meta = Meta { name: source.stem().to_owned(), ..plan.meta().clone() };
            plan = crate::edit::set_meta(&plan, meta);
        }
        Ok(Import { plans: vec![plan], notes })
    }
}

impl Exporter for PlanJson {
    fn write(&self, plans: &[NamedPlan<'_>], _schemes: &Schemes, _options: &Options) -> Result<Export, Refused> {
        let file = |it: &NamedPlan<'_>| NamedBytes { name: format!("{}.plan.json", it.stem), bytes: to_bytes(it.plan) };
        Ok(Export { files: plans.iter().map(file).collect(), lost: Vec::new() })
    }
}

/// Reads a plan. Lengths are rounded to the 0.1 mm grid.
///
/// # Errors
/// When the bytes are not a plan file of a known version, or their content breaks an invariant of the
/// model; with the line and the element if known.
pub fn from_bytes(bytes: &[u8]) -> Result<Plan, ReadError> {
    read(bytes).map(|mut import| import.plans.pop().unwrap_or_default())
}

/// As [`from_bytes`], with notes on what is not in the plan.
fn read(bytes: &[u8]) -> Result<Import, ReadError> {
    let text = decode(bytes)?;
    let head: DiskHead = serde_json::from_str(text).map_err(|error| refuse_json(text, &error))?;
    if head.format.as_ref().and_then(Value::as_str) != Some(MAGIC) {
        return Err(ReadError {
            place: Place::default(),
            what: format!("is JSON, but not a plan file: it lacks \"format\": \"{MAGIC}\""),
            hint: "open a file that ends in .plan.json".to_owned(),
        });
    }
    let refuse_version = |what: String, hint: String| Err(ReadError { place: Place::default(), what, hint });
    let current = format!("the current one is written \"version\": {VERSION}");
    match head.version {
        None => return refuse_version("has no file version".to_owned(), current),
        Some(version) => match version.as_u64() {
            Some(1) => {}
            Some(newer) if newer > VERSION => {
                let what =
                    format!("was saved by a newer Enfilade (file version {newer}; this one reads up to {VERSION})");
                return refuse_version(what, "update Enfilade".to_owned());
            }
            _ => return refuse_version(format!("has the file version {version}, which never existed"), current),
        },
    }
    let disk: DiskPlan = serde_json::from_str(text).map_err(|error| refuse_json(text, &error))?;
    let notes = [
        ("guides", disk.guides.len().saturating_sub(guides::MOST_GUIDES), guides::MOST_GUIDES),
        ("ignored", disk.ignored.len().saturating_sub(ignored::MOST_IGNORED), ignored::MOST_IGNORED),
    ];
    let note = |(list, beyond, most): (&str, usize, usize)| Note {
        kind: NoteKind::Skipped,
        place: Place { line: None, element: list.to_owned() },
        what: format!(
            "{beyond} more than the {most} that a plan may have; the last {} left out, and gone from the file when it \
             is saved",
            if beyond == 1 { "is" } else { "are" },
        ),
    };
    let notes = notes.into_iter().filter(|(_, beyond, _)| *beyond > 0).map(note).collect();
    Ok(Import { plans: vec![live(text, disk)?], notes })
}

/// The complete bytes of a plan's file.
pub fn to_bytes(plan: &Plan) -> Vec<u8> {
    let mut file = ObjectLines::new(200 + 60 * plan.corners().len() + 400 * plan.rooms().len());
    file.member("format", MAGIC);
    file.member("version", &VERSION);
    file.object("meta", &DiskMeta::of(plan.meta()));
    if let Some(backdrop) = plan.backdrop() {
        file.member("backdrop", &DiskBackdrop::of(backdrop));
    }
    if !plan.guides().is_empty() {
        file.list("guides", plan.guides().iter().map(DiskGuide::of));
    }
    if !plan.ignored().is_empty() {
        file.list("ignored", plan.ignored().iter().map(DiskIgnored::of));
    }
    file.list("corners", plan.corners().map(|(id, corner)| DiskCorner::of(id, corner)));
    file.list("walls", plan.walls().map(|(id, wall)| DiskWall::of(id, wall)));
    file.list("rooms", plan.rooms().map(|(id, room)| DiskRoom::of(id, room)));
    file.list("openings", plan.openings().map(|(id, opening)| DiskOpening::of(id, opening)));
    if plan.dimensions().len() > 0 {
        file.list("dimensions", plan.dimensions().map(|(id, dimension)| DiskDimension::of(id, dimension)));
    }
    file.members(plan.extra.iter().flat_map(|extra| extra.iter()));
    file.finish()
}

// The disk form.

/// A length in metres: rounded to the 0.1 mm grid, rejected beyond ±100 km.
#[derive(Clone, Copy)]
struct Metres(f64);

impl Serialize for Metres {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Number(self.0).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Metres {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Number(metres) = Number::deserialize(deserializer)?;
        if metres.is_finite() && metres.abs() <= COORDINATE_LIMIT_M {
            Ok(Self(trim_m(metres)))
        } else {
            Err(D::Error::custom(format_args!("{metres:?} m lies beyond ±{COORDINATE_LIMIT_M} m")))
        }
    }
}

/// Something written as its `Display` text and read by its `FromStr`: ids and labels.
#[derive(Clone, Copy)]
struct Text<T>(T);

impl<T: Display> Serialize for Text<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.0)
    }
}

impl<'de, T: FromStr<Err: Display>> Deserialize<'de> for Text<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor<T>(std::marker::PhantomData<T>);
        impl<T: FromStr<Err: Display>> serde::de::Visitor<'_> for Visitor<T> {
            type Value = Text<T>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a text")
            }

            fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Text<T>, E> {
                text.parse().map(Text).map_err(E::custom)
            }
        }
        deserializer.deserialize_str(Visitor(std::marker::PhantomData))
    }
}

/// Read first, to reject other files and newer versions before parsing anything else.
#[derive(Deserialize)]
struct DiskHead {
    format: Option<Value>,
    version: Option<Value>,
}

#[derive(Deserialize)]
#[serde(expecting = "a plan")]
struct DiskPlan {
    #[serde(rename = "format")]
    _format: IgnoredAny,
    #[serde(rename = "version")]
    _version: IgnoredAny,
    #[serde(default)]
    meta: DiskMeta,
    backdrop: Option<DiskBackdrop>,
    #[serde(default)]
    guides: Vec<DiskGuide>,
    #[serde(default)]
    ignored: Vec<DiskIgnored>,
    #[serde(default)]
    corners: Vec<DiskCorner>,
    #[serde(default)]
    walls: Vec<DiskWall>,
    #[serde(default)]
    rooms: Vec<DiskRoom>,
    #[serde(default)]
    openings: Vec<DiskOpening>,
    #[serde(default)]
    dimensions: Vec<DiskDimension>,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Default, Serialize, Deserialize)]
#[serde(expecting = "an object")]
struct DiskMeta {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    building: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    storey: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    typology: String,
    #[serde(default, skip_serializing_if = "DiskScaleOrigin::is_unknown")]
    scale_origin: DiskScaleOrigin,
    #[serde(skip_serializing_if = "Option::is_none")]
    metres_per_unit: Option<Number>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    scale_note: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    licence: String,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a backdrop")]
struct DiskBackdrop {
    path: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    content_hash: String,
    #[serde(default = "first_page", skip_serializing_if = "is_first_page")]
    page: u32,
    x: Number,
    y: Number,
    metres_per_pixel: Number,
    #[serde(default = "zero", skip_serializing_if = "is_zero")]
    rotation_rad: Number,
    #[serde(default = "one", skip_serializing_if = "is_one")]
    opacity: Number,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    measurements: Vec<DiskMeasurement>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    rectification: Option<DiskRectification>,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a rectification")]
struct DiskRectification {
    corners: [[Number; 2]; 4],
    rectangle: [[Number; 2]; 2],
    size: [u32; 2],
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a guide")]
struct DiskGuide {
    axis: Text<GuideAxis>,
    at: Metres,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "an ignored finding")]
struct DiskIgnored {
    kind: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    elements: Vec<Text<ElementId>>,
    reason: String,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a measurement")]
struct DiskMeasurement {
    from: [Number; 2],
    to: [Number; 2],
    length: Number,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a corner")]
struct DiskCorner {
    id: Text<CornerId>,
    x: Metres,
    y: Metres,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a wall")]
struct DiskWall {
    id: Text<WallId>,
    from: Text<CornerId>,
    to: Text<CornerId>,
    thickness: Metres,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a room")]
struct DiskRoom {
    id: Text<RoomId>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    function: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    label: Option<Text<Label>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    label_origin: Option<DiskLabelOrigin>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    outer: Vec<Text<CornerId>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    holes: Vec<Vec<Text<CornerId>>>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    note: String,
    /// Where its texts are, from the middle of its bounding box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    text_offset: Option<[Metres; 2]>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source_id: String,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "an opening")]
struct DiskOpening {
    id: Text<OpeningId>,
    kind: DiskOpeningKind,
    /// The edge of a hosted opening.
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<[Text<CornerId>; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    width: Option<Metres>,
    /// The ends of a free opening.
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<[Metres; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<[Metres; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    hinge: Option<DiskHinge>,
    #[serde(skip_serializing_if = "Option::is_none")]
    opens: Option<DiskSide>,
    /// Pinned sides; null is the outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    joins: Option<[Option<Text<RoomId>>; 2]>,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source_id: String,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a dimension")]
struct DiskDimension {
    id: Text<DimensionId>,
    along: DiskAlong,
    offset: Metres,
    points: Vec<DiskDimensionPoint>,
    #[serde(flatten)]
    extra: Map<String, Value>,
}

#[derive(Serialize, Deserialize)]
#[serde(expecting = "a point of a dimension")]
struct DiskDimensionPoint {
    x: Metres,
    y: Metres,
    /// The id of a corner, a wall or an opening.
    #[serde(skip_serializing_if = "Option::is_none")]
    on: Option<String>,
    /// Of a wall.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<DiskWallSide>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<Metres>,
    /// Of an opening.
    #[serde(skip_serializing_if = "Option::is_none")]
    end: Option<DiskHinge>,
}

/// The disk form of an enum: its words belong to the format, even if the live type is renamed.
macro_rules! disk_words {
    ($disk:ident for $live:ident { $($variant:ident = $word:literal),+ $(,)? }) => {
        #[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
        pub(super) enum $disk {
            $(#[serde(rename = $word)] $variant,)+
        }

        impl From<$live> for $disk {
            fn from(live: $live) -> Self {
                match live { $($live::$variant => Self::$variant,)+ }
            }
        }

        impl From<$disk> for $live {
            fn from(disk: $disk) -> Self {
                match disk { $($disk::$variant => Self::$variant,)+ }
            }
        }
    };
}

disk_words!(DiskScaleOrigin for ScaleOrigin {
    Unknown = "unknown", Drawn = "drawn", Measured = "measured", Imported = "imported", Estimated = "estimated",
});
disk_words!(DiskLabelOrigin for LabelOrigin {
    Person = "person", Imported = "imported", AcceptedPrediction = "accepted prediction",
    Prediction = "prediction",
});
disk_words!(DiskOpeningKind for OpeningKind {
    Door = "door", DoubleDoor = "double door", Passage = "passage", Window = "window",
});
disk_words!(DiskAlong for DimensionAlong {
    Horizontal = "horizontal", Vertical = "vertical", Aligned = "aligned",
});
disk_words!(DiskWallSide for WallSide { Left = "left", Axis = "axis", Right = "right" });
disk_words!(DiskSide for LeafSide { Left = "left", Right = "right" });

impl Default for DiskScaleOrigin {
    fn default() -> Self {
        ScaleOrigin::default().into()
    }
}

impl DiskScaleOrigin {
    fn is_unknown(&self) -> bool {
        *self == Self::Unknown
    }
}

/// An end of an opening's segment: the one with the hinge, or the one that is measured.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum DiskHinge {
    Start,
    End,
}

fn zero() -> Number {
    Number(0.0)
}

fn one() -> Number {
    Number(1.0)
}

fn first_page() -> u32 {
    1
}

fn is_first_page(page: &u32) -> bool {
    *page == 1
}

fn is_zero(number: &Number) -> bool {
    number.0 == 0.0
}

fn is_one(number: &Number) -> bool {
    number.0 == 1.0
}

// From live to disk.

fn fields(extra: &Extra) -> Map<String, Value> {
    extra.as_deref().cloned().unwrap_or_default()
}

impl DiskMeta {
    fn of(meta: &Meta) -> Self {
        Self {
            name: meta.name.clone(),
            building: meta.building.clone(),
            storey: meta.storey.clone(),
            typology: meta.typology.as_ref().map(|typology| typology.as_str().to_owned()).unwrap_or_default(),
            scale_origin: meta.scale.origin.into(),
            metres_per_unit: meta.scale.metres_per_unit.map(Number),
            scale_note: meta.scale.note.clone(),
            source: meta.source.clone(),
            licence: meta.licence.clone(),
            extra: fields(&meta.extra),
        }
    }
}

impl DiskBackdrop {
    fn of(backdrop: &Backdrop) -> Self {
        Self {
            path: backdrop.path.clone(),
            content_hash: backdrop.content_hash.clone(),
            page: backdrop.page,
            x: Number(backdrop.origin.x),
            y: Number(backdrop.origin.y),
            metres_per_pixel: Number(backdrop.metres_per_pixel),
            rotation_rad: Number(backdrop.rotation_rad),
            opacity: Number(backdrop.opacity),
            measurements: backdrop.measurements.iter().map(DiskMeasurement::of).collect(),
            rectification: backdrop.rectification.as_ref().map(DiskRectification::of),
            extra: fields(&backdrop.extra),
        }
    }
}

impl DiskRectification {
    fn of(rectification: &Rectification) -> Self {
        let point = |point: Point| [Number(point.x), Number(point.y)];
        Self {
            corners: rectification.corners.map(point),
            rectangle: rectification.rectangle.map(point),
            size: rectification.size_px,
        }
    }

    fn live(self) -> Rectification {
        let point = |[x, y]: [Number; 2]| Point::new(x.0, y.0);
        Rectification { corners: self.corners.map(point), rectangle: self.rectangle.map(point), size_px: self.size }
    }
}

impl DiskGuide {
    fn of(guide: &Guide) -> Self {
        Self { axis: Text(guide.axis), at: Metres(guide.at_m), extra: fields(&guide.extra) }
    }

    fn live(self) -> Guide {
        Guide { axis: self.axis.0, at_m: self.at.0, extra: kept(self.extra) }
    }
}

impl DiskIgnored {
    fn of(ignored: &Ignored) -> Self {
        let Ignored { kind, elements, reason, extra } = ignored;
        let elements = elements.iter().copied().map(Text).collect();
        Self { kind: kind.clone(), elements, reason: reason.clone(), extra: fields(extra) }
    }

    fn live(self) -> Ignored {
        let elements = self.elements.into_iter().map(|element| element.0);
        Ignored { extra: kept(self.extra), ..Ignored::new(&self.kind, elements, &self.reason) }
    }
}

impl DiskMeasurement {
    fn of(measurement: &Measurement) -> Self {
        let Measurement { from, to, length_m } = measurement;
        let pair = |point: &Point| [Number(point.x), Number(point.y)];
        Self { from: pair(from), to: pair(to), length: Number(*length_m) }
    }

    fn live(self) -> Measurement {
        let point = |[x, y]: [Number; 2]| Point::new(x.0, y.0);
        Measurement { from: point(self.from), to: point(self.to), length_m: self.length.0 }
    }
}

impl DiskCorner {
    fn of(id: CornerId, corner: &Corner) -> Self {
        let Point { x, y } = corner.position;
        Self { id: Text(id), x: Metres(x), y: Metres(y), extra: fields(&corner.extra) }
    }
}

impl DiskWall {
    fn of(id: WallId, wall: &Wall) -> Self {
        Self {
            id: Text(id),
            from: Text(wall.from),
            to: Text(wall.to),
            thickness: Metres(wall.thickness_m),
            extra: fields(&wall.extra),
        }
    }
}

impl DiskRoom {
    fn of(id: RoomId, room: &Room) -> Self {
        let ring = |ring: &Arc<[CornerId]>| ring.iter().copied().map(Text).collect();
        Self {
            id: Text(id),
            name: room.name.clone(),
            function: room.function.clone(),
            label: room.label.map(|given| Text(given.label)),
            label_origin: room.label.map(|given| given.origin.into()),
            outer: ring(&room.outer),
            holes: room.holes.iter().map(ring).collect(),
            note: room.note.clone(),
            text_offset: room.text_offset.map(|offset| [offset.x, offset.y].map(Metres)),
            source_id: room.source_id.clone(),
            extra: fields(&room.extra),
        }
    }
}

impl DiskOpening {
    fn of(id: OpeningId, opening: &Opening) -> Self {
        let mut disk = Self {
            id: Text(id),
            kind: opening.kind.into(),
            on: None,
            at: None,
            width: None,
            from: None,
            to: None,
            hinge: opening.swing.map(|swing| if swing.hinge_at_start { DiskHinge::Start } else { DiskHinge::End }),
            opens: opening.swing.map(|swing| swing.side.into()),
            joins: opening.pinned.map(|sides| sides.map(|side| side.room().map(Text))),
            source_id: opening.source_id.clone(),
            extra: fields(&opening.extra),
        };
        match opening.place {
            OpeningPlace::Hosted { from, to, at_m, width_m } => {
                disk.on = Some([Text(from), Text(to)]);
                disk.at = Some(Number(at_m));
                disk.width = Some(Metres(width_m));
            }
            OpeningPlace::Free { from, to } => {
                disk.from = Some([from.x, from.y].map(Metres));
                disk.to = Some([to.x, to.y].map(Metres));
            }
        }
        disk
    }
}

impl DiskDimension {
    fn of(id: DimensionId, dimension: &Dimension) -> Self {
        Self {
            id: Text(id),
            along: dimension.along.into(),
            offset: Metres(dimension.offset_m),
            points: dimension.points.iter().map(DiskDimensionPoint::of).collect(),
            extra: fields(&dimension.extra),
        }
    }

    fn live(self) -> Result<Dimension, (&'static str, &'static str)> {
        Ok(Dimension {
            points: self.points.into_iter().map(DiskDimensionPoint::live).collect::<Result<_, _>>()?,
            along: self.along.into(),
            offset_m: self.offset.0,
            extra: kept(self.extra),
        })
    }
}

impl DiskDimensionPoint {
    fn of(point: &DimensionPoint) -> Self {
        let Point { x, y } = point.last;
        let mut disk = Self { x: Metres(x), y: Metres(y), on: None, side: None, at: None, end: None };
        match point.on {
            None => {}
            Some(DimensionHost::Corner(id)) => disk.on = Some(id.to_string()),
            Some(DimensionHost::Wall { wall, side, at_m }) => {
                disk.on = Some(wall.to_string());
                disk.side = Some(side.into());
                disk.at = Some(Metres(at_m));
            }
            Some(DimensionHost::Opening { opening, is_start }) => {
                disk.on = Some(opening.to_string());
                disk.end = Some(if is_start { DiskHinge::Start } else { DiskHinge::End });
            }
        }
        disk
    }

    fn live(self) -> Result<DimensionPoint, (&'static str, &'static str)> {
        let no_id = |_| ("a point of it is on something that has no such id", MEASURED_HINT);
        let on = match (self.on, self.side, self.at, self.end) {
            (None, None, None, None) => None,
            (Some(id), None, None, None) => Some(DimensionHost::Corner(id.parse().map_err(no_id)?)),
            (Some(id), Some(side), Some(at), None) => {
                Some(DimensionHost::Wall { wall: id.parse().map_err(no_id)?, side: side.into(), at_m: at.0 })
            }
            (Some(id), None, None, Some(end)) => {
                let opening = id.parse().map_err(no_id)?;
                Some(DimensionHost::Opening { opening, is_start: end == DiskHinge::Start })
            }
            _ => return Err(("a point of it is incomplete", MEASURED_HINT)),
        };
        Ok(DimensionPoint { on, last: Point::new(self.x.0, self.y.0) })
    }
}

/// The hint about the points of a dimension.
const MEASURED_HINT: &str =
    "a point is \"on\" a corner; on a wall, with \"side\" and \"at\"; on an opening, with \"end\"; or on nothing";

// From disk to live.

/// The plan described by a file.
fn live(text: &str, disk: DiskPlan) -> Result<Plan, ReadError> {
    let mut plan = Plan {
        meta: Arc::new(disk.meta.live()),
        backdrop: disk.backdrop.map(|backdrop| Arc::new(backdrop.live())),
        guides: guides::sorted(disk.guides.into_iter().take(guides::MOST_GUIDES).map(DiskGuide::live)),
        ignored: ignored::sorted(disk.ignored.into_iter().take(ignored::MOST_IGNORED).map(DiskIgnored::live)),
        extra: kept(disk.extra),
        ..Plan::default()
    };
    if let Some(fault) = plan.backdrop().and_then(Backdrop::fault) {
        let line = text.find("\"metres_per_pixel\"").map(|at| super::text::line_of(text.as_bytes(), at));
        let place = Place { line, element: String::new() };
        let hint = "correct \"backdrop\" by hand, or take it out and add the picture anew";
        return Err(ReadError { place, what: format!("the picture under the plan {fault}"), hint: hint.to_owned() });
    }
    let twice = |element: ElementId| {
        refuse(text, element, 1, "is in the file twice", "remove one of the two, or give it an id of its own")
    };
    for corner in disk.corners {
        let id = corner.id.0;
        let position = Point::new(corner.x.0, corner.y.0);
        if plan.corners.insert(id, Corner { position, extra: kept(corner.extra) }).is_some() {
            return Err(twice(ElementId::Corner(id)));
        }
    }
    for wall in disk.walls {
        let id = wall.id.0;
        let extra = kept(wall.extra);
        let wall = Wall { from: wall.from.0, to: wall.to.0, thickness_m: wall.thickness.0, extra };
        if plan.walls.insert(id, wall).is_some() {
            return Err(twice(ElementId::Wall(id)));
        }
    }
    for room in disk.rooms {
        let id = room.id.0;
        if plan.rooms.insert(id, Arc::new(room.live())).is_some() {
            return Err(twice(ElementId::Room(id)));
        }
    }
    for opening in disk.openings {
        let id = opening.id.0;
        let element = ElementId::Opening(id);
        let opening = opening.live().map_err(|(what, hint)| refuse(text, element, 0, what, hint))?;
        if plan.openings.insert(id, Arc::new(opening)).is_some() {
            return Err(twice(element));
        }
    }
    for dimension in disk.dimensions {
        let id = dimension.id.0;
        let element = ElementId::Dimension(id);
        let dimension = dimension.live().map_err(|(what, hint)| refuse(text, element, 0, what, hint))?;
        if plan.dimensions.insert(id, Arc::new(dimension)).is_some() {
            return Err(twice(element));
        }
    }
    match plan.violations().into_iter().next() {
        None => Ok(plan),
        Some(violation) => Err(refuse(
            text,
            violation.element,
            0,
            &violation.what,
            "correct it by hand, or restore the file from a copy or from version control",
        )),
    }
}

/// The hint about an opening's fields.
const PLACE_HINT: &str = "an opening has either \"on\", \"at\" and \"width\", or \"from\" and \"to\"";
const SWING_HINT: &str = "\"hinge\" and \"opens\" come together";

fn kept(extra: Map<String, Value>) -> Extra {
    (!extra.is_empty()).then(|| Arc::new(extra))
}

impl DiskMeta {
    fn live(self) -> Meta {
        Meta {
            name: self.name,
            building: self.building,
            storey: self.storey,
            typology: Typology::new(&self.typology),
            scale: Scale {
                origin: self.scale_origin.into(),
                metres_per_unit: self.metres_per_unit.map(|number| number.0),
                note: self.scale_note,
            },
            source: self.source,
            licence: self.licence,
            extra: kept(self.extra),
        }
    }
}

impl DiskBackdrop {
    fn live(self) -> Backdrop {
        Backdrop {
            path: self.path,
            content_hash: self.content_hash,
            page: self.page,
            origin: Point::new(self.x.0, self.y.0),
            metres_per_pixel: self.metres_per_pixel.0,
            rotation_rad: self.rotation_rad.0,
            opacity: self.opacity.0,
            measurements: self.measurements.into_iter().map(DiskMeasurement::live).collect(),
            rectification: self.rectification.map(DiskRectification::live),
            extra: kept(self.extra),
        }
    }
}

impl DiskRoom {
    fn live(self) -> Room {
        let ring = |ring: Vec<Text<CornerId>>| ring.into_iter().map(|corner| corner.0).collect();
        Room {
            outer: ring(self.outer),
            holes: self.holes.into_iter().map(ring).collect(),
            function: self.function,
            label: self.label.map(|label| RoomLabel {
                label: label.0,
                // A label that another program wrote without its origin.
                origin: self.label_origin.map_or(LabelOrigin::Imported, LabelOrigin::from),
            }),
            name: self.name,
            note: self.note,
            text_offset: self.text_offset.map(|[x, y]| Vector::new(x.0, y.0)),
            source_id: self.source_id,
            extra: kept(self.extra),
        }
    }
}

impl DiskOpening {
    fn live(self) -> Result<Opening, (&'static str, &'static str)> {
        let place = match (self.on, self.at, self.width, self.from, self.to) {
            (Some([from, to]), Some(at), Some(width), None, None) => {
                OpeningPlace::Hosted { from: from.0, to: to.0, at_m: trim_m(at.0), width_m: width.0 }
            }
            (None, None, None, Some([x0, y0]), Some([x1, y1])) => {
                OpeningPlace::Free { from: Point::new(x0.0, y0.0), to: Point::new(x1.0, y1.0) }
            }
            (None, None, None, None, None) => return Err(("has no place", PLACE_HINT)),
            _ => return Err(("its place is incomplete or stated twice", PLACE_HINT)),
        };
        let swing = match (self.hinge, self.opens) {
            (Some(hinge), Some(side)) => Some(Swing { hinge_at_start: hinge == DiskHinge::Start, side: side.into() }),
            (None, None) => None,
            _ => return Err(("its swing is incomplete", SWING_HINT)),
        };
        let joint = |room: Option<Text<RoomId>>| room.map_or(Joint::Outside, |room| Joint::Room(room.0));
        Ok(Opening {
            kind: self.kind.into(),
            place,
            swing,
            pinned: self.joins.map(|sides| sides.map(joint)),
            source_id: self.source_id,
            extra: kept(self.extra),
        })
    }
}

// Errors.

/// The kind of an element and its id, for messages.
fn element_name(id: &str) -> String {
    let kind = match id.as_bytes().first() {
        Some(b'c') => "corner",
        Some(b'w') => "wall",
        Some(b'r') => "room",
        Some(b'o') => "opening",
        Some(b'd') => "dimension",
        _ => "element",
    };
    format!("{kind} {id}")
}

/// An error about an element of a JSON file; `nth` selects among several with its id.
fn refuse(text: &str, element: ElementId, nth: usize, what: &str, hint: &str) -> ReadError {
    let id = element.to_string();
    let place = Place { line: line_of_id(text, &id, nth), element: element_name(&id) };
    ReadError { place, what: what.to_owned(), hint: hint.to_owned() }
}

/// Converts an error of the JSON reader: a syntax error, or a value of the wrong type.
fn refuse_json(text: &str, error: &serde_json::Error) -> ReadError {
    let line = (error.line() > 0).then_some(error.line());
    let element = id_around(text, error, 1).map(element_name).unwrap_or_default();
    let fault = json_fault(text, error);
    let hint =
        fault.hint.unwrap_or("correct it by hand (docs/plan-file.md describes the file), or restore it from a copy");
    ReadError { place: Place { line, element }, what: fault.what, hint: hint.to_owned() }
}
