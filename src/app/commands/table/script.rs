//! The actions of the pointer, for scripts.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "pick",
        "Pick a room",
        "Pick a room, as a click on it does: the view stays where it is",
        has_rooms,
        &given1(ROOM, |app, room, _| {
            app.session.pick(Some(ElementId::Room(room)));
            Outcome::Done
        }),
        None,
    ),
    with(
        "select",
        "Select elements",
        "Select rooms, walls, openings and corners, as clicks and boxes do",
        has_plan,
        &given2(
            needed("ELEMENTS", ELEMENTS, "ids with blanks between"),
            optional("MODE", one_of::<SelectMode>(), "replace (without), add or toggle"),
            |app, elements, mode, _| {
                app.session.select(elements, mode.unwrap_or(SelectMode::Replace));
                Outcome::Done
            },
        ),
        None,
    ),
    with(
        "pick-opening",
        "Pick an opening",
        "Pick an opening, as a click on it does",
        has_openings,
        &given2(
            needed("OPENING", OPENING, "the opening's id"),
            optional("SHOW", ON_OR_OFF, "on to bring it into sight; without, the view stays where it is"),
            |app, opening, is_shown, _| {
                let picked = ElementId::Opening(opening);
                app.session.pick(Some(picked));
                if is_shown == Some(true) {
                    app.canvas.reveal(picked);
                }
                Outcome::Done
            },
        ),
        None,
    ),
    with(
        "pick-towards",
        "Pick towards",
        "Pick the next room in a direction, as an arrow key on the plan does",
        has_rooms,
        &given1(needed("DIRECTION", one_of::<Direction>(), "left, right, up or down"), |app, direction, _| {
            app.session.pick_towards(direction.vector());
            Outcome::Done
        }),
        None,
    ),
    with(
        "change-here",
        "Change it where it is",
        "Show a small form beside an element, with its name or its measures, as a double click on it does",
        has_plan,
        &given1(needed("ELEMENT", ELEMENTS, "its id"), |app, elements, _| {
            let Some(&element) = elements.first() else { return Outcome::Done };
            app.session.pick(Some(element));
            app.change_here(element);
            Outcome::Asks
        }),
        None,
    ),
    with(
        "zoom-to",
        "Zoom to a place",
        "Show a rectangle of the plan as large as fits",
        has_plan,
        &given4(X, Y, WIDTH, HEIGHT, |app, x, y, width, height, _| {
            let corner = Point::new(x, y);
            app.canvas.zoom_to(Bounds::of([corner, corner + Vector::new(width, height)]));
            Outcome::Done
        }),
        None,
    ),
    with(
        "view",
        "Set the view",
        "Show the plan about a point, a metre so many pixels long",
        has_plan,
        &given3(X, Y, SCALE, |app, x, y, scale, _| {
            app.canvas.look_at(Point::new(x, y), scale);
            Outcome::Done
        }),
        None,
    ),
    with(
        "dismiss-message",
        "Dismiss a message",
        "Take a message off the plan",
        has_messages,
        &given1(optional("NUMBER", COUNT, "which one, the oldest being 1; without, the newest"), |app, number, _| {
            let shown = app.session.shown_messages();
            let newest = shown.len();
            let number = number.unwrap_or(newest);
            match number.checked_sub(1).and_then(|index| shown.get(index)) {
                Some(&index) => drop(app.session.messages.remove(index)),
                None => return Outcome::Refused(format!("there are {newest} messages")),
            }
            Outcome::Done
        }),
        None,
    ),
    with(
        "answer",
        "Answer the question",
        "Press a button of the question that is asked",
        is_asked,
        &given2(
            needed("ANSWER", ANSWER, "the button: save, discard, replace, elsewhere, delete or cancel"),
            optional("PATH", NEW_PLAN_FILE, "the file to save in, where a dialog would ask for it"),
            |app, word, path, _| {
                if app.session.answer(word, path) { Outcome::Done } else { Outcome::Asks }
            },
        ),
        None,
    ),
    with(
        "choose-file",
        "Choose a file",
        "Name the file that is asked for, where the system has no dialog to do so",
        is_asked_for_file,
        &given1(needed("PATH", NEW_FILE, "the file"), |app, path, context| {
            if let Some(purpose) = app.session.typed_for.take() {
                app.session.was_typed(purpose, path, context);
            }
            Outcome::Asks
        }),
        None,
    ),
];
