//! Overlaying paths on a plan: the first step of every edit that draws. A corner exists once, so a path
//! goes through the corners it meets, splits the edges it touches, and shares a corner with every edge it
//! crosses.

use std::collections::{BTreeMap, BTreeSet};

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use crate::edit::split::{Splits, split_edges};
use crate::edit::{EditError, add_corner, checked_position, fail};
use crate::geometry::segments::{SegmentIndex, crossing};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M};
use crate::plan::{CornerId, Plan, Positions, ordered, ring_edges};

/// Paths overlaid on a plan.
pub(crate) struct Overlay {
    /// The plan with the corners of the paths; nothing uses their new edges yet.
    pub plan: Plan,
    /// For each path the corners it runs through, without consecutive repeats.
    pub chains: Vec<Vec<CornerId>>,
}

/// Overlays paths on a plan. A point closer than [`TOUCH_M`] to a corner becomes that corner; one that
/// close to an edge is put on the edge, which is split there. Corners that close to a path become part of
/// it, and where it crosses an edge or a path both get a corner. Existing elements never move by more
/// than the rounding to the grid.
///
/// Takes time linear in the number of edges of the plan, plus logarithmic time for each edge that the
/// paths have or meet.
///
/// # Errors
/// When a point lies outside the drawing area.
pub(crate) fn overlay_paths(plan: &Plan, paths: &[Vec<Point>]) -> Result<Overlay, EditError> {
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
            // A path that stays in one place is just its corner.
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
    Ok(Overlay { plan: next, chains })
}

/// A corner, existing or to be added.
struct Stop {
    id: Option<CornerId>,
    at: Point,
}

/// The part of a plan around paths while they are overlaid.
struct Ground {
    stops: Vec<Stop>,
    stop_tree: RTree<GeomWithData<[f64; 2], usize>>,
    /// The edges of the plan, then the pieces of paths: each as the stops along it.
    lines: Vec<Vec<usize>>,
    /// The pieces of lines between two neighbouring stops.
    pieces: RTree<GeomWithData<Rectangle<[f64; 2]>, Piece>>,
}

/// A piece of a line, from one stop to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    line: usize,
    from: usize,
    to: usize,
}

/// The most things a piece of a path may meet: no drawing has so many on one line.
const MEETINGS_LIMIT: usize = 20_000;

impl Ground {
    /// The corners and edges of a plan near paths.
    fn around(plan: &Plan, paths: &[Vec<Point>]) -> Self {
        // Pieces bend by up to the touching distance, repeatedly where corners are close together.
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
        let mut stops = Vec::new();
        let mut stop_of: BTreeMap<CornerId, usize> = BTreeMap::new();
        for (id, corner) in plan.corners() {
            if near(Segment::new(corner.position, corner.position)) {
                stop_of.insert(id, stops.len());
                stops.push(Stop { id: Some(id), at: corner.position });
            }
        }
        let mut edges: BTreeSet<[CornerId; 2]> = BTreeSet::new();
        let mut lines: Vec<Vec<usize>> = Vec::new();
        let positions = Positions::new(plan);
        for (a, b) in plan_edges(plan) {
            if let (Some(from), Some(to)) = (positions.get(a), positions.get(b))
                && near(Segment::new(from, to))
                && edges.insert(ordered(a, b))
            {
                let ends = [(a, from), (b, to)].map(|(id, at)| {
                    *stop_of.entry(id).or_insert_with(|| {
                        stops.push(Stop { id: Some(id), at });
                        stops.len() - 1
                    })
                });
                lines.push(ends.to_vec());
            }
        }
        let points = stops.iter().enumerate().map(|(i, stop)| GeomWithData::new([stop.at.x, stop.at.y], i)).collect();
        let boxes = lines.iter().enumerate().map(|(line, ends)| {
            boxed(Segment::new(stops[ends[0]].at, stops[ends[1]].at), Piece { line, from: ends[0], to: ends[1] })
        });
        let pieces = RTree::bulk_load(boxes.collect());
        Self { stop_tree: RTree::bulk_load(points), stops, lines, pieces }
    }

    fn at(&self, stop: usize) -> Point {
        self.stops[stop].at
    }

    fn segment(&self, piece: Piece) -> Segment {
        Segment::new(self.at(piece.from), self.at(piece.to))
    }

    /// The stops in a box, by index.
    fn stops_in(&self, bounds: Bounds) -> Vec<usize> {
        let mut found: Vec<usize> =
            self.stop_tree.locate_in_envelope(envelope(bounds)).map(|found| found.data).collect();
        found.sort_unstable();
        found
    }

    /// The pieces whose bounding boxes meet a box, by line.
    fn pieces_in(&self, bounds: Bounds) -> Vec<Piece> {
        let mut found: Vec<Piece> =
            self.pieces.locate_in_envelope_intersecting(envelope(bounds)).map(|found| found.data).collect();
        found.sort_unstable();
        found
    }

    /// The stop nearest to a point, if close enough to count as the same place.
    fn stop_at(&self, point: Point) -> Option<usize> {
        let near = self.stops_in(Bounds::of([point]).inflated(TOUCH_M));
        let near = near.into_iter().map(|i| (self.at(i).distance(point), i));
        near.filter(|&(distance_m, _)| distance_m <= TOUCH_M).min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, i)| i)
    }

    /// The pieces within the touching distance of a point, with that distance.
    fn pieces_at(&self, point: Point) -> Vec<(f64, Piece)> {
        let near = self.pieces_in(Bounds::of([point]).inflated(TOUCH_M));
        let near = near.into_iter().map(|piece| (self.segment(piece).distance(point), piece));
        near.filter(|&(distance_m, _)| distance_m <= TOUCH_M).collect()
    }

    /// The stop for a point of a path: an existing one, or a new one, on an edge if one passes there.
    fn stop(&mut self, point: Point) -> usize {
        if let Some(stop) = self.stop_at(point) {
            return stop;
        }
        let nearest = self.pieces_at(point).into_iter().min_by(|p, q| p.0.total_cmp(&q.0));
        let Some((_, piece)) = nearest else { return self.new_stop(point) };
        let on_edge = self.segment(piece).nearest_point(point).trimmed();
        self.stop_at(on_edge).unwrap_or_else(|| self.new_stop(on_edge))
    }

    /// A new stop, which splits the lines that pass there.
    fn new_stop(&mut self, at: Point) -> usize {
        let mut passing = self.pieces_at(at);
        let stop = self.stops.len();
        self.stops.push(Stop { id: None, at });
        self.stop_tree.insert(GeomWithData::new([at.x, at.y], stop));
        // A line that passes twice is split once, where it comes closest.
        passing.sort_by(|p, q| p.1.line.cmp(&q.1.line).then(p.0.total_cmp(&q.0)));
        passing.dedup_by_key(|passing| passing.1.line);
        for (_, piece) in passing {
            self.split(piece, stop);
        }
        stop
    }

    /// Inserts a stop into a line.
    fn split(&mut self, piece: Piece, stop: usize) {
        let Piece { line, from, to } = piece;
        let stops = &mut self.lines[line];
        let Some(k) = stops.windows(2).position(|pair| pair == [from, to]) else { return };
        stops.insert(k + 1, stop);
        self.pieces.remove(&boxed(self.segment(piece), piece));
        for part in [Piece { line, from, to: stop }, Piece { line, from: stop, to }] {
            self.pieces.insert(boxed(self.segment(part), part));
        }
    }

    /// Draws a line between two stops, through all it meets, and returns its index.
    fn draw(&mut self, from: usize, to: usize) -> Result<usize, EditError> {
        let line = self.lines.len();
        self.lines.push(vec![from, to]);
        let whole = Piece { line, from, to };
        self.pieces.insert(boxed(self.segment(whole), whole));
        let mut k = 0;
        // Crossings that give no new corner: the lines already meet in one, up to rounding.
        let mut settled: BTreeSet<[usize; 4]> = BTreeSet::new();
        while k + 1 < self.lines[line].len() {
            if self.lines[line].len() > MEETINGS_LIMIT {
                return fail("the line meets too many others");
            }
            let piece = Piece { line, from: self.lines[line][k], to: self.lines[line][k + 1] };
            if let Some(stop) = self.stop_between(piece) {
                self.split(piece, stop);
            } else if !self.cross_one(piece, &mut settled) {
                k += 1;
            }
        }
        Ok(line)
    }

    /// The first stop close enough to a piece that the piece must go through it, but that its line does
    /// not have yet.
    fn stop_between(&self, piece: Piece) -> Option<usize> {
        let segment = self.segment(piece);
        let candidates = self.stops_in(segment.bounds().inflated(TOUCH_M)).into_iter().filter(|&i| {
            let at = self.at(i);
            segment.distance(at) <= TOUCH_M
                && at.distance(segment.a) > TOUCH_M
                && at.distance(segment.b) > TOUCH_M
                && !self.lines[piece.line].contains(&i)
        });
        let along = candidates.map(|i| (segment.nearest_fraction(self.at(i)), i));
        along.min_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, i)| i)
    }

    /// Finds a line that crosses a piece and gives both a stop there; returns whether anything changed.
    fn cross_one(&mut self, piece: Piece, settled: &mut BTreeSet<[usize; 4]>) -> bool {
        let segment = self.segment(piece);
        for other in self.pieces_in(segment.bounds()) {
            let ends = [piece.from, piece.to];
            if other.line == piece.line || ends.contains(&other.from) || ends.contains(&other.to) {
                continue;
            }
            let Some(at) = crossing(segment, self.segment(other)) else { continue };
            if !settled.insert([piece.from, piece.to, other.from, other.to]) {
                continue;
            }
            let at = at.trimmed();
            let Some(stop) = self.stop_at(at) else {
                // Splits both lines, and all others that pass there.
                self.new_stop(at);
                return true;
            };
            for piece in [piece, other] {
                if !self.lines[piece.line].contains(&stop) {
                    self.split(piece, stop);
                }
            }
            return true;
        }
        false
    }
}

fn boxed(segment: Segment, piece: Piece) -> GeomWithData<Rectangle<[f64; 2]>, Piece> {
    let Bounds { min, max } = segment.bounds();
    GeomWithData::new(Rectangle::from_corners([min.x, min.y], [max.x, max.y]), piece)
}

fn envelope(bounds: Bounds) -> AABB<[f64; 2]> {
    AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y])
}

/// Whether an edge lies on one side of the line through a piece, further than `reach_m` from it.
fn lies_beside(edge: Segment, piece: Segment, reach_m: f64) -> bool {
    let Some(normal) = piece.vector().left().unit() else { return false };
    let [a, b] = [edge.a, edge.b].map(|end| (end - piece.a).dot(normal));
    a.min(b) > reach_m || a.max(b) < -reach_m
}

/// The edges of a plan: those of walls, then those of rooms. Shared edges are repeated.
pub(crate) fn plan_edges(plan: &Plan) -> impl Iterator<Item = (CornerId, CornerId)> + '_ {
    let walls = plan.walls().map(|(_, wall)| (wall.from, wall.to));
    let rings = plan.rooms().flat_map(|(_, room)| room.rings()).flat_map(|ring| ring_edges(ring));
    walls.chain(rings)
}
