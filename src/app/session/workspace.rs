//! The open workspace: a folder of plans as a dataset. It is listed at once from the index of the last time, and read
//! beside the frames, a few files at a time, so that what is known is shown as it comes in.
//!
//! Panels that want a folder of plans take [`OpenWorkspace::now`]: a value of the workspace that stays as it is while they
//! work with it. [`OpenWorkspace::revision`] tells when there is another.

pub(crate) mod bulk;
pub(crate) mod shows;
pub(crate) mod storeys;
pub(crate) mod view;

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use super::Session;
use crate::app::session::file_dialogs::Purpose;
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::messages::Severity;
use crate::app::session::origin::{Origin, absolute};
use crate::app::session::wishes::Wish;
use crate::base::wording::thousands;
use crate::base::work::{Cancelled, Work};
use crate::plan::{ElementId, RoomId};
use crate::store::IndexFile;
use crate::workspace::index::{self, Listed, Recipe};
use crate::workspace::{PlanFile, PlanKey, PlanRow, Workspace, path_below};

/// The name of the jobs, by which the progress of the one that runs is found.
const JOB: &str = "read the plans of a folder";

/// So many files are read in one job, a thread: enough to be quick, few enough to see something soon.
const READ_AT_ONCE: usize = 24;

/// The same where rooms are predicted, which takes longer.
const PREDICTED_AT_ONCE: usize = 6;

/// An open folder of plans.
pub(crate) struct OpenWorkspace {
    /// What is known now. Keep the value while working with rows of it.
    pub now: Arc<Workspace>,
    /// Another whenever `now` is another.
    pub revision: u64,
    /// What is being found out; `None` once everything is known.
    pub indexing: Option<Indexing>,
    /// What the table shows.
    pub view: view::View,
    /// What was changed last in many files, to undo it.
    pub changed: Option<bulk::Changed>,
    recipe: Recipe,
    index: Option<Arc<IndexFile>>,
    /// Wanted as long as the folder is open.
    job: Option<Wanted>,
}

/// What is being found out about a workspace.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Indexing {
    pub step: Step,
    /// Files done, and their total, in this step.
    pub done: usize,
    pub count: usize,
    queue: VecDeque<Arc<str>>,
}

/// What is done to find it out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Step {
    /// The folder is listed.
    #[default]
    Listing,
    /// Files are read and checked.
    Reading,
    /// Rooms are predicted.
    Predicting,
}

impl Indexing {
    fn begun(step: Step, queue: Vec<Arc<str>>) -> Self {
        Self { step, done: 0, count: queue.len(), queue: queue.into() }
    }

    /// In words, with so many more done beside those taken in: '120 of 2,000 files read'.
    fn words(&self, more: usize) -> String {
        let figures = format!("{} of {}", thousands((self.done + more) as u64), thousands(self.count as u64));
        match self.step {
            Step::Listing => "Listing the folder".to_owned(),
            Step::Reading => format!("{figures} files read"),
            Step::Predicting => format!("Rooms of {figures} files predicted"),
        }
    }
}

impl OpenWorkspace {
    fn set(&mut self, now: Arc<Workspace>) {
        self.now = now;
        self.revision += 1;
    }

    /// Where a plan is opened from.
    pub(crate) fn origin_of(&self, key: &PlanKey) -> Origin {
        Origin::File { path: self.now.folder().join(&*key.path), storey: key.storey as usize }
    }

    /// The row of a plan that lies in the folder.
    pub(crate) fn row_of(&self, origin: &Origin) -> Option<PlanRow> {
        let Origin::File { path, storey } = origin else { return None };
        self.now.row_of(&PlanKey { path: self.path_below(path)?.into(), storey: u32::try_from(*storey).ok()? })
    }

    /// The path below the folder of a file that lies there, however it is written; `None` for another.
    fn path_below(&self, path: &Path) -> Option<String> {
        path_below(&absolute(self.now.folder()), &absolute(path))
    }
}

impl Session {
    /// Asks for a folder of plans.
    pub(crate) fn choose_workspace(&mut self) {
        let open = self.workspace.as_ref().map(|workspace| workspace.now.folder().to_owned());
        self.ask_for_file(Purpose::Workspace, open.or_else(|| self.list.folder.clone()), String::new());
    }

    /// Opens a folder of plans; of a file, the folder that it lies in. One that is open already is listed anew, and keeps
    /// what is shown of it.
    pub(crate) fn open_workspace(&mut self, path: &Path) {
        let folder = if path.is_file() { path.parent().unwrap_or(path).to_owned() } else { path.to_owned() };
        let recipe = Recipe::new(self.schemes.clone(), &self.models);
        let before = self.workspace.take().filter(|workspace| workspace.now.folder() == folder);
        let (now, revision, view, changed, index) = match before {
            // The old job ends with what it was wanted for.
            Some(before) => (before.now, before.revision + 1, before.view, before.changed, before.index),
            None => (Arc::new(Workspace::new(&folder, Vec::new())), 0, view::View::default(), None, None),
        };
        let indexing = Some(Indexing::default());
        self.workspace = Some(OpenWorkspace {
            now,
            revision,
            indexing,
            view,
            changed,
            recipe: recipe.clone(),
            index: None,
            job: None,
        });
        // Its file may be opened once at a time.
        drop(index);
        let cache = self.cache_folder.clone();
        self.start_indexing(move |work| {
            let listed = listed(&folder, cache.as_deref(), &recipe, work);
            move |session: &mut Session, _: &Context| {
                if let Ok((listed, index, broken)) = listed {
                    session.workspace_was_listed(listed, index, broken);
                }
            }
        });
    }

    /// Leaves the workspace.
    pub(crate) fn close_workspace(&mut self) {
        self.workspace = None;
    }

    /// Reads some files of the workspace again, after they were written; those that lie elsewhere are passed over.
    pub(crate) fn read_in_workspace_again(&mut self, paths: &[PathBuf]) {
        let Some(workspace) = &mut self.workspace else { return };
        let below = paths.iter().filter_map(|path| workspace.path_below(path));
        let below: Vec<Arc<str>> =
            below.filter(|path| crate::formats::is_plan_file_name(path)).map(Into::into).collect();
        if below.is_empty() {
            return;
        }
        match &mut workspace.indexing {
            // They are listed anyway.
            Some(Indexing { step: Step::Listing, .. }) => {}
            Some(Indexing { step: Step::Reading, queue, count, .. }) => {
                *count += below.len();
                queue.extend(below);
            }
            Some(Indexing { step: Step::Predicting, .. }) | None => {
                let is_idle = workspace.indexing.is_none();
                workspace.indexing = Some(Indexing::begun(Step::Reading, below));
                if is_idle {
                    self.index_next();
                }
            }
        }
    }

    /// How far what is being found out about the workspace is: the share that is done, 0..=1, and in words. `None` once
    /// everything is known.
    pub(crate) fn indexing_shown(&self) -> Option<(f64, String)> {
        let indexing = self.workspace.as_ref()?.indexing.as_ref()?;
        if indexing.step == Step::Listing {
            return Some((0.0, indexing.words(0)));
        }
        // What the job that runs has done so far.
        let more = self.jobs.progress_of(JOB).map_or(0, |(done, _)| done);
        let more = more.min(indexing.count.saturating_sub(indexing.done));
        Some(((indexing.done + more) as f64 / indexing.count.max(1) as f64, indexing.words(more)))
    }

    fn start_indexing<O>(&mut self, job: impl FnOnce(&Work<'_>) -> O + Send + 'static)
    where
        O: FnOnce(&mut Session, &Context) + Send + 'static,
    {
        let kind = Kind::new(JOB).newest_of("workspace").if_broken(|session| {
            if let Some(workspace) = &mut session.workspace {
                (workspace.indexing, workspace.index) = (None, None);
            }
        });
        let job = self.jobs.start_wanted(kind, move |work| {
            // A thread stays free for the frames.
            job(&work.on_threads(work.threads().saturating_sub(1)))
        });
        if let Some(workspace) = &mut self.workspace {
            workspace.job = Some(job);
        }
    }

    fn workspace_was_listed(&mut self, listed: Listed, index: Option<Arc<IndexFile>>, broken: Option<String>) {
        let Some(workspace) = &mut self.workspace else { return };
        workspace.set(Arc::new(listed.workspace));
        workspace.index = index;
        workspace.indexing = Some(Indexing::begun(Step::Reading, listed.to_read));
        if let Some(what) = broken {
            let detail = format!("It is made anew from the plans; nothing is lost. ({what})");
            self.say_of_program(Severity::Info, "The index of this folder could not be used", detail);
        }
        self.index_next();
    }

    /// Goes on with finding out what is not known.
    fn index_next(&mut self) {
        let Some(workspace) = &mut self.workspace else { return };
        let Some(indexing) = &mut workspace.indexing else { return };
        if indexing.queue.is_empty() {
            let next = if indexing.step == Step::Reading { index::to_predict(&workspace.now) } else { Vec::new() };
            if next.is_empty() {
                // Others may have the index now.
                (workspace.indexing, workspace.index) = (None, None);
                return;
            }
            *indexing = Indexing::begun(Step::Predicting, next);
        }
        let predicts = indexing.step == Step::Predicting;
        let at_once = if predicts { PREDICTED_AT_ONCE } else { READ_AT_ONCE } * self.jobs.threads();
        let paths: Vec<Arc<str>> = indexing.queue.drain(..at_once.min(indexing.queue.len())).collect();
        let (now, recipe, index) = (workspace.now.clone(), workspace.recipe.clone(), workspace.index.clone());
        self.start_indexing(move |work| {
            let read = read(&now, &paths, &recipe, index.as_deref(), predicts, work);
            move |session: &mut Session, _: &Context| {
                if let Ok(files) = read {
                    session.workspace_was_read(files);
                }
            }
        });
    }

    fn workspace_was_read(&mut self, files: Vec<Option<PlanFile>>) {
        let Some(workspace) = &mut self.workspace else { return };
        if let Some(indexing) = &mut workspace.indexing {
            indexing.done += files.len();
        }
        // In place, unless somebody works with the value as it was.
        Arc::make_mut(&mut workspace.now).put(files.into_iter().flatten());
        workspace.revision += 1;
        self.index_next();
    }

    /// Opens a plan of the workspace, and selects a room in it.
    pub(crate) fn open_of_workspace(&mut self, key: &PlanKey, room: Option<RoomId>) {
        let Some(workspace) = &self.workspace else { return };
        let origin = workspace.origin_of(key);
        self.awaited_room = room.map(|room| (origin.clone(), room));
        // Recorded and opened as a person opens it: from plan to plan, not all stay open.
        self.wishes.push(Wish::OpenListed(origin));
    }

    /// Selects the room that was asked for, once its plan is shown.
    pub(crate) fn show_awaited_room(&mut self) {
        let Some((origin, room)) = &self.awaited_room else { return };
        // It may have been opened by another path.
        let wanted = self.open_of(origin);
        let Some(document) = self.document.as_ref().filter(|document| wanted == Some(document.number)) else { return };
        let element = ElementId::Room(*room);
        if document.plan().room(*room).is_some() {
            self.pick(Some(element));
            self.wishes.push(Wish::Reveal(element));
        }
        self.awaited_room = None;
    }
}

/// What is listed, the index to keep the rest in, and what was wrong with the index before.
type ListedAndIndex = (Listed, Option<Arc<IndexFile>>, Option<String>);

/// Lists a folder with what an index knows of it, and gives the index to keep the rest in.
fn listed(folder: &Path, cache: Option<&Path>, recipe: &Recipe, work: &Work<'_>) -> Result<ListedAndIndex, Cancelled> {
    // Without an index everything is found out anew, and nothing else is different.
    let known = cache.and_then(|cache| IndexFile::open(cache, folder).ok());
    let (index, files, broken) = match known {
        Some(known) => (Some(Arc::new(known.index)), known.files, known.broken),
        None => (None, Vec::new(), None),
    };
    let listed = index::list(folder, &files, recipe, work)?;
    if let Some(index) = index.as_ref().filter(|_| !listed.gone.is_empty()) {
        // What is gone is only not forgotten.
        let _ = index.keep(&[], &listed.gone);
    }
    Ok((listed, index, broken))
}

/// Reads some files, and keeps in the index what was found; `None` for a file that is as it was.
fn read(
    now: &Workspace,
    paths: &[Arc<str>],
    recipe: &Recipe,
    index: Option<&IndexFile>,
    predicts: bool,
    work: &Work<'_>,
) -> Result<Vec<Option<PlanFile>>, Cancelled> {
    let files = work.map(paths.len(), |at| {
        let known = now.find(&paths[at]).map(|file| &*now.files()[file]);
        let file = index::read(now.folder(), &paths[at], known, recipe, predicts);
        (known != Some(&file)).then_some(file)
    })?;
    if let Some(index) = index {
        let found: Vec<(String, Vec<u8>)> = files.iter().flatten().map(|file| index::to_keep(file, recipe)).collect();
        // An index that cannot be written is found out again the next time.
        let _ = index.keep(&found, &[]);
    }
    Ok(files)
}
