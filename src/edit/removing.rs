//! Removing elements, and what cannot stand without them.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::heal::healed;
use crate::edit::{EditError, fail};
use crate::plan::{CornerId, ElementId, Joint, OpeningId, Place, Plan, Room, RoomId, ordered, ring_edges};

/// What removing elements would also remove: the walls, rooms and openings that use a removed corner, the
/// openings of removed walls and those whose edge belongs to no wall or room any more, and unused corners.
/// Sorted; includes the given elements.
pub fn removed_with(plan: &Plan, elements: &[ElementId]) -> BTreeSet<ElementId> {
    let mut gone: BTreeSet<ElementId> = elements.iter().copied().collect();
    let corner_gone = |gone: &BTreeSet<ElementId>, corner: &CornerId| gone.contains(&ElementId::Corner(*corner));
    for (id, wall) in plan.walls() {
        if corner_gone(&gone, &wall.from) || corner_gone(&gone, &wall.to) {
            gone.insert(ElementId::Wall(id));
        }
    }
    for (id, room) in plan.rooms() {
        if room.rings().flat_map(|ring| ring.iter()).any(|corner| corner_gone(&gone, corner)) {
            gone.insert(ElementId::Room(id));
        }
    }
    // Edges and corners that are still used.
    let mut edges: BTreeSet<[CornerId; 2]> = BTreeSet::new();
    let mut used: BTreeSet<CornerId> = BTreeSet::new();
    let mut walls_gone: BTreeSet<[CornerId; 2]> = BTreeSet::new();
    for (id, wall) in plan.walls() {
        if gone.contains(&ElementId::Wall(id)) {
            walls_gone.insert(ordered(wall.from, wall.to));
        } else {
            edges.insert(ordered(wall.from, wall.to));
            used.extend([wall.from, wall.to]);
        }
    }
    // Where another wall stands on the same edge, that one has the openings.
    walls_gone.retain(|edge| !edges.contains(edge));
    for (id, room) in plan.rooms() {
        if !gone.contains(&ElementId::Room(id)) {
            for ring in room.rings() {
                edges.extend(ring_edges(ring).map(|(a, b)| ordered(a, b)));
                used.extend(ring.iter().copied());
            }
        }
    }
    // Only what loses its support is removed: a free-standing corner, or an opening whose edge never
    // belonged to anything, stays unless it is given.
    let mut edges_before: BTreeSet<[CornerId; 2]> = edges.clone();
    let mut losing: BTreeSet<CornerId> = BTreeSet::new();
    for element in &gone {
        match element {
            ElementId::Wall(id) => {
                if let Some(wall) = plan.wall(*id) {
                    edges_before.insert(ordered(wall.from, wall.to));
                    losing.extend([wall.from, wall.to]);
                }
            }
            ElementId::Room(id) => {
                for ring in plan.room(*id).into_iter().flat_map(Room::rings) {
                    edges_before.extend(ring_edges(ring).map(|(a, b)| ordered(a, b)));
                    losing.extend(ring.iter().copied());
                }
            }
            _ => {}
        }
    }
    for (id, opening) in plan.openings() {
        if let Place::Hosted { from, to, .. } = opening.place {
            let edge = ordered(from, to);
            let lost = (edges_before.contains(&edge) && !edges.contains(&edge)) || walls_gone.contains(&edge);
            if lost || corner_gone(&gone, &from) || corner_gone(&gone, &to) {
                gone.insert(ElementId::Opening(id));
            } else if !gone.contains(&ElementId::Opening(id)) {
                used.extend([from, to]);
            }
        }
    }
    gone.extend(losing.difference(&used).map(|&corner| ElementId::Corner(corner)));
    gone
}

/// Removes elements and what depends on them, see [`removed_with`]. An opening pinned to a removed room
/// then leads outside on that side. Corners that then only divide a straight line go as well, and with them
/// the division.
///
/// # Errors
/// When an element does not exist.
pub fn remove(plan: &Plan, elements: &[ElementId]) -> Result<Plan, EditError> {
    for element in elements {
        let exists = match element {
            ElementId::Corner(id) => plan.corners.contains_key(id),
            ElementId::Wall(id) => plan.walls.contains_key(id),
            ElementId::Room(id) => plan.rooms.contains_key(id),
            ElementId::Opening(id) => plan.openings.contains_key(id),
            ElementId::Dimension(id) => plan.dimensions.contains_key(id),
        };
        if !exists {
            return fail(format!("{element} does not exist"));
        }
    }
    let mut next = plan.clone();
    let mut rooms_gone = BTreeSet::new();
    let gone = removed_with(plan, elements);
    let met = corners_met(plan, &gone);
    for element in gone {
        match element {
            ElementId::Corner(id) => drop(next.corners.remove(&id)),
            ElementId::Wall(id) => drop(next.walls.remove(&id)),
            ElementId::Opening(id) => drop(next.openings.remove(&id)),
            ElementId::Dimension(id) => drop(next.dimensions.remove(&id)),
            ElementId::Room(id) => {
                next.rooms.remove(&id);
                rooms_gone.insert(id);
            }
        }
    }
    if !rooms_gone.is_empty() {
        let joins_gone = |joint: &Joint| matches!(joint, Joint::Room(id) if rooms_gone.contains(id));
        let touched: Vec<OpeningId> = next
            .openings
            .iter()
            .filter(|(_, opening)| opening.pinned.iter().flatten().any(joins_gone))
            .map(|(&id, _)| id)
            .collect();
        for id in touched {
            if let Some(shared) = next.openings.get_mut(&id) {
                for joint in Arc::make_mut(shared).pinned.iter_mut().flatten() {
                    if joins_gone(joint) {
                        *joint = Joint::Outside;
                    }
                }
            }
        }
    }
    Ok(healed(next, met))
}

/// The corners that walls and rooms among these elements use.
fn corners_met(plan: &Plan, elements: &BTreeSet<ElementId>) -> BTreeSet<CornerId> {
    let mut corners = BTreeSet::new();
    for element in elements {
        match element {
            ElementId::Wall(id) => corners.extend(plan.wall(*id).into_iter().flat_map(|wall| [wall.from, wall.to])),
            ElementId::Room(id) => {
                let rings = plan.room(*id).into_iter().flat_map(Room::rings);
                corners.extend(rings.flat_map(|ring| ring.iter().copied()));
            }
            ElementId::Corner(_) | ElementId::Opening(_) | ElementId::Dimension(_) => {}
        }
    }
    corners
}

/// The two rooms that lost the wall between them when these elements went: to be offered as one. `None` where
/// there are none, or more.
pub fn rooms_joined_by(before: &Plan, after: &Plan, elements: &[ElementId]) -> Option<[RoomId; 2]> {
    let walls = elements.iter().filter_map(|element| if let ElementId::Wall(id) = element { Some(*id) } else { None });
    let mut open: BTreeSet<[CornerId; 2]> =
        walls.filter_map(|id| before.wall(id)).map(|wall| ordered(wall.from, wall.to)).collect();
    if !open.is_empty() {
        for (_, wall) in after.walls() {
            open.remove(&ordered(wall.from, wall.to));
        }
    }
    if open.is_empty() {
        return None;
    }
    let mut rooms_at: BTreeMap<[CornerId; 2], BTreeSet<RoomId>> = BTreeMap::new();
    for (id, room) in after.rooms() {
        for (a, b) in room.rings().flat_map(|ring| ring_edges(ring)) {
            if open.contains(&ordered(a, b)) {
                rooms_at.entry(ordered(a, b)).or_default().insert(id);
            }
        }
    }
    let joined: BTreeSet<RoomId> = rooms_at.into_values().filter(|rooms| rooms.len() == 2).flatten().collect();
    <[RoomId; 2]>::try_from(joined.into_iter().collect::<Vec<_>>()).ok()
}
