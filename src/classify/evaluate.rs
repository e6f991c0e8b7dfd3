use super::{Algorithm, Classifier, Distribution, Scores};
use crate::base::random::seed_of_part;
use crate::base::work::{Cancelled, Work};
use crate::dataset::folds::Folds;
use crate::dataset::table::Table;

/// A cross-validation to run.
#[derive(Clone, Copy, Debug)]
pub struct Validation<'a> {
    pub table: &'a Table,
    /// Folds of the table's rows.
    pub folds: &'a Folds,
    pub algorithm: Algorithm,
    pub seed: u64,
}

/// The result of a cross-validation.
#[derive(Clone, Debug, PartialEq)]
pub struct Validated {
    /// For each row of the table, the prediction by the classifier that was not trained on it.
    pub predictions: Vec<Distribution>,
    pub scores: Scores,
}

/// Cross-validates: each fold is predicted by a classifier trained on the others. The same seed gives the
/// same result on any number of threads.
///
/// # Errors
/// When the work is cancelled.
pub fn evaluate(
    table: &Table,
    folds: &Folds,
    algorithm: Algorithm,
    seed: u64,
    work: &Work<'_>,
) -> Result<Validated, Cancelled> {
    let mut validated = evaluate_all(&[Validation { table, folds, algorithm, seed }], work)?;
    validated.pop().ok_or(Cancelled)
}

/// Runs several cross-validations at once, so that all threads are busy to the end. Progress counts
/// folds.
///
/// # Errors
/// When the work is cancelled.
pub fn evaluate_all(validations: &[Validation<'_>], work: &Work<'_>) -> Result<Vec<Validated>, Cancelled> {
    let parts: Vec<(&Validation<'_>, usize)> = validations
        .iter()
        .flat_map(|validation| (0..validation.folds.count()).map(move |fold| (validation, fold)))
        .collect();
    let mut predicted =
        work.map(parts.len(), |part| predict_fold(parts[part].0, parts[part].1, &work.alone()))?.into_iter();
    let gather = |validation: &Validation<'_>| {
        let mut predictions = vec![Distribution::UNIFORM; validation.table.len()];
        for fold in predicted.by_ref().take(validation.folds.count()) {
            for (row, prediction) in fold? {
                predictions[row] = prediction;
            }
        }
        let rows = validation.folds.of_rows().iter().zip(&predictions).zip(validation.table.labels());
        let scores = Scores::of(rows.map(|((&fold, prediction), &truth)| (fold, prediction, truth)));
        Ok(Validated { predictions, scores })
    };
    validations.iter().map(gather).collect()
}

/// The predictions of one fold's rows.
fn predict_fold(
    validation: &Validation<'_>,
    fold: usize,
    work: &Work<'_>,
) -> Result<Vec<(usize, Distribution)>, Cancelled> {
    let Validation { table, folds, algorithm, seed } = *validation;
    // Every fold has a row, and there are at least two: there is always something to train on.
    let Some(training) = table.subset(&folds.training_rows(fold)) else { return Ok(Vec::new()) };
    let classifier = Classifier::train(algorithm, &training, seed_of_part(seed, fold), work)?;
    let predict = |row: usize| Some((row, classifier.predict(table.values().get(row)?)));
    Ok(folds.test_rows(fold).into_iter().filter_map(predict).collect())
}

/// The scores of a trained classifier on rooms not in its training set: another data set, say.
pub fn test(classifier: &Classifier, table: &Table) -> Validated {
    let predictions: Vec<Distribution> = table.values().iter().map(|values| classifier.predict(values)).collect();
    let scores = Scores::of(predictions.iter().zip(table.labels()).map(|(prediction, &truth)| (0, prediction, truth)));
    Validated { predictions, scores }
}
