use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::are_parallel;
use crate::geometry::{Point, Segment};
use crate::plan::titles::{OpeningName, WallName};
use crate::plan::{ElementId, OpeningKind};

/// A wall that ends in a door or passage, or goes through it: nobody passes there, and the opening leads to
/// the room on one side of the wall only.
#[derive(Clone, Debug, PartialEq)]
pub struct WallStandsInAnOpening {
    pub wall: WallName,
    pub opening: OpeningName,
    /// How much of the opening lies to the nearer side of the wall's centre line, in metres.
    pub beside_m: f64,
    pub at: Point,
}

/// A wall reaches into the wall that it ends at by so much at most, in metres, besides half of that one's
/// thickness.
const SLACK_M: f64 = 0.01;

impl Check for WallStandsInAnOpening {
    const KIND: Kind = Kind {
        name: "wall_stands_in_an_opening",
        title: "Wall stands in an opening",
        severity: Severity::Warning,
        remedy: "move the opening to one side of the wall, or the wall's end beside the opening",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let walls = &context.walls;
        for placed in context.openings.iter().filter(|placed| placed.opening.kind != OpeningKind::Window) {
            let opening = placed.segment;
            let mut near: Vec<usize> = walls.index.near(opening.bounds().inflated(SLACK_M)).collect();
            near.sort_unstable_by_key(|&wall| walls.ids[wall]);
            for wall in near {
                let line = walls.index.get(wall);
                if are_parallel(line, opening, ANGLE_TOLERANCE_RAD) {
                    continue;
                }
                let Some(at) = meets(line, opening) else { continue };
                let half_m = context.plan.wall(walls.ids[wall]).map_or(0.0, |wall| wall.thickness_m / 2.0);
                let beside_m = at.distance(opening.a).min(at.distance(opening.b));
                // A door drawn up to the centre line of the wall beside it is a door in the corner.
                if beside_m <= half_m.max(context.drawing_tolerance_m) {
                    continue;
                }
                found.push(Self {
                    wall: context.wall_name(walls.ids[wall]),
                    opening: context.opening_name(placed.id, placed.opening),
                    beside_m,
                    at,
                });
                if found.len() >= FINDINGS_LIMIT {
                    return found;
                }
            }
        }
        found
    }

    fn size(&self) -> f64 {
        self.beside_m
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: vec![ElementId::Wall(self.wall.id), ElementId::Opening(self.opening.id)],
            rooms: Vec::new(),
            at: Some(self.at),
        }
    }

    fn what(&self) -> String {
        format!("{} stands in {}, {:.2} m from its end", self.wall, self.opening, self.beside_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("beside_m", self.beside_m)]
    }
}

/// Where a wall crosses an opening or ends at it; `None` where it does neither.
fn meets(wall: Segment, opening: Segment) -> Option<Point> {
    let across = wall.vector().cross(opening.vector());
    let along = (opening.a - wall.a).cross(opening.vector()) / across;
    let at = wall.a.lerp(wall.b, along);
    let slack = SLACK_M / wall.length();
    (along.is_finite() && (-slack..=1.0 + slack).contains(&along) && opening.distance(at) <= SLACK_M).then_some(at)
}
