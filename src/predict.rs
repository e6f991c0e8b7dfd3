//! Predictions for the rooms of a plan: which model fits the plan, and what it predicts for each room.
//! The one function behind the window, the command line and scripts; fast enough to run after every edit.

pub mod explored;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, OnceLock};

use crate::base::units::Units;
use crate::base::wording::{count, sentence};
use crate::classify::blend::{Earlier, Opinions};
use crate::classify::explain::{NearRoom, Reason};
use crate::classify::in_plan::{self, InPlan};
use crate::classify::joint::FirstRound;
use crate::classify::learned::Acquaintance;
use crate::classify::model_file::ModelFileError;
use crate::classify::models::{Models, StoredModel, bundled_typologies, bundled_unknown};
use crate::classify::typology::TypologyReason;
use crate::classify::why::{OnPlan, Why};
use crate::classify::{Distribution, Method, PlanClassifier};
use crate::dataset::sets::STANDARD;
use crate::dataset::{NetworkDoor, RoomNetwork};
use crate::features::{Features, NeighbourLabels};
use crate::labels::{Label, Typology};
use crate::plan::{OpeningId, RoomId};

/// Which models predict.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ModelSet {
    /// Those of the plan's own typology; those of all typologies if there are none of its own; inferred from the plan if
    /// it has no typology, or the method has no model of its own.
    #[default]
    OfPlan,
    /// Those of the typology inferred from the plan, whatever the plan states.
    Auto,
    /// Those of a typology that has models, or of [`STANDARD`].
    Named(String),
    /// The model with this name, whatever its method.
    Model(String),
}

impl ModelSet {
    /// Its name on the command line and in scripts.
    pub fn name(&self) -> &str {
        match self {
            Self::OfPlan => "plan",
            Self::Auto => "auto",
            Self::Named(name) | Self::Model(name) => name,
        }
    }

    /// The name for menus.
    pub fn title(&self) -> String {
        match self {
            Self::OfPlan => "Set for the plan".to_owned(),
            Self::Auto => "Inferred from the plan".to_owned(),
            Self::Named(name) if name == STANDARD => "Any kind of building".to_owned(),
            Self::Named(name) => sentence(name),
            Self::Model(name) => name.clone(),
        }
    }

    /// A description, in a sentence without a full stop.
    pub fn help(&self) -> String {
        match self {
            Self::OfPlan => {
                "Predict with models for the typology set for this plan; where none is set, it is inferred from the plan"
                    .to_owned()
            }
            Self::Auto => "Infer the typology from the number of rooms, their areas and openings, even where one is set, \
                           and predict with models for it"
                .to_owned(),
            Self::Named(name) if name == STANDARD => {
                "Predict with models that learned from all kinds of buildings together".to_owned()
            }
            Self::Named(name) => format!("Predict with models that learned from plans of the typology '{name}'"),
            Self::Model(name) => format!("Predict with your own model '{name}'"),
        }
    }

    /// All choices, in menu order: the plan's, inferred, the available sets, the user's own models.
    pub fn all(models: &Models) -> Vec<Self> {
        let named = models.sets().into_iter().map(|set| Self::Named(set.to_owned()));
        let own = models.own().iter().map(|model| Self::Model(model.name.clone()));
        [Self::OfPlan, Self::Auto].into_iter().chain(named).chain(own).collect()
    }

    /// Parses a word: 'plan', 'auto', the name of a set in any case, or that of a model.
    ///
    /// # Errors
    /// When there are no models with that name.
    pub fn read(word: &str, models: &Models) -> Result<Self, UnknownSet> {
        let wanted = word.trim();
        let found = Self::all(models).into_iter().find(|set| match set {
            Self::Model(name) => name == wanted,
            set => set.name() == wanted.to_lowercase(),
        });
        let bundled = || models.named(wanted).map(|_| Self::Model(wanted.to_owned()));
        found.or_else(bundled).ok_or_else(|| UnknownSet {
            word: word.to_owned(),
            sets: models.sets().into_iter().map(str::to_owned).collect(),
        })
    }
}

/// There are no models with that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownSet {
    pub word: String,
    /// The available sets.
    pub sets: Vec<String>,
}

impl fmt::Display for UnknownSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "there are no models of the typology '{}'; use plan, auto or one of {}, or train one with 'enfilade train'",
            self.word,
            self.sets.join(", ")
        )
    }
}

impl std::error::Error for UnknownSet {}

/// The default method: the best on buildings never seen (`docs/blend.md`).
pub const DEFAULT_METHOD: Method = Method::Blend;

/// Which of the available models are to predict.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Predictor {
    pub set: ModelSet,
    pub method: Method,
}

impl Default for Predictor {
    fn default() -> Self {
        Self { set: ModelSet::default(), method: DEFAULT_METHOD }
    }
}

impl Predictor {
    /// Classifies the rooms of a network by one of the available models. `known` holds, for each room,
    /// the label that may be used when it is a neighbour; without `neighbours`, they are taken as in the
    /// model's training.
    ///
    /// # Errors
    /// When there is no model for the set and the method.
    pub fn predict(
        &self,
        network: impl Into<Arc<RoomNetwork>>,
        known: &[Option<Label>],
        neighbours: Option<NeighbourLabels>,
        models: &Models,
    ) -> Result<Predictions, ModelFileError> {
        self.predict_as(network, None, known, neighbours, models, After::Nothing)
    }

    /// The same by the models of a choice that was made before, and after what was predicted before.
    ///
    /// # Errors
    /// As [`Predictor::predict`].
    pub fn predict_as(
        &self,
        network: impl Into<Arc<RoomNetwork>>,
        choice: Option<Choice>,
        known: &[Option<Label>],
        neighbours: Option<NeighbourLabels>,
        models: &Models,
        after: After<'_>,
    ) -> Result<Predictions, ModelFileError> {
        let network = network.into();
        if let ModelSet::Model(name) = &self.set
            && let Some(model) = models.named(name)
        {
            let model = model?;
            let choice = Choice::of_model(&model);
            return Ok(Predictions::after(network, choice, model, known, neighbours, after));
        }
        let choice = choice.unwrap_or_else(|| self.choose(&network, models));
        if self.method == DEFAULT_METHOD
            && let Some(model) = models.default_of(&choice.set)
        {
            return Ok(Predictions::new(network, choice, model, known, neighbours));
        }
        let method = models.method_for(&choice.set, self.method).unwrap_or(self.method);
        let model = models.find(&choice.set, method)?;
        Ok(Predictions::after(network, choice, model, known, neighbours, after))
    }

    /// Chooses the set of models for a plan.
    pub fn choose(&self, network: &RoomNetwork, models: &Models) -> Choice {
        let stated = network.typology.as_ref();
        match (&self.set, stated) {
            (ModelSet::Named(name) | ModelSet::Model(name), _) => Choice::stated(name, "as told"),
            (ModelSet::OfPlan, Some(stated))
                if self.method == DEFAULT_METHOD && models.default_of(stated.as_str()).is_some() =>
            {
                Choice::stated(stated.as_str(), "set for the plan")
            }
            (ModelSet::OfPlan, Some(stated)) => match models.method_for(stated.as_str(), self.method) {
                Some(_) => Choice::stated(stated.as_str(), "set for the plan"),
                // Models of another typology would know it less well than those of all.
                None if models.methods(stated.as_str()).is_empty() => {
                    let because = format!("there are no models of the typology '{}'", stated.as_str());
                    Choice::stated(STANDARD, &because)
                }
                None => infer(network),
            },
            (ModelSet::OfPlan, None) | (ModelSet::Auto, _) => infer(network),
        }
    }
}

/// Which set of models classifies a plan, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// A typology, or [`STANDARD`].
    pub set: String,
    /// The reason, in a few words: 'set for the plan'.
    pub because: String,
    /// If inferred: the probability of each typology, most probable first, 0..=1.
    pub posterior: Vec<(Typology, f64)>,
    /// If inferred: the evidence for it, strongest first.
    pub reasons: Vec<TypologyReason>,
}

impl Choice {
    /// The evidence in a sentence without its end, with areas in these units; empty if nothing was inferred.
    pub fn reasons_in_words(&self, units: Units) -> String {
        self.reasons.iter().map(|reason| reason.words(units)).collect::<Vec<_>>().join("; ")
    }

    /// The choice of one model, whatever the plan.
    fn of_model(model: &StoredModel) -> Self {
        Self::stated(model.set(), "of the model")
    }

    /// A choice that needs no inference.
    pub fn stated(set: &str, because: &str) -> Self {
        Self { set: set.to_owned(), because: because.to_owned(), posterior: Vec::new(), reasons: Vec::new() }
    }
}

/// A typology that is less likely than this decides nothing: the models of all typologies are used.
const SURE: f64 = 0.45;

/// Infers the typology from the plan itself, as [`RoomNetwork::without_typology`] sees it.
pub fn infer(network: &RoomNetwork) -> Choice {
    let Some(model) = bundled_typologies().filter(|_| !network.rooms.is_empty()) else {
        return Choice::stated(STANDARD, "the plan has no typology");
    };
    // Labels that a person gave, not those that follow from functions: which follow depends on the typology.
    let known: Vec<Option<Label>> =
        network.rooms.iter().map(|room| room.label.filter(|_| room.label_origin.is_some())).collect();
    let posterior = model.posterior(network, &known);
    let Some((typology, probability)) = posterior.first().cloned() else {
        return Choice::stated(STANDARD, "the plan has no typology");
    };
    let percent = 100.0 * probability;
    if probability < SURE {
        let because = format!("unsure: {} is only {percent:.0} % likely", typology.as_str());
        return Choice { posterior, ..Choice::stated(STANDARD, &because) };
    }
    let because = format!("inferred from the plan, {percent:.0} % sure");
    Choice { set: typology.as_str().to_owned(), because, posterior, reasons: model.reasons(network, &known) }
}

/// What was predicted before, from which the next predictions are worked out faster, with the same result.
#[derive(Clone, Copy, Debug, Default)]
pub enum After<'a> {
    /// Nothing, nor will anything follow.
    #[default]
    Nothing,
    /// Nothing, but edits of the plan will follow.
    Start,
    /// The predictions before an edit of the plan, made for edits to follow.
    Edit(&'a Predictions),
}

/// What explanations start from, besides the result: by the kind of classifier.
#[derive(Clone, Debug)]
enum Origin {
    Each(in_plan::Said),
    Joint(Box<FirstRound>),
    Blend(Box<Opinions>),
}

/// A model's predictions for a plan's rooms.
#[derive(Clone, Debug)]
pub struct Predictions {
    pub choice: Choice,
    pub model: Arc<StoredModel>,
    pub network: Arc<RoomNetwork>,
    /// The labels that could be used, one per room.
    known: Vec<Option<Label>>,
    /// Which labels of neighbours counted.
    pub neighbours: NeighbourLabels,
    pub result: InPlan,
    /// Where explanations start.
    origin: Origin,
    index_of: Arc<BTreeMap<RoomId, usize>>,
    /// See [`Predictions::acquaintance`].
    acquaintance: OnceLock<Option<Acquaintance>>,
}

fn ids(network: &RoomNetwork) -> impl Iterator<Item = RoomId> {
    network.rooms.iter().map(|room| room.id)
}

impl Predictions {
    /// Classifies the rooms of a network with one model, whatever the plan's typology.
    pub fn by(
        network: impl Into<Arc<RoomNetwork>>,
        model: Arc<StoredModel>,
        known: &[Option<Label>],
        neighbours: Option<NeighbourLabels>,
    ) -> Self {
        let choice = Choice::of_model(&model);
        Self::new(network, choice, model, known, neighbours)
    }

    /// Classifies the rooms of a network. `known` holds, for each room, the label that may be used when
    /// it is a neighbour; without `neighbours`, they are taken as in the model's training.
    pub fn new(
        network: impl Into<Arc<RoomNetwork>>,
        choice: Choice,
        model: Arc<StoredModel>,
        known: &[Option<Label>],
        neighbours: Option<NeighbourLabels>,
    ) -> Self {
        Self::after(network.into(), choice, model, known, neighbours, After::Nothing)
    }

    /// The same, after what was predicted before: the result does not depend on it.
    pub fn after(
        network: Arc<RoomNetwork>,
        choice: Choice,
        model: Arc<StoredModel>,
        known: &[Option<Label>],
        neighbours: Option<NeighbourLabels>,
        after: After<'_>,
    ) -> Self {
        let is_kept = !matches!(after, After::Nothing);
        let earlier = match after {
            After::Edit(before) if Arc::ptr_eq(&before.model, &model) => Some(before),
            _ => None,
        };
        let before = earlier.map(|before| &before.origin);
        let neighbours = neighbours.unwrap_or(model.about.neighbours);
        // Two rounds of its own: neighbours' predicted labels, or known ones.
        let of_plan = |distributions: Vec<Distribution>| {
            let seen: Vec<Label> = distributions.iter().map(Distribution::label).collect();
            let features = (0..network.rooms.len()).map(|room| network.features(room, &seen)).collect();
            InPlan { distributions, features, rounds: 2, settled: true }
        };
        let (neighbours, result, origin) = match &model.classifier {
            PlanClassifier::Each(classifier) => {
                let before = before.and_then(|before| if let Origin::Each(said) = before { Some(said) } else { None });
                let (result, said) = in_plan::classify_after(classifier, &network, known, neighbours, before);
                (neighbours, result, Origin::Each(if is_kept { said } else { in_plan::Said::default() }))
            }
            PlanClassifier::Joint(joint) => {
                let before =
                    before.and_then(|it| if let Origin::Joint(round) = it { Some(round.as_ref()) } else { None });
                let (round, distributions) = if is_kept {
                    joint.predict_after(&network, known, None, before)
                } else {
                    let round = joint.first_round(&network);
                    let distributions = joint.predict_from(&round, known);
                    (round, distributions)
                };
                (NeighbourLabels::Predicted, of_plan(distributions), Origin::Joint(Box::new(round)))
            }
            PlanClassifier::Blend(blend) => {
                let before = match after {
                    After::Edit(before) => match (&before.model.classifier, &before.origin) {
                        (PlanClassifier::Blend(blend), Origin::Blend(opinions)) => {
                            Some(Earlier { blend, opinions, looks_same: network.looks_like(&before.network) })
                        }
                        _ => None,
                    },
                    After::Nothing | After::Start => None,
                };
                let opinions = if is_kept {
                    blend.opinions_after(&network, known, before)
                } else {
                    blend.opinions(&network, known)
                };
                let distributions = opinions.distributions.clone();
                (NeighbourLabels::Predicted, of_plan(distributions), Origin::Blend(Box::new(opinions)))
            }
        };
        let same = earlier.filter(|earlier| ids(&earlier.network).eq(ids(&network)));
        let index_of = same.map(|earlier| earlier.index_of.clone());
        let index_of = index_of.unwrap_or_else(|| Arc::new(ids(&network).zip(0..).collect()));
        Self {
            choice,
            model,
            network,
            known: known.to_vec(),
            neighbours,
            result,
            origin,
            index_of,
            acquaintance: OnceLock::new(),
        }
    }

    /// The distribution for a room; `None` if it is not classified.
    pub fn distribution(&self, room: RoomId) -> Option<&Distribution> {
        self.index_of.get(&room).map(|&index| &self.result.distributions[index])
    }

    /// The predicted label of a room; `None` if it is not classified.
    pub fn label(&self, room: RoomId) -> Option<Label> {
        self.distribution(room).map(Distribution::label)
    }

    /// Why a room got its label, with areas in these units; `None` if it is not classified.
    pub fn why(&self, room: RoomId, units: Units) -> Option<Why> {
        let &index = self.index_of.get(&room)?;
        match (&self.model.classifier, &self.origin) {
            (PlanClassifier::Each(classifier), _) => {
                Some(classifier.explain(&self.result.features[index].values()).why(units))
            }
            (PlanClassifier::Joint(joint), Origin::Joint(round)) => {
                Some(joint.explain_from(round, &self.network, &self.known, index)?.why(units))
            }
            (PlanClassifier::Blend(blend), Origin::Blend(opinions)) => {
                blend.why(opinions, &self.network, &self.known, index, units)
            }
            (PlanClassifier::Joint(_) | PlanClassifier::Blend(_), _) => None,
        }
    }

    /// The rooms that the model learned from that are most like a room, nearest first, if its label follows from these; with
    /// the room's own features.
    pub fn nearest(&self, room: RoomId) -> Option<(Features, Vec<NearRoom>)> {
        let PlanClassifier::Each(classifier) = &self.model.classifier else { return None };
        let features = self.result.features[*self.index_of.get(&room)?];
        match classifier.explain(&features.values()).reason {
            Reason::Neighbours(reason) => Some((features, reason.neighbours)),
            Reason::Rule(_) | Reason::Path(_) | Reason::Features(_) => None,
        }
    }

    /// What is to be marked on the plan where a point of a room's reason is seen; nothing for a room that is not
    /// classified.
    pub fn marks(&self, room: RoomId, on_plan: &OnPlan) -> Marks {
        let mut marks = Marks { room, shows_area: false, shows_axes: false, rooms: Vec::new(), openings: Vec::new() };
        let Some(of) = self.index_of.get(&room).and_then(|&index| self.network.rooms.get(index)) else { return marks };
        match on_plan {
            OnPlan::Area => marks.shows_area = true,
            OnPlan::Axes => marks.shows_axes = true,
            OnPlan::Openings(to) => {
                let leads = |door: &&NetworkDoor| {
                    to.is_none_or(|label| door.to.is_some_and(|other| self.seen_label(other) == Some(label)))
                };
                marks.openings = of.doors.iter().filter(leads).map(|door| door.opening).collect();
                marks.openings.dedup();
            }
            OnPlan::Rooms(rooms) => {
                marks.rooms = rooms.iter().filter_map(|&other| Some(self.network.rooms.get(other)?.id)).collect();
            }
        }
        marks
    }

    /// The label that counted for a room when others had it as a neighbour.
    fn seen_label(&self, index: usize) -> Option<Label> {
        let temporary = self.network.rooms.get(index)?.temporary;
        let known = self.known.get(index).copied().flatten();
        Some(match self.neighbours {
            NeighbourLabels::Temporary => temporary,
            NeighbourLabels::True => known.unwrap_or(temporary),
            NeighbourLabels::Predicted => {
                known.or_else(|| self.result.distributions.get(index).map(Distribution::label))?
            }
        })
    }

    /// The predicted labels of all classified rooms.
    pub fn labels(&self) -> BTreeMap<RoomId, Label> {
        self.index_of.iter().map(|(&room, &index)| (room, self.result.distributions[index].label())).collect()
    }

    /// How sure the predictions of all classified rooms are: the probability of each label, 0..=1.
    pub fn sureness(&self) -> BTreeMap<RoomId, f64> {
        self.index_of.iter().map(|(&room, &index)| (room, self.result.distributions[index].sureness())).collect()
    }

    /// What lies behind each opening that leads into unexplored space (or outside), should there be a
    /// room: the room on this side by its index in the network, the opening, and the distribution over
    /// labels. Unknown labels are taken as predicted. Empty for models of a set without a bundled
    /// predictor for this.
    pub fn unknown(&self) -> Vec<(usize, OpeningId, Distribution)> {
        let Some(unknown) = bundled_unknown(&self.choice.set) else { return Vec::new() };
        let said = &self.result.distributions;
        let labels: Vec<Option<Label>> =
            said.iter().zip(&self.known).map(|(said, known)| known.or_else(|| Some(said.label()))).collect();
        let mut behind = Vec::new();
        for (room, of) in self.network.rooms.iter().enumerate() {
            for (index, door) in of.doors.iter().enumerate().filter(|(_, door)| door.to.is_none()) {
                if let Some(distribution) = unknown.predict(&self.network, &labels, room, index) {
                    behind.push((room, door.opening, distribution));
                }
            }
        }
        behind
    }

    /// The number of rooms with a known label, and how many of these are predicted correctly.
    pub fn agreement(&self) -> Agreement {
        let pairs = self.network.rooms.iter().zip(&self.result.distributions);
        let known = pairs.filter_map(|(room, said)| Some(room.label? == said.label()));
        known.fold(Agreement::default(), |sum, right| Agreement {
            known: sum.known + 1,
            right: sum.right + usize::from(right),
        })
    }

    /// What the model has to do with the plan, where it learned from it. Computed once: it compares every
    /// room with all that the model learned from, tens of milliseconds for 25,000 rooms.
    pub fn acquaintance(&self) -> Option<&Acquaintance> {
        let compare = || self.model.about.learned.as_ref()?.acquaintance(&self.network);
        self.acquaintance.get_or_init(compare).as_ref()
    }

    /// How neighbours' labels were taken, in words.
    pub fn neighbours_in_words(&self) -> String {
        match (self.neighbours, self.result.settled) {
            (NeighbourLabels::Predicted, true) => {
                format!("predicted, stable after {}", count(self.result.rounds, "round"))
            }
            (NeighbourLabels::Predicted, false) => {
                format!("predicted, not stable after {}", count(self.result.rounds, "round"))
            }
            (mode, _) => mode.name().to_owned(),
        }
    }
}

/// What is marked on the plan for a point of a room's reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Marks {
    /// The room in question.
    pub room: RoomId,
    /// Whether its area, its axes are shown.
    pub shows_area: bool,
    pub shows_axes: bool,
    /// Other rooms.
    pub rooms: Vec<RoomId>,
    /// Openings, in the order they are counted in.
    pub openings: Vec<OpeningId>,
}

/// How predictions compare with the labels that are known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Rooms with a known label.
    pub known: usize,
    /// Those predicted correctly.
    pub right: usize,
}

impl Agreement {
    /// Adds the counts of another plan.
    pub fn add(&mut self, other: Self) {
        self.known += other.known;
        self.right += other.right;
    }

    /// Share of the known labels that are predicted correctly, 0..=1; `None` if none is known.
    pub fn share(self) -> Option<f64> {
        (self.known > 0).then(|| self.right as f64 / self.known as f64)
    }
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.share() {
            None => f.write_str("no room has a label to compare with"),
            Some(share) => {
                let Self { known, right } = self;
                write!(f, "{right} of {known} known labels predicted correctly ({:.0} %)", 100.0 * share)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Schemes;

    #[test]
    fn a_default_predicts_where_nobody_asks_for_a_method() {
        let plans = crate::store::bundled_plans().expect("the bundled plans read");
        let house = &plans.iter().find(|(name, _)| name.starts_with("dwelling")).expect("a house").1;
        let network = RoomNetwork::new(house, &Schemes::bundled());
        let defaults = BTreeMap::from([("house".to_owned(), "house-knn".to_owned())]);
        let models = Models::bundled().with_defaults(defaults);
        let by = |method: Method, models: &Models| {
            let predictor = Predictor { method, ..Predictor::default() };
            predictor.predict(network.clone(), &[], None, models).expect("there is a model").model.name.clone()
        };
        assert_eq!(by(DEFAULT_METHOD, &models), "house-knn");
        assert_eq!(by(Method::Joint, &models), "house-joint");
        assert_eq!(by(DEFAULT_METHOD, &Models::bundled()), "house-blend");
        // One that is not there any more is none.
        let gone = Models::bundled().with_defaults(BTreeMap::from([("house".to_owned(), "gone".to_owned())]));
        assert_eq!(by(DEFAULT_METHOD, &gone), "house-blend");
    }
}
