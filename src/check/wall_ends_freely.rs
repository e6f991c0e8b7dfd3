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
            for corner in [wall.from, wall.to] {
                let Some(at) = plan.position(corner).filter(|_| uses.get(&corner) == Some(&1)) else { continue };
                let around = Bounds::of([at]).inflated(TOUCH_M);
                let walls = &context.walls;
                let meets_wall = walls
                    .index
                    .near(around)
                    .any(|other| walls.ids[other] != id && walls.index.get(other).distance(at) <= TOUCH_M);
                let edges = &context.edges.index;
                if !meets_wall && !edges.near(around).any(|edge| edges.get(edge).distance(at) <= TOUCH_M) {
                    found.push(Self { wall: id, corner, at });
                }
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
