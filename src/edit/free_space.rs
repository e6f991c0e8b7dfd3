//! Drawing a room in the space not covered by rooms.

use std::collections::BTreeSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;

use crate::edit::draw::{add_walls, added, closed, overlay_ring, without_leftovers};
use crate::edit::fill::Boundary;
use crate::edit::overlay::{Overlay, overlay_paths};
use crate::edit::{self, EditError, fail};
use crate::geometry::areas::{self, Shapes};
use crate::geometry::polygon::{self, Location};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, GRID_M, Point, Segment, TOUCH_M};
use crate::plan::{CornerId, Plan, Room, RoomId, ordered};
use crate::topology::RoomShape;
use crate::topology::RoomShapes;
use crate::topology::plan_faces::{EdgeFaces, is_sliver};

/// Space between rooms that is at most this wide, in metres, is not made part of a new room: in real
/// drawings neighbours leave gaps from a few centimetres to the thickness of an inner wall (in the
/// paper's data, rooms are drawn one by one).
pub const GAP_BETWEEN_ROOMS_M: f64 = 0.3;

/// A piece of what is free is a room of its own where it is larger than this, in square metres: smaller ones are what
/// is left at the edge of a generous stroke. No round number: rounding never decides.
const LEAST_PIECE_M2: f64 = 0.2497;

/// Nor is a piece of less than this share of the largest: over a scan, what a rectangle leaves beside its neighbours is a
/// remnant of a wall or a niche.
const LEAST_SHARE: f64 = 0.25;

/// Rooms that were drawn where no room was.
#[derive(Clone, Debug)]
pub struct DrawnInFreeSpace {
    pub plan: Plan,
    /// The new rooms, the largest first; never empty.
    pub rooms: Vec<RoomId>,
    /// Free pieces that became no room, in square metres together.
    pub left_out_m2: f64,
}

/// Draws a room with what of an area no room covers yet; holes are left where rooms lie inside it.
///
/// Where that is in several pieces each becomes a room, but for those that are smaller than any room. Arms that reach
/// between or along existing rooms and are no wider than `gap_m` (see [`GAP_BETWEEN_ROOMS_M`]) are cut off; slivers are
/// dropped. Edges along rooms are shared with them. Walls as for [`super::draw_room`].
///
/// # Errors
/// When the boundary crosses itself or encloses nothing, lies outside the drawing area, or rooms
/// cover all of it.
pub fn draw_room_in_free_space(
    plan: &Plan,
    outer: &[Point],
    wall_thickness_m: Option<f64>,
    gap_m: f64,
) -> Result<DrawnInFreeSpace, EditError> {
    // Alone on an empty plan: whether it is a boundary at all.
    let (alone, ring) = overlay_ring(&Plan::default(), outer)?;
    let outer = alone.ring_points(&ring);
    let shapes = RoomShapes::new(plan);
    let near: Vec<&RoomShape> =
        shapes.near(polygon::bounds(&outer).inflated(TOUCH_M)).into_iter().map(|index| &shapes.all()[index]).collect();
    let free = free_pieces(&outer, &near, gap_m);
    let mut pieces: Vec<_> = free
        .into_iter()
        .filter(|(outer, holes)| !is_sliver(outer, holes))
        .map(|(outer, holes)| (polygon::area(&outer, &holes), outer, holes))
        .collect();
    pieces.sort_by(|(p, ..), (q, ..)| q.total_cmp(p));
    if pieces.is_empty() {
        return fail("rooms cover this place already");
    }
    let mut drawn = DrawnInFreeSpace { plan: plan.clone(), rooms: Vec::new(), left_out_m2: 0.0 };
    let mut corners = Vec::new();
    let least_m2 =
        pieces.first().map_or(LEAST_PIECE_M2, |(largest_m2, ..)| (largest_m2 * LEAST_SHARE).max(LEAST_PIECE_M2));
    for (area_m2, outer, holes) in pieces {
        if !drawn.rooms.is_empty() && area_m2 < least_m2 {
            drawn.left_out_m2 += area_m2;
            continue;
        }
        match draw_piece(&drawn.plan, &outer, &holes, wall_thickness_m) {
            Ok((next, id, laid)) => {
                drawn.plan = next;
                drawn.rooms.push(id);
                corners.extend(laid);
            }
            Err(error) if drawn.rooms.is_empty() => return Err(error),
            Err(_) => drawn.left_out_m2 += area_m2,
        }
    }
    drawn.plan = without_leftovers(plan, &drawn.plan, added(plan, &corners));
    Ok(drawn)
}

/// Draws one piece of what is free; also gives the corners that its rings came through.
fn draw_piece(
    plan: &Plan,
    outer: &[Point],
    holes: &[Vec<Point>],
    wall_thickness_m: Option<f64>,
) -> Result<(Plan, RoomId, Vec<CornerId>), EditError> {
    let OverlayArea { plan: mut next, boundary: Boundary { outer, holes }, corners } =
        overlay_area(plan, outer, holes)?;
    if let Some(thickness_m) = wall_thickness_m {
        for ring in std::iter::once(&outer).chain(&holes) {
            next = add_walls(&next, &[(&closed(ring), thickness_m)])?.0;
        }
    }
    let (next, id) = edit::add_room(&next, Room { outer, holes, ..Room::default() })?;
    Ok((next, id, corners))
}

/// An area overlaid on a plan.
pub(crate) struct OverlayArea {
    pub plan: Plan,
    pub boundary: Boundary,
    /// All corners that its rings pass through, used or not.
    pub corners: Vec<CornerId>,
}

/// Overlays the boundary of an area with holes on a plan, see [`overlay_paths`].
///
/// # Errors
/// When it lies outside the drawing area, or encloses nothing.
pub(crate) fn overlay_area(plan: &Plan, outer: &[Point], holes: &[Vec<Point>]) -> Result<OverlayArea, EditError> {
    let rings = std::iter::once(outer).chain(holes.iter().map(Vec::as_slice));
    let paths: Vec<Vec<Point>> = rings.map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
    let Overlay { plan: overlaid, chains } = overlay_paths(plan, &paths)?;
    let edges = chains.iter().flat_map(|chain| chain.windows(2)).map(|pair| ordered(pair[0], pair[1]));
    // Rounding may pinch a narrow place: the largest remaining face is the area.
    let faces = EdgeFaces::new(&overlaid, edges.collect::<BTreeSet<_>>())?;
    let area = |i: usize| {
        let (outer, holes) = faces.positions(i);
        polygon::area(&outer, &holes)
    };
    let inside = |&i: &usize| polygon::locate(outer, holes, faces.interior_point(i)) == Location::Inside;
    let largest = (0..faces.count()).filter(inside).max_by(|&p, &q| area(p).total_cmp(&area(q)));
    let (plan, boundaries) = faces.boundaries(largest.as_slice())?;
    match boundaries.into_iter().next() {
        Some(boundary) => Ok(OverlayArea { plan, boundary, corners: chains.into_iter().flatten().collect() }),
        None => fail("the boundary encloses nothing"),
    }
}

/// A room's rings as an area.
pub(crate) fn oriented(room: &RoomShape) -> impl Iterator<Item = areas::Ring> + '_ {
    room.rings().enumerate().map(|(i, ring)| areas::directed(ring, i == 0))
}

/// The pieces of an area that no room covers, without narrow arms along rooms; on the grid.
fn free_pieces(outer: &[Point], rooms: &[&RoomShape], gap_m: f64) -> Vec<(Vec<Point>, Vec<Vec<Point>>)> {
    // As if the area were at the origin: so the result is the same wherever it lies, to the last digit.
    let origin = polygon::bounds(outer).min;
    let here = |ring: &[Point]| -> Vec<Point> {
        ring.iter().map(|&point| (Point::default() + (point - origin)).trimmed()).collect()
    };
    let there = |ring: &[Point]| -> Vec<Point> {
        ring.iter().map(|&point| (point.trimmed() + (origin - Point::default())).trimmed()).collect()
    };
    let rooms: Vec<Vec<Vec<Point>>> = rooms.iter().map(|room| room.rings().map(|ring| here(ring)).collect()).collect();
    areas::pieces(&free_shapes(&here(outer), &rooms, gap_m))
        .iter()
        .map(|(outer, holes)| (there(outer), holes.iter().map(|hole| there(hole)).collect()))
        .collect()
}

/// The result of [`free_pieces`], for rooms given as rings, outer ring first.
fn free_shapes(outer: &[Point], rooms: &[Vec<Vec<Point>>], gap_m: f64) -> Shapes {
    let covered: Vec<areas::Ring> = rooms
        .iter()
        .flat_map(|rings| rings.iter().enumerate().map(|(i, ring)| areas::directed(ring, i == 0)))
        .collect();
    let free = areas::without(vec![vec![areas::ring(outer)]], &covered);
    if rooms.is_empty() || gap_m <= 0.0 {
        return free;
    }
    let wide = areas::opening(&free, (gap_m + BETWEEN_GRID_M) / 2.0);
    if wide.is_empty() {
        // All of it is narrow: a shaft, drawn on purpose.
        return free;
    }
    let edges = SegmentIndex::new(rooms.iter().flatten().flat_map(|ring| polygon::edges(ring)).collect());
    // The opened shape has the same edges up to rounding, which leaves threads along them; these would
    // join separate narrow parts.
    let narrow = areas::opening(&free.overlay(&wide, OverlayRule::Difference, FillRule::NonZero), THREAD_M / 2.0);
    let arms: Shapes = narrow.into_iter().filter(|part| is_along(part, &edges)).collect();
    if arms.is_empty() {
        return free;
    }
    // Slightly more than the arms, so that no thread joins what lies beyond them, but none of the wide
    // part.
    let cut = areas::offset(&arms, THREAD_M / 2.0).overlay(&wide, OverlayRule::Difference, FillRule::NonZero);
    let left = free.overlay(&cut, OverlayRule::Difference, FillRule::NonZero);
    areas::without_slivers(&left).simplify_shape(FillRule::NonZero)
}

/// Added to the gap: drawn lengths are multiples of the grid, so rounding never decides whether a strip
/// exactly as wide as the gap is narrow.
const BETWEEN_GRID_M: f64 = 4.5 * GRID_M;

/// Anything narrower is a rounding artefact, not part of an area; below [`TOUCH_M`], between two lengths
/// on the grid.
const THREAD_M: f64 = 8.5 * GRID_M;

/// A narrow part is an arm along rooms if more than this share of its boundary is theirs: true for both
/// sides of a gap between two rooms, and about half of a strip beside one room, but not for the tip of a
/// sharp corner drawn in the open. Not a simple fraction: a strip that ends in the open has the share L /
/// (2 L + 2 W), which would equal one for some W on the grid.
const ARM_SHARE: f64 = 0.2937;

/// Whether an area is an arm along the edges of rooms.
fn is_along(area: &[areas::Ring], edges: &SegmentIndex) -> bool {
    let rings: Vec<Vec<Point>> = area.iter().map(areas::points).collect();
    let perimeter_m: f64 = rings.iter().map(|ring| polygon::perimeter(ring)).sum();
    let along_m: f64 = rings.iter().flat_map(|ring| polygon::edges(ring)).map(|edge| length_along(edge, edges)).sum();
    along_m > ARM_SHARE * perimeter_m
}

/// The length in metres over which an edge runs within [`TOUCH_M`] of others, however these are split.
fn length_along(edge: Segment, others: &SegmentIndex) -> f64 {
    let near = others.near(edge.bounds().inflated(TOUCH_M)).map(|index| others.get(index));
    let mut parts: Vec<(f64, f64)> = near.filter_map(|other| part_along(edge, other)).collect();
    parts.sort_by(|p, q| p.0.total_cmp(&q.0));
    let (mut share, mut counted_to) = (0.0, 0.0_f64);
    for (from, to) in parts {
        share += (to - from.max(counted_to)).max(0.0);
        counted_to = counted_to.max(to);
    }
    share * edge.length()
}

/// The stretch over which an edge runs within [`TOUCH_M`] of another, as fractions.
fn part_along(edge: Segment, other: Segment) -> Option<(f64, f64)> {
    let along = other.vector().unit()?;
    let seen = |point: Point| Point::new((point - other.a).dot(along), (point - other.a).dot(along.left()));
    Bounds::of([seen(other.a), seen(other.b)]).inflated(TOUCH_M).part_of(Segment::new(seen(edge.a), seen(edge.b)))
}
