use crate::labels::Label;

/// Probabilities of the five labels: none negative, summing to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution([f64; 5]);

impl Distribution {
    /// The weighted mean of distributions.
    pub fn mean(said: &[Self], weights: &[f64]) -> Self {
        let mut sums = [0.0; 5];
        for (said, weight) in said.iter().zip(weights) {
            for (sum, probability) in sums.iter_mut().zip(said.probabilities()) {
                *sum += weight * probability;
            }
        }
        Self::from_weights(sums)
    }

    /// All labels equally likely.
    pub const UNIFORM: Self = Self([0.2; 5]);

    /// The distribution proportional to weights, in the order of [`Label::ALL`]. Negative and non-finite
    /// weights count as 0; if all are 0 it is uniform.
    pub fn from_weights(weights: [f64; 5]) -> Self {
        let weights = weights.map(|weight| if weight.is_finite() { weight.max(0.0) } else { 0.0 });
        let sum: f64 = weights.iter().sum();
        if sum > 0.0 && sum.is_finite() { Self(weights.map(|weight| weight / sum)) } else { Self::UNIFORM }
    }

    /// Laplace's rule of succession: from counts of labels, `(n + strength * prior) / (N + strength)`.
    /// With `strength` 5 and the uniform prior this adds one to each label.
    pub fn smoothed(counts: [f64; 5], prior: &Self, strength: f64) -> Self {
        Self::from_weights(std::array::from_fn(|i| counts[i] + strength * prior.0[i]))
    }

    /// The probabilities in the order of [`Label::ALL`].
    pub const fn probabilities(&self) -> &[f64; 5] {
        &self.0
    }

    /// The probability of a label, 0..=1.
    pub const fn probability(&self, label: Label) -> f64 {
        self.0[label.index()]
    }

    /// The most probable label; if tied, the first in the order of [`Label::ALL`].
    pub fn label(&self) -> Label {
        let mut best = Label::ALL[0];
        for label in Label::ALL {
            if self.probability(label) > self.probability(best) {
                best = label;
            }
        }
        best
    }

    /// The most probable label with its probability, 0..=1.
    pub fn likeliest(&self) -> (Label, f64) {
        let label = self.label();
        (label, self.probability(label))
    }

    /// How probable the most probable label is, 0..=1.
    pub fn sureness(&self) -> f64 {
        self.likeliest().1
    }

    /// The distribution at a temperature: above 1 less certain, below 1 more certain. The order of the
    /// labels does not change. A temperature that is not a positive number changes nothing.
    pub fn at_temperature(self, temperature: f64) -> Self {
        if temperature == 1.0 || !(temperature.is_finite() && temperature > 0.0) {
            return self;
        }
        let most = self.sureness();
        Self::from_weights(self.0.map(|probability| (probability / most).powf(1.0 / temperature)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_become_probabilities_whatever_they_are() {
        let distribution = Distribution::from_weights([1.0, 3.0, 0.0, f64::NAN, -2.0]);
        assert_eq!(distribution.probabilities(), &[0.25, 0.75, 0.0, 0.0, 0.0]);
        assert_eq!(distribution.label(), Label::MediumRoom);
        for weights in [[0.0; 5], [f64::INFINITY; 5], [f64::MAX; 5], [f64::NAN; 5]] {
            assert_eq!(Distribution::from_weights(weights), Distribution::UNIFORM);
        }
    }

    #[test]
    fn laplace_adds_one_to_each_label() {
        let distribution = Distribution::smoothed([2.0, 0.0, 0.0, 0.0, 0.0], &Distribution::UNIFORM, 5.0);
        assert_eq!(distribution, Distribution::from_weights([3.0, 1.0, 1.0, 1.0, 1.0]));
    }

    #[test]
    fn temperature_keeps_the_order() {
        let distribution = Distribution::from_weights([1.0, 2.0, 3.0, 4.0, 0.0]);
        let cool = distribution.at_temperature(0.5);
        let warm = distribution.at_temperature(2.0);
        assert!(cool.probability(Label::Corridor) > 0.4 && warm.probability(Label::Corridor) < 0.4);
        assert!((cool.probability(Label::Corridor) / cool.probability(Label::MediumRoom) - 4.0).abs() < 1e-12);
        assert_eq!(distribution.at_temperature(f64::NAN), distribution);
        assert_eq!(warm.label(), Label::Corridor);
        assert_eq!(
            Distribution::from_weights([0.0, 1.0, 0.0, 0.0, 0.0]).at_temperature(3.0).label(),
            Label::MediumRoom
        );
    }
}
