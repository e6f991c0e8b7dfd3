//! Classifiers: from features to labels.

mod distribution;
pub mod naive;
mod numbers;
pub mod rules;
pub mod tree;

pub use distribution::Distribution;
