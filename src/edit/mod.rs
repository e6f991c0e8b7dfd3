//! Edits: functions from plan to plan. Each returns a plan that keeps the invariants, or an error that
//! says what is in the way; the given plan is never changed.

mod across;
mod along;
mod beside;
mod bridge;
mod calibration;
mod close;
mod copy;
mod dimension_length;
mod dimensions;
mod dragging;
mod draw;
mod facades;
mod fill;
mod free_space;
pub mod guides;
mod heal;
pub mod ignore;
mod local;
mod merge;
mod moving;
pub mod naming;
mod offset;
mod openings;
pub(crate) mod overlay;
mod picked;
mod rectify;
mod refit;
mod removing;
pub(crate) mod split;
mod square_up;
pub mod storey;
mod weld;

use std::fmt;
use std::sync::Arc;

use crate::geometry::{COORDINATE_LIMIT_M, Point, Vector, trim_m};
use crate::plan::{
    Backdrop, Corner, CornerId, Joint, Meta, Opening, OpeningId, Place, Plan, Room, RoomId, RoomLabel, Wall, WallId,
    builder::{new_corner_id, new_opening_id, new_room_id, new_wall_id},
};

pub use across::{Across, room_around, split_rooms, straight_across};
pub use along::{
    Beside, End, NARROWEST_OPENING_M, beside_opening, change_swing, next_swing, set_opening_distance, set_wall_length,
    stretch_opening,
};
pub use beside::{Built, Lies, WallsNear, boundary_around, draw_walls_beside, walls_beside};
pub use bridge::bridge_gaps;
pub use calibration::{
    Calibration, DrawingMoves, UNMEASURED_METRES_PER_PIXEL, move_picture, rescale, set_measurements, straightening_rad,
    turn_picture,
};
pub use close::fill_closed;
pub use copy::{Array, array, array_fitted, copy_elements, fragment, insert, insert_fitted, middle_of};
pub use dimension_length::{StretchChange, dimension_stretch, set_dimension_length};
pub use dimensions::{Settled, dimension_between, dimension_room, draw_dimension, move_dimension, settle_dimensions};
pub use dragging::{Reach, WallDrag, drag_corners, move_corners};
pub use draw::{Drawn, cut_out, cut_out_by, draw_room, draw_walls, split_room, split_room_by};
pub use facades::dimension_outside;
pub use fill::{Filled, fill_all, fill_at};
pub use free_space::{DrawnInFreeSpace, GAP_BETWEEN_ROOMS_M, draw_room_in_free_space};
pub use local::locally;
pub use merge::merge_rooms;
pub use moving::{Alignment, align, distribute, move_elements, move_picked, set_thickness, transform_elements};
pub use offset::{lines_to_offset, offset_paths, offset_room, offset_walls};
pub use openings::{
    OpeningPreview, flip_hinge, flip_side, opening_at, opening_on, opening_preview, place_opening, resize_opening,
    set_opening_kind, set_swing, slide_opening,
};
pub use picked::{Part, corners_of};
pub use rectify::{in_order, rectify_picture, unrectify_picture};
pub use refit::{Changed, Refit, Refitted};
pub use removing::{remove, removed_with, rooms_joined_by};
pub use square_up::square_up;
pub use weld::{Weld, settle, weld, weld_corners};

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

/// Places what is written in a room, its name and area, so far from the middle of the room's bounding box, in metres;
/// `None` leaves the place to the drawing code.
///
/// # Errors
/// When the room does not exist, or the text would lie outside the drawing area.
pub fn set_text_offset(plan: &Plan, id: RoomId, offset: Option<Vector>) -> Result<Plan, EditError> {
    let offset = match offset {
        Some(offset) => {
            let place = checked_position(Point::default() + offset)?;
            Some(place - Point::default())
        }
        None => None,
    };
    change_room(plan, id, |room| room.text_offset = offset)
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
