use super::{Point, Segment};

/// An axis-aligned box in metres. [`Bounds::EMPTY`] contains nothing and grows from its first point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: Point,
    pub max: Point,
}

impl Bounds {
    pub const EMPTY: Self =
        Self { min: Point::new(f64::INFINITY, f64::INFINITY), max: Point::new(f64::NEG_INFINITY, f64::NEG_INFINITY) };

    /// The bounding box of points.
    pub fn of(points: impl IntoIterator<Item = Point>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with)
    }

    /// This box grown to hold `point`.
    pub fn with(self, point: Point) -> Self {
        Self {
            min: Point::new(self.min.x.min(point.x), self.min.y.min(point.y)),
            max: Point::new(self.max.x.max(point.x), self.max.y.max(point.y)),
        }
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        if other.is_empty() { self } else { self.with(other.min).with(other.max) }
    }

    /// Grown by `by_m` metres on every side.
    pub fn inflated(self, by_m: f64) -> Self {
        Self {
            min: Point::new(self.min.x - by_m, self.min.y - by_m),
            max: Point::new(self.max.x + by_m, self.max.y + by_m),
        }
    }

    pub fn is_empty(self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y)
    }

    /// Width in metres, 0 when empty.
    pub fn width(self) -> f64 {
        if self.is_empty() { 0.0 } else { self.max.x - self.min.x }
    }

    /// Height in metres, 0 when empty.
    pub fn height(self) -> f64 {
        if self.is_empty() { 0.0 } else { self.max.y - self.min.y }
    }

    pub fn center(self) -> Point {
        self.min.midpoint(self.max)
    }

    pub fn contains(self, point: Point) -> bool {
        point.x >= self.min.x && point.x <= self.max.x && point.y >= self.min.y && point.y <= self.max.y
    }

    /// Whether any point of a segment lies in it.
    pub fn meets(self, segment: Segment) -> bool {
        self.part_of(segment).is_some()
    }

    /// The part of a segment inside it, as fractions in 0..=1 from start to end; clipped at the four
    /// sides (Liang and Barsky 1984).
    pub fn part_of(self, segment: Segment) -> Option<(f64, f64)> {
        let way = segment.vector();
        let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
        let sides = [
            (-way.x, segment.a.x - self.min.x),
            (way.x, self.max.x - segment.a.x),
            (-way.y, segment.a.y - self.min.y),
            (way.y, self.max.y - segment.a.y),
        ];
        for (towards, room) in sides {
            if towards == 0.0 {
                if room < 0.0 {
                    return None;
                }
            } else if towards < 0.0 {
                enters = enters.max(room / towards);
            } else {
                leaves = leaves.min(room / towards);
            }
        }
        (enters <= leaves).then_some((enters, leaves))
    }

    /// Whether the two boxes share at least one point.
    pub fn intersects(self, other: Self) -> bool {
        self.min.x <= other.max.x && other.min.x <= self.max.x && self.min.y <= other.max.y && other.min.y <= self.max.y
    }
}

impl Segment {
    pub fn bounds(self) -> Bounds {
        Bounds::of([self.a, self.b])
    }
}
