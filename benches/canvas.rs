//! The cost of working on a large plan, on one core: `cargo bench --bench canvas [WALLS]`.
//!
//! The goals: 60 frames a second, that is 16.7 ms a frame, with 50,000 walls; a click selects in under 5
//! ms. A frame is everything from the event to the triangles that go to a display. The analysis of rooms
//! and features runs in the background of the window, except here, where it is measured separately.

use std::path::Path;

use egui::{Key, PointerButton, Pos2, pos2};
use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::geometry::Point;
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};
use enfilade::store::save_plan;

/// Of a clock on the wall.
fn wall_ms() -> f64 {
    #[expect(clippy::disallowed_methods, reason = "a bench measures time")]
    std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64() * 1e3)
}

/// Of processor time where the system tells it (Linux), so that other programs do not disturb.
fn now_ms() -> f64 {
    if let Ok(text) = std::fs::read_to_string("/proc/thread-self/schedstat")
        && let Some(nanoseconds) = text.split(' ').next().and_then(|word| word.parse::<f64>().ok())
    {
        return nanoseconds * 1e-6;
    }
    wall_ms()
}

/// A grid of rooms of 4 m by 3 m with about so many walls, a door in every third.
fn grid(walls: usize) -> Plan {
    let side = ((walls as f64 / 2.0).sqrt().round() as usize).max(1);
    let mut builder = Builder::new(Meta { name: "Grid".to_owned(), ..Meta::default() });
    let corner = |builder: &mut Builder, x: usize, y: usize| builder.corner(Point::new(x as f64 * 4.0, y as f64 * 3.0));
    let mut count = 0;
    for y in 0..=side {
        for x in 0..=side {
            let here = corner(&mut builder, x, y);
            for (dx, dy) in [(1, 0), (0, 1)] {
                if x + dx <= side && y + dy <= side {
                    let there = corner(&mut builder, x + dx, y + dy);
                    builder.wall(here, there, 0.12);
                    count += 1;
                    if count % 3 == 0 {
                        let place = Place::Hosted { from: here, to: there, at_m: 1.5, width_m: 0.9 };
                        builder.opening("", Opening::new(OpeningKind::Door, place));
                    }
                }
            }
            if x < side && y < side {
                let ring = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| corner(&mut builder, x, y));
                builder.room("", Room { outer: ring.into(), ..Room::default() });
            }
        }
    }
    builder.plan().clone()
}

/// The slowest and the mean of some frames.
#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn told(what: &str, window: &mut Offscreen, runs: usize, mut act: impl FnMut(&mut Offscreen, usize)) {
    let (mut slowest, mut sum) = (0.0_f64, 0.0);
    for run in 0..runs {
        let before = now_ms();
        act(window, run);
        window.tessellate();
        let took = now_ms() - before;
        slowest = slowest.max(took);
        sum += took;
    }
    println!("  {what:32} {:7.2} ms, slowest {slowest:7.2} ms", sum / runs as f64);
}

/// What is done in one frame.
type Frame<'a> = &'a dyn Fn(&mut Offscreen, usize);

/// The mean of what takes several frames, and of the slowest of these; `before` each is not measured.
#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn told_frames(what: &str, window: &mut Offscreen, runs: usize, before: Frame<'_>, frames: &[Frame<'_>]) {
    let mut sums = vec![0.0; frames.len()];
    for run in 0..runs {
        before(window, run);
        window.tessellate();
        for (frame, sum) in frames.iter().zip(&mut sums) {
            let before = now_ms();
            frame(window, run);
            window.tessellate();
            *sum += now_ms() - before;
        }
    }
    let means = sums.iter().map(|sum| sum / runs as f64);
    let (all, slowest) = (means.clone().sum::<f64>(), means.fold(0.0, f64::max));
    println!("  {what:32} {all:7.2} ms in {} frames, of one at most {slowest:7.2} ms", frames.len());
}

const NOTHING: Frame<'static> = &|_, _| ();
const PRESS: Frame<'static> = &|window, _| window.button(PointerButton::Primary, true);
const RELEASE: Frame<'static> = &|window, _| window.button(PointerButton::Primary, false);

#[expect(clippy::print_stdout, reason = "a bench prints what it measured")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let walls = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(50_000);
    let plan = grid(walls);
    println!("{} walls, {} rooms, {} openings", plan.walls().len(), plan.rooms().len(), plan.openings().len());
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("grid.plan.json");
    save_plan(Path::new(&path), &plan)?;
    let mut window = Offscreen::new(OffscreenOptions::default()).without_screen_reader();
    window.open(&path);
    told("opened, all worked out", &mut window, 1, |window, _| drop(window.settle()));
    let centre = pos2(640.0, 400.0);
    let along = |run: usize| centre + egui::vec2(run as f32 * 3.0, run as f32);
    let still = |window: &mut Offscreen, at: Pos2| window.move_to(at);
    for (name, px_per_m) in [("whole plan", None), ("a wing", Some("12")), ("a room", Some("80"))] {
        match px_per_m {
            None => {
                window.run_command("fit");
            }
            Some(px_per_m) => window.run_command_with("view", &["300", "230", px_per_m])?,
        }
        window.settle()?;
        println!("{name}");
        told("pointer moves", &mut window, 20, |window, run| still(window, along(run)));
        let moves: Frame<'_> = &|window, run| still(window, along(run * 3));
        told_frames("click selects", &mut window, 10, NOTHING, &[moves, PRESS, RELEASE]);
        window.button(PointerButton::Middle, true);
        told("pans", &mut window, 20, |window, run| still(window, along(run)));
        window.button(PointerButton::Middle, false);
        told("zooms", &mut window, 10, |window, run| window.wheel(if run % 2 == 0 { 1.0 } else { -1.0 }));
        window.run_command("tool-walls");
        window.click(centre);
        told("draws: pointer moves", &mut window, 20, |window, run| still(window, along(run)));
        window.key(egui::Modifiers::NONE, Key::Escape);
        window.run_command("tool-door");
        told("door: pointer moves", &mut window, 20, |window, run| still(window, along(run)));
        window.run_command("tool-select");
    }
    told("the whole plan again", &mut window, 1, |window, _| {
        window.run_command("fit");
        window.event(egui::Event::PointerMoved(centre));
    });
    let boxed: Frame<'_> =
        &|window, _| drop(window.run_command_with("select-box", &["200,150 380,300", "touching", "replace"]));
    let shown: Frame<'_> = &|window, _| still(window, centre);
    let without: Frame<'_> = &|window, _| {
        window.run_command("clear-selection");
    };
    told_frames("box selects", &mut window, 5, without, &[boxed, shown]);
    println!("    {} selected", window.app().selection().len());
    told("many selected: pointer moves", &mut window, 20, |window, run| still(window, along(run)));
    window.run_command("clear-selection");
    window.run_command_with("view", &["300", "230", "80"])?;
    window.settle()?;
    window.run_command("tool-walls");
    let there = pos2(700.0, 420.0);
    window.click(centre);
    told("wall drawn, all worked out", &mut window, 1, |window, _| window.click(there));
    window.key(egui::Modifiers::NONE, Key::Escape);
    window.key(egui::Modifiers::NONE, Key::Escape);
    window.run_command("tool-select");
    drop(window);

    // As on a screen: what follows from an edit is worked out beside the frames.
    let mut window = Offscreen::new(OffscreenOptions::default()).without_screen_reader().working_beside();
    window.open(&path);
    rest(&mut window);
    window.run_command_with("view", &["300", "230", "80"])?;
    rest(&mut window);
    println!("edits, worked out beside");
    window.run_command("tool-walls");
    window.click(centre);
    let moves: Frame<'_> = &|window, run| still(window, there + egui::vec2(20.0, 35.0) * run as f32);
    told_frames("wall drawn", &mut window, 6, NOTHING, &[moves, PRESS, RELEASE]);
    told("not worked out: pointer moves", &mut window, 20, |window, run| still(window, along(run)));
    window.key(egui::Modifiers::NONE, Key::Escape);
    window.key(egui::Modifiers::NONE, Key::Escape);
    window.run_command("tool-select");
    told("undone", &mut window, 5, |window, _| {
        window.run_command("undo");
    });
    told("redone", &mut window, 5, |window, _| {
        window.run_command("redo");
    });
    rest(&mut window);
    // A corner of rooms, with all that share it.
    let corner = window.app().screen_position(300.0, 231.0).unwrap_or(centre);
    let drags: Frame<'_> = &|window, _| {
        window.run_command("undo");
        window.click(corner + egui::vec2(60.0, 40.0));
        window.move_to(corner);
        window.button(PointerButton::Primary, true);
        (0..4).for_each(|step| still(window, corner + egui::vec2(step as f32 * 2.0, 9.0)));
    };
    drags(&mut window, 0);
    told("a corner is dragged", &mut window, 20, |window, run| {
        still(window, corner + egui::vec2(run as f32 * 2.0, 9.0))
    });
    window.key(egui::Modifiers::NONE, Key::Escape);
    window.button(PointerButton::Primary, false);
    told_frames("and dropped", &mut window, 5, drags, &[RELEASE, shown]);
    told("edit after edit", &mut window, 6, |window, run| {
        window.run_command(if run % 2 == 0 { "undo" } else { "redo" });
        still(window, centre);
    });
    let before = wall_ms();
    rest(&mut window);
    println!("  {:32} {:7.2} ms", "all worked out after", wall_ms() - before);
    Ok(())
}

/// Frames until nothing is worked out any more.
fn rest(window: &mut Offscreen) {
    window.event(egui::Event::PointerGone);
    while window.is_working() {
        std::thread::sleep(std::time::Duration::from_millis(2));
        window.event(egui::Event::PointerGone);
    }
    drop(window.settle());
}
