//! The ghost of what an edit is about to make: the outlines of what is selected, moved, turned or copied.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::rc::Rc;

use super::Scope;
use crate::app::paint::preview::{Look, Preview};
use crate::edit;
use crate::geometry::{Point, Segment, Transform};
use crate::plan::{ElementId, Plan};

/// The most lines shown; for larger parts just the bounding box, since more would take longer than a
/// frame.
const MOST_LINES: usize = 3000;

/// What belongs to the selection: found once, and again when the plan or the selection changes.
#[derive(Default)]
pub(super) struct Selected {
    known: RefCell<Option<Known>>,
}

/// What belongs to some elements of a plan.
struct Known {
    plan: Plan,
    elements: BTreeSet<ElementId>,
    part: Rc<Plan>,
}

impl Selected {
    /// As a plan of its own; empty if nothing is selected.
    pub(super) fn part(&self, scope: &Scope<'_>) -> Rc<Plan> {
        let mut known = self.known.borrow_mut();
        if let Some(Known { plan, elements, part }) = known.as_ref()
            && plan.is_same_value(scope.plan)
            && elements == scope.selection.elements()
        {
            return Rc::clone(part);
        }
        let part = Rc::new(edit::fragment(scope.plan, scope.selection.elements()).unwrap_or_default());
        let (plan, elements) = (scope.plan.clone(), scope.selection.elements().clone());
        *known = Some(Known { plan, elements, part: Rc::clone(&part) });
        part
    }
}

/// The outlines of a part of a plan, transformed.
pub(super) fn ghost(part: &Plan, transform: Transform, preview: &mut Preview) {
    let place = |point: Point| transform.point(point);
    if lines_of(part) > MOST_LINES {
        let bounds = part.bounds();
        let (a, b) = (bounds.min, bounds.max);
        let corners = [a, Point::new(b.x, a.y), b, Point::new(a.x, b.y)];
        preview.line(corners.map(place).to_vec(), true, Look::New);
        return;
    }
    for (_, room) in part.rooms() {
        for ring in room.rings() {
            preview.line(part.ring_points(ring).into_iter().map(place).collect(), true, Look::New);
        }
    }
    for (_, wall) in part.walls() {
        if let Some(segment) = part.wall_segment(wall) {
            let moved = Segment::new(place(segment.a), place(segment.b));
            preview.wall(moved, wall.thickness_m * transform.factor(), Look::New);
        }
    }
    for (_, opening) in part.openings() {
        if let Some(segment) = part.opening_segment(opening) {
            preview.line(vec![place(segment.a), place(segment.b)], false, Look::Guide);
        }
    }
}

/// The same several times, as far as that is quick.
pub(super) fn ghosts(part: &Plan, transforms: &[Transform], preview: &mut Preview) {
    let most = (MOST_LINES / lines_of(part).max(1)).max(1);
    for &transform in transforms.iter().take(most) {
        ghost(part, transform, preview);
    }
}

fn lines_of(part: &Plan) -> usize {
    part.walls().len() + part.rooms().len() + part.openings().len()
}
