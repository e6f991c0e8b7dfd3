use std::fmt;
use std::str::FromStr;

/// One of the paper's five semantic labels (section 3.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Label {
    SmallRoom,
    MediumRoom,
    BigRoom,
    Corridor,
    Hall,
}

impl Label {
    /// All labels in the fixed order of `F_r`: S, M, B, C, H. Every table and export uses it.
    pub const ALL: [Self; 5] = [Self::SmallRoom, Self::MediumRoom, Self::BigRoom, Self::Corridor, Self::Hall];

    /// Position in [`Label::ALL`], 0..5.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The paper's letter.
    pub const fn letter(self) -> &'static str {
        ["S", "M", "B", "C", "H"][self as usize]
    }

    /// The name in words, in the interface and in files.
    pub const fn name(self) -> &'static str {
        ["small room", "medium room", "big room", "corridor", "hall"][self as usize]
    }
}

impl fmt::Display for Label {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A text that is neither a label's letter nor its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownLabel(pub String);

impl fmt::Display for UnknownLabel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown label '{}': use S, M, B, C, H or small room, medium room, big room, corridor, hall", self.0)
    }
}

impl std::error::Error for UnknownLabel {}

impl FromStr for Label {
    type Err = UnknownLabel;

    /// Reads a letter (`S`) or a name (`small room`), in any case.
    fn from_str(text: &str) -> Result<Self, UnknownLabel> {
        let wanted = text.trim();
        Self::ALL
            .into_iter()
            .find(|label| label.letter().eq_ignore_ascii_case(wanted) || label.name().eq_ignore_ascii_case(wanted))
            .ok_or_else(|| UnknownLabel(text.to_owned()))
    }
}
