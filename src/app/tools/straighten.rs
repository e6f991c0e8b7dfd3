//! Rotates the backdrop so that one of its lines becomes horizontal or vertical.

use super::{Call, Entry, Input, Scope, TakenBack, Tool, picture_numbers};
use crate::app::paint::preview::{Look, Preview};
use crate::edit::straightening_rad;
use crate::geometry::{Point, Segment};

pub(crate) const ENTRY: Entry = Entry {
    id: "tool-straighten",
    title: "Straighten",
    help: "Click along a wall of the picture that should be horizontal or vertical, to turn the picture",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Straighten { from: None }),
};

struct Straighten {
    from: Option<Point>,
}

/// A shorter line, in points, has no reliable direction.
const LEAST_PX: f64 = 12.0;

impl Straighten {
    /// From -> Ready
    fn end(&mut self, from: Point, scope: &Scope<'_>) -> Vec<Call> {
        if from.distance(scope.pointer) < scope.metres(LEAST_PX) {
            return Vec::new();
        }
        self.from = None;
        vec![Call::new("straighten", picture_numbers([from.x, from.y, scope.pointer.x, scope.pointer.y]))]
    }
}

impl Tool for Straighten {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, self.from) {
            // Ready -> From
            (Input::Click, None) => self.from = Some(scope.pointer),
            (Input::DragStart { pointer, .. }, None) => self.from = Some(pointer),
            (Input::Click | Input::Drop, Some(from)) => return self.end(from, scope),
            (Input::Escape | Input::SecondaryClick, _) => self.from = None,
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if scope.plan.backdrop().is_none() {
            return "This plan has no picture; add one first".to_owned();
        }
        match self.from {
            None => "Straighten: click along a wall of the picture that should be horizontal or vertical".to_owned(),
            Some(_) => "Click further along the wall, the further the better · Esc cancels".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(from) = self.from else { return };
        let line = Segment::new(from, scope.pointer);
        preview.line(vec![line.a, line.b], false, Look::New);
        for end in [line.a, line.b] {
            preview.handle(end, Look::New);
        }
        if let Some(turn_rad) = straightening_rad(line.vector()) {
            let middle = line.midpoint();
            let half = (line.b - middle).rotated(turn_rad);
            preview.dashed(vec![middle + -half, middle + half], false, Look::Guide);
            preview.label(
                scope.pointer,
                format!(
                    "turns {:.2}° {}",
                    turn_rad.to_degrees().abs(),
                    if turn_rad < 0.0 { "clockwise" } else { "counter-clockwise" }
                ),
                Look::New,
            );
        }
    }

    fn is_busy(&self) -> bool {
        self.from.is_some()
    }

    // Refers to positions in the backdrop, not in the drawing.
    fn snaps(&self) -> bool {
        false
    }

    fn take_back(&mut self) -> TakenBack {
        match self.from.take() {
            Some(_) => TakenBack::Corner,
            None => TakenBack::Nothing,
        }
    }
}
