//! How well a simulated robot finds the rooms of plans: explores each, and prints a line for each and the sum.
//!
//!     cargo run --release --example explore_plans -- [--noise 1] [--furniture 0] [--seed 1] [--paper] PLAN... [generated]
//!
//! `generated` stands for the plans that `layouts.rs` makes.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]
#![allow(clippy::disallowed_methods, reason = "it says how long each plan took")]

mod layouts;

use std::error::Error;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use enfilade::geometry::Point;
use enfilade::geometry::areas::Shapes;
use enfilade::plan::Plan;
use enfilade::robot::doorways::DoorwayOptions;
use enfilade::robot::explore::Activity;
use enfilade::robot::rooms::{FoundRooms, RoomOptions};
use enfilade::robot::score::{Fate, Score, score};
use enfilade::robot::{Exploration, Pose, RobotOptions, Scanner, World, WorldOptions};

/// What is asked for.
struct Options {
    noise: f64,
    furniture: usize,
    seed: u64,
    is_papers: bool,
}

/// What came of all plans: by the plans' rooms, and with rooms as one that no wall parts.
#[derive(Default)]
struct Sum {
    as_drawn: Counts,
    joined: Counts,
}

#[derive(Default)]
struct Counts {
    rooms: usize,
    found: usize,
    edges: usize,
    right: usize,
    wrong: usize,
}

impl Counts {
    fn add(&mut self, score: &Score) {
        self.rooms += score.rooms.len();
        self.found += score.count(Fate::Found);
        self.edges += score.true_edges.len();
        self.right += score.right_edges.len();
        self.wrong += score.wrong_edges;
    }

    fn line(&self) -> String {
        let percent = |part: usize, of: usize| 100.0 * part as f64 / of.max(1) as f64;
        format!(
            "{} of {} rooms ({:.1} %), {} of {} edges ({:.1} %), {} wrong",
            self.found,
            self.rooms,
            percent(self.found, self.rooms),
            self.right,
            self.edges,
            percent(self.right, self.edges),
            self.wrong
        )
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut options = Options { noise: 1.0, furniture: 0, seed: 1, is_papers: false };
    let mut plans: Vec<(String, Plan)> = Vec::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--noise" => options.noise = value()?.parse()?,
            "--furniture" => options.furniture = value()?.parse()?,
            "--seed" => options.seed = value()?.parse()?,
            "--paper" => options.is_papers = true,
            "generated" => plans.extend(layouts::plans()),
            path => {
                let plan = enfilade::open(path)?.plan().clone();
                let name = Path::new(path).file_name().unwrap_or_default().to_string_lossy().into_owned();
                plans.push((name, plan));
            }
        }
    }
    let next = AtomicUsize::new(0);
    let sum = Mutex::new(Sum::default());
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((name, plan)) = plans.get(next.fetch_add(1, Ordering::Relaxed)) {
                    explore(name, plan, &options, &sum);
                }
            });
        }
    });
    let sum = sum.into_inner().unwrap_or_else(PoisonError::into_inner);
    println!("all plans, rooms as drawn: {}", sum.as_drawn.line());
    println!("all plans, rooms without a wall between them as one: {}", sum.joined.line());
    Ok(())
}

fn explore(name: &str, plan: &Plan, options: &Options, sum: &Mutex<Sum>) {
    let began = std::time::Instant::now();
    let &Options { noise, furniture, seed, .. } = options;
    let world = Arc::new(World::new(plan, &WorldOptions { furniture, seed, ..WorldOptions::default() }));
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
    let Some(start) = world.start(reach_m, seed) else {
        println!("{name}: no space for the robot");
        return;
    };
    let mut exploration = Exploration::new(world.clone(), Pose::new(start.x, start.y, 0.0), robot);
    let ended = if exploration.run() == Activity::Finished { "" } else { ", gave up" };
    let doorways = if options.is_papers { DoorwayOptions::PAPER } else { DoorwayOptions::default() };
    let found = exploration.rooms(&RoomOptions { doorways, seed, ..RoomOptions::default() });
    let as_drawn = score_of(&world, start, reach_m, &found, &exploration);
    let joined = score_of(&world.with_open_rooms_joined(), start, reach_m, &found, &exploration);
    let mut sum = sum.lock().unwrap_or_else(PoisonError::into_inner);
    let mut counts = Counts::default();
    counts.add(&as_drawn);
    sum.as_drawn.add(&as_drawn);
    sum.joined.add(&joined);
    println!(
        "{name}: {}; {} split, {} merged, {} missed, {} invented, {} out of reach; {} frontiers left, {} steps, {} \
         collisions, {:.1} s{ended}",
        counts.line(),
        as_drawn.count(Fate::Split),
        as_drawn.count(Fate::Merged),
        as_drawn.count(Fate::Missed),
        as_drawn.invented.len(),
        as_drawn.unreachable.len(),
        exploration.frontiers().len(),
        exploration.path.len(),
        exploration.collisions(),
        began.elapsed().as_secs_f64()
    );
    for room in as_drawn.rooms.iter().filter(|room| room.fate != Fate::Found) {
        let name = plan.room(room.id).map(|room| room.name.clone()).unwrap_or_default();
        println!("    {} {name}: {}, IoU {:.2}", room.id, room.fate.name(), room.iou);
    }
}

fn score_of(world: &World, start: Point, reach_m: f64, found: &FoundRooms, exploration: &Exploration) -> Score {
    let moved = |shapes: Shapes| -> Shapes {
        let point = |[x, y]: [f64; 2]| {
            let point = exploration.world_from_map.apply(Point::new(x, y));
            [point.x, point.y]
        };
        shapes
            .into_iter()
            .map(|shape| shape.into_iter().map(|ring| ring.into_iter().map(point).collect()).collect())
            .collect()
    };
    let rooms: Vec<Shapes> = found.rooms.iter().map(|room| moved(room.shapes())).collect();
    let edges: Vec<(usize, usize)> = found.sides.iter().filter_map(|sides| Some((sides[0]?, sides[1]?))).collect();
    score(world, start, reach_m, &rooms, &edges)
}
