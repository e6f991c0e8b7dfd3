//! Parsing a script into steps.

use super::act::Act;
use std::fmt;

use super::verbs::{self, VERBS};
use super::words::{self, Words};
use crate::app::commands::{self, COMMANDS};

/// A parsed script.
pub struct Script {
    pub(super) steps: Vec<Step>,
}

/// A line with an action.
pub(super) struct Step {
    /// Counted from 1.
    pub line: usize,
    pub act: Act,
}

/// A syntax error in a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Counted from 1.
    pub line: usize,
    pub what: String,
    /// What to do about it; may be empty.
    pub hint: String,
}

impl fmt::Display for SyntaxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}

impl std::error::Error for SyntaxError {}

/// The maximum size: nobody writes or records a longer script on purpose.
pub const LARGEST_BYTES: usize = 4 << 20;

/// The most errors reported; a file with more is something else.
const MOST_ERRORS: usize = 10;

impl Script {
    /// Parses a script.
    ///
    /// # Errors
    /// Every invalid line, up to `MOST_ERRORS`, each with the nearest valid alternative.
    pub fn parse(bytes: &[u8]) -> Result<Self, Vec<SyntaxError>> {
        let whole =
            |what: &str, hint: &str| vec![SyntaxError { line: 1, what: what.to_owned(), hint: hint.to_owned() }];
        if bytes.len() > LARGEST_BYTES {
            let megabytes = LARGEST_BYTES >> 20;
            return Err(whole(&format!("a script has at most {megabytes} MiB"), "split it, or give a script"));
        }
        let text = match std::str::from_utf8(bytes) {
            Ok(text) if !text.contains('\0') => text,
            _ => return Err(whole("this is no text", "a script is plain text in UTF-8, one step a line")),
        };
        let (mut steps, mut errors) = (Vec::new(), Vec::new());
        for (index, text) in text.trim_start_matches('\u{feff}').lines().enumerate() {
            let line = index + 1;
            match step(text) {
                Ok(None) => {}
                Ok(Some(act)) => steps.push(Step { line, act }),
                Err((what, hint)) => errors.push(SyntaxError { line, what, hint }),
            }
            if errors.len() == MOST_ERRORS {
                break;
            }
        }
        if errors.is_empty() { Ok(Self { steps }) } else { Err(errors) }
    }

    /// The number of steps.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there are no steps.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }
}

/// The step on a line; none for a blank line. An error has a hint.
fn step(line: &str) -> Result<Option<Act>, (String, String)> {
    let line = words::split(line).map_err(|what| (what, String::new()))?;
    let mut words = Words::new(&line);
    let Some(first) = words.next() else { return Ok(None) };
    let act = match VERBS.iter().flat_map(|group| group.verbs).find(|verb| verb.name == first.text) {
        Some(verb) => {
            let form = || format!("write: {}", verb.form);
            let act = (verb.parse)(&mut words).map_err(|what| (what, form()))?;
            if let Some(word) = words.next() {
                return Err((format!("{} is one word too many", words::written(&word.text)), form()));
            }
            act
        }
        None => match commands::find(&first.text) {
            Some(command) => {
                let usage = || format!("write: {}", command.usage());
                verbs::command(command, words.all()).map_err(|what| (what, usage()))?
            }
            None => {
                let names = VERBS.iter().flat_map(|group| group.verbs).map(|verb| verb.name);
                let all = names.chain(COMMANDS.iter().map(|command| command.id));
                let hint = match words::did_you_mean(&first.text, all) {
                    hint if hint.is_empty() => "enfilade replay --list names all verbs and commands".to_owned(),
                    hint => hint,
                };
                return Err((format!("{} is neither a verb nor a command", words::told(&first.text)), hint));
            }
        },
    };
    Ok(Some(act))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_verb_is_a_command_or_another_verb() {
        let names: Vec<&str> = VERBS.iter().flat_map(|group| group.verbs).map(|verb| verb.name).collect();
        for (index, name) in names.iter().enumerate() {
            assert!(commands::find(name).is_none(), "{name} is a command too");
            assert!(!names[..index].contains(name), "{name} is there twice");
        }
    }

    #[test]
    fn every_line_is_counted() {
        let text = "\u{feff}# a comment\r\n\r\nopen-sample office\r\n  fit  # all of it\r\n";
        let script = Script::parse(text.as_bytes()).map_err(|errors| errors[0].to_string());
        let lines: Vec<usize> = script.expect("it is well formed").steps.iter().map(|step| step.line).collect();
        assert_eq!(lines, [3, 4]);
        let errors = Script::parse(b"fit\nfitt\n\"fit").err().expect("two lines mean nothing");
        assert_eq!(errors.iter().map(|error| error.line).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(errors[0].to_string(), "fitt is neither a verb nor a command; did you mean fit?");
    }
}
