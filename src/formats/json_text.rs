//! What the readers of JSON formats share: from bytes to text, and from an error to its place.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Place, ReadError};

/// The text of a JSON file. A byte order mark is dropped.
///
/// # Errors
/// When the file is empty or not UTF-8; UTF-16 is named as such.
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
    std::str::from_utf8(body).map_err(|error| {
        let line = line_of(body, error.valid_up_to());
        fail(Some(line), "is not UTF-8", "save it again as UTF-8")
    })
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

/// What `serde_json` says, without the place that it appends.
pub(super) fn message_of(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&place).unwrap_or(&text).to_owned()
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
        f64::deserialize(deserializer).map(Self)
    }
}
