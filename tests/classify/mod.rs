//! The four algorithms: scores compared with Weka's, model files, explanations, and the effect of bad
//! data.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "a skipped test says so")]

mod explanations;
mod generated;
mod real_rows;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use enfilade::base::hash;
use enfilade::base::units::Units;
use enfilade::base::work::Work;
use enfilade::classify::explain::Reason;
use enfilade::classify::model_file::{self, About, DataSummary, ModelFileError, ScoreSummary, to_bytes};
use enfilade::classify::{
    Algorithm, Classifier, Distribution, Method, PlanClassifier, Scores, Validation, evaluate, evaluate_all, test,
};
use enfilade::dataset::folds::{Folds, Grouping};
use enfilade::dataset::table::{FEATURES, RoomSource, Table, Values};
use enfilade::dataset::{Row, csv};
use enfilade::features::NeighbourLabels;
use enfilade::labels::{Label, Typology};
use generated::generated_rows;
use proptest::prelude::*;
use real_rows::{SETS, real_rows};

use crate::support;

fn fixture(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/classify")).join(name)
}

fn table(rows: &[Row]) -> Table {
    Table::from_rows(rows).expect("good rows")
}

/// A table of these rooms, from plans of ten.
fn table_of(rooms: &[(Values, Label)]) -> Table {
    let source = |index: usize| RoomSource { plan: format!("p{}", index / 10).into(), room: index.to_string().into() };
    let (values, labels) = rooms.iter().copied().unzip();
    Table::from_columns(values, labels, (0..rooms.len()).map(source).collect()).expect("good rows")
}

fn algorithm(id: &str) -> Algorithm {
    id.parse().expect("a learner's id")
}

fn trained(algorithm: Algorithm, table: &Table, seed: u64) -> Classifier {
    Classifier::train(algorithm, table, seed, &Work::quiet()).expect("not cancelled")
}

fn assert_is_distribution(distribution: &Distribution, context: &str) {
    let probabilities = distribution.probabilities();
    assert!(probabilities.iter().all(|p| (0.0..=1.0).contains(p)), "{context}: {probabilities:?}");
    assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{context}: {probabilities:?}");
}

// Scores.

/// Rooms that Weka put right, by set, algorithm and seed of the folds. See the head of the file.
fn weka_accuracies(set: &str, algorithm: Algorithm) -> Vec<(u64, f64)> {
    let text = std::fs::read_to_string(fixture("weka.csv")).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let found: Vec<(u64, f64)> = lines
        .map(|line| line.split(',').collect::<Vec<_>>())
        .filter(|cells| cells[0] == set && cells[1] == algorithm.name())
        .map(|cells| (cells[2].parse().unwrap(), cells[3].parse::<f64>().unwrap() / cells[4].parse::<f64>().unwrap()))
        .collect();
    assert!(!found.is_empty(), "{set} {algorithm} is not in weka.csv");
    found
}

/// On the same rows and the same folds each of our algorithms is at most a point below Weka's, on the
/// mean over the seeds.
fn assert_not_below_weka(set: &str, rows: &[Row], seeds: usize) {
    let table = table(rows);
    for algorithm in ["rules", "tree", "knn", "mlp"].map(algorithm) {
        let theirs = &weka_accuracies(set, algorithm)[..seeds];
        let folds: Vec<(u64, Folds)> = theirs
            .iter()
            .map(|&(seed, _)| (seed, Folds::new(rows, Grouping::Room, 10, seed).expect("enough rows")))
            .collect();
        let validations: Vec<Validation<'_>> =
            folds.iter().map(|(seed, folds)| Validation { table: &table, folds, algorithm, seed: *seed }).collect();
        let validated = evaluate_all(&validations, &Work::quiet()).expect("not cancelled");
        let ours = validated.iter().map(|validated| validated.scores.accuracy).sum::<f64>() / seeds as f64;
        let theirs = theirs.iter().map(|(_, accuracy)| accuracy).sum::<f64>() / seeds as f64;
        println!("{set} {algorithm}: {:.1} %, Weka {:.1} %", ours * 100.0, theirs * 100.0);
        assert!(ours > theirs - 0.01, "{set}: {algorithm} {ours:.4}, Weka {theirs:.4}");
        // Probabilities are worth having: far better than the labels' shares.
        let prior = Distribution::from_weights(table.label_counts().map(|count| count as f64));
        let of_prior = Scores::of(table.labels().iter().map(|&label| (0, &prior, label)));
        for validated in &validated {
            let scores = &validated.scores;
            assert!(scores.log_loss < 0.8 * of_prior.log_loss, "{set}: {algorithm} log loss {}", scores.log_loss);
            assert!(scores.brier < 0.8 * of_prior.brier, "{set}: {algorithm} Brier {}", scores.brier);
            assert!(scores.calibration_error < 0.06, "{set}: {algorithm} off by {}", scores.calibration_error);
        }
    }
}

/// Reads a model that has no parts.
fn from_bytes(bytes: &[u8]) -> Result<(PlanClassifier, About), ModelFileError> {
    model_file::from_bytes(bytes, &|_| None).map(|(classifier, about, _)| (classifier, about))
}

#[test]
fn on_real_rooms_no_algorithm_is_below_weka() {
    // More seeds where fewer rooms make chance larger.
    for ((set, folders), seeds) in SETS.into_iter().zip([1, 2, 3, 1]) {
        if seeds == 1 && !support::is_whole() {
            continue;
        }
        match real_rows(folders) {
            Some(rows) => assert_not_below_weka(set, &rows, seeds),
            None => println!("skipped {set}: the real plans are not in ../shared/data"),
        }
    }
}

#[test]
fn on_generated_rooms_no_algorithm_is_below_weka() {
    assert_not_below_weka("generated", &generated_rows(900, 1), 3);
}

#[test]
fn results_do_not_depend_on_threads() {
    let rows = generated_rows(300, 2);
    let table = table(&rows);
    let folds = Folds::new(&rows, Grouping::Building, 3, 1).expect("enough buildings");
    for algorithm in Algorithm::ALL {
        let on = |threads| evaluate(&table, &folds, algorithm, 9, &Work::quiet().on_threads(threads)).expect("done");
        assert_eq!(on(1), on(4), "{algorithm}");
        let bytes = |seed| to_bytes(&trained(algorithm, &table, seed).into(), &about(&rows));
        assert_eq!(bytes(5), bytes(5), "{algorithm}");
    }
}

#[test]
fn a_classifier_tested_on_other_rooms_scores_them() {
    let classifier = trained(algorithm("tree"), &table(&generated_rows(400, 3)), 1);
    let validated = test(&classifier, &table(&generated_rows(200, 4)));
    assert_eq!((validated.scores.rooms, validated.scores.folds.len()), (200, 1));
    assert!(validated.scores.accuracy > 0.5, "{}", validated.scores.accuracy);
}

// Model files.

fn about(rows: &[Row]) -> About {
    let table = table(rows);
    let folds = Folds::new(rows, Grouping::Room, 3, 1).expect("enough rows");
    let validated = evaluate(&table, &folds, algorithm("tree"), 1, &Work::quiet()).expect("done");
    About {
        typology: Typology::new("school"),
        neighbours: NeighbourLabels::True,
        command: "enfilade train rooms.csv --algorithm tree -o \"a b.model.json\"".to_owned(),
        program: "0.1.0".to_owned(),
        seed: 1,
        licence: "MIT: nobody's rooms, ünbekannt".to_owned(),
        data: DataSummary::of(rows, &table),
        scores: vec![ScoreSummary::of(&validated.scores, Grouping::Room, 1)],
        learned: None,
    }
}

#[test]
fn model_files_survive_reading_and_writing() {
    let rows = generated_rows(240, 5);
    let table = table(&rows);
    let about = about(&rows);
    for algorithm in Algorithm::ALL {
        let classifier = trained(algorithm, &table, 3);
        let bytes = to_bytes(&classifier.clone().into(), &about);
        let (again, about_again) = from_bytes(&bytes).expect("its own file");
        assert_eq!(about_again, about, "{algorithm}");
        assert_eq!(String::from_utf8(to_bytes(&again, &about_again)), String::from_utf8(bytes), "{algorithm}");
        let PlanClassifier::Each(again) = again else { panic!("{algorithm} became a joint classifier") };
        for row in generated_rows(100, 6) {
            let values = row.features.values();
            assert_eq!(again.explain(&values), classifier.explain(&values), "{algorithm}");
        }
    }
}

/// A small model whose file one can read. Versions that were released stay readable: the file is
/// committed, and a change that can no longer read it fails here.
#[test]
fn the_committed_model_file_stays_readable() {
    let rows = generated_rows(60, 7);
    let path = fixture("tree.model.json");
    let classifier = trained(algorithm("tree"), &table(&rows), 1).into();
    support::assert_text(&path, &String::from_utf8(to_bytes(&classifier, &about(&rows))).unwrap());
    let (read, _) = from_bytes(&std::fs::read(path).unwrap()).expect("a released version");
    assert_eq!(read.method(), Method::Each(algorithm("tree")));
}

/// The content of a model file with its checksum made to fit again, as a careless editor's script
/// might leave it.
fn with_fitting_checksum(text: &str) -> Vec<u8> {
    let mut value: serde_json::Value = serde_json::from_str(text).unwrap();
    let members = value.as_object_mut().unwrap();
    members.shift_remove("checksum");
    let checksum = format!("{:016x}", hash::fnv1a(hash::START, value.to_string().into_bytes()));
    value.as_object_mut().unwrap().insert("checksum".to_owned(), checksum.into());
    value.to_string().into_bytes()
}

#[test]
fn files_that_are_no_sound_model_are_refused_with_a_reason() {
    let rows = generated_rows(120, 8);
    let file =
        |algorithm| String::from_utf8(to_bytes(&trained(algorithm, &table(&rows), 1).into(), &about(&rows))).unwrap();
    let [rules, tree, knn, mlp] = ["rules", "tree", "knn", "mlp"].map(|id| file(algorithm(id)));
    let half = &tree[..tree.len() / 2];
    let replaced = |text: &str, from: &str, to: &str| {
        assert!(text.contains(from), "{from} is not in the file");
        text.replacen(from, to, 1)
    };
    let edited = |text: &str, from: &str, to: &str| with_fitting_checksum(&replaced(text, from, to));
    let cases: Vec<(&str, Vec<u8>)> = vec![
        ("empty", Vec::new()),
        ("only spaces", b" \n\t\n".to_vec()),
        ("not text", vec![0, 159, 146, 150, 0xff]),
        ("not JSON", b"label,a,rt\nS,1,1\n".to_vec()),
        ("cut in half", half.as_bytes().to_vec()),
        ("a JSON list", b"[1, 2]".to_vec()),
        ("a plan", std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/plans/dwelling.plan.json")).unwrap()),
        ("a newer version", replaced(&tree, "\"version\": 1", "\"version\": 7").into_bytes()),
        ("version nought", replaced(&tree, "\"version\": 1", "\"version\": 0").into_bytes()),
        ("no version", replaced(&tree, "\"version\": 1,\n", "").into_bytes()),
        ("a threshold changed", replaced(&tree, "\"at_most\":", "\"at_most\":1").into_bytes()),
        ("no checksum", replaced(&tree, "\"checksum\"", "\"sum\"").into_bytes()),
        ("deeply nested", "[".repeat(100_000).into_bytes()),
        ("unknown algorithm", edited(&tree, "\"algorithm\": \"tree\"", "\"algorithm\": \"forest\"")),
        ("another algorithm's model", edited(&tree, "\"algorithm\": \"tree\"", "\"algorithm\": \"rules\"")),
        ("a tree that runs in circles", edited(&tree, "\"then\":[1,", "\"then\":[0,")),
        ("a tree that leads nowhere", edited(&tree, "\"then\":[1,", "\"then\":[9999,")),
        ("unknown feature", edited(&tree, "\"feature\":\"", "\"feature\":\"colour of ")),
        (
            "a last rule with a condition",
            edited(&rules, "{\"if\":[],", "{\"if\":[{\"feature\":\"a\",\"at_most\":1.0}],"),
        ),
        ("no neighbour", {
            let from = knn.find("\"rooms\": [\n").unwrap();
            let to = from + knn[from..].find("\n]").unwrap();
            with_fitting_checksum(&format!("{}\"rooms\": [{}", &knn[..from], &knn[to..]))
        }),
        ("a neighbour of no plan", edited(&knn, "\"plans\": [", "\"plans\": [], \"were\": [")),
        ("a deviation of nought", {
            let from = mlp.find("\"deviations\":[").unwrap() + "\"deviations\":[".len();
            let to = from + mlp[from..].find(',').unwrap();
            with_fitting_checksum(&format!("{}0.0{}", &mlp[..from], &mlp[to..]))
        }),
        ("a unit too few", {
            let from = mlp.find("{\"from\"").unwrap();
            let to = from + mlp[from..].find('\n').unwrap() + 1;
            with_fitting_checksum(&format!("{}{}", &mlp[..from], &mlp[to..]))
        }),
    ];
    let mut said = String::new();
    for (case, bytes) in &cases {
        let error = from_bytes(bytes).expect_err(case);
        let _ = writeln!(said, "{case}:\n    FILE: {error}");
    }
    support::assert_text(&fixture("refused.txt"), &said);
}

#[test]
fn no_cut_and_no_flipped_bit_gets_through() {
    let rows = generated_rows(80, 9);
    let bytes = to_bytes(&trained(algorithm("rules"), &table(&rows), 1).into(), &about(&rows));
    let (whole, about_whole) = from_bytes(&bytes).expect("its own file");
    // The last bytes are a brace and the end of the line.
    for end in 0..bytes.len() - 2 {
        assert!(from_bytes(&bytes[..end]).is_err(), "cut to {end} bytes");
    }
    for place in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (place % 8);
        // What still reads must mean the same: spaces between the parts say nothing.
        if let Ok((classifier, about)) = from_bytes(&changed) {
            assert_eq!(to_bytes(&classifier, &about), to_bytes(&whole, &about_whole), "byte {place}");
        }
    }
}

#[test]
fn a_model_file_may_be_indented_anew_and_begin_with_a_mark() {
    let rows = generated_rows(80, 9);
    let bytes = to_bytes(&trained(algorithm("knn"), &table(&rows), 1).into(), &about(&rows));
    let value: serde_json::Value = serde_json::from_slice(&bytes).unwrap();
    let pretty = format!("\u{feff}{}", serde_json::to_string_pretty(&value).unwrap());
    let (classifier, about) = from_bytes(pretty.as_bytes()).expect("only the layout differs");
    assert_eq!(to_bytes(&classifier, &about), bytes);
}

// Explanations.

#[test]
fn explanations_agree_with_predictions() {
    let rows = generated_rows(400, 11);
    let table = table(&rows);
    for algorithm in Algorithm::ALL {
        let classifier = trained(algorithm, &table, 1);
        for row in generated_rows(200, 12) {
            let values = row.features.values();
            let explanation = classifier.explain(&values);
            let predicted = classifier.predict(&values);
            assert_eq!(explanation.label, predicted.label());
            assert_eq!(explanation.probability(), predicted.probability(predicted.label()));
            match &explanation.reason {
                Reason::Rule(reason) => assert!((1..=reason.rules).contains(&reason.number)),
                Reason::Path(reason) => {
                    for step in &reason.steps {
                        assert_eq!(values[step.feature] <= step.at_most, step.yes);
                    }
                    assert!(reason.right * 5 >= reason.rooms, "the label given is a most frequent one");
                }
                Reason::Neighbours(reason) => {
                    let distances: Vec<f64> = reason.neighbours.iter().map(|near| near.distance).collect();
                    assert!(distances.is_sorted(), "{distances:?}");
                }
                Reason::Features(reason) => assert_eq!(reason.effects.len(), FEATURES),
            }
        }
    }
}

// Bad data.

/// Trains every algorithm, asks it about all rooms and a few odd ones, and writes and reads its file.
fn assert_survives(table: &Table, context: &str) {
    let odd = [[0.0; FEATURES], [f64::NAN; FEATURES], [f64::INFINITY; FEATURES], [-1.0; FEATURES], [1e300; FEATURES]];
    for algorithm in Algorithm::ALL {
        let classifier = trained(algorithm, table, 1);
        for values in table.values().iter().chain(&odd) {
            assert_is_distribution(&classifier.predict(values), &format!("{context}, {algorithm}, {values:?}"));
            let words = classifier.explain(values).why(Units::Metric).sentences();
            assert!(words.ends_with('.'), "{context}, {algorithm}: {words}");
        }
        let about = About { data: DataSummary::of(&[], table), scores: Vec::new(), ..about(&generated_rows(40, 1)) };
        let bytes = to_bytes(&classifier.into(), &about);
        let (again, _) = from_bytes(&bytes).unwrap_or_else(|error| panic!("{context}, {algorithm}: {error}"));
        assert_eq!(to_bytes(&again, &about), bytes, "{context}, {algorithm}");
    }
}

#[test]
fn little_or_dull_data_trains_to_something_sensible() {
    let room = [12.0, 1.5, 2.0, 0.0, 1.0, 0.0, 1.0, 0.0];
    let bigger = [40.0, 1.5, 2.0, 0.0, 1.0, 0.0, 1.0, 0.0];
    let one_label = table_of(&[(room, Label::MediumRoom); 50]);
    assert_survives(&one_label, "one label only");
    let constant: Vec<(Values, Label)> =
        (0..100).map(|index| (room, if index % 4 == 0 { Label::Hall } else { Label::SmallRoom })).collect();
    let constant = table_of(&constant);
    assert_survives(&constant, "constant features");
    for algorithm in Algorithm::ALL {
        let certain = trained(algorithm, &one_label, 1).predict(&room);
        assert_eq!(certain.label(), Label::MediumRoom, "{algorithm}");
        // What cannot be told apart gets the labels' shares.
        let share = trained(algorithm, &constant, 1).predict(&room).probability(Label::SmallRoom);
        assert!((share - 0.75).abs() < 0.1, "{algorithm}: {share}");
    }
    assert_survives(&table_of(&[(room, Label::Hall)]), "one room");
    let three = [(room, Label::SmallRoom), (bigger, Label::BigRoom), (bigger, Label::Hall)];
    assert_survives(&table_of(&three), "three rooms");
    let five: Vec<(Values, Label)> = Label::ALL.map(|label| (room, label)).to_vec();
    assert_survives(&table_of(&five), "one room a label, all alike");
    let huge = [(room, Label::SmallRoom), ([1e300; FEATURES], Label::Hall), ([f64::MAX; FEATURES], Label::Hall)];
    assert_survives(&table_of(&huge.repeat(20)), "numbers near the largest");
    let tiny: Vec<(Values, Label)> = (0..60)
        .map(|index| ([f64::MIN_POSITIVE * f64::from(index); FEATURES], Label::ALL[index as usize % 5]))
        .collect();
    assert_survives(&table_of(&tiny), "numbers near nought");
}

#[test]
fn bad_tables_are_refused_with_a_reason() {
    let rows = generated_rows(3, 1);
    let mut said = String::new();
    let mut say = |case: &str, error: String| {
        let _ = writeln!(said, "{case}:\n    {error}");
    };
    say("no rows", Table::from_rows(&[]).expect_err("no rows").to_string());
    for value in [f64::NAN, f64::INFINITY, -4.0] {
        let mut rows = rows.clone();
        rows[1].features.area_m2 = value;
        say(&format!("an area of {value}"), Table::from_rows(&rows).expect_err("a bad value").to_string());
        rows[2].features.axes_ratio = value;
        say(&format!("twice {value}"), Table::from_rows(&rows).expect_err("bad values").to_string());
    }
    say("ten folds", Folds::new(&rows, Grouping::Room, 10, 1).expect_err("too few rooms").to_string());
    say("folds by building", Folds::new(&rows, Grouping::Building, 2, 1).expect_err("one building").to_string());
    say("one fold", Folds::new(&rows, Grouping::Room, 1, 1).expect_err("one fold").to_string());
    let head = "label,a,rt,d,l_S,l_M,l_B,l_C,l_H\n";
    for (case, text) in [
        ("an empty file", String::new()),
        ("a missing column", "label,a,rt,d,l_S,l_M,l_B,l_C\n".to_owned()),
        ("an unknown label", format!("{head}S,1,1,0,0,0,0,0,0\nkitchen,1,1,0,0,0,0,0,0\n")),
        ("an infinite area", format!("{head}S,inf,1,0,0,0,0,0,0\n")),
        ("a word for a number", format!("{head}S,12 m²,1,0,0,0,0,0,0\n")),
        ("a missing number", format!("{head}S,12,1,,0,0,0,0,0\n")),
        ("half an opening", format!("{head}S,12,1,0.5,0,0,0,0,0\n")),
        ("a cell too few", format!("{head}S,12,1\n")),
    ] {
        say(case, csv::read(text.as_bytes()).expect_err(case).to_string());
    }
    assert_eq!(csv::read(head.as_bytes()), Ok(Vec::new()));
    support::assert_text(&fixture("bad_tables.txt"), &said);
}

/// Tables as spreadsheets write them.
#[test]
fn tables_of_spreadsheets_are_read_and_their_lines_counted() {
    let read = |name: &str| csv::read(std::fs::File::open(fixture(&format!("tables/{name}"))).expect(name));
    let rows = read("semicolons.csv").expect("a table");
    assert_eq!((rows.len(), rows[0].features.area_m2, rows[0].features.axes_ratio), (1, 12.0, 1.2));
    let error = read("crlf_wrong_label_on_line_3.csv").expect_err("Q is no label");
    assert!(error.to_string().starts_with("line 3: column 'label': unknown label 'Q'"), "{error}");
}

#[test]
fn columns_of_unequal_length_are_cut_to_the_shortest() {
    let source = RoomSource { plan: Arc::from("p"), room: Arc::from("r") };
    let table = Table::from_columns(vec![[1.0; FEATURES]; 3], vec![Label::Hall; 2], vec![source; 4]).expect("rows");
    assert_eq!(table.len(), 2);
}

/// Far more rooms than any study has: the same code a million rooms take (docs/classifiers.md), at a
/// size that stays fast.
#[test]
fn a_large_table_trains() {
    let rows = generated_rows(20_000, 13);
    let large = table(&rows);
    let fresh = table(&generated_rows(1_000, 14));
    for algorithm in Algorithm::ALL {
        let accuracy = test(&trained(algorithm, &large, 1), &fresh).scores.accuracy;
        assert!(accuracy > 0.6, "{algorithm}: {accuracy}");
    }
}

/// A feature's value: usual, odd, or at the end of what numbers can be.
fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (0u32..6).prop_map(f64::from),
        4 => 0.0..200.0,
        1 => Just(0.0),
        1 => Just(f64::MAX),
        1 => Just(f64::MIN_POSITIVE),
    ]
}

fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![3 => value(), 1 => any::<f64>()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever a classifier learned from and whatever it is asked, it answers with a distribution
    /// and a reason.
    #[test]
    fn every_answer_is_a_distribution(
        rooms in prop::collection::vec((prop::array::uniform8(value()), 0usize..5), 1..70),
        questions in prop::collection::vec(prop::array::uniform8(any_value()), 1..8),
        seed in any::<u64>(),
    ) {
        let rooms: Vec<(Values, Label)> = rooms.into_iter().map(|(values, label)| (values, Label::ALL[label])).collect();
        let table = table_of(&rooms);
        for algorithm in Algorithm::ALL {
            let classifier = trained(algorithm, &table, seed);
            for values in questions.iter().chain(table.values()) {
                assert_is_distribution(&classifier.predict(values), algorithm.name());
                prop_assert!(classifier.explain(values).why(Units::Metric).sentences().ends_with('.'));
            }
        }
    }

    /// Every room is predicted once, and every figure counts it once.
    #[test]
    fn every_fold_is_predicted_by_the_others(rooms in 20usize..80, folds in 2usize..6, seed in any::<u64>()) {
        let rows = generated_rows(rooms, seed);
        let table = table(&rows);
        let folds = Folds::new(&rows, Grouping::Room, folds, seed).expect("enough rooms");
        let validated = evaluate(&table, &folds, algorithm("rules"), seed, &Work::quiet().on_threads(1)).expect("done");
        prop_assert_eq!(validated.predictions.len(), rooms);
        prop_assert_eq!(validated.scores.rooms, rooms);
        prop_assert_eq!(validated.scores.confusion.rooms(), rooms);
        prop_assert_eq!(validated.scores.reliability.iter().map(|bin| bin.rooms).sum::<usize>(), rooms);
        for prediction in &validated.predictions {
            assert_is_distribution(prediction, "fold");
        }
    }
}
