//! Selects, moves, drags corners, slides openings.

use std::collections::{BTreeMap, BTreeSet};

use egui::{CursorIcon, Key, KeyboardShortcut, Modifiers};

use super::moving::{Moving, preview_moved};
use super::opening_grips::{self, Grip};
use super::tool::Group;
use super::{Anchor, Call, Entry, Input, NUDGES_MORE, Scope, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Loop;
use crate::app::look::theme::PLAN_TEXT;
use crate::app::paint::preview::{Look, Preview};
use crate::app::session::document::Derived;
use crate::app::session::layers::LayerSettings;
use crate::app::session::selection::{SelectMode, Selection};
use crate::app::value::Boxed;
use crate::draw::{Style, dimensions};
use crate::edit::{self, Reach};
use crate::geometry::{Bounds, Point, Vector};
use crate::plan::{CornerId, DimensionLine, ElementId, Place, Plan, RoomId};

pub(super) const ENTRY: Entry = Entry {
    id: "tool-select",
    title: "Select",
    help: "Select and move things, drag corners; drag across free space to select with a box",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::V)],
    strip: Some((
        Icon::Drawn(&[Loop(&[
            (4.0, 2.0),
            (4.0, 12.6),
            (6.7, 10.1),
            (8.5, 14.0),
            (10.4, 13.1),
            (8.6, 9.4),
            (12.2, 9.2),
        ])]),
        Group::Select,
    )),
    options: &[],
    make: || Box::new(Select::default()),
};

#[derive(Default)]
struct Select {
    state: State,
    cycle: Option<Cycle>,
}

#[derive(Default)]
enum State {
    #[default]
    Ready,
    /// Dragging a selection box from here.
    Boxing { from: Point },
    /// Dragging a corner.
    MovingCorner { corner: CornerId, from: Point },
    /// Dragging the selection; `from` is the point that snaps.
    Moving { from: Point, what: Moving },
    /// Dragging a grip of an opening.
    Gripping(Grip),
    /// Dragging the name and area of a room: where they are, and where they were grabbed.
    MovingText { room: RoomId, at: Point, from: Point },
}

/// Repeated clicks at one position cycle through all elements there.
struct Cycle {
    at: Point,
    candidates: Vec<ElementId>,
    index: usize,
}

/// How close a click must be to hit something, in points.
pub(crate) const REACH_PX: f64 = 7.0;

/// Clicks closer than this are at the same position, in points.
const SAME_PLACE_PX: f64 = 4.0;

/// The most corners shown with handles: more would hide the plan.
const MOST_HANDLES: usize = 400;

/// The elements at a position, likeliest first: dimensions, openings, walls, rooms from the smallest. Locked ones are
/// skipped.
pub(crate) fn hit(
    derived: &Derived,
    plan: &Plan,
    layers: &LayerSettings,
    point: Point,
    px_per_m: f64,
) -> Vec<ElementId> {
    let mut found = dimensions_at(plan, layers, point, px_per_m);
    found.extend(derived.at(point, REACH_PX / px_per_m));
    found.retain(|&element| plan.has(element) && !layers.is_locked(element));
    found
}

/// The dimension chains whose line or figures are at a position, where they are shown.
fn dimensions_at(plan: &Plan, layers: &LayerSettings, point: Point, px_per_m: f64) -> Vec<ElementId> {
    let style = Style { text_px: PLAN_TEXT, ..Style::default() };
    let lines = dimensions::lines(plan).into_iter().filter(|_| layers.dimensions);
    let is_near = |line: &DimensionLine| {
        let is_on_line = dimensions::segment(line).is_some_and(|line| line.distance(point) <= REACH_PX / px_per_m);
        is_on_line || dimensions::figure_at(line, point, &style, px_per_m).is_some()
    };
    lines.filter(|(_, line)| is_near(line)).map(|(id, _)| ElementId::Dimension(id)).collect()
}

impl Select {
    fn clicked(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        let same_place_m = scope.metres(SAME_PLACE_PX);
        match &mut self.cycle {
            Some(cycle) if cycle.at.distance(scope.pointer) <= same_place_m && !cycle.candidates.is_empty() => {
                cycle.index = (cycle.index + 1) % cycle.candidates.len();
            }
            _ => {
                let candidates = scope
                    .derived
                    .map(|derived| hit(derived, scope.plan, scope.layers, scope.pointer, scope.px_per_m))
                    .unwrap_or_default();
                self.cycle = Some(Cycle { at: scope.pointer, candidates, index: 0 });
            }
        }
        let found = self.cycle.as_ref().and_then(|cycle| cycle.candidates.get(cycle.index)).copied();
        let mode = mode(scope);
        match (found, mode) {
            (None, SelectMode::Replace) if scope.selection.is_empty() => Vec::new(),
            (None, SelectMode::Replace) => vec![Call::new("clear-selection", [])],
            (None, _) => Vec::new(),
            (Some(ElementId::Room(id)), SelectMode::Replace) => vec![Call::new("pick", [Value::Room(id)])],
            (Some(ElementId::Opening(id)), SelectMode::Replace) => {
                vec![Call::new("pick-opening", [Value::Opening(id)])]
            }
            (Some(element), mode) => {
                vec![Call::new("select", [Value::Elements(vec![element]), Value::word(mode)])]
            }
        }
    }

    /// What was clicked first is meant, and changed where it is.
    fn double_clicked(&mut self) -> Vec<Call> {
        let Some(cycle) = &mut self.cycle else { return Vec::new() };
        let number = cycle.candidates.len();
        if number == 0 {
            return Vec::new();
        }
        cycle.index = (cycle.index + number - 1) % number;
        let Some(&element) = cycle.candidates.get(cycle.index) else { return Vec::new() };
        let one = || Value::Elements(vec![element]);
        vec![Call::new("select", [one()]), Call::new("change-here", [one()])]
    }

    /// Ready -> whatever is dragged
    fn drag_start(&mut self, at: Point, pointer: Point, scope: &Scope<'_>) {
        self.cycle = None;
        self.state = match self.grabbed(pointer, scope) {
            Some(Grabbed::Corner(corner, from)) => State::MovingCorner { corner, from },
            Some(Grabbed::Opening(grip)) => State::Gripping(grip),
            Some(Grabbed::Text(room, at)) => State::MovingText { room, at, from: pointer },
            Some(Grabbed::Selection) => State::Moving { from: at, what: Moving::of(scope) },
            None => State::Boxing { from: pointer },
        };
    }

    /// What a press here grabs: only something selected, so that nothing moves by accident.
    fn grabbed(&self, pointer: Point, scope: &Scope<'_>) -> Option<Grabbed> {
        if scope.modifiers.shift || scope.modifiers.command {
            return None;
        }
        let reach_m = scope.metres(REACH_PX);
        if let Some(grip) = opening_grips::grip_at(scope, pointer, reach_m) {
            return Some(Grabbed::Opening(grip));
        }
        if let Some((room, at, grip)) = text_grip(scope)
            && grip.distance(pointer) <= reach_m
        {
            return Some(Grabbed::Text(room, at));
        }
        if let Some((corner, place)) = handle_at(scope.plan, scope.selection, pointer, reach_m) {
            return Some(Grabbed::Corner(corner, place));
        }
        let found = hit(scope.derived?, scope.plan, scope.layers, pointer, scope.px_per_m);
        let held = found.into_iter().find(|&element| scope.selection.contains(element))?;
        match (held, scope.selection.one()) {
            (ElementId::Opening(id), Some(_))
                if scope.plan.opening(id).is_some_and(|opening| matches!(opening.place, Place::Hosted { .. })) =>
            {
                Some(Grabbed::Opening(opening_grips::held(scope.plan, id, pointer)))
            }
            _ => Some(Grabbed::Selection),
        }
    }

    /// Whatever is dragged -> Ready
    fn drop(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        match std::mem::take(&mut self.state) {
            State::Ready => Vec::new(),
            State::Boxing { from } => {
                let how = if is_inside(from, scope.pointer) { Boxed::Inside } else { Boxed::Touching };
                let corners = Value::points(&[from, scope.pointer]);
                vec![Call::new("select-box", [corners, Value::word(how), Value::word(mode(scope))])]
            }
            State::MovingCorner { corner, from } if from.distance(scope.at()) > 0.0 => {
                let moved = Value::Elements(vec![ElementId::Corner(corner)]);
                vec![Call::new("move-corner", [moved, Value::point(scope.at())])]
            }
            State::Moving { from, what } => {
                let by = what.moved_by(from, scope);
                if by.length() <= 0.0 {
                    return Vec::new();
                }
                let mut call = Call::new("move-selection", [Value::point(Point::default() + by)]);
                if what.piece(scope).is_some() {
                    call.values.push(Value::word(Reach::Piece));
                }
                vec![call]
            }
            State::Gripping(grip) => vec![grip.drop(scope)],
            State::MovingText { room, at, from } => {
                vec![Call::new("move-name", [Value::Room(room), Value::point(at + (scope.pointer - from))])]
            }
            State::MovingCorner { .. } => Vec::new(),
        }
    }
}

enum Grabbed {
    Corner(CornerId, Point),
    Opening(Grip),
    /// The name and area of a room, by their grip; and where they are.
    Text(RoomId, Point),
    /// Whatever is selected.
    Selection,
}

/// How far above the name of a room its grip is, in points.
const TEXT_GRIP_PX: f64 = 9.0;

/// The selected room whose name or area is written in it, where these are, and the grip that moves them.
fn text_grip(scope: &Scope<'_>) -> Option<(RoomId, Point, Point)> {
    let ElementId::Room(room) = scope.selection.one()? else { return None };
    let (at, bounds) = scope.text?;
    Some((room, at, Point::new(bounds.center().x, bounds.max.y + scope.metres(TEXT_GRIP_PX))))
}

/// How a click or a box changes the selection.
fn mode(scope: &Scope<'_>) -> SelectMode {
    if scope.modifiers.command {
        SelectMode::Toggle
    } else if scope.modifiers.shift {
        SelectMode::Add
    } else {
        SelectMode::Replace
    }
}

/// A box dragged to the right takes what is inside; to the left also what it touches, as in CAD programs.
fn is_inside(from: Point, to: Point) -> bool {
    to.x >= from.x
}

/// The corner of what is selected whose handle is at a point, and its place.
pub(crate) fn handle_at(plan: &Plan, selection: &Selection, point: Point, reach_m: f64) -> Option<(CornerId, Point)> {
    handles_of(plan, selection)
        .into_iter()
        .filter_map(|corner| Some((corner, plan.position(corner)?)))
        .filter(|(_, place)| place.distance(point) <= reach_m)
        .min_by(|p, q| p.1.distance(point).total_cmp(&q.1.distance(point)))
}

/// The corners of the selected elements, if few enough to be shown and grabbed.
fn handles_of(plan: &Plan, selection: &Selection) -> BTreeSet<CornerId> {
    // Each element has corners of its own or shares them: that many elements have too many.
    if selection.len() > MOST_HANDLES {
        return BTreeSet::new();
    }
    let handles = corners_of(plan, selection);
    if handles.len() > MOST_HANDLES { BTreeSet::new() } else { handles }
}

/// The corners of the selected elements.
fn corners_of(plan: &Plan, selection: &Selection) -> BTreeSet<CornerId> {
    let mut corners: BTreeSet<CornerId> = selection.corners().collect();
    for wall in selection.walls().filter_map(|id| plan.wall(id)) {
        corners.extend([wall.from, wall.to]);
    }
    for room in selection.rooms().filter_map(|id| plan.room(id)) {
        corners.extend(room.rings().flat_map(|ring| ring.iter().copied()));
    }
    corners
}

impl Tool for Select {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => return self.clicked(scope),
            // It follows a click, the second at the place, which has gone on to what lies below.
            Input::DoubleClick => return self.double_clicked(),
            Input::DragStart { at, pointer } => self.drag_start(at, pointer, scope),
            Input::Drop => return self.drop(scope),
            // Whatever is dragged -> Ready
            Input::Escape => self.state = State::Ready,
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        match &self.state {
            State::Ready if scope.selection.is_empty() => String::new(),
            State::Ready if matches!(self.grabbed(scope.pointer, scope), Some(Grabbed::Text(..))) => {
                "Drag to move the room's name and area".to_owned()
            }
            State::Ready => {
                let [step, more, less] =
                    [1.0, NUDGES_MORE, 1.0 / NUDGES_MORE].map(|times| scope.units.length(scope.nudge_m * times));
                format!(
                    "Arrow keys move it by {step}, with Shift by {more}, with Alt by {less} · double-click to change it"
                )
            }
            State::Boxing { from } if is_inside(*from, scope.pointer) => {
                "Selects what lies inside · drag to the left for what is touched · Shift adds".to_owned()
            }
            State::Boxing { .. } => "Selects what is inside or touched · Shift adds".to_owned(),
            State::MovingCorner { .. } => {
                "Everything that shares the corner follows · Alt: no snapping · Esc cancels".to_owned()
            }
            State::Moving { what, .. } => what.hint(scope),
            State::Gripping(grip) => grip.hint(scope),
            State::MovingText { .. } => "The name and area stay there while the plan changes · Esc cancels".to_owned(),
        }
    }

    fn would_be(&self, scope: &Scope<'_>) -> Option<Plan> {
        match &self.state {
            State::Gripping(grip) => grip.would_be(scope),
            &State::MovingCorner { corner, .. } => edit::move_corners(scope.plan, &[(corner, scope.at())]).ok(),
            State::Moving { from, what } => what.would_be(what.moved_by(*from, scope), scope),
            State::Ready | State::Boxing { .. } | State::MovingText { .. } => None,
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        match &self.state {
            State::Ready => {
                for corner in handles_of(scope.plan, scope.selection) {
                    if let Some(place) = scope.plan.position(corner) {
                        preview.handle(place, Look::New);
                    }
                }
                opening_grips::show(scope, preview);
                if let Some((.., grip)) = text_grip(scope) {
                    preview.handle(grip, Look::New);
                }
            }
            &State::Boxing { from } => {
                let to = scope.pointer;
                let corners = vec![from, Point::new(to.x, from.y), to, Point::new(from.x, to.y)];
                preview.fill(corners.clone(), Vec::new(), Look::New);
                if is_inside(from, to) {
                    preview.line(corners, true, Look::New);
                } else {
                    preview.dashed(corners, true, Look::New);
                }
            }
            &State::MovingCorner { corner, from } => {
                preview_moved(scope, &BTreeMap::from([(corner, scope.at())]), preview);
                preview.handle(scope.at(), Look::New);
                preview.label(
                    scope.at(),
                    format!("moved {}", scope.units.length(from.distance(scope.at()))),
                    Look::New,
                );
            }
            State::Moving { from, what } => {
                let (from, by) = (*from, what.moved_by(*from, scope));
                what.preview(by, scope, preview);
                preview_dimensions(scope, by, preview);
                preview.dashed(vec![from, from + by], false, Look::Guide);
                preview.label(scope.at(), format!("moved {}", scope.units.length(by.length())), Look::New);
            }
            State::Gripping(grip) => grip.preview(scope, preview),
            State::MovingText { at, from, .. } => {
                let by = scope.pointer - *from;
                if let Some((_, bounds)) = scope.text {
                    let Bounds { min, max } = bounds;
                    let corners = [min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)].map(|it| it + by);
                    preview.fill(corners.to_vec(), Vec::new(), Look::New);
                    preview.line(corners.to_vec(), true, Look::New);
                }
                preview.dashed(vec![*at, *at + by], false, Look::Guide);
            }
        }
    }

    fn cursor(&self, scope: &Scope<'_>) -> CursorIcon {
        match self.state {
            State::Moving { .. } | State::MovingCorner { .. } | State::Gripping(_) | State::MovingText { .. } => {
                CursorIcon::Grabbing
            }
            State::Boxing { .. } => CursorIcon::Crosshair,
            State::Ready => match self.grabbed(scope.pointer, scope) {
                Some(Grabbed::Corner(..) | Grabbed::Opening(Grip::End(..))) => CursorIcon::Grab,
                Some(_) => CursorIcon::Move,
                None => CursorIcon::Default,
            },
        }
    }

    fn is_busy(&self) -> bool {
        !matches!(self.state, State::Ready)
    }

    fn snaps(&self) -> bool {
        matches!(self.state, State::MovingCorner { .. } | State::Moving { .. })
    }

    fn anchor(&self) -> Option<Anchor> {
        match self.state {
            State::MovingCorner { from, .. } | State::Moving { from, .. } => {
                Some(Anchor { from, along: None, right_angles: false })
            }
            _ => None,
        }
    }
}

/// The lines of the selected dimension chains, at their new places.
fn preview_dimensions(scope: &Scope<'_>, by: Vector, preview: &mut Preview) {
    for line in scope.selection.dimensions().filter_map(|id| scope.plan.dimension_line(scope.plan.dimension(id)?)) {
        if let Some(segment) = dimensions::segment(&line) {
            let by = line.along.left() * by.dot(line.along.left());
            preview.line(vec![segment.a + by, segment.b + by], false, Look::New);
        }
    }
}
