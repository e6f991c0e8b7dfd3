//! Walls and doorways of a line map (paper, section 3.3): walls by collinearity, doorways as gaps between
//! the collinear segments of a wall, or between a wall's end and another wall.

use super::RayGrid;
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::are_parallel;
use crate::geometry::{Bounds, Point, Segment, Vector};

/// The thresholds for walls and doorways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoorwayOptions {
    /// Shorter segments count as furniture, in metres (paper: 30 cm).
    pub shortest_m: f64,
    /// Segments of a wall differ by at most this angle (paper: 10 degrees).
    pub collinear_rad: f64,
    /// Segments of a wall are offset from each other's line by at most this, in metres: less than the
    /// thickness of a thin wall.
    pub aside_m: f64,
    /// The minimum width of a doorway, in metres (paper: 30 cm).
    pub narrowest_m: f64,
    /// The maximum width of a doorway, in metres (paper: 150 cm).
    pub widest_m: f64,
    /// Beyond the paper: a gap between two collinear segments, a free passage, may be this wide, in
    /// metres.
    pub widest_passage_m: f64,
    /// Beyond the paper: minimum length in metres of a segment that may end at a doorway, for the narrow
    /// strip of wall beside a door in a corner.
    pub shortest_jamb_m: f64,
    /// Beyond the paper: a gap counts only if, within the depth of a thick wall, the floor is wider than
    /// the gap on both sides. Otherwise the mouth of a narrow corridor would count as a doorway.
    pub must_widen: bool,
}

impl DoorwayOptions {
    /// The paper's rule alone.
    pub const PAPER: Self = Self {
        shortest_m: 0.30,
        collinear_rad: ANGLE_TOLERANCE_RAD,
        aside_m: 0.08,
        narrowest_m: 0.30,
        widest_m: 1.50,
        widest_passage_m: 1.50,
        shortest_jamb_m: 0.30,
        must_widen: false,
    };
}

impl Default for DoorwayOptions {
    /// The paper's values, plus the test that the floor widens and wide free passages.
    fn default() -> Self {
        Self { must_widen: true, widest_m: 2.2, widest_passage_m: 4.5, shortest_jamb_m: 0.15, ..Self::PAPER }
    }
}

/// A passage in a wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Doorway {
    /// From jamb to jamb, along the middle of the wall.
    pub segment: Segment,
    pub width_m: f64,
    /// Thickness of the wall there, in metres: from one face's gap to the other's; 0 if only one was
    /// seen.
    pub depth_m: f64,
    /// Of a mouth, whether the floor is wider at both ends of it.
    pub is_framed: bool,
}

impl Doorway {
    /// The unit vector across the doorway, pointing to the left of its segment.
    pub fn across(&self) -> Vector {
        self.segment.vector().left().unit().unwrap_or(Vector::new(0.0, 1.0))
    }
}

/// The walls of a line map: for each segment the index of its wall, `None` if it is too short.
pub fn walls(segments: &[Segment], options: &DoorwayOptions) -> Vec<Option<usize>> {
    let long: Vec<usize> = (0..segments.len()).filter(|&i| segments[i].length() >= options.shortest_m).collect();
    let grid = RayGrid::new(long.iter().map(|&i| segments[i]).collect());
    let mut groups = Groups::new(segments.len());
    for (at, &i) in long.iter().enumerate() {
        for other in grid.near(segments[i].bounds().inflated(options.widest_m)) {
            let j = long[other];
            if other > at && are_collinear(segments[i], segments[j], options) {
                groups.join(i, j);
            }
        }
    }
    let mut numbers: Vec<Option<usize>> = vec![None; segments.len()];
    let mut of_root: Vec<Option<usize>> = vec![None; segments.len()];
    let mut count = 0;
    for &i in &long {
        let root = groups.root(i);
        let number = *of_root[root].get_or_insert_with(|| {
            count += 1;
            count - 1
        });
        numbers[i] = Some(number);
    }
    numbers
}

/// Whether two segments belong to one wall: parallel, on one line, and no further apart than the width of
/// a doorway.
fn are_collinear(p: Segment, q: Segment, options: &DoorwayOptions) -> bool {
    let (longer, shorter) = if p.length() >= q.length() { (p, q) } else { (q, p) };
    let Some(along) = longer.vector().unit() else { return false };
    let aside = |point: Point| along.cross(point - longer.a).abs();
    let place = |point: Point| along.dot(point - longer.a);
    let (near, far) = (place(shorter.a).min(place(shorter.b)), place(shorter.a).max(place(shorter.b)));
    let gap_m = (near - longer.length()).max(-far).max(0.0);
    are_parallel(p, q, options.collinear_rad)
        && aside(shorter.a).min(aside(shorter.b)) <= options.aside_m
        && gap_m <= options.widest_m
}

/// Disjoint sets, or union-find (Galler and Fischer 1964).
#[derive(Clone, Debug)]
pub(super) struct Groups {
    parents: Vec<usize>,
}

impl Groups {
    pub fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// The smallest member of the set of `i`.
    pub fn root(&mut self, mut i: usize) -> usize {
        while self.parents[i] != i {
            self.parents[i] = self.parents[self.parents[i]];
            i = self.parents[i];
        }
        i
    }

    /// Merges two sets; returns whether they were different.
    pub fn join(&mut self, i: usize, j: usize) -> bool {
        let (p, q) = (self.root(i), self.root(j));
        self.parents[p.max(q)] = p.min(q);
        p != q
    }
}

/// The end of a segment and the direction in which it would continue.
#[derive(Clone, Copy)]
struct End {
    at: Point,
    onward: Vector,
}

/// The gaps in the walls of a line map, narrowest first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gaps {
    pub doorways: Vec<Doorway>,
    /// Beyond the paper: gaps past which the floor widens on one side only. Such is the opening of a closet
    /// or an alcove, but the mouth of a corridor too.
    pub mouths: Vec<Doorway>,
}

/// The gaps between the long segments of a line map. `boundary` holds the edges of the free space, which is
/// to their left.
pub fn gaps(segments: &[Segment], boundary: &RayGrid, options: &DoorwayOptions) -> Gaps {
    let long: Vec<Segment> = segments.iter().copied().filter(|s| s.length() >= options.shortest_jamb_m).collect();
    let grid = RayGrid::new(long.clone());
    let mut gaps: Vec<Segment> = Vec::new();
    for (i, segment) in long.iter().enumerate() {
        let Some(along) = segment.vector().unit() else { continue };
        if options.must_widen && segment.length() < options.shortest_m && !is_aligned(i, &long, &grid, options) {
            continue;
        }
        for end in [End { at: segment.b, onward: along }, End { at: segment.a, onward: -along }] {
            gaps.extend(between_ends(end, i, &long, &grid, options));
            let ahead = to_wall(end, &long, &grid, options);
            gaps.extend(ahead.map(|gap| if options.must_widen { before_stub(gap, boundary) } else { gap }));
        }
    }
    gaps.retain(|&gap| is_free(gap, boundary));
    gaps.sort_by(|p, q| p.length().total_cmp(&q.length()));
    let mut found: Vec<Vec<Segment>> = Vec::new();
    let mut mouths: Vec<Segment> = Vec::new();
    for gap in gaps {
        // Narrow ones first: a door beside this gap does not widen it.
        match if options.must_widen { widens(gap, boundary, &found) } else { [true; 2] } {
            [true, true] => {}
            [false, false] => continue,
            _ => {
                if gap.length() <= options.widest_m {
                    mouths.push(gap);
                }
                continue;
            }
        }
        match found.iter().position(|group| group.iter().all(|&other| is_same_doorway(gap, other))) {
            Some(group) => found[group].push(gap),
            // A gap that crosses a narrower doorway is not one.
            None if found.iter().flatten().any(|&other| crosses(gap, other)) => {}
            None => found.push(vec![gap]),
        }
    }
    let is_new = |mouth: &&Segment| {
        !found.iter().flatten().any(|&other| is_same_doorway(**mouth, other) || crosses(**mouth, other))
    };
    let alone = |&mouth: &Segment| {
        let is_framed = jogs(mouth, boundary, &found).iter().any(|side| side[0] && side[1]);
        Doorway { segment: mouth, width_m: mouth.length(), depth_m: 0.0, is_framed }
    };
    let mouths = mouths.iter().filter(is_new).map(alone).collect();
    let doorways = found.iter().map(|gaps| {
        let doorway = merged(gaps);
        if options.must_widen { deepened(doorway, boundary) } else { doorway }
    });
    Gaps { doorways: doorways.collect(), mouths }
}

/// Whether a segment is parallel or square to a longer wall near it: noise at corners is neither.
fn is_aligned(i: usize, long: &[Segment], grid: &RayGrid, options: &DoorwayOptions) -> bool {
    let segment = long[i];
    grid.near(segment.bounds().inflated(1.0)).into_iter().any(|j| {
        let other = long[j];
        let Some(square) = other.vector().unit().map(|along| Segment::new(other.a, other.a + along.left())) else {
            return false;
        };
        j != i
            && other.length() >= 2.0 * options.shortest_m
            && (are_parallel(other, segment, options.collinear_rad)
                || are_parallel(square, segment, options.collinear_rad))
    })
}

/// A wall bends by at most this angle at a doorway.
const MOST_BEND_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// Gaps from an end to the facing ends of collinear segments.
fn between_ends(end: End, own: usize, long: &[Segment], grid: &RayGrid, options: &DoorwayOptions) -> Vec<Segment> {
    let reach = Bounds::of([end.at, end.at + end.onward * options.widest_passage_m]).inflated(0.3);
    let mut gaps = Vec::new();
    for i in grid.near(reach).into_iter().filter(|&i| i != own) {
        let other = long[i];
        let ahead = Segment::new(end.at, end.at + end.onward);
        let is_straight = are_parallel(other, ahead, options.collinear_rad);
        // Beyond the paper a wall may bend at the doorway, where both of its parts are more than noise at a corner.
        let may_bend = options.must_widen && long[own].length().min(other.length()) >= 2.0 * options.shortest_m;
        let is_bent = may_bend && are_parallel(other, ahead, MOST_BEND_RAD);
        if !is_straight && !is_bent {
            continue;
        }
        let widest_m = if is_straight { options.widest_passage_m } else { options.widest_m };
        let (near, far) = if end.onward.dot(other.vector()) > 0.0 { (other.a, other.b) } else { (other.b, other.a) };
        let way = near - end.at;
        let (ahead_m, aside_m) = (way.dot(end.onward), way.cross(end.onward).abs());
        let fits = (options.narrowest_m..=widest_m).contains(&ahead_m)
            && aside_m <= options.aside_m.max(ahead_m * options.collinear_rad.tan() * 0.5)
            && (far - near).dot(end.onward) > 0.0;
        if fits {
            gaps.push(Segment::new(end.at, near));
        }
    }
    gaps
}

/// So many lines ahead of an end are looked at: noise about a stub of wall, then the wall.
const MOST_HITS: usize = 3;

/// The gap straight ahead from an end to the wall it meets.
fn to_wall(end: End, long: &[Segment], grid: &RayGrid, options: &DoorwayOptions) -> Option<Segment> {
    // Past the end itself and whatever is joined to it.
    let mut from = end.at + end.onward * 0.02;
    // Beyond the paper squarely, or else it is not where the passage is narrowest: a short segment, the reveal of
    // a door say, points anywhere. Noise about a stub of wall in front of the wall is passed over.
    let least_rad = if options.must_widen { SQUARE_RAD } else { options.collinear_rad };
    let most = if options.must_widen { MOST_HITS } else { 1 };
    for _ in 0..most {
        let hit = grid.cast(from, end.onward, options.widest_m - end.at.distance(from))?;
        let to = from + end.onward * hit.distance_m;
        let gap = Segment::new(end.at, to);
        if !are_parallel(long[hit.segment], gap, least_rad) {
            return (options.narrowest_m..=options.widest_m).contains(&gap.length()).then_some(gap);
        }
        if long[hit.segment].length() >= 2.0 * options.shortest_m {
            return None;
        }
        from = to + end.onward * 0.02;
    }
    None
}

/// A stub of wall beside a door in a corner may be shorter than any line of the map; it is at most this long, in metres.
const LONGEST_STUB_M: f64 = 0.25;

/// Less is what the floor ends before a wall anyway.
const SHORTEST_STUB_M: f64 = 0.05;

/// A gap up to a wall without the stub in front of that wall: up to where the floor ends.
fn before_stub(gap: Segment, boundary: &RayGrid) -> Segment {
    let Some(along) = gap.vector().unit() else { return gap };
    let (middle, half_m) = (gap.midpoint(), gap.length() / 2.0);
    match boundary.cast(middle, along, half_m) {
        Some(hit) if (SHORTEST_STUB_M..=LONGEST_STUB_M).contains(&(half_m - hit.distance_m)) => {
            Segment::new(gap.a, middle + along * hit.distance_m)
        }
        _ => gap,
    }
}

/// A gap up to a wall meets it at this angle at least.
const SQUARE_RAD: f64 = 45.0 * std::f64::consts::PI / 180.0;

/// Number of sample points on a gap.
const PLACES: usize = 9;

/// Whether a gap is unobstructed: all of it except its ends is in the free space.
fn is_free(gap: Segment, boundary: &RayGrid) -> bool {
    let Some(along) = gap.vector().unit() else { return false };
    let margin_m = 0.06_f64.min(gap.length() / 4.0);
    let (from, to) = (gap.a + along * margin_m, gap.b - along * margin_m);
    (0..PLACES).all(|i| is_inside(boundary, from.lerp(to, i as f64 / (PLACES - 1) as f64)))
}

/// Whether a point is in the free space: it is left of the first boundary that a ray from it meets.
pub(super) fn is_inside(boundary: &RayGrid, point: Point) -> bool {
    // In a direction that no wall has, so that no ray runs along one.
    let direction = Vector::new(0.8141, 0.5807).unit().unwrap_or(Vector::new(1.0, 0.0));
    boundary.cast(point, direction, 1e4).is_some_and(|hit| {
        let edge = boundary.segments()[hit.segment];
        edge.vector().cross(point - edge.a) > 0.0
    })
}

/// Maximum depth of a doorway in metres: the thickest plausible wall, with a margin.
pub(super) const DEEPEST_M: f64 = 0.65;

/// How much wider than a doorway the floor beside it must be, in metres and as a share of its width.
const WIDER_M: f64 = 0.06;
const WIDER_SHARE: f64 = 0.1;

/// The same for gaps wider than a door, where two walls that happen to lie in line across a corridor are no passage.
const WIDE_WIDER_SHARE: f64 = 0.2;

/// Maximum length of rays along a gap, in metres.
pub(super) const WIDTH_LIMIT_M: f64 = 6.0;

/// Whether the free floor is wider than the gap to its left and to its right, within the depth of a wall.
/// Doorways already found count as closed.
pub(super) fn widens(gap: Segment, boundary: &RayGrid, found: &[Vec<Segment>]) -> [bool; 2] {
    let Some(along) = gap.vector().unit() else { return [false; 2] };
    let middle = gap.midpoint();
    let around = gap.bounds().inflated(WIDTH_LIMIT_M);
    let closed: Vec<Segment> = found
        .iter()
        .filter(|doorway| !doorway.iter().any(|&other| is_same_doorway(gap, other)))
        .flatten()
        .copied()
        .filter(|other| other.bounds().intersects(around))
        .collect();
    let reach_m = |at: Point, way: Vector| {
        let walls_m = boundary.cast(at, way, WIDTH_LIMIT_M).map_or(WIDTH_LIMIT_M, |hit| hit.distance_m);
        closed.iter().filter_map(|&door| super::ray_grid::hit_m(at, way, door)).fold(walls_m, f64::min)
    };
    let width_m = |at: Point| reach_m(at, along) + reach_m(at, -along);
    let width_here_m = width_m(middle).min(gap.length() + 0.05);
    let share = if gap.length() > DoorwayOptions::PAPER.widest_m { WIDE_WIDER_SHARE } else { WIDER_SHARE };
    let wider_m = width_here_m + WIDER_M.max(share * width_here_m);
    [along.left(), -along.left()].map(|across| {
        let ahead_m = boundary.cast(middle, across, DEEPEST_M).map_or(DEEPEST_M, |hit| hit.distance_m - 0.05);
        let steps = (ahead_m / 0.05).floor().max(0.0) as usize;
        (1..=steps).any(|step| width_m(middle + across * (step as f64 * 0.05)) >= wider_m)
    })
}

/// A wall ends beside a gap if the floor reaches this much further than the gap's end, in metres.
const JOG_M: f64 = 0.05;

/// Whether the floor reaches further than the gap's end within the depth of a wall: on its left and right, at its
/// start and end. Doorways found before count as closed.
fn jogs(gap: Segment, boundary: &RayGrid, found: &[Vec<Segment>]) -> [[bool; 2]; 2] {
    let Some(along) = gap.vector().unit() else { return [[false; 2]; 2] };
    let middle = gap.midpoint();
    let half_m = gap.length() / 2.0;
    let limit_m = half_m + 1.0;
    let reach_m = |at: Point, way: Vector| {
        let wall_m = boundary.cast(at, way, limit_m).map_or(limit_m, |hit| hit.distance_m);
        found.iter().flatten().filter_map(|&door| super::ray_grid::hit_m(at, way, door)).fold(wall_m, f64::min)
    };
    [along.left(), -along.left()].map(|across| {
        let ahead_m = boundary.cast(middle, across, DEEPEST_M).map_or(DEEPEST_M, |hit| hit.distance_m - 0.05);
        let steps = (ahead_m / 0.05).floor().max(0.0) as usize;
        [-along, along].map(|way| {
            let end_m = reach_m(middle, way).min(half_m + 0.025);
            (1..=steps).any(|step| reach_m(middle + across * (step as f64 * 0.05), way) >= end_m + JOG_M)
        })
    })
}

/// Whether two gaps belong to the two faces of one wall, or to the same face.
pub(super) fn is_same_doorway(p: Segment, q: Segment) -> bool {
    let Some(along) = q.vector().unit() else { return false };
    let way = p.midpoint() - q.midpoint();
    let (stretch_from, stretch_to) = crate::geometry::segments::common_stretch(q, p);
    are_parallel(p, q, 0.35)
        && way.cross(along).abs() <= DEEPEST_M
        && stretch_to - stretch_from >= 0.5 * p.length().min(q.length())
}

fn crosses(p: Segment, q: Segment) -> bool {
    crate::geometry::segments::crossing(p, q).is_some()
}

/// One doorway from the gaps in the faces of a wall.
fn merged(gaps: &[Segment]) -> Doorway {
    let narrowest = gaps[0];
    let along = narrowest.vector().unit().unwrap_or(Vector::new(1.0, 0.0));
    let depths = gaps.iter().map(|gap| (gap.midpoint() - narrowest.a).dot(along.left()));
    let (low_m, high_m) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)));
    let shift = along.left() * ((low_m + high_m) / 2.0);
    let segment = Segment::new(narrowest.a + shift, narrowest.b + shift);
    Doorway { segment, width_m: narrowest.length(), depth_m: high_m - low_m, is_framed: false }
}

/// A doorway's place leaves this much floor behind it, in metres: a closet is not all doorway.
const LEAST_BEHIND_M: f64 = 0.5;

/// The maximum length of rays across a doorway, in metres.
const FLOOR_LIMIT_M: f64 = 1.5;

/// The doorway with all of its passage between the faces of the wall as its place, where only one face's gap was seen.
fn deepened(doorway: Doorway, boundary: &RayGrid) -> Doorway {
    let Some(along) = doorway.segment.vector().unit() else { return doorway };
    let middle = doorway.segment.midpoint();
    let half_m = doorway.width_m / 2.0;
    let limit_m = half_m + 1.0;
    let width_m = |at: Point| -> f64 {
        [along, -along]
            .into_iter()
            .map(|way| boundary.cast(at, way, limit_m).map_or(limit_m, |hit| hit.distance_m))
            .sum()
    };
    let here_m = width_m(middle).min(doorway.width_m + 0.05);
    // As far as the passage is no wider than the doorway.
    let reach_m = |across: Vector| {
        let most_m = DEEPEST_M - doorway.depth_m / 2.0;
        let ahead_m = boundary.cast(middle, across, most_m).map_or(most_m, |hit| hit.distance_m);
        let steps = (ahead_m / 0.05).floor().max(0.0) as usize;
        let floor_m = boundary.cast(middle, across, FLOOR_LIMIT_M).map_or(FLOOR_LIMIT_M, |hit| hit.distance_m);
        let steps = steps.min(((floor_m - LEAST_BEHIND_M) / 0.05).floor().max(0.0) as usize);
        let wide = (1..=steps).find(|&step| width_m(middle + across * (0.05 * step as f64)) >= here_m + WIDER_M);
        wide.map_or(doorway.depth_m / 2.0, |step| (0.05 * (step as f64 - 0.5)).max(doorway.depth_m / 2.0))
    };
    let (left_m, right_m) = (reach_m(along.left()), reach_m(-along.left()));
    if left_m + right_m > DEEPEST_M {
        return doorway;
    }
    let shift = along.left() * ((left_m - right_m) / 2.0);
    let segment = Segment::new(doorway.segment.a + shift, doorway.segment.b + shift);
    Doorway { segment, depth_m: left_m + right_m, ..doorway }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(a: (f64, f64), b: (f64, f64)) -> Segment {
        Segment::new(Point::new(a.0, a.1), Point::new(b.0, b.1))
    }

    #[test]
    fn segments_of_a_wall_are_collinear_and_near() {
        let map = [
            segment((0.0, 0.0), (3.0, 0.02)),
            segment((3.9, 0.0), (6.0, 0.0)),
            segment((6.5, 0.0), (6.7, 0.0)),
            segment((0.0, 0.5), (3.0, 0.5)),
            segment((3.0, 0.0), (3.0, 4.0)),
            segment((9.0, 0.0), (12.0, 0.0)),
        ];
        let options = DoorwayOptions::PAPER;
        assert_eq!(walls(&map, &options), [Some(0), Some(0), None, Some(1), Some(2), Some(3)]);
    }
}
