//! Are the probabilities trustworthy? Proper scores, and the temperature that improves them.

use super::Distribution;
use crate::labels::Label;

/// Smaller probabilities are raised to this, so that one impossible surprise does not make the mean
/// infinite.
const LEAST_PROBABILITY: f64 = 1e-9;

/// The negative logarithm of the probability given to the truth, in nats: 0 is perfect, ln 5 = 1.61 is
/// complete ignorance.
pub fn log_loss(distribution: &Distribution, truth: Label) -> f64 {
    -distribution.probability(truth).max(LEAST_PROBABILITY).ln()
}

/// The squared distance between the probabilities and the truth, summed over the labels (Brier 1950): 0
/// is perfect, 0.8 is complete ignorance, 2 is certainty of the wrong label.
pub fn brier(distribution: &Distribution, truth: Label) -> f64 {
    let squares: f64 = distribution.probabilities().iter().map(|probability| probability * probability).sum();
    squares + 1.0 - 2.0 * distribution.probability(truth)
}

/// Temperatures tried: from twice as sure to four times less sure. Anything outside is noise.
const TEMPERATURES: std::ops::RangeInclusive<f64> = 0.5..=4.0;

/// With fewer rooms to fit on, the temperature stays 1.
const LEAST_ROOMS: usize = 30;

/// The temperature with the least log loss on predictions of rooms not in the training set (Platt scaling
/// with one parameter, Guo et al. 2017).
pub(super) fn fitted_temperature(predictions: impl Iterator<Item = (Distribution, Label)>) -> f64 {
    let predictions: Vec<(Distribution, Label)> = predictions.collect();
    if predictions.len() < LEAST_ROOMS {
        return 1.0;
    }
    let loss = |temperature: f64| -> f64 {
        predictions
            .iter()
            .map(|(distribution, truth)| log_loss(&distribution.at_temperature(temperature), *truth))
            .sum()
    };
    // Golden-section search: the loss has one minimum in 1 / temperature. Twenty steps leave 0.0001 of
    // the interval, which even high temperatures need for their two decimals.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = (1.0 / TEMPERATURES.end(), 1.0 / TEMPERATURES.start());
    let (mut p, mut q) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut loss_p, mut loss_q) = (loss(1.0 / p), loss(1.0 / q));
    for _ in 0..20 {
        if loss_p <= loss_q {
            (high, q, loss_q) = (q, p, loss_p);
            p = high - GOLDEN * (high - low);
            loss_p = loss(1.0 / p);
        } else {
            (low, p, loss_p) = (p, q, loss_q);
            q = low + GOLDEN * (high - low);
            loss_q = loss(1.0 / q);
        }
    }
    let temperature = 2.0 / (low + high);
    // Two decimals match its accuracy, and are readable.
    (temperature * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_have_their_known_ends() {
        let sure = Distribution::from_weights([1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!((log_loss(&sure, Label::SmallRoom), brier(&sure, Label::SmallRoom)), (0.0, 0.0));
        assert_eq!(brier(&sure, Label::Hall), 2.0);
        assert!(log_loss(&sure, Label::Hall).is_finite());
        let clueless = Distribution::UNIFORM;
        assert!((log_loss(&clueless, Label::Hall) - 5f64.ln()).abs() < 1e-12);
        assert!((brier(&clueless, Label::Hall) - 0.8).abs() < 1e-12);
    }

    #[test]
    fn boasting_is_cooled_down() {
        // Right in 3 of 4 but claiming 99 %: an honest temperature brings that to 75 %.
        let boast = Distribution::from_weights([0.99, 0.01, 0.0, 0.0, 0.0]);
        let truth = |i: usize| if i.is_multiple_of(4) { Label::MediumRoom } else { Label::SmallRoom };
        let temperature = fitted_temperature((0..400).map(|i| (boast, truth(i))));
        let told = boast.at_temperature(temperature).probability(Label::SmallRoom);
        assert!((told - 0.75).abs() < 0.01, "{temperature} gives {told}");
        assert_eq!(fitted_temperature((0..10).map(|i| (boast, truth(i)))), 1.0);
    }
}
