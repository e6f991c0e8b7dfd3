//! Shortcuts: each does what the table says, and users can change them.

use std::path::{Path, PathBuf};

use enfilade::app::commands::{COMMANDS, Keys, find};
use enfilade::app::{Offscreen, OffscreenOptions, Severity};
use enfilade::plan::OpeningKind;

use super::{done, keys, picked, press, run, type_in, window_with};

/// Each shortcut of the table, pressed where its command can be done, does this command and no other.
#[test]
fn every_shortcut_does_its_command() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("traced.plan.json");
    let word = path.to_str().unwrap();
    // A copy: a review keeps what was decided in the folder.
    let plans = folder.path().join("plans");
    copy_plans(&plans);
    let mut checked = 0;
    for command in COMMANDS.iter() {
        for &shortcut in command.shortcuts {
            let in_the_middle = matches!(command.id, "previous-plan" | "next-plan");
            let mut window = window_with(if in_the_middle { "school" } else { "dwelling" });
            // A plan with something to undo and redo, and a picture under it.
            let plan = enfilade::edit::set_backdrop(window.app().plan().unwrap(), Some(super::backdrop()));
            enfilade::store::save_plan(&path, &plan).unwrap();
            if !in_the_middle {
                run(&mut window, "open", &[word]);
            }
            run(&mut window, "next-room", &[]);
            for id in ["label-hall", "label-small"] {
                if !matches!(command.id, "quit" | "close" | "previous-plan" | "next-plan") {
                    run(&mut window, id, &[]);
                }
            }
            if command.id == "accept-all-predictions" {
                // A room without a label.
                run(&mut window, "label-by-function", &[]);
                run(&mut window, "set-function", &["of no scheme"]);
            }
            match command.id {
                // Walls that end nowhere.
                "next-finding" | "previous-finding" => run(&mut window, "draw-walls", &["20,0 24,0"]),
                "accept-function" => {
                    run(&mut window, "set-function", &[""]);
                    run(&mut window, "rename", &["Kitchen 2"]);
                }
                // Walls that enclose what no room covers.
                "fill-all" => {
                    run(&mut window, "delete", &[]);
                    if window.control("Delete").is_some() {
                        run(&mut window, "answer", &["delete"]);
                    }
                }
                "merge-rooms" => select_neighbours(&mut window),
                "paste" => run(&mut window, "copy", &[]),
                "robot-run" | "robot-step" => run(&mut window, "explore-plan", &[]),
                id if id.starts_with("review-") => {
                    run(&mut window, "open", &[plans.to_str().unwrap()]);
                    run(&mut window, "review-labels", &[]);
                    if id == "review-back" {
                        run(&mut window, "review-skip", &[]);
                    }
                }
                // Nothing hangs on a window.
                "delete" | "cut" => {
                    let plan = window.app().plan().unwrap();
                    let pane = plan.openings().find(|(_, opening)| opening.kind == OpeningKind::Window).unwrap().0;
                    run(&mut window, "pick-opening", &[&pane.to_string()]);
                }
                _ => {}
            }
            if command.id == "redo" {
                run(&mut window, "undo", &[]);
            }
            window.answer_dialog(Some(path.clone()));
            window.watch_commands(true);
            keys(&mut window, &Keys::from(shortcut).to_string());
            let said = done(&mut window).join("; ");
            let (is_done, expected) = match command.id {
                "save-as" => (said.starts_with("save-as "), "save-as"),
                // A file that is open already is shown.
                "open" => (said.starts_with("open ") || said.starts_with("show-plan "), "open"),
                // These show something, or give the keyboard to it.
                "review-note" => (window.focused().is_some(), "the note"),
                "commands" => (window.control("Find a command").is_some(), "the palette"),
                "find-room" => (
                    window.control("Find a room: a room's name, or its id if several rooms have the name").is_some(),
                    "the palette",
                ),
                "export" | "print" => (
                    ["Export the plan", "Print the plan"].iter().any(|title| window.control(title).is_some()),
                    "the dialog",
                ),
                "shortcuts" => (window.control("Search shortcuts").is_some(), "the sheet"),
                "name-rooms" => (window.control("Name rooms").is_some(), "the form"),
                "rename" | "set-function" => {
                    type_in(&mut window, "q");
                    keys(&mut window, "Enter");
                    (done(&mut window)[0].starts_with(command.id), "a name")
                }
                "next-open" | "previous-open" => (said.starts_with("show-plan "), "another open plan"),
                // Going on to another plan closes one that nothing was done in.
                id => (said.split("; ").any(|one| one == id || one.starts_with(&format!("{id} "))), id),
            };
            assert!(is_done, "{} of {} gave '{said}', not {expected}", Keys::from(shortcut), command.id);
            checked += 1;
        }
    }
    assert!(checked > 30, "{checked}");
}

#[test]
fn no_shortcut_is_used_twice_or_reserved() {
    let mut seen: Vec<(Keys, &str)> = Vec::new();
    for command in COMMANDS.iter() {
        for &shortcut in command.shortcuts {
            let keys = Keys::from(shortcut);
            let before = seen.iter().find(|(other, _)| *other == keys);
            assert_eq!(before, None, "{keys} is the shortcut of {} too", command.id);
            let is_its_own = matches!(command.id, "clear-selection" | "copy" | "cut" | "paste");
            assert!(keys.why_reserved().is_none() || is_its_own, "{keys} of {}", command.id);
            assert_eq!(keys.to_string().parse(), Ok(keys), "{keys} can be kept");
            seen.push((keys, command.id));
        }
    }
}

/// Selects two rooms that can be merged.
fn select_neighbours(window: &mut Offscreen) {
    let rooms: Vec<String> = window.app().plan().unwrap().rooms().map(|(id, _)| id.to_string()).collect();
    for (index, one) in rooms.iter().enumerate() {
        for other in &rooms[index + 1..] {
            let both = format!("{one} {other}");
            run(window, "select", &[&both]);
            if window.run_command("merge-rooms") {
                run(window, "undo", &[]);
                run(window, "select", &[&both]);
                return;
            }
        }
    }
    panic!("no two rooms can be merged");
}

/// A window whose settings are kept in a file.
fn window_of(file: &Path) -> Offscreen {
    let mut window = window_with("dwelling");
    // High enough for the whole sheet.
    window.resize(1600, 2400);
    window.use_settings(file);
    window.settle().unwrap();
    window
}

fn settings() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("of somebody/settings.json");
    (folder, file)
}

fn kept(file: &Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
}

#[test]
fn a_person_changes_a_shortcut_in_the_sheet() {
    let (_folder, file) = settings();
    let mut window = window_of(&file);
    keys(&mut window, "Questionmark");
    press(&mut window, "Shortcut of Graph: G");
    keys(&mut window, "Ctrl+Alt+K");
    assert!(window.control("Ctrl+Alt+K is now the shortcut of 'Graph'").is_some());
    assert!(window.control("Shortcut of Graph: Ctrl+Alt+K").is_some());
    press(&mut window, "Shortcut of Grid: Shift+G");
    keys(&mut window, "G");
    press(&mut window, "Shortcut of Names: N");
    keys(&mut window, "Backspace");
    press(&mut window, "Done");
    assert!(window.control("Search shortcuts").is_none());
    let expected = serde_json::json!({
        "version": 1,
        "shortcuts": { "graph": ["Ctrl+Alt+K"], "grid": ["G"], "names": [] },
    });
    assert_eq!(kept(&file), expected);
    // The keys do what they say, in this window and in the next.
    for window in [&mut window, &mut window_of(&file)] {
        window.watch_commands(true);
        for text in ["Ctrl+Alt+K", "G", "N", "Shift+G"] {
            keys(window, text);
        }
        assert_eq!(done(window), [r#"graph "on""#, r#"grid "off""#]);
        // So do tooltips.
        let tool = window.control("Graph").unwrap().rect.center();
        window.move_to(tool);
        window.advance(1.0);
        window.settle().unwrap();
        assert!(window.control("Ctrl+Alt+K").is_some());
    }
}

#[test]
fn clashes_are_refused_and_named() {
    let (_folder, file) = settings();
    let mut window = window_of(&file);
    keys(&mut window, "F1");
    press(&mut window, "Shortcut of Graph: G");
    for (pressed, said) in [
        ("Ctrl+O", "Ctrl+O is already the shortcut of 'Open'"),
        ("Tab", "Tab cannot be a shortcut: it goes from control to control and presses them"),
        ("Space", "Space cannot be a shortcut: it goes from control to control and presses them"),
        ("Home", "Home cannot be a shortcut: it belongs to text"),
        // The second shortcut of a command, too.
        ("Ctrl+Y", "Ctrl+Y is already the shortcut of 'Redo'"),
    ] {
        keys(&mut window, pressed);
        assert!(window.control(said).is_some(), "{pressed}");
        assert!(window.control("Shortcut of Graph: press keys").is_some(), "it goes on waiting");
    }
    keys(&mut window, "Escape");
    assert!(window.control("Shortcut of Graph: G").is_some());
    assert!(!file.exists(), "nothing was changed");
    // Escape now leaves the sheet.
    keys(&mut window, "Escape");
    assert!(window.control("Search shortcuts").is_none());
    let error = window.run_command_with("set-shortcut", &["graph", "F2"]).unwrap_err().to_string();
    assert_eq!(error, "'set-shortcut' is not available: F2 is already the shortcut of 'Rename'");
}

#[test]
fn one_or_all_are_reset() {
    let (_folder, file) = settings();
    let mut window = window_of(&file);
    run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
    run(&mut window, "set-shortcut", &["grid", "G"]);
    run(&mut window, "remove-shortcut", &["undo"]);
    // Its own keys are another's by now.
    let error = window.run_command_with("reset-shortcut", &["graph"]).unwrap_err().to_string();
    assert_eq!(error, "'reset-shortcut' is not available: G is already the shortcut of 'Grid'");
    keys(&mut window, "F1");
    press(&mut window, "Reset the shortcut of Grid");
    press(&mut window, "Reset the shortcut of Graph");
    assert!(window.control("Shortcut of Graph: G").is_some());
    assert!(window.control("Shortcut of Undo: none").is_some());
    press(&mut window, "Reset all");
    assert!(window.control("Shortcut of Undo: Ctrl+Z").is_some());
    assert_eq!(kept(&file)["shortcuts"], serde_json::json!({}));
    keys(&mut window, "Escape");
    assert!(window.run_command_with("reset-shortcuts", &[]).is_err(), "nothing is changed any more");
}

#[test]
fn the_sheet_is_searched() {
    let mut window = window_with("dwelling");
    keys(&mut window, "F1");
    for command in COMMANDS.iter().filter(|command| command.menu.is_some()) {
        let name = format!("Shortcut of {}: ", command.title.trim_end_matches('…'));
        assert!(window.controls().iter().any(|control| control.name.starts_with(&name)), "{name}");
    }
    type_in(&mut window, "ctrl+s");
    let shown: Vec<String> = window
        .controls()
        .into_iter()
        .filter_map(|control| Some(control.name.strip_prefix("Shortcut of ")?.to_owned()))
        .collect();
    assert!(shown.contains(&"Save: Ctrl+S".to_owned()), "{shown:?}");
    assert!(!shown.contains(&"Graph: G".to_owned()), "{shown:?}");
}

#[test]
fn plain_letters_go_to_a_text_field_and_others_do_not() {
    let mut window = window_with("dwelling");
    run(&mut window, "set-shortcut", &["graph", "Q"]);
    run(&mut window, "set-shortcut", &["grid", "Ctrl+Alt+X"]);
    run(&mut window, "set-shortcut", &["names", "F12"]);
    run(&mut window, "pick", &["Study"]);
    run(&mut window, "rename", &[]);
    window.watch_commands(true);
    // As a window system tells of it: the key, and the text it gives.
    keys(&mut window, "Q");
    type_in(&mut window, "q");
    keys(&mut window, "Ctrl+Alt+X");
    keys(&mut window, "F12");
    let said = done(&mut window);
    assert!(!said.iter().any(|line| line.starts_with("graph")), "{said:?}");
    assert!(said.contains(&r#"grid "off""#.to_owned()) && said.contains(&r#"names "off""#.to_owned()), "{said:?}");
    keys(&mut window, "Enter");
    assert_eq!(picked(&window).name, "q", "the old name was selected");
    keys(&mut window, "Q");
    assert!(done(&mut window).contains(&r#"graph "on""#.to_owned()));
}

fn copy_plans(folder: &Path) {
    for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("plans")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            write(&folder.join(path.file_name().unwrap()), &std::fs::read_to_string(&path).unwrap());
        }
    }
}

#[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
fn write(file: &Path, text: &str) {
    std::fs::create_dir_all(file.parent().unwrap()).unwrap();
    std::fs::write(file, text).unwrap();
}

fn said(window: &Offscreen) -> String {
    let messages = window.app().messages();
    assert!(messages.iter().all(|message| message.severity == Severity::Warning));
    messages.iter().map(|message| format!("{}\n{}\n", message.text, message.detail)).collect()
}

#[test]
fn a_damaged_file_is_said_and_kept_aside() {
    for damaged in ["{ \"version\": 1, \"shortcuts\": {", "", "[1, 2]", "\u{fffd}\u{0}"] {
        let (_folder, file) = settings();
        write(&file, damaged);
        let mut window = window_of(&file);
        let text = said(&window);
        assert!(text.contains("Your settings are damaged") && text.contains("settings.damaged.json"), "{text}");
        assert!(!file.exists());
        run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
        assert_eq!(kept(&file)["shortcuts"], serde_json::json!({ "graph": ["Ctrl+G"] }));
        let aside = file.with_file_name("settings.damaged.json");
        assert_eq!(std::fs::read_to_string(&aside).unwrap(), damaged);
        // A second one does not replace the first.
        write(&file, damaged);
        window_of(&file);
        assert_eq!(std::fs::read_to_string(file.with_file_name("settings.damaged-2.json")).unwrap(), damaged);
    }
}

#[test]
fn what_is_not_known_in_the_file_stays() {
    let (_folder, file) = settings();
    write(
        &file,
        r#"{
            "version": 1, "colour": "mauve",
            "shortcuts": { "fly-to-the-moon": ["Ctrl+M"], "graph": ["Ctrl+G"], "grid": "G", "names": ["Ctrl+O"], "fit": ["Tab"] }
        }"#,
    );
    let mut window = window_of(&file);
    let text = said(&window);
    for part in
        ["grid: \"G\" is not a list of keys", "names: Ctrl+O is already the shortcut of 'Open'", "fit: Tab cannot be"]
    {
        assert!(text.contains(part), "{text}");
    }
    assert!(!text.contains("fly-to-the-moon"), "{text}");
    window.watch_commands(true);
    for text in ["Ctrl+G", "N", "F"] {
        keys(&mut window, text);
    }
    assert_eq!(done(&mut window), [r#"graph "on""#, r#"names "off""#, "fit"]);
    run(&mut window, "set-shortcut", &["fit", "Ctrl+0"]);
    assert_eq!(kept(&file)["colour"], "mauve");
    assert_eq!(
        kept(&file)["shortcuts"],
        serde_json::json!({ "fit": ["Ctrl+0"], "fly-to-the-moon": ["Ctrl+M"], "graph": ["Ctrl+G"] })
    );
}

#[test]
fn a_file_of_a_newer_version_or_of_nobody_is_left_alone() {
    let (_folder, file) = settings();
    let newer = r#"{ "version": 2, "shortcuts": [] }"#;
    write(&file, newer);
    let mut window = window_of(&file);
    assert!(said(&window).contains("newer version"), "{}", said(&window));
    run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), newer);
    // A folder where the file should be.
    let folder = tempfile::tempdir().unwrap();
    let mut window = window_of(folder.path());
    assert!(said(&window).contains("cannot be read"), "{}", said(&window));
    run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
    // A place where nothing can be written.
    let mut window = window_of(Path::new("/dev/null/settings.json"));
    run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
    assert!(said(&window).contains("Your settings"), "{}", said(&window));
    // Without a file nothing is kept.
    let mut window = Offscreen::new(OffscreenOptions::default());
    run(&mut window, "set-shortcut", &["graph", "Ctrl+G"]);
    assert_eq!(said(&window), "");
    assert!(find("graph").is_some());
}
