use clap::builder::EnumValueParser;
use clap_complete::Shell;

use super::outputs::Outputs;
use super::{CliError, Outcome, Subcommand, Terminal, command};
use std::path::PathBuf;

/// `enfilade completions`: what a shell completes.
#[derive(clap::Args)]
pub struct CompletionsCommand {
    /// The shell to write for
    #[arg(value_name = "SHELL", value_parser = EnumValueParser::<Shell>::new())]
    shell: Shell,
    /// Write the script here instead of to stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl Subcommand for CompletionsCommand {
    const NAME: &'static str = "completions";
    const ABOUT: &'static str = "Print a completion script for your shell";
    const EXAMPLE: &'static str = "enfilade completions bash -o ~/.local/share/bash-completion/completions/enfilade";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut command(), "enfilade", &mut script);
        Outputs::new(terminal).result(self.output.as_deref(), &script, terminal)?;
        Ok(Outcome::Done)
    }
}
