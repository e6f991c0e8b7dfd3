//! Why a room got its label: the sentences, from reasons written down here; and the predictions of each
//! algorithm for obvious rooms.

use std::sync::Arc;

use enfilade::base::units::Units;
use enfilade::classify::Distribution;
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
const TO_CORRIDORS: usize = 6;
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

/// Of a room of 82 m², 1.5 times as long as wide, with 3 openings, one of them to a corridor.
const VALUES: Values = [82.0, 1.5, 3.0, 0.0, 0.0, 0.0, 1.0, 0.0];

fn words_in(units: Units, label: Label, values: Values, reason: Reason) -> String {
    let weights = Label::ALL.map(|other| if other == label { 0.96 } else { 0.01 });
    Explanation { label, distribution: Distribution::from_weights(weights), values, reason }.why(units).sentences()
}

fn words(label: Label, reason: Reason) -> String {
    words_in(Units::Metric, label, VALUES, reason)
}

#[test]
fn a_rule_in_words() {
    let rule = |conditions: &[Condition], number, rules, decides, right| {
        Reason::Rule(RuleReason { number, rules, conditions: conditions.to_vec(), decides, right })
    };
    let said = |label, conditions: &[Condition], number, rules, decides, right| {
        words(label, rule(conditions, number, rules, decides, right))
    };
    let large = [at_least(AREA, 73.0), at_least(RATIO, 1.42), at_most(RATIO, 1.93)];
    assert_eq!(
        said(BigRoom, &large, 2, 7, 31, 25),
        "What was seen: 82 m² along axes (at least 73 m²); 1.5 times as long as wide (1.42 to 1.93). Of the 31 rooms like this \
         that the model learned from, 25 are big rooms."
    );
    assert_eq!(
        words_in(Units::Imperial, BigRoom, VALUES, rule(&large, 2, 7, 31, 25)),
        "What was seen: 883 sq ft along axes (at least 786 sq ft); 1.5 times as long as wide (1.42 to 1.93). Of the 31 rooms like \
         this that the model learned from, 25 are big rooms."
    );
    assert_eq!(
        said(Hall, &[at_most(RATIO, 3.0), at_least(OPENINGS, 2.0)], 1, 7, 28, 28),
        "What was seen: 1.5 times as long as wide (at most 3); 3 openings (at least 2). All 28 rooms like this that the \
         model learned from are halls."
    );
    assert_eq!(
        said(SmallRoom, &[], 7, 7, 1460, 136),
        "None of the 6 rules for other labels applies. Of the 1\u{a0}460 rooms left over that the model learned from, \
         136 are small rooms."
    );
    assert_eq!(
        said(SmallRoom, &[], 2, 2, 1, 1),
        "The only rule for other labels does not apply. The only room left over that the model learned from is a small \
         room."
    );
    assert_eq!(said(Hall, &[], 1, 1, 1, 0), "The only room that the model learned from is no hall.");
    assert_eq!(
        said(Hall, &[at_most(TO_HALLS, 0.0)], 1, 2, 0, 0),
        "What was seen: no openings to halls. The model learned from no room like this."
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
            &[
                over(AREA, 33.6),
                at_most(RATIO, 1.6),
                at_most(OPENINGS, 4.0),
                at_most(TO_BIG, 0.0),
                over(TO_CORRIDORS, 0.0)
            ],
            61,
            40
        ),
        "What was seen: 82 m² along axes (over 33.6 m²); 1.5 times as long as wide (at most 1.6); 3 openings (at most 4); no \
         openings to big rooms; 1 opening to corridors (at least 1). Of the 61 rooms like this that the model learned \
         from, 40 are medium rooms."
    );
    assert_eq!(
        said(Corridor, &[over(AREA, 4.8), at_most(AREA, 93.6), over(OPENINGS, 2.0), at_most(OPENINGS, 4.0)], 52, 52),
        "What was seen: 82 m² along axes (4.8 m² to 93.6 m²); 3 openings (3 to 4). All 52 rooms like this that the model learned \
         from are corridors."
    );
    assert_eq!(
        said(Hall, &[over(OPENINGS, 2.0), at_most(OPENINGS, 3.0)], 3, 1),
        "What was seen: 3 openings (exactly 3). Of the 3 rooms like this that the model learned from, one is a hall."
    );
    assert_eq!(said(Hall, &[], 20, 20), "All 20 rooms that the model learned from are halls.");
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
    let seen = "What was seen: 82 m² along axes; 1.5 times as long as wide; 3 openings: 1 to corridors.";
    assert_eq!(
        said(BigRoom, vec![gym()]),
        format!(
            "{seen} The most similar room that the model learned from is a big room: Gym in School 4 (120 m², 3 openings)."
        )
    );
    assert_eq!(
        said(MediumRoom, vec![class(), gym(), gym()]),
        format!(
            "{seen} Of the 3 most similar rooms that the model learned from, one is a medium room: Room 18 in School 1 \
             (52.5 m², 1 opening)."
        )
    );
    assert_eq!(
        said(BigRoom, vec![class(), gym(), gym(), gym(), gym()]),
        format!(
            "{seen} Of the 5 most similar rooms that the model learned from, 4 are big rooms, the nearest: Gym in School 4 \
             (120 m², 3 openings); Gym in School 4 (120 m², 3 openings); Gym in School 4 (120 m², 3 openings)."
        )
    );
    // An id that a program gave a room says nothing to people.
    let unnamed = near(BigRoom, "School 4", "0f3a7c52-1111-4222-8333-444455556666", 9.0, 0.0);
    assert_eq!(
        said(BigRoom, vec![unnamed.clone(), unnamed]),
        format!(
            "{seen} All 2 most similar rooms that the model learned from are big rooms: a room in School 4 (9 m², no \
             openings); a room in School 4 (9 m², no openings)."
        )
    );
}

#[test]
fn features_in_words() {
    // Without the feature, a big room would be so much less likely, and a medium room so much more.
    let effect = |feature, typical, less: f64| Effect {
        feature,
        value: VALUES[feature],
        typical,
        if_typical: Distribution::from_weights([0.01, 0.01 + less, 0.96 - less, 0.01, 0.01]),
    };
    let said = |effects: &[Effect]| words(BigRoom, Reason::Features(FeaturesReason { effects: effects.to_vec() }));
    assert_eq!(
        said(&[effect(AREA, 43.6, 0.58), effect(OPENINGS, 1.0, 0.19), effect(RATIO, 1.59, 0.01)]),
        "Strong sign of a big room: 82 m² along axes (usual: 43.6 m²). Clear sign of a big room: 3 openings (usual: 1)."
    );
    let against =
        Effect { if_typical: Distribution::from_weights([0.01, 0.01, 0.96, 0.01, 0.01]), ..effect(RATIO, 1.59, 0.0) };
    let said_of_one = |effect: Effect, said: [f64; 5]| {
        let reason = Reason::Features(FeaturesReason { effects: vec![effect] });
        let distribution = Distribution::from_weights(said);
        Explanation { label: BigRoom, distribution, values: VALUES, reason }.why(Units::Metric).sentences()
    };
    assert_eq!(
        said_of_one(against, [0.01, 0.01, 0.7, 0.27, 0.01]),
        "But a clear sign of a corridor: 1.5 times as long as wide (usual: 1.59)."
    );
    assert_eq!(said(&[effect(RATIO, 1.59, 0.01)]), "Nothing stands out: no single trait makes it a big room.");
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
        ("rules", &["What was seen: ", "None of the "]),
        ("tree", &["What was seen: "]),
        ("knn", &["What was seen: "]),
        ("mlp", &["Strong sign", "Clear sign", "Slight sign", "But a", "Nothing stands out: "]),
    ];
    for (algorithm, forms) in forms {
        let classifier = trained(algorithm.parse().unwrap(), &table, 1);
        let sure = [(CUPBOARD, SmallRoom), (CLASSROOM, MediumRoom), (LONG_CORRIDOR, Corridor), (ENTRANCE_HALL, Hall)];
        for (values, label) in sure {
            let explanation = classifier.explain(&values);
            assert_eq!(explanation.label, label, "{algorithm}: {values:?}");
            assert!(explanation.probability() > 0.85, "{algorithm}, {label}: {}", explanation.probability());
            let words = explanation.why(Units::Metric).sentences();
            assert!(forms.iter().any(|form| words.starts_with(form)) && words.ends_with('.'), "{algorithm}: {words}");
            assert!(words.contains(label.name()), "{algorithm}: {words}");
        }
        let gymnasium = classifier.explain(&GYMNASIUM);
        assert!(matches!(gymnasium.label, BigRoom | Hall), "{algorithm}: {}", gymnasium.label);
        let least = if gymnasium.label == BigRoom { 0.45 } else { 0.3 };
        assert!(gymnasium.probability() > least, "{algorithm}: {}", gymnasium.probability());
    }
    // Each says what decided: the corridor's shape, the cupboard's area.
    let said = |algorithm: &str, values: &Values| {
        trained(algorithm.parse().unwrap(), &table, 1).explain(values).why(Units::Metric).sentences()
    };
    for (algorithm, shape) in [
        ("rules", "9.5 times as long as wide (at least 3"),
        ("tree", "9.5 times as long as wide (over 3"),
        ("mlp", "9.5 times as long as wide (usual: 1."),
    ] {
        let words = said(algorithm, &LONG_CORRIDOR);
        assert!(words.contains(shape), "{algorithm}: {words}");
    }
    let cupboard = said("mlp", &CUPBOARD);
    assert!(cupboard.starts_with("Strong sign of a small room: 3.2 m² along axes (usual: 4"), "{cupboard}");
}

/// Learned from halls alone, everything is a hall, and each algorithm says so.
#[test]
fn explanations_where_there_is_nothing_to_tell_apart() {
    let halls = table_of(&[([100.0, 1.5, 4.0, 0.0, 0.0, 0.0, 4.0, 0.0], Hall); 20]);
    let seen = "What was seen: 3.2 m² along axes; 1.4 times as long as wide; 1 opening: 1 to corridors.";
    let nearest = format!(
        "{seen} The most similar room that the model learned from is a hall: a room in p0 (100 m², 4 openings)."
    );
    for (algorithm, words) in [
        ("rules", "All 20 rooms that the model learned from are halls."),
        ("tree", "All 20 rooms that the model learned from are halls."),
        ("knn", nearest.as_str()),
        ("mlp", "Nothing stands out: no single trait makes it a hall."),
    ] {
        let said = trained(algorithm.parse().unwrap(), &halls, 1).explain(&CUPBOARD).why(Units::Metric).sentences();
        assert_eq!(said, words, "{algorithm}");
    }
}
