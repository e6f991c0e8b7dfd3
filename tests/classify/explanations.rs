//! Why a room got its label: the sentences, from reasons written down here; and the predictions of each
//! algorithm for obvious rooms.

use std::sync::Arc;

use enfilade::classify::explain::{
    Effect, Explanation, FeaturesReason, NearRoom, NeighboursReason, PathReason, Reason, RuleReason,
};
use enfilade::classify::learners::rules::{Bound, Condition};
use enfilade::dataset::table::{RoomSource, Values};
use enfilade::labels::Label::{self, BigRoom, Corridor, Hall, MediumRoom, SmallRoom};

use super::generated::generated_rows;
use super::{table, table_of, trained};

const AREA: usize = 0;
const RATIO: usize = 1;
const OPENINGS: usize = 2;
const TO_BIG: usize = 5;
const TO_HALLS: usize = 7;

fn at_most(feature: usize, bound: f64) -> Condition {
    Condition { feature, bound: Bound::AtMost(bound) }
}

fn at_least(feature: usize, bound: f64) -> Condition {
    Condition { feature, bound: Bound::AtLeast(bound) }
}

fn over(feature: usize, bound: f64) -> Condition {
    Condition { feature, bound: Bound::Over(bound) }
}

fn words(label: Label, reason: Reason) -> String {
    Explanation { label, probability: 0.96, reason }.words()
}

#[test]
fn a_rule_in_words() {
    let said = |label, conditions: &[Condition], number, rules, decides, right| {
        words(label, Reason::Rule(RuleReason { number, rules, conditions: conditions.to_vec(), decides, right }))
    };
    assert_eq!(
        said(BigRoom, &[at_least(AREA, 73.0), at_least(RATIO, 1.42), at_most(RATIO, 1.93)], 2, 7, 31, 25),
        "Rule 2 of 7: area at least 73 m² and axes ratio from 1.42 to 1.93 means big room. It decides 31 training \
         rooms, 25 of them rightly."
    );
    assert_eq!(
        said(Hall, &[at_most(RATIO, 3.0), at_least(OPENINGS, 5.0)], 1, 7, 28, 28),
        "Rule 1 of 7: axes ratio at most 3 and at least 5 openings means hall. It decides 28 training rooms, all of \
         them rightly."
    );
    assert_eq!(
        said(SmallRoom, &[], 7, 7, 146, 136),
        "None of the 6 rules before applies, so it is a small room. It decides 146 training rooms, 136 of them rightly."
    );
    assert_eq!(
        said(SmallRoom, &[], 2, 2, 1, 1),
        "The one rule before does not apply, so it is a small room. It decides one training room, rightly."
    );
    assert_eq!(
        said(Hall, &[], 1, 1, 1, 0),
        "The only rule: every room is a hall. It decides one training room, wrongly."
    );
    assert_eq!(
        said(Hall, &[at_most(OPENINGS, 0.0)], 1, 2, 0, 0),
        "Rule 1 of 2: no openings means hall. It decides no training room."
    );
}

#[test]
fn a_path_in_words() {
    let said = |label, conditions: &[Condition], rooms, right| {
        words(label, Reason::Path(PathReason { steps: Vec::new(), conditions: conditions.to_vec(), rooms, right }))
    };
    assert_eq!(
        said(
            MediumRoom,
            &[over(AREA, 33.6), at_most(RATIO, 1.3), at_most(OPENINGS, 2.0), at_most(TO_BIG, 0.0), over(TO_HALLS, 0.0)],
            61,
            40
        ),
        "Of the 61 training rooms with area over 33.6 m², axes ratio at most 1.3, at most 2 openings, no openings to \
         big rooms and at least 1 opening to halls, 40 are medium rooms."
    );
    assert_eq!(
        said(Corridor, &[over(AREA, 4.8), at_most(AREA, 33.6), over(OPENINGS, 2.0), at_most(OPENINGS, 4.0)], 52, 52),
        "All 52 training rooms with area from 4.8 m² to 33.6 m² and 3 to 4 openings are corridors."
    );
    assert_eq!(
        said(Hall, &[over(OPENINGS, 2.0), at_most(OPENINGS, 3.0)], 3, 1),
        "Of the 3 training rooms with exactly 3 openings, one is a hall."
    );
    assert_eq!(said(Hall, &[over(RATIO, 3.2)], 1, 1), "The only training room with axes ratio over 3.2 is a hall.");
    assert_eq!(said(Hall, &[], 20, 20), "All 20 training rooms are halls.");
}

#[test]
fn neighbours_in_words() {
    let near = |label, plan: &str, room: &str, area: f64, openings: f64| NearRoom {
        source: RoomSource { plan: Arc::from(plan), room: Arc::from(room) },
        label,
        values: [area, 1.0, openings, 0.0, 0.0, 0.0, 0.0, 0.0],
        distance: 0.1,
    };
    let said = |label, neighbours: Vec<NearRoom>| words(label, Reason::Neighbours(NeighboursReason { neighbours }));
    let gym = || near(BigRoom, "School 4", "Gym", 120.4, 3.0);
    let class = || near(MediumRoom, "School 1", "Room 18", 52.51, 1.0);
    assert_eq!(
        said(BigRoom, vec![gym()]),
        "The most similar training room is a big room: Gym in School 4 (120 m², 3 openings)."
    );
    assert_eq!(
        said(MediumRoom, vec![class(), gym(), gym()]),
        "Of the 3 most similar training rooms one is a medium room: Room 18 in School 1 (52.5 m², 1 opening)."
    );
    assert_eq!(
        said(BigRoom, vec![class(), gym(), gym(), gym(), gym()]),
        "Of the 5 most similar training rooms 4 are big rooms, the nearest of them Gym in School 4 (120 m², 3 \
         openings); Gym in School 4 (120 m², 3 openings); Gym in School 4 (120 m², 3 openings)."
    );
    // Of an id that programs gave a room the first part is said.
    let unnamed = near(BigRoom, "School 4", "0f3a7c52-1111-4222-8333-444455556666", 9.0, 0.0);
    assert_eq!(
        said(BigRoom, vec![unnamed.clone(), unnamed]),
        "All 2 most similar training rooms are big rooms: room 0f3a7c52 in School 4 (9 m², no openings); room 0f3a7c52 \
         in School 4 (9 m², no openings)."
    );
}

#[test]
fn features_in_words() {
    let effect = |feature, value, typical, probability_if_typical| Effect {
        feature,
        value,
        typical,
        probability_if_typical,
        label_if_typical: MediumRoom,
    };
    let said = |effects: &[Effect]| words(BigRoom, Reason::Features(FeaturesReason { effects: effects.to_vec() }));
    assert_eq!(
        said(&[effect(AREA, 190.0, 43.6, 0.38), effect(OPENINGS, 3.0, 1.0, 0.77), effect(RATIO, 1.5, 1.59, 0.95)]),
        "What speaks for a big room: an area of 190 m² (with the typical 43.6 m² the probability would be 38 %, not \
         96 %); 3 openings (with the typical 1 the probability would be 77 %, not 96 %)."
    );
    assert_eq!(
        said(&[effect(OPENINGS, 0.0, 1.0, 0.004)]),
        "What speaks for a big room: no openings (with the typical 1 the probability would be under 1 %, not 96 %)."
    );
    assert_eq!(
        said(&[effect(RATIO, 1.5, 1.59, 0.95)]),
        "No single feature decides: with any one at its typical value a big room is as likely."
    );
}

/// Area, axes ratio, openings, and openings to small, medium and big rooms, corridors and halls.
const CUPBOARD: Values = [3.2, 1.4, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const CLASSROOM: Values = [55.25, 1.25, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const GYMNASIUM: Values = [190.0, 1.5, 3.0, 1.0, 0.0, 0.0, 2.0, 0.0];
const LONG_CORRIDOR: Values = [72.5, 9.5, 11.0, 3.0, 6.0, 1.0, 0.0, 1.0];
const ENTRANCE_HALL: Values = [240.0, 1.8, 8.0, 2.0, 2.0, 0.0, 4.0, 0.0];

/// Any of the algorithms knows a cupboard, a classroom, a long corridor and an entrance hall for sure; a
/// gymnasium only just, for a few halls are as large and nearly as open; and what is said is how it was learned.
#[test]
fn explanations_read_well() {
    let rows = generated_rows(400, 10);
    let table = table(&rows);
    let forms: [(&str, &[&str]); 4] = [
        ("rules", &["Rule ", "None of the "]),
        ("tree", &["All ", "Of the "]),
        ("knn", &["All 9 most similar ", "Of the 9 most similar "]),
        ("mlp", &["What speaks for a ", "No single feature decides"]),
    ];
    for (algorithm, forms) in forms {
        let classifier = trained(algorithm.parse().unwrap(), &table, 1);
        let sure = [(CUPBOARD, SmallRoom), (CLASSROOM, MediumRoom), (LONG_CORRIDOR, Corridor), (ENTRANCE_HALL, Hall)];
        for (values, label) in sure {
            let explanation = classifier.explain(&values);
            assert_eq!(explanation.label, label, "{algorithm}: {values:?}");
            assert!(explanation.probability > 0.85, "{algorithm}, {label}: {}", explanation.probability);
            let words = explanation.words();
            assert!(forms.iter().any(|form| words.starts_with(form)) && words.ends_with('.'), "{algorithm}: {words}");
            assert!(words.contains(label.name()), "{algorithm}: {words}");
        }
        let gymnasium = classifier.explain(&GYMNASIUM);
        assert!(matches!(gymnasium.label, BigRoom | Hall), "{algorithm}: {}", gymnasium.label);
        let least = if gymnasium.label == BigRoom { 0.45 } else { 0.3 };
        assert!(gymnasium.probability > least, "{algorithm}: {}", gymnasium.probability);
    }
    // Each says what decided: the corridor's shape, the cupboard's area.
    let said =
        |algorithm: &str, values: &Values| trained(algorithm.parse().unwrap(), &table, 1).explain(values).words();
    for (algorithm, shape) in [
        ("rules", "axes ratio at least 3"),
        ("tree", "axes ratio over 3"),
        ("mlp", "an axes ratio of 9.5 (with the typical 1."),
    ] {
        let words = said(algorithm, &LONG_CORRIDOR);
        assert!(words.contains(shape), "{algorithm}: {words}");
    }
    let cupboard = said("mlp", &CUPBOARD);
    assert!(cupboard.starts_with("What speaks for a small room: an area of 3.2 m² (with the typical 4"), "{cupboard}");
}

/// Learned from halls alone, everything is a hall, and each algorithm says so.
#[test]
fn explanations_where_there_is_nothing_to_tell_apart() {
    let halls = table_of(&[([100.0, 1.5, 4.0, 0.0, 0.0, 0.0, 4.0, 0.0], Hall); 20]);
    for (algorithm, words) in [
        ("rules", "The only rule: every room is a hall. It decides 20 training rooms, all of them rightly."),
        ("tree", "All 20 training rooms are halls."),
        ("knn", "The most similar training room is a hall: 0 in p0 (100 m², 4 openings)."),
        ("mlp", "No single feature decides: with any one at its typical value a hall is as likely."),
    ] {
        assert_eq!(trained(algorithm.parse().unwrap(), &halls, 1).explain(&CUPBOARD).words(), words, "{algorithm}");
    }
}
