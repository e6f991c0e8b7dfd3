//! Laser logs to line maps: from the robot's readings to walls and poses.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

use enfilade::base::random::Random;
use enfilade::base::work::Work;
use enfilade::geometry::{Point, Segment, Vector, areas};
use enfilade::robot::carmen::{Log, LogError};
use enfilade::robot::log_map::{MappedLog, map_log, surroundings};
use enfilade::robot::{MapperOptions, Pose};
use enfilade::store::{load_log, read_log};

// --- a small house and a drive through it ---------------------------------------------------------

/// The inner faces of three rooms on a corridor, each joined to it by a doorway of 1 m; walls 20 cm.
fn house() -> Vec<Segment> {
    let mut walls = Vec::new();
    let mut wall = |x: f64, y: f64, to_x: f64, to_y: f64| {
        walls.push(Segment::new(Point::new(x, y), Point::new(to_x, to_y)));
    };
    // The corridor, 12 m by 2 m, with doorways in its upper wall.
    wall(0.0, 0.0, 12.0, 0.0);
    wall(12.0, 0.0, 12.0, 2.0);
    wall(0.0, 2.0, 0.0, 0.0);
    let mut x = 12.0;
    for left in [8.2, 4.2, 0.2] {
        let (door_right, door_left) = (left + 1.6, left + 0.6);
        wall(x, 2.0, door_right, 2.0);
        // The jambs.
        wall(door_right, 2.0, door_right, 2.2);
        wall(door_left, 2.2, door_left, 2.0);
        x = door_left;
        // The room behind, 3.6 m by 3 m.
        let (room_left, room_right) = (left, left + 3.6);
        wall(door_right, 2.2, room_right, 2.2);
        wall(room_right, 2.2, room_right, 5.2);
        wall(room_right, 5.2, room_left, 5.2);
        wall(room_left, 5.2, room_left, 2.2);
        wall(room_left, 2.2, door_left, 2.2);
    }
    wall(x, 2.0, 0.0, 2.0);
    walls
}

/// How far a beam goes.
fn range_m(walls: &[Segment], from: Point, towards: Vector) -> f64 {
    let hit = |wall: &Segment| {
        let along = wall.vector();
        let across = towards.cross(along);
        let way = wall.a - from;
        let (range, at) = (way.cross(along) / across, way.cross(towards) / across);
        (range > 0.0 && (0.0..=1.0).contains(&at)).then_some(range)
    };
    walls.iter().filter_map(hit).fold(81.91, f64::min)
}

/// A drive down the corridor, into each room and back: in the corridor's middle and the rooms'.
fn drive() -> Vec<Pose> {
    let stops: Vec<Point> = [(0.8, 1.0), (1.3, 1.0), (1.3, 3.8), (1.3, 1.0), (5.3, 1.0), (5.3, 3.8), (5.3, 1.0)]
        .into_iter()
        .chain([(9.3, 1.0), (9.3, 3.8), (9.3, 1.0), (11.0, 1.0), (0.8, 1.0)])
        .map(|(x, y)| Point::new(x, y))
        .collect();
    let mut poses = vec![Pose::new(0.8, 1.0, 0.0)];
    for pair in stops.windows(2) {
        let heading = (pair[1] - pair[0]).angle_rad();
        let before = poses[poses.len() - 1].heading_rad;
        let turn = Pose::new(0.0, 0.0, heading - before).heading_rad;
        let turns = (turn.abs() / 0.2).ceil();
        for i in 1..=turns as usize {
            poses.push(Pose::new(pair[0].x, pair[0].y, before + turn * i as f64 / turns));
        }
        let steps = (pair[0].distance(pair[1]) / 0.2).ceil();
        for i in 1..=steps as usize {
            let at = pair[0].lerp(pair[1], i as f64 / steps);
            poses.push(Pose::new(at.x, at.y, heading));
        }
    }
    poses
}

/// A log of the drive: readings with noise of so many metres, odometry that bends by so many radians
/// a metre and starts at `origin`; between two scans a reading of the odometry alone.
fn log_text(noise_m: f64, bend_rad_per_m: f64, origin: Pose) -> String {
    let walls = house();
    let mut random = Random::new(11);
    let mut text = String::from("# a log\nPARAM robot_frontlaser_offset 0.0 host 0\n");
    let mut odometry = origin;
    let mut before: Option<Pose> = None;
    for (at, pose) in drive().into_iter().enumerate() {
        let time = 10.0 + at as f64;
        if let Some(before) = before {
            let step = before.between(pose);
            let way = step.x_m.hypot(step.y_m);
            let half = Pose::new(step.x_m / 2.0, step.y_m / 2.0, (step.heading_rad + bend_rad_per_m * way) / 2.0);
            odometry = odometry.compose(half);
            let (x, y, theta) = (odometry.x_m, odometry.y_m, odometry.heading_rad);
            text += &format!("ODOM {x} {y} {theta} 0 0 0 {} host 0\n", time - 0.5);
            odometry = odometry.compose(half);
        }
        before = Some(pose);
        text += "FLASER 361";
        for beam in 0..361 {
            let angle = pose.heading_rad - FRAC_PI_2 + f64::from(beam) * PI / 360.0;
            let range = range_m(&walls, pose.position(), Vector::new(angle.cos(), angle.sin()));
            text += &format!(" {:.4}", range + noise_m * 3.0_f64.sqrt() * (2.0 * random.unit() - 1.0));
        }
        // The corrected pose of the archives, wrong here: nobody may use it.
        text += &format!(" 7 7 7 {} {} {} {time} host 0\n", odometry.x_m, odometry.y_m, odometry.heading_rad);
    }
    text
}

fn mapped(text: &str) -> (Log, MappedLog) {
    let log = read_log(text.as_bytes()).unwrap().log;
    let mapped = map_log(&log, &MapperOptions::default(), &Work::quiet()).unwrap();
    (log, mapped)
}

/// The poses of the scans alone.
fn at_scans(log: &Log, mapped: &MappedLog) -> Vec<Pose> {
    let readings = log.readings.iter().zip(&mapped.poses);
    readings.filter(|(reading, _)| !reading.scans.is_empty()).map(|(_, pose)| *pose).collect()
}

/// The largest error of place and heading against the drive.
fn worst(poses: &[Pose]) -> (f64, f64) {
    let truth = drive();
    let start = truth[0];
    assert_eq!(poses.len(), truth.len());
    poses.iter().zip(&truth).fold((0.0, 0.0), |(way, turn): (f64, f64), (pose, truth)| {
        let off = start.between(*truth).between(*pose);
        (way.max(off.x_m.hypot(off.y_m)), turn.max(off.heading_rad.abs()))
    })
}

/// How far the ends of the map's lines lie off the true walls, at most, in metres; the rooms are found
/// by those of 30 cm and more, and a shorter one may stand for a corner.
fn worst_line_m(mapped: &MappedLog) -> f64 {
    let (walls, start) = (house(), drive()[0]);
    let off = |point: Point| walls.iter().map(|wall| wall.distance(start.apply(point))).fold(f64::INFINITY, f64::min);
    let long = mapped.map.lines().filter(|line| line.line.length() >= 0.3);
    long.flat_map(|line| [line.line.start, line.line.end]).map(off).fold(0.0, f64::max)
}

// --- what must hold ----------------------------------------------------------------------------------

#[test]
fn without_noise_the_map_is_the_walls() {
    let (log, mapped) = mapped(&log_text(0.0, 0.0, Pose::IDENTITY));
    let (way_m, turn_rad) = worst(&at_scans(&log, &mapped));
    assert!(way_m < 0.005 && turn_rad < 0.002, "off by {way_m} m and {turn_rad} rad");
    let off_m = worst_line_m(&mapped);
    assert!(off_m < 0.015, "a line lies {off_m} m off the walls");
    // Every wall is there in its whole length, but for the corners' last centimetres.
    let start = drive()[0];
    for wall in house() {
        let found: f64 = mapped
            .map
            .lines()
            .map(|line| Segment::new(start.apply(line.line.start), start.apply(line.line.end)))
            .filter(|line| line.vector().dot(wall.vector()) > 0.0 && wall.distance(line.midpoint()) < 0.01)
            .map(|line| line.length())
            .sum();
        assert!((found - wall.length()).abs() < 0.1 + 0.05 * wall.length(), "{found} m of {wall:?}");
    }
}

#[test]
fn bent_odometry_and_noise_are_corrected() {
    let (log, mapped) = mapped(&log_text(0.01, 0.06, Pose::IDENTITY));
    let (way_m, turn_rad) = worst(&at_scans(&log, &mapped));
    assert!(way_m < 0.05 && turn_rad < 0.02, "off by {way_m} m and {turn_rad} rad");
    assert_eq!(mapped.poses.len(), log.readings.len());
    assert!(worst_line_m(&mapped) < 0.08);
    // Three rooms on a corridor, each behind a doorway of 1 m.
    let found = surroundings(&log, &mapped).found;
    assert_eq!((found.rooms.len(), found.doorways.len()), (4, 3));
    assert!(found.doorways.iter().all(|doorway| (doorway.width_m - 1.0).abs() < 0.25));
}

#[test]
fn the_frame_of_the_odometry_does_not_matter() {
    let (_, here) = mapped(&log_text(0.01, 0.03, Pose::IDENTITY));
    let (_, there) = mapped(&log_text(0.01, 0.03, Pose::new(-300.0, 80.0, 2.0)));
    assert_eq!(here.map.len(), there.map.len());
    for (a, b) in here.poses.iter().zip(&there.poses) {
        assert!(a.position().distance(b.position()) < 1e-4 && (a.heading_rad - b.heading_rad).abs() < 1e-4);
    }
}

#[test]
fn without_odometry_scans_are_matched_from_one_another() {
    let text = log_text(0.005, 0.0, Pose::IDENTITY);
    let still: String = text
        .lines()
        .filter(|line| !line.starts_with("ODOM"))
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            if words[0] != "FLASER" {
                return format!("{line}\n");
            }
            let mut words = words;
            let end = words.len();
            for word in &mut words[end - 6..end - 3] {
                *word = "0";
            }
            format!("{}\n", words.join(" "))
        })
        .collect();
    let (log, mapped) = mapped(&still);
    assert!(!log.has_odometry);
    let (way_m, _) = worst(&at_scans(&log, &mapped));
    assert!(way_m < 0.3, "off by {way_m} m");
}

#[test]
fn a_log_gives_the_same_files_every_time_packed_or_not() {
    let folder = tempfile::tempdir().unwrap();
    let text = log_text(0.01, 0.03, Pose::IDENTITY);
    let plain = folder.path().join("house.log");
    enfilade::store::save_bytes(&plain, text.as_bytes()).unwrap();
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(text.as_bytes()).unwrap();
    let packed_bytes = packer.finish().unwrap();
    let packed = folder.path().join("house.log.gz");
    enfilade::store::save_bytes(&packed, &packed_bytes).unwrap();
    let one = run(&plain, &folder.path().join("one"));
    let two = run(&packed, &folder.path().join("two"));
    assert_eq!(one, two);
    assert!(one.keys().any(|name| name == "house.map.png") && one.keys().any(|name| name == "house.lines.json"));
    assert!(
        enfilade::formats::plan_json::from_bytes(&one["house.plan.json"]).is_ok()
            && one.contains_key("house.rooms.png")
    );
    let csv = String::from_utf8(one["poses.csv"].clone()).unwrap();
    assert!(csv.starts_with("t,x,y,theta\n10,0,0,0\n10.5,"), "{csv:.60}");
    // Every reading has its pose: a scan a stop and an odometry reading between each two.
    assert_eq!(csv.lines().count(), 2 * drive().len());

    // Half a packed file gives half a map, and says so.
    enfilade::store::save_bytes(&packed, &packed_bytes[..packed_bytes.len() / 2]).unwrap();
    let half = load_log(&packed).unwrap();
    assert_eq!(half.broken_off.as_deref(), Some("the packed file is cut off"));
    assert!(half.log.readings.len() > drive().len() / 4);
}

/// The files that `enfilade map` writes, by name.
fn run(log: &Path, output: &Path) -> BTreeMap<String, Vec<u8>> {
    let arguments = ["enfilade".as_ref(), "map".as_ref(), log.as_os_str(), "-o".as_ref(), output.as_os_str()];
    let mut terminal = enfilade::cli::Terminal::new(std::io::sink(), std::io::sink());
    assert_eq!(enfilade::cli::run(arguments.map(Into::into), &mut terminal), 0);
    let entries = std::fs::read_dir(output).unwrap().map(|entry| entry.unwrap().path());
    entries
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect()
}

// --- broken logs -------------------------------------------------------------------------------------

/// Two scans, an odometry line and one of every kind of message, to be broken.
fn seed_text() -> String {
    let text = log_text(0.01, 0.03, Pose::IDENTITY);
    let mut seed: String = text.lines().take(7).flat_map(|line| [line, "\n"]).collect();
    seed += "RLASER 5 1 2 3 2 1 0 0 0 0.1 0 0 13 host 0\n\
             ROBOTLASER1 0 -1.57 3.14 0.0174 81.9 0.01 0 5 1 2 3 2 1 2 7 8 0 0 0 0.1 0 0 0 0 0 0 0 14 host 0\n\
             RAWLASER2 0 -1.57 3.14 0.0174 81.9 0.01 0 4 1 2 2 1 0 15 host 0\nSYNC x 1\nNEFF 13.8\n";
    seed
}

/// Whatever becomes of a log, the reader and the mapper end, with poses that are numbers.
#[test]
fn mutated_logs_never_panic() {
    let seed = seed_text().into_bytes();
    let words: [&[u8]; 10] = [
        b"nan",
        b"inf",
        b"-inf",
        b"1e308",
        b"-1e-320",
        b"99999999999999999999",
        b"4294967295",
        b"\n",
        b" ",
        b"\xff\xfe",
    ];
    for round in 0..1500 {
        let mut random = Random::new(round);
        let mut bytes = seed.clone();
        for _ in 0..=random.below(6) {
            let at = random.below(bytes.len() + 1);
            match random.below(5) {
                0 => bytes.truncate(at),
                1 if at < bytes.len() => bytes[at] = random.bits() as u8,
                2 => {
                    let to = (at + random.below(60)).min(bytes.len());
                    bytes.drain(at..to);
                }
                3 => {
                    let to = (at + random.below(2000)).min(bytes.len());
                    let piece = bytes[at..to].to_vec();
                    let into = random.below(bytes.len() + 1);
                    bytes.splice(into..into, piece);
                }
                _ => {
                    // A whole word, so that numbers go wrong and not only their spelling.
                    let start = bytes[..at].iter().rposition(|byte| *byte == b' ').map_or(0, |space| space + 1);
                    let end = bytes[at..].iter().position(|byte| *byte == b' ').map_or(bytes.len(), |space| at + space);
                    bytes.splice(start..end, words[random.below(words.len())].iter().copied());
                }
            }
        }
        if let Ok(loaded) = read_log(bytes.as_slice()) {
            let mapped = map_log(&loaded.log, &MapperOptions::default(), &Work::quiet()).unwrap();
            assert_eq!(mapped.poses.len(), loaded.log.readings.len(), "round {round}");
            assert!(mapped.poses.iter().all(|pose| pose.is_finite()), "round {round}");
        }
    }
}

/// What promises much and holds little takes little memory: the reader never believes a number.
#[test]
fn huge_counts_and_endless_lines_take_no_memory() {
    for line in ["FLASER 18446744073709551615 1 2 3\n", "FLASER 10000 1\n", "ROBOTLASER1 0 0 3 1 80 0 0 9999999999 1\n"]
    {
        assert_eq!(read_log(line.repeat(1000).as_bytes()).unwrap_err(), LogError::NoScans);
    }
    // 50 MB without an end of line, after a scan.
    let text = format!("FLASER 3 1 1 1 0 0 0 0 0 0 5 h 5\nFLASER {}", "1 ".repeat(100));
    let endless = std::io::repeat(b'1').take(50_000_000);
    let loaded = read_log(std::io::BufReader::new(text.as_bytes().chain(endless))).unwrap();
    assert_eq!(loaded.log.readings.len(), 1);
    assert_eq!(loaded.log.notes[0].to_string(), "line 2: is longer than any message; left out");
    // A packed file of zeros.
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&vec![0; 20_000_000]).unwrap();
    assert_eq!(read_log(packer.finish().unwrap().as_slice()).unwrap_err(), LogError::NotALog);
}

// --- real logs ---------------------------------------------------------------------------------------

fn data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/robot/logs").join(name);
    if !path.exists() {
        println!("skipped: ../shared/data/robot/logs/{name} is not there");
        return None;
    }
    Some(path)
}

/// Mean translational error over the relations of Kuemmerle et al. (2009), in metres; poses between
/// readings are interpolated in a straight line, as by the benchmark's script.
fn error_m(log: &Log, poses: &[Pose], relations: &Path) -> f64 {
    let times: Vec<f64> = log.readings.iter().map(|reading| reading.time_s).collect();
    let at = |time: f64| -> Option<Pose> {
        let after = times.partition_point(|other| *other < time);
        let near =
            [after, after.wrapping_sub(1)].into_iter().find(|i| times.get(*i).is_some_and(|t| (t - time).abs() < 1e-3));
        if let Some(near) = near {
            return Some(poses[near]);
        }
        if after == 0 || after == times.len() || times[after] - times[after - 1] > 10.0 {
            return None;
        }
        let share = (time - times[after - 1]) / (times[after] - times[after - 1]);
        let (a, b) = (poses[after - 1], poses[after]);
        let place = a.position().lerp(b.position(), share);
        Some(Pose::new(place.x, place.y, a.heading_rad + share * a.between(b).heading_rad))
    };
    let text = std::fs::read_to_string(relations).unwrap();
    let errors: Vec<f64> = text
        .lines()
        .filter_map(|line| {
            let fields: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
            let truth = Pose::new(fields[2], fields[3], fields[7]);
            let off = truth.between(at(fields[0])?.between(at(fields[1])?));
            Some(off.x_m.hypot(off.y_m))
        })
        .collect();
    assert!(errors.len() > 1000);
    errors.iter().sum::<f64>() / errors.len() as f64
}

/// Published for scan matching without closing loops: 0.220 m (Kuemmerle et al. 2009). With closures
/// what is left is the straight line between scans 3 s apart: the corrected poses of the archive get
/// 0.126 m.
#[test]
fn the_intel_lab_is_mapped_better_than_by_sequential_matching() {
    let (Some(path), Some(relations)) = (data("intel.truepair.log.gz"), data("intel.relations")) else { return };
    let log = load_log(&path).unwrap().log;
    let map = |closes_loops| {
        let options = MapperOptions { closes_loops, ..MapperOptions::default() };
        map_log(&log, &options, &Work::quiet()).unwrap()
    };
    let drifting = error_m(&log, &map(false).poses, &relations);
    assert!(drifting < 0.220, "{drifting} m");
    let mapped = map(true);
    let closed = error_m(&log, &mapped.poses, &relations);
    assert!(closed < 0.130, "{closed} m");
    // Its offices are rooms of their own, beside corridors, a large laboratory and smaller rooms.
    let found = surroundings(&log, &mapped).found;
    let areas: Vec<f64> = found.rooms.iter().map(|room| areas::area_m2(&room.shapes())).collect();
    let offices = areas.iter().filter(|area_m2| (8.0..30.0).contains(*area_m2)).count();
    let largest_m2 = areas.iter().copied().fold(0.0, f64::max);
    assert!(offices >= 14 && largest_m2 < 110.0, "{offices} offices, the largest room {largest_m2} m²");
}
