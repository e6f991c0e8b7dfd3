//! A four-room house, an L-shaped house and the bundled office, changed as an architect changes them: no room that was not
//! picked changes, `check` finds nothing new that is wrong, and undo gives the same bytes.

use std::collections::BTreeSet;

use enfilade::check::{Finding, Severity, check};
use enfilade::edit::{self, Array, Changed, Reach};
use enfilade::features::{NeighbourLabels, analyse};
use enfilade::formats::plan_json;
use enfilade::geometry::{Point, Transform, Vector};
use enfilade::labels::Schemes;
use enfilade::plan::{ElementId, History, OpeningKind, Plan, RoomId, WallId};

use super::support::{area_m2, points, rectangle};

/// A house being changed.
struct Site {
    history: History,
    written: Vec<Vec<u8>>,
}

impl Site {
    fn new(plan: Plan) -> Self {
        assert_eq!(wrong(&plan), Vec::<String>::new(), "the house itself is sound");
        Self { written: vec![plan_json::to_bytes(&plan)], history: History::new("House", plan) }
    }

    fn plan(&self) -> &Plan {
        self.history.plan()
    }

    /// Does an edit; rooms other than these keep their areas.
    fn edit(&mut self, what: &str, picked: &[RoomId], change: impl FnOnce(&Plan) -> Plan) {
        let before = self.plan().clone();
        let after = change(&before);
        assert_eq!(after.violations(), [], "{what}");
        for (id, room) in before.rooms().filter(|(id, _)| !picked.contains(id)) {
            let now = after.room(id).unwrap_or_else(|| panic!("{what}: the room {} is gone", room.name));
            let off_m2 = (area_m2(&before, room) - area_m2(&after, now)).abs();
            assert!(off_m2 < 0.01, "{what}: the room {} changes by {off_m2} m²", room.name);
        }
        assert_eq!(wrong(&after), Vec::<String>::new(), "{what}");
        self.history.push(what, after);
        self.written.push(plan_json::to_bytes(self.plan()));
    }

    /// Undoes everything, to the same bytes.
    fn undo_all(mut self) {
        while let Some(bytes) = self.written.pop() {
            assert!(plan_json::to_bytes(self.plan()) == bytes, "undo gives other bytes");
            self.history.undo();
        }
    }

    fn room(&self, name: &str) -> RoomId {
        self.plan().rooms().find(|(_, room)| room.name == name).unwrap_or_else(|| panic!("no room {name}")).0
    }

    /// The wall whose middle is nearest to a place.
    fn wall_at(&self, x: f64, y: f64) -> WallId {
        let plan = self.plan();
        let off = |id: WallId| plan.wall_segment(plan.wall(id).unwrap()).unwrap().distance(Point::new(x, y));
        plan.walls().map(|(id, _)| id).min_by(|&p, &q| off(p).total_cmp(&off(q))).unwrap()
    }
}

/// What `check` says is wrong, but for what depends on what rooms are for.
fn wrong(plan: &Plan) -> Vec<String> {
    let schemes = Schemes::bundled();
    let findings = check(plan, &analyse(plan, &schemes, NeighbourLabels::default()), &schemes);
    let is_drawn = |finding: &&Finding| {
        finding.severity() >= Severity::Warning
            && !["plan_has_no_typology", "room_has_no_function"].contains(&finding.kind().name)
    };
    findings.iter().filter(is_drawn).map(ToString::to_string).collect()
}

fn door(plan: &Plan, x: f64, y: f64) -> Plan {
    edit::place_opening(plan, OpeningKind::Door, Point::new(x, y), 0.9, 0.3, None).unwrap().0
}

fn window(plan: &Plan, x: f64, y: f64) -> Plan {
    edit::place_opening(plan, OpeningKind::Window, Point::new(x, y), 1.2, 0.3, None).unwrap().0
}

/// Names rooms by points in them.
fn named(mut plan: Plan, names: &[(&str, f64, f64)]) -> Plan {
    for &(name, x, y) in names {
        let shapes = enfilade::topology::RoomShapes::new(&plan);
        let id = shapes.all()[shapes.at(Point::new(x, y))[0]].id;
        plan = edit::set_name(&plan, id, name).unwrap();
    }
    plan
}

/// A house of 10 by 8 m, four rooms, doors in the partitions and a window each.
fn four_rooms() -> Plan {
    let (plan, _) = edit::draw_room(&Plan::default(), &rectangle(0., 0., 10., 8.), Some(0.3)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(6., 0.), (6., 8.)]), Some(0.1)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(0., 5.), (6., 5.)]), Some(0.1)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(6., 3.), (10., 3.)]), Some(0.1)).unwrap();
    let plan = [(6., 4.), (3., 5.), (8., 3.), (6., 7.), (0., 2.)].iter().fold(plan, |plan, &(x, y)| door(&plan, x, y));
    let plan = [(3., 0.), (8., 0.), (8., 8.), (2., 8.)].iter().fold(plan, |plan, &(x, y)| window(&plan, x, y));
    named(plan, &[("living", 1., 1.), ("kitchen", 1., 7.), ("bath", 9., 1.), ("bed", 9., 7.)])
}

/// An L of 12 by 10 m with five rooms.
fn l_house() -> Plan {
    let outline = points(&[(0., 0.), (12., 0.), (12., 4.), (5., 4.), (5., 10.), (0., 10.)]);
    let (plan, _) = edit::draw_room(&Plan::default(), &outline, Some(0.24)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(0., 4.), (5., 4.)]), Some(0.12)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(5., 0.), (5., 4.)]), Some(0.12)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(8.5, 0.), (8.5, 4.)]), Some(0.12)).unwrap();
    let (plan, _) = edit::split_rooms(&plan, &points(&[(0., 7.), (5., 7.)]), Some(0.12)).unwrap();
    let plan =
        [(5., 2.), (8.5, 2.), (2.5, 4.), (2.5, 7.), (0., 2.)].iter().fold(plan, |plan, &(x, y)| door(&plan, x, y));
    let plan = [(7., 0.), (10., 4.), (0., 5.5), (2., 10.)].iter().fold(plan, |plan, &(x, y)| window(&plan, x, y));
    named(plan, &[("entrance", 1., 1.), ("one", 7., 1.), ("two", 11., 1.), ("three", 1., 5.), ("four", 1., 9.)])
}

fn moved(changed: Result<Changed, edit::EditError>) -> Plan {
    changed.unwrap().plan
}

fn one(element: ElementId) -> BTreeSet<ElementId> {
    [element].into()
}

#[test]
fn a_four_room_house_is_changed() {
    let mut site = Site::new(four_rooms());
    let [living, kitchen, bath, bed] = ["living", "kitchen", "bath", "bed"].map(|name| site.room(name));
    let of = |id: RoomId| one(ElementId::Room(id));
    // Mirrored about its own middle, and back: its door stays with the partition, the house stays whole.
    let middle = Point::new(8., 1.5);
    let upright = Transform::reflection(middle, middle + Vector::new(0.0, 1.0)).unwrap();
    site.edit("mirror the bath", &[bath], |plan| moved(edit::transform_elements(plan, &of(bath), upright, true)));
    assert_eq!(site.plan().walls().len(), 13, "no wall is doubled");
    let turn = Transform::rotation(middle, std::f64::consts::PI);
    site.edit("turn the bath", &[bath], |plan| moved(edit::transform_elements(plan, &of(bath), turn, true)));
    // The partition between left and right is three pieces: they move as one, and the doors in it with them.
    let piece = site.wall_at(6., 1.);
    let all = [living, kitchen, bath, bed];
    let by = Vector::new(0.5, 0.0);
    let drag = |plan: &Plan, by: Vector, reach: Reach| {
        moved(edit::move_picked(plan, &one(ElementId::Wall(piece)), by, reach, true))
    };
    site.edit("move the partition", &all, |plan| drag(plan, by, Reach::Run));
    let areas =
        |site: &Site| all.map(|id| (area_m2(site.plan(), site.plan().room(id).unwrap()) * 100.0).round() / 100.0);
    assert_eq!(areas(&site), [32.5, 19.5, 10.5, 17.5]);
    site.edit("move it back", &all, |plan| drag(plan, -by, Reach::Run));
    site.edit("move a piece of it", &[living, bath], |plan| drag(plan, Vector::new(-0.5, 0.0), Reach::Piece));
    assert_eq!(areas(&site), [28.5, 18.0, 13.5, 20.0]);
    site.edit("and back", &[living, bath], |plan| drag(plan, Vector::new(0.5, 0.0), Reach::Piece));
    assert_eq!(areas(&site), [30.0, 18.0, 12.0, 20.0]);
    // A wider door.
    let door = site.plan().openings().find(|(_, it)| it.kind == OpeningKind::Door).unwrap().0;
    site.edit("widen a door", &[], |plan| edit::resize_opening(plan, door, 1.0).unwrap());
    // Without the wall between kitchen and living, and as one room.
    let wall = site.wall_at(1., 5.);
    let before = site.plan().clone();
    let without = edit::remove(&before, &[ElementId::Wall(wall)]).unwrap();
    assert_eq!(without.openings().len() + 1, before.openings().len(), "its door goes with it");
    let rooms = edit::rooms_joined_by(&before, &without, &[ElementId::Wall(wall)]).unwrap();
    assert_eq!(BTreeSet::from(rooms), BTreeSet::from([living, kitchen]));
    site.edit("merge the rooms", &rooms, |_| edit::merge_rooms(&without, &rooms).unwrap());
    site.undo_all();
}

#[test]
fn copies_of_houses_stand_beside_them() {
    for house in [four_rooms(), l_house()] {
        let mut site = Site::new(house);
        let rooms: BTreeSet<ElementId> = site.plan().rooms().map(|(id, _)| ElementId::Room(id)).collect();
        let bounds = site.plan().bounds();
        let facade = Point::new(bounds.max.x, 0.0);
        let across = Transform::reflection(facade, facade + Vector::new(0.0, 1.0)).unwrap();
        let unnamed = |plan: Plan, before: &Plan| {
            let new: Vec<RoomId> = plan.rooms().map(|(id, _)| id).filter(|&id| before.room(id).is_none()).collect();
            new.iter().enumerate().fold(plan, |plan, (i, &id)| edit::set_name(&plan, id, &format!("copy {i}")).unwrap())
        };
        site.edit("mirror a copy across the facade", &[], |plan| {
            unnamed(edit::copy_elements(plan, &rooms, across).unwrap().0, plan)
        });
        let column_step = Vector::new(4.0 * bounds.width(), 0.0);
        let row_step = Vector::new(0.0, bounds.height() + 3.0);
        site.edit("an array of houses", &[], |plan| {
            let array = Array::Grid { columns: 2, rows: 2, column_step, row_step };
            unnamed(edit::array(plan, &rooms, array).unwrap().0, &Plan::default())
        });
        site.undo_all();
    }
}

#[test]
fn a_pasted_room_that_is_deleted_leaves_nothing_behind() {
    let plan = l_house();
    let mut site = Site::new(plan.clone());
    let four = site.room("four");
    let mut made = BTreeSet::new();
    // Against the facade, its corners in the middle of the walls there.
    site.edit("paste", &[], |plan| {
        let by = Transform::translation(Vector::new(-5.0, -1.3));
        let (next, placed) = edit::copy_elements(plan, &one(ElementId::Room(four)), by).unwrap();
        made = placed;
        let copy = made.iter().find_map(|one| if let ElementId::Room(id) = one { Some(*id) } else { None }).unwrap();
        edit::set_name(&next, copy, "pasted").unwrap()
    });
    assert!(site.plan().walls().len() > plan.walls().len());
    site.edit("delete", &[site.room("pasted")], |plan| {
        edit::remove(plan, &made.iter().copied().collect::<Vec<_>>()).unwrap()
    });
    assert_eq!(site.plan().walls().len(), plan.walls().len());
    assert_eq!(site.plan().corners().len(), plan.corners().len());
    assert!(plan_json::to_bytes(site.plan()) == plan_json::to_bytes(&plan), "the facade is as it was");
    site.undo_all();
}

#[test]
fn rooms_of_the_bundled_office_are_changed_alone() {
    let (_, plan) =
        enfilade::store::bundled_plans().unwrap().iter().find(|(name, _)| name.starts_with("office")).cloned().unwrap();
    let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
    let middle =
        |id: RoomId| enfilade::geometry::polygon::bounds(&plan.ring_points(&plan.room(id).unwrap().outer)).center();
    for &id in rooms.iter().step_by(3) {
        let about = middle(id);
        let ways = [
            Transform::reflection(about, about + Vector::new(0.0, 1.0)).unwrap(),
            Transform::rotation(about, std::f64::consts::FRAC_PI_2),
            Transform::scaling(about, 0.7),
            Transform::translation(Vector::new(200.0, 0.0)),
        ];
        for way in ways {
            let after = edit::move_elements(&plan, &one(ElementId::Room(id)), way).unwrap();
            assert_eq!(after.violations(), []);
            for (other, room) in plan.rooms().filter(|(other, _)| *other != id) {
                let off_m2 = (area_m2(&plan, room) - area_m2(&after, after.room(other).unwrap())).abs();
                assert!(off_m2 < 0.01, "{}: {off_m2} m²", room.name);
            }
        }
    }
    // Partitions: every tenth wall, by a hand's breadth, as far as nothing is in the way.
    let walls: Vec<WallId> = plan.walls().map(|(id, _)| id).collect();
    let mut dragged = 0;
    for &id in walls.iter().step_by(10) {
        let Some(across) = plan.wall_segment(plan.wall(id).unwrap()).unwrap().vector().left().unit() else { continue };
        for reach in [Reach::Run, Reach::Piece] {
            let Ok(changed) = edit::move_picked(&plan, &one(ElementId::Wall(id)), across * 0.1, reach, true) else {
                continue;
            };
            dragged += 1;
            assert_eq!(changed.plan.violations(), []);
            for (opening, it) in plan.openings() {
                assert!(changed.plan.opening(opening).is_some(), "{} is gone", it.kind.name());
            }
        }
    }
    assert!(walls.is_empty() || dragged > 0);
}

/// The bundled office traced anew over a picture of it, 25 pixels a metre: its rooms by their corners, one after the
/// other where no room is yet, with walls; then its doors and windows.
fn traced_office() -> Plan {
    const PIXEL_M: f64 = 0.04;
    let (_, office) =
        enfilade::store::bundled_plans().unwrap().iter().find(|(name, _)| name.starts_with("office")).cloned().unwrap();
    let pixel = |at: Point| Point::new((at.x / PIXEL_M).round() * PIXEL_M, (at.y / PIXEL_M).round() * PIXEL_M);
    let mut plan = Plan::default();
    // Small ones first: what lies within another is left out of that.
    let mut rooms: Vec<_> = office.rooms().map(|(_, room)| (area_m2(&office, room), room)).collect();
    rooms.sort_by(|p, q| p.0.total_cmp(&q.0));
    for (_, room) in rooms {
        let clicked: Vec<Point> = office.ring_points(&room.outer).into_iter().map(pixel).collect();
        let drawn = edit::draw_room_in_free_space(&plan, &clicked, Some(0.12), edit::GAP_BETWEEN_ROOMS_M).unwrap();
        plan = edit::set_name(&drawn.plan, drawn.rooms[0], &room.name).unwrap();
        assert_eq!(drawn.rooms.len(), 1, "{}", room.name);
    }
    for (_, opening) in office.openings() {
        let segment = office.opening_segment(opening).unwrap();
        let at = pixel(segment.midpoint());
        plan = edit::place_opening(&plan, opening.kind, at, segment.length(), 0.3, Some(at)).unwrap().0;
    }
    plan
}

/// The rooms that a drag of corners concerns.
fn rooms_at(plan: &Plan, corners: &BTreeSet<enfilade::plan::CornerId>) -> Vec<RoomId> {
    let has = |room: &enfilade::plan::Room| room.rings().any(|ring| ring.iter().any(|id| corners.contains(id)));
    plan.rooms().filter(|(_, room)| has(room)).map(|(id, _)| id).collect()
}

#[test]
fn a_traced_office_is_changed() {
    let mut site = Site::new(traced_office());
    assert!(site.plan().rooms().len() >= 39 && site.plan().openings().len() >= 78);
    // Rectangular rooms, mirrored and turned by half where they are: nothing else notices.
    let rooms: Vec<RoomId> = site.plan().rooms().map(|(id, _)| id).collect();
    let mut turned = 0;
    for &id in &rooms {
        let room = site.plan().room(id).unwrap();
        let bounds = enfilade::geometry::polygon::bounds(&site.plan().ring_points(&room.outer));
        if area_m2(site.plan(), room) < bounds.width() * bounds.height() - 1e-6 || turned == 5 {
            continue;
        }
        turned += 1;
        let (name, about) = (room.name.clone(), bounds.center());
        let upright = Transform::reflection(about, about + Vector::new(0.0, 1.0)).unwrap();
        let half = Transform::rotation(about, std::f64::consts::PI);
        for way in [upright, half] {
            site.edit(&format!("turn {name}"), &[id], |plan| {
                moved(edit::transform_elements(plan, &one(ElementId::Room(id)), way, true))
            });
        }
    }
    assert_eq!(turned, 5);
    // Partitions, by a hand's breadth: as a run, and one piece of it, and back.
    let (mut runs, mut pieces) = (0, 0);
    let walls: Vec<WallId> = site.plan().walls().map(|(id, _)| id).collect();
    for &id in walls.iter().step_by(11) {
        for reach in [Reach::Run, Reach::Piece] {
            let plan = site.plan();
            let Some(segment) = plan.wall(id).and_then(|wall| plan.wall_segment(wall)) else { continue };
            let by = segment.vector().left().unit().unwrap() * 0.1;
            let drag = edit::WallDrag::new(plan, &[id].into(), &BTreeSet::new(), reach).unwrap();
            let Ok(changed) = drag.apply(plan, by) else { continue };
            // A jog beside a door may narrow a neighbour's; a drag that does is left.
            if !wrong(&changed.plan).is_empty() {
                continue;
            }
            let wall = plan.wall(id).unwrap();
            let mut corners: BTreeSet<_> = drag.targets(by).into_iter().map(|(id, _)| id).collect();
            corners.extend([wall.from, wall.to]);
            let picked = rooms_at(plan, &corners);
            if reach == Reach::Run {
                runs += 1
            } else {
                pieces += 1
            };
            site.edit(&format!("drag {id}"), &picked, |_| changed.plan);
            let before = site.plan().clone();
            if let Ok(back) = edit::move_picked(&before, &one(ElementId::Wall(id)), -by, reach, true)
                && wrong(&back.plan).is_empty()
            {
                site.edit(&format!("drag {id} back"), &picked, |_| back.plan);
            }
        }
    }
    assert!(runs >= 5 && pieces >= 4, "{runs} runs, {pieces} pieces");
    // Doors, wider by a hand's breadth.
    let doors: Vec<_> =
        site.plan().openings().filter(|(_, it)| it.kind == OpeningKind::Door).map(|(id, _)| id).collect();
    let mut widened = 0;
    for &id in doors.iter().step_by(5) {
        let Some([before, behind]) = edit::beside_opening(site.plan(), id) else { continue };
        if before.distance_m < 0.1 || behind.distance_m < 0.1 {
            continue;
        }
        widened += 1;
        let width_m = site.plan().opening_segment(site.plan().opening(id).unwrap()).unwrap().length() + 0.1;
        site.edit("widen a door", &[], |plan| edit::resize_opening(plan, id, width_m).unwrap());
    }
    assert!(widened >= 3, "{widened} doors");
    // Walls between two rooms, deleted, and the rooms merged.
    let mut merged = 0;
    for id in walls.iter().step_by(9).copied() {
        let before = site.plan().clone();
        if before.wall(id).is_none() {
            continue;
        }
        let without = edit::remove(&before, &[ElementId::Wall(id)]).unwrap();
        let Some(rooms) = edit::rooms_joined_by(&before, &without, &[ElementId::Wall(id)]) else { continue };
        let Ok(one) = edit::merge_rooms(&without, &rooms) else { continue };
        merged += 1;
        site.edit("delete a wall and merge", &rooms, |_| {
            let stays = rooms.iter().copied().find(|&id| one.room(id).is_some()).unwrap();
            edit::set_name(&one, stays, &format!("merged {merged}")).unwrap()
        });
        if merged == 3 {
            break;
        }
    }
    assert!(merged >= 3, "{merged} merged");
    // A mirrored copy of all across the facade, and an array of two beside that.
    let all: BTreeSet<ElementId> = site.plan().rooms().map(|(id, _)| ElementId::Room(id)).collect();
    let bounds = site.plan().bounds();
    let renamed = |plan: Plan, before: &Plan| {
        let new: Vec<RoomId> = plan.rooms().map(|(id, _)| id).filter(|&id| before.room(id).is_none()).collect();
        new.iter().enumerate().fold(plan, |plan, (i, &id)| edit::set_name(&plan, id, &format!("copy {i}")).unwrap())
    };
    let facade = Point::new(bounds.max.x, 0.0);
    let across = Transform::reflection(facade, facade + Vector::new(0.0, 1.0)).unwrap();
    site.edit("mirror a copy across the facade", &[], |plan| {
        renamed(edit::copy_elements(plan, &all, across).unwrap().0, plan)
    });
    let (column_step, row_step) = (Vector::new(0.0, 0.0), Vector::new(0.0, bounds.height() + 5.0));
    site.edit("an array", &[], |plan| {
        let array = Array::Grid { columns: 1, rows: 2, column_step, row_step };
        renamed(edit::array(plan, &all, array).unwrap().0, plan)
    });
    site.undo_all();
}
