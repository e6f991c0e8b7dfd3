//! The simulated laser scanner.

use super::{Pose, Scan, World};
use crate::base::random::Random;
use crate::geometry::Vector;

/// A simulated laser scanner's characteristics.
#[derive(Clone, Debug, PartialEq)]
pub struct Scanner {
    /// Angle between the first beam and the last.
    pub field_rad: f64,
    /// From one beam to the next.
    pub step_rad: f64,
    /// Anything further away, in metres, gives no return.
    pub max_range_m: f64,
    /// Resolution of the readings in metres; 0 for exact ones.
    pub range_step_m: f64,
    /// Standard deviation in metres of a reading perpendicular to a wall.
    pub noise_m: f64,
    /// Probability of a lost reading.
    pub drop_out: f64,
    /// Walls met at a smaller angle than this give no return.
    pub glancing_rad: f64,
    /// The pose of the scanner on the robot.
    pub robot_from_scanner: Pose,
}

impl Scanner {
    /// A SICK LMS 200 in its centimetre mode.
    ///
    /// Field of 180 degrees in steps of 0.5, resolution of 10 mm, statistical error of 5 mm (one standard
    /// deviation, typical at up to 8 m): SICK, LMS 200/211/221/291 Technical Description (8008970, 2006),
    /// section 'Technical data'. Range of 20 m: as in USARSim's SickLMS, which the paper used; the device
    /// sees 10 m at 10 % reflectivity and up to 80 m. The share of lost readings, 0.1 %, and the angle
    /// below which walls are not seen, 2 degrees, are our choice.
    pub fn lms200(robot_from_scanner: Pose) -> Self {
        Self {
            field_rad: 180.0_f64.to_radians(),
            step_rad: 0.5_f64.to_radians(),
            max_range_m: 20.0,
            range_step_m: 0.01,
            noise_m: 0.005,
            drop_out: 0.001,
            glancing_rad: 2.0_f64.to_radians(),
            robot_from_scanner,
        }
    }

    /// The same without errors: each reading is the exact distance.
    #[must_use]
    pub fn exact(self) -> Self {
        Self { range_step_m: 0.0, noise_m: 0.0, drop_out: 0.0, glancing_rad: 0.0, ..self }
    }

    /// Number of beams in a sweep.
    pub fn beams(&self) -> usize {
        if self.step_rad > 0.0 {
            (self.field_rad / self.step_rad).round().clamp(0.0, 100_000.0) as usize + 1
        } else {
            1
        }
    }

    /// One sweep in the world by a stationary robot.
    pub fn scan(&self, world: &World, world_from_robot: Pose, random: &mut Random) -> Scan {
        let world_from_scanner = world_from_robot.compose(self.robot_from_scanner);
        let (origin, beams) = (world_from_scanner.position(), self.beams());
        let start_rad = -self.field_rad / 2.0;
        let mut direction = Vector::new(1.0, 0.0).rotated(world_from_scanner.heading_rad + start_rad);
        let (sin, cos) = self.step_rad.sin_cos();
        let glancing = self.glancing_rad.sin();
        let mut ranges_m = Vec::with_capacity(beams);
        for _ in 0..beams {
            let is_lost = self.drop_out > 0.0 && random.unit() < self.drop_out;
            let hit = world.obstacles().cast(origin, direction, self.max_range_m).filter(|_| !is_lost);
            let hit = hit.filter(|hit| {
                let along = world.obstacles().segments()[hit.segment].vector();
                glancing <= 0.0 || along.cross(direction).abs() >= glancing * along.length()
            });
            let noise_m = if self.noise_m > 0.0 { self.noise_m * random.normal() } else { 0.0 };
            ranges_m.push(hit.map_or(self.max_range_m, |hit| self.reading_m(hit.distance_m + noise_m)));
            direction = Vector::new(direction.x * cos - direction.y * sin, direction.x * sin + direction.y * cos);
        }
        Scan {
            ranges_m,
            start_rad,
            step_rad: self.step_rad,
            max_range_m: self.max_range_m,
            robot_from_scanner: self.robot_from_scanner,
        }
    }

    /// A distance as the scanner reports it.
    fn reading_m(&self, distance_m: f64) -> f64 {
        let stepped = if self.range_step_m > 0.0 {
            (distance_m / self.range_step_m).round() * self.range_step_m
        } else {
            distance_m
        };
        // Never 0, which would mean no return.
        stepped.max(0.001)
    }
}

/// Two scanners back to back, in front of and behind the robot's middle, that together see all around.
pub fn back_to_back(scanner: impl Fn(Pose) -> Scanner) -> [Scanner; 2] {
    [scanner(Pose::new(SCANNER_AHEAD_M, 0.0, 0.0)), scanner(Pose::new(-SCANNER_AHEAD_M, 0.0, std::f64::consts::PI))]
}

/// Distance of the scanner's mirror ahead of the robot's middle, in metres: half of what two LMS 200
/// (0.156 m deep, SICK's drawing) need back to back, rounded up.
const SCANNER_AHEAD_M: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Segment};

    fn box_world() -> World {
        let corners = [(-3.0, -2.0), (5.0, -2.0), (5.0, 2.0), (-3.0, 2.0)].map(|(x, y)| Point::new(x, y));
        World::of_obstacles((0..4).map(|i| Segment::new(corners[i], corners[(i + 1) % 4])).collect())
    }

    #[test]
    fn an_exact_scan_lies_on_the_walls() {
        let scanners = back_to_back(Scanner::lms200).map(Scanner::exact);
        let pose = Pose::new(0.5, 0.3, 0.4);
        for scanner in scanners {
            let scan = scanner.scan(&box_world(), pose, &mut Random::new(1));
            assert_eq!(scan.points().count(), 361);
            for (_, point) in scan.points() {
                let at = pose.compose(scanner.robot_from_scanner).apply(point);
                let aside = [(at.x + 3.0).abs(), (at.x - 5.0).abs(), (at.y + 2.0).abs(), (at.y - 2.0).abs()];
                assert!(aside.into_iter().fold(f64::INFINITY, f64::min) < 1e-9, "{at:?}");
            }
        }
    }

    #[test]
    fn noise_and_lost_readings_are_as_stated() {
        let exact = Scanner::lms200(Pose::IDENTITY).exact();
        let noisy = Scanner { noise_m: 0.02, drop_out: 0.05, ..exact.clone() };
        let world = box_world();
        let truth = exact.scan(&world, Pose::IDENTITY, &mut Random::new(1));
        let (mut lost, mut squares, mut seen) = (0.0, 0.0, 0.0);
        let mut random = Random::new(2);
        for _ in 0..50 {
            let scan = noisy.scan(&world, Pose::IDENTITY, &mut random);
            for beam in 0..scan.ranges_m.len() {
                match (scan.range_m(beam), truth.range_m(beam)) {
                    (Some(range_m), Some(true_m)) => {
                        squares += (range_m - true_m).powi(2);
                        seen += 1.0;
                    }
                    _ => lost += 1.0,
                }
            }
        }
        assert!((f64::sqrt(squares / seen) - 0.02).abs() < 0.001);
        assert!((lost / (lost + seen) - 0.05_f64).abs() < 0.01);
    }
}
