//! The verbs of scripts, one file per group. To add a verb, add an entry: the parser, the manual and the
//! hints use it.

mod checks;
mod files;
mod keyboard;
mod pointer;
mod window;

use super::act::Act;
use super::fault::Fault;
use super::stage::{self};
use super::words::Words;
use crate::app::commands::{ArgumentKind, Command};

/// A verb of the language.
pub(super) struct Verb {
    /// The first word of the line.
    pub name: &'static str,
    /// Its syntax: keywords in lower case, placeholders in capitals, optional parts in brackets.
    pub form: &'static str,
    /// What it does, in a sentence.
    pub help: &'static str,
    /// Parses what comes after the verb. An error says what is wrong with it.
    pub parse: fn(&mut Words<'_>) -> Result<Act, String>,
}

/// A group of related verbs.
pub(super) struct Group {
    pub title: &'static str,
    pub verbs: &'static [Verb],
}

/// Every verb.
pub(super) const VERBS: &[Group] = &[pointer::GROUP, keyboard::GROUP, window::GROUP, files::GROUP, checks::GROUP];

/// The expectations, with their syntax and meaning.
pub(super) fn expectations() -> impl Iterator<Item = (&'static str, &'static str)> {
    checks::EXPECTATIONS.iter().map(|expectation| (expectation.form, expectation.help))
}

/// A step that runs a command. Its files are the script's own: copies of what it reads and, in its
/// folder, what it writes.
///
/// # Errors
/// When the command does not take such arguments.
pub(super) fn command(command: &'static Command, arguments: Vec<String>) -> Result<Act, String> {
    let most = command.arguments.len();
    if arguments.len() > most {
        return Err(format!(
            "{} words stand behind {}, which takes at most {}",
            arguments.len(),
            command.id,
            stage::count(most, "argument")
        ));
    }
    Ok(Box::new(move |stage| {
        let words: Vec<String> = arguments
            .iter()
            .zip(command.arguments)
            .map(|(word, argument)| {
                let path = match argument.kind {
                    ArgumentKind::PlanFile
                    | ArgumentKind::PictureFile
                    | ArgumentKind::LogFile
                    | ArgumentKind::RecentFile => stage.folders.brought_in(word)?,
                    ArgumentKind::NewPlanFile | ArgumentKind::NewFile => stage.folders.to_write(word)?,
                    _ => return Ok(word.clone()),
                };
                Ok(path.to_string_lossy().into_owned())
            })
            .collect::<Result<_, Fault>>()?;
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        stage.window.run_command_with(command.id, &words).map_err(|error| Fault::new(error.to_string()))
    }))
}
