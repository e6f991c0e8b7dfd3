//! The study: everything reported in the paper's section 4.2, measured on a collection of labelled rooms,
//! and what the paper leaves open (buildings never seen, neighbours whose labels are unknown). Numbers
//! only; [`report`] writes them as a page and as tables.

mod compare;
mod comparison;
mod measure;
pub mod noise;
pub mod paper;
pub mod predictions;
pub mod report;
pub mod robot;
mod run;
pub mod suspects;
mod typologies;

use std::fmt;

use serde::{Serialize, Serializer};

pub use comparison::Comparison;
pub use run::{
    FoldTold, Validation, learning_curve, learning_curve_telling, study, study_with_predictions, validate,
    validate_telling,
};

use crate::base::work::Cancelled;
use crate::classify::{Algorithm, Confusion, Method, Scores, TableRates};
use crate::dataset::LabelStatistics;
use crate::dataset::folds::Grouping;
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// The options of a study.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Folds of each cross-validation, at least 2. The paper: 10.
    pub folds: usize,
    /// The unit assigned to folds in the main condition, which all tables use. The paper: rooms.
    pub grouping: Grouping,
    /// Neighbours' labels in the main condition. The paper: true.
    pub neighbours: NeighbourLabels,
    pub seed: u64,
    /// Whether the folds of the main condition's grouping are those that the rows carry ([`crate::dataset::Row::fold`]).
    pub given: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { folds: 10, grouping: Grouping::Room, neighbours: NeighbourLabels::True, seed: 1, given: false }
    }
}

/// A condition under which classifiers are tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Condition {
    #[serde(serialize_with = "grouping_name")]
    pub by: Grouping,
    #[serde(serialize_with = "neighbours_name")]
    pub neighbours: NeighbourLabels,
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "folds by {}, {} neighbour labels", self.by.name(), self.neighbours.name())
    }
}

/// What a new building is met under: it was not learned from, and no label of it is known.
pub const HONEST: Condition = Condition { by: Grouping::Building, neighbours: NeighbourLabels::Predicted };

/// What a study found. All shares 0..=1.
#[derive(Clone, Debug, Serialize)]
pub struct Study {
    pub program: String,
    /// What it was made from, and how; empty where nobody said.
    pub about: About,
    pub seed: u64,
    pub folds: usize,
    /// The condition of all tables but [`Study::accuracy`], which has every condition, and those that say otherwise.
    pub condition: Condition,
    /// The condition under which a new building is met, see [`HONEST`]; `None` where it could not be measured.
    pub honest: Option<Condition>,
    /// Data sets: one of each typology, and the standard set of all where there are several.
    pub sets: Vec<Set>,
    /// Fig. 4 and beyond: each set, algorithm and condition.
    pub accuracy: Vec<Cell>,
    /// Fig. 4's averages over the algorithms.
    pub averages: Vec<Average>,
    /// Table 1.
    pub confusion: Vec<ConfusionTable>,
    /// Table 2.
    pub rooms: Vec<RoomsTable>,
    /// Typology classifiers against standard ones on the same rooms.
    pub own_against_standard: Vec<Rival>,
    /// The same under [`Study::honest`], where that is another condition.
    pub own_against_standard_honest: Vec<Rival>,
    /// Typology classifiers against those of other typologies.
    pub own_against_foreign: Vec<Rival>,
    pub learning_curves: Vec<Curve>,
    pub importance: Vec<Importance>,
    /// The joint classifier, then the blend, on buildings never seen.
    pub joint: Vec<JointCell>,
    /// The joint classifier after learning from a part of the buildings.
    pub joint_curves: Vec<JointCurve>,
    /// How far the labels agree with each other, and what the blend makes of them.
    pub noise: Vec<noise::Noise>,
    /// What lies behind openings into unexplored space, on buildings never seen.
    pub unknown: Vec<UnknownCell>,
    /// How well typologies are inferred from plans of buildings never seen, as the program does it.
    pub typologies: Vec<TypologyLine>,
    /// The same by several ways, beside each other.
    pub typology_ways: Vec<TypologyWay>,
    /// What could not be measured, and why.
    pub notes: Vec<String>,
}

/// What a study was made from, and how.
#[derive(Clone, Debug, Default, Serialize)]
pub struct About {
    /// The call that made it.
    pub command: String,
    /// What was named on the command line, as it was named.
    pub data: Vec<String>,
    /// Files that were read.
    pub files: usize,
    /// SHA-256 over the files' hashes, in order.
    pub sha256: String,
    /// When, as somebody said; the program looks at no clock, so that the same input gives the same bytes.
    pub date: Option<String>,
}

/// A data set.
#[derive(Clone, Debug, Serialize)]
pub struct Set {
    /// A typology, or `STANDARD`.
    pub name: String,
    pub rooms: usize,
    pub plans: usize,
    pub buildings: usize,
    /// Share of the most frequent label: the accuracy reached without looking at a room.
    pub most_frequent: f64,
    /// [`crate::dataset::table::Table::fingerprint`] of its rows with true neighbour labels, in
    /// hexadecimal digits.
    pub fingerprint: String,
}

/// The scores of one algorithm on one set under one condition.
#[derive(Clone, Debug, Serialize)]
pub struct Cell {
    pub set: String,
    #[serde(serialize_with = "algorithm_name")]
    pub algorithm: Algorithm,
    #[serde(flatten)]
    pub condition: Condition,
    /// Number of folds: fewer than requested if there are not enough buildings.
    pub fold_count: usize,
    #[serde(flatten)]
    pub scores: Scores,
}

/// Accuracy on a set averaged over the algorithms.
#[derive(Clone, Debug, Serialize)]
pub struct Average {
    pub set: String,
    pub mean: f64,
    /// Mean of the algorithms' standard deviations over the folds.
    pub deviation: f64,
}

/// One matrix of Table 1.
#[derive(Clone, Debug, Serialize)]
pub struct ConfusionTable {
    pub set: String,
    /// Numbers of rooms, summed over the algorithms.
    pub rooms: Confusion,
    /// Rows of shares, averaged over the algorithms: true label down, predicted across, in the order
    /// of [`Label::ALL`].
    pub shares: [[f64; 5]; 5],
    /// The rates in the paper's terms, averaged over the algorithms.
    pub rates: [TableRates; 5],
}

/// Table 2 of one set.
#[derive(Clone, Debug, Serialize)]
pub struct RoomsTable {
    pub set: String,
    pub labels: Vec<LabelLine>,
}

/// One line of Table 2.
#[derive(Clone, Debug, Serialize)]
pub struct LabelLine {
    pub label: String,
    pub rooms: usize,
    pub share: f64,
    pub area_mean_m2: f64,
    pub area_deviation_m2: f64,
    pub doors_mean: f64,
    pub doors_deviation: f64,
    pub axes_ratio_mean: f64,
}

impl LabelLine {
    fn of(line: &LabelStatistics) -> Self {
        Self {
            label: line.label.letter().to_owned(),
            rooms: line.rooms,
            share: line.share,
            area_mean_m2: line.area_m2.mean,
            area_deviation_m2: line.area_m2.deviation,
            doors_mean: line.doors.mean,
            doors_deviation: line.doors.deviation,
            axes_ratio_mean: line.axes_ratio.mean,
        }
    }
}

/// The classifiers of a typology against others on that typology's rooms.
#[derive(Clone, Debug, Serialize)]
pub struct Rival {
    /// The typology whose rooms are classified.
    pub rooms_of: String,
    /// The set the other classifier learned from.
    pub rival: String,
    /// `None`: averaged over the algorithms.
    #[serde(serialize_with = "algorithm_or_average")]
    pub algorithm: Option<Algorithm>,
    /// Deviation of the rival's accuracy over the folds of the rooms.
    pub rival_deviation: f64,
    /// First the typology's own classifier, cross-validated; second the rival.
    pub comparison: Comparison,
}

/// A learning curve.
#[derive(Clone, Debug, Serialize)]
pub struct Curve {
    pub set: String,
    #[serde(serialize_with = "algorithm_name")]
    pub algorithm: Algorithm,
    pub points: Vec<CurvePoint>,
}

/// A learning curve of the joint classifier on buildings never seen.
#[derive(Clone, Debug, Serialize)]
pub struct JointCurve {
    pub set: String,
    /// In order of the training rooms; the last one learned from all buildings but those tested.
    pub points: Vec<CurvePoint>,
}

/// Accuracy when trained on a part of the rooms.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CurvePoint {
    /// Training rooms, mean over the folds.
    pub training_rooms: f64,
    pub accuracy: f64,
    pub deviation: f64,
}

/// The importance of each feature to a classifier: the accuracy lost when its values are shuffled among
/// the tested rooms (Breiman 2001).
#[derive(Clone, Debug, Serialize)]
pub struct Importance {
    pub set: String,
    #[serde(serialize_with = "algorithm_name")]
    pub algorithm: Algorithm,
    /// In the order of [`crate::features::Features::NAMES`].
    pub accuracy_lost: [f64; 8],
}

/// A classifier of whole plans (the joint one, or the blend) on a set, with folds by building and no known labels in the
/// tested buildings.
#[derive(Clone, Debug, Serialize)]
pub struct JointCell {
    pub set: String,
    #[serde(serialize_with = "method_name")]
    pub method: Method,
    /// The best of the learners under the same condition.
    #[serde(serialize_with = "algorithm_name")]
    pub best: Algorithm,
    /// First this classifier, second the best of the learners.
    pub comparison: Comparison,
    pub scores: Scores,
}

/// What lies behind an opening, predicted from the room on this side: each opening between two labelled
/// rooms in turn is treated as leading into unexplored space; folds by building.
#[derive(Clone, Debug, Serialize)]
pub struct UnknownCell {
    pub set: String,
    /// Per opening, from both sides: first the prediction, second the most frequent label.
    pub comparison: Comparison,
}

/// How often plans of one typology were inferred to be of each.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TypologyLine {
    pub typology: String,
    /// Plans taken for each typology.
    pub plans: Vec<TypologyCount>,
    /// Share of plans, and of buildings (each the mean over its plans), inferred correctly.
    pub plan_accuracy: f64,
    pub building_accuracy: f64,
    pub buildings: usize,
}

/// A way of inferring typologies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TypologyWay {
    /// What it does, in words.
    pub way: String,
    /// Share of plans, and of buildings (each the mean over its plans), taken for what they are: means over the typologies, which
    /// count alike however many plans they have.
    pub plan_accuracy: f64,
    pub building_accuracy: f64,
    /// The same share of plans by typology, in the order of [`Study::typologies`].
    pub plans_of: Vec<f64>,
}

/// Plans taken for a typology.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TypologyCount {
    pub taken_for: String,
    pub plans: usize,
}

/// Why a study is not possible.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StudyError {
    Cancelled,
    /// What is wrong with the data or the options, and what to do about it.
    Data(String),
}

impl fmt::Display for StudyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => Cancelled.fmt(f),
            Self::Data(what) => f.write_str(what),
        }
    }
}

impl std::error::Error for StudyError {}

impl From<Cancelled> for StudyError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

impl Study {
    /// The scores of an algorithm on a set under a condition.
    pub fn scores(&self, set: &str, algorithm: Algorithm, condition: Condition) -> Option<&Scores> {
        let wanted = |cell: &&Cell| cell.set == set && cell.algorithm == algorithm && cell.condition == condition;
        self.accuracy.iter().find(wanted).map(|cell| &cell.scores)
    }

    /// The methods that look at whole plans and were measured, in order.
    pub fn plan_methods(&self) -> Vec<Method> {
        let measured = |method: &Method| self.joint.iter().any(|cell| cell.method == *method);
        [Method::Joint, Method::Blend].into_iter().filter(measured).collect()
    }

    /// The scores of such a method on a set.
    pub fn plan_scores(&self, set: &str, method: Method) -> Option<&Scores> {
        self.joint.iter().find(|cell| cell.set == set && cell.method == method).map(|cell| &cell.scores)
    }

    /// The conditions that were measured, in order.
    pub fn conditions(&self) -> Vec<Condition> {
        let mut conditions: Vec<Condition> = Vec::new();
        for cell in &self.accuracy {
            if !conditions.contains(&cell.condition) {
                conditions.push(cell.condition);
            }
        }
        conditions
    }
}

/// A set's name for people: 'House', 'Standard'.
pub fn set_title(name: &str) -> String {
    Typology::new(name).map(|name| name.title()).unwrap_or_default()
}

/// The letters of the labels in order.
pub(crate) fn letters() -> [&'static str; 5] {
    Label::ALL.map(Label::letter)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn grouping_name<S: Serializer>(grouping: &Grouping, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(grouping.name())
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn neighbours_name<S: Serializer>(neighbours: &NeighbourLabels, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(neighbours.name())
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn algorithm_name<S: Serializer>(algorithm: &Algorithm, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(algorithm.name())
}

fn method_name<S: Serializer>(method: &Method, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(method.name())
}

#[expect(clippy::ref_option, reason = "serde calls it so")]
fn algorithm_or_average<S: Serializer>(algorithm: &Option<Algorithm>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(algorithm.map_or("average", Algorithm::name))
}
