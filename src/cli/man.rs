use std::path::PathBuf;

use clap::Command;
use clap_mangen::Man;

use super::outputs::{Outputs, is_stdout, must_be_folder};
use super::{CliError, Outcome, Subcommand, Terminal, command};

/// `enfilade man`: pages for `man`.
#[derive(clap::Args)]
pub struct ManCommand {
    /// Write the pages of all subcommands to this folder, instead of the program's own page to stdout
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Subcommand for ManCommand {
    const NAME: &'static str = "man";
    const ABOUT: &'static str = "Print the manual page, or write those of all subcommands";
    const EXAMPLE: &'static str = "enfilade man -o ~/.local/share/man/man1   # then: man enfilade-render";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let mut outputs = Outputs::new(terminal);
        let Some(folder) = self.output.filter(|output| !is_stdout(output)) else {
            outputs.result(None, &page(command())?, terminal)?;
            return Ok(Outcome::Done);
        };
        must_be_folder(&folder)?;
        outputs.folder(&folder)?;
        let mut all = command();
        // Gives each subcommand its usage, 'enfilade render'.
        all.build();
        let own = |name: &str| name != "help";
        let pages: Vec<Command> = all.get_subcommands().filter(|sub| own(sub.get_name())).cloned().collect();
        outputs.save_in(&folder, "enfilade.1", &page(command())?, terminal)?;
        for sub in pages {
            let name = format!("enfilade-{}", sub.get_name());
            let file = format!("{name}.1");
            // clap keeps names for good.
            let sub = sub.display_name(name);
            outputs.save_in(&folder, &file, &page(sub)?, terminal)?;
        }
        terminal.report(format!("{}: enfilade.1 and a page for each subcommand", folder.display()))?;
        Ok(Outcome::Done)
    }
}

fn page(command: Command) -> Result<Vec<u8>, CliError> {
    let mut page = Vec::new();
    Man::new(command).render(&mut page)?;
    Ok(page)
}
