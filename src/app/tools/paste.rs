//! Pastes what was copied.

use super::{Call, Entry, Input, Scope, Tool, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, Segment, Vector};
use crate::plan::Plan;

pub(crate) const ENTRY: Entry = Entry {
    id: "paste",
    title: "Paste",
    help: "Paste what was copied; click to place it",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Paste),
};

/// The pointer carries what was copied last.
struct Paste;

/// The most lines shown; for larger copies just the bounding box, since more would take longer than a
/// frame.
const MOST_LINES: usize = 3000;

impl Tool for Paste {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => vec![Call::new("paste-at", [Value::point(scope.at())])],
            Input::SecondaryClick => vec![Call::new("clear-selection", [])],
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        "Paste: click to place it, as often as you like · Esc ends".to_owned()
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(copied) = scope.copied else { return };
        let by = scope.at() - copied.bounds().center();
        if copied.walls().len() + copied.rooms().len() > MOST_LINES {
            let bounds = copied.bounds();
            let corners = [bounds.min, bounds.max].map(|corner| corner + by);
            let [a, b] = corners;
            let points = vec![a, Point::new(b.x, a.y), b, Point::new(a.x, b.y)];
            preview.line(points, true, Look::New);
            return;
        }
        outline(copied, by, preview);
    }
}

/// The lines of a plan, moved.
fn outline(plan: &Plan, by: Vector, preview: &mut Preview) {
    for (_, room) in plan.rooms() {
        let points = plan.ring_points(&room.outer).into_iter().map(|point| point + by).collect::<Vec<_>>();
        preview.line(points, true, Look::New);
    }
    for (_, wall) in plan.walls() {
        if let Some(segment) = plan.wall_segment(wall) {
            let moved = Segment::new(segment.a + by, segment.b + by);
            preview.wall(moved, wall.thickness_m, Look::New);
        }
    }
    for (_, opening) in plan.openings() {
        if let Some(segment) = plan.opening_segment(opening) {
            preview.line(vec![segment.a + by, segment.b + by], false, Look::Guide);
        }
    }
}
