use std::collections::BTreeSet;
use std::sync::Arc;

use super::RoomShapes;
use super::shapes::changed_key;
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
    /// For each room, by its index in [`RoomShapes::all`], the indices of its connections, without
    /// repeats.
    of_room: Vec<Vec<usize>>,
}

impl Graph {
    /// The graph of a plan's rooms.
    pub fn new(plan: &Plan, shapes: &RoomShapes) -> Self {
        let mut graph = Self::without_connections(shapes);
        for (id, opening) in plan.openings() {
            graph.add(id, opening.kind, shapes, || joined_by(plan, shapes, opening));
        }
        graph
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
        let changed: BTreeSet<CornerId> = if plan.corners.ptr_eq(&before.corners) {
            BTreeSet::new()
        } else {
            plan.corners.diff(&before.corners).map(|item| changed_key(&item)).collect()
        };
        if is_shape && changed.is_empty() && plan.openings.ptr_eq(&before.openings) {
            return Arc::clone(graph);
        }
        // The boxes of rooms that changed, came or went.
        let mut around: Vec<Bounds> = Vec::new();
        if !is_shape {
            let of = |shapes: &RoomShapes, others: &RoomShapes| -> Vec<Bounds> {
                let changed = shapes.all().iter().filter(|shape| others.get(shape.id) != Some(shape));
                changed.map(|shape| shape.bounds).filter(|bounds| !bounds.is_empty()).collect()
            };
            around.extend(of(shapes, shapes_before));
            around.extend(of(shapes_before, shapes));
        }
        let is_near = |opening: &Opening| {
            let looked = plan.opening_segment(opening).map(|segment| {
                // As far as both rays reach.
                Bounds::of([segment.midpoint()]).inflated(2.0 * THICKEST_WALL_M + 1e-6)
            });
            looked.is_none_or(|looked| around.iter().any(|bounds| bounds.intersects(looked)))
        };
        let mut after = Self::without_connections(shapes);
        let mut known = graph.connections.iter().peekable();
        for (&id, opening) in &plan.openings {
            while known.next_if(|connection| connection.opening < id).is_some() {}
            let sides = known.next_if(|connection| connection.opening == id).map(|connection| connection.sides);
            let is_same = || {
                let has_moved = |corner: &CornerId| changed.contains(corner);
                let is_there = match &opening.place {
                    Place::Hosted { from, to, .. } => !has_moved(from) && !has_moved(to),
                    Place::Free { .. } => true,
                };
                is_there
                    && before.openings.get(&id).is_some_and(|earlier| Arc::ptr_eq(earlier, opening))
                    && (around.is_empty() || !is_near(opening))
            };
            match sides.filter(|_| opening.pinned.is_none() && is_same()) {
                Some(sides) => after.add(id, opening.kind, shapes, || (sides, false)),
                None => after.add(id, opening.kind, shapes, || joined_by(plan, shapes, opening)),
            }
        }
        Arc::new(after)
    }

    fn without_connections(shapes: &RoomShapes) -> Self {
        Self { connections: Vec::new(), of_room: vec![Vec::new(); shapes.all().len()] }
    }

    /// Adds what an opening joins, unless it is a window.
    fn add(
        &mut self,
        id: OpeningId,
        kind: OpeningKind,
        shapes: &RoomShapes,
        joined: impl FnOnce() -> ([Joint; 2], bool),
    ) {
        if !kind.is_passable() {
            return;
        }
        let (sides, pinned) = joined();
        let index = self.connections.len();
        self.connections.push(Connection { opening: id, kind, sides, pinned });
        let mut rooms: Vec<usize> = sides.iter().filter_map(|side| shapes.index_of(side.room()?)).collect();
        rooms.dedup();
        for room in rooms {
            self.of_room[room].push(index);
        }
    }

    /// All connections by opening.
    pub fn connections(&self) -> &[Connection] {
        &self.connections
    }

    /// The connections of a room given by its index in [`RoomShapes::all`]; one that joins the room to
    /// itself occurs once.
    pub fn of_room(&self, index: usize) -> impl ExactSizeIterator<Item = &Connection> + '_ {
        self.of_room
            .get(index)
            .map(Vec::as_slice)
            .unwrap_or_default()
            .iter()
            .map(|&connection| &self.connections[connection])
    }
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
