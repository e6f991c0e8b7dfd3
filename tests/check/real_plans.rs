//! The real plans: no check may be noisy on them, and none may panic.

use std::collections::BTreeMap;
use std::path::Path;

use enfilade::check::{Finding, Severity};
use enfilade::formats::{is_plan_file_name, read_file};

/// For each kind of finding, the number of plans of a folder that have it, and the number of plans.
fn plans_by_kind(folder: &str) -> Option<(BTreeMap<&'static str, usize>, usize)> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")).join(folder);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: {} is absent", folder.display());
        return None;
    };
    let mut by_kind = BTreeMap::new();
    let mut plans = 0;
    for entry in entries {
        let path = entry.unwrap().path();
        if !is_plan_file_name(&path.file_name().unwrap().to_string_lossy()) {
            continue;
        }
        for plan in read_file(&path).unwrap().plans {
            plans += 1;
            let found = super::findings(&plan);
            // Every finding that names a place names one in the plan.
            for at in found.iter().filter_map(|finding| finding.place().at) {
                assert!(plan.bounds().inflated(1.0).contains(at), "{}: {at:?}", path.display());
            }
            for kind in super::kinds(&plan).into_keys() {
                *by_kind.entry(kind).or_default() += 1;
            }
        }
    }
    Some((by_kind, plans))
}

/// Folders of real plans.
const FOLDERS: [&str; 4] = ["authors/school", "authors/office", "houses/r2v", "houses/archilyse"];

#[test]
fn no_check_fires_on_every_real_plan() {
    let mut total = 0;
    for folder in FOLDERS {
        let Some((by_kind, plans)) = plans_by_kind(folder) else { continue };
        total += plans;
        for kind in Finding::KINDS {
            let fired = by_kind.get(kind.name).copied().unwrap_or(0);
            // A handful of storeys can all have the same fault.
            assert!(plans < 10 || 4 * fired <= 3 * plans, "{}: {fired} of {plans} plans in {folder}", kind.name);
            // Errors are rare: they make a folder's check fail.
            assert!(
                plans < 100 || kind.severity != Severity::Error || 20 * fired <= plans,
                "{}: {fired} of {plans} plans in {folder}",
                kind.name
            );
        }
    }
    println!("{total} real plans checked");
}

#[test]
fn the_bundled_plans_have_no_findings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("plans");
    let mut plans = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if is_plan_file_name(&path.file_name().unwrap().to_string_lossy()) {
            for plan in read_file(&path).unwrap().plans {
                plans += 1;
                assert_eq!(super::findings(&plan), Vec::new(), "{}", path.display());
            }
        }
    }
    assert!(plans >= 3, "{plans} bundled plans");
}
