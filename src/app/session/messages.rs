//! Messages that stay until they are dismissed, another plan is shown, or what they say is no longer so.

use super::Session;
use crate::plan::Plan;

use crate::plan::RoomId;

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
    /// Until when it is so.
    pub(crate) lasts: Lasts,
    /// The plan that it is about, by the number of its document, 0 for no plan; `None` for the program.
    pub(crate) plan: Option<u64>,
}

impl Message {
    /// A message about the plan shown, without remedies, that stays until it is dismissed.
    pub(crate) fn new(severity: Severity, text: impl Into<String>, detail: impl Into<String>) -> Self {
        let (text, detail) = (text.into(), detail.into());
        Self { severity, text, detail, remedies: Vec::new(), stays: false, lasts: Lasts::Always, plan: Some(0) }
    }

    /// The same, about the program: it stays whatever plan is shown.
    pub(crate) fn of_program(self) -> Self {
        Self { plan: None, ..self }
    }

    pub(crate) fn lasting(self, lasts: Lasts) -> Self {
        Self { lasts, ..self }
    }

    pub(crate) fn with(self, remedies: Vec<Remedy>) -> Self {
        Self { remedies, ..self }
    }

    /// Whether both say the same.
    fn says_as(&self, other: &Self) -> bool {
        self.text == other.text && self.detail == other.detail && self.plan == other.plan
    }
}

/// Until when something is so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Lasts {
    Always,
    /// While the plan is at this step of its history.
    Step(usize),
    /// While this is the path of the picture under the plan.
    Picture(String),
    /// While the plan has changes that are in no file.
    Unsaved,
}

/// The most messages that are kept.
const MOST: usize = 50;

impl Session {
    /// The messages about the plan shown and about the program, oldest first, by their place among all.
    pub(crate) fn shown_messages(&self) -> Vec<usize> {
        let shown = self.document.as_ref().map_or(0, |document| document.number);
        let is_shown = |message: &Message| message.plan.is_none_or(|plan| plan == shown);
        (0..self.messages.len()).filter(|&index| self.messages.get(index).is_some_and(is_shown)).collect()
    }

    pub(crate) fn add_message(&mut self, mut message: Message) {
        let shown = self.document.as_ref().map_or(0, |document| document.number);
        message.plan = message.plan.map(|_| shown);
        // A repeated message moves to the end.
        self.messages.retain(|other| !other.says_as(&message));
        self.messages.push(message);
        let too_many = self.messages.len().saturating_sub(MOST);
        self.messages.drain(..too_many);
    }

    /// Says something about the program, whatever plan is shown.
    pub(crate) fn say_of_program(&mut self, severity: Severity, text: impl Into<String>, detail: impl Into<String>) {
        self.add_message(Message::new(severity, text, detail).of_program());
    }

    /// Something that is refused as the plan stands: another change of it, and it may be otherwise.
    pub(crate) fn say_refused(&mut self, text: impl Into<String>) {
        let step = self.document.as_ref().map(|document| document.history.position());
        let lasts = step.map_or(Lasts::Always, Lasts::Step);
        self.add_message(Message::new(Severity::Warning, text, "").lasting(lasts));
    }

    /// Drops the messages of the plan shown that are no longer so.
    pub(crate) fn drop_stale_messages(&mut self) {
        let Some(document) = &self.document else { return };
        let (number, step, is_changed) = (document.number, document.history.position(), document.is_changed());
        let picture = document.plan().backdrop().map(|backdrop| backdrop.path.clone());
        self.messages.retain(|message| {
            message.plan != Some(number)
                || match &message.lasts {
                    Lasts::Always => true,
                    Lasts::Step(then) => *then == step,
                    Lasts::Picture(path) => picture.as_ref() == Some(path),
                    Lasts::Unsaved => is_changed,
                }
        });
    }

    /// Until when something about the picture under the plan is so.
    pub(crate) fn while_this_picture(&self) -> Lasts {
        let path = self.plan().and_then(Plan::backdrop).map(|backdrop| backdrop.path.clone());
        path.map_or(Lasts::Always, Lasts::Picture)
    }
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
    /// Make one room of two that have no wall between them any more.
    MergeRooms([RoomId; 2]),
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
            Self::MergeRooms(_) => "Merge rooms",
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
