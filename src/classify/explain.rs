//! Why a room got its label: in data, and in words.

use std::fmt::Write as _;

use super::numbers::{IN_WORDS, percent, value_in_words};
use super::rules::{Bound, Condition};
use super::{Classifier, Model};
use crate::dataset::table::{FEATURES, RoomSource, Values};
use crate::features::Features;
use crate::labels::Label;

/// A prediction with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The label given.
    pub label: Label,
    /// Its probability, 0..=1.
    pub probability: f64,
    pub reason: Reason,
}

/// What a prediction rests on.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    Rule(RuleReason),
    Path(PathReason),
    Neighbours(NeighboursReason),
    Features(FeaturesReason),
}

/// The rule that decided.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleReason {
    /// Its number in the list, from 1.
    pub number: usize,
    /// How many rules the list has.
    pub rules: usize,
    /// What must hold; nothing for the last rule, which takes what no other covers.
    pub conditions: Vec<Condition>,
    /// Training rooms that it decides, and how many of them rightly.
    pub decides: u32,
    pub right: u32,
}

/// The way down the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct PathReason {
    /// The questions from the root on.
    pub steps: Vec<Step>,
    /// What the answers come to: the tightest bounds on each feature.
    pub conditions: Vec<Condition>,
    /// Training rooms in the leaf, and how many of them carry the label given.
    pub rooms: u32,
    pub right: u32,
}

/// A question of the tree and its answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Index of the feature.
    pub feature: usize,
    /// Is it at most this?
    pub at_most: f64,
    pub yes: bool,
}

/// The rooms of the training set that are most alike.
#[derive(Clone, Debug, PartialEq)]
pub struct NeighboursReason {
    /// Nearest first.
    pub neighbours: Vec<NearRoom>,
}

/// A training room near the one in question.
#[derive(Clone, Debug, PartialEq)]
pub struct NearRoom {
    pub source: RoomSource,
    pub label: Label,
    pub values: Values,
    /// How far, in standard deviations.
    pub distance: f64,
}

/// The features that mattered.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturesReason {
    /// By how much each mattered, the most first.
    pub effects: Vec<Effect>,
}

/// What a feature did: the prediction is made again with the feature at its typical value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Index of the feature.
    pub feature: usize,
    pub value: f64,
    /// The median over the training rooms.
    pub typical: f64,
    /// The probability of the label given, if the feature had its typical value.
    pub probability_if_typical: f64,
    /// The label that would then be given.
    pub label_if_typical: Label,
}

impl Classifier {
    /// The prediction for a room and what it rests on.
    pub fn explain(&self, values: &Values) -> Explanation {
        let distribution = self.predict(values);
        let label = distribution.label();
        let probability = distribution.probability(label);
        let reason = match self.model() {
            Model::Rules(model) => {
                let index = model.deciding(values);
                let rule = &model.rules()[index];
                Reason::Rule(RuleReason {
                    number: index + 1,
                    rules: model.rules().len(),
                    conditions: rule.conditions.clone(),
                    decides: rule.counts.iter().sum(),
                    right: rule.counts[label.index()],
                })
            }
            Model::Tree(model) => {
                let path = model.path(values);
                let steps: Vec<Step> = path
                    .iter()
                    .filter_map(|node| node.split)
                    .map(|split| Step {
                        feature: split.feature,
                        at_most: split.at_most,
                        yes: values[split.feature] <= split.at_most,
                    })
                    .collect();
                let counts = path.last().map(|leaf| leaf.counts).unwrap_or_default();
                Reason::Path(PathReason {
                    conditions: tightest(&steps),
                    steps,
                    rooms: counts.iter().sum(),
                    right: counts[label.index()],
                })
            }
            Model::Knn(model) => {
                let table = model.table();
                let neighbours = model.nearest(values);
                let near = neighbours.iter().map(|neighbour| NearRoom {
                    source: table.sources()[neighbour.row].clone(),
                    label: table.labels()[neighbour.row],
                    values: table.values()[neighbour.row],
                    distance: neighbour.distance,
                });
                Reason::Neighbours(NeighboursReason { neighbours: near.collect() })
            }
            Model::Mlp(model) => {
                let effect = |feature: usize| {
                    let mut changed = *values;
                    changed[feature] = model.typical()[feature];
                    let distribution = self.predict(&changed);
                    Effect {
                        feature,
                        value: values[feature],
                        typical: model.typical()[feature],
                        probability_if_typical: distribution.probability(label),
                        label_if_typical: distribution.label(),
                    }
                };
                let mut effects: Vec<Effect> = (0..FEATURES).map(effect).collect();
                effects.sort_by(|p, q| p.probability_if_typical.total_cmp(&q.probability_if_typical));
                Reason::Features(FeaturesReason { effects })
            }
        };
        Explanation { label, probability, reason }
    }
}

/// The bounds that answers come to, in the order of the features; an answer no is 'over'.
fn tightest(steps: &[Step]) -> Vec<Condition> {
    let mut conditions = Vec::new();
    for feature in 0..FEATURES {
        let answers = |yes: bool| {
            steps.iter().filter(move |step| step.feature == feature && step.yes == yes).map(|step| step.at_most)
        };
        if let Some(bound) = answers(false).reduce(f64::max) {
            conditions.push(Condition { feature, bound: Bound::Over(bound) });
        }
        if let Some(bound) = answers(true).reduce(f64::min) {
            conditions.push(Condition { feature, bound: Bound::AtMost(bound) });
        }
    }
    conditions
}

impl Condition {
    /// The condition in words: `area at most 6.2 m²`.
    pub fn words(&self) -> String {
        let name = IN_WORDS[self.feature];
        let counts = self.feature >= 2;
        match self.bound {
            Bound::AtMost(bound) if counts && bound < 1.0 => format!("no {name}"),
            Bound::AtMost(bound) => format!("{name} at most {}", value_in_words(self.feature, bound)),
            Bound::AtLeast(bound) => format!("{name} at least {}", value_in_words(self.feature, bound)),
            Bound::Over(bound) => format!("{name} over {}", value_in_words(self.feature, bound)),
        }
    }

    /// The condition as the paper writes features: `a <= 6.2`.
    pub fn formula(&self) -> String {
        let name = Features::NAMES[self.feature];
        match self.bound {
            Bound::AtMost(bound) => format!("{name} <= {bound}"),
            Bound::AtLeast(bound) => format!("{name} >= {bound}"),
            Bound::Over(bound) => format!("{name} > {bound}"),
        }
    }
}

fn joined(conditions: &[Condition]) -> String {
    let words: Vec<String> = conditions.iter().map(Condition::words).collect();
    words.join(", ")
}

/// Neighbours named in a sentence; more are in the data.
const NAMED: usize = 3;

/// A feature is named in a sentence when without it the probability would be lower by this.
const MATTERS: f64 = 0.05;

impl Explanation {
    /// The reason in one or two sentences.
    pub fn words(&self) -> String {
        let mut words = String::new();
        let label = self.label.name();
        // Writing to a string cannot fail.
        let _ = match &self.reason {
            Reason::Rule(reason) => reason.write(label, &mut words),
            Reason::Path(reason) => reason.write(label, &mut words),
            Reason::Neighbours(reason) => reason.write(self.label, &mut words),
            Reason::Features(reason) => reason.write(label, self.probability, &mut words),
        };
        words
    }
}

impl RuleReason {
    fn write(&self, label: &str, words: &mut String) -> std::fmt::Result {
        let Self { number, rules, decides, right, .. } = self;
        if self.conditions.is_empty() {
            write!(words, "None of the {} rules before covers it: {label}.", rules - 1)?;
        } else {
            write!(words, "Rule {number} of {rules}: {} means {label}.", joined(&self.conditions))?;
        }
        write!(words, " It decides {decides} training rooms, {right} of them rightly.")
    }
}

impl PathReason {
    fn write(&self, label: &str, words: &mut String) -> std::fmt::Result {
        let Self { rooms, right, .. } = self;
        if self.conditions.is_empty() {
            return write!(words, "Of all {rooms} training rooms {right} are {label}s.");
        }
        write!(words, "Of {rooms} training rooms with {}, {right} are {label}s.", joined(&self.conditions))
    }
}

impl NeighboursReason {
    fn write(&self, label: Label, words: &mut String) -> std::fmt::Result {
        let alike = self.neighbours.iter().filter(|near| near.label == label);
        write!(
            words,
            "{} of the {} most similar training rooms are {label}s",
            alike.clone().count(),
            self.neighbours.len()
        )?;
        let named: Vec<String> = alike
            .take(NAMED)
            .map(|near| {
                let area = value_in_words(0, near.values[0]);
                let doors = near.values[2];
                let doors = if doors == 1.0 { "1 opening".to_owned() } else { format!("{doors} openings") };
                format!("{} ({area}, {doors})", near.source)
            })
            .collect();
        if named.is_empty() { write!(words, ".") } else { write!(words, ", the nearest {}.", named.join("; ")) }
    }
}

impl FeaturesReason {
    fn write(&self, label: &str, probability: f64, words: &mut String) -> std::fmt::Result {
        let matters = |effect: &&Effect| effect.probability_if_typical < probability - MATTERS;
        let mut effects = self.effects.iter().filter(matters).take(NAMED).peekable();
        if effects.peek().is_none() {
            return write!(words, "No single feature decides: with any one at its typical value it stays a {label}.");
        }
        write!(words, "What speaks for {label}: ")?;
        let parts: Vec<String> = effects
            .map(|effect| {
                let value = |value| value_in_words(effect.feature, value);
                format!(
                    "{} {} (with the typical {} the probability would be {}, not {})",
                    IN_WORDS[effect.feature],
                    value(effect.value),
                    value(effect.typical),
                    percent(effect.probability_if_typical),
                    percent(probability)
                )
            })
            .collect();
        write!(words, "{}.", parts.join("; "))
    }
}
