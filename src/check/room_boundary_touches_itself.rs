use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room whose boundary touches itself or doubles back (a spike): its area is right, but its walls, and
/// so its axes ratio, may not be.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomBoundaryTouchesItself {
    pub room: RoomName,
    /// Where, in order along the boundary; at least one.
    pub touches: Vec<Point>,
}

impl Check for RoomBoundaryTouchesItself {
    const KIND: Kind = Kind {
        name: "room_boundary_touches_itself",
        title: "Room's boundary touches itself",
        severity: Severity::Warning,
        remedy: "delete the spike's corners; make an island a hole, and two parts two rooms",
    };

    fn find(context: &Context) -> Vec<Self> {
        let faults = context.ring_faults.iter().enumerate();
        faults
            // A crossing is worse, and fixing it usually fixes both.
            .filter(|(_, faults)| faults.crossings.is_empty() && !faults.touches.is_empty())
            .map(|(index, faults)| Self { room: context.name(index), touches: faults.touches.clone() })
            .collect()
    }

    fn size(&self) -> f64 {
        self.touches.len() as f64
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: vec![ElementId::Room(self.room.id)],
            rooms: vec![&self.room],
            at: self.touches.first().copied(),
        }
    }

    fn what(&self) -> String {
        match self.touches.len() {
            1 => format!("the boundary of {} touches itself", self.room),
            count => format!("the boundary of {} touches itself in {count} places", self.room),
        }
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("touches", self.touches.len() as f64)]
    }
}
