//! Arguments: their effects, and the messages about invalid ones.

use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::labels::Label;
use enfilade::plan::{Builder, ElementId, Meta, Room};
use enfilade::store::{load_plan, save_plan};

use super::{picked, refusal, run, window_with};

#[test]
fn a_session_by_words_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.plan.json");
    let mut window = Offscreen::new(OffscreenOptions::default());
    run(&mut window, "open-sample", &["dwelling"]);
    run(&mut window, "find-room", &["Study"]);
    run(&mut window, "rename", &["Library of the house"]);
    run(&mut window, "set-function", &["bedroom"]);
    run(&mut window, "set-note", &["Shelves on three sides"]);
    run(&mut window, "label-corridor", &[]);
    run(&mut window, "rename-plan", &["Ours"]);
    run(&mut window, "set-typology", &["office"]);
    let room = picked(&window);
    assert_eq!(
        (&*room.name, &*room.function, &*room.note),
        ("Library of the house", "bedroom", "Shelves on three sides")
    );
    assert_eq!(room.label.map(|label| label.label), Some(Label::Corridor));
    run(&mut window, "save-as", &[path.to_str().unwrap()]);
    assert!(!window.app().has_unsaved_changes());
    let saved = load_plan(&path).unwrap();
    assert_eq!(saved, *window.app().plan().unwrap());
    assert_eq!((&*saved.meta().name, saved.meta().typology.as_ref().unwrap().as_str()), ("Ours", "office"));
    run(&mut window, "set-typology", &["unknown"]);
    assert_eq!(window.app().plan().unwrap().meta().typology, None);
    run(&mut window, "undo", &[]);
    run(&mut window, "close", &[]);
    assert_eq!(window.app().plan(), None);
    run(&mut window, "open", &[path.to_str().unwrap(), "1"]);
    assert_eq!(*window.app().plan().unwrap(), saved);
}

#[test]
fn wrong_words_are_told_with_what_was_meant() {
    let mut window = Offscreen::new(OffscreenOptions::default());
    assert_eq!(
        refusal(&mut window, "label-coridor", &[]),
        "there is no command 'label-coridor'; did you mean 'label-corridor'?"
    );
    assert_eq!(refusal(&mut window, "xyzzy", &[]), "there is no command 'xyzzy'");
    assert_eq!(refusal(&mut window, "fit", &[]), "'fit' is not available: open a plan first");
    assert_eq!(
        refusal(&mut window, "open-sample", &["dweling"]),
        "SAMPLE of 'open-sample' is 'dweling': expected one of the sample plans; did you mean 'dwelling'?"
    );
    let mut window = window_with("dwelling");
    for (id, arguments, expected) in [
        ("undo", &[][..], "'undo' is not available: there is nothing to undo"),
        ("redo", &[], "'redo' is not available: nothing was undone"),
        ("rename", &["x"], "'rename' is not available: select a room first"),
        ("backdrop", &["on"], "'backdrop' is not available: the plan has no picture under it"),
        ("answer", &["save"], "'answer' is not available: nothing is asked"),
        ("fit", &["now"], "'fit' takes no arguments, but got 1"),
        ("zoom-to", &["1", "2", "3", "4", "5"], "'zoom-to' takes 4 arguments, but got 5"),
        ("zoom-to", &["1", "two"], "Y of 'zoom-to' is 'two': expected a number of metres from -1000000 to 1000000"),
        (
            "zoom-to",
            &["1", "2", "NaN", "1"],
            "WIDTH of 'zoom-to' is 'NaN': expected a number of metres from 0.001 to 1000000",
        ),
        ("graph", &["yes"], "SWITCH of 'graph' is 'yes': expected 'on' or 'off'"),
        (
            "pick-towards",
            &["north"],
            "DIRECTION of 'pick-towards' is 'north': expected 'left', 'right', 'up' or 'down'",
        ),
        (
            "pick",
            &["Kitchn"],
            "ROOM of 'pick' is 'Kitchn': expected the name of a room of this plan, or its id; did you mean 'Kitchen'?",
        ),
        ("open", &["plan.json", "0"], "STOREY of 'open' is '0': expected 1, 2, 3, …"),
    ] {
        assert_eq!(refusal(&mut window, id, arguments), expected);
    }
}

#[test]
fn rooms_of_one_name_are_told_apart_by_id() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("offices.plan.json");
    let mut builder = Builder::new(Meta::default());
    let mut ids = Vec::new();
    for (index, name) in ["Office", "Office", "store", ""].into_iter().enumerate() {
        let x = 4.0 * index as f64;
        let points = [(x, 0.0), (x + 3.0, 0.0), (x + 3.0, 3.0), (x, 3.0)];
        let outer = builder.ring(points.map(|(x, y)| enfilade::geometry::Point::new(x, y)));
        ids.push(builder.room(&format!("room {index}"), Room { outer, name: name.to_owned(), ..Room::default() }));
    }
    save_plan(&path, &builder.finish().unwrap()).unwrap();
    let mut window = Offscreen::new(OffscreenOptions::default());
    run(&mut window, "open", &[path.to_str().unwrap()]);
    let error = refusal(&mut window, "pick", &["office"]);
    assert!(error.contains("an id, because 2 rooms have this name"), "{error}");
    assert!(ids[..2].iter().all(|id| error.contains(&id.to_string())), "{error}");
    for (word, id) in [(ids[1].to_string(), ids[1]), ("STORE".to_owned(), ids[2]), (ids[3].to_string(), ids[3])] {
        run(&mut window, "pick", &[&word]);
        assert_eq!(window.app().picked(), Some(ElementId::Room(id)));
    }
    refusal(&mut window, "pick", &[""]);
}

#[test]
fn what_is_missing_is_asked_for() {
    let mut window = window_with("dwelling");
    // By a dialog, here cancelled.
    window.answer_dialog(None);
    run(&mut window, "open", &[]);
    // By the field for it, with the panel it is in.
    run(&mut window, "pick", &["Study"]);
    run(&mut window, "inspector", &["off"]);
    for (id, text) in [("rename", "Den"), ("set-function", "office"), ("set-note", "Dark")] {
        run(&mut window, id, &[]);
        window.key(egui::Modifiers::COMMAND, egui::Key::A);
        window.text(text);
        window.key(egui::Modifiers::NONE, egui::Key::Enter);
        window.settle().unwrap();
    }
    let room = picked(&window);
    assert_eq!((&*room.name, &*room.function, &*room.note), ("Den", "office", "Dark"));
}

#[test]
fn a_question_comes_first_and_has_its_own_answers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.plan.json");
    let mut window = window_with("dwelling");
    run(&mut window, "pick", &["Study"]);
    run(&mut window, "label-hall", &[]);
    run(&mut window, "close", &[]);
    let error = refusal(&mut window, "label-big", &[]);
    assert_eq!(error, "'label-big' is not available: answer 'Save changes to House with an enfilade?' first");
    let error = refusal(&mut window, "answer", &["replace"]);
    assert_eq!(
        error,
        "ANSWER of 'answer' is 'replace': expected a button of the question: 'save', 'discard' or 'cancel'"
    );
    run(&mut window, "answer", &["cancel"]);
    run(&mut window, "close", &[]);
    run(&mut window, "answer", &["save", path.to_str().unwrap()]);
    assert_eq!(window.app().plan(), None);
    assert!(path.exists());
}

#[test]
fn the_view_goes_where_it_is_told() {
    let mut window = window_with("dwelling");
    let apart = |window: &Offscreen| {
        let at = |x| window.app().screen_position(x, 0.0).unwrap();
        f64::from(at(1.0).distance(at(0.0)))
    };
    run(&mut window, "view", &["3.5", "2", "100"]);
    assert!((apart(&window) - 100.0).abs() < 0.1, "{}", apart(&window));
    run(&mut window, "zoom-to", &["2", "2", "1", "1"]);
    assert!(apart(&window) > 200.0, "{}", apart(&window));
    let middle = window.app().screen_position(2.5, 2.5).unwrap();
    run(&mut window, "view", &["2.5", "2.5", "80"]);
    assert!(middle.distance(window.app().screen_position(2.5, 2.5).unwrap()) < 2.0);
    // A switch says what it is to be, whatever it was.
    for _ in 0..2 {
        run(&mut window, "graph", &["on"]);
        assert_eq!(window.control("Graph").unwrap().is_on, Some(true));
    }
    run(&mut window, "graph", &[]);
    assert_eq!(window.control("Graph").unwrap().is_on, Some(false));
}
