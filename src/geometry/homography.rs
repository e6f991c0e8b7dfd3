//! Maps between a plane and its picture in perspective.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::Point;

/// A projective map of the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Homography(Matrix3<f64>);

/// Below this share of the largest term, the third coordinate counts as zero: the point lies on the horizon.
const HORIZON: f64 = 1e-9;

impl Homography {
    /// The map that takes four points to four others; `None` where three of either lie on a line, or a coordinate is
    /// not finite.
    pub fn between(from: [Point; 4], to: [Point; 4]) -> Option<Self> {
        // About their middles and of a size near 1, so that the equations are well conditioned (Hartley 1997).
        let (near_from, near_to) = (normalising(&from)?, normalising(&to)?);
        let (from, to) = (from.map(|p| applied(&near_from, p)), to.map(|p| applied(&near_to, p)));
        if has_three_in_line(&from) || has_three_in_line(&to) {
            return None;
        }
        let mut left = SMatrix::<f64, 8, 8>::zeros();
        let mut right = SVector::<f64, 8>::zeros();
        for (i, (p, q)) in from.iter().zip(&to).enumerate() {
            let rows = [
                [p.x, p.y, 1.0, 0.0, 0.0, 0.0, -p.x * q.x, -p.y * q.x],
                [0.0, 0.0, 0.0, p.x, p.y, 1.0, -p.x * q.y, -p.y * q.y],
            ];
            for (k, row) in rows.iter().enumerate() {
                for (column, value) in row.iter().enumerate() {
                    left[(2 * i + k, column)] = *value;
                }
            }
            (right[2 * i], right[2 * i + 1]) = (q.x, q.y);
        }
        let h = left.lu().solve(&right)?;
        let between = Matrix3::new(h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1.0);
        let whole = near_to.try_inverse()? * between * near_from;
        let is_finite = whole.iter().all(|value| value.is_finite());
        let map = Self(whole);
        (is_finite && map.inverse().is_some()).then_some(map)
    }

    /// Where a point goes; `None` on the horizon.
    pub fn apply(&self, point: Point) -> Option<Point> {
        let mapped = self.0 * Vector3::new(point.x, point.y, 1.0);
        let size = (self.0[(2, 0)] * point.x).abs() + (self.0[(2, 1)] * point.y).abs() + self.0[(2, 2)].abs();
        let is_near = mapped.z.abs() > HORIZON * size;
        let there = Point::new(mapped.x / mapped.z, mapped.y / mapped.z);
        (is_near && there.is_finite()).then_some(there)
    }

    /// On which side of the horizon a point lies: the sign of its third coordinate.
    pub fn side(&self, point: Point) -> f64 {
        (self.0[(2, 0)] * point.x + self.0[(2, 1)] * point.y + self.0[(2, 2)]).signum()
    }

    /// The way back; `None` where several points go to one.
    pub fn inverse(&self) -> Option<Self> {
        let inverse = self.0.try_inverse()?;
        inverse.iter().all(|value| value.is_finite()).then_some(Self(inverse))
    }
}

/// Moves points about the origin, a length of 1 from it on average.
fn normalising(points: &[Point; 4]) -> Option<Matrix3<f64>> {
    let (x, y) = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.x / 4.0, sum.1 + p.y / 4.0));
    let middle = Point::new(x, y);
    let size = points.iter().map(|p| p.distance(middle)).sum::<f64>() / 4.0;
    let scale = 1.0 / size;
    (size > 0.0 && scale.is_finite() && size.is_finite())
        .then(|| Matrix3::new(scale, 0.0, -x * scale, 0.0, scale, -y * scale, 0.0, 0.0, 1.0))
}

/// Whether three of four points of a size near 1 lie on a line, up to rounding.
fn has_three_in_line(points: &[Point; 4]) -> bool {
    (0..4).any(|left_out| {
        let mut others = (0..4).filter(|&index| index != left_out).map(|index| points[index]);
        match (others.next(), others.next(), others.next()) {
            (Some(a), Some(b), Some(c)) => (b - a).cross(c - a).abs() <= HORIZON,
            _ => true,
        }
    })
}

fn applied(map: &Matrix3<f64>, point: Point) -> Point {
    let mapped = map * Vector3::new(point.x, point.y, 1.0);
    Point::new(mapped.x / mapped.z, mapped.y / mapped.z)
}

/// How wide a photographed rectangle is for its height. `corners`: the upper left, upper right, lower right and lower
/// left one on the photograph; `middle`: the middle of the photograph, where the camera looked.
///
/// For a camera with square pixels the vanishing points of the two sides give its focal length, and that the ratio
/// (Zhang and He, 'Whiteboard scanning and image enhancement', 2007, equations 11 and 20). Where the sides are all but
/// parallel on the photograph, nothing can be said of the focal length, nor need be: then it is the ratio of their
/// mean lengths.
pub fn side_ratio(corners: [Point; 4], middle: Point) -> f64 {
    let [upper_left, upper_right, lower_right, lower_left] = corners;
    let mean = (upper_left.distance(upper_right) + lower_left.distance(lower_right))
        / (upper_left.distance(lower_left) + upper_right.distance(lower_right));
    perspective_ratio(corners, middle).unwrap_or(mean)
}

/// The ratio by the focal length, where there is one that a camera may have.
fn perspective_ratio(corners: [Point; 4], middle: Point) -> Option<f64> {
    // A focal length, in sizes of the rectangle on the photograph.
    const FOCAL: std::ops::RangeInclusive<f64> = 0.2..=50.0;
    let size = corners[0].distance(corners[2]).max(corners[1].distance(corners[3]));
    let [m1, m2, m4, m3] = corners.map(|p| Vector3::new((p.x - middle.x) / size, (p.y - middle.y) / size, 1.0));
    let k2 = m1.cross(&m4).dot(&m3) / m2.cross(&m4).dot(&m3);
    let k3 = m1.cross(&m4).dot(&m2) / m3.cross(&m4).dot(&m2);
    let (n2, n3) = (m2 * k2 - m1, m3 * k3 - m1);
    let squared = -(n2.x * n3.x + n2.y * n3.y) / (n2.z * n3.z);
    let focal = squared.sqrt();
    if !FOCAL.contains(&focal) {
        return None;
    }
    let length = |n: Vector3<f64>| ((n.x * n.x + n.y * n.y) / squared + n.z * n.z).sqrt();
    let ratio = length(n2) / length(n3);
    (0.01..=100.0).contains(&ratio).then_some(ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: [(f64, f64); 4]) -> [Point; 4] {
        list.map(|(x, y)| Point::new(x, y))
    }

    #[test]
    fn four_points_go_to_four_and_back() {
        let from = points([(100.0, 80.0), (900.0, 120.0), (820.0, 700.0), (60.0, 640.0)]);
        let to = points([(0.0, 0.0), (800.0, 0.0), (800.0, 600.0), (0.0, 600.0)]);
        let map = Homography::between(from, to).expect("a map");
        let back = map.inverse().expect("a way back");
        for (p, q) in from.into_iter().zip(to) {
            assert!(map.apply(p).expect("a point").distance(q) < 1e-9);
            assert!(back.apply(q).expect("a point").distance(p) < 1e-9);
        }
        // Lines stay lines: the crossing of the diagonals.
        let middle = map.apply(crossing(from)).expect("a point");
        assert!(middle.distance(Point::new(400.0, 300.0)) < 1e-9, "{middle:?}");
        let line = points([(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (0.0, 5.0)]);
        assert_eq!(Homography::between(line, to), None);
        assert_eq!(Homography::between([from[0]; 4], to), None);
        let endless = [Point::new(f64::NAN, 0.0), from[1], from[2], from[3]];
        assert_eq!(Homography::between(endless, to), None);
    }

    /// Where the diagonals of a quadrilateral cross.
    fn crossing([a, b, c, d]: [Point; 4]) -> Point {
        let (ac, bd) = (c - a, d - b);
        a + ac * ((b - a).cross(bd) / ac.cross(bd))
    }

    /// What a camera above the middle of a rectangle, tilted and turned, sees of it.
    fn photographed(width: f64, height: f64, tilt_rad: f64, turn_rad: f64) -> [Point; 4] {
        let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
        corners.map(|(x, y)| {
            let (x, y) = (x * width / 2.0, y * height / 2.0);
            let (x, y) = (x * turn_rad.cos() - y * turn_rad.sin(), x * turn_rad.sin() + y * turn_rad.cos());
            // About the x axis, then away.
            let (y, z) = (y * tilt_rad.cos(), y * tilt_rad.sin());
            let depth = 3.0 * width.max(height) + z;
            Point::new(2000.0 + 2400.0 * x / depth, 1500.0 - 2400.0 * y / depth)
        })
    }

    #[test]
    fn the_ratio_of_a_photographed_rectangle_is_found() {
        let middle = Point::new(2000.0, 1500.0);
        for (width, height) in [(8.0, 6.0), (1.0, 3.0), (5.0, 5.0)] {
            for (tilt_rad, turn_rad) in [(0.6, 0.3), (0.9, 0.5), (0.4, -0.4)] {
                let ratio = side_ratio(photographed(width, height, tilt_rad, turn_rad), middle);
                assert!((ratio / (width / height) - 1.0).abs() < 1e-6, "{ratio} of {width} by {height}");
            }
            // Straight from above: parallel sides.
            let ratio = side_ratio(photographed(width, height, 0.0, 0.2), middle);
            assert!((ratio / (width / height) - 1.0).abs() < 1e-6, "{ratio} of {width} by {height}");
        }
    }
}
