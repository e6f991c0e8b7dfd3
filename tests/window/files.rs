//! Opening, saving, closing: whatever a user would be angry to lose.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use enfilade::app::{Offscreen, OffscreenOptions, Severity};
use enfilade::edit;
use enfilade::geometry::Point;
use enfilade::picture::Picture;
use enfilade::plan::{Backdrop, Builder, Meta, Plan, Room};
use enfilade::store::{BUNDLED, load_plan, save_plan};

use super::{click_room, press, texts, window_with};

/// A folder with two plans of our own and one that is broken.
#[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in &BUNDLED[..2] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    std::fs::write(folder.path().join("broken.plan.json"), "{\"format\": \"enfilade plan\", \"version\": 1,").unwrap();
    folder
}

fn open(path: &Path) -> Offscreen {
    let mut window = Offscreen::new(OffscreenOptions::default());
    window.open(path);
    window.settle().unwrap();
    window
}

fn name(window: &Offscreen) -> String {
    window.app().plan().map(|plan| plan.meta().name.clone()).unwrap_or_default()
}

/// Gives the first room another label than it has.
fn change(window: &mut Offscreen) {
    window.run_command("next-room");
    window.run_command("label-hall");
    window.run_command("label-small");
    window.settle().unwrap();
    assert!(window.app().has_unsaved_changes());
}

#[test]
fn files_come_by_path_by_dialog_by_drop_and_by_list() {
    let folder = folder();
    let (office, school) = (folder.path().join("office.plan.json"), folder.path().join("school.plan.json"));
    let mut window = open(&office);
    assert_eq!(name(&window), "Office on a corner");
    window.answer_dialog(Some(school.clone()));
    window.key(Modifiers::COMMAND, Key::O);
    window.settle().unwrap();
    assert_eq!(name(&window), "School round a court");
    window.drop_file(&office);
    window.settle().unwrap();
    assert_eq!(name(&window), "Office on a corner");
    // The folder's plans are listed, and those that come with the program.
    press(&mut window, "school.plan.json");
    assert_eq!(name(&window), "School round a court");
    press(&mut window, "House with an enfilade");
    assert_eq!(name(&window), "House with an enfilade");
    window.key(Modifiers::NONE, Key::PageUp);
    window.settle().unwrap();
    assert_eq!(name(&window), "School round a court");
    // A cancelled dialog changes nothing.
    window.answer_dialog(None);
    window.key(Modifiers::COMMAND, Key::O);
    window.settle().unwrap();
    assert_eq!(name(&window), "School round a court");
    // A folder opens its first plan that reads; here the first is broken.
    let window = open(folder.path());
    assert!(texts(&window)[0].contains("broken.plan.json"), "{:?}", texts(&window));
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
fn a_folder_opens_with_all_plans_below_it() {
    let folder = tempfile::tempdir().unwrap();
    for (name, (_, text)) in ["east/a.plan.json", "west/deep/b.plan.json"].into_iter().zip(&BUNDLED[..2]) {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    // Links in a circle end nothing.
    #[cfg(unix)]
    std::os::unix::fs::symlink("..", folder.path().join("east/round")).unwrap();
    let mut window = open(folder.path());
    assert_eq!(name(&window), "Office on a corner");
    press(&mut window, "west/deep/b.plan.json");
    window.settle().unwrap();
    assert_eq!(name(&window), "School round a court");
    // The list stays that of the folder that was opened.
    press(&mut window, "east/a.plan.json");
    window.settle().unwrap();
    assert_eq!(name(&window), "Office on a corner");
}

#[test]
fn what_cannot_be_opened_is_said_and_nothing_is_lost() {
    let folder = folder();
    let mut window = window_with("dwelling");
    change(&mut window);
    let before = window.app().plan().unwrap().clone();
    for (path, words) in [
        (folder.path().join("broken.plan.json"), ["broken.plan.json", "line 1"]),
        (PathBuf::from("/nowhere/plan.xml"), ["plan.xml", "No such file"]),
        (Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/window/files.rs"), ["files.rs", "no known plan format"]),
    ] {
        window.drop_file(&path);
        window.settle().unwrap();
        let texts = texts(&window);
        let last = texts.last().unwrap();
        assert!(words.iter().all(|word| last.contains(word)), "{last}");
        assert!(last.contains(&*path.to_string_lossy()), "{last}");
        assert_eq!(window.app().plan(), Some(&before));
    }
    assert!(window.app().messages().iter().all(|message| message.severity == Severity::Error));
    // They stay until they are dismissed.
    window.advance(30.0);
    for left in (0..3).rev() {
        press(&mut window, "Dismiss message");
        assert_eq!(window.app().messages().len(), left);
    }
}

#[test]
fn saving_keeps_every_byte_and_asks_where_only_once() {
    let folder = folder();
    let mut window = window_with("dwelling");
    change(&mut window);
    let plan = window.app().plan().unwrap().clone();
    // A bundled plan has no file: cancel means cancel.
    window.answer_dialog(None);
    window.key(Modifiers::COMMAND, Key::S);
    window.settle().unwrap();
    assert!(window.app().has_unsaved_changes());
    // The ending is added when it is left out.
    window.answer_dialog(Some(folder.path().join("mine")));
    window.key(Modifiers::COMMAND, Key::S);
    window.settle().unwrap();
    let path = folder.path().join("mine.plan.json");
    assert_eq!(load_plan(&path).unwrap(), plan);
    assert!(!window.app().has_unsaved_changes());
    assert!(window.control("mine.plan.json").is_some(), "it is in the list");
    // From then on it has its place.
    window.run_command("label-medium");
    window.key(Modifiers::COMMAND, Key::S);
    window.settle().unwrap();
    assert_eq!(load_plan(&path).unwrap(), *window.app().plan().unwrap());
    assert!(!window.app().has_unsaved_changes());
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
fn a_file_changed_by_somebody_else_is_never_overwritten_silently() {
    let folder = folder();
    let path = folder.path().join("office.plan.json");
    let mut window = open(&path);
    change(&mut window);
    let theirs = BUNDLED[1].1;
    std::fs::write(&path, theirs).unwrap();
    window.run_command("save");
    window.settle().unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), theirs);
    press(&mut window, "Cancel");
    assert!(window.app().has_unsaved_changes());
    window.run_command("save");
    window.settle().unwrap();
    press(&mut window, "Replace");
    assert_eq!(load_plan(&path).unwrap(), *window.app().plan().unwrap());
    assert!(!window.app().has_unsaved_changes());
    // A folder that is gone: the work stays, the error says so, and it can be saved elsewhere.
    window.run_command("label-medium");
    let gone = folder.path().join("gone/plan.plan.json");
    window.answer_dialog(Some(gone));
    window.run_command("save-as");
    window.settle().unwrap();
    let texts = texts(&window);
    assert!(texts.last().unwrap().contains("not saved"), "{texts:?}");
    assert!(window.app().has_unsaved_changes());
}

#[test]
fn closing_asks_once_and_cancel_means_cancel() {
    let folder = folder();
    let mut window = window_with("dwelling");
    change(&mut window);
    let plan = window.app().plan().unwrap().clone();
    // Cancel, by button and by key.
    window.ask_to_close();
    window.settle().unwrap();
    press(&mut window, "Cancel");
    window.run_command("quit");
    window.settle().unwrap();
    window.key(Modifiers::NONE, Key::Escape);
    window.settle().unwrap();
    // Another plan asks nothing: this one stays open beside it.
    window.drop_file(&folder.path().join("office.plan.json"));
    window.settle().unwrap();
    assert_eq!(name(&window), "Office on a corner");
    press(&mut window, "• House with an enfilade");
    assert!(!window.is_closed());
    assert_eq!(window.app().plan(), Some(&plan));
    // Saving to nowhere, too, goes on with nothing.
    window.ask_to_close();
    window.settle().unwrap();
    window.answer_dialog(None);
    press(&mut window, "Save");
    assert!(!window.is_closed() && window.app().has_unsaved_changes());
    // Saving somewhere closes.
    let path = folder.path().join("kept.plan.json");
    window.ask_to_close();
    window.settle().unwrap();
    window.answer_dialog(Some(path.clone()));
    press(&mut window, "Save");
    assert!(window.is_closed());
    assert_eq!(load_plan(&path).unwrap(), plan);
    // Giving up closes without.
    let mut window = window_with("dwelling");
    change(&mut window);
    window.ask_to_close();
    window.settle().unwrap();
    press(&mut window, "Don't save");
    assert!(window.is_closed());
    // Without changes nothing is asked.
    let mut window = window_with("dwelling");
    window.ask_to_close();
    window.settle().unwrap();
    assert!(window.is_closed());
}

#[test]
fn text_that_is_still_being_typed_is_not_lost_by_closing() {
    let mut window = window_with("dwelling");
    click_room(&mut window, "Study");
    window.key(Modifiers::NONE, Key::F2);
    window.settle().unwrap();
    window.text("Study two");
    window.ask_to_close();
    window.settle().unwrap();
    assert!(!window.is_closed(), "the text is a change");
    press(&mut window, "Cancel");
    super::room(&window, "Study two");
}

#[test]
fn an_import_says_what_it_mended() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/import");
    let mut found = None;
    for entry in walk(&path) {
        let mut window = open(&entry);
        if window.app().messages().iter().any(|message| !message.remedies.is_empty()) {
            press(&mut window, "Show notes");
            assert!(window.control("Import notes").is_some(), "{}", entry.display());
            press(&mut window, "Close");
            assert!(window.control("Import notes").is_none());
            found = Some(entry);
            break;
        }
    }
    assert!(found.is_some(), "some file of tests/import is mended");
}

fn walk(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .flat_map(|path| if path.is_dir() { walk(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "xml"))
        .collect();
    files.sort();
    files
}

fn with_backdrop(path: &str) -> Plan {
    let mut builder = Builder::new(Meta { name: "Traced".to_owned(), ..Meta::default() });
    let ring = builder.ring([(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0)].map(|(x, y)| Point::new(x, y)));
    builder.room("room", Room { outer: ring, name: "Room".to_owned(), ..Room::default() });
    let plan = builder.finish().unwrap();
    let backdrop = Backdrop {
        path: path.to_owned(),
        content_hash: String::new(),
        origin: Point::new(-1.0, 5.0),
        metres_per_pixel: 0.5,
        rotation_rad: 0.0,
        opacity: 1.0,
        page: 1,
        measurements: Vec::new(),
        rectification: None,
        extra: None,
    };
    edit::set_backdrop(&plan, Some(backdrop))
}

/// The colour of the picture at a place of the plan.
fn colour_at(window: &mut Offscreen, x_m: f64, y_m: f64) -> [u8; 3] {
    let at = window.app().screen_position(x_m, y_m).unwrap();
    let picture = window.picture();
    let index = (at.y as usize * picture.width_px as usize + at.x as usize) * 4;
    [picture.rgba[index], picture.rgba[index + 1], picture.rgba[index + 2]]
}

#[test]
#[expect(clippy::disallowed_methods, reason = "a test's files are no user's")]
fn the_picture_under_the_plan_is_where_it_belongs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("traced.plan.json");
    // 16 by 12 pixels of half a metre: the left half red, the right half blue.
    let rgba = (0..16 * 12).flat_map(|i| if i % 16 < 8 { [255, 0, 0, 255] } else { [0, 0, 255, 255] }).collect();
    let scan = Picture { width_px: 16, height_px: 12, rgba };
    std::fs::write(folder.path().join("scan.png"), scan.to_png().unwrap()).unwrap();
    save_plan(&path, &with_backdrop("scan.png")).unwrap();
    let mut window = open(&path);
    window.run_command("fill-none");
    window.run_command("names");
    window.run_command("grid");
    window.settle().unwrap();
    assert_eq!(texts(&window), Vec::<String>::new());
    assert_eq!(colour_at(&mut window, 1.0, 3.0), [255, 0, 0]);
    assert_eq!(colour_at(&mut window, 5.0, 1.0), [0, 0, 255]);
    assert_eq!(colour_at(&mut window, -0.5, 4.5), [255, 0, 0], "it reaches beyond the room");
    window.run_command("backdrop");
    window.settle().unwrap();
    assert_eq!(colour_at(&mut window, 1.0, 3.0), [255, 255, 255]);
    // One that is gone is said, once, and the plan is there all the same.
    save_plan(&path, &with_backdrop("gone.png")).unwrap();
    let window = open(&path);
    assert_eq!(texts(&window).len(), 1, "{:?}", texts(&window));
    assert!(texts(&window)[0].contains("gone.png"), "{:?}", texts(&window));
    assert_eq!(name(&window), "Traced");
}
