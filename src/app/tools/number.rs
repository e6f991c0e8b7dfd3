//! Names rooms in order along a line drawn through them.

use super::{Call, Entry, Input, Scope, Tool, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, polygon};

pub(crate) const ENTRY: Entry = Entry {
    id: "tool-number",
    title: "Name along a line",
    help: "Drag a line through rooms to name them in that order",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Number::default()),
};

/// The spacing of points along the line, in pixels.
const STEP_PX: f64 = 4.0;

/// Ready while the line is empty, Drawing while it is not.
#[derive(Default)]
struct Number {
    line: Vec<Point>,
}

impl Number {
    fn add(&mut self, scope: &Scope<'_>) {
        let is_far = |last: &Point| last.distance(scope.pointer) >= scope.metres(STEP_PX);
        if self.line.last().is_none_or(is_far) {
            self.line.push(scope.pointer);
        }
    }
}

impl Tool for Number {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            // Ready -> Drawing
            Input::DragStart { pointer, .. } => {
                self.line = vec![pointer];
                self.add(scope);
            }
            // Drawing -> Drawing
            Input::Drag if !self.line.is_empty() => self.add(scope),
            // Drawing -> Ready
            Input::Drop if !self.line.is_empty() => {
                self.add(scope);
                let line = std::mem::take(&mut self.line);
                if line.len() > 1 {
                    return vec![Call::new("name-along", [Value::points(&line)])];
                }
            }
            Input::Escape => self.line.clear(),
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        if self.line.is_empty() {
            "Name: drag a line through the rooms in the order you want".to_owned()
        } else {
            "Release to name these rooms · Esc cancels".to_owned()
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.line.is_empty() {
            return;
        }
        if let Some(derived) = scope.derived {
            let shapes = &derived.analysis.shapes;
            for (index, room) in shapes.along(&self.line).into_iter().enumerate() {
                let Some(shape) = shapes.get(room) else { continue };
                preview.fill(shape.outer.clone(), shape.holes.clone(), Look::New);
                preview.label(polygon::centroid(&shape.outer), (index + 1).to_string(), Look::New);
            }
        }
        preview.line(self.line.clone(), false, Look::New);
    }

    fn is_busy(&self) -> bool {
        !self.line.is_empty()
    }

    fn snaps(&self) -> bool {
        false
    }
}
