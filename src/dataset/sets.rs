//! The data sets that classifiers learn from: one per typology, and one of all.

use crate::labels::Typology;

/// The set whose classifiers learn from all typologies.
pub const STANDARD: &str = "standard";

/// The name of the set a model learned from, as in its file's name: a typology, or `standard`.
pub fn set_name(typology: Option<&Typology>) -> &str {
    typology.map_or(STANDARD, Typology::as_str)
}

/// A set's plans, in words: 'school plans'.
pub fn plans_of(set: &str) -> String {
    if set == STANDARD { "plans of any kind".to_owned() } else { format!("{set} plans") }
}
