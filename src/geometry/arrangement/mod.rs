//! The arrangement of segments: where they meet, exactly, on the 0.1 mm grid, and the faces between them.
//! It knows nothing of plans.

mod error;
mod faces;
pub(crate) mod grid;
mod snap_rounding;

use std::cmp::Ordering;

use grid::{GridPoint, Piece, cross};
use snap_rounding as snap;

use crate::geometry::{Point, Segment};

pub use error::{ArrangementError, PASSINGS_LIMIT, TESTS_LIMIT};
pub use faces::{Face, faces};

/// Index of a node of an [`Arrangement`].
pub type NodeIndex = u32;

/// Segments cut where they meet: nodes on the 0.1 mm grid, and edges that share nodes or nothing.
///
/// Segments may cross, touch, overlap, dangle, repeat, or have no length (those are left out). They are
/// snap-rounded: every end and every crossing moves to the nearest grid point, and a segment passing
/// within half a grid step of such a point is routed through it. All predicates are exact, so the result
/// is consistent however nearly the segments coincide, independent of their order and direction, and
/// moves with them by whole grid steps.
#[derive(Clone, Debug, Default)]
pub struct Arrangement {
    /// By x, then y.
    nodes: Vec<GridPoint>,
    /// Smaller node first; sorted, each once.
    edges: Vec<[NodeIndex; 2]>,
    /// Where in `chain_nodes` the chain of each piece starts; one more at the end.
    chain_starts: Vec<u32>,
    /// The nodes along each piece, from its first end to its second.
    chain_nodes: Vec<NodeIndex>,
    /// The pieces that make up each input segment.
    spans: Vec<Span>,
}

/// The pieces `first..end`, consecutive on a line, that form one segment.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    first: u32,
    end: u32,
    /// Whether the segment was given from its later end to its earlier one.
    backward: bool,
}

impl Arrangement {
    /// Arranges segments, given in metres.
    ///
    /// Takes O(n log n) time for n segments and crossings spread as in plans, and little more when all
    /// segments are long or collinear.
    ///
    /// # Errors
    /// When a segment is not finite or lies outside the drawing area, or when the segments meet more
    /// often than memory allows.
    pub fn new(segments: &[Segment]) -> Result<Self, ArrangementError> {
        if segments.len() > PASSINGS_LIMIT {
            return Err(ArrangementError::TooDense);
        }
        let (pieces, spans) = disjoint_pieces(segments)?;
        let snap::Snapped { nodes, passings } = snap::snap(&pieces)?;
        let (nodes, rank) = sorted(&nodes);
        let (chain_starts, mut chain_nodes) =
            grouped(pieces.len(), passings.iter().map(|&(piece, node)| (piece, rank[node as usize])));
        drop((passings, rank));
        for (piece, window) in pieces.iter().zip(chain_starts.windows(2)) {
            let chain = &mut chain_nodes[window[0] as usize..window[1] as usize];
            // A piece meets pixels in order of x, and of y within a column. Nodes are numbered by x, then
            // y, so only a falling piece needs to look at the points.
            if piece.a.y <= piece.b.y {
                chain.sort_unstable();
            } else {
                chain.sort_unstable_by_key(|&node| (nodes[node as usize].x, std::cmp::Reverse(node)));
            }
        }
        let links = chain_starts.windows(2).flat_map(|window| {
            chain_nodes[window[0] as usize..window[1] as usize]
                .windows(2)
                .map(|pair| (pair[0].min(pair[1]), pair[0].max(pair[1])))
        });
        let (link_starts, mut link_ends) = grouped(nodes.len(), links);
        let mut edges = Vec::with_capacity(link_ends.len());
        for (from, window) in (0..).zip(link_starts.windows(2)) {
            let ends = &mut link_ends[window[0] as usize..window[1] as usize];
            ends.sort_unstable();
            let mut last = None;
            for &to in ends.iter() {
                if last != Some(to) {
                    edges.push([from, to]);
                    last = Some(to);
                }
            }
        }
        Ok(Self { nodes, edges, chain_starts, chain_nodes, spans })
    }

    /// The number of nodes: ends of segments and crossings.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Where a node lies, in metres.
    pub fn position(&self, node: NodeIndex) -> Point {
        self.nodes[node as usize].point()
    }

    /// Where the nodes of a ring or chain lie, in metres.
    pub fn positions(&self, nodes: &[NodeIndex]) -> Vec<Point> {
        nodes.iter().map(|&node| self.position(node)).collect()
    }

    /// The edges, each once, its smaller node first, sorted.
    pub fn edges(&self) -> &[[NodeIndex; 2]] {
        &self.edges
    }

    /// The nodes a segment passes through, from its first end to its second, by the segment's index; none
    /// if it has no length.
    pub fn chain(&self, segment: usize) -> Vec<NodeIndex> {
        let Some(&Span { first, end, backward }) = self.spans.get(segment) else { return Vec::new() };
        let nodes = self.chain_starts[first as usize]..self.chain_starts[end as usize];
        let mut chain = self.chain_nodes[nodes.start as usize..nodes.end as usize].to_vec();
        // Each piece starts where the previous one ends.
        chain.dedup();
        if backward {
            chain.reverse();
        }
        chain
    }

    /// The nodes as grid points.
    pub(crate) fn grid_points(&self) -> &[GridPoint] {
        &self.nodes
    }
}

/// Groups (key, value) pairs by key, all keys below `keys`: where each group starts (plus one entry for
/// the end), and the values.
pub(crate) fn grouped(keys: usize, pairs: impl Iterator<Item = (u32, u32)> + Clone) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; keys + 1];
    for (key, _) in pairs.clone() {
        starts[key as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut values = vec![0_u32; starts[keys] as usize];
    for (key, value) in pairs {
        let slot = &mut next[key as usize];
        values[*slot as usize] = value;
        *slot += 1;
    }
    (starts, values)
}

/// The points sorted, and for each input point its index there.
fn sorted(points: &[GridPoint]) -> (Vec<GridPoint>, Vec<u32>) {
    // As one number each, which sorts twice as fast as two.
    let number = |value: i32| u64::from(value as u32 ^ 1 << 31);
    let mut order: Vec<(u64, u32)> =
        points.iter().zip(0..).map(|(point, i)| (number(point.x) << 32 | number(point.y), i)).collect();
    order.sort_unstable();
    let mut rank = vec![0; points.len()];
    for (&(_, i), place) in order.iter().zip(0..) {
        rank[i as usize] = place;
    }
    (order.iter().map(|&(_, i)| points[i as usize]).collect(), rank)
}

/// Cuts segments that overlap on a line at each other's ends, so that every part of the line is covered
/// once: otherwise thousands of segments on one line would meet each other's nodes quadratically often.
fn disjoint_pieces(segments: &[Segment]) -> Result<(Vec<Piece>, Vec<Span>), ArrangementError> {
    let mut whole: Vec<Piece> = Vec::with_capacity(segments.len());
    let mut given: Vec<u32> = Vec::with_capacity(segments.len());
    let mut spans = vec![Span::default(); segments.len()];
    for (i, segment) in segments.iter().enumerate() {
        let (Some(a), Some(b)) = (GridPoint::nearest(segment.a), GridPoint::nearest(segment.b)) else {
            return Err(ArrangementError::OutOfRange(i));
        };
        if a != b {
            spans[i].backward = b < a;
            whole.push(Piece { a: a.min(b), b: a.max(b) });
            given.push(i as u32);
        }
    }
    // Equal slopes have equal quotients, since division rounds correctly; few unequal ones do.
    let mut order: Vec<(u64, u32)> = whole
        .iter()
        .zip(0..)
        .map(|(piece, i)| {
            let (dx, dy) = piece.vector();
            // Adding zero turns -0.0 into 0.0.
            ((dy as f64 / dx as f64 + 0.0).to_bits(), i)
        })
        .collect();
    order.sort_unstable();
    let mut pieces: Vec<Piece> = Vec::with_capacity(whole.len());
    for parallel in order.chunk_by_mut(|p, q| p.0 == q.0) {
        if parallel.len() > 1 {
            parallel.sort_unstable_by(|p, q| {
                let (first, second) = (whole[p.1 as usize], whole[q.1 as usize]);
                by_line(first, second).then_with(|| (first.a, first.b, p.1).cmp(&(second.a, second.b, q.1)))
            });
        }
        let mut rest = &parallel[..];
        while let Some((&(_, first), _)) = rest.split_first() {
            // A cluster: all that overlap or touch in a chain along the line.
            let line = whole[first as usize];
            let mut end = line.b;
            let mut size = 1;
            for &(_, i) in &rest[1..] {
                let next = whole[i as usize];
                if next.a >= end || by_line(line, next).is_ne() {
                    break;
                }
                end = end.max(next.b);
                size += 1;
            }
            let (cluster, others) = rest.split_at(size);
            rest = others;
            let start = pieces.len() as u32;
            if size == 1 {
                pieces.push(line);
                let span = &mut spans[given[first as usize] as usize];
                (span.first, span.end) = (start, start + 1);
                continue;
            }
            let members = cluster.iter().map(|&(_, i)| (whole[i as usize], given[i as usize]));
            let mut cuts: Vec<GridPoint> = members.clone().flat_map(|(piece, _)| [piece.a, piece.b]).collect();
            cuts.sort_unstable();
            cuts.dedup();
            pieces.extend(cuts.windows(2).map(|pair| Piece { a: pair[0], b: pair[1] }));
            for (piece, segment) in members {
                let place = |end: GridPoint| start + cuts.partition_point(|&cut| cut < end) as u32;
                let span = &mut spans[segment as usize];
                (span.first, span.end) = (place(piece.a), place(piece.b));
            }
        }
    }
    Ok((pieces, spans))
}

/// Orders pieces by direction, and parallel ones by their line: equal when on the same line.
fn by_line(first: Piece, second: Piece) -> Ordering {
    let along = first.vector();
    // Directions all point right or straight up, so their order by angle is total.
    cross(second.vector(), along).cmp(&0).then_with(|| cross(along, first.a.to(second.a)).cmp(&0))
}
