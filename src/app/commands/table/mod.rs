//! The table itself: one file per menu, and helpers for the entries.

mod curate;
mod dataset;
mod draw;
mod edit;
mod file;
mod help;
mod modify;
mod picture;
mod predict;
mod review;
mod robot;
mod room;
mod script;
mod view;

use crate::app::session::origin::Origin;
use std::sync::LazyLock;

use egui::{Context, Key, KeyboardShortcut, Modifiers};

use super::given::*;
use super::{Action, Argument, Availability, Command, Menu, On, Outcome};
use crate::app::look::{icons::Icon, theme::ThemeChoice};
use crate::app::session::{fields::FieldKind, questions::Intent, selection::SelectMode, settings::GRID_RANGE_M};
use crate::app::state::{App, Asked, Purpose, dialogs, panels};
use crate::app::tools::{self, Entry, Group, TOOLS};
use crate::app::value::{Boxed, Direction, Space, Worded, switch_word};
use crate::base::units::Units;
use crate::draw::{Fill, LabelColours};
use crate::edit::EditError;
use crate::features::RoomStatus;
use crate::geometry::{Bounds, Point, Segment, Vector, polygon, trim_m};
use crate::labels::{Label, normalised_function};
use crate::plan::{ElementId, OpeningKind, Plan, RoomId};

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
    Command {
        id,
        title,
        help,
        arguments: &[],
        shortcuts: &[],
        menu: None,
        on: &[],
        tool: None,
        strip: None,
        types_path: false,
        availability,
        complete_availability: None,
        action,
    }
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

const SWITCH: &[Argument] = &[optional("SWITCH", ON_OR_OFF, "on or off; without it, switches over").argument()];

/// A command that turns something on or off.
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

/// A command that chooses one of several alternatives.
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

/// A command that activates a tool: everything except availability is declared in the tool's own file.
const fn tool(tool: &'static Entry, availability: fn(&App) -> Availability) -> Command {
    entry(tool.id, tool.title, tool.help, availability, Action::TakeUp(tool)).keys(tool.keys)
}

/// The commands of the tools in the strip, by group.
fn tools_of_the_strip() -> Vec<Command> {
    let mut tools: Vec<(Group, Command)> = TOOLS
        .iter()
        .filter_map(|entry| {
            let (icon, group) = entry.strip?;
            let section = match group {
                Group::Select | Group::Draw | Group::Divide => 0,
                Group::Openings => 1,
                Group::Measure => 2,
            };
            let on: &[On] = match group {
                Group::Draw => &[On::Picture, On::FreeSpace],
                Group::Openings => &[On::Wall],
                Group::Divide => &[On::Room],
                Group::Select | Group::Measure => &[],
            };
            Some((group, tool(entry, has_plan).menu(Menu::Draw, section).on(on).strip(icon, group as u8)))
        })
        .collect();
    tools.sort_by_key(|(group, _)| *group);
    tools.into_iter().map(|(_, command)| command).collect()
}

/// A command with arguments, see [`given`](super::given); `ask` or the palette asks for missing ones.
const fn with<const N: usize, G, F>(
    id: &'static str,
    title: &'static str,
    help: &'static str,
    availability: fn(&App) -> Availability,
    given: &'static Given<N, G, F>,
    ask: Option<fn(&mut App, &Context)>,
) -> Command
where
    Given<N, G, F>: Run,
{
    entry(id, title, help, availability, Action::With { run: given, ask, is_on: None }).takes(&given.arguments)
}

impl Command {
    const fn takes(self, arguments: &'static [Argument]) -> Self {
        Self { arguments, ..self }
    }

    /// With all its arguments given, it is available under this weaker condition.
    const fn when_complete(self, availability: fn(&App) -> Availability) -> Self {
        Self { complete_availability: Some(availability), ..self }
    }

    /// Marks it as one of several alternatives, with its state.
    const fn shown_on(self, is_on: fn(&App) -> bool) -> Self {
        match self.action {
            Action::With { run, ask, .. } => Self { action: Action::With { run, ask, is_on: Some(is_on) }, ..self },
            _ => self,
        }
    }

    const fn keys(self, shortcuts: &'static [KeyboardShortcut]) -> Self {
        Self { shortcuts, ..self }
    }

    const fn menu(self, menu: Menu, section: u8) -> Self {
        Self { menu: Some((menu, section)), ..self }
    }

    /// Adds it to the context menus of things.
    const fn on(self, on: &'static [On]) -> Self {
        Self { on, ..self }
    }

    /// Adds it to the strip of tools.
    const fn strip(self, icon: Icon, group: u8) -> Self {
        Self { strip: Some((icon, group)), ..self }
    }

    /// The palette lets its path be typed.
    const fn typed_path(self) -> Self {
        Self { types_path: true, ..self }
    }

    const fn tool(self, icon: Icon, group: u8) -> Self {
        Self { tool: Some((icon, group)), ..self }
    }
}

// When commands are available.

fn always(_: &App) -> Availability {
    Ok(())
}

/// `Ok` if the condition holds, otherwise what to do first.
fn when(holds: bool, otherwise: &'static str) -> Availability {
    if holds { Ok(()) } else { Err(otherwise) }
}

fn has_plan(app: &App) -> Availability {
    when(app.session.document.is_some(), "open a plan first")
}

fn has_folder(app: &App) -> Availability {
    when(app.session.dataset_source().is_some(), "open a plan of a folder first")
}

fn has_findings(app: &App) -> Availability {
    has_plan(app)?;
    let Some(checked) = app.session.findings() else { return Err("the plan is still being checked") };
    when(!checked.open.is_empty() || !checked.ignored.is_empty(), "there are no findings")
}

fn has_picked(app: &App) -> Availability {
    has_plan(app)?;
    when(!app.session.selection.is_empty(), "select something first")
}

fn can_clear(app: &App) -> Availability {
    when(!app.session.selection.is_empty() || !app.tools.is_selecting(), "nothing is selected")
}

fn has_room(app: &App) -> Availability {
    has_plan(app)?;
    when(matches!(app.picked(), Some(ElementId::Room(_))), "select a room first")
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
    let can = app.session.document.as_ref().is_some_and(|document| document.history.can_undo());
    when(can || app.tools.tool().is_busy(), "there is nothing to undo")
}

fn can_redo(app: &App) -> Availability {
    has_plan(app)?;
    let can = app.session.document.as_ref().is_some_and(|document| document.history.can_redo());
    when(can, "nothing was undone")
}

/// Rooms are selected, or there is one under the pointer.
fn has_target(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.target(None).is_some(), "select a room first, or point at one")
}

fn has_own_label(app: &App) -> Availability {
    has_target(app)?;
    let Some((plan, target)) = app.plan().zip(app.session.target(None)) else { return Ok(()) };
    let has = target.rooms.iter().any(|&room| plan.room(room).is_some_and(|room| room.label.is_some()));
    when(has, "the room has no label of its own")
}

fn has_proposed_function(app: &App) -> Availability {
    has_target(app)?;
    let target = app.session.target(None);
    let proposed = target.map(|target| app.session.proposed_functions(&target.rooms)).unwrap_or_default();
    when(!proposed.is_empty(), "no room without a function has a name that says what it is for")
}

fn has_prediction(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.selection.rooms().next().is_some(), "select a room first")?;
    when(!app.session.predictions_of_selected().is_empty(), "the room is not one that is predicted")
}

fn has_unlabelled(app: &App) -> Availability {
    has_plan(app)?;
    let has =
        app.predictions().is_some_and(|predictions| predictions.network.rooms.iter().any(|room| room.label.is_none()));
    when(has, "every room has a label")
}

fn has_other_panels(app: &App) -> Availability {
    when(app.panels.others().next().is_some(), "every panel has a command of its own")
}

fn has_several_plans(app: &App) -> Availability {
    when(app.session.list.len() > 1, "there is only one plan in the list")
}

fn has_several_open(app: &App) -> Availability {
    when(app.session.has_several_open(), "only one plan is open")
}

fn has_recent(app: &App) -> Availability {
    when(!app.session.settings.recent().is_empty(), "there are no recent files")
}

fn is_asked_for_file(app: &App) -> Availability {
    when(app.session.typed_for.is_some(), "no file is needed now")
}

fn has_backdrop(app: &App) -> Availability {
    has_plan(app)?;
    let has = app.plan().is_some_and(|plan| plan.backdrop().is_some());
    when(has, "the plan has no picture under it")
}

fn has_notes(app: &App) -> Availability {
    has_plan(app)?;
    let has = app.session.document.as_ref().is_some_and(|document| !document.notes.is_empty());
    when(has, "nothing was mended or left out when the plan was opened")
}

fn has_leftovers(app: &App) -> Availability {
    when(!app.session.safety.leftovers.is_empty(), "nothing was left unsaved")
}

fn can_recover(app: &App) -> Availability {
    has_leftovers(app)?;
    when(!app.is_recording(), "end the recording first")
}

fn has_theirs(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.safety.own.theirs.is_some(), "nobody else has changed the plan's file")
}

fn has_their_plan(app: &App) -> Availability {
    has_theirs(app)?;
    when(app.session.their_plan().is_some(), "what is in the file is no plan")
}

fn has_messages(app: &App) -> Availability {
    when(!app.session.shown_messages().is_empty(), "there is no message")
}

fn can_record(app: &App) -> Availability {
    // A script starts from the contents of a file.
    when(
        app.is_recording() || !app.has_unsaved_changes(),
        "save the plan first: a script starts from what is in its file",
    )?;
    when(app.is_recording() || !app.session.has_several_open(), "close the other plans first: a script starts with one")
}

fn has_changed_keys(app: &App) -> Availability {
    when(app.session.settings.is_any_changed(), "no shortcut was changed")
}

fn is_asked(app: &App) -> Availability {
    when(app.session.question.is_some(), "nothing is asked")
}

/// The half side of the drawing area in metres: no plan has coordinates beyond it.
const FAR_M: f64 = 1e6;

const X: Arg<f64> = needed("X", coordinate(-FAR_M, FAR_M), "to the right, in metres");
const Y: Arg<f64> = needed("Y", coordinate(-FAR_M, FAR_M), "up, in metres");
const WIDTH: Arg<f64> = needed("WIDTH", coordinate(0.001, FAR_M), "how wide, in metres");
const HEIGHT: Arg<f64> = needed("HEIGHT", coordinate(0.001, FAR_M), "how high, in metres");
const SCALE: Arg<f64> = needed("SCALE", number(" of pixels to the metre", 0.001, 1e5), "pixels per metre");

const ROOM: Arg<RoomId> = needed("ROOM", A_ROOM, "a room's name, or its id if several rooms have the name");

/// The zoom factor of one step.
const ZOOM_STEP: f64 = 1.25;

/// Every command, in menu order. Each menu is a file; the tools' commands come from the tools.
pub static COMMANDS: LazyLock<Vec<Command>> = LazyLock::new(|| {
    let tools = tools_of_the_strip();
    let parts: [&[Command]; 15] = [
        file::COMMANDS,
        edit::COMMANDS,
        &tools,
        draw::COMMANDS,
        modify::COMMANDS,
        room::COMMANDS,
        picture::COMMANDS,
        predict::COMMANDS,
        dataset::COMMANDS,
        curate::COMMANDS,
        review::COMMANDS,
        robot::COMMANDS,
        view::COMMANDS,
        help::COMMANDS,
        script::COMMANDS,
    ];
    parts.concat()
});
