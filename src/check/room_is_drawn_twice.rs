use super::context::Overlap;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// Two rooms in the same place: they share nearly all of their area.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomIsDrawnTwice {
    pub rooms: [RoomName; 2],
    pub area_m2: f64,
    /// As a share of their union's area.
    pub share: f64,
    pub at: Point,
}

/// Rooms that share at least this much of their area are the same room: nine tenths allows for two
/// people's drawings of it, and no two different rooms overlap so much.
const SAME_SHARE: f64 = 0.9;

/// Whether an overlap means this finding.
pub(super) fn is_same(overlap: &Overlap) -> bool {
    overlap.share_of_union >= SAME_SHARE
}

impl Check for RoomIsDrawnTwice {
    const KIND: Kind = Kind {
        name: "room_is_drawn_twice",
        title: "Room is drawn twice",
        severity: Severity::Error,
        remedy: "delete one of the two",
    };

    fn find(context: &Context) -> Vec<Self> {
        let same = context.overlaps.iter().filter(|overlap| is_same(overlap));
        same.map(|overlap| Self {
            rooms: [context.name(overlap.smaller), context.name(overlap.larger)],
            area_m2: overlap.region.area_m2,
            share: overlap.share_of_union,
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
        format!("{one} and {other} share {:.0} % of their area", 100.0 * self.share)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2), ("share", self.share)]
    }
}
