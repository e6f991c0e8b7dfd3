//! A multilayer perceptron: one hidden layer with leaky ReLU, softmax and cross-entropy, trained with
//! Adam (Kingma and Ba 2015), decoupled weight decay (Loshchilov and Hutter 2019) and early stopping on
//! held-out rooms.
//!
//! Arrays rather than nalgebra matrices: a batch of 32 rooms takes 4 µs, against 12 µs as six products of
//! `SMatrix`, which also differ in the last bits.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::numbers::lower_median;
use crate::base::random::Random;
use crate::base::work::{Cancelled, Round, Work};
use crate::classify::Distribution;
use crate::classify::calibration::fitted_temperature;
use crate::classify::explain::{Effect, FeaturesReason, Reason};
use crate::classify::learner::{Learner, Model, Trained};
use crate::classify::scale::{Scale, Transform};
use crate::dataset::folds::Folds;
use crate::dataset::table::{FEATURES, Table, Values};
use crate::labels::Label;

/// Hidden units: more did not help, and 16 fills whole vector registers.
pub const HIDDEN: usize = 16;

const LABELS: usize = Label::ALL.len();

/// One in this many training rooms is held out for early stopping.
const KEPT_APART: usize = 8;

/// With fewer rooms than this none are held out: too few would tell too little.
const LEAST_TO_KEEP_APART: usize = 40;

/// Batch size.
const BATCH: usize = 32;

/// Initial learning rate; it falls to zero along a half cosine.
const STEP: f32 = 0.02;

/// Weight decay per step, as a share of the learning rate.
const DECAY: f32 = 0.02;

/// Total rooms to visit, which sets the number of epochs...
const VISITS: usize = 120_000;

/// ...within these bounds.
const ROUNDS: std::ops::RangeInclusive<usize> = 16..=80;

/// Training stops after this many epochs without improvement.
const PATIENCE: usize = 12;

/// Slope of a hidden unit for negative sums, so that it never dies.
const LEAK: f32 = 0.1;

/// The learner.
pub struct Backpropagation;

impl Learner for Backpropagation {
    fn id(&self) -> &'static str {
        "mlp"
    }

    fn title(&self) -> &'static str {
        "multilayer perceptron"
    }

    fn short_title(&self) -> &'static str {
        "Perceptron"
    }

    fn help(&self) -> &'static str {
        "a small neural network, each room by itself"
    }

    fn train(&self, table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled> {
        Ok(Perceptron::train(table, seed, work)?.shared())
    }

    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>> {
        Some(Arc::new(Perceptron::read(model)?))
    }
}

impl Perceptron {
    /// Reads the net that its [`Model::to_json`] wrote; `None` if the data are not a valid one.
    pub fn read(model: Value) -> Option<Self> {
        let DiskPerceptron { scale, typical, units, output_bias } = serde_json::from_value(model).ok()?;
        let units: [DiskUnit; HIDDEN] = units.try_into().ok()?;
        let hidden = std::array::from_fn(|input| {
            std::array::from_fn(|unit: usize| {
                let DiskUnit { from, bias, .. } = &units[unit];
                from.get(input).copied().unwrap_or(*bias) as f32
            })
        });
        let output = std::array::from_fn(|label| std::array::from_fn(|unit: usize| units[unit].to[label] as f32));
        let weights = Weights { hidden, output, output_bias: output_bias.map(|bias| bias as f32) };
        let scale = Scale {
            transform: Transform::from_name(&scale.transform)?,
            means: scale.means,
            deviations: scale.deviations,
        };
        Self::from_parts(scale, weights, typical)
    }
}

impl Model for Perceptron {
    fn predict(&self, values: &Values) -> Distribution {
        self.predict(values)
    }

    fn explain(&self, values: &Values, label: Label, predict: &dyn Fn(&Values) -> Distribution) -> Reason {
        let effect = |feature: usize| {
            let mut changed = *values;
            changed[feature] = self.typical[feature];
            Effect { feature, value: values[feature], typical: self.typical[feature], if_typical: predict(&changed) }
        };
        let mut effects: Vec<Effect> = (0..FEATURES).map(effect).collect();
        effects.sort_by(|p, q| p.if_typical.probability(label).total_cmp(&q.if_typical.probability(label)));
        Reason::Features(FeaturesReason { effects })
    }

    fn to_json(&self) -> Value {
        let Scale { transform, means, deviations } = self.scale.clone();
        let weights = &self.weights;
        let unit = |unit: usize| DiskUnit {
            from: std::array::from_fn(|input| short(weights.hidden[input][unit])),
            bias: short(weights.hidden[FEATURES][unit]),
            to: std::array::from_fn(|label| short(weights.output[label][unit])),
        };
        let disk = DiskPerceptron {
            scale: DiskScale { transform: transform.name().to_owned(), means, deviations },
            typical: self.typical,
            units: (0..HIDDEN).map(unit).collect(),
            output_bias: weights.output_bias.map(short),
        };
        // Plain structs of numbers and texts can always be written.
        serde_json::to_value(disk).unwrap_or_default()
    }
}

#[derive(Serialize, Deserialize)]
struct DiskPerceptron {
    scale: DiskScale,
    typical: Values,
    units: Vec<DiskUnit>,
    output_bias: [f64; LABELS],
}

#[derive(Serialize, Deserialize)]
struct DiskScale {
    transform: String,
    means: Values,
    deviations: Values,
}

/// A hidden unit: its weights from each input, its bias, its weights to each label.
#[derive(Serialize, Deserialize)]
struct DiskUnit {
    from: [f64; FEATURES],
    bias: f64,
    to: [f64; LABELS],
}

/// The value as the shortest decimal that reads back the same.
fn short(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

/// A trained net.
#[derive(Clone, Debug, PartialEq)]
pub struct Perceptron {
    scale: Scale,
    weights: Weights,
    /// The median of each feature over the training rooms: what explanations compare with.
    typical: Values,
}

/// The weights of a net; gradients and the optimiser's averages have the same shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// To each hidden unit from each input, the last row the biases.
    pub hidden: [[f32; HIDDEN]; FEATURES + 1],
    /// To each label from each hidden unit.
    pub output: [[f32; HIDDEN]; LABELS],
    pub output_bias: [f32; LABELS],
}

/// The hidden units' part of a forward pass.
struct Hidden {
    /// The outputs of the hidden units.
    given: [f32; HIDDEN],
    /// Their slopes.
    slope: [f32; HIDDEN],
}

/// The forward pass for one room.
struct Pass {
    hidden: Hidden,
    probabilities: [f32; LABELS],
}

impl Weights {
    const ZERO: Self =
        Self { hidden: [[0.0; HIDDEN]; FEATURES + 1], output: [[0.0; HIDDEN]; LABELS], output_bias: [0.0; LABELS] };

    /// Small random weights, uniform with the deviation that keeps sums in range (Glorot and Bengio
    /// 2010).
    fn random(random: &mut Random) -> Self {
        let mut uniform = |range: f64| ((2.0 * random.unit() - 1.0) * range) as f32;
        let mut weights = Self::ZERO;
        let range = (6.0 / (FEATURES + HIDDEN) as f64).sqrt();
        weights.hidden[..FEATURES].as_flattened_mut().iter_mut().for_each(|weight| *weight = uniform(range));
        // Units have different kinks from the start.
        weights.hidden[FEATURES].iter_mut().for_each(|bias| *bias = uniform(1.0));
        let range = (6.0 / (HIDDEN + LABELS) as f64).sqrt();
        weights.output.as_flattened_mut().iter_mut().for_each(|weight| *weight = uniform(range));
        weights
    }

    fn parts(&self) -> [&[f32]; 3] {
        [self.hidden.as_flattened(), self.output.as_flattened(), &self.output_bias]
    }

    fn parts_mut(&mut self) -> [&mut [f32]; 3] {
        [self.hidden.as_flattened_mut(), self.output.as_flattened_mut(), &mut self.output_bias]
    }

    fn pass(&self, inputs: &[f32; FEATURES]) -> Pass {
        let hidden = self.hidden_pass(inputs);
        let probabilities = softmax(self.scores(&hidden.given));
        Pass { hidden, probabilities }
    }

    fn hidden_pass(&self, inputs: &[f32; FEATURES]) -> Hidden {
        let mut sums = self.hidden[FEATURES];
        for (input, weights) in inputs.iter().zip(&self.hidden) {
            for (sum, weight) in sums.iter_mut().zip(weights) {
                *sum += input * weight;
            }
        }
        let slope = sums.map(|sum| if sum > 0.0 { 1.0 } else { LEAK });
        let given = std::array::from_fn(|unit| sums[unit] * slope[unit]);
        Hidden { given, slope }
    }

    /// What softmax makes the probabilities of.
    fn scores(&self, given: &[f32; HIDDEN]) -> [f32; LABELS] {
        std::array::from_fn(|label| self.output_bias[label] + dot(&self.output[label], given))
    }

    /// Adds the gradient of one room's cross-entropy to `gradient`. Returns the cross-entropy.
    fn add_gradient(&self, inputs: &[f32; FEATURES], label: usize, gradient: &mut Self) -> f64 {
        let Pass { hidden: Hidden { given, slope }, probabilities: mut error } = self.pass(inputs);
        let loss = cross_entropy(error[label]);
        error[label] -= 1.0;
        let mut back = [0.0; HIDDEN];
        for (label, &error) in error.iter().enumerate() {
            gradient.output_bias[label] += error;
            for unit in 0..HIDDEN {
                gradient.output[label][unit] += error * given[unit];
                back[unit] += error * self.output[label][unit];
            }
        }
        for unit in 0..HIDDEN {
            back[unit] *= slope[unit];
        }
        for (row, input) in gradient.hidden.iter_mut().zip(inputs.iter().chain(&[1.0])) {
            for (sum, back) in row.iter_mut().zip(&back) {
                *sum += input * back;
            }
        }
        loss
    }
}

/// The cross-entropy of a room whose label has this probability.
fn cross_entropy(probability: f32) -> f64 {
    -f64::from(probability.max(1e-9)).ln()
}

/// Four sums side by side: one vector register.
fn dot(p: &[f32; HIDDEN], q: &[f32; HIDDEN]) -> f32 {
    let mut four = [0.0; 4];
    for (p, q) in p.chunks_exact(4).zip(q.chunks_exact(4)) {
        for i in 0..4 {
            four[i] += p[i] * q[i];
        }
    }
    (four[0] + four[1]) + (four[2] + four[3])
}

fn softmax(scores: [f32; LABELS]) -> [f32; LABELS] {
    let most = scores.into_iter().fold(f32::NEG_INFINITY, f32::max);
    let weights = scores.map(|score| (score - most).exp());
    let sum: f32 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

/// Adam's state.
struct Optimiser {
    mean: Weights,
    square: Weights,
    /// The powers of the two rates below, for correcting the averages' start at zero.
    mean_power: f32,
    square_power: f32,
}

/// The decay rates of Adam's averages, and the term that prevents division by zero; its authors'
/// defaults.
const MEAN_RATE: f32 = 0.9;
const SQUARE_RATE: f32 = 0.999;
const EPSILON: f32 = 1e-8;

impl Optimiser {
    const fn new() -> Self {
        Self { mean: Weights::ZERO, square: Weights::ZERO, mean_power: 1.0, square_power: 1.0 }
    }

    /// One step against the gradient over `rooms` rooms.
    fn step(&mut self, weights: &mut Weights, gradient: &Weights, rooms: usize, step: f32) {
        self.mean_power *= MEAN_RATE;
        self.square_power *= SQUARE_RATE;
        let share = 1.0 / rooms as f32;
        let mean_step = step / (1.0 - self.mean_power);
        let square_share = 1.0 / (1.0 - self.square_power);
        let decay = step * DECAY;
        let averages = self.mean.parts_mut().into_iter().zip(self.square.parts_mut());
        for ((weights, gradient), (means, squares)) in
            weights.parts_mut().into_iter().zip(gradient.parts()).zip(averages)
        {
            for (((weight, gradient), mean), square) in weights.iter_mut().zip(gradient).zip(means).zip(squares) {
                let slope = gradient * share;
                *mean = MEAN_RATE * *mean + (1.0 - MEAN_RATE) * slope;
                *square = SQUARE_RATE * *square + (1.0 - SQUARE_RATE) * slope * slope;
                *weight -= mean_step * *mean / ((*square * square_share).sqrt() + EPSILON) + decay * *weight;
            }
        }
    }
}

impl Perceptron {
    /// Learns a net. The same seed gives the same net.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub fn train(table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Self>, Cancelled> {
        let mut random = Random::new(seed);
        // Logarithms: what matters about an area is its ratio to others, all the more as the scale of
        // real plans is doubtful.
        let scale = Scale::of(table.values(), Transform::Logarithm);
        let inputs: Vec<[f32; FEATURES]> = table.values().iter().map(|values| scale.apply(values)).collect();
        let labels: Vec<usize> = table.labels().iter().map(|label| label.index()).collect();
        let apart = Some(table.len())
            .filter(|&rows| rows >= LEAST_TO_KEEP_APART)
            .and_then(|_| Folds::stratified(table.labels(), KEPT_APART, random.bits()).ok());
        let (mut learn, check) = match &apart {
            Some(folds) => (folds.training_rows(0), folds.test_rows(0)),
            None => ((0..table.len()).collect(), Vec::new()),
        };

        let mut weights = Weights::random(&mut random);
        let mut optimiser = Optimiser::new();
        let rounds = (VISITS / learn.len()).clamp(*ROUNDS.start(), *ROUNDS.end());
        let mut best = (f64::INFINITY, weights.clone(), 0);
        for round in 0..rounds {
            work.goes_on()?;
            let step = STEP * 0.5 * (1.0 + (std::f32::consts::PI * round as f32 / rounds as f32).cos());
            random.shuffle(&mut learn);
            let mut learned = 0.0;
            for rooms in learn.chunks(BATCH) {
                let mut gradient = Weights::ZERO;
                for &room in rooms {
                    learned += weights.add_gradient(&inputs[room], labels[room], &mut gradient);
                }
                optimiser.step(&mut weights, &gradient, rooms.len(), step);
            }
            let loss = |&room: &usize| cross_entropy(weights.pass(&inputs[room]).probabilities[labels[room]]);
            let loss: f64 = check.iter().map(loss).sum();
            let held_out_loss = (!check.is_empty()).then(|| loss / check.len() as f64);
            work.tell_round(Round { round, loss: learned / learn.len().max(1) as f64, held_out_loss });
            if loss < best.0 || check.is_empty() {
                best = (loss, weights.clone(), round);
            } else if round - best.2 >= PATIENCE {
                break;
            }
        }
        let model = Self { scale, weights: best.1, typical: medians(table.values()) };
        let temperature =
            fitted_temperature(check.iter().map(|&room| (model.predict(&table.values()[room]), table.labels()[room])));
        Ok(Trained { model, temperature })
    }

    /// A net from its parts; `None` if a number is not finite.
    pub fn from_parts(scale: Scale, weights: Weights, typical: Values) -> Option<Self> {
        let sound = scale.is_sound()
            && weights.parts().into_iter().flatten().all(|weight| weight.is_finite())
            && typical.iter().all(|value| value.is_finite());
        sound.then_some(Self { scale, weights, typical })
    }

    pub fn scale(&self) -> &Scale {
        &self.scale
    }

    pub fn weights(&self) -> &Weights {
        &self.weights
    }

    /// The median of each feature over the training rooms.
    pub fn typical(&self) -> &Values {
        &self.typical
    }

    pub fn predict(&self, values: &Values) -> Distribution {
        Distribution::from_weights(self.weights.pass(&self.scale.apply(values)).probabilities.map(f64::from))
    }

    /// The same at a temperature, of a room whose features were transformed by [`Scale::transform`] already: what several nets
    /// are asked about is transformed once.
    pub fn predict_transformed(&self, transformed: &Values, temperature: f64) -> [f32; LABELS] {
        let Hidden { given, .. } = self.weights.hidden_pass(&self.scale.standardised(transformed));
        // As powers of the probabilities would be, which take far longer.
        let surer = (1.0 / temperature) as f32;
        softmax(self.weights.scores(&given).map(|score| score * surer))
    }
}

/// The median of each feature, the lower of the two middle values.
fn medians(rows: &[Values]) -> Values {
    std::array::from_fn(|feature| {
        let mut values: Vec<f64> = rows.iter().map(|row| row[feature]).collect();
        lower_median(&mut values).unwrap_or_default()
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;
    use std::sync::atomic::AtomicBool;

    use super::*;
    use crate::dataset::Row;
    use crate::features::Features;

    #[test]
    fn who_hears_of_the_rounds_changes_nothing() {
        let rows: Vec<Row> = (0..120u32)
            .map(|it| {
                let label = if it % 3 == 0 { Label::Corridor } else { Label::SmallRoom };
                let area_m2 = f64::from(it % 17 + 3);
                Row::new(
                    label,
                    Features { area_m2, axes_ratio: 1.0 + f64::from(it % 3), doors: it % 5, doors_to: [0; 5] },
                )
            })
            .collect();
        let table = Table::from_rows(&rows).unwrap();
        let quiet = Perceptron::train(&table, 7, &Work::quiet()).unwrap();
        let (heard, cancelled) = (Mutex::new(Vec::new()), AtomicBool::new(false));
        let hear = |round: Round| heard.lock().unwrap().push(round);
        let work = Work::quiet().watched(&|_, _| {}, &cancelled).hearing(&hear);
        let watched = Perceptron::train(&table, 7, &work).unwrap();
        assert_eq!((watched.model, watched.temperature), (quiet.model, quiet.temperature));
        let rounds = heard.into_inner().unwrap();
        assert!(rounds.iter().enumerate().all(|(at, it)| it.round == at && it.held_out_loss.is_some()), "{rounds:?}");
        assert!(rounds.len() >= *ROUNDS.start() && rounds[rounds.len() - 1].loss < 0.5 * rounds[0].loss, "{rounds:?}");
    }
}
