//! What must hold of every robot and every map, on generated worlds: rooms of random sizes in rows.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::collections::BTreeMap;
use std::sync::Arc;

use enfilade::base::random::Random;
use enfilade::geometry::{Point, Segment, Vector, areas};
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};
use enfilade::robot::grid_map::{Cell, GridMap};
use enfilade::robot::rooms::{FoundRooms, RoomOptions};
use enfilade::robot::segment::segment;
use enfilade::robot::{Exploration, Pose, RobotOptions, World, WorldOptions};
use proptest::prelude::*;

/// Two rows of rooms on a corridor, of so many decimetres' width, moved; walls of 0.2 m, doors of 0.9 m.
fn house(above_dm: &[u32], below_dm: &[u32], turn_rad: f64, shift: Vector) -> Plan {
    let place = |x: f64, y: f64| Point::default() + Vector::new(x, y).rotated(turn_rad) + shift;
    let mut builder = Builder::new(Meta::default());
    let metres = |dm: &[u32]| dm.iter().map(|&dm| f64::from(dm) / 10.0).collect::<Vec<_>>();
    let (above, below) = (metres(above_dm), metres(below_dm));
    let length = above.iter().sum::<f64>().max(below.iter().sum());
    let mut rooms = vec![(0.0, 0.0, length, 2.0)];
    for (widths, low, high) in [(above, 2.0, 5.5), (below, -4.0, 0.0)] {
        let mut left = 0.0;
        for (at, width) in widths.iter().enumerate() {
            let right = if at + 1 == widths.len() { length } else { left + width };
            rooms.push((left, low, right, high));
            left = right;
        }
    }
    for (at, &(left, low, right, high)) in rooms.iter().enumerate() {
        let ring = [(left, low), (right, low), (right, high), (left, high)].map(|(x, y)| place(x, y));
        let outer = builder.ring(ring);
        builder.room("", Room { outer, ..Room::default() });
        for i in 0..4 {
            let (from, to) = (builder.corner(ring[i]), builder.corner(ring[(i + 1) % 4]));
            builder.wall(from, to, 0.2);
        }
        if at > 0 {
            let y = if low > 0.0 { 2.0 } else { 0.0 };
            let middle = (left + right) / 2.0;
            let (from, to) = (place(middle - 0.45, y), place(middle + 0.45, y));
            builder.opening("", Opening::new(OpeningKind::Door, Place::Free { from, to }));
        }
    }
    builder.finish().unwrap()
}

fn start(turn_rad: f64, shift: Vector) -> Pose {
    let at = Point::default() + Vector::new(1.5, 1.0).rotated(turn_rad) + shift;
    Pose::new(at.x, at.y, turn_rad)
}

fn explored(plan: &Plan, start: Pose, options: RobotOptions) -> (Arc<World>, Exploration, FoundRooms) {
    let world = Arc::new(World::new(plan, &WorldOptions::default()));
    let mut exploration = Exploration::new(world.clone(), start, options);
    exploration.run();
    let found = exploration.rooms(&RoomOptions::default());
    (world, exploration, found)
}

/// Whether two areas are the same but for a share of the first.
fn agree(one: f64, other: f64, share: f64) -> bool {
    (one - other).abs() <= share * one.max(other)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3, ..ProptestConfig::default() })]

    /// Without noise the map lies on the walls' faces, every face that the robot drove past is in it, and the rooms
    /// found are the rooms.
    #[test]
    fn without_noise_the_map_is_the_plan(above in prop::collection::vec(25u32..60, 1..3), below in prop::collection::vec(25u32..60, 1..3)) {
        let start = start(0.0, Vector::default());
        let (world, exploration, found) = explored(&house(&above, &below, 0.0, Vector::default()), start, RobotOptions::default().exact());
        let map: Vec<Segment> = exploration
            .segments()
            .iter()
            .map(|segment| Segment::new(start.apply(segment.a), start.apply(segment.b)))
            .filter(|segment| segment.length() > 0.3)
            .collect();
        // But for a bevel across a corner now and then, where few beams hit.
        let is_on_wall = |segment: &Segment| {
            let at = |i: i32| segment.a.lerp(segment.b, 0.02 + 0.096 * f64::from(i));
            (0..=10).all(|i| world.obstacles().distance_m(at(i), 1.0) < 0.02)
        };
        let off: Vec<&Segment> = map.iter().filter(|segment| !is_on_wall(segment)).collect();
        let length_m: f64 = map.iter().map(|segment| segment.length()).sum();
        let off_m: f64 = off.iter().map(|segment| segment.length()).sum();
        prop_assert!(off_m < 0.02 * length_m, "on no wall: {:?}", off);
        // A face is visible where the robot once had it in its sight and within range: here, of all rooms it entered.
        let driven: Vec<Point> = exploration.path.iter().map(|step| step.true_pose.position()).collect();
        let (mut visible, mut mapped) = (0, 0);
        for wall in world.obstacles().segments().iter().filter(|wall| wall.length() > 0.5) {
            for i in 0..10 {
                let at = wall.a.lerp(wall.b, 0.05 + 0.1 * f64::from(i));
                let normal = wall.vector().left().unit().unwrap_or_default();
                let is_seen = driven.iter().step_by(3).any(|&from| {
                    let to = at - from;
                    // Not too flat for a beam to be counted to the wall.
                    let flat = normal.dot(to).abs() / to.length().max(1e-9);
                    to.length() < 8.0 && flat > 0.35 && !world.obstacles().blocks(from, from + to * (1.0 - 0.02 / to.length()))
                });
                if is_seen {
                    visible += 1;
                    mapped += usize::from(map.iter().any(|segment| segment.distance(at) < 0.03));
                }
            }
        }
        prop_assert!(visible > 50 && mapped as f64 > 0.95 * visible as f64, "{} of {}", mapped, visible);
        prop_assert_eq!(found.rooms.len(), world.rooms().len());
        let mut floors: Vec<f64> = world.rooms().iter().map(|room| room.area_m2).collect();
        let mut rooms: Vec<f64> = found.rooms.iter().map(|room| areas::area_m2(&room.shapes())).collect();
        floors.sort_by(f64::total_cmp);
        rooms.sort_by(f64::total_cmp);
        prop_assert!(floors.iter().zip(&rooms).all(|(floor, room)| agree(*floor, *room, 0.1)), "{:?} {:?}", floors, rooms);
    }

    /// What robots find in a world that was moved is what they found before, and twice the same is the same.
    #[test]
    fn a_moved_world_gives_the_moved_result(widths in prop::collection::vec(25u32..50, 1..3), turn_rad in -3.0f64..3.0, x in -200.0f64..200.0) {
        let rooms = |turn_rad: f64, shift: Vector| {
            let (_, exploration, found) = explored(&house(&widths, &[40], turn_rad, shift), start(turn_rad, shift), RobotOptions::default().exact());
            let mut areas_m2: Vec<f64> = found.rooms.iter().map(|room| areas::area_m2(&room.shapes())).collect();
            areas_m2.sort_by(f64::total_cmp);
            (areas_m2, found.doorways.len(), exploration.path.clone())
        };
        let here = rooms(0.0, Vector::default());
        let again = rooms(0.0, Vector::default());
        prop_assert_eq!(&here, &again);
        let there = rooms(turn_rad, Vector::new(x, -0.5 * x));
        prop_assert_eq!((here.0.len(), here.1), (there.0.len(), there.1));
        prop_assert!(here.0.iter().zip(&there.0).all(|(one, other)| agree(*one, *other, 0.06)), "{:?} {:?}", here.0, there.0);
    }
}

/// A floor as a grid: rooms of random sizes in a raster of walls, each with a gap to the next.
fn floor(seed: u64, width: usize, height: usize) -> Vec<Cell> {
    let mut random = Random::new(seed);
    let mut cells = vec![Cell::Free; width * height];
    let mut wall = |from: (usize, usize), to: (usize, usize)| {
        for y in from.1..to.1 {
            for x in from.0..to.0 {
                cells[y * width + x] = Cell::Occupied;
            }
        }
    };
    wall((0, 0), (width, 4));
    wall((0, height - 4), (width, height));
    wall((0, 0), (4, height));
    wall((width - 4, 0), (width, height));
    let mut x = 0;
    loop {
        x += 60 + random.below(40);
        if x + 50 > width {
            break;
        }
        // A door of a metre, not in a corner.
        let door = 15 + random.below(height - 50);
        wall((x, 0), (x + 4, door));
        wall((x, door + 20), (x + 4, height));
    }
    cells
}

/// The sizes of the rooms of a map, in cells, sorted.
fn rooms_of(width: usize, height: usize, cells: Vec<Cell>) -> Vec<usize> {
    let map = GridMap::new(width, height, 0.05, Pose::IDENTITY, cells).unwrap();
    let found = segment(&map);
    let mut sizes: BTreeMap<u32, usize> = BTreeMap::new();
    for &region in found.region_of_cell.iter().filter(|&&region| (1..=found.rooms).contains(&region)) {
        *sizes.entry(region).or_default() += 1;
    }
    let mut sizes: Vec<usize> = sizes.into_values().collect();
    sizes.sort_unstable();
    sizes
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, ..ProptestConfig::default() })]

    /// A map turned by a quarter or mirrored has the same rooms, turned or mirrored.
    #[test]
    fn rooms_of_a_grid_do_not_depend_on_how_it_lies(seed in any::<u64>()) {
        let (width, height) = (320, 110);
        let cells = floor(seed, width, height);
        let sizes = rooms_of(width, height, cells.clone());
        prop_assert!(sizes.len() >= 3, "{:?}", sizes);
        let at = |x: usize, y: usize| cells[y * width + x];
        let mirrored: Vec<Cell> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(width - 1 - x, y)).collect();
        let upside_down: Vec<Cell> = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(width - 1 - x, height - 1 - y)).collect();
        // A quarter: the new map is `height` wide and `width` high.
        let turned: Vec<Cell> = (0..width).flat_map(|y| (0..height).map(move |x| (x, y))).map(|(x, y)| at(y, height - 1 - x)).collect();
        for (width, height, cells) in [(width, height, mirrored), (width, height, upside_down), (height, width, turned)] {
            let others = rooms_of(width, height, cells);
            prop_assert_eq!(sizes.len(), others.len());
            // A cut runs along cells, and which of two equal ones gets it may differ.
            prop_assert!(sizes.iter().zip(&others).all(|(one, other)| one.abs_diff(*other) <= 60), "{:?} {:?}", sizes, others);
        }
    }
}
