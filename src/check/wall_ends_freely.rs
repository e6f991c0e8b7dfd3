use std::collections::BTreeMap;

use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, Point, Segment, TOUCH_M};
use crate::plan::titles::WallName;
use crate::plan::{CornerId, ElementId, WallId};

/// A wall with an end that meets nothing: no room is enclosed there.
#[derive(Clone, Debug, PartialEq)]
pub struct WallEndsFreely {
    pub wall: WallName,
    /// The ends that meet nothing and their positions; one or both.
    pub ends: Vec<(CornerId, Point)>,
}

/// A wall free at both ends and at most this many times as long as it is thick is a column, a pier or a
/// chimney, drawn that way on purpose. A fireplace is 1.5 m by 0.6 m.
const PIER_RATIO: f64 = 3.0;

impl Check for WallEndsFreely {
    const KIND: Kind = Kind {
        name: "wall_ends_freely",
        title: "Wall ends freely",
        severity: Severity::Info,
        remedy: "extend it to the next wall if it should enclose a room",
    };

    fn find(context: &Context) -> Vec<Self> {
        let plan = context.plan;
        let mut uses: BTreeMap<CornerId, usize> = BTreeMap::new();
        for (_, wall) in plan.walls() {
            *uses.entry(wall.from).or_default() += 1;
            *uses.entry(wall.to).or_default() += 1;
        }
        let (walls, edges) = (&context.walls, &context.edges.index);
        let openings = SegmentIndex::new(context.openings.iter().map(|placed| placed.segment).collect());
        let meets_nothing = |id: WallId, at: Point| {
            let around = Bounds::of([at]).inflated(TOUCH_M);
            let touches = |segment: Segment| segment.distance(at) <= TOUCH_M;
            // Where walls are drawn with gaps for doors, a wall ends at the door that closes the gap.
            !openings.near(around).any(|opening| touches(openings.get(opening)))
                && !walls.index.near(around).any(|other| walls.ids[other] != id && touches(walls.index.get(other)))
                && !edges.near(around).any(|edge| touches(edges.get(edge)))
        };
        let mut found = Vec::new();
        for (id, wall) in plan.walls() {
            let ends = [wall.from, wall.to].into_iter().filter(|corner| uses.get(corner) == Some(&1));
            let ends = ends.filter_map(|corner| Some((corner, plan.position(corner)?)));
            let ends: Vec<(CornerId, Point)> = ends.filter(|&(_, at)| meets_nothing(id, at)).collect();
            let length_m = plan.wall_segment(wall).map_or(0.0, Segment::length);
            let is_pier = ends.len() == 2 && length_m <= PIER_RATIO * wall.thickness_m;
            if !ends.is_empty() && !is_pier {
                found.push(Self { wall: context.wall_name(id), ends });
            }
        }
        found
    }

    fn place(&self) -> Place<'_> {
        let corners = self.ends.iter().map(|&(corner, _)| ElementId::Corner(corner));
        Place {
            elements: [ElementId::Wall(self.wall.id)].into_iter().chain(corners).collect(),
            rooms: Vec::new(),
            at: self.ends.first().map(|&(_, at)| at),
        }
    }

    fn what(&self) -> String {
        match self.ends.as_slice() {
            [_] => format!("{} meets nothing at one end", self.wall),
            _ => format!("{} meets nothing at either end", self.wall),
        }
    }
}
