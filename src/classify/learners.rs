//! The learners: the paper's four algorithms (section 3.2).

pub mod knn;
pub mod mlp;
pub mod rules;
pub mod tree;

use std::fmt;
use std::str::FromStr;

use super::Method;
use super::learner::Learner;
use crate::base::wording::or_words;

/// All learners, in the order of menus, tables and help texts.
#[rustfmt::skip] // one line each
pub const LEARNERS: &[&dyn Learner] = &[
    &rules::Ripper,
    &tree::C45,
    &knn::NearestNeighbours,
    &mlp::Backpropagation,
];

/// One of the [`LEARNERS`].
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Algorithm(usize);

impl Algorithm {
    /// All of them, in their order.
    pub const ALL: [Self; LEARNERS.len()] = {
        let mut all = [Self(0); LEARNERS.len()];
        let mut index = 0;
        while index < all.len() {
            all[index] = Self(index);
            index += 1;
        }
        all
    };

    /// Position in [`LEARNERS`].
    pub const fn index(self) -> usize {
        self.0
    }

    pub fn learner(self) -> &'static dyn Learner {
        LEARNERS[self.0]
    }

    /// The word for files and the command line.
    pub fn name(self) -> &'static str {
        self.learner().id()
    }

    /// The name for people.
    pub fn title(self) -> &'static str {
        self.learner().title()
    }
}

impl fmt::Debug for Algorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
