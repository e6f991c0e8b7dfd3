//! Split-and-merge measured as Schaefer, Büscher, Luft and Burgard (2018) measured line extractors: the share of a
//! scan's returned rays that hit an extracted line, and the error of the range at which they do.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "a measurement prints its figures, a skipped test says so")]

use std::path::Path;

use enfilade::base::random::Random;
use enfilade::geometry::{Point, Segment};
use enfilade::robot::split_and_merge::{SplitOptions, segments_of};
use enfilade::robot::{Pose, Scan, Scanner, World};
use enfilade::store::load_log;

use crate::support::is_whole;

/// What some lines say of a scan: the share of the returned rays that hit one, and the root of the mean squared
/// difference of the ranges of these, in metres. `None` without a returned ray.
fn explained(scan: &Scan, lines: &[Segment]) -> Option<(f64, f64)> {
    let range_m = |towards_rad: f64| {
        let towards = enfilade::geometry::Vector::new(towards_rad.cos(), towards_rad.sin());
        let hit = |line: &Segment| {
            let (along, way) = (line.vector(), line.a - Point::default());
            let across = towards.cross(along);
            let (range, at) = (way.cross(along) / across, way.cross(towards) / across);
            (range > 0.0 && (-1e-9..=1.0 + 1e-9).contains(&at)).then_some(range)
        };
        lines.iter().filter_map(hit).min_by(f64::total_cmp)
    };
    let returned: Vec<(f64, Option<f64>)> = (0..scan.ranges_m.len())
        .filter_map(|beam| Some((scan.range_m(beam)?, range_m(scan.angle_rad(beam)))))
        .collect();
    let hits: Vec<f64> = returned.iter().filter_map(|(measured, said)| Some((measured - (*said)?).powi(2))).collect();
    let error_m = (hits.iter().sum::<f64>() / hits.len().max(1) as f64).sqrt();
    (!returned.is_empty()).then(|| (hits.len() as f64 / returned.len() as f64, error_m))
}

/// The segments of a scan, those with the most hits first.
fn lines(scan: &Scan) -> Vec<Segment> {
    let (_, mut segments) = segments_of(scan, &SplitOptions::default());
    segments.sort_by_key(|segment| std::cmp::Reverse(segment.hits.len()));
    segments.iter().map(|segment| segment.line.segment()).collect()
}

/// The means over some scans: share and error with `vertices` vertices at most (two a segment), and with all segments;
/// and the mean number of segments.
fn means<'a>(scans: impl Iterator<Item = &'a Scan>, vertices: usize) -> [f64; 5] {
    let mut sums = [0.0; 5];
    let mut count = 0.0;
    for scan in scans {
        let lines = lines(scan);
        let few = &lines[..lines.len().min(vertices / 2)];
        let (Some(few), Some(all)) = (explained(scan, few), explained(scan, &lines)) else { continue };
        count += 1.0;
        for (sum, value) in sums.iter_mut().zip([few.0, few.1, all.0, all.1, lines.len() as f64]) {
            *sum += value;
        }
    }
    sums.map(|sum| sum / count)
}

#[test]
fn a_simulated_room_is_explained_whole() {
    let corners =
        [(0.0, 0.0), (5.0, 0.0), (5.0, 4.0), (3.0, 4.0), (3.0, 6.0), (0.0, 6.0)].map(|(x, y)| Point::new(x, y));
    let walls = (0..corners.len()).map(|at| Segment::new(corners[at], corners[(at + 1) % corners.len()]));
    let world = World::of_obstacles(walls.collect());
    let mut random = Random::new(3);
    let scanner = Scanner::lms200(Pose::IDENTITY);
    let scans: Vec<Scan> =
        (0..12).map(|turn| scanner.scan(&world, Pose::new(1.5, 2.0, f64::from(turn) * 0.5), &mut random)).collect();
    let [share, error_m, all, all_m, _] = means(scans.iter(), 20);
    assert!(share > 0.97 && error_m < 0.03, "{share} {error_m}");
    assert!(all >= share && all_m < 0.03, "{all} {all_m}");
    // A line too few is missed.
    assert!(means(scans.iter(), 2)[0] < 0.7);
}

/// Published for 20 vertices, over real scans: PLE+ 0.89 and 0.063 m, Visvalingam 0.68 and 0.174 m.
#[test]
fn real_scans_are_explained_by_few_segments() {
    let logs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/robot/logs");
    let mut all = Vec::new();
    for name in ["intel.truepair.log.gz", "csail.truepair.log.gz", "freiburg-079.paired.log.gz"] {
        let path = logs.join(name);
        if !path.exists() {
            println!("skipped: ../shared/data/robot/logs/{name} is not there");
            continue;
        }
        let log = load_log(&path).unwrap().log;
        let scans: Vec<&Scan> = log.readings.iter().flat_map(|reading| &reading.scans).collect();
        // As many as the authors drew from each log; with ENFILADE_WHOLE all.
        let step = if is_whole() { 1 } else { (scans.len() / 20).max(1) };
        let chosen: Vec<&Scan> = scans.into_iter().step_by(step).collect();
        for vertices in [10, 20, 30, 40, 50] {
            let [share, error_m, of_all, error_of_all_m, segments] = means(chosen.iter().copied(), vertices);
            println!(
                "{name}: {} scans, {vertices} vertices: {share:.3} {error_m:.3} m; all {segments:.1} segments: {of_all:.3} \
                 {error_of_all_m:.3} m",
                chosen.len()
            );
            if vertices == 20 {
                all.push((share, error_m));
            }
        }
    }
    for (share, error_m) in all {
        assert!(share > 0.58 && error_m < 0.03, "{share} {error_m}");
    }
}
