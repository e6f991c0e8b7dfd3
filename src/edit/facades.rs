//! The usual chains around a building: on each side one with all openings and offsets of the facade, and one of its
//! whole length.

use rstar::{AABB, RTree};
use std::collections::BTreeMap;

use crate::edit::{EditError, draw_dimension, fail};
use crate::geometry::tangle::entry;
use crate::geometry::{Bounds, Point, Segment, Vector};
use crate::plan::{CornerId, DimensionAlong, Place, Plan, ordered, ring_edges};
use crate::topology::wall_bodies::faces;

/// From the building to the first chain, and from that to the next, in metres: 10 mm on paper at 1:100, where the
/// figures of narrow stretches stand higher.
const FIRST_M: f64 = 1.0;
const NEXT_M: f64 = 1.0;

/// An offset of the facade nearer than this to an opening or to another offset is not measured, in metres: its figure
/// could not be read, and the wall beside a door says as much.
const LEAST_OFFSET_M: f64 = 0.2;

/// Faces within eight degrees of a side's direction belong to it; what is more oblique has no length along it.
const SQUARE_COS: f64 = 0.99;

/// Faces whose planes lie within this of each other, in metres, are one facade; a gap as narrow is none.
const SAME_M: f64 = 0.01;

/// A building seen from one side.
struct Side {
    /// Outwards.
    out: Vector,
    along: DimensionAlong,
}

const SIDES: [Side; 4] = [
    Side { out: Vector::new(0.0, -1.0), along: DimensionAlong::Horizontal },
    Side { out: Vector::new(0.0, 1.0), along: DimensionAlong::Horizontal },
    Side { out: Vector::new(-1.0, 0.0), along: DimensionAlong::Vertical },
    Side { out: Vector::new(1.0, 0.0), along: DimensionAlong::Vertical },
];

/// A face that may be seen from outside, and the way out of it.
struct Face {
    line: Segment,
    out: Vector,
    /// The corners of its edge.
    edge: [CornerId; 2],
}

/// The faces of walls on both sides and, of rooms without walls, their edges.
fn all_faces(plan: &Plan) -> (Vec<Face>, Vec<Segment>) {
    let mut found = Vec::new();
    let mut lines = Vec::new();
    let mut walled = std::collections::BTreeSet::new();
    let of_walls = faces(plan);
    for (id, wall) in plan.walls() {
        walled.insert(ordered(wall.from, wall.to));
        let Some(axis) = plan.wall_segment(wall) else { continue };
        lines.push(axis);
        let Some(left) = axis.vector().unit().map(Vector::left) else { continue };
        let edge = [wall.from, wall.to];
        let [on_left, on_right] = of_walls.get(&id).map_or([axis; 2], |faces| [faces.left, faces.right]);
        found.push(Face { line: on_left, out: left, edge });
        found.push(Face { line: on_right, out: -left, edge });
    }
    let rings = plan.rooms().flat_map(|(_, room)| room.rings());
    for (from, to) in rings.flat_map(|ring| ring_edges(ring)).filter(|&(from, to)| walled.insert(ordered(from, to))) {
        let Some((a, b)) = plan.position(from).zip(plan.position(to)) else { continue };
        let line = Segment::new(a, b);
        lines.push(line);
        let Some(left) = line.vector().unit().map(Vector::left) else { continue };
        found.push(Face { line, out: left, edge: [from, to] });
        found.push(Face { line, out: -left, edge: [from, to] });
    }
    (found, lines)
}

/// Draws chains along the sides of the building that lack them, and says how many.
///
/// # Errors
/// When nothing stands there that has a level or upright side.
pub fn dimension_outside(plan: &Plan) -> Result<(Plan, usize), EditError> {
    let (faces, lines) = all_faces(plan);
    let bounds = Bounds::of(faces.iter().flat_map(|face| [face.line.a, face.line.b]));
    if bounds.is_empty() {
        return fail("nothing is drawn yet that could be dimensioned");
    }
    let tree = RTree::bulk_load(lines.into_iter().map(|line| entry(line, ())).collect());
    let mut next = plan.clone();
    let (mut drawn, mut seen) = (0, false);
    for side in SIDES {
        let points = measured(plan, &side, &faces, &tree, bounds);
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else { continue };
        seen = true;
        let edge = if side.out.x + side.out.y < 0.0 { bounds.min } else { bounds.max };
        let whole = [first, last];
        // A facade without openings and offsets has one chain.
        let chains = std::iter::once(points.as_slice()).filter(|points| points.len() > 2).chain([whole.as_slice()]);
        for (index, chain) in chains.enumerate() {
            let through = edge + side.out * (FIRST_M + NEXT_M * index as f64);
            let (with_chain, id) = draw_dimension(&next, chain, side.along, through)?;
            let line = with_chain.dimension(id).and_then(|dimension| with_chain.dimension_line(dimension));
            let is_there = line.is_some_and(|line| {
                next.dimensions()
                    .any(|(_, other)| next.dimension_line(other).is_some_and(|other| is_same(&other, &line)))
            });
            if !is_there {
                next = with_chain;
                drawn += 1;
            }
        }
    }
    match seen {
        true => Ok((next, drawn)),
        false => fail("no outer wall runs level or upright: draw the dimensions by hand"),
    }
}

/// Whether two chains measure the same in the same place.
fn is_same(one: &crate::plan::DimensionLine, other: &crate::plan::DimensionLine) -> bool {
    one.ticks.len() == other.ticks.len() && one.ticks.iter().zip(&other.ticks).all(|(p, q)| p.1.distance(q.1) <= SAME_M)
}

/// What is measured on a side, in order along it.
fn measured(
    plan: &Plan,
    side: &Side,
    faces: &[Face],
    tree: &crate::geometry::tangle::LineTree<()>,
    bounds: Bounds,
) -> Vec<Point> {
    let along = side.along.direction().unwrap_or_default();
    let place_m = |point: Point| (point - Point::default()).dot(along);
    let depth_m = |point: Point| (point - Point::default()).dot(side.out);
    let far_m = depth_m(bounds.min).max(depth_m(bounds.max)) + 1.0;
    let is_seen = |face: &Face| {
        let from = face.line.midpoint() + side.out * 1e-3;
        let ray = Segment::new(from, from + side.out * (far_m - depth_m(from)));
        let envelope = AABB::from_corners([ray.a.x, ray.a.y], [ray.b.x, ray.b.y]);
        tree.locate_in_envelope_intersecting(envelope).next().is_none()
    };
    let faces: Vec<&Face> = faces.iter().filter(|face| face.out.dot(side.out) >= SQUARE_COS && is_seen(face)).collect();
    // Stretches of one facade, each its deepest place, its start and its end.
    let mut stretches: Vec<[Point; 2]> = faces
        .iter()
        .map(|face| {
            let Segment { a, b } = face.line;
            if place_m(a) <= place_m(b) { [a, b] } else { [b, a] }
        })
        .collect();
    stretches.sort_by(|p, q| place_m(p[0]).total_cmp(&place_m(q[0])).then(depth_m(p[0]).total_cmp(&depth_m(q[0]))));
    let mut merged: Vec<[Point; 2]> = Vec::new();
    for stretch in stretches {
        let before = merged.iter_mut().find(|[_, end]| {
            (depth_m(*end) - depth_m(stretch[0])).abs() <= SAME_M && place_m(stretch[0]) - place_m(*end) <= SAME_M
        });
        match before {
            Some([_, end]) if place_m(stretch[1]) > place_m(*end) => *end = stretch[1],
            Some(_) => {}
            None => merged.push(stretch),
        }
    }
    let offsets: Vec<Point> = merged.into_iter().flatten().collect();
    let mut points: Vec<Point> = Vec::new();
    let seen: BTreeMap<[CornerId; 2], &Face> =
        faces.iter().map(|face| (ordered(face.edge[0], face.edge[1]), *face)).collect();
    for (_, opening) in plan.openings() {
        let Place::Hosted { from, to, .. } = opening.place else { continue };
        let Some(face) = seen.get(&ordered(from, to)) else { continue };
        let Some(Segment { a, b }) = plan.opening_segment(opening) else { continue };
        let out_m = (face.line.a - a).dot(face.out);
        points.extend([a, b].map(|end| end + face.out * out_m));
    }
    let by_place = |p: &Point, q: &Point| place_m(*p).total_cmp(&place_m(*q)).then(depth_m(*q).total_cmp(&depth_m(*p)));
    // The ends come first, then the openings, then what stands clear of both.
    let [first, last] = [offsets.iter().copied().min_by(by_place), offsets.iter().copied().max_by(by_place)];
    points.extend(first.into_iter().chain(last));
    for offset in offsets {
        if points.iter().all(|point| (place_m(*point) - place_m(offset)).abs() >= LEAST_OFFSET_M) {
            points.push(offset);
        }
    }
    points.sort_by(by_place);
    points.dedup_by(|next, kept| place_m(*next) - place_m(*kept) <= SAME_M);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit::{draw_room, place_opening};
    use crate::plan::OpeningKind;

    fn chains(plan: &Plan) -> Vec<String> {
        let lengths = |line: crate::plan::DimensionLine| {
            line.lengths_m().map(|length_m| format!("{length_m:.2}")).collect::<Vec<_>>().join(" ")
        };
        let mut all: Vec<String> =
            plan.dimensions().filter_map(|(_, dimension)| Some(lengths(plan.dimension_line(dimension)?))).collect();
        all.sort();
        all
    }

    #[test]
    fn each_side_has_its_openings_and_its_length() {
        // An L: 8 by 6 m, less 4 by 3 m at the upper right; 0.3 m walls on the axes.
        let ring =
            [(0.0, 0.0), (8.0, 0.0), (8.0, 3.0), (4.0, 3.0), (4.0, 6.0), (0.0, 6.0)].map(|(x, y)| Point::new(x, y));
        let plan = draw_room(&Plan::default(), &ring, Some(0.3)).unwrap().0;
        let window = |plan: &Plan, x: f64, y: f64| {
            place_opening(plan, OpeningKind::Window, Point::new(x, y), 1.0, 0.5, Some(Point::new(4.0, 1.5))).unwrap().0
        };
        // Below, at the step, and on the right.
        let plan = window(&window(&window(&plan, 2.0, 0.0), 6.0, 3.0), 8.0, 1.5);
        let (drawn, number) = dimension_outside(&plan).unwrap();
        assert_eq!(number, 7, "{:?}", chains(&drawn));
        assert_eq!(
            chains(&drawn),
            ["1.15 1.00 1.15 3.00", "1.65 1.00 5.65", "4.30 1.35 1.00 1.65", "6.30", "6.30", "8.30", "8.30"]
        );
        assert_eq!(drawn.violations(), Vec::new());
        // All hold on to something; a second time nothing is missing.
        let held = drawn.dimensions().flat_map(|(_, dimension)| &dimension.points).all(|point| point.on.is_some());
        assert!(held, "{:?}", drawn.dimensions().collect::<Vec<_>>());
        assert_eq!(dimension_outside(&drawn).unwrap().1, 0);
        assert!(dimension_outside(&Plan::default()).is_err());
    }
}
