//! Running commands by id, and reporting to a recorder which ran.

use crate::app::session::executed::Executed;
use crate::base::wording::{or_list, similar};
use std::fmt;
use std::path::PathBuf;
use std::sync::OnceLock;

use egui::Context;

use super::{Action, COMMANDS, Command, Outcome, find};
use crate::app::look::keys::Keys;
use crate::app::look::theme::ThemeChoice;
use crate::app::session::settings::{Keyed, Settings};
use crate::app::state::{App, Asked};
use crate::app::value::{Call, Value, Values, switch_word};
use crate::base::units::Units;

/// Why a command was not run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CommandError {
    /// No command has this id.
    Unknown {
        id: String,
        /// Similar ids, closest first; may be empty.
        similar: Vec<&'static str>,
    },
    /// It is unavailable.
    NotNow {
        id: &'static str,
        /// What to do first: 'pick a room first'.
        reason: String,
    },
    /// An argument is invalid.
    WrongArgument {
        id: &'static str,
        /// The argument's name: 'ROOM'.
        argument: &'static str,
        given: String,
        /// What is not understood, or what it should be, with words that are like the given one.
        what: String,
    },
    /// More arguments were given than the command takes.
    TooManyArguments { id: &'static str, given: usize, most: usize },
}

impl fmt::Display for CommandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { id, similar } if similar.is_empty() => write!(f, "there is no command '{id}'"),
            Self::Unknown { id, similar } => {
                write!(f, "there is no command '{id}'; did you mean {}?", or_list(similar))
            }
            Self::NotNow { id, reason } => write!(f, "'{id}' is not available: {reason}"),
            Self::WrongArgument { id, argument, given, what } => {
                write!(f, "{argument} of '{id}' is '{given}': {what}")
            }
            Self::TooManyArguments { id, given, most: 0 } => write!(f, "'{id}' takes no arguments, but got {given}"),
            Self::TooManyArguments { id, given, most: 1 } => write!(f, "'{id}' takes 1 argument, but got {given}"),
            Self::TooManyArguments { id, given, most } => write!(f, "'{id}' takes {most} arguments, but got {given}"),
        }
    }
}

impl std::error::Error for CommandError {}

impl App {
    /// Runs a command by its id without arguments, as a menu does: it asks for what it needs. Returns
    /// whether the command exists and ran.
    pub fn run_command(&mut self, id: &str, context: &Context) -> bool {
        self.run_command_with(id, &[], context).is_ok()
    }

    /// Runs a command by its id. It asks for missing arguments as from a menu: by a dialog, a text field
    /// that gets the keyboard, or the palette. On an error nothing is done.
    ///
    /// # Errors
    /// When the command does not exist or is unavailable, or an argument is invalid.
    pub fn run_command_with(&mut self, id: &str, arguments: &[&str], context: &Context) -> Result<(), CommandError> {
        let command = self.prepare(id, arguments.len())?;
        let values = self.read_arguments(command, arguments)?;
        self.finish(command, values, context)
    }

    /// Runs a command with values.
    ///
    /// # Errors
    /// As [`App::run_command_with`].
    pub(crate) fn run_call(&mut self, call: Call, context: &Context) -> Result<(), CommandError> {
        let command = self.prepare(call.id, call.values.len())?;
        let values = self.take_arguments(command, call.values)?;
        self.finish(command, values, context)
    }

    /// Runs a command with values, and reports why if it is refused.
    pub(crate) fn act_on(&mut self, call: Call, context: &Context) {
        if let Err(error) = self.run_call(call, context) {
            self.session.say_refused(error.to_string());
        }
    }

    /// The command, if it is available with this many arguments.
    fn prepare(&mut self, id: &str, given: usize) -> Result<&'static Command, CommandError> {
        let command = find(id).ok_or_else(|| CommandError::Unknown {
            id: id.to_owned(),
            similar: similar(id, COMMANDS.iter().map(|command| command.id), 3),
        })?;
        self.session.commit_field();
        let not_now = |reason: String| CommandError::NotNow { id: command.id, reason };
        if let Some(question) = &self.session.question
            && command.id != "answer"
        {
            return Err(not_now(format!("answer '{}' first", question.title)));
        }
        let is_complete = given > 0 && given == command.arguments.len();
        let availability = command.complete_availability.filter(|_| is_complete).unwrap_or(command.availability);
        availability(self).map_err(|reason| not_now(reason.to_owned()))?;
        Ok(command)
    }

    fn finish(&mut self, command: &'static Command, values: Values, context: &Context) -> Result<(), CommandError> {
        let not_now = |reason: String| CommandError::NotNow { id: command.id, reason };
        let ran = self.run_with_values(command, values, context).map_err(not_now);
        self.grant_wishes(context);
        ran
    }

    /// Runs a command with arguments from the window itself, and reports why if it is refused.
    pub(crate) fn act(&mut self, id: &str, arguments: &[&str], context: &Context) {
        if let Err(error) = self.run_command_with(id, arguments, context) {
            self.session.say_refused(error.to_string());
        }
    }

    fn read_arguments(&self, command: &'static Command, arguments: &[&str]) -> Result<Values, CommandError> {
        let (id, most) = (command.id, command.arguments.len());
        if arguments.len() > most {
            return Err(CommandError::TooManyArguments { id, given: arguments.len(), most });
        }
        let read = command.arguments.iter().zip(arguments).map(|(argument, text)| {
            argument.kind.read(self, text).map_err(|what| {
                let given = (*text).to_owned();
                CommandError::WrongArgument { id, argument: argument.name, given, what }
            })
        });
        read.collect::<Result<_, _>>().map(Values)
    }

    fn take_arguments(&self, command: &'static Command, values: Vec<Value>) -> Result<Values, CommandError> {
        let (id, most) = (command.id, command.arguments.len());
        if values.len() > most {
            return Err(CommandError::TooManyArguments { id, given: values.len(), most });
        }
        let taken = command.arguments.iter().zip(values).map(|(argument, value)| {
            let given = argument.kind.write(self, &value);
            argument.kind.take(self, value).map_err(|what| CommandError::WrongArgument {
                id,
                argument: argument.name,
                given,
                what,
            })
        });
        taken.collect::<Result<_, _>>().map(Values)
    }

    /// Runs an available command; `Err` says why it was refused after all.
    fn run_with_values(&mut self, command: &'static Command, values: Values, context: &Context) -> Result<(), String> {
        let is_complete = command.arguments.get(values.0.len()).is_none_or(|argument| argument.is_optional);
        // Before the command runs: it may rename the room, or close the plan, that an argument names.
        let written = self.write_arguments(command, &values);
        self.session.status.clear();
        match &command.action {
            Action::Plain(run) | Action::Choose { run, .. } => {
                run(self, context);
                self.session.note_executed(command.id, written);
            }
            Action::TakeUp(tool) => {
                self.tools.take_up(tool.id);
                self.session.note_executed(command.id, written);
            }
            Action::Switch { is_on, set } => {
                let wanted = match values.0.first() {
                    Some(&Value::Switch(wanted)) => wanted,
                    _ => !is_on(self),
                };
                set(self, wanted);
                self.session.note_executed(command.id, vec![switch_word(wanted).to_owned()]);
            }
            Action::With { run, .. } if is_complete => match run.run(self, &values, context) {
                Outcome::Done => self.session.note_executed(command.id, written),
                Outcome::DoneWith(arguments) => self.session.note_executed(command.id, arguments),
                Outcome::Asks => {}
                Outcome::Refused(reason) => return Err(reason),
            },
            Action::With { ask: Some(ask), .. } => ask(self, context),
            Action::With { ask: None, .. } => self.ask_for_argument(Asked { given: written, ..Asked::of(command.id) }),
        }
        Ok(())
    }

    fn write_arguments(&self, command: &Command, values: &Values) -> Vec<String> {
        command.arguments.iter().zip(&values.0).map(|(argument, value)| argument.kind.write(self, value)).collect()
    }

    // What a recorder sees.

    /// Starts or stops recording the commands that run, for [`App::take_executed`].
    pub fn watch_commands(&mut self, is_watched: bool) {
        self.session.executed = is_watched.then(|| self.session.executed.take().unwrap_or_default());
    }

    /// The commands run since the last call, in order, each with all its arguments, including those it
    /// asked for, and including clicks, typing into fields, panning and zooming. Empty unless they are
    /// watched.
    pub fn take_executed(&mut self) -> Vec<Executed> {
        self.session.executed.as_mut().map(std::mem::take).unwrap_or_default()
    }
}

// Shortcuts.

/// The commands with their default shortcuts, for the settings.
pub(crate) fn keyed() -> &'static [Keyed] {
    static KEYED: OnceLock<Vec<Keyed>> = OnceLock::new();
    let keyed = |command: &Command| Keyed {
        id: command.id,
        title: command.title,
        menu: command.menu.map(|(menu, _)| menu.title()),
        shipped: command.shortcuts.iter().map(|&shortcut| shortcut.into()).collect(),
    };
    KEYED.get_or_init(|| COMMANDS.iter().map(keyed).collect())
}

impl App {
    /// Keeps settings in a file from now on, and loads those it has.
    pub fn use_settings(&mut self, file: PathBuf, context: &Context) {
        let (settings, problems) = Settings::read(file, keyed());
        for panel in self.panels.list {
            if let Some(is_shown) = settings.is_panel_shown(panel.id) {
                self.panels.set_shown(panel.id, is_shown);
            }
        }
        self.session.settings = settings;
        let theme = self.session.settings.theme().and_then(ThemeChoice::of_word).unwrap_or_default();
        self.theme = theme;
        theme.apply(context);
        self.session.look_for_recent();
        for problem in problems {
            self.session.add_message(problem);
        }
    }

    /// The first shortcut of a command in readable form ('Ctrl+Shift+S', '+'); empty if it has none.
    pub fn keys_text(&self, command: &Command, context: &Context) -> String {
        self.session.settings.keys_of(command.id).first().map(|keys| keys.text(context)).unwrap_or_default()
    }

    pub(super) fn set_shortcut(&mut self, id: &'static str, keys: Option<Keys>) -> Outcome {
        match self.session.settings.set_keys(id, keys) {
            Ok(()) => self.keep_settings(),
            Err(refused) => Outcome::Refused(refused.reason(&keys.map(|keys| keys.to_string()).unwrap_or_default())),
        }
    }

    pub(super) fn reset_shortcut(&mut self, id: &'static str) -> Outcome {
        match self.session.settings.reset_keys(id) {
            Ok(()) => self.keep_settings(),
            Err((keys, refused)) => Outcome::Refused(refused.reason(&keys.to_string())),
        }
    }

    pub(super) fn reset_all_shortcuts(&mut self) {
        self.session.settings.reset_all_keys();
        self.keep_settings();
    }

    pub(super) fn set_units(&mut self, units: Units) {
        self.session.settings.set_units(units);
        self.keep_settings();
    }

    /// Sets the spacing of the grid in metres; `None` chooses it by the zoom.
    pub(super) fn set_grid_m(&mut self, grid_m: Option<f64>) {
        self.session.settings.set_grid_m(grid_m);
        self.keep_settings();
    }

    fn keep_settings(&mut self) -> Outcome {
        self.session.keep_settings();
        Outcome::Done
    }

    /// Shows or hides a panel, from now on.
    pub(super) fn set_panel(&mut self, id: &str, is_shown: bool) {
        self.panels.set_shown(id, is_shown);
        self.session.settings.set_panel_shown(id, is_shown);
        self.session.keep_settings();
    }
}
