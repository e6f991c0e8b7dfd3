//! Merging rooms.

use std::collections::BTreeSet;
use std::sync::Arc;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;

use crate::edit::draw::{Inside, without_leftovers};
use crate::edit::free_space::{OverlayArea, oriented, overlay_area};
use crate::edit::heal::healed;
use crate::edit::{self, EditError, fail};
use crate::geometry::areas::{self, Ring, Shapes};
use crate::geometry::runs::NOTCH_M;
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Point, Segment, TOUCH_M, polygon};
use crate::plan::{CornerId, ElementId, Joint, OpeningId, Plan, Room, RoomId, THICKEST_WALL_M, WallId};
use crate::topology::plan_faces::is_sliver;
use crate::topology::{RoomShape, RoomShapes, sides_by_geometry};

/// Merges rooms that touch along an edge or across at most the thickest wall ([`THICKEST_WALL_M`]); the
/// gap between them becomes part of the result. The largest room remains: it keeps its identity, name,
/// function, label and note; those of the others are lost.
///
/// The walls between the rooms are removed, with the openings on them and all openings that join two of
/// the rooms. Walls inside one of the rooms stay. Openings pinned to one of the rooms are pinned to the
/// remaining one.
///
/// # Errors
/// When there are fewer than two, one does not exist or has no boundary, or they do not all touch.
pub fn merge_rooms(plan: &Plan, rooms: &[RoomId]) -> Result<Plan, EditError> {
    let merged: BTreeSet<RoomId> = rooms.iter().copied().collect();
    for &id in &merged {
        edit::require_room(plan, id)?;
    }
    let shapes = RoomShapes::new(plan);
    let parts: Vec<&RoomShape> = merged.iter().filter_map(|&id| shapes.get(id)).collect();
    let Some(largest) = parts.iter().copied().max_by(|p, q| p.area_m2().total_cmp(&q.area_m2())) else {
        return fail("choose two rooms or more to merge");
    };
    if parts.len() < 2 {
        return fail("choose two rooms or more to merge");
    }
    if parts.iter().any(|part| part.outer.is_empty()) {
        return fail("a room without a boundary cannot be merged");
    }
    let others: Vec<Ring> = parts
        .iter()
        .flat_map(|part| shapes.near(part.bounds.inflated(THICKEST_WALL_M)))
        .collect::<BTreeSet<usize>>()
        .into_iter()
        .map(|index| &shapes.all()[index])
        .filter(|other| !merged.contains(&other.id))
        .flat_map(oriented)
        .collect();
    let pieces = areas::pieces(&union(&parts, &others));
    let mut pieces = pieces.into_iter().filter(|(outer, holes)| !is_sliver(outer, holes));
    let (Some((outer, holes)), None) = (pieces.next(), pieces.next()) else {
        return fail(format!("the rooms must touch, or lie no further apart than {THICKEST_WALL_M} m"));
    };
    let OverlayArea { plan: overlaid, boundary, mut corners } = overlay_area(plan, &outer, &holes)?;
    // To remove: openings between the rooms, then walls between them and the openings on these.
    let joins_merged = |side: &Joint| side.room().is_some_and(|room| merged.contains(&room));
    let between: BTreeSet<OpeningId> = plan
        .openings()
        .filter(|(_, opening)| {
            let sides = opening.pinned.unwrap_or_else(|| sides_by_geometry(plan, &shapes, opening));
            sides.iter().all(joins_merged) && sides[0] != sides[1]
        })
        .map(|(id, _)| id)
        .collect();
    let was_inside: Vec<Inside> =
        parts.iter().filter_map(|part| Some(Inside::new(plan, plan.room(part.id)?))).collect();
    let mut next = edit::change_room(&overlaid, largest.id, |room| {
        room.outer = boundary.outer;
        room.holes = boundary.holes;
    })?;
    for id in merged.iter().copied().filter(|&id| id != largest.id) {
        if let Some(room) = next.rooms.remove(&id) {
            corners.extend(room.rings().flat_map(|ring| ring.iter().copied()));
        }
    }
    let Some(room) = next.room(largest.id) else { return Ok(next) };
    let now = Inside::new(&next, room);
    // Rounding does not put a wall along the boundary between the rooms.
    let boundary: Vec<Segment> =
        room.rings().flat_map(|ring| polygon::edges(&next.ring_points(ring)).collect::<Vec<_>>()).collect();
    let is_along = |at: Point| boundary.iter().any(|edge| edge.distance(at) <= 2.0 * TOUCH_M);
    // All of a wall, not just its middle: one that is partly inside a room stays.
    let is_between = |from: CornerId, to: CornerId| {
        let goes = |at: Point| now.holds(at) && !is_along(at) && !was_inside.iter().any(|inside| inside.holds(at));
        let ends = next.position(from).zip(next.position(to));
        ends.is_some_and(|(a, b)| [0.25, 0.5, 0.75].iter().all(|&share| goes(a.lerp(b, share))))
    };
    let walls: Vec<WallId> =
        next.walls().filter(|(_, wall)| is_between(wall.from, wall.to)).map(|(id, _)| id).collect();
    let mut gone: Vec<ElementId> = walls.into_iter().map(ElementId::Wall).collect();
    gone.extend(between.into_iter().map(ElementId::Opening));
    next = edit::remove(&next, &gone)?;
    corners.extend(parts.iter().filter_map(|part| plan.room(part.id)).flat_map(Room::rings).flat_map(|r| r.to_vec()));
    let next = without_leftovers(plan, &repinned(&next, &merged, largest.id), corners.iter().copied());
    Ok(healed(next, corners))
}

/// Pins what was pinned to merged rooms to the remaining one.
fn repinned(plan: &Plan, merged: &BTreeSet<RoomId>, stays: RoomId) -> Plan {
    let is_gone = |joint: &Joint| joint.room().is_some_and(|room| room != stays && merged.contains(&room));
    let pinned = plan.openings().filter(|(_, opening)| opening.pinned.iter().flatten().any(is_gone));
    let ids: Vec<OpeningId> = pinned.map(|(id, _)| id).collect();
    let mut next = plan.clone();
    for id in ids {
        let Some(shared) = next.openings.get_mut(&id) else { continue };
        for joint in Arc::make_mut(shared).pinned.iter_mut().flatten().filter(|joint| is_gone(joint)) {
            *joint = Joint::Room(stays);
        }
    }
    next
}

/// The union of rooms and the gaps between them, minus what other rooms cover of the gaps.
fn union(rooms: &[&RoomShape], others: &[Ring]) -> Shapes {
    let rings: Vec<Ring> = rooms.iter().flat_map(|room| oriented(room)).collect();
    let rooms_alone: Shapes = rings.simplify_shape(FillRule::NonZero);
    // Morphological closing (grow, then shrink back) fills gaps narrower than twice the distance.
    let reach_m = THICKEST_WALL_M / 2.0 + TOUCH_M;
    let closed = areas::offset(&areas::offset(&areas::without_slivers(&rooms_alone), reach_m), -reach_m);
    let added = areas::without(closed.overlay(&rooms_alone, OverlayRule::Difference, FillRule::NonZero), others);
    let edges: Vec<SegmentIndex> = rooms
        .iter()
        .map(|room| SegmentIndex::new(room.rings().flat_map(|ring| polygon::edges(ring)).collect()))
        .collect();
    // Filled parts that touch two rooms lie between them; others are niches of one room.
    let touches = |outer: &[Point], edges: &SegmentIndex| {
        polygon::edges(outer).any(|edge| {
            let middle = edge.midpoint();
            edges.near(edge.bounds().inflated(NOTCH_M)).any(|index| {
                edges.get(index).distance(middle) <= TOUCH_M || edge.distance(edges.get(index).midpoint()) <= TOUCH_M
            })
        })
    };
    let mut all = rings;
    for (outer, holes) in areas::pieces(&added) {
        if edges.iter().filter(|edges| touches(&outer, edges)).count() > 1 {
            all.push(areas::directed(&outer, true));
            all.extend(holes.iter().map(|hole| areas::directed(hole, false)));
        }
    }
    // Closes hairlines that rounding leaves between pieces, within the touching distance.
    let joined: Shapes = all.simplify_shape(FillRule::NonZero);
    areas::offset(&areas::offset(&joined, TOUCH_M), -TOUCH_M)
}
