//! The names of rooms and openings wherever they appear: a title for people ([`room_title`]), a name with
//! its id for reports ([`RoomName`]), a unique key within a plan for datasets ([`room_keys`]).

use std::collections::BTreeMap;
use std::fmt;

use crate::base::natural_order::NaturalKey;
use crate::base::wording::sentence;
use crate::labels::function_title;
use crate::plan::{ElementId, Opening, OpeningId, OpeningKind, Plan, Room, RoomId};

/// Longer names are cut in reports, so that a line fits a terminal.
const LONGEST_NAME: usize = 40;

/// Longer source ids (UUIDs, not words) are cut to [`SHORT_ID`] characters: enough to find them.
const LONGEST_ID: usize = 13;

const SHORT_ID: usize = 8;

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
    keys.sort_by_cached_key(|(id, key)| (NaturalKey::of(key), *id));
    keys
}

/// A room as named in reports: its function, its name, and the id to find it by (the source's, if it has
/// one).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RoomName {
    pub id: RoomId,
    pub source_id: String,
    pub name: String,
    pub function: String,
}

impl RoomName {
    pub fn new(id: RoomId, room: &Room) -> Self {
        Self { id, source_id: room.source_id.clone(), name: room.name.clone(), function: room.function.clone() }
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
        // Some sources have no id other than the name.
        if self.source_id.is_empty() || self.source_id != self.name {
            write!(f, " {}", short_id(&self.source_id, &self.id))?;
        }
        Ok(())
    }
}

/// An opening as named in reports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OpeningName {
    pub id: OpeningId,
    pub source_id: String,
    pub kind: OpeningKind,
}

impl OpeningName {
    pub fn new(id: OpeningId, opening: &Opening) -> Self {
        Self { id, source_id: opening.source_id.clone(), kind: opening.kind }
    }
}

impl fmt::Display for OpeningName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.kind.name(), short_id(&self.source_id, &self.id))
    }
}

fn short_id(source_id: &str, id: &dyn fmt::Display) -> String {
    let source_id = printable(source_id);
    if source_id.is_empty() {
        id.to_string()
    } else if source_id.chars().count() > LONGEST_ID && !source_id.contains(char::is_whitespace) {
        source_id.chars().take(SHORT_ID).chain(['…']).collect()
    } else {
        source_id
    }
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
