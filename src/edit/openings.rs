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

/// The opening that [`place_opening`] would add: for a preview.
///
/// It goes on the nearest wall or, if no wall is within `reach_m`, on the nearest room boundary, its
/// middle as close to `at` as its width allows: inside the edge if it fits. On a shorter edge it extends
/// over the collinear edges beside it, and is made narrower only if these are too short as well. A door
/// opens to the side of the point `swing_towards`, hinged at the end nearer to it.
///
/// # Errors
/// When nothing that can host an opening is within reach, other openings leave no space on its edge, or
/// the width is invalid.
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

/// The same on a known edge: for callers that have already found it.
///
/// # Errors
/// When the edge has no length, other openings leave no space on it, or the width is invalid.
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

/// Slides an opening along its wall, over all its collinear edges, as close to a point as possible; a
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

/// Sets an opening's width in metres; its middle stays in place if the wall allows.
///
/// # Errors
/// When the opening does not exist, or the width is invalid.
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

/// Sets an opening's kind; if it is no longer a door, it loses its swing.
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

/// Sets how a door's leaf opens; `None` leaves it to the drawing code.
///
/// # Errors
/// When the opening does not exist.
pub fn set_swing(plan: &Plan, id: OpeningId, swing: Option<Swing>) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| opening.swing = swing)
}

/// Moves a door's hinge to its other end. `shown` is the swing as drawn, for a door whose swing is left
/// to the drawing code.
///
/// # Errors
/// When the opening does not exist.
pub fn flip_hinge(plan: &Plan, id: OpeningId, shown: Swing) -> Result<Plan, EditError> {
    with_opening(plan, id, |opening| {
        let swing = opening.swing.unwrap_or(shown);
        opening.swing = Some(Swing { hinge_at_start: !swing.hinge_at_start, ..swing });
    })
}

/// Makes a door open to its other side; `shown` as for [`flip_hinge`].
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

/// Checks an opening's width in metres: from the grid step up to what no building exceeds (the limit of
/// the invariants).
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

/// The edge nearest to a point within `reach_m`; the first, if equally near.
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

/// An opening's place on an edge, its middle as close to a point as its width allows.
pub(super) fn fitted(
    plan: &Plan,
    (from, to): (CornerId, CornerId),
    at: Point,
    width_m: f64,
) -> Result<Place, EditError> {
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
        // How far the collinear edges extend before and after this one.
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

/// A place on an edge, shifted along it as little as necessary not to overlap its other openings; one
/// that extends past the edge's ends stays.
pub(super) fn beside_others(plan: &Plan, place: Place) -> Result<Place, EditError> {
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
    // The free stretches between openings, and the nearest position in one that is wide enough.
    let mut free_from_m = 0.0_f64;
    let mut nearest_m: Option<f64> = None;
    for (start_m, end_m) in taken {
        let (least_m, most_m) = (free_from_m + width_m / 2.0, start_m - width_m / 2.0);
        if most_m >= least_m - GRID_M / 2.0 {
            let here_m = at_m.clamp(least_m, most_m.max(least_m));
            // If two are equally near, the first: rounding must not decide.
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

/// The collinear edges of walls and boundaries that an edge is part of, in its direction, from first to
/// last; offsets up to a notch count as collinear.
pub(super) fn run_of(plan: &Plan, from: CornerId, to: CornerId) -> Vec<(CornerId, CornerId)> {
    let mut run = vec![(from, to)];
    let (Some(a), Some(b)) = (plan.position(from), plan.position(to)) else { return run };
    let Some(along) = (b - a).unit() else { return run };
    let aside = |point: Point| (point - a).dot(along.left()).abs();
    // By starting corner, the nearest end first.
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

/// An opening to be placed and what it would join.
#[derive(Clone, Debug)]
pub struct OpeningPreview {
    pub opening: Opening,
    pub segment: Segment,
    /// The two sides, the left of the segment first.
    pub sides: [Joint; 2],
}

/// What [`place_opening`] would add and what it would join; `shapes` are those of the plan.
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
