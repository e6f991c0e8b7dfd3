//! From scans with odometry to poses and a line map, one scan at a time.

use nalgebra::{Matrix3, Vector3};

use super::calibration::{OdometryCalibration, OdometryOptions};
use super::correlation::{COARSE_POINTS, Raster, Window, thinned};
use super::line_map::{FusionOptions, LineMap};
use super::loop_closing::{Closure, ClosureOptions, Drift, is_near, recognise};
use super::matching::{Match, MatchOptions, PoseEstimate, Reference, SurfacePoint, match_points, surprise};
use super::pose_graph::{Edge, PoseGraph};
use super::split_and_merge::{SplitOptions, segments_of};
use super::{LineSegment, Pose, Scan};
use crate::geometry::Bounds;

/// Mapping parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapperOptions {
    pub split: SplitOptions,
    pub matching: MatchOptions,
    pub fusion: FusionOptions,
    pub odometry: OdometryOptions,
    /// Whether to close loops; without, the path drifts.
    pub closes_loops: bool,
    pub closure: ClosureOptions,
    /// A scan becomes a keyframe once the robot has moved or turned this much since the last one.
    pub keyframe_m: f64,
    pub keyframe_rad: f64,
    /// Scans are matched to the last keyframes, at least this many and at most twice as many, 50 to 100 m
    /// of path: older lines are not yet affected by the drift, and could be mistaken for others.
    pub memory: usize,
    /// A match that explains a smaller share of a scan is rejected.
    pub least_explained: f64,
    /// The initial search distance for lines, in metres; extended up to the matching's first reach if a
    /// match explains less of the scan than `sure`.
    pub near_reach_m: f64,
    pub sure: f64,
    /// A match that explains less is compared with those of a coarse search in the window `lost`.
    pub trusted: f64,
    /// The maximum odometry error between two scans: matches further away only look alike.
    pub lost: Window,
}

impl Default for MapperOptions {
    fn default() -> Self {
        Self {
            split: SplitOptions::default(),
            matching: MatchOptions::default(),
            fusion: FusionOptions::default(),
            odometry: OdometryOptions::default(),
            closes_loops: true,
            closure: ClosureOptions::default(),
            keyframe_m: 0.3,
            keyframe_rad: 0.3,
            memory: 100,
            least_explained: 0.25,
            near_reach_m: 0.2,
            sure: 0.85,
            trusted: 0.7,
            lost: Window { way_m: 0.6, turn_rad: 0.6 },
        }
    }
}

/// The view of the robot's scanners from one place, in the robot's frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    pub segments: Vec<LineSegment>,
    /// The hits on these segments.
    pub points: Vec<SurfacePoint>,
}

impl View {
    pub fn of(scans: &[Scan], options: &SplitOptions) -> Self {
        let mut view = Self::default();
        for scan in scans {
            let mount = scan.robot_from_scanner;
            let (points, segments) = segments_of(scan, options);
            for segment in segments {
                let line = segment.line.moved(mount);
                let along = line.direction();
                view.points
                    .extend(points[segment.hits].iter().map(|point| SurfacePoint { at: mount.apply(*point), along }));
                view.segments.push(line);
            }
        }
        view
    }

    fn bounds_from(&self, pose: Pose) -> Bounds {
        Bounds::of(self.points.iter().map(|point| pose.apply(point.at)))
    }
}

/// A keyframe: a scan that is kept. Its pose is in the pose graph.
#[derive(Clone, Debug, PartialEq)]
struct Keyframe {
    odometry: Pose,
    view: View,
    /// Length of the path so far, in metres.
    path_m: f64,
}

/// The place of a scan relative to the preceding keyframe, so that it moves with that.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Taken {
    keyframe: usize,
    from_keyframe: Pose,
}

/// Builds a map from scans as they arrive. The cost of a scan depends on what is nearby; only closing a
/// loop moves the whole path.
#[derive(Clone, Debug, Default)]
pub struct Mapper {
    options: MapperOptions,
    keyframes: Vec<Keyframe>,
    graph: PoseGraph,
    taken: Vec<Taken>,
    last_odometry: Pose,
    last_motion: Pose,
    calibration: OdometryCalibration,
    /// The lines of the most recent keyframes, to match with; and those of the latest part of them.
    recent: LineMap,
    latest: LineMap,
    in_latest: usize,
    /// Path length at the last closure.
    closed_at_m: f64,
    /// Closures over so much drift that they wait for a second one.
    waiting: Vec<Edge>,
    /// The number of closures since the poses were last optimised, and their total residual, in squared
    /// deviations.
    fresh: usize,
    strain: f64,
}

impl Mapper {
    pub fn new(options: MapperOptions) -> Self {
        Self { calibration: OdometryCalibration::new(options.odometry), options, ..Self::default() }
    }

    /// Processes the scans from one place, and returns the robot's pose there.
    pub fn add(&mut self, odometry: Pose, scans: &[Scan]) -> Pose {
        let view = View::of(scans, &self.options.split);
        let Some(last_pose) = self.pose() else {
            self.last_odometry = odometry;
            self.keep(odometry, Pose::IDENTITY, view, None);
            return Pose::IDENTITY;
        };
        let reported = self.last_odometry.between(odometry);
        // Without odometry the robot most likely continues as before.
        let reported = if self.options.odometry.is_absent { self.last_motion } else { reported };
        let likely = self.calibration.corrected(reported);
        self.last_odometry = odometry;
        let prior = PoseEstimate { pose: last_pose.compose(likely.pose), information: likely.information };
        let found = self.matched(&view, &prior);
        let pose = found.map_or(prior.pose, |found| found.estimate.pose);
        self.last_motion = last_pose.between(pose);
        let keyframe = self.keyframes.len() - 1;
        let since = self.graph.poses[keyframe].between(pose);
        if since.x_m.hypot(since.y_m) >= self.options.keyframe_m || since.heading_rad.abs() >= self.options.keyframe_rad
        {
            let reported = self.keyframes[keyframe].odometry.between(odometry);
            if found.is_some() && !self.options.odometry.is_absent {
                self.calibration.learn(reported, since);
            }
            let lines = found.map_or_else(Matrix3::zeros, |found| found.estimate.information);
            let information = softened(lines + self.calibration.corrected(reported).information);
            self.keep(odometry, pose, view, Some(PoseEstimate { pose: since, information }));
        } else {
            self.taken.push(Taken { keyframe, from_keyframe: since });
        }
        self.pose().unwrap_or(pose)
    }

    /// The current pose.
    pub fn pose(&self) -> Option<Pose> {
        self.taken.last().map(|taken| self.pose_of(taken))
    }

    /// The current best estimates of the poses of all scans.
    pub fn poses(&self) -> Vec<Pose> {
        self.taken.iter().map(|taken| self.pose_of(taken)).collect()
    }

    fn pose_of(&self, taken: &Taken) -> Pose {
        self.graph.poses[taken.keyframe].compose(taken.from_keyframe)
    }

    /// The lines of all keyframes, at the current best estimates of their poses.
    pub fn map(&self) -> LineMap {
        self.map_of(0..self.keyframes.len(), |segment| self.options.split.is_firm(segment))
    }

    /// The number of recognised places, and how many of these contradict the rest of the path.
    pub fn closures(&self) -> (usize, usize) {
        let closures = self.graph.edges.iter().filter(|edge| edge.is_closure);
        let doubted = closures.clone().filter(|edge| self.graph.weight(edge) < 0.1).count();
        (closures.count(), doubted)
    }

    /// Optimises what is left. Call it once, after the last scan.
    pub fn finish(&mut self) {
        if self.fresh > 0 {
            self.optimise();
        }
    }

    fn map_of(&self, keyframes: std::ops::Range<usize>, is_kept: impl Fn(&LineSegment) -> bool) -> LineMap {
        let mut map = LineMap::default();
        for (keyframe, pose) in self.keyframes[keyframes.clone()].iter().zip(&self.graph.poses[keyframes]) {
            for segment in keyframe.view.segments.iter().filter(|segment| is_kept(segment)) {
                map.add(segment.moved(*pose), &self.options.fusion);
            }
        }
        map
    }

    fn matched(&self, view: &View, prior: &PoseEstimate) -> Option<Match> {
        let reach_m = self.options.matching.first_reach_m;
        let bounds = view.bounds_from(prior.pose).inflated(2.0 * reach_m);
        let lines: Vec<LineSegment> = self.recent.near(bounds).iter().map(|line| line.line).collect();
        let reference = Reference::new(&lines, bounds, reach_m);
        let from = |start, options: &MatchOptions| match_points(&reference, &view.points, start, Some(prior), options);
        let matching = self.options.matching;
        // Near the odometry first: with too long a reach, a match is drawn to the wrong one of many door
        // frames.
        let near = MatchOptions { first_reach_m: self.options.near_reach_m, ..matching };
        let mut found: Vec<Match> = from(prior.pose, &near).into_iter().collect();
        let explained = |found: &[Match]| found.iter().map(|found| found.explained).fold(0.0, f64::max);
        if explained(&found) < self.options.sure {
            found.extend(from(prior.pose, &matching));
        }
        if explained(&found) < self.options.trusted {
            let starts = Raster::new(&lines, bounds).search(
                &thinned(&view.points, COARSE_POINTS),
                prior.pose,
                self.options.lost,
                MOST_STARTS,
            );
            found.extend(starts.into_iter().filter_map(|(start, _)| from(start, &matching)));
        }
        let likelihood =
            |found: &Match| found.log_likelihood(view.points.len(), &matching) - surprise(prior, found.estimate.pose);
        found.retain(|found| {
            let off = prior.pose.between(found.estimate.pose);
            off.x_m.hypot(off.y_m) <= self.options.lost.way_m && off.heading_rad.abs() <= self.options.lost.turn_rad
        });
        let best = found.into_iter().max_by(|a, b| likelihood(a).total_cmp(&likelihood(b)));
        best.filter(|found| found.explained > self.options.least_explained)
    }

    /// Keeps a scan as a keyframe; `step` is the motion since the last one.
    fn keep(&mut self, odometry: Pose, pose: Pose, view: View, step: Option<PoseEstimate>) {
        for segment in &view.segments {
            let segment = segment.moved(pose);
            self.recent.add(segment, &self.options.fusion);
            self.latest.add(segment, &self.options.fusion);
        }
        self.in_latest += 1;
        if self.in_latest >= self.options.memory {
            self.recent = std::mem::take(&mut self.latest);
            self.in_latest = 0;
        }
        let id = self.keyframes.len();
        let mut path_m = 0.0;
        if let (Some(step), Some(before)) = (step, self.keyframes.last()) {
            path_m = before.path_m + step.pose.x_m.hypot(step.pose.y_m);
            self.graph.edges.push(Edge { from: id - 1, to: id, measured: step, is_closure: false });
        }
        self.graph.poses.push(pose);
        self.keyframes.push(Keyframe { odometry, view, path_m });
        self.taken.push(Taken { keyframe: id, from_keyframe: Pose::IDENTITY });
        if self.options.closes_loops && id.is_multiple_of(self.options.closure.every.max(1)) {
            self.look_back(id);
        }
    }

    /// Checks whether the current place was seen before.
    fn look_back(&mut self, id: usize) {
        let options = self.options.closure;
        let since_m = self.keyframes[id].path_m - self.closed_at_m;
        let drift = Drift {
            way_m: options.drift_m + options.drift_m_per_m * since_m,
            turn_rad: options.drift_rad + options.drift_rad_per_m * since_m,
        };
        for place in self.places(id, drift) {
            let Some(found) = self.recognised(place, id, drift) else { continue };
            let edge = Edge { from: place, to: id, measured: softened_estimate(found.estimate), is_closure: true };
            if drift.way_m <= options.wide_m {
                self.close(&[edge]);
            } else if let Some(second) = self.waiting.iter().find(|other| self.agree(other, &edge)).copied() {
                self.close(&[second, edge]);
                self.waiting.clear();
            } else {
                self.waiting.push(edge);
            }
        }
        // A path consistent with the closures need not be moved yet.
        if self.strain > MOST_STRAIN {
            self.optimise();
        }
    }

    /// Keyframes of places that may be the current one: nearest first, one per stretch of path.
    fn places(&self, id: usize, drift: Drift) -> Vec<usize> {
        let options = &self.options.closure;
        let here = self.graph.poses[id].position();
        let latest_m = self.keyframes[id].path_m - options.least_path_m - drift.way_m;
        let mut near: Vec<(f64, usize)> = (0..id)
            .filter(|other| self.keyframes[*other].path_m < latest_m)
            .map(|other| (self.graph.poses[other].position(), other))
            .filter(|(position, _)| is_near(*position, here, options, drift))
            .map(|(position, other)| (position.distance(here), other))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut places: Vec<usize> = Vec::new();
        for (_, other) in near {
            if places.iter().all(|place| place.abs_diff(other) > 2 * options.around) {
                places.push(other);
            }
            if places.len() == MOST_PLACES {
                break;
            }
        }
        places
    }

    fn recognised(&self, place: usize, id: usize, drift: Drift) -> Option<Closure> {
        let options = &self.options.closure;
        let origin = self.graph.poses[place].inverse();
        let from = place.saturating_sub(options.around);
        let segments: Vec<LineSegment> = (from..(place + options.around + 1).min(id))
            .flat_map(|other| {
                let pose = origin.compose(self.graph.poses[other]);
                self.keyframes[other].view.segments.iter().map(move |segment| segment.moved(pose))
            })
            .collect();
        let here = self.graph.poses[id].inverse();
        let points: Vec<SurfacePoint> = (id.saturating_sub(options.around / 2)..=id)
            .flat_map(|other| {
                let pose = here.compose(self.graph.poses[other]);
                self.keyframes[other]
                    .view
                    .points
                    .iter()
                    .map(move |point| SurfacePoint { at: pose.apply(point.at), along: pose.rotate(point.along) })
            })
            .collect();
        let guess = origin.compose(self.graph.poses[id]);
        recognise(&segments, &points, guess, drift, options, &self.options.matching, &self.options.fusion)
    }

    /// Whether two closures move the path in the same way.
    fn agree(&self, a: &Edge, b: &Edge) -> bool {
        if self.keyframes[b.to].path_m - self.keyframes[a.to].path_m > AGREEING_WITHIN_M || a.to == b.to {
            return false;
        }
        let poses = &self.graph.poses;
        // Around the loop: to the place of a, along the path there to b's, and back along the path here.
        let there = poses[a.from].between(poses[b.from]);
        let here = poses[a.to].between(poses[b.to]);
        let off = a.measured.pose.compose(here).between(there.compose(b.measured.pose));
        off.x_m.hypot(off.y_m) < AGREEING_M && off.heading_rad.abs() < AGREEING_RAD
    }

    fn close(&mut self, edges: &[Edge]) {
        self.graph.edges.extend(edges);
        self.strain += edges.iter().map(|edge| self.graph.squared_error(edge)).sum::<f64>();
        self.fresh += edges.len();
        if let Some(last) = edges.last() {
            self.closed_at_m = self.keyframes[last.to].path_m;
        }
    }

    fn optimise(&mut self) {
        self.graph.optimise();
        self.fresh = 0;
        self.strain = 0.0;
        let count = self.keyframes.len();
        let latest = count - self.in_latest.min(count);
        self.recent = self.map_of(latest.saturating_sub(self.options.memory)..count, |_| true);
        self.latest = self.map_of(latest..count, |_| true);
    }
}

/// Poses from a coarse search that are examined closely.
const MOST_STARTS: usize = 3;
/// Closures may be off by this much, in squared deviations, before the path is moved: chance alone leaves
/// three for each.
const MOST_STRAIN: f64 = 6.0;
/// Places examined for one keyframe.
const MOST_PLACES: usize = 2;
/// Two wide closures must come within this length of path, and agree this well.
const AGREEING_WITHIN_M: f64 = 10.0;
const AGREEING_M: f64 = 0.4;
const AGREEING_RAD: f64 = 0.08;

/// A measured pose is never better than this, in metres and radians: scanners have systematic errors that
/// do not average out.
const FINEST_M: f64 = 0.01;
const FINEST_RAD: f64 = 0.004;

/// An information matrix with the floor added to its covariance.
fn softened(information: Matrix3<f64>) -> Matrix3<f64> {
    let floor =
        Matrix3::from_diagonal(&Vector3::new(FINEST_M * FINEST_M, FINEST_M * FINEST_M, FINEST_RAD * FINEST_RAD));
    let covariance = information.try_inverse().unwrap_or_else(Matrix3::identity) + floor;
    covariance.try_inverse().unwrap_or_else(Matrix3::identity)
}

fn softened_estimate(estimate: PoseEstimate) -> PoseEstimate {
    PoseEstimate { information: softened(estimate.information), ..estimate }
}
