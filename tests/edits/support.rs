//! What the tests of edits share.

use enfilade::geometry::{Point, polygon};
use enfilade::plan::{Plan, Room};
use proptest::prelude::ProptestConfig;

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

/// So many cases, or as many as `PROPTEST_CASES` says.
pub fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_some() { default } else { ProptestConfig { cases, ..default } }
}

/// The area of all rooms together.
pub fn total_area(plan: &Plan) -> f64 {
    plan.rooms().map(|(_, room)| area_m2(plan, room)).sum()
}
