use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::titles::{OpeningName, RoomName};
use crate::plan::{ElementId, THICKEST_WALL_M};

/// An opening stated to lead to a room whose boundary is further away than the thickest wall.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningIsFarFromItsRooms {
    pub opening: OpeningName,
    pub room: RoomName,
    /// From the opening's middle to the room, in metres; `None` if beyond `LOOK_M`.
    pub distance_m: Option<f64>,
    pub at: Point,
}

/// How far to look for the room, in metres, in order to state its distance.
const LOOK_M: f64 = 10.0;

impl Check for OpeningIsFarFromItsRooms {
    const KIND: Kind = Kind {
        name: "opening_is_far_from_its_rooms",
        title: "Opening is far from the room it leads to",
        severity: Severity::Warning,
        remedy: "move it to the room's wall, or unpin it: its rooms then follow from its place",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        for placed in &context.openings {
            let at = placed.segment.midpoint();
            for joint in placed.opening.pinned.iter().flatten() {
                let Some(index) = joint.room().and_then(|id| context.analysis.shapes.index_of(id)) else { continue };
                // A room whose boundary encloses nothing is nowhere: that is another finding.
                if context.shapes()[index].outer.is_empty()
                    || context.ring_faults[index].is_hopeless()
                    || context.distance_to_room(at, index, THICKEST_WALL_M).is_some()
                {
                    continue;
                }
                found.push(Self {
                    opening: context.opening_name(placed.id, placed.opening),
                    room: context.name(index),
                    distance_m: context.distance_to_room(at, index, LOOK_M),
                    at,
                });
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.distance_m.unwrap_or(LOOK_M)
    }

    fn place(&self) -> Place<'_> {
        let elements = vec![ElementId::Opening(self.opening.id), ElementId::Room(self.room.id)];
        Place { elements, rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        match self.distance_m {
            Some(distance_m) => {
                format!("{} lies {distance_m:.2} m from {}, to which it leads", self.opening, self.room)
            }
            None => format!("{} lies more than {LOOK_M} m from {}, to which it leads", self.opening, self.room),
        }
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        self.distance_m.map(|distance_m| ("distance_m", distance_m)).into_iter().collect()
    }
}
