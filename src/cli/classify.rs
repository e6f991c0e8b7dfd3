use crate::base::wording::shortened;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::json;

use super::batch::{self, Input};
use super::collect::neighbour_labels;
use super::train::method;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::classify::{Distribution, Method, models::StoredModel};
use crate::dataset::NetworkRoom;
use crate::edit;
use crate::features::NeighbourLabels;
use crate::formats::Import;
use crate::labels::{Label, Schemes};
use crate::pipeline::{Asked, Pipeline};
use crate::plan::{LabelOrigin, OpeningId, Plan, RoomLabel};
use crate::predict::{Agreement, DEFAULT_METHOD, ModelSet, Predictions, Predictor, UnknownSet};
use crate::store::{load_model, save_plan};

/// `enfilade classify`: labels for the rooms of plans.
#[derive(clap::Args)]
pub struct ClassifyCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    #[command(flatten)]
    predictor: PredictorOptions,
    /// Use this model instead of a bundled one
    #[arg(long, value_name = "FILE.model.json", conflicts_with_all = ["typology", "algorithm"])]
    model: Option<PathBuf>,
    /// Neighbours' labels: 'true' (where known, else temporary), 'temporary', or 'predicted' (where not
    /// known, repeated until stable); without it, as the model learned
    #[arg(long, value_name = "MODE", value_parser = neighbour_labels)]
    neighbours: Option<NeighbourLabels>,
    /// Pretend that no room's label is known, to see what would be said of a new building
    #[arg(long)]
    hide_labels: bool,
    /// Say as well, for each opening that leads into unexplored space or outside, what would lie behind it
    #[arg(long)]
    unknown: bool,
    /// Write the predictions into the plan file, marked as predictions, for rooms without a label
    #[arg(long)]
    write: bool,
    /// With --write: write to this plan file (.plan.json) instead; for several plans, into this folder
    #[arg(short, long, value_name = "FILE|DIR", requires = "write")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Label scheme that extends the bundled ones (may be given several times)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

/// Options of every subcommand that predicts.
#[derive(clap::Args)]
pub struct PredictorOptions {
    /// Models of house, school, office or 'standard' (learned from all); 'auto' infers it from the plan;
    /// without it the plan's own, inferred where it has none
    #[arg(long, value_name = "NAME", default_value = "plan", hide_default_value = true, value_parser = model_set)]
    typology: ModelSet,
    /// rules, tree, knn or mlp, each room by itself; or joint, all rooms of a plan together
    #[arg(long, value_name = "NAME", default_value = DEFAULT_METHOD.name(), value_parser = method)]
    algorithm: Method,
}

impl PredictorOptions {
    pub fn predictor(&self) -> Predictor {
        Predictor { set: self.typology.clone(), method: self.algorithm }
    }
}

/// Which models to use, as an option's value.
fn model_set(word: &str) -> Result<ModelSet, String> {
    word.parse().map_err(|error: UnknownSet| error.to_string())
}

impl Subcommand for ClassifyCommand {
    const NAME: &'static str = "classify";
    const ABOUT: &'static str = "Predict the labels of rooms, with probability and reason";
    const EXAMPLE: &'static str = "enfilade classify plans/office.plan.json --algorithm tree";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let own = self.model.as_deref().map(load_model).transpose()?.map(Arc::new);
        let files = batch::inputs(&self.plans)?;
        let mut objects: Vec<serde_json::Value> = Vec::new();
        let mut total = Agreement::default();
        let mut plans = 0;
        let work = |_: &Input, import: Import| -> Result<Vec<(Plan, Predictions)>, CliError> {
            import
                .plans
                .into_iter()
                .map(|plan| Ok((plan.clone(), self.classify(&plan, &schemes, own.as_ref())?)))
                .collect()
        };
        let failed = batch::for_each_import(&files, "classifying", terminal, work, |file, classified, terminal| {
            let classified = classified?;
            for (storey, (plan, said)) in classified.iter().enumerate() {
                total.add(said.agreement());
                if self.json {
                    objects.push(json(plan, said, self.unknown));
                } else {
                    if plans > 0 {
                        writeln!(terminal.out)?;
                    }
                    print(plan, said, self.unknown, terminal)?;
                }
                plans += 1;
                if self.write {
                    let (target, rooms) = self.write(&file.path, storey, classified.len(), files.len(), plan, said)?;
                    writeln!(terminal.err, "{}: {rooms} predictions written", target.display())?;
                }
            }
            Ok(())
        })?;
        if self.json {
            serde_json::to_writer_pretty(&mut terminal.out, &objects)?;
            writeln!(terminal.out)?;
        } else if plans > 1 && total.known > 0 {
            writeln!(terminal.out, "\nAll {plans} plans: {total}")?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl ClassifyCommand {
    fn classify(
        &self,
        plan: &Plan,
        schemes: &Schemes,
        own: Option<&Arc<StoredModel>>,
    ) -> Result<Predictions, CliError> {
        let asked = Asked {
            predictor: self.predictor.predictor(),
            model: own.cloned(),
            neighbours: self.neighbours,
            hides_labels: self.hide_labels,
        };
        Ok(Pipeline::new(plan, schemes).predictions(&asked)?)
    }

    /// Writes the predictions of the rooms without a label into a plan file; gives the file and their number.
    fn write(
        &self,
        file: &Path,
        storey: usize,
        storeys: usize,
        files: usize,
        plan: &Plan,
        said: &Predictions,
    ) -> Result<(PathBuf, usize), CliError> {
        let name = inputs::target_name(file, storey, "plan.json");
        let target = match &self.output {
            Some(output) if files * storeys > 1 || output.is_dir() => {
                std::fs::create_dir_all(output)?;
                output.join(name)
            }
            Some(output) => output.clone(),
            None if file.to_string_lossy().ends_with(".plan.json") => file.to_owned(),
            None => {
                return Err(CliError::new(format!(
                    "{}: predictions can be written into plan files (.plan.json) only; say with -o where to write one",
                    file.display()
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
        save_plan(&target, &plan)?;
        Ok((target, written))
    }
}

fn print(plan: &Plan, said: &Predictions, with_unknown: bool, terminal: &mut Terminal) -> Result<(), CliError> {
    let name = if plan.meta().name.is_empty() { "Untitled plan" } else { &plan.meta().name };
    let rooms = &said.network.rooms;
    let width = |of: &dyn Fn(&NetworkRoom) -> usize, least: usize| {
        rooms.iter().map(of).max().unwrap_or_default().clamp(least, 28)
    };
    let keys = width(&|room| room.key.chars().count(), 4);
    let functions = width(&|room| room.function.chars().count(), 8);
    let out = &mut terminal.out;
    writeln!(out, "{name}: typology {} ({}), model {}", said.choice.set, said.choice.because, said.model.name)?;
    if !said.choice.reasons.is_empty() {
        writeln!(out, "  {} because of {}", said.choice.set, said.choice.reasons.join("; "))?;
    }
    if rooms.is_empty() {
        return Ok(writeln!(out, "  no rooms to classify")?);
    }
    writeln!(
        out,
        "  {:<keys$}  {:<functions$}  {:<11}  {:<11}  prob.  reason",
        "room", "function", "label", "predicted"
    )?;
    for (room, distribution) in rooms.iter().zip(&said.result.distributions) {
        let label = distribution.label();
        let mark = if room.label.is_some_and(|known| known != label) { "≠" } else { " " };
        writeln!(
            out,
            "  {:<keys$}  {:<functions$}  {:<11}{mark} {:<11}  {:>3.0} %  {}",
            shortened(&room.key, keys),
            shortened(&room.function, functions),
            room.label.map_or("–", Label::name),
            label.name(),
            100.0 * distribution.probability(label),
            said.reason(room.id).unwrap_or_default()
        )?;
    }
    writeln!(out, "  {}; neighbours' labels: {}", said.agreement(), said.neighbours_in_words())?;
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
                rooms[room].key,
                100.0 * behind.probability(label)
            )?;
        }
    }
    Ok(())
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
            json!({
                "room": room.key,
                "id": room.id.to_string(),
                "function": room.function,
                "label": room.label.map(Label::letter),
                "predicted": distribution.label().letter(),
                "probabilities": probabilities(distribution),
                "reason": said.reason(room.id),
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
        "typology_reasons": said.choice.reasons,
        "model": said.model.name,
        "neighbours": said.neighbours.name(),
        "rounds": said.result.rounds,
        "settled": said.result.settled,
        "labelled_rooms": agreement.known,
        "agreeing_rooms": agreement.right,
        "rooms": rooms,
        "unknown": unknown,
    })
}
