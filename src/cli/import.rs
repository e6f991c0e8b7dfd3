use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::batch::{self, Input};
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::edit;
use crate::formats::registry::Found;
use crate::formats::{self, FORMATS, Note, NoteKind, Place, Preview, Reading, building_name, manual, plan_json};
use crate::labels::Typology;
use crate::plan::{Meta, Plan};
use crate::store::save_bytes_fast;

/// How the files that are written end.
const ENDING: &str = "plan.json";

/// `enfilade import`: files of any known format to plan files.
#[derive(clap::Args)]
pub struct ImportCommand {
    /// Files of any known format, or folders of them
    #[arg(required = true, value_name = "FILE|DIR")]
    inputs: Vec<PathBuf>,
    /// Folder to write the plans to; the folders of a DIR are made again in it
    #[arg(short, long, value_name = "DIR", required_unless_present = "preview")]
    output: Option<PathBuf>,
    /// The format of all files, where they do not tell it themselves
    #[arg(long, value_name = "FORMAT", value_parser = importer)]
    from: Option<Found<'static>>,
    /// Set an option of a format (may be given several times); the list is below
    #[arg(long, value_name = "NAME=VALUE")]
    option: Vec<String>,
    /// Only say what is in each file, and write nothing
    #[arg(long)]
    preview: bool,
    /// Replace plans that are there already and differ
    #[arg(long)]
    force: bool,
    /// List each thing that was mended or left out with its place, instead of a summary
    #[arg(short, long)]
    verbose: bool,
    /// Print the whole report as JSON
    #[arg(long)]
    json: bool,
}

/// A format that can be read, as an option's value.
fn importer(word: &str) -> Result<Found<'static>, String> {
    formats::importer_named(word).ok_or_else(|| {
        let ids = FORMATS.iter().filter(|format| format.importer.is_some()).map(|format| format.id);
        format!("use one of {}", ids.collect::<Vec<_>>().join(", "))
    })
}

impl Subcommand for ImportCommand {
    const NAME: &'static str = "import";
    const ABOUT: &'static str = "Read plans of other programs, mend them, and save them as plan files";
    const EXAMPLE: &'static str = "enfilade import annotated -o plans   # every plan below the folder 'annotated'";

    fn more_help() -> String {
        manual::import_help()
    }

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let reading = Reading { from: self.from, options: self.option.clone() };
        reading.check()?;
        // Nothing is written into it when previewing.
        let output = self.output.clone().unwrap_or_default();
        let jobs = jobs(&self.inputs, &output)?;
        if self.preview {
            return preview(&jobs, &reading, terminal);
        }
        std::fs::create_dir_all(&output)
            .map_err(|error| CliError::new(format!("{}: {error}; choose another folder", output.display())))?;
        let read = |input: &Input| content(input, &reading);
        let inputs: Vec<Input> = jobs.iter().map(|job| job.input.clone()).collect();
        let mut contents = Vec::with_capacity(jobs.len());
        batch::for_each(&inputs, "reading", terminal, read, |_, content, _| {
            contents.push(content);
            Ok(())
        })?;
        let mut files: Vec<File> = jobs.into_iter().zip(contents).map(|(job, content)| File { job, content }).collect();
        same_buildings(&mut files);
        let mut targets = BTreeSet::new();
        for file in &mut files {
            if let Content::Plans { plans, .. } = &mut file.content {
                let count = plans.len();
                for (index, plan) in plans.iter_mut().enumerate() {
                    plan.target = target(&output, &file.job.target, (count > 1).then_some(index), &mut targets);
                    plan.state = save(plan, self.force);
                }
            }
            file.report_errors(terminal)?;
        }
        if self.json {
            serde_json::to_writer_pretty(&mut terminal.out, &Report::new(&files))?;
            writeln!(terminal.out)?;
        } else {
            if self.verbose {
                list_notes(&files, terminal)?
            } else {
                summarise_notes(&files, terminal)?
            }
            print_table(&files, terminal)?;
            print_outcome(&files, &output, terminal)?;
        }
        let is_wrong = files.iter().any(File::is_wrong);
        Ok(if is_wrong { Outcome::InputWrong } else { Outcome::Done })
    }
}

/// A file to import.
struct Job {
    input: Input,
    /// The folder it is counted under.
    folder: PathBuf,
    /// Where its plan goes in the output folder, without the ending.
    target: PathBuf,
}

/// A file and what became of it.
struct File {
    job: Job,
    content: Content,
}

enum Content {
    Plans {
        plans: Vec<ImportedPlan>,
        notes: Vec<Note>,
    },
    /// No plan, although its name ends like one: passed over.
    Foreign(String),
    Failed(formats::FileError),
}

struct ImportedPlan {
    plan: Plan,
    target: PathBuf,
    state: State,
}

/// What became of a plan's file.
#[derive(Clone, Debug, PartialEq, Eq)]
enum State {
    Waiting,
    Written,
    /// The same plan was there.
    Unchanged,
    /// Another plan was there, and stays.
    Kept,
    NotSaved(String),
}

impl State {
    const fn name(&self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Written => "written",
            Self::Unchanged => "unchanged",
            Self::Kept => "kept",
            Self::NotSaved(_) => "not saved",
        }
    }
}

/// The files that the inputs name, in their order; those of a folder sorted by path.
fn jobs(inputs: &[PathBuf], output: &Path) -> Result<Vec<Job>, CliError> {
    let output = output.canonicalize().ok();
    let is_output = |path: &Path| output.is_some() && path.canonicalize().ok() == output;
    // Plans that an earlier import wrote beside their sources are no sources.
    let beside: BTreeSet<&PathBuf> = inputs.iter().filter(|input| is_output(input)).collect();
    let is_source = |input: &Input| {
        let is_own = input.path.to_string_lossy().ends_with(ENDING);
        !is_own || input.root.as_ref().is_none_or(|root| !beside.contains(root))
    };
    let found = batch::inputs_but(inputs, is_output, is_source)?;
    Ok(found.into_iter().map(|input| job(input, inputs.len() > 1)).collect())
}

/// Where a file's plan goes. With several folders each keeps its name, so that equal paths in them do not collide.
fn job(input: Input, has_several: bool) -> Job {
    let Some(root) = &input.root else {
        let folder = input.path.parent().unwrap_or(Path::new("")).to_owned();
        let target = stem_of(&input.path);
        return Job { input, folder, target };
    };
    let prefix = match root.canonicalize() {
        Ok(root) if has_several => root.file_name().map(PathBuf::from).unwrap_or_default(),
        _ => PathBuf::new(),
    };
    let within = input.path.strip_prefix(root).unwrap_or(&input.path);
    let below = within.parent().unwrap_or(Path::new(""));
    let folder = root.join(below).components().collect();
    let target = prefix.join(below).join(stem_of(within));
    Job { input, folder, target }
}

/// A file's name without the ending of its format.
fn stem_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default();
    // Only names that are text have a known ending.
    name.to_str().map_or_else(|| PathBuf::from(name), |name| PathBuf::from(formats::file_stem(name)))
}

fn content(input: &Input, reading: &Reading) -> Content {
    match input.read_or_pass(reading) {
        Err(error) => Content::Failed(error),
        Ok(Err(kind)) => Content::Foreign(kind),
        Ok(Ok(import)) => {
            let waiting = |plan| ImportedPlan { plan, target: PathBuf::new(), state: State::Waiting };
            Content::Plans { plans: import.plans.into_iter().map(waiting).collect(), notes: import.notes }
        }
    }
}

/// Says what is in each file, one a line.
fn preview(jobs: &[Job], reading: &Reading, terminal: &mut Terminal) -> Result<Outcome, CliError> {
    let mut outcome = Outcome::Done;
    for job in jobs {
        match job.input.check().and_then(|()| reading.preview(&job.input.path)) {
            Ok((format, preview)) => {
                writeln!(terminal.out, "{}: {}: {}", job.input.path.display(), format.name, in_words(&preview))?;
            }
            Err(error) => {
                outcome = Outcome::InputWrong;
                writeln!(terminal.err, "enfilade: {error}")?;
            }
        }
    }
    Ok(outcome)
}

/// '1 plan, 31 rooms, 40 openings, 0 walls, 24.3 x 12.1 m (portal 78, space 31)'
fn in_words(preview: &Preview) -> String {
    let counted = |count: usize, noun: &str| format!("{count} {noun}{}", if count == 1 { "" } else { "s" });
    let mut words = vec![
        counted(preview.plans, "plan"),
        counted(preview.rooms, "room"),
        counted(preview.openings, "opening"),
        counted(preview.walls, "wall"),
    ];
    if let Some((width, height)) = preview.size {
        let units = preview.units.as_deref().unwrap_or("of unknown unit");
        words.push(format!("{width:.1} x {height:.1} {units}"));
    }
    let layers: Vec<String> = preview.layers.iter().map(|(layer, count)| format!("{layer} {count}")).collect();
    let layers = if layers.is_empty() { String::new() } else { format!(" ({})", layers.join(", ")) };
    format!("{}{layers}", words.join(", "))
}

/// Gives plans of one building the same name of it, where spellings differ: the longest, since a
/// letter is more often left out than added.
fn same_buildings(files: &mut [File]) {
    let key_of =
        |meta: &Meta| -> (Option<Typology>, String) { (meta.typology.clone(), building_name::key(&meta.building)) };
    let mut spellings: BTreeMap<(Option<Typology>, String), String> = BTreeMap::new();
    for plan in files.iter().flat_map(File::plans) {
        let meta = plan.plan.meta();
        let rank = |name: &str| (std::cmp::Reverse(name.chars().count()), name.to_owned());
        let spelling = spellings.entry(key_of(meta)).or_insert_with(|| meta.building.clone());
        if rank(&meta.building) < rank(spelling) {
            spelling.clone_from(&meta.building);
        }
    }
    for file in files {
        let Content::Plans { plans, notes } = &mut file.content else { continue };
        for plan in plans {
            let meta = plan.plan.meta();
            let Some(spelling) = spellings.get(&key_of(meta)).filter(|spelling| **spelling != meta.building) else {
                continue;
            };
            let what = format!("its building '{}' is spelled '{spelling}' elsewhere; taken as that", meta.building);
            notes.insert(0, Note { kind: NoteKind::Healed, place: Place::default(), what });
            plan.plan = edit::set_meta(&plan.plan, Meta { building: spelling.clone(), ..meta.clone() });
        }
    }
}

/// A path in the output folder that no other plan of this import has, also where upper and lower
/// case are the same.
fn target(output: &Path, target: &Path, index: Option<usize>, taken: &mut BTreeSet<String>) -> PathBuf {
    let stem = target.file_name().unwrap_or_default();
    for nth in 1.. {
        let mut name = stem.to_owned();
        if let Some(index) = index {
            name.push(format!("-{}", index + 1));
        }
        if nth > 1 {
            name.push(format!("-{nth}"));
        }
        name.push(".");
        name.push(ENDING);
        let path = output.join(target.with_file_name(name));
        if taken.insert(path.to_string_lossy().to_lowercase()) {
            return path;
        }
    }
    output.join(target)
}

fn save(plan: &ImportedPlan, force: bool) -> State {
    let bytes = plan_json::to_bytes(&plan.plan);
    match std::fs::read(&plan.target) {
        Ok(there) if there == bytes => return State::Unchanged,
        Ok(_) if !force => return State::Kept,
        _ => {}
    }
    if let Some(folder) = plan.target.parent()
        && let Err(error) = std::fs::create_dir_all(folder)
    {
        return State::NotSaved(format!("{}: {error}", folder.display()));
    }
    // The source is still there: no need to wait for the disk.
    match save_bytes_fast(&plan.target, &bytes) {
        Ok(()) => State::Written,
        Err(error) => State::NotSaved(error.to_string()),
    }
}

impl File {
    fn plans(&self) -> &[ImportedPlan] {
        match &self.content {
            Content::Plans { plans, .. } => plans,
            Content::Foreign(_) | Content::Failed(_) => &[],
        }
    }

    fn notes(&self) -> &[Note] {
        match &self.content {
            Content::Plans { notes, .. } => notes,
            Content::Foreign(_) | Content::Failed(_) => &[],
        }
    }

    /// Whether it could not be read, or a plan of it could not be saved.
    fn is_wrong(&self) -> bool {
        matches!(self.content, Content::Failed(_))
            || self.plans().iter().any(|plan| matches!(plan.state, State::Kept | State::NotSaved(_)))
    }

    fn report_errors(&self, terminal: &mut Terminal) -> Result<(), CliError> {
        if let Content::Failed(error) = &self.content {
            writeln!(terminal.err, "enfilade: {error}")?;
        }
        for plan in self.plans() {
            match &plan.state {
                State::Kept => writeln!(
                    terminal.err,
                    "enfilade: {}: kept: it differs from what {} gives; --force replaces it",
                    plan.target.display(),
                    self.job.input.path.display()
                )?,
                State::NotSaved(why) => writeln!(terminal.err, "enfilade: {why}")?,
                State::Waiting | State::Written | State::Unchanged => {}
            }
        }
        Ok(())
    }
}

const fn kind_name(kind: NoteKind) -> &'static str {
    match kind {
        NoteKind::Healed => "healed",
        NoteKind::Skipped => "skipped",
    }
}

/// Every note as `path:line: kind: element: what`, then an empty line.
fn list_notes(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    for file in files {
        for note in file.notes() {
            write!(terminal.out, "{}", place(file, note))?;
            write!(terminal.out, ": {}: ", kind_name(note.kind))?;
            if !note.place.element.is_empty() {
                write!(terminal.out, "{}: ", note.place.element)?;
            }
            writeln!(terminal.out, "{}", note.what)?;
        }
        if let Content::Foreign(kind) = &file.content {
            writeln!(terminal.out, "{}: passed over: {kind}", file.job.input.path.display())?;
        }
    }
    if files.iter().any(|file| !file.notes().is_empty() || matches!(file.content, Content::Foreign(_))) {
        writeln!(terminal.out)?;
    }
    Ok(())
}

fn place(file: &File, note: &Note) -> String {
    let path = file.job.input.path.display();
    note.place.line.map_or_else(|| path.to_string(), |line| format!("{path}:{line}"))
}

/// One line for notes that say the same but for names and numbers, with their number and the first.
fn summarise_notes(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    /// Notes of one kind and text.
    struct Group<'a> {
        count: usize,
        first: (&'a File, &'a Note),
    }
    let mut groups: BTreeMap<(NoteKind, String), Group<'_>> = BTreeMap::new();
    for file in files {
        for note in file.notes() {
            let group = groups.entry((note.kind, masked(&note.what)));
            group.or_insert(Group { count: 0, first: (file, note) }).count += 1;
        }
    }
    if groups.is_empty() {
        return Ok(());
    }
    writeln!(terminal.out, "Mended and left out, with the first place of each (-v lists all):")?;
    let mut groups: Vec<((NoteKind, String), Group<'_>)> = groups.into_iter().collect();
    groups.sort_by(|((a_kind, _), a), ((b_kind, _), b)| a_kind.cmp(b_kind).then(b.count.cmp(&a.count)));
    for ((kind, what), Group { count, first: (file, note) }) in groups {
        let what = if count == 1 { &note.what } else { &what };
        writeln!(terminal.out, "  {:7} {count:5} x  {what}", kind_name(kind))?;
        writeln!(terminal.out, "                   {}", place(file, note))?;
    }
    writeln!(terminal.out)?;
    Ok(())
}

/// A text with '…' for what is in quotes and for numbers.
fn masked(what: &str) -> String {
    let mut masked = String::new();
    let mut rest = what;
    while let Some(letter) = rest.chars().next() {
        let (length, mark) = if letter == '\'' && rest[1..].contains('\'') {
            // A quoted name ends before a space, a comma or the end, and may hold an apostrophe.
            let end = rest[1..].match_indices('\'').map(|(at, _)| at + 2);
            let closing = end.into_iter().find(|&end| !rest[end..].starts_with(char::is_alphanumeric));
            (closing.unwrap_or(1), "'…'")
        } else if letter.is_ascii_digit() {
            let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(rest.len());
            (rest[..end].trim_end_matches('.').len(), "…")
        } else {
            (letter.len_utf8(), "")
        };
        masked.push_str(if mark.is_empty() { &rest[..length] } else { mark });
        rest = &rest[length..];
    }
    masked
}

/// What the table counts.
#[derive(Clone, Copy, Default, Serialize)]
struct Counts {
    files: usize,
    plans: usize,
    rooms: usize,
    openings: usize,
    healed: usize,
    skipped: usize,
    failed: usize,
}

impl Counts {
    const NAMES: [&'static str; 7] = ["files", "plans", "rooms", "openings", "healed", "skipped", "failed"];

    const fn values(&self) -> [usize; 7] {
        [self.files, self.plans, self.rooms, self.openings, self.healed, self.skipped, self.failed]
    }

    fn add(&mut self, file: &File) {
        let count = |kind| file.notes().iter().filter(|note| note.kind == kind).count();
        match file.content {
            Content::Foreign(_) => return,
            Content::Failed(_) => self.failed += 1,
            Content::Plans { .. } => {}
        }
        self.files += 1;
        self.plans += file.plans().len();
        self.rooms += file.plans().iter().map(|plan| plan.plan.rooms().len()).sum::<usize>();
        self.openings += file.plans().iter().map(|plan| plan.plan.openings().len()).sum::<usize>();
        self.healed += count(NoteKind::Healed);
        self.skipped += count(NoteKind::Skipped);
    }
}

/// The counts of each folder, in the order of its first file, and of all.
fn counts(files: &[File]) -> (Vec<(String, Counts)>, Counts) {
    let mut folders: Vec<(String, Counts)> = Vec::new();
    let mut index_of: BTreeMap<&Path, usize> = BTreeMap::new();
    let mut total = Counts::default();
    for file in files {
        let index = *index_of.entry(&file.job.folder).or_insert_with(|| {
            let name = file.job.folder.display().to_string();
            folders.push((if name.is_empty() { ".".to_owned() } else { name }, Counts::default()));
            folders.len() - 1
        });
        folders[index].1.add(file);
        total.add(file);
    }
    folders.retain(|(_, counts)| counts.files > 0);
    (folders, total)
}

fn print_table(files: &[File], terminal: &mut Terminal) -> Result<(), CliError> {
    let (folders, total) = counts(files);
    let rows = folders.iter().map(|(name, counts)| (name.as_str(), *counts));
    let rows: Vec<(&str, Counts)> = rows.chain((folders.len() != 1).then_some(("total", total))).collect();
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0).max("folder".len());
    write!(terminal.out, "{:width$}", "folder")?;
    for name in Counts::NAMES {
        write!(terminal.out, " {name:>8}")?;
    }
    writeln!(terminal.out)?;
    for (name, counts) in rows {
        write!(terminal.out, "{name:width$}")?;
        for value in counts.values() {
            write!(terminal.out, " {value:>8}")?;
        }
        writeln!(terminal.out)?;
    }
    Ok(())
}

fn print_outcome(files: &[File], output: &Path, terminal: &mut Terminal) -> Result<(), CliError> {
    let count = |name: &str| files.iter().flat_map(File::plans).filter(|plan| plan.state.name() == name).count();
    let parts: Vec<String> = ["written", "unchanged", "kept", "not saved"]
        .into_iter()
        .filter_map(|name| {
            let count = count(name);
            (count > 0).then(|| format!("{count} {name}"))
        })
        .collect();
    if !parts.is_empty() {
        writeln!(terminal.out, "Plans in {}: {}.", output.display(), parts.join(", "))?;
    }
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for file in files {
        if let Content::Foreign(kind) = &file.content {
            *kinds.entry(kind).or_default() += 1;
        }
    }
    for (kind, count) in kinds {
        writeln!(terminal.out, "Passed over as no plans: {count} x {kind}.")?;
    }
    Ok(())
}

/// The report for machines.
#[derive(Serialize)]
struct Report {
    total: Counts,
    folders: Vec<FolderReport>,
    files: Vec<FileReport>,
}

#[derive(Serialize)]
struct FolderReport {
    folder: String,
    #[serde(flatten)]
    counts: Counts,
}

#[derive(Serialize)]
struct FileReport {
    path: String,
    /// `read`, `failed` or `passed over`.
    state: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    plans: Vec<PlanReport>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<NoteReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<ErrorReport>,
    /// What a file is that was passed over.
    #[serde(skip_serializing_if = "Option::is_none")]
    is: Option<String>,
}

#[derive(Serialize)]
struct PlanReport {
    path: String,
    /// `written`, `unchanged`, `kept` or `not saved`.
    state: &'static str,
    name: String,
    building: String,
    storey: String,
    rooms: usize,
    openings: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
}

#[derive(Serialize)]
struct NoteReport {
    kind: &'static str,
    line: Option<usize>,
    element: String,
    what: String,
}

#[derive(Serialize)]
struct ErrorReport {
    line: Option<usize>,
    element: String,
    what: String,
    hint: String,
}

impl Report {
    fn new(files: &[File]) -> Self {
        let (folders, total) = counts(files);
        let folders = folders.into_iter().map(|(folder, counts)| FolderReport { folder, counts }).collect();
        Self { total, folders, files: files.iter().map(FileReport::new).collect() }
    }
}

impl FileReport {
    fn new(file: &File) -> Self {
        let plans = file.plans().iter().map(|plan| PlanReport {
            path: plan.target.display().to_string(),
            state: plan.state.name(),
            name: plan.plan.meta().name.clone(),
            building: plan.plan.meta().building.clone(),
            storey: plan.plan.meta().storey.clone(),
            rooms: plan.plan.rooms().len(),
            openings: plan.plan.openings().len(),
            why: match &plan.state {
                State::NotSaved(why) => Some(why.clone()),
                _ => None,
            },
        });
        let notes = file.notes().iter().map(|note| NoteReport {
            kind: kind_name(note.kind),
            line: note.place.line,
            element: note.place.element.clone(),
            what: note.what.clone(),
        });
        let (state, error, is) = match &file.content {
            Content::Plans { .. } => ("read", None, None),
            Content::Foreign(kind) => ("passed over", None, Some(kind.clone())),
            Content::Failed(formats::FileError { error, .. }) => {
                let report = ErrorReport {
                    line: error.place.line,
                    element: error.place.element.clone(),
                    what: error.what.clone(),
                    hint: error.hint.clone(),
                };
                ("failed", Some(report), None)
            }
        };
        Self {
            path: file.job.input.path.display().to_string(),
            state,
            plans: plans.collect(),
            notes: notes.collect(),
            error,
            is,
        }
    }
}
