use super::{Check, Context, FINDINGS_LIMIT, Kind, Place, Severity};
use crate::edit::{self, EditError};
use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::{SegmentIndex, are_parallel, common_stretch};
use crate::geometry::{GRID_M, Point, Segment};
use crate::plan::titles::OpeningName;
use crate::plan::{DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, ElementId, Plan};

/// Two openings in the same place: a doorway drawn twice counts twice in its rooms' features.
#[derive(Clone, Debug, PartialEq)]
pub struct OpeningsOverlap {
    pub openings: [OpeningName; 2],
    /// Length of the overlap in metres.
    pub overlap_m: f64,
    pub at: Point,
    /// Whether the second is the first once more: of its kind, and in its place.
    pub is_repeat: bool,
}

/// Openings that share more than this fraction of the narrower one overlap. Less means two neighbouring
/// doors drawn a little too wide.
const LEAST_SHARE: f64 = 0.5;

/// The certain share of the default width: a door of exactly that width may be one its source draws as a
/// point, and the doors of two adjacent stalls are half as wide.
const LEAST_OF_USUAL_WIDTH: f64 = 0.5;

/// The part an opening occupies for certain.
fn certain_part(segment: Segment) -> Segment {
    if (segment.length() - DEFAULT_DOOR_WIDTH_M).abs() > GRID_M {
        return segment;
    }
    let middle = segment.midpoint();
    Segment::new(middle.lerp(segment.a, LEAST_OF_USUAL_WIDTH), middle.lerp(segment.b, LEAST_OF_USUAL_WIDTH))
}

/// Openings whose ends are closer than this, in metres, are in the same place.
const SAME_PLACE_M: f64 = 0.05;

/// Whether two openings have their ends in the same places, in either direction.
fn are_same(one: Segment, other: Segment) -> bool {
    let apart = |a: Point, b: Point| one.a.distance(a).max(one.b.distance(b));
    apart(other.a, other.b).min(apart(other.b, other.a)) <= SAME_PLACE_M
}

impl Check for OpeningsOverlap {
    const KIND: Kind = Kind {
        name: "openings_overlap",
        title: "Openings overlap",
        severity: Severity::Warning,
        remedy: "delete the one that is drawn twice, or move them apart",
    };

    fn find(context: &Context) -> Vec<Self> {
        let mut found = Vec::new();
        let index = SegmentIndex::new(context.openings.iter().map(|placed| certain_part(placed.segment)).collect());
        for (i, placed) in context.openings.iter().enumerate() {
            let segment = index.get(i);
            let mut near: Vec<usize> =
                index.near(segment.bounds().inflated(DEFAULT_WALL_THICKNESS_M)).filter(|&j| j > i).collect();
            near.sort_unstable();
            for j in near {
                let (other, other_segment) = (&context.openings[j], index.get(j));
                let (from, to) = common_stretch(segment, other_segment);
                let least_m = LEAST_SHARE * segment.length().min(other_segment.length());
                if to - from <= least_m || !are_parallel(segment, other_segment, ANGLE_TOLERANCE_RAD) {
                    continue;
                }
                let at = segment.a.lerp(segment.b, (from + to) / 2.0 / segment.length());
                if other_segment.distance(at) > DEFAULT_WALL_THICKNESS_M {
                    continue;
                }
                let is_repeat = placed.opening.kind == other.opening.kind
                    && placed.opening.pinned == other.opening.pinned
                    && are_same(placed.segment, other.segment);
                found.push(Self {
                    openings: [
                        context.opening_name(placed.id, placed.opening),
                        context.opening_name(other.id, other.opening),
                    ],
                    overlap_m: to - from,
                    at,
                    is_repeat,
                });
                if found.len() >= FINDINGS_LIMIT {
                    return found;
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
            elements: self.openings.iter().map(|opening| ElementId::Opening(opening.id)).collect(),
            rooms: Vec::new(),
            at: Some(self.at),
        }
    }

    fn fix_title(&self) -> Option<&'static str> {
        self.is_repeat.then_some("Delete the repeated opening")
    }

    fn fixed(&self, plan: &Plan) -> Result<Plan, EditError> {
        if !self.is_repeat {
            return Err(EditError("neither opening repeats the other".to_owned()));
        }
        edit::remove(plan, &[ElementId::Opening(self.openings[1].id)])
    }

    fn what(&self) -> String {
        let [one, other] = &self.openings;
        format!("{one} and {other} share {:.2} m of the same wall", self.overlap_m)
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("overlap_m", self.overlap_m)]
    }
}
