use super::plan_has_no_openings::has_no_openings;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room with no door or passage leading to it. Balconies, shafts and the like need none.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHasNoOpening {
    pub room: RoomName,
    pub at: Point,
}

impl Check for RoomHasNoOpening {
    const KIND: Kind = Kind {
        name: "room_has_no_opening",
        title: "Nothing leads to the room",
        severity: Severity::Warning,
        remedy: "draw its door; give a shaft or a void a function that is not classified",
    };

    fn find(context: &Context) -> Vec<Self> {
        // A single room is a drawing just begun; a plan without any opening is one finding.
        if context.shapes().len() < 2 || has_no_openings(context) {
            return Vec::new();
        }
        let rooms = context.shapes().iter().enumerate();
        rooms
            .filter(|(index, shape)| {
                !shape.outer.is_empty()
                    && context.is_classified(*index)
                    && context.analysis.graph.of_room(*index).len() == 0
            })
            .map(|(index, shape)| Self { room: context.name(index), at: shape.bounds.center() })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("{} has no door or passage", self.room)
    }
}
