//! Rooms that come by themselves: what walls that were just drawn close becomes a room.

use std::f64::consts::TAU;

use crate::edit::fill::Filled;
use crate::edit::{EditError, fill};
use crate::geometry::polygon::{self, Location};
use crate::geometry::{Bounds, Point};
use crate::plan::{CornerId, Plan, WallId};
use crate::topology::plan_faces::PlanFaces;

/// The most walls around one face that are followed: no room has more.
const MOST_AROUND: usize = 10_000;

/// Makes rooms of what `walls`, just drawn in `drawn`, enclose with walls that stood there: each face that walls alone
/// enclose now and did not in `before`, unless it has a room or is a sliver. What was enclosed before and has no room
/// was left empty on purpose and stays so.
///
/// # Errors
/// When the walls meet more often than [`crate::geometry::arrangement::PASSINGS_LIMIT`].
pub fn fill_closed(before: &Plan, drawn: &Plan, walls: &[WallId]) -> Result<Filled, EditError> {
    let around = WallGraph::new(drawn).rings_of(drawn, walls);
    let bounds = around.iter().fold(Bounds::EMPTY, |all, ring| all.union(polygon::bounds(ring)));
    if bounds.is_empty() {
        return Ok(Filled { plan: drawn.clone(), rooms: Vec::new() });
    }
    let (faces_before, faces) = (PlanFaces::within(before, bounds)?, PlanFaces::within(drawn, bounds)?);
    let was_closed = |point: Point| faces_before.at(point).is_some_and(|index| faces_before.all()[index].by_walls);
    let closed: Vec<usize> = (0..faces.all().len())
        .filter(|&index| {
            let face = &faces.all()[index];
            let inside = faces.interior_point(index);
            let is_around = |ring: &Vec<Point>| polygon::locate_in_ring(ring, inside) == Location::Inside;
            face.by_walls
                && face.rooms.is_empty()
                && !face.is_sliver()
                && around.iter().any(is_around)
                && !was_closed(inside)
        })
        .collect();
    fill::fill_faces(&faces, &closed)
}

/// The walls at each corner.
struct WallGraph {
    /// From corner to corner, both ways, sorted.
    ways: Vec<[CornerId; 2]>,
}

impl WallGraph {
    fn new(plan: &Plan) -> Self {
        let mut ways: Vec<[CornerId; 2]> =
            plan.walls().flat_map(|(_, wall)| [[wall.from, wall.to], [wall.to, wall.from]]).collect();
        ways.sort_unstable();
        ways.dedup();
        Self { ways }
    }

    fn neighbours(&self, corner: CornerId) -> impl Iterator<Item = CornerId> + '_ {
        let first = self.ways.partition_point(|way| way[0] < corner);
        self.ways[first..].iter().take_while(move |way| way[0] == corner).map(|way| way[1])
    }

    /// The closed rings of walls on both sides of some walls, counter-clockwise.
    fn rings_of(&self, plan: &Plan, walls: &[WallId]) -> Vec<Vec<Point>> {
        let ends = walls.iter().filter_map(|&id| plan.wall(id)).map(|wall| [wall.from, wall.to]);
        let ways = ends.flat_map(|[from, to]| [[from, to], [to, from]]);
        ways.filter_map(|way| self.ring_left_of(plan, way)).filter(|ring| polygon::signed_area(ring) > 0.0).collect()
    }

    /// The ring of walls around what lies left of a way along a wall.
    fn ring_left_of(&self, plan: &Plan, first: [CornerId; 2]) -> Option<Vec<Point>> {
        let mut ring = vec![plan.position(first[0])?];
        let mut way = first;
        loop {
            let [from, at] = way;
            let here = plan.position(at)?;
            ring.push(here);
            let back = plan.position(from)? - here;
            // The next wall clockwise from the one that was come by; the same back where it ends freely.
            let turn = |to: CornerId| {
                let way = plan.position(to)? - here;
                let angle_rad = way.cross(back).atan2(way.dot(back));
                Some(if angle_rad <= 1e-12 { angle_rad + TAU } else { angle_rad })
            };
            let turns = self.neighbours(at).filter_map(|to| Some((if to == from { TAU } else { turn(to)? }, to)));
            let (_, next) = turns.min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)))?;
            way = [at, next];
            if way == first {
                ring.pop();
                return Some(ring);
            }
            if ring.len() > MOST_AROUND {
                return None;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{draw_walls, remove};
    use crate::plan::ElementId;
    use crate::topology::RoomShapes;

    fn at(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    /// Draws walls as the window does, one after the other.
    fn draw(plan: &Plan, points: &[(f64, f64)]) -> Plan {
        let mut plan = plan.clone();
        for pair in at(points).windows(2) {
            let drawn = draw_walls(&plan, pair, 0.2).expect("walls");
            plan = fill_closed(&plan, &drawn.plan, &drawn.walls).expect("it fills").plan;
        }
        assert_eq!(plan.violations(), []);
        plan
    }

    fn areas(plan: &Plan) -> Vec<f64> {
        let mut areas: Vec<f64> = RoomShapes::new(plan).all().iter().map(|shape| shape.area_m2().round()).collect();
        areas.sort_by(f64::total_cmp);
        areas
    }

    const SQUARE: [(f64, f64); 5] = [(0.0, 0.0), (6.0, 0.0), (6.0, 4.0), (0.0, 4.0), (0.0, 0.0)];

    #[test]
    fn the_wall_that_closes_makes_the_room_once() {
        let open = draw(&Plan::default(), &SQUARE[..4]);
        assert_eq!(areas(&open), [] as [f64; 0]);
        let closed = draw(&open, &SQUARE[3..]);
        assert_eq!(areas(&closed), [24.0]);
        // A partition splits the room and makes none beside it.
        let split = draw(&closed, &[(2.0, 0.0), (2.0, 4.0)]);
        assert_eq!(areas(&split), [8.0, 16.0]);
        // A free end closes nothing.
        assert_eq!(areas(&draw(&split, &[(6.0, 2.0), (9.0, 2.0)])), [8.0, 16.0]);
        // Another house around the corner, which shares a wall.
        let beside = draw(&split, &[(6.0, 0.0), (9.0, 0.0), (9.0, 4.0), (6.0, 4.0)]);
        assert_eq!(areas(&beside), [8.0, 12.0, 16.0]);
    }

    #[test]
    fn what_was_left_empty_stays_empty() {
        let closed = draw(&Plan::default(), &SQUARE);
        let room = closed.rooms().next().expect("a room").0;
        let empty = remove(&closed, &[ElementId::Room(room)]).expect("it goes");
        assert_eq!(areas(&draw(&empty, &[(2.0, 0.0), (2.0, 4.0)])), [] as [f64; 0]);
        // What is closed anew becomes a room all the same.
        assert_eq!(areas(&draw(&empty, &[(6.0, 0.0), (9.0, 0.0), (9.0, 4.0), (6.0, 4.0)])), [12.0]);
    }

    #[test]
    fn a_house_drawn_around_another_has_a_hole() {
        let inner = draw(&Plan::default(), &SQUARE);
        let around = draw(&inner, &[(-5.0, -5.0), (11.0, -5.0), (11.0, 9.0), (-5.0, 9.0), (-5.0, -5.0)]);
        assert_eq!(areas(&around), [24.0, 200.0]);
        // Many at once: a grid of lines.
        let mut grid = Plan::default();
        for k in 0..4 {
            let k = f64::from(k) * 3.0;
            grid = draw(&grid, &[(k, 0.0), (k, 9.0)]);
        }
        for k in 0..4 {
            let k = f64::from(k) * 3.0;
            grid = draw(&grid, &[(0.0, k), (9.0, k)]);
        }
        assert_eq!(areas(&grid), [9.0; 9]);
    }
}
