//! Where the free space is narrowest between two wider places: the saddle points of the distance to
//! obstacles, as used in Voronoi methods.

use super::Raster;
use super::distance::Distances;
use super::union::Union;
use crate::geometry::Point;

/// The two nearest obstacles of a narrow place are on opposite sides: the maximum cosine of the angle
/// between them.
const MOST_COSINE: f64 = -0.3;

/// The places narrower than a share of both sides, from the nearest obstacle on one side to that on the
/// other; which to keep is decided later.
///
/// Cells are visited from the widest place down; basins that meet are merged unless the place where they
/// meet is clearly narrower than both.
pub fn narrows(raster: &Raster, distances: &Distances, widest_share: f64) -> Vec<[Point; 2]> {
    let (width, height) = (raster.width as i32, raster.height as i32);
    let mut order: Vec<u32> = (0..raster.free.len() as u32).filter(|&cell| raster.free[cell as usize]).collect();
    order.sort_unstable_by_key(|&cell| (std::cmp::Reverse(distances.squared[cell as usize]), cell));
    let mut basin_of = vec![u32::MAX; raster.free.len()];
    let mut basins = Union::default();
    let mut peaks: Vec<f64> = Vec::new();
    let mut found = Vec::new();
    for &cell in &order {
        let (x, y) = (cell as i32 % width, cell as i32 / width);
        let distance = f64::from(distances.squared[cell as usize]).sqrt();
        // The surrounding basins, without repeats, deepest first: at most four of eight neighbours can
        // differ.
        let mut around: Vec<u32> = Vec::new();
        for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0)] {
            let (x, y) = (x + dx, y + dy);
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let basin = basin_of[(y * width + x) as usize];
                if basin != u32::MAX {
                    let root = basins.find(basin);
                    if !around.contains(&root) {
                        around.push(root);
                    }
                }
            }
        }
        let deepest = around
            .iter()
            .copied()
            .reduce(|best, basin| if peaks[basin as usize] > peaks[best as usize] { basin } else { best });
        let Some(deepest) = deepest else {
            basin_of[cell as usize] = basins.add();
            peaks.push(distance);
            continue;
        };
        basin_of[cell as usize] = deepest;
        for &other in &around {
            let (one, other) = (basins.find(deepest), basins.find(other));
            if one == other {
                continue;
            }
            let (peak, lower) = (peaks[one as usize], peaks[other as usize]);
            if distance > widest_share * peak.min(lower) {
                let (keep, go) = if peak >= lower { (one, other) } else { (other, one) };
                basins.join(keep, go);
            } else {
                found.extend(across(raster, distances, x, y));
            }
        }
    }
    found
}

/// From the nearest obstacle of a cell to the one most nearly opposite.
fn across(raster: &Raster, distances: &Distances, x: i32, y: i32) -> Option<[Point; 2]> {
    /// How far around the cell to look for the obstacle on the other side, in cells.
    const AROUND: i32 = 2;
    let (width, height) = (raster.width as i32, raster.height as i32);
    let here = Point::new(f64::from(x), f64::from(y));
    let obstacle = |x: i32, y: i32| {
        let (x, y) = distances.nearest[(y * width + x) as usize];
        Point::new(f64::from(x), f64::from(y))
    };
    let one = obstacle(x, y);
    let mut best: Option<(f64, Point)> = None;
    for y in (y - AROUND).max(0)..=(y + AROUND).min(height - 1) {
        for x in (x - AROUND).max(0)..=(x + AROUND).min(width - 1) {
            if !raster.is_free(x, y) {
                continue;
            }
            let other = obstacle(x, y);
            let lengths = (one - here).length() * (other - here).length();
            let cosine = (one - here).dot(other - here) / (lengths + 1e-9);
            if best.is_none_or(|(least, _)| cosine < least) {
                best = Some((cosine, other));
            }
        }
    }
    let (_, other) = best.filter(|&(cosine, _)| cosine < MOST_COSINE)?;
    let middle = |point: Point| Point::new(point.x + 0.5, point.y + 0.5);
    Some([middle(one), middle(other)])
}
