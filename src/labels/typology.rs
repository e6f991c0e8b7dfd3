use std::fmt;
use std::sync::Arc;

/// What a building is for: `house`, `school`, `office`, or another that a user adds with a label scheme.
/// Kept in lower case, so that 'OFFICE' in a file and `office` in a scheme are the same.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Typology(Arc<str>);

impl Typology {
    /// A typology by name, with surrounding space trimmed. `None` for an empty name.
    pub fn new(name: &str) -> Option<Self> {
        let name = name.trim();
        (!name.is_empty()).then(|| Self(name.to_lowercase().into()))
    }

    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// The name capitalised, for titles.
    pub fn title(&self) -> String {
        let mut letters = self.0.chars();
        letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
    }
}

impl fmt::Display for Typology {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
