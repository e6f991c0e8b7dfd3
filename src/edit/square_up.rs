//! Making angles right that nearly are.

use std::collections::{BTreeMap, BTreeSet};

use crate::edit::dragging::check_shapes;
use crate::edit::{EditError, fail, move_corners};
use crate::geometry::{Point, Segment, TOUCH_M, Vector};
use crate::plan::{CornerId, Plan, RoomId, ordered, ring_edges};

/// A drawing whose main direction strays from the axes by no more than this (1 degree) is meant to lie
/// along them.
const UPRIGHT_RAD: f64 = std::f64::consts::PI / 180.0;

/// Directions that differ by no more than this (2 degrees) are one, however well each is drawn.
const SAME_DIRECTION_RAD: f64 = 2.0 * UPRIGHT_RAD;

/// A room is turned against the others, not drawn badly, when it is turned by so many times what its own edges stray.
const CERTAIN: f64 = 3.0;

/// An edge, from corner to corner.
type Edge = [CornerId; 2];

/// The same whichever way it goes.
fn key([a, b]: Edge) -> Edge {
    ordered(a, b)
}

/// Makes nearly right angles right, in rooms or (`None`) in the whole plan, walls included.
///
/// What is turned against the rest is squared up in its own direction: each room has a main direction, walls that
/// bound no room have those that most of them share, and rooms whose directions differ by no more than they are badly
/// drawn make up a wing. Its main direction is the one from which, or from whose perpendicular, the greatest length of
/// edges strays by no more than `max_angle_rad`, and the mean of these; the axes of the drawing where it is within a
/// degree of them. An edge that strays from it or from its perpendicular by at most `max_angle_rad` becomes parallel to
/// it: its ends get the same coordinate across. Corners linked that way get the mean of their coordinates, which moves
/// them least (in the sum of squares). Where two wings meet, the larger one comes first.
///
/// Corners are shared before and after; edges at other angles, and chords of round walls, stay between theirs.
///
/// # Errors
/// When a room does not exist, nothing has edges, an edge would lose its length, or a room would turn
/// inside out.
pub fn square_up(plan: &Plan, rooms: Option<&BTreeSet<RoomId>>, max_angle_rad: f64) -> Result<Plan, EditError> {
    let parts = Parts::of(plan, rooms)?;
    let wings = wings(plan, &parts, max_angle_rad);
    if wings.is_empty() {
        return fail("there is no main direction to square up to");
    }
    let by_wing = edges_by_wing(plan, &parts, &wings, max_angle_rad);
    let mut moves: BTreeMap<CornerId, Move> = BTreeMap::new();
    for (wing, edges) in wings.iter().zip(&by_wing) {
        let (along, across) = wing.axes();
        let origin = wing.edges.first().and_then(|&[corner, _]| plan.position(corner)).unwrap_or_default();
        // Corners linked by edges along the main direction share the coordinate across it, and vice versa.
        let mut linked = [Links::default(), Links::default()];
        for &[a, b] in edges {
            let Some(edge) = segment(plan, [a, b]) else { continue };
            let is_along = edge.vector().dot(along).abs() >= edge.vector().dot(across).abs();
            linked[usize::from(is_along)].link(a, b);
        }
        for (links, axis) in linked.into_iter().zip([along, across]) {
            for group in links.groups() {
                let at = |id: CornerId| plan.position(id).map_or(0.0, |point| (point - origin).dot(axis));
                // Corners whose place is known by now say where the others go.
                let is_known = |id: &&CornerId| moves.get(*id).is_some_and(Move::is_known);
                let known = group.iter().filter(is_known).map(|id| at(*id) + moves[id].vector().dot(axis));
                let known: Vec<f64> = known.collect();
                let places = if known.is_empty() { group.iter().map(|&id| at(id)).collect() } else { known };
                let mean = places.iter().sum::<f64>() / places.len() as f64;
                for id in group {
                    moves.entry(id).or_default().add(axis, mean - at(id));
                }
            }
        }
    }
    let targets: Vec<(CornerId, Point)> = moves
        .iter()
        .filter_map(|(&id, by)| Some((id, plan.position(id)? + by.vector())))
        .filter(|&(id, to)| plan.position(id) != Some(to.trimmed()))
        .collect();
    let next = move_corners(plan, &targets)?;
    check_shapes(plan, &next, &targets.iter().map(|&(id, _)| id).collect(), "squaring up")?;
    Ok(next)
}

fn segment(plan: &Plan, [a, b]: Edge) -> Option<Segment> {
    Some(Segment::new(plan.position(a)?, plan.position(b)?))
}

/// What can be a wing: the edges of each room, and those of walls that bound none.
struct Parts {
    rooms: Vec<Vec<Edge>>,
    walls: Vec<Edge>,
    /// Chords of round walls.
    round: BTreeSet<Edge>,
}

impl Parts {
    /// # Errors
    /// When a room does not exist.
    fn of(plan: &Plan, rooms: Option<&BTreeSet<RoomId>>) -> Result<Self, EditError> {
        let ids: Vec<RoomId> = match rooms {
            Some(rooms) => rooms.iter().copied().collect(),
            None => plan.rooms().map(|(id, _)| id).collect(),
        };
        let mut parts = Self { rooms: Vec::new(), walls: Vec::new(), round: BTreeSet::new() };
        for id in ids {
            super::require_room(plan, id)?;
            let Some(room) = plan.room(id) else { continue };
            let edges = room.rings().flat_map(|ring| ring_edges(ring)).map(|(a, b)| [a, b]);
            parts.rooms.push(edges.collect());
            for ring in room.rings() {
                parts.note_round(plan, ring, true);
            }
        }
        if rooms.is_none() {
            let of_rooms: BTreeSet<Edge> = parts.rooms.iter().flatten().copied().map(key).collect();
            let walls = plan.walls().map(|(_, wall)| ordered(wall.from, wall.to));
            let walls: BTreeSet<Edge> = walls.filter(|edge| !of_rooms.contains(edge)).collect();
            for (chain, is_closed) in chains(&walls) {
                parts.note_round(plan, &chain, is_closed);
            }
            parts.walls = walls.into_iter().collect();
        }
        Ok(parts)
    }

    fn note_round(&mut self, plan: &Plan, corners: &[CornerId], is_closed: bool) {
        let points: Vec<Point> = corners.iter().filter_map(|&id| plan.position(id)).collect();
        if points.len() != corners.len() {
            return;
        }
        for i in round_pieces(&points, is_closed) {
            self.round.insert(ordered(corners[i], corners[(i + 1) % corners.len()]));
        }
    }

    fn edges(&self) -> impl Iterator<Item = Edge> + '_ {
        self.rooms.iter().flatten().chain(&self.walls).copied()
    }

    /// The straight ones of some edges.
    fn straight(&self, edges: &[Edge]) -> Vec<Edge> {
        edges.iter().copied().filter(|&edge| !self.round.contains(&key(edge))).collect()
    }
}

/// Corners one after the other along walls, through corners where just two of them meet; whether each is closed.
fn chains(walls: &BTreeSet<Edge>) -> Vec<(Vec<CornerId>, bool)> {
    let mut at: BTreeMap<CornerId, Vec<CornerId>> = BTreeMap::new();
    for &[a, b] in walls {
        at.entry(a).or_default().push(b);
        at.entry(b).or_default().push(a);
    }
    let mut left = walls.clone();
    let mut chains = Vec::new();
    let is_end = |id: &CornerId| at.get(id).is_none_or(|others| others.len() != 2);
    let starts: Vec<CornerId> = at.keys().copied().filter(is_end).chain(at.keys().copied()).collect();
    for start in starts {
        for &second in at.get(&start).into_iter().flatten() {
            if !left.remove(&ordered(start, second)) {
                continue;
            }
            let mut chain = vec![start, second];
            let mut last = second;
            while !is_end(&last)
                && let Some(&next) =
                    at.get(&last).into_iter().flatten().find(|&&next| left.contains(&ordered(last, next)))
            {
                left.remove(&ordered(last, next));
                chain.push(next);
                last = next;
            }
            let is_closed = chain.len() > 3 && chain.first() == chain.last();
            if is_closed {
                chain.pop();
            }
            chains.push((chain, is_closed));
        }
    }
    chains
}

/// Which pieces of a line are chords of something round, by the index of their first point: at least three one after
/// the other that turn the same way, each by less than 40 degrees, all by more than 20, and are about as long.
fn round_pieces(points: &[Point], is_closed: bool) -> Vec<usize> {
    const MOST_TURN_RAD: f64 = 0.7;
    const LEAST_ROUND_RAD: f64 = 0.35;
    /// A turn of less is none: lengths are on a grid.
    const NO_TURN_RAD: f64 = 0.002;
    const ALIKE: f64 = 4.0;
    let n = points.len();
    let pieces = if is_closed { n } else { n.saturating_sub(1) };
    if pieces < 3 {
        return Vec::new();
    }
    let piece = |i: usize| points[(i + 1) % n] - points[i % n];
    let turn = |i: usize| {
        let (here, next) = (piece(i), piece(i + 1));
        here.left().dot(next).atan2(here.dot(next))
    };
    // From behind the sharpest turn, so that nothing round is cut where the ring happens to begin.
    let start = match is_closed {
        true => (0..n).max_by(|&p, &q| turn(p).abs().total_cmp(&turn(q).abs())).map_or(0, |i| i + 1),
        false => 0,
    };
    let mut round = Vec::new();
    let mut first = 0;
    while first < pieces {
        let mut last = first;
        let (mut sum, mut most) = (0.0_f64, 0.0_f64);
        while last + 1 < pieces {
            let (angle, ratio) = (turn(start + last), piece(start + last + 1).length() / piece(start + last).length());
            let goes_on = angle.abs() < NO_TURN_RAD || angle * sum > 0.0 || sum == 0.0;
            if !goes_on || angle.abs() >= MOST_TURN_RAD || !(1.0 / ALIKE..=ALIKE).contains(&ratio) {
                break;
            }
            (sum, most, last) = (sum + angle, most.max(angle.abs()), last + 1);
        }
        let turns = (last - first) as f64;
        if last >= first + 2 && sum.abs() >= LEAST_ROUND_RAD && most <= 3.0 * sum.abs() / turns {
            round.extend((first..=last).map(|i| (start + i) % n));
        }
        first = last.max(first + 1);
    }
    round
}

/// What is squared up in one direction.
struct Wing {
    main_rad: f64,
    /// How far its edges stray from that, on the mean.
    stray_rad: f64,
    length_m: f64,
    /// The edges of its rooms, or its walls, each once.
    edges: Vec<Edge>,
    /// The same, whichever way they go.
    keys: BTreeSet<Edge>,
}

impl Wing {
    /// What some edges make up by themselves: those that stray by at most an angle from the direction that most of
    /// them share.
    fn of(plan: &Plan, edges: &[Edge], max_angle_rad: f64) -> Option<Self> {
        let segments = || edges.iter().filter_map(|&edge| segment(plan, edge));
        let main_rad = main_direction(segments(), max_angle_rad)?;
        let strays = segments().map(|edge| (stray(edge.vector().angle_rad(), main_rad).abs(), edge.length()));
        let near = strays.filter(|(stray_rad, _)| *stray_rad <= max_angle_rad.max(UPRIGHT_RAD));
        let (weighted, length_m) =
            near.fold((0.0, 0.0), |(sum, total), (stray_rad, length)| (sum + stray_rad * length, total + length));
        let stray_rad = if length_m > 0.0 { weighted / length_m } else { 0.0 };
        let mut keys = BTreeSet::new();
        let edges = edges.iter().copied().filter(|&edge| keys.insert(key(edge))).collect();
        Some(Self { main_rad, stray_rad, length_m, edges, keys })
    }

    /// Its main direction, and the one across.
    fn axes(&self) -> (Vector, Vector) {
        (Vector::new(1.0, 0.0).rotated(self.main_rad), Vector::new(0.0, 1.0).rotated(self.main_rad))
    }

    /// By how much an edge strays from its directions.
    fn stray_of(&self, plan: &Plan, edge: Edge) -> Option<f64> {
        Some(stray(segment(plan, edge)?.vector().angle_rad(), self.main_rad).abs())
    }

    /// Whether two of its edges meet at nearly a right angle: else there is nothing to square up.
    fn has_right_angle(&self, plan: &Plan, max_angle_rad: f64) -> bool {
        let (along, across) = self.axes();
        let mut met: [BTreeSet<CornerId>; 2] = Default::default();
        for &edge in &self.edges {
            let Some(vector) = segment(plan, edge).map(Segment::vector) else { continue };
            if self.stray_of(plan, edge).is_some_and(|stray_rad| stray_rad <= max_angle_rad) {
                let is_along = vector.dot(along).abs() >= vector.dot(across).abs();
                met[usize::from(is_along)].extend(edge);
            }
        }
        !met[0].is_disjoint(&met[1])
    }

    /// Whether another is of the same direction, as far as both are drawn well.
    fn is_one_with(&self, other: &Self, max_angle_rad: f64) -> bool {
        let apart_rad = stray(other.main_rad, self.main_rad).abs();
        let is_certain = apart_rad > CERTAIN * self.stray_rad.max(other.stray_rad);
        apart_rad <= SAME_DIRECTION_RAD.min(max_angle_rad.max(UPRIGHT_RAD))
            || (apart_rad <= max_angle_rad && !is_certain)
    }
}

/// The wings of a drawing, the largest first.
fn wings(plan: &Plan, parts: &Parts, max_angle_rad: f64) -> Vec<Wing> {
    let mut found: Vec<Wing> =
        parts.rooms.iter().filter_map(|edges| Wing::of(plan, &parts.straight(edges), max_angle_rad)).collect();
    // Of walls that bound no room, one direction after the other.
    let mut walls = parts.straight(&parts.walls);
    while let Some(all) = Wing::of(plan, &walls, max_angle_rad) {
        let is_near = |edge: &Edge| all.stray_of(plan, *edge).is_some_and(|stray_rad| stray_rad <= max_angle_rad);
        let (near, rest): (Vec<Edge>, Vec<Edge>) = walls.into_iter().partition(is_near);
        walls = rest;
        match Wing::of(plan, &near, max_angle_rad) {
            Some(wing) if !near.is_empty() => found.push(wing),
            _ => break,
        }
    }
    found.sort_by(|p, q| q.length_m.total_cmp(&p.length_m).then(p.keys.cmp(&q.keys)));
    let mut wings: Vec<(Wing, Vec<Edge>)> = Vec::new();
    for part in found {
        let near = |wing: &Wing| stray(part.main_rad, wing.main_rad).abs();
        let is_first = wings.is_empty();
        let nearest = wings.iter_mut().min_by(|p, q| near(&p.0).total_cmp(&near(&q.0)));
        if let Some((_, edges)) = nearest.filter(|(wing, _)| wing.is_one_with(&part, max_angle_rad)) {
            edges.extend(part.edges);
        } else if is_first || part.has_right_angle(plan, max_angle_rad) {
            // Of the first, angles need not be right: it lies along the axes, say.
            let edges = part.edges.clone();
            wings.push((part, edges));
        }
    }
    let mut wings: Vec<Wing> =
        wings.into_iter().filter_map(|(_, edges)| Wing::of(plan, &edges, max_angle_rad)).collect();
    wings.sort_by(|p, q| q.length_m.total_cmp(&p.length_m).then(p.keys.cmp(&q.keys)));
    wings
}

/// The edges that become parallel to each wing's directions: of its own, or where an edge fits none of its own, of the
/// wing that it fits best.
fn edges_by_wing(plan: &Plan, parts: &Parts, wings: &[Wing], max_angle_rad: f64) -> Vec<Vec<Edge>> {
    let mut by_wing = vec![Vec::new(); wings.len()];
    let mut seen = parts.round.clone();
    for edge in parts.edges().filter(|&edge| seen.insert(key(edge))) {
        let fits = wings.iter().enumerate().filter_map(|(index, wing)| {
            let stray_rad = wing.stray_of(plan, edge).filter(|stray_rad| *stray_rad <= max_angle_rad)?;
            Some((!wing.keys.contains(&key(edge)), stray_rad, index))
        });
        let best = fits.min_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)));
        if let Some((.., index)) = best {
            by_wing[index].push(edge);
        }
    }
    by_wing
}

/// How a corner is to move: by so much along one direction, or along two.
#[derive(Default)]
struct Move(Vec<(Vector, f64)>);

/// Two directions nearer to each other than this (its sine; 24 degrees) leave the place to chance.
const LEAST_CROSSING: f64 = 0.4;

impl Move {
    /// Adds a direction and how far the corner is to move along it, unless that is said by two others.
    fn add(&mut self, direction: Vector, by: f64) {
        let crosses = |(other, _): &(Vector, f64)| other.left().dot(direction).abs() >= LEAST_CROSSING;
        if !self.is_known() && self.0.iter().all(crosses) {
            self.0.push((direction, by));
        }
    }

    /// Whether the place is known, and not only a line on which it is.
    fn is_known(&self) -> bool {
        self.0.len() >= 2
    }

    fn vector(&self) -> Vector {
        match self.0.as_slice() {
            [] => Vector::default(),
            &[(u, by_u)] => u * by_u,
            &[(u, by_u), (v, by_v), ..] if u.dot(v).abs() < 1e-9 => u * by_u + v * by_v,
            // Of two wings that meet: where the lines across both cross.
            &[(u, by_u), (v, by_v), ..] => (u.left() * by_v + v.left() * -by_u) * (1.0 / u.left().dot(v)),
        }
    }
}

/// By how much a direction strays from another or its perpendicular, in radians, in -π/4..=π/4.
fn stray(angle_rad: f64, from_rad: f64) -> f64 {
    const QUARTER_RAD: f64 = std::f64::consts::FRAC_PI_2;
    (angle_rad - from_rad + QUARTER_RAD / 2.0).rem_euclid(QUARTER_RAD) - QUARTER_RAD / 2.0
}

/// The direction that most edges share up to quarter turns, in radians, in -π/4..=π/4; see
/// [`square_up`].
fn main_direction(edges: impl Iterator<Item = Segment>, max_angle_rad: f64) -> Option<f64> {
    const QUARTER_RAD: f64 = std::f64::consts::FRAC_PI_2;
    /// A quarter of a degree each: a fraction of what a hand-drawn line strays by.
    const BINS: usize = 360;
    let directions: Vec<(f64, f64)> = edges
        .map(|edge| (edge.vector().angle_rad(), edge.length()))
        .filter(|&(_, length_m)| length_m > TOUCH_M)
        .collect();
    let center = |bin: usize| QUARTER_RAD * bin as f64 / BINS as f64;
    let mut lengths_m = vec![0.0; BINS];
    for &(angle_rad, length_m) in &directions {
        let bin = (angle_rad.rem_euclid(QUARTER_RAD) / QUARTER_RAD * BINS as f64).round() as usize % BINS;
        lengths_m[bin] += length_m;
    }
    let window_rad = max_angle_rad.max(UPRIGHT_RAD);
    let used: Vec<usize> = (0..BINS).filter(|&bin| lengths_m[bin] > 0.0).collect();
    let within = |bin: usize| -> f64 {
        let near = used.iter().filter(|&&other| stray(center(other), center(bin)).abs() <= window_rad);
        near.map(|&other| lengths_m[other]).sum()
    };
    let best = (0..BINS).map(|bin| (within(bin), bin)).max_by(|p, q| p.0.total_cmp(&q.0).then(q.1.cmp(&p.1)))?.1;
    let near = directions.iter().map(|&(angle_rad, length_m)| (stray(angle_rad, center(best)), length_m));
    let (weighted, length_m) = near
        .filter(|(stray_rad, _)| stray_rad.abs() <= window_rad)
        .fold((0.0, 0.0), |(sum, total), (stray_rad, length_m)| (sum + stray_rad * length_m, total + length_m));
    let main_rad = (length_m > 0.0).then(|| stray(center(best) + weighted / length_m, 0.0))?;
    Some(if main_rad.abs() <= UPRIGHT_RAD { 0.0 } else { main_rad })
}

/// Corners linked with each other, directly or through others.
#[derive(Default)]
struct Links {
    parent: BTreeMap<CornerId, CornerId>,
}

impl Links {
    fn root(&mut self, mut id: CornerId) -> CornerId {
        while let Some(&parent) = self.parent.get(&id)
            && parent != id
        {
            let above = self.parent.get(&parent).copied().unwrap_or(parent);
            self.parent.insert(id, above);
            id = above;
        }
        id
    }

    fn link(&mut self, a: CornerId, b: CornerId) {
        for id in [a, b] {
            self.parent.entry(id).or_insert(id);
        }
        let (p, q) = (self.root(a), self.root(b));
        self.parent.insert(p.max(q), p.min(q));
    }

    /// The groups of linked corners, by their smallest.
    fn groups(mut self) -> Vec<Vec<CornerId>> {
        let mut groups: BTreeMap<CornerId, Vec<CornerId>> = BTreeMap::new();
        let all: Vec<CornerId> = self.parent.keys().copied().collect();
        for id in all {
            groups.entry(self.root(id)).or_default().push(id);
        }
        groups.into_values().collect()
    }
}
