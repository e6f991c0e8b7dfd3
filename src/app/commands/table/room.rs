//! The picked room: finding, naming, labelling.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "find-room",
        "Find a room…",
        "Pick a room by its name and bring it into sight",
        has_rooms,
        &[ROOM],
        |app, values, _| {
            if let Some(picked) = values.room(0).copied().map(ElementId::Room) {
                app.pick(Some(picked));
                app.canvas.reveal(picked);
            }
            Ran::Done
        },
        None,
    )
    .keys(&[ctrl(Key::F)])
    .menu(Menu::Room, 0),
    with(
        "rename",
        "Rename…",
        "Write the picked room's name",
        has_room,
        &[needed("NAME", ArgumentKind::Text, "the room's name")],
        |app, values, _| {
            app.write_field(FieldKind::Name, values.text(0).unwrap_or_default());
            Ran::Done
        },
        Some(|app, _| app.ask_for_field(FieldKind::Name)),
    )
    .keys(&[key(Key::F2)])
    .menu(Menu::Room, 1),
    with(
        "set-function",
        "Set function…",
        "Write what the picked room is for",
        has_room,
        &[needed(
            "FUNCTION",
            ArgumentKind::Function,
            "what the room is for, as the label scheme or as the source has it",
        )],
        |app, values, _| {
            app.write_field(FieldKind::Function, values.text(0).unwrap_or_default());
            Ran::Done
        },
        Some(|app, _| app.ask_for_field(FieldKind::Function)),
    )
    .keys(&[shift(Key::F2)])
    .menu(Menu::Room, 1),
    with(
        "set-note",
        "Write note…",
        "Write a note on the picked room",
        has_room,
        &[needed("TEXT", ArgumentKind::Text, "the note")],
        |app, values, _| {
            app.write_field(FieldKind::Note, values.text(0).unwrap_or_default());
            Ran::Done
        },
        Some(|app, _| app.ask_for_field(FieldKind::Note)),
    )
    .menu(Menu::Room, 1),
    choose(
        "label-small",
        "Small room",
        "Label the picked room as a small room",
        has_room,
        |app| app.picked_label() == Some(Label::SmallRoom),
        |app, _| app.label_picked(Some(Label::SmallRoom)),
    )
    .keys(&[key(Key::S)])
    .menu(Menu::Room, 2),
    choose(
        "label-medium",
        "Medium room",
        "Label the picked room as a medium room",
        has_room,
        |app| app.picked_label() == Some(Label::MediumRoom),
        |app, _| app.label_picked(Some(Label::MediumRoom)),
    )
    .keys(&[key(Key::M)])
    .menu(Menu::Room, 2),
    choose(
        "label-big",
        "Big room",
        "Label the picked room as a big room",
        has_room,
        |app| app.picked_label() == Some(Label::BigRoom),
        |app, _| app.label_picked(Some(Label::BigRoom)),
    )
    .keys(&[key(Key::B)])
    .menu(Menu::Room, 2),
    choose(
        "label-corridor",
        "Corridor",
        "Label the picked room as a corridor",
        has_room,
        |app| app.picked_label() == Some(Label::Corridor),
        |app, _| app.label_picked(Some(Label::Corridor)),
    )
    .keys(&[key(Key::C)])
    .menu(Menu::Room, 2),
    choose(
        "label-hall",
        "Hall",
        "Label the picked room as a hall",
        has_room,
        |app| app.picked_label() == Some(Label::Hall),
        |app, _| app.label_picked(Some(Label::Hall)),
    )
    .keys(&[key(Key::H)])
    .menu(Menu::Room, 2),
    command(
        "label-by-function",
        "Label by function",
        "Drop the picked room's own label: the label scheme's answer for its function counts",
        has_own_label,
        |app, _| app.label_picked(None),
    )
    .menu(Menu::Room, 2),
    command("next-room", "Next room", "Pick the next room, as one reads: from the top left", has_rooms, |app, _| {
        app.pick_neighbour(1);
    })
    .keys(&[key(Key::CloseBracket)])
    .menu(Menu::Room, 3),
    command("previous-room", "Previous room", "Pick the room before", has_rooms, |app, _| {
        app.pick_neighbour(-1);
    })
    .keys(&[key(Key::OpenBracket)])
    .menu(Menu::Room, 3),
];
