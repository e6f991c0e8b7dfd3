//! The clear part of each room: what its boundary encloses, less the bodies of walls.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::{RoomShape, RoomShapes};
use crate::geometry::areas::{self, Ring, Shapes};
use crate::geometry::{Point, polygon};
use crate::plan::{Plan, RoomId, THICKEST_WALL_M, Wall};
use crate::topology::wall_bodies::WallBodies;

/// The clear part of a room: between the faces of its walls, without free-standing walls, piers and holes.
///
/// This is the area that can be furnished and let: net floor area as in ISO 9836 and DIN 277, where doorways and
/// niches for windows do not count. A room without walls is clear to its boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct NetRoom {
    /// In m²; never more than the area of the boundary.
    pub area_m2: f64,
    /// Outer rings, counter-clockwise, each with its holes: one piece, unless walls divide the room.
    pub pieces: Vec<(Vec<Point>, Vec<Vec<Point>>)>,
    /// Whether a wall takes any of the boundary's area.
    pub has_walls: bool,
}

impl NetRoom {
    /// The total length of all its rings in metres.
    pub fn perimeter_m(&self) -> f64 {
        self.rings().map(|ring| polygon::perimeter(ring)).sum()
    }

    /// All its rings.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        self.pieces.iter().flat_map(|(outer, holes)| std::iter::once(outer).chain(holes))
    }
}

/// Pieces of wall near a room, counted over all rooms, up to which clear areas are worked out. No building has a
/// tenth; a fuzzer's rooms, piled up under thousands of walls, have no clear area.
const MOST_PIECES: usize = 500_000;
const MOST_PIECES_A_ROOM: usize = 64;

/// Less area than this, in m², is the rounding of coordinates: a grid step along a wall of ten metres.
const ROUNDING_M2: f64 = 1e-3;

/// The clear parts of all rooms in the order of [`RoomShapes::all`]; `None` for a room that encloses no area.
pub fn net_rooms(plan: &Plan, shapes: &RoomShapes) -> Vec<Option<NetRoom>> {
    if shapes.all().is_empty() { Vec::new() } else { net_rooms_between(&WallBodies::new(plan), shapes) }
}

/// As [`net_rooms`], between the bodies of the plan's walls.
pub fn net_rooms_between(bodies: &WallBodies, shapes: &RoomShapes) -> Vec<Option<NetRoom>> {
    let rings = &bodies.rings;
    let entry = |(index, ring): (usize, &Ring)| {
        let corners = ring.iter().fold(None, |corners: Option<([f64; 2], [f64; 2])>, &[x, y]| {
            let (low, high) = corners.unwrap_or(([x, y], [x, y]));
            Some(([low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]))
        });
        corners.map(|(low, high)| GeomWithData::new(Rectangle::from_corners(low, high), index))
    };
    let tree = RTree::bulk_load(rings.iter().enumerate().filter_map(entry).collect());
    let most = MOST_PIECES + MOST_PIECES_A_ROOM * shapes.all().len();
    let mut pieces = 0;
    let net = |shape: &RoomShape| {
        let area_m2 = shape.area_m2();
        if area_m2 <= 0.0 || shape.bounds.is_empty() {
            return None;
        }
        let bounds = shape.bounds;
        let near = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let mut walls: Vec<usize> = Vec::new();
        if pieces < most {
            walls.extend(tree.locate_in_envelope_intersecting(near).map(|entry| entry.data).take(most));
            pieces += walls.len();
        }
        walls.sort_unstable();
        let walls: Vec<Ring> = walls.into_iter().map(|index| rings[index].clone()).collect();
        Some(without_walls(shape, area_m2, &walls))
    };
    shapes.all().iter().map(net).collect()
}

/// The clear part of an area that is no room yet: only the walls near it are looked at.
pub fn net_of(plan: &Plan, outer: &[Point], holes: &[Vec<Point>]) -> NetRoom {
    let bounds = polygon::bounds(outer);
    // As far as the thickest wall, its joints with it, reaches.
    let near = bounds.inflated(2.0 * THICKEST_WALL_M);
    let is_near = |wall: &Wall| plan.wall_segment(wall).is_some_and(|segment| near.intersects(segment.bounds()));
    let walls = plan.walls().filter(|(_, wall)| is_near(wall)).map(|(id, wall)| (id, wall.clone())).collect();
    let part = Plan { corners: plan.corners.clone(), walls, ..Plan::default() };
    let shape = RoomShape { id: RoomId::of_key(""), outer: outer.to_vec(), holes: holes.to_vec(), bounds };
    without_walls(&shape, shape.area_m2(), &WallBodies::new(&part).rings)
}

fn without_walls(shape: &RoomShape, area_m2: f64, walls: &[Ring]) -> NetRoom {
    if !walls.is_empty() {
        let rings = shape.rings().enumerate().map(|(index, ring)| areas::directed(ring, index == 0));
        let whole: Shapes = vec![rings.collect()];
        let clear = areas::without(whole, walls);
        let clear_m2 = areas::area_m2(&clear);
        if clear_m2 < area_m2 - ROUNDING_M2 {
            return NetRoom { area_m2: clear_m2, pieces: areas::pieces(&clear), has_walls: true };
        }
    }
    let directed = |ring: &[Point], is_outer: bool| areas::points(&areas::directed(ring, is_outer));
    let holes = shape.holes.iter().map(|hole| directed(hole, false)).collect();
    NetRoom { area_m2, pieces: vec![(directed(&shape.outer, true), holes)], has_walls: false }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Builder, Meta, Room};

    /// A wall's ends and thickness.
    type Standing = ((f64, f64), (f64, f64), f64);

    /// A room of 4 m by 3 m between walls on its boundary, with what stands in it.
    fn net(thickness_m: f64, inside: &[Standing]) -> NetRoom {
        let mut builder = Builder::new(Meta::default());
        let at = |(x, y): (f64, f64)| Point::new(x, y);
        let outer = builder.ring([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(at));
        for i in 0..4 {
            builder.wall(outer[i], outer[(i + 1) % 4], thickness_m);
        }
        builder.room("", Room { outer, ..Room::default() });
        for &(a, b, thickness_m) in inside {
            let (a, b) = (builder.corner(at(a)), builder.corner(at(b)));
            builder.wall(a, b, thickness_m);
        }
        let plan = builder.finish().expect("a sound plan");
        let shapes = RoomShapes::new(&plan);
        let net = net_rooms(&plan, &shapes).remove(0).expect("it has an area");
        let alone = net_of(&plan, &shapes.all()[0].outer, &[]);
        assert!((alone.area_m2 - net.area_m2).abs() < 1e-6);
        net
    }

    #[test]
    fn a_room_ends_at_the_faces_of_its_walls() {
        let clear = net(0.5, &[]);
        assert!((clear.area_m2 - 3.5 * 2.5).abs() < 1e-6 && clear.has_walls);
        assert!((clear.perimeter_m() - 12.0).abs() < 1e-6);
        let bare = net(0.0, &[]);
        assert!((bare.area_m2, bare.has_walls) == (12.0, false));
    }

    #[test]
    fn what_stands_in_a_room_takes_its_part() {
        // A pier of 0.4 m by 0.4 m, and a stub of a wall from the middle of a wall's axis.
        let pier = net(0.2, &[((2.0, 1.5), (2.4, 1.5), 0.4)]);
        assert!((pier.area_m2 - (3.8 * 2.8 - 0.16)).abs() < 1e-6 && pier.pieces[0].1.len() == 1);
        let stub = net(0.2, &[((1.0, 0.0), (1.0, 1.1), 0.1)]);
        assert!((stub.area_m2 - (3.8 * 2.8 - 0.1)).abs() < 1e-6);
        let parted = net(0.2, &[((1.0, 0.0), (1.0, 3.0), 0.1)]);
        assert_eq!(parted.pieces.len(), 2);
    }
}
