//! The picture under the plan, to trace over.

use super::*;
use crate::app::session::tracing::PictureUse;
use crate::edit::DrawingMoves;
use crate::plan::{DEFAULT_DOOR_WIDTH_M, ElementId};

const DRAWING: Argument = optional(
    "DRAWING",
    ArgumentKind::Word(DrawingMoves::WORDS),
    "whether the drawing goes along with the picture; without, it is asked where something is drawn",
);

const PAGE: Argument = optional("PAGE", ArgumentKind::Count, "which page of a PDF, from 1");

const fn metres(name: &'static str, help: &'static str) -> Argument {
    needed(name, ArgumentKind::Number { unit: " of metres", least: -FAR_M, most: FAR_M }, help)
}

const LENGTH: ArgumentKind = ArgumentKind::Number { unit: " of metres", least: 0.001, most: FAR_M };

/// By how much a key makes the picture fainter or stronger.
const OPACITY_STEP: f64 = 0.1;

fn has_measurements(app: &App) -> Availability {
    has_backdrop(app)?;
    let has = app.plan().and_then(crate::plan::Plan::backdrop).is_some_and(crate::plan::Backdrop::is_measured);
    when(has, "no length was measured on the picture")
}

fn has_opening_on_picture(app: &App) -> Availability {
    has_backdrop(app)?;
    when(selected_opening(app).is_some(), "select one door that was drawn over the picture first")
}

fn selected_opening(app: &App) -> Option<crate::plan::OpeningId> {
    match app.session.selection.one()? {
        ElementId::Opening(id) => Some(id),
        _ => None,
    }
}

fn has_pages(app: &App) -> Availability {
    has_backdrop(app)?;
    when(app.session.backdrop.pages() > 1, "the picture has one page")
}

/// The argument at a place that says what becomes of the drawing.
fn drawing(values: &Values, index: usize) -> Option<DrawingMoves> {
    values.word(index).map(|word| DrawingMoves::of_word(word))
}

fn point(values: &Values, index: usize) -> Option<Point> {
    Some(Point::new(*values.number(index)?, *values.number(index + 1)?))
}

fn done(result: Result<(), String>) -> Ran {
    result.map_or_else(Ran::Refused, |()| Ran::Done)
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "picture",
        "Add picture…",
        "Lay a picture under the plan, or under a new one, to trace over: PNG, JPEG, TIFF, WebP, BMP, GIF or a page of a \
         PDF",
        always,
        &[needed("PATH", ArgumentKind::PictureFile, "the picture's file"), PAGE],
        |app, values, _| {
            if let Some(path) = values.path(0) {
                let page = values.count(1).map_or(1, |page| u32::try_from(*page).unwrap_or(u32::MAX));
                app.session.use_picture(PictureUse::Add, path.to_owned(), page);
            }
            Ran::Done
        },
        Some(|app, _| app.session.choose_picture(PictureUse::Add)),
    )
    .menu(Menu::Picture, 0),
    with(
        "relink-picture",
        "Relink picture…",
        "Say where the picture under the plan is now; its place and scale stay",
        has_backdrop,
        &[needed("PATH", ArgumentKind::PictureFile, "the picture's file")],
        |app, values, _| {
            if let Some(path) = values.path(0) {
                let page = app.plan().and_then(crate::plan::Plan::backdrop).map_or(1, |backdrop| backdrop.page);
                app.session.use_picture(PictureUse::Relink, path.to_owned(), page);
            }
            Ran::Done
        },
        Some(|app, _| app.session.choose_picture(PictureUse::Relink)),
    )
    .menu(Menu::Picture, 0),
    with(
        "picture-page",
        "Page…",
        "Show another page of the PDF under the plan",
        has_pages,
        &[needed("PAGE", ArgumentKind::Count, "from 1")],
        |app, values, _| {
            let page = values.count(0).map_or(1, |page| u32::try_from(*page).unwrap_or(u32::MAX));
            if page > app.session.backdrop.pages() {
                return Ran::Refused(format!("it has {} pages", app.session.backdrop.pages()));
            }
            app.session.change_backdrop("Show page", |backdrop| backdrop.page = page);
            Ran::Done
        },
        None,
    )
    .menu(Menu::Picture, 0),
    command("remove-picture", "Remove picture", "Take the picture away from under the plan", has_backdrop, |app, _| {
        app.session.remove_picture();
    })
    .menu(Menu::Picture, 0),
    tool(&tools::CALIBRATE_BY_LENGTH, has_backdrop)    .menu(Menu::Picture, 1),
    tool(&tools::CALIBRATE_BY_DOOR, has_backdrop)    .menu(Menu::Picture, 1),
    with(
        "calibrate",
        "Set scale",
        "Set the scale by the true length between two points of the picture; of several lengths, each added to those \
         before, the scale is the best fit",
        has_backdrop,
        &[
            metres("X1", "the first point, in metres as the plan is now"),
            metres("Y1", "its height"),
            metres("X2", "the second point"),
            metres("Y2", "its height"),
            needed("LENGTH", LENGTH, "the true length between them in metres"),
            DRAWING,
        ],
        |app, values, _| match (point(values, 0), point(values, 2), values.number(4)) {
            (Some(from), Some(to), Some(&length_m)) => {
                done(app.session.add_measurement(from, to, length_m, drawing(values, 5)))
            }
            _ => Ran::Done,
        },
        None,
    ),
    with(
        "calibrate-by-door",
        "Set scale by the selected door",
        "Set the scale by a door that was drawn over the picture and whose true width is known: 0.9 m unless another is \
         given",
        has_opening_on_picture,
        &[optional("WIDTH", LENGTH, "its true width in metres"), DRAWING],
        |app, values, _| {
            let width_m = values.number(0).copied().unwrap_or(DEFAULT_DOOR_WIDTH_M);
            let Some(opening) = selected_opening(app) else { return Ran::Done };
            done(app.session.measure_opening(opening, width_m, drawing(values, 1)))
        },
        None,
    )
    .menu(Menu::Picture, 1),
    with(
        "remove-measurement",
        "Remove a measured length…",
        "Forget a length that was measured on the picture: the scale follows from the others",
        has_measurements,
        &[needed("NUMBER", ArgumentKind::Count, "which of the list, from 1"), DRAWING],
        |app, values, _| {
            let index = values.count(0).map_or(0, |number| number - 1);
            done(app.session.remove_measurement(index, drawing(values, 1)))
        },
        None,
    )
    .menu(Menu::Picture, 1),
    tool(&tools::STRAIGHTEN, has_backdrop)    .menu(Menu::Picture, 2),
    with(
        "straighten",
        "Straighten by a line",
        "Turn the picture so that a line between two of its points is level or upright, whichever is nearer",
        has_backdrop,
        &[
            metres("X1", "the first point, in metres"),
            metres("Y1", "its height"),
            metres("X2", "the second point"),
            metres("Y2", "its height"),
            DRAWING,
        ],
        |app, values, _| match (point(values, 0), point(values, 2)) {
            (Some(from), Some(to)) => done(app.session.straighten(from, to, drawing(values, 4))),
            _ => Ran::Done,
        },
        None,
    ),
    with(
        "turn-picture",
        "Turn picture…",
        "Turn the picture about its middle",
        has_backdrop,
        &[
            needed(
                "ANGLE",
                ArgumentKind::Number { unit: " of degrees", least: -360.0, most: 360.0 },
                "counter-clockwise, in degrees",
            ),
            DRAWING,
        ],
        |app, values, _| {
            app.session.turn_picture(values.number(0).copied().unwrap_or(0.0), drawing(values, 1));
            Ran::Done
        },
        None,
    )
    .menu(Menu::Picture, 2),
    with(
        "move-picture",
        "Move picture…",
        "Move the picture under the plan; what is drawn stays",
        has_backdrop,
        &[metres("DX", "to the right, in metres"), metres("DY", "up, in metres")],
        |app, values, _| {
            if let Some(by) = point(values, 0) {
                app.session.move_picture(Vector::new(by.x, by.y));
            }
            Ran::Done
        },
        None,
    )
    .menu(Menu::Picture, 2),
    with(
        "picture-opacity",
        "Opacity…",
        "Say how strongly the picture is seen",
        has_backdrop,
        &[needed(
            "PERCENT",
            ArgumentKind::Number { unit: " of percent", least: 0.0, most: 100.0 },
            "0 not at all, 100 as it is",
        )],
        |app, values, _| {
            let opacity = values.number(0).copied().unwrap_or(100.0) / 100.0;
            app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = opacity);
            Ran::Done
        },
        None,
    )
    .menu(Menu::Picture, 3),
    command("picture-fainter", "Fainter", "Show the picture less strongly", has_backdrop, |app, _| {
        app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = stepped(backdrop.opacity, -1.0));
    })
    .keys(&[key(Key::Comma)])
    .menu(Menu::Picture, 3),
    command("picture-stronger", "Stronger", "Show the picture more strongly", has_backdrop, |app, _| {
        app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = stepped(backdrop.opacity, 1.0));
    })
    .keys(&[key(Key::Period)])
    .menu(Menu::Picture, 3),
];

/// An opacity some steps away, in whole steps.
fn stepped(opacity: f64, steps: f64) -> f64 {
    // Divided, not multiplied: 7 tenths are 0.7.
    ((opacity / OPACITY_STEP + steps).round() / (1.0 / OPACITY_STEP).round()).clamp(0.0, 1.0)
}
