//! Random sequences of the basic edits on corners, walls, rooms and openings.

use enfilade::edit;
use enfilade::geometry::Point;
use enfilade::labels::Label;
use enfilade::plan::{
    CornerId, ElementId, Joint, LabelOrigin, Opening, OpeningId, OpeningKind, Place, Plan, Room, RoomId, RoomLabel,
    WallId,
};
use proptest::prelude::*;

use super::support::{Way, invariants_hold_and_undo_is_exact_for};

/// An edit with indices instead of ids: they pick among what the plan then has.
#[derive(Clone, Debug)]
enum Step {
    Corner(f64, f64),
    Move(usize, f64, f64),
    Wall(usize, usize, f64),
    Room(Vec<usize>),
    Hosted(usize, f64, f64),
    Free(f64, f64, f64, f64, usize),
    Remove(usize),
    Label(usize, usize),
    Function(usize),
    Undo,
    Redo,
}

fn step() -> impl Strategy<Value = Step> {
    let metre = || prop_oneof![9 => -50.0..50.0, 1 => Just(1e9), 1 => Just(f64::NAN)];
    let index = || 0usize..1000;
    prop_oneof![
        6 => (metre(), metre()).prop_map(|(x, y)| Step::Corner(x, y)),
        2 => (index(), metre(), metre()).prop_map(|(i, x, y)| Step::Move(i, x, y)),
        4 => (index(), index(), -1.0..11.0).prop_map(|(i, j, t)| Step::Wall(i, j, t)),
        4 => proptest::collection::vec(index(), 2..6).prop_map(Step::Room),
        3 => (index(), -1.0..20.0, -1.0..3.0).prop_map(|(i, at, w)| Step::Hosted(i, at, w)),
        2 => (metre(), metre(), metre(), metre(), index()).prop_map(|(a, b, c, d, r)| Step::Free(a, b, c, d, r)),
        2 => index().prop_map(Step::Remove),
        1 => (index(), 0usize..6).prop_map(|(i, l)| Step::Label(i, l)),
        1 => index().prop_map(Step::Function),
        2 => Just(Step::Undo),
        1 => Just(Step::Redo),
    ]
}

fn pick<T: Copy>(all: &[T], index: usize) -> Option<T> {
    (!all.is_empty()).then(|| all[index % all.len()])
}

/// The plan after the step; `None` where there is nothing to apply it to or it was refused.
fn applied(plan: &Plan, step: &Step) -> Option<Plan> {
    let corners: Vec<CornerId> = plan.corners().map(|(id, _)| id).collect();
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).collect();
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    let openings: Vec<OpeningId> = plan.openings().map(|(id, _)| id).collect();
    match step {
        Step::Corner(x, y) => edit::add_corner(plan, Point::new(*x, *y)).ok().map(|(plan, _)| plan),
        Step::Move(i, x, y) => edit::move_corners(plan, &[(pick(&corners, *i)?, Point::new(*x, *y))]).ok(),
        Step::Wall(i, j, thickness) => {
            edit::add_wall(plan, pick(&corners, *i)?, pick(&corners, *j)?, *thickness).ok().map(|(plan, _)| plan)
        }
        Step::Room(ring) => {
            let outer: Option<Vec<CornerId>> = ring.iter().map(|&i| pick(&corners, i)).collect();
            edit::add_room(plan, Room { outer: outer?.into(), ..Room::default() }).ok().map(|(plan, _)| plan)
        }
        Step::Hosted(i, at_m, width_m) => {
            let wall = plan.wall(pick(&walls, *i)?)?;
            let place = Place::Hosted { from: wall.from, to: wall.to, at_m: *at_m, width_m: *width_m };
            edit::add_opening(plan, Opening::new(OpeningKind::Door, place)).ok().map(|(plan, _)| plan)
        }
        Step::Free(a, b, c, d, room) => {
            let mut opening =
                Opening::new(OpeningKind::Passage, Place::Free { from: Point::new(*a, *b), to: Point::new(*c, *d) });
            opening.pinned = pick(&rooms, *room).map(|room| [Joint::Room(room), Joint::Outside]);
            edit::add_opening(plan, opening).ok().map(|(plan, _)| plan)
        }
        Step::Remove(i) => {
            let all: Vec<ElementId> = corners
                .into_iter()
                .map(ElementId::Corner)
                .chain(walls.into_iter().map(ElementId::Wall))
                .chain(rooms.into_iter().map(ElementId::Room))
                .chain(openings.into_iter().map(ElementId::Opening))
                .collect();
            let chosen = pick(&all, *i)?;
            let after = edit::remove(plan, &[chosen]).expect("what exists can be removed");
            for gone in edit::removed_with(plan, &[chosen]) {
                assert!(edit::remove(&after, &[gone]).is_err(), "{gone} was announced as removed but is still there");
            }
            Some(after)
        }
        Step::Label(i, l) => {
            let label = Label::ALL.get(*l).map(|&label| RoomLabel { label, origin: LabelOrigin::Person });
            edit::set_label(plan, pick(&rooms, *i)?, label).ok()
        }
        Step::Function(i) => edit::set_function(plan, pick(&rooms, *i)?, " office ").ok(),
        Step::Undo | Step::Redo => None,
    }
}

proptest! {
    #![proptest_config(super::support::config(128))]

    #[test]
    fn invariants_hold_and_undo_is_exact(steps in proptest::collection::vec(step(), 1..60)) {
        let way = |step: &Step| match step {
            Step::Undo => Way::Back,
            Step::Redo => Way::Forth,
            _ => Way::On,
        };
        invariants_hold_and_undo_is_exact_for(&steps, way, applied)?;
    }
}

#[test]
fn moving_a_corner_moves_all_that_share_it_and_keeps_the_door() {
    let mut plan = Plan::default();
    let mut corners = Vec::new();
    for (x, y) in [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (8.0, 0.0), (8.0, 3.0)] {
        let (next, id) = edit::add_corner(&plan, Point::new(x, y)).expect("within the drawing area");
        plan = next;
        corners.push(id);
    }
    let [a, b, c, d, e, f] = corners[..] else { unreachable!("six corners were added") };
    let (plan, left) = edit::add_room(&plan, Room { outer: [a, b, c, d].into(), ..Room::default() }).expect("a room");
    let (plan, right) = edit::add_room(&plan, Room { outer: [b, e, f, c].into(), ..Room::default() }).expect("a room");
    let door = Opening::new(OpeningKind::Door, Place::Hosted { from: b, to: c, at_m: 2.4, width_m: 0.9 });
    let (plan, door) = edit::add_opening(&plan, door).expect("a door");
    let moved = edit::move_corners(&plan, &[(c, Point::new(4.0, 2.0))]).expect("a valid move");
    let area = |plan: &Plan, room| {
        enfilade::geometry::polygon::signed_area(&plan.ring_points(&plan.room(room).expect("exists").outer)).abs()
    };
    assert_eq!((area(&plan, left), area(&plan, right)), (12.0, 12.0));
    assert_eq!((area(&moved, left), area(&moved, right)), (10.0, 10.0));
    let Place::Hosted { at_m, .. } = moved.opening(door).expect("still there").place else { panic!("still hosted") };
    assert_eq!(at_m, 1.55, "the door stays on its shortened wall, all of it");
    assert!(edit::move_corners(&plan, &[(c, Point::new(4.0, 0.0))]).is_err(), "its wall would lose its length");
    // Removing one room keeps the shared edge and the door on it; removing both takes it along.
    let one = edit::remove(&plan, &[ElementId::Room(left)]).expect("exists");
    assert!(one.opening(door).is_some() && one.corner(a).is_none() && one.corner(b).is_some());
    let none = edit::remove(&plan, &[ElementId::Room(left), ElementId::Room(right)]).expect("both exist");
    assert!(none.is_empty());
}
