use super::RoomShapes;
use crate::geometry::{Bounds, Point, Vector};
use crate::plan::{Joint, Opening, OpeningId, Plan, THICKEST_WALL_M};

/// An opening and the two sides it joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    pub opening: OpeningId,
    /// Both sides; for one found by geometry, the left of its segment first.
    pub sides: [Joint; 2],
    /// Whether a file or a person stated the sides; else they follow from geometry.
    pub pinned: bool,
}

impl Connection {
    /// Whether both sides are the same room, or both the outside: it joins nothing.
    pub fn joins_nothing(&self) -> bool {
        self.sides[0] == self.sides[1]
    }
}

/// The rooms of a plan and the connections between them. Windows join nothing and are left out.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    connections: Vec<Connection>,
    /// For each room, by its index in [`RoomShapes::all`], the indices of its connections, each
    /// once.
    of_room: Vec<Vec<usize>>,
}

impl Graph {
    /// The graph of a plan's rooms.
    pub fn new(plan: &Plan, shapes: &RoomShapes) -> Self {
        let mut graph = Self { connections: Vec::new(), of_room: vec![Vec::new(); shapes.all().len()] };
        for (id, opening) in plan.openings() {
            if !opening.kind.is_passable() {
                continue;
            }
            let (sides, pinned) = match opening.pinned {
                Some(sides) => (sides, true),
                None => (sides_by_geometry(plan, shapes, opening), false),
            };
            let index = graph.connections.len();
            graph.connections.push(Connection { opening: id, sides, pinned });
            let mut rooms: Vec<usize> = sides.iter().filter_map(|side| shapes.index_of(side.room()?)).collect();
            rooms.dedup();
            for room in rooms {
                graph.of_room[room].push(index);
            }
        }
        graph
    }

    /// All connections by opening.
    pub fn connections(&self) -> &[Connection] {
        &self.connections
    }

    /// The connections of a room given by its index in [`RoomShapes::all`]; one that joins the room
    /// with itself appears once.
    pub fn of_room(&self, index: usize) -> impl ExactSizeIterator<Item = &Connection> + '_ {
        self.of_room
            .get(index)
            .map(Vec::as_slice)
            .unwrap_or_default()
            .iter()
            .map(|&connection| &self.connections[connection])
    }
}

/// The rooms an opening joins, found by looking from its middle along its normal, both ways, up to
/// the thickest plausible wall.
pub fn sides_by_geometry(plan: &Plan, shapes: &RoomShapes, opening: &Opening) -> [Joint; 2] {
    let Some(segment) = plan.opening_segment(opening) else { return [Joint::Outside; 2] };
    let Some(normal) = segment.vector().left().unit() else { return [Joint::Outside; 2] };
    let middle = segment.midpoint();
    [room_along(shapes, middle, normal), room_along(shapes, middle, -normal)]
}

/// The room first entered from `origin` along `direction`. Where several are entered at the same
/// place (drawn rooms overlap by centimetres), the one the ray stays in longest: it lies on this
/// side, the others reach over from behind.
fn room_along(shapes: &RoomShapes, origin: Point, direction: Vector) -> Joint {
    // Look past the thickest wall, to tell a room from the overlap of one.
    let reach_m = 2.0 * THICKEST_WALL_M;
    let mut best: Option<(f64, f64, usize)> = None;
    for index in shapes.near(Bounds::of([origin, origin + direction * reach_m])) {
        let entered = shapes.all()[index]
            .stretches(origin, direction, reach_m)
            .into_iter()
            .find(|&(from, to)| from <= THICKEST_WALL_M && to - from > SLIVER_M);
        let Some((from, to)) = entered else { continue };
        let better = match best {
            None => true,
            Some((best_from, best_length, _)) => {
                let length = to - from;
                if (from - best_from).abs() <= SLIVER_M { length > best_length + 1e-9 } else { from < best_from }
            }
        };
        if better {
            best = Some((from, to - from, index));
        }
    }
    best.map_or(Joint::Outside, |(_, _, index)| Joint::Room(shapes.all()[index].id))
}

/// A stretch shorter than this is an overlap of two boundaries, not a room: imported rooms are drawn
/// one by one and overlap by a few centimetres (`data` of the paper's authors).
const SLIVER_M: f64 = 0.05;
