use std::fmt;
use std::str::FromStr;

use super::Algorithm;
use crate::base::wording::or_words;

/// A way to label the rooms of a plan: one by one with one of the learners, or all together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Method {
    /// Each room by its own features `F_r`.
    Each(Algorithm),
    /// All rooms of the plan in relation to each other, see [`super::joint`].
    Joint,
    /// The mean of several of the others, see [`super::blend`].
    Blend,
}

impl Method {
    /// All methods: the learners in their order, then the joint classifier, then the blend.
    pub const ALL: [Self; Algorithm::ALL.len() + 2] = {
        let mut all = [Self::Blend; Algorithm::ALL.len() + 2];
        all[Algorithm::ALL.len()] = Self::Joint;
        let mut index = 0;
        while index < Algorithm::ALL.len() {
            all[index] = Self::Each(Algorithm::ALL[index]);
            index += 1;
        }
        all
    };

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.name(),
            Self::Joint => "joint",
            Self::Blend => "blend",
        }
    }

    /// The name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.title(),
            Self::Joint => "joint classifier",
            Self::Blend => "blend",
        }
    }

    /// A short name, as for menus.
    pub fn short_title(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.learner().short_title(),
            Self::Joint => "All rooms together",
            Self::Blend => "Several together",
        }
    }

    /// What it predicts by: completes the sentence 'Predict by …'.
    pub fn help(self) -> &'static str {
        match self {
            Self::Each(algorithm) => algorithm.learner().help(),
            Self::Joint => {
                "comparing all rooms of the plan: their sizes, shapes and openings, and which opens to which"
            }
            Self::Blend => {
                "asking several models and taking the mean: those that compare all rooms of the plan and those that look at \
                 each room, of this kind of building and of all kinds"
            }
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

/// A text that is not a method's name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownAlgorithm(pub String);

impl fmt::Display for UnknownAlgorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown algorithm '{}': use {}", self.0, or_words(&Method::ALL.map(Method::name)))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_learner_has_a_word_and_a_name_of_its_own() {
        for (index, method) in Method::ALL.into_iter().enumerate() {
            let id = method.name();
            assert!(!id.is_empty() && id.bytes().all(|byte| byte.is_ascii_lowercase() || byte == b'-'), "{id}");
            assert!(method.short_title().starts_with(char::is_uppercase), "{id}");
            assert!(!method.help().ends_with('.'), "{id}");
            for other in &Method::ALL[index + 1..] {
                assert!(id != other.name() && method.title() != other.title(), "{id}");
            }
            assert_eq!(id.parse(), Ok(method));
        }
    }
}
