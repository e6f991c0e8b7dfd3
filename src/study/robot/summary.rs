//! What a study of robots found, put together from its runs.

use serde::Serialize;

use super::labels::{LabelCounts, METHODS, label_runs, method_title};
use super::{Explored, Factor, Record, RobotCondition, RobotStudyOptions, Run, StudyPlan};
use crate::base::work::{Cancelled, Work};
use crate::classify::Method;
use crate::robot::score::Fate;
use crate::study::{About, Comparison};

/// What labels are predicted from. The rooms are the same: those that the robot found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// The true plan, with the true labels of each room's neighbours: the paper's ideal conditions.
    Ideal,
    /// The true plan, no label known.
    TruePlan,
    /// The robot's plan, no label known.
    Robot,
}

impl View {
    pub const ALL: [Self; 3] = [Self::Ideal, Self::TruePlan, Self::Robot];

    /// For people.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Ideal => "true plan, neighbours' labels given",
            Self::TruePlan => "true plan, no label given",
            Self::Robot => "robot's plan, no label given",
        }
    }
}

/// A study. All shares 0..=1.
#[derive(Clone, Debug, Serialize)]
pub struct RobotStudy {
    pub program: String,
    pub about: About,
    pub options: RobotStudyOptions,
    /// Plans explored, and their buildings; plans that were read in all.
    pub explored_plans: usize,
    pub explored_buildings: usize,
    pub plans: usize,
    /// Typologies explored, then `all`.
    pub sets: Vec<String>,
    /// By set and condition.
    pub conditions: Vec<ConditionLine>,
    /// By set, condition and method.
    pub labels: Vec<LabelLine>,
    /// Differences that chance may explain or not, by set, on all conditions with the usual noise.
    pub gaps: Vec<Gap>,
    /// By run.
    pub runs: Vec<RunLine>,
    pub notes: Vec<String>,
}

/// What robots found under one condition, summed over the runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConditionLine {
    pub set: String,
    #[serde(flatten)]
    pub condition: RobotCondition,
    pub runs: usize,
    /// Runs that ended by themselves.
    pub ended: usize,
    /// Rooms in reach.
    pub rooms: usize,
    pub found: usize,
    pub split: usize,
    pub merged: usize,
    pub missed: usize,
    /// Rooms the robots put into their plans, without those out of reach that they saw through a door.
    pub found_rooms: usize,
    /// Share of the rooms in reach that were found, and of the robots' rooms that are true ones.
    pub room_recall: f64,
    pub room_precision: f64,
    /// Mean over the rooms in reach.
    pub iou: f64,
    pub true_edges: usize,
    pub right_edges: usize,
    pub wrong_edges: usize,
    pub edge_recall: f64,
    pub edge_precision: f64,
    pub driven_m: f64,
    pub collisions: usize,
    /// Mean over the runs.
    pub path_error_m: f64,
}

/// Labels under one condition by one method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LabelLine {
    pub set: String,
    #[serde(flatten)]
    pub condition: RobotCondition,
    /// A method, or `average`: the mean over the paper's algorithms.
    pub method: String,
    /// Found rooms whose true label is known.
    pub rooms: usize,
    /// By the typology's classifier and by the standard one, in the order of [`View::ALL`]; `None` where there was
    /// nothing to learn from.
    pub own: [Option<f64>; 3],
    pub standard: [Option<f64>; 3],
    /// Share of all labelled rooms in reach that were found and got the right label from the typology's classifier.
    pub found_and_right: Option<f64>,
}

/// A difference under the usual noise, with its interval over buildings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Gap {
    pub set: String,
    /// What is compared with what.
    pub first: String,
    pub second: String,
    pub method: String,
    pub comparison: Comparison,
}

/// One run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunLine {
    pub file: String,
    pub plan: String,
    pub building: String,
    pub typology: String,
    #[serde(flatten)]
    pub condition: RobotCondition,
    pub seed: u64,
    /// `ended`, `gave up`, or `no plan`.
    pub outcome: &'static str,
    pub rooms: usize,
    pub found: usize,
    pub found_rooms: usize,
    pub unreachable: usize,
    pub true_edges: usize,
    pub right_edges: usize,
    pub wrong_edges: usize,
    pub driven_m: f64,
    pub collisions: usize,
    pub path_error_m: f64,
    pub labelled: usize,
    /// Right by the typology's classifier in the robot's plan, mean over the algorithms, and by the joint classifier.
    pub right: Option<f64>,
    pub right_joint: Option<usize>,
}

/// The name of the set of all typologies.
const ALL: &str = "all";

/// Puts a study together: labels the rooms of all runs, and counts.
///
/// # Errors
/// When the work is cancelled.
pub fn gather(
    plans: &[StudyPlan],
    runs: &[Run],
    records: &[Record],
    options: &RobotStudyOptions,
    work: &Work<'_>,
) -> Result<RobotStudy, Cancelled> {
    let pairs: Vec<(Run, Option<&Explored>)> =
        runs.iter().zip(records).map(|(run, record)| (*run, record.explored.as_ref())).collect();
    let labelled = label_runs(plans, &pairs, options.folds, options.seed, work)?;
    let counted = Counted { plans, pairs, labels: labelled.counts, seed: options.seed };
    let explored: Vec<&StudyPlan> = plans.iter().filter(|plan| plan.is_explored).collect();
    let mut typologies: Vec<String> = explored.iter().map(|plan| typology_of(plan)).collect();
    typologies.sort_unstable();
    typologies.dedup();
    let mut sets = typologies;
    if sets.len() != 1 {
        sets.push(ALL.to_owned());
    }
    let mut buildings: Vec<_> = explored.iter().map(|plan| (typology_of(plan), &plan.network.group)).collect();
    buildings.sort_unstable();
    buildings.dedup();
    let conditions = options.conditions();
    let mut lines = Vec::new();
    let mut labels = Vec::new();
    let mut gaps = Vec::new();
    for set in &sets {
        for condition in &conditions {
            lines.push(counted.condition(set, condition));
            labels.push(counted.labels(set, condition, None));
            labels.extend(METHODS.map(|method| counted.labels(set, condition, Some(method))));
        }
        gaps.extend(counted.gaps(set));
    }
    let mut notes = labelled.notes;
    let lost = counted.pairs.iter().filter(|(_, explored)| explored.is_none()).count();
    if lost > 0 {
        notes.push(format!(
            "{lost} of {} runs have no result: no room has space for the robot, or the rooms it found make no plan",
            runs.len()
        ));
    }
    let endless = counted.pairs.iter().filter(|(_, it)| it.is_some_and(|it| !it.ended)).count();
    if endless > 0 {
        notes.push(format!("{endless} of {} runs were stopped before they ended by themselves", runs.len()));
    }
    Ok(RobotStudy {
        program: String::new(),
        about: About::default(),
        options: options.clone(),
        explored_plans: explored.len(),
        explored_buildings: buildings.len(),
        plans: plans.len(),
        sets,
        conditions: lines,
        labels,
        gaps,
        runs: counted.runs(),
        notes,
    })
}

fn typology_of(plan: &StudyPlan) -> String {
    plan.network.typology.as_ref().map_or("unknown", |typology| typology.as_str()).to_owned()
}

/// All that was counted, by run.
struct Counted<'a> {
    plans: &'a [StudyPlan],
    pairs: Vec<(Run, Option<&'a Explored>)>,
    labels: Vec<[LabelCounts; METHODS.len()]>,
    seed: u64,
}

impl Counted<'_> {
    /// The runs of a set under a condition, by index.
    fn of<'b>(&'b self, set: &'b str, condition: &'b RobotCondition) -> impl Iterator<Item = usize> + 'b {
        (0..self.pairs.len()).filter(move |&index| {
            let run = &self.pairs[index].0;
            run.condition == *condition && (set == ALL || typology_of(&self.plans[run.plan]) == set)
        })
    }

    fn condition(&self, set: &str, condition: &RobotCondition) -> ConditionLine {
        let runs: Vec<&Explored> = self.of(set, condition).filter_map(|index| self.pairs[index].1).collect();
        let sum = |of: fn(&Explored) -> usize| runs.iter().map(|run| of(run)).sum::<usize>();
        let fate = |fate: Fate| {
            let name = fate.name();
            runs.iter().flat_map(|run| &run.rooms).filter(|room| room.fate == name).count()
        };
        let ious = runs.iter().flat_map(|run| &run.rooms).map(|room| room.iou);
        let (rooms, found, found_rooms) = (sum(|run| run.rooms.len()), fate(Fate::Found), sum(|run| run.found_rooms));
        let (true_edges, right_edges) = (sum(|run| run.true_edges), sum(|run| run.right_edges));
        let wrong_edges = sum(|run| run.wrong_edges);
        ConditionLine {
            set: set.to_owned(),
            condition: *condition,
            runs: runs.len(),
            ended: runs.iter().filter(|run| run.ended).count(),
            rooms,
            found,
            split: fate(Fate::Split),
            merged: fate(Fate::Merged),
            missed: fate(Fate::Missed),
            found_rooms,
            room_recall: share(found, rooms),
            room_precision: share(found, found_rooms),
            iou: crate::base::numbers::mean(ious).unwrap_or_default(),
            true_edges,
            right_edges,
            wrong_edges,
            edge_recall: share(right_edges, true_edges),
            edge_precision: share(right_edges, right_edges + wrong_edges),
            driven_m: runs.iter().map(|run| run.driven_m).sum(),
            collisions: sum(|run| run.collisions),
            path_error_m: crate::base::numbers::mean(runs.iter().map(|run| run.path_error_m)).unwrap_or_default(),
        }
    }

    /// Labels right in one run by a method, or by the mean over the algorithms.
    fn right(&self, run: usize, view: usize, side: usize, method: Option<Method>) -> Option<f64> {
        let of = |at: usize| self.labels[run][at].right[view][side].map(|right| right as f64);
        match method {
            Some(method) => of(METHODS.iter().position(|other| *other == method)?),
            None => {
                let each = METHODS.iter().enumerate().filter(|(_, method)| **method != Method::Joint);
                let each: Option<Vec<f64>> = each.map(|(at, _)| of(at)).collect();
                crate::base::numbers::mean(each?)
            }
        }
    }

    fn labels(&self, set: &str, condition: &RobotCondition, method: Option<Method>) -> LabelLine {
        let runs: Vec<usize> = self.of(set, condition).collect();
        let accuracy = |view: usize, side: usize| {
            // Of the plans that could be labelled.
            let told = runs.iter().filter_map(|&run| Some((self.right(run, view, side, method)?, self.labels[run][0])));
            let (right, rooms) = told.fold((0.0, 0), |sum, (right, of)| (sum.0 + right, sum.1 + of.rooms));
            (rooms > 0).then(|| right / rooms as f64)
        };
        let reached = runs.iter().filter_map(|&run| Some((self.right(run, 2, 0, method)?, self.labels[run][0])));
        let (right, reachable) = reached.fold((0.0, 0), |sum, (right, of)| (sum.0 + right, sum.1 + of.reachable));
        LabelLine {
            set: set.to_owned(),
            condition: *condition,
            method: method.map_or("average", Method::name).to_owned(),
            rooms: runs.iter().map(|&run| self.labels[run][0].rooms).sum(),
            own: [0, 1, 2].map(|view| accuracy(view, 0)),
            standard: [0, 1, 2].map(|view| accuracy(view, 1)),
            found_and_right: (reachable > 0).then(|| right / reachable as f64),
        }
    }

    /// The differences that matter, under the usual noise.
    fn gaps(&self, set: &str) -> Vec<Gap> {
        let usual = RobotCondition::USUAL;
        let compare = |method: Option<Method>, first: (usize, usize), second: (usize, usize)| {
            // Comparison wants rooms; the rooms of a run share its mean, which is all that resampling buildings sees.
            let rooms = self.of(set, &usual).flat_map(|run| {
                let building = self.plans[self.pairs[run].0.plan].network.group.as_str();
                let rooms = self.labels[run][0].rooms;
                let one = self.right(run, first.0, first.1, method);
                let other = self.right(run, second.0, second.1, method);
                let of = one.zip(other).filter(|_| rooms > 0);
                let count = if of.is_some() { rooms } else { 0 };
                let (one, other) = of.unwrap_or_default();
                let each = move |_| (building, one / rooms as f64, other / rooms as f64);
                (0..count).map(each).collect::<Vec<_>>()
            });
            Comparison::of(rooms, self.seed)
        };
        let pairs = [
            ("typology classifiers, robot's plan", "standard classifiers, robot's plan", (2, 0), (2, 1)),
            ("robot's plan, no label given", "true plan, no label given", (2, 0), (1, 0)),
            ("robot's plan, no label given", "true plan, neighbours' labels given", (2, 0), (0, 0)),
        ];
        let mut gaps = Vec::new();
        for (first, second, one, other) in pairs {
            for method in [None, Some(Method::Joint)] {
                if let Some(comparison) = compare(method, one, other) {
                    gaps.push(Gap {
                        set: set.to_owned(),
                        first: first.to_owned(),
                        second: second.to_owned(),
                        method: method_title(method).to_owned(),
                        comparison,
                    });
                }
            }
        }
        gaps
    }

    fn runs(&self) -> Vec<RunLine> {
        let line = |(index, (run, explored)): (usize, &(Run, Option<&Explored>))| {
            let plan = &self.plans[run.plan];
            let count = |of: fn(&Explored) -> usize| explored.map(of).unwrap_or_default();
            let joint = METHODS.iter().position(|method| *method == Method::Joint).unwrap_or_default();
            RunLine {
                file: plan.network.file.clone(),
                plan: plan.network.plan.clone(),
                building: plan.network.building.clone(),
                typology: typology_of(plan),
                condition: run.condition,
                seed: run.seed,
                outcome: match explored {
                    None => "no plan",
                    Some(explored) if explored.ended => "ended",
                    Some(_) => "gave up",
                },
                rooms: count(|of| of.rooms.len()),
                found: count(|of| of.rooms.iter().filter(|room| room.is_found()).count()),
                found_rooms: count(|of| of.found_rooms),
                unreachable: count(|of| of.unreachable),
                true_edges: count(|of| of.true_edges),
                right_edges: count(|of| of.right_edges),
                wrong_edges: count(|of| of.wrong_edges),
                driven_m: explored.map(|of| of.driven_m).unwrap_or_default(),
                collisions: count(|of| of.collisions),
                path_error_m: explored.map(|of| of.path_error_m).unwrap_or_default(),
                labelled: self.labels[index][0].rooms,
                right: self.right(index, 2, 0, None),
                right_joint: self.labels[index][joint].right[2][0],
            }
        };
        self.pairs.iter().enumerate().map(line).collect()
    }
}

fn share(part: usize, of: usize) -> f64 {
    if of == 0 { 1.0 } else { part as f64 / of as f64 }
}

impl RobotStudy {
    /// The lines of a set along a factor: its level, the line, and the labels' line of the average of the algorithms.
    pub fn along(&self, set: &str, factor: Factor) -> Vec<(f64, &ConditionLine, Option<&LabelLine>)> {
        let mut lines: Vec<_> = self
            .conditions
            .iter()
            .filter(|line| line.set == set)
            .filter_map(|line| {
                Some((factor.level(&line.condition)?, line, self.label(set, &line.condition, "average")))
            })
            .collect();
        lines.sort_by(|p, q| p.0.total_cmp(&q.0));
        lines
    }

    /// The labels of a set under a condition by a method, by its name in files.
    pub fn label(&self, set: &str, condition: &RobotCondition, method: &str) -> Option<&LabelLine> {
        self.labels.iter().find(|line| line.set == set && line.condition == *condition && line.method == method)
    }

    /// What robots found of a set under a condition.
    pub fn condition(&self, set: &str, condition: &RobotCondition) -> Option<&ConditionLine> {
        self.conditions.iter().find(|line| line.set == set && line.condition == *condition)
    }
}
