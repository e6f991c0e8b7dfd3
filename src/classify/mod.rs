//! Classifiers: from features to labels.

pub mod calibration;
mod classifier;
mod distribution;
mod evaluate;
pub mod explain;
pub mod in_plan;
pub mod joint;
pub mod knn;
mod method;
pub mod mlp;
pub mod model_file;
pub mod models;
mod neighbours;
mod numbers;
pub mod rules;
pub mod scale;
mod scores;
pub mod tree;
pub mod typology;
pub mod unknown;

pub use classifier::{Algorithm, Classifier, Model, UnknownAlgorithm};
pub use distribution::Distribution;
pub use evaluate::{Validated, Validation, evaluate, evaluate_all, test};
pub use method::{Method, PlanClassifier};
pub use neighbours::Metric;
pub use scores::{Confusion, FoldScore, LabelCounts, ReliabilityBin, Scores, TableRates};

/// A model and the temperature that makes its probabilities believable.
#[derive(Clone, Debug)]
pub struct Trained<M> {
    pub model: M,
    /// See [`Distribution::at_temperature`].
    pub temperature: f64,
}
