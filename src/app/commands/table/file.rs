//! Opening, saving, closing.

use super::*;
use crate::app::value::{Call, Value};
use crate::edit::storey::Keep;

pub(super) const COMMANDS: &[Command] = &[
    command("new-plan", "New plan", "Start an empty plan", always, |app, _| app.session.new_plan())
        .keys(&[ctrl(Key::N)])
        .menu(Menu::File, 0),
    with(
        "copy-storey",
        "Copy to another storey…",
        "Start a plan of another storey with the same walls and rooms; this storey shows faintly below it",
        has_plan,
        &given2(
            needed("STOREY", TEXT, "the name of the new storey, such as 2 or first floor"),
            optional("KEEP", one_of::<Keep>(), "what rooms keep: functions (default), all or outlines"),
            |app, storey, keep, _| {
                if storey.is_empty() {
                    return Outcome::Refused("the new storey needs a name".to_owned());
                }
                app.session.copy_storey(&storey, keep.unwrap_or(Keep::Functions));
                Outcome::Done
            },
        ),
        None,
    )
    .menu(Menu::File, 0)
    .on(&[On::ListedPlan]),
    with(
        "open",
        "Open…",
        "Open a plan file, or a plan in another format such as GeoJSON or the paper authors' XML",
        always,
        &given2(
            needed("PATH", PLAN_FILE, "a file with a plan, or a folder, whose first plan is opened"),
            optional("STOREY", COUNT, "which plan of the file, from 1"),
            |app, path, storey, _| {
                let storey = storey.map_or(0, |storey| storey - 1);
                opened(app, Origin::File { path, storey })
            },
        ),
        Some(|app, _| app.session.choose_plan()),
    )
    .typed_path()
    .keys(&[ctrl(Key::O)])
    .menu(Menu::File, 0),
    with(
        "open-sample",
        "Open a sample…",
        "Open one of the plans that come with Enfilade",
        always,
        &given1(needed("SAMPLE", SAMPLE, "the sample's file name without the ending"), |app, Sample(sample), _| {
            opened(app, Origin::Bundled(sample))
        }),
        None,
    )
    .menu(Menu::File, 0),
    with(
        "open-recent",
        "Open recent…",
        "Open a recent file",
        has_recent,
        &given1(needed("PATH", RECENT_FILE, "the file"), |app, path, context| {
            app.act_on(Call::new("open", [Value::Path(path)]), context);
            Outcome::Asks
        }),
        Some(|app, _| {
            app.session.look_for_recent();
            app.ask_for_argument(Asked::of("open-recent"));
        }),
    )
    .menu(Menu::File, 0),
    command("clear-recent", "Clear recent files", "Empty the list of recent files", has_recent, |app, _| {
        app.session.forget_recent();
    })
    .menu(Menu::File, 0),
    with(
        "save",
        "Save",
        "Save the plan to its file",
        has_plan,
        &given0(|app, _| if app.session.save(None) { Outcome::Done } else { Outcome::Asks }),
        None,
    )
    .keys(&[ctrl(Key::S)])
    .menu(Menu::File, 1)
    .on(&[On::ListedPlan]),
    with(
        "save-as",
        "Save as…",
        "Save the plan to a new file",
        has_plan,
        &given1(
            needed("PATH", NEW_PLAN_FILE, "the file, which is overwritten if it exists; '.plan.json' is added"),
            |app, path, _| if app.session.save_as(path) { Outcome::Asks } else { Outcome::Done },
        ),
        Some(|app, _| app.session.ask_where_to_save(None, None)),
    )
    .typed_path()
    .keys(&[ctrl_shift(Key::S)])
    .menu(Menu::File, 1)
    .on(&[On::ListedPlan]),
    with(
        "export",
        "Export…",
        "Write the plan as a PDF, picture or drawing for other programs",
        has_plan,
        &given2(
            needed("PATH", NEW_FILE, "the file, whose ending gives the format; an existing file is overwritten"),
            optional("OPTIONS", TEXT, "options of the format as NAME=VALUE, separated by blanks: paper=A3 scale=1:100"),
            |app, path, options, _| {
                let options = options.unwrap_or_default();
                app.session.export(path, &options).map_or_else(Outcome::Refused, |()| Outcome::Done)
            },
        ),
        Some(|app, _| app.open_dialog(dialogs::EXPORT)),
    )
    .keys(&[ctrl(Key::E)])
    .menu(Menu::File, 1)
    .on(&[On::ListedPlan]),
    with(
        "print",
        "Print…",
        "Make a sheet to scale and open it in your PDF viewer to print",
        has_plan,
        &given1(
            needed("OPTIONS", TEXT, "options of the sheet as NAME=VALUE, separated by blanks; 'default' for none"),
            |app, options, _| app.session.print(&options).map_or_else(Outcome::Refused, |()| Outcome::Done),
        ),
        Some(|app, _| app.open_dialog_for(dialogs::EXPORT, Purpose::Print)),
    )
    .keys(&[ctrl(Key::P)])
    .menu(Menu::File, 1),
    with(
        "export-dataset",
        "Export dataset…",
        "Write the labelled rooms of all plans in the open folder as a table, with a description of its columns",
        has_folder,
        &given1(needed("PATH", NEW_FILE, "the table, to which '.csv' is added"), |app, path, _| {
            app.session.export_dataset(path).map_or_else(Outcome::Refused, |()| Outcome::Done)
        }),
        Some(|app, _| app.open_dialog(dialogs::DATASET)),
    )
    .menu(Menu::File, 1),
    switch(
        "recovery",
        "Recover unsaved work",
        "Show unsaved work from earlier sessions, with a picture of each plan",
        has_leftovers,
        |app| app.dialogs.is_open(dialogs::RECOVERY),
        |app, is_on| app.set_dialog(dialogs::RECOVERY, is_on),
    )
    .menu(Menu::File, 2),
    with(
        "recover",
        "Recover",
        "Open unsaved work from an earlier session; no file changes until you save",
        can_recover,
        &given1(needed("NUMBER", COUNT, "which, from the top"), |app, number, _| {
            app.session.recover(number).map_or_else(Outcome::Refused, |()| Outcome::Done)
        }),
        None,
    ),
    with(
        "discard-recovered",
        "Discard what can be recovered",
        "Discard unsaved work from an earlier session, after asking once more",
        has_leftovers,
        &given1(needed("NUMBER", COUNT, "which, from the top"), |app, number, _| {
            app.session.ask_to_discard(number).map_or_else(Outcome::Refused, |()| Outcome::Done)
        }),
        None,
    ),
    switch(
        "differences",
        "Differences to the file",
        "Show how this plan differs from its file, which someone else has changed",
        has_their_plan,
        |app| app.dialogs.is_open(dialogs::DIFFERENCES),
        |app, is_on| app.set_dialog(dialogs::DIFFERENCES, is_on),
    )
    .menu(Menu::File, 2),
    command(
        "load-theirs",
        "Load the file as it is now",
        "Load the version that someone else saved; Undo brings yours back",
        has_their_plan,
        |app, context| app.session.load_theirs(context),
    )
    .menu(Menu::File, 2),
    command(
        "keep-mine",
        "Keep mine",
        "Keep your version; saving overwrites what someone else saved",
        has_theirs,
        |app, context| app.session.keep_mine(context),
    )
    .menu(Menu::File, 2),
    switch(
        "import-notes",
        "Import notes",
        "Show what was repaired or left out when the plan was opened",
        has_notes,
        |app| app.dialogs.is_open(dialogs::NOTES),
        |app, is_on| app.set_dialog(dialogs::NOTES, is_on),
    )
    .menu(Menu::File, 2),
    command("previous-plan", "Previous plan", "Open the plan above in the list", has_several_plans, |app, _| {
        app.session.open_neighbour(-1);
    })
    .menu(Menu::File, 3),
    command("next-plan", "Next plan", "Open the plan below in the list", has_several_plans, |app, _| {
        app.session.open_neighbour(1);
    })
    .menu(Menu::File, 3),
    with(
        "show-plan",
        "Show open plan…",
        "Show another open plan, as you left it",
        // The one in view is among them: a recording names it where a person went back to it.
        has_plan,
        &given1(needed("PLAN", OPEN_PLAN, "its title in the list"), |app, OpenPlanNumber(number), _| {
            app.session.show_open(number);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::File, 3),
    with(
        "next-open",
        "Next open plan",
        "Show the next of the open plans",
        has_several_open,
        &given0(|app, _| shown(app, 1)),
        None,
    )
    .keys(&[ctrl(Key::Tab)])
    .menu(Menu::File, 3),
    with(
        "previous-open",
        "Previous open plan",
        "Show the previous open plan",
        has_several_open,
        &given0(|app, _| shown(app, -1)),
        None,
    )
    .keys(&[ctrl_shift(Key::Tab)])
    .menu(Menu::File, 3),
    with(
        "close",
        "Close plan",
        "Close the plan, after asking if it has unsaved changes",
        has_plan,
        &given1(optional("PLAN", OPEN_PLAN, "its title in the list; without it, the one shown"), |app, plan, _| {
            let shown = app.session.document.as_ref().map(|document| document.number);
            if let Some(number) = plan.map(|OpenPlanNumber(number)| number).or(shown) {
                app.session.close_plan(number);
            }
            Outcome::Done
        }),
        None,
    )
    .keys(&[ctrl(Key::W)])
    .menu(Menu::File, 4)
    .on(&[On::ListedPlan]),
    command("quit", "Quit", "Quit Enfilade", always, |app, _| app.session.request(Intent::QUIT))
        .keys(&[ctrl(Key::Q)])
        .menu(Menu::File, 4),
];

/// Shows the open plan some places after this one, which the session records.
fn shown(app: &mut App, step: isize) -> Outcome {
    app.session.show_next_open(step);
    Outcome::Asks
}

/// Opens a plan; the session records if it shows one that is open.
fn opened(app: &mut App, origin: Origin) -> Outcome {
    if app.session.open(origin) { Outcome::Done } else { Outcome::Asks }
}
