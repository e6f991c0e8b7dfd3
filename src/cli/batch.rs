//! Processing many plans, in order but several at once: which files are meant, what is done with each,
//! and progress. An error in one never stops the rest.

use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

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

    /// Whether its beginning shows that it is no plan, although its name ends like one.
    fn is_foreign(&self) -> bool {
        let mut head = Vec::new();
        let file = std::fs::File::open(&self.path);
        let read = file.and_then(|file| file.take(formats::HEAD_BYTES as u64).read_to_end(&mut head));
        read.is_ok() && formats::foreign_kind(&self.path, &head).is_some()
    }
}

/// The plans that paths name: a file is itself, a folder all plans below it that are not for certain
/// something else, in the order of their paths.
///
/// # Errors
/// When a folder holds no plan.
pub fn inputs(paths: &[PathBuf]) -> Result<Vec<Input>, CliError> {
    inputs_but(paths, |_| false, |input| !input.is_foreign())
}

/// The same, without the folders that `is_left_out` names, and of the files found only those that are `wanted`.
///
/// # Errors
/// When a folder holds no plan.
pub fn inputs_but(
    paths: &[PathBuf],
    is_left_out: impl Fn(&Path) -> bool,
    wanted: impl Fn(&Input) -> bool,
) -> Result<Vec<Input>, CliError> {
    let mut inputs = Vec::new();
    for path in paths {
        if !path.is_dir() || formats::folder_format(path).is_some() {
            // A file that does not exist is reported when it is read, with the others going on.
            inputs.push(Input { path: path.clone(), root: None, problem: None });
            continue;
        }
        let before = inputs.len();
        let found = plans_below(path, usize::MAX, &is_left_out);
        let found = found.map(|it| Input { path: it.path, root: Some(path.clone()), problem: it.problem });
        inputs.extend(found.filter(&wanted));
        if inputs.len() == before {
            return Err(CliError::new(format!("{}: no plan files in this folder", path.display())));
        }
    }
    Ok(inputs)
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
    let quiet = Work::quiet();
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
/// read. Gives the number of inputs that failed.
///
/// # Errors
/// What `take` returns, or when stderr cannot be written.
pub fn for_each_import<T: Send>(
    inputs: &[Input],
    title: &str,
    terminal: &mut Terminal,
    work: impl Fn(&Input, Import) -> T + Sync,
    mut take: impl FnMut(&Input, T, &mut Terminal) -> Result<(), CliError>,
) -> Result<usize, CliError> {
    let mut failed = 0;
    let read = |input: &Input| input.read().map(|import| work(input, import));
    for_each(inputs, title, terminal, read, |input, result, terminal| match result {
        Ok(result) => take(input, result, terminal),
        Err(error) => {
            failed += 1;
            Ok(writeln!(terminal.err, "enfilade: {error}")?)
        }
    })?;
    Ok(failed)
}
