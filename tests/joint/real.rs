//! The authors' schools and offices, and the dwellings, if available.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use enfilade::base::work::Work;
use enfilade::classify::joint::{Group, Joint, cross_validate, cross_validate_without};
use enfilade::classify::typology::{Inferred, Measure, TypologyModel, cross_validate as infer};
use enfilade::classify::unknown::{Unknown, UnknownScores};
use enfilade::dataset::RoomNetwork;
use enfilade::formats::{self, building_name};
use enfilade::labels::Schemes;
use enfilade::plan::Plan;

const SCHOOLS: &[&str] = &["authors/school"];
const OFFICES: &[&str] = &["authors/office"];
const HOUSES: &[&str] = &["houses/r2v", "houses/archilyse"];

/// The networks of all plans in folders of the shared data, made by `of`; nothing, with a word, where the
/// data are not.
fn networks(folders: &[&str], of: fn(&Plan, &Schemes) -> RoomNetwork) -> Option<Vec<RoomNetwork>> {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data"));
    if !data.is_dir() {
        println!("skipped: no shared data");
        return None;
    }
    let schemes = Schemes::bundled();
    let mut networks = Vec::new();
    for folder in folders {
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(data.join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files {
            for plan in formats::read_file(&file).map(|import| import.plans).unwrap_or_default() {
                let mut network = of(&plan, &schemes);
                network.building = building_name::key(&network.building);
                network.group.clone_from(&network.building);
                networks.push(network);
            }
        }
    }
    Some(networks)
}

/// Eight points above the best of the four with its neighbours' labels given (57.7, `docs/joint.md`), though
/// it learns from two thirds of the buildings only.
#[test]
fn offices_never_seen() {
    let Some(networks) = networks(OFFICES, RoomNetwork::new) else { return };
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    let scores = cross_validate(&networks, 3, 1, &Work::quiet()).unwrap().scores;
    println!("offices, 3 folds by building: {:.1} %", scores.accuracy * 100.0);
    assert!(scores.accuracy > 0.66, "{}", scores.accuracy);
    assert!(scores.calibration_error < 0.1, "{}", scores.calibration_error);
}

#[test]
fn typologies_of_buildings_never_seen() {
    let folders = [SCHOOLS, OFFICES, &HOUSES[..1]].concat();
    let Some(networks) = networks(&folders, RoomNetwork::without_typology) else { return };
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    let inferred = infer(&networks, &BTreeSet::new(), 10, 1);
    let (_, balanced) =
        shares(&inferred, |inferred| (inferred.truth.to_string(), f64::from(u8::from(is_right(inferred)))));
    println!("typologies, folds by building: {:.1} % balanced", balanced * 100.0);
    assert!(balanced > 0.85, "{balanced}");
}

fn is_right(inferred: &Inferred) -> bool {
    inferred.posterior[0].0 == inferred.truth
}

/// The mean of a number by key, and the mean of these means.
fn shares<T>(items: &[T], number: impl Fn(&T) -> (String, f64)) -> (BTreeMap<String, f64>, f64) {
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (key, number) in items.iter().map(number) {
        let sum = sums.entry(key).or_default();
        *sum = (sum.0 + number, sum.1 + 1.0);
    }
    let means: BTreeMap<String, f64> = sums.into_iter().map(|(key, (sum, count))| (key, sum / count)).collect();
    let mean = means.values().sum::<f64>() / means.len() as f64;
    (means, mean)
}

const SEEDS: std::ops::RangeInclusive<u64> = 1..=5;

fn report(
    title: &str,
    networks: &[&RoomNetwork],
    left_out: &BTreeSet<Group>,
    known: f64,
    seeds: impl Iterator<Item = u64>,
) {
    let scores: Vec<_> = seeds
        .map(|seed| cross_validate_without(networks, left_out, 10, known, seed, &Work::quiet()).unwrap().scores)
        .collect();
    let mean =
        |of: &dyn Fn(&enfilade::classify::Scores) -> f64| scores.iter().map(of).sum::<f64>() / scores.len() as f64;
    let each: Vec<String> = scores.iter().map(|scores| format!("{:.1}", scores.accuracy * 100.0)).collect();
    println!(
        "{title:<40} {:.1} % ({}) log loss {:.3} Brier {:.3} ECE {:.3}",
        mean(&|scores| scores.accuracy) * 100.0,
        each.join(" "),
        mean(&|scores| scores.log_loss),
        mean(&|scores| scores.brier),
        mean(&|scores| scores.calibration_error),
    );
}

#[test]
#[ignore = "takes minutes: prints the tables of docs/joint.md"]
fn measure_joint() {
    let none = BTreeSet::new();
    for (set, folders) in [("school", SCHOOLS), ("office", OFFICES)] {
        let Some(networks) = networks(folders, RoomNetwork::new) else { return };
        let networks: Vec<&RoomNetwork> = networks.iter().collect();
        report(set, &networks, &none, 0.0, SEEDS);
        for known in [0.25, 0.5, 0.75] {
            report(&format!("{set}, {known} of the rooms known"), &networks, &none, known, 1..=1);
        }
        for group in Group::ALL {
            report(&format!("{set} without {group:?}"), &networks, &BTreeSet::from([group]), 0.0, 1..=1);
        }
        let joint = Joint::train(&networks, 1, &Work::quiet()).unwrap();
        println!("{set} model: {} bytes", joint.to_value().to_string().len());
    }
    for (set, folders) in [("house", HOUSES.to_vec()), ("all", [SCHOOLS, OFFICES, HOUSES].concat())] {
        let Some(networks) = networks(&folders, RoomNetwork::new) else { return };
        report(set, &networks.iter().collect::<Vec<_>>(), &none, 0.0, 1..=1);
    }
}

#[test]
#[ignore = "prints the tables of docs/joint.md"]
fn measure_unknown() {
    for (set, folders) in [("school", SCHOOLS), ("office", OFFICES), ("house", HOUSES)] {
        let Some(networks) = networks(folders, RoomNetwork::new) else { return };
        let networks: Vec<&RoomNetwork> = networks.iter().collect();
        for seed in SEEDS {
            let UnknownScores { scores, most_frequent } = Unknown::score(&networks, 10, seed).unwrap();
            println!(
                "{set} behind openings: {:.1} % of {}, most frequent label {:.1} %, log loss {:.3}",
                scores.accuracy * 100.0,
                scores.rooms,
                most_frequent * 100.0,
                scores.log_loss
            );
        }
    }
}

#[test]
#[ignore = "prints the tables of docs/joint.md"]
fn measure_typology() {
    let folders = [SCHOOLS, OFFICES, HOUSES].concat();
    let Some(networks) = networks(&folders, RoomNetwork::without_typology) else { return };
    let networks: Vec<&RoomNetwork> = networks.iter().collect();
    use Measure::{MedianArea, Passages, Rooms};
    for left_out in [vec![], vec![Rooms], vec![MedianArea], vec![Rooms, MedianArea], vec![Rooms, MedianArea, Passages]]
    {
        let left_out: BTreeSet<Measure> = left_out.into_iter().collect();
        let inferred: Vec<Inferred> = SEEDS.flat_map(|seed| infer(&networks, &left_out, 10, seed)).collect();
        let right = |inferred: &Inferred| f64::from(u8::from(is_right(inferred)));
        let (by_plan, balanced) = shares(&inferred, |it| (it.truth.to_string(), right(it)));
        // A building's plans count as one.
        let (by_building, _) = shares(&inferred, |it| (format!("{} {}", it.truth, it.building), right(it)));
        let buildings: Vec<(String, f64)> = by_building.into_iter().collect();
        let (by_building, balanced_buildings) =
            shares(&buildings, |(key, share)| (key.split(' ').next().unwrap_or_default().to_owned(), *share));
        let truth =
            |it: &Inferred| it.posterior.iter().find(|(typology, _)| *typology == it.truth).map_or(0.0, |of| of.1);
        let (_, loss) = shares(&inferred, |it| (it.truth.to_string(), -truth(it).max(1e-9).ln()));
        let gap = |it: &Inferred| (it.truth.to_string(), it.posterior[0].1 - right(it));
        let (gaps, _) = shares(&inferred, gap);
        println!("without {left_out:?}\n  plans {by_plan:.3?} balanced {balanced:.3}");
        println!(
            "  buildings {by_building:.3?} balanced {balanced_buildings:.3}\n  log loss {loss:.3} overconfidence {gaps:.3?}"
        );
    }
    let model = TypologyModel::train(&networks).unwrap();
    for (network, _) in networks.iter().zip(0..5) {
        println!("{}: {:.2?}\n  {:?}", network.plan, model.posterior(network, &[]), model.reasons(network, &[]));
    }
}
