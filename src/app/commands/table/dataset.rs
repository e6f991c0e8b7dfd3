//! Folders of plans, and buildings of several storeys.

use super::*;
use crate::app::session::workspace::shows::Shows;
use crate::labels::Typology;
use crate::workspace::change::Change;
use crate::workspace::query::{Order, PlanColumn, RoomColumn};

fn has_workspace(app: &App) -> Availability {
    when(app.session.workspace.is_some(), "open a folder of plans first")
}

fn has_storey_below(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.ghost_plan().is_some(), "show a storey below first")
}

fn can_go_up_or_down(app: &App) -> Availability {
    when(!app.session.storeys().is_empty() || app.session.list.len() > 1, "there is only one plan in the list")
}

fn can_undo_change(app: &App) -> Availability {
    has_workspace(app)?;
    let has = app.session.workspace.as_ref().is_some_and(|workspace| workspace.changed.is_some());
    when(has, "no files were changed together")
}

fn done(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Refused, |()| Outcome::Done)
}

/// 'label hall', 'label by-function', 'function office', 'building North', 'typology school', 'typology unknown'.
fn change_of(word: &str) -> Option<Change> {
    let word = word.trim();
    let (what, value) = word.split_once(' ').unwrap_or((word, ""));
    match (what, value.trim()) {
        ("building", name) => Some(Change::Building(name.to_owned())),
        ("typology", "unknown") => Some(Change::Typology(None)),
        ("typology", name) => Typology::new(name).map(|typology| Change::Typology(Some(typology))),
        ("function", function) => Some(Change::Function(function.to_owned())),
        ("label", "by-function") => Some(Change::Label(None)),
        ("label", label) => {
            let short = Label::ALL.into_iter().find(|it| it.name().strip_suffix(" room") == Some(label));
            short.or_else(|| label.parse().ok()).map(|label| Change::Label(Some(label)))
        }
        _ => None,
    }
}

fn sort(app: &mut App, column: &str, is_descending: bool) -> Outcome {
    let Some(workspace) = &mut app.session.workspace else { return Outcome::Done };
    let view = &mut workspace.view;
    let words = if view.shows == Shows::Rooms {
        if let Some(by) = RoomColumn::of_word(column) {
            view.room_order = Order { by, is_descending };
            return Outcome::Done;
        }
        RoomColumn::ALL.iter().map(|column| column.word()).collect::<Vec<_>>()
    } else {
        if let Some(by) = PlanColumn::of_word(column) {
            view.plan_order = Order { by, is_descending };
            return Outcome::Done;
        }
        PlanColumn::ALL.iter().map(|column| column.word()).collect()
    };
    Outcome::Refused(format!("there is no column '{column}': use {}", crate::base::wording::or_list(&words)))
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "open-workspace",
        "Open a folder of plans…",
        "Show all plans and rooms of a folder as a table; the folder is read in the background and nothing is written to it",
        always,
        &given1(needed("PATH", PLAN_FILE, "a folder of plans, or a file in it"), |app, path, _| {
            app.session.open_workspace(&path);
            app.set_dialog(dialogs::WORKSPACE, true);
            Outcome::Done
        }),
        Some(|app, _| app.session.choose_workspace()),
    )
    .typed_path()
    .keys(&[ctrl_shift(Key::O)])
    .menu(Menu::Dataset, 0),
    switch(
        "workspace",
        "Plans and rooms of the folder",
        "Show the open folder of plans: all its plans and rooms, to search, sort, open and change together",
        always,
        |app| app.dialogs.is_open(dialogs::WORKSPACE),
        |app, is_on| app.set_dialog(dialogs::WORKSPACE, is_on),
    )
    .keys(&[ctrl_shift(Key::L)])
    .menu(Menu::Dataset, 0),
    command(
        "read-workspace-again",
        "Read the folder again",
        "Look for plans of the folder that are new, gone or changed",
        has_workspace,
        |app, _| {
            let folder = app.session.workspace.as_ref().map(|workspace| workspace.now.folder().to_owned());
            if let Some(folder) = folder {
                app.session.open_workspace(&folder);
            }
        },
    )
    .menu(Menu::Dataset, 0),
    command(
        "undo-workspace-change",
        "Undo the change of many files",
        "Put the files that were changed together back as before, where nobody has changed them since",
        can_undo_change,
        |app, _| {
            if let Err(what) = app.session.undo_in_workspace() {
                app.session.status = crate::base::wording::sentence(&what);
            }
        },
    )
    .menu(Menu::Dataset, 0),
    command("close-workspace", "Close the folder", "Leave the open folder of plans", has_workspace, |app, _| {
        app.session.close_workspace();
        app.set_dialog(dialogs::WORKSPACE, false);
    })
    .menu(Menu::Dataset, 0),
    command(
        "storey-up",
        "Storey above",
        "Open the next storey up of this building, with this one faintly below; of a plan without other storeys, the plan \
         above in the list",
        can_go_up_or_down,
        |app, _| {
            if !app.session.show_storey(1) {
                app.session.open_neighbour(-1);
            }
        },
    )
    .keys(&[key(Key::PageUp)])
    .menu(Menu::Dataset, 1),
    command(
        "storey-down",
        "Storey below",
        "Open the next storey down of this building; of a plan without other storeys, the plan below in the list",
        can_go_up_or_down,
        |app, _| {
            if !app.session.show_storey(-1) {
                app.session.open_neighbour(1);
            }
        },
    )
    .keys(&[key(Key::PageDown)])
    .menu(Menu::Dataset, 1),
    with(
        "lay-over-storey",
        "Lay over the storey below",
        "Move and turn the plan so that its stairs and lifts lie over those of the storey below",
        has_storey_below,
        &given1(
            optional("POINTS", points(4), "two points of this plan, and the same two points of the storey below"),
            |app, points, _| match points.as_deref() {
                None => done(app.session.lay_over_storey_below(None)),
                Some([a, b, p, q]) => done(app.session.lay_over_storey_below(Some([*a, *b, *p, *q]))),
                Some(_) => Outcome::Refused("give two points of this plan and two of the storey below".to_owned()),
            },
        ),
        None,
    )
    .menu(Menu::Dataset, 1),
    tool(&tools::COMMON_POINTS, has_storey_below).menu(Menu::Dataset, 1),
    with(
        "workspace-show",
        "Show the folder as…",
        "Show the open folder as a list of plans, as pictures, or as a table of all rooms",
        has_workspace,
        &given1(needed("HOW", one_of::<Shows>(), "plans, grid or rooms"), |app, shows, _| {
            if let Some(workspace) = &mut app.session.workspace {
                workspace.view.show(shows);
            }
            Outcome::Done
        }),
        None,
    ),
    with(
        "workspace-find",
        "Search the folder…",
        "Show only plans and rooms with these words",
        has_workspace,
        &given1(
            needed("TEXT", TEXT, "words of a function, name, label, plan, building or typology; function:office in one"),
            |app, text, _| {
                if let Some(workspace) = &mut app.session.workspace {
                    workspace.view.query.text = text;
                }
                Outcome::Done
            },
        ),
        None,
    ),
    with(
        "workspace-sort",
        "Sort the folder…",
        "Sort the plans or rooms by a column",
        has_workspace,
        &given2(
            needed("COLUMN", TEXT, "a column of the table, such as name, rooms, labelled or label"),
            optional("DESCENDING", ON_OR_OFF, "on for the largest first"),
            |app, column, is_descending, _| sort(app, &column, is_descending.unwrap_or(false)),
        ),
        None,
    ),
    with(
        "workspace-change",
        "Change what is selected in the folder…",
        "Change all plans or rooms that are selected in the table",
        has_workspace,
        &given1(
            needed(
                "CHANGE",
                TEXT,
                "'label hall', 'label by-function', 'function meeting room', 'building North', 'typology school'",
            ),
            |app, word, _| match change_of(&word) {
                Some(change) => done(app.session.change_in_workspace(&change)),
                None => Outcome::Refused(format!("'{word}' is no change")),
            },
        ),
        None,
    ),
];
