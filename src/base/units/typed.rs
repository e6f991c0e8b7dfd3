//! The one reader of what somebody types for a length, an angle or a number: numbers with units, and sums of them.
//!
//! Every place where one can be typed comes here: the canvas while something is drawn, fields, prompts, scripts,
//! options of subcommands. What is not understood is refused with a word on what is; nothing is passed over.

use std::fmt;

/// Metres in a foot.
pub const METRES_PER_FOOT: f64 = 12.0 * METRES_PER_INCH;

/// Metres in an inch, by its definition of 1959.
pub const METRES_PER_INCH: f64 = 0.0254;

/// Why a typed text is no length, angle or number, with what would be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotUnderstood(String);

impl fmt::Display for NotUnderstood {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NotUnderstood {}

/// A longer text is no length: nobody types so much.
const MOST_LETTERS: usize = 200;

/// Parentheses and signs stand in each other at most so deep.
const MOST_DEPTH: usize = 32;

/// Nothing in a plan is longer, in metres, and no turn larger.
const MOST: f64 = 1e9;

/// What a unit is, where that matters for what stands beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Is {
    Feet,
    Inches,
    Other,
}

/// A unit: its words in lower case, what it is, and its size.
type Unit = (&'static [&'static str], Is, f64);

const LENGTHS: &[Unit] = &[
    (&["m", "metre", "metres", "meter", "meters"], Is::Other, 1.0),
    (&["cm", "centimetre", "centimetres", "centimeter", "centimeters"], Is::Other, 0.01),
    (&["mm", "millimetre", "millimetres", "millimeter", "millimeters"], Is::Other, 0.001),
    (&["dm", "decimetre", "decimetres", "decimeter", "decimeters"], Is::Other, 0.1),
    (&["km", "kilometre", "kilometres", "kilometer", "kilometers"], Is::Other, 1000.0),
    (&["in", "inch", "inches"], Is::Inches, METRES_PER_INCH),
    (&["ft", "foot", "feet"], Is::Feet, METRES_PER_FOOT),
    (&["yd", "yard", "yards"], Is::Other, 3.0 * METRES_PER_FOOT),
];

/// What stands for feet behind a number: an apostrophe, or what a keyboard, a word processor or a table of
/// characters has for one. Two of them stand for inches.
const FEET_MARKS: &[char] = &['\'', '’', '‘', '′', 'ʹ', 'ʼ', '´', '`', '＇'];

/// What stands for inches.
const INCH_MARKS: &[char] = &['"', '”', '“', '„', '″', 'ʺ', '˝', '＂'];

const ANGLES: &[Unit] = &[
    (&["deg", "degree", "degrees"], Is::Other, 1.0),
    (&["rad", "radian", "radians"], Is::Other, 180.0 / std::f64::consts::PI),
];

const DEGREE_MARKS: &[char] = &['°', 'º', '˚'];

/// What joins feet and inches, or inches and their fraction, where no blank stands beside it: hyphens, and the dash
/// that word processors make of one.
const HYPHENS: &[char] = &['-', '‐', '‑', '–'];

/// What takes away.
const MINUS: &[char] = &['-', '−', '–', '‐', '‑'];

/// Between the parts of a fraction.
const SLASHES: &[char] = &['/', '⁄', '∕'];

/// Fractions that are one character.
const FRACTIONS: &[(char, f64)] = &[
    ('½', 1.0 / 2.0),
    ('¼', 1.0 / 4.0),
    ('¾', 3.0 / 4.0),
    ('⅛', 1.0 / 8.0),
    ('⅜', 3.0 / 8.0),
    ('⅝', 5.0 / 8.0),
    ('⅞', 7.0 / 8.0),
    ('⅓', 1.0 / 3.0),
    ('⅔', 2.0 / 3.0),
    ('⅕', 1.0 / 5.0),
    ('⅖', 2.0 / 5.0),
    ('⅗', 3.0 / 5.0),
    ('⅘', 4.0 / 5.0),
    ('⅙', 1.0 / 6.0),
    ('⅚', 5.0 / 6.0),
    ('⅐', 1.0 / 7.0),
    ('⅑', 1.0 / 9.0),
    ('⅒', 1.0 / 10.0),
];

/// What is typed: its units, and words for errors.
struct Kind {
    units: &'static [Unit],
    /// Characters that are units.
    marks: &'static [(&'static [char], Is, f64)],
    /// The size of a number without a unit.
    unit: f64,
    /// Whether `6-1/2` alone may mean six and a half.
    may_join: bool,
    /// 'length'.
    name: &'static str,
    /// What two of them multiplied are.
    square: &'static str,
    /// What is understood.
    examples: &'static str,
}

/// A typed length in metres; `unit_m` is the size of a number without a unit, `may_join` whether `6-1/2` alone may
/// mean six and a half.
pub(super) fn length_m(text: &str, unit_m: f64, may_join: bool) -> Result<f64, NotUnderstood> {
    let kind = Kind {
        units: LENGTHS,
        marks: &[(FEET_MARKS, Is::Feet, METRES_PER_FOOT), (INCH_MARKS, Is::Inches, METRES_PER_INCH)],
        unit: unit_m,
        may_join,
        name: "length",
        square: "is an area",
        examples: "a length is a number, with m, cm, mm, ft or in if need be, such as 3.25, 325 cm, 10' 8 1/2\" or 3.2 + 0.4",
    };
    kind.read(text)
}

/// An angle that somebody typed, in degrees: `45`, `45°`, `22,5 deg`, `0.5 rad`, and sums of them with + - * / and
/// parentheses.
///
/// # Errors
/// What is not understood, and what would be.
pub fn parse_angle_deg(text: &str) -> Result<f64, NotUnderstood> {
    let kind = Kind {
        units: ANGLES,
        marks: &[(DEGREE_MARKS, Is::Other, 1.0)],
        unit: 1.0,
        may_join: false,
        name: "angle",
        square: "is no angle",
        examples: "an angle is a number of degrees, such as 45, 22.5° or 90/4, or of radians with rad",
    };
    kind.read(text)
}

/// The same in radians.
///
/// # Errors
/// As [`parse_angle_deg`].
pub fn parse_angle_rad(text: &str) -> Result<f64, NotUnderstood> {
    parse_angle_deg(text).map(f64::to_radians)
}

/// A number that somebody typed, without a unit: `1.5`, `1,5`, `3/4`, and sums.
///
/// # Errors
/// What is not understood, and what would be.
pub fn parse_number(text: &str) -> Result<f64, NotUnderstood> {
    let examples = "a number is such as 2, 1.5 or 3/4";
    plain(&[], examples).read(text)
}

/// A share or a factor that somebody typed: `0.25`, `1/4`, `25 %`.
///
/// # Errors
/// What is not understood, and what would be.
pub fn parse_ratio(text: &str) -> Result<f64, NotUnderstood> {
    let examples = "this takes a number, such as 0.25, 1/4 or 25 %";
    plain(&[(&['%'], Is::Other, 0.01)], examples).read(text)
}

/// A number of percent that somebody typed: `40`, `40 %`.
///
/// # Errors
/// What is not understood, and what would be.
pub fn parse_percent(text: &str) -> Result<f64, NotUnderstood> {
    let examples = "this takes a number of percent, such as 40 or 12.5 %";
    plain(&[(&['%'], Is::Other, 1.0)], examples).read(text)
}

const fn plain(marks: &'static [(&'static [char], Is, f64)], examples: &'static str) -> Kind {
    Kind { units: &[], marks, unit: 1.0, may_join: false, name: "share", square: "is no share", examples }
}

/// A value on the way.
#[derive(Clone, Copy)]
enum Value {
    /// A number without a unit: a factor, or in the end a length.
    Number(f64),
    /// With a unit, in metres, degrees or parts of one.
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

    /// Takes one of some characters behind blanks.
    fn take(&mut self, wanted: &[char]) -> Option<char> {
        let rest = self.rest.trim_start();
        let first = rest.chars().next().filter(|first| wanted.contains(first))?;
        self.rest = &rest[first.len_utf8()..];
        Some(first)
    }

    /// What stands where something else should.
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
        loop {
            let sign = match self.take(MINUS) {
                Some(_) => -1.0,
                None if self.take(&['+']).is_some() => 1.0,
                None => return Ok(value),
            };
            let other = self.product()?;
            value = match (value, other) {
                (Value::Number(a), Value::Number(b)) => Value::Number(a + sign * b),
                (a, b) => Value::Quantity(self.kind.quantity(a) + sign * self.kind.quantity(b)),
            };
        }
    }

    fn product(&mut self) -> Result<Value, NotUnderstood> {
        let mut value = self.signed()?;
        let name = self.kind.name;
        while let Some(sign) = self.take(&['*', '×', '·', '/', '⁄', '∕', '÷', ':']) {
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
        let value = if self.take(&['(']).is_some() {
            let value = self.sum()?;
            if self.take(&[')']).is_none() {
                let is_open = self.rest.trim_start().is_empty();
                return Err(if is_open { self.kind.not("a ')' is missing") } else { self.unexpected() });
            }
            value
        } else if self.take(&['+']).is_some() {
            self.signed()?
        } else if self.take(MINUS).is_some() {
            match self.signed()? {
                Value::Number(number) => Value::Number(-number),
                Value::Quantity(quantity) => Value::Quantity(-quantity),
            }
        } else {
            self.quantity()?
        };
        self.depth -= 1;
        Ok(value)
    }

    /// A number with a unit or without, or feet and inches.
    fn quantity(&mut self) -> Result<Value, NotUnderstood> {
        self.skip_blanks();
        let number = self.number(false)?;
        let Some((is, size)) = self.unit()? else { return Ok(Value::Number(number)) };
        let feet_m = number * size;
        let Some((rest, must_be_inches)) = (is == Is::Feet).then(|| behind_feet(self.rest)).flatten() else {
            return Ok(Value::Quantity(feet_m));
        };
        let before = std::mem::replace(&mut self.rest, rest);
        let inches = self.number(true)?;
        match self.unit()? {
            Some((Is::Inches, size)) => Ok(Value::Quantity(feet_m + inches * size)),
            None if !must_be_inches => Ok(Value::Quantity(feet_m + inches * METRES_PER_INCH)),
            // Two lengths side by side.
            _ => {
                self.rest = before;
                Ok(Value::Quantity(feet_m))
            }
        }
    }

    /// `3.25`, `3,25`, `8 1/2`, `8½`; `8-1/2` and `1/2` as parts of an inch or a foot, which they are behind feet
    /// (`is_inches`) or where such a unit follows.
    fn number(&mut self, is_inches: bool) -> Result<f64, NotUnderstood> {
        if let Some((part, rest)) = sign_of_fraction(self.rest) {
            self.rest = rest;
            return Ok(part);
        }
        let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
        let end = self.rest.find(|c: char| !is_part(c)).unwrap_or(self.rest.len());
        let word = &self.rest[..end];
        let marks = word.chars().filter(|c| !c.is_ascii_digit()).count();
        let value = word.replace(',', ".").parse::<f64>().ok().filter(|_| marks <= 1 && marks < word.len());
        let Some(value) = value else { return Err(self.unexpected()) };
        let from = self.rest;
        self.rest = &from[end..];
        if marks > 0 {
            return Ok(value);
        }
        // A whole number and a fraction.
        let is_apart = self.rest.starts_with(char::is_whitespace);
        if let Some((part, rest)) = sign_of_fraction(self.rest.trim_start())
            .or_else(|| if is_apart { fraction(self.rest.trim_start()) } else { None })
        {
            self.rest = rest;
            return Ok(value + part);
        }
        if let Some(joined) = self.rest.strip_prefix(HYPHENS)
            && let Some((part, rest)) = fraction(joined)
        {
            match (is_inches, self.unit_behind(rest)) {
                (true, _) | (false, Some(Is::Feet | Is::Inches)) => {
                    self.rest = rest;
                    return Ok(value + part);
                }
                (false, None) if self.kind.may_join => {
                    let typed = &from[..from.len() - rest.len()];
                    let part = &joined[..joined.len() - rest.len()];
                    let what =
                        format_args!("'{typed}' can be read in two ways: type '{value} {part}' or '{value} - {part}'");
                    return Err(self.kind.not(what));
                }
                _ => {}
            }
        }
        // A fraction alone is one only with a unit behind it: 1/2", but 7/2 and 10'/2 divide.
        if let Some((part, rest)) = fraction_of(value, self.rest)
            && (is_inches || self.unit_behind(rest).is_some())
        {
            self.rest = rest;
            return Ok(part);
        }
        Ok(value)
    }

    /// What a unit at the start of a text is.
    fn unit_behind(&self, rest: &'a str) -> Option<Is> {
        Reader { kind: self.kind, rest, depth: 0 }.unit().ok().flatten().map(|(is, _)| is)
    }

    /// A unit, behind blanks.
    fn unit(&mut self) -> Result<Option<(Is, f64)>, NotUnderstood> {
        let rest = self.rest.trim_start();
        let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
        let word = rest[..end].to_lowercase();
        if let Some(&(_, is, size)) = self.kind.units.iter().find(|(words, ..)| words.contains(&word.as_str())) {
            self.rest = &rest[end..];
            // The full stop of an abbreviation: 'ft.'
            if let Some(behind) = self.rest.strip_prefix('.') {
                if behind.starts_with(|c: char| c.is_ascii_digit()) {
                    return Err(self.unexpected());
                }
                self.rest = behind;
            }
            return Ok(Some((is, size)));
        }
        let mut letters = rest.chars();
        let Some(first) = letters.next() else { return Ok(None) };
        let Some(&(_, is, size)) = self.kind.marks.iter().find(|(marks, ..)| marks.contains(&first)) else {
            return Ok(None);
        };
        self.rest = letters.as_str();
        if is == Is::Feet && self.rest.starts_with(FEET_MARKS) {
            letters.next();
            self.rest = letters.as_str();
            return Ok(Some((Is::Inches, METRES_PER_INCH)));
        }
        Ok(Some((is, size)))
    }
}

/// The inches behind feet: after blanks, nothing, or a hyphen without blanks about it; and whether they must have
/// their unit, as behind 'and' and a comma.
fn behind_feet(rest: &str) -> Option<(&str, bool)> {
    let begins =
        |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || c == '.') || sign_of_fraction(text).is_some();
    let near = rest.trim_start();
    if begins(near) {
        return Some((near, false));
    }
    if let Some(joined) = rest.strip_prefix(HYPHENS).filter(|joined| begins(joined)) {
        return Some((joined, false));
    }
    let listed = near
        .strip_prefix(',')
        .or_else(|| near.get(..3).filter(|word| word.eq_ignore_ascii_case("and")).map(|_| &near[3..]))?;
    let inches = listed.trim_start();
    (listed.len() > inches.len() && begins(inches)).then_some((inches, true))
}

/// `1/2` or `½` at the start of a text, and what follows.
fn fraction(text: &str) -> Option<(f64, &str)> {
    if let Some(found) = sign_of_fraction(text) {
        return Some(found);
    }
    let (part, rest) = whole(text)?;
    fraction_of(part, rest)
}

/// `½` at the start of a text, and what follows.
fn sign_of_fraction(text: &str) -> Option<(f64, &str)> {
    let mut letters = text.chars();
    let first = letters.next()?;
    let &(_, part) = FRACTIONS.iter().find(|(sign, _)| *sign == first)?;
    Some((part, letters.as_str()))
}

/// `/2` behind a whole number, and what follows.
fn fraction_of(part: f64, rest: &str) -> Option<(f64, &str)> {
    let (of, rest) = whole(rest.strip_prefix(SLASHES)?)?;
    (of > 0.0 && !rest.starts_with(['.', ','])).then(|| (part / of, rest))
}

/// A whole number at the start of a text, and what follows.
fn whole(text: &str) -> Option<(f64, &str)> {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    Some((text[..end].parse().ok()?, &text[end..]))
}
