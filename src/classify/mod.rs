//! Classifiers: from features to labels.

pub mod naive;
