//! What is dragged when the selection is: rooms, which come away from what they share, or walls, which take it along.

use std::collections::{BTreeMap, BTreeSet};

use super::Scope;
use super::ghost::ghost;
use crate::app::paint::preview::{Look, Preview};
use crate::edit::{self, Reach, WallDrag};
use crate::geometry::{Point, Segment, Transform, Vector};
use crate::plan::{CornerId, ElementId, Plan};

/// The most corners whose edges are shown while they are dragged: more would hide the plan.
const MOST_MOVED: usize = 400;

/// What is dragged: found when the drag begins.
pub(super) enum Moving {
    /// Rooms with their walls and openings, or openings alone.
    Part(Box<Plan>),
    /// Walls and corners.
    Walls {
        run: Box<WallDrag>,
        /// A single wall of a longer run, alone.
        piece: Option<Box<WallDrag>>,
        /// The direction across a single wall.
        across: Option<Vector>,
    },
}

impl Moving {
    /// What is selected.
    pub(super) fn of(scope: &Scope<'_>) -> Self {
        let (plan, selection) = (scope.plan, scope.selection);
        let walls: BTreeSet<_> = selection.walls().collect();
        let corners: BTreeSet<_> = selection.corners().collect();
        let of_reach = |reach| WallDrag::new(plan, &walls, &corners, reach);
        if selection.rooms().next().is_none()
            && let Some(run) = of_reach(Reach::Run)
        {
            let piece = of_reach(Reach::Piece).filter(WallDrag::is_of_a_piece).map(Box::new);
            let wall = match selection.one() {
                Some(ElementId::Wall(id)) => plan.wall(id),
                _ => None,
            };
            let segment = wall.and_then(|wall| plan.wall_segment(wall));
            let across = segment.and_then(|segment| segment.vector().left().unit());
            return Self::Walls { run: Box::new(run), piece, across };
        }
        Self::Part(Box::new(edit::fragment(plan, selection.elements()).unwrap_or_default()))
    }

    /// Only a piece of a run, where that is wanted.
    pub(super) fn piece(&self, scope: &Scope<'_>) -> Option<&WallDrag> {
        match self {
            Self::Walls { piece, .. } if scope.modifiers.command => piece.as_deref(),
            _ => None,
        }
    }

    /// How far it is moved. A single wall moves across itself, unless Shift is held.
    pub(super) fn moved_by(&self, from: Point, scope: &Scope<'_>) -> Vector {
        let by = scope.at() - from;
        match self {
            Self::Walls { across: Some(across), .. } if !scope.modifiers.shift || self.piece(scope).is_some() => {
                *across * by.dot(*across)
            }
            _ => by,
        }
    }

    pub(super) fn hint(&self, scope: &Scope<'_>) -> String {
        let what = match self {
            Self::Part(part) if part.rooms().len() == 0 => "Alt: no snapping",
            Self::Part(_) => "It comes away from its neighbours, which stay as they are · Alt: no snapping",
            Self::Walls { .. } if self.piece(scope).is_some() => {
                "Only this piece moves; short walls at right angles join it with the rest"
            }
            Self::Walls { piece: Some(_), .. } => {
                "The whole straight wall moves, and what shares it follows · Ctrl: only this piece · Shift: any \
                 direction"
            }
            Self::Walls { across: Some(_), .. } => {
                "What shares the wall follows · Shift: any direction · Alt: no snapping"
            }
            Self::Walls { .. } => "What shares these walls follows · Alt: no snapping",
        };
        format!("{what} · Esc cancels")
    }

    /// The plan if it were let go now.
    pub(super) fn would_be(&self, by: Vector, scope: &Scope<'_>) -> Option<Plan> {
        match self {
            Self::Walls { run, .. } => {
                let drag = self.piece(scope).unwrap_or(run);
                drag.apply(scope.plan, by).ok().map(|changed| changed.plan)
            }
            // Rooms come away from their neighbours: what that makes of the plan is seen once they are let go.
            Self::Part(_) => None,
        }
    }

    /// Where it would be.
    pub(super) fn preview(&self, by: Vector, scope: &Scope<'_>, preview: &mut Preview) {
        match self {
            Self::Part(part) => ghost(part, Transform::translation(by), preview),
            Self::Walls { run, across, .. } => {
                let drag = self.piece(scope).unwrap_or(run);
                let joints = drag.joints(scope.plan, by);
                let targets: BTreeMap<CornerId, Point> = drag.targets(by).into_iter().collect();
                if joints.is_empty() {
                    preview_moved(scope, &targets, preview);
                    return;
                }
                // Only the piece and what joins it: the rest of the run stays.
                let wall = scope.selection.walls().next().and_then(|id| scope.plan.wall(id));
                if let Some(wall) = wall
                    && let (Some(&a), Some(&b)) = (targets.get(&wall.from), targets.get(&wall.to))
                {
                    let by = across.map_or(by, |across| across * by.dot(across));
                    preview.wall(Segment::new(a, b), wall.thickness_m, Look::New);
                    for Segment { a, .. } in joints {
                        preview.wall(Segment::new(a, a + by), wall.thickness_m, Look::New);
                    }
                }
            }
        }
    }
}

/// The edges of moved corners, at their new positions.
pub(super) fn preview_moved(scope: &Scope<'_>, targets: &BTreeMap<CornerId, Point>, preview: &mut Preview) {
    let Some(derived) = scope.derived else { return };
    let mut shown = BTreeSet::new();
    for &corner in targets.keys().take(MOST_MOVED) {
        let Some(place) = scope.plan.position(corner) else { continue };
        for edge in derived.index.edges_near(place, 1e-4) {
            if !shown.insert(edge.corners) {
                continue;
            }
            let [a, b] = edge
                .corners
                .map(|id| targets.get(&id).copied().unwrap_or_else(|| scope.plan.position(id).unwrap_or_default()));
            if edge.wall.is_some() {
                preview.wall(Segment::new(a, b), edge.thickness_m, Look::New);
            } else {
                preview.line(vec![a, b], false, Look::New);
            }
        }
    }
}
