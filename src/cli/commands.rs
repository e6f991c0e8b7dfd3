use std::io::Write as _;

use serde_json::{Value, json};

use super::{CliError, Outcome, Subcommand, Terminal};
use crate::app::commands::{ArgumentKind, COMMANDS, Command, keys_of, manual};

/// `enfilade commands`: what the window can do.
#[derive(clap::Args)]
pub struct CommandsCommand {
    /// Print JSON (docs/json/commands.md describes it)
    #[arg(long)]
    json: bool,
    /// Print the page of the manual
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
}

impl Subcommand for CommandsCommand {
    const NAME: &'static str = "commands";
    const ABOUT: &'static str = "List the window's commands, with their words in scripts, keys and purpose";
    const EXAMPLE: &'static str = "enfilade commands | grep zoom";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        if self.json {
            let commands: Vec<Value> = COMMANDS.iter().map(as_json).collect();
            serde_json::to_writer_pretty(&mut terminal.out, &json!({ "version": 1, "commands": commands }))?;
            writeln!(terminal.out)?;
        } else if self.markdown {
            write!(terminal.out, "{}", manual())?;
        } else {
            let width = |text: fn(&Command) -> String| {
                COMMANDS.iter().map(|command| text(command).chars().count()).max().unwrap_or_default()
            };
            let keys = |command: &Command| keys_of(command).join(", ");
            let (usage_width, keys_width) = (width(Command::usage), width(keys));
            for command in COMMANDS.iter() {
                let (usage, keys) = (command.usage(), keys(command));
                writeln!(terminal.out, "{usage:usage_width$}  {keys:keys_width$}  {}", command.help)?;
            }
        }
        Ok(Outcome::Done)
    }
}

fn as_json(command: &Command) -> Value {
    let arguments: Vec<Value> = command
        .arguments
        .iter()
        .map(|argument| {
            let words: Option<Vec<&str>> = match argument.kind {
                ArgumentKind::Switch => Some(vec!["on", "off"]),
                ArgumentKind::Word(words) => Some(words.iter().map(|(word, _)| *word).collect()),
                _ => None,
            };
            json!({
                "name": argument.name,
                "help": argument.help,
                "expected": argument.kind.expected(),
                "optional": argument.is_optional,
                "words": words,
            })
        })
        .collect();
    json!({
        "id": command.id,
        "title": command.title,
        "help": command.help,
        "menu": command.menu.map(|(menu, _)| menu.title()),
        "keys": keys_of(command),
        "arguments": arguments,
    })
}
