//! Numbers along a wall: what is typed is what is measured afterwards, and what was not meant stays.

use enfilade::edit::{
    self, End, NARROWEST_OPENING_M, beside_opening, draw_room, set_opening_distance, set_wall_length, stretch_opening,
};
use enfilade::geometry::{Point, Segment};
use enfilade::plan::{OpeningId, OpeningKind, Plan, WallId};
use proptest::prelude::{prop_assert, prop_assert_eq, proptest};

use super::support::{areas, config, rectangle};

/// Two rooms of 5 by 4 m side by side, a door and a window in the lower wall of the left one.
fn house() -> (Plan, OpeningId, OpeningId) {
    let (plan, _) = draw_room(&Plan::default(), &rectangle(0., 0., 5., 4.), Some(0.2)).unwrap();
    let (plan, _) = draw_room(&plan, &rectangle(5., 0., 10., 4.), Some(0.2)).unwrap();
    let place = |plan: &Plan, kind, x| edit::place_opening(plan, kind, Point::new(x, 0.), 0.8, 0.1, None).unwrap();
    let (plan, door) = place(&plan, OpeningKind::Door, 1.2);
    let (plan, window) = place(&plan, OpeningKind::Window, 3.4);
    (plan, door, window)
}

fn segment(plan: &Plan, id: OpeningId) -> Segment {
    plan.opening_segment(plan.opening(id).unwrap()).unwrap()
}

/// The ends of an opening in the lower wall, from the left.
fn ends(plan: &Plan, id: OpeningId) -> [f64; 2] {
    let Segment { a, b } = segment(plan, id);
    [a.x.min(b.x), a.x.max(b.x)]
}

/// The end of an opening that lies on the left.
fn left(plan: &Plan, id: OpeningId) -> End {
    let Segment { a, b } = segment(plan, id);
    if a.x < b.x { End::Start } else { End::End }
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn an_end_goes_where_it_is_dragged_and_passes_nothing(x in -3.0..8.0f64, is_left: bool) {
        let (plan, door, window) = house();
        let end = if is_left { left(&plan, door) } else { left(&plan, door).other() };
        let next = stretch_opening(&plan, door, end, Point::new(x, 0.7)).unwrap();
        prop_assert!(next.violations().is_empty());
        let ([from, to], [from_before, to_before]) = (ends(&next, door), ends(&plan, door));
        let next_m = ends(&plan, window)[0];
        if is_left {
            prop_assert!((to - to_before).abs() < 2e-4, "the other end stays");
            let wanted = x.clamp(0.1, to_before - NARROWEST_OPENING_M);
            prop_assert!((from - wanted).abs() < 2e-4, "{from} {wanted}");
        } else {
            prop_assert!((from - from_before).abs() < 2e-4, "the other end stays");
            let wanted = x.clamp(from_before + NARROWEST_OPENING_M, next_m);
            prop_assert!((to - wanted).abs() < 2e-4, "{to} {wanted}");
        }
        prop_assert_eq!(next.opening(window), plan.opening(window));
        prop_assert_eq!(areas(&next), areas(&plan));
    }

    #[test]
    fn a_distance_is_what_was_typed(distance_m in 0.0..3.0f64, is_left: bool) {
        let (plan, door, window) = house();
        let end = if is_left { left(&plan, door) } else { left(&plan, door).other() };
        // From the face on the left to the window.
        let free_m = ends(&plan, window)[0] - 0.1 - 0.8;
        match set_opening_distance(&plan, door, end, distance_m) {
            Ok(next) => {
                prop_assert!(distance_m <= free_m + 1e-3);
                let index = usize::from(end == End::End);
                let measured_m = beside_opening(&next, door).unwrap()[index].distance_m;
                prop_assert!((measured_m - distance_m).abs() < 2e-4, "{measured_m} {distance_m}");
                prop_assert!((segment(&next, door).length() - 0.8).abs() < 2e-4);
                prop_assert!(next.violations().is_empty());
            }
            Err(_) => prop_assert!(distance_m > free_m),
        }
    }

    #[test]
    fn a_length_is_what_was_typed_and_angles_stay(length_m in 0.3..9.0f64, is_end: bool) {
        let (plan, _) = draw_room(&Plan::default(), &rectangle(0., 0., 5., 4.), Some(0.2)).unwrap();
        let lower = |plan: &Plan| -> WallId {
            plan.walls().find(|(_, wall)| plan.wall_segment(wall).unwrap().midpoint().y == 0.0).unwrap().0
        };
        let wall = lower(&plan);
        let end = if is_end { End::End } else { End::Start };
        let stays = end.other().of(plan.wall_segment(plan.wall(wall).unwrap()).unwrap());
        let next = set_wall_length(&plan, wall, length_m, end).unwrap();
        let after = next.wall_segment(next.wall(wall).unwrap()).unwrap();
        prop_assert!((after.length() - length_m).abs() < 2e-4);
        prop_assert_eq!(end.other().of(after), stays);
        // A rectangle as before.
        let area_m2 = areas(&next)[0];
        prop_assert!((area_m2 - 4.0 * after.length()).abs() < 1e-3, "{area_m2}");
        prop_assert!(next.violations().is_empty());
    }
}

#[test]
fn a_wall_that_would_turn_a_room_inside_out_is_refused() {
    let (plan, _, _) = house();
    // The lower wall of the left room: its right end is the partition's.
    let found = plan.walls().find(|(_, wall)| {
        let middle = plan.wall_segment(wall).unwrap().midpoint();
        middle.y == 0.0 && middle.x < 5.0
    });
    let (id, wall) = found.unwrap();
    let is_right_at_end = plan.wall_segment(wall).unwrap().b.x == 5.0;
    let right = if is_right_at_end { End::End } else { End::Start };
    // The partition moves with it: one room gains what the other loses.
    let next = set_wall_length(&plan, id, 6.0, right).unwrap();
    assert_eq!(areas(&next), [16.0, 24.0]);
    assert!(set_wall_length(&plan, id, 11.0, right).is_err(), "beyond the right room's far wall");
    assert!(set_wall_length(&plan, id, 0.0, right).is_err());
    assert!(set_wall_length(&plan, id, f64::NAN, right).is_err());
}
