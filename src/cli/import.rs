mod file;
mod report;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use self::file::{Content, File, ImportedPlan, Job, State};
use self::report::{Report, list_notes, print_outcome, print_table, summarise_notes};
use super::batch::{self, Input};
use super::door::one_line;
use super::outputs::{Care, Outputs, must_be_folder};
use super::{CliError, Outcome, Subcommand, Terminal};
use crate::base::wording::count;
use crate::edit;
use crate::formats::registry::Found;
use crate::formats::{self, FORMATS, Note, NoteKind, Place, Preview, Reading, building_name, manual, plan_json};
use crate::labels::Typology;
use crate::plan::Meta;

/// The extension of the files written.
const ENDING: &str = "plan.json";

/// `enfilade import`: files of any known format to plan files.
#[derive(clap::Args)]
pub struct ImportCommand {
    /// Files of any known format, or folders of them
    #[arg(required = true, value_name = "FILE|DIR")]
    inputs: Vec<PathBuf>,
    /// Folder to write the plans to; it gets the same folder structure as the input
    #[arg(short, long, value_name = "DIR", required_unless_present = "preview")]
    output: Option<PathBuf>,
    /// The format of all files, if it cannot be recognised
    #[arg(long, value_name = "FORMAT", value_parser = importer)]
    from: Option<Found<'static>>,
    /// Set an option of a format (can be repeated); see the list below
    #[arg(long, value_name = "NAME=VALUE")]
    option: Vec<String>,
    /// Only show what is in each file; write nothing
    #[arg(long)]
    preview: bool,
    /// Print the whole report as JSON (docs/json/import.md describes it)
    #[arg(long)]
    json: bool,
}

/// Parses the name of a readable format.
fn importer(word: &str) -> Result<Found<'static>, String> {
    formats::importer_named(word).ok_or_else(|| {
        let ids = FORMATS.iter().filter(|format| format.importer.is_some()).map(|format| format.id);
        format!("use one of {}", ids.collect::<Vec<_>>().join(", "))
    })
}

impl Subcommand for ImportCommand {
    const NAME: &'static str = "import";
    const ABOUT: &'static str = "Read plans of other programs, repair them, and save them as plan files";
    const EXAMPLE: &'static str = "enfilade import annotated -o plans   # every plan below the folder 'annotated'";

    fn more_help() -> String {
        manual::import_help()
    }

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        let reading = Reading { from: self.from, options: self.option.clone() };
        reading.check().map_err(|error| CliError::call(error.to_string()))?;
        if let Some(output) = &self.output {
            must_be_folder(output)?;
        }
        // Nothing is written into it when previewing.
        let output = self.output.clone().unwrap_or_default();
        let jobs = jobs(&self.inputs, &output);
        if self.preview {
            return preview(&jobs, &reading, terminal);
        }
        let mut outputs = Outputs::new(terminal);
        let read = |input: &Input| content(input, &reading);
        let inputs: Vec<Input> = jobs.iter().map(|job| job.input.clone()).collect();
        let mut contents = Vec::with_capacity(jobs.len());
        batch::for_each(&inputs, "reading", terminal, read, |_, content, _| {
            contents.push(content);
            Ok(())
        })?;
        let mut files: Vec<File> = jobs.into_iter().zip(contents).map(|(job, content)| File { job, content }).collect();
        if files.iter().all(|file| matches!(file.content, Content::Failed(_))) && !self.json {
            for file in &files {
                file.report_errors(terminal)?;
            }
            return Err(batch::nothing_to_read());
        }
        outputs.folder(&output)?;
        same_buildings(&mut files);
        let mut targets = BTreeSet::new();
        for file in &mut files {
            if let Content::Plans { plans, .. } = &mut file.content {
                let count = plans.len();
                for (index, plan) in plans.iter_mut().enumerate() {
                    plan.target = target(&output, &file.job.target, (count > 1).then_some(index), &mut targets);
                    plan.state = save(plan, &mut outputs, terminal);
                }
            }
            file.report_errors(terminal)?;
        }
        if self.json {
            serde_json::to_writer_pretty(&mut terminal.out, &Report::new(&files))?;
            writeln!(terminal.out)?;
        } else {
            match () {
                () if terminal.call.verbose => list_notes(&files, terminal)?,
                () if terminal.call.quiet => {}
                () => summarise_notes(&files, terminal)?,
            }
            if !terminal.call.quiet {
                print_table(&files, terminal)?;
                print_outcome(&files, &output, terminal)?;
            }
        }
        let is_wrong = files.iter().any(File::is_wrong);
        Ok(if is_wrong { Outcome::InputWrong } else { Outcome::Done })
    }
}

/// The files that the inputs name, in their order; those of a folder sorted by path.
fn jobs(inputs: &[PathBuf], output: &Path) -> Vec<Job> {
    let output = output.canonicalize().ok();
    let is_output = |path: &Path| output.is_some() && path.canonicalize().ok() == output;
    // Plans that an earlier import wrote beside their sources are not sources.
    let beside: BTreeSet<&PathBuf> = inputs.iter().filter(|input| is_output(input)).collect();
    let is_source = |input: &Input| {
        let is_own = input.path.to_string_lossy().ends_with(ENDING);
        !is_own || input.root.as_ref().is_none_or(|root| !beside.contains(root))
    };
    batch::inputs_but(inputs, is_output, is_source).into_iter().map(job).collect()
}

/// Where a file's plan goes.
fn job(input: Input) -> Job {
    let folder = match &input.root {
        None => input.path.parent().unwrap_or(Path::new("")).to_owned(),
        Some(root) => {
            let within = input.path.strip_prefix(root).unwrap_or(&input.path);
            root.join(within.parent().unwrap_or(Path::new(""))).components().collect()
        }
    };
    let target = input.within.parent().unwrap_or(Path::new("")).join(stem_of(&input.within));
    Job { input, folder, target }
}

/// A file's name without the extension of its format.
fn stem_of(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default();
    // Only names that are valid text can have a known extension.
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

/// Prints a summary of each file, one per line.
fn preview(jobs: &[Job], reading: &Reading, terminal: &mut Terminal) -> Result<Outcome, CliError> {
    let mut outcome = Outcome::Done;
    for job in jobs {
        match job.input.check().and_then(|()| reading.preview(&job.input.path)) {
            Ok((format, preview)) => {
                let text = format!("{}: {}: {}", job.input.path.display(), format.name, in_words(&preview));
                writeln!(terminal.out, "{}", one_line(&text))?;
            }
            Err(error) => {
                outcome = Outcome::InputWrong;
                terminal.error(error)?;
            }
        }
    }
    Ok(outcome)
}

/// '1 plan, 31 rooms, 40 openings, 0 walls, 24.3 x 12.1 m (portal 78, space 31)'
fn in_words(preview: &Preview) -> String {
    let mut words = vec![
        count(preview.plans, "plan"),
        count(preview.rooms, "room"),
        count(preview.openings, "opening"),
        count(preview.walls, "wall"),
    ];
    if let Some((width, height)) = preview.size {
        let units = preview.units.as_deref().unwrap_or("of unknown unit");
        words.push(format!("{width:.1} x {height:.1} {units}"));
    }
    let layers: Vec<String> = preview.layers.iter().map(|(layer, count)| format!("{layer} {count}")).collect();
    let layers = if layers.is_empty() { String::new() } else { format!(" ({})", layers.join(", ")) };
    format!("{}{layers}", words.join(", "))
}

/// Gives plans of one building the same building name if spellings differ: the longest, since letters are
/// more often omitted than added.
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
            let what =
                format!("its building '{}' is spelled '{spelling}' elsewhere; that spelling is used", meta.building);
            notes.insert(0, Note { kind: NoteKind::Healed, place: Place::default(), what });
            plan.plan = edit::set_meta(&plan.plan, Meta { building: spelling.clone(), ..meta.clone() });
        }
    }
}

/// A path in the output folder unique within this import, also ignoring case.
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

fn save(plan: &ImportedPlan, outputs: &mut Outputs, terminal: &mut Terminal) -> State {
    let bytes = plan_json::to_bytes(&plan.plan);
    if std::fs::read(&plan.target).is_ok_and(|there| there == bytes) {
        return State::Unchanged;
    }
    if !outputs.may_replace(&plan.target, &bytes) {
        return State::Kept;
    }
    if let Some(folder) = plan.target.parent()
        && let Err(error) = outputs.folder(folder)
    {
        return State::NotSaved(error.message);
    }
    // The source is still there: no need to wait for the disk.
    match outputs.save(&plan.target, &bytes, Care::Fast, terminal) {
        Ok(()) => State::Written,
        Err(error) => State::NotSaved(error.message),
    }
}
