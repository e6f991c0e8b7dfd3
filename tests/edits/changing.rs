//! Moving, copying, tidying, and gaps in walls.

use std::collections::BTreeSet;

use enfilade::edit::{
    self, Alignment, Array, Reach, bridge_gaps, draw_room, draw_walls, fill_all, offset_room, offset_walls,
};
use enfilade::geometry::{Point, Transform, Vector};
use enfilade::plan::{ElementId, LeafSide, Opening, OpeningKind, Place, Plan, RoomId, Swing, WallId};
use enfilade::topology::gaps;

use super::support::{area_m2, areas, points, rectangle, total_area};

/// Two rooms with walls and a door between them.
fn two_rooms() -> (Plan, [RoomId; 2], enfilade::plan::OpeningId) {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(4., 0., 8., 3.), Some(0.1)).unwrap();
    let towards = Some(Point::new(5., 1.2));
    let (plan, door) = edit::place_opening(&plan, OpeningKind::Door, Point::new(4., 1.), 0.9, 0.1, towards).unwrap();
    (plan, [left, right], door)
}

/// The wall that an opening is in.
fn host_of(plan: &Plan, opening: enfilade::plan::OpeningId) -> WallId {
    let Place::Hosted { from, to, .. } = plan.opening(opening).unwrap().place else { panic!("hosted") };
    let is_it = |wall: &enfilade::plan::Wall| [[from, to], [to, from]].contains(&[wall.from, wall.to]);
    plan.walls().find(|(_, wall)| is_it(wall)).unwrap().0
}

fn rooms(ids: &[RoomId]) -> BTreeSet<ElementId> {
    ids.iter().map(|&id| ElementId::Room(id)).collect()
}

#[test]
fn rooms_move_alone_walls_take_neighbours_along_and_mirrored_doors_open_into_their_room() {
    let (plan, [left, right], door) = two_rooms();
    let by = Vector::new(1.0, 0.0);
    let moved = edit::move_elements(&plan, &rooms(&[right]), Transform::translation(by)).unwrap();
    assert_eq!((areas(&moved), moved.violations()), (vec![12.0, 12.0], vec![]), "the left room stays");
    assert_eq!((moved.corners().len(), moved.walls().len()), (8, 8), "each has walls of its own");
    let segment = moved.opening_segment(moved.opening(door).unwrap()).unwrap();
    assert_eq!(segment.midpoint(), Point::new(4., 1.), "the door stays with the wall that stays");
    let back = edit::move_elements(&moved, &rooms(&[right]), Transform::translation(-by)).unwrap();
    assert_eq!((back.corners().len(), back.walls().len(), areas(&back)), (6, 7, areas(&plan)));
    // Of the wall between them both follow.
    let between = host_of(&plan, door);
    let dragged = edit::move_picked(&plan, &[ElementId::Wall(between)].into(), by, Reach::Run, true).unwrap().plan;
    assert_eq!((areas(&dragged), dragged.corners().len()), (vec![9.0, 15.0], 6));
    let refused =
        edit::move_elements(&plan, &[ElementId::Wall(between)].into(), Transform::rotation(Point::default(), 1.0));
    assert!(refused.unwrap_err().0.contains("select the rooms too"));
    let mirror = Transform::reflection(Point::new(4., 0.), Point::new(4., 1.)).unwrap();
    let mirrored = edit::move_elements(&plan, &rooms(&[left, right]), mirror).unwrap();
    let side = |plan: &Plan| plan.opening(door).unwrap().swing.unwrap().side;
    assert_ne!(side(&plan), side(&mirrored));
    assert_eq!(edit::move_elements(&mirrored, &rooms(&[left, right]), mirror).unwrap(), plan);
    let twice = edit::move_elements(&plan, &rooms(&[left, right]), Transform::scaling(Point::default(), 2.0)).unwrap();
    assert_eq!((areas(&twice), twice.violations()), (vec![48.0, 48.0], vec![]));
    let Place::Hosted { at_m, width_m, .. } = twice.opening(door).unwrap().place else { panic!("hosted") };
    assert!((at_m == 2.0 || at_m == 4.0) && width_m == 1.8, "{at_m} {width_m}");
    // A door alone slides along its wall.
    let by = Transform::translation(by);
    let slid = edit::move_elements(&plan, &[ElementId::Opening(door)].into(), by).unwrap();
    assert_eq!(slid.opening(door), plan.opening(door));
    let up = Transform::translation(Vector::new(3.0, 1.0));
    let slid = edit::move_elements(&plan, &[ElementId::Opening(door)].into(), up).unwrap();
    let segment = slid.opening_segment(slid.opening(door).unwrap()).unwrap();
    assert_eq!(segment.midpoint(), Point::new(4., 2.));
    assert!(edit::move_elements(&plan, &rooms(&[left]), Transform::scaling(Point::default(), 0.0)).is_err());
}

#[test]
fn copies_share_edges_with_what_they_touch() {
    let (plan, [left, right], door) = two_rooms();
    let both = rooms(&[left, right]);
    let walls: BTreeSet<ElementId> = plan.walls().map(|(id, _)| ElementId::Wall(id)).collect();
    let all: BTreeSet<ElementId> = both.union(&walls).copied().collect();
    let (copied, new) = edit::copy_elements(&plan, &all, Transform::translation(Vector::new(8.0, 0.0))).unwrap();
    assert_eq!(copied.violations(), []);
    assert_eq!((copied.rooms().len(), copied.openings().len(), copied.walls().len()), (4, 2, 13));
    assert_eq!(copied.corners().len(), 10, "those between the original and the copy exist once");
    assert!(new.len() == 9 && new.iter().all(|&element| !plan.has(element)), "the wall between them is not new");
    let (grid, copies) = edit::array(
        &plan,
        &both,
        Array::Grid { columns: 2, rows: 3, column_step: Vector::new(8., 0.), row_step: Vector::new(0., 3.) },
    )
    .unwrap();
    assert_eq!((grid.rooms().len(), grid.violations(), total_area(&grid)), (12, vec![], 144.0));
    assert_eq!((grid.corners().len(), grid.openings().len()), (20, 6));
    assert_eq!(copies.len(), 10 + 5 + 24, "rooms, doors and walls");
    let polar = Array::Polar { about: Point::new(-5., -5.), count: 4, step_rad: std::f64::consts::FRAC_PI_2 };
    let (polar, _) = edit::array(&plan, &both, polar).unwrap();
    assert_eq!((polar.rooms().len(), polar.violations(), areas(&polar)), (8, vec![], vec![12.0; 8]));
    assert!(edit::array(&plan, &both, Array::Polar { about: Point::default(), count: 1, step_rad: 1.0 }).is_err());
    // Between plans: identities are kept where they are free; a door alone finds its wall again.
    let clip = edit::fragment(&plan, &all).unwrap();
    let (pasted, _) = edit::insert(&Plan::default(), &clip, Transform::IDENTITY).unwrap();
    assert!(pasted.room(left).is_some() && pasted.opening(door).is_some());
    assert_eq!((areas(&pasted), pasted.walls().len()), (areas(&plan), plan.walls().len()));
    let alone = edit::fragment(&plan, &[ElementId::Opening(door)].into()).unwrap();
    let (with_two, new) = edit::insert(&plan, &alone, Transform::translation(Vector::new(0., 1.2))).unwrap();
    let Some(&ElementId::Opening(second)) = new.first() else { panic!("an opening") };
    assert!(matches!(with_two.opening(second).unwrap().place, Place::Hosted { .. }));
    assert!(edit::fragment(&plan, &BTreeSet::new()).is_err());
}

#[test]
fn nearly_right_angles_become_right_and_stay_shared() {
    let (plan, left) =
        draw_room(&Plan::default(), &points(&[(0., 0.), (4.02, 0.03), (3.98, 3.), (0.03, 2.96)]), None).unwrap();
    let (plan, right) = draw_room(&plan, &points(&[(4.02, 0.03), (8., 0.), (8., 3.), (3.98, 3.)]), None).unwrap();
    let squared = edit::square_up(&plan, None, 0.1).unwrap();
    for id in [left, right] {
        let ring = squared.ring_points(&squared.room(id).unwrap().outer);
        for i in 0..4 {
            let (u, v) = (ring[(i + 1) % 4] - ring[i], ring[(i + 2) % 4] - ring[(i + 1) % 4]);
            assert!(u.dot(v).abs() < 1e-3 * u.length() * v.length(), "{ring:?}");
        }
    }
    assert_eq!(squared.corners().len(), 6);
    for (id, corner) in squared.corners() {
        assert!(corner.position.distance(plan.position(id).unwrap()) < 0.05);
    }
    assert_eq!(edit::square_up(&squared, None, 0.1).unwrap(), squared, "done is done");
    // A slanting wall stays slanting.
    let (slanting, _) = draw_room(&Plan::default(), &points(&[(0., 0.), (4., 0.), (6., 3.), (0., 3.)]), None).unwrap();
    assert_eq!(edit::square_up(&slanting, None, 0.1).unwrap(), slanting);
    // Turned as a whole it is squared up along its own directions.
    let turn = Transform::rotation(Point::default(), 0.5);
    let all: BTreeSet<ElementId> = plan.rooms().map(|(id, _)| ElementId::Room(id)).collect();
    let turned = edit::square_up(&edit::move_elements(&plan, &all, turn).unwrap(), None, 0.1).unwrap();
    for (id, corner) in turned.corners() {
        assert!(corner.position.distance(turn.point(plan.position(id).unwrap())) < 0.06);
    }
    assert!((total_area(&turned) - total_area(&squared)).abs() < 0.1);
    assert!(edit::square_up(&Plan::default(), None, 0.1).is_err());
}

#[test]
fn welding_joins_corners_and_puts_them_on_edges() {
    let (plan, _) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    let (plan, _) = draw_room(&plan, &rectangle(4.02, 0., 8., 3.), Some(0.1)).unwrap();
    let (plan, _) = draw_room(&plan, &rectangle(1., 3.03, 2., 5.), None).unwrap();
    let (plan, door) = edit::place_opening(&plan, OpeningKind::Door, Point::new(4.02, 1.), 0.9, 0.005, None).unwrap();
    let weld = edit::weld(&plan, 0.05).unwrap();
    assert_eq!((weld.merged.len(), weld.onto_edges.len(), weld.plan.violations()), (2, 2, vec![]));
    assert_eq!((weld.plan.corners().len(), weld.plan.walls().len()), (10, 9));
    assert!((total_area(&weld.plan) - 26.0).abs() < 0.2);
    let middle = weld.plan.opening_segment(weld.plan.opening(door).unwrap()).unwrap().midpoint();
    assert!((middle.y - 1.0).abs() < 0.01 && (middle.x - 4.0).abs() < 0.03, "{middle:?}");
    let again = edit::weld(&weld.plan, 0.05).unwrap();
    assert!(again.is_empty() && again.plan == weld.plan);
    assert!(edit::weld(&plan, 5.0).unwrap_err().0.contains("tolerance"));
    assert!(edit::weld(&plan, 0.0).is_err());
}

#[test]
fn what_was_dragged_onto_something_is_joined_with_it() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(6., 0., 9., 2.), Some(0.1)).unwrap();
    let corner = |plan: &Plan, x: f64, y: f64| {
        plan.corners().find(|(_, corner)| corner.position == Point::new(x, y)).map(|(id, _)| id).unwrap()
    };
    let (lower, upper) = (corner(&plan, 6., 0.), corner(&plan, 6., 2.));
    let there = [(lower, Point::new(4., 0.)), (upper, Point::new(4., 2.))];
    let moved = edit::move_corners(&plan, &there).unwrap();
    let settled = edit::settle(&moved, &[lower, upper].into()).unwrap();
    assert_eq!((settled.violations(), settled.corners().len(), settled.walls().len()), (vec![], 7, 8));
    assert_eq!(settled.room(left).unwrap().outer.len(), 5);
    assert!(settled.corner(upper).is_some() && settled.corner(lower).is_none(), "what was there stays");
    assert_eq!(areas(&settled), [10.0, 12.0]);
    // A room dragged flat onto its own side is refused.
    let flat = edit::move_corners(&plan, &[(upper, Point::new(9., 0.)), (corner(&plan, 9., 2.), Point::new(6., 0.))]);
    let flat = flat.unwrap();
    let all: BTreeSet<_> = flat.room(right).unwrap().outer.iter().copied().collect();
    assert!(edit::settle(&flat, &all).is_err());
    assert_eq!(edit::settle(&plan, &all).unwrap(), plan);
}

#[test]
fn elements_align_and_spread() {
    let mut plan = Plan::default();
    let mut ids = Vec::new();
    for (x, y) in [(0., 0.), (5., 0.3), (13., 0.1)] {
        let (next, id) = draw_room(&plan, &rectangle(x, y, x + 3., y + 3.), None).unwrap();
        plan = next;
        ids.push(id);
    }
    let left = |plan: &Plan, id: RoomId| plan.ring_points(&plan.room(id).unwrap().outer)[0];
    let aligned = edit::align(&plan, &rooms(&ids), Alignment::Bottom).unwrap();
    assert_eq!(ids.iter().map(|&id| left(&aligned, id).y).collect::<Vec<_>>(), [0.0; 3]);
    let middle = edit::align(&plan, &rooms(&ids), Alignment::Middle).unwrap();
    assert_eq!(left(&middle, ids[0]).y, 0.15);
    let spread = edit::distribute(&aligned, &rooms(&ids), false).unwrap();
    assert_eq!(ids.iter().map(|&id| left(&spread, id).x).collect::<Vec<_>>(), [0.0, 6.5, 13.0]);
    assert!(edit::align(&plan, &rooms(&ids[..1]), Alignment::Left).is_err());
    assert!(edit::distribute(&plan, &rooms(&ids[..2]), false).is_err());
    let (two, both, _) = two_rooms();
    assert!(edit::align(&two, &rooms(&both), Alignment::Left).unwrap_err().0.contains("share"));
    let walls: Vec<WallId> = two.walls().map(|(id, _)| id).collect();
    let thick = edit::set_thickness(&two, &walls, 0.3).unwrap();
    assert!(thick.walls().all(|(_, wall)| wall.thickness_m == 0.3));
    assert!(edit::set_thickness(&two, &walls, -1.0).is_err());
}

#[test]
fn gaps_of_a_doors_width_between_walls_in_line_become_doorways() {
    let mut plan = Plan::default();
    for path in [
        [(0., 0.), (3., 0.)],
        [(3.9, 0.02), (8., 0.)],
        [(8.2, 0.), (9., 0.)],
        [(11., 0.), (12., 0.)],
        [(12.9, 0.5), (14., 0.5)],
        [(0., 0.), (0., 4.)],
        [(0., 4.), (8., 4.)],
        [(8., 4.), (8., 0.)],
    ] {
        plan = draw_walls(&plan, &points(&path), 0.1).unwrap().plan;
    }
    let found = gaps(&plan);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].width_m - 0.9).abs() < 0.01);
    let (bridged, openings) = bridge_gaps(&plan, &found, OpeningKind::Door).unwrap();
    assert_eq!((openings.len(), bridged.violations()), (1, vec![]));
    assert!(gaps(&bridged).is_empty() && bridge_gaps(&bridged, &[], OpeningKind::Door).is_err());
    assert!(bridge_gaps(&bridged, &found, OpeningKind::Door).unwrap_err().0.contains("already"));
    let filled = fill_all(&bridged).unwrap();
    assert_eq!(filled.rooms.len(), 1, "the gap is closed");
}

#[test]
fn parallels_of_walls_and_rooms() {
    let (plan, room) = draw_room(&Plan::default(), &rectangle(0., 0., 6., 4.), Some(0.2)).unwrap();
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).collect();
    let inner = offset_walls(&plan, &walls, 1.0, Point::new(3., 2.)).unwrap();
    assert_eq!((inner.walls.len(), areas(&inner.plan)), (4, vec![8.0, 16.0]));
    let outer = offset_walls(&plan, &walls, 1.0, Point::new(3., -2.)).unwrap();
    assert_eq!((outer.walls.len(), outer.plan.rooms().len()), (4, 1));
    assert!(outer.plan.walls().all(|(_, wall)| wall.thickness_m == 0.2));
    assert!(offset_walls(&plan, &walls, 3.0, Point::new(3., 2.)).unwrap_err().0.contains("too large"));
    let loggia = offset_room(&plan, room, 0.5, false, 0.1).unwrap();
    assert_eq!(fill_all(&loggia.plan).unwrap().plan.rooms().len(), 2);
    let one = offset_walls(&plan, &walls[..1], 0.5, Point::new(3., 2.)).unwrap();
    assert_eq!((one.walls.len(), one.plan.violations()), (1, vec![]));
}

#[test]
fn doors_flip_and_survive() {
    let (plan, [left, right], door) = two_rooms();
    let shown = Swing { hinge_at_start: true, side: LeafSide::Left };
    let unset = edit::set_swing(&plan, door, None).unwrap();
    let flipped = edit::flip_hinge(&unset, door, shown).unwrap();
    assert_eq!(flipped.opening(door).unwrap().swing, Some(Swing { hinge_at_start: false, ..shown }));
    let flipped = edit::flip_side(&flipped, door, shown).unwrap();
    assert_eq!(
        flipped.opening(door).unwrap().swing,
        Some(Swing { hinge_at_start: false, side: LeafSide::Right }),
        "what is set counts, not what was shown"
    );
    let passage = edit::set_opening_kind(&flipped, door, OpeningKind::Passage).unwrap();
    assert_eq!(passage.opening(door).unwrap().swing, None);
    // The wall goes, and its door with it; the edge between the rooms stays.
    let without = edit::remove(&plan, &[ElementId::Wall(host_of(&plan, door))]).unwrap();
    assert!(without.opening(door).is_none() && areas(&without) == areas(&plan));
    let joined = edit::rooms_joined_by(&plan, &without, &[ElementId::Wall(host_of(&plan, door))]).unwrap();
    assert_eq!(BTreeSet::from(joined), BTreeSet::from([left, right]));
    assert_eq!(areas(&edit::merge_rooms(&without, &joined).unwrap()), [24.0]);
    // A free opening is resized about its middle.
    let free = Opening::new(OpeningKind::Passage, Place::Free { from: Point::new(1., 1.), to: Point::new(2., 1.) });
    let (with_free, free) = edit::add_opening(&plan, free).unwrap();
    let resized = edit::resize_opening(&with_free, free, 0.5).unwrap();
    let segment = resized.opening_segment(resized.opening(free).unwrap()).unwrap();
    assert_eq!((segment.a, segment.b), (Point::new(1.25, 1.), Point::new(1.75, 1.)));
    let slid = edit::slide_opening(&with_free, free, Point::new(5., 7.)).unwrap();
    assert_eq!(slid.opening_segment(slid.opening(free).unwrap()).unwrap().midpoint(), Point::new(5., 1.));
    assert!(area_m2(&plan, plan.room(left).unwrap()) == area_m2(&plan, plan.room(right).unwrap()));
}

/// How far the corners of a room are from right angles at most, in degrees.
fn most_off_right_deg(plan: &Plan, id: RoomId) -> f64 {
    let ring = plan.ring_points(&plan.room(id).unwrap().outer);
    let n = ring.len();
    let off = |i: usize| {
        let (u, v) = (ring[(i + 1) % n] - ring[i], ring[(i + 2) % n] - ring[(i + 1) % n]);
        (u.dot(v) / (u.length() * v.length())).asin().to_degrees().abs()
    };
    (0..n).map(off).fold(0.0, f64::max)
}

/// A nearly rectangular room, turned about its first corner.
fn turned(at: (f64, f64), turn_deg: f64) -> Vec<Point> {
    let at = Point::new(at.0, at.1);
    let ring = points(&[(0., 0.), (6., 0.05), (5.96, 4.), (0.04, 3.95)]);
    let turn = Transform::rotation(Point::default(), turn_deg.to_radians());
    ring.into_iter().map(|corner| (at + (turn.point(corner) - Point::default())).trimmed()).collect()
}

#[test]
fn each_wing_is_squared_up_in_its_own_direction() {
    for turn_deg in [15.0, 30.0, 45.0, 62.0, 80.0] {
        let (plan, first) = draw_room(&Plan::default(), &turned((0., 0.), 0.3), Some(0.1)).unwrap();
        let (plan, second) = draw_room(&plan, &turned((20., 0.), turn_deg), Some(0.1)).unwrap();
        let squared = edit::square_up(&plan, None, 0.1745).unwrap();
        for id in [first, second] {
            assert!(most_off_right_deg(&squared, id) < 0.01, "{turn_deg}");
            let alone = edit::square_up(&plan, Some(&[id].into()), 0.1745).unwrap();
            assert_eq!(
                squared.ring_points(&squared.room(id).unwrap().outer),
                alone.ring_points(&alone.room(id).unwrap().outer)
            );
        }
        assert_eq!(edit::square_up(&squared, None, 0.1745).unwrap(), squared, "done is done");
    }
    // Turned by less than the threshold, and drawn too well to be drawn badly.
    let exact = |x: f64, turn_deg: f64| -> Vec<Point> {
        let turn = Transform::rotation(Point::default(), turn_deg.to_radians());
        rectangle(0., 0., 6., 4.).into_iter().map(|corner| turn.point(corner) + Vector::new(x, 0.)).collect()
    };
    let (plan, _) = draw_room(&Plan::default(), &exact(0., 0.), None).unwrap();
    let (plan, wing) = draw_room(&plan, &exact(20., 7.), None).unwrap();
    let squared = edit::square_up(&plan, None, 0.1745).unwrap();
    for (id, corner) in squared.corners() {
        assert!(corner.position.distance(plan.position(id).unwrap()) < 2e-4);
    }
    assert!(most_off_right_deg(&squared, wing) < 0.01);
    // Where two wings share a wall, both come out right.
    let (plan, main) =
        draw_room(&Plan::default(), &points(&[(0., 0.), (6., 0.04), (9., 3.02), (9., 8.), (0., 8.03)]), None).unwrap();
    let (plan, side) = draw_room(&plan, &points(&[(6., 0.04), (10.02, -4.), (13., -0.97), (9., 3.02)]), None).unwrap();
    let squared = edit::square_up(&plan, None, 0.1745).unwrap();
    assert!(most_off_right_deg(&squared, side) < 0.01);
    let ring = squared.ring_points(&squared.room(main).unwrap().outer);
    assert!((ring[0].y - ring[1].y).abs() < 1e-3 && (ring[2].x - ring[3].x).abs() < 1e-3, "{ring:?}");
    // Walls that bound no room have wings as well.
    let walls = |plan: &Plan, path: &[(f64, f64)]| edit::draw_walls(plan, &points(path), 0.1).unwrap().plan;
    let plan = walls(&Plan::default(), &[(0., 0.), (8., 0.1), (8., 4.), (0., 4.1)]);
    let plan = walls(&plan, &[(12.01, 0.02), (16.27, 4.28), (13.43, 7.11), (9.13, 2.83)]);
    let squared = edit::square_up(&plan, None, 0.1745).unwrap();
    for (_, wall) in squared.walls() {
        let degrees = squared.wall_segment(wall).unwrap().vector().angle_rad().to_degrees().rem_euclid(45.0);
        assert!(degrees.min(45.0 - degrees) < 1.0, "{degrees}");
    }
    let corners: Vec<Point> = [(16.27, 4.28), (13.43, 7.11)].map(|(x, y)| Point::new(x, y)).to_vec();
    let near = |at: Point| {
        squared.corners().map(|(_, it)| it.position).min_by(|p, q| p.distance(at).total_cmp(&q.distance(at))).unwrap()
    };
    let (a, b, c) = (near(Point::new(12.01, 0.02)), near(corners[0]), near(corners[1]));
    assert!(((b - a).dot(c - b) / ((b - a).length() * (c - b).length())).abs() < 1e-4);
}

#[test]
fn round_walls_are_left_alone_when_squaring_up() {
    let chords = |from: (f64, f64), by: (f64, f64), to: (f64, f64)| {
        let [from, by, to] = [from, by, to].map(|(x, y)| Point::new(x, y));
        enfilade::geometry::path::arc(from, by, to, 0.02).into_iter().map(Point::trimmed).collect::<Vec<Point>>()
    };
    // A hall with an apse: its straight walls become right, its chords stay.
    let apse = chords((8., 6.), (4., 10.), (0., 6.04));
    let mut outline = points(&[(0., 0.), (8., 0.06)]);
    outline.extend(&apse);
    let (plan, hall) = draw_room(&Plan::default(), &outline, Some(0.1)).unwrap();
    let squared = edit::square_up(&plan, None, 0.1745).unwrap();
    let ring = squared.ring_points(&squared.room(hall).unwrap().outer);
    assert!(ring.iter().any(|p| p.y.abs() > 1e-3));
    for corner in &apse[1..apse.len() - 1] {
        assert!(ring.contains(corner), "{corner:?} moved");
    }
    // A round room beside a square one; a round wall that bounds none.
    let mut round = chords((20., 0.), (23., 3.), (20., 6.));
    round.extend(chords((20., 6.), (17., 3.), (20., 0.)).into_iter().skip(1));
    round.pop();
    let (plan, tower) = draw_room(&plan, &round, None).unwrap();
    let bow = chords((30., 0.), (33., 3.), (36., 0.));
    let plan = edit::draw_walls(&plan, &bow, 0.1).unwrap().plan;
    let squared = edit::square_up(&plan, None, 0.1745).unwrap();
    assert_eq!(
        squared.ring_points(&squared.room(tower).unwrap().outer),
        plan.ring_points(&plan.room(tower).unwrap().outer)
    );
    let is_corner = |at: &Point| squared.corners().any(|(_, corner)| corner.position == *at);
    assert!(bow.iter().all(is_corner));
    // Alone there is nothing to square up.
    let (alone, _) = draw_room(&Plan::default(), &round, None).unwrap();
    assert!(edit::square_up(&alone, None, 0.1745).is_err());
}
