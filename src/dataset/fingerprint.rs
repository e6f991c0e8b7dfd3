//! What tells a room again wherever it is read: measures of its boundary and of where its nearest rooms lie. They stay the
//! same when the plan is moved, turned or mirrored, when corners are listed from another start or the other way round, and
//! when points are added along an edge; they do not depend on names, labels or the file's format.

use rstar::RTree;
use rstar::primitives::GeomWithData;

use crate::base::hash;
use crate::geometry::{Point, polygon};
use crate::topology::{RoomShape, RoomShapes};

/// Nearest rooms that count. With three, rooms of one size tell apart by where they are along a corridor, and a room changed
/// far away changes nothing.
const NEAREST: usize = 3;

const MEASURES: usize = 3 + NEAREST;

/// The step of the grid in which measures are compared, in metres.
const STEP_M: f64 = 0.04;

/// Two readings of one room differ by less: coordinates are written to 0.1 mm at best, and to some millimetres at worst.
const NOISE_M: f64 = 0.004;

/// The same for logarithms of lengths, where rooms need only be alike.
const ROUGH_STEP: f64 = 0.12;

/// Lengths of rooms that are alike differ by some three per cent.
const ROUGH_NOISE: f64 = 0.03;

/// What tells a room again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoomPrint {
    /// Centre of its area, in the plan's metres.
    pub centre: Point,
    pub area_m2: f64,
    /// Length of the outer boundary and of the holes.
    pub perimeter_m: f64,
    /// The root of the area, a quarter of the perimeter, the radius of gyration about the centre, and the distances to the
    /// centres of the nearest rooms (0 where there are not so many), all in metres.
    measures: [f64; MEASURES],
}

impl RoomPrint {
    /// A number that two readings of the room share, unless a measure lies at the edge of a step: then one of
    /// [`RoomPrint::hashes`] is the other's.
    pub fn hash(&self) -> u32 {
        self.hashes()[0]
    }

    /// The hashes that another reading of the room may have: two for each measure that lies at the edge of a step. The first is
    /// [`RoomPrint::hash`].
    pub fn hashes(&self) -> Vec<u32> {
        hashes(&self.measures, STEP_M, NOISE_M)
    }

    /// The same for rooms that are alike but for some per cent of their lengths, as in storeys that were drawn one by one.
    pub fn rough_hashes(&self) -> Vec<u32> {
        let lengths = [self.measures[0], self.measures[1], self.measures[3]];
        hashes(&lengths.map(|length| length.max(NOISE_M).ln()), ROUGH_STEP, ROUGH_NOISE)
    }

    /// Whether another room has the same size and outline length, to what files keep, when its plan is `scale` times as large.
    pub fn is_like(&self, other: &Self, scale: f64, tolerance: f64) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() <= 5.0 * NOISE_M + tolerance * a.max(b);
        near(self.area_m2.sqrt() * scale, other.area_m2.sqrt()) && near(self.perimeter_m * scale, other.perimeter_m)
    }
}

fn hashes(measures: &[f64], step: f64, noise: f64) -> Vec<u32> {
    let step_of = |measure: f64| (measure / step).floor() as i64;
    let mut all: Vec<Vec<i64>> = vec![measures.iter().copied().map(step_of).collect()];
    for (index, &measure) in measures.iter().enumerate() {
        let others = [measure - noise, measure + noise].into_iter().map(step_of);
        if let Some(other) = others.into_iter().find(|&other| other != step_of(measure)) {
            for at in 0..all.len() {
                let mut changed = all[at].clone();
                changed[index] = other;
                all.push(changed);
            }
        }
    }
    let folded = |steps: Vec<i64>| {
        let hash = hash::fnv1a(hash::START, steps.into_iter().flat_map(i64::to_le_bytes));
        (hash ^ (hash >> 32)) as u32
    };
    all.into_iter().map(folded).collect()
}

/// The prints of all rooms of a plan that enclose an area, in the order of [`RoomShapes::all`], whatever they are for: what
/// counts as a neighbour must not depend on a label scheme.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prints(Vec<Option<RoomPrint>>);

/// With more rooms changed by an edit, all are compared again.
const FEW_CHANGED: usize = 40;

impl Prints {
    pub fn new(shapes: &RoomShapes) -> Self {
        let mut prints = Self(shapes.all().iter().map(of_shape).collect());
        let centres = prints.0.iter().enumerate().filter_map(|(index, room)| Some((index, room.as_ref()?.centre)));
        let tree =
            RTree::bulk_load(centres.map(|(index, centre)| GeomWithData::new([centre.x, centre.y], index)).collect());
        for (index, room) in prints.0.iter_mut().enumerate() {
            let Some(room) = room else { continue };
            let nearest =
                tree.nearest_neighbor_iter([room.centre.x, room.centre.y]).filter(|other| other.data != index);
            for (slot, other) in room.measures[MEASURES - NEAREST..].iter_mut().zip(nearest) {
                let [x, y] = *other.geom();
                *slot = room.centre.distance(Point::new(x, y));
            }
        }
        prints
    }

    /// The prints after an edit, from those before it: the same as [`Prints::new`]. A room is compared again where one that
    /// changed was or is among the nearest.
    pub fn after(shapes: &RoomShapes, shapes_before: &RoomShapes, before: &Self) -> Self {
        let mut prints: Vec<Option<RoomPrint>> = Vec::with_capacity(shapes.all().len());
        let mut is_new: Vec<bool> = Vec::with_capacity(shapes.all().len());
        let mut changed: Vec<Point> = Vec::new();
        let mut known = shapes_before.all().iter().zip(&before.0).peekable();
        for shape in shapes.all() {
            // Both are sorted by id; what is passed over has gone.
            while let Some((_, gone)) = known.next_if(|(earlier, _)| earlier.id < shape.id) {
                changed.extend(gone.as_ref().map(|print| print.centre));
            }
            let earlier = known.next_if(|(earlier, _)| earlier.id == shape.id);
            match earlier.filter(|(earlier, _)| *earlier == shape) {
                Some((_, print)) => {
                    prints.push(*print);
                    is_new.push(false);
                }
                None => {
                    let print = of_shape(shape);
                    changed.extend(earlier.and_then(|(_, print)| print.as_ref()).map(|print| print.centre));
                    changed.extend(print.as_ref().map(|print| print.centre));
                    prints.push(print);
                    is_new.push(true);
                }
            }
        }
        changed.extend(known.filter_map(|(_, gone)| Some(gone.as_ref()?.centre)));
        if changed.len() > FEW_CHANGED {
            return Self::new(shapes);
        }
        let centres: Vec<Option<Point>> = prints.iter().map(|print| Some(print.as_ref()?.centre)).collect();
        for (index, print) in prints.iter_mut().enumerate() {
            let Some(print) = print else { continue };
            let nearest = &mut print.measures[MEASURES - NEAREST..];
            let farthest_m = if nearest.contains(&0.0) { f64::INFINITY } else { nearest[NEAREST - 1] };
            let centre = print.centre;
            if !is_new[index] && !changed.iter().any(|other| centre.distance(*other) <= farthest_m + 1e-9) {
                continue;
            }
            // The nearest so far, by the square of the distance as the tree compares them.
            let mut near = [(f64::INFINITY, 0.0); NEAREST];
            for (_, other) in centres.iter().enumerate().filter(|(other, _)| *other != index) {
                let Some(other) = *other else { continue };
                let (x, y) = (other.x - centre.x, other.y - centre.y);
                let square = x * x + y * y;
                if square < near[NEAREST - 1].0 {
                    let place = near.iter().position(|(than, _)| square < *than).unwrap_or(NEAREST - 1);
                    near[place..].rotate_right(1);
                    near[place] = (square, centre.distance(other));
                }
            }
            for (slot, (_, distance_m)) in nearest.iter_mut().zip(near) {
                *slot = distance_m;
            }
        }
        Self(prints)
    }

    /// The print of the room with an index in [`RoomShapes::all`].
    pub fn of(&self, index: usize) -> Option<&RoomPrint> {
        self.0.get(index)?.as_ref()
    }
}

fn of_shape(shape: &RoomShape) -> Option<RoomPrint> {
    let &start = shape.outer.first()?;
    // Area, first and second moments about a corner, holes taken off; whichever way the rings run.
    let (mut area, mut x, mut y, mut second) = (0.0, 0.0, 0.0, 0.0);
    for (index, ring) in shape.rings().enumerate() {
        let sign = polygon::signed_area(ring).signum() * if index == 0 { 1.0 } else { -1.0 };
        for edge in polygon::edges(ring) {
            let (p, q) = (edge.a - start, edge.b - start);
            let cross = sign * p.cross(q);
            area += cross / 2.0;
            x += (p.x + q.x) * cross / 6.0;
            y += (p.y + q.y) * cross / 6.0;
            second += (p.dot(p) + p.dot(q) + q.dot(q)) * cross / 12.0;
        }
    }
    if !(area.is_finite() && area > 1e-6) {
        return None;
    }
    let (x, y) = (x / area, y / area);
    let gyration = (second / area - x * x - y * y).max(0.0).sqrt();
    let perimeter_m = shape.perimeter_m();
    let mut measures = [0.0; MEASURES];
    measures[..3].copy_from_slice(&[area.sqrt(), perimeter_m / 4.0, gyration]);
    Some(RoomPrint { centre: Point::new(start.x + x, start.y + y), area_m2: area, perimeter_m, measures })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit;
    use crate::geometry::{Transform, Vector};
    use crate::plan::Plan;

    fn of(plan: &Plan) -> Vec<RoomPrint> {
        Prints::new(&RoomShapes::new(plan)).0.into_iter().flatten().collect()
    }

    /// A plan moved, turned by some angle and mirrored, its corners put on the grid again: each room is still itself.
    #[test]
    fn a_room_is_known_again_wherever_its_plan_lies() {
        for (name, plan) in crate::store::bundled_plans().unwrap() {
            let before = of(&plan);
            let mirror = Transform::reflection(Point::new(3.0, 1.0), Point::new(4.0, 7.0)).unwrap();
            for way in [
                Transform::translation(Vector::new(1234.5678, -77.0001)),
                Transform::rotation(Point::new(1.0, 2.0), 0.3),
                mirror,
            ] {
                let elements = plan.elements().collect();
                let after = of(&edit::move_elements(&plan, &elements, way).unwrap());
                assert_eq!(before.len(), after.len());
                for (a, b) in before.iter().zip(&after) {
                    assert!(b.hashes().contains(&a.hash()), "{name}: {a:?} {b:?}");
                }
            }
        }
    }
}
