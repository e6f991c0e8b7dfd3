//! The walls in section: the area an architect fills black. Drawn walls are joined with mitres; imported
//! rooms without walls get walls along their boundaries, so that the building reads as a whole.

use std::collections::BTreeSet;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;
use i_overlay::mesh::float::stroke::offset::StrokeOffset as _;
use i_overlay::mesh::float::style::{LineJoin, StrokeStyle};
use rstar::primitives::Line;
use rstar::{AABB, RTree};

use super::elements::RoomDrawing;
use super::tile_grid::TileGrid;
use crate::geometry::areas::{self, Ring, SHARPEST_RAD, Shapes, area_m2, directed, offset, points, without_slivers};
use crate::geometry::tangle::{LineTree, entry, one_line_in, segment_of, tangled};
use crate::geometry::{Bounds, Point, Segment, Vector, polygon};
use crate::plan::{Plan, THICKEST_WALL_M, WallId};
use crate::topology::wall_bodies::{self, WallBodies};

/// The walls of a plan before openings are cut out.
pub(super) struct Walls {
    /// Tile by tile; without tiles, all in one.
    pub solid: Vec<Shapes>,
    /// Walls without thickness.
    pub lines: Vec<Segment>,
    /// Boundaries of rooms without a wall.
    pub boundaries: Vec<Segment>,
    /// Indices of the rooms that came without walls.
    pub unwalled: Vec<usize>,
    /// The number of walls and room boundaries that are tangled, and drawn as lines.
    pub tangled: usize,
}

/// Half the thickness in metres of the wall drawn along a boundary that came without walls: that of a
/// light partition, 0.1 m, which covers little of rooms that meet on the wall's centre line.
const HALF_PARTITION_M: f64 = 0.05;

/// How far the outermost wall of an import extends beyond its rooms, in metres: where rooms meet on
/// centre lines, and where they are drawn to the walls' faces.
const OUTER_WALL_M: [f64; 2] = [0.10, 0.25];

/// The side of a room of usual size in metres. Imports whose median room is far from it have a doubtful
/// scale (in the paper's data the median classroom of a school ranges from 24 to 255 m²), so their walls
/// are drawn thicker or thinner in proportion, within limits.
const USUAL_ROOM_M: f64 = 3.0;

impl Walls {
    /// The walls of a plan, which have these bodies, cut at tile borders.
    pub fn new(plan: &Plan, bodies: &WallBodies, rooms: &[RoomDrawing], grid: Option<&TileGrid>) -> Self {
        let mut index = WallIndex::new(plan, bodies);
        let mut boundaries = Vec::new();
        let mut unwalled = Vec::new();
        for (i, room) in rooms.iter().enumerate() {
            let open = index.uncovered(room);
            // Not touched by any wall: the room came without walls.
            if open.whole && !room.outer.is_empty() {
                unwalled.push(i);
            } else {
                boundaries.extend(open.pieces);
            }
        }
        let unwalled_count = unwalled.len();
        let mut tangle = tangled_rooms(rooms, &mut unwalled);
        boundaries.append(&mut tangle);
        let tangled = unwalled_count - unwalled.len() + bodies.tangled.len();
        let mut rings = bodies.rings.clone();
        let derived = (!unwalled.is_empty()).then(|| Derived::new(rooms, &unwalled)).map(|derived| {
            boundaries.extend(derived.railings);
            derived.solid
        });
        let solid = match grid {
            Some(grid) => {
                rings.extend(derived.into_iter().flatten().flatten());
                in_tiles(rings, grid)
            }
            None => {
                let mut solid = if rings.is_empty() { Shapes::new() } else { rings.simplify_shape(FillRule::NonZero) };
                if let Some(derived) = derived {
                    rings = solid.drain(..).chain(derived).flatten().collect();
                    solid = rings.simplify_shape(FillRule::NonZero);
                }
                vec![solid]
            }
        };
        Self { solid, lines: std::mem::take(&mut index.lines), boundaries, unwalled, tangled }
    }
}

/// Removes the rooms with tangled boundaries from `unwalled`; returns these boundaries.
fn tangled_rooms(rooms: &[RoomDrawing], unwalled: &mut Vec<usize>) -> Vec<Segment> {
    let edges_of = |room: usize| rooms[room].rings().flat_map(|ring| polygon::edges(ring));
    let edges: Vec<(usize, Segment)> =
        unwalled.iter().flat_map(|&room| edges_of(room).map(move |edge| (room, edge))).collect();
    let segments: Vec<Segment> = edges.iter().map(|(_, edge)| *edge).collect();
    let is_tangled = tangled(&segments, &RTree::bulk_load(segments.iter().map(|&edge| entry(edge, ())).collect()));
    let rooms: BTreeSet<usize> =
        edges.iter().zip(&is_tangled).filter(|(_, is_tangled)| **is_tangled).map(|((room, _), _)| *room).collect();
    unwalled.retain(|room| !rooms.contains(room));
    rooms.into_iter().flat_map(edges_of).collect()
}

/// Counter-clockwise rings as polygons cut at tile borders, tile by tile.
fn in_tiles(rings: Vec<Ring>, grid: &TileGrid) -> Vec<Shapes> {
    by_tile(rings, grid)
        .into_iter()
        .enumerate()
        .map(|(tile, rings)| {
            if rings.is_empty() {
                return Shapes::new();
            }
            // No larger than what is cut: the polygon library's raster spans everything it is given.
            let around = rings.iter().flatten().fold(Bounds::EMPTY, |box_m, &[x, y]| box_m.with(Point::new(x, y)));
            let (tile, around) = (grid.bounds(tile), around.inflated(1.0));
            let (left, right) = (tile.min.x.max(around.min.x), tile.max.x.min(around.max.x));
            let (low, high) = (tile.min.y.max(around.min.y), tile.max.y.min(around.max.y));
            let square: Ring = vec![[left, low], [right, low], [right, high], [left, high]];
            rings.overlay(&[square], OverlayRule::Intersect, FillRule::NonZero)
        })
        .collect()
}

/// Rings by the tiles their bounding boxes meet: a ring that winds around no point of a tile does not
/// matter there.
fn by_tile(rings: Vec<Ring>, grid: &TileGrid) -> Vec<Vec<Ring>> {
    let mut tiles: Vec<Vec<Ring>> = vec![Vec::new(); grid.count()];
    for ring in rings {
        for tile in grid.meeting(Bounds::of(ring.iter().map(|&[x, y]| Point::new(x, y)))) {
            if !lies_beside(&ring, grid.bounds(tile)) {
                tiles[tile].push(ring.clone());
            }
        }
    }
    tiles
}

/// Whether an edge separates a box from the whole ring: a long oblique wall meets few of the tiles in its
/// bounding box.
fn lies_beside(ring: &Ring, box_m: Bounds) -> bool {
    const MOST_POINTS: usize = 8;
    if ring.len() > MOST_POINTS {
        return false;
    }
    let point = |&[x, y]: &[f64; 2]| Point::new(x, y);
    let corners = [box_m.min, box_m.max, Point::new(box_m.min.x, box_m.max.y), Point::new(box_m.max.x, box_m.min.y)];
    (0..ring.len()).any(|i| {
        let (from, to) = (point(&ring[i]), point(&ring[(i + 1) % ring.len()]));
        let side = |at: Point| (to - from).cross(at - from);
        ring.iter().all(|at| side(point(at)) >= 0.0) && corners.iter().all(|&at| side(at) < 0.0)
    })
}

/// Walls, tile by tile, minus the given counter-clockwise rings.
pub(super) fn without(solid: Vec<Shapes>, cuts: Vec<Ring>, grid: Option<&TileGrid>) -> Vec<Shapes> {
    let cuts = match grid {
        None => vec![cuts],
        Some(grid) => by_tile(cuts, grid),
    };
    solid.into_iter().zip(cuts).map(|(shapes, cuts)| areas::without(shapes, &cuts)).collect()
}

/// A spatial index of the drawn walls.
struct WallIndex {
    tree: LineTree<f64>,
    /// Walls without thickness, and tangled ones.
    lines: Vec<Segment>,
}

/// The parts of a room's boundary not covered by walls.
struct Uncovered {
    pieces: Vec<Segment>,
    whole: bool,
}

impl WallIndex {
    fn new(plan: &Plan, bodies: &WallBodies) -> Self {
        let walls: Vec<(WallId, f64, Segment)> = wall_bodies::axes(plan).collect();
        let entries = walls.iter().map(|&(_, thickness_m, segment)| entry(segment, thickness_m / 2.0));
        let tree = RTree::bulk_load(entries.collect());
        let (step, mut seen) = (one_line_in(bodies.tangled.len()), 0);
        let mut lines = Vec::new();
        for (id, thickness_m, segment) in walls {
            let is_tangled = bodies.tangled.contains(&id);
            seen += usize::from(is_tangled);
            if (thickness_m <= 0.0 && !is_tangled) || (is_tangled && seen.is_multiple_of(step)) {
                lines.push(segment);
            }
        }
        Self { tree, lines }
    }

    /// The parts of a room's boundary that lie on no wall.
    fn uncovered(&self, room: &RoomDrawing) -> Uncovered {
        let mut uncovered = Uncovered { pieces: Vec::new(), whole: true };
        for edge in room.rings().flat_map(|ring| polygon::edges(ring)) {
            let length = edge.length();
            let Some(along) = edge.vector().unit() else { continue };
            let mut covered: Vec<(f64, f64)> = Vec::new();
            // Within a wall's thickness, and at most half the thickest plausible wall away.
            let bounds = edge.bounds().inflated(THICKEST_WALL_M);
            let near = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
            for wall in self.tree.locate_in_envelope_intersecting(near) {
                let reach = wall.data + COVER_TOLERANCE_M;
                covered.extend(stretch_within(edge, along, length, segment_of(wall), reach));
            }
            uncovered.whole &= covered.iter().all(|(from, to)| to - from < 0.5 * length.min(1.0));
            covered.sort_by(|p, q| p.0.total_cmp(&q.0));
            let mut reached = 0.0;
            for (from, to) in covered.into_iter().chain([(length, length)]) {
                if from - reached > SHORTEST_BOUNDARY_M {
                    uncovered.pieces.push(Segment::new(edge.a + along * reached, edge.a + along * from));
                }
                reached = f64::max(reached, to);
            }
        }
        uncovered
    }
}

/// A boundary counts as lying on a wall up to this distance from its faces, in metres.
const COVER_TOLERANCE_M: f64 = 0.02;

/// Shorter pieces of a boundary are remnants between walls that nearly meet.
const SHORTEST_BOUNDARY_M: f64 = 0.05;

/// The stretch of `edge`, as distances from its start, within `reach` of the axis of a wall, ends
/// included.
fn stretch_within(edge: Segment, along: Vector, length: f64, axis: Segment, reach: f64) -> Option<(f64, f64)> {
    let axis_along = axis.vector().unit()?;
    let offset = edge.a - axis.a;
    // Both the distance from the axis and the position along it are linear in the position on the edge.
    let (from, to) = linear_within(axis_along.cross(offset), axis_along.cross(along), -reach, reach, length)?;
    let (place, rate) = (axis_along.dot(offset), axis_along.dot(along));
    let (first, last) = linear_within(place, rate, -reach, axis.length() + reach, length)?;
    let (from, to) = (from.max(first), to.min(last));
    (from < to).then_some((from, to))
}

/// Where in 0..=`length` the value `start + rate * s` lies within `low..=high`.
fn linear_within(start: f64, rate: f64, low: f64, high: f64, length: f64) -> Option<(f64, f64)> {
    if rate.abs() < 1e-12 {
        return (low..=high).contains(&start).then_some((0.0, length));
    }
    let (p, q) = ((low - start) / rate, (high - start) / rate);
    let (from, to) = (p.min(q).max(0.0), p.max(q).min(length));
    (from < to).then_some((from, to))
}

/// Walls generated for rooms that came without any.
struct Derived {
    solid: Shapes,
    railings: Vec<Segment>,
}

impl Derived {
    fn new(rooms: &[RoomDrawing], unwalled: &[usize]) -> Self {
        let mut indoors: Vec<Ring> = Vec::new();
        let mut outdoors: Vec<Ring> = Vec::new();
        let mut railings = Vec::new();
        let mut areas: Vec<f64> = Vec::new();
        for room in unwalled.iter().map(|&i| &rooms[i]) {
            let rings = room.rings().enumerate().map(|(i, points)| directed(points, i == 0));
            if room.is_open_air() {
                outdoors.extend(rings);
                railings.extend(polygon::edges(&room.outer));
            } else {
                indoors.extend(rings);
                areas.push(room.area_m2);
            }
        }
        areas.sort_by(f64::total_cmp);
        let median_m2 = areas.get(areas.len() / 2).copied().unwrap_or(USUAL_ROOM_M * USUAL_ROOM_M);
        let scale = (median_m2.sqrt() / USUAL_ROOM_M).clamp(0.5, 1.5);

        let rooms_area = without_slivers(&indoors.simplify_shape(FillRule::NonZero));
        // Morphological closing (grow, then shrink back) fills gaps narrower than the thickest wall:
        // between rooms, and between them and balconies.
        let reach = THICKEST_DRAWN_M / 2.0 * scale.min(1.0);
        let closed = |shapes: &Shapes| offset(&offset(shapes, reach), -reach);
        let building = without_spurs(closed(&rooms_area));
        let gaps = if outdoors.is_empty() {
            building.overlay(&rooms_area, OverlayRule::Difference, FillRule::NonZero)
        } else {
            let all: Vec<Ring> = indoors.iter().chain(&outdoors).cloned().collect();
            closed(&without_slivers(&all.simplify_shape(FillRule::NonZero))).overlay(
                &all,
                OverlayRule::Difference,
                FillRule::NonZero,
            )
        };
        // Rooms drawn to the walls' faces leave gaps throughout the building; rooms that meet on centre
        // lines leave none.
        let (gaps_m2, length_m) = (area_m2(&gaps), indoors.iter().map(|ring| polygon::perimeter(&points(ring))).sum());
        let to_faces = gaps_m2 > SHARE_OF_FACES_M * f64::max(length_m, 1.0);
        let outer = OUTER_WALL_M[usize::from(to_faces)] * scale;
        let shell = offset(&building, outer).overlay(&building, OverlayRule::Difference, FillRule::NonZero);
        let partitions = indoors
            .stroke(StrokeStyle::new(2.0 * HALF_PARTITION_M * scale).line_join(LineJoin::Miter(SHARPEST_RAD)), true);
        // Where neighbours overlap by less than a wall, there is a wall: the area covered twice, minus
        // wide parts (a room drawn inside another).
        let overlaps =
            rooms_area.overlay(&indoors.simplify_shape(FillRule::EvenOdd), OverlayRule::Difference, FillRule::NonZero);
        let wide = offset(&offset(&without_slivers(&overlaps), -reach), reach);
        let overlaps = overlaps.overlay(&wide, OverlayRule::Difference, FillRule::NonZero);
        let all: Vec<Ring> = gaps.into_iter().chain(shell).chain(partitions).chain(overlaps).flatten().collect();
        let mut solid: Shapes = all.simplify_shape(FillRule::NonZero);
        if !outdoors.is_empty() {
            solid = solid.overlay(&outdoors, OverlayRule::Difference, FillRule::NonZero);
        }
        solid.retain(|shape| {
            shape.first().is_some_and(|outer| polygon::signed_area(&points(outer)) >= SMALLEST_PIECE_M2 * scale * scale)
        });
        Self { solid, railings }
    }
}

/// Shapes without the spurs that closing leaves where neighbours stand askew by millimetres: grown by a wall's thickness, a
/// spur of no width would become a stub of wall. Shapes that have none stay as they are, to the bit.
///
/// Growing back may overshoot at a corner that is nearly straight; what lies outside the shapes is cut off again.
fn without_spurs(shapes: Shapes) -> Shapes {
    let opened = areas::opening(&shapes, SPUR_M);
    let length_m: f64 = shapes.iter().flatten().map(|ring| polygon::perimeter(&points(ring))).sum();
    let is_same = (area_m2(&shapes) - area_m2(&opened)).abs() <= SPUR_M2_A_METRE * length_m;
    if is_same { shapes } else { without_slivers(&opened.overlay(&shapes, OverlayRule::Intersect, FillRule::NonZero)) }
}

/// Half the width in metres of what counts as a spur.
const SPUR_M: f64 = 0.05;

/// Shapes that lose less area in m² for each metre of their outline have no spur: so much is rounding.
const SPUR_M2_A_METRE: f64 = 2e-6;

/// Gaps between imported rooms up to this width in metres are drawn as walls: a little more than
/// [`crate::plan::THICKEST_WALL_M`], for the masonry of old buildings with plaster on both sides.
const THICKEST_DRAWN_M: f64 = 0.75;

/// A smaller isolated piece of generated wall, in m², is a remnant between rooms drawn askew.
const SMALLEST_PIECE_M2: f64 = 0.2;

/// Gaps between rooms amount to this thickness in metres along all boundaries when rooms are drawn to the
/// walls' faces: each side of a wall of 0.1 m gets half of it, and part of the boundaries is on the
/// outside.
const SHARE_OF_FACES_M: f64 = 0.03;

/// A spatial index of the faces of solid walls, for ray casting.
pub(super) struct Faces {
    tree: RTree<Line<[f64; 2]>>,
}

impl Faces {
    /// The faces of walls, tile by tile, without the cuts between tiles.
    pub fn new(solid: &[Shapes], grid: Option<&TileGrid>) -> Self {
        let mut lines = Vec::new();
        for ring in solid.iter().flatten().flatten() {
            for (i, &from) in ring.iter().enumerate() {
                let to = ring[(i + 1) % ring.len()];
                let is_cut = |grid: &TileGrid| grid.is_cut(Point::new(from[0], from[1]), Point::new(to[0], to[1]));
                if !grid.is_some_and(is_cut) {
                    lines.push(Line::new(from, to));
                }
            }
        }
        Self { tree: RTree::bulk_load(lines) }
    }

    /// Where the line through `origin` along the unit vector `direction` crosses faces within
    /// `-back..=ahead` metres: distances in order, and whether it enters a wall there (otherwise it
    /// leaves one).
    fn crossings(&self, origin: Point, direction: Vector, back: f64, ahead: f64) -> Vec<(f64, bool)> {
        let bounds = Segment::new(origin - direction * back, origin + direction * ahead).bounds();
        let near = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let mut found = Vec::new();
        for line in self.tree.locate_in_envelope_intersecting(near) {
            let (a, b) = (Point::new(line.from[0], line.from[1]), Point::new(line.to[0], line.to[1]));
            let (side_a, side_b) = (direction.cross(a - origin), direction.cross(b - origin));
            // Half-open, so that a line through a shared end crosses once.
            if (side_a > 0.0) == (side_b > 0.0) {
                continue;
            }
            let at = a.lerp(b, side_a / (side_a - side_b));
            let distance = (at - origin).dot(direction);
            if (-back..=ahead).contains(&distance) {
                // A wall is to the left of its faces.
                found.push((distance, side_a > side_b));
            }
        }
        found.sort_by(|p, q| p.0.total_cmp(&q.0));
        found
    }

    /// The extent of the wall at or nearest to `origin` along the unit vector `direction`, within `reach`
    /// metres.
    pub fn wall_at(&self, origin: Point, direction: Vector, reach: f64) -> Option<(f64, f64)> {
        let far = reach + THICKEST_WALL_M;
        let crossings = self.crossings(origin, direction, far, far);
        let mut best: Option<(f64, (f64, f64))> = None;
        for pair in crossings.windows(2) {
            let ((from, enters), (to, enters_again)) = (pair[0], pair[1]);
            if !enters || enters_again {
                continue;
            }
            let distance = if from <= 0.0 && to >= 0.0 { 0.0 } else { from.abs().min(to.abs()) };
            if distance <= reach && best.is_none_or(|(nearest, _)| distance < nearest) {
                best = Some((distance, (from, to)));
            }
        }
        best.map(|(_, wall)| wall)
    }

    /// The free distance from `origin`, which is not in a wall, along the unit vector `direction`, at
    /// most `reach` metres.
    pub fn free(&self, origin: Point, direction: Vector, reach: f64) -> f64 {
        self.crossings(origin, direction, 0.0, reach).first().map_or(reach, |&(distance, _)| distance)
    }

    /// The stretch without walls at or nearest to `origin` along the unit vector `direction`, within
    /// `reach` metres both ways; `None` if all is wall.
    pub fn open_at(&self, origin: Point, direction: Vector, reach: f64) -> Option<(f64, f64)> {
        let crossings = self.crossings(origin, direction, reach, reach);
        let mut stretches = Vec::new();
        // It begins in the open unless the first crossing leaves a wall.
        let mut open_from = crossings.first().is_none_or(|&(_, enters)| enters).then_some(-reach);
        for (distance, enters) in crossings {
            if enters {
                stretches.extend(open_from.take().map(|from| (from, distance)));
            } else {
                open_from = Some(distance);
            }
        }
        stretches.extend(open_from.map(|from| (from, reach)));
        let distance = |&(from, to): &(f64, f64)| if from <= 0.0 && to >= 0.0 { 0.0 } else { from.abs().min(to.abs()) };
        stretches.into_iter().min_by(|p, q| distance(p).total_cmp(&distance(q)))
    }

    /// The faces that meet a box.
    pub fn near(&self, bounds: crate::geometry::Bounds) -> impl Iterator<Item = Segment> + '_ {
        let near = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        self.tree
            .locate_in_envelope_intersecting(near)
            .map(|line| Segment::new(Point::new(line.from[0], line.from[1]), Point::new(line.to[0], line.to[1])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The top of two rooms of a robot's map that stand askew by 2 mm, once closed: a spur at the right, and a corner that
    /// is nearly straight, over which growing back overshoots by 0.19 m.
    #[test]
    fn no_bump_takes_the_place_of_a_spur() {
        let ring: Ring = vec![
            [0.0768, 5.0],
            [9.1299, 5.0],
            [9.129904427313804, 8.718429387426376],
            [9.129902907395362, 8.729599417066574],
            [9.129900731825828, 8.745508403396606],
            [9.129899986767768, 8.729600013113021],
            [4.87039998986721, 8.729800016498565],
            [4.8703938505887985, 8.727576256608963],
            [4.495640047574043, 8.727366865491867],
            [0.07680095055103298, 8.724897743082046],
        ];
        let top_m = |shapes: &Shapes| shapes.iter().flatten().flatten().map(|point| point[1]).fold(0.0, f64::max);
        let shapes = vec![vec![ring]];
        assert!(top_m(&areas::opening(&shapes, SPUR_M)) > 8.9, "the test would show nothing");
        assert!(top_m(&without_spurs(shapes)) < 8.7299);
    }
}
