//! The actions of the pointer, for scripts.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "pick",
        "Pick a room",
        "Select a room as a click does; the view stays where it is",
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
            needed("ELEMENTS", ELEMENTS, "ids, separated by blanks"),
            optional("MODE", one_of::<SelectMode>(), "replace (default), add or toggle"),
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
        "Select an opening as a click does",
        has_openings,
        &given2(
            needed("OPENING", OPENING, "the opening's id"),
            optional("SHOW", ON_OR_OFF, "on to bring it into view; without it, the view stays where it is"),
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
        "Select the next room in a direction, as an arrow key on the plan does",
        has_rooms,
        &given1(needed("DIRECTION", one_of::<Direction>(), "left, right, up or down"), |app, direction, _| {
            app.session.pick_towards(direction.vector());
            Outcome::Done
        }),
        None,
    ),
    with(
        "change-here",
        "Edit in place",
        "Show a small form with the name or measures of an element, as a double click does",
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
        "Centre the view on a point, at so many pixels per metre",
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
        "Close a message on the plan",
        has_messages,
        &given1(
            optional("NUMBER", COUNT, "which one, 1 being the oldest; without it, the newest"),
            |app, number, _| {
                let shown = app.session.shown_messages();
                let newest = shown.len();
                let number = number.unwrap_or(newest);
                match number.checked_sub(1).and_then(|index| shown.get(index)) {
                    Some(&index) => drop(app.session.messages.remove(index)),
                    None => return Outcome::Refused(format!("there are {newest} messages")),
                }
                Outcome::Done
            },
        ),
        None,
    ),
    with(
        "answer",
        "Answer the question",
        "Answer the question on the screen",
        is_asked,
        &given2(
            needed("ANSWER", ANSWER, "the button: save, discard, replace, elsewhere, delete or cancel"),
            optional("PATH", NEW_PLAN_FILE, "the file to save to, where a dialog would ask for it"),
            |app, word, path, _| {
                if app.session.answer(word, path) { Outcome::Done } else { Outcome::Asks }
            },
        ),
        None,
    ),
    with(
        "choose-file",
        "Choose a file",
        "Give the path of a file, if the system has no file dialog",
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
