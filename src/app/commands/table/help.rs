//! Commands, shortcuts, recording.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "commands",
        "Commands…",
        "Find a command by its name and do it",
        always,
        &[],
        |app, _, _| {
            app.open_dialog(crate::app::panels::palette::ID);
            Ran::Asks
        },
        None,
    )
    .keys(&[ctrl_shift(Key::P)])
    .menu(Menu::Help, 0),
    with(
        "shortcuts",
        "Shortcuts…",
        "Show the shortcuts of all commands, and change them",
        always,
        &[],
        |app, _, _| {
            app.open_dialog(crate::app::panels::shortcuts::ID);
            Ran::Asks
        },
        None,
    )
    .keys(&[key(Key::Questionmark), key(Key::F1)])
    .menu(Menu::Help, 0),
    with(
        "set-shortcut",
        "Set a shortcut…",
        "Give a command other keys than it has",
        always,
        &[
            needed("COMMAND", ArgumentKind::Command, "the command's id"),
            needed("KEYS", ArgumentKind::Keys, "keys such as Ctrl+Shift+K, F5 or Plus"),
        ],
        |app, values, _| match values.command(0) {
            Some(command) => app.set_shortcut(command, values.keys(1).copied()),
            None => Ran::Done,
        },
        None,
    )
    .menu(Menu::Help, 1),
    with(
        "remove-shortcut",
        "Remove a shortcut…",
        "Leave a command without keys",
        always,
        &[needed("COMMAND", ArgumentKind::Command, "the command's id")],
        |app, values, _| match values.command(0) {
            Some(command) => app.set_shortcut(command, None),
            None => Ran::Done,
        },
        None,
    ),
    with(
        "reset-shortcut",
        "Reset a shortcut…",
        "Give a command the keys it comes with",
        has_changed_keys,
        &[needed("COMMAND", ArgumentKind::Command, "the command's id")],
        |app, values, _| match values.command(0) {
            Some(command) => app.reset_shortcut(command),
            None => Ran::Done,
        },
        None,
    ),
    command(
        "reset-shortcuts",
        "Reset all shortcuts",
        "Give every command the keys it comes with",
        has_changed_keys,
        |app, _| {
            app.reset_all_shortcuts();
        },
    )
    .menu(Menu::Help, 1),
    switch(
        "record-script",
        "Record a script",
        "Write what is done as a script that does it again; once more to end and save it",
        can_record,
        App::is_recording,
        |app, _| if app.is_recording() { app.stop_recording(None) } else { app.wants_recording = true },
    )
    .menu(Menu::Help, 2),
    with(
        "about",
        "About Enfilade",
        "Show the version, the licence and the paper",
        always,
        &[],
        |app, _, _| {
            app.open_dialog(crate::app::panels::about::ID);
            Ran::Asks
        },
        None,
    )
    .menu(Menu::Help, 3),
];
