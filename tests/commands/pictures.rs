//! The looks of the palette and the sheet of shortcuts, in both themes and at both scales: snapshots of
//! just them.

use std::path::Path;

use egui::{Key, Modifiers};
use enfilade::app::{Offscreen, OffscreenOptions};

use super::{keys, press, run, type_in};
use crate::support;

fn window(options: OffscreenOptions) -> Offscreen {
    let mut window = Offscreen::new(options);
    window.open_bundled("dwelling");
    window.settle().unwrap();
    window
}

fn light() -> Offscreen {
    window(OffscreenOptions::default())
}

fn dark() -> Offscreen {
    window(OffscreenOptions { is_dark: true, ..OffscreenOptions::default() })
}

fn twice() -> Offscreen {
    window(OffscreenOptions { width: 640, height: 440, scale: 2.0, ..OffscreenOptions::default() })
}

/// Compares what is in front with the picture of this name.
fn assert_picture(name: &str, window: &mut Offscreen) {
    let front = window.front_rect().expect("something is in front");
    let picture = window.picture_of(front).to_png().unwrap();
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/commands").join(format!("{name}.png"));
    support::assert_picture(&reference, &picture);
}

#[test]
fn palette_with_what_was_done_last() {
    let mut window = light();
    for query in ["fill by f", "graph"] {
        keys(&mut window, "Ctrl+Shift+P");
        type_in(&mut window, query);
        window.key(Modifiers::NONE, Key::Enter);
        window.settle().unwrap();
    }
    keys(&mut window, "Ctrl+Shift+P");
    assert_picture("palette", &mut window);
}

#[test]
fn palette_with_a_few_letters_in_the_dark() {
    let mut window = dark();
    keys(&mut window, "Ctrl+Shift+P");
    type_in(&mut window, "zo sel");
    assert_picture("palette-query-dark", &mut window);
}

#[test]
fn palette_with_nothing_that_fits() {
    let mut window = twice();
    keys(&mut window, "Ctrl+Shift+P");
    type_in(&mut window, "xyzzy");
    assert_picture("palette-no-match-200", &mut window);
}

#[test]
fn palette_asking_for_a_room() {
    let mut window = light();
    run(&mut window, "pick", &["Study"]);
    run(
        &mut window,
        "rename",
        &["A study with a name so long that no list of any width has space for it, whatever one does"],
    );
    keys(&mut window, "Ctrl+F");
    type_in(&mut window, "st");
    keys(&mut window, "Down");
    assert_picture("palette-room", &mut window);
}

#[test]
fn palette_refusing_what_was_typed() {
    let mut window = dark();
    run(&mut window, "zoom-to", &["1.5", "2"]);
    type_in(&mut window, "wide");
    keys(&mut window, "Enter");
    assert_picture("palette-argument-dark", &mut window);
}

#[test]
fn sheet() {
    let mut window = light();
    run(&mut window, "set-shortcut", &["graph", "Ctrl+Alt+G"]);
    run(&mut window, "remove-shortcut", &["grid"]);
    keys(&mut window, "F1");
    assert_picture("sheet", &mut window);
}

#[test]
fn sheet_with_a_clash_in_the_dark() {
    let mut window = dark();
    keys(&mut window, "F1");
    press(&mut window, "Shortcut of Zoom to fit: F");
    keys(&mut window, "Ctrl+O");
    assert_picture("sheet-clash-dark", &mut window);
}

#[test]
fn sheet_in_a_small_window_searched() {
    let mut window = twice();
    keys(&mut window, "F1");
    type_in(&mut window, "room");
    assert_picture("sheet-search-200", &mut window);
}

#[test]
fn about() {
    let mut window = dark();
    window.resize(800, 600);
    run(&mut window, "about", &[]);
    assert_picture("about-dark", &mut window);
}
