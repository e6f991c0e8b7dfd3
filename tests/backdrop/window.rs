//! The backdrop in the window: added, scaled, rotated, moved away, changed, missing.

use std::path::Path;

use enfilade::app::{Offscreen, OffscreenOptions, Remedy};
use enfilade::geometry::Point;
use enfilade::plan::{Backdrop, Plan, ScaleOrigin};
use enfilade::store::pictures::content_hash;
use enfilade::store::{load_plan, save_plan};
use image::ImageFormat;

use super::render::traced;
use super::scan::{encoded, put, walls};

fn window() -> Offscreen {
    Offscreen::new(OffscreenOptions { width: 900, height: 600, ..OffscreenOptions::default() })
}

fn opened(path: &Path) -> Offscreen {
    let mut window = window();
    window.open(path);
    window.settle().unwrap();
    window
}

fn run(window: &mut Offscreen, id: &str, arguments: &[&str]) {
    window.run_command_with(id, arguments).unwrap_or_else(|error| panic!("{id}: {error}"));
    window.settle().unwrap();
}

fn plan(window: &Offscreen) -> &Plan {
    window.app().plan().unwrap()
}

fn backdrop(window: &Offscreen) -> &Backdrop {
    plan(window).backdrop().unwrap()
}

fn said(window: &Offscreen) -> Vec<String> {
    window.app().messages().iter().map(|message| message.text.clone()).collect()
}

#[test]
fn a_dropped_picture_begins_a_plan_that_is_traced_scaled_and_saved() {
    let folder = tempfile::tempdir().unwrap();
    let scan = put(folder.path(), "scans/ground.png", &encoded(&walls(), ImageFormat::Png));
    let mut window = window();
    window.drop_file(&scan);
    window.settle().unwrap();
    assert_eq!(said(&window), Vec::<String>::new());
    assert!(Path::new(&backdrop(&window).path).is_absolute(), "{}", backdrop(&window).path);
    assert!(backdrop(&window).content_hash.starts_with("sha256:"));
    // Its upper left corner lies at the origin; a pixel is a centimetre until it is measured.
    run(&mut window, "calibrate", &["0.2", "-0.2", "1.8", "-0.2", "16"]);
    assert!((backdrop(&window).metres_per_pixel - 0.1).abs() < 1e-12);
    assert_eq!(plan(&window).meta().scale.origin, ScaleOrigin::Measured);
    run(&mut window, "draw-room", &["2,-2 18,-2 18,-12 2,-12"]);
    // Another length, 2 % off: something is drawn, so that it is asked what becomes of it.
    window.run_command_with("calibrate", &["2", "-2", "2", "-12", "10.2"]).unwrap();
    assert!(window.run_command_with("fit", &[]).is_err(), "a question is asked");
    run(&mut window, "answer", &["along"]);
    let scaled = backdrop(&window).metres_per_pixel;
    assert!(scaled > 0.1 && scaled < 0.102, "{scaled}");
    let width_m = plan(&window).bounds().width();
    assert!((width_m - 160.0 * scaled).abs() < 2e-4, "{width_m}");
    run(&mut window, "undo", &[]);
    assert!((plan(&window).bounds().width() - 16.0).abs() < 1e-9 && backdrop(&window).measurements.len() == 1);
    run(&mut window, "redo", &[]);
    run(&mut window, "remove-measurement", &["2", "stays"]);
    assert!((plan(&window).bounds().width() - width_m).abs() < 1e-9);
    assert!((backdrop(&window).metres_per_pixel - 0.1).abs() < 1e-12);
    // Saved beside, the plan names the picture from where it lies; so does every earlier step.
    let path = folder.path().join("plans/ground.plan.json");
    std::fs::create_dir(path.parent().unwrap()).unwrap();
    run(&mut window, "save-as", &[&path.to_string_lossy()]);
    assert_eq!(load_plan(&path).unwrap().backdrop().unwrap().path, "../scans/ground.png");
    assert!(!window.app().has_unsaved_changes());
    run(&mut window, "undo", &[]);
    assert_eq!(backdrop(&window).path, "../scans/ground.png");
    assert_eq!(said(&window), Vec::<String>::new());
}

#[test]
fn straightening_turns_and_moving_moves() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = encoded(&walls(), ImageFormat::Png);
    put(folder.path(), "a.png", &bytes);
    let path = folder.path().join("a.plan.json");
    save_plan(&path, &traced("a.png", &content_hash(&bytes))).unwrap();
    let mut window = opened(&path);
    run(&mut window, "straighten", &["0", "0", "10", "1", "stays"]);
    assert!((backdrop(&window).rotation_rad + 0.1f64.atan()).abs() < 1e-9);
    let turned = backdrop(&window).clone();
    let level = turned.plan_from_picture(Point::new(0.0, 0.0)) - Point::new(0.0, 0.0);
    assert!(level.length() > 0.1, "it turns about the middle of the line");
    assert!((plan(&window).bounds().width() - 8.0).abs() < 1e-9, "the drawing stays");
    run(&mut window, "undo", &[]);
    assert_eq!(backdrop(&window).rotation_rad, 0.0);
    run(&mut window, "straighten", &["0", "0", "10", "1", "along"]);
    assert!(plan(&window).bounds().width() > 8.1, "the drawing turns too");
    run(&mut window, "undo", &[]);
    run(&mut window, "move-picture", &["1.5", "-2"]);
    assert_eq!(backdrop(&window).origin, Point::new(1.5, -2.0));
    run(&mut window, "picture-opacity", &["40"]);
    run(&mut window, "picture-stronger", &[]);
    assert_eq!(backdrop(&window).opacity, 0.5);
    run(&mut window, "remove-picture", &[]);
    assert_eq!(plan(&window).backdrop(), None);
    for _ in 0..4 {
        run(&mut window, "undo", &[]);
    }
    assert!(!window.app().has_unsaved_changes());
    assert!(window.run_command_with("straighten", &["0", "0", "0", "0"]).is_err());
    assert!(window.run_command_with("calibrate", &["0", "0", "0.1", "0", "3"]).is_err(), "half a pixel");
}

#[test]
fn a_picture_that_is_gone_is_found_or_relinked() {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let bytes = encoded(&walls(), ImageFormat::Png);
    let path = root.join("a.plan.json");
    save_plan(&path, &traced("gone/a.png", &content_hash(&bytes))).unwrap();
    // Nowhere: said with a way out; the plan is unchanged.
    let mut window = opened(&path);
    assert_eq!(window.app().messages()[0].remedies, [Remedy::RelinkPicture], "{:?}", said(&window));
    assert!(!window.app().has_unsaved_changes());
    let elsewhere = tempfile::tempdir().unwrap();
    let same = put(elsewhere.path(), "b.png", &bytes);
    window.answer_dialog(Some(same));
    assert!(window.click_control("Relink…"));
    window.settle().unwrap();
    assert_eq!(said(&window), Vec::<String>::new());
    assert!(backdrop(&window).path.ends_with("/b.png") && backdrop(&window).metres_per_pixel == 0.2);
    // Another picture is taken, but not without a word.
    let other = put(root, "other.bmp", &encoded(&walls().rotate90(), ImageFormat::Bmp));
    run(&mut window, "relink-picture", &[&other.to_string_lossy()]);
    assert!(said(&window)[0].contains("not the picture that was"), "{:?}", said(&window));
    assert_eq!(backdrop(&window).path, "other.bmp");
    // In a folder below: found by itself, the plan still unchanged until it is kept.
    put(root, "scans/renamed.png", &bytes);
    let mut window = opened(&path);
    assert!(said(&window)[0].contains("found at"), "{:?}", said(&window));
    assert!(!window.app().has_unsaved_changes());
    assert!(window.click_control("Keep this picture"));
    window.settle().unwrap();
    assert_eq!(backdrop(&window).path, "scans/renamed.png");
    assert_eq!(said(&window), Vec::<String>::new());
    // One that was changed by somebody is shown with a warning.
    run(&mut window, "save", &[]);
    put(root, "scans/renamed.png", &encoded(&walls().rotate180(), ImageFormat::Png));
    let mut window = opened(&path);
    assert!(said(&window)[0].contains("has changed"), "{:?}", said(&window));
    assert!(window.click_control("Keep this picture"));
    window.settle().unwrap();
    assert!(window.app().has_unsaved_changes());
}

#[test]
fn a_picture_outside_the_plans_folder_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = encoded(&walls(), ImageFormat::Png);
    put(folder.path(), "private/a.png", &bytes);
    let path = folder.path().join("plans/a.plan.json");
    std::fs::create_dir(path.parent().unwrap()).unwrap();
    save_plan(&path, &traced("../private/a.png", &content_hash(&bytes))).unwrap();
    let mut window = opened(&path);
    assert!(said(&window)[0].contains("lies outside the plan's folder"), "{:?}", said(&window));
    assert_eq!(window.app().messages()[0].remedies, [Remedy::ShowPicture]);
    assert!(window.click_control("Show it"));
    window.settle().unwrap();
    assert_eq!(said(&window), Vec::<String>::new());
    // It is shown now, and the plan is as it was.
    assert!(window.run_command_with("show-outside-picture", &[]).is_err(), "it is shown already");
    assert!(!window.app().has_unsaved_changes());
    // In another window it is asked for again; who names it need not be asked.
    let mut window = opened(&path);
    assert!(said(&window)[0].contains("lies outside"), "{:?}", said(&window));
    run(&mut window, "relink-picture", &[&folder.path().join("private/a.png").to_string_lossy()]);
    assert_eq!(said(&window), Vec::<String>::new());
}

#[test]
fn what_is_no_picture_is_refused_and_the_plan_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = put(folder.path(), "a.png", b"no picture");
    let mut window = window();
    run(&mut window, "new-plan", &[]);
    run(&mut window, "picture", &[&path.to_string_lossy()]);
    assert!(said(&window)[0].contains("no known kind"), "{:?}", said(&window));
    assert_eq!(plan(&window).backdrop(), None);
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn a_door_that_was_drawn_sets_the_scale() {
    let folder = tempfile::tempdir().unwrap();
    let scan = put(folder.path(), "a.png", &encoded(&walls(), ImageFormat::Png));
    let mut window = window();
    window.drop_file(&scan);
    window.settle().unwrap();
    // The door between the lower rooms is 10 pixels wide: 0.1 m of a plan that is not measured.
    run(&mut window, "draw-room", &["1,-0.2 1.8,-0.2 1.8,-0.7 1,-0.7"]);
    run(&mut window, "add-opening", &["door", "1.345,-0.7", "0.1", "1.345,-0.6"]);
    let (door, _) = plan(&window).openings().next().unwrap();
    run(&mut window, "select", &[&door.to_string()]);
    run(&mut window, "calibrate-by-door", &["0.9", "along"]);
    assert!((backdrop(&window).metres_per_pixel - 0.09).abs() < 1e-9, "{}", backdrop(&window).metres_per_pixel);
    let (_, door) = plan(&window).openings().next().unwrap();
    let width_m = plan(&window).opening_segment(door).unwrap().length();
    assert!((width_m - 0.9).abs() < 1e-4, "{width_m}");
}
