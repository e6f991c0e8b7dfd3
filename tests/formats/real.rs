//! The dwellings of `../shared/data/houses`, if available.

use std::path::PathBuf;

use enfilade::formats::{geojson, plan_json};
use enfilade::labels::Schemes;
use enfilade::plan::{OpeningKind, ScaleOrigin};

use super::geojson::{features, kept, read, written};

/// Folder of the real dwellings; `None`, with a word, where they are absent.
pub fn houses() -> Option<PathBuf> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/houses"));
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: no real dwellings at ../shared/data/houses");
    None
}

pub fn files(folder: &str) -> Vec<PathBuf> {
    let Some(houses) = houses() else { return Vec::new() };
    let entries = std::fs::read_dir(houses.join(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

#[test]
fn all_dwellings_arrive_whole_and_round_trip() {
    if houses().is_none() {
        return;
    }
    let schemes = Schemes::bundled();
    let (mut rooms, mut openings, mut windows, mut pinned, mut notes) = (0, 0, 0, 0, 0);
    let mut scales = [0; 2];
    for path in files("r2v").into_iter().chain(files("archilyse")) {
        let import =
            geojson::from_bytes(&std::fs::read(&path).unwrap(), "").map_err(|error| error.to_string()).unwrap();
        let plan = &import.plans[0];
        notes += import.notes.len();
        rooms += plan.rooms().len();
        openings += plan.openings().len();
        windows += plan.openings().filter(|(_, opening)| opening.kind == OpeningKind::Window).count();
        pinned += plan.openings().filter(|(_, opening)| opening.pinned.is_some()).count();
        scales[usize::from(plan.meta().scale.origin == ScaleOrigin::Measured)] += 1;
        assert_eq!(plan.meta().typology.as_ref().map(ToString::to_string).as_deref(), Some("house"));
        assert!(!plan.meta().building.is_empty());

        let bytes = plan_json::to_bytes(plan);
        let loaded = plan_json::from_bytes(&bytes).map_err(|error| error.to_string()).unwrap();
        assert_eq!(&loaded, plan, "{}", path.display());
        assert_eq!(plan_json::to_bytes(&loaded), bytes, "{}", path.display());

        let geojson = geojson::to_bytes(plan, &schemes);
        let again = read(std::str::from_utf8(&geojson).unwrap());
        assert_eq!(&again.plans[0], plan, "{}", path.display());
        assert_eq!(again.notes, []);
        assert_eq!(written(&again.plans[0]).into_bytes(), geojson, "{}", path.display());
        assert_eq!(kept(&again.plans[0]), kept(plan));
        assert_eq!(features(&again.plans[0]), features(plan), "{}", path.display());
    }
    assert_eq!((rooms, openings, windows, pinned, notes), (5355, 6469, 973, 6469, 0));
    assert_eq!(scales, [607, 4], "estimated and measured scales");
}
