//! `enfilade train`.

use std::path::{Path, PathBuf};

use super::call::quoted;
use super::collect::{CollectOptions, Collected, FoldsFrom, collect, neighbour_labels};
use super::outputs::{Care, Outputs, is_stdout};
use super::predictions::save_predictions;
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::base::file_name::component;
use crate::base::wording::or_words;
use crate::base::work::Work;
use crate::classify::{Algorithm, Method, typology::TypologyModel, unknown::Unknown};
use crate::dataset::folds::Grouping;
use crate::dataset::sets::set_name;
use crate::dataset::{RoomNetwork, Row};
use crate::features::NeighbourLabels;
use crate::store::MODEL_ENDING;
use crate::study::predictions::Prediction;
use crate::training::{self, Made, Order, Watcher};

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
        let parts = training::parts(&collection, self.typology.as_deref())?;
        let methods = training::methods(&collection, self.algorithm)?;
        let is_file = is_stdout(&self.output) || self.output.to_string_lossy().ends_with(MODEL_ENDING);
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
        let mut outputs = Outputs::new(terminal);
        let mut writer = Writer { output: &self.output, is_file, outputs: &mut outputs, terminal };
        let trained = training::train(&collection, &parts, &methods, &self.order(given), &mut writer)?;
        if let Some(path) = &self.predictions {
            let mut told_of_rooms: Vec<(Row, Prediction)> = Vec::new();
            for (typology, part) in &parts {
                let rows = part.rows(NeighbourLabels::True).unwrap_or_default();
                let said = trained.said.get(set_name(typology.as_ref())).into_iter().flatten();
                told_of_rooms.extend(said.filter_map(|it| Some((rows.get(it.row)?.clone(), it.clone()))));
            }
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

/// Writes models as they come, with a progress line for each step.
struct Writer<'a> {
    output: &'a Path,
    /// Whether the output is the file of the only model.
    is_file: bool,
    outputs: &'a mut Outputs,
    terminal: &'a mut Terminal,
}

impl Watcher for Writer<'_> {
    type Error = CliError;

    fn step<T>(&mut self, what: &str, step: impl FnOnce(&Work<'_>) -> T) -> T {
        with_progress(what, None, self.terminal, step)
    }

    fn remark(&mut self, what: &str) -> Result<(), CliError> {
        Ok(self.terminal.remark(what)?)
    }

    fn made(&mut self, made: Made) -> Result<(), CliError> {
        let path = if self.is_file {
            self.output.to_owned()
        } else {
            self.outputs.path_in(self.output, &format!("{}-{}{MODEL_ENDING}", made.set, made.method.name()))?
        };
        write_model(&path, &made.bytes, self.outputs, self.terminal)?;
        let told = format!("{}: {}, {}: {}", path.display(), made.set, made.method, made.told());
        Ok(self.terminal.report(told)?)
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

    /// What is to be trained. `given`: what the folds of a table do not split.
    fn order(&self, given: Option<Grouping>) -> Order {
        let words: Vec<String> = std::iter::once("enfilade train".to_owned()).chain(self.collect.words()).collect();
        let folds_word = match &self.folds {
            FoldsFrom::Count(count) => count.to_string(),
            FoldsFrom::File(file) => quoted(&file.to_string_lossy()),
        };
        Order {
            method: self.algorithm,
            typology: self.typology.clone(),
            neighbours: self.neighbours,
            folds: self.folds.count(),
            groupings: Grouping::ALL.to_vec(),
            given,
            seed: self.seed,
            licence: self.licence.clone(),
            call: words.join(" "),
            folds_word,
        }
    }
}

fn write_model(path: &Path, bytes: &[u8], outputs: &mut Outputs, terminal: &mut Terminal) -> Result<(), CliError> {
    if let (Some(folder), false) = (path.parent(), is_stdout(path)) {
        outputs.folder(folder)?;
    }
    outputs.save(path, bytes, Care::Flushed, terminal)
}
