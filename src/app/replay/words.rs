//! The words of a line, separated by spaces; in quotes if they contain spaces.

use crate::base::wording::shortened;

/// A word of a line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Word {
    pub text: String,
    /// If so, it is never a keyword.
    pub is_quoted: bool,
}

/// Splits a line. `#` at the start of a word begins a comment. In quotes, `\"`, `\\`, `\n`, `\t` and
/// `\u{…}` are escapes.
///
/// # Errors
/// When quotes are not closed or an escape is invalid; the message says so.
pub(super) fn split(line: &str) -> Result<Vec<Word>, String> {
    let mut words = Vec::new();
    let mut letters = line.chars().peekable();
    loop {
        while letters.next_if(|letter| letter.is_whitespace()).is_some() {}
        match letters.peek() {
            None | Some('#') => return Ok(words),
            Some('"') => {
                letters.next();
                words.push(Word { text: quoted(&mut letters)?, is_quoted: true });
                if letters.peek().is_some_and(|letter| !letter.is_whitespace()) {
                    return Err("a blank is missing behind a closing quote".to_owned());
                }
            }
            Some(_) => {
                let mut text = String::new();
                while let Some(letter) = letters.next_if(|letter| !letter.is_whitespace()) {
                    text.push(letter);
                }
                words.push(Word { text, is_quoted: false });
            }
        }
    }
}

fn quoted(letters: &mut impl Iterator<Item = char>) -> Result<String, String> {
    let mut text = String::new();
    loop {
        match letters.next() {
            None => return Err("a quote is not closed".to_owned()),
            Some('"') => return Ok(text),
            Some('\\') => text.push(match letters.next() {
                Some('n') => '\n',
                Some('t') => '\t',
                Some('u') => by_number(letters)?,
                Some(letter @ ('"' | '\\')) => letter,
                Some(letter) => return Err(format!("\\{letter} means nothing; write \\\\ for a backslash")),
                None => return Err("a quote is not closed".to_owned()),
            }),
            Some(letter) => text.push(letter),
        }
    }
}

/// The character given by its code point in braces, as in `\u{e9}`.
fn by_number(letters: &mut impl Iterator<Item = char>) -> Result<char, String> {
    let wrong = || "\\u means the character of a number in braces, as in \\u{e9}".to_owned();
    if letters.next() != Some('{') {
        return Err(wrong());
    }
    let digits: String = letters.take_while(|letter| *letter != '}').take(7).collect();
    u32::from_str_radix(&digits, 16).ok().and_then(char::from_u32).ok_or_else(wrong)
}

/// A text as a word of a script: unquoted if that reads back the same, otherwise in quotes.
pub(super) fn written(text: &str) -> String {
    let is_plain = |letter: char| letter.is_alphanumeric() || "_-./:+".contains(letter);
    if !text.is_empty() && text.chars().all(is_plain) { text.to_owned() } else { in_quotes(text) }
}

/// A text in quotes, as scripts write names and typed text.
pub(super) fn in_quotes(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            letter if letter.is_control() => quoted.push_str(&format!("\\u{{{:x}}}", u32::from(letter))),
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

/// A word as from [`written`], short enough for a message.
pub(super) fn told(text: &str) -> String {
    const MOST: usize = 60;
    written(&shortened(text, MOST))
}

/// The most similar of some words, if any is similar enough.
pub(super) fn nearest<'a>(wrong: &str, words: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // By experiment: below this the guess is more often wrong than right.
    const ALIKE: f64 = 0.75;
    words
        .into_iter()
        .map(|word| (strsim::jaro_winkler(wrong, word), word))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|p, q| p.0.total_cmp(&q.0).then(q.1.cmp(p.1)))
        .map(|(_, word)| word)
}

/// A hint with the most similar of some words; empty if none is similar enough.
pub(super) fn did_you_mean<'a>(wrong: &str, words: impl IntoIterator<Item = &'a str>) -> String {
    nearest(wrong, words).map(|word| format!("did you mean {}?", written(word))).unwrap_or_default()
}

/// The remaining words of a line during parsing.
pub(super) struct Words<'a> {
    rest: &'a [Word],
}

impl<'a> Words<'a> {
    pub(super) fn new(words: &'a [Word]) -> Self {
        Self { rest: words }
    }

    /// Takes the next word.
    pub(super) fn next(&mut self) -> Option<&'a Word> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(first)
    }

    /// Takes the next word if it equals this one.
    pub(super) fn keyword(&mut self, word: &str) -> bool {
        let is_next = self.rest.first().is_some_and(|next| !next.is_quoted && next.text == word);
        if is_next {
            self.rest = &self.rest[1..];
        }
        is_next
    }

    /// The next word, without taking it; `None` if it is quoted.
    pub(super) fn peek(&self) -> Option<&'a str> {
        self.rest.first().filter(|word| !word.is_quoted).map(|word| word.text.as_str())
    }

    /// Whether all words have been taken.
    pub(super) fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// A required word; `what` describes it.
    ///
    /// # Errors
    /// When it is missing.
    pub(super) fn text(&mut self, what: &str) -> Result<&'a str, String> {
        self.next().map(|word| word.text.as_str()).ok_or_else(|| format!("{what} is missing"))
    }

    /// All remaining words, as texts.
    pub(super) fn all(&mut self) -> Vec<String> {
        std::mem::take(&mut self.rest).iter().map(|word| word.text.clone()).collect()
    }

    /// A number from `least` to `most`.
    ///
    /// # Errors
    /// When there is none.
    pub(super) fn number(&mut self, what: &str, least: f64, most: f64) -> Result<f64, String> {
        number(self.text(what)?, what, least, most)
    }

    /// A count.
    ///
    /// # Errors
    /// When there is none.
    pub(super) fn count(&mut self, what: &str) -> Result<usize, String> {
        let text = self.text(what)?;
        text.parse().map_err(|_| format!("{what} is a whole number, not {}", written(text)))
    }

    /// Two numbers with a comma between them.
    ///
    /// # Errors
    /// When there are none.
    pub(super) fn pair(&mut self, what: &str) -> Result<(f64, f64), String> {
        let text = self.text(what)?;
        let Some((x, y)) = text.split_once(',') else {
            return Err(format!("{what} is two numbers like 3.2,4.5, not {}", written(text)));
        };
        Ok((number(x, what, -FAR, FAR)?, number(y, what, -FAR, FAR)?))
    }
}

/// No coordinate of a script is larger: more than any plan or screen.
const FAR: f64 = 1e7;

/// A number from `least` to `most`.
///
/// # Errors
/// When it is not one.
pub(super) fn number(text: &str, what: &str, least: f64, most: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (least..=most).contains(&number) => Ok(number),
        Ok(_) => Err(format!("{what} is from {least} to {most}, not {text}")),
        Err(_) => Err(format!("{what} is a number, not {}", written(text))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(line: &str) -> Vec<String> {
        split(line).expect("the line is well formed").into_iter().map(|word| word.text).collect()
    }

    #[test]
    fn lines_split_into_words() {
        assert_eq!(texts("  click room \"Room 3\"  # the big one"), ["click", "room", "Room 3"]);
        assert_eq!(texts(r#"type "a \"b\" \\ \n" c#d"#), ["type", "a \"b\" \\ \n", "c#d"]);
        assert_eq!(texts("# all of it"), [""; 0]);
        for wrong in ["type \"a", "type \"a\\", "type \"a\\q\"", "type \"a\"b"] {
            assert!(split(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn the_nearest_word_is_found() {
        assert_eq!(nearest("clik", ["click", "drag"]), Some("click"));
        assert_eq!(nearest("zzz", ["click", "drag"]), None);
    }

    proptest! {
        #[test]
        fn written_words_read_back(text in "\\PC{0,12}", other in any::<String>()) {
            prop_assert_eq!(texts(&format!("{} {}", written(&text), in_quotes(&other))), [text, other]);
        }
    }
}
