//! The drawing board: a small vocabulary for plans drawn by hand in metres.
//!
//! Rooms are outlines on wall centre-lines. The walls follow from them: where two rooms meet stands
//! a partition, where a room meets the open stands an exterior wall, and bearing lines make walls
//! thicker. Every place where walls meet becomes a corner that all of them share. Openings name a
//! point on a wall; the piece of wall under it becomes their host.

use std::collections::BTreeMap;

use enfilade::geometry::polygon::{self, Location};
use enfilade::geometry::{Point, Segment, Vector};
use enfilade::plan::{Builder, CornerId, LeafSide, Meta, Opening, OpeningKind, Place, Plan, Room, Swing};

/// Two points closer than this are the same: a hundredth of the thinnest partition, and far above
/// what turning a wing and trimming to the grid do to a coordinate.
const SAME_POINT_M: f64 = 1e-3;

/// What remains visible of a wall between an opening and a wall that meets its own: room for the
/// frame.
const REVEAL_M: f64 = 0.1;

/// Where a door opens to that opens outwards.
pub const OUTSIDE: &str = "";

/// Thicknesses in metres of the walls that follow from the rooms.
#[derive(Clone, Copy, Debug)]
pub struct Thickness {
    /// Between a room and the open.
    pub exterior_m: f64,
    /// Between two rooms.
    pub partition_m: f64,
    /// Round a terrace or court, where it meets no room.
    pub parapet_m: f64,
}

/// Which way a door's hinge lies from its middle, in the frame in which it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hinge {
    North,
    East,
    South,
    West,
}

/// A rectangle between two opposite corners.
pub fn rect(x0: f64, y0: f64, x1: f64, y1: f64) -> Vec<(f64, f64)> {
    vec![(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
}

/// The point a fraction of the way from one point to another.
pub fn between(a: (f64, f64), b: (f64, f64), fraction: f64) -> (f64, f64) {
    (a.0 + (b.0 - a.0) * fraction, a.1 + (b.1 - a.1) * fraction)
}

/// A drawing in the making.
#[derive(Debug)]
pub struct Sheet {
    meta: Meta,
    thickness: Thickness,
    /// Where the current frame's origin lies and the direction of its x axis, of length 1.
    frame: (Point, Vector),
    points: Vec<Point>,
    rooms: Vec<DrawnRoom>,
    lines: Vec<(Segment, f64)>,
    piers: Vec<(usize, usize, f64)>,
    openings: Vec<DrawnOpening>,
}

#[derive(Debug)]
struct DrawnRoom {
    name: String,
    function: String,
    /// The outer ring, then the holes, as indices of points.
    rings: Vec<Vec<usize>>,
    is_outdoors: bool,
}

#[derive(Debug)]
struct DrawnOpening {
    kind: OpeningKind,
    middle: Point,
    width_m: f64,
    /// The room a leaf opens into and the direction from the middle to its hinge.
    leaf: Option<(String, Vector)>,
}

/// A wall between two neighbouring corners.
struct Piece {
    segment: Segment,
    thickness_m: f64,
}

impl Sheet {
    /// An empty sheet.
    pub fn new(meta: Meta, thickness: Thickness) -> Self {
        Self {
            meta,
            thickness,
            frame: (Point::default(), Vector::new(1.0, 0.0)),
            points: Vec::new(),
            rooms: Vec::new(),
            lines: Vec::new(),
            piers: Vec::new(),
            openings: Vec::new(),
        }
    }

    /// What follows is drawn in a frame with its origin at a point of the plan and its x axis along
    /// a direction (a whole-numbered triangle such as 7, 24, 25 keeps coordinates short).
    pub fn set_frame(&mut self, origin: (f64, f64), along: (f64, f64)) {
        let along = Vector::new(along.0, along.1);
        self.frame = (Point::new(origin.0, origin.1), along * (1.0 / along.length()));
    }

    /// Where a point of the current frame lies in the plan.
    pub fn place(&self, (x, y): (f64, f64)) -> Point {
        (self.frame.0 + self.direction(Vector::new(x, y))).trimmed()
    }

    fn direction(&self, vector: Vector) -> Vector {
        self.frame.1 * vector.x + self.frame.1.left() * vector.y
    }

    fn point(&mut self, at: (f64, f64)) -> usize {
        let point = self.place(at);
        match self.points.iter().position(|known| known.distance(point) < SAME_POINT_M) {
            Some(index) => index,
            None => {
                self.points.push(point);
                self.points.len() - 1
            }
        }
    }

    /// A room.
    pub fn room(&mut self, name: &str, function: &str, outline: &[(f64, f64)]) {
        self.room_around(name, function, outline, &[]);
    }

    /// A room with holes.
    pub fn room_around(&mut self, name: &str, function: &str, outline: &[(f64, f64)], holes: &[Vec<(f64, f64)>]) {
        self.add_room(name, function, outline, holes, false);
    }

    /// A terrace, a court: an area without a roof. The walls of the house stand between it and the
    /// rooms.
    pub fn outdoors(&mut self, name: &str, function: &str, outline: &[(f64, f64)]) {
        self.add_room(name, function, outline, &[], true);
    }

    fn add_room(
        &mut self,
        name: &str,
        function: &str,
        outline: &[(f64, f64)],
        holes: &[Vec<(f64, f64)>],
        is_outdoors: bool,
    ) {
        let mut rings = vec![outline.iter().map(|&at| self.point(at)).collect()];
        for hole in holes {
            rings.push(hole.iter().map(|&at| self.point(at)).collect());
        }
        self.rooms.push(DrawnRoom { name: name.to_owned(), function: function.to_owned(), rings, is_outdoors });
    }

    /// Walls along a line have a thickness of their own; 0 stands for none at all.
    pub fn wall_line(&mut self, thickness_m: f64, line: &[(f64, f64)]) {
        for pair in line.windows(2) {
            self.lines.push((Segment::new(self.place(pair[0]), self.place(pair[1])), thickness_m));
        }
    }

    /// A free-standing piece of masonry: a column, a chimney, a fin.
    pub fn pier(&mut self, thickness_m: f64, from: (f64, f64), to: (f64, f64)) {
        let (from, to) = (self.point(from), self.point(to));
        self.piers.push((from, to, thickness_m));
    }

    /// A door with one leaf, by its middle.
    pub fn door(&mut self, at: (f64, f64), width_m: f64, into: &str, hinge: Hinge) {
        let hinge = match hinge {
            Hinge::North => Vector::new(0.0, 1.0),
            Hinge::East => Vector::new(1.0, 0.0),
            Hinge::South => Vector::new(0.0, -1.0),
            Hinge::West => Vector::new(-1.0, 0.0),
        };
        let leaf = Some((into.to_owned(), self.direction(hinge)));
        let middle = self.place(at);
        self.openings.push(DrawnOpening { kind: OpeningKind::Door, middle, width_m, leaf });
    }

    /// A door with two leaves, by its middle.
    pub fn double_door(&mut self, at: (f64, f64), width_m: f64, into: &str) {
        let leaf = Some((into.to_owned(), Vector::default()));
        let middle = self.place(at);
        self.openings.push(DrawnOpening { kind: OpeningKind::DoubleDoor, middle, width_m, leaf });
    }

    /// A free passage, by its middle.
    pub fn passage(&mut self, at: (f64, f64), width_m: f64) {
        let middle = self.place(at);
        self.openings.push(DrawnOpening { kind: OpeningKind::Passage, middle, width_m, leaf: None });
    }

    /// A window, by its middle.
    pub fn window(&mut self, at: (f64, f64), width_m: f64) {
        let middle = self.place(at);
        self.openings.push(DrawnOpening { kind: OpeningKind::Window, middle, width_m, leaf: None });
    }

    /// Windows of one width, evenly along a line.
    pub fn windows(&mut self, from: (f64, f64), to: (f64, f64), count: u32, width_m: f64) {
        for i in 0..count {
            self.window(between(from, to, (f64::from(i) + 0.5) / f64::from(count)), width_m);
        }
    }

    /// The plan that is drawn.
    ///
    /// # Errors
    /// Everything that does not fit, in words: openings that stand on no wall or too close to
    /// another wall, doors that open into a room that is not there, broken invariants.
    pub fn finish(mut self) -> Result<Plan, String> {
        let mut problems = Vec::new();
        self.split_rings();
        let mut builder = Builder::new(self.meta.clone());
        let corners: Vec<CornerId> = self.points.iter().map(|&point| builder.corner(point)).collect();
        let pieces = self.pieces();
        for (&(a, b), piece) in &pieces {
            if piece.thickness_m > 0.0 {
                builder.wall(corners[a], corners[b], piece.thickness_m);
            }
        }
        for &(from, to, thickness_m) in &self.piers {
            builder.wall(corners[from], corners[to], thickness_m);
        }
        for room in &self.rooms {
            let mut rings = room.rings.iter().map(|ring| ring.iter().map(|&point| corners[point]).collect());
            let Some(outer) = rings.next() else { continue };
            let drawn = Room {
                outer,
                holes: rings.collect(),
                function: room.function.clone(),
                name: room.name.clone(),
                ..Room::default()
            };
            builder.room(&room.name, drawn);
        }
        for opening in &self.openings {
            match self.hosted(opening, &pieces, &corners) {
                Ok(hosted) => {
                    builder.opening("", hosted);
                }
                Err(problem) => {
                    problems.push(format!(
                        "{} at ({:.2}, {:.2}): {problem}",
                        opening.kind.name(),
                        opening.middle.x,
                        opening.middle.y
                    ));
                }
            }
        }
        match builder.finish() {
            Ok(plan) if problems.is_empty() => return Ok(plan),
            Ok(_) => {}
            Err(violations) => problems.extend(violations.iter().map(ToString::to_string)),
        }
        Err(problems.join("\n"))
    }

    /// Puts every point that lies on an edge of a ring into the ring, so that rooms that meet share
    /// all their corners.
    fn split_rings(&mut self) {
        for ring in self.rooms.iter_mut().flat_map(|room| &mut room.rings) {
            let mut split = Vec::new();
            for (i, &start) in ring.iter().enumerate() {
                let edge = Segment::new(self.points[start], self.points[ring[(i + 1) % ring.len()]]);
                split.push(start);
                let mut between: Vec<(f64, usize)> = (0..self.points.len())
                    .filter(|&index| is_inside(edge, self.points[index]))
                    .map(|index| (edge.a.distance(self.points[index]), index))
                    .collect();
                between.sort_by(|p, q| p.0.total_cmp(&q.0));
                split.extend(between.into_iter().map(|(_, index)| index));
            }
            *ring = split;
        }
    }

    /// All edges of rooms with the thickness of the wall that stands there, by their points.
    fn pieces(&self) -> BTreeMap<(usize, usize), Piece> {
        // How many rooms with a roof and how many without meet at an edge.
        let mut sides: BTreeMap<(usize, usize), (u32, u32)> = BTreeMap::new();
        for room in &self.rooms {
            for ring in &room.rings {
                for (i, &a) in ring.iter().enumerate() {
                    let b = ring[(i + 1) % ring.len()];
                    let (indoors, outdoors) = sides.entry((a.min(b), a.max(b))).or_default();
                    *(if room.is_outdoors { outdoors } else { indoors }) += 1;
                }
            }
        }
        sides
            .into_iter()
            .map(|((a, b), sides)| {
                let segment = Segment::new(self.points[a], self.points[b]);
                let on =
                    |line: Segment| line.distance(segment.a) < SAME_POINT_M && line.distance(segment.b) < SAME_POINT_M;
                // The last line drawn counts.
                let own = self.lines.iter().rev().find(|(line, _)| on(*line)).map(|&(_, thickness_m)| thickness_m);
                let usual_m = match sides {
                    (0, _) => self.thickness.parapet_m,
                    (1, _) => self.thickness.exterior_m,
                    _ => self.thickness.partition_m,
                };
                ((a, b), Piece { segment, thickness_m: own.unwrap_or(usual_m) })
            })
            .collect()
    }

    /// The opening on the piece of wall on which its middle lies.
    fn hosted(
        &self,
        opening: &DrawnOpening,
        pieces: &BTreeMap<(usize, usize), Piece>,
        corners: &[CornerId],
    ) -> Result<Opening, String> {
        let (&(a, b), piece) = pieces
            .iter()
            .find(|(_, piece)| piece.segment.distance(opening.middle) < SAME_POINT_M)
            .ok_or("there is no wall")?;
        let at_m = piece.segment.a.distance(opening.middle);
        for (corner, available_m) in [(a, at_m), (b, piece.segment.length() - at_m)] {
            let needed_m = opening.width_m / 2.0 + self.reach_of_walls_m(corner, piece, pieces) + REVEAL_M;
            if available_m < needed_m - SAME_POINT_M {
                let Point { x, y } = self.points[corner];
                return Err(format!("{:.2} m too close to the wall at ({x:.2}, {y:.2})", needed_m - available_m));
            }
        }
        let place = Place::Hosted { from: corners[a], to: corners[b], at_m, width_m: opening.width_m };
        let mut hosted = Opening::new(opening.kind, place);
        if let Some((into, hinge)) = &opening.leaf {
            let along = piece.segment.vector();
            let left = along.left().unit().ok_or("the wall has no length")?;
            let is_target = |point: Point| match self.rooms.iter().find(|room| room.name == *into) {
                Some(room) => self.contains(room, point),
                None => !self.rooms.iter().any(|room| !room.is_outdoors && self.contains(room, point)),
            };
            if into != OUTSIDE && !self.rooms.iter().any(|room| room.name == *into) {
                return Err(format!("there is no room '{into}'"));
            }
            let sides = [is_target(opening.middle + left * 0.3), is_target(opening.middle + left * -0.3)];
            let side = match sides {
                [true, false] => LeafSide::Left,
                [false, true] => LeafSide::Right,
                _ => return Err(format!("'{into}' does not lie on one side of it")),
            };
            if along.dot(*hinge).abs() < 0.1 * along.length() && hinge.length() > 0.0 {
                return Err("its hinge does not lie along the wall".to_owned());
            }
            hosted.swing = Some(Swing { hinge_at_start: along.dot(*hinge) < 0.0, side });
        }
        Ok(hosted)
    }

    /// How far the walls that meet a piece at a corner reach into it.
    fn reach_of_walls_m(&self, corner: usize, piece: &Piece, pieces: &BTreeMap<(usize, usize), Piece>) -> f64 {
        let from_corner = if self.points[corner] == piece.segment.a { 1.0 } else { -1.0 };
        let along = piece.segment.vector() * from_corner;
        pieces
            .iter()
            .filter(|((a, b), _)| *a == corner || *b == corner)
            .map(|((a, _), other)| {
                let away = if *a == corner { other.segment.vector() } else { -other.segment.vector() };
                let lengths = along.length() * away.length();
                let (sine, cosine) = (along.cross(away).abs() / lengths, along.dot(away) / lengths);
                // A wall in line does not reach into it at all. Others by half their thickness, and
                // at a sharp angle to where the faces of both meet.
                if sine < 0.01 {
                    return 0.0;
                }
                let faces_meet_m = (other.thickness_m + piece.thickness_m * cosine) / 2.0 / sine;
                faces_meet_m.max(other.thickness_m / 2.0)
            })
            .fold(0.0, f64::max)
    }

    fn contains(&self, room: &DrawnRoom, point: Point) -> bool {
        let rings: Vec<Vec<Point>> =
            room.rings.iter().map(|ring| ring.iter().map(|&index| self.points[index]).collect()).collect();
        rings.split_first().is_some_and(|(outer, holes)| polygon::locate(outer, holes, point) == Location::Inside)
    }
}

/// Whether a point lies on a segment, off its ends.
fn is_inside(segment: Segment, point: Point) -> bool {
    segment.distance(point) < SAME_POINT_M
        && segment.a.distance(point) >= SAME_POINT_M
        && segment.b.distance(point) >= SAME_POINT_M
}
