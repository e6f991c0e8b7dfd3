//! Puts doors, passages and windows into walls, and closes gaps between walls with them.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::tool::{Group, WIDTH};
use super::{Call, Entry, Input, Scope, Tool, Typed, Typing, Value};
use crate::app::look::icons::Icon;
use crate::app::paint::preview::{Look, Preview};
use crate::edit::opening_on;
use crate::geometry::{Point, Segment, trim_m};
use crate::plan::titles::room_title;
use crate::plan::{Joint, LeafSide, Opening as PlanOpening, OpeningKind, Swing};
use crate::snapping::IndexedEdge;
use crate::topology::{Gap, sides_by_geometry};

pub(super) const DOOR: Entry = Entry {
    id: "tool-door",
    title: "Door",
    help: "Place a door in a wall",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::D)],
    strip: Some((Icon::Door, Group::Openings)),
    options: &[WIDTH],
    make: || Box::new(Opening::new(OpeningKind::Door)),
};
pub(super) const DOUBLE_DOOR: Entry = Entry {
    id: "tool-double-door",
    title: "Double door",
    help: "Place a door with two leaves in a wall",
    keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::D)],
    strip: Some((Icon::DoubleDoor, Group::Openings)),
    options: &[WIDTH],
    make: || Box::new(Opening::new(OpeningKind::DoubleDoor)),
};
pub(super) const PASSAGE: Entry = Entry {
    id: "tool-passage",
    title: "Passage",
    help: "Place an opening without a door in a wall or a room boundary",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::O)],
    strip: Some((Icon::Passage, Group::Openings)),
    options: &[WIDTH],
    make: || Box::new(Opening::new(OpeningKind::Passage)),
};
pub(super) const WINDOW: Entry = Entry {
    id: "tool-window",
    title: "Window",
    help: "Place a window in a wall",
    keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::O)],
    strip: Some((Icon::Window, Group::Openings)),
    options: &[WIDTH],
    make: || Box::new(Opening::new(OpeningKind::Window)),
};

struct Opening {
    kind: OpeningKind,
    /// Where a drag along the wall started: its length is the opening's width.
    from: Option<Point>,
}

/// How close to the pointer a wall must be to get an opening, in points: closer than the next wall of a
/// narrow corridor at a usual zoom.
const REACH_PX: f64 = 18.0;

/// A shorter drag is a click with a trembling hand, in metres.
const LEAST_WIDTH_M: f64 = 0.3;

impl Opening {
    fn new(kind: OpeningKind) -> Self {
        Self { kind, from: None }
    }

    /// Where the middle of an opening is meant to be, and how wide it is meant to be.
    fn wanted(&self, scope: &Scope<'_>) -> (Point, f64) {
        let dragged = self.from.map(|from| Segment::new(from, scope.pointer));
        let dragged = dragged.filter(|way| way.length() >= LEAST_WIDTH_M);
        (dragged.map_or(scope.pointer, Segment::midpoint), dragged.map_or(self.width_m(scope), Segment::length))
    }

    /// The opening that a click would make.
    fn planned(&self, scope: &Scope<'_>) -> Option<PlanOpening> {
        let (at, width_m) = self.wanted(scope);
        // A wall before a boundary, the nearer first.
        let near = scope.derived?.index.edges_near(at, scope.metres(REACH_PX));
        let is_there = |edge: &&IndexedEdge| edge.corners.iter().all(|&id| scope.plan.corner(id).is_some());
        let walls = near.iter().filter(|edge| edge.wall.is_some_and(|id| scope.plan.wall(id).is_some()));
        let host = walls.chain(&near).find(is_there)?.corners;
        opening_on(scope.plan, self.kind, host.into(), at, width_m, Some(scope.pointer)).ok()
    }

    /// The gap between two collinear walls under the pointer.
    fn gap(scope: &Scope<'_>) -> Option<Gap> {
        let reach_m = scope.metres(REACH_PX);
        let distance = |gap: &Gap| gap.segment.distance(scope.pointer);
        let nearest = scope.gaps.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)))?;
        // Beside the gap, the walls are meant.
        let fraction = nearest.segment.nearest_fraction(scope.pointer);
        (distance(nearest) <= reach_m && (0.02..=0.98).contains(&fraction)).then(|| nearest.clone())
    }

    /// A double door is twice as wide.
    fn width_m(&self, scope: &Scope<'_>) -> f64 {
        let factor = if self.kind == OpeningKind::DoubleDoor { 2.0 } else { 1.0 };
        scope.options.opening_width_m * factor
    }

    /// Ready -> Ready
    fn place(&self, scope: &Scope<'_>) -> Vec<Call> {
        if let Some(gap) = Self::gap(scope) {
            let values = [Value::point(gap.segment.midpoint()), Value::word(self.kind)];
            return vec![Call::new("bridge-gap", values)];
        }
        let planned = self.planned(scope);
        let Some(segment) = planned.and_then(|opening| scope.plan.opening_segment(&opening)) else { return Vec::new() };
        // As it was meant, not as the wall lets it: what differs is said.
        let width_m = trim_m(segment.length().max(self.wanted(scope).1));
        let values = [
            Value::word(self.kind),
            Value::point(segment.midpoint()),
            Value::Number(width_m),
            Value::point(scope.pointer),
        ];
        vec![Call::new("add-opening", values)]
    }
}

impl Tool for Opening {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => self.place(scope),
            // Ready -> Widening
            Input::DragStart { pointer, .. } => {
                self.from = Some(pointer);
                Vec::new()
            }
            // Widening -> Ready
            Input::Drop => {
                let calls = self.place(scope);
                self.from = None;
                calls
            }
            Input::Escape => {
                self.from = None;
                Vec::new()
            }
            Input::Typed(Typed::Length { length_m, .. }) => vec![Call::new("opening-width", [Value::Number(length_m)])],
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        let name = crate::base::wording::sentence(self.kind.name());
        if let Some(gap) = Self::gap(scope) {
            let width = scope.units.length(gap.width_m);
            return format!("{name}: click to close this gap of {width}");
        }
        match self.planned(scope) {
            Some(_) => format!("{name}: click to place it, drag along the wall to set the width, or type a width"),
            None => format!("{name}: point at a wall or a room boundary"),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if let Some(gap) = Self::gap(scope) {
            let thickness_m = gap.walls.iter().filter_map(|&id| scope.plan.wall(id)).map(|wall| wall.thickness_m);
            preview.wall(gap.segment, thickness_m.fold(scope.metres(4.0), f64::max), Look::New);
            preview.label(scope.pointer, format!("gap of {}", scope.units.length(gap.width_m)), Look::New);
            return;
        }
        let Some(opening) = self.planned(scope) else { return };
        let Some(segment) = scope.plan.opening_segment(&opening) else { return };
        preview.wall(segment, scope.metres(8.0), Look::New);
        for [hinge, shut, tip] in leaves(segment, self.kind, opening.swing) {
            preview.line(vec![hinge, tip], false, Look::New);
            preview.arc(hinge, shut, tip, Look::New);
        }
        let mut said = scope.units.length(segment.length());
        if self.kind.is_passable()
            && let Some(derived) = scope.derived
        {
            let name = |joint: Joint| match joint {
                Joint::Outside => "outside".to_owned(),
                Joint::Room(id) => scope.plan.room(id).map(room_title).unwrap_or_default(),
            };
            let [left, right] = sides_by_geometry(scope.plan, &derived.analysis.shapes, &opening).map(name);
            said = format!("{said}  {left} – {right}");
        }
        preview.label(scope.pointer, said, Look::New);
    }

    fn is_busy(&self) -> bool {
        self.from.is_some()
    }

    fn snaps(&self) -> bool {
        false
    }

    fn typing(&self) -> Option<Typing> {
        Some(Typing::Width)
    }
}

/// The hinge, the closed and the open end of each leaf.
pub(super) fn leaves(segment: Segment, kind: OpeningKind, swing: Option<Swing>) -> Vec<[Point; 3]> {
    let Some(swing) = swing else { return Vec::new() };
    let to_side = segment.vector().left() * if swing.side == LeafSide::Left { 1.0 } else { -1.0 };
    let leaf = |hinge: Point, shut: Point, share: f64| [hinge, shut, hinge + to_side * share];
    match (kind, swing.hinge_at_start) {
        (OpeningKind::DoubleDoor, _) => {
            let middle = segment.midpoint();
            vec![leaf(segment.a, middle, 0.5), leaf(segment.b, middle, 0.5)]
        }
        (_, true) => vec![leaf(segment.a, segment.b, 1.0)],
        (_, false) => vec![leaf(segment.b, segment.a, 1.0)],
    }
}
