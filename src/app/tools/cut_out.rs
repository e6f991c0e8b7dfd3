//! Cuts a courtyard or a shaft out of a room.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::Path;
use super::tool::{GRID, Group, RIGHT_ANGLES, SNAPPING, THICKNESS_WITH_ROOMS, WITH_WALLS};
use super::typing::LEAST_SIDE_M;
use super::{Anchor, Call, Entry, Input, Scope, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Loop;
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, polygon};

pub(super) const ENTRY: Entry = Entry {
    id: "tool-cut-out",
    title: "Courtyard",
    help: "Cut a courtyard or a shaft out of a room",
    keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::X)],
    strip: Some((
        Icon::Drawn(&[
            Loop(&[(2.5, 2.5), (13.5, 2.5), (13.5, 13.5), (2.5, 13.5)]),
            Loop(&[(5.8, 5.8), (10.2, 5.8), (10.2, 10.2), (5.8, 10.2)]),
        ]),
        Group::Divide,
    )),
    options: &[THICKNESS_WITH_ROOMS, WITH_WALLS, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(CutOut::default()),
};

/// No corners yet, or some.
#[derive(Default)]
struct CutOut {
    path: Path,
    /// Whether the button is down since the first corner.
    is_dragging: bool,
}

impl CutOut {
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        if self.path.closes(point) || self.path.is_last(point) {
            return self.close(scope);
        }
        // Ready -> Drawing, Drawing -> Drawing
        let rectangle = self.rectangle(point, scope);
        self.path.go_to(point, scope);
        match rectangle {
            Some(corners) => {
                self.path.points = corners.to_vec();
                self.close(scope)
            }
            None => Vec::new(),
        }
    }

    /// The rectangle from the first corner to a point, where that is what a click makes: the two lie neither level
    /// nor upright, and no line was wanted.
    fn rectangle(&self, to: Point, scope: &Scope<'_>) -> Option<[Point; 4]> {
        let &[from] = self.path.points.as_slice() else { return None };
        let is_oblique = (to.x - from.x).abs() >= LEAST_SIDE_M && (to.y - from.y).abs() >= LEAST_SIDE_M;
        let is_wanted = self.is_dragging || (scope.options.right_angles && !scope.modifiers.shift);
        (is_oblique && is_wanted).then(|| [from, Point::new(to.x, from.y), to, Point::new(from.x, to.y)])
    }

    /// Drawing -> Ready
    fn close(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        self.is_dragging = false;
        let points = std::mem::take(&mut self.path).points;
        if points.len() < 3 {
            return Vec::new();
        }
        vec![Call::new("cut-out", [Value::points(&points), scope.options.new_walls()])]
    }
}

impl Tool for CutOut {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => self.to(scope.at(), scope),
            Input::DragStart { at, .. } if self.path.is_empty() => {
                *self = Self { path: Path::from(at), is_dragging: true };
                Vec::new()
            }
            Input::Drop if self.is_dragging => {
                let calls = self.to(scope.at(), scope);
                // What is not a rectangle goes on as an outline.
                self.is_dragging = false;
                calls
            }
            Input::Drop => self.to(scope.at(), scope),
            Input::Typed(typed) => match self.path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.close(scope),
            Input::Escape => {
                *self = Self::default();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        match self.path.points.len() {
            0 => "Courtyard: drag a rectangle inside a room, or click its corners".to_owned(),
            1 if self.rectangle(scope.at(), scope).is_some() => {
                "Click the opposite corner of the rectangle · Shift: a line instead · Esc cancels".to_owned()
            }
            1 => "Click the next corner of the outline, or the opposite corner of a rectangle · Esc cancels".to_owned(),
            _ => "Click the next corner · click the first again or press Enter to close · Esc cancels".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.path.is_empty() {
            return;
        }
        let rectangle = self.rectangle(scope.at(), scope);
        let outline = rectangle.map_or_else(
            || self.path.points.iter().copied().chain([scope.at()]).collect::<Vec<_>>(),
            |corners| corners.to_vec(),
        );
        let is_closed = outline.len() >= 3;
        if is_closed {
            preview.label(scope.at(), scope.units.area(polygon::signed_area(&outline).abs()), Look::Danger);
            preview.fill(outline.clone(), Vec::new(), Look::Danger);
        }
        preview.dashed(outline, is_closed, Look::Danger);
        self.path.preview_corners(preview);
        if rectangle.is_none() {
            self.path.preview_next(scope, preview);
        }
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        Some(&mut self.path)
    }

    fn anchor(&self) -> Option<Anchor> {
        // The second corner may be a rectangle's: any direction.
        self.path.anchor().filter(|_| self.path.points.len() > 1)
    }

    fn points(&self) -> Vec<Point> {
        self.path.points.clone()
    }
}
