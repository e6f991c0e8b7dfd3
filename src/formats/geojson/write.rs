use serde_json::{Map, Value};

use super::KEPT;
use super::coordinates::{Coordinates, Position};
use super::disk::{DiskFeature, DiskGeometry, DiskHost, DiskMeta, DiskProperties, Words};
use super::words::{FROM_SCHEME, opening_kind, opening_word};
use crate::features::RoomStatus;
use crate::formats::json_text::{Number, ObjectLines};
use crate::formats::plan_json::DiskHinge;
use crate::geometry::Point;
use crate::labels::Schemes;
use crate::plan::{CornerId, Extra, Joint, Meta, Opening, OpeningId, Place, Plan, Room, RoomId, Wall, WallId};
use crate::topology::{Graph, RoomShapes};

/// Members that Enfilade itself writes: kept properties with these names are not written twice.
const OWN: &[&str] = &[
    "type",
    "features",
    "crs",
    "units",
    "name",
    "building",
    "storey",
    "typology",
    "scale",
    "scale_origin",
    "metres_per_unit",
    "source",
    "licence",
    "kind",
    "function",
    "label",
    "label_origin",
    "note",
    "opening",
    "rooms",
    "pinned",
    "host",
    "free",
    "hinge",
    "opens",
    "thickness_m",
    "source_id",
];

/// The whole file: one feature per line; rooms, walls, openings, each sorted by id.
pub(super) fn write(plan: &Plan, schemes: &Schemes, rooms_only: bool) -> Vec<u8> {
    let mut file = ObjectLines::new(300 * (plan.rooms().len() + plan.openings().len() + plan.walls().len()));
    file.member("type", "FeatureCollection");
    file.member("units", "m");
    let meta = serde_json::to_value(meta_of(plan)).unwrap_or_default();
    file.members(meta.as_object().into_iter().flatten());
    let rooms = plan.rooms().map(|(id, room)| room_feature(plan, schemes, id, room));
    if rooms_only {
        file.list("features", rooms);
        return file.finish();
    }
    let shapes = RoomShapes::new(plan);
    let graph = Graph::new(plan, &shapes);
    let walls = plan.walls().map(|(id, wall)| wall_feature(plan, id, wall));
    let openings = plan.openings().map(|(id, opening)| {
        // The graph omits windows; its connections are sorted by opening, like the plan's openings.
        let found = graph.connections().binary_search_by_key(&id, |connection| connection.opening).ok();
        opening_feature(plan, id, opening, found.map(|index| graph.connections()[index].sides))
    });
    file.list("features", rooms.chain(walls).chain(openings));
    file.finish()
}

/// What the file does not keep, in words, each with a count.
pub(super) fn lost(plan: &Plan, rooms_only: bool) -> Vec<String> {
    let count_others = |extra: &Extra| extra.iter().flat_map(|extra| extra.keys()).filter(|key| *key != KEPT).count();
    let fields = count_others(&plan.extra)
        + plan.meta().extra.as_ref().map_or(0, |extra| extra.len())
        + plan.rooms().map(|(_, room)| count_others(&room.extra)).sum::<usize>()
        + plan.walls().map(|(_, wall)| count_others(&wall.extra)).sum::<usize>()
        + plan.openings().map(|(_, opening)| count_others(&opening.extra)).sum::<usize>()
        + plan.corners().map(|(_, corner)| count_others(&corner.extra)).sum::<usize>();
    let (walls, openings) = if rooms_only { (plan.walls().len(), plan.openings().len()) } else { (0, 0) };
    let counted = [
        (usize::from(plan.backdrop().is_some()), "traced picture", "traced pictures"),
        (plan.guides().len(), "guide", "guides"),
        (plan.dimensions().len(), "dimension chain", "dimension chains"),
        (walls, "wall", "walls"),
        (openings, "opening", "openings"),
        (fields, "field of another program", "fields of other programs"),
    ];
    let present = counted.into_iter().filter(|&(count, ..)| count > 0);
    present.map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many })).collect()
}

fn meta_of(plan: &Plan) -> DiskMeta {
    let Meta { name, building, storey, typology, scale, source, licence, extra: _ } = plan.meta();
    DiskMeta {
        name: name.as_str().into(),
        building: building.as_str().into(),
        storey: storey.as_str().into(),
        typology: typology.as_ref().map(|typology| typology.as_str().into()).unwrap_or_default(),
        scale: scale.note.as_str().into(),
        scale_origin: scale.origin.name().into(),
        metres_per_unit: scale.metres_per_unit.map(Number),
        source: source.as_str().into(),
        licence: licence.as_str().into(),
        other: kept(&plan.extra),
    }
}

/// The properties kept from an import, without those Enfilade itself writes.
fn kept(extra: &Extra) -> Map<String, Value> {
    let properties = extra.as_ref().and_then(|extra| extra.get(KEPT)).and_then(Value::as_object);
    properties
        .into_iter()
        .flatten()
        .filter(|(key, _)| !OWN.contains(&key.as_str()))
        .map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

/// The feature's id and its property `source_id`. The id is the source's own if reading it gives the same
/// identity again, else Enfilade's.
fn names<T: Copy + PartialEq + ToString>(id: T, source_id: &str, of_key: fn(&str) -> T) -> (Words, Words) {
    if !source_id.is_empty() && of_key(source_id) == id {
        (source_id.into(), Words::default())
    } else {
        (Words(id.to_string()), source_id.into())
    }
}

fn room_names(id: RoomId, room: &Room) -> (Words, Words) {
    names(id, &room.source_id, RoomId::of_key)
}

fn feature(id: Words, kind: &str, coordinates: Option<Coordinates>, properties: DiskProperties) -> DiskFeature {
    let geometry = coordinates.map(|coordinates| DiskGeometry {
        kind: kind.into(),
        coordinates: Some(coordinates),
        geometries: None,
    });
    DiskFeature { kind: "Feature".into(), id, geometry, properties: Some(properties) }
}

fn room_feature(plan: &Plan, schemes: &Schemes, id: RoomId, room: &Room) -> DiskFeature {
    // GeoJSON repeats the first position at the end of a ring.
    let ring = |ring: &std::sync::Arc<[CornerId]>| -> Vec<Position> {
        let points = plan.ring_points(ring);
        points.iter().chain(points.first()).copied().map(Position).collect()
    };
    let (label, label_origin) = match (room.label, RoomStatus::of(plan, schemes, room).label()) {
        (Some(given), _) => (given.label.name(), given.origin.name()),
        (None, Some(label)) => (label.name(), FROM_SCHEME),
        (None, None) => ("", ""),
    };
    let (feature_id, source_id) = room_names(id, room);
    let properties = DiskProperties {
        kind: "room".into(),
        function: room.function.as_str().into(),
        label: label.into(),
        label_origin: label_origin.into(),
        name: room.name.as_str().into(),
        note: room.note.as_str().into(),
        source_id,
        other: kept(&room.extra),
        ..DiskProperties::default()
    };
    let coordinates = room.has_boundary().then(|| Coordinates::Rings(room.rings().map(ring).collect()));
    feature(feature_id, "Polygon", coordinates, properties)
}

fn line(a: Point, b: Point) -> Option<Coordinates> {
    Some(Coordinates::Line(vec![Position(a.trimmed()), Position(b.trimmed())]))
}

fn wall_feature(plan: &Plan, id: WallId, wall: &Wall) -> DiskFeature {
    let segment = plan.wall_segment(wall);
    let properties = DiskProperties {
        kind: "wall".into(),
        thickness_m: Some(Number(wall.thickness_m)),
        other: kept(&wall.extra),
        ..DiskProperties::default()
    };
    feature(Words(id.to_string()), "LineString", segment.and_then(|segment| line(segment.a, segment.b)), properties)
}

/// `found` are the sides the opening joins, stated or by geometry; none for a window.
fn opening_feature(plan: &Plan, id: OpeningId, opening: &Opening, found: Option<[Joint; 2]>) -> DiskFeature {
    let joint = |joint: Joint| Some(room_names(joint.room()?, plan.room(joint.room()?)?).0);
    let sides = opening.pinned.or(found);
    let (feature_id, source_id) = names(id, &opening.source_id, OpeningId::of_key);
    let host = match opening.place {
        Place::Free { .. } => None,
        Place::Hosted { from, to, at_m, width_m } => plan.position(from).zip(plan.position(to)).map(|(from, to)| {
            DiskHost { from: Position(from), to: Position(to), at_m: Number(at_m), width_m: Number(width_m) }
        }),
    };
    // The source's own word, as long as it still means the same.
    let word = opening
        .extra
        .as_ref()
        .and_then(|extra| extra.get(KEPT)?.get("opening")?.as_str())
        .filter(|word| opening_kind(word) == Some(opening.kind))
        .unwrap_or(opening_word(opening.kind));
    let properties = DiskProperties {
        kind: "opening".into(),
        opening: word.into(),
        rooms: sides.map(|sides| sides.map(joint).to_vec()),
        pinned: (opening.pinned.is_none() && sides.is_some()).then_some(false),
        host,
        free: matches!(opening.place, Place::Free { .. }).then_some(true),
        hinge: opening.swing.map(|swing| if swing.hinge_at_start { DiskHinge::Start } else { DiskHinge::End }),
        opens: opening.swing.map(|swing| swing.side.into()),
        source_id,
        other: kept(&opening.extra),
        ..DiskProperties::default()
    };
    let segment = plan.opening_segment(opening);
    feature(feature_id, "LineString", segment.and_then(|segment| line(segment.a, segment.b)), properties)
}
