//! `enfilade explore` on plans that nobody would draw: it ends, or says why it cannot begin.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

use std::sync::Arc;

use enfilade::geometry::{Point, areas};
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};
use enfilade::robot::rooms::RoomOptions;
use enfilade::robot::{Exploration, Pose, RobotOptions, World, WorldOptions};

use crate::support::enfilade;

type Rectangle = (f64, f64, f64, f64);

/// Rooms (left, low, right, high), walls (ends and thickness) and doors (ends).
fn plan(rooms: &[Rectangle], walls: &[(Rectangle, f64)], doors: &[Rectangle]) -> Plan {
    let mut builder = Builder::new(Meta::default());
    for &(left, low, right, high) in rooms {
        let ring = [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| Point::new(x, y));
        let outer = builder.ring(ring);
        builder.room("", Room { outer, ..Room::default() });
    }
    for &((x1, y1, x2, y2), thickness_m) in walls {
        let (from, to) = (builder.corner(Point::new(x1, y1)), builder.corner(Point::new(x2, y2)));
        builder.wall(from, to, thickness_m);
    }
    for &(x1, y1, x2, y2) in doors {
        let place = Place::Free { from: Point::new(x1, y1), to: Point::new(x2, y2) };
        builder.opening("", Opening::new(OpeningKind::Door, place));
    }
    builder.finish().unwrap()
}

/// What `enfilade explore` says of a plan.
fn explore(plan: &Plan) -> (u8, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("strange.plan.json");
    std::fs::write(&file, enfilade::formats::plan_json::to_bytes(plan)).unwrap();
    let out = folder.path().join("out");
    let told = enfilade(["explore", file.to_str().unwrap(), "-o", out.to_str().unwrap()]);
    assert_eq!(out.exists(), told.0 == 0, "{told:?}");
    told
}

fn refused(plan: &Plan) {
    let (code, _, err) = explore(plan);
    assert!(code == 1 && err.contains("strange.plan.json: no room has space for the robot"), "{code} {err}");
}

#[test]
fn where_no_robot_fits_none_is_sent() {
    refused(&plan(&[], &[], &[]));
    // Walls alone, closed or not, are no room.
    let walls = [((0.0, 0.0, 5.0, 0.0), 0.2), ((5.0, 0.0, 5.0, 4.0), 0.2), ((5.0, 4.0, 0.0, 4.0), 0.2)];
    refused(&plan(&[], &walls, &[]));
    refused(&plan(&[(0.0, 0.0, 0.3, 0.3)], &[], &[]));
    refused(&plan(&[(0.0, 0.0, 50.0, 0.5)], &[], &[]));
    // A wall that fills the room.
    refused(&plan(&[(0.0, 0.0, 4.0, 3.0)], &[((-1.0, 1.5, 5.0, 1.5), 9.0)], &[]));
}

#[test]
fn a_room_five_kilometres_away_costs_nothing() {
    let far = plan(&[(0.0, 0.0, 4.0, 3.0), (5000.0, 5000.0, 5003.0, 5003.0)], &[], &[]);
    let (code, out, err) = explore(&far);
    assert!(code == 0 && out.contains("1 of 1 rooms found") && out.contains("1 out of reach"), "{out}{err}");
}

/// Nothing but floor as far as the scanners reach: no exploration ends soon, but each step stays cheap.
#[test]
fn a_hall_of_five_kilometres_can_be_begun() {
    let hall = plan(&[(0.0, 0.0, 5000.0, 5000.0)], &[], &[]);
    let world = Arc::new(World::new(&hall, &WorldOptions::default()));
    let start = world.start(0.3, 1).unwrap();
    let mut exploration = Exploration::new(world, Pose::new(start.x, start.y, 0.0), RobotOptions::default());
    for _ in 0..40 {
        exploration.step();
    }
    assert!(exploration.pose.is_finite());
    assert!(exploration.rooms(&RoomOptions::default()).rooms.len() <= 1);
}

#[test]
fn rooms_drawn_over_each_other_are_explored() {
    // The same room twice, a third half over both, and one within.
    let rooms = [(0.0, 0.0, 5.0, 4.0), (0.0, 0.0, 5.0, 4.0), (2.5, 0.0, 7.5, 4.0), (1.0, 1.0, 2.0, 2.0)];
    let (code, out, err) = explore(&plan(&rooms, &[], &[]));
    assert!(code == 0 && out.contains("rooms found"), "{out}{err}");
}

#[test]
fn walls_that_do_not_close_leave_the_rooms_as_they_are_drawn() {
    // Two rooms of which only a piece of one side is drawn as a wall.
    let rooms = [(0.0, 0.0, 4.0, 4.0), (4.0, 0.0, 8.0, 4.0)];
    let walls = [((4.0, 0.0, 4.0, 1.5), 0.2), ((0.0, 0.0, 1.0, 0.0), 0.2), ((20.0, 20.0, 21.0, 22.0), 0.2)];
    let (code, out, err) = explore(&plan(&rooms, &walls, &[]));
    assert!(code == 0 && out.contains("rooms found"), "{out}{err}");
}

#[test]
fn doors_that_lead_nowhere_do_no_harm() {
    let rooms = [(0.0, 0.0, 4.0, 4.0), (4.2, 0.0, 8.0, 4.0)];
    // In the middle of a room, far off, longer than the wall, right in a corner, twice at one place.
    let doors = [
        (1.0, 1.0, 2.0, 1.0),
        (90.0, 90.0, 91.0, 90.0),
        (4.1, -3.0, 4.1, 9.0),
        (3.8, 4.0, 4.4, 4.0),
        (4.1, 1.0, 4.1, 1.9),
        (4.1, 1.0, 4.1, 1.9),
    ];
    let (code, out, err) = explore(&plan(&rooms, &[], &doors));
    assert!(code == 0 && out.contains("rooms found"), "{out}{err}");
}

/// Random heaps of rooms, walls and doors: worlds are made of them and a robot does some steps, or has no start.
#[test]
fn heaps_of_anything_never_panic() {
    let mut random = enfilade::base::random::Random::new(5);
    for _ in 0..25 {
        let mut rectangle = |most: f64| {
            let mut at = || (random.unit() * 4.0 * most).round() / 4.0;
            let (x, y) = (at(), at());
            (x, y, x + 0.25 + at() / 2.0, y + 0.25 + at() / 2.0)
        };
        let rooms: Vec<Rectangle> = (0..4).map(|_| rectangle(8.0)).collect();
        let walls: Vec<(Rectangle, f64)> = (0..5).map(|at| (rectangle(9.0), 0.1 * f64::from(at))).collect();
        let doors: Vec<Rectangle> = (0..5).map(|_| rectangle(8.0)).collect();
        let heap = plan(&rooms, &walls, &doors);
        let world = Arc::new(World::new(&heap, &WorldOptions { furniture: 2, ..WorldOptions::default() }));
        let Some(start) = world.start(0.3, 1) else { continue };
        let mut exploration = Exploration::new(world, Pose::new(start.x, start.y, 0.0), RobotOptions::default());
        for _ in 0..25 {
            exploration.step();
        }
        let found = exploration.rooms(&RoomOptions::default());
        assert!(found.rooms.iter().all(|room| areas::area_m2(&room.shapes()) > 0.0));
    }
}
