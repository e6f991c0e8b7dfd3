//! Making rooms from walls: filling the faces enclosed by walls and boundaries.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::edit::split::{Splits, split_edges};
use crate::edit::{self, EditError};
use crate::geometry::Point;
use crate::geometry::arrangement::{ArrangementError, Face, NodeIndex};
use crate::plan::{CornerId, Plan, Room, RoomId};
use crate::topology::plan_faces::{EdgeFaces, PlanFaces};

impl From<ArrangementError> for EditError {
    fn from(error: ArrangementError) -> Self {
        Self(format!("the faces between the walls cannot be found: {error}"))
    }
}

/// The result of filling faces.
#[derive(Clone, Debug)]
pub struct Filled {
    pub plan: Plan,
    /// The new rooms.
    pub rooms: Vec<RoomId>,
}

/// The rings around a face, as corners.
#[derive(Clone, Debug)]
pub(crate) struct Boundary {
    pub outer: Arc<[CornerId]>,
    pub holes: Vec<Arc<[CornerId]>>,
}

impl PlanFaces<'_> {
    /// Makes a room of each of the faces with these indices in [`PlanFaces::all`].
    ///
    /// The room uses the corners that walls and boundaries have there, and new ones where these cross. A
    /// wall or boundary that passes through such a corner without having it is split there, so that the
    /// corner is shared; its openings stay in place. The first part of a split wall keeps the wall's
    /// identity.
    ///
    /// # Errors
    /// When an index is out of range.
    pub fn fill(&self, indices: &[usize]) -> Result<Filled, EditError> {
        let indices: BTreeSet<usize> = indices.iter().copied().collect();
        if let Some(beyond) = indices.iter().find(|&&index| index >= self.faces.len()) {
            return Err(EditError(format!("there is no face {beyond}")));
        }
        let indices: Vec<usize> = indices.into_iter().collect();
        let (mut next, boundaries) = self.edges.boundaries(&indices)?;
        let mut rooms = Vec::with_capacity(indices.len());
        for Boundary { outer, holes } in boundaries {
            let (with_room, id) = edit::add_room(&next, Room { outer, holes, ..Room::default() })?;
            next = with_room;
            rooms.push(id);
        }
        Ok(Filled { plan: next, rooms })
    }
}

impl EdgeFaces<'_> {
    /// The rings around faces as corners, in the order of the indices, and a plan that has all of these
    /// corners: with new ones where edges cross, and everything on these edges split at the rings'
    /// corners.
    pub fn boundaries(&self, indices: &[usize]) -> Result<(Plan, Vec<Boundary>), EditError> {
        let chosen = || indices.iter().map(|&index| &self.faces[index]);
        let mut corners = self.corners_at_nodes();
        let mut next = self.plan.clone();
        let mut used = vec![false; self.arrangement.node_count()];
        for &node in chosen().flat_map(Face::rings).flatten() {
            used[node as usize] = true;
            let corner = &mut corners[node as usize];
            if corner.is_none() {
                let (with_corner, id) = edit::add_corner(&next, self.arrangement.position(node))?;
                (next, *corner) = (with_corner, Some(id));
            }
        }
        let mut splits = Splits::new();
        for (i, &ends) in self.edges.iter().enumerate() {
            let chain = self.arrangement.chain(i);
            let inner = chain.get(1..chain.len().saturating_sub(1)).unwrap_or_default();
            let inner: Vec<CornerId> =
                inner.iter().filter(|&&node| used[node as usize]).filter_map(|&node| corners[node as usize]).collect();
            if !inner.is_empty() {
                splits.insert(ends, inner);
            }
        }
        if !splits.is_empty() {
            next = split_edges(&next, &splits)?;
        }
        let ring = |nodes: &Vec<NodeIndex>| -> Arc<[CornerId]> {
            nodes.iter().filter_map(|&node| corners[node as usize]).collect()
        };
        let boundaries = chosen()
            .map(|face| Boundary { outer: ring(&face.outer), holes: face.holes.iter().map(ring).collect() })
            .collect();
        Ok((next, boundaries))
    }
}

/// Fills the face around a point with a room. It may be enclosed by walls and room boundaries.
///
/// # Errors
/// When nothing encloses the point, or there is already a room.
pub fn fill_at(plan: &Plan, point: Point) -> Result<Filled, EditError> {
    let faces = PlanFaces::new(plan)?;
    let Some(index) = faces.at(point) else {
        return Err(EditError("no walls enclose this place: look for an end that meets no other wall".to_owned()));
    };
    if let Some(&room) = faces.all()[index].rooms.first() {
        let name = plan.room(room).map(|room| room.name.as_str()).filter(|name| !name.is_empty());
        return Err(EditError(match name {
            Some(name) => format!("the room '{name}' is here already"),
            None => "a room is here already".to_owned(),
        }));
    }
    faces.fill(&[index])
}

/// Makes rooms of some faces; of none, the plan as it is.
pub(super) fn fill_faces(faces: &PlanFaces<'_>, indices: &[usize]) -> Result<Filled, EditError> {
    if indices.is_empty() {
        return Ok(Filled { plan: faces.edges.plan.clone(), rooms: Vec::new() });
    }
    faces.fill(indices)
}

/// Fills every face enclosed by walls alone, unless it has a room or is a sliver. The space between rooms
/// drawn without walls stays empty: it may be the thickness of a wall.
///
/// # Errors
/// When the walls meet more often than [`crate::geometry::arrangement::PASSINGS_LIMIT`].
pub fn fill_all(plan: &Plan) -> Result<Filled, EditError> {
    let faces = PlanFaces::new(plan)?;
    let empty: Vec<usize> = (0..faces.all().len())
        .filter(|&index| {
            let face = &faces.all()[index];
            face.by_walls && face.rooms.is_empty() && !face.is_sliver()
        })
        .collect();
    faces.fill(&empty)
}
