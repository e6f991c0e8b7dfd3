//! Numbers along a wall: how far an opening is from what lies beside it, its ends, and a wall's own length.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::edit::overlay::plan_edges;
use crate::edit::{EditError, fail, move_corners, settle};
use crate::geometry::{Point, Segment, polygon, trim_m};
use crate::plan::{CornerId, ElementId, LeafSide, OpeningId, OpeningKind, Place, Plan, Swing, WallId};

/// An end of a wall, or of an opening along its wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    Start,
    End,
}

impl End {
    pub const BOTH: [Self; 2] = [Self::Start, Self::End];

    /// The end of a segment.
    pub const fn of(self, segment: Segment) -> Point {
        match self {
            Self::Start => segment.a,
            Self::End => segment.b,
        }
    }

    pub const fn other(self) -> Self {
        match self {
            Self::Start => Self::End,
            Self::End => Self::Start,
        }
    }
}

/// The way along a wall from an end of an opening to the next thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beside {
    /// From the opening's end to the next opening, or to the face of the wall that the opening's wall meets there, or
    /// to its own end.
    pub way: Segment,
    /// Its length in metres; negative where the two overlap.
    pub distance_m: f64,
    /// Whether another opening is there.
    pub is_opening: bool,
}

/// An opening narrower than this is none, in metres.
pub const NARROWEST_OPENING_M: f64 = 0.1;

/// A line along an edge that hosts openings.
struct Line {
    edge: Segment,
    along: crate::geometry::Vector,
    length_m: f64,
}

impl Line {
    fn of(plan: &Plan, from: CornerId, to: CornerId) -> Option<Self> {
        let edge = Segment::new(plan.position(from)?, plan.position(to)?);
        Some(Self { edge, along: edge.vector().unit()?, length_m: edge.length() })
    }

    fn at(&self, point: Point) -> f64 {
        (point - self.edge.a).dot(self.along)
    }

    fn point(&self, at_m: f64) -> Point {
        self.edge.a + self.along * at_m
    }
}

/// How far the walls that meet an edge at a corner reach along it, in metres: to the face of the thickest.
fn reach_m(plan: &Plan, corner: CornerId, line: &Line) -> f64 {
    let ending = plan.walls().filter(|(_, wall)| wall.from == corner || wall.to == corner);
    let reaches = ending.filter_map(|(_, wall)| {
        let way = plan.wall_segment(wall)?.vector().unit()?;
        let sine = way.cross(line.along).abs();
        // One that goes on in line with it has no face there.
        (sine > 0.3).then(|| wall.thickness_m / 2.0 / sine)
    });
    reaches.fold(0.0, f64::max)
}

/// What lies beside an opening on its edge, before its start and behind its end; `width_m` and `at_m` are those of the
/// opening, or those it is about to get.
fn sides_at(plan: &Plan, id: OpeningId, at_m: f64, width_m: f64) -> Option<[Beside; 2]> {
    let Place::Hosted { from, to, .. } = plan.opening(id)?.place else { return None };
    let line = Line::of(plan, from, to)?;
    let (start_m, end_m) = (at_m - width_m / 2.0, at_m + width_m / 2.0);
    let mut before = (reach_m(plan, from, &line), false);
    let mut behind = (line.length_m - reach_m(plan, to, &line), false);
    for (other, opening) in plan.openings() {
        let is_beside = matches!(opening.place, Place::Hosted { from: p, to: q, .. } if [p, q] == [from, to] || [p, q] == [to, from]);
        // Of all others not even the place is looked up: this is asked in each frame.
        let beside = (is_beside && other != id).then_some(opening);
        let Some(segment) = beside.and_then(|opening| plan.opening_segment(opening)) else { continue };
        let ends = [line.at(segment.a), line.at(segment.b)];
        let (least, most) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        if (least + most) / 2.0 <= at_m {
            before = if most > before.0 { (most, true) } else { before };
        } else {
            behind = if least < behind.0 { (least, true) } else { behind };
        }
    }
    let way = |own_m: f64, (there_m, is_opening): (f64, bool), distance_m: f64| Beside {
        way: Segment::new(line.point(own_m), line.point(there_m)),
        distance_m: trim_m(distance_m),
        is_opening,
    };
    Some([way(start_m, before, start_m - before.0), way(end_m, behind, behind.0 - end_m)])
}

/// What lies beside an opening on its edge, before its start and behind its end; `None` for one that is in no wall.
pub fn beside_opening(plan: &Plan, id: OpeningId) -> Option<[Beside; 2]> {
    let Place::Hosted { at_m, width_m, .. } = plan.opening(id)?.place else { return None };
    sides_at(plan, id, at_m, width_m)
}

/// Moves an opening along its wall so that one of its ends is so far from what lies beside it, in metres.
///
/// # Errors
/// When the opening does not exist or is in no wall, or the wall has no space for that.
pub fn set_opening_distance(plan: &Plan, id: OpeningId, end: End, distance_m: f64) -> Result<Plan, EditError> {
    let (from, to, at_m, width_m) = hosted(plan, id)?;
    let Some([before, behind]) = sides_at(plan, id, at_m, width_m) else {
        return fail("the opening's wall has no length");
    };
    let by_m = match end {
        End::Start => distance_m - before.distance_m,
        End::End => behind.distance_m - distance_m,
    };
    let room_m = before.distance_m + behind.distance_m;
    if !(0.0..=room_m.max(0.0) + crate::geometry::GRID_M).contains(&distance_m) {
        return fail(format!("there are {:.2} m beside the opening, not {distance_m} m", room_m.max(0.0)));
    }
    placed(plan, id, Place::Hosted { from, to, at_m: trim_m(at_m + by_m), width_m })
}

/// Moves one end of an opening along its wall as near to a point as what lies beside it allows; its other end stays.
///
/// # Errors
/// When the opening does not exist, or has no direction.
pub fn stretch_opening(plan: &Plan, id: OpeningId, end: End, towards: Point) -> Result<Plan, EditError> {
    let Some(opening) = plan.opening(id) else { return fail(format!("the opening {id} does not exist")) };
    if let Place::Free { from, to } = opening.place {
        let segment = Segment::new(from, to);
        let Some(along) = segment.vector().unit() else { return fail("the opening has no direction") };
        let stays = end.other().of(segment);
        let outwards = if end == End::End { along } else { -along };
        let moved = stays + outwards * (towards - stays).dot(outwards).max(NARROWEST_OPENING_M);
        let (from, to) = if end == End::End { (stays, moved) } else { (moved, stays) };
        return placed(plan, id, Place::Free { from: from.trimmed(), to: to.trimmed() });
    }
    let (from, to, at_m, width_m) = hosted(plan, id)?;
    let (Some(line), Some([before, behind])) = (Line::of(plan, from, to), sides_at(plan, id, at_m, width_m)) else {
        return fail("the opening's wall has no length");
    };
    let (start_m, end_m) = (at_m - width_m / 2.0, at_m + width_m / 2.0);
    // What overlaps something already may stay so, and grow no further.
    let (least_m, most_m) = (start_m - before.distance_m.max(0.0), end_m + behind.distance_m.max(0.0));
    let narrowest_m = NARROWEST_OPENING_M.min(width_m);
    let (start_m, end_m) = match end {
        End::Start => (line.at(towards).clamp(least_m, (end_m - narrowest_m).max(least_m)), end_m),
        End::End => (start_m, line.at(towards).clamp((start_m + narrowest_m).min(most_m), most_m)),
    };
    let place = Place::Hosted { from, to, at_m: trim_m((start_m + end_m) / 2.0), width_m: trim_m(end_m - start_m) };
    placed(plan, id, place)
}

/// Sets a wall's length in metres: one of its ends moves along it, with the walls that meet it there at a right angle.
///
/// # Errors
/// When the wall does not exist or has no length, or a room would lose its shape.
pub fn set_wall_length(plan: &Plan, id: WallId, length_m: f64, moves: End) -> Result<Plan, EditError> {
    let Some(wall) = plan.wall(id) else { return fail(format!("the wall {id} does not exist")) };
    let Some((segment, along)) = plan.wall_segment(wall).and_then(|segment| Some((segment, segment.vector().unit()?)))
    else {
        return fail("the wall has no length");
    };
    if !(length_m.is_finite() && trim_m(length_m) > 0.0) {
        return fail("a wall's length is above 0");
    }
    let (corner, outwards) = if moves == End::End { (wall.to, along) } else { (wall.from, -along) };
    let stays = if moves == End::End { wall.from } else { wall.to };
    let by = outwards * (length_m - segment.length());
    let moved = across(plan, corner, outwards);
    if moved.contains(&stays) {
        return fail("both ends of the wall would move");
    }
    let targets: Vec<(CornerId, Point)> =
        moved.iter().filter_map(|&corner| Some((corner, plan.position(corner)? + by))).collect();
    let next = move_corners(plan, &targets)?;
    for (room, shape) in
        plan.rooms().filter(|(_, room)| room.rings().any(|ring| ring.iter().any(|it| moved.contains(it))))
    {
        let area_m2 = |plan: &Plan| polygon::signed_area(&plan.ring_points(&shape.outer));
        if area_m2(plan) * area_m2(&next) <= 0.0 {
            return fail(format!(
                "{} would be turned inside out",
                crate::plan::titles::title_of(plan, ElementId::Room(room))
            ));
        }
    }
    settle(&next, &moved)
}

/// The corners that move with one when it goes along a direction: those of the straight line across.
fn across(plan: &Plan, corner: CornerId, along: crate::geometry::Vector) -> BTreeSet<CornerId> {
    /// The cosine of an angle this near to a right one: a degree.
    const RIGHT: f64 = 0.017;
    let crossing: Vec<(CornerId, CornerId)> = plan_edges(plan)
        .filter(|&(p, q)| {
            let way = plan.position(p).zip(plan.position(q)).and_then(|(a, b)| (b - a).unit());
            way.is_some_and(|way| way.dot(along).abs() < RIGHT)
        })
        .collect();
    let mut found = BTreeSet::from([corner]);
    let mut ends = vec![corner];
    while let Some(end) = ends.pop() {
        for &(p, q) in &crossing {
            let next = if p == end {
                q
            } else if q == end {
                p
            } else {
                continue;
            };
            if found.insert(next) {
                ends.push(next);
            }
        }
    }
    found
}

/// Sets at which end a door is hinged, or to which side it opens; `shown` is its swing as drawn, for a door whose swing
/// is left to the drawing code.
///
/// # Errors
/// When the opening does not exist, or is no door.
pub fn change_swing(
    plan: &Plan,
    id: OpeningId,
    shown: Swing,
    change: impl FnOnce(Swing) -> Swing,
) -> Result<Plan, EditError> {
    let Some(opening) = plan.opening(id) else { return fail(format!("the opening {id} does not exist")) };
    if !matches!(opening.kind, OpeningKind::Door | OpeningKind::DoubleDoor) {
        return fail(format!("a {} has no leaf", opening.kind.name()));
    }
    super::set_swing(plan, id, Some(change(opening.swing.unwrap_or(shown))))
}

/// The next of the four ways in which a door can hang, of the two for a double door.
pub fn next_swing(kind: OpeningKind, swing: Swing) -> Swing {
    let is_double = kind == OpeningKind::DoubleDoor;
    match (swing.side, swing.hinge_at_start) {
        (side, _) if is_double => Swing { side: side.other(), ..swing },
        // Round: the other end, the other side, and back.
        (LeafSide::Left, true) => Swing { hinge_at_start: false, side: LeafSide::Left },
        (LeafSide::Left, false) => Swing { hinge_at_start: false, side: LeafSide::Right },
        (LeafSide::Right, false) => Swing { hinge_at_start: true, side: LeafSide::Right },
        (LeafSide::Right, true) => Swing { hinge_at_start: true, side: LeafSide::Left },
    }
}

fn hosted(plan: &Plan, id: OpeningId) -> Result<(CornerId, CornerId, f64, f64), EditError> {
    match plan.opening(id).map(|opening| opening.place) {
        None => fail(format!("the opening {id} does not exist")),
        Some(Place::Free { .. }) => fail("the opening is in no wall"),
        Some(Place::Hosted { from, to, at_m, width_m }) => Ok((from, to, at_m, width_m)),
    }
}

fn placed(plan: &Plan, id: OpeningId, place: Place) -> Result<Plan, EditError> {
    let mut next = plan.clone();
    if let Some(opening) = next.openings.get_mut(&id) {
        Arc::make_mut(opening).place = place;
    }
    Ok(next)
}
