use crate::base::units::Units;
use crate::base::wording::{count, shortened};
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::json;

use super::batch::{self, Input};
use super::collect::neighbour_labels;
use super::door::one_line;
use super::outputs::{Care, Outputs, is_stdout};
use super::train::{each_room, method};
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::classify::why::Why;
use crate::classify::{Distribution, Method, models::Models};
use crate::dataset::NetworkRoom;
use crate::edit;
use crate::features::NeighbourLabels;
use crate::formats::Import;
use crate::labels::Label;
use crate::pipeline::{Asked, Pipeline};
use crate::plan::{LabelOrigin, OpeningId, Plan, RoomLabel};
use crate::predict::{Agreement, DEFAULT_METHOD, ModelSet, Predictions, Predictor};
use crate::store::{MODEL_ENDING, checked_bytes, default_models, load_model, models_folder, models_in, save_plan};

/// How plan files end.
const PLAN_ENDING: &str = "plan.json";

/// Whether an output is one plan file, by its name.
fn is_plan_file(output: &Path) -> bool {
    !output.is_dir() && output.to_string_lossy().ends_with(&format!(".{PLAN_ENDING}"))
}

/// `enfilade classify`: labels for the rooms of plans.
#[derive(clap::Args)]
pub struct ClassifyCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    #[command(flatten)]
    predictor: PredictorOptions,
    /// Use the model in this file, or your own model of this name ('enfilade models' lists them)
    #[arg(long, value_name = "FILE|NAME", conflicts_with_all = ["typology", "algorithm"])]
    model: Option<PathBuf>,
    /// Neighbours' labels: 'true' (where known, else temporary), 'temporary', or 'predicted' (where not known,
    /// repeated until stable) [default: as the model learned]
    #[arg(long, value_name = "MODE", value_parser = neighbour_labels)]
    neighbours: Option<NeighbourLabels>,
    /// Ignore all known labels, to see the predictions for a new building
    #[arg(long)]
    hide_labels: bool,
    /// Also predict what lies behind each opening that leads into unexplored space or outside
    #[arg(long)]
    unknown: bool,
    /// Write the predictions for rooms without a label to the plan file, marked as predictions
    #[arg(long)]
    write: bool,
    /// With --write: write to this plan file (.plan.json) instead, or for several plans to this folder
    #[arg(short, long, value_name = "FILE|DIR", requires = "write")]
    output: Option<PathBuf>,
    /// Print JSON (docs/json/classify.md describes it)
    #[arg(long)]
    json: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

/// Options of every subcommand that predicts.
#[derive(clap::Args)]
pub struct PredictorOptions {
    /// Use models for this typology, for 'standard' (learned from all typologies), or the model of this name
    /// ('enfilade models' lists them); 'auto' infers the typology from the plan [default: the plan's own typology,
    /// inferred if it has none]
    #[arg(long, value_name = "NAME", default_value = "plan", hide_default_value = true)]
    typology: String,
    #[arg(long, value_name = "NAME", default_value = DEFAULT_METHOD.name(), value_parser = method,
          help = format!("blend (the mean of several models), joint (all rooms of a plan together), or {} (each room by itself)", each_room()))]
    algorithm: Method,
    #[command(flatten)]
    models: ModelsOption,
}

/// Where a subcommand finds the user's own models.
#[derive(clap::Args)]
pub struct ModelsOption {
    /// Folder of your own models [default: the one that 'enfilade models' names]
    #[arg(long = "models", value_name = "DIR")]
    folder: Option<PathBuf>,
}

impl ModelsOption {
    /// The folder of the user's own models; `None` if the system has no home folder.
    pub fn folder(&self) -> Option<PathBuf> {
        self.folder.clone().or_else(models_folder)
    }

    /// The available models, and the number of the user's own that cannot be used, which are reported on
    /// stderr.
    ///
    /// # Errors
    /// When the given folder does not exist, or stderr cannot be written.
    pub fn read(&self, terminal: &mut Terminal) -> Result<(Models, usize), CliError> {
        if let Some(folder) = self.folder.as_ref().filter(|folder| !folder.is_dir()) {
            return Err(CliError::call(format!("{}: no such folder of models; check the path", folder.display())));
        }
        let folder = self.folder();
        let (own, errors) = folder.as_deref().map(models_in).unwrap_or_default();
        let defaults = folder.as_deref().map(default_models).unwrap_or_default();
        for error in &errors {
            terminal.error(error)?;
        }
        Ok((Models::bundled().with(own).with_defaults(defaults), errors.len()))
    }
}

impl PredictorOptions {
    /// Which models predict, and the available models.
    ///
    /// # Errors
    /// When there are no models with the given name.
    pub fn read(&self, terminal: &mut Terminal) -> Result<(Predictor, Models), CliError> {
        let (models, _) = self.models.read(terminal)?;
        let set = ModelSet::read(&self.typology, &models).map_err(|error| CliError::call(error.to_string()))?;
        Ok((Predictor { set, method: self.algorithm }, models))
    }
}

impl Subcommand for ClassifyCommand {
    const NAME: &'static str = "classify";
    const ABOUT: &'static str = "Predict the labels of rooms, with probabilities and reasons";
    const EXAMPLE: &'static str = "enfilade classify plans/office.plan.json --algorithm tree";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let (predictor, models) = self.predictor.read(terminal)?;
        let own_folder = self.predictor.models.folder();
        let model_file =
            |named: &Path| inputs::by_name(named, MODEL_ENDING, own_folder).unwrap_or_else(|| named.to_owned());
        let own = self.model.as_deref().map(model_file);
        let own = own.as_deref().map(load_model).transpose()?.map(Arc::new);
        let folder = self.output.as_deref().filter(|output| !is_stdout(output) && !is_plan_file(output));
        let files = batch::inputs_into(&self.plans, folder);
        if let (Some(output), None, true) = (&self.output, folder, files.len() > 1) {
            return Err(CliError::call(format!(
                "-o {}: is a single file, but there are {} plans to write; name a folder",
                output.display(),
                files.len()
            )));
        }
        let mut outputs = Outputs::new(terminal);
        // What a person reads goes where no plan goes.
        let tells_on_stderr = self.output.as_deref().is_some_and(is_stdout);
        let mut objects: Vec<serde_json::Value> = Vec::new();
        let mut total = Agreement::default();
        let mut plans = 0;
        let asked =
            Asked { predictor, models, model: own, neighbours: self.neighbours, hides_labels: self.hide_labels };
        let work = |_: &Input, import: Import| -> Result<Vec<(Plan, Predictions)>, CliError> {
            import
                .plans
                .into_iter()
                .map(|plan| Ok((plan.clone(), Pipeline::new(&plan, &schemes).predictions(&asked)?)))
                .collect()
        };
        let failed = batch::for_each_import(&files, "classifying", terminal, work, |file, classified, terminal| {
            let classified = classified?;
            for (storey, (plan, said)) in classified.iter().enumerate() {
                total.add(said.agreement());
                if self.json {
                    objects.push(json(plan, said, self.unknown));
                } else {
                    let gap = if plans > 0 { "\n" } else { "" };
                    let text = gap.to_owned() + &text(plan, said, self.unknown)?;
                    if tells_on_stderr && terminal.call.quiet {
                    } else if tells_on_stderr {
                        terminal.err.write_all(text.as_bytes())?;
                    } else {
                        terminal.out.write_all(text.as_bytes())?;
                    }
                }
                plans += 1;
                if self.write {
                    let (target, rooms) = self.write(file, storey, folder, plan, said, &mut outputs, terminal)?;
                    terminal.remark(format!("{}: {} written", target.display(), count(rooms, "prediction")))?;
                }
            }
            Ok(())
        })?;
        if self.json {
            serde_json::to_writer_pretty(&mut terminal.out, &json!({ "version": 1, "plans": objects }))?;
            writeln!(terminal.out)?;
        } else if !tells_on_stderr && plans > 1 && total.known > 0 {
            writeln!(terminal.out, "\nAll {plans} plans: {total}")?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl ClassifyCommand {
    /// Writes the predictions for rooms without a label into a plan file; returns the file and their
    /// number.
    fn write(
        &self,
        file: &Input,
        storey: usize,
        folder: Option<&Path>,
        plan: &Plan,
        said: &Predictions,
        outputs: &mut Outputs,
        terminal: &mut Terminal,
    ) -> Result<(PathBuf, usize), CliError> {
        let is_own = file.path.to_string_lossy().ends_with(&format!(".{PLAN_ENDING}"));
        let target = match (folder, &self.output) {
            (Some(folder), _) => file.mirrored(folder, storey, PLAN_ENDING, outputs),
            (None, Some(output)) => output.clone(),
            (None, None) if is_own => file.path.clone(),
            (None, None) => {
                return Err(CliError::new(format!(
                    "{}: predictions can only be written to plan files (.plan.json); name one with -o",
                    file.path.display()
                )));
            }
        };
        let mut plan = plan.clone();
        let mut written = 0;
        for room in said.network.rooms.iter().filter(|room| room.label.is_none()) {
            let label = said.label(room.id).map(|label| RoomLabel { label, origin: LabelOrigin::Prediction });
            plan = edit::set_label(&plan, room.id, label)?;
            written += 1;
        }
        if self.output.is_none() {
            // The plan's own file: that is what --write asks for.
            save_plan(&target, &plan)?;
            return Ok((target, written));
        }
        if let (Some(_), Some(parent)) = (folder, target.parent()) {
            outputs.folder(parent)?;
        }
        outputs.save_from(&target, &checked_bytes(&target, &plan)?, Care::Flushed, &file.path, terminal)?;
        Ok((target, written))
    }
}

/// What is said of a plan, for people.
fn text(plan: &Plan, said: &Predictions, with_unknown: bool) -> Result<String, std::fmt::Error> {
    let name = if plan.meta().name.is_empty() { "Untitled plan".to_owned() } else { one_line(&plan.meta().name) };
    let rooms = &said.network.rooms;
    let width = |of: &dyn Fn(&NetworkRoom) -> usize, least: usize| {
        rooms.iter().map(of).max().unwrap_or_default().clamp(least, 28)
    };
    let keys = width(&|room| room.key.chars().count(), 4);
    let functions = width(&|room| room.function.chars().count(), 8);
    let mut out = String::new();
    writeln!(out, "{name}: typology {} ({}), model {}", said.choice.set, said.choice.because, said.model.name)?;
    if !said.choice.reasons.is_empty() {
        writeln!(out, "  {} because {}", said.choice.set, said.choice.reasons_in_words(Units::Metric))?;
    }
    if rooms.is_empty() {
        writeln!(out, "  no rooms to classify")?;
        return Ok(out);
    }
    writeln!(
        out,
        "  {:<keys$}  {:<functions$}  {:<11}    {:<11}  prob.  reason",
        "room", "function", "label", "predicted"
    )?;
    for (room, distribution) in rooms.iter().zip(&said.result.distributions) {
        let label = distribution.label();
        // Where the known label is another.
        let mark = if room.label.is_some_and(|known| known != label) { "≠" } else { " " };
        writeln!(
            out,
            "  {:<keys$}  {:<functions$}  {:<11}  {mark} {:<11}  {:>3.0} %  {}",
            one_line(&shortened(&room.key, keys)),
            one_line(&shortened(&room.function, functions)),
            room.label.map_or("–", Label::name),
            label.name(),
            100.0 * distribution.probability(label),
            said.why(room.id, Units::Metric).map(|why| why.sentences()).unwrap_or_default()
        )?;
    }
    writeln!(out, "  {}; neighbours' labels: {}", said.agreement(), said.neighbours_in_words())?;
    if let Some(known) = said.acquaintance() {
        writeln!(out, "  the model {}", known.words())?;
    }
    if with_unknown {
        let unknown = said.unknown();
        if unknown.is_empty() {
            writeln!(out, "  no opening leads into unexplored space or outside")?;
        }
        for (room, opening, behind) in unknown {
            let label = behind.label();
            writeln!(
                out,
                "  behind opening {opening} of {}, if there is a room: {label} ({:.0} %)",
                one_line(&rooms[room].key),
                100.0 * behind.probability(label)
            )?;
        }
    }
    Ok(out)
}

fn json(plan: &Plan, said: &Predictions, with_unknown: bool) -> serde_json::Value {
    let probabilities = |distribution: &Distribution| -> serde_json::Map<String, serde_json::Value> {
        let rounded = |label: Label| (distribution.probability(label) * 1e4).round() / 1e4;
        Label::ALL.into_iter().map(|label| (label.letter().to_owned(), json!(rounded(label)))).collect()
    };
    let rooms: Vec<serde_json::Value> = said
        .network
        .rooms
        .iter()
        .zip(&said.result.distributions)
        .map(|(room, distribution)| {
            let why = said.why(room.id, Units::Metric);
            json!({
                "room": room.key,
                "id": room.id.to_string(),
                "function": room.function,
                "label": room.label.map(Label::letter),
                "predicted": distribution.label().letter(),
                "probabilities": probabilities(distribution),
                "reason": why.as_ref().map(Why::sentences),
                "evidence": why.as_ref().map(Why::to_value),
            })
        })
        .collect();
    let agreement = said.agreement();
    let posterior: serde_json::Map<String, serde_json::Value> = said
        .choice
        .posterior
        .iter()
        .map(|(typology, probability)| (typology.as_str().to_owned(), json!((probability * 1e4).round() / 1e4)))
        .collect();
    let unknown = |(room, opening, behind): (usize, OpeningId, Distribution)| {
        json!({
            "opening": opening.to_string(),
            "room": said.network.rooms[room].key,
            "predicted": behind.label().letter(),
            "probabilities": probabilities(&behind),
        })
    };
    let unknown = with_unknown.then(|| said.unknown().into_iter().map(unknown).collect::<Vec<_>>());
    json!({
        "plan": plan.meta().name,
        "typology": said.choice.set,
        "typology_because": said.choice.because,
        "typology_posterior": posterior,
        "typology_reasons": said.choice.reasons.iter().map(|reason| reason.words(Units::Metric)).collect::<Vec<_>>(),
        "model": said.model.name,
        "neighbours": said.neighbours.name(),
        "rounds": said.result.rounds,
        "settled": said.result.settled,
        "labelled_rooms": agreement.known,
        "agreeing_rooms": agreement.right,
        "learned_from": said.acquaintance().map(|known| json!({
            "rooms": known.rooms,
            "of": known.of,
            "out_of_fold_agreement": known.out_of_fold.map(|share| (share * 1e4).round() / 1e4),
            "folds_by": known.folds_by,
        })),
        "rooms": rooms,
        "unknown": unknown,
    })
}
