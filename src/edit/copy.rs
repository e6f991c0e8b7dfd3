//! Copying within a plan and between plans.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::dimensions::insert_chains;
use crate::edit::moving::mirror_swing;
use crate::edit::overlay::{Overlay, overlay_paths};
use crate::edit::picked::Part;
use crate::edit::refit::{Refitted, beside_each_other};
use crate::edit::split::nearest_part;
use crate::edit::{EditError, add_opening, add_room, add_wall, fail};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M, Transform, Vector, trim_m};
use crate::plan::{
    CornerId, Dimension, DimensionHost, DimensionId, ElementId, Joint, Opening, Place, Plan, Room, RoomId, ordered,
    ring_edges,
};

/// Extracts elements of a plan as a plan of their own: for the clipboard, or to insert elsewhere. Rooms come with
/// the walls along their boundaries and in them, and everything with its openings, shared ones included, see
/// [`Part`]; an opening selected without its wall becomes a free one. Openings stay pinned if both sides are
/// included or outside.
///
/// # Errors
/// When an element does not exist, or none is selected.
pub fn fragment(plan: &Plan, elements: &BTreeSet<ElementId>) -> Result<Plan, EditError> {
    let mut copied = Plan::default();
    let part = Part::of(plan, elements)?;
    for id in part.corners {
        if let Some(corner) = plan.corner(id) {
            copied.corners.insert(id, corner.clone());
        }
    }
    for id in part.walls.union(&part.shared_walls) {
        copied.walls.extend(plan.wall(*id).map(|wall| (*id, wall.clone())));
    }
    for id in &part.rooms {
        copied.rooms.extend(plan.rooms.get(id).map(|room| (*id, Arc::clone(room))));
    }
    for (id, opening) in plan.openings() {
        let comes_along = part.openings.contains(&id) || part.shared_openings.contains(&id);
        let mut opening = opening.clone();
        if !comes_along {
            if !elements.contains(&ElementId::Opening(id)) {
                continue;
            }
            let Some(Segment { a, b }) = plan.opening_segment(&opening) else { continue };
            opening.place = Place::Free { from: a.trimmed(), to: b.trimmed() };
        }
        let comes = |joint: &Joint| joint.room().is_none_or(|room| copied.rooms.contains_key(&room));
        if !opening.pinned.iter().flatten().all(comes) {
            opening.pinned = None;
        }
        copied.openings.insert(id, Arc::new(opening));
    }
    copied.dimensions.extend(chains_of(plan, &copied, elements));
    if copied.is_empty() && copied.dimensions.is_empty() {
        return fail("choose what to copy");
    }
    Ok(copied)
}

/// The dimension chains that come with a fragment: those that measure nothing else, and the picked ones, which are fixed
/// where they measure something else.
fn chains_of(plan: &Plan, copied: &Plan, elements: &BTreeSet<ElementId>) -> Vec<(DimensionId, Arc<Dimension>)> {
    let comes = |host: DimensionHost| match host {
        DimensionHost::Corner(id) => copied.corner(id).is_some(),
        DimensionHost::Wall { wall, .. } => copied.wall(wall).is_some(),
        DimensionHost::Opening { opening, .. } => copied.opening(opening).is_some(),
    };
    let chain = |(id, dimension): (DimensionId, &Dimension)| {
        let is_picked = elements.contains(&ElementId::Dimension(id));
        if !is_picked && !dimension.points.iter().all(|point| point.on.is_some_and(comes)) {
            return None;
        }
        let mut chain = dimension.clone();
        for point in &mut chain.points {
            point.last = plan.dimension_point(point).trimmed();
            point.on = point.on.filter(|&host| comes(host));
        }
        Some((id, Arc::new(chain)))
    };
    plan.dimensions().filter_map(chain).collect()
}

/// The middle of a fragment: what the pointer carries it by.
pub fn middle_of(fragment: &Plan) -> Point {
    let bounds = fragment.bounds();
    if !bounds.is_empty() {
        return bounds.center();
    }
    // Nothing but chains.
    let points = fragment.dimensions().flat_map(|(_, dimension)| &dimension.points);
    let bounds = Bounds::of(points.map(|point| fragment.dimension_point(point)));
    if bounds.is_empty() { Point::default() } else { bounds.center() }
}

/// Inserts a fragment of a plan, transformed, and returns what was added. Corners are shared with existing ones and
/// edges split as when drawing; a wall that already exists is not doubled, and is none of what was added.
/// A free opening that falls on an edge is attached to it. Ids are kept where not taken.
///
/// # Errors
/// When something falls outside the drawing area, or a room or wall would become too small.
pub fn insert(plan: &Plan, fragment: &Plan, transform: Transform) -> Result<(Plan, BTreeSet<ElementId>), EditError> {
    insert_fitted(plan, fragment, transform).map(|(plan, placed, _)| (plan, placed))
}

/// As [`insert`]; also says what became of openings that would have stood where others do.
///
/// # Errors
/// As [`insert`].
pub fn insert_fitted(
    plan: &Plan,
    fragment: &Plan,
    transform: Transform,
) -> Result<(Plan, BTreeSet<ElementId>, Vec<Refitted>), EditError> {
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
    let mut standing: BTreeSet<[CornerId; 2]> = next.walls().map(|(_, wall)| ordered(wall.from, wall.to)).collect();
    let thickness_by = if transform.keeps_lengths() { 1.0 } else { transform.factor() };
    for (_, wall) in fragment.walls() {
        let chain = chain(wall.from, wall.to);
        if chain.len() < 2 {
            return fail("a wall would get too short");
        }
        for pair in chain.windows(2) {
            if standing.insert(ordered(pair[0], pair[1])) {
                let thickness_m = (wall.thickness_m * thickness_by).min(10.0);
                let (with_wall, id) = add_wall(&next, pair[0], pair[1], thickness_m)?;
                next = with_wall;
                if let Some(added) = next.walls.get_mut(&id) {
                    added.extra.clone_from(&wall.extra);
                }
                placed.insert(ElementId::Wall(id));
            }
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
        let text_offset = room.text_offset.map(|offset| transform.vector(offset));
        let holes = room.holes.iter().map(ring).collect();
        let copy = Room { outer: ring(&room.outer), holes, text_offset, ..room.clone() };
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
        if stands_there(plan, &next, &copy) {
            continue;
        }
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
    let openings = placed.iter().filter_map(|one| if let ElementId::Opening(id) = one { Some(*id) } else { None });
    let (next, refitted) = beside_each_other(next, openings.collect::<Vec<_>>());
    placed.retain(|&element| next.has(element));
    let (next, chains) = insert_chains(next, fragment, transform)?;
    placed.extend(chains.into_iter().map(ElementId::Dimension));
    Ok((next, placed, refitted))
}

/// Openings of a kind this close together, in metres, are one.
const SAME_OPENING_M: f64 = 0.05;

/// Whether an opening of the plan is where a copy of its kind would be: a wall that two copies share has one door.
fn stands_there(before: &Plan, next: &Plan, copy: &Opening) -> bool {
    let Place::Hosted { from, to, .. } = copy.place else { return false };
    let middle = |opening: &Opening| next.opening_segment(opening).map(Segment::midpoint);
    let Some(at) = middle(copy) else { return false };
    next.openings().filter(|(id, _)| before.opening(*id).is_some()).any(|(_, other)| match other.place {
        Place::Hosted { from: p, to: q, .. } if ordered(p, q) == ordered(from, to) => {
            other.kind == copy.kind && middle(other).is_some_and(|other| other.distance(at) <= SAME_OPENING_M)
        }
        _ => false,
    })
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
    array_fitted(plan, elements, array).map(|(plan, copies, _)| (plan, copies))
}

impl Array {
    /// Where the copies go, without the original.
    ///
    /// # Errors
    /// When there would be no copies or more than 10,000.
    pub fn places(self) -> Result<Vec<Transform>, EditError> {
        let count = match self {
            Self::Grid { columns, rows, .. } => columns.saturating_mul(rows),
            Self::Polar { count, .. } => count,
        };
        if !(2..=COPIES_LIMIT).contains(&count) {
            return fail(format!("an array has between 2 and {COPIES_LIMIT} places, not {count}"));
        }
        let place = |i: usize| match self {
            Self::Grid { columns, column_step, row_step, .. } => {
                let (column, row) = (i % columns, i / columns);
                Transform::translation(column_step * column as f64 + row_step * row as f64)
            }
            Self::Polar { about, step_rad, .. } => Transform::rotation(about, step_rad * i as f64),
        };
        Ok((1..count).map(place).collect())
    }
}

/// As [`array()`]; also says what became of openings that would have stood where others do.
///
/// # Errors
/// As [`array()`].
pub fn array_fitted(
    plan: &Plan,
    elements: &BTreeSet<ElementId>,
    array: Array,
) -> Result<(Plan, BTreeSet<ElementId>, Vec<Refitted>), EditError> {
    let places = array.places()?;
    let fragment = fragment(plan, elements)?;
    let mut next = plan.clone();
    let mut copies = BTreeSet::new();
    let mut refitted = Vec::new();
    for transform in places {
        let (with_copy, placed, fitted) = insert_fitted(&next, &fragment, transform)?;
        next = with_copy;
        copies.extend(placed);
        refitted.extend(fitted);
    }
    // Splitting removes nothing, but walls of the original may be among those met again.
    copies.retain(|element| !elements.contains(element));
    copies.retain(|&element| next.has(element));
    Ok((next, copies, refitted))
}
