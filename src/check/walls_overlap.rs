use std::collections::BTreeSet;

use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::edit::{self, EditError};
use crate::geometry::segments::{are_parallel, common_stretch};
use crate::geometry::{Point, Segment};
use crate::plan::titles::WallName;
use crate::plan::{CornerId, ElementId, Place as OpeningPlace, Plan, WallId, ordered};

/// Two walls in the same place: one is drawn twice, or extends over the end of the other.
#[derive(Clone, Debug, PartialEq)]
pub struct WallsOverlap {
    pub walls: [WallName; 2],
    pub overlap_m: f64,
    pub at: Point,
    /// The wall that lies in the other all along, is no thicker, and holds no opening.
    pub superfluous: Option<WallId>,
}

/// Walls whose centre lines are closer than this, in metres, are in the same place.
const APART_M: f64 = 0.01;

/// Walls that overlap by less than this, in metres, just meet inexactly.
const LEAST_OVERLAP_M: f64 = 0.05;

/// Walls at a larger angle than this, in radians, meet rather than overlap: 1 cm per metre.
const PARALLEL_RAD: f64 = 0.01;

impl Check for WallsOverlap {
    const KIND: Kind = Kind {
        name: "walls_overlap",
        title: "Walls overlap",
        severity: Severity::Warning,
        remedy: "delete the wall that is drawn twice, or end one where the other begins",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let walls = &context.walls;
        let hosts: BTreeSet<[CornerId; 2]> = context
            .plan
            .openings()
            .filter_map(|(_, opening)| match opening.place {
                OpeningPlace::Hosted { from, to, .. } => Some(ordered(from, to)),
                OpeningPlace::Free { .. } => None,
            })
            .collect();
        let is_within = |one: usize, other: usize, overlap_m: f64| {
            let walls_of = [one, other].map(|index| context.plan.wall(walls.ids[index]));
            let [Some(wall), Some(other_wall)] = walls_of else { return false };
            overlap_m >= walls.index.get(one).length() - APART_M
                && wall.thickness_m <= other_wall.thickness_m
                && !hosts.contains(&ordered(wall.from, wall.to))
        };
        for (i, &segment) in walls.index.all().iter().enumerate() {
            let mut near: Vec<usize> =
                walls.index.near(segment.bounds().inflated(APART_M)).filter(|&j| j > i).collect();
            near.sort_unstable();
            for j in near {
                if let Some((overlap_m, at)) = overlap(segment, walls.index.get(j)) {
                    let within = [(j, i), (i, j)].into_iter().find(|&(one, other)| is_within(one, other, overlap_m));
                    let superfluous = within.map(|(one, _)| walls.ids[one]);
                    let names = [i, j].map(|index| context.wall_name(walls.ids[index]));
                    found.push(Self { walls: names, overlap_m, at, superfluous });
                    if found.len() >= FINDINGS_LIMIT {
                        return found;
                    }
                }
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.overlap_m
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: self.walls.iter().map(|wall| ElementId::Wall(wall.id)).collect(),
            rooms: Vec::new(),
            at: Some(self.at),
        }
    }

    fn fix_title(&self) -> Option<&'static str> {
        self.superfluous.map(|_| "Delete the wall that lies in the other")
    }

    fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
        let wall = self.superfluous.ok_or_else(|| EditError("neither wall lies in the other".to_owned()))?;
        edit::remove(plan, &[ElementId::Wall(wall)])
    }

    fn what(&self) -> String {
        let [one, other] = self.walls.each_ref().map(WallName::to_string);
        // Of two in one place both have the same name as a rule.
        match one == other {
            true => format!("{one} is drawn twice over {:.2} m", self.overlap_m),
            false => format!("{one} and {other} share {:.2} m", self.overlap_m),
        }
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("overlap_m", self.overlap_m)]
    }
}

/// The length of the overlap of two walls, and its midpoint.
fn overlap(one: Segment, other: Segment) -> Option<(f64, Point)> {
    let (from, to) = common_stretch(one, other);
    if to - from < LEAST_OVERLAP_M || !are_parallel(one, other, PARALLEL_RAD) {
        return None;
    }
    let at = one.a.lerp(one.b, (from + to) / 2.0 / one.length());
    (other.distance(at) <= APART_M).then_some((to - from, at))
}
