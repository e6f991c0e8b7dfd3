use std::fmt;
use std::str::FromStr;

use super::joint::Joint;
use super::{Algorithm, Classifier, UnknownAlgorithm};

/// A way to label the rooms of a plan: each by itself, by one of the paper's algorithms, or all together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Method {
    /// Each room by its own features `F_r`.
    Each(Algorithm),
    /// All rooms of the plan in relation to each other, see [`super::joint`].
    Joint,
}

impl Method {
    pub const ALL: [Self; 5] = [
        Self::Each(Algorithm::Rules),
        Self::Each(Algorithm::Tree),
        Self::Each(Algorithm::Knn),
        Self::Each(Algorithm::Mlp),
        Self::Joint,
    ];

    /// The word for files and the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.name(),
            Self::Joint => "joint",
        }
    }

    /// The name for people.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.title(),
            Self::Joint => "joint classifier",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

impl FromStr for Method {
    type Err = UnknownAlgorithm;

    fn from_str(text: &str) -> Result<Self, UnknownAlgorithm> {
        let wanted = text.trim();
        let found = Self::ALL.into_iter().find(|method| method.name().eq_ignore_ascii_case(wanted));
        found.ok_or_else(|| UnknownAlgorithm(text.to_owned()))
    }
}

/// A trained classifier of either kind.
#[derive(Clone, Debug)]
pub enum PlanClassifier {
    Each(Box<Classifier>),
    Joint(Box<Joint>),
}

impl PlanClassifier {
    pub fn method(&self) -> Method {
        match self {
            Self::Each(classifier) => Method::Each(classifier.algorithm()),
            Self::Joint(_) => Method::Joint,
        }
    }
}

impl From<Classifier> for PlanClassifier {
    fn from(classifier: Classifier) -> Self {
        Self::Each(Box::new(classifier))
    }
}

impl From<Joint> for PlanClassifier {
    fn from(joint: Joint) -> Self {
        Self::Joint(Box::new(joint))
    }
}
