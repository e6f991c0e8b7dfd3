//! Parses a floor of the KTH campus into what it states, without judging it.

use quick_xml::events::BytesStart;

use super::super::xml::{DAMAGED_HINT, Offset, Result, Unknown, Xml};
use crate::geometry::Point;

/// The root element of a file.
pub(super) const ROOT: &str = "floor";

/// Maximum lines of a room's contour. The largest real one has 396.
const LINE_LIMIT: usize = 10_000;

/// Maximum rooms, and portals and windows, in a file. The largest real file has 152 rooms.
const COUNT_LIMIT: usize = 100_000;

/// What a file states. Empty text where it says nothing.
#[derive(Debug, Default)]
pub(super) struct Floor {
    pub building: String,
    pub name: String,
    /// The campus: 'KTH'.
    pub domain: String,
    pub scale: Option<Scale>,
    pub spaces: Vec<Space>,
    pub unknown: Unknown,
}

/// So many pixels for so many metres; `None` where the text is no number.
#[derive(Debug)]
pub(super) struct Scale {
    pub at: Offset,
    pub pixels: Option<f64>,
    pub metres: Option<f64>,
}

/// A room, as drawn.
#[derive(Debug)]
pub(super) struct Space {
    pub at: Offset,
    pub name: String,
    /// What the drawing says that it is for.
    pub function: String,
    pub lines: Vec<Line>,
    /// The rooms that its portals lead to, with the place of each statement.
    pub targets: Vec<(String, Offset)>,
}

impl Space {
    /// What it is called in messages.
    pub fn title(&self) -> String {
        if self.name.is_empty() { "space".to_owned() } else { format!("space {}", self.name) }
    }
}

/// A piece of a contour.
#[derive(Debug)]
pub(super) struct Line {
    pub at: Offset,
    /// In pixels, y down.
    pub from: Point,
    pub to: Point,
    pub kind: Kind,
    /// The room behind a portal.
    pub target: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Wall,
    Portal,
    Window,
}

/// Reads a file's text.
///
/// # Errors
/// When it is not well-formed XML with the root `<floor>`, a coordinate is no number, or a list exceeds the limits
/// above; the error has the line, the element and a hint.
pub(super) fn parse(text: &str) -> Result<Floor> {
    let mut parser = Parser { xml: Xml::new(text, "floor of the KTH campus"), openings: 0 };
    let (start, at) = parser.xml.enter_root(ROOT)?;
    let floor = parser.floor(&start, at)?;
    parser.xml.finish(ROOT, "keep one floor a file")?;
    Ok(floor)
}

struct Parser<'a> {
    xml: Xml<'a>,
    openings: usize,
}

impl<'a> Parser<'a> {
    fn attribute(&self, start: &BytesStart<'a>, at: Offset, name: &str) -> Result<String> {
        Ok(self.xml.attribute(start, at, name)?.unwrap_or_default())
    }

    fn floor(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Floor> {
        let building = self.attribute(start, at, "BuildingName")?;
        let name = self.attribute(start, at, "FloorName")?;
        let mut floor = Floor { building, name, ..Floor::default() };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "Domain" => {
                    floor.domain = self.attribute(&child, at, "name")?;
                    self.xml.skip()?;
                }
                "Scale" => {
                    let number = |text: String| text.parse::<f64>().ok().filter(|number| number.is_finite());
                    let pixels = number(self.attribute(&child, at, "PixelDistance")?);
                    let metres = number(self.attribute(&child, at, "RealDistance")?);
                    floor.scale = Some(Scale { at, pixels, metres });
                    self.xml.skip()?;
                }
                "space" => {
                    if floor.spaces.len() >= COUNT_LIMIT {
                        return self.xml.fail(at, format!("has more than {COUNT_LIMIT} rooms"), "split the file");
                    }
                    let space = self.space(&child, at)?;
                    floor.spaces.push(space);
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        floor.unknown = std::mem::take(&mut self.xml.unknown);
        Ok(floor)
    }

    fn space(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Space> {
        let name = self.attribute(start, at, "name")?;
        let function = self.attribute(start, at, "type")?;
        let mut space = Space { at, name, function, lines: Vec::new(), targets: Vec::new() };
        self.xml.element = space.title();
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "contour" => self.contour(&mut space)?,
                "portal" => {
                    self.count_opening(at)?;
                    space.targets.push((self.attribute(&child, at, "target")?, at));
                    self.xml.skip()?;
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        self.xml.element.clear();
        Ok(space)
    }

    fn contour(&mut self, space: &mut Space) -> Result<()> {
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "linesegment" => {
                    if space.lines.len() >= LINE_LIMIT {
                        let what = format!("the contour has more than {LINE_LIMIT} lines");
                        return self.xml.fail(at, what, "simplify the contour, or split the room");
                    }
                    let line = self.line(&child, at)?;
                    space.lines.push(line);
                    self.xml.skip()?;
                }
                // It follows from the contour.
                "centroid" => self.xml.skip()?,
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(())
    }

    fn line(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Line> {
        let numbers = self.xml.numbers(start, at, ["x1", "y1", "x2", "y2"], "a line")?;
        let [Some(x1), Some(y1), Some(x2), Some(y2)] = numbers else {
            return self.xml.fail(at, "a line lacks one of x1, y1, x2 and y2", DAMAGED_HINT);
        };
        let kind = match self.attribute(start, at, "type")?.to_ascii_lowercase().as_str() {
            "portal" => Kind::Portal,
            "window" => Kind::Window,
            _ => Kind::Wall,
        };
        if kind != Kind::Wall {
            self.count_opening(at)?;
        }
        let target = if kind == Kind::Portal { self.attribute(start, at, "target")? } else { String::new() };
        Ok(Line { at, from: Point::new(x1, y1), to: Point::new(x2, y2), kind, target })
    }

    fn count_opening(&mut self, at: Offset) -> Result<()> {
        self.openings += 1;
        if self.openings > COUNT_LIMIT {
            return self.xml.fail(at, format!("has more than {COUNT_LIMIT} portals and windows"), "split the file");
        }
        Ok(())
    }
}
