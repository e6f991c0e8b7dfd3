//! Shared by the readers of text formats: decoding bytes, and finding the line of a byte.

use super::{Place, ReadError};

/// The text of a file that starts with an ASCII character, without its byte order mark.
///
/// # Errors
/// When the file is empty, or not UTF-8: UTF-16 is named as such, otherwise the first bad line.
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
    // A zero byte among the first two means two bytes per character; the byte order marks are those of
    // UTF-16.
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
