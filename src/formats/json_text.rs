//! What the readers of JSON formats share: from bytes to text, and from an error to its place.

use std::fmt;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Place, ReadError};

/// The text of a file that holds a JSON object. A byte order mark is dropped.
///
/// # Errors
/// When the file is empty, not UTF-8 (UTF-16 is named as such), or starts like no object.
pub(super) fn decode(bytes: &[u8]) -> Result<&str, ReadError> {
    let fail = |line, what: &str, hint: &str| ReadError {
        place: Place { line, element: String::new() },
        what: what.to_owned(),
        hint: hint.to_owned(),
    };
    let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if body.iter().all(u8::is_ascii_whitespace) {
        return Err(fail(None, "is empty", "restore it from a copy"));
    }
    // JSON starts with an ASCII character, so a zero byte among the first two means two bytes a
    // character; the byte order marks are those of UTF-16.
    if body.starts_with(b"\xff\xfe") || body.starts_with(b"\xfe\xff") || body.iter().take(2).any(|&byte| byte == 0) {
        return Err(fail(None, "is UTF-16 or UTF-32, not UTF-8", "save it again as UTF-8"));
    }
    let text = std::str::from_utf8(body).map_err(|error| {
        let line = line_of(body, error.valid_up_to());
        fail(Some(line), "is not UTF-8", "save it again as UTF-8")
    })?;
    match text.trim_start().chars().next() {
        Some('{') => Ok(text),
        other => {
            let start = other.map(String::from).unwrap_or_default();
            Err(fail(None, &format!("is no JSON object: it starts with '{start}'"), "check that it is the right file"))
        }
    }
}

/// The line, from 1, of a byte of a text.
pub(super) fn line_of(text: &[u8], offset: usize) -> usize {
    1 + text[..offset.min(text.len())].iter().filter(|&&byte| byte == b'\n').count()
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

/// The value of the first member `"id": "…"` of a line, when it is of plain characters.
pub(super) fn id_on_line(text: &str, line: usize) -> Option<&str> {
    let line = text.split('\n').nth(line.checked_sub(1)?)?;
    let (_, rest) = line.split_once("\"id\"")?;
    let value = rest.trim_start().strip_prefix(':')?.trim_start().strip_prefix('"')?;
    let (id, _) = value.split_once('"')?;
    (!id.is_empty() && id.len() <= 80 && !id.contains('\\')).then_some(id)
}

/// An error of the JSON reader: what is wrong, and what to do where that is plain.
pub(super) struct JsonFault {
    pub what: String,
    pub hint: Option<&'static str>,
}

/// Puts an error of `serde_json` in words; `text` is what it read.
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
    // `serde_json` appends the place, which our errors carry apart.
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
