//! The robot in the window: exploring the open plan, or replaying a log.
//!
//! It drives in jobs beside the frames, which are ahead of what is shown by a few steps; frames only go on from step
//! to step by the clock, and paint the last map. The plan itself is never changed.
//!
//! States: Preparing -> Running <-> Paused -> Finished, and Failed from any of them; `run` is `None` when idle.

pub(crate) mod compared;
pub(crate) mod drive;
pub(crate) mod run;
pub(crate) mod settings;
mod vehicle;

use std::path::PathBuf;
use std::sync::Arc;

use egui::Context;

use self::drive::{Batch, Drive, Truth};
use self::run::{Run, Source, State, Until};
use self::settings::RobotSettings;
use self::vehicle::LogVehicle;
use super::Session;
use crate::app::paint::robot::RobotSeen;
use crate::app::session::document::{Begun, Opened};
use crate::app::session::file_dialogs::Purpose;
use crate::app::session::jobs::Kind;
use crate::app::session::messages::Severity;
use crate::app::session::origin::file_name;
use crate::app::session::wishes::Wish;
use crate::base::wording::count;
use crate::base::work::Work;
use crate::draw::Fill;
use crate::edit;
use crate::formats::FileError;
use crate::geometry::Bounds;
use crate::plan::{Meta, Plan, Scale, ScaleOrigin};
use crate::predict::explored::explored_meta;
use crate::robot::log_replay::LogReplay;
use crate::robot::{Exploration, MapperOptions, Pose, RobotOptions, World};
use crate::store::{self, LoadedLog};

/// Steps of a job: few, so that the first ones are soon there; more where nobody watches each.
const STEPS: usize = 12;
const STEPS_AHEAD: usize = 60;

/// The drive is this far ahead of what is shown, in seconds of the person, and at most so many steps.
const AHEAD_S: f64 = 1.0;
const MOST_AHEAD: usize = 240;

/// The longest time between two frames that counts, in seconds: after a pause of the window the robot does not leap.
const LONGEST_FRAME_S: f64 = 0.1;

/// Where nothing moves smoothly, a frame follows after so many seconds.
const STILL_FRAME_S: f32 = 0.05;

/// The robot of the window.
#[derive(Default)]
pub(crate) struct Robot {
    pub settings: RobotSettings,
    pub run: Option<Box<Run>>,
    /// Runs are counted, so that what a job brings is not taken for another's.
    runs: u64,
    /// The clock of the last frame, in seconds.
    last_s: Option<f64>,
}

/// What a job made ready.
struct Ready {
    drive: Box<Drive>,
}

impl Session {
    /// Lets a robot explore the open plan.
    ///
    /// # Errors
    /// When there is nothing to explore.
    pub(crate) fn explore_plan(&mut self) -> Result<(), String> {
        self.commit_field();
        let Some(document) = &self.document else { return Err("open a plan first".to_owned()) };
        let plan = document.plan().clone();
        if plan.rooms().len() == 0 {
            return Err("the plan has no rooms".to_owned());
        }
        let (title, number) = (document.title(), document.number);
        let settings = self.robot.settings.clone();
        let labels = (self.predictor.clone(), self.models.clone());
        let radius_m = settings.robot().radius_m;
        self.robot.runs += 1;
        let this = self.robot.runs;
        let mut run = Run::new(Source::Plan(plan.clone()), title, number, radius_m);
        let kind = Kind::new("prepare the robot").if_broken(|session| session.robot_broke());
        run.job = Some(self.jobs.start_wanted(kind, move |_| {
            let ready = explorer(plan, &settings, labels);
            move |session: &mut Session, _: &Context| session.robot_is_ready(this, ready)
        }));
        self.robot.run = Some(Box::new(run));
        self.status = "The robot looks around".to_owned();
        Ok(())
    }

    /// Asks which log to replay.
    pub(crate) fn choose_log(&mut self) {
        self.ask_for_file(Purpose::Log, None, String::new());
    }

    /// Reads a robot's log and replays it over an empty plan.
    pub(crate) fn replay_log(&mut self, path: PathBuf) {
        self.jobs.start(Kind::new("read a log").newest_of("log to replay"), move |_| {
            let loaded = store::load_log(&path);
            move |session: &mut Session, _: &Context| session.log_was_read(&path, loaded)
        });
        self.status = "Reading the log".to_owned();
    }

    fn log_was_read(&mut self, path: &std::path::Path, loaded: Result<LoadedLog, FileError>) {
        let name = file_name(path);
        let loaded = match loaded {
            Ok(loaded) => loaded,
            Err(FileError { path, error }) => {
                let text = format!("Cannot replay {name}");
                self.say(Severity::Error, text, format!("{error}\n{}", self.shown_path(&path)));
                return;
            }
        };
        let mut remarks: Vec<String> = loaded.log.notes.iter().take(4).map(ToString::to_string).collect();
        remarks.extend(loaded.broken_off.map(|why| format!("{why}; read up to there")));
        if !loaded.log.has_odometry {
            remarks.push("the odometry never moves; scans are matched with one another only".to_owned());
        }
        let scale = Scale { origin: ScaleOrigin::Measured, note: format!("from the log {name}"), ..Scale::default() };
        let meta = Meta { name: log_title(&name), source: format!("laser log {name}"), scale, ..Meta::default() };
        let blank = edit::set_meta(&Plan::default(), meta.clone());
        self.show(Opened { storeys: vec![blank], ..Opened::untitled() });
        let Some(number) = self.document.as_ref().map(|document| document.number) else { return };
        let labels = (self.predictor.clone(), self.models.clone());
        let robot = RobotOptions::default();
        let replay = LogReplay::new(Arc::new(loaded.log), &MapperOptions::default());
        let vehicle = Box::new(LogVehicle { replay, time_s: None });
        self.robot.runs += 1;
        let mut run = Run::new(Source::Log, name.clone(), number, robot.radius_m);
        let seed = self.robot.settings.seed;
        run.drive = Some(Box::new(Drive::new(vehicle, Pose::IDENTITY, meta, labels, seed, None)));
        run.state = State::Running;
        self.robot.run = Some(Box::new(run));
        self.status = format!("Replaying {name}");
        if !remarks.is_empty() {
            self.say(Severity::Info, format!("Some of {name} was left out or repaired"), remarks.join("\n"));
        }
    }

    fn robot_is_ready(&mut self, this: u64, ready: Result<Ready, String>) {
        if self.robot.runs != this {
            return;
        }
        let Some(run) = &mut self.robot.run else { return };
        run.job = None;
        match ready {
            Ok(Ready { drive }) => {
                run.drive = Some(drive);
                run.state = State::Running;
            }
            Err(why) => {
                run.state = State::Failed(why.clone());
                self.say(Severity::Warning, "The robot cannot explore this plan", why);
            }
        }
    }

    /// A job of the robot panicked.
    fn robot_broke(&mut self) {
        if let Some(run) = &mut self.robot.run {
            run.job = None;
            run.state = State::Failed("something went wrong inside Enfilade".to_owned());
        }
    }

    /// The run, if the robot is out.
    pub(crate) fn robot_run(&self) -> Option<&Run> {
        self.robot.run.as_deref()
    }

    /// The run, if its plan is the one shown.
    pub(crate) fn shown_run(&self) -> Option<&Run> {
        let number = self.document.as_ref()?.number;
        self.robot_run().filter(|run| run.document == number)
    }

    /// Shows the plan that the robot drives in.
    pub(crate) fn show_robots_plan(&mut self) {
        if let Some(number) = self.robot_run().map(|run| run.document) {
            self.show_open(number);
            self.note_shown();
        }
    }

    /// Whether the plan has been changed since the run began.
    pub(crate) fn is_plan_changed_since_run(&self) -> bool {
        let run = self.shown_run();
        let (Some(Source::Plan(before)), Some(plan)) = (run.map(|run| &run.source), self.plan()) else { return false };
        !before.is_same_value(plan) && before != plan
    }

    /// Lets the robot go on, or pauses it.
    pub(crate) fn set_robot_running(&mut self, is_running: bool) {
        let Some(run) = &mut self.robot.run else { return };
        match (&run.state, is_running) {
            (State::Paused, true) => run.state = State::Running,
            (State::Running, false) => {
                run.state = State::Paused;
                run.until = None;
            }
            _ => {}
        }
    }

    /// Goes on by one scan, and stays there.
    pub(crate) fn step_robot(&mut self) {
        let Some(run) = &mut self.robot.run else { return };
        if matches!(run.state, State::Running | State::Paused) {
            run.state = State::Paused;
            run.until = None;
            run.single_steps += 1;
        }
    }

    /// Goes on, without showing each step, until so many metres have been driven in all; without, to the end.
    pub(crate) fn hurry_robot(&mut self, until_m: Option<f64>) {
        let Some(run) = &mut self.robot.run else { return };
        if matches!(run.state, State::Running | State::Paused | State::Preparing) {
            run.until = Some(until_m.map_or(Until::End, Until::Metres));
            if run.state == State::Paused {
                run.state = State::Running;
            }
        }
    }

    /// Ends the run: the plan is shown as before.
    pub(crate) fn stop_robot(&mut self) {
        if let Some(run) = self.robot.run.take() {
            self.robot.runs += 1;
            self.status = format!("The robot was put away after {}", self.units().length(run.driven_m()));
        }
    }

    /// Shows or hides the comparison with the true plan.
    pub(crate) fn set_robot_compared(&mut self, is_compared: bool) {
        if let Some(run) = &mut self.robot.run {
            run.is_compared = is_compared;
            run.current = None;
        }
    }

    /// Brings what a line of the comparison is about into view. Lines count from 1.
    ///
    /// # Errors
    /// When there is no such line.
    pub(crate) fn go_to_difference(&mut self, number: usize) -> Result<(), String> {
        self.show_robots_plan();
        let Some(run) = &mut self.robot.run else { return Err("no robot is out".to_owned()) };
        let compared = run.compared().cloned().ok_or("compare with the true plan first")?;
        let line = compared.list.get(number.wrapping_sub(1));
        let line = line.ok_or_else(|| format!("there are {}", count(compared.list.len(), "line")))?;
        run.is_compared = true;
        run.current = Some(number - 1);
        self.status = format!("{}: {}", line.verdict.title(), line.text);
        self.wishes.push(Wish::ZoomTo(line.bounds.inflated(1.0)));
        Ok(())
    }

    /// Whether there is a map that can be opened as a plan.
    pub(crate) fn has_robot_map(&self) -> bool {
        let is_still = |run: &&Run| matches!(run.state, State::Finished | State::Paused);
        let result = self.robot_run().filter(is_still).and_then(|run| run.result.as_ref());
        result.is_some_and(|result| !result.labelled.explored.rooms.is_empty())
    }

    /// Opens the map as a plan of its own, beside the others.
    ///
    /// # Errors
    /// When there is none yet.
    pub(crate) fn open_robot_map(&mut self) -> Result<(), String> {
        let result = self.robot_run().filter(|_| self.has_robot_map()).and_then(|run| run.result.clone());
        let result = result.ok_or("the robot has found no rooms yet")?;
        let title = self.robot_run().map(|run| run.title.clone()).unwrap_or_default();
        let plan = &result.labelled.explored.plan;
        let meta = Meta { name: format!("{title}, as the robot found it"), ..plan.meta().clone() };
        let plan = edit::set_meta(plan, meta);
        let begun = Begun { title: "Open the robot's map".to_owned(), plan, below: None };
        self.opening = None;
        self.show(Opened { begun: Some(Box::new(begun)), ..Opened::untitled() });
        // Nobody has reviewed its labels: they are predictions.
        self.layers.fill = Fill::Prediction;
        self.status = "The robot's map is a plan of its own now; its labels are predicted".to_owned();
        Ok(())
    }

    /// Goes on with the run by the clock of the window.
    pub(crate) fn drive_robot(&mut self, context: &Context) {
        let now_s = context.input(|input| input.time);
        let frame_s = (now_s - self.robot.last_s.replace(now_s).unwrap_or(now_s)).clamp(0.0, LONGEST_FRAME_S);
        let Some(run) = &self.robot.run else { return };
        if !self.is_open(run.document) {
            self.robot.run = None;
            self.robot.runs += 1;
            self.status = "The robot's run ended with its plan".to_owned();
            return;
        }
        let is_shown = self.shown_run().is_some();
        let speed = self.robot.settings.speed;
        let Some(run) = &mut self.robot.run else { return };
        let (is_running, is_paused) = (run.state == State::Running, run.state == State::Paused);
        let hurries = run.until.filter(|_| is_running);
        if hurries.is_some_and(|until| run.hurry(until)) {
            run.until = None;
            run.state = State::Paused;
        } else if is_running && is_shown && hurries.is_none() {
            run.play(frame_s * speed);
        }
        while is_paused && run.single_steps > 0 && !run.ahead.is_empty() {
            // Steps without any motion are not seen.
            run.single_steps -= usize::from(run.ahead.front().is_some_and(|step| step.secs > 0.0));
            run.since_s = 0.0;
            run.take();
        }
        if run.is_done() && matches!(run.state, State::Running | State::Paused) {
            run.until = None;
            run.single_steps = 0;
            run.state = State::Finished;
            self.status = self.robot_in_words();
        }
        self.follow_log();
        self.drive_on(is_shown);
        self.ask_for_frames(context, is_shown);
    }

    /// Starts the next job, where the drive is not far enough ahead.
    fn drive_on(&mut self, is_shown: bool) {
        let speed = self.robot.settings.speed;
        let this = self.robot.runs;
        let Some(run) = &mut self.robot.run else { return };
        let wants_more = match (&run.state, run.until) {
            (State::Running, Some(_)) => true,
            (State::Running, None) => is_shown && run.ahead_s() < AHEAD_S * speed && run.ahead.len() < MOST_AHEAD,
            (State::Paused, _) => run.single_steps > 0,
            _ => false,
        };
        if !wants_more || run.is_over || run.job.is_some() {
            return;
        }
        let Some(mut drive) = run.drive.take() else { return };
        let most = if run.until.is_some() { STEPS_AHEAD } else { STEPS };
        let until_m = match run.until {
            Some(Until::Metres(metres)) => Some(metres),
            _ => None,
        };
        let kind = Kind::new("drive the robot").if_broken(|session| session.robot_broke());
        let job = self.jobs.start_wanted(kind, move |work: &Work<'_>| {
            let batch = drive.batch(most, until_m, work);
            move |session: &mut Session, _: &Context| {
                if let Some(batch) = batch.ok().filter(|_| session.robot.runs == this) {
                    session.robot_drove(drive, batch);
                }
            }
        });
        if let Some(run) = &mut self.robot.run {
            run.job = Some(job);
        }
    }

    fn robot_drove(&mut self, drive: Box<Drive>, batch: Batch) {
        let Some(run) = &mut self.robot.run else { return };
        run.job = None;
        run.drive = Some(drive);
        run.is_over = batch.is_over;
        run.gave_up = batch.gave_up;
        run.progress = batch.progress;
        run.trouble = batch.trouble;
        run.result = batch.result.or(run.result.take());
        run.ahead.extend(batch.steps);
    }

    /// Keeps the map of a log in view, which nobody knows the size of.
    fn follow_log(&mut self) {
        if self.shown_run().is_none() {
            return;
        }
        let Some(run) = &mut self.robot.run else { return };
        if !matches!(run.source, Source::Log) {
            return;
        }
        let known = run.map.free.iter().flat_map(|part| part.outer.iter().copied());
        let bounds = Bounds::of(known);
        if bounds.is_empty() || (run.in_view.contains(bounds.min) && run.in_view.contains(bounds.max)) {
            return;
        }
        run.in_view = bounds.inflated((bounds.width().max(bounds.height()) / 4.0).max(2.0));
        self.wishes.push(Wish::ZoomTo(bounds));
    }

    fn ask_for_frames(&self, context: &Context, is_shown: bool) {
        let Some(run) = &self.robot.run else { return };
        let is_moving = run.state == State::Running || run.single_steps > 0;
        match (is_moving, run.until.is_some() || run.single_steps > 0, self.jobs.is_inline()) {
            (false, ..) => {}
            (true, false, _) if !is_shown => {}
            // Nothing is waited for: what was driven is shown in the next frame.
            (true, true, true) => context.request_repaint(),
            (true, _, false) => context.request_repaint(),
            (true, false, true) => context.request_repaint_after_secs(STILL_FRAME_S),
        }
    }

    /// What is painted now, if the robot's plan is shown.
    pub(crate) fn robot_seen(&self) -> Option<RobotSeen<'_>> {
        let run = self.shown_run()?;
        let at = run.at.as_ref()?;
        let (pose, true_pose) = run.pose()?;
        let compared = run.compared().filter(|_| run.is_compared);
        Some(RobotSeen {
            map: &run.map,
            pose,
            true_pose,
            radius_m: run.radius_m,
            fans: &at.fans,
            way: &at.way,
            paths: &run.paths,
            shows_sights: self.robot.settings.shows_sights && !matches!(run.source, Source::Log),
            shows_paths: self.robot.settings.shows_paths && compared.is_none(),
            is_over: run.state == State::Finished,
            marks: compared.map_or(&[], |compared| compared.marks.as_slice()),
            current: run.current,
        })
    }

    /// How the run stands, in a sentence.
    pub(crate) fn robot_in_words(&self) -> String {
        let Some(run) = self.robot_run() else { return "No robot is out".to_owned() };
        if let State::Failed(why) = &run.state {
            return format!("{}: {why}", run.state_in_words());
        }
        let rooms = count(run.map.rooms.rooms.len(), "room");
        format!("{}: {rooms} found, {} driven", run.state_in_words(), self.units().length(run.driven_m()))
    }
}

/// A plan's name for a log: its file's without the endings.
fn log_title(name: &str) -> String {
    let stem = name.strip_suffix(".gz").unwrap_or(name);
    let stem = stem.strip_suffix(".log").unwrap_or(stem);
    if stem.is_empty() { name.to_owned() } else { stem.to_owned() }
}

/// A robot at its start in a plan.
fn explorer(
    plan: Plan,
    settings: &RobotSettings,
    labels: (crate::predict::Predictor, crate::classify::models::Models),
) -> Result<Ready, String> {
    let world = Arc::new(World::new(&plan, &settings.world()));
    let robot = settings.robot();
    let reach_m = robot.radius_m + robot.margin_m;
    let Some(start) = world.start(reach_m, settings.seed) else {
        return Err(format!(
            "No room has space for it: it is {:.1} m wide. Check the scale of the plan, or take furniture out.",
            2.0 * robot.radius_m
        ));
    };
    let pose = Pose::new(start.x, start.y, 0.0);
    let meta = explored_meta(plan.meta());
    let vehicle = Box::new(Exploration::new(world.clone(), pose, robot));
    let truth = Truth { plan, world, start, reach_m };
    Ok(Ready { drive: Box::new(Drive::new(vehicle, pose, meta, labels, settings.seed, Some(truth))) })
}
