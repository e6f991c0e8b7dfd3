use std::io::Write as _;
use std::sync::Arc;

use super::{CliError, Outcome, Subcommand, Terminal};
use crate::classify::{
    Method,
    models::{StoredModel, bundled_model, bundled_sets},
};
use crate::dataset::sets::set_name;
use crate::store::{models_folder, models_in};

/// `enfilade models`: the classifiers at hand.
#[derive(clap::Args)]
pub struct ModelsCommand {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Subcommand for ModelsCommand {
    const NAME: &'static str = "models";
    const ABOUT: &'static str = "List the bundled models and your own";
    const EXAMPLE: &'static str = "enfilade models";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let mut models: Vec<Arc<StoredModel>> = Vec::new();
        for set in bundled_sets() {
            for method in Method::ALL {
                models.push(bundled_model(set, method)?);
            }
        }
        let folder = models_folder();
        let (own, errors) = folder.as_deref().map(models_in).unwrap_or_default();
        let own_count = own.len();
        models.extend(own.into_iter().map(Arc::new));
        for error in &errors {
            writeln!(terminal.err, "enfilade: {error}")?;
        }
        if self.json {
            let objects: Vec<serde_json::Value> = models.iter().map(|model| json(model)).collect();
            serde_json::to_writer_pretty(&mut terminal.out, &objects)?;
            writeln!(terminal.out)?;
        } else {
            print(&models, terminal)?;
            if let (0, Some(folder)) = (own_count, folder) {
                writeln!(terminal.out, "\nYour own models go into {}: none yet.", folder.display())?;
            }
        }
        Ok(if errors.is_empty() { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The accuracy of the cross-validation that dealt these units to folds.
fn accuracy(model: &StoredModel, folds_by: &str) -> Option<f64> {
    model.about.scores.iter().find(|scores| scores.folds_by == folds_by).map(|scores| scores.accuracy)
}

fn json(model: &StoredModel) -> serde_json::Value {
    serde_json::json!({
        "name": model.name,
        "path": model.path,
        "typology": set_name(model.about.typology.as_ref()),
        "algorithm": model.classifier.method().name(),
        "neighbours": model.about.neighbours.name(),
        "rooms": model.about.data.rooms,
        "buildings": model.about.data.buildings,
        "accuracy_by_room": accuracy(model, "room"),
        "accuracy_by_building": accuracy(model, "building"),
        "command": model.about.command,
        "licence": model.about.licence,
    })
}

fn print(models: &[Arc<StoredModel>], terminal: &mut Terminal) -> Result<(), CliError> {
    let width = models.iter().map(|model| model.name.chars().count()).max().unwrap_or_default().max(5);
    let out = &mut terminal.out;
    writeln!(
        out,
        "{:<width$}  typology  algorithm                rooms  buildings  by room  by building  from",
        "model"
    )?;
    for model in models {
        let percent = |share: Option<f64>| share.map_or("–".to_owned(), |share| format!("{:.1} %", 100.0 * share));
        writeln!(
            out,
            "{:<width$}  {:<8}  {:<21}  {:>7}  {:>9}  {:>7}  {:>11}  {}",
            model.name,
            set_name(model.about.typology.as_ref()),
            model.classifier.method().title(),
            model.about.data.rooms,
            model.about.data.buildings,
            percent(accuracy(model, "room")),
            percent(accuracy(model, "building")),
            model.path.as_ref().map_or("bundled".to_owned(), |path| path.display().to_string()),
        )?;
    }
    writeln!(
        out,
        "\nAccuracy in cross-validation, with neighbours' labels predicted as in use unless a model says otherwise (--json)."
    )?;
    Ok(())
}
