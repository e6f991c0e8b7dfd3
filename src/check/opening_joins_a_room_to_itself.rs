use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::titles::{OpeningName, RoomName};
use crate::plan::{ElementId, Joint};

/// A door or passage with the same room on both sides: it counts as an opening of the room but leads
/// nowhere.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningJoinsARoomToItself {
    pub opening: OpeningName,
    pub room: RoomName,
    pub at: Option<Point>,
    /// Whether this is stated; otherwise it follows from geometry.
    pub pinned: bool,
}

impl Check for OpeningJoinsARoomToItself {
    const KIND: Kind = Kind {
        name: "opening_joins_a_room_to_itself",
        title: "Opening joins a room to itself",
        severity: Severity::Warning,
        remedy: "divide the room there, move the opening to the room's boundary, or delete it",
    };

    fn find(context: &Context) -> Vec<Self> {
        let connections = context.analysis.graph.connections().iter();
        connections
            .filter_map(|connection| {
                let (Joint::Room(room), true) = (connection.sides[0], connection.joins_nothing()) else { return None };
                let opening = context.plan.opening(connection.opening)?;
                Some(Self {
                    opening: context.opening_name(connection.opening, opening),
                    room: context.name_of(room)?,
                    at: context.plan.opening_segment(opening).map(|segment| segment.midpoint()),
                    pinned: connection.pinned,
                })
            })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        let elements = vec![ElementId::Opening(self.opening.id), ElementId::Room(self.room.id)];
        Place { elements, rooms: vec![&self.room], at: self.at }
    }

    fn what(&self) -> String {
        let says = if self.pinned { "is said to have" } else { "has" };
        format!("{} {says} {} on both sides", self.opening, self.room)
    }
}
