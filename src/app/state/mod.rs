//! The window's state, apart from any display, and the dialogs open over it.

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
use egui::Context;
use std::path::PathBuf;

mod arrivals;
mod open_dialogs;
mod side_panels;

pub(crate) use arrivals::Arrivals;
pub(crate) use open_dialogs::{After, Asked, Dialog, Entry, OpenDialogs, Purpose, dialogs};
pub(crate) use side_panels::Here;
pub(crate) use side_panels::{Height, Panels, Side, SidePanel, Thing, ids as panels};

/// The window's state, apart from any display.
pub struct App {
    pub(crate) session: Session,
    pub(crate) canvas: Canvas,
    pub(crate) tools: Toolbox,
    pub(crate) theme: ThemeChoice,
    pub(crate) panels: Panels,
    pub(crate) dialogs: OpenDialogs,
    pub(crate) samples: Samples,
    /// Input that waits for its frame.
    pub(crate) arrivals: Arrivals,
    /// Whether a text field had the keyboard at the end of the last frame.
    pub(crate) was_typing: bool,
    pub(crate) is_close_sent: bool,
    pub(crate) shown_title: String,
    /// The recording in progress; only `replay` can look inside.
    pub(crate) recorder: Option<Box<dyn std::any::Any>>,
    /// Whether to start a recording.
    pub(crate) wants_recording: bool,
}

impl App {
    /// The open plan.
    pub fn plan(&self) -> Option<&Plan> {
        self.session.plan()
    }

    /// The selection.
    pub fn selection(&self) -> &Selection {
        self.session.selection()
    }

    /// The selected element, if there is exactly one.
    pub fn picked(&self) -> Option<ElementId> {
        self.session.picked()
    }

    /// The messages above the canvas: dismissible ones, oldest first, then those that stay as long as
    /// they are true.
    pub fn messages(&self) -> Vec<Message> {
        self.session.messages()
    }

    /// Whether the plan has unsaved changes.
    pub fn has_unsaved_changes(&self) -> bool {
        self.session.has_unsaved_changes()
    }

    /// The predictions for the current plan; `None` while they are being computed.
    pub fn predictions(&self) -> Option<&Predictions> {
        self.session.predictions()
    }

    /// The plan of the storey below, if one is shown.
    pub fn ghost_plan(&self) -> Option<&Plan> {
        self.session.ghost_plan()
    }

    /// The lines of the storey below that can be snapped to.
    pub fn ghost_segments(&self) -> &[Segment] {
        self.session.ghost_segments()
    }

    /// The visible guide lines of the open plan, for snapping.
    pub fn guides(&self) -> &[Guide] {
        self.session.guides()
    }

    /// The units in which lengths and areas are shown and typed.
    pub fn units(&self) -> Units {
        self.session.units()
    }

    /// Keeps journals in a folder from now on, and offers those left there.
    pub fn use_journal(&mut self, folder: PathBuf) {
        self.session.use_journal(folder);
    }

    /// Undoes the last change, or the last corner of what is being drawn. Returns whether the plan's last
    /// step was undone.
    pub(crate) fn undo(&mut self) -> bool {
        if self.tools.take_back() == TakenBack::Corner {
            return false;
        }
        self.session.undo();
        true
    }

    /// Gives the keyboard to the inspector's field for a text of the picked room.
    pub(crate) fn ask_for_field(&mut self, kind: FieldKind) {
        self.panels.set_shown(panels::INSPECTOR, true);
        self.panels.focus = Some(kind);
    }

    /// The screen position of a point of the plan (in metres), in egui's points; `None` before the first
    /// frame and without a plan.
    pub fn screen_position(&self, x_m: f64, y_m: f64) -> Option<egui::Pos2> {
        self.canvas.screen_position(crate::geometry::Point::new(x_m, y_m))
    }

    pub(crate) fn set_theme(&mut self, theme: ThemeChoice, context: &Context) {
        self.theme = theme;
        theme.apply(context);
        self.session.settings.set_theme(theme.word());
        self.session.keep_settings();
    }
}
