//! Predictions.

use super::*;

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
];
