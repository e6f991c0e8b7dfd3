use std::io::Write as _;
use std::path::PathBuf;

use super::collect::{CollectOptions, Collected, collect, neighbour_labels};
use super::outputs::{Outputs, must_be_folder};
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::dataset::folds::Grouping;
use crate::features::NeighbourLabels;
use crate::study::{Options, report, study};

/// `enfilade evaluate`: the paper's study on one's own data.
#[derive(clap::Args)]
pub struct EvaluateCommand {
    #[command(flatten)]
    collect: CollectOptions,
    /// Folds of each cross-validation
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = folds)]
    folds: usize,
    /// What is assigned to folds: 'room', as in the paper, or 'building', which none is tested on that was
    /// learned from
    #[arg(long, value_name = "UNIT", default_value = "room", value_parser = grouping)]
    by: Grouping,
    /// Neighbours' labels: 'true' (given, as in the paper), 'temporary' (the naive classifier's) or
    /// 'predicted' (repeated until stable)
    #[arg(long, value_name = "MODE", default_value = "true", value_parser = neighbour_labels)]
    neighbours: NeighbourLabels,
    /// Seed of all that is random: the same seed gives the same bytes
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Folder for the report: report.html, report.json and a CSV file for each table
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print the report's JSON as well
    #[arg(long)]
    json: bool,
}

/// A number of folds, as an option's value.
fn folds(word: &str) -> Result<usize, String> {
    word.parse().ok().filter(|&folds| folds >= 2).ok_or_else(|| "use a whole number from 2 up".to_owned())
}

/// What is assigned to folds, as an option's value.
fn grouping(word: &str) -> Result<Grouping, String> {
    inputs::one_of(word, &Grouping::ALL, Grouping::name)
}

impl Subcommand for EvaluateCommand {
    const NAME: &'static str = "evaluate";
    const ABOUT: &'static str = "Compare the classifiers on labelled plans, beside the paper's figures";
    const EXAMPLE: &'static str = "enfilade evaluate schools offices houses --most-rooms 2000 -o study";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        must_be_folder(&self.output)?;
        let mut outputs = Outputs::new(terminal);
        let Collected { collection, blind, failed } = collect(&self.collect, self.seed, terminal)?;
        let options = Options { folds: self.folds, grouping: self.by, neighbours: self.neighbours, seed: self.seed };
        let study = with_progress("evaluating", None, terminal, |work| study(&collection, &blind, options, work))?;
        let files = report::files(&study)?;
        outputs.folder(&self.output)?;
        for (name, bytes) in &files {
            outputs.save_in(&self.output, name, bytes, terminal)?;
            if self.json && name == "report.json" {
                terminal.out.write_all(bytes)?;
            }
        }
        if !self.json {
            terminal.out.write_all(report::summary(&study).as_bytes())?;
            writeln!(terminal.out)?;
            terminal.report(format!("The report: {}", self.output.join("report.html").display()))?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}
