//! Sets the scale of the backdrop by known lengths: those written on the drawing, or the width of a door.

use super::{Call, Entry, Input, Scope, TakenBack, Tool, Typed, Typing, Value, picture_numbers};
use crate::app::paint::preview::{Look, Preview};
use crate::app::session::tracing::millimetres;
use crate::base::units::Units;
use crate::edit::Calibration;
use crate::geometry::{Point, Segment};
use crate::plan::Backdrop;

pub(crate) const BY_LENGTH: Entry = Entry {
    id: "tool-calibrate",
    title: "Set scale by a length",
    help: "Click both ends of a known length in the picture and type the length; more lengths make the scale more \
           accurate",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Calibrate::new(Known::Typed)),
};
pub(crate) const BY_DOOR: Entry = Entry {
    id: "tool-calibrate-door",
    title: "Set scale by a door",
    help: "Click both sides of a door in the picture; it counts as wide as new doors are, 0.9 m unless you set \
           another width",
    keys: &[],
    strip: None,
    options: &[],
    make: || Box::new(Calibrate::new(Known::Door)),
};

/// The kind of length being measured.
#[derive(Clone, Copy, PartialEq)]
enum Known {
    /// Typed by the user.
    Typed,
    /// A door's, initially the current width of doors; another can be typed.
    Door,
}

struct Calibrate {
    known: Known,
    state: State,
}

#[derive(Clone, Copy)]
enum State {
    Ready,
    From(Point),
    /// Both ends are set; the length is asked for.
    Between(Segment),
}

/// Two clicks closer than this, in points, are one: hands tremble.
const LEAST_PX: f64 = 4.0;

impl Calibrate {
    const fn new(known: Known) -> Self {
        Self { known, state: State::Ready }
    }

    /// Between -> Ready
    fn measured(&mut self, line: Segment, length_m: f64) -> Vec<Call> {
        self.state = State::Ready;
        vec![Call::new("calibrate", picture_numbers([line.a.x, line.a.y, line.b.x, line.b.y, length_m]))]
    }

    /// From -> Between, or with a door -> Ready
    fn end(&mut self, from: Point, to: Point, scope: &Scope<'_>) -> Vec<Call> {
        if from.distance(to) < scope.metres(LEAST_PX) {
            return Vec::new();
        }
        let line = Segment::new(from, to);
        match self.known {
            Known::Door => self.measured(line, scope.options.opening_width_m),
            Known::Typed => {
                self.state = State::Between(line);
                Vec::new()
            }
        }
    }

    /// The line in the making.
    fn line(&self, scope: &Scope<'_>) -> Option<Segment> {
        match self.state {
            State::Ready => None,
            State::From(from) => Some(Segment::new(from, scope.pointer)),
            State::Between(line) => Some(line),
        }
    }
}

impl Tool for Calibrate {
    fn take(&mut self, input: Input, scope: &Scope<'_>) -> Vec<Call> {
        match (input, self.state) {
            // Ready -> From
            (Input::Click, State::Ready) => self.state = State::From(scope.pointer),
            (Input::DragStart { pointer, .. }, State::Ready) => self.state = State::From(pointer),
            (Input::Click | Input::Drop, State::From(from)) => return self.end(from, scope.pointer, scope),
            // Between -> From
            (Input::Click, State::Between(_)) => self.state = State::From(scope.pointer),
            (Input::Typed(Typed::Length { length_m, .. }), State::Between(line)) => {
                return self.measured(line, length_m);
            }
            (Input::Typed(Typed::Length { length_m, .. }), _) if self.known == Known::Door => {
                return vec![Call::new("opening-width", [Value::Number(length_m)])];
            }
            (Input::Escape | Input::SecondaryClick, _) => self.state = State::Ready,
            _ => {}
        }
        Vec::new()
    }

    fn hint(&self, scope: &Scope<'_>) -> String {
        if scope.plan.backdrop().is_none() {
            return "This plan has no picture; add one first".to_owned();
        }
        let door = scope.units.exact_length(scope.options.opening_width_m);
        match (self.state, self.known) {
            (State::Ready, Known::Typed) => {
                "Scale: click one end of a length you know, the longer the better".to_owned()
            }
            (State::Ready, Known::Door) => {
                format!("Scale: click one side of a door that is {door} wide, or type another width")
            }
            (State::From(_), Known::Typed) => "Click the other end · Esc cancels".to_owned(),
            (State::From(_), Known::Door) => format!(
                "Click the other side of the door: it is {door} wide · Esc \
                                                      cancels"
            ),
            (State::Between(_), _) => "Type the true length and press Enter · click to start again".to_owned(),
        }
    }

    fn preview(&self, scope: &Scope<'_>, preview: &mut Preview) {
        let Some(backdrop) = scope.plan.backdrop() else { return };
        measured_before(scope.units, backdrop, preview);
        let Some(line) = self.line(scope) else { return };
        let pixels = line.length() / backdrop.metres_per_pixel;
        // Not yet measured, so there is no length to state.
        let said = if backdrop.is_measured() {
            format!("{pixels:.0} px  {}", scope.units.length(line.length()))
        } else {
            format!("{pixels:.0} px")
        };
        preview.line(vec![line.a, line.b], false, Look::New);
        for end in [line.a, line.b] {
            preview.handle(end, Look::New);
        }
        preview.dimension(line, said);
        if let (State::From(_), Known::Door) = (self.state, self.known) {
            let metres_per_pixel = scope.options.opening_width_m / pixels.max(1.0);
            preview.label(scope.pointer, format!("1 pixel = {}", millimetres(metres_per_pixel)), Look::New);
        }
    }

    fn is_busy(&self) -> bool {
        !matches!(self.state, State::Ready)
    }

    // Refers to positions in the backdrop, not in the drawing.
    fn snaps(&self) -> bool {
        false
    }

    fn typing(&self) -> Option<Typing> {
        let is_asked = matches!(self.state, State::Between(_)) || self.known == Known::Door;
        is_asked.then_some(Typing::Width)
    }

    fn take_back(&mut self) -> TakenBack {
        self.state = match self.state {
            State::Ready => return TakenBack::Nothing,
            State::From(_) => State::Ready,
            State::Between(line) => State::From(line.a),
        };
        TakenBack::Corner
    }
}

/// The lengths measured so far, each with how well it fits; the worst is highlighted.
fn measured_before(units: Units, backdrop: &Backdrop, preview: &mut Preview) {
    let Some(calibration) = Calibration::of(&backdrop.measurements) else { return };
    for (index, (measurement, residual)) in backdrop.measurements.iter().zip(&calibration.residuals).enumerate() {
        let line =
            Segment::new(backdrop.plan_from_picture(measurement.from), backdrop.plan_from_picture(measurement.to));
        let is_worst = calibration.worst == Some(index) && residual.abs() > 0.01;
        let look = if is_worst { Look::Danger } else { Look::Guide };
        preview.line(vec![line.a, line.b], false, look);
        for end in [line.a, line.b] {
            preview.handle(end, look);
        }
        let length = units.exact_length(measurement.length_m);
        let fit =
            if backdrop.measurements.len() > 1 { format!("{length}  {:+.1} %", residual * 100.0) } else { length };
        preview.dimension(line, fit);
    }
}
