//! Tracing six real offices in the window: scripts of clicks and keys, generated from the truth the way a
//! person would work, are replayed, and the result is compared with the truth.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the table is what the test is for")]

mod person;
mod planner;
mod truth;

use std::path::{Path, PathBuf};

use egui::{PointerButton, Pos2, pos2};
use enfilade::app::replay::{ReplayOptions, ScriptFile, replay};
use enfilade::app::{Offscreen, OffscreenOptions};
use enfilade::formats;
use enfilade::geometry::{Bounds, Point, polygon};
use enfilade::plan::Plan;

use person::{Count, Person, View};
use planner::Planner;
use truth::{Grid, Judged, Truth, judge};

/// Offices whose pictures are there, with the width of each picture in pixels over the 1000 units of
/// its truth.
const OFFICES: [&str; 6] = ["AtlanticSuites", "ED21", "OfficePlan", "floorplanMAIN", "magenta", "poli"];

/// Those that stay within 60 % even of four corners and a door's two clicks a room, which is less than
/// their rooms have.
const BY_FOUR_CORNERS: [&str; 2] = ["ED21", "floorplanMAIN"];

/// The one that is traced unless all are asked for: the fewest rooms, and those with the most corners.
const QUICK: &str = "magenta";

const WINDOW: (u32, u32) = (1920, 1200);

struct Traced {
    name: String,
    rooms: usize,
    doors: usize,
    corners: usize,
    count: Count,
    judged: Judged,
}

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data")
}

/// The window up to the first gesture of tracing, done by hand and noted.
struct Start {
    window: Offscreen,
    lines: Vec<String>,
    count: Count,
}

impl Start {
    fn new() -> Self {
        let options = OffscreenOptions { width: WINDOW.0, height: WINDOW.1, ..OffscreenOptions::default() };
        let mut start = Self { window: Offscreen::new(options), lines: Vec::new(), count: Count::default() };
        start.lines.push(format!("size {}x{}", WINDOW.0, WINDOW.1));
        start.window.settle().unwrap();
        start.key(egui::Key::N, "Ctrl+N");
        start
    }

    fn key(&mut self, key: egui::Key, chord: &str) {
        let modifiers = if chord.starts_with("Ctrl") {
            egui::Modifiers::CTRL | egui::Modifiers::COMMAND
        } else {
            egui::Modifiers::NONE
        };
        self.window.key(modifiers, key);
        self.window.settle().unwrap();
        self.lines.push(format!("key {chord}"));
        self.count.keys += chord.split('+').count();
    }

    fn press(&mut self, control: &str) {
        assert!(self.window.click_control(control), "no control {control:?}");
        self.window.settle().unwrap();
        self.lines.push(format!("click control {control:?}"));
        self.count.picture += 1;
    }

    fn click(&mut self, at: Pos2) {
        self.window.clicks(PointerButton::Primary, at, 1);
        self.window.settle().unwrap();
        self.lines.push(format!("click pixel {},{}", at.x, at.y));
        self.count.picture += 1;
    }

    /// Lays a picture under the plan: a menu, its entry, and the file's name in a dialog.
    fn lay_picture(&mut self, picture: &Path) {
        self.lines.push(format!("file-dialog open {:?}", picture.file_name().unwrap().to_str().unwrap()));
        self.window.answer_dialog(Some(picture.to_owned()));
        self.press("Picture");
        self.press("Add picture…");
        self.count.picture += 1;
    }

    /// Where a pixel of the picture is in the plan.
    fn plan_of_pixel(&self, x_px: f64, y_px: f64) -> Point {
        let backdrop = self.window.app().plan().and_then(Plan::backdrop).unwrap();
        let size_m = backdrop.metres_per_pixel;
        Point::new(backdrop.origin.x + x_px * size_m, backdrop.origin.y - y_px * size_m)
    }

    /// Sets the scale by a length that is known between two pixels of the picture.
    fn set_scale(&mut self, from_px: Point, to_px: Point, length_m: f64) {
        self.press("Picture");
        self.press("Set scale by a length");
        for place in [from_px, to_px] {
            let at = self.on_screen(self.plan_of_pixel(place.x, place.y));
            self.click(at.round());
        }
        let typed = format!("{length_m:.2}");
        self.window.text(&typed);
        self.window.settle().unwrap();
        self.lines.push(format!("type {typed:?}"));
        self.window.key(egui::Modifiers::NONE, egui::Key::Enter);
        self.window.settle().unwrap();
        self.lines.push("key Enter".to_owned());
        self.count.picture += typed.len() + 1;
    }

    fn on_screen(&self, point: Point) -> Pos2 {
        self.window.app().screen_position(point.x, point.y).unwrap()
    }

    fn canvas(&self) -> egui::Rect {
        self.window.controls().into_iter().find(|control| control.role == egui::Role::Canvas).unwrap().rect
    }

    fn px_per_m(&self) -> f64 {
        f64::from((self.on_screen(Point::new(100.0, 0.0)) - self.on_screen(Point::default())).x) / 100.0
    }

    fn plan_point(&self, at: Pos2) -> Point {
        let origin = self.on_screen(Point::default());
        let px = self.px_per_m();
        Point::new(f64::from(at.x - origin.x) / px, -f64::from(at.y - origin.y) / px)
    }

    /// Pans and turns the wheel until an area fills the canvas.
    fn look_at(&mut self, area: Bounds) {
        let canvas = self.canvas().shrink(24.0);
        let middle = self.on_screen(area.center());
        if (middle - canvas.center()).length() > 20.0 {
            let from =
                pos2(middle.x.clamp(canvas.left(), canvas.right()), middle.y.clamp(canvas.top(), canvas.bottom()))
                    .round();
            let to = (from + (canvas.center() - middle)).round();
            let way = [from, from + (to - from) / 2.0, to];
            self.window.drag_along(PointerButton::Middle, &way);
            self.window.settle().unwrap();
            self.lines.push(format!("drag middle pixel {},{} to pixel {},{}", from.x, from.y, to.x, to.y));
            self.count.view += 2;
        }
        let fits = |start: &Self, factor: f64| {
            let px = start.px_per_m() * factor;
            area.width() * px <= f64::from(canvas.width()) && area.height() * px <= f64::from(canvas.height())
        };
        let at = canvas.center().round();
        while !fits(self, 1.0) {
            self.wheel(-1, at);
        }
        while fits(self, 1.23) {
            self.wheel(1, at);
        }
    }

    /// What is on the screen now; the gestures since the last time are handed over.
    fn view(&mut self) -> View {
        let canvas = self.canvas();
        View {
            px_per_m: self.px_per_m(),
            seen: Bounds::of([self.plan_point(canvas.min), self.plan_point(canvas.max)]),
            pixel: self.plan_point(pos2(0.0, 0.0)),
            lines: std::mem::take(&mut self.lines),
            count: std::mem::take(&mut self.count),
        }
    }

    fn wheel(&mut self, lines: i32, at: Pos2) {
        self.window.move_to(at);
        self.window.settle().unwrap();
        self.window.wheel(lines as f32);
        self.window.settle().unwrap();
        self.lines.push(format!("scroll {lines} pixel {},{}", at.x, at.y));
        self.count.view += 1;
    }
}

/// Traces an office; `None` where its files are not there.
fn trace(name: &str) -> Option<Traced> {
    let xml = data().join(format!("authors/office/{name}.xml"));
    if !xml.is_file() {
        return None;
    }
    let import = formats::read_file(&xml).unwrap();
    let [imported] = import.plans.as_slice() else { panic!("{name} is one storey") };
    // Kept to look at.
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tracing").join(name);
    // What an earlier run left would be judged in place of this one's.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let picture = ["png", "jpg"].map(|ending| data().join(format!("images/{name}.{ending}")));
    let picture = picture.into_iter().find(|path| path.is_file())?;
    let beside = folder.join(picture.file_name().unwrap());
    std::fs::copy(&picture, &beside).unwrap();

    let mut start = Start::new();
    start.lay_picture(&beside);
    // Pixels of the picture of a metre of the truth: 1000 units of the file are the picture's width.
    let unit_m = imported.meta().scale.metres_per_unit.unwrap();
    let [width_px, _] = enfilade::store::pictures::load_picture(&beside, 1).unwrap().levels.size_px();
    let px_per_m = f64::from(width_px) / 1000.0 / unit_m;
    let pixel = |point: Point| Point::new(point.x * px_per_m, -point.y * px_per_m);
    // The longest side of a room is the length that is known.
    let untouched = Truth::new(imported, |point| point);
    let sides = untouched.rooms.iter().flat_map(|room| polygon::edges(&room.outer));
    let known = sides.max_by(|p, q| p.length().total_cmp(&q.length())).unwrap();
    start.set_scale(pixel(known.a), pixel(known.b), known.length());
    let truth = Truth::new(imported, |point| {
        let Point { x, y } = pixel(point);
        start.plan_of_pixel(x, y)
    });
    let grid = Grid::new(&truth);
    start.look_at(truth.bounds());
    let person = Person::new(start.view());
    let mut planner = Planner::new(&truth, &grid);
    planner.talk = std::env::var_os("TRACING_TALK").is_some();
    let person = planner.trace(person, |area| {
        start.look_at(area);
        start.view()
    });

    let mut lines = person.lines.clone();
    lines.extend(
        ["key V", "fit", "file-dialog save traced", "save", "expect file traced.plan.json exists"].map(str::to_owned),
    );
    let path = folder.join(format!("{name}.replay"));
    std::fs::write(&path, lines.join("\n") + "\n").unwrap();
    let script = ScriptFile { path, title: name.to_owned() };
    let report = replay(&script, &ReplayOptions { out: Some(folder.clone()), ..ReplayOptions::default() });
    for failure in &report.failures {
        println!("{name}.replay:{}: {failure}", failure.line);
    }
    let traced = formats::read_file(&folder.join(name).join("traced.plan.json")).unwrap();
    let judged = judge(&truth, &grid, &traced.plans[0]);
    let foreseen = judge(&truth, &grid, &person.plan);
    if planner.talk {
        println!("foreseen: worst {:.3}, wrong {:?}", foreseen.worst(), foreseen.wrong);
    }
    Some(Traced {
        name: name.to_owned(),
        rooms: truth.rooms.len(),
        doors: truth.doors.len(),
        corners: truth.corners,
        count: person.count,
        judged,
    })
}

#[test]
fn offices_are_traced_with_at_most_60_percent_of_the_clicks() {
    let only = std::env::var("TRACING_OFFICE").ok();
    let offices = OFFICES.into_iter().filter(|name| match only.as_deref() {
        Some(only) => only == *name,
        None => crate::support::is_whole() || *name == QUICK,
    });
    let traced: Vec<Traced> = std::thread::scope(|scope| {
        let threads: Vec<_> = offices.map(|name| scope.spawn(move || trace(name))).collect();
        threads.into_iter().filter_map(|thread| thread.join().unwrap()).collect()
    });
    if traced.is_empty() {
        println!("skipped: ../shared/data/authors/office is not there");
        return;
    }
    println!(
        "| office | rooms | doors | worst area | wrong connections | clicks, keys, view, picture | all | theirs | % | with their corners | % |"
    );
    for office in &traced {
        let (count, judged) = (office.count, &office.judged);
        let (strict, drawn) = (6 * office.rooms, office.corners + 2 * office.doors);
        println!(
            "| {} | {} | {} | {:.1} % | {} | {} + {} + {} + {} | {} | {strict} | {:.0} | {drawn} | {:.0} |",
            office.name,
            office.rooms,
            office.doors,
            judged.worst() * 100.0,
            judged.wrong.len(),
            count.clicks,
            count.keys,
            count.view,
            count.picture,
            count.all(),
            count.all() as f64 / strict as f64 * 100.0,
            count.all() as f64 / drawn as f64 * 100.0,
        );
        if !judged.wrong.is_empty() || judged.worst() > 0.05 {
            let off: Vec<(usize, f64)> =
                judged.errors.iter().copied().enumerate().filter(|(_, off)| *off > 0.05).collect();
            println!("    off {off:?}, wrong {:?}, surplus {}", judged.wrong, judged.surplus);
        }
        assert!(judged.worst() <= 0.05, "{}: a room is off by more than 5 %", office.name);
        assert!(judged.wrong.is_empty(), "{}: wrong connections {:?}", office.name, judged.wrong);
        assert_eq!(judged.surplus, 0, "{}: rooms too many", office.name);
        assert!(count.all() * 100 <= drawn * 60, "{}: {} of {drawn}", office.name, count.all());
        if BY_FOUR_CORNERS.contains(&office.name.as_str()) {
            assert!(count.all() * 100 <= strict * 60, "{}: {} of {strict}", office.name, count.all());
        }
    }
}
