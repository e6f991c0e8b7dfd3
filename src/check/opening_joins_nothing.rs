use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::plan::titles::OpeningName;
use crate::plan::{ElementId, Joint, THICKEST_WALL_M};

/// A door or passage with no room on either side: it counts in no room's features.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningJoinsNothing {
    pub opening: OpeningName,
    pub at: Option<Point>,
    /// Whether this is stated; otherwise it follows from geometry.
    pub pinned: bool,
}

impl Check for OpeningJoinsNothing {
    const KIND: Kind = Kind {
        name: "opening_joins_nothing",
        title: "Opening joins nothing",
        severity: Severity::Error,
        remedy: "move it onto the wall of its room, draw the missing room, or delete it",
    };

    fn find(context: &Context) -> Vec<Self> {
        let connections = context.analysis.graph.connections().iter();
        connections
            .filter(|connection| connection.sides == [Joint::Outside; 2])
            .filter_map(|connection| {
                let opening = context.plan.opening(connection.opening)?;
                Some(Self {
                    opening: context.opening_name(connection.opening, opening),
                    at: context.plan.opening_segment(opening).map(|segment| segment.midpoint()),
                    pinned: connection.pinned,
                })
            })
            .collect()
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Opening(self.opening.id)], rooms: Vec::new(), at: self.at }
    }

    fn what(&self) -> String {
        if self.pinned {
            format!("{} is said to lead from the outside to the outside", self.opening)
        } else {
            format!("{} has no room within {THICKEST_WALL_M} m on either side", self.opening)
        }
    }
}
