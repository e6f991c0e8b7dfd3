//! Draws a room by its corners: it takes only free space, or also what other rooms cover.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::{ARC_HINT, Path};
use super::tool::{GRID, Group, OVER_ROOMS, RIGHT_ANGLES, SNAPPING, THICKNESS_WITH_ROOMS, WITH_WALLS};
use super::{Call, DrawOptions, Entry, Input, Scope, Tool};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::{Disc, Fill, Loop};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, Vector, polygon};
use crate::snapping::Faces;

pub(super) const ENTRY: Entry = Entry {
    id: "tool-room",
    title: "Room by corners",
    help: "Draw a room corner by corner",
    keys: &[KeyboardShortcut::new(Modifiers::SHIFT, Key::R)],
    strip: Some((
        Icon::Drawn(&[
            Loop(&[(2.5, 13.0), (2.5, 3.0), (9.0, 3.0), (9.0, 7.5), (13.5, 7.5), (13.5, 13.0)]),
            Fill(&[(2.5, 13.0), (2.5, 3.0), (9.0, 3.0), (9.0, 7.5), (13.5, 7.5), (13.5, 13.0)]),
            Disc(2.5, 3.0, 1.5),
            Disc(9.0, 3.0, 1.5),
            Disc(13.5, 13.0, 1.5),
        ]),
        Group::Draw,
    )),
    // Clear sizes are in the menu: one more, and the bar covers two lines of a small window.
    options: &[THICKNESS_WITH_ROOMS, WITH_WALLS, OVER_ROOMS, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Room::default()),
};

/// No corners yet, or some.
#[derive(Default)]
struct Room {
    path: Path,
}

impl Room {
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        // Drawing -> Ready
        if !self.path.is_bending() && (self.path.closes(point) || self.path.is_last(point)) {
            return self.close(scope);
        }
        // Ready -> Drawing, Drawing -> Drawing
        self.path.go_to(point, scope);
        Vec::new()
    }

    /// Drawing -> Ready
    fn close(&mut self, scope: &Scope<'_>) -> Vec<Call> {
        let mut points = std::mem::take(&mut self.path).points;
        points.extend(closing_corner(&points, scope));
        if points.len() < 3 {
            return Vec::new();
        }
        vec![scope.options.draw_room(&points)]
    }
}

/// The corner that makes the last two angles right, where it is missing and the first and last lines are
/// perpendicular or parallel: an L of six corners takes five clicks.
fn closing_corner(points: &[Point], scope: &Scope<'_>) -> Option<Point> {
    let [first, second, .., before, last] = points else {
        // Three corners make a rectangle.
        let [first, second, third] = points else { return None };
        let is_right = is_right_angle(*second - *first, *third - *second);
        return (scope.options.right_angles && is_right).then(|| (*first + (*third - *second)).trimmed());
    };
    if !scope.options.right_angles {
        return None;
    }
    let (start, end) = ((*second - *first).unit()?, (*last - *before).unit()?);
    let closing = *first - *last;
    // Already closed at a right angle.
    if closing.unit().is_none_or(|closing| closing.dot(start).abs() < 1e-3 || closing.dot(end).abs() < 1e-3)
        && is_right_angle(start, closing)
    {
        return None;
    }
    // Perpendicular to the first line and to the last one.
    let (p, q) = (start.left(), end.left());
    let denominator = p.cross(q);
    if denominator.abs() < 1e-6 {
        return None;
    }
    let t = (*last - *first).cross(q) / denominator;
    let corner = (*first + p * t).trimmed();
    (corner.distance(*first) > 1e-3 && corner.distance(*last) > 1e-3).then_some(corner)
}

fn is_right_angle(p: Vector, q: Vector) -> bool {
    match (p.unit(), q.unit()) {
        (Some(p), Some(q)) => p.dot(q).abs() < 1e-3,
        _ => false,
    }
}

impl Tool for Room {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => self.to(scope.at(), scope),
            Input::Typed(typed) => match self.path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            Input::Key(Key::A) => {
                self.path.toggle_arc();
                Vec::new()
            }
            Input::Enter | Input::DoubleClick | Input::SecondaryClick => self.close(scope),
            // Drawing -> Ready
            Input::Escape => {
                self.path = Path::default();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if self.path.is_bending() {
            return ARC_HINT.to_owned();
        }
        match self.path.points.len() {
            0 if scope.options.over_rooms => {
                "Room: click the first corner · it takes space of other rooms too".to_owned()
            }
            0 => "Room: click the first corner · it takes only free space, so lines may cross other rooms".to_owned(),
            1 | 2 => {
                "Click the next corner, or type a length (3.2) · Shift: any angle · Ctrl+Z removes a corner".to_owned()
            }
            _ => "Click the next corner · click the first or press Enter to close, with the last corner at a right \
                  angle"
                .to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if self.path.is_empty() {
            return;
        }
        let mut points = self.path.points.clone();
        if !self.path.is_last(scope.at()) && !self.path.closes(scope.at()) {
            points.extend(self.path.next_line(scope).into_iter().skip(1));
        }
        if points.len() >= 3 {
            let closed: Vec<Point> = points.iter().copied().chain(closing_corner(&points, scope)).collect();
            preview.fill(closed.clone(), Vec::new(), Look::New);
            if let (Some(&last), Some(&first)) = (points.last(), points.first()) {
                let mut rest = vec![last];
                rest.extend(closed.get(points.len()).copied());
                rest.push(first);
                preview.dashed(rest, false, Look::New);
            }
            let area_m2 = polygon::signed_area(&closed).abs();
            preview.label(scope.at(), scope.options.drawn_area(area_m2, scope.units), Look::New);
        }
        preview.line(points, false, Look::New);
        self.path.preview_corners(preview);
        self.path.preview_next(scope, preview);
    }

    fn path(&self) -> Option<&Path> {
        Some(&self.path)
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        Some(&mut self.path)
    }

    fn faces(&self, options: &DrawOptions) -> Faces {
        options.faces_for_rooms()
    }

    fn points(&self) -> Vec<Point> {
        self.path.points.clone()
    }

    fn keys(&self) -> &'static [Key] {
        &[Key::A]
    }
}
