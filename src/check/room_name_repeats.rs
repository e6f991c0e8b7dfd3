use std::collections::BTreeMap;

use super::{Check, Context, Kind, Place, Severity};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;
use crate::plan::titles::{first_of, printable};

/// Several rooms of the same function with the same name: a room's number should identify one room.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomNameRepeats {
    pub name: String,
    /// At least two, by id.
    pub rooms: Vec<RoomName>,
}

impl Check for RoomNameRepeats {
    const KIND: Kind = Kind {
        name: "room_name_repeats",
        title: "Rooms have the same name",
        severity: Severity::Info,
        remedy: "give each its own name or number",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut by_name: BTreeMap<&str, Vec<RoomName>> = BTreeMap::new();
        for (id, room) in context.plan.rooms() {
            let name = room.name.trim();
            // Names without a digit describe a kind of room ('Office', 'WC') rather than identify one.
            if name.chars().any(char::is_numeric) {
                by_name.entry(name).or_default().push(context.name_of_room(id, room));
            }
        }
        by_name
            .into_iter()
            .filter(|(_, rooms)| rooms.len() > 1)
            .map(|(name, rooms)| Self { name: name.to_owned(), rooms })
            .collect()
    }

    fn size(&self) -> f64 {
        self.rooms.len() as f64
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: self.rooms.iter().map(|room| ElementId::Room(room.id)).collect(),
            rooms: self.rooms.iter().collect(),
            at: None,
        }
    }

    fn what(&self) -> String {
        format!("'{}' names {} rooms: {}", printable(&self.name), self.rooms.len(), first_of(&self.rooms))
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("rooms", self.rooms.len() as f64)]
    }
}
