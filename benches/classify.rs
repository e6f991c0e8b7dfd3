//! The paper's sixteen classifiers, ours against Weka's on the same rows and the same folds:
//!
//!     cargo bench --bench classify                 # scores, calibration, times: docs/classifiers.md
//!     cargo bench --bench classify -- --ours       # without Weka
//!     cargo bench --bench classify -- --seeds 1    # one cross-validation a cell instead of three
//!     cargo bench --bench classify -- --threads 1  # times on one thread only
//!     cargo bench --bench classify -- --record     # the rows of tests/classify/weka.csv, no more
//!
//! Needs the real plans in ../shared/data and, for Weka, a JDK and Debian's package `weka`
//! (/usr/share/java/weka.jar); says so if they are missing.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::panic,
    reason = "a benchmark reads the clock, writes scratch files, prints to a terminal, and may stop when it fails"
)]

#[path = "../tests/classify/generated.rs"]
mod generated;
#[path = "../tests/classify/real_rows.rs"]
mod real_rows;

use std::fmt::Write as _;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::Instant;

use enfilade::base::work::Work;
use enfilade::classify::{Algorithm, Classifier, Distribution, Scores, Validation, evaluate_all};
use enfilade::dataset::folds::{Folds, Grouping};
use enfilade::dataset::table::Table;
use enfilade::dataset::{Row, csv};
use generated::generated_rows;
use real_rows::{SETS, real_rows};

/// Cross-validations of each set in tests/classify/weka.csv: more where fewer rooms make chance larger.
const SEEDS_RECORDED: [usize; 4] = [1, 2, 3, 1];

/// The head of tests/classify/weka.csv.
const RECORD_HEAD: &str = "\
# Weka 3.6.14 in 10-fold cross-validation: JRip, J48, IBk -K 5, MultilayerPerceptron, defaults else. The folds are those
# of Folds::new(rows, Grouping::Room, 10, seed); the rows those of tests/classify/real_rows.rs and generated_rows(900, 1).
# Made with
#     cargo bench --bench classify -- --record > tests/classify/weka.csv
set,algorithm,seed,right,rooms,log_loss,brier";

const WEKA: &str = "/usr/share/java/weka.jar";

/// Folds of each cross-validation, as in the paper.
const FOLDS: usize = 10;

/// Speed is measured over as many runs of ours; the fastest counts, as of Weka's. Other work on the
/// machine only ever makes a run slower.
const RUNS: usize = 5;

struct Set {
    name: &'static str,
    rows: Vec<Row>,
    table: Table,
    /// For each seed from 1.
    by_room: Vec<Folds>,
    by_building: Vec<Folds>,
}

impl Set {
    fn new(name: &'static str, rows: Vec<Row>, seeds: usize) -> Self {
        let deal =
            |grouping| (1..=seeds as u64).map(|seed| Folds::new(&rows, grouping, FOLDS, seed).unwrap()).collect();
        let (by_room, by_building) = (deal(Grouping::Room), deal(Grouping::Building));
        Self { name, table: Table::from_rows(&rows).unwrap(), rows, by_room, by_building }
    }
}

/// Mean figures over the seeds.
#[derive(Clone, Copy, Default)]
struct Cell {
    accuracy: f64,
    log_loss: f64,
    brier: f64,
    calibration_error: f64,
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |name: &str, otherwise: usize| {
        let at = arguments.iter().position(|argument| argument == name);
        at.map_or(otherwise, |at| arguments[at + 1].parse().unwrap())
    };
    let seeds = number("--seeds", 3);
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get);
    let threads: Vec<usize> = if number("--threads", cores) == 1 { vec![1] } else { vec![1, cores] };
    let record = arguments.iter().any(|argument| argument == "--record");
    let mut sets = Vec::new();
    for (name, folders) in SETS {
        let Some(rows) = real_rows(folders) else {
            println!("the real plans are not in ../shared/data: nothing to measure");
            return;
        };
        sets.push(Set::new(name, rows, if record { SEEDS_RECORDED[sets.len()] } else { seeds }));
    }
    let weka = if arguments.iter().any(|argument| argument == "--ours") { None } else { Weka::find() };
    if record {
        sets.push(Set::new("generated", generated_rows(900, 1), 3));
        let Some(weka) = weka else { return };
        println!("{RECORD_HEAD}");
        weka.run(&sets, 3, cores).cells.iter().for_each(|cell| println!("{}", cell.record));
        return;
    }

    let ours = validated(&sets, |set| &set.by_room);
    let by_building = validated(&sets, |set| &set.by_building);
    let theirs = weka.as_ref().map(|weka| weka.scores(&sets, cores));

    println!("\nRooms with the right label in %, {FOLDS} folds by room, seeds 1 to {seeds}; neighbours' labels true");
    print_table(&sets, |algorithm, set| {
        let ours = ours[algorithm][set].accuracy * 100.0;
        match &theirs {
            Some(theirs) => {
                let theirs = theirs[algorithm][set].accuracy * 100.0;
                format!("{ours:.1} / {theirs:.1} ({:+.1})", ours - theirs)
            }
            None => format!("{ours:.1}"),
        }
    });
    println!("\nThe same with folds that never split a building, ours");
    print_table(&sets, |algorithm, set| format!("{:.1}", by_building[algorithm][set].accuracy * 100.0));
    for (title, cells) in [("by room", &ours), ("by building", &by_building)] {
        println!("\nLog loss, Brier score, calibration error, folds {title}; ours");
        print_table(&sets, |algorithm, set| {
            let Cell { log_loss, brier, calibration_error, .. } = cells[algorithm][set];
            format!("{log_loss:.3} {brier:.3} {calibration_error:.3}")
        });
    }
    println!("of the labels' shares alone, by room");
    print_row("", &sets, |set| {
        let prior = Distribution::from_weights(set.table.label_counts().map(|count| count as f64));
        let rows = set.table.labels().iter().map(|&label| (0, &prior, label));
        let scores = Scores::of(rows);
        format!("{:.3} {:.3} {:.3}", scores.log_loss, scores.brier, scores.calibration_error)
    });
    if let Some(theirs) = &theirs {
        println!("\nLog loss, Brier score, folds by room; Weka");
        print_table(&sets, |algorithm, set| {
            let Cell { log_loss, brier, .. } = theirs[algorithm][set];
            format!("{log_loss:.3} {brier:.3}")
        });
    }

    speed(&sets, weka.as_ref(), &threads);
    prediction(&sets);
}

/// The mean figures of each algorithm and set.
fn validated(sets: &[Set], folds: impl Fn(&Set) -> &Vec<Folds>) -> Vec<Vec<Cell>> {
    let cell = |algorithm: Algorithm, set: &Set| {
        let validations: Vec<Validation<'_>> = folds(set)
            .iter()
            .zip(1..)
            .map(|(folds, seed)| Validation { table: &set.table, folds, algorithm, seed })
            .collect();
        let validated = evaluate_all(&validations, &Work::quiet()).unwrap();
        let mean = |of: fn(&Scores) -> f64| {
            validated.iter().map(|validated| of(&validated.scores)).sum::<f64>() / validated.len() as f64
        };
        Cell {
            accuracy: mean(|scores| scores.accuracy),
            log_loss: mean(|scores| scores.log_loss),
            brier: mean(|scores| scores.brier),
            calibration_error: mean(|scores| scores.calibration_error),
        }
    };
    Algorithm::ALL.iter().map(|&algorithm| sets.iter().map(|set| cell(algorithm, set)).collect()).collect()
}

fn print_row(title: &str, sets: &[Set], cell: impl Fn(&Set) -> String) {
    let cells: Vec<String> = sets.iter().map(|set| format!("{:>22}", cell(set))).collect();
    println!("{title:<24}{}", cells.join(""));
}

fn print_table(sets: &[Set], cell: impl Fn(usize, usize) -> String) {
    print_row("", sets, |set| format!("{} ({})", set.name, set.table.len()));
    for (index, algorithm) in Algorithm::ALL.iter().enumerate() {
        let cells: Vec<String> = (0..sets.len()).map(|set| format!("{:>22}", cell(index, set))).collect();
        println!("{:<24}{}", algorithm.title(), cells.join(""));
    }
}

/// Training and cross-validation of all sixteen.
fn speed(sets: &[Set], weka: Option<&Weka>, threads: &[usize]) {
    println!(
        "\nTraining and {FOLDS}-fold validation of all sixteen, seconds on the wall, ours the fastest of {RUNS} runs"
    );
    for &threads in threads {
        let ours = least(wall_s, RUNS, || {
            let validations: Vec<Validation<'_>> = Algorithm::ALL
                .iter()
                .flat_map(|&algorithm| {
                    let validation = move |set| validation(set, algorithm);
                    sets.iter().map(validation)
                })
                .collect();
            black_box(evaluate_all(&validations, &Work::quiet().on_threads(threads)).unwrap());
        });
        print!("{threads} threads: ours {ours:.3}");
        if let Some(weka) = weka {
            let theirs = weka.run(sets, 1, threads).wall_s;
            print!(", Weka {theirs:.2}, {:.0} times as long", theirs / ours);
        }
        println!();
    }
    println!("\nOf these by algorithm, ours, milliseconds of processor time, the least of {RUNS} runs");
    let milliseconds = |algorithm: usize, set: usize| {
        let validation = validation(&sets[set], Algorithm::ALL[algorithm]);
        1e3 * least(thread_s, RUNS, || {
            black_box(evaluate_all(&[validation], &Work::quiet().on_threads(1)).unwrap());
        })
    };
    let ours: Vec<Vec<f64>> =
        (0..4).map(|algorithm| (0..sets.len()).map(|set| milliseconds(algorithm, set)).collect()).collect();
    print_table(sets, |algorithm, set| format!("{:.1}", ours[algorithm][set]));
    let Some(weka) = weka else { return };
    println!("Weka's");
    let run = weka.run(sets, 1, 1);
    print_table(sets, |algorithm, set| {
        let (name, set) = (Algorithm::ALL[algorithm].name(), sets[set].name);
        let cell = run.cells.iter().find(|cell| cell.set == set && cell.algorithm == name).unwrap();
        format!("{:.0}", cell.cpu_ms)
    });
    let theirs = run.cells.iter().map(|cell| cell.cpu_ms).sum::<f64>() / 1e3;
    let ours = ours.iter().flatten().sum::<f64>() / 1e3;
    println!("together: ours {ours:.2} s, Weka {theirs:.2} s, {:.0} times as long", theirs / ours);
    println!("Not counted: reading the rows, and the start of a JVM, {:.2} s with the class compiled", weka.start_s());
}

fn validation(set: &Set, algorithm: Algorithm) -> Validation<'_> {
    Validation { table: &set.table, folds: &set.by_room[0], algorithm, seed: 1 }
}

/// How long one prediction takes.
fn prediction(sets: &[Set]) {
    println!("\nOne prediction, microseconds of processor time, model of all rows of the set asked for the same rows");
    print_table(sets, |algorithm, set| {
        let table = &sets[set].table;
        let classifier = Classifier::train(Algorithm::ALL[algorithm], table, 1, &Work::quiet()).unwrap();
        let seconds = least(thread_s, RUNS, || {
            for values in table.values() {
                black_box(classifier.predict(black_box(values)));
            }
        });
        format!("{:.3}", seconds * 1e6 / table.len() as f64)
    });
}

/// The least seconds of several runs by a clock.
fn least(clock: fn() -> f64, runs: usize, work: impl Fn()) -> f64 {
    let time = |_| {
        let start = clock();
        work();
        clock() - start
    };
    (0..runs).map(time).fold(f64::INFINITY, f64::min)
}

/// Seconds on the wall.
fn wall_s() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Seconds of processor time of this thread, where the system tells it (Linux): other programs' load
/// does not count.
fn thread_s() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    text.split(' ').next().and_then(|word| word.parse::<f64>().ok()).map_or_else(wall_s, |ns| ns * 1e-9)
}

/// Weka, compiled and ready.
struct Weka {
    scratch: tempfile::TempDir,
    class_path: String,
}

struct WekaCell {
    set: String,
    algorithm: String,
    accuracy: f64,
    log_loss: f64,
    brier: f64,
    cpu_ms: f64,
    /// All but the time, as ClassifyWeka prints it.
    record: String,
}

struct WekaRun {
    cells: Vec<WekaCell>,
    wall_s: f64,
}

impl Weka {
    fn find() -> Option<Self> {
        let scratch = tempfile::tempdir().unwrap();
        let source = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/ClassifyWeka.java");
        let compiled = Path::new(WEKA).is_file()
            && Command::new("javac")
                .args(["-cp", WEKA, "-d"])
                .arg(scratch.path())
                .arg(source)
                .status()
                .is_ok_and(|status| status.success());
        if !compiled {
            println!("no Weka: it needs {WEKA} and a JDK (Debian: weka, default-jdk-headless)");
            return None;
        }
        let class_path = format!("{WEKA}:{}", scratch.path().display());
        Some(Self { scratch, class_path })
    }

    /// The rows with the labels, features and fold numbers of the first seeds.
    fn write(&self, set: &Set, seeds: usize) -> PathBuf {
        let mut text = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H".to_owned();
        let folds = &set.by_room[..seeds.min(set.by_room.len())];
        for seed in 1..=folds.len() {
            let _ = write!(text, ",fold{seed}");
        }
        for (index, row) in set.rows.iter().enumerate() {
            let _ = write!(text, "\n{},{}", row.label.letter(), csv::feature_cells(&row.features).join(","));
            for folds in folds {
                let _ = write!(text, ",{}", folds.of_rows()[index]);
            }
        }
        let path = self.scratch.path().join(format!("{}.csv", set.name));
        std::fs::write(&path, text).unwrap();
        path
    }

    fn run(&self, sets: &[Set], seeds: usize, threads: usize) -> WekaRun {
        let files: Vec<PathBuf> = sets.iter().map(|set| self.write(set, seeds)).collect();
        let mut command = Command::new("java");
        // The user's own Weka settings are not wanted; the collector's threads are counted to the one.
        command.args(["-XX:+UseSerialGC", "-cp", &self.class_path, "ClassifyWeka", &threads.to_string()]).args(&files);
        let output = command.env("HOME", self.scratch.path()).output().unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let mut run = WekaRun { cells: Vec::new(), wall_s: f64::NAN };
        for line in text.lines() {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |index: usize| -> f64 { cells[index].parse().unwrap() };
            if cells[0] == "wall_ms" {
                run.wall_s = number(1) / 1e3;
                continue;
            }
            run.cells.push(WekaCell {
                set: cells[0].to_owned(),
                algorithm: cells[1].to_owned(),
                accuracy: number(3) / number(4),
                log_loss: number(5),
                brier: number(6),
                cpu_ms: number(7),
                record: cells[..7].join(","),
            });
        }
        assert!(run.wall_s.is_finite(), "Weka: {}", String::from_utf8_lossy(&output.stderr));
        run
    }

    fn scores(&self, sets: &[Set], threads: usize) -> Vec<Vec<Cell>> {
        let run = self.run(sets, sets[0].by_room.len(), threads);
        let cell = |algorithm: Algorithm, set: &Set| {
            let cells: Vec<&WekaCell> =
                run.cells.iter().filter(|cell| cell.set == set.name && cell.algorithm == algorithm.name()).collect();
            let mean = |of: fn(&WekaCell) -> f64| cells.iter().map(|cell| of(cell)).sum::<f64>() / cells.len() as f64;
            Cell {
                accuracy: mean(|cell| cell.accuracy),
                log_loss: mean(|cell| cell.log_loss),
                brier: mean(|cell| cell.brier),
                calibration_error: f64::NAN,
            }
        };
        Algorithm::ALL.iter().map(|&algorithm| sets.iter().map(|set| cell(algorithm, set)).collect()).collect()
    }

    /// Seconds to start and end a JVM that does nothing.
    fn start_s(&self) -> f64 {
        least(wall_s, 3, || {
            let status =
                Command::new("java").args(["-XX:+UseSerialGC", "-cp", &self.class_path, "ClassifyWeka", "1"]).output();
            assert!(status.unwrap().status.success());
        })
    }
}
