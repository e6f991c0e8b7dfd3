use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::titles::{OpeningName, RoomName};
use crate::plan::{ElementId, Joint, THICKEST_WALL_M};
use crate::topology::sides_by_geometry;

/// An opening stated to lead to a nearby room, but that by its position leads into another.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningContradictsItsPlace {
    pub opening: OpeningName,
    /// The room it is stated to lead to.
    pub stated: RoomName,
    /// The room that is there instead.
    pub found: RoomName,
    pub at: Point,
}

impl Check for OpeningContradictsItsPlace {
    const KIND: Kind = Kind {
        name: "opening_contradicts_its_place",
        title: "Opening leads elsewhere than stated",
        severity: Severity::Warning,
        remedy: "move it between the rooms it joins, or unpin it: they then follow from its place",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        for placed in &context.openings {
            let Some(stated) = placed.opening.pinned.filter(|_| placed.opening.kind.is_passable()) else { continue };
            let seen = sides_by_geometry(context.plan, &context.analysis.shapes, placed.opening);
            // Both sides are rooms, stated and found, and one of them is the same: so the difference is
            // not due to the opening's direction or to space that is not drawn.
            let rooms = |sides: [Joint; 2]| Some([sides[0].room()?, sides[1].room()?]);
            let (Some(stated), Some(seen)) = (rooms(stated), rooms(seen)) else { continue };
            let missing: Vec<_> = stated.into_iter().filter(|room| !seen.contains(room)).collect();
            let instead: Vec<_> = seen.into_iter().filter(|room| !stated.contains(room)).collect();
            let (&[missing], &[instead]) = (missing.as_slice(), instead.as_slice()) else { continue };
            let at = placed.segment.midpoint();
            // A room far away is another finding.
            let is_near = context
                .analysis
                .shapes
                .index_of(missing)
                .is_some_and(|index| context.distance_to_room(at, index, THICKEST_WALL_M).is_some());
            if let (true, Some(stated), Some(instead)) = (is_near, context.name_of(missing), context.name_of(instead)) {
                found.push(Self {
                    opening: context.opening_name(placed.id, placed.opening),
                    stated,
                    found: instead,
                    at,
                });
            }
        }
        found
    }

    fn place(&self) -> Place<'_> {
        let rooms = [self.stated.id, self.found.id].map(ElementId::Room);
        Place {
            elements: [ElementId::Opening(self.opening.id)].into_iter().chain(rooms).collect(),
            rooms: vec![&self.stated, &self.found],
            at: Some(self.at),
        }
    }

    fn what(&self) -> String {
        format!("{} is said to lead to {}, but {} lies there", self.opening, self.stated, self.found)
    }
}
