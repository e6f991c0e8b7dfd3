//! The cost of edits on a plan of 50,000 walls and 25,000 rooms: a grid of rooms, with drawing in its
//! middle. Times are in milliseconds, each the minimum of several runs.
//!
//!     cargo bench --no-default-features --bench edits
#![allow(clippy::unwrap_used, reason = "a benchmark that cannot go on stops")]
#![allow(clippy::print_stdout, reason = "its figures")]
#![allow(clippy::disallowed_methods, reason = "measuring needs a clock")]

use std::collections::BTreeSet;
use std::hint::black_box;
use std::time::Instant;

use enfilade::edit::{
    self, bridge_gaps, cut_out, draw_room, draw_room_in_free_space, draw_walls, merge_rooms, offset_walls,
    opening_preview, split_room,
};
use enfilade::geometry::{Point, Transform, Vector};
use enfilade::plan::{Builder, CornerId, ElementId, Meta, OpeningKind, Plan, Room, RoomId, WallId};
use enfilade::topology::{RoomShapes, gaps};

/// Rooms of 4 by 3 m in so many columns and rows, with walls.
fn grid(columns: i32, rows: i32) -> Plan {
    let mut builder = Builder::new(Meta::default());
    let mut corners: Vec<Vec<CornerId>> = Vec::new();
    for x in 0..=columns {
        let at = |y: i32| Point::new(4.0 * f64::from(x), 3.0 * f64::from(y));
        corners.push((0..=rows).map(|y| builder.corner(at(y))).collect());
    }
    for x in 0..=columns as usize {
        for y in 0..=rows as usize {
            if x < columns as usize {
                builder.wall(corners[x][y], corners[x + 1][y], 0.1);
            }
            if y < rows as usize {
                builder.wall(corners[x][y], corners[x][y + 1], 0.1);
            }
            if x < columns as usize && y < rows as usize {
                let outer = [corners[x][y], corners[x + 1][y], corners[x + 1][y + 1], corners[x][y + 1]].into();
                builder.room("", Room { outer, ..Room::default() });
            }
        }
    }
    builder.finish().unwrap()
}

fn measure<T>(name: &str, mut run: impl FnMut() -> T) {
    let mut least_ms = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        black_box(run());
        least_ms = least_ms.min(start.elapsed().as_secs_f64() * 1e3);
    }
    println!("{name:<44} {least_ms:8.1} ms");
}

fn main() {
    let plan = grid(158, 158);
    println!("{} walls, {} rooms, {} corners", plan.walls().len(), plan.rooms().len(), plan.corners().len());
    let at = |x: f64, y: f64| Point::new(300.0 + x, 240.0 + y);
    let rectangle = |x: f64, y: f64, w: f64, h: f64| vec![at(x, y), at(x + w, y), at(x + w, y + h), at(x, y + h)];
    let rooms_at = |x: f64, y: f64| -> RoomId {
        let shapes = RoomShapes::new(&plan);
        shapes.all()[shapes.at(at(x, y))[0]].id
    };
    let (room, beside) = (rooms_at(1.0, 1.0), rooms_at(5.0, 1.0));
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).take(10).collect();
    let shapes = RoomShapes::new(&plan);
    measure("draw a wall across a room", || draw_walls(&plan, &[at(0.5, 0.0), at(0.5, 3.0)], 0.1).unwrap());
    measure("draw a wall across 100 rooms", || draw_walls(&plan, &[at(0.5, 0.0), at(0.5, 200.0)], 0.1).unwrap());
    let corners = [Point::new(0.3, 0.1), Point::new(631.0, 473.0)];
    measure("draw a wall from corner to corner", || draw_walls(&plan, &corners, 0.1).unwrap());
    measure("draw a room", || draw_room(&plan, &rectangle(1.0, 1.0, 2.0, 1.0), Some(0.1)).unwrap());
    let free = edit::remove(&plan, &[ElementId::Room(room)]).unwrap();
    measure("draw a room in free space", || {
        draw_room_in_free_space(&free, &rectangle(-0.2, -0.2, 4.4, 3.4), Some(0.1), 0.3).unwrap()
    });
    measure("split a room", || split_room(&plan, room, &[at(0.0, 1.0), at(4.0, 1.0)]).unwrap());
    measure("cut a courtyard", || cut_out(&plan, room, &rectangle(1.0, 1.0, 1.0, 1.0)).unwrap());
    measure("merge two rooms", || merge_rooms(&plan, &[room, beside]).unwrap());
    measure("place a door", || edit::place_opening(&plan, OpeningKind::Door, at(1.0, 0.1), 0.9, 0.5, None).unwrap());
    measure("preview a door", || {
        opening_preview(&plan, &shapes, OpeningKind::Door, at(1.0, 0.1), 0.9, 0.5, None).unwrap()
    });
    measure("shapes of all rooms, once for previews", || RoomShapes::new(&plan));
    let some: BTreeSet<ElementId> = [ElementId::Room(room), ElementId::Room(beside)].into();
    let by = Transform::translation(Vector::new(0.1, 0.0));
    measure("move two rooms", || edit::move_elements(&plan, &some, by).unwrap());
    measure("copy two rooms", || edit::copy_elements(&plan, &some, by).unwrap());
    let all: BTreeSet<ElementId> = plan.rooms().map(|(id, _)| ElementId::Room(id)).collect();
    measure("move all rooms", || edit::move_elements(&plan, &all, by).unwrap());
    measure("copy all rooms beside", || {
        edit::copy_elements(&plan, &all, Transform::translation(Vector::new(700.0, 0.0))).unwrap()
    });
    measure("offset ten walls", || offset_walls(&plan, &walls, 0.5, at(0.0, 0.0)).unwrap());
    measure("find gaps", || gaps(&plan));
    measure("weld everything", || edit::weld(&plan, 0.02).unwrap());
    measure("square up everything", || edit::square_up(&plan, None, 0.1).unwrap());
    let mut open = Plan::default();
    for i in 0..100 {
        let y = f64::from(i);
        for (from, to) in [(0.0, 3.0), (3.9, 8.0)] {
            open = draw_walls(&open, &[Point::new(from, y), Point::new(to, y)], 0.1).unwrap().plan;
        }
    }
    measure("bridge 100 gaps", || bridge_gaps(&open, &gaps(&open), OpeningKind::Door).unwrap());
}
