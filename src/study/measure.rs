//! Doing a study: every fold, foreign test and point of a curve is a task of its own, so that all
//! threads are busy to the end and progress is even.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    Average, Cell, Comparison, Condition, ConfusionTable, Curve, CurvePoint, Importance, JointCell, LabelLine, Options,
    Rival, RoomsTable, Set, Study, StudyError, TypologyCount, TypologyLine, UnknownCell,
};
use crate::base::random::{Random, seed_of_part};
use crate::base::work::Work;
use crate::classify::joint::Joint;
use crate::classify::unknown::{PlanScore, Unknown};
use crate::classify::{Algorithm, Classifier, Confusion, Distribution, Scores, in_plan, typology};
use crate::dataset::folds::{Folds, FoldsError, Grouping, building_of};
use crate::dataset::sets::STANDARD;
use crate::dataset::table::{FEATURES, Table, Values};
use crate::dataset::{Collection, Moments, RoomNetwork, RoomPlace, Row, Statistics};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// Shares of the training rooms at the points of a learning curve.
const CURVE_SHARES: [f64; 6] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0];

/// Folds whose curves are averaged.
const CURVE_FOLDS: usize = 5;

/// Times each feature is shuffled in each fold.
const SHUFFLES: usize = 3;

/// Studies a collection. `blind` are the same plans as [`RoomNetwork::without_typology`] sees them; without
/// them, the inference of the typology is not measured. `work` is told how many tasks are done of how many; they come in random
/// order, so that the share done is close to the share of the time.
///
/// # Errors
/// When there is too little data for even one cross-validation, or the work is cancelled.
pub fn study(
    collection: &Collection,
    blind: &[RoomNetwork],
    options: Options,
    work: &Work<'_>,
) -> Result<Study, StudyError> {
    let lab = Lab::new(collection, options)?;
    let mut tasks = lab.tasks();
    Random::new(options.seed).shuffle(&mut tasks);
    let done = work.map(tasks.len(), |index| lab.perform(tasks[index]))?;
    let mut study = lab.gather(&Results::new(tasks, done));
    study.typologies = infer_typologies(collection, blind, options);
    Ok(study)
}

/// Cross-validates some algorithms on one set under some conditions, without the rest of a study.
/// Conditions that cannot be measured are left out and named in the notes beside the cells.
///
/// # Errors
/// As [`study`].
pub fn validate(
    collection: &Collection,
    options: Options,
    set: &str,
    algorithms: &[Algorithm],
    conditions: &[Condition],
    work: &Work<'_>,
) -> Result<(Vec<Cell>, Vec<String>), StudyError> {
    let lab = Lab::new(collection, options)?;
    let all = lab.conditions();
    let is_wanted = |task: &Task| match *task {
        Task::Fold { condition, set: of, algorithm, .. } => {
            lab.sets[of].name == set
                && algorithms.contains(&Algorithm::ALL[algorithm])
                && conditions.contains(&all[condition])
        }
        Task::Foreign { .. } | Task::Point { .. } | Task::Joint { .. } | Task::Unknown { .. } => false,
    };
    let tasks: Vec<Task> = lab.tasks().into_iter().filter(is_wanted).collect();
    let done = work.map(tasks.len(), |index| lab.perform(tasks[index]))?;
    let results = Results::new(tasks, done);
    let cells = lab.cells(&results).into_iter().filter(|cell| cell.scores.rooms > 0).collect();
    Ok((cells, lab.notes))
}

/// The data, prepared.
struct Lab<'a> {
    collection: &'a Collection,
    options: Options,
    /// All labelled rooms, with the features that true neighbour labels give.
    rows: Vec<Row>,
    places: Vec<RoomPlace>,
    /// The same with temporary neighbour labels; none for rows of a file. Features with predicted labels
    /// depend on the classifier and are made where needed.
    temporary: Vec<Row>,
    sets: Vec<SetRows>,
    notes: Vec<String>,
}

/// A set's rows, and how they are dealt to folds.
struct SetRows {
    name: String,
    /// `None` for the standard set.
    typology: Option<Typology>,
    /// Indices of its rows, ascending.
    rows: Vec<usize>,
    by_room: Option<Dealt>,
    by_building: Option<Dealt>,
}

/// Folds of a set: for each of its rows the fold.
#[derive(Clone)]
struct Dealt {
    count: usize,
    of_rows: Vec<usize>,
}

impl SetRows {
    fn dealt(&self, grouping: Grouping) -> Option<&Dealt> {
        match grouping {
            Grouping::Room => self.by_room.as_ref(),
            Grouping::Building => self.by_building.as_ref(),
        }
    }
}

/// One piece of work. Sets, conditions and algorithms by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Task {
    Fold { condition: usize, set: usize, algorithm: usize, fold: usize },
    Foreign { model: usize, algorithm: usize },
    Point { set: usize, algorithm: usize, fold: usize, share: usize },
    Joint { set: usize, fold: usize },
    Unknown { set: usize, fold: usize },
}

/// What came of a task.
enum Done {
    /// Predictions of rows, and the rooms right after shuffling each feature (of [`SHUFFLES`] times the
    /// rows).
    Predicted(Vec<(usize, Distribution)>, Option<[usize; FEATURES]>),
    /// Training rooms, rooms tested, and how many of them were right.
    Point(usize, usize, usize),
    /// What lies behind openings, by plan.
    Behind(Vec<PlanScore>),
}

/// Tasks with what came of them, sorted.
struct Results(Vec<(Task, Done)>);

impl<'a> Lab<'a> {
    fn new(collection: &'a Collection, options: Options) -> Result<Self, StudyError> {
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
        let mut lab = Self { collection, options, rows, places, temporary, sets: Vec::new(), notes: Vec::new() };
        lab.deal_sets()?;
        Ok(lab)
    }

    /// Makes the sets. The standard set's folds are those of the typologies put together, so that own
    /// and standard classifiers are tested on the same rooms having learned without the same rooms.
    fn deal_sets(&mut self) -> Result<(), StudyError> {
        let options = self.options;
        let mut by_typology: BTreeMap<Option<&Typology>, Vec<usize>> = Default::default();
        for (index, row) in self.rows.iter().enumerate() {
            by_typology.entry(row.typology.as_ref()).or_default().push(index);
        }
        let groups: Vec<(Option<Typology>, Vec<usize>)> =
            by_typology.into_iter().map(|(typology, rows)| (typology.cloned(), rows)).collect();
        let all: Vec<usize> = (0..self.rows.len()).collect();
        let mut notes = Vec::new();
        let deal = |rows: &[usize], grouping: Grouping, name: &str, notes: &mut Vec<String>| {
            let own: Vec<Row> = rows.iter().map(|&row| self.rows[row].clone()).collect();
            let mut count = options.folds;
            let folds = match Folds::new(&own, grouping, count, options.seed) {
                Err(FoldsError::TooFewRows { have, .. }) if have >= 2 => {
                    notes.push(format!("{name}: {have} {}s give {have} folds, not {count}", grouping.name()));
                    count = have;
                    Folds::new(&own, grouping, count, options.seed)
                }
                folds => folds,
            };
            folds.map(|folds| Dealt { count, of_rows: folds.of_rows().to_vec() })
        };
        let several = groups.len() > 1;
        let mut joined = [vec![0; all.len()], vec![0; all.len()]];
        let mut joined_count = [Some(0), Some(0)];
        for (typology, rows) in groups {
            let name = typology.as_ref().map_or("rooms without a typology", Typology::as_str).to_owned();
            let mut dealt = Vec::new();
            for (way, grouping) in Grouping::ALL.into_iter().enumerate() {
                let folds = deal(&rows, grouping, &name, &mut notes);
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
                dealt.push(folds.ok());
            }
            if several && typology.is_none() {
                // Part of the standard set only.
                continue;
            }
            let by_building = dealt.pop().flatten();
            let by_room = dealt.pop().flatten();
            let name = if typology.is_some() { name } else { STANDARD.to_owned() };
            self.sets.push(SetRows { name, typology, rows, by_room, by_building });
        }
        if several {
            let [by_room, by_building] = [0, 1].map(|way| {
                let of_rows = joined[way].clone();
                joined_count[way].map(|count| Dealt { count, of_rows })
            });
            self.sets.push(SetRows { name: STANDARD.to_owned(), typology: None, rows: all, by_room, by_building });
        }
        self.notes = notes;
        let main = options.grouping;
        if self.sets.iter().all(|set| set.dealt(main).is_none()) {
            let why = self.notes.pop().unwrap_or_default();
            return Err(StudyError::Data(format!("there is too little data to validate on: {why}")));
        }
        Ok(())
    }

    fn conditions(&self) -> Vec<Condition> {
        let modes = self.collection.neighbour_modes();
        Grouping::ALL
            .into_iter()
            .flat_map(|by| modes.iter().map(move |&neighbours| Condition { by, neighbours }))
            .collect()
    }

    fn main_condition(&self) -> Condition {
        Condition { by: self.options.grouping, neighbours: self.options.neighbours }
    }

    /// The mode in which curves and foreign classifiers are measured: they learn once, without the
    /// inner validation that predicted labels need.
    fn plain_mode(&self) -> NeighbourLabels {
        match self.options.neighbours {
            NeighbourLabels::Predicted => NeighbourLabels::Temporary,
            plain => plain,
        }
    }

    fn typology_sets(&self) -> impl Iterator<Item = (usize, &SetRows)> {
        self.sets.iter().enumerate().filter(|(_, set)| set.typology.is_some())
    }

    fn tasks(&self) -> Vec<Task> {
        let mut tasks = Vec::new();
        let main = self.options.grouping;
        for (condition, Condition { by, .. }) in self.conditions().into_iter().enumerate() {
            for (set, rows) in self.sets.iter().enumerate() {
                for fold in 0..rows.dealt(by).map_or(0, |dealt| dealt.count) {
                    tasks.extend((0..4).map(|algorithm| Task::Fold { condition, set, algorithm, fold }));
                }
            }
        }
        if self.typology_sets().count() > 1 {
            for (model, _) in self.typology_sets() {
                tasks.extend((0..4).map(|algorithm| Task::Foreign { model, algorithm }));
            }
        }
        for (set, rows) in self.sets.iter().enumerate() {
            for fold in 0..rows.dealt(main).map_or(0, |dealt| dealt.count.min(CURVE_FOLDS)) {
                for share in 0..CURVE_SHARES.len() {
                    tasks.extend((0..4).map(|algorithm| Task::Point { set, algorithm, fold, share }));
                }
            }
        }
        if !self.collection.networks().is_empty() {
            for (set, rows) in self.sets.iter().enumerate() {
                let folds = rows.dealt(Grouping::Building).map_or(0, |dealt| dealt.count);
                tasks.extend((0..folds).map(|fold| Task::Joint { set, fold }));
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
    ) -> Option<Classifier> {
        let data = self.rows_in(mode);
        let table = Table::from_rows(rows.map(|row| &data[row])).ok()?;
        Some(Classifier::train(algorithm, &table, self.options.seed))
    }

    fn perform(&self, task: Task) -> Done {
        let nothing = Done::Predicted(Vec::new(), None);
        match task {
            Task::Fold { condition, set, algorithm, fold } => {
                let Some(&condition) = self.conditions().get(condition) else { return nothing };
                self.predict_fold(condition, &self.sets[set], Algorithm::ALL[algorithm], fold).unwrap_or(nothing)
            }
            Task::Foreign { model, algorithm } => {
                let (mode, own) = (self.plain_mode(), &self.sets[model]);
                let classifier = self.train(Algorithm::ALL[algorithm], own.rows.iter().copied(), mode);
                let Some(classifier) = classifier else { return nothing };
                let data = self.rows_in(mode);
                let foreign = self.typology_sets().filter(|(set, _)| *set != model).flat_map(|(_, set)| &set.rows);
                Done::Predicted(
                    foreign.map(|&row| (row, classifier.predict(&data[row].features.values()))).collect(),
                    None,
                )
            }
            Task::Unknown { set, fold } => self.look_behind(&self.sets[set], fold).unwrap_or(nothing),
            Task::Joint { set, fold } => self.predict_jointly(&self.sets[set], fold).unwrap_or(nothing),
            Task::Point { set, algorithm, fold, share } => {
                self.curve_point(&self.sets[set], Algorithm::ALL[algorithm], fold, CURVE_SHARES[share])
            }
        }
    }

    /// The rows of a set that a fold tests, and the others.
    fn split(set: &SetRows, grouping: Grouping, fold: usize) -> Option<(Vec<usize>, Vec<usize>)> {
        let dealt = set.dealt(grouping)?;
        let pairs = set.rows.iter().copied().zip(&dealt.of_rows);
        let (tested, learned): (Vec<_>, Vec<_>) = pairs.partition(|(_, of)| **of == fold);
        let rows = |pairs: Vec<(usize, &usize)>| pairs.into_iter().map(|(row, _)| row).collect();
        Some((rows(tested), rows(learned)))
    }

    fn predict_fold(&self, condition: Condition, set: &SetRows, algorithm: Algorithm, fold: usize) -> Option<Done> {
        let (tested, learned) = Self::split(set, condition.by, fold)?;
        let seed = seed_of_part(self.options.seed, fold);
        if condition.neighbours == NeighbourLabels::Predicted {
            let networks = self.collection.networks();
            let rows = in_plan::rows_with_predicted_neighbours(
                networks,
                &self.rows,
                &self.places,
                &learned,
                algorithm,
                condition.by,
                seed,
            );
            let classifier = Classifier::train(algorithm, &Table::from_rows(&rows).ok()?, seed);
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
            return Some(Done::Predicted(predictions, None));
        }
        let data = self.rows_in(condition.neighbours);
        let table = Table::from_rows(learned.iter().map(|&row| &data[row])).ok()?;
        let classifier = Classifier::train(algorithm, &table, seed);
        let values: Vec<Values> = tested.iter().map(|&row| data[row].features.values()).collect();
        let predictions = tested.iter().zip(&values).map(|(&row, values)| (row, classifier.predict(values))).collect();
        let shuffled = (condition == self.main_condition()).then(|| {
            let truths: Vec<Label> = tested.iter().map(|&row| self.rows[row].label).collect();
            right_when_shuffled(&classifier, &values, &truths, seed)
        });
        Some(Done::Predicted(predictions, shuffled))
    }

    /// The joint classifier on the buildings of a fold, having learned from the others of the set.
    fn predict_jointly(&self, set: &SetRows, fold: usize) -> Option<Done> {
        let (tested, learned) = Self::split(set, Grouping::Building, fold)?;
        let taught: Vec<&RoomNetwork> = self.networks_of(&learned).into_values().collect();
        // Threads are busy with other tasks.
        let alone = Work::quiet().on_threads(1);
        let joint = Joint::train(&taught, seed_of_part(self.options.seed, fold), &alone).ok()?;
        let said: BTreeMap<usize, Vec<Distribution>> =
            self.networks_of(&tested).into_iter().map(|(at, network)| (at, joint.predict(network, &[]))).collect();
        let prediction = |row: usize| Some((row, *said.get(&self.places[row].network)?.get(self.places[row].room)?));
        Some(Done::Predicted(tested.into_iter().filter_map(prediction).collect(), None))
    }

    /// What lies behind the openings of a fold's buildings, having learned from the others of the set.
    fn look_behind(&self, set: &SetRows, fold: usize) -> Option<Done> {
        let (tested, learned) = Self::split(set, Grouping::Building, fold)?;
        let networks = |rows: &[usize]| self.networks_of(rows).into_values().collect::<Vec<_>>();
        Some(Done::Behind(Unknown::train(&networks(&learned)).test(&networks(&tested))))
    }

    /// The networks that hold some rows, by index.
    fn networks_of(&self, rows: &[usize]) -> BTreeMap<usize, &RoomNetwork> {
        let networks = self.collection.networks();
        rows.iter().map(|&row| self.places[row].network).map(|at| (at, &networks[at])).collect()
    }

    fn curve_point(&self, set: &SetRows, algorithm: Algorithm, fold: usize, share: f64) -> Done {
        let mode = self.plain_mode();
        let Some((tested, mut learned)) = Self::split(set, self.options.grouping, fold) else {
            return Done::Point(0, 0, 0);
        };
        let mut random = Random::new(seed_of_part(self.options.seed, fold));
        // The smaller parts lie within the larger ones, and buildings stay whole where folds keep them so.
        if self.options.grouping == Grouping::Building {
            let mut buildings: Vec<&str> = learned.iter().map(|&row| building_of(&self.rows[row])).collect();
            buildings.sort_unstable();
            buildings.dedup();
            random.shuffle(&mut buildings);
            let rank: BTreeMap<&str, usize> =
                buildings.into_iter().enumerate().map(|(rank, name)| (name, rank)).collect();
            learned.sort_by_key(|&row| rank.get(building_of(&self.rows[row])));
        } else {
            random.shuffle(&mut learned);
        }
        learned.truncate(((learned.len() as f64 * share).round() as usize).max(1));
        let data = self.rows_in(mode);
        let Some(classifier) = self.train(algorithm, learned.iter().copied(), mode) else {
            return Done::Point(0, 0, 0);
        };
        let right =
            tested.iter().filter(|&&row| classifier.predict(&data[row].features.values()).label() == data[row].label);
        Done::Point(learned.len(), tested.len(), right.count())
    }

    fn gather(&self, results: &Results) -> Study {
        let conditions = self.conditions();
        let main = self.main_condition();
        let mut study = Study {
            program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
            seed: self.options.seed,
            folds: self.options.folds,
            condition: main,
            sets: self.sets.iter().map(|set| self.describe(set)).collect(),
            accuracy: self.cells(results),
            averages: Vec::new(),
            confusion: Vec::new(),
            rooms: Vec::new(),
            own_against_standard: Vec::new(),
            own_against_foreign: Vec::new(),
            learning_curves: Vec::new(),
            importance: Vec::new(),
            joint: Vec::new(),
            unknown: Vec::new(),
            typologies: Vec::new(),
            notes: self.notes.clone(),
        };
        for (at, set) in self.sets.iter().enumerate() {
            let of_set: Vec<&Scores> =
                Algorithm::ALL.into_iter().filter_map(|algorithm| study.scores(&set.name, algorithm, main)).collect();
            if !of_set.is_empty() {
                let mean = |of: &dyn Fn(&Scores) -> f64| Moments::of(of_set.iter().map(|scores| of(scores))).mean;
                let average = Average {
                    set: set.name.clone(),
                    mean: mean(&|scores| scores.accuracy),
                    deviation: mean(&|scores| scores.accuracy_deviation),
                };
                let confusion = confusion_table(&set.name, &of_set);
                study.averages.push(average);
                study.confusion.push(confusion);
            }
            let statistics = Statistics::of(set.rows.iter().map(|&row| &self.rows[row]));
            let labels = statistics.labels.iter().map(LabelLine::of).collect();
            study.rooms.push(RoomsTable { set: set.name.clone(), labels });
            for (number, algorithm) in Algorithm::ALL.into_iter().enumerate() {
                study.learning_curves.extend(results.curve(set, at, number, algorithm));
                let accuracy = study.scores(&set.name, algorithm, main).map_or(0.0, |scores| scores.accuracy);
                study.importance.extend(results.importance(set, at, number, algorithm, accuracy, &conditions, main));
            }
        }
        study.joint = (0..self.sets.len()).filter_map(|set| self.compare_jointly(results, set, &study)).collect();
        study.unknown = (0..self.sets.len()).filter_map(|set| self.compare_behind(results, set)).collect();
        self.compare(results, &self.right(results), &mut study);
        study
    }

    /// The scores of each set, algorithm and condition.
    fn cells(&self, results: &Results) -> Vec<Cell> {
        let mut cells = Vec::new();
        for (index, &condition) in self.conditions().iter().enumerate() {
            for (at, set) in self.sets.iter().enumerate() {
                let Some(dealt) = set.dealt(condition.by) else { continue };
                for (number, algorithm) in Algorithm::ALL.into_iter().enumerate() {
                    let predictions = results.folds(index, at, number);
                    let scores =
                        Scores::of(predictions.iter().map(|(fold, row, said)| (*fold, *said, self.rows[*row].label)));
                    cells.push(Cell { set: set.name.clone(), algorithm, condition, fold_count: dealt.count, scores });
                }
            }
        }
        cells
    }

    /// The joint classifier beside the best of the four where no building and no label is known.
    fn compare_jointly(&self, results: &Results, set: usize, study: &Study) -> Option<JointCell> {
        let condition = Condition { by: Grouping::Building, neighbours: NeighbourLabels::Predicted };
        let at = self.conditions().iter().position(|other| *other == condition)?;
        let name = &self.sets[set].name;
        let accuracy =
            |algorithm: Algorithm| study.scores(name, algorithm, condition).map_or(0.0, |scores| scores.accuracy);
        let best = Algorithm::ALL.into_iter().max_by(|&p, &q| accuracy(p).total_cmp(&accuracy(q)))?;
        let of_joint = results.jointly(set);
        if of_joint.is_empty() {
            return None;
        }
        let is_right = |row: usize, said: &Distribution| said.label() == self.rows[row].label;
        let by_best: BTreeMap<usize, bool> = results
            .folds(at, set, best as usize)
            .into_iter()
            .map(|(_, row, said)| (row, is_right(row, said)))
            .collect();
        let pairs = of_joint.iter().filter_map(|(_, row, said)| {
            let first = f64::from(u8::from(is_right(*row, said)));
            Some((building_of(&self.rows[*row]), first, f64::from(u8::from(*by_best.get(row)?))))
        });
        let comparison = Comparison::of(pairs, self.options.seed)?;
        let scores = Scores::of(of_joint.iter().map(|(fold, row, said)| (*fold, *said, self.rows[*row].label)));
        Some(JointCell { set: name.clone(), best, comparison, scores })
    }

    /// What is said of what lies behind openings beside the most frequent label.
    fn compare_behind(&self, results: &Results, wanted: usize) -> Option<UnknownCell> {
        let mut openings: Vec<(&str, f64, f64)> = Vec::new();
        for (task, done) in &results.0 {
            if let (Task::Unknown { set, .. }, Done::Behind(plans)) = (task, done)
                && *set == wanted
            {
                for plan in plans {
                    let share = |part: usize| part as f64 / plan.openings as f64;
                    let of_one = (plan.building.as_str(), share(plan.right), share(plan.most_frequent));
                    openings.extend((0..plan.openings).map(|_| of_one));
                }
            }
        }
        let comparison = Comparison::of(openings, self.options.seed)?;
        Some(UnknownCell { set: self.sets[wanted].name.clone(), comparison })
    }

    /// How right each set's algorithms are on each row, under the main condition; `None` for rows that
    /// are not of the set.
    fn right(&self, results: &Results) -> Vec<Vec<Vec<Option<bool>>>> {
        let main = self.conditions().iter().position(|condition| *condition == self.main_condition());
        let of_algorithm = |set: usize, algorithm: usize| {
            let mut right = vec![None; self.rows.len()];
            for (_, row, said) in results.folds(main.unwrap_or_default(), set, algorithm) {
                right[row] = Some(said.label() == self.rows[row].label);
            }
            right
        };
        (0..self.sets.len()).map(|set| (0..4).map(|algorithm| of_algorithm(set, algorithm)).collect()).collect()
    }

    /// The typologies' own classifiers against standard and foreign ones.
    fn compare(&self, results: &Results, right: &[Vec<Vec<Option<bool>>>], study: &mut Study) {
        let standard = self.sets.iter().position(|set| set.typology.is_none());
        let main = self.options.grouping;
        for (own, set) in self.typology_sets() {
            let Some(dealt) = set.dealt(main) else { continue };
            let rivals = |rival: &[Vec<Option<bool>>], name: &str| -> Vec<Rival> {
                let algorithms = Algorithm::ALL.into_iter().map(Some).chain([None]);
                let rival_of = |algorithm: Option<Algorithm>| {
                    let numbers = algorithm.map_or(0..4, |algorithm| algorithm as usize..algorithm as usize + 1);
                    let share = |of: &[Vec<Option<bool>>], row: usize| -> Option<f64> {
                        let right: Option<Vec<bool>> = numbers.clone().map(|number| of[number][row]).collect();
                        right.map(|right| right.iter().filter(|&&right| right).count() as f64 / right.len() as f64)
                    };
                    let pairs: Vec<(usize, f64, f64)> = set
                        .rows
                        .iter()
                        .enumerate()
                        .filter_map(|(index, &row)| Some((index, share(&right[own], row)?, share(rival, row)?)))
                        .collect();
                    let mut of_folds = vec![(0.0, 0.0); dealt.count];
                    for &(index, _, second) in &pairs {
                        let fold = &mut of_folds[dealt.of_rows[index]];
                        *fold = (fold.0 + second, fold.1 + 1.0);
                    }
                    let accuracies: Vec<f64> =
                        of_folds.iter().filter(|fold| fold.1 > 0.0).map(|(right, rooms)| right / rooms).collect();
                    let rooms = pairs
                        .iter()
                        .map(|&(index, first, second)| (building_of(&self.rows[set.rows[index]]), first, second));
                    Some(Rival {
                        rooms_of: set.name.clone(),
                        rival: name.to_owned(),
                        algorithm,
                        rival_deviation: Moments::of(accuracies).deviation,
                        comparison: Comparison::of(rooms, self.options.seed)?,
                    })
                };
                algorithms.filter_map(rival_of).collect()
            };
            if let Some(standard) = standard {
                study.own_against_standard.extend(rivals(&right[standard], STANDARD));
            }
            for (model, other) in self.typology_sets().filter(|(model, _)| *model != own) {
                let foreign: Vec<Vec<Option<bool>>> = (0..4)
                    .map(|number| {
                        let mut right = vec![None; self.rows.len()];
                        for (row, said) in results.foreign(model, number) {
                            right[*row] = Some(said.label() == self.rows[*row].label);
                        }
                        right
                    })
                    .collect();
                study.own_against_foreign.extend(rivals(&foreign, &other.name));
            }
        }
    }

    fn describe(&self, set: &SetRows) -> Set {
        let rows: Vec<&Row> = set.rows.iter().map(|&row| &self.rows[row]).collect();
        let distinct =
            |key: &dyn Fn(&Row) -> (String, String)| rows.iter().map(|row| key(row)).collect::<BTreeSet<_>>().len();
        let table = Table::from_rows(rows.iter().copied()).ok();
        let most = table.as_ref().and_then(|table| table.label_counts().into_iter().max()).unwrap_or_default();
        Set {
            name: set.name.clone(),
            rooms: rows.len(),
            plans: distinct(&|row| (building_of(row).to_owned(), row.plan.clone())),
            buildings: distinct(&|row| (building_of(row).to_owned(), String::new())),
            most_frequent: most as f64 / rows.len().max(1) as f64,
            fingerprint: table.map(|table| format!("{:016x}", table.fingerprint())).unwrap_or_default(),
        }
    }
}

/// Rooms that are right after shuffling each feature among them, of [`SHUFFLES`] times the rooms.
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

/// How typologies are inferred, folds by building. Nothing without several typologies.
fn infer_typologies(collection: &Collection, blind: &[RoomNetwork], options: Options) -> Vec<TypologyLine> {
    let typologies = collection.typologies();
    if typologies.len() < 2 || blind.is_empty() {
        return Vec::new();
    }
    let blind: Vec<&RoomNetwork> = blind.iter().collect();
    let inferred = typology::cross_validate(&blind, &BTreeSet::new(), options.folds, options.seed);
    let line = |typology: &Typology| {
        let of_truth: Vec<_> = inferred.iter().filter(|plan| plan.truth == *typology).collect();
        let best = |plan: &typology::Inferred| plan.posterior.first().map(|(best, _)| best.clone());
        let mut buildings: BTreeMap<&str, Vec<f64>> = BTreeMap::new();
        for plan in &of_truth {
            let right = f64::from(u8::from(best(plan).as_ref() == Some(typology)));
            buildings.entry(&plan.building).or_default().push(right);
        }
        let mean = |numbers: &[f64]| Moments::of(numbers.iter().copied()).mean;
        let of_buildings: Vec<f64> = buildings.values().map(|of_plans| mean(of_plans)).collect();
        let of_plans: Vec<f64> = buildings.values().flatten().copied().collect();
        let taken_for = |other: &Typology| TypologyCount {
            taken_for: other.as_str().to_owned(),
            plans: of_truth.iter().filter(|plan| best(plan).as_ref() == Some(other)).count(),
        };
        TypologyLine {
            typology: typology.as_str().to_owned(),
            plans: typologies.iter().map(taken_for).collect(),
            plan_accuracy: mean(&of_plans),
            building_accuracy: mean(&of_buildings),
            buildings: buildings.len(),
        }
    };
    typologies.iter().map(line).collect()
}

fn confusion_table(set: &str, scores: &[&Scores]) -> ConfusionTable {
    let mut rooms = Confusion::default();
    let mut shares = [[0.0; 5]; 5];
    for of_algorithm in scores {
        let of_shares = of_algorithm.confusion.row_shares();
        for row in 0..5 {
            for column in 0..5 {
                rooms.0[row][column] += of_algorithm.confusion.0[row][column];
                shares[row][column] += of_shares[row][column] / scores.len() as f64;
            }
        }
    }
    // All algorithms are tested on the same rooms: rates of the sums are means of the rates.
    ConfusionTable { set: set.to_owned(), rooms, shares, rates: Label::ALL.map(|label| rooms.table_rates(label)) }
}

impl Results {
    fn new(tasks: Vec<Task>, done: Vec<Done>) -> Self {
        let mut results: Vec<(Task, Done)> = tasks.into_iter().zip(done).collect();
        results.sort_by_key(|(task, _)| *task);
        Self(results)
    }

    /// The predictions of all folds: fold, row, distribution.
    fn folds(&self, condition: usize, set: usize, algorithm: usize) -> Vec<(usize, usize, &Distribution)> {
        let from = Task::Fold { condition, set, algorithm, fold: 0 };
        let start = self.0.partition_point(|(task, _)| *task < from);
        let mut predictions = Vec::new();
        for (task, done) in &self.0[start..] {
            match (task, done) {
                (Task::Fold { condition: c, set: s, algorithm: a, fold }, Done::Predicted(rows, _))
                    if (*c, *s, *a) == (condition, set, algorithm) =>
                {
                    predictions.extend(rows.iter().map(|(row, said)| (*fold, *row, said)));
                }
                _ => break,
            }
        }
        predictions
    }

    /// The joint classifier's predictions on a set: fold, row, distribution.
    fn jointly(&self, wanted: usize) -> Vec<(usize, usize, &Distribution)> {
        let mut predictions = Vec::new();
        for (task, done) in &self.0 {
            if let (Task::Joint { set, fold }, Done::Predicted(rows, _)) = (task, done)
                && *set == wanted
            {
                predictions.extend(rows.iter().map(|(row, said)| (*fold, *row, said)));
            }
        }
        predictions
    }

    fn foreign(&self, model: usize, algorithm: usize) -> &[(usize, Distribution)] {
        let wanted = Task::Foreign { model, algorithm };
        match self.0.binary_search_by(|(task, _)| task.cmp(&wanted)).map(|at| &self.0[at].1) {
            Ok(Done::Predicted(rows, _)) => rows,
            _ => &[],
        }
    }

    fn curve(&self, set: &SetRows, at: usize, number: usize, algorithm: Algorithm) -> Option<Curve> {
        let points: Vec<CurvePoint> = (0..CURVE_SHARES.len())
            .filter_map(|wanted| {
                let of_folds: Vec<(usize, f64)> = self
                    .0
                    .iter()
                    .filter_map(|(task, done)| match (task, done) {
                        (Task::Point { set, algorithm, share, .. }, Done::Point(learned, tested, right))
                            if (*set, *algorithm, *share) == (at, number, wanted) && *tested > 0 =>
                        {
                            Some((*learned, *right as f64 / *tested as f64))
                        }
                        _ => None,
                    })
                    .collect();
                let accuracy = Moments::of(of_folds.iter().map(|(_, accuracy)| *accuracy));
                let rooms: usize = of_folds.iter().map(|(learned, _)| learned).sum();
                (!of_folds.is_empty()).then(|| CurvePoint {
                    training_rooms: rooms as f64 / of_folds.len() as f64,
                    accuracy: accuracy.mean,
                    deviation: accuracy.deviation,
                })
            })
            .collect();
        (!points.is_empty()).then(|| Curve { set: set.name.clone(), algorithm, points })
    }

    fn importance(
        &self,
        set: &SetRows,
        at: usize,
        number: usize,
        algorithm: Algorithm,
        accuracy: f64,
        conditions: &[Condition],
        main: Condition,
    ) -> Option<Importance> {
        let condition = conditions.iter().position(|condition| *condition == main)?;
        let mut right = [0; FEATURES];
        let mut found = false;
        for (task, done) in &self.0 {
            if let (Task::Fold { condition: c, set, algorithm, .. }, Done::Predicted(_, Some(of_fold))) = (task, done)
                && (*c, *set, *algorithm) == (condition, at, number)
            {
                found = true;
                for (sum, count) in right.iter_mut().zip(of_fold) {
                    *sum += count;
                }
            }
        }
        let shuffled = (SHUFFLES * set.rows.len()) as f64;
        let accuracy_lost = right.map(|right| accuracy - right as f64 / shuffled);
        found.then(|| Importance { set: set.name.clone(), algorithm, accuracy_lost })
    }
}
