//! The window without a display: what it does when it is clicked, typed at, and told to close.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]

mod access;
mod curate;
mod fields;
mod files;
mod hand;
mod monkey;
mod orders;
mod pictures;
mod robot;
#[path = "use.rs"]
mod use_;

use egui::{Pos2, pos2};
use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::geometry::Bounds;
use enfilade::plan::{ElementId, RoomId, RoomLabel};

/// A window that shows a bundled plan.
fn window_with(stem: &str) -> Offscreen {
    let mut window = Offscreen::new(OffscreenOptions::default());
    assert!(window.open_bundled(stem), "{stem} is bundled");
    window.settle().unwrap();
    window
}

/// The room of this name in the open plan.
fn room(window: &Offscreen, name: &str) -> RoomId {
    let plan = window.app().plan().unwrap();
    plan.rooms().find(|(_, room)| room.name == name).map(|(id, _)| id).unwrap_or_else(|| panic!("no room {name}"))
}

/// The middle of the box around a room, on the screen.
fn middle_of(window: &Offscreen, name: &str) -> Pos2 {
    let plan = window.app().plan().unwrap();
    let outer = &plan.room(room(window, name)).unwrap().outer;
    let centre = Bounds::of(plan.ring_points(outer)).center();
    window.app().screen_position(centre.x, centre.y).unwrap()
}

/// A place on the canvas beside the plan.
fn beside(window: &Offscreen) -> Pos2 {
    let bounds = window.app().plan().unwrap().bounds();
    let corner = window.app().screen_position(bounds.min.x, bounds.max.y).unwrap();
    pos2(corner.x - 15.0, corner.y - 15.0)
}

fn click_room(window: &mut Offscreen, name: &str) {
    window.click(middle_of(window, name));
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(window, name))), "clicking {name}");
}

/// The label given to a room itself.
fn own_label(window: &Offscreen, name: &str) -> Option<RoomLabel> {
    window.app().plan().unwrap().room(room(window, name)).unwrap().label
}

/// Clicks a control that must be there.
fn press(window: &mut Offscreen, name: &str) {
    let names: Vec<String> = window.controls().into_iter().map(|control| control.name).collect();
    assert!(window.click_control(name), "no control '{name}' among {names:?}");
    window.settle().unwrap();
}

fn texts(window: &Offscreen) -> Vec<String> {
    window.app().messages().iter().map(|message| format!("{} {}", message.text, message.detail)).collect()
}
