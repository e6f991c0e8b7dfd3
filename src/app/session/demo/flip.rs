//! The search for a label that flips: a door that is dragged along its wall, or else a wall.

use std::collections::BTreeSet;

use crate::app::session::document::{Labelled, LabelledBy};
use crate::app::session::live::{Changed, changes};
use crate::base::work::Work;
use crate::classify::models::Models;
use crate::edit::{self, Reach, WallDrag};
use crate::geometry::{Point, Vector};
use crate::labels::Schemes;
use crate::plan::{ElementId, OpeningId, Place, Plan, WallId};

/// Places along a wall where a door is tried are so far apart, and at most so far from where it is, in metres.
const DOOR_STEP_M: f64 = 1.0;
const DOOR_REACH_M: f64 = 16.0;

/// How far a wall is tried to be moved, in metres.
const WALL_STEPS_M: [f64; 6] = [-2.0, -1.2, -0.6, 0.6, 1.2, 2.0];

/// A flip as sure as this, before and after, is worth showing.
const SURE: f64 = 0.45;

/// Something dragged, and the label that it changes.
#[derive(Clone, Debug)]
pub(super) struct Flip {
    pub(super) dragged: Dragged,
    pub(super) changed: Changed,
}

#[derive(Clone, Debug)]
pub(super) enum Dragged {
    Door { id: OpeningId, from: Point, to: Point },
    Wall { id: WallId, from: Point, by: Vector },
}

impl Dragged {
    /// The plan when it has been dragged so far, 0..=1.
    pub(super) fn apply(&self, plan: &Plan, share: f64) -> Option<Plan> {
        match self {
            Self::Door { id, from, to } => edit::slide_opening(plan, *id, from.lerp(*to, share)).ok(),
            Self::Wall { id, by, .. } => {
                let drag = WallDrag::new(plan, &BTreeSet::from([*id]), &BTreeSet::new(), Reach::Run)?;
                drag.apply(plan, *by * share).ok().map(|changed| changed.plan)
            }
        }
    }

    /// Where it is held.
    pub(super) fn held(&self, share: f64) -> Point {
        match self {
            Self::Door { from, to, .. } => from.lerp(*to, share),
            Self::Wall { from, by, .. } => *from + *by * share,
        }
    }

    pub(super) const fn element(&self) -> ElementId {
        match self {
            Self::Door { id, .. } => ElementId::Opening(*id),
            Self::Wall { id, .. } => ElementId::Wall(*id),
        }
    }
}

/// The drag that changes a label most surely: a door along its wall, or else a wall; `None` if none changes any.
pub(super) fn find_flip(plan: &Plan, schemes: &Schemes, models: &Models, work: &Work<'_>) -> Option<Flip> {
    let by = LabelledBy::default();
    let base = Labelled::new(plan, schemes, Some((&by, models)), None);
    let tried = |dragged: Dragged| -> Option<(f64, Flip)> {
        work.goes_on().ok()?;
        let next = dragged.apply(plan, 1.0)?;
        let after = Labelled::new(&next, schemes, Some((&by, models)), Some(&base));
        let changed = changes(&base, &after).into_iter().filter(Changed::is_flip);
        let sure = |changed: &Changed| changed.before.1.min(changed.after.1);
        let best = changed.max_by(|p, q| sure(p).total_cmp(&sure(q)))?;
        Some((sure(&best), Flip { dragged, changed: best }))
    };
    let best = |flips: &mut dyn Iterator<Item = Dragged>| {
        let mut best: Option<(f64, Flip)> = None;
        for (sure, flip) in flips.filter_map(tried) {
            if best.as_ref().is_none_or(|(than, _)| sure > *than) {
                best = Some((sure, flip));
            }
        }
        best
    };
    let mut doors = doors_to_try(plan, &base).into_iter();
    let door = best(&mut doors);
    if let Some((_, flip)) = door.as_ref().filter(|(sure, _)| *sure >= SURE) {
        return Some(flip.clone());
    }
    let across = |id: WallId| {
        let segment = plan.wall_segment(plan.wall(id)?)?;
        Some((id, segment.midpoint(), segment.vector().left().unit()?))
    };
    let walls: Vec<(WallId, Point, Vector)> = plan.walls().filter_map(|(id, _)| across(id)).collect();
    let mut walls = walls
        .into_iter()
        .flat_map(|(id, from, across)| WALL_STEPS_M.map(|step_m| Dragged::Wall { id, from, by: across * step_m }));
    let wall = best(&mut walls);
    let all = [door, wall].into_iter().flatten();
    all.max_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, flip)| flip)
}

/// Places to which doors could be dragged where they lead to other rooms.
fn doors_to_try(plan: &Plan, base: &Labelled) -> Vec<Dragged> {
    let mut tried = Vec::new();
    let shapes = &base.analysis.shapes;
    for connection in base.analysis.graph.connections() {
        let Some(opening) = plan.opening(connection.opening) else { continue };
        let Some(segment) = plan.opening_segment(opening) else { continue };
        let (Place::Hosted { .. }, None, Some(along)) = (opening.place, opening.pinned, segment.vector().unit()) else {
            continue;
        };
        let from = segment.midpoint();
        let mut known = vec![connection.sides];
        let steps = (DOOR_REACH_M / DOOR_STEP_M) as i32;
        let mut ways: Vec<i32> = (-steps..=steps).filter(|&step| step != 0).collect();
        ways.sort_by_key(|step| (step.abs(), *step));
        for step in ways {
            let to = from + along * (f64::from(step) * DOOR_STEP_M);
            let Ok(next) = edit::slide_opening(plan, connection.opening, to) else { continue };
            let Some(moved) = next.opening(connection.opening) else { continue };
            let sides = crate::topology::sides_by_geometry(&next, shapes, moved);
            if known.contains(&sides) {
                continue;
            }
            known.push(sides);
            let Some(to) = next.opening_segment(moved).map(|segment| segment.midpoint()) else { continue };
            tried.push(Dragged::Door { id: connection.opening, from, to });
        }
    }
    tried
}
