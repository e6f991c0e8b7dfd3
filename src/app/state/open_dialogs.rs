//! Dialogs that cover the window. A new one is a file, and a line in the panels' list.

use egui::Ui;

use super::App;
use crate::app::session::bulk::Which;
use crate::app::session::words::Choice;

/// A dialog that is open: it shows itself, and remembers what it needs for that.
pub(crate) trait Dialog {
    /// Shows it for a frame.
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After;
}

/// What becomes of a dialog that was shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum After {
    Stay,
    Close,
}

/// What a dialog is opened for.
#[derive(Clone, Debug, Default)]
pub(crate) enum Purpose {
    /// What it is for of itself.
    #[default]
    Usual,
    /// The palette: to ask for an argument.
    Argument(Asked),
    /// Many rooms: to name these.
    NameRooms(Which),
    /// Many rooms: to give them another function or label.
    ChangeRooms,
}

/// An argument that the palette asks for.
#[derive(Clone, Debug)]
pub(crate) struct Asked {
    /// The command's id.
    pub command: &'static str,
    /// The arguments before it.
    pub given: Vec<String>,
    /// The arguments behind it.
    pub rest: Vec<String>,
    /// What the command is about, beside its title; may be empty.
    pub about: String,
    /// What it can be; `None` for what its kind says.
    pub choices: Option<Vec<Choice>>,
    /// What is in the field at first, to be changed.
    pub text: String,
}

impl Asked {
    /// The first argument of a command, of its kind's choices.
    pub(crate) fn of(command: &'static str) -> Self {
        Self { command, given: Vec::new(), rest: Vec::new(), about: String::new(), choices: None, text: String::new() }
    }
}

/// A dialog that can be opened.
pub(crate) struct Entry {
    /// By which it is opened.
    pub id: &'static str,
    pub make: fn(&App, Purpose) -> Box<dyn Dialog>,
    /// Whether it is about the plan that is shown, and closed with it.
    pub is_of_plan: bool,
}

/// The dialogs that are open, each once at most.
pub(crate) struct OpenDialogs {
    /// All there are; of those that are open, a later one lies above an earlier one.
    list: &'static [Entry],
    open: Vec<(&'static str, Box<dyn Dialog>)>,
    /// The one that is being shown, while it is.
    shown: Option<&'static str>,
    /// Whether that one is to be closed.
    closes: bool,
}

impl OpenDialogs {
    pub(crate) const fn new(list: &'static [Entry]) -> Self {
        Self { list, open: Vec::new(), shown: None, closes: false }
    }

    /// Whether a dialog covers the window.
    pub(crate) fn is_any_open(&self) -> bool {
        !self.open.is_empty() || self.shown.is_some()
    }

    pub(crate) fn is_open(&self, id: &str) -> bool {
        (self.shown == Some(id) && !self.closes) || self.is_waiting(id)
    }

    /// Whether it is open and not the one that is being shown: it takes that one's place.
    pub(crate) fn is_waiting(&self, id: &str) -> bool {
        self.open.iter().any(|(open, _)| *open == id)
    }

    /// Opens a dialog in place of one of the same id.
    fn open(&mut self, id: &'static str, dialog: Box<dyn Dialog>) {
        self.open.retain(|(open, _)| *open != id);
        self.open.push((id, dialog));
    }

    pub(crate) fn close(&mut self, id: &str) {
        self.open.retain(|(open, _)| *open != id);
        self.closes |= self.shown == Some(id);
    }

    /// Closes those that are about the plan that was shown.
    pub(crate) fn forget_plan(&mut self) {
        self.list.iter().filter(|entry| entry.is_of_plan).for_each(|entry| self.close(entry.id));
    }
}

impl App {
    /// Opens a dialog of the list, anew if it is open.
    pub(crate) fn open_dialog(&mut self, id: &str) {
        self.open_dialog_for(id, Purpose::Usual);
    }

    /// Opens a dialog of the list for something, anew if it is open.
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

    /// Opens a dialog of the list unless it is open, or closes it.
    pub(crate) fn set_dialog(&mut self, id: &str, is_open: bool) {
        match is_open {
            true if self.dialogs.is_open(id) => {}
            true => self.open_dialog(id),
            false => self.dialogs.close(id),
        }
    }

    /// Shows the dialogs that are open.
    pub(crate) fn show_dialogs(&mut self, ui: &mut Ui) {
        for &Entry { id, .. } in self.dialogs.list {
            let Some(index) = self.dialogs.open.iter().position(|(open, _)| *open == id) else { continue };
            let (_, mut dialog) = self.dialogs.open.remove(index);
            (self.dialogs.shown, self.dialogs.closes) = (Some(id), false);
            let after = dialog.show(self, ui);
            self.dialogs.shown = None;
            // It may have opened one of its own kind.
            let is_closed = self.dialogs.closes || after == After::Close || self.dialogs.is_waiting(id);
            if !is_closed {
                self.dialogs.open.push((id, dialog));
            }
        }
    }
}

/// What dialogs are called, by those that open them and those that show them.
pub(crate) mod dialogs {
    pub(crate) const RECOVERY: &str = "recovery";
    pub(crate) const DIFFERENCES: &str = "differences";
    pub(crate) const NOTES: &str = "import-notes";
    pub(crate) const PALETTE: &str = "commands";
    pub(crate) const SHORTCUTS: &str = "shortcuts";
    pub(crate) const ABOUT: &str = "about";
    pub(crate) const BULK: &str = "many-rooms";
}
