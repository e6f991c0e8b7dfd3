//! Replaying a log: the map, and the robot's pose at each reading.

use std::collections::BTreeMap;

use super::calibration::OdometryOptions;
use super::carmen::Log;
use super::mapper::{Mapper, MapperOptions};
use super::{LineMap, Pose};
use crate::base::work::{Cancelled, Work};

/// The result of mapping a log.
#[derive(Clone, Debug, Default)]
pub struct MappedLog {
    pub map: LineMap,
    /// The pose at each reading of the log, in the frame of the first scan.
    pub poses: Vec<Pose>,
    /// The number of places recognised, and how many of these contradict the path.
    pub closures: (usize, usize),
}

/// Maps a log.
///
/// # Errors
/// When cancelled.
pub fn map_log(log: &Log, options: &MapperOptions, work: &Work<'_>) -> Result<MappedLog, Cancelled> {
    let odometry = if log.has_odometry { options.odometry } else { OdometryOptions::NONE };
    let mut mapper = Mapper::new(MapperOptions { odometry, ..*options });
    let mut looks = Vec::new();
    for (at, reading) in log.readings.iter().enumerate() {
        work.step(at, log.readings.len())?;
        if !reading.scans.is_empty() {
            mapper.add(reading.odometry, &reading.scans);
            looks.push(at);
        }
    }
    mapper.finish();
    let at_looks: BTreeMap<usize, Pose> = looks.into_iter().zip(mapper.poses()).collect();
    let reported: Vec<Pose> = log.readings.iter().map(|reading| reading.odometry).collect();
    Ok(MappedLog { map: mapper.map(), poses: poses_along(&reported, &at_looks), closures: mapper.closures() })
}

/// Poses of all odometry readings: between two scans they follow the odometry, with the residual spread
/// in proportion to the distance. `scans` maps the index of each scan among the readings, ascending, to
/// its pose.
fn poses_along(odometry: &[Pose], scans: &BTreeMap<usize, Pose>) -> Vec<Pose> {
    let Some((first, first_pose)) = scans.first_key_value() else { return Vec::new() };
    let mut poses: Vec<Pose> =
        odometry[..*first].iter().map(|reading| first_pose.compose(odometry[*first].between(*reading))).collect();
    let mut before = (*first, *first_pose);
    poses.push(*first_pose);
    for (at, pose) in scans.iter().skip(1) {
        let (from, from_pose) = before;
        let effort = |i: usize| {
            let step = odometry[i - 1].between(odometry[i]);
            // A turn of one radian counts like driving 0.3 m, about a robot's radius.
            step.x_m.hypot(step.y_m) + 0.3 * step.heading_rad.abs()
        };
        let total: f64 = (from + 1..=*at).map(effort).sum();
        let left = from_pose.compose(odometry[from].between(odometry[*at])).between(*pose);
        let mut done = 0.0;
        for i in from + 1..*at {
            done += effort(i);
            let share = if total > 0.0 { done / total } else { 0.0 };
            let part = Pose::new(left.x_m * share, left.y_m * share, left.heading_rad * share);
            poses.push(from_pose.compose(odometry[from].between(odometry[i])).compose(part));
        }
        poses.push(*pose);
        before = (*at, *pose);
    }
    let (from, from_pose) = before;
    poses.extend(odometry[from + 1..].iter().map(|reading| from_pose.compose(odometry[from].between(*reading))));
    poses
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_odometry_missed_is_spread_along_the_way() {
        let odometry: Vec<Pose> = [-1.0, 0.0, 0.0, 1.0, 2.0, 3.0].map(|x| Pose::new(x, 0.0, 0.0)).to_vec();
        // Twice as far as the odometry says between the scans at readings 1 and 4.
        let scans = BTreeMap::from([(1, Pose::new(5.0, 5.0, 0.0)), (4, Pose::new(9.0, 5.0, 0.0))]);
        let places: Vec<f64> = poses_along(&odometry, &scans).iter().map(|pose| pose.x_m).collect();
        assert_eq!(places, [4.0, 5.0, 5.0, 7.0, 9.0, 10.0]);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        let mapped = map_log(&Log::default(), &MapperOptions::default(), &Work::quiet()).unwrap();
        assert!(mapped.poses.is_empty() && mapped.map.is_empty());
    }
}
