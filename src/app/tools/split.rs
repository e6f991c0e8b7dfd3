//! Splits rooms, with walls or without: straight across by one click, or along a line.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::Path;
use super::tool::{GRID, Group, RIGHT_ANGLES, SNAPPING, THICKNESS_WITH_ROOMS, WITH_WALLS};
use super::{Call, Entry, Input, Scope, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Line;
use crate::app::paint::preview::{Look, Preview};
use crate::edit::{Across, straight_across};
use crate::geometry::Point;

pub(super) const ENTRY: Entry = Entry {
    id: "tool-split",
    title: "Split",
    help: "Split a room along a line",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::X)],
    strip: Some((
        Icon::Drawn(&[
            Line(&[(6.6, 3.0), (2.5, 3.0), (2.5, 13.0), (6.6, 13.0)]),
            Line(&[(9.4, 3.0), (13.5, 3.0), (13.5, 13.0), (9.4, 13.0)]),
            Line(&[(8.0, 1.8), (8.0, 5.0)]),
            Line(&[(8.0, 6.6), (8.0, 9.4)]),
            Line(&[(8.0, 11.0), (8.0, 14.2)]),
        ]),
        Group::Divide,
    )),
    options: &[THICKNESS_WITH_ROOMS, WITH_WALLS, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Split::default()),
};

/// No points yet: a click splits straight across. Or some.
#[derive(Default)]
struct Split {
    path: Path,
}

/// How close to a boundary the pointer must be, in points: the same as the snapping radius.
const REACH_PX: f64 = 10.0;

impl Split {
    /// Where a click would split.
    fn across(&self, scope: &Scope<'_>) -> Option<Across> {
        if !self.path.is_empty() || scope.modifiers.shift {
            return None;
        }
        let shapes = &scope.derived?.analysis.shapes;
        straight_across(shapes, scope.pointer, scope.at(), scope.metres(REACH_PX))
    }

    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        if self.path.is_last(point) {
            return self.end(scope);
        }
        // Ready -> Cutting, Cutting -> Cutting
        let is_first = self.path.is_empty();
        self.path.go_to(point, scope);
        // At a boundary the line is complete.
        let index = scope.derived.map(|derived| &derived.index);
        let is_through = index.is_some_and(|index| !index.edges_near(point, SAME_PLACE_M).is_empty());
        if !is_first && is_through { self.end(scope) } else { Vec::new() }
    }

    /// Cutting -> Ready
    fn end(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        let points = std::mem::take(&mut self.path).points;
        if points.len() < 2 {
            return Vec::new();
        }
        vec![Call::new("split-rooms", [Value::points(&points), scope.options.new_walls()])]
    }
}

/// A point this close to a boundary is on it, in metres.
const SAME_PLACE_M: f64 = 1e-3;

impl Tool for Split {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            // Ready -> Ready
            Input::Click if self.path.is_empty() && !scope.modifiers.shift => match self.across(scope) {
                Some(Across { line, .. }) => {
                    vec![Call::new("split-rooms", [Value::points(&[line.a, line.b]), scope.options.new_walls()])]
                }
                None => Vec::new(),
            },
            Input::Click | Input::Drop => self.to(scope.at(), scope),
            // Ready -> Cutting
            Input::DragStart { at, .. } if self.path.is_empty() => self.to(at, scope),
            Input::Typed(typed) => match self.path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.end(scope),
            Input::Escape => {
                self.path = Path::default();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if self.path.is_empty() {
            match self.across(scope) {
                Some(_) => "Click to split straight across · drag, or Shift+click, for a line of your own".to_owned(),
                None if scope.modifiers.shift => "Click where the line starts, on a room boundary".to_owned(),
                None => "Split: point at a room boundary; a click splits the room straight across".to_owned(),
            }
        } else {
            "Click the boundary on the other side · points in between bend the line · Esc cancels".to_owned()
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.path.is_empty() {
            if let Some(Across { line, areas_m2, .. }) = self.across(scope) {
                preview.dashed(vec![line.a, line.b], false, Look::Danger);
                if let Some([left, right]) = areas_m2 {
                    // The smaller x first, as they are placed.
                    let is_upward = line.b.y > line.a.y;
                    let (first, second) = if is_upward { (left, right) } else { (right, left) };
                    preview.label(
                        scope.pointer,
                        format!("{} | {}", scope.units.area(first), scope.units.area(second)),
                        Look::New,
                    );
                }
            }
            return;
        }
        let mut points = self.path.points.clone();
        points.push(scope.at());
        preview.dashed(points, false, Look::Danger);
        self.path.preview_corners(preview);
        self.path.preview_next(scope, preview);
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        Some(&mut self.path)
    }
}
