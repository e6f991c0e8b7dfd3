//! What tools are given: what a person does, where, and how things are drawn.

use std::sync::Arc;

use egui::{Key, Modifiers};

use super::{Call, Typed, Value};
use crate::app::session::{document::Derived, layers::LayerSettings, selection::Selection};
use crate::app::value::Space;
use crate::base::units::Units;
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, Plan};
use crate::snapping::{PlanIndex, Snap};
use crate::topology::Gap;

/// What is drawn next, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DrawOptions {
    /// Thickness of new walls in metres.
    pub thickness_m: f64,
    /// Whether walls are drawn along the boundaries of new rooms.
    pub walls_with_rooms: bool,
    /// Whether new rooms take what other rooms cover too.
    pub over_rooms: bool,
    /// Clear width of new openings in metres.
    pub opening_width_m: f64,
    /// Arcs are drawn as chords that stay this near to them, in metres.
    pub arc_tolerance_m: f64,
    /// Whether lines keep to right angles unless Shift is held.
    pub right_angles: bool,
    /// Whether corners, walls and alignments attract.
    pub snaps: bool,
    /// Whether the grid attracts.
    pub snaps_to_grid: bool,
}

/// 2 cm: about a pen's width on a 1:100 drawing.
const ARC_TOLERANCE_M: f64 = 0.02;

impl DrawOptions {
    /// The call that draws a room with these corners.
    pub(super) fn draw_room(&self, corners: &[Point]) -> Call {
        let thickness_m = if self.walls_with_rooms { self.thickness_m } else { 0.0 };
        // Along rooms that are there the boundary need not be drawn exactly: it may run through them.
        let space = if self.over_rooms { Space::Exact } else { Space::Free };
        Call::new("draw-room", [Value::points(corners), Value::word(space), Value::Number(thickness_m)])
    }
}

impl Default for DrawOptions {
    fn default() -> Self {
        Self {
            thickness_m: DEFAULT_WALL_THICKNESS_M,
            walls_with_rooms: true,
            over_rooms: false,
            opening_width_m: DEFAULT_DOOR_WIDTH_M,
            arc_tolerance_m: ARC_TOLERANCE_M,
            right_angles: true,
            snaps: true,
            snaps_to_grid: true,
        }
    }
}

/// What a tool sees.
pub(crate) struct Scope<'a> {
    pub plan: &'a Plan,
    /// What follows from the plan, or from an earlier one while that is worked out anew.
    pub derived: Option<&'a Arc<Derived>>,
    /// The doorways left open in the plan's walls; none while they are looked for anew.
    pub gaps: &'a [Gap],
    pub selection: &'a Selection,
    pub options: &'a DrawOptions,
    pub layers: &'a LayerSettings,
    /// What was copied.
    pub copied: Option<&'a Plan>,
    pub units: Units,
    /// Where the pointer is in the plan, in metres; the last place when it has left the canvas.
    pub pointer: Point,
    /// What it snaps to.
    pub snap: Snap,
    pub px_per_m: f64,
    pub modifiers: Modifiers,
}

impl Scope<'_> {
    /// The point that is meant.
    pub(crate) fn at(&self) -> Point {
        self.snap.point
    }

    /// A length on the screen, in metres of the plan.
    pub(crate) fn metres(&self, px: f64) -> f64 {
        px / self.px_per_m
    }
}

/// What a person does.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Input {
    /// The primary button was pressed and let go at one place.
    Click,
    /// It was pressed twice in quick succession; follows a click.
    DoubleClick,
    /// The secondary button was clicked.
    SecondaryClick,
    /// It was pressed here and the pointer has moved on: what it snapped to then, and the place itself.
    DragStart { at: Point, pointer: Point },
    /// The pointer moves while the button is down.
    Drag,
    /// The button was let go after a drag.
    Drop,
    /// Enter, with nothing typed.
    Enter,
    /// Enter or Tab behind something typed.
    Typed(Typed),
    /// A letter that the tool asks for.
    Key(Key),
    /// Escape.
    Escape,
}

/// Where lines are measured from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Anchor {
    pub from: Point,
    /// The direction of the line drawn before.
    pub along: Option<Vector>,
    /// Whether the line from here keeps to right angles.
    pub right_angles: bool,
}

/// What places can snap to.
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
    /// Spacing of the grid that is shown, in metres; `None` where it does not attract.
    pub grid_m: Option<f64>,
    /// Whether the pointer is on the canvas.
    pub is_seen: bool,
}
