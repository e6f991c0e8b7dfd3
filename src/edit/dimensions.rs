//! Dimension chains: drawing them, moving their line, and keeping them on what they measure.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::{EditError, Part, checked_position, fail};
use crate::geometry::{Bounds, Point, Segment, Transform, Vector, trim_m};
use crate::plan::builder::new_dimension_id;
use crate::plan::{
    CornerId, Dimension, DimensionAlong, DimensionHost, DimensionId, DimensionPoint, OpeningId, Place, Plan, RoomId,
    WallId, WallSide, ordered,
};
use crate::topology::net_of;

/// A point this near to something, in metres, lies on it: rounding to the 0.1 mm grid, at any angle.
const ON_IT_M: f64 = 5e-4;

/// Walls that stand across the line rather than along it: what is measured is where they begin and end. The cosine
/// of 45 degrees.
const ACROSS: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Draws a chain that measures between points along a line through a place. Each point holds on to what lies there:
/// an end of an opening, a wall's face or axis, a corner; a point on nothing stays where it is.
///
/// # Errors
/// When there are fewer than two points, all fall into one along the line, or one lies outside the drawing area.
pub fn draw_dimension(
    plan: &Plan,
    points: &[Point],
    along: DimensionAlong,
    through: Point,
) -> Result<(Plan, DimensionId), EditError> {
    let mut dimension = dimension_between(points, along, through)?;
    let Some(line) = plan.dimension_line(&dimension) else {
        return fail("the points coincide along the line, so there is nothing to measure");
    };
    let hosts = Hosts::new(plan);
    for point in &mut dimension.points {
        point.on = hosts.at(point.last, line.along);
    }
    let id = new_dimension_id(plan, &dimension);
    let mut next = plan.clone();
    next.dimensions.insert(id, Arc::new(dimension));
    Ok((next, id))
}

/// A chain between fixed points, not part of a plan yet: for a preview.
///
/// # Errors
/// When there are fewer than two points, the first and the last are the same and give the direction, or one lies
/// outside the drawing area.
pub fn dimension_between(points: &[Point], along: DimensionAlong, through: Point) -> Result<Dimension, EditError> {
    let fixed = |&point: &Point| Ok(DimensionPoint { on: None, last: checked_position(point)? });
    let points: Vec<DimensionPoint> = points.iter().map(fixed).collect::<Result<_, EditError>>()?;
    let [first, .., last] = points.as_slice() else { return fail("a dimension needs two points") };
    let Some(direction) = along.direction().or_else(|| (last.last - first.last).unit()) else {
        return fail("the first point and the last are the same");
    };
    let offset_m = trim_m((checked_position(through)? - first.last).dot(direction.left()));
    Ok(Dimension { points, along, offset_m, extra: None })
}

/// From the faces of a room's walls to the chains inside it, in metres: clear of the figures of a chain at a door.
const INSIDE_M: f64 = 0.4;

/// Draws two chains inside a room: of its clear width near its lower side and of its clear depth near its left one, each
/// with all corners between.
///
/// # Errors
/// When the room does not exist or encloses nothing.
pub fn dimension_room(plan: &Plan, id: RoomId) -> Result<Plan, EditError> {
    let Some(room) = plan.room(id) else { return fail(format!("the room {id} does not exist")) };
    let holes: Vec<Vec<Point>> = room.holes.iter().map(|hole| plan.ring_points(hole)).collect();
    let net = net_of(plan, &plan.ring_points(&room.outer), &holes);
    let mut corners: Vec<Point> = net.pieces.iter().flat_map(|(outer, _)| outer.iter().copied()).collect();
    let bounds = Bounds::of(corners.iter().copied());
    if bounds.is_empty() {
        return fail("the room encloses nothing");
    }
    let mut next = plan.clone();
    let inside = Vector::new(INSIDE_M.min(bounds.width() / 2.0), INSIDE_M.min(bounds.height() / 2.0));
    let through = bounds.min + inside;
    for along in [DimensionAlong::Horizontal, DimensionAlong::Vertical] {
        let direction = along.direction().unwrap_or_default();
        let place = |point: &Point| (*point - bounds.min).dot(direction);
        corners.sort_by(|p, q| place(p).total_cmp(&place(q)));
        let mut measured = corners.clone();
        measured.dedup_by(|next, kept| place(next) - place(kept) < SAME_CORNER_M);
        next = draw_dimension(&next, &measured, along, through)?.0;
    }
    Ok(next)
}

/// Corners of a room nearer to each other along a chain, in metres, are one: a layer of plaster.
const SAME_CORNER_M: f64 = 0.02;

/// Moves the line of a chain through a place; what it measures stays.
///
/// # Errors
/// When the chain does not exist, measures nothing, or the place lies outside the drawing area.
pub fn move_dimension(plan: &Plan, id: DimensionId, through: Point) -> Result<Plan, EditError> {
    let through = checked_position(through)?;
    let Some(dimension) = plan.dimension(id) else { return fail(format!("the dimension {id} does not exist")) };
    let Some(line) = plan.dimension_line(dimension) else { return fail("the dimension measures nothing") };
    let first = dimension.points.first().map_or(through, |point| plan.dimension_point(point));
    let offset_m = trim_m((through - first).dot(line.along.left()));
    let mut next = plan.clone();
    next.dimensions.insert(id, Arc::new(Dimension { offset_m, ..dimension.clone() }));
    Ok(next)
}

/// A selected chain after what is selected moved: its line moves along, and what it measures on nothing; what it
/// measures on elements follows those.
pub(super) fn transformed(
    before: &Plan,
    after: &Plan,
    id: DimensionId,
    transform: Transform,
) -> Result<Plan, EditError> {
    let (Some(dimension), Some(line)) =
        (before.dimension(id), before.dimension(id).and_then(|it| before.dimension_line(it)))
    else {
        return Ok(after.clone());
    };
    // As it is there: its walls may have changed sides.
    let mut moved = after.dimension(id).unwrap_or(dimension).clone();
    for point in moved.points.iter_mut().filter(|point| point.on.is_none()) {
        point.last = checked_position(transform.point(point.last))?;
    }
    moved.along = moved.along.turned(transform.vector(Vector::new(1.0, 0.0)));
    // A shared corner stays with the neighbour: what moved has one of its own.
    let left = |point: &DimensionPoint| {
        let (Some(host @ DimensionHost::Corner(_)), Some(was)) = (point.on, point.on.and_then(|it| before.on_host(it)))
        else {
            return None;
        };
        let to = transform.point(was).trimmed();
        after.on_host(host).is_none_or(|now| now.distance(to) > ON_IT_M).then_some(to)
    };
    let mut hosts: Option<Hosts> = None;
    for point in &mut moved.points {
        if let Some(to) = left(point)
            && let Some(on) = hosts.get_or_insert_with(|| Hosts::new(after)).at(to, transform.vector(line.along))
        {
            *point = DimensionPoint { on: Some(on), last: to };
        }
    }
    let mut next = after.clone();
    next.dimensions.insert(id, Arc::new(moved));
    match line.ticks.first() {
        Some((_, on_line)) => move_dimension(&next, id, transform.point(*on_line)).or(Ok(next)),
        None => Ok(next),
    }
}

/// The plan in which the chains measure to the other faces of walls that were mirrored: what was left is right.
pub(super) fn on_other_sides(mut plan: Plan, walls: &BTreeSet<WallId>) -> Plan {
    let is_mirrored =
        |point: &DimensionPoint| matches!(point.on, Some(DimensionHost::Wall { wall, .. }) if walls.contains(&wall));
    let changed: Vec<(DimensionId, Dimension)> = plan
        .dimensions()
        .filter(|(_, dimension)| dimension.points.iter().any(is_mirrored))
        .map(|(id, dimension)| (id, dimension.clone()))
        .collect();
    for (id, mut dimension) in changed {
        for point in dimension.points.iter_mut().filter(|point| is_mirrored(point)) {
            if let Some(DimensionHost::Wall { side, .. }) = &mut point.on {
                *side = match *side {
                    WallSide::Left => WallSide::Right,
                    WallSide::Axis => WallSide::Axis,
                    WallSide::Right => WallSide::Left,
                };
            }
        }
        plan.dimensions.insert(id, Arc::new(dimension));
    }
    plan
}

/// The chains that measure nothing but a part of a plan: they are turned and mirrored with it.
pub(super) fn chains_on(plan: &Plan, part: &Part) -> Vec<DimensionId> {
    let is_of = |point: &DimensionPoint| match point.on {
        Some(DimensionHost::Corner(id)) => part.corners.contains(&id),
        Some(DimensionHost::Wall { wall, .. }) => part.walls.contains(&wall),
        Some(DimensionHost::Opening { opening, .. }) => part.openings.contains(&opening),
        None => false,
    };
    plan.dimensions().filter(|(_, dimension)| dimension.points.iter().all(is_of)).map(|(id, _)| id).collect()
}

/// The chains of a fragment in the plan that now has all else of it, holding on to what lies there; and their ids.
pub(super) fn insert_chains(
    plan: Plan,
    fragment: &Plan,
    transform: Transform,
) -> Result<(Plan, Vec<DimensionId>), EditError> {
    let mut placed = Vec::new();
    if fragment.dimensions.is_empty() {
        return Ok((plan, placed));
    }
    let hosts = Hosts::new(&plan);
    let mut next = plan.clone();
    let right = transform.vector(Vector::new(1.0, 0.0));
    for (id, dimension) in fragment.dimensions() {
        let Some(line) = fragment.dimension_line(dimension) else { continue };
        let Some((_, on_line)) = line.ticks.first() else { continue };
        let along = match right.x.abs().min(right.y.abs()) < ON_IT_M {
            true => dimension.along.turned(right),
            // Neither level nor upright any more.
            false => DimensionAlong::Aligned,
        };
        let mut ordered: Vec<(Point, bool)> =
            dimension.points.iter().map(|point| (fragment.dimension_point(point), point.on.is_some())).collect();
        if along == DimensionAlong::Aligned && dimension.along != along {
            ordered.sort_by(|p, q| (p.0 - *on_line).dot(line.along).total_cmp(&(q.0 - *on_line).dot(line.along)));
        }
        let moved: Vec<Point> = ordered.iter().map(|(point, _)| transform.point(*point)).collect();
        let mut chain = dimension_between(&moved, along, transform.point(*on_line))?;
        let direction = next.dimension_line(&chain).map(|line| line.along);
        for (point, (_, is_held)) in chain.points.iter_mut().zip(ordered) {
            point.on = direction.filter(|_| is_held).and_then(|direction| hosts.at(point.last, direction));
        }
        chain.extra.clone_from(&dimension.extra);
        let id = if next.dimensions.contains_key(&id) { new_dimension_id(&next, &chain) } else { id };
        next.dimensions.insert(id, Arc::new(chain));
        placed.push(id);
    }
    Ok((next, placed))
}

/// What became of the chains of a plan after an edit.
#[derive(Clone, Debug)]
pub struct Settled {
    pub plan: Plan,
    /// How many points lost what they were on, and stay where they were.
    pub fixed: usize,
}

/// The chains of a plan after an edit of something else: each point notes where it is now; one whose wall, corner or
/// opening is gone takes what lies there instead, such as the wall that one was joined with, else it stays where it
/// was before.
pub fn settle_dimensions(before: &Plan, after: Plan) -> Settled {
    if after.dimensions.is_empty() || before.is_same_value(&after) {
        return Settled { plan: after, fixed: 0 };
    }
    let mut hosts: Option<Hosts> = None;
    let mut fixed = 0;
    let mut changed = Vec::new();
    for (id, dimension) in after.dimensions() {
        let along = before.dimension(id).and_then(|earlier| before.dimension_line(earlier)).map(|line| line.along);
        let settle = |point: &DimensionPoint| {
            let Some(host) = point.on else { return *point };
            if let Some(now) = after.on_host(host) {
                return DimensionPoint { last: now.trimmed(), ..*point };
            }
            let last = before.on_host(host).unwrap_or(point.last).trimmed();
            let direction = along.unwrap_or(Vector::new(1.0, 0.0));
            let on = hosts.get_or_insert_with(|| Hosts::new(&after)).at(last, direction);
            fixed += usize::from(on.is_none());
            DimensionPoint { on, last }
        };
        let points: Vec<DimensionPoint> = dimension.points.iter().map(settle).collect();
        if points != dimension.points {
            changed.push((id, Dimension { points, ..dimension.clone() }));
        }
    }
    let mut plan = after.clone();
    for (id, dimension) in changed {
        plan.dimensions.insert(id, Arc::new(dimension));
    }
    Settled { plan, fixed }
}

/// What a point of a chain can be on.
struct Hosts {
    corners: Vec<(CornerId, Point)>,
    walls: Vec<(WallId, Segment, f64)>,
    openings: Vec<(OpeningId, Segment, f64)>,
}

impl Hosts {
    fn new(plan: &Plan) -> Self {
        let walls: Vec<(WallId, Segment, f64)> = plan
            .walls()
            .filter_map(|(id, wall)| Some((id, plan.wall_segment(wall)?, wall.thickness_m / 2.0)))
            .collect();
        let thickness_m: BTreeMap<[CornerId; 2], f64> =
            plan.walls().map(|(_, wall)| (ordered(wall.from, wall.to), wall.thickness_m)).collect();
        let opening = |(id, opening): (OpeningId, &crate::plan::Opening)| {
            let half_m = match opening.place {
                Place::Hosted { from, to, .. } => thickness_m.get(&ordered(from, to)).copied().unwrap_or(0.0) / 2.0,
                Place::Free { .. } => 0.0,
            };
            Some((id, plan.opening_segment(opening)?, half_m))
        };
        Self {
            corners: plan.corners().map(|(id, corner)| (id, corner.position)).collect(),
            walls,
            openings: plan.openings().filter_map(opening).collect(),
        }
    }

    /// What a point is on, for a chain along a direction.
    fn at(&self, point: Point, along: Vector) -> Option<DimensionHost> {
        self.opening_at(point, along).or_else(|| self.wall_at(point, along)).or_else(|| {
            let near = self.corners.iter().filter(|(_, corner)| corner.distance(point) <= ON_IT_M);
            near.map(|(id, _)| DimensionHost::Corner(*id)).next()
        })
    }

    /// The end of an opening in a wall along the line.
    fn opening_at(&self, point: Point, along: Vector) -> Option<DimensionHost> {
        self.openings.iter().find_map(|&(opening, segment, half_m)| {
            let way = segment.vector().unit()?;
            let is_end = |end: Point| {
                (point - end).dot(way).abs() <= ON_IT_M && (point - end).cross(way).abs() <= half_m + ON_IT_M
            };
            let is_start = is_end(segment.a);
            let is_at = way.dot(along).abs() > ACROSS && (is_start || is_end(segment.b));
            is_at.then_some(DimensionHost::Opening { opening, is_start })
        })
    }

    /// A face or the axis of a wall that stands across the line, the squarest first.
    fn wall_at(&self, point: Point, along: Vector) -> Option<DimensionHost> {
        let on = self.walls.iter().filter_map(|&(wall, axis, half_m)| {
            let way = axis.vector().unit()?;
            let at_m = (point - axis.a).dot(way);
            let aside_m = way.cross(point - axis.a);
            // To where the faces of another wall may end, around a corner.
            let is_beside = (-2.0 * half_m - ON_IT_M..=axis.length() + 2.0 * half_m + ON_IT_M).contains(&at_m);
            let side =
                WallSide::ALL.into_iter().find(|side| (aside_m - side.off_axis_m(2.0 * half_m)).abs() <= ON_IT_M)?;
            let askew = way.dot(along).abs();
            (is_beside && askew < ACROSS).then_some((
                askew,
                wall,
                DimensionHost::Wall { wall, side, at_m: trim_m(at_m) },
            ))
        });
        on.min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1))).map(|(_, _, host)| host)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit;
    use crate::plan::{Builder, ElementId, Meta, Opening, OpeningKind, Room};

    /// A wall of 6 m with a door, walls of 0.24 m at its ends and a partition in between.
    fn plan() -> Plan {
        let mut builder = Builder::new(Meta::default());
        let at = |x, y| Point::new(x, y);
        let c = [at(0.0, 0.0), at(6.0, 0.0), at(0.0, 4.0), at(6.0, 4.0), at(4.0, 0.0), at(4.0, 4.0)]
            .map(|point| builder.corner(point));
        builder.wall(c[0], c[4], 0.24);
        builder.wall(c[4], c[1], 0.24);
        builder.wall(c[0], c[2], 0.24);
        builder.wall(c[1], c[3], 0.24);
        builder.wall(c[4], c[5], 0.1);
        let place = Place::Hosted { from: c[0], to: c[4], at_m: 2.0, width_m: 0.9 };
        builder.opening("", Opening::new(OpeningKind::Door, place));
        builder.finish().expect("a sound plan")
    }

    fn lengths(plan: &Plan, id: DimensionId) -> Vec<f64> {
        let line = plan.dimension_line(plan.dimension(id).expect("it is there")).expect("it measures");
        line.lengths_m().map(trim_m).collect()
    }

    fn drawn() -> (Plan, DimensionId) {
        let points = [(0.12, 0.12), (1.55, 0.12), (2.45, 0.12), (3.95, 0.12), (4.05, 0.12), (5.88, 0.12)]
            .map(|(x, y)| Point::new(x, y));
        draw_dimension(&plan(), &points, DimensionAlong::Horizontal, Point::new(0.0, 1.0)).expect("it measures")
    }

    #[test]
    fn a_chain_follows_walls_and_doors() {
        let (plan, id) = drawn();
        assert_eq!(lengths(&plan, id), [1.43, 0.9, 1.5, 0.1, 1.83]);
        assert!(plan.dimension(id).expect("it is there").points.iter().all(|point| point.on.is_some()));
        assert_eq!(plan.violations(), Vec::new());
        // The partition moves by half a metre, and becomes thicker.
        let corners: Vec<(CornerId, Point)> = plan
            .corners()
            .filter(|(_, corner)| corner.position.x == 4.0)
            .map(|(id, corner)| (id, corner.position + Vector::new(0.5, 0.0)))
            .collect();
        let moved = settle_dimensions(&plan, edit::move_corners(&plan, &corners).expect("they move")).plan;
        assert_eq!(lengths(&moved, id), [1.43, 0.9, 2.0, 0.1, 1.33]);
        let partition: Vec<WallId> =
            moved.walls().filter(|(_, wall)| wall.thickness_m == 0.1).map(|(id, _)| id).collect();
        let thicker = edit::set_thickness(&moved, &partition, 0.24).expect("it becomes thicker");
        assert_eq!(lengths(&thicker, id), [1.43, 0.9, 1.93, 0.24, 1.26]);
    }

    #[test]
    fn what_loses_its_wall_stays_where_it_was() {
        let (plan, id) = drawn();
        let partition: Vec<ElementId> =
            plan.walls().filter(|(_, wall)| wall.thickness_m == 0.1).map(|(id, _)| ElementId::Wall(id)).collect();
        let settled = settle_dimensions(&plan, edit::remove(&plan, &partition).expect("it goes"));
        assert_eq!(settled.fixed, 2);
        assert_eq!(lengths(&settled.plan, id), [1.43, 0.9, 1.5, 0.1, 1.83]);
        assert_eq!(settled.plan.violations(), Vec::new());
    }

    #[test]
    fn a_room_gets_chains_of_its_clear_sizes() {
        let mut builder = Builder::new(Meta::default());
        let corners = [(0.0, 0.0), (5.0, 0.0), (5.0, 2.0), (3.0, 2.0), (3.0, 4.0), (0.0, 4.0)];
        let outer = builder.ring(corners.map(|(x, y)| Point::new(x, y)));
        for i in 0..6 {
            builder.wall(outer[i], outer[(i + 1) % 6], 0.2);
        }
        let room = builder.room("", Room { outer, ..Room::default() });
        let plan = dimension_room(&builder.finish().expect("a sound plan"), room).expect("it is measured");
        let mut chains: Vec<Vec<f64>> = plan.dimensions().map(|(id, _)| lengths(&plan, id)).collect();
        chains.sort_by(|p, q| p[0].total_cmp(&q[0]));
        assert_eq!(chains, [[1.8, 2.0], [2.8, 2.0]]);
        let all = plan.dimensions().flat_map(|(_, chain)| &chain.points);
        assert!(all.into_iter().all(|point| point.on.is_some()));
    }

    #[test]
    fn the_line_moves_and_what_is_measured_stays() {
        let (plan, id) = drawn();
        let moved = move_dimension(&plan, id, Point::new(7.0, -2.0)).expect("it moves");
        let line = moved.dimension_line(moved.dimension(id).expect("it is there")).expect("it measures");
        assert!(line.ticks.iter().all(|(_, on_line)| on_line.y == -2.0));
        assert_eq!(lengths(&moved, id), lengths(&plan, id));
        for (points, along) in [
            (vec![Point::new(0.0, 0.0)], DimensionAlong::Vertical),
            (vec![Point::new(0.0, 0.0), Point::new(6.0, 0.0)], DimensionAlong::Vertical),
            (vec![Point::new(1.0, 0.0); 2], DimensionAlong::Aligned),
            (vec![Point::new(1.0, 0.0), Point::new(f64::NAN, 0.0)], DimensionAlong::Horizontal),
        ] {
            assert!(draw_dimension(&plan, &points, along, Point::new(0.0, 1.0)).is_err(), "{points:?}");
        }
    }
}
