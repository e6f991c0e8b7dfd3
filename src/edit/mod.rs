//! Edits: functions from plan to plan. Each returns a plan that keeps the invariants, or an error that
//! says what is in the way; the given plan is never changed.

mod across;
mod bridge;
mod calibration;
mod close;
mod copy;
mod draw;
mod fill;
mod free_space;
pub mod guides;
mod local;
mod merge;
mod moving;
pub mod naming;
mod offset;
mod openings;
pub(crate) mod overlay;
mod rectify;
pub(crate) mod split;
mod square_up;
pub mod storey;
mod weld;

use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;

use crate::geometry::{COORDINATE_LIMIT_M, Point, trim_m};
use crate::plan::{
    Backdrop, Corner, CornerId, ElementId, Joint, Meta, Opening, OpeningId, Place, Plan, Room, RoomId, RoomLabel, Wall,
    WallId,
    builder::{new_corner_id, new_opening_id, new_room_id, new_wall_id},
    ordered, ring_edges,
};

pub use across::{Across, room_around, split_rooms, straight_across};
pub use bridge::bridge_gaps;
pub use calibration::{
    Calibration, DrawingMoves, UNMEASURED_METRES_PER_PIXEL, move_picture, set_measurements, straightening_rad,
    turn_picture,
};
pub use close::fill_closed;
pub use copy::{Array, array, copy_elements, fragment, insert};
pub use draw::{Drawn, cut_out, draw_room, draw_walls, split_room};
pub use fill::{Filled, fill_all, fill_at};
pub use free_space::{DrawnInFreeSpace, GAP_BETWEEN_ROOMS_M, draw_room_in_free_space};
pub use local::locally;
pub use merge::merge_rooms;
pub use moving::{Alignment, align, corners_of, distribute, move_elements, set_thickness};
pub use offset::{offset_room, offset_walls};
pub use openings::{
    OpeningPreview, flip_hinge, flip_side, opening_at, opening_on, opening_preview, place_opening, resize_opening,
    set_opening_kind, set_swing, slide_opening,
};
pub use rectify::{in_order, rectify_picture, unrectify_picture};
pub use square_up::square_up;
pub use weld::{Weld, settle, weld};

/// Why an edit failed, worded for the status line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EditError(pub String);

impl fmt::Display for EditError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for EditError {}

pub(crate) fn fail<T>(what: impl Into<String>) -> Result<T, EditError> {
    Err(EditError(what.into()))
}

pub(crate) fn checked_position(point: Point) -> Result<Point, EditError> {
    let position = point.trimmed();
    if position.is_finite() && position.x.abs() <= COORDINATE_LIMIT_M && position.y.abs() <= COORDINATE_LIMIT_M {
        return Ok(position);
    }
    fail(format!("({}, {}) lies outside the drawing area of ±{COORDINATE_LIMIT_M} m", point.x, point.y))
}

/// Replaces the plan's metadata.
pub fn set_meta(plan: &Plan, meta: Meta) -> Plan {
    Plan { meta: Arc::new(meta), ..plan.clone() }
}

/// Sets, replaces or removes the backdrop.
pub fn set_backdrop(plan: &Plan, backdrop: Option<Backdrop>) -> Plan {
    Plan { backdrop: backdrop.map(Arc::new), ..plan.clone() }
}

/// Adds a corner at a point (on the 0.1 mm grid). To snap to an existing corner, use that one instead.
///
/// # Errors
/// When the point lies outside the drawing area.
pub fn add_corner(plan: &Plan, point: Point) -> Result<(Plan, CornerId), EditError> {
    let position = checked_position(point)?;
    let id = new_corner_id(plan, position);
    let mut next = plan.clone();
    next.corners.insert(id, Corner { position, extra: None });
    Ok((next, id))
}

/// Moves corners, and with them every wall, room and hosted opening that uses them. An opening keeps its
/// distance from the first corner of its edge, as far as the edge allows.
///
/// # Errors
/// When a corner does not exist, a target lies outside the drawing area, or an edge hosting an opening
/// would lose its length.
pub fn move_corners(plan: &Plan, targets: &[(CornerId, Point)]) -> Result<Plan, EditError> {
    let mut next = plan.clone();
    let mut moved = BTreeSet::new();
    for &(id, point) in targets {
        let position = checked_position(point)?;
        let Some(corner) = next.corners.get_mut(&id) else { return fail(format!("the corner {id} does not exist")) };
        corner.position = position;
        moved.insert(id);
    }
    let touched: Vec<OpeningId> = plan
        .openings
        .iter()
        .filter(|(_, opening)| matches!(opening.place, Place::Hosted { from, to, .. } if moved.contains(&from) || moved.contains(&to)))
        .map(|(&id, _)| id)
        .collect();
    for id in touched {
        let Some(shared) = next.openings.get_mut(&id) else { continue };
        let opening = Arc::make_mut(shared);
        if let Place::Hosted { from, to, at_m, .. } = &mut opening.place {
            let (Some(a), Some(b)) = (next.corners.get(from), next.corners.get(to)) else { continue };
            let length = a.position.distance(b.position);
            if length <= 0.0 {
                return fail(format!("the wall of the opening {id} would lose its length"));
            }
            *at_m = trim_m(at_m.min(length));
        }
    }
    Ok(next)
}

/// Adds a wall between two corners.
///
/// # Errors
/// When a corner does not exist, both are the same, or the thickness is not within 0..=10 m.
pub fn add_wall(plan: &Plan, from: CornerId, to: CornerId, thickness_m: f64) -> Result<(Plan, WallId), EditError> {
    require_corners(plan, &[from, to])?;
    if from == to {
        return fail("a wall needs two different corners");
    }
    check_thickness(thickness_m)?;
    let id = new_wall_id(plan, from, to);
    let mut next = plan.clone();
    next.walls.insert(id, Wall { from, to, thickness_m: trim_m(thickness_m), extra: None });
    Ok((next, id))
}

/// Adds a room.
///
/// # Errors
/// When a ring has fewer than three corners, repeats one twice in a row, or uses one that does not exist.
pub fn add_room(plan: &Plan, room: Room) -> Result<(Plan, RoomId), EditError> {
    for ring in room.rings() {
        require_corners(plan, ring)?;
        if ring.len() < 3 {
            return fail(format!("a room needs at least three corners, not {}", ring.len()));
        }
        if let Some(i) = (0..ring.len()).find(|&i| ring[i] == ring[(i + 1) % ring.len()]) {
            return fail(format!("the corner {} follows itself in the room's boundary", ring[i]));
        }
    }
    let id = new_room_id(plan, "", &room);
    let mut next = plan.clone();
    next.rooms.insert(id, Arc::new(room));
    Ok((next, id))
}

/// Adds an opening.
///
/// # Errors
/// When its edge does not exist or has no length, its middle is not on the edge, it has no width, or it
/// is pinned to a room that does not exist.
pub fn add_opening(plan: &Plan, opening: Opening) -> Result<(Plan, OpeningId), EditError> {
    let opening = opening.trimmed();
    match opening.place {
        Place::Hosted { from, to, at_m, width_m } => {
            require_corners(plan, &[from, to])?;
            let length = plan.position(from).zip(plan.position(to)).map_or(0.0, |(a, b)| a.distance(b));
            if length <= 0.0 {
                return fail("an opening needs a wall with a length");
            }
            if !(0.0..=length).contains(&at_m) {
                return fail(format!("the opening's middle at {at_m} m lies beyond its wall of {length:.2} m"));
            }
            if !(width_m > 0.0 && width_m <= 1000.0) {
                return fail(format!("an opening's width is above 0 and at most 1000 m, not {width_m} m"));
            }
        }
        Place::Free { from, to } => {
            checked_position(from)?;
            checked_position(to)?;
            if from == to {
                return fail("an opening needs a width");
            }
        }
    }
    for joint in opening.pinned.iter().flatten() {
        if let Joint::Room(room) = joint {
            require_room(plan, *room)?;
        }
    }
    let id = new_opening_id(plan, "", &opening);
    let mut next = plan.clone();
    next.openings.insert(id, Arc::new(opening));
    Ok((next, id))
}

/// What removing elements would also remove: the walls, rooms and openings that use a removed corner, the
/// openings whose edge belongs to no wall or room any more, and unused corners. Sorted; includes the
/// given elements.
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
    for (id, wall) in plan.walls() {
        if !gone.contains(&ElementId::Wall(id)) {
            edges.insert(ordered(wall.from, wall.to));
            used.extend([wall.from, wall.to]);
        }
    }
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
            let lost = edges_before.contains(&edge) && !edges.contains(&edge);
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
/// then leads outside on that side.
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
        };
        if !exists {
            return fail(format!("{element} does not exist"));
        }
    }
    let mut next = plan.clone();
    let mut rooms_gone = BTreeSet::new();
    for element in removed_with(plan, elements) {
        match element {
            ElementId::Corner(id) => drop(next.corners.remove(&id)),
            ElementId::Wall(id) => drop(next.walls.remove(&id)),
            ElementId::Opening(id) => drop(next.openings.remove(&id)),
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
    Ok(next)
}

/// Changes one room: its function, label, name, note or rings.
///
/// # Errors
/// When the room does not exist, or the change leaves it without a valid boundary.
pub fn change_room(plan: &Plan, id: RoomId, change: impl FnOnce(&mut Room)) -> Result<Plan, EditError> {
    require_room(plan, id)?;
    let mut next = plan.clone();
    if let Some(shared) = next.rooms.get_mut(&id) {
        let room = Arc::make_mut(shared);
        let rings: Vec<Arc<[CornerId]>> = room.rings().cloned().collect();
        change(room);
        if !room.rings().eq(rings.iter()) {
            let room = room.clone();
            add_room(plan, room)?;
        }
    }
    Ok(next)
}

/// Sets what a room is for; empty text means unknown.
///
/// # Errors
/// When the room does not exist.
pub fn set_function(plan: &Plan, id: RoomId, function: &str) -> Result<Plan, EditError> {
    change_room(plan, id, |room| room.function = function.trim().to_owned())
}

/// Gives a room a label of its own, or removes it.
///
/// # Errors
/// When the room does not exist.
pub fn set_label(plan: &Plan, id: RoomId, label: Option<RoomLabel>) -> Result<Plan, EditError> {
    change_room(plan, id, |room| room.label = label)
}

/// Sets a room's name.
///
/// # Errors
/// When the room does not exist.
pub fn set_name(plan: &Plan, id: RoomId, name: &str) -> Result<Plan, EditError> {
    change_room(plan, id, |room| room.name = name.trim().to_owned())
}

fn check_thickness(thickness_m: f64) -> Result<(), EditError> {
    if (0.0..=10.0).contains(&thickness_m) {
        return Ok(());
    }
    fail(format!("a wall's thickness is between 0 and 10 m, not {thickness_m} m"))
}

fn require_corners(plan: &Plan, corners: &[CornerId]) -> Result<(), EditError> {
    match corners.iter().find(|id| !plan.corners.contains_key(*id)) {
        Some(id) => fail(format!("the corner {id} does not exist")),
        None => Ok(()),
    }
}

pub(crate) fn require_room(plan: &Plan, id: RoomId) -> Result<(), EditError> {
    if plan.rooms.contains_key(&id) { Ok(()) } else { fail(format!("the room {id} does not exist")) }
}
