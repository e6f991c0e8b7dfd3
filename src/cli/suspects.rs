use std::io::Write as _;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::collect::{CollectOptions, FoldsFrom, collect};
use super::door::one_line;
use super::manifest;
use super::outputs::{Care, Outputs};
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::base::wording::{count, shortened};
use crate::dataset::Row;
use crate::dataset::csv::Guard;
use crate::labels::{Label, Meaning, Schemes};
use crate::plan::titles::printable;
use crate::study::suspects::{Suspect, contradiction, suspects};

/// `enfilade suspects`: labels that are probably wrong.
#[derive(clap::Args)]
pub struct SuspectsCommand {
    #[command(flatten)]
    collect: CollectOptions,
    /// Number of rooms to list, most suspicious first; 0 for all
    #[arg(long, value_name = "N", default_value_t = 40)]
    most: usize,
    /// Folds: their number, or a table (.csv) with the columns file, id, fold that splits no building
    #[arg(long, value_name = "N|FILE", default_value = "10", value_parser = FoldsFrom::read)]
    folds: FoldsFrom,
    /// Seed for everything random: the same seed gives the same list
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write the list of all rooms here (CSV); correct its column 'label', and 'enfilade label' applies it
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Put an apostrophe before texts that begin with = + - @, so that spreadsheets do not run them as formulas
    #[arg(long)]
    guard_formulas: bool,
    /// Print JSON (docs/json/suspects.md describes it)
    #[arg(long)]
    json: bool,
}

impl Subcommand for SuspectsCommand {
    const NAME: &'static str = "suspects";
    const ABOUT: &'static str = "List labels that are probably wrong, with reasons";
    const EXAMPLE: &'static str = "enfilade suspects plans --most 100 -o suspects.csv";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.collect.scheme)?;
        let mut collected = collect(&self.collect, self.seed, terminal)?;
        let by = Some(crate::dataset::folds::Grouping::Building);
        let given = collected.folds_of(&self.folds, by, terminal)?.is_some();
        let found = with_progress("looking for suspicious labels", None, terminal, |work| {
            suspects(&collected.collection, self.folds.count(), self.seed, given, work)
        })?;
        let told: Vec<Told<'_>> = found.iter().map(|suspect| Told::new(suspect, &schemes)).collect();
        if let Some(path) = &self.output {
            let bytes = table(&told, if self.guard_formulas { Guard::On } else { Guard::Off })?;
            let mut outputs = Outputs::new(terminal);
            outputs.save(path, &bytes, Care::Flushed, terminal)?;
            if manifest::is_file(path) {
                let told = manifest::of_table(path, &bytes, told.len())
                    .with_plans(&collected.read)
                    .with_schemes(&schemes, &self.collect.scheme);
                manifest::save(told, path, None, &mut outputs, terminal)?;
            }
        }
        let most = if self.most == 0 { told.len() } else { self.most.min(told.len()) };
        if self.json {
            let rooms: Vec<Value> = told[..most].iter().enumerate().map(|(at, told)| told.json(at + 1)).collect();
            let report = json!({ "version": 1, "rooms_judged": told.len(), "rooms": rooms });
            serde_json::to_writer_pretty(&mut terminal.out, &report)?;
            writeln!(terminal.out)?;
        } else if self.output.is_some() {
            terminal
                .remark(format!("{} judged by classifiers that did not learn from them", count(told.len(), "room")))?;
        } else {
            print(&told, most, terminal)?;
        }
        Ok(if collected.failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// A suspect with all that speaks against its label.
struct Told<'a> {
    suspect: &'a Suspect,
    reason: String,
}

impl<'a> Told<'a> {
    fn new(suspect: &'a Suspect, schemes: &Schemes) -> Self {
        let row = &suspect.row;
        let by_scheme = match schemes.meaning(row.typology.as_ref(), &row.function) {
            Some(Meaning::Labelled(label)) => Some(label),
            _ => None,
        };
        let reasons = [contradiction(row, by_scheme).unwrap_or_default(), suspect.reason.clone()];
        let reason = reasons.into_iter().filter(|reason| !reason.is_empty()).collect::<Vec<_>>().join(" ");
        Self { suspect, reason }
    }

    fn row(&self) -> &Row {
        &self.suspect.row
    }

    fn json(&self, rank: usize) -> Value {
        let row = self.row();
        let rounded = |label: Label| (self.suspect.said.probability(label) * 1e4).round() / 1e4;
        let probabilities: serde_json::Map<String, Value> =
            Label::ALL.into_iter().map(|label| (label.letter().to_owned(), json!(rounded(label)))).collect();
        json!({
            "rank": rank,
            "file": row.file,
            "id": row.id,
            "building": row.building,
            "plan": row.plan,
            "room": row.room,
            "function": row.function,
            "label": row.label.letter(),
            "label_origin": row.label_origin,
            "predicted": self.suspect.said.label().letter(),
            "probabilities": probabilities,
            "reason": self.reason,
        })
    }
}

/// All rooms as a table.
fn table(told: &[Told<'_>], guard: Guard) -> Result<Vec<u8>, CliError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "rank",
        "file",
        "id",
        "building",
        "typology",
        "plan",
        "room",
        "function",
        "label",
        "label_origin",
        "probability",
        "predicted",
        "predicted_probability",
        "reason",
    ])?;
    for (at, told) in told.iter().enumerate() {
        let row = told.row();
        let said = &told.suspect.said;
        let typology = row.typology.as_ref().map(crate::labels::Typology::as_str).unwrap_or_default();
        let texts = [&row.file, &row.id, &row.building, typology, &row.plan, &row.room, &row.function];
        let cells = [(at + 1).to_string()].into_iter().chain(texts.into_iter().map(|text| guard.cell(text))).chain([
            row.label.letter().to_owned(),
            row.label_origin.clone(),
            format!("{:.4}", told.suspect.probability()),
            said.label().letter().to_owned(),
            format!("{:.4}", said.sureness()),
            guard.cell(&told.reason),
        ]);
        writer.write_record(cells)?;
    }
    writer.into_inner().map_err(|error| CliError::new(error.to_string()))
}

fn print(told: &[Told<'_>], most: usize, terminal: &mut Terminal) -> Result<(), CliError> {
    let out = &mut terminal.out;
    writeln!(
        out,
        "{} judged by classifiers that did not learn from them; the {most} least probable labels:\n",
        count(told.len(), "room")
    )?;
    for (at, told) in told[..most].iter().enumerate() {
        let row = told.row();
        let said = &told.suspect.said;
        let (label, predicted) = (row.label, said.label());
        let function = if row.function.is_empty() { String::new() } else { format!(", {}", printable(&row.function)) };
        writeln!(
            out,
            "{:>4}  {:<11} {:>3.0} %  rather {:<11} {:>3.0} %  {}{} ({}) in {}",
            at + 1,
            label.name(),
            100.0 * said.probability(label),
            predicted.name(),
            100.0 * said.probability(predicted),
            shortened(&printable(&row.room), 28),
            shortened(&function, 28),
            row.id,
            one_line(&row.file),
        )?;
        if !told.reason.is_empty() {
            writeln!(out, "      {}", told.reason)?;
        }
    }
    writeln!(
        out,
        "\nA label may still be right: look at the room. 'enfilade label' applies a table of corrections (file, id, \
         label)."
    )?;
    Ok(())
}
