//! Laws that hold for any plan and any sequence of edits.

use std::collections::BTreeSet;

use enfilade::edit::{
    self, Alignment, Array, bridge_gaps, cut_out, draw_room, draw_room_in_free_space, draw_walls, fill_all, fill_at,
    merge_rooms, offset_room, offset_walls, split_room,
};
use enfilade::geometry::{Point, Segment, Transform, Vector};
use enfilade::plan::{CornerId, ElementId, LeafSide, OpeningId, OpeningKind, Plan, RoomId, Swing, WallId};
use enfilade::topology::gaps;
use proptest::prelude::*;

use super::support::{Way, area_m2, areas, config, invariants_hold_and_undo_is_exact_for, points, total_area};

/// Coordinates as they come in drawing: whole metres that meet again and again, some of them missed
/// by a little, and some anywhere.
fn coordinate() -> impl Strategy<Value = f64> {
    let missed = prop_oneof![Just(0.0), Just(0.0004), Just(-0.0007), Just(0.003), Just(-0.04), Just(0.15)];
    prop_oneof![
        8 => (0..10_i32).prop_map(f64::from),
        2 => ((0..10_i32), missed).prop_map(|(metre, by)| f64::from(metre) + by),
        1 => 0.0..10.0,
    ]
}

fn point() -> impl Strategy<Value = Point> {
    (coordinate(), coordinate()).prop_map(|(x, y)| Point::new(x, y))
}

/// A path: straight, L-shaped, closed, anything.
fn path() -> impl Strategy<Value = Vec<Point>> {
    prop_oneof![
        3 => (point(), point()).prop_map(|(a, b)| vec![a, b]),
        2 => (point(), point()).prop_map(|(a, b)| vec![a, Point::new(b.x, a.y), b]),
        2 => (point(), point()).prop_map(|(a, b)| {
            let mut ring = rectangle_of(a, b);
            ring.push(ring[0]);
            ring
        }),
        1 => proptest::collection::vec(point(), 2..7),
    ]
}

fn rectangle_of(a: Point, b: Point) -> Vec<Point> {
    vec![a, Point::new(b.x, a.y), b, Point::new(a.x, b.y)]
}

/// A boundary: a rectangle, an L, or anything.
fn boundary() -> impl Strategy<Value = Vec<Point>> {
    prop_oneof![
        4 => (point(), point()).prop_map(|(a, b)| rectangle_of(a, b)),
        2 => (point(), point(), 0.2..0.8).prop_map(|(a, b, t)| {
            let inner = a.lerp(b, t);
            vec![a, Point::new(b.x, a.y), Point::new(b.x, inner.y), inner, Point::new(inner.x, b.y), Point::new(a.x, b.y)]
        }),
        1 => proptest::collection::vec(point(), 3..7),
    ]
}

fn transform() -> impl Strategy<Value = Transform> {
    prop_oneof![
        3 => ((-3..4_i32), (-3..4_i32))
            .prop_map(|(x, y)| Transform::translation(Vector::new(f64::from(x), f64::from(y)))),
        1 => (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Transform::translation(Vector::new(x, y))),
        1 => (point(), 0..4_i32)
            .prop_map(|(about, quarters)| Transform::rotation(about, f64::from(quarters) * std::f64::consts::FRAC_PI_2)),
        1 => (point(), -3.0..3.0).prop_map(|(about, angle_rad)| Transform::rotation(about, angle_rad)),
        1 => (point(), point()).prop_map(|(a, b)| Transform::reflection(a, b).unwrap_or(Transform::IDENTITY)),
        1 => (point(), 0.0..2.5).prop_map(|(about, factor)| Transform::scaling(about, factor)),
    ]
}

/// An edit with indices instead of ids: they pick among what the plan then has.
#[derive(Clone, Debug)]
enum Step {
    Walls(Vec<Point>, f64),
    Room(Vec<Point>, bool),
    FreeSpace(Vec<Point>, bool),
    Fill(Option<Point>),
    Place(usize, Point, f64),
    Slide(usize, Point),
    Resize(usize, f64),
    Turn(usize, usize),
    Split(usize, Vec<Point>),
    Merge(usize, usize),
    CutOut(usize, Vec<Point>),
    Gaps,
    Move(Vec<usize>, Transform),
    Copy(Vec<usize>, Transform),
    Array(Vec<usize>, usize, Transform),
    OffsetWalls(Vec<usize>, f64, Point),
    OffsetRoom(usize, f64, bool),
    SquareUp(Option<usize>, f64),
    Weld(f64),
    Align(Vec<usize>, usize),
    Thickness(usize, f64),
    Remove(usize),
    MoveCorner(usize, Point),
    Undo,
    Redo,
}

fn step() -> impl Strategy<Value = Step> {
    let index = || 0usize..1000;
    let some = || proptest::collection::vec(0usize..1000, 1..5);
    let thickness = || prop_oneof![Just(0.0), Just(0.1), Just(0.3), -0.1..12.0];
    prop_oneof![
        8 => (path(), thickness()).prop_map(|(path, t)| Step::Walls(path, t)),
        6 => (boundary(), any::<bool>()).prop_map(|(outer, walls)| Step::Room(outer, walls)),
        4 => (boundary(), any::<bool>()).prop_map(|(outer, walls)| Step::FreeSpace(outer, walls)),
        2 => proptest::option::of(point()).prop_map(Step::Fill),
        5 => (index(), point(), -0.1..4.0).prop_map(|(kind, at, w)| Step::Place(kind, at, w)),
        2 => (index(), point()).prop_map(|(i, to)| Step::Slide(i, to)),
        1 => (index(), -0.1..4.0).prop_map(|(i, w)| Step::Resize(i, w)),
        1 => (index(), index()).prop_map(|(i, how)| Step::Turn(i, how)),
        3 => (index(), path()).prop_map(|(i, path)| Step::Split(i, path)),
        3 => (index(), index()).prop_map(|(i, j)| Step::Merge(i, j)),
        3 => (index(), boundary()).prop_map(|(i, outer)| Step::CutOut(i, outer)),
        1 => Just(Step::Gaps),
        3 => (some(), transform()).prop_map(|(which, how)| Step::Move(which, how)),
        3 => (some(), transform()).prop_map(|(which, how)| Step::Copy(which, how)),
        1 => (some(), 0usize..4, transform()).prop_map(|(which, n, how)| Step::Array(which, n, how)),
        1 => (some(), 0.0..2.0, point()).prop_map(|(which, d, to)| Step::OffsetWalls(which, d, to)),
        1 => (index(), 0.0..2.0, any::<bool>()).prop_map(|(i, d, inside)| Step::OffsetRoom(i, d, inside)),
        1 => (proptest::option::of(index()), 0.0..0.3).prop_map(|(i, angle)| Step::SquareUp(i, angle)),
        1 => prop_oneof![Just(0.001), Just(0.05), 0.0..1.0].prop_map(Step::Weld),
        1 => (some(), 0usize..8).prop_map(|(which, how)| Step::Align(which, how)),
        1 => (index(), thickness()).prop_map(|(i, t)| Step::Thickness(i, t)),
        2 => index().prop_map(Step::Remove),
        2 => (index(), point()).prop_map(|(i, to)| Step::MoveCorner(i, to)),
        2 => Just(Step::Undo),
        1 => Just(Step::Redo),
    ]
}

fn pick<T: Copy>(all: &[T], index: usize) -> Option<T> {
    (!all.is_empty()).then(|| all[index % all.len()])
}

/// The plan after a step; `None` where there is nothing to apply it to or it was refused.
fn applied(plan: &Plan, step: &Step) -> Option<Plan> {
    let corners: Vec<CornerId> = plan.corners().map(|(id, _)| id).collect();
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).collect();
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    let openings: Vec<OpeningId> = plan.openings().map(|(id, _)| id).collect();
    let all: Vec<ElementId> = corners
        .iter()
        .map(|&id| ElementId::Corner(id))
        .chain(walls.iter().map(|&id| ElementId::Wall(id)))
        .chain(rooms.iter().map(|&id| ElementId::Room(id)))
        .chain(openings.iter().map(|&id| ElementId::Opening(id)))
        .collect();
    let some = |which: &[usize]| -> BTreeSet<ElementId> { which.iter().filter_map(|&i| pick(&all, i)).collect() };
    match step {
        Step::Walls(path, t) => draw_walls(plan, path, *t).ok().map(|drawn| drawn.plan),
        Step::Room(outer, walls) => draw_room(plan, outer, walls.then_some(0.1)).ok().map(|(plan, _)| plan),
        Step::FreeSpace(outer, walls) => {
            let before = plan.rooms().filter(|(_, room)| room.holes.is_empty()).count();
            let drawn = draw_room_in_free_space(plan, outer, walls.then_some(0.1), 0.3).ok()?;
            assert!(drawn.rooms.iter().all(|&id| drawn.plan.room(id).is_some()) && !drawn.rooms.is_empty());
            assert!(drawn.plan.rooms().count() > before);
            Some(drawn.plan)
        }
        Step::Fill(Some(at)) => fill_at(plan, *at).ok().map(|filled| filled.plan),
        Step::Fill(None) => fill_all(plan).ok().map(|filled| filled.plan),
        Step::Place(kind, at, width_m) => {
            let kind = OpeningKind::ALL[kind % 4];
            edit::place_opening(plan, kind, *at, *width_m, 0.5, Some(Point::new(at.y, at.x))).ok().map(|(plan, _)| plan)
        }
        Step::Slide(i, to) => edit::slide_opening(plan, pick(&openings, *i)?, *to).ok(),
        Step::Resize(i, width_m) => edit::resize_opening(plan, pick(&openings, *i)?, *width_m).ok(),
        Step::Turn(i, how) => {
            let id = pick(&openings, *i)?;
            let shown = Swing { hinge_at_start: false, side: LeafSide::Left };
            match how % 3 {
                0 => edit::flip_hinge(plan, id, shown).ok(),
                1 => edit::flip_side(plan, id, shown).ok(),
                _ => edit::set_opening_kind(plan, id, OpeningKind::ALL[how % 4]).ok(),
            }
        }
        Step::Split(i, path) => split_room(plan, pick(&rooms, *i)?, path).ok().map(|(plan, _)| plan),
        Step::Merge(i, j) => merge_rooms(plan, &[pick(&rooms, *i)?, pick(&rooms, *j)?]).ok(),
        Step::CutOut(i, outer) => cut_out(plan, pick(&rooms, *i)?, outer).ok(),
        Step::Gaps => {
            let (next, _) = bridge_gaps(plan, &gaps(plan), OpeningKind::Door).ok()?;
            Some(next)
        }
        Step::Move(which, how) => edit::move_elements(plan, &some(which), *how).ok(),
        Step::Copy(which, how) => edit::copy_elements(plan, &some(which), *how).ok().map(|(plan, new)| {
            assert!(new.iter().all(|&element| exists(&plan, element)), "a copy that is not there");
            plan
        }),
        Step::Array(which, count, how) => {
            let step = how.vector(Vector::new(1.5, 0.0));
            let array = if count % 2 == 0 {
                Array::Grid { columns: count + 1, rows: 2, column_step: step, row_step: step.left() }
            } else {
                Array::Polar { about: how.point(Point::new(2.0, 2.0)), count: count + 1, step_rad: 1.0 }
            };
            edit::array(plan, &some(which), array).ok().map(|(plan, new)| {
                assert!(new.iter().all(|&element| exists(&plan, element)), "a copy that is not there");
                plan
            })
        }
        Step::OffsetWalls(which, distance_m, to) => {
            let some: Vec<WallId> = which.iter().filter_map(|&i| pick(&walls, i)).collect();
            offset_walls(plan, &some, *distance_m, *to).ok().map(|drawn| drawn.plan)
        }
        Step::OffsetRoom(i, distance_m, is_inside) => {
            offset_room(plan, pick(&rooms, *i)?, *distance_m, *is_inside, 0.1).ok().map(|drawn| drawn.plan)
        }
        Step::SquareUp(i, angle_rad) => {
            let one: Option<BTreeSet<RoomId>> = i.and_then(|i| pick(&rooms, i)).map(|id| [id].into());
            edit::square_up(plan, one.as_ref(), *angle_rad).ok()
        }
        Step::Weld(tolerance_m) => edit::weld(plan, *tolerance_m).ok().map(|weld| weld.plan),
        Step::Align(which, how) => {
            let all = [
                Alignment::Left,
                Alignment::Right,
                Alignment::Top,
                Alignment::Bottom,
                Alignment::Center,
                Alignment::Middle,
            ];
            match all.get(*how) {
                Some(&alignment) => edit::align(plan, &some(which), alignment).ok(),
                None => edit::distribute(plan, &some(which), how % 2 == 0).ok(),
            }
        }
        Step::Thickness(i, t) => edit::set_thickness(plan, &[pick(&walls, *i)?], *t).ok(),
        Step::Remove(i) => edit::remove(plan, &[pick(&all, *i)?]).ok(),
        Step::MoveCorner(i, to) => {
            let corner = pick(&corners, *i)?;
            let moved = edit::move_corners(plan, &[(corner, *to)]).ok()?;
            edit::settle(&moved, &[corner].into()).ok().or(Some(moved))
        }
        Step::Undo | Step::Redo => None,
    }
}

fn exists(plan: &Plan, element: ElementId) -> bool {
    match element {
        ElementId::Corner(id) => plan.corner(id).is_some(),
        ElementId::Wall(id) => plan.wall(id).is_some(),
        ElementId::Room(id) => plan.room(id).is_some(),
        ElementId::Opening(id) => plan.opening(id).is_some(),
        ElementId::Dimension(id) => plan.dimension(id).is_some(),
    }
}

/// Lines that cut a box of 12 by 9 m into a grid of rooms, as a plan.
fn grid(columns: &BTreeSet<i32>, rows: &BTreeSet<i32>) -> Plan {
    let mut paths = vec![points(&[(0., 0.), (12., 0.), (12., 9.), (0., 9.), (0., 0.)])];
    paths.extend(columns.iter().map(|&x| points(&[(f64::from(x), 0.), (f64::from(x), 9.)])));
    paths.extend(rows.iter().map(|&y| points(&[(0., f64::from(y)), (12., f64::from(y))])));
    let mut plan = Plan::default();
    for path in paths {
        plan = draw_walls(&plan, &path, 0.1).unwrap().plan;
    }
    fill_all(&plan).unwrap().plan
}

fn some_grid() -> impl Strategy<Value = Plan> {
    (proptest::collection::btree_set(1..12_i32, 0..4), proptest::collection::btree_set(1..9_i32, 0..3))
        .prop_map(|(columns, rows)| grid(&columns, &rows))
}

proptest! {
    #![proptest_config(config(48))]

    #[test]
    fn invariants_hold_after_every_edit_and_undo_is_exact(steps in proptest::collection::vec(step(), 1..30)) {
        let way = |step: &Step| match step {
            Step::Undo => Way::Back,
            Step::Redo => Way::Forth,
            _ => Way::On,
        };
        invariants_hold_and_undo_is_exact_for(&steps, way, applied)?;
    }

    #[test]
    fn the_same_edits_give_the_same_wherever_they_are_done(
        steps in proptest::collection::vec((path(), boundary(), any::<bool>()), 1..6),
        by in (-50..50_i32, -50..50_i32),
    ) {
        let there = Transform::translation(Vector::new(f64::from(by.0), f64::from(by.1)));
        let map = |path: &[Point]| -> Vec<Point> { path.iter().map(|&p| there.point(p).trimmed()).collect() };
        let (mut here, mut moved) = (Plan::default(), Plan::default());
        // On whole centimetres: what lies a tolerance apart may be joined here and not there. Shifted, not
        // turned: of two equal parts the first one in the plan's order stays the room.
        let coarse = |path: &[Point]| -> Vec<Point> {
            path.iter().map(|p| Point::new((p.x * 100.0).round() / 100.0, (p.y * 100.0).round() / 100.0)).collect()
        };
        for (path, outer, in_free_space) in &steps {
            // Straight walls: where a zigzag crosses itself at a sharp angle, rounding decides what it encloses.
            let (path, outer) = (&coarse(&path[..2]), &coarse(outer));
            if let Ok(drawn) = draw_walls(&here, path, 0.1) { here = drawn.plan; }
            if let Ok(drawn) = draw_walls(&moved, &map(path), 0.1) { moved = drawn.plan; }
            let room = |plan: &Plan, outer: &[Point]| {
                if *in_free_space {
                    draw_room_in_free_space(plan, outer, None, 0.3).map(|drawn| drawn.plan)
                } else {
                    draw_room(plan, outer, None).map(|(plan, _)| plan)
                }
            };
            if let Ok(next) = room(&here, outer) { here = next; }
            if let Ok(next) = room(&moved, &map(outer)) { moved = next; }
        }
        prop_assert_eq!(here.rooms().len(), moved.rooms().len());
        let length_m = |plan: &Plan| -> f64 {
            plan.walls().filter_map(|(_, wall)| plan.wall_segment(wall)).map(Segment::length).sum()
        };
        prop_assert!((length_m(&here) - length_m(&moved)).abs() < 0.01, "{} {}", length_m(&here), length_m(&moved));
        for (p, q) in areas(&here).into_iter().zip(areas(&moved)) {
            prop_assert!((p - q).abs() < 0.02, "{} {}", p, q);
        }
    }

    #[test]
    fn walls_across_rooms_keep_their_area_and_merging_gives_it_back(
        plan in some_grid(),
        paths in proptest::collection::vec(path(), 1..4),
    ) {
        prop_assert_eq!(total_area(&plan), 108.0);
        let mut divided = plan.clone();
        for path in &paths {
            if let Ok(drawn) = draw_walls(&divided, path, 0.1) {
                divided = drawn.plan;
            }
        }
        prop_assert!((total_area(&divided) - 108.0).abs() < 0.05, "{}", total_area(&divided));
        prop_assert!(divided.rooms().len() >= plan.rooms().len());
        let rooms: Vec<RoomId> = divided.rooms().map(|(id, _)| id).collect();
        if rooms.len() > 1 {
            let merged = merge_rooms(&divided, &rooms).unwrap();
            prop_assert_eq!(merged.rooms().len(), 1);
            prop_assert!((total_area(&merged) - 108.0).abs() < 0.05, "{}", total_area(&merged));
            prop_assert_eq!(merged.violations(), vec![]);
        }
    }

    #[test]
    fn what_is_moved_comes_back(plan in some_grid(), how in transform(), which in proptest::collection::vec(0usize..1000, 1..4)) {
        prop_assume!(how.factor() > 0.1);
        let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
        let some: BTreeSet<ElementId> = which.iter().filter_map(|&i| pick(&rooms, i)).map(ElementId::Room).collect();
        let there = edit::move_elements(&plan, &some, how).unwrap();
        for (id, room) in plan.rooms() {
            let (was_m2, now) = (area_m2(&plan, room), there.room(id).unwrap());
            let wanted_m2 = if some.contains(&ElementId::Room(id)) { was_m2 * how.factor() * how.factor() } else { was_m2 };
            prop_assert!((area_m2(&there, now) - wanted_m2).abs() < 0.02 * (1.0 + how.factor()), "{}", id);
        }
        let back = how.inverse().unwrap();
        let again = edit::move_elements(&there, &some, back).unwrap();
        for (id, room) in plan.rooms() {
            let (was, is) = (plan.ring_points(&room.outer), again.ring_points(&again.room(id).unwrap().outer));
            for corner in was {
                prop_assert!(is.iter().any(|at| at.distance(corner) < 3e-3 / how.factor().min(1.0)), "{:?} of {:?}", corner, is);
            }
        }
    }

    #[test]
    fn a_boundary_drawn_with_walls_fills_to_its_area(outer in boundary()) {
        if let Ok((room, id)) = draw_room(&Plan::default(), &outer, Some(0.1)) {
            let area = total_area(&room);
            let walls = edit::remove(&room, &[ElementId::Room(id)]).unwrap();
            let filled = fill_all(&walls).unwrap();
            if let Some(&face) = filled.rooms.first() {
                prop_assert_eq!(filled.rooms.len(), 1);
                prop_assert!((total_area(&filled.plan) - area).abs() < 1e-6);
                prop_assert_eq!(filled.plan.room(face).unwrap().outer.len(), room.room(id).unwrap().outer.len());
            } else {
                prop_assert!(area < 0.6, "a room of {} m² was not filled", area);
            }
        }
    }

    #[test]
    fn rooms_drawn_in_free_space_never_overlap(outers in proptest::collection::vec(boundary(), 1..6)) {
        let mut plan = Plan::default();
        for outer in &outers {
            if let Ok(drawn) = draw_room_in_free_space(&plan, outer, None, 0.3) {
                let next = drawn.plan;
                let (before, after) = (total_area(&plan), total_area(&next));
                let boxes_m2 = drawn.rooms.iter().map(|&id| {
                    let bounds = enfilade::geometry::polygon::bounds(&next.ring_points(&next.room(id).unwrap().outer));
                    bounds.width() * bounds.height()
                });
                prop_assert!(after - before <= boxes_m2.sum::<f64>() + 0.01);
                plan = next;
            }
        }
        let shapes = enfilade::topology::RoomShapes::new(&plan);
        for x in 0..40 {
            for y in 0..40 {
                let at = Point::new(f64::from(x) * 0.25 + 0.11, f64::from(y) * 0.25 + 0.13);
                let inside = shapes.at(at).into_iter().filter(|&i| {
                    shapes.all()[i].rings().flat_map(|ring| enfilade::geometry::polygon::edges(ring)).all(|e| e.distance(at) > 0.01)
                });
                prop_assert!(inside.count() <= 1, "two rooms at {:?}", at);
            }
        }
    }
}
