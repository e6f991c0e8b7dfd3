//! Classifiers: from features to labels.

pub mod blend;
pub mod calibration;
mod classifier;
pub mod committee;
pub mod condition;
mod distribution;
mod evaluate;
pub mod explain;
pub mod given;
pub mod in_plan;
pub mod joint;
pub mod learned;
pub mod learner;
pub mod learners;
mod method;
pub mod model_file;
pub mod models;
mod neighbours;
mod numbers;
mod plan_classifier;
pub mod scale;
mod scores;
pub mod typology;
pub mod unknown;
pub mod why;

pub use classifier::Classifier;
pub use distribution::Distribution;
pub use evaluate::{Validated, Validation, evaluate, evaluate_all, test};
pub use learners::Algorithm;
pub use method::{Method, UnknownAlgorithm};
pub use neighbours::Metric;
pub use plan_classifier::PlanClassifier;
pub use scores::{Confusion, FoldScore, LabelCounts, LabelRates, ReliabilityBin, Scores, TableRates};
