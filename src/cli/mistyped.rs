//! A mistyped subcommand is told with its nearest name, instead of being taken for a plan to open.

use std::ffi::OsString;
use std::path::Path;

use clap::Command;

/// More letters than this are another word, not a slip.
const MOST_SLIPS: usize = 2;

/// What is wrong with the first word after the program's name, if it can be neither a subcommand nor a plan.
pub fn subcommand(arguments: &[OsString], command: &Command) -> Option<String> {
    let word = arguments.get(1)?;
    let text = word.to_str()?;
    let names = || command.get_subcommands().map(Command::get_name).chain(["help"]);
    if text.is_empty() || text.starts_with('-') || names().any(|name| name == text) || Path::new(word).exists() {
        return None;
    }
    // What looks like a path is one: reading it says what is wrong.
    let is_alone = arguments.len() == 2;
    if is_alone && (text.contains(['/', '\\', '.'])) {
        return None;
    }
    let slips = |name: &str| strsim::osa_distance(&text.to_lowercase(), name);
    let nearest = names().map(|name| (slips(name), name)).min();
    // Of short words a smaller part may be wrong; a beginning means the whole.
    let nearest = nearest.filter(|(slips, name)| *slips <= MOST_SLIPS.min(name.len() / 2)).map(|(_, name)| name);
    let nearest = nearest.or_else(|| names().find(|name| text.len() >= 3 && name.starts_with(text)));
    let hint = match nearest {
        Some(name) => format!("did you mean '{name}'?"),
        None => format!("there are {}", names().collect::<Vec<_>>().join(", ")),
    };
    Some(format!("'{text}' is neither a subcommand nor a file; {hint}"))
}
