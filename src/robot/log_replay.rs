//! A laser log replayed one scan at a time: poses, line map and free space after each, as they would have
//! been known to the robot.

use std::sync::Arc;

use super::calibration::OdometryOptions;
use super::carmen::{Log, Reading};
use super::frontiers::{Frontier, frontiers};
use super::log_map::{Surroundings, surroundings_of};
use super::{FreeSpace, Mapper, MapperOptions, Pose, Scan};
use crate::geometry::Segment;

/// Scans are added to the free space after driving this many metres, or turning this far: as a simulated
/// robot does.
const LOOK_M: f64 = 0.4;
const LOOK_RAD: f64 = 0.8;

/// The free space is rebuilt when closing a loop has moved a place by this much, in metres, counting a turn
/// as the movement it causes at the distance of a room's wall.
const MOVED_M: f64 = 0.05;
const LEVER_M: f64 = 3.0;

/// Until the end rooms are found in no more scans than this, evenly spaced: each time takes as long as all
/// their beams.
const MOST_LOOKS: usize = 1_000;

/// What was seen from one place.
#[derive(Clone, Debug)]
struct Look {
    /// The index of its scan among all.
    scan: usize,
    /// The pose used for it in the free space.
    pose: Pose,
    /// The index of its reading in the log.
    reading: usize,
}

/// A log being replayed. The frame is that of the robot at the first scan.
pub struct LogReplay {
    log: Arc<Log>,
    mapper: Mapper,
    /// The next reading.
    next: usize,
    /// The number of scans mapped.
    scans: usize,
    /// The reading mapped last.
    last: Option<usize>,
    /// The odometry's pose at the first scan, in its own frame.
    origin: Pose,
    looks: Vec<Look>,
    closures: usize,
    free: FreeSpace,
    pose: Pose,
    looked_at: Option<Pose>,
    has_new_look: bool,
}

impl LogReplay {
    /// Before the first scan.
    pub fn new(log: Arc<Log>, options: &MapperOptions) -> Self {
        let odometry = if log.has_odometry { options.odometry } else { OdometryOptions::NONE };
        Self {
            log,
            mapper: Mapper::new(MapperOptions { odometry, ..*options }),
            next: 0,
            scans: 0,
            last: None,
            origin: Pose::IDENTITY,
            looks: Vec::new(),
            closures: 0,
            free: FreeSpace::default(),
            pose: Pose::IDENTITY,
            looked_at: None,
            has_new_look: false,
        }
    }

    /// Maps the next reading that has scans. Returns whether there was one.
    pub fn step(&mut self) -> bool {
        self.has_new_look = false;
        let log = self.log.clone();
        let rest = log.readings.iter().enumerate().skip(self.next);
        let Some((at, reading)) = rest.into_iter().find(|(_, reading)| !reading.scans.is_empty()) else {
            if self.next < log.readings.len() {
                self.next = log.readings.len();
                self.mapper.finish();
                self.settle();
            }
            return false;
        };
        if self.last.is_none() {
            self.origin = reading.odometry;
        }
        self.next = at + 1;
        self.pose = self.mapper.add(reading.odometry, &reading.scans);
        self.scans += 1;
        self.last = Some(at);
        let is_due = self.looked_at.is_none_or(|looked_at| {
            let moved = looked_at.between(self.pose);
            moved.x_m.hypot(moved.y_m) >= LOOK_M || moved.heading_rad.abs() >= LOOK_RAD
        });
        if is_due {
            self.free.add(self.pose, &reading.scans);
            self.looks.push(Look { scan: self.scans - 1, pose: self.pose, reading: at });
            if self.mapper.closures().0 != self.closures {
                self.settle();
            }
            self.looked_at = Some(self.pose);
            self.has_new_look = true;
        }
        if self.next == log.readings.len() {
            self.mapper.finish();
            self.settle();
        }
        true
    }

    /// Rebuilds the free space when closing a loop has moved the path.
    fn settle(&mut self) {
        self.closures = self.mapper.closures().0;
        let poses = self.mapper.poses();
        self.pose = poses.last().copied().unwrap_or_default();
        let off_m = |look: &Look| {
            let moved = look.pose.between(poses[look.scan]);
            moved.x_m.hypot(moved.y_m) + LEVER_M * moved.heading_rad.abs()
        };
        if self.looks.iter().map(off_m).fold(0.0, f64::max) < MOVED_M {
            return;
        }
        for look in &mut self.looks {
            look.pose = poses[look.scan];
        }
        let seen = self.looks.iter().map(|look| (look.pose, self.log.readings[look.reading].scans.as_slice()));
        self.free = FreeSpace::of(seen);
        self.has_new_look = true;
    }

    /// Whether every reading has been mapped.
    pub fn is_over(&self) -> bool {
        self.next >= self.log.readings.len()
    }

    /// How many readings are done, and how many there are.
    pub fn progress(&self) -> (usize, usize) {
        (self.next, self.log.readings.len())
    }

    /// The reading mapped last.
    pub fn reading(&self) -> Option<&Reading> {
        self.log.readings.get(self.last?)
    }

    /// The last scans.
    pub fn scans(&self) -> &[Scan] {
        self.reading().map_or(&[], |reading| reading.scans.as_slice())
    }

    /// The robot's estimated pose.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// The pose by odometry alone.
    pub fn odometry(&self) -> Pose {
        self.reading().map_or(Pose::IDENTITY, |reading| self.origin.between(reading.odometry))
    }

    /// Whether the last step added to the free space.
    pub fn has_new_look(&self) -> bool {
        self.has_new_look
    }

    pub fn free(&self) -> &FreeSpace {
        &self.free
    }

    /// Where the known floor ends without an obstacle.
    pub fn frontiers(&self) -> Vec<Frontier> {
        frontiers(&self.free)
    }

    /// The segments of the line map so far.
    pub fn segments(&self) -> Vec<Segment> {
        self.mapper.map().lines().map(|line| line.line.segment()).collect()
    }

    /// The rooms, and what else is known of the surroundings: at the end as
    /// [`surroundings`](super::log_map::surroundings) finds them, before from a thousand scans at most.
    pub fn surroundings(&self) -> Surroundings {
        let every = if self.is_over() { 1 } else { self.scans.div_ceil(MOST_LOOKS).max(1) };
        let poses = self.mapper.poses();
        let readings = self.log.readings[..self.next].iter().filter(|reading| !reading.scans.is_empty());
        let looks = readings.zip(&poses).step_by(every).map(|(reading, pose)| (*pose, reading.scans.as_slice()));
        surroundings_of(looks, self.segments().into_iter())
    }

    /// The current best estimates of the poses of all scans.
    pub fn poses(&self) -> Vec<Pose> {
        self.mapper.poses()
    }

    /// The number of places recognised so far.
    pub fn closures(&self) -> usize {
        self.closures
    }
}

#[cfg(test)]
mod tests {
    use super::super::log_map::{map_log, surroundings};
    use super::super::scanner::back_to_back;
    use super::super::{Exploration, RobotOptions, Scanner, World, WorldOptions};
    use super::*;
    use crate::base::work::Work;
    use crate::geometry::areas;

    /// The log of an exploration, made in memory.
    fn log() -> (Exploration, Log) {
        let (_, plan) = crate::store::bundled_plans().unwrap().into_iter().next().unwrap();
        let world = Arc::new(World::new(&plan, &WorldOptions::default()));
        let start = world.start(0.3, 1).unwrap();
        let scanner = |mount| Scanner { step_rad: 2_f64.to_radians(), ..Scanner::lms200(mount) };
        let options = RobotOptions { scanners: back_to_back(scanner).to_vec(), ..RobotOptions::default() };
        let mut exploration = Exploration::new(world, Pose::new(start.x, start.y, 0.0), options);
        let mut readings = Vec::new();
        for time in 0..40 {
            let scans = exploration.scans.clone();
            readings.push(Reading { time_s: f64::from(time), odometry: exploration.odometry, scans });
            exploration.step();
        }
        (exploration, Log { readings, has_odometry: true, notes: Vec::new() })
    }

    #[test]
    fn step_by_step_it_is_the_map_of_the_whole_log() {
        let (_, log) = log();
        let mapped = map_log(&log, &MapperOptions::default(), &Work::quiet()).unwrap();
        let mut replay = LogReplay::new(Arc::new(log.clone()), &MapperOptions::default());
        let mut known_m2 = 0.0;
        while replay.step() {
            assert!(areas::area_m2(replay.free().shapes()) >= known_m2 - 0.1);
            known_m2 = areas::area_m2(replay.free().shapes());
        }
        assert!(replay.is_over() && !replay.step());
        assert_eq!(replay.poses(), mapped.poses);
        let lines: Vec<Segment> = mapped.map.lines().map(|line| line.line.segment()).collect();
        assert_eq!(replay.segments(), lines);
        assert_eq!(replay.surroundings().found, surroundings(&log, &mapped).found);
        assert!(!replay.surroundings().found.rooms.is_empty());
        assert!(known_m2 > 10.0, "{known_m2} m² are known");
    }

    #[test]
    fn a_log_without_scans_is_over_at_once() {
        let mut replay = LogReplay::new(Arc::new(Log::default()), &MapperOptions::default());
        assert!(!replay.step() && replay.is_over() && replay.scans().is_empty() && replay.free().shapes().is_empty());
    }
}
