//! The table of commands: each runs by its word with arguments, says why it cannot, and is told to a
//! recorder so that running it again does the same.

#![cfg(feature = "gui")]
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

#[path = "commands/arguments.rs"]
mod arguments;
#[path = "commands/recorded.rs"]
mod recorded;

use enfilade::app::{Executed, Offscreen, OffscreenOptions, Picked};
use enfilade::plan::Room;

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

/// The picked room.
fn picked(window: &Offscreen) -> Room {
    match window.app().picked() {
        Some(Picked::Room(id)) => window.app().plan().unwrap().room(id).unwrap().clone(),
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
