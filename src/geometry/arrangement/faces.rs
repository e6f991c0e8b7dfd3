use std::cmp::Ordering;
use std::collections::BTreeSet;

use crate::geometry::arrangement::grid::{GridPoint, cross, orientation};
use crate::geometry::arrangement::{Arrangement, NodeIndex, grouped};
use crate::geometry::{Point, polygon};

/// An area enclosed by edges of an arrangement and not divided by any.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Face {
    /// The outer boundary, counter-clockwise, from its smallest node. Simple: no node twice.
    pub outer: Vec<NodeIndex>,
    /// The outer boundaries of what lies inside, clockwise, each from its smallest node, sorted.
    /// Each is simple; they may touch each other and the outer ring in single nodes.
    pub holes: Vec<Vec<NodeIndex>>,
}

impl Face {
    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<NodeIndex>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The outer ring and the holes as points in metres.
    pub fn positions(&self, arrangement: &Arrangement) -> (Vec<Point>, Vec<Vec<Point>>) {
        let holes = self.holes.iter().map(|hole| arrangement.positions(hole)).collect();
        (arrangement.positions(&self.outer), holes)
    }

    /// Twice the area in square steps of the 0.1 mm grid, exactly.
    pub fn doubled_area_steps(&self, arrangement: &Arrangement) -> i128 {
        self.rings().map(|ring| doubled_area(arrangement.grid_points(), ring)).sum()
    }

    /// Area in m².
    pub fn area_m2(&self, arrangement: &Arrangement) -> f64 {
        let (outer, holes) = self.positions(arrangement);
        polygon::area(&outer, &holes)
    }

    /// A point inside, far from the boundary as seen along the x axis: the middle of the widest
    /// stretch halfway between two of the nodes' y.
    pub fn interior_point(&self, arrangement: &Arrangement) -> Point {
        let (outer, holes) = self.positions(arrangement);
        let mut levels: Vec<f64> = outer.iter().chain(holes.iter().flatten()).map(|point| point.y).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        // The middle gap and the highest: one is enough for most faces; a second helps where the middle
        // one is a sliver.
        let gap = |i: usize| (levels[i] + levels[i + 1]) / 2.0;
        let gaps = levels.len().saturating_sub(1);
        let highest = (0..gaps).max_by(|&p, &q| (levels[p + 1] - levels[p]).total_cmp(&(levels[q + 1] - levels[q])));
        let mut best = (0.0, outer.first().copied().unwrap_or_default());
        for level in [gaps.checked_sub(1).map(|last| last / 2), highest].into_iter().flatten().map(gap) {
            let mut crossings: Vec<f64> = std::iter::once(&outer)
                .chain(&holes)
                .flat_map(|ring| polygon::edges(ring))
                .filter(|edge| (edge.a.y > level) != (edge.b.y > level))
                .map(|edge| edge.a.x + (level - edge.a.y) / (edge.b.y - edge.a.y) * (edge.b.x - edge.a.x))
                .collect();
            crossings.sort_by(f64::total_cmp);
            for stretch in crossings.chunks_exact(2) {
                if stretch[1] - stretch[0] > best.0 {
                    best = (stretch[1] - stretch[0], Point::new((stretch[0] + stretch[1]) / 2.0, level));
                }
            }
        }
        best.1
    }
}

/// The bounded faces of an arrangement, sorted by their outer rings.
///
/// Edges that do not separate two faces (dangling ends, bridges) bound none and are left out of all
/// rings; nodes in the middle of a straight boundary stay. An island becomes a hole of the face around
/// it, and the faces inside it are faces of their own. Takes O(n log n) time for n edges.
pub fn faces(arrangement: &Arrangement) -> Vec<Face> {
    let nodes = arrangement.grid_points();
    let half_edges = HalfEdges::new(nodes, arrangement.edges());
    let walks = half_edges.walks();
    let mut faces: Vec<Face> = Vec::new();
    // What each walk bounds, by its index.
    let mut bounds: Vec<Side> = Vec::with_capacity(walks.starts.len());
    let mut splitter = Splitter::new(nodes.len());
    for &start in &walks.starts {
        let mut rings = splitter.rings(half_edges.walk(start));
        // The walk around the inside of a face has one counter-clockwise ring, and clockwise ones
        // where islands touch it; the walk around the outside of an island has clockwise ones only.
        match rings.iter().position(|ring| doubled_area(nodes, ring) > 0) {
            Some(outer) => {
                bounds.push(Side::Face(faces.len() as u32));
                let outer = rings.swap_remove(outer);
                faces.push(Face { outer, holes: rings });
            }
            None => bounds.push(Side::Island(rings)),
        }
    }
    let islands = bounds.iter().filter(|side| matches!(side, Side::Island(_))).count();
    if islands > 1 {
        let around = half_edges.faces_around_islands(&walks, &bounds);
        for (walk, face) in around {
            if let Side::Island(rings) = &mut bounds[walk as usize] {
                faces[face as usize].holes.append(rings);
            }
        }
    }
    for face in &mut faces {
        from_smallest(&mut face.outer);
        face.holes.iter_mut().for_each(|hole| from_smallest(hole));
        face.holes.sort_unstable();
    }
    // No two faces have the same outer ring.
    faces.sort_unstable();
    faces
}

/// Turns a ring so that it starts with its smallest node.
fn from_smallest(ring: &mut [NodeIndex]) {
    let smallest = ring.iter().enumerate().min_by_key(|&(_, node)| node).map_or(0, |(i, _)| i);
    ring.rotate_left(smallest);
}

/// Twice the signed area of a ring of nodes.
fn doubled_area(nodes: &[GridPoint], ring: &[NodeIndex]) -> i128 {
    let Some(&origin) = ring.first() else { return 0 };
    let from_origin = |node: NodeIndex| nodes[origin as usize].to(nodes[node as usize]);
    ring.windows(2).map(|pair| i128::from(cross(from_origin(pair[0]), from_origin(pair[1])))).sum()
}

/// What lies to the left of a walk.
enum Side {
    /// A face, by its index.
    Face(u32),
    /// The outside of an island, with these rings.
    Island(Vec<Vec<NodeIndex>>),
}

/// Marks a half-edge or walk that does not exist.
const NONE: u32 = u32::MAX;

/// The edges that separate faces, each as two half-edges: edge `e` of `edges` from its smaller node
/// as `2 * e`, back as `2 * e + 1`.
struct HalfEdges<'a> {
    nodes: &'a [GridPoint],
    edges: &'a [[NodeIndex; 2]],
    /// Where in `around` the half-edges of each node start; one more at the end.
    starts: Vec<u32>,
    /// The half-edges that leave each node, counter-clockwise.
    around: Vec<u32>,
    /// The half-edge that follows each on the boundary of the face to its left; [`NONE`] for those
    /// left out.
    next: Vec<u32>,
}

/// The closed walks along `next`.
struct Walks {
    /// One half-edge of each walk.
    starts: Vec<u32>,
    /// The walk of each half-edge; [`NONE`] for those left out.
    of: Vec<u32>,
}

impl<'a> HalfEdges<'a> {
    fn new(nodes: &'a [GridPoint], edges: &'a [[NodeIndex; 2]]) -> Self {
        let mut kept = without_dangles(nodes.len(), edges);
        let leaving = |kept: &[bool]| {
            let pairs = edges.iter().zip(0..).zip(kept).filter(|(_, kept)| **kept);
            let pairs = pairs.flat_map(|((&[u, v], e), _)| [(u, 2 * e), (v, 2 * e + 1)]);
            grouped(nodes.len(), pairs.collect::<Vec<_>>().into_iter())
        };
        let (starts, around) = leaving(&kept);
        let mut half_edges = Self { nodes, edges, starts, around, next: Vec::new() };
        for window in half_edges.starts.windows(2) {
            let around = &mut half_edges.around[window[0] as usize..window[1] as usize];
            // Two can stand in any order: each is next to the other both ways round.
            if around.len() > 2 {
                around.sort_unstable_by(|&p, &q| by_angle(nodes, half_edge(edges, p), half_edge(edges, q)));
            }
        }
        half_edges.link();
        // A bridge has the same walk on both sides. Removing all bridges creates no new ones.
        let walks = half_edges.walks();
        let mut bridges = false;
        for (e, kept) in kept.iter_mut().enumerate() {
            if *kept && walks.of[2 * e] == walks.of[2 * e + 1] {
                *kept = false;
                bridges = true;
            }
        }
        if bridges {
            let mut around = Vec::with_capacity(half_edges.around.len());
            let mut starts = vec![0];
            for window in half_edges.starts.windows(2) {
                let all = &half_edges.around[window[0] as usize..window[1] as usize];
                around.extend(all.iter().filter(|&&h| kept[h as usize / 2]));
                starts.push(around.len() as u32);
            }
            (half_edges.starts, half_edges.around) = (starts, around);
            half_edges.link();
        }
        half_edges
    }

    /// Finds `next` from the order around the nodes.
    fn link(&mut self) {
        self.next.clear();
        self.next.resize(2 * self.edges.len(), NONE);
        for window in self.starts.windows(2) {
            let around = &self.around[window[0] as usize..window[1] as usize];
            let Some(&last) = around.last() else { continue };
            // Arriving along h's twin, the boundary of the face on the left continues with the next
            // half-edge clockwise of h.
            let mut clockwise = last;
            for &h in around {
                self.next[h as usize ^ 1] = clockwise;
                clockwise = h;
            }
        }
    }

    /// All walks, by their first half-edge.
    fn walks(&self) -> Walks {
        let mut walks = Walks { starts: Vec::new(), of: vec![NONE; self.next.len()] };
        for start in 0..self.next.len() as u32 {
            if self.next[start as usize] == NONE || walks.of[start as usize] != NONE {
                continue;
            }
            let index = walks.starts.len() as u32;
            walks.starts.push(start);
            let mut h = start;
            while walks.of[h as usize] == NONE {
                walks.of[h as usize] = index;
                h = self.next[h as usize];
            }
        }
        walks
    }

    /// The nodes along a walk.
    fn walk(&self, start: u32) -> impl Iterator<Item = NodeIndex> + '_ {
        let mut h = Some(start);
        std::iter::from_fn(move || {
            let at = h?;
            let next = self.next[at as usize];
            h = (next != start).then_some(next);
            Some(half_edge(self.edges, at)[0])
        })
    }

    /// For each island inside a face, its walk and that face: a sweep over the nodes from left to right
    /// keeps the edges it cuts in order, and looks below the first node of each island (de Berg and
    /// others, Computational Geometry, sections 2.1 and 2.3).
    fn faces_around_islands(&self, walks: &Walks, bounds: &[Side]) -> Vec<(u32, u32)> {
        // The first node of each island's walk, which is the first of the whole island.
        let mut firsts: Vec<(NodeIndex, u32)> = Vec::new();
        for (walk, (&start, side)) in (0..).zip(walks.starts.iter().zip(bounds)) {
            if matches!(side, Side::Island(_))
                && let Some(first) = self.walk(start).min()
            {
                firsts.push((first, walk));
            }
        }
        firsts.sort_unstable();
        let mut firsts = firsts.into_iter().peekable();
        let mut found = Vec::new();
        // The face around each walk, once known: for islands already met.
        let mut around: Vec<Option<u32>> = vec![None; bounds.len()];
        let mut cut: BTreeSet<CutEdge> = BTreeSet::new();
        let edge = |h: u32| {
            let [u, v] = self.edges[h as usize / 2];
            CutEdge { left: self.nodes[u as usize], right: self.nodes[v as usize], edge: h / 2 }
        };
        for (node, window) in (0..).zip(self.starts.windows(2)) {
            let leaving = &self.around[window[0] as usize..window[1] as usize];
            // An odd half-edge goes back to its smaller node: its edge ends here.
            for &h in leaving.iter().filter(|&&h| h % 2 == 1) {
                cut.remove(&edge(h));
            }
            if let Some((_, walk)) = firsts.next_if(|&(first, _)| first == node) {
                let here = self.nodes[node as usize];
                let below = cut.range(..CutEdge { left: here, right: here, edge: NONE }).next_back();
                let face = below.and_then(|below| {
                    // What lies above an edge is to the left of its rightward half-edge.
                    let above = walks.of[2 * below.edge as usize];
                    match bounds[above as usize] {
                        Side::Face(face) => Some(face),
                        Side::Island(_) => around[above as usize],
                    }
                });
                around[walk as usize] = face;
                found.extend(face.map(|face| (walk, face)));
            }
            for &h in leaving.iter().filter(|&&h| h % 2 == 0) {
                cut.insert(edge(h));
            }
        }
        found
    }
}

/// Marks the edges that remain after pruning dead ends repeatedly.
fn without_dangles(nodes: usize, edges: &[[NodeIndex; 2]]) -> Vec<bool> {
    // For each node its number of edges and the XOR of their indices, which is the edge itself when only
    // one is left.
    let mut incident = vec![(0_u32, 0_u32); nodes];
    for (&[u, v], e) in edges.iter().zip(0..) {
        for node in [u, v] {
            incident[node as usize].0 += 1;
            incident[node as usize].1 ^= e;
        }
    }
    let mut kept = vec![true; edges.len()];
    for node in 0..nodes {
        let mut node = node;
        while incident[node].0 == 1 {
            let e = incident[node].1;
            kept[e as usize] = false;
            let [u, v] = edges[e as usize];
            for end in [u, v] {
                incident[end as usize].0 -= 1;
                incident[end as usize].1 ^= e;
            }
            node = if u as usize == node { v } else { u } as usize;
        }
    }
    kept
}

/// The nodes a half-edge leads from and to.
fn half_edge(edges: &[[NodeIndex; 2]], h: u32) -> [NodeIndex; 2] {
    let [u, v] = edges[h as usize / 2];
    if h.is_multiple_of(2) { [u, v] } else { [v, u] }
}

/// Orders half-edges leaving the same node counter-clockwise, starting from straight down.
fn by_angle(nodes: &[GridPoint], [from, p]: [NodeIndex; 2], [_, q]: [NodeIndex; 2]) -> Ordering {
    // Nodes are numbered by x, then y: a half-edge to a larger one points right or straight up.
    let rightward = |to: NodeIndex| to > from;
    rightward(q).cmp(&rightward(p)).then_with(|| {
        let origin = nodes[from as usize];
        cross(origin.to(nodes[q as usize]), origin.to(nodes[p as usize])).cmp(&0)
    })
}

/// An edge cut by the sweep, ordered from below; an edge without length stands for a point.
#[derive(Clone, Copy, Debug)]
struct CutEdge {
    left: GridPoint,
    right: GridPoint,
    edge: u32,
}

impl Ord for CutEdge {
    /// Edges compare only while the sweep cuts both, which it does at the later of their left ends.
    fn cmp(&self, other: &Self) -> Ordering {
        if self.edge == other.edge {
            return Ordering::Equal;
        }
        let side = if self.left == other.left {
            cross(self.left.to(self.right), other.left.to(other.right))
        } else if self.left < other.left {
            orientation(self.left, self.right, other.left)
        } else {
            -orientation(other.left, other.right, self.left)
        };
        0.cmp(&side)
    }
}

impl PartialOrd for CutEdge {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for CutEdge {
    fn eq(&self, other: &Self) -> bool {
        self.edge == other.edge
    }
}

impl Eq for CutEdge {}

/// Splits walks that pass through a node more than once into simple rings.
struct Splitter {
    /// For each node its position on the path so far, or [`NONE`].
    place: Vec<u32>,
    path: Vec<NodeIndex>,
}

impl Splitter {
    fn new(nodes: usize) -> Self {
        Self { place: vec![NONE; nodes], path: Vec::new() }
    }

    /// The simple rings of a walk. Without bridges the decomposition is unique: each ring is the part of
    /// the face's boundary in one block of the graph.
    fn rings(&mut self, walk: impl Iterator<Item = NodeIndex>) -> Vec<Vec<NodeIndex>> {
        let mut rings = Vec::new();
        for node in walk {
            let place = self.place[node as usize];
            if place != NONE {
                let ring = self.path.split_off(place as usize);
                for &node in &ring {
                    self.place[node as usize] = NONE;
                }
                rings.push(ring);
            }
            self.place[node as usize] = self.path.len() as u32;
            self.path.push(node);
        }
        for &node in &self.path {
            self.place[node as usize] = NONE;
        }
        rings.push(std::mem::take(&mut self.path));
        rings
    }
}
