//! Why a room got its label: as data, and in words.

use std::fmt::Write as _;

use super::condition::{Bound, Condition};
use super::numbers::{in_words, percent, value_in_words};
use crate::dataset::table::{FEATURES, RoomSource, Values};
use crate::features::Features;
use crate::labels::Label;

/// A prediction with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The predicted label.
    pub label: Label,
    /// Its probability, 0..=1.
    pub probability: f64,
    pub reason: Reason,
}

/// The reason for a prediction.
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
    /// The number of rules in the list.
    pub rules: usize,
    /// Its conditions; none for the last rule, which takes what no other covers.
    pub conditions: Vec<Condition>,
    /// Training rooms that it decides, and how many of them correctly.
    pub decides: u32,
    pub right: u32,
}

/// The path down the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct PathReason {
    /// The questions from the root on.
    pub steps: Vec<Step>,
    /// The answers combined: the tightest bounds on each feature.
    pub conditions: Vec<Condition>,
    /// Training rooms in the leaf, and how many of them have the predicted label.
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

/// The most similar rooms of the training set.
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
    /// The distance, in standard deviations.
    pub distance: f64,
}

/// The features that mattered.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturesReason {
    /// How much each mattered, most first.
    pub effects: Vec<Effect>,
}

/// The effect of a feature: the prediction is repeated with the feature at its typical value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effect {
    /// Index of the feature.
    pub feature: usize,
    pub value: f64,
    /// The median over the training rooms.
    pub typical: f64,
    /// The probability of the predicted label if the feature had its typical value.
    pub probability_if_typical: f64,
    /// The label predicted in that case.
    pub label_if_typical: Label,
}

/// The bounds on one feature.
#[derive(Clone, Copy, Default)]
struct Bounds {
    /// At least this, or more than this.
    low: Option<Bound>,
    at_most: Option<f64>,
}

impl Bounds {
    fn of(conditions: &[Condition], feature: usize) -> Self {
        let mut bounds = Self::default();
        for condition in conditions.iter().filter(|condition| condition.feature == feature) {
            match condition.bound {
                Bound::AtMost(bound) => bounds.at_most = Some(bound),
                low => bounds.low = Some(low),
            }
        }
        bounds
    }

    /// In words: `area at most 6.2 m²`, `axes ratio from 1.4 to 2`, `at least 3 openings`.
    fn words(self, feature: usize) -> Option<String> {
        if feature >= 2 {
            return self.count_words(feature);
        }
        let value = |bound| value_in_words(feature, bound);
        let words = match (self.low, self.at_most) {
            (None, None) => return None,
            (None, Some(most)) => format!("at most {}", value(most)),
            (Some(Bound::Over(less)), None) => format!("over {}", value(less)),
            (Some(Bound::AtLeast(least) | Bound::AtMost(least)), None) => format!("at least {}", value(least)),
            (Some(Bound::Over(low) | Bound::AtLeast(low) | Bound::AtMost(low)), Some(most)) => {
                format!("from {} to {}", value(low), value(most))
            }
        };
        Some(format!("{} {words}", in_words::NAMES[feature]))
    }

    /// Counts are integers: over 2 is at least 3.
    fn count_words(self, feature: usize) -> Option<String> {
        let least = self.low.map(|low| match low {
            Bound::Over(less) => less.floor() + 1.0,
            Bound::AtLeast(least) | Bound::AtMost(least) => least.ceil(),
        });
        let most = self.at_most.map(f64::floor);
        let name = |count| in_words::of_count(feature, count);
        Some(match (least.filter(|&least| least > 0.0), most) {
            (None, None) => return None,
            (None, Some(most)) if most <= 0.0 => name(0.0),
            (None, Some(most)) => format!("at most {}", name(most)),
            (Some(least), None) => format!("at least {}", name(least)),
            (Some(least), Some(most)) if least == most => format!("exactly {}", name(most)),
            (Some(least), Some(most)) => format!("{least} to {}", name(most)),
        })
    }
}

impl Condition {
    /// The condition in words: `area at most 6.2 m²`.
    pub fn words(&self) -> String {
        joined(&[*self])
    }

    /// The condition in the paper's notation: `a <= 6.2`.
    pub fn formula(&self) -> String {
        let name = Features::NAMES[self.feature];
        match self.bound {
            Bound::AtMost(bound) => format!("{name} <= {bound}"),
            Bound::AtLeast(bound) => format!("{name} >= {bound}"),
            Bound::Over(bound) => format!("{name} > {bound}"),
        }
    }
}

/// Conditions as one phrase, with the two bounds of a feature combined.
fn joined(conditions: &[Condition]) -> String {
    let words: Vec<String> =
        (0..FEATURES).filter_map(|feature| Bounds::of(conditions, feature).words(feature)).collect();
    match words.split_last() {
        None => "any value".to_owned(),
        Some((only, [])) => only.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

/// The most neighbours named in a sentence; the data have all.
const NAMED: usize = 3;

/// A feature is named in a sentence if the probability would be lower by this without it.
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
        match (self.conditions.is_empty(), rules - 1) {
            (true, 0) => write!(words, "The only rule: every room is a {label}.")?,
            (true, 1) => write!(words, "The one rule before does not apply, so it is a {label}.")?,
            (true, before) => write!(words, "None of the {before} rules before applies, so it is a {label}.")?,
            (false, _) => write!(words, "Rule {number} of {rules}: {} means {label}.", joined(&self.conditions))?,
        }
        match (decides, right) {
            (0, _) => write!(words, " It decides no training room."),
            (1, 1) => write!(words, " It decides one training room, rightly."),
            (1, _) => write!(words, " It decides one training room, wrongly."),
            _ if decides == right => write!(words, " It decides {decides} training rooms, all of them rightly."),
            _ => write!(words, " It decides {decides} training rooms, {right} of them rightly."),
        }
    }
}

impl PathReason {
    fn write(&self, label: &str, words: &mut String) -> std::fmt::Result {
        let Self { rooms, right, .. } = self;
        let with =
            if self.conditions.is_empty() { String::new() } else { format!(" with {}", joined(&self.conditions)) };
        match (rooms, right) {
            (1, 1) => write!(words, "The only training room{with} is a {label}."),
            _ if rooms == right => write!(words, "All {rooms} training rooms{with} are {label}s."),
            (_, 1) => write!(words, "Of the {rooms} training rooms{with}, one is a {label}."),
            _ => write!(words, "Of the {rooms} training rooms{with}, {right} are {label}s."),
        }
    }
}

impl NeighboursReason {
    fn write(&self, label: Label, words: &mut String) -> std::fmt::Result {
        let alike: Vec<&NearRoom> = self.neighbours.iter().filter(|near| near.label == label).collect();
        match (alike.len(), self.neighbours.len()) {
            (1, 1) => write!(words, "The most similar training room is a {label}")?,
            (all, most) if all == most => write!(words, "All {most} most similar training rooms are {label}s")?,
            (1, most) => write!(words, "Of the {most} most similar training rooms one is a {label}")?,
            (some, most) => write!(words, "Of the {most} most similar training rooms {some} are {label}s")?,
        }
        let named: Vec<String> = alike
            .iter()
            .take(NAMED)
            .map(|near| {
                let area = value_in_words(0, near.values[0]);
                format!("{} ({area}, {})", place(&near.source), in_words::of_count(2, near.values[2]))
            })
            .collect();
        match (named.as_slice(), alike.len()) {
            ([], _) => write!(words, "."),
            ([only], _) => write!(words, ": {only}."),
            (named, all) if named.len() == all => write!(words, ": {}.", named.join("; ")),
            (named, _) => write!(words, ", the nearest of them {}.", named.join("; ")),
        }
    }
}

/// The location of a room.
fn place(source: &RoomSource) -> String {
    format!("{} in {}", readable(&source.room), source.plan)
}

/// A room's readable name. Of a generated id (a UUID), people read only the first part.
pub(super) fn readable(room: &str) -> String {
    let parts: Vec<&str> = room.split('-').collect();
    let lengths = parts.iter().map(|part| part.len());
    let is_uuid =
        lengths.eq([8, 4, 4, 4, 12]) && parts.iter().all(|part| part.bytes().all(|byte| byte.is_ascii_hexdigit()));
    if is_uuid { format!("room {}", parts[0]) } else { room.to_owned() }
}

impl FeaturesReason {
    fn write(&self, label: &str, probability: f64, words: &mut String) -> std::fmt::Result {
        let matters = |effect: &&Effect| effect.probability_if_typical < probability - MATTERS;
        let mut effects = self.effects.iter().filter(matters).take(NAMED).peekable();
        if effects.peek().is_none() {
            return write!(
                words,
                "No single feature decides: with any one at its typical value a {label} is as likely."
            );
        }
        write!(words, "What speaks for a {label}: ")?;
        let parts: Vec<String> = effects
            .map(|effect| {
                format!(
                    "{} (with the typical {} the probability would be {}, not {})",
                    in_words::of_value(effect.feature, effect.value),
                    value_in_words(effect.feature, effect.typical),
                    percent(effect.probability_if_typical),
                    percent(probability)
                )
            })
            .collect();
        write!(words, "{}.", parts.join("; "))
    }
}
