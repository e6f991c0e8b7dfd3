//! Drawing where there is no room yet, and merging rooms.

use enfilade::edit;
use enfilade::edit::{GAP_BETWEEN_ROOMS_M, draw_room, draw_room_in_free_space, draw_walls, merge_rooms, split_room};
use enfilade::geometry::Point;
use enfilade::plan::{Joint, Opening, OpeningKind, Place, Plan};

use super::support::{area_m2, areas, points, rectangle};

#[test]
fn a_room_drawn_over_others_takes_what_is_free() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(4.1, 0.02, 8., 3.), None).unwrap();
    // A corridor above both, drawn generously into them; the gap between them stays free.
    let draw_all = |plan: &Plan, outer: &[Point]| draw_room_in_free_space(plan, outer, None, GAP_BETWEEN_ROOMS_M);
    let draw = |plan: &Plan, outer: &[Point]| draw_all(plan, outer).map(|drawn| (drawn.plan, drawn.rooms[0]));
    let (next, corridor) = draw(&plan, &rectangle(0., 1.5, 8., 5.)).unwrap();
    assert_eq!(next.violations(), []);
    let room = next.room(corridor).unwrap();
    assert_eq!((area_m2(&next, room), room.outer.len()), (16.0, 6));
    for other in [left, right] {
        let shared = next.room(other).unwrap().outer.iter().filter(|corner| room.outer.contains(corner)).count();
        assert_eq!(shared, 2, "its two upper corners");
    }
    // Around both: they become holes, the gap between them does not join in.
    let (next, around) = draw(&plan, &rectangle(-2., -2., 10., 5.)).unwrap();
    let room = next.room(around).unwrap();
    assert_eq!((room.holes.len(), next.violations()), (1, vec![]));
    assert!((area_m2(&next, room) - (84.0 - 12.0 - 3.9 * 2.98 - 0.1 * 2.98)).abs() < 0.02, "{}", area_m2(&next, room));
    // Two pieces are two rooms, the larger first; nothing is left within a room.
    let drawn = draw_all(&plan, &rectangle(-1., 1., 12., 2.)).unwrap();
    let pieces: Vec<f64> = drawn.rooms.iter().map(|&id| area_m2(&drawn.plan, drawn.plan.room(id).unwrap())).collect();
    assert_eq!((pieces, drawn.left_out_m2, drawn.plan.violations()), (vec![4.0, 1.0], 0.0, vec![]));
    // A piece that is smaller than any room is left out, and known to be.
    let drawn = draw_all(&plan, &rectangle(-0.5, 1., 12., 1.4)).unwrap();
    assert_eq!(drawn.rooms.len(), 1);
    assert!((drawn.left_out_m2 - 0.2).abs() < 1e-9, "{}", drawn.left_out_m2);
    assert!(draw(&plan, &rectangle(1., 1., 3., 2.)).unwrap_err().0.contains("cover"));
    assert!(draw(&plan, &points(&[(0., 5.), (4., 8.), (4., 5.), (0., 8.)])).unwrap_err().0.contains("crosses"));
    // A narrow room drawn on purpose is kept, and so is a sharp corner in the open.
    let (shaft, id) = draw(&plan, &rectangle(10., 0., 10.2, 3.)).unwrap();
    assert!((area_m2(&shaft, shaft.room(id).unwrap()) - 0.6).abs() < 1e-9);
    let (sharp, id) = draw(&plan, &points(&[(0., 3.), (8., 3.), (8., 9.), (7.9, 9.)])).unwrap();
    assert!((area_m2(&sharp, sharp.room(id).unwrap()) - 24.3).abs() < 0.05);
    // With walls: only where none stands yet.
    let walled = draw_room_in_free_space(&plan, &rectangle(0., 1.5, 4., 5.), Some(0.1), 0.3).unwrap().plan;
    assert_eq!((plan.walls().len(), walled.walls().len()), (4, 7));
}

#[test]
fn what_is_left_out_beside_rooms_does_not_hang_on_where_they_lie() {
    let room = [(3., 9.), (0., 9.), (0., 7.2), (2.4, 7.2), (2.4, 0.), (3., 0.)];
    // Above the room it leaves a strip 0.15 m wide and 3 m long.
    let outer = [(5., 9.15), (0., 9.15), (0., 1.2026743418441947), (5., 1.2026743418441947)];
    for (by_x, by_y) in [(0., 0.), (0., 3.), (-41., 17.), (0.1, 0.2), (1000.3, -777.7)] {
        let shifted =
            |ring: &[(f64, f64)]| -> Vec<Point> { ring.iter().map(|&(x, y)| Point::new(x + by_x, y + by_y)).collect() };
        let (plan, _) = draw_room(&Plan::default(), &shifted(&room), None).unwrap();
        let drawn = draw_room_in_free_space(&plan, &shifted(&outer), None, GAP_BETWEEN_ROOMS_M).unwrap();
        let area_m2 = area_m2(&drawn.plan, drawn.plan.room(drawn.rooms[0]).unwrap());
        assert!((area_m2 - 15.8946).abs() < 1e-3, "{area_m2} m² at {by_x} {by_y}");
    }
}

#[test]
fn rooms_are_merged_across_what_lies_between_and_split_again() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(4., 0., 9., 3.), Some(0.1)).unwrap();
    let plan = edit::set_function(&edit::set_name(&plan, right, "Hall").unwrap(), right, "hall").unwrap();
    let (plan, between) = edit::place_opening(&plan, OpeningKind::Door, Point::new(4., 1.5), 0.9, 0.1, None).unwrap();
    let (plan, out) = edit::place_opening(&plan, OpeningKind::Door, Point::new(2., 0.), 0.9, 0.1, None).unwrap();
    let mut pinned = Opening::new(OpeningKind::Door, Place::Free { from: Point::new(0., 1.), to: Point::new(0., 2.) });
    pinned.pinned = Some([Joint::Room(left), Joint::Outside]);
    let (plan, pinned) = edit::add_opening(&plan, pinned).unwrap();
    // A wall that ends freely within a room stays.
    let plan = draw_walls(&plan, &points(&[(2., 3.), (2., 2.)]), 0.1).unwrap().plan;
    let merged = merge_rooms(&plan, &[left, right]).unwrap();
    assert_eq!((merged.violations(), areas(&merged)), (vec![], vec![27.0]));
    let room = merged.room(right).unwrap();
    assert_eq!((room.name.as_str(), room.function.as_str()), ("Hall", "hall"));
    assert!(merged.opening(between).is_none() && merged.opening(out).is_some());
    assert_eq!(merged.opening(pinned).unwrap().pinned, Some([Joint::Room(right), Joint::Outside]));
    assert_eq!(
        (plan.walls().len(), merged.walls().len()),
        (9, 6),
        "above and below is one wall each again, but for the stub"
    );
    let (again, new) = split_room(&merged, right, &points(&[(4., 0.), (4., 3.)])).unwrap();
    assert_eq!((areas(&again), new.len()), (vec![12.0, 15.0], 1));
    for few in [vec![], vec![left], vec![left, left]] {
        assert!(merge_rooms(&plan, &few).unwrap_err().0.contains("two rooms"));
    }
}

#[test]
fn the_gap_between_rooms_becomes_part_of_the_merged_one() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), None).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(4.3, 0., 9., 3.), None).unwrap();
    let (plan, far) = draw_room(&plan, &rectangle(9.7, 0., 12., 3.), None).unwrap();
    // A niche of one room, narrower than a wall, stays a niche.
    let niche = [(0., 3.), (4., 3.), (4., 6.), (2.2, 6.), (2.2, 5.), (2., 5.), (2., 6.), (0., 6.)];
    let (plan, upper) = draw_room(&plan, &points(&niche), None).unwrap();
    let merged = merge_rooms(&plan, &[left, right]).unwrap();
    assert_eq!((merged.violations(), areas(&merged)), (vec![], vec![6.9, 11.8, 27.0]));
    assert_eq!(merged.room(right).unwrap().outer.len(), 5, "its own, and one of the room above");
    let niched = merge_rooms(&plan, &[left, upper]).unwrap();
    assert_eq!(areas(&niched), [6.9, 14.1, 23.8]);
    assert!(merge_rooms(&plan, &[right, far]).unwrap_err().0.contains("touch"));
    assert!(merge_rooms(&plan, &[left, far]).unwrap_err().0.contains("touch"));
}
