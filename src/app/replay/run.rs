//! Finding and running scripts.

use std::fmt;
use std::path::{Path, PathBuf};

use super::fault::Fault;
use super::folders::Folders;
use super::script::{LARGEST_BYTES, Script};
use super::stage::Stage;
use crate::formats;
use crate::plan::Plan;

/// A script on disk.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScriptFile {
    pub path: PathBuf,
    /// Its path below the searched folder, without the extension: this identifies it.
    pub title: String,
}

/// Options for running scripts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReplayOptions {
    /// The folder of the reference pictures, with a folder per script; if `None`, they are beside each
    /// script.
    pub snapshots: Option<PathBuf>,
    /// Where to keep what scripts save and every picture they take, with a folder per script; if `None`,
    /// what they save is thrown away.
    pub out: Option<PathBuf>,
    /// Whether to make the results the new references.
    pub update: bool,
}

/// The result of a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    pub script: ScriptFile,
    /// The number of steps done.
    pub steps: usize,
    /// The number of snapshots taken.
    pub snapshots: usize,
    /// The failures, in line order.
    pub failures: Vec<Failure>,
    /// The references written.
    pub updated: Vec<PathBuf>,
}

impl Report {
    /// Whether everything was as the script says.
    pub fn is_passed(&self) -> bool {
        self.failures.is_empty()
    }
}

/// A failure in a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// Counted from 1; 0 for the script as a whole.
    pub line: usize,
    /// What was expected and what was found.
    pub what: String,
    /// What to do about it; may be empty.
    pub hint: String,
    /// Files written for inspection.
    pub files: Vec<PathBuf>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.what)?;
        if !self.hint.is_empty() {
            write!(f, "; {}", self.hint)?;
        }
        Ok(())
    }
}

/// There are no scripts where they were looked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FindError {
    pub path: PathBuf,
    pub what: String,
}

impl fmt::Display for FindError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.path.display(), self.what)
    }
}

impl std::error::Error for FindError {}

/// The extension of scripts.
const ENDING: &str = ".replay";

/// A script with this name takes the name of its folder.
const FOLDERS_OWN: &str = "script";

/// The most failures reported for a script: enough to show what is wrong, without all that follows from
/// it.
const MOST_FAILURES: usize = 20;

/// The scripts named by paths: a file stands for itself, a folder for all files below it that end in
/// `.replay`, in name order.
///
/// # Errors
/// When a path does not exist, or a folder has no scripts.
pub fn find_scripts(paths: &[PathBuf]) -> Result<Vec<ScriptFile>, FindError> {
    let mut scripts = Vec::new();
    for path in paths {
        let fail = |what: &str| FindError { path: path.clone(), what: what.to_owned() };
        if path.is_file() {
            let title = title_of(path.file_name().map(Path::new).unwrap_or(path), path.parent());
            scripts.push(ScriptFile { path: path.clone(), title });
            continue;
        }
        if !path.is_dir() {
            return Err(fail("there is no such script"));
        }
        let before = scripts.len();
        for entry in walkdir::WalkDir::new(path).follow_links(true).sort_by_file_name() {
            let entry = entry.map_err(|error| fail(&error.to_string()))?;
            if entry.file_type().is_file() && entry.file_name().to_string_lossy().ends_with(ENDING) {
                let below = entry.path().strip_prefix(path).unwrap_or(entry.path());
                scripts.push(ScriptFile { title: title_of(below, Some(path)), path: entry.path().to_owned() });
            }
        }
        if scripts.len() == before {
            return Err(fail("no script in this folder; the names of scripts end in .replay"));
        }
    }
    // Two folders may contain scripts of the same name; what they write must not be mixed up.
    let titles: Vec<String> = scripts.iter().map(|script| script.title.clone()).collect();
    for (index, script) in scripts.iter_mut().enumerate() {
        let earlier = titles[..index].iter().filter(|title| **title == titles[index]).count();
        if earlier > 0 {
            script.title = format!("{}-{}", script.title, earlier + 1);
        }
    }
    Ok(scripts)
}

/// A script's path below the searched folder, as a title.
fn title_of(below: &Path, folder: Option<&Path>) -> String {
    let parts: Vec<String> = below.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    let Some((file, folders)) = parts.split_last() else { return FOLDERS_OWN.to_owned() };
    let stem = file.strip_suffix(ENDING).unwrap_or(file);
    let mut parts = folders.to_vec();
    if stem != FOLDERS_OWN {
        parts.push(stem.to_owned());
    } else if parts.is_empty() {
        let name = folder.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        parts.push(name.unwrap_or_else(|| FOLDERS_OWN.to_owned()));
    }
    parts.join("/")
}

/// Runs a script.
pub fn replay(script: &ScriptFile, options: &ReplayOptions) -> Report {
    replay_telling(script, options, &mut |_| {})
}

/// Runs a script and reports each step, by its line, when it is done: its changes are then in the
/// journal, if there is one.
pub fn replay_telling(script: &ScriptFile, options: &ReplayOptions, told: &mut dyn FnMut(usize)) -> Report {
    let mut report =
        Report { script: script.clone(), steps: 0, snapshots: 0, failures: Vec::new(), updated: Vec::new() };
    if let Err(failure) = run(script, options, told, &mut report) {
        report.failures.push(failure);
    }
    report
}

fn run(
    script: &ScriptFile,
    options: &ReplayOptions,
    told: &mut dyn FnMut(usize),
    report: &mut Report,
) -> Result<(), Failure> {
    let whole = |what: String, hint: &str| Failure { line: 0, what, hint: hint.to_owned(), files: Vec::new() };
    let bytes = read(&script.path).map_err(|what| whole(what, "check the path"))?;
    let parsed = match Script::parse(&bytes) {
        Ok(parsed) => parsed,
        Err(errors) => {
            report.failures.extend(errors.into_iter().map(|error| Failure {
                line: error.line,
                what: error.what,
                hint: error.hint,
                files: Vec::new(),
            }));
            return Ok(());
        }
    };
    // Thrown away afterwards; kept until then.
    let temporary = tempfile::Builder::new().prefix("enfilade-replay-").tempdir();
    let temporary = temporary.map_err(|error| whole(format!("no folder to work in: {error}"), "free some space"))?;
    let work = match &options.out {
        Some(out) => out.join(&script.title),
        // The last part is visible in the window, so it must always be the same.
        None => temporary.path().join(script.title.rsplit('/').next().unwrap_or(FOLDERS_OWN)),
    };
    std::fs::create_dir_all(&work).map_err(|error| whole(format!("{}: {error}", work.display()), ""))?;
    let beside = script.path.parent().unwrap_or(Path::new("")).to_owned();
    let folders = Folders {
        snapshots: options.snapshots.as_ref().map_or_else(|| beside.clone(), |folder| folder.join(&script.title)),
        script: beside,
        kept_pictures: options.out.is_some().then(|| work.clone()),
        work,
    };
    let mut stage = Stage::new(&folders, options.update);
    let mut checked: Option<Plan> = None;
    for step in &parsed.steps {
        let done = (step.act)(&mut stage).and_then(|()| settle(&mut stage)).and_then(|()| {
            // Comparing values is cheap: a plan is only checked if it changed.
            let plan = stage.window.app().plan();
            if plan.is_none() || plan.zip(checked.as_ref()).is_some_and(|(plan, last)| plan.is_same_value(last)) {
                return Ok(());
            }
            checked = plan.cloned();
            sweep(plan)
        });
        report.steps += 1;
        if done.is_ok() {
            told(step.line);
        }
        if let Err(fault) = done {
            let Fault { what, hint, files, goes_on } = fault;
            report.failures.push(Failure { line: step.line, what, hint, files });
            if !goes_on || report.failures.len() >= MOST_FAILURES {
                break;
            }
        }
    }
    if report.failures.is_empty() && stage.window.answers_left() > 0 {
        let left = super::stage::count(stage.window.answers_left(), "answer");
        report.failures.push(whole(format!("{left} left that no dialog asked for"), "take it out, or open the dialog"));
    }
    if let Some(name) = stage.window.job_to_stop().filter(|_| report.failures.is_empty()) {
        let what = format!("the job {} was to stop and did not start", super::words::in_quotes(name));
        let names: Vec<String> = stage.window.job_names().into_iter().map(super::words::in_quotes).collect();
        report.failures.push(whole(what, &format!("these have started: {}", names.join(", "))));
    }
    report.snapshots = stage.snapshots;
    report.updated = std::mem::take(&mut stage.updated);
    Ok(())
}

/// A script's bytes.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    let size = std::fs::metadata(path).map_err(|error| error.to_string())?;
    if !size.is_file() {
        return Err("this is no file".to_owned());
    }
    if size.len() > LARGEST_BYTES as u64 {
        return Err(format!("a script has at most {} MiB", LARGEST_BYTES >> 20));
    }
    formats::read_bytes(path).map_err(|error| error.error.to_string())
}

/// Lets the window settle after a step.
fn settle(stage: &mut Stage<'_>) -> Result<(), Fault> {
    stage
        .window
        .settle()
        .map_err(|error| Fault::new(error.to_string()).hint("something goes on without end; please report this"))?;
    if stage.window.take_unanswered() > 0 {
        let hint = "write what it is told before this step: file-dialog open PATH, file-dialog save PATH, or file-dialog cancel";
        return Err(Fault::new("a dialog asks for a file and has no answer").hint(hint));
    }
    Ok(())
}

/// Checks the plan's invariants, after every step.
fn sweep(plan: Option<&Plan>) -> Result<(), Fault> {
    let violations = plan.map(Plan::violations).unwrap_or_default();
    match violations.first() {
        None => Ok(()),
        Some(first) => {
            let what = format!("the plan broke its invariants: {first}");
            Err(Fault::new(what).hint("this is a mistake in Enfilade; please report it with the script"))
        }
    }
}
