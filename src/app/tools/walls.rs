//! Draws a chain of walls.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::{ARC_HINT, Path};
use super::tool::{GRID, Group, RIGHT_ANGLES, SNAPPING, THICKNESS};
use super::{Call, Entry, Input, Scope, TakenBack, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Line;
use crate::app::paint::preview::{Look, Preview};
use crate::geometry::{Point, Segment};

pub(super) const ENTRY: Entry = Entry {
    id: "tool-walls",
    title: "Walls",
    help: "Draw a chain of walls",
    keys: &[KeyboardShortcut::new(Modifiers::NONE, Key::W)],
    strip: Some((
        Icon::Drawn(&[
            Line(&[(2.2, 13.5), (2.2, 2.2), (13.8, 2.2), (13.8, 9.0)]),
            Line(&[(5.4, 13.5), (5.4, 5.4), (10.6, 5.4), (10.6, 9.0)]),
            Line(&[(2.2, 13.5), (5.4, 13.5)]),
            Line(&[(10.6, 9.0), (13.8, 9.0)]),
        ]),
        Group::Draw,
    )),
    options: &[THICKNESS, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Walls::Ready),
};

enum Walls {
    Ready,
    /// Every wall between these corners is already in the plan.
    Drawing(Path),
}

impl Walls {
    /// Continues to a corner.
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        match self {
            // Ready -> Drawing
            Self::Ready => {
                *self = Self::Drawing(Path::from(point));
                Vec::new()
            }
            // Drawing -> Ready
            Self::Drawing(path) if path.is_last(point) && !path.is_bending() => {
                *self = Self::Ready;
                Vec::new()
            }
            // Drawing -> Drawing, or Ready where the chain is closed
            Self::Drawing(path) => {
                let is_closed = path.closes(point);
                if !path.go_to(point, scope) {
                    return Vec::new();
                }
                let values = [Value::points(&path.points), Value::Number(scope.options.thickness_m)];
                if is_closed {
                    *self = Self::Ready;
                }
                vec![Call::new("draw-walls", values)]
            }
        }
    }
}

impl Tool for Walls {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, &self) {
            (Input::Click, _) => self.to(scope.at(), scope),
            (Input::Typed(typed), Self::Drawing(path)) => match path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            (Input::Key(Key::A), Self::Drawing(_)) => {
                if let Self::Drawing(path) = self {
                    path.toggle_arc();
                }
                Vec::new()
            }
            // Drawing -> Ready
            (Input::Enter | Input::Escape | Input::DoubleClick | Input::SecondaryClick, _) => {
                *self = Self::Ready;
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        match self {
            Self::Ready => "Walls: click where the walls start".to_owned(),
            Self::Drawing(path) if path.is_bending() => ARC_HINT.to_owned(),
            Self::Drawing(_) => {
                "Click the next corner, or type a length: 3.2, 3.2<45 · A: arc · Shift: any angle · Enter ends"
                    .to_owned()
            }
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if let Self::Drawing(path) = self {
            for pair in path.next_line(scope).windows(2) {
                preview.wall(Segment::new(pair[0], pair[1]), scope.options.thickness_m, Look::New);
            }
            path.preview_corners(preview);
            path.preview_next(scope, preview);
        }
    }

    fn path(&self) -> Option<&Path> {
        match self {
            Self::Ready => None,
            Self::Drawing(path) => Some(path),
        }
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        match self {
            Self::Ready => None,
            Self::Drawing(path) => Some(path),
        }
    }

    fn points(&self) -> Vec<Point> {
        self.path().map(|path| path.points.clone()).unwrap_or_default()
    }

    fn resume(&mut self, points: Vec<Point>) {
        *self = Self::Drawing(Path::through(points));
    }

    fn keys(&self) -> &'static [Key] {
        &[Key::A]
    }

    fn was_refused(&mut self) {
        if let Some(path) = self.path_mut() {
            path.was_refused();
        }
    }

    fn take_back(&mut self) -> TakenBack {
        let Self::Drawing(path) = self else { return TakenBack::Nothing };
        let (_, had_corners) = path.take_back();
        if !had_corners {
            return TakenBack::Corner;
        }
        // The first corner is not a wall yet.
        if path.is_empty() {
            *self = Self::Ready;
            TakenBack::Corner
        } else {
            TakenBack::CornerAndStep
        }
    }
}
