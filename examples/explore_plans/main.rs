//! How well a simulated robot finds the rooms of plans: explores each, and prints a table and the sums.
//!
//!     CARGO_PROFILE_DEV_OPT_LEVEL=2 cargo run --no-default-features --features cli --example explore_plans -- \
//!         [--noise 1] [--furniture 0] [--ajar 0] [--seed 1] [--paper] [--pictures DIR] [--store DIR] \
//!         [own] [real=DIR | next=DIR | later=DIR] [PLAN...]
//!
//! `--store` keeps what each exploration saw in a folder and takes it from there the next time: then only the rooms are
//! found anew, which takes seconds. After a change of what explores, use another folder. `--ajar` is a share of the doors.
//!
//! `own` stands for the three bundled plans and 17 that `layouts.rs` makes, `generated` for the latter alone; `real=DIR`
//! for 20 real plans below a folder, chosen by the rule in `sets.rs`, `next=DIR` for those that come after them,
//! `later=DIR` for those after these.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example talks to its user")]
#![allow(clippy::disallowed_methods, reason = "it says how long each plan took")]

mod layouts;
mod sets;
mod sketch;
mod stored;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use enfilade::geometry::areas::Shapes;
use enfilade::geometry::{Point, Segment, Vector};
use enfilade::robot::doorways::DoorwayOptions;
use enfilade::robot::explore::Activity;
use enfilade::robot::rooms::{RoomOptions, find_rooms};
use enfilade::robot::score::{Fate, Score, score};
use enfilade::robot::{Exploration, Pose, RobotOptions, Scanner, World, WorldOptions};
use sets::{Case, Set};
use stored::Stored;

/// What is asked for.
struct Options {
    noise: f64,
    furniture: usize,
    /// Share of the inner doors that are ajar.
    ajar: f64,
    seed: u64,
    is_papers: bool,
    pictures: Option<PathBuf>,
    store: Option<PathBuf>,
}

/// What came of one or more plans.
#[derive(Clone, Debug, Default)]
struct Counts {
    rooms: usize,
    found: usize,
    invented: usize,
    out_of_reach: usize,
    edges: usize,
    right: usize,
    wrong: usize,
    seconds: f64,
}

impl Counts {
    fn of(score: &Score, seconds: f64) -> Self {
        Self {
            rooms: score.rooms.len(),
            found: score.count(Fate::Found),
            invented: score.invented.len(),
            out_of_reach: score.unreachable.len(),
            edges: score.true_edges.len(),
            right: score.right_edges.len(),
            wrong: score.wrong_edges,
            seconds,
        }
    }

    fn sum<'a>(all: impl IntoIterator<Item = &'a Self>) -> Self {
        all.into_iter().fold(Self::default(), |sum, one| Self {
            rooms: sum.rooms + one.rooms,
            found: sum.found + one.found,
            invented: sum.invented + one.invented,
            out_of_reach: sum.out_of_reach + one.out_of_reach,
            edges: sum.edges + one.edges,
            right: sum.right + one.right,
            wrong: sum.wrong + one.wrong,
            seconds: sum.seconds + one.seconds,
        })
    }

    fn row(&self, name: &str) -> String {
        let percent = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
        format!(
            "| {name} | {} | {} | {:.1} | {} | {} | {} | {} | {:.1} | {} | {:.1} |",
            self.rooms,
            self.found,
            percent(self.found, self.rooms),
            self.invented,
            self.out_of_reach,
            self.edges,
            self.right,
            percent(self.right, self.edges),
            self.wrong,
            self.seconds
        )
    }
}

const HEAD: &str = "| plan | rooms | found | % | invented | out of reach | edges | right | % | wrong | seconds |\n\
                    | --- | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |";

/// What came of a plan: by its rooms as drawn, and with rooms as one that no wall parts.
struct Outcome {
    as_drawn: Counts,
    joined: Counts,
    has_given_up: bool,
    /// What was not found, a line each.
    remarks: Vec<String>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut options =
        Options { noise: 1.0, furniture: 0, ajar: 0.0, seed: 1, is_papers: false, pictures: None, store: None };
    let mut cases: Vec<Case> = Vec::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--noise" => options.noise = value()?.parse()?,
            "--furniture" => options.furniture = value()?.parse()?,
            "--ajar" => options.ajar = value()?.parse()?,
            "--store" => options.store = Some(PathBuf::from(value()?)),
            "--seed" => options.seed = value()?.parse()?,
            "--paper" => options.is_papers = true,
            "--pictures" => options.pictures = Some(PathBuf::from(value()?)),
            "own" => cases.extend(sets::own()?),
            "generated" => cases.extend(sets::generated()),
            path => match path.split_once('=') {
                Some(("real", folder)) => cases.extend(sets::real(Path::new(folder), 0)?),
                Some(("next", folder)) => cases.extend(sets::real(Path::new(folder), 1)?),
                Some(("later", folder)) => cases.extend(sets::real(Path::new(folder), 2)?),
                _ => {
                    let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
                    let plan = enfilade::open(path)?.plan().clone();
                    cases.push(Case { name, set: Set::Other, plan });
                }
            },
        }
    }
    for folder in [&options.pictures, &options.store].into_iter().flatten() {
        std::fs::create_dir_all(folder)?;
    }
    let next = AtomicUsize::new(0);
    let outcomes: Mutex<Vec<(usize, Result<Outcome, String>)>> = Mutex::default();
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(cases.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(case) = cases.get(index) else { break };
                    let outcome = explore(case, &options).map_err(|error| error.to_string());
                    eprintln!("{}", case.name);
                    outcomes.lock().unwrap_or_else(PoisonError::into_inner).push((index, outcome));
                }
            });
        }
    });
    let mut outcomes = outcomes.into_inner().unwrap_or_else(PoisonError::into_inner);
    outcomes.sort_by_key(|(index, _)| *index);
    println!("{HEAD}");
    let mut done: Vec<(Set, Outcome)> = Vec::new();
    let mut remarks: Vec<String> = Vec::new();
    for (index, outcome) in outcomes {
        let case = &cases[index];
        match outcome {
            Ok(outcome) => {
                println!("{}", outcome.as_drawn.row(&case.name));
                if outcome.has_given_up {
                    remarks.push(format!("{}: gave up", case.name));
                }
                remarks.extend(outcome.remarks.iter().map(|remark| format!("{}: {remark}", case.name)));
                done.push((case.set, outcome));
            }
            Err(error) => remarks.push(format!("{}: {error}", case.name)),
        }
    }
    let sums: [(&str, &[Set]); 5] = [
        ("own", &[Set::Own]),
        ("real", &[Set::RealOdd, Set::RealEven]),
        ("real, first, third, ...", &[Set::RealOdd]),
        ("real, second, fourth, ...", &[Set::RealEven]),
        ("all", &[Set::Own, Set::RealOdd, Set::RealEven, Set::Other]),
    ];
    for (title, counts) in [
        ("Sums", (|outcome| &outcome.as_drawn) as fn(&Outcome) -> &Counts),
        ("Sums, rooms without a wall between them as one", |outcome| &outcome.joined),
    ] {
        println!("\n{title}\n\n{HEAD}");
        for (name, sets) in sums {
            let of = done.iter().filter(|(set, _)| sets.contains(set)).map(|(_, outcome)| counts(outcome));
            let sum = Counts::sum(of);
            if sum.rooms > 0 {
                println!("{}", sum.row(name));
            }
        }
    }
    println!("\n{}", remarks.join("\n"));
    Ok(())
}

/// Seconds that this thread has worked: the processor's account where the system keeps one (Linux), else the clock.
fn now_s(start: std::time::Instant) -> f64 {
    let account = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = account.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| nanoseconds / 1e9)
}

fn explore(case: &Case, options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let clock = std::time::Instant::now();
    let began_s = now_s(clock);
    let &Options { noise, furniture, ajar, seed, .. } = options;
    let world_options = WorldOptions { furniture, seed, ajar_share: ajar, ..WorldOptions::default() };
    let world = Arc::new(World::new(&case.plan, &world_options));
    let mut robot = RobotOptions { seed, ..RobotOptions::default() };
    if noise == 0.0 {
        robot = robot.exact();
    }
    let tuned = |scanner: &Scanner| Scanner {
        noise_m: scanner.noise_m * noise,
        drop_out: (scanner.drop_out * noise).min(1.0),
        ..scanner.clone()
    };
    robot.scanners = robot.scanners.iter().map(tuned).collect();
    robot.odometry = robot.odometry.times(noise);
    let reach_m = robot.radius_m + robot.margin_m;
    let name = case.name.replace(['/', ' '], "_");
    let file = options.store.as_ref().map(|folder| folder.join(format!("{name}.json")));
    let before = file.as_ref().filter(|file| file.exists()).map(|file| Stored::read(file)).transpose()?;
    let seen = match before {
        Some(seen) => seen,
        None => {
            let start = world.start(reach_m, seed).ok_or("no space for the robot")?;
            let mut exploration = Exploration::new(world.clone(), Pose::new(start.x, start.y, 0.0), robot);
            let gave_up = exploration.run() != Activity::Finished;
            let walls = if options.is_papers { exploration.segments() } else { exploration.walls() };
            let seconds = now_s(clock) - began_s;
            let seen = Stored { start, walls, free: exploration.free.shapes().clone(), gave_up, seconds };
            if let Some(file) = &file {
                seen.write(file)?;
            }
            seen
        }
    };
    let start = seen.start;
    let doorways = if options.is_papers { DoorwayOptions::PAPER } else { DoorwayOptions::default() };
    let found = find_rooms(&seen.walls, &seen.free, &RoomOptions { doorways, seed, ..RoomOptions::default() });
    let rooms: Vec<Shapes> = found.rooms.iter().map(|room| moved(&room.shapes(), start)).collect();
    let edges: Vec<(usize, usize)> = found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
    let as_drawn = score(&world, start, reach_m, &rooms, &edges);
    let joined = score(&world.with_open_rooms_joined(), start, reach_m, &rooms, &edges);
    if let Some(folder) = &options.pictures {
        let by = Vector::new(start.x, start.y);
        let to_world = |segment: &Segment| Segment::new(segment.a + by, segment.b + by);
        let picture = sketch::Outcome {
            world: &world,
            score: &as_drawn,
            walls: seen.walls.iter().map(to_world).collect(),
            free: moved(&seen.free, start),
            rooms,
            found: &found,
            doorways: found.doorways.iter().map(|doorway| to_world(&doorway.segment)).collect(),
        };
        std::fs::write(folder.join(format!("{name}.png")), picture.png()?)?;
    }
    let mut remarks: Vec<String> = Vec::new();
    for room in as_drawn.rooms.iter().filter(|room| room.fate != Fate::Found) {
        let name = case.plan.room(room.id).map(|room| room.name.clone()).unwrap_or_default();
        remarks.push(format!("{} {name}: {}, IoU {:.2}", room.id, room.fate.name(), room.iou));
    }
    Ok(Outcome {
        as_drawn: Counts::of(&as_drawn, seen.seconds),
        joined: Counts::of(&joined, seen.seconds),
        has_given_up: seen.gave_up,
        remarks,
    })
}

/// Areas of the map in the world's frame: the robot starts facing along the x axis.
fn moved(shapes: &Shapes, start: Point) -> Shapes {
    let point = |&[x, y]: &[f64; 2]| [x + start.x, y + start.y];
    shapes.iter().map(|shape| shape.iter().map(|ring| ring.iter().map(point).collect()).collect()).collect()
}
