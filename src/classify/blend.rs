//! The sixth classifier: several classifiers asked about the same rooms, their answers averaged. Described
//! for readers in `docs/blend.md`.
//!
//! Classifiers err in different ways on buildings unlike those they learned from. One that compares the
//! rooms of a plan does not mind a wrong scale, but another custom of drawing (no closets, say) shifts all
//! its comparisons; one that lives on square metres is the other way round; one that learned from all kinds
//! of buildings knows more of them, and less of each. Their mean is seldom worse than the best of them, and
//! nobody can know beforehand which that is.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use serde_json::{Value, json};

use super::calibration::fitted_temperature;
use super::committee;
use super::given::{self, Given};
use super::in_plan;
use super::joint::{FirstRound, Joint, JointExplanation};
use super::why::{OnPlan, Point, Why, and_list, speaks};
use super::{Algorithm, Classifier, Distribution, Method};
use crate::base::units::Units;
use crate::dataset::sets::STANDARD;
use crate::dataset::{RoomNetwork, places_among};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};
use crate::plan::RoomId;

/// A part of the [`RECIPE`]: one of a typology's own classifiers, or of those of all typologies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ingredient {
    pub method: Method,
    /// Whether it is the one of all typologies.
    pub is_standard: bool,
    pub weight: f64,
}

/// What takes part; the perceptron stands for a [`committee`] of them. The weights are a compromise between buildings like those
/// learned from, where the own joint classifier is best, and those of another source, where it is worst (`docs/blend.md` has both).
pub const RECIPE: [Ingredient; 3] = [
    Ingredient { method: Method::Joint, is_standard: false, weight: 1.0 },
    Ingredient { method: Method::Joint, is_standard: true, weight: 2.0 },
    Ingredient { method: Method::Each(Algorithm::PERCEPTRON), is_standard: false, weight: 2.0 },
];

/// The recipe for a set: for each part the set that its model learned from, the method, and the weight. For [`STANDARD`] its own
/// classifier and that of all typologies are one, which counts for both.
pub fn recipe(set: &str) -> Vec<(&str, Method, f64)> {
    let mut parts: Vec<(&str, Method, f64)> = Vec::new();
    for of in RECIPE {
        let from = if of.is_standard { STANDARD } else { set };
        match parts.iter_mut().find(|(other, method, _)| (*other, *method) == (from, of.method)) {
            Some((.., weight)) => *weight += of.weight,
            None => parts.push((from, of.method, of.weight)),
        }
    }
    parts
}

/// What a blend must know of a model that takes part. A trait, since a model may be a blend, which must then know no models.
pub trait Member: fmt::Debug + Send + Sync {
    /// The model's name, such as `school-tree`.
    fn name(&self) -> &str;
    /// What tells it from another model of its name.
    fn checksum(&self) -> &str;
    /// The set it learned from: a typology, or [`STANDARD`].
    fn set(&self) -> &str;
    fn method(&self) -> Method;
    /// `None` if it is a blend: no blend takes part in another.
    fn kind(&self) -> Option<Kind<'_>>;
}

/// The classifier of a [`Member`].
#[derive(Clone, Copy, Debug)]
pub enum Kind<'a> {
    Each(&'a Classifier),
    Joint(&'a Joint),
}

/// A classifier that takes part.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its share of the answer, above 0.
    pub weight: f64,
    pub by: By,
}

/// Who answers for a part.
#[derive(Clone, Debug)]
pub enum By {
    /// A model with a file of its own.
    Model(Arc<dyn Member>),
    /// A [`committee`], which the blend's own file holds.
    Committee {
        /// The set it learned from: a typology, or [`STANDARD`].
        set: String,
        classifier: Classifier,
    },
}

impl By {
    /// Whether it is the same model, in memory.
    fn is(&self, other: &Self) -> bool {
        matches!((self, other), (Self::Model(model), Self::Model(other)) if Arc::ptr_eq(model, other))
    }
}

impl Part {
    /// The classifier; `None` if the model is a blend.
    fn kind(&self) -> Option<Kind<'_>> {
        match &self.by {
            By::Model(model) => model.kind(),
            By::Committee { classifier, .. } => Some(Kind::Each(classifier)),
        }
    }

    /// Its name in sentences: 'joint classifier of offices'.
    fn title(&self) -> String {
        let (what, set) = match &self.by {
            By::Model(model) => (model.method().title().to_owned(), model.set()),
            By::Committee { set, .. } => (format!("{}s", Algorithm::PERCEPTRON.title()), set.as_str()),
        };
        if set == STANDARD { format!("{what} of all buildings") } else { format!("{what} of {set}s") }
    }
}

/// The mean of several classifiers.
#[derive(Clone, Debug)]
pub struct Blend {
    /// At least one; their weights sum to 1.
    parts: Vec<Part>,
    /// See [`Distribution::at_temperature`].
    temperature: f64,
}

/// What the parts and all together say of a plan's rooms.
#[derive(Clone, Debug)]
pub struct Opinions {
    heard: Arc<Heard>,
    /// The labels that were given.
    given: Arc<Given>,
    /// The blend's distribution of each room: the mean, corrected by the labels that were given ([`Given::corrected`]).
    pub distributions: Vec<Distribution>,
}

/// What was said of a plan before an edit.
#[derive(Clone, Copy, Debug)]
pub struct Earlier<'a> {
    /// Who said it; of another blend only what it has in common is of use.
    pub blend: &'a Blend,
    pub opinions: &'a Opinions,
    /// Whether the rooms look now as they did then ([`RoomNetwork::looks_like`]).
    pub looks_same: bool,
}

/// What the parts say, which knows no labels.
#[derive(Debug)]
struct Heard {
    rooms: Vec<RoomId>,
    /// For each part, the distribution of each room.
    of_parts: Vec<Vec<Distribution>>,
    /// For each part that is a joint classifier, its first round: where explanations start.
    rounds: Vec<Option<FirstRound>>,
    /// For each part that looks at each room by itself, what it said, for the next plan.
    said: Vec<Option<in_plan::Said>>,
    /// The mean of the parts.
    means: Vec<Distribution>,
}

/// A name of a part, and what shows that it is the one meant: see [`Member::checksum`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartName {
    pub name: String,
    pub checksum: String,
}

impl Blend {
    /// A blend of models with their weights. Weights are brought to the sum 1. `None` if there is no part, one is a blend
    /// itself, or a weight is not above 0.
    pub fn new(parts: Vec<Part>, temperature: f64) -> Option<Self> {
        let sum: f64 = parts.iter().map(|part| part.weight).sum();
        let is_usable = |part: &Part| part.weight > 0.0 && part.kind().is_some();
        let is_sound = sum.is_finite() && temperature.is_finite() && temperature > 0.0;
        if parts.is_empty() || !is_sound || !parts.iter().all(is_usable) {
            return None;
        }
        let parts = parts.into_iter().map(|part| Part { weight: part.weight / sum, ..part }).collect();
        Some(Self { parts, temperature })
    }

    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// What every part and all together say of a network's rooms. `known` as in [`super::joint::Joint::predict`]: the parts are
    /// asked as if nothing were known, since what they make of given labels is worth less than what shows where they are wrong.
    pub fn opinions(&self, network: &RoomNetwork, known: &[Option<Label>]) -> Opinions {
        let (mut of_parts, mut rounds): (Vec<Vec<Distribution>>, Vec<Option<FirstRound>>) = (Vec::new(), Vec::new());
        for part in &self.parts {
            match part.kind() {
                Some(Kind::Joint(joint)) => {
                    let round = match rounds.iter().flatten().next() {
                        Some(other) => joint.first_round_after(network, other),
                        None => joint.first_round(network),
                    };
                    of_parts.push(joint.predict_from(&round, &[]));
                    rounds.push(Some(round));
                }
                Some(Kind::Each(classifier)) => {
                    let neighbours = NeighbourLabels::Predicted;
                    of_parts.push(in_plan::classify(classifier, network, &[], neighbours).distributions);
                    rounds.push(None);
                }
                None => {}
            }
        }
        let heard = self.heard(of_parts, rounds, Vec::new(), network, None);
        self.together(Arc::new(heard), network, known, None)
    }

    /// The same of the plan after an edit, to the last bit; `before` is what was said of the plan before it, by this function too.
    pub fn opinions_after(
        &self,
        network: &RoomNetwork,
        known: &[Option<Label>],
        before: Option<Earlier<'_>>,
    ) -> Opinions {
        let same = before.filter(|before| std::ptr::eq(before.blend, self));
        if let Some(Earlier { opinions, looks_same: true, .. }) = same {
            return self.together(opinions.heard.clone(), network, known, Some((opinions, true)));
        }
        // A model of all typologies takes part in other blends too.
        let round_before = |by: &By| {
            let Earlier { blend, opinions, .. } = before?;
            blend.parts.iter().zip(&opinions.heard.rounds).find(|(part, _)| part.by.is(by))?.1.as_ref()
        };
        let heard_before = same.map(|same| same.opinions.heard.as_ref());
        let (mut of_parts, mut rounds, mut said) = (Vec::new(), Vec::<Option<FirstRound>>::new(), Vec::new());
        for (index, part) in self.parts.iter().enumerate() {
            match part.kind() {
                Some(Kind::Joint(joint)) => {
                    let other = rounds.iter().flatten().next();
                    let (round, distributions) = joint.predict_after(network, &[], other, round_before(&part.by));
                    of_parts.push(distributions);
                    rounds.push(Some(round));
                    said.push(None);
                }
                Some(Kind::Each(classifier)) => {
                    let before = heard_before.and_then(|before| before.said.get(index)?.as_ref());
                    let neighbours = NeighbourLabels::Predicted;
                    let (result, kept) = in_plan::classify_after(classifier, network, &[], neighbours, before);
                    of_parts.push(result.distributions);
                    rounds.push(None);
                    said.push(Some(kept));
                }
                None => {}
            }
        }
        let heard = self.heard(of_parts, rounds, said, network, heard_before);
        self.together(Arc::new(heard), network, known, before.map(|before| (before.opinions, false)))
    }

    fn heard(
        &self,
        of_parts: Vec<Vec<Distribution>>,
        rounds: Vec<Option<FirstRound>>,
        said: Vec<Option<in_plan::Said>>,
        network: &RoomNetwork,
        before: Option<&Heard>,
    ) -> Heard {
        let rooms: Vec<RoomId> = network.rooms.iter().map(|room| room.id).collect();
        let places = before.map_or_else(Vec::new, |before| places_among(&before.rooms, &rooms));
        let weights: Vec<f64> = self.parts.iter().map(|part| part.weight).collect();
        let mut of_room: Vec<Distribution> = Vec::with_capacity(weights.len());
        let means = (0..rooms.len())
            .map(|room| {
                let place = places.get(room).copied().flatten();
                let is_as_before = |before: &&Heard, place: usize| {
                    let parts = before.of_parts.iter().zip(&of_parts);
                    parts.fold(true, |all, (before, now)| all & (before[place] == now[room]))
                };
                if let Some((before, place)) = before.zip(place).filter(|(before, place)| is_as_before(before, *place))
                {
                    return before.means[place];
                }
                of_room.clear();
                of_room.extend(of_parts.iter().map(|said| said[room]));
                Distribution::mean(&of_room, &weights).at_temperature(self.temperature)
            })
            .collect();
        Heard { rooms, of_parts, rounds, said, means }
    }

    fn together(
        &self,
        heard: Arc<Heard>,
        network: &RoomNetwork,
        known: &[Option<Label>],
        before: Option<(&Opinions, bool)>,
    ) -> Opinions {
        if let Some((before, true)) = before
            && before.given.is_of(known)
        {
            return before.clone();
        }
        let given_before = before.map(|(before, is_same)| (before.given.as_ref(), is_same));
        let given = Arc::new(Given::after(network, known, &heard.means, given_before));
        let distributions = given.corrected(&heard.means);
        Opinions { heard, given, distributions }
    }

    /// Why a room got its label, with areas in these units; `None` for a room that is not in the network. The points are those
    /// of the joint classifiers in the blend; which part said what stands behind them.
    pub fn why(
        &self,
        opinions: &Opinions,
        network: &RoomNetwork,
        known: &[Option<Label>],
        room: usize,
        units: Units,
    ) -> Option<Why> {
        let label = opinions.distributions.get(room)?.label();
        let mut told: Vec<(f64, JointExplanation)> = Vec::new();
        for (part, round) in self.parts.iter().zip(&opinions.heard.rounds) {
            if let (Some(Kind::Joint(joint)), Some(round)) = (part.kind(), round) {
                // As it was asked: as if no label were known.
                told.push((part.weight, joint.explain_from(round, network, &[], room)?));
            }
        }
        let mut why = match JointExplanation::pooled(told, label) {
            Some(explanation) => explanation.beside_given(known).why(units),
            None => Why { label, points: Vec::new(), conclusion: String::new() },
        };
        let said: Vec<(&Part, Distribution)> =
            self.parts.iter().zip(&opinions.heard.of_parts).map(|(part, said)| (part, said[room])).collect();
        let (mean, corrected) = (opinions.heard.means[room], opinions.distributions[room]);
        if let Some((speaks, _)) = speaks(label, |of| corrected.probability(of) - mean.probability(of)) {
            let like = opinions.given.like(room);
            let seen = given::words(&like);
            let on_plan = OnPlan::Rooms(like.into_iter().map(|(other, _)| other).collect());
            why.add(Point { seen, speaks: Some(speaks), on_plan });
        }
        if !why.conclusion.is_empty() {
            why.conclusion.push(' ');
        }
        why.conclusion.push_str(&who_said_what(&said, label, mean.label()));
        Some(why)
    }

    /// The blend as data: the names of its parts, or what they are, and their weights.
    pub fn to_value(&self) -> Value {
        let part = |Part { weight, by }: &Part| match by {
            By::Model(model) => json!({ "model": model.name(), "checksum": model.checksum(), "weight": weight }),
            By::Committee { set, classifier } => {
                json!({ "committee": classifier.model().to_json(), "set": set, "weight": weight })
            }
        };
        json!({ "parts": self.parts.iter().map(part).collect::<Vec<_>>() })
    }

    /// Reads such data, with its parts taken from where `find` finds them.
    ///
    /// # Errors
    /// When a part is missing, is another one than was meant, or the data are no blend: what is wrong, in words.
    pub fn from_value(
        value: &Value,
        temperature: f64,
        find: &dyn Fn(&str) -> Option<Arc<dyn Member>>,
    ) -> Result<Self, String> {
        let parts = value.get("parts").and_then(Value::as_array).ok_or("its parts are missing")?;
        if parts.len() > MOST_PARTS {
            return Err(format!("its {} parts are more than {MOST_PARTS}", parts.len()));
        }
        let mut read = Vec::new();
        for part in parts {
            let text = |key: &str| part.get(key).and_then(Value::as_str);
            if let Some(value) = part.get("committee") {
                let is_set = |set: &&str| *set == STANDARD || Typology::new(set).is_some();
                let (Some(set), Some(weight)) =
                    (text("set").filter(is_set), part.get("weight").and_then(Value::as_f64))
                else {
                    return Err("its committee has no set or weight".to_owned());
                };
                let by = By::Committee { set: set.to_owned(), classifier: committee::from_value(value)? };
                read.push(Part { weight, by });
                continue;
            }
            let (Some(name), Some(checksum), Some(weight)) =
                (text("model"), text("checksum"), part.get("weight").and_then(Value::as_f64))
            else {
                return Err("one of its parts has no name, checksum or weight".to_owned());
            };
            let model = find(name).ok_or_else(|| format!("its part '{name}' is not beside it"))?;
            if model.checksum() != checksum {
                return Err(format!("its part '{name}' is another model than the one it was made with"));
            }
            read.push(Part { weight, by: By::Model(model) });
        }
        Self::new(read, temperature).ok_or_else(|| "its parts do not make a classifier".to_owned())
    }
}

/// More parts than anybody means.
const MOST_PARTS: usize = 100;

/// What a blend says of rooms that none of its parts learned from.
pub struct Unseen {
    /// For each room, at a temperature that was fitted on the rooms of the other folds.
    pub said: Vec<Distribution>,
    /// The temperature fitted on all of them.
    pub temperature: f64,
}

/// Blends what each part (with its weight) said of the same rooms out of fold. `None` where a part did not say something of
/// every room.
pub fn blend_unseen(parts: &[(f64, Vec<Distribution>)], labels: &[Label], folds: &[usize]) -> Option<Unseen> {
    let rooms = labels.len();
    if parts.is_empty() || folds.len() != rooms || parts.iter().any(|(_, said)| said.len() != rooms) {
        return None;
    }
    let weights: Vec<f64> = parts.iter().map(|(weight, _)| *weight).collect();
    let plain: Vec<Distribution> = (0..rooms)
        .map(|room| Distribution::mean(&parts.iter().map(|(_, said)| said[room]).collect::<Vec<_>>(), &weights))
        .collect();
    let pairs = || plain.iter().copied().zip(labels.iter().copied());
    let count = folds.iter().max().map_or(0, |most| most + 1);
    let of_folds: Vec<f64> = (0..count)
        .map(|fold| fitted(pairs().zip(folds).filter(|(_, of)| **of != fold).map(|(pair, _)| pair)))
        .collect();
    let said = plain.iter().zip(folds).map(|(said, &fold)| said.at_temperature(of_folds[fold])).collect();
    Some(Unseen { said, temperature: fitted(pairs()) })
}

/// A mean is less sure than its parts, and on buildings of the kind they learned from rightly surer; on others hardly (`docs/blend.md`
/// has both). So it is made a little surer at most.
fn fitted(unseen: impl Iterator<Item = (Distribution, Label)>) -> f64 {
    fitted_temperature(unseen).max(LEAST_TEMPERATURE)
}

/// On other sources the calibration error stays at 0.06 down to this temperature.
const LEAST_TEMPERATURE: f64 = 0.9;

/// `All four parts say big room: ...` or which part says what.
fn who_said_what(said: &[(&Part, Distribution)], label: Label, mean: Label) -> String {
    let mut by_label: BTreeMap<Label, Sayers> = BTreeMap::new();
    for (part, said) in said {
        let (says, sure) = said.likeliest();
        let sayers = by_label.entry(says).or_default();
        sayers.are_several |= matches!(part.by, By::Committee { .. }) || !sayers.names.is_empty();
        sayers.names.push(format!("the {} ({:.0} %)", part.title(), 100.0 * sure));
    }
    let for_it = by_label.remove(&label);
    let mut sentence = match &for_it {
        None if mean == label => format!("No part says {label} first, but together they make it most likely"),
        None => format!("No part says {label} first, but the labels given to rooms like it do"),
        Some(sayers) => format!("{} {label}", capital(&sayers.say())),
    };
    for (other, sayers) in by_label {
        sentence.push_str(&format!("; {} {other}", sayers.say()));
    }
    sentence + "."
}

/// The parts that say the same label.
#[derive(Default)]
struct Sayers {
    names: Vec<String>,
    are_several: bool,
}

impl Sayers {
    /// Subject and verb.
    fn say(&self) -> String {
        format!("{} {}", and_list(&self.names), if self.are_several { "say" } else { "says" })
    }
}

fn capital(text: &str) -> String {
    crate::base::wording::sentence(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::PlanClassifier;
    use crate::classify::models::Models;

    fn part(name: &str, weight: f64) -> Part {
        Part { weight, by: By::Model(Models::bundled().named(name).unwrap().unwrap()) }
    }

    #[test]
    fn a_blend_is_the_mean_of_its_parts_and_says_which_part_said_what() {
        let blend = Blend::new(vec![part("office-joint", 3.0), part("office-mlp", 1.0)], 1.0).unwrap();
        let (_, plan) = crate::store::bundled_plans().unwrap().into_iter().next().unwrap();
        let network = RoomNetwork::new(&plan, &crate::labels::Schemes::bundled());
        let opinions = blend.opinions(&network, &[]);
        for (room, said) in opinions.distributions.iter().enumerate() {
            for label in Label::ALL {
                let of = |part: usize| opinions.heard.of_parts[part][room].probability(label);
                assert!((said.probability(label) - 0.75 * of(0) - 0.25 * of(1)).abs() < 1e-9);
            }
            let why = blend.why(&opinions, &network, &[], room, Units::Metric).unwrap();
            assert_eq!(why.label, said.label());
            for who in ["joint classifier of offices (", "multilayer perceptron of offices ("] {
                assert!(why.conclusion.contains(who), "{}", why.conclusion);
            }
        }
    }

    #[test]
    fn a_blend_takes_no_other_part_than_it_was_made_with() {
        let blend = Blend::new(vec![part("office-joint", 2.0), part("office-mlp", 1.0)], 1.25).unwrap();
        let value = blend.to_value();
        let read =
            Blend::from_value(&value, 1.25, &|name| Some(Models::bundled().named(name)?.ok()? as Arc<dyn Member>))
                .unwrap();
        assert_eq!((read.to_value(), read.temperature()), (value.clone(), 1.25));
        let missing = Blend::from_value(&value, 1.25, &|_| None).unwrap_err();
        assert_eq!(missing, "its part 'office-joint' is not beside it");
        let other =
            Blend::from_value(
                &value,
                1.25,
                &|_| Some(Models::bundled().named("house-joint")?.ok()? as Arc<dyn Member>),
            )
            .unwrap_err();
        assert_eq!(other, "its part 'office-joint' is another model than the one it was made with");
        assert!(Blend::new(Vec::new(), 1.0).is_none() && Blend::new(vec![part("office-mlp", 0.0)], 1.0).is_none());
    }

    fn after<'a>(blend: &'a Blend, opinions: &'a Opinions) -> Option<Earlier<'a>> {
        Some(Earlier { blend, opinions, looks_same: false })
    }

    #[test]
    fn a_committee_is_in_the_blend_itself_and_answers_after_an_edit_as_before() {
        let PlanClassifier::Blend(blend) = &Models::bundled().named("office-blend").unwrap().unwrap().classifier else {
            panic!("no blend");
        };
        let mut value = blend.to_value();
        let find = |name: &str| Some(Models::bundled().named(name)?.ok()? as Arc<dyn Member>);
        let read = Blend::from_value(&value, blend.temperature(), &find).unwrap();
        let (_, plan) = crate::store::bundled_plans().unwrap().into_iter().next().unwrap();
        let network = RoomNetwork::new(&plan, &crate::labels::Schemes::bundled());
        let opinions = read.opinions(&network, &[]);
        assert_eq!(opinions.distributions, blend.opinions(&network, &[]).distributions);
        let first = read.opinions_after(&network, &[], None);
        let second = read.opinions_after(&network, &[], after(&read, &first));
        assert_eq!((&first.distributions, &second.distributions), (&opinions.distributions, &opinions.distributions));
        // After another blend, which has a part in common.
        let PlanClassifier::Blend(other) = &Models::bundled().named("school-blend").unwrap().unwrap().classifier else {
            panic!("no blend");
        };
        let has_part = |blend: &Blend, by: &By| blend.parts.iter().any(|part| part.by.is(by));
        assert_eq!(blend.parts.iter().filter(|part| has_part(other, &part.by)).count(), 1);
        let foreign = other.opinions_after(&network, &[], after(&read, &first));
        assert_eq!(foreign.distributions, other.opinions(&network, &[]).distributions);
        let back = blend.opinions_after(&network, &[], after(other, &foreign));
        assert_eq!(back.distributions, opinions.distributions);
        let why = read.why(&opinions, &network, &[], 0, Units::Metric).unwrap();
        assert!(why.conclusion.contains("multilayer perceptrons of offices ("), "{}", why.conclusion);

        let committee = value["parts"].as_array_mut().unwrap().iter_mut().find(|it| it.get("committee").is_some());
        let committee = committee.unwrap();
        committee["set"] = json!("");
        let refused = Blend::from_value(&value, 1.0, &find).unwrap_err();
        assert_eq!(refused, "its committee has no set or weight");
        let many = json!({ "parts": vec![json!({}); 101] });
        assert_eq!(Blend::from_value(&many, 1.0, &find).unwrap_err(), "its 101 parts are more than 100");
    }

    #[test]
    fn temperatures_come_from_the_other_folds() {
        // Both parts are right in three of four rooms, and surer than that.
        let labels: Vec<Label> =
            (0..400).map(|room| if room % 4 == 0 { Label::MediumRoom } else { Label::SmallRoom }).collect();
        let sure = vec![Distribution::from_weights([0.95, 0.05, 0.0, 0.0, 0.0]); 400];
        let folds: Vec<usize> = (0..400).map(|room| room / 40).collect();
        let parts = [(1.0, sure.clone()), (1.0, sure)];
        let unseen = blend_unseen(&parts, &labels, &folds).unwrap();
        assert!((unseen.said[7].probability(Label::SmallRoom) - 0.75).abs() < 0.02, "{:?}", unseen.said[7]);
        assert!(blend_unseen(&parts, &labels, &folds[1..]).is_none());
    }
}
