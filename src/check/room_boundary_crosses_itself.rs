use super::overlaps::shared;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room whose boundary crosses itself: the inside, and so its area, is not what was meant.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomBoundaryCrossesItself {
    pub room: RoomName,
    /// Where, in order along the boundary; at least one.
    pub crossings: Vec<Point>,
    /// How far its area, computed as for any room, is from what its boundary encloses; the latter counts
    /// as 0 where the boundary crosses itself excessively.
    pub area_error_m2: f64,
    /// The same as a share of the area its boundary encloses.
    pub area_error: f64,
}

/// A crossing that changes the room's area by less than this share is a warning: areas are computed and
/// compared to a thousandth.
const TOLERATED_AREA_ERROR: f64 = 0.001;

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
            .map(|(index, faults)| {
                let shape = &context.shapes()[index];
                let (min, max) = (shape.bounds.min, shape.bounds.max);
                let around = vec![min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
                let enclosed = if faults.is_hopeless() { None } else { shared(shape.rings(), [&around]) };
                let enclosed_m2 = enclosed.map_or(0.0, |region| region.area_m2);
                let area_error_m2 = (enclosed_m2 - shape.area_m2()).abs();
                let area_error = if enclosed_m2 > 0.0 { area_error_m2 / enclosed_m2 } else { 1.0 };
                Self { room: context.name(index), crossings: faults.crossings.clone(), area_error_m2, area_error }
            })
            .collect()
    }

    fn severity(&self) -> Severity {
        if self.area_error > TOLERATED_AREA_ERROR { Severity::Error } else { Severity::Warning }
    }

    fn size(&self) -> f64 {
        self.area_error_m2
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: vec![ElementId::Room(self.room.id)],
            rooms: vec![&self.room],
            at: self.crossings.first().copied(),
        }
    }

    fn what(&self) -> String {
        let places =
            if self.crossings.len() == 1 { String::new() } else { format!(" in {} places", self.crossings.len()) };
        format!("the boundary of {} crosses itself{places}; its area is {:.2} m² off", self.room, self.area_error_m2)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![
            ("crossings", self.crossings.len() as f64),
            ("area_error_m2", self.area_error_m2),
            ("area_error", self.area_error),
        ]
    }
}
