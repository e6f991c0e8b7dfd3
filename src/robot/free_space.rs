//! The explored free space: a polygon with holes whose edges are obstacles or frontiers (paper, section
//! 3.3).

use std::collections::BTreeSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::grid_map::{Cell, GridMap};
use super::segment::outlines;
use super::split_and_merge::USUAL_NOISE_M;
use super::{Pose, Scan};
use crate::geometry::areas::{self, Ring, Shapes};
use crate::geometry::{Bounds, Point, Segment, polygon};

/// How far the free space seen by a scan ends before each hit, in metres: three standard deviations of a usual
/// reading, plus the error of simplifying its outline.
const BEFORE_HIT_M: f64 = 0.02;

/// How much further before it at most, in metres, with scanners of more noise.
const MOST_BEFORE_HIT_M: f64 = 0.05;

/// Outlines are simplified to this tolerance in metres: the resolution of the readings, 1 cm, and a
/// little.
const OUTLINE_M: f64 = 0.012;

/// How much coarser at most, in metres, with scanners of more noise: else every reading would be a corner, and each look
/// would cost more than the one before.
const MOST_COARSER_M: f64 = 0.04;

/// Two neighbouring beams whose readings differ by more than this, in metres, hit different things.
const JUMP_M: f64 = 0.3;

/// Side in metres of the cells that record hits.
const HIT_CELL_M: f64 = 0.05;

/// Tolerance in cells for the outlines of a grid map's free cells, which are staircases along oblique walls.
const STAIRS_CELLS: f64 = 1.0;

/// A smaller gap of unknown floor, in m², is a shadow between two beams.
const SHADOW_M2: f64 = 0.02;

/// The kind of boundary of a stretch of the free space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    /// Something was hit there.
    Obstacle,
    /// What is behind it has not been seen yet.
    Frontier,
}

/// The free space seen so far, in the map's frame.
#[derive(Clone, Debug, Default)]
pub struct FreeSpace {
    shapes: Shapes,
    hits: BTreeSet<(i32, i32)>,
    /// The standard deviation of a reading beyond the usual, in metres.
    more_noise_m: f64,
}

impl FreeSpace {
    /// Nothing seen yet, by scanners whose readings have this standard deviation in metres.
    pub fn for_noise(noise_m: f64) -> Self {
        Self { more_noise_m: (noise_m - USUAL_NOISE_M).max(0.0), ..Self::default() }
    }

    /// The union of the free space seen by scans, each with the robot's pose at the time.
    pub fn of<'a>(seen: impl IntoIterator<Item = (Pose, &'a [Scan])>) -> Self {
        Self::default().again(seen)
    }

    /// The same from other scans of the same scanners, or from other poses.
    #[must_use]
    pub fn again<'a>(&self, seen: impl IntoIterator<Item = (Pose, &'a [Scan])>) -> Self {
        let mut free = Self { more_noise_m: self.more_noise_m, ..Self::default() };
        let mut parts: Vec<Shapes> = Vec::new();
        for (map_from_robot, scans) in seen {
            parts.push(free.outlines(map_from_robot, scans));
        }
        // Merged pairwise: each outline is merged log(n) times, not n times.
        while parts.len() > 1 {
            let pairs = parts.chunks(2).map(|pair| match pair {
                [one, other] => union(one, other),
                _ => pair.concat(),
            });
            parts = pairs.collect();
        }
        free.shapes = parts.pop().unwrap_or_default();
        free.tidy();
        free
    }

    /// The free space of a grid map, with its occupied cells as hits.
    pub fn of_grid(map: &GridMap) -> Self {
        let (width, height) = (map.width() as i32, map.height() as i32);
        let cell_at = |x: i32, y: i32| {
            let inside = (0..width).contains(&x) && (0..height).contains(&y);
            if inside { map.cells()[(y * width + x) as usize] } else { Cell::Unknown }
        };
        let window = [0, 0, map.width(), map.height()];
        let rings: Vec<Ring> = outlines(window, |x, y| cell_at(x, y) == Cell::Free)
            .iter()
            .map(|outline| super::segment::simplified(outline, STAIRS_CELLS))
            .filter(|ring| ring.len() >= 3)
            .map(|ring| {
                let at = |point: &Point| map.map_from_picture(point.x, point.y);
                ring.iter().map(at).map(|point| [point.x, point.y]).collect()
            })
            .collect();
        let shapes = if rings.is_empty() { Shapes::new() } else { rings.simplify_shape(FillRule::NonZero) };
        let occupied = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let hits = occupied
            .filter(|&(x, y)| cell_at(x, y) == Cell::Occupied)
            .map(|(x, y)| swapped(hit_cell(map.map_from_picture(f64::from(x) + 0.5, f64::from(y) + 0.5))))
            .collect();
        Self { shapes, hits, more_noise_m: 0.0 }
    }

    /// Adds what the scans from one place saw.
    pub fn add(&mut self, map_from_robot: Pose, scans: &[Scan]) {
        let seen = self.outlines(map_from_robot, scans);
        self.shapes = union(&self.shapes, &seen);
        self.tidy();
    }

    /// The polygons: the outer ring counter-clockwise first, then its holes.
    pub fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// Its bounding box.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.shapes.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y)))
    }

    /// Whether something was hit within about 0.1 m of a point.
    pub fn is_hit_near(&self, point: Point) -> bool {
        let (x, y) = hit_cell(point);
        (-2..=2).any(|row| self.hits.range((y + row, x - 2)..=(y + row, x + 2)).next().is_some())
    }

    /// All edges, cut into pieces of at most `piece_m` metres, each with its kind. The pieces of each
    /// ring are in order; the free space is to their left.
    pub fn edges(&self, piece_m: f64) -> Vec<Vec<(Segment, EdgeKind)>> {
        let kind = |piece: Segment| {
            if self.is_hit_near(piece.midpoint()) { EdgeKind::Obstacle } else { EdgeKind::Frontier }
        };
        let pieces = |edge: Segment| {
            let count = (edge.length() / piece_m).ceil().clamp(1.0, 10_000.0) as usize;
            (0..count).map(move |i| {
                let at = |i: usize| edge.a.lerp(edge.b, i as f64 / count as f64);
                Segment::new(at(i), at(i + 1))
            })
        };
        let of_ring = |ring: &Ring| {
            let points = areas::points(ring);
            polygon::edges(&points).flat_map(pieces).map(|piece| (piece, kind(piece))).collect()
        };
        self.shapes.iter().flatten().map(of_ring).collect()
    }

    /// The free space seen by scans; also records their hits.
    fn outlines(&mut self, map_from_robot: Pose, scans: &[Scan]) -> Shapes {
        let mut rings: Vec<Ring> = Vec::new();
        for scan in scans {
            let map_from_scanner = map_from_robot.compose(scan.robot_from_scanner);
            self.remember_hits(scan, map_from_scanner);
            // Not so far that the hit is no longer near.
            let before_hit_m = BEFORE_HIT_M + (3.0 * self.more_noise_m).min(MOST_BEFORE_HIT_M);
            let outline: Vec<Point> = outline(scan, before_hit_m, self.outline_m())
                .into_iter()
                .map(|point| map_from_scanner.apply(point))
                .collect();
            if outline.len() >= 3 {
                rings.push(areas::ring(&outline));
            }
        }
        if rings.is_empty() { Shapes::new() } else { rings.simplify_shape(FillRule::NonZero) }
    }

    fn remember_hits(&mut self, scan: &Scan, map_from_scanner: Pose) {
        let mut last: Option<(usize, Point)> = None;
        for (beam, point) in scan.points() {
            let point = map_from_scanner.apply(point);
            self.hits.insert(swapped(hit_cell(point)));
            if let Some((before, from)) = last
                && beam - before <= 3
            {
                // Between two beams that hit one surface, the surface continues.
                let length_m = from.distance(point);
                let steps = (length_m / HIT_CELL_M).ceil();
                if length_m < JUMP_M && steps > 1.0 {
                    for step in 1..steps as usize {
                        self.hits.insert(swapped(hit_cell(from.lerp(point, step as f64 / steps))));
                    }
                }
            }
            last = Some((beam, point));
        }
    }

    /// The tolerance of outlines, in metres.
    fn outline_m(&self) -> f64 {
        OUTLINE_M + self.more_noise_m.min(MOST_COARSER_M)
    }

    /// Simplifies outlines and removes shadows.
    fn tidy(&mut self) {
        let outline_m = self.outline_m();
        let tidied = |ring: &Ring| -> Option<Ring> {
            let points = simplified_ring(&areas::points(ring), outline_m);
            (points.len() >= 3).then(|| points.iter().map(|point| [point.x, point.y]).collect())
        };
        let shapes = self.shapes.iter().filter_map(|shape| {
            let (outer, holes) = shape.split_first()?;
            let holes = holes.iter().filter(|hole| {
                let points = areas::points(hole);
                polygon::signed_area(&points).abs() >= SHADOW_M2 || self.is_hit_near(polygon::centroid(&points))
            });
            let mut rings = vec![tidied(outer)?];
            rings.extend(holes.filter_map(tidied));
            Some(rings)
        });
        self.shapes = shapes.collect();
    }
}

/// The union of two areas.
pub(super) fn union(one: &Shapes, other: &Shapes) -> Shapes {
    match (one.is_empty(), other.is_empty()) {
        (true, _) => other.clone(),
        (_, true) => one.clone(),
        _ => one.overlay(other, OverlayRule::Union, FillRule::NonZero),
    }
}

fn hit_cell(point: Point) -> (i32, i32) {
    let cell = |at: f64| (at / HIT_CELL_M).floor().clamp(-1e9, 1e9) as i32;
    (cell(point.x), cell(point.y))
}

/// Row first: neighbours along x are adjacent in the set.
fn swapped((x, y): (i32, i32)) -> (i32, i32) {
    (y, x)
}

/// The outline of the free space seen by one sweep, in the scanner's frame, starting and ending at the
/// scanner. It ends `before_hit_m` metres before each hit and is simplified to `outline_m`.
fn outline(scan: &Scan, before_hit_m: f64, outline_m: f64) -> Vec<Point> {
    let ray = |beam: usize, range_m: f64| {
        let (sin, cos) = scan.angle_rad(beam).sin_cos();
        Point::new(range_m * cos, range_m * sin)
    };
    let seen: Vec<(usize, f64)> = (0..scan.ranges_m.len())
        .filter_map(|beam| Some((beam, (scan.range_m(beam)? - before_hit_m).max(0.0))))
        .collect();
    let scanner = Point::default();
    let mut outline: Vec<Point> = vec![scanner];
    let mut run: Vec<Point> = Vec::new();
    let beams = scan.ranges_m.len();
    let edge = (seen.first().copied(), seen.last().copied());
    let open = |outline: &mut Vec<Point>, from: Option<(usize, f64)>, to: Option<(usize, f64)>| {
        let first = from.map_or(0, |(beam, _)| beam + 1);
        let last = to.map_or(beams, |(beam, _)| beam);
        let range_m = open_range_m(scan, from, to, last - first);
        if range_m > 0.0 {
            // Only beams without return extend past what is seen beside them.
            let beside_m = from.into_iter().chain(to).map(|(_, range_m)| range_m).fold(f64::INFINITY, f64::min);
            let widened = usize::from(range_m <= beside_m);
            let begin = first.saturating_sub(if from.is_some() { widened } else { 0 });
            let end = if to.is_some() { last - 1 + widened } else { last - 1 };
            // Enough corners that the chord stays outside the space the beams passed.
            outline.extend((begin..end).step_by(CHORD_BEAMS).map(|beam| ray(beam, range_m)));
            outline.push(ray(end, range_m));
        } else {
            outline.push(scanner);
        }
    };
    let mut last: Option<(usize, f64)> = None;
    for (beam, range_m) in seen {
        match last {
            None if beam > 0 => open(&mut outline, None, edge.0),
            Some((before, last_m)) if beam - before > LOST_BEAMS + 1 => {
                outline.extend(simplified(&run, outline_m));
                run.clear();
                open(&mut outline, Some((before, last_m)), Some((beam, range_m)));
            }
            Some((before, last_m)) if (range_m - last_m).abs() > JUMP_M => {
                // The floor between the two is known only as far as the nearer one.
                let corner = if range_m > last_m { ray(beam, last_m) } else { ray(before, range_m) };
                outline.extend(simplified(&run, outline_m));
                outline.push(corner);
                run.clear();
            }
            _ => {}
        }
        run.push(ray(beam, range_m));
        last = Some((beam, range_m));
    }
    outline.extend(simplified(&run, outline_m));
    match edge.1 {
        Some((beam, _)) if beam + 1 < beams => open(&mut outline, edge.1, None),
        _ => {}
    }
    outline
}

/// How far the floor is free, in metres, along consecutive beams without return. A wall met at too
/// shallow an angle is further away than what is seen beside it, and no wall is met that way over many
/// beams.
fn open_range_m(scan: &Scan, from: Option<(usize, f64)>, to: Option<(usize, f64)>, lost: usize) -> f64 {
    let beside_m = from.into_iter().chain(to).map(|(_, range_m)| range_m).fold(f64::INFINITY, f64::min);
    let is_wide = lost as f64 * scan.step_rad.abs() >= WIDE_OPEN_RAD;
    let far_m = OPEN_M.min(0.8 * scan.max_range_m);
    match (beside_m.is_finite(), is_wide) {
        (true, true) => beside_m.max(far_m),
        (true, false) => beside_m,
        (false, _) => 0.0,
    }
}

/// If nothing returns over this angle, there is no wall nearby.
const WIDE_OPEN_RAD: f64 = 0.14;

/// How far the floor then counts as free, in metres.
const OPEN_M: f64 = 6.0;

/// The outline of an open sector has a corner every this many beams.
const CHORD_BEAMS: usize = 8;

/// Up to this many consecutive beams without return count as lost readings, if their neighbours agree.
const LOST_BEAMS: usize = 2;

/// Simplifies a polyline: drops points closer than the tolerance to what is left (Douglas and Peucker
/// 1973).
pub(super) fn simplified(chain: &[Point], tolerance_m: f64) -> Vec<Point> {
    if chain.len() < 3 {
        return chain.to_vec();
    }
    let mut kept = vec![false; chain.len()];
    kept[0] = true;
    kept[chain.len() - 1] = true;
    let mut open = vec![(0, chain.len() - 1)];
    while let Some((from, to)) = open.pop() {
        let base = Segment::new(chain[from], chain[to]);
        let furthest =
            (from + 1..to).map(|i| (base.distance(chain[i]), i)).max_by(|p, q| p.0.total_cmp(&q.0).then(q.1.cmp(&p.1)));
        if let Some((distance_m, i)) = furthest
            && distance_m > tolerance_m
        {
            kept[i] = true;
            open.extend([(from, i), (i, to)]);
        }
    }
    chain.iter().zip(kept).filter_map(|(&point, kept)| kept.then_some(point)).collect()
}

/// [`simplified`] for a ring: starts from its two points roughly furthest apart, so that the result does
/// not depend on where the ring begins.
pub(super) fn simplified_ring(ring: &[Point], tolerance_m: f64) -> Vec<Point> {
    let Some(&first) = ring.first() else { return Vec::new() };
    let furthest = |from: Point| {
        (0..ring.len()).max_by(|&i, &j| from.distance(ring[i]).total_cmp(&from.distance(ring[j]))).unwrap_or(0)
    };
    let start = furthest(first);
    let turned: Vec<Point> = ring[start..].iter().chain(&ring[..start]).copied().collect();
    let middle = (0..turned.len())
        .max_by(|&i, &j| turned[0].distance(turned[i]).total_cmp(&turned[0].distance(turned[j])))
        .unwrap_or(0);
    let mut kept = simplified(&turned[..=middle], tolerance_m);
    kept.pop();
    let back: Vec<Point> = turned[middle..].iter().chain(turned.first()).copied().collect();
    kept.extend(simplified(&back, tolerance_m));
    kept.pop();
    kept
}
