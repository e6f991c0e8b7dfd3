//! Loop closing: whether what a robot sees now matches what it saw at a place long ago.

use super::correlation::{COARSE_POINTS, Raster, Window, thinned};
use super::line_map::{FusionOptions, LineMap};
use super::matching::{MatchOptions, PoseEstimate, Reference, SurfacePoint, match_points};
use super::{LineSegment, Pose};
use crate::geometry::{Bounds, Point};

/// The criteria for recognising a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosureOptions {
    /// Minimum path length in metres before a place can be revisited.
    pub least_path_m: f64,
    /// Keyframes between two attempts.
    pub every: usize,
    /// Places further away than this plus the drift are not considered, in metres.
    pub near_m: f64,
    /// Drift of the path since the last closure, in metres per metre and radians per metre; and before
    /// it.
    pub drift_m_per_m: f64,
    pub drift_rad_per_m: f64,
    pub drift_m: f64,
    pub drift_rad: f64,
    /// The number of keyframes around the place, and before now, that are compared.
    pub around: usize,
    /// The share of points that must lie on lines, for a narrow and for a wide window.
    pub explained: f64,
    pub explained_wide: f64,
    /// With at least this drift, in metres, a closure waits for a second one that agrees.
    pub wide_m: f64,
}

impl Default for ClosureOptions {
    fn default() -> Self {
        Self {
            least_path_m: 8.0,
            every: 3,
            near_m: 2.5,
            drift_m_per_m: 0.02,
            drift_rad_per_m: 0.003,
            drift_m: 0.2,
            drift_rad: 0.04,
            around: 8,
            explained: 0.6,
            explained_wide: 0.7,
            wide_m: 1.0,
        }
    }
}

/// The uncertainty of the path between two places.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    pub way_m: f64,
    pub turn_rad: f64,
}

/// A recognised place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closure {
    /// The current pose in the place's frame.
    pub estimate: PoseEstimate,
    pub explained: f64,
}

/// The sample size for the fine search, in points.
const FINE_POINTS: usize = 500;
/// Poses from the coarse search that are examined closely.
const MOST_POSES: usize = 3;
/// A runner-up elsewhere that explains nearly as much as the best makes the place ambiguous.
const AMBIGUOUS: f64 = 0.06;
/// The maximum uncertainty of a closure in any direction: standard deviation in metres, with radians
/// converted to metres a few metres away.
const VAGUEST_M: f64 = 0.15;

/// Looks for the current pose among the lines of a place. Everything is in the place's frame: `segments`
/// were seen there, `guess` is the pose according to the path; only `points`, seen now, are in the
/// robot's frame.
pub fn recognise(
    segments: &[LineSegment],
    points: &[SurfacePoint],
    guess: Pose,
    drift: Drift,
    options: &ClosureOptions,
    matching: &MatchOptions,
    fusion: &FusionOptions,
) -> Option<Closure> {
    let mut map = LineMap::default();
    for segment in segments {
        map.add(*segment, fusion);
    }
    let lines: Vec<LineSegment> = map.lines().map(|line| line.line).collect();
    let bounds = Bounds::of(lines.iter().flat_map(|line| [line.start, line.end])).inflated(1.0);
    let reference = Reference::new(&lines, bounds, matching.first_reach_m);
    let fine = thinned(points, FINE_POINTS);
    let is_wide = drift.way_m > matching.first_reach_m;
    let starts = if is_wide {
        let window = Window { way_m: drift.way_m, turn_rad: drift.turn_rad };
        let coarse = thinned(points, COARSE_POINTS);
        Raster::new(&lines, bounds).search(&coarse, guess, window, MOST_POSES)
    } else {
        vec![(guess, 1.0)]
    };
    let mut found: Vec<Closure> = starts
        .into_iter()
        .filter_map(|(start, _)| match_points(&reference, &fine, start, None, matching))
        .map(|found| Closure { estimate: found.estimate, explained: found.explained })
        .collect();
    found.sort_by(|a, b| b.explained.total_cmp(&a.explained));
    let best = *found.first()?;
    let least = if is_wide { options.explained_wide } else { options.explained };
    let away = guess.between(best.estimate.pose);
    let is_plausible = away.x_m.hypot(away.y_m) <= 1.5 * drift.way_m.max(matching.first_reach_m)
        && away.heading_rad.abs() <= 1.5 * drift.turn_rad;
    let is_clear = found.iter().skip(1).all(|other| {
        let apart = best.estimate.pose.between(other.estimate.pose);
        (apart.x_m.hypot(apart.y_m) < 0.2 && apart.heading_rad.abs() < 0.1)
            || other.explained < best.explained - AMBIGUOUS
    });
    (best.explained >= least && is_plausible && is_clear && is_firm(&best.estimate)).then_some(best)
}

/// Whether a pose is certain enough in every direction.
fn is_firm(estimate: &PoseEstimate) -> bool {
    estimate.information.try_inverse().is_some_and(|covariance| {
        let place = covariance.fixed_view::<2, 2>(0, 0).symmetric_eigenvalues().max();
        place.is_finite() && place < VAGUEST_M * VAGUEST_M
    })
}

/// Whether a point is near a place.
pub fn is_near(place: Point, point: Point, options: &ClosureOptions, drift: Drift) -> bool {
    place.distance(point) <= options.near_m + drift.way_m
}
