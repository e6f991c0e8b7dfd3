//! Predictions.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    with(
        "models",
        "Models…",
        "Say which models predict: those of the plan's typology, of another, or one of your own",
        always,
        &given1(
            needed("MODELS", MODEL_SET, "'plan', 'auto' (inferred), a typology, 'standard', or a model's name"),
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
        "Say by which algorithm is predicted",
        always,
        &given1(
            needed("ALGORITHM", METHOD, "an algorithm, or 'joint' for all rooms of the plan together"),
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
        "Make the predicted labels the selected rooms' own",
        has_prediction,
        |app, _| app.session.accept_prediction(),
    )
    .keys(&[key(Key::A)])
    .menu(Menu::Predict, 2)
    .on(&[On::Room, On::Several]),
    command(
        "accept-all-predictions",
        "Accept all predictions",
        "Make the predicted labels those of all rooms without a label",
        has_unlabelled,
        |app, _| app.session.accept_all_predictions(),
    )
    .keys(&[shift(Key::A)])
    .menu(Menu::Predict, 2),
];
