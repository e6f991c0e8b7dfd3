use super::context::Overlap;
use super::room_is_drawn_twice::is_same;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::ElementId;
use crate::plan::titles::RoomName;

/// A room inside another one: the other's area includes what is not its own.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomLiesInsideAnother {
    pub inner: RoomName,
    pub outer: RoomName,
    pub area_m2: f64,
    /// As a share of the inner room's area.
    pub share: f64,
    pub at: Point,
}

/// A room with this share of its area in another counts as inside it: the rest is a side drawn a little
/// too far out.
const INSIDE_SHARE: f64 = 0.9;

/// Whether an overlap means this finding.
pub(super) fn is_inside(overlap: &Overlap) -> bool {
    overlap.share >= INSIDE_SHARE && !is_same(overlap)
}

impl Check for RoomLiesInsideAnother {
    const KIND: Kind = Kind {
        name: "room_lies_inside_another",
        title: "Room lies inside another",
        severity: Severity::Warning,
        remedy: "cut the outer room out around it, or delete the inner one",
    };

    fn find(context: &Context) -> Vec<Self> {
        let inside = context.overlaps.iter().filter(|overlap| is_inside(overlap));
        inside
            .map(|overlap| Self {
                inner: context.name(overlap.smaller),
                outer: context.name(overlap.larger),
                area_m2: overlap.region.area_m2,
                share: overlap.share,
                at: overlap.region.at,
            })
            .collect()
    }

    fn size(&self) -> f64 {
        self.area_m2
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: vec![ElementId::Room(self.outer.id), ElementId::Room(self.inner.id)],
            rooms: vec![&self.outer, &self.inner],
            at: Some(self.at),
        }
    }

    fn what(&self) -> String {
        format!("{} ({:.2} m²) lies inside {}", self.inner, self.area_m2, self.outer)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2), ("share", self.share)]
    }
}
