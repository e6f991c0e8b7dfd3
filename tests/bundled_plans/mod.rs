//! The bundled plans: they match their drawings, and describe architecture that could be built.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod doors;
#[path = "../../examples/draw_bundled_plans/drawings/mod.rs"]
mod drawings;
mod layout;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use enfilade::features::{NeighbourLabels, RoomStatus, analyse};
use enfilade::formats::plan_json;
use enfilade::geometry::Segment;
use enfilade::labels::{Label, Schemes};
use enfilade::plan::{Joint, Plan, RoomId, ScaleOrigin};
use enfilade::store::load_plan;
use enfilade::topology::{Graph, RoomShapes};

/// The bundled plans by the names of their files.
const FILES: [&str; 3] = ["dwelling.plan.json", "office.plan.json", "school.plan.json"];

fn path(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("plans").join(file)
}

/// Every bundled plan, as read from its file, with the file's name.
fn plans() -> Vec<(&'static str, Plan)> {
    FILES.into_iter().map(|file| (file, load_plan(&path(file)).unwrap())).collect()
}

fn name(plan: &Plan, id: RoomId) -> String {
    plan.room(id).unwrap().name.clone()
}

fn room_called(plan: &Plan, name: &str) -> RoomId {
    plan.rooms().find(|(_, room)| room.name == name).unwrap_or_else(|| panic!("no room '{name}'")).0
}

#[test]
fn the_files_are_what_is_drawn() {
    let drawn = drawings::all().unwrap();
    assert_eq!(drawn.iter().map(|(file, _)| *file).collect::<Vec<_>>(), FILES);
    for (file, plan) in drawn {
        let bytes = plan_json::to_bytes(&plan);
        assert!(
            std::fs::read(path(file)).unwrap() == bytes,
            "plans/{file} is not what is drawn: cargo run --example draw_bundled_plans"
        );
        assert_eq!(plan_json::from_bytes(&bytes).unwrap(), plan, "{file}");
    }
}

#[test]
fn what_is_known_of_each_plan() {
    for (file, plan) in plans() {
        assert_eq!(plan.violations(), [], "{file}");
        let meta = plan.meta();
        for text in [&meta.name, &meta.building, &meta.storey] {
            assert!(!text.is_empty(), "{file}");
        }
        assert_eq!(meta.scale.origin, ScaleOrigin::Drawn, "{file}");
        assert_eq!(
            (meta.source.as_str(), meta.licence.as_str()),
            ("Drawn for Enfilade", "MIT OR Apache-2.0"),
            "{file}"
        );
        let names: BTreeSet<&str> = plan.rooms().map(|(_, room)| room.name.as_str()).collect();
        assert_eq!(names.len(), plan.rooms().len(), "{file}: every room has a name of its own");
        assert!(!names.contains(""), "{file}");
    }
}

/// The openings of a plan in words, sorted: kind, clear width, the rooms joined.
fn openings_in_words(plan: &Plan) -> String {
    let shapes = RoomShapes::new(plan);
    let side = |joint: Joint| joint.room().map_or("outside".to_owned(), |id| name(plan, id));
    let mut lines: Vec<String> = Graph::new(plan, &shapes)
        .connections()
        .iter()
        .map(|connection| {
            let opening = plan.opening(connection.opening).unwrap();
            let mut sides = connection.sides.map(side);
            sides.sort();
            let width_m = plan.opening_segment(opening).unwrap().length();
            format!("{} - {}: {} {width_m:.1} m", sides[0], sides[1], opening.kind.name())
        })
        .collect();
    lines.sort();
    lines.iter().fold(String::new(), |mut text, line| {
        let _ = writeln!(text, "{line}");
        text
    })
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's output is no user's file")]
fn the_rooms_are_joined_as_intended() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bundled_plans");
    let mut different = Vec::new();
    for (file, plan) in plans() {
        let golden = folder.join(file.replace("plan.json", "openings.txt"));
        let out = golden.with_extension("out.txt");
        let actual = openings_in_words(&plan);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(&golden, &actual).unwrap();
        }
        if std::fs::read_to_string(&golden).unwrap_or_default() == actual {
            let _ = std::fs::remove_file(&out);
        } else {
            std::fs::write(&out, &actual).unwrap();
            different.push(out);
        }
    }
    assert!(different.is_empty(), "look at {different:?}, then run with UPDATE_GOLDEN=1");
}

#[test]
fn every_room_can_be_reached_from_outside() {
    for (file, plan) in plans() {
        let shapes = RoomShapes::new(&plan);
        let graph = Graph::new(&plan, &shapes);
        for connection in graph.connections() {
            assert!(!connection.pinned && !connection.joins_nothing(), "{file}: {connection:?}");
        }
        let mut reached = BTreeSet::from([Joint::Outside]);
        loop {
            let before = reached.len();
            for connection in graph.connections() {
                if connection.sides.iter().any(|side| reached.contains(side)) {
                    reached.extend(connection.sides);
                }
            }
            if reached.len() == before {
                break;
            }
        }
        let unreached: Vec<String> = plan
            .rooms()
            .filter(|(id, _)| !reached.contains(&Joint::Room(*id)))
            .map(|(id, _)| name(&plan, id))
            .collect();
        assert_eq!(unreached, Vec::<String>::new(), "{file}");
    }
}

#[test]
fn every_function_is_known_and_the_numbers_are_as_planned() {
    let schemes = Schemes::bundled();
    // Rooms, of them not classified (terraces and courts), and by label S, M, B, C, H.
    let planned = BTreeMap::from([
        ("dwelling.plan.json", (15, 2, [5, 4, 2, 1, 1])),
        ("office.plan.json", (39, 1, [15, 14, 4, 3, 2])),
        ("school.plan.json", (29, 1, [14, 6, 4, 2, 2])),
    ]);
    for (file, plan) in plans() {
        let mut by_label = [0; 5];
        let mut not_classified = 0;
        for (_, room) in plan.rooms() {
            match RoomStatus::of(&plan, &schemes, room) {
                RoomStatus::Labelled(label) => by_label[label.index()] += 1,
                RoomStatus::NotClassified => not_classified += 1,
                RoomStatus::Unlabelled => panic!("{file}: '{}' is not in the scheme", room.function),
            }
        }
        assert_eq!((plan.rooms().len(), not_classified, by_label), planned[file], "{file}");
    }
}

/// Mean and standard deviation of the area in m² of S, M, B, C, H (paper, table 2).
fn table_2(typology: &str) -> [(f64, f64); 5] {
    match typology {
        "house" => [(6.0, 2.6), (17.4, 4.8), (33.7, 7.8), (14.0, 11.4), (61.5, 25.1)],
        "school" => [(10.0, 9.7), (54.8, 14.8), (102.9, 22.3), (36.1, 42.2), (205.1, 172.9)],
        "office" => [(4.5, 2.3), (18.5, 14.4), (31.3, 12.2), (30.5, 25.7), (106.9, 84.5)],
        other => panic!("the paper has no {other}"),
    }
}

#[test]
fn areas_are_those_of_the_typology() {
    let schemes = Schemes::bundled();
    for (file, plan) in plans() {
        let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
        let table = table_2(plan.meta().typology.as_ref().unwrap().as_str());
        let mut areas: BTreeMap<Label, Vec<f64>> = BTreeMap::new();
        for room in &analysis.rooms {
            let Some(label) = room.status.label() else { continue };
            let area_m2 = room.features.unwrap().area_m2;
            areas.entry(label).or_default().push(area_m2);
            let (mean, deviation) = table[label.index()];
            // A staircase for two flights cannot be smaller than about 15 m², which the paper's
            // small rooms of offices hardly reach.
            let is_stairs = plan.room(room.id).unwrap().function == "stairs";
            let range = if is_stairs { 15.0..=30.0 } else { 1.5..=mean + 3.0 * deviation };
            assert!(range.contains(&area_m2), "{file}: {} has {area_m2} m²", name(&plan, room.id));
        }
        for (label, areas) in areas {
            let (mean, deviation) = table[label.index()];
            let ours = areas.iter().sum::<f64>() / areas.len() as f64;
            assert!((ours - mean).abs() <= 2.0 * deviation, "{file}: {label} has {ours} m² on average");
        }
    }
}

#[test]
fn the_dwelling_has_its_enfilade() {
    let plan = load_plan(&path("dwelling.plan.json")).unwrap();
    let shapes = RoomShapes::new(&plan);
    let graph = Graph::new(&plan, &shapes);
    let suite = ["Study", "Entrance hall", "Dining room", "Living room"].map(|name| room_called(&plan, name));
    let doors: Vec<Segment> = suite
        .windows(2)
        .map(|pair| {
            let sides = BTreeSet::from([Joint::Room(pair[0]), Joint::Room(pair[1])]);
            let door = graph.connections().iter().find(|connection| BTreeSet::from(connection.sides) == sides).unwrap();
            plan.opening_segment(plan.opening(door.opening).unwrap()).unwrap()
        })
        .collect();
    for door in &doors {
        assert_eq!(door.midpoint().y, doors[0].midpoint().y, "the doors stand in one line");
    }
}

#[test]
fn among_the_rooms_are_oblique_ones_and_rings() {
    let (mut oblique, mut with_holes) = (0, 0);
    for (_, plan) in plans() {
        for shape in RoomShapes::new(&plan).all() {
            let is_oblique = enfilade::geometry::polygon::edges(&shape.outer).any(|edge| {
                let along = edge.vector();
                along.x.abs().min(along.y.abs()) > 0.1
            });
            oblique += usize::from(is_oblique);
            with_holes += usize::from(!shape.holes.is_empty());
        }
    }
    assert!(oblique >= 10 && with_holes == 2, "{oblique} oblique rooms, {with_holes} with a hole");
}
