//! What other programs write, and what they make of files of ours; what lies at the limits of both.

use enfilade::formats::{FORMATS, Import, Options, Source, geojson as format, read_file};
use enfilade::geometry::Point;
use enfilade::labels::Schemes;
use enfilade::plan::Plan;
use enfilade::topology::RoomShapes;
use proptest::prelude::*;

use super::generated::plans_at_the_limits;
use super::geojson::{kept, read, written};
use super::golden::fixture;

fn other(name: &str) -> Import {
    read_file(&fixture(&format!("others/{name}"))).unwrap()
}

fn notes(import: &Import) -> Vec<String> {
    import.notes.iter().map(ToString::to_string).collect()
}

/// How many rooms, walls and openings a plan has.
fn counts(import: &Import) -> (usize, usize, usize) {
    let plan = &import.plans[0];
    (plan.rooms().len(), plan.walls().len(), plan.openings().len())
}

fn areas(plan: &Plan) -> Vec<f64> {
    RoomShapes::new(plan).all().iter().map(|shape| (shape.area_m2() * 1e4).round() / 1e4).collect()
}

fn door(plan: &Plan) -> [Point; 2] {
    let (_, opening) = plan.openings().next().unwrap();
    let segment = plan.opening_segment(opening).unwrap();
    let mut ends = [segment.a, segment.b];
    ends.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
    ends.map(Point::trimmed)
}

/// A file in metres with these features.
fn with_features(features: &[&str]) -> String {
    format!(r#"{{"type": "FeatureCollection", "units": "m", "features": [{}]}}"#, features.join(",\n"))
}

const ROOM: &str = r#"{"type": "Feature", "id": "A", "geometry": {"type": "Polygon", "coordinates": [[[0,0],[4,0],[4,3],[0,3],[0,0]]]}, "properties": {"kind": "room"}}"#;

#[test]
fn qgis_writes_lines_and_areas_as_multi() {
    let import = other("lines-as-multi.geojson");
    assert_eq!(counts(&import), (2, 1, 1));
    assert_eq!(notes(&import), [] as [&str; 0]);
    assert_eq!(door(&import.plans[0]), [Point::new(4.0, 1.0), Point::new(4.0, 1.9)]);
}

#[test]
fn a_multi_line_of_two_parts_is_two_walls_or_doors_and_pieces_are_one() {
    let wall = r#"{"type": "Feature", "geometry": {"type": "MultiLineString", "coordinates": [[[0,0],[4,0]],[[6,0],[8,0],[8,3]]]}, "properties": {"kind": "wall", "thickness_m": 0.1}}"#;
    let doors = r#"{"type": "Feature", "id": "d", "geometry": {"type": "MultiLineString", "coordinates": [[[1,0],[2,0]],[[3,0],[3.5,0]]]}, "properties": {"opening": "door"}}"#;
    let pieces = r#"{"type": "Feature", "id": "e", "geometry": {"type": "MultiLineString", "coordinates": [[[7,0],[6.5,0]],[[7,0],[7.5,0]]]}, "properties": {"opening": "door"}}"#;
    let import = read(&with_features(&[wall, doors, pieces]));
    assert_eq!(counts(&import), (0, 3, 3));
    assert_eq!(notes(&import), ["healed: line 2, feature d: has 2 parts; each becomes an opening"]);
    let points = r#"{"type": "Feature", "id": "d", "geometry": {"type": "MultiPoint", "coordinates": [[2,0],[0,2]]}, "properties": {"opening": "door"}}"#;
    assert_eq!(counts(&read(&with_features(&[ROOM, points]))), (1, 0, 2));
}

#[test]
fn truths_that_geopandas_made_numbers_are_read() {
    let import = other("geopandas-round-trip.geojson");
    assert_eq!(counts(&import), (2, 0, 1));
    assert_eq!(notes(&import), [] as [&str; 0]);
    let (_, room) = import.plans[0].rooms().next().unwrap();
    assert!(["A", "B"].contains(&room.source_id.as_str()), "the id among the properties is the room's");
    // With the rooms it joins, by the ids that moved to the properties.
    let text = std::fs::read_to_string(fixture("others/geopandas-round-trip.geojson")).unwrap();
    let joined = read(&text.replace("\"pinned\": 0.0", "\"pinned\": 1.0, \"rooms\": [\"A\", \"B\"]"));
    assert!(joined.plans[0].openings().next().unwrap().1.pinned.is_some());
    let strange = read(&text.replace("\"pinned\": 0.0", "\"pinned\": 7"));
    assert_eq!(
        notes(&strange),
        ["healed: line 5, feature d: its property 'pinned' is 7, not true or false; passed over"]
    );
}

#[test]
fn rooms_may_be_closed_lines_or_lie_in_a_collection() {
    let line = other("room-as-closed-line.geojson");
    assert_eq!(areas(&line.plans[0]), [12.0]);
    assert!(notes(&line)[0].contains("its boundary is a LineString"), "{:?}", notes(&line));
    let collection = other("room-in-a-geometrycollection.geojson");
    assert_eq!(areas(&collection.plans[0]), [12.0]);
    assert!(notes(&collection)[0].contains("GeometryCollection of 1 area and 1 point"), "{:?}", notes(&collection));
    // A boundary in pieces, with a hole.
    let rings = r#"{"type": "Feature", "id": "A", "geometry": {"type": "MultiLineString", "coordinates": [[[0,0],[4,0],[4,3]],[[0,0],[0,3],[4,3]],[[1,1],[2,1],[2,2],[1,2],[1,1]]]}, "properties": {"kind": "room"}}"#;
    assert_eq!(areas(&read(&with_features(&[rings])).plans[0]), [11.0]);
    // What bounds nothing is named for what it is.
    let open = r#"{"type": "Feature", "id": "A", "geometry": {"type": "MultiPoint", "coordinates": [[0,0],[4,0]]}, "properties": {"kind": "room"}}"#;
    let import = read(&with_features(&[open]));
    assert_eq!(
        notes(&import),
        ["healed: line 1, feature A: its geometry is a MultiPoint, which bounds no area; kept without a boundary"]
    );
}

#[test]
fn millimetres_are_doubted() {
    let import = other("millimetres-without-units.geojson");
    let [note] = &notes(&import)[..] else { panic!("{:?}", notes(&import)) };
    assert!(note.contains("which is doubtful: its largest room would have 12\u{a0}000\u{a0}000 m²"), "{note}");
    assert!(note.contains("an opening would be 900 m wide; the numbers look like millimetres"), "{note}");
    assert!(!note.contains("as the sizes suggest"));
    // Those who say metres are believed as long as there is such a room.
    let text = std::fs::read_to_string(fixture("others/millimetres-without-units.geojson")).unwrap();
    let stated = text.replacen('{', "{\"units\": \"m\", ", 1);
    assert!(notes(&read(&stated))[0].contains("says that it is in metres, which is doubtful"));
    let hall = stated.replace("4000", "400").replace("3000", "300").replace("8000", "800");
    assert_eq!(notes(&read(&hall.replace("1000", "100").replace("1900", "102"))), [] as [&str; 0]);
}

#[test]
fn a_door_that_is_a_point_slides_along_its_wall() {
    let import = other("point-door-beyond-the-building.geojson");
    assert_eq!(door(&import.plans[0]), [Point::new(4.0, 0.0), Point::new(4.0, 0.9)]);
    assert_eq!(
        notes(&import),
        ["healed: line 5, feature d: has no width; taken as 0.9 m, moved 0.35 m along its wall to fit"]
    );
    let placed = |point: &str, more: &str| {
        let door = format!(
            r#"{{"type": "Feature", "id": "d", "geometry": {{"type": "Point", "coordinates": {point}}}, "properties": {{"opening": "door"{more}}}}}"#
        );
        let import = read(&with_features(&[ROOM, &door]));
        (door_of(&import.plans[0]), notes(&import).concat())
    };
    fn door_of(plan: &Plan) -> String {
        let [a, b] = door(plan);
        format!("{},{} {},{}", a.x, a.y, b.x, b.y)
    }
    assert_eq!(placed("[2, 0]", "").0, "1.55,0 2.45,0");
    let (place, note) = placed("[3.9, 0.05]", "");
    assert_eq!(place, "3.1,0 4,0");
    assert!(note.contains("has no width; taken as 0.9 m, put on its wall, 0.050 m away"), "{note}");
    assert_eq!(placed("[3.9, 0.05]", ", \"free\": true").0, "3.45,0.05 4.35,0.05");
    assert_eq!(placed("[2, -5]", "").0, "1.55,-5 2.45,-5", "too far from any wall");
    assert_eq!(placed("[2, -5]", ", \"rooms\": [\"A\", null]").0, "1.55,0 2.45,0", "the room is known");
}

#[test]
fn coordinate_reference_systems_are_named() {
    let of = |crs: &str, units: &str, x: f64, y: f64| {
        let text = format!(
            r#"{{"type": "FeatureCollection", {units}"crs": {{"type": "name", "properties": {{"name": "{crs}"}}}}, "features": [
{{"type": "Feature", "id": "A", "geometry": {{"type": "Polygon", "coordinates": [[[{x},{y}],[{0},{y}],[{0},{1}],[{x},{1}],[{x},{y}]]]}}, "properties": {{"kind": "room"}}}}]}}"#,
            x + 4.0,
            y + 3.0
        );
        format::from_bytes(text.as_bytes(), "")
    };
    for (crs, words) in [
        ("urn:ogc:def:crs:OGC:1.3:CRS84", "is in longitude and latitude (CRS84);"),
        ("EPSG:4326", "is in longitude and latitude (EPSG:4326);"),
        ("urn:ogc:def:crs:EPSG::4258", "is in longitude and latitude (EPSG:4258);"),
        ("EPSG:3857", "is in Web Mercator (EPSG:3857), whose metres are true at the equator only;"),
    ] {
        let error = of(crs, "", 0.0, 0.0).unwrap_err().to_string();
        assert!(error.starts_with(words), "{error}");
        let import = of(crs, "\"units\": \"m\", ", 0.0, 0.0).unwrap();
        assert!(notes(&import)[0].contains("but is in metres, as it says"), "{:?}", notes(&import));
    }
    let utm = of("urn:ogc:def:crs:EPSG::32632", "", 691_604.25, 5_334_762.5).unwrap();
    assert_eq!(areas(&utm.plans[0]), [12.0]);
    assert_eq!(
        notes(&utm),
        [
            "healed: file: is in UTM zone 32 north (EPSG:32632), in metres",
            "healed: file: lies far from the origin, as in a map; moved by (-691600.0, -5334700.0) m, so that (0, 0) is \
             (691600.0, 5334700.0) there",
        ]
    );
    let foreign = ROOM.replace("\"kind\": \"room\"", "").replace("4,3", "4000,3");
    let foreign = format!(r#"{{"type": "FeatureCollection", "features": [{foreign}]}}"#);
    let error = format::from_bytes(foreign.as_bytes(), "").unwrap_err().to_string();
    assert!(error.starts_with("names no units, and its numbers are no longitude and latitude; "), "{error}");
    let unknown = of("EPSG:2263", "", 0.0, 0.0).unwrap();
    assert!(notes(&unknown)[0].contains("the coordinate reference system EPSG:2263, which says nothing here"));
}

#[test]
fn one_feature_that_cannot_be_read_costs_that_feature() {
    let features = [
        ROOM,
        "12",
        r#"{"type": "Feature", "id": "B", "geometry": {"type": "Polygon", "coordinates": [[[4,0],[8,0],[8,null],[4,3]]]}, "properties": {"kind": "room"}}"#,
        r#"{"type": "Feature", "id": "C", "geometry": {"type": "Circle", "coordinates": [4,0]}, "properties": {"kind": "room"}}"#,
        r#"{"type": "Feature", "id": "D", "geometry": {"type": "Polygon", "coordinates": [[[4,0],[8,0],[1e9,3],[4,3]]]}, "properties": {"kind": "room"}}"#,
        r#"{"type": "Feature", "id": "A", "geometry": {"type": "Polygon", "coordinates": [[[4,0],[8,0],[8,3],[4,3],[4,0]]]}, "properties": {"kind": "room"}}"#,
    ];
    let import = read(&with_features(&features));
    assert_eq!(areas(&import.plans[0]), [12.0, 12.0]);
    assert_eq!(
        notes(&import),
        [
            "skipped: line 2, feature number 2: invalid type: integer `12`, expected a feature; left out",
            "skipped: line 3, feature B: invalid type: null, expected a number; left out",
            "skipped: line 4, feature C: its geometry is of the type 'Circle', which GeoJSON does not have; left out",
            "skipped: line 5, feature D: the position (1000000000.0, 3.0) lies beyond ±100000 m; left out",
            "healed: line 6, feature A: its id is in the file twice; kept under one of its own",
        ]
    );
}

/// Programs write JSON on one line: an error names the element that it lies in, not the first of the line.
#[test]
fn elements_are_named_rightly_where_all_stands_on_one_line() {
    let plan = std::fs::read_to_string(fixture("others/at-the-edge.plan.json")).unwrap().replace('\n', "");
    for (from, to, element) in [
        ("\"x\":8,\"y\":4", "\"x\":8,\"y\":\"4\"", "corner ce2pgk1h9wrwf"),
        ("\"thickness\":0.12", "\"thickness\":null", "wall wfr862538mdje"),
        ("\"function\":\"living_room\"", "\"function\":[]", "room r0000000parxr"),
        ("\"at\":0,", "\"at\":{},", "opening of605hgey4qyp"),
    ] {
        let broken = plan.replace(from, to);
        assert_ne!(broken, plan, "{from}");
        let error = enfilade::formats::plan_json::from_bytes(broken.as_bytes()).unwrap_err();
        assert_eq!((error.place.line, error.place.element.as_str()), (Some(1), element), "{error}");
    }
    let door = r#"{"type": "Feature", "properties": {"kind": "opening", "id": "inner"}, "geometry": {"type": "LineString", "coordinates": [[1,0],[2,"0"]]}, "id": "d"}"#;
    let import = read(&with_features(&[ROOM, door]).replace('\n', " "));
    assert!(notes(&import)[0].starts_with("skipped: line 1, feature d: "), "{:?}", notes(&import));
}

#[test]
fn guides_beyond_the_limit_are_told() {
    let import = other("guides-1001.plan.json");
    assert_eq!(import.plans[0].guides().len(), 1000);
    assert_eq!(
        notes(&import),
        [
            "skipped: guides: 1 more than the 1000 that a plan may have; the last is left out, and gone from the file when it is saved"
        ]
    );
}

#[test]
fn an_opening_beyond_the_edge_of_the_drawing_area_comes_back() {
    let plan = other("at-the-edge.plan.json").plans.remove(0);
    let again = read(&written(&plan));
    assert_eq!(notes(&again), [] as [&str; 0]);
    assert_eq!(kept(&again.plans[0]), kept(&plan));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    /// What can be saved can be exported and read back, in every format that is written and read.
    #[test]
    fn every_format_reads_what_it_writes_at_the_limits(plan in plans_at_the_limits()) {
        let schemes = Schemes::bundled();
        for format in FORMATS {
            let (Some(importer), Some(exporter)) = (format.importer, format.exporter) else { continue };
            let named = enfilade::formats::NamedPlan { stem: "x", plan: &plan };
            let export = exporter.write(&[named], &schemes, &Options::default()).unwrap();
            for file in &export.files {
                let source = Source::File { stem: "x", bytes: &file.bytes };
                let import = importer.read(&source, &Options::default());
                let import = import.map_err(|error| TestCaseError::fail(format!("{}: {error}", format.id)))?;
                let read = &import.plans[0];
                prop_assert_eq!(read.rooms().len(), plan.rooms().len(), "{}: {:?}", format.id, notes(&import));
                prop_assert_eq!(read.walls().len(), plan.walls().len(), "{}: {:?}", format.id, notes(&import));
                prop_assert_eq!(read.openings().len(), plan.openings().len(), "{}: {:?}", format.id, notes(&import));
                for (id, opening) in plan.openings() {
                    let there = read.opening(id).and_then(|opening| read.opening_segment(opening));
                    let (there, here) = (there.unwrap(), plan.opening_segment(opening).unwrap());
                    prop_assert!(there.a.distance(here.a) < 2e-3 && there.b.distance(here.b) < 2e-3, "{}", format.id);
                }
            }
        }
    }
}
