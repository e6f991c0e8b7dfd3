//! Looking at a plan: panning, zooming, picking, by pointer and by keyboard.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use enfilade::app::commands::COMMANDS;
use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::geometry::Segment;
use enfilade::labels::Label;
use enfilade::plan::{ElementId, LabelOrigin, OpeningId, Plan, RoomLabel};

use super::{beside, click_room, middle_of, own_label, press, room, window_with};

fn near(p: Pos2, q: Pos2) {
    assert!(p.distance(q) <= 1.5, "{p:?} is not {q:?}");
}

#[test]
fn the_wheel_zooms_at_the_pointer_and_everything_pans() {
    let mut window = window_with("office");
    let at = middle_of(&window, "Lobby");
    let apart = |window: &Offscreen| middle_of(window, "Lobby").distance(middle_of(window, "Direction"));
    let before = apart(&window);
    window.move_to(at);
    window.wheel(3.0);
    window.settle().unwrap();
    near(middle_of(&window, "Lobby"), at);
    assert!(apart(&window) > before * 1.5);
    // Two fingers, the middle button, and the second button pan.
    window.swipe(vec2(5.0, -7.0));
    window.settle().unwrap();
    near(middle_of(&window, "Lobby"), at + vec2(5.0, -7.0));
    let mut expected = middle_of(&window, "Lobby");
    for button in [PointerButton::Middle, PointerButton::Secondary] {
        window.drag(button, at, at + vec2(40.0, 30.0));
        window.settle().unwrap();
        expected += vec2(40.0, 30.0);
        near(middle_of(&window, "Lobby"), expected);
    }
    assert_eq!(window.app().picked(), None, "dragging picks nothing");
    // Space and drag, with the keyboard on the canvas.
    click_room(&mut window, "Lobby");
    let at = middle_of(&window, "Lobby");
    window.hold(Key::Space, true);
    window.drag(PointerButton::Primary, at + vec2(30.0, 0.0), at + vec2(-60.0, 0.0));
    window.hold(Key::Space, false);
    window.settle().unwrap();
    near(middle_of(&window, "Lobby"), at + vec2(-90.0, 0.0));
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Lobby"))));
    // Back to where all is seen, also after the window has changed.
    window.run_command("fit");
    window.settle().unwrap();
    let fitted = apart(&window);
    assert!((fitted - before).abs() < 1.0, "{fitted} {before}");
    window.resize(900, 600);
    window.settle().unwrap();
    assert!(apart(&window) < before * 0.7, "a fitted plan stays fitted");
}

#[test]
fn keys_zoom_to_what_is_picked() {
    let mut window = window_with("office");
    click_room(&mut window, "Lobby");
    let apart = |window: &Offscreen| middle_of(window, "Lobby").distance(middle_of(window, "Direction"));
    let before = apart(&window);
    window.key(Modifiers::SHIFT, Key::F);
    window.settle().unwrap();
    assert!(apart(&window) > before * 2.0);
    window.key(Modifiers::NONE, Key::F);
    window.settle().unwrap();
    assert!((apart(&window) - before).abs() < 1.0);
    window.key(Modifiers::SHIFT, Key::Plus);
    window.settle().unwrap();
    assert!(apart(&window) > before * 1.2);
}

/// An opening of a plan that lies inside a room's box, and the middle of it on the screen.
fn door_of(window: &Offscreen, plan: &Plan, is_wanted: impl Fn(&Segment) -> bool) -> (OpeningId, Pos2) {
    let found = plan.openings().filter(|(_, opening)| opening.kind.is_passable()).find_map(|(id, opening)| {
        let segment = plan.opening_segment(opening)?;
        is_wanted(&segment).then_some((id, segment.midpoint()))
    });
    let (id, middle) = found.expect("there is such a door");
    (id, window.app().screen_position(middle.x, middle.y).unwrap())
}

#[test]
fn clicking_picks_the_smallest_and_again_what_lies_beneath() {
    let mut window = window_with("office");
    let plan = window.app().plan().unwrap().clone();
    let (door, at) = door_of(&window, &plan, |_| true);
    window.click(at);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Opening(door)));
    window.click(at);
    window.settle().unwrap();
    let second = window.app().picked();
    assert!(matches!(second, Some(ElementId::Wall(_))), "{second:?}");
    window.click(at);
    window.settle().unwrap();
    let third = window.app().picked();
    assert!(matches!(third, Some(ElementId::Room(_))), "{third:?}");
    window.click(beside(&window));
    window.settle().unwrap();
    assert_eq!(window.app().picked(), None);
    click_room(&mut window, "Lobby");
    window.key(Modifiers::NONE, Key::Escape);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), None);
}

#[test]
fn the_inspector_leads_from_room_to_room() {
    // High enough for the neighbours, which stand last.
    let mut window = Offscreen::new(OffscreenOptions { height: 1500, ..OffscreenOptions::default() });
    assert!(window.open_bundled("dwelling"));
    window.settle().unwrap();
    click_room(&mut window, "Kitchen");
    for expected in [
        "Area along axes: 15.7 m²",
        "Clear area: 13.6 m²",
        "Axes ratio: 2.00",
        "Openings: 2",
        "to halls: 1",
        "Medium room",
    ] {
        assert!(window.control(expected).is_some(), "{expected}");
    }
    press(&mut window, "Dining room");
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Dining room"))));
    press(&mut window, "Kitchen");
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Kitchen"))));
}

#[test]
fn rooms_are_reached_by_keyboard() {
    let mut window = window_with("dwelling");
    // Tab goes round the whole window and comes to the canvas.
    let canvas =
        |window: &Offscreen| window.controls().into_iter().find(|control| control.role == Role::Canvas).unwrap();
    for _ in 0..60 {
        window.key(Modifiers::NONE, Key::Tab);
        window.settle().unwrap();
        if window.app().picked().is_some() {
            break;
        }
    }
    let first = window.app().picked();
    assert!(matches!(first, Some(ElementId::Room(_))), "{first:?}");
    assert!(canvas(&window).name.contains("selected"), "{}", canvas(&window).name);
    let mut seen = vec![first];
    let rooms = window.app().plan().unwrap().rooms().len();
    for _ in 1..rooms {
        window.key(Modifiers::NONE, Key::Tab);
        window.settle().unwrap();
        assert!(!seen.contains(&window.app().picked()), "each room once");
        seen.push(window.app().picked());
    }
    // Behind the last room Tab leaves the canvas, and goes round again.
    window.key(Modifiers::NONE, Key::Tab);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), *seen.last().unwrap());
    // With Ctrl arrows go to the room on that side.
    click_room(&mut window, "Dining room");
    window.key(Modifiers::COMMAND, Key::ArrowUp);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Kitchen"))));
    window.key(Modifiers::COMMAND, Key::ArrowRight);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Living room"))));
}

#[test]
fn a_room_is_labelled_named_and_undone() {
    let mut window = window_with("dwelling");
    click_room(&mut window, "Study");
    window.key(Modifiers::NONE, Key::B);
    window.settle().unwrap();
    let by_person = Some(RoomLabel { label: Label::BigRoom, origin: LabelOrigin::Person });
    assert_eq!(own_label(&window, "Study"), by_person);
    press(&mut window, "Corridor");
    assert_eq!(own_label(&window, "Study").unwrap().label, Label::Corridor);
    window.key(Modifiers::COMMAND, Key::Z);
    window.settle().unwrap();
    assert_eq!(own_label(&window, "Study"), by_person);
    // The name, by its key; what is typed counts when the field is left.
    window.key(Modifiers::NONE, Key::F2);
    window.settle().unwrap();
    window.key(Modifiers::COMMAND, Key::A);
    window.text("Library of ");
    window.text("the house");
    window.key(Modifiers::NONE, Key::S);
    assert_eq!(own_label(&window, "Study"), by_person, "letters belong to the text");
    window.key(Modifiers::NONE, Key::Enter);
    window.settle().unwrap();
    assert_eq!(own_label(&window, "Library of the house"), by_person);
    // Escape drops what was typed.
    window.key(Modifiers::NONE, Key::F2);
    window.settle().unwrap();
    window.text("!");
    window.key(Modifiers::NONE, Key::Escape);
    window.settle().unwrap();
    room(&window, "Library of the house");
    for _ in 0..2 {
        window.key(Modifiers::COMMAND, Key::Z);
        window.settle().unwrap();
    }
    assert_eq!(own_label(&window, "Study"), None);
    assert!(!window.app().has_unsaved_changes(), "undone to how it came");
    window.key(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    window.settle().unwrap();
    assert_eq!(own_label(&window, "Study"), by_person);
}

#[test]
fn a_function_is_chosen_from_the_scheme() {
    let mut window = window_with("dwelling");
    click_room(&mut window, "Study");
    press(&mut window, "Function");
    window.key(Modifiers::COMMAND, Key::A);
    window.text("bed");
    window.settle().unwrap();
    press(&mut window, "bedroom");
    let study = window.app().plan().unwrap().room(room(&window, "Study")).unwrap().clone();
    assert_eq!(study.function, "bedroom");
    // What is typed and left by picking another room belongs to the room it was typed for.
    press(&mut window, "Name");
    window.key(Modifiers::COMMAND, Key::A);
    window.text("Guests");
    window.settle().unwrap();
    click_room(&mut window, "Kitchen");
    room(&window, "Guests");
    room(&window, "Kitchen");
}

/// Every command of the table does no harm, in each state and at once after another.
#[test]
fn every_command_runs_in_every_state() {
    let options = OffscreenOptions { width: 640, height: 420, ..OffscreenOptions::default() };
    for state in ["welcome", "plan", "room"] {
        let mut window = Offscreen::new(options);
        for command in COMMANDS.iter() {
            if window.is_closed() {
                window = Offscreen::new(options);
            }
            // Everything that the last one left open or asked is put away.
            while window.app().plan().is_some() {
                let _ = window.run_command_with("answer", &["cancel"]);
                window.run_command("close");
                window.settle().unwrap();
                if window.control("Don't save").is_some() {
                    press(&mut window, "Don't save");
                }
            }
            if state != "welcome" {
                window.open_bundled("dwelling");
            }
            window.settle().unwrap();
            if state == "room" {
                window.run_command("next-room");
            }
            window.run_command(command.id);
            window.settle().unwrap_or_else(|error| panic!("{} in {state}: {error}", command.id));
            assert_eq!(window.is_closed(), command.id == "quit", "{} in {state}", command.id);
        }
    }
    let mut window = Offscreen::new(OffscreenOptions::default());
    assert!(!window.run_command("no-such-command"));
    assert!(!window.run_command("undo"), "nothing to undo");
}

#[test]
fn layers_are_seen_to_change() {
    let mut window = window_with("dwelling");
    let plain = window.picture();
    for id in ["graph", "names", "grid", "fill-function", "fill-none", "theme-dark", "plan-panel", "inspector"] {
        window.run_command(id);
        window.settle().unwrap();
        let changed = plain.difference(&window.picture()).map_or(0, |difference| difference.pixels);
        assert!(changed > 200, "{id}: {changed} pixels");
        match id {
            "fill-function" | "fill-none" => window.run_command("fill-label"),
            "theme-dark" => window.run_command("theme-system"),
            id => window.run_command(id),
        };
        window.settle().unwrap();
        assert_eq!(plain.difference(&window.picture()).map(|d| d.pixels), None, "{id} and back");
    }
}
