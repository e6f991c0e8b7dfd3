//! Walls drawn by a face instead of the axis: where the axis runs, and how walls of several thicknesses join.

use super::draw::{Drawn, draw_walls};
use super::{EditError, move_corners};
use crate::geometry::{Point, Segment, Vector, polygon};
use crate::plan::{CornerId, Plan};
use crate::topology::wall_bodies;

/// Where a wall stands, seen along the line that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lies {
    /// On the left: the line is its right face.
    Left,
    /// The line is its axis.
    #[default]
    Centre,
    /// On the right: the line is its left face.
    Right,
}

impl Lies {
    pub const ALL: [Self; 3] = [Self::Left, Self::Centre, Self::Right];

    /// Its name in commands and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Centre => "centre",
            Self::Right => "right",
        }
    }

    /// The next one, to go through them with a key.
    pub const fn next(self) -> Self {
        match self {
            Self::Left => Self::Centre,
            Self::Centre => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// How far to the left of the line the axis is, in metres.
    fn off_m(self, thickness_m: f64) -> f64 {
        match self {
            Self::Left => thickness_m / 2.0,
            Self::Centre => 0.0,
            Self::Right => -thickness_m / 2.0,
        }
    }
}

/// The axes of the walls near a point, or of more, with their thickness in metres. Near is where their
/// faces may pass through the point.
pub type WallsNear<'a> = dyn Fn(Point) -> Vec<(Segment, f64)> + 'a;

/// How the walls along a line are built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Built {
    pub thickness_m: f64,
    pub lies: Lies,
}

/// Two points this near, in metres, are one: the grid.
const SAME_M: f64 = 1e-4;

/// A point this near to a face, in metres, is on it: rounding to the grid, at any angle.
const ON_FACE_M: f64 = 1e-3;

/// Below this sine of the angle between them, lines count as parallel: 5.7 degrees.
const PARALLEL: f64 = 0.1;

/// A corner further away than this many thicknesses is no joint: the walls meet at too sharp an angle.
const LONGEST_MITRE: f64 = 6.0;

/// Draws a chain of walls beside a line: their faces join at its corners. With `drawn` the first stretch stands
/// already, built so; the chain goes on from it.
///
/// The chain can be drawn again with one more corner: what stands of it is taken up, and its loose end moves to
/// where the faces join. An end on the face of another wall reaches on to its axis, so that they join.
///
/// # Errors
/// As [`draw_walls`].
pub fn draw_walls_beside(plan: &Plan, line: &[Point], built: Built, drawn: Option<Built>) -> Result<Drawn, EditError> {
    let chain = Chain::new(line, built, drawn);
    let walls = |_| wall_bodies::axes(plan).map(|(_, thickness_m, axis)| (axis, thickness_m)).collect();
    let Some(axis) = chain.as_ref().and_then(|chain| chain.axis(&walls)) else {
        return draw_walls(plan, line, built.thickness_m);
    };
    let mut next = plan.clone();
    // Where the chain ended before its last corner, and where it began before it closed.
    let earlier = chain.as_ref().and_then(Chain::without_last).and_then(|earlier| earlier.axis(&walls));
    if let Some(earlier) = earlier {
        let before_last = axis.stretches.len().checked_sub(2).and_then(|index| axis.stretches.get(index));
        let ends = [(earlier.end(), before_last.map(|stretch| stretch.b)), (earlier.start(), axis.start())];
        for (from, to) in ends {
            if let (Some(from), Some(to)) = (from, to) {
                next = with_loose_end(&next, from, to)?;
            }
        }
    }
    for jog in axis.jogs() {
        // Without a thickness: it lies within the bodies of the walls that it joins.
        if let Ok(joined) = draw_walls(&next, &[jog.a, jog.b], 0.0) {
            next = joined.plan;
        }
    }
    let first = usize::from(drawn.is_some());
    let mut path: Vec<Point> = Vec::new();
    let mut result: Option<Drawn> = None;
    let mut refused = None;
    let mut draw = |next: &mut Plan, path: &[Point]| match draw_walls(next, path, built.thickness_m) {
        Ok(drawn) => {
            *next = drawn.plan.clone();
            let all = result.get_or_insert_with(|| Drawn { walls: Vec::new(), rooms: Vec::new(), ..drawn.clone() });
            all.walls.extend(drawn.walls);
            all.rooms.extend(drawn.rooms);
        }
        Err(error) => refused = Some(error),
    };
    for stretch in &axis.stretches[first.min(axis.stretches.len())..] {
        if path.last().is_some_and(|last| last.distance(stretch.a) > SAME_M) {
            draw(&mut next, &path);
            path.clear();
        }
        if path.is_empty() {
            path.push(stretch.a);
        }
        path.push(stretch.b);
    }
    draw(&mut next, &path);
    match (result, refused) {
        (Some(mut drawn), _) => {
            drawn.plan = next;
            drawn.rooms.sort_unstable();
            drawn.rooms.dedup();
            Ok(drawn)
        }
        (None, Some(error)) => Err(error),
        (None, None) => draw_walls(plan, line, built.thickness_m),
    }
}

/// The axes of the walls that [`draw_walls_beside`] draws, with their thickness in metres: for a preview, which tells
/// what walls stand near a point.
pub fn walls_beside(near: &WallsNear<'_>, line: &[Point], built: Built, drawn: Option<Built>) -> Vec<(Segment, f64)> {
    let Some(chain) = Chain::new(line, built, drawn) else { return Vec::new() };
    let Some(axis) = chain.axis(near) else { return Vec::new() };
    axis.stretches.into_iter().zip(chain.pieces).map(|(axis, piece)| (axis, piece.built.thickness_m)).collect()
}

/// The axes of walls around a clear space: the boundary of a room that is as large inside as this ring, which may run
/// either way. The ring itself where a wall has no thickness, or none of it is left.
pub fn boundary_around(clear: &[Point], thickness_m: f64) -> Vec<Point> {
    let lies = if polygon::signed_area(clear) > 0.0 { Lies::Right } else { Lies::Left };
    let closed: Vec<Point> = clear.iter().chain(clear.first()).copied().collect();
    let axes: Vec<Segment> = walls_beside(&|_| Vec::new(), &closed, Built { thickness_m, lies }, None)
        .into_iter()
        .map(|(axis, _)| axis)
        .collect();
    let mut ring: Vec<Point> = axes.iter().flat_map(|axis| [axis.a, axis.b]).collect();
    ring.dedup_by(|next, kept| next.distance(*kept) <= SAME_M);
    while ring.len() > 1 && ring[0].distance(ring[ring.len() - 1]) <= SAME_M {
        ring.pop();
    }
    if ring.len() < 3 { clear.to_vec() } else { ring }
}

/// A straight piece of the line.
#[derive(Clone, Copy, Debug)]
struct Piece {
    line: Segment,
    built: Built,
}

impl Piece {
    fn along(&self) -> Vector {
        // Pieces have a length.
        self.line.vector().unit().unwrap_or(Vector::new(1.0, 0.0))
    }

    /// Its axis, as long as the line.
    fn axis(&self) -> Segment {
        let by = self.along().left() * self.built.lies.off_m(self.built.thickness_m);
        Segment::new(self.line.a + by, self.line.b + by)
    }
}

/// The line that is drawn, piece by piece.
struct Chain {
    pieces: Vec<Piece>,
    is_closed: bool,
}

/// The axes of a chain, piece by piece.
struct Axis {
    stretches: Vec<Segment>,
    is_closed: bool,
}

impl Chain {
    /// `None` for a line without a length.
    fn new(line: &[Point], built: Built, drawn: Option<Built>) -> Option<Self> {
        let pairs = line.windows(2).filter(|pair| pair[0].distance(pair[1]) > SAME_M);
        let piece = |(i, pair): (usize, &[Point])| Piece {
            line: Segment::new(pair[0], pair[1]),
            built: drawn.filter(|_| i == 0).unwrap_or(built),
        };
        let pieces: Vec<Piece> = pairs.enumerate().map(piece).collect();
        let (first, last) = (pieces.first()?, pieces.last()?);
        let is_closed = pieces.len() > 2 && first.line.a.distance(last.line.b) <= SAME_M;
        Some(Self { pieces, is_closed })
    }

    /// The chain as it stood before its last corner; `None` if it is the first piece.
    fn without_last(&self) -> Option<Self> {
        let (_, pieces) = self.pieces.split_last()?;
        (!pieces.is_empty()).then(|| Self { pieces: pieces.to_vec(), is_closed: false })
    }

    /// The axes, joined where the faces join; `None` for a chain without pieces.
    fn axis(&self, near: &WallsNear<'_>) -> Option<Axis> {
        let mut stretches: Vec<Segment> = self.pieces.iter().map(Piece::axis).collect();
        let count = stretches.len();
        for i in 0..count {
            let j = (i + 1) % count;
            if (j > 0 || self.is_closed)
                && let Some(at) = joint(&self.pieces[i], &self.pieces[j])
            {
                stretches[i].b = at;
                stretches[j].a = at;
            }
        }
        if !self.is_closed {
            let (first, last) = (self.pieces.first()?, self.pieces.last()?);
            stretches[0].a = reaching(near(first.line.a), first.line.a, stretches[0].a, -first.along());
            stretches[count - 1].b = reaching(near(last.line.b), last.line.b, stretches[count - 1].b, last.along());
        }
        Some(Axis { stretches, is_closed: self.is_closed })
    }
}

impl Axis {
    fn start(&self) -> Option<Point> {
        self.stretches.first().map(|stretch| stretch.a)
    }

    fn end(&self) -> Option<Point> {
        self.stretches.last().map(|stretch| stretch.b)
    }

    /// From the end of a stretch to the start of the next, where walls in line are of several thicknesses.
    fn jogs(&self) -> Vec<Segment> {
        let count = self.stretches.len();
        let pairs = (0..count).map(|i| (i, (i + 1) % count)).filter(|(_, j)| *j > 0 || self.is_closed);
        let jogs = pairs.map(|(i, j)| Segment::new(self.stretches[i].b, self.stretches[j].a));
        jogs.filter(|jog| jog.length() > SAME_M).collect()
    }
}

/// Where the axes of two pieces meet, so that their faces do; `None` for pieces in line, and for too sharp a corner.
fn joint(first: &Piece, second: &Piece) -> Option<Point> {
    let (p, q) = (first.axis(), second.axis());
    let (along, next) = (first.along(), second.along());
    let turn = along.cross(next);
    if turn.abs() < PARALLEL {
        return (p.b.distance(q.a) <= SAME_M).then_some(p.b);
    }
    let at = p.b + along * ((q.a - p.b).cross(next) / turn);
    let thickest_m = first.built.thickness_m.max(second.built.thickness_m);
    (at.distance(first.line.b) <= LONGEST_MITRE * thickest_m.max(SAME_M)).then_some(at.trimmed())
}

/// The end of an axis whose clicked point is on the face of another wall: carried on to that wall's axis.
fn reaching(walls: Vec<(Segment, f64)>, clicked: Point, end: Point, outwards: Vector) -> Point {
    let reached = walls.into_iter().filter_map(|(axis, thickness_m)| {
        let way = axis.vector().unit()?;
        let half_m = thickness_m / 2.0;
        let (aside_m, place_m) = (way.cross(clicked - axis.a).abs(), (clicked - axis.a).dot(way));
        let is_on_face = half_m > 0.0
            && (aside_m - half_m).abs() <= ON_FACE_M
            && (-half_m - ON_FACE_M..=axis.length() + half_m + ON_FACE_M).contains(&place_m);
        let across = outwards.cross(way);
        if !is_on_face || across.abs() < PARALLEL {
            return None;
        }
        let by_m = (axis.a - end).cross(way) / across;
        // Outwards, and no further than through the wall.
        (by_m > 0.0 && by_m <= thickness_m / across.abs() + ON_FACE_M).then_some(by_m)
    });
    let nearest_m = reached.min_by(f64::total_cmp);
    nearest_m.map_or(end, |by_m| (end + outwards * by_m).trimmed())
}

/// The plan with the corner at one point moved to another, if it is the end of one wall and of nothing else.
fn with_loose_end(plan: &Plan, from: Point, to: Point) -> Result<Plan, EditError> {
    if from.distance(to) <= SAME_M {
        return Ok(plan.clone());
    }
    let at: Vec<CornerId> =
        plan.corners().filter(|(_, corner)| corner.position.distance(from) <= SAME_M).map(|(id, _)| id).collect();
    let &[corner] = at.as_slice() else { return Ok(plan.clone()) };
    let walls = plan.walls().filter(|(_, wall)| wall.from == corner || wall.to == corner).count();
    let is_used = plan.rooms().any(|(_, room)| room.rings().any(|ring| ring.contains(&corner)));
    if walls != 1 || is_used {
        return Ok(plan.clone());
    }
    move_corners(plan, &[(corner, to)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit;
    use crate::topology::{RoomShapes, net_rooms};

    fn line(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    /// Draws corner by corner, as a person does.
    fn drawn(plan: &Plan, points: &[(f64, f64)], built: Built) -> Plan {
        let points = line(points);
        (2..=points.len()).fold(plan.clone(), |plan, count| {
            draw_walls_beside(&plan, &points[..count], built, None).expect("it is drawn").plan
        })
    }

    fn net_areas(plan: &Plan) -> Vec<f64> {
        let net = net_rooms(plan, &RoomShapes::new(plan));
        net.into_iter().flatten().map(|net| (net.area_m2 * 1e4).round() / 1e4).collect()
    }

    const ROOM: [(f64, f64); 5] = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)];

    #[test]
    fn the_line_that_is_drawn_is_the_face() {
        for (lies, clear_m2) in [(Lies::Right, 12.0), (Lies::Centre, 3.7 * 2.7), (Lies::Left, 3.4 * 2.4)] {
            let built = Built { thickness_m: 0.3, lies };
            let plan = drawn(&Plan::default(), &ROOM, built);
            assert_eq!((plan.walls().len(), plan.corners().len()), (4, 4), "{lies:?}");
            let filled = edit::fill_all(&plan).expect("it is closed").plan;
            assert_eq!(net_areas(&filled), [(clear_m2 * 1e4_f64).round() / 1e4], "{lies:?}");
            // At once it is the same.
            let at_once = draw_walls_beside(&Plan::default(), &line(&ROOM), built, None).expect("it is drawn").plan;
            let places = |plan: &Plan| {
                let mut places: Vec<(i64, i64)> = plan
                    .corners()
                    .map(|(_, corner)| ((corner.position.x * 1e4) as i64, (corner.position.y * 1e4) as i64))
                    .collect();
                places.sort_unstable();
                places
            };
            assert_eq!(places(&at_once), places(&plan));
        }
    }

    #[test]
    fn a_clear_space_gets_its_walls_around_it() {
        let mut clear = line(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (2.0, 2.0), (2.0, 3.0), (0.0, 3.0)]);
        for _ in 0..2 {
            let boundary = boundary_around(&clear, 0.3);
            let (plan, _) = edit::draw_room(&Plan::default(), &boundary, Some(0.3)).expect("it is drawn");
            assert_eq!(net_areas(&plan), [10.0]);
            clear.reverse();
        }
        assert_eq!(boundary_around(&clear, 0.0), clear);
    }

    #[test]
    fn walls_of_24_and_36_keep_the_face() {
        // In line: the right faces are one, the axes are 6 cm apart, and nothing is open between them.
        let [thick, thin] = [0.36, 0.24].map(|thickness_m| Built { thickness_m, lies: Lies::Left });
        let points = line(&[(0.0, 0.0), (3.0, 0.0), (5.0, 0.0), (5.0, 4.0), (0.0, 4.0), (0.0, 0.0)]);
        let mut plan = draw_walls_beside(&Plan::default(), &points[..2], thick, None).expect("it is drawn").plan;
        plan = draw_walls_beside(&plan, &points[..3], thin, Some(thick)).expect("it goes on").plan;
        let faces: Vec<f64> = wall_bodies::faces(&plan).values().map(|faces| faces.right.a.y).collect();
        assert!(faces.len() == 2 && faces.iter().all(|y| y.abs() < 1e-9), "{faces:?}");
        let jog: Vec<f64> = plan
            .walls()
            .filter(|(_, wall)| wall.thickness_m == 0.0)
            .filter_map(|(_, wall)| Some(plan.wall_segment(wall)?.length()))
            .collect();
        assert_eq!(jog.len(), 1);
        assert!((jog[0] - 0.06).abs() < 1e-9);
        // Around a corner the joint is where both faces meet.
        plan = draw_walls_beside(&plan, &points[1..4], thin, None).expect("it goes on").plan;
        assert!(plan.corners().any(|(_, corner)| corner.position == Point::new(4.88, 0.12)));
    }

    #[test]
    fn a_partition_from_face_to_face_joins_the_walls() {
        let built = Built { thickness_m: 0.3, lies: Lies::Right };
        let plan = drawn(&Plan::default(), &ROOM, built);
        // The clear room is 4 m by 3 m: a partition of 0.1 m to the right of x = 2.
        let partition = Built { thickness_m: 0.1, lies: Lies::Right };
        let plan = drawn(&plan, &[(2.0, 0.0), (2.0, 3.0)], partition);
        let filled = edit::fill_all(&plan).expect("it is closed").plan;
        let mut areas = net_areas(&filled);
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas, [1.9 * 3.0, 6.0].map(|area_m2: f64| (area_m2 * 1e4).round() / 1e4));
    }
}
