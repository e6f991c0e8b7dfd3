//! Finds where on its rooms' boundaries an opening lies, given one point.

use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::{Point, Segment, Vector, polygon};
use crate::plan::{CornerId, DEFAULT_DOOR_WIDTH_M, Place, THICKEST_WALL_M};

/// The most edges tried for an opening, nearest first. A real one has 2 to 8 nearby.
const NEAR_LIMIT: usize = 32;

/// The outer boundary of a room that an opening joins.
#[derive(Clone, Copy)]
pub struct Ring<'a> {
    pub corners: &'a [CornerId],
    /// The positions of the corners, in metres.
    pub points: &'a [Point],
}

impl Ring<'_> {
    fn edge(&self, index: usize) -> Segment {
        let n = self.points.len();
        Segment::new(self.points[index % n], self.points[(index + 1) % n])
    }

    fn edges(&self) -> impl Iterator<Item = Segment> + '_ {
        polygon::edges(self.points)
    }

    /// Distance in metres from a point to the boundary.
    pub fn distance(&self, point: Point) -> f64 {
        self.edges().map(|edge| edge.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// How far the boundary continues straight past an end of an edge, in metres, up to `most_m`.
    fn straight_m(&self, index: usize, forward: bool, most_m: f64) -> f64 {
        let n = self.points.len();
        let direction = self.edge(index).vector();
        let mut length_m = 0.0;
        for step in 1..n {
            let next = self.edge(if forward { index + step } else { index + n - step });
            if length_m >= most_m || turn_rad(direction, next.vector()) > ANGLE_TOLERANCE_RAD {
                break;
            }
            length_m += next.length();
        }
        length_m.min(most_m)
    }
}

/// The result of placing an opening.
pub struct Placed {
    pub place: Place,
    /// Distance in metres from the point to the edge it was put on.
    pub off_m: f64,
}

/// Places an opening of [`DEFAULT_DOOR_WIDTH_M`] with its middle at a point, on an edge of the boundaries
/// of the one or two rooms it joins; `None` if they have no edge.
///
/// The middle is the foot of the perpendicular from the point to the edge. If the opening would extend
/// past the end of its straight wall, it is shifted until it fits. The edge is chosen by the least sum
/// of: distance to the point, this shift, the amount the wall is too short by, and a metre if no edge of
/// the other room runs alongside; ties go to the longest.
pub fn place(rings: &[Ring<'_>], point: Point) -> Option<Placed> {
    const HALF_M: f64 = DEFAULT_DOOR_WIDTH_M / 2.0;
    let nearest_m = rings.iter().map(|ring| ring.distance(point)).fold(f64::INFINITY, f64::min);
    // Other edges nearby may suit better; half a door away, the next wall's doors start.
    let mut near: Vec<(f64, usize, usize)> = Vec::new();
    for (which, ring) in rings.iter().enumerate() {
        let edges = ring.edges().enumerate().filter(|(_, edge)| edge.length() > 0.0);
        let with_distance = edges.map(|(index, edge)| (edge.distance(point), which, index));
        near.extend(with_distance.filter(|&(off_m, ..)| off_m <= nearest_m + HALF_M));
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    near.truncate(NEAR_LIMIT);
    let mut best: Option<((i64, i64), Placed)> = None;
    for (off_m, which, index) in near {
        let ring = &rings[which];
        let edge = ring.edge(index);
        let length_m = edge.length();
        let foot_m = edge.nearest_fraction(point) * length_m;
        let before_m = foot_m + ring.straight_m(index, false, HALF_M);
        let after_m = length_m - foot_m + ring.straight_m(index, true, HALF_M);
        let lacking_m = (2.0 * HALF_M - before_m - after_m).max(0.0);
        let wanted_m = if lacking_m > 0.0 {
            foot_m + (after_m - before_m) / 2.0
        } else {
            foot_m + (HALF_M - before_m).max(0.0) - (HALF_M - after_m).max(0.0)
        };
        let at_m = wanted_m.clamp(0.0, length_m);
        let is_shared = rings.iter().enumerate().all(|(other, ring)| {
            other == which || ring.edges().any(|other| runs_alongside(other, edge, at_m, nearest_m + THICKEST_WALL_M))
        });
        let cost_m = off_m + (at_m - foot_m).abs() + lacking_m + if is_shared { 0.0 } else { 1.0 };
        // Compared to the millimetre, so that rounding does not decide.
        let millimetres = |length_m: f64| (length_m * 1000.0).round() as i64;
        let rank = (millimetres(cost_m), -millimetres(length_m));
        if best.as_ref().is_none_or(|(best, _)| rank < *best) {
            let to = ring.corners[(index + 1) % ring.corners.len()];
            let place = Place::Hosted { from: ring.corners[index], to, at_m, width_m: DEFAULT_DOOR_WIDTH_M };
            best = Some((rank, Placed { place, off_m }));
        }
    }
    best.map(|(_, placed)| placed)
}

/// The likely position of an opening when only its rooms are known: the point of the larger room's
/// boundary nearest to the middle of the smaller one; for a single room, the middle of its longest edge.
pub fn likely_point(rings: &[Ring<'_>]) -> Option<Point> {
    let area = |ring: &Ring<'_>| polygon::signed_area(ring.points).abs();
    match rings {
        [] => None,
        [ring] => ring.edges().max_by(|a, b| a.length().total_cmp(&b.length())).map(Segment::midpoint),
        [a, b, ..] => {
            let (small, large) = if area(a) <= area(b) { (a, b) } else { (b, a) };
            let middle = polygon::centroid(small.points);
            let edges = large.edges();
            edges
                .min_by(|a, b| a.distance(middle).total_cmp(&b.distance(middle)))
                .map(|edge| edge.nearest_point(middle))
        }
    }
}

/// Whether an edge is parallel to an opening's wall, at most `most_m` away from it, and alongside at
/// least half of it.
fn runs_alongside(other: Segment, wall: Segment, at_m: f64, most_m: f64) -> bool {
    let Some(direction) = wall.vector().unit().filter(|_| is_parallel(wall.vector(), other.vector())) else {
        return false;
    };
    let along = |point: Point| (point - wall.a).dot(direction) - at_m;
    let (from_m, to_m) = (along(other.a).min(along(other.b)), along(other.a).max(along(other.b)));
    let beside_m = to_m.min(DEFAULT_DOOR_WIDTH_M / 2.0) - from_m.max(-DEFAULT_DOOR_WIDTH_M / 2.0);
    beside_m >= DEFAULT_DOOR_WIDTH_M / 2.0 && other.distance(wall.a + direction * at_m) <= most_m
}

/// The angle in radians between two directions.
fn turn_rad(from: Vector, to: Vector) -> f64 {
    from.cross(to).abs().atan2(from.dot(to))
}

/// Whether two directions are the same or opposite, within the tolerance for wall runs.
fn is_parallel(a: Vector, b: Vector) -> bool {
    let turn = turn_rad(a, b);
    turn.min(std::f64::consts::PI - turn) <= ANGLE_TOLERANCE_RAD
}
