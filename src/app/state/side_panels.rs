//! Side panels of the canvas. To add one, write a file, and a line in the panels' list.

use std::collections::{BTreeMap, BTreeSet};

use egui::Ui;

use super::App;
use crate::app::session::fields::FieldKind;

/// A side panel of the canvas.
pub(crate) struct SidePanel {
    /// Its id for commands and scripts.
    pub id: &'static str,
    /// In the menu.
    pub title: &'static str,
    /// A sentence for tooltips.
    pub help: &'static str,
    pub side: Side,
    pub height: Height,
    /// Whether it is shown by default.
    pub is_shown_at_first: bool,
    /// Whether it is only shown with a plan.
    pub needs_plan: bool,
    /// Whether it has a command of its own to show and hide it; others have a row in the menu, and
    /// 'panel' for scripts.
    pub has_own_command: bool,
    pub show: fn(&mut App, &mut Ui),
}

/// A side of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// The height of a panel among those of its side, in points. They are stacked in the order of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Height {
    /// The rest, but no less than this: for one panel of each side.
    Rest { least: f32 },
    /// That of its contents, which scroll if there is less.
    Content { usual: f32 },
    /// As set by dragging.
    Dragged { usual: f32, least: f32 },
}

/// The state of the panels.
pub(crate) struct Panels {
    /// All side panels.
    pub list: &'static [SidePanel],
    shown: BTreeSet<&'static str>,
    /// The text of a room whose field should get the keyboard.
    pub focus: Option<FieldKind>,
    /// Commands run from the palette, latest first.
    pub recent: Vec<&'static str>,
    /// The last pattern used to name rooms.
    pub pattern: Option<String>,
    /// The format and the options last used to export, by the format's id: `paper=A3 scale=1:100`.
    pub export: (Option<&'static str>, BTreeMap<&'static str, String>),
    /// The rectangles of the panels on the left, the middle, and those on the right in the last frame, if
    /// shown.
    pub left_rect: Option<egui::Rect>,
    pub middle_rect: Option<egui::Rect>,
    pub right_rect: Option<egui::Rect>,
    /// Height in points of the contents of panels sized by them, when last shown.
    pub content_heights: BTreeMap<&'static str, f32>,
}

impl Panels {
    pub(crate) fn new(list: &'static [SidePanel]) -> Self {
        Self {
            list,
            shown: list.iter().filter(|panel| panel.is_shown_at_first).map(|panel| panel.id).collect(),
            focus: None,
            recent: Vec::new(),
            pattern: None,
            export: (None, BTreeMap::new()),
            left_rect: None,
            middle_rect: None,
            right_rect: None,
            content_heights: BTreeMap::new(),
        }
    }

    /// The panel with an id.
    pub(crate) fn find(&self, id: &str) -> Option<&'static SidePanel> {
        self.list.iter().find(|panel| panel.id == id)
    }

    /// Those without a command of their own.
    pub(crate) fn others(&self) -> impl Iterator<Item = &'static SidePanel> + use<> {
        self.list.iter().filter(|panel| !panel.has_own_command)
    }

    /// Whether a panel is shown: if it needs a plan, only with one.
    pub(crate) fn is_shown(&self, id: &str) -> bool {
        self.shown.contains(id)
    }

    pub(crate) fn set_shown(&mut self, id: &str, is_shown: bool) {
        match self.find(id) {
            Some(panel) if is_shown => drop(self.shown.insert(panel.id)),
            Some(panel) => drop(self.shown.remove(panel.id)),
            None => {}
        }
    }
}

/// The ids of panels that commands refer to.
pub(crate) mod ids {
    pub(crate) const PLANS: &str = "plans";
    pub(crate) const LAYERS: &str = "layers";
    pub(crate) const INSPECTOR: &str = "inspector";
    pub(crate) const HISTORY: &str = "history";
    pub(crate) const FINDINGS: &str = "findings";
}
