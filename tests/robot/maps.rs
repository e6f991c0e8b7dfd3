//! `enfilade segment`: rooms of grid maps, from files to files, and invalid maps.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

use std::collections::BTreeSet;
use std::path::Path;

use crate::support::{Picture, enfilade};
use enfilade::geometry::{Point, polygon};
use enfilade::robot::semantics::SemanticMap;
use enfilade::store::load_plan;

const YAML: &str = "image: floor.pgm\nresolution: 0.05\norigin: [-2.0, 1.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

/// Two rooms of 4 m by 5 m with a door of 0.9 m between them, a table's legs in the left one; 200 by 120 cells
/// and `wider` more at the right end, which is unknown.
fn two_rooms(folder: &Path, wider: usize) {
    let (width, height) = (200 + wider, 120);
    let mut bytes = format!("P5\n{width} {height}\n255\n").into_bytes();
    for y in 0..height {
        for x in 0..width {
            let in_rooms = (10..90).contains(&x) || (94..174).contains(&x);
            let in_door = (90..94).contains(&x) && (50..68).contains(&y);
            let is_leg =
                [(40, 40), (60, 40), (40, 60), (60, 60)].iter().any(|&(lx, ly)| x / 2 == lx / 2 && y / 2 == ly / 2);
            let inside = (10..110).contains(&y) && (in_rooms || in_door) && !is_leg;
            let near = (8..112).contains(&y) && (8..176).contains(&x);
            bytes.push(if inside {
                254
            } else if near {
                0
            } else {
                205
            });
        }
    }
    std::fs::write(folder.join("floor.pgm"), bytes).unwrap();
    std::fs::write(folder.join("floor.yaml"), YAML).unwrap();
}

fn segment(folder: &Path, more: &[&str]) -> (u8, String, String) {
    let (map, out) = (folder.join("floor.yaml"), folder.join("out"));
    let words = ["segment", map.to_str().unwrap(), "-o", out.to_str().unwrap()];
    enfilade(words.iter().copied().chain(more.iter().copied()))
}

fn semantics(folder: &Path) -> SemanticMap {
    SemanticMap::from_yaml(&std::fs::read_to_string(folder.join("out/floor_semantics.yaml")).unwrap()).unwrap()
}

#[test]
fn two_rooms_and_their_door_are_found_in_the_maps_frame() {
    let folder = tempfile::tempdir().unwrap();
    two_rooms(folder.path(), 0);
    let (code, out, err) = segment(folder.path(), &["--typology", "office"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.contains("2 rooms, 1 doorway, typology office"), "{out}");
    let map = semantics(folder.path());
    assert_eq!((map.frame.as_str(), map.map.as_str(), map.origin), ("map", "floor.yaml", [-2.0, 1.0, 0.0]));
    for room in &map.rooms {
        assert!((room.area - 20.0).abs() < 1.0, "{}", room.area);
        assert!("SMBCH".contains(&room.label) && !room.label.is_empty());
        let ring: Vec<Point> = room.polygon.iter().map(|&[x, y]| Point::new(x, y)).collect();
        let centre = Point::new(room.centre[0], room.centre[1]);
        assert_eq!(polygon::locate_in_ring(&ring, centre), polygon::Location::Inside);
    }
    let door = &map.doors[0];
    assert!((0.8..1.1).contains(&door.width), "{}", door.width);
    // Between x = 90 and 94 cells, y = 50 and 68 from the top.
    let middle = [(door.ends[0][0] + door.ends[1][0]) / 2.0, (door.ends[0][1] + door.ends[1][1]) / 2.0];
    assert!((middle[0] - (-2.0 + 92.0 * 0.05)).abs() < 0.15 && (middle[1] - (1.0 + 61.0 * 0.05)).abs() < 0.15);
    for side in &door.sides {
        let room = map.rooms.iter().find(|room| room.id == side.room).unwrap();
        let ring: Vec<Point> = room.polygon.iter().map(|&[x, y]| Point::new(x, y)).collect();
        let at = Point::new(side.pose[0], side.pose[1]);
        assert_eq!(polygon::locate_in_ring(&ring, at), polygon::Location::Inside);
        let ahead = Point::new(at.x + 0.5 * side.pose[2].cos(), at.y + 0.5 * side.pose[2].sin());
        assert!(ahead.distance(Point::new(middle[0], middle[1])) < 0.01, "looks at the door");
    }
    let plan = load_plan(&folder.path().join("out/floor.plan.json")).unwrap();
    assert_eq!((plan.rooms().count(), plan.openings().count()), (2, 1));
    let picture = Picture::decode(&std::fs::read(folder.path().join("out/segmentation.png")).unwrap());
    let colours: BTreeSet<&[u8]> = picture.rgba.chunks_exact(4).collect();
    assert_eq!((picture.width, picture.height, colours.len()), (200, 120, 3));
    // The legs of the table are part of their room.
    let at = |x: usize, y: usize| &picture.rgba[4 * (y * 200 + x)..][..4];
    assert_eq!(at(40, 40), at(20, 20));
    // The map written for map_server is the one that was read.
    let copy = std::fs::read(folder.path().join("out/floor.pgm")).unwrap();
    assert!(copy == std::fs::read(folder.path().join("floor.pgm")).unwrap());
}

#[test]
fn ids_names_and_functions_stay_when_the_map_is_updated() {
    let folder = tempfile::tempdir().unwrap();
    two_rooms(folder.path(), 0);
    assert_eq!(segment(folder.path(), &[]).0, 0);
    let path = folder.path().join("out/floor_semantics.yaml");
    let first = std::fs::read(&path).unwrap();
    assert_eq!(segment(folder.path(), &[]).0, 0);
    assert!(first == std::fs::read(&path).unwrap(), "the same map gives the same bytes");

    let mut named = semantics(folder.path());
    named.rooms[0].name = "Ada".to_owned();
    named.rooms[0].function = "office".to_owned();
    std::fs::write(&path, named.to_yaml().unwrap()).unwrap();
    // A larger picture with another origin, the rooms shifted by a cell.
    two_rooms(folder.path(), 7);
    let moved = YAML.replace("[-2.0, 1.0, 0.0]", "[-1.95, 1.05, 0.0]");
    std::fs::write(folder.path().join("floor.yaml"), moved).unwrap();
    let (code, out, err) = segment(folder.path(), &[]);
    assert!(code == 0 && out.contains("2 of the rooms known from before"), "{out}{err}");
    let updated = semantics(folder.path());
    let ids = |map: &SemanticMap| map.rooms.iter().map(|room| room.id.clone()).collect::<BTreeSet<_>>();
    assert_eq!(ids(&updated), ids(&named));
    assert_eq!(updated.doors[0].id, named.doors[0].id);
    assert_ne!(updated.rooms[0].polygon, named.rooms[0].polygon);
    let ada = updated.rooms.iter().find(|room| room.name == "Ada").unwrap();
    assert_eq!((&ada.id, ada.function.as_str()), (&named.rooms[0].id, "office"));
}

#[test]
fn what_is_no_map_is_refused_with_file_reason_and_help() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |yaml: &str, picture: Option<&[u8]>, words: &[&str]| {
        let _ = std::fs::remove_file(folder.path().join("floor.pgm"));
        if let Some(bytes) = picture {
            std::fs::write(folder.path().join("floor.pgm"), bytes).unwrap();
        }
        std::fs::write(folder.path().join("floor.yaml"), yaml).unwrap();
        let (code, _, err) = segment(folder.path(), &[]);
        assert_eq!(code, 1, "{err}");
        for word in words {
            assert!(err.contains(word), "'{word}' in: {err}");
        }
        assert!(!folder.path().join("out").exists());
    };
    refused("a: [", None, &["floor.yaml", "no map"]);
    refused("", None, &["floor.yaml", "image, resolution and origin"]);
    refused(YAML, None, &["floor.pgm", "does not exist"]);
    refused(&YAML.replace("floor.pgm", "../floor.pgm"), None, &["not in the map's folder"]);
    refused(YAML, Some(b"hello"), &["floor.pgm", "picture"]);
    refused(YAML, Some(b"P5\n20000 20000\n255\n\x00"), &["20000 x 20000", "more than can be held"]);
    refused(YAML, Some(b"P5\n200 200\n255\n\x00"), &["floor.pgm"]);
    refused(&YAML.replace("0.05", "-1"), Some(b"P5\n1 1\n255\n\xfe"), &["resolution"]);
    let picture = folder.path().join("floor.pgm");
    let (code, _, err) = enfilade(["segment", picture.to_str().unwrap(), "-o", "nowhere"]);
    assert!(code == 2 && err.contains("--resolution"), "{err}");
}

#[test]
fn a_map_of_one_pixel_has_no_rooms() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("floor.pgm"), b"P5\n1 1\n255\n\xfe").unwrap();
    std::fs::write(folder.path().join("floor.yaml"), YAML).unwrap();
    let (code, out, err) = segment(folder.path(), &[]);
    assert!(code == 0 && out.contains("0 rooms, 0 doorways"), "{out}{err}");
}

#[test]
fn a_broken_semantic_map_is_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    two_rooms(folder.path(), 0);
    std::fs::create_dir(folder.path().join("out")).unwrap();
    let path = folder.path().join("out/floor_semantics.yaml");
    std::fs::write(&path, "rooms: 7\n").unwrap();
    let (code, _, err) = segment(folder.path(), &[]);
    assert!(code == 1 && err.contains("no semantic map") && err.contains("move it away"), "{err}");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "rooms: 7\n");
}

#[test]
fn all_rooms_of_a_real_floor_are_found_furnished_or_not() {
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/robot/maps");
    if !maps.is_dir() {
        println!("skipped: no maps under {}", maps.display());
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (map, rooms) in [("office_c.png", 34), ("office_c_furnitures.png", 34)] {
        let (path, out) = (maps.join(map), folder.path().join(map));
        let words = ["segment", path.to_str().unwrap(), "--resolution", "0.05", "-o", out.to_str().unwrap()];
        let (code, said, err) = enfilade(words);
        assert!(code == 0 && said.contains(&format!(": {rooms} rooms")), "{said}{err}");
    }
}

/// Robots read YAML by other readers (yaml-cpp, PyYAML), some of which take an unquoted `no` for false and `12:30` for 750.
#[test]
fn names_that_other_readers_would_misread_are_quoted() {
    let folder = tempfile::tempdir().unwrap();
    two_rooms(folder.path(), 0);
    assert_eq!(segment(folder.path(), &[]).0, 0);
    let mut map = semantics(folder.path());
    for name in [
        "no",
        "on",
        "y",
        "12:30",
        "1_000",
        "null",
        "~",
        "0x10",
        "1e3",
        "017",
        "2026-01-01",
        ".inf",
        "true",
        "# b",
        "a: b",
        " x",
    ] {
        map.rooms[0].name = name.to_owned();
        let yaml = map.to_yaml().unwrap();
        assert!(yaml.contains(&format!("name: \"{name}\"\n")), "{name}: {yaml:.400}");
        assert_eq!(SemanticMap::from_yaml(&yaml).unwrap(), map);
    }
    // What map_server of ROS 2 asks for (nav2_map_server, map_io.cpp): these keys, the origin of three numbers.
    let yaml = std::fs::read_to_string(folder.path().join("out/floor.yaml")).unwrap();
    for key in [
        "image: floor.pgm",
        "resolution: 0.05",
        "origin:\n- -2.0\n- 1.0\n- 0.0\n",
        "negate: 0",
        "occupied_thresh: 0.65",
        "free_thresh: 0.196",
        "mode: trinary",
        "semantics: floor_semantics.yaml",
    ] {
        assert!(yaml.contains(key), "{key}: {yaml}");
    }
}
