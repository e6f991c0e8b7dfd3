//! The subcommands that learn and predict: evaluate, train, models, classify. Real plans in, reports,
//! models and words out.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod repeats;
mod robot;
mod suspects;

use std::path::{Path, PathBuf};

use enfilade::classify::{
    Method,
    models::{Models, bundled_typologies},
};
use enfilade::edit;
use enfilade::labels::Schemes;
use enfilade::plan::{LabelOrigin, Plan};
use enfilade::store::{bundled_plans, load_plan, save_plan};

use crate::support::{self, enfilade};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/study").join(name)
}

/// A folder that is removed at the end of the test.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn text_of(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn bundled(name: &str) -> Plan {
    bundled_plans().unwrap().into_iter().find(|(file, _)| file.starts_with(name)).unwrap().1
}

const PLANS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/plans");
const REAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/authors");

/// The report on the bundled plans, in a folder of its own.
fn report(arguments: &[&str]) -> tempfile::TempDir {
    let folder = folder();
    let all = [&["evaluate", PLANS, "--folds", "3", "-o", text_of(folder.path())], arguments].concat();
    let (code, _, err) = enfilade(&all);
    assert_eq!(
        (code, err.as_str()),
        (0, "left out 4 rooms:\n     4  not classified (balconies, shafts and the like)\n")
    );
    folder
}

#[test]
fn the_same_seed_gives_the_same_report_on_any_number_of_threads() {
    let (one, four) = (report(&["--threads", "1"]), report(&["--threads", "4"]));
    let mut names: Vec<_> = std::fs::read_dir(one.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names.len(), 18, "{names:?}");
    for name in &names {
        let read = |folder: &tempfile::TempDir| std::fs::read(folder.path().join(name)).unwrap();
        assert!(read(&one) == read(&four), "{name:?} depends on the number of threads");
    }
    let other = report(&["--seed", "2"]);
    let json = |folder: &tempfile::TempDir| std::fs::read(folder.path().join("report.json")).unwrap();
    assert_ne!(json(&one), json(&other), "the seed has no effect");
}

/// Every cell of the paper's tables has its place: sets, algorithms and conditions, own against foreign and
/// standard, curves, importance, and what goes beyond the paper.
#[test]
fn a_report_holds_all_that_was_measured() {
    let folder = report(&[]);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("report.json")).unwrap()).unwrap();
    let length = |member: &str| json[member].as_array().map_or(0, Vec::len);
    // One building a typology: folds by building exist for the standard set alone, and not even for it,
    // since its folds are the typologies' put together.
    assert_eq!(length("sets"), 4);
    assert_eq!(length("accuracy"), 4 * 4 * 3, "sets, algorithms, neighbours' labels");
    assert_eq!((length("averages"), length("confusion"), length("rooms")), (4, 4, 4));
    assert_eq!(length("own_against_standard"), 3 * 5);
    assert_eq!(length("own_against_foreign"), 6 * 5);
    assert_eq!((length("learning_curves"), length("importance")), (16, 16));
    assert_eq!(length("typologies"), 3);
    assert_eq!(length("notes"), 3, "{:?}", json["notes"]);
    for cell in json["accuracy"].as_array().unwrap() {
        let rows: u64 = cell["confusion"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|row| row.as_array().unwrap())
            .map(|n| n.as_u64().unwrap())
            .sum();
        assert_eq!(cell["rooms"].as_u64(), Some(rows), "every room is tested once");
        assert!((0.0..=1.0).contains(&cell["accuracy"].as_f64().unwrap()));
    }
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    for outside in ["src=", "href=", "url(", "http://", "https://"] {
        assert!(!page.contains(outside), "the page needs something outside: {outside}");
    }
    assert!(page.contains("87.8"), "the paper's figure for houses is missing");
}

/// Scores on the authors' schools and offices stay where they were measured; the joint classifier stays ahead of
/// the best of the four by more than five points where no building and no label is known.
#[test]
fn real_schools_and_offices() {
    if !Path::new(REAL).exists() {
        println!("skipped: no real plans at {REAL}");
        return;
    }
    let folder = folder();
    // Offices alone: the whole study takes minutes without optimisation.
    let office = format!("{REAL}/office");
    let folds = if support::is_whole() { "5" } else { "3" };
    let (code, out, _) = enfilade(["evaluate", &office, "--folds", folds, "-o", text_of(folder.path())]);
    assert_eq!(code, 0, "{out}");
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("report.json")).unwrap()).unwrap();
    let joint = &json["joint"][0]["comparison"];
    let (first, difference) = (joint["first"].as_f64().unwrap(), joint["difference"].as_f64().unwrap());
    assert!(first > 0.69 && difference > 0.05, "joint {first}, better by {difference}");
    let mean = json["averages"][0]["mean"].as_f64().unwrap();
    assert!((0.58..0.70).contains(&mean), "average of the four {mean}");
}

#[test]
fn every_bundled_model_reads_and_says_where_it_comes_from() {
    let models = Models::bundled();
    assert_eq!(models.sets(), ["house", "office", "school", "standard"]);
    for set in models.sets() {
        let methods: Vec<&str> = models.methods(set).into_iter().map(Method::name).collect();
        assert_eq!(methods, ["rules", "tree", "knn", "mlp", "joint", "blend"], "{set}");
        for method in models.methods(set) {
            let model = models.find(set, method).unwrap_or_else(|error| panic!("{set}, {method}: {error}"));
            assert_eq!((model.method(), model.set()), (method, set));
            let about = &model.about;
            assert!(about.command.starts_with("enfilade train") && about.licence.contains("MIT"), "{set}, {method}");
            assert!(!about.scores.is_empty() && about.data.rooms > 600, "{set}, {method}");
        }
    }
    assert!(bundled_typologies().is_some());
    let (code, out, err) = enfilade(["models", "--json"]);
    let printed: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(printed["models"].as_array().unwrap().len() >= 20, "{out}");
    assert_eq!((code, err.as_str()), (0, ""));
}

/// A room's line in what `enfilade classify` prints.
struct Said<'a> {
    room: &'a str,
    label: &'a str,
    /// Whether the label and the prediction are marked as differing.
    is_marked: bool,
    predicted: &'a str,
    percent: u32,
    reason: &'a str,
}

/// The lines of rooms between the heading and the summary, cut at the columns of the heading.
fn said_of_rooms<'a>(out: &'a str) -> Vec<Said<'a>> {
    let lines: Vec<&'a str> = out.lines().collect();
    let heading = lines[1];
    let column = |title: &str| heading.find(title).unwrap_or_else(|| panic!("no column {title} in {heading}"));
    let (function, label, predicted) = (column("function"), column("label"), column("predicted"));
    let (percent, reason) = (column("prob."), column("reason"));
    let said = |line: &&'a str| {
        // Columns count characters.
        let at = |column: usize| line.char_indices().nth(column).map_or(line.len(), |(byte, _)| byte);
        Said {
            room: line[..at(function)].trim(),
            label: line[at(label)..at(label + 11)].trim(),
            is_marked: line[at(label + 11)..at(predicted)].contains('≠'),
            predicted: line[at(predicted)..at(percent)].trim(),
            percent: line[at(percent)..at(reason)].trim().trim_end_matches(" %").parse().unwrap(),
            reason: &line[at(reason)..],
        }
    };
    lines[2..lines.len() - 1].iter().map(said).collect()
}

/// Rooms of the bundled office that every method knows.
const KNOWN_BY_ALL: [(&str, &str); 6] = [
    ("Corridor east", "corridor"),
    ("Corridor west", "corridor"),
    ("Cafeteria", "big room"),
    ("Direction", "big room"),
    ("Room 1.03", "medium room"),
    ("Phone 1", "small room"),
];

/// Of the 38 rooms of the bundled office each method gets about so many right, and says why in its own way.
#[test]
fn predictions_in_words() {
    let plan = format!("{PLANS}/office.plan.json");
    let methods: [(&str, usize, &[&str]); 6] = [
        ("rules", 20, &["What was seen: ", "None of the "]),
        ("tree", 23, &["What was seen: "]),
        ("knn", 23, &["What was seen: "]),
        ("mlp", 24, &["Strong sign", "Clear sign", "Slight sign", "But ", "Nothing stands out: "]),
        ("joint", 26, &["Strong sign", "Clear sign", "Slight sign", "But ", "Nothing stands out: "]),
        ("blend", 31, &["Strong sign", "Clear sign", "Slight sign", "But ", "Nothing stands out: "]),
    ];
    let bundled: Vec<&str> = Models::bundled().methods("office").iter().map(|method| method.name()).collect();
    assert_eq!(methods.map(|(name, ..)| name).as_slice(), bundled);
    for (method, about, forms) in methods {
        let (code, out, err) = enfilade(["classify", &plan, "--algorithm", method]);
        assert_eq!((code, err.as_str()), (0, ""));
        let heading = format!("Office on a corner: typology office (set for the plan), model office-{method}\n");
        assert!(out.starts_with(&heading), "{out}");
        let rooms = said_of_rooms(&out);
        assert_eq!(rooms.len(), 38, "{out}");
        for Said { room, label, is_marked, predicted, percent, reason } in &rooms {
            assert_eq!(*is_marked, label != predicted, "{method}, {room}: {out}");
            // Of five labels the likeliest has a fifth at least.
            assert!((20..=100).contains(percent), "{method}, {room}: {percent} %");
            assert!(forms.iter().any(|form| reason.starts_with(form)), "{method}, {room}: {reason}");
            assert!(reason.ends_with('.'), "{method}, {room}: {reason}");
        }
        for (name, label) in KNOWN_BY_ALL {
            let room = rooms.iter().find(|said| said.room == name).unwrap();
            assert_eq!((room.label, room.predicted), (label, label), "{method}, {name}");
            let least = if label == "corridor" { 70 } else { 35 };
            assert!(room.percent >= least, "{method}, {name}: {} %", room.percent);
        }
        let right = rooms.iter().filter(|said| !said.is_marked).count();
        assert!(right.abs_diff(about) <= 2, "{method}: {right} right, not about {about}");
        let percent = (100.0 * right as f64 / 38.0).round();
        let summary = format!("  {right} of 38 known labels predicted correctly ({percent} %); ");
        let last = out.lines().last().unwrap();
        assert!(last.starts_with(&summary) && last.contains("neighbours' labels: predicted, stable after "), "{last}");
        if method == "blend" {
            // Which part says what.
            let lift = rooms.iter().find(|said| said.room == "Lift 1").unwrap().reason;
            assert!(
                lift.contains("The joint classifier of offices (") && lift.contains("of all buildings ("),
                "{lift}"
            );
        }
        if method == "joint" {
            let lift = rooms.iter().find(|said| said.room == "Lift 1").unwrap().reason;
            for part in ["1.1 times as long as wide, 4 walls", "it opens to 1 corridor"] {
                assert!(lift.contains(part), "{lift}");
            }
        }
    }
}

/// The bundled office with its labels hidden and its typology to be inferred.
#[test]
fn predictions_as_json() {
    let plan = format!("{PLANS}/office.plan.json");
    let (code, out, err) = enfilade(["classify", &plan, "--typology", "auto", "--hide-labels", "--json"]);
    assert_eq!((code, err.as_str()), (0, ""));
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    let [said] = json["plans"].as_array().unwrap().as_slice() else { panic!("{out}") };
    let members: Vec<&str> = said.as_object().unwrap().keys().map(String::as_str).collect();
    assert_eq!(
        members,
        [
            "plan",
            "typology",
            "typology_because",
            "typology_posterior",
            "typology_reasons",
            "model",
            "neighbours",
            "rounds",
            "settled",
            "labelled_rooms",
            "agreeing_rooms",
            "learned_from",
            "rooms",
            "unknown"
        ]
    );
    for (member, value) in [
        ("plan", serde_json::json!("Office on a corner")),
        ("typology", serde_json::json!("office")),
        ("model", serde_json::json!("office-blend")),
        ("neighbours", serde_json::json!("predicted")),
        ("settled", serde_json::json!(true)),
        ("labelled_rooms", serde_json::json!(38)),
        ("unknown", serde_json::Value::Null),
    ] {
        assert_eq!(said[member], value, "{member}");
    }
    let posterior = said["typology_posterior"].as_object().unwrap();
    let of = |typology: &str| posterior[typology].as_f64().unwrap();
    assert!((of("office") - 0.81).abs() < 0.05 && of("house") < 0.02, "{posterior:?}");
    assert!((posterior.keys().map(|typology| of(typology)).sum::<f64>() - 1.0).abs() < 1e-3, "{posterior:?}");
    let because = format!("inferred from the plan, {:.0} % sure", 100.0 * of("office"));
    assert_eq!(said["typology_because"], because);
    let reasons: Vec<&str> = said["typology_reasons"].as_array().unwrap().iter().map(|r| r.as_str().unwrap()).collect();
    for fact in ["half of its rooms are over 16.2 m² (usual: office ", "it has 39 rooms (usual: office "] {
        assert!(reasons.iter().any(|reason| reason.starts_with(fact)), "{fact}: {reasons:?}");
    }
    let rooms = said["rooms"].as_array().unwrap();
    assert_eq!(rooms.len(), 38);
    let mut agreeing = 0;
    for room in rooms {
        let probabilities = room["probabilities"].as_object().unwrap();
        assert_eq!(probabilities.keys().map(String::as_str).collect::<Vec<_>>(), ["S", "M", "B", "C", "H"]);
        let of = |label: &str| probabilities[label].as_f64().unwrap();
        assert!((probabilities.keys().map(|label| of(label)).sum::<f64>() - 1.0).abs() < 1e-3, "{room}");
        let predicted = room["predicted"].as_str().unwrap();
        assert!(probabilities.keys().all(|label| of(label) <= of(predicted)), "{room}");
        agreeing += u64::from(room["label"] == room["predicted"]);
        // Labels are hidden, so nobody may lean on one.
        let reason = room["reason"].as_str().unwrap();
        assert!(!reason.contains("(known: "), "{reason}");
        let begins = ["Strong sign", "Clear sign", "Slight sign", "No single trait decides", "Nothing stands out"];
        assert!(begins.iter().any(|begin| reason.starts_with(begin)), "{reason}");
    }
    assert_eq!(said["agreeing_rooms"].as_u64(), Some(agreeing));
    assert!(agreeing.abs_diff(25) <= 2, "{agreeing} agree, not about 25");
    let called = |name: &str| rooms.iter().find(|room| room["room"] == name).unwrap();
    for (name, label) in [("Corridor east", "C"), ("Phone 1", "S"), ("Meeting 2", "M"), ("Direction", "B")] {
        assert_eq!(called(name)["predicted"], label, "{name}");
    }
    let closet = called("Accessible WC");
    assert_eq!((closet["id"].as_str(), closet["function"].as_str()), (Some("rgwka2mq2a59y"), Some("washroom")));
}

/// Without its functions no label of the plan is known: predictions are written where nobody said
/// otherwise, marked, and taken for no truth by anyone.
#[test]
fn predictions_are_written_only_when_told_and_marked() {
    let folder = folder();
    let path = folder.path().join("unknown.plan.json");
    let mut plan = bundled("dwelling");
    let rooms: Vec<_> = plan.rooms().map(|(id, _)| id).collect();
    for &room in &rooms {
        plan = edit::set_function(&plan, room, "").unwrap();
    }
    save_plan(&path, &plan).unwrap();
    let before = std::fs::read(&path).unwrap();
    assert_eq!(enfilade(["classify", text_of(&path)]).0, 0);
    assert_eq!(std::fs::read(&path).unwrap(), before, "written without being told");
    let copy = folder.path().join("copy.plan.json");
    assert_eq!(enfilade(["classify", text_of(&path), "--write", "-o", text_of(&copy)]).0, 0);
    assert_eq!(std::fs::read(&path).unwrap(), before, "the source was written");
    let written = load_plan(&copy).unwrap();
    for (_, room) in written.rooms() {
        assert_eq!(room.label.map(|label| label.origin), Some(LabelOrigin::Prediction), "{}", room.name);
    }
    let network = enfilade::dataset::RoomNetwork::new(&written, &Schemes::bundled());
    assert!(network.rooms.iter().all(|room| room.label.is_none()), "a prediction was taken for the truth");
    // Again into itself: the same file.
    let once = std::fs::read(&copy).unwrap();
    assert_eq!(enfilade(["classify", text_of(&copy), "--write"]).0, 0);
    assert_eq!(std::fs::read(&copy).unwrap(), once);
}

#[test]
fn a_model_that_was_trained_is_used() {
    let folder = folder();
    let model = folder.path().join("mine.model.json");
    // A blend is made of others, and trained with them.
    for method in Method::ALL.into_iter().filter(|&method| method != Method::Blend) {
        let (code, out, err) =
            enfilade(["train", PLANS, "--algorithm", method.name(), "--typology", "office", "-o", text_of(&model)]);
        assert_eq!(code, 0, "{out}{err}");
        let bytes = std::fs::read(&model).unwrap();
        assert_eq!(
            enfilade(["train", PLANS, "--algorithm", method.name(), "--typology", "office", "-o", text_of(&model)]).0,
            0
        );
        assert!(std::fs::read(&model).unwrap() == bytes, "{method}: not the same bytes twice");
        let plan = format!("{PLANS}/office.plan.json");
        let (code, out, err) = enfilade(["classify", &plan, "--model", text_of(&model)]);
        assert_eq!((code, err.as_str()), (0, ""));
        assert!(out.starts_with("Office on a corner: typology office (of the model), model mine\n"), "{out}");
    }
}

/// A typology of one's own: a scheme file, a model learned with it, and both found by name.
#[test]
fn a_typology_of_ones_own_needs_two_files() {
    let folder = folder();
    let scheme = folder.path().join("clinic.scheme.toml");
    let text = "version = 1\n[clinic]\nM = ['office', 'shared office', 'conference room']\nC = ['corridor']\nS = ['toilet', \
                'storage']\nH = ['lobby']\n";
    enfilade::store::save_bytes(&scheme, text.as_bytes()).unwrap();
    let plan = folder.path().join("clinic.plan.json");
    let office = bundled("office");
    let typology = enfilade::labels::Typology::new("clinic");
    save_plan(&plan, &edit::set_meta(&office, enfilade::plan::Meta { typology, ..office.meta().clone() })).unwrap();
    let models = folder.path().join("models");
    std::fs::create_dir(&models).unwrap();
    let model = models.join("ours.model.json");
    let (code, out, err) = enfilade([
        "train",
        text_of(&plan),
        "--scheme",
        text_of(&scheme),
        "--algorithm",
        "tree",
        "--folds",
        "0",
        "-o",
        text_of(&model),
    ]);
    assert_eq!(code, 0, "{out}{err}");
    let classify = |arguments: &[&str]| {
        let all =
            [&["classify", text_of(&plan), "--scheme", text_of(&scheme), "--models", text_of(&models)], arguments];
        let (code, out, err) = enfilade(all.concat());
        (code, format!("{}{err}", out.lines().next().unwrap_or_default()))
    };
    let (code, said) = classify(&["--algorithm", "tree"]);
    assert_eq!((code, said.as_str()), (0, "Office on a corner: typology clinic (set for the plan), model ours"));
    let (code, said) = classify(&["--algorithm", "tree", "--typology", "clinic"]);
    assert_eq!((code, said.as_str()), (0, "Office on a corner: typology clinic (as told), model ours"));
    let (code, said) = classify(&["--typology", "ours"]);
    assert_eq!((code, said.as_str()), (0, "Office on a corner: typology clinic (of the model), model ours"));
    // Without a model by that method the typology is inferred from those that have one.
    let (code, said) = classify(&["--algorithm", "joint"]);
    assert!(code == 0 && said.contains("(inferred from the plan, ") && said.contains("-joint"), "{said}");
    let (code, said) = classify(&["--algorithm", "joint", "--typology", "clinic"]);
    assert!(
        code == 1 && said.contains("there is no model of clinic by joint classifier; use tree, or train"),
        "{said}"
    );
}

/// What cannot be done is refused in words that say what to do.
#[test]
fn refusals() {
    let folder = folder();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        enfilade::store::save_bytes(&path, text.as_bytes()).unwrap();
        path
    };
    let head = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H\n";
    let empty = write("empty.csv", head);
    let bad = write("bad.csv", &format!("{head}S,inf,1,1,0,0,0,0,0\n"));
    let three = write("three.csv", &format!("{head}S,4,1,1,0,0,0,0,0\nM,20,1,1,0,0,0,0,0\nC,9,4,5,0,0,0,0,0\n"));
    let torn = write("torn.model.json", "{\"format\": \"enfilade model\", \"version\": 1, ");
    let newer = write("newer.model.json", "{\"format\": \"enfilade model\", \"version\": 9}");
    let out = folder.path().join("out");
    let (out, plan) = (text_of(&out), format!("{PLANS}/office.plan.json"));
    let calls: &[&[&str]] = &[
        &["evaluate", text_of(&empty), "-o", out],
        &["evaluate", text_of(&bad), "-o", out],
        &["evaluate", text_of(&three), PLANS, "-o", out],
        &["evaluate", text_of(&three), "--neighbours", "predicted", "-o", out],
        &["evaluate", text_of(&three), "--by", "building", "-o", out],
        &["evaluate", PLANS, "--folds", "1", "-o", out],
        &["evaluate", "nowhere", "-o", out],
        &["train", PLANS, "-o", "all.model.json"],
        &["train", PLANS, "--typology", "castle", "-o", out],
        &["train", text_of(&three), "--algorithm", "joint", "-o", out],
        &["classify", &plan, "--model", text_of(&torn)],
        &["classify", &plan, "--model", text_of(&newer)],
        &["classify", &plan, "--typology", "castle"],
        &["classify", &plan, "--algorithm", "guess"],
        &["classify", &plan, "--neighbours", "nice"],
    ];
    let mut text = String::new();
    for call in calls {
        let (code, _, err) = enfilade(call.iter().copied());
        let shown = call.join(" ").replace(text_of(folder.path()), "FOLDER").replace(PLANS, "plans");
        let err = err.replace(text_of(folder.path()), "FOLDER").replace(PLANS, "plans");
        text.push_str(&format!("$ enfilade {shown}\n{err}exit {code}\n\n"));
        assert!(code == 1 || code == 2, "{shown}: {code}");
    }
    support::assert_text(&fixture("refusals.txt"), &text);
    assert!(!Path::new(out).exists(), "something was written");
}

/// Three rooms are too few to validate on ten folds, and enough to learn from.
#[test]
fn three_rooms_make_a_model() {
    let folder = folder();
    let table = folder.path().join("three.csv");
    let text = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H\nS,4,1,1,0,0,0,0,0\nM,20,1,1,0,0,0,0,0\nC,9,4,5,0,0,0,0,0\n";
    enfilade::store::save_bytes(&table, text.as_bytes()).unwrap();
    let models = folder.path().join("models");
    let (code, out, err) = enfilade(["train", text_of(&table), "-o", text_of(&models)]);
    assert_eq!(code, 0, "{out}{err}");
    assert_eq!(std::fs::read_dir(models).unwrap().count(), 4, "{out}");
}
