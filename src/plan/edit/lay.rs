//! Laying paths into a plan: what every edit that draws does first. A corner exists once, so a path
//! goes through the corners it meets, splits the edges it touches, and shares a corner with every
//! edge it crosses.

use std::collections::{BTreeMap, BTreeSet};

use super::split::{Splits, split_edges};
use super::{EditError, add_corner, checked_position, fail};
use crate::geometry::segments::{SegmentIndex, crossing};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M};
use crate::plan::{CornerId, Plan, ordered, ring_edges};

/// Paths laid into a plan.
pub(crate) struct Laid {
    /// The plan with the corners of the paths; nothing has their new edges yet.
    pub plan: Plan,
    /// For each path the corners it runs through, no two neighbours equal.
    pub chains: Vec<Vec<CornerId>>,
}

/// Lays paths into a plan. A point closer than [`TOUCH_M`] to a corner is that corner; one as close
/// to an edge is put on the edge, which is split there. Corners as close to a path become part of it,
/// and where it crosses an edge or a path both get a corner. What is there never moves by more than
/// the rounding to the grid.
///
/// Takes time linear in the number of edges of the plan for a path that meets few of them.
///
/// # Errors
/// When a point lies outside the drawing area.
pub(crate) fn lay(plan: &Plan, paths: &[Vec<Point>]) -> Result<Laid, EditError> {
    let paths: Vec<Vec<Point>> =
        paths.iter().map(|path| path.iter().map(|&p| checked_position(p)).collect()).collect::<Result<_, _>>()?;
    let mut ground = Ground::around(plan, &paths);
    let existing = ground.lines.len();
    let mut laid_lines: Vec<Vec<usize>> = Vec::new();
    for path in &paths {
        let stops: Vec<usize> = path.iter().map(|&point| ground.stop(point)).collect();
        let mut lines = Vec::new();
        for pair in stops.windows(2).filter(|pair| pair[0] != pair[1]) {
            lines.push(ground.draw(pair[0], pair[1])?);
        }
        if lines.is_empty()
            && let Some(&only) = stops.first()
        {
            // A path of one place: its corner is all there is of it.
            lines.push(ground.lines.len());
            ground.lines.push(vec![only]);
        }
        laid_lines.push(lines);
    }
    let mut next = plan.clone();
    let mut ids: Vec<CornerId> = Vec::with_capacity(ground.stops.len());
    for stop in &ground.stops {
        ids.push(match stop.id {
            Some(id) => id,
            None => {
                let (with_corner, id) = add_corner(&next, stop.at)?;
                next = with_corner;
                id
            }
        });
    }
    let mut splits = Splits::new();
    for line in ground.lines[..existing].iter().filter(|line| line.len() > 2) {
        let mut inner: Vec<CornerId> = line[1..line.len() - 1].iter().map(|&stop| ids[stop]).collect();
        let (from, to) = (ids[line[0]], ids[line[line.len() - 1]]);
        if from > to {
            inner.reverse();
        }
        splits.insert(ordered(from, to), inner);
    }
    if !splits.is_empty() {
        next = split_edges(&next, &splits)?;
    }
    let chains = laid_lines
        .into_iter()
        .map(|lines| {
            let mut chain: Vec<CornerId> =
                lines.into_iter().flat_map(|line| &ground.lines[line]).map(|&stop| ids[stop]).collect();
            chain.dedup();
            chain
        })
        .collect();
    Ok(Laid { plan: next, chains })
}

/// A corner, there already or to be added.
struct Stop {
    id: Option<CornerId>,
    at: Point,
}

/// The part of a plan around paths, while they are laid.
struct Ground {
    stops: Vec<Stop>,
    /// The edges of the plan, then the pieces of paths: each as the stops along it.
    lines: Vec<Vec<usize>>,
}

/// A piece of a path that meets more things than this is refused: no drawing has so many on one
/// line, and each costs a look at all others.
const MEETINGS_LIMIT: usize = 20_000;

impl Ground {
    /// The corners and edges of a plan near paths.
    fn around(plan: &Plan, paths: &[Vec<Point>]) -> Self {
        // Pieces bend by up to the touching distance, more than once where corners stand close.
        let reach_m = 10.0 * TOUCH_M;
        let pieces = paths.iter().flat_map(|path| {
            let last = path.last().map(|&last| Segment::new(last, last));
            path.windows(2).map(|pair| Segment::new(pair[0], pair[1])).chain(last)
        });
        let pieces = SegmentIndex::new(pieces.collect());
        let all = pieces.all().iter().fold(Bounds::EMPTY, |all, piece| all.union(piece.bounds())).inflated(reach_m);
        let near = |edge: Segment| {
            let bounds = edge.bounds();
            all.intersects(bounds)
                && pieces.near(bounds.inflated(reach_m)).any(|piece| !lies_beside(edge, pieces.get(piece), reach_m))
        };
        let mut ground = Self { stops: Vec::new(), lines: Vec::new() };
        let mut stop_of: BTreeMap<CornerId, usize> = BTreeMap::new();
        for (id, corner) in plan.corners() {
            if near(Segment::new(corner.position, corner.position)) {
                stop_of.insert(id, ground.stops.len());
                ground.stops.push(Stop { id: Some(id), at: corner.position });
            }
        }
        let mut edges: BTreeSet<[CornerId; 2]> = BTreeSet::new();
        for (a, b) in plan_edges(plan) {
            if let (Some(from), Some(to)) = (plan.position(a), plan.position(b))
                && near(Segment::new(from, to))
                && edges.insert(ordered(a, b))
            {
                let ends = [(a, from), (b, to)].map(|(id, at)| {
                    *stop_of.entry(id).or_insert_with(|| {
                        ground.stops.push(Stop { id: Some(id), at });
                        ground.stops.len() - 1
                    })
                });
                ground.lines.push(ends.to_vec());
            }
        }
        ground
    }

    fn at(&self, stop: usize) -> Point {
        self.stops[stop].at
    }

    fn piece(&self, line: usize, k: usize) -> Segment {
        Segment::new(self.at(self.lines[line][k]), self.at(self.lines[line][k + 1]))
    }

    /// The stop nearest to a point, if one is close enough to be the same place.
    fn stop_at(&self, point: Point) -> Option<usize> {
        let near = self.stops.iter().enumerate().map(|(i, stop)| (stop.at.distance(point), i));
        near.filter(|&(distance_m, _)| distance_m <= TOUCH_M).min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, i)| i)
    }

    /// The pieces of lines that come within the touching distance of a point and do not end there.
    fn pieces_at(&self, point: Point) -> Vec<(f64, usize, usize)> {
        let mut found = Vec::new();
        for (line, stops) in self.lines.iter().enumerate() {
            for k in 0..stops.len().saturating_sub(1) {
                let piece = self.piece(line, k);
                if piece.bounds().inflated(TOUCH_M).contains(point) && piece.distance(point) <= TOUCH_M {
                    found.push((piece.distance(point), line, k));
                }
            }
        }
        found
    }

    /// The stop for a point of a path: an existing one, else a new one, on an edge where one passes.
    fn stop(&mut self, point: Point) -> usize {
        if let Some(stop) = self.stop_at(point) {
            return stop;
        }
        let nearest = self.pieces_at(point).into_iter().min_by(|p, q| p.0.total_cmp(&q.0));
        let Some((_, line, k)) = nearest else { return self.new_stop(point) };
        let on_edge = self.piece(line, k).nearest_point(point).trimmed();
        self.stop_at(on_edge).unwrap_or_else(|| self.new_stop(on_edge))
    }

    /// A new stop, which splits the lines that pass there.
    fn new_stop(&mut self, at: Point) -> usize {
        let mut passing = self.pieces_at(at);
        let stop = self.stops.len();
        self.stops.push(Stop { id: None, at });
        // From the back, so that earlier places in a line stay valid; a line that comes by twice is
        // split once, where it comes closest.
        passing.sort_by(|p, q| (p.1, p.0).partial_cmp(&(q.1, q.0)).unwrap_or(std::cmp::Ordering::Equal));
        passing.dedup_by_key(|passing| passing.1);
        for (_, line, k) in passing {
            self.lines[line].insert(k + 1, stop);
        }
        stop
    }

    /// Draws a line between two stops, through all it meets, and gives its index.
    fn draw(&mut self, from: usize, to: usize) -> Result<usize, EditError> {
        let line = self.lines.len();
        self.lines.push(vec![from, to]);
        let mut k = 0;
        // Crossings that give no new corner: the lines meet in one already, up to rounding.
        let mut settled: BTreeSet<[usize; 4]> = BTreeSet::new();
        while k + 1 < self.lines[line].len() {
            if self.lines[line].len() > MEETINGS_LIMIT {
                return fail("the line meets too many others");
            }
            let (a, b) = (self.lines[line][k], self.lines[line][k + 1]);
            if let Some(stop) = self.stop_between(line, a, b) {
                self.lines[line].insert(k + 1, stop);
            } else if !self.cross_one(line, k, &mut settled) {
                k += 1;
            }
        }
        Ok(line)
    }

    /// The first stop that a piece of a line passes close enough to go through it, and which the line
    /// does not have yet.
    fn stop_between(&self, line: usize, a: usize, b: usize) -> Option<usize> {
        let piece = Segment::new(self.at(a), self.at(b));
        let bounds = piece.bounds().inflated(TOUCH_M);
        let candidates = self.stops.iter().enumerate().filter(|&(i, stop)| {
            bounds.contains(stop.at)
                && piece.distance(stop.at) <= TOUCH_M
                && stop.at.distance(piece.a) > TOUCH_M
                && stop.at.distance(piece.b) > TOUCH_M
                && !self.lines[line].contains(&i)
        });
        candidates.map(|(i, stop)| (piece.nearest_fraction(stop.at), i)).min_by(|p, q| p.0.total_cmp(&q.0)).map(|p| p.1)
    }

    /// Finds a line that crosses a piece and gives both a stop there; whether anything changed.
    fn cross_one(&mut self, line: usize, k: usize, settled: &mut BTreeSet<[usize; 4]>) -> bool {
        let (a, b) = (self.lines[line][k], self.lines[line][k + 1]);
        let piece = self.piece(line, k);
        let bounds = piece.bounds();
        for other in (0..self.lines.len()).filter(|&other| other != line) {
            for j in 0..self.lines[other].len().saturating_sub(1) {
                let (c, d) = (self.lines[other][j], self.lines[other][j + 1]);
                if c == a || c == b || d == a || d == b {
                    continue;
                }
                let crossed = self.piece(other, j);
                if !bounds.intersects(crossed.bounds()) {
                    continue;
                }
                let Some(at) = crossing(piece, crossed) else { continue };
                if !settled.insert([a, b, c, d]) {
                    continue;
                }
                let at = at.trimmed();
                let Some(stop) = self.stop_at(at) else {
                    // Splits both lines, and all others that pass there.
                    self.new_stop(at);
                    return true;
                };
                for (line, k) in [(line, k), (other, j)] {
                    if !self.lines[line].contains(&stop) {
                        self.lines[line].insert(k + 1, stop);
                    }
                }
                return true;
            }
        }
        false
    }
}

/// Whether an edge lies on one side of the line through a piece, further than `reach_m` from it.
fn lies_beside(edge: Segment, piece: Segment, reach_m: f64) -> bool {
    let Some(normal) = piece.vector().left().unit() else { return false };
    let [a, b] = [edge.a, edge.b].map(|end| (end - piece.a).dot(normal));
    a.min(b) > reach_m || a.max(b) < -reach_m
}

/// The edges of a plan: of its walls, then of its rooms; those that several have, several times.
pub(crate) fn plan_edges(plan: &Plan) -> impl Iterator<Item = (CornerId, CornerId)> + '_ {
    let walls = plan.walls().map(|(_, wall)| (wall.from, wall.to));
    let rings = plan.rooms().flat_map(|(_, room)| room.rings()).flat_map(|ring| ring_edges(ring));
    walls.chain(rings)
}
