//! The input of tools: the user's actions, their position, and drawing options.

use std::sync::Arc;

use egui::{Key, Modifiers};

use super::{Call, Typed, Value};
use crate::app::session::{document::Derived, layers::LayerSettings, selection::Selection};
use crate::app::value::Space;
use crate::base::units::Units;
use crate::edit::{Built, Lies, boundary_around};
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, Plan};
use crate::snapping::{Faces, PlanIndex, Snap};
use crate::topology::Gap;

/// The options for drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawOptions {
    /// Thickness of new walls in metres.
    pub thickness_m: f64,
    /// On which side of the line that is drawn new walls stand.
    pub lies: Lies,
    /// Whether walls are put along new boundaries.
    pub walls_with_rooms: bool,
    /// Whether the rooms that are drawn are the clear spaces between their walls.
    pub clear_sizes: bool,
    /// Whether mirroring, turning and scaling leave the original.
    pub copies: bool,
    /// Whether new rooms may cover existing ones.
    pub over_rooms: bool,
    /// Clear width of new openings in metres.
    pub opening_width_m: f64,
    /// The maximum distance of chords from arcs, in metres.
    pub arc_tolerance_m: f64,
    /// Whether lines are constrained to right angles unless Shift is held.
    pub right_angles: bool,
    /// Whether to snap to corners, walls and alignments.
    pub snaps: bool,
    /// Whether to snap to the grid.
    pub snaps_to_grid: bool,
}

/// 2 cm: about a pen's width on a 1:100 drawing.
const ARC_TOLERANCE_M: f64 = 0.02;

impl DrawOptions {
    /// Whether what is drawn of a room lies between the faces of its walls.
    pub(super) fn draws_clear(&self) -> bool {
        self.clear_sizes && self.walls_with_rooms
    }

    /// An area that is being drawn, and by what it is measured.
    pub(super) fn drawn_area(&self, area_m2: f64, units: Units) -> String {
        let by = match (self.walls_with_rooms && self.thickness_m > 0.0, self.clear_sizes) {
            (true, true) => " clear",
            (true, false) => " along axes",
            (false, _) => "",
        };
        format!("{}{by}", units.area(area_m2))
    }

    /// How the tools for rooms take the faces of walls.
    pub(super) fn faces_for_rooms(&self) -> Faces {
        if self.draws_clear() { Faces::LikeAxes } else { Faces::Off }
    }

    /// How new walls are built.
    pub(super) fn built(&self) -> Built {
        Built { thickness_m: self.thickness_m, lies: self.lies }
    }

    /// The thickness of walls along new boundaries, 0 for none: an argument of what makes them.
    pub(super) fn new_walls(&self) -> Value {
        Value::Number(if self.walls_with_rooms { self.thickness_m } else { 0.0 })
    }

    /// The call that draws a room with these corners.
    pub(super) fn draw_room(&self, corners: &[Point]) -> Call {
        let around = if self.draws_clear() { boundary_around(corners, self.thickness_m) } else { corners.to_vec() };
        // Along existing rooms the boundary need not be drawn exactly: it may run through them.
        let space = if self.over_rooms { Space::Exact } else { Space::Free };
        Call::new("draw-room", [Value::points(&around), Value::word(space), self.new_walls()])
    }
}

impl Default for DrawOptions {
    fn default() -> Self {
        Self {
            thickness_m: DEFAULT_WALL_THICKNESS_M,
            lies: Lies::Centre,
            walls_with_rooms: true,
            clear_sizes: false,
            copies: false,
            over_rooms: false,
            opening_width_m: DEFAULT_DOOR_WIDTH_M,
            arc_tolerance_m: ARC_TOLERANCE_M,
            right_angles: true,
            snaps: true,
            snaps_to_grid: true,
        }
    }
}

/// What a tool can see.
pub(crate) struct Scope<'a> {
    pub plan: &'a Plan,
    /// The plan's analysis, or that of an earlier plan until it is ready.
    pub derived: Option<&'a Arc<Derived>>,
    /// The doorways left open in the plan's walls; empty while they are being found again.
    pub gaps: &'a [Gap],
    pub selection: &'a Selection,
    pub options: &'a DrawOptions,
    pub layers: &'a LayerSettings,
    /// The copied part of a plan.
    pub copied: Option<&'a Plan>,
    /// The plan of the storey shown below.
    pub below: Option<&'a Plan>,
    pub units: Units,
    /// The pointer's position in the plan, in metres; the last one if it has left the canvas.
    pub pointer: Point,
    /// The snapped position.
    pub snap: Snap,
    pub px_per_m: f64,
    /// How far an arrow key moves what is selected, in metres.
    pub nudge_m: f64,
    /// Whether an arrow key was the last thing that moved what is selected.
    pub is_nudging: bool,
    /// Where the name and area of the one selected room are written, and the box around them.
    pub text: Option<(Point, Bounds)>,
    pub modifiers: Modifiers,
}

/// With Shift an arrow key goes so many times as far, with Alt that part of the way.
pub(crate) const NUDGES_MORE: f64 = 10.0;

impl Scope<'_> {
    /// The intended point.
    pub(crate) fn at(&self) -> Point {
        self.snap.point
    }

    /// A length on the screen, in metres of the plan.
    pub(crate) fn metres(&self, px: f64) -> f64 {
        px / self.px_per_m
    }
}

/// A user action.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Input {
    /// The primary button was clicked.
    Click,
    /// It was double-clicked; follows a click.
    DoubleClick,
    /// The secondary button was clicked.
    SecondaryClick,
    /// A drag started here: the position it snapped to then, and the exact one.
    DragStart { at: Point, pointer: Point },
    /// The pointer moves while the button is down.
    Drag,
    /// The button was let go after a drag.
    Drop,
    /// Enter, with no text typed.
    Enter,
    /// Enter or Tab after typed text.
    Typed(Typed),
    /// A letter requested by the tool.
    Key(Key),
    /// Escape.
    Escape,
}

/// The reference for new lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    pub from: Point,
    /// The direction of the previous line.
    pub along: Option<Vector>,
    /// Whether the line from here is constrained to right angles.
    pub right_angles: bool,
}

/// What positions can snap to.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub index: Option<&'a PlanIndex>,
    pub seen: Bounds,
    pub px_per_m: f64,
    pub modifiers: Modifiers,
    /// Guide lines, and lines of the storey below.
    pub lines: &'a [Segment],
    /// Corners of the storey below.
    pub points: &'a [Point],
    pub options: &'a DrawOptions,
    /// Spacing of the visible grid in metres; `None` if it is not snapped to.
    pub grid_m: Option<f64>,
    /// Whether the pointer is on the canvas.
    pub is_seen: bool,
    /// Whether a picture lies under the plan.
    pub is_over_picture: bool,
    /// Whether a button goes down or up in this frame.
    pub is_pressing: bool,
}
