use super::overlaps::outside;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A hole that lies outside the room's outer boundary or crosses it: the area subtracted is not the
/// room's.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHoleIsNotInside {
    pub room: RoomName,
    /// How much of the hole is outside.
    pub area_outside_m2: f64,
    pub at: Point,
}

impl Check for RoomHoleIsNotInside {
    const KIND: Kind = Kind {
        name: "room_hole_is_not_inside",
        title: "Room's hole reaches outside the room",
        severity: Severity::Error,
        remedy: "move the hole's corners into the room, or delete the hole",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let shapes = context.shapes().iter().enumerate();
        for (index, shape) in shapes.filter(|(index, _)| !context.ring_faults[*index].is_hopeless()) {
            for hole in &shape.holes {
                let beyond =
                    outside([hole], [&shape.outer]).filter(|region| region.depth_m > context.drawing_tolerance_m);
                if let Some(region) = beyond {
                    found.push(Self { room: context.name(index), area_outside_m2: region.area_m2, at: region.at });
                }
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.area_outside_m2
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("{:.2} m² of a hole of {} lie outside the room", self.area_outside_m2, self.room)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_outside_m2", self.area_outside_m2)]
    }
}
