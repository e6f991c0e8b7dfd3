//! From an edit to the labels of all rooms, in schools of 500 and 5,000 rooms: `cargo bench --bench live -- [EDITS [ROOMS [KIND]]]`,
//! the kind being the place of an edit in the table, from 0.
//!
//! The goals: under 4 ms at the 99th percentile for 500 rooms, under 16 ms for 5,000, on two cores.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark reads the clock, prints to a terminal, and may stop when it fails"
)]

#[path = "../tests/support/large_school.rs"]
mod large_school;

use std::time::Instant;

use enfilade::base::random::Random;
use enfilade::classify::models::Models;
use enfilade::edit;
use enfilade::geometry::{Point, Vector};
use enfilade::labels::{Label, Schemes};
use enfilade::pipeline::{Derived, Labelled, LabelledBy};
use enfilade::plan::{CornerId, ElementId, LabelOrigin, OpeningId, Plan, RoomId, RoomLabel};
use enfilade::predict::Predictions;

/// What a person does to a plan.
const KINDS: [&str; 7] =
    ["slide a door", "widen a door", "move a corner", "remove a door", "label a room", "undo", "remove a room"];

const UNDO: usize = 5;

/// A plan after a random edit of a kind; the same plan where it is refused.
fn edited(plan: &Plan, kind: usize, random: &mut Random) -> Option<Plan> {
    let doors: Vec<OpeningId> = plan.openings().map(|(id, _)| id).collect();
    let door = doors[random.below(doors.len())];
    match kind {
        0 => {
            let at = plan.opening_segment(plan.opening(door)?)?.midpoint();
            edit::slide_opening(plan, door, at + Vector::new(random.unit() - 0.5, random.unit() - 0.5)).ok()
        }
        1 => edit::resize_opening(plan, door, 0.7 + 0.3 * random.unit()).ok(),
        2 => {
            let corners: Vec<(CornerId, Point)> = plan.corners().map(|(id, corner)| (id, corner.position)).collect();
            let (id, at) = corners[random.below(corners.len())];
            let to = at + Vector::new(0.2 * random.unit() - 0.1, 0.2 * random.unit() - 0.1);
            edit::move_corners(plan, &[(id, to)]).ok()
        }
        3 => edit::remove(plan, &[ElementId::Opening(door)]).ok(),
        6 => {
            let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
            edit::remove(plan, &[ElementId::Room(rooms[random.below(rooms.len())])]).ok()
        }
        _ => {
            let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
            let label = Label::ALL[random.below(5)];
            let given = RoomLabel { label, origin: LabelOrigin::Person };
            edit::set_label(plan, rooms[random.below(rooms.len())], Some(given)).ok()
        }
    }
}

fn percentile(times_ms: &mut [f64], share: f64) -> f64 {
    times_ms.sort_by(f64::total_cmp);
    let place = ((times_ms.len() as f64 * share).ceil() as usize).clamp(1, times_ms.len());
    times_ms[place - 1]
}

/// An edit is followed so often, from the same labels; the fastest counts beside the first: other work on the machine only ever
/// makes a run slower.
const RUNS: usize = 3;

/// A line of the table: median and 99th percentile of the first runs, and of the fastest.
fn line(name: &str, times: &[[f64; 2]]) {
    let of = |run: usize, share: f64| {
        let mut times: Vec<f64> = times.iter().map(|times| times[run]).collect();
        if times.is_empty() { f64::NAN } else { percentile(&mut times, share) }
    };
    let [first, fastest] = [0, 1].map(|run| format!("{:8.2} {:8.2}", of(run, 0.5), of(run, 0.99)));
    println!("  {name:16} {first}   {fastest}   ({})", times.len());
}

fn main() {
    let numbers: Vec<usize> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let (edits, only, kind) =
        (numbers.first().copied().unwrap_or(120), numbers.get(1).copied(), numbers.get(2).copied());
    let (schemes, models, by) = (Schemes::bundled(), Models::bundled(), LabelledBy::default());
    for rooms in [500, 5000].into_iter().filter(|rooms| only.is_none_or(|only| only == *rooms)) {
        let mut plan = large_school::large_school(rooms);
        println!("{} rooms, {} openings, {} walls", plan.rooms().len(), plan.openings().len(), plan.walls().len());
        let mut random = Random::new(7);
        let mut times: Vec<Vec<[f64; 2]>> = vec![Vec::new(); KINDS.len()];
        let mut scratch = Vec::new();
        let mut before = plan.clone();
        let by = Some((&by, &models));
        let timed = |work: &dyn Fn() -> Labelled| {
            let start = Instant::now();
            let labelled = work();
            (labelled, start.elapsed().as_secs_f64() * 1e3)
        };
        let mut labelled = Labelled::new(&plan, &schemes, by, None);
        for turn in 0..edits {
            let kind = kind.unwrap_or_else(|| random.below(KINDS.len()));
            let after = if kind == UNDO { Some(before.clone()) } else { edited(&plan, kind, &mut random) };
            let Some(after) = after else { continue };
            before = std::mem::replace(&mut plan, after);
            let (mut first, mut fastest) = (None, f64::INFINITY);
            for _ in 0..RUNS {
                // What is dropped at the end is not waited for by anybody.
                let (next, took_ms) = timed(&|| Labelled::new(&plan, &schemes, by, Some(&labelled)));
                fastest = fastest.min(took_ms);
                first.get_or_insert((next, took_ms));
            }
            let Some((next, took_ms)) = first else { continue };
            labelled = next;
            times[kind].push([took_ms, fastest]);
            if turn % 10 == 0 {
                // The same as if nothing had been known before.
                let (anew, took_ms) = timed(&|| Labelled::new(&plan, &schemes, by, None));
                scratch.push([took_ms, took_ms]);
                let said =
                    |labelled: &Labelled| labelled.predictions.as_ref().map(|it| it.result.distributions.clone());
                assert_eq!(said(&labelled), said(&anew), "after '{}'", KINDS[kind]);
            }
        }
        println!("  {:16} {:>17}   {:>17}   edits", "ms", "first run", "fastest of three");
        println!("  {:16} {:>8} {:>8}   {:>8} {:>8}", "", "median", "99th", "median", "99th");
        for (kind, times) in KINDS.iter().zip(&times) {
            line(kind, times);
        }
        line("edit to labels", &times.concat());
        line("opened", &scratch);
        // Predicted from nothing, with nothing kept for an edit: as `enfilade classify` does.
        let predictions = labelled.predictions.as_ref().expect("the models are bundled");
        let nothing_known = vec![None; predictions.network.rooms.len()];
        let known = predictions.network.known_labels();
        let anew = Predictions::by(predictions.network.clone(), predictions.model.clone(), &known, None);
        assert_eq!(predictions.result, anew.result, "what is kept for edits is what is predicted without");
        for (name, known) in [("from nothing", &nothing_known), ("labels given", &known)] {
            let predict = || {
                let start = Instant::now();
                let network = predictions.network.clone();
                let anew = Predictions::by(network, predictions.model.clone(), known, None);
                let took_ms = start.elapsed().as_secs_f64() * 1e3;
                drop(anew);
                [took_ms; 2]
            };
            let mut times: Vec<[f64; 2]> = (0..9).map(|_| predict()).collect();
            let fastest = times.iter().map(|times| times[1]).fold(f64::INFINITY, f64::min);
            times.iter_mut().for_each(|times| times[1] = fastest);
            line(name, &times);
        }
        let start = Instant::now();
        let derived = Derived::from_labelled(std::sync::Arc::new(labelled));
        println!("  the rest of what the window derives {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
        drop(derived);
    }
}
