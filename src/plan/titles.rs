//! The names of rooms and openings wherever they appear: a title for people ([`room_title`]), a name
//! for reports ([`RoomName`]), a unique key within a plan for datasets ([`room_keys`]).

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use crate::base::natural_order;
use crate::base::wording::sentence;
use crate::labels::function_title;
use crate::plan::{ElementId, Opening, OpeningId, OpeningKind, Plan, Room, RoomId, WallId};

/// Longer names are cut in reports, so that a line fits a terminal.
const LONGEST_NAME: usize = 40;

/// Longer source ids are UUIDs, not words.
const LONGEST_ID: usize = 13;

/// The title of an element.
pub fn title_of(plan: &Plan, picked: ElementId) -> String {
    match picked {
        ElementId::Room(id) => plan.room(id).map_or_else(String::new, room_title),
        ElementId::Opening(id) => plan.opening(id).map_or_else(String::new, |opening| sentence(opening.kind.name())),
        ElementId::Wall(_) => "Wall".to_owned(),
        ElementId::Corner(_) => "Corner".to_owned(),
        ElementId::Dimension(_) => "Dimension".to_owned(),
    }
}

/// A room's name or, without one, its function.
pub fn room_title(room: &Room) -> String {
    if !room.name.is_empty() {
        room.name.clone()
    } else if !room.function.is_empty() {
        function_title(&room.function)
    } else {
        "Unnamed room".to_owned()
    }
}

/// A unique key for each room of a plan in a table: its name if no other room has it, else its source id,
/// else its id. Sorted so that 'Room 2' comes before 'Room 10'.
pub fn room_keys(plan: &Plan) -> Vec<(RoomId, String)> {
    let mut names: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, room) in plan.rooms() {
        *names.entry(room.name.as_str()).or_default() += 1;
    }
    let mut keys: Vec<(RoomId, String)> = plan
        .rooms()
        .map(|(id, room)| {
            let key = if !room.name.is_empty() && names.get(room.name.as_str()) == Some(&1) {
                room.name.clone()
            } else if room.source_id.is_empty() {
                id.to_string()
            } else {
                room.source_id.clone()
            };
            (id, key)
        })
        .collect();
    keys.sort_by(|(p, key), (q, other)| natural_order::compare(key, other).then(p.cmp(q)));
    keys
}

/// The numbers of the rooms without a name, from 1 in an order of all rooms; those that the order lacks come last. A
/// room whose name is 'Room 3' keeps the 3.
pub fn numbers_of_unnamed(plan: &Plan, order: &[RoomId]) -> BTreeMap<RoomId, usize> {
    let taken: BTreeSet<usize> =
        plan.rooms().filter_map(|(_, room)| room.name.trim().strip_prefix("Room ")?.parse().ok()).collect();
    let listed: BTreeSet<RoomId> = order.iter().copied().collect();
    let all = order.iter().copied().chain(plan.rooms().map(|(id, _)| id).filter(|id| !listed.contains(id)));
    let unnamed = all.filter(|&id| plan.room(id).is_some_and(|room| room.name.trim().is_empty()));
    unnamed.zip((1..).filter(|number| !taken.contains(number))).collect()
}

/// A room as named in reports, without what only a file knows it by: its function, its name, the short id of its source
/// or, without both, a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomName {
    pub id: RoomId,
    pub source_id: String,
    pub name: String,
    pub function: String,
    /// Its number among the rooms without a name.
    pub number: Option<usize>,
}

impl RoomName {
    pub fn new(id: RoomId, room: &Room, number: Option<usize>) -> Self {
        let [source_id, name, function] = [&room.source_id, &room.name, &room.function].map(String::clone);
        Self { id, source_id, name, function, number }
    }
}

impl fmt::Display for RoomName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let function = printable(&self.function);
        f.write_str(if function.is_empty() { "room" } else { &function })?;
        let name = printable(&self.name);
        if !name.is_empty() {
            write!(f, " '{name}'")?;
        }
        match (source_word(&self.source_id), self.number) {
            // Some sources have no id other than the name.
            (Some(word), _) if word != name => write!(f, " {word}"),
            (None, Some(number)) if name.is_empty() => write!(f, " {number}"),
            _ => Ok(()),
        }
    }
}

/// A wall as named in reports: by the rooms that it bounds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WallName {
    pub id: WallId,
    /// The rooms on its sides, one if it is the same on both; none where both are outside.
    pub rooms: Vec<RoomName>,
    /// Whether one side is outside.
    pub is_outer: bool,
}

impl fmt::Display for WallName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.rooms.as_slice(), self.is_outer) {
            ([one, other, ..], _) => write!(f, "the wall between {one} and {other}"),
            ([one], true) => write!(f, "the outer wall of {one}"),
            ([one], false) => write!(f, "a wall in {one}"),
            ([], _) => f.write_str("a wall outside all rooms"),
        }
    }
}

/// An opening as named in reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpeningName {
    pub id: OpeningId,
    pub source_id: String,
    pub kind: OpeningKind,
    /// The rooms on its sides, one if it is the same on both, or if the other side is outside.
    pub rooms: Vec<RoomName>,
}

impl OpeningName {
    pub fn new(id: OpeningId, opening: &Opening, rooms: Vec<RoomName>) -> Self {
        Self { id, source_id: opening.source_id.clone(), kind: opening.kind, rooms }
    }
}

impl fmt::Display for OpeningName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = self.kind.name();
        match (source_word(&self.source_id), self.rooms.as_slice()) {
            (Some(word), _) => write!(f, "{kind} {word}"),
            (None, [one, other, ..]) => write!(f, "the {kind} between {one} and {other}"),
            (None, [one]) => write!(f, "the {kind} of {one}"),
            (None, []) => write!(f, "a {kind}"),
        }
    }
}

/// The id of a source that a person may know: a short word, no UUID.
fn source_word(source_id: &str) -> Option<String> {
    let word = printable(source_id);
    let is_word = word.chars().count() <= LONGEST_ID || word.contains(char::is_whitespace);
    (is_word && !word.is_empty()).then_some(word)
}

/// A text from a file as one short line, without characters that move a terminal's cursor or are
/// invisible.
pub fn printable(text: &str) -> String {
    let clean: String = text.trim().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if clean.chars().count() <= LONGEST_NAME {
        return clean;
    }
    clean.chars().take(LONGEST_NAME - 1).chain(['…']).collect()
}

/// The first few of a list, and how many more there are: 'a, b, c and 4 more'.
pub fn first_of<T: fmt::Display>(names: &[T]) -> String {
    /// Nobody reads more.
    const SHOWN: usize = 3;
    let mut text = names.iter().take(SHOWN).map(T::to_string).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        text.push_str(&format!(" and {} more", names.len() - SHOWN));
    }
    text
}

/// 'a school', 'an office'.
pub fn with_article(noun: &str) -> String {
    let vowel = noun.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {noun}", if vowel { "an" } else { "a" })
}
