//! Training models on labelled rooms: cross-validation, the models, and the blend of them. The one way for the command
//! line and the window; files and progress lines are theirs.

mod made;
mod validating;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use self::validating::Validated;
use crate::base::work::{Cancelled, Work};
use crate::classify::model_file::{self, About, DataSummary, ScoreSummary};
use crate::classify::models::StoredModel;
use crate::classify::{Algorithm, Classifier, Method, PlanClassifier, Scores, committee, in_plan, joint::Joint};
use crate::dataset::folds::Grouping;
use crate::dataset::sets::{STANDARD, plans_of, set_name};
use crate::dataset::table::Table;
use crate::dataset::{Collection, RoomNetwork, Row};
use crate::features::NeighbourLabels;
use crate::labels::Typology;
use crate::study::FoldTold;
use crate::study::predictions::Prediction;

/// What is to be trained, and how it is tested.
#[derive(Clone, Debug)]
pub struct Order {
    /// One method; `None` for all of them and, of plans, their blend.
    pub method: Option<Method>,
    /// The name of a typology, or of [`STANDARD`] for all rooms; `None` for a model of each typology, and standard ones
    /// if there are several.
    pub typology: Option<String>,
    /// Neighbours' labels while learning; `None` for predicted ones of plans, and true ones of tables.
    pub neighbours: Option<NeighbourLabels>,
    /// Folds of the cross-validation, 0 for none.
    pub folds: usize,
    /// What the folds do not split, for each cross-validation wanted.
    pub groupings: Vec<Grouping>,
    /// Where the rooms carry folds that count: what these do not split.
    pub given: Option<Grouping>,
    pub seed: u64,
    /// Licence of the models, and whose data they contain.
    pub licence: String,
    /// The words of the call that names the data: 'enfilade train schools'.
    pub call: String,
    /// The folds as an option's value.
    pub folds_word: String,
}

/// Why nothing was trained.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TrainError {
    Cancelled,
    /// What is wrong with the data or the order, and what to do.
    Data(String),
}

impl fmt::Display for TrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => Cancelled.fmt(f),
            Self::Data(what) => f.write_str(what),
        }
    }
}

impl std::error::Error for TrainError {}

impl From<Cancelled> for TrainError {
    fn from(Cancelled: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A model that was trained.
#[derive(Clone, Debug)]
pub struct Made {
    /// The set it learned from: a typology, or [`STANDARD`].
    pub set: String,
    pub method: Method,
    /// Its file.
    pub bytes: Vec<u8>,
    /// What cross-validation found, by what the folds did not split.
    pub scores: Vec<(Grouping, Scores)>,
    pub model: Arc<StoredModel>,
}

impl Made {
    /// How it did, in words: '71.2 % by room, 65.0 % by building'.
    pub fn told(&self) -> String {
        let told: Vec<String> = self
            .scores
            .iter()
            .map(|(by, scores)| format!("{:.1} % by {}", 100.0 * scores.accuracy, by.name()))
            .collect();
        if told.is_empty() { "not validated".to_owned() } else { told.join(", ") }
    }
}

/// Who has models trained: runs each step, and hears of what comes of it.
pub trait Watcher {
    type Error: From<TrainError>;

    /// Runs a step, given in words ('testing on school plans'), with progress and whether to go on.
    fn step<T>(&mut self, what: &str, step: impl FnOnce(&Work<'_>) -> T) -> T;

    /// Hears what could not be done, which does not end the training.
    ///
    /// # Errors
    /// When it cannot be passed on.
    fn remark(&mut self, what: &str) -> Result<(), Self::Error>;

    /// Takes a model, as soon as it is trained.
    ///
    /// # Errors
    /// When it cannot be kept.
    fn made(&mut self, model: Made) -> Result<(), Self::Error>;

    /// Who hears of each fold of a set that was tested, from any thread.
    fn folds(&self, _set: &str) -> Arc<dyn Fn(FoldTold) + Send + Sync> {
        Arc::new(|_| {})
    }
}

/// A part of the data to learn from; `None` is the typology of a standard model.
pub type Part = (Option<Typology>, Collection);

/// The parts of the data that models are trained on.
///
/// # Errors
/// When no labelled room is of the typology asked for.
pub fn parts(collection: &Collection, typology: Option<&str>) -> Result<Vec<Part>, TrainError> {
    let typologies = collection.typologies();
    let Some(name) = typology else {
        let mut parts: Vec<Part> = typologies
            .iter()
            .map(|typology| (Some(typology.clone()), collection.of_typology(typology)))
            .filter(|(_, part)| !part.rows(NeighbourLabels::True).unwrap_or_default().is_empty())
            .collect();
        if parts.len() != 1 {
            parts.push((None, collection.clone()));
        }
        return Ok(parts);
    };
    if name.trim().eq_ignore_ascii_case(STANDARD) {
        return Ok(vec![(None, collection.clone())]);
    }
    match Typology::new(name).filter(|typology| typologies.contains(typology)) {
        Some(typology) => Ok(vec![(Some(typology.clone()), collection.of_typology(&typology))]),
        None => {
            let known: Vec<&str> = typologies.iter().map(Typology::as_str).chain([STANDARD]).collect();
            Err(TrainError::Data(format!(
                "no labelled room is of the typology '{name}'; there are {}",
                known.join(", ")
            )))
        }
    }
}

/// The methods to train on a collection.
///
/// # Errors
/// When the method asked for cannot learn from it.
pub fn methods(collection: &Collection, method: Option<Method>) -> Result<Vec<Method>, TrainError> {
    match (method, collection) {
        (Some(Method::Joint), Collection::Rows(_)) => Err(TrainError::Data(
            "a dataset file does not say which rooms belong together; give the plans instead".to_owned(),
        )),
        (Some(Method::Blend), _) => Err(TrainError::Data(
            "a blend is made of other models, so they are trained together; train all of them".to_owned(),
        )),
        (Some(method), _) => Ok(vec![method]),
        (None, Collection::Plans(_)) => Ok(Method::ALL.into_iter().filter(|&method| method != Method::Blend).collect()),
        (None, Collection::Rows(_)) => Ok(Algorithm::ALL.map(Method::Each).to_vec()),
    }
}

/// What training found besides the models.
#[derive(Default)]
pub struct Trained {
    /// The joint classifiers, which take part in blends, by set.
    joints: BTreeMap<String, Arc<StoredModel>>,
    /// What was said out of fold, by set.
    pub said: BTreeMap<String, Vec<Prediction>>,
    /// The same of the committees that take part in blends.
    by_committees: BTreeMap<String, Vec<Prediction>>,
}

/// Trains the models of an order on parts of a collection, one after the other: of each part each method, then the blends.
///
/// # Errors
/// When it is cancelled, the data do not suffice, or the watcher cannot go on.
pub fn train<W: Watcher>(
    collection: &Collection,
    parts: &[Part],
    methods: &[Method],
    order: &Order,
    watcher: &mut W,
) -> Result<Trained, W::Error> {
    let mut trained = Trained::default();
    for (typology, part) in parts {
        let set = set_name(typology.as_ref());
        let neighbours = order.neighbours.unwrap_or(match part {
            Collection::Plans(_) => NeighbourLabels::Predicted,
            Collection::Rows(_) => NeighbourLabels::True,
        });
        let Validated { scores: scores_of, said: predictions, by_committees } =
            validating::validated(part, set, methods, neighbours, order, watcher)?;
        for &method in methods {
            let scores: Vec<(Grouping, Scores)> =
                scores_of.iter().filter(|(of, _)| *of == method).map(|(_, scores)| scores.clone()).collect();
            let (classifier, data) = classifier(part, set, method, neighbours, order, watcher)?;
            let about = About {
                typology: typology.clone(),
                neighbours,
                command: order.command_line(typology.as_ref(), method, neighbours),
                program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
                seed: order.seed,
                licence: order.licence.clone(),
                data,
                scores: scores.iter().map(|(by, scores)| ScoreSummary::of(scores, *by, order.seed)).collect(),
                learned: made::learned(part, method, &predictions),
            };
            let bytes = model_file::to_bytes(&classifier, &about);
            let made = made::made(set, method, bytes, scores, &|_| None)?;
            if method == Method::Joint {
                trained.joints.insert(set.to_owned(), made.model.clone());
            }
            watcher.made(made)?;
        }
        trained.said.insert(set.to_owned(), predictions);
        trained.by_committees.insert(set.to_owned(), by_committees);
    }
    if order.method.is_none() && !collection.networks().is_empty() {
        for (typology, part) in parts {
            let committee = committee(part, set_name(typology.as_ref()), order, watcher)?;
            if let Some(blend) = trained.blend(typology.as_ref(), part, collection, committee, order)? {
                watcher.made(blend)?;
            }
        }
    }
    Ok(trained)
}

/// What went wrong with the data.
fn wrong(error: impl fmt::Display) -> TrainError {
    TrainError::Data(error.to_string())
}

/// The rows to learn from, before neighbours are predicted.
fn rows_of(part: &Collection, neighbours: NeighbourLabels) -> Result<Vec<Row>, TrainError> {
    part.rows(neighbours).ok_or_else(|| {
        TrainError::Data(format!(
            "a dataset file does not say which rooms are neighbours, so there are no {} neighbour labels; give \
             the plans instead",
            neighbours.name()
        ))
    })
}

/// The committee that takes part in the blend of a set.
fn committee<W: Watcher>(
    part: &Collection,
    set: &str,
    order: &Order,
    watcher: &mut W,
) -> Result<Option<Classifier>, W::Error> {
    let learn = |work: &Work<'_>| -> Result<Option<Classifier>, TrainError> {
        let rows = rows_of(part, NeighbourLabels::Predicted)?;
        let all: Vec<usize> = (0..rows.len()).collect();
        Ok(committee::train(part.networks(), &rows, &part.places(), &all, order.seed, work)?)
    };
    Ok(watcher.step(&format!("training on {}: committee of perceptrons", plans_of(set)), learn)?)
}

/// A classifier that learned from all rooms of a part, and what it learned from.
fn classifier<W: Watcher>(
    part: &Collection,
    set: &str,
    method: Method,
    neighbours: NeighbourLabels,
    order: &Order,
    watcher: &mut W,
) -> Result<(PlanClassifier, DataSummary), W::Error> {
    let learn = |work: &Work<'_>| -> Result<(PlanClassifier, DataSummary), TrainError> {
        let mut rows = rows_of(part, neighbours)?;
        if let (Method::Each(algorithm), NeighbourLabels::Predicted) = (method, neighbours) {
            let all: Vec<usize> = (0..rows.len()).collect();
            let (networks, places) = (part.networks(), part.places());
            let by = Grouping::Building;
            rows = in_plan::rows_with_predicted_neighbours(
                networks, &rows, &places, &all, algorithm, by, order.seed, work,
            )?;
        }
        let table = Table::from_rows(&rows).map_err(wrong)?;
        let classifier: PlanClassifier = match method {
            Method::Each(algorithm) => Classifier::train(algorithm, &table, order.seed, work)?.into(),
            Method::Joint => {
                let networks: Vec<&RoomNetwork> = part.networks().iter().collect();
                Joint::train(&networks, order.seed, work).map_err(validating::joint_error)?.into()
            }
            Method::Blend => return Err(wrong("a blend is made of other models")),
        };
        Ok((classifier, DataSummary::of(&rows, &table)))
    };
    Ok(watcher.step(&format!("training on {}: {}", plans_of(set), method.title()), learn)?)
}

impl Order {
    /// The command line that makes this one model from the same data.
    fn command_line(&self, typology: Option<&Typology>, method: Method, neighbours: NeighbourLabels) -> String {
        let mut words = vec![self.call.clone()];
        if method != Method::Blend {
            words.push(format!("--algorithm {} --typology {}", method.name(), set_name(typology)));
        }
        words.push(format!("--neighbours {} --folds {} --seed {}", neighbours.name(), self.folds_word, self.seed));
        words.join(" ")
    }
}
