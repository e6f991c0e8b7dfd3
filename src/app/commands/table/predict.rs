//! What classifiers say.

use super::*;

pub(super) const COMMANDS: &[Command] = &[
    choose(
        "models-plan",
        "Of the plan",
        "Predict by models of the plan's own typology, inferred where it has none",
        always,
        |app| app.session.predictor.set.name() == "plan",
        |app, _| app.session.predict_by_set("plan"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-auto",
        "Inferred",
        "Predict by models of the typology that is inferred from the plan, whatever it says of itself",
        always,
        |app| app.session.predictor.set.name() == "auto",
        |app, _| app.session.predict_by_set("auto"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-house",
        "House",
        "Predict by models that learned from houses",
        always,
        |app| app.session.predictor.set.name() == "house",
        |app, _| app.session.predict_by_set("house"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-school",
        "School",
        "Predict by models that learned from schools",
        always,
        |app| app.session.predictor.set.name() == "school",
        |app, _| app.session.predict_by_set("school"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-office",
        "Office",
        "Predict by models that learned from offices",
        always,
        |app| app.session.predictor.set.name() == "office",
        |app, _| app.session.predict_by_set("office"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "models-standard",
        "Standard",
        "Predict by models that learned from all typologies",
        always,
        |app| app.session.predictor.set.name() == "standard",
        |app, _| app.session.predict_by_set("standard"),
    )
    .menu(Menu::Predict, 0),
    choose(
        "predict-by-rules",
        "Rule induction",
        "Predict by rules that can be read",
        always,
        |app| app.session.predictor.method == Method::Each(Algorithm::Rules),
        |app, _| app.session.predictor.method = Method::Each(Algorithm::Rules),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-tree",
        "Decision tree",
        "Predict by a decision tree",
        always,
        |app| app.session.predictor.method == Method::Each(Algorithm::Tree),
        |app, _| app.session.predictor.method = Method::Each(Algorithm::Tree),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-knn",
        "Nearest neighbours",
        "Predict by the most similar rooms of the training set",
        always,
        |app| app.session.predictor.method == Method::Each(Algorithm::Knn),
        |app, _| app.session.predictor.method = Method::Each(Algorithm::Knn),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-mlp",
        "Perceptron",
        "Predict by a multilayer perceptron",
        always,
        |app| app.session.predictor.method == Method::Each(Algorithm::Mlp),
        |app, _| app.session.predictor.method = Method::Each(Algorithm::Mlp),
    )
    .menu(Menu::Predict, 1),
    choose(
        "predict-by-joint",
        "All rooms together",
        "Predict by a classifier that looks at all rooms of the plan in relation to each other",
        always,
        |app| app.session.predictor.method == Method::Joint,
        |app, _| app.session.predictor.method = Method::Joint,
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
    .menu(Menu::Predict, 2),
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
