//! Opening, saving, closing.

use super::*;
use crate::app::value::{Call, Value};
use crate::edit::storey::Keep;

pub(super) const COMMANDS: &[Command] = &[
    command("new-plan", "New plan", "Begin a plan on which nothing is drawn yet", always, |app, _| {
        app.session.new_plan()
    })
    .keys(&[ctrl(Key::N)])
    .menu(Menu::File, 0),
    with(
        "copy-storey",
        "Copy to another storey…",
        "Begin a plan of another storey with the same walls and rooms; this one is drawn faintly below it",
        has_plan,
        &given2(
            needed("STOREY", TEXT, "what the new storey is called, as on the drawing: 2, first floor"),
            optional("KEEP", one_of::<Keep>(), "what rooms keep: functions (without), all or outlines"),
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
        "Open a plan: a plan file, the authors' XML, or GeoJSON",
        always,
        &given2(
            needed("PATH", PLAN_FILE, "a file with a plan, or a folder of which the first plan is opened"),
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
        "Open a plan that comes with the program",
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
        "Open a file that was opened or saved before",
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
    command("clear-recent", "Clear recent files", "Forget which files were opened before", has_recent, |app, _| {
        app.session.forget_recent();
    })
    .menu(Menu::File, 0),
    with(
        "save",
        "Save",
        "Save the plan in its file",
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
        "Save the plan in another file",
        has_plan,
        &given1(
            needed("PATH", NEW_PLAN_FILE, "the file, which is replaced if it exists; '.plan.json' is added"),
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
            needed("PATH", NEW_FILE, "the file, whose ending says the format; one that exists is replaced"),
            optional("OPTIONS", TEXT, "options of the format, as NAME=VALUE parted by blanks: paper=A3 scale=1:100"),
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
        "Put the plan on a sheet of paper to scale, and open it in the desktop's viewer, which prints",
        has_plan,
        &given1(
            needed("OPTIONS", TEXT, "options of the sheet, as NAME=VALUE parted by blanks; 'default' for none"),
            |app, options, _| app.session.print(&options).map_or_else(Outcome::Refused, |()| Outcome::Done),
        ),
        Some(|app, _| app.open_dialog_for(dialogs::EXPORT, Purpose::Print)),
    )
    .keys(&[ctrl(Key::P)])
    .menu(Menu::File, 1),
    with(
        "export-dataset",
        "Export dataset…",
        "Write the labelled rooms of all plans in the open folder as a table, with what its columns mean",
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
        "Show what was not saved when Enfilade was ended, with pictures",
        has_leftovers,
        |app| app.dialogs.is_open(dialogs::RECOVERY),
        |app, is_on| app.set_dialog(dialogs::RECOVERY, is_on),
    )
    .menu(Menu::File, 2),
    with(
        "recover",
        "Recover",
        "Open what was not saved when Enfilade was ended; nothing is written until it is saved",
        can_recover,
        &given1(needed("NUMBER", COUNT, "which, from the top"), |app, number, _| {
            app.session.recover(number).map_or_else(Outcome::Refused, |()| Outcome::Done)
        }),
        None,
    ),
    with(
        "discard-recovered",
        "Discard what can be recovered",
        "Give up what was not saved when Enfilade was ended, after asking once more",
        has_leftovers,
        &given1(needed("NUMBER", COUNT, "which, from the top"), |app, number, _| {
            app.session.ask_to_discard(number).map_or_else(Outcome::Refused, |()| Outcome::Done)
        }),
        None,
    ),
    switch(
        "differences",
        "Differences to the file",
        "Show how the plan and its file, which somebody else changed, differ",
        has_their_plan,
        |app| app.dialogs.is_open(dialogs::DIFFERENCES),
        |app, is_on| app.set_dialog(dialogs::DIFFERENCES, is_on),
    )
    .menu(Menu::File, 2),
    command(
        "load-theirs",
        "Load the file as it is now",
        "Make the plan what somebody else put in its file; undo brings yours back",
        has_their_plan,
        |app, context| app.session.load_theirs(context),
    )
    .menu(Menu::File, 2),
    command(
        "keep-mine",
        "Keep mine",
        "Go on with the plan as it is here: saving replaces what somebody else put in its file",
        has_theirs,
        |app, context| app.session.keep_mine(context),
    )
    .menu(Menu::File, 2),
    switch(
        "import-notes",
        "Import notes",
        "Show what was mended or left out when the plan was opened",
        has_notes,
        |app| app.dialogs.is_open(dialogs::NOTES),
        |app, is_on| app.set_dialog(dialogs::NOTES, is_on),
    )
    .menu(Menu::File, 2),
    command("previous-plan", "Previous plan", "Open the plan above in the list", has_several_plans, |app, _| {
        app.session.open_neighbour(-1);
    })
    .keys(&[key(Key::PageUp)])
    .menu(Menu::File, 3),
    command("next-plan", "Next plan", "Open the plan below in the list", has_several_plans, |app, _| {
        app.session.open_neighbour(1);
    })
    .keys(&[key(Key::PageDown)])
    .menu(Menu::File, 3),
    with(
        "show-plan",
        "Show open plan…",
        "Show another of the open plans, as it was left",
        has_several_open,
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
        "Show the open plan before this one",
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
        &given1(optional("PLAN", OPEN_PLAN, "its title in the list; without, the one shown"), |app, plan, _| {
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
    command("quit", "Quit", "Close the window", always, |app, _| app.session.request(Intent::QUIT))
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
