//! What a recorder receives: everything that was done, complete, so that repeating it gives the same.

use egui::{Key, Modifiers, PointerButton, pos2, vec2};
use enfilade::app::{Offscreen, OffscreenOptions};

use super::{done, press, run, window_with};

#[test]
fn all_that_is_done_by_hand_is_told_and_replays_to_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.plan.json");
    let word = path.to_str().unwrap();
    let mut window = Offscreen::new(OffscreenOptions::default());
    window.settle().unwrap();
    window.watch_commands(true);
    press(&mut window, "House with an enfilade");
    // A room by a click, a label by its key, a name by its field.
    let study = window.control("Study").unwrap().rect.center();
    window.click(study);
    window.settle().unwrap();
    window.key(Modifiers::NONE, Key::H);
    window.key(Modifiers::NONE, Key::F2);
    window.settle().unwrap();
    window.key(Modifiers::COMMAND, Key::A);
    window.text("Library \"of\" the house");
    window.settle().unwrap();
    // Leaving the field by picking another room writes it first.
    window.click(window.control("Bathroom").unwrap().rect.center());
    window.settle().unwrap();
    press(&mut window, "Corridor");
    // The keyboard on the plan, the pointer on it, the wheel.
    window.key(Modifiers::COMMAND, Key::ArrowRight);
    window.key(Modifiers::NONE, Key::Tab);
    window.key(Modifiers::NONE, Key::ArrowRight);
    window.key(Modifiers::SHIFT, Key::ArrowRight);
    window.wheel(2.0);
    window.settle().unwrap();
    window.drag(PointerButton::Middle, study, study + vec2(30.0, -20.0));
    window.settle().unwrap();
    press(&mut window, "Graph");
    press(&mut window, "Function");
    window.settle().unwrap();
    window.run_command("clear-selection");
    window.settle().unwrap();
    // Closing asks, and saving asks where.
    window.run_command("close");
    window.settle().unwrap();
    window.answer_dialog(Some(path.clone()));
    press(&mut window, "Save");
    let recorded = window.take_executed();
    window.watch_commands(true);
    window.move_to(pos2(1.0, 1.0));
    window.settle().unwrap();
    let picture = window.picture();
    let saved = std::fs::read(&path).unwrap();
    assert!(window.take_executed().is_empty());

    let mut again = Offscreen::new(OffscreenOptions::default());
    again.watch_commands(true);
    for command in &recorded {
        let arguments: Vec<&str> = command.arguments.iter().map(String::as_str).collect();
        run(&mut again, command.id, &arguments);
    }
    assert_eq!(again.take_executed(), recorded, "a recording of the replay is the recording");
    assert_eq!(std::fs::read(&path).unwrap(), saved);
    again.move_to(pos2(1.0, 1.0));
    again.settle().unwrap();
    let difference = again.picture().difference(&picture);
    assert_eq!(difference.map(|difference| difference.pixels), None);

    // What it looks like.
    let lines: Vec<String> = recorded
        .into_iter()
        .filter(|command| command.id != "view")
        .map(|command| format!("{} {}", command.id, command.arguments.join(" | ")).trim().to_owned())
        .collect();
    let save = format!("answer save | {word}");
    let expected = [
        "open-sample dwelling",
        "pick Study",
        "label-hall",
        "rename Library \"of\" the house",
        "pick Bathroom",
        "label-corridor",
    ];
    assert_eq!(lines[..expected.len()], expected, "{lines:#?}");
    assert!(lines.contains(&"graph on".to_owned()), "{lines:#?}");
    assert_eq!(lines.last(), Some(&save), "{lines:#?}");
}

#[test]
fn what_was_only_asked_for_or_refused_is_not_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = window_with("dwelling");
    window.watch_commands(true);
    assert!(!window.run_command("undo"));
    window.answer_dialog(None);
    run(&mut window, "open", &[]);
    run(&mut window, "pick", &["Study"]);
    run(&mut window, "rename", &[]);
    window.key(Modifiers::NONE, Key::Escape);
    window.settle().unwrap();
    run(&mut window, "label-hall", &[]);
    // Cancelling the dialog answers the question by cancel.
    run(&mut window, "close", &[]);
    window.answer_dialog(None);
    press(&mut window, "Save");
    assert_eq!(done(&mut window), [r#"pick "Study""#, "label-hall", "close", r#"answer "cancel""#]);
    // A dialog's answer is told with the command that asked.
    let path = folder.path().join("mine.plan.json");
    window.answer_dialog(Some(path.clone()));
    run(&mut window, "save", &[]);
    assert_eq!(done(&mut window), [format!("save-as {:?}", path.to_str().unwrap())]);
    run(&mut window, "save", &[]);
    assert_eq!(done(&mut window), ["save"]);
    window.watch_commands(false);
    run(&mut window, "fit", &[]);
    assert_eq!(done(&mut window), Vec::<String>::new());
}
