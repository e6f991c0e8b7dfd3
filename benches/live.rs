//! From an edit to the labels of all rooms, in schools of 500 and 5,000 rooms: `cargo bench --bench live [EDITS]`.
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
use enfilade::plan::{CornerId, LabelOrigin, OpeningId, Plan, RoomId, RoomLabel};

/// What a person does to a plan.
const KINDS: [&str; 6] = ["slide a door", "widen a door", "move a corner", "remove a door", "label a room", "undo"];

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
        3 => edit::remove(plan, &[enfilade::plan::ElementId::Opening(door)]).ok(),
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

fn main() {
    let edits = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(120);
    let only: Option<usize> = std::env::args().skip(2).find_map(|word| word.parse().ok());
    let (schemes, models, by) = (Schemes::bundled(), Models::bundled(), LabelledBy::default());
    for rooms in [500, 5000].into_iter().filter(|rooms| only.is_none_or(|only| only == *rooms)) {
        let mut plan = large_school::large_school(rooms);
        println!("{} rooms, {} openings, {} walls", plan.rooms().len(), plan.openings().len(), plan.walls().len());
        let mut random = Random::new(7);
        let mut times: Vec<Vec<f64>> = vec![Vec::new(); KINDS.len()];
        let (mut scratch, mut all) = (Vec::new(), Vec::new());
        let mut before = plan.clone();
        let by = Some((&by, &models));
        let mut labelled = Labelled::new(&plan, &schemes, by, None);
        for turn in 0..edits {
            let kind = turn % KINDS.len();
            let after = if kind == 5 { Some(before.clone()) } else { edited(&plan, kind, &mut random) };
            let Some(after) = after else { continue };
            before = std::mem::replace(&mut plan, after);
            let start = Instant::now();
            labelled = Labelled::new(&plan, &schemes, by, Some(&labelled));
            let took_ms = start.elapsed().as_secs_f64() * 1e3;
            times[kind].push(took_ms);
            all.push(took_ms);
            if turn % 10 == 0 {
                // The same as if nothing had been known before.
                let start = Instant::now();
                let anew = Labelled::new(&plan, &schemes, by, None);
                scratch.push(start.elapsed().as_secs_f64() * 1e3);
                let said =
                    |labelled: &Labelled| labelled.predictions.as_ref().map(|it| it.result.distributions.clone());
                assert_eq!(said(&labelled), said(&anew), "after '{}'", KINDS[kind]);
            }
        }
        for (kind, times) in KINDS.iter().zip(&mut times) {
            println!("  {kind:16} median {:8.2} ms, 99th {:8.2} ms", percentile(times, 0.5), percentile(times, 0.99));
        }
        println!(
            "  edit to labels   median {:8.2} ms, 99th {:8.2} ms",
            percentile(&mut all, 0.5),
            percentile(&mut all, 0.99)
        );
        let start = Instant::now();
        let derived = Derived::from_labelled(std::sync::Arc::new(labelled));
        println!("  the rest of what the window derives {:.2} ms", start.elapsed().as_secs_f64() * 1e3);
        drop(derived);
    }
}
