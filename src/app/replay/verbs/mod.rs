//! The verbs of scripts, a file a group. A new verb is one entry: the parser, the manual and the hints
//! come from it.

mod checks;
mod files;
mod keyboard;
mod pointer;
mod window;

use super::script::Act;
use super::stage::Fault;
use super::words::Words;
use crate::app::commands::Command;

/// A verb of the language.
pub(super) struct Verb {
    /// The first word of the line.
    pub name: &'static str,
    /// How it is written: keywords small, what is to be filled in large, what may be left out in
    /// brackets.
    pub form: &'static str,
    /// What it does, in a sentence.
    pub help: &'static str,
    /// Understands what stands behind the verb. An error says what is wrong with it.
    pub parse: fn(&mut Words<'_>) -> Result<Act, String>,
}

/// Verbs that belong together.
pub(super) struct Group {
    pub title: &'static str,
    pub verbs: &'static [Verb],
}

/// Every verb.
pub(super) const VERBS: &[Group] = &[pointer::GROUP, keyboard::GROUP, window::GROUP, files::GROUP, checks::GROUP];

/// What can be expected, with how it is written and what it means.
pub(super) fn expectations() -> impl Iterator<Item = (&'static str, &'static str)> {
    checks::EXPECTATIONS.iter().map(|expectation| (expectation.form, expectation.help))
}

/// A step that runs a command.
pub(super) fn command(command: &'static Command, arguments: Vec<String>) -> Act {
    Box::new(move |stage| {
        if !arguments.is_empty() {
            return Err(Fault::new(format!("the command {} takes nothing behind it", command.id)));
        }
        if stage.window.run_command(command.id) {
            return Ok(());
        }
        Err(Fault::new(format!("the command {} cannot be done here ({})", command.id, command.help)))
    })
}
