//! Door leaves: where they open to, and that nothing is in the way.

use enfilade::features::RoomStatus;
use enfilade::geometry::{Point, Segment, Vector, polygon::Location};
use enfilade::labels::{Label, Schemes};
use enfilade::plan::{LeafSide, Opening, OpeningId, OpeningKind, Plan};
use enfilade::topology::{RoomShape, RoomShapes};

use super::plans;

/// What a leaf sweeps: a convex quarter disc as points, the hinge first.
struct Leaf {
    opening: OpeningId,
    host: Segment,
    points: Vec<Point>,
}

/// Where the leaves of a door open to, as a unit vector.
fn opens_along(opening: &Opening, segment: Segment) -> Vector {
    let left = segment.vector().left().unit().unwrap();
    match opening.swing.expect("every door of ours says how it opens").side {
        LeafSide::Left => left,
        LeafSide::Right => -left,
    }
}

fn leaves(plan: &Plan) -> Vec<Leaf> {
    let mut leaves = Vec::new();
    for (id, opening) in plan.openings() {
        let host = plan.opening_segment(opening).unwrap();
        let mut sweep = |hinge: Point, towards: Point| {
            let closed = towards - hinge;
            let open = opens_along(opening, host) * closed.length();
            let arc = (0..=12).map(|i| {
                let angle_rad = f64::from(i) / 12.0 * std::f64::consts::FRAC_PI_2;
                hinge + closed * angle_rad.cos() + open * angle_rad.sin()
            });
            let points = std::iter::once(hinge).chain(arc).collect();
            leaves.push(Leaf { opening: id, host, points });
        };
        match opening.kind {
            OpeningKind::Door if opening.swing.expect("a swing").hinge_at_start => sweep(host.a, host.b),
            OpeningKind::Door => sweep(host.b, host.a),
            OpeningKind::DoubleDoor => {
                sweep(host.a, host.midpoint());
                sweep(host.b, host.midpoint());
            }
            OpeningKind::Passage | OpeningKind::Window => assert_eq!(opening.swing, None),
        }
    }
    leaves
}

/// Whether two convex shapes overlap by more than a millimetre: no line separates them (separating
/// axis theorem).
fn overlap(p: &[Point], q: &[Point]) -> bool {
    let normals = |points: &[Point]| -> Vec<Vector> {
        (0..points.len()).filter_map(|i| (points[(i + 1) % points.len()] - points[i]).left().unit()).collect()
    };
    normals(p).into_iter().chain(normals(q)).all(|normal| {
        let range = |points: &[Point]| {
            points
                .iter()
                .map(|&point| (point - Point::default()).dot(normal))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), along| (least.min(along), most.max(along)))
        };
        let ((p_least, p_most), (q_least, q_most)) = (range(p), range(q));
        p_most.min(q_most) - p_least.max(q_least) > 1e-3
    })
}

/// A wall's body as a rectangle that reaches round its corners.
fn body(centre_line: Segment, thickness_m: f64) -> [Point; 4] {
    let along = centre_line.vector().unit().unwrap() * (thickness_m / 2.0);
    let across = along.left();
    let (a, b) = (centre_line.a + -along, centre_line.b + along);
    [a + across, a + -across, b + -across, b + across]
}

#[test]
fn leaves_do_not_collide() {
    for (file, plan) in plans() {
        let leaves = leaves(&plan);
        assert!(leaves.len() > 10, "{file}");
        for (i, leaf) in leaves.iter().enumerate() {
            for other in &leaves[i + 1..] {
                assert!(
                    !overlap(&leaf.points, &other.points),
                    "{file}: the leaves of {} and {} collide",
                    leaf.opening,
                    other.opening
                );
            }
            let along = leaf.host.vector().unit().unwrap();
            for (id, wall) in plan.walls() {
                let centre_line = plan.wall_segment(wall).unwrap();
                let in_line = centre_line.vector().unit().unwrap().cross(along).abs() < 1e-3
                    && (centre_line.a - leaf.host.a).cross(along).abs() < 1e-3;
                assert!(
                    in_line || !overlap(&leaf.points, &body(centre_line, wall.thickness_m)),
                    "{file}: a leaf of {} hits the wall {id}",
                    leaf.opening
                );
            }
        }
    }
}

/// The room into which a door opens; `None` for the open air, terraces and courts.
fn opens_into<'a>(
    plan: &Plan,
    shapes: &'a RoomShapes,
    schemes: &Schemes,
    segment: Segment,
    along: Vector,
) -> Option<&'a RoomShape> {
    let ahead = segment.midpoint() + along * 0.5;
    let shape = shapes.all().iter().find(|shape| shape.locate(ahead) == Location::Inside)?;
    let status = RoomStatus::of(plan, schemes, plan.room(shape.id).unwrap());
    (status != RoomStatus::NotClassified).then_some(shape)
}

#[test]
fn doors_open_as_an_architect_would_have_them() {
    let schemes = Schemes::bundled();
    for (file, plan) in plans() {
        let shapes = RoomShapes::new(&plan);
        for (id, opening) in plan.openings() {
            let segment = plan.opening_segment(opening).unwrap();
            let width_m = segment.length();
            let widths = match opening.kind {
                OpeningKind::Door => 0.8..=1.0,
                OpeningKind::DoubleDoor => 1.6..=1.8,
                OpeningKind::Passage => 1.0..=4.2,
                OpeningKind::Window => 0.6..=3.6,
            };
            assert!(
                (widths.start() - 1e-6..=widths.end() + 1e-6).contains(&width_m),
                "{file}: {id} is {width_m} m wide"
            );
            if opening.swing.is_none() {
                continue;
            }
            let along = opens_along(opening, segment);
            let ahead = opens_into(&plan, &shapes, &schemes, segment, along);
            let behind = opens_into(&plan, &shapes, &schemes, segment, -along);
            if let Some(shape) = ahead {
                let status = RoomStatus::of(&plan, &schemes, plan.room(shape.id).unwrap());
                assert_ne!(status.label(), Some(Label::Corridor), "{file}: {id} opens into a corridor");
            }
            // Exits open in the direction of escape; a dwelling's front door opens inwards.
            if behind.is_none() {
                assert!(file.starts_with("dwelling"), "{file}: the exit {id} opens inwards");
                assert_eq!(ahead.map(|shape| super::name(&plan, shape.id)).as_deref(), Some("Entrance hall"));
            }
        }
    }
}
