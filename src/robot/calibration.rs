//! Online odometry calibration: unequal wheels bend a straight drive, and a scanner ahead of the axle
//! swings sideways in a turn.

use nalgebra::{Matrix3, Vector3};

use super::Pose;
use super::matching::PoseEstimate;

/// The systematic error of the odometry, learned by a Kalman filter from motions corrected by scan
/// matching (the idea of Roy and Thrun 1999, here linear in all three components), and the random rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryCalibration {
    /// True motion (ahead, left, turn) = this times the motion reported by the odometry.
    gain: Matrix3<f64>,
    /// Covariance of each row of the gain: ahead, left, turn.
    doubt: [Matrix3<f64>; 3],
    options: OdometryOptions,
}

/// How far to trust odometry, per metre and radian: the standard deviation of a motion is the sum of the
/// parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryOptions {
    pub base_m: f64,
    pub m_per_m: f64,
    pub m_per_rad: f64,
    pub base_rad: f64,
    pub rad_per_m: f64,
    pub rad_per_rad: f64,
    /// Deviation of the systematic part before anything is learned.
    pub gain: f64,
    /// Deviation of the scanner's mounting position, which few logs state, in metres: each radian of a
    /// turn moves the scanner by this much.
    pub mount_m: f64,
    /// There is no odometry: nothing is learned, and the last motion is assumed to continue.
    pub is_absent: bool,
}

impl OdometryOptions {
    /// For a robot without odometry: it may move by a step or two between scans.
    pub const NONE: Self = Self {
        base_m: 0.2,
        m_per_m: 0.3,
        m_per_rad: 0.0,
        base_rad: 0.2,
        rad_per_m: 0.0,
        rad_per_rad: 0.3,
        gain: 0.0,
        mount_m: 0.0,
        is_absent: true,
    };
}

impl Default for OdometryOptions {
    /// Measured on logs of Pioneers and B21s: random errors of a few centimetres and degrees per metre,
    /// and systematic ones of the same size.
    fn default() -> Self {
        Self {
            base_m: 0.01,
            m_per_m: 0.06,
            m_per_rad: 0.04,
            base_rad: 0.01,
            rad_per_m: 0.05,
            rad_per_rad: 0.06,
            gain: 0.07,
            mount_m: 0.3,
            is_absent: false,
        }
    }
}

/// Motions corrected by scan matching by more than this many deviations are not learned from: a wheel
/// slipped, or the match is wrong.
const MOST_DEVIATIONS: f64 = 4.0;

impl Default for OdometryCalibration {
    fn default() -> Self {
        Self::new(OdometryOptions::default())
    }
}

impl OdometryCalibration {
    pub fn new(options: OdometryOptions) -> Self {
        let variance = Vector3::new(options.gain, options.gain, options.gain).map(|deviation| deviation * deviation);
        let place = Vector3::new(variance.x, variance.y, options.mount_m.powi(2));
        let doubt = [place, place, variance].map(|variances| Matrix3::from_diagonal(&variances));
        Self { gain: Matrix3::identity(), doubt, options }
    }

    /// The most likely motion when the odometry reports `motion`, with its information as in
    /// [`PoseEstimate::information`].
    pub fn corrected(&self, motion: Pose) -> PoseEstimate {
        let reported = Vector3::new(motion.x_m, motion.y_m, motion.heading_rad);
        let likely = self.gain * reported;
        let covariance = self.covariance_of(motion);
        PoseEstimate {
            pose: Pose::new(likely.x, likely.y, likely.z),
            information: covariance.try_inverse().unwrap_or_else(Matrix3::identity),
        }
    }

    /// Random errors, and what is not yet known of the systematic ones.
    fn covariance_of(&self, motion: Pose) -> Matrix3<f64> {
        let reported = Vector3::new(motion.x_m, motion.y_m, motion.heading_rad);
        let system = Vector3::from_fn(|row, _| reported.dot(&(self.doubt[row] * reported)));
        Matrix3::from_diagonal(&(self.chance(motion).map(|deviation| deviation * deviation) + system))
    }

    /// Standard deviations of the random errors: ahead, left and turn.
    fn chance(&self, motion: Pose) -> Vector3<f64> {
        let options = &self.options;
        let (way, turn) = (motion.x_m.hypot(motion.y_m), motion.heading_rad.abs());
        let place = options.base_m + options.m_per_m * way + options.m_per_rad * turn;
        Vector3::new(place, place, options.base_rad + options.rad_per_m * way + options.rad_per_rad * turn)
    }

    /// Learns from a motion reported by the odometry as `reported` and found by scan matching to be
    /// `found`.
    pub fn learn(&mut self, reported: Pose, found: Pose) {
        let motion = Vector3::new(reported.x_m, reported.y_m, reported.heading_rad);
        let likely = self.gain * motion;
        let error = Vector3::new(
            found.x_m - likely.x,
            found.y_m - likely.y,
            super::pose::wrapped_rad(found.heading_rad - likely.z),
        );
        let covariance = self.covariance_of(reported);
        let deviations = (0..3).map(|i| error[i].abs() / covariance[(i, i)].sqrt()).fold(0.0, f64::max);
        if motion.norm_squared() < 1e-6 || !deviations.is_finite() || deviations > MOST_DEVIATIONS {
            return;
        }
        let chance = self.chance(reported);
        for row in 0..3 {
            let spread = self.doubt[row] * motion;
            let innovation = chance[row].powi(2) + motion.dot(&spread);
            for column in 0..3 {
                self.gain[(row, column)] += error[row] * spread[column] / innovation;
            }
            self.doubt[row] -= spread * spread.transpose() / innovation;
        }
    }
}
