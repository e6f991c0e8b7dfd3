use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;

use crate::formats::{FileError, Place, ReadError};
use crate::robot::carmen::{LONGEST_LINE, Log, LogError, LogReader};

/// The largest text of a log, in bytes: a compressed file of a few kilobytes can expand to gigabytes of
/// nothing.
const MOST_BYTES: u64 = 4 << 30;

/// A log as far as it could be read.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedLog {
    pub log: Log,
    /// Why reading stopped early, in words: a truncated compressed file.
    pub broken_off: Option<String>,
}

/// Loads a CARMEN log, plain or gzipped, whatever its name.
///
/// # Errors
/// When the file cannot be opened, or nothing in it can be mapped.
pub fn load_log(path: &Path) -> Result<LoadedLog, FileError> {
    let fail = |what: String, hint: &str| FileError {
        path: path.to_owned(),
        error: ReadError { place: Place::default(), what, hint: hint.to_owned() },
    };
    let file = std::fs::File::open(path).map_err(|error| fail(error.to_string(), "check the path"))?;
    read_log(BufReader::new(file)).map_err(|error| fail(error.to_string(), ""))
}

/// Reads a CARMEN log, plain or gzipped.
///
/// # Errors
/// When nothing in it can be mapped.
pub fn read_log(mut bytes: impl BufRead) -> Result<LoadedLog, LogError> {
    // A read error shows up again, and is reported, at the first line.
    let is_packed = bytes.fill_buf().is_ok_and(|head| head.starts_with(&[0x1f, 0x8b]));
    if is_packed { read_lines(BufReader::new(MultiGzDecoder::new(bytes))) } else { read_lines(bytes) }
}

fn read_lines(bytes: impl BufRead) -> Result<LoadedLog, LogError> {
    let mut bytes = bytes.take(MOST_BYTES);
    let mut reader = LogReader::new();
    let mut broken_off = None;
    let mut line = Vec::new();
    loop {
        match next_line(&mut bytes, &mut line) {
            Ok(Line::End) => break,
            Ok(Line::Whole) => reader.line(Some(&String::from_utf8_lossy(&line)))?,
            Ok(Line::TooLong) => reader.line(None)?,
            Err(error) => {
                broken_off = Some(match error.kind() {
                    ErrorKind::UnexpectedEof => "the packed file is cut off".to_owned(),
                    _ => error.to_string(),
                });
                break;
            }
        }
    }
    if bytes.limit() == 0 {
        return Err(LogError::TooLarge);
    }
    Ok(LoadedLog { log: reader.finish()?, broken_off })
}

enum Line {
    Whole,
    /// Longer than [`LONGEST_LINE`]; the rest was skipped.
    TooLong,
    End,
}

/// Reads a line into `line`, without its line ending, never keeping more than [`LONGEST_LINE`].
fn next_line(bytes: &mut impl BufRead, line: &mut Vec<u8>) -> std::io::Result<Line> {
    line.clear();
    bytes.by_ref().take(LONGEST_LINE as u64).read_until(b'\n', line)?;
    if line.is_empty() {
        return Ok(Line::End);
    }
    if line.len() < LONGEST_LINE || line.last() == Some(&b'\n') {
        return Ok(Line::Whole);
    }
    line.clear();
    loop {
        let buffer = match bytes.fill_buf() {
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            buffer => buffer?,
        };
        let found = buffer.iter().position(|byte| *byte == b'\n');
        let read = found.map_or(buffer.len(), |at| at + 1);
        bytes.consume(read);
        if found.is_some() || read == 0 {
            return Ok(Line::TooLong);
        }
    }
}
