//! Mirrors, rotates and scales what is selected: about a point or an axis that the pointer shows, with the ghost
//! of the result; what is typed says how much.

use super::ghost::{Selected, ghost};
use super::tool::{COPIES, GRID, RIGHT_ANGLES, SNAPPING};
use super::{Anchor, Call, Entry, Input, Scope, TakenBack, Tool, Typed, Typing, Value};
use crate::app::paint::preview::{Look, Preview, turn, turn_rad};
use crate::app::value::MoveOrCopy;
use crate::base::units;
use crate::geometry::{Point, Transform, Vector};

pub(crate) const MIRROR: Entry = Entry {
    id: "mirror-across",
    title: "Mirror",
    help: "Mirror the selection across an axis: click two points of the axis, or type its angle",
    keys: &[],
    strip: None,
    options: &[COPIES, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Turning::of(Kind::Mirror)),
};

pub(crate) const ROTATE: Entry = Entry {
    id: "rotate",
    title: "Rotate",
    help: "Rotate the selection: click the centre, then a point and where it goes, or type the angle",
    keys: &[],
    strip: None,
    options: &[COPIES, RIGHT_ANGLES, SNAPPING, GRID],
    make: || Box::new(Turning::of(Kind::Rotate)),
};

pub(crate) const SCALE: Entry = Entry {
    id: "scale-selection",
    title: "Scale",
    help: "Scale the selection: click the point that stays, then another and where it goes, or type the factor",
    keys: &[],
    strip: None,
    options: &[COPIES, SNAPPING, GRID],
    make: || Box::new(Turning::of(Kind::Scale)),
};

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Mirror,
    Rotate,
    Scale,
}

struct Turning {
    kind: Kind,
    selected: Selected,
    /// What was clicked: the centre, then where it is turned or scaled from; of a mirror the first point of the axis.
    points: Vec<Point>,
}

/// Two points closer than this show no direction, in metres.
const SAME_M: f64 = 1e-3;

impl Turning {
    fn of(kind: Kind) -> Self {
        Self { kind, selected: Selected::default(), points: Vec::new() }
    }

    /// Takes a point, unless it is the last one again.
    fn go_to(&mut self, point: Point) {
        if self.points.last().is_none_or(|last| last.distance(point) >= SAME_M) {
            self.points.push(point);
        }
    }

    /// How many points are clicked before the last one.
    fn needed(&self) -> usize {
        if self.kind == Kind::Mirror { 1 } else { 2 }
    }

    /// The middle of what is selected, for what is typed before anything was clicked.
    fn centre(&self, scope: &Scope<'_>) -> Point {
        self.points.first().copied().unwrap_or_else(|| self.selected.part(scope).bounds().center().trimmed())
    }

    /// What the last point says: the call, and what it does.
    fn shown(&self, to: Point, scope: &Scope<'_>) -> Option<(Call, Transform)> {
        match (self.kind, self.points.as_slice()) {
            (Kind::Mirror, &[from, ..]) if from.distance(to) >= SAME_M => self.mirrored(from, to, scope),
            (Kind::Rotate, &[about, from, ..]) if about.distance(to) >= SAME_M => {
                self.rotated(about, turn_rad(from - about, to - about).to_degrees(), scope)
            }
            (Kind::Scale, &[about, from, ..]) if about.distance(to) >= SAME_M => {
                self.scaled(about, about.distance(to) / about.distance(from), scope)
            }
            _ => None,
        }
    }

    fn mirrored(&self, from: Point, to: Point, scope: &Scope<'_>) -> Option<(Call, Transform)> {
        let axis = [from, to].map(Point::trimmed);
        let call = Call::new(MIRROR.id, [Value::points(&axis), copy(scope)]);
        Some((call, Transform::reflection(axis[0], axis[1])?))
    }

    fn rotated(&self, about: Point, angle_deg: f64, scope: &Scope<'_>) -> Option<(Call, Transform)> {
        let call = Call::new(ROTATE.id, [Value::Number(angle_deg), Value::point(about), copy(scope)]);
        Some((call, Transform::rotation(about.trimmed(), angle_deg.to_radians())))
    }

    fn scaled(&self, about: Point, factor: f64, scope: &Scope<'_>) -> Option<(Call, Transform)> {
        // To a ten-thousandth: what is read off the screen is no finer.
        let factor = ((factor * 1e4).round() / 1e4).clamp(0.001, 1000.0);
        let call = Call::new(SCALE.id, [Value::Number(factor), Value::point(about), copy(scope)]);
        Some((call, Transform::scaling(about.trimmed(), factor)))
    }

    /// What was typed says: about the clicked point, or about the middle.
    fn typed(&self, typed: Typed, scope: &Scope<'_>) -> Option<(Call, Transform)> {
        let about = self.centre(scope);
        match (self.kind, typed) {
            (Kind::Mirror, Typed::Angle { angle_rad }) => {
                let along = Vector::new(1.0, 0.0).rotated(angle_rad);
                self.mirrored(about, about + along * 10.0, scope)
            }
            (Kind::Rotate, Typed::Angle { angle_rad }) => self.rotated(about, angle_rad.to_degrees(), scope),
            (Kind::Scale, Typed::Factor(factor)) => self.scaled(about, factor, scope),
            _ => None,
        }
    }
}

/// Whether the original stays, as an argument.
fn copy(scope: &Scope<'_>) -> Value {
    Value::word(if scope.options.copies { MoveOrCopy::Copy } else { MoveOrCopy::Move })
}

/// The call, then back to selecting.
pub(super) fn done(call: Call) -> Vec<Call> {
    vec![call, Call::new("tool-select", [])]
}

impl Tool for Turning {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match input {
            Input::Click | Input::Drop if self.points.len() >= self.needed() => {
                // Drawing -> done
                if let Some((call, _)) = self.shown(scope.at(), scope) {
                    return done(call);
                }
            }
            // Ready -> Drawing, Drawing -> Drawing
            Input::Click => self.go_to(scope.at()),
            Input::DragStart { at, .. } if self.points.len() < self.needed() => self.go_to(at),
            Input::Typed(typed) => {
                if let Some((call, _)) = self.typed(typed, scope) {
                    return done(call);
                }
            }
            Input::Escape => self.points.clear(),
            Input::SecondaryClick => drop(self.points.pop()),
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        let kept = if scope.options.copies { "makes a copy" } else { "what it shares stays with its neighbours" };
        match (self.kind, self.points.len()) {
            (Kind::Mirror, 0) => {
                format!(
                    "Mirror: click a point of the axis · or type its angle (90) for an axis through the middle · \
                         {kept}"
                )
            }
            (Kind::Mirror, _) => {
                "Click another point of the axis, or type its angle · Shift: any angle · Esc cancels".to_owned()
            }
            (Kind::Rotate, 0) => {
                format!("Rotate: click the centre · or type an angle (45) to rotate about the middle · {kept}")
            }
            (Kind::Rotate, 1) => "Click a point to rotate from, or type the angle · Esc cancels".to_owned(),
            (Kind::Rotate, _) => {
                "Click where that point goes, or type the angle · Shift: any angle · Esc cancels".to_owned()
            }
            (Kind::Scale, 0) => {
                format!("Scale: click the point that stays · or type a factor (1.5) to scale about the middle · {kept}")
            }
            (Kind::Scale, 1) => "Click a point to scale from, or type the factor · Esc cancels".to_owned(),
            (Kind::Scale, _) => "Click where that point goes, or type the factor · Esc cancels".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        for &point in &self.points {
            preview.handle(point, Look::New);
        }
        let to = scope.at();
        if let Some(&first) = self.points.first() {
            preview.dashed(vec![first, to], false, Look::Guide);
        }
        if let (Kind::Rotate | Kind::Scale, &[about, from]) = (self.kind, self.points.as_slice()) {
            preview.dashed(vec![about, from], false, Look::Guide);
        }
        let Some((_, transform)) = self.shown(to, scope) else { return };
        ghost(&self.selected.part(scope), transform, preview);
        let said = match (self.kind, self.points.as_slice()) {
            (Kind::Mirror, &[from, ..]) => format!("axis at {}", units::angle(axis_rad(to - from))),
            (Kind::Rotate, &[about, from, ..]) => {
                preview.arc(
                    about,
                    from,
                    about + (to - about).unit().unwrap_or_default() * about.distance(from),
                    Look::Guide,
                );
                turn(from - about, to - about)
            }
            _ => format!("x {:.3}", transform.factor()),
        };
        preview.label(to, said, Look::New);
    }

    fn is_busy(&self) -> bool {
        !self.points.is_empty()
    }

    fn anchor(&self) -> Option<Anchor> {
        let &from = self.points.first()?;
        let along = self.points.get(1).and_then(|&to| (to - from).unit());
        Some(Anchor { from, along, right_angles: self.kind != Kind::Scale })
    }

    fn points(&self) -> Vec<Point> {
        self.points.clone()
    }

    fn typing(&self) -> Option<Typing> {
        Some(if self.kind == Kind::Scale { Typing::Factor } else { Typing::Angle })
    }

    fn take_back(&mut self) -> TakenBack {
        if self.points.pop().is_some() { TakenBack::Corner } else { TakenBack::Nothing }
    }
}

/// The direction of an axis: from 0 to below half a turn.
fn axis_rad(along: Vector) -> f64 {
    along.angle_rad().rem_euclid(std::f64::consts::PI)
}
