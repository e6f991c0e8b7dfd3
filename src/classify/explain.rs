//! Why a room got its label by itself: as data, and as people read it ([`Why`]).

use super::Distribution;
use super::condition::{Bound, Condition};
use super::numbers::{count_in_words, rounded, times};
use super::why::{OnPlan, Point, Why, and_list, area, nothing_stands_out, sorted, speaks};
use crate::base::units::Units;
use crate::base::wording::thousands;
use crate::dataset::table::{FEATURES, RoomSource, Values};
use crate::features::Features;
use crate::labels::Label;

/// A prediction with its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The predicted label.
    pub label: Label,
    pub distribution: Distribution,
    /// The room's features.
    pub values: Values,
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
    /// What is predicted if the feature has its typical value.
    pub if_typical: Distribution,
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

    /// In words: `at most 6.2 m²`, `1.4 to 2`, `at least 3`. `None` without a bound that says anything.
    fn words(self, feature: usize, units: Units) -> Option<String> {
        if feature >= 2 {
            return self.count_words();
        }
        let value = |bound| if feature == 0 { area(bound, units) } else { rounded(bound) };
        Some(match (self.low, self.at_most) {
            (None, None) => return None,
            (None, Some(most)) => format!("at most {}", value(most)),
            (Some(Bound::Over(less)), None) => format!("over {}", value(less)),
            (Some(Bound::AtLeast(least) | Bound::AtMost(least)), None) => format!("at least {}", value(least)),
            (Some(Bound::Over(low) | Bound::AtLeast(low) | Bound::AtMost(low)), Some(most)) => {
                format!("{} to {}", value(low), value(most))
            }
        })
    }

    /// Counts are integers: over 2 is at least 3.
    fn count_words(self) -> Option<String> {
        let least = self.low.map(|low| match low {
            Bound::Over(less) => less.floor() + 1.0,
            Bound::AtLeast(least) | Bound::AtMost(least) => least.ceil(),
        });
        let most = self.at_most.map(f64::floor);
        Some(match (least.filter(|&least| least > 0.0), most) {
            (None, None) => return None,
            (None, Some(most)) if most <= 0.0 => "none".to_owned(),
            (None, Some(most)) => format!("at most {most}"),
            (Some(least), None) => format!("at least {least}"),
            (Some(least), Some(most)) if least == most => format!("exactly {most}"),
            (Some(least), Some(most)) => format!("{least} to {most}"),
        })
    }
}

impl Condition {
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

/// A feature with its value: `12.4 m² along axes`, `1.4 times as long as wide`, `3 openings`.
fn value_in_words(feature: usize, value: f64, units: Units) -> String {
    match feature {
        // The paper's area, not the clear one that the drawing shows.
        0 => format!("{} along axes", area(value, units)),
        1 => times(value),
        _ => count_in_words(feature, value),
    }
}

/// What of a room answers the conditions, and which bounds it keeps.
fn answers(conditions: &[Condition], values: &Values, units: Units) -> Vec<Point> {
    let point = |feature: usize| {
        let bounds = Bounds::of(conditions, feature).words(feature, units)?;
        let value = value_in_words(feature, values[feature], units);
        // 'No openings to halls' needs no 'at most 3'.
        let is_none = feature >= 2 && values[feature] == 0.0;
        let seen = if is_none { value } else { format!("{value} ({bounds})") };
        Some(Point { seen, speaks: None, on_plan: OnPlan::of_feature(feature) })
    };
    (0..FEATURES).filter_map(point).collect()
}

/// How many of the rooms that a model learned from have the label: `Of the 31 rooms like it in the training plans, 25
/// are big rooms.`
fn share(rooms: u32, right: u32, label: Label, like: &str) -> String {
    let label = label.name();
    match (rooms, right) {
        (0, _) => format!("The model learned from no room{like}."),
        (1, 1) => format!("The only room{like} that the model learned from is a {label}."),
        (1, _) => format!("The only room{like} that the model learned from is no {label}."),
        _ if rooms == right => {
            format!("All {} rooms{like} that the model learned from are {label}s.", thousands(u64::from(rooms)))
        }
        _ => {
            let are = if right == 1 { format!("one is a {label}") } else { format!("{right} are {label}s") };
            format!("Of the {} rooms{like} that the model learned from, {are}.", thousands(u64::from(rooms)))
        }
    }
}

/// The most neighbours named in a sentence; the data have all.
const NAMED: usize = 3;

impl Explanation {
    /// The probability of the predicted label, 0..=1.
    pub fn probability(&self) -> f64 {
        self.distribution.probability(self.label)
    }

    /// The reason as people read it, with areas in these units.
    pub fn why(&self, units: Units) -> Why {
        let (label, values) = (self.label, &self.values);
        let (points, conclusion) = match &self.reason {
            Reason::Rule(reason) => (answers(&reason.conditions, values, units), reason.conclusion(label)),
            Reason::Path(reason) => (answers(&reason.conditions, values, units), reason.conclusion(label)),
            Reason::Neighbours(reason) => (compared(values, units), reason.conclusion(label, units)),
            Reason::Features(reason) => reason.points(label, &self.distribution, units),
        };
        Why { label, points, conclusion }
    }
}

impl RuleReason {
    fn conclusion(&self, label: Label) -> String {
        let share = |like| share(self.decides, self.right, label, like);
        match (self.conditions.is_empty(), self.rules - 1) {
            (false, _) => share(" like this"),
            (true, 0) => share(""),
            (true, 1) => format!("The only rule for other labels does not apply. {}", share(" left over")),
            (true, before) => format!("None of the {before} rules for other labels applies. {}", share(" left over")),
        }
    }
}

impl PathReason {
    fn conclusion(&self, label: Label) -> String {
        share(self.rooms, self.right, label, if self.conditions.is_empty() { "" } else { " like this" })
    }
}

/// What is compared with other rooms.
fn compared(values: &Values, units: Units) -> Vec<Point> {
    let of = |feature: usize| (value_in_words(feature, values[feature], units), OnPlan::of_feature(feature));
    let to = |feature: &usize| values[*feature] > 0.0;
    let to: Vec<String> = (3..FEATURES)
        .filter(to)
        .map(|feature| {
            let name = Label::ALL[feature - 3].name();
            format!("{} to {name}s", values[feature])
        })
        .collect();
    let (openings, on_plan) = of(2);
    let openings = if to.is_empty() { openings } else { format!("{openings}: {}", and_list(&to)) };
    [of(0), of(1), (openings, on_plan)]
        .into_iter()
        .map(|(seen, on_plan)| Point { seen, speaks: None, on_plan })
        .collect()
}

impl NeighboursReason {
    fn conclusion(&self, label: Label, units: Units) -> String {
        let alike: Vec<&NearRoom> = self.neighbours.iter().filter(|near| near.label == label).collect();
        let name = label.name();
        let lead = match (alike.len(), self.neighbours.len()) {
            (1, 1) => format!("The most similar room that the model learned from is a {name}"),
            (all, most) if all == most => {
                format!("All {most} most similar rooms that the model learned from are {name}s")
            }
            (1, most) => format!("Of the {most} most similar rooms that the model learned from, one is a {name}"),
            (some, most) => {
                format!("Of the {most} most similar rooms that the model learned from, {some} are {name}s")
            }
        };
        let named: Vec<String> = alike
            .iter()
            .take(NAMED)
            .map(|near| {
                let openings = count_in_words(2, near.values[2]);
                format!("{} ({}, {openings})", place(&near.source), area(near.values[0], units))
            })
            .collect();
        match (named.as_slice(), alike.len()) {
            ([], _) => format!("{lead}."),
            ([only], _) => format!("{lead}: {only}."),
            (named, all) if named.len() == all => format!("{lead}: {}.", named.join("; ")),
            (named, _) => format!("{lead}, the nearest: {}.", named.join("; ")),
        }
    }
}

/// The location of a room.
fn place(source: &RoomSource) -> String {
    format!("{} in {}", readable(&source.room), source.plan)
}

/// A room's readable name. An id that a program made (a UUID, a number) says nothing to people.
fn readable(room: &str) -> &str {
    let parts: Vec<&str> = room.split('-').collect();
    let lengths = parts.iter().map(|part| part.len());
    let is_uuid =
        lengths.eq([8, 4, 4, 4, 12]) && parts.iter().all(|part| part.bytes().all(|byte| byte.is_ascii_hexdigit()));
    let is_number = room.bytes().all(|byte| byte.is_ascii_digit());
    if is_uuid || is_number { "a room" } else { room }
}

impl FeaturesReason {
    fn points(&self, label: Label, said: &Distribution, units: Units) -> (Vec<Point>, String) {
        let points = self.effects.iter().filter_map(|effect| {
            let Effect { feature, value, typical, if_typical } = effect;
            let gain = |label| said.probability(label) - if_typical.probability(label);
            let (speaks, change) = speaks(label, gain)?;
            let usual = match feature {
                0 => area(*typical, units),
                _ => rounded(*typical),
            };
            let seen = format!("{} (usual: {usual})", value_in_words(*feature, *value, units));
            Some((Point { seen, speaks: Some(speaks), on_plan: OnPlan::of_feature(*feature) }, change))
        });
        let points = sorted(label, points.collect());
        let conclusion = if points.is_empty() { nothing_stands_out(label) } else { String::new() };
        (points, conclusion)
    }
}
