//! What is seen, and how.

use super::*;

/// The grid's lines are as far apart as the zoom has it.
const AUTO: &str = "auto";

pub(super) const COMMANDS: &[Command] = &[
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
    with(
        "grid-spacing",
        "Grid spacing…",
        "Set how far the grid's lines are apart, or leave it to the zoom",
        always,
        &[needed("SPACING", ArgumentKind::Text, "a length, or 'auto'")],
        |app, values, _| {
            let text = values.text(0).unwrap_or_default();
            if text == AUTO {
                app.set_grid_m(None);
                return Ran::DoneWith(vec![AUTO.to_owned()]);
            }
            match app.units().parse_length(text).map(trim_m) {
                Ok(grid_m) if GRID_RANGE_M.contains(&grid_m) => {
                    app.set_grid_m(Some(grid_m));
                    Ran::DoneWith(vec![format!("{grid_m}m")])
                }
                Ok(_) => {
                    let [least, most] = [GRID_RANGE_M.start(), GRID_RANGE_M.end()].map(|end| app.units().length(*end));
                    Ran::Refused(format!("the grid's lines are {least} to {most} apart"))
                }
                Err(error) => Ran::Refused(error.to_string()),
            }
        },
        Some(|app, _| {
            let now = app.settings.grid_m().map_or(AUTO.to_owned(), |grid_m| app.units().exact_length(grid_m));
            let asking = crate::app::commands::find("grid-spacing").map(|command| Palette::asking(command, Vec::new()));
            app.panels.palette = asking.map(|palette| palette.with_text(&now));
        }),
    )
    .menu(Menu::View, 3),
    choose(
        "units-metric",
        "Metres",
        "Show lengths and areas in metres and square metres; numbers typed without a unit are metres",
        always,
        |app| app.units() == Units::Metric,
        |app, _| app.set_units(Units::Metric),
    )
    .menu(Menu::View, 3),
    choose(
        "units-imperial",
        "Feet and inches",
        "Show lengths in feet and inches, areas in square feet; numbers typed without a unit are feet",
        always,
        |app| app.units() == Units::Imperial,
        |app, _| app.set_units(Units::Imperial),
    )
    .menu(Menu::View, 3),
    switch(
        "plan-panel",
        "Plans and layers",
        "Show the panel on the left",
        always,
        |app| app.panels.left,
        |app, is_on| app.panels.left = is_on,
    )
    .keys(&[ctrl(Key::Num1)])
    .menu(Menu::View, 4)
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
    .menu(Menu::View, 4)
    .tool(Icon::Inspector, 3),
    switch(
        "history",
        "History",
        "Show the steps that led to the plan, and go to any of them",
        always,
        |app| app.panels.history,
        |app, is_on| app.panels.history = is_on,
    )
    .keys(&[ctrl(Key::Num3)])
    .menu(Menu::View, 4),
    choose(
        "theme-system",
        "Follow the system",
        "Light or dark as the system says",
        always,
        |app| app.theme == ThemeChoice::System,
        |app, context| app.set_theme(ThemeChoice::System, context),
    )
    .menu(Menu::View, 5),
    choose(
        "theme-light",
        "Light",
        "Light, whatever the system says",
        always,
        |app| app.theme == ThemeChoice::Light,
        |app, context| app.set_theme(ThemeChoice::Light, context),
    )
    .menu(Menu::View, 5),
    choose(
        "theme-dark",
        "Dark",
        "Dark, whatever the system says",
        always,
        |app| app.theme == ThemeChoice::Dark,
        |app, context| app.set_theme(ThemeChoice::Dark, context),
    )
    .menu(Menu::View, 5),
];
