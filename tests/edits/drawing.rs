//! Drawing walls, rooms and openings.

use enfilade::edit::{self, cut_out, draw_room, draw_walls, fill_all, opening_preview, split_room};
use enfilade::geometry::Point;
use enfilade::plan::{Joint, OpeningKind, Place, Plan, RoomId};
use enfilade::topology::{Graph, RoomShapes};

use proptest::prelude::*;

use super::support::{area_m2, areas, config, points, rectangle};

#[test]
fn a_closed_chain_of_walls_is_filled_to_its_area() {
    let drawn =
        draw_walls(&Plan::default(), &points(&[(0., 0.), (4., 0.), (4., 3.), (0., 3.), (0., 0.)]), 0.1).unwrap();
    assert_eq!((drawn.walls.len(), drawn.plan.corners().len(), drawn.rooms.len()), (4, 4, 0));
    let filled = fill_all(&drawn.plan).unwrap();
    assert_eq!(areas(&filled.plan), [12.0]);
    // Drawn again: nothing changes, and a word says so.
    assert!(draw_walls(&drawn.plan, &points(&[(0., 0.), (4., 0.)]), 0.1).unwrap_err().0.contains("already"));
    // Only the missing stretch of a longer wall is added.
    let longer = draw_walls(&drawn.plan, &points(&[(-2., 0.), (6., 0.)]), 0.1).unwrap();
    assert_eq!((longer.walls.len(), longer.plan.walls().len()), (2, 6));
}

#[test]
fn a_wall_across_a_room_divides_it_and_the_larger_part_stays_the_room() {
    let (plan, room) = draw_room(&Plan::default(), &rectangle(0., 0., 10., 4.), Some(0.1)).unwrap();
    let plan = edit::set_name(&edit::set_function(&plan, room, "office").unwrap(), room, "1.01").unwrap();
    let (plan, door) = edit::place_opening(&plan, OpeningKind::Door, Point::new(8.0, 0.05), 0.9, 0.3, None).unwrap();
    let drawn = draw_walls(&plan, &points(&[(7., 0.), (7., 4.)]), 0.1).unwrap();
    assert_eq!(drawn.plan.violations(), []);
    assert_eq!(areas(&drawn.plan), [12.0, 28.0]);
    assert_eq!((drawn.walls.len(), drawn.rooms.len(), drawn.plan.corners().len()), (1, 2, 6));
    let new = drawn.rooms.iter().copied().find(|&id| id != room).unwrap();
    let (old, new) = (drawn.plan.room(room).unwrap(), drawn.plan.room(new).unwrap());
    assert_eq!((old.name.as_str(), old.function.as_str(), area_m2(&drawn.plan, old)), ("1.01", "office", 28.0));
    assert_eq!((new.name.as_str(), new.function.as_str()), ("", "office"));
    // The wall with the door was split; the door stayed where it was.
    assert_eq!(middle(&drawn.plan, door), Point::new(8.0, 0.0));
    // Through several rooms at once, the path given the other way, ends sticking out.
    let across = draw_walls(&drawn.plan, &points(&[(12., 2.), (-2., 2.)]), 0.1).unwrap();
    assert_eq!(areas(&across.plan), [6.0, 6.0, 14.0, 14.0]);
    // A wall that ends within a room leaves it whole, until another meets its end.
    let free = draw_walls(&drawn.plan, &points(&[(0., 2.), (3., 2.)]), 0.1).unwrap();
    assert_eq!((areas(&free.plan), free.rooms.len()), (vec![12.0, 28.0], 0));
    let closed = draw_walls(&free.plan, &points(&[(3., 2.), (3., 4.)]), 0.1).unwrap();
    assert_eq!(areas(&closed.plan), [6.0, 12.0, 22.0]);
}

fn middle(plan: &Plan, opening: enfilade::plan::OpeningId) -> Point {
    plan.opening_segment(plan.opening(opening).unwrap()).unwrap().midpoint().trimmed()
}

#[test]
fn a_room_with_a_courtyard_is_divided_around_it() {
    let (plan, room) = draw_room(&Plan::default(), &rectangle(0., 0., 10., 10.), None).unwrap();
    let plan = cut_out(&plan, room, &rectangle(4., 4., 6., 6.)).unwrap();
    assert_eq!((areas(&plan), plan.room(room).unwrap().holes.len()), (vec![96.0], 1));
    // From the boundary to the courtyard and on: only both together divide it.
    let half = draw_walls(&plan, &points(&[(0., 5.), (4., 5.)]), 0.1).unwrap();
    assert_eq!((half.plan.rooms().len(), half.plan.violations()), (1, vec![]));
    let whole = draw_walls(&half.plan, &points(&[(6., 5.), (10., 5.)]), 0.1).unwrap();
    assert_eq!(areas(&whole.plan), [48.0, 48.0]);
    assert!(whole.plan.rooms().all(|(_, room)| room.holes.is_empty()));
    let (through, new) = split_room(&plan, room, &points(&[(-1., 5.), (11., 5.)])).unwrap();
    assert_eq!((areas(&through), new.len(), through.walls().len()), (vec![48.0, 48.0], 1, 0));
    assert!(split_room(&plan, room, &points(&[(0., 5.), (2., 5.)])).unwrap_err().0.contains("boundary to boundary"));
    // A notch at the boundary, and what may not be cut.
    let notched = cut_out(&plan, room, &rectangle(-1., -1., 2., 2.)).unwrap();
    assert_eq!((areas(&notched), notched.violations()), (vec![92.0], vec![]));
    assert!(cut_out(&plan, room, &rectangle(20., 0., 22., 2.)).is_err());
    assert!(cut_out(&plan, room, &rectangle(-1., -1., 11., 11.)).is_err());
    let cut_in_two = cut_out(&plan, room, &rectangle(-1., 3., 11., 7.)).unwrap();
    assert_eq!(areas(&cut_in_two), [30.0, 30.0]);
}

#[test]
fn rooms_share_corners_and_edges_with_their_neighbours() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), Some(0.1)).unwrap();
    // Half a millimetre off, and shorter: the corner is put on the wall of the first room.
    let (plan, right) = draw_room(&plan, &rectangle(4.0005, 0., 8., 2.), Some(0.1)).unwrap();
    assert_eq!((plan.corners().len(), plan.walls().len(), plan.violations()), (7, 8, vec![]));
    assert_eq!(plan.room(left).unwrap().outer.len(), 5);
    let shared = |id: RoomId| plan.room(id).unwrap().outer.to_vec();
    assert_eq!(shared(left).iter().filter(|corner| shared(right).contains(corner)).count(), 2);
    for (bad, word) in [
        (points(&[(0., 5.), (4., 8.), (4., 5.), (0., 8.)]), "crosses"),
        (points(&[(0., 5.), (4., 5.), (4., 5.0004)]), "nothing"),
        (points(&[(0., 5.), (4., 5.)]), "nothing"),
        (rectangle(0., 0., 4., 3.)[..3].iter().chain(&[Point::new(f64::NAN, 0.)]).copied().collect(), "drawing area"),
    ] {
        assert!(draw_room(&plan, &bad, None).unwrap_err().0.contains(word), "{word}");
    }
    let (again, _) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), None).unwrap();
    assert!(draw_room(&again, &rectangle(0., 0., 4., 3.), None).unwrap_err().0.contains("already"));
}

#[test]
fn openings_are_placed_within_their_edge_and_over_collinear_ones_where_it_is_short() {
    let (plan, left) = draw_room(&Plan::default(), &rectangle(0., 0., 4., 3.), None).unwrap();
    let (plan, right) = draw_room(&plan, &rectangle(4., 0., 8., 3.), None).unwrap();
    let shapes = RoomShapes::new(&plan);
    let kind = OpeningKind::Door;
    let preview =
        opening_preview(&plan, &shapes, kind, Point::new(4.1, 2.9), 0.9, 0.3, Some(Point::new(5., 2.))).unwrap();
    assert_eq!(preview.segment.midpoint(), Point::new(4.0, 2.55), "moved to fit");
    let mut sides = preview.sides;
    sides.sort();
    let mut expected = [Joint::Room(left), Joint::Room(right)];
    expected.sort();
    assert_eq!(sides, expected);
    let (with_door, door) = edit::place_opening(&plan, kind, Point::new(4.1, 2.9), 0.9, 0.3, None).unwrap();
    assert_eq!(Graph::new(&with_door, &shapes).connections().len(), 1);
    let slid = edit::slide_opening(&with_door, door, Point::new(9., 1.)).unwrap();
    assert_eq!(middle(&slid, door), Point::new(4.0, 1.0));
    let wide = edit::resize_opening(&slid, door, 1.6).unwrap();
    let Place::Hosted { width_m, .. } = wide.opening(door).unwrap().place else { panic!("hosted") };
    assert_eq!((width_m, middle(&wide, door)), (1.6, Point::new(4.0, 1.0)));
    assert!(edit::place_opening(&plan, kind, Point::new(2., 1.5), 0.9, 0.3, None).is_err(), "too far from all");
    // A wall of three short pieces: the opening reaches over the pieces beside its own.
    let short = draw_walls(&Plan::default(), &points(&[(0., 0.), (0.6, 0.), (1.2, 0.), (1.8, 0.)]), 0.1).unwrap().plan;
    let (with_door, door) = edit::place_opening(&short, kind, Point::new(0.9, 0.), 0.9, 0.3, None).unwrap();
    assert_eq!((middle(&with_door, door), with_door.violations()), (Point::new(0.9, 0.0), vec![]));
    let slid = edit::slide_opening(&with_door, door, Point::new(5., 0.)).unwrap();
    assert_eq!((middle(&slid, door), slid.violations()), (Point::new(1.35, 0.0), vec![]));
    let (narrow, door) = edit::place_opening(&short, kind, Point::new(0.1, 0.), 3.0, 0.3, None).unwrap();
    let Place::Hosted { width_m, .. } = narrow.opening(door).unwrap().place else { panic!("hosted") };
    assert_eq!((width_m, narrow.violations()), (1.8, vec![]));
}

proptest! {
    #![proptest_config(config(64))]

    #[test]
    fn openings_of_a_wall_stand_beside_each_other(
        wanted in proptest::collection::vec((-1.0..7.0, 0.3..2.0, any::<bool>()), 1..12)
    ) {
        let (mut plan, _) = draw_room(&Plan::default(), &rectangle(0., 0., 6., 4.), Some(0.1)).unwrap();
        let mut refused = 0;
        for &(x, width_m, is_window) in &wanted {
            let kind = if is_window { OpeningKind::Window } else { OpeningKind::Door };
            match edit::place_opening(&plan, kind, Point::new(x, 0.0), width_m, 1.5, None) {
                Ok((next, _)) => plan = next,
                Err(error) => {
                    prop_assert!(error.0.contains("leave no"), "{error}");
                    refused += 1;
                }
            }
        }
        let mut taken: Vec<(f64, f64)> = plan
            .openings()
            .map(|(_, opening)| plan.opening_segment(opening).unwrap())
            .map(|s| (s.a.x.min(s.b.x), s.a.x.max(s.b.x)))
            .collect();
        taken.sort_by(|p, q| p.0.total_cmp(&q.0));
        prop_assert_eq!(taken.len() + refused, wanted.len());
        prop_assert!(taken.iter().all(|&(from, to)| from > -2e-4 && to < 6.0 + 2e-4), "{taken:?}");
        prop_assert!(taken.windows(2).all(|pair| pair[1].0 > pair[0].1 - 2e-4), "{taken:?}");
    }
}

#[test]
fn an_opening_goes_beside_one_that_stands_where_it_was_wanted() {
    let plan = draw_walls(&Plan::default(), &points(&[(0., 0.), (4., 0.)]), 0.1).unwrap().plan;
    let place = |plan: &Plan, x: f64, width_m: f64| {
        edit::place_opening(plan, OpeningKind::Door, Point::new(x, 0.1), width_m, 0.3, None)
    };
    let (plan, first) = place(&plan, 2.0, 1.0).unwrap();
    let (plan, second) = place(&plan, 2.2, 0.8).unwrap();
    assert_eq!((middle(&plan, first), middle(&plan, second)), (Point::new(2.0, 0.0), Point::new(2.9, 0.0)));
    let (plan, third) = place(&plan, 2.2, 1.4).unwrap();
    assert_eq!(middle(&plan, third), Point::new(0.8, 0.0), "the nearest that is wide enough");
    assert_eq!(
        place(&plan, 2.0, 1.0).unwrap_err().0,
        "the openings of this wall leave no 1 m for another; make it narrower"
    );
}
