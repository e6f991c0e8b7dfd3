//! Draws a rectangular room: it takes only free space, or also what other rooms cover.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::tool::{CLEAR_SIZES, GRID, Group, OVER_ROOMS, SNAPPING, THICKNESS_WITH_ROOMS, WITH_WALLS};
use super::typing::LEAST_SIDE_M;
use super::{Call, DrawOptions, Entry, Input, Scope, TakenBack, Tool, Typed, Typing};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::{Disc, Fill, Loop};
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, Segment, Vector, polygon};
use crate::snapping::Faces;

pub(super) const ENTRY: Entry = Entry {
    id: "tool-rectangle",
    title: "Rectangular room",
    help: "Draw a rectangular room; it fills only what no other room covers",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::R)],
    strip: Some((
        Icon::Drawn(&[
            Loop(&[(2.5, 3.5), (13.5, 3.5), (13.5, 12.5), (2.5, 12.5)]),
            Fill(&[(2.5, 3.5), (13.5, 3.5), (13.5, 12.5), (2.5, 12.5)]),
            Disc(2.5, 3.5, 1.6),
            Disc(13.5, 12.5, 1.6),
        ]),
        Group::Draw,
    )),
    options: &[THICKNESS_WITH_ROOMS, WITH_WALLS, CLEAR_SIZES, OVER_ROOMS, SNAPPING, GRID],
    make: || Box::new(Rectangle::Ready),
};

enum Rectangle {
    Ready,
    /// `along`: the direction of its sides.
    Sized {
        from: Point,
        along: Vector,
    },
}

impl Rectangle {
    /// Ready -> Sized
    fn begin(&mut self, from: Point, scope: &Scope<'_>) {
        // Along the wall it starts on, if that is oblique.
        let index = scope.derived.map(|derived| &derived.index);
        let edges = index.map(|index| index.edges_near(from, scope.metres(1.0))).unwrap_or_default();
        let along = edges.first().and_then(|edge| edge.segment.vector().unit()).unwrap_or(Vector::new(1.0, 0.0));
        *self = Self::Sized { from, along };
    }

    /// Sized -> Ready
    fn end(&mut self, to: Point, scope: &Scope<'_>) -> Vec<Call> {
        let Self::Sized { from, along } = *self else { return Vec::new() };
        let corners = corners(from, to, along);
        let sides = [corners[0].distance(corners[1]), corners[1].distance(corners[2])];
        if sides.into_iter().any(|side| side < LEAST_SIDE_M) {
            return Vec::new();
        }
        *self = Self::Ready;
        vec![scope.options.draw_room(&corners)]
    }
}

/// The corners of a rectangle by two opposite ones and the direction of a side.
fn corners(from: Point, to: Point, along: Vector) -> [Point; 4] {
    let way = to - from;
    let (x, y) = (along * way.dot(along), along.left() * way.dot(along.left()));
    [from, from + x, to, from + y]
}

impl Tool for Rectangle {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, &self) {
            (Input::Click, Self::Ready) => self.begin(scope.at(), scope),
            (Input::DragStart { at, .. }, Self::Ready) => self.begin(at, scope),
            (Input::Click | Input::Drop, Self::Sized { .. }) => return self.end(scope.at(), scope),
            (Input::Typed(Typed::Size { width_m, height_m }), &&mut Self::Sized { from, along }) => {
                // Towards the pointer.
                let way = scope.at() - from;
                let sign = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
                let (u, v) = (along, along.left());
                let to = from + u * (width_m * sign(way.dot(u))) + v * (height_m * sign(way.dot(v)));
                return self.end(to, scope);
            }
            // Sized -> Ready
            (Input::Escape | Input::SecondaryClick, _) => *self = Self::Ready,
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        match self {
            Self::Ready => {
                let takes = if scope.options.over_rooms { "space of other rooms too" } else { "only free space" };
                format!("Rectangle: click a corner, or drag from corner to corner · it takes {takes}")
            }
            Self::Sized { .. } => "Click the opposite corner, or type both sides (4x3) · Esc cancels".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Self::Sized { from, along } = *self else { return };
        let corners = corners(from, scope.at(), along);
        let area_m2 = polygon::signed_area(&corners).abs();
        preview.fill(corners.to_vec(), Vec::new(), Look::New);
        preview.line(corners.to_vec(), true, Look::New);
        for pair in [[corners[0], corners[1]], [corners[1], corners[2]]] {
            let side = Segment::new(pair[0], pair[1]);
            preview.dimension(side, scope.units.length(side.length()));
        }
        if area_m2 > 0.0 {
            preview.label(scope.at(), scope.options.drawn_area(area_m2, scope.units), Look::New);
        }
    }

    fn faces(&self, options: &DrawOptions) -> Faces {
        options.faces_for_rooms()
    }

    fn is_busy(&self) -> bool {
        matches!(self, Self::Sized { .. })
    }

    fn draft(&self) -> Vec<Point> {
        match *self {
            Self::Ready => Vec::new(),
            Self::Sized { from, along } => vec![from, from + along],
        }
    }

    fn resume(&mut self, points: Vec<Point>) {
        if let [from, to] = points.as_slice()
            && let Some(along) = (*to - *from).unit()
        {
            *self = Self::Sized { from: *from, along };
        }
    }

    fn typing(&self) -> Option<Typing> {
        self.is_busy().then_some(Typing::Size)
    }

    fn take_back(&mut self) -> TakenBack {
        if !self.is_busy() {
            return TakenBack::Nothing;
        }
        *self = Self::Ready;
        TakenBack::Corner
    }
}
