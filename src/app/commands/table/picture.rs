//! The backdrop.

use super::*;
use crate::app::paint::backdrop::Known;
use crate::app::session::picture_change::PictureUse;
use crate::edit::DrawingMoves;
use crate::plan::{DEFAULT_DOOR_WIDTH_M, ElementId};
use crate::store::pictures;

const DRAWING: Arg<Option<DrawingMoves>> = optional(
    "DRAWING",
    one_of::<DrawingMoves>(),
    "whether the drawing moves with the picture; without it, you are asked if anything is drawn",
);

const PAGE: Arg<Option<usize>> = optional("PAGE", COUNT, "which page of a PDF or TIFF, from 1");

const fn place(name: &'static str, help: &'static str) -> Arg<f64> {
    needed(name, coordinate(-FAR_M, FAR_M), help)
}

const fn way(name: &'static str, help: &'static str) -> Arg<f64> {
    needed(name, length(-FAR_M, FAR_M), help)
}

const LENGTH: Kind<f64> = length(0.001, FAR_M);

/// The change in opacity per key press.
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

fn is_outside(app: &App) -> Availability {
    has_backdrop(app)?;
    let is = matches!(app.session.backdrop.state(), Some(Known::Missing(error)) if *error == pictures::is_outside());
    when(is, "the picture lies in the plan's folder, or is shown already")
}

fn is_rectified(app: &App) -> Availability {
    has_backdrop(app)?;
    let is = app.plan().and_then(crate::plan::Plan::backdrop).is_some_and(|backdrop| backdrop.rectification.is_some());
    when(is, "the picture is shown as it is in its file")
}

fn has_pages(app: &App) -> Availability {
    has_backdrop(app)?;
    when(app.session.backdrop.pages() > 1, "the picture has one page")
}

/// A page number too large for any document becomes the largest possible.
fn page_number(page: usize) -> u32 {
    u32::try_from(page).unwrap_or(u32::MAX)
}

fn done(result: Result<(), String>) -> Outcome {
    result.map_or_else(Outcome::Refused, |()| Outcome::Done)
}

pub(super) const COMMANDS: &[Command] = &[
    with(
        "picture",
        "Add picture…",
        "Place a picture under the plan, or under a new one, to trace: PNG, JPEG, TIFF, \
                                     WebP, BMP, GIF, or a page of a PDF or TIFF",
        always,
        &given2(needed("PATH", PICTURE_FILE, "the picture's file"), PAGE, |app, path, page, _| {
            app.session.use_picture(PictureUse::Add, path, page.map_or(1, page_number));
            Outcome::Done
        }),
        Some(|app, _| app.session.choose_picture(PictureUse::Add)),
    )
    .typed_path()
    .menu(Menu::Picture, 0),
    with(
        "relink-picture",
        "Relink picture…",
        "Choose the picture file again, for one that was moved; its place and \
                                               scale stay",
        has_backdrop,
        &given1(needed("PATH", PICTURE_FILE, "the picture's file"), |app, path, _| {
            let page = app.plan().and_then(crate::plan::Plan::backdrop).map_or(1, |backdrop| backdrop.page);
            app.session.use_picture(PictureUse::Relink, path, page);
            Outcome::Done
        }),
        Some(|app, _| app.session.choose_picture(PictureUse::Relink)),
    )
    .typed_path()
    .menu(Menu::Picture, 0),
    with(
        "picture-page",
        "Page…",
        "Show another page of the PDF or TIFF under the plan",
        has_pages,
        &given1(needed("PAGE", COUNT, "from 1"), |app, page, _| {
            let page = page_number(page);
            if page > app.session.backdrop.pages() {
                return Outcome::Refused(format!("it has {} pages", app.session.backdrop.pages()));
            }
            app.session.change_backdrop("Show page", |backdrop| backdrop.page = page);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Picture, 0),
    command(
        "show-outside-picture",
        "Show picture from elsewhere",
        "Show the picture under the plan although its file lies outside the plan's folder",
        is_outside,
        |app, _| app.session.allow_picture(),
    )
    .menu(Menu::Picture, 0),
    command("remove-picture", "Remove picture", "Remove the picture under the plan", has_backdrop, |app, _| {
        app.session.remove_picture();
    })
    .menu(Menu::Picture, 0)
    .on(&[On::Picture]),
    tool(&tools::CALIBRATE_BY_LENGTH, has_backdrop).menu(Menu::Picture, 1).on(&[On::Picture]),
    tool(&tools::CALIBRATE_BY_DOOR, has_backdrop).menu(Menu::Picture, 1).on(&[On::Picture]),
    with(
        "calibrate",
        "Set scale",
        "Set the scale by the true length between two points of the picture; with several \
                                    lengths it is the best fit to all",
        has_backdrop,
        &given6(
            place("X1", "the first point, in metres as the plan is now"),
            place("Y1", "its height"),
            place("X2", "the second point"),
            place("Y2", "its height"),
            needed("LENGTH", LENGTH, "the true length between them"),
            DRAWING,
            |app, x1, y1, x2, y2, length_m, drawing, _| {
                done(app.session.add_measurement(Point::new(x1, y1), Point::new(x2, y2), length_m, drawing))
            },
        ),
        None,
    ),
    with(
        "calibrate-by-door",
        "Set scale by the selected door",
        "Set the scale by a door that you drew over the picture, from its true width: 0.9 m unless you give another",
        has_opening_on_picture,
        &given2(optional("WIDTH", LENGTH, "its true width"), DRAWING, |app, width_m, drawing, _| {
            let width_m = width_m.unwrap_or(DEFAULT_DOOR_WIDTH_M);
            let Some(opening) = selected_opening(app) else { return Outcome::Done };
            done(app.session.measure_opening(opening, width_m, drawing))
        }),
        None,
    )
    .menu(Menu::Picture, 1),
    with(
        "remove-measurement",
        "Remove a measured length…",
        "Remove a length measured in the picture; the scale follows from the others",
        has_measurements,
        &given2(needed("NUMBER", COUNT, "which of the list, from 1"), DRAWING, |app, number, drawing, _| {
            done(app.session.remove_measurement(number - 1, drawing))
        }),
        None,
    )
    .menu(Menu::Picture, 1),
    tool(&tools::STRAIGHTEN, has_backdrop).menu(Menu::Picture, 2).on(&[On::Picture]),
    with(
        "straighten",
        "Straighten by a line",
        "Turn the picture so that a line between two of its points is \
                                                horizontal or vertical, whichever is nearer",
        has_backdrop,
        &given5(
            place("X1", "the first point, in metres"),
            place("Y1", "its height"),
            place("X2", "the second point"),
            place("Y2", "its height"),
            DRAWING,
            |app, x1, y1, x2, y2, drawing, _| {
                done(app.session.straighten(Point::new(x1, y1), Point::new(x2, y2), drawing))
            },
        ),
        None,
    ),
    tool(&tools::RECTIFY, has_backdrop).menu(Menu::Picture, 2).on(&[On::Picture]),
    with(
        "rectify-picture",
        "Make picture flat",
        "Flatten a photographed drawing by the corners of a rectangle in it; its sides set the scale, or else their \
         ratio is estimated",
        has_backdrop,
        &given3(
            needed("CORNERS", points(4), "its four corners in metres, such as '0,0 4,0 4,3 0,3'"),
            optional("WIDTH", LENGTH, "its true width"),
            optional("HEIGHT", LENGTH, "its true height"),
            |app, corners, width_m, height_m, _| {
                let Ok(corners) = corners.try_into() else {
                    return Outcome::Refused("a rectangle has four corners".to_owned());
                };
                let sides_m = width_m.zip(height_m).map(|(width_m, height_m)| [width_m, height_m]);
                if width_m.is_some() != sides_m.is_some() {
                    return Outcome::Refused("give both sides or neither".to_owned());
                }
                done(app.session.rectify_picture(corners, sides_m))
            },
        ),
        None,
    ),
    with(
        "unrectify-picture",
        "Show picture as taken",
        "Show the picture as it is in its file, not flattened",
        is_rectified,
        &given0(|app, _| done(app.session.unrectify_picture())),
        None,
    )
    .menu(Menu::Picture, 2)
    .on(&[On::Picture]),
    with(
        "turn-picture",
        "Turn picture…",
        "Turn the picture about its centre",
        has_backdrop,
        &given2(
            needed("ANGLE", angle(-360.0, 360.0), "counter-clockwise, in degrees"),
            DRAWING,
            |app, angle, drawing, _| {
                app.session.turn_picture(angle, drawing);
                Outcome::Done
            },
        ),
        None,
    )
    .menu(Menu::Picture, 2)
    .on(&[On::Picture]),
    with(
        "move-picture",
        "Move picture…",
        "Move the picture under the plan; the drawing stays",
        has_backdrop,
        &given2(way("DX", "how far to the right"), way("DY", "how far up"), |app, dx, dy, _| {
            app.session.move_picture(Vector::new(dx, dy));
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Picture, 2)
    .on(&[On::Picture]),
    with(
        "picture-opacity",
        "Opacity…",
        "Set how strongly the picture shows",
        has_backdrop,
        &given1(needed("PERCENT", PERCENT, "0 hides it, 100 shows it in full"), |app, percent, _| {
            let opacity = percent / 100.0;
            app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = opacity);
            Outcome::Done
        }),
        None,
    )
    .menu(Menu::Picture, 3)
    .on(&[On::Picture]),
    command("picture-fainter", "Fainter", "Make the picture fainter", has_backdrop, |app, _| {
        app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = stepped(backdrop.opacity, -1.0));
    })
    .keys(&[key(Key::Comma)])
    .menu(Menu::Picture, 3)
    .on(&[On::Picture]),
    command("picture-stronger", "Stronger", "Make the picture stronger", has_backdrop, |app, _| {
        app.session.change_backdrop("Set opacity", |backdrop| backdrop.opacity = stepped(backdrop.opacity, 1.0));
    })
    .keys(&[key(Key::Period)])
    .menu(Menu::Picture, 3)
    .on(&[On::Picture]),
];

/// An opacity some steps away, rounded to whole steps.
fn stepped(opacity: f64, steps: f64) -> f64 {
    // Divided, not multiplied: so 7 tenths are 0.7.
    ((opacity / OPACITY_STEP + steps).round() / (1.0 / OPACITY_STEP).round()).clamp(0.0, 1.0)
}
