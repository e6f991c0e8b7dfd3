//! Cuts a courtyard or a shaft out of a room.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::Path;
use super::tool::{GRID, Group, RIGHT_ANGLES, SNAPPING};
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
    options: &[RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(CutOut::default()),
};

/// No corners yet, or some.
#[derive(Default)]
struct CutOut {
    path: Path,
}

impl CutOut {
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        if self.path.closes(point) || self.path.is_last(point) {
            return self.close();
        }
        // Ready -> Drawing, Drawing -> Drawing
        self.path.go_to(point, scope);
        Vec::new()
    }

    /// Drawing -> Ready
    fn close(&mut self) -> Vec<Call> {
        let points = rectangle_of_two(std::mem::take(&mut self.path).points);
        if points.len() < 3 { Vec::new() } else { vec![Call::new("cut-out", [Value::points(&points)])] }
    }
}

/// Two corners are those of a rectangle.
fn rectangle_of_two(points: Vec<Point>) -> Vec<Point> {
    match points.as_slice() {
        [a, b] => vec![*a, Point::new(b.x, a.y), *b, Point::new(a.x, b.y)],
        _ => points,
    }
}

impl Tool for CutOut {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => self.to(scope.at(), scope),
            Input::DragStart { at, .. } if self.path.is_empty() => {
                self.path = Path::from(at);
                Vec::new()
            }
            Input::Drop => {
                self.path.go_to(scope.at(), scope);
                self.close()
            }
            Input::Typed(typed) => match self.path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.close(),
            Input::Escape => {
                self.path = Path::default();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        if self.path.is_empty() {
            "Courtyard: drag a rectangle inside a room, or click its corners".to_owned()
        } else {
            "Click the next corner · click the first again or press Enter to close · Esc cancels".to_owned()
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.path.is_empty() {
            return;
        }
        let mut points = self.path.points.clone();
        points.push(scope.at());
        let closed = rectangle_of_two(points);
        if closed.len() >= 3 {
            preview.label(scope.at(), scope.units.area(polygon::signed_area(&closed).abs()), Look::Danger);
            preview.fill(closed.clone(), Vec::new(), Look::Danger);
        }
        preview.dashed(closed, true, Look::Danger);
        self.path.preview_corners(preview);
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        Some(&mut self.path)
    }

    fn anchor(&self) -> Option<Anchor> {
        // The first two corners are a rectangle's: any direction.
        self.path.anchor().filter(|_| self.path.points.len() > 1)
    }

    fn points(&self) -> Vec<Point> {
        self.path.points.clone()
    }
}
