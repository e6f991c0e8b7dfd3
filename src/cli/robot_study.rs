use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};

use super::batch::{self, Input};
use super::call::quoted;
use super::collect::report_left_out;
use super::inputs;
use super::outputs::{Care, Outputs, must_be_folder};
use super::progress::{Progress, with_progress};
use super::repeats::report_repeats;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::base::random::Random;
use crate::base::units::parse_number;
use crate::base::work::Work;
use crate::formats::{self, Import};
use crate::gather::{FileRead, PlansRead, program, sha256};
use crate::labels::Schemes;
use crate::plan::Plan;
use crate::store;
use crate::study::robot::{Record, RobotStudyOptions, Run, StudyPlan, explore, gather, run_key, runs};
use crate::study::{About, report};

/// `enfilade robot-study`: what noise and furniture cost a robot.
#[derive(clap::Args)]
pub struct RobotStudyCommand {
    /// Plans, or folders of plans, to explore, with labelled rooms
    #[arg(required = true, value_name = "DIR")]
    plans: Vec<PathBuf>,
    /// More labelled plans for the classifiers to learn from, which are not explored (can be repeated)
    #[arg(long, value_name = "DIR")]
    learn: Vec<PathBuf>,
    /// Explore at most N plans of each typology, drawn by the seed; the others only teach
    #[arg(long, value_name = "N", default_value_t = 10)]
    most_plans: usize,
    /// Explore no plan with more than N rooms: they take long, and teach all the same
    #[arg(long, value_name = "N", default_value_t = 30)]
    most_rooms: usize,
    /// Levels of sensor noise, as multiples of the usual
    #[arg(long, value_name = "LEVELS", default_value = "1,4,10", value_parser = Levels::read)]
    sensor_noise: Levels,
    /// Levels of odometry noise, as multiples of the usual
    #[arg(long, value_name = "LEVELS", default_value = "1,2,4", value_parser = Levels::read)]
    odometry_noise: Levels,
    /// Levels of furniture, in pieces a room
    #[arg(long, value_name = "LEVELS", default_value = "0,3,6", value_parser = Levels::read_whole)]
    furniture: Levels,
    /// Explorations of each plan under each condition
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1000))]
    repeats: u16,
    /// Folds of buildings: classifiers learn from all but one, and are tested on that one
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(2..=1000))]
    folds: u16,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
    /// Seed for everything random: the same seed gives the same bytes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// The date to print on the report [default: none]
    #[arg(long, value_name = "TEXT")]
    date: Option<String>,
    /// Folder for the report, and for the runs, which a later call with the same plans takes up again
    #[arg(short, long, value_name = "STUDY")]
    output: PathBuf,
}

/// Levels of a factor.
#[derive(Clone, Debug, PartialEq)]
struct Levels(Vec<f64>);

/// The highest level that is taken.
const HIGHEST_LEVEL: f64 = 100.0;

/// The most levels of a factor.
const MOST_LEVELS: usize = 20;

impl Levels {
    fn read(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(parse_number).collect();
        let numbers = numbers.unwrap_or_default();
        let is_right = (1..=MOST_LEVELS).contains(&numbers.len())
            && numbers.iter().all(|level| (0.0..=HIGHEST_LEVEL).contains(level));
        if !is_right {
            return Err(format!(
                "give up to {MOST_LEVELS} numbers from 0 to {HIGHEST_LEVEL} with commas between them, such as 0,1,4"
            ));
        }
        Ok(Self(numbers))
    }

    fn read_whole(text: &str) -> Result<Self, String> {
        let levels = Self::read(text)?;
        if levels.0.iter().any(|level| level.fract() != 0.0) {
            return Err("give whole numbers with commas between them, such as 0,3,6".to_owned());
        }
        Ok(levels)
    }

    fn words(&self) -> String {
        let words: Vec<String> = self.0.iter().map(ToString::to_string).collect();
        words.join(",")
    }
}

/// Where runs are kept within the study's folder.
const RUNS_FOLDER: &str = "runs";

impl Subcommand for RobotStudyCommand {
    const NAME: &'static str = "robot-study";
    const ABOUT: &'static str = "Measure what noise and furniture cost a simulated robot that finds and labels rooms";
    const EXAMPLE: &'static str =
        "enfilade robot-study schools offices --learn houses -o study   # go on: call it again";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        must_be_folder(&self.output)?;
        let options = self.options();
        let schemes = inputs::schemes(&self.scheme)?;
        let (plans, read) = self.read(&schemes, terminal)?;
        if plans.iter().all(|plan| !plan.is_explored) {
            return Err(CliError::new(
                "there is no plan with rooms to explore; name plans, or a folder of plans, and a larger --most-rooms",
            ));
        }
        let mut outputs = Outputs::new(terminal);
        outputs.folder(&self.output.join(RUNS_FOLDER))?;
        let all = runs(&plans, &options);
        let records = self.perform(&plans, &all, &mut outputs, terminal)?;
        let mut study =
            with_progress("labelling", None, terminal, |work| gather(&plans, &all, &records, &options, work))?;
        let hashes: Vec<&str> = read.sources.iter().map(|source| source.sha256.as_str()).collect();
        study.program = program();
        study.about = About {
            command: self.command_line(),
            data: self.plans.iter().chain(&self.learn).map(|path| path.display().to_string()).collect(),
            files: read.sources.len(),
            sha256: sha256(hashes.join("\n").as_bytes()),
            date: self.date.clone(),
        };
        for (name, bytes) in report::robot_files(&study)? {
            outputs.save_in(&self.output, &name, &bytes, terminal)?;
        }
        if !terminal.call.quiet {
            terminal.out.write_all(report::robot_text(&study).as_bytes())?;
        }
        terminal.report(format!("The report: {}", self.output.join("report.html").display()))?;
        Ok(if read.failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl RobotStudyCommand {
    fn options(&self) -> RobotStudyOptions {
        RobotStudyOptions {
            sensor_noise: self.sensor_noise.0.clone(),
            odometry_noise: self.odometry_noise.0.clone(),
            // Whole numbers, as the parser saw to it.
            furniture: self.furniture.0.iter().map(|&pieces| pieces as usize).collect(),
            repeats: usize::from(self.repeats),
            folds: usize::from(self.folds),
            seed: self.seed,
        }
    }

    /// The call that makes this report: what the numbers depend on, and nothing else.
    fn command_line(&self) -> String {
        let path = |path: &PathBuf| quoted(&path.to_string_lossy());
        let mut words = vec!["enfilade robot-study".to_owned()];
        words.extend(self.plans.iter().map(path));
        words.extend(self.learn.iter().map(|it| format!("--learn {}", path(it))));
        words.push(format!("--most-plans {} --most-rooms {}", self.most_plans, self.most_rooms));
        words.extend(self.scheme.iter().map(|it| format!("--scheme {}", path(it))));
        words.push(format!("--sensor-noise {}", self.sensor_noise.words()));
        words.push(format!("--odometry-noise {}", self.odometry_noise.words()));
        words.push(format!("--furniture {}", self.furniture.words()));
        words.push(format!("--repeats {} --folds {} --seed {}", self.repeats, self.folds, self.seed));
        words.join(" ")
    }

    /// Reads the plans; says on stderr what could not be read, what was read twice, and which rooms have no label.
    fn read(&self, schemes: &Schemes, terminal: &mut Terminal) -> Result<(Vec<StudyPlan>, PlansRead), CliError> {
        let mut explored = batch::inputs_into(&self.plans, Some(&self.output));
        let first_taught = explored.len();
        if !self.learn.is_empty() {
            explored.extend(batch::inputs_into(&self.learn, Some(&self.output)));
        }
        let files: Vec<Input> = explored;
        // By path: whether it is to be explored.
        let is_explored: BTreeMap<&Path, bool> =
            files.iter().enumerate().rev().map(|(index, input)| (input.path.as_path(), index < first_taught)).collect();
        let mut read = PlansRead::default();
        let mut plans: Vec<(Arc<Plan>, bool)> = Vec::new();
        let work = |input: &Input, import: Import| {
            let file = input.path.display().to_string();
            (FileRead::new(&file, store::content_of(&input.path), &import.plans, schemes, false), import.plans)
        };
        read.failed = batch::for_each_import(&files, "reading plans", terminal, work, |input, (file, of_file), _| {
            let explores = is_explored.get(input.path.as_path()).copied().unwrap_or_default();
            plans.extend(of_file.into_iter().map(|plan| (Arc::new(plan), explores)));
            read.add(file);
            Ok(())
        })?;
        read.put_together();
        report_repeats(&read.sightings, &read.repeats, false, terminal)?;
        for &(plan, room) in read.repeats.left_out.keys() {
            let id = read.sightings[plan].rooms[room].id;
            if let Some(room) = read.networks[plan].rooms.iter_mut().find(|room| room.id == id) {
                room.is_repeat = true;
            }
        }
        report_left_out(&read.left_out(), terminal)?;
        // A plan that was read before is neither explored twice nor learned from twice.
        let networks = std::mem::take(&mut read.networks);
        let mut plans: Vec<StudyPlan> = networks
            .into_iter()
            .zip(plans)
            .filter(|(network, _)| network.rooms.iter().any(|room| !room.is_repeat))
            .map(|(network, (plan, is_explored))| StudyPlan { plan, network, is_explored })
            .collect();
        for plan in &mut plans {
            plan.is_explored &= plan.plan.rooms().len() <= self.most_rooms;
        }
        draw(&mut plans, self.most_plans, self.seed);
        Ok((plans, read))
    }

    /// Performs the runs that are not kept from an earlier call; keeps each as soon as it is done.
    fn perform(
        &self,
        plans: &[StudyPlan],
        all: &[Run],
        outputs: &mut Outputs,
        terminal: &mut Terminal,
    ) -> Result<Vec<Record>, CliError> {
        let folder = self.output.join(RUNS_FOLDER);
        let keys: Vec<String> =
            all.iter().map(|run| run_key(super::VERSION, &plans[run.plan].plan, &run.condition, run.seed)).collect();
        let path = |key: &str| folder.join(format!("{key}.json"));
        let mut kept: BTreeMap<&str, Record> = BTreeMap::new();
        for key in &keys {
            let bytes = formats::read_bytes(&path(key)).ok();
            kept.extend(bytes.and_then(|bytes| Record::from_bytes(&bytes, key)).map(|record| (key.as_str(), record)));
        }
        // Equal runs, of a plan that is there twice, are done once.
        let mut missing: BTreeMap<&str, Run> = BTreeMap::new();
        for (key, run) in keys.iter().zip(all).filter(|(key, _)| !kept.contains_key(key.as_str())) {
            missing.insert(key, *run);
        }
        if !kept.is_empty() {
            terminal.remark(format!(
                "{} of {} runs are kept from an earlier call",
                kept.len(),
                kept.len() + missing.len()
            ))?;
        }
        let mut missing: Vec<(&str, Run)> = missing.into_iter().collect();
        missing.sort_by_key(|(_, run)| (run.plan, run.repeat));
        let quiet = match terminal.call.jobs {
            Some(threads) => Work::quiet().on_threads(threads),
            None => Work::quiet(),
        };
        let progress = Progress::new("exploring", missing.len(), terminal);
        let told = |done: usize, _: usize| progress.tell(done);
        let work = quiet.watched(&told, &progress.never);
        let (sender, receiver) = mpsc::channel::<(usize, Record)>();
        let mut saved: Result<(), CliError> = Ok(());
        let done = std::thread::scope(|scope| {
            let missing = &missing;
            let explored = scope.spawn(move || {
                work.map(missing.len(), |index| {
                    let (key, run) = missing[index];
                    let plan = &plans[run.plan].plan;
                    let record = explore(key.to_owned(), plan, &run.condition, run.seed, &work.alone());
                    if let Ok(record) = record {
                        // Nobody listens only once a run could not be saved.
                        let _ = sender.send((index, record));
                    }
                })
            });
            for (index, record) in receiver {
                let key = missing[index].0;
                let save = record
                    .to_bytes()
                    .map_err(CliError::from)
                    .and_then(|bytes| outputs.save(&path(key), &bytes, Care::Fast, terminal));
                if let (Err(error), true) = (save, saved.is_ok()) {
                    progress.never.store(true, std::sync::atomic::Ordering::Relaxed);
                    saved = Err(error);
                }
                kept.insert(key, record);
            }
            explored.join()
        });
        progress.clear();
        saved?;
        match done {
            Ok(done) => drop(done?),
            Err(panic) => std::panic::resume_unwind(panic),
        }
        let found: Option<Vec<Record>> = keys.iter().map(|key| kept.get(key.as_str()).cloned()).collect();
        found.ok_or_else(|| CliError::new("a run came to no end; please report this with the call"))
    }
}

/// Leaves at most so many plans of each typology to be explored, those with labelled rooms first.
fn draw(plans: &mut [StudyPlan], most: usize, seed: u64) {
    let mut order: Vec<usize> = (0..plans.len()).filter(|&index| plans[index].is_explored).collect();
    Random::new(seed).shuffle(&mut order);
    order.sort_by_key(|&index| plans[index].network.labelled().next().is_none());
    let mut taken: BTreeMap<_, usize> = BTreeMap::new();
    for index in order {
        let taken = taken.entry(plans[index].network.typology.clone()).or_default();
        plans[index].is_explored = *taken < most;
        *taken += 1;
    }
}
