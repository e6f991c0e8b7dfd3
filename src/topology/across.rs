//! Edits of whichever rooms lie at a place.

use super::{RoomShapes, split_room};
use crate::geometry::{Bounds, Point, polygon};
use crate::plan::edit::EditError;
use crate::plan::{Plan, RoomId};

/// Divides every room that a path crosses from boundary to boundary, without walls; see [`split_room`].
/// Gives the plan and the new rooms.
///
/// # Errors
/// When it crosses none.
pub fn split_rooms(plan: &Plan, path: &[Point]) -> Result<(Plan, Vec<RoomId>), EditError> {
    let shapes = RoomShapes::new(plan);
    let near = shapes.near(Bounds::of(path.iter().copied()));
    let (mut next, mut made) = (plan.clone(), Vec::new());
    let mut reason = EditError("the line crosses no room from boundary to boundary".to_owned());
    for index in near {
        match split_room(&next, shapes.all()[index].id, path) {
            Ok((divided, rooms)) => {
                next = divided;
                made.extend(rooms);
            }
            Err(error) => reason = error,
        }
    }
    if made.is_empty() { Err(reason) } else { Ok((next, made)) }
}

/// The smallest room around the middle of an area.
///
/// # Errors
/// When there is none.
pub fn room_around(plan: &Plan, area: &[Point]) -> Result<RoomId, EditError> {
    let shapes = RoomShapes::new(plan);
    let found = shapes.at(polygon::centroid(area)).first().map(|&index| shapes.all()[index].id);
    found.ok_or_else(|| EditError("no room is there".to_owned()))
}
