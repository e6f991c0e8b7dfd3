//! Parses the authors' XML into what it states, without judging it: the meaningful elements, each with
//! its position in the file.

use quick_xml::events::BytesStart;

use super::super::xml::{DAMAGED_HINT, Offset, Result, Token, Unknown, Xml};
use crate::geometry::{Bounds, Point};

/// Maximum corners of a room. The largest real one has 86; a file with more is no floor plan, and
/// searching for openings' walls would take too long.
const CORNER_LIMIT: usize = 10_000;

/// Maximum rooms, portals, and line segments of portals in a file. The largest real file has 105 rooms
/// and 268 portals.
const COUNT_LIMIT: usize = 100_000;

/// What a file states. Empty text where an element is missing.
#[derive(Debug, Default)]
pub struct Document {
    pub id: String,
    pub name: String,
    pub info: String,
    /// The length in pixels that [`Document::real`] corresponds to.
    pub represented: Option<Length>,
    pub real: Option<Length>,
    /// The position of the `<image_scale>` element, if any.
    pub image_scale: Option<Offset>,
    pub typology: String,
    pub floors: Vec<Floor>,
    pub unknown: Unknown,
}

/// A value with a unit, both as written.
#[derive(Debug)]
pub struct Length {
    pub value: String,
    pub unit: String,
    pub at: Offset,
}

#[derive(Debug, Default)]
pub struct Floor {
    pub spaces: Vec<Space>,
    pub groups: Vec<Group>,
    /// The bounding box of all line segments that are walls, in pixels.
    pub walls: Option<Bounds>,
}

/// A room, as drawn.
#[derive(Debug)]
pub struct Space {
    pub at: Offset,
    pub id: String,
    /// The coarse type: R room, C connection, E entrance.
    pub kind: String,
    pub function: String,
    /// In pixels, y down, as written.
    pub boundary: Vec<Point>,
    /// The line segments of the class PORTAL.
    pub segments: Vec<Segment>,
    pub portals: Vec<Portal>,
}

/// The position of an opening on a room's boundary.
#[derive(Debug)]
pub struct Segment {
    pub at: Offset,
    pub id: String,
    /// The middle of its points.
    pub point: Option<Point>,
}

/// An opening, as stated in one of its rooms.
#[derive(Debug, Default)]
pub struct Portal {
    pub at: Offset,
    /// The line segment that says where it is.
    pub segment: String,
    pub class: String,
    pub kind: String,
    pub features: String,
    pub direction: String,
    /// The rooms it joins.
    pub targets: Vec<String>,
}

impl Portal {
    /// Equal for the statements of an opening in its two rooms, if the file is as the program writes it.
    pub fn key(&self) -> (&str, Vec<&str>) {
        let mut targets: Vec<&str> = self.targets.iter().map(String::as_str).collect();
        targets.sort_unstable();
        (&self.segment, targets)
    }
}

/// Rooms that belong together.
#[derive(Debug, Default)]
pub struct Group {
    pub at: Offset,
    pub id: String,
    pub name: String,
    pub kind: String,
    pub spaces: Vec<String>,
}

/// Reads a file's text.
///
/// # Errors
/// When it is not well-formed XML with the root `<building>`, a number is invalid, a list exceeds the
/// limits above, or a room has no id; the error has the line, the element and a hint.
pub fn parse(text: &str) -> Result<Document> {
    let mut parser = Parser { xml: Xml::new(text, "plan of the authors' program"), spaces: 0, portals: 0, segments: 0 };
    parser.file()
}

struct Parser<'a> {
    xml: Xml<'a>,
    spaces: usize,
    portals: usize,
    segments: usize,
}

impl<'a> Parser<'a> {
    /// The point that a `<point x="…" y="…"/>` states, in pixels, y down.
    fn point(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Point> {
        let [Some(x), Some(y)] = self.xml.numbers(start, at, ["x", "y"], "a point")? else {
            return self.xml.fail(at, "a point lacks its x or y", DAMAGED_HINT);
        };
        self.xml.skip()?;
        Ok(Point::new(x, y))
    }

    fn file(&mut self) -> Result<Document> {
        let (start, at) = self.xml.enter_root("building")?;
        let document = self.building(&start, at)?;
        self.xml.finish("building", "keep one building a file")?;
        Ok(document)
    }

    fn building(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Document> {
        let mut document =
            Document { id: self.xml.attribute(start, at, "id")?.unwrap_or_default(), ..Document::default() };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "name" => document.name = self.xml.text()?,
                "scale" => self.scale(&mut document)?,
                "Info" | "info" => self.info(&mut document)?,
                "building_type" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "main_type" => document.typology = self.xml.text()?,
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                "floor" => {
                    let floor = self.floor()?;
                    document.floors.push(floor);
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        document.unknown = std::mem::take(&mut self.xml.unknown);
        Ok(document)
    }

    fn scale(&mut self, document: &mut Document) -> Result<()> {
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "represented_distance" => document.represented = Some(self.length(at)?),
                "real_distance" => document.real = Some(self.length(at)?),
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(())
    }

    fn length(&mut self, at: Offset) -> Result<Length> {
        let mut length = Length { value: String::new(), unit: String::new(), at };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "value" => length.value = self.xml.text()?,
                "um" => length.unit = self.xml.text()?,
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(length)
    }

    /// A text that may hold an `<image_scale>`.
    fn info(&mut self, document: &mut Document) -> Result<()> {
        let mut text = String::new();
        loop {
            match self.xml.next()? {
                Token::Text(piece) => text.push_str(&piece),
                Token::Start(child, at) => {
                    if child.name().as_ref() == "image_scale" {
                        document.image_scale.get_or_insert(at);
                        self.xml.skip()?;
                    } else {
                        self.xml.skip_unknown(&child, at)?;
                    }
                }
                Token::End | Token::Eof => {
                    document.info = text.trim().replace("\r\n", "\n");
                    return Ok(());
                }
            }
        }
    }

    fn floor(&mut self) -> Result<Floor> {
        let mut floor = Floor::default();
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "spaces" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "space" => self.space(&child, at, &mut floor)?,
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                "groups" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "group_features" => {
                                let group = self.group(&child, at)?;
                                floor.groups.push(group);
                            }
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(floor)
    }

    fn group(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Group> {
        let mut group = Group { at, id: self.xml.attribute(start, at, "id")?.unwrap_or_default(), ..Group::default() };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "name" => group.name = self.xml.text()?,
                "type" => group.kind = self.xml.text()?,
                // A room's id as text: a member of the group, not a room.
                "space" => group.spaces.push(self.xml.text()?),
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(group)
    }

    fn space(&mut self, start: &BytesStart<'a>, at: Offset, floor: &mut Floor) -> Result<()> {
        let id = self.xml.attribute(start, at, "id")?.unwrap_or_default();
        if id.is_empty() {
            return self.xml.fail(at, "a <space> has no id", "give it one that no other space has");
        }
        self.spaces += 1;
        if self.spaces > COUNT_LIMIT {
            return self.xml.fail(at, format!("has more than {COUNT_LIMIT} rooms"), "split it into storeys");
        }
        self.xml.element = format!("space {id}");
        let mut space = Space {
            at,
            id,
            kind: String::new(),
            function: String::new(),
            boundary: Vec::new(),
            segments: Vec::new(),
            portals: Vec::new(),
        };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "labels" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "type" => space.kind = self.xml.text()?,
                            "label" => space.function = self.xml.text()?,
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                "bounding_polygon" => self.boundary(&mut space)?,
                "space_representation" => self.segments(&mut space, floor)?,
                "portals" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "portal" => {
                                let portal = self.portal(at)?;
                                space.portals.push(portal);
                            }
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                // These follow from the boundary, and are often wrong.
                "centroid" | "bounding_box" | "features" => self.xml.skip()?,
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        self.xml.element.clear();
        floor.spaces.push(space);
        Ok(())
    }

    fn boundary(&mut self, space: &mut Space) -> Result<()> {
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "point" => {
                    if space.boundary.len() >= CORNER_LIMIT {
                        let what = format!("the boundary has more than {CORNER_LIMIT} corners");
                        return self.xml.fail(at, what, "simplify the boundary, or split the room");
                    }
                    let point = self.point(&child, at)?;
                    space.boundary.push(point);
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(())
    }

    /// Reads the line segments of a room's boundary and keeps the portals.
    ///
    /// The first version of the program wrote a segment's class behind it, later ones inside.
    fn segments(&mut self, space: &mut Space, floor: &mut Floor) -> Result<()> {
        let mut last: Option<RawSegment<'a>> = None;
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "linesegment" => {
                    self.keep_segment(last.take(), space, floor)?;
                    last = Some(self.segment(child, at)?);
                }
                "class" => {
                    let class = self.xml.text()?;
                    if let Some(last) = &mut last {
                        last.is_portal = class == "PORTAL";
                    }
                }
                "type" | "features" => self.xml.skip()?,
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        self.keep_segment(last, space, floor)
    }

    fn segment(&mut self, start: BytesStart<'a>, at: Offset) -> Result<RawSegment<'a>> {
        let mut segment = RawSegment { start, at, is_portal: false, points: Bounds::EMPTY };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                "point" => segment.points = segment.points.with(self.point(&child, at)?),
                "class" => segment.is_portal = self.xml.text()? == "PORTAL",
                // The portal states its kind; some versions write IMPLICIT here for every one.
                "type" | "features" => self.xml.skip()?,
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(segment)
    }

    fn keep_segment(&mut self, raw: Option<RawSegment<'a>>, space: &mut Space, floor: &mut Floor) -> Result<()> {
        let Some(raw) = raw else { return Ok(()) };
        let points = raw.points;
        if raw.is_portal {
            let id = self.xml.attribute(&raw.start, raw.at, "id")?.unwrap_or_default();
            let point = (!points.is_empty()).then(|| points.center());
            self.segments += 1;
            if self.segments > COUNT_LIMIT {
                let what = format!("has more than {COUNT_LIMIT} line segments of portals");
                return self.xml.fail(raw.at, what, "split it into storeys");
            }
            space.segments.push(Segment { at: raw.at, id, point });
        } else if !points.is_empty() {
            floor.walls = Some(floor.walls.unwrap_or(Bounds::EMPTY).union(points));
        }
        Ok(())
    }

    fn portal(&mut self, at: Offset) -> Result<Portal> {
        self.portals += 1;
        if self.portals > COUNT_LIMIT {
            return self.xml.fail(at, format!("has more than {COUNT_LIMIT} portals"), "split it into storeys");
        }
        let mut portal = Portal { at, ..Portal::default() };
        while let Some((child, at)) = self.xml.child()? {
            match child.name().as_ref() {
                // The first version of the program wrote <id>.
                "linesegment" | "id" => portal.segment = self.xml.text()?,
                "class" => portal.class = self.xml.text()?,
                "type" => portal.kind = self.xml.text()?,
                "features" => portal.features = self.xml.text()?,
                "direction" => portal.direction = self.xml.text()?,
                "target" => {
                    while let Some((child, at)) = self.xml.child()? {
                        match child.name().as_ref() {
                            "id" => portal.targets.push(self.xml.text()?),
                            _ => self.xml.skip_unknown(&child, at)?,
                        }
                    }
                }
                _ => self.xml.skip_unknown(&child, at)?,
            }
        }
        Ok(portal)
    }
}

/// A line segment whose class may still follow.
struct RawSegment<'a> {
    start: BytesStart<'a>,
    at: Offset,
    is_portal: bool,
    /// The bounding box of its two points.
    points: Bounds,
}
