//! Rule induction: RIPPER (Cohen 1995), in the form of Weka's JRip.
//!
//! Labels are learned from the rarest to the most frequent, each against the later ones; the last needs
//! no rule. A rule is grown condition by condition with FOIL's gain, pruned on held-out rooms, and kept
//! if it shortens the description; two passes then replace or revise each rule given the others. For a
//! small table several lists are learned, and the one with the shortest description is kept.

mod bits;
mod grow;
mod induce;
mod length;

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::base::random::Random;
use crate::base::work::{Cancelled, Work};
use crate::classify::Distribution;
pub use crate::classify::condition::{Bound, Condition};
use crate::classify::explain::{Reason, RuleReason};
use crate::classify::learner::{Learner, Model, Trained};
use crate::classify::numbers::readable_between;
use crate::dataset::table::{FEATURES, Table, Values};
use crate::features::Features;
use crate::labels::Label;
use bits::Bits;
use grow::{RankCondition, Ranked};
use induce::{Task, possible_conditions};
use length::rule_bits;

/// Which rooms are held out for pruning is random, and matters more the fewer there are: for small tables
/// several lists are learned, and the one with the shortest description is kept. This bounds the work of
/// all attempts...
const ATTEMPTS_TIMES_ROOMS: usize = 5000;

/// ...and this their number for few rooms.
const MOST_ATTEMPTS: usize = 12;

/// The learner.
pub struct Ripper;

impl Learner for Ripper {
    fn id(&self) -> &'static str {
        "rules"
    }

    fn title(&self) -> &'static str {
        "rule induction"
    }

    fn short_title(&self) -> &'static str {
        "Rule induction"
    }

    fn help(&self) -> &'static str {
        "rules that you can read, each room by itself"
    }

    fn train(&self, table: &Table, seed: u64, work: &Work<'_>) -> Result<Trained<Arc<dyn Model>>, Cancelled> {
        // Laplace's correction alone calibrates rules as well as a temperature would: fitted on held-out
        // rooms it came out near 1 and changed the log loss in the third digit.
        Ok(Trained { model: RuleList::train(table, seed, work)?, temperature: 1.0 }.shared())
    }

    fn from_json(&self, model: Value) -> Option<Arc<dyn Model>> {
        let disk: DiskRules = serde_json::from_value(model).ok()?;
        let rule = |rule: DiskRule| {
            let conditions: Option<Vec<Condition>> = rule.r#if.iter().map(DiskCondition::live).collect();
            Some(Rule { conditions: conditions?, counts: rule.rooms })
        };
        let rules = disk.rules.into_iter().map(rule).collect::<Option<_>>()?;
        Some(Arc::new(RuleList::from_rules(rules)?))
    }
}

impl Model for RuleList {
    fn predict(&self, values: &Values) -> Distribution {
        self.predict(values)
    }

    fn explain(&self, values: &Values, label: Label, _: &dyn Fn(&Values) -> Distribution) -> Reason {
        let index = self.deciding(values);
        let rule = &self.rules[index];
        Reason::Rule(RuleReason {
            number: index + 1,
            rules: self.rules.len(),
            conditions: rule.conditions.clone(),
            decides: rule.counts.iter().sum(),
            right: rule.counts[label.index()],
        })
    }

    fn to_json(&self) -> Value {
        let rule = |rule: &Rule| DiskRule {
            r#if: rule.conditions.iter().map(DiskCondition::of).collect(),
            then: rule.label().letter().to_owned(),
            rooms: rule.counts,
        };
        // Plain structs of numbers and texts can always be written.
        serde_json::to_value(DiskRules { rules: self.rules.iter().map(rule).collect() }).unwrap_or_default()
    }
}

#[derive(Serialize, Deserialize)]
struct DiskRules {
    rules: Vec<DiskRule>,
}

#[derive(Serialize, Deserialize)]
struct DiskRule {
    r#if: Vec<DiskCondition>,
    /// For human readers; `rooms` is what counts.
    then: String,
    /// Training rooms of each label.
    rooms: [u32; 5],
}

#[derive(Serialize, Deserialize)]
struct DiskCondition {
    feature: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_most: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_least: Option<f64>,
}

impl DiskCondition {
    fn of(condition: &Condition) -> Self {
        let feature = Features::NAMES[condition.feature].to_owned();
        match condition.bound {
            Bound::AtMost(bound) => Self { feature, at_most: Some(bound), at_least: None },
            // Rules have no 'over'; the next number up is equivalent.
            Bound::Over(bound) => Self { feature, at_most: None, at_least: Some(bound.next_up()) },
            Bound::AtLeast(bound) => Self { feature, at_most: None, at_least: Some(bound) },
        }
    }

    fn live(&self) -> Option<Condition> {
        let bound = match (self.at_most, self.at_least) {
            (Some(bound), None) => Bound::AtMost(bound),
            (None, Some(bound)) => Bound::AtLeast(bound),
            _ => return None,
        };
        Some(Condition { feature: Features::index(&self.feature)?, bound })
    }
}

/// An ordered list of rules: the first that covers a room decides.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleList {
    rules: Vec<Rule>,
}

/// A rule: if all conditions hold, then the label. The last rule of a list has no conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    pub conditions: Vec<Condition>,
    /// Training rooms of each label that this rule decides, in the order of the labels.
    pub counts: [u32; 5],
}

impl Rule {
    /// Whether all conditions hold.
    pub fn covers(&self, values: &Values) -> bool {
        self.conditions.iter().all(|condition| condition.holds(values))
    }

    /// The shares of the labels among the training rooms it decides, with Laplace's correction.
    pub fn distribution(&self) -> Distribution {
        Distribution::smoothed(self.counts.map(f64::from), &Distribution::UNIFORM, 5.0)
    }

    /// The label it gives: the most common among the training rooms it decides.
    pub fn label(&self) -> Label {
        self.distribution().label()
    }
}

impl RuleList {
    /// Learns rules. The same seed gives the same rules.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub fn train(table: &Table, seed: u64, work: &Work<'_>) -> Result<Self, Cancelled> {
        let ranked = Ranked::new(table);
        let possible_conditions = possible_conditions(&ranked);
        let mut random = Random::new(seed);
        let attempts = (ATTEMPTS_TIMES_ROOMS / table.len()).clamp(1, MOST_ATTEMPTS);
        let mut best = Self::attempt(table, &ranked, possible_conditions, &mut random);
        for _ in 1..attempts {
            work.goes_on()?;
            let other = Self::attempt(table, &ranked, possible_conditions, &mut random);
            if other.bits(possible_conditions) < best.bits(possible_conditions) {
                best = other;
            }
        }
        Ok(best)
    }

    /// Bits to encode the rules and, given these, the labels of the training rooms.
    fn bits(&self, possible_conditions: f64) -> f64 {
        let of_rule = |rule: &Rule| {
            let distribution = rule.distribution();
            let labels: f64 = Label::ALL
                .iter()
                .map(|&label| -f64::from(rule.counts[label.index()]) * distribution.probability(label).log2())
                .sum();
            rule_bits(rule.conditions.len(), possible_conditions) + labels
        };
        self.rules.iter().map(of_rule).sum()
    }

    /// Learns one list with one sequence of random numbers.
    fn attempt(table: &Table, ranked: &Ranked, possible_conditions: f64, random: &mut Random) -> Self {
        let mut order: Vec<Label> = Label::ALL.to_vec();
        let counts = table.label_counts();
        order.sort_by_key(|label| counts[label.index()]);
        order.retain(|label| counts[label.index()] > 0);

        let mut rooms = Bits::of(table.len(), |_| true);
        let mut drafts: Vec<Vec<RankCondition>> = Vec::new();
        for (index, &label) in order.iter().enumerate().take(order.len().saturating_sub(1)) {
            let from_here: usize = order[index..].iter().map(|label| counts[label.index()]).sum();
            let task = Task {
                ranked,
                labels: table.labels(),
                label: Bits::of(table.len(), |row| table.labels()[row] == label),
                rooms: rooms.clone(),
                share: counts[label.index()] as f64 / from_here as f64,
                possible_conditions,
            };
            for rule in task.rules(random) {
                rooms.subtract(&rule.covers);
                drafts.push(rule.conditions);
            }
        }
        drafts.push(Vec::new());

        let mut rules: Vec<Rule> =
            drafts.iter().map(|draft| Rule { conditions: readable(draft, ranked), counts: [0; 5] }).collect();
        for (values, label) in table.values().iter().zip(table.labels()) {
            if let Some(rule) = rules.iter_mut().find(|rule| rule.covers(values)) {
                rule.counts[label.index()] += 1;
            }
        }
        // A rule made idle by later ones is useless. The last decides whatever is left.
        let last = rules.len() - 1;
        let mut index = 0;
        rules.retain(|rule| {
            index += 1;
            index > last || rule.counts != [0; 5]
        });
        Self { rules }
    }

    /// A list from its rules; `None` unless the last has no conditions, so that every room is decided.
    pub fn from_rules(rules: Vec<Rule>) -> Option<Self> {
        let ends_well = rules.last().is_some_and(|rule| rule.conditions.is_empty());
        let sound = rules.iter().flat_map(|rule| &rule.conditions).all(|condition| {
            let (Bound::AtMost(bound) | Bound::AtLeast(bound) | Bound::Over(bound)) = condition.bound;
            condition.feature < FEATURES && bound.is_finite()
        });
        let counts_fit =
            |rule: &Rule| rule.counts.iter().map(|&count| u64::from(count)).sum::<u64>() <= u32::MAX.into();
        (ends_well && sound && rules.iter().all(counts_fit)).then_some(Self { rules })
    }

    /// All rules in order; the last has no condition.
    pub fn rules(&self) -> &[Rule] {
        &self.rules
    }

    /// The index of the rule that decides a room.
    pub fn deciding(&self, values: &Values) -> usize {
        self.rules.iter().position(|rule| rule.covers(values)).unwrap_or(self.rules.len() - 1)
    }

    /// The label shares among the training rooms decided by the same rule, with Laplace's correction.
    pub fn predict(&self, values: &Values) -> Distribution {
        self.rules[self.deciding(values)].distribution()
    }
}

/// Conditions with readable thresholds, in feature order; of several bounds in the same direction on one
/// feature, the tightest.
fn readable(draft: &[RankCondition], ranked: &Ranked) -> Vec<Condition> {
    let mut conditions = Vec::new();
    for feature in 0..FEATURES {
        let values = &ranked.values[feature];
        let bounds = |at_most: bool| {
            draft
                .iter()
                .filter(move |condition| condition.feature == feature && condition.at_most == at_most)
                .map(|condition| condition.rank as usize)
        };
        if let Some(rank) = bounds(false).max() {
            let below = rank.checked_sub(1).map_or(values[rank], |below| values[below]);
            // The mirror image: above the value below, at most the value itself.
            let bound = Bound::AtLeast(-readable_between(-values[rank], -below));
            conditions.push(Condition { feature, bound });
        }
        if let Some(rank) = bounds(true).min() {
            let above = values.get(rank + 1).copied().unwrap_or(values[rank]);
            conditions.push(Condition { feature, bound: Bound::AtMost(readable_between(values[rank], above)) });
        }
    }
    conditions
}
