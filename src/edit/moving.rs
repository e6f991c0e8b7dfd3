//! Moving, rotating, mirroring, scaling and arranging elements.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::{EditError, checked_position, fail, move_corners, require_corners};
use crate::geometry::{Bounds, Point, TOUCH_M, Transform, Vector, polygon, trim_m};
use crate::plan::{CornerId, ElementId, OpeningId, Place, Plan, WallId};

/// Moves elements: each corner they use once, and with it everything that shares it; also free openings.
/// An opening selected without its wall slides along it.
///
/// Mirrored doors still open into the same room. Scaling applies to the positions and widths of openings
/// on scaled edges, and to the thickness of selected walls.
///
/// # Errors
/// When an element does not exist, a target lies outside the drawing area, or an edge hosting an opening
/// would lose its length.
pub fn move_elements(plan: &Plan, elements: &BTreeSet<ElementId>, transform: Transform) -> Result<Plan, EditError> {
    let corners = corners_of(plan, elements)?;
    let targets: Vec<(CornerId, Point)> =
        corners.iter().filter_map(|&id| Some((id, transform.point(plan.position(id)?)))).collect();
    let mut next = move_corners(plan, &targets)?;
    let factor = transform.factor();
    let openings: Vec<OpeningId> = plan.openings().map(|(id, _)| id).collect();
    for id in openings {
        let Some(opening) = plan.opening(id) else { continue };
        let chosen = elements.contains(&ElementId::Opening(id));
        match opening.place {
            Place::Hosted { from, to, at_m, width_m } if corners.contains(&from) && corners.contains(&to) => {
                if transform.keeps_lengths() && !transform.mirrors() {
                    continue;
                }
                let length_m = next.position(from).zip(next.position(to)).map_or(0.0, |(a, b)| a.distance(b));
                let (at_m, width_m) = (trim_m((at_m * factor).min(length_m)), trim_m(width_m * factor));
                if !(width_m > 0.0 && width_m <= 1000.0) {
                    return fail("an opening would get too small or too large");
                }
                let Some(shared) = next.openings.get_mut(&id) else { continue };
                let opening = Arc::make_mut(shared);
                opening.place = Place::Hosted { from, to, at_m, width_m };
                mirror_swing(opening, transform);
            }
            Place::Hosted { from, to, .. } if chosen && !corners.contains(&from) && !corners.contains(&to) => {
                if let Some(segment) = plan.opening_segment(opening) {
                    next = super::slide_opening(&next, id, transform.point(segment.midpoint()))?;
                }
            }
            Place::Free { from, to } if chosen => {
                let (from, to) = (checked_position(transform.point(from))?, checked_position(transform.point(to))?);
                if from == to {
                    return fail("an opening would lose its width");
                }
                let Some(shared) = next.openings.get_mut(&id) else { continue };
                let opening = Arc::make_mut(shared);
                opening.place = Place::Free { from, to };
                mirror_swing(opening, transform);
            }
            _ => {}
        }
    }
    if !transform.keeps_lengths() {
        for element in elements {
            if let ElementId::Wall(id) = element
                && let Some(wall) = next.walls.get_mut(id)
            {
                wall.thickness_m = trim_m((wall.thickness_m * factor).min(10.0));
            }
        }
    }
    let chains =
        elements.iter().filter_map(|element| if let ElementId::Dimension(id) = element { Some(*id) } else { None });
    chains.fold(Ok(next), |next, id| super::dimensions::transformed(plan, &next?, id, transform))
}

/// A mirrored door opens to the other side of its segment, whose ends keep their order.
pub(crate) fn mirror_swing(opening: &mut crate::plan::Opening, transform: Transform) {
    if transform.mirrors()
        && let Some(swing) = &mut opening.swing
    {
        swing.side = swing.side.other();
    }
}

/// The corners that elements use; those of a hosted opening belong to its wall.
///
/// # Errors
/// When an element does not exist.
pub fn corners_of(plan: &Plan, elements: &BTreeSet<ElementId>) -> Result<BTreeSet<CornerId>, EditError> {
    let mut corners = BTreeSet::new();
    for element in elements {
        match element {
            ElementId::Corner(id) => {
                require_corners(plan, &[*id])?;
                corners.insert(*id);
            }
            ElementId::Wall(id) => match plan.wall(*id) {
                Some(wall) => corners.extend([wall.from, wall.to]),
                None => return fail(format!("{id} does not exist")),
            },
            ElementId::Room(id) => match plan.room(*id) {
                Some(room) => corners.extend(room.rings().flat_map(|ring| ring.iter().copied())),
                None => return fail(format!("{id} does not exist")),
            },
            ElementId::Opening(id) => {
                if plan.opening(*id).is_none() {
                    return fail(format!("{id} does not exist"));
                }
            }
            ElementId::Dimension(id) => {
                if plan.dimension(*id).is_none() {
                    return fail(format!("{id} does not exist"));
                }
            }
        }
    }
    Ok(corners)
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
        next = move_elements(&next, &group.elements, Transform::translation(by))?;
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

/// Rejects an edit that moved corners if an edge lost its length, or a room turned inside out or began to
/// cross itself.
///
/// # Errors
/// Says which of these.
pub(crate) fn check_shapes(
    before: &Plan,
    after: &Plan,
    moved: &BTreeSet<CornerId>,
    what: &str,
) -> Result<(), EditError> {
    for (a, b) in crate::edit::overlay::plan_edges(after) {
        if (moved.contains(&a) || moved.contains(&b))
            && let (Some(p), Some(q)) = (after.position(a), after.position(b))
            && p.distance(q) <= TOUCH_M
            && before.position(a).zip(before.position(b)).is_some_and(|(p, q)| p.distance(q) > TOUCH_M)
        {
            return fail(format!("{what} would leave a wall without length"));
        }
    }
    for (id, room) in after.rooms() {
        let touched = room.rings().any(|ring| ring.iter().any(|corner| moved.contains(corner)));
        let Some(old) = before.room(id).filter(|_| touched) else { continue };
        for (old, new) in old.rings().zip(room.rings()) {
            let (old, new) = (before.ring_points(old), after.ring_points(new));
            let turned = polygon::signed_area(&old) * polygon::signed_area(&new) < 0.0;
            let is_simple = crate::geometry::path::is_simple_ring;
            if turned || (is_simple(&old) && !is_simple(&new)) {
                let name = if room.name.is_empty() { id.to_string() } else { format!("'{}'", room.name) };
                return fail(format!("{what} would turn the room {name} inside out"));
            }
        }
    }
    Ok(())
}
