//! Lays the plan over the storey below by two points that both have in common.

use super::{Call, Entry, Input, Scope, TakenBack, Tool, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, Segment};

pub(crate) const ENTRY: Entry = Entry {
    id: "tool-common-points",
    title: "Lay over by two common points",
    help: "Click a point of this plan, then the same point of the storey below; do so with a second point far from the \
           first",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(CommonPoints::default()),
};

/// In turn a point of the plan and its place in the storey below.
#[derive(Default)]
struct CommonPoints {
    points: Vec<Point>,
}

/// Two points of one plan closer than this, in points, would not say how it is turned.
const LEAST_PX: f64 = 24.0;

impl Tool for CommonPoints {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click if scope.below.is_some() => {
                // The first of the same plan.
                let earlier = self.points.len().checked_sub(2).and_then(|at| self.points.get(at));
                if earlier.is_some_and(|point| point.distance(scope.at()) < scope.metres(LEAST_PX)) {
                    return Vec::new();
                }
                self.points.push(scope.at());
                match self.points[..] {
                    [a, p, b, q] => {
                        self.points.clear();
                        vec![Call::new("lay-over-storey", [Value::points(&[a, b, p, q])])]
                    }
                    _ => Vec::new(),
                }
            }
            Input::Escape | Input::SecondaryClick => {
                self.points.clear();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if scope.below.is_none() {
            return "No storey is shown below; show one first".to_owned();
        }
        match self.points.len() {
            0 => "Lay over: click a point of this plan that the storey below has too, such as a corner of its stairs",
            1 => "Click the same point of the storey below, drawn faintly · Esc cancels",
            2 => "Click a second point of this plan, far from the first · Esc cancels",
            _ => "Click the second point of the storey below · Esc cancels",
        }
        .to_owned()
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        for (index, point) in self.points.iter().enumerate() {
            preview.handle(*point, if index % 2 == 0 { Look::New } else { Look::Guide });
        }
        for (index, pair) in self.points.chunks(2).enumerate() {
            let to = pair.get(1).copied().unwrap_or(scope.pointer);
            preview.line(vec![pair[0], to], false, Look::Guide);
            preview.label(Segment::new(pair[0], to).midpoint(), (index + 1).to_string(), Look::Guide);
        }
    }

    fn is_busy(&self) -> bool {
        !self.points.is_empty()
    }

    fn take_back(&mut self) -> TakenBack {
        if self.points.pop().is_some() { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
