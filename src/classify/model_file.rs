//! `*.model.json`: a trained classifier with what one must know to trust it. Described for outsiders
//! in `docs/classifiers.md`.
//!
//! The disk form has types of its own, apart from the live ones. One rule, node, room or hidden unit a
//! line. The checksum is of the content, not of the layout: a file may be indented anew, but a number
//! that was changed is noticed.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::joint::Joint;
use super::knn::{Neighbours, Settings};
use super::mlp::{HIDDEN, Perceptron, Weights};
use super::rules::{Bound, Condition, Rule, RuleList};
use super::scale::{Scale, Transform};
use super::tree::{Node, Split, Tree};
use super::{Classifier, Method, Metric, Model, PlanClassifier, Scores};
use crate::base::hash;
use crate::dataset::Row;
use crate::dataset::folds::{Grouping, building_of};
use crate::dataset::table::{FEATURES, RoomSource, Table, Values};
use crate::features::{Features, NeighbourLabels};
use crate::labels::{Label, Typology};

/// The newest version of the file that this program reads, and the one it writes.
pub const VERSION: u64 = 1;

/// The value of the member `format`, which tells the file from other JSON.
const FORMAT: &str = "enfilade model";

/// What one must know of a classifier to trust it.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// The typology of the buildings it learned from; `None` for a standard classifier, which learned
    /// from several.
    pub typology: Option<Typology>,
    /// Which labels of their neighbours the training rooms' features count.
    pub neighbours: NeighbourLabels,
    /// The command that trained it.
    pub command: String,
    /// The version of the program that trained it.
    pub program: String,
    pub seed: u64,
    /// Under which terms the model may be used, and whose data it holds.
    pub licence: String,
    pub data: DataSummary,
    /// What cross-validation on the same rooms gave.
    pub scores: Vec<ScoreSummary>,
}

/// The rooms a classifier learned from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DataSummary {
    pub rooms: usize,
    pub plans: usize,
    pub buildings: usize,
    /// Rooms of each label, by the paper's letter.
    pub labels: BTreeMap<String, usize>,
    /// [`Table::fingerprint`] in hexadecimal digits.
    pub fingerprint: String,
}

/// The scores of one cross-validation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScoreSummary {
    /// What was dealt to folds: `room` or `building`.
    pub folds_by: String,
    pub seed: u64,
    /// Share of rooms with the right label, 0..=1, and the deviation over the folds.
    pub accuracy: f64,
    pub accuracy_deviation: f64,
    pub log_loss: f64,
    pub brier: f64,
    pub calibration_error: f64,
    /// The accuracy of each fold.
    pub folds: Vec<f64>,
}

impl DataSummary {
    /// The summary of rows and their table.
    pub fn of(rows: &[Row], table: &Table) -> Self {
        let plans: BTreeSet<(&str, &str)> = rows.iter().map(|row| (building_of(row), row.plan.as_str())).collect();
        let buildings: BTreeSet<&str> = rows.iter().map(building_of).collect();
        let counts = table.label_counts();
        Self {
            rooms: table.len(),
            plans: plans.len(),
            buildings: buildings.len(),
            labels: Label::ALL.iter().map(|label| (label.letter().to_owned(), counts[label.index()])).collect(),
            fingerprint: format!("{:016x}", table.fingerprint()),
        }
    }
}

impl ScoreSummary {
    /// What a model file keeps of scores, to five decimals.
    pub fn of(scores: &Scores, grouping: Grouping, seed: u64) -> Self {
        let rounded = |number: f64| (number * 1e5).round() / 1e5;
        Self {
            folds_by: grouping.name().to_owned(),
            seed,
            accuracy: rounded(scores.accuracy),
            accuracy_deviation: rounded(scores.accuracy_deviation),
            log_loss: rounded(scores.log_loss),
            brier: rounded(scores.brier),
            calibration_error: rounded(scores.calibration_error),
            folds: scores.folds.iter().map(|fold| rounded(fold.accuracy())).collect(),
        }
    }
}

/// Why a file is no model that can be used, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelFileError {
    /// The line, from 1, where it can be told.
    pub line: Option<usize>,
    pub what: String,
    pub hint: String,
}

impl fmt::Display for ModelFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        write!(f, "{}; {}", self.what, self.hint)
    }
}

impl std::error::Error for ModelFileError {}

fn refuse(line: Option<usize>, what: impl Into<String>) -> ModelFileError {
    ModelFileError { line, what: what.into(), hint: "restore it from a copy, or train it again".to_owned() }
}

/// The complete bytes of a model's file.
pub fn to_bytes(classifier: &PlanClassifier, about: &About) -> Vec<u8> {
    let (temperature, model) = match classifier {
        PlanClassifier::Each(classifier) => {
            (classifier.temperature(), serde_json::to_value(DiskModel::of(classifier.model())).unwrap_or_default())
        }
        // It keeps its temperature itself.
        PlanClassifier::Joint(joint) => (1.0, joint.to_value()),
    };
    let disk = Disk {
        format: FORMAT.to_owned(),
        version: VERSION,
        algorithm: classifier.method().name().to_owned(),
        about: DiskAbout::of(about),
        temperature,
        model,
    };
    // Serialising plain structs of numbers and texts cannot fail; if it did, the file would not read.
    let value = serde_json::to_value(disk).unwrap_or_default();
    let checksum = checksum(&value);
    let mut file = String::from("{");
    for (key, member) in value.as_object().into_iter().flatten() {
        file.push_str(if file.len() == 1 { "\n" } else { ",\n" });
        file.push_str(&format!("{}: ", Value::from(key.as_str())));
        push_member(&mut file, key, member);
    }
    file.push_str(&format!(",\n\"checksum\": \"{checksum}\"\n}}\n"));
    file.into_bytes()
}

/// Members whose elements stand one a line.
const LISTS: [&str; 6] = ["rules", "nodes", "rooms", "units", "first", "second"];

fn push_member(file: &mut String, key: &str, member: &Value) {
    let (open, elements, close) = match member {
        Value::Array(elements) if LISTS.contains(&key) => {
            ("[", elements.iter().map(Value::to_string).collect::<Vec<_>>(), "]")
        }
        Value::Object(members) if matches!(key, "about" | "model") => {
            let element = |(key, member): (&String, &Value)| {
                let mut element = format!("{}: ", Value::from(key.as_str()));
                push_member(&mut element, key, member);
                element
            };
            ("{", members.iter().map(element).collect(), "}")
        }
        _ => return file.push_str(&member.to_string()),
    };
    if elements.is_empty() {
        return file.push_str(&format!("{open}{close}"));
    }
    file.push_str(&format!("{open}\n{}\n{close}", elements.join(",\n")));
}

/// FNV-1a of the content without spaces, in hexadecimal digits.
fn checksum(value: &Value) -> String {
    format!("{:016x}", hash::fnv1a(hash::START, value.to_string().into_bytes()))
}

/// Reads a model.
///
/// # Errors
/// When the bytes are not a model file of a known version, were changed or cut, or do not make a
/// classifier; with the line where it can be told.
pub fn from_bytes(bytes: &[u8]) -> Result<(PlanClassifier, About), ModelFileError> {
    let body = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if body.iter().all(u8::is_ascii_whitespace) {
        return Err(refuse(None, "is empty"));
    }
    let json_error = |error: serde_json::Error| {
        let text = error.to_string();
        let place = format!(" at line {} column {}", error.line(), error.column());
        let what = match error.classify() {
            serde_json::error::Category::Eof => "ends too early: it was cut short".to_owned(),
            _ => format!("is not JSON: {}", text.strip_suffix(&place).unwrap_or(&text)),
        };
        refuse(Some(error.line()).filter(|&line| line > 0), what)
    };
    let mut value: Value = serde_json::from_slice(body).map_err(json_error)?;
    if value.get("format").and_then(Value::as_str) != Some(FORMAT) {
        return Err(ModelFileError {
            line: None,
            what: format!("is JSON, but not a model: it lacks \"format\": \"{FORMAT}\""),
            hint: "give a file that ends in .model.json".to_owned(),
        });
    }
    match value.get("version").and_then(Value::as_u64) {
        Some(1..=VERSION) => {}
        Some(newer) if newer > VERSION => {
            return Err(ModelFileError {
                line: None,
                what: format!("was made by a newer Enfilade (file version {newer}; this one reads up to {VERSION})"),
                hint: "update Enfilade".to_owned(),
            });
        }
        _ => return Err(refuse(None, "states no file version that exists")),
    }
    let stated = value.as_object_mut().and_then(|members| members.shift_remove("checksum"));
    if stated.as_ref().and_then(Value::as_str) != Some(checksum(&value).as_str()) {
        return Err(refuse(None, "was changed after it was made: its content does not fit its checksum"));
    }
    let disk: Option<Disk> = serde_json::from_value(value).ok();
    disk.and_then(Disk::live).ok_or_else(|| refuse(None, "its parts do not make a classifier"))
}

#[derive(Serialize, Deserialize)]
struct Disk {
    format: String,
    version: u64,
    algorithm: String,
    about: DiskAbout,
    temperature: f64,
    /// A [`DiskModel`], or what [`Joint::to_value`] gives.
    model: Value,
}

#[derive(Serialize, Deserialize)]
struct DiskAbout {
    typology: Option<String>,
    neighbours: String,
    command: String,
    program: String,
    seed: u64,
    licence: String,
    data: DataSummary,
    scores: Vec<ScoreSummary>,
}

/// Its members tell which kind it is.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum DiskModel {
    Rules { rules: Vec<DiskRule> },
    Tree { nodes: Vec<DiskNode> },
    Knn { k: usize, metric: String, by_distance: bool, transform: String, plans: Vec<String>, rooms: Vec<DiskRoom> },
    Mlp { scale: DiskScale, typical: Values, units: Vec<DiskUnit>, output_bias: [f64; 5] },
}

#[derive(Serialize, Deserialize)]
struct DiskRule {
    r#if: Vec<DiskCondition>,
    /// For the reader; what counts is `rooms`.
    then: String,
    /// Training rooms of each label.
    rooms: [u32; 5],
}

#[derive(Serialize, Deserialize)]
struct DiskCondition {
    feature: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_most: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_least: Option<f64>,
}

#[derive(Serialize, Deserialize)]
struct DiskNode {
    #[serde(skip_serializing_if = "Option::is_none")]
    feature: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at_most: Option<f64>,
    /// Indices of the nodes for yes and no.
    #[serde(skip_serializing_if = "Option::is_none")]
    then: Option<[usize; 2]>,
    rooms: [u32; 5],
}

/// The values, the label, the index of the plan, and the room's name.
type DiskRoom = (Values, String, usize, String);

#[derive(Serialize, Deserialize)]
struct DiskScale {
    transform: String,
    means: Values,
    deviations: Values,
}

/// A hidden unit: its weights from each input, its bias, its weights to each label.
#[derive(Serialize, Deserialize)]
struct DiskUnit {
    from: [f64; FEATURES],
    bias: f64,
    to: [f64; 5],
}

/// The number that reads as this one and is written with the fewest digits.
fn short(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

impl Disk {
    fn live(self) -> Option<(PlanClassifier, About)> {
        let classifier = match self.algorithm.parse::<Method>().ok()? {
            Method::Joint => Joint::from_value(&self.model).ok()?.into(),
            Method::Each(algorithm) => {
                let model: DiskModel = serde_json::from_value(self.model).ok()?;
                let classifier = Classifier::from_parts(model.live()?, self.temperature);
                (classifier.algorithm() == algorithm).then_some(())?;
                classifier.into()
            }
        };
        Some((classifier, self.about.live()?))
    }
}

impl DiskAbout {
    fn of(about: &About) -> Self {
        let About { typology, neighbours, command, program, seed, licence, data, scores } = about.clone();
        Self {
            typology: typology.map(|typology| typology.as_str().to_owned()),
            neighbours: neighbours.name().to_owned(),
            command,
            program,
            seed,
            licence,
            data,
            scores,
        }
    }

    fn live(self) -> Option<About> {
        let Self { typology, neighbours, command, program, seed, licence, data, scores } = self;
        let typology = match typology {
            Some(name) => Some(Typology::new(&name)?),
            None => None,
        };
        let neighbours = NeighbourLabels::ALL.into_iter().find(|mode| mode.name() == neighbours)?;
        Some(About { typology, neighbours, command, program, seed, licence, data, scores })
    }
}

fn feature_index(name: &str) -> Option<usize> {
    Features::NAMES.iter().position(|feature| *feature == name)
}

impl DiskCondition {
    fn of(condition: &Condition) -> Self {
        let feature = Features::NAMES[condition.feature].to_owned();
        match condition.bound {
            Bound::AtMost(bound) => Self { feature, at_most: Some(bound), at_least: None },
            // Rules are not written with 'over'; the next number up says the same.
            Bound::Over(bound) => Self { feature, at_most: None, at_least: Some(bound.next_up()) },
            Bound::AtLeast(bound) => Self { feature, at_most: None, at_least: Some(bound) },
        }
    }

    fn live(&self) -> Option<Condition> {
        let bound = match (self.at_most, self.at_least) {
            (Some(bound), None) => Bound::AtMost(bound),
            (None, Some(bound)) => Bound::AtLeast(bound),
            _ => return None,
        };
        Some(Condition { feature: feature_index(&self.feature)?, bound })
    }
}

impl DiskModel {
    fn of(model: &Model) -> Self {
        match model {
            Model::Rules(list) => {
                let rule = |rule: &Rule| DiskRule {
                    r#if: rule.conditions.iter().map(DiskCondition::of).collect(),
                    then: rule.label().letter().to_owned(),
                    rooms: rule.counts,
                };
                Self::Rules { rules: list.rules().iter().map(rule).collect() }
            }
            Model::Tree(tree) => {
                let node = |node: &Node| DiskNode {
                    feature: node.split.map(|split| Features::NAMES[split.feature].to_owned()),
                    at_most: node.split.map(|split| split.at_most),
                    then: node.split.map(|split| [split.yes, split.no]),
                    rooms: node.counts,
                };
                Self::Tree { nodes: tree.nodes().iter().map(node).collect() }
            }
            Model::Knn(neighbours) => {
                let Settings { transform, metric, k, by_distance } = neighbours.settings();
                let table = neighbours.table();
                let mut index_of: BTreeMap<&Arc<str>, usize> = BTreeMap::new();
                let mut plans = Vec::new();
                let rooms = table.values().iter().zip(table.labels()).zip(table.sources());
                let rooms = rooms.map(|((values, label), source)| {
                    let plan = *index_of.entry(&source.plan).or_insert_with(|| {
                        plans.push(source.plan.to_string());
                        plans.len() - 1
                    });
                    (*values, label.letter().to_owned(), plan, source.room.to_string())
                });
                let rooms = rooms.collect();
                let (metric, transform) = (metric.name().to_owned(), transform.name().to_owned());
                Self::Knn { k, metric, by_distance, transform, plans, rooms }
            }
            Model::Mlp(net) => {
                let Scale { transform, means, deviations } = net.scale().clone();
                let weights = net.weights();
                let unit = |unit: usize| DiskUnit {
                    from: std::array::from_fn(|input| short(weights.hidden[input][unit])),
                    bias: short(weights.hidden[FEATURES][unit]),
                    to: std::array::from_fn(|label| short(weights.output[label][unit])),
                };
                Self::Mlp {
                    scale: DiskScale { transform: transform.name().to_owned(), means, deviations },
                    typical: *net.typical(),
                    units: (0..HIDDEN).map(unit).collect(),
                    output_bias: weights.output_bias.map(short),
                }
            }
        }
    }

    fn live(self) -> Option<Model> {
        match self {
            Self::Rules { rules } => {
                let rule = |rule: DiskRule| {
                    let conditions: Option<Vec<Condition>> = rule.r#if.iter().map(DiskCondition::live).collect();
                    Some(Rule { conditions: conditions?, counts: rule.rooms })
                };
                Some(Model::Rules(RuleList::from_rules(rules.into_iter().map(rule).collect::<Option<_>>()?)?))
            }
            Self::Tree { nodes } => {
                let node = |node: DiskNode| {
                    let split = match (node.feature, node.at_most, node.then) {
                        (None, None, None) => None,
                        (Some(feature), Some(at_most), Some([yes, no])) => {
                            Some(Split { feature: feature_index(&feature)?, at_most, yes, no })
                        }
                        _ => return None,
                    };
                    Some(Node { counts: node.rooms, split })
                };
                Some(Model::Tree(Tree::from_nodes(nodes.into_iter().map(node).collect::<Option<_>>()?)?))
            }
            Self::Knn { k, metric, by_distance, transform, plans, rooms } => {
                let plans: Vec<Arc<str>> = plans.into_iter().map(Arc::from).collect();
                let (mut values, mut labels, mut sources) = (Vec::new(), Vec::new(), Vec::new());
                for (room_values, label, plan, room) in rooms {
                    values.push(room_values);
                    labels.push(label.parse().ok()?);
                    sources.push(RoomSource { plan: plans.get(plan)?.clone(), room: room.into() });
                }
                let settings = Settings {
                    transform: Transform::from_name(&transform)?,
                    metric: Metric::from_name(&metric)?,
                    k,
                    by_distance,
                };
                Some(Model::Knn(Neighbours::new(Table::from_columns(values, labels, sources).ok()?, settings)))
            }
            Self::Mlp { scale, typical, units, output_bias } => {
                let units: [DiskUnit; HIDDEN] = units.try_into().ok()?;
                let hidden = std::array::from_fn(|input| {
                    std::array::from_fn(|unit: usize| {
                        let DiskUnit { from, bias, .. } = &units[unit];
                        from.get(input).copied().unwrap_or(*bias) as f32
                    })
                });
                let output =
                    std::array::from_fn(|label| std::array::from_fn(|unit: usize| units[unit].to[label] as f32));
                let weights = Weights { hidden, output, output_bias: output_bias.map(|bias| bias as f32) };
                let scale = Scale {
                    transform: Transform::from_name(&scale.transform)?,
                    means: scale.means,
                    deviations: scale.deviations,
                };
                Some(Model::Mlp(Perceptron::from_parts(scale, weights, typical)?))
            }
        }
    }
}
