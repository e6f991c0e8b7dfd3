//! Walks through XML element by element with the place of each, for the readers of XML formats: what is not
//! well-formed is refused with its line, elements that a format does not know are skipped and counted.

use std::borrow::Cow;
use std::collections::BTreeMap;

use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart, Event};

use super::text::line_of;
use super::{Note, NoteKind, Place, ReadError};

/// Maximum nesting depth: the deepest format needs 8.
const DEPTH_LIMIT: usize = 64;

/// The most names of unknown elements to remember for the report.
const UNKNOWN_LIMIT: usize = 50;

/// Coordinates in pixels: no picture is wider than this.
pub(super) const PIXEL_LIMIT: f64 = 1_000_000.0;

/// A byte offset in the file, for finding the line.
pub(super) type Offset = usize;

/// Elements that are not read: how many of each name, and the position of the first.
pub(super) type Unknown = BTreeMap<String, (usize, Offset)>;

/// The hint for most damaged files.
pub(super) const DAMAGED_HINT: &str = "correct it by hand, or restore it from a copy";

/// The name of the root element of a file that starts with `head`, if it is XML and the name is
/// complete.
pub(super) fn root_name(head: &[u8]) -> Option<String> {
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

/// A piece of XML.
pub(super) enum Token<'a> {
    Start(BytesStart<'a>, Offset),
    End,
    Text(Cow<'a, str>),
    Eof,
}

/// A file's XML, read from the start to the end.
pub(super) struct Xml<'a> {
    reader: Reader<&'a [u8]>,
    text: &'a str,
    /// What the file is called in messages: 'a file of the authors' program'.
    of: &'static str,
    /// Where each element that is open starts.
    open: Vec<Offset>,
    /// The current element, for messages ('space 3547daca-…').
    pub(super) element: String,
    pub(super) unknown: Unknown,
}

pub(super) type Result<T, E = ReadError> = std::result::Result<T, E>;

impl<'a> Xml<'a> {
    pub(super) fn new(text: &'a str, of: &'static str) -> Self {
        let mut reader = Reader::from_str(text);
        reader.config_mut().expand_empty_elements = true;
        Self { reader, text, of, open: Vec::new(), element: String::new(), unknown: Unknown::new() }
    }

    pub(super) fn fail<T>(&self, at: Offset, what: impl Into<String>, hint: &str) -> Result<T> {
        let line = Some(line_of(self.text.as_bytes(), at));
        let place = Place { line, element: self.element.clone() };
        Err(ReadError { place, what: what.into(), hint: hint.to_owned() })
    }

    pub(super) fn position(&self) -> Offset {
        usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX)
    }

    /// The next meaningful token; comments and instructions are skipped.
    pub(super) fn next(&mut self) -> Result<Token<'a>> {
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
                        return self.fail(at, what, &format!("this is no {}", self.of));
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
    pub(super) fn child(&mut self) -> Result<Option<(BytesStart<'a>, Offset)>> {
        loop {
            match self.next()? {
                Token::Start(start, at) => return Ok(Some((start, at))),
                Token::End | Token::Eof => return Ok(None),
                Token::Text(_) => {}
            }
        }
    }

    /// Skips the rest of the element opened last.
    pub(super) fn skip(&mut self) -> Result<()> {
        let depth = self.open.len();
        while self.open.len() >= depth {
            self.next()?;
        }
        Ok(())
    }

    /// Skips an unknown element and remembers it.
    pub(super) fn skip_unknown(&mut self, start: &BytesStart<'a>, at: Offset) -> Result<()> {
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
    pub(super) fn text(&mut self) -> Result<String> {
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
    pub(super) fn attribute(&self, start: &BytesStart<'a>, at: Offset, name: &str) -> Result<Option<String>> {
        let value = start
            .try_get_attribute(name)
            .map_err(quick_xml::Error::from)
            .and_then(|attribute| attribute.map(|found| found.normalized_value(XmlVersion::Explicit1_0)).transpose());
        match value {
            Ok(value) => Ok(value.map(|value| value.trim().to_owned())),
            Err(error) => self.fail(at, format!("is not well-formed XML: {error}"), DAMAGED_HINT),
        }
    }

    /// The numbers of an element's attributes of these names, each within ±[`PIXEL_LIMIT`]; `what` names the element
    /// for the error.
    pub(super) fn numbers<const N: usize>(
        &self,
        start: &BytesStart<'a>,
        at: Offset,
        names: [&str; N],
        what: &str,
    ) -> Result<[Option<f64>; N]> {
        let mut numbers = [None; N];
        for attribute in start.attributes().with_checks(false) {
            let attribute = match attribute {
                Ok(attribute) => attribute,
                Err(error) => return self.fail(at, format!("is not well-formed XML: {error}"), DAMAGED_HINT),
            };
            let key: &str = attribute.key.as_ref();
            let Some(index) = names.iter().position(|name| *name == key) else { continue };
            match attribute.value.trim().parse::<f64>() {
                Ok(value) if value.abs() <= PIXEL_LIMIT => numbers[index] = Some(value),
                _ => {
                    let text = &attribute.value;
                    let what = format!("{key}=\"{text}\" of {what} is no number within ±{PIXEL_LIMIT}");
                    return self.fail(at, what, DAMAGED_HINT);
                }
            }
        }
        Ok(numbers)
    }

    /// The root element, which must have this name; nothing else may come before it.
    pub(super) fn enter_root(&mut self, root: &str) -> Result<(BytesStart<'a>, Offset)> {
        let hint = format!("a plan starts with <{root}>");
        loop {
            let at = self.position();
            match self.next()? {
                Token::Start(start, at) if start.name().as_ref() == root => return Ok((start, at)),
                Token::Start(start, at) => {
                    let name = start.name();
                    let what = format!("is XML, but no {}: its root is <{}>", self.of, name.as_ref());
                    return self.fail(at, what, &hint);
                }
                Token::Text(text) if text.trim().is_empty() => {}
                _ => return self.fail(at, "is not XML", &hint),
            }
        }
    }

    /// The end of the file behind the root element; `hint` says what a file holds.
    pub(super) fn finish(&mut self, root: &str, hint: &str) -> Result<()> {
        loop {
            let at = self.position();
            match self.next()? {
                Token::Eof => return Ok(()),
                Token::Text(text) if text.trim().is_empty() => {}
                _ => return self.fail(at, format!("goes on behind </{root}>"), hint),
            }
        }
    }
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

/// Maximum notes per file. More help nobody, and a hostile file must not fill the memory.
const NOTE_LIMIT: usize = 10_000;

/// Notes with their lines.
pub(super) struct Notes<'a> {
    text: &'a str,
    /// Positions of line ends; filled with the first note.
    line_ends: Vec<Offset>,
    notes: Vec<Note>,
    left_off: usize,
}

impl<'a> Notes<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { text, line_ends: Vec::new(), notes: Vec::new(), left_off: 0 }
    }

    /// The line, from 1, of a place in the text.
    pub(super) fn line(&mut self, at: Offset) -> usize {
        if self.line_ends.is_empty() {
            self.line_ends = self.text.match_indices('\n').map(|(offset, _)| offset).collect();
        }
        1 + self.line_ends.partition_point(|&end| end < at)
    }

    pub(super) fn push(
        &mut self,
        kind: NoteKind,
        at: Option<Offset>,
        element: impl Into<String>,
        what: impl Into<String>,
    ) {
        if self.notes.len() >= NOTE_LIMIT {
            self.left_off += 1;
            return;
        }
        let line = at.map(|at| self.line(at));
        self.notes.push(Note { kind, place: Place { line, element: element.into() }, what: what.into() });
    }

    /// Tells which elements were not read.
    pub(super) fn unknown(&mut self, unknown: &Unknown) {
        for (name, &(count, at)) in unknown {
            let times = if count == 1 { String::new() } else { format!(" ({count} times)") };
            self.push(
                NoteKind::Skipped,
                Some(at),
                format!("<{name}>"),
                format!("is no known element{times}; left out"),
            );
        }
    }

    /// All notes, in the file's order.
    pub(super) fn finish(mut self) -> Vec<Note> {
        self.notes.sort_by_key(|note| note.place.line);
        if self.left_off > 0 {
            let what = format!("{} more things were mended or left out", self.left_off);
            self.notes.push(Note { kind: NoteKind::Healed, place: Place::default(), what });
        }
        self.notes
    }
}
