//! Classifiers: from features to labels.

pub mod calibration;
mod distribution;
pub mod knn;
pub mod mlp;
pub mod naive;
mod neighbours;
mod numbers;
pub mod rules;
pub mod scale;
pub mod tree;

pub use distribution::Distribution;
pub use neighbours::Metric;

/// A model and the temperature that makes its probabilities believable.
#[derive(Clone, Debug)]
pub struct Trained<M> {
    pub model: M,
    /// See [`Distribution::at_temperature`].
    pub temperature: f64,
}
