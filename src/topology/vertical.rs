//! What joins the storeys of a building: stairs and lifts that lie over each other.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay as _;

use super::RoomShapes;
use crate::geometry::{Point, Transform, Vector, areas, polygon};
use crate::labels::normalised_function;
use crate::plan::{Plan, RoomId};

/// A way from storey to storey.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shaft {
    Stairs,
    Lift,
}

impl Shaft {
    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stairs => "stairs",
            Self::Lift => "lift",
        }
    }

    /// What a room's function says; `None` for another function, such as a staircase's landing or a lift's machine room.
    pub fn of_function(function: &str) -> Option<Self> {
        const STAIRS: [&str; 8] =
            ["stair", "stairs", "staircase", "stairwell", "stairway", "emergency stairs", "fire stairs", "vano scala"];
        const LIFTS: [&str; 6] = ["lift", "lifts", "elevator", "elevators", "elevator shaft", "lift shaft"];
        let function = normalised_function(function);
        if STAIRS.contains(&function.as_str()) {
            Some(Self::Stairs)
        } else if LIFTS.contains(&function.as_str()) {
            Some(Self::Lift)
        } else {
            None
        }
    }
}

/// Stairs or a lift of one storey and those of the next that lie over them: an edge of the building's graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VerticalLink {
    pub shaft: Shaft,
    /// The room in the lower plan and the one in the upper plan.
    pub lower: RoomId,
    pub upper: RoomId,
    /// The area that both cover as a share of the smaller one, above 0, at most 1.
    pub overlap: f64,
}

/// Rooms that share less of the smaller one only touch: walls are that thick, and storeys are drawn one by one.
pub const LEAST_OVERLAP: f64 = 0.25;

/// The links between two storeys with one origin, by the room below. Each room below is joined to all above it: a flight
/// of stairs may end in two rooms.
pub fn vertical_links(lower: &Plan, upper: &Plan) -> Vec<VerticalLink> {
    Shafts::of(lower).links_to(&Shafts::of(upper))
}

/// The stairs and lifts of a storey: what its links follow from.
#[derive(Clone, Debug, Default)]
pub struct Shafts(Vec<Placed>);

impl Shafts {
    /// Those of a plan.
    pub fn of(plan: &Plan) -> Self {
        Self(shafts(plan))
    }

    /// The links to the storey above, as [`vertical_links`].
    pub fn links_to(&self, above: &Self) -> Vec<VerticalLink> {
        let mut links = Vec::new();
        for p in &self.0 {
            for q in above.0.iter().filter(|q| q.shaft == p.shaft) {
                let overlap = shared_m2(&p.outer, &q.outer) / p.area_m2.min(q.area_m2);
                if overlap >= LEAST_OVERLAP {
                    let (shaft, lower, upper) = (p.shaft, p.room, q.room);
                    links.push(VerticalLink { shaft, lower, upper, overlap: overlap.min(1.0) });
                }
            }
        }
        links
    }
}

/// Stairs or a lift of a plan.
#[derive(Clone, Debug)]
struct Placed {
    room: RoomId,
    shaft: Shaft,
    outer: Vec<Point>,
    centre: Point,
    area_m2: f64,
}

fn shafts(plan: &Plan) -> Vec<Placed> {
    let rooms: Vec<(RoomId, Shaft)> =
        plan.rooms().filter_map(|(id, room)| Some((id, Shaft::of_function(&room.function)?))).collect();
    let shapes = RoomShapes::of_rooms(plan, rooms.iter().map(|(id, _)| *id));
    let placed = rooms.into_iter().filter_map(|(room, shaft)| {
        let outer = shapes.all()[shapes.index_of(room)?].outer.clone();
        let area_m2 = polygon::area(&outer, &[[]; 0]);
        let centre = (area_m2 > 0.0).then(|| polygon::centroid(&outer))?;
        Some(Placed { room, shaft, outer, centre, area_m2 })
    });
    placed.collect()
}

fn shared_m2(p: &[Point], q: &[Point]) -> f64 {
    let (p, q) = (vec![areas::ring(p)], vec![areas::ring(q)]);
    areas::area_m2(&p.overlay(&q, OverlayRule::Intersect, FillRule::NonZero))
}

/// Two points of a plan and the points of the storey below that they lie over.
#[derive(Clone, Debug, PartialEq)]
pub struct CommonPoints {
    pub here: [Point; 2],
    pub below: [Point; 2],
    /// How many stairs and lifts then lie over each other, of how many that the storey with fewer of them has.
    pub joined: usize,
    pub of: usize,
}

impl CommonPoints {
    /// The move that brings the first point onto the one below, and turns the second towards its own. Nothing is scaled.
    pub fn transform(&self) -> Transform {
        let ([a, b], [p, q]) = (self.here, self.below);
        let angle = |v: Vector| v.y.atan2(v.x);
        let turn_rad =
            if (b - a).length() < 1e-9 || (q - p).length() < 1e-9 { 0.0 } else { angle(q - p) - angle(b - a) };
        Transform::rotation(a, turn_rad).then(Transform::translation(p - a))
    }

    /// By how much the two distances differ, in metres: what no move brings together.
    pub fn mismatch_m(&self) -> f64 {
        (self.here[0].distance(self.here[1]) - self.below[0].distance(self.below[1])).abs()
    }
}

/// Centres of shafts that lie over each other may be this far apart: they are drawn one by one.
const NEAR_M: f64 = 0.6;

/// Turned by less, a plan is taken as not turned.
const LEAST_TURN_RAD: f64 = 0.02;

/// Points that two storeys probably have in common, by their stairs and lifts: the pair that brings most of them over each
/// other, of those the one that turns the plan least. With one shaft each, the plan is moved and not turned. `None` without
/// a shaft of one kind in both.
pub fn common_points(plan: &Plan, below: &Plan) -> Option<CommonPoints> {
    let (here, under) = (shafts(plan), shafts(below));
    let of = [Shaft::Stairs, Shaft::Lift].into_iter().map(|shaft| {
        let count = |placed: &[Placed]| placed.iter().filter(|it| it.shaft == shaft).count();
        count(&here).min(count(&under))
    });
    let of: usize = of.sum();
    let joined = |transform: Transform| {
        let mut taken = vec![false; under.len()];
        let mut joined = 0;
        for p in &here {
            let centre = transform.point(p.centre);
            let near = under
                .iter()
                .enumerate()
                .filter(|(at, q)| !taken[*at] && q.shaft == p.shaft && q.centre.distance(centre) <= NEAR_M)
                .min_by(|(_, p), (_, q)| p.centre.distance(centre).total_cmp(&q.centre.distance(centre)));
            if let Some((at, _)) = near {
                taken[at] = true;
                joined += 1;
            }
        }
        joined
    };
    let mut best: Option<(usize, i64, i64, CommonPoints)> = None;
    let mut consider = |here: [Point; 2], below: [Point; 2]| {
        let mut points = CommonPoints { here, below, joined: 0, of };
        let transform = points.transform();
        points.joined = joined(transform);
        let turned = transform.vector(Vector::new(1.0, 0.0));
        let turn_rad = turned.y.atan2(turned.x).abs();
        let turn = if turn_rad < LEAST_TURN_RAD { 0 } else { (turn_rad * 1e3) as i64 };
        // The farther apart the points, the less a small error turns the plan.
        let rank = (points.joined, -turn, (points.here[0].distance(points.here[1]) * 1e3) as i64);
        if best.as_ref().is_none_or(|(joined, turn, apart, _)| rank > (*joined, *turn, *apart)) {
            best = Some((rank.0, rank.1, rank.2, points));
        }
    };
    for p in &here {
        for q in under.iter().filter(|q| q.shaft == p.shaft) {
            // Moved only.
            let along = Vector::new(1.0, 0.0);
            consider([p.centre, p.centre + along], [q.centre, q.centre + along]);
            for p2 in here.iter().filter(|p2| p2.room > p.room) {
                for q2 in under.iter().filter(|q2| q2.room != q.room && q2.shaft == p2.shaft) {
                    let (here_m, below_m) = (p.centre.distance(p2.centre), q.centre.distance(q2.centre));
                    if (here_m - below_m).abs() <= NEAR_M && here_m > NEAR_M {
                        consider([p.centre, p2.centre], [q.centre, q2.centre]);
                    }
                }
            }
        }
    }
    best.map(|(_, _, _, points)| points).filter(|points| points.joined > 0)
}
