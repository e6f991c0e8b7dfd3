use std::path::PathBuf;

use enfilade::edit::{self, fill_all, fill_at};
use enfilade::geometry::{Point, polygon};
use enfilade::plan::{Builder, CornerId, Meta, Opening, OpeningKind, Place, Plan, Room};
use enfilade::topology::PlanFaces;
use proptest::prelude::*;

/// A plan of walls between points.
fn walls(lines: &[[f64; 4]]) -> Plan {
    let mut builder = Builder::new(Meta::default());
    for &[ax, ay, bx, by] in lines {
        let (from, to) = (builder.corner(Point::new(ax, ay)), builder.corner(Point::new(bx, by)));
        if from != to {
            builder.wall(from, to, 0.1);
        }
    }
    builder.finish().unwrap()
}

fn corner_at(plan: &Plan, x: f64, y: f64) -> CornerId {
    plan.corners().find(|(_, corner)| corner.position == Point::new(x, y)).map(|(id, _)| id).unwrap()
}

fn area_m2(plan: &Plan, room: &Room) -> f64 {
    let holes: Vec<Vec<Point>> = room.holes.iter().map(|hole| plan.ring_points(hole)).collect();
    polygon::area(&plan.ring_points(&room.outer), &holes)
}

fn areas(plan: &Plan) -> Vec<f64> {
    let mut areas: Vec<f64> = plan.rooms().map(|(_, room)| (area_m2(plan, room) * 1e4).round() / 1e4).collect();
    areas.sort_by(f64::total_cmp);
    areas
}

#[test]
fn walls_that_cross_are_split_at_shared_corners() {
    let mut plan = walls(&[[-1.0, 0.0, 6.0, 0.0], [-1.0, 3.0, 6.0, 3.0], [0.0, -1.0, 0.0, 4.0], [5.0, -1.0, 5.0, 4.0]]);
    let (from, to) = (corner_at(&plan, 6.0, 0.0), corner_at(&plan, -1.0, 0.0));
    // On the wall from right to left: one door on the room's side, one beyond the crossing.
    let mut doors = Vec::new();
    for at_m in [2.5, 6.5] {
        let place = Place::Hosted { from, to, at_m, width_m: 0.9 };
        let (next, door) = edit::add_opening(&plan, Opening::new(OpeningKind::Door, place)).unwrap();
        plan = next;
        doors.push((door, plan.opening_segment(plan.opening(door).unwrap()).unwrap().midpoint()));
    }
    let filled = fill_at(&plan, Point::new(2.0, 1.0)).unwrap();
    let after = filled.plan;
    assert_eq!(after.violations(), []);
    let room = after.room(filled.rooms[0]).unwrap();
    assert_eq!(
        after.ring_points(&room.outer),
        [Point::new(0.0, 0.0), Point::new(5.0, 0.0), Point::new(5.0, 3.0), Point::new(0.0, 3.0)]
    );
    assert_eq!((after.walls().len(), after.corners().len()), (12, 12));
    for (id, _) in plan.walls() {
        assert!(after.wall(id).is_some(), "a wall keeps its identity");
    }
    for (door, middle) in doors {
        let opening = after.opening(door).unwrap();
        let moved = after.opening_segment(opening).unwrap().midpoint();
        assert!(moved.distance(middle) < 1e-4, "{moved:?} {middle:?}");
        let Place::Hosted { from, to, .. } = opening.place else { panic!("hosted") };
        assert!(
            after.walls().any(|(_, wall)| (wall.from, wall.to) == (from, to) || (wall.to, wall.from) == (from, to)),
            "the door stands on a part of the wall"
        );
    }
    // Moving the shared corner moves the room.
    let moved = edit::move_corners(&after, &[(corner_at(&after, 5.0, 3.0), Point::new(6.0, 4.0))]).unwrap();
    assert!(area_m2(&moved, moved.room(filled.rooms[0]).unwrap()) > 15.0);
}

#[test]
fn existing_corners_are_used_and_only_touched_walls_change() {
    // Two rooms side by side: the partition ends on the outer walls, which have no corner there. A
    // third wall crosses outside.
    let plan = walls(&[
        [0.0, 0.0, 8.0, 0.0],
        [8.0, 0.0, 8.0, 4.0],
        [8.0, 4.0, 0.0, 4.0],
        [0.0, 4.0, 0.0, 0.0],
        [3.0, 0.0, 3.0, 4.0],
        [20.0, 0.0, 24.0, 0.0],
        [22.0, -2.0, 22.0, 2.0],
    ]);
    let filled = fill_all(&plan).unwrap();
    assert_eq!(filled.plan.violations(), []);
    assert_eq!(areas(&filled.plan), [12.0, 20.0]);
    assert_eq!(filled.plan.corners().len(), plan.corners().len(), "no new corner is needed");
    assert_eq!(filled.plan.walls().len(), 9);
    // Nothing is left to fill, and filling again is refused in words.
    let again = fill_all(&filled.plan).unwrap();
    assert_eq!((again.rooms, again.plan == filled.plan), (vec![], true));
    assert!(fill_at(&filled.plan, Point::new(1.0, 1.0)).unwrap_err().0.contains("already"));
    assert!(fill_at(&plan, Point::new(21.0, 1.0)).unwrap_err().0.contains("no walls enclose"));
    assert!(fill_at(&plan, Point::new(f64::NAN, 1.0)).is_err());
}

#[test]
fn islands_become_holes() {
    let mut lines = Vec::new();
    for (x, y, side) in [(0.0, 0.0, 10.0), (2.0, 2.0, 3.0), (7.0, 7.0, 0.5)] {
        lines.extend([[x, y, x + side, y], [x + side, y, x + side, y + side]]);
        lines.extend([[x + side, y + side, x, y + side], [x, y + side, x, y]]);
    }
    let plan = walls(&lines);
    let filled = fill_at(&plan, Point::new(1.0, 1.0)).unwrap();
    assert_eq!(areas(&filled.plan), [90.75]);
    assert_eq!(filled.plan.room(filled.rooms[0]).unwrap().holes.len(), 2);
    let all = fill_all(&filled.plan).unwrap();
    assert_eq!(areas(&all.plan), [0.25, 9.0, 90.75]);
    assert_eq!(all.plan.violations(), []);
}

#[test]
fn slivers_between_lines_that_should_be_one_stay_empty() {
    // The partition is drawn twice, 3 mm apart at one end.
    let plan = walls(&[
        [0.0, 0.0, 8.0, 0.0],
        [8.0, 0.0, 8.0, 4.0],
        [8.0, 4.0, 0.0, 4.0],
        [0.0, 4.0, 0.0, 0.0],
        [3.0, 0.0, 3.0, 4.0],
        [3.0, 0.0, 3.003, 4.0],
    ]);
    let faces = PlanFaces::new(&plan).unwrap();
    assert_eq!(faces.all().len(), 3);
    let filled = fill_all(&plan).unwrap();
    assert_eq!(areas(&filled.plan), [12.0, 19.994]);
    assert_eq!(filled.plan.violations(), []);
}

#[test]
fn boundaries_of_rooms_enclose_where_one_clicks_and_share_new_corners() {
    // A room without walls closes the open side of three walls; its boundary reaches beyond.
    let mut builder = Builder::new(Meta::default());
    let outer = builder.ring([(4.0, -1.0), (7.0, -1.0), (7.0, 5.0), (4.0, 5.0)].map(|(x, y)| Point::new(x, y)));
    builder.room("hall", Room { outer, name: "Hall".to_owned(), ..Room::default() });
    for [ax, ay, bx, by] in [[4.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 3.0], [0.0, 3.0, 4.0, 3.0]] {
        let (from, to) = (builder.corner(Point::new(ax, ay)), builder.corner(Point::new(bx, by)));
        builder.wall(from, to, 0.1);
    }
    let plan = builder.finish().unwrap();
    assert_eq!(fill_all(&plan).unwrap().rooms, [], "walls alone do not enclose it");
    let filled = fill_at(&plan, Point::new(1.0, 1.0)).unwrap();
    assert_eq!(areas(&filled.plan), [12.0, 18.0]);
    assert_eq!(filled.plan.violations(), []);
    let hall = filled.plan.rooms().find(|(_, room)| room.name == "Hall").unwrap().1;
    assert_eq!(hall.outer.len(), 6, "the hall has the corners of the new room");
    assert!(fill_at(&plan, Point::new(5.0, 1.0)).unwrap_err().0.contains("'Hall'"));
}

/// Every dwelling drawn by its rooms' boundaries as walls gives these rooms again.
#[test]
fn rooms_of_real_dwellings_follow_from_their_walls() {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/houses/r2v"));
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is not here", folder.display());
        return;
    };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let (mut known, mut found) = (0_u32, 0_u32);
    for file in files.iter().filter(|file| file.extension().is_some_and(|extension| extension == "geojson")) {
        let text = std::fs::read_to_string(file).unwrap();
        let document: serde_json::Value = serde_json::from_str(&text).unwrap();
        let mut lines = Vec::new();
        let mut expected = Vec::new();
        for feature in document["features"].as_array().unwrap() {
            if feature["geometry"]["type"] != "Polygon" || feature["properties"]["kind"] != "room" {
                continue;
            }
            let mut rings = Vec::new();
            for ring in feature["geometry"]["coordinates"].as_array().unwrap() {
                let ring: Vec<Point> = ring
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|point| Point::new(point[0].as_f64().unwrap(), point[1].as_f64().unwrap()).trimmed())
                    .collect();
                lines.extend(ring.windows(2).map(|pair| [pair[0].x, pair[0].y, pair[1].x, pair[1].y]));
                rings.push(ring[1..].to_vec());
            }
            expected.push(polygon::area(&rings[0], &rings[1..]));
        }
        let filled = fill_all(&walls(&lines)).unwrap();
        assert_eq!(filled.plan.violations(), [], "{}", file.display());
        let mut areas: Vec<f64> = filled.plan.rooms().map(|(_, room)| area_m2(&filled.plan, room)).collect();
        for area in expected {
            known += 1;
            // A hundredth of a percent, and what rounding the corners may move.
            if let Some(at) = areas.iter().position(|other| (other - area).abs() < 1e-4 * area + 1e-3) {
                areas.swap_remove(at);
                found += 1;
            }
        }
    }
    println!("{found} of {known} rooms of {} dwellings", files.len());
    assert!(known > 5_000);
    assert_eq!(found, known);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn filling_keeps_the_invariants(
        lines in prop::collection::vec(prop::array::uniform4(0_i32..60), 1..14),
        at in prop::collection::vec((any::<prop::sample::Index>(), 0.0..1.0_f64), 0..6),
        scale in prop_oneof![Just(1e-4), Just(0.1), Just(0.0917)],
    ) {
        let mut plan = walls(&lines.iter().map(|line| line.map(|value| f64::from(value) * scale)).collect::<Vec<_>>());
        let mut middles = Vec::new();
        for (index, fraction) in at {
            let hosts: Vec<_> = plan.walls().map(|(_, wall)| (wall.from, wall.to, plan.wall_segment(wall).unwrap())).collect();
            if hosts.is_empty() {
                break;
            }
            let (from, to, segment) = hosts[index.index(hosts.len())];
            let place = Place::Hosted { from, to, at_m: fraction * segment.length() * 0.99, width_m: 0.1 };
            if let Ok((next, id)) = edit::add_opening(&plan, Opening::new(OpeningKind::Door, place)) {
                plan = next;
                middles.push((id, plan.opening_segment(plan.opening(id).unwrap()).unwrap().midpoint()));
            }
        }
        let faces = PlanFaces::new(&plan).unwrap();
        let all: Vec<usize> = (0..faces.all().len()).collect();
        let filled = faces.fill(&all).unwrap();
        prop_assert_eq!(filled.plan.violations(), []);
        prop_assert_eq!(filled.rooms.len(), all.len());
        for (face, room) in faces.all().iter().zip(&filled.rooms) {
            let room = filled.plan.room(*room).unwrap();
            prop_assert_eq!(filled.plan.ring_points(&room.outer), face.outer.clone());
        }
        for (id, middle) in middles {
            let moved = filled.plan.opening_segment(filled.plan.opening(id).unwrap()).unwrap().midpoint();
            // A pixel's half diagonal for the wall, half a step for the distance along it.
            prop_assert!(moved.distance(middle) < 1.3e-4, "{:?} {:?}", moved, middle);
        }
        // Every part of a room's boundary is a whole wall now, so that all faces are rooms already.
        let again = fill_all(&filled.plan).unwrap();
        prop_assert_eq!(again.rooms, vec![]);
    }
}
