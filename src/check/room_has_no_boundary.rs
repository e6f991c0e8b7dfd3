use super::{Check, Context, Kind, Place, Severity};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room that is named but not drawn: it has no area, no axes, no features.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHasNoBoundary {
    pub room: RoomName,
}

impl Check for RoomHasNoBoundary {
    const KIND: Kind = Kind {
        name: "room_has_no_boundary",
        title: "Room has no boundary",
        severity: Severity::Error,
        remedy: "draw its boundary, or delete the room",
    };

    fn find(context: &Context) -> Vec<Self> {
        context
            .plan
            .rooms()
            .filter(|(_, room)| !room.has_boundary())
            .map(|(id, room)| Self { room: context.name_of_room(id, room) })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: None }
    }

    fn what(&self) -> String {
        format!("{} is not drawn", self.room)
    }
}
