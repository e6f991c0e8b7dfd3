//! Edits that touch only their surroundings, done on a part of the plan: in a large one the rest costs nothing.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::edit::EditError;
use crate::geometry::Bounds;
use crate::plan::{ChangeKind, CornerId, Difference, ElementId, Place, Plan};

/// Does an edit on the part of a plan that lies near, and puts what it changed into the whole.
///
/// `near` are all elements that meet `bounds`, or more; the edit looks at nothing else and changes nothing beyond. What
/// comes out is what the edit makes of the whole plan, which it is done on where the part shows that it reaches
/// further.
///
/// # Errors
/// Those of the edit.
pub fn locally(
    plan: &Plan,
    near: &BTreeSet<ElementId>,
    bounds: Bounds,
    edit: impl Fn(&Plan) -> Result<Plan, EditError>,
) -> Result<Plan, EditError> {
    let part = part_of(plan, near);
    let edited = edit(&part)?;
    match merged(plan, &part, &edited, bounds) {
        Some(next) => Ok(next),
        None => edit(plan),
    }
}

/// Some elements of a plan, with the corners that they use and the openings on their edges.
fn part_of(plan: &Plan, elements: &BTreeSet<ElementId>) -> Plan {
    let mut part = Plan { meta: plan.meta.clone(), backdrop: plan.backdrop.clone(), ..Plan::default() };
    part.guides = plan.guides.clone();
    part.extra = plan.extra.clone();
    let mut corners: Vec<CornerId> = Vec::new();
    for element in elements {
        match element {
            ElementId::Corner(id) => corners.push(*id),
            ElementId::Wall(id) => {
                if let Some(wall) = plan.walls.get(id) {
                    corners.extend([wall.from, wall.to]);
                    part.walls.insert(*id, wall.clone());
                }
            }
            ElementId::Room(id) => {
                if let Some(room) = plan.rooms.get(id) {
                    corners.extend(room.rings().flat_map(|ring| ring.iter().copied()));
                    part.rooms.insert(*id, room.clone());
                }
            }
            // Whoever does the edit lets them follow, in the whole plan.
            ElementId::Opening(_) | ElementId::Dimension(_) => {}
        }
    }
    corners.sort_unstable();
    corners.dedup();
    let mut more: Vec<CornerId> = Vec::new();
    for (id, opening) in &plan.openings {
        let is_on = match opening.place {
            Place::Hosted { from, to, .. } => [from, to].iter().all(|corner| corners.binary_search(corner).is_ok()),
            Place::Free { .. } => false,
        };
        let is_pinned = || {
            let rooms = opening.pinned.iter().flatten().filter_map(|joint| joint.room());
            rooms.into_iter().any(|room| part.rooms.contains_key(&room))
        };
        if is_on || elements.contains(&ElementId::Opening(*id)) || is_pinned() {
            if let Place::Hosted { from, to, .. } = opening.place {
                more.extend([from, to]);
            }
            part.openings.insert(*id, opening.clone());
        }
    }
    for id in corners.into_iter().chain(more) {
        if let Some(corner) = plan.corners.get(&id) {
            part.corners.insert(id, corner.clone());
        }
    }
    // What is pinned to a room far away stays so: the room comes along, and its corners.
    let pinned = part.openings.values().flat_map(|opening| opening.pinned.iter().flatten());
    let rooms: BTreeSet<_> = pinned.filter_map(|joint| joint.room()).collect();
    for id in rooms {
        if let Some(room) = plan.rooms.get(&id).filter(|_| !part.rooms.contains_key(&id)) {
            for corner in room.rings().flat_map(|ring| ring.iter()) {
                if let Some(known) = plan.corners.get(corner) {
                    part.corners.insert(*corner, known.clone());
                }
            }
            part.rooms.insert(id, Arc::clone(room));
        }
    }
    part
}

/// The whole plan with what was changed in a part of it; `None` where that concerns what lies beyond `bounds`, or
/// would take another's id.
fn merged(plan: &Plan, part: &Plan, edited: &Plan, bounds: Bounds) -> Option<Plan> {
    let difference = Difference::between(part, edited);
    if difference.meta || difference.backdrop || difference.guides || difference.extra {
        return None;
    }
    let mut next = plan.clone();
    for (&element, &kind) in &difference.elements {
        if kind == ChangeKind::Added && plan.has(element) {
            return None;
        }
        match element {
            ElementId::Corner(id) => {
                // Others may use a corner that lies beyond.
                let is_beyond = |plan: &Plan| plan.position(id).is_some_and(|point| !bounds.contains(point));
                if kind != ChangeKind::Added && (is_beyond(part) || is_beyond(edited)) {
                    return None;
                }
                match edited.corners.get(&id) {
                    Some(corner) => drop(next.corners.insert(id, corner.clone())),
                    None => drop(next.corners.remove(&id)),
                }
            }
            ElementId::Wall(id) => match edited.walls.get(&id) {
                Some(wall) => drop(next.walls.insert(id, wall.clone())),
                None => drop(next.walls.remove(&id)),
            },
            ElementId::Room(id) => match edited.rooms.get(&id) {
                Some(room) => drop(next.rooms.insert(id, Arc::clone(room))),
                None => drop(next.rooms.remove(&id)),
            },
            ElementId::Opening(id) => match edited.openings.get(&id) {
                Some(opening) => drop(next.openings.insert(id, Arc::clone(opening))),
                None => drop(next.openings.remove(&id)),
            },
            ElementId::Dimension(_) => return None,
        }
    }
    Some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;
    use crate::edit::{drag_corners, draw_walls};
    use crate::geometry::Point;
    use crate::plan::{Builder, Joint, Meta, Opening, OpeningKind, Room};

    /// Rooms of 4 by 3 m with walls, doors, and one door that is pinned to a room far away.
    fn grid(side: usize) -> Plan {
        let mut builder = Builder::new(Meta::default());
        let at = |x: usize, y: usize| Point::new(x as f64 * 4.0, y as f64 * 3.0);
        let mut doors = Vec::new();
        let mut last = None;
        for y in 0..=side {
            for x in 0..=side {
                let here = builder.corner(at(x, y));
                for (dx, dy) in [(1, 0), (0, 1)] {
                    if x + dx <= side && y + dy <= side {
                        let there = builder.corner(at(x + dx, y + dy));
                        builder.wall(here, there, 0.12);
                        doors.push(Place::Hosted { from: here, to: there, at_m: 1.5, width_m: 0.9 });
                    }
                }
                if x < side && y < side {
                    let ring = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| builder.corner(at(x, y)));
                    last = Some(builder.room("", Room { outer: ring.into(), ..Room::default() }));
                }
            }
        }
        for (index, place) in doors.into_iter().enumerate().filter(|(index, _)| index % 3 == 0) {
            let pinned = last.filter(|_| index == 0).map(|room| [Joint::Room(room), Joint::Outside]);
            builder.opening("", Opening { pinned, ..Opening::new(OpeningKind::Door, place) });
        }
        builder.finish().expect("a plan")
    }

    /// All elements that meet a box, found one by one.
    fn near(plan: &Plan, bounds: Bounds) -> BTreeSet<ElementId> {
        let meets = |element: &ElementId| {
            let points = match *element {
                ElementId::Corner(id) => vec![plan.position(id)],
                ElementId::Room(id) => {
                    plan.room(id).into_iter().flat_map(|room| room.outer.iter()).map(|&c| plan.position(c)).collect()
                }
                ElementId::Wall(id) => {
                    let segment = plan.wall(id).and_then(|wall| plan.wall_segment(wall));
                    segment.map(|segment| vec![Some(segment.a), Some(segment.b)]).unwrap_or_default()
                }
                ElementId::Opening(id) => {
                    let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
                    segment.map(|segment| vec![Some(segment.a), Some(segment.b)]).unwrap_or_default()
                }
                ElementId::Dimension(_) => Vec::new(),
            };
            Bounds::of(points.into_iter().flatten()).intersects(bounds)
        };
        plan.elements().filter(meets).collect()
    }

    /// The box with the rooms that meet it.
    fn with_rooms(plan: &Plan, bounds: Bounds) -> Bounds {
        let rooms = near(plan, bounds).into_iter().filter_map(|element| match element {
            ElementId::Room(id) => Some(Bounds::of(plan.ring_points(&plan.room(id)?.outer))),
            _ => None,
        });
        rooms.fold(bounds, Bounds::union)
    }

    fn assert_same(plan: &Plan, bounds: Bounds, edit: impl Fn(&Plan) -> Result<Plan, EditError>) -> Plan {
        let around = with_rooms(plan, bounds.inflated(0.5));
        let here = locally(plan, &near(plan, around), around, &edit);
        let whole = edit(plan);
        assert_eq!(here, whole);
        here.unwrap_or_else(|_| plan.clone())
    }

    #[test]
    fn what_is_done_on_a_part_is_as_done_on_the_whole() {
        let mut random = Random::new(12);
        for _ in 0..40 {
            let mut plan = grid(5);
            for _ in 0..6 {
                let mut at = |reach: f64| {
                    Point::new(
                        random.unit() * 20.0 + reach * random.unit(),
                        random.unit() * 15.0 + reach * random.unit(),
                    )
                };
                let path = [at(0.0), at(3.0), at(0.0)];
                let bounds = Bounds::of(path);
                plan = assert_same(&plan, bounds, |plan| Ok(draw_walls(plan, &path, 0.2)?.plan));
                let corners: Vec<CornerId> = plan.corners().map(|(id, _)| id).collect();
                let corner = corners[random.below(corners.len())];
                let Some(place) = plan.position(corner) else { continue };
                let to = Point::new(place.x + random.unit() * 2.0 - 1.0, place.y + random.unit() * 2.0 - 1.0);
                let meeting = near(&plan, Bounds::of([place]));
                let part = part_of(&plan, &meeting);
                let bounds = part.bounds().with(to);
                plan = assert_same(&plan, bounds, |plan| Ok(drag_corners(plan, &[(corner, to)])?.plan));
            }
            assert_eq!(plan.violations(), []);
        }
    }
}
