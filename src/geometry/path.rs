//! Open and closed paths of straight pieces: arcs as polylines, and parallels.

use super::{Point, TOUCH_M, Vector, polygon};

/// The arc from one point through another to a third as a polyline with both ends included, its chords at
/// most `tolerance_m` from the arc. A straight piece if the three are collinear or the whole arc is
/// within the tolerance.
///
/// A chord over the angle a of a circle of radius r lies r (1 - cos(a / 2)) from its arc.
pub fn arc(from: Point, through: Point, to: Point, tolerance_m: f64) -> Vec<Point> {
    let Some((center, radius_m)) = circle(from, through, to) else { return vec![from, to] };
    let start = from - center;
    let angle_to = |point: Point| {
        let turn = start.cross(point - center).atan2(start.dot(point - center));
        if turn < 0.0 { turn + std::f64::consts::TAU } else { turn }
    };
    let (middle, end) = (angle_to(through), angle_to(to));
    // Counter-clockwise if the middle point comes first that way.
    let sweep = if middle <= end { end } else { end - std::f64::consts::TAU };
    let step = 2.0 * (1.0 - (tolerance_m / radius_m).clamp(1e-6, 1.0)).acos();
    let count = (sweep.abs() / step).ceil().clamp(1.0, ARC_PIECES_LIMIT) as usize;
    let inner = (1..count).map(|i| center + start.rotated(sweep * i as f64 / count as f64));
    std::iter::once(from).chain(inner).chain([to]).collect()
}

/// The most pieces in an arc: a full circle of 100 m radius to a millimetre has 702.
const ARC_PIECES_LIMIT: f64 = 2_000.0;

/// The circle through three points: centre and radius in metres. `None` when they are collinear, or so
/// nearly that the circle would be larger than any drawing.
pub fn circle(a: Point, b: Point, c: Point) -> Option<(Point, f64)> {
    let (u, v) = (b - a, c - a);
    let twice_area = 2.0 * u.cross(v);
    let longest = u.length().max(v.length()).max((c - b).length());
    if twice_area.abs() <= 1e-6 * longest * longest {
        return None;
    }
    let by = (v.left() * u.dot(u) - u.left() * v.dot(v)) * (-1.0 / twice_area);
    Some((a + by, by.length()))
}

/// The parallel of a path, offset by a distance in metres to its left (right when negative) and mitred at
/// its corners; `None` where a piece would reverse because the distance is too large.
///
/// Corners that nearly turn back get no mitre: beyond four times the distance (corners sharper than 29
/// degrees) they are cut off square.
pub fn parallel(path: &[Point], is_closed: bool, distance_m: f64) -> Option<Vec<Point>> {
    let mut path = path.to_vec();
    path.dedup_by(|next, point| next.distance(*point) <= TOUCH_M);
    if is_closed && path.len() > 1 && path[0].distance(path[path.len() - 1]) <= TOUCH_M {
        path.pop();
    }
    let mut directions: Vec<Vector> = path.windows(2).filter_map(|pair| (pair[1] - pair[0]).unit()).collect();
    if is_closed && path.len() > 2 {
        directions.push((path[0] - path[path.len() - 1]).unit()?);
    }
    if directions.is_empty() {
        return None;
    }
    let mut shifted = Vec::with_capacity(path.len());
    // The two ends of each piece on the parallel.
    let mut ends: Vec<[Point; 2]> = directions.iter().map(|_| [Point::default(); 2]).collect();
    let count = directions.len();
    for (i, &at) in path.iter().enumerate() {
        let before = if i > 0 { Some(i - 1) } else { is_closed.then(|| count - 1) };
        let after = (i < count).then_some(i);
        let (first, last) = match (before.map(|k| directions[k]), after.map(|k| directions[k])) {
            (Some(before), Some(after)) => corner(at, before, after, distance_m),
            (Some(only), None) | (None, Some(only)) => {
                let end = at + only.left() * distance_m;
                (end, end)
            }
            (None, None) => continue,
        };
        if let Some(k) = before {
            ends[k][1] = first;
        }
        if let Some(k) = after {
            ends[k][0] = last;
        }
        shifted.push(first);
        if first != last {
            shifted.push(last);
        }
    }
    let keeps_direction = directions.iter().zip(&ends).all(|(direction, [a, b])| (*b - *a).dot(*direction) > TOUCH_M);
    keeps_direction.then_some(shifted)
}

/// Where the parallels of two pieces meet: one point, or two if the corner is cut off.
fn corner(at: Point, before: Vector, after: Vector, distance_m: f64) -> (Point, Point) {
    let normal = before.left() + after.left();
    // The mitre's length over the distance is 2 / |sum of the normals|, that is 1 / cos(turn / 2).
    let squared = normal.dot(normal);
    if squared * MITRE_LIMIT * MITRE_LIMIT >= 4.0 {
        let tip = at + normal * (2.0 * distance_m / squared);
        return (tip, tip);
    }
    (at + before.left() * distance_m, at + after.left() * distance_m)
}

/// The longest mitre, as a multiple of the distance, as in drawing programs.
const MITRE_LIMIT: f64 = 4.0;

/// Whether a ring encloses an area and neither crosses nor touches itself. Quadratic in the number of
/// points: meant for room boundaries.
pub fn is_simple_ring(ring: &[Point]) -> bool {
    let edges: Vec<super::Segment> = polygon::edges(ring).collect();
    let n = edges.len();
    n >= 3
        && (0..n).all(|i| {
            (i + 1..n).all(|j| {
                let neighbours = j == i + 1 || (i == 0 && j == n - 1);
                neighbours || !edges[i].bounds().intersects(edges[j].bounds()) || {
                    super::segments::crossing(edges[i], edges[j]).is_none()
                }
            })
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(coordinates: &[(f64, f64)]) -> Vec<Point> {
        coordinates.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn an_arc_keeps_its_tolerance_and_its_side() {
        let half = arc(Point::new(2.0, 0.0), Point::new(0.0, 2.0), Point::new(-2.0, 0.0), 0.01);
        assert!(half.len() > 10 && half.iter().all(|point| (point.distance(Point::default()) - 2.0).abs() < 1e-9));
        assert!(half.windows(2).all(|pair| pair[0].midpoint(pair[1]).distance(Point::default()) >= 2.0 - 0.01 - 1e-9));
        assert!(half.iter().all(|point| point.y >= -1e-9));
        let other = arc(Point::new(2.0, 0.0), Point::new(0.0, -2.0), Point::new(-2.0, 0.0), 0.01);
        assert!(other.iter().all(|point| point.y <= 1e-9) && other.len() == half.len());
        assert_eq!(arc(Point::new(0.0, 0.0), Point::new(1.0, 0.0), Point::new(2.0, 0.0), 0.01).len(), 2);
        assert_eq!(arc(Point::new(0.0, 0.0), Point::new(0.0, 0.0), Point::new(0.0, 0.0), 0.01).len(), 2);
    }

    #[test]
    fn parallels_are_mitred() {
        let bent = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]);
        assert_eq!(parallel(&bent, false, 1.0), Some(points(&[(0.0, 1.0), (3.0, 1.0), (3.0, 3.0)])));
        assert_eq!(parallel(&bent, false, -1.0), Some(points(&[(0.0, -1.0), (5.0, -1.0), (5.0, 3.0)])));
        let square = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)]);
        assert_eq!(parallel(&square, true, 1.0), Some(points(&[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)])));
        assert_eq!(parallel(&square, true, 2.0), None, "nothing is left of its sides");
        assert_eq!(parallel(&square[..1], false, 1.0), None);
    }
}
