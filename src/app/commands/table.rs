//! The table itself, in the order of the menus.

use std::path::Path;

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use super::{Action, Argument, ArgumentKind, Availability, Command, Menu, Ran, Values};
use crate::app::icons::Icon;
use crate::app::panels::FieldKind;
use crate::app::panels::palette::Palette;
use crate::app::panels::shortcuts::Sheet;
use crate::app::theme::ThemeChoice;
use crate::app::{App, Intent, Origin, Picked};
use crate::classify::{Algorithm, Method};
use crate::draw::{Fill, LabelColours};
use crate::geometry::{Bounds, Point, Vector};
use crate::labels::Label;

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

const fn entry(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    action: Action,
) -> Command {
    Command { id, title, help, arguments: &[], shortcuts: &[], menu: None, tool: None, availability, action }
}

const fn command(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    run: fn(&mut App, &Context),
) -> Command {
    entry(id, title, help, availability, Action::Plain(run))
}

const SWITCH: &[Argument] = &[optional("SWITCH", ArgumentKind::Switch, "on or off; without, the other of what it is")];

/// Something that is on or off.
const fn switch(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    is_on: fn(&App) -> bool,
    set: fn(&mut App, bool),
) -> Command {
    entry(id, title, help, availability, Action::Switch { is_on, set }).takes(SWITCH)
}

/// One of several, of which one is on.
const fn choose(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    is_on: fn(&App) -> bool,
    run: fn(&mut App, &Context),
) -> Command {
    entry(id, title, help, availability, Action::Choose { is_on, run })
}

/// Something that takes arguments; missing ones are asked for by `ask`, or in the palette.
const fn with(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    arguments: &'static [Argument],
    run: fn(&mut App, &Values, &Context) -> Ran,
    ask: Option<fn(&mut App, &Context)>,
) -> Command {
    entry(id, title, help, availability, Action::With { run, ask }).takes(arguments)
}

const fn needed(name: &'static str, kind: ArgumentKind, help: &'static str) -> Argument {
    Argument { name, kind, is_optional: false, help }
}

const fn optional(name: &'static str, kind: ArgumentKind, help: &'static str) -> Argument {
    Argument { name, kind, is_optional: true, help }
}

impl Command {
    const fn takes(self, arguments: &'static [Argument]) -> Self {
        Self { arguments, ..self }
    }

    const fn keys(self, shortcuts: &'static [KeyboardShortcut]) -> Self {
        Self { shortcuts, ..self }
    }

    const fn menu(self, menu: Menu, section: u8) -> Self {
        Self { menu: Some((menu, section)), ..self }
    }

    const fn tool(self, icon: Icon, group: u8) -> Self {
        Self { tool: Some((icon, group)), ..self }
    }
}

// When commands are available.

fn always(_: &App) -> Availability {
    Ok(())
}

/// `Ok` where something holds, else what to do first.
fn when(holds: bool, otherwise: &'static str) -> Availability {
    if holds { Ok(()) } else { Err(otherwise) }
}

fn has_plan(app: &App) -> Availability {
    when(app.document.is_some(), "open a plan first")
}

fn has_picked(app: &App) -> Availability {
    has_plan(app)?;
    when(app.picked.is_some(), "pick a room or an opening first")
}

fn has_room(app: &App) -> Availability {
    has_plan(app)?;
    when(matches!(app.picked, Some(Picked::Room(_))), "pick a room first")
}

fn has_rooms(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| plan.rooms().len() > 0), "the plan has no rooms")
}

fn has_openings(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| plan.openings().len() > 0), "the plan has no openings")
}

fn can_undo(app: &App) -> Availability {
    has_plan(app)?;
    let can = app.document.as_ref().is_some_and(|document| document.history.can_undo());
    when(can, "there is nothing to undo")
}

fn can_redo(app: &App) -> Availability {
    has_plan(app)?;
    let can = app.document.as_ref().is_some_and(|document| document.history.can_redo());
    when(can, "nothing was undone")
}

fn has_own_label(app: &App) -> Availability {
    has_room(app)?;
    let has = app.picked_room().is_some_and(|(_, room)| room.label.is_some());
    when(has, "the room has no label of its own")
}

fn has_prediction(app: &App) -> Availability {
    has_room(app)?;
    when(app.prediction_of_picked().is_some(), "the room is not one that is predicted")
}

fn has_unlabelled(app: &App) -> Availability {
    has_plan(app)?;
    let has =
        app.predictions().is_some_and(|predictions| predictions.network.rooms.iter().any(|room| room.label.is_none()));
    when(has, "every room has a label")
}

fn has_several_plans(app: &App) -> Availability {
    when(app.list.len() > 1, "there is only one plan in the list")
}

fn has_backdrop(app: &App) -> Availability {
    has_plan(app)?;
    let has = app.plan().is_some_and(|plan| plan.backdrop().is_some());
    when(has, "the plan has no picture under it")
}

fn has_notes(app: &App) -> Availability {
    has_plan(app)?;
    let has = app.document.as_ref().is_some_and(|document| !document.notes.is_empty());
    when(has, "nothing was mended or left out when the plan was opened")
}

fn has_messages(app: &App) -> Availability {
    when(!app.messages.is_empty(), "there is no message")
}

fn can_record(app: &App) -> Availability {
    // A script starts from what is in a file.
    when(
        app.is_recording() || !app.has_unsaved_changes(),
        "save the plan first: a script starts from what is in its file",
    )
}

fn has_changed_keys(app: &App) -> Availability {
    when(app.settings.is_any_changed(), "no shortcut was changed")
}

fn is_asked(app: &App) -> Availability {
    when(app.question.is_some(), "nothing is asked")
}

/// The drawing area's half side in metres: coordinates beyond are no plan's.
const FAR_M: f64 = 1e6;

const X: Argument =
    needed("X", ArgumentKind::Number { unit: " of metres", least: -FAR_M, most: FAR_M }, "to the right, in metres");
const Y: Argument =
    needed("Y", ArgumentKind::Number { unit: " of metres", least: -FAR_M, most: FAR_M }, "up, in metres");
const WIDTH: Argument =
    needed("WIDTH", ArgumentKind::Number { unit: " of metres", least: 0.001, most: FAR_M }, "in metres");
const HEIGHT: Argument =
    needed("HEIGHT", ArgumentKind::Number { unit: " of metres", least: 0.001, most: FAR_M }, "in metres");
const SCALE: Argument = needed(
    "SCALE",
    ArgumentKind::Number { unit: " of pixels to the metre", least: 0.001, most: 1e5 },
    "how many pixels a metre is long",
);

const ROOM: Argument = needed("ROOM", ArgumentKind::Room, "a room's name, or its id where several have the name");

const DIRECTIONS: &[(&str, &str)] = &[("left", "Left"), ("right", "Right"), ("up", "Up"), ("down", "Down")];

/// Every command, in the order of the menus.
pub const COMMANDS: &[Command] = &[
    // File.
    with(
        "open",
        "Open…",
        "Open a plan: a plan file, the authors' XML, or GeoJSON",
        always,
        &[
            needed("PATH", ArgumentKind::PlanFile, "a file with a plan, or a folder of which the first plan is opened"),
            optional("STOREY", ArgumentKind::Count, "which plan of the file, from 1"),
        ],
        |app, values, _| {
            if let Some(path) = values.path(0) {
                let storey = values.count(1).map_or(0, |storey| storey - 1);
                app.open(Origin::File { path: path.to_owned(), storey });
            }
            Ran::Done
        },
        Some(|app, _| app.choose_plan()),
    )
    .keys(&[ctrl(Key::O)])
    .menu(Menu::File, 0),
    with(
        "open-sample",
        "Open a sample…",
        "Open a plan that comes with the program",
        always,
        &[needed("SAMPLE", ArgumentKind::Sample, "the sample's file name without the ending")],
        |app, values, _| {
            if let Some(&sample) = values.sample(0) {
                app.open(Origin::Bundled(sample));
            }
            Ran::Done
        },
        None,
    )
    .menu(Menu::File, 0),
    with(
        "save",
        "Save",
        "Save the plan in its file",
        has_plan,
        &[],
        |app, _, _| if app.save(None) { Ran::Done } else { Ran::Asks },
        None,
    )
    .keys(&[ctrl(Key::S)])
    .menu(Menu::File, 1),
    with(
        "save-as",
        "Save as…",
        "Save the plan in another file",
        has_plan,
        &[needed("PATH", ArgumentKind::NewPlanFile, "the file, which is replaced if it exists; '.plan.json' is added")],
        |app, values, _| {
            if let Some(path) = values.path(0) {
                app.save_in(path.to_owned(), None);
            }
            Ran::Done
        },
        Some(|app, _| app.ask_where_to_save(None, None)),
    )
    .keys(&[ctrl_shift(Key::S)])
    .menu(Menu::File, 1),
    switch(
        "import-notes",
        "Import notes",
        "Show what was mended or left out when the plan was opened",
        has_notes,
        |app| app.panels.notes,
        |app, is_on| app.panels.notes = is_on,
    )
    .menu(Menu::File, 2),
    command("previous-plan", "Previous plan", "Open the plan above in the list", has_several_plans, |app, _| {
        app.open_neighbour(-1);
    })
    .keys(&[key(Key::PageUp)])
    .menu(Menu::File, 3),
    command("next-plan", "Next plan", "Open the plan below in the list", has_several_plans, |app, _| {
        app.open_neighbour(1);
    })
    .keys(&[key(Key::PageDown)])
    .menu(Menu::File, 3),
    command("close", "Close plan", "Close the plan", has_plan, |app, _| app.request(Intent::Close))
        .keys(&[ctrl(Key::W)])
        .menu(Menu::File, 4),
    command("quit", "Quit", "Close the window", always, |app, _| app.request(Intent::Quit))
        .keys(&[ctrl(Key::Q)])
        .menu(Menu::File, 4),
    // Edit.
    command("undo", "Undo", "Take the last change back", can_undo, |app, _| app.undo())
        .keys(&[ctrl(Key::Z)])
        .menu(Menu::Edit, 0)
        .tool(Icon::Undo, 0),
    command("redo", "Redo", "Do again what was taken back", can_redo, |app, _| app.redo())
        .keys(&[ctrl_shift(Key::Z), ctrl(Key::Y)])
        .menu(Menu::Edit, 0)
        .tool(Icon::Redo, 0),
    command("clear-selection", "Clear selection", "Pick nothing", has_picked, |app, _| app.pick(None))
        .keys(&[key(Key::Escape)])
        .menu(Menu::Edit, 1),
    with(
        "rename-plan",
        "Rename the plan…",
        "Write the plan's name",
        has_plan,
        &[needed("NAME", ArgumentKind::Text, "the plan's name")],
        |app, values, _| {
            app.change_meta("Rename plan", |meta| meta.name = values.text(0).unwrap_or_default().to_owned());
            Ran::Done
        },
        Some(|app, _| {
            let name = app.plan().map(|plan| plan.meta().name.clone()).unwrap_or_default();
            let asking = super::find("rename-plan").map(|command| Palette::asking(command, Vec::new()));
            app.panels.palette = asking.map(|palette| palette.with_text(&name));
        }),
    )
    .menu(Menu::Edit, 2),
    with(
        "set-typology",
        "Typology…",
        "Say what the plan's building is for: its label scheme says what the rooms' functions mean",
        has_plan,
        &[needed("TYPOLOGY", ArgumentKind::Typology, "a typology with a label scheme, or 'unknown'")],
        |app, values, _| {
            app.change_meta("Set typology", |meta| meta.typology = values.typology(0).cloned().flatten());
            Ran::Done
        },
        None,
    )
    .menu(Menu::Edit, 2),
    // Room.
    with(
        "find-room",
        "Find a room…",
        "Pick a room by its name and bring it into sight",
        has_rooms,
        &[ROOM],
        |app, values, _| {
            if let Some(picked) = values.room(0).copied().map(Picked::Room) {
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
    // Predict.
    choose(
        "models-plan",
        "Of the plan",
        "Predict by models of the plan's own typology, inferred where it has none",
        always,
        |app| app.predictor.set.name() == "plan",
        |app, _| app.predict_by_set("plan"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-auto",
        "Inferred",
        "Predict by models of the typology that is inferred from the plan, whatever it says of itself",
        always,
        |app| app.predictor.set.name() == "auto",
        |app, _| app.predict_by_set("auto"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-house",
        "House",
        "Predict by models that learned from houses",
        always,
        |app| app.predictor.set.name() == "house",
        |app, _| app.predict_by_set("house"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-school",
        "School",
        "Predict by models that learned from schools",
        always,
        |app| app.predictor.set.name() == "school",
        |app, _| app.predict_by_set("school"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-office",
        "Office",
        "Predict by models that learned from offices",
        always,
        |app| app.predictor.set.name() == "office",
        |app, _| app.predict_by_set("office"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-standard",
        "Standard",
        "Predict by models that learned from all typologies",
        always,
        |app| app.predictor.set.name() == "standard",
        |app, _| app.predict_by_set("standard"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "predict-by-rules",
        "Rule induction",
        "Predict by rules that can be read",
        always,
        |app| app.predictor.method == Method::Each(Algorithm::Rules),
        |app, _| app.predictor.method = Method::Each(Algorithm::Rules),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-tree",
        "Decision tree",
        "Predict by a decision tree",
        always,
        |app| app.predictor.method == Method::Each(Algorithm::Tree),
        |app, _| app.predictor.method = Method::Each(Algorithm::Tree),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-knn",
        "Nearest neighbours",
        "Predict by the most similar rooms of the training set",
        always,
        |app| app.predictor.method == Method::Each(Algorithm::Knn),
        |app, _| app.predictor.method = Method::Each(Algorithm::Knn),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-mlp",
        "Perceptron",
        "Predict by a multilayer perceptron",
        always,
        |app| app.predictor.method == Method::Each(Algorithm::Mlp),
        |app, _| app.predictor.method = Method::Each(Algorithm::Mlp),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-joint",
        "All rooms together",
        "Predict by a classifier that looks at all rooms of the plan in relation to each other",
        always,
        |app| app.predictor.method == Method::Joint,
        |app, _| app.predictor.method = Method::Joint,
    )
    .menu(Menu::Predict, 1),
    command(
        "accept-prediction",
        "Accept the prediction",
        "Make the predicted label the picked room's own",
        has_prediction,
        |app, _| app.accept_prediction(),
    )
    .keys(&[key(Key::A)])
    .menu(Menu::Predict, 2),
    command(
        "accept-all-predictions",
        "Accept all predictions",
        "Make the predicted labels those of all rooms without a label",
        has_unlabelled,
        |app, _| app.accept_all_predictions(),
    )
    .keys(&[shift(Key::A)])
    .menu(Menu::Predict, 2),
    // View.
    command("fit", "Zoom to fit", "Show the whole plan", has_plan, |app, _| app.canvas.fit())
        .keys(&[key(Key::F)])
        .menu(Menu::View, 0)
        .tool(Icon::Fit, 1),
    command("zoom-to-selection", "Zoom to selection", "Show what is picked as large as fits", has_picked, |app, _| {
        app.zoom_to_picked();
    })
    .keys(&[shift(Key::F)])
    .menu(Menu::View, 0)
    .tool(Icon::ZoomToSelection, 1),
    command("zoom-in", "Zoom in", "Show the plan larger", has_plan, |app, _| app.canvas.zoom_by(ZOOM_STEP))
        .keys(&[key(Key::Plus), key(Key::Equals)])
        .menu(Menu::View, 0),
    command("zoom-out", "Zoom out", "Show the plan smaller", has_plan, |app, _| app.canvas.zoom_by(1.0 / ZOOM_STEP))
        .keys(&[key(Key::Minus)])
        .menu(Menu::View, 0),
    choose(
        "fill-label",
        "Fill by label",
        "Colour each room by its label",
        always,
        |app| app.layers.fill == Fill::Label,
        |app, _| app.layers.fill = Fill::Label,
    )
    .keys(&[key(Key::L)])
    .menu(Menu::View, 1),
    choose(
        "fill-function",
        "Fill by function",
        "Colour each room by what it is for",
        always,
        |app| app.layers.fill == Fill::Function,
        |app, _| app.layers.fill = Fill::Function,
    )
    .keys(&[shift(Key::L)])
    .menu(Menu::View, 1),
    choose(
        "fill-prediction",
        "Fill by prediction",
        "Colour each room by its predicted label; a known label that is another rims its room",
        always,
        |app| app.layers.fill == Fill::Prediction,
        |app, _| app.layers.fill = Fill::Prediction,
    )
    .keys(&[shift(Key::P)])
    .menu(Menu::View, 1),
    choose(
        "fill-none",
        "No fill",
        "Show walls and openings only",
        always,
        |app| app.layers.fill == Fill::None,
        |app, _| app.layers.fill = Fill::None,
    )
    .keys(&[key(Key::K)])
    .menu(Menu::View, 1),
    switch(
        "colour-blind-safe",
        "Colour-blind safe colours",
        "Show labels in five colours that are told apart without seeing red, green or blue",
        always,
        |app| app.layers.colours == LabelColours::ColourBlindSafe,
        |app, is_on| {
            app.layers.colours = if is_on { LabelColours::ColourBlindSafe } else { LabelColours::Standard };
        },
    )
    .menu(Menu::View, 1),
    switch(
        "graph",
        "Graph",
        "Show which rooms the openings join",
        always,
        |app| app.layers.graph,
        |app, is_on| app.layers.graph = is_on,
    )
    .keys(&[key(Key::G)])
    .menu(Menu::View, 2)
    .tool(Icon::Graph, 2),
    switch(
        "names",
        "Names",
        "Show names and areas of rooms",
        always,
        |app| app.layers.names,
        |app, is_on| app.layers.names = is_on,
    )
    .keys(&[key(Key::N)])
    .menu(Menu::View, 2)
    .tool(Icon::Names, 2),
    switch(
        "backdrop",
        "Backdrop",
        "Show the picture under the plan",
        has_backdrop,
        |app| app.layers.backdrop,
        |app, is_on| app.layers.backdrop = is_on,
    )
    .keys(&[key(Key::P)])
    .menu(Menu::View, 2)
    .tool(Icon::Backdrop, 2),
    switch(
        "grid",
        "Grid",
        "Show a grid of whole metres",
        always,
        |app| app.layers.grid,
        |app, is_on| app.layers.grid = is_on,
    )
    .keys(&[shift(Key::G)])
    .menu(Menu::View, 2)
    .tool(Icon::Grid, 2),
    switch(
        "plan-panel",
        "Plans and layers",
        "Show the panel on the left",
        always,
        |app| app.panels.left,
        |app, is_on| app.panels.left = is_on,
    )
    .keys(&[ctrl(Key::Num1)])
    .menu(Menu::View, 3)
    .tool(Icon::Sidebar, 3),
    switch(
        "inspector",
        "Inspector",
        "Show the panel on the right",
        always,
        |app| app.panels.right,
        |app, is_on| app.panels.right = is_on,
    )
    .keys(&[ctrl(Key::Num2)])
    .menu(Menu::View, 3)
    .tool(Icon::Inspector, 3),
    choose(
        "theme-system",
        "Follow the system",
        "Light or dark as the system says",
        always,
        |app| app.theme == ThemeChoice::System,
        |app, context| app.set_theme(ThemeChoice::System, context),
    )
    .menu(Menu::View, 4),
    choose(
        "theme-light",
        "Light",
        "Light, whatever the system says",
        always,
        |app| app.theme == ThemeChoice::Light,
        |app, context| app.set_theme(ThemeChoice::Light, context),
    )
    .menu(Menu::View, 4),
    choose(
        "theme-dark",
        "Dark",
        "Dark, whatever the system says",
        always,
        |app| app.theme == ThemeChoice::Dark,
        |app, context| app.set_theme(ThemeChoice::Dark, context),
    )
    .menu(Menu::View, 4),
    // Help.
    with(
        "commands",
        "Commands…",
        "Find a command by its name and do it",
        always,
        &[],
        |app, _, _| {
            app.panels.palette = Some(Palette::default());
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
            app.panels.sheet = Some(Sheet::default());
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
            app.panels.about = true;
            Ran::Asks
        },
        None,
    )
    .menu(Menu::Help, 3),
    // What the pointer does, for scripts.
    with(
        "pick",
        "Pick a room",
        "Pick a room, as a click on it does: the view stays where it is",
        has_rooms,
        &[ROOM],
        |app, values, _| {
            app.pick(values.room(0).copied().map(Picked::Room));
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
            if let Some(picked) = values.opening(0).copied().map(Picked::Opening) {
                app.pick(Some(picked));
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
            app.pick_towards(match values.word(0) {
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
            let newest = app.messages.len();
            let number = values.count(0).copied().unwrap_or(newest);
            if number > newest {
                return Ran::Refused(format!("there are {newest} messages"));
            }
            app.messages.remove(number - 1);
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
            needed("ANSWER", ArgumentKind::Answer, "the button: save, discard, replace, elsewhere or cancel"),
            optional("PATH", ArgumentKind::NewPlanFile, "the file to save in, where a dialog would ask for it"),
        ],
        |app, values, _| {
            let word = values.word(0).copied().unwrap_or("cancel");
            if app.answer(word, values.path(1).map(Path::to_owned)) { Ran::Done } else { Ran::Asks }
        },
        None,
    ),
];

/// How much a step of zooming changes the size.
const ZOOM_STEP: f64 = 1.25;
