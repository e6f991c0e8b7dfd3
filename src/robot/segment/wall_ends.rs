//! Free ends of walls and what is ahead of them: doorways as gaps between a wall's end and the next wall,
//! collinear or not (section 3.3 of the paper).

use super::Raster;
use super::contours;
use crate::geometry::{Point, Vector};

/// A free end of a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
struct WallEnd {
    /// Its middle.
    at: Point,
    /// Along the wall, pointing out of its end; a unit vector.
    ahead: Vector,
    /// Distance between its corners, in cells.
    width: f64,
}

/// The thickest wall, in metres, as everywhere in plans.
const THICKEST_WALL_M: f64 = 0.6;
/// Shorter pieces are not walls: 'segments under 30 cm are dropped' (section 3.3).
const SHORTEST_WALL_M: f64 = 0.3;
/// The widest gap considered. The paper's doorways end at 1.5 m; free passages are wider, and whether a
/// gap separates two rooms is decided later by the wall beside it.
const WIDEST_GAP_M: f64 = 3.0;
/// How far a wall's face may deviate from a straight line, in cells: steps of the grid and scanner noise.
const STRAIGHTNESS_CELLS: f64 = 1.5;
/// How far the two faces of a wall may be from parallel: the outline turns by 150 to 215 degrees around
/// the wall's end (at a pointed end of a wall seen from both sides they meet).
const LEAST_TURN_RAD: f64 = 150.0 * DEGREE;
const MOST_TURN_RAD: f64 = 215.0 * DEGREE;
/// Around its end the wall turns one way, with at most this much in reverse.
const BACK_TURN_RAD: f64 = 10.0 * DEGREE;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The gaps ahead of walls' free ends: from the end to the obstacle ahead.
pub fn gaps(raster: &Raster) -> Vec<[Point; 2]> {
    let reach = raster.cells(WIDEST_GAP_M);
    let ends = wall_ends(raster);
    ends.iter()
        .filter_map(|end| {
            let half = (end.width / 2.0).max(STRAIGHTNESS_CELLS);
            let there = look_ahead(raster, *end, half, reach)?;
            // From inside the wall, so that the gap's line does not start beside its corner.
            Some([end.at + end.ahead * -1.0, there])
        })
        .collect()
}

fn wall_ends(raster: &Raster) -> Vec<WallEnd> {
    let window = [0, 0, raster.width, raster.height];
    let outlines = contours::outlines(window, |x, y| raster.is_free(x, y));
    outlines
        .iter()
        .filter(|outline| outline.len() >= 8)
        .flat_map(|outline| ends_of(&contours::simplified(outline, STRAIGHTNESS_CELLS), raster))
        .collect()
}

/// The wall ends on an outline of the free space: one, two or three corners between two faces.
fn ends_of(corners: &[Point], raster: &Raster) -> Vec<WallEnd> {
    let count = corners.len();
    if count < 3 {
        return Vec::new();
    }
    let (thickest, shortest) = (raster.cells(THICKEST_WALL_M), raster.cells(SHORTEST_WALL_M));
    let edge = |index: usize| corners[(index + 1) % count] - corners[index % count];
    let turn = |one: usize, next: usize| {
        let (one, next) = (edge(one), edge(next));
        one.cross(next).atan2(one.dot(next))
    };
    let mut ends = Vec::new();
    for first in 0..count {
        // The number of edges between the faces; the faces themselves are two more.
        for between in 0..=2.min(count.saturating_sub(3)) {
            let (last, before) = (first + between, first + count - 1);
            let width = corners[first].distance(corners[last % count]);
            let is_wide = (first..last).any(|index| edge(index).length() > thickest);
            let (into, out) = (edge(before), edge(last));
            let (into_length, out_length) = (into.length(), out.length());
            if width > thickest || is_wide || into_length < shortest || out_length < shortest {
                continue;
            }
            let turns: Vec<f64> = (0..=between).map(|step| turn(before + step, before + step + 1)).collect();
            let turned: f64 = turns.iter().sum();
            let turns_back = turns.iter().any(|&turn| turn < -BACK_TURN_RAD);
            if !(LEAST_TURN_RAD..=MOST_TURN_RAD).contains(&turned) || turns_back {
                continue;
            }
            let along = into * (1.0 / into_length) + out * (-1.0 / out_length);
            if let Some(ahead) = along.unit() {
                ends.push(WallEnd { at: corners[first].midpoint(corners[last % count]), ahead, width });
                break;
            }
        }
    }
    ends
}

/// The nearest obstacle cell within a strip ahead of a wall's end, at most `reach` away. Sideways offset
/// counts as extra distance: so the collinear wall is preferred to its neighbour.
fn look_ahead(raster: &Raster, end: WallEnd, half: f64, reach: f64) -> Option<Point> {
    /// How far the wall itself may extend into the strip, in cells.
    const OWN: f64 = 4.0;
    let rays = (2.0 * half) as i32 + 1;
    let mut best: Option<(f64, Point)> = None;
    for ray in -rays..=rays {
        let aside = half * f64::from(ray) / f64::from(rays);
        let from = end.at + end.ahead.left() * aside;
        let mut is_out = false;
        let mut ahead = 1.5;
        while ahead < reach {
            let at = from + end.ahead * ahead;
            if raster.is_free_at(at) {
                is_out = true;
            } else if is_out {
                let far = ahead + aside.abs();
                if best.is_none_or(|(nearest, _)| far < nearest) {
                    best = Some((far, at));
                }
                break;
            } else if ahead > OWN {
                break;
            }
            ahead += 0.5;
        }
    }
    best.filter(|&(far, _)| far < reach).map(|(_, at)| at)
}
