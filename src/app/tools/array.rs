//! Copies what is selected into columns and rows, or around a point, with the ghost of all copies.

use super::ghost::{Selected, ghosts};
use super::tool::{GRID, SNAPPING};
use super::transform::done;
use super::{Anchor, Call, Entry, Input, Scope, TakenBack, Tool, Typed, Typing, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::edit::Array;
use crate::geometry::{Point, Vector};

pub(crate) const ARRAY: Entry = Entry {
    id: "array",
    title: "Array",
    help: "Copy the selection into columns and rows: click a point and where it is on the next copy, type how many",
    keys: &[],
    strip: None,
    options: &[SNAPPING, GRID],
    make: || Box::new(Grid { selected: Selected::default(), from: None, columns: 2, rows: 1 }),
};

pub(crate) const POLAR_ARRAY: Entry = Entry {
    id: "polar-array",
    title: "Array around a point",
    help: "Copy the selection around a point: type how many, click the point",
    keys: &[],
    strip: None,
    options: &[SNAPPING, GRID],
    make: || Box::new(Polar { selected: Selected::default(), count: 4, step_deg: None }),
};

struct Grid {
    selected: Selected,
    /// The point from which the step is shown, once clicked.
    from: Option<Point>,
    columns: usize,
    rows: usize,
}

/// A step shorter than this is none, in metres.
const LEAST_STEP_M: f64 = 0.01;

impl Grid {
    fn array(&self, step: Vector) -> Option<Array> {
        let array = Array::Grid {
            columns: self.columns,
            rows: self.rows,
            column_step: Vector::new(step.x, 0.0),
            row_step: Vector::new(0.0, step.y),
        };
        // Copies on top of the original are none.
        let is_apart =
            (self.columns < 2 || step.x.abs() >= LEAST_STEP_M) && (self.rows < 2 || step.y.abs() >= LEAST_STEP_M);
        is_apart.then_some(array)
    }

    fn place(&self, step: Vector) -> Vec<Call> {
        if self.array(step).is_none() {
            return Vec::new();
        }
        let step = Value::point(Point::default() + step);
        done(Call::new(ARRAY.id, [Value::Count(self.columns), Value::Count(self.rows), step]))
    }
}

impl Tool for Grid {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click | Input::Drop => match self.from {
                // Ready -> Stepping
                None => self.from = Some(scope.at()),
                // Stepping -> done
                Some(from) => return self.place(scope.at() - from),
            },
            Input::DragStart { at, .. } if self.from.is_none() => self.from = Some(at),
            Input::Typed(Typed::Grid { columns, rows, step }) => {
                (self.columns, self.rows) = (columns, rows);
                if let Some(step) = step {
                    return self.place(step);
                }
            }
            Input::Escape | Input::SecondaryClick => self.from = None,
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        let (columns, rows) = (self.columns, self.rows);
        let many = format!("{columns} x {rows}");
        match self.from {
            None => format!(
                "Array of {many}: click a point of the selection · type columns x rows (4x2), or with steps (4x2 \
                 3.5,4)"
            ),
            Some(_) => format!(
                "Array of {many}: click where that point is on the next copy · type columns x rows (4x2) · Esc cancels"
            ),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(from) = self.from else { return };
        let step = scope.at() - from;
        preview.handle(from, Look::New);
        preview.dashed(vec![from, from + step], false, Look::Guide);
        if let Some(places) = self.array(step).and_then(|array| array.places().ok()) {
            ghosts(&self.selected.part(scope), &places, preview);
        }
        let [x, y] = [step.x, step.y].map(|way| scope.units.length(way.abs()));
        let said = match (self.columns > 1, self.rows > 1) {
            (true, false) => format!("{} x 1, every {x}", self.columns),
            (false, _) => format!("1 x {}, every {y}", self.rows),
            (true, true) => format!("{} x {}, every {x} and {y}", self.columns, self.rows),
        };
        preview.label(scope.at(), said, Look::New);
    }

    fn is_busy(&self) -> bool {
        self.from.is_some()
    }

    fn anchor(&self) -> Option<Anchor> {
        self.from.map(|from| Anchor { from, along: None, right_angles: false })
    }

    fn typing(&self) -> Option<Typing> {
        Some(Typing::Grid)
    }

    fn take_back(&mut self) -> TakenBack {
        if self.from.take().is_some() { TakenBack::Corner } else { TakenBack::Nothing }
    }
}

struct Polar {
    selected: Selected,
    count: usize,
    /// From one to the next; all around without.
    step_deg: Option<f64>,
}

impl Polar {
    fn step_deg(&self) -> f64 {
        self.step_deg.unwrap_or(360.0 / self.count.max(1) as f64)
    }

    fn array(&self, about: Point) -> Array {
        Array::Polar { about: about.trimmed(), count: self.count, step_rad: self.step_deg().to_radians() }
    }
}

impl Tool for Polar {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click if self.count > 1 => {
                let about = Value::point(scope.at());
                let arguments = [about, Value::Count(self.count), Value::Number(self.step_deg())];
                return done(Call::new(POLAR_ARRAY.id, arguments));
            }
            Input::Typed(Typed::Polar { count, angle_rad }) => {
                (self.count, self.step_deg) = (count, angle_rad.map(f64::to_degrees));
            }
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, _: &Scope<'_>) -> String {
        let (count, step) = (self.count, crate::base::units::angle(self.step_deg().to_radians()));
        format!("Array of {count}, {step} apart: click the centre · type how many (6), or with the angle (6<30)")
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let about = scope.at();
        if let Ok(places) = self.array(about).places() {
            let part = self.selected.part(scope);
            ghosts(&part, &places, preview);
            preview.dashed(vec![about, part.bounds().center()], false, Look::Guide);
        }
    }

    fn typing(&self) -> Option<Typing> {
        Some(Typing::Polar)
    }
}
