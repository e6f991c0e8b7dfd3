//! Recordings: replaying the recorded script repeats whatever was done in the window. The plan is the
//! same, byte for byte, and so is its picture.

use std::path::Path;

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, pos2, vec2};
use enfilade::app::{
    Offscreen, OffscreenOptions,
    commands::COMMANDS,
    replay::{ReplayOptions, ScriptFile, replay},
};
use enfilade::base::random::Random;
use enfilade::picture::Picture;
use libtest_mimic::{Failed, Trial};

use crate::passed;

/// How many sessions are recorded, in as many tests as run well side by side.
const TRIALS: u64 = 4;
const SESSIONS_PER_TRIAL: u64 = 4;

pub fn trials() -> Vec<Trial> {
    let random = (0..TRIALS).map(|trial| {
        Trial::test(format!("recordings/any_use_{trial}"), move || {
            let seeds = (0..SESSIONS_PER_TRIAL).map(|session| trial * SESSIONS_PER_TRIAL + session);
            let compared = seeds.map(any_use).collect::<Result<Vec<bool>, _>>()?;
            assert!(compared.contains(&true), "no session came to its end");
            Ok(())
        })
    });
    random
        .chain([Trial::test("recordings/read_well", reads_well), Trial::test("recordings/undo_before_start", undo)])
        .collect()
}

fn window() -> Offscreen {
    Offscreen::new(OffscreenOptions::default())
}

/// Ends a recording and saves it.
fn save(window: &mut Offscreen, path: &Path) {
    window.forget_answers();
    window.answer_dialog(Some(path.to_owned()));
    window.run_command_with("record-script", &["off"]).unwrap();
    window.settle().unwrap();
    assert!(!window.app().is_recording(), "{:?}", window.app().messages());
}

fn reads_well() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("session.replay");
    let mut window = window();
    window.open_bundled("dwelling");
    window.settle()?;
    window.run_command("graph");
    window.run_command_with("record-script", &["on"]).unwrap();
    window.settle()?;
    // By pointer, by key, by menu, by typing.
    let kitchen = window.controls().into_iter().rfind(|control| control.name == "Kitchen").expect("there is one");
    window.click(kitchen.rect.center());
    window.settle()?;
    window.key(Modifiers::NONE, Key::B);
    window.settle()?;
    window.click_control("View");
    window.settle()?;
    window.click_control("Grid");
    window.settle()?;
    window.key(Modifiers::NONE, Key::F2);
    window.settle()?;
    window.key(Modifiers::COMMAND, Key::A);
    window.text("Cooking \"place\"");
    window.key(Modifiers::NONE, Key::Enter);
    window.settle()?;
    window.move_to(kitchen.rect.center());
    window.wheel(3.0);
    window.settle()?;
    window.answer_dialog(Some(folder.path().join("mine")));
    window.key(Modifiers::COMMAND, Key::S);
    window.settle()?;
    save(&mut window, &path);
    let text = std::fs::read_to_string(&path)?;
    crate::support::assert_text(&crate::tests("recordings/session.txt"), &text);
    passed(&replay(&ScriptFile { path, title: "session".to_owned() }, &ReplayOptions::default()))
}

/// What lies before a recording is no part of it.
fn undo() -> Result<(), Failed> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("before.replay");
    let mut window = window();
    window.open_bundled("dwelling");
    window.settle()?;
    window.run_command("next-room");
    window.run_command("label-hall");
    window.settle()?;
    let error = window.run_command_with("record-script", &["on"]).expect_err("the plan is not saved");
    assert!(error.to_string().contains("save the plan first"), "{error}");
    window.run_command_with("save-as", &[&folder.path().join("mine.plan.json").to_string_lossy()]).unwrap();
    window.settle()?;
    window.run_command_with("record-script", &["on"]).unwrap();
    window.settle()?;
    window.run_command("label-big");
    window.settle()?;
    window.answer_dialog(Some(path.clone()));
    for _ in 0..2 {
        window.run_command("undo");
        window.settle()?;
    }
    assert!(!window.app().is_recording());
    passed(&replay(&ScriptFile { path, title: "before".to_owned() }, &ReplayOptions::default()))
}

/// Records a session and replays it; gives whether it could be recorded to its end.
fn any_use(seed: u64) -> Result<bool, Failed> {
    let mut random = Random::new(seed);
    let folder = tempfile::tempdir()?;
    let mine = folder.path().join("mine");
    std::fs::create_dir(&mine)?;
    for (name, text) in &enfilade::store::BUNDLED[..2] {
        std::fs::write(mine.join(name), text)?;
    }
    std::fs::write(mine.join("broken.plan.json"), "{\"format\": \"enfilade plan\"")?;
    let mut window = window();
    match random.below(4) {
        0 => {}
        1 => window.open(&mine.join("office.plan.json")),
        2 => drop(window.open_bundled("school")),
        _ => drop(window.open_bundled("dwelling")),
    }
    window.settle()?;
    for _ in 0..random.below(6) {
        deed(&mut window, &mut random, folder.path());
    }
    window.settle()?;
    if window.run_command_with("record-script", &["on"]).is_err() {
        // Something was changed and not saved.
        return Ok(false);
    }
    window.settle()?;
    for _ in 0..40 {
        deed(&mut window, &mut random, folder.path());
        if let Some(plan) = window.app().plan() {
            assert_eq!(plan.violations(), Vec::new());
        }
        window.settle()?;
        if !window.app().is_recording() || window.is_closed() {
            // It ended: by undoing what came before it, or by closing the window.
            break;
        }
    }
    let path = folder.path().join("session.replay");
    rest(&mut window);
    if !window.app().is_recording() {
        return Ok(false);
    }
    save(&mut window, &path);
    window.event(Event::PointerGone);
    window.settle()?;
    // Messages lie over the canvas, and name files where they are.
    let mut dismissed = 0;
    while dismissed < 20 && window.run_command("dismiss-message") {
        dismissed += 1;
    }
    window.settle()?;
    let plan = window.app().canvas_rect().map(|rect| window.picture_of(rect));
    let mut text = std::fs::read_to_string(&path)?;
    if plan.is_some() {
        text.push_str(&"dismiss-message\n".repeat(dismissed));
        text.push_str("snapshot end --region canvas\n");
        std::fs::write(&path, &text)?;
    }
    let script = ScriptFile { path: path.clone(), title: "session".to_owned() };
    let update = ReplayOptions { update: true, ..ReplayOptions::default() };
    let say = |error: Failed| Failed::from(format!("seed {seed}: {}\n{text}", error.message().unwrap_or_default()));
    // The plan is compared, not made the reference.
    let report = replay(&script, &update);
    passed(&report).map_err(say)?;
    assert!(report.updated.iter().all(|path| path.ends_with("end.png")), "seed {seed}: {:?}\n{text}", report.updated);
    passed(&replay(&script, &ReplayOptions::default())).map_err(say)?;
    if let Some(plan) = plan {
        let replayed = std::fs::File::open(folder.path().join("end.png"))?;
        let replayed = Picture::from_png(std::io::BufReader::new(replayed), 1 << 24)?;
        if (replayed.width_px, replayed.height_px) == (plan.width_px, plan.height_px)
            && let Some(difference) = plan.difference(&replayed)
        {
            return Err(say(Failed::from(format!("{} pixels differ", difference.pixels))));
        }
    }
    Ok(true)
}

/// Ends what is only half done: a menu, a text, a question, a command in the palette that still asks for
/// its arguments.
fn rest(window: &mut Offscreen) {
    let _ = window.run_command_with("answer", &["cancel"]);
    for _ in 0..2 {
        window.key(Modifiers::NONE, Key::Escape);
        let _ = window.settle();
    }
    window.click(pos2(-5.0, -5.0));
    for _ in 0..3 {
        if window.app().canvas_rect().is_some() {
            break;
        }
        let _ = window.settle();
    }
    let _ = window.settle();
}

const KEYS: [(Modifiers, Key); 24] = [
    (Modifiers::NONE, Key::Tab),
    (Modifiers::SHIFT, Key::Tab),
    (Modifiers::NONE, Key::Enter),
    (Modifiers::NONE, Key::Escape),
    (Modifiers::NONE, Key::Space),
    (Modifiers::NONE, Key::ArrowLeft),
    (Modifiers::NONE, Key::ArrowDown),
    (Modifiers::NONE, Key::ArrowRight),
    (Modifiers::NONE, Key::F2),
    (Modifiers::COMMAND, Key::Z),
    (Modifiers::COMMAND, Key::Y),
    (Modifiers::COMMAND, Key::A),
    (Modifiers::COMMAND, Key::S),
    (Modifiers::NONE, Key::S),
    (Modifiers::NONE, Key::H),
    (Modifiers::NONE, Key::C),
    (Modifiers::NONE, Key::F),
    (Modifiers::SHIFT, Key::F),
    (Modifiers::NONE, Key::G),
    (Modifiers::NONE, Key::Backspace),
    (Modifiers::NONE, Key::PageDown),
    (Modifiers::NONE, Key::PageUp),
    (Modifiers::NONE, Key::CloseBracket),
    (Modifiers::NONE, Key::OpenBracket),
];

const TEXTS: [&str; 6] = ["Bed", "\"quoted\" \\ #1", "Küche 3", "bath", "  ", "x\ty"];

/// Anything a person may do.
fn deed(window: &mut Offscreen, random: &mut Random, folder: &Path) {
    let size = window.options();
    let area = Rect::from_min_size(Pos2::ZERO, vec2(size.width as f32, size.height as f32));
    let place = |random: &mut Random| {
        area.min + vec2(random.unit() as f32 * area.width(), random.unit() as f32 * area.height())
    };
    // Whatever dialog opens is told something.
    if window.answers_left() == 0 {
        let answer = match random.below(4) {
            0 => None,
            1 => Some(folder.join("mine/office.plan.json")),
            2 => Some(folder.join("mine/school.plan.json")),
            _ => Some(folder.join(format!("saved-{}", random.below(1000)))),
        };
        window.answer_dialog(answer);
    }
    match random.below(13) {
        0 | 1 => {
            let at = place(random);
            window.click(at);
        }
        2..=4 => {
            let controls = window.controls();
            let inputs: Vec<_> =
                controls.iter().filter(|control| egui::accessibility::is_input(control.role)).collect();
            if !inputs.is_empty() {
                let at = inputs[random.below(inputs.len())].rect.center();
                window.click(at);
            }
        }
        5 | 6 => {
            let (modifiers, key) = KEYS[random.below(KEYS.len())];
            window.key(modifiers, key);
        }
        7 => window.text(TEXTS[random.below(TEXTS.len())]),
        8 => {
            let at = place(random);
            window.move_to(at);
            window.wheel([-2.0, 1.0, 3.0][random.below(3)]);
        }
        9 => {
            let (from, to) = (place(random), place(random));
            let button = [PointerButton::Primary, PointerButton::Middle][random.below(2)];
            // Not where a panel would become wider or narrower: that is not recorded.
            let is_free = window.app().canvas_rect().is_some_and(|rect| rect.shrink(12.0).contains(from));
            if is_free {
                window.drag(button, from, to);
            }
        }
        10 => {
            let command = &COMMANDS[random.below(COMMANDS.len())];
            if command.id != "record-script" && command.id != "quit" {
                window.run_command(command.id);
            }
        }
        11 => match random.below(4) {
            0 => window.resize(700 + 100 * random.below(8) as u32, 500 + 100 * random.below(5) as u32),
            1 => window.drop_file(&folder.join("mine/broken.plan.json")),
            2 => window.drop_file(&folder.join("mine/office.plan.json")),
            _ => {
                let words = ["save", "discard", "cancel", "replace"];
                let _ = window.run_command_with("answer", &[words[random.below(4)]]);
            }
        },
        _ => {
            let at = place(random);
            window.clicks(PointerButton::Primary, at, 2);
        }
    }
}
