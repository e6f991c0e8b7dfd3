//! Frontiers: where the known floor ends without an obstacle.

use super::RayGrid;
use super::free_space::{EdgeKind, FreeSpace};
use crate::geometry::{Point, Segment, Vector};

/// The boundary is examined in pieces of this length in metres.
const PIECE_M: f64 = 0.1;

/// Shorter frontiers are shadows between beams, in metres: no robot fits through them.
const SHORTEST_M: f64 = 0.35;

/// How far behind a frontier must be unknown, in metres; otherwise it is a slit.
const SLIT_M: f64 = 0.15;

/// A stretch of the boundary between the known and the unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Frontier {
    /// Its points in order; the known floor is to the left.
    pub line: Vec<Point>,
    /// The point on it halfway along.
    pub middle: Point,
    pub length_m: f64,
    /// Unit vector into the unknown, on average.
    pub outward: Vector,
}

/// The frontiers of a free space, in the order of its rings.
pub fn frontiers(free: &FreeSpace) -> Vec<Frontier> {
    let rings = free.edges(PIECE_M);
    let grid = RayGrid::new(rings.iter().flatten().map(|(segment, _)| *segment).collect());
    let is_frontier = |(segment, kind): &(Segment, EdgeKind)| {
        *kind == EdgeKind::Frontier && {
            let Some(outward) = segment.vector().left().unit().map(|left| -left) else { return false };
            let from = segment.midpoint() + outward * 0.005;
            !grid.blocks(from, from + outward * SLIT_M) && !free.is_hit_near(from + outward * SLIT_M)
        }
    };
    let mut found = Vec::new();
    for ring in &rings {
        let marks: Vec<bool> = ring.iter().map(is_frontier).collect();
        let n = ring.len();
        // Start after a piece that is not a frontier, so that the start of the ring splits none.
        let start = marks.iter().position(|mark| !mark).map_or(0, |at| at + 1);
        let mut line: Vec<Point> = Vec::new();
        for i in 0..n {
            let at = (start + i) % n;
            if marks[at] {
                if line.is_empty() {
                    line.push(ring[at].0.a);
                }
                line.push(ring[at].0.b);
            }
            if !line.is_empty() && (!marks[at] || i + 1 == n) {
                found.extend(frontier(std::mem::take(&mut line)));
            }
        }
    }
    found
}

fn frontier(line: Vec<Point>) -> Option<Frontier> {
    let length_m: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if length_m < SHORTEST_M {
        return None;
    }
    let mut left_m = length_m / 2.0;
    let mut middle = line[0];
    let mut outward = Vector::new(0.0, 0.0);
    for pair in line.windows(2) {
        let step = pair[1] - pair[0];
        let step_m = step.length();
        if left_m >= 0.0 && step_m > 0.0 {
            middle = pair[0].lerp(pair[1], (left_m / step_m).min(1.0));
        }
        left_m -= step_m;
        outward = outward - step.left();
    }
    let line = super::free_space::simplified(&line, 0.02);
    Some(Frontier { line, middle, length_m, outward: outward.unit().unwrap_or(Vector::new(1.0, 0.0)) })
}
