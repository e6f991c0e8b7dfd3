//! Background work that ends late, in another order, or not at all.

use std::path::Path;

use enfilade::app::{Offscreen, OffscreenOptions, Severity};
use enfilade::geometry::Point;
use enfilade::plan::{Builder, Plan, Room};
use enfilade::store::{load_plan, save_plan};

const SAVE: &str = "save the plan";
const OPEN: &str = "open a plan";
const ANALYSE: &str = "analyse the plan";
const GHOST: &str = "read the storey below";

/// A window with the bundled house, changed, in which jobs are held back.
fn changed() -> Offscreen {
    let mut window = Offscreen::new(OffscreenOptions::default()).holding_jobs();
    assert!(window.open_bundled("dwelling"));
    assert!(window.end_job(OPEN));
    window.settle().unwrap();
    window.run_command_with("pick", &["Study"]).unwrap();
    window.run_command_with("label-hall", &[]).unwrap();
    assert!(window.app().has_unsaved_changes());
    window
}

fn save_as(window: &mut Offscreen, path: &Path) {
    window.run_command_with("save-as", &[&path.to_string_lossy()]).unwrap();
    window.settle().unwrap();
}

fn breaks(window: &mut Offscreen, job: &str) {
    assert!(window.break_job(job), "{job} is not among {:?}", window.held_jobs());
    window.settle().unwrap();
    let messages = window.app().messages();
    let is_said = messages
        .iter()
        .any(|message| message.severity == Severity::Error && message.text == "Something went wrong inside Enfilade");
    assert!(is_said, "{messages:?}");
}

#[test]
fn a_plan_is_closed_once_its_save_has_ended() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.plan.json");
    let mut window = changed();
    let plan = window.app().plan().unwrap().clone();
    save_as(&mut window, &path);
    assert!(window.run_command("close"));
    window.settle().unwrap();
    assert_eq!(window.app().plan(), Some(&plan), "the save has not ended");
    assert!(window.end_job(SAVE));
    window.settle().unwrap();
    assert_eq!(window.app().plan(), None);
    assert_eq!(load_plan(&path).unwrap(), plan);
}

#[test]
fn two_saves_end_in_any_order_before_the_window_closes() {
    for order in [[0, 1], [1, 0]] {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|name| folder.path().join(format!("{name}.plan.json")));
        let mut window = changed();
        let plan = window.app().plan().unwrap().clone();
        paths.iter().for_each(|path| save_as(&mut window, path));
        window.ask_to_close();
        window.settle().unwrap();
        // Other work waits beside them.
        let held = window.held_jobs();
        let saves: Vec<usize> = (0..held.len()).filter(|&index| held[index] == SAVE).collect();
        assert!(window.end_job_at(saves[order[0]]));
        window.settle().unwrap();
        assert!(!window.is_closed(), "{order:?}: a save has not ended");
        assert!(window.end_job(SAVE));
        window.settle().unwrap();
        assert!(window.is_closed(), "{order:?}");
        paths.iter().for_each(|path| assert_eq!(load_plan(path).unwrap(), plan, "{order:?}"));
    }
}

#[test]
fn a_job_that_breaks_does_not_end_a_save() {
    let folder = tempfile::tempdir().unwrap();
    let [below, path] = ["below", "house"].map(|name| folder.path().join(format!("{name}.plan.json")));
    save_plan(&below, &Plan::default()).unwrap();
    let mut window = changed();
    save_as(&mut window, &path);
    window.run_command_with("ghost", &[&below.to_string_lossy()]).unwrap();
    window.ask_to_close();
    window.settle().unwrap();
    breaks(&mut window, GHOST);
    assert!(!window.is_closed() && window.app().has_unsaved_changes(), "the save has not ended");
    assert!(window.end_job(SAVE));
    window.settle().unwrap();
    assert!(window.is_closed() && path.exists());
}

#[test]
fn a_save_that_breaks_loses_nothing_and_closes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.plan.json");
    let mut window = changed();
    save_as(&mut window, &path);
    window.ask_to_close();
    window.settle().unwrap();
    breaks(&mut window, SAVE);
    assert!(!window.is_closed() && window.app().has_unsaved_changes());
    save_as(&mut window, &path);
    assert!(window.end_job(SAVE));
    window.settle().unwrap();
    assert!(!window.app().has_unsaved_changes() && path.exists());
}

/// A window with a plan so large that it is analysed beside the frames.
fn large(folder: &Path) -> Offscreen {
    let mut builder = Builder::default();
    for index in 0..2100 {
        let (x, y) = (f64::from(index % 50) * 4.0, f64::from(index / 50) * 3.0);
        let outer =
            builder.ring([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(dx, dy)| Point::new(x + dx, y + dy)));
        builder.room(&index.to_string(), Room { outer, ..Room::default() });
    }
    let path = folder.join("large.plan.json");
    save_plan(&path, &builder.finish().unwrap()).unwrap();
    let mut window = Offscreen::new(OffscreenOptions::default()).holding_jobs();
    window.open(&path);
    assert!(window.end_job(OPEN));
    window.settle().unwrap();
    window
}

/// Whether the plan is analysed : rooms can be gone through.
fn is_analysed(window: &mut Offscreen) -> bool {
    window.run_command("clear-selection");
    window.run_command("next-room");
    window.app().picked().is_some()
}

fn rename(window: &mut Offscreen, name: &str) {
    window.run_command_with("rename-plan", &[name]).unwrap();
    window.settle().unwrap();
}

/// First the labels, then the rest.
fn end_analysis(window: &mut Offscreen) {
    assert!(window.end_job(ANALYSE));
    window.settle().unwrap();
    assert!(window.end_job(ANALYSE), "{:?}", window.held_jobs());
    window.settle().unwrap();
}

#[test]
fn an_analysis_of_an_earlier_plan_is_cancelled_and_does_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = large(folder.path());
    rename(&mut window, "Later");
    let analyses = window.held_jobs().iter().filter(|job| **job == ANALYSE).count();
    assert_eq!(analyses, 2);
    assert_eq!(window.jobs().iter().filter(|(job, _)| *job == ANALYSE).count(), 1, "the earlier is cancelled");
    assert!(window.end_job(ANALYSE));
    assert!(!is_analysed(&mut window));
    end_analysis(&mut window);
    assert!(is_analysed(&mut window));
}

#[test]
fn an_analysis_that_breaks_is_not_begun_again_before_the_plan_is_another() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = large(folder.path());
    breaks(&mut window, ANALYSE);
    window.advance(1.0);
    assert!(!window.held_jobs().contains(&ANALYSE));
    assert!(!is_analysed(&mut window));
    rename(&mut window, "Another");
    end_analysis(&mut window);
    assert!(is_analysed(&mut window));
}

#[test]
fn a_job_a_frame_is_enough_where_there_are_no_threads() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("house.plan.json");
    let mut window = Offscreen::new(OffscreenOptions::default()).working_in_slices();
    assert!(window.open_bundled("dwelling"));
    window.settle().unwrap();
    save_as(&mut window, &path);
    assert_eq!(load_plan(&path).unwrap(), *window.app().plan().unwrap());
    assert!(!window.is_working());
}

#[test]
fn a_dataset_that_is_given_up_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("house.plan.json");
    let mut window = changed();
    save_as(&mut window, &plan);
    assert!(window.end_job(SAVE));
    window.settle().unwrap();
    window.open(&plan);
    window.settle().unwrap();
    while let Some(job) = window.held_jobs().first().copied() {
        window.end_job(job);
        window.settle().unwrap();
    }
    let rooms = folder.path().join("rooms.csv");
    // From the dialog, which then shows how far it is.
    window.run_command_with("export-dataset", &[&rooms.to_string_lossy()]).unwrap();
    window.run_command("export-dataset");
    window.settle().unwrap();
    assert!(window.click_control("Stop"), "{:?}", window.controls());
    window.settle().unwrap();
    // What was begun ends without a file, whenever it does.
    while let Some(job) = window.held_jobs().first().copied() {
        window.end_job(job);
        window.settle().unwrap();
    }
    assert!(!rooms.exists());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "only the plan");
    assert!(window.app().messages().iter().all(|message| message.severity != Severity::Error));
    // It can be made after all.
    window.run_command_with("export-dataset", &[&rooms.to_string_lossy()]).unwrap();
    while let Some(job) = window.held_jobs().first().copied() {
        window.end_job(job);
        window.settle().unwrap();
    }
    assert!(rooms.exists());
}
