//! Training in the window: while it runs, when it is stopped, and when it is done.

use enfilade::app::{Offscreen, OffscreenOptions};

const READ: &str = "read the labelled rooms";
const TRAIN: &str = "train models";

/// A window with the bundled house in which a tree is about to be trained on its rooms; its job is held back.
fn training() -> Offscreen {
    let mut window = Offscreen::new(OffscreenOptions::default()).holding_jobs();
    assert!(window.open_bundled("dwelling"));
    assert!(window.end_job("open a plan"));
    window.settle().unwrap();
    window.run_command_with("train", &["", "algorithm=tree by=room folds=2 neighbours=true"]).unwrap();
    window.settle().unwrap();
    // The training waits for its rooms.
    assert!(!window.held_jobs().contains(&TRAIN));
    assert!(window.end_job(READ));
    window.settle().unwrap();
    assert!(window.held_jobs().contains(&TRAIN), "{:?}", window.held_jobs());
    window.run_command("train");
    window.settle().unwrap();
    window
}

#[test]
fn a_training_that_is_stopped_leaves_nothing() {
    let mut window = training();
    assert!(window.control("Continue in the background").is_some());
    assert!(window.click_control("Stop"));
    window.settle().unwrap();
    // The form is back, whatever the job still does.
    assert!(window.control("Stop").is_none() && window.control("Neighbours").is_none());
    assert!(window.control("Folds: 10").is_some());
    assert!(window.end_job(TRAIN));
    window.settle().unwrap();
    assert!(window.control("Keep").is_none());
    assert!(window.run_command_with("keep-models", &["mine", "models"]).is_err());
}

#[test]
fn a_trained_model_can_be_chosen_at_once() {
    let mut window = training();
    assert!(window.end_job(TRAIN));
    window.settle().unwrap();
    assert!(window.control("Keep").is_some() && window.control("Train again").is_some());
    window.run_command_with("models", &["the-open-plans-house-tree"]).unwrap();
    window.settle().unwrap();
    assert!(window.app().predictions().is_some());
}
