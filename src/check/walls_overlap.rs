use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::geometry::segments::{are_parallel, common_stretch};
use crate::geometry::{Point, Segment};
use crate::plan::{ElementId, WallId};

/// Two walls in the same place: one is drawn twice, or extends over the end of the other.
#[derive(Clone, Debug, PartialEq)]
pub struct WallsOverlap {
    pub walls: [WallId; 2],
    pub overlap_m: f64,
    pub at: Point,
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
        for (i, &segment) in walls.index.all().iter().enumerate() {
            let mut near: Vec<usize> =
                walls.index.near(segment.bounds().inflated(APART_M)).filter(|&j| j > i).collect();
            near.sort_unstable();
            for j in near {
                if let Some((overlap_m, at)) = overlap(segment, walls.index.get(j)) {
                    found.push(Self { walls: [walls.ids[i], walls.ids[j]], overlap_m, at });
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
        Place { elements: self.walls.map(ElementId::Wall).to_vec(), rooms: Vec::new(), at: Some(self.at) }
    }

    fn what(&self) -> String {
        let [one, other] = self.walls;
        format!("walls {one} and {other} share {:.2} m", self.overlap_m)
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
