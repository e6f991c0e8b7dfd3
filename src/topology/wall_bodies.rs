//! What walls take up: their bodies, joined with mitres, and their faces.

use std::collections::{BTreeMap, BTreeSet};

use rstar::RTree;

use crate::geometry::areas::{Ring, ring};
use crate::geometry::tangle::{entry, tangled};
use crate::geometry::{Point, Segment, Vector};
use crate::plan::{CornerId, Plan, WallId};

/// The bodies of a plan's walls. Openings are not cut out: the floor of a doorway belongs to no room.
#[derive(Debug, Default)]
pub struct WallBodies {
    /// A rectangle for each wall with a thickness, and at each corner the mitre that closes the joint on its outer
    /// side, all counter-clockwise: together, under the non-zero rule, they are the walls.
    pub rings: Vec<Ring>,
    /// Walls that cross others so often that they are left out: none in a building, some in what a fuzzer draws.
    pub tangled: BTreeSet<WallId>,
}

impl WallBodies {
    /// The bodies of all walls of a plan.
    pub fn new(plan: &Plan) -> Self {
        let walls: Vec<(WallId, f64, Segment)> = axes(plan).collect();
        let segments: Vec<Segment> = walls.iter().map(|(_, _, segment)| *segment).collect();
        let tree = RTree::bulk_load(segments.iter().map(|&segment| entry(segment, ())).collect());
        let is_tangled = tangled(&segments, &tree);
        let tangled: BTreeSet<WallId> =
            walls.iter().zip(&is_tangled).filter(|(_, is_tangled)| **is_tangled).map(|((id, ..), _)| *id).collect();
        let mut rings: Vec<Ring> = walls
            .iter()
            .filter(|(id, thickness_m, _)| *thickness_m > 0.0 && !tangled.contains(id))
            .map(|&(_, thickness_m, segment)| rectangle(segment, thickness_m / 2.0))
            .collect();
        for joint in joints(plan, &tangled) {
            for (i, a) in joint.ends.iter().enumerate() {
                rings.extend(mitre(joint.at, a, &joint.ends[(i + 1) % joint.ends.len()]));
            }
        }
        Self { rings, tangled }
    }
}

/// The faces of a wall, both in the direction of its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallFaces {
    /// On the left, seen from the wall's first corner to its second.
    pub left: Segment,
    pub right: Segment,
}

/// The faces of all walls with a thickness. They end where they meet those of the next wall around the corner, else
/// at right angles to the corner.
pub fn faces(plan: &Plan) -> BTreeMap<WallId, WallFaces> {
    let mut faces: BTreeMap<WallId, WallFaces> = BTreeMap::new();
    for (id, thickness_m, axis) in axes(plan).filter(|(_, thickness_m, _)| *thickness_m > 0.0) {
        let Some(left) = axis.vector().left().unit().map(|left| left * (thickness_m / 2.0)) else { continue };
        let moved = |by: Vector| Segment::new(axis.a + by, axis.b + by);
        faces.insert(id, WallFaces { left: moved(left), right: moved(-left) });
    }
    for joint in joints(plan, &BTreeSet::new()) {
        for (i, a) in joint.ends.iter().enumerate() {
            let b = &joint.ends[(i + 1) % joint.ends.len()];
            let Some(tip) = meeting(joint.at, a, b) else { continue };
            // On the left of a wall that leaves the corner, on the right of the next one.
            for (end, is_left) in [(a, true), (b, false)] {
                // Of a wall shorter than others are thick, nothing would be left.
                if (tip - joint.at).dot(end.along) > end.length_m / 2.0 {
                    continue;
                }
                let Some(of_wall) = faces.get_mut(&end.wall) else { continue };
                let face = if is_left == end.is_first { &mut of_wall.left } else { &mut of_wall.right };
                *(if end.is_first { &mut face.a } else { &mut face.b }) = tip;
            }
        }
    }
    faces
}

/// The walls that have a length: id, thickness in metres, and axis.
pub(crate) fn axes(plan: &Plan) -> impl Iterator<Item = (WallId, f64, Segment)> + '_ {
    plan.walls().filter_map(|(id, wall)| {
        let segment = plan.wall_segment(wall).filter(|segment| segment.length() > 0.0)?;
        Some((id, wall.thickness_m, segment))
    })
}

/// The end of a wall at a corner.
struct End {
    wall: WallId,
    /// Whether it is the wall's first.
    is_first: bool,
    /// Away from the corner, of length 1.
    along: Vector,
    length_m: f64,
    /// Half the thickness in metres, above 0.
    half_m: f64,
}

/// Where walls with a thickness meet.
struct Joint {
    at: Point,
    /// At least two, counter-clockwise.
    ends: Vec<End>,
}

/// The corners at which walls meet, by corner.
fn joints(plan: &Plan, without: &BTreeSet<WallId>) -> Vec<Joint> {
    let mut ends: BTreeMap<CornerId, Vec<End>> = BTreeMap::new();
    for (id, wall) in plan.walls().filter(|(id, _)| !without.contains(id)) {
        let (Some(segment), half_m) = (plan.wall_segment(wall), wall.thickness_m / 2.0) else { continue };
        let Some(along) = segment.vector().unit().filter(|_| half_m > 0.0) else { continue };
        let length_m = segment.length();
        ends.entry(wall.from).or_default().push(End { wall: id, is_first: true, along, length_m, half_m });
        ends.entry(wall.to).or_default().push(End { wall: id, is_first: false, along: -along, length_m, half_m });
    }
    let joint = |(corner, mut ends): (CornerId, Vec<End>)| {
        let at = plan.position(corner).filter(|_| ends.len() > 1)?;
        ends.sort_by(|p, q| p.along.angle_rad().total_cmp(&q.along.angle_rad()));
        Some(Joint { at, ends })
    };
    ends.into_iter().filter_map(joint).collect()
}

/// The rectangle of a wall.
fn rectangle(segment: Segment, half_m: f64) -> Ring {
    let Some(left) = segment.vector().left().unit().map(|left| left * half_m) else { return Ring::new() };
    ring(&[segment.a - left, segment.b - left, segment.b + left, segment.a + left])
}

/// A joint sharper than this many half thicknesses is cut off, as with SVG's `stroke-miterlimit`.
const MITRE_LIMIT: f64 = 4.0;

/// Below this sine of the angle between them, walls run straight on.
const STRAIGHT_ON: f64 = 1e-9;

/// The feet, at a corner, of the face left of `a` and of the face right of `b`, the next wall counter-clockwise.
fn feet(at: Point, a: &End, b: &End) -> (Point, Point) {
    (at + a.along.left() * a.half_m, at - b.along.left() * b.half_m)
}

/// Where these two faces meet; `None` where they run side by side, or meet too far outside a sharp joint.
fn meeting(at: Point, a: &End, b: &End) -> Option<Point> {
    let (face_a, face_b) = feet(at, a, b);
    let turn = a.along.cross(b.along);
    if turn.abs() <= STRAIGHT_ON {
        return None;
    }
    let tip = face_a + a.along * ((face_b - face_a).cross(b.along) / turn);
    (turn > 0.0 || at.distance(tip) <= MITRE_LIMIT * a.half_m.max(b.half_m)).then_some(tip)
}

/// The piece that closes the joint between two walls, where `b` is next counter-clockwise after `a`; `None` unless the
/// angle between them is more than half a turn.
fn mitre(at: Point, a: &End, b: &End) -> Option<Ring> {
    if a.along.cross(b.along) >= -STRAIGHT_ON {
        return None;
    }
    // The faces on the far side of the joint.
    let (face_a, face_b) = feet(at, a, b);
    Some(match meeting(at, a, b) {
        Some(tip) => ring(&[at, face_a, tip, face_b]),
        None => ring(&[at, face_a, face_b]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Builder, Meta};

    /// Walls of 0.24 m along x and 0.36 m along y that meet in the origin, and a partition below the first.
    fn plan() -> (Plan, [WallId; 3]) {
        let mut builder = Builder::new(Meta::default());
        let [origin, right, up, below] =
            [(0.0, 0.0), (4.0, 0.0), (0.0, 3.0), (4.0, -2.0)].map(|(x, y)| builder.corner(Point::new(x, y)));
        let walls =
            [builder.wall(origin, right, 0.24), builder.wall(up, origin, 0.36), builder.wall(right, below, 0.1)];
        (builder.finish().expect("a sound plan"), walls)
    }

    #[test]
    fn faces_end_where_they_meet() {
        let (plan, walls) = plan();
        let faces = faces(&plan);
        let near = |found: Segment, a: (f64, f64), b: (f64, f64)| {
            let off = found.a.distance(Point::new(a.0, a.1)).max(found.b.distance(Point::new(b.0, b.1)));
            assert!(off < 1e-9, "{found:?}");
        };
        // Above the first wall is the corner of the room, below it the corner of the building and the partition.
        near(faces[&walls[0]].left, (0.18, 0.12), (4.05, 0.12));
        near(faces[&walls[0]].right, (-0.18, -0.12), (3.95, -0.12));
        near(faces[&walls[1]].left, (0.18, 3.0), (0.18, 0.12));
        near(faces[&walls[1]].right, (-0.18, 3.0), (-0.18, -0.12));
        near(faces[&walls[2]].right, (3.95, -0.12), (3.95, -2.0));
    }

    #[test]
    fn a_sharp_joint_is_cut_off() {
        let mut builder = Builder::new(Meta::default());
        let [origin, right, back] = [(0.0, 0.0), (4.0, 0.0), (4.0, 0.2)].map(|(x, y)| builder.corner(Point::new(x, y)));
        let wall = builder.wall(origin, right, 0.2);
        builder.wall(origin, back, 0.2);
        let plan = builder.finish().expect("a sound plan");
        assert_eq!(faces(&plan)[&wall].right.a, Point::new(0.0, -0.1));
        assert_eq!(WallBodies::new(&plan).rings.len(), 3);
    }
}
