use std::path::PathBuf;

use serde_json::json;

use super::batch::{self, Input};
use super::manifest;
use super::numbers::rounded;
use super::outputs::Outputs;
use super::scales::PlanScale;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::dataset::{BY_SCHEME, csv::cell, csv::feature_cells};
use crate::features::{Features, NeighbourLabels};
use crate::formats::Import;
use crate::labels::{Label, Schemes, Typology};
use crate::pipeline::Pipeline;
use crate::plan::titles::room_keys;
use crate::plan::{Plan, RoomId};
use crate::store;

/// `enfilade features`: the features of every room.
#[derive(clap::Args)]
pub struct FeaturesCommand {
    /// Plans, or folders of plans, of any known format
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// Write the table here instead of to stdout
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print JSON instead of CSV (docs/json/features.md describes it)
    #[arg(long)]
    json: bool,
    /// Add the clear area of every room, between wall faces, as the column 'net'
    #[arg(long)]
    net: bool,
    /// Instead of rooms, print what the widths of doors and the areas of rooms say about each plan's scale
    /// (docs/scale.md)
    #[arg(long, conflicts_with = "net")]
    scale: bool,
    #[command(flatten)]
    shared: FeatureOptions,
}

/// Options of every subcommand that computes features.
#[derive(clap::Args)]
pub struct FeatureOptions {
    /// Neighbours' labels to count: 'true' (where known, else temporary) or 'temporary' (the naive classifier's for
    /// all)
    #[arg(long, value_name = "MODE", default_value = "true", value_parser = neighbour_labels)]
    pub neighbours: NeighbourLabels,
    /// Label scheme to add to the bundled ones (can be repeated)
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
        let files = batch::inputs_into(&self.plans, self.output.as_deref());
        if self.scale {
            return self.scales(&files, &schemes, terminal);
        }
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut objects: Vec<serde_json::Value> = Vec::new();
        let mut rooms_written = 0;
        writer.write_record(HEAD.into_iter().chain(Features::NAMES).chain(self.net.then_some(NET)))?;
        let rooms = |input: &Input, import: Import| -> Vec<RoomFeatures> {
            let file = input.path.display().to_string();
            import.plans.iter().flat_map(|plan| self.rooms(plan, &file, &schemes)).collect()
        };
        let failed = batch::for_each_import(&files, "computing features", terminal, rooms, |_, rooms, _| {
            for room in rooms {
                if self.json {
                    objects.push(room.json());
                } else {
                    rooms_written += 1;
                    writer.write_record(room.cells())?;
                }
            }
            Ok(())
        })?;
        let bytes = if self.json {
            let mut text = serde_json::to_vec_pretty(&serde_json::json!({ "version": 1, "rooms": objects }))?;
            text.push(b'\n');
            text
        } else {
            writer.into_inner().map_err(|error| CliError::new(error.to_string()))?
        };
        let mut outputs = Outputs::new(terminal);
        outputs.result(self.output.as_deref(), &bytes, terminal)?;
        if let Some(path) = self.output.as_deref().filter(|path| !self.json && manifest::is_file(path)) {
            let source = |file: &Input| json!({ "file": file.path.display().to_string(), "sha256": store::content_of(&file.path) });
            let told = manifest::of_table(path, &bytes, rooms_written)
                .with("neighbours", json!(self.shared.neighbours.name()))
                .with("sources", files.iter().map(source).collect())
                .with_schemes(&schemes, &self.shared.scheme);
            manifest::save(told, path, None, &mut outputs, terminal)?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The columns that identify a room, before its features.
const HEAD: [&str; 10] =
    ["file", "id", "building", "typology", "storey", "plan", "room", "function", "label", "label_origin"];

/// The column of clear areas.
const NET: &str = "net";

/// A room with its features, if it has an area.
struct RoomFeatures {
    /// The texts for [`HEAD`].
    texts: [String; 10],
    features: Option<Features>,
    /// The clear area in m², if it is asked for; within, `None` for a room without an area.
    net_m2: Option<Option<f64>>,
}

impl FeaturesCommand {
    /// Prints what doors and rooms say about each plan's scale.
    fn scales(&self, files: &[Input], schemes: &Schemes, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut objects: Vec<serde_json::Value> = Vec::new();
        writer.write_record(PlanScale::head())?;
        let scales = |input: &Input, import: Import| -> Vec<PlanScale> {
            let file = input.path.display().to_string();
            import.plans.iter().map(|plan| PlanScale::of(plan, &file, schemes)).collect()
        };
        let failed = batch::for_each_import(files, "weighing scales", terminal, scales, |_, scales, _| {
            for scale in scales {
                if self.json {
                    objects.push(scale.json());
                } else {
                    writer.write_record(scale.cells())?;
                }
            }
            Ok(())
        })?;
        let bytes = if self.json {
            let mut text = serde_json::to_vec_pretty(&json!({ "version": 1, "plans": objects }))?;
            text.push(b'\n');
            text
        } else {
            writer.into_inner().map_err(|error| CliError::new(error.to_string()))?
        };
        Outputs::new(terminal).result(self.output.as_deref(), &bytes, terminal)?;
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }

    fn rooms(&self, plan: &Plan, file: &str, schemes: &Schemes) -> Vec<RoomFeatures> {
        let pipeline = Pipeline::counting(plan, schemes, self.shared.neighbours);
        let analysis = pipeline.analysis();
        let room = |(id, key): (RoomId, String)| {
            let (room, result) = (plan.room(id)?, analysis.room(id)?);
            let label = result.status.label().map(Label::letter).unwrap_or_default();
            let origin = match (label, room.label) {
                ("", _) => "",
                (_, Some(own)) => own.origin.name(),
                (_, None) => BY_SCHEME,
            };
            let meta = plan.meta();
            let building = meta.building_or_name();
            let typology = meta.typology.as_ref().map(Typology::as_str).unwrap_or_default();
            let (room_id, id) = (id, id.to_string());
            let texts = [file, &id, building, typology, &meta.storey, &meta.name, &key, &room.function, label, origin];
            let texts = texts.map(str::to_owned);
            let net_m2 = self.net.then(|| analysis.net(room_id).map(|net| net.area_m2));
            Some(RoomFeatures { texts, features: result.features, net_m2 })
        };
        room_keys(plan).into_iter().filter_map(room).collect()
    }
}

impl RoomFeatures {
    fn json(self) -> serde_json::Value {
        let mut object = serde_json::Map::new();
        for (name, text) in HEAD.into_iter().zip(self.texts) {
            let text = if text.is_empty() { serde_json::Value::Null } else { text.into() };
            object.insert(name.to_owned(), text);
        }
        for (index, name) in Features::NAMES.into_iter().enumerate() {
            let value = self.features.map(|features| features.values()[index]);
            object.insert(name.to_owned(), value.map(rounded).into());
        }
        if let Some(net_m2) = self.net_m2 {
            object.insert(NET.to_owned(), net_m2.map(rounded).into());
        }
        object.into()
    }

    fn cells(self) -> impl Iterator<Item = String> {
        let cells = self.features.as_ref().map(feature_cells).unwrap_or_default();
        let net = self.net_m2.map(|net_m2| net_m2.map(cell).unwrap_or_default());
        self.texts.into_iter().chain(cells).chain(net)
    }
}
