//! The program is killed at random moments of a scripted session: what it had acknowledged comes back,
//! and the file on disk is intact.
//!
//! A step is acknowledged once `enfilade replay --steps` has reported it. `ENFILADE_KILL_TRIALS=500 cargo
//! test --test app recovery::killed -- --nocapture` runs that many trials, and prints their results.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::base::random::Random;
use enfilade::formats::plan_json;
use enfilade::plan::Plan;
use enfilade::store::{leftovers, load_plan};

/// So many steps change the plan, or take changes back.
const CHANGES: usize = 45;

/// Trials of a normal test run.
const TRIALS: usize = 25;

/// A step of the use: a command and its arguments.
type Step = Vec<String>;

/// Edits of all kinds, undone and redone at times, saved now and then, beginning with a file.
fn use_of_all_kinds() -> Vec<Step> {
    let step = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Step>();
    let mut steps = vec![step(&["open-sample", "dwelling"]), step(&["save-as", "house.plan.json"])];
    let mut random = Random::new(2026);
    let rooms = ["Study", "Kitchen", "Bathroom", "Dressing", "Gallery", "Living room"];
    for number in 0..CHANGES {
        let room = rooms[random.below(rooms.len())];
        match random.below(12) {
            0 | 1 => steps.push(step(&["undo"])),
            2 => steps.push(step(&["redo"])),
            3 => steps.push(step(&["save"])),
            4 | 5 => {
                let at =
                    |random: &mut Random| format!("{:.1},{:.1}", 30.0 + random.unit() * 20.0, random.unit() * 20.0);
                let points = format!("{} {}", at(&mut random), at(&mut random));
                steps.push(step(&["draw-walls", &points]));
            }
            6 | 7 => steps.extend([step(&["pick", room]), step(&["set-note", &format!("note {number}")])]),
            8 => steps.push(step(&["rename-plan", &format!("House {number}")])),
            _ => {
                let label = ["label-small", "label-medium", "label-big", "label-hall"][random.below(4)];
                steps.extend([step(&["pick", room]), step(&[label])]);
            }
        }
    }
    steps
}

/// What a step led to.
struct State {
    plan: Plan,
    /// What the file held afterwards.
    file: Option<Vec<u8>>,
}

/// Does every step here and tells what it led to. Steps that cannot be done (nothing to undo) are taken out.
fn done_here(steps: &[Step]) -> (Vec<Step>, Vec<State>) {
    let folder = tempfile::tempdir().unwrap();
    let mut window = Offscreen::new(OffscreenOptions { width: 640, height: 420, ..OffscreenOptions::default() });
    let (mut kept, mut states) = (Vec::new(), Vec::new());
    let file = folder.path().join("house.plan.json");
    for step in steps {
        let mut words: Vec<&str> = step.iter().map(String::as_str).collect();
        let path = file.to_string_lossy().into_owned();
        if words[0] == "save-as" {
            words[1] = &path;
        }
        if window.run_command_with(words[0], &words[1..]).is_ok() {
            window.settle().unwrap();
            kept.push(step.clone());
            states.push(State { plan: window.app().plan().unwrap().clone(), file: std::fs::read(&file).ok() });
        }
    }
    (kept, states)
}

/// Lines of the script in front of the steps.
const BEFORE: [&str; 2] = ["size 640x420", "journal"];

fn write_script(folder: &Path, steps: &[Step]) -> PathBuf {
    let lines = steps.iter().map(|step| {
        let words = step[1..].iter().map(|word| format!(" \"{word}\""));
        format!("{}{}", step[0], words.collect::<String>())
    });
    let lines: Vec<String> = BEFORE.iter().map(|line| (*line).to_owned()).chain(lines).collect();
    let path = folder.join("use.replay");
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    path
}

/// Runs the program on a script and kills it after some time; gives how many steps it told of, and whether
/// it had come to the end by then.
fn killed_after(script: &Path, out: &Path, time: Duration) -> (usize, bool) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_enfilade"))
        .args(["replay", "--steps", "--out"])
        .arg(out)
        .arg(script)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let stdout = child.stdout.take().unwrap();
    let reader = std::thread::spawn(move || {
        let lines = BufReader::new(stdout).lines().map_while(Result::ok);
        lines.filter_map(|line| line.strip_prefix("done ")?.parse::<usize>().ok()).last().unwrap_or(0)
    });
    std::thread::sleep(time);
    // SIGKILL on Unix.
    let is_over = child.try_wait().unwrap().is_some();
    let _ = child.kill();
    let status = child.wait().unwrap();
    let line = reader.join().unwrap();
    assert!(!is_over || status.success(), "the use fails by itself");
    (line.saturating_sub(BEFORE.len()), is_over)
}

/// Where in the use a trial ended.
#[derive(Default)]
struct Tally {
    trials: usize,
    before_first: usize,
    over: usize,
    recovered: usize,
    from_file: usize,
    ahead: usize,
}

/// Checks what a killed program left: nothing acknowledged is missing, the file is whole.
fn check(work: &Path, acknowledged: usize, states: &[State], tally: &mut Tally) {
    // What the step that was being done had come to may be there or not.
    let possible = [acknowledged.checked_sub(1), (acknowledged < states.len()).then_some(acknowledged)];
    let possible: Vec<usize> = possible.into_iter().flatten().collect();
    let file = work.join("house.plan.json");
    let on_disk = std::fs::read(&file).ok();
    let is_expected = |held: &Option<Vec<u8>>| possible.iter().any(|&at| states[at].file == *held);
    assert!(
        is_expected(&on_disk) || (acknowledged == 0 && on_disk.is_none()),
        "after {acknowledged} steps the file holds something that was never saved, or saved long ago"
    );
    if on_disk.is_some() {
        load_plan(&file).unwrap();
    }
    let journal = work.join("journal");
    let found = leftovers(&journal);
    assert!(found.len() <= 1, "one plan, one journal");
    let in_journal = found.first().map(|leftover| leftover.content.as_ref().unwrap().history.plan().clone());
    drop(found);
    let is_plan = |plan: &Plan| possible.iter().any(|&at| states[at].plan == *plan);
    match &in_journal {
        Some(plan) => {
            assert!(is_plan(plan), "after {acknowledged} steps the journal gives another plan");
            tally.recovered += 1;
            tally.ahead += usize::from(acknowledged > 0 && states[acknowledged - 1].plan != *plan);
        }
        // All is in the file, or nothing was done yet.
        None => {
            let saved = on_disk.as_deref().map(|bytes| plan_json::from_bytes(bytes).unwrap());
            assert!(saved.as_ref().is_none_or(is_plan), "after {acknowledged} steps an edit is missing");
            assert!(saved.is_some() || acknowledged <= 1, "after {acknowledged} steps nothing is left");
            tally.from_file += usize::from(saved.is_some());
        }
    }
    // The window itself comes to the same.
    if let Some(plan) = in_journal {
        let mut window = Offscreen::new(OffscreenOptions { width: 640, height: 420, ..OffscreenOptions::default() });
        window.use_journal(&journal);
        window.settle().unwrap();
        window.run_command_with("recover", &["1"]).unwrap();
        window.settle().unwrap();
        assert_eq!(window.app().plan(), Some(&plan));
        assert!(window.app().has_unsaved_changes());
    }
}

#[test]
fn killed_at_any_moment_nothing_acknowledged_is_lost() {
    let trials = std::env::var("ENFILADE_KILL_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(TRIALS);
    let (steps, states) = done_here(&use_of_all_kinds());
    assert!(states.iter().filter(|state| state.file.is_some()).count() > 10 && steps.len() > CHANGES);
    let folder = tempfile::tempdir().unwrap();
    let script = write_script(folder.path(), &steps);
    // How long it takes undisturbed, and that it then comes to what it comes to here.
    let began = Instant::now();
    let whole = folder.path().join("whole");
    let output = Command::new(env!("CARGO_BIN_EXE_enfilade"))
        .args(["replay", "--steps", "--out"])
        .arg(&whole)
        .arg(&script)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let longest = began.elapsed();
    check(&whole.join("use"), steps.len(), &states, &mut Tally::default());
    let mut random = Random::new(20);
    let mut tally = Tally { trials, ..Tally::default() };
    for trial in 0..trials {
        let out = folder.path().join(trial.to_string());
        let (acknowledged, is_over) = killed_after(&script, &out, longest.mul_f64(random.unit()));
        tally.before_first += usize::from(acknowledged == 0);
        tally.over += usize::from(is_over);
        if acknowledged > 0 || out.join("use").exists() {
            check(&out.join("use"), acknowledged, &states, &mut tally);
        }
        let _ = std::fs::remove_dir_all(&out);
    }
    let Tally { trials, before_first, over, recovered, from_file, ahead } = tally;
    println!(
        "{trials} trials of {} steps within {longest:.2?}: {before_first} killed before the first step, {over} after \
         the last; {recovered} plans from the journal ({ahead} with the step that was being done), {from_file} from \
         the file; nothing acknowledged was missing",
        steps.len()
    );
    assert!(recovered > trials / 10, "the trials say little: {recovered} of {trials} found a journal");
}
