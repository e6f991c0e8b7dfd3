//! Dragging corners and walls: what shares them follows, and stays straight.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::edit::overlay::plan_edges;
use crate::edit::refit::{Changed, beside_each_other, refit, wanted_middles};
use crate::edit::weld::settle;
use crate::edit::{EditError, add_wall, checked_position, fail};
use crate::geometry::{GRID_M, Point, Segment, TOUCH_M, Vector, polygon};
use crate::plan::{Corner, CornerId, OpeningId, Place, Plan, WallId, builder::new_corner_id, ordered};

/// How much of a straight run of walls is dragged by one of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// The whole run.
    #[default]
    Run,
    /// Only that wall: where the run goes on, a short wall at right angles joins the two, so that nothing tilts.
    Piece,
}

/// Moves corners, and with them every wall, room and hosted opening that uses them. Openings stay where they
/// are in the plan unless both ends of their edge move; then they keep their place along it. One that no longer
/// fits its edge is moved to fit, or made narrower.
///
/// # Errors
/// When a corner does not exist, a target lies outside the drawing area, or an edge hosting an opening
/// would lose its length or leave it no space.
pub fn move_corners(plan: &Plan, targets: &[(CornerId, Point)]) -> Result<Plan, EditError> {
    Ok(moved(plan, targets)?.plan)
}

/// As [`move_corners`], saying what became of openings.
fn moved(plan: &Plan, targets: &[(CornerId, Point)]) -> Result<Changed, EditError> {
    let mut next = plan.clone();
    let mut moved = BTreeMap::new();
    for &(id, point) in targets {
        let position = checked_position(point)?;
        let Some(corner) = next.corners.get_mut(&id) else { return fail(format!("the corner {id} does not exist")) };
        if corner.position != position {
            corner.position = position;
            moved.insert(id, position);
        }
    }
    if moved.is_empty() {
        return Ok(Changed::plainly(next));
    }
    let (plan, refitted) = refit(plan, next, &wanted_middles(plan, &moved))?;
    Ok(Changed { plan, refitted })
}

/// Drags corners to other places: everything that shares them follows. What comes to rest on something else
/// shares its corners, see [`settle`].
///
/// # Errors
/// As [`move_corners`], and when a room would turn inside out or cross itself.
pub fn drag_corners(plan: &Plan, targets: &[(CornerId, Point)]) -> Result<Changed, EditError> {
    let Changed { plan: next, refitted } = moved(plan, targets)?;
    let corners: BTreeSet<CornerId> = targets.iter().map(|&(id, _)| id).collect();
    settled(plan, &next, &corners, refitted)
}

/// Joins what was dragged with what it came to rest on, and checks the rooms.
fn settled(
    before: &Plan,
    moved: &Plan,
    corners: &BTreeSet<CornerId>,
    mut refitted: Vec<crate::edit::Refitted>,
) -> Result<Changed, EditError> {
    let next =
        settle(moved, corners).map_err(|_| EditError("a room would be squeezed flat: move it less far".to_owned()))?;
    check_rooms(before, &next, corners, "this")?;
    // Where an edge was divided, its openings may now reach beyond their part.
    let divided: BTreeSet<OpeningId> = next
        .openings()
        .filter(|(id, opening)| moved.opening(*id).is_some_and(|before| before.place != opening.place))
        .map(|(id, _)| id)
        .collect();
    let wanted = divided.iter().filter_map(|&id| Some((id, moved.opening_segment(moved.opening(id)?)?.midpoint())));
    let (next, fitted) = refit(moved, next, &wanted.collect())?;
    refitted.extend(fitted);
    let (plan, left) = beside_each_other(next, divided);
    if let Some(lost) = left.iter().find(|one| one.how == crate::edit::Refit::LeftOut) {
        let kind = lost.kind.name();
        return fail(format!("a {kind} would meet another opening: move or narrow one of them first"));
    }
    refitted.extend(left);
    Ok(Changed { plan, refitted })
}

/// Walls and corners being dragged: which corners go where. Made once, when the drag begins.
#[derive(Clone, Debug)]
pub struct WallDrag {
    lines: Vec<Line>,
    /// Corners dragged as such.
    loose: Vec<(CornerId, Point)>,
    /// For a single piece of a longer run: the wall, and its ends at which the run goes on.
    piece: Option<(WallId, [bool; 2])>,
}

/// A dragged wall and the straight run that it is part of.
#[derive(Clone, Debug)]
struct Line {
    along: Vector,
    ends: [CornerId; 2],
    /// The corners of the run, each with the direction that it slides along, if what it stands on has one.
    corners: Vec<(CornerId, Point, Option<Vector>)>,
}

/// Directions within two degrees are in line: walls drawn by hand are straight to about one.
const IN_LINE_COS: f64 = 0.999_4;

/// Anything within 15 degrees of the run's own direction is along it: a corner that slid along that would go far, and a
/// run dragged that way would only be stretched.
const ALONG_SIN: f64 = 0.26;

impl WallDrag {
    /// The drag of walls and loose corners; `None` if none of them exists. A wall takes the straight run that it
    /// is part of along.
    pub fn new(plan: &Plan, walls: &BTreeSet<WallId>, corners: &BTreeSet<CornerId>, reach: Reach) -> Option<Self> {
        let around = Around::new(plan);
        let is_single = walls.len() == 1 && corners.is_empty();
        let mut drag = Self { lines: Vec::new(), loose: Vec::new(), piece: None };
        drag.loose.extend(corners.iter().filter_map(|&id| Some((id, plan.position(id)?))));
        for (&id, wall) in walls.iter().filter_map(|id| Some((id, plan.wall(*id)?))) {
            let ends = [wall.from, wall.to];
            let (Some(along), Some(run)) = (around.way(ends[0], ends[1]), around.run(ends[0], ends[1])) else {
                // A wall without length moves as its corners do.
                drag.loose.extend(ends.iter().filter_map(|&id| Some((id, plan.position(id)?))));
                continue;
            };
            let in_run: BTreeSet<CornerId> = run.iter().copied().collect();
            let joints = ends.map(|corner| run.first() != Some(&corner) && run.last() != Some(&corner));
            if is_single && reach == Reach::Piece && joints != [false; 2] {
                drag.piece = Some((id, joints));
            }
            let moving = if drag.piece.is_some() { ends.to_vec() } else { run };
            let corners = moving.into_iter().filter_map(|corner| {
                let slides = if is_single { around.slides_along(corner, &in_run, along) } else { None };
                Some((corner, plan.position(corner)?, slides))
            });
            let corners = corners.collect();
            drag.lines.push(Line { along, ends, corners });
        }
        (!drag.lines.is_empty() || !drag.loose.is_empty()).then_some(drag)
    }

    /// Where the corners go. A run dragged across itself slides with its corners along what they stand on, so that
    /// that stays straight; one dragged otherwise takes them the same way.
    pub fn targets(&self, by: Vector) -> Vec<(CornerId, Point)> {
        let mut targets: BTreeMap<CornerId, Point> = self.loose.iter().map(|&(id, at)| (id, at + by)).collect();
        for Line { along, ends, corners } in &self.lines {
            let across = along.left();
            let is_across = (by - across * by.dot(across)).length() <= GRID_M;
            let is_stretched = by.dot(across).abs() < ALONG_SIN * by.length();
            for &(id, at, slides) in corners {
                let to = match slides {
                    Some(slides) if is_across => at + slides * (by.dot(across) / slides.dot(across)),
                    _ if is_stretched && !ends.contains(&id) => continue,
                    _ => at + by,
                };
                targets.entry(id).or_insert(to);
            }
        }
        targets.into_iter().collect()
    }

    /// The joints that appear where a piece is dragged out of its run: from where it was to where it is.
    pub fn joints(&self, plan: &Plan, by: Vector) -> Vec<Segment> {
        let Some((id, joints)) = self.piece else { return Vec::new() };
        let ends = plan.wall(id).map(|wall| [wall.from, wall.to]).into_iter().flatten().zip(joints);
        let places = ends.filter(|(_, goes_on)| *goes_on).filter_map(|(corner, _)| plan.position(corner));
        places.map(|at| Segment::new(at, at + by)).collect()
    }

    /// Whether only a piece of a run is dragged.
    pub fn is_of_a_piece(&self) -> bool {
        self.piece.is_some()
    }

    /// The dragged plan.
    ///
    /// # Errors
    /// As [`drag_corners`].
    pub fn apply(&self, plan: &Plan, by: Vector) -> Result<Changed, EditError> {
        match self.piece {
            Some((id, joints)) => self.apply_to_piece(plan, id, joints, by),
            None => drag_corners(plan, &self.targets(by)),
        }
    }

    /// Takes one wall out of its run, and joins it with the rest by walls at right angles.
    fn apply_to_piece(&self, plan: &Plan, id: WallId, joints: [bool; 2], by: Vector) -> Result<Changed, EditError> {
        let (Some(wall), [Line { along, .. }]) = (plan.wall(id).cloned(), self.lines.as_slice()) else {
            return fail("the wall is gone");
        };
        let by = along.left() * by.dot(along.left());
        if by.length() <= TOUCH_M {
            return Ok(Changed::plainly(plan.clone()));
        }
        let ends = [wall.from, wall.to];
        let mut next = plan.clone();
        let mut now = ends;
        let mut moving: BTreeSet<CornerId> = BTreeSet::new();
        for (end, goes_on) in now.iter_mut().zip(joints) {
            if goes_on {
                let Some(at) = plan.position(*end) else { continue };
                let position = checked_position(at + by)?;
                let new = new_corner_id(&next, position);
                next.corners.insert(new, Corner { position, extra: None });
                *end = new;
            }
            moving.insert(*end);
        }
        let edge = ordered(ends[0], ends[1]);
        let on_edge: Vec<WallId> =
            plan.walls().filter(|(_, one)| ordered(one.from, one.to) == edge).map(|(id, _)| id).collect();
        let becomes = |corner: CornerId| if corner == ends[0] { now[0] } else { now[1] };
        for id in on_edge {
            if let Some(wall) = next.walls.get_mut(&id) {
                (wall.from, wall.to) = (becomes(wall.from), becomes(wall.to));
            }
        }
        let rooms: Vec<_> =
            plan.rooms().filter(|(_, room)| crate::edit::draw::room_edges(room).contains(&edge)).collect();
        for (id, room) in rooms {
            let mut changed = room.clone();
            for ring in std::iter::once(&mut changed.outer).chain(&mut changed.holes) {
                let mut through = Vec::with_capacity(ring.len() + 2);
                for (a, b) in crate::plan::ring_edges(ring) {
                    through.push(a);
                    if ordered(a, b) == edge {
                        // Where an end itself moves it is there already.
                        through.extend([becomes(a), becomes(b)].into_iter().filter(|corner| !ends.contains(corner)));
                    }
                }
                *ring = through.into();
            }
            next.rooms.insert(id, Arc::new(changed));
        }
        let mut hosted = BTreeMap::new();
        for (id, opening) in plan.openings() {
            let Place::Hosted { from, to, at_m, width_m } = opening.place else { continue };
            if ordered(from, to) == edge
                && let Some(shared) = next.openings.get_mut(&id)
                && let Some(segment) = plan.opening_segment(opening)
            {
                Arc::make_mut(shared).place = Place::Hosted { from: becomes(from), to: becomes(to), at_m, width_m };
                hosted.insert(id, segment.midpoint() + by);
            }
        }
        // Ends of the run slide along what they stand on.
        let mut slid = BTreeMap::new();
        for (corner, to) in self.targets(by) {
            if now.contains(&corner) {
                let position = checked_position(to)?;
                if let Some(end) = next.corners.get_mut(&corner) {
                    end.position = position;
                }
                slid.insert(corner, position);
            }
        }
        let mut wanted = wanted_middles(plan, &slid);
        wanted.extend(hosted);
        let (mut next, refitted) = refit(plan, next, &wanted)?;
        for ((from, to), goes_on) in ends.into_iter().zip(now).zip(joints) {
            if goes_on && !stands_towards(plan, from, by) {
                next = add_wall(&next, from, to, wall.thickness_m)?.0;
            }
        }
        settled(plan, &next, &moving, refitted)
    }
}

/// Whether a wall already leads from a corner as far as this.
fn stands_towards(plan: &Plan, corner: CornerId, by: Vector) -> bool {
    let Some(way) = by.unit() else { return true };
    plan.walls().any(|(_, wall)| {
        let other = match corner {
            corner if corner == wall.from => wall.to,
            corner if corner == wall.to => wall.from,
            _ => return false,
        };
        let leads = plan.position(corner).zip(plan.position(other)).map(|(a, b)| b - a);
        leads.is_some_and(|leads| leads.dot(way) >= by.length() - TOUCH_M && leads.cross(way).abs() <= TOUCH_M)
    })
}

/// Which edges meet at each corner.
struct Around<'a> {
    plan: &'a Plan,
    /// Each edge from both of its ends, sorted.
    edges: Vec<(CornerId, CornerId)>,
}

impl<'a> Around<'a> {
    fn new(plan: &'a Plan) -> Self {
        let mut edges: Vec<(CornerId, CornerId)> = plan_edges(plan).flat_map(|(a, b)| [(a, b), (b, a)]).collect();
        edges.sort_unstable();
        edges.dedup();
        Self { plan, edges }
    }

    /// The other ends of the edges at a corner.
    fn neighbours(&self, corner: CornerId) -> impl Iterator<Item = CornerId> + '_ {
        let first = self.edges.partition_point(|&(from, _)| from < corner);
        self.edges[first..].iter().take_while(move |&&(from, _)| from == corner).map(|&(_, to)| to)
    }

    fn way(&self, from: CornerId, to: CornerId) -> Option<Vector> {
        (self.plan.position(to)? - self.plan.position(from)?).unit()
    }

    /// The corners along the straight run of edges that an edge is part of, in its direction.
    fn run(&self, from: CornerId, to: CornerId) -> Option<Vec<CornerId>> {
        let along = self.way(from, to)?;
        let mut run = vec![from, to];
        for (end, along) in [(to, along), (from, -along)] {
            let mut at = end;
            let is_onward = |at: CornerId, next: CornerId| self.way(at, next).map_or(0.0, |way| way.dot(along));
            while let Some((cos, next)) =
                self.neighbours(at).map(|next| (is_onward(at, next), next)).max_by(|p, q| p.0.total_cmp(&q.0))
                && cos >= IN_LINE_COS
                && !run.contains(&next)
            {
                if end == to {
                    run.push(next);
                } else {
                    run.insert(0, next);
                }
                at = next;
            }
        }
        Some(run)
    }

    /// The direction that a corner of a run can slide along so that what it stands on stays straight: that of
    /// the line through it, or of the only other edge.
    fn slides_along(&self, corner: CornerId, run: &BTreeSet<CornerId>, along: Vector) -> Option<Vector> {
        let others = self.neighbours(corner).filter(|next| !run.contains(next));
        let ways: Vec<Vector> = others.filter_map(|next| self.way(corner, next)).collect();
        let first = *ways.first()?;
        let is_parallel = |p: Vector, q: Vector| p.dot(q).abs() >= IN_LINE_COS;
        let is_opposite = |p: Vector, q: Vector| p.dot(q) <= -IN_LINE_COS;
        let through =
            ways.iter().enumerate().find_map(|(i, &p)| ways[i + 1..].iter().any(|&q| is_opposite(p, q)).then_some(p));
        let only = ways.iter().all(|&way| is_parallel(first, way)).then_some(first);
        through.or(only).filter(|way| way.cross(along).abs() >= ALONG_SIN)
    }
}

/// Rejects an edit that moved corners if an edge lost its length, or a room turned inside out or began to
/// cross itself.
///
/// # Errors
/// Says which of these.
pub(crate) fn check_shapes(
    before: &Plan,
    after: &Plan,
    moved: &BTreeSet<CornerId>,
    what: &str,
) -> Result<(), EditError> {
    for (a, b) in plan_edges(after) {
        if (moved.contains(&a) || moved.contains(&b))
            && let (Some(p), Some(q)) = (after.position(a), after.position(b))
            && p.distance(q) <= TOUCH_M
            && before.position(a).zip(before.position(b)).is_some_and(|(p, q)| p.distance(q) > TOUCH_M)
        {
            return fail(format!("{what} would leave a wall without length"));
        }
    }
    check_rooms(before, after, moved, what)
}

/// Rejects an edit that moved corners if a room turned inside out or began to cross itself.
fn check_rooms(before: &Plan, after: &Plan, moved: &BTreeSet<CornerId>, what: &str) -> Result<(), EditError> {
    for (id, room) in after.rooms() {
        let is_moved = || room.rings().any(|ring| ring.iter().any(|corner| moved.contains(corner)));
        let Some(old) = before.room(id).filter(|old| !old.rings().eq(room.rings()) || is_moved()) else { continue };
        for (old, new) in old.rings().zip(room.rings()) {
            let (old, new) = (before.ring_points(old), after.ring_points(new));
            let turned = polygon::signed_area(&old) * polygon::signed_area(&new) < 0.0;
            let is_simple = crate::geometry::path::is_simple_ring;
            if turned || (is_simple(&old) && !is_simple(&new)) {
                let name = crate::edit::draw::named(room);
                return fail(format!("{what} would turn {name} inside out"));
            }
        }
    }
    Ok(())
}
