//! Measures distances, angles and areas. Changes nothing.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::Path;
use super::tool::{Group, SNAPPING};
use super::{Anchor, Call, DrawOptions, Entry, Input, Scope, TakenBack, Tool, Typing};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::{Line, Loop};
use crate::app::paint::preview::{Look, Preview, angle, between};
use crate::geometry::{Point, Segment, polygon};
use crate::snapping::Faces;

pub(super) const ENTRY: Entry = Entry {
    id: "tool-measure",
    title: "Measure",
    help: "Measure distances, angles and areas",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::T)],
    strip: Some((
        Icon::Drawn(&[
            Loop(&[(1.8, 10.6), (10.6, 1.8), (14.2, 5.4), (5.4, 14.2)]),
            Line(&[(4.4, 8.0), (6.0, 9.6)]),
            Line(&[(6.6, 5.8), (8.8, 8.0)]),
            Line(&[(8.8, 3.6), (10.4, 5.2)]),
        ]),
        Group::Measure,
    )),
    options: &[SNAPPING],
    make: || Box::new(Measure::default()),
};

#[derive(Default)]
struct Measure {
    path: Path,
    /// Whether the measurement is finished: the result stays visible until the next click.
    is_done: bool,
}

impl Measure {
    /// The points measured so far, the pointer's included.
    fn points(&self, scope: &Scope<'_>) -> Vec<Point> {
        let mut points = self.path.points.clone();
        if !self.is_done && !points.is_empty() {
            points.push(scope.at());
        }
        points
    }
}

impl Tool for Measure {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            // Done -> Measuring
            Input::Click if self.is_done || self.path.is_empty() => {
                *self = Self { path: Path::from(scope.at()), is_done: false };
            }
            // Measuring -> Done
            Input::Click if self.path.closes(scope.at()) => {
                self.path.go_to(scope.at(), scope);
                self.is_done = true;
            }
            Input::Click if self.path.is_last(scope.at()) => self.is_done = true,
            // Measuring -> Measuring
            Input::Click => {
                self.path.go_to(scope.at(), scope);
            }
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.is_done = !self.path.is_empty(),
            Input::Escape => *self = Self::default(),
            Input::DragStart { at, .. } => *self = Self { path: Path::from(at), is_done: false },
            Input::Drop => {
                self.path.go_to(scope.at(), scope);
                self.is_done = true;
            }
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        let points = self.points(scope);
        if points.len() < 2 {
            return "Measure: click from point to point · click the first again for an area".to_owned();
        }
        let total_m: f64 = points.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        let mut text = format!("Length {}", scope.units.length(total_m));
        if let [.., a, b] = points.as_slice() {
            let way = *b - *a;
            text.push_str(&format!(
                " · across {} · up {}",
                scope.units.length(way.x.abs()),
                scope.units.length(way.y.abs())
            ));
        }
        if points.len() >= 3 {
            text.push_str(&format!(" · area {}", scope.units.area(polygon::signed_area(&points).abs())));
        }
        text
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let points = self.points(scope);
        if points.len() >= 3 {
            preview.fill(points.clone(), Vec::new(), Look::Guide);
            preview.label(
                polygon::centroid(&points),
                scope.units.area(polygon::signed_area(&points).abs()),
                Look::Guide,
            );
        }
        for pair in points.windows(2) {
            let segment = Segment::new(pair[0], pair[1]);
            preview
                .dimension(segment, format!("{}  {}", scope.units.length(segment.length()), angle(segment.vector())));
        }
        for corner in points.windows(3) {
            // The angle between the two lines.
            if let Some(between) = between(corner[0] - corner[1], corner[2] - corner[1]) {
                preview.label(corner[1], format!("corner {between}"), Look::Guide);
            }
        }
        for &point in &points {
            preview.handle(point, Look::Guide);
        }
        preview.dashed(points, false, Look::Guide);
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        Some(&mut self.path)
    }

    fn anchor(&self) -> Option<Anchor> {
        // Distances are measured in any direction.
        self.path.anchor().map(|anchor| Anchor { right_angles: false, ..anchor })
    }

    fn faces(&self, _: &DrawOptions) -> Faces {
        Faces::LikeAxes
    }

    fn points(&self) -> Vec<Point> {
        self.path.points.clone()
    }

    fn is_drawing(&self) -> bool {
        false
    }

    // Nothing is drawn: no length is typed.
    fn typing(&self) -> Option<Typing> {
        None
    }

    fn take_back(&mut self) -> TakenBack {
        self.is_done = false;
        if self.path.take_back().0 { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
