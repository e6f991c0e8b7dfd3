//! Replaying a log: the map, and the robot's pose at each reading.

use std::collections::BTreeMap;

use super::bridges::without_bridges;
use super::calibration::OdometryOptions;
use super::carmen::Log;
use super::doorways::DoorwayOptions;
use super::frontiers::{Frontier, frontiers};
use super::grid_map::Cell;
use super::grid_rooms::log_rooms;
use super::mapper::{Mapper, MapperOptions};
use super::occupancy::grid_map;
use super::rooms::FoundRooms;
use super::{FreeSpace, LineMap, Pose, Scan};
use crate::base::work::{Cancelled, Work};
use crate::geometry::{Point, Segment};

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

/// What is known of the robot's surroundings after a log, in the map's frame.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    pub free: FreeSpace,
    pub frontiers: Vec<Frontier>,
    /// By the second method: the segmentation of the grid map of all scans.
    pub found: FoundRooms,
    /// The segments of the line map beside free space: the others were seen behind glass, in mirrors, or
    /// once by mistake.
    pub segments: Vec<Segment>,
}

/// The free space, frontiers and rooms of a mapped log.
pub fn surroundings(log: &Log, mapped: &MappedLog) -> Surroundings {
    let looks = log.readings.iter().zip(&mapped.poses).filter(|(reading, _)| !reading.scans.is_empty());
    let looks = looks.map(|(reading, pose)| (*pose, reading.scans.as_slice()));
    surroundings_of(looks, mapped.map.lines().map(|line| line.line.segment()))
}

/// The same of scans, each with the robot's pose, and the segments of their line map.
pub fn surroundings_of<'a>(
    looks: impl Iterator<Item = (Pose, &'a [Scan])> + Clone,
    segments: impl Iterator<Item = Segment>,
) -> Surroundings {
    let Some(map) = grid_map(looks.clone()) else { return Surroundings::default() };
    let reach = (BESIDE_FREE_M / map.resolution_m).ceil() as i64;
    let is_free_near = |point: Point| {
        let (x, y) = map.picture_from_map(point);
        let (x, y) = (x.floor() as i64, y.floor() as i64);
        let (width, height) = (map.width() as i64, map.height() as i64);
        (y - reach..=y + reach).filter(|y| (0..height).contains(y)).any(|y| {
            let row = (x - reach).clamp(0, width)..(x + reach + 1).clamp(0, width);
            map.cells()[(y * width + row.start) as usize..(y * width + row.end) as usize].contains(&Cell::Free)
        })
    };
    let is_beside_free = |segment: &Segment| {
        let count = (segment.length() / BESIDE_FREE_M).ceil().clamp(1.0, 1_000.0) as usize;
        let near = (0..count).filter(|&i| is_free_near(segment.a.lerp(segment.b, (i as f64 + 0.5) / count as f64)));
        2 * near.count() >= count
    };
    let segments: Vec<Segment> = segments.filter(is_beside_free).collect();
    let free = FreeSpace::of_grid(&map);
    let segments = without_bridges(&segments, &super::rooms::boundary(free.shapes()), |at| free.is_hit_near(at));
    let long: Vec<Segment> =
        segments.iter().copied().filter(|segment| segment.length() >= DoorwayOptions::PAPER.shortest_m).collect();
    let places: Vec<Point> = looks.map(|(pose, _)| pose.position()).collect();
    let found = log_rooms(&map, &places, &long);
    let frontiers = frontiers(&free);
    Surroundings { free, frontiers, found, segments }
}

/// A segment is beside free space if half of it has some within this distance in metres.
const BESIDE_FREE_M: f64 = 0.2;

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
