//! The interface of a tool: a state machine, and its entry in the list of tools.

use egui::{CursorIcon, Key, KeyboardShortcut};

use super::Call;
use super::input::{Anchor, DrawOptions, Input, Scope};
use super::path::Path;
use super::typing::Typing;
use crate::app::look::icons::Icon;
use crate::app::paint::preview::Preview;
use crate::geometry::Point;
use crate::plan::Plan;
use crate::snapping::Faces;

/// A tool, and all that the window shows of it: its command, its place in the strip, its options.
pub(crate) struct Entry {
    /// The id of the command that activates it.
    pub id: &'static str,
    /// Its title in menus.
    pub title: &'static str,
    /// A sentence for tooltips and the manual.
    pub help: &'static str,
    /// The default shortcuts of its command.
    pub keys: &'static [KeyboardShortcut],
    /// Its icon, and its group in the strip and in the menu; `None` for a tool placed in another menu.
    pub strip: Option<(Icon, Group)>,
    /// Its options, in the order of the bar.
    pub options: &'static [ToolOption],
    pub make: fn() -> Box<dyn Tool>,
}

/// The groups of the strip, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Group {
    Select,
    Draw,
    Divide,
    Openings,
    Measure,
}

/// An option of a tool, set by a command.
pub(crate) enum ToolOption {
    /// On or off.
    Switch {
        /// The command's id.
        command: &'static str,
        /// Its name in the bar.
        name: &'static str,
    },
    /// One of several, which its command goes through.
    Choice {
        command: &'static str,
        name: &'static str,
        /// The word of what is chosen.
        now: fn(&DrawOptions) -> &'static str,
    },
    /// A length in metres.
    Length {
        command: &'static str,
        name: &'static str,
        least_m: f64,
        most_m: f64,
        now_m: fn(&DrawOptions) -> f64,
        /// Whether it currently applies.
        is_shown: fn(&DrawOptions) -> bool,
    },
}

pub(super) const SNAPPING: ToolOption = ToolOption::Switch { command: "snapping", name: "Snap" };
pub(super) const GRID: ToolOption = ToolOption::Switch { command: "snap-to-grid", name: "Grid" };
pub(super) const RIGHT_ANGLES: ToolOption = ToolOption::Switch { command: "right-angles", name: "Right angles" };
pub(super) const WITH_WALLS: ToolOption = ToolOption::Switch { command: "walls-with-rooms", name: "With walls" };
pub(super) const CLEAR_SIZES: ToolOption = ToolOption::Switch { command: "clear-sizes", name: "Clear sizes" };
pub(super) const ROOMS_FROM_WALLS: ToolOption = ToolOption::Switch { command: "rooms-from-walls", name: "Rooms" };
pub(super) const COPIES: ToolOption = ToolOption::Switch { command: "transform-copies", name: "Copy" };
pub(super) const OVER_ROOMS: ToolOption = ToolOption::Switch { command: "over-rooms", name: "Over rooms" };

/// On which side of the line walls stand.
pub(super) const WALL_SIDE: ToolOption =
    ToolOption::Choice { command: "wall-side", name: "Side", now: |options| options.lies.name() };

/// The thickness of walls.
pub(super) const THICKNESS: ToolOption = thickness(|_| true);

/// The thickness of walls along new boundaries, if they are put there.
pub(super) const THICKNESS_WITH_ROOMS: ToolOption = thickness(|options| options.walls_with_rooms);

const fn thickness(is_shown: fn(&DrawOptions) -> bool) -> ToolOption {
    ToolOption::Length {
        command: "wall-thickness",
        name: "Thickness",
        least_m: 0.0,
        most_m: 10.0,
        now_m: |options| options.thickness_m,
        is_shown,
    }
}

/// The width of openings.
pub(super) const WIDTH: ToolOption = ToolOption::Length {
    command: "opening-width",
    name: "Width",
    least_m: 0.1,
    most_m: 100.0,
    now_m: |options| options.opening_width_m,
    is_shown: |_| true,
};

/// What undo does to the active tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakenBack {
    /// Nothing: the plan's last step is undone.
    Nothing,
    /// Removes a corner that is not in the plan yet.
    Corner,
    /// Removes a corner that is: the plan's last step is undone as well.
    CornerAndStep,
}

/// A tool's state machine.
pub(crate) trait Tool {
    /// Handles a user action; returns the resulting commands.
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call>;

    /// What can be done now, for the status line.
    fn hint(&self, scope: &Scope<'_>) -> String;

    /// The plan if what is dragged were let go now; `None` where nothing is dragged that changes rooms or openings.
    fn would_be(&self, _scope: &Scope<'_>) -> Option<Plan> {
        None
    }

    /// Shows the work in progress.
    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview);

    fn cursor(&self, _scope: &Scope<'_>) -> CursorIcon {
        CursorIcon::Crosshair
    }

    /// The path being drawn, if it draws one corner after the other: defaults below then follow from it.
    fn path(&self) -> Option<&Path> {
        None
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        None
    }

    /// Whether something has been started that Escape would cancel.
    fn is_busy(&self) -> bool {
        self.path().is_some_and(|path| !path.is_empty())
    }

    /// Whether that is being drawn, so that no letter may be a shortcut: another tool would drop it.
    fn is_drawing(&self) -> bool {
        self.is_busy()
    }

    /// Whether places snap.
    fn snaps(&self) -> bool {
        true
    }

    /// How it takes the faces of walls.
    fn faces(&self, _options: &DrawOptions) -> Faces {
        Faces::Off
    }

    fn anchor(&self) -> Option<Anchor> {
        self.path()?.anchor()
    }

    /// Points of the work in progress that can be snapped to like corners.
    fn points(&self) -> Vec<Point> {
        Vec::new()
    }

    /// The points of what is half drawn: they are kept as safe as the plan.
    fn draft(&self) -> Vec<Point> {
        self.path().map(|path| path.points.clone()).unwrap_or_default()
    }

    /// Goes on with points that were half drawn when the program ended.
    fn resume(&mut self, points: Vec<Point>) {
        if let Some(path) = self.path_mut() {
            *path = Path::through(points);
        }
    }

    /// What can be typed now.
    fn typing(&self) -> Option<Typing> {
        self.path().filter(|path| !path.is_empty()).map(|_| Typing::Length)
    }

    /// Letters that it takes while busy.
    fn keys(&self) -> &'static [Key] {
        &[]
    }

    /// The plan refused what it called for last.
    fn was_refused(&mut self) {}

    fn take_back(&mut self) -> TakenBack {
        let was_there = self.path_mut().is_some_and(|path| path.take_back().0);
        if was_there { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
