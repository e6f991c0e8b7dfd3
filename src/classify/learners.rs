//! The learners: the paper's four algorithms (section 3.2).

pub mod knn;
pub mod mlp;
pub mod rules;
pub mod tree;

use std::fmt;

use super::learner::Learner;

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

    /// The multilayer perceptron.
    pub const PERCEPTRON: Self = Self(3);

    /// The decision tree.
    pub const TREE: Self = Self(1);

    /// Position in [`LEARNERS`].
    pub const fn index(self) -> usize {
        self.0
    }

    pub fn learner(self) -> &'static dyn Learner {
        LEARNERS[self.0]
    }

    /// Its name in files and on the command line.
    pub fn name(self) -> &'static str {
        self.learner().id()
    }

    /// Its name for people.
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
