//! Finds the rooms of a line map (paper, section 3.3): random points in the free space belong to one room
//! if they can see each other past walls and doorways.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::RayGrid;
use super::doorways::{Doorway, DoorwayOptions, Gaps, Groups, gaps, is_inside, walls};
use super::furniture::rectangle;
use super::quadrilaterals::mean_quadrilateral_m2;
use super::width_changes::is_width_change;
use crate::base::random::Random;
use crate::geometry::areas::{self, Ring, Shapes};
use crate::geometry::runs::{self, Axes};
use crate::geometry::{Bounds, Point, Segment, Vector, polygon};

/// Room detection parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomOptions {
    pub doorways: DoorwayOptions,
    /// Random points per square metre.
    pub points_per_m2: f64,
    /// Smaller pieces are not rooms, in m²: a niche, or a leak beside a wall.
    pub smallest_m2: f64,
    pub seed: u64,
}

impl Default for RoomOptions {
    fn default() -> Self {
        Self { doorways: DoorwayOptions::default(), points_per_m2: 4.0, smallest_m2: 0.35, seed: 1 }
    }
}

/// A room found.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundRoom {
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
    /// `a`: the mean of the inner and outer quadrilaterals, in m².
    pub area_m2: f64,
    /// `M` and `m`.
    pub axes: Option<Axes>,
    /// Indices of the random points inside it.
    pub points: Vec<usize>,
}

impl FoundRoom {
    /// As an area.
    pub fn shapes(&self) -> Shapes {
        let holes = self.holes.iter().map(|hole| areas::directed(hole, false));
        vec![std::iter::once(areas::directed(&self.outer, true)).chain(holes).collect()]
    }
}

/// The rooms of a map and the evidence for them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundRooms {
    /// For each segment of the map, the index of its wall; `None` if it is too short.
    pub walls: Vec<Option<usize>>,
    pub doorways: Vec<Doorway>,
    /// The indices of the rooms on the left and right of each doorway.
    pub sides: Vec<[Option<usize>; 2]>,
    /// The random points.
    pub points: Vec<Point>,
    /// Pairs of points that see each other, by index: those that merged two sets.
    pub sights: Vec<[usize; 2]>,
    pub rooms: Vec<FoundRoom>,
}

/// The rooms of the line map `segments` in the free space `free`; deterministic for a given seed.
pub fn find_rooms(segments: &[Segment], free: &Shapes, options: &RoomOptions) -> FoundRooms {
    let boundary = boundary(free);
    let clutter = if options.doorways.must_widen { clutter(free) } else { Vec::new() };
    let structure: Vec<Segment> = segments.iter().copied().filter(|segment| !is_of(segment, &clutter)).collect();
    let long: Vec<Segment> =
        structure.iter().copied().filter(|segment| segment.length() >= options.doorways.shortest_m).collect();
    let Gaps { doorways: mut found, mouths } = gaps(&structure, &boundary, &options.doorways);
    let walled = without_strips(free, &wall_strips(&long, &options.doorways));
    // A doorway from a room to itself is spurious: without it the room may extend further, so repeat.
    let (mut pieces, mut sides) = loop {
        let strips: Vec<Ring> = found.iter().map(doorway_strip).collect();
        let pieces: Vec<Vec<Ring>> = without_strips(&walled, &strips);
        let sides = sides_of(&found, &pieces);
        let joins = |sides: &[Option<usize>; 2]| sides[0].is_some() && sides[1].is_some() && sides[0] != sides[1];
        if !sides.iter().all(joins) {
            let mut each = sides.iter();
            found.retain(|_| each.next().is_some_and(joins));
            continue;
        }
        // Two doorways with only a doorstep between them are one: keep the narrower.
        match between_two(&found, &sides, &pieces, options) {
            Some(wider) => {
                found.remove(wider);
                continue;
            }
            None if !options.doorways.must_widen => break (pieces, sides),
            None => {}
        }
        let passages = found.iter().filter(|doorway| !is_width_change(doorway, &boundary, &found)).cloned();
        let passages: Vec<Doorway> = passages.collect();
        if passages.len() == found.len() {
            break (pieces, sides);
        }
        found = passages;
    };
    if close_mouths(&mouths, &mut found, &mut pieces, options) {
        sides = sides_of(&found, &pieces);
    }
    if options.doorways.must_widen {
        let count = pieces.len();
        pieces = pieces.into_iter().flat_map(without_leaks).collect();
        if pieces.len() > count {
            sides = sides_of(&found, &pieces);
        }
    }
    let (points, sights, piece_of) = scatter(&pieces, options);
    let mut room_of_piece: Vec<Option<usize>> = vec![None; pieces.len()];
    let mut rooms: Vec<FoundRoom> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let within: Vec<usize> = (0..points.len()).filter(|&i| piece_of[i] == index).collect();
        let leads_somewhere = sides.iter().flatten().any(|&side| side == Some(index));
        // Its doorway may have been missed; what is small leaked past a wall.
        let is_large = area_m2(piece) > LONE_ROOM_M2 && options.doorways.must_widen;
        if within.is_empty() || !(leads_somewhere || found.is_empty() || is_large) {
            continue;
        }
        if let Some(room) = room(piece, within, options) {
            room_of_piece[index] = Some(rooms.len());
            rooms.push(room);
        }
    }
    let sides = sides.into_iter().map(|pair| pair.map(|side| room_of_piece[side?])).collect();
    FoundRooms { walls: walls(segments, &options.doorways), doorways: found, sides, points, sights, rooms }
}

/// An obstacle that stands free and is smaller across, in metres, is a pillar or furniture, not a wall with
/// passages beside it: walls between two doorways are longer.
const LARGEST_CLUTTER_M: f64 = 0.9;

/// Its shorter side is at least this share of its longer one: the end of a wall between two doorways is thin.
const CLUTTER_SHARE: f64 = 0.4;

/// The boxes of free-standing obstacles that are no walls, a little larger.
fn clutter(free: &Shapes) -> Vec<Bounds> {
    let holes = free.iter().flat_map(|shape| shape.iter().skip(1));
    let boxes = holes.map(|hole| Bounds::of(hole.iter().map(|&[x, y]| Point::new(x, y))));
    let is_clutter = |bounds: &Bounds| {
        let (short_m, long_m) = (bounds.width().min(bounds.height()), bounds.width().max(bounds.height()));
        long_m <= LARGEST_CLUTTER_M && short_m >= CLUTTER_SHARE * long_m
    };
    boxes.filter(is_clutter).map(|bounds| bounds.inflated(0.1)).collect()
}

fn is_of(segment: &Segment, clutter: &[Bounds]) -> bool {
    clutter.iter().any(|bounds| bounds.contains(segment.a) && bounds.contains(segment.b))
}

/// A room behind a mouth, a closet or an alcove, has no other doorway and is at most this large in m².
const LARGEST_ALCOVE_M2: f64 = 4.0;

/// It is at least this deep as a share of its width: a bay is not. Both ends of its mouth are wall, or else it is the
/// room's own corner.
const LEAST_DEPTH_SHARE: f64 = 0.6;

/// A corridor's mouth separates it from a room that has space for a disc of this many times the mouth's
/// width in front of it; another corridor has not.
const ROOMY_SHARE: f64 = 1.5;

/// How far in front of a mouth that disc may be, in metres.
const ROOMY_WITHIN_M: f64 = 2.5;

/// Whether there is a room in this direction from a mouth: space before it, straight ahead or to one side, for a disc
/// wider than the mouth. `boundary` holds the edges of the floor there, doorways closed.
fn is_roomy(mouth: &Doorway, way: Vector, boundary: &RayGrid) -> bool {
    let middle = mouth.segment.midpoint();
    let along = way.left();
    let radius_m = ROOMY_SHARE * mouth.width_m / 2.0;
    let aside_m = radius_m - mouth.width_m / 2.0;
    let steps = (ROOMY_WITHIN_M / 0.1).floor() as usize;
    [0.0, aside_m, -aside_m].into_iter().any(|aside_m| {
        let from = middle + way * 0.05 + along * aside_m;
        let ahead_m = boundary.cast(from, way, ROOMY_WITHIN_M).map_or(ROOMY_WITHIN_M, |hit| hit.distance_m);
        (1..=steps)
            .map(|step| 0.1 * step as f64)
            .take_while(|&at_m| at_m <= ahead_m)
            .any(|at_m| boundary.distance_m(from + way * at_m, radius_m) >= radius_m)
    })
}

/// Cuts alcoves off their rooms, and corridors off rooms that they open into; returns whether there were any.
fn close_mouths(
    mouths: &[Doorway],
    found: &mut Vec<Doorway>,
    pieces: &mut Vec<Vec<Ring>>,
    options: &RoomOptions,
) -> bool {
    let before = found.len();
    let doors: Vec<Doorway> = found.clone();
    for mouth in mouths {
        let Some(whole) = (0..pieces.len()).find(|&i| {
            piece_bounds(&pieces[i]).contains(mouth.segment.midpoint())
                && contains(&pieces[i], mouth.segment.midpoint())
        }) else {
            continue;
        };
        let parts: Vec<Vec<Ring>> = without_strips(&vec![pieces[whole].clone()], &[doorway_strip(mouth)]);
        let Some(&[Some(one), Some(other)]) = sides_of(std::slice::from_ref(mouth), &parts).first() else { continue };
        if one == other {
            continue;
        }
        let (small, large) = if area_m2(&parts[one]) < area_m2(&parts[other]) { (one, other) } else { (other, one) };
        let is_alcove = mouth.is_framed
            && (options.smallest_m2..=LARGEST_ALCOVE_M2).contains(&area_m2(&parts[small]))
            && area_m2(&parts[small]) >= LEAST_DEPTH_SHARE * mouth.width_m.powi(2)
            && area_m2(&parts[large]) > 2.0 * area_m2(&parts[small]);
        let doors_of = sides_of(&doors, &parts);
        let has_door = doors_of.iter().flatten().any(|&side| side == Some(small));
        let opens_into_room = || {
            if mouth.width_m > DoorwayOptions::PAPER.widest_m {
                return false;
            }
            // The part with the mouth's full width on its side is the corridor, if it is longer than wide.
            let is_corridor = |part: usize| {
                doors_of.iter().flatten().any(|&side| side == Some(part))
                    && area_m2(&parts[part]) >= mouth.width_m.powi(2)
            };
            let edges_of = |part: usize| RayGrid::new(edges(&vec![parts[part].clone()]));
            (is_corridor(one) && is_roomy(mouth, -mouth.across(), &edges_of(other)))
                || (is_corridor(other) && is_roomy(mouth, mouth.across(), &edges_of(one)))
        };
        if (is_alcove && !has_door) || opens_into_room() {
            found.push(mouth.clone());
            pieces.splice(whole..=whole, parts);
        }
    }
    found.len() > before
}

/// The boundary of a free space, which is to the left of its edges.
pub fn boundary(free: &Shapes) -> RayGrid {
    RayGrid::new(edges(free))
}

/// The edges of areas, with the area to their left.
fn edges(shapes: &Shapes) -> Vec<Segment> {
    shapes.iter().flatten().flat_map(|ring| polygon::edges(&areas::points(ring)).collect::<Vec<_>>()).collect()
}

fn without_strips(shapes: &Shapes, strips: &[Ring]) -> Shapes {
    if strips.is_empty() {
        return shapes.clone();
    }
    shapes.overlay(&strips.to_vec(), OverlayRule::Difference, FillRule::NonZero)
}

/// Width in metres of the strips that walls cut out of the free space.
const STRIP_M: f64 = 0.02;

/// The segments of walls as strips, plus strips that close gaps too narrow for a doorway: between the
/// ends of segments, and up to the wall that an end points at.
fn wall_strips(long: &[Segment], options: &DoorwayOptions) -> Vec<Ring> {
    let grid = RayGrid::new(long.to_vec());
    let mut strips: Vec<Ring> = Vec::new();
    let strip = |segment: Segment| {
        let along = segment.vector().unit()?;
        Some(areas::ring(&rectangle(segment.midpoint(), along, segment.length() + STRIP_M, STRIP_M)))
    };
    for segment in long {
        strips.extend(strip(*segment));
        let Some(along) = segment.vector().unit() else { continue };
        for (end, onward) in [(segment.b, along), (segment.a, -along)] {
            let from = end + onward * 0.01;
            if let Some(hit) = grid.cast(from, onward, options.narrowest_m) {
                strips.extend(strip(Segment::new(end, from + onward * hit.distance_m)));
            }
        }
    }
    strips
}

/// The strip that a doorway cuts out of the free space: the place of its door, from face to face.
fn doorway_strip(doorway: &Doorway) -> Ring {
    let along = doorway.segment.vector().unit().unwrap_or(Vector::new(1.0, 0.0));
    let (length_m, depth_m) = (doorway.width_m + 2.0 * JAMB_M, doorway.depth_m + STRIP_M);
    areas::ring(&rectangle(doorway.segment.midpoint(), along, length_m, depth_m))
}

/// How far a doorway's cut extends into its jambs, in metres.
const JAMB_M: f64 = 0.08;

/// The pieces on the left and right of each doorway.
fn sides_of(doorways: &[Doorway], pieces: &[Vec<Ring>]) -> Vec<[Option<usize>; 2]> {
    let bounds: Vec<Bounds> = pieces.iter().map(|piece| piece_bounds(piece)).collect();
    let piece_at = |point: Point| (0..pieces.len()).find(|&i| bounds[i].contains(point) && contains(&pieces[i], point));
    let side = |doorway: &Doorway, across: Vector| {
        let from_m = doorway.depth_m / 2.0 + STRIP_M;
        // Past what is left of the door's place, and any thin obstacle in it.
        (1..=6).find_map(|step| {
            let at = doorway.segment.midpoint() + across * (from_m + f64::from(step) * 0.06);
            piece_at(at).filter(|&i| area_m2(&pieces[i]) > 0.1)
        })
    };
    doorways.iter().map(|doorway| [side(doorway, doorway.across()), side(doorway, -doorway.across())]).collect()
}

/// The widest doorway of a piece that has several and is too small for a room.
fn between_two(
    doorways: &[Doorway],
    sides: &[[Option<usize>; 2]],
    pieces: &[Vec<Ring>],
    options: &RoomOptions,
) -> Option<usize> {
    let small = (0..pieces.len()).filter(|&piece| is_too_small(&pieces[piece], options));
    small.into_iter().find_map(|piece| {
        let leading: Vec<usize> = (0..doorways.len()).filter(|&i| sides[i].contains(&Some(piece))).collect();
        let widest = leading.iter().copied().max_by(|&p, &q| doorways[p].width_m.total_cmp(&doorways[q].width_m));
        widest.filter(|_| leading.len() > 1)
    })
}

/// Whether a piece is too small for a room, ignoring its narrow parts.
fn is_too_small(piece: &[Ring], options: &RoomOptions) -> bool {
    area_m2(piece) < options.smallest_m2
        || areas::area_m2(&areas::offset(&vec![piece.to_vec()], -2.0 * NARROW_M)) < options.smallest_m2 / 10.0
}

fn piece_bounds(piece: &[Ring]) -> Bounds {
    Bounds::of(piece.iter().flatten().map(|&[x, y]| Point::new(x, y)))
}

fn area_m2(piece: &[Ring]) -> f64 {
    piece.iter().map(|ring| polygon::signed_area(&areas::points(ring))).sum::<f64>().abs()
}

fn contains(piece: &[Ring], point: Point) -> bool {
    let inside = |ring: &Ring| polygon::locate_in_ring(&areas::points(ring), point) == polygon::Location::Inside;
    piece.split_first().is_some_and(|(outer, holes)| inside(outer) && !holes.iter().any(inside))
}

/// Points further apart than this in metres are not tested for visibility: others lie between them.
const SIGHT_M: f64 = 2.5;

/// Random points in the pieces, the sight lines that merged them, and the piece of each point: sets of
/// points that see each other, directly or via others, are one room.
fn scatter(pieces: &[Vec<Ring>], options: &RoomOptions) -> (Vec<Point>, Vec<[usize; 2]>, Vec<usize>) {
    let shapes: Shapes = pieces.to_vec();
    let grid = RayGrid::new(edges(&shapes));
    let bounds = Bounds::of(pieces.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y)));
    let mut random = Random::new(options.seed);
    let count = (bounds.width() * bounds.height() * options.points_per_m2).clamp(0.0, 1e6) as usize;
    let mut points: Vec<Point> = (0..count)
        .map(|_| {
            let (u, v) = (random.unit(), random.unit());
            Point::new(bounds.min.x + u * bounds.width(), bounds.min.y + v * bounds.height())
        })
        .filter(|&point| is_inside(&grid, point))
        .collect();
    // Sorted left to right, so that nearby ones are found without testing all.
    points.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..points.len() {
        for j in (i + 1..points.len()).take_while(|&j| points[j].x - points[i].x <= SIGHT_M) {
            let distance_m = points[i].distance(points[j]);
            if distance_m <= SIGHT_M {
                pairs.push((distance_m, i, j));
            }
        }
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2))));
    let boxes: Vec<Bounds> = pieces.iter().map(|piece| piece_bounds(piece)).collect();
    let piece_at = |point: Point| (0..pieces.len()).find(|&p| boxes[p].contains(point) && contains(&pieces[p], point));
    let piece_of: Vec<usize> = points.iter().map(|&point| piece_at(point).unwrap_or(usize::MAX)).collect();
    let mut groups = Groups::new(points.len());
    let mut sights = Vec::new();
    for (_, i, j) in pairs {
        // Pieces may touch in a point, through which a sight would slip.
        if piece_of[i] == piece_of[j] && groups.root(i) != groups.root(j) && !grid.blocks(points[i], points[j]) {
            groups.join(i, j);
            sights.push([i, j]);
        }
    }
    (points, sights, piece_of)
}

/// A piece of free space without a doorway that is larger, in m², is a room all the same.
const LONE_ROOM_M2: f64 = 3.0;

/// A piece without what is narrower than a room's narrowest part, where that leaves several that could be rooms: floor seen
/// past the edge of a wall may join two of them.
fn without_leaks(piece: Vec<Ring>) -> Vec<Vec<Ring>> {
    let parts = areas::opening(&vec![piece.clone()], NARROW_M);
    let large: Vec<Vec<Ring>> = parts.into_iter().filter(|part| area_m2(part) > LONE_ROOM_M2).collect();
    if large.len() > 1 { large } else { vec![piece] }
}

/// Smaller holes are furniture and columns, in m²; a courtyard is larger.
const LARGEST_FURNITURE_M2: f64 = 4.0;

/// Parts narrower than twice this, in metres, do not belong to a room: the place of a door, the gap
/// beside a cupboard.
const NARROW_M: f64 = 0.1;

/// Tolerance for simplifying a room's boundary, in metres.
const BOUNDARY_M: f64 = 0.04;

/// The room of a piece of free space; `None` if it is too small.
fn room(piece: &[Ring], points: Vec<usize>, options: &RoomOptions) -> Option<FoundRoom> {
    let (outer, holes) = piece.split_first()?;
    let large = holes.iter().filter(|hole| polygon::signed_area(&areas::points(hole)).abs() > LARGEST_FURNITURE_M2);
    let kept: Shapes = vec![std::iter::once(outer).chain(large).cloned().collect()];
    let opened = areas::opening(&kept, NARROW_M);
    let largest = areas::pieces(&opened)
        .into_iter()
        .max_by(|p, q| polygon::area(&p.0, &p.1).total_cmp(&polygon::area(&q.0, &q.1)))?;
    let simplified = |ring: &Vec<Point>| super::free_space::simplified_ring(ring, BOUNDARY_M);
    let outer = simplified(&largest.0);
    let holes: Vec<Vec<Point>> = largest.1.iter().map(simplified).filter(|hole| hole.len() >= 3).collect();
    if outer.len() < 3 || polygon::area(&outer, &holes) < options.smallest_m2 {
        return None;
    }
    let axes = runs::axes(&outer, &holes);
    Some(FoundRoom { area_m2: mean_quadrilateral_m2(&outer), outer, holes, axes, points })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leak_past_a_wall_joins_no_rooms() {
        // Two rooms with a slit of this width between them.
        let joined = |slit_m: f64| -> Vec<Ring> {
            let (low, high) = (1.0, 1.0 + slit_m);
            let ring = vec![
                [0.0, 0.0],
                [3.0, 0.0],
                [3.0, low],
                [3.1, low],
                [3.1, 0.0],
                [6.0, 0.0],
                [6.0, 3.0],
                [3.1, 3.0],
                [3.1, high],
                [3.0, high],
                [3.0, 3.0],
                [0.0, 3.0],
            ];
            vec![ring]
        };
        assert_eq!(without_leaks(joined(0.1)).len(), 2);
        assert_eq!(without_leaks(joined(0.5)), [joined(0.5)]);
    }
}
