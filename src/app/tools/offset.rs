//! Draws walls beside the selected walls, or inside or outside the selected room: the pointer shows the side and the
//! distance.

use super::tool::{GRID, SNAPPING, THICKNESS};
use super::transform::done;
use super::{Call, Entry, Input, Scope, Tool, Typed, Typing, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::edit;
use crate::geometry::Point;
use crate::plan::WallId;

pub(crate) const OFFSET: Entry = Entry {
    id: "offset",
    title: "Offset copy",
    help: "Draw walls parallel to the selected walls, or inside or outside the selected room: click or type the \
           distance",
    keys: &[],
    strip: None,
    options: &[THICKNESS, SNAPPING, GRID],
    make: || Box::new(Offset),
};

struct Offset;

/// A parallel closer than this is none, in metres.
const LEAST_M: f64 = 0.005;

impl Offset {
    /// How far the pointer is from the nearest of what is selected, in metres.
    fn distance_m(scope: &Scope<'_>, to: Point) -> Option<f64> {
        let lines = edit::lines_to_offset(scope.plan, &walls(scope), scope.selection.rooms().next());
        let distances = lines.iter().map(|line| line.distance(to));
        let nearest_m = distances.fold(f64::INFINITY, f64::min);
        (nearest_m >= LEAST_M && nearest_m.is_finite()).then(|| (nearest_m * 1e4).round() / 1e4)
    }

    fn draw(distance_m: f64, scope: &Scope<'_>) -> Vec<Call> {
        done(Call::new(OFFSET.id, [Value::Number(distance_m), Value::point(scope.pointer)]))
    }
}

fn walls(scope: &Scope<'_>) -> Vec<WallId> {
    scope.selection.walls().collect()
}

impl Tool for Offset {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click => match Self::distance_m(scope, scope.at()) {
                Some(distance_m) => Self::draw(distance_m, scope),
                None => Vec::new(),
            },
            Input::Typed(Typed::Length { length_m, .. }) => Self::draw(length_m, scope),
            _ => Vec::new(),
        }
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        "Offset: click the distance · or type it (0.5), to the side of the pointer".to_owned()
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(distance_m) = Self::distance_m(scope, scope.at()) else { return };
        let (walls, room) = (walls(scope), scope.selection.rooms().next());
        let own_m = scope.options.thickness_m;
        let Ok(paths) = edit::offset_paths(scope.plan, &walls, room, distance_m, scope.pointer, own_m) else { return };
        for (piece, thickness_m) in paths {
            preview.wall(piece, thickness_m, Look::New);
        }
        preview.label(scope.at(), scope.units.length(distance_m), Look::New);
    }

    fn typing(&self) -> Option<Typing> {
        Some(Typing::Width)
    }
}
