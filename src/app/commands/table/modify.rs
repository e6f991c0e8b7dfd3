//! Selecting and changing what is drawn.

mod acts;

use std::collections::BTreeSet;

use self::acts::{
    Mirror, NO_GAPS, Wanted, Way, copied, has_copied, has_door, has_drawing, has_opening, has_wall, is_labelled,
    is_selectable, select_found, transformed,
};
use super::draw::{REACH_OF_WALLS_M, edited, edited_fitting, edited_fitting_near};
use super::*;
use crate::app::session::{document::Document, questions::Question};
use crate::app::value::MoveOrCopy;
use crate::edit::{self, Alignment, Array, End, Reach};
use crate::geometry::Transform;
use crate::plan::{LeafSide, OpeningId, Swing};
use crate::topology;

const MODE: Arg<Option<SelectMode>> = optional("MODE", one_of::<SelectMode>(), "replace (without), add or toggle");

pub(super) const COMMANDS: &[Command] = &[
    command("select-all", "Select all", "Select everything that is not locked", has_drawing, |app, _| {
        let Some(plan) = app.plan() else { return };
        let all: Vec<ElementId> = plan.elements().filter(|&element| is_selectable(app, element)).collect();
        app.session.select(all, SelectMode::Replace);
    })
    .keys(&[ctrl(Key::A)])
    .menu(Menu::Modify, 0)
    .on(&[On::FreeSpace]),
    with(
        "select-by-label",
        "Select by label…",
        "Select all rooms with a label",
        has_rooms,
        &given2(
            needed("LABEL", one_of::<Wanted>(), "small, medium, big, corridor, hall or none"),
            MODE,
            |app, Wanted(wanted), mode, _| {
                let Some(plan) = app.plan() else { return Outcome::Done };
                let found: Vec<ElementId> = plan
                    .rooms()
                    .filter(|(_, room)| is_labelled(RoomStatus::of(plan, &app.session.schemes, room), wanted))
                    .map(|(id, _)| ElementId::Room(id))
                    .collect();
                select_found(app, found, mode)
            },
        ),
        None,
    )
    .menu(Menu::Modify, 0),
    with(
        "select-by-function",
        "Select by function…",
        "Select all rooms that are for something",
        has_rooms,
        &given2(needed("FUNCTION", FUNCTION, "what the rooms are for"), MODE, |app, function, mode, _| {
            let wanted = normalised_function(&function);
            let Some(plan) = app.plan() else { return Outcome::Done };
            let found: Vec<ElementId> = plan
                .rooms()
                .filter(|(_, room)| normalised_function(&room.function) == wanted)
                .map(|(id, _)| ElementId::Room(id))
                .collect();
            select_found(app, found, mode)
        }),
        None,
    )
    .menu(Menu::Modify, 0),
    with(
        "delete",
        "Delete",
        "Delete what is selected, and what cannot stand without it",
        has_picked,
        &given0(|app, _| app.delete_selected()),
        None,
    )
    .keys(&[key(Key::Delete)])
    .menu(Menu::Modify, 1)
    .on(&[On::Room, On::Wall, On::Opening, On::Corner, On::Several]),
    // The clipboard.
    with(
        "copy",
        "Copy",
        "Keep what is selected, to paste it here or into another plan",
        has_picked,
        &given0(|app, context| app.copy_selected(context)),
        None,
    )
    .keys(&[ctrl(Key::C)])
    .menu(Menu::Modify, 2)
    .on(&[On::Room, On::Wall, On::Opening, On::Several]),
    with(
        "cut",
        "Cut",
        "Keep what is selected, to paste it, and delete it here",
        has_picked,
        &given0(|app, context| match app.copy_selected(context) {
            Outcome::Done => app.delete_selected(),
            other => other,
        }),
        None,
    )
    .keys(&[ctrl(Key::X)])
    .menu(Menu::Modify, 2)
    .on(&[On::Room, On::Wall, On::Opening, On::Several]),
    command(tools::PASTE.id, tools::PASTE.title, tools::PASTE.help, has_copied, |app, _| {
        app.tools.take_up(tools::PASTE.id);
    })
    .keys(&[ctrl(Key::V)])
    .menu(Menu::Modify, 2)
    .on(&[On::FreeSpace]),
    with(
        "duplicate",
        "Duplicate",
        "Place a copy of what is selected",
        has_picked,
        &given0(|app, context| {
            let ran = app.copy_selected(context);
            if ran == Outcome::Done {
                app.tools.take_up(tools::PASTE.id);
            }
            ran
        }),
        None,
    )
    .keys(&[ctrl(Key::D)])
    .menu(Menu::Modify, 2)
    .on(&[On::Room, On::Wall, On::Opening, On::Several]),
    // Rotating and the like: the pointer shows where, what is typed says how much.
    with(
        tools::ROTATE.id,
        tools::ROTATE.title,
        tools::ROTATE.help,
        has_picked,
        &given3(
            needed("ANGLE", angle(-360.0, 360.0), "in degrees, counter-clockwise"),
            CENTRE,
            COPY,
            |app, angle, about, copy, _| {
                let about = app.centre_of_selection(about);
                transformed(app, "Rotate", Transform::rotation(about, angle.to_radians()), copy)
            },
        ),
        Some(|app, _| app.tools.take_up(tools::ROTATE.id)),
    )
    .menu(Menu::Modify, 3)
    .on(&[On::Room, On::Several]),
    command(
        "rotate-left",
        "Rotate left",
        "Turn what is selected by a right angle, counter-clockwise",
        has_picked,
        |app, _| {
            let about = app.centre_of_selection(None);
            let turn = Transform::rotation(about, std::f64::consts::FRAC_PI_2);
            app.report(|app| transformed(app, "Rotate", turn, None));
        },
    )
    .menu(Menu::Modify, 3)
    .on(&[On::Room, On::Wall, On::Several]),
    with(
        tools::MIRROR.id,
        tools::MIRROR.title,
        tools::MIRROR.help,
        has_picked,
        &given2(
            needed("AXIS", points(2), "two points of the axis, in metres, as '4,0 4,3'"),
            COPY,
            |app, axis, copy, _| match axis.as_slice() {
                &[a, b, ..] => match Transform::reflection(a, b) {
                    Some(transform) => transformed(app, "Mirror", transform, copy),
                    None => Outcome::Refused("the two points of the axis are the same".to_owned()),
                },
                _ => Outcome::Done,
            },
        ),
        Some(|app, _| app.tools.take_up(tools::MIRROR.id)),
    )
    .menu(Menu::Modify, 3),
    with(
        "mirror",
        "Flip…",
        "Mirror what is selected left and right, or up and down, about its middle",
        has_picked,
        &given3(
            needed("WAY", one_of::<Mirror>(), "left-right or up-down"),
            CENTRE,
            COPY,
            |app, mirror, about, copy, _| {
                let about = app.centre_of_selection(about);
                let way = match mirror {
                    Mirror::LeftRight => Vector::new(0.0, 1.0),
                    Mirror::UpDown => Vector::new(1.0, 0.0),
                };
                match Transform::reflection(about, about + way) {
                    Some(transform) => transformed(app, "Mirror", transform, copy),
                    None => Outcome::Done,
                }
            },
        ),
        None,
    )
    .menu(Menu::Modify, 3)
    .on(&[On::Room, On::Wall, On::Several]),
    with(
        tools::SCALE.id,
        tools::SCALE.title,
        tools::SCALE.help,
        has_picked,
        &given3(
            needed("FACTOR", ratio(0.001, 1000.0), "2 is twice as large"),
            CENTRE,
            COPY,
            |app, factor, about, copy, _| {
                let about = app.centre_of_selection(about);
                transformed(app, "Scale", Transform::scaling(about, factor), copy)
            },
        ),
        Some(|app, _| app.tools.take_up(tools::SCALE.id)),
    )
    .menu(Menu::Modify, 3)
    .on(&[On::Room, On::Several]),
    switch(
        "transform-copies",
        "Copy",
        "Leave the original where it is when mirroring, rotating or scaling",
        always,
        |app| app.tools.options.copies,
        |app, is_on| app.tools.options.copies = is_on,
    ),
    with(
        tools::ARRAY.id,
        tools::ARRAY.title,
        tools::ARRAY.help,
        has_picked,
        &given3(
            needed("COLUMNS", COUNT, "how many side by side, the original among them"),
            needed("ROWS", COUNT, "how many above each other"),
            needed("STEP", POINT, "from column to column and from row to row, as '4,3'"),
            |app, columns, rows, step, _| {
                let (column_step, row_step) = (Vector::new(step.x, 0.0), Vector::new(0.0, step.y));
                copied(app, Array::Grid { columns, rows, column_step, row_step })
            },
        ),
        Some(|app, _| app.tools.take_up(tools::ARRAY.id)),
    )
    .menu(Menu::Modify, 3)
    .on(&[On::Room, On::Several]),
    with(
        tools::POLAR_ARRAY.id,
        tools::POLAR_ARRAY.title,
        tools::POLAR_ARRAY.help,
        has_picked,
        &given3(
            needed("ABOUT", POINT, "the point, as '4,3'"),
            needed("COUNT", COUNT, "how many, the original among them"),
            needed("ANGLE", angle(-360.0, 360.0), "from one to the next, in degrees"),
            |app, about, count, step, _| {
                let step_rad = step.to_radians();
                copied(app, Array::Polar { about, count, step_rad })
            },
        ),
        Some(|app, _| app.tools.take_up(tools::POLAR_ARRAY.id)),
    )
    .menu(Menu::Modify, 3),
    with(
        "align",
        "Align…",
        "Bring sides or middles of what is selected into line",
        has_picked,
        &given1(
            needed("SIDE", one_of::<Alignment>(), "left, right, top, bottom, centre or middle"),
            |app, alignment, _| {
                let selected = app.session.selection.elements().clone();
                edited(app, "Align", |plan| edit::align(plan, &selected, alignment))
            },
        ),
        None,
    )
    .menu(Menu::Modify, 4)
    .on(&[On::Several]),
    with(
        "distribute",
        "Distribute…",
        "Put what is selected at equal distances",
        has_picked,
        &given1(needed("WAY", one_of::<Way>(), "across or up"), |app, way, _| {
            let is_upright = way == Way::Up;
            let selected = app.session.selection.elements().clone();
            edited(app, "Distribute", |plan| edit::distribute(plan, &selected, is_upright))
        }),
        None,
    )
    .menu(Menu::Modify, 4)
    .on(&[On::Several]),
    with(
        "square-up",
        "Square up",
        "Make angles that are nearly right ones right: of the selected rooms, or of all",
        has_drawing,
        &given1(
            optional(
                "ANGLE",
                angle(0.01, 44.0),
                "how far from right an angle may be, in degrees; 10 without, the paper's threshold",
            ),
            |app, angle, _| {
                let max_rad = angle.unwrap_or(10.0).to_radians();
                let rooms: BTreeSet<RoomId> = app.session.selection.rooms().collect();
                let of = (!rooms.is_empty()).then_some(rooms);
                edited(app, "Square up", |plan| edit::square_up(plan, of.as_ref(), max_rad))
            },
        ),
        None,
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Room]),
    with(
        "weld",
        "Weld corners…",
        "Join corners that are no further apart than a tolerance; shows what it does before it does it",
        has_drawing,
        &given1(needed("TOLERANCE", length(0.0001, 10.0), "how far apart at most"), |app, tolerance_m, _| {
            app.ask_to_weld(tolerance_m)
        }),
        None,
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Corner]),
    with(
        tools::OFFSET.id,
        tools::OFFSET.title,
        tools::OFFSET.help,
        has_picked,
        &given2(
            needed("DISTANCE", length(0.001, 1000.0), "how far away"),
            optional("TOWARDS", POINT, "a point on the side where the copy goes; without, where the pointer is"),
            |app, distance_m, towards, _| app.offset_selected(distance_m, towards),
        ),
        Some(|app, _| app.tools.take_up(tools::OFFSET.id)),
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Room, On::Wall]),
    with(
        "set-thickness",
        "Thickness…",
        "Make the selected walls as thick as this",
        has_picked,
        &given1(needed("THICKNESS", length(0.0, 10.0), "how thick"), |app, thickness_m, _| {
            let walls: Vec<_> = app.session.selection.walls().collect();
            if walls.is_empty() {
                return Outcome::Refused("select a wall first".to_owned());
            }
            edited(app, "Set thickness", |plan| edit::set_thickness(plan, &walls, thickness_m))
        }),
        None,
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Wall, On::Several]),
    with(
        "set-wall-length",
        "Length of wall…",
        "Make the selected wall so long: one end moves along it, with the walls that meet it there at a right angle",
        has_wall,
        &given2(
            needed("LENGTH", length(0.001, 1e5), "how long, along its middle"),
            optional("END", one_of::<End>(), "which end moves: start or end (without)"),
            |app, length_m, end, _| {
                let Some(ElementId::Wall(wall)) = app.picked() else {
                    return Outcome::Refused("select one wall first".to_owned());
                };
                let end = end.unwrap_or(End::End);
                edited(app, "Set length", |plan| edit::set_wall_length(plan, wall, length_m, end))
            },
        ),
        None,
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Wall]),
    with(
        "merge-rooms",
        "Merge rooms",
        "Make one room of the selected ones; walls and openings between them go",
        has_picked,
        &given1(optional("ROOMS", ELEMENTS, "which ones; the selected ones without"), |app, named, _| {
            let is_room = |element: ElementId| if let ElementId::Room(id) = element { Some(id) } else { None };
            let named: Option<Vec<RoomId>> = named.map(|named| named.into_iter().filter_map(is_room).collect());
            let rooms = named.unwrap_or_else(|| app.session.selection.rooms().collect());
            if rooms.len() < 2 {
                return Outcome::Refused("select two rooms or more first".to_owned());
            }
            edited(app, "Merge rooms", |plan| edit::merge_rooms(plan, &rooms))
        }),
        None,
    )
    .when_complete(has_rooms)
    .keys(&[key(Key::J)])
    .menu(Menu::Modify, 6)
    .on(&[On::Several]),
    with(
        "bridge-gaps",
        "Doors into all gaps",
        "Close the gaps of 30 to 150 cm between collinear walls with doorways",
        has_drawing,
        &given0(|app, _| app.ask_to_bridge()),
        None,
    )
    .menu(Menu::Modify, 6),
    with(
        "flip",
        "Flip",
        "Hang the selected doors, or the one just placed, the next way: at the other end, to the other side; Space on \
         the plan does it",
        has_door,
        &given0(|app, _| app.flip_doors()),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "flip-hinge",
        "Hinge at the other end",
        "Hinge the selected doors at their other end",
        has_opening,
        &given0(|app, _| app.change_openings("Flip hinge", edit::flip_hinge)),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "flip-side",
        "Open to the other side",
        "Let the selected doors open to their other side",
        has_opening,
        &given0(|app, _| app.change_openings("Flip side", edit::flip_side)),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "set-opening-kind",
        "Kind of opening…",
        "Make doors, double doors, passages or windows of the selected openings",
        has_opening,
        &given1(needed("KIND", one_of::<OpeningKind>(), "door, double-door, passage or window"), |app, kind, _| {
            app.change_openings("Change opening", |plan, id, _| edit::set_opening_kind(plan, id, kind))
        }),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening, On::Several]),
    with(
        "set-opening-width",
        "Width of opening…",
        "Make the selected openings as wide as this",
        has_opening,
        &given1(needed("WIDTH", length(0.01, 1000.0), "how wide"), |app, width_m, _| {
            let ran = app.change_openings("Set width", |plan, id, _| edit::resize_opening(plan, id, width_m));
            let openings: Vec<OpeningId> = app.session.selection.openings().collect();
            if ran == Outcome::Done {
                app.say_narrower(width_m, &openings);
            }
            ran
        }),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening, On::Several]),
    with(
        "set-opening-distance",
        "Distance of opening…",
        "Move the selected opening along its wall until it is so far from what lies beside it",
        has_opening,
        &given2(
            needed("DISTANCE", length(0.0, 1000.0), "from its end to the next opening, or the next wall's face"),
            optional("END", one_of::<End>(), "which of its ends: start (without) or end"),
            |app, distance_m, end, _| {
                let Some(ElementId::Opening(opening)) = app.picked() else {
                    return Outcome::Refused("select one opening first".to_owned());
                };
                let end = end.unwrap_or(End::Start);
                edited(app, "Set distance", |plan| edit::set_opening_distance(plan, opening, end, distance_m))
            },
        ),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "set-hinge",
        "Hinge…",
        "Hinge the selected doors at an end",
        has_opening,
        &given1(needed("END", one_of::<End>(), "start or end, as the opening lies"), |app, end, _| {
            app.change_openings("Set hinge", |plan, id, shown| {
                edit::change_swing(plan, id, shown, |swing| Swing { hinge_at_start: end == End::Start, ..swing })
            })
        }),
        None,
    )
    .menu(Menu::Modify, 7),
    with(
        "set-side",
        "Side that a door opens to…",
        "Let the selected doors open to a side",
        has_opening,
        &given1(
            needed("SIDE", one_of::<LeafSide>(), "left or right, from the opening's start to its end"),
            |app, side, _| {
                app.change_openings("Set side", |plan, id, shown| {
                    edit::change_swing(plan, id, shown, |swing| Swing { side, ..swing })
                })
            },
        ),
        None,
    )
    .menu(Menu::Modify, 7),
    switch(
        "lock-rooms",
        "Lock rooms",
        "Let the pointer neither select nor move rooms",
        always,
        |app| app.session.layers.locked.rooms,
        |app, is_on| app.session.layers.locked.rooms = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-walls",
        "Lock walls",
        "Let the pointer neither select nor move walls",
        always,
        |app| app.session.layers.locked.walls,
        |app, is_on| app.session.layers.locked.walls = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-openings",
        "Lock openings",
        "Let the pointer neither select nor move openings",
        always,
        |app| app.session.layers.locked.openings,
        |app, is_on| app.session.layers.locked.openings = is_on,
    )
    .menu(Menu::Modify, 9),
    // The actions of the pointer, for scripts.
    with(
        "select-box",
        "Select in a box",
        "Select what lies in a box, or also what it touches",
        has_plan,
        &given3(
            needed("CORNERS", points(2), "two opposite corners of the box"),
            optional("HOW", one_of::<Boxed>(), "inside (without) or touching"),
            MODE,
            |app, corners, boxed, mode, _| {
                let bounds = Bounds::of(corners);
                let touches = boxed == Some(Boxed::Touching);
                let found = app.elements_in(bounds, touches);
                app.session.select(found, mode.unwrap_or(SelectMode::Replace));
                Outcome::Done
            },
        ),
        None,
    ),
    with(
        "move-selection",
        "Move the selection",
        "Move what is selected: rooms come away from what they share, of walls what shares them follows",
        has_picked,
        &given2(
            needed("BY", POINT, "how far right and up, in metres, as '0.5,-1'"),
            optional(
                "REACH",
                one_of::<Reach>(),
                "of a wall: run (without) for the straight run it is part of, or piece",
            ),
            |app, by, reach, _| {
                let selected = app.session.selection.elements().clone();
                let own_walls = app.tools.options.walls_with_rooms;
                edited_fitting(app, "Move", |plan| {
                    edit::move_picked(plan, &selected, by - Point::default(), reach.unwrap_or_default(), own_walls)
                })
            },
        ),
        None,
    ),
    with(
        "paste-at",
        "Paste at a place",
        "Place what was copied with its middle at a point",
        has_copied,
        &given1(needed("PLACE", POINT, "a point in metres, as '2,1.5'"), |app, at, _| app.paste_at(at)),
        None,
    ),
    with(
        "bridge-gap",
        "Door into a gap",
        "Close the gap between two collinear walls that is nearest to a point with an opening",
        has_drawing,
        &given2(
            needed("PLACE", POINT, "a point in metres, as '2,1.5'"),
            optional("KIND", one_of::<OpeningKind>(), "door (without), double-door, passage or window"),
            |app, at, kind, _| {
                let kind = kind.unwrap_or(OpeningKind::Door);
                edited(app, "Bridge gap", |plan| {
                    let gaps = topology::gaps(plan);
                    let nearest = gaps.iter().min_by(|p, q| p.segment.distance(at).total_cmp(&q.segment.distance(at)));
                    let Some(gap) = nearest else { return Err(EditError(NO_GAPS.to_owned())) };
                    Ok(edit::bridge_gaps(plan, std::slice::from_ref(gap), kind)?.0)
                })
            },
        ),
        None,
    ),
    with(
        "move-corner",
        "Move a corner",
        "Move a corner; everything that shares it follows",
        has_plan,
        &given2(
            needed("CORNER", ELEMENTS, "the corner's id"),
            needed("TO", POINT, "where to, in metres"),
            |app, elements, to, _| {
                let Some(ElementId::Corner(corner)) = elements.first().copied() else {
                    return Outcome::Refused("this is no corner".to_owned());
                };
                let from = app.session.document.as_ref().map_or(Bounds::EMPTY, |document| document.around(corner));
                let around = from.with(to).inflated(REACH_OF_WALLS_M);
                edited_fitting_near(app, "Move corner", around, |plan| edit::drag_corners(plan, &[(corner, to)]))
            },
        ),
        None,
    ),
    with(
        "nudge",
        "Nudge",
        "Move what is selected a little, as an arrow key on the plan does; an opening along its wall",
        has_picked,
        &given2(
            needed("DIRECTION", one_of::<Direction>(), "left, right, up or down"),
            needed("DISTANCE", length(0.0001, 1000.0), "how far"),
            |app, direction, distance_m, _| app.nudge(direction, distance_m),
        ),
        None,
    ),
    with(
        "stretch-opening",
        "Stretch an opening",
        "Move one end of an opening along its wall, as near to a point as there is space; its other end stays",
        has_openings,
        &given3(
            needed("OPENING", OPENING, "the opening's id"),
            needed("END", one_of::<End>(), "start or end, as the opening lies"),
            needed("TOWARDS", POINT, "a point, in metres"),
            |app, opening, end, towards, _| {
                edited(app, "Set width", |plan| edit::stretch_opening(plan, opening, end, towards))
            },
        ),
        None,
    ),
    with(
        "slide-opening",
        "Slide an opening",
        "Slide an opening along its wall, as near to a point as the wall lets it",
        has_openings,
        &given2(
            needed("OPENING", OPENING, "the opening's id"),
            needed("TOWARDS", POINT, "a point, in metres"),
            |app, opening, towards, _| edited(app, "Slide opening", |plan| edit::slide_opening(plan, opening, towards)),
        ),
        None,
    ),
];

const COPY: Arg<Option<MoveOrCopy>> =
    optional("COPY", one_of::<MoveOrCopy>(), "move (without), or copy to leave the original where it is");

const CENTRE: Arg<Option<Point>> =
    optional("ABOUT", POINT, "a point, in metres, as '4,3'; the middle of what is selected without");
