//! The command line. One file per subcommand, and one line in [`SUBCOMMANDS`] to register it.

mod batch;
mod check;
mod classify;
mod collect;
#[cfg(feature = "gui")]
mod commands;
mod dataset;
mod evaluate;
mod explore;
mod export;
mod features;
mod import;
mod inputs;
mod map;
mod models;
mod numbers;
mod open;
mod progress;
mod render;
#[cfg(feature = "gui")]
mod replay;
mod segment;
mod train;

use std::io::{IsTerminal as _, Write};
use std::path::PathBuf;

use clap::{ArgMatches, Args, Command};

/// All subcommands, in the order of the help.
#[rustfmt::skip] // one line each
const SUBCOMMANDS: &[Entry] = &[
    entry::<import::ImportCommand>(),
    entry::<features::FeaturesCommand>(),
    entry::<dataset::DatasetCommand>(),
    entry::<export::ExportCommand>(),
    entry::<check::CheckCommand>(),
    entry::<render::RenderCommand>(),
    entry::<classify::ClassifyCommand>(),
    entry::<evaluate::EvaluateCommand>(),
    entry::<train::TrainCommand>(),
    entry::<models::ModelsCommand>(),
    entry::<explore::ExploreCommand>(),
    entry::<map::MapCommand>(),
    entry::<segment::SegmentCommand>(),
    #[cfg(feature = "gui")]
    entry::<replay::ReplayCommand>(),
    #[cfg(feature = "gui")]
    entry::<commands::CommandsCommand>(),
];

/// A subcommand: its arguments (a clap `Args`) and its action.
pub trait Subcommand: Args {
    /// Its name on the command line.
    const NAME: &'static str;
    /// One line for the list of subcommands.
    const ABOUT: &'static str;
    /// An example call with a short explanation, shown at the end of its help.
    const EXAMPLE: &'static str;

    /// Text above the example: lists that the program keeps elsewhere. Empty for most.
    fn more_help() -> String {
        String::new()
    }

    /// Does the work.
    ///
    /// # Errors
    /// When the input is wrong so that there is no result; the message goes to stderr, exit code 1.
    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError>;
}

/// The outcome of a subcommand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Exit code 0.
    Done,
    /// It did what it could, and reported what was wrong with the input: exit code 1.
    InputWrong,
}

/// A message for stderr.
#[derive(Debug)]
pub struct CliError {
    pub message: String,
    /// The reader of our output has gone away (`| head`): nothing to say.
    pub broken_pipe: bool,
}

impl<E: std::error::Error + 'static> From<E> for CliError {
    fn from(error: E) -> Self {
        let io = (&error as &dyn std::error::Error).downcast_ref::<std::io::Error>();
        let broken_pipe = io.is_some_and(|io| io.kind() == std::io::ErrorKind::BrokenPipe);
        Self { message: error.to_string(), broken_pipe }
    }
}

impl CliError {
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), broken_pipe: false }
    }
}

/// Where a subcommand writes.
pub struct Terminal {
    /// Results.
    pub out: Box<dyn Write>,
    /// Errors, warnings, reports.
    pub err: Box<dyn Write>,
    /// Whether `err` is a terminal: progress is shown on one only.
    pub is_interactive: bool,
}

impl Terminal {
    /// The process's stdout (buffered) and stderr.
    pub fn standard() -> Self {
        Self {
            out: Box::new(std::io::BufWriter::new(std::io::stdout())),
            err: Box::new(std::io::stderr()),
            is_interactive: std::io::stderr().is_terminal(),
        }
    }
}

struct Entry {
    name: &'static str,
    command: fn() -> Command,
    run: fn(&ArgMatches, &mut Terminal) -> Result<Outcome, CliError>,
}

const fn entry<S: Subcommand>() -> Entry {
    Entry {
        name: S::NAME,
        command: || {
            let more = S::more_help();
            let gap = if more.is_empty() { "" } else { "\n\n" };
            // After `augment_args`, which sets the type's docstring.
            S::augment_args(Command::new(S::NAME))
                .about(S::ABOUT)
                .long_about(None)
                .after_help(format!("{more}{gap}Example:\n  {}", S::EXAMPLE))
        },
        run: |matches, terminal| {
            // The matches come from the command built from the same type: they always fit, and if
            // not, clap's message says how.
            let arguments = S::from_arg_matches(matches)?;
            arguments.run(terminal)
        },
    }
}

/// Runs the program with the process's arguments and gives its exit code: 0 done, 1 the input is
/// wrong, 2 the call is wrong.
pub fn main() -> u8 {
    run(std::env::args_os(), &mut Terminal::standard())
}

/// Runs the program with the given arguments (the program's name first).
pub fn run(arguments: impl IntoIterator<Item = std::ffi::OsString>, terminal: &mut Terminal) -> u8 {
    let mut command = Command::new("enfilade")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Draw and label floor plans, classify their rooms by building typology, export datasets.")
        .long_about(
            "Draw and label floor plans, classify their rooms by building typology, export datasets.\n\n\
             Without a subcommand the window opens, on PLAN if one is given.",
        )
        .arg(
            clap::Arg::new("plan")
                .value_name("PLAN")
                .value_parser(clap::value_parser!(PathBuf))
                .help("Plan to open in the window"),
        )
        .args_conflicts_with_subcommands(true);
    for entry in SUBCOMMANDS {
        command = command.subcommand((entry.command)());
    }
    let matches = match command.try_get_matches_from(arguments) {
        Ok(matches) => matches,
        Err(error) => {
            let text = error.render();
            let _ = if error.use_stderr() {
                write!(terminal.err, "{text}")
            } else {
                write!(terminal.out, "{text}").and_then(|()| terminal.out.flush())
            };
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let result = match matches.subcommand() {
        Some((name, matches)) => match SUBCOMMANDS.iter().find(|entry| entry.name == name) {
            Some(entry) => (entry.run)(matches, terminal),
            None => Err(CliError::new(format!("unknown subcommand {name}"))),
        },
        None => open::open(matches.get_one::<PathBuf>("plan").map(PathBuf::as_path), terminal),
    };
    let flushed = terminal.out.flush().map_err(CliError::from);
    match result.and_then(|outcome| flushed.map(|()| outcome)) {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::InputWrong) => 1,
        Err(error) if error.broken_pipe => 0,
        Err(error) => {
            let _ = writeln!(terminal.err, "enfilade: {}", error.message);
            1
        }
    }
}
