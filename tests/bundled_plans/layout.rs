//! Rooms tile the floor, walls meet in corners, openings stand clear of other walls.

use std::collections::{BTreeMap, BTreeSet};

use enfilade::geometry::polygon::{self, Location};
use enfilade::geometry::{Point, Segment};
use enfilade::plan::{CornerId, Place, Plan, Wall};
use enfilade::topology::RoomShapes;

use super::{name, plans};

/// An edge between two corners, whichever comes first.
type Edge = (CornerId, CornerId);

fn edge(a: CornerId, b: CornerId) -> Edge {
    (a.min(b), a.max(b))
}

/// The directed edges of all rooms, each ring turned so that its room lies to the left.
fn directed_edges(plan: &Plan) -> Vec<Edge> {
    let mut edges = Vec::new();
    for (_, room) in plan.rooms() {
        for (i, ring) in room.rings().enumerate() {
            let mut ring = ring.to_vec();
            if (polygon::signed_area(&plan.ring_points(&ring)) > 0.0) != (i == 0) {
                ring.reverse();
            }
            edges.extend((0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
        }
    }
    edges
}

fn segment(plan: &Plan, (a, b): Edge) -> Segment {
    Segment::new(plan.position(a).unwrap(), plan.position(b).unwrap())
}

fn walls_by_edge(plan: &Plan) -> BTreeMap<Edge, &Wall> {
    plan.walls().map(|(_, wall)| (edge(wall.from, wall.to), wall)).collect()
}

#[test]
fn rooms_tile_the_floor() {
    for (file, plan) in plans() {
        let edges = directed_edges(&plan);
        let distinct: BTreeSet<Edge> = edges.iter().copied().collect();
        assert_eq!(distinct.len(), edges.len(), "{file}: two rooms lie on the same side of an edge");
        // What no room lies behind is the outline: one ring, if the rooms leave no gap.
        let outline: BTreeMap<CornerId, CornerId> =
            distinct.iter().copied().filter(|&(a, b)| !distinct.contains(&(b, a))).collect();
        let start = *outline.keys().next().unwrap();
        let mut ring = vec![start];
        while outline[ring.last().unwrap()] != start {
            ring.push(outline[ring.last().unwrap()]);
        }
        assert_eq!(ring.len(), outline.len(), "{file}: the outline is one ring");
        let floor_m2 = polygon::signed_area(&plan.ring_points(&ring));
        let rooms_m2: f64 = RoomShapes::new(&plan).all().iter().map(|shape| shape.area_m2()).sum();
        assert!((floor_m2 - rooms_m2).abs() < 1e-6, "{file}: floor {floor_m2} m², rooms {rooms_m2} m²");
    }
}

#[test]
fn no_two_rooms_overlap() {
    // Every point of a grid that is finer than the thickness of a wall lies in at most one room.
    const STEP_M: f64 = 0.1;
    for (file, plan) in plans() {
        let shapes = RoomShapes::new(&plan);
        let bounds = plan.bounds();
        for i in 0..(bounds.width() / STEP_M) as u32 {
            for j in 0..(bounds.height() / STEP_M) as u32 {
                let point = Point::new(
                    bounds.min.x + (f64::from(i) + 0.317) * STEP_M,
                    bounds.min.y + (f64::from(j) + 0.619) * STEP_M,
                );
                let inside: Vec<String> = shapes
                    .at(point)
                    .into_iter()
                    .filter(|&index| shapes.all()[index].locate(point) == Location::Inside)
                    .map(|index| name(&plan, shapes.all()[index].id))
                    .collect();
                assert!(inside.len() <= 1, "{file}: ({}, {}) lies in {inside:?}", point.x, point.y);
            }
        }
    }
}

#[test]
fn walls_meet_in_corners() {
    for (file, plan) in plans() {
        let walls = walls_by_edge(&plan);
        assert_eq!(walls.len(), plan.walls().len(), "{file}: two walls stand on one edge");
        let room_edges: BTreeSet<Edge> = directed_edges(&plan).into_iter().map(|(a, b)| edge(a, b)).collect();
        for &edge in walls.keys().chain(&room_edges) {
            let line = segment(&plan, edge);
            for (id, corner) in plan.corners().filter(|(id, _)| *id != edge.0 && *id != edge.1) {
                // Less than a millimetre apart means on it: turned walls are not exact to the last
                // digit. More than a decimetre means elsewhere: nothing lies in between.
                let distance_m = line.distance(corner.position);
                assert!(distance_m > 0.1, "{file}: the corner {id} lies {distance_m} m from the wall {line:?}");
            }
        }
        // All boundaries of rooms are walls but the porch's open side.
        let open: Vec<f64> = room_edges
            .iter()
            .filter(|edge| !walls.contains_key(*edge))
            .map(|&edge| segment(&plan, edge).length())
            .collect();
        assert_eq!(open.len(), usize::from(file.starts_with("dwelling")), "{file}: {open:?}");
    }
}

#[test]
fn walls_have_the_thickness_of_walls() {
    for (file, plan) in plans() {
        let sides = directed_edges(&plan).into_iter().fold(BTreeMap::<Edge, u32>::new(), |mut sides, (a, b)| {
            *sides.entry(edge(a, b)).or_default() += 1;
            sides
        });
        for (_, wall) in plan.walls() {
            let thickness_m = wall.thickness_m;
            let range = match sides.get(&edge(wall.from, wall.to)) {
                // A column or a fireplace.
                None => 0.3..=0.6,
                // An exterior wall or the low wall round a terrace.
                Some(1) if thickness_m == 0.1 => 0.1..=0.1,
                Some(1) => 0.3..=0.4,
                _ => 0.1..=0.4,
            };
            assert!(range.contains(&thickness_m), "{file}: a wall of {thickness_m} m");
        }
    }
}

#[test]
fn openings_stand_clear_of_other_walls() {
    for (file, plan) in plans() {
        let walls = walls_by_edge(&plan);
        let room_edges: BTreeSet<Edge> = directed_edges(&plan).into_iter().map(|(a, b)| edge(a, b)).collect();
        let mut spans: BTreeMap<Edge, Vec<(f64, f64)>> = BTreeMap::new();
        for (id, opening) in plan.openings() {
            let Place::Hosted { from, to, at_m, width_m } = opening.place else { panic!("{file}: {id} has no host") };
            let host = edge(from, to);
            assert!(room_edges.contains(&host), "{file}: {id} is on no room's boundary");
            let line = segment(&plan, (from, to));
            let along = line.vector().unit().unwrap();
            for (corner, free_m) in [(from, at_m - width_m / 2.0), (to, line.length() - at_m - width_m / 2.0)] {
                let meeting_m = walls
                    .iter()
                    .filter(|(edge, _)| edge.0 == corner || edge.1 == corner)
                    .filter(|(edge, _)| segment(&plan, **edge).vector().unit().unwrap().cross(along).abs() > 0.01)
                    .map(|(_, wall)| wall.thickness_m / 2.0)
                    .fold(0.0, f64::max);
                assert!(
                    free_m >= meeting_m + 0.1 - 1e-3,
                    "{file}: {id} is {free_m} m from a corner whose wall reaches {meeting_m} m"
                );
            }
            let at_m = if from == host.0 { at_m } else { line.length() - at_m };
            spans.entry(host).or_default().push((at_m - width_m / 2.0, at_m + width_m / 2.0));
        }
        for (host, mut spans) in spans {
            spans.sort_by(|p, q| p.0.total_cmp(&q.0));
            for pair in spans.windows(2) {
                assert!(pair[1].0 - pair[0].1 >= 0.2 - 1e-9, "{file}: openings stand too close on {host:?}");
            }
        }
    }
}
