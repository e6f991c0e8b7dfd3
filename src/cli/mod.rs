//! The command line. One file per subcommand, and one line in `SUBCOMMANDS` to register it.

mod batch;
mod call;
mod check;
mod classify;
mod collect;
#[cfg(feature = "gui")]
mod commands;
mod compare;
mod completions;
mod dataset;
mod door;
mod evaluate;
mod explore;
mod export;
mod features;
mod import;
mod inputs;
mod label;
mod man;
mod manifest;
mod map;
mod mistyped;
mod models;
mod numbers;
mod open;
mod outputs;
mod predictions;
mod progress;
mod render;
mod repeats;
#[cfg(feature = "gui")]
mod replay;
mod review;
mod robot_study;
mod scales;
mod segment;
mod suspects;
mod train;
mod workspace;

use std::ffi::OsString;
use std::fmt::Display;
use std::io::{IsTerminal as _, Write};
use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Args, Command};

pub use door::Door;
use door::{Paint, one_line};

use crate::store::pictures;

/// All subcommands, in the order of the help.
#[rustfmt::skip] // one line each
const SUBCOMMANDS: &[Entry] = &[
    entry::<import::ImportCommand>(),
    entry::<features::FeaturesCommand>(),
    entry::<dataset::DatasetCommand>(),
    entry::<export::ExportCommand>(),
    entry::<check::CheckCommand>(),
    entry::<workspace::WorkspaceCommand>(),
    entry::<render::RenderCommand>(),
    entry::<classify::ClassifyCommand>(),
    entry::<evaluate::EvaluateCommand>(),
    entry::<suspects::SuspectsCommand>(),
    entry::<review::ReviewCommand>(),
    entry::<compare::CompareCommand>(),
    entry::<label::LabelCommand>(),
    entry::<train::TrainCommand>(),
    entry::<models::ModelsCommand>(),
    entry::<explore::ExploreCommand>(),
    entry::<map::MapCommand>(),
    entry::<segment::SegmentCommand>(),
    entry::<robot_study::RobotStudyCommand>(),
    #[cfg(feature = "gui")]
    entry::<replay::ReplayCommand>(),
    #[cfg(feature = "gui")]
    entry::<commands::CommandsCommand>(),
    entry::<completions::CompletionsCommand>(),
    entry::<man::ManCommand>(),
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
    /// When the input is wrong so that there is no result (exit code 1), or the call is (exit code 2,
    /// [`CliError::call`], before anything is read or written); the message goes to stderr.
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
    /// Whether the call is wrong, not what it was to work on.
    pub wrong_call: bool,
}

impl<E: std::error::Error + 'static> From<E> for CliError {
    fn from(error: E) -> Self {
        let io = (&error as &dyn std::error::Error).downcast_ref::<std::io::Error>();
        let broken_pipe = io.is_some_and(|io| io.kind() == std::io::ErrorKind::BrokenPipe);
        Self { message: error.to_string(), broken_pipe, wrong_call: false }
    }
}

impl CliError {
    /// The input is wrong.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), broken_pipe: false, wrong_call: false }
    }

    /// The call is wrong: said before anything is done, exit code 2.
    pub fn call(message: impl Into<String>) -> Self {
        Self { wrong_call: true, ..Self::new(message) }
    }
}

/// Where a subcommand writes, and what its caller wants to hear.
pub struct Terminal {
    /// Results.
    pub out: Door,
    /// Errors, warnings, reports.
    pub err: Door,
    /// Whether `err` is a terminal: progress is shown on one only.
    pub is_interactive: bool,
    call: Call,
}

/// What every subcommand is told.
#[derive(Clone, Copy, Debug, Default)]
struct Call {
    /// Its name; empty for the window.
    command: &'static str,
    quiet: bool,
    verbose: bool,
    /// Files that another made may be replaced.
    force: bool,
    /// Threads to work on; as many as there are processors without.
    jobs: Option<usize>,
    /// Whether a result went to stdout: then nothing else does.
    out_is_result: bool,
}

impl Terminal {
    /// The process's stdout (buffered) and stderr.
    pub fn standard() -> Self {
        let is_interactive = std::io::stderr().is_terminal();
        Self {
            out: Door::to(Box::new(std::io::BufWriter::new(std::io::stdout())), std::io::stdout().is_terminal()),
            err: Door::to(Box::new(std::io::stderr()), is_interactive),
            is_interactive,
            call: Call::default(),
        }
    }

    /// Other places than the process's own, neither of them a terminal.
    pub fn new(out: impl Write + 'static, err: impl Write + 'static) -> Self {
        let (out, err) = (Door::new(Box::new(out)), Door::new(Box::new(err)));
        Self { out, err, is_interactive: false, call: Call::default() }
    }

    /// Says on stderr what is wrong, in one line.
    ///
    /// # Errors
    /// When stderr cannot be written.
    pub fn error(&mut self, what: impl Display) -> std::io::Result<()> {
        writeln!(self.err, "{}: {}", Paint::Error.on("enfilade"), one_line(&what.to_string()))?;
        self.err.flush()
    }

    /// Says on stderr what is worth knowing, in one line; not with `--quiet`.
    ///
    /// # Errors
    /// When stderr cannot be written.
    pub fn remark(&mut self, what: impl Display) -> std::io::Result<()> {
        if self.call.quiet {
            return Ok(());
        }
        writeln!(self.err, "{}", one_line(&what.to_string()))?;
        self.err.flush()
    }

    /// Says on stderr what only `--verbose` asks for, in one line.
    ///
    /// # Errors
    /// When stderr cannot be written.
    pub fn detail(&mut self, what: impl Display) -> std::io::Result<()> {
        if self.call.verbose { self.remark(what) } else { Ok(()) }
    }

    /// Says on stdout what was done, in one line, or on stderr when a result is on stdout; not with `--quiet`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn report(&mut self, what: impl Display) -> std::io::Result<()> {
        if self.call.out_is_result {
            return self.remark(what);
        }
        if self.call.quiet {
            return Ok(());
        }
        writeln!(self.out, "{}", one_line(&what.to_string()))?;
        // Said at once: many files take a while.
        self.out.flush()
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
            let command = S::augment_args(Command::new(S::NAME))
                .about(S::ABOUT)
                .long_about(None)
                .after_help(format!("{more}{gap}Example:\n  {}", S::EXAMPLE));
            with_common_options(command)
        },
        run: |matches, terminal| {
            let flag = |name: &str| matches.try_get_one::<bool>(name).ok().flatten().is_some_and(|&is_set| is_set);
            terminal.call = Call {
                command: S::NAME,
                quiet: flag("quiet"),
                verbose: flag("verbose"),
                force: flag("force"),
                out_is_result: false,
                jobs: matches.try_get_one::<u16>("jobs").ok().flatten().map(|&jobs| usize::from(jobs)),
            };
            terminal.is_interactive &= !terminal.call.quiet;
            // The matches come from the command built from the same type: they always fit, and if
            // not, clap's message says how.
            let arguments = S::from_arg_matches(matches)?;
            arguments.run(terminal)
        },
    }
}

/// The options that all subcommands have, and `--force` for those that write.
fn with_common_options(command: Command) -> Command {
    const HEADING: &str = "Common options";
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help_heading(HEADING);
    let writes = command.get_arguments().any(|argument| argument.get_id() == "output");
    let force = flag("force").help("Overwrite existing files, whoever wrote them");
    let force = writes.then_some(force);
    command
        .args(force)
        .arg(
            Arg::new("jobs")
                .long("jobs")
                .alias("threads")
                .short('j')
                .value_name("N")
                .value_parser(clap::value_parser!(u16).range(1..))
                .help_heading(HEADING)
                .help("Number of threads [default: one per processor]; results do not depend on it"),
        )
        .arg(flag("quiet").short('q').conflicts_with("verbose").help("Print only results and errors"))
        .arg(flag("verbose").short('v').help("Print more: what readers repaired or left out, and where"))
}

/// Runs the program with the process's arguments and gives its exit code: 0 done, 1 the input is
/// wrong, 2 the call is wrong.
pub fn main() -> u8 {
    if let Some(code) = pictures::answer_if_asked() {
        return code;
    }
    pictures::decode_by_this_program();
    run(std::env::args_os(), &mut Terminal::standard())
}

/// The whole command line as clap knows it.
pub fn command() -> Command {
    let command = Command::new("enfilade")
        .version(VERSION)
        .about("Draw floor plans, label their rooms, predict labels by building type, and export datasets.")
        .long_about(
            "Draw floor plans, label their rooms, predict labels by building type, and export datasets.\n\nWithout a \
             subcommand the window opens, with the plans that you give.",
        )
        .after_help(
            "Use '-' instead of a file for stdin or stdout. Exit codes: 0 done, 1 something is wrong with the input, \
             2 the call is wrong.",
        )
        .arg(
            Arg::new("plan")
                .value_name("PLAN")
                .num_args(0..)
                .value_parser(clap::value_parser!(PathBuf))
                .help("Plans to open in the window"),
        )
        .arg(
            Arg::new("demo")
                .long("demo")
                .action(ArgAction::SetTrue)
                .conflicts_with("plan")
                .help("Start with the demonstration: a school is drawn and labelled in less than a minute"),
        )
        .args_conflicts_with_subcommands(true);
    SUBCOMMANDS.iter().fold(command, |command, entry| command.subcommand((entry.command)()))
}

/// '0.1.0 (commit 1a2b3c4d5e6f)'; see `build.rs`.
pub const VERSION: &str = env!("ENFILADE_VERSION");

/// Runs the program with the given arguments (the program's name first).
pub fn run(arguments: impl IntoIterator<Item = OsString>, terminal: &mut Terminal) -> u8 {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    call::remember_command(&arguments);
    let command = command();
    if let Some(what) = mistyped::subcommand(&arguments, &command) {
        // Whoever closed stderr does not read it.
        let _ = terminal.error(what);
        return 2;
    }
    let matches = match command.try_get_matches_from(arguments) {
        Ok(matches) => matches,
        Err(error) => {
            let text = error.render();
            let _ = if error.use_stderr() {
                write!(terminal.err, "{text}").and_then(|()| terminal.err.flush())
            } else {
                write!(terminal.out, "{text}").and_then(|()| terminal.out.flush())
            };
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    let result = match matches.subcommand() {
        Some((name, matches)) => match SUBCOMMANDS.iter().find(|entry| entry.name == name) {
            Some(entry) => (entry.run)(matches, terminal),
            None => Err(CliError::call(format!("unknown subcommand {name}"))),
        },
        None => {
            let plans: Vec<PathBuf> = matches.get_many("plan").into_iter().flatten().cloned().collect();
            open::open(&plans, matches.get_flag("demo"), terminal)
        }
    };
    let flushed = terminal.out.flush().map_err(CliError::from);
    match result.and_then(|outcome| flushed.map(|()| outcome)) {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::InputWrong) => 1,
        Err(error) if error.broken_pipe => 0,
        Err(error) => {
            let _ = terminal.error(&error.message);
            if error.wrong_call && !terminal.call.command.is_empty() {
                let _ = terminal.remark(format!("See 'enfilade {} --help'.", terminal.call.command));
            }
            if error.wrong_call { 2 } else { 1 }
        }
    }
}
