//! `*.model.json`: a trained classifier with the information needed to judge it. Described for outsiders
//! in `docs/classifiers.md`.
//!
//! The disk form has types of its own, separate from the live ones; that of each learner's model is in
//! the learner's file. One rule, node, room or hidden unit per line. The checksum covers the content, not
//! the layout: a file may be reformatted, but a changed number is noticed.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::blend::{Blend, Member};
use super::joint::Joint;
use super::learned::{DiskLearned, Learned};
use super::{Classifier, Method, PlanClassifier, Scores};
use crate::base::hash;
use crate::dataset::Row;
use crate::dataset::folds::{Grouping, building_of};
use crate::dataset::table::Table;
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// The newest file version this program reads, and the one it writes.
pub const VERSION: u64 = 1;

/// The value of the member `format`, which distinguishes the file from other JSON.
const FORMAT: &str = "enfilade model";

/// The information needed to judge a classifier.
#[derive(Clone, Debug, PartialEq)]
pub struct About {
    /// The typology of the buildings it learned from; `None` for a standard classifier, which learned
    /// from several.
    pub typology: Option<Typology>,
    /// Which labels of neighbours the training rooms' features count.
    pub neighbours: NeighbourLabels,
    /// The command that trained it.
    pub command: String,
    /// The version of the program that trained it.
    pub program: String,
    pub seed: u64,
    /// The terms under which the model may be used, and whose data it contains.
    pub licence: String,
    pub data: DataSummary,
    /// The results of cross-validation on the same rooms.
    pub scores: Vec<ScoreSummary>,
    /// What tells the rooms again; `None` in files of earlier versions, and where only their features were known.
    pub learned: Option<Learned>,
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
    /// The unit assigned to folds: `room` or `building`.
    pub folds_by: String,
    pub seed: u64,
    /// Share of rooms with the right label, 0..=1, and its standard deviation over the folds.
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
        // Names repeat: a plan is known by its file, and within one file by its name and storey.
        let plan = |row: &Row| [&row.file, building_of(row), &row.plan, &row.storey].map(str::to_owned);
        let plans: BTreeSet<[String; 4]> = rows.iter().map(plan).collect();
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
    /// The part of the scores that a model file keeps, to five decimals.
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

/// Why a file is not a usable model, and what to do about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelFileError {
    /// The line, from 1, if known.
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
        PlanClassifier::Each(classifier) => (classifier.temperature(), classifier.model().to_json()),
        // The joint classifier keeps its temperature itself.
        PlanClassifier::Joint(joint) => (1.0, joint.to_value()),
        PlanClassifier::Blend(blend) => (blend.temperature(), blend.to_value()),
    };
    let disk = Disk {
        format: FORMAT.to_owned(),
        version: VERSION,
        algorithm: classifier.method().name().to_owned(),
        about: DiskAbout::of(about),
        temperature,
        model,
    };
    // Serialising plain structs of numbers and texts cannot fail; if it did, the file would be
    // unreadable.
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

/// Writes the members of `about` and of the model one per line, and likewise the elements of a model's
/// lists of objects or lists: rules, nodes, rooms, units.
fn push_member(file: &mut String, key: &str, member: &Value) {
    match (key, member) {
        ("about", Value::Object(members)) => push_members(file, members, Value::to_string),
        ("model", Value::Object(members)) => push_members(file, members, |member| match member {
            Value::Array(elements) if elements.iter().any(|element| element.is_array() || element.is_object()) => {
                lines("[", elements.iter().map(Value::to_string), "]")
            }
            plain => plain.to_string(),
        }),
        _ => file.push_str(&member.to_string()),
    }
}

fn push_members(file: &mut String, members: &Map<String, Value>, write: fn(&Value) -> String) {
    let member = |(key, member): (&String, &Value)| format!("{}: {}", Value::from(key.as_str()), write(member));
    file.push_str(&lines("{", members.iter().map(member), "}"));
}

fn lines(open: &str, elements: impl Iterator<Item = String>, close: &str) -> String {
    let elements: Vec<String> = elements.collect();
    if elements.is_empty() { format!("{open}{close}") } else { format!("{open}\n{}\n{close}", elements.join(",\n")) }
}

/// FNV-1a of the content without whitespace, in hexadecimal digits.
fn checksum(value: &Value) -> String {
    format!("{:016x}", hash::fnv1a(hash::START, value.to_string().into_bytes()))
}

/// Where the parts of a blend are found, by name.
pub type Parts<'a> = &'a dyn Fn(&str) -> Option<Arc<dyn Member>>;

/// Reads a model: the classifier, what to know of it, and its checksum. `parts` finds the models that a blend is made of.
///
/// # Errors
/// When the bytes are not a model file of a known version, were changed or truncated, or are not a valid
/// classifier; with the line if known.
pub fn from_bytes(bytes: &[u8], parts: Parts<'_>) -> Result<(PlanClassifier, About, String), ModelFileError> {
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
    let checksum = checksum(&value);
    if stated.as_ref().and_then(Value::as_str) != Some(checksum.as_str()) {
        return Err(refuse(None, "was changed after it was made: its content does not fit its checksum"));
    }
    let disk: Option<Disk> = serde_json::from_value(value).ok();
    let (classifier, about) = disk
        .map_or_else(|| Err("its parts do not make a classifier".to_owned()), |disk| disk.live(parts))
        .map_err(|what| refuse(None, what))?;
    Ok((classifier, about, checksum))
}

#[derive(Serialize, Deserialize)]
struct Disk {
    format: String,
    version: u64,
    algorithm: String,
    about: DiskAbout,
    temperature: f64,
    /// The output of [`Model::to_json`] or [`Joint::to_value`].
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
    #[serde(default, skip_serializing_if = "Option::is_none")]
    learned: Option<DiskLearned>,
}

impl Disk {
    fn live(self, parts: Parts<'_>) -> Result<(PlanClassifier, About), String> {
        let refused = || "its parts do not make a classifier".to_owned();
        let classifier = match self.algorithm.parse::<Method>().map_err(|_| refused())? {
            Method::Blend => Blend::from_value(&self.model, self.temperature, parts)?.into(),
            Method::Joint => Joint::from_value(&self.model).map_err(|_| refused())?.into(),
            Method::Each(algorithm) => {
                let model = algorithm.learner().from_json(self.model).ok_or_else(refused)?;
                Classifier::from_parts(algorithm, model, self.temperature).into()
            }
        };
        Ok((classifier, self.about.live().ok_or_else(refused)?))
    }
}

impl DiskAbout {
    fn of(about: &About) -> Self {
        let About { typology, neighbours, command, program, seed, licence, data, scores, learned } = about.clone();
        Self {
            typology: typology.map(|typology| typology.as_str().to_owned()),
            neighbours: neighbours.name().to_owned(),
            command,
            program,
            seed,
            licence,
            data,
            scores,
            learned: learned.as_ref().map(DiskLearned::of),
        }
    }

    fn live(self) -> Option<About> {
        let Self { typology, neighbours, command, program, seed, licence, data, scores, learned } = self;
        let typology = match typology {
            Some(name) => Some(Typology::new(&name)?),
            None => None,
        };
        let neighbours = NeighbourLabels::ALL.into_iter().find(|mode| mode.name() == neighbours)?;
        let learned = match learned {
            Some(learned) => Some(learned.live()?),
            None => None,
        };
        Some(About { typology, neighbours, command, program, seed, licence, data, scores, learned })
    }
}
