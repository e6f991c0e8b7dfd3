//! Conditions on one feature: the building blocks of rules and of paths down a tree.

use crate::dataset::table::Values;

/// A bound on one feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Index of the feature.
    pub feature: usize,
    pub bound: Bound,
}

/// Which values a condition admits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    AtMost(f64),
    AtLeast(f64),
    /// More than this. Rules do not use it; a path down a tree can end up with it.
    Over(f64),
}

impl Condition {
    pub fn holds(&self, values: &Values) -> bool {
        match self.bound {
            Bound::AtMost(most) => values[self.feature] <= most,
            Bound::AtLeast(least) => values[self.feature] >= least,
            Bound::Over(less) => values[self.feature] > less,
        }
    }
}
