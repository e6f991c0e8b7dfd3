//! Corners in the making: what tools share that draw one corner after the other.

use super::preview::{Look, Preview, degrees};
use super::{Anchor, Scope, Typed};
use crate::geometry::{Point, Segment, Vector};

/// Corners clicked so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Path {
    pub points: Vec<Point>,
}

/// Two points closer than this are one: the grid that plans are kept on.
const SAME_M: f64 = 1e-4;

impl Path {
    pub(super) fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    pub(super) fn last(&self) -> Option<Point> {
        self.points.last().copied()
    }

    /// Whether a point is the first one, which closes the path.
    pub(super) fn closes(&self, point: Point) -> bool {
        self.points.len() >= 3 && self.points.first().is_some_and(|first| first.distance(point) < SAME_M)
    }

    /// Whether a point is the last one.
    pub(super) fn is_last(&self, point: Point) -> bool {
        self.last().is_some_and(|last| last.distance(point) < SAME_M)
    }

    /// The direction of the last line.
    pub(super) fn along(&self) -> Option<Vector> {
        let [.., a, b] = self.points.as_slice() else { return None };
        (*b - *a).unit()
    }

    pub(super) fn anchor(&self) -> Option<Anchor> {
        let from = self.last()?;
        Some(Anchor { from, along: self.along(), right_angles: true })
    }

    /// The corner that a typed length means: towards the pointer, or at the typed angle from the last
    /// line.
    pub(super) fn typed_point(&self, typed: Typed, scope: &Scope<'_>) -> Option<Point> {
        let Typed::Length { length_m, angle_rad } = typed else { return None };
        let last = self.last()?;
        let along = self.along().unwrap_or(Vector::new(1.0, 0.0));
        let way = match angle_rad {
            Some(angle_rad) => along.rotated(angle_rad),
            None => (scope.at() - last).unit().or_else(|| (scope.pointer - last).unit())?,
        };
        Some((last + way * length_m).trimmed())
    }

    /// The line that comes next: its length, and its angle to the last one.
    pub(super) fn preview_next(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(last) = self.last().filter(|last| last.distance(scope.at()) >= SAME_M) else { return };
        let segment = Segment::new(last, scope.at());
        let angle = degrees(self.along(), segment.vector());
        let text = format!("{}  {angle}°", scope.units.length(segment.length()));
        preview.dimension(segment, text);
    }

    /// The corners clicked so far.
    pub(super) fn preview_corners(&self, preview: &mut Preview) {
        for &point in &self.points {
            preview.handle(point, Look::New);
        }
    }
}
