use super::{Point, Vector};

/// A similarity transform of the plane: moves, turns, mirrors, uniform scalings, and their compositions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// The images of the unit vectors along x and y.
    x: Vector,
    y: Vector,
    /// The image of the origin.
    origin: Point,
}

impl Transform {
    /// Leaves everything in place.
    pub const IDENTITY: Self =
        Self { x: Vector::new(1.0, 0.0), y: Vector::new(0.0, 1.0), origin: Point::new(0.0, 0.0) };

    /// Moves by a vector in metres.
    pub fn translation(by: Vector) -> Self {
        Self { origin: Point::default() + by, ..Self::IDENTITY }
    }

    /// Rotates counter-clockwise about a point by an angle in radians; quarter turns are exact.
    pub fn rotation(about: Point, angle_rad: f64) -> Self {
        let quarters = angle_rad / std::f64::consts::FRAC_PI_2;
        let x = if (quarters - quarters.round()).abs() < 1e-12 {
            let unit = [Vector::new(1.0, 0.0), Vector::new(0.0, 1.0), Vector::new(-1.0, 0.0), Vector::new(0.0, -1.0)];
            unit[quarters.round().rem_euclid(4.0) as usize % 4]
        } else {
            Vector::new(1.0, 0.0).rotated(angle_rad)
        };
        Self { x, y: x.left(), origin: Point::default() }.about(about)
    }

    /// Mirrors across the line through two points; `None` if they coincide.
    pub fn reflection(a: Point, b: Point) -> Option<Self> {
        let along = (b - a).unit()?;
        // The unit vectors mirrored across the direction: 2 (v . d) d - v.
        let mirrored = |v: Vector| along * (2.0 * v.dot(along)) - v;
        let (x, y) = (mirrored(Vector::new(1.0, 0.0)), mirrored(Vector::new(0.0, 1.0)));
        Some(Self { x, y, origin: Point::default() }.about(a))
    }

    /// Scales by a factor about a point.
    pub fn scaling(about: Point, factor: f64) -> Self {
        Self { x: Vector::new(factor, 0.0), y: Vector::new(0.0, factor), origin: Point::default() }.about(about)
    }

    /// Turns a map that fixes the origin into one that fixes the given point instead.
    fn about(self, fixed: Point) -> Self {
        let back = self.vector(fixed - Point::default());
        Self { origin: fixed - back, ..self }
    }

    /// Applies this map, then another.
    pub fn then(self, next: Self) -> Self {
        Self { x: next.vector(self.x), y: next.vector(self.y), origin: next.point(self.origin) }
    }

    /// The map that undoes this one; `None` for a scaling by 0.
    pub fn inverse(self) -> Option<Self> {
        // The inverse of a similarity is its transpose over the factor squared.
        let squared = self.x.dot(self.x);
        if squared <= 0.0 {
            return None;
        }
        let x = Vector::new(self.x.x, self.y.x) * (1.0 / squared);
        let y = Vector::new(self.x.y, self.y.y) * (1.0 / squared);
        let back = Self { x, y, origin: Point::default() };
        let origin = Point::default() + -back.vector(self.origin - Point::default());
        Some(Self { origin, ..back })
    }

    /// Maps a point.
    pub fn point(self, point: Point) -> Point {
        self.origin + self.x * point.x + self.y * point.y
    }

    /// Maps a vector.
    pub fn vector(self, vector: Vector) -> Vector {
        self.x * vector.x + self.y * vector.y
    }

    /// Whether it swaps left and right.
    pub fn mirrors(self) -> bool {
        self.x.cross(self.y) < 0.0
    }

    /// The scale factor; 1 up to rounding for maps that keep lengths.
    pub fn factor(self) -> f64 {
        self.x.length()
    }

    /// Whether it keeps lengths, up to rounding.
    pub fn keeps_lengths(self) -> bool {
        (self.factor() - 1.0).abs() < 1e-9
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_does_what_it_says() {
        let (p, about) = (Point::new(3.0, 1.0), Point::new(1.0, 1.0));
        assert_eq!(Transform::translation(Vector::new(1.0, 2.0)).point(p), Point::new(4.0, 3.0));
        let quarter = Transform::rotation(about, std::f64::consts::FRAC_PI_2);
        assert_eq!(quarter.point(p), Point::new(1.0, 3.0));
        assert_eq!(quarter.then(quarter).then(quarter).then(quarter), Transform::IDENTITY);
        assert!(Transform::rotation(about, 0.3).then(Transform::rotation(about, -0.3)).point(p).distance(p) < 1e-12);
        let mirror = Transform::reflection(about, Point::new(1.0, 5.0)).unwrap();
        assert_eq!((mirror.point(p), mirror.mirrors()), (Point::new(-1.0, 1.0), true));
        assert_eq!(Transform::reflection(about, about), None);
        let twice = Transform::scaling(about, 2.0);
        assert_eq!((twice.point(p), twice.factor(), twice.keeps_lengths()), (Point::new(5.0, 1.0), 2.0, false));
        assert!(quarter.keeps_lengths() && !quarter.mirrors());
        for one in [quarter, mirror, twice, Transform::rotation(about, 0.7).then(mirror).then(twice)] {
            assert!(one.inverse().unwrap().point(one.point(p)).distance(p) < 1e-12);
        }
        assert_eq!(Transform::scaling(about, 0.0).inverse(), None);
    }
}
