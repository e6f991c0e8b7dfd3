//! The door through which everything goes that the program prints: whatever a file says, no control character reaches
//! the terminal. Names in plans may hold escape sequences, which move the cursor, change the title, or hide text.

use std::io::{self, Write};

/// Colours of text, as marks in it that the door turns into what the terminal understands, or leaves out.
/// They are noncharacters: no text of a person holds them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// What is wrong.
    Error,
    /// What may be wrong.
    Warning,
    /// What is worth knowing.
    Info,
}

/// The mark that ends a colour.
const PLAIN: char = '\u{fdd0}';

impl Paint {
    const ALL: [Self; 3] = [Self::Error, Self::Warning, Self::Info];

    const fn mark(self) -> char {
        match self {
            Self::Error => '\u{fdd1}',
            Self::Warning => '\u{fdd2}',
            Self::Info => '\u{fdd3}',
        }
    }

    /// Bold red, yellow and cyan of the terminal's own palette.
    const fn code(self) -> &'static str {
        match self {
            Self::Error => "\x1b[1;31m",
            Self::Warning => "\x1b[33m",
            Self::Info => "\x1b[36m",
        }
    }

    /// The text in this colour, where the terminal has colours.
    pub fn on(self, text: &str) -> String {
        format!("{}{text}{PLAIN}", self.mark())
    }
}

/// A way out for text.
pub struct Door {
    sink: Box<dyn Write>,
    has_colours: bool,
    is_terminal: bool,
    /// The beginning of a character that is not whole yet, or a carriage return whose line feed may follow.
    rest: Vec<u8>,
}

impl Door {
    /// Text goes to `sink`.
    pub fn new(sink: Box<dyn Write>) -> Self {
        Self { sink, has_colours: false, is_terminal: false, rest: Vec::new() }
    }

    /// Text goes to `sink`, which is a terminal, if `is_terminal`, that may have colours.
    pub(super) fn to(sink: Box<dyn Write>, is_terminal: bool) -> Self {
        Self { is_terminal, has_colours: is_terminal && wants_colours(), ..Self::new(sink) }
    }

    /// Writes what is no text: a picture.
    ///
    /// # Errors
    /// When a terminal would have to show it, or it cannot be written.
    pub(super) fn write_binary(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.is_terminal {
            return Err(io::Error::other(
                "this cannot be shown on a terminal; name a file with -o, or redirect the \
                                         output",
            ));
        }
        self.flush()?;
        self.sink.write_all(bytes)
    }

    fn write_char(&mut self, c: char) -> io::Result<()> {
        if let Some(paint) = Paint::ALL.into_iter().find(|paint| paint.mark() == c) {
            return if self.has_colours { self.sink.write_all(paint.code().as_bytes()) } else { Ok(()) };
        }
        match c {
            PLAIN if self.has_colours => self.sink.write_all(b"\x1b[0m"),
            PLAIN => Ok(()),
            '\n' | '\t' => self.sink.write_all(&[c as u8]),
            _ if is_hidden(c) => write!(self.sink, "{}", escaped(c)),
            _ => self.sink.write_all(c.encode_utf8(&mut [0; 4]).as_bytes()),
        }
    }

    /// Writes as much as is whole, and keeps the rest.
    fn write_text(&mut self, bytes: &[u8], is_end: bool) -> io::Result<()> {
        let mut held = std::mem::take(&mut self.rest);
        held.extend_from_slice(bytes);
        let mut rest: &[u8] = &held;
        while !rest.is_empty() {
            // The longest beginning that goes out as it is.
            let plain = rest.iter().take_while(|byte| (0x20..0x7f).contains(*byte) || **byte == b'\n').count();
            self.sink.write_all(&rest[..plain])?;
            rest = &rest[plain..];
            let Some(first) = rest.first() else { break };
            if *first == b'\r' {
                match rest.get(1) {
                    None if !is_end => break,
                    Some(b'\n') => self.sink.write_all(b"\r\n")?,
                    _ => self.write_char('\r')?,
                }
                rest = &rest[if rest.get(1) == Some(&b'\n') { 2 } else { 1 }..];
                continue;
            }
            let length = match first {
                0xc2..=0xdf => 2,
                0xe0..=0xef => 3,
                0xf0..=0xf4 => 4,
                _ => 1,
            };
            let whole = &rest[..length.min(rest.len())];
            match std::str::from_utf8(whole) {
                Ok(text) => {
                    for c in text.chars() {
                        self.write_char(c)?;
                    }
                    rest = &rest[whole.len()..];
                }
                // It may go on with the next bytes.
                Err(error) if error.error_len().is_none() && !is_end => break,
                Err(_) => {
                    write!(self.sink, "\\x{first:02x}")?;
                    rest = &rest[1..];
                }
            }
        }
        self.rest = rest.to_vec();
        Ok(())
    }
}

impl Write for Door {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_text(bytes, false)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.write_text(b"", true)?;
        self.sink.flush()
    }
}

/// Whether colours are wanted on a terminal: see no-color.org.
fn wants_colours() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Whether a character does something to the terminal instead of being seen: control characters, those that turn
/// the direction of writing round (U+202A to U+202E, U+2066 to U+2069), and the separators of lines that only some
/// programs take for such (U+2028, U+2029).
fn is_hidden(c: char) -> bool {
    c.is_control() || matches!(c, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// As JSON writes it, so that JSON stays what it is.
fn escaped(c: char) -> String {
    format!("\\u{:04x}", u32::from(c))
}

/// A text for one line: line feeds and tabs are shown as well.
pub fn one_line(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if is_hidden(c) { shown.push_str(&escaped(c)) } else { shown.push(c) }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    #[derive(Clone, Default)]
    struct Sink(Arc<Mutex<Vec<u8>>>);

    impl Write for Sink {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.lock().expect("unbroken").write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn through(pieces: &[&[u8]], has_colours: bool) -> String {
        let sink = Sink::default();
        let mut door = Door { has_colours, ..Door::new(Box::new(sink.clone())) };
        for piece in pieces {
            door.write_all(piece).expect("written");
        }
        door.flush().expect("written");
        String::from_utf8(sink.0.lock().expect("unbroken").clone()).expect("text")
    }

    #[test]
    fn control_characters_are_shown() {
        assert_eq!(through(&["Büro 12 m²\tß\n".as_bytes()], false), "Büro 12 m²\tß\n");
        assert_eq!(through(&[b"\x1b]0;X\x07\x7f\0\r"], false), "\\u001b]0;X\\u0007\\u007f\\u0000\\u000d");
        assert_eq!(through(&["\u{9b}2J\u{202e}evil".as_bytes()], false), "\\u009b2J\\u202eevil");
        assert_eq!(through(&[b"a\r\nb"], false), "a\r\nb");
        assert_eq!(through(&[b"a\r", b"\nb\r", b"c"], false), "a\r\nb\\u000dc");
        assert_eq!(through(&[b"\xc3", b"\xbc", b"\xff\xe2\x80"], false), "ü\\xff\\xe2\\x80");
        // A character cut in any place.
        for at in 0..=3 {
            let text = "\u{202e}".as_bytes();
            assert_eq!(through(&[&text[..at], &text[at..]], false), "\\u202e");
        }
        assert_eq!(one_line("a\nb\tc"), "a\\u000ab\\u0009c");
    }

    #[test]
    fn colours_only_where_they_are_wanted() {
        let text = format!("{}: x", Paint::Error.on("error"));
        assert_eq!(through(&[text.as_bytes()], false), "error: x");
        assert_eq!(through(&[text.as_bytes()], true), "\x1b[1;31merror\x1b[0m: x");
    }
}
