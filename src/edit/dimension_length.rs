//! Typing the length of a stretch of a dimension chain: what it measures moves, where only one thing can be meant.
//!
//! A figure always says what is measured; there is no text of its own that could say something else.

use std::collections::BTreeSet;

use crate::edit::refit::Changed;
use crate::edit::{EditError, End, Reach, fail, move_picked, resize_opening, set_thickness, slide_opening};
use crate::geometry::{Point, Vector};
use crate::plan::{DimensionHost, DimensionId, DimensionPoint, ElementId, OpeningId, Plan, WallId};

/// How a stretch of a chain gets another length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StretchChange {
    /// It is the width of an opening, whose middle stays.
    Width(OpeningId),
    /// It is the thickness of a wall, whose axis stays.
    Thickness(WallId),
    /// The opening at this end slides along its wall.
    Slide(OpeningId, End),
    /// The wall at this end moves, as if it were dragged.
    Move(WallId, End),
}

impl StretchChange {
    /// The end that moves; `None` where both do.
    pub const fn end(self) -> Option<End> {
        match self {
            Self::Slide(_, end) | Self::Move(_, end) => Some(end),
            Self::Width(_) | Self::Thickness(_) => None,
        }
    }
}

/// A stretch of a chain: its measured ends in order along the line, and the line's direction.
struct Stretch {
    ends: [DimensionPoint; 2],
    along: Vector,
}

impl Stretch {
    fn of(plan: &Plan, id: DimensionId, index: usize) -> Option<Self> {
        let dimension = plan.dimension(id)?;
        let line = plan.dimension_line(dimension)?;
        let [first, second] = line.ticks.get(index..)?.first_chunk()?;
        // Several points may fall into one tick: of these one that follows something.
        let measured = |tick: &(Point, Point)| {
            let here = dimension.points.iter().filter(|point| plan.dimension_point(point) == tick.0);
            here.max_by_key(|point| point.on.is_some()).copied()
        };
        Some(Self { ends: [measured(first)?, measured(second)?], along: line.along })
    }

    /// Its length in metres in a plan.
    fn length_m(&self, plan: &Plan) -> f64 {
        let [start, end] = self.ends.map(|end| plan.dimension_point(&end));
        (end - start).dot(self.along)
    }

    /// The ways to change its length. Openings move rather than walls: they bound no rooms.
    fn changes(&self) -> Vec<StretchChange> {
        match self.ends.map(|end| end.on) {
            [Some(DimensionHost::Opening { opening, .. }), Some(DimensionHost::Opening { opening: other, .. })]
                if opening == other =>
            {
                return vec![StretchChange::Width(opening)];
            }
            [Some(DimensionHost::Wall { wall, .. }), Some(DimensionHost::Wall { wall: other, .. })]
                if wall == other =>
            {
                return vec![StretchChange::Thickness(wall)];
            }
            _ => {}
        }
        let at = |end: End| self.ends[usize::from(end == End::End)].on;
        let slides = |end: End| match at(end)? {
            DimensionHost::Opening { opening, .. } => Some(StretchChange::Slide(opening, end)),
            _ => None,
        };
        let moves = |end: End| match at(end)? {
            DimensionHost::Wall { wall, .. } => Some(StretchChange::Move(wall, end)),
            _ => None,
        };
        let openings: Vec<StretchChange> = End::BOTH.into_iter().filter_map(slides).collect();
        if openings.is_empty() { End::BOTH.into_iter().filter_map(moves).collect() } else { openings }
    }
}

/// The length of a stretch of a chain in metres, from 0 in order along the line, and the ways to change it: none where
/// it is between corners and fixed points. `None` where there is no such stretch.
pub fn dimension_stretch(plan: &Plan, id: DimensionId, index: usize) -> Option<(f64, Vec<StretchChange>)> {
    let stretch = Stretch::of(plan, id, index)?;
    Some((stretch.length_m(plan), stretch.changes()))
}

/// What is measured may miss the length by this, in metres: rounding to the 0.1 mm grid at any angle.
const EXACT_M: f64 = 5e-4;

/// Gives a stretch of a chain another length. Which end moves need only be said where both can.
///
/// # Errors
/// When there is no such stretch, nothing or more than one thing could move, or it has no space to do so.
pub fn set_dimension_length(
    plan: &Plan,
    id: DimensionId,
    index: usize,
    length_m: f64,
    end: Option<End>,
) -> Result<Changed, EditError> {
    let Some(stretch) = Stretch::of(plan, id, index) else { return fail("the dimension has no such stretch") };
    let changes = stretch.changes();
    let change = match (changes.as_slice(), end) {
        ([], _) => return fail("this length is between corners or fixed points: drag those"),
        ([only], _) => *only,
        (both, Some(end)) => match both.iter().find(|change| change.end() == Some(end)) {
            Some(change) => *change,
            None => return fail("nothing can move at this end"),
        },
        (_, None) => return fail("say which end moves: start or end"),
    };
    let by_m = length_m - stretch.length_m(plan);
    let by = |end: End| stretch.along * if end == End::End { by_m } else { -by_m };
    let (changed, why) = match change {
        StretchChange::Width(opening) => {
            (Changed::plainly(resize_opening(plan, opening, length_m)?), "the opening has no space to be so wide")
        }
        StretchChange::Thickness(wall) => {
            (Changed::plainly(set_thickness(plan, &[wall], length_m)?), "the wall cannot be so thick")
        }
        StretchChange::Slide(opening, end) => {
            let segment = plan.opening(opening).and_then(|opening| plan.opening_segment(opening));
            let Some(segment) = segment else { return fail("the opening has no place") };
            let slid = slide_opening(plan, opening, segment.midpoint() + by(end))?;
            (Changed::plainly(slid), "the opening has no space to move so far")
        }
        StretchChange::Move(wall, end) => {
            let picked = BTreeSet::from([ElementId::Wall(wall)]);
            (
                move_picked(plan, &picked, by(end), Reach::Run, false)?,
                "the wall cannot move so far, or takes the other end along",
            )
        }
    };
    if (stretch.length_m(&changed.plan) - length_m).abs() > EXACT_M {
        return fail(why);
    }
    Ok(changed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{draw_dimension, settle_dimensions};
    use crate::geometry::trim_m;
    use crate::plan::{Builder, DimensionAlong, Meta, Opening, OpeningKind, Place};

    /// A wall of 6 m with a door from 1.55 to 2.45 m, walls of 0.24 m at its ends, a partition at 4 m, and a chain.
    fn drawn() -> (Plan, DimensionId) {
        let mut builder = Builder::new(Meta::default());
        let c = [(0.0, 0.0), (6.0, 0.0), (0.0, 4.0), (6.0, 4.0), (4.0, 0.0), (4.0, 4.0)]
            .map(|(x, y)| builder.corner(Point::new(x, y)));
        builder.wall(c[0], c[4], 0.24);
        builder.wall(c[4], c[1], 0.24);
        builder.wall(c[0], c[2], 0.24);
        builder.wall(c[1], c[3], 0.24);
        builder.wall(c[4], c[5], 0.1);
        let place = Place::Hosted { from: c[0], to: c[4], at_m: 2.0, width_m: 0.9 };
        builder.opening("", Opening::new(OpeningKind::Door, place));
        let plan = builder.finish().unwrap();
        let points = [0.12, 1.55, 2.45, 3.95, 4.05, 5.88].map(|x| Point::new(x, 0.12));
        draw_dimension(&plan, &points, DimensionAlong::Horizontal, Point::new(0.0, 1.0)).unwrap()
    }

    fn lengths(plan: &Plan, id: DimensionId) -> Vec<f64> {
        let line = plan.dimension_line(plan.dimension(id).unwrap()).unwrap();
        line.lengths_m().map(trim_m).collect()
    }

    #[test]
    fn what_a_length_means_moves() {
        let (plan, id) = drawn();
        assert_eq!(lengths(&plan, id), [1.43, 0.9, 1.5, 0.1, 1.83]);
        let set = |index, length_m, end| {
            let next = set_dimension_length(&plan, id, index, length_m, end).map(|changed| changed.plan)?;
            assert_eq!(next.violations(), Vec::new());
            Ok::<_, EditError>(lengths(&settle_dimensions(&plan, next).plan, id))
        };
        // The door slides, gets wider, slides; the partition becomes thicker, moves.
        assert_eq!(set(0, 1.0, None).unwrap(), [1.0, 0.9, 1.93, 0.1, 1.83]);
        assert_eq!(set(1, 1.2, None).unwrap(), [1.28, 1.2, 1.35, 0.1, 1.83]);
        assert_eq!(set(2, 2.0, None).unwrap(), [0.93, 0.9, 2.0, 0.1, 1.83]);
        assert_eq!(set(3, 0.2, None).unwrap(), [1.43, 0.9, 1.45, 0.2, 1.78]);
        assert_eq!(set(4, 1.33, Some(End::Start)).unwrap(), [1.43, 0.9, 2.0, 0.1, 1.33]);
        assert_eq!(set(4, 2.83, Some(End::End)).unwrap(), [1.43, 0.9, 1.5, 0.1, 2.83]);
    }

    #[test]
    fn what_cannot_be_meant_is_refused() {
        let (plan, id) = drawn();
        let why = |index, length_m| set_dimension_length(&plan, id, index, length_m, None).unwrap_err().0;
        assert!(why(4, 2.0).contains("which end"), "{}", why(4, 2.0));
        assert!(why(0, 3.5).contains("no space"), "{}", why(0, 3.5));
        assert!(why(9, 1.0).contains("no such"), "{}", why(9, 1.0));
        let fixed = [Point::new(1.0, 2.0), Point::new(2.0, 2.0)];
        let (plan, id) = draw_dimension(&plan, &fixed, DimensionAlong::Horizontal, Point::new(0.0, 2.0)).unwrap();
        let why = set_dimension_length(&plan, id, 0, 2.0, None).unwrap_err().0;
        assert!(why.contains("fixed"), "{why}");
    }
}
