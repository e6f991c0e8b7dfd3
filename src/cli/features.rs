use crate::plan::titles::room_keys;
use std::path::PathBuf;

use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::dataset::csv::feature_cells;
use crate::features::{Features, NeighbourLabels, analyse};
use crate::labels::Label;

/// `enfilade features`: the features of every room.
#[derive(clap::Args)]
pub struct FeaturesCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// Write the table here instead of to stdout
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Print JSON instead of CSV
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    shared: FeatureOptions,
}

/// Options of every subcommand that computes features.
#[derive(clap::Args)]
pub struct FeatureOptions {
    /// Which labels of its neighbours a room counts: 'true' (where known, else temporary) or
    /// 'temporary' (the naive classifier's for all)
    #[arg(long, value_name = "MODE", default_value = "true", value_parser = neighbour_labels)]
    pub neighbours: NeighbourLabels,
    /// Label scheme that extends the bundled ones (may be given several times)
    #[arg(long, value_name = "FILE.scheme.toml")]
    pub scheme: Vec<PathBuf>,
}

fn neighbour_labels(word: &str) -> Result<NeighbourLabels, String> {
    inputs::one_of(word, &NeighbourLabels::WITHOUT_CLASSIFIER, NeighbourLabels::name)
}

impl Subcommand for FeaturesCommand {
    const NAME: &'static str = "features";
    const ABOUT: &'static str = "Print the features F_r of every room";
    const EXAMPLE: &'static str = "enfilade features plans/office.plan.json -o rooms.csv";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.shared.scheme)?;
        let files = inputs::plan_files(&self.plans)?;
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut objects: Vec<serde_json::Value> = Vec::new();
        let head = ["plan", "room", "function", "label"];
        writer.write_record(head.into_iter().chain(Features::NAMES))?;
        let failed = inputs::for_each_plan(&files, terminal, |_, import, _| {
            for plan in &import.plans {
                let analysis = analyse(plan, &schemes, self.shared.neighbours);
                for (id, key) in room_keys(plan) {
                    let (Some(room), Some(result)) = (plan.room(id), analysis.room(id)) else { continue };
                    let label = result.status.label().map(Label::letter).unwrap_or_default();
                    let texts = [plan.meta().name.as_str(), &key, &room.function, label];
                    if self.json {
                        let mut object = serde_json::Map::new();
                        for (name, text) in head.into_iter().zip(texts) {
                            object.insert(
                                name.to_owned(),
                                if text.is_empty() { serde_json::Value::Null } else { text.into() },
                            );
                        }
                        for (index, name) in Features::NAMES.into_iter().enumerate() {
                            let value = result.features.map(|features| features.values()[index]);
                            object.insert(name.to_owned(), value.map(rounded).into());
                        }
                        objects.push(object.into());
                    } else {
                        let cells = result.features.as_ref().map(feature_cells).unwrap_or_default();
                        writer.write_record(texts.into_iter().map(str::to_owned).chain(cells))?;
                    }
                }
            }
            Ok(())
        })?;
        let bytes = if self.json {
            let mut text = serde_json::to_vec_pretty(&objects)?;
            text.push(b'\n');
            text
        } else {
            writer.into_inner().map_err(|error| CliError::new(error.to_string()))?
        };
        inputs::write_result(self.output.as_deref(), &bytes, terminal)?;
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// A number as JSON: a whole one without a decimal point, else at most six decimals.
fn rounded(value: f64) -> serde_json::Value {
    let value = (value * 1e6).round() / 1e6;
    if value.fract() == 0.0 && value.abs() < 1e15 { (value as i64).into() } else { value.into() }
}
