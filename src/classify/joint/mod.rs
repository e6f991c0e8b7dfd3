//! The fifth classifier: all rooms of a plan together, each in relation to the others. Described for
//! readers in `docs/joint.md`, with its gains and what did not help.
//!
//! It has two rounds. In the first, a forest of random trees looks at each room's size, form and openings
//! in relation to the rest of its plan (`view`); it knows no labels. In the second, another forest also
//! sees what the first predicted for the surrounding rooms, or labels given by the user (`around`), so
//! that the labels of a plan agree. The second forest is trained on predictions of forests that had not
//! seen the building, as in use; and in half of its examples some rooms are known, so that it learns how
//! much to trust known labels.

mod altered;
mod around;
mod asked;
mod explain;
mod places;
mod room_by_room;
mod rows;
mod store;
mod trees;
mod view;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

pub use altered::Alterations;
pub use explain::{GroupEffect, JointExplanation, NeighbourEffect};
pub use room_by_room::by_other_rooms;
pub use store::JointModelError;
pub use view::Group;

use self::altered::Version;
use self::around::Around;
use self::asked::Held;
use self::places::Place;
use self::rows::Rows;
use self::trees::{Forest, Job, KEPT, Samples, VersionChoice};
use self::view::View;
use super::calibration::fitted_temperature;
use super::{Distribution, FoldScore, Scores};
use crate::base::lists::Lists;
use crate::base::random::{Random, seed_of_part};
use crate::base::work::{Cancelled, Work};
use crate::dataset::folds::{Folds, FoldsError};
use crate::dataset::{RoomNetwork, RoomPlace, places_among};
use crate::labels::{Label, Typology};
use crate::plan::RoomId;

/// Folds for first-round predictions of training rooms by forests not trained on their building.
const INNER_FOLDS: usize = 4;

/// How plans are altered while learning (`docs/joint.md` has what that is worth).
const ALTERATIONS: Alterations = Alterations { copies: 3, as_drawn: 0.5, scale: 0.15, left_out: 0.4 };

/// The trained fifth classifier.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    first: Forest,
    second: Forest,
    /// See [`Distribution::at_temperature`].
    temperature: f64,
    /// The median of each feature over the training rooms: what 'typical' means in explanations.
    typical: Vec<f32>,
    left_out: BTreeSet<Group>,
}

/// Why nothing was learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointTrainError {
    /// No room has a label.
    NoLabelledRooms,
    Cancelled,
}

impl fmt::Display for JointTrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoLabelledRooms => "there are no labelled rooms to learn from; label some rooms, or add plans",
            Self::Cancelled => "cancelled",
        })
    }
}

impl std::error::Error for JointTrainError {}

impl From<Cancelled> for JointTrainError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// Why there is no cross-validation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JointValidationError {
    Folds(FoldsError),
    Cancelled,
}

impl fmt::Display for JointValidationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folds(error) => error.fmt(f),
            Self::Cancelled => f.write_str("cancelled"),
        }
    }
}

impl std::error::Error for JointValidationError {}

/// The result of a cross-validation.
#[derive(Clone, Debug, PartialEq)]
pub struct JointValidated {
    /// The positions of the labelled rooms, in the order of the networks.
    pub places: Vec<RoomPlace>,
    /// For each of these, the prediction by a classifier that had not seen its building.
    pub predictions: Vec<Distribution>,
    /// For each the fold it was tested in.
    pub folds: Vec<usize>,
    pub scores: Scores,
}

/// The first-round features of one plan's rooms, and what the second round needs besides.
#[derive(Clone, Debug)]
struct Looked {
    view: View,
    rows: Rows,
    /// Whether no group of features was left out.
    is_whole: bool,
    /// Which rooms of the whole plan are joined, and where each lies among them.
    placed: Arc<(Lists, Vec<Place>)>,
}

impl Looked {
    /// A storey of flats is looked at flat by flat ([`RoomNetwork::flats`]): a dwelling's rooms are compared with each other, not with the
    /// neighbours'. What the flats share is compared with the whole storey.
    fn new(network: &RoomNetwork, left_out: &BTreeSet<Group>) -> Self {
        Self::after(network, left_out, None)
    }

    /// The same, after an edit: where rooms lie is found again where the same rooms are joined.
    fn after(network: &RoomNetwork, left_out: &BTreeSet<Group>, before: Option<&Self>) -> Self {
        let mut view = View::new(network);
        let known = before.map(|before| &before.placed).filter(|placed| placed.0 == view.joined);
        let placed = known.cloned().unwrap_or_else(|| Arc::new((view.joined.clone(), places::places(&view.joined))));
        let mut rows = view::features(network, &view, &placed.1);
        let flats = network.flats().map(|of| of.flats.as_slice()).unwrap_or_default();
        let mut alone: Vec<View> = Vec::with_capacity(flats.len());
        for flat in flats {
            let part = network.part(flat);
            let of_part = View::new(&part);
            let of_rooms = view::features(&part, &of_part, &places::places(&of_part.joined));
            for (&room, of_room) in flat.iter().zip(of_rooms.iter()) {
                rows.of_mut(room).copy_from_slice(of_room);
            }
            alone.push(of_part);
        }
        if !flats.is_empty() {
            view.put(flats, &alone);
        }
        rows.iter_mut().for_each(|row| blank(row, view::FEATURES, left_out));
        Self { view, rows, is_whole: left_out.is_empty(), placed }
    }

    /// The features of the second round.
    fn with_labels(&self, first: &[Distribution], known: &[Option<Label>], left_out: &BTreeSet<Group>) -> Rows {
        let around = Around::new(&self.view, first, known);
        let mut rows = Rows::with_capacity(self.rows.width() + around::FEATURES.len(), self.rows.len());
        for (row, mut told) in self.rows.iter().zip(around.of_rooms()) {
            blank(&mut told, around::FEATURES, left_out);
            rows.push(row.iter().copied().chain(told));
        }
        rows
    }

    /// The same for one room.
    fn with_labels_around(&self, room: usize, around: &Around<'_>, left_out: &BTreeSet<Group>) -> Vec<f32> {
        let mut told = around.of_room(room);
        blank(&mut told, around::FEATURES, left_out);
        [self.rows.of(room), &told].concat()
    }
}

/// The first round over a plan: the starting point of both predictions and their explanations.
#[derive(Clone, Debug)]
pub struct FirstRound {
    looked: Arc<Looked>,
    opinions: Vec<Distribution>,
    /// For the next plan, the rooms and what both forests said of them; empty where nothing is to be kept.
    held: HeldRooms,
}

/// What the forests said of a plan's rooms.
#[derive(Clone, Debug, Default)]
struct HeldRooms {
    rooms: Vec<RoomId>,
    first: Vec<Arc<Held>>,
    second: Vec<Arc<Held>>,
}

/// Sets the features of some groups to 0, so that no tree can split on them.
fn blank(values: &mut [f32], features: &[(Group, &str)], groups: &BTreeSet<Group>) {
    if groups.is_empty() {
        return;
    }
    for (value, (group, _)) in values.iter_mut().zip(features) {
        if groups.contains(group) {
            *value = 0.0;
        }
    }
}

/// The group of each feature of the second round.
fn group_of(feature: usize) -> Option<Group> {
    view::FEATURES.iter().chain(around::FEATURES).nth(feature).map(|(group, _)| *group)
}

impl Joint {
    /// Learns from the labelled rooms of plans. Plans of one building, by the name in
    /// [`RoomNetwork::group`], are taken for each other's witnesses: opinions on one never come from
    /// another. The same networks and seed give the same classifier on any number of threads. Progress
    /// counts trees, for each round anew.
    ///
    /// # Errors
    /// When no room has a label, or the work is cancelled.
    pub fn train(networks: &[&RoomNetwork], seed: u64, work: &Work<'_>) -> Result<Self, JointTrainError> {
        Self::train_without(networks, &BTreeSet::new(), seed, work)
    }

    /// The same with plans altered in another way, to measure what that is worth.
    ///
    /// # Errors
    /// As [`Joint::train`].
    pub fn train_altered(
        networks: &[&RoomNetwork],
        alterations: &Alterations,
        seed: u64,
        work: &Work<'_>,
    ) -> Result<Self, JointTrainError> {
        Self::learn(networks, alterations, &BTreeSet::new(), seed, work)
    }

    /// The same without some groups of features, to measure their worth.
    ///
    /// # Errors
    /// As [`Joint::train`].
    pub fn train_without(
        networks: &[&RoomNetwork],
        left_out: &BTreeSet<Group>,
        seed: u64,
        work: &Work<'_>,
    ) -> Result<Self, JointTrainError> {
        Self::learn(networks, &ALTERATIONS, left_out, seed, work)
    }

    fn learn(
        networks: &[&RoomNetwork],
        alterations: &Alterations,
        left_out: &BTreeSet<Group>,
        seed: u64,
        work: &Work<'_>,
    ) -> Result<Self, JointTrainError> {
        let places = labelled(networks);
        if places.is_empty() {
            return Err(JointTrainError::NoLabelledRooms);
        }
        let folds = inner_folds(networks, &places, seed);
        let count = folds.as_ref().map_or(0, Folds::count);
        // The fold that tests each room. A room without a label is in the fold of the first labelled room of its plan.
        let mut fold_of: Vec<Vec<usize>> = networks.iter().map(|network| vec![count; network.rooms.len()]).collect();
        if let Some(folds) = &folds {
            for (place, &fold) in places.iter().zip(folds.of_rows()).rev() {
                fold_of[place.network].fill(fold);
            }
            for (place, &fold) in places.iter().zip(folds.of_rows()) {
                fold_of[place.network][place.room] = fold;
            }
        }
        let classes = Classes::new(networks, &places);

        // Every plan as it is drawn, and as another source might have drawn it. The samples are the labelled rooms of all
        // versions, those of the plans as drawn first, in the order of `places`.
        let versions = Version::all(networks, alterations, seed_of_part(seed, 4));
        let looked = work.map(versions.len(), |version| Looked::new(&versions[version].network, left_out))?;
        let samples_of: Vec<(usize, usize)> = versions
            .iter()
            .enumerate()
            .flat_map(|(index, version)| version.network.labelled().map(move |room| (index, room)))
            .collect();
        let origin = |(version, room): (usize, usize)| {
            let version: &Version = &versions[version];
            RoomPlace { network: version.of, room: version.rooms[room] }
        };
        let sample = |samples: &mut Samples, at: (usize, usize), values: &[f32]| {
            let place = origin(at);
            samples.push(values, label(networks, place), classes.of(networks, place));
            samples.versions.push((place.network, versions[at.0].copy));
        };
        let folds_of: Vec<usize> =
            samples_of.iter().map(|&at| origin(at)).map(|place| fold_of[place.network][place.room]).collect();
        let choice = VersionChoice { copies: alterations.copies, as_drawn: alterations.as_drawn };

        // The first round: a forest for each fold that did not see it, and one trained on all rooms.
        let mut samples = Samples::default();
        for &at in &samples_of {
            sample(&mut samples, at, looked[at.0].rows.of(at.1));
        }
        let (of_folds, first) = grow(&samples, &folds_of, count, choice, seed_of_part(seed, 1), work)?;

        // Predictions for every room, by the forest not trained on it.
        let opinions = work.map(versions.len(), |index| {
            let version = &versions[index];
            let rooms = looked[index].rows.iter().zip(&version.rooms);
            rooms
                .map(|(values, &room)| of_folds.get(fold_of[version.of][room]).unwrap_or(&first).predict(values))
                .collect::<Vec<_>>()
        })?;

        // The second round: every version with no rooms known, and with some known.
        let mut random = Random::new(seed_of_part(seed, 2));
        let told: Vec<[Rows; 2]> = versions
            .iter()
            .zip(&looked)
            .zip(&opinions)
            .map(|((version, looked), opinions)| {
                let rooms = &version.network.rooms;
                let share = random.unit();
                let known: Vec<Option<Label>> =
                    rooms.iter().map(|room| room.label.filter(|_| random.unit() < share)).collect();
                let nothing = vec![None; rooms.len()];
                [nothing, known].map(|known| looked.with_labels(opinions, &known, left_out))
            })
            .collect();
        let mut samples = Samples::default();
        // All places with nothing known, then all of them with some rooms known.
        let knowing_some = samples_of.iter().map(|&at| (at, 1));
        for (at, knowing) in samples_of.iter().map(|&at| (at, 0)).chain(knowing_some) {
            sample(&mut samples, at, told[at.0][knowing].of(at.1));
        }
        let folds_of = folds_of.repeat(2);
        let (of_folds, second) = grow(&samples, &folds_of, count, choice, seed_of_part(seed, 3), work)?;
        let typical = samples.columns.iter().map(|column| median(&column[..places.len()])).collect();

        // Temperature from rooms whose building the forest had not seen.
        let unseen = places.iter().enumerate().filter_map(|(index, &place)| {
            let forest = of_folds.get(fold_of[place.network][place.room])?;
            let values: Vec<f32> = samples.columns.iter().map(|column| column[index]).collect();
            Some((forest.predict(&values), label(networks, place)))
        });
        let temperature = fitted_temperature(unseen);
        let [first, second] = [first, second].map(|forest| forest.shortened(KEPT));
        Ok(Self { first, second, temperature, typical, left_out: left_out.clone() })
    }

    /// The distribution of every room of a network. `known` holds the labels that may be used, by room:
    /// they are evidence for the other rooms, never for the room itself. In a list that is too short, the
    /// remaining rooms are unknown.
    pub fn predict(&self, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<Distribution> {
        self.predict_from(&self.first_round(network), known)
    }

    /// The first round, which needs no labels.
    pub fn first_round(&self, network: &RoomNetwork) -> FirstRound {
        self.first_round_from(Arc::new(Looked::new(network, &self.left_out)))
    }

    /// The same, after another classifier's first round over the same network: rooms are looked at once for both.
    pub fn first_round_after(&self, network: &RoomNetwork, other: &FirstRound) -> FirstRound {
        if !(self.left_out.is_empty() && other.looked.is_whole) {
            return self.first_round(network);
        }
        self.first_round_from(other.looked.clone())
    }

    fn first_round_from(&self, looked: Arc<Looked>) -> FirstRound {
        let opinions = self.first.predict_all(&looked.rows);
        FirstRound { looked, opinions, held: HeldRooms::default() }
    }

    /// Both rounds over the plan after an edit: `before` is this classifier's first round over the plan before it, if there
    /// was one, and `other` another classifier's over the same network. The result is that of [`Joint::first_round`] and
    /// [`Joint::predict_from`], to the last bit.
    pub fn predict_after(
        &self,
        network: &RoomNetwork,
        known: &[Option<Label>],
        other: Option<&FirstRound>,
        before: Option<&FirstRound>,
    ) -> (FirstRound, Vec<Distribution>) {
        let looked = match other.filter(|other| self.left_out.is_empty() && other.looked.is_whole) {
            Some(other) => other.looked.clone(),
            None => {
                let looked = before.map(|before| before.looked.as_ref());
                Arc::new(Looked::after(network, &self.left_out, looked))
            }
        };
        let rooms: Vec<RoomId> = network.rooms.iter().map(|room| room.id).collect();
        let places = before.map_or_else(Vec::new, |before| places_among(&before.held.rooms, &rooms));
        let place = |room: usize| places.get(room).copied().flatten();
        let held = before.map(|before| &before.held);
        let first_before = |room: usize| held?.first.get(place(room)?);
        let first = self.first.asked().predict_held(&looked.rows, first_before, |said| said);
        let opinions: Vec<Distribution> = first.iter().map(|held| held.said).collect();
        let rows = looked.with_labels(&opinions, known, &self.left_out);
        let finish = |said: Distribution| said.at_temperature(self.temperature);
        let second_before = |room: usize| held?.second.get(place(room)?);
        let second = self.second.asked().predict_held(&rows, second_before, finish);
        let distributions = second.iter().map(|held| held.said).collect();
        (FirstRound { looked, opinions, held: HeldRooms { rooms, first, second } }, distributions)
    }

    /// Like [`Joint::predict`], from a first round over the same network.
    pub fn predict_from(&self, round: &FirstRound, known: &[Option<Label>]) -> Vec<Distribution> {
        self.second_opinions(&round.looked, &round.opinions, known)
    }

    fn second_opinions(&self, looked: &Looked, first: &[Distribution], known: &[Option<Label>]) -> Vec<Distribution> {
        let said = self.second.predict_all(&looked.with_labels(first, known, &self.left_out));
        said.into_iter().map(|said| said.at_temperature(self.temperature)).collect()
    }

    /// The second forest's prediction for a room.
    fn answer(&self, values: &[f32]) -> Distribution {
        self.second.predict(values).at_temperature(self.temperature)
    }
}

/// The positions of the labelled rooms, in the order of the networks.
fn labelled(networks: &[&RoomNetwork]) -> Vec<RoomPlace> {
    let rooms = networks.iter().enumerate();
    rooms.flat_map(|(index, of)| of.labelled().map(move |room| RoomPlace { network: index, room })).collect()
}

/// The label of a room returned by [`labelled`].
fn label(networks: &[&RoomNetwork], place: RoomPlace) -> Label {
    networks[place.network].rooms[place.room].label.unwrap_or(Label::SmallRoom)
}

/// The classes that the forests' questions tell apart: functions rather than labels. What makes a classroom is more alike than
/// what makes a medium room; a leaf still counts labels, so that nobody is told a function, and none is asked for.
struct Classes<'a>(BTreeMap<(Option<&'a Typology>, &'a str, Label), u16>);

/// Rarer functions are told apart by their labels only.
const LEAST_OF_FUNCTION: usize = 5;

impl<'a> Classes<'a> {
    fn new(networks: &[&'a RoomNetwork], places: &[RoomPlace]) -> Self {
        let mut counts: BTreeMap<(Option<&Typology>, &str, Label), usize> = BTreeMap::new();
        for &place in places {
            *counts.entry(Self::key(networks, place)).or_default() += 1;
        }
        let mut frequent: Vec<_> = counts.into_iter().filter(|(_, rooms)| *rooms >= LEAST_OF_FUNCTION).collect();
        // The most frequent first, should there be too many.
        frequent.sort_by_key(|(_, rooms)| std::cmp::Reverse(*rooms));
        let numbers = Label::ALL.len() as u16..trees::MOST_CLASSES as u16;
        Self(frequent.into_iter().map(|(key, _)| key).zip(numbers).collect())
    }

    fn key(networks: &[&'a RoomNetwork], place: RoomPlace) -> (Option<&'a Typology>, &'a str, Label) {
        let network = networks[place.network];
        (network.typology.as_ref(), &network.rooms[place.room].function, label(networks, place))
    }

    /// The class of a room: its function together with its label, or else its label alone.
    fn of(&self, networks: &[&'a RoomNetwork], place: RoomPlace) -> u16 {
        let key = Self::key(networks, place);
        self.0.get(&key).copied().unwrap_or_else(|| key.2.index() as u16)
    }
}

/// Folds by building; by room if there is only one building; `None` for a single room.
fn inner_folds(networks: &[&RoomNetwork], places: &[RoomPlace], seed: u64) -> Option<Folds> {
    let labels: Vec<Label> = places.iter().map(|&place| label(networks, place)).collect();
    let buildings: Vec<&str> = places.iter().map(|place| networks[place.network].group.as_str()).collect();
    let distinct = buildings.iter().collect::<BTreeSet<_>>().len();
    Folds::grouped(&labels, &buildings, INNER_FOLDS.min(distinct), seed)
        .or_else(|_| Folds::stratified(&labels, INNER_FOLDS.min(labels.len()), seed))
        .ok()
}

/// A forest for each of `count` folds, trained on the samples of the others, and one trained on all.
fn grow(
    samples: &Samples,
    fold_of: &[usize],
    count: usize,
    choice: VersionChoice,
    seed: u64,
    work: &Work<'_>,
) -> Result<(Vec<Forest>, Forest), Cancelled> {
    let rows = |keep: &dyn Fn(usize) -> bool| -> Vec<u32> {
        (0..fold_of.len()).filter(|&row| keep(fold_of[row])).map(|row| row as u32).collect()
    };
    let mut chosen: Vec<Vec<u32>> = vec![rows(&|_| true)];
    chosen.extend((0..count).map(|fold| rows(&|of| of != fold)));
    let jobs: Vec<Job<'_>> = chosen
        .into_iter()
        .enumerate()
        .map(|(index, rows)| Job { samples, rows, choice, seed: seed_of_part(seed, index) })
        .collect();
    let mut forests = trees::grow(&jobs, work)?.into_iter();
    let of_all = forests.next().ok_or(Cancelled)?;
    Ok((forests.collect(), of_all))
}

fn median(numbers: &[f32]) -> f32 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Cross-validates with folds that never split a building and no known labels in the buildings predicted.
/// The same seed gives the same result on any number of threads. Progress counts folds.
///
/// # Errors
/// When there are fewer buildings with labelled rooms than folds, or the work is cancelled.
pub fn cross_validate(
    networks: &[&RoomNetwork],
    folds: usize,
    seed: u64,
    work: &Work<'_>,
) -> Result<JointValidated, JointValidationError> {
    cross_validate_without(networks, &BTreeSet::new(), folds, 0.0, seed, work)
}

/// The same without some groups of features, and with a random share `known` (0..=1) of the rooms of each
/// predicted plan known: what a partly labelled building gains.
///
/// # Errors
/// As [`cross_validate`].
pub fn cross_validate_without(
    networks: &[&RoomNetwork],
    left_out: &BTreeSet<Group>,
    folds: usize,
    known: f64,
    seed: u64,
    work: &Work<'_>,
) -> Result<JointValidated, JointValidationError> {
    validate(networks, left_out, &folds_of(networks, folds, seed)?, known, seed, &|_| {}, work)
}

/// The folds of [`cross_validate`]: one for each labelled room.
///
/// # Errors
/// When there are fewer buildings with labelled rooms than folds.
pub fn folds_of(networks: &[&RoomNetwork], folds: usize, seed: u64) -> Result<Folds, JointValidationError> {
    let places = labelled(networks);
    let labels: Vec<Label> = places.iter().map(|&place| label(networks, place)).collect();
    let buildings: Vec<&str> = places.iter().map(|place| networks[place.network].group.as_str()).collect();
    Folds::grouped(&labels, &buildings, folds, seed).map_err(JointValidationError::Folds)
}

/// The same on folds that are given: one for each labelled room, such that no plan is split.
///
/// # Errors
/// When the work is cancelled.
pub fn cross_validate_on(
    networks: &[&RoomNetwork],
    folds: &Folds,
    seed: u64,
    work: &Work<'_>,
) -> Result<JointValidated, JointValidationError> {
    cross_validate_telling(networks, folds, seed, &|_| {}, work)
}

/// The same; `told` hears of each fold when it is done, from any thread.
///
/// # Errors
/// As [`cross_validate_on`].
pub fn cross_validate_telling(
    networks: &[&RoomNetwork],
    folds: &Folds,
    seed: u64,
    told: &(dyn Fn(FoldScore) + Sync),
    work: &Work<'_>,
) -> Result<JointValidated, JointValidationError> {
    validate(networks, &BTreeSet::new(), folds, 0.0, seed, told, work)
}

fn validate(
    networks: &[&RoomNetwork],
    left_out: &BTreeSet<Group>,
    folds: &Folds,
    known: f64,
    seed: u64,
    told: &(dyn Fn(FoldScore) + Sync),
    work: &Work<'_>,
) -> Result<JointValidated, JointValidationError> {
    let places = labelled(networks);
    let labels: Vec<Label> = places.iter().map(|&place| label(networks, place)).collect();
    let predicted = work
        .map(folds.count(), |fold| {
            let seed = seed_of_part(seed, fold);
            let tested: BTreeSet<usize> = folds.test_rows(fold).into_iter().map(|row| places[row].network).collect();
            let taught: Vec<&RoomNetwork> =
                networks.iter().enumerate().filter(|(index, _)| !tested.contains(index)).map(|(_, &of)| of).collect();
            // The other threads are busy with other folds.
            let joint = Joint::train_without(&taught, left_out, seed, &Work::quiet().on_threads(1)).ok();
            let mut random = Random::new(seed);
            let mut predict = |network: usize| {
                let rooms = &networks[network].rooms;
                let known: Vec<_> = rooms.iter().map(|room| room.label.filter(|_| random.unit() < known)).collect();
                let said = joint.as_ref().map(|joint| joint.predict(networks[network], &known));
                (network, said.unwrap_or_else(|| vec![Distribution::UNIFORM; rooms.len()]))
            };
            let said: Vec<(usize, Vec<Distribution>)> = tested.into_iter().map(&mut predict).collect();
            let mut score = FoldScore { rooms: 0, right: 0 };
            for (network, said) in &said {
                for room in networks[*network].labelled() {
                    score.rooms += 1;
                    score.right += usize::from(networks[*network].rooms[room].label == Some(said[room].label()));
                }
            }
            told(score);
            said
        })
        .map_err(|Cancelled| JointValidationError::Cancelled)?;
    let mut of_network: Vec<Vec<Distribution>> = vec![Vec::new(); networks.len()];
    for (network, distributions) in predicted.into_iter().flatten() {
        of_network[network] = distributions;
    }
    let predictions: Vec<Distribution> = places.iter().map(|place| of_network[place.network][place.room]).collect();
    let rooms = folds.of_rows().iter().zip(&predictions).zip(&labels);
    let scores = Scores::of(rooms.map(|((&fold, prediction), &label)| (fold, prediction, label)));
    Ok(JointValidated { places, predictions, folds: folds.of_rows().to_vec(), scores })
}
