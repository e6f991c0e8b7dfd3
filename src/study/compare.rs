//! The evaluation of measurements: scores, averages, tables, and classifiers compared.

use std::collections::{BTreeMap, BTreeSet};

use super::measure::{CURVE_SHARES, Experiment, JOINT_SHARES, Outcome, SHUFFLES, SetRows, Task};
use super::noise::Noise;
use super::predictions::Prediction;
use super::{
    Average, Cell, Comparison, Condition, ConfusionTable, Curve, CurvePoint, HONEST, Importance, JointCell, JointCurve,
    LabelLine, Rival, RoomsTable, Set, Study, UnknownCell,
};
use crate::classify::blend::{blend_unseen, recipe};
use crate::classify::{Algorithm, Confusion, Distribution, Method, Scores};
use crate::dataset::folds::{Grouping, building_of, group_of};
use crate::dataset::sets::STANDARD;
use crate::dataset::table::{FEATURES, Table};
use crate::dataset::{Moments, Row, Statistics};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// What was said of a room out of fold: the fold, the row, the distribution.
type Said = (usize, usize, Distribution);

fn as_told(said: &[Said]) -> Vec<(usize, usize, &Distribution)> {
    said.iter().map(|(fold, row, said)| (*fold, *row, said)).collect()
}

/// Tasks with their outcomes, sorted.
pub(super) struct Results(Vec<(Task, Outcome)>);

impl Experiment<'_> {
    /// Everything in a study except the inference of typologies.
    pub(super) fn gather(&self, results: &Results) -> Study {
        let conditions = self.conditions();
        let main = self.main_condition();
        let mut study = Study {
            program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
            about: super::About::default(),
            seed: self.options.seed,
            folds: self.options.folds,
            condition: main,
            honest: None,
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
            joint_curves: Vec::new(),
            noise: Vec::new(),
            unknown: Vec::new(),
            typologies: Vec::new(),
            typology_ways: Vec::new(),
            own_against_standard_honest: Vec::new(),
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
            for algorithm in Algorithm::ALL {
                study.learning_curves.extend(results.curve(set, at, algorithm));
                let accuracy = study.scores(&set.name, algorithm, main).map_or(0.0, |scores| scores.accuracy);
                study.importance.extend(results.importance(set, at, algorithm, accuracy, &conditions, main));
            }
        }
        let blended: Vec<Vec<Said>> = (0..self.sets.len()).map(|set| self.blended(results, set)).collect();
        for (method, of_sets) in [
            (Method::Joint, (0..self.sets.len()).map(|set| results.jointly(set)).collect()),
            (Method::Blend, blended.iter().map(|said| as_told(said)).collect::<Vec<_>>()),
        ] {
            let cells =
                of_sets.iter().enumerate().map(|(set, said)| self.compare_jointly(results, set, method, said, &study));
            let cells: Vec<JointCell> = cells.into_iter().flatten().collect();
            study.joint.extend(cells);
        }
        study.joint_curves =
            self.sets.iter().enumerate().filter_map(|(at, set)| results.joint_curve(self, set, at)).collect();
        study.noise = blended
            .iter()
            .zip(&self.sets)
            .filter(|(_, set)| set.typology.is_some())
            .filter_map(|(said, set)| {
                let rooms: Vec<(&Row, Distribution)> =
                    said.iter().map(|(_, row, said)| (&self.rows[*row], *said)).collect();
                Noise::of(&set.name, &rooms)
            })
            .collect();
        study.unknown = (0..self.sets.len()).filter_map(|set| self.compare_behind(results, set)).collect();
        study.honest = self.honest_condition(&study);
        self.compare(results, &self.right(results, main), main.by, &mut study);
        if let Some(honest) = study.honest.filter(|honest| *honest != main) {
            let right = self.right(results, honest);
            study.own_against_standard_honest = self.against_standard(&right, honest.by);
        }
        study
    }

    /// The scores of each set, algorithm and condition.
    pub(super) fn cells(&self, results: &Results) -> Vec<Cell> {
        let mut cells = Vec::new();
        for (index, &condition) in self.conditions().iter().enumerate() {
            for (at, set) in self.sets.iter().enumerate() {
                let Some(folds) = set.folds_by(condition.by) else { continue };
                for algorithm in Algorithm::ALL {
                    let predictions = results.folds(index, at, algorithm);
                    let scores =
                        Scores::of(predictions.iter().map(|(fold, row, said)| (*fold, *said, self.rows[*row].label)));
                    cells.push(Cell { set: set.name.clone(), algorithm, condition, fold_count: folds.count, scores });
                }
            }
        }
        cells
    }

    /// What was said of each room out of fold under some conditions: by set, algorithm and room. The joint classifier is tested on
    /// buildings never seen, no label known.
    pub(super) fn predictions(&self, results: &Results, wanted: &[Condition]) -> Vec<Prediction> {
        let mut predictions = Vec::new();
        for (index, condition) in self.conditions().into_iter().enumerate().filter(|(_, it)| wanted.contains(it)) {
            for (at, set) in self.sets.iter().enumerate() {
                let mut tell = |method: Method, said: Vec<(usize, usize, &Distribution)>| {
                    let mut said = said;
                    said.sort_unstable_by_key(|(_, row, _)| *row);
                    let set = &set.name;
                    predictions.extend(said.into_iter().map(|(fold, row, said)| Prediction {
                        row,
                        set: set.clone(),
                        method,
                        condition,
                        fold,
                        said: *said,
                    }));
                };
                for algorithm in Algorithm::ALL {
                    tell(Method::Each(algorithm), results.folds(index, at, algorithm));
                }
                if condition == HONEST {
                    tell(Method::Joint, results.jointly(at));
                    let blended = self.blended(results, at);
                    tell(Method::Blend, as_told(&blended));
                }
            }
        }
        predictions
    }

    /// What the committees that take part in blends said of each room out of fold.
    pub(super) fn by_committees(&self, results: &Results) -> Vec<Prediction> {
        let of_set = |(at, set): (usize, &SetRows)| {
            let told = results.by_committee(at).into_iter();
            let predictions = told.map(|(fold, row, said)| Prediction {
                row,
                set: set.name.clone(),
                method: Method::Each(Algorithm::PERCEPTRON),
                condition: HONEST,
                fold,
                said: *said,
            });
            predictions.collect::<Vec<_>>()
        };
        self.sets.iter().enumerate().flat_map(of_set).collect()
    }

    /// What the blend says of a set's rooms, where no building and no label is known: the mean of what its parts said, those
    /// of the set and the standard ones.
    fn blended(&self, results: &Results, set: usize) -> Vec<Said> {
        let rows = &self.sets[set].rows;
        let (mut parts, mut folds) = (Vec::new(), Vec::new());
        for (of, method, weight) in recipe(&self.sets[set].name) {
            let Some(of) = self.sets.iter().position(|other| other.name == of) else { continue };
            let told = match method {
                Method::Each(_) => results.by_committee(of),
                Method::Joint => results.jointly(of),
                Method::Blend => Vec::new(),
            };
            let of_row: BTreeMap<usize, (usize, &Distribution)> =
                told.into_iter().map(|(fold, row, said)| (row, (fold, said))).collect();
            let (of_folds, said): (Vec<usize>, Vec<Distribution>) =
                rows.iter().filter_map(|row| of_row.get(row).map(|(fold, said)| (*fold, **said))).unzip();
            if folds.is_empty() {
                folds = of_folds;
            }
            parts.push((weight, said));
        }
        let labels: Vec<Label> = rows.iter().map(|&row| self.rows[row].label).collect();
        let Some(unseen) = blend_unseen(&parts, &labels, &folds) else { return Vec::new() };
        folds.iter().zip(rows).zip(unseen.said).map(|((&fold, &row), said)| (fold, row, said)).collect()
    }

    /// A classifier of whole plans beside the best of the learners where no building and no label is known.
    fn compare_jointly(
        &self,
        results: &Results,
        set: usize,
        method: Method,
        of_joint: &[(usize, usize, &Distribution)],
        study: &Study,
    ) -> Option<JointCell> {
        let condition = HONEST;
        let at = self.conditions().iter().position(|other| *other == condition)?;
        let name = &self.sets[set].name;
        let accuracy =
            |algorithm: Algorithm| study.scores(name, algorithm, condition).map_or(0.0, |scores| scores.accuracy);
        let best = Algorithm::ALL.into_iter().max_by(|&p, &q| accuracy(p).total_cmp(&accuracy(q)))?;
        if of_joint.is_empty() {
            return None;
        }
        let is_right = |row: usize, said: &Distribution| said.label() == self.rows[row].label;
        let by_best: BTreeMap<usize, bool> =
            results.folds(at, set, best).into_iter().map(|(_, row, said)| (row, is_right(row, said))).collect();
        let pairs = of_joint.iter().filter_map(|(_, row, said)| {
            let first = f64::from(u8::from(is_right(*row, said)));
            Some((group_of(&self.rows[*row]), first, f64::from(u8::from(*by_best.get(row)?))))
        });
        let comparison = Comparison::of(pairs, self.options.seed)?;
        let scores = Scores::of(of_joint.iter().map(|(fold, row, said)| (*fold, *said, self.rows[*row].label)));
        Some(JointCell { set: name.clone(), method, best, comparison, scores })
    }

    /// Compares predictions of what lies behind openings with the most frequent label.
    fn compare_behind(&self, results: &Results, wanted: usize) -> Option<UnknownCell> {
        let mut openings: Vec<(&str, f64, f64)> = Vec::new();
        for (task, outcome) in &results.0 {
            if let (Task::Unknown { set, .. }, Outcome::Behind(plans)) = (task, outcome)
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

    /// The condition a new building is met under, as far as it was measured: buildings never seen; no label given, or where only
    /// features are known, theirs.
    fn honest_condition(&self, study: &Study) -> Option<Condition> {
        let by_features = Condition { neighbours: NeighbourLabels::True, ..HONEST };
        let measured = |condition: &Condition| {
            study.accuracy.iter().any(|cell| cell.condition == *condition && cell.scores.rooms > 0)
        };
        [HONEST, by_features].into_iter().find(measured)
    }

    /// How right each set's algorithms are on each row, under a condition; `None` for rows that
    /// are not of the set.
    fn right(&self, results: &Results, condition: Condition) -> Vec<Vec<Vec<Option<bool>>>> {
        let main = self.conditions().iter().position(|other| *other == condition);
        let of_algorithm = |set: usize, algorithm: Algorithm| {
            let mut right = vec![None; self.rows.len()];
            for (_, row, said) in results.folds(main.unwrap_or_default(), set, algorithm) {
                right[row] = Some(said.label() == self.rows[row].label);
            }
            right
        };
        let of_set = |set: usize| Algorithm::ALL.map(|algorithm| of_algorithm(set, algorithm)).to_vec();
        (0..self.sets.len()).map(of_set).collect()
    }

    /// The typologies' own classifiers against standard and foreign ones.
    fn compare(&self, results: &Results, right: &[Vec<Vec<Option<bool>>>], by: Grouping, study: &mut Study) {
        study.own_against_standard = self.against_standard(right, by);
        for (own, set) in self.typology_sets() {
            for (model, other) in self.typology_sets().filter(|(model, _)| *model != own) {
                let foreign = Algorithm::ALL.map(|algorithm| {
                    let mut right = vec![None; self.rows.len()];
                    for (row, said) in results.foreign(model, algorithm) {
                        right[*row] = Some(said.label() == self.rows[*row].label);
                    }
                    right
                });
                study.own_against_foreign.extend(self.rivals(set, by, &right[own], &foreign, &other.name));
            }
        }
    }

    /// The typologies' own classifiers against standard ones.
    fn against_standard(&self, right: &[Vec<Vec<Option<bool>>>], by: Grouping) -> Vec<Rival> {
        let Some(standard) = self.sets.iter().position(|set| set.typology.is_none()) else { return Vec::new() };
        let of_set = |(own, set): (usize, &SetRows)| self.rivals(set, by, &right[own], &right[standard], STANDARD);
        self.typology_sets().flat_map(of_set).collect()
    }

    /// A typology's own classifiers against others on its rooms: by algorithm, then averaged.
    fn rivals(
        &self,
        set: &SetRows,
        by: Grouping,
        own: &[Vec<Option<bool>>],
        rival: &[Vec<Option<bool>>],
        name: &str,
    ) -> Vec<Rival> {
        let Some(folds) = set.folds_by(by) else { return Vec::new() };
        let algorithms = Algorithm::ALL.into_iter().map(Some).chain([None]);
        let rival_of = |algorithm: Option<Algorithm>| {
            let of = algorithm.map_or(Algorithm::ALL.to_vec(), |algorithm| vec![algorithm]);
            let share = |right: &[Vec<Option<bool>>], row: usize| -> Option<f64> {
                let right: Option<Vec<bool>> = of.iter().map(|of| right[of.index()][row]).collect();
                right.map(|right| right.iter().filter(|&&right| right).count() as f64 / right.len() as f64)
            };
            let pairs: Vec<(usize, f64, f64)> = set
                .rows
                .iter()
                .enumerate()
                .filter_map(|(index, &row)| Some((index, share(own, row)?, share(rival, row)?)))
                .collect();
            let mut of_folds = vec![(0.0, 0.0); folds.count];
            for &(index, _, second) in &pairs {
                let fold = &mut of_folds[folds.of_rows[index]];
                *fold = (fold.0 + second, fold.1 + 1.0);
            }
            let accuracies: Vec<f64> =
                of_folds.iter().filter(|fold| fold.1 > 0.0).map(|(right, rooms)| right / rooms).collect();
            let rooms =
                pairs.iter().map(|&(index, first, second)| (group_of(&self.rows[set.rows[index]]), first, second));
            Some(Rival {
                rooms_of: set.name.clone(),
                rival: name.to_owned(),
                algorithm,
                rival_deviation: Moments::of(accuracies).deviation,
                comparison: Comparison::of(rooms, self.options.seed)?,
            })
        };
        algorithms.filter_map(rival_of).collect()
    }

    fn describe(&self, set: &SetRows) -> Set {
        let rows: Vec<&Row> = set.rows.iter().map(|&row| &self.rows[row]).collect();
        let distinct = |key: fn(&Row) -> [&str; 4]| rows.iter().map(|row| key(row)).collect::<BTreeSet<_>>().len();
        let table = Table::from_rows(rows.iter().copied()).ok();
        let most = table.as_ref().and_then(|table| table.label_counts().into_iter().max()).unwrap_or_default();
        Set {
            name: set.name.clone(),
            rooms: rows.len(),
            plans: distinct(|row| [&row.file, building_of(row), &row.plan, &row.storey]),
            buildings: distinct(|row| [row.typology.as_ref().map_or("", Typology::as_str), building_of(row), "", ""]),
            most_frequent: most as f64 / rows.len().max(1) as f64,
            fingerprint: table.map(|table| format!("{:016x}", table.fingerprint())).unwrap_or_default(),
        }
    }
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
    pub(super) fn new(tasks: Vec<Task>, outcomes: Vec<Outcome>) -> Self {
        let mut results: Vec<(Task, Outcome)> = tasks.into_iter().zip(outcomes).collect();
        results.sort_by_key(|(task, _)| *task);
        Self(results)
    }

    /// Adds the outcome of a task.
    pub(super) fn add(&mut self, task: Task, outcome: Outcome) {
        let at = self.0.partition_point(|(other, _)| *other < task);
        self.0.insert(at, (task, outcome));
    }

    /// The predictions of all folds: fold, row, distribution.
    fn folds(&self, condition: usize, set: usize, algorithm: Algorithm) -> Vec<(usize, usize, &Distribution)> {
        let from = Task::Fold { condition, set, algorithm, fold: 0 };
        let start = self.0.partition_point(|(task, _)| *task < from);
        let mut predictions = Vec::new();
        for (task, outcome) in &self.0[start..] {
            match (task, outcome) {
                (Task::Fold { condition: c, set: s, algorithm: a, fold }, Outcome::Predicted(rows, _))
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
        self.by_folds(|task| match *task {
            Task::Joint { set, fold } if set == wanted => Some(fold),
            _ => None,
        })
    }

    /// The predictions of the committee that takes part in the blend.
    fn by_committee(&self, wanted: usize) -> Vec<(usize, usize, &Distribution)> {
        self.by_folds(|task| match *task {
            Task::Committee { set, fold } if set == wanted => Some(fold),
            _ => None,
        })
    }

    /// The predictions of the tasks that test a fold.
    fn by_folds(&self, fold_of: impl Fn(&Task) -> Option<usize>) -> Vec<(usize, usize, &Distribution)> {
        let mut predictions = Vec::new();
        for (task, outcome) in &self.0 {
            if let (Some(fold), Outcome::Predicted(rows, _)) = (fold_of(task), outcome) {
                predictions.extend(rows.iter().map(|(row, said)| (fold, *row, said)));
            }
        }
        predictions
    }

    /// The joint classifier's curve on a set, over the folds that all its points were measured on.
    fn joint_curve(&self, experiment: &Experiment<'_>, set: &SetRows, wanted: usize) -> Option<JointCurve> {
        let mut points: Vec<Vec<(usize, usize, usize)>> = vec![Vec::new(); JOINT_SHARES.len() + 1];
        let mut folds = BTreeSet::new();
        for (task, outcome) in &self.0 {
            if let (Task::JointPoint { set, fold, share }, Outcome::Point(learned, tested, right)) = (task, outcome)
                && *set == wanted
                && *tested > 0
            {
                folds.insert(*fold);
                points[*share].push((*learned, *tested, *right));
            }
        }
        for &fold in &folds {
            let of_fold = self.jointly(wanted).into_iter().filter(|(of, ..)| *of == fold);
            let right: Vec<bool> = of_fold.map(|(_, row, said)| said.label() == experiment.rows[row].label).collect();
            let tested = right.len();
            points[JOINT_SHARES.len()].push((
                set.rows.len() - tested,
                tested.max(1),
                right.into_iter().filter(|&right| right).count(),
            ));
        }
        let point = |of: &Vec<(usize, usize, usize)>| {
            let accuracy = Moments::of(of.iter().map(|(_, tested, right)| *right as f64 / *tested as f64));
            let learned = Moments::of(of.iter().map(|(learned, ..)| *learned as f64)).mean;
            CurvePoint { training_rooms: learned, accuracy: accuracy.mean, deviation: accuracy.deviation }
        };
        (!folds.is_empty()).then(|| JointCurve { set: set.name.clone(), points: points.iter().map(point).collect() })
    }

    fn foreign(&self, model: usize, algorithm: Algorithm) -> &[(usize, Distribution)] {
        let wanted = Task::Foreign { model, algorithm };
        match self.0.binary_search_by(|(task, _)| task.cmp(&wanted)).map(|at| &self.0[at].1) {
            Ok(Outcome::Predicted(rows, _)) => rows,
            _ => &[],
        }
    }

    pub(super) fn curve(&self, set: &SetRows, at: usize, wanted: Algorithm) -> Option<Curve> {
        let points: Vec<CurvePoint> = (0..CURVE_SHARES.len())
            .filter_map(|point| {
                let of_folds: Vec<(usize, f64)> = self
                    .0
                    .iter()
                    .filter_map(|(task, outcome)| match (task, outcome) {
                        (Task::Point { set, algorithm, share, .. }, Outcome::Point(learned, tested, right))
                            if (*set, *algorithm, *share) == (at, wanted, point) && *tested > 0 =>
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
        (!points.is_empty()).then(|| Curve { set: set.name.clone(), algorithm: wanted, points })
    }

    fn importance(
        &self,
        set: &SetRows,
        at: usize,
        wanted: Algorithm,
        accuracy: f64,
        conditions: &[Condition],
        main: Condition,
    ) -> Option<Importance> {
        let condition = conditions.iter().position(|condition| *condition == main)?;
        let mut right = [0; FEATURES];
        let mut found = false;
        for (task, outcome) in &self.0 {
            if let (Task::Fold { condition: c, set, algorithm, .. }, Outcome::Predicted(_, Some(of_fold))) =
                (task, outcome)
                && (*c, *set, *algorithm) == (condition, at, wanted)
            {
                found = true;
                for (sum, count) in right.iter_mut().zip(of_fold) {
                    *sum += count;
                }
            }
        }
        let shuffled = (SHUFFLES * set.rows.len()) as f64;
        let accuracy_lost = right.map(|right| accuracy - right as f64 / shuffled);
        found.then(|| Importance { set: set.name.clone(), algorithm: wanted, accuracy_lost })
    }
}
