//! What was done, for whoever records it.

use super::Session;

/// A command that was done, complete: running it again with these arguments does the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Executed {
    pub id: &'static str,
    pub arguments: Vec<String>,
}

impl Session {
    /// Notes that something was done which the command with these arguments does.
    pub(crate) fn note_executed(&mut self, id: &'static str, arguments: Vec<String>) {
        let Some(executed) = &mut self.executed else { return };
        // Of a pan, only where it ends.
        if id == "view" && executed.last().is_some_and(|last| last.id == id) {
            executed.pop();
        }
        executed.push(Executed { id, arguments });
    }
}
