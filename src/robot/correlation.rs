//! A coarse search for a pose in a window too wide for [`super::matching`]: tries every pose of a grid on
//! a raster of the lines (Olson 2009, 'Real-time correlative scan matching').

use super::matching::SurfacePoint;
use super::{LineSegment, Pose};
use crate::geometry::{Bounds, Point, Vector};

/// Side of a raster cell in metres.
const CELL_M: f64 = 0.1;
/// A line marks the cells this far around it.
const BLUR_M: f64 = 0.15;
/// Directions are quantised into this many sectors, one bit each.
const SECTORS: usize = 16;
/// Maximum width of a raster.
const WIDEST_M: f64 = 120.0;

/// The sample size for a coarse search, in points.
pub const COARSE_POINTS: usize = 120;

/// For each cell, the directions of the lines near it.
#[derive(Clone, Debug)]
pub struct Raster {
    origin: Point,
    columns: usize,
    rows: usize,
    directions: Vec<u16>,
}

/// A search window: this far to each side of the guess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    pub way_m: f64,
    pub turn_rad: f64,
}

impl Raster {
    pub fn new(lines: &[LineSegment], bounds: Bounds) -> Self {
        let side = |length: f64| (length.min(WIDEST_M) / CELL_M).ceil().max(1.0) as usize;
        let (columns, rows) = (side(bounds.width()), side(bounds.height()));
        let mut raster = Self { origin: bounds.min, columns, rows, directions: vec![0; columns * rows] };
        for line in lines {
            raster.mark(line);
        }
        raster
    }

    fn mark(&mut self, line: &LineSegment) {
        // The sector and its two neighbours: a segment of a scan may be a sector off.
        let middle = sector(line.direction().angle_rad());
        let mut bits = 0_u16;
        for by in [SECTORS - 1, 0, 1] {
            bits |= 1 << ((middle + by) % SECTORS);
        }
        let steps = (line.length() / CELL_M).ceil().max(1.0) as usize;
        let reach = (BLUR_M / CELL_M).round() as i64;
        for step in 0..=steps {
            let point = line.start.lerp(line.end, step as f64 / steps as f64);
            let (column, row) = self.cell(point);
            for row in row - reach..=row + reach {
                for column in column - reach..=column + reach {
                    if let Some(at) = self.index(column, row) {
                        self.directions[at] |= bits;
                    }
                }
            }
        }
    }

    fn cell(&self, point: Point) -> (i64, i64) {
        (((point.x - self.origin.x) / CELL_M).floor() as i64, ((point.y - self.origin.y) / CELL_M).floor() as i64)
    }

    fn index(&self, column: i64, row: i64) -> Option<usize> {
        let (column, row) = (usize::try_from(column).ok()?, usize::try_from(row).ok()?);
        (column < self.columns && row < self.rows).then(|| row * self.columns + column)
    }

    /// The poses of the window that put the most points on lines, best first and well separated, each
    /// with the share of points it explains.
    pub fn search(&self, points: &[SurfacePoint], guess: Pose, window: Window, most: usize) -> Vec<(Pose, f64)> {
        let radius = points.iter().map(|point| point.at.x.hypot(point.at.y)).fold(1.0, f64::max).min(8.0);
        let turn_step = (2.0 * CELL_M / radius).min(window.turn_rad.max(1e-3));
        let turns = (window.turn_rad / turn_step).ceil() as i64;
        let ways = (window.way_m / CELL_M).ceil() as i64;
        // Every other cell: the blur bridges the gaps.
        let stride = 2;
        let mut found: Vec<(Pose, f64)> = Vec::new();
        for turn in -turns..=turns {
            let heading_rad = guess.heading_rad + turn as f64 * turn_step;
            let cells: Vec<(i64, i64, u16)> = points
                .iter()
                .map(|point| {
                    let at = Vector::new(point.at.x, point.at.y).rotated(heading_rad);
                    let (column, row) = self.cell(guess.position() + at);
                    (column, row, 1 << sector(point.along.rotated(heading_rad).angle_rad()))
                })
                .collect();
            let mut best: Option<(i64, i64, usize)> = None;
            for up in (-ways..=ways).step_by(stride) {
                for right in (-ways..=ways).step_by(stride) {
                    let hits = cells
                        .iter()
                        .filter(|(column, row, bit)| {
                            self.index(column + right, row + up).is_some_and(|at| self.directions[at] & bit != 0)
                        })
                        .count();
                    if best.is_none_or(|(_, _, most)| hits > most) {
                        best = Some((right, up, hits));
                    }
                }
            }
            if let Some((right, up, hits)) = best {
                let at = guess.position() + Vector::new(right as f64, up as f64) * CELL_M;
                found.push((Pose::new(at.x, at.y, heading_rad), hits as f64 / points.len().max(1) as f64));
            }
        }
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut apart: Vec<(Pose, f64)> = Vec::new();
        for (pose, share) in found {
            let is_new = apart.iter().all(|(other, _)| {
                let way = other.between(pose);
                way.x_m.hypot(way.y_m) > 4.0 * CELL_M || way.heading_rad.abs() > 4.0 * turn_step
            });
            if is_new && apart.len() < most {
                apart.push((pose, share));
            }
        }
        apart
    }
}

/// About `most` of the points, evenly spaced.
pub fn thinned(points: &[SurfacePoint], most: usize) -> Vec<SurfacePoint> {
    points.iter().step_by(points.len().div_ceil(most.max(1)).max(1)).copied().collect()
}

fn sector(angle_rad: f64) -> usize {
    let turns = angle_rad.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
    ((turns * SECTORS as f64).round() as usize) % SECTORS
}
