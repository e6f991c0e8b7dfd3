//! One case per check: a plan that barely does not have the finding, and one that has it once.

use enfilade::labels::Typology;
use enfilade::plan::{Joint, OpeningKind, Room};

use super::draft::{Draft, rectangle};

/// A plan made from the sound flat, which the argument makes.
type Make = fn(&dyn Fn() -> Draft) -> Draft;

pub struct Case {
    pub kind: &'static str,
    pub sound: Make,
    pub wrong: Make,
}

/// The flat with something more.
macro_rules! flat {
    (|$draft:ident| $body:block) => {
        |make| {
            let mut $draft = make();
            $body
            $draft
        }
    };
}

/// Nothing but what is given.
macro_rules! only {
    (|$draft:ident| $body:block) => {
        |make| {
            let mut $draft = make().cleared();
            $body
            $draft
        }
    };
}

macro_rules! case {
    ($kind:ident, $sound:expr, $wrong:expr) => {
        Case { kind: stringify!($kind), sound: $sound, wrong: $wrong }
    };
}

/// A garden beside the flat: not classified, so it needs no door.
const BESIDE: [(f64, f64); 4] = [(12.0, 0.0), (16.0, 0.0), (16.0, 4.0), (12.0, 4.0)];

#[expect(clippy::too_many_lines, reason = "a table")]
pub fn cases() -> Vec<Case> {
    vec![
        case!(
            invariant_is_broken,
            |make| make(),
            flat!(|draft| {
                draft.room("garden", &[(12.0, 0.0), (14.0, 0.0)]);
            })
        ),
        case!(plan_has_no_rooms, |make| make(), only!(|draft| { draft.wall((0.0, 0.0), (3.0, 0.0)) })),
        case!(
            room_has_no_boundary,
            |make| make(),
            flat!(|draft| {
                draft.builder.room("R6", Room { function: "garden".into(), ..Room::default() });
            })
        ),
        case!(
            room_boundary_encloses_nothing,
            flat!(|draft| {
                draft.room("garden", &rectangle((12.0, 0.0), (12.2, 0.2)));
            }),
            flat!(|draft| {
                draft.room("garden", &[(12.0, 0.0), (14.0, 0.0), (16.0, 0.0)]);
            })
        ),
        case!(
            room_boundary_crosses_itself,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
            }),
            flat!(|draft| {
                draft.room("garden", &[(12.0, 0.0), (16.0, 4.0), (16.0, 0.0), (12.0, 3.0)]);
            })
        ),
        case!(
            room_boundary_touches_itself,
            flat!(|draft| {
                draft.room("garden", &[(12.0, 0.0), (16.0, 0.0), (16.0, 4.0), (14.0, 0.02), (12.0, 4.0)]);
            }),
            flat!(|draft| {
                draft.room("garden", &[(12.0, 0.0), (16.0, 0.0), (16.0, 4.0), (14.0, 0.0), (12.0, 4.0)]);
            })
        ),
        case!(
            room_hole_is_not_inside,
            flat!(|draft| {
                draft.room_with_holes("garden", &BESIDE, &[&rectangle((13.0, 1.0), (15.0, 3.0))]);
            }),
            flat!(|draft| {
                draft.room_with_holes("garden", &BESIDE, &[&rectangle((13.0, 1.0), (17.0, 3.0))]);
            })
        ),
        case!(
            room_hole_lies_along_its_boundary,
            flat!(|draft| {
                // One that only touches it at a corner.
                draft.room_with_holes("garden", &BESIDE, &[&[(12.0, 2.0), (13.0, 1.0), (14.0, 2.0), (13.0, 3.0)]]);
            }),
            flat!(|draft| {
                draft.room_with_holes("garden", &BESIDE, &[&rectangle((12.0, 1.0), (14.0, 3.0))]);
            })
        ),
        case!(
            room_holes_overlap,
            flat!(|draft| {
                let holes = [rectangle((12.5, 1.0), (14.0, 3.0)), rectangle((14.0, 1.0), (15.0, 3.0))];
                draft.room_with_holes("garden", &BESIDE, &[&holes[0], &holes[1]]);
            }),
            flat!(|draft| {
                let holes = [rectangle((12.5, 1.0), (14.0, 3.0)), rectangle((13.5, 1.0), (15.0, 3.0))];
                draft.room_with_holes("garden", &BESIDE, &[&holes[0], &holes[1]]);
            })
        ),
        case!(
            room_is_drawn_twice,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("garden", &rectangle((13.0, 1.0), (15.0, 3.0)));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((12.0, 0.1), (16.0, 4.0)));
            })
        ),
        case!(
            room_lies_inside_another,
            flat!(|draft| {
                draft.room_with_holes("garden", &BESIDE, &[&rectangle((13.0, 1.0), (15.0, 3.0))]);
                draft.room("terrace", &rectangle((13.0, 1.0), (15.0, 3.0)));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((13.0, 1.0), (15.0, 3.0)));
            })
        ),
        case!(
            rooms_overlap,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((15.9, 0.0), (19.0, 4.0)));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((15.6, 0.0), (19.0, 4.0)));
            })
        ),
        case!(
            rooms_leave_a_gap,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((16.1, 0.0), (19.0, 4.0)));
                draft.room("balcony", &rectangle((12.0, 4.005), (16.0, 6.0)));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.room("terrace", &rectangle((16.03, 0.0), (19.0, 4.0)));
            })
        ),
        case!(
            opening_joins_nothing,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.door((13.0, 4.5), (13.8, 4.5));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.door((13.0, 4.7), (13.8, 4.7));
            })
        ),
        case!(
            opening_joins_a_room_to_itself,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.door((13.0, 4.0), (13.8, 4.0));
            }),
            flat!(|draft| {
                draft.room("garden", &BESIDE);
                draft.door((13.0, 2.0), (13.8, 2.0));
            })
        ),
        case!(
            opening_is_far_from_its_rooms,
            flat!(|draft| {
                let pinned = [Joint::Room(draft.living), Joint::Outside];
                draft.opening(OpeningKind::Passage, (9.5, 1.0), (9.5, 2.0), Some(pinned));
            }),
            flat!(|draft| {
                let pinned = [Joint::Room(draft.living), Joint::Outside];
                draft.opening(OpeningKind::Passage, (9.8, 1.0), (9.8, 2.0), Some(pinned));
            })
        ),
        case!(
            opening_contradicts_its_place,
            flat!(|draft| {
                let pinned = [Joint::Room(draft.corridor), Joint::Room(draft.bedroom)];
                draft.opening(OpeningKind::Passage, (3.0, 4.0), (3.6, 4.0), Some(pinned));
            }),
            flat!(|draft| {
                let pinned = [Joint::Room(draft.corridor), Joint::Room(draft.living)];
                draft.opening(OpeningKind::Passage, (3.2, 4.0), (3.8, 4.0), Some(pinned));
            })
        ),
        case!(
            opening_is_wider_than_its_wall,
            flat!(|draft| {
                draft.door((6.1, 0.0), (8.9, 0.0));
            }),
            flat!(|draft| {
                draft.door((6.5, 0.0), (9.3, 0.0));
            })
        ),
        case!(
            openings_overlap,
            flat!(|draft| {
                draft.door((2.1, 4.0), (2.95, 4.0));
            }),
            flat!(|draft| {
                draft.door((1.7, 4.0), (2.55, 4.0));
            })
        ),
        case!(
            plan_has_no_openings,
            |make| make(),
            only!(|draft| {
                draft.room("bedroom", &rectangle((0.0, 0.0), (4.0, 4.0)));
                draft.room("living room", &rectangle((4.0, 0.0), (9.0, 4.0)));
                draft.opening(OpeningKind::Window, (1.0, 0.0), (2.0, 0.0), None);
            })
        ),
        case!(
            room_has_no_opening,
            flat!(|draft| {
                draft.room("shaft", &rectangle((6.0, 5.5), (7.0, 8.0)));
            }),
            flat!(|draft| {
                draft.room("closet", &rectangle((6.0, 5.5), (7.0, 8.0)));
                draft.opening(OpeningKind::Window, (6.1, 8.0), (6.9, 8.0), None);
            })
        ),
        case!(
            rooms_are_cut_off,
            flat!(|draft| {
                draft.room("bedroom", &BESIDE);
                draft.room("stairs", &rectangle((16.0, 0.0), (19.0, 4.0)));
                draft.door((16.0, 1.0), (16.0, 1.85));
            }),
            flat!(|draft| {
                draft.room("bedroom", &BESIDE);
                draft.room("kitchen", &rectangle((16.0, 0.0), (19.0, 4.0)));
                draft.door((16.0, 1.0), (16.0, 1.85));
            })
        ),
        case!(plan_has_no_typology, |make| make(), flat!(|draft| { draft.set_meta(|meta| meta.typology = None) })),
        case!(
            typology_has_no_scheme,
            flat!(|draft| { draft.set_meta(|meta| meta.typology = None) }),
            flat!(|draft| { draft.set_meta(|meta| meta.typology = Typology::new("castle")) })
        ),
        case!(
            function_is_unknown,
            flat!(|draft| {
                draft.room("Garden", &BESIDE);
            }),
            flat!(|draft| {
                draft.room("observatory", &rectangle((6.0, 5.5), (9.0, 8.0)));
                draft.door((8.0, 5.5), (8.85, 5.5));
            })
        ),
        case!(
            room_has_no_function,
            flat!(|draft| {
                draft.room("garden", &BESIDE);
            }),
            flat!(|draft| {
                draft.room("", &rectangle((6.0, 5.5), (9.0, 8.0)));
                draft.door((8.0, 5.5), (8.85, 5.5));
            })
        ),
        case!(
            scale_is_implausible,
            only!(|draft| { doors_of_width(&mut draft, 1.25) }),
            only!(|draft| { doors_of_width(&mut draft, 1.6) })
        ),
        case!(
            axes_ratio_is_implausible,
            flat!(|draft| {
                draft.room("corridor", &rectangle((12.0, 0.0), (42.0, 1.0)));
            }),
            flat!(|draft| {
                draft.room("corridor", &rectangle((12.0, 0.0), (42.0, 0.5)));
            })
        ),
        case!(
            room_area_is_unusual,
            flat!(|draft| {
                draft.room("closet", &rectangle((12.0, 0.0), (15.0, 6.0)));
            }),
            flat!(|draft| {
                draft.room("closet", &rectangle((12.0, 0.0), (22.0, 6.0)));
            })
        ),
        case!(
            room_name_repeats,
            flat!(|draft| {
                draft.named_room("garden", "Garden", &BESIDE);
                draft.named_room("garden", "Garden", &rectangle((16.0, 0.0), (19.0, 4.0)));
                draft.named_room("garden", "1", &rectangle((19.0, 0.0), (22.0, 4.0)));
            }),
            flat!(|draft| {
                draft.named_room("garden", "G 1", &BESIDE);
                draft.named_room("garden", "G 1", &rectangle((16.0, 0.0), (19.0, 4.0)));
            })
        ),
        case!(
            wall_has_no_length,
            flat!(|draft| { draft.wall((0.0, 0.0), (4.0, 0.0)) }),
            flat!(|draft| {
                let corner = draft.corner((0.0, 0.0));
                draft.builder.wall(corner, corner, 0.1);
            })
        ),
        case!(
            walls_overlap,
            flat!(|draft| {
                draft.wall((0.0, 0.0), (4.0, 0.0));
                draft.wall((4.0, 0.0), (9.0, 0.0));
                draft.wall((2.0, 0.0), (2.0, 4.0));
            }),
            flat!(|draft| {
                draft.wall((0.0, 0.0), (4.0, 0.0));
                draft.wall((3.0, 0.0), (9.0, 0.0));
            })
        ),
        case!(
            wall_stands_in_an_opening,
            flat!(|draft| {
                // Beside a door, up to its very edge.
                draft.wall((5.85, 4.0), (5.85, 0.0));
            }),
            flat!(|draft| { draft.wall((5.4, 4.0), (5.4, 0.0)) })
        ),
        case!(
            wall_ends_freely,
            flat!(|draft| {
                draft.wall((2.0, 0.0), (2.0, 4.0));
                let column = [(1.0, 1.0), (1.0, 1.4)].map(|at| draft.corner(at));
                draft.builder.wall(column[0], column[1], 0.4);
            }),
            flat!(|draft| { draft.wall((2.0, 0.0), (2.0, 3.0)) })
        ),
        case!(
            corners_nearly_coincide,
            flat!(|draft| {
                draft.room("garden", &rectangle((9.02, 0.0), (12.0, 4.0)));
            }),
            flat!(|draft| {
                draft.room("garden", &rectangle((9.005, 0.0), (12.0, 3.5)));
            })
        ),
    ]
}

/// A row of corridors with doors of a width to the outside.
fn doors_of_width(draft: &mut Draft, width_m: f64) {
    for i in 0..6 {
        let left = 2.5 * f64::from(i);
        draft.room("corridor", &rectangle((left, 0.0), (left + 2.5, 2.0)));
        draft.door((left + 0.2, 2.0), (left + 0.2 + width_m, 2.0));
    }
}
