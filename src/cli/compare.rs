use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::batch::{self, Input};
use super::door::one_line;
use super::outputs::{Care, Outputs};
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::base::wording::count;
use crate::classify::Confusion;
use crate::dataset::csv::Guard;
use crate::labels::Label;
use crate::plan::Plan;
use crate::plan::titles::printable;
use crate::review::agreement::{Agreement, table_of};
use crate::review::compare::{Compared, Pair, Prefer, compare, merged};
use crate::store::checked_bytes;

/// `enfilade compare`: how far two people's labels agree.
#[derive(clap::Args)]
pub struct CompareCommand {
    /// A plan, or a folder of plans
    #[arg(value_name = "FIRST")]
    first: PathBuf,
    /// The same plans, labelled by somebody else: a plan, or a folder with files of the same names
    #[arg(value_name = "SECOND")]
    second: PathBuf,
    /// Write a table of the rooms that differ here (CSV); fill its columns 'label' or 'function', and 'enfilade label' applies it
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Write plans made of both into this folder
    #[arg(long, value_name = "FOLDER")]
    merged: Option<PathBuf>,
    /// Whose word counts in the merged plans where both labelled a room differently: first, second, or neither, which leaves the
    /// room without a label
    #[arg(long, value_name = "WHOSE", default_value = "neither", requires = "merged",
        value_parser = |word: &str| inputs::one_of(word, &Prefer::ALL, Prefer::name))]
    prefer: Prefer,
    /// Put an apostrophe before texts that begin with = + - @, so that spreadsheets do not run them as formulas
    #[arg(long)]
    guard_formulas: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
    /// Print JSON (docs/json/compare.md describes it)
    #[arg(long)]
    json: bool,
}

/// Two readings of one plan.
struct Both {
    file: PathBuf,
    /// Which plan of its file.
    storey: usize,
    plan: String,
    input: Input,
    plans: [Plan; 2],
    compared: Compared,
}

impl Subcommand for CompareCommand {
    const NAME: &'static str = "compare";
    const ABOUT: &'static str = "Compare two people's labels of the same plans: agreement, kappa, differences";
    const EXAMPLE: &'static str = "enfilade compare anna ben -o differences.csv";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let mut is_whole = true;
        let sides = [&self.first, &self.second].map(|path| batch::inputs(std::slice::from_ref(path)));
        let mut both: Vec<Both> = Vec::new();
        for (first, second) in paired(&self.first, &self.second, &sides, &mut is_whole, terminal)? {
            let (one, other) = match (first.read(), second.read()) {
                (Ok(one), Ok(other)) => (one, other),
                (one, other) => {
                    is_whole = false;
                    for error in [one.err(), other.err()].into_iter().flatten() {
                        terminal.error(error)?;
                    }
                    continue;
                }
            };
            if one.plans.len() != other.plans.len() {
                is_whole = false;
                let (ours, theirs) = (count(one.plans.len(), "plan"), other.plans.len());
                terminal.error(format!("{}: {ours} here, {theirs} there", first.path.display()))?;
            }
            for (storey, (one, other)) in one.plans.into_iter().zip(other.plans).enumerate() {
                let compared = compare(&one, &other, &schemes);
                let (file, plan) = (first.path.clone(), one.meta().name.clone());
                both.push(Both { file, storey, plan, input: first.clone(), plans: [one, other], compared });
            }
        }
        if both.is_empty() {
            return Err(CliError::new("no plan is on both sides; files are taken for the same by their names"));
        }
        let mut outputs = Outputs::new(terminal);
        if let Some(path) = &self.output {
            let guard = if self.guard_formulas { Guard::On } else { Guard::Off };
            outputs.save(path, &table(&both, guard)?, Care::Flushed, terminal)?;
        }
        if let Some(folder) = &self.merged {
            outputs.folder(folder)?;
            for both in &both {
                let plan = merged(&both.plans[0], &both.plans[1], &both.compared, self.prefer)?;
                let path = both.input.mirrored(folder, both.storey, "plan.json", &outputs);
                if let Some(parent) = path.parent() {
                    outputs.folder(parent)?;
                }
                outputs.save_from(&path, &checked_bytes(&path, &plan)?, Care::Flushed, &both.file, terminal)?;
            }
        }
        let table = table_of(both.iter().flat_map(|both| both.compared.labels()));
        if self.json {
            serde_json::to_writer_pretty(&mut terminal.out, &as_json(&both, &table))?;
            writeln!(terminal.out)?;
        } else {
            let mut said = Vec::new();
            print(&both, &table, self.output.is_none(), &mut said)?;
            if self.output.is_none() {
                terminal.out.write_all(&said)?;
            } else {
                // The table is the result: this only tells what is in it.
                for line in String::from_utf8_lossy(&said).lines() {
                    terminal.report(line)?;
                }
            }
        }
        Ok(if is_whole { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// The files of both sides that belong together; says which stand alone.
fn paired<'a>(
    first: &Path,
    second: &Path,
    sides: &'a [Vec<Input>; 2],
    is_whole: &mut bool,
    terminal: &mut Terminal,
) -> Result<Vec<(&'a Input, &'a Input)>, CliError> {
    // Two files are compared whatever they are called.
    if let ([one], [other]) = (sides[0].as_slice(), sides[1].as_slice())
        && one.root.is_none()
        && other.root.is_none()
    {
        return Ok(vec![(one, other)]);
    }
    if first.is_dir() != second.is_dir() {
        return Err(CliError::call("a folder and a file cannot be compared; name two folders, or two files"));
    }
    let theirs: BTreeMap<&Path, &Input> = sides[1].iter().map(|input| (input.within.as_path(), input)).collect();
    let ours: BTreeSet<&Path> = sides[0].iter().map(|input| input.within.as_path()).collect();
    let mut pairs = Vec::new();
    for one in &sides[0] {
        match theirs.get(one.within.as_path()) {
            Some(other) => pairs.push((one, *other)),
            None => {
                *is_whole = false;
                terminal.error(format!("{}: not in {}", one.path.display(), second.display()))?;
            }
        }
    }
    for other in sides[1].iter().filter(|other| !ours.contains(other.within.as_path())) {
        *is_whole = false;
        terminal.error(format!("{}: not in {}", other.path.display(), first.display()))?;
    }
    Ok(pairs)
}

/// The rooms that differ, each with its plan.
fn differences(both: &[Both]) -> impl Iterator<Item = (&Both, &Pair)> {
    both.iter().flat_map(|both| both.compared.pairs.iter().filter(|pair| pair.differs()).map(move |pair| (both, pair)))
}

fn letter(label: Option<Label>) -> &'static str {
    label.map(Label::letter).unwrap_or_default()
}

/// The differences as a table that 'enfilade label' takes once it is filled in.
fn table(both: &[Both], guard: Guard) -> Result<Vec<u8>, CliError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "file",
        "id",
        "plan",
        "room",
        "first_label",
        "second_label",
        "first_function",
        "second_function",
        "label",
        "function",
    ])?;
    for (both, pair) in differences(both) {
        writer.write_record([
            guard.cell(&both.file.display().to_string()),
            pair.ids[0].to_string(),
            guard.cell(&both.plan),
            guard.cell(&pair.name),
            letter(pair.labels[0]).to_owned(),
            letter(pair.labels[1]).to_owned(),
            guard.cell(&pair.functions[0]),
            guard.cell(&pair.functions[1]),
            String::new(),
            String::new(),
        ])?;
    }
    writer.into_inner().map_err(|error| CliError::new(error.to_string()))
}

fn alone(both: &[Both], side: usize) -> usize {
    both.iter().map(|both| both.compared.alone[side].len()).sum()
}

fn as_json(both: &[Both], table: &Confusion) -> Value {
    let agreement = Agreement::of(table);
    let kappa = agreement.kappa.map(|kappa| {
        json!({ "value": kappa.value, "standard_error": kappa.error, "low": kappa.low, "high": kappa.high,
            "in_words": kappa.in_words() })
    });
    let rooms: Vec<Value> = differences(both)
        .map(|(both, pair)| {
            json!({
                "file": both.file.display().to_string(),
                "plan": both.plan,
                "room": pair.name,
                "ids": pair.ids.map(|id| id.to_string()),
                "labels": pair.labels.map(|label| label.map(Label::letter)),
                "functions": pair.functions,
            })
        })
        .collect();
    json!({
        "version": 1,
        "plans": both.len(),
        "rooms_in_both": both.iter().map(|both| both.compared.pairs.len()).sum::<usize>(),
        "rooms_only_in": [alone(both, 0), alone(both, 1)],
        "rooms_labelled_by_both": agreement.rooms,
        "same_label": agreement.same,
        "agreement": agreement.share(),
        "kappa": kappa,
        "confusion": { "labels": Label::ALL.map(Label::letter), "rooms": table.0 },
        "differences": rooms,
    })
}

/// The most differences printed: more are read in a table.
const MOST: usize = 200;

fn print(both: &[Both], table: &Confusion, with_list: bool, out: &mut Vec<u8>) -> Result<(), CliError> {
    let agreement = Agreement::of(table);
    let in_both: usize = both.iter().map(|both| both.compared.pairs.len()).sum();
    writeln!(out, "{} and {} in both", count(both.len(), "plan"), count(in_both, "room"))?;
    for (side, name) in ["first", "second"].into_iter().enumerate().filter(|(side, _)| alone(both, *side) > 0) {
        writeln!(out, "{} only in the {name}", count(alone(both, side), "room"))?;
    }
    let labelled = count(agreement.rooms, "room");
    match agreement.share() {
        None => writeln!(out, "No room is labelled by both.")?,
        Some(share) => {
            writeln!(out, "{labelled} labelled by both: {} alike ({:.1} %)", agreement.same, 100.0 * share)?;
        }
    }
    match agreement.kappa {
        Some(kappa) => writeln!(
            out,
            "Cohen's kappa {:.3}, 95 % interval {:.3} to {:.3}: {} agreement",
            kappa.value,
            kappa.low,
            kappa.high,
            kappa.in_words()
        )?,
        None if agreement.rooms > 0 => {
            writeln!(out, "Cohen's kappa says nothing here: both gave all rooms one and the same label.")?;
        }
        None => {}
    }
    if agreement.rooms > 0 {
        writeln!(out, "\nRooms by the first's label (rows) and the second's (columns):")?;
        write!(out, "   ")?;
        for label in Label::ALL {
            write!(out, "{:>6}", label.letter())?;
        }
        writeln!(out)?;
        for label in Label::ALL {
            write!(out, "  {}", label.letter())?;
            for number in table.0[label.index()] {
                write!(out, "{number:>6}")?;
            }
            writeln!(out)?;
        }
    }
    let differ = differences(both).count();
    if with_list && differ > 0 {
        writeln!(
            out,
            "\n{}:",
            if differ == 1 { "1 room differs".to_owned() } else { format!("{differ} rooms differ") }
        )?;
        for (both, pair) in differences(both).take(MOST) {
            let said = |side: usize| {
                let label = pair.labels[side].map_or("no label", Label::name);
                let function = printable(&pair.functions[side]);
                if function.is_empty() { label.to_owned() } else { format!("{label} ({function})") }
            };
            let name = if pair.name.is_empty() { String::new() } else { format!("{} ", printable(&pair.name)) };
            let file = one_line(&both.file.display().to_string());
            writeln!(out, "  {file}: {name}{}: {} / {}", pair.ids[0], said(0), said(1))?;
        }
        if differ > MOST {
            writeln!(out, "  and {} more; -o FILE.csv writes them all", differ - MOST)?;
        }
    }
    Ok(())
}
