//! The commands that ran, for recording.

use super::Session;

/// A complete call of a command: repeating it does the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Executed {
    pub id: &'static str,
    pub arguments: Vec<String>,
}

impl Session {
    /// Records something done as a call of this command with these arguments.
    pub(crate) fn note_executed(&mut self, id: &'static str, arguments: Vec<String>) {
        let Some(executed) = &mut self.executed else { return };
        // Of a pan, only its end.
        if id == "view" && executed.last().is_some_and(|last| last.id == id) {
            executed.pop();
        }
        executed.push(Executed { id, arguments });
    }
}
