//! Running a study: every fold, foreign test and point of a curve is a separate task, so that all threads
//! are busy to the end and progress is even.

use std::sync::{Mutex, PoisonError};

use super::compare::Results;
use super::measure::{Experiment, Outcome, Task};
use super::predictions::Prediction;
use super::typologies::infer_typologies;
use super::{Cell, Condition, Curve, HONEST, Options, Study, StudyError};
use crate::base::random::Random;
use crate::base::work::{Cancelled, Work};
use crate::classify::{Algorithm, FoldScore, Method};
use crate::dataset::{Collection, RoomNetwork};

/// Studies a collection. `blind` are the same plans as [`RoomNetwork::without_typology`] sees them;
/// without them, the inference of the typology is not measured. `work` receives the number of tasks done;
/// they run in random order, so that progress is roughly proportional to time.
///
/// # Errors
/// When there is too little data for even one cross-validation, or the work is cancelled.
pub fn study(
    collection: &Collection,
    blind: &[RoomNetwork],
    options: Options,
    work: &Work<'_>,
) -> Result<Study, StudyError> {
    Ok(study_with_predictions(collection, blind, options, work)?.0)
}

/// The same, and what was said of each room out of fold under the honest condition and under the main one.
///
/// # Errors
/// As [`study`].
pub fn study_with_predictions(
    collection: &Collection,
    blind: &[RoomNetwork],
    options: Options,
    work: &Work<'_>,
) -> Result<(Study, Vec<Prediction>), StudyError> {
    let experiment = Experiment::new(collection, options)?;
    let mut tasks = experiment.tasks();
    Random::new(options.seed).shuffle(&mut tasks);
    let results = perform(&experiment, tasks, work)?;
    let mut study = experiment.gather(&results);
    let inferred = infer_typologies(collection, blind, options, work)?;
    (study.typologies, study.typology_ways) = inferred;
    let told: Vec<Condition> = study.honest.into_iter().filter(|honest| *honest != study.condition).collect();
    let conditions: Vec<Condition> = told.into_iter().chain([study.condition]).collect();
    Ok((study, experiment.predictions(&results, &conditions)))
}

/// What a cross-validation found.
pub struct Validation {
    pub cells: Vec<Cell>,
    /// What could not be measured.
    pub notes: Vec<String>,
    /// What was said of each room out of fold.
    pub predictions: Vec<Prediction>,
    /// The same of the committees that take part in blends; empty unless all algorithms were asked for, [`HONEST`].
    pub by_committees: Vec<Prediction>,
}

/// Cross-validates some algorithms on one set under some conditions, without the rest of a study.
/// Conditions that cannot be measured are left out and named in the notes.
///
/// # Errors
/// As [`study`].
pub fn validate(
    collection: &Collection,
    options: Options,
    set: &str,
    algorithms: &[Algorithm],
    conditions: &[Condition],
    work: &Work<'_>,
) -> Result<Validation, StudyError> {
    validate_telling(collection, options, set, algorithms, conditions, &|_| {}, work)
}

/// A fold that was tested.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldTold {
    pub method: Method,
    pub condition: Condition,
    pub score: FoldScore,
}

/// The same as [`validate`]; `told` hears of each fold when it is done, from any thread.
///
/// # Errors
/// As [`study`].
pub fn validate_telling(
    collection: &Collection,
    options: Options,
    set: &str,
    algorithms: &[Algorithm],
    conditions: &[Condition],
    told: &(dyn Fn(FoldTold) + Sync),
    work: &Work<'_>,
) -> Result<Validation, StudyError> {
    let experiment = Experiment::new(collection, options)?;
    let all = experiment.conditions();
    let is_wanted = |task: &Task| match *task {
        Task::Fold { condition, set: of, algorithm, .. } => {
            experiment.sets[of].name == set && algorithms.contains(&algorithm) && conditions.contains(&all[condition])
        }
        Task::Committee { set: of, .. } => {
            // Blends are made where all learn, and tested on buildings never seen.
            let is_for_blend = algorithms.len() == Algorithm::ALL.len() && conditions.contains(&HONEST);
            experiment.sets[of].name == set && is_for_blend
        }
        Task::Foreign { .. }
        | Task::Point { .. }
        | Task::Joint { .. }
        | Task::JointPoint { .. }
        | Task::Unknown { .. } => false,
    };
    let tasks: Vec<Task> = experiment.tasks().into_iter().filter(is_wanted).collect();
    let heard = |task: Task, outcome: &Outcome| {
        if let (Task::Fold { condition, algorithm, .. }, Outcome::Predicted(said, _)) = (task, outcome) {
            let right = said.iter().filter(|(row, said)| said.label() == experiment.rows[*row].label).count();
            let score = FoldScore { rooms: said.len(), right };
            told(FoldTold { method: Method::Each(algorithm), condition: all[condition], score });
        }
    };
    let results = perform_telling(&experiment, tasks, &heard, work)?;
    let cells = experiment.cells(&results).into_iter().filter(|cell| cell.scores.rooms > 0).collect();
    let predictions = experiment.predictions(&results, conditions);
    let by_committees = experiment.by_committees(&results);
    Ok(Validation { cells, notes: experiment.notes, predictions, by_committees })
}

/// The learning curve of an algorithm on one set: accuracy after learning from parts of the rooms, with the folds of
/// the options. `None` where it cannot be measured.
///
/// # Errors
/// As [`study`].
pub fn learning_curve(
    collection: &Collection,
    options: Options,
    set: &str,
    algorithm: Algorithm,
    work: &Work<'_>,
) -> Result<Option<Curve>, StudyError> {
    learning_curve_telling(collection, options, set, algorithm, &|_| {}, work)
}

/// The same as [`learning_curve`]; `told` hears of the curve so far after each part, from any thread.
///
/// # Errors
/// As [`study`].
pub fn learning_curve_telling(
    collection: &Collection,
    options: Options,
    set: &str,
    algorithm: Algorithm,
    told: &(dyn Fn(Curve) + Sync),
    work: &Work<'_>,
) -> Result<Option<Curve>, StudyError> {
    let experiment = Experiment::new(collection, options)?;
    let Some(at) = experiment.sets.iter().position(|of| of.name == set) else { return Ok(None) };
    let is_wanted =
        |task: &Task| matches!(*task, Task::Point { set: of, algorithm: by, .. } if of == at && by == algorithm);
    let tasks: Vec<Task> = experiment.tasks().into_iter().filter(is_wanted).collect();
    let so_far = Mutex::new(Results::new(Vec::new(), Vec::new()));
    let heard = |task: Task, outcome: &Outcome| {
        let Outcome::Point(learned, tested, right) = *outcome else { return };
        let mut so_far = so_far.lock().unwrap_or_else(PoisonError::into_inner);
        so_far.add(task, Outcome::Point(learned, tested, right));
        so_far.curve(&experiment.sets[at], at, algorithm).into_iter().for_each(told);
    };
    let results = perform_telling(&experiment, tasks, &heard, work)?;
    Ok(results.curve(&experiment.sets[at], at, algorithm))
}

fn perform(experiment: &Experiment<'_>, tasks: Vec<Task>, work: &Work<'_>) -> Result<Results, Cancelled> {
    perform_telling(experiment, tasks, &|_, _| {}, work)
}

fn perform_telling(
    experiment: &Experiment<'_>,
    tasks: Vec<Task>,
    heard: &(dyn Fn(Task, &Outcome) + Sync),
    work: &Work<'_>,
) -> Result<Results, Cancelled> {
    let outcomes = work.map(tasks.len(), |index| {
        let outcome = experiment.perform(tasks[index], &work.alone());
        if let Ok(outcome) = &outcome {
            heard(tasks[index], outcome);
        }
        outcome
    })?;
    Ok(Results::new(tasks, outcomes.into_iter().collect::<Result<_, _>>()?))
}
