use std::collections::BTreeMap;

use super::{Check, Context, Kind, Place, Severity};
use crate::labels::normalised_function;
use crate::plan::titles::RoomName;
use crate::plan::titles::first_of;
use crate::plan::{ElementId, Joint};

/// Rooms connected to each other, but not to the outside, an entrance, stairs, or the rest of the storey.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsAreCutOff {
    /// The rooms, by id; at least two.
    pub rooms: Vec<RoomName>,
}

/// Functions of rooms through which people arrive from outside or from another storey, as named in the
/// bundled schemes. Many plans draw the entrance, but not its door.
const WAYS_IN: [&str; 5] = ["elevator", "entrance", "stair", "staircase", "stairs"];

impl Check for RoomsAreCutOff {
    const KIND: Kind = Kind {
        name: "rooms_are_cut_off",
        title: "Rooms are cut off from the rest",
        severity: Severity::Warning,
        remedy: "draw the door or passage that leads to them",
    };

    fn find(context: &Context) -> Vec<Self> {
        let shapes = context.shapes();
        let mut parts = Parts { parent: (0..shapes.len()).collect() };
        let mut leads_out = vec![false; shapes.len()];
        for connection in context.analysis.graph.connections() {
            let index = |joint: Joint| context.analysis.shapes.index_of(joint.room()?);
            match (index(connection.sides[0]), index(connection.sides[1])) {
                (Some(one), Some(other)) => parts.join(one, other),
                (Some(room), None) | (None, Some(room)) => leads_out[room] = true,
                (None, None) => {}
            }
        }
        for (index, (_, room)) in context.plan.rooms().enumerate() {
            leads_out[index] |= WAYS_IN.contains(&normalised_function(&room.function).as_str());
        }
        let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for room in 0..shapes.len() {
            members.entry(parts.find(room)).or_default().push(room);
        }
        let is_reached = |rooms: &[usize]| rooms.iter().any(|&room| leads_out[room]);
        // If nothing leads out, the largest part counts as the storey.
        let largest = if members.values().any(|rooms| is_reached(rooms)) {
            None
        } else {
            members
                .iter()
                .max_by_key(|(first, rooms)| (rooms.len(), std::cmp::Reverse(**first)))
                .map(|(&first, _)| first)
        };
        members
            .iter()
            .filter(|(first, rooms)| rooms.len() > 1 && Some(**first) != largest && !is_reached(rooms))
            .filter(|(_, rooms)| rooms.iter().any(|&room| context.is_classified(room)))
            .map(|(_, rooms)| Self { rooms: rooms.iter().map(|&room| context.name(room)).collect() })
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
        format!("nothing leads to these {} rooms: {}", self.rooms.len(), first_of(&self.rooms))
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("rooms", self.rooms.len() as f64)]
    }
}

/// Connected components of a graph (union by smaller index, path halving).
struct Parts {
    parent: Vec<usize>,
}

impl Parts {
    fn find(&mut self, mut room: usize) -> usize {
        while self.parent[room] != room {
            self.parent[room] = self.parent[self.parent[room]];
            room = self.parent[room];
        }
        room
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.find(one), self.find(other));
        self.parent[one.max(other)] = one.min(other);
    }
}
