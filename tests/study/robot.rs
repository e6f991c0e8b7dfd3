//! `enfilade robot-study`: plans in, a report out, the same however it was come by.

#![allow(clippy::disallowed_methods, reason = "a test's files are no user's")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::{PLANS, folder, text_of};
use crate::support::enfilade;

/// Two schools and two houses of three labelled rooms each, of different sizes; one plan a building.
fn plans(folder: &Path) -> PathBuf {
    let plans = folder.join("plans");
    std::fs::create_dir_all(&plans).unwrap();
    for (at, (typology, function)) in
        [("school", "classroom"), ("school", "classroom"), ("house", "bedroom"), ("house", "bedroom")]
            .into_iter()
            .enumerate()
    {
        let (width, deep) = (3.6 + 0.4 * at as f64, 3.0 + 0.3 * at as f64);
        let rectangle = |left: f64, low: f64, right: f64, high: f64| {
            format!("[[[{left},{low}],[{right},{low}],[{right},{high}],[{left},{high}],[{left},{low}]]]")
        };
        let room = |ring: String, function: &str, label: &str| {
            format!(
                r#"{{"type":"Feature","geometry":{{"type":"Polygon","coordinates":{ring}}},"properties":{{"kind":"room","function":"{function}","label":"{label}"}}}}"#
            )
        };
        let door = |middle: f64| {
            let (from, to) = (middle - 0.45, middle + 0.45);
            format!(
                r#"{{"type":"Feature","geometry":{{"type":"LineString","coordinates":[[{from},{deep}],[{to},{deep}]]}},"properties":{{"kind":"opening","opening":"door"}}}}"#
            )
        };
        let features = [
            room(rectangle(0.0, 0.0, width, deep), function, "M"),
            room(rectangle(width, 0.0, 2.0 * width, deep), function, "S"),
            room(rectangle(0.0, deep, 2.0 * width, deep + 1.8), "corridor", "C"),
            door(width / 2.0),
            door(1.5 * width),
        ];
        let text = format!(
            r#"{{"type":"FeatureCollection","units":"m","name":"{typology} {at}","typology":"{typology}","features":[{}]}}"#,
            features.join(",")
        );
        std::fs::write(plans.join(format!("{typology}{at}.geojson")), text).unwrap();
    }
    plans
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    entries
        .map(|path| (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(path).unwrap()))
        .collect()
}

fn study(plans: &Path, output: &Path, more: &[&str]) -> (String, String) {
    let words = ["robot-study", text_of(plans), "-o", text_of(output), "--sensor-noise", "1", "--odometry-noise", "1"];
    let (code, out, err) = enfilade(words.into_iter().chain(["--furniture", "0"]).chain(more.iter().copied()));
    assert_eq!(code, 0, "{out}{err}");
    (out, err)
}

#[test]
fn a_study_is_the_same_on_any_number_of_threads_and_after_it_was_killed() {
    let folder = folder();
    let plans = plans(folder.path());
    let (one, two) = (folder.path().join("one"), folder.path().join("two"));
    let (out, _) = study(&plans, &one, &["--jobs", "1"]);
    assert!(out.contains("## School") && out.contains("| no noise | 2 |"), "{out}");
    let first = files(&one);
    let names: Vec<&str> = first.keys().map(String::as_str).collect();
    assert_eq!(names, ["conditions.csv", "labels.csv", "report.html", "report.json", "report.md", "runs.csv"]);
    let runs = files(&one.join("runs"));
    // No noise and the usual, in four plans.
    assert_eq!(runs.len(), 8);

    // As a study leaves it that was killed: some runs missing, one cut off by a failing disk, no report.
    std::fs::create_dir_all(two.join("runs")).unwrap();
    for (at, (name, bytes)) in runs.iter().enumerate().skip(2) {
        let kept = if at == 2 { &bytes[..bytes.len() / 2] } else { bytes };
        std::fs::write(two.join("runs").join(name), kept).unwrap();
    }
    let (_, err) = study(&plans, &two, &["--jobs", "2", "--force"]);
    assert!(err.contains("5 of 8 runs are kept from an earlier call"), "{err}");
    assert!(first == files(&two));
    assert!(runs == files(&two.join("runs")));

    let report: Value = serde_json::from_slice(&first["report.json"]).unwrap();
    let all = report["conditions"].as_array().unwrap().iter().find(|line| line["set"] == "all").unwrap();
    // Without noise: three rooms and two edges in each of the four.
    assert_eq!((&all["rooms"], &all["found"], &all["true_edges"]), (&12.into(), &12.into(), &8.into()), "{all}");
    let label = |method: &str| {
        let lines = report["labels"].as_array().unwrap();
        lines.iter().find(|line| line["set"] == "all" && line["method"] == method).unwrap().clone()
    };
    for method in ["average", "tree", "joint"] {
        let line = label(method);
        assert_eq!(line["rooms"], 12, "{line}");
        for view in line["own"].as_array().unwrap().iter().chain(line["standard"].as_array().unwrap()) {
            assert!((0.0..=1.0).contains(&view.as_f64().unwrap()), "{line}");
        }
    }
}

#[test]
fn plans_can_teach_without_being_explored() {
    let folder = folder();
    let plans = plans(folder.path());
    let (out, _) = study(&plans, &folder.path().join("few"), &["--most-plans", "1"]);
    assert!(out.contains("2 plans of 2 buildings explored, 4 read; 4 runs"), "{out}");
    // The only plan of a kind: the program's own models are taken, and that is said.
    let alone = folder.path().join("alone");
    let school = plans.join("school0.geojson");
    let (out, _) = study(&school, &alone, &["--learn", text_of(&plans.join("house2.geojson"))]);
    assert!(out.contains("school: no other building to learn from"), "{out}");
}

#[test]
fn what_cannot_be_studied_is_refused() {
    let folder = folder();
    let out = folder.path().join("out");
    for (words, what) in [
        (vec!["--sensor-noise", "1,many"], "0,1,4"),
        (vec!["--furniture", "0.5"], "whole numbers"),
        (vec!["--odometry-noise=-1"], "0 to 100"),
        (vec!["--repeats", "0"], "--repeats"),
    ] {
        let all = ["robot-study", PLANS, "-o", text_of(&out)].into_iter().chain(words);
        let (code, _, err) = enfilade(all);
        assert!(code == 2 && err.contains(what), "{what}: {err}");
    }
    let (code, _, err) = enfilade(["robot-study", text_of(folder.path()), "-o", text_of(&out)]);
    assert!(code == 1 && err.contains("no plan"), "{err}");
}
