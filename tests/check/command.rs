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
