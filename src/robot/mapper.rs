//! From scans with odometry to poses and a line map, one scan at a time.


use super::calibration::{OdometryCalibration, OdometryOptions};
use super::line_map::{FusionOptions, LineMap};
use super::matching::{Match, MatchOptions, PoseEstimate, Reference, SurfacePoint, match_points};
use super::split_and_merge::{SplitOptions, segments_of};
use super::{LineSegment, Pose, Scan};
use crate::geometry::{Bounds};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapperOptions {
    pub split: SplitOptions,
    pub matching: MatchOptions,
    pub fusion: FusionOptions,
    pub odometry: OdometryOptions,
    pub keyframe_m: f64,
    pub keyframe_rad: f64,
    pub memory: usize,
}

impl Default for MapperOptions {
    fn default() -> Self {
        Self {
            split: SplitOptions::default(),
            matching: MatchOptions::default(),
            fusion: FusionOptions::default(),
            odometry: OdometryOptions::default(),
            keyframe_m: 0.3,
            keyframe_rad: 0.3,
            memory: 40,
        }
    }
}

/// What a scan shows, in the robot's frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct View {
    pub segments: Vec<LineSegment>,
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

#[derive(Clone, Debug)]
pub struct Keyframe {
    pub odometry: Pose,
    pub pose: Pose,
    pub view: View,
}

#[derive(Clone, Debug, Default)]
pub struct Mapper {
    options: MapperOptions,
    pub keyframes: Vec<Keyframe>,
    last: Option<(Pose, Pose)>,
    pub current: LineMap,
    next: LineMap,
    in_next: usize,
    pub calibration: OdometryCalibration,
    pub stats: (f64, f64, usize, usize),
}

impl Mapper {
    pub fn new(options: MapperOptions) -> Self {
        Self { calibration: OdometryCalibration::new(options.odometry), options, ..Self::default() }
    }

    pub fn add(&mut self, odometry: Pose, scans: &[Scan]) -> Pose {
        let view = View::of(scans, &self.options.split);
        let Some((last_odometry, last_pose)) = self.last else {
            self.last = Some((odometry, Pose::IDENTITY));
            self.keep(odometry, Pose::IDENTITY, view);
            return Pose::IDENTITY;
        };
        let Some(from) = self.keyframes.last() else { return last_pose };
        let motion = from.odometry.between(odometry);
        let from_pose = from.pose;
        let likely = self.calibration.corrected(last_odometry.between(odometry));
        let guess = last_pose.compose(likely.pose);
        let prior = PoseEstimate { pose: guess, information: likely.information };
        let found = self.matched(&view, &prior);
        let pose = found.map_or(guess, |found| found.estimate.pose);
        if let Some(found) = found {
            self.stats.0 += found.explained;
            self.stats.1 += found.residual_m;
            self.stats.2 += 1;
        } else {
            self.stats.3 += 1;
        }
        self.last = Some((odometry, pose));
        let since = self.keyframes.last().map_or(Pose::IDENTITY, |keyframe| keyframe.pose.between(pose));
        if since.x_m.hypot(since.y_m) >= self.options.keyframe_m || since.heading_rad.abs() >= self.options.keyframe_rad
        {
            if found.is_some() { self.calibration.learn(motion, from_pose.between(pose)); }
            self.keep(odometry, pose, view);
        }
        pose
    }

    fn matched(&self, view: &View, prior: &PoseEstimate) -> Option<Match> {
        let reach_m = self.options.matching.first_reach_m;
        let bounds = view.bounds_from(prior.pose).inflated(2.0 * reach_m);
        let near = self.current.near(bounds);
        let reference = Reference::new(near.iter().map(|line| &line.line), bounds, reach_m);
        let found = match_points(&reference, &view.points, prior.pose, Some(prior), &self.options.matching)?;
        (found.explained > 0.25).then_some(found)
    }

    fn keep(&mut self, odometry: Pose, pose: Pose, view: View) {
        for segment in &view.segments {
            let segment = segment.moved(pose);
            self.current.add(segment, &self.options.fusion);
            self.next.add(segment, &self.options.fusion);
        }
        self.keyframes.push(Keyframe { odometry, pose, view });
        self.in_next += 1;
        if self.in_next >= self.options.memory {
            self.current = std::mem::take(&mut self.next);
            self.in_next = 0;
        }
    }
}

