//! Splitting edges at corners, for everything that has those edges.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::EditError;
use crate::geometry::{Point, Segment, trim_m};
use crate::plan::{CornerId, OpeningId, Place, Plan, RoomId, WallId, ordered, ring_edges};

/// The corners to insert into edges: keyed by the edge's corners, smaller first, in order from that one
/// to the larger.
pub(crate) type Splits = BTreeMap<[CornerId; 2], Vec<CornerId>>;

/// The corners from one end of an edge to the other, both included; `None` if it is not split.
fn split_chain(splits: &Splits, from: CornerId, to: CornerId) -> Option<Vec<CornerId>> {
    let inner = splits.get(&ordered(from, to))?;
    let mut chain = vec![from];
    if from < to {
        chain.extend(inner)
    } else {
        chain.extend(inner.iter().rev())
    }
    chain.push(to);
    Some(chain)
}

/// Splits the walls and boundaries that have these edges, and moves their openings to the right part. Where walls lay so
/// close together that parts of them have the same ends, one stays.
pub(crate) fn split_edges(plan: &Plan, splits: &Splits) -> Result<Plan, EditError> {
    let (next, parents) = split_walls_and_rooms(plan, splits)?;
    let cut: BTreeSet<CornerId> = splits.iter().flat_map(|(ends, inner)| ends.iter().chain(inner)).copied().collect();
    Ok(without_repeated_walls(next, &cut, &parents.into_keys().collect()))
}

/// Of walls with the same ends, one of which is among the given corners, keeps only the first by id, of those that did not
/// move if there are any.
pub(crate) fn without_repeated_walls(plan: Plan, between: &BTreeSet<CornerId>, moved: &BTreeSet<WallId>) -> Plan {
    let mut seen: BTreeSet<[CornerId; 2]> = BTreeSet::new();
    let mut there: Vec<(bool, WallId, [CornerId; 2])> = plan
        .walls()
        .filter(|(_, wall)| between.contains(&wall.from) || between.contains(&wall.to))
        .map(|(id, wall)| (moved.contains(&id), id, ordered(wall.from, wall.to)))
        .collect();
    there.sort_unstable();
    let repeated: Vec<WallId> =
        there.into_iter().filter(|&(_, _, edge)| !seen.insert(edge)).map(|(_, id, _)| id).collect();
    let mut next = plan;
    for id in repeated {
        next.walls.remove(&id);
    }
    next
}

/// As [`split_edges`]; also gives the new walls, each with the one that it is a part of.
pub(crate) fn split_walls_and_rooms(
    plan: &Plan,
    splits: &Splits,
) -> Result<(Plan, BTreeMap<WallId, WallId>), EditError> {
    let mut next = plan.clone();
    let mut parents = BTreeMap::new();
    let walls: Vec<(WallId, Vec<CornerId>)> =
        plan.walls().filter_map(|(id, wall)| Some((id, split_chain(splits, wall.from, wall.to)?))).collect();
    for (id, chain) in walls {
        let Some(wall) = next.walls.get_mut(&id) else { continue };
        wall.to = chain[1];
        let (thickness_m, extra) = (wall.thickness_m, wall.extra.clone());
        for pair in chain.windows(2).skip(1) {
            let (with_wall, part) = super::add_wall(&next, pair[0], pair[1], thickness_m)?;
            next = with_wall;
            parents.insert(part, id);
            if let Some(part) = next.walls.get_mut(&part) {
                part.extra.clone_from(&extra);
            }
        }
    }
    let is_split = |ring: &[CornerId]| ring_edges(ring).any(|(a, b)| splits.contains_key(&ordered(a, b)));
    let rooms: Vec<RoomId> =
        plan.rooms().filter(|(_, room)| room.rings().any(|ring| is_split(ring))).map(|(id, _)| id).collect();
    for id in rooms {
        let Some(room) = next.rooms.get_mut(&id) else { continue };
        let room = Arc::make_mut(room);
        for ring in std::iter::once(&mut room.outer).chain(&mut room.holes) {
            *ring = ring_edges(ring)
                .flat_map(|(a, b)| {
                    let mut chain = split_chain(splits, a, b).unwrap_or_else(|| vec![a, b]);
                    chain.pop();
                    chain
                })
                .collect();
        }
    }
    let openings: Vec<(OpeningId, Place)> = plan
        .openings()
        .filter_map(|(id, opening)| Some((id, place_on_part(plan, &next, splits, opening.place)?)))
        .collect();
    for (id, place) in openings {
        if let Some(opening) = next.openings.get_mut(&id) {
            Arc::make_mut(opening).place = place;
        }
    }
    Ok((next, parents))
}

/// Where an opening on a split edge of `before` goes in `after`: on the part nearest to its middle.
fn place_on_part(before: &Plan, after: &Plan, splits: &Splits, place: Place) -> Option<Place> {
    let Place::Hosted { from, to, at_m, width_m } = place else { return None };
    let chain = split_chain(splits, from, to)?;
    let edge = Segment::new(before.position(from)?, before.position(to)?);
    nearest_part(after, &chain, edge.a + edge.vector().unit()? * at_m, width_m)
}

/// The place of an opening with this middle on a chain of edges: on the nearest part; `None` if no part
/// has a length.
pub(crate) fn nearest_part(plan: &Plan, chain: &[CornerId], middle: Point, width_m: f64) -> Option<Place> {
    let parts = chain.windows(2).filter_map(|pair| {
        let part = Segment::new(plan.position(pair[0])?, plan.position(pair[1])?);
        (part.length() > 0.0).then(|| (part.distance(middle), part, pair[0], pair[1]))
    });
    let (_, part, from, to) = parts.min_by(|p, q| p.0.total_cmp(&q.0))?;
    let at_m = trim_m(part.nearest_fraction(middle) * part.length());
    Some(Place::Hosted { from, to, at_m, width_m })
}
