//! The palette: finding commands by a few letters, and running them with the keyboard alone.

use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::labels::Label;

use super::{done, keys, picked, run, type_in, window_with};

/// The lines of the list, as a screen reader says them, and which one Enter takes.
fn lines(window: &Offscreen) -> (Vec<String>, Option<String>) {
    let rows = window.controls().into_iter().filter(|control| control.role == egui::accesskit::Role::ListBoxOption);
    // The plan's own rooms and the list of plans lie under the palette.
    let rows: Vec<_> = rows.filter(|control| control.rect.height() == 28.0 && control.rect.width() > 500.0).collect();
    let chosen = rows.iter().find(|control| control.is_on == Some(true)).map(|control| control.name.clone());
    (rows.into_iter().map(|control| control.name).collect(), chosen)
}

fn open(window: &mut Offscreen, query: &str) {
    keys(window, "Ctrl+Shift+P");
    type_in(window, query);
}

fn is_open(window: &Offscreen) -> bool {
    !lines(window).0.is_empty() || window.control("Find a command").is_some()
}

#[test]
fn a_few_letters_and_enter() {
    let mut window = window_with("dwelling");
    window.watch_commands(true);
    open(&mut window, "zoin");
    assert_eq!(lines(&window).1.as_deref(), Some("Zoom in, View"));
    keys(&mut window, "Enter");
    assert!(!is_open(&window));
    // By the menu's name and by the id's words, too.
    open(&mut window, "view grid");
    assert_eq!(lines(&window).0[0], "Grid, View");
    keys(&mut window, "Enter");
    assert_eq!(done(&mut window), ["zoom-in", r#"grid "off""#]);
    // What was done last comes first, with what cannot be done at the end.
    keys(&mut window, "Ctrl+Shift+P");
    let (all, chosen) = lines(&window);
    assert_eq!(all[..2], ["Grid, View", "Zoom in, View"]);
    assert_eq!(chosen.as_deref(), Some("Grid, View"));
    // Up goes round to the end, where a reason stands.
    keys(&mut window, "Up");
    let last = lines(&window).1.unwrap();
    assert!(last.contains("not available: "), "{last}");
    keys(&mut window, "Enter");
    assert!(is_open(&window), "what cannot be done does nothing");
    keys(&mut window, "Escape");
    assert!(!is_open(&window));
    assert_eq!(done(&mut window), Vec::<String>::new());
}

#[test]
fn letters_go_to_the_text_and_to_nothing_else() {
    let mut window = window_with("dwelling");
    run(&mut window, "pick", &["Study"]);
    keys(&mut window, "Ctrl+Shift+P");
    for key in ["H", "G", "F", "Questionmark", "F2", "Ctrl+Z", "Tab", "PageDown"] {
        keys(&mut window, key);
    }
    assert_eq!(picked(&window).label, None);
    assert!(is_open(&window));
    type_in(&mut window, "hall");
    assert_eq!(lines(&window).1.as_deref(), Some("Hall, Room"));
    keys(&mut window, "Enter");
    assert_eq!(picked(&window).label.unwrap().label, Label::Hall);
}

#[test]
fn what_a_command_needs_is_asked_in_place() {
    let mut window = Offscreen::new(OffscreenOptions::default());
    window.settle().unwrap();
    window.watch_commands(true);
    // One of some.
    open(&mut window, "sample");
    keys(&mut window, "Enter");
    let (samples, chosen) = lines(&window);
    assert_eq!(samples.len(), 3, "{samples:?}");
    assert_eq!(chosen.as_deref(), Some(samples[0].as_str()));
    type_in(&mut window, "house");
    keys(&mut window, "Enter");
    // A room, with its label and area; the plan's own order, from the top left.
    keys(&mut window, "Ctrl+F");
    let (rooms, _) = lines(&window);
    assert_eq!(rooms[0], "Utility, small room, 9.0 m²", "{rooms:?}");
    type_in(&mut window, "stu");
    assert_eq!(lines(&window).1.as_deref(), Some("Study, medium room, 16.5 m²"));
    keys(&mut window, "Enter");
    assert_eq!(picked(&window).name, "Study");
    // A text, which is there to be changed.
    open(&mut window, "rename the plan");
    keys(&mut window, "Enter");
    keys(&mut window, "End");
    type_in(&mut window, " II");
    keys(&mut window, "Enter");
    // Two things one after the other; what is wrong is said and can be mended.
    open(&mut window, "set a shortcut");
    keys(&mut window, "Enter");
    type_in(&mut window, "typology");
    keys(&mut window, "Enter");
    type_in(&mut window, "Hyper");
    keys(&mut window, "Enter");
    assert!(window.control("Expected keys such as 'Ctrl+Shift+K', 'F5' or 'Plus'").is_some());
    keys(&mut window, "Ctrl+A");
    type_in(&mut window, "Ctrl+T");
    keys(&mut window, "Enter");
    // A command that asks in its own way does so.
    open(&mut window, "rename");
    keys(&mut window, "Enter");
    type_in(&mut window, "s");
    keys(&mut window, "Enter");
    assert_eq!(
        done(&mut window),
        [
            r#"open-sample "dwelling""#,
            r#"find-room "Study""#,
            r#"rename-plan "House with an enfilade II""#,
            r#"set-shortcut "set-typology" "Ctrl+T""#,
            r#"rename "s""#,
        ]
    );
}

#[test]
fn escape_goes_one_step_back() {
    let mut window = window_with("dwelling");
    open(&mut window, "typology");
    keys(&mut window, "Enter");
    assert!(window.control("House").is_some() || lines(&window).0.contains(&"House".to_owned()));
    keys(&mut window, "Escape");
    assert!(window.control("Find a command").is_some());
    keys(&mut window, "Escape");
    assert!(!is_open(&window));
    // Asked for from elsewhere, there is nothing to go back to.
    keys(&mut window, "Ctrl+F");
    assert!(is_open(&window));
    keys(&mut window, "Escape");
    assert!(!is_open(&window));
    // A click beside leaves.
    keys(&mut window, "Ctrl+Shift+P");
    window.click(egui::pos2(20.0, 700.0));
    window.settle().unwrap();
    assert!(!is_open(&window));
}

/// A plan of thousands of rooms is found in as quickly.
#[test]
fn nothing_fits_and_much_fits() {
    let mut window = window_with("school");
    open(&mut window, "xyzzy");
    assert_eq!(lines(&window).0, Vec::<String>::new());
    assert!(window.control("No command fits ‘xyzzy’").is_some());
    keys(&mut window, "Enter");
    assert!(is_open(&window));
    keys(&mut window, "Escape");
    keys(&mut window, "Ctrl+F");
    for _ in 0..3 {
        keys(&mut window, "PageDown");
    }
    let chosen = lines(&window).1.expect("the chosen line is in sight");
    assert_eq!(chosen, *lines(&window).0.last().unwrap());
}
