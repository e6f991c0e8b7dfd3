//! Drawing a room where no room is yet.

use std::collections::BTreeSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::RoomShapes;
use super::draw::{add_walls, closed, lay_ring, without_unused};
use super::fill::{Boundary, EdgeFaces, is_sliver};
use super::shapes::RoomShape;
use crate::geometry::areas::{self, Shapes};
use crate::geometry::polygon::{self, Location};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, Point, Segment, TOUCH_M};
use crate::plan::edit::lay::{Laid, lay};
use crate::plan::edit::{self, EditError, fail};
use crate::plan::{CornerId, Plan, Room, RoomId, ordered};

/// What is left between drawn rooms is no part of a new one where it is narrower than this, in
/// metres: neighbours in real drawings leave gaps of some centimetres up to the thickness of an inner
/// wall (`data`: rooms are drawn one by one).
pub const GAP_BETWEEN_ROOMS_M: f64 = 0.3;

/// Draws a room with what of an area no room covers yet; holes are left where rooms lie inside it.
///
/// Of several pieces the largest becomes the room. Arms that reach between or along existing rooms
/// and are narrower than `gap_m` (see [`GAP_BETWEEN_ROOMS_M`]) are cut off; slivers are dropped.
/// Edges along rooms are shared with them. Walls as for [`super::draw_room`].
///
/// # Errors
/// When the boundary crosses itself or encloses nothing, lies outside the drawing area, or rooms
/// cover all of it.
pub fn draw_room_in_free_space(
    plan: &Plan,
    outer: &[Point],
    wall_thickness_m: Option<f64>,
    gap_m: f64,
) -> Result<(Plan, RoomId), EditError> {
    // Alone on an empty plan: whether it is a boundary at all.
    let (alone, ring) = lay_ring(&Plan::default(), outer)?;
    let outer = alone.ring_points(&ring);
    let shapes = RoomShapes::new(plan);
    let near: Vec<&RoomShape> =
        shapes.near(polygon::bounds(&outer).inflated(TOUCH_M)).into_iter().map(|index| &shapes.all()[index]).collect();
    let free = free_pieces(&outer, &near, gap_m);
    let largest = free
        .into_iter()
        .filter(|(outer, holes)| !is_sliver(outer, holes))
        .max_by(|(p, in_p), (q, in_q)| polygon::area(p, in_p).total_cmp(&polygon::area(q, in_q)));
    let Some((outer, holes)) = largest else { return fail("rooms cover this place already") };
    let LaidArea { plan: mut next, boundary: Boundary { outer, holes }, corners } = lay_area(plan, &outer, &holes)?;
    if let Some(thickness_m) = wall_thickness_m {
        for ring in std::iter::once(&outer).chain(&holes) {
            next = add_walls(&next, &[(&closed(ring), thickness_m)])?.0;
        }
    }
    let (next, id) = edit::add_room(&next, Room { outer, holes, ..Room::default() })?;
    Ok((without_unused(plan, &next, &corners), id))
}

/// An area laid into a plan.
pub(super) struct LaidArea {
    pub plan: Plan,
    pub boundary: Boundary,
    /// All corners that its rings came through, used or not.
    pub corners: Vec<CornerId>,
}

/// Lays the boundary of an area with holes into a plan, see [`lay`].
///
/// # Errors
/// When it lies outside the drawing area, or encloses nothing.
pub(super) fn lay_area(plan: &Plan, outer: &[Point], holes: &[Vec<Point>]) -> Result<LaidArea, EditError> {
    let rings = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice));
    let paths: Vec<Vec<Point>> = rings.map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
    let Laid { plan: laid, chains } = lay(plan, &paths)?;
    let edges = chains.iter().flat_map(|chain| chain.windows(2)).map(|pair| ordered(pair[0], pair[1]));
    // Rounding may pinch a narrow place: the largest face of what is left is the area.
    let faces = EdgeFaces::new(&laid, edges.collect::<BTreeSet<_>>())?;
    let area = |i: usize| {
        let (outer, holes) = faces.positions(i);
        polygon::area(&outer, &holes)
    };
    let inside = |&i: &usize| polygon::locate(outer, holes, faces.interior_point(i)) == Location::Inside;
    let largest = (0..faces.count()).filter(inside).max_by(|&p, &q| area(p).total_cmp(&area(q)));
    let (plan, boundaries) = faces.boundaries(largest.as_slice())?;
    match boundaries.into_iter().next() {
        Some(boundary) => Ok(LaidArea { plan, boundary, corners: chains.into_iter().flatten().collect() }),
        None => fail("the boundary encloses nothing"),
    }
}

/// A room's rings as an area.
pub(super) fn oriented(room: &RoomShape) -> impl Iterator<Item = areas::Ring> + '_ {
    room.rings().enumerate().map(|(i, ring)| areas::directed(ring, i == 0))
}

/// The pieces of an area that no room covers, without narrow arms along rooms.
fn free_pieces(outer: &[Point], rooms: &[&RoomShape], gap_m: f64) -> Vec<(Vec<Point>, Vec<Vec<Point>>)> {
    let area: Shapes = vec![vec![areas::ring(outer)]];
    let covered: Vec<areas::Ring> = rooms.iter().flat_map(|room| oriented(room)).collect();
    let mut free = areas::without(area, &covered);
    let reach_m = gap_m / 2.0;
    if rooms.is_empty() || reach_m <= 0.0 {
        return areas::pieces(&free);
    }
    // Opening (shrunk, then grown by the same) leaves out what is narrower than the gap.
    let wide = areas::grown(&areas::grown(&areas::cleaned(&free), -reach_m), reach_m);
    if wide.is_empty() {
        // All of it is narrow: a shaft, drawn on purpose.
        return areas::pieces(&free);
    }
    let edges = rooms.iter().flat_map(|room| room.rings()).flat_map(|ring| polygon::edges(ring));
    let edges = SegmentIndex::new(edges.collect());
    let along_rooms = |ring: &Vec<Point>| -> f64 {
        polygon::edges(ring).filter(|&edge| runs_along(edge, &edges)).map(Segment::length).sum()
    };
    let narrow = free.overlay(&wide, OverlayRule::Difference, FillRule::NonZero);
    let arms: Vec<areas::Ring> = areas::pieces(&narrow)
        .into_iter()
        .filter(|(outer, holes)| {
            let rings = || std::iter::once(outer).chain(holes);
            let perimeter_m: f64 = rings().map(|ring| polygon::perimeter(ring)).sum();
            rings().map(along_rooms).sum::<f64>() > ARM_SHARE * perimeter_m
        })
        .flat_map(|(outer, holes)| {
            std::iter::once(areas::directed(&outer, true))
                .chain(holes.iter().map(|hole| areas::directed(hole, false)))
                .collect::<Vec<_>>()
        })
        .collect();
    free = areas::without(free, &arms);
    // Cutting along the same lines twice leaves threads as thin as rounding.
    let threadless = areas::cleaned(&free).simplify_shape(FillRule::NonZero);
    areas::pieces(&threadless)
}

/// A narrow part is an arm along rooms when more than this share of its boundary is theirs: both
/// sides of a gap between two rooms are, one side of a strip beside one room; the tip of a sharp
/// corner that the person drew in the open is not.
const ARM_SHARE: f64 = 0.3;

/// Whether the middle of an edge lies on one of the edges indexed.
fn runs_along(edge: Segment, edges: &SegmentIndex) -> bool {
    let middle = edge.midpoint();
    edges.near(Bounds::of([middle]).inflated(TOUCH_M)).any(|index| edges.get(index).distance(middle) <= TOUCH_M)
}
