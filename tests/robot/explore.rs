//! A simulated robot in a plan: it explores everything by itself and finds the rooms.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test writes into a folder of its own")]

use std::collections::BTreeMap;
use std::sync::Arc;

use enfilade::geometry::{Point, Segment, Vector, areas, polygon};
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};
use enfilade::robot::explore::Activity;
use enfilade::robot::rooms::{FoundRooms, RoomOptions};
use enfilade::robot::score::{Fate, score};
use enfilade::robot::{Exploration, Pose, RobotOptions, World, WorldOptions};

/// Three rooms on a corridor with walls of 0.2 m and doors of 0.9 m, and a fourth behind the second,
/// moved by a turn and a shift.
fn house(turn_rad: f64, shift: Vector) -> Plan {
    let place = |(x, y): (f64, f64)| Point::default() + Vector::new(x, y).rotated(turn_rad) + shift;
    let mut builder = Builder::new(Meta::default());
    let rooms = [
        ((0.0, 0.0), (12.0, 2.0)),
        ((0.0, 2.0), (4.0, 6.0)),
        ((4.0, 2.0), (8.5, 6.0)),
        ((8.5, 2.0), (12.0, 6.0)),
        ((4.0, 6.0), (8.5, 9.0)),
    ];
    let mut edges: Vec<[(f64, f64); 2]> = Vec::new();
    for ((left, low), (right, high)) in rooms {
        let ring = [(left, low), (right, low), (right, high), (left, high)];
        let outer = builder.ring(ring.map(place));
        builder.room("", Room { outer, ..Room::default() });
        edges.extend((0..4).map(|i| [ring[i], ring[(i + 1) % 4]]));
    }
    for [a, b] in edges {
        let (from, to) = (builder.corner(place(a)), builder.corner(place(b)));
        builder.wall(from, to, 0.2);
    }
    for (middle, along) in
        [((2.0, 2.0), (1.0, 0.0)), ((6.0, 2.0), (1.0, 0.0)), ((10.0, 2.0), (1.0, 0.0)), ((6.5, 6.0), (1.0, 0.0))]
    {
        let half = Vector::new(along.0, along.1) * 0.45;
        let (from, to) = (place((middle.0 - half.x, middle.1 - half.y)), place((middle.0 + half.x, middle.1 + half.y)));
        builder.opening("", Opening::new(OpeningKind::Door, Place::Free { from, to }));
    }
    builder.finish().expect("a valid plan")
}

/// From the middle of the corridor.
fn start(turn_rad: f64, shift: Vector) -> Pose {
    let at = Point::default() + Vector::new(3.0, 1.0).rotated(turn_rad) + shift;
    Pose::new(at.x, at.y, turn_rad)
}

fn explored(world: &World, start: Pose, options: RobotOptions) -> (Exploration, FoundRooms) {
    let mut exploration = Exploration::new(Arc::new(world.clone()), start, options);
    assert_eq!(exploration.run(), Activity::Finished);
    let found = exploration.rooms(&RoomOptions::default());
    (exploration, found)
}

#[test]
fn a_robot_finds_all_rooms_and_doors_of_a_house() {
    let world = World::new(&house(0.0, Vector::default()), &WorldOptions::default());
    let start = start(0.0, Vector::default());
    let (exploration, found) = explored(&world, start, RobotOptions::default());
    let rooms: Vec<areas::Shapes> = found.rooms.iter().map(|room| moved(&room.shapes(), start)).collect();
    let edges: Vec<(usize, usize)> = found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
    let score = score(&world, start.position(), 0.3, &rooms, &edges);
    assert_eq!((score.count(Fate::Found), score.rooms.len(), score.invented.len()), (5, 5, 0), "{score:?}");
    assert_eq!((score.right_edges.len(), score.true_edges.len(), score.wrong_edges), (4, 4, 0));
    // The floor between the walls' faces.
    assert!(score.rooms.iter().all(|room| room.iou > 0.9), "{score:?}");
    let off_m = exploration
        .path
        .iter()
        .zip(exploration.poses())
        .map(|(step, estimate)| start.apply(estimate.position()).distance(step.true_pose.position()));
    assert!(off_m.fold(0.0, f64::max) < 0.1);
}

fn moved(shapes: &areas::Shapes, by: Pose) -> areas::Shapes {
    let point = |&[x, y]: &[f64; 2]| {
        let point = by.apply(Point::new(x, y));
        [point.x, point.y]
    };
    shapes.iter().map(|shape| shape.iter().map(|ring| ring.iter().map(point).collect()).collect()).collect()
}

#[test]
fn without_noise_the_map_is_the_walls() {
    let world = World::new(&house(0.0, Vector::default()), &WorldOptions::default());
    let start = start(0.0, Vector::default());
    let (exploration, _) = explored(&world, start, RobotOptions::default().exact());
    let map: Vec<Segment> = exploration
        .segments()
        .iter()
        .map(|segment| Segment::new(start.apply(segment.a), start.apply(segment.b)))
        .filter(|segment| segment.length() > 0.3)
        .collect();
    let walls = world.obstacles();
    for segment in &map {
        for i in 1..10 {
            let at = segment.a.lerp(segment.b, f64::from(i) / 10.0);
            assert!(walls.distance_m(at, 1.0) < 0.02, "{segment:?} is on no wall");
        }
    }
    // And of the walls' faces little is missing: those beside the doorway of a room that is seen whole from its
    // threshold. Faces too short for a map are not asked for.
    let (mut seen_m, mut all_m) = (0.0, 0.0);
    for wall in walls.segments().iter().filter(|wall| wall.length() > 0.3) {
        let count = (wall.length() / 0.05).ceil() as usize;
        for i in 0..count {
            let at = wall.a.lerp(wall.b, (i as f64 + 0.5) / count as f64);
            let piece_m = wall.length() / count as f64;
            all_m += piece_m;
            if map.iter().any(|segment| segment.distance(at) < 0.03) {
                seen_m += piece_m;
            }
        }
    }
    assert!(seen_m > 0.9 * all_m, "{seen_m} m of {all_m} m");
}

/// What a world and a robot moved by a rigid motion find is what they found before, moved.
#[test]
fn moving_the_world_moves_the_result() {
    let centres = |turn_rad: f64, shift: Vector| -> Vec<(f64, Point)> {
        let world = World::new(&house(turn_rad, shift), &WorldOptions::default());
        let start = start(turn_rad, shift);
        let (_, found) = explored(&world, start, RobotOptions::default().exact());
        found.rooms.iter().map(|room| (room.area_m2, polygon::centroid(&room.outer))).collect()
    };
    // Both in the robot's frame.
    let here = centres(0.0, Vector::default());
    assert_eq!(here.len(), 5);
    for (turn_rad, shift) in [(0.7, Vector::new(30.0, -12.0)), (-2.1, Vector::new(-5.0, 100.0))] {
        let there = centres(turn_rad, shift);
        assert_eq!(there.len(), here.len());
        // By place: two rooms lie above one another, so that no order by x holds.
        for one in &here {
            let other = there.iter().min_by(|p, q| p.1.distance(one.1).total_cmp(&q.1.distance(one.1))).unwrap();
            assert!((one.0 - other.0).abs() < 0.05 * one.0 + 0.1, "{one:?} {other:?}");
            assert!(one.1.distance(other.1) < 0.15, "{one:?} {other:?}");
        }
    }
}

#[test]
fn two_runs_give_the_same_and_another_seed_another_path() {
    let world = World::new(&house(0.0, Vector::default()), &WorldOptions { furniture: 2, ..WorldOptions::default() });
    let start = start(0.0, Vector::default());
    let run = |seed: u64| {
        let (exploration, found) = explored(&world, start, RobotOptions { seed, ..RobotOptions::default() });
        (exploration.path.clone(), exploration.segments(), found)
    };
    let (first, again, other) = (run(1), run(1), run(2));
    assert_eq!(first, again);
    assert_ne!(first.0, other.0);
}

#[test]
fn closed_doors_and_doors_ajar_hide_rooms() {
    let plan = house(0.0, Vector::default());
    let start = start(0.0, Vector::default());
    let rooms = |options: &WorldOptions| {
        let world = World::new(&plan, options);
        let (exploration, found) = explored(&world, start, RobotOptions::default());
        (found.rooms.len(), exploration.frontiers().len())
    };
    assert_eq!(rooms(&WorldOptions { closed_share: 1.0, ..WorldOptions::default() }), (1, 0));
    // Seen through, but nobody passes.
    assert_eq!(rooms(&WorldOptions { ajar_share: 1.0, ..WorldOptions::default() }).0, 1);
}

/// The whole command, twice: the same bytes.
#[test]
fn the_command_writes_map_plan_pictures_and_score() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let plan_file = folder.path().join("house.plan.json");
    let bytes = enfilade::formats::plan_json::to_bytes(&house(0.0, Vector::default()));
    std::fs::write(&plan_file, bytes).expect("written");
    let run = |name: &str| -> BTreeMap<String, Vec<u8>> {
        let output = folder.path().join(name);
        let words =
            ["explore".into(), plan_file.clone().into_os_string(), "-o".into(), output.clone().into_os_string()];
        let (code, _, errors) = crate::support::enfilade(words);
        assert_eq!((code, errors.as_str()), (0, ""));
        let files = std::fs::read_dir(&output).expect("a folder").map(|entry| entry.expect("an entry").path());
        files
            .map(|path| {
                let name = path.file_name().expect("a name").to_string_lossy().into_owned();
                (name, std::fs::read(&path).expect("read"))
            })
            .collect()
    };
    let first = run("one");
    let names: Vec<&str> = first.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        ["house.map.png", "house.map.svg", "house.plan.json", "house.rooms.png", "map.json", "poses.csv", "score.json"]
    );
    assert_eq!(first, run("two"));
    let found = enfilade::formats::plan_json::from_bytes(&first["house.plan.json"]).expect("a plan");
    assert_eq!((found.rooms().len(), found.openings().len()), (5, 4));
    assert!(found.rooms().all(|(_, room)| room.label.is_some()), "every room has a predicted label");
    let score: serde_json::Value = serde_json::from_slice(&first["score.json"]).expect("JSON");
    assert_eq!(score["rooms"]["found"], 5);
}
