//! Undo and redo, and the plan as a whole.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "undo",
        "Undo",
        "Undo the last change; while you draw, the last corner",
        can_undo, // A corner in the making is no change of the plan.
        &given0(|app, _| if app.undo() { Outcome::Done } else { Outcome::Asks }),
        None,
    )
    .keys(&[ctrl(Key::Z)])
    .menu(Menu::Edit, 0)
    .on(&[On::Picture, On::FreeSpace])
    .tool(Icon::Undo, 0),
    command("redo", "Redo", "Redo what was undone", can_redo, |app, _| app.session.redo())
        .keys(&[ctrl_shift(Key::Z), ctrl(Key::Y)])
        .menu(Menu::Edit, 0)
        .on(&[On::Picture, On::FreeSpace])
        .tool(Icon::Redo, 0),
    with(
        "jump-to-step",
        "Go to a step…",
        "Go back or forward to a step of the history",
        has_plan,
        &given1(needed("STEP", COUNT, "which step of the history; 1 is the plan as it was opened"), |app, step, _| {
            match app.session.jump_to_step(step - 1) {
                Ok(()) => Outcome::Done,
                Err(reason) => Outcome::Refused(reason),
            }
        }),
        Some(|app, _| app.panels.set_shown(panels::HISTORY, true)),
    )
    .menu(Menu::Edit, 0),
    with(
        "clear-selection",
        "Clear selection",
        "Leave the tool, or clear the selection",
        can_clear,
        &given0(|app, _| {
            if app.tools.is_selecting() {
                app.session.pick(None);
                return Outcome::Done;
            }
            app.put_tool_away();
            // A recording need not know how the tool came to hand: without it, the selection would be cleared instead.
            app.session.note_executed("tool-select", Vec::new());
            Outcome::Asks
        }),
        None,
    )
    .keys(&[key(Key::Escape)])
    .menu(Menu::Edit, 1),
    with(
        "rename-plan",
        "Rename the plan…",
        "Change the plan's name",
        has_plan,
        &given1(needed("NAME", TEXT, "the plan's name"), |app, name, _| {
            app.session.change_meta("Rename plan", |meta| meta.name = name);
            Outcome::Done
        }),
        Some(|app, _| {
            let text = app.plan().map(|plan| plan.meta().name.clone()).unwrap_or_default();
            app.ask_for_argument(Asked { text, ..Asked::of("rename-plan") });
        }),
    )
    .menu(Menu::Edit, 2)
    .on(&[On::ListedPlan]),
    with(
        "set-typology",
        "Typology…",
        "Choose the kind of building; its label scheme gives rooms the labels of their functions",
        has_plan,
        &given1(needed("TYPOLOGY", TYPOLOGY, "a typology with a label scheme, or 'unknown'"), |app, typology, _| {
            app.session.change_meta("Set typology", |meta| meta.typology = typology);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Edit, 2)
    .on(&[On::FreeSpace, On::ListedPlan]),
];
