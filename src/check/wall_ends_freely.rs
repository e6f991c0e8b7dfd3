use std::collections::BTreeMap;

use super::rings::TOUCH_M;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::{Bounds, Point};
use crate::plan::{CornerId, ElementId, WallId};

/// A wall with an end that meets nothing: it encloses no room there.
#[derive(Clone, Debug, PartialEq)]
pub struct WallEndsFreely {
    pub wall: WallId,
    pub corner: CornerId,
    pub at: Point,
}

/// A wall that stands free at both ends and is at most this many times as long as it is thick is a
/// column, a pier or a chimney: drawn so on purpose. A fireplace is 1.5 m by 0.6 m.
const PIER_RATIO: f64 = 3.0;

impl Check for WallEndsFreely {
    const KIND: Kind = Kind {
        name: "wall_ends_freely",
        title: "Wall ends freely",
        severity: Severity::Info,
        remedy: "draw it on to the next wall if it should enclose a room",
    };

    fn find(context: &Context) -> Vec<Self> {
        let plan = context.plan;
        let mut uses: BTreeMap<CornerId, usize> = BTreeMap::new();
        for (_, wall) in plan.walls() {
            *uses.entry(wall.from).or_default() += 1;
            *uses.entry(wall.to).or_default() += 1;
        }
        let mut found = Vec::new();
        for (id, wall) in plan.walls() {
            let free_ends = [wall.from, wall.to].into_iter().filter_map(|corner| {
                let at = plan.position(corner).filter(|_| uses.get(&corner) == Some(&1))?;
                let around = Bounds::of([at]).inflated(TOUCH_M);
                let walls = &context.walls;
                let meets_wall = walls
                    .index
                    .near(around)
                    .any(|other| walls.ids[other] != id && walls.index.get(other).distance(at) <= TOUCH_M);
                let edges = &context.edges.index;
                let meets_room = edges.near(around).any(|edge| edges.get(edge).distance(at) <= TOUCH_M);
                (!meets_wall && !meets_room).then_some(Self { wall: id, corner, at })
            });
            let free_ends: Vec<Self> = free_ends.collect();
            let length_m = plan.wall_segment(wall).map_or(0.0, |line| line.length());
            if free_ends.len() < 2 || length_m > PIER_RATIO * wall.thickness_m {
                found.extend(free_ends);
            }
        }
        found
    }

    fn place(&self) -> Place<'_> {
        let elements = vec![ElementId::Wall(self.wall), ElementId::Corner(self.corner)];
        Place { elements, rooms: Vec::new(), at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("wall {} meets nothing at its corner {}", self.wall, self.corner)
    }
}
