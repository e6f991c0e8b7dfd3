use rstar::AABB;

use super::context::ring_boxes;
use super::overlaps::shared;
use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::geometry::{Bounds, Point, polygon};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// Two holes of a room that overlap: their common area is subtracted twice.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomHolesOverlap {
    pub room: RoomName,
    pub area_m2: f64,
    pub at: Point,
}

impl Check for RoomHolesOverlap {
    const KIND: Kind = Kind {
        name: "room_holes_overlap",
        title: "Holes of a room overlap",
        severity: Severity::Error,
        remedy: "make one hole of the two",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let shapes = context.shapes().iter().enumerate().filter(|(_, shape)| shape.holes.len() > 1);
        for (index, shape) in shapes.filter(|(index, _)| !context.ring_faults[*index].is_hopeless()) {
            let boxes = ring_boxes(&shape.holes);
            for (one, hole) in shape.holes.iter().enumerate().filter(|(_, hole)| !hole.is_empty()) {
                let Bounds { min, max } = polygon::bounds(hole);
                let mut near: Vec<usize> = boxes
                    .locate_in_envelope_intersecting(AABB::from_corners([min.x, min.y], [max.x, max.y]))
                    .map(|found| found.data)
                    .filter(|&other| other > one)
                    .collect();
                near.sort_unstable();
                for other in near {
                    let common =
                        shared([hole], [&shape.holes[other]]).filter(|it| it.depth_m > context.drawing_tolerance_m);
                    if let Some(region) = common {
                        found.push(Self { room: context.name(index), area_m2: region.area_m2, at: region.at });
                    }
                    if found.len() >= FINDINGS_LIMIT {
                        return found;
                    }
                }
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.area_m2
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("two holes of {} share {:.2} m²", self.room, self.area_m2)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2)]
    }
}
