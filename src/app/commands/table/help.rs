//! Commands, shortcuts, recording.

use super::*;

fn has_demo(app: &App) -> Availability {
    when(app.session.demo.is_some(), "no demonstration is running")
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "commands",
        "Commands…",
        "Find a command by its name and run it",
        always,
        &given0(|app, _| {
            app.open_dialog(dialogs::PALETTE);
            Outcome::Asks
        }),
        None,
    )
    .keys(&[ctrl_shift(Key::P)])
    .menu(Menu::Help, 0),
    with(
        "shortcuts",
        "Shortcuts…",
        "Show the shortcuts of all commands, and change them",
        always,
        &given0(|app, _| {
            app.open_dialog(dialogs::SHORTCUTS);
            Outcome::Asks
        }),
        None,
    )
    .keys(&[key(Key::Questionmark), key(Key::F1)])
    .menu(Menu::Help, 0),
    command(
        "demonstration",
        "Watch a demonstration",
        "Watch a school being drawn and labelled room by room, in less than a minute; take over at any moment",
        always,
        |app, _| app.session.start_demo(),
    )
    .menu(Menu::Help, 0),
    command("stop-demonstration", "Stop the demonstration", "Take over its plan as it is", has_demo, |app, _| {
        app.session.stop_demo();
    }),
    with(
        "set-shortcut",
        "Set a shortcut…",
        "Change the shortcut of a command",
        always,
        &given2(
            needed("COMMAND", A_COMMAND, "the command's id"),
            needed("KEYS", KEYS, "keys such as Ctrl+Shift+K, F5 or Plus"),
            |app, CommandId(id), keys, _| app.set_shortcut(id, Some(keys)),
        ),
        None,
    )
    .menu(Menu::Help, 1),
    with(
        "remove-shortcut",
        "Remove a shortcut…",
        "Remove the shortcut of a command",
        always,
        &given1(needed("COMMAND", A_COMMAND, "the command's id"), |app, CommandId(id), _| app.set_shortcut(id, None)),
        None,
    ),
    with(
        "reset-shortcut",
        "Reset a shortcut…",
        "Restore the original shortcut of a command",
        has_changed_keys,
        &given1(needed("COMMAND", A_COMMAND, "the command's id"), |app, CommandId(id), _| app.reset_shortcut(id)),
        None,
    ),
    command(
        "reset-shortcuts",
        "Reset all shortcuts",
        "Restore the original shortcuts of all commands",
        has_changed_keys,
        |app, _| {
            app.reset_all_shortcuts();
        },
    )
    .menu(Menu::Help, 1),
    switch(
        "record-script",
        "Record a script",
        "Record what you do as a script; run it again to stop and save",
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
        &given0(|app, _| {
            app.open_dialog(dialogs::ABOUT);
            Outcome::Asks
        }),
        None,
    )
    .menu(Menu::Help, 3),
];
