//! The grips of a selected opening: its ends make it wider or narrower, its middle slides it along its wall.

use super::opening::leaves;
use super::{Call, Scope, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::base::units::Units;
use crate::edit::{self, End, beside_opening};
use crate::geometry::{Point, Segment, Vector};
use crate::plan::{ElementId, OpeningId, Place, Plan};

/// What is grabbed of an opening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip {
    /// An end, while the other stays.
    End(OpeningId, End),
    /// The whole of it: its middle is so far from the pointer.
    Middle(OpeningId, Vector),
}

/// The selected opening, if nothing else is selected, and where it lies.
fn selected(scope: &Scope<'_>) -> Option<(OpeningId, Segment)> {
    let ElementId::Opening(id) = scope.selection.one()? else { return None };
    let opening = scope.plan.opening(id)?;
    Some((id, scope.plan.opening_segment(opening)?))
}

/// The grip of the whole of an opening that is grabbed anywhere, such as by its leaf.
pub(super) fn held(plan: &Plan, id: OpeningId, pointer: Point) -> Grip {
    let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
    Grip::Middle(id, segment.map_or(Vector::default(), |segment| segment.midpoint() - pointer))
}

/// The grip at a point.
pub(super) fn grip_at(scope: &Scope<'_>, point: Point, reach_m: f64) -> Option<Grip> {
    let (id, segment) = selected(scope)?;
    // Where it is small on the screen, its middle is still there to be grabbed.
    let reach_m = reach_m.min(segment.length() / 3.0);
    let ends = End::BOTH.map(|end| (end.of(segment).distance(point), Grip::End(id, end)));
    let middle = (segment.midpoint().distance(point), Grip::Middle(id, segment.midpoint() - point));
    let near = ends.into_iter().chain([middle]).filter(|(distance_m, _)| *distance_m <= reach_m);
    near.min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, grip)| grip)
}

/// Shows the grips.
pub(super) fn show(scope: &Scope<'_>, preview: &mut Preview) {
    let Some((_, segment)) = selected(scope) else { return };
    for place in [segment.a, segment.midpoint(), segment.b] {
        preview.handle(place, Look::New);
    }
    // While arrow keys move it, as while it is dragged.
    if scope.is_nudging
        && let Some(ElementId::Opening(id)) = scope.selection.one()
    {
        show_distances(scope.plan, id, scope, preview);
    }
}

/// Shows how far an opening is from what lies beside it.
fn show_distances(plan: &Plan, id: OpeningId, scope: &Scope<'_>, preview: &mut Preview) {
    for beside in beside_opening(plan, id).into_iter().flatten().filter(|beside| beside.distance_m > 0.0) {
        preview.line(vec![beside.way.a, beside.way.b], false, Look::Guide);
        preview.dimension(beside.way, scope.units.length(beside.distance_m));
    }
}

/// Lengths that are dragged are whole multiples of this, in metres: a centimetre, half an inch.
const fn step_m(units: Units) -> f64 {
    match units {
        Units::Metric => 0.01,
        Units::Imperial => 0.0127,
    }
}

impl Grip {
    const fn opening(self) -> OpeningId {
        match self {
            Self::End(id, _) | Self::Middle(id, _) => id,
        }
    }

    /// The plan with the grip at a point.
    fn dragged(self, plan: &Plan, towards: Point) -> Option<Plan> {
        match self {
            Self::End(id, end) => edit::stretch_opening(plan, id, end, towards).ok(),
            Self::Middle(id, _) => edit::slide_opening(plan, id, towards).ok(),
        }
    }

    /// Where the grip goes when the pointer is where it is: to a round width, or a round distance from what lies beside
    /// it, unless Alt is held.
    fn target(self, scope: &Scope<'_>) -> Point {
        let towards = match self {
            Self::End(..) => scope.pointer,
            Self::Middle(_, offset) => scope.pointer + offset,
        };
        if scope.modifiers.alt {
            return towards;
        }
        let rounded = || {
            let next = self.dragged(scope.plan, towards)?;
            let id = self.opening();
            let segment = next.opening_segment(next.opening(id)?)?;
            let (now_m, outwards) = match self {
                Self::End(_, End::End) => (segment.length(), segment.vector().unit()?),
                Self::End(_, End::Start) => (segment.length(), -segment.vector().unit()?),
                Self::Middle(..) => {
                    let [before, _] = beside_opening(&next, id)?;
                    (before.distance_m, segment.vector().unit()?)
                }
            };
            let step_m = step_m(scope.units);
            let by_m = (now_m / step_m).round() * step_m - now_m;
            let grip = match self {
                Self::End(_, end) => end.of(segment),
                Self::Middle(..) => segment.midpoint(),
            };
            Some(grip + outwards * by_m)
        };
        rounded().unwrap_or(towards)
    }

    /// The plan if it were let go now.
    pub(super) fn would_be(self, scope: &Scope<'_>) -> Option<Plan> {
        self.dragged(scope.plan, self.target(scope))
    }

    /// What letting go does.
    pub(super) fn drop(self, scope: &Scope<'_>) -> Call {
        let to = Value::point(self.target(scope));
        match self {
            Self::End(id, end) => Call::new("stretch-opening", [Value::Opening(id), Value::word(end), to]),
            Self::Middle(id, _) => Call::new("slide-opening", [Value::Opening(id), to]),
        }
    }

    pub(super) fn hint(self, scope: &Scope<'_>) -> String {
        let is_free = scope.plan.opening(self.opening()).is_some_and(|it| matches!(it.place, Place::Free { .. }));
        match self {
            Self::End(..) => "The other end stays · Alt: any width · Esc cancels".to_owned(),
            Self::Middle(..) if is_free => "The opening slides along its line · Esc cancels".to_owned(),
            Self::Middle(..) => "The opening slides along its wall · Alt: any place · Esc cancels".to_owned(),
        }
    }

    /// Shows the opening where it would be, how wide it is, and how far from what lies beside it.
    pub(super) fn preview(self, scope: &Scope<'_>, preview: &mut Preview) {
        let id = self.opening();
        let Some(next) = self.dragged(scope.plan, self.target(scope)) else { return };
        let Some(opening) = next.opening(id) else { return };
        let Some(segment) = next.opening_segment(opening) else { return };
        preview.wall(segment, scope.metres(8.0), Look::New);
        let shown = scope.derived.and_then(|derived| derived.drawing.swing_of(id));
        for [hinge, shut, tip] in leaves(segment, opening.kind, opening.swing.or(shown)) {
            preview.line(vec![hinge, tip], false, Look::New);
            preview.arc(hinge, shut, tip, Look::New);
        }
        for place in [segment.a, segment.b] {
            preview.handle(place, Look::New);
        }
        show_distances(&next, id, scope, preview);
        preview.label(scope.pointer, scope.units.length(segment.length()), Look::New);
    }
}
