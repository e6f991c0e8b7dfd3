//! Edits on real plans: drawn rooms with overlaps and gaps of centimetres.

use std::path::{Path, PathBuf};

use enfilade::edit;
use enfilade::edit::{cut_out, draw_room_in_free_space, draw_walls, merge_rooms, split_room};
use enfilade::geometry::{Point, Transform, Vector, polygon};
use enfilade::plan::{ElementId, OpeningKind, Plan, RoomId};

use super::support::{area_m2, total_area};

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data");

fn files(folder: &str, extension: &str, limit: usize) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(Path::new(DATA).join(folder)) else {
        println!("skipped: {DATA}/{folder} is not there");
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|found| found == extension));
    files.sort();
    let step = (files.len() / limit.max(1)).max(1);
    files.into_iter().step_by(step).collect()
}

fn plans() -> Vec<(PathBuf, Plan)> {
    let scale: usize = std::env::var("ENFILADE_REAL_PLANS").ok().and_then(|n| n.parse().ok()).unwrap_or(4);
    let mut paths = files("authors/office", "xml", scale);
    paths.extend(files("authors/school", "xml", scale));
    paths.extend(files("houses/r2v", "geojson", 3 * scale));
    let mut plans = Vec::new();
    for path in paths {
        let Ok(read) = enfilade::formats::read_file(&path) else { continue };
        plans.extend(read.plans.into_iter().map(|plan| (path.clone(), plan)));
    }
    plans
}

#[test]
fn edits_keep_the_invariants_of_real_plans() {
    for (path, plan) in plans() {
        let name = path.display();
        let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
        let bounds = plan.bounds();
        let across = [bounds.min, bounds.max].map(|p| Point::new(p.x, bounds.center().y));
        let drawn = draw_walls(&plan, &[across[0], across[1]], 0.1).unwrap();
        assert_eq!(drawn.plan.violations(), [], "{name}: a wall across");
        assert!((total_area(&drawn.plan) - total_area(&plan)).abs() < 0.002 * total_area(&plan) + 0.1, "{name}");
        for weld_m in [0.01, 0.05] {
            if let Ok(weld) = edit::weld(&plan, weld_m) {
                assert_eq!(weld.plan.violations(), [], "{name}: weld {weld_m}");
            }
        }
        if let Ok(squared) = edit::square_up(&plan, None, 0.05) {
            assert_eq!(squared.violations(), [], "{name}: square up");
        }
        let all: std::collections::BTreeSet<ElementId> = rooms.iter().map(|&id| ElementId::Room(id)).collect();
        if let Ok((copied, _)) = edit::copy_elements(&plan, &all, Transform::translation(Vector::new(0.37, 0.11))) {
            assert_eq!(copied.violations(), [], "{name}: a copy across itself");
        }
        for (i, &id) in rooms.iter().enumerate().step_by(7) {
            let Some(room) = plan.room(id).filter(|room| room.outer.len() >= 3) else { continue };
            let ring = plan.ring_points(&room.outer);
            let (box_, center) = (polygon::bounds(&ring), polygon::bounds(&ring).center());
            let path = [Point::new(center.x, box_.min.y - 0.1), Point::new(center.x, box_.max.y + 0.1)];
            if let Ok((split, new)) = split_room(&plan, id, &path) {
                assert_eq!(split.violations(), [], "{name}: split {i}");
                let mut parts = vec![id];
                parts.extend(&new);
                let total: f64 = parts.iter().map(|&part| area_m2(&split, split.room(part).unwrap())).sum();
                assert!((total - area_m2(&plan, room)).abs() < 0.02 * total + 0.01, "{name}: split {i}: {total}");
                let merged = merge_rooms(&split, &parts).unwrap();
                assert_eq!(merged.violations(), [], "{name}: merge {i}");
                let area = area_m2(&merged, merged.room(id).or(merged.room(new[0])).unwrap());
                assert!((area - total).abs() < 0.01 * total + 0.01, "{name}: merge {i}: {area} {total}");
            }
            if let Ok(cut) =
                cut_out(&plan, id, &[center, Point::new(center.x + 1., center.y), Point::new(center.x, center.y + 1.)])
            {
                assert_eq!(cut.violations(), [], "{name}: cut {i}");
            }
            if let Ok((with_door, _)) = edit::place_opening(&plan, OpeningKind::Door, ring[0], 0.9, 0.5, Some(center)) {
                assert_eq!(with_door.violations(), [], "{name}: a door {i}");
            }
        }
    }
}

#[test]
fn a_room_taken_out_of_a_real_plan_is_drawn_back_with_generous_strokes() {
    let (mut drawn, mut close) = (0, 0);
    let mut worst: Vec<(f64, String)> = Vec::new();
    for (path, plan) in plans() {
        let rooms: Vec<RoomId> = plan.rooms().map(|(id, _)| id).collect();
        for id in rooms {
            let Some(room) = plan.room(id).filter(|room| room.outer.len() >= 3 && room.holes.is_empty()) else {
                continue;
            };
            let truth = area_m2(&plan, room);
            // A rectangle inside its walls' line, grown by half a wall: it overlaps all neighbours.
            let ring = plan.ring_points(&room.outer);
            let bounds = polygon::bounds(&ring);
            if truth < 4.0 || truth < 0.98 * bounds.width() * bounds.height() {
                continue;
            }
            let generous = bounds.inflated(0.1);
            let (p, q) = (generous.min, generous.max);
            let stroke = [p, Point::new(q.x, p.y), q, Point::new(p.x, q.y)];
            let without = edit::remove(&plan, &[ElementId::Room(id)]).unwrap();
            let Ok(drawn_again) = draw_room_in_free_space(&without, &stroke, None, 0.3) else { continue };
            let (next, new) = (drawn_again.plan, drawn_again.rooms[0]);
            assert_eq!(next.violations(), [], "{}", path.display());
            let area = area_m2(&next, next.room(new).unwrap());
            drawn += 1;
            let off = area / truth - 1.0;
            // Grown by 0.1 m all round where nothing is beside it; rooms that overlapped take their share.
            let grown = generous.width() * generous.height() / truth - 1.0;
            if off > -0.1 && off <= grown + 1e-3 {
                close += 1;
            } else {
                worst.push((off, format!("{} {id} {truth:.1} m²: {area:.1} m²", path.display())));
            }
        }
    }
    worst.sort_by(|p, q| p.0.total_cmp(&q.0));
    println!("{close} of {drawn} rooms drawn back; worst {:?}", &worst[..worst.len().min(5)]);
    assert!(drawn == 0 || close * 100 >= drawn * 95, "{close} of {drawn}: {:?}", &worst[..worst.len().min(20)]);
}
