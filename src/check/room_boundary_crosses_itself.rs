use super::{Check, Context, Kind, Place, RoomName, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;

/// A room whose boundary passes over itself: what is inside, and so its area, is not what was meant.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomBoundaryCrossesItself {
    pub room: RoomName,
    /// Where, in the order of the boundary; at least one.
    pub crossings: Vec<Point>,
}

impl Check for RoomBoundaryCrossesItself {
    const KIND: Kind = Kind {
        name: "room_boundary_crosses_itself",
        title: "Room's boundary crosses itself",
        severity: Severity::Error,
        remedy: "move or delete the corners that make the loop",
    };

    fn find(context: &Context) -> Vec<Self> {
        let faults = context.ring_faults.iter().enumerate();
        faults
            .filter(|(_, faults)| !faults.crossings.is_empty())
            .map(|(index, faults)| Self { room: context.name(index), crossings: faults.crossings.clone() })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: vec![ElementId::Room(self.room.id)],
            rooms: vec![&self.room],
            at: self.crossings.first().copied(),
        }
    }

    fn what(&self) -> String {
        match self.crossings.len() {
            1 => format!("the boundary of {} crosses itself", self.room),
            count => format!("the boundary of {} crosses itself in {count} places", self.room),
        }
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("crossings", self.crossings.len() as f64)]
    }
}
