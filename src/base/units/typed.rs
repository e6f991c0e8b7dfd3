//! Parses typed lengths and angles: numbers with units, and arithmetic on them.

use std::fmt;

/// Metres in a foot.
pub const METRES_PER_FOOT: f64 = 12.0 * METRES_PER_INCH;

/// Metres in an inch, by its definition of 1959.
pub const METRES_PER_INCH: f64 = 0.0254;

/// Why a typed text is not a length or angle, and what would be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotUnderstood(String);

impl fmt::Display for NotUnderstood {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NotUnderstood {}

/// The longest text accepted: nobody types a longer length.
const MOST_LETTERS: usize = 200;

/// How deep parentheses and signs may nest.
const MOST_DEPTH: usize = 32;

/// Nothing in a plan is longer, in metres, or turned further, in radians.
const MOST: f64 = 1e9;

/// A unit: its spellings and its size.
type Unit = (&'static [&'static str], f64);

const METRES: Unit = (&["m", "metre", "metres", "meter", "meters"], 1.0);
const FEET: Unit = (&["'", "′", "’", "ft", "foot", "feet"], METRES_PER_FOOT);
const INCHES: Unit = (&["\"", "″", "”", "''", "′′", "in", "inch", "inches"], METRES_PER_INCH);

const LENGTHS: &[Unit] = &[METRES, (&["cm"], 0.01), (&["mm"], 0.001), (&["dm"], 0.1), (&["km"], 1000.0), INCHES, FEET];

const ANGLES: &[Unit] =
    &[(&["°", "º", "deg", "degree", "degrees"], std::f64::consts::PI / 180.0), (&["rad", "radian", "radians"], 1.0)];

/// What is being parsed: its units, and words for errors.
struct Kind {
    units: &'static [Unit],
    /// The size of a number without a unit.
    unit: f64,
    /// 'a length'.
    name: &'static str,
    /// What the product of two of them is.
    square: &'static str,
    /// Examples of valid input, for errors.
    examples: &'static str,
}

/// Parses a length in metres; `unit_m` is the unit of a number without one.
pub(super) fn length_m(text: &str, unit_m: f64) -> Result<f64, NotUnderstood> {
    let kind = Kind {
        units: LENGTHS,
        unit: unit_m,
        name: "length",
        square: "is an area",
        examples: "a length is a number, with m, cm, mm, ft or in if need be, such as 3.25, 325 cm, 10' 8 1/2\" or 3.2 + 0.4",
    };
    kind.read(text)
}

/// Parses an angle in radians: degrees (`45`, `45°`, `22,5 deg`), `0.5 rad`, and sums of them with + - *
/// / and parentheses.
///
/// # Errors
/// When the text is not understood; the error says what would be.
pub fn parse_angle_rad(text: &str) -> Result<f64, NotUnderstood> {
    let kind = Kind {
        units: ANGLES,
        unit: std::f64::consts::PI / 180.0,
        name: "angle",
        square: "is no angle",
        examples: "an angle is a number of degrees, such as 45, 22.5° or 90/4, or of radians with rad",
    };
    kind.read(text)
}

/// An intermediate value.
#[derive(Clone, Copy)]
enum Value {
    /// Without a unit: a factor, or a length once all is read.
    Number(f64),
    /// With a unit, in metres or radians.
    Quantity(f64),
}

impl Kind {
    fn read(&self, text: &str) -> Result<f64, NotUnderstood> {
        if text.trim().is_empty() {
            return Err(self.not("nothing is typed"));
        }
        if text.chars().count() > MOST_LETTERS {
            return Err(self.not("this is too long"));
        }
        let mut reader = Reader { kind: self, rest: text, depth: 0 };
        let value = reader.sum()?;
        reader.skip_blanks();
        if !reader.rest.is_empty() {
            return Err(reader.unexpected());
        }
        let value = self.quantity(value);
        if value.is_finite() && value.abs() <= MOST { Ok(value) } else { Err(self.not("this is too large")) }
    }

    fn quantity(&self, value: Value) -> f64 {
        match value {
            Value::Number(number) => number * self.unit,
            Value::Quantity(quantity) => quantity,
        }
    }

    fn not(&self, what: impl fmt::Display) -> NotUnderstood {
        NotUnderstood(format!("{what}; {}", self.examples))
    }
}

struct Reader<'a> {
    kind: &'a Kind,
    rest: &'a str,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    /// Skips spaces and consumes one of the wanted characters.
    fn take(&mut self, wanted: &[char]) -> Option<char> {
        let rest = self.rest.trim_start();
        let first = rest.chars().next().filter(|first| wanted.contains(first))?;
        self.rest = &rest[first.len_utf8()..];
        Some(first)
    }

    /// The error for what stands here.
    fn unexpected(&self) -> NotUnderstood {
        let rest = self.rest.trim_start();
        if rest.is_empty() {
            return self.kind.not("it ends too early");
        }
        let is_word = |c: char| c.is_alphanumeric() || c == '.' || c == ',';
        let word: String = if rest.starts_with(is_word) {
            rest.chars().take_while(|&c| is_word(c)).take(20).collect()
        } else {
            rest.chars().take(1).collect()
        };
        self.kind.not(format_args!("'{word}' is not understood"))
    }

    fn sum(&mut self) -> Result<Value, NotUnderstood> {
        let mut value = self.product()?;
        while let Some(sign) = self.take(&['+', '-', '−', '–']) {
            let other = self.product()?;
            let sign = if sign == '+' { 1.0 } else { -1.0 };
            value = match (value, other) {
                (Value::Number(a), Value::Number(b)) => Value::Number(a + sign * b),
                (a, b) => Value::Quantity(self.kind.quantity(a) + sign * self.kind.quantity(b)),
            };
        }
        Ok(value)
    }

    fn product(&mut self) -> Result<Value, NotUnderstood> {
        let mut value = self.signed()?;
        let name = self.kind.name;
        while let Some(sign) = self.take(&['*', '×', '·', '/', '÷', ':']) {
            let other = self.signed()?;
            let is_product = matches!(sign, '*' | '×' | '·');
            value = match (value, other) {
                (Value::Number(a), Value::Number(b)) if is_product => Value::Number(a * b),
                (Value::Number(a), Value::Quantity(b)) | (Value::Quantity(a), Value::Number(b)) if is_product => {
                    Value::Quantity(a * b)
                }
                (Value::Quantity(_), Value::Quantity(_)) if is_product => {
                    return Err(self.kind.not(format_args!("a {name} times a {name} {}", self.kind.square)));
                }
                (_, Value::Number(0.0) | Value::Quantity(0.0)) => return Err(self.kind.not("this divides by zero")),
                (Value::Number(a), Value::Number(b)) => Value::Number(a / b),
                (Value::Quantity(a), Value::Number(b)) => Value::Quantity(a / b),
                (Value::Number(_), Value::Quantity(_)) => {
                    return Err(self.kind.not(format_args!("this divides by a {name}")));
                }
                (Value::Quantity(_), Value::Quantity(_)) => {
                    return Err(self.kind.not(format_args!("a {name} divided by a {name} is no {name}")));
                }
            };
        }
        Ok(value)
    }

    fn signed(&mut self) -> Result<Value, NotUnderstood> {
        if self.depth >= MOST_DEPTH {
            return Err(self.kind.not("this is too deep"));
        }
        self.depth += 1;
        let value = match self.take(&['-', '−', '–', '+', '(']) {
            Some('(') => {
                let value = self.sum()?;
                if self.take(&[')']).is_none() {
                    return Err(self.kind.not("a ')' is missing"));
                }
                value
            }
            Some('+') => self.signed()?,
            Some(_) => match self.signed()? {
                Value::Number(number) => Value::Number(-number),
                Value::Quantity(quantity) => Value::Quantity(-quantity),
            },
            None => self.quantity()?,
        };
        self.depth -= 1;
        Ok(value)
    }

    /// A number with or without a unit, or feet and inches.
    fn quantity(&mut self) -> Result<Value, NotUnderstood> {
        self.skip_blanks();
        let number = self.number()?;
        let Some((unit, size)) = self.unit() else { return Ok(Value::Number(number)) };
        let feet_m = number * size;
        if unit != FEET.0 {
            return Ok(Value::Quantity(feet_m));
        }
        // Inches, after a space, nothing, or a hyphen without spaces around it.
        let before = self.rest;
        self.rest = self.rest.strip_prefix('-').unwrap_or(self.rest);
        if self.rest.trim_start().starts_with(|c: char| c.is_ascii_digit() || c == '.')
            && (self.rest.len() == before.len() || !self.rest.starts_with(char::is_whitespace))
        {
            self.skip_blanks();
            let inches = self.number()?;
            match self.unit() {
                Some((unit, size)) if unit == INCHES.0 => return Ok(Value::Quantity(feet_m + inches * size)),
                None => return Ok(Value::Quantity(feet_m + inches * METRES_PER_INCH)),
                // Two lengths in a row.
                Some(_) => {}
            }
        }
        self.rest = before;
        Ok(Value::Quantity(feet_m))
    }

    /// `3.25`, `3,25`, `8 1/2`, and `1/2` where a unit follows.
    fn number(&mut self) -> Result<f64, NotUnderstood> {
        let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
        let end = self.rest.find(|c: char| !is_part(c)).unwrap_or(self.rest.len());
        let word = &self.rest[..end];
        let marks = word.chars().filter(|c| !c.is_ascii_digit()).count();
        let value = word.replace(',', ".").parse::<f64>().ok().filter(|_| marks <= 1 && marks < word.len());
        let Some(value) = value else { return Err(self.unexpected()) };
        self.rest = &self.rest[end..];
        if marks > 0 {
            return Ok(value);
        }
        // A whole number and a fraction.
        if self.rest.starts_with(char::is_whitespace)
            && let Some((part, rest)) = fraction(self.rest.trim_start())
        {
            self.rest = rest;
            return Ok(value + part);
        }
        // A fraction alone counts only with a unit after it: 1/2", but 7/2 and 10'/2 are divisions.
        if let Some((whole, rest)) = fraction_of(value, self.rest) {
            let mut ahead = Reader { kind: self.kind, rest, depth: 0 };
            if ahead.unit().is_some() {
                self.rest = rest;
                return Ok(whole);
            }
        }
        Ok(value)
    }

    /// A unit, after optional spaces.
    fn unit(&mut self) -> Option<(&'static [&'static str], f64)> {
        let rest = self.rest.trim_start();
        let end = rest.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(rest.len());
        let word = rest[..end].to_lowercase();
        let mut found: Option<(&'static [&'static str], f64, usize)> = None;
        for &(spellings, size) in self.kind.units {
            for spelling in spellings {
                let is_it = if spelling.is_ascii() && spelling.starts_with(|c: char| c.is_ascii_alphabetic()) {
                    word == *spelling
                } else {
                    rest.starts_with(spelling)
                };
                // Two apostrophes are inches, one is feet.
                if is_it && found.is_none_or(|(_, _, length)| spelling.len() > length) {
                    found = Some((spellings, size, spelling.len()));
                }
            }
        }
        let (spellings, size, length) = found?;
        self.rest = &rest[length..];
        Some((spellings, size))
    }
}

/// `1/2` at the start of a text, and the rest.
fn fraction(text: &str) -> Option<(f64, &str)> {
    let (part, rest) = whole(text)?;
    fraction_of(part, rest)
}

/// `/2` after a whole number, and the rest.
fn fraction_of(part: f64, rest: &str) -> Option<(f64, &str)> {
    let (of, rest) = whole(rest.strip_prefix('/')?)?;
    (of > 0.0 && !rest.starts_with(['.', ','])).then(|| (part / of, rest))
}

/// A whole number at the start of a text, and the rest.
fn whole(text: &str) -> Option<(f64, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    Some((text[..end].parse().ok()?, &text[end..]))
}
