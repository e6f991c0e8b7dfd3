//! Outlines of sets of cells, and their simplification.

use crate::geometry::Point;

/// The four directions along cell edges, y down: right, down, left, up.
const STEPS: [(i32, i32); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// The closed outlines of a set of cells, along cell edges, in cells with y down. The set is on the left
/// as seen in the picture, so that outer outlines run counter-clockwise there and holes clockwise. Cells
/// that touch only at a corner are not joined; their surroundings are.
///
/// `window` is the range of columns and rows to look at, half-open; the set must not extend beyond it.
pub fn outlines(window: [usize; 4], inside: impl Fn(i32, i32) -> bool) -> Vec<Vec<(i32, i32)>> {
    let [left, top, right, bottom] = window.map(|side| side as i32);
    let columns = (right - left + 1) as usize;
    let index = |x: i32, y: i32| (y - top) as usize * columns + (x - left) as usize;
    // A bit for each edge leaving a lattice point that is done.
    let mut done = vec![0u8; columns * (bottom - top + 1) as usize];
    // Whether an edge leaves the point (x, y) in a direction with the set only on its left.
    let leaves = |x: i32, y: i32, step: usize| {
        let (left, right) = match step {
            0 => ((x, y - 1), (x, y)),
            1 => ((x, y), (x - 1, y)),
            2 => ((x - 1, y), (x - 1, y - 1)),
            _ => ((x - 1, y - 1), (x, y - 1)),
        };
        inside(left.0, left.1) && !inside(right.0, right.1)
    };
    let mut found = Vec::new();
    for start_y in top..=bottom {
        for start_x in left..right {
            // Every closed outline has a rightward edge.
            if done[index(start_x, start_y)] & 1 != 0 || !leaves(start_x, start_y, 0) {
                continue;
            }
            let (mut x, mut y, mut step) = (start_x, start_y, 0);
            let mut outline = Vec::new();
            loop {
                done[index(x, y)] |= 1 << step;
                outline.push((x, y));
                x += STEPS[step].0;
                y += STEPS[step].1;
                // Left turns first, so that cells touching at a corner stay apart.
                let next = [3, 0, 1].map(|turn| (step + turn) % 4).into_iter().find(|&turn| leaves(x, y, turn));
                let Some(next) = next else { break };
                step = next;
                if (x, y, step) == (start_x, start_y, 0) {
                    break;
                }
            }
            found.push(outline);
        }
    }
    found
}

/// Simplifies an outline by the Douglas-Peucker algorithm: no dropped point is further than the tolerance
/// from the result. The two points (nearly) furthest from each other are kept.
pub fn simplified(outline: &[(i32, i32)], tolerance: f64) -> Vec<Point> {
    let at = |index: usize| Point::new(f64::from(outline[index].0), f64::from(outline[index].1));
    let count = outline.len();
    if count < 3 {
        return (0..count).map(at).collect();
    }
    let farthest_from = |index: usize| {
        // The first, if tied.
        (0..count).fold((0, -1.0), |best, other| {
            let distance = at(index).distance(at(other));
            if distance > best.1 { (other, distance) } else { best }
        })
    };
    let one = farthest_from(0).0;
    let other = farthest_from(one).0;
    let mut keep = vec![false; count];
    let mut kept = vec![one, other];
    if count > LONGEST_WHOLE {
        kept.extend((0..count).step_by(PIECE));
    }
    kept.sort_unstable();
    kept.dedup();
    for &index in &kept {
        keep[index] = true;
    }
    let mut open: Vec<(usize, usize)> =
        (0..kept.len()).map(|index| (kept[index], kept[(index + 1) % kept.len()])).collect();
    while let Some((from, to)) = open.pop() {
        let between = (to + count - from) % count;
        let (start, end) = (at(from), at(to));
        let mut worst = (0, -1.0);
        for offset in 1..between {
            let index = (from + offset) % count;
            let distance = distance_to_segment(at(index), start, end);
            if distance > worst.1 {
                worst = (index, distance);
            }
        }
        if worst.1 > tolerance {
            keep[worst.0] = true;
            open.extend([(from, worst.0), (worst.0, to)]);
        }
    }
    (0..count).filter(|&index| keep[index]).map(at).collect()
}

/// The algorithm takes quadratic time at worst (a spiral): longer outlines are cut into pieces of this
/// many points, each of which keeps an extra corner.
const LONGEST_WHOLE: usize = 1 << 16;
const PIECE: usize = 1 << 10;

fn distance_to_segment(point: Point, start: Point, end: Point) -> f64 {
    let way = end - start;
    let length_squared = way.dot(way);
    let t = if length_squared > 0.0 { ((point - start).dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(start + way * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ring_of_cells_has_two_outlines() {
        let inside = |x: i32, y: i32| (1..6).contains(&x) && (1..6).contains(&y) && (x, y) != (3, 3);
        let found = outlines([0, 0, 8, 8], inside);
        let lengths: Vec<usize> = found.iter().map(Vec::len).collect();
        assert_eq!(lengths, [4, 20]);
        assert_eq!(simplified(&found[1], 0.5).len(), 4);
    }

    #[test]
    fn cells_that_touch_at_a_corner_have_outlines_of_their_own() {
        let found = outlines([0, 0, 3, 3], |x, y| (x, y) == (0, 0) || (x, y) == (1, 1));
        assert_eq!(found.len(), 2);
    }
}
