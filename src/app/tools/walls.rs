//! Draws a chain of walls.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::path::{ARC_HINT, Path};
use super::tool::{GRID, Group, RIGHT_ANGLES, ROOMS_FROM_WALLS, SNAPPING, THICKNESS, WALL_SIDE};
use super::{Call, DrawOptions, Entry, Input, Scope, TakenBack, Tool, Value};
use crate::app::look::icons::Icon;
use crate::app::look::icons::Part::Line;
use crate::app::paint::preview::{Look, Preview};
use crate::edit::{self, Built, Lies};
use crate::geometry::Point;
use crate::plan::DEFAULT_WALL_THICKNESS_M;
use crate::snapping::Faces;

/// How far from its axis a face may be clicked, in metres: at a corner of the thickest wall there can be, of 10 m.
const FACES_WITHIN_M: f64 = 7.1;

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
    options: &[THICKNESS, WALL_SIDE, ROOMS_FROM_WALLS, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Walls::Ready),
};

enum Walls {
    Ready,
    /// Every wall between these corners is already in the plan.
    Drawing {
        path: Path,
        /// How each of them is built.
        built: Vec<Built>,
    },
}

/// What is drawn of a chain: the walls that are built like the last one, and the one before them.
struct Run<'a> {
    line: &'a [Point],
    built: Built,
    drawn: Option<Built>,
}

impl<'a> Run<'a> {
    /// `built` has an entry for each piece of the line.
    fn of(line: &'a [Point], built: &[Built]) -> Option<Self> {
        let last = *built.last()?;
        let before = built.iter().rposition(|other| *other != last);
        let start = before.unwrap_or(0);
        Some(Self {
            line: line.get(start..)?,
            built: last,
            drawn: before.and_then(|before| built.get(before).copied()),
        })
    }

    fn call(&self) -> Call {
        let Built { thickness_m, lies } = self.built;
        let mut values = vec![Value::points(self.line), Value::Number(thickness_m)];
        if lies != Lies::Centre || self.drawn.is_some() {
            values.push(Value::word(lies));
        }
        if let Some(Built { thickness_m, lies }) = self.drawn {
            values.extend([Value::Number(thickness_m), Value::word(lies)]);
        }
        Call::new("draw-walls", values)
    }
}

impl Walls {
    /// Continues to a corner.
    fn to(&mut self, point: Point, scope: &Scope<'_>) -> Vec<Call> {
        match self {
            // Ready -> Drawing
            Self::Ready => {
                *self = Self::Drawing { path: Path::from(point), built: Vec::new() };
                Vec::new()
            }
            // Drawing -> Ready
            Self::Drawing { path, .. } if path.is_last(point) && !path.is_bending() => {
                *self = Self::Ready;
                Vec::new()
            }
            // Drawing -> Drawing, or Ready where the chain is closed
            Self::Drawing { path, built } => {
                let is_closed = path.closes(point);
                if !path.go_to(point, scope) {
                    return Vec::new();
                }
                built.resize(path.points.len().saturating_sub(1), scope.options.built());
                let calls = Run::of(&path.points, built).map(|run| run.call()).into_iter().collect();
                if is_closed {
                    *self = Self::Ready;
                }
                calls
            }
        }
    }
}

impl Tool for Walls {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, &self) {
            (Input::Click, _) => self.to(scope.at(), scope),
            (Input::Key(Key::S), Self::Drawing { .. }) => vec![Call::new("wall-side", [])],
            (Input::Typed(typed), Self::Drawing { path, .. }) => match path.typed_point(typed, scope) {
                Some(point) => self.to(point, scope),
                None => Vec::new(),
            },
            (Input::Key(Key::A), Self::Drawing { .. }) => {
                if let Self::Drawing { path, .. } = self {
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
            Self::Drawing { path, .. } if path.is_bending() => ARC_HINT.to_owned(),
            Self::Drawing { .. } => {
                "Click the next corner, or type a length: 3.2, 3.2<45 (angle), 3.2<<30 (turn) · S: side · A: arc · \
                 Shift: any angle · Enter ends"
                    .to_owned()
            }
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        if let Self::Drawing { path, built } = self {
            let line: Vec<Point> =
                path.points.iter().copied().chain(path.next_line(scope).into_iter().skip(1)).collect();
            let mut built = built.clone();
            let stand = built.len();
            built.resize(line.len().saturating_sub(1), scope.options.built());
            if let Some(run) = Run::of(&line, &built) {
                let near =
                    |at| scope.derived.map_or_else(Vec::new, |derived| derived.index.walls_near(at, FACES_WITHIN_M));
                let walls = edit::walls_beside(&near, run.line, run.built, run.drawn);
                // Those that stand are in the plan.
                let new = built.len() - stand;
                for &(axis, thickness_m) in walls.iter().rev().take(new) {
                    preview.wall(axis, thickness_m, Look::New);
                }
            }
            path.preview_corners(preview);
            path.preview_next(scope, preview);
        }
    }

    fn path(&self) -> Option<&Path> {
        match self {
            Self::Ready => None,
            Self::Drawing { path, .. } => Some(path),
        }
    }

    fn path_mut(&mut self) -> Option<&mut Path> {
        match self {
            Self::Ready => None,
            Self::Drawing { path, .. } => Some(path),
        }
    }

    fn faces(&self, options: &DrawOptions) -> Faces {
        // Who draws by faces aims at faces.
        if options.lies == Lies::Centre { Faces::BehindAxes } else { Faces::LikeAxes }
    }

    fn points(&self) -> Vec<Point> {
        self.path().map(|path| path.points.clone()).unwrap_or_default()
    }

    fn resume(&mut self, points: Vec<Point>) {
        let path = Path::through(points);
        // How they were built is not known: by their axes they go on as they are.
        let built = Built { thickness_m: DEFAULT_WALL_THICKNESS_M, lies: Lies::Centre };
        let built = vec![built; path.points.len().saturating_sub(1)];
        *self = Self::Drawing { path, built };
    }

    fn keys(&self) -> &'static [Key] {
        &[Key::A, Key::S]
    }

    fn was_refused(&mut self) {
        if let Some(path) = self.path_mut() {
            path.was_refused();
        }
    }

    fn take_back(&mut self) -> TakenBack {
        let Self::Drawing { path, built } = self else { return TakenBack::Nothing };
        let (_, had_corners) = path.take_back();
        built.truncate(path.points.len().saturating_sub(1));
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
