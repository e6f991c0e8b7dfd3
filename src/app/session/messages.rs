//! What is said to a person until it is dismissed.

/// A message that stays until it is dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    pub severity: Severity,
    /// What happened, in a sentence.
    pub text: String,
    /// Where, and what to do; may be empty.
    pub detail: String,
    /// What can be done about it.
    pub remedies: Vec<Remedy>,
    /// Whether it stays as long as what it says is so; else a person can dismiss it.
    pub stays: bool,
}

/// What a message offers to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Show what an import mended or left out.
    ShowNotes,
    /// Show how the plan and its file differ.
    ShowDifferences,
    /// Make the plan what its file holds.
    LoadTheirs,
    /// Go on with the plan as it is here.
    KeepMine,
    /// Save the plan in its file.
    Save,
    /// Save it in another.
    SaveElsewhere,
    /// Say where the picture under the plan is.
    RelinkPicture,
    /// Take the picture that is shown as the one that the plan means.
    KeepPicture,
}

impl Remedy {
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::ShowNotes => "Show notes",
            Self::ShowDifferences => "Show differences",
            Self::LoadTheirs => "Load the file",
            Self::KeepMine => "Keep mine",
            Self::Save => "Save",
            Self::SaveElsewhere => "Save in another place…",
            Self::RelinkPicture => "Relink…",
            Self::KeepPicture => "Keep this picture",
        }
    }
}

/// How bad a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    Info,
    Warning,
    Error,
}
