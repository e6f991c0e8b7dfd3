//! Texts of a room while being edited.

use crate::edit::{self, EditError};
use crate::plan::{Plan, RoomId};

/// A text field being edited.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    pub(crate) room: RoomId,
    pub(crate) kind: FieldKind,
    pub(crate) text: String,
}

/// An editable text of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FieldKind {
    Name,
    Function,
    Note,
}

impl Field {
    pub(crate) fn new(room: RoomId, kind: FieldKind, text: &str) -> Self {
        Self { room, kind, text: text.to_owned() }
    }

    /// The id and the argument of the command that sets it.
    pub(crate) fn as_command(&self) -> (&'static str, String) {
        let id = match self.kind {
            FieldKind::Name => "rename",
            FieldKind::Function => "set-function",
            FieldKind::Note => "set-note",
        };
        (id, self.text.clone())
    }

    /// The title of the edit in the history.
    pub(crate) fn title(&self) -> &'static str {
        match self.kind {
            FieldKind::Name => "Rename room",
            FieldKind::Function => "Set function",
            FieldKind::Note => "Write note",
        }
    }

    /// # Errors
    /// When the room is gone.
    pub(crate) fn apply(&self, plan: &Plan) -> Result<Plan, EditError> {
        match self.kind {
            FieldKind::Name => edit::set_name(plan, self.room, &self.text),
            FieldKind::Function => edit::set_function(plan, self.room, &self.text),
            FieldKind::Note => edit::change_room(plan, self.room, |room| room.note = self.text.trim().to_owned()),
        }
    }
}
