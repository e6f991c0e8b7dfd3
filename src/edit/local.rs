//! Edits that touch only their surroundings, done on a part of the plan: in a large one the rest costs nothing.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::edit::EditError;
use crate::geometry::Bounds;
use crate::plan::{ChangeKind, CornerId, Difference, ElementId, Place, Plan};

/// Does an edit on the part of a plan that lies near, and puts what it changed into the whole.
///
/// `near` are all elements that meet `bounds`, or more; the edit looks at nothing else and changes nothing beyond. What
/// comes out is what the edit makes of the whole plan, which it is done on where the part shows that it reaches
/// further.
///
/// # Errors
/// Those of the edit.
pub fn locally(
    plan: &Plan,
    near: &BTreeSet<ElementId>,
    bounds: Bounds,
    edit: impl Fn(&Plan) -> Result<Plan, EditError>,
) -> Result<Plan, EditError> {
    let part = part_of(plan, near);
    let edited = edit(&part)?;
    match merged(plan, &part, &edited, bounds) {
        Some(next) => Ok(next),
        None => edit(plan),
    }
}

/// Some elements of a plan, with the corners that they use and the openings on their edges.
fn part_of(plan: &Plan, elements: &BTreeSet<ElementId>) -> Plan {
    let mut part = Plan { meta: plan.meta.clone(), backdrop: plan.backdrop.clone(), ..Plan::default() };
    part.guides = plan.guides.clone();
    part.extra = plan.extra.clone();
    let mut corners: Vec<CornerId> = Vec::new();
    for element in elements {
        match element {
            ElementId::Corner(id) => corners.push(*id),
            ElementId::Wall(id) => {
                if let Some(wall) = plan.walls.get(id) {
                    corners.extend([wall.from, wall.to]);
                    part.walls.insert(*id, wall.clone());
                }
            }
            ElementId::Room(id) => {
                if let Some(room) = plan.rooms.get(id) {
                    corners.extend(room.rings().flat_map(|ring| ring.iter().copied()));
                    part.rooms.insert(*id, room.clone());
                }
            }
            ElementId::Opening(_) => {}
        }
    }
    corners.sort_unstable();
    corners.dedup();
    let mut more: Vec<CornerId> = Vec::new();
    for (id, opening) in &plan.openings {
        let is_on = match opening.place {
            Place::Hosted { from, to, .. } => [from, to].iter().all(|corner| corners.binary_search(corner).is_ok()),
            Place::Free { .. } => false,
        };
        let is_pinned = || {
            let rooms = opening.pinned.iter().flatten().filter_map(|joint| joint.room());
            rooms.into_iter().any(|room| part.rooms.contains_key(&room))
        };
        if is_on || elements.contains(&ElementId::Opening(*id)) || is_pinned() {
            if let Place::Hosted { from, to, .. } = opening.place {
                more.extend([from, to]);
            }
            part.openings.insert(*id, opening.clone());
        }
    }
    for id in corners.into_iter().chain(more) {
        if let Some(corner) = plan.corners.get(&id) {
            part.corners.insert(id, corner.clone());
        }
    }
    // What is pinned to a room far away stays so: the room comes along, and its corners.
    let pinned = part.openings.values().flat_map(|opening| opening.pinned.iter().flatten());
    let rooms: BTreeSet<_> = pinned.filter_map(|joint| joint.room()).collect();
    for id in rooms {
        if let Some(room) = plan.rooms.get(&id).filter(|_| !part.rooms.contains_key(&id)) {
            for corner in room.rings().flat_map(|ring| ring.iter()) {
                if let Some(known) = plan.corners.get(corner) {
                    part.corners.insert(*corner, known.clone());
                }
            }
            part.rooms.insert(id, Arc::clone(room));
        }
    }
    part
}

/// The whole plan with what was changed in a part of it; `None` where that concerns what lies beyond `bounds`, or
/// would take another's id.
fn merged(plan: &Plan, part: &Plan, edited: &Plan, bounds: Bounds) -> Option<Plan> {
    let difference = Difference::between(part, edited);
    if difference.meta || difference.backdrop || difference.guides || difference.extra {
        return None;
    }
    let mut next = plan.clone();
    for (&element, &kind) in &difference.elements {
        if kind == ChangeKind::Added && plan.has(element) {
            return None;
        }
        match element {
            ElementId::Corner(id) => {
                // Others may use a corner that lies beyond.
                let is_beyond = |plan: &Plan| plan.position(id).is_some_and(|point| !bounds.contains(point));
                if kind != ChangeKind::Added && (is_beyond(part) || is_beyond(edited)) {
                    return None;
                }
                match edited.corners.get(&id) {
                    Some(corner) => drop(next.corners.insert(id, corner.clone())),
                    None => drop(next.corners.remove(&id)),
                }
            }
            ElementId::Wall(id) => match edited.walls.get(&id) {
                Some(wall) => drop(next.walls.insert(id, wall.clone())),
                None => drop(next.walls.remove(&id)),
            },
            ElementId::Room(id) => match edited.rooms.get(&id) {
                Some(room) => drop(next.rooms.insert(id, Arc::clone(room))),
                None => drop(next.rooms.remove(&id)),
            },
            ElementId::Opening(id) => match edited.openings.get(&id) {
                Some(opening) => drop(next.openings.insert(id, Arc::clone(opening))),
                None => drop(next.openings.remove(&id)),
            },
        }
    }
    Some(next)
}
