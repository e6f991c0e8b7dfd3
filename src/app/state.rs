//! The window's state, apart from any display, and the dialogs that are open over it.

use crate::app::canvas::Canvas;
use crate::app::look::theme::ThemeChoice;
use crate::app::session::Session;
use crate::app::session::fields::FieldKind;
use crate::app::session::messages::Message;
use crate::app::session::samples::Samples;
use crate::app::session::selection::Selection;
use crate::app::tools::TakenBack;
use crate::app::tools::Toolbox;
use crate::base::units::Units;
use crate::geometry::Segment;
use crate::plan::ElementId;
use crate::plan::Guide;
use crate::plan::Plan;
use crate::predict::Predictions;
use egui::{Context, Ui};
use std::path::PathBuf;
/// The window's state, apart from any display.
pub struct App {
    pub(crate) session: Session,
    pub(crate) canvas: Canvas,
    pub(crate) tools: Toolbox,
    pub(crate) theme: ThemeChoice,
    pub(crate) panels: Panels,
    pub(crate) dialogs: OpenDialogs,
    pub(crate) samples: Samples,
    /// Whether a text field had the keyboard when the last frame ended.
    pub(crate) was_typing: bool,
    pub(crate) is_close_sent: bool,
    pub(crate) shown_title: String,
    /// What is being recorded; only `replay` looks into it.
    pub(crate) recorder: Option<Box<dyn std::any::Any>>,
    /// A recording is to begin.
    pub(crate) wants_recording: bool,
}

impl App {
    /// The open plan.
    pub fn plan(&self) -> Option<&Plan> {
        self.session.plan()
    }

    /// What is selected.
    pub fn selection(&self) -> &Selection {
        self.session.selection()
    }

    /// The element that is selected, where it is exactly one.
    pub fn picked(&self) -> Option<ElementId> {
        self.session.picked()
    }

    /// What stands above the canvas: messages, the oldest first, then what stays as long as it is so.
    pub fn messages(&self) -> Vec<Message> {
        self.session.messages()
    }

    /// Whether the plan has changes that are in no file.
    pub fn has_unsaved_changes(&self) -> bool {
        self.session.has_unsaved_changes()
    }

    /// What is said of the rooms of the plan as it is now; `None` while that is being worked out.
    pub fn predictions(&self) -> Option<&Predictions> {
        self.session.predictions()
    }

    /// The plan of the storey below, while one is shown.
    pub fn ghost_plan(&self) -> Option<&Plan> {
        self.session.ghost_plan()
    }

    /// The lines of the storey below that attract.
    pub fn ghost_segments(&self) -> &[Segment] {
        self.session.ghost_segments()
    }

    /// The guide lines of the open plan that are shown: what snapping may go by.
    pub fn guides(&self) -> &[Guide] {
        self.session.guides()
    }

    /// In which units lengths and areas are shown and typed.
    pub fn units(&self) -> Units {
        self.session.units()
    }

    /// Keeps journals in a folder from now on, and offers what is left there.
    pub fn use_journal(&mut self, folder: PathBuf) {
        self.session.use_journal(folder);
    }

    /// Takes the last change back, or the last corner of what is being drawn. Gives whether the plan's
    /// last step was undone.
    pub(crate) fn undo(&mut self) -> bool {
        if self.tools.take_back() == TakenBack::Corner {
            return false;
        }
        self.session.undo();
        true
    }

    /// Gives the keyboard to the inspector's field for a text of the picked room.
    pub(crate) fn ask_for_field(&mut self, kind: FieldKind) {
        self.panels.right = true;
        self.panels.focus = Some(kind);
    }

    /// Where a point of the plan (in metres) is on the screen, in egui's points; `None` before the
    /// first frame and without a plan.
    pub fn screen_position(&self, x_m: f64, y_m: f64) -> Option<egui::Pos2> {
        self.canvas.screen_position(crate::geometry::Point::new(x_m, y_m))
    }

    pub(crate) fn set_theme(&mut self, theme: ThemeChoice, context: &Context) {
        self.theme = theme;
        theme.apply(context);
    }
}

// Dialogs that cover the window. A new one is a file, and a line in the panels' list.

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

/// A dialog that can be opened.
pub(crate) struct Entry {
    /// By which it is opened.
    pub id: &'static str,
    pub make: fn(&App) -> Box<dyn Dialog>,
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
    pub(crate) fn open(&mut self, id: &'static str, dialog: Box<dyn Dialog>) {
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
        if let Some(entry) = self.dialogs.list.iter().find(|entry| entry.id == id) {
            let dialog = (entry.make)(self);
            self.dialogs.open(entry.id, dialog);
        }
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

/// What the panels remember.
pub(crate) struct Panels {
    /// Whether the panel of plans and layers is shown.
    pub left: bool,
    /// Whether the inspector is shown.
    pub right: bool,
    /// Whether the history is shown, below the inspector.
    pub history: bool,
    /// The text of a room whose field is to take the keyboard.
    pub focus: Option<FieldKind>,
    /// Commands that were done from the palette, the last one first.
    pub recent: Vec<&'static str>,
    /// The pattern by which rooms were named last.
    pub pattern: Option<String>,
    /// Where the panel on the left, what is between, and the inspector were in the last frame, as far as shown.
    pub left_rect: Option<egui::Rect>,
    pub middle_rect: Option<egui::Rect>,
    pub right_rect: Option<egui::Rect>,
    /// Height in points that the fill and the layers took when they were last shown.
    pub layers_height: f32,
}

impl Default for Panels {
    fn default() -> Self {
        Self {
            left: true,
            right: true,
            history: false,
            focus: None,
            recent: Vec::new(),
            pattern: None,
            left_rect: None,
            middle_rect: None,
            right_rect: None,
            layers_height: 360.0,
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
