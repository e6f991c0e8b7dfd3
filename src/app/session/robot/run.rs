//! A run of the robot: what is shown of it, by the clock.
//!
//! States: Preparing -> Running <-> Paused -> Finished, and Failed from any of them.

use std::collections::VecDeque;
use std::sync::Arc;

use super::compared::Compared;
use super::drive::{Drive, Result, Step};
use crate::app::paint::robot::{MapSeen, Paths};
use crate::app::session::jobs::Wanted;
use crate::geometry::{Bounds, Point};
use crate::plan::Plan;
use crate::robot::Pose;
use crate::robot::pose::wrapped_rad;

/// Points of a path closer together than this, in metres, are one.
const SAME_POINT_M: f64 = 0.03;

/// What the robot is doing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum State {
    /// The world is made, or the log is read.
    Preparing,
    Running,
    Paused,
    Finished,
    /// It cannot go on, for a reason.
    Failed(String),
}

/// Where a run goes on to without showing each step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Until {
    Metres(f64),
    End,
}

/// What a run is about.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// The plan as it was at the start.
    Plan(Plan),
    /// A log.
    Log,
}

/// A run: from its start until the robot is put away.
pub(crate) struct Run {
    pub source: Source,
    pub title: String,
    pub state: State,
    /// The number of the document it is shown over.
    pub(super) document: u64,
    pub(super) radius_m: f64,
    /// The drive; `None` while a job has it.
    pub(super) drive: Option<Box<Drive>>,
    pub(super) job: Option<Wanted>,
    /// Whether the drive has come to its end, though not all is shown yet.
    pub(super) is_over: bool,
    pub(super) ahead: VecDeque<Step>,
    /// What was reached last.
    pub(super) at: Option<Step>,
    /// How far it is to the next step, in the robot's seconds.
    pub(super) since_s: f64,
    pub(super) until: Option<Until>,
    /// Steps to be shown while paused.
    pub(super) single_steps: usize,
    pub map: MapSeen,
    pub paths: Paths,
    pub time_s: f64,
    pub steps: usize,
    pub(super) result: Option<Result>,
    pub progress: Option<(usize, usize)>,
    pub trouble: Option<String>,
    pub(super) gave_up: bool,
    /// What of a log's map is in view.
    pub(super) in_view: Bounds,
    pub is_compared: bool,
    /// The line of the comparison that is looked at.
    pub current: Option<usize>,
}

impl Run {
    pub(super) fn new(source: Source, title: String, document: u64, radius_m: f64) -> Self {
        Self {
            source,
            title,
            state: State::Preparing,
            document,
            radius_m,
            drive: None,
            job: None,
            is_over: false,
            ahead: VecDeque::new(),
            at: None,
            since_s: 0.0,
            until: None,
            single_steps: 0,
            map: MapSeen::default(),
            paths: Paths::default(),
            time_s: 0.0,
            steps: 0,
            result: None,
            progress: None,
            trouble: None,
            gave_up: false,
            in_view: Bounds::EMPTY,
            is_compared: false,
            current: None,
        }
    }

    /// The way driven so far, in metres.
    pub(crate) fn driven_m(&self) -> f64 {
        self.at.as_ref().map_or(0.0, |step| step.driven_m)
    }

    /// How many places were recognised.
    pub(crate) fn closures(&self) -> usize {
        self.at.as_ref().map_or(0, |step| step.closures)
    }

    /// How far the estimate is from the truth now, in metres.
    pub(crate) fn error_m(&self) -> Option<f64> {
        let at = self.at.as_ref()?;
        Some(at.true_pose?.position().distance(at.pose.position()))
    }

    /// How far odometry alone would be from the truth now, in metres.
    pub(crate) fn drift_m(&self) -> Option<f64> {
        let at = self.at.as_ref()?;
        Some(at.true_pose?.position().distance(at.odometry.position()))
    }

    /// The comparison with the true plan, if it is there.
    pub(crate) fn compared(&self) -> Option<&Arc<Compared>> {
        self.result.as_ref()?.compared.as_ref().filter(|_| self.state == State::Finished)
    }

    /// Which models gave the labels, and why.
    pub(crate) fn choice(&self) -> Option<&crate::predict::Choice> {
        self.result.as_ref()?.labelled.choice.as_ref()
    }

    /// What it is doing, in a word or two.
    pub(crate) fn state_in_words(&self) -> &'static str {
        match (&self.state, &self.source) {
            (State::Preparing, Source::Plan(_)) => "Furnishing the world…",
            (State::Preparing, Source::Log) => "Reading the log…",
            (State::Running, _) if self.until.is_some() => "Hurrying ahead…",
            (State::Running, Source::Plan(_)) => "Exploring",
            (State::Running, Source::Log) => "Replaying",
            (State::Paused, _) => "Paused",
            (State::Finished, Source::Plan(_)) if self.gave_up => "Gave up",
            (State::Finished, Source::Plan(_)) => "Explored",
            (State::Finished, Source::Log) => "Replayed",
            (State::Failed(_), _) => "Failed",
        }
    }

    /// The pose between the last step and the next.
    pub(super) fn pose(&self) -> Option<(Pose, Option<Pose>)> {
        let at = self.at.as_ref()?;
        let next = self.ahead.front().filter(|next| next.secs > 0.0 && self.since_s > 0.0);
        let Some(next) = next else { return Some((at.pose, at.true_pose)) };
        let share = (self.since_s / next.secs).clamp(0.0, 1.0);
        let truth = at.true_pose.zip(next.true_pose).map(|(from, to)| between(from, to, share));
        Some((between(at.pose, next.pose, share), truth))
    }

    /// Goes to the next step.
    pub(super) fn take(&mut self) {
        let Some(step) = self.ahead.pop_front() else { return };
        fn add(path: &mut Vec<Point>, point: Point) {
            if path.last().is_none_or(|last| last.distance(point) > SAME_POINT_M) {
                path.push(point);
            }
        }
        add(&mut self.paths.odometry, step.odometry.position());
        if let Some(truth) = step.true_pose {
            add(&mut self.paths.truth, truth.position());
        }
        match &step.path {
            Some(path) => {
                self.paths.estimate.clear();
                path.iter().for_each(|&point| add(&mut self.paths.estimate, point));
            }
            None => add(&mut self.paths.estimate, step.pose.position()),
        }
        if let Some(map) = &step.map {
            self.map = map.clone();
        }
        self.time_s += step.secs;
        self.steps += 1;
        self.at = Some(step);
    }

    /// Shows what the clock has come to. Returns whether something moved.
    pub(super) fn play(&mut self, robot_secs: f64) -> bool {
        if self.ahead.is_empty() {
            self.since_s = 0.0;
            return false;
        }
        self.since_s += robot_secs;
        while let Some(next) = self.ahead.front() {
            if self.since_s < next.secs {
                return true;
            }
            self.since_s -= next.secs;
            self.take();
        }
        // The drive is behind: it does not catch up in a leap.
        self.since_s = 0.0;
        true
    }

    /// Goes on to where it is to hurry, as far as the drive has come. Returns whether it is there.
    pub(super) fn hurry(&mut self, until: Until) -> bool {
        self.since_s = 0.0;
        loop {
            let is_there = match until {
                Until::Metres(metres) => self.driven_m() >= metres && self.at.is_some(),
                Until::End => false,
            };
            if is_there || self.ahead.is_empty() {
                return is_there;
            }
            self.take();
        }
    }

    /// Whether all is driven and shown.
    pub(super) fn is_done(&self) -> bool {
        self.is_over && self.ahead.is_empty() && self.drive.is_some()
    }

    /// How far ahead of what is shown the drive is, in the robot's seconds.
    pub(super) fn ahead_s(&self) -> f64 {
        self.ahead.iter().map(|step| step.secs).sum()
    }
}

/// The pose a share of the way from one to another.
fn between(from: Pose, to: Pose, share: f64) -> Pose {
    let at = from.position().lerp(to.position(), share);
    Pose::new(at.x, at.y, from.heading_rad + share * wrapped_rad(to.heading_rad - from.heading_rad))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn step(x_m: f64, secs: f64) -> Step {
        let pose = Pose::new(x_m, 0.0, 0.0);
        Step {
            pose,
            true_pose: None,
            odometry: pose,
            secs,
            driven_m: x_m,
            fans: Arc::default(),
            way: Arc::default(),
            map: None,
            path: None,
            closures: 0,
        }
    }

    fn run_of(steps: impl IntoIterator<Item = Step>) -> Run {
        let mut run = Run::new(Source::Log, String::new(), 1, 0.25);
        run.ahead.extend(steps);
        run
    }

    #[test]
    fn between_two_headings_it_turns_the_short_way() {
        let middle = between(Pose::new(0.0, 0.0, PI - 0.1), Pose::new(1.0, 0.0, 0.1 - PI), 0.5);
        assert!((middle.heading_rad.abs() - PI).abs() < 1e-9 && (middle.x_m - 0.5).abs() < 1e-9);
    }

    #[test]
    fn it_moves_evenly_between_steps_and_waits_for_the_drive() {
        let mut run = run_of([step(0.0, 0.0), step(0.2, 0.5), step(0.2, 0.0), step(0.4, 0.5)]);
        let x_m = |run: &Run| run.pose().map(|(pose, _)| pose.x_m).unwrap();
        let mut places = Vec::new();
        for _ in 0..12 {
            run.play(0.1);
            places.push((x_m(&run) * 1e6).round() / 1e6);
        }
        assert_eq!(places[..9], [0.04, 0.08, 0.12, 0.16, 0.2, 0.24, 0.28, 0.32, 0.36]);
        // Nothing more is known: it stays, and does not leap when there is.
        assert_eq!(places[9..], [0.4, 0.4, 0.4]);
        run.ahead.push_back(step(0.6, 0.5));
        run.play(0.1);
        assert!((x_m(&run) - 0.44).abs() < 1e-9);
        assert_eq!((run.steps, run.paths.estimate.len()), (4, 3));
    }

    #[test]
    fn hurrying_ends_at_the_first_step_that_is_far_enough() {
        let mut run = run_of((0..10).map(|i| step(f64::from(i) * 0.2, 0.5)));
        assert!(run.hurry(Until::Metres(0.5)));
        assert!((run.driven_m() - 0.6).abs() < 1e-9);
        assert!(!run.hurry(Until::End) && run.ahead.is_empty());
    }
}
