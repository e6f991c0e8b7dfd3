//! Something that drives, step by step: a simulated robot, or a log.

use crate::geometry::areas::Shapes;
use crate::geometry::{Point, Segment};
use crate::robot::explore::Activity;
use crate::robot::frontiers::Frontier;
use crate::robot::log_map::Surroundings;
use crate::robot::log_replay::LogReplay;
use crate::robot::rooms::RoomOptions;
use crate::robot::{Exploration, Pose, Scan};

/// How fast a robot drives and turns, in m/s and rad/s: with these a step of 0.2 m or of 20 degrees takes the
/// half second between two of its scans.
const DRIVES_M_PER_S: f64 = 0.4;
const TURNS_RAD_PER_S: f64 = 0.7;

/// Two scans of a log further apart than this, in seconds, are shown as if they were so far apart: the robot stood
/// still, or the recorder did.
const LONGEST_S: f64 = 2.0;

/// Something that drives.
pub(super) trait Vehicle: Send {
    /// One step. Returns how long it took, in seconds; `None` at the end.
    fn step(&mut self) -> Option<f64>;
    fn is_over(&self) -> bool;
    fn has_new_look(&self) -> bool;
    /// In the map's frame, as is all else.
    fn pose(&self) -> Pose;
    /// In the plan's frame.
    fn true_pose(&self) -> Option<Pose>;
    fn odometry(&self) -> Pose;
    fn scans(&self) -> &[Scan];
    fn way(&self) -> &[Point];
    fn free(&self) -> &Shapes;
    fn frontiers(&self) -> Vec<Frontier>;
    fn segments(&self) -> Vec<Segment>;
    /// The rooms, and what else is known of the surroundings.
    fn surroundings(&self, seed: u64) -> Surroundings;
    fn poses(&self) -> Vec<Pose>;
    fn closures(&self) -> usize;
    fn progress(&self) -> Option<(usize, usize)>;
    fn gave_up(&self) -> bool;
}

impl Vehicle for Exploration {
    fn step(&mut self) -> Option<f64> {
        if Exploration::is_over(self) {
            return None;
        }
        let before = self.path.len();
        let pose = self.pose;
        Exploration::step(self);
        if self.path.len() == before {
            return Some(0.0);
        }
        let moved = pose.between(self.pose);
        let drive_s = moved.x_m.hypot(moved.y_m) / DRIVES_M_PER_S;
        Some(drive_s.max(moved.heading_rad.abs() / TURNS_RAD_PER_S))
    }

    fn is_over(&self) -> bool {
        Exploration::is_over(self)
    }

    fn has_new_look(&self) -> bool {
        Exploration::has_new_look(self)
    }

    fn pose(&self) -> Pose {
        self.pose
    }

    fn true_pose(&self) -> Option<Pose> {
        Some(self.true_pose)
    }

    fn odometry(&self) -> Pose {
        self.odometry
    }

    fn scans(&self) -> &[Scan] {
        &self.scans
    }

    fn way(&self) -> &[Point] {
        self.goal.as_ref().map_or(&[], |goal| goal.way.as_slice())
    }

    fn free(&self) -> &Shapes {
        self.free.shapes()
    }

    fn frontiers(&self) -> Vec<Frontier> {
        Exploration::frontiers(self)
    }

    fn segments(&self) -> Vec<Segment> {
        Exploration::segments(self)
    }

    fn surroundings(&self, seed: u64) -> Surroundings {
        let segments = Exploration::segments(self);
        let options = RoomOptions { seed, ..RoomOptions::default() };
        // As `enfilade explore` finds them.
        let found = Exploration::rooms(self, &options);
        Surroundings { free: self.free.clone(), frontiers: Exploration::frontiers(self), found, segments }
    }

    fn poses(&self) -> Vec<Pose> {
        Exploration::poses(self)
    }

    fn closures(&self) -> usize {
        Exploration::closures(self)
    }

    fn progress(&self) -> Option<(usize, usize)> {
        None
    }

    fn gave_up(&self) -> bool {
        self.activity == Activity::GaveUp
    }
}

/// A log, with the time of the scan before.
pub(super) struct LogVehicle {
    pub replay: LogReplay,
    pub time_s: Option<f64>,
}

impl Vehicle for LogVehicle {
    fn step(&mut self) -> Option<f64> {
        if !self.replay.step() {
            return None;
        }
        let time_s = self.replay.reading()?.time_s;
        let before_s = self.time_s.replace(time_s).unwrap_or(time_s);
        // The clock of a log may jump, and run back.
        Some((time_s - before_s).clamp(0.0, LONGEST_S))
    }

    fn is_over(&self) -> bool {
        self.replay.is_over()
    }

    fn has_new_look(&self) -> bool {
        self.replay.has_new_look()
    }

    fn pose(&self) -> Pose {
        self.replay.pose()
    }

    fn true_pose(&self) -> Option<Pose> {
        None
    }

    fn odometry(&self) -> Pose {
        self.replay.odometry()
    }

    fn scans(&self) -> &[Scan] {
        self.replay.scans()
    }

    fn way(&self) -> &[Point] {
        &[]
    }

    fn free(&self) -> &Shapes {
        self.replay.free().shapes()
    }

    fn frontiers(&self) -> Vec<Frontier> {
        self.replay.frontiers()
    }

    fn segments(&self) -> Vec<Segment> {
        self.replay.segments()
    }

    fn surroundings(&self, _seed: u64) -> Surroundings {
        self.replay.surroundings()
    }

    fn poses(&self) -> Vec<Pose> {
        self.replay.poses()
    }

    fn closures(&self) -> usize {
        self.replay.closures()
    }

    fn progress(&self) -> Option<(usize, usize)> {
        Some(self.replay.progress())
    }

    fn gave_up(&self) -> bool {
        false
    }
}
