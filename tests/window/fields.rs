//! Every text field keeps every letter, in order, on however slow a machine: when a frame takes half a second, all that
//! was typed and clicked meanwhile comes at once.

use std::collections::BTreeSet;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use enfilade::app::{Control, Offscreen, OffscreenOptions};
use enfilade::plan::ElementId;

use super::{press, room, window_with};

/// The text fields that are shown.
fn fields(window: &Offscreen) -> Vec<Control> {
    let is_field = |control: &Control| control.role == Role::TextInput && control.is_enabled;
    window.controls().into_iter().filter(is_field).collect()
}

fn run(window: &mut Offscreen, id: &str, words: &[&str]) {
    window.run_command_with(id, words).unwrap();
    window.settle().unwrap();
}

/// The bundled plans.
const PLANS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/plans");

/// Brings fields up in a window.
type BringUp = fn(&mut Offscreen);

/// Ways to bring text fields up.
const STATES: &[(&str, BringUp)] = &[
    ("a room", |window| {
        let id = room(window, "Study");
        run(window, "pick", &[&id.to_string()]);
    }),
    ("a room where it is", |window| {
        let id = room(window, "Study");
        run(window, "change-here", &[&id.to_string()]);
    }),
    ("a wall", |window| {
        let wall = window.app().plan().unwrap().walls().next().unwrap().0;
        run(window, "select", &[&wall.to_string()]);
    }),
    ("a wall where it is", |window| {
        let wall = window.app().plan().unwrap().walls().next().unwrap().0;
        run(window, "change-here", &[&wall.to_string()]);
    }),
    ("an opening", |window| {
        let opening = window.app().plan().unwrap().openings().next().unwrap().0;
        run(window, "select", &[&opening.to_string()]);
    }),
    ("a corner", |window| {
        let corner = window.app().plan().unwrap().corners().next().unwrap().0;
        run(window, "select", &[&corner.to_string()]);
    }),
    ("a tool", |window| run(window, "tool-walls", &[])),
    ("the palette", |window| run(window, "commands", &[])),
    ("an argument", |window| run(window, "rename-plan", &[])),
    ("the shortcuts", |window| run(window, "shortcuts", &[])),
    ("naming rooms", |window| run(window, "name-rooms", &[])),
    ("changing rooms", |window| run(window, "change-rooms", &[])),
    ("exporting", |window| run(window, "export", &[])),
    ("a finding", |window| {
        run(window, "findings", &["on"]);
        run(window, "draw-walls", &["20,0 24,0"]);
        press(window, "Ignore…");
    }),
    ("a folder of plans", |window| run(window, "open-workspace", &[PLANS])),
    ("training", |window| run(window, "train", &[])),
    ("label schemes", |window| run(window, "schemes", &[])),
    ("a review", |window| {
        window.open(Path::new(PLANS));
        window.settle().unwrap();
        run(window, "review-labels", &[]);
    }),
    ("a table of rooms", |window| {
        window.open(Path::new(PLANS));
        window.settle().unwrap();
        run(window, "export-dataset", &[]);
    }),
];

const TEXT: [&str; 5] = ["Kitc", "h", "en nu", "mber", " 3 & ü"];

#[test]
fn every_field_keeps_every_letter() {
    let mut seen: BTreeSet<String> = BTreeSet::new();
    for (state, bring_up) in STATES {
        let mut window = window_with("dwelling");
        bring_up(&mut window);
        let names: Vec<String> = fields(&window).into_iter().map(|field| field.name).collect();
        assert!(!names.is_empty(), "{state} shows no field");
        for name in names {
            let mut window = window_with("dwelling");
            bring_up(&mut window);
            let find = |window: &Offscreen| fields(window).into_iter().find(|field| field.name == name);
            let before = window.app().plan().unwrap().clone();
            let field = find(&window).unwrap_or_else(|| panic!("{state}: no field {name}"));
            // A click into it, all that stood there, letters: in one frame.
            window.be_slow();
            // One that has the keyboard already may be scrolled out of sight.
            if window.focused().is_none_or(|focused| focused.rect != field.rect) {
                window.click(field.rect.center());
            }
            window.key(Modifiers::COMMAND, Key::A);
            TEXT.iter().for_each(|text| window.text(text));
            window.key(Modifiers::NONE, Key::Backspace);
            window.text("u");
            window.be_quick();
            let value = find(&window).map(|field| field.value).unwrap_or_default();
            assert_eq!(value, "Kitchen number 3 & u", "{state}: {name}");
            // The plan is what it was: no letter was a command.
            assert_eq!(window.app().plan(), Some(&before), "{state}: {name}");
            seen.insert(name.clone());
        }
    }
    let wanted =
        ["Name", "Function", "Note", "Length", "Thickness", "Width", "Find a command", "Search shortcuts", "File"];
    for name in wanted {
        assert!(seen.contains(name), "{name} is not among {seen:?}");
    }
}

/// A new field is tried above once somebody has brought it up there.
#[test]
fn every_kind_of_field_in_the_code_is_tried() {
    let mut found = Vec::new();
    for entry in walkdir::WalkDir::new(Path::new(env!("CARGO_MANIFEST_DIR")).join("src/app")).sort_by_file_name() {
        let path = entry.unwrap().into_path();
        if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            let number = text.matches("TextEdit::singleline(").count() + text.matches("TextEdit::multiline(").count();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            found.extend(std::iter::repeat_n(name, number));
        }
    }
    let tried = [
        "length_field.rs",
        "bulk.rs",
        "dataset.rs",
        "export.rs",
        "export.rs",
        "findings.rs",
        "forms.rs",
        "here.rs",
        "room.rs",
        "palette.rs",
        "review.rs",
        "shortcuts.rs",
        "change.rs",
        "workspace.rs",
    ];
    assert_eq!(found, tried, "bring the new field up in STATES, and name its file here");
}

#[test]
fn what_comes_with_enter_and_with_the_key_before_is_kept() {
    let mut window = window_with("dwelling");
    let study = room(&window, "Study");
    run(&mut window, "pick", &[&study.to_string()]);
    // F2 selects the old text; letters and Enter come in its frame.
    window.be_slow();
    window.key(Modifiers::NONE, Key::F2);
    TEXT.iter().for_each(|text| window.text(text));
    window.key(Modifiers::NONE, Key::Enter);
    window.be_quick();
    window.settle().unwrap();
    let name = |window: &Offscreen| window.app().plan().unwrap().room(study).unwrap().name.clone();
    assert_eq!(name(&window), "Kitchen number 3 & ü");
    // Tab ends the name and goes on to the function; Enter ends that; the next letter is a command again.
    window.be_slow();
    window.key(Modifiers::NONE, Key::F2);
    window.text("Den");
    window.key(Modifiers::NONE, Key::Tab);
    window.key(Modifiers::COMMAND, Key::A);
    window.text("observatory");
    window.key(Modifiers::NONE, Key::Enter);
    window.be_quick();
    window.settle().unwrap();
    assert_eq!(name(&window), "Den");
    assert_eq!(window.app().plan().unwrap().room(study).unwrap().function, "observatory");
    // The palette: its key, what is sought, Enter, what it then asks for, Enter.
    window.be_slow();
    window.key(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::P);
    window.text("rename the plan");
    window.key(Modifiers::NONE, Key::Enter);
    window.key(Modifiers::COMMAND, Key::A);
    window.text("Slow but sure");
    window.key(Modifiers::NONE, Key::Enter);
    window.be_quick();
    window.settle().unwrap();
    assert_eq!(window.app().plan().unwrap().meta().name, "Slow but sure");
}

#[test]
fn letters_for_a_file_dialog_do_nothing_to_the_plan() {
    let mut window = Offscreen::new(OffscreenOptions::default()).holding_jobs();
    window.open_bundled("dwelling");
    while !window.held_jobs().is_empty() {
        window.end_job_at(0);
    }
    window.settle().unwrap();
    let study = room(&window, "Study");
    run(&mut window, "pick", &[&study.to_string()]);
    let before = window.app().plan().unwrap().clone();
    window.answer_dialog(None);
    window.key(Modifiers::COMMAND, Key::O);
    assert!(window.held_jobs().contains(&"ask for a file"), "{:?}", window.held_jobs());
    for letter in ["t", "r", "a", "c", "e", "1"] {
        let key = Key::from_name(&letter.to_uppercase()).unwrap();
        window.key(Modifiers::NONE, key);
        window.text(letter);
    }
    window.key(Modifiers::NONE, Key::Enter);
    window.key(Modifiers::NONE, Key::Delete);
    assert_eq!(window.app().plan(), Some(&before));
    assert!(!window.app().has_unsaved_changes());
    // Once it has gone, letters are commands again.
    window.end_job("ask for a file");
    window.settle().unwrap();
    window.key(Modifiers::NONE, Key::Num5);
    window.settle().unwrap();
    assert!(window.app().has_unsaved_changes());
    assert_eq!(window.app().picked(), Some(ElementId::Room(study)));
}
