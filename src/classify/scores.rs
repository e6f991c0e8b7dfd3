use serde::{Deserialize, Serialize};

use super::Distribution;
use super::calibration::{brier, log_loss};
use crate::labels::Label;

/// Number of equal bins of the reliability diagram, 0 to 1.
const BINS: usize = 10;

/// How predictions compare with the truth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// Number of rooms tested.
    pub rooms: usize,
    /// Share of rooms with the right label, 0..=1.
    pub accuracy: f64,
    /// Standard deviation of the folds' accuracies (n - 1 in the denominator); 0 with one fold.
    pub accuracy_deviation: f64,
    /// Each fold's own figures.
    pub folds: Vec<FoldScore>,
    pub confusion: Confusion,
    /// Mean of [`log_loss`].
    pub log_loss: f64,
    /// Mean of [`brier`].
    pub brier: f64,
    /// Mean distance between the probability of the predicted label and the share that was right, over
    /// the bins of the reliability diagram, weighted by their rooms.
    pub calibration_error: f64,
    /// The reliability diagram: bins of the probability of the predicted label, including empty ones.
    pub reliability: Vec<ReliabilityBin>,
}

/// One fold's figures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoldScore {
    pub rooms: usize,
    /// Rooms with the right label.
    pub right: usize,
}

impl FoldScore {
    /// Share of rooms with the right label, 0..=1; 0 if there are no rooms.
    pub fn accuracy(&self) -> f64 {
        share(self.right as f64, self.rooms as f64)
    }
}

/// One bin of the reliability diagram.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReliabilityBin {
    /// The bin holds probabilities from this...
    pub from: f64,
    /// ...to this.
    pub to: f64,
    pub rooms: usize,
    /// Mean probability of the predicted label.
    pub probability: f64,
    /// Share of rooms with the right label.
    pub right: f64,
}

/// How often rooms of each true label (row) got each label (column), in the order of [`Label::ALL`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Confusion(pub [[usize; 5]; 5]);

/// The rates of one label in the terms of the paper's Table 1, each 0..=1. Note that the paper's FP is
/// usually called the miss rate, and its FN the false-positive rate: of the rooms with the label, TP got
/// it and FP got another; of the rooms without it, TN did not get it and FN did. (Four cells of the
/// printed table, C of houses and offices and S of schools and of all, do not follow from its matrices
/// this way; the other sixteen do.)
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TableRates {
    pub tp: f64,
    pub fp: f64,
    pub tn: f64,
    #[serde(rename = "fn")]
    pub fn_: f64,
}

/// Numbers of rooms for one label in the usual terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct LabelCounts {
    pub true_positives: usize,
    pub false_positives: usize,
    pub true_negatives: usize,
    pub false_negatives: usize,
}

/// How well one label is told, each 0..=1, 0 where nothing is there to divide by.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LabelRates {
    /// Rooms with the label.
    pub rooms: usize,
    /// Of the rooms with the label, those that got it.
    pub recall: f64,
    /// Of the rooms that got the label, those that have it.
    pub precision: f64,
    /// The harmonic mean of both.
    pub f1: f64,
}

impl Confusion {
    /// Number of rooms.
    pub fn rooms(&self) -> usize {
        self.0.iter().flatten().sum()
    }

    /// Number of rooms with the right label.
    pub fn right(&self) -> usize {
        (0..5).map(|label| self.0[label][label]).sum()
    }

    /// Numbers for one label in the usual terms.
    pub fn counts(&self, label: Label) -> LabelCounts {
        let label = label.index();
        let true_positives = self.0[label][label];
        let with_label: usize = self.0[label].iter().sum();
        let given: usize = self.0.iter().map(|row| row[label]).sum();
        LabelCounts {
            true_positives,
            false_positives: given - true_positives,
            false_negatives: with_label - true_positives,
            true_negatives: self.rooms() + true_positives - with_label - given,
        }
    }

    /// The mean over the labels that occur of the share of their rooms that is right, 0..=1; 0 without rooms.
    pub fn balanced_accuracy(&self) -> f64 {
        let rates = Label::ALL.map(|label| self.label_rates(label));
        let occurring: Vec<f64> = rates.iter().filter(|rates| rates.rooms > 0).map(|rates| rates.recall).collect();
        share(occurring.iter().sum(), occurring.len() as f64)
    }

    /// How well one label is told.
    pub fn label_rates(&self, label: Label) -> LabelRates {
        let counts = self.counts(label);
        let (found, rooms) = (counts.true_positives as f64, counts.true_positives + counts.false_negatives);
        let given = (counts.true_positives + counts.false_positives) as f64;
        LabelRates {
            rooms,
            recall: share(found, rooms as f64),
            precision: share(found, given),
            f1: share(2.0 * found, given + rooms as f64),
        }
    }

    /// Rates of one label in the terms of the paper's Table 1. TP and FP need rooms with the label, TN
    /// and FN rooms without it: otherwise both are 0.
    pub fn table_rates(&self, label: Label) -> TableRates {
        let counts = self.counts(label);
        let with_label = (counts.true_positives + counts.false_negatives) as f64;
        let without = (counts.true_negatives + counts.false_positives) as f64;
        TableRates {
            tp: share(counts.true_positives as f64, with_label),
            fp: share(counts.false_negatives as f64, with_label),
            tn: share(counts.true_negatives as f64, without),
            fn_: share(counts.false_positives as f64, without),
        }
    }

    /// Each row as shares of its sum, as printed in Table 1; 0 for a row without rooms.
    pub fn row_shares(&self) -> [[f64; 5]; 5] {
        self.0.map(|row| {
            let sum: usize = row.iter().sum();
            row.map(|count| share(count as f64, sum as f64))
        })
    }
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

impl Scores {
    /// Scores predictions. Each item is the fold (from 0), the prediction and the truth.
    pub fn of<'a>(predictions: impl IntoIterator<Item = (usize, &'a Distribution, Label)>) -> Self {
        let mut folds: Vec<FoldScore> = Vec::new();
        let mut confusion = Confusion::default();
        let (mut log_losses, mut briers) = (0.0, 0.0);
        // For each bin: rooms, correct ones, and the sum of probabilities.
        let mut bins = [(0usize, 0usize, 0.0); BINS];
        for (fold, distribution, truth) in predictions {
            let given = distribution.label();
            let right = usize::from(given == truth);
            if folds.len() <= fold {
                folds.resize(fold + 1, FoldScore { rooms: 0, right: 0 });
            }
            folds[fold].rooms += 1;
            folds[fold].right += right;
            confusion.0[truth.index()][given.index()] += 1;
            log_losses += log_loss(distribution, truth);
            briers += brier(distribution, truth);
            let probability = distribution.probability(given);
            let bin = &mut bins[((probability * BINS as f64) as usize).min(BINS - 1)];
            bin.0 += 1;
            bin.1 += right;
            bin.2 += probability;
        }
        let rooms = confusion.rooms();
        let all = rooms as f64;
        let accuracies: Vec<f64> = folds.iter().filter(|fold| fold.rooms > 0).map(FoldScore::accuracy).collect();
        let reliability: Vec<ReliabilityBin> = bins
            .iter()
            .enumerate()
            .map(|(index, &(rooms, right, probabilities))| ReliabilityBin {
                from: index as f64 / BINS as f64,
                to: (index + 1) as f64 / BINS as f64,
                rooms,
                probability: share(probabilities, rooms as f64),
                right: share(right as f64, rooms as f64),
            })
            .collect();
        let gap = |bin: &ReliabilityBin| (bin.probability - bin.right).abs() * bin.rooms as f64;
        Self {
            rooms,
            accuracy: share(confusion.right() as f64, all),
            accuracy_deviation: deviation(&accuracies),
            folds,
            confusion,
            log_loss: share(log_losses, all),
            brier: share(briers, all),
            calibration_error: share(reliability.iter().map(gap).sum(), all),
            reliability,
        }
    }
}

/// The sample standard deviation; 0 for fewer than two numbers.
fn deviation(numbers: &[f64]) -> f64 {
    let n = numbers.len() as f64;
    if n < 2.0 {
        return 0.0;
    }
    let mean = numbers.iter().sum::<f64>() / n;
    (numbers.iter().map(|number| (number - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure(label: Label, probability: f64) -> Distribution {
        let rest = (1.0 - probability) / 4.0;
        let mut weights = [rest; 5];
        weights[label.index()] = probability;
        Distribution::from_weights(weights)
    }

    #[test]
    fn scores_follow_from_the_predictions() {
        let (small, hall) = (Label::SmallRoom, Label::Hall);
        let said = [sure(small, 0.9), sure(small, 0.7), sure(hall, 0.7), sure(small, 0.9)];
        let truths = [(0, small), (0, hall), (1, hall), (1, small)];
        let scores = Scores::of(truths.iter().zip(&said).map(|(&(fold, truth), said)| (fold, said, truth)));
        assert_eq!((scores.rooms, scores.accuracy), (4, 0.75));
        assert!((scores.accuracy_deviation - 0.5f64.sqrt() / 2.0).abs() < 1e-12);
        assert_eq!(scores.folds[0], FoldScore { rooms: 2, right: 1 });
        let expected = -(0.9f64.ln() * 2.0 + 0.7f64.ln() + 0.075f64.ln()) / 4.0;
        assert!((scores.log_loss - expected).abs() < 1e-12);
        // At 0.9 all are right, at 0.7 half.
        assert!((scores.calibration_error - (0.1 + 0.2) / 2.0).abs() < 1e-12);
        let counts = scores.confusion.counts(small);
        assert_eq!((counts.true_positives, counts.false_positives), (2, 1));
        assert_eq!((counts.true_negatives, counts.false_negatives), (1, 0));
        let rates = scores.confusion.table_rates(hall);
        assert_eq!((rates.tp, rates.fp, rates.tn, rates.fn_), (0.5, 0.5, 1.0, 0.0));
        // Both small rooms are found, one of two halls; three rooms are said to be small, two rightly.
        assert_eq!(scores.confusion.balanced_accuracy(), 0.75);
        let rates = scores.confusion.label_rates(small);
        assert_eq!((rates.rooms, rates.recall, rates.precision, rates.f1), (2, 1.0, 2.0 / 3.0, 0.8));
    }

    #[test]
    fn nothing_scores_nothing() {
        let scores = Scores::of([]);
        assert_eq!((scores.rooms, scores.accuracy, scores.log_loss, scores.calibration_error), (0, 0.0, 0.0, 0.0));
    }

    /// The paper's Table 1 for houses, weighted by the shares of its Table 2, gives the rates it prints
    /// for halls, small, medium and big rooms.
    #[test]
    fn table_rates_mean_what_the_paper_means() {
        use Label::{BigRoom, Corridor, Hall, MediumRoom, SmallRoom};
        let rows = [
            (SmallRoom, 28.0, [91.4, 4.5, 0.0, 3.8, 0.3]),
            (MediumRoom, 26.3, [8.1, 83.4, 4.3, 3.7, 0.4]),
            (BigRoom, 13.7, [0.0, 5.4, 86.5, 1.0, 7.1]),
            (Corridor, 23.9, [1.7, 3.5, 1.3, 92.3, 1.2]),
            (Hall, 8.0, [0.0, 0.7, 8.2, 3.0, 88.0]),
        ];
        let mut confusion = Confusion::default();
        for (label, weight, row) in rows {
            confusion.0[label.index()] = row.map(|percent: f64| (percent * weight * 100.0).round() as usize);
        }
        for (label, printed) in [(Hall, 1.5), (SmallRoom, 3.7), (MediumRoom, 3.9), (BigRoom, 2.5)] {
            let rates = confusion.table_rates(label);
            assert!((rates.fn_ * 100.0 - printed).abs() < 0.25, "{label}: {}", rates.fn_ * 100.0);
            assert!((rates.tn + rates.fn_ - 1.0).abs() < 1e-12 && (rates.tp + rates.fp - 1.0).abs() < 1e-12);
        }
    }
}
