//! Edits of the rooms at a given place.

use crate::edit::{EditError, split_room_by};
use crate::geometry::{
    Bounds, Point, Segment, TOUCH_M,
    polygon::{self, Location},
};
use crate::plan::{Plan, RoomId};
use crate::topology::{RoomShape, RoomShapes};

/// Splits every room that a path crosses from boundary to boundary; with a thickness in metres, by walls. See
/// [`split_room_by`]. Returns the plan and the new rooms.
///
/// # Errors
/// When it crosses no room, or the thickness is not within 0..=10 m.
pub fn split_rooms(
    plan: &Plan,
    path: &[Point],
    wall_thickness_m: Option<f64>,
) -> Result<(Plan, Vec<RoomId>), EditError> {
    let shapes = RoomShapes::new(plan);
    let near = shapes.near(Bounds::of(path.iter().copied()));
    let (mut next, mut made) = (plan.clone(), Vec::new());
    let mut reason = EditError("the line crosses no room from boundary to boundary".to_owned());
    for index in near {
        match split_room_by(&next, shapes.all()[index].id, path, wall_thickness_m) {
            Ok((divided, rooms)) => {
                next = divided;
                made.extend(rooms);
            }
            Err(error) => reason = error,
        }
    }
    if made.is_empty() { Err(reason) } else { Ok((next, made)) }
}

/// A line straight across a room, see [`straight_across`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Across {
    pub room: RoomId,
    /// From boundary to boundary, in metres.
    pub line: Segment,
    /// The areas of the two parts in m², the one left of the line first; `None` if the line ends at a
    /// hole and splits nothing.
    pub areas_m2: Option<[f64; 2]>,
}

/// The line straight across a room for a pointer at or inside its boundary: perpendicular to the piece of
/// boundary nearest to `pointer`, through the snapped point `through`, from boundary to boundary.
///
/// The room is the smallest one around the pointer or, if there is none, the one with the nearest
/// boundary within `reach_m`.
pub fn straight_across(shapes: &RoomShapes, pointer: Point, through: Point, reach_m: f64) -> Option<Across> {
    let edges = |shape: &RoomShape| -> Vec<Segment> {
        let all = shape.rings().flat_map(|ring| polygon::edges(ring)).filter(|edge| edge.length() > TOUCH_M);
        all.collect()
    };
    let distance =
        |shape: &RoomShape| edges(shape).into_iter().map(|edge| edge.distance(pointer)).fold(f64::INFINITY, f64::min);
    let around = shapes.at(pointer).into_iter().map(|index| &shapes.all()[index]).next();
    let near = || {
        let near = shapes.near(Bounds::of([pointer]).inflated(reach_m)).into_iter().map(|index| &shapes.all()[index]);
        let near = near.map(|shape| (distance(shape), shape)).filter(|(distance_m, _)| *distance_m <= reach_m);
        near.min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, shape)| shape)
    };
    let shape = around.or_else(near)?;
    let nearest = edges(shape).into_iter().min_by(|p, q| p.distance(pointer).total_cmp(&q.distance(pointer)))?;
    let way = nearest.vector().left().unit()?;
    // A line from outside through the whole room; of its stretches inside, take the one at the pointer.
    let bounds = shape.bounds.union(Bounds::of([through]));
    let reach_m = bounds.width() + bounds.height() + 1.0;
    let origin = through + way * -reach_m;
    let at_m = (pointer - origin).dot(way);
    let off = |&(from_m, to_m): &(f64, f64)| (from_m - at_m).max(at_m - to_m).max(0.0);
    let stretches = shape.stretches(origin, way, 2.0 * reach_m);
    let (from_m, to_m) = stretches.into_iter().min_by(|p, q| off(p).total_cmp(&off(q)))?;
    let line = Segment::new((origin + way * from_m).trimmed(), (origin + way * to_m).trimmed());
    if line.length() <= TOUCH_M || shape.locate(line.midpoint()) != Location::Inside {
        return None;
    }
    Some(Across { room: shape.id, line, areas_m2: areas_of_parts(shape, line) })
}

/// The areas of the parts of a room left and right of a line between two points of its outer ring.
fn areas_of_parts(shape: &RoomShape, line: Segment) -> Option<[f64; 2]> {
    let ring = &shape.outer;
    // The edge an end lies on, counted from the start of the ring.
    let edge_at = |point: Point| {
        let near = polygon::edges(ring).enumerate().map(|(i, edge)| (edge.distance(point), i));
        near.min_by(|p, q| p.0.total_cmp(&q.0)).filter(|(distance_m, _)| *distance_m <= TOUCH_M).map(|(_, i)| i)
    };
    let (from, to) = (edge_at(line.a)?, edge_at(line.b)?);
    let part = |(from, start): (usize, Point), (to, end): (usize, Point)| {
        let steps = (to + ring.len() - from) % ring.len();
        let mut part = vec![start];
        part.extend((1..=steps).map(|step| ring[(from + step) % ring.len()]));
        part.push(end);
        part
    };
    let parts = [part((to, line.b), (from, line.a)), part((from, line.a), (to, line.b))];
    let areas = parts.map(|part| {
        let holes = shape.holes.iter().filter(|hole| {
            hole.first().is_some_and(|&corner| polygon::locate_in_ring(&part, corner) == Location::Inside)
        });
        polygon::signed_area(&part).abs() - holes.map(|hole| polygon::signed_area(hole).abs()).sum::<f64>()
    });
    // On a clockwise ring the first part is on the right.
    Some(if polygon::signed_area(ring) < 0.0 { [areas[1], areas[0]] } else { areas })
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
