//! Side panels of the canvas. To add one, write a file, and a line in the panels' list.

use std::collections::{BTreeMap, BTreeSet};

use egui::Ui;

use super::App;
use crate::app::session::fields::FieldKind;
use crate::app::session::origin::Origin;
use crate::geometry::Point;
use crate::plan::{ElementId, GuideAxis};

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

/// An element that is changed where it is.
#[derive(Clone, Debug)]
pub(crate) struct Here {
    pub element: ElementId,
    /// The form is beside this point of the plan.
    pub at: Point,
    /// What is typed, and what stood there before.
    pub texts: Vec<String>,
    pub before: Vec<String>,
    /// Whether it has been shown: at first it takes the keyboard.
    pub is_shown: bool,
}

/// What a context menu is about.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Thing {
    /// What is selected, and this with it.
    Element(ElementId),
    /// A place of the plan where nothing is.
    Free,
    /// A guide line: its direction and its place in metres.
    Guide(GuideAxis, f64),
    /// The picture under the plan.
    Picture,
    /// A plan in the list.
    Listed(Origin),
}

/// The state of the panels.
pub(crate) struct Panels {
    /// All side panels.
    pub list: &'static [SidePanel],
    shown: BTreeSet<&'static str>,
    /// The form in which an element is changed where it is.
    pub here: Option<Here>,
    /// The thing whose context menu is open, where, and which menu in a row it is.
    pub context_menu: Option<(Thing, egui::Pos2, usize)>,
    /// The buttons of the menus in the bar, from the left.
    pub menu_buttons: BTreeMap<usize, egui::Id>,
    /// Whether the menu that opens gets the keyboard.
    pub menu_takes_keyboard: bool,
    /// Whether Alt is held and nothing else was pressed since.
    pub alt_is_alone: bool,
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
            here: None,
            context_menu: None,
            menu_buttons: BTreeMap::new(),
            menu_takes_keyboard: false,
            alt_is_alone: false,
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
    pub(crate) const ROBOT: &str = "robot";
    pub(crate) const REVIEW: &str = "review";
    pub(crate) const LIVE: &str = "live";
    pub(crate) const WHAT_IF: &str = "what-if";
}
