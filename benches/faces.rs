//! Faces of segments, ours against GEOS through shapely, in the same run:
//!
//!     cargo bench --bench faces                      # the table of docs/figures.md
//!     cargo bench --bench faces -- --reference       # the rows of tests/faces/reference.csv
//!
//! Times are processor times, medians of several runs. The comparison needs python3 with shapely; without
//! it, says so and measures only ours.
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock and writes scratch files")]
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a failing benchmark may stop; it prints to a terminal")]

#[path = "../tests/faces/families.rs"]
mod families;
#[path = "../tests/faces/sums.rs"]
mod sums;

use std::process::Command;
use std::time::Instant;

use enfilade::geometry::arrangement::{Arrangement, faces};
use families::FAMILIES;

/// How often each measurement is taken; the median counts.
const RUNS: usize = 5;

/// The head of tests/faces/reference.csv.
const REFERENCE_HEAD: &str = "\
# The faces of the segments of tests/faces/families.rs by GEOS, ring by ring. Made with
#     cargo bench --bench faces -- --reference > tests/faces/reference.csv
# which gives the segments to benches/faces_geos.py; its head explains the columns. The family 'pixels' is
# snap-rounded in rational arithmetic before GEOS polygonizes it.";

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let reference = arguments.iter().any(|argument| argument == "--reference");
    let only: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with("--")).collect();
    let sizes: &[usize] = if reference { &[100, 1_000, 10_000] } else { &[1_000, 10_000, 100_000] };
    let scratch = tempfile::tempdir().unwrap();
    if !reference {
        println!(
            "{:<9} {:>8} {:>8} {:>7} | {:>9} {:>11} | {:>9} {:>6} | {:>10} {:>6} | {:>8} | same",
            "family",
            "segments",
            "faces",
            "holes",
            "ours ms",
            "ns/seg",
            "GEOS ms",
            "ratio",
            "snapped ms",
            "ratio",
            "plain"
        );
    }
    let mut header = reference;
    for family in &FAMILIES {
        if !only.is_empty() && !only.iter().any(|name| *name == family.name) {
            continue;
        }
        for &count in sizes {
            let ends = families::segments(family, count);
            let path = scratch.path().join(format!("{}-{count}", family.name));
            let bytes: Vec<u8> = ends.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
            std::fs::write(&path, bytes).unwrap();
            let segments = sums::in_metres(&ends);
            if let Err(error) = Arrangement::new(&segments) {
                println!("{:<9} {count:>8} refused: {error}", family.name);
                continue;
            }
            let work = || {
                let arrangement = Arrangement::new(&segments).unwrap();
                let found = faces(&arrangement);
                let polygons: Vec<_> = found.iter().map(|face| face.positions(&arrangement)).collect();
                assert_eq!(polygons.len(), found.len());
                (arrangement, found)
            };
            let (arrangement, found) = work();
            let ours = sums::summary(&arrangement, &found);
            drop((arrangement, found));
            let mut millis: Vec<f64> = (0..RUNS).map(|_| cpu_ms(|| drop(work()))).collect();
            let millis = median(&mut millis);
            let geos = if count <= family.geos_limit {
                let file = format!("{}:{}", family.name, path.display());
                geos(&file, if count < 100_000 { 5 } else { 3 }, family.by_rationals)
            } else if reference {
                continue;
            } else {
                None
            };
            if reference {
                let Some((versions, columns, row)) = geos else {
                    println!("python3 with shapely is needed");
                    return;
                };
                if std::mem::take(&mut header) {
                    println!("{REFERENCE_HEAD}\n{versions}\n{}", without_times(&columns, 3));
                }
                println!("{}", without_times(&row, 3));
                continue;
            }
            let fields: Vec<&str> = ours.split(',').collect();
            print!(
                "{:<9} {count:>8} {:>8} {:>7} | {millis:>9.2} {:>11.0}",
                family.name,
                fields[0],
                fields[1],
                millis * 1e6 / count as f64
            );
            match geos {
                Some((_, _, row)) => {
                    let theirs: Vec<&str> = row.split(',').collect();
                    let (plain, snapped): (f64, f64) = (theirs[7].parse().unwrap(), theirs[8].parse().unwrap());
                    let same = if theirs[2..7] == fields[..] {
                        "yes".to_owned()
                    } else {
                        format!("NO: {ours} against {}", theirs[2..7].join(","))
                    };
                    println!(
                        " | {plain:>9.2} {:>6.1} | {snapped:>10.2} {:>6.1} | {:>8} | {same}",
                        plain / millis,
                        snapped / millis,
                        theirs[9]
                    );
                }
                None if count > family.geos_limit => println!(" | too much for GEOS"),
                None => println!(" | python3 with shapely not found"),
            }
        }
    }
}

/// Processor time of one call in milliseconds, from as many calls as take a tenth of a second: the
/// kernel accounts in ticks. Other programs' load does not count. Where there is no such account
/// (not Linux), the clock on the wall.
fn cpu_ms(work: impl Fn()) -> f64 {
    let account = || -> Option<f64> {
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        Some(text.split(' ').next()?.parse::<f64>().ok()? / 1e6)
    };
    let (start, start_account) = (Instant::now(), account());
    let mut calls = 0;
    loop {
        work();
        calls += 1;
        let wall = start.elapsed().as_secs_f64() * 1e3;
        let taken = start_account.zip(account()).map_or(wall, |(from, to)| to - from);
        if taken >= 100.0 {
            return taken / f64::from(calls);
        }
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// A row without its last columns.
fn without_times(row: &str, columns: usize) -> String {
    let fields: Vec<&str> = row.split(',').collect();
    fields[..fields.len() - columns].join(",")
}

/// The versions, the columns' names and the row that GEOS gives for a file.
fn geos(file: &str, times: usize, by_rationals: bool) -> Option<(String, String, String)> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/faces_geos.py");
    let mut command = Command::new("python3");
    command.args([script, file, "--times", &times.to_string()]);
    if by_rationals {
        command.arg("--exact");
    }
    let output = command.output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let mut lines = text.lines().map(str::to_owned);
    Some((lines.next()?, lines.next()?, lines.next()?))
}
