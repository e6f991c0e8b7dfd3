//! The scans from which six real office floors were traced, as backdrops of the traced plans.

use std::path::{Path, PathBuf};

use enfilade::edit::{self, DrawingMoves, set_measurements};
use enfilade::formats::read_file;
use enfilade::geometry::{Point, Segment, polygon};
use enfilade::plan::{Backdrop, Plan};
use enfilade::store::pictures::{LoadedPicture, load_picture, relative_path};

/// The picture's file, and how many of its pixels a unit of the file of the same name is; `None`: as
/// many as make the picture a thousand units wide.
const SCANS: [(&str, Option<f64>); 6] = [
    ("AtlanticSuites.jpg", None),
    ("ED21.png", Some(2.768)),
    ("OfficePlan.jpg", None),
    ("floorplanMAIN.png", None),
    ("magenta.jpg", None),
    ("poli.png", None),
];

fn data() -> Option<PathBuf> {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    if data.join("images").is_dir() {
        return Some(data.to_owned());
    }
    println!("skipped: {} is not there", data.display());
    None
}

/// A plan on which nothing is drawn, with the picture under it at the scale of the plan that was traced
/// from it, which is given too.
fn ready_to_trace(data: &Path, name: &str, px_per_unit: Option<f64>) -> (Plan, Plan, LoadedPicture) {
    let path = data.join("images").join(name);
    let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
    let truth = read_file(&data.join("authors/office").join(format!("{stem}.xml"))).unwrap().plans.remove(0);
    let picture = load_picture(&path, 1).unwrap();
    let [width, _] = picture.levels.size_px().map(f64::from);
    let px_per_unit = px_per_unit.unwrap_or(width / 1000.0);
    let metres_per_unit = truth.meta().scale.metres_per_unit.unwrap();
    let backdrop = Backdrop::new(relative_path(&path, None), picture.content_hash.clone());
    // The picture's width, as a person who knows the scale would measure it.
    let [from, to] = [0.0, width].map(|x| backdrop.plan_from_picture(Point::new(x, 0.0)));
    let length_m = width / px_per_unit * metres_per_unit;
    let measured = backdrop.measurement(from, to, length_m).unwrap();
    let plan = edit::set_backdrop(&Plan::default(), Some(backdrop));
    (set_measurements(&plan, vec![measured], DrawingMoves::Along).unwrap(), truth, picture)
}

/// How dark the picture is along the rooms' boundaries moved by a vector, 0 to 1: the darkest pixel
/// within 3 of each place.
fn darkness(plan: &Plan, truth: &Plan, picture: &LoadedPicture, moved: [f64; 2]) -> f64 {
    let backdrop = plan.backdrop().unwrap();
    let level = &picture.levels.all()[0];
    let mut sum = 0.0;
    let mut count = 0.0;
    for (_, room) in truth.rooms() {
        let ring = truth.ring_points(&room.outer);
        for Segment { a, b } in polygon::edges(&ring) {
            for step in 1..8 {
                let at = backdrop.picture_from_plan(a.lerp(b, f64::from(step) / 8.0));
                let (x, y) = ((at.x + moved[0]).round() as i64, (at.y + moved[1]).round() as i64);
                let near = (-3..=3).flat_map(|dx| (-3..=3).map(move |dy| (x + dx, y + dy)));
                let darkest = near
                    .map(|(x, y)| level.pixel(x, y))
                    // What is transparent lies on white paper.
                    .map(|[r, g, b, a]| 255.0 - f64::from(a) / 255.0 * (255.0 - f64::from(r.min(g).min(b))))
                    .fold(255.0, f64::min);
                sum += 1.0 - darkest / 255.0;
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn the_scans_lie_right_under_the_plans_traced_from_them() {
    let Some(data) = data() else { return };
    for (name, px_per_unit) in SCANS {
        let (plan, truth, picture) = ready_to_trace(&data, name, px_per_unit);
        let backdrop = plan.backdrop().unwrap();
        let [width, height] = picture.levels.size_px().map(f64::from);
        // Every corner that was traced lies on the picture.
        for (_, corner) in truth.corners() {
            let at = backdrop.picture_from_plan(corner.position);
            assert!((-1.0..=width + 1.0).contains(&at.x) && (-1.0..=height + 1.0).contains(&at.y), "{name}: {at:?}");
        }
        let here = darkness(&plan, &truth, &picture, [0.0, 0.0]);
        let away = [[25.0, 0.0], [-25.0, 0.0], [0.0, 25.0], [0.0, -25.0]];
        let elsewhere = away.map(|moved| darkness(&plan, &truth, &picture, moved)).into_iter().fold(0.0, f64::max);
        println!("{name}: boundaries are {here:.2} dark, {elsewhere:.2} at most 25 pixels away");
        assert!(here > elsewhere + 0.03, "{name}: {here} here, {elsewhere} elsewhere");
    }
}
