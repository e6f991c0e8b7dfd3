//! The table of commands: each runs by its id with arguments, says why it is unavailable, and is reported
//! to a recorder such that repeating it does the same.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod arguments;
mod manual;
mod palette;
mod pictures;
mod recorded;
mod shortcuts;
mod units;

use egui::{Key, Modifiers};
use enfilade::app::{Executed, Offscreen, OffscreenOptions};
use enfilade::geometry::Point;
use enfilade::plan::{Backdrop, ElementId, Room};

/// A window that shows a bundled plan.
fn window_with(stem: &str) -> Offscreen {
    let mut window = Offscreen::new(OffscreenOptions::default());
    assert!(window.open_bundled(stem), "{stem} is bundled");
    window.settle().unwrap();
    window
}

/// Runs a command that must be done.
fn run(window: &mut Offscreen, id: &str, arguments: &[&str]) {
    window.run_command_with(id, arguments).unwrap_or_else(|error| panic!("{error}"));
    window.settle().unwrap();
}

/// Why a command is refused, in words.
fn refusal(window: &mut Offscreen, id: &str, arguments: &[&str]) -> String {
    let before = window.app().plan().cloned();
    let error = window.run_command_with(id, arguments).expect_err(id).to_string();
    window.settle().unwrap();
    assert_eq!(window.app().plan(), before.as_ref(), "{id} is refused, so it does nothing");
    error
}

/// Clicks a control that must be there.
fn press(window: &mut Offscreen, name: &str) {
    let names: Vec<String> = window.controls().into_iter().map(|control| control.name).collect();
    assert!(window.click_control(name), "no control '{name}' among {names:?}");
    window.settle().unwrap();
}

/// Presses keys, as written in settings: 'Ctrl+Shift+P'.
fn keys(window: &mut Offscreen, text: &str) {
    let mut modifiers = Modifiers::NONE;
    let mut name = text;
    while let Some((first, rest)) = name.split_once('+').filter(|(_, rest)| !rest.is_empty()) {
        match first {
            "Ctrl" => modifiers |= Modifiers::COMMAND | Modifiers::CTRL,
            "Shift" => modifiers |= Modifiers::SHIFT,
            "Alt" => modifiers |= Modifiers::ALT,
            other => panic!("no modifier {other}"),
        }
        name = rest;
    }
    window.key(modifiers, Key::from_name(name).unwrap_or_else(|| panic!("no key {name}")));
    window.settle().unwrap();
}

/// Types a text into what has the keyboard.
fn type_in(window: &mut Offscreen, text: &str) {
    window.text(text);
    window.settle().unwrap();
}

/// A picture under a plan, which need not be there.
fn backdrop() -> Backdrop {
    Backdrop {
        path: "scan.png".to_owned(),
        content_hash: String::new(),
        origin: Point::new(0.0, 5.0),
        metres_per_pixel: 0.5,
        rotation_rad: 0.0,
        opacity: 1.0,
        page: 1,
        measurements: Vec::new(),
        rectification: None,
        extra: None,
    }
}

/// The picked room.
fn picked(window: &Offscreen) -> Room {
    match window.app().picked() {
        Some(ElementId::Room(id)) => window.app().plan().unwrap().room(id).unwrap().clone(),
        other => panic!("no room is picked: {other:?}"),
    }
}

/// The commands done since the last call, as a script would have them.
fn done(window: &mut Offscreen) -> Vec<String> {
    let line = |Executed { id, arguments }| {
        let arguments: Vec<String> = arguments.iter().map(|argument| format!(" {argument:?}")).collect();
        format!("{id}{}", arguments.concat())
    };
    window.take_executed().into_iter().map(line).collect()
}
