//! Dialogs over the window. To add one, write a file, and a line in the panels' list.

use egui::Ui;

use super::App;
use crate::app::session::bulk::Which;
use crate::app::session::words::Choice;

/// An open dialog: it shows itself, and keeps its own state.
pub(crate) trait Dialog {
    /// Shows it for a frame.
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After;
}

/// What happens to a dialog after it was shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum After {
    Stay,
    Close,
}

/// The purpose of opening a dialog.
#[derive(Clone, Debug, Default)]
pub(crate) enum Purpose {
    /// Its usual purpose.
    #[default]
    Usual,
    /// The palette: to ask for an argument.
    Argument(Asked),
    /// Many rooms: to name these.
    NameRooms(Which),
    /// Many rooms: to change their function or label.
    ChangeRooms,
    /// Exporting: to print.
    Print,
}

/// A request to the palette for an argument.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// The command's id.
    pub command: &'static str,
    /// The arguments before it.
    pub given: Vec<String>,
    /// The arguments after it.
    pub rest: Vec<String>,
    /// What the command applies to, shown beside its title; may be empty.
    pub about: String,
    /// The choices; `None` for those of its kind.
    pub choices: Option<Vec<Choice>>,
    /// The initial text of the field.
    pub text: String,
}

impl Asked {
    /// A request for the first argument of a command, with the choices of its kind.
    pub(crate) fn of(command: &'static str) -> Self {
        Self { command, given: Vec::new(), rest: Vec::new(), about: String::new(), choices: None, text: String::new() }
    }
}

/// A dialog that can be opened.
pub(crate) struct Entry {
    /// The id to open it by.
    pub id: &'static str,
    pub make: fn(&App, Purpose) -> Box<dyn Dialog>,
    /// Whether it belongs to the plan shown, and closes with it.
    pub is_of_plan: bool,
}

/// The open dialogs, each at most once.
pub(crate) struct OpenDialogs {
    /// All dialogs; of the open ones, later ones are above earlier ones.
    list: &'static [Entry],
    open: Vec<(&'static str, Box<dyn Dialog>)>,
    /// The one being shown at the moment.
    shown: Option<&'static str>,
    /// Whether that one should close.
    closes: bool,
}

impl OpenDialogs {
    pub(crate) const fn new(list: &'static [Entry]) -> Self {
        Self { list, open: Vec::new(), shown: None, closes: false }
    }

    /// Whether any dialog is open.
    pub(crate) fn is_any_open(&self) -> bool {
        !self.open.is_empty() || self.shown.is_some()
    }

    pub(crate) fn is_open(&self, id: &str) -> bool {
        (self.shown == Some(id) && !self.closes) || self.is_waiting(id)
    }

    /// Whether it is open and not being shown at the moment; if its predecessor is, it will replace that.
    pub(crate) fn is_waiting(&self, id: &str) -> bool {
        self.open.iter().any(|(open, _)| *open == id)
    }

    /// Opens a dialog, replacing one with the same id.
    fn open(&mut self, id: &'static str, dialog: Box<dyn Dialog>) {
        self.open.retain(|(open, _)| *open != id);
        self.open.push((id, dialog));
    }

    pub(crate) fn close(&mut self, id: &str) {
        self.open.retain(|(open, _)| *open != id);
        self.closes |= self.shown == Some(id);
    }

    /// Closes those that belong to the previous plan.
    pub(crate) fn forget_plan(&mut self) {
        self.list.iter().filter(|entry| entry.is_of_plan).for_each(|entry| self.close(entry.id));
    }
}

impl App {
    /// Opens a dialog of the list, afresh if it is already open.
    pub(crate) fn open_dialog(&mut self, id: &str) {
        self.open_dialog_for(id, Purpose::Usual);
    }

    /// Opens a dialog of the list for a purpose, afresh if it is already open.
    pub(crate) fn open_dialog_for(&mut self, id: &str, purpose: Purpose) {
        if let Some(entry) = self.dialogs.list.iter().find(|entry| entry.id == id) {
            let dialog = (entry.make)(self, purpose);
            self.dialogs.open(entry.id, dialog);
        }
    }

    /// Opens the palette to ask for an argument.
    pub(crate) fn ask_for_argument(&mut self, asked: Asked) {
        self.open_dialog_for(dialogs::PALETTE, Purpose::Argument(asked));
    }

    /// Opens a dialog of the list if it is not open, or closes it.
    pub(crate) fn set_dialog(&mut self, id: &str, is_open: bool) {
        match is_open {
            true if self.dialogs.is_open(id) => {}
            true => self.open_dialog(id),
            false => self.dialogs.close(id),
        }
    }

    /// Shows the open dialogs.
    pub(crate) fn show_dialogs(&mut self, ui: &mut Ui) {
        for &Entry { id, .. } in self.dialogs.list {
            let Some(index) = self.dialogs.open.iter().position(|(open, _)| *open == id) else { continue };
            let (_, mut dialog) = self.dialogs.open.remove(index);
            (self.dialogs.shown, self.dialogs.closes) = (Some(id), false);
            let after = dialog.show(self, ui);
            self.dialogs.shown = None;
            // It may have opened another of its own kind.
            let is_closed = self.dialogs.closes || after == After::Close || self.dialogs.is_waiting(id);
            if !is_closed {
                self.dialogs.open.push((id, dialog));
            }
        }
    }
}

/// The ids of dialogs, for those that open them and those that show them.
pub(crate) mod dialogs {
    pub(crate) const RECOVERY: &str = "recovery";
    pub(crate) const DIFFERENCES: &str = "differences";
    pub(crate) const NOTES: &str = "import-notes";
    pub(crate) const PALETTE: &str = "commands";
    pub(crate) const SHORTCUTS: &str = "shortcuts";
    pub(crate) const ABOUT: &str = "about";
    pub(crate) const BULK: &str = "many-rooms";
    pub(crate) const EXPORT: &str = "export";
    pub(crate) const WORKSPACE: &str = "workspace";
    pub(crate) const DATASET: &str = "export-dataset";
    pub(crate) const DASHBOARD: &str = "dashboard";
    pub(crate) const TRAINING: &str = "train";
    pub(crate) const SCHEMES: &str = "schemes";
}
