use super::{Point, Vector};

/// A straight piece between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub a: Point,
    pub b: Point,
}

impl Segment {
    pub const fn new(a: Point, b: Point) -> Self {
        Self { a, b }
    }

    pub fn vector(self) -> Vector {
        self.b - self.a
    }

    /// Length in metres.
    pub fn length(self) -> f64 {
        self.vector().length()
    }

    pub fn midpoint(self) -> Point {
        self.a.midpoint(self.b)
    }

    /// The position along the segment of its point nearest to `point`, as a fraction in 0..=1.
    pub fn nearest_fraction(self, point: Point) -> f64 {
        let along = self.vector();
        let squared = along.dot(along);
        if squared <= 0.0 { 0.0 } else { ((point - self.a).dot(along) / squared).clamp(0.0, 1.0) }
    }

    /// The point of the segment nearest to `point`.
    pub fn nearest_point(self, point: Point) -> Point {
        self.a.lerp(self.b, self.nearest_fraction(point))
    }

    /// Distance in metres from `point` to the nearest point of the segment.
    pub fn distance(self, point: Point) -> f64 {
        self.nearest_point(point).distance(point)
    }
}
