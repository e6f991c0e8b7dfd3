//! Shared by the tests of edits.

use std::fmt::Debug;

use enfilade::geometry::{Point, polygon};
use enfilade::plan::{History, Plan, Room};
use proptest::prelude::{ProptestConfig, TestCaseError, prop_assert, prop_assert_eq};
use proptest::test_runner::RngSeed;

pub fn points(coordinates: &[(f64, f64)]) -> Vec<Point> {
    coordinates.iter().map(|&(x, y)| Point::new(x, y)).collect()
}

/// A rectangle by two opposite corners.
pub fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<Point> {
    points(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
}

pub fn area_m2(plan: &Plan, room: &Room) -> f64 {
    let holes: Vec<Vec<Point>> = room.holes.iter().map(|hole| plan.ring_points(hole)).collect();
    polygon::area(&plan.ring_points(&room.outer), &holes)
}

/// The areas of all rooms, ascending, rounded to a square centimetre.
pub fn areas(plan: &Plan) -> Vec<f64> {
    let mut areas: Vec<f64> = plan.rooms().map(|(_, room)| (area_m2(plan, room) * 1e4).round() / 1e4).collect();
    areas.sort_by(f64::total_cmp);
    areas
}

/// So many cases, or as many as `PROPTEST_CASES` says. The same cases each time, unless `PROPTEST_RNG_SEED` gives another
/// seed; with `PROPTEST_CASES` alone, new ones each time.
pub fn config(cases: u32) -> ProptestConfig {
    // Both variables are read by proptest itself.
    let default = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    let is_set = |name: &str| std::env::var_os(name).is_some();
    let rng_seed = match default.rng_seed {
        RngSeed::Random if !is_set("PROPTEST_CASES") => RngSeed::Fixed(12),
        seed => seed,
    };
    let cases = if is_set("PROPTEST_CASES") { default.cases } else { cases };
    ProptestConfig { cases, rng_seed, ..default }
}

/// The area of all rooms together.
pub fn total_area(plan: &Plan) -> f64 {
    plan.rooms().map(|(_, room)| area_m2(plan, room)).sum()
}

/// Where a step goes in the history of a plan.
pub enum Way {
    Back,
    Forth,
    On,
}

/// Takes steps from an empty plan on: after each the plan is as expected and has no violation, and undoing
/// all gives the empty plan. `applied` gives the plan after a step, `None` where it was refused.
pub fn invariants_hold_and_undo_is_exact_for<S: Debug>(
    steps: &[S],
    way: impl Fn(&S) -> Way,
    applied: impl Fn(&Plan, &S) -> Option<Plan>,
) -> Result<(), TestCaseError> {
    let mut history = History::new("New plan", Plan::default());
    let mut expected = vec![Plan::default()];
    let mut at = 0_usize;
    for step in steps {
        match way(step) {
            Way::Back => {
                prop_assert_eq!(history.undo().is_some(), at > 0);
                at = at.saturating_sub(1);
            }
            Way::Forth => {
                let possible = at + 1 < expected.len();
                prop_assert_eq!(history.redo().is_some(), possible);
                at += usize::from(possible);
            }
            Way::On => {
                if let Some(plan) = applied(history.plan(), step) {
                    if plan != *history.plan() {
                        expected.truncate(at + 1);
                        expected.push(plan.clone());
                        at += 1;
                    }
                    history.push(format!("{step:?}"), plan);
                }
            }
        }
        prop_assert_eq!(history.plan(), &expected[at]);
        let violations = history.plan().violations();
        prop_assert!(violations.is_empty(), "{:?} after {:?}", violations, step);
    }
    while history.undo().is_some() {}
    prop_assert_eq!(history.plan(), &Plan::default());
    Ok(())
}
