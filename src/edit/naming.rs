//! Bulk changes to rooms: names from a pattern, and selecting rooms by their properties.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::labels::{Label, normalised_function};
use crate::plan::{Meta, Plan, Room, RoomId};

/// A name pattern, such as `{function} {n}`.
///
/// | part | replaced by |
/// | --- | --- |
/// | `{n}`, `{nn}`, `{nnn}` | the room's number, zero-padded to as many digits as letters |
/// | `{function}` | what the room is for, capitalised; 'Room' if unknown |
/// | `{label}`, `{letter}` | its label in words ('Big room'), or its letter ('B'); 'Room' or 'R' if it has none |
/// | `{storey}`, `{building}` | those of the plan |
/// | `{{`, `}}` | a brace |
///
/// Rooms whose names are otherwise the same are numbered: `{function} {n}` gives 'Office 1', 'Office 2',
/// 'Kitchen 1', and `{storey}.{nn}` numbers all rooms in sequence.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern(Vec<Part>);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Text(String),
    /// Minimum number of digits.
    Number(usize),
    Function,
    Label,
    Letter,
    Storey,
    Building,
}

/// The parts of a pattern as written, each with its meaning.
pub const PARTS: [(&str, &str); 7] = [
    ("{n}", "the room's number"),
    ("{nn}", "the room's number with two digits"),
    ("{function}", "what the room is for"),
    ("{label}", "its label"),
    ("{letter}", "its label's letter"),
    ("{storey}", "the plan's storey"),
    ("{building}", "the plan's building"),
];

/// Why a pattern is invalid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PatternError(String);

impl fmt::Display for PatternError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for PatternError {}

/// The longest name, in letters: it has to fit in a room.
const LONGEST_NAME: usize = 200;

/// The most digits of a number.
const MOST_DIGITS: usize = 6;

impl std::str::FromStr for Pattern {
    type Err = PatternError;

    fn from_str(text: &str) -> Result<Self, PatternError> {
        if text.trim().is_empty() {
            return Err(PatternError("write a pattern, such as {function} {n}".to_owned()));
        }
        let mut parts = Vec::new();
        let mut plain = String::new();
        let mut letters = text.trim().chars().peekable();
        while let Some(letter) = letters.next() {
            match letter {
                '{' if letters.next_if_eq(&'{').is_some() => plain.push('{'),
                '}' if letters.next_if_eq(&'}').is_some() => plain.push('}'),
                '{' => {
                    let word: String = letters.by_ref().take_while(|&letter| letter != '}').collect();
                    if !plain.is_empty() {
                        parts.push(Part::Text(std::mem::take(&mut plain)));
                    }
                    parts.push(Part::of_word(&word)?);
                }
                '}' => return Err(PatternError("a } stands alone; write }} for a brace".to_owned())),
                _ => plain.push(letter),
            }
        }
        if !plain.is_empty() {
            parts.push(Part::Text(plain));
        }
        Ok(Self(parts))
    }
}

impl Part {
    fn of_word(word: &str) -> Result<Self, PatternError> {
        Ok(match word {
            "function" => Self::Function,
            "label" => Self::Label,
            "letter" => Self::Letter,
            "storey" => Self::Storey,
            "building" => Self::Building,
            _ if (1..=MOST_DIGITS).contains(&word.len()) && word.bytes().all(|letter| letter == b'n') => {
                Self::Number(word.len())
            }
            _ => {
                let known: Vec<&str> = PARTS.iter().map(|(part, _)| *part).collect();
                return Err(PatternError(format!("{{{word}}} is not known; there are {}", known.join(", "))));
            }
        })
    }
}

impl Pattern {
    /// Whether it has a number.
    pub fn has_number(&self) -> bool {
        self.0.iter().any(|part| matches!(part, Part::Number(_)))
    }

    /// The text before, between and after the numbers for a room.
    fn filled(&self, meta: &Meta, room: &Room, label: Option<Label>) -> Vec<Result<String, usize>> {
        let text = |part: &Part| match part {
            Part::Text(text) => Ok(text.clone()),
            Part::Number(digits) => Err(*digits),
            Part::Function => {
                let function = normalised_function(&room.function);
                Ok(if function.is_empty() { "Room".to_owned() } else { capital(&function) })
            }
            Part::Label => Ok(label.map_or("Room".to_owned(), |label| capital(label.name()))),
            Part::Letter => Ok(label.map_or("R", Label::letter).to_owned()),
            Part::Storey => Ok(meta.storey.trim().to_owned()),
            Part::Building => Ok(meta.building.trim().to_owned()),
        };
        self.0.iter().map(text).collect()
    }

    /// The names for rooms, numbered in order from `start`. A name already used by a room outside of
    /// these is skipped if the pattern has a number.
    ///
    /// # Errors
    /// When the pattern uses the plan's storey or building and the plan has none, or a name would be too
    /// long.
    pub fn names(
        &self,
        plan: &Plan,
        rooms: &[RoomId],
        start: u32,
        label_of: impl Fn(RoomId, &Room) -> Option<Label>,
    ) -> Result<Vec<(RoomId, String)>, PatternError> {
        let meta = plan.meta();
        for (part, text, what) in [(Part::Storey, &meta.storey, "storey"), (Part::Building, &meta.building, "building")]
        {
            if self.0.contains(&part) && text.trim().is_empty() {
                return Err(PatternError(format!("the plan has no {what}: leave {{{what}}} out")));
            }
        }
        let named: BTreeSet<RoomId> = rooms.iter().copied().collect();
        let mut taken: BTreeSet<String> = plan
            .rooms()
            .filter(|(id, _)| !named.contains(id))
            .map(|(_, room)| room.name.trim().to_lowercase())
            .collect();
        let mut next: BTreeMap<String, u32> = BTreeMap::new();
        let mut names = Vec::with_capacity(rooms.len());
        for &id in rooms {
            let Some(room) = plan.room(id) else { continue };
            let parts = self.filled(meta, room, label_of(id, room));
            let with = |number: u32| -> String {
                let part = |part: &Result<String, usize>| match part {
                    Ok(text) => text.clone(),
                    Err(digits) => format!("{number:0digits$}"),
                };
                parts.iter().map(part).collect::<String>().trim().to_owned()
            };
            let name = if self.has_number() {
                // A letter that no name contains stands for the number.
                let same: String = parts.iter().map(|part| part.as_deref().unwrap_or("\0")).collect();
                let number = next.entry(same.to_lowercase()).or_insert(start);
                while taken.contains(&with(*number).to_lowercase()) && *number < u32::MAX {
                    *number += 1;
                }
                let name = with(*number);
                *number = number.saturating_add(1);
                name
            } else {
                with(start)
            };
            if name.chars().count() > LONGEST_NAME {
                return Err(PatternError(format!("a name would be longer than {LONGEST_NAME} letters")));
            }
            taken.insert(name.to_lowercase());
            names.push((id, name));
        }
        Ok(names)
    }
}

/// Capitalises the first letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::edit::naming::*;
    use crate::geometry::Point;
    use crate::plan::Builder;

    fn plan(rooms: &[(&str, &str)]) -> (Plan, Vec<RoomId>) {
        let mut builder = Builder::new(Meta { storey: "2".to_owned(), ..Meta::default() });
        let mut ids = Vec::new();
        for (index, (name, function)) in rooms.iter().enumerate() {
            let x = index as f64 * 4.0;
            let outer = builder.ring([(x, 0.0), (x + 3.0, 0.0), (x + 3.0, 3.0)].map(|(x, y)| Point::new(x, y)));
            let room = Room { outer, name: (*name).to_owned(), function: (*function).to_owned(), ..Room::default() };
            ids.push(builder.room(&index.to_string(), room));
        }
        (builder.finish().unwrap(), ids)
    }

    fn names(pattern: &str, plan: &Plan, rooms: &[RoomId], start: u32) -> Result<Vec<String>, String> {
        let pattern: Pattern = pattern.parse().map_err(|error: PatternError| error.to_string())?;
        let label = |_: RoomId, room: &Room| (!room.function.is_empty()).then_some(Label::BigRoom);
        let names = pattern.names(plan, rooms, start, label).map_err(|error| error.to_string())?;
        Ok(names.into_iter().map(|(_, name)| name).collect())
    }

    #[test]
    fn rooms_of_the_same_name_are_counted() {
        let (plan, rooms) = plan(&[("", "office"), ("", "MEETING_ROOM"), ("", "Office"), ("", "")]);
        let named = |pattern: &str, start: u32| names(pattern, &plan, &rooms, start).unwrap();
        assert_eq!(named("{function} {n}", 1), ["Office 1", "Meeting room 1", "Office 2", "Room 1"]);
        assert_eq!(named("{storey}.{nn}", 9), ["2.09", "2.10", "2.11", "2.12"]);
        assert_eq!(named("{letter}{n}", 1), ["B1", "B2", "B3", "R1"]);
        assert_eq!(named("{label}", 1), ["Big room", "Big room", "Big room", "Room"]);
        assert_eq!(named("{{{n}}}", 3), ["{3}", "{4}", "{5}", "{6}"]);
    }

    #[test]
    fn names_of_others_are_passed_over() {
        let (plan, rooms) = plan(&[("Office 2", "office"), ("", "office"), ("old", "office")]);
        assert_eq!(names("{function} {n}", &plan, &rooms[1..], 1).unwrap(), ["Office 1", "Office 3"]);
        // The rooms' own old names are free to reuse.
        assert_eq!(names("{function} {n}", &plan, &rooms, 1).unwrap(), ["Office 1", "Office 2", "Office 3"]);
    }

    #[test]
    fn what_is_wrong_with_a_pattern_is_told() {
        let (plan, rooms) = plan(&[("", "office")]);
        for (pattern, word) in [
            ("  ", "write a pattern"),
            ("{room} {n}", "{room} is not known"),
            ("{n", "no"),
            ("{nnnnnnn}", "not known"),
            ("a } b", "stands alone"),
            ("{building} {n}", "no building"),
        ] {
            match names(pattern, &plan, &rooms, 1) {
                Err(error) => assert!(error.contains(word), "{pattern:?} gave {error:?}"),
                // An open brace at the end closes itself.
                Ok(names) => assert_eq!((pattern, names.concat().as_str()), ("{n", "1")),
            }
        }
    }
}
