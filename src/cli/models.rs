use std::io::Write as _;
use std::sync::Arc;

use super::classify::ModelsOption;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::classify::models::StoredModel;

/// `enfilade models`: the classifiers at hand.
#[derive(clap::Args)]
pub struct ModelsCommand {
    #[command(flatten)]
    models: ModelsOption,
    /// Print JSON (docs/json/models.md describes it)
    #[arg(long)]
    json: bool,
}

impl Subcommand for ModelsCommand {
    const NAME: &'static str = "models";
    const ABOUT: &'static str = "List the bundled models and your own";
    const EXAMPLE: &'static str = "enfilade models";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let (at_hand, failed) = self.models.read(terminal)?;
        let models = at_hand.all()?;
        if self.json {
            let objects: Vec<serde_json::Value> = models.iter().map(|model| json(model)).collect();
            serde_json::to_writer_pretty(&mut terminal.out, &serde_json::json!({ "version": 1, "models": objects }))?;
            writeln!(terminal.out)?;
        } else {
            print(&models, terminal)?;
            if let (true, Some(folder)) = (at_hand.own().is_empty(), self.models.folder()) {
                writeln!(terminal.out, "\nYour own models go into {}: none yet.", folder.display())?;
            }
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The accuracy of the cross-validation with folds by this unit.
fn accuracy(model: &StoredModel, folds_by: &str) -> Option<f64> {
    model.about.scores.iter().find(|scores| scores.folds_by == folds_by).map(|scores| scores.accuracy)
}

fn json(model: &StoredModel) -> serde_json::Value {
    serde_json::json!({
        "name": model.name,
        "path": model.path,
        "typology": model.set(),
        "algorithm": model.method().name(),
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
            model.set(),
            model.method().title(),
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
