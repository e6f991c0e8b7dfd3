//! The measurements of a study, each a separate task: a fold predicted by classifiers trained on the
//! others, a foreign test, a point of a learning curve.

use std::collections::BTreeMap;

use super::{Condition, HONEST, Options, StudyError};
use crate::base::random::{Random, seed_of_part};
use crate::base::work::{Cancelled, Work};
use crate::classify::joint::Joint;
use crate::classify::unknown::{PlanScore, Unknown};
use crate::classify::{Algorithm, Classifier, Distribution, committee, in_plan};
use crate::dataset::fold_table;
use crate::dataset::folds::{Folds, Grouping, group_of};
use crate::dataset::sets::STANDARD;
use crate::dataset::table::{FEATURES, Table, Values};
use crate::dataset::{Collection, RoomNetwork, RoomPlace, Row};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// Shares of the training rooms at the points of a learning curve.
pub(super) const CURVE_SHARES: [f64; 6] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0];

/// Shares of the training buildings at the points of the joint classifier's curve; the last point, all of them, is [`Task::Joint`].
pub(super) const JOINT_SHARES: [f64; 2] = [0.25, 0.5];

/// Folds whose curves are averaged.
const CURVE_FOLDS: usize = 5;

/// Times each feature is shuffled in each fold.
pub(super) const SHUFFLES: usize = 3;

/// The prepared data, and how to perform each task on them.
pub(super) struct Experiment<'a> {
    pub(super) collection: &'a Collection,
    pub(super) options: Options,
    /// All labelled rooms, with features from true neighbour labels.
    pub(super) rows: Vec<Row>,
    pub(super) places: Vec<RoomPlace>,
    /// The same with temporary neighbour labels; empty for rows of a file. Features with predicted labels
    /// depend on the classifier and are made when needed.
    pub(super) temporary: Vec<Row>,
    pub(super) sets: Vec<SetRows>,
    pub(super) notes: Vec<String>,
}

/// A set's rows, and their folds.
pub(super) struct SetRows {
    pub(super) name: String,
    /// `None` for the standard set.
    pub(super) typology: Option<Typology>,
    /// Indices of its rows, ascending.
    pub(super) rows: Vec<usize>,
    pub(super) by_room: Option<FoldsOfSet>,
    pub(super) by_building: Option<FoldsOfSet>,
}

/// Folds of a set: for each of its rows the fold.
#[derive(Clone)]
pub(super) struct FoldsOfSet {
    pub(super) count: usize,
    pub(super) of_rows: Vec<usize>,
}

impl SetRows {
    pub(super) fn folds_by(&self, grouping: Grouping) -> Option<&FoldsOfSet> {
        match grouping {
            Grouping::Room => self.by_room.as_ref(),
            Grouping::Building => self.by_building.as_ref(),
        }
    }
}

/// One piece of work. Sets and conditions by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Task {
    Fold {
        condition: usize,
        set: usize,
        algorithm: Algorithm,
        fold: usize,
    },
    Foreign {
        model: usize,
        algorithm: Algorithm,
    },
    Point {
        set: usize,
        algorithm: Algorithm,
        fold: usize,
        share: usize,
    },
    /// The committee that takes part in the blend.
    Committee {
        set: usize,
        fold: usize,
    },
    Joint {
        set: usize,
        fold: usize,
    },
    JointPoint {
        set: usize,
        fold: usize,
        share: usize,
    },
    Unknown {
        set: usize,
        fold: usize,
    },
}

/// The outcome of a task.
pub(super) enum Outcome {
    /// Predictions of rows, and the rooms right after shuffling each feature (out of [`SHUFFLES`] times
    /// the rows).
    Predicted(Vec<(usize, Distribution)>, Option<[usize; FEATURES]>),
    /// Training rooms, rooms tested, and how many of them were right.
    Point(usize, usize, usize),
    /// What lies behind openings, by plan.
    Behind(Vec<PlanScore>),
}

impl<'a> Experiment<'a> {
    pub(super) fn new(collection: &'a Collection, options: Options) -> Result<Self, StudyError> {
        let modes = collection.neighbour_modes();
        if !modes.contains(&options.neighbours) {
            return Err(StudyError::Data(format!(
                "rows of a dataset file do not tell which rooms are neighbours, so {} neighbour labels cannot be \
                 taken; give the plans instead",
                options.neighbours.name()
            )));
        }
        let rows = collection.rows(NeighbourLabels::True).unwrap_or_default();
        Table::from_rows(&rows).map_err(|error| StudyError::Data(error.to_string()))?;
        let temporary = collection.rows(NeighbourLabels::Temporary).unwrap_or_default();
        let places = collection.places();
        let mut experiment = Self { collection, options, rows, places, temporary, sets: Vec::new(), notes: Vec::new() };
        experiment.assign_folds()?;
        Ok(experiment)
    }

    /// Makes the sets. The standard set's folds are those of the typologies combined, so that own and
    /// standard classifiers are tested on the same rooms, with the same rooms excluded from training.
    fn assign_folds(&mut self) -> Result<(), StudyError> {
        let options = self.options;
        let mut by_typology: BTreeMap<Option<&Typology>, Vec<usize>> = Default::default();
        for (index, row) in self.rows.iter().enumerate() {
            by_typology.entry(row.typology.as_ref()).or_default().push(index);
        }
        let groups: Vec<(Option<Typology>, Vec<usize>)> =
            by_typology.into_iter().map(|(typology, rows)| (typology.cloned(), rows)).collect();
        let all: Vec<usize> = (0..self.rows.len()).collect();
        let mut notes = Vec::new();
        let given = options.given.then(|| self.collection.given_folds()).flatten();
        let assign = |rows: &[usize], grouping: Grouping, name: &str, notes: &mut Vec<String>| {
            let folds = match given.as_ref().filter(|_| grouping == options.grouping) {
                Some(given) => Folds::given(rows.iter().map(|&row| given[row]).collect()),
                None => {
                    let own: Vec<Row> = rows.iter().map(|&row| self.rows[row].clone()).collect();
                    fold_table::deal_set(&own, grouping, options.folds, options.seed, name, notes)
                }
            };
            folds.map(|folds| FoldsOfSet { count: folds.count(), of_rows: folds.of_rows().to_vec() })
        };
        let several = groups.len() > 1;
        let mut joined = [vec![0; all.len()], vec![0; all.len()]];
        let mut joined_count = [Some(0), Some(0)];
        for (typology, rows) in groups {
            let name = fold_table::set_title(typology.as_ref()).to_owned();
            let mut of_set = Vec::new();
            for (way, grouping) in Grouping::ALL.into_iter().enumerate() {
                let folds = assign(&rows, grouping, &name, &mut notes);
                match &folds {
                    Ok(folds) => {
                        joined_count[way] = joined_count[way].map(|count: usize| count.max(folds.count));
                        for (&row, &fold) in rows.iter().zip(&folds.of_rows) {
                            joined[way][row] = fold;
                        }
                    }
                    Err(error) => {
                        notes.push(format!("{name}, folds by {}: not measured: {error}", grouping.name()));
                        joined_count[way] = None;
                    }
                }
                of_set.push(folds.ok());
            }
            if several && typology.is_none() {
                // Only in the standard set.
                continue;
            }
            let by_building = of_set.pop().flatten();
            let by_room = of_set.pop().flatten();
            let name = if typology.is_some() { name } else { STANDARD.to_owned() };
            self.sets.push(SetRows { name, typology, rows, by_room, by_building });
        }
        if several {
            let [by_room, by_building] = [0, 1].map(|way| {
                let of_rows = joined[way].clone();
                joined_count[way].map(|count| FoldsOfSet { count, of_rows })
            });
            self.sets.push(SetRows { name: STANDARD.to_owned(), typology: None, rows: all, by_room, by_building });
        }
        self.notes = notes;
        let main = options.grouping;
        if self.sets.iter().all(|set| set.folds_by(main).is_none()) {
            let why = self.notes.pop().unwrap_or_default();
            return Err(StudyError::Data(format!("there is too little data to validate on: {why}")));
        }
        Ok(())
    }

    pub(super) fn conditions(&self) -> Vec<Condition> {
        let modes = self.collection.neighbour_modes();
        Grouping::ALL
            .into_iter()
            .flat_map(|by| modes.iter().map(move |&neighbours| Condition { by, neighbours }))
            .collect()
    }

    pub(super) fn main_condition(&self) -> Condition {
        Condition { by: self.options.grouping, neighbours: self.options.neighbours }
    }

    /// The choice of neighbours' labels for curves and foreign classifiers: they are trained once,
    /// without the inner validation that predicted labels need.
    fn plain_mode(&self) -> NeighbourLabels {
        match self.options.neighbours {
            NeighbourLabels::Predicted => NeighbourLabels::Temporary,
            plain => plain,
        }
    }

    pub(super) fn typology_sets(&self) -> impl Iterator<Item = (usize, &SetRows)> {
        self.sets.iter().enumerate().filter(|(_, set)| set.typology.is_some())
    }

    pub(super) fn tasks(&self) -> Vec<Task> {
        let mut tasks = Vec::new();
        let main = self.options.grouping;
        for (condition, Condition { by, .. }) in self.conditions().into_iter().enumerate() {
            for (set, rows) in self.sets.iter().enumerate() {
                for fold in 0..rows.folds_by(by).map_or(0, |folds| folds.count) {
                    tasks.extend(Algorithm::ALL.map(|algorithm| Task::Fold { condition, set, algorithm, fold }));
                }
            }
        }
        if self.typology_sets().count() > 1 {
            for (model, _) in self.typology_sets() {
                tasks.extend(Algorithm::ALL.map(|algorithm| Task::Foreign { model, algorithm }));
            }
        }
        for (set, rows) in self.sets.iter().enumerate() {
            for fold in 0..rows.folds_by(main).map_or(0, |folds| folds.count.min(CURVE_FOLDS)) {
                for share in 0..CURVE_SHARES.len() {
                    tasks.extend(Algorithm::ALL.map(|algorithm| Task::Point { set, algorithm, fold, share }));
                }
            }
        }
        if !self.collection.networks().is_empty() {
            for (set, rows) in self.sets.iter().enumerate() {
                let folds = rows.folds_by(Grouping::Building).map_or(0, |folds| folds.count);
                tasks.extend((0..folds).map(|fold| Task::Committee { set, fold }));
                tasks.extend((0..folds).map(|fold| Task::Joint { set, fold }));
                if rows.typology.is_some() {
                    let points = |fold| (0..JOINT_SHARES.len()).map(move |share| Task::JointPoint { set, fold, share });
                    tasks.extend((0..folds.min(CURVE_FOLDS)).flat_map(points));
                }
                tasks.extend((0..folds).map(|fold| Task::Unknown { set, fold }));
            }
        }
        tasks
    }

    fn rows_in(&self, mode: NeighbourLabels) -> &[Row] {
        match mode {
            NeighbourLabels::Temporary => &self.temporary,
            NeighbourLabels::True | NeighbourLabels::Predicted => &self.rows,
        }
    }

    fn train(
        &self,
        algorithm: Algorithm,
        rows: impl Iterator<Item = usize>,
        mode: NeighbourLabels,
        work: &Work<'_>,
    ) -> Option<Classifier> {
        let data = self.rows_in(mode);
        let table = Table::from_rows(rows.map(|row| &data[row])).ok()?;
        Classifier::train(algorithm, &table, self.options.seed, work).ok()
    }

    /// Performs a task.
    ///
    /// # Errors
    /// When the work is cancelled.
    pub(super) fn perform(&self, task: Task, work: &Work<'_>) -> Result<Outcome, Cancelled> {
        let outcome = self.outcome(task, work);
        // Otherwise a cancelled task would count as measured.
        work.goes_on()?;
        Ok(outcome)
    }

    fn outcome(&self, task: Task, work: &Work<'_>) -> Outcome {
        let nothing = Outcome::Predicted(Vec::new(), None);
        match task {
            Task::Fold { condition, set, algorithm, fold } => {
                let Some(&condition) = self.conditions().get(condition) else { return nothing };
                self.predict_fold(condition, &self.sets[set], algorithm, fold, work).unwrap_or(nothing)
            }
            Task::Foreign { model, algorithm } => {
                let (mode, own) = (self.plain_mode(), &self.sets[model]);
                let classifier = self.train(algorithm, own.rows.iter().copied(), mode, work);
                let Some(classifier) = classifier else { return nothing };
                let data = self.rows_in(mode);
                let foreign = self.typology_sets().filter(|(set, _)| *set != model).flat_map(|(_, set)| &set.rows);
                Outcome::Predicted(
                    foreign.map(|&row| (row, classifier.predict(&data[row].features.values()))).collect(),
                    None,
                )
            }
            Task::Unknown { set, fold } => self.look_behind(&self.sets[set], fold).unwrap_or(nothing),
            Task::JointPoint { set, fold, share } => {
                self.joint_point(&self.sets[set], fold, JOINT_SHARES[share], work).unwrap_or(Outcome::Point(0, 0, 0))
            }
            Task::Committee { set, fold } => {
                let learn = |learned: &[usize], seed| {
                    let (networks, places) = (self.collection.networks(), &self.places);
                    committee::train(networks, &self.rows, places, learned, seed, work).ok()?
                };
                let said = self.predict_in_plans(HONEST, &self.sets[set], fold, &learn);
                said.map_or(nothing, |said| Outcome::Predicted(said, None))
            }
            Task::Joint { set, fold } => self.predict_jointly(&self.sets[set], fold, work).unwrap_or(nothing),
            Task::Point { set, algorithm, fold, share } => {
                self.curve_point(&self.sets[set], algorithm, fold, CURVE_SHARES[share], work)
            }
        }
    }

    /// The rows of a set that a fold tests, and the others.
    fn split(set: &SetRows, grouping: Grouping, fold: usize) -> Option<(Vec<usize>, Vec<usize>)> {
        let folds = set.folds_by(grouping)?;
        let pairs = set.rows.iter().copied().zip(&folds.of_rows);
        let (tested, learned): (Vec<_>, Vec<_>) = pairs.partition(|(_, of)| **of == fold);
        let rows = |pairs: Vec<(usize, &usize)>| pairs.into_iter().map(|(row, _)| row).collect();
        Some((rows(tested), rows(learned)))
    }

    fn predict_fold(
        &self,
        condition: Condition,
        set: &SetRows,
        algorithm: Algorithm,
        fold: usize,
        work: &Work<'_>,
    ) -> Option<Outcome> {
        if condition.neighbours == NeighbourLabels::Predicted {
            let learn = |learned: &[usize], seed| {
                let (networks, by) = (self.collection.networks(), condition.by);
                let rows = in_plan::rows_with_predicted_neighbours(
                    networks,
                    &self.rows,
                    &self.places,
                    learned,
                    algorithm,
                    by,
                    seed,
                    work,
                )
                .ok()?;
                Classifier::train(algorithm, &Table::from_rows(&rows).ok()?, seed, work).ok()
            };
            let said = self.predict_in_plans(condition, set, fold, &learn)?;
            return Some(Outcome::Predicted(said, None));
        }
        let (tested, learned) = Self::split(set, condition.by, fold)?;
        let seed = seed_of_part(self.options.seed, fold);
        let data = self.rows_in(condition.neighbours);
        let table = Table::from_rows(learned.iter().map(|&row| &data[row])).ok()?;
        let classifier = Classifier::train(algorithm, &table, seed, work).ok()?;
        let values: Vec<Values> = tested.iter().map(|&row| data[row].features.values()).collect();
        let predictions = tested.iter().zip(&values).map(|(&row, values)| (row, classifier.predict(values))).collect();
        let shuffled = (condition == self.main_condition()).then(|| {
            let truths: Vec<Label> = tested.iter().map(|&row| self.rows[row].label).collect();
            right_when_shuffled(&classifier, &values, &truths, seed)
        });
        Some(Outcome::Predicted(predictions, shuffled))
    }

    /// A classifier on the rooms of a fold, whole plans at a time, with the labels of neighbours predicted; `learn` trains it on
    /// the other rooms of the set, with a seed.
    fn predict_in_plans(
        &self,
        condition: Condition,
        set: &SetRows,
        fold: usize,
        learn: &dyn Fn(&[usize], u64) -> Option<Classifier>,
    ) -> Option<Vec<(usize, Distribution)>> {
        let (tested, learned) = Self::split(set, condition.by, fold)?;
        let networks = self.collection.networks();
        let classifier = learn(&learned, seed_of_part(self.options.seed, fold))?;
        let mut predictions = Vec::with_capacity(tested.len());
        let mut classified: Option<(usize, Vec<Distribution>)> = None;
        for row in tested {
            let RoomPlace { network, room } = self.places[row];
            let distributions = match classified.take() {
                Some((of, distributions)) if of == network => distributions,
                _ => {
                    let unknown = vec![None; networks[network].rooms.len()];
                    in_plan::classify(&classifier, &networks[network], &unknown, NeighbourLabels::Predicted)
                        .distributions
                }
            };
            predictions.push((row, distributions[room]));
            classified = Some((network, distributions));
        }
        Some(predictions)
    }

    /// The joint classifier on the buildings of a fold, trained on the others of the set.
    fn predict_jointly(&self, set: &SetRows, fold: usize, work: &Work<'_>) -> Option<Outcome> {
        let (tested, learned) = Self::split(set, Grouping::Building, fold)?;
        let taught: Vec<&RoomNetwork> = self.networks_of(&learned).into_values().collect();
        let joint = Joint::train(&taught, seed_of_part(self.options.seed, fold), work).ok()?;
        let said: BTreeMap<usize, Vec<Distribution>> =
            self.networks_of(&tested).into_iter().map(|(at, network)| (at, joint.predict(network, &[]))).collect();
        let prediction = |row: usize| Some((row, *said.get(&self.places[row].network)?.get(self.places[row].room)?));
        Some(Outcome::Predicted(tested.into_iter().filter_map(prediction).collect(), None))
    }

    /// The joint classifier on the buildings of a fold, trained on a share of the other buildings.
    fn joint_point(&self, set: &SetRows, fold: usize, share: f64, work: &Work<'_>) -> Option<Outcome> {
        let (tested, learned) = Self::split(set, Grouping::Building, fold)?;
        let mut buildings: Vec<&str> = learned.iter().map(|&row| group_of(&self.rows[row])).collect();
        buildings.sort_unstable();
        buildings.dedup();
        Random::new(seed_of_part(self.options.seed, fold)).shuffle(&mut buildings);
        buildings.truncate(((buildings.len() as f64 * share).round() as usize).max(1));
        let learned: Vec<usize> =
            learned.into_iter().filter(|&row| buildings.contains(&group_of(&self.rows[row]))).collect();
        let taught: Vec<&RoomNetwork> = self.networks_of(&learned).into_values().collect();
        let joint = Joint::train(&taught, seed_of_part(self.options.seed, fold), work).ok()?;
        let said: BTreeMap<usize, Vec<Distribution>> =
            self.networks_of(&tested).into_iter().map(|(at, network)| (at, joint.predict(network, &[]))).collect();
        let is_right = |row: &&usize| {
            let RoomPlace { network, room } = self.places[**row];
            said.get(&network)
                .and_then(|said| said.get(room))
                .is_some_and(|said| said.label() == self.rows[**row].label)
        };
        Some(Outcome::Point(learned.len(), tested.len(), tested.iter().filter(is_right).count()))
    }

    /// What lies behind the openings of a fold's buildings, trained on the others of the set.
    fn look_behind(&self, set: &SetRows, fold: usize) -> Option<Outcome> {
        let (tested, learned) = Self::split(set, Grouping::Building, fold)?;
        let networks = |rows: &[usize]| self.networks_of(rows).into_values().collect::<Vec<_>>();
        Some(Outcome::Behind(Unknown::train(&networks(&learned)).test(&networks(&tested))))
    }

    /// The networks that hold some rows, by index.
    fn networks_of(&self, rows: &[usize]) -> BTreeMap<usize, &RoomNetwork> {
        let networks = self.collection.networks();
        rows.iter().map(|&row| self.places[row].network).map(|at| (at, &networks[at])).collect()
    }

    fn curve_point(&self, set: &SetRows, algorithm: Algorithm, fold: usize, share: f64, work: &Work<'_>) -> Outcome {
        let mode = self.plain_mode();
        let Some((tested, mut learned)) = Self::split(set, self.options.grouping, fold) else {
            return Outcome::Point(0, 0, 0);
        };
        let mut random = Random::new(seed_of_part(self.options.seed, fold));
        // Smaller parts are subsets of larger ones, and buildings stay whole if folds keep them whole.
        if self.options.grouping == Grouping::Building {
            let mut buildings: Vec<&str> = learned.iter().map(|&row| group_of(&self.rows[row])).collect();
            buildings.sort_unstable();
            buildings.dedup();
            random.shuffle(&mut buildings);
            let rank: BTreeMap<&str, usize> =
                buildings.into_iter().enumerate().map(|(rank, name)| (name, rank)).collect();
            learned.sort_by_key(|&row| rank.get(group_of(&self.rows[row])));
        } else {
            random.shuffle(&mut learned);
        }
        learned.truncate(((learned.len() as f64 * share).round() as usize).max(1));
        let data = self.rows_in(mode);
        let Some(classifier) = self.train(algorithm, learned.iter().copied(), mode, work) else {
            return Outcome::Point(0, 0, 0);
        };
        let right =
            tested.iter().filter(|&&row| classifier.predict(&data[row].features.values()).label() == data[row].label);
        Outcome::Point(learned.len(), tested.len(), right.count())
    }
}

/// Rooms right after shuffling each feature among them, out of [`SHUFFLES`] times the rooms.
fn right_when_shuffled(classifier: &Classifier, values: &[Values], truths: &[Label], seed: u64) -> [usize; FEATURES] {
    std::array::from_fn(|feature| {
        let mut random = Random::new(seed_of_part(seed, feature));
        let mut right = 0;
        for _ in 0..SHUFFLES {
            let mut order: Vec<usize> = (0..values.len()).collect();
            random.shuffle(&mut order);
            for (index, &other) in order.iter().enumerate() {
                let mut shuffled = values[index];
                shuffled[feature] = values[other][feature];
                right += usize::from(classifier.predict(&shuffled).label() == truths[index]);
            }
        }
        right
    })
}
