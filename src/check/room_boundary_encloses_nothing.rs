use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::{Point, polygon};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room whose boundary is not a closed shape: fewer than three different corners, or all collinear.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomBoundaryEnclosesNothing {
    pub room: RoomName,
    pub area_m2: f64,
    pub at: Point,
}

/// Anything smaller is not a room: a square of 10 cm is below the smallest duct anyone draws (the
/// smallest of 7,400 real rooms has 0.06 m²).
const LEAST_AREA_M2: f64 = 0.01;

impl Check for RoomBoundaryEnclosesNothing {
    const KIND: Kind = Kind {
        name: "room_boundary_encloses_nothing",
        title: "Room's boundary encloses nothing",
        severity: Severity::Error,
        remedy: "draw its boundary again, or delete the room",
    };

    fn find(context: &Context) -> Vec<Self> {
        let shapes = context.shapes().iter().zip(&context.ring_faults).enumerate();
        shapes
            .filter(|(_, (shape, faults))| {
                // The lobes of a bow tie cancel out: that is another finding.
                !shape.outer.is_empty() && shape.area_m2() < LEAST_AREA_M2 && faults.crossings.is_empty()
            })
            .map(|(index, (shape, _))| Self {
                room: context.name(index),
                area_m2: shape.area_m2(),
                at: polygon::centroid(&shape.outer),
            })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("{} has an area of {:.4} m²", self.room, self.area_m2)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2)]
    }
}
