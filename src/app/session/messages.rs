//! Messages that stay until they are dismissed.

/// A message that stays until it is dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    pub severity: Severity,
    /// What happened, in a sentence.
    pub text: String,
    /// Where, and what to do; may be empty.
    pub detail: String,
    /// The available remedies.
    pub remedies: Vec<Remedy>,
    /// Whether it stays as long as it is true; otherwise the user can dismiss it.
    pub stays: bool,
}

/// A remedy offered by a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// Show what an import repaired or skipped.
    ShowNotes,
    /// Show how the plan and its file differ.
    ShowDifferences,
    /// Replace the plan by the file's contents.
    LoadTheirs,
    /// Continue with the plan as it is here.
    KeepMine,
    /// Save the plan in its file.
    Save,
    /// Save it in another file.
    SaveElsewhere,
    /// Find the missing backdrop.
    RelinkPicture,
    /// Show the picture though it lies outside the plan's folder.
    ShowPicture,
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
            Self::SaveElsewhere => "Save to another place…",
            Self::RelinkPicture => "Relink…",
            Self::ShowPicture => "Show it",
            Self::KeepPicture => "Keep this picture",
        }
    }
}

/// The severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    Info,
    Warning,
    Error,
}
