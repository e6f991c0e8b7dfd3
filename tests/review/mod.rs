//! The review queue, and two people's labels compared.

use std::path::Path;

use enfilade::base::random::Random;
use enfilade::base::work::Work;
use enfilade::classify::Confusion;
use enfilade::classify::models::Models;
use enfilade::edit;
use enfilade::formats;
use enfilade::labels::{Label, Schemes};
use enfilade::plan::{LabelOrigin, Plan, RoomId, RoomLabel};
use enfilade::review::agreement::{Agreement, Kappa};
use enfilade::review::{Decision, Decisions, FILE_NAME, FileSeen, Key, Material, Queue, Verdict, queue};
use enfilade::store::{bundled_plans, save_plan};
use proptest::prelude::*;

use crate::support::{enfilade, is_whole};

#[expect(dead_code, reason = "the example uses all of it")]
#[path = "../../examples/planted_errors/plant.rs"]
mod plant;

use plant::{File, Functions, Wrong, found, plant};

const REAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/authors");

fn text_of(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn relabelled(plan: &Plan, id: RoomId, label: Label) -> Plan {
    edit::set_label(plan, id, Some(RoomLabel { label, origin: LabelOrigin::Person })).unwrap()
}

fn material(files: &[File]) -> Material {
    let schemes = Schemes::bundled();
    Material::new(files.iter().map(|file| FileSeen::new(&file.name, String::new(), &file.plans, &schemes)))
}

fn queue_of(files: &[File], folds: usize) -> Queue {
    queue(&material(files), &Schemes::bundled(), &Models::bundled(), folds, 1, &Work::quiet()).unwrap()
}

fn bundled() -> Vec<File> {
    let file = |(name, plan): (&str, Plan)| File { name: format!("{name}.plan.json"), plans: vec![plan] };
    bundled_plans().unwrap().into_iter().map(file).collect()
}

/// The tables with scikit-learn's kappa and statsmodels' standard error. Recorded with scikit-learn 1.9.1 and statsmodels 0.15.0:
/// `cohen_kappa_score(a, b)` and `cohens_kappa(table).std_kappa`, the table without the labels that neither used.
#[rustfmt::skip]
const RECORDED: &[([[usize; 5]; 5], f64, f64)] = &[
    ([[4, 2, 0, 0, 0], [2, 4, 0, 0, 0], [0, 0, 0, 0, 0], [0, 0, 0, 0, 0], [0, 0, 0, 0, 0]], 0.333333333333, 0.272165526976),
    ([[12, 1, 4, 0, 0], [1, 10, 0, 0, 0], [2, 2, 8, 0, 0], [0, 0, 0, 0, 0], [0, 0, 0, 0, 0]], 0.621928166352, 0.103463236016),
    ([[27, 1, 0, 1, 0], [0, 41, 0, 0, 0], [2, 1, 42, 2, 1], [0, 0, 1, 35, 3], [1, 0, 3, 1, 38]], 0.893189243529, 0.024787104438),
    ([[30, 19, 17, 16, 22], [18, 38, 15, 15, 22], [19, 13, 36, 13, 15], [24, 18, 28, 29, 12], [13, 8, 12, 21, 27]], 0.150322877307, 0.026023420837),
    ([[3, 2, 12, 5, 0], [4, 4, 4, 1, 0], [1, 3, 1, 3, 0], [3, 4, 7, 3, 0], [0, 0, 0, 0, 0]], -0.052631578947, 0.064528162325),
    ([[4, 0, 0, 0, 0], [0, 9, 0, 0, 0], [0, 0, 5, 0, 0], [0, 0, 0, 5, 0], [0, 0, 0, 0, 7]], 1.0, 0.0),
];

#[test]
fn kappa_is_scikit_learns() {
    for (table, value, error) in RECORDED {
        let kappa = Kappa::of(&Confusion(*table)).unwrap();
        assert!((kappa.value - value).abs() < 1e-9, "{} is not {value}", kappa.value);
        assert!((kappa.error - error).abs() < 1e-7, "{} is not {error}", kappa.error);
        assert!(kappa.low <= kappa.value && kappa.value <= kappa.high);
    }
    // Nothing to say where both only ever used one label.
    let mut one = Confusion::default();
    assert_eq!((Agreement::of(&one).share(), Agreement::of(&one).kappa), (None, None));
    one.0[1][1] = 12;
    assert_eq!((Agreement::of(&one).share(), Agreement::of(&one).kappa), (Some(1.0), None));
}

proptest! {
    #[test]
    fn kappa_does_not_depend_on_who_is_first_nor_on_the_order_of_labels(cells in prop::collection::vec(0usize..30, 25), turn in 0usize..5) {
        let table = Confusion(std::array::from_fn(|row| std::array::from_fn(|column| cells[5 * row + column])));
        let swapped = Confusion(std::array::from_fn(|row| std::array::from_fn(|column| table.0[column][row])));
        let turned =
            Confusion(std::array::from_fn(|row| std::array::from_fn(|column| table.0[(row + turn) % 5][(column + turn) % 5])));
        let kappa = Kappa::of(&table);
        for other in [Kappa::of(&swapped), Kappa::of(&turned)] {
            match (kappa, other) {
                (Some(kappa), Some(other)) => {
                    prop_assert!((kappa.value - other.value).abs() < 1e-9 && (kappa.error - other.error).abs() < 1e-7);
                    prop_assert!((-1.0..=1.0).contains(&kappa.low) && (-1.0..=1.0).contains(&kappa.high));
                }
                (kappa, other) => prop_assert_eq!(kappa.is_some(), other.is_some()),
            }
        }
    }
}

fn told(queue: &Queue) -> Vec<(String, String, String)> {
    let told = |entry: &enfilade::review::Entry| {
        (entry.row.file.clone(), entry.row.id.clone(), format!("{:.9} {}", entry.worth, entry.reasons_in_words()))
    };
    queue.entries.iter().map(told).collect()
}

#[test]
fn the_order_of_the_files_does_not_change_the_queue() {
    let files = bundled();
    let queue = told(&queue_of(&files, 4));
    assert!(queue.len() > 70);
    for seed in 1..=3 {
        let mut other = files.clone();
        Random::new(seed).shuffle(&mut other);
        assert_eq!(told(&queue_of(&other, 4)), queue);
    }
}

/// Each sample with a label that contradicts its function: these rooms come first. What is decided leaves the list, and comes back
/// once the label is another.
#[test]
fn a_wrong_label_comes_first_until_it_is_decided() {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong: Vec<String> = Vec::new();
    for (name, plan) in bundled_plans().unwrap() {
        let id = plan.rooms().find(|(_, room)| !room.function.is_empty() && room.label.is_none()).map(|(id, _)| id);
        let plan = match id {
            Some(id) => {
                wrong.push(id.to_string());
                let schemes = Schemes::bundled();
                let status = enfilade::features::RoomStatus::of(&plan, &schemes, plan.room(id).unwrap());
                let other = Label::ALL.into_iter().rfind(|&label| status.label() != Some(label)).unwrap();
                relabelled(&plan, id, other)
            }
            None => plan,
        };
        save_plan(&folder.path().join(format!("{name}.plan.json")), &plan).unwrap();
    }
    assert!(!wrong.is_empty());
    let top = wrong.len().to_string();
    let list = || {
        let (code, out, err) = enfilade(["review", text_of(folder.path()), "--json", "--top", &top]);
        assert_eq!((code, err.as_str()), (0, ""), "{err}");
        serde_json::from_str::<serde_json::Value>(&out).unwrap()
    };
    let json = list();
    let ids = |json: &serde_json::Value| -> Vec<String> {
        json["queue"].as_array().unwrap().iter().map(|room| room["id"].as_str().unwrap().to_owned()).collect()
    };
    for id in ids(&json) {
        assert!(wrong.contains(&id), "{json:#}");
    }
    let first = &json["queue"][0];
    let words = first["reasons"][0]["words"].as_str().unwrap();
    assert!(words.starts_with("Its function, ") && words.contains("makes it a"), "{words}");
    // Accepted: it is not asked about again, unless its label changes.
    let label: Label = first["label"].as_str().unwrap().parse().unwrap();
    let key = Key { file: first["file"].as_str().unwrap().to_owned(), room: ids(&json)[0].clone() };
    let decide = |label: Label| {
        let mut decisions = Decisions::default();
        let verdict = Some(Verdict::Accepted);
        decisions.set(key.clone(), Decision { verdict, label: Some(label), note: "seen".to_owned() });
        std::fs::write(folder.path().join(FILE_NAME), decisions.to_bytes()).unwrap();
    };
    decide(label);
    let after = list();
    assert!(!ids(&after).contains(&key.room) && after["decided"] == 1, "{after:#}");
    decide(Label::ALL.into_iter().find(|&other| other != label).unwrap());
    assert_eq!(ids(&list()), ids(&json));
    assert_eq!(list()["queue"][0]["note"], "seen");
    let (code, out, _) = enfilade(["review", text_of(folder.path()), "--top", "3"]);
    assert!(code == 0 && out.contains("Note: seen") && out.contains("Its function"), "{out}");
}

/// A part of what `examples/planted_errors` measures: docs/review.md has the whole.
#[test]
fn planted_errors_are_found_by_looking_at_few_rooms() {
    let folder = format!("{REAL}/office");
    if !Path::new(&folder).exists() {
        println!("skipped: no real plans at {REAL}");
        return;
    }
    let mut paths: Vec<_> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    if !is_whole() {
        paths.truncate(4);
    }
    let file = |path: &std::path::PathBuf| File {
        name: path.display().to_string(),
        plans: formats::read_file(path).unwrap().plans,
    };
    let files: Vec<File> = paths.iter().map(file).collect();
    let clean = material(&files);
    for wrong in Wrong::ALL {
        let (changed, planted) = plant(&files, clean.networks(), 0.05, wrong, Functions::Kept, 1);
        let queue = queue_of(&changed, 5);
        let order: Vec<(String, RoomId)> =
            queue.entries.iter().map(|entry| (entry.row.file.clone(), entry.room)).collect();
        let share = found(&order, &planted, 0.15);
        println!("{}: {:.0} % of {} found", wrong.name(), 100.0 * share, planted.len());
        assert!(planted.len() >= 5 && share >= 0.9, "{}: {share}", wrong.name());
    }
}

#[test]
fn two_peoples_labels_are_compared_and_put_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for side in ["anna", "ben"] {
        std::fs::create_dir(path(side)).unwrap();
    }
    let mut changed = Vec::new();
    for (name, plan) in bundled_plans().unwrap().into_iter().take(2) {
        let id = plan.rooms().next().unwrap().0;
        save_plan(&path("anna").join(format!("{name}.plan.json")), &relabelled(&plan, id, Label::SmallRoom)).unwrap();
        save_plan(&path("ben").join(format!("{name}.plan.json")), &relabelled(&plan, id, Label::Hall)).unwrap();
        changed.push(id.to_string());
    }
    let (anna, ben) = (path("anna"), path("ben"));
    let csv = path("differences.csv");
    let merged = path("merged");
    let (code, out, err) = enfilade([
        "compare",
        text_of(&anna),
        text_of(&ben),
        "--json",
        "-o",
        text_of(&csv),
        "--merged",
        text_of(&merged),
        "--prefer",
        "second",
    ]);
    assert_eq!((code, err.as_str()), (0, ""));
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    let rooms = json["rooms_labelled_by_both"].as_u64().unwrap();
    assert_eq!(json["same_label"].as_u64().unwrap() + 2, rooms);
    assert_eq!(json["confusion"]["rooms"][0][4], 2);
    let differ: Vec<&str> =
        json["differences"].as_array().unwrap().iter().map(|room| room["ids"][0].as_str().unwrap()).collect();
    assert_eq!(differ.len(), 2);
    assert!(differ.iter().all(|id| changed.iter().any(|changed| changed == id)), "{json:#}");
    // The merged plans say what the second said.
    let (code, out, _) = enfilade(["compare", text_of(&merged), text_of(&ben)]);
    assert!(code == 0 && out.contains("rooms labelled by both: ") && out.contains("(100.0 %)"), "{out}");
    let (_, out, _) = enfilade(["compare", text_of(&anna), text_of(&ben)]);
    assert!(out.contains("2 rooms differ:") && out.contains("Cohen's kappa 0.9"), "{out}");
    // The table, filled in, is applied by 'label'.
    let table = std::fs::read_to_string(&csv).unwrap();
    assert!(table.starts_with("file,id,plan,room,first_label,second_label,"), "{table}");
    let filled: String = table
        .lines()
        .map(|line| format!("{}\n", line.strip_suffix(",,").map_or(line.to_owned(), |it| format!("{it},H,"))))
        .collect();
    std::fs::write(&csv, filled).unwrap();
    let (code, out, err) = enfilade(["label", text_of(&anna), "--from", text_of(&csv)]);
    assert!(code == 0 && out.contains("2 rooms in 2 files changed"), "{out}{err}");
    let (_, out, _) = enfilade(["compare", text_of(&anna), text_of(&ben)]);
    assert!(out.contains("(100.0 %)"), "{out}");
    // A folder beside a file, and folders without a plan in common.
    let one = anna.join("nothing.plan.json");
    assert_eq!(enfilade(["compare", text_of(&anna), text_of(&one)]).0, 2);
    std::fs::create_dir(path("empty")).unwrap();
    assert_eq!(enfilade(["compare", text_of(&anna), text_of(&path("empty"))]).0, 1);
}
