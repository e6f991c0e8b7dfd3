//! The rule of docs/editing.md, on random houses and random edits: what was not picked is not harmed.

use std::collections::BTreeSet;

use enfilade::edit::{self, Array, Part, Reach, WallDrag};
use enfilade::formats::plan_json;
use enfilade::geometry::{Point, Segment, Transform, Vector, polygon};
use enfilade::plan::{CornerId, ElementId, History, OpeningId, OpeningKind, Place, Plan, Room, RoomId, WallId};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

use super::support::{area_m2, config, points, rectangle};

/// A house: a rectangle or an L, divided by walls, with doors and windows.
#[derive(Clone, Debug)]
struct House {
    is_l: bool,
    cuts: Vec<(bool, i32, i32)>,
    openings: Vec<(usize, f64, f64, bool)>,
}

fn house() -> impl Strategy<Value = House> {
    let cut = (any::<bool>(), 1..11_i32, 1..8_i32);
    let opening = (0usize..1000, 0.0..1.0, 0.6..1.6, any::<bool>());
    (any::<bool>(), proptest::collection::vec(cut, 0..6), proptest::collection::vec(opening, 0..8))
        .prop_map(|(is_l, cuts, openings)| House { is_l, cuts, openings })
}

impl House {
    fn plan(&self) -> Plan {
        let outline = match self.is_l {
            false => rectangle(0., 0., 12., 9.),
            true => points(&[(0., 0.), (12., 0.), (12., 5.), (7., 5.), (7., 9.), (0., 9.)]),
        };
        let (mut plan, _) = edit::draw_room(&Plan::default(), &outline, Some(0.3)).unwrap();
        for &(is_upright, x, y) in &self.cuts {
            // Across the room that is there.
            let (x, y) = (f64::from(x), f64::from(y) + 0.5);
            let shapes = enfilade::topology::RoomShapes::new(&plan);
            let Some(&room) = shapes.at(Point::new(x + 0.2, y)).first() else { continue };
            let (id, bounds) = (shapes.all()[room].id, shapes.all()[room].bounds);
            let path = match is_upright {
                true => [Point::new(x, bounds.min.y - 0.1), Point::new(x, bounds.max.y + 0.1)],
                false => [Point::new(bounds.min.x - 0.1, y), Point::new(bounds.max.x + 0.1, y)],
            };
            if let Ok((next, _)) = edit::split_room_by(&plan, id, &path, Some(0.1)) {
                plan = next;
            }
        }
        for &(wall, at, width_m, is_window) in &self.openings {
            let walls: Vec<Segment> = plan.walls().filter_map(|(_, wall)| plan.wall_segment(wall)).collect();
            let segment = walls[wall % walls.len()];
            let kind = if is_window { OpeningKind::Window } else { OpeningKind::Door };
            let at = segment.a.lerp(segment.b, at);
            if let Ok((next, _)) = edit::place_opening(&plan, kind, at, width_m, 0.01, Some(at)) {
                plan = next;
            }
        }
        plan
    }
}

/// An edit with indices instead of ids: they pick among what the plan then has.
#[derive(Clone, Debug)]
enum Step {
    Transform(Vec<usize>, Transform, bool),
    Copy(Vec<usize>, Transform),
    Array(Vec<usize>, usize, Vector),
    Delete(Vec<usize>),
    DragWall(usize, f64, Reach),
    DragCorner(usize, Vector),
    Split(usize, bool, f64, bool),
    CutOut(usize, f64, bool),
    Merge(usize, usize),
}

fn transform() -> impl Strategy<Value = Transform> {
    let place = || (0..13_i32, 0..10_i32).prop_map(|(x, y)| Point::new(f64::from(x), f64::from(y)));
    let anywhere = || (0.0..12.0, 0.0..9.0).prop_map(|(x, y)| Point::new(x, y));
    prop_oneof![
        3 => (-6..7_i32, -6..7_i32).prop_map(|(x, y)| Transform::translation(Vector::new(f64::from(x), f64::from(y)))),
        1 => (-3.0..3.0, -3.0..3.0).prop_map(|(x, y)| Transform::translation(Vector::new(x, y))),
        1 => (place(), 1..4_i32).prop_map(|(at, turns)| Transform::rotation(at, f64::from(turns) * std::f64::consts::FRAC_PI_2)),
        1 => (anywhere(), -3.0..3.0).prop_map(|(at, angle)| Transform::rotation(at, angle)),
        2 => (place(), any::<bool>()).prop_map(|(at, is_upright)| {
            let way = if is_upright { Vector::new(0.0, 1.0) } else { Vector::new(1.0, 0.0) };
            Transform::reflection(at, at + way).unwrap()
        }),
        1 => (anywhere(), anywhere()).prop_map(|(a, b)| Transform::reflection(a, b).unwrap_or(Transform::IDENTITY)),
        1 => (anywhere(), 0.3..2.0).prop_map(|(at, factor)| Transform::scaling(at, factor)),
    ]
}

fn step() -> impl Strategy<Value = Step> {
    let index = || 0usize..1000;
    let some = || proptest::collection::vec(0usize..1000, 1..4);
    let way = || (-4.0..4.0, -4.0..4.0).prop_map(|(x, y)| Vector::new(x, y));
    prop_oneof![
        4 => (some(), transform(), any::<bool>()).prop_map(|(which, how, walls)| Step::Transform(which, how, walls)),
        3 => (some(), transform()).prop_map(|(which, how)| Step::Copy(which, how)),
        1 => (some(), 2usize..4, way()).prop_map(|(which, columns, step)| Step::Array(which, columns, step)),
        2 => some().prop_map(Step::Delete),
        4 => (index(), -3.0..3.0, any::<bool>())
            .prop_map(|(i, by, run)| Step::DragWall(i, by, if run { Reach::Run } else { Reach::Piece })),
        2 => (index(), way()).prop_map(|(i, by)| Step::DragCorner(i, by)),
        2 => (index(), any::<bool>(), 0.1..0.9, any::<bool>()).prop_map(|(i, up, at, walls)| Step::Split(i, up, at, walls)),
        1 => (index(), 0.1..0.4, any::<bool>()).prop_map(|(i, size, walls)| Step::CutOut(i, size, walls)),
        1 => (index(), index()).prop_map(|(i, j)| Step::Merge(i, j)),
    ]
}

/// What an edit was about.
struct Done {
    after: Plan,
    /// What was picked, with all that belongs to it.
    picked: BTreeSet<ElementId>,
    /// The corners dragged.
    dragged: BTreeSet<CornerId>,
    /// Where something came to be: in the plan after.
    made: BTreeSet<ElementId>,
}

impl Done {
    fn new(after: Plan) -> Self {
        let (picked, dragged, made) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
        Self { after, picked, dragged, made }
    }
}

fn pick<T: Copy>(all: &[T], index: usize) -> Option<T> {
    (!all.is_empty()).then(|| all[index % all.len()])
}

/// The elements of a part.
fn elements_of(part: &Part) -> BTreeSet<ElementId> {
    let rooms = part.rooms.iter().map(|&id| ElementId::Room(id));
    let walls = part.walls.iter().map(|&id| ElementId::Wall(id));
    rooms.chain(walls).chain(part.openings.iter().map(|&id| ElementId::Opening(id))).collect()
}

/// What a step does; `None` where there is nothing to apply it to or it was refused.
fn done(plan: &Plan, step: &Step) -> Option<Done> {
    let corners: Vec<CornerId> = plan.corners().map(|(id, _)| id).collect();
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).collect();
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    // Rooms and walls, half of either.
    let some = |which: &[usize]| -> BTreeSet<ElementId> {
        let one = |&i: &usize| match i % 3 {
            0 => pick(&walls, i / 3).map(ElementId::Wall),
            _ => pick(&rooms, i / 3).map(ElementId::Room),
        };
        which.iter().filter_map(one).collect()
    };
    let own = |picked: &BTreeSet<ElementId>| -> BTreeSet<ElementId> {
        Part::of(plan, picked).map(|part| elements_of(&part)).unwrap_or_default()
    };
    let of = |after: Plan, picked: BTreeSet<ElementId>| {
        let made = picked.clone();
        Done { picked, made, ..Done::new(after) }
    };
    let added = |after: Plan, made: BTreeSet<ElementId>| Done { made, ..Done::new(after) };
    match step {
        Step::Transform(which, how, own_walls) => {
            let picked = some(which);
            let after = edit::transform_elements(plan, &picked, *how, *own_walls).ok()?.plan;
            Some(of(after, own(&picked)))
        }
        Step::Copy(which, how) => {
            let (after, made) = edit::copy_elements(plan, &some(which), *how).ok()?;
            Some(added(after, made))
        }
        Step::Array(which, columns, step) => {
            let (column_step, row_step) = (Vector::new(step.x, 0.0), Vector::new(0.0, step.y));
            let array = Array::Grid { columns: *columns, rows: 2, column_step, row_step };
            let (after, made) = edit::array(plan, &some(which), array).ok()?;
            Some(added(after, made))
        }
        Step::Delete(which) => {
            let picked: Vec<ElementId> = some(which).into_iter().collect();
            let gone = edit::removed_with(plan, &picked);
            Some(of(edit::remove(plan, &picked).ok()?, gone))
        }
        Step::DragWall(i, by_m, reach) => {
            let id = pick(&walls, *i)?;
            let across = plan.wall_segment(plan.wall(id)?)?.vector().left().unit()?;
            let drag = WallDrag::new(plan, &[id].into(), &BTreeSet::new(), *reach)?;
            let by = across * ((by_m * 20.0).round() / 20.0);
            let after = drag.apply(plan, by).ok()?.plan;
            let mut dragged: BTreeSet<CornerId> = drag.targets(by).into_iter().map(|(corner, _)| corner).collect();
            let wall = plan.wall(id)?;
            dragged.extend([wall.from, wall.to]);
            Some(Done { dragged, ..Done::new(after) })
        }
        Step::DragCorner(i, by) => {
            let id = pick(&corners, *i)?;
            let after = edit::drag_corners(plan, &[(id, plan.position(id)? + *by)]).ok()?.plan;
            Some(Done { dragged: [id].into(), ..Done::new(after) })
        }
        Step::Split(i, is_upright, at, with_walls) => {
            let id = pick(&rooms, *i)?;
            let bounds = polygon::bounds(&plan.ring_points(&plan.room(id)?.outer));
            let middle = bounds.min.lerp(bounds.max, *at);
            let path = match is_upright {
                true => [Point::new(middle.x, bounds.min.y - 0.1), Point::new(middle.x, bounds.max.y + 0.1)],
                false => [Point::new(bounds.min.x - 0.1, middle.y), Point::new(bounds.max.x + 0.1, middle.y)],
            };
            let (after, _) = edit::split_room_by(plan, id, &path, with_walls.then_some(0.1)).ok()?;
            Some(of(after, [ElementId::Room(id)].into()))
        }
        Step::CutOut(i, size, with_walls) => {
            let id = pick(&rooms, *i)?;
            let bounds = polygon::bounds(&plan.ring_points(&plan.room(id)?.outer));
            let (a, b) = (bounds.min.lerp(bounds.max, 0.5 - size / 2.0), bounds.min.lerp(bounds.max, 0.5 + size / 2.0));
            let after = edit::cut_out_by(plan, id, &rectangle(a.x, a.y, b.x, b.y), with_walls.then_some(0.1)).ok()?;
            Some(of(after, [ElementId::Room(id)].into()))
        }
        Step::Merge(i, j) => {
            let both = [pick(&rooms, *i)?, pick(&rooms, *j)?];
            let after = edit::merge_rooms(plan, &both).ok()?;
            // The rings of each, the outer one first.
            let rings = |plan: &Plan| -> Vec<Vec<Vec<Point>>> {
                let rooms = both.iter().filter_map(|&id| plan.room(id));
                rooms.map(|room| room.rings().map(|ring| plan.ring_points(ring)).collect()).collect()
            };
            let (were, merged) = (rings(plan), rings(&after));
            // What lies between them goes, with all of a wall that does so in part; what lies within one of them stays.
            let between = |at: Point| {
                let is_in =
                    |rooms: &[Vec<Vec<Point>>], by_m: f64| rooms.iter().any(|rings| is_deep_in(rings, at, by_m));
                is_in(&merged, 1e-4) && !is_in(&were, 1e-3)
            };
            // As do openings that join the two, which rooms on top of each other may have anywhere.
            let gone = plan.elements().filter(|&element| !after.has(element));
            let gone = gone.filter(|element| !matches!(element, ElementId::Wall(_)));
            let goes = |&id: &WallId| {
                let segment = plan.wall_segment(plan.wall(id).unwrap()).unwrap();
                SHARES.iter().any(|&share| between(segment.a.lerp(segment.b, share)))
            };
            let goes: Vec<ElementId> = walls.iter().copied().filter(goes).map(ElementId::Wall).collect();
            let picked: BTreeSet<ElementId> = both.into_iter().map(ElementId::Room).chain(gone).chain(goes).collect();
            Some(of(after, picked))
        }
    }
}

/// The lines of an element.
fn lines(plan: &Plan, element: ElementId) -> Vec<Segment> {
    match element {
        ElementId::Corner(id) => plan.position(id).map(|at| Segment::new(at, at)).into_iter().collect(),
        ElementId::Wall(id) => plan.wall(id).and_then(|wall| plan.wall_segment(wall)).into_iter().collect(),
        ElementId::Opening(id) => plan.opening(id).and_then(|it| plan.opening_segment(it)).into_iter().collect(),
        ElementId::Room(id) => {
            let rings = plan.room(id).into_iter().flat_map(Room::rings).map(|ring| plan.ring_points(ring));
            rings.flat_map(|ring| polygon::edges(&ring).collect::<Vec<_>>()).collect()
        }
        // They follow whatever they measure: the session's part, with tests of its own.
        ElementId::Dimension(_) => Vec::new(),
    }
}

fn apart_m(p: Segment, q: Segment) -> f64 {
    if enfilade::geometry::segments::crossing(p, q).is_some() {
        return 0.0;
    }
    [p.distance(q.a), p.distance(q.b), q.distance(p.a), q.distance(p.b)].into_iter().fold(f64::INFINITY, f64::min)
}

/// Less than this is rounding, or corners joined where they touch, in metres.
const SAME_M: f64 = 2.5e-3;

/// Whether a point lies in a room with these rings, further from its edges than this, in metres.
fn is_deep_in(rings: &[Vec<Point>], at: Point, by_m: f64) -> bool {
    let is_in = |ring: &[Point]| polygon::locate_in_ring(ring, at) == polygon::Location::Inside;
    rings.iter().enumerate().all(|(i, ring)| is_in(ring) == (i == 0))
        && rings.iter().flat_map(|ring| polygon::edges(ring)).all(|edge| edge.distance(at) > by_m)
}

/// Where along a wall it is looked at.
const SHARES: [f64; 5] = [0.01, 0.25, 0.5, 0.75, 0.99];

/// Walls that lie on each other for more than a centimetre.
fn doubled(plan: &Plan) -> BTreeSet<[WallId; 2]> {
    let walls: Vec<(WallId, Segment)> =
        plan.walls().filter_map(|(id, wall)| Some((id, plan.wall_segment(wall)?))).collect();
    let mut found = BTreeSet::new();
    for (i, &(p, one)) in walls.iter().enumerate() {
        let Some(along) = one.vector().unit() else { continue };
        for &(q, other) in &walls[i + 1..] {
            let [a, b] = [other.a, other.b].map(|end| (end - one.a).dot(along));
            let shared_m = a.max(b).min(one.length()) - a.min(b).max(0.0);
            let aside = |point: Point| (point - one.a).cross(along).abs();
            if shared_m > 0.01 && aside(other.a).max(aside(other.b)) <= 2e-4 {
                found.insert([p, q]);
            }
        }
    }
    found
}

/// How far a corner of one of two boundaries is from the other, at most, in metres.
fn boundaries_apart_m(before: &Plan, old: &Room, after: &Plan, new: &Room) -> f64 {
    let edges = |plan: &Plan, room: &Room| -> Vec<Segment> {
        room.rings().flat_map(|ring| polygon::edges(&plan.ring_points(ring)).collect::<Vec<_>>()).collect()
    };
    let (was, is) = (edges(before, old), edges(after, new));
    let off_m = |from: &[Segment], to: &[Segment]| {
        let apart_m = |at: Point| to.iter().map(|edge| edge.distance(at)).fold(f64::INFINITY, f64::min);
        from.iter().map(|edge| apart_m(edge.a)).fold(0.0, f64::max)
    };
    off_m(&was, &is).max(off_m(&is, &was))
}

/// An element as bytes would hold it: with the places of its corners.
fn as_written(plan: &Plan, element: ElementId) -> String {
    let at = |id: &CornerId| format!("{id} {:?}", plan.corner(*id));
    match element {
        ElementId::Corner(id) => at(&id),
        ElementId::Wall(id) => {
            plan.wall(id).map(|it| format!("{it:?} {} {}", at(&it.from), at(&it.to))).unwrap_or_default()
        }
        ElementId::Room(id) => {
            let room = plan.room(id);
            let corners = room.into_iter().flat_map(Room::rings).flat_map(|ring| ring.iter()).map(at);
            format!("{room:?} {:?}", corners.collect::<Vec<_>>())
        }
        ElementId::Opening(id) => {
            let opening = plan.opening(id);
            let ends = opening.map(|it| match it.place {
                Place::Hosted { from, to, .. } => format!("{} {}", at(&from), at(&to)),
                Place::Free { .. } => String::new(),
            });
            format!("{opening:?} {ends:?}")
        }
        ElementId::Dimension(id) => format!("{:?}", plan.dimension(id)),
    }
}

/// Holds the rule for one edit.
fn holds(before: &Plan, done: &Done) -> Result<(), TestCaseError> {
    let Done { after, picked, dragged, made } = done;
    let violations = after.violations();
    prop_assert!(violations.is_empty(), "{violations:?}");
    let doubled_now: Vec<[WallId; 2]> = doubled(after).difference(&doubled(before)).copied().collect();
    let at = |ids: &[WallId; 2]| ids.map(|id| after.wall(id).and_then(|wall| after.wall_segment(wall)));
    let places: Vec<_> = doubled_now.iter().map(at).collect();
    prop_assert!(doubled_now.is_empty() || !doubled(before).is_empty(), "walls lie on each other: {places:?}");
    let is_dragged = |corners: &[CornerId]| corners.iter().any(|corner| dragged.contains(corner));
    let has_dragged = |element: ElementId| match element {
        ElementId::Corner(id) => is_dragged(&[id]),
        ElementId::Wall(id) => before.wall(id).is_some_and(|wall| is_dragged(&[wall.from, wall.to])),
        ElementId::Room(id) => before.room(id).is_some_and(|room| room.rings().any(|ring| is_dragged(ring))),
        ElementId::Opening(id) => before.opening(id).is_some_and(|it| match it.place {
            Place::Hosted { from, to, .. } => is_dragged(&[from, to]),
            Place::Free { .. } => false,
        }),
        ElementId::Dimension(_) => false,
    };
    // What the edit was about, before and after: what touches none of it is the same.
    let mut about: Vec<Segment> = picked.iter().flat_map(|&element| lines(before, element)).collect();
    about.extend(made.iter().flat_map(|&element| lines(after, element)));
    for element in before.elements().filter(|&element| has_dragged(element)) {
        about.extend(lines(before, element));
        about.extend(lines(after, element));
    }
    let moved = |id: &CornerId| before.position(*id) != after.position(*id);
    for element in after.elements().filter(|&element| !before.has(element)) {
        about.extend(lines(after, element));
    }
    let touches = |element: ElementId| {
        let own = lines(before, element);
        own.iter().any(|&line| about.iter().any(|&other| apart_m(line, other) <= 2.0 * SAME_M))
    };
    let hosts: BTreeSet<OpeningId> = before
        .openings()
        .filter(|(_, opening)| match opening.place {
            // On an edge of what is picked: that is touched, wherever the opening is on it.
            Place::Hosted { from, to, .. } => about.iter().any(|&line| {
                let edge = before.position(from).zip(before.position(to)).map(|(a, b)| Segment::new(a, b));
                edge.is_some_and(|edge| apart_m(edge, line) <= 2.0 * SAME_M)
            }),
            Place::Free { .. } => false,
        })
        .map(|(id, _)| id)
        .collect();
    for element in before.elements() {
        if picked.contains(&element) || has_dragged(element) {
            continue;
        }
        let is_host_touched = matches!(element, ElementId::Opening(id) if hosts.contains(&id));
        if !touches(element) && !is_host_touched {
            prop_assert_eq!(as_written(before, element), as_written(after, element), "{} is not touched", element);
        }
        match element {
            // Whatever moves a corner of something that is not picked is a drag of that corner.
            ElementId::Corner(id) => {
                let is_of = |plan: &Plan, id: CornerId, element: ElementId| match element {
                    ElementId::Wall(wall) => plan.wall(wall).is_some_and(|wall| [wall.from, wall.to].contains(&id)),
                    ElementId::Room(room) => {
                        plan.room(room).is_some_and(|room| room.rings().any(|ring| ring.contains(&id)))
                    }
                    _ => false,
                };
                let others = before.elements().filter(|element| !picked.contains(element));
                if !others.into_iter().any(|element| is_of(before, id, element)) {
                    continue;
                }
                prop_assert!(after.corner(id).is_none() || !moved(&id), "the corner {} moved", id);
            }
            ElementId::Room(id) => {
                let (old, new) = (before.room(id).unwrap(), after.room(id));
                prop_assert!(new.is_some(), "the room {} is gone", id);
                let new = new.unwrap();
                let (was_m2, is_m2) = (area_m2(before, old), area_m2(after, new));
                prop_assert!((was_m2 - is_m2).abs() < 0.01, "{}: {} -> {} m²", id, was_m2, is_m2);
                let off_m = boundaries_apart_m(before, old, after, new);
                prop_assert!(off_m <= 2.0 * SAME_M, "the boundary of {} is {} m off", id, off_m);
            }
            ElementId::Wall(id) => {
                let wall = before.wall(id).unwrap();
                let segment = before.wall_segment(wall).unwrap();
                for share in SHARES {
                    let at = segment.a.lerp(segment.b, share);
                    let stands = after.walls().any(|(_, other)| {
                        after.wall_segment(other).is_some_and(|it| it.distance(at) <= SAME_M)
                            && other.thickness_m == wall.thickness_m
                    });
                    prop_assert!(stands, "the wall {} no longer stands at {:?}", id, at);
                }
            }
            ElementId::Opening(id) => {
                let (old, new) = (before.opening(id).unwrap(), after.opening(id));
                prop_assert!(new.is_some(), "the opening {} is gone", id);
                let (was, is) = (before.opening_segment(old).unwrap(), after.opening_segment(new.unwrap()).unwrap());
                let off_m = was.a.distance(is.a).max(was.b.distance(is.b));
                // Where what is dragged divides its wall just there, it is moved to fit.
                let is_divided = !dragged.is_empty()
                    && after.corners().any(|(corner, _)| {
                        let is_new = before.corner(corner).is_none() || moved(&corner);
                        let at = after.position(corner).unwrap();
                        (is_new || is_dragged(&[corner])) && was.distance(at) <= SAME_M
                    });
                // Or its wall no longer reaches as far.
                let edges = || {
                    let hosts = after.elements().filter(|it| matches!(it, ElementId::Wall(_) | ElementId::Room(_)));
                    hosts.flat_map(|element| lines(after, element)).collect::<Vec<_>>()
                };
                let is_divided = is_divided
                    || !dragged.is_empty() && off_m > SAME_M && {
                        let edges = edges();
                        let stands = |at: Point| edges.iter().any(|edge| edge.distance(at) <= SAME_M);
                        !SHARES.iter().all(|&share| stands(was.a.lerp(was.b, share)))
                    };
                // Or it makes way for a neighbour that is.
                let makes_way = || {
                    before.openings().filter(|(other, _)| *other != id).any(|(other, old)| {
                        let places = before
                            .opening_segment(old)
                            .zip(after.opening(other).and_then(|new| after.opening_segment(new)));
                        places.is_some_and(|(old, new)| old.a.distance(new.a) > SAME_M && apart_m(new, was) <= SAME_M)
                    })
                };
                let makes_way = !dragged.is_empty() && off_m > SAME_M && makes_way();
                prop_assert!(off_m <= SAME_M || is_divided || makes_way, "the opening {} went {} m", id, off_m);
            }
            ElementId::Dimension(_) => {}
        }
    }
    // What was dragged stays whole: rooms do not cross themselves, and openings stand within their walls.
    for (id, room) in after.rooms().filter(|(id, _)| has_dragged(ElementId::Room(*id))) {
        let is_simple = |plan: &Plan, room: &Room| {
            room.rings().all(|ring| enfilade::geometry::path::is_simple_ring(&plan.ring_points(ring)))
        };
        let was_simple = before.room(id).is_some_and(|old| is_simple(before, old));
        prop_assert!(!was_simple || is_simple(after, room), "the room {} crosses itself", id);
    }
    for (id, opening) in after.openings().filter(|(id, _)| has_dragged(ElementId::Opening(*id))) {
        let fits = |plan: &Plan, place: Place| {
            let Place::Hosted { from, to, at_m, width_m } = place else { return true };
            let length_m = plan.position(from).unwrap().distance(plan.position(to).unwrap());
            at_m - width_m / 2.0 >= -SAME_M && at_m + width_m / 2.0 <= length_m + SAME_M
        };
        let fitted = before.opening(id).is_some_and(|old| fits(before, old.place));
        prop_assert!(!fitted || fits(after, opening.place), "the opening {} reaches beyond its wall", id);
    }
    Ok(())
}

proptest! {
    #![proptest_config(config(128))]

    #[test]
    fn nothing_that_was_not_picked_is_harmed(house in house(), steps in proptest::collection::vec(step(), 1..8)) {
        let mut history = History::new("House", house.plan());
        let mut written = vec![plan_json::to_bytes(history.plan())];
        for step in &steps {
            let Some(done) = done(history.plan(), step) else { continue };
            holds(history.plan(), &done).map_err(|error| TestCaseError::fail(format!("{step:?}: {error}")))?;
            if done.after != *history.plan() {
                history.push("step", done.after);
                written.push(plan_json::to_bytes(history.plan()));
            }
        }
        while let Some(bytes) = written.pop() {
            prop_assert!(plan_json::to_bytes(history.plan()) == bytes, "undo gives other bytes");
            history.undo();
        }
    }
}
