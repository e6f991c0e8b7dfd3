//! Targets of the pointer: a point of the plan, a pixel, a room, a control.

use egui::{Pos2, pos2};

use super::fault::Fault;
use super::stage::Stage;
use super::words::{Words, in_quotes};
use crate::app::replay::words::told;
use crate::geometry::Point;

/// A place named in a script.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Place {
    /// `at 3.2,4.5`: a point of the plan in metres, y up.
    Plan(Point),
    /// `pixel 100,200`: logical pixels from the window's top left.
    Pixel(Pos2),
    /// `room "Room 3"`: inside a room of the plan, by its name or its id.
    Room { name: String, number: Option<usize> },
    /// `control "Save"`: the middle of a control, or a point in it.
    Control { name: String, number: Option<usize>, offset: Option<Pos2> },
}

/// The syntax of places, for the manual.
pub(super) const FORMS: [(&str, &str); 4] = [
    ("at X,Y", "a point of the plan, in metres, y up: `at 3.2,4.5`"),
    ("pixel X,Y", "logical pixels from the window's top left: `pixel 100,200`"),
    ("room NAME [N]", "inside a room, by its name or its id; of several rooms of one name the Nth: `room \"Room 3\"`"),
    (
        "control NAME [N] [at X,Y]",
        "the middle of a control, by the name a screen reader says; of several the Nth; or logical pixels from its top \
         left: `control \"Save\"`",
    ),
];

impl Place {
    /// Parses a place.
    ///
    /// # Errors
    /// When there is none.
    pub(super) fn take(words: &mut Words<'_>) -> Result<Self, String> {
        let kind = words.text("a place")?;
        match kind {
            "at" => {
                let (x, y) = words.pair("a point of the plan")?;
                Ok(Self::Plan(Point::new(x, y)))
            }
            "pixel" => {
                let (x, y) = words.pair("a place on the screen")?;
                Ok(Self::Pixel(pos2(x as f32, y as f32)))
            }
            "room" => Ok(Self::Room { name: words.text("the room's name")?.to_owned(), number: ordinal(words)? }),
            "control" => {
                let name = words.text("the control's name")?.to_owned();
                let number = ordinal(words)?;
                let offset = if words.keyword("at") {
                    let (x, y) = words.pair("a place in the control")?;
                    Some(pos2(x as f32, y as f32))
                } else {
                    None
                };
                Ok(Self::Control { name, number, offset })
            }
            other => {
                let other = told(other);
                Err(format!("a place is at X,Y, pixel X,Y, room NAME or control NAME, not {other}"))
            }
        }
    }

    /// Its current position on the screen.
    ///
    /// # Errors
    /// When it does not exist, or is not on the screen.
    pub(super) fn on_screen(&self, stage: &Stage<'_>) -> Result<Pos2, Fault> {
        match self {
            Self::Plan(point) => stage.plan_point_on_screen(*point),
            Self::Pixel(place) => Ok(*place),
            Self::Room { name, number } => {
                let room = stage.room(name, *number)?;
                let point = stage
                    .window
                    .app()
                    .place_in_room(room)
                    .ok_or_else(|| Fault::new(format!("the room {} has no place to click at", in_quotes(name))))?;
                stage.plan_point_on_screen(point)
            }
            Self::Control { name, number, offset } => {
                let rect = stage.control(name, *number)?.rect;
                Ok(offset.map_or(rect.center(), |offset| rect.min + offset.to_vec2()))
            }
        }
    }
}

/// A number that selects one of several, counted from 1.
fn ordinal(words: &mut Words<'_>) -> Result<Option<usize>, String> {
    let Some(number) = words.peek().and_then(|word| word.parse::<usize>().ok()) else { return Ok(None) };
    words.next();
    if number == 0 { Err("the first of several is 1, not 0".to_owned()) } else { Ok(Some(number)) }
}
