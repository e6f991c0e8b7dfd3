//! What the robot costs, and how that grows: sweeps of the simulated scanner, a scan in maps of growing size, rooms
//! of grid maps of growing size, and a real log against the time it took to record. One core; times are processor
//! times, the least of several runs, and ratios are of the same run.
//!
//!     cargo bench --no-default-features --features cli --bench robot
#![allow(clippy::unwrap_used, reason = "a benchmark that cannot go on stops")]
#![allow(clippy::print_stdout, reason = "its figures")]
#![allow(clippy::disallowed_methods, reason = "measuring needs a clock")]

use std::hint::black_box;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use enfilade::base::random::Random;
use enfilade::base::work::Work;
use enfilade::geometry::{Point, Segment};
use enfilade::robot::grid_map::{Cell, GridMap};
use enfilade::robot::log_map::map_log;
use enfilade::robot::odometry::OdometryNoise;
use enfilade::robot::scanner::back_to_back;
use enfilade::robot::segment::segment;
use enfilade::robot::{Mapper, MapperOptions, Pose, Scan, Scanner, World, WorldOptions};
use enfilade::store::{bundled_plans, load_log};

/// Seconds that this thread has worked, from any start: the processor's account where the system keeps one (Linux),
/// else the clock on the wall.
fn now_s(start: Instant) -> f64 {
    let account = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = account.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| nanoseconds / 1e9)
}

/// The least time of several runs, in seconds.
fn least_s<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    let time = |run: &mut dyn FnMut() -> T| {
        let before = now_s(start);
        black_box(run());
        now_s(start) - before
    };
    (0..runs).map(|_| time(&mut run)).fold(f64::INFINITY, f64::min)
}

fn sweeps() {
    println!("sweeps of 361 beams a second, from 200 places of each bundled plan");
    for (name, plan) in bundled_plans().unwrap() {
        let world = World::new(&plan, &WorldOptions::default());
        let scanner = Scanner::lms200(Pose::IDENTITY);
        let places: Vec<Pose> =
            (0..200).filter_map(|seed| world.start(0.3, seed).map(|at| Pose::new(at.x, at.y, seed as f64))).collect();
        let mut random = Random::new(1);
        let seconds =
            least_s(5, || places.iter().map(|&at| scanner.scan(&world, at, &mut random).ranges_m.len()).sum::<usize>());
        println!("  {name:<24} {:9.0}", places.len() as f64 / seconds);
    }
}

/// A street of rooms: a corridor 2.4 m wide, with a niche-like room of 4 by 3 m on both sides every 5 m.
fn street(rooms: usize) -> World {
    let mut walls = Vec::new();
    let mut wall = |x: f64, y: f64, to_x: f64, to_y: f64| {
        walls.push(Segment::new(Point::new(x, y), Point::new(to_x, to_y)));
    };
    for at in 0..rooms {
        let left = 5.0 * at as f64;
        for side in [1.0, -1.0] {
            let y = 1.2 * side;
            wall(left, y, left + 2.0, y);
            wall(left + 3.0, y, left + 5.0, y);
            // The jambs, then the room behind. Rooms differ in depth, so that places can be told apart.
            let deep = y + side * (2.5 + 0.1 * ((7 * at) % 11) as f64);
            wall(left + 2.0, y, left + 2.0, y + 0.2 * side);
            wall(left + 3.0, y, left + 3.0, y + 0.2 * side);
            wall(left + 0.5, y + 0.2 * side, left + 2.0, y + 0.2 * side);
            wall(left + 3.0, y + 0.2 * side, left + 4.5, y + 0.2 * side);
            wall(left + 0.5, y + 0.2 * side, left + 0.5, deep);
            wall(left + 4.5, y + 0.2 * side, left + 4.5, deep);
            wall(left + 0.5, deep, left + 4.5, deep);
        }
    }
    let end = 5.0 * rooms as f64;
    wall(0.0, -1.2, 0.0, 1.2);
    wall(end, -1.2, end, 1.2);
    World::of_obstacles(walls)
}

fn growth() {
    println!("\na look of two scans, matched and fused, while the map grows: usual noise, 0.25 m a step");
    println!(
        "  {:>6} {:>7} {:>8} {:>12} {:>20} {:>8}",
        "rooms", "looks", "lines", "µs a look", "µs, last 100 looks", "ratio"
    );
    let mut first = None;
    for rooms in [16, 64, 256] {
        let world = Arc::new(street(rooms));
        let scanners = back_to_back(Scanner::lms200);
        let noise = OdometryNoise::default();
        let mut random = Random::new(1);
        let (mut truth, mut odometry) = (Pose::new(1.0, 0.0, 0.0), Pose::IDENTITY);
        let mut looks: Vec<(Pose, Vec<Scan>)> = Vec::new();
        while truth.x_m < 5.0 * rooms as f64 - 2.0 {
            looks.push((odometry, scanners.iter().map(|scanner| scanner.scan(&world, truth, &mut random)).collect()));
            // What the wheels report while the robot is steered along the middle of the corridor.
            let step = Pose::new(0.25, 0.0, 0.0);
            let reported = truth.between(Pose::new(truth.x_m + step.x_m, 0.0, 0.0));
            odometry = odometry.compose(reported);
            truth = truth.compose(noise.sample(reported, &mut random));
        }
        // The last hundred by themselves: the processor's account is too coarse for a single look.
        let last = looks.len() - 100;
        let (mut all_s, mut last_s) = (f64::INFINITY, f64::INFINITY);
        let mut lines = 0;
        let start = Instant::now();
        for _ in 0..3 {
            let mut mapper = Mapper::new(MapperOptions::default());
            let from = now_s(start);
            let mut before_last = from;
            for (at, (odometry, scans)) in looks.iter().enumerate() {
                if at == last {
                    before_last = now_s(start);
                }
                black_box(mapper.add(*odometry, scans));
            }
            let to = now_s(start);
            (all_s, last_s) = (all_s.min(to - from), last_s.min(to - before_last));
            lines = mapper.map().lines().count();
        }
        let (all, last) = (1e6 * all_s / looks.len() as f64, 1e4 * last_s);
        let ratio = last / *first.get_or_insert(last);
        println!("  {rooms:>6} {:>7} {lines:>8} {all:>12.0} {last:>20.0} {ratio:>8.2}", looks.len());
    }
}

/// A floor of rooms of about 5 by 4 m, with doors of a metre, on a grid of 0.05 m.
fn floor(side: usize) -> GridMap {
    let (across, up) = (100, 80);
    let is_wall = |x: usize, y: usize| {
        let (column, row) = (x % across, y % up);
        let in_door = |at: usize, from: usize| (from..from + 20).contains(&at);
        let is_outer = x < 4 || y < 4 || x + 4 >= side || y + 4 >= side;
        is_outer
            || (column < 4 && !in_door(row, 30 + (x / across) % 15))
            || (row < 4 && !in_door(column, 40 + (y / up) % 20))
    };
    let cell = |at: usize| if is_wall(at % side, at / side) { Cell::Occupied } else { Cell::Free };
    GridMap::new(side, side, 0.05, Pose::IDENTITY, (0..side * side).map(cell).collect()).unwrap()
}

fn grids() {
    println!("\nrooms of a grid map");
    println!("  {:>10} {:>7} {:>9} {:>18} {:>8}", "pixels", "rooms", "s", "µs a 1000 pixels", "ratio");
    let mut first = None;
    for side in [320, 640, 1000, 2000, 4000] {
        let map = floor(side);
        let rooms = segment(&map).rooms;
        let seconds = least_s(if side > 1000 { 2 } else { 5 }, || segment(&map));
        let each = 1e9 * seconds / (side * side) as f64;
        println!(
            "  {:>10} {rooms:>7} {seconds:>9.3} {each:>18.0} {:>8.2}",
            side * side,
            each / *first.get_or_insert(each)
        );
    }
}

fn logs() {
    println!("\na log through reading and mapping, loops closed, against the time it took to record");
    for name in ["intel.truepair.log.gz", "freiburg-079.paired.log.gz"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/robot/logs").join(name);
        if !path.exists() {
            println!("  skipped: ../shared/data/robot/logs/{name} is not there");
            continue;
        }
        let log = load_log(&path).unwrap().log;
        let recorded_s = log.readings.last().map_or(0.0, |last| last.time_s - log.readings[0].time_s);
        let scans: usize = log.readings.iter().map(|reading| reading.scans.len()).sum();
        let seconds = least_s(3, || {
            let log = load_log(&path).unwrap().log;
            map_log(&log, &MapperOptions::default(), &Work::quiet().on_threads(1)).unwrap().map.len()
        });
        println!(
            "  {name:<28} {scans:>6} scans {seconds:>7.2} s of {recorded_s:>6.0} s: {:.0} times faster",
            recorded_s / seconds
        );
    }
}

fn main() {
    let only: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let benches: [(&str, fn()); 4] = [("sweeps", sweeps), ("growth", growth), ("grids", grids), ("logs", logs)];
    for (name, run) in benches {
        if only.is_empty() || only.iter().any(|wanted| wanted == name) {
            run();
        }
    }
}
