//! The picked room: finding, naming, labelling.

use super::draw::edited;
use super::*;
use crate::app::session::bulk::{Change, Order, Which};
use crate::app::session::labelling::Target;
use crate::app::value::room_word;
use crate::edit;

const TARGET: Arg<Option<RoomId>> = optional(
    "ROOM",
    A_ROOM,
    "a room's name or id; without it, the selected rooms, or the one under the pointer if nothing is selected",
);

/// Gives rooms a label.
const fn label<G, F>(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    given: &'static Given<1, G, F>,
    is_on: fn(&App) -> bool,
) -> Command
where
    Given<1, G, F>: Run,
{
    with(id, title, help, has_target, given, None)
        .when_complete(has_rooms)
        .shown_on(is_on)
        .menu(Menu::Room, 2)
        .on(&[On::Room, On::Several])
}

fn label_target(app: &mut App, room: Option<RoomId>, label: Option<Label>) -> Outcome {
    on_target(app, room, &[], |app, target| app.session.label_rooms(target, label))
}

/// Exactly one room is selected, just drawn or under the pointer.
fn has_one_target(app: &App) -> Availability {
    has_target(app)?;
    when(app.session.target(None).is_some_and(|target| target.rooms.len() == 1), "select one room first")
}

impl App {
    /// Gives the keyboard to the field for a text of the one room meant, which is picked for that.
    fn ask_for_field_of_target(&mut self, kind: FieldKind) {
        let target = self.session.target(None).filter(|target| !target.is_selection);
        if let Some(&room) = target.as_ref().and_then(|target| target.rooms.first()) {
            let word = self.plan().map(|plan| room_word(plan, room)).unwrap_or_default();
            self.session.pick(Some(ElementId::Room(room)));
            self.session.note_executed("pick", vec![word]);
        }
        self.ask_for_field(kind);
    }
}

fn has_moved_name(app: &App) -> Availability {
    has_plan(app)?;
    let has_moved = |plan: &crate::plan::Plan| {
        let mut rooms = app.selection().rooms().filter_map(|id| plan.room(id));
        rooms.any(|room| room.text_offset.is_some())
    };
    when(app.plan().is_some_and(has_moved), "select a room whose name was moved first")
}

/// Acts on the rooms a command applies to; a recording names a room that was just under the pointer.
fn on_target(app: &mut App, named: Option<RoomId>, given: &[&str], act: impl FnOnce(&mut App, &Target)) -> Outcome {
    let Some((plan, target)) = app.plan().zip(app.session.target(named)) else {
        return Outcome::Refused("select a room first, or point at one".to_owned());
    };
    let words = given.iter().map(|word| (*word).to_owned()).chain(target.word(plan)).collect();
    act(app, &target);
    Outcome::DoneWith(words)
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "find-room",
        "Find a room…",
        "Find a room by its name, select it and bring it into view",
        has_rooms,
        &given1(ROOM, |app, room, _| {
            app.session.pick(Some(ElementId::Room(room)));
            app.canvas.reveal(ElementId::Room(room));
            Outcome::Done
        }),
        None,
    )
    .keys(&[ctrl(Key::F)])
    .menu(Menu::Room, 0),
    with(
        "rename",
        "Rename…",
        "Change the name of a room: the selected one, or the one just drawn or under the pointer",
        has_one_target,
        &given1(needed("NAME", TEXT, "the room's name"), |app, name, _| {
            app.session.write_field(FieldKind::Name, &name);
            Outcome::Done
        }),
        Some(|app, _| app.ask_for_field_of_target(FieldKind::Name)),
    )
    .when_complete(has_room)
    .keys(&[key(Key::F2)])
    .menu(Menu::Room, 1)
    .on(&[On::Room]),
    with(
        "set-function",
        "Set function…",
        "Set what the selected rooms, or the one under the pointer, are for: a function of the typology, most used \
         first, or any other",
        has_target,
        &given2(
            needed("FUNCTION", FUNCTION, "what the room is for, in the words of the label scheme or any other"),
            TARGET,
            |app, function, room, _| {
                on_target(app, room, &[&function], |app, target| app.session.set_function_of(target, &function))
            },
        ),
        Some(|app, _| {
            let Some((plan, target)) = app.plan().zip(app.session.target(None)) else { return };
            let (title, rest) = (target.title(plan), target.word(plan));
            let rest = rest.into_iter().collect();
            app.ask_for_argument(Asked { about: title, rest, ..Asked::of("set-function") });
        }),
    )
    .when_complete(has_rooms)
    .keys(&[key(Key::F4), shift(Key::F2)])
    .menu(Menu::Room, 1)
    .on(&[On::Room, On::Several]),
    with(
        "accept-function",
        "Use the name as function",
        "Set the function that a room's name speaks for, such as kitchen for 'Kitchen 2' or 'Küche', for the selected \
         rooms that have none, or the one under the pointer",
        has_proposed_function,
        &given1(TARGET, |app, room, _| {
            on_target(app, room, &[], |app, target| app.session.accept_functions(target))
        }),
        None,
    )
    .when_complete(has_rooms)
    .keys(&[shift(Key::F4)])
    .menu(Menu::Room, 1),
    with(
        "set-note",
        "Write note…",
        "Write a note on a room: the selected one, or the one just drawn or under the pointer",
        has_one_target,
        &given1(needed("TEXT", TEXT, "the note"), |app, note, _| {
            app.session.write_field(FieldKind::Note, &note);
            Outcome::Done
        }),
        Some(|app, _| app.ask_for_field_of_target(FieldKind::Note)),
    )
    .when_complete(has_room)
    .menu(Menu::Room, 1)
    .on(&[On::Room]),
    with(
        "name-rooms",
        "Name rooms…",
        "Name many rooms by a pattern such as {function} {n}; shows the names first",
        has_rooms,
        &given4(
            needed("PATTERN", TEXT, "text with {n}, {nn}, {function}, {label}, {letter}, {storey}, {building}"),
            optional(
                "ROOMS",
                TEXT,
                "unnamed (default), selected, all, 'function office', 'label big' or 'along 1,2 5,2'",
            ),
            optional("ORDER", one_of::<Order>(), "rows (default) or columns, from the top left"),
            optional("START", whole(1_000_000), "the first number, 1 by default"),
            |app, pattern, which, order, start, _| {
                let which = Which::of_word(which.as_deref().unwrap_or("unnamed"));
                let order = order.unwrap_or(Order::Rows);
                let start = start.and_then(|start| u32::try_from(start).ok()).unwrap_or(1);
                match which.and_then(|which| app.session.name_rooms(&pattern, &which, order, start)) {
                    Ok(()) => Outcome::Done,
                    Err(reason) => Outcome::Refused(reason),
                }
            },
        ),
        Some(|app, _| app.open_dialog(dialogs::BULK)),
    )
    .keys(&[ctrl(Key::F2)])
    .menu(Menu::Room, 1)
    .on(&[On::Several]),
    tool(&tools::NUMBER, has_rooms).menu(Menu::Room, 1),
    with(
        "name-along",
        "Name rooms along a line",
        "Name the rooms that a line crosses, in that order; asks for a pattern",
        has_rooms,
        &given1(
            needed("POINTS", points(2), "the points of the line, such as '1,2 5,2', in metres"),
            |app, points, _| {
                let which = Which::Along(points);
                if app.session.rooms_of(&which).is_empty() {
                    return Outcome::Refused("the line goes through no room".to_owned());
                }
                app.open_dialog_for(dialogs::BULK, Purpose::NameRooms(which));
                Outcome::Asks
            },
        ),
        None,
    ),
    with(
        "change-rooms",
        "Change rooms…",
        "Give all rooms of a function or a label, or the selected ones, another function or label; shows how many \
         first",
        has_rooms,
        &given2(
            needed("ROOMS", TEXT, "selected, unnamed, all, 'function office' or 'label big'"),
            needed("CHANGE", TEXT, "'function meeting room', 'label hall' or 'label by-function'"),
            |app, which, change, _| {
                let which = Which::of_word(&which);
                let change = Change::of_word(&change);
                match which.and_then(|which| app.session.change_rooms(&which, &change?)) {
                    Ok(()) => Outcome::Done,
                    Err(reason) => Outcome::Refused(reason),
                }
            },
        ),
        Some(|app, _| app.open_dialog_for(dialogs::BULK, Purpose::ChangeRooms)),
    )
    .menu(Menu::Room, 1)
    .on(&[On::Several]),
    label(
        "label-small",
        "Small room",
        "Label the selected rooms, or the one under the pointer, as a small room: a side room such as a bathroom, a \
         closet or a store",
        &given1(TARGET, |app, room, _| label_target(app, room, Some(Label::SmallRoom))),
        |app| app.session.selected_label() == Some(Label::SmallRoom),
    )
    .keys(&[key(Key::S), key(Key::Num1)]),
    label(
        "label-medium",
        "Medium room",
        "Label the selected rooms, or the one under the pointer, as a medium room: an ordinary room such as a bedroom, \
         an office or a classroom",
        &given1(TARGET, |app, room, _| label_target(app, room, Some(Label::MediumRoom))),
        |app| app.session.selected_label() == Some(Label::MediumRoom),
    )
    .keys(&[key(Key::M), key(Key::Num2)]),
    label(
        "label-big",
        "Big room",
        "Label the selected rooms, or the one under the pointer, as a big room: a large room such as a living room, a \
         canteen or an open-plan office",
        &given1(TARGET, |app, room, _| label_target(app, room, Some(Label::BigRoom))),
        |app| app.session.selected_label() == Some(Label::BigRoom),
    )
    .keys(&[key(Key::B), key(Key::Num3)]),
    label(
        "label-corridor",
        "Corridor",
        "Label the selected rooms, or the one under the pointer, as a corridor: a way from room to room, mostly long and \
         with several doors",
        &given1(TARGET, |app, room, _| label_target(app, room, Some(Label::Corridor))),
        |app| app.session.selected_label() == Some(Label::Corridor),
    )
    .keys(&[key(Key::C), key(Key::Num4)]),
    label(
        "label-hall",
        "Hall",
        "Label the selected rooms, or the one under the pointer, as a hall: a wide space that people enter by or gather \
         in, such as a lobby",
        &given1(TARGET, |app, room, _| label_target(app, room, Some(Label::Hall))),
        |app| app.session.selected_label() == Some(Label::Hall),
    )
    .keys(&[key(Key::H), key(Key::Num5)]),
    with(
        "label-by-function",
        "Clear labels",
        "Remove the labels given to the selected rooms, so that each gets the label of its function again",
        has_own_label,
        &given1(TARGET, |app, room, _| label_target(app, room, None)),
        None,
    )
    .when_complete(has_rooms)
    .menu(Menu::Room, 2)
    .on(&[On::Room, On::Several]),
    with(
        "move-name",
        "Move a name",
        "Write the name and area of a room in another place; they keep it while the plan changes",
        has_rooms,
        &given2(ROOM, needed("PLACE", POINT, "their middle, in metres, such as '2,1.5'"), |app, room, place, _| {
            let middle = app.session.document.as_ref().and_then(|it| it.bounds_of(ElementId::Room(room)));
            let Some(middle) = middle.map(Bounds::center) else {
                return Outcome::Refused("the room has no boundary".to_owned());
            };
            edited(app, "Move name", |plan| edit::set_text_offset(plan, room, Some(place - middle)))
        }),
        None,
    ),
    with(
        "reset-name",
        "Reset place of name",
        "Write the names and areas of the selected rooms where they fit best again, after they were moved",
        has_moved_name,
        &given0(|app, _| {
            let rooms: Vec<RoomId> = app.selection().rooms().collect();
            edited(app, "Reset place of name", |plan| {
                rooms.iter().try_fold(plan.clone(), |plan, &room| edit::set_text_offset(&plan, room, None))
            })
        }),
        None,
    )
    .menu(Menu::Room, 2)
    .on(&[On::Room, On::Several]),
    command("next-room", "Next room", "Select the next room, in reading order from the top left", has_rooms, |app, _| {
        app.session.pick_neighbour(1);
    })
    .keys(&[key(Key::CloseBracket)])
    .menu(Menu::Room, 3),
    command("previous-room", "Previous room", "Select the room before", has_rooms, |app, _| {
        app.session.pick_neighbour(-1);
    })
    .keys(&[key(Key::OpenBracket)])
    .menu(Menu::Room, 3),
];
