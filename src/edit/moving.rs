//! Moving, rotating, mirroring, scaling and arranging elements.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::dragging::{Reach, WallDrag, drag_corners};
use crate::edit::heal::healed;
use crate::edit::picked::{Part, corners_of};
use crate::edit::refit::{Changed, beside_each_other};
use crate::edit::weld::settle;
use crate::edit::{EditError, checked_position, fail};
use crate::geometry::{Bounds, Point, TOUCH_M, Transform, Vector, trim_m};
use crate::plan::{CornerId, ElementId, OpeningId, Place, Plan, Room, WallId, ring_edges};

/// Moves, turns, mirrors or scales elements, and nothing else: as [`transform_elements`], with walls.
///
/// # Errors
/// As [`transform_elements`].
pub fn move_elements(plan: &Plan, elements: &BTreeSet<ElementId>, transform: Transform) -> Result<Plan, EditError> {
    transform_elements(plan, elements, transform, true).map(|changed| changed.plan)
}

/// Moves, turns, mirrors or scales elements, and nothing else. Rooms take their walls and openings along, see
/// [`Part`]; corners that something else uses stay with that, and so do walls that bound another room: the moved
/// part gets its own corners and, with `own_walls`, its own walls. What comes to rest on something else shares its
/// corners; what is left behind loses the corners that it only had for the sake of what went. An opening selected
/// without its wall slides along it; where only corners are selected, what shares them follows.
///
/// Mirrored doors still open into the same room. Scaling applies to the positions and widths of openings
/// on scaled edges, and to the thickness of walls.
///
/// # Errors
/// When an element does not exist, a wall bounds rooms that are not among the elements, a target lies outside the
/// drawing area, or something would get too small or too large.
pub fn transform_elements(
    plan: &Plan,
    elements: &BTreeSet<ElementId>,
    transform: Transform,
    own_walls: bool,
) -> Result<Changed, EditError> {
    let part = Part::of(plan, elements)?;
    let to = |point: Point| checked_position(transform.point(point));
    if part.rooms.is_empty() && part.walls.is_empty() && !part.corners.is_empty() {
        let targets: Vec<(CornerId, Point)> =
            part.corners.iter().filter_map(|&id| Some((id, transform.point(plan.position(id)?)))).collect();
        return drag_corners(plan, &targets);
    }
    let stays = |&id: &CornerId| plan.position(id).is_none_or(|at| transform.point(at).trimmed() == at);
    let alone: Vec<OpeningId> = elements
        .iter()
        .filter_map(|element| if let ElementId::Opening(id) = element { Some(*id) } else { None })
        .filter(|id| !part.openings.contains(id))
        .collect();
    if part.corners.iter().all(stays) && part.openings.is_empty() && alone.is_empty() {
        return Ok(Changed::plainly(with_dimensions(plan, plan.clone(), elements, transform)?));
    }
    part.check_takes_no_boundary(plan)?;
    let mut carried = elements.clone();
    carried.extend(super::dimensions::chains_on(plan, &part).into_iter().map(ElementId::Dimension));
    let (mut next, part, left) = part.detached(plan, own_walls)?;
    for &id in &part.corners {
        if let Some(corner) = next.corners.get_mut(&id) {
            corner.position = to(corner.position)?;
        }
    }
    for id in &part.rooms {
        if let Some(shared) = next.rooms.get_mut(id)
            && let Some(offset) = shared.text_offset
            && transform.vector(offset) != offset
        {
            let offset = (Point::default() + transform.vector(offset)).trimmed() - Point::default();
            Arc::make_mut(shared).text_offset = Some(offset);
        }
    }
    let factor = transform.factor();
    for &id in &part.openings {
        let Some(opening) = plan.opening(id) else { continue };
        let Some(shared) = next.openings.get_mut(&id) else { continue };
        match shared.place {
            Place::Hosted { from, to, at_m, width_m } => {
                let ends = next.corners.get(&from).zip(next.corners.get(&to));
                let length_m = ends.map_or(0.0, |(a, b)| a.position.distance(b.position));
                if length_m <= 0.0 {
                    return fail(format!("the wall of a {} would lose its length", opening.kind.name()));
                }
                if transform.keeps_lengths() && !transform.mirrors() {
                    // Rounding may shorten the edge.
                    if at_m > length_m {
                        let at_m = trim_m(length_m);
                        Arc::make_mut(shared).place = Place::Hosted { from, to, at_m, width_m };
                    }
                    continue;
                }
                let (at_m, width_m) = (trim_m((at_m * factor).min(length_m)), trim_m(width_m * factor));
                if !(width_m > 0.0 && width_m <= 1000.0) {
                    return fail("an opening would get too small or too large");
                }
                let opening = Arc::make_mut(shared);
                opening.place = Place::Hosted { from, to, at_m, width_m };
                mirror_swing(opening, transform);
            }
            Place::Free { from, to: end } => {
                let (from, end) = (to(from)?, to(end)?);
                if from == end {
                    return fail("an opening would lose its width");
                }
                let opening = Arc::make_mut(shared);
                opening.place = Place::Free { from, to: end };
                mirror_swing(opening, transform);
            }
        }
    }
    if !transform.keeps_lengths() {
        for id in &part.walls {
            if let Some(wall) = next.walls.get_mut(id) {
                wall.thickness_m = trim_m((wall.thickness_m * factor).min(10.0));
            }
        }
    }
    if transform.mirrors() {
        next = super::dimensions::on_other_sides(next, &part.walls);
    }
    check_keeps_edges(plan, &next, &part)?;
    let next = settle(&next, &part.corners).map_err(|_| EditError("a room would get too small".to_owned()))?;
    let mut next = healed(next, left);
    for id in alone {
        if let Some(segment) = plan.opening(id).and_then(|opening| plan.opening_segment(opening)) {
            next = super::slide_opening(&next, id, transform.point(segment.midpoint()))?;
        }
    }
    let (next, refitted) = beside_each_other(next, part.openings.iter().copied());
    Ok(Changed { plan: with_dimensions(plan, next, &carried, transform)?, refitted })
}

/// The plan with the dimension chains among the elements moved along.
fn with_dimensions(
    before: &Plan,
    after: Plan,
    elements: &BTreeSet<ElementId>,
    transform: Transform,
) -> Result<Plan, EditError> {
    let mut chains =
        elements.iter().filter_map(|element| if let ElementId::Dimension(id) = element { Some(*id) } else { None });
    chains.try_fold(after, |after, id| super::dimensions::transformed(before, &after, id, transform))
}

/// Rejects a scaling that leaves an edge without length.
fn check_keeps_edges(before: &Plan, after: &Plan, part: &Part) -> Result<(), EditError> {
    let rings = part.rooms.iter().filter_map(|id| after.room(*id)).flat_map(Room::rings);
    let edges = rings.flat_map(|ring| ring_edges(ring));
    let walls = part.walls.iter().filter_map(|id| after.wall(*id)).map(|wall| (wall.from, wall.to));
    let has_none = |(a, b): (CornerId, CornerId)| {
        let ends = after.position(a).zip(after.position(b));
        ends.is_some_and(|(p, q)| p.distance(q) <= TOUCH_M)
    };
    let had_none = before.walls().any(|(_, wall)| before.wall_segment(wall).is_some_and(|it| it.length() <= TOUCH_M));
    match edges.chain(walls).any(has_none) && !had_none {
        true => fail("a wall would be left without length"),
        false => Ok(()),
    }
}

/// Moves elements by a way. Rooms move alone, as by [`transform_elements`]; where only walls and corners are
/// selected this is a drag, and what shares them follows, see [`WallDrag`].
///
/// # Errors
/// As for these two.
pub fn move_picked(
    plan: &Plan,
    elements: &BTreeSet<ElementId>,
    by: Vector,
    reach: Reach,
    own_walls: bool,
) -> Result<Changed, EditError> {
    let (mut walls, mut corners, mut is_drag) = (BTreeSet::new(), BTreeSet::new(), false);
    for element in elements {
        match element {
            ElementId::Wall(id) if plan.wall(*id).is_some() => drop(walls.insert(*id)),
            ElementId::Corner(id) if plan.corner(*id).is_some() => drop(corners.insert(*id)),
            ElementId::Room(_) => return transform_elements(plan, elements, Transform::translation(by), own_walls),
            ElementId::Opening(id) if plan.opening(*id).is_some() => continue,
            ElementId::Dimension(id) if plan.dimension(*id).is_some() => continue,
            gone => return fail(format!("{gone} does not exist")),
        }
        is_drag = true;
    }
    match WallDrag::new(plan, &walls, &corners, reach).filter(|_| is_drag) {
        Some(drag) => {
            let Changed { plan: next, refitted } = drag.apply(plan, by)?;
            Ok(Changed { plan: with_dimensions(plan, next, elements, Transform::translation(by))?, refitted })
        }
        None => transform_elements(plan, elements, Transform::translation(by), own_walls),
    }
}

/// A mirrored door opens to the other side of its segment, whose ends keep their order.
pub(crate) fn mirror_swing(opening: &mut crate::plan::Opening, transform: Transform) {
    if transform.mirrors()
        && let Some(swing) = &mut opening.swing
    {
        swing.side = swing.side.other();
    }
}

/// Sets the thickness of walls in metres.
///
/// # Errors
/// When a wall does not exist, or the thickness is not within 0..=10 m.
pub fn set_thickness(plan: &Plan, walls: &[WallId], thickness_m: f64) -> Result<Plan, EditError> {
    super::check_thickness(thickness_m)?;
    let mut next = plan.clone();
    for id in walls {
        match next.walls.get_mut(id) {
            Some(wall) => wall.thickness_m = trim_m(thickness_m),
            None => return fail(format!("{id} does not exist")),
        }
    }
    Ok(next)
}

/// Which sides or middles of elements are aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// Left sides, at the leftmost.
    Left,
    /// Right sides, at the rightmost.
    Right,
    /// Upper sides, at the highest.
    Top,
    /// Lower sides, at the lowest.
    Bottom,
    /// Middles on a vertical line, that of the box around all.
    Center,
    /// Middles on a horizontal line, that of the box around all.
    Middle,
}

/// Aligns elements. Elements that share corners move as one; a corner selected alone is aligned by
/// itself.
///
/// # Errors
/// When an element does not exist, or there are fewer than two things to align.
pub fn align(plan: &Plan, elements: &BTreeSet<ElementId>, alignment: Alignment) -> Result<Plan, EditError> {
    let groups = groups(plan, elements)?;
    if groups.len() < 2 {
        return fail("choose two things or more that share no corner");
    }
    let all = groups.iter().fold(Bounds::EMPTY, |all, group| all.union(group.bounds));
    let by = |bounds: Bounds| match alignment {
        Alignment::Left => Vector::new(all.min.x - bounds.min.x, 0.0),
        Alignment::Right => Vector::new(all.max.x - bounds.max.x, 0.0),
        Alignment::Top => Vector::new(0.0, all.max.y - bounds.max.y),
        Alignment::Bottom => Vector::new(0.0, all.min.y - bounds.min.y),
        Alignment::Center => Vector::new(all.center().x - bounds.center().x, 0.0),
        Alignment::Middle => Vector::new(0.0, all.center().y - bounds.center().y),
    };
    let moves = groups.iter().map(|group| (group, by(group.bounds)));
    moved(plan, moves)
}

/// Spaces elements so that their middles are equidistant between the outermost two, which stay: along x,
/// or along y if `is_upright`. Elements that share corners move as one.
///
/// # Errors
/// When an element does not exist, or there are fewer than three things to space.
pub fn distribute(plan: &Plan, elements: &BTreeSet<ElementId>, is_upright: bool) -> Result<Plan, EditError> {
    let mut groups = groups(plan, elements)?;
    if groups.len() < 3 {
        return fail("choose three things or more that share no corner");
    }
    let middle = |group: &Group| if is_upright { group.bounds.center().y } else { group.bounds.center().x };
    groups.sort_by(|p, q| middle(p).total_cmp(&middle(q)));
    let (first, last) = (middle(&groups[0]), middle(&groups[groups.len() - 1]));
    let step = (last - first) / (groups.len() - 1) as f64;
    let moves = groups.iter().enumerate().map(|(i, group)| {
        let by = first + step * i as f64 - middle(group);
        (group, if is_upright { Vector::new(0.0, by) } else { Vector::new(by, 0.0) })
    });
    moved(plan, moves)
}

/// Elements that share corners.
struct Group {
    elements: BTreeSet<ElementId>,
    bounds: Bounds,
}

fn moved<'a>(plan: &Plan, moves: impl Iterator<Item = (&'a Group, Vector)>) -> Result<Plan, EditError> {
    let mut next = plan.clone();
    for (group, by) in moves {
        next = move_picked(&next, &group.elements, by, Reach::Run, true)?.plan;
    }
    Ok(next)
}

/// Groups elements by the corners they share, in the order of their first elements. Hosted openings
/// follow their walls and form no group.
fn groups(plan: &Plan, elements: &BTreeSet<ElementId>) -> Result<Vec<Group>, EditError> {
    let mut groups: Vec<Option<(Group, BTreeSet<CornerId>)>> = Vec::new();
    let mut group_of: BTreeMap<CornerId, usize> = BTreeMap::new();
    for &element in elements {
        let corners = corners_of(plan, &[element].into())?;
        let mut bounds = Bounds::of(corners.iter().filter_map(|&id| plan.position(id)));
        if let ElementId::Opening(id) = element
            && let Some(Place::Free { from, to }) = plan.opening(id).map(|opening| opening.place)
        {
            bounds = Bounds::of([from, to]);
        }
        if bounds.is_empty() {
            continue;
        }
        let mut group = (Group { elements: [element].into(), bounds }, corners);
        let index = groups.len();
        let met: BTreeSet<usize> = group.1.iter().filter_map(|corner| group_of.get(corner).copied()).collect();
        for other in met {
            if let Some((mut joined, corners)) = groups[other].take() {
                group.0.elements.append(&mut joined.elements);
                group.0.bounds = group.0.bounds.union(joined.bounds);
                group.1.extend(corners);
            }
        }
        group_of.extend(group.1.iter().map(|&corner| (corner, index)));
        groups.push(Some(group));
    }
    let mut groups: Vec<Group> = groups.into_iter().flatten().map(|(group, _)| group).collect();
    groups.sort_by(|p, q| p.elements.cmp(&q.elements));
    Ok(groups)
}
