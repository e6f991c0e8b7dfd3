//! Predictions.

use super::*;

use crate::app::session::live::NEIGHBOURS;
use crate::app::session::live::WhatIf;
use crate::classify::Method;
use crate::features::Features;
use crate::pipeline::SecondOpinion;

fn has_what_if(app: &App) -> Availability {
    has_plan(app)?;
    app.session.tried().map(|_| ()).map_err(|_| "pick a room that is classified first")
}

/// The feature with a name.
fn feature(word: &str) -> Result<usize, Outcome> {
    let names = Features::NAMES.join(", ");
    Features::index(word).ok_or_else(|| Outcome::Refused(format!("there is no feature '{word}'; they are {names}")))
}

fn method(word: &str) -> Result<Method, Outcome> {
    word.parse().map_err(|_| {
        let names: Vec<&str> = Method::ALL.iter().map(|method| method.name()).collect();
        Outcome::Refused(format!("there is no method '{word}'; they are {}", names.join(", ")))
    })
}

impl App {
    fn set_second_opinion(&mut self, word: &str, neighbours: Option<String>) -> Outcome {
        if word == "none" {
            self.session.live.second = None;
            return Outcome::Done;
        }
        let method = match method(word) {
            Ok(method) => method,
            Err(refused) => return refused,
        };
        let wanted = neighbours.as_deref().unwrap_or("trained");
        let Some((_, neighbours)) = NEIGHBOURS.iter().find(|(word, _)| *word == wanted) else {
            return Outcome::Refused(format!("expected trained, true, temporary or predicted, not '{wanted}'"));
        };
        self.session.live.second = Some(SecondOpinion { method, neighbours: *neighbours });
        self.panels.set_shown(panels::LIVE, true);
        Outcome::Done
    }

    fn set_what_if(&mut self, name: &str, value: &str) -> Outcome {
        let index = match feature(name) {
            Ok(index) => index,
            Err(refused) => return refused,
        };
        match value.parse::<f64>().ok().filter(|value| value.is_finite()) {
            Some(value) => {
                self.panels.set_shown(panels::WHAT_IF, true);
                self.session.try_feature(index, value);
                Outcome::Done
            }
            None => Outcome::Refused(format!("'{value}' is no number")),
        }
    }

    fn set_regions(&mut self, across: &str, up: &str) -> Outcome {
        match (feature(across), feature(up)) {
            (Ok(across), Ok(up)) if across != up => {
                self.panels.set_shown(panels::WHAT_IF, true);
                self.session.live.what_if.axes = [across, up];
                Outcome::Done
            }
            (Ok(_), Ok(_)) => Outcome::Refused("choose two different features".to_owned()),
            (Err(refused), _) | (_, Err(refused)) => refused,
        }
    }
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "models",
        "Models…",
        "Choose the models that predict: those for the plan's typology, for another, or your own",
        always,
        &given1(
            needed(
                "MODELS",
                MODEL_SET,
                "'plan' (as set for it), 'auto' (inferred from it), a typology, 'standard' \
                                         (any kind of building), or a model's name",
            ),
            |app, set, _| {
                app.session.predictor.set = set;
                Outcome::Done
            },
        ),
        None,
    )
    .menu(Menu::Predict, 0),
    with(
        "predict-by",
        "Predict by…",
        "Choose the method that predicts",
        always,
        &given1(
            needed(
                "ALGORITHM",
                METHOD,
                "a method: 'blend' takes the mean of several models, 'joint' compares all rooms of the plan, \
                 the others look at each room by itself",
            ),
            |app, method, _| {
                app.session.predictor.method = method;
                Outcome::Done
            },
        ),
        None,
    )
    .menu(Menu::Predict, 1),
    command(
        "accept-prediction",
        "Accept the prediction",
        "Give the selected rooms their predicted labels",
        has_prediction,
        |app, _| app.session.accept_prediction(),
    )
    .keys(&[key(Key::A)])
    .menu(Menu::Predict, 2)
    .on(&[On::Room, On::Several]),
    command(
        "accept-all-predictions",
        "Accept all predictions",
        "Give all rooms without a label their predicted labels",
        has_unlabelled,
        |app, _| app.session.accept_all_predictions(),
    )
    .keys(&[shift(Key::A)])
    .menu(Menu::Predict, 2),
    with(
        "accept-above",
        "Accept the sure predictions…",
        "Give the rooms without a label their predicted labels where these are so sure",
        has_unlabelled,
        &given1(needed("SURE", PERCENT, "how sure at least"), |app, percent, _| {
            app.session.accept_those(None, percent / 100.0);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Predict, 2),
    with(
        "accept-label",
        "Accept all of a label…",
        "Give the rooms without a label that are predicted to have this label that label",
        has_unlabelled,
        &given1(needed("LABEL", one_of::<Label>(), "the label"), |app, label, _| {
            app.session.accept_those(Some(label), 0.0);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Predict, 2),
    with(
        "accept-threshold",
        "Sure predictions",
        "Set from when on a prediction counts as sure in the panel of live labels",
        always,
        &given1(needed("SURE", PERCENT, "how sure at least"), |app, percent, _| {
            app.session.live.least = percent / 100.0;
            Outcome::Done
        }),
        None,
    ),
    switch(
        "live-labels",
        "Live labels",
        "Show the predicted labels as they follow every edit, accept several, and compare two methods",
        always,
        |app| app.panels.is_shown(panels::LIVE),
        |app, is_on| app.set_panel(panels::LIVE, is_on),
    )
    .menu(Menu::Predict, 3),
    with(
        "second-opinion",
        "Second opinion…",
        "Show what another method says beside the first, or none",
        always,
        &given2(
            needed("METHOD", TEXT, "a method, or 'none'"),
            optional(
                "NEIGHBOURS",
                TEXT,
                "which labels of neighbours count: 'trained' (as in the model's training), 'true', 'temporary' or 'predicted'",
            ),
            |app, word, neighbours, _| app.set_second_opinion(&word, neighbours),
        ),
        None,
    )
    .menu(Menu::Predict, 3),
    switch(
        "what-if-panel",
        "What if",
        "Show how the label of the picked room would change with its features, and the regions of the labels",
        always,
        |app| app.panels.is_shown(panels::WHAT_IF),
        |app, is_on| app.set_panel(panels::WHAT_IF, is_on),
    )
    .menu(Menu::Predict, 3),
    with(
        "what-if",
        "Try a feature",
        "Show which label the picked room would get with another value of a feature; the plan stays as it is",
        has_what_if,
        &given2(
            needed("FEATURE", TEXT, "a, rt, d, l_S, l_M, l_B, l_C or l_H"),
            needed("VALUE", TEXT, "its value"),
            |app, name, value, _| app.set_what_if(&name, &value),
        ),
        None,
    ),
    with(
        "what-if-reset",
        "Features as they are",
        "Forget the tried values of features",
        has_what_if,
        &given0(|app, _| {
            app.session.live.what_if.changed = None;
            Outcome::Done
        }),
        None,
    ),
    with(
        "what-if-by",
        "Try by another method",
        "Choose the method that answers what-if: one that looks at each room by itself",
        always,
        &given1(needed("METHOD", TEXT, "rules, tree, knn or mlp"), |app, word, _| match method(&word) {
            Ok(method @ Method::Each(_)) => {
                app.session.live.what_if = WhatIf { method: Some(method), ..app.session.live.what_if.clone() };
                Outcome::Done
            }
            Ok(method) => Outcome::Refused(format!("the {} looks at all rooms together", method.title())),
            Err(refused) => refused,
        }),
        None,
    ),
    with(
        "regions",
        "Regions over two features",
        "Choose the features of the picture of the labels' regions",
        always,
        &given2(
            needed("ACROSS", TEXT, "a, rt, d, l_S, l_M, l_B, l_C or l_H"),
            needed("UP", TEXT, "another of them"),
            |app, across, up, _| app.set_regions(&across, &up),
        ),
        None,
    ),
];
