//! Selecting and changing what is drawn.

mod acts;

use std::collections::BTreeSet;

use self::acts::{
    Mirror, NO_GAPS, Wanted, Way, copied, has_copied, has_dimension, has_door, has_drawing, has_opening, has_wall,
    is_labelled, is_selectable, select_found, transformed,
};
use super::draw::{REACH_OF_WALLS_M, edited, edited_fitting, edited_fitting_near};
use super::*;
use crate::app::session::{document::Document, questions::Question};
use crate::app::value::MoveOrCopy;
use crate::edit::{self, Alignment, Array, End, Reach};
use crate::geometry::Transform;
use crate::plan::{LeafSide, OpeningId, Swing};
use crate::topology;

const MODE: Arg<Option<SelectMode>> = optional("MODE", one_of::<SelectMode>(), "replace (default), add or toggle");

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
        "Select all rooms with a function",
        has_rooms,
        &given2(needed("FUNCTION", FUNCTION, "the function of the rooms"), MODE, |app, function, mode, _| {
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
        "Delete the selection and what depends on it",
        has_picked,
        &given0(|app, _| app.delete_selected()),
        None,
    )
    .keys(&[key(Key::Delete)])
    .menu(Menu::Modify, 1)
    .on(&[On::Room, On::Wall, On::Opening, On::Corner, On::Dimension, On::Several]),
    // The clipboard.
    with(
        "copy",
        "Copy",
        "Copy the selection, to paste it here or in another plan",
        has_picked,
        &given0(|app, context| app.copy_selected(context)),
        None,
    )
    .keys(&[ctrl(Key::C)])
    .menu(Menu::Modify, 2)
    .on(&[On::Room, On::Wall, On::Opening, On::Dimension, On::Several]),
    with(
        "cut",
        "Cut",
        "Cut the selection, to paste it here or in another plan",
        has_picked,
        &given0(|app, context| match app.copy_selected(context) {
            Outcome::Done => app.delete_selected(),
            other => other,
        }),
        None,
    )
    .keys(&[ctrl(Key::X)])
    .menu(Menu::Modify, 2)
    .on(&[On::Room, On::Wall, On::Opening, On::Dimension, On::Several]),
    command(tools::PASTE.id, tools::PASTE.title, tools::PASTE.help, has_copied, |app, _| {
        app.tools.take_up(tools::PASTE.id);
    })
    .keys(&[ctrl(Key::V)])
    .menu(Menu::Modify, 2)
    .on(&[On::FreeSpace]),
    with(
        "duplicate",
        "Duplicate",
        "Copy the selection, and click to place the copy",
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
    .on(&[On::Room, On::Wall, On::Opening, On::Dimension, On::Several]),
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
        "Rotate the selection by a right angle, counter-clockwise",
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
            needed("AXIS", points(2), "two points of the axis in metres, such as '4,0 4,3'"),
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
        "Mirror the selection left and right, or up and down, about its middle",
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
        "Keep the original when mirroring, rotating or scaling",
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
            needed("COLUMNS", COUNT, "how many side by side, including the original"),
            needed("ROWS", COUNT, "how many above each other, including the original"),
            needed("STEP", POINT, "the distance between columns and between rows, such as '4,3'"),
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
            needed("ABOUT", POINT, "the point, such as '4,3'"),
            needed("COUNT", COUNT, "how many, including the original"),
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
        "Align sides or middles of the selection",
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
        "Space the selection evenly",
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
        "Make nearly right angles exactly right, in the selected rooms or in all",
        has_drawing,
        &given1(
            optional(
                "ANGLE",
                angle(0.01, 44.0),
                "how far from a right angle, in degrees; 10 by default, the paper's threshold",
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
        "Join corners closer than a tolerance; shows the result first",
        has_drawing,
        &given1(needed("TOLERANCE", length(0.0001, 10.0), "the largest distance"), |app, tolerance_m, _| {
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
            needed("DISTANCE", length(0.001, 1000.0), "the distance"),
            optional("TOWARDS", POINT, "a point on the side where the copy goes; without it, the side of the pointer"),
            |app, distance_m, towards, _| app.offset_selected(distance_m, towards),
        ),
        Some(|app, _| app.tools.take_up(tools::OFFSET.id)),
    )
    .menu(Menu::Modify, 5)
    .on(&[On::Room, On::Wall]),
    with(
        "set-thickness",
        "Thickness…",
        "Set the thickness of the selected walls",
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
        "Set the length of the selected wall: one end moves, with the walls that meet it there at a right angle",
        has_wall,
        &given2(
            needed("LENGTH", length(0.001, 1e5), "the length along its centre line"),
            optional("END", one_of::<End>(), "the end that moves: start or end (default)"),
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
        "Merge the selected rooms into one; walls and openings between them are removed",
        has_picked,
        &given1(optional("ROOMS", ELEMENTS, "which ones; without it, the selected ones"), |app, named, _| {
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
        "Place doors in all gaps of 30 to 150 cm between aligned walls",
        has_drawing,
        &given0(|app, _| app.ask_to_bridge()),
        None,
    )
    .menu(Menu::Modify, 6),
    with(
        "flip",
        "Flip",
        "Flip the selected doors, or the one just placed, through all ways they can hang; Space does the same",
        has_door,
        &given0(|app, _| app.flip_doors()),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "flip-hinge",
        "Hinge at the other end",
        "Move the hinge of the selected doors to their other end",
        has_opening,
        &given0(|app, _| app.change_openings("Flip hinge", edit::flip_hinge)),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "flip-side",
        "Open to the other side",
        "Make the selected doors open to their other side",
        has_opening,
        &given0(|app, _| app.change_openings("Flip side", edit::flip_side)),
        None,
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Opening]),
    with(
        "set-opening-kind",
        "Kind of opening…",
        "Change the selected openings to doors, double doors, passages or windows",
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
        "Set the width of the selected openings",
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
        "Set the distance of the selected opening from what is beside it",
        has_opening,
        &given2(
            needed("DISTANCE", length(0.0, 1000.0), "from its end to the next opening or the face of the next wall"),
            optional("END", one_of::<End>(), "which of its ends: start (default) or end"),
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
        "set-dimension",
        "Length of dimension…",
        "Type the length of a stretch of the selected dimension chain: the door, the window or the wall at its end moves",
        has_dimension,
        &given3(
            needed("STRETCH", COUNT, "which stretch of the chain, from 1, along its line"),
            needed("LENGTH", length(0.0001, 1e5), "its new length"),
            optional("END", one_of::<End>(), "which end moves, where both can: start or end"),
            |app, stretch, length_m, end, _| {
                let Some(ElementId::Dimension(id)) = app.picked() else {
                    return Outcome::Refused("select one dimension chain first".to_owned());
                };
                edited_fitting(app, "Set length", |plan| {
                    edit::set_dimension_length(plan, id, stretch - 1, length_m, end)
                })
            },
        ),
        Some(|app, _| {
            if let Some(element) = app.picked() {
                app.change_here(element);
            }
        }),
    )
    .menu(Menu::Modify, 7)
    .on(&[On::Dimension]),
    with(
        "set-hinge",
        "Hinge…",
        "Set the hinge side of the selected doors",
        has_opening,
        &given1(needed("END", one_of::<End>(), "start or end of the opening"), |app, end, _| {
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
        "Set the side that the selected doors open to",
        has_opening,
        &given1(
            needed("SIDE", one_of::<LeafSide>(), "left or right, seen from the opening's start to its end"),
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
        "Keep the pointer from selecting or moving rooms",
        always,
        |app| app.session.layers.locked.rooms,
        |app, is_on| app.session.layers.locked.rooms = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-walls",
        "Lock walls",
        "Keep the pointer from selecting or moving walls",
        always,
        |app| app.session.layers.locked.walls,
        |app, is_on| app.session.layers.locked.walls = is_on,
    )
    .menu(Menu::Modify, 9),
    switch(
        "lock-openings",
        "Lock openings",
        "Keep the pointer from selecting or moving openings",
        always,
        |app| app.session.layers.locked.openings,
        |app, is_on| app.session.layers.locked.openings = is_on,
    )
    .menu(Menu::Modify, 9),
    // The actions of the pointer, for scripts.
    with(
        "select-box",
        "Select in a box",
        "Select what lies inside a box, or also what it touches",
        has_plan,
        &given3(
            needed("CORNERS", points(2), "two opposite corners of the box"),
            optional("HOW", one_of::<Boxed>(), "inside (default) or touching"),
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
        "Move the selection: rooms come away from what they share, while what shares walls follows",
        has_picked,
        &given2(
            needed("BY", POINT, "how far to the right and up in metres, such as '0.5,-1'"),
            optional("REACH", one_of::<Reach>(), "for a wall: run (default) for the whole straight wall, or piece"),
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
        "Paste what was copied, centred on a point",
        has_copied,
        &given1(needed("PLACE", POINT, "a point in metres, such as '2,1.5'"), |app, at, _| app.paste_at(at)),
        None,
    ),
    with(
        "bridge-gap",
        "Door into a gap",
        "Place an opening in the gap between two aligned walls that is nearest to a point",
        has_drawing,
        &given2(
            needed("PLACE", POINT, "a point in metres, such as '2,1.5'"),
            optional("KIND", one_of::<OpeningKind>(), "door (default), double-door, passage or window"),
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
        "Nudge the selection, as an arrow key does; an opening moves along its wall",
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
        "Move one end of an opening along its wall towards a point; its other end stays",
        has_openings,
        &given3(
            needed("OPENING", OPENING, "the opening's id"),
            needed("END", one_of::<End>(), "start or end of the opening"),
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
        "Slide an opening along its wall towards a point",
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
    optional("COPY", one_of::<MoveOrCopy>(), "move (default), or copy to keep the original");

const CENTRE: Arg<Option<Point>> =
    optional("ABOUT", POINT, "a point in metres, such as '4,3'; without it, the middle of the selection");
