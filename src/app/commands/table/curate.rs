//! The dashboard, training, and label schemes.

use super::*;
use crate::app::session::training::Wish;
use crate::chart::rooms::ChartKind;
use crate::classify::Algorithm;
use crate::labels::Typology;

pub(super) const COMMANDS: &[Command] = &[
    switch(
        "dashboard",
        "Dashboard…",
        "Show what the labelled rooms at hand are like, how well a classifier tells them, and what changed",
        always,
        |app| app.dialogs.is_open(dialogs::DASHBOARD),
        |app, is_on| app.set_dialog(dialogs::DASHBOARD, is_on),
    )
    .menu(Menu::Dataset, 2),
    with(
        "export-chart",
        "Export a chart",
        "Write a chart of the dashboard as a picture, a drawing or a table",
        has_rooms_at_hand,
        &given3(
            needed("CHART", one_of::<ChartKind>(), "which"),
            needed("PATH", NEW_FILE, "the file, whose ending gives the format: .png, .svg or .csv"),
            optional("OPTIONS", TEXT, "NAME=VALUE, separated by blanks: set=school across=a up=d"),
            |app, kind, path, options, _| {
                let options = options.unwrap_or_default();
                app.session.export_chart(kind, &path, &options).map_or_else(Outcome::Refused, |()| Outcome::Done)
            },
        ),
        None,
    ),
    with(
        "measure-accuracy",
        "Measure the accuracy",
        "Train a classifier on some buildings and test it on the others, for the dashboard's charts",
        has_rooms_at_hand,
        &given2(
            needed("SET", TEXT, "a typology, or 'standard' for all rooms"),
            needed("ALGORITHM", TEXT, "which classifier: rules, tree, knn or mlp"),
            |app, set, algorithm, _| match algorithm.parse::<Algorithm>() {
                Ok(algorithm) => {
                    app.session.measure(&set, algorithm);
                    Outcome::Done
                }
                Err(error) => Outcome::Refused(error.to_string()),
            },
        ),
        None,
    ),
    with(
        "train",
        "Train models…",
        "Train models on the labelled rooms of plans, test them, and predict with them",
        always,
        &given2(
            needed("DATA", TEXT, "a folder of plans, or a dataset (.csv); empty for the open plans"),
            optional(
                "OPTIONS",
                TEXT,
                "NAME=VALUE, separated by blanks: algorithm=tree typology=school by=building folds=10 neighbours=predicted",
            ),
            |app, data, options, _| {
                let wish = match Wish::read(&options.unwrap_or_default()) {
                    Ok(wish) => wish,
                    Err(wrong) => return Outcome::Refused(wrong),
                };
                let source = app.session.source_of(&data);
                app.session.read_rooms(source.clone(), false);
                app.session.train_when_read(source, wish).map_or_else(Outcome::Refused, |()| Outcome::Done)
            },
        ),
        Some(|app, _| app.open_dialog(dialogs::TRAINING)),
    )
    .menu(Menu::Dataset, 2),
    command(
        "stop-training",
        "Stop the training",
        "Give up the training; nothing of it is kept",
        is_training,
        |app, _| app.session.cancel_training(),
    )
    .menu(Menu::Dataset, 2),
    with(
        "keep-models",
        "Keep the trained models",
        "Write the models trained last into a folder, where they are found from now on",
        has_trained,
        &given3(
            needed("NAME", TEXT, "what they are called; several get their typology and method behind it"),
            needed("FOLDER", NEW_FILE, "the folder"),
            optional("DEFAULT", ON_OR_OFF, "on: they predict the plans of their typology from now on"),
            |app, name, folder, default, _| {
                let kept = app.session.keep_trained(&name, &folder, default.unwrap_or(false));
                kept.map_or_else(Outcome::Refused, |()| Outcome::Done)
            },
        ),
        None,
    ),
    switch(
        "schemes",
        "Label schemes…",
        "Edit which function of a room means which label, and add typologies",
        always,
        |app| app.dialogs.is_open(dialogs::SCHEMES),
        |app, is_on| app.set_dialog(dialogs::SCHEMES, is_on),
    )
    .menu(Menu::Dataset, 2),
    with(
        "save-scheme",
        "Change a label scheme",
        "Change which functions of a typology mean which label, and save it among your own schemes",
        always,
        &given2(
            needed("TYPOLOGY", TEXT, "the typology; a new one is added"),
            needed(
                "CHANGES",
                TEXT,
                "FUNCTION=LABEL, separated by semicolons; a label is S, M, B, C or H, '-' leaves rooms unclassified, \
                 '?' takes the function out, '#ffd27f' gives it a colour",
            ),
            |app, typology, changes, _| {
                let Some(typology) = Typology::new(&typology) else {
                    return Outcome::Refused("the typology needs a name".to_owned());
                };
                app.session.save_scheme(&typology, &changes).map_or_else(Outcome::Refused, |()| Outcome::Done)
            },
        ),
        None,
    ),
];

fn has_rooms_at_hand(app: &App) -> Availability {
    when(app.session.at_hand.read.is_some(), "open the dashboard first")
}

fn is_training(app: &App) -> Availability {
    when(app.session.training.is_running(), "no model is being trained")
}

fn has_trained(app: &App) -> Availability {
    when(!app.session.training.reports.is_empty(), "train a model first")
}
