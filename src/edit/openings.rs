//! Placing openings on edges and changing them.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::edit::overlay::plan_edges;
use crate::edit::{EditError, add_opening, fail};
use crate::geometry::polygon::orientation;
use crate::geometry::runs::NOTCH_M;
use crate::geometry::{GRID_M, Point, Segment, trim_m};
use crate::plan::{
    CornerId, Joint, LeafSide, Opening, OpeningId, OpeningKind, Place, Plan, Positions, Swing, ordered, ring_edges,
};
use crate::topology::{RoomShapes, sides_by_geometry};

/// The opening that [`place_opening`] would add: to show it beforehand.
///
/// It goes on the nearest wall, or where no wall is within `reach_m` on the nearest boundary of a
/// room, its middle as near to `at` as its width allows: inside the edge where it fits. On a shorter
/// edge it reaches over the collinear edges beside it, and is narrower than wanted only where these
/// are too short as well. A door opens to the side of the point `swing_towards`, hinged at the end
/// nearer to it.
///
/// # Errors
/// When nothing that could have an opening is within reach, others leave no place for it on its edge, or
/// the width is not a width.
pub fn opening_at(
    plan: &Plan,
    kind: OpeningKind,
    at: Point,
    width_m: f64,
    reach_m: f64,
    swing_towards: Option<Point>,
) -> Result<Opening, EditError> {
    let walls = plan.walls().map(|(_, wall)| (wall.from, wall.to));
    let boundaries = || plan.rooms().flat_map(|(_, room)| room.rings()).flat_map(|ring| ring_edges(ring));
    let Some(host) = nearest_edge(plan, walls, at, reach_m).or_else(|| nearest_edge(plan, boundaries(), at, reach_m))
    else {
        return fail("no wall or boundary of a room is near enough for an opening");
    };
    opening_on(plan, kind, host, at, width_m, swing_towards)
}

/// The same on an edge that is known: for who has looked for it already.
///
/// # Errors
/// When the edge has no length, others leave no place on it, or the width is not a width.
pub fn opening_on(
    plan: &Plan,
    kind: OpeningKind,
    host: (CornerId, CornerId),
    at: Point,
    width_m: f64,
    swing_towards: Option<Point>,
) -> Result<Opening, EditError> {
    let place = beside_others(plan, fitted(plan, host, at, width_m)?)?;
    let mut opening = Opening::new(kind, place);
    if matches!(kind, OpeningKind::Door | OpeningKind::DoubleDoor)
        && let (Some(towards), Some(segment)) = (swing_towards, plan.opening_segment(&opening))
    {
        let side = if orientation(segment.a, segment.b, towards) >= 0.0 { LeafSide::Left } else { LeafSide::Right };
        let hinge_at_start = segment.a.distance(towards) <= segment.b.distance(towards);
        opening.swing = Some(Swing { hinge_at_start, side });
    }
    Ok(opening)
}

/// Adds the opening that [`opening_at`] describes.
///
/// # Errors
/// As [`opening_at`].
pub fn place_opening(
    plan: &Plan,
    kind: OpeningKind,
    at: Point,
    width_m: f64,
    reach_m: f64,
    swing_towards: Option<Point>,
) -> Result<(Plan, OpeningId), EditError> {
    add_opening(plan, opening_at(plan, kind, at, width_m, reach_m, swing_towards)?)
}

/// Slides an opening along its wall, over all its collinear edges, as near to a point as it goes; a
/// free one along its own line.
///
/// # Errors
/// When the opening does not exist, or its edge has no length.
pub fn slide_opening(plan: &Plan, id: OpeningId, towards: Point) -> Result<Plan, EditError> {
    let opening = known(plan, id)?;
    let place = match opening.place {
        Place::Hosted { from, to, width_m, .. } => {
            let run = run_of(plan, from, to);
            let host = nearest_edge(plan, run.into_iter(), towards, f64::INFINITY).unwrap_or((from, to));
            fitted(plan, host, towards, width_m)?
        }
        Place::Free { from, to } => {
            let Some(along) = (to - from).unit() else { return fail("the opening has no direction to slide in") };
            let by = along * (towards - from.midpoint(to)).dot(along);
            free(from + by, to + by)?
        }
    };
    with_opening(plan, id, |opening| opening.place = place)
}

/// Changes an opening's width, in metres; its middle stays where it is if the wall allows.
///
/// # Errors
/// When the opening does not exist, or the width is not a width.
pub fn resize_opening(plan: &Plan, id: OpeningId, width_m: f64) -> Result<Plan, EditError> {
    let opening = known(plan, id)?;
    let Some(middle) = plan.opening_segment(opening).map(Segment::midpoint) else {
        return fail("the opening's wall has no length");
    };
    let place = match opening.place {
        Place::Hosted { from, to, .. } => fitted(plan, (from, to), middle, width_m)?,
        Place::Free { from, to } => {
            check_width(width_m)?;
            let Some(along) = (to - from).unit() else { return fail("the opening has no direction") };
            free(middle - along * (width_m / 2.0), middle + along * (width_m / 2.0))?
        }
    };
    with_opening(plan, id, |opening| opening.place = place)
}

/// Says what an opening is; what is no door loses its swing.
///
/// # Errors
/// When the opening does not exist.
pub fn set_opening_kind(plan: &Plan, id: OpeningId, kind: OpeningKind) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| {
        opening.kind = kind;
        if !matches!(kind, OpeningKind::Door | OpeningKind::DoubleDoor) {
            opening.swing = None;
        }
    })
}

/// Says how a door's leaf opens; `None` leaves it to the drawing.
///
/// # Errors
/// When the opening does not exist.
pub fn set_swing(plan: &Plan, id: OpeningId, swing: Option<Swing>) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| opening.swing = swing)
}

/// Hinges a door at its other end. `shown` is how the drawing shows it, for a door that leaves its
/// swing to the drawing.
///
/// # Errors
/// When the opening does not exist.
pub fn flip_hinge(plan: &Plan, id: OpeningId, shown: Swing) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| {
        let swing = opening.swing.unwrap_or(shown);
        opening.swing = Some(Swing { hinge_at_start: !swing.hinge_at_start, ..swing });
    })
}

/// Lets a door open to its other side; `shown` as for [`flip_hinge`].
///
/// # Errors
/// When the opening does not exist.
pub fn flip_side(plan: &Plan, id: OpeningId, shown: Swing) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| {
        let swing = opening.swing.unwrap_or(shown);
        opening.swing = Some(Swing { side: swing.side.other(), ..swing });
    })
}

fn known(plan: &Plan, id: OpeningId) -> Result<&Opening, EditError> {
    plan.opening(id).ok_or_else(|| EditError(format!("the opening {id} does not exist")))
}

fn with_opening(plan: &Plan, id: OpeningId, change: impl FnOnce(&mut Opening)) -> Result<Plan, EditError> {
    let mut next = plan.clone();
    match next.openings.get_mut(&id) {
        Some(opening) => change(Arc::make_mut(opening)),
        None => return fail(format!("the opening {id} does not exist")),
    }
    Ok(next)
}

/// Widths an opening may have, in metres: from the grid of lengths to what no building exceeds (the
/// invariant's limit).
fn check_width(width_m: f64) -> Result<(), EditError> {
    if trim_m(width_m) > 0.0 && width_m <= 1000.0 {
        return Ok(());
    }
    fail(format!("an opening's width is above 0 and at most 1000 m, not {width_m} m"))
}

fn free(from: Point, to: Point) -> Result<Place, EditError> {
    let (from, to) = (super::checked_position(from)?, super::checked_position(to)?);
    if from == to { fail("an opening needs a width") } else { Ok(Place::Free { from, to }) }
}

/// The edge nearest to a point within `reach_m`; among equals the first.
fn nearest_edge(
    plan: &Plan,
    edges: impl Iterator<Item = (CornerId, CornerId)>,
    at: Point,
    reach_m: f64,
) -> Option<(CornerId, CornerId)> {
    let positions = Positions::new(plan);
    let near = edges.filter_map(|(from, to)| {
        let segment = Segment::new(positions.get(from)?, positions.get(to)?);
        let distance_m = segment.distance(at);
        (distance_m <= reach_m && segment.length() > 0.0).then_some((distance_m, (from, to)))
    });
    near.min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, edge)| edge)
}

/// An opening's place on an edge, its middle as near to a point as its width allows.
fn fitted(plan: &Plan, (from, to): (CornerId, CornerId), at: Point, width_m: f64) -> Result<Place, EditError> {
    check_width(width_m)?;
    let edge = plan.position(from).zip(plan.position(to)).map(|(a, b)| Segment::new(a, b));
    let Some((edge, along)) = edge.and_then(|edge| Some((edge, edge.vector().unit()?))) else {
        return fail("an opening needs a wall with a length");
    };
    let length_m = edge.length();
    let wanted_m = (at - edge.a).dot(along);
    let (at_m, width_m) = if width_m <= length_m {
        (wanted_m.clamp(width_m / 2.0, length_m - width_m / 2.0), width_m)
    } else {
        // How far the collinear edges reach before and behind this one.
        let run = run_of(plan, from, to);
        let ends = run.iter().flat_map(|&(a, b)| [a, b]).filter_map(|corner| plan.position(corner));
        let (start_m, end_m) = ends
            .map(|end| (end - edge.a).dot(along))
            .fold((0.0_f64, length_m), |(start, end), at| (start.min(at), end.max(at)));
        let width_m = width_m.min(end_m - start_m);
        let (least, most) = (start_m + width_m / 2.0, end_m - width_m / 2.0);
        // Its middle must stay on this edge.
        (wanted_m.clamp(least, most.max(least)).clamp(0.0, length_m), width_m)
    };
    Ok(Place::Hosted { from, to, at_m: trim_m(at_m), width_m: trim_m(width_m) })
}

/// A place on an edge, moved along it as little as need be to overlap no other opening of it; one that
/// reaches over the edge's ends stays.
fn beside_others(plan: &Plan, place: Place) -> Result<Place, EditError> {
    let Place::Hosted { from, to, at_m, width_m } = place else { return Ok(place) };
    let length_m = plan.position(from).zip(plan.position(to)).map_or(0.0, |(a, b)| a.distance(b));
    if width_m > length_m {
        return Ok(place);
    }
    let mut taken: Vec<(f64, f64)> = plan
        .openings()
        .filter_map(|(_, opening)| match opening.place {
            Place::Hosted { from: p, to: q, at_m, width_m } if [p, q] == [from, to] => Some((at_m, width_m)),
            Place::Hosted { from: p, to: q, at_m, width_m } if [p, q] == [to, from] => Some((length_m - at_m, width_m)),
            _ => None,
        })
        .map(|(at_m, width_m)| (at_m - width_m / 2.0, at_m + width_m / 2.0))
        .collect();
    taken.sort_by(|p, q| p.0.total_cmp(&q.0));
    taken.push((length_m, length_m));
    // Free stretches from one to the next, and the nearest place in one that is wide enough.
    let mut free_from_m = 0.0_f64;
    let mut nearest_m: Option<f64> = None;
    for (start_m, end_m) in taken {
        let (least_m, most_m) = (free_from_m + width_m / 2.0, start_m - width_m / 2.0);
        if most_m >= least_m - GRID_M / 2.0 {
            let here_m = at_m.clamp(least_m, most_m.max(least_m));
            // Of two as near, the first: rounding does not decide.
            if nearest_m.is_none_or(|nearest_m| (here_m - at_m).abs() < (nearest_m - at_m).abs() - GRID_M / 2.0) {
                nearest_m = Some(here_m);
            }
        }
        free_from_m = free_from_m.max(end_m);
    }
    match nearest_m {
        Some(at_m) => Ok(Place::Hosted { from, to, at_m: trim_m(at_m), width_m }),
        None => fail(format!("the openings of this wall leave no {width_m} m for another; make it narrower")),
    }
}

/// The collinear edges of walls and boundaries that an edge is part of, in its direction, from the
/// first to the last; what lies aside by no more than a notch counts as collinear.
fn run_of(plan: &Plan, from: CornerId, to: CornerId) -> Vec<(CornerId, CornerId)> {
    let mut run = vec![(from, to)];
    let (Some(a), Some(b)) = (plan.position(from), plan.position(to)) else { return run };
    let Some(along) = (b - a).unit() else { return run };
    let aside = |point: Point| (point - a).dot(along.left()).abs();
    // By the corner they start at, the nearest end first.
    let mut onward: BTreeMap<CornerId, (f64, CornerId)> = BTreeMap::new();
    let mut backward: BTreeMap<CornerId, (f64, CornerId)> = BTreeMap::new();
    let mut note = |map_forward: bool, p: CornerId, q: CornerId, length_m: f64| {
        let map = if map_forward { &mut onward } else { &mut backward };
        let entry = map.entry(p).or_insert((length_m, q));
        if length_m < entry.0 {
            *entry = (length_m, q);
        }
    };
    for (p, q) in plan_edges(plan) {
        let (Some(start), Some(end)) = (plan.position(p), plan.position(q)) else { continue };
        if aside(start) > NOTCH_M || aside(end) > NOTCH_M || ordered(p, q) == ordered(from, to) {
            continue;
        }
        let (first, last) = if (end - start).dot(along) >= 0.0 { (p, q) } else { (q, p) };
        let length_m = start.distance(end);
        if length_m > 0.0 && (end - start).dot(along).abs() > 0.9 * length_m {
            note(true, first, last, length_m);
            note(false, last, first, length_m);
        }
    }
    let mut end = to;
    while let Some((_, next)) = onward.remove(&end) {
        run.push((end, next));
        end = next;
    }
    let mut start = from;
    while let Some((_, next)) = backward.remove(&start) {
        run.insert(0, (next, start));
        start = next;
    }
    run
}

/// An opening that would be placed and what it would join.
#[derive(Clone, Debug)]
pub struct OpeningPreview {
    pub opening: Opening,
    pub segment: Segment,
    /// The two sides, the left of the segment first.
    pub sides: [Joint; 2],
}

/// What [`place_opening`] would add, with what it would join; `shapes` are those of the plan.
///
/// # Errors
/// As [`opening_at`].
pub fn opening_preview(
    plan: &Plan,
    shapes: &RoomShapes,
    kind: OpeningKind,
    at: Point,
    width_m: f64,
    reach_m: f64,
    swing_towards: Option<Point>,
) -> Result<OpeningPreview, EditError> {
    let opening = opening_at(plan, kind, at, width_m, reach_m, swing_towards)?;
    let segment = plan.opening_segment(&opening).ok_or_else(|| EditError("the wall has no length".to_owned()))?;
    let sides = sides_by_geometry(plan, shapes, &opening);
    Ok(OpeningPreview { opening, segment, sides })
}
