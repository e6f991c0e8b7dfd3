//! What belongs to picked elements, and how it comes away from what it shares: the rule that every edit
//! follows, see `docs/editing.md`.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::draw::{Inside, room_edges};
use crate::edit::{EditError, add_wall, fail, require_corners};
use crate::plan::{
    Corner, CornerId, ElementId, Joint, OpeningId, Place, Plan, Room, RoomId, WallId, builder::new_corner_id, ordered,
};

/// The part of a plan that is picked. A room comes with the walls along its boundary and in it, and every wall
/// and room with its openings.
#[derive(Clone, Debug, Default)]
pub struct Part {
    pub rooms: BTreeSet<RoomId>,
    /// The walls that no other room needs.
    pub walls: BTreeSet<WallId>,
    /// The walls of its rooms that bound another room as well.
    pub shared_walls: BTreeSet<WallId>,
    /// The openings on its own walls and boundaries, and picked free ones.
    pub openings: BTreeSet<OpeningId>,
    /// The openings on edges that it shares, which stay there.
    pub shared_openings: BTreeSet<OpeningId>,
    /// All corners that its rooms and walls use, shared or not, and those picked as such.
    pub corners: BTreeSet<CornerId>,
    /// A picked wall that bounds rooms, none of which is picked.
    bounding: Option<WallId>,
}

impl Part {
    /// What belongs to these elements.
    ///
    /// # Errors
    /// When an element does not exist.
    pub fn of(plan: &Plan, picked: &BTreeSet<ElementId>) -> Result<Self, EditError> {
        let mut part = Self { corners: corners_of(plan, picked)?, ..Self::default() };
        part.rooms =
            picked.iter().filter_map(|one| if let ElementId::Room(id) = one { Some(*id) } else { None }).collect();
        let rooms = || part.rooms.iter().filter_map(|&id| plan.room(id));
        let own: BTreeSet<[CornerId; 2]> = rooms().flat_map(room_edges).collect();
        let insides: Vec<Inside> = rooms().map(|room| Inside::new(plan, room)).collect();
        let mut candidates: Vec<(WallId, [CornerId; 2], bool)> = Vec::new();
        for (id, wall) in plan.walls() {
            let edge = ordered(wall.from, wall.to);
            let is_picked = picked.contains(&ElementId::Wall(id));
            let is_inside = || {
                let middle = plan.wall_segment(wall).map(crate::geometry::Segment::midpoint);
                middle.is_some_and(|middle| insides.iter().any(|inside| inside.holds(middle)))
            };
            if own.contains(&edge) || is_picked || is_inside() {
                candidates.push((id, edge, is_picked));
            }
        }
        let asked: BTreeSet<[CornerId; 2]> =
            candidates.iter().map(|&(_, edge, _)| edge).chain(own.iter().copied()).collect();
        let mut others: BTreeSet<[CornerId; 2]> = BTreeSet::new();
        for (_, room) in plan.rooms().filter(|(id, _)| !part.rooms.contains(id)) {
            others.extend(room_edges(room).into_iter().filter(|edge| asked.contains(edge)));
        }
        for (id, edge, is_picked) in candidates {
            match (own.contains(&edge), others.contains(&edge)) {
                (true, true) => drop(part.shared_walls.insert(id)),
                (false, true) if is_picked => {
                    part.bounding.get_or_insert(id);
                    part.walls.insert(id);
                }
                // A room within a picked room stays with its walls.
                (false, true) => {}
                (_, false) => drop(part.walls.insert(id)),
            }
        }
        part.corners.extend(part.walls.iter().filter_map(|&id| plan.wall(id)).flat_map(|wall| [wall.from, wall.to]));
        let mut edges: BTreeSet<[CornerId; 2]> = own.difference(&others).copied().collect();
        edges.extend(part.walls.iter().filter_map(|&id| plan.wall(id)).map(|wall| ordered(wall.from, wall.to)));
        let joins_part = |joint: &Joint| joint.room().is_none_or(|room| part.rooms.contains(&room));
        for (id, opening) in plan.openings() {
            let is_picked = picked.contains(&ElementId::Opening(id));
            match opening.place {
                Place::Hosted { from, to, .. } if edges.contains(&ordered(from, to)) => drop(part.openings.insert(id)),
                Place::Hosted { from, to, .. } if own.contains(&ordered(from, to)) => {
                    part.shared_openings.insert(id);
                }
                Place::Free { .. } if is_picked => drop(part.openings.insert(id)),
                Place::Free { .. } => {
                    // A door between picked rooms, or from one of them to the outside.
                    let sides = opening.pinned.as_ref();
                    let is_own = sides.is_some_and(|sides| {
                        sides.iter().all(joins_part) && sides.iter().any(|side| side.room().is_some())
                    });
                    if is_own {
                        part.openings.insert(id);
                    }
                }
                Place::Hosted { .. } => {}
            }
        }
        Ok(part)
    }

    /// Refuses to take a wall away from rooms that are not picked.
    ///
    /// # Errors
    /// When a picked wall bounds rooms none of which is picked.
    pub fn check_takes_no_boundary(&self, plan: &Plan) -> Result<(), EditError> {
        let Some(wall) = self.bounding.and_then(|id| plan.wall(id)) else { return Ok(()) };
        let edge = ordered(wall.from, wall.to);
        let bounded = plan.rooms().filter(|(id, room)| !self.rooms.contains(id) && room_edges(room).contains(&edge));
        let rooms: Vec<&Room> = bounded.map(|(_, room)| room).collect();
        let names: Vec<String> = match rooms[..] {
            [one, other] if one.name.is_empty() && other.name.is_empty() => vec!["two rooms".to_owned()],
            _ => rooms.iter().map(|room| crate::edit::draw::named(room)).collect(),
        };
        fail(format!(
            "the wall bounds {}, which would lose it; select the rooms too, or make a copy",
            names.join(" and ")
        ))
    }

    /// The plan in which the part shares no corner with the rest: corners that something else uses stay with
    /// that, and the part gets its own in the same places. Walls that bound a room of the part and another one
    /// stay with the other; with `own_walls` the part gets its own. Returns the part in that plan, and the
    /// corners it left behind.
    ///
    /// # Errors
    /// When a wall cannot be added.
    pub fn detached(self, plan: &Plan, own_walls: bool) -> Result<(Plan, Self, BTreeSet<CornerId>), EditError> {
        let mut stay: BTreeSet<CornerId> = BTreeSet::new();
        let mut keep = |corner: CornerId| {
            if self.corners.contains(&corner) {
                stay.insert(corner);
            }
        };
        for (_, wall) in plan.walls().filter(|(id, _)| !self.walls.contains(id)) {
            keep(wall.from);
            keep(wall.to);
        }
        for (_, room) in plan.rooms().filter(|(id, _)| !self.rooms.contains(id)) {
            room.rings().flat_map(|ring| ring.iter()).for_each(|&corner| keep(corner));
        }
        for (_, opening) in plan.openings().filter(|(id, _)| !self.openings.contains(id)) {
            if let Place::Hosted { from, to, .. } = opening.place {
                keep(from);
                keep(to);
            }
        }
        if stay.is_empty() {
            return Ok((plan.clone(), self, stay));
        }
        let mut next = plan.clone();
        let mut now: BTreeMap<CornerId, CornerId> = BTreeMap::new();
        let mut added_walls = Vec::new();
        // Corners picked as such, which nothing of the part uses, stay where they are shared.
        let mut used: BTreeSet<CornerId> = BTreeSet::new();
        used.extend(self.walls.iter().filter_map(|&id| plan.wall(id)).flat_map(|wall| [wall.from, wall.to]));
        let rings = self.rooms.iter().filter_map(|&id| plan.room(id)).flat_map(|room| room.rings());
        used.extend(rings.flat_map(|ring| ring.iter().copied()));
        for &corner in stay.iter().filter(|corner| used.contains(corner)) {
            let Some(position) = plan.position(corner) else { continue };
            let id = new_corner_id(&next, position);
            next.corners.insert(id, Corner { position, extra: None });
            now.insert(corner, id);
        }
        let of = |corner: CornerId| now.get(&corner).copied().unwrap_or(corner);
        for id in &self.walls {
            if let Some(wall) = next.walls.get_mut(id) {
                (wall.from, wall.to) = (of(wall.from), of(wall.to));
            }
        }
        for id in &self.rooms {
            if let Some(shared) = next.rooms.get_mut(id) {
                let room = Arc::make_mut(shared);
                for ring in std::iter::once(&mut room.outer).chain(&mut room.holes) {
                    *ring = ring.iter().map(|&corner| of(corner)).collect();
                }
            }
        }
        for id in &self.openings {
            if let Some(shared) = next.openings.get_mut(id)
                && let Place::Hosted { from, to, at_m, width_m } = shared.place
                && (of(from), of(to)) != (from, to)
            {
                Arc::make_mut(shared).place = Place::Hosted { from: of(from), to: of(to), at_m, width_m };
            }
        }
        // A door that stays is no longer one to a room that goes.
        let leaves = |joint: &Joint| joint.room().is_some_and(|room| self.rooms.contains(&room));
        let unpinned = plan
            .openings()
            .filter(|(id, opening)| !self.openings.contains(id) && opening.pinned.iter().flatten().any(leaves));
        for id in unpinned.map(|(id, _)| id) {
            if let Some(shared) = next.openings.get_mut(&id) {
                Arc::make_mut(shared).pinned = None;
            }
        }
        if own_walls {
            for wall in self.shared_walls.iter().filter_map(|&id| plan.wall(id)) {
                let (with_wall, id) = add_wall(&next, of(wall.from), of(wall.to), wall.thickness_m)?;
                next = with_wall;
                if let Some(added) = next.walls.get_mut(&id) {
                    added.extra.clone_from(&wall.extra);
                }
                added_walls.push(id);
            }
        }
        let own = self.corners.iter().filter(|corner| !stay.contains(corner)).copied();
        let corners = own.chain(now.values().copied()).collect();
        let walls = self.walls.iter().copied().chain(added_walls).collect();
        let part = Self { corners, walls, ..self };
        Ok((next, part, stay))
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
