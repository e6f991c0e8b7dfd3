//! Parses the authors' XML into what it states, without judging it: the meaningful elements, each with
//! its position in the file.

use std::borrow::Cow;
use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart, Event};

use super::super::text::line_of;
use super::super::{Place, ReadError};
use crate::geometry::{Bounds, Point};

/// Maximum nesting depth: the format needs 8.
const DEPTH_LIMIT: usize = 64;

/// Maximum corners of a room. The largest real one has 86; a file with more is no floor plan, and
/// searching for openings' walls would take too long.
const CORNER_LIMIT: usize = 10_000;

/// Maximum rooms, portals, and line segments of portals in a file. The largest real file has 105 rooms
/// and 268 portals.
const COUNT_LIMIT: usize = 100_000;

/// Coordinates in pixels: no picture is wider than this.
const PIXEL_LIMIT: f64 = 1_000_000.0;

/// The most names of unknown elements to remember for the report.
const UNKNOWN_LIMIT: usize = 50;

/// A byte offset in the file, for finding the line.
pub type Offset = usize;

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
    /// Elements that are not read: how many, and the position of the first.
    pub unknown: BTreeMap<String, (usize, Offset)>,
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

/// The name of the root element of a file that starts with `head`, if it is XML and the name is
/// complete.
pub fn root_name(head: &[u8]) -> Option<String> {
    // In UTF-16 every other byte of ASCII is zero; UTF-8 text has no zeros.
    let head: Vec<u8> = head.iter().copied().filter(|&byte| byte != 0).collect();
    let head = String::from_utf8_lossy(&head);
    let mut rest = head.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}' || c == '\u{fffd}');
    loop {
        rest = rest.trim_start().strip_prefix('<')?;
        if let Some(comment) = rest.strip_prefix("!--") {
            rest = comment.split_once("-->")?.1;
        } else if rest.starts_with(['?', '!']) {
            rest = rest.split_once('>')?.1;
        } else {
            let end = rest.find(|c: char| c.is_whitespace() || c == '>' || c == '/')?;
            return (end > 0).then(|| rest[..end].to_owned());
        }
    }
}

/// The hint for most damaged files.
pub const DAMAGED_HINT: &str = "correct it by hand, or restore it from a copy";

/// Reads a file's text.
///
/// # Errors
/// When it is not well-formed XML with the root `<building>`, a number is invalid, a list exceeds the
/// limits above, or a room has no id; the error has the line, the element and a hint.
pub fn parse(text: &str) -> Result<Document, ReadError> {
    let mut parser = Parser {
        reader: Reader::from_str(text),
        text,
        open: Vec::new(),
        element: String::new(),
        spaces: 0,
        portals: 0,
        segments: 0,
        unknown: BTreeMap::new(),
    };
    parser.reader.config_mut().expand_empty_elements = true;
    parser.file()
}

/// A piece of XML.
enum Token<'a> {
    Start(BytesStart<'a>, Offset),
    End,
    Text(Cow<'a, str>),
    Eof,
}

struct Parser<'a> {
    reader: Reader<&'a [u8]>,
    text: &'a str,
    /// Where each element that is open starts.
    open: Vec<Offset>,
    /// The current element, for messages ('space 3547daca-…').
    element: String,
    spaces: usize,
    portals: usize,
    segments: usize,
    unknown: BTreeMap<String, (usize, Offset)>,
}

type Result<T, E = ReadError> = std::result::Result<T, E>;

impl<'a> Parser<'a> {
    fn fail<T>(&self, at: Offset, what: impl Into<String>, hint: &str) -> Result<T> {
        let line = Some(line_of(self.text.as_bytes(), at));
        let place = Place { line, element: self.element.clone() };
        Err(ReadError { place, what: what.into(), hint: hint.to_owned() })
    }

    fn position(&self) -> Offset {
        usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX)
    }

    /// The next meaningful token; comments and instructions are skipped.
    fn next(&mut self) -> Result<Token<'a>> {
        loop {
            let at = self.position();
            let event = match self.reader.read_event() {
                Ok(event) => event,
                Err(quick_xml::Error::Syntax(error)) => {
                    // All of these mean that the file ends inside a tag or the like.
                    let at = usize::try_from(self.reader.error_position()).unwrap_or(at);
                    return self.fail(at, format!("is cut off: {error}"), "restore it from a complete copy");
                }
                Err(error) => {
                    let at = usize::try_from(self.reader.error_position()).unwrap_or(at);
                    let why = match error {
                        quick_xml::Error::IllFormed(error) => error.to_string(),
                        error => error.to_string(),
                    };
                    return self.fail(at, format!("is not well-formed XML: {why}"), DAMAGED_HINT);
                }
            };
            match event {
                Event::Start(start) => {
                    if self.open.len() >= DEPTH_LIMIT {
                        let what = format!("elements lie deeper in each other than {DEPTH_LIMIT} levels");
                        return self.fail(at, what, "this is no file of the authors' program");
                    }
                    self.open.push(at);
                    return Ok(Token::Start(start, at));
                }
                Event::End(_) => {
                    self.open.pop();
                    return Ok(Token::End);
                }
                Event::Text(text) => return Ok(Token::Text(text.into_inner())),
                Event::CData(text) => return Ok(Token::Text(text.into_inner())),
                Event::GeneralRef(reference) => return Ok(Token::Text(self.character(&reference, at)?)),
                Event::Eof => {
                    let Some(&opened) = self.open.last() else { return Ok(Token::Eof) };
                    let name = tag_name(&self.text[opened..]);
                    let line = line_of(self.text.as_bytes(), opened);
                    let what = format!("is cut off: <{name}> from line {line} is never closed");
                    return self.fail(self.text.len(), what, "restore it from a complete copy");
                }
                Event::DocType(doctype) if doctype.contains('[') => {
                    return self.fail(at, "declares entities of its own, which are not read", "remove the DOCTYPE");
                }
                Event::Decl(declaration) => {
                    if let Some(Ok(encoding)) = declaration.encoding()
                        && !(self.text.is_ascii() && is_ascii_compatible(&encoding))
                        && !encoding.eq_ignore_ascii_case("utf-8")
                        && !encoding.eq_ignore_ascii_case("utf8")
                    {
                        return self.fail(
                            at,
                            format!("says that it is in {encoding}, not UTF-8"),
                            "save it again as UTF-8",
                        );
                    }
                }
                // Empty elements come as a start and an end.
                Event::DocType(_) | Event::Comment(_) | Event::PI(_) | Event::Empty(_) => {}
            }
        }
    }

    /// The character that `&name;` or `&#number;` stands for.
    fn character(&self, reference: &BytesRef<'a>, at: Offset) -> Result<Cow<'a, str>> {
        let plain = match &**reference {
            "amp" => "&",
            "lt" => "<",
            "gt" => ">",
            "quot" => "\"",
            "apos" => "'",
            name => match reference.resolve_char_ref() {
                Ok(Some(character)) => return Ok(Cow::Owned(character.to_string())),
                _ => return self.fail(at, format!("'&{name};' stands for nothing known"), DAMAGED_HINT),
            },
        };
        Ok(Cow::Borrowed(plain))
    }

    /// The next child of the element opened last; `None` after the last one.
    fn child(&mut self) -> Result<Option<(BytesStart<'a>, Offset)>> {
        loop {
            match self.next()? {
                Token::Start(start, at) => return Ok(Some((start, at))),
                Token::End | Token::Eof => return Ok(None),
                Token::Text(_) => {}
            }
        }
    }

    /// Skips the rest of the element opened last.
    fn skip(&mut self) -> Result<()> {
        let depth = self.open.len();
        while self.open.len() >= depth {
            self.next()?;
        }
        Ok(())
    }

    /// Skips an unknown element and remembers it.
    fn skip_unknown(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<()> {
        let name = start.name();
        let name: &str = name.as_ref();
        if let Some((count, _)) = self.unknown.get_mut(name) {
            *count += 1;
        } else if self.unknown.len() < UNKNOWN_LIMIT {
            self.unknown.insert(name.to_owned(), (1, at));
        }
        self.skip()
    }

    /// The text of the element opened last, trimmed.
    fn text(&mut self) -> Result<String> {
        let mut text = String::new();
        loop {
            match self.next()? {
                Token::Text(piece) => text.push_str(&piece),
                Token::Start(..) => self.skip()?,
                Token::End | Token::Eof => {
                    let trimmed = text.trim();
                    return Ok(if trimmed.len() == text.len() { text } else { trimmed.to_owned() });
                }
            }
        }
    }

    /// The value of an attribute.
    fn attribute(&self, start: &BytesStart<'a>, at: Offset, name: &str) -> Result<Option<String>> {
        let value = start
            .try_get_attribute(name)
            .map_err(quick_xml::Error::from)
            .and_then(|attribute| attribute.map(|found| found.normalized_value(XmlVersion::Explicit1_0)).transpose());
        match value {
            Ok(value) => Ok(value.map(|value| value.trim().to_owned())),
            Err(error) => self.fail(at, format!("is not well-formed XML: {error}"), DAMAGED_HINT),
        }
    }

    /// The point that a `<point x="…" y="…"/>` states, in pixels, y down.
    fn point(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Point> {
        let (mut x, mut y) = (None, None);
        for attribute in start.attributes().with_checks(false) {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(error) => return self.fail(at, format!("is not well-formed XML: {error}"), DAMAGED_HINT),
            };
            let coordinate = match attribute.key.as_ref() {
                "x" => &mut x,
                "y" => &mut y,
                _ => continue,
            };
            match attribute.value.trim().parse::<f64>() {
                Ok(value) if value.abs() <= PIXEL_LIMIT => *coordinate = Some(value),
                _ => {
                    let (name, text) = (attribute.key.as_ref(), &attribute.value);
                    let what = format!("{name}=\"{text}\" of a point is no number within ±{PIXEL_LIMIT}");
                    return self.fail(at, what, DAMAGED_HINT);
                }
            }
        }
        let (Some(x), Some(y)) = (x, y) else {
            return self.fail(at, "a point lacks its x or y", DAMAGED_HINT);
        };
        self.skip()?;
        Ok(Point::new(x, y))
    }

    fn file(&mut self) -> Result<Document> {
        let document = loop {
            let at = self.position();
            match self.next()? {
                Token::Start(start, at) if start.name().as_ref() == "building" => break self.building(&start, at)?,
                Token::Start(start, at) => {
                    let name = start.name();
                    let what = format!("is XML, but no plan of the authors' program: its root is <{}>", name.as_ref());
                    return self.fail(at, what, "a plan starts with <building>");
                }
                Token::Text(text) if text.trim().is_empty() => {}
                _ => return self.fail(at, "is not XML", "a plan starts with <building>"),
            }
        };
        loop {
            let at = self.position();
            match self.next()? {
                Token::Eof => return Ok(document),
                Token::Text(text) if text.trim().is_empty() => {}
                _ => return self.fail(at, "goes on behind </building>", "keep one building a file"),
            }
        }
    }

    fn building(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Document> {
        let mut document = Document { id: self.attribute(start, at, "id")?.unwrap_or_default(), ..Document::default() };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "name" => document.name = self.text()?,
                "scale" => self.scale(&mut document)?,
                "Info" | "info" => self.info(&mut document)?,
                "building_type" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "main_type" => document.typology = self.text()?,
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                "floor" => {
                    let floor = self.floor()?;
                    document.floors.push(floor);
                }
                _ => self.skip_unknown(&child, at)?,
            }
        }
        document.unknown = std::mem::take(&mut self.unknown);
        Ok(document)
    }

    fn scale(&mut self, document: &mut Document) -> Result<()> {
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "represented_distance" => document.represented = Some(self.length(at)?),
                "real_distance" => document.real = Some(self.length(at)?),
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(())
    }

    fn length(&mut self, at: Offset) -> Result<Length> {
        let mut length = Length { value: String::new(), unit: String::new(), at };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "value" => length.value = self.text()?,
                "um" => length.unit = self.text()?,
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(length)
    }

    /// A text that may hold an `<image_scale>`.
    fn info(&mut self, document: &mut Document) -> Result<()> {
        let mut text = String::new();
        loop {
            match self.next()? {
                Token::Text(piece) => text.push_str(&piece),
                Token::Start(child, at) => {
                    if child.name().as_ref() == "image_scale" {
                        document.image_scale.get_or_insert(at);
                        self.skip()?;
                    } else {
                        self.skip_unknown(&child, at)?;
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
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "spaces" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "space" => self.space(&child, at, &mut floor)?,
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                "groups" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "group_features" => {
                                let group = self.group(&child, at)?;
                                floor.groups.push(group);
                            }
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(floor)
    }

    fn group(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<Group> {
        let mut group = Group { at, id: self.attribute(start, at, "id")?.unwrap_or_default(), ..Group::default() };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "name" => group.name = self.text()?,
                "type" => group.kind = self.text()?,
                // A room's id as text: a member of the group, not a room.
                "space" => group.spaces.push(self.text()?),
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(group)
    }

    fn space(&mut self, start: &BytesStart<'a>, at: Offset, floor: &mut Floor) -> Result<()> {
        let id = self.attribute(start, at, "id")?.unwrap_or_default();
        if id.is_empty() {
            return self.fail(at, "a <space> has no id", "give it one that no other space has");
        }
        self.spaces += 1;
        if self.spaces > COUNT_LIMIT {
            return self.fail(at, format!("has more than {COUNT_LIMIT} rooms"), "split it into storeys");
        }
        self.element = format!("space {id}");
        let mut space = Space {
            at,
            id,
            kind: String::new(),
            function: String::new(),
            boundary: Vec::new(),
            segments: Vec::new(),
            portals: Vec::new(),
        };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "labels" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "type" => space.kind = self.text()?,
                            "label" => space.function = self.text()?,
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                "bounding_polygon" => self.boundary(&mut space)?,
                "space_representation" => self.segments(&mut space, floor)?,
                "portals" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "portal" => {
                                let portal = self.portal(at)?;
                                space.portals.push(portal);
                            }
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                // These follow from the boundary, and are often wrong.
                "centroid" | "bounding_box" | "features" => self.skip()?,
                _ => self.skip_unknown(&child, at)?,
            }
        }
        self.element.clear();
        floor.spaces.push(space);
        Ok(())
    }

    fn boundary(&mut self, space: &mut Space) -> Result<()> {
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "point" => {
                    if space.boundary.len() >= CORNER_LIMIT {
                        let what = format!("the boundary has more than {CORNER_LIMIT} corners");
                        return self.fail(at, what, "simplify the boundary, or split the room");
                    }
                    let point = self.point(&child, at)?;
                    space.boundary.push(point);
                }
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(())
    }

    /// Reads the line segments of a room's boundary and keeps the portals.
    ///
    /// The first version of the program wrote a segment's class behind it, later ones inside.
    fn segments(&mut self, space: &mut Space, floor: &mut Floor) -> Result<()> {
        let mut last: Option<RawSegment<'a>> = None;
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "linesegment" => {
                    self.keep_segment(last.take(), space, floor)?;
                    last = Some(self.segment(child, at)?);
                }
                "class" => {
                    let class = self.text()?;
                    if let Some(last) = &mut last {
                        last.is_portal = class == "PORTAL";
                    }
                }
                "type" | "features" => self.skip()?,
                _ => self.skip_unknown(&child, at)?,
            }
        }
        self.keep_segment(last, space, floor)
    }

    fn segment(&mut self, start: BytesStart<'a>, at: Offset) -> Result<RawSegment<'a>> {
        let mut segment = RawSegment { start, at, is_portal: false, points: Bounds::EMPTY };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                "point" => segment.points = segment.points.with(self.point(&child, at)?),
                "class" => segment.is_portal = self.text()? == "PORTAL",
                // The portal states its kind; some versions write IMPLICIT here for every one.
                "type" | "features" => self.skip()?,
                _ => self.skip_unknown(&child, at)?,
            }
        }
        Ok(segment)
    }

    fn keep_segment(&mut self, raw: Option<RawSegment<'a>>, space: &mut Space, floor: &mut Floor) -> Result<()> {
        let Some(raw) = raw else { return Ok(()) };
        let points = raw.points;
        if raw.is_portal {
            let id = self.attribute(&raw.start, raw.at, "id")?.unwrap_or_default();
            let point = (!points.is_empty()).then(|| points.center());
            self.segments += 1;
            if self.segments > COUNT_LIMIT {
                let what = format!("has more than {COUNT_LIMIT} line segments of portals");
                return self.fail(raw.at, what, "split it into storeys");
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
            return self.fail(at, format!("has more than {COUNT_LIMIT} portals"), "split it into storeys");
        }
        let mut portal = Portal { at, ..Portal::default() };
        while let Some((child, at)) = self.child()? {
            match child.name().as_ref() {
                // The first version of the program wrote <id>.
                "linesegment" | "id" => portal.segment = self.text()?,
                "class" => portal.class = self.text()?,
                "type" => portal.kind = self.text()?,
                "features" => portal.features = self.text()?,
                "direction" => portal.direction = self.text()?,
                "target" => {
                    while let Some((child, at)) = self.child()? {
                        match child.name().as_ref() {
                            "id" => portal.targets.push(self.text()?),
                            _ => self.skip_unknown(&child, at)?,
                        }
                    }
                }
                _ => self.skip_unknown(&child, at)?,
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

/// The name of the tag at the start of a text.
fn tag_name(text: &str) -> &str {
    let name = text.strip_prefix('<').unwrap_or(text);
    name.split(|c: char| c.is_whitespace() || c == '>' || c == '/').next().unwrap_or_default()
}

/// Whether ASCII text has the same bytes in this encoding as in UTF-8.
fn is_ascii_compatible(encoding: &str) -> bool {
    let encoding = encoding.to_ascii_lowercase();
    ["ascii", "us-ascii", "latin1"].contains(&encoding.as_str())
        || encoding.starts_with("iso-8859-")
        || encoding.starts_with("windows-125")
}
