//! `enfilade train`. Above 500 lines: one call validates, trains and blends, and each step reads what the one before found.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::call::quoted;
use super::collect::{CollectOptions, Collected, FoldsFrom, collect, neighbour_labels};
use super::outputs::{Care, Outputs, is_stdout};
use super::predictions::save_predictions;
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::base::file_name::component;
use crate::base::wording::or_words;
use crate::base::work::Work;
use crate::classify::blend::{self, Blend, Part};
use crate::classify::models::StoredModel;
use crate::classify::{
    Algorithm, Classifier, Distribution, Method, PlanClassifier, Scores, in_plan,
    joint::{self, Joint, JointValidationError},
    learned::Learned,
    model_file::{self, About, DataSummary, ScoreSummary},
    typology::TypologyModel,
    unknown::Unknown,
};
use crate::dataset::{
    Collection, RoomNetwork, Row,
    fingerprint::RoomPrint,
    folds::{Folds, Grouping},
    sets::{STANDARD, set_name},
    table::Table,
};
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};
use crate::store::MODEL_ENDING;
use crate::study::predictions::Prediction;
use crate::study::{Cell, Condition, Options, StudyError, validate};

/// `enfilade train`: classifiers from labelled rooms.
#[derive(clap::Args)]
pub struct TrainCommand {
    #[command(flatten)]
    collect: CollectOptions,
    #[arg(long, value_name = "NAME", value_parser = method, help = format!(
        "{} (each room by itself) or joint (all rooms of a plan together) [default: all of them]",
        each_room()
    ))]
    algorithm: Option<Method>,
    /// Learn only from rooms of this typology, or 'standard' for all rooms [default: a model for each typology in the
    /// data, and standard ones if there are several]
    #[arg(long, value_name = "NAME")]
    typology: Option<String>,
    /// Neighbours' labels while learning: 'predicted' (as they look in use), 'temporary' or 'true' (as in
    /// the paper)
    #[arg(long, value_name = "MODE", value_parser = neighbour_labels)]
    neighbours: Option<NeighbourLabels>,
    /// Folds of the cross-validation whose scores go into the model file: their number, 0 for none, or a table (.csv)
    /// with the columns file, id, fold, such as a dataset
    #[arg(long, value_name = "N|FILE", default_value = "10", value_parser = FoldsFrom::read_or_none)]
    folds: FoldsFrom,
    /// Seed for everything random: the same data and seed give the same bytes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write the predictions of the cross-validation (CSV): a line per room, set, algorithm and kind of folds
    #[arg(long, value_name = "FILE.csv")]
    predictions: Option<PathBuf>,
    /// Put an apostrophe before texts in the predictions that begin with = + - @, so that spreadsheets do not run
    /// them as formulas
    #[arg(long)]
    guard_formulas: bool,
    /// Licence of the models, and whose data they contain
    #[arg(long, value_name = "TEXT", default_value = "")]
    licence: String,
    /// The model file (.model.json); for several models the folder
    #[arg(short, long, value_name = "FILE|DIR")]
    output: PathBuf,
}

/// The scores of each method, and the unit assigned to folds.
type ScoresOf = Vec<(Method, (Grouping, Scores))>;

/// The names of the learners: 'rules, tree, knn or mlp'.
pub fn each_room() -> String {
    or_words(&Algorithm::ALL.map(Algorithm::name))
}

/// Parses a method.
pub fn method(word: &str) -> Result<Method, String> {
    word.parse().map_err(|error: crate::classify::UnknownAlgorithm| error.to_string())
}

impl Subcommand for TrainCommand {
    const NAME: &'static str = "train";
    const ABOUT: &'static str = "Train models on labelled rooms";
    const EXAMPLE: &'static str = "enfilade train schools --algorithm tree --typology school -o school.model.json";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        self.check()?;
        let mut collected = collect(&self.collect, self.seed, terminal)?;
        let given = collected.folds_of(&self.folds, None, terminal)?;
        let Collected { collection, blind, failed, read } = collected;
        let mut told_of_rooms: Vec<(Row, Prediction)> = Vec::new();
        let mut trained = Trained::default();
        let parts = self.parts(&collection)?;
        let methods: Vec<Method> = match (self.algorithm, &collection) {
            (Some(Method::Joint), Collection::Rows(_)) => {
                return Err(CliError::new(
                    "a dataset file does not say which rooms belong together; give the plans instead",
                ));
            }
            (Some(method), _) => vec![method],
            (None, Collection::Plans(_)) => Method::ALL.into_iter().filter(|&method| method != Method::Blend).collect(),
            (None, Collection::Rows(_)) => Algorithm::ALL.map(Method::Each).to_vec(),
        };
        let is_file = is_stdout(&self.output) || self.output.to_string_lossy().ends_with(MODEL_ENDING);
        let mut outputs = Outputs::new(terminal);
        for (typology, _) in &parts {
            // The name of a typology becomes a part of the model's: said before any is learned.
            component(set_name(typology.as_ref())).map_err(|error| {
                CliError::new(format!("the typology cannot be part of a model's name: {error}; change it in the plans"))
            })?;
        }
        if is_file && parts.len() * methods.len() > 1 {
            return Err(CliError::new(format!(
                "{}: is a single file, but there are {} models to train; name a folder, or choose with --algorithm \
                 and --typology",
                self.output.display(),
                parts.len() * methods.len()
            )));
        }
        for (typology, part) in &parts {
            let set = set_name(typology.as_ref());
            let neighbours = self.neighbours.unwrap_or(match part {
                Collection::Plans(_) => NeighbourLabels::Predicted,
                Collection::Rows(_) => NeighbourLabels::True,
            });
            let (scores_of, predictions) = self.validated(part, set, &methods, neighbours, given, terminal)?;
            for &method in &methods {
                let scores: Vec<&(Grouping, Scores)> =
                    scores_of.iter().filter(|(of, _)| *of == method).map(|(_, scores)| scores).collect();
                let learned = learned(part, method, &predictions);
                let bytes = self.model(typology.as_ref(), part, method, neighbours, &scores, learned, terminal)?;
                let path = if is_file {
                    self.output.clone()
                } else {
                    outputs.path_in(&self.output, &format!("{set}-{}{MODEL_ENDING}", method.name()))?
                };
                write_model(&path, &bytes, &mut outputs, terminal)?;
                trained.add(set, method, &bytes)?;
                let told: Vec<String> = scores
                    .iter()
                    .map(|(by, scores)| format!("{:.1} % by {}", 100.0 * scores.accuracy, by.name()))
                    .collect();
                let told = if told.is_empty() { "not validated".to_owned() } else { told.join(", ") };
                terminal.report(format!("{}: {set}, {method}: {told}", path.display()))?;
            }
            trained.said.insert(set.to_owned(), predictions.clone());
            if self.predictions.is_some() {
                let rows = part.rows(NeighbourLabels::True).unwrap_or_default();
                told_of_rooms.extend(predictions.into_iter().filter_map(|it| Some((rows.get(it.row)?.clone(), it))));
            }
        }
        if self.algorithm.is_none() && !collection.networks().is_empty() {
            for (typology, part) in &parts {
                let set = set_name(typology.as_ref());
                let Some((bytes, told)) = self.blend(typology.as_ref(), part, &collection, &trained)? else { continue };
                let path = outputs.path_in(&self.output, &format!("{set}-{}{MODEL_ENDING}", Method::Blend.name()))?;
                write_model(&path, &bytes, &mut outputs, terminal)?;
                terminal.report(format!("{}: {set}, {}: {told}", path.display(), Method::Blend))?;
            }
        }
        if let Some(path) = &self.predictions {
            let (rows, mut predictions): (Vec<Row>, Vec<Prediction>) = told_of_rooms.into_iter().unzip();
            predictions.iter_mut().enumerate().for_each(|(index, it)| it.row = index);
            save_predictions(path, &rows, &predictions, self.guard_formulas, &read, &mut outputs, terminal)?;
        }
        if !is_file && self.typology.is_none() && parts.len() > 1 {
            if let Ok(model) = TypologyModel::train(&blind.iter().collect::<Vec<_>>()) {
                let path = self.output.join("typologies.json");
                let mut bytes = serde_json::to_vec_pretty(&model.to_value())?;
                bytes.push(b'\n');
                write_model(&path, &bytes, &mut outputs, terminal)?;
                terminal.report(format!("{}: infers the typology of plans", path.display()))?;
            }
            let mut unknown = serde_json::Map::new();
            for (typology, part) in &parts {
                let networks: Vec<&RoomNetwork> = part.networks().iter().collect();
                let of_set = serde_json::to_value(Unknown::train(&networks))?;
                unknown.insert(set_name(typology.as_ref()).to_owned(), of_set);
            }
            if !collection.networks().is_empty() {
                let path = self.output.join("unknown.json");
                let mut bytes = serde_json::to_vec(&unknown)?;
                bytes.push(b'\n');
                write_model(&path, &bytes, &mut outputs, terminal)?;
                terminal.report(format!("{}: predicts what lies behind openings", path.display()))?;
            }
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl TrainCommand {
    /// What is wrong with the call, whatever the data hold.
    fn check(&self) -> Result<(), CliError> {
        let is_file = is_stdout(&self.output) || self.output.to_string_lossy().ends_with(MODEL_ENDING);
        if is_file && self.algorithm.is_none() {
            return Err(CliError::call(format!(
                "-o {}: is a single file, but there is a model of each algorithm to train; name a folder, or choose \
                 with --algorithm",
                self.output.display()
            )));
        }
        if self.algorithm == Some(Method::Blend) {
            return Err(CliError::call(
                "a blend is made of other models, so they are trained together; leave out --algorithm",
            ));
        }
        let is_table = |path: &PathBuf| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        if self.algorithm == Some(Method::Joint) && self.collect.data.iter().all(is_table) {
            return Err(CliError::call(
                "a dataset file does not say which rooms belong together; give the plans instead",
            ));
        }
        Ok(())
    }

    /// The parts of the data to learn from; `None` is the typology of a standard model.
    fn parts(&self, collection: &Collection) -> Result<Vec<(Option<Typology>, Collection)>, CliError> {
        let typologies = collection.typologies();
        let Some(name) = &self.typology else {
            let mut parts: Vec<(Option<Typology>, Collection)> = typologies
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
                Err(CliError::new(format!(
                    "no labelled room is of the typology '{name}'; there are {}",
                    known.join(", ")
                )))
            }
        }
    }

    /// The scores of cross-validation, by room and by building; reports on stderr what could not be done.
    /// The joint classifier is trained on whole plans, so only by building.
    fn validated(
        &self,
        part: &Collection,
        set: &str,
        methods: &[Method],
        neighbours: NeighbourLabels,
        given: Option<Grouping>,
        terminal: &mut Terminal,
    ) -> Result<(ScoresOf, Vec<Prediction>), CliError> {
        let mut predictions = Vec::new();
        if self.folds == FoldsFrom::Count(0) {
            return Ok((Vec::new(), predictions));
        }
        let algorithms: Vec<Algorithm> =
            Algorithm::ALL.into_iter().filter(|&algorithm| methods.contains(&Method::Each(algorithm))).collect();
        let (grouping, is_given) = (given.unwrap_or(Grouping::Room), given.is_some());
        let options = Options { folds: self.folds.count(), neighbours, seed: self.seed, grouping, given: is_given };
        let conditions = Grouping::ALL.map(|by| Condition { by, neighbours });
        // A single typology makes a set with its own name, never a standard one.
        let typologies = part.typologies();
        let of_part = if typologies.len() == 1 { set_name(typologies.first()).to_owned() } else { set.to_owned() };
        let result = with_progress(&format!("validating {set}"), None, terminal, |work| {
            validate(part, options, &of_part, &algorithms, &conditions, work)
        });
        let mut scores = ScoresOf::new();
        match result {
            Ok((cells, notes, said)) => {
                predictions.extend(
                    said.into_iter().filter(|it| it.set == of_part).map(|it| Prediction { set: set.to_owned(), ..it }),
                );
                for note in notes.iter().filter(|note| note.starts_with(&of_part)) {
                    terminal.remark(note)?;
                }
                let of_cell = |cell: Cell| (Method::Each(cell.algorithm), (cell.condition.by, cell.scores));
                scores.extend(cells.into_iter().map(of_cell));
            }
            Err(StudyError::Cancelled) => return Err(StudyError::Cancelled.into()),
            Err(StudyError::Data(what)) => terminal.remark(format!("{set}: not validated: {what}"))?,
        }
        if methods.contains(&Method::Joint) {
            let networks: Vec<&RoomNetwork> = part.networks().iter().collect();
            let result = with_progress(&format!("validating {set}, joint"), None, terminal, |work| {
                match part.given_folds().filter(|_| given == Some(Grouping::Building)) {
                    Some(folds) => {
                        let folds = Folds::given(folds).map_err(JointValidationError::Folds)?;
                        joint::cross_validate_on(&networks, &folds, self.seed, work)
                    }
                    None => {
                        let folds = self.folds.count().min(buildings(&networks));
                        joint::cross_validate(&networks, folds, self.seed, work)
                    }
                }
            });
            match result {
                Ok(validated) => {
                    let condition = Condition { by: Grouping::Building, neighbours: NeighbourLabels::Predicted };
                    let said = validated.predictions.iter().zip(&validated.folds).enumerate();
                    predictions.extend(said.map(|(row, (said, &fold))| Prediction {
                        row,
                        set: set.to_owned(),
                        method: Method::Joint,
                        condition,
                        fold,
                        said: *said,
                    }));
                    scores.push((Method::Joint, (Grouping::Building, validated.scores)));
                }
                Err(error) => terminal.remark(format!("{set}, joint classifier: not validated: {error}"))?,
            }
        }
        Ok((scores, predictions))
    }

    /// The blend of a set's models and of the standard ones, and how it did, in words. `None` where there is nothing to blend.
    fn blend(
        &self,
        typology: Option<&Typology>,
        part: &Collection,
        all: &Collection,
        trained: &Trained,
    ) -> Result<Option<(Vec<u8>, String)>, CliError> {
        let set = set_name(typology);
        let rows = part.rows(NeighbourLabels::Predicted).unwrap_or_default();
        let labels: Vec<Label> = rows.iter().map(|row| row.label).collect();
        // The set's rooms among all rooms, by which the standard models were validated.
        let all_rows = all.rows(NeighbourLabels::Predicted).unwrap_or_default();
        let among_all: Vec<usize> = (0..all_rows.len())
            .filter(|&row| typology.is_none() || all_rows[row].typology.as_ref() == typology)
            .collect();
        let among_own: Vec<usize> = (0..rows.len()).collect();
        let (mut parts, mut unseen, mut folds) = (Vec::new(), Vec::new(), Vec::new());
        for (of, method, weight) in blend::recipe(set) {
            let Some(model) = trained.models.get(&(of.to_owned(), method)) else { continue };
            parts.push(Part { weight, model: model.clone() });
            let (said, of_folds) = trained.by_building(of, method, if of == set { &among_own } else { &among_all });
            unseen.push((weight, said));
            if folds.is_empty() {
                folds = of_folds;
            }
        }
        let tested = blend::blend_unseen(&unseen, &labels, &folds);
        let temperature = tested.as_ref().map_or(1.0, |tested| tested.temperature);
        let Some(blend) = Blend::new(parts, temperature) else { return Ok(None) };
        let scores = tested.map(|tested| {
            let of_rooms = folds.iter().zip(&tested.said).zip(&labels);
            (Scores::of(of_rooms.map(|((&fold, said), &label)| (fold, said, label))), tested.said)
        });
        let table = Table::from_rows(&rows)?;
        let prints: Vec<&RoomPrint> =
            part.places().iter().map(|place| &part.networks()[place.network].rooms[place.room].print).collect();
        let right: Option<Vec<bool>> = scores
            .as_ref()
            .map(|(_, said)| said.iter().zip(&labels).map(|(said, label)| said.label() == *label).collect());
        let right = right.as_ref().map(|right| (right.as_slice(), Grouping::Building.name()));
        let about = About {
            typology: typology.cloned(),
            neighbours: NeighbourLabels::Predicted,
            command: self.command_line(typology, Method::Blend, NeighbourLabels::Predicted),
            program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
            seed: self.seed,
            licence: self.licence.clone(),
            data: DataSummary::of(&rows, &table),
            scores: scores.iter().map(|(scores, _)| ScoreSummary::of(scores, Grouping::Building, self.seed)).collect(),
            learned: Some(Learned::new(prints, right)),
        };
        let told = scores.map_or("not validated".to_owned(), |(scores, _)| {
            format!("{:.1} % by {}", 100.0 * scores.accuracy, Grouping::Building.name())
        });
        Ok(Some((model_file::to_bytes(&blend.into(), &about), told)))
    }

    fn model(
        &self,
        typology: Option<&Typology>,
        part: &Collection,
        method: Method,
        neighbours: NeighbourLabels,
        scores: &[&(Grouping, Scores)],
        learned: Option<Learned>,
        terminal: &Terminal,
    ) -> Result<Vec<u8>, CliError> {
        let mut rows: Vec<Row> = part.rows(neighbours).ok_or_else(|| {
            CliError::new(format!(
                "a dataset file does not say which rooms are neighbours, so there are no {} neighbour labels; give \
                 the plans instead",
                neighbours.name()
            ))
        })?;
        if let (Method::Each(algorithm), NeighbourLabels::Predicted) = (method, neighbours) {
            let all: Vec<usize> = (0..rows.len()).collect();
            let (networks, places) = (part.networks(), part.places());
            rows = in_plan::rows_with_predicted_neighbours(
                networks,
                &rows,
                &places,
                &all,
                algorithm,
                Grouping::Building,
                self.seed,
                &Work::quiet(),
            )?;
        }
        let table = Table::from_rows(&rows)?;
        let classifier: PlanClassifier = match method {
            Method::Each(algorithm) => Classifier::train(algorithm, &table, self.seed, &Work::quiet())?.into(),
            Method::Joint => {
                let networks: Vec<&RoomNetwork> = part.networks().iter().collect();
                with_progress("training the joint classifier", None, terminal, |work| {
                    Joint::train(&networks, self.seed, work)
                })?
                .into()
            }
            Method::Blend => return Err(CliError::call("a blend is made of other models")),
        };
        let about = About {
            typology: typology.cloned(),
            neighbours,
            command: self.command_line(typology, method, neighbours),
            program: format!("enfilade {}", env!("CARGO_PKG_VERSION")),
            seed: self.seed,
            licence: self.licence.clone(),
            data: DataSummary::of(&rows, &table),
            scores: scores.iter().map(|(by, scores)| ScoreSummary::of(scores, *by, self.seed)).collect(),
            learned,
        };
        Ok(model_file::to_bytes(&classifier, &about))
    }

    /// The command line that makes this one model from the same data.
    fn command_line(&self, typology: Option<&Typology>, method: Method, neighbours: NeighbourLabels) -> String {
        let mut words = vec!["enfilade train".to_owned()];
        words.extend(self.collect.words());
        if method != Method::Blend {
            words.push(format!("--algorithm {} --typology {}", method.name(), set_name(typology)));
        }
        let folds = match &self.folds {
            FoldsFrom::Count(count) => count.to_string(),
            FoldsFrom::File(file) => quoted(&file.to_string_lossy()),
        };
        words.push(format!("--neighbours {} --folds {folds} --seed {}", neighbours.name(), self.seed));
        words.join(" ")
    }
}

/// The models of this call, and what classifiers of their kind said out of fold: what blends are made of.
#[derive(Default)]
struct Trained {
    models: BTreeMap<(String, Method), Arc<StoredModel>>,
    said: BTreeMap<String, Vec<Prediction>>,
}

impl Trained {
    fn add(&mut self, set: &str, method: Method, bytes: &[u8]) -> Result<(), CliError> {
        if blend::RECIPE.iter().any(|of| of.method == method) {
            let (classifier, about, checksum) =
                model_file::from_bytes(bytes, &|_| None).map_err(|error| CliError::new(error.to_string()))?;
            let name = format!("{set}-{}", method.name());
            let model = StoredModel { name, path: None, classifier, about, checksum };
            self.models.insert((set.to_owned(), method), Arc::new(model));
        }
        Ok(())
    }

    /// What was said of some rooms of a set by classifiers that had not seen their building, and the folds. Shorter than the
    /// list of rooms where something is missing.
    fn by_building(&self, set: &str, method: Method, rooms: &[usize]) -> (Vec<Distribution>, Vec<usize>) {
        let told = self.said.get(set).into_iter().flatten();
        let told = told.filter(|it| it.method == method && it.condition.by == Grouping::Building);
        let of_row: BTreeMap<usize, (Distribution, usize)> = told.map(|it| (it.row, (it.said, it.fold))).collect();
        rooms.iter().filter_map(|room| of_row.get(room).copied()).unzip()
    }
}

/// What tells the rooms of a part again, and which of them were right out of fold: on buildings never seen, or else by room. `None` for
/// rows of a file.
fn learned(part: &Collection, method: Method, predictions: &[Prediction]) -> Option<Learned> {
    let places = part.places();
    let prints: Vec<&RoomPrint> =
        places.iter().map(|place| &part.networks()[place.network].rooms[place.room].print).collect();
    let rows = part.rows(NeighbourLabels::True)?;
    let right_by = |by: Grouping| {
        let mut right: Vec<Option<bool>> = vec![None; rows.len()];
        for it in predictions.iter().filter(|it| it.method == method && it.condition.by == by) {
            right[it.row] = Some(it.said.label() == rows[it.row].label);
        }
        Some((right.into_iter().collect::<Option<Vec<bool>>>()?, by.name()))
    };
    let right = [Grouping::Building, Grouping::Room].into_iter().find_map(right_by);
    let right = right.as_ref().map(|(right, by)| (right.as_slice(), *by));
    (!prints.is_empty()).then(|| Learned::new(prints, right))
}

/// Number of buildings with a labelled room.
fn buildings(networks: &[&RoomNetwork]) -> usize {
    let labelled = networks.iter().filter(|network| network.labelled().next().is_some());
    labelled.map(|network| network.group.as_str()).collect::<BTreeSet<_>>().len()
}

fn write_model(path: &Path, bytes: &[u8], outputs: &mut Outputs, terminal: &mut Terminal) -> Result<(), CliError> {
    if let (Some(folder), false) = (path.parent(), is_stdout(path)) {
        outputs.folder(folder)?;
    }
    outputs.save(path, bytes, Care::Flushed, terminal)
}
