//! The options of a format: each has a name, a type, a default and a line of help, and is read from
//! `NAME=VALUE`. Help texts and the manual list them from here.

use std::collections::BTreeMap;
use std::fmt;

/// Yes or no.
#[derive(Debug)]
pub struct Switch {
    /// Lower case with hyphens: `rooms-only`.
    pub name: &'static str,
    pub default: bool,
    /// A sentence without its full stop.
    pub help: &'static str,
}

/// A number within limits.
#[derive(Debug)]
pub struct Number {
    pub name: &'static str,
    /// `None`: as the file says.
    pub default: Option<f64>,
    pub least: f64,
    pub most: f64,
    pub help: &'static str,
}

/// One word of a list, which is not empty; the first is the default.
#[derive(Debug)]
pub struct Choice {
    pub name: &'static str,
    pub words: &'static [&'static str],
    pub help: &'static str,
}

/// An option of any type, as formats list theirs.
#[derive(Clone, Copy, Debug)]
pub enum FormatOption {
    Switch(&'static Switch),
    Number(&'static Number),
    Choice(&'static Choice),
}

impl FormatOption {
    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Switch(option) => option.name,
            Self::Number(option) => option.name,
            Self::Choice(option) => option.name,
        }
    }

    /// What it does, a sentence without its full stop.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Switch(option) => option.help,
            Self::Number(option) => option.help,
            Self::Choice(option) => option.help,
        }
    }

    /// The values it takes, in words: 'yes or no'.
    pub fn values(self) -> String {
        match self {
            Self::Switch(_) => "yes or no".to_owned(),
            Self::Number(option) => format!("a number from {} to {}", option.least, option.most),
            Self::Choice(option) => option.words.join(", "),
        }
    }

    /// The default value, in words.
    pub fn default_in_words(self) -> String {
        match self {
            Self::Switch(option) => if option.default { "yes" } else { "no" }.to_owned(),
            Self::Number(option) => option.default.map_or_else(|| "as the file says".to_owned(), |it| it.to_string()),
            Self::Choice(option) => option.words.first().copied().unwrap_or_default().to_owned(),
        }
    }

    fn parse(self, text: &str) -> Result<Value, OptionError> {
        let text = text.trim();
        let value = match self {
            Self::Switch(_) => match text {
                "yes" | "true" | "on" => Some(Value::Switch(true)),
                "no" | "false" | "off" => Some(Value::Switch(false)),
                _ => None,
            },
            Self::Number(option) => {
                let number = crate::base::units::parse_number(text)
                    .ok()
                    .filter(|number| (option.least..=option.most).contains(number));
                number.map(Value::Number)
            }
            Self::Choice(option) => option.words.iter().find(|word| **word == text).map(|word| Value::Word(word)),
        };
        value.ok_or_else(|| OptionError(format!("'{}' cannot be '{text}'; use {}", self.name(), self.values())))
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Switch(bool),
    Number(f64),
    Word(&'static str),
}

/// The options that were set; all others have their defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options(BTreeMap<&'static str, Value>);

/// An unknown option or an invalid value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OptionError(String);

impl fmt::Display for OptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for OptionError {}

impl Options {
    /// Those of `pairs` (`NAME=VALUE`) that are among `known`; others belong to another format, see
    /// [`Options::check_names`]. If one is repeated, the last wins.
    ///
    /// # Errors
    /// When a pair has no '=', or a value is invalid.
    pub fn parse(known: &[FormatOption], pairs: &[String]) -> Result<Self, OptionError> {
        let mut options = Self::default();
        for pair in pairs {
            let (name, value) = split(pair)?;
            if let Some(option) = known.iter().find(|option| option.name() == name) {
                options.0.insert(option.name(), option.parse(value)?);
            }
        }
        Ok(options)
    }

    /// Checks that each of `pairs` names one of `known`.
    ///
    /// # Errors
    /// When one does not; the error lists the names there are.
    pub fn check_names(known: &[FormatOption], pairs: &[String]) -> Result<(), OptionError> {
        for pair in pairs {
            let (name, _) = split(pair)?;
            if !known.iter().any(|option| option.name() == name) {
                let names: Vec<&str> = known.iter().map(|option| option.name()).collect();
                let known = if names.is_empty() { "there are none here".to_owned() } else { names.join(", ") };
                return Err(OptionError(format!("there is no option '{name}'; known are: {known}")));
            }
        }
        Ok(())
    }

    /// Whether a switch is on.
    pub fn switch(&self, option: &Switch) -> bool {
        match self.0.get(option.name) {
            Some(&Value::Switch(on)) => on,
            _ => option.default,
        }
    }

    /// The value of a number; `None` if it is neither set nor has a default.
    pub fn number(&self, option: &Number) -> Option<f64> {
        match self.0.get(option.name) {
            Some(&Value::Number(number)) => Some(number),
            _ => option.default,
        }
    }

    /// The word of a choice.
    pub fn choice(&self, option: &Choice) -> &'static str {
        match self.0.get(option.name) {
            Some(&Value::Word(word)) => word,
            _ => option.words.first().copied().unwrap_or_default(),
        }
    }
}

fn split(pair: &str) -> Result<(&str, &str), OptionError> {
    let (name, value) =
        pair.split_once('=').ok_or_else(|| OptionError(format!("'{pair}' is no option; write NAME=VALUE")))?;
    Ok((name.trim(), value))
}

/// The option of formats whose lengths are pixels.
pub(super) static METRES_PER_PIXEL: Number = Number {
    name: "metres-per-pixel",
    default: None,
    least: 1e-4,
    most: 10.0,
    help: "The scale, where the file states none or a wrong one",
};

#[cfg(test)]
mod tests {
    use super::*;

    static BARE: Switch = Switch { name: "bare", default: false, help: "" };
    static SCALE: Number = Number { name: "scale", default: None, least: 0.5, most: 2.0, help: "" };
    static AXES: Choice = Choice { name: "axes", words: &["up", "down"], help: "" };
    const ALL: &[FormatOption] =
        &[FormatOption::Switch(&BARE), FormatOption::Number(&SCALE), FormatOption::Choice(&AXES)];

    fn parse(pairs: &[&str]) -> Result<Options, String> {
        let pairs: Vec<String> = pairs.iter().map(ToString::to_string).collect();
        Options::check_names(ALL, &pairs).and_then(|()| Options::parse(ALL, &pairs)).map_err(|error| error.to_string())
    }

    #[test]
    fn options_are_read_or_refused_in_words() {
        let options = parse(&["bare=yes", "scale=1", "axes=down", "scale = 1.5"]).unwrap_or_default();
        assert_eq!((options.switch(&BARE), options.number(&SCALE), options.choice(&AXES)), (true, Some(1.5), "down"));
        let none = Options::default();
        assert_eq!((none.switch(&BARE), none.number(&SCALE), none.choice(&AXES)), (false, None, "up"));
        for (pair, expected) in [
            ("bare", "'bare' is no option; write NAME=VALUE"),
            ("bare=maybe", "'bare' cannot be 'maybe'; use yes or no"),
            ("scale=NaN", "'scale' cannot be 'NaN'; use a number from 0.5 to 2"),
            ("scale=3", "'scale' cannot be '3'; use a number from 0.5 to 2"),
            ("axes=left", "'axes' cannot be 'left'; use up, down"),
            ("colour=red", "there is no option 'colour'; known are: bare, scale, axes"),
        ] {
            assert_eq!(parse(&[pair]), Err(expected.to_owned()));
        }
    }
}
