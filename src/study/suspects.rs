//! Labels that are probably wrong: rooms by the odds that their label is, as classifiers see it which did not learn from them
//! (confident learning without a threshold; Northcutt, Jiang and Chuang 2021). Several classifiers are asked, since each alone is wrong
//! about rooms of its own, and the mean of their log-probabilities counts. Rooms of the same size and form in one building speak
//! for each other. The review queue and `enfilade suspects` both stand on this.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::StudyError;
use super::noise::is_alike;
use crate::base::random::seed_of_part;
use crate::base::units::Units;
use crate::base::work::{Cancelled, Work};
use crate::classify::joint::{FirstRound, Joint, by_other_rooms};
use crate::classify::models::Models;
use crate::classify::{Algorithm, Distribution, Validation, evaluate_all};
use crate::dataset::folds::{Folds, Grouping, group_of};
use crate::dataset::table::Table;
use crate::dataset::{Collection, RoomNetwork, RoomPlace, Row, fold_table};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology, normalised_function};
use crate::predict::Predictor;

/// A room and what is said of its label.
#[derive(Clone, Debug)]
pub struct Suspect {
    pub row: Row,
    /// Where it stands in the collection.
    pub place: RoomPlace,
    /// What classifiers say that did not learn from the room, and the rooms like it in its building, together.
    pub said: Distribution,
    /// How many classifiers were asked, and how many of them find another label likelier.
    pub asked: usize,
    pub against: usize,
    /// What most other rooms of its function are labelled, if that is another label: the label, how many have it, of how many.
    pub by_function: Option<(Label, usize, usize)>,
    /// Other rooms of the building that are about as large and of the same form, by label.
    pub alike: [usize; 5],
    /// Why another label is more likely, in words; empty where the given one is the likeliest.
    pub reason: String,
}

impl Suspect {
    /// The probability of the label that is given, 0..=1.
    pub fn probability(&self) -> f64 {
        self.said.probability(self.row.label)
    }

    /// The odds that its label is wrong, up to a factor that is the same for all rooms, given how people err: half of the
    /// mistakes are any other label, half the neighbouring size, or hall for corridor.
    pub fn odds(&self) -> f64 {
        odds_of_mistake(&self.said, self.row.label)
    }
}

/// The odds that a label is wrong by what is said of the room, if wrong labels were as frequent as right ones. A label that is easily
/// mistaken for the right one is likelier to be given than another: it is assumed that one half of the mistakes are any other label,
/// and the other half those of the neighbouring sizes, and halls for corridors and the reverse.
fn odds_of_mistake(said: &Distribution, given: Label) -> f64 {
    /// Of mistakes, those that are no better than chance.
    const BY_CHANCE: f64 = 0.5;
    /// No opinion makes a label impossible.
    const LEAST: f64 = 1e-6;
    let of_truth = |truth: Label| {
        let easy = easily_mistaken(truth);
        let easily = if easy.contains(&given) { 1.0 / easy.len() as f64 } else { 0.0 };
        said.probability(truth) * (BY_CHANCE * 0.25 + (1.0 - BY_CHANCE) * easily)
    };
    let wrong: f64 = Label::ALL.into_iter().filter(|&truth| truth != given).map(of_truth).sum();
    // As many times as there are labels to mistake it for, so that a mistake by chance alone gives the odds of `said`.
    4.0 * wrong.max(LEAST) / said.probability(given).max(LEAST)
}

/// The labels that people give by mistake for a label.
const fn easily_mistaken(truth: Label) -> &'static [Label] {
    match truth {
        Label::SmallRoom | Label::BigRoom => &[Label::MediumRoom],
        Label::MediumRoom => &[Label::SmallRoom, Label::BigRoom],
        Label::Corridor => &[Label::Hall],
        Label::Hall => &[Label::Corridor],
    }
}

/// Opinions of classifiers that did not learn from a room, by kind of classifier, for each labelled room.
pub struct Opinions {
    /// Where each room stands, in the order of the collection's rows.
    pub places: Vec<RoomPlace>,
    pub rows: Vec<Row>,
    /// A name, and for each room what is said; `None` for rooms of which nobody could be asked.
    pub of: Vec<(String, Vec<Option<Distribution>>)>,
    /// By room: why, as the joint classifier sees it.
    reasons: Vec<String>,
    /// By room, see [`Suspect::by_function`].
    by_function: Vec<Option<(Label, usize, usize)>>,
}

/// All rooms, those whose given label is likeliest to be wrong first. Each typology is judged by itself. `work` counts folds.
///
/// # Errors
/// When the collection holds rows of a file rather than plans, has too few rooms, or the work is cancelled.
pub fn suspects(
    collection: &Collection,
    folds: usize,
    seed: u64,
    given: bool,
    work: &Work<'_>,
) -> Result<Vec<Suspect>, StudyError> {
    Ok(opinions(collection, folds, seed, given, work)?.suspects(collection.networks()))
}

/// The same, except that the models at hand are asked of typologies with few rooms, from which nothing can be learned.
///
/// # Errors
/// As [`suspects`].
pub fn suspects_by(
    collection: &Collection,
    folds: usize,
    seed: u64,
    models: &Models,
    work: &Work<'_>,
) -> Result<Vec<Suspect>, StudyError> {
    Ok(asked(collection, folds, seed, false, Some(models), work)?.suspects(collection.networks()))
}

/// With fewer rooms, or buildings, of a typology classifiers learn little from the others.
const FEW_ROOMS: usize = 200;
const FEW_BUILDINGS: usize = 5;

impl Opinions {
    /// All rooms, those whose given label is likeliest to be wrong first; of equals the first in the collection.
    fn suspects(&self, networks: &[RoomNetwork]) -> Vec<Suspect> {
        let alike = Alike::new(&self.rows, &self.places, networks);
        let mut rooms_of: BTreeMap<Option<&Typology>, usize> = BTreeMap::new();
        for row in &self.rows {
            *rooms_of.entry(row.typology.as_ref()).or_default() += 1;
        }
        let mut suspects: Vec<Suspect> = self
            .rows
            .iter()
            .enumerate()
            .map(|(index, row)| {
                let all = || self.of.iter().filter_map(move |(name, of)| Some((name.as_str(), of[index]?)));
                let learned_from = rooms_of.get(&row.typology.as_ref()).copied().unwrap_or_default();
                let said = together(all(), learned_from);
                // As much weight as what the classifiers say by themselves: they are right about rooms that have no like.
                let with_alike = Distribution::smoothed(alike.near[index], &said, 1.0);
                let said = together([("", said), ("", with_alike)].into_iter(), learned_from);
                let classifiers = || all().filter(|(name, _)| *name != BY_FUNCTION);
                let reason = if said.label() == row.label { String::new() } else { self.reasons[index].clone() };
                Suspect {
                    row: row.clone(),
                    place: self.places[index],
                    said,
                    asked: classifiers().count(),
                    against: classifiers().filter(|(_, said)| said.label() != row.label).count(),
                    by_function: self.by_function[index],
                    alike: alike.counts[index],
                    reason,
                }
            })
            .collect();
        suspects.sort_by(|p, q| q.odds().total_cmp(&p.odds()));
        suspects
    }
}

/// The rooms of a building that are like each other.
struct Alike {
    /// For each room the others by label, each by how near it is in size and form: 1 for the same, less the less alike.
    near: Vec<[f64; 5]>,
    /// The same in whole rooms, of those that are alike to 10 %.
    counts: Vec<[usize; 5]>,
}

impl Alike {
    fn new(rows: &[Row], places: &[RoomPlace], networks: &[RoomNetwork]) -> Self {
        let mut buildings: BTreeMap<(Option<&Typology>, &str), Vec<usize>> = BTreeMap::new();
        for (index, row) in rows.iter().enumerate() {
            buildings.entry((row.typology.as_ref(), group_of(row))).or_default().push(index);
        }
        let measures: Vec<[f64; 5]> = rows
            .iter()
            .zip(places)
            .map(|(row, place)| {
                let form = &networks[place.network].rooms[place.room].form;
                let log = |value: f64| value.max(0.1).ln();
                // A step of each is as much of a difference: 12 % of an area, 18 % of a side or an axes ratio, one opening.
                [
                    log(row.features.area_m2) / 0.12,
                    log(row.features.axes_ratio) / 0.18,
                    f64::from(row.features.doors),
                    log(form.length_m) / 0.18,
                    log(form.width_m) / 0.18,
                ]
            })
            .collect();
        let mut alike = Self { near: vec![[0.0; 5]; rows.len()], counts: vec![[0; 5]; rows.len()] };
        for of in buildings.values() {
            for &room in of {
                for &other in of.iter().filter(|&&other| other != room) {
                    let squares = measures[room].iter().zip(&measures[other]).map(|(p, q)| (p - q) * (p - q));
                    let label = rows[other].label.index();
                    alike.near[room][label] += (-squares.sum::<f64>() / 2.0).exp();
                    alike.counts[room][label] += usize::from(is_alike(&rows[room], &rows[other]));
                }
            }
        }
        alike
    }
}

/// What several say together who learned from so many rooms: the geometric mean of their probabilities.
fn together<'a>(said: impl Iterator<Item = (&'a str, Distribution)>, learned_from: usize) -> Distribution {
    /// No opinion alone rules a label out.
    const LEAST: f64 = 0.002;
    let mut sums = [0.0; 5];
    let mut weights = 0.0;
    for (name, said) in said {
        let weight = weight_of(name, learned_from);
        // Rooms that agree with each other may.
        let least = if name == BY_FUNCTION { f64::MIN_POSITIVE } else { LEAST };
        weights += weight;
        for (sum, probability) in sums.iter_mut().zip(said.probabilities()) {
            *sum += weight * probability.max(least).ln();
        }
    }
    let weights = if weights > 0.0 { weights } else { 1.0 };
    Distribution::from_weights(sums.map(|sum| (sum / weights).exp()))
}

/// From so many rooms of a typology on, a forest that looks at all of a room is worth its full weight.
const ENOUGH_ROOMS: usize = 300;

/// How much a kind of classifier counts. Chosen on errors planted in offices (`examples/planted_errors`, seeds 11 and 12), which have
/// enough rooms. From few rooms a forest learns to be sure of too much, and the learners of eight features make up for it.
fn weight_of(name: &str, learned_from: usize) -> f64 {
    let enough = (learned_from as f64 / ENOUGH_ROOMS as f64).min(1.0);
    match name {
        // It knows the building's customs.
        BY_ROOM => 8.0 * enough,
        JOINT => 4.0,
        // Asked alone, it would be drowned by the rooms of one function.
        MODELS => 8.0,
        // Rooms of one function seldom differ in label.
        BY_FUNCTION => 16.0,
        // One of the eight of the four learners, which see less of a room.
        _ => 1.0 - 0.75 * enough,
    }
}

/// The parts of the progress of asking about one set, in the order in which they are asked: the four learners, then the
/// classifier that knows more, with folds by room and by building.
const ROOM_SHARES: [Range<f64>; 2] = [0.0..0.2, 0.2..0.35];
const BUILDING_SHARES: [Range<f64>; 2] = [0.35..0.55, 0.55..1.0];

/// The name of what other rooms of a function say, among [`Opinions::of`].
const BY_FUNCTION: &str = "by function";

/// The name of the models at hand among [`Opinions::of`].
const MODELS: &str = "models at hand";

/// The name of the forest that learned from the other rooms, among [`Opinions::of`].
const BY_ROOM: &str = "forest, folds by room";

/// The name of the joint classifier among [`Opinions::of`].
const JOINT: &str = "joint";

/// Asks classifiers of several kinds of every room.
///
/// # Errors
/// As [`suspects`].
pub fn opinions(
    collection: &Collection,
    folds: usize,
    seed: u64,
    given: bool,
    work: &Work<'_>,
) -> Result<Opinions, StudyError> {
    asked(collection, folds, seed, given, None, work)
}

fn asked(
    collection: &Collection,
    folds: usize,
    seed: u64,
    given: bool,
    models: Option<&Models>,
    work: &Work<'_>,
) -> Result<Opinions, StudyError> {
    let Collection::Plans(networks) = collection else {
        return Err(StudyError::Data(
            "rows of a dataset file do not tell which rooms are neighbours; give the plans".to_owned(),
        ));
    };
    let rows = collection.rows(NeighbourLabels::True).unwrap_or_default();
    let mut opinions = Opinions {
        places: collection.places(),
        of: Vec::new(),
        reasons: vec![String::new(); rows.len()],
        by_function: vec![None; rows.len()],
        rows,
    };
    let typologies: BTreeSet<Option<Typology>> = opinions.rows.iter().map(|row| row.typology.clone()).collect();
    let (mut asked, mut rooms) = (false, 0);
    for typology in typologies {
        let of_set: Vec<usize> =
            (0..opinions.rows.len()).filter(|&row| opinions.rows[row].typology == typology).collect();
        let buildings: BTreeSet<&str> = of_set.iter().map(|&row| group_of(&opinions.rows[row])).collect();
        let is_small = of_set.len() < FEW_ROOMS || buildings.len() < FEW_BUILDINGS;
        let share = |rooms: usize| rooms as f64 / opinions.rows.len() as f64;
        let shares = share(rooms)..share(rooms + of_set.len());
        rooms += of_set.len();
        asked |= work.within(shares, |work| match models.filter(|_| is_small) {
            Some(models) => opinions.ask_models(networks, &of_set, models, work),
            None => opinions.ask(networks, &of_set, folds, seed, given, work),
        })?;
    }
    if asked {
        return Ok(opinions);
    }
    Err(StudyError::Data("there are too few labelled rooms to doubt any; label some more".to_owned()))
}

impl Opinions {
    /// Asks of the rows of one set; whether anybody could be asked.
    fn ask(
        &mut self,
        networks: &[RoomNetwork],
        of_set: &[usize],
        folds: usize,
        seed: u64,
        given: bool,
        work: &Work<'_>,
    ) -> Result<bool, Cancelled> {
        let own: Vec<Row> = of_set.iter().map(|&row| self.rows[row].clone()).collect();
        let Ok(table) = Table::from_rows(&own) else { return Ok(false) };
        let mut asked = false;
        for by in Grouping::ALL {
            let of_rows: Option<Vec<usize>> = own.iter().map(|row| row.fold).collect();
            let folds = match of_rows.filter(|_| given && by == Grouping::Building) {
                Some(of_rows) => Folds::given(of_rows),
                None => fold_table::deal_set(&own, by, folds, seed, "", &mut Vec::new()),
            };
            let Ok(folds) = folds else { continue };
            asked = true;
            let validations: Vec<Validation<'_>> =
                Algorithm::ALL.map(|algorithm| Validation { table: &table, folds: &folds, algorithm, seed }).to_vec();
            // About what each takes of the time.
            let [learners, whole] = match by {
                Grouping::Building => BUILDING_SHARES,
                Grouping::Room => ROOM_SHARES,
            };
            let all = work.within(learners, |work| evaluate_all(&validations, work))?;
            for (algorithm, validated) in Algorithm::ALL.into_iter().zip(all) {
                self.tell(&format!("{}, folds by {}", algorithm.name(), by.name()), of_set, &validated.predictions);
            }
            work.within(whole, |work| match by {
                Grouping::Building => self.ask_jointly(networks, of_set, &folds, seed, work),
                Grouping::Room => self.ask_by_room(networks, of_set, &folds, seed, work),
            })?;
        }
        self.ask_by_function(of_set, &own);
        Ok(asked)
    }

    /// Asks the models at hand, which know the labels of the room's own plan, its own excepted; whether there are any.
    fn ask_models(
        &mut self,
        networks: &[RoomNetwork],
        of_set: &[usize],
        models: &Models,
        work: &Work<'_>,
    ) -> Result<bool, Cancelled> {
        let mut of_networks: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &row in of_set {
            of_networks.entry(self.places[row].network).or_default().push(row);
        }
        let of_networks: Vec<(usize, Vec<usize>)> = of_networks.into_iter().collect();
        let places = &self.places;
        let said = work.map(of_networks.len(), |at| {
            let (network, rows) = &of_networks[at];
            let of = &networks[*network];
            let predictions = Predictor::default().predict(of.clone(), &of.known_labels(), None, models).ok()?;
            let of_row = |&row: &usize| {
                let room = &of.rooms[places[row].room];
                let said = *predictions.distribution(room.id)?;
                let is_doubted = room.label.is_some_and(|label| label != said.label());
                let why = is_doubted.then(|| predictions.why(room.id, Units::Metric)).flatten();
                Some((row, said, why.map(|why| why.sentences()).unwrap_or_default()))
            };
            Some(rows.iter().filter_map(of_row).collect::<Vec<_>>())
        })?;
        let mut asked = false;
        for (row, said, why) in said.into_iter().flatten().flatten() {
            asked = true;
            self.tell(MODELS, &[row], &[said]);
            self.reasons[row] = why;
        }
        let own: Vec<Row> = of_set.iter().map(|&row| self.rows[row].clone()).collect();
        self.ask_by_function(of_set, &own);
        Ok(asked)
    }

    /// What other rooms of the same function are labelled, where they agree with each other and not with the room. Rooms whose label goes
    /// with their function are not judged by it: a wrong function gives a wrong label too.
    fn ask_by_function(&mut self, of_set: &[usize], own: &[Row]) {
        /// Fewer other rooms tell nothing.
        const LEAST: f64 = 3.0;
        /// From this share on they agree.
        const AGREE: f64 = 0.8;
        let mut counts: BTreeMap<String, [f64; 5]> = BTreeMap::new();
        for row in own.iter().filter(|row| !row.function.is_empty()) {
            counts.entry(normalised_function(&row.function)).or_default()[row.label.index()] += 1.0;
        }
        for (&index, row) in of_set.iter().zip(own) {
            let Some(mut others) = counts.get(&normalised_function(&row.function)).copied() else { continue };
            others[row.label.index()] -= 1.0;
            let all: f64 = others.iter().sum();
            let said = Distribution::smoothed(others, &Distribution::UNIFORM, 0.02);
            if all >= LEAST && said.label() != row.label && others[said.label().index()] >= AGREE * all {
                self.tell(BY_FUNCTION, &[index], &[said]);
                let label = said.label();
                self.by_function[index] = Some((label, others[label.index()] as usize, all as usize));
            }
        }
    }

    fn tell(&mut self, name: &str, of_set: &[usize], said: &[Distribution]) {
        let known = self.of.iter().position(|(of, _)| of == name);
        let index = known.unwrap_or_else(|| {
            self.of.push((name.to_owned(), vec![None; self.rows.len()]));
            self.of.len() - 1
        });
        for (&row, &said) in of_set.iter().zip(said) {
            self.of[index].1[row] = Some(said);
        }
    }

    /// A forest that learned from all other rooms.
    fn ask_by_room(
        &mut self,
        networks: &[RoomNetwork],
        of_set: &[usize],
        folds: &Folds,
        seed: u64,
        work: &Work<'_>,
    ) -> Result<(), Cancelled> {
        let of_rows: BTreeSet<usize> = of_set.iter().map(|&row| self.places[row].network).collect();
        let networks: Vec<&RoomNetwork> = of_rows.into_iter().map(|network| &networks[network]).collect();
        let said = by_other_rooms(&networks, folds, seed, work)?;
        self.tell(BY_ROOM, of_set, &said);
        Ok(())
    }

    /// The joint classifier, which learned from other buildings and knows the labels of the room's own plan, its own excepted.
    fn ask_jointly(
        &mut self,
        networks: &[RoomNetwork],
        of_set: &[usize],
        folds: &Folds,
        seed: u64,
        work: &Work<'_>,
    ) -> Result<(), Cancelled> {
        let network_of = |index: usize| self.places[of_set[index]].network;
        let of_fold = |fold: usize| {
            let tested: BTreeSet<usize> = folds.test_rows(fold).into_iter().map(network_of).collect();
            let taught: BTreeSet<usize> = folds
                .training_rows(fold)
                .into_iter()
                .map(network_of)
                .filter(|network| !tested.contains(network))
                .collect();
            let taught: Vec<&RoomNetwork> = taught.into_iter().map(|network| &networks[network]).collect();
            let joint = Joint::train(&taught, seed_of_part(seed, fold), &work.alone()).ok()?;
            let said = |row: usize| {
                let RoomPlace { network, room } = self.places[of_set[row]];
                (row, network, room)
            };
            let mut predicted: Vec<(usize, Distribution, String)> = Vec::new();
            let mut round: Option<(usize, FirstRound, Vec<Distribution>)> = None;
            for (row, network, room) in folds.test_rows(fold).into_iter().map(said) {
                let of = &networks[network];
                let known = of.known_labels();
                if round.as_ref().is_none_or(|(at, ..)| *at != network) {
                    let first = joint.first_round(of);
                    let distributions = joint.predict_from(&first, &known);
                    round = Some((network, first, distributions));
                }
                let Some((_, first, distributions)) = &round else { continue };
                let doubted = of.rooms[room].label.is_some_and(|label| distributions[room].label() != label);
                let why = doubted.then(|| joint.explain_from(first, of, &known, room)).flatten();
                predicted.push((
                    row,
                    distributions[room],
                    why.map(|why| why.why(Units::Metric).sentences()).unwrap_or_default(),
                ));
            }
            Some(predicted)
        };
        let told: Vec<Option<Vec<(usize, Distribution, String)>>> = work.map(folds.count(), of_fold)?;
        for (row, said, why) in told.into_iter().flatten().flatten() {
            self.tell(JOINT, &of_set[row..=row], &[said]);
            self.reasons[of_set[row]] = why;
        }
        Ok(())
    }
}

/// What a label scheme says of a function, where that differs from the label given: a sentence, or nothing.
pub fn contradiction(row: &Row, by_scheme: Option<Label>) -> Option<String> {
    let by_scheme = by_scheme.filter(|&label| label != row.label)?;
    Some(format!("Its function, {}, makes it a {}.", row.function, by_scheme.name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn easy_mistakes_are_likelier_than_others_and_as_likely_together() {
        // Surely a medium room, as far as others can tell.
        let said = Distribution::from_weights([0.05, 0.8, 0.05, 0.05, 0.05]);
        let [small, big, corridor] =
            [Label::SmallRoom, Label::BigRoom, Label::Corridor].map(|given| odds_of_mistake(&said, given));
        assert!(small > 2.0 * corridor && (small - big).abs() < 1e-9, "{small} {big} {corridor}");
        assert!(odds_of_mistake(&said, Label::MediumRoom) < 0.5);
        // On average the odds are those of the probability alone.
        for truth in Label::ALL {
            let sure =
                Distribution::from_weights(std::array::from_fn(|at| if at == truth.index() { 0.96 } else { 0.01 }));
            let wrong = Label::ALL.into_iter().filter(|&given| given != truth);
            let mean = wrong.map(|given| odds_of_mistake(&sure, given)).sum::<f64>() / 4.0;
            assert!((mean / 96.0 - 1.0).abs() < 0.05, "{truth}: {mean}");
        }
        // Nothing is impossible.
        let certain = Distribution::from_weights([1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(Label::ALL.into_iter().all(|given| odds_of_mistake(&certain, given).ln().is_finite()));
    }
}
