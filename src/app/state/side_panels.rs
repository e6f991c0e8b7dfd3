//! Panels at the sides of the canvas. A new one is a file, and a line in the panels' list.

use std::collections::{BTreeMap, BTreeSet};

use egui::Ui;

use super::App;
use crate::app::session::fields::FieldKind;

/// A panel at a side of the canvas.
pub(crate) struct SidePanel {
    /// By which commands and scripts call it.
    pub id: &'static str,
    /// In the menu.
    pub title: &'static str,
    /// A sentence for tooltips.
    pub help: &'static str,
    pub side: Side,
    pub height: Height,
    /// Whether it is shown before anybody chose.
    pub is_shown_at_first: bool,
    /// Whether it is shown only with a plan.
    pub needs_plan: bool,
    /// Whether a command of its own shows and hides it; others have a row in the menu, and 'panel' for scripts.
    pub has_own_command: bool,
    pub show: fn(&mut App, &mut Ui),
}

/// A side of the canvas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Left,
    Right,
}

/// How high a panel is among those of its side, in points. They stand below each other in the order of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Height {
    /// What the others leave, and no less than this: one of each side.
    Rest { least: f32 },
    /// As high as what is in it, which scrolls where there is less.
    Content { usual: f32 },
    /// As a person drags it.
    Dragged { usual: f32, least: f32 },
}

/// What the panels remember.
pub(crate) struct Panels {
    /// All there are at the sides.
    pub list: &'static [SidePanel],
    shown: BTreeSet<&'static str>,
    /// The text of a room whose field is to take the keyboard.
    pub focus: Option<FieldKind>,
    /// Commands that were done from the palette, the last one first.
    pub recent: Vec<&'static str>,
    /// The pattern by which rooms were named last.
    pub pattern: Option<String>,
    /// Where the panels on the left, what is between, and those on the right were in the last frame, as far as shown.
    pub left_rect: Option<egui::Rect>,
    pub middle_rect: Option<egui::Rect>,
    pub right_rect: Option<egui::Rect>,
    /// Height in points of what was in the panels that are as high as that, when they were last shown.
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

    /// Those that no command of their own shows and hides.
    pub(crate) fn others(&self) -> impl Iterator<Item = &'static SidePanel> + use<> {
        self.list.iter().filter(|panel| !panel.has_own_command)
    }

    /// Whether a panel is shown, with a plan where it needs one.
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

/// What panels that commands name are called.
pub(crate) mod ids {
    pub(crate) const PLANS: &str = "plans";
    pub(crate) const LAYERS: &str = "layers";
    pub(crate) const INSPECTOR: &str = "inspector";
    pub(crate) const HISTORY: &str = "history";
}
