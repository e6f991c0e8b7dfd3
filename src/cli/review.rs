use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::batch::{self, Input};
use super::door::one_line;
use super::progress::with_progress;
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::base::wording::{count, shortened};
use crate::classify::models::Models;
use crate::formats::Import;
use crate::labels::Label;
use crate::plan::titles::printable;
use crate::review::{Decisions, Entry, FILE_NAME, FileSeen, Key, Material, Reason, Verdict, queue};
use crate::store;

/// `enfilade review`: where a person's look is worth most.
#[derive(clap::Args)]
pub struct ReviewCommand {
    /// A folder of plans with labelled rooms, or one plan
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Number of rooms to list, most worth a look first; 0 for all
    #[arg(long, value_name = "N", default_value_t = 20)]
    top: usize,
    /// List rooms that were accepted or corrected, too
    #[arg(long)]
    decided: bool,
    /// Folds for the classifiers that judge rooms they did not learn from; none splits a building
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..))]
    folds: usize,
    /// Seed for everything random: the same seed gives the same queue
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
    /// Print JSON (docs/json/review.md describes it)
    #[arg(long)]
    json: bool,
}

/// A room of the queue with what was decided about it.
struct Told<'a> {
    rank: usize,
    entry: &'a Entry,
    verdict: Option<Verdict>,
    note: String,
}

impl Subcommand for ReviewCommand {
    const NAME: &'static str = "review";
    const ABOUT: &'static str = "List the rooms whose labels are most worth a look, with reasons";
    const EXAMPLE: &'static str = "enfilade review plans --top 50";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let files = batch::inputs(std::slice::from_ref(&self.folder));
        let mut seen: Vec<FileSeen> = Vec::new();
        let work = |input: &Input, import: Import| {
            let name = input.within.to_string_lossy().replace('\\', "/");
            FileSeen::new(&name, store::content_of(&input.path), &import.plans, &schemes)
        };
        let failed = batch::for_each_import(&files, "reading plans", terminal, work, |_, file, _| {
            seen.push(file);
            Ok(())
        })?;
        let material = Material::new(seen);
        let found = with_progress("looking where a look is worth most", None, terminal, |work| {
            queue(&material, &schemes, &Models::bundled(), self.folds, self.seed, work)
        })?;
        let decisions = decisions_of(&self.folder, terminal)?;
        let all: Vec<Told<'_>> = found
            .entries
            .iter()
            .enumerate()
            .map(|(index, entry)| {
                let key = Key { file: entry.row.file.clone(), room: entry.row.id.clone() };
                let decision = decisions.of(&key);
                let verdict = decision.and_then(|decision| decision.verdict_on(entry.row.label));
                let note = decision.map(|decision| decision.note.clone()).unwrap_or_default();
                Told { rank: index + 1, entry, verdict, note }
            })
            .collect();
        let is_done = |told: &&Told<'_>| matches!(told.verdict, Some(Verdict::Accepted | Verdict::Corrected));
        let done = all.iter().filter(is_done).count();
        let mut listed: Vec<&Told<'_>> = all.iter().filter(|told| self.decided || !is_done(told)).collect();
        // What was left for later comes later.
        listed.sort_by_key(|told| told.verdict == Some(Verdict::Skipped));
        if self.top > 0 {
            listed.truncate(self.top);
        }
        if self.json {
            let report = json!({
                "version": 1,
                "rooms": all.len(),
                "decided": done,
                "notes": found.notes,
                "queue": listed.iter().map(|told| told.json()).collect::<Vec<_>>(),
            });
            serde_json::to_writer_pretty(&mut terminal.out, &report)?;
            writeln!(terminal.out)?;
        } else {
            print(&listed, all.len(), done, &found.notes, terminal)?;
        }
        Ok(if failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The decisions that are kept in the folder; what is wrong with their file is said.
fn decisions_of(folder: &Path, terminal: &mut Terminal) -> Result<Decisions, CliError> {
    let path = folder.join(FILE_NAME);
    if !path.is_file() {
        return Ok(Decisions::default());
    }
    let bytes = std::fs::read(&path).map_err(|error| CliError::new(format!("{}: {error}", path.display())))?;
    let read = Decisions::read(&bytes);
    if let Some(broken) = read.broken {
        terminal.error(format!("{}: {broken}", path.display()))?;
    }
    Ok(read.decisions)
}

impl Told<'_> {
    fn json(&self) -> Value {
        let (entry, row) = (self.entry, &self.entry.row);
        let rounded = |share: f64| (share * 1e4).round() / 1e4;
        let probabilities: serde_json::Map<String, Value> = Label::ALL
            .into_iter()
            .map(|label| (label.letter().to_owned(), json!(rounded(entry.said.probability(label)))))
            .collect();
        let reason = |reason: &Reason| json!({ "kind": reason.name(), "words": reason.words() });
        json!({
            "rank": self.rank,
            "file": row.file,
            "plan_of_file": entry.storey_of_file + 1,
            "id": row.id,
            "building": row.building,
            "typology": row.typology.as_ref().map(crate::labels::Typology::as_str),
            "plan": row.plan,
            "room": row.room,
            "function": row.function,
            "label": row.label.letter(),
            "label_origin": row.label_origin,
            "rather": entry.other().letter(),
            "probabilities": probabilities,
            "worth": rounded(entry.worth),
            "reasons": entry.reasons.iter().map(reason).collect::<Vec<_>>(),
            "decision": self.verdict.map(Verdict::name),
            "note": self.note,
        })
    }
}

fn print(
    listed: &[&Told<'_>],
    rooms: usize,
    done: usize,
    notes: &[String],
    terminal: &mut Terminal,
) -> Result<(), CliError> {
    let out = &mut terminal.out;
    writeln!(out, "{}, {done} decided; the {} most worth a look:\n", count(rooms, "labelled room"), listed.len())?;
    for told in listed {
        let (entry, row) = (told.entry, &told.entry.row);
        let other = entry.other();
        let function = if row.function.is_empty() { String::new() } else { format!(", {}", printable(&row.function)) };
        writeln!(
            out,
            "{:>4}  {:<11} {:>3.0} %  rather {:<11} {:>3.0} %  {}{} ({}) in {}{}",
            told.rank,
            row.label.name(),
            100.0 * entry.said.probability(row.label),
            other.name(),
            100.0 * entry.said.probability(other),
            shortened(&printable(&row.room), 28),
            shortened(&function, 28),
            row.id,
            one_line(&row.file),
            told.verdict.map(|verdict| format!(", {}", verdict.name())).unwrap_or_default(),
        )?;
        for reason in &entry.reasons {
            writeln!(out, "      {}", one_line(&reason.words()))?;
        }
        if !told.note.is_empty() {
            writeln!(out, "      Note: {}", one_line(&told.note))?;
        }
    }
    for note in notes {
        writeln!(out, "\n{note}")?;
    }
    writeln!(
        out,
        "\nA label may still be right: look at the room. The window goes through this queue: open the folder, then \
         'Review the labels…'."
    )?;
    Ok(())
}
