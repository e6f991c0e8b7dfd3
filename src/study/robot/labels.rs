//! Labels of the rooms that a robot found, by classifiers that did not learn from the building.

use std::collections::{BTreeMap, BTreeSet};

use super::{Explored, Run, StudyPlan};
use crate::base::random::seed_of_part;
use crate::base::work::{Cancelled, Work};
use crate::classify::joint::Joint;
use crate::classify::models::{Models, StoredModel};
use crate::classify::typology::building_folds;
use crate::classify::{Algorithm, Classifier, Method, PlanClassifier, in_plan};
use crate::dataset::sets::set_name;
use crate::dataset::table::Table;
use crate::dataset::{RoomNetwork, Row};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Schemes, Typology};

/// The methods that are compared: the paper's four algorithms, then the joint classifier.
pub const METHODS: [Method; Algorithm::ALL.len() + 1] = {
    let mut methods = [Method::Joint; Algorithm::ALL.len() + 1];
    let mut index = 0;
    while index < methods.len() {
        methods[index] = Method::ALL[index];
        index += 1;
    }
    methods
};

/// A method's name for people; `None` is the average of the algorithms, without the joint classifier.
pub fn method_title(method: Option<Method>) -> &'static str {
    method.map_or("average of the algorithms", Method::title)
}

/// How many labels of one run are right by one method. All counts but [`LabelCounts::reachable`] are of the same
/// rooms: those that the robot found and whose true label is known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LabelCounts {
    /// Rooms the robot could reach whose true label is known.
    pub reachable: usize,
    /// Those of them that it found.
    pub rooms: usize,
    /// Right by the typology's classifier and by the standard one, on: the true plan with the neighbours' true
    /// labels (the paper's ideal conditions), the true plan with no label known, the robot's plan with none known.
    /// `None` where there was nothing to learn from.
    pub right: [[Option<usize>; 2]; 3],
}

/// Where classifiers come from.
enum Taught {
    /// They learned from the other buildings: with temporary labels of neighbours, and with true ones.
    Others([Vec<PlanClassifier>; 2]),
    /// There is no other building: the program's own, for plans that they did not learn from.
    Bundled(Vec<std::sync::Arc<StoredModel>>),
    Nothing,
}

impl Taught {
    /// The classifiers for a plan, by method; `is_ideal`: with true labels of neighbours.
    fn of(&self, network: &RoomNetwork, is_ideal: bool) -> Vec<&PlanClassifier> {
        match self {
            Self::Others(classifiers) => classifiers[usize::from(is_ideal)].iter().collect(),
            Self::Bundled(models) => {
                let learned = |model: &&std::sync::Arc<StoredModel>| {
                    model.about.learned.as_ref().is_some_and(|learned| learned.acquaintance(network).is_some())
                };
                if models.iter().any(|model| learned(&model)) {
                    return Vec::new();
                }
                models.iter().map(|model| &model.classifier).collect()
            }
            Self::Nothing => Vec::new(),
        }
    }
}

/// What is told of a study's labels.
pub struct LabelResults {
    /// For each run, for each of [`METHODS`].
    pub counts: Vec<[LabelCounts; METHODS.len()]>,
    /// What could not be measured, or was measured otherwise.
    pub notes: Vec<String>,
}

/// Labels the rooms of all runs. Buildings are dealt to folds; the classifiers for a building learn from those of all
/// other folds, explored or not.
///
/// # Errors
/// When the work is cancelled.
pub fn label_runs(
    plans: &[StudyPlan],
    runs: &[(Run, Option<&Explored>)],
    folds: usize,
    seed: u64,
    work: &Work<'_>,
) -> Result<LabelResults, Cancelled> {
    let folds = folds.max(2);
    let networks: Vec<&RoomNetwork> = plans.iter().map(|plan| &plan.network).collect();
    let fold_of = building_folds(&networks, folds, seed);
    let wanted: BTreeSet<(usize, Option<Typology>)> = plans
        .iter()
        .zip(&fold_of)
        .filter(|(plan, _)| plan.is_explored)
        .flat_map(|(plan, &fold)| [(fold, plan.network.typology.clone()), (fold, None)])
        .collect();
    let wanted: Vec<(usize, Option<Typology>)> = wanted.into_iter().collect();
    // Each method by itself keeps the processors busy to the end.
    let parts = wanted.len() * METHODS.len();
    let trained = work.map(parts, |part| {
        let ((fold, set), method) = (&wanted[part / METHODS.len()], METHODS[part % METHODS.len()]);
        let taught: Vec<&RoomNetwork> = networks
            .iter()
            .zip(&fold_of)
            .filter(|(network, of)| *of != fold && (set.is_none() || network.typology == *set))
            .map(|(network, _)| *network)
            .collect();
        train(method, &taught, seed_of_part(seed, *fold), &work.alone())
    })?;
    let mut trained = trained.into_iter();
    let mut taught: BTreeMap<(usize, Option<Typology>), Taught> = BTreeMap::new();
    let mut notes: BTreeSet<String> = BTreeSet::new();
    for (fold, set) in wanted {
        let of: Vec<Option<[PlanClassifier; 2]>> = trained.by_ref().take(METHODS.len()).collect();
        let all: Option<Vec<[PlanClassifier; 2]>> = of.into_iter().collect();
        let found = match all {
            Some(all) => {
                let (temporary, ideal) = all.into_iter().map(|[temporary, ideal]| (temporary, ideal)).unzip();
                Taught::Others([temporary, ideal])
            }
            None => bundled(set.as_ref(), &mut notes),
        };
        taught.insert((fold, set), found);
    }
    let schemes = Schemes::bundled();
    let counts = work.map(runs.len(), |index| {
        let (run, explored) = runs[index];
        let network = &plans[run.plan].network;
        let fold = fold_of[run.plan];
        let own = taught.get(&(fold, network.typology.clone())).filter(|_| network.typology.is_some());
        let standard = taught.get(&(fold, None));
        count(network, explored, [own, standard], &schemes)
    })?;
    Ok(LabelResults { counts, notes: notes.into_iter().collect() })
}

fn bundled(set: Option<&Typology>, notes: &mut BTreeSet<String>) -> Taught {
    let name = set_name(set);
    let models: Result<Vec<_>, _> = METHODS.iter().map(|&method| Models::bundled().find(name, method)).collect();
    match models {
        Ok(models) => {
            notes.insert(format!(
                "{name}: no other building to learn from, so the models that come with the program were taken, for \
                 plans that they did not learn from"
            ));
            Taught::Bundled(models)
        }
        Err(_) => {
            notes.insert(format!("{name}: no other building to learn from, so its labels were not counted"));
            Taught::Nothing
        }
    }
}

/// A classifier that learned with temporary labels of the neighbours, and one that learned with true ones; the joint
/// classifier takes both. `None` where there is nothing to learn from.
fn train(method: Method, taught: &[&RoomNetwork], seed: u64, work: &Work<'_>) -> Option<[PlanClassifier; 2]> {
    match method {
        Method::Each(algorithm) => {
            let each = |neighbours: NeighbourLabels| -> Option<PlanClassifier> {
                let rows: Vec<Row> = taught
                    .iter()
                    .flat_map(|network| {
                        let seen = network.seen_labels(&network.known_labels(), neighbours);
                        network.rows_seeing(&seen).collect::<Vec<_>>()
                    })
                    .collect();
                let table = Table::from_rows(&rows).ok()?;
                Some(Classifier::train(algorithm, &table, seed, work).ok()?.into())
            };
            Some([each(NeighbourLabels::Temporary)?, each(NeighbourLabels::True)?])
        }
        // A blend is made of models that were trained before.
        Method::Blend => None,
        Method::Joint => {
            let joint: PlanClassifier = Joint::train(taught, seed, work).ok()?.into();
            Some([joint.clone(), joint])
        }
    }
}

/// The label of each room of a network.
fn predict(classifier: &PlanClassifier, network: &RoomNetwork, known: &[Option<Label>]) -> Vec<Label> {
    let neighbours = if known.is_empty() { NeighbourLabels::Temporary } else { NeighbourLabels::True };
    let said = match classifier {
        PlanClassifier::Each(classifier) => in_plan::classify(classifier, network, known, neighbours).distributions,
        PlanClassifier::Joint(joint) => joint.predict(network, known),
        PlanClassifier::Blend(blend) => blend.opinions(network, known).distributions,
    };
    said.iter().map(|said| said.label()).collect()
}

/// Counts the right labels of one run.
fn count(
    truth: &RoomNetwork,
    explored: Option<&Explored>,
    taught: [Option<&Taught>; 2],
    schemes: &Schemes,
) -> [LabelCounts; METHODS.len()] {
    let mut counts = [LabelCounts::default(); METHODS.len()];
    let Some(explored) = explored else { return counts };
    let Some(robot) = explored.network(schemes) else { return counts };
    let true_index: BTreeMap<String, usize> =
        truth.labelled().map(|room| (truth.rooms[room].id.to_string(), room)).collect();
    let robot_index: BTreeMap<String, usize> =
        robot.rooms.iter().enumerate().map(|(index, room)| (room.id.to_string(), index)).collect();
    let labelled = || explored.rooms.iter().filter_map(|room| Some((room, *true_index.get(&room.id)?)));
    let reachable = labelled().count();
    // The true room, the robot's, and the label.
    let pairs: Vec<(usize, usize, Label)> = labelled()
        .filter(|(room, _)| room.is_found())
        .filter_map(|(room, of)| Some((of, *robot_index.get(room.best.as_ref()?)?, truth.rooms[of].label?)))
        .collect();
    let known = truth.known_labels();
    for counts in &mut counts {
        (counts.reachable, counts.rooms) = (reachable, pairs.len());
    }
    for (side, taught) in taught.into_iter().enumerate() {
        let Some(taught) = taught else { continue };
        let plain = taught.of(truth, false);
        let ideal = taught.of(truth, true);
        for (method, (plain, ideal)) in plain.into_iter().zip(ideal).enumerate() {
            let in_truth = |said: Vec<Label>| pairs.iter().filter(|(of, _, label)| said[*of] == *label).count();
            let in_robot = |said: Vec<Label>| pairs.iter().filter(|(_, of, label)| said[*of] == *label).count();
            counts[method].right[0][side] = Some(in_truth(predict(ideal, truth, &known)));
            counts[method].right[1][side] = Some(in_truth(predict(plain, truth, &[])));
            counts[method].right[2][side] = Some(in_robot(predict(plain, &robot, &[])));
        }
    }
    counts
}
