//! What is visible, and how.

use super::*;
use crate::edit::EditError;
use crate::edit::guides::{add_guide, clear_guides, move_guide, remove_guide};
use crate::plan::{GuideAxis, Plan};

const AXIS: Arg<GuideAxis> = needed("WAY", one_of::<GuideAxis>(), "horizontal or vertical");

const POSITION: Arg<f64> = needed("POSITION", length(-FAR_M, FAR_M), "y of a horizontal guide, x of a vertical one");

fn has_ghost(app: &App) -> Availability {
    has_plan(app)?;
    when(app.session.ghost.is_some(), "show a storey below first")
}

fn has_guides(app: &App) -> Availability {
    has_plan(app)?;
    when(app.plan().is_some_and(|plan| !plan.guides().is_empty()), "there are no guides")
}

impl App {
    /// Changes guides, and shows them.
    fn change_guides(&mut self, title: &str, change: impl FnOnce(&Plan) -> Result<Plan, EditError>) -> Outcome {
        let Some(plan) = self.plan() else { return Outcome::Done };
        match change(plan) {
            Ok(plan) => {
                self.session.layers.guides = true;
                self.session.edit(title, |_| Ok(plan));
                Outcome::Done
            }
            Err(error) => Outcome::Refused(error.0),
        }
    }
}

fn done(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Refused, |()| Outcome::Done)
}

/// The spacing of the grid follows the zoom.
const AUTO: &str = "auto";

pub(super) const COMMANDS: &[Command] = &[
    command("fit", "Zoom to fit", "Show the whole plan", has_plan, |app, _| app.canvas.fit())
        .keys(&[key(Key::F)])
        .menu(Menu::View, 0)
        .on(&[On::FreeSpace])
        .tool(Icon::Fit, 1),
    command("zoom-to-selection", "Zoom to selection", "Show the selection as large as fits", has_picked, |app, _| {
        app.session.zoom_to_picked();
    })
    .keys(&[shift(Key::F)])
    .menu(Menu::View, 0)
    .on(&[On::Room, On::Wall, On::Opening, On::Corner, On::Dimension, On::Several])
    .tool(Icon::ZoomToSelection, 1),
    command("zoom-in", "Zoom in", "Zoom in", has_plan, |app, _| app.canvas.zoom_by(ZOOM_STEP))
        .keys(&[key(Key::Plus), key(Key::Equals)])
        .menu(Menu::View, 0),
    command("zoom-out", "Zoom out", "Zoom out", has_plan, |app, _| app.canvas.zoom_by(1.0 / ZOOM_STEP))
        .keys(&[key(Key::Minus)])
        .menu(Menu::View, 0),
    choose(
        "fill-label",
        "Fill by label",
        "Colour each room by its label",
        always,
        |app| app.session.layers.fill == Fill::Label,
        |app, _| app.session.layers.fill = Fill::Label,
    )
    .keys(&[key(Key::L)])
    .menu(Menu::View, 1),
    choose(
        "fill-function",
        "Fill by function",
        "Colour each room by its function",
        always,
        |app| app.session.layers.fill == Fill::Function,
        |app, _| app.session.layers.fill = Fill::Function,
    )
    .keys(&[shift(Key::L)])
    .menu(Menu::View, 1),
    choose(
        "fill-prediction",
        "Fill by prediction",
        "Colour each room by its predicted label, fainter where it is unsure; a room with another known label is hatched",
        always,
        |app| app.session.layers.fill == Fill::Prediction,
        |app, _| app.session.layers.fill = Fill::Prediction,
    )
    .keys(&[shift(Key::P)])
    .menu(Menu::View, 1),
    choose(
        "fill-none",
        "No fill",
        "Show only walls and openings",
        always,
        |app| app.session.layers.fill == Fill::None,
        |app, _| app.session.layers.fill = Fill::None,
    )
    .keys(&[key(Key::K)])
    .menu(Menu::View, 1),
    switch(
        "colour-blind-safe",
        "Colour-blind safe colours",
        "Use label colours that people with any colour blindness can tell apart",
        always,
        |app| app.session.layers.colours == LabelColours::ColourBlindSafe,
        |app, is_on| {
            app.session.layers.colours = if is_on { LabelColours::ColourBlindSafe } else { LabelColours::Standard };
        },
    )
    .menu(Menu::View, 1),
    switch(
        "graph",
        "Graph",
        "Show which rooms the openings connect",
        always,
        |app| app.session.layers.graph,
        |app, is_on| app.session.layers.graph = is_on,
    )
    .keys(&[key(Key::G)])
    .menu(Menu::View, 2)
    .tool(Icon::Graph, 2),
    switch(
        "names",
        "Names",
        "Show names and areas of rooms",
        always,
        |app| app.session.layers.names,
        |app, is_on| app.session.layers.names = is_on,
    )
    .keys(&[key(Key::N)])
    .menu(Menu::View, 2)
    .tool(Icon::Names, 2),
    switch(
        "backdrop",
        "Backdrop",
        "Show the picture under the plan",
        has_backdrop,
        |app| app.session.layers.backdrop,
        |app, is_on| app.session.layers.backdrop = is_on,
    )
    .keys(&[key(Key::P)])
    .menu(Menu::View, 2)
    .on(&[On::Picture])
    .tool(Icon::Backdrop, 2),
    switch(
        "grid",
        "Grid",
        "Show a grid of whole metres",
        always,
        |app| app.session.layers.grid,
        |app, is_on| app.session.layers.grid = is_on,
    )
    .keys(&[shift(Key::G)])
    .menu(Menu::View, 2)
    .on(&[On::FreeSpace])
    .tool(Icon::Grid, 2),
    switch(
        "guides",
        "Guides",
        "Show the guide lines",
        has_guides,
        |app| app.session.layers.guides,
        |app, is_on| app.session.layers.guides = is_on,
    )
    .menu(Menu::View, 2)
    .on(&[On::Guide]),
    switch(
        "dimensions",
        "Dimensions",
        "Show dimension chains, and clear lengths, area and perimeter of the selection",
        always,
        |app| app.session.layers.dimensions,
        |app, is_on| app.session.layers.dimensions = is_on,
    )
    .menu(Menu::View, 2)
    .on(&[On::Dimension, On::FreeSpace]),
    switch(
        "ghost-layer",
        "Storey below",
        "Show the plan chosen as the storey below, faintly",
        has_ghost,
        |app| app.session.layers.ghost,
        |app, is_on| app.session.layers.ghost = is_on,
    )
    .menu(Menu::View, 2),
    with(
        "ghost",
        "Show a storey below…",
        "Show another plan faintly under this one, such as the storey below",
        has_plan,
        &given2(
            needed("PATH", PLAN_FILE, "a file with a plan"),
            optional(
                "STOREY",
                COUNT,
                "which plan of the file, from 1; without it, the first, or for the open file the one before",
            ),
            |app, path, storey, _| {
                app.session.read_ghost(path, storey.map(|storey| storey - 1));
                Outcome::Done
            },
        ),
        Some(|app, _| {
            let choices = Some(app.session.ghost_choices()).filter(|choices| !choices.is_empty());
            app.ask_for_argument(Asked { choices, ..Asked::of("ghost") });
        }),
    )
    .menu(Menu::View, 3),
    command("clear-ghost", "Show no storey below", "Remove the storey below", has_ghost, |app, _| {
        app.session.show_ghost(None);
    })
    .menu(Menu::View, 3),
    switch(
        "rulers",
        "Rulers",
        "Show rulers along the canvas; drag guide lines out of them",
        always,
        |app| app.session.layers.rulers,
        |app, is_on| app.session.layers.rulers = is_on,
    )
    .keys(&[ctrl(Key::R)])
    .menu(Menu::View, 3),
    with(
        "add-guide",
        "Add a guide…",
        "Add a line to draw along; you can also drag one out of a ruler",
        has_plan,
        &given2(AXIS, POSITION, |app, axis, at_m, _| {
            app.change_guides("Add guide", |plan| add_guide(plan, axis, at_m))
        }),
        None,
    )
    .menu(Menu::View, 3)
    .on(&[On::FreeSpace]),
    with(
        "move-guide",
        "Move a guide…",
        "Move a guide line; you can also drag its mark along the ruler",
        has_guides,
        &given3(AXIS, POSITION, needed("TO", length(-FAR_M, FAR_M), "its new place"), |app, axis, from_m, to_m, _| {
            app.change_guides("Move guide", |plan| move_guide(plan, axis, from_m, to_m))
        }),
        None,
    )
    .menu(Menu::View, 3)
    .on(&[On::Guide]),
    with(
        "remove-guide",
        "Remove a guide…",
        "Remove a guide line; you can also drag its mark off the ruler, or double-click the mark",
        has_guides,
        &given2(AXIS, POSITION, |app, axis, at_m, _| {
            app.change_guides("Remove guide", |plan| remove_guide(plan, axis, at_m))
        }),
        None,
    )
    .menu(Menu::View, 3)
    .on(&[On::Guide]),
    command("clear-guides", "Clear guides", "Remove all guide lines", has_guides, |app, _| {
        app.session.edit("Clear guides", |plan| Ok(clear_guides(plan)));
    })
    .menu(Menu::View, 3)
    .on(&[On::Guide]),
    with(
        "grid-spacing",
        "Grid spacing…",
        "Set the distance between grid lines, or 'auto' to follow the zoom",
        always,
        &given1(needed("SPACING", TEXT, "a length, or 'auto'"), |app, text, _| {
            if text == AUTO {
                app.set_grid_m(None);
                return Outcome::DoneWith(vec![AUTO.to_owned()]);
            }
            match app.units().parse_length(&text).map(trim_m) {
                Ok(grid_m) if GRID_RANGE_M.contains(&grid_m) => {
                    app.set_grid_m(Some(grid_m));
                    Outcome::DoneWith(vec![format!("{grid_m}m")])
                }
                Ok(_) => {
                    let [least, most] = [GRID_RANGE_M.start(), GRID_RANGE_M.end()].map(|end| app.units().length(*end));
                    Outcome::Refused(format!("the grid's lines are {least} to {most} apart"))
                }
                Err(error) => Outcome::Refused(error.to_string()),
            }
        }),
        Some(|app, _| {
            let now = app.session.settings.grid_m().map_or(AUTO.to_owned(), |grid_m| app.units().exact_length(grid_m));
            app.ask_for_argument(Asked { text: now, ..Asked::of("grid-spacing") });
        }),
    )
    .menu(Menu::View, 3),
    choose(
        "units-metric",
        "Metres",
        "Show metres and square metres; numbers typed without a unit are metres",
        always,
        |app| app.units() == Units::Metric,
        |app, _| app.set_units(Units::Metric),
    )
    .menu(Menu::View, 3),
    choose(
        "units-imperial",
        "Feet and inches",
        "Show feet, inches and square feet; numbers typed without a unit are feet",
        always,
        |app| app.units() == Units::Imperial,
        |app, _| app.set_units(Units::Imperial),
    )
    .menu(Menu::View, 3),
    switch(
        "plan-panel",
        "Plans and layers",
        "Show or hide the panel on the left",
        always,
        |app| app.panels.is_shown(panels::PLANS),
        |app, is_on| [panels::PLANS, panels::LAYERS].iter().for_each(|id| app.set_panel(id, is_on)),
    )
    .keys(&[ctrl(Key::Num1)])
    .menu(Menu::View, 4)
    .tool(Icon::Sidebar, 3),
    switch(
        "inspector",
        "Inspector",
        "Show or hide the panel on the right",
        always,
        |app| app.panels.is_shown(panels::INSPECTOR),
        |app, is_on| app.set_panel(panels::INSPECTOR, is_on),
    )
    .keys(&[ctrl(Key::Num2)])
    .menu(Menu::View, 4)
    .tool(Icon::Inspector, 3),
    switch(
        "history",
        "History",
        "Show the steps that led to this plan, and go to any of them",
        always,
        |app| app.panels.is_shown(panels::HISTORY),
        |app, is_on| app.set_panel(panels::HISTORY, is_on),
    )
    .keys(&[ctrl(Key::Num3)])
    .menu(Menu::View, 4),
    switch(
        "findings",
        "Findings",
        "Show what is wrong with the plan, and what to do about it",
        always,
        |app| app.panels.is_shown(panels::FINDINGS),
        |app, is_on| app.panels.set_shown(panels::FINDINGS, is_on),
    )
    .keys(&[ctrl(Key::Num4)])
    .menu(Menu::View, 4),
    with(
        "next-finding",
        "Next finding",
        "Select what the next finding is about and bring it into view",
        has_findings,
        &given0(|app, _| done(app.session.step_finding(1))),
        None,
    )
    .keys(&[key(Key::F6)])
    .menu(Menu::View, 4),
    with(
        "previous-finding",
        "Previous finding",
        "Select what the previous finding is about and bring it into view",
        has_findings,
        &given0(|app, _| done(app.session.step_finding(-1))),
        None,
    )
    .keys(&[shift(Key::F6)])
    .menu(Menu::View, 4),
    with(
        "go-to-finding",
        "Go to finding",
        "Select what a finding is about, and bring it into view",
        has_findings,
        &given1(needed("NUMBER", COUNT, "its number in the panel"), |app, number, _| {
            done(app.session.go_to_finding(number))
        }),
        None,
    ),
    with(
        "fix-finding",
        "Fix finding",
        "Fix a finding that has a safe fix; for others, read what to do",
        has_findings,
        &given1(needed("NUMBER", COUNT, "its number in the panel"), |app, number, _| {
            done(app.session.fix_finding(number))
        }),
        None,
    ),
    with(
        "ignore-finding",
        "Ignore finding",
        "Ignore a finding, for a reason that is kept in the plan and shown by 'enfilade check'",
        has_findings,
        &given2(
            needed("NUMBER", COUNT, "its number in the panel"),
            needed("REASON", TEXT, "why, in one line"),
            |app, number, reason, _| done(app.session.ignore_finding(number, &reason)),
        ),
        None,
    ),
    with(
        "heed-finding",
        "Heed finding",
        "No longer ignore a finding",
        has_findings,
        &given1(needed("NUMBER", COUNT, "its number in the panel"), |app, number, _| {
            done(app.session.heed_finding(number))
        }),
        None,
    ),
    with(
        "panel",
        "Panel…",
        "Show or hide a panel beside the canvas",
        has_other_panels,
        &given2(
            needed("PANEL", PANEL, "a panel without a command of its own"),
            optional("SWITCH", ON_OR_OFF, "on or off; without it, switches over"),
            |app, SidePanelId(id), is_on, _| {
                let is_on = is_on.unwrap_or(!app.panels.is_shown(id));
                app.set_panel(id, is_on);
                Outcome::DoneWith(vec![id.to_owned(), switch_word(is_on).to_owned()])
            },
        ),
        None,
    )
    .menu(Menu::View, 4),
    choose(
        "theme-system",
        "Follow the system",
        "Light or dark, as the system is set",
        always,
        |app| app.theme == ThemeChoice::System,
        |app, context| app.set_theme(ThemeChoice::System, context),
    )
    .menu(Menu::View, 5),
    choose(
        "theme-light",
        "Light",
        "Always light",
        always,
        |app| app.theme == ThemeChoice::Light,
        |app, context| app.set_theme(ThemeChoice::Light, context),
    )
    .menu(Menu::View, 5),
    choose(
        "theme-dark",
        "Dark",
        "Always dark",
        always,
        |app| app.theme == ThemeChoice::Dark,
        |app, context| app.set_theme(ThemeChoice::Dark, context),
    )
    .menu(Menu::View, 5),
];
