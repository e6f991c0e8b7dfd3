//! Copying within a plan and between plans.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::moving::{corners_of, mirror_swing};
use crate::edit::overlay::{Overlay, overlay_paths};
use crate::edit::split::nearest_part;
use crate::edit::{EditError, add_opening, add_room, add_wall, fail};
use crate::geometry::{Point, Segment, TOUCH_M, Transform, Vector, trim_m};
use crate::plan::{
    CornerId, ElementId, Joint, Opening, OpeningId, Place, Plan, Room, RoomId, WallId, ordered, ring_edges,
};

/// Extracts elements of a plan as a plan of their own: for the clipboard, or to insert elsewhere.
/// Openings on the edges of selected walls and rooms are included; an opening selected without its wall
/// becomes a free one. Openings stay pinned if both sides are included or outside.
///
/// # Errors
/// When an element does not exist, or none is selected.
pub fn fragment(plan: &Plan, elements: &BTreeSet<ElementId>) -> Result<Plan, EditError> {
    let mut part = Plan::default();
    for id in corners_of(plan, elements)? {
        if let Some(corner) = plan.corner(id) {
            part.corners.insert(id, corner.clone());
        }
    }
    for element in elements {
        match element {
            ElementId::Wall(id) => part.walls.extend(plan.wall(*id).map(|wall| (*id, wall.clone()))),
            ElementId::Room(id) => part.rooms.extend(plan.rooms.get(id).map(|room| (*id, Arc::clone(room)))),
            ElementId::Corner(_) | ElementId::Opening(_) | ElementId::Dimension(_) => {}
        }
    }
    let edges: BTreeSet<[CornerId; 2]> = crate::edit::overlay::plan_edges(&part).map(|(a, b)| ordered(a, b)).collect();
    for (id, opening) in plan.openings() {
        let chosen = elements.contains(&ElementId::Opening(id));
        let mut opening = opening.clone();
        match opening.place {
            Place::Hosted { from, to, .. } if edges.contains(&ordered(from, to)) => {}
            Place::Free { .. } if chosen => {}
            Place::Hosted { .. } if chosen => {
                let Some(Segment { a, b }) = plan.opening_segment(&opening) else { continue };
                opening.place = Place::Free { from: a.trimmed(), to: b.trimmed() };
            }
            _ => continue,
        }
        let comes = |joint: &Joint| joint.room().is_none_or(|room| part.rooms.contains_key(&room));
        if !opening.pinned.iter().flatten().all(comes) {
            opening.pinned = None;
        }
        part.openings.insert(id, Arc::new(opening));
    }
    if part.is_empty() {
        return fail("choose what to copy");
    }
    Ok(part)
}

/// Inserts a fragment of a plan, transformed, and returns its elements in the new plan. Corners are
/// shared with existing ones and edges split as when drawing; a wall that already exists is not doubled.
/// A free opening that falls on an edge is attached to it. Ids are kept where not taken.
///
/// # Errors
/// When something falls outside the drawing area, or a room or wall would become too small.
pub fn insert(plan: &Plan, fragment: &Plan, transform: Transform) -> Result<(Plan, BTreeSet<ElementId>), EditError> {
    let place = |id: CornerId| fragment.position(id).map(|point| transform.point(point));
    // Each edge is overlaid once, from its smaller corner to its larger.
    let edges: BTreeSet<[CornerId; 2]> =
        crate::edit::overlay::plan_edges(fragment).map(|(a, b)| ordered(a, b)).collect();
    let mut paths: Vec<Vec<Point>> =
        edges.iter().map(|&[a, b]| [a, b].into_iter().filter_map(place).collect()).collect();
    let loose: BTreeSet<CornerId> = fragment.corners().map(|(id, _)| id).collect();
    let at_edges: BTreeSet<CornerId> = edges.iter().flatten().copied().collect();
    let loose: Vec<CornerId> = loose.difference(&at_edges).copied().collect();
    paths.extend(loose.iter().filter_map(|&id| Some(vec![place(id)?])));
    let Overlay { plan: mut next, chains } = overlay_paths(plan, &paths)?;
    let (edge_chains, loose_chains) = chains.split_at(edges.len());
    let mut placed: BTreeSet<ElementId> = loose_chains.iter().flatten().map(|&id| ElementId::Corner(id)).collect();
    let chain_of: BTreeMap<[CornerId; 2], &Vec<CornerId>> = edges.iter().copied().zip(edge_chains).collect();
    let chain = |a: CornerId, b: CornerId| -> Vec<CornerId> {
        let chain = chain_of.get(&ordered(a, b)).map(|chain| (*chain).clone()).unwrap_or_default();
        if a < b { chain } else { chain.into_iter().rev().collect() }
    };
    let mut standing: BTreeMap<[CornerId; 2], WallId> =
        next.walls().map(|(id, wall)| (ordered(wall.from, wall.to), id)).collect();
    let thickness_by = if transform.keeps_lengths() { 1.0 } else { transform.factor() };
    for (_, wall) in fragment.walls() {
        let chain = chain(wall.from, wall.to);
        if chain.len() < 2 {
            return fail("a wall would get too short");
        }
        for pair in chain.windows(2) {
            let id = match standing.get(&ordered(pair[0], pair[1])) {
                Some(&id) => id,
                None => {
                    let thickness_m = (wall.thickness_m * thickness_by).min(10.0);
                    let (with_wall, id) = add_wall(&next, pair[0], pair[1], thickness_m)?;
                    next = with_wall;
                    if let Some(added) = next.walls.get_mut(&id) {
                        added.extra.clone_from(&wall.extra);
                    }
                    standing.insert(ordered(pair[0], pair[1]), id);
                    id
                }
            };
            placed.insert(ElementId::Wall(id));
        }
    }
    let mut room_of: BTreeMap<RoomId, RoomId> = BTreeMap::new();
    for (id, room) in fragment.rooms() {
        let ring = |ring: &Arc<[CornerId]>| -> Arc<[CornerId]> {
            let mut corners: Vec<CornerId> = Vec::new();
            for (a, b) in ring_edges(ring) {
                corners.extend(chain(a, b));
                corners.dedup();
            }
            if corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            corners.into()
        };
        let copy = Room { outer: ring(&room.outer), holes: room.holes.iter().map(ring).collect(), ..room.clone() };
        let new_id = if room.has_boundary() {
            let (with_room, new_id) = add_room(&next, copy)?;
            next = with_room;
            new_id
        } else {
            let new_id = RoomId::derive(&[id.bits()], |id| next.rooms.contains_key(&id));
            next.rooms.insert(new_id, Arc::new(copy));
            new_id
        };
        let kept = if next.rooms.contains_key(&id) { new_id } else { id };
        if kept != new_id
            && let Some(room) = next.rooms.remove(&new_id)
        {
            next.rooms.insert(kept, room);
        }
        room_of.insert(id, kept);
        placed.insert(ElementId::Room(kept));
    }
    for (id, opening) in fragment.openings() {
        let mut copy = opening.clone();
        copy.place = opening_place(fragment, &next, opening, transform, chain)?;
        mirror_swing(&mut copy, transform);
        let room =
            |joint: Joint| joint.room().and_then(|room| room_of.get(&room)).map_or(Joint::Outside, |&r| Joint::Room(r));
        copy.pinned = opening.pinned.map(|sides| sides.map(room));
        let (with_opening, new_id) = add_opening(&next, copy)?;
        next = with_opening;
        let kept = if next.openings.contains_key(&id) { new_id } else { id };
        if kept != new_id
            && let Some(opening) = next.openings.remove(&new_id)
        {
            next.openings.insert(kept, opening);
        }
        placed.insert(ElementId::Opening(kept));
    }
    Ok((next, placed))
}

/// Where an opening of a fragment goes in the plan that now has its edges.
fn opening_place(
    fragment: &Plan,
    next: &Plan,
    opening: &Opening,
    transform: Transform,
    chain: impl Fn(CornerId, CornerId) -> Vec<CornerId>,
) -> Result<Place, EditError> {
    let Some(segment) = fragment.opening_segment(opening) else { return fail("an opening's wall has no length") };
    let (a, b) = (transform.point(segment.a), transform.point(segment.b));
    let width_m = trim_m(a.distance(b));
    if let Place::Hosted { from, to, width_m: given_m, .. } = opening.place {
        let chain = chain(from, to);
        let width_m = if transform.keeps_lengths() { given_m } else { width_m };
        return match nearest_part(next, &chain, a.midpoint(b), width_m) {
            Some(place) => Ok(place),
            None => fail("an opening's wall would get too short"),
        };
    }
    let on_edge = crate::edit::overlay::plan_edges(next).find(|&(from, to)| {
        let edge = next.position(from).zip(next.position(to)).map(|(a, b)| Segment::new(a, b));
        edge.is_some_and(|edge| edge.length() > TOUCH_M && edge.distance(a) <= TOUCH_M && edge.distance(b) <= TOUCH_M)
    });
    if let Some((from, to)) = on_edge
        && let (Some(start), Some(end)) = (next.position(from), next.position(to))
    {
        // In the opening's own direction, to keep its swing.
        let (from, to) = if (end - start).dot(b - a) >= 0.0 { (from, to) } else { (to, from) };
        if let Some(place) = nearest_part(next, &[from, to], a.midpoint(b), width_m) {
            return Ok(place);
        }
    }
    Ok(Place::Free { from: a.trimmed(), to: b.trimmed() })
}

/// Copies elements within a plan: [`fragment`], then [`insert`].
///
/// # Errors
/// As for these two.
pub fn copy_elements(
    plan: &Plan,
    elements: &BTreeSet<ElementId>,
    transform: Transform,
) -> Result<(Plan, BTreeSet<ElementId>), EditError> {
    insert(plan, &fragment(plan, elements)?, transform)
}

/// The arrangement of copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Array {
    /// In columns and rows, including the original.
    Grid { columns: usize, rows: usize, column_step: Vector, row_step: Vector },
    /// Around a point: `count` elements including the original, each rotated counter-clockwise from the
    /// previous one.
    Polar { about: Point, count: usize, step_rad: f64 },
}

/// More copies than this at once must be a mistake.
const COPIES_LIMIT: usize = 10_000;

/// Copies elements into an array and returns all copies, without the originals.
///
/// # Errors
/// As [`copy_elements`], and when there would be no copies or more than 10,000.
pub fn array(
    plan: &Plan,
    elements: &BTreeSet<ElementId>,
    array: Array,
) -> Result<(Plan, BTreeSet<ElementId>), EditError> {
    let count = match array {
        Array::Grid { columns, rows, .. } => columns.saturating_mul(rows),
        Array::Polar { count, .. } => count,
    };
    if !(2..=COPIES_LIMIT).contains(&count) {
        return fail(format!("an array has between 2 and {COPIES_LIMIT} places, not {count}"));
    }
    let fragment = fragment(plan, elements)?;
    let mut next = plan.clone();
    let mut copies = BTreeSet::new();
    for i in 1..count {
        let transform = match array {
            Array::Grid { columns, column_step, row_step, .. } => {
                let (column, row) = (i % columns, i / columns);
                Transform::translation(column_step * column as f64 + row_step * row as f64)
            }
            Array::Polar { about, step_rad, .. } => Transform::rotation(about, step_rad * i as f64),
        };
        let (with_copy, placed) = insert(&next, &fragment, transform)?;
        next = with_copy;
        copies.extend(placed);
    }
    // Splitting removes nothing, but walls of the original may be among those met again.
    copies.retain(|element| !elements.contains(element));
    let exists = |id: &OpeningId| next.opening(*id).is_some();
    copies.retain(|element| if let ElementId::Opening(id) = element { exists(id) } else { true });
    Ok((next, copies))
}
