use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::{SegmentIndex, are_parallel};
use crate::geometry::{Point, Segment};
use crate::plan::titles::OpeningName;
use crate::plan::{ElementId, THICKEST_WALL_M};

/// An opening that extends past the end of its wall.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningIsWiderThanItsWall {
    pub opening: OpeningName,
    pub width_m: f64,
    /// How far it extends past the end, in metres.
    pub excess_m: f64,
    pub at: Point,
}

/// An opening may extend this far past its wall, in metres: into the thickness of a crossing wall, which
/// rooms drawn to wall centre lines do not show.
const TOLERATED_EXCESS_M: f64 = crate::plan::DEFAULT_WALL_THICKNESS_M;

impl Check for OpeningIsWiderThanItsWall {
    const KIND: Kind = Kind {
        name: "opening_is_wider_than_its_wall",
        title: "Opening is wider than its wall",
        severity: Severity::Warning,
        remedy: "make it narrower, or move it along its wall",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        for placed in &context.openings {
            let width_m = placed.segment.length();
            let ends = [placed.segment.a, placed.segment.b];
            let excess_m = ends
                .into_iter()
                .filter_map(|end| beyond_walls_m(&context.edges.index, &context.walls.index, placed.segment, end))
                .fold(0.0, f64::max);
            if excess_m > TOLERATED_EXCESS_M.max(context.drawing_tolerance_m) {
                found.push(Self {
                    opening: context.opening_name(placed.id, placed.opening),
                    width_m,
                    excess_m,
                    at: placed.segment.midpoint(),
                });
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.excess_m
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Opening(self.opening.id)], rooms: Vec::new(), at: Some(self.at) }
    }

    fn what(&self) -> String {
        format!("{} is {:.2} m wide and reaches {:.2} m beyond its wall", self.opening, self.width_m, self.excess_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("width_m", self.width_m), ("excess_m", self.excess_m)]
    }
}

/// How far an end of an opening is past the walls and room sides that run along the opening, in metres;
/// `None` if nothing runs along it (it stands free: another finding).
fn beyond_walls_m(edges: &SegmentIndex, walls: &SegmentIndex, opening: Segment, end: Point) -> Option<f64> {
    let direction = opening.vector().unit()?;
    let near = opening.bounds().inflated(THICKEST_WALL_M);
    let along = [edges, walls].into_iter().flat_map(|index| index.near(near).map(|found| index.get(found)));
    along
        .filter(|edge| are_parallel(*edge, opening, ANGLE_TOLERANCE_RAD))
        .filter_map(|edge| {
            let (a, b) = ((edge.a - end).dot(direction), (edge.b - end).dot(direction));
            let beyond_m = a.min(b).max(-a.max(b)).max(0.0);
            let aside_m = (edge.nearest_point(end) - end).cross(direction).abs();
            (aside_m <= THICKEST_WALL_M).then_some(beyond_m)
        })
        .min_by(f64::total_cmp)
}
