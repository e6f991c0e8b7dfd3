//! A differential drive with drifting odometry.

use super::Pose;
use super::pose::wrapped_rad;
use crate::base::random::Random;

/// Odometry noise: the standard motion model of Thrun, Burgard and Fox (Probabilistic Robotics, 2005,
/// table 5.6), in which every small motion is a turn, a straight drive and a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryNoise {
    /// Turn variance per squared turn.
    pub alpha_1: f64,
    /// Turn variance per squared distance, rad² per m².
    pub alpha_2: f64,
    /// Distance variance per squared distance.
    pub alpha_3: f64,
    /// Distance variance per squared turns, m² per rad².
    pub alpha_4: f64,
}

impl OdometryNoise {
    pub const NONE: Self = Self { alpha_1: 0.0, alpha_2: 0.0, alpha_3: 0.0, alpha_4: 0.0 };

    /// The model with standard deviations scaled: 0 for no noise, 1 for the default.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let squared = factor * factor;
        Self {
            alpha_1: self.alpha_1 * squared,
            alpha_2: self.alpha_2 * squared,
            alpha_3: self.alpha_3 * squared,
            alpha_4: self.alpha_4 * squared,
        }
    }

    /// A sample of the true motion when the odometry reports `odometry`, both relative to the previous
    /// pose.
    pub fn sample(&self, odometry: Pose, random: &mut Random) -> Pose {
        let drive_m = odometry.x_m.hypot(odometry.y_m);
        // A turn on the spot has no driving direction.
        let first_rad = if drive_m < 1e-6 { 0.0 } else { odometry.y_m.atan2(odometry.x_m) };
        let second_rad = wrapped_rad(odometry.heading_rad - first_rad);
        // Reversing is not a turn by half a circle (the model's known flaw).
        let turn = |angle_rad: f64| angle_rad.abs().min((std::f64::consts::PI - angle_rad.abs()).abs());
        let (first, second) = (turn(first_rad).powi(2), turn(second_rad).powi(2));
        let of_turn = |turn_squared: f64| (self.alpha_1 * turn_squared + self.alpha_2 * drive_m * drive_m).sqrt();
        let of_drive = (self.alpha_3 * drive_m * drive_m + self.alpha_4 * (first + second)).sqrt();
        let mut error = |deviation: f64| if deviation > 0.0 { deviation * random.normal() } else { 0.0 };
        let first_rad = first_rad - error(of_turn(first));
        let drive_m = drive_m - error(of_drive);
        let second_rad = second_rad - error(of_turn(second));
        Pose::new(drive_m * first_rad.cos(), drive_m * first_rad.sin(), first_rad + second_rad)
    }
}

impl Default for OdometryNoise {
    /// Typical of skid-steered robots indoors: a standard deviation of 10 % of a small turn, 5 % of a
    /// small drive, and 3 degrees per metre. Errors over the many steps of a path mostly cancel: 100 m in
    /// steps of 0.1 m drift by 0.16 m along and by 13 degrees in heading.
    fn default() -> Self {
        Self { alpha_1: 0.01, alpha_2: 0.0025, alpha_3: 0.0025, alpha_4: 0.0001 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_noise_the_robot_does_what_it_reads() {
        let mut random = Random::new(1);
        for odometry in [Pose::IDENTITY, Pose::new(0.1, 0.02, 0.3), Pose::new(-0.2, 0.0, 0.0), Pose::new(0.0, 0.0, 1.0)]
        {
            let done = OdometryNoise::NONE.sample(odometry, &mut random);
            assert!(done.position().distance(odometry.position()) < 1e-12);
            assert!(wrapped_rad(done.heading_rad - odometry.heading_rad).abs() < 1e-12);
        }
    }

    #[test]
    fn the_deviation_is_that_of_the_model() {
        let noise = OdometryNoise { alpha_1: 0.0, alpha_2: 0.0, alpha_3: 0.04, alpha_4: 0.0 };
        let mut random = Random::new(3);
        let drives: Vec<f64> = (0..20_000).map(|_| noise.sample(Pose::new(0.5, 0.0, 0.0), &mut random).x_m).collect();
        let mean = drives.iter().sum::<f64>() / drives.len() as f64;
        let deviation = (drives.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / drives.len() as f64).sqrt();
        assert!((mean - 0.5).abs() < 0.003 && (deviation - 0.1).abs() < 0.003, "{mean} {deviation}");
    }
}
