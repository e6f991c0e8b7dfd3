//! A world for the simulated robot, made from a plan: walls with their thickness, doors, furniture.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::simplify::SimplifyShape as _;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::doorways::{Groups, widens};
use super::furniture::{Piece, bundled_furniture, furnish, rectangle};
use super::ray_grid::RayGrid;
use crate::base::random::{Random, seed_of_part};
use crate::geometry::areas::{self, Ring, Shapes};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{Joint, Opening, OpeningId, Plan, RoomId, THICKEST_WALL_M};
use crate::topology::{RoomShape, RoomShapes, sides_by_geometry};

/// Thickness in metres of the walls along the boundaries of rooms that came without any: a light
/// partition, as drawn in the plan's rendering.
const PARTITION_M: f64 = 0.10;

/// Minimum thickness in metres of a wall drawn as a line: boards, glass.
const THINNEST_WALL_M: f64 = 0.05;

/// Width in metres of the gap of a door that is ajar: a robot sees through but cannot pass.
const AJAR_GAP_M: f64 = 0.25;

/// Options for making a world from a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldOptions {
    /// Share of the inner doors that are closed, 0..=1.
    pub closed_share: f64,
    /// Share of the inner doors that are ajar, 0..=1.
    pub ajar_share: f64,
    /// Whether outside doors are open: the robot then sees the open field, without walls.
    pub outer_doors_open: bool,
    /// Pieces of furniture per room, as far as they fit.
    pub furniture: usize,
    pub seed: u64,
}

impl Default for WorldOptions {
    /// All inner doors open, outside doors closed, no furniture.
    fn default() -> Self {
        Self { closed_share: 0.0, ajar_share: 0.0, outer_doors_open: false, furniture: 0, seed: 1 }
    }
}

/// The state of a door.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DoorState {
    /// As wide as the opening; the leaf is folded back.
    Open,
    /// A gap that can be seen through but not passed.
    Ajar,
    /// Solid, like the wall beside it.
    Closed,
}

/// A room of the world.
#[derive(Clone, Debug)]
pub struct WorldRoom {
    pub id: RoomId,
    /// Its floor between the faces of the walls, without doorways; furniture is not subtracted.
    pub floor: Shapes,
    pub area_m2: f64,
}

/// An opening of the world; windows are left out.
#[derive(Clone, Copy, Debug)]
pub struct WorldOpening {
    pub id: OpeningId,
    pub sides: [Joint; 2],
    pub segment: Segment,
    pub state: DoorState,
}

/// The simulated robot's surroundings, in metres in the plan's frame.
#[derive(Clone, Debug)]
pub struct World {
    obstacles: RayGrid,
    free: Shapes,
    rooms: Vec<WorldRoom>,
    openings: Vec<WorldOpening>,
    bounds: Bounds,
}

impl World {
    /// The world of a plan; deterministic for a given seed.
    pub fn new(plan: &Plan, options: &WorldOptions) -> Self {
        let shapes = RoomShapes::new(plan);
        let solids = solids(plan, &shapes);
        let rooms = floors(&shapes, &solids);
        let openings = openings(plan, &shapes, options);
        let mut rings: Vec<Ring> = rooms.iter().flat_map(|room| room.floor.iter().flatten().cloned()).collect();
        let mut outlets: Vec<Segment> = Vec::new();
        for opening in openings.iter().filter(|opening| opening.state != DoorState::Closed) {
            let (cut, outlet) = doorway(opening, &shapes, &solids);
            rings.extend(cut.into_iter().flatten());
            outlets.extend(outlet);
        }
        let mut free: Shapes = if rings.is_empty() { Shapes::new() } else { rings.simplify_shape(FillRule::NonZero) };
        let furniture = furniture(&rooms, &openings, options, &bundled_furniture());
        free = areas::without(free, &furniture);
        let is_outlet = |edge: &Segment| {
            outlets.iter().any(|outlet| outlet.distance(edge.a) < 1e-3 && outlet.distance(edge.b) < 1e-3)
        };
        let edges = free.iter().flatten().map(areas::points).flat_map(|ring| polygon::edges(&ring).collect::<Vec<_>>());
        let obstacles: Vec<Segment> = edges.filter(|edge| !is_outlet(edge)).collect();
        let bounds = obstacles.iter().fold(Bounds::EMPTY, |all, s| all.with(s.a).with(s.b));
        Self { obstacles: RayGrid::new(obstacles), free, rooms, openings, bounds }
    }

    /// A world with only these obstacles, without rooms: for testing the scanner.
    pub fn of_obstacles(obstacles: Vec<Segment>) -> Self {
        let bounds = obstacles.iter().fold(Bounds::EMPTY, |all, s| all.with(s.a).with(s.b));
        let obstacles = RayGrid::new(obstacles);
        Self { obstacles, free: Shapes::new(), rooms: Vec::new(), openings: Vec::new(), bounds }
    }

    /// The faces of everything solid.
    pub fn obstacles(&self) -> &RayGrid {
        &self.obstacles
    }

    /// The floor not covered by walls and furniture, doorways included.
    pub fn free(&self) -> &Shapes {
        &self.free
    }

    /// The rooms by id.
    pub fn rooms(&self) -> &[WorldRoom] {
        &self.rooms
    }

    /// The openings by id.
    pub fn openings(&self) -> &[WorldOpening] {
        &self.openings
    }

    /// The bounding box of all obstacles.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Where the centre of a disc of this radius in metres can be, piece by piece, largest first.
    pub fn passable(&self, radius_m: f64) -> Vec<Shapes> {
        let mut pieces: Vec<Shapes> =
            areas::offset(&self.free, -radius_m).into_iter().map(|shape| vec![shape]).collect();
        pieces.sort_by(|p, q| areas::area_m2(q).total_cmp(&areas::area_m2(p)));
        pieces
    }

    /// The same world with rooms as one that an opening as wide as the narrower of them joins, which no laser
    /// scanner can tell from a bend or a niche of one room. An opening is narrower if the floor widens on both
    /// sides of it within the depth of a wall.
    #[must_use]
    pub fn with_open_rooms_joined(&self) -> Self {
        let index_of = |joint: Joint| self.rooms.iter().position(|room| Some(room.id) == joint.room());
        let mut groups = Groups::new(self.rooms.len());
        for opening in self.openings.iter().filter(|opening| opening.state == DoorState::Open) {
            if let [Some(p), Some(q)] = opening.sides.map(index_of)
                && !widens(opening.segment, &self.obstacles, &[]).iter().all(|&widens| widens)
            {
                groups.join(p, q);
            }
        }
        let roots: Vec<usize> = (0..self.rooms.len()).map(|i| groups.root(i)).collect();
        let mut rooms = Vec::new();
        let mut joined: Vec<RoomId> = self.rooms.iter().map(|room| room.id).collect();
        for root in 0..self.rooms.len() {
            let members: Vec<usize> = (0..self.rooms.len()).filter(|&i| roots[i] == root).collect();
            let largest = members.iter().max_by(|&&p, &&q| self.rooms[p].area_m2.total_cmp(&self.rooms[q].area_m2));
            let Some(&largest) = largest else { continue };
            let id = self.rooms[largest].id;
            let floor: Shapes = members.iter().flat_map(|&i| self.rooms[i].floor.clone()).collect();
            let area_m2 = members.iter().map(|&i| self.rooms[i].area_m2).sum();
            rooms.push(WorldRoom { id, floor, area_m2 });
            members.iter().for_each(|&i| joined[i] = id);
        }
        rooms.sort_by_key(|room| room.id);
        let side = |joint: Joint| index_of(joint).map_or(joint, |index| Joint::Room(joined[index]));
        let openings =
            self.openings.iter().map(|opening| WorldOpening { sides: opening.sides.map(side), ..*opening }).collect();
        Self { rooms, openings, ..self.clone() }
    }

    /// A starting point: of several random ones in the largest part passable for a disc of this radius,
    /// the one with the most room around it. `None` if there is no such part.
    pub fn start(&self, radius_m: f64, seed: u64) -> Option<Point> {
        let passable = self.passable(radius_m);
        let largest = passable.first()?;
        let bounds = Bounds::of(largest.iter().flatten().flatten().map(|&[x, y]| Point::new(x, y)));
        let mut random = Random::new(seed);
        let tries = (0..START_TRIES).map(|_| {
            let (u, v) = (random.unit(), random.unit());
            Point::new(bounds.min.x + u * bounds.width(), bounds.min.y + v * bounds.height())
        });
        let inside: Vec<Point> = tries.filter(|&point| is_inside(largest, point)).take(START_CHOICES).collect();
        let clearance = |point: Point| self.obstacles.distance_m(point, 2.0);
        inside.into_iter().max_by(|&p, &q| clearance(p).total_cmp(&clearance(q)))
    }
}

/// Attempts before a start is given up: enough to hit even a corridor covering 1 % of its bounding box.
const START_TRIES: usize = 5_000;

/// Number of candidates, of which the one with the most room around it is taken.
const START_CHOICES: usize = 12;

/// Whether a point lies within an area.
pub fn is_inside(shapes: &Shapes, point: Point) -> bool {
    shapes.iter().any(|shape| {
        let inside = |ring: &Ring| polygon::locate_in_ring(&areas::points(ring), point) == Location::Inside;
        shape.split_first().is_some_and(|(outer, holes)| inside(outer) && !holes.iter().any(inside))
    })
}

/// The rectangle of a wall with square ends, counter-clockwise.
fn wall_ring(segment: Segment, thickness_m: f64) -> Option<Ring> {
    let along = segment.vector().unit()?;
    Some(areas::ring(&rectangle(segment.midpoint(), along, segment.length() + thickness_m, thickness_m)))
}

/// Everything solid before doors are cut: drawn walls, and partitions along the boundaries of rooms not
/// touched by any wall.
fn solids(plan: &Plan, shapes: &RoomShapes) -> Vec<Ring> {
    let walls: Vec<(Segment, f64)> = plan
        .walls()
        .filter_map(|(_, wall)| Some((plan.wall_segment(wall)?, wall.thickness_m.max(THINNEST_WALL_M))))
        .collect();
    let mut rings: Vec<Ring> = walls.iter().filter_map(|&(segment, t)| wall_ring(segment, t)).collect();
    let touches = |edge: &Segment| {
        let middle = edge.midpoint();
        walls.iter().any(|(wall, thickness_m)| wall.distance(middle) <= thickness_m / 2.0 + 0.02)
    };
    for shape in shapes.all() {
        let edges: Vec<Segment> = shape.rings().flat_map(|ring| polygon::edges(ring)).collect();
        if !edges.iter().any(touches) {
            rings.extend(edges.iter().filter_map(|&edge| wall_ring(edge, PARTITION_M)));
        }
    }
    rings
}

fn ring_bounds(ring: &Ring) -> Bounds {
    Bounds::of(ring.iter().map(|&[x, y]| Point::new(x, y)))
}

/// The solids near a box.
fn near(solids: &[Ring], bounds: Bounds) -> Vec<Ring> {
    solids.iter().filter(|ring| ring_bounds(ring).intersects(bounds)).cloned().collect()
}

/// The floors of rooms: their area minus what is solid, and minus smaller rooms drawn over them.
fn floors(shapes: &RoomShapes, solids: &[Ring]) -> Vec<WorldRoom> {
    let rings = |shape: &RoomShape| -> Vec<Ring> {
        shape.rings().enumerate().map(|(i, ring)| areas::directed(ring, i == 0)).collect()
    };
    let area = |shape: &RoomShape| -> Shapes { rings(shape).simplify_shape(FillRule::NonZero) };
    shapes
        .all()
        .iter()
        .filter(|shape| !shape.outer.is_empty())
        .map(|shape| {
            let mut cuts = near(solids, shape.bounds);
            let smaller = shapes.near(shape.bounds).into_iter().map(|index| &shapes.all()[index]);
            for other in smaller.filter(|other| other.id != shape.id && other.area_m2() < shape.area_m2()) {
                let common = area(shape).overlay(&area(other), OverlayRule::Intersect, FillRule::NonZero);
                // Neighbours overlap by a few centimetres; only a room inside this one takes floor from
                // it.
                if areas::area_m2(&common) > 0.5 * other.area_m2() {
                    cuts.extend(rings(other).into_iter().take(1));
                }
            }
            let floor = areas::without_slivers(&areas::without(area(shape), &cuts));
            WorldRoom { id: shape.id, area_m2: areas::area_m2(&floor), floor }
        })
        .collect()
}

/// The passable openings with their sides, each in a random state.
fn openings(plan: &Plan, shapes: &RoomShapes, options: &WorldOptions) -> Vec<WorldOpening> {
    let mut random = Random::new(seed_of_part(options.seed, 1));
    let of = |(id, opening): (OpeningId, &Opening)| {
        let drawn = random.unit();
        let segment = plan.opening_segment(opening).filter(|segment| segment.length() > 0.0)?;
        let sides = opening.pinned.unwrap_or_else(|| sides_by_geometry(plan, shapes, opening));
        let is_outer = sides.contains(&Joint::Outside);
        let state = match (is_outer, opening.kind) {
            (true, _) if options.outer_doors_open => DoorState::Open,
            (true, _) => DoorState::Closed,
            (false, crate::plan::OpeningKind::Passage) => DoorState::Open,
            (false, _) if drawn < options.closed_share => DoorState::Closed,
            (false, _) if drawn < options.closed_share + options.ajar_share => DoorState::Ajar,
            (false, _) => DoorState::Open,
        };
        Some(WorldOpening { id, sides, segment, state })
    };
    plan.openings().filter(|(_, opening)| opening.kind.is_passable()).filter_map(of).collect()
}

/// What a doorway cuts out of the walls and, if it leads outside, where the world ends.
fn doorway(opening: &WorldOpening, shapes: &RoomShapes, solids: &[Ring]) -> (Shapes, Option<Segment>) {
    let Some(along) = opening.segment.vector().unit() else { return (Shapes::new(), None) };
    let segment = match opening.state {
        DoorState::Ajar => {
            let gap_m = AJAR_GAP_M.min(opening.segment.length());
            Segment::new(opening.segment.a, opening.segment.a + along * gap_m)
        }
        _ => opening.segment,
    };
    let middle = segment.midpoint();
    let around = Bounds::of([segment.a, segment.b]).inflated(2.0 * THICKEST_WALL_M);
    let solid = near(solids, around);
    let is_solid = |point: Point| {
        solid.iter().any(|ring| polygon::locate_in_ring(&areas::points(ring), point) != Location::Outside)
    };
    // In each direction as far as the floor of a room on that side, or the thickest wall.
    let depth = |normal: Vector| {
        let steps = (2.0 * THICKEST_WALL_M / DEPTH_STEP_M) as usize;
        (0..steps).map(|step| step as f64 * DEPTH_STEP_M).find(|&depth_m| {
            let at = middle + normal * depth_m;
            let in_side = opening.sides.iter().filter_map(|side| shapes.index_of(side.room()?));
            !is_solid(at) && in_side.into_iter().any(|index| shapes.all()[index].locate(at) == Location::Inside)
        })
    };
    let (left, right) = (along.left(), -along.left());
    let (to_left, to_right) = (depth(left), depth(right));
    let reach = |found: Option<f64>| found.map_or(THICKEST_WALL_M, |depth_m| depth_m + 2.0 * DEPTH_STEP_M);
    let (left_m, right_m) = (reach(to_left), reach(to_right));
    let centre = middle + left * ((left_m - right_m) / 2.0);
    let cut = areas::ring(&rectangle(centre, along, segment.length(), left_m + right_m));
    // If a door is wider than its wall, neighbouring walls stay intact.
    let mut others: Vec<Ring> = Vec::new();
    for index in shapes.near(around) {
        let shape = &shapes.all()[index];
        if !opening.sides.contains(&Joint::Room(shape.id)) && shape.locate(middle) == Location::Outside {
            let rings: Vec<Ring> = shape.rings().enumerate().map(|(i, r)| areas::directed(r, i == 0)).collect();
            others.extend(areas::offset(&rings.simplify_shape(FillRule::NonZero), PARTITION_M / 2.0).concat());
        }
    }
    let outlet = match (to_left, to_right) {
        (None, Some(_)) => Some((left, left_m)),
        (Some(_), None) => Some((right, right_m)),
        _ => None,
    };
    let outlet = outlet
        .filter(|_| opening.sides.contains(&Joint::Outside))
        .map(|(normal, far_m)| Segment::new(segment.a + normal * far_m, segment.b + normal * far_m));
    (areas::without(vec![vec![cut]], &others), outlet)
}

/// Resolution for measuring the depth of a doorway, in metres.
const DEPTH_STEP_M: f64 = 0.01;

/// The outlines of all furniture. Each room has its own random numbers: moving a door elsewhere does not
/// move the chairs here.
fn furniture(rooms: &[WorldRoom], openings: &[WorldOpening], options: &WorldOptions, catalogue: &[Piece]) -> Vec<Ring> {
    let mut rings = Vec::new();
    for (index, room) in rooms.iter().enumerate().filter(|_| options.furniture > 0) {
        let mut random = Random::new(seed_of_part(options.seed, 1_000 + index));
        let leads_here = |opening: &&WorldOpening| opening.sides.contains(&Joint::Room(room.id));
        let doors: Vec<Point> = openings.iter().filter(leads_here).map(|opening| opening.segment.midpoint()).collect();
        let pieces = areas::pieces(&room.floor);
        let largest = pieces.iter().max_by(|p, q| polygon::area(&p.0, &p.1).total_cmp(&polygon::area(&q.0, &q.1)));
        let Some((outer, holes)) = largest else { continue };
        let seen = furnish(outer, holes, &doors, catalogue, options.furniture, &mut random);
        rings.extend(seen.iter().map(|ring| areas::ring(ring)));
    }
    rings
}
