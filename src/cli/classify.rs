use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::collect::neighbour_labels;
use super::train::algorithm;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::classify::in_plan::{self, InPlan};
use crate::classify::{Algorithm, Distribution};
use crate::dataset::RoomNetwork;
use crate::features::NeighbourLabels;
use crate::labels::{Label, Schemes, Typology};
use crate::plan::{LabelOrigin, Plan, RoomId, RoomLabel, edit};
use crate::store::{StoredModel, bundled_model, bundled_sets, load_model, save_plan};

/// `enfilade classify`: labels for the rooms of plans.
#[derive(clap::Args)]
pub struct ClassifyCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// house, school, office, 'standard' (learned from all), or 'auto' to infer it from the plan;
    /// without it the plan's own, inferred where it has none
    #[arg(long, value_name = "NAME")]
    typology: Option<String>,
    /// rules, tree, knn or mlp
    #[arg(long, value_name = "NAME", default_value = "mlp", value_parser = algorithm)]
    algorithm: Algorithm,
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

/// What is said of one room.
struct Said {
    id: RoomId,
    key: String,
    function: String,
    /// The label that is known.
    known: Option<Label>,
    distribution: Distribution,
    reason: String,
}

/// What is said of one plan.
struct SaidOfPlan {
    /// The typology whose model was used, and how it was chosen.
    choice: Choice,
    model: String,
    neighbours: NeighbourLabels,
    rounds: usize,
    settled: bool,
    rooms: Vec<Said>,
}

/// Which set of models a plan is classified by, and why.
struct Choice {
    set: String,
    why: String,
}

impl Subcommand for ClassifyCommand {
    const NAME: &'static str = "classify";
    const ABOUT: &'static str = "Predict the labels of rooms, with probability and reason";
    const EXAMPLE: &'static str = "enfilade classify plans/office.plan.json --algorithm tree";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let own = self.model.as_deref().map(load_model).transpose()?;
        let files = inputs::plan_files(&self.plans)?;
        let mut objects: Vec<serde_json::Value> = Vec::new();
        let mut total = Agreement::default();
        let mut plans = 0;
        let failed = inputs::for_each_plan(&files, terminal, |file, import, terminal| {
            for (storey, plan) in import.plans.iter().enumerate() {
                let said = self.classify(plan, &schemes, own.as_ref())?;
                let agreement = Agreement::of(&said.rooms);
                total.add(&agreement);
                if self.json {
                    objects.push(said.json(plan, &agreement));
                } else {
                    if plans > 0 {
                        writeln!(terminal.out)?;
                    }
                    said.print(plan, &agreement, terminal)?;
                }
                plans += 1;
                if self.write {
                    let (target, rooms) = self.write(file, storey, import.plans.len(), files.len(), plan, &said)?;
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
    fn classify(&self, plan: &Plan, schemes: &Schemes, own: Option<&StoredModel>) -> Result<SaidOfPlan, CliError> {
        let network = RoomNetwork::new(plan, schemes);
        let known = if self.hide_labels { vec![None; network.rooms.len()] } else { network.known_labels() };
        let bundled;
        let (choice, model) = match own {
            Some(model) => {
                let set = crate::store::set_name(model.about.typology.as_ref()).to_owned();
                (Choice { set, why: "the model's".to_owned() }, model)
            }
            None => {
                let choice = self.choose(&network)?;
                bundled = bundled_model(&choice.set, self.algorithm)?;
                (choice, &bundled)
            }
        };
        let neighbours = self.neighbours.unwrap_or(model.about.neighbours);
        let result = in_plan::classify(&model.classifier, &network, &known, neighbours);
        let rooms = network
            .rooms
            .iter()
            .enumerate()
            .map(|(index, room)| Said {
                id: room.id,
                key: room.key.clone(),
                function: room.function.clone(),
                known: room.label,
                distribution: result.distributions[index],
                reason: model.classifier.explain(&result.features[index].values()).words(),
            })
            .collect();
        let InPlan { rounds, settled, .. } = result;
        Ok(SaidOfPlan { choice, model: model.name.clone(), neighbours, rounds, settled, rooms })
    }

    /// The set of models to use for a plan.
    fn choose(&self, network: &RoomNetwork) -> Result<Choice, CliError> {
        let sets: Vec<&str> = bundled_sets().collect();
        let stated = network.typology.as_ref().map(Typology::as_str);
        match self.typology.as_deref().map(str::trim) {
            Some(name) if name.eq_ignore_ascii_case("auto") => Ok(Self::infer(network)),
            Some(name) => match sets.iter().find(|set| set.eq_ignore_ascii_case(name)) {
                Some(set) => Ok(Choice { set: (*set).to_owned(), why: "as told".to_owned() }),
                None => Err(CliError::new(format!(
                    "there is no bundled model for the typology '{name}'; use auto or one of {}, or train one with 'enfilade train'",
                    sets.join(", ")
                ))),
            },
            None => match stated.filter(|stated| sets.contains(stated)) {
                Some(stated) => Ok(Choice { set: stated.to_owned(), why: "the plan's".to_owned() }),
                None => Ok(Self::infer(network)),
            },
        }
    }

    /// Infers the typology from the plan itself.
    fn infer(_network: &RoomNetwork) -> Choice {
        Choice { set: crate::study::STANDARD.to_owned(), why: "the plan has none".to_owned() }
    }

    /// Writes the predictions of the rooms without a label into a plan file; gives the file and their number.
    fn write(
        &self,
        file: &Path,
        storey: usize,
        storeys: usize,
        files: usize,
        plan: &Plan,
        said: &SaidOfPlan,
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
        for room in said.rooms.iter().filter(|room| room.known.is_none()) {
            let label = RoomLabel { label: room.distribution.label(), origin: LabelOrigin::Prediction };
            plan = edit::set_label(&plan, room.id, Some(label))?;
            written += 1;
        }
        save_plan(&target, &plan)?;
        Ok((target, written))
    }
}

/// How predictions compare with the labels that are known.
#[derive(Clone, Copy, Debug, Default)]
struct Agreement {
    known: usize,
    right: usize,
}

impl Agreement {
    fn of(rooms: &[Said]) -> Self {
        let known = || rooms.iter().filter(|room| room.known.is_some());
        let right = known().filter(|room| room.known == Some(room.distribution.label())).count();
        Self { known: known().count(), right }
    }

    fn add(&mut self, other: &Self) {
        self.known += other.known;
        self.right += other.right;
    }
}

impl std::fmt::Display for Agreement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { known, right } = self;
        match known {
            0 => f.write_str("no room has a label to compare with"),
            _ => write!(
                f,
                "{right} of {known} labelled rooms are said to be what they are ({:.0} %)",
                100.0 * *right as f64 / *known as f64
            ),
        }
    }
}

impl SaidOfPlan {
    fn print(&self, plan: &Plan, agreement: &Agreement, terminal: &mut Terminal) -> Result<(), CliError> {
        let name = if plan.meta().name.is_empty() { "Untitled plan" } else { &plan.meta().name };
        let width = |of: &dyn Fn(&Said) -> usize, least: usize| {
            self.rooms.iter().map(of).max().unwrap_or_default().clamp(least, 28)
        };
        let keys = width(&|room| room.key.chars().count(), 4);
        let functions = width(&|room| room.function.chars().count(), 8);
        let out = &mut terminal.out;
        writeln!(out, "{name}: typology {} ({}), model {}", self.choice.set, self.choice.why, self.model)?;
        if self.rooms.is_empty() {
            return Ok(writeln!(out, "  no rooms to classify")?);
        }
        writeln!(
            out,
            "  {:<keys$}  {:<functions$}  {:<11}  {:<11}  prob.  reason",
            "room", "function", "label", "predicted"
        )?;
        for room in &self.rooms {
            let said = room.distribution.label();
            let mark = if room.known.is_some_and(|known| known != said) { "≠" } else { " " };
            writeln!(
                out,
                "  {:<keys$}  {:<functions$}  {:<11}{mark} {:<11}  {:>3.0} %  {}",
                shortened(&room.key, keys),
                shortened(&room.function, functions),
                room.known.map_or("–", Label::name),
                said.name(),
                100.0 * room.distribution.probability(said),
                room.reason
            )?;
        }
        writeln!(out, "  {agreement}; neighbours' labels: {}", self.neighbours_in_words())?;
        Ok(())
    }

    fn neighbours_in_words(&self) -> String {
        match (self.neighbours, self.settled) {
            (NeighbourLabels::Predicted, true) => format!("predicted, stable after {} rounds", self.rounds),
            (NeighbourLabels::Predicted, false) => format!("predicted, not stable after {} rounds", self.rounds),
            (mode, _) => mode.name().to_owned(),
        }
    }

    fn json(&self, plan: &Plan, agreement: &Agreement) -> serde_json::Value {
        let probabilities = |distribution: &Distribution| {
            let rounded = |label: Label| (distribution.probability(label) * 1e4).round() / 1e4;
            Label::ALL
                .map(|label| (label.letter().to_owned(), json!(rounded(label))))
                .into_iter()
                .collect::<serde_json::Map<_, _>>()
        };
        let rooms: Vec<serde_json::Value> = self
            .rooms
            .iter()
            .map(|room| {
                json!({
                    "room": room.key,
                    "id": room.id.to_string(),
                    "function": room.function,
                    "label": room.known.map(Label::letter),
                    "predicted": room.distribution.label().letter(),
                    "probabilities": probabilities(&room.distribution),
                    "reason": room.reason,
                })
            })
            .collect();
        json!({
            "plan": plan.meta().name,
            "typology": self.choice.set,
            "typology_because": self.choice.why,
            "model": self.model,
            "neighbours": self.neighbours.name(),
            "rounds": self.rounds,
            "settled": self.settled,
            "labelled_rooms": agreement.known,
            "agreeing_rooms": agreement.right,
            "rooms": rooms,
        })
    }
}

/// A text of at most so many characters, cut with an ellipsis.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    text.chars().take(most.saturating_sub(1)).chain(['…']).collect()
}
