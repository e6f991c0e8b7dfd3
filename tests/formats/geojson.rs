use enfilade::features::{NeighbourLabels, analyse};
use enfilade::formats::{Import, geojson};
use enfilade::labels::Schemes;
use enfilade::plan::{CornerId, Place, Plan};
use proptest::prelude::*;

use super::generated::plans;
use super::golden::assert_golden;
use super::plan_json::full_plan;

pub fn written(plan: &Plan) -> String {
    String::from_utf8(geojson::to_bytes(plan, &Schemes::bundled())).unwrap()
}

pub fn read(text: &str) -> Import {
    geojson::from_bytes(text.as_bytes(), "").map_err(|error| error.to_string()).unwrap()
}

/// What GeoJSON keeps of a plan, as text: everything but corners' identities, the backdrop and the
/// fields of newer plan files.
pub fn kept(plan: &Plan) -> String {
    let mut text = String::new();
    let mut say = |line: String| text.extend([line.as_str(), "\n"]);
    let meta = plan.meta();
    say(format!("{} {} {} {:?} {:?}", meta.name, meta.building, meta.storey, meta.typology, meta.scale));
    say(format!("{} {}", meta.source, meta.licence));
    for (id, room) in plan.rooms() {
        let rings: Vec<_> = room.rings().map(|ring| plan.ring_points(ring)).collect();
        let texts = [&room.function, &room.name, &room.note, &room.source_id];
        say(format!("{id} {:?} {texts:?} {rings:?}", room.label));
    }
    for (id, wall) in plan.walls() {
        say(format!("{id} {:?} {}", plan.wall_segment(wall), wall.thickness_m));
    }
    for (id, opening) in plan.openings() {
        let edge = |corner: CornerId| plan.position(corner).unwrap();
        let place = match opening.place {
            Place::Hosted { from, to, at_m, width_m } => format!("{:?} {:?} {at_m} {width_m}", edge(from), edge(to)),
            Place::Free { from, to } => format!("{from:?} {to:?}"),
        };
        let rest = (opening.kind, opening.swing, opening.pinned, &opening.source_id);
        say(format!("{id} {place} {rest:?}"));
    }
    text
}

/// `F_r` of every room, both ways of taking neighbours' labels.
pub fn features(plan: &Plan) -> String {
    let schemes = Schemes::bundled();
    let analyses = NeighbourLabels::ALL.map(|neighbours| analyse(plan, &schemes, neighbours).rooms);
    let rooms = analyses.iter().flatten();
    rooms
        .map(|room| format!("{} {:?} {:?} {:?}\n", room.id, room.status.label(), room.features, room.temporary))
        .collect()
}

#[test]
fn the_file_looks_as_documented() {
    assert_golden("every_property.geojson", &written(&full_plan()));
}

#[test]
fn properties_of_others_survive() {
    let text = r##"{"type": "FeatureCollection", "name": "p", "units": "m", "campus": {"id": 7}, "features": [
{"type": "Feature", "id": 4, "geometry": {"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,3],[0,0]]]}, "properties": {"kind": "room", "function": "kitchen", "colour": "#fff", "sensors": [1, 2]}},
{"type": "Feature", "id": 5, "geometry": {"type": "LineString", "coordinates": [[1,0,2.5],[2,0,2.5]]}, "properties": {"kind": "opening", "opening": "sliding_door", "rooms": [4, null], "fire": true}}
]}"##;
    let import = read(text);
    assert_eq!(import.notes, []);
    let again = written(&import.plans[0]);
    for part in [
        "\"campus\": {\"id\":7}",
        "\"colour\":\"#fff\",\"sensors\":[1,2]",
        "\"fire\":true",
        "\"sliding_door\"",
        "\"id\":\"4\"",
    ] {
        assert!(again.contains(part), "{part} is not in {again}");
    }
    assert_eq!(read(&again).plans, import.plans);
}

/// A door drawn on a wall is part of it, so that both move together.
#[test]
fn openings_on_an_edge_are_hosted_by_it() {
    let place = |line: &str, more: &str| {
        let text = format!(
            r#"{{"type": "FeatureCollection", "units": "m", "features": [
{{"type": "Feature", "geometry": {{"type": "LineString", "coordinates": {line}}}, "properties": {{"opening": "door"{more}}}}},
{{"type": "Feature", "geometry": {{"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,3],[0,3],[0,0]]]}}, "properties": {{"kind": "room"}}}}
]}}"#
        );
        let import = read(&text);
        let plan = &import.plans[0];
        let (_, opening) = plan.openings().next().unwrap();
        match opening.place {
            Place::Hosted { from, to, at_m, width_m } => {
                let (a, b) = (plan.position(from).unwrap(), plan.position(to).unwrap());
                format!("on {},{} {},{} at {at_m} width {width_m}", a.x, a.y, b.x, b.y)
            }
            Place::Free { .. } => "free".to_owned(),
        }
    };
    assert_eq!(place("[[1,0],[2,0]]", ""), "on 0,0 4,0 at 1.5 width 1");
    assert_eq!(place("[[2,0],[1,0]]", ""), "on 4,0 0,0 at 2.5 width 1", "the edge takes the line's direction");
    assert_eq!(place("[[4,0.5],[4.0008,1.5]]", ""), "on 4,0 4,3 at 1 width 1");
    assert_eq!(place("[[4,0.5],[4.01,1.5]]", ""), "free", "a centimetre off");
    assert_eq!(place("[[4,2.5],[4,3.5]]", ""), "free", "reaches beyond the edge");
    assert_eq!(place("[[1,0],[2,0]]", ", \"free\": true"), "free");
    let host = ", \"host\": {\"from\": [0,0], \"to\": [9,0], \"at_m\": 1.5, \"width_m\": 1}";
    assert_eq!(place("[[1,0],[2,0]]", host), "on 0,0 9,0 at 1.5 width 1");
    assert_eq!(place("[[2,0],[3,0]]", host), "on 0,0 4,0 at 2.5 width 1", "the line was moved: it counts");
}

proptest! {
    #[test]
    fn any_plan_has_the_same_features_after_geojson(plan in plans()) {
        let import = read(&written(&plan));
        // A room without a boundary, or of square kilometres, is told.
        let is_told = |note: &&enfilade::formats::Note| note.what.contains("no boundary") || note.what.contains("doubtful");
        prop_assert_eq!(import.notes.iter().filter(|note| !is_told(note)).collect::<Vec<_>>(), Vec::<&enfilade::formats::Note>::new());
        let read = &import.plans[0];
        prop_assert_eq!(kept(read), kept(&plan));
        prop_assert_eq!(features(read), features(&plan));
        prop_assert_eq!(written(read), written(&plan));
    }
}
