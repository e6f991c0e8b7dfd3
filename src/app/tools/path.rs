//! Paths being drawn: shared by tools that draw one corner after the other.

use super::typing::Towards;
use super::{Anchor, Scope, Typed};
use crate::app::paint::preview::{Look, Preview, angle, turn};
use crate::geometry::path::arc;
use crate::geometry::{Point, Segment, Vector};

/// Corners clicked so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Path {
    pub points: Vec<Point>,
    /// The state before each click.
    before: Vec<Before>,
    /// Whether an arc comes next.
    bend: Bend,
}

/// The state before a click.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Before {
    corners: usize,
    /// Whether the plan refused what the click was to draw.
    was_refused: bool,
}

/// The meaning of the next click.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Bend {
    /// A corner.
    #[default]
    Straight,
    /// A point that the arc passes through.
    Through,
    /// The arc's end.
    To { through: Point },
}

/// The hint while drawing an arc.
pub(super) const ARC_HINT: &str = "Arc: click a point on the arc, then its end · A goes back to straight lines";

/// Two points closer than this are the same: the grid of plans.
const SAME_M: f64 = 1e-4;

impl Path {
    /// A path starting at a point.
    pub(super) fn from(point: Point) -> Self {
        Self { points: vec![point], before: vec![Before { corners: 0, was_refused: false }], bend: Bend::Straight }
    }

    /// A path through points that were clicked before.
    pub(super) fn through(points: Vec<Point>) -> Self {
        let before = (0..points.len()).map(|corners| Before { corners, was_refused: false }).collect();
        Self { points, before, bend: Bend::Straight }
    }

    /// Switches the next piece between an arc and a straight line.
    pub(super) fn toggle_arc(&mut self) {
        self.bend = if self.bend == Bend::Straight { Bend::Through } else { Bend::Straight };
    }

    /// Whether an arc is being drawn.
    pub(super) fn is_bending(&self) -> bool {
        self.bend != Bend::Straight
    }

    /// Continues to a point. Returns whether corners were added: the point that an arc passes through is
    /// not one.
    pub(super) fn go_to(&mut self, point: Point, scope: &Scope<'_>) -> bool {
        match (self.bend, self.last()) {
            (Bend::Through, Some(_)) => {
                self.bend = Bend::To { through: point };
                false
            }
            (Bend::To { through }, Some(last)) => {
                self.before.push(Before { corners: self.points.len(), was_refused: false });
                self.bend = Bend::Straight;
                let chords = arc(last, through, point, scope.options.arc_tolerance_m);
                self.points.extend(chords.into_iter().skip(1).map(Point::trimmed));
                true
            }
            _ => {
                self.before.push(Before { corners: self.points.len(), was_refused: false });
                self.points.push(point);
                true
            }
        }
    }

    /// Records that the plan refused what the last click was to draw.
    pub(super) fn was_refused(&mut self) {
        if let Some(last) = self.before.last_mut() {
            last.was_refused = true;
        }
    }

    /// Undoes the last click: a corner, an arc, or the point that an arc was to pass through. Returns
    /// whether there was one, and whether it removed corners already in the plan.
    pub(super) fn take_back(&mut self) -> (bool, bool) {
        if self.bend != Bend::Straight {
            self.bend = Bend::Straight;
            return (true, false);
        }
        match self.before.pop() {
            Some(before) => {
                self.points.truncate(before.corners);
                (true, !before.was_refused)
            }
            None => (false, false),
        }
    }

    /// The line from the last corner to the pointer, as an arc if one is being drawn.
    pub(super) fn next_line(&self, scope: &Scope<'_>) -> Vec<Point> {
        match (self.bend, self.last()) {
            (Bend::To { through }, Some(last)) => arc(last, through, scope.at(), scope.options.arc_tolerance_m),
            (_, Some(last)) => vec![last, scope.at()],
            (_, None) => Vec::new(),
        }
    }

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
        Some(Anchor { from, along: self.along(), right_angles: !self.is_bending() })
    }

    /// The corner that a typed length means: towards the pointer, at the typed angle, or after the typed turn from
    /// the last line; straight on where the pointer is on the last corner.
    pub(super) fn typed_point(&self, typed: Typed, scope: &Scope<'_>) -> Option<Point> {
        let Typed::Length { length_m, towards } = typed else { return None };
        let last = self.last()?;
        let along = self.along().unwrap_or(Vector::new(1.0, 0.0));
        let way = match towards {
            Some(Towards::Angle(angle_rad)) => Vector::new(1.0, 0.0).rotated(angle_rad),
            Some(Towards::Turn(turn_rad)) => along.rotated(turn_rad),
            None => (scope.at() - last).unit().or_else(|| (scope.pointer - last).unit()).unwrap_or(along),
        };
        Some((last + way * length_m).trimmed())
    }

    /// Shows the next line: its length and angle, and its turn from the last one.
    pub(super) fn preview_next(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(last) = self.last().filter(|last| last.distance(scope.at()) >= SAME_M) else { return };
        let segment = Segment::new(last, scope.at());
        let mut text = format!("{}  {}", scope.units.length(segment.length()), angle(segment.vector()));
        let turn = self.along().map(|along| turn(along, segment.vector())).unwrap_or_default();
        if !turn.is_empty() {
            text.push_str(&format!("  {turn}"));
        }
        preview.dimension(segment, text);
    }

    /// Shows the corners clicked so far.
    pub(super) fn preview_corners(&self, preview: &mut Preview) {
        for &point in &self.points {
            preview.handle(point, Look::New);
        }
        if let Bend::To { through } = self.bend {
            preview.handle(through, Look::Guide);
        }
    }
}
