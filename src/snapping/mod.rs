//! Snapping: which exact point is meant by pointing near it.
//!
//! Ranked as in the design: corner, intersection, midpoint, perpendicular foot, wall, wall faces, alignment with
//! other corners, grid. What measures takes axes and faces alike. Independent of the screen: radii are in metres.

mod index;

pub use index::{IndexedEdge, PlanIndex};

use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::CornerId;

/// What a point was snapped to, strongest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SnapKind {
    Corner,
    Intersection,
    Midpoint,
    Perpendicular,
    /// On the axis of a wall, on a boundary, on a guide line.
    Wall,
    /// The end of an opening.
    Jamb,
    /// Where the faces of walls meet.
    FaceCorner,
    /// On the face of a wall.
    Face,
    Alignment,
    Grid,
    /// Nothing is near; at most constrained to a right angle with what was drawn before.
    Free,
}

impl SnapKind {
    /// The caption beside the marker.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Corner => "corner",
            Self::Intersection => "intersection",
            Self::Midpoint => "midpoint",
            Self::Perpendicular => "perpendicular",
            Self::Wall => "axis",
            Self::Jamb => "edge of an opening",
            Self::FaceCorner => "corner of faces",
            Self::Face => "face",
            Self::Alignment => "in line",
            Self::Grid => "grid",
            Self::Free => "",
        }
    }
}

/// How the faces of walls count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Faces {
    /// Not at all: what is drawn lies on axes.
    #[default]
    Off,
    /// Where no axis is near.
    BehindAxes,
    /// Like axes, and the ends of openings too: for measuring.
    LikeAxes,
}

impl Faces {
    /// The rank of a kind, the strongest first.
    fn rank(self, kind: SnapKind) -> SnapKind {
        match (self, kind) {
            (Self::LikeAxes, SnapKind::FaceCorner | SnapKind::Jamb) => SnapKind::Corner,
            (Self::LikeAxes, SnapKind::Face) => SnapKind::Wall,
            _ => kind,
        }
    }
}

/// A candidate point.
#[derive(Clone, Debug, PartialEq)]
pub struct Snap {
    pub point: Point,
    pub kind: SnapKind,
    /// The corner, if it is one of the plan's.
    pub corner: Option<CornerId>,
    /// Lines that explain the snap: from the corners it aligns with.
    pub guides: Vec<Segment>,
}

/// A snapping query.
#[derive(Clone, Debug)]
pub struct Query<'a> {
    pub pointer: Point,
    /// The snap radius in metres: a radius in pixels divided by the zoom.
    pub radius_m: f64,
    /// How far alignment with corners may pull, in metres: at most as far as the radius.
    pub alignment_m: f64,
    /// The visible part of the plan: corners elsewhere are ignored for alignment.
    pub seen: Bounds,
    /// The start of the line being drawn.
    pub from: Option<Point>,
    /// The direction of the previous line: right angles to it count besides the axes.
    pub along: Option<Vector>,
    /// Whether the line is constrained to right angles.
    pub right_angles: bool,
    /// Whether to snap to corners, walls and alignments at all.
    pub objects: bool,
    /// How the faces of walls count.
    pub faces: Faces,
    /// Spacing of the grid in metres; `None` not to snap to it.
    pub grid_m: Option<f64>,
    /// More points to snap to like corners: of what is being drawn, of the storey below.
    pub points: &'a [Point],
    /// More lines to snap to like walls: guide lines, walls of the storey below.
    pub lines: &'a [Segment],
}

/// The most edges near the pointer that are intersected with each other.
const MOST_CROSSED: usize = 48;

/// Directions within this angle of the axes or the previous line count as the same: 1e-9 rad is below any
/// drawing's precision.
const SAME_DIRECTION: f64 = 1e-9;

/// All candidate points, best first; never empty: the last is the pointer itself, or its position on the
/// right-angle ray.
pub fn candidates(index: &PlanIndex, query: &Query<'_>) -> Vec<Snap> {
    let ray = query.ray();
    let free = ray.map_or(query.pointer, |(from, way)| from + way * (query.pointer - from).dot(way));
    let mut found: Vec<Snap> = Vec::new();
    if query.objects {
        corners(index, query, &mut found);
        let near = edges_near(index, query);
        on_edges(&near, query, ray, &mut found);
        if query.faces != Faces::Off {
            on_faces(&index.faces_near(query.pointer, query.radius_m), query, ray, &mut found);
        }
        if query.faces == Faces::LikeAxes {
            let jamb = |point| Snap { point, kind: SnapKind::Jamb, corner: None, guides: Vec::new() };
            let jambs = index.jambs_near(query.pointer, query.radius_m).into_iter().map(jamb);
            found.extend(jambs.map(|snap| Snap { point: snap.point.trimmed(), ..snap }));
        }
        alignments(index, query, ray, free, &mut found);
    }
    if let Some(point) = query.grid_m.and_then(|spacing_m| on_grid(query, ray, free, spacing_m)) {
        push(&mut found, query, free, Snap { point, kind: SnapKind::Grid, corner: None, guides: Vec::new() });
    }
    let distance = |snap: &Snap| snap.point.distance(query.pointer);
    let rank = |snap: &Snap| query.faces.rank(snap.kind);
    found.sort_by(|p, q| rank(p).cmp(&rank(q)).then(distance(p).total_cmp(&distance(q))));
    let mut kept: Vec<Snap> = Vec::new();
    for snap in found {
        if !kept.iter().any(|other| other.point.distance(snap.point) < 1e-6) {
            kept.push(snap);
        }
    }
    kept.push(Snap { point: free.trimmed(), kind: SnapKind::Free, corner: None, guides: Vec::new() });
    kept
}

impl Query<'_> {
    /// The right-angle ray nearest to the pointer.
    fn ray(&self) -> Option<(Point, Vector)> {
        let from = self.from.filter(|_| self.right_angles)?;
        let way = self.pointer - from;
        let mut axes = vec![Vector::new(1.0, 0.0)];
        if let Some(along) = self.along.and_then(Vector::unit)
            && along.x.abs().min(along.y.abs()) > SAME_DIRECTION
        {
            axes.push(along);
        }
        let directions = axes.into_iter().flat_map(|axis| [axis, axis.left(), -axis, -axis.left()]);
        directions.max_by(|p, q| p.dot(way).total_cmp(&q.dot(way))).map(|direction| (from, direction))
    }
}

/// Adds a point if it is near enough to the pointer or to its position on the right-angle ray.
fn push(found: &mut Vec<Snap>, query: &Query<'_>, free: Point, snap: Snap) {
    let distance_m = snap.point.distance(query.pointer).min(snap.point.distance(free));
    if distance_m <= query.radius_m && snap.point.is_finite() {
        found.push(Snap { point: snap.point.trimmed(), ..snap });
    }
}

fn corners(index: &PlanIndex, query: &Query<'_>, found: &mut Vec<Snap>) {
    for (id, point) in index.corners_near(query.pointer, query.radius_m) {
        found.push(Snap { point, kind: SnapKind::Corner, corner: Some(id), guides: Vec::new() });
    }
    for &point in query.points {
        if point.distance(query.pointer) <= query.radius_m {
            found.push(Snap { point, kind: SnapKind::Corner, corner: None, guides: Vec::new() });
        }
    }
}

fn edges_near(index: &PlanIndex, query: &Query<'_>) -> Vec<Segment> {
    let mut near: Vec<Segment> =
        index.edges_near(query.pointer, query.radius_m).into_iter().map(|edge| edge.segment).collect();
    near.extend(query.lines.iter().copied().filter(|line| line.distance(query.pointer) <= query.radius_m));
    near
}

/// Intersections, midpoints, perpendicular feet and nearest points of the edges near the pointer.
fn on_edges(near: &[Segment], query: &Query<'_>, ray: Option<(Point, Vector)>, found: &mut Vec<Snap>) {
    let mut add = |point: Point, kind: SnapKind, guides: Vec<Segment>| {
        push(found, query, query.pointer, Snap { point, kind, corner: None, guides });
    };
    for (i, &edge) in near.iter().enumerate() {
        for &other in near.iter().take(MOST_CROSSED).skip(i + 1) {
            if let Some(point) = crossing(edge, other) {
                add(point, SnapKind::Intersection, Vec::new());
            }
        }
        if let Some((from, way)) = ray {
            // Where the right-angle ray meets the wall.
            let reach_m = (query.pointer - from).length() + query.radius_m;
            if let Some(point) = crossing(edge, Segment::new(from, from + way * reach_m)) {
                let kind = if is_perpendicular(edge, way) { SnapKind::Perpendicular } else { SnapKind::Intersection };
                add(point, kind, vec![Segment::new(from, point)]);
            }
        }
        add(edge.midpoint(), SnapKind::Midpoint, Vec::new());
        if let Some(from) = query.from {
            let foot = edge.nearest_point(from);
            if is_perpendicular(edge, foot - from) {
                add(foot, SnapKind::Perpendicular, vec![Segment::new(from, foot)]);
            }
        }
        add(edge.nearest_point(query.pointer), SnapKind::Wall, Vec::new());
    }
}

/// Where faces meet each other or the right-angle ray, their ends, middles and nearest points.
fn on_faces(near: &[Segment], query: &Query<'_>, ray: Option<(Point, Vector)>, found: &mut Vec<Snap>) {
    let mut add = |point: Point, kind: SnapKind, guides: Vec<Segment>| {
        push(found, query, query.pointer, Snap { point, kind, corner: None, guides });
    };
    for (i, &face) in near.iter().enumerate() {
        for end in [face.a, face.b] {
            add(end, SnapKind::FaceCorner, Vec::new());
        }
        for &other in near.iter().take(MOST_CROSSED).skip(i + 1) {
            if let Some(point) = crossing(face, other) {
                add(point, SnapKind::FaceCorner, Vec::new());
            }
        }
        if let Some((from, way)) = ray {
            let reach_m = (query.pointer - from).length() + query.radius_m;
            if let Some(point) = crossing(face, Segment::new(from, from + way * reach_m)) {
                add(point, SnapKind::Face, vec![Segment::new(from, point)]);
            }
        }
        if query.faces == Faces::LikeAxes {
            add(face.midpoint(), SnapKind::Midpoint, Vec::new());
            if let Some(from) = query.from {
                let foot = face.nearest_point(from);
                if is_perpendicular(face, foot - from) {
                    add(foot, SnapKind::Perpendicular, vec![Segment::new(from, foot)]);
                }
            }
        }
        add(face.nearest_point(query.pointer), SnapKind::Face, Vec::new());
    }
}

/// Whether a direction is perpendicular to an edge.
fn is_perpendicular(edge: Segment, way: Vector) -> bool {
    match (edge.vector().unit(), way.unit()) {
        (Some(edge), Some(way)) => edge.dot(way).abs() < 1e-6,
        _ => false,
    }
}

/// Where two segments cross or touch; `None` if they are parallel.
fn crossing(p: Segment, q: Segment) -> Option<Point> {
    let (along, across) = (p.vector(), q.vector());
    let denominator = along.cross(across);
    if denominator.abs() <= 1e-12 * along.length() * across.length() || denominator == 0.0 {
        return None;
    }
    let t = (q.a - p.a).cross(across) / denominator;
    let u = (q.a - p.a).cross(along) / denominator;
    let within = |value: f64| (-1e-9..=1.0 + 1e-9).contains(&value);
    (within(t) && within(u)).then(|| p.a + along * t)
}

/// Points aligned with corners of the plan, horizontally or vertically.
fn alignments(index: &PlanIndex, query: &Query<'_>, ray: Option<(Point, Vector)>, free: Point, found: &mut Vec<Snap>) {
    let reach_m = query.alignment_m.min(query.radius_m);
    // From the start of a line its own ray says the same.
    let is_start = |point: Point| query.from.is_some_and(|from| from.distance(point) < 1e-6);
    let choose = |points: Vec<Point>| {
        let all = points.into_iter().chain(query.points.iter().copied()).filter(|&point| !is_start(point));
        all.collect::<Vec<Point>>()
    };
    let nearest = |points: &[Point], off: &dyn Fn(Point) -> f64, aside: &dyn Fn(Point) -> f64| {
        let near = points.iter().copied().filter(|&point| off(point) <= reach_m);
        near.min_by(|&p, &q| {
            // The smallest movement; if about equal, the nearest corner.
            let step = reach_m / 4.0;
            let key = |point: Point| (off(point) / step).floor();
            key(p).total_cmp(&key(q)).then(aside(p).total_cmp(&aside(q)))
        })
    };
    let columns = choose(index.corners_at_x(free.x, reach_m, query.seen));
    let rows = choose(index.corners_at_y(free.y, reach_m, query.seen));
    let in_column = nearest(&columns, &|point| (point.x - free.x).abs(), &|point| (point.y - query.pointer.y).abs());
    let in_row = nearest(&rows, &|point| (point.y - free.y).abs(), &|point| (point.x - query.pointer.x).abs());
    let mut add = |point: Point, with: &[Point]| {
        // Along a line that is off the axes, the way to what is in line is longer.
        if point.distance(query.pointer).min(point.distance(free)) > reach_m {
            return;
        }
        let guides = with.iter().map(|&corner| Segment::new(corner, point)).collect();
        push(found, query, free, Snap { point, kind: SnapKind::Alignment, corner: None, guides });
    };
    match ray {
        // Along the ray, one alignment is enough.
        Some((from, way)) => {
            if let Some(corner) = in_column
                && way.x.abs() > 1e-6
            {
                add(from + way * ((corner.x - from.x) / way.x), &[corner]);
            }
            if let Some(corner) = in_row
                && way.y.abs() > 1e-6
            {
                add(from + way * ((corner.y - from.y) / way.y), &[corner]);
            }
        }
        None => match (in_column, in_row) {
            (Some(column), Some(row)) => add(Point::new(column.x, row.y), &[column, row]),
            (Some(column), None) => add(Point::new(column.x, free.y), &[column]),
            (None, Some(row)) => add(Point::new(free.x, row.y), &[row]),
            (None, None) => {}
        },
    }
}

/// The nearest grid point; along a ray, a length that is a multiple of the spacing.
fn on_grid(query: &Query<'_>, ray: Option<(Point, Vector)>, free: Point, spacing_m: f64) -> Option<Point> {
    if spacing_m.is_nan() || spacing_m <= 0.0 {
        return None;
    }
    let round = |value: f64| (value / spacing_m).round() * spacing_m;
    let point = match ray {
        Some((from, way)) => from + way * round((free - from).dot(way)),
        None => Point::new(round(query.pointer.x), round(query.pointer.y)),
    };
    // A grid finer than the radius always applies; a coarser one only near its points.
    (point.distance(free) <= query.radius_m.max(spacing_m)).then_some(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Builder, Meta, Plan};

    /// An L of two walls: from (0, 0) to (4, 0) to (4, 3), and one from (0, 2) to (6, 2) across.
    fn plan() -> Plan {
        let mut builder = Builder::new(Meta::default());
        let corners =
            [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 2.0), (6.0, 2.0)].map(|(x, y)| builder.corner(Point::new(x, y)));
        builder.wall(corners[0], corners[1], 0.1);
        builder.wall(corners[1], corners[2], 0.1);
        builder.wall(corners[3], corners[4], 0.1);
        builder.finish().expect("a valid plan")
    }

    fn ask(x: f64, y: f64) -> Query<'static> {
        Query {
            pointer: Point::new(x, y),
            radius_m: 0.2,
            alignment_m: 0.2,
            seen: Bounds::of([Point::new(-10.0, -10.0), Point::new(10.0, 10.0)]),
            from: None,
            along: None,
            right_angles: true,
            objects: true,
            faces: Faces::Off,
            grid_m: None,
            points: &[],
            lines: &[],
        }
    }

    fn first(query: &Query<'_>) -> (SnapKind, Point) {
        let snap = candidates(&PlanIndex::new(&plan()), query).remove(0);
        (snap.kind, snap.point)
    }

    #[test]
    fn stronger_things_win_though_weaker_ones_are_nearer() {
        assert_eq!(first(&ask(3.9, 0.02)), (SnapKind::Corner, Point::new(4.0, 0.0)));
        assert_eq!(first(&ask(3.95, 2.1)), (SnapKind::Intersection, Point::new(4.0, 2.0)));
        assert_eq!(first(&ask(2.1, 0.05)), (SnapKind::Midpoint, Point::new(2.0, 0.0)));
        assert_eq!(first(&ask(1.2, 0.05)), (SnapKind::Wall, Point::new(1.2, 0.0)));
        assert_eq!(first(&ask(7.0, 7.0)), (SnapKind::Free, Point::new(7.0, 7.0)));
    }

    #[test]
    fn a_line_keeps_to_right_angles_and_meets_walls_there() {
        let from = |x, y, from| Query { from: Some(from), ..ask(x, y) };
        // Along x from (1, 1), the pointer a little off: keeps the y of the start.
        let start = Point::new(1.0, 1.0);
        assert_eq!(first(&from(2.7, 1.15, start)), (SnapKind::Free, Point::new(2.7, 1.0)));
        // Onto the wall at x = 4, perpendicularly.
        assert_eq!(first(&from(3.9, 1.1, start)), (SnapKind::Perpendicular, Point::new(4.0, 1.0)));
        let free = Query { right_angles: false, ..from(2.7, 1.15, start) };
        assert_eq!(first(&free), (SnapKind::Free, Point::new(2.7, 1.15)));
        // Right angles to a slanted line drawn before.
        let slanted = Query { along: Some(Vector::new(1.0, 1.0)), ..from(-0.98, -1.0, Point::new(-2.0, -2.0)) };
        let (_, point) = first(&slanted);
        assert!((point.x - point.y).abs() < 1e-3, "{point:?}");
    }

    #[test]
    fn corners_elsewhere_align() {
        let (kind, point) = first(&ask(6.1, 3.1));
        assert_eq!((kind, point), (SnapKind::Alignment, Point::new(6.0, 3.0)));
        let along = Query { from: Some(Point::new(0.0, 5.0)), ..ask(5.9, 5.1) };
        assert_eq!(first(&along), (SnapKind::Alignment, Point::new(6.0, 5.0)));
    }

    #[test]
    fn alignment_can_be_weaker_than_the_rest() {
        let weak = |x, y| Query { alignment_m: 0.05, ..ask(x, y) };
        assert_eq!(first(&weak(6.1, 3.1)), (SnapKind::Free, Point::new(6.1, 3.1)));
        assert_eq!(first(&weak(6.04, 3.02)), (SnapKind::Alignment, Point::new(6.0, 3.0)));
        // Along a slanted line it pulls no further than across.
        let slanted = Query {
            from: Some(Point::new(-1.0, 5.0)),
            along: Some(Vector::new(10.0, 1.0)),
            alignment_m: 0.05,
            ..ask(3.6, 5.45)
        };
        let (kind, point) = first(&slanted);
        assert!(kind != SnapKind::Alignment || point.distance(slanted.pointer) <= 0.06, "{kind:?} {point:?}");
        assert_eq!(first(&weak(3.9, 0.02)), (SnapKind::Corner, Point::new(4.0, 0.0)));
    }

    #[test]
    fn the_grid_comes_last_and_counts_lengths_along_a_line() {
        let grid = Query { grid_m: Some(0.5), ..ask(7.6, 7.4) };
        assert_eq!(first(&grid), (SnapKind::Grid, Point::new(7.5, 7.5)));
        let along = Query { from: Some(Point::new(7.1, 7.1)), grid_m: Some(0.5), ..ask(8.65, 7.2) };
        assert_eq!(first(&along), (SnapKind::Grid, Point::new(8.6, 7.1)));
    }

    #[test]
    fn what_measures_takes_faces_like_axes() {
        let measure = |x, y| Query { faces: Faces::LikeAxes, radius_m: 0.08, ..ask(x, y) };
        assert_eq!(first(&measure(1.2, 0.06)), (SnapKind::Face, Point::new(1.2, 0.05)));
        assert_eq!(first(&measure(1.2, 0.01)), (SnapKind::Wall, Point::new(1.2, 0.0)));
        // The corner of the room between the two walls, and of the building.
        assert_eq!(first(&measure(3.94, 0.06)), (SnapKind::FaceCorner, Point::new(3.95, 0.05)));
        assert_eq!(first(&measure(4.06, -0.06)), (SnapKind::FaceCorner, Point::new(4.05, -0.05)));
        assert_eq!(first(&measure(4.01, 0.01)), (SnapKind::Corner, Point::new(4.0, 0.0)));
        // Walls that cross without a corner.
        assert_eq!(first(&measure(3.94, 2.06)), (SnapKind::FaceCorner, Point::new(3.95, 2.05)));
        // Drawn is along axes, and where none is near along a face.
        let draw = |y, radius_m| Query { faces: Faces::BehindAxes, radius_m, ..ask(1.2, y) };
        assert_eq!(first(&draw(0.06, 0.08)), (SnapKind::Wall, Point::new(1.2, 0.0)));
        assert_eq!(first(&draw(0.06, 0.02)), (SnapKind::Face, Point::new(1.2, 0.05)));
    }

    #[test]
    fn nothing_attracts_when_suspended() {
        let alone = Query { objects: false, right_angles: false, ..ask(3.99, 0.01) };
        assert_eq!(candidates(&PlanIndex::new(&plan()), &alone).len(), 1);
        assert_eq!(first(&alone), (SnapKind::Free, Point::new(3.99, 0.01)));
    }
}
