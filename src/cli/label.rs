use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::batch::{self, Input};
use super::{CliError, Outcome, Subcommand, Terminal, inputs};
use crate::base::separated::{Separated, SeparatedRow};
use crate::base::wording::count;
use crate::dataset::csv::unguarded;
use crate::edit;
use crate::labels::{Label, Schemes};
use crate::plan::titles::{printable, room_keys};
use crate::plan::{LabelOrigin, Plan, Room, RoomId, RoomLabel};
use crate::store::{load_plan, save_plan};

/// `enfilade label`: a table of corrections, applied to plans.
#[derive(clap::Args)]
pub struct LabelCommand {
    /// Plan files (.plan.json), or folders of them
    #[arg(required = true, value_name = "PLAN")]
    plans: Vec<PathBuf>,
    /// The corrections: a table (.csv) with the columns file and id, and label or function or both. An empty cell changes nothing
    #[arg(long, value_name = "FILE.csv", required = true)]
    from: PathBuf,
    /// Only show what would change; write nothing
    #[arg(long)]
    dry_run: bool,
    /// Print JSON (docs/json/label.md describes it)
    #[arg(long)]
    json: bool,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

impl Subcommand for LabelCommand {
    const NAME: &'static str = "label";
    const ABOUT: &'static str = "Apply a table of corrected labels or functions to plan files";
    const EXAMPLE: &'static str = "enfilade label plans --from fixes.csv --dry-run";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let schemes = inputs::schemes(&self.scheme)?;
        let mut table = read_table(&self.from)?;
        let files = batch::inputs(&self.plans);
        let is_missing = |file: &&Input| file.check().is_err() || !file.path.is_file();
        let missing: Vec<&Input> = files.iter().filter(is_missing).collect();
        for error in missing.iter().filter_map(|file| file.read().err()) {
            writeln!(terminal.err, "enfilade: {error}")?;
        }
        if missing.len() == files.len() {
            return Err(batch::nothing_to_read());
        }
        let targets = Targets::new(&files);
        let mut by_file: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, row) in table.iter_mut().enumerate() {
            if row.refused.is_none() {
                match targets.find(&row.file) {
                    Ok(file) => by_file.entry(file).or_default().push(index),
                    Err(why) => row.refused = Some(why),
                }
            }
        }
        let mut report = Report { dry_run: self.dry_run, failed: missing.len(), ..Report::default() };
        for (file, rows) in by_file {
            let path = &files[file].path;
            match load_plan(path) {
                Err(error) => {
                    report.failed += 1;
                    writeln!(terminal.err, "enfilade: {error}")?;
                    rows.iter().for_each(|&row| table[row].refused = Some("its file cannot be read".to_owned()));
                }
                Ok(plan) => {
                    let changed = apply(&plan, &schemes, path, &rows, &mut table, &mut report);
                    if changed != plan && !self.dry_run {
                        save_plan(path, &changed)?;
                    }
                }
            }
        }
        let refused = table.iter().filter(|row| row.refused.is_some()).count();
        if self.json {
            report.print_json(&table, terminal)?;
        } else {
            report.print(&table, &self.from, terminal)?;
        }
        Ok(if refused + report.failed == 0 { Outcome::Done } else { Outcome::InputWrong })
    }
}

/// A line of the table.
struct Correction {
    line: u64,
    file: String,
    id: String,
    label: Option<Label>,
    function: Option<String>,
    /// Why it is not applied.
    refused: Option<String>,
}

/// Reads the corrections. What is wrong with one line refuses that line.
///
/// # Errors
/// When the file cannot be read, is no table, or lacks a column.
fn read_table(path: &Path) -> Result<Vec<Correction>, CliError> {
    let fail = |what: String| CliError::new(format!("{}: {what}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| fail(error.to_string()))?;
    let read = Separated::read(&bytes).map_err(|error| match error.line {
        0 => fail(error.what),
        line => fail(format!("line {line}: {}", error.what)),
    })?;
    let column = |name: &str| read.column(name);
    let needed = |name: &str| {
        let hint = "corrections have the columns file, id, and label or function";
        column(name).ok_or_else(|| fail(format!("line 1: no column '{name}'; {hint}")))
    };
    let (file, id) = (needed("file")?, needed("id")?);
    let (label, function) = (column("label"), column("function"));
    if label.is_none() && function.is_none() {
        needed("label")?;
    }
    let mut table = Vec::new();
    for SeparatedRow { line, cells } in &read.rows {
        let cell = |index: usize| unguarded(cells.get(index).map(String::as_str).unwrap_or_default()).to_owned();
        let text = |index: Option<usize>| index.map(cell).filter(|text| !text.is_empty());
        let mut row = Correction {
            line: *line,
            file: cell(file),
            id: cell(id),
            label: None,
            function: text(function),
            refused: None,
        };
        match text(label).map(|word| word.parse::<Label>()) {
            Some(Ok(label)) => row.label = Some(label),
            Some(Err(error)) => row.refused = Some(error.to_string()),
            None => {}
        }
        if row.file.is_empty() || row.id.is_empty() {
            row.refused = Some("has no file and id".to_owned());
        } else if row.label.is_none() && row.function.is_none() && row.refused.is_none() {
            row.refused = Some("has neither a label nor a function".to_owned());
        }
        table.push(row);
    }
    refuse_contradictions(&mut table);
    Ok(table)
}

/// Lines that give one room different labels or functions: none of them is applied.
fn refuse_contradictions(table: &mut [Correction]) {
    let mut of_room: BTreeMap<(String, String), Vec<usize>> = BTreeMap::new();
    for (index, row) in table.iter().enumerate().filter(|(_, row)| row.refused.is_none()) {
        of_room.entry((slashed(&row.file), row.id.clone())).or_default().push(index);
    }
    for rows in of_room.into_values().filter(|rows| rows.len() > 1) {
        refuse_if_contradicting(table, &rows);
    }
}

/// Refuses lines of one room where they give it different labels or functions. Returns whether they did.
fn refuse_if_contradicting(table: &mut [Correction], rows: &[usize]) -> bool {
    let labels: BTreeSet<Label> = rows.iter().filter_map(|&row| table[row].label).collect();
    let functions: BTreeSet<&str> = rows.iter().filter_map(|&row| table[row].function.as_deref()).collect();
    if labels.len() <= 1 && functions.len() <= 1 {
        return false;
    }
    let lines: Vec<String> = rows.iter().map(|&row| table[row].line.to_string()).collect();
    let why = format!("lines {} contradict each other about one room", lines.join(" and "));
    rows.iter().for_each(|&row| table[row].refused = Some(why.clone()));
    true
}

fn slashed(path: &str) -> String {
    let path = path.replace('\\', "/");
    path.strip_prefix("./").map_or_else(|| path.clone(), str::to_owned)
}

/// The files that were named, by every way a table may call them.
struct Targets {
    /// As named on the command line, or found in a folder that was.
    whole: BTreeMap<String, usize>,
    /// The path's last names, one or more; `None` where that fits several.
    part: BTreeMap<String, Option<usize>>,
    is_plan_file: Vec<bool>,
}

impl Targets {
    fn new(files: &[Input]) -> Self {
        let mut targets = Self { whole: BTreeMap::new(), part: BTreeMap::new(), is_plan_file: Vec::new() };
        for (index, input) in files.iter().enumerate() {
            let path = slashed(&input.path.to_string_lossy());
            targets.is_plan_file.push(path.ends_with(".plan.json"));
            if targets.whole.contains_key(&path) {
                continue;
            }
            // The last names of the path, as many as were written: 'office.plan.json', 'plans/office.plan.json'.
            for (at, _) in path.match_indices('/') {
                targets.part.entry(path[at + 1..].to_owned()).and_modify(|file| *file = None).or_insert(Some(index));
            }
            targets.whole.insert(path, index);
        }
        targets
    }

    /// The file that a table means.
    fn find(&self, file: &str) -> Result<usize, String> {
        let file = slashed(file);
        let found = match (self.whole.get(&file), self.part.get(&file)) {
            (Some(&found), _) | (None, Some(&Some(found))) => found,
            (None, Some(None)) => {
                return Err(format!("several files are called {}; name its folder too", printable(&file)));
            }
            (None, None) => return Err(format!("{} is not among the plans given", printable(&file))),
        };
        if self.is_plan_file[found] {
            return Ok(found);
        }
        Err(format!("{} is not a plan file (.plan.json); import it and correct the result", printable(&file)))
    }
}

/// The rooms of a plan that an id, or a name where nothing has that id, may mean.
fn rooms_called(plan: &Plan, called: &str) -> Vec<RoomId> {
    let mut rooms: Vec<RoomId> = plan
        .rooms()
        .filter(|(id, room)| id.to_string() == called || room.source_id == called)
        .map(|(id, _)| id)
        .collect();
    if rooms.is_empty() {
        rooms = room_keys(plan).into_iter().filter(|(_, key)| key == called).map(|(id, _)| id).collect();
    }
    rooms
}

/// A plan with its corrections.
fn apply(
    plan: &Plan,
    schemes: &Schemes,
    path: &Path,
    rows: &[usize],
    table: &mut [Correction],
    report: &mut Report,
) -> Plan {
    let mut changed = plan.clone();
    let mut meant: BTreeMap<RoomId, Vec<usize>> = BTreeMap::new();
    for &row in rows {
        match rooms_called(plan, &table[row].id).as_slice() {
            [id] => meant.entry(*id).or_default().push(row),
            [] => {
                table[row].refused =
                    Some(format!("no room of {} has the id {}", path.display(), printable(&table[row].id)))
            }
            several => {
                let what =
                    format!("{} rooms of {} are called {}", several.len(), path.display(), printable(&table[row].id));
                table[row].refused = Some(format!("{what}; use the id from the column 'id' of a dataset"));
            }
        }
    }
    for (id, rows) in meant {
        let Some(room) = plan.room(id) else { continue };
        // One room may be called by its id and by its source's.
        if refuse_if_contradicting(table, &rows) {
            continue;
        }
        // They agree.
        let label = rows.iter().find_map(|&row| table[row].label);
        let function = rows.iter().find_map(|&row| table[row].function.clone());
        let mut after = changed.clone();
        if let Some(function) = function.as_deref().filter(|&function| function != room.function) {
            after = edit::set_function(&after, id, function).unwrap_or(after);
        }
        if let Some(label) = label {
            // A label that follows from the function already need not be pinned to the room.
            if status(&after, schemes, id) != Some(label) {
                let given = RoomLabel { label, origin: LabelOrigin::Person };
                after = edit::set_label(&after, id, Some(given)).unwrap_or(after);
            }
        }
        let (was, is) = (said(plan, schemes, id), said(&after, schemes, id));
        let lines = rows.iter().map(|&row| table[row].line).collect();
        let overruled =
            function.is_some() && label.is_none() && after.room(id).is_some_and(|room| room.label.is_some());
        report.rooms.push(Done {
            file: path.display().to_string(),
            id: id.to_string(),
            room: name_of(room),
            lines,
            is_changed: after != changed,
            is_overruled: overruled,
            was,
            is,
        });
        changed = after;
    }
    changed
}

fn status(plan: &Plan, schemes: &Schemes, id: RoomId) -> Option<Label> {
    crate::features::RoomStatus::of(plan, schemes, plan.room(id)?).label()
}

/// A room's label and function.
fn said(plan: &Plan, schemes: &Schemes, id: RoomId) -> (Option<Label>, String) {
    (status(plan, schemes, id), plan.room(id).map(|room| room.function.clone()).unwrap_or_default())
}

fn name_of(room: &Room) -> String {
    if room.name.is_empty() { room.source_id.clone() } else { room.name.clone() }
}

/// What became of one room.
struct Done {
    file: String,
    id: String,
    room: String,
    lines: Vec<u64>,
    is_changed: bool,
    /// Whether a label of the room's own goes before what its new function would give it.
    is_overruled: bool,
    was: (Option<Label>, String),
    is: (Option<Label>, String),
}

impl Done {
    fn words(&self) -> String {
        let name = |of: &(Option<Label>, String)| {
            let label = of.0.map_or("no label", Label::name);
            if of.1.is_empty() { label.to_owned() } else { format!("{label} ({})", printable(&of.1)) }
        };
        let room = if self.room.is_empty() { String::new() } else { format!("{} ", printable(&self.room)) };
        let own = if self.is_overruled { "; the room's own label stays" } else { "" };
        if self.is_changed {
            format!("{room}{}: {} -> {}{own}", self.id, name(&self.was), name(&self.is))
        } else {
            format!("{room}{}: is {} already", self.id, name(&self.is))
        }
    }
}

/// What was done.
#[derive(Default)]
struct Report {
    dry_run: bool,
    /// Files that could not be read.
    failed: usize,
    rooms: Vec<Done>,
}

impl Report {
    fn print(&self, table: &[Correction], from: &Path, terminal: &mut Terminal) -> Result<(), CliError> {
        let mut file = "";
        for done in self.rooms.iter().filter(|done| done.is_changed) {
            if done.file != file {
                file = &done.file;
                writeln!(terminal.out, "{file}")?;
            }
            writeln!(terminal.out, "  {}", done.words())?;
        }
        for row in table {
            if let Some(why) = &row.refused {
                writeln!(terminal.err, "{}: line {}: refused: {why}", from.display(), row.line)?;
            }
        }
        let changed = self.rooms.iter().filter(|done| done.is_changed).count();
        let same = self.rooms.len() - changed;
        let refused = table.iter().filter(|row| row.refused.is_some()).count();
        let files =
            self.rooms.iter().filter(|done| done.is_changed).map(|done| &done.file).collect::<BTreeSet<_>>().len();
        let verb = if self.dry_run { "would be changed" } else { "changed" };
        let (rooms, files) = (count(changed, "room"), count(files, "file"));
        writeln!(
            terminal.out,
            "{rooms} in {files} {verb}; {same} as said already; {} refused",
            count(refused, "line")
        )?;
        Ok(())
    }

    fn print_json(&self, table: &[Correction], terminal: &mut Terminal) -> Result<(), CliError> {
        let label = |of: &(Option<Label>, String)| json!({ "label": of.0.map(Label::letter), "function": of.1 });
        let rooms: Vec<Value> = self
            .rooms
            .iter()
            .map(|done| {
                json!({
                    "file": done.file,
                    "id": done.id,
                    "lines": done.lines,
                    "changed": done.is_changed,
                    "was": label(&done.was),
                    "is": label(&done.is),
                })
            })
            .collect();
        let refused = table.iter().filter_map(|row| Some(json!({ "line": row.line, "why": row.refused.as_ref()? })));
        let report = json!({
            "version": 1,
            "dry_run": self.dry_run,
            "rooms": rooms,
            "refused": refused.collect::<Vec<_>>(),
        });
        serde_json::to_writer_pretty(&mut terminal.out, &report)?;
        writeln!(terminal.out)?;
        Ok(())
    }
}
