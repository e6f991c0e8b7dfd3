use std::io::Write as _;
use std::path::PathBuf;

use super::call::quoted;
use super::collect::{CollectOptions, Collected, FoldsFrom, collect, grouping, neighbour_labels};
use super::manifest::{self, Manifest};
use super::outputs::{Outputs, must_be_folder};
use super::predictions::save_predictions;
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::dataset::folds::Grouping;
use crate::features::NeighbourLabels;
use crate::gather::sha256;
use crate::study::{About, Options, report, study_with_predictions};

/// `enfilade evaluate`: the paper's study on one's own data.
#[derive(clap::Args)]
pub struct EvaluateCommand {
    #[command(flatten)]
    collect: CollectOptions,
    /// Folds of each cross-validation: their number, or a table (.csv) with the columns file, id, fold, such as a
    /// dataset
    #[arg(long, value_name = "N|FILE", default_value = "10", value_parser = FoldsFrom::read)]
    folds: FoldsFrom,
    /// Assign single rooms ('room', as in the paper) or whole buildings ('building', so that test buildings are new)
    /// to folds [default: 'room', unless a table of folds splits no building]
    #[arg(long, value_name = "UNIT", value_parser = grouping)]
    by: Option<Grouping>,
    /// Neighbours' labels: 'true' (as in the paper), 'temporary' (the naive classifier's) or 'predicted' (repeated
    /// until stable)
    #[arg(long, value_name = "MODE", default_value = "true", value_parser = neighbour_labels)]
    neighbours: NeighbourLabels,
    /// Seed for everything random: the same seed gives the same bytes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write the predictions for each room by classifiers that did not learn from it (CSV): a line per room, set and
    /// algorithm, for new buildings and under the report's condition
    #[arg(long, value_name = "FILE.csv")]
    predictions: Option<PathBuf>,
    /// Put an apostrophe before texts in the predictions that begin with = + - @, so that spreadsheets do not run
    /// them as formulas
    #[arg(long)]
    guard_formulas: bool,
    /// The date to print on the report [default: none]
    #[arg(long, value_name = "TEXT")]
    date: Option<String>,
    /// Folder for the report: report.html, report.json and a CSV file for each table
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Also print the report as JSON
    #[arg(long)]
    json: bool,
}

impl Subcommand for EvaluateCommand {
    const NAME: &'static str = "evaluate";
    const ABOUT: &'static str = "Compare the classifiers on labelled plans, and with the paper's figures";
    const EXAMPLE: &'static str = "enfilade evaluate schools offices houses --most-rooms 2000 -o study";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        must_be_folder(&self.output)?;
        let mut outputs = Outputs::new(terminal);
        let mut collected = collect(&self.collect, self.seed, terminal)?;
        let given = collected.folds_of(&self.folds, self.by, terminal)?;
        let options = Options {
            folds: self.folds.count(),
            grouping: given.or(self.by).unwrap_or(Grouping::Room),
            neighbours: self.neighbours,
            seed: self.seed,
            given: given.is_some(),
        };
        let Collected { collection, blind, failed, read } = collected;
        let (mut study, predictions) = with_progress("evaluating", None, terminal, |work| {
            study_with_predictions(&collection, &blind, options, work)
        })?;
        let hashes: Vec<&str> = read.sources.iter().map(|source| source.sha256.as_str()).collect();
        study.about = About {
            command: self.command_line(),
            data: self.collect.data.iter().map(|path| path.display().to_string()).collect(),
            files: read.sources.len(),
            sha256: sha256(hashes.join("\n").as_bytes()),
            date: self.date.clone(),
        };
        let files = report::files(&study)?;
        outputs.folder(&self.output)?;
        for (name, bytes) in &files {
            outputs.save_in(&self.output, name, bytes, terminal)?;
            if self.json && name == "report.json" {
                terminal.out.write_all(bytes)?;
            }
        }
        let told = serde_json::to_value(&study.about)?;
        let told = Manifest::of_folder(files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())))
            .with("study", told)
            .with_plans(&read);
        manifest::save(told, &self.output.join("report.csv"), None, &mut outputs, terminal)?;
        if let Some(path) = &self.predictions {
            let rows = collection.rows(NeighbourLabels::True).unwrap_or_default();
            save_predictions(path, &rows, &predictions, self.guard_formulas, &read, &mut outputs, terminal)?;
        }
        if !self.json {
            terminal.out.write_all(report::summary(&study).as_bytes())?;
            writeln!(terminal.out)?;
            terminal.report(format!("The report: {}", self.output.join("report.html").display()))?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

impl EvaluateCommand {
    /// The call that makes this report: what the numbers depend on, and nothing else.
    fn command_line(&self) -> String {
        let mut words = vec!["enfilade evaluate".to_owned()];
        words.extend(self.collect.words());
        let folds = match &self.folds {
            FoldsFrom::Count(count) => count.to_string(),
            FoldsFrom::File(file) => quoted(&file.to_string_lossy()),
        };
        words.push(format!("--folds {folds}"));
        words.extend(self.by.map(|by| format!("--by {}", by.name())));
        words.push(format!("--neighbours {} --seed {}", self.neighbours.name(), self.seed));
        words.join(" ")
    }
}
