//! Splits rooms along a line, without a wall.

use super::path::Path;
use super::preview::{Look, Preview};
use super::{Anchor, Call, Entry, Input, Scope, TakenBack, Tool, Typing};
use crate::app::commands::points_word;
use crate::geometry::Point;

pub(super) const ENTRY: Entry = Entry { id: "split", make: || Box::new(Split::default()) };

/// No points yet, or some.
#[derive(Default)]
struct Split {
    path: Path,
}

impl Split {
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        if self.path.is_last(point) {
            return self.end();
        }
        // Ready -> Cutting, Cutting -> Cutting
        let is_first = self.path.is_empty();
        self.path.go_to(point, scope);
        // On a boundary the line has come through.
        let index = scope.derived.map(|derived| &derived.index);
        let is_through = index.is_some_and(|index| !index.edges_near(point, SAME_PLACE_M).is_empty());
        if !is_first && is_through { self.end() } else { Vec::new() }
    }

    /// Cutting -> Ready
    fn end(&mut self) -> Vec<Call> {
        let points = std::mem::take(&mut self.path.points);
        if points.len() < 2 { Vec::new() } else { vec![("split-rooms", vec![points_word(&points)])] }
    }
}

/// A point this near to a boundary is on it.
const SAME_PLACE_M: f64 = 1e-3;

impl Tool for Split {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => self.to(scope.at(), scope),
            Input::Typed(typed) => match self.path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.end(),
            Input::Escape => {
                self.path = Path::default();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        if self.path.is_empty() {
            "Split: click on a room's boundary, then on the other side".to_owned()
        } else {
            "Click on the boundary across · points in between bend the line · Esc drops it".to_owned()
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.path.is_empty() {
            return;
        }
        let mut points = self.path.points.clone();
        points.push(scope.at());
        preview.dashed(points, false, Look::Danger);
        self.path.preview_corners(preview);
        self.path.preview_next(scope, preview);
    }

    fn is_busy(&self) -> bool {
        !self.path.is_empty()
    }

    fn anchor(&self) -> Option<Anchor> {
        self.path.anchor()
    }

    fn typing(&self) -> Option<Typing> {
        self.is_busy().then_some(Typing::Length)
    }

    fn take_back(&mut self) -> TakenBack {
        if self.path.take_back().0 { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
