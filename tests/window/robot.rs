//! The robot in the window: its states, and what happens around it.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

use enfilade::app::Offscreen;
use enfilade::plan::Plan;
use enfilade::robot::{Exploration, Pose, RobotOptions, Scanner, World, WorldOptions};

use super::{press, texts};

/// The plan of the replay case: seven rooms.
fn house() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/replay/cases/robot/house.plan.json")
}

fn house_plan() -> Plan {
    enfilade::formats::read_file(&house()).unwrap().plans.remove(0)
}

fn window() -> Offscreen {
    let mut window = Offscreen::new(Default::default());
    window.open(&house());
    window.settle().unwrap();
    window
}

fn run(window: &mut Offscreen, id: &str, arguments: &[&str]) {
    window.run_command_with(id, arguments).unwrap_or_else(|error| panic!("{id}: {error}"));
    window.settle().unwrap();
}

fn has(window: &Offscreen, name: &str) -> bool {
    window.controls().iter().any(|control| control.name.starts_with(name))
}

/// The text behind a name in the panel.
fn figure(window: &Offscreen, name: &str) -> String {
    let start = format!("{name}: ");
    let control = window.controls().into_iter().find(|control| control.name.starts_with(&start));
    control.map(|control| control.name[start.len()..].to_owned()).unwrap_or_default()
}

#[test]
fn it_runs_pauses_steps_and_is_put_away() {
    let mut window = window();
    let before = window.app().plan().unwrap().clone();
    assert!(window.run_command_with("robot-run", &["on"]).is_err(), "no robot is out");
    run(&mut window, "explore-plan", &[]);
    assert!(has(&window, "Pause"));
    // It goes by the clock: 16 times 0.4 m/s.
    window.advance(0.5);
    let driven = figure(&window, "Driven");
    assert!(!driven.is_empty() && !driven.starts_with("0.00 m"), "{driven}");
    press(&mut window, "Pause");
    let driven = figure(&window, "Driven");
    window.advance(2.0);
    assert_eq!(figure(&window, "Driven"), driven);
    for _ in 0..4 {
        press(&mut window, "Step");
    }
    // The way and the time.
    assert_ne!(figure(&window, "Driven"), driven);
    run(&mut window, "robot-run-to", &["5m"]);
    assert!(has(&window, "Run"), "it is paused where it was to go");
    assert!(figure(&window, "Driven").starts_with("5."), "{}", figure(&window, "Driven"));
    // Another window comes to the same place.
    let mut other = self::window();
    run(&mut other, "explore-plan", &[]);
    run(&mut other, "robot-run-to", &["5m"]);
    for name in ["Driven", "Known floor", "Found", "Estimate off", "Odometry off"] {
        assert_eq!(figure(&window, name), figure(&other, name), "{name}");
    }
    press(&mut window, "Stop");
    assert!(!has(&window, "Pause") && has(&window, "Explore this plan"));
    assert_eq!(*window.app().plan().unwrap(), before);
    assert!(!window.app().has_unsaved_changes());
}

#[test]
fn other_plans_edits_and_second_runs() {
    let mut window = window();
    run(&mut window, "explore-plan", &[]);
    run(&mut window, "robot-run-to", &["1m"]);
    // The plan is edited: the run goes on.
    run(&mut window, "draw-walls", &["20,0 24,0"]);
    assert!(has(&window, "The plan was changed."), "{:?}", window.controls());
    run(&mut window, "robot-run-to", &["2m"]);
    assert!(figure(&window, "Driven").starts_with("2."));
    run(&mut window, "undo", &[]);
    assert!(!has(&window, "The plan was changed."));
    // Another plan is shown: the robot waits.
    run(&mut window, "robot-run", &["on"]);
    run(&mut window, "open-sample", &["dwelling"]);
    let driven = figure(&window, "Driven");
    window.advance(1.0);
    assert_eq!(figure(&window, "Driven"), driven);
    press(&mut window, "Show its plan");
    window.advance(0.5);
    assert_ne!(figure(&window, "Driven"), driven);
    // A second run takes the place of the first, also while the first is being prepared.
    run(&mut window, "explore-plan", &[]);
    run(&mut window, "robot-run-to", &["1m"]);
    assert!(figure(&window, "Driven").starts_with("1."), "{}", figure(&window, "Driven"));
    // With its plan the run ends.
    run(&mut window, "close", &[]);
    assert!(window.run_command_with("robot-step", &[]).is_err());
}

#[test]
fn plans_it_cannot_explore_are_said() {
    let mut window = Offscreen::new(Default::default());
    assert!(window.run_command_with("explore-plan", &[]).is_err(), "without a plan");
    run(&mut window, "new-plan", &[]);
    assert!(window.run_command_with("explore-plan", &[]).is_err(), "without rooms");
    run(&mut window, "draw-walls", &["0,0 0.5,0 0.5,0.5 0,0.5 0,0"]);
    run(&mut window, "explore-plan", &[]);
    let said = texts(&window).join("\n");
    assert!(said.contains("cannot explore") && said.contains("0.5 m wide"), "{said}");
    assert!(has(&window, "Explore again") || has(&window, "Explore this plan"));
    // The window closes while it drives.
    let mut window = self::window();
    run(&mut window, "explore-plan", &[]);
    window.ask_to_close();
    window.settle().unwrap();
    assert!(window.is_closed());
}

/// A drive of the simulated robot as a CARMEN log, with a front scanner of one reading a degree.
fn recorded(steps: usize) -> Vec<u8> {
    let world = Arc::new(World::new(&house_plan(), &WorldOptions::default()));
    let start = world.start(0.3, 1).unwrap();
    let mut exploration = Exploration::new(world, Pose::new(start.x, start.y, 0.0), RobotOptions::default());
    let mut text = String::from("# A simulated robot in a small house.\nPARAM robot_frontlaser_offset 0.1\n");
    let scanner = Scanner { step_rad: 1_f64.to_radians(), ..Scanner::lms200(Pose::IDENTITY) };
    let beams = scanner.beams();
    for step in 0..steps {
        let scan = &exploration.scans[0];
        let _ = write!(text, "FLASER {beams}");
        for beam in (0..scan.ranges_m.len()).step_by(2) {
            // Beyond what any scanner sees: no return.
            let _ = write!(text, " {:.2}", scan.range_m(beam).unwrap_or(90.0));
        }
        let Pose { x_m, y_m, heading_rad } = exploration.odometry;
        let pose = format!("{x_m:.3} {y_m:.3} {heading_rad:.4}");
        let time_s = step as f64 * 0.5;
        let _ = writeln!(text, " {pose} {pose} {time_s:.1} robot {time_s:.1}");
        exploration.step();
    }
    let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
    packed.write_all(text.as_bytes()).unwrap();
    packed.finish().unwrap()
}

/// `UPDATE_GOLDEN=1` records the log of the replay case anew.
#[test]
fn a_recorded_drive_is_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drive.log.gz");
    std::fs::write(&file, recorded(60)).unwrap();
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        let kept = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/replay/cases/robot_log/drive.log.gz");
        std::fs::write(kept, recorded(200)).unwrap();
    }
    let mut window = window();
    let before = window.app().plan().unwrap().clone();
    window.answer_dialog(Some(file.clone()));
    window.run_command("replay-log");
    window.settle().unwrap();
    run(&mut window, "robot-to-end", &[]);
    assert_eq!(figure(&window, "Log"), "100 %");
    let known = figure(&window, "Known floor");
    let known: f64 = known.split(" m²").next().unwrap().parse().unwrap();
    assert!(known > 10.0, "{known}");
    assert!(!has(&window, "Compare with the true plan"));
    // It is over a plan of its own.
    assert_eq!(window.app().plan().unwrap().rooms().len(), 0);
    run(&mut window, "close", &[]);
    assert_eq!(*window.app().plan().unwrap(), before);
    // What is no log is said, and so is a file that is not there.
    for (name, bytes) in [("none.log", &b"nothing\n"[..]), ("empty.log", b"")] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        run(&mut window, "replay-log", &[path.to_str().unwrap()]);
        assert!(texts(&window).iter().any(|text| text.contains("Cannot replay") && text.contains(name)), "{name}");
    }
}
