//! Finding out what is in the files of a folder: which are there, which are as they were, and what is in the others.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::{Content, PlanEntry, PlanFile, Workspace, path_below, record};
use crate::base::hash;
use crate::base::work::{Cancelled, Work};
use crate::classify::models::Models;
use crate::formats::{self, FileError};
use crate::labels::Schemes;
use crate::store::{FileState, plans_below};

/// How entries are made: with these schemes and models.
#[derive(Clone)]
pub struct Recipe {
    pub schemes: Arc<Schemes>,
    pub models: Models,
    /// Differs where the entries would.
    number: u64,
}

/// Raise it when entries are made in another way.
const VERSION: u64 = 1;

impl Recipe {
    /// Entries by these schemes and models.
    pub fn new(schemes: Arc<Schemes>, models: &Models) -> Self {
        let own = models.own().iter().flat_map(|model| [model.name.clone(), format!("{:?}", model.checksum)]);
        let parts = [env!("CARGO_PKG_VERSION").to_owned(), format!("{VERSION}"), format!("{schemes:?}")];
        let number = parts.into_iter().chain(own).fold(hash::START, |hash, part| {
            let length = (part.len() as u64).to_le_bytes();
            hash::fnv1a(hash::fnv1a(hash, length), part.bytes())
        });
        Self { schemes, models: models.clone(), number }
    }
}

/// A folder as it was listed, and what has to be found out.
pub struct Listed {
    pub workspace: Workspace,
    /// The paths of the files that have to be read: all that are new or may have changed.
    pub to_read: Vec<Arc<str>>,
    /// The paths that an index knows, of files that are gone.
    pub gone: Vec<String>,
}

/// Lists the plans of a folder: those as they were when an index was made are known at once.
///
/// # Errors
/// When cancelled.
pub fn list(folder: &Path, known: &[(String, Vec<u8>)], recipe: &Recipe, work: &Work<'_>) -> Result<Listed, Cancelled> {
    let decoded = work.alone().on_threads(work.threads()).map(known.len(), |at| {
        let (path, bytes) = &known[at];
        record::from_bytes(path, bytes, recipe.number)
    })?;
    let mut before: BTreeMap<&str, Option<PlanFile>> =
        known.iter().map(|(path, _)| path.as_str()).zip(decoded).collect();
    let listed = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };

    let (mut files, mut to_read) = (Vec::new(), Vec::new());
    for (at, found) in plans_below(listed, usize::MAX, |_| false).enumerate() {
        if at % 256 == 0 {
            work.goes_on()?;
        }
        let Some(path) = path_below(listed, &found.path) else { continue };
        let known = before.remove(path.as_str()).flatten();
        let state = FileState::of(&found.path).unwrap_or_default();
        let file = match (found.problem, known) {
            (Some(problem), _) => PlanFile {
                path: path.into(),
                state,
                hash: 0,
                content: Content::Broken(format!("{problem}; check the path")),
            },
            (None, Some(known)) if state.is_surely(&known.state) => known,
            // Shown as it was until it is read.
            (None, Some(known)) => {
                to_read.push(known.path.clone());
                known
            }
            (None, None) => {
                let path: Arc<str> = path.into();
                to_read.push(path.clone());
                PlanFile { path, state, hash: 0, content: Content::Pending }
            }
        };
        files.push(Arc::new(file));
    }
    let gone = before.into_keys().map(str::to_owned).collect();
    Ok(Listed { workspace: Workspace::new(folder, files), to_read, gone })
}

/// What is in a file, found out now; of a file that holds the bytes that it held before, what is known already. With
/// `predicts` rooms are predicted too, which takes most of the time.
pub fn read(folder: &Path, path: &Arc<str>, known: Option<&PlanFile>, recipe: &Recipe, predicts: bool) -> PlanFile {
    let at = folder.join(&**path);
    // Before the bytes: what is written in between is seen the next time.
    let state = FileState::of(&at).unwrap_or_default();
    let (hash, content) = match content(&at, known, recipe, predicts) {
        Ok(found) => found,
        Err(FileError { error, .. }) => (0, Content::Broken(error.to_string())),
    };
    PlanFile { path: path.clone(), state, hash, content }
}

fn content(at: &Path, known: Option<&PlanFile>, recipe: &Recipe, predicts: bool) -> Result<(u64, Content), FileError> {
    let (hash, import) = if at.is_dir() {
        (0, formats::read_file(at)?)
    } else {
        let bytes = formats::read_bytes(at)?;
        let hash = hash::fnv1a(hash::START, bytes.iter().copied());
        if let Some(known) = known
            && known.hash == hash
            && known.content != Content::Pending
            && (!predicts || known.plans().iter().all(|plan| plan.is_predicted))
        {
            return Ok((hash, known.content.clone()));
        }
        if let Some(kind) = formats::foreign_kind(at, &bytes) {
            return Ok((hash, Content::Foreign(kind)));
        }
        (hash, formats::read_from(at, &bytes)?)
    };
    let models = predicts.then_some(&recipe.models);
    let plans = import.plans.iter().map(|plan| PlanEntry::of(plan, &recipe.schemes, models)).collect();
    Ok((hash, Content::Plans(plans)))
}

/// What an index keeps of a file.
pub fn to_keep(file: &PlanFile, recipe: &Recipe) -> (String, Vec<u8>) {
    (file.path.to_string(), record::to_bytes(file, recipe.number))
}

/// The paths of the files with plans whose rooms have not been predicted.
pub fn to_predict(workspace: &Workspace) -> Vec<Arc<str>> {
    let is_wanted = |file: &&Arc<PlanFile>| file.plans().iter().any(|plan| !plan.is_predicted);
    workspace.files().iter().filter(is_wanted).map(|file| file.path.clone()).collect()
}
