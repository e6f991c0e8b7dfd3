use super::{Check, Context, Kind, Place, Severity};
use crate::features::RoomStatus;
use crate::geometry::Point;
use crate::labels::normalised_function;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room with neither a function nor a label: useless for training and scoring.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHasNoFunction {
    pub room: RoomName,
    pub at: Option<Point>,
}

impl Check for RoomHasNoFunction {
    const KIND: Kind = Kind {
        name: "room_has_no_function",
        title: "Room has neither function nor label",
        severity: Severity::Warning,
        remedy: "set its function, or accept a prediction",
    };

    fn find(context: &Context) -> Vec<Self> {
        let rooms = context.plan.rooms().enumerate();
        rooms
            .filter(|(index, (_, room))| {
                context.status(*index) == RoomStatus::Unlabelled && normalised_function(&room.function).is_empty()
            })
            .map(|(index, (id, room))| {
                let shape = &context.shapes()[index];
                let at = (!shape.outer.is_empty()).then(|| shape.bounds.center());
                Self { room: context.name_of_room(id, room), at }
            })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: self.at }
    }

    fn what(&self) -> String {
        self.room.to_string()
    }
}
