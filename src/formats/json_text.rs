//! Shared by the readers of JSON formats: decoding bytes, and locating errors.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::text::{self, line_of};
use super::{Place, ReadError};

/// The text of a file that holds a JSON object. A byte order mark is dropped.
///
/// # Errors
/// As [`text::decode`], and when it does not start like an object.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, ReadError> {
    let text = text::decode(bytes)?;
    match text.trim_start().chars().next() {
        Some('{') => Ok(text),
        other => Err(ReadError {
            place: Place::default(),
            what: format!("is no JSON object: it starts with '{}'", other.map(String::from).unwrap_or_default()),
            hint: "check that it is the right file".to_owned(),
        }),
    }
}

/// The line, from 1, of the `nth` (from 0) member `"id": "…"` with this value.
pub(super) fn line_of_id(text: &str, id: &str, nth: usize) -> Option<usize> {
    let quoted = format!("\"{id}\"");
    text.match_indices(&quoted)
        .filter(|&(offset, _)| {
            let before = text[..offset].trim_end();
            before.strip_suffix(':').is_some_and(|before| before.trim_end().ends_with("\"id\""))
        })
        .nth(nth)
        .map(|(offset, _)| line_of(text.as_bytes(), offset))
}

/// The id of the element that an error of the JSON reader lies in, when it is a text of plain characters.
/// `depth`: how many objects the element lies in; 0 for an element that is a text by itself.
pub(super) fn id_around<'a>(text: &'a str, error: &serde_json::Error, depth: usize) -> Option<&'a str> {
    let line_start = match error.line() {
        0 => return None,
        1 => 0,
        line => text.match_indices('\n').nth(line - 2)?.0 + 1,
    };
    // The column counts the bytes read: the last of them may close the element.
    let at = line_start + error.column().saturating_sub(1);
    // Objects that are open, each with where its id stands: whether the key just read was "id" comes before.
    let mut open: Vec<Option<&str>> = Vec::new();
    let mut lists = Vec::new();
    let mut key_is_id = false;
    let bytes = text.as_bytes();
    let mut i = 0;
    let is_plain = |id: &&str| !id.is_empty() && id.len() <= 80 && !id.contains('\\');
    while i < bytes.len() {
        if i >= at {
            // The id may stand behind the error, but not behind the end of the element.
            match open.get(depth) {
                // The error may be that an element starts here at all.
                None if bytes[i] == b'{' && open.len() == depth => {}
                None => return None,
                Some(Some(id)) => return Some(*id).filter(is_plain),
                Some(None) => {}
            }
        }
        match bytes[i] {
            b'"' => {
                let start = i + 1;
                i = start;
                while i < bytes.len() && bytes[i] != b'"' && bytes[i] != b'\n' {
                    i += if bytes[i] == b'\\' { 2 } else { 1 };
                }
                let word = text.get(start..i.min(text.len()))?;
                let is_key = text[(i + 1).min(text.len())..].trim_start().starts_with(':');
                if !is_key
                    && key_is_id
                    && lists.last() == Some(&false)
                    && let Some(last) = open.last_mut()
                {
                    *last = last.or(Some(word));
                }
                key_is_id = is_key && word == "id";
            }
            b'{' => {
                open.push(None);
                lists.push(false);
                key_is_id = false;
            }
            b'[' => {
                lists.push(true);
                key_is_id = false;
            }
            b'}' => {
                if i >= at && open.len() == depth + 1 {
                    return open.pop().flatten().filter(is_plain);
                }
                open.pop();
                lists.pop();
            }
            b']' => {
                lists.pop();
            }
            _ => {}
        }
        i += 1;
    }
    open.get(depth).copied().flatten().filter(is_plain)
}

/// A JSON reader's error: what is wrong and, if obvious, what to do.
pub(super) struct JsonFault {
    pub what: String,
    pub hint: Option<&'static str>,
}

/// Words an error of `serde_json`; `text` is what it read.
pub(super) fn json_fault(text: &str, error: &serde_json::Error) -> JsonFault {
    let line = error.line().checked_sub(1).and_then(|index| text.split('\n').nth(index)).unwrap_or_default();
    if ["<<<<<<<", "=======", ">>>>>>>"].iter().any(|mark| line.starts_with(mark)) {
        return JsonFault {
            what: "holds a merge conflict of git".to_owned(),
            hint: Some("resolve the conflict, then open the file again"),
        };
    }
    if error.is_eof() {
        return JsonFault {
            what: "ends in the middle of a value".to_owned(),
            hint: Some("the file is cut off: restore it from a copy or from version control"),
        };
    }
    // `serde_json` appends the position, which our errors carry separately.
    let full = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let message = full.strip_suffix(&place).unwrap_or(&full);
    let what = match message {
        "expected value" | "expected ident" => format!("is no JSON at column {}", error.column()),
        "recursion limit exceeded" => "lists or objects are nested too deeply".to_owned(),
        "number out of range" => "a number is out of range".to_owned(),
        other => other.to_owned(),
    };
    JsonFault { what, hint: None }
}

/// A number that prints without a trailing '.0'.
#[derive(Clone, Copy)]
pub(super) struct Number(pub f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // Every whole number below 2^53 is itself an f64.
        if self.0.fract() == 0.0 && self.0.abs() < 9_007_199_254_740_992.0 {
            serializer.serialize_i64(self.0 as i64)
        } else {
            serializer.serialize_f64(self.0)
        }
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl serde::de::Visitor<'_> for NumberVisitor {
            type Value = Number;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }

            fn visit_f64<E>(self, number: f64) -> Result<Number, E> {
                Ok(Number(number))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Number, E> {
                Ok(Number(number as f64))
            }

            fn visit_u64<E>(self, number: u64) -> Result<Number, E> {
                Ok(Number(number as f64))
            }
        }
        deserializer.deserialize_f64(NumberVisitor)
    }
}

/// Writes a JSON object with one member, or one element of a list, per line: so small changes stay small
/// differences, and a line locates an element. Neither the values nor the keys of our disk types can fail
/// to be written.
pub(super) struct ObjectLines {
    text: String,
    is_empty: bool,
}

impl ObjectLines {
    /// `bytes` is the expected length.
    pub(super) fn new(bytes: usize) -> Self {
        let mut text = String::with_capacity(bytes);
        text.push('{');
        Self { text, is_empty: true }
    }

    fn name(&mut self, name: &str) {
        self.text.push_str(if self.is_empty { "\n" } else { ",\n" });
        self.is_empty = false;
        self.text.push_str(&compact(name));
        self.text.push_str(": ");
    }

    /// A member on a line of its own.
    pub(super) fn member<T: Serialize + ?Sized>(&mut self, name: &str, value: &T) {
        self.name(name);
        self.text.push_str(&compact(value));
    }

    /// Each member of an object on a line of its own.
    pub(super) fn members<'a>(&mut self, object: impl IntoIterator<Item = (&'a String, &'a Value)>) {
        for (name, value) in object {
            self.member(name, value);
        }
    }

    /// A list, each element on a line of its own.
    pub(super) fn list<T: Serialize>(&mut self, name: &str, elements: impl IntoIterator<Item = T>) {
        self.name(name);
        self.text.push('[');
        for (i, element) in elements.into_iter().enumerate() {
            self.text.push_str(if i == 0 { "\n" } else { ",\n" });
            self.text.push_str(&compact(&element));
        }
        self.text.push_str("\n]");
    }

    /// An object, each member on a line of its own.
    pub(super) fn object(&mut self, name: &str, value: &impl Serialize) {
        self.name(name);
        let mut inner = Self::new(0);
        let value = serde_json::to_value(value).unwrap_or_default();
        inner.members(value.as_object().into_iter().flatten());
        self.text.push_str(&inner.text);
        self.text.push_str("\n}");
    }

    /// The whole file.
    pub(super) fn finish(mut self) -> Vec<u8> {
        self.text.push_str("\n}\n");
        self.text.into_bytes()
    }
}

/// Compact JSON of a value.
pub(super) fn compact<T: Serialize + ?Sized>(value: &T) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
