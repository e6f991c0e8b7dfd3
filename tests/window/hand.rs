//! What the hand means: keys, menus, the view, and things changed where they are.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use enfilade::app::commands::{COMMANDS, Menu};
use enfilade::app::{Control, Offscreen, OffscreenOptions};
use enfilade::edit::beside_opening;
use enfilade::geometry::Point;
use enfilade::plan::{ElementId, OpeningId, OpeningKind};

use super::{click_room, middle_of, press, room, texts, window_with};

fn key(window: &mut Offscreen, modifiers: Modifiers, key: Key) {
    window.key(modifiers, key);
    window.settle().unwrap();
}

fn run(window: &mut Offscreen, id: &str, words: &[&str]) {
    window.run_command_with(id, words).unwrap();
    window.settle().unwrap();
}

fn at(window: &Offscreen, x_m: f64, y_m: f64) -> Pos2 {
    window.app().screen_position(x_m, y_m).unwrap()
}

fn names(window: &Offscreen) -> Vec<String> {
    window.controls().into_iter().map(|control| control.name).collect()
}

#[test]
fn drawing_moves_no_view() {
    let mut window = window_with("dwelling");
    let before = (at(&window, 0.0, 0.0), at(&window, 10.0, 5.0));
    // Far beyond what is seen, and a bar that comes up.
    run(&mut window, "draw-room", &["40,40 60,40 60,60 40,60"]);
    assert_eq!((at(&window, 0.0, 0.0), at(&window, 10.0, 5.0)), before);
    run(&mut window, "undo", &[]);
    assert_eq!((at(&window, 0.0, 0.0), at(&window, 10.0, 5.0)), before);
    window.drop_file(std::path::Path::new("nowhere.plan.json"));
    window.settle().unwrap();
    assert_eq!(texts(&window).len(), 1, "{:?}", texts(&window));
    assert_eq!((at(&window, 0.0, 0.0), at(&window, 10.0, 5.0)), before);
    // Asked for, it moves.
    run(&mut window, "redo", &[]);
    run(&mut window, "fit", &[]);
    assert_ne!((at(&window, 0.0, 0.0), at(&window, 10.0, 5.0)), before);
}

#[test]
fn bars_belong_to_a_plan_and_go_when_they_are_no_longer_so() {
    let mut window = window_with("dwelling");
    window.drop_file(std::path::Path::new("nowhere.plan.json"));
    window.settle().unwrap();
    assert_eq!(texts(&window).len(), 1, "{:?}", texts(&window));
    run(&mut window, "open-sample", &["office"]);
    assert_eq!(texts(&window), Vec::<String>::new());
    // Refused as the plan stands; the next change may have made room for it.
    press(&mut window, "Room");
    window.key(Modifiers::NONE, Key::Escape);
    window.settle().unwrap();
    run(&mut window, "new-plan", &[]);
    run(&mut window, "draw-room", &["0,0 4,0 4,3 0,3"]);
    assert_eq!(texts(&window), Vec::<String>::new());
}

#[test]
fn a_key_right_after_a_room_is_drawn_means_it() {
    let mut window = window_with("dwelling");
    run(&mut window, "new-plan", &[]);
    window.settle().unwrap();
    let function = |window: &Offscreen, index: usize| {
        let rooms: Vec<String> = window.app().plan().unwrap().rooms().map(|(_, room)| room.name.clone()).collect();
        rooms.get(index).cloned()
    };
    key(&mut window, Modifiers::NONE, Key::R);
    let corners = [(at(&window, -4.0, -2.0), at(&window, 0.0, 1.0)), (at(&window, 3.0, -2.0), at(&window, 0.0, 1.0))];
    for (from, to) in corners {
        window.click(from);
        window.click(to);
        window.settle().unwrap();
    }
    // The pointer stands on the corner of both; the second was drawn last.
    key(&mut window, Modifiers::NONE, Key::H);
    let plan = window.app().plan().unwrap();
    let labelled: Vec<_> = plan.rooms().filter(|(_, room)| room.label.is_some()).collect();
    assert_eq!(labelled.len(), 1);
    let middle = enfilade::geometry::Bounds::of(plan.ring_points(&labelled[0].1.outer)).center();
    assert!(middle.x > 0.0, "the room on the right was drawn last: {middle:?}");
    key(&mut window, Modifiers::NONE, Key::F2);
    window.text("New");
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!([function(&window, 0), function(&window, 1)].contains(&Some("New".to_owned())));
    // Pointing at another room means that one, as ever.
    run(&mut window, "tool-select", &[]);
    run(&mut window, "clear-selection", &[]);
    window.move_to(at(&window, -2.0, 0.0));
    key(&mut window, Modifiers::NONE, Key::C);
    let labelled = window.app().plan().unwrap().rooms().filter(|(_, room)| room.label.is_some()).count();
    assert_eq!(labelled, 2);
}

/// A door of the dwelling that hangs on a hinge, and the middle of its arc on the screen.
fn hinged(window: &Offscreen) -> (OpeningId, Pos2) {
    let plan = window.app().plan().unwrap();
    let schemes = enfilade::labels::Schemes::bundled();
    let drawing = enfilade::draw::Drawing::new(plan, enfilade::pipeline::Pipeline::new(plan, &schemes).analysis());
    let is_free = |point: Point| plan.walls().all(|(_, wall)| plan.wall_segment(wall).unwrap().distance(point) > 0.25);
    let is_single = |id: OpeningId| plan.opening(id).unwrap().kind == OpeningKind::Door;
    let found = drawing.sweeps().filter(|(id, _)| is_single(*id)).find_map(|(id, [hinge, shut, tip])| {
        let (open, shut) = (tip - hinge, shut - hinge);
        let arc = hinge + (open + shut) * std::f64::consts::FRAC_1_SQRT_2;
        is_free(arc).then_some((id, arc))
    });
    let (id, arc) = found.unwrap();
    (id, at(window, arc.x, arc.y))
}

#[test]
fn doors_are_caught_by_their_arc_and_flipped_by_space() {
    let mut window = window_with("dwelling");
    let (door, arc) = hinged(&window);
    window.click(arc);
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Opening(door)));
    let swing = |window: &Offscreen| window.app().plan().unwrap().opening(door).unwrap().swing;
    let mut seen = Vec::new();
    for _ in 0..4 {
        window.hold(Key::Space, true);
        window.hold(Key::Space, false);
        window.settle().unwrap();
        let now = swing(&window).unwrap();
        assert!(!seen.contains(&now), "{now:?} again");
        seen.push(now);
    }
    // Space and a drag pans, and flips nothing.
    let last = swing(&window);
    window.hold(Key::Space, true);
    window.drag(PointerButton::Primary, arc, arc + vec2(40.0, 0.0));
    window.hold(Key::Space, false);
    window.settle().unwrap();
    assert_eq!(swing(&window), last);
    run(&mut window, "undo", &[]);
    assert_eq!(swing(&window), Some(seen[2]));
}

#[test]
fn an_opening_has_grips() {
    let mut window = window_with("dwelling");
    run(&mut window, "new-plan", &[]);
    run(&mut window, "draw-room", &["-4,-2 4,-2 4,2 -4,2", "exact", "0.2m"]);
    run(&mut window, "add-opening", &["window", "0,-2", "1m"]);
    let id = window.app().plan().unwrap().openings().next().unwrap().0;
    run(&mut window, "select", &[&id.to_string()]);
    let segment = |window: &Offscreen| {
        let plan = window.app().plan().unwrap();
        plan.opening_segment(plan.opening(id).unwrap()).unwrap()
    };
    let ends = |window: &Offscreen| {
        let segment = segment(window);
        [segment.a.x.min(segment.b.x), segment.a.x.max(segment.b.x)].map(|x| (x * 1e4).round() / 1e4)
    };
    assert_eq!(ends(&window), [-0.5, 0.5]);
    // The right end to the right: the left one stays.
    let (from, to) = (at(&window, 0.5, -2.0), at(&window, 1.3, -1.9));
    window.drag(PointerButton::Primary, from, to);
    window.settle().unwrap();
    let [left, right] = ends(&window);
    assert!(left == -0.5 && (1.25..=1.35).contains(&right), "{left} {right}");
    // The width is round.
    assert!(((right - left) * 100.0 - ((right - left) * 100.0).round()).abs() < 0.02, "{}", right - left);
    // The middle slides it.
    let width = right - left;
    let (from, to) = (at(&window, (left + right) / 2.0, -2.0), at(&window, -2.0, -2.0));
    window.drag(PointerButton::Primary, from, to);
    window.settle().unwrap();
    let [left, right] = ends(&window);
    assert!((right - left - width).abs() < 1e-3 && ((left + right) / 2.0 + 2.0).abs() < 0.05, "{left} {right}");
    // Its place is a field: so far from the face of the wall on its left.
    let word = if segment(&window).a.x < segment(&window).b.x { "start" } else { "end" };
    run(&mut window, "set-opening-distance", &["0.5m", word]);
    let [left, _] = ends(&window);
    assert!((left - (-4.0 + 0.1 + 0.5)).abs() < 1e-3, "{left}");
    let plan = window.app().plan().unwrap();
    let nearest = beside_opening(plan, id).unwrap().map(|beside| beside.distance_m);
    assert!(nearest.iter().any(|distance_m| (distance_m - 0.5).abs() < 1e-3), "{nearest:?}");
}

#[test]
fn arrows_nudge_and_undo_at_once() {
    let mut window = window_with("dwelling");
    run(&mut window, "new-plan", &[]);
    run(&mut window, "draw-room", &["-4,-2 4,-2 4,2 -4,2"]);
    let room_id = window.app().plan().unwrap().rooms().next().unwrap().0;
    let left = |window: &Offscreen| {
        let plan = window.app().plan().unwrap();
        let points = plan.ring_points(&plan.room(room_id).unwrap().outer);
        points.into_iter().map(|point| point.x).fold(f64::INFINITY, f64::min)
    };
    let before = window.app().plan().unwrap().clone();
    window.click(at(&window, 0.0, 0.0));
    window.settle().unwrap();
    assert_eq!(window.app().picked(), Some(ElementId::Room(room_id)));
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    let step = left(&window) + 4.0;
    assert!(step > 0.0);
    key(&mut window, Modifiers::SHIFT, Key::ArrowRight);
    assert!((left(&window) + 4.0 - 11.0 * step).abs() < 1e-3, "{}", left(&window));
    key(&mut window, Modifiers::ALT, Key::ArrowLeft);
    assert!((left(&window) + 4.0 - 10.9 * step).abs() < 1e-3, "{}", left(&window));
    key(&mut window, Modifiers::COMMAND, Key::Z);
    assert_eq!(window.app().plan(), Some(&before));
}

#[test]
fn a_wall_gets_its_length_and_the_chosen_end_moves() {
    let mut window = window_with("dwelling");
    run(&mut window, "new-plan", &[]);
    run(&mut window, "draw-room", &["0,0 4,0 4,3 0,3"]);
    let plan = window.app().plan().unwrap();
    let (lower, wall) = plan.walls().find(|(_, wall)| plan.wall_segment(wall).unwrap().midpoint().y == 0.0).unwrap();
    let is_right = plan.wall_segment(wall).unwrap().b.x > 2.0;
    run(&mut window, "select", &[&lower.to_string()]);
    run(&mut window, "set-wall-length", &["5m", if is_right { "end" } else { "start" }]);
    let bounds = window.app().plan().unwrap().bounds();
    assert_eq!((bounds.min, bounds.max), (Point::new(0.0, 0.0), Point::new(5.0, 3.0)));
    // The room is a rectangle still.
    let area = |window: &Offscreen| {
        let plan = window.app().plan().unwrap();
        let (_, room) = plan.rooms().next().unwrap();
        enfilade::geometry::polygon::signed_area(&plan.ring_points(&room.outer)).abs()
    };
    assert_eq!(area(&window), 15.0);
    run(&mut window, "set-wall-length", &["6m", if is_right { "start" } else { "end" }]);
    assert_eq!(window.app().plan().unwrap().bounds().min, Point::new(-1.0, 0.0));
    assert_eq!(area(&window), 18.0);
}

#[test]
fn every_kind_of_thing_has_a_context_menu() {
    let mut window = window_with("dwelling");
    let open = |window: &mut Offscreen, place: Pos2| {
        window.clicks(PointerButton::Secondary, place, 1);
        window.settle().unwrap();
        let seen = names(window);
        key(window, Modifiers::NONE, Key::Escape);
        seen
    };
    let has = |seen: &[String], name: &str| seen.iter().filter(|seen| *seen == name).count();
    // A room: what was not selected is, and keeps so.
    let place = middle_of(&window, "Study");
    let seen = open(&mut window, place);
    assert_eq!(window.app().picked(), Some(ElementId::Room(room(&window, "Study"))));
    assert!(has(&seen, "Rename…") == 1 && has(&seen, "Hall") >= 1 && has(&seen, "Flip") == 0, "{seen:?}");
    let (door, arc) = hinged(&window);
    let seen = open(&mut window, arc);
    assert_eq!(window.app().picked(), Some(ElementId::Opening(door)));
    assert!(
        has(&seen, "Flip") == 1 && has(&seen, "Width of opening…") == 1 && has(&seen, "Merge rooms") == 0,
        "{seen:?}"
    );
    let plan = window.app().plan().unwrap();
    let free = plan.walls().find_map(|(id, wall)| {
        let middle = plan.wall_segment(wall)?.midpoint();
        let is_beside = plan.openings().all(|(_, it)| plan.opening_segment(it).unwrap().distance(middle) > 0.7);
        is_beside.then_some((id, middle))
    });
    let (wall, middle) = free.unwrap();
    let place = at(&window, middle.x, middle.y);
    let seen = open(&mut window, place);
    assert_eq!(window.app().picked(), Some(ElementId::Wall(wall)));
    assert!(has(&seen, "Thickness…") == 1 && has(&seen, "Length of wall…") == 1, "{seen:?}");
    // Several, which stay selected.
    click_room(&mut window, "Study");
    window.hold_modifiers(Modifiers::SHIFT);
    window.click(middle_of(&window, "Kitchen"));
    window.hold_modifiers(Modifiers::NONE);
    let place = middle_of(&window, "Kitchen");
    let seen = open(&mut window, place);
    assert_eq!(window.app().selection().len(), 2);
    assert!(has(&seen, "Merge rooms") == 1 && has(&seen, "Rename…") == 0, "{seen:?}");
    // Free space, and what is selected stays so.
    let place = super::beside(&window);
    let seen = open(&mut window, place);
    assert!(has(&seen, "Select all") == 1 && has(&seen, "Merge rooms") == 0, "{seen:?}");
    let plan = window.app().plan().unwrap();
    let bounds = plan.bounds();
    let far = at(&window, bounds.max.x + 0.5, bounds.max.y + 0.5);
    run(&mut window, "pick", &["Study"]);
    window.hold_modifiers(Modifiers::SHIFT);
    for name in ["Kitchen", "Gallery"] {
        let place = middle_of(&window, name);
        window.click(place);
    }
    window.hold_modifiers(Modifiers::NONE);
    assert_eq!(window.app().selection().len(), 3);
    let seen = open(&mut window, far);
    assert!(has(&seen, "Select all") == 1 && has(&seen, "Merge rooms") == 0, "{seen:?}");
    // The list.
    // The title of the window has the name, too.
    let row_of = |window: &Offscreen, name: &str| {
        let is_row = |control: &Control| control.role == Role::ListBoxOption && control.name == name;
        window.controls().into_iter().find(is_row).unwrap().rect.center()
    };
    let row = row_of(&window, "House with an enfilade");
    let seen = open(&mut window, row);
    assert!(has(&seen, "Save as…") == 1 && has(&seen, "Close plan") == 1, "{seen:?}");
    let row = row_of(&window, "School round a court");
    window.clicks(PointerButton::Secondary, row, 1);
    window.settle().unwrap();
    // A section of the list has the same name.
    let open = window.controls().into_iter().rfind(|control| control.name == "Open").unwrap();
    window.click(open.rect.center());
    window.settle().unwrap();
    assert_eq!(window.app().plan().unwrap().meta().name, "School round a court");
}

#[test]
fn a_double_click_changes_a_thing_where_it_is() {
    let mut window = window_with("dwelling");
    let place = middle_of(&window, "Study");
    window.clicks(PointerButton::Primary, place, 2);
    window.settle().unwrap();
    window.text("Den");
    key(&mut window, Modifiers::NONE, Key::Enter);
    let den = room(&window, "Den");
    assert_eq!(window.app().picked(), Some(ElementId::Room(den)));
    assert!(window.control("Name here").is_none());
    run(&mut window, "undo", &[]);
    assert_eq!(room(&window, "Study"), den);
    // A door's width.
    let (door, arc) = hinged(&window);
    window.clicks(PointerButton::Primary, arc, 2);
    window.settle().unwrap();
    window.text("0.77");
    key(&mut window, Modifiers::NONE, Key::Enter);
    let plan = window.app().plan().unwrap();
    let width_m = plan.opening_segment(plan.opening(door).unwrap()).unwrap().length();
    assert!((width_m - 0.77).abs() < 1e-3, "{width_m}");
    // Escape leaves it as it was.
    let place = middle_of(&window, "Study");
    window.clicks(PointerButton::Primary, place, 2);
    window.settle().unwrap();
    window.text("Nothing");
    key(&mut window, Modifiers::NONE, Key::Escape);
    assert_eq!(room(&window, "Study"), den);
}

#[test]
fn menus_fit_and_are_reached_by_keys() {
    for (width, height) in [(1024, 768), (1280, 500), (1280, 800)] {
        let mut window = Offscreen::new(OffscreenOptions { width, height, ..OffscreenOptions::default() });
        window.open_bundled("dwelling");
        window.settle().unwrap();
        for menu in Menu::ALL {
            press(&mut window, menu.title());
            let rect = window.front_rect().unwrap_or_else(|| panic!("{menu:?} does not open"));
            let button = window.control(menu.title()).unwrap().rect;
            assert!(
                rect.bottom() <= height as f32 && rect.top() >= button.bottom() - 1.0,
                "{menu:?} {rect:?} {button:?}"
            );
            assert!(!rect.contains(window.pointer()), "{menu:?} opens under the pointer");
            // To its last entry, by the keyboard: that comes into view.
            let last = COMMANDS.iter().rfind(|command| command.menu.is_some_and(|(of, _)| of == menu));
            key(&mut window, Modifiers::NONE, Key::ArrowUp);
            let focused = window.focused().unwrap();
            assert!(
                rect.expand(1.0).contains_rect(focused.rect),
                "{menu:?} {focused:?} {last:?}",
                last = last.map(|it| it.id)
            );
            key(&mut window, Modifiers::NONE, Key::Escape);
        }
    }
    let mut window = window_with("dwelling");
    let open = |window: &Offscreen| {
        let has = |name: &str| window.controls().iter().any(|control| control.name == name);
        [
            ("Save as…", "File"),
            ("Rename the plan…", "Edit"),
            ("Follow the system", "View"),
            ("Select by label…", "Modify"),
        ]
        .into_iter()
        .filter(|(entry, _)| has(entry) && window.front_rect().is_some())
        .map(|(_, menu)| menu)
        .collect::<Vec<_>>()
    };
    key(&mut window, Modifiers::NONE, Key::F10);
    assert_eq!(open(&window), ["File"]);
    key(&mut window, Modifiers::NONE, Key::ArrowRight);
    assert_eq!(open(&window), ["Edit"]);
    key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    key(&mut window, Modifiers::NONE, Key::ArrowLeft);
    assert_eq!(open(&window), Vec::<&str>::new(), "Help");
    key(&mut window, Modifiers::NONE, Key::F10);
    assert!(window.front_rect().is_none());
    window.key(Modifiers::ALT, Key::M);
    window.text("m");
    window.settle().unwrap();
    assert_eq!(open(&window), ["Modify"]);
    // Its first entry has the keyboard, and Enter chooses it.
    assert_eq!(window.focused().map(|control| control.name).as_deref(), Some("Select all"));
    key(&mut window, Modifiers::NONE, Key::Enter);
    assert!(window.app().selection().len() > 10);
    assert_eq!(window.front_rect(), None);
    // Alt alone goes to the bar.
    window.hold(Key::AltLeft, true);
    window.hold(Key::AltLeft, false);
    window.settle().unwrap();
    assert_eq!(window.focused().map(|control| control.name).as_deref(), Some("File"));
}

#[test]
fn a_new_door_is_flipped_by_space() {
    let mut window = window_with("dwelling");
    run(&mut window, "new-plan", &[]);
    run(&mut window, "draw-room", &["-4,-2 4,-2 4,2 -4,2"]);
    key(&mut window, Modifiers::NONE, Key::D);
    let place = at(&window, 0.0, -1.9);
    window.click(place);
    window.settle().unwrap();
    let swing = |window: &Offscreen| {
        let (_, opening) = window.app().plan().unwrap().openings().next().unwrap();
        assert_eq!(opening.kind, OpeningKind::Door);
        opening.swing
    };
    let before = swing(&window);
    window.hold(Key::Space, true);
    window.hold(Key::Space, false);
    window.settle().unwrap();
    assert_ne!(swing(&window), before);
}
