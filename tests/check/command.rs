//! The subcommand: its wording, its JSON, its exit codes.

use super::golden::assert_golden;
use crate::support;

/// Runs `enfilade check` and gives its exit code, stdout and stderr.
fn enfilade_check(arguments: &[&str]) -> (u8, String, String) {
    support::enfilade(["check"].iter().chain(arguments))
}

const FLAT: &str = "tests/check/flat.plan.json";
const SPOILED: &str = "tests/check/spoiled.plan.json";
const NO_PLAN: &str = "tests/check/no_plan.json";

#[test]
fn a_sound_plan_gives_no_findings() {
    let (code, out, err) = enfilade_check(&[FLAT]);
    assert_eq!((code, err.as_str()), (0, ""));
    assert_golden("flat.txt", &out);
}

#[test]
fn a_spoiled_plan_is_listed_for_people_and_for_machines() {
    let (code, out, err) = enfilade_check(&[FLAT, SPOILED]);
    assert_eq!((code, err.as_str()), (1, ""));
    assert_golden("spoiled.txt", &out);
    let (code, all, _) = enfilade_check(&[SPOILED, "--all", "--least", "warning"]);
    assert_eq!(code, 1);
    assert_golden("spoiled.all.txt", &all);
    let (code, json, err) = enfilade_check(&[FLAT, SPOILED, "--json"]);
    assert_eq!((code, err.as_str()), (1, ""));
    assert_golden("spoiled.json", &json);
}

#[test]
fn an_unreadable_file_does_not_stop_the_others() {
    let (code, out, err) = enfilade_check(&[NO_PLAN, FLAT]);
    assert_eq!(code, 1);
    assert!(err.contains(NO_PLAN), "{err}");
    assert!(out.contains("1 plan checked") && out.contains("1 file unreadable"), "{out}");
    let (code, json, err) = enfilade_check(&[NO_PLAN, FLAT, "--json"]);
    assert_eq!((code, err.as_str()), (1, ""));
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(report["files"][0]["error"].is_string(), "{json}");
    assert_eq!(report["totals"]["unreadable"], 1);
    assert_eq!(report["files"][1]["plans"][0]["rooms"], 5);
}

#[test]
fn warnings_fail_only_when_asked() {
    let warned = "tests/check/warned.plan.json";
    assert_eq!(enfilade_check(&[warned]).0, 0);
    assert_eq!(enfilade_check(&[warned, "--strict"]).0, 1);
    // What is not shown does not count.
    assert_eq!(enfilade_check(&[warned, "--strict", "--least", "error"]).0, 0);
}

#[test]
fn a_wrong_call_is_2() {
    assert_eq!(enfilade_check(&[]).0, 2);
    assert_eq!(enfilade_check(&[FLAT, "--least", "disaster"]).0, 2);
    assert_eq!(enfilade_check(&["--help"]).0, 0);
}

#[test]
fn what_the_plan_ignores_is_told_and_counts_nowhere() {
    use enfilade::check::check;
    use enfilade::edit::ignore::ignore_finding;
    use enfilade::features::{NeighbourLabels, analyse};
    use enfilade::formats::{plan_json, read_file};
    use enfilade::labels::Schemes;
    let schemes = Schemes::bundled();
    let mut plan = read_file(std::path::Path::new(SPOILED)).unwrap().plans.remove(0);
    let found = check(&plan, &analyse(&plan, &schemes, NeighbourLabels::True), &schemes);
    let errors = found.iter().filter(|finding| finding.severity() == enfilade::check::Severity::Error).count();
    assert!(errors > 0 && found.len() > errors);
    for finding in &found {
        plan = ignore_finding(&plan, finding.as_ignored("as the survey says")).unwrap();
    }
    // The file keeps it, byte for byte.
    let bytes = plan_json::to_bytes(&plan);
    assert_eq!(plan_json::to_bytes(&plan_json::from_bytes(&bytes).unwrap()), bytes);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("spoiled.plan.json");
    enfilade::store::save_bytes(&file, &bytes).unwrap();
    let (code, out, _) = enfilade_check(&[file.to_str().unwrap(), "--strict", "--all"]);
    assert_eq!(code, 0, "{out}");
    assert!(out.contains("0 errors, 0 warnings, 0 remarks"), "{out}");
    assert!(out.contains(&format!("; {} findings ignored", found.len())), "{out}");
    assert_eq!(out.matches("(because: as the survey says)").count(), found.len(), "{out}");
    let (_, json, _) = enfilade_check(&[file.to_str().unwrap(), "--json"]);
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    let told = &report["files"][0]["plans"][0];
    assert_eq!(told["findings"].as_array().unwrap().len(), 0);
    assert_eq!(told["ignored"].as_array().unwrap().len(), found.len());
    assert_eq!(told["ignored"][0]["reason"], "as the survey says");
    assert_eq!(report["totals"]["ignored"], found.len());
}
