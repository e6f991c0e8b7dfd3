//! Processing many plans, in order but several at once: which files are meant, what is done with each,
//! and progress. An error in one never stops the rest.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use super::inputs::from_stdin;
use super::outputs::Outputs;
use super::progress::Progress;
use super::{CliError, Terminal};
use crate::base::work::Work;
use crate::formats::{self, FileError, Import, Place, ReadError, Reading};
use crate::store::plans_below;

/// A plan named on the command line, or found in a folder that is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    pub path: PathBuf,
    /// The folder on the command line in which it was found; `None` if it is named itself.
    pub root: Option<PathBuf>,
    /// Where it stands in a folder that mirrors what was named: its name behind the folders below `root`.
    pub within: PathBuf,
    /// Why it cannot be read, where finding it showed that.
    problem: Option<String>,
}

impl Input {
    /// Reads it.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(&self) -> Result<Import, FileError> {
        self.check()?;
        formats::read_file(&self.path)
    }

    /// Reads it with the user's options; the inner error is for a file found in a folder that is not a
    /// plan, see [`formats::foreign_kind`], and says what it is instead.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read_or_pass(&self, reading: &Reading) -> Result<Result<Import, String>, FileError> {
        self.check()?;
        if self.path.is_dir() {
            return reading.file(&self.path).map(Ok);
        }
        let bytes = formats::read_bytes(&self.path)?;
        match formats::foreign_kind(&self.path, &bytes) {
            Some(kind) if self.root.is_some() => Ok(Err(kind)),
            _ => reading.bytes(&self.path, &bytes).map(Ok),
        }
    }

    /// The problem found when listing it, if any.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn check(&self) -> Result<(), FileError> {
        let Some(problem) = &self.problem else { return Ok(()) };
        let error = ReadError { place: Place::default(), what: problem.clone(), hint: "check the path".to_owned() };
        Err(FileError { path: self.path.clone(), error })
    }

    /// The path of a result in a folder that mirrors what was named: the source's name up to its first known
    /// ending, later storeys of one file numbered from 2. Where this call wrote such a file already, of a plan beside
    /// its export say, the source's own ending stays as well.
    pub fn mirrored(&self, folder: &Path, storey: usize, ending: &str, outputs: &Outputs) -> PathBuf {
        let name = self.within.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let number = if storey == 0 { String::new() } else { format!("-{}", storey + 1) };
        let named = |stem: &str| folder.join(self.within.with_file_name(format!("{stem}{number}.{ending}")));
        let path = named(formats::file_stem(&name));
        if outputs.has(&path) { named(&name) } else { path }
    }

    /// Whether its beginning shows that it is no plan, although its name ends like one.
    fn is_foreign(&self) -> bool {
        let mut head = Vec::new();
        let file = std::fs::File::open(&self.path);
        let read = file.and_then(|file| file.take(formats::HEAD_BYTES as u64).read_to_end(&mut head));
        read.is_ok() && formats::foreign_kind(&self.path, &head).is_some()
    }
}

/// The plans that paths name: a file is itself, a folder all plans below it that are not for certain
/// something else, in the order of their paths; `-` is stdin.
pub fn inputs(paths: &[PathBuf]) -> Vec<Input> {
    inputs_into(paths, None)
}

/// The same, when results go to `output`: a folder of that name within another is no source.
pub fn inputs_into(paths: &[PathBuf], output: Option<&Path>) -> Vec<Input> {
    let output = output.and_then(|output| output.canonicalize().ok()).filter(|output| output.is_dir());
    let is_output = |path: &Path| output.is_some() && path.canonicalize().ok() == output;
    inputs_but(paths, is_output, |input| !input.is_foreign())
}

/// The same, without the folders that `is_left_out` names, and of the files found only those that are `wanted`. A
/// folder without any is an input that cannot be read, so that the others go on.
pub fn inputs_but(
    paths: &[PathBuf],
    is_left_out: impl Fn(&Path) -> bool,
    wanted: impl Fn(&Input) -> bool,
) -> Vec<Input> {
    let mut inputs = Vec::new();
    let mut prefixes = BTreeSet::new();
    for path in paths {
        let path = &from_stdin(path);
        if !path.is_dir() || formats::folder_format(path).is_some() {
            // A file that does not exist is reported when it is read, with the others going on.
            let within = path.file_name().map(PathBuf::from).unwrap_or_else(|| PathBuf::from("plan"));
            inputs.push(Input { path: path.clone(), root: None, within, problem: None });
            continue;
        }
        let before = inputs.len();
        let prefix = if paths.len() > 1 { prefix(path, &mut prefixes) } else { PathBuf::new() };
        let found = plans_below(path, usize::MAX, &is_left_out).map(|it| {
            let within = prefix.join(it.path.strip_prefix(path).unwrap_or(&it.path));
            Input { path: it.path, root: Some(path.clone()), within, problem: it.problem }
        });
        inputs.extend(found.filter(|input| input.problem.is_some() || wanted(input)));
        if inputs.len() == before {
            let problem = Some("no plan files in this folder".to_owned());
            inputs.push(Input { path: path.clone(), root: None, within: PathBuf::from("plan"), problem });
        }
    }
    inputs
}

/// The folder that mirrors one of several that are named: of its name, numbered where two have the same.
fn prefix(root: &Path, taken: &mut BTreeSet<String>) -> PathBuf {
    let name = root.canonicalize().ok().and_then(|root| Some(root.file_name()?.to_string_lossy().into_owned()));
    let name = name.unwrap_or_else(|| "folder".to_owned());
    let numbered = |number: usize| if number == 1 { name.clone() } else { format!("{name}-{number}") };
    let free = (1..).map(numbered).find(|name| taken.insert(name.to_lowercase()));
    PathBuf::from(free.unwrap_or(name))
}

/// Inputs per thread processed before their results are handed over: enough to keep all threads busy, few
/// enough to hold in memory.
const AT_ONCE: usize = 4;

/// Processes each input, several at once, and hands the results over in input order, with a progress
/// line. The results do not depend on the number of threads.
///
/// # Errors
/// What `take` returns; then no further input is started.
pub fn for_each<T: Send>(
    inputs: &[Input],
    title: &str,
    terminal: &mut Terminal,
    work: impl Fn(&Input) -> T + Sync,
    mut take: impl FnMut(&Input, T, &mut Terminal) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let quiet = match terminal.call.jobs {
        Some(threads) => Work::quiet().on_threads(threads),
        None => Work::quiet(),
    };
    let progress = Progress::new(title, inputs.len(), terminal);
    for (round, chunk) in inputs.chunks(AT_ONCE * quiet.threads()).enumerate() {
        let before = round * AT_ONCE * quiet.threads();
        let told = |done: usize, _: usize| progress.tell(before + done);
        let results = quiet.watched(&told, &progress.never).map(chunk.len(), |index| work(&chunk[index]))?;
        progress.clear();
        for (input, result) in chunk.iter().zip(results) {
            take(input, result, terminal)?;
        }
    }
    Ok(())
}

/// Reads the plans of each input and works on them as [`for_each`] does, saying on stderr what could not be
/// read or done; the others go on. With `--verbose` it says as well what was mended or left out in reading. Gives
/// the number of inputs that failed.
///
/// # Errors
/// When not one input could be read, or the output cannot be written.
pub fn for_each_import<T: Send>(
    inputs: &[Input],
    title: &str,
    terminal: &mut Terminal,
    work: impl Fn(&Input, Import) -> T + Sync,
    mut take: impl FnMut(&Input, T, &mut Terminal) -> Result<(), CliError>,
) -> Result<usize, CliError> {
    let (mut failed, mut unreadable) = (0, 0);
    let tells = terminal.call.verbose;
    let read = |input: &Input| {
        input.read().map(|import| {
            let notes = if tells { import.notes.clone() } else { Vec::new() };
            (notes, work(input, import))
        })
    };
    for_each(inputs, title, terminal, read, |input, result, terminal| {
        let (notes, result) = match result {
            Ok(read) => read,
            Err(error) => {
                (failed, unreadable) = (failed + 1, unreadable + 1);
                return Ok(terminal.error(error)?);
            }
        };
        for note in notes {
            let line = note.place.line.map(|line| format!(":{line}")).unwrap_or_default();
            terminal.detail(format!("{}{line}: {}: {}", input.path.display(), note.kind.name(), note.what))?;
        }
        match take(input, result, terminal) {
            Err(error) if !error.broken_pipe && !error.wrong_call => {
                failed += 1;
                Ok(terminal.error(error.message)?)
            }
            done => done,
        }
    })?;
    if unreadable == inputs.len() {
        return Err(nothing_to_read());
    }
    Ok(failed)
}

/// What every subcommand says when there is nothing that it could work on, after the reason for each input.
pub fn nothing_to_read() -> CliError {
    CliError::new("no plan could be read; nothing was written")
}
