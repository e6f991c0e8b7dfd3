use std::collections::BTreeSet;
use std::sync::Arc;

use super::RoomShapes;
use super::shapes::changed_keys;
use crate::base::lists::Lists;
use crate::geometry::{Bounds, Point, Vector};
use crate::plan::{CornerId, Joint, Opening, OpeningId, OpeningKind, Place, Plan, THICKEST_WALL_M};

/// An opening and the two sides it joins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Connection {
    pub opening: OpeningId,
    pub kind: OpeningKind,
    /// Both sides; if derived from geometry, the left of its segment first.
    pub sides: [Joint; 2],
    /// Whether a file or the user stated the sides; otherwise they follow from geometry.
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
    /// For each connection the rooms on both sides, by their index in [`RoomShapes::all`].
    ends: Vec<[Option<u32>; 2]>,
    /// For each connection the middle of its opening, from where its sides are looked for; `None` where they are stated.
    middles: Vec<Option<Point>>,
    /// For each room, by its index in [`RoomShapes::all`], the indices of its connections, without
    /// repeats.
    of_room: Lists,
}

impl Graph {
    /// The graph of a plan's rooms.
    pub fn new(plan: &Plan, shapes: &RoomShapes) -> Self {
        let mut graph = Self::default();
        for (id, opening) in plan.openings() {
            graph.look(plan, shapes, id, opening);
        }
        graph.finished(shapes)
    }

    /// The graph after an edit, from the one before it: the same as [`Graph::new`]. What an opening joins is looked for again
    /// only where it, its edge or a room beside it has changed.
    pub fn after(
        plan: &Plan,
        shapes: &Arc<RoomShapes>,
        before: &Plan,
        shapes_before: &Arc<RoomShapes>,
        graph: &Arc<Self>,
    ) -> Arc<Self> {
        let is_shape = Arc::ptr_eq(shapes, shapes_before);
        let moved: BTreeSet<CornerId> = changed_keys(&plan.corners, &before.corners);
        let changed: BTreeSet<OpeningId> = changed_keys(&plan.openings, &before.openings);
        if is_shape && moved.is_empty() && changed.is_empty() {
            return Arc::clone(graph);
        }
        // The boxes of rooms that changed, came or went.
        let mut around: Vec<Bounds> = Vec::new();
        let mut is_same_rooms = true;
        if !is_shape {
            is_same_rooms = shapes.all().len() == shapes_before.all().len();
            let mut was = shapes_before.all().iter().peekable();
            for shape in shapes.all() {
                // Both are sorted by id; what is passed over has gone.
                while let Some(gone) = was.next_if(|was| was.id < shape.id) {
                    around.push(gone.bounds);
                }
                match was.next_if(|was| was.id == shape.id) {
                    Some(was) if was == shape => {}
                    Some(was) => around.extend([was.bounds, shape.bounds]),
                    None => {
                        is_same_rooms = false;
                        around.push(shape.bounds);
                    }
                }
            }
            around.extend(was.map(|gone| gone.bounds));
            around.retain(|bounds| !bounds.is_empty());
        }
        let is_near = |middle: Point| {
            // As far as both rays reach.
            let looked = Bounds::of([middle]).inflated(2.0 * THICKEST_WALL_M + 1e-6);
            around.iter().any(|bounds| bounds.intersects(looked))
        };
        let mut after = Self::default();
        after.connections.reserve(graph.connections.len() + 1);
        after.ends.reserve(graph.connections.len() + 1);
        after.middles.reserve(graph.connections.len() + 1);
        let mut at = 0;
        for (&id, opening) in &plan.openings {
            while graph.connections.get(at).is_some_and(|connection| connection.opening < id) {
                at += 1;
            }
            let has_moved = || match &opening.place {
                Place::Hosted { from, to, .. } => moved.contains(from) || moved.contains(to),
                Place::Free { .. } => false,
            };
            let known = graph.connections.get(at).filter(|connection| connection.opening == id);
            let middle = graph.middles.get(at).copied().flatten();
            let is_there = || {
                let is_still = moved.is_empty() || !has_moved();
                is_still && middle.is_some_and(|middle| around.is_empty() || !is_near(middle))
            };
            match known.filter(|_| !changed.contains(&id) && (opening.pinned.is_some() || is_there())) {
                Some(connection) => {
                    let ends = if is_same_rooms { graph.ends[at] } else { ends(shapes, connection.sides) };
                    after.add(*connection, ends, middle);
                }
                None => after.look(plan, shapes, id, opening),
            }
        }
        Arc::new(after.finished(shapes))
    }

    /// Adds what an opening joins, unless it is a window.
    fn look(&mut self, plan: &Plan, shapes: &RoomShapes, id: OpeningId, opening: &Opening) {
        if !opening.kind.is_passable() {
            return;
        }
        let (sides, pinned) = joined_by(plan, shapes, opening);
        let looked = opening.pinned.is_none().then(|| plan.opening_segment(opening)).flatten();
        let middle = looked.map(|segment| segment.midpoint());
        self.add(Connection { opening: id, kind: opening.kind, sides, pinned }, ends(shapes, sides), middle);
    }

    fn add(&mut self, connection: Connection, ends: [Option<u32>; 2], middle: Option<Point>) {
        self.connections.push(connection);
        self.ends.push(ends);
        self.middles.push(middle);
    }

    fn finished(mut self, shapes: &RoomShapes) -> Self {
        self.of_room = Lists::of_pairs(shapes.all().len(), |tell| {
            for (index, [one, other]) in (0..).zip(&self.ends) {
                if let Some(room) = *one {
                    tell(room, index);
                }
                if let Some(room) = other.filter(|_| one != other) {
                    tell(room, index);
                }
            }
        });
        self
    }

    /// All connections by opening.
    pub fn connections(&self) -> &[Connection] {
        &self.connections
    }

    /// The connections of a room given by its index in [`RoomShapes::all`]; one that joins the room to
    /// itself occurs once.
    pub fn of_room(&self, index: usize) -> impl ExactSizeIterator<Item = &Connection> + '_ {
        self.numbers(index).iter().map(|&connection| &self.connections[connection as usize])
    }

    /// The same, each with the room on the other side by its index; `None` for the outside and the room itself.
    pub fn doors_of(&self, index: usize) -> impl ExactSizeIterator<Item = (&Connection, Option<usize>)> + '_ {
        self.numbers(index).iter().map(move |&connection| {
            let [one, other] = self.ends[connection as usize].map(|room| room.map(|room| room as usize));
            let side = if one == Some(index) { other } else { one };
            (&self.connections[connection as usize], side.filter(|&side| side != index))
        })
    }

    fn numbers(&self, index: usize) -> &[u32] {
        if index < self.of_room.len() { self.of_room.of(index) } else { &[] }
    }
}

/// The rooms on both sides, by their index.
fn ends(shapes: &RoomShapes, sides: [Joint; 2]) -> [Option<u32>; 2] {
    sides.map(|side| Some(shapes.index_of(side.room()?)? as u32))
}

/// What an opening joins, and whether that is stated.
fn joined_by(plan: &Plan, shapes: &RoomShapes, opening: &Opening) -> ([Joint; 2], bool) {
    match opening.pinned {
        Some(sides) => (sides, true),
        None => (sides_by_geometry(plan, shapes, opening), false),
    }
}

/// The rooms an opening joins, found by looking from its middle along its normal, in both directions, up
/// to the thickest plausible wall.
pub fn sides_by_geometry(plan: &Plan, shapes: &RoomShapes, opening: &Opening) -> [Joint; 2] {
    let Some(segment) = plan.opening_segment(opening) else { return [Joint::Outside; 2] };
    let Some(normal) = segment.vector().left().unit() else { return [Joint::Outside; 2] };
    let middle = segment.midpoint();
    [room_along(shapes, middle, normal), room_along(shapes, middle, -normal)]
}

/// The room first entered from `origin` along `direction`. If several are entered at the same place
/// (drawn rooms overlap by centimetres), the one the ray stays in longest: it is on this side, the others
/// extend over from behind.
fn room_along(shapes: &RoomShapes, origin: Point, direction: Vector) -> Joint {
    // Look past the thickest wall, to tell a room from a mere overlap.
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

/// A shorter stretch is an overlap of two boundaries, not a room: imported rooms are drawn one by one and
/// overlap by a few centimetres (data of the paper's authors).
const SLIVER_M: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Builder, Meta, OpeningKind, Place, Room, RoomId};

    fn rectangle(builder: &mut Builder, key: &str, x: (f64, f64), y: (f64, f64)) -> RoomId {
        let ring = [(x.0, y.0), (x.1, y.0), (x.1, y.1), (x.0, y.1)].map(|(x, y)| Point::new(x, y));
        let outer = builder.ring(ring);
        builder.room(key, Room { outer, ..Room::default() })
    }

    fn free(from: (f64, f64), to: (f64, f64), kind: OpeningKind) -> Opening {
        Opening::new(kind, Place::Free { from: Point::new(from.0, from.1), to: Point::new(to.0, to.1) })
    }

    fn sides(builder: Builder) -> Vec<[Joint; 2]> {
        let plan = builder.finish().expect("a valid plan");
        let shapes = RoomShapes::new(&plan);
        Graph::new(&plan, &shapes).connections().iter().map(|connection| connection.sides).collect()
    }

    /// Two rooms `gap_m` apart (negative: overlapping) with a door midway between them.
    fn across(gap_m: f64) -> (Vec<[Joint; 2]>, [Joint; 2]) {
        let mut builder = Builder::new(Meta::default());
        let left = rectangle(&mut builder, "left", (0.0, 4.0), (0.0, 3.0));
        let right = rectangle(&mut builder, "right", (4.0 + gap_m, 9.0), (0.0, 3.0));
        let x = 4.0 + gap_m / 2.0;
        builder.opening("", free((x, 1.0), (x, 1.9), OpeningKind::Door));
        (sides(builder), [Joint::Room(left), Joint::Room(right)])
    }

    #[test]
    fn rooms_are_neighbours_across_a_wall_or_a_small_overlap() {
        for gap_m in [0.0, 0.1, 0.6, 1.19, -0.04, -0.3] {
            let (found, expected) = across(gap_m);
            assert_eq!(found, [expected], "gap of {gap_m} m");
        }
        let (found, _) = across(1.3);
        assert_eq!(found, [[Joint::Outside; 2]], "no wall is that thick");
    }

    #[test]
    fn a_door_on_one_rooms_boundary_reaches_the_other_through_the_wall() {
        let mut builder = Builder::new(Meta::default());
        let left = rectangle(&mut builder, "left", (0.0, 4.0), (0.0, 3.0));
        let right = rectangle(&mut builder, "right", (4.4, 9.0), (0.0, 3.0));
        builder.opening("", free((4.0, 1.9), (4.0, 1.0), OpeningKind::Door));
        assert_eq!(sides(builder), [[Joint::Room(right), Joint::Room(left)]]);
    }

    #[test]
    fn free_sides_lead_outside_and_windows_join_nothing() {
        let mut builder = Builder::new(Meta::default());
        let room = rectangle(&mut builder, "room", (0.0, 4.0), (0.0, 3.0));
        builder.opening("door", free((1.0, 0.0), (2.0, 0.0), OpeningKind::Door));
        builder.opening("window", free((1.0, 3.0), (2.0, 3.0), OpeningKind::Window));
        assert_eq!(sides(builder), [[Joint::Room(room), Joint::Outside]]);
    }

    #[test]
    fn what_a_file_states_comes_before_geometry() {
        let mut builder = Builder::new(Meta::default());
        rectangle(&mut builder, "left", (0.0, 4.0), (0.0, 3.0));
        let far = rectangle(&mut builder, "far", (20.0, 24.0), (0.0, 3.0));
        let mut door = free((4.0, 1.0), (4.0, 1.9), OpeningKind::Door);
        door.pinned = Some([Joint::Outside, Joint::Room(far)]);
        builder.opening("", door);
        assert_eq!(sides(builder), [[Joint::Outside, Joint::Room(far)]]);
    }

    #[test]
    fn an_opening_within_a_room_joins_it_with_itself_once() {
        let mut builder = Builder::new(Meta::default());
        let room = rectangle(&mut builder, "room", (0.0, 4.0), (0.0, 3.0));
        builder.opening("", free((2.0, 1.0), (2.0, 1.9), OpeningKind::Door));
        let plan = builder.finish().expect("a valid plan");
        let shapes = RoomShapes::new(&plan);
        let graph = Graph::new(&plan, &shapes);
        assert!(graph.connections()[0].joins_nothing());
        assert_eq!(graph.of_room(shapes.index_of(room).expect("exists")).len(), 1);
    }
}
