//! The window when disks fail, and when it is closed in the middle of something.

use std::path::{Path, PathBuf};

use egui::Modifiers;
use egui::accesskit::Role;
use enfilade::app::{Control, Offscreen, OffscreenOptions, Severity};
use enfilade::store::load_plan;

use crate::support::assert_picture;

fn window(dark: bool) -> Offscreen {
    let options = OffscreenOptions { width: 1000, height: 560, is_dark: dark, ..OffscreenOptions::default() };
    let mut window = Offscreen::new(options);
    assert!(window.open_bundled("dwelling"));
    window.settle().unwrap();
    window
}

fn run(window: &mut Offscreen, id: &str, arguments: &[&str]) {
    window.run_command_with(id, arguments).unwrap();
    window.settle().unwrap();
}

fn change(window: &mut Offscreen) {
    run(window, "pick", &["Study"]);
    run(window, "label-hall", &[]);
    assert!(window.app().has_unsaved_changes());
}

fn press(window: &mut Offscreen, name: &str) {
    let names: Vec<String> = window.controls().into_iter().map(|control| control.name).collect();
    assert!(window.click_control(name), "no control '{name}' among {names:?}");
    window.settle().unwrap();
}

fn files(folder: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(folder).map(|entries| entries.map(|entry| entry.unwrap().path()).collect()).unwrap_or_default()
}

/// Compares the messages, which lie over the canvas, with a picture.
fn compare_messages(window: &mut Offscreen, name: &str) {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recovery").join(name);
    let is_message = |control: &Control| matches!(control.role, Role::Status | Role::Alert);
    let rects = window.controls().into_iter().filter(is_message).map(|control| control.rect);
    let messages = rects.reduce(|all, rect| all.union(rect)).unwrap();
    assert_picture(&reference, &window.picture_of(messages.expand(4.0)).to_png().unwrap());
}

/// A path that leads to the disk that is always full.
#[cfg(target_os = "linux")]
fn always_full(folder: &Path) -> PathBuf {
    let path = folder.join("house.plan.json");
    std::os::unix::fs::symlink("/dev/full", &path).unwrap();
    path
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_stays_in_sight_until_a_save_works() {
    let folder = tempfile::tempdir().unwrap();
    let full = always_full(folder.path());
    let mut window = window(false);
    window.name_paths_from(folder.path());
    change(&mut window);
    run(&mut window, "save-as", &[&full.to_string_lossy()]);
    let messages = window.app().messages();
    let [bar] = messages.as_slice() else { panic!("{messages:?}") };
    assert!(bar.text.contains("house.plan.json is not saved: No space left on device"), "{}", bar.text);
    assert!(bar.stays && bar.severity == Severity::Error);
    assert!(window.control("Dismiss message").is_none());
    window.key(Modifiers::NONE, egui::Key::Escape);
    window.advance(60.0);
    assert_eq!(window.app().messages().len(), 1);
    compare_messages(&mut window, "full_disk.png");
    // Closing: a save that fails does not close, by whatever way.
    window.ask_to_close();
    window.settle().unwrap();
    window.answer_dialog(Some(full.clone()));
    run(&mut window, "answer", &["save"]);
    assert!(!window.is_closed() && window.app().has_unsaved_changes());
    // Another place.
    let other = folder.path().join("other.plan.json");
    window.answer_dialog(Some(other.clone()));
    press(&mut window, "Save to another place…");
    assert_eq!(window.app().messages(), []);
    assert_eq!(load_plan(&other).unwrap(), *window.app().plan().unwrap());
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn a_journal_that_cannot_be_written_stays_in_sight_until_it_can() {
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("journal");
    std::fs::write(&state, "a file where a folder should be").unwrap();
    let mut window = window(true);
    window.name_paths_from(folder.path());
    window.use_journal(&state);
    window.settle().unwrap();
    assert_eq!(window.app().messages(), [], "nothing is kept yet, nothing fails");
    change(&mut window);
    let messages = window.app().messages();
    let [bar] = messages.as_slice() else { panic!("{messages:?}") };
    assert!(bar.text.starts_with("Your changes have no backup: "), "{}", bar.text);
    assert!(bar.stays && bar.severity == Severity::Error);
    #[cfg(target_os = "linux")]
    compare_messages(&mut window, "journal_fails_dark.png");
    assert!(window.controls().iter().any(|control| control.name == "● No backup"), "the status line says so too");
    std::fs::remove_file(&state).unwrap();
    run(&mut window, "label-small", &[]);
    // It is tried again every two seconds.
    for _ in 0..100 {
        if window.app().messages().is_empty() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
        window.settle().unwrap();
    }
    assert_eq!(window.app().messages(), []);
    assert_eq!(files(&state).len(), 1);
    let plan = window.app().plan().unwrap().clone();
    drop(window);
    // Both changes are there: the one that waited, too.
    let mut window = self::window(false);
    window.use_journal(&state);
    window.settle().unwrap();
    press(&mut window, "Recover");
    assert_eq!(window.app().plan(), Some(&plan));
    run(&mut window, "undo", &[]);
    run(&mut window, "undo", &[]);
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn nothing_is_left_where_nothing_is_unsaved() {
    let folder = tempfile::tempdir().unwrap();
    let (state, file) = (folder.path().join("journal"), folder.path().join("house.plan.json"));
    let mut window = window(false);
    window.use_journal(&state);
    change(&mut window);
    assert_eq!(files(&state).len(), 1);
    run(&mut window, "save-as", &[&file.to_string_lossy()]);
    assert!(files(&state).is_empty(), "it is saved");
    run(&mut window, "label-small", &[]);
    assert_eq!(files(&state).len(), 1);
    // Undone to what is saved, and on: the journal follows.
    run(&mut window, "undo", &[]);
    run(&mut window, "redo", &[]);
    run(&mut window, "close", &[]);
    assert_eq!(files(&state).len(), 1, "it is asked first");
    run(&mut window, "answer", &["cancel"]);
    assert_eq!(files(&state).len(), 1);
    run(&mut window, "close", &[]);
    run(&mut window, "answer", &["discard"]);
    assert!(files(&state).is_empty(), "it is given up");
    run(&mut window, "open", &[&file.to_string_lossy()]);
    run(&mut window, "pick", &["Study"]);
    run(&mut window, "label-big", &[]);
    assert_eq!(files(&state).len(), 1);
    window.ask_to_close();
    window.settle().unwrap();
    press(&mut window, "Save");
    assert!(window.is_closed() && files(&state).is_empty());
}

#[test]
fn closing_waits_for_what_is_being_saved() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("house.plan.json");
    let mut window = window(false);
    change(&mut window);
    // No frame between the two: the outcome of the save is not known yet.
    window.run_command_with("save-as", &[&file.to_string_lossy()]).unwrap();
    window.ask_to_close();
    window.settle().unwrap();
    assert!(window.is_closed(), "what was saved need not be asked for");
    assert!(load_plan(&file).is_ok());
}

#[test]
#[cfg(target_os = "linux")]
fn closing_does_not_follow_a_save_that_fails() {
    let folder = tempfile::tempdir().unwrap();
    let full = always_full(folder.path());
    let mut window = window(false);
    change(&mut window);
    window.run_command_with("save-as", &[&full.to_string_lossy()]).unwrap();
    window.run_command("quit");
    window.settle().unwrap();
    assert!(!window.is_closed() && window.app().has_unsaved_changes());
    assert_eq!(window.app().messages().len(), 1);
}

#[test]
fn what_arrives_while_something_is_asked_waits_for_the_answer() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("other.plan.json");
    std::fs::write(&file, enfilade::store::BUNDLED[0].1).unwrap();
    let mut window = window(false);
    change(&mut window);
    let plan = window.app().plan().unwrap().clone();
    window.open(&file);
    window.run_command("quit");
    window.settle().unwrap();
    assert!(window.control("Don't save").is_some());
    // Cancel means cancel; the other plan is shown beside.
    press(&mut window, "Cancel");
    assert!(window.control("Don't save").is_none());
    assert!(!window.is_closed());
    assert_ne!(window.app().plan(), Some(&plan));
    window.run_command("previous-open");
    window.settle().unwrap();
    assert_eq!(window.app().plan(), Some(&plan));
}

#[test]
fn a_journal_with_an_unsound_step_says_so_and_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/recovery/undo-invalid.journal");
    std::fs::copy(sample, folder.path().join("plan-a.journal")).unwrap();
    let mut window = Offscreen::new(OffscreenOptions { width: 1000, height: 560, ..OffscreenOptions::default() });
    window.use_journal(folder.path());
    window.settle().unwrap();
    run(&mut window, "recover", &["1"]);
    let said: Vec<String> = window.app().messages().iter().map(|message| message.text.clone()).collect();
    assert!(said.iter().any(|text| text.contains("is damaged")), "{said:?}");
    assert_eq!(window.app().plan().unwrap().violations(), []);
    assert!(window.run_command_with("undo", &[]).is_err(), "nothing before it");
    assert_eq!(files(folder.path()), [folder.path().join("plan-a.journal")]);
}
