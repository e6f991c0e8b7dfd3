//! What the pointer does, for scripts.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "pick",
        "Pick a room",
        "Pick a room, as a click on it does: the view stays where it is",
        has_rooms,
        &[ROOM],
        |app, values, _| {
            app.session.pick(values.room(0).copied().map(ElementId::Room));
            Ran::Done
        },
        None,
    ),
    with(
        "select",
        "Select elements",
        "Select rooms, walls, openings and corners, as clicks and boxes do",
        has_plan,
        &[
            needed("ELEMENTS", ArgumentKind::Elements, "ids with blanks between"),
            optional("MODE", ArgumentKind::Word(SelectMode::WORDS), "replace (without), add or toggle"),
        ],
        |app, values, _| {
            let mode = SelectMode::of_word(values.word(1).copied().unwrap_or("replace"));
            app.session.select(values.elements(0).unwrap_or_default().iter().copied(), mode);
            Ran::Done
        },
        None,
    ),
    with(
        "pick-opening",
        "Pick an opening",
        "Pick an opening, as a click on it does",
        has_openings,
        &[
            needed("OPENING", ArgumentKind::Opening, "the opening's id"),
            optional("SHOW", ArgumentKind::Switch, "on to bring it into sight; without, the view stays where it is"),
        ],
        |app, values, _| {
            if let Some(picked) = values.opening(0).copied().map(ElementId::Opening) {
                app.session.pick(Some(picked));
                if values.switch(1) == Some(&true) {
                    app.canvas.reveal(picked);
                }
            }
            Ran::Done
        },
        None,
    ),
    with(
        "pick-towards",
        "Pick towards",
        "Pick the next room in a direction, as an arrow key on the plan does",
        has_rooms,
        &[needed("DIRECTION", ArgumentKind::Word(DIRECTIONS), "left, right, up or down")],
        |app, values, _| {
            app.session.pick_towards(match values.word(0) {
                Some(&"left") => Vector::new(-1.0, 0.0),
                Some(&"right") => Vector::new(1.0, 0.0),
                Some(&"up") => Vector::new(0.0, 1.0),
                _ => Vector::new(0.0, -1.0),
            });
            Ran::Done
        },
        None,
    ),
    with(
        "zoom-to",
        "Zoom to a place",
        "Show a rectangle of the plan as large as fits",
        has_plan,
        &[X, Y, WIDTH, HEIGHT],
        |app, values, _| {
            let number = |index: usize| values.number(index).copied().unwrap_or_default();
            let corner = Point::new(number(0), number(1));
            app.canvas.zoom_to(Bounds::of([corner, corner + Vector::new(number(2), number(3))]));
            Ran::Done
        },
        None,
    ),
    with(
        "view",
        "Set the view",
        "Show the plan about a point, a metre so many pixels long",
        has_plan,
        &[X, Y, SCALE],
        |app, values, _| {
            let number = |index: usize| values.number(index).copied().unwrap_or_default();
            app.canvas.look_at(Point::new(number(0), number(1)), number(2));
            Ran::Done
        },
        None,
    ),
    with(
        "dismiss-message",
        "Dismiss a message",
        "Take a message out of the bar above the plan",
        has_messages,
        &[optional("NUMBER", ArgumentKind::Count, "which one, the oldest being 1; without, the newest")],
        |app, values, _| {
            let newest = app.session.messages.len();
            let number = values.count(0).copied().unwrap_or(newest);
            if number > newest {
                return Ran::Refused(format!("there are {newest} messages"));
            }
            app.session.messages.remove(number - 1);
            Ran::Done
        },
        None,
    ),
    with(
        "answer",
        "Answer the question",
        "Press a button of the question that is asked",
        is_asked,
        &[
            needed("ANSWER", ArgumentKind::Answer, "the button: save, discard, replace, elsewhere, delete or cancel"),
            optional("PATH", ArgumentKind::NewPlanFile, "the file to save in, where a dialog would ask for it"),
        ],
        |app, values, _| {
            let word = values.word(0).copied().unwrap_or("cancel");
            if app.session.answer(word, values.path(1).map(Path::to_owned)) { Ran::Done } else { Ran::Asks }
        },
        None,
    ),
];
