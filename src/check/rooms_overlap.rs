use super::room_is_drawn_twice::is_same;
use super::room_lies_inside_another::is_inside;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::titles::RoomName;
use crate::plan::{DEFAULT_WALL_THICKNESS_M, ElementId};

/// Two rooms that overlap more deeply than a wall between them explains: both count the same floor area.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomsOverlap {
    pub rooms: [RoomName; 2],
    pub area_m2: f64,
    /// Depth of the overlap in metres.
    pub depth_m: f64,
    pub at: Point,
}

/// Overlaps up to a partition's thickness are normal for rooms traced one by one along a wall's two
/// faces, or along its near or far face; they change an area by less than the uncertainty of its scale.
const TOLERATED_DEPTH_M: f64 = DEFAULT_WALL_THICKNESS_M;

impl Check for RoomsOverlap {
    const KIND: Kind = Kind {
        name: "rooms_overlap",
        title: "Rooms overlap",
        severity: Severity::Warning,
        remedy: "move the side they share to where the wall is",
    };

    fn find(context: &Context) -> Vec<Self> {
        let deep = context.overlaps.iter().filter(|overlap| {
            let tolerated_m = TOLERATED_DEPTH_M.max(context.drawing_tolerance_m);
            overlap.region.depth_m > tolerated_m && !is_same(overlap) && !is_inside(overlap)
        });
        deep.map(|overlap| Self {
            rooms: [context.name(overlap.smaller), context.name(overlap.larger)],
            area_m2: overlap.region.area_m2,
            depth_m: overlap.region.depth_m,
            at: overlap.region.at,
        })
        .collect()
    }

    fn size(&self) -> f64 {
        self.area_m2
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: self.rooms.iter().map(|room| ElementId::Room(room.id)).collect(),
            rooms: self.rooms.iter().collect(),
            at: Some(self.at),
        }
    }

    fn what(&self) -> String {
        let [one, other] = &self.rooms;
        format!("{one} and {other} overlap by {:.2} m², {:.2} m deep", self.area_m2, self.depth_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2), ("depth_m", self.depth_m)]
    }
}
