//! The study of noise that the paper leaves for later: labels of rooms that a simulated robot found, against
//! sensor noise, odometry noise and furniture, beside labels of the same rooms in the true plan.
//!
//! A study is many runs, each one exploration of one plan under one condition. Runs are independent of each
//! other, their results are values that can be stored and read again, and everything else follows from them.

mod labels;
mod run;
mod summary;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::dataset::RoomNetwork;
use crate::plan::Plan;
use crate::robot::odometry::OdometryNoise;
use crate::robot::{RobotOptions, Scanner, WorldOptions};

pub use labels::{LabelCounts, METHODS, method_title};
pub use run::{Explored, Record, TrueRoom, explore, run_key};
pub use summary::{ConditionLine, Gap, LabelLine, RobotStudy, RunLine, View, gather};

/// The noise and the furniture of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotCondition {
    /// Range noise and lost readings, as a multiple of the usual ([`Scanner::lms200`]).
    pub sensor_noise: f64,
    /// Standard deviations of the motion model, as a multiple of the usual ([`OdometryNoise::default`]).
    pub odometry_noise: f64,
    /// Pieces of furniture a room, as far as they fit.
    pub furniture: usize,
}

impl RobotCondition {
    /// The usual noise, no furniture.
    pub const USUAL: Self = Self { sensor_noise: 1.0, odometry_noise: 1.0, furniture: 0 };

    /// Perfect scanners and odometry, no furniture: what is lost here is lost by exploring and by finding rooms.
    pub const EXACT: Self = Self { sensor_noise: 0.0, odometry_noise: 0.0, furniture: 0 };

    /// The world of a run.
    pub fn world_options(&self, seed: u64) -> WorldOptions {
        WorldOptions { furniture: self.furniture, seed, ..WorldOptions::default() }
    }

    /// The robot of a run.
    pub fn robot_options(&self, seed: u64) -> RobotOptions {
        let usual = RobotOptions { seed, ..RobotOptions::default() };
        let scanner = |scanner: &Scanner| match self.sensor_noise {
            0.0 => scanner.clone().exact(),
            factor => Scanner {
                noise_m: scanner.noise_m * factor,
                drop_out: (scanner.drop_out * factor).min(1.0),
                ..scanner.clone()
            },
        };
        RobotOptions {
            scanners: usual.scanners.iter().map(scanner).collect(),
            odometry: OdometryNoise::default().times(self.odometry_noise),
            ..usual
        }
    }

    /// In words: 'sensor noise x 4, odometry noise x 1, 3 pieces of furniture a room'.
    pub fn words(&self) -> String {
        let Self { sensor_noise, odometry_noise, furniture } = self;
        if *self == Self::EXACT {
            return "no noise".to_owned();
        }
        if *self == Self::USUAL {
            return "usual noise".to_owned();
        }
        let mut words = Vec::new();
        if *sensor_noise != 1.0 {
            words.push(format!("sensor noise × {sensor_noise}"));
        }
        if *odometry_noise != 1.0 {
            words.push(format!("odometry noise × {odometry_noise}"));
        }
        if *furniture > 0 {
            words.push(format!("{furniture} pieces of furniture a room"));
        }
        words.join(", ")
    }
}

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Factor {
    SensorNoise,
    OdometryNoise,
    Furniture,
}

impl Factor {
    pub const ALL: [Self; 3] = [Self::SensorNoise, Self::OdometryNoise, Self::Furniture];

    /// For people.
    pub const fn title(self) -> &'static str {
        match self {
            Self::SensorNoise => "Sensor noise, multiple of the usual",
            Self::OdometryNoise => "Odometry noise, multiple of the usual",
            Self::Furniture => "Pieces of furniture a room",
        }
    }

    /// Its level under a condition, if nothing else differs from the usual.
    pub fn level(self, condition: &RobotCondition) -> Option<f64> {
        let usual = RobotCondition::USUAL;
        let (level, rest) = match self {
            Self::SensorNoise => {
                (condition.sensor_noise, RobotCondition { sensor_noise: usual.sensor_noise, ..*condition })
            }
            Self::OdometryNoise => {
                (condition.odometry_noise, RobotCondition { odometry_noise: usual.odometry_noise, ..*condition })
            }
            Self::Furniture => {
                (condition.furniture as f64, RobotCondition { furniture: usual.furniture, ..*condition })
            }
        };
        (rest == usual).then_some(level)
    }
}

/// The options of a study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RobotStudyOptions {
    /// Levels of each factor, the others as usual.
    pub sensor_noise: Vec<f64>,
    pub odometry_noise: Vec<f64>,
    pub furniture: Vec<usize>,
    /// Runs of each plan under each condition, with seeds that follow each other.
    pub repeats: usize,
    /// Folds of buildings, at least 2: classifiers learn from all but one, and are tested in that one.
    pub folds: usize,
    pub seed: u64,
}

impl Default for RobotStudyOptions {
    fn default() -> Self {
        Self {
            sensor_noise: vec![1.0, 4.0, 10.0],
            odometry_noise: vec![1.0, 2.0, 4.0],
            furniture: vec![0, 3, 6],
            repeats: 1,
            folds: 5,
            seed: 1,
        }
    }
}

impl RobotStudyOptions {
    /// The conditions: no noise at all, the usual, then each level of each factor by itself; each once.
    pub fn conditions(&self) -> Vec<RobotCondition> {
        let usual = RobotCondition::USUAL;
        let sensor = self.sensor_noise.iter().map(|&sensor_noise| RobotCondition { sensor_noise, ..usual });
        let odometry = self.odometry_noise.iter().map(|&odometry_noise| RobotCondition { odometry_noise, ..usual });
        let furniture = self.furniture.iter().map(|&furniture| RobotCondition { furniture, ..usual });
        let mut conditions = vec![RobotCondition::EXACT, usual];
        for condition in sensor.chain(odometry).chain(furniture) {
            if !conditions.contains(&condition) {
                conditions.push(condition);
            }
        }
        conditions
    }
}

/// A plan of a study.
#[derive(Clone, Debug)]
pub struct StudyPlan {
    pub plan: Arc<Plan>,
    /// The true rooms with their labels.
    pub network: RoomNetwork,
    /// Whether the robot explores it; the others only teach.
    pub is_explored: bool,
}

/// One exploration of a study.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The plan, by index.
    pub plan: usize,
    pub condition: RobotCondition,
    /// From 0.
    pub repeat: usize,
    /// Of the start, the noise and the furniture: the same for all conditions, so that they differ in nothing else.
    pub seed: u64,
}

/// All runs of a study, in the order of the plans.
pub fn runs(plans: &[StudyPlan], options: &RobotStudyOptions) -> Vec<Run> {
    let mut runs = Vec::new();
    for (plan, _) in plans.iter().enumerate().filter(|(_, plan)| plan.is_explored) {
        for condition in options.conditions() {
            runs.extend((0..options.repeats).map(|repeat| {
                let seed = options.seed.wrapping_add(repeat as u64);
                Run { plan, condition, repeat, seed }
            }));
        }
    }
    runs
}
