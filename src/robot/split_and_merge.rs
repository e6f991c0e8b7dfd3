//! Split-and-merge: line segments from one scan (the paper's reference 17, as compared by Nguyen et al.
//! 2007), first split at range jumps.

use super::{LineSegment, Moments, Scan};
use crate::geometry::Point;

/// Criteria for a straight segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SplitOptions {
    /// The maximum distance of a point from its segment, in metres, at close range.
    pub tolerance_m: f64,
    /// The additional tolerance per metre of range: the footprint of a beam grows.
    pub tolerance_per_m: f64,
    /// The minimum number of points in a segment.
    pub least_points: usize,
    /// With fewer points than this, spaced `sparse_m` metres or more, an alignment may be chance: past a
    /// door's jamb and a wall behind it. Good enough for matching scans, but not for a map.
    pub least_sparse_points: usize,
    pub sparse_m: f64,
    /// The shallowest angle between beam and wall at which neighbouring readings still count as connected
    /// (the λ of Borges and Aldon 2004).
    pub flattest_rad: f64,
    /// Neighbouring hits closer than this are connected at any angle.
    pub gap_m: f64,
}

impl Default for SplitOptions {
    /// For a SICK LMS 200: 1 cm of noise and 1 cm of rounding (its manual states ±1.5 cm and σ 5 mm up to
    /// 8 m), so 3 cm include nearly all points of a wall.
    fn default() -> Self {
        Self {
            tolerance_m: 0.03,
            tolerance_per_m: 0.002,
            least_points: 3,
            least_sparse_points: 6,
            sparse_m: 0.15,
            flattest_rad: 8_f64.to_radians(),
            gap_m: 0.06,
        }
    }
}

/// The standard deviation of a reading, in metres, that the defaults are for: that of a SICK LMS 200.
pub(super) const USUAL_NOISE_M: f64 = 0.005;

impl SplitOptions {
    /// For readings with this standard deviation, in metres: wider by three times of what exceeds the usual, so that
    /// a wall's points stay together.
    pub fn for_noise(noise_m: f64) -> Self {
        let more_m = 3.0 * (noise_m - USUAL_NOISE_M).max(0.0);
        let usual = Self::default();
        Self { tolerance_m: usual.tolerance_m + more_m, gap_m: usual.gap_m + more_m, ..usual }
    }

    /// Whether a segment of a scan is reliable enough for a map.
    pub fn is_firm(&self, segment: &LineSegment) -> bool {
        let count = segment.moments.weight;
        count >= self.least_sparse_points as f64 || segment.length() <= self.sparse_m * (count - 1.0)
    }
}

/// A segment of a scan and its readings.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanSegment {
    /// In the frame of the points.
    pub line: LineSegment,
    /// Its hits: a range of indices into the hits, in beam order.
    pub hits: std::ops::Range<usize>,
}

/// The hits of a scan in the scanner's frame, and the segments through them.
pub fn segments_of(scan: &Scan, options: &SplitOptions) -> (Vec<Point>, Vec<ScanSegment>) {
    let (beams, points): (Vec<usize>, Vec<Point>) = scan.points().unzip();
    let segments = pieces(&beams, &points, scan.step_rad, options)
        .into_iter()
        .flat_map(|piece| settled(&points, merged(&points, split(&points, piece, options), options), options))
        .filter(|hits| hits.len() >= options.least_points)
        .filter_map(|hits| Some(ScanSegment { line: LineSegment::fitted(&points[hits.clone()])?, hits }))
        .collect();
    (points, segments)
}

/// Maximal runs of hits without jumps between neighbours.
fn pieces(beams: &[usize], points: &[Point], step_rad: f64, options: &SplitOptions) -> Vec<std::ops::Range<usize>> {
    let mut pieces = Vec::new();
    let mut first = 0;
    for at in 1..=points.len() {
        if at == points.len() || is_jump(beams[at] - beams[at - 1], points[at - 1], points[at], step_rad, options) {
            if at > first {
                pieces.push(first..at);
            }
            first = at;
        }
    }
    pieces
}

/// More consecutive lost beams than this split a wall.
const MOST_LOST_BEAMS: usize = 2;

/// Whether two neighbouring hits belong to different surfaces: further apart than the shallowest wall at
/// that range would put them (the adaptive breakpoint detector of Borges and Aldon 2004).
fn is_jump(beams: usize, from: Point, to: Point, step_rad: f64, options: &SplitOptions) -> bool {
    if beams > MOST_LOST_BEAMS + 1 {
        return true;
    }
    let turn = step_rad.abs() * beams as f64;
    let range = from.x.hypot(from.y).min(to.x.hypot(to.y));
    let flattest = options.flattest_rad.max(1.5 * turn);
    let apart = range * turn.sin() / (flattest - turn).sin();
    from.distance(to) > apart.max(options.gap_m)
}

/// The maximum distance of `point` from its segment.
fn tolerance_m(point: Point, options: &SplitOptions) -> f64 {
    options.tolerance_m + options.tolerance_per_m * point.x.hypot(point.y)
}

/// Splits a run of hits at the point furthest from the chord until all points are close to theirs (Ramer
/// 1972), without recursion: a scan may have as many points as fit on a line of the log.
fn split(points: &[Point], piece: std::ops::Range<usize>, options: &SplitOptions) -> Vec<std::ops::Range<usize>> {
    let mut done = Vec::new();
    let mut waiting = vec![piece];
    while let Some(part) = waiting.pop() {
        match furthest_off(points, part.clone(), options) {
            Some(corner) => {
                // The corner's hit ends the first part; the second starts at the next hit.
                waiting.push(corner + 1..part.end);
                waiting.push(part.start..corner + 1);
            }
            None => done.push(part),
        }
    }
    done
}

/// The hit furthest from the chord of a part, if beyond its tolerance.
fn furthest_off(points: &[Point], part: std::ops::Range<usize>, options: &SplitOptions) -> Option<usize> {
    if part.len() < 3 {
        return None;
    }
    let (first, last) = (points[part.start], points[part.end - 1]);
    let chord = (last - first).unit()?;
    let mut worst = (1.0, None);
    for (at, &point) in points.iter().enumerate().take(part.end - 1).skip(part.start + 1) {
        let off = (point - first).cross(chord).abs() / tolerance_m(point, options);
        if off > worst.0 {
            worst = (off, Some(at));
        }
    }
    worst.1
}

/// Merges neighbouring parts whose points are close to a common line.
fn merged(points: &[Point], parts: Vec<std::ops::Range<usize>>, options: &SplitOptions) -> Vec<std::ops::Range<usize>> {
    let mut merged: Vec<std::ops::Range<usize>> = Vec::new();
    for part in parts {
        let mut part = part;
        while let Some(before) = merged.last() {
            let both = before.start..part.end;
            if !is_straight(&points[both.clone()], options) {
                break;
            }
            merged.pop();
            part = both;
        }
        merged.push(part);
    }
    merged
}

/// Assigns each hit between two parts to the nearer line: the hits at a corner fit both within the
/// tolerance, and would tilt the wrong one.
fn settled(
    points: &[Point],
    mut parts: Vec<std::ops::Range<usize>>,
    options: &SplitOptions,
) -> Vec<std::ops::Range<usize>> {
    for at in 1..parts.len() {
        let (before, after) = (parts[at - 1].clone(), parts[at].clone());
        if before.len() <= options.least_points || after.len() <= options.least_points {
            continue;
        }
        // The lines without the hits to be assigned.
        let inner = |part: std::ops::Range<usize>| Moments::of(points[part].iter().copied());
        let (one, other) = (inner(before.start..before.end - 1), inner(after.start + 1..after.end));
        let off = |line: Moments, point: Point| (point - line.centroid).cross(line.direction()).abs();
        let is_of_other = |hit: usize| off(other, points[hit]) < off(one, points[hit]);
        let mut border = before.end;
        while border - before.start > options.least_points && is_of_other(border - 1) {
            border -= 1;
        }
        if border == before.end {
            while after.end - border > options.least_points && !is_of_other(border) {
                border += 1;
            }
        }
        parts[at - 1] = before.start..border;
        parts[at] = border..after.end;
    }
    parts
}

/// Whether all points are close to their common line.
fn is_straight(points: &[Point], options: &SplitOptions) -> bool {
    let moments = Moments::of(points.iter().copied());
    let direction = moments.direction();
    points.iter().all(|point| (*point - moments.centroid).cross(direction).abs() <= tolerance_m(*point, options))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Pose;

    /// A scan of a room 4 m wide and 3 m deep seen from its middle, all around.
    fn room(noise_m: f64) -> Scan {
        let mut random = crate::base::random::Random::new(5);
        let step = 1_f64.to_radians();
        let ranges_m = (0..360)
            .map(|beam| {
                let (sin, cos) = (step * f64::from(beam) - 3.0).sin_cos();
                (2.0 / cos.abs()).min(1.5 / sin.abs()) + noise_m * (2.0 * random.unit() - 1.0)
            })
            .collect();
        Scan { ranges_m, start_rad: -3.0, step_rad: step, max_range_m: 30.0, robot_from_scanner: Pose::IDENTITY }
    }

    #[test]
    fn a_room_has_four_walls_seen_from_inside() {
        let (points, segments) = segments_of(&room(0.015), &SplitOptions::default());
        let long: Vec<_> = segments.iter().filter(|segment| segment.line.length() > 0.5).collect();
        // The sweep starts and ends within one wall.
        assert_eq!(long.len(), 5, "{long:?}");
        for segment in long {
            assert!(segment.line.normal().dot(Point::new(0.0, 0.0) - segment.line.start) > 1.4);
        }
        let explained: usize = segments.iter().map(|segment| segment.hits.len()).sum();
        assert!(explained * 100 > points.len() * 97, "{explained} of {}", points.len());
    }

    #[test]
    fn a_jump_of_range_separates_parallel_walls() {
        // A wall 2 m ahead with a niche 1 m deep.
        let step = 1_f64.to_radians();
        let ranges_m = (0..81)
            .map(|beam| if (30..50).contains(&beam) { 3.0 } else { 2.0 } / (step * (f64::from(beam) - 40.0)).cos())
            .collect();
        let scan = Scan {
            ranges_m,
            start_rad: -40.0 * step,
            step_rad: step,
            max_range_m: 30.0,
            robot_from_scanner: Pose::IDENTITY,
        };
        let (_, segments) = segments_of(&scan, &SplitOptions::default());
        let hits: Vec<_> = segments.iter().map(|segment| segment.hits.clone()).collect();
        assert_eq!(hits, [0..30, 30..50, 50..81]);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        let blind = Scan { ranges_m: vec![f64::NAN, 0.0, -1.0, f64::INFINITY, 99.0], ..room(0.0) };
        assert_eq!(segments_of(&blind, &SplitOptions::default()), (Vec::new(), Vec::new()));
    }
}
