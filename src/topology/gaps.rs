//! Doorways left open in walls.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;

use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::geometry::runs::ANGLE_TOLERANCE_RAD;
use crate::geometry::segments::{SegmentIndex, crossing};
use crate::geometry::{Bounds, Point, Segment, TOUCH_M, Vector};
use crate::plan::{CornerId, DEFAULT_WALL_THICKNESS_M, Plan, WallId};

/// The width in metres of a gap in a wall that counts as a doorway: 'more than 30 cm and less than 150
/// cm' (paper, section 3.3).
pub const DOORWAY_WIDTH_M: RangeInclusive<f64> = 0.30..=1.50;

/// A gap the size of a doorway between the free ends of two collinear walls.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// The walls' free ends, the smaller id first.
    pub ends: [CornerId; 2],
    /// The walls that end there, in the same order.
    pub walls: [WallId; 2],
    /// From the first end to the second.
    pub segment: Segment,
    pub width_m: f64,
}

/// The doorway-sized gaps in walls, by their ends.
///
/// Two walls are collinear when their directions, and the direction across the gap, differ by at most 10
/// degrees (paper, section 3.3), and the end of one is offset from the line of the other by less than the
/// thickness of the thicker one (a wall without thickness counts as a default partition). An end is free
/// when only one wall ends there. Each end has at most one gap, the narrowest. There is no gap where
/// another wall crosses or an opening already exists.
pub fn gaps(plan: &Plan) -> Vec<Gap> {
    let ends = free_ends(plan);
    let points = ends.iter().enumerate().map(|(i, end)| GeomWithData::new([end.at.x, end.at.y], i)).collect();
    let tree = RTree::bulk_load(points);
    let reach_m = *DOORWAY_WIDTH_M.end();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, end) in ends.iter().enumerate() {
        for near in tree.locate_within_distance([end.at.x, end.at.y], (reach_m + TOUCH_M).powi(2)) {
            let width_m = end.at.distance(ends[near.data].at);
            if near.data > i && fits(end, &ends[near.data]) {
                pairs.push((width_m, i, near.data));
            }
        }
    }
    pairs.sort_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2))));
    let obstacles = Obstacles::near(plan, pairs.iter().map(|&(_, i, j)| Segment::new(ends[i].at, ends[j].at)));
    let mut taken: BTreeSet<usize> = BTreeSet::new();
    let mut found: Vec<Gap> = Vec::new();
    for (width_m, i, j) in pairs {
        if taken.contains(&i) || taken.contains(&j) {
            continue;
        }
        let (p, q) = (&ends[i], &ends[j]);
        let segment = Segment::new(p.at, q.at);
        if obstacles.block(segment, [p.wall, q.wall]) {
            continue;
        }
        taken.extend([i, j]);
        found.push(Gap { ends: [p.corner, q.corner], walls: [p.wall, q.wall], segment, width_m });
    }
    found.sort_by_key(|gap| gap.ends);
    found
}

/// The end of a wall where no other wall ends.
struct FreeEnd {
    corner: CornerId,
    at: Point,
    wall: WallId,
    thickness_m: f64,
    /// Pointing out of the wall, into the open.
    outward: Vector,
}

/// The free ends of walls, by corner.
fn free_ends(plan: &Plan) -> Vec<FreeEnd> {
    // Sorted, since a map of all ends of a large plan takes longer.
    let mut walls_at: Vec<(CornerId, WallId)> =
        plan.walls().flat_map(|(id, wall)| [(wall.from, id), (wall.to, id)]).collect();
    walls_at.sort_unstable();
    let single = walls_at.chunk_by(|p, q| p.0 == q.0).filter_map(|at| if let [only] = at { Some(*only) } else { None });
    single
        .filter_map(|(corner, id)| {
            let wall = plan.wall(id)?;
            let (at, other) =
                (plan.position(corner)?, plan.position(if wall.from == corner { wall.to } else { wall.from })?);
            let thickness_m = if wall.thickness_m > 0.0 { wall.thickness_m } else { DEFAULT_WALL_THICKNESS_M };
            Some(FreeEnd { corner, at, wall: id, thickness_m, outward: (at - other).unit()? })
        })
        .collect()
}

/// Whether two free ends face each other across a gap of a doorway's width.
fn fits(p: &FreeEnd, q: &FreeEnd) -> bool {
    let across = q.at - p.at;
    let width_m = across.length();
    // A little slack: a gap drawn as 1.5 m counts.
    let in_range = width_m >= DOORWAY_WIDTH_M.start() - TOUCH_M && width_m <= DOORWAY_WIDTH_M.end() + TOUCH_M;
    let is_along = |direction: Vector, of: Vector| {
        direction.dot(of) > 0.0 && direction.cross(of).abs() <= direction.dot(of) * ANGLE_TOLERANCE_RAD.tan()
    };
    let aside_m = across.cross(p.outward).abs().max(across.cross(q.outward).abs());
    p.wall != q.wall
        && in_range
        && is_along(p.outward, -q.outward)
        && is_along(p.outward, across)
        && is_along(-q.outward, across)
        && aside_m < p.thickness_m.max(q.thickness_m)
}

/// A spatial index of the walls and openings of a plan near gaps.
struct Obstacles {
    walls: Vec<WallId>,
    wall_index: SegmentIndex,
    opening_index: SegmentIndex,
}

impl Obstacles {
    fn near(plan: &Plan, gaps: impl Iterator<Item = Segment>) -> Self {
        let gaps = SegmentIndex::new(gaps.collect());
        let reach_m = *DOORWAY_WIDTH_M.end();
        let is_near = |segment: Segment| gaps.near(segment.bounds().inflated(reach_m)).next().is_some();
        let (mut walls, mut segments, mut openings) = (Vec::new(), Vec::new(), Vec::new());
        if !gaps.all().is_empty() {
            let known = plan.walls().filter_map(|(id, wall)| Some((id, plan.wall_segment(wall)?)));
            (walls, segments) = known.filter(|&(_, segment)| is_near(segment)).unzip();
            openings = plan.openings().filter_map(|(_, opening)| plan.opening_segment(opening)).collect();
            openings.retain(|&segment| is_near(segment));
        }
        Self { walls, wall_index: SegmentIndex::new(segments), opening_index: SegmentIndex::new(openings) }
    }

    /// Whether a wall other than those beside it crosses a gap, or there is an opening in it.
    fn block(&self, gap: Segment, beside: [WallId; 2]) -> bool {
        let touches =
            |end: Point| gap.distance(end) <= TOUCH_M && end.distance(gap.a) > TOUCH_M && end.distance(gap.b) > TOUCH_M;
        let bounds = gap.bounds().inflated(TOUCH_M);
        let mut walls = self.wall_index.near(bounds).filter(|&i| !beside.contains(&self.walls[i]));
        let middle = gap.midpoint();
        let around = Bounds::of([middle]).inflated(gap.length() / 4.0);
        walls.any(|i| {
            let wall = self.wall_index.get(i);
            crossing(gap, wall).is_some() || touches(wall.a) || touches(wall.b)
        }) || self.opening_index.near(around).any(|i| self.opening_index.get(i).distance(middle) <= gap.length() / 4.0)
    }
}
