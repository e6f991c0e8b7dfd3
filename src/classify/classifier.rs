use std::fmt;
use std::str::FromStr;

use super::knn::Neighbours;
use super::mlp::Perceptron;
use super::rules::RuleList;
use super::tree::Tree;
use super::{Distribution, Trained};
use crate::dataset::table::{Table, Values};

/// The paper's four algorithms (section 3.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Algorithm {
    Rules,
    Tree,
    Knn,
    Mlp,
}

impl Algorithm {
    pub const ALL: [Self; 4] = [Self::Rules, Self::Tree, Self::Knn, Self::Mlp];

    /// The word for files and the command line.
    pub const fn name(self) -> &'static str {
        ["rules", "tree", "knn", "mlp"][self as usize]
    }

    /// The name for people.
    pub const fn title(self) -> &'static str {
        ["rule induction", "decision tree", "k-nearest neighbours", "multilayer perceptron"][self as usize]
    }
}

impl fmt::Display for Algorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

/// The text is no algorithm's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownAlgorithm(pub String);

impl fmt::Display for UnknownAlgorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown algorithm '{}': use rules, tree, knn, mlp or joint", self.0)
    }
}

impl std::error::Error for UnknownAlgorithm {}

impl FromStr for Algorithm {
    type Err = UnknownAlgorithm;

    fn from_str(text: &str) -> Result<Self, UnknownAlgorithm> {
        let wanted = text.trim();
        Self::ALL
            .into_iter()
            .find(|algorithm| algorithm.name().eq_ignore_ascii_case(wanted))
            .ok_or_else(|| UnknownAlgorithm(text.to_owned()))
    }
}

/// What an algorithm learned.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "there are a handful of models, and prediction is quicker without a box")]
pub enum Model {
    Rules(RuleList),
    Tree(Tree),
    Knn(Neighbours),
    Mlp(Perceptron),
}

/// A trained classifier: from `F_r` to a distribution over the labels.
#[derive(Clone, Debug)]
pub struct Classifier {
    model: Model,
    temperature: f64,
}

impl Classifier {
    /// Learns from labelled rooms. The same table and seed give the same classifier.
    pub fn train(algorithm: Algorithm, table: &Table, seed: u64) -> Self {
        let (model, temperature) = match algorithm {
            // Laplace's correction alone makes these as believable as a temperature would: fitted on
            // rooms kept apart it came out near 1 and changed the log loss in the third digit.
            Algorithm::Rules => (Model::Rules(RuleList::train(table, seed)), 1.0),
            Algorithm::Tree => (Model::Tree(Tree::train(table)), 1.0),
            Algorithm::Knn => {
                let Trained { model, temperature } = Neighbours::train(table, seed);
                (Model::Knn(model), temperature)
            }
            Algorithm::Mlp => {
                let Trained { model, temperature } = Perceptron::train(table, seed);
                (Model::Mlp(model), temperature)
            }
        };
        Self { model, temperature }
    }

    /// A classifier of these parts. A temperature that is not a positive number counts as 1.
    pub fn from_parts(model: Model, temperature: f64) -> Self {
        let temperature = if temperature.is_finite() && temperature > 0.0 { temperature } else { 1.0 };
        Self { model, temperature }
    }

    pub fn algorithm(&self) -> Algorithm {
        match self.model {
            Model::Rules(_) => Algorithm::Rules,
            Model::Tree(_) => Algorithm::Tree,
            Model::Knn(_) => Algorithm::Knn,
            Model::Mlp(_) => Algorithm::Mlp,
        }
    }

    pub fn model(&self) -> &Model {
        &self.model
    }

    /// See [`Distribution::at_temperature`].
    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// The distribution over the labels for a room. Whatever the values are, there is an answer.
    pub fn predict(&self, values: &Values) -> Distribution {
        let distribution = match &self.model {
            Model::Rules(model) => model.predict(values),
            Model::Tree(model) => model.predict(values),
            Model::Knn(model) => model.predict(values),
            Model::Mlp(model) => model.predict(values),
        };
        distribution.at_temperature(self.temperature)
    }
}
