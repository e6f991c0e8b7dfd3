//! The window without eyes or a mouse: every control has a name, the keyboard reaches and presses it, and
//! it is visible where the keyboard is.

use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Rect};
use enfilade::app::commands::Menu;
use enfilade::app::{Control, Offscreen, OffscreenOptions};
use enfilade::plan::ElementId;

use super::{click_room, press, room, window_with};

fn key(window: &mut Offscreen, key: Key) {
    window.key(Modifiers::NONE, key);
    window.settle().unwrap();
}

/// A room on the canvas: arrows and Tab go from one to the next, while the canvas has the keyboard.
fn is_room(control: &Control) -> bool {
    control.role == Role::ListBoxOption && !control.description.is_empty()
}

fn check_names(window: &Offscreen, state: &str) {
    let controls = window.controls();
    assert!(controls.len() > 5, "{state}: {controls:?}");
    for control in controls {
        // The keys scroll, too: a bar is for the pointer alone.
        if control.role == Role::ScrollBar {
            continue;
        }
        let is_control = egui::accessibility::is_input(control.role) || control.takes_clicks || control.takes_focus;
        assert!(!is_control || !control.name.trim().is_empty(), "{state}: {control:?} has no name");
    }
}

/// What Tab goes through, until it comes back to where it was.
fn tab_stops(window: &mut Offscreen) -> Vec<Control> {
    let mut stops: Vec<Control> = Vec::new();
    // The canvas is one stop, whichever room it says is picked.
    let is_same = |p: &Control, q: &Control| {
        p.role == q.role && p.rect.min.distance(q.rect.min) < 2.0 && (p.name == q.name || p.role == Role::Canvas)
    };
    for _ in 0..400 {
        key(window, Key::Tab);
        let Some(control) = window.focused() else { continue };
        match stops.iter().rposition(|stop| is_same(stop, &control)) {
            // Tab goes from room to room there.
            Some(at) if at + 1 == stops.len() && control.role == Role::Canvas => {}
            Some(_) => return stops,
            None => stops.push(control),
        }
    }
    panic!("Tab goes on and on: {:?}", stops.iter().map(|stop| &stop.name).collect::<Vec<_>>());
}

/// Every control that can be pressed is one of the stops. `is_covered`: what a dialog lies over.
fn check_reach(window: &mut Offscreen, state: &str, is_covered: impl Fn(&Control) -> bool) {
    check_names(window, state);
    // Before Tab goes through the plan's rooms, which changes what can be done.
    let controls = window.controls();
    let stops = tab_stops(window);
    let names: Vec<&str> = stops.iter().map(|stop| stop.name.as_str()).collect();
    for control in controls.into_iter().filter(|control| control.role != Role::ScrollBar) {
        // Text that can be marked takes clicks, too.
        let is_text = control.role == Role::Label;
        let is_wanted =
            control.takes_clicks && control.is_enabled && !is_text && !is_room(&control) && !is_covered(&control);
        let is_it = |stop: &&Control| stop.name == control.name || stop.rect == control.rect;
        let is_reached = stops.iter().filter(is_it).any(|stop| stop.role == control.role);
        assert!(!is_wanted || is_reached, "{state}: {control:?} is not among {names:?}");
    }
    for stop in stops {
        assert!(!is_covered(&stop), "{state}: {stop:?} lies under a dialog and gets the keyboard");
    }
}

#[test]
fn every_control_has_a_name_and_is_reached() {
    let mut window = Offscreen::new(OffscreenOptions::default());
    window.settle().unwrap();
    let nothing = |_: &Control| false;
    check_reach(&mut window, "welcome", nothing);
    window.open_bundled("dwelling");
    window.settle().unwrap();
    check_reach(&mut window, "plan", nothing);
    // Escape takes the keyboard from everything, so that Tab begins at the top.
    key(&mut window, Key::Escape);
    window.run_command_with("pick", &["Study"]).unwrap();
    window.run_command("label-hall");
    window.settle().unwrap();
    assert!(window.control("Clear label").is_some());
    check_reach(&mut window, "room", nothing);
    key(&mut window, Key::Escape);
    let plan = window.app().plan().unwrap().clone();
    let (opening, _) = plan.openings().find(|(_, opening)| opening.kind.is_passable()).unwrap();
    window.run_command_with("pick-opening", &[&opening.to_string()]).unwrap();
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Opening(opening)));
    check_reach(&mut window, "opening", nothing);
    key(&mut window, Key::Escape);
    window.open(Path::new("/nowhere/plan.xml"));
    window.settle().unwrap();
    assert!(window.control("Dismiss message").is_some());
    check_reach(&mut window, "message", nothing);
    // In a small window, where much has to be scrolled.
    key(&mut window, Key::Escape);
    window.resize(640, 420);
    window.settle().unwrap();
    check_reach(&mut window, "small", nothing);
}

/// Dialogs keep the keyboard to themselves until Escape leaves them.
#[test]
fn dialogs_are_reached_and_left() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import/cases/groups.xml");
    let mut window = Offscreen::new(OffscreenOptions::default());
    window.open(&path);
    window.settle().unwrap();
    let under: Vec<Control> = window.controls();
    let is_covered = |control: &Control| {
        under.iter().any(|other| other.name == control.name && other.role == control.role && other.rect == control.rect)
    };
    for (command, sign) in
        [("shortcuts", "Search shortcuts"), ("about", "Version 0.1.0"), ("import-notes", "Import notes")]
    {
        if !window.run_command(command) {
            assert_eq!(command, "import-notes", "there may be nothing to note");
            continue;
        }
        window.settle().unwrap();
        assert!(window.controls().iter().any(|control| control.name.starts_with(sign)), "{command}");
        check_reach(&mut window, command, is_covered);
        key(&mut window, Key::Escape);
        assert!(!window.controls().iter().any(|control| control.name.starts_with(sign)), "Escape leaves {command}");
    }
    window.run_command("next-room");
    window.run_command("label-hall");
    window.run_command("label-small");
    window.settle().unwrap();
    let under: Vec<Control> = window.controls();
    let is_covered = |control: &Control| {
        under.iter().any(|other| other.name == control.name && other.role == control.role && other.rect == control.rect)
    };
    window.ask_to_close();
    window.settle().unwrap();
    check_reach(&mut window, "question", is_covered);
    key(&mut window, Key::Escape);
    assert!(window.control("Don't save").is_none());
    // The palette has one stop, its text; arrows go through its lines.
    for (command, argument) in [("commands", false), ("find-room", true)] {
        window.run_command(command);
        window.settle().unwrap();
        check_names(&window, command);
        for _ in 0..3 {
            key(&mut window, Key::Tab);
            assert_eq!(window.focused().map(|control| control.role), Some(Role::TextInput), "{command}");
        }
        let lines = |window: &Offscreen| -> Vec<Control> {
            window
                .controls()
                .into_iter()
                .filter(|control| control.rect.width() > 500.0 && control.is_on.is_some())
                .collect()
        };
        let number = lines(&window).len();
        assert!(number >= 2, "{command}");
        let mut seen = std::collections::BTreeSet::new();
        for _ in 0..number {
            seen.extend(lines(&window).into_iter().filter(|line| line.is_on == Some(true)).map(|line| line.name));
            key(&mut window, Key::ArrowDown);
        }
        assert!(seen.len() >= number, "{command}: {seen:?} of {number}, {argument}");
        key(&mut window, Key::Escape);
    }
}

#[test]
fn menus_open_by_keyboard_and_every_entry_is_reached() {
    let mut window = window_with("dwelling");
    click_room(&mut window, "Study");
    for menu in Menu::ALL {
        let before: Vec<String> = window.controls().into_iter().map(|control| control.name).collect();
        // From the start of the window to the menu, and in by Enter.
        let mut is_found = false;
        for _ in 0..400 {
            key(&mut window, Key::Tab);
            is_found = window.focused().is_some_and(|control| control.name == menu.title());
            if is_found {
                break;
            }
        }
        assert!(is_found, "Tab comes to {}", menu.title());
        key(&mut window, Key::Enter);
        check_names(&window, menu.title());
        let entries: Vec<Control> = window
            .controls()
            .into_iter()
            .filter(|control| control.role == Role::MenuItem && control.is_enabled)
            .filter(|control| !before.contains(&control.name) || control.rect.width() > 200.0)
            .collect();
        // Of pictures only the first command, as long as there is none.
        assert!(!entries.is_empty(), "{}: {entries:?}", menu.title());
        let mut reached = Vec::new();
        for _ in 0..60 {
            key(&mut window, Key::Tab);
            reached
                .extend(window.focused().filter(|control| control.role == Role::MenuItem).map(|control| control.name));
        }
        for entry in &entries {
            assert!(reached.contains(&entry.name), "{}: {} is not among {reached:?}", menu.title(), entry.name);
        }
        key(&mut window, Key::Escape);
        let is_open = window.controls().iter().any(|control| control.rect == entries[0].rect);
        assert!(!is_open, "Escape leaves the menu {}", menu.title());
    }
}

#[test]
fn enter_and_space_press_what_has_the_keyboard() {
    let mut window = window_with("dwelling");
    let is_on = |window: &Offscreen| window.control("Graph").unwrap().is_on;
    while window.focused().is_none_or(|control| control.name != "Graph") {
        key(&mut window, Key::Tab);
    }
    for (pressed, expected) in [(Key::Space, true), (Key::Enter, false)] {
        key(&mut window, pressed);
        assert_eq!(is_on(&window), Some(expected), "{pressed:?}");
    }
    // In reading order: menus, tools, plans, layers, inspector, the plan, the line at the bottom.
    let names: Vec<String> = tab_stops(&mut window).into_iter().map(|control| control.name).collect();
    let mut names = [names.clone(), names].concat();
    names.drain(..names.iter().position(|name| name == "File").unwrap());
    let order = ["File", "Help", "Zoom to fit", "Inspector", "Office on a corner", "Fill by label", "Names"];
    let places: Vec<usize> =
        order.iter().map(|wanted| names.iter().position(|name| name == wanted).expect(wanted)).collect();
    // Names of tools and of layers are the same: the first are the tools.
    assert!(places[..6].is_sorted(), "{order:?} are at {places:?} of {names:?}");
    let plan = names.iter().position(|name| name.starts_with("Plan House")).unwrap();
    let zoom = names.iter().position(|name| name == "Zoom out").unwrap();
    assert!(places[5] < plan && plan < zoom, "{names:?}");
}

#[test]
fn one_sees_where_the_keyboard_is() {
    for is_dark in [false, true] {
        let mut window =
            Offscreen::new(OffscreenOptions { width: 900, height: 560, is_dark, ..OffscreenOptions::default() });
        window.open_bundled("dwelling");
        window.settle().unwrap();
        click_room(&mut window, "Study");
        window.run_command("label-hall");
        // From the room's name on, so that its link is passed before other rooms are picked.
        window.run_command("rename");
        window.move_to(egui::pos2(450.0, 1.0));
        window.settle().unwrap();
        let mut before = window.picture();
        let mut seen = Vec::new();
        for _ in 0..90 {
            let was = window.focused();
            key(&mut window, Key::Tab);
            // What has the keyboard is brought into sight.
            window.settle().unwrap();
            let picture = window.picture();
            let focused = window.focused();
            // Within the canvas the picked room changes.
            if let Some(control) = focused.filter(|control| control.name != "Resize panel")
                && was.is_none_or(|was| was.rect != control.rect)
            {
                let part = |picture: &enfilade::picture::Picture, rect: Rect| {
                    let corner = |at: egui::Pos2| [at.x.max(0.0) as u32, at.y.max(0.0) as u32];
                    picture.part(corner(rect.min), corner(rect.max))
                };
                let rect =
                    control.rect.expand(4.0).intersect(Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(900.0, 560.0)));
                let difference = part(&before, rect).difference(&part(&picture, rect));
                let (pixels, largest) = difference.map_or((0, 0), |difference| (difference.pixels, difference.largest));
                assert!(pixels >= 20 && largest >= 50, "{} dark {is_dark}: {pixels} pixels, {largest}", control.name);
                seen.push(control.name);
            }
            before = picture;
        }
        for name in ["File", "Graph", "Function", "Office on a corner", "Name", "Clear label"] {
            assert!(seen.iter().any(|seen| seen == name), "{name} among {seen:?}");
        }
    }
}

#[test]
fn rooms_are_told_with_label_and_area() {
    let mut window = window_with("dwelling");
    let kitchen = window.control("Kitchen").unwrap();
    assert_eq!((kitchen.description.as_str(), kitchen.is_on), ("medium room, kitchen, 13.6 m² clear", Some(false)));
    click_room(&mut window, "Study");
    assert_eq!(
        window.controls().into_iter().find(|control| is_room(control) && control.name == "Study").unwrap().is_on,
        Some(true)
    );
    for (_, room) in window.app().plan().unwrap().rooms() {
        assert!(window.control(&room.name).is_some_and(|control| is_room(&control) || control.name == room.name));
    }
    // With the keyboard on the plan, Ctrl and arrows go from room to room.
    window.key(Modifiers::COMMAND, Key::ArrowDown);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Bedroom"))));
    key(&mut window, Key::Enter);
    assert_eq!(window.focused().map(|control| control.name).as_deref(), Some("Name"));
    key(&mut window, Key::Escape);
    press(&mut window, "Kitchen");
}
