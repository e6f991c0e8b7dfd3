//! DXF as text: pairs of a group code and a value, a line each.

use std::fmt::Write as _;

use crate::geometry::Point;

/// Writes pairs, and gives every object a handle of its own.
pub(super) struct Pairs {
    out: String,
    last_handle: u32,
}

/// The number by which objects refer to each other; 0 for none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Handle(u32);

impl Pairs {
    /// Nothing yet. Handles go on from the last one of another part of the file.
    pub(super) fn after(last_handle: u32) -> Self {
        Self { out: String::new(), last_handle }
    }

    pub(super) const fn last_handle(&self) -> u32 {
        self.last_handle
    }

    /// A handle for an object that is written later.
    pub(super) const fn handle(&mut self) -> Handle {
        self.last_handle += 1;
        Handle(self.last_handle)
    }

    pub(super) fn text(&mut self, code: u32, value: &str) -> &mut Self {
        let _ = writeln!(self.out, "{code:>3}\n{}", escaped(value));
        self
    }

    pub(super) fn whole(&mut self, code: u32, value: i64) -> &mut Self {
        let _ = writeln!(self.out, "{code:>3}\n{value}");
        self
    }

    pub(super) fn number(&mut self, code: u32, value: f64) -> &mut Self {
        let _ = writeln!(self.out, "{code:>3}\n{}", number(value));
        self
    }

    pub(super) fn refer(&mut self, code: u32, handle: Handle) -> &mut Self {
        let _ = writeln!(self.out, "{code:>3}\n{:X}", handle.0);
        self
    }

    /// A point whose x has this code, and z = 0.
    pub(super) fn point(&mut self, code: u32, point: Point) -> &mut Self {
        self.number(code, point.x).number(code + 10, point.y).number(code + 20, 0.0)
    }

    pub(super) fn section(&mut self, name: &str) {
        self.text(0, "SECTION").text(2, name);
    }

    pub(super) fn end_section(&mut self) {
        self.text(0, "ENDSEC");
    }

    /// Adds what another part wrote.
    pub(super) fn append(&mut self, part: &Self) {
        self.out.push_str(&part.out);
    }

    pub(super) fn finish(self) -> String {
        self.out
    }
}

/// A number to a ten-thousandth of a millimetre in metres, without trailing zeros but with a point, as reals have.
fn number(value: f64) -> String {
    // `+ 0.0` turns -0.0 into 0.0.
    let text = format!("{:.7}", (value * 1e7).round() / 1e7 + 0.0);
    let short = text.trim_end_matches('0');
    if short.ends_with('.') { format!("{short}0") } else { short.to_owned() }
}

/// Text on one line in ASCII: other letters as their Unicode numbers, which all readers of this release know.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            ' '..='~' => out.push(letter),
            _ if letter.is_control() => out.push(' '),
            _ => {
                for part in letter.encode_utf16(&mut [0; 2]) {
                    let _ = write!(out, "\\U+{part:04X}");
                }
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_texts_are_as_readers_expect() {
        assert_eq!([number(1.0), number(-0.0), number(0.12), number(1e5)], ["1.0", "0.0", "0.12", "100000.0"]);
        assert_eq!(escaped("Küche 12 m²\n"), "K\\U+00FCche 12 m\\U+00B2 ");
    }
}
