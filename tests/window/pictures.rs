//! Pictures of the window, in both themes, at both scales, empty, full, and in trouble.

use std::path::Path;

use enfilade::app::{Offscreen, OffscreenOptions};

use crate::golden::assert_picture;
use crate::{click_room, middle_of, press, window_with};

fn dark() -> Offscreen {
    Offscreen::new(OffscreenOptions { is_dark: true, ..OffscreenOptions::default() })
}

#[test]
fn office() {
    assert_picture("office", &window_with("office").picture());
}

#[test]
fn school_with_its_graph_in_the_dark() {
    let mut window = dark();
    window.resize(1040, 640);
    window.open_bundled("school");
    window.settle().unwrap();
    assert!(window.run_command("graph"));
    window.settle().unwrap();
    assert_picture("school-graph-dark", &window.picture());
}

#[test]
fn dwelling_with_a_room_picked_and_another_under_the_pointer() {
    let mut window = window_with("dwelling");
    click_room(&mut window, "Kitchen");
    window.move_to(middle_of(&window, "Study"));
    window.settle().unwrap();
    assert_picture("dwelling-room", &window.picture());
}

#[test]
fn dwelling_by_function_at_twice_the_scale() {
    let options = OffscreenOptions { width: 700, height: 460, scale: 2.0, ..OffscreenOptions::default() };
    let mut window = Offscreen::new(options);
    window.open_bundled("dwelling");
    window.run_command("inspector");
    window.run_command("fill-function");
    window.settle().unwrap();
    assert_picture("dwelling-function-200", &window.picture());
}

#[test]
fn welcome() {
    let mut window = dark();
    window.settle().unwrap();
    assert_picture("welcome-dark", &window.picture());
}

#[test]
fn an_error_keeps_the_plan_and_says_what_to_do() {
    let mut window = window_with("dwelling");
    window.resize(1000, 640);
    window.open(Path::new("/nowhere/plan.xml"));
    window.settle().unwrap();
    assert_picture("error", &window.picture());
}

#[test]
fn a_question_about_unsaved_changes_in_the_dark() {
    let mut window = dark();
    window.resize(1000, 640);
    window.open_bundled("dwelling");
    window.settle().unwrap();
    click_room(&mut window, "Study");
    assert!(window.run_command("label-big"));
    window.ask_to_close();
    window.settle().unwrap();
    assert_picture("question-dark", &window.picture());
}

#[test]
fn a_menu() {
    let mut window = window_with("dwelling");
    window.resize(900, 600);
    window.settle().unwrap();
    press(&mut window, "View");
    assert_picture("menu", &window.picture());
}

/// Nothing of a picture depends on what was done before, or on when it is taken.
#[test]
fn the_same_state_gives_the_same_picture() {
    let picture = window_with("dwelling").picture();
    let mut window = window_with("office");
    window.run_command("graph");
    window.wheel(2.0);
    window.advance(3.0);
    window.run_command("graph");
    window.open_bundled("dwelling");
    window.settle().unwrap();
    window.run_command("zoom-in");
    window.settle().unwrap();
    window.run_command("fit");
    window.settle().unwrap();
    let difference = picture.difference(&window.picture());
    assert_eq!(difference.map(|difference| difference.pixels), None);
}
