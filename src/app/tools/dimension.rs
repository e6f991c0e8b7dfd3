//! Draws dimension chains: first what is measured, point by point, then where the line lies.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::tool::{Group, SNAPPING};
use super::{Call, DrawOptions, Entry, Input, Scope, TakenBack, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Line;
use crate::app::paint::preview::{Look, Preview};
use crate::draw::dimensions;
use crate::edit::dimension_between;
use crate::geometry::{Bounds, Point, Segment};
use crate::plan::DimensionAlong;
use crate::snapping::{Faces, SnapKind};

pub(super) const ENTRY: Entry = Entry {
    id: "tool-dimension",
    title: "Dimension",
    help: "Draw a dimension chain that follows walls and openings",
    keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::T)],
    strip: Some((
        Icon::Drawn(&[
            Line(&[(1.5, 10.0), (14.5, 10.0)]),
            Line(&[(1.8, 11.8), (5.2, 8.2)]),
            Line(&[(10.8, 11.8), (14.2, 8.2)]),
            Line(&[(3.5, 2.5), (3.5, 7.0)]),
            Line(&[(12.5, 2.5), (12.5, 7.0)]),
        ]),
        Group::Measure,
    )),
    options: &[SNAPPING],
    make: || Box::new(Dimension::Picking(Vec::new())),
};

enum Dimension {
    /// What is measured so far.
    Picking(Vec<Point>),
    /// All of what is measured; the next click says where the line lies.
    Placing(Vec<Point>),
}

/// Two points this near, in metres, are one.
const SAME_M: f64 = 1e-3;

impl Dimension {
    fn points(&self) -> &[Point] {
        match self {
            Self::Picking(points) | Self::Placing(points) => points,
        }
    }

    /// Whether a click here is beside everything: it places the line.
    fn is_beside(scope: &Scope<'_>) -> bool {
        matches!(scope.snap.kind, SnapKind::Free | SnapKind::Grid | SnapKind::Alignment)
    }

    /// What is measured and whether the pointer places it.
    fn shown(&self, scope: &Scope<'_>) -> (Vec<Point>, bool) {
        match self {
            Self::Placing(points) => (points.clone(), true),
            Self::Picking(points) if points.len() > 1 && Self::is_beside(scope) => (points.clone(), true),
            Self::Picking(points) => (points.iter().copied().chain([scope.at()]).collect(), false),
        }
    }

    fn place(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        let points = self.points().to_vec();
        if points.len() < 2 {
            return Vec::new();
        }
        let (along, through) = (along(&points, scope.pointer), scope.pointer);
        *self = Self::Picking(Vec::new());
        vec![Call::new("draw-dimension", [Value::points(&points), Value::word(along), Value::point(through)])]
    }
}

/// The direction of a chain by where its line is put: above or below the points a level one, to the left or right of
/// them an upright one; else, and where the points lie in line, one along them.
fn along(points: &[Point], place: Point) -> DimensionAlong {
    let bounds = Bounds::of(points.iter().copied());
    if bounds.height() < SAME_M {
        return DimensionAlong::Horizontal;
    }
    if bounds.width() < SAME_M {
        return DimensionAlong::Vertical;
    }
    let is_within = |value: f64, low: f64, high: f64| (low..=high).contains(&value);
    let columns = is_within(place.x, bounds.min.x, bounds.max.x);
    let rows = is_within(place.y, bounds.min.y, bounds.max.y);
    match (columns, rows) {
        (true, false) => DimensionAlong::Horizontal,
        (false, true) => DimensionAlong::Vertical,
        _ => DimensionAlong::Aligned,
    }
}

impl Tool for Dimension {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, &mut *self) {
            (Input::Click, Self::Placing(_)) => return self.place(scope),
            (Input::Click, Self::Picking(points)) => {
                if points.len() > 1 && Self::is_beside(scope) {
                    return self.place(scope);
                }
                let at = scope.at();
                if points.iter().all(|point| point.distance(at) > SAME_M) {
                    points.push(at);
                }
            }
            // Picking -> Placing
            (Input::Enter | Input::DoubleClick | Input::SecondaryClick, Self::Picking(points)) if points.len() > 1 => {
                *self = Self::Placing(std::mem::take(points));
            }
            (Input::Enter, Self::Placing(_)) => return self.place(scope),
            (Input::Escape, _) => *self = Self::Picking(Vec::new()),
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        match self {
            Self::Picking(points) if points.is_empty() => {
                "Dimension: click what to measure: corners, faces and axes of walls, edges of openings".to_owned()
            }
            Self::Picking(points) if points.len() == 1 => "Click the next point · Esc cancels".to_owned(),
            Self::Picking(_) if Self::is_beside(scope) => {
                "Click to place the line here, or click the next point".to_owned()
            }
            Self::Picking(_) => "Click the next point, or click beside the walls to place the line there".to_owned(),
            Self::Placing(_) => "Click where to place the line · Esc cancels".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let (points, is_placed) = self.shown(scope);
        for &point in self.points() {
            preview.handle(point, Look::New);
        }
        if points.len() < 2 {
            return;
        }
        let along = along(&points, scope.pointer);
        let through = if is_placed { scope.pointer } else { points[0] };
        let line = dimension_between(&points, along, through).ok();
        let Some(line) = line.and_then(|dimension| scope.plan.dimension_line(&dimension)) else { return };
        for (pair, length_m) in line.ticks.windows(2).zip(line.lengths_m()) {
            preview.dimension(Segment::new(pair[0].1, pair[1].1), scope.units.dimension(length_m));
        }
        for &(measured, on_line) in &line.ticks {
            let slash = (line.along + line.along.left()) * scope.metres(5.0);
            preview.line(vec![on_line + -slash, on_line + slash], false, Look::New);
            preview.dashed(vec![measured, on_line], false, Look::Guide);
        }
        if let Some(segment) = dimensions::segment(&line) {
            preview.line(vec![segment.a, segment.b], false, Look::New);
        }
    }

    fn faces(&self, _: &DrawOptions) -> Faces {
        Faces::LikeAxes
    }

    fn snaps(&self) -> bool {
        matches!(self, Self::Picking(_))
    }

    fn is_busy(&self) -> bool {
        !self.points().is_empty()
    }

    fn take_back(&mut self) -> TakenBack {
        match self {
            Self::Placing(points) => *self = Self::Picking(std::mem::take(points)),
            Self::Picking(points) => {
                if points.pop().is_none() {
                    return TakenBack::Nothing;
                }
            }
        }
        TakenBack::Corner
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    #[test]
    fn where_the_line_is_put_says_how_it_runs() {
        let points = [Point::new(0.0, 0.0), Point::new(4.0, 3.0)];
        assert_eq!(along(&points, Point::new(2.0, -1.0)), DimensionAlong::Horizontal);
        assert_eq!(along(&points, Point::new(5.0, 1.0)), DimensionAlong::Vertical);
        assert_eq!(along(&points, Point::new(1.0, 2.0)), DimensionAlong::Aligned);
        let level = [Point::new(0.0, 0.0), Point::new(4.0, 0.0)];
        assert_eq!(along(&level, Point::new(9.0, 1.0)), DimensionAlong::Horizontal);
        let turned = level.map(|point| Point::default() + Vector::new(-point.y, point.x));
        assert_eq!(along(&turned, Point::new(9.0, 1.0)), DimensionAlong::Vertical);
    }
}
