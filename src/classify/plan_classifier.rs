//! A trained classifier of any kind.

use super::blend::Blend;
use super::joint::Joint;
use super::{Classifier, Method};

/// A trained classifier of any kind.
#[derive(Clone, Debug)]
pub enum PlanClassifier {
    Each(Box<Classifier>),
    Joint(Box<Joint>),
    Blend(Box<Blend>),
}

impl PlanClassifier {
    pub fn method(&self) -> Method {
        match self {
            Self::Each(classifier) => Method::Each(classifier.algorithm()),
            Self::Joint(_) => Method::Joint,
            Self::Blend(_) => Method::Blend,
        }
    }
}

impl From<Classifier> for PlanClassifier {
    fn from(classifier: Classifier) -> Self {
        Self::Each(Box::new(classifier))
    }
}

impl From<Blend> for PlanClassifier {
    fn from(blend: Blend) -> Self {
        Self::Blend(Box::new(blend))
    }
}

impl From<Joint> for PlanClassifier {
    fn from(joint: Joint) -> Self {
        Self::Joint(Box::new(joint))
    }
}
