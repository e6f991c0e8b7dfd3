//! The world and the noise of the next run, and how runs are shown.

use crate::robot::{RobotOptions, Scanner, WorldOptions};

/// How many times faster than the robot its steps are shown.
pub(crate) const SPEEDS: [f64; 5] = [1.0, 4.0, 8.0, 16.0, 64.0];

/// The limits of the settings.
pub(crate) const MOST_NOISE: f64 = 10.0;
pub(crate) const MOST_FURNITURE: usize = 12;
pub(crate) const MOST_SEED: usize = 9999;

/// The world and the robot of the next run, and how they are shown.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RobotSettings {
    /// Noise of the scanners, as a multiple of the usual.
    pub scanner_noise: f64,
    /// Drift of the odometry, as a multiple of the usual.
    pub drift: f64,
    /// Pieces of furniture a room.
    pub furniture: usize,
    pub seed: u64,
    /// Shares of the inner doors, in percent.
    pub ajar_percent: f64,
    pub closed_percent: f64,
    pub speed: f64,
    pub shows_sights: bool,
    pub shows_paths: bool,
}

impl Default for RobotSettings {
    fn default() -> Self {
        Self {
            scanner_noise: 1.0,
            drift: 1.0,
            furniture: 0,
            seed: 1,
            ajar_percent: 0.0,
            closed_percent: 0.0,
            speed: 16.0,
            shows_sights: false,
            shows_paths: true,
        }
    }
}

impl RobotSettings {
    pub(super) fn world(&self) -> WorldOptions {
        let closed_share = (self.closed_percent / 100.0).clamp(0.0, 1.0);
        WorldOptions {
            closed_share,
            ajar_share: (self.ajar_percent / 100.0).clamp(0.0, 1.0 - closed_share),
            outer_doors_open: false,
            furniture: self.furniture,
            seed: self.seed,
        }
    }

    pub(super) fn robot(&self) -> RobotOptions {
        let robot = RobotOptions { seed: self.seed, ..RobotOptions::default() };
        let noisy = |scanner: Scanner| match self.scanner_noise {
            0.0 => scanner.exact(),
            noise => {
                Scanner { noise_m: scanner.noise_m * noise, drop_out: (scanner.drop_out * noise).min(1.0), ..scanner }
            }
        };
        let scanners = robot.scanners.into_iter().map(noisy).collect();
        RobotOptions { odometry: robot.odometry.times(self.drift), scanners, ..robot }
    }
}
