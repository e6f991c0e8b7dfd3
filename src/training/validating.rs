//! Cross-validation before the training.

use std::collections::BTreeSet;

use super::{Order, TrainError, Watcher};
use crate::base::work::Cancelled;
use crate::classify::joint::{self, JointTrainError, JointValidationError};
use crate::classify::{Algorithm, Method, Scores};
use crate::dataset::folds::{Folds, Grouping};
use crate::dataset::sets::{plans_of, set_name};
use crate::dataset::{Collection, RoomNetwork};
use crate::features::NeighbourLabels;
use crate::study::predictions::Prediction;
use crate::study::{Cell, Condition, FoldTold, Options, StudyError, Validation, validate_telling};

/// The scores of each method, and the unit assigned to folds.
pub(super) type ScoresOf = Vec<(Method, (Grouping, Scores))>;

/// What cross-validation found.
#[derive(Default)]
pub(super) struct Validated {
    pub scores: ScoresOf,
    pub said: Vec<Prediction>,
    /// What the committees that take part in blends said.
    pub by_committees: Vec<Prediction>,
}

/// What an error of the joint classifier means here.
pub(super) fn joint_error(error: JointTrainError) -> TrainError {
    match error {
        JointTrainError::Cancelled => TrainError::Cancelled,
        error => TrainError::Data(error.to_string()),
    }
}

/// The scores of cross-validation, by room and by building as ordered; remarks on what could not be done.
/// The joint classifier is trained on whole plans, so only by building.
pub(super) fn validated<W: Watcher>(
    part: &Collection,
    set: &str,
    methods: &[Method],
    neighbours: NeighbourLabels,
    order: &Order,
    watcher: &mut W,
) -> Result<Validated, W::Error> {
    let Validated { mut scores, said: mut predictions, mut by_committees } = Validated::default();
    if order.folds == 0 || order.groupings.is_empty() {
        return Ok(Validated::default());
    }
    let told = watcher.folds(set);
    let algorithms: Vec<Algorithm> =
        Algorithm::ALL.into_iter().filter(|&algorithm| methods.contains(&Method::Each(algorithm))).collect();
    if !algorithms.is_empty() {
        let first = order.groupings.first().copied().unwrap_or(Grouping::Room);
        let (grouping, given) = (order.given.unwrap_or(first), order.given.is_some());
        let options = Options { folds: order.folds, neighbours, seed: order.seed, grouping, given };
        let conditions: Vec<Condition> = order.groupings.iter().map(|&by| Condition { by, neighbours }).collect();
        // A single typology makes a set with its own name, never a standard one.
        let typologies = part.typologies();
        let of_part = if typologies.len() == 1 { set_name(typologies.first()).to_owned() } else { set.to_owned() };
        let result = watcher.step(&format!("testing on {}", plans_of(set)), |work| {
            validate_telling(part, options, &of_part, &algorithms, &conditions, &*told, work)
        });
        match result {
            Ok(Validation { cells, notes, predictions: said, by_committees: together }) => {
                let of_part_alone = |said: Vec<Prediction>| -> Vec<Prediction> {
                    let said = said.into_iter().filter(|it| it.set == of_part);
                    said.map(|it| Prediction { set: set.to_owned(), ..it }).collect()
                };
                predictions = of_part_alone(said);
                by_committees = of_part_alone(together);
                for note in notes.iter().filter(|note| note.starts_with(&of_part)) {
                    watcher.remark(note)?;
                }
                let of_cell = |cell: Cell| (Method::Each(cell.algorithm), (cell.condition.by, cell.scores));
                scores.extend(cells.into_iter().map(of_cell));
            }
            Err(StudyError::Cancelled) => return Err(TrainError::Cancelled.into()),
            Err(StudyError::Data(what)) => watcher.remark(&format!("{set}: not validated: {what}"))?,
        }
    }
    if methods.contains(&Method::Joint) {
        let networks: Vec<&RoomNetwork> = part.networks().iter().collect();
        let condition = Condition { by: Grouping::Building, neighbours: NeighbourLabels::Predicted };
        let hear = |score| told(FoldTold { method: Method::Joint, condition, score });
        let result = watcher.step(&format!("testing on {}: {}", plans_of(set), Method::Joint.title()), |work| {
            let given = part.given_folds().filter(|_| order.given == Some(Grouping::Building));
            let folds = match given {
                Some(folds) => Folds::given(folds).map_err(JointValidationError::Folds)?,
                None => joint::folds_of(&networks, order.folds.min(buildings(&networks)), order.seed)?,
            };
            joint::cross_validate_telling(&networks, &folds, order.seed, &hear, work)
        });
        match result {
            Ok(validated) => {
                let said = validated.predictions.iter().zip(&validated.folds).enumerate();
                predictions.extend(said.map(|(row, (said, &fold))| Prediction {
                    row,
                    set: set.to_owned(),
                    method: Method::Joint,
                    condition,
                    fold,
                    said: *said,
                }));
                scores.push((Method::Joint, (Grouping::Building, validated.scores)));
            }
            Err(JointValidationError::Cancelled) => return Err(TrainError::from(Cancelled).into()),
            Err(error) => watcher.remark(&format!("{set}, joint classifier: not validated: {error}"))?,
        }
    }
    Ok(Validated { scores, said: predictions, by_committees })
}

/// Number of buildings with a labelled room.
fn buildings(networks: &[&RoomNetwork]) -> usize {
    let labelled = networks.iter().filter(|network| network.labelled().next().is_some());
    labelled.map(|network| network.group.as_str()).collect::<BTreeSet<_>>().len()
}
