//! Makes a photographed drawing flat: four corners of a rectangle of it are clicked, its sides typed or estimated.

use super::{Call, Entry, Input, Scope, TakenBack, Tool, Typed, Typing, Value};
use crate::app::paint::preview::{Look, Preview};
use crate::edit::in_order;
use crate::geometry::{Homography, Point, Segment};

pub(crate) const ENTRY: Entry = Entry {
    id: "tool-rectify",
    title: "Make flat by four corners",
    help: "Click the four corners of a rectangle in a photographed drawing, then type its sides or have them estimated",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Rectify::default()),
};

#[derive(Default)]
struct Rectify {
    corners: Vec<Point>,
}

/// Two clicks closer than this, in points, are one: hands tremble.
const LEAST_PX: f64 = 6.0;

/// The preview's lines in each direction.
const LINES: i32 = 8;

impl Rectify {
    /// The four corners in order, once there are so many.
    fn rectangle(&self) -> Option<[Point; 4]> {
        let corners: [Point; 4] = self.corners.as_slice().try_into().ok()?;
        in_order(corners).ok()
    }

    fn flat(&mut self, sides_m: Option<[f64; 2]>) -> Vec<Call> {
        let Some(corners) = self.rectangle() else { return Vec::new() };
        self.corners.clear();
        let sides = sides_m.into_iter().flatten().map(Value::Number);
        vec![Call::new("rectify-picture", std::iter::once(Value::points(&corners)).chain(sides))]
    }
}

impl Tool for Rectify {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click if self.corners.len() < 4 => {
                let is_far = |corner: &Point| corner.distance(scope.pointer) >= scope.metres(LEAST_PX);
                if self.corners.iter().all(is_far) {
                    self.corners.push(scope.pointer);
                }
                // What is no rectangle is begun anew at its last corner.
                if self.corners.len() == 4 && self.rectangle().is_none() {
                    self.corners.pop();
                }
                Vec::new()
            }
            // The nearest corner is corrected.
            Input::Click => {
                let nearest = self
                    .corners
                    .iter_mut()
                    .min_by(|p, q| p.distance(scope.pointer).total_cmp(&q.distance(scope.pointer)));
                if let Some(nearest) = nearest {
                    let before = std::mem::replace(nearest, scope.pointer);
                    if self.rectangle().is_none()
                        && let Some(moved) = self.corners.iter_mut().find(|corner| **corner == scope.pointer)
                    {
                        *moved = before;
                    }
                }
                Vec::new()
            }
            Input::Typed(Typed::Size { width_m, height_m }) => self.flat(Some([width_m, height_m])),
            Input::Enter => self.flat(None),
            Input::Escape | Input::SecondaryClick => {
                self.corners.clear();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if scope.plan.backdrop().is_none() {
            return "This plan has no picture; add one first".to_owned();
        }
        match self.corners.len() {
            0 => "Make flat: click the four corners of a rectangle in the drawing, the larger the better".to_owned(),
            4 => "Type its width and height, such as 8.2x6.1, or press Enter to estimate them · click to correct a \
                  corner"
                .to_owned(),
            number => format!("Click the next corner, {} to go · Esc cancels", 4 - number),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        for corner in &self.corners {
            preview.handle(*corner, Look::New);
        }
        let Some(corners) = self.rectangle() else {
            let mut path = self.corners.clone();
            path.push(scope.pointer);
            preview.line(path, false, Look::New);
            return;
        };
        preview.line(corners.iter().chain(&corners[..1]).copied().collect(), false, Look::New);
        // What will be level and upright, as it is seen now.
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let Some(seen_from_square) = Homography::between(square, corners) else { return };
        for k in 1..LINES {
            let share = f64::from(k) / f64::from(LINES);
            for ends in [[(share, 0.0), (share, 1.0)], [(0.0, share), (1.0, share)]] {
                let ends = ends.map(|(x, y)| seen_from_square.apply(Point::new(x, y)));
                if let [Some(a), Some(b)] = ends {
                    preview.line(vec![a, b], false, Look::Guide);
                }
            }
        }
        let [upper_left, upper_right, _, lower_left] = corners;
        preview.label(Segment::new(upper_left, upper_right).midpoint(), "width".to_owned(), Look::New);
        preview.label(Segment::new(upper_left, lower_left).midpoint(), "height".to_owned(), Look::New);
    }

    fn is_busy(&self) -> bool {
        !self.corners.is_empty()
    }

    // Refers to positions in the backdrop, not in the drawing.
    fn snaps(&self) -> bool {
        false
    }

    fn typing(&self) -> Option<Typing> {
        (self.corners.len() == 4).then_some(Typing::Size)
    }

    fn take_back(&mut self) -> TakenBack {
        if self.corners.pop().is_some() { TakenBack::Corner } else { TakenBack::Nothing }
    }
}
