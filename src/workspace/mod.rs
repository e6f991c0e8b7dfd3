//! A folder of plans as a dataset: what is known of every plan and room in it, searched, filtered and sorted.
//!
//! [`Workspace`] is a value: the files of a folder and what was found in each. [`index`] finds it out, in any number of
//! steps, and knows what an index on the disk kept from the last time. [`query`] answers what the table of plans and the
//! table of rooms show; [`buildings`] puts the storeys of a building in order; [`change`] changes many plans at once.

pub mod buildings;
pub mod change;
mod entry;
pub mod index;
mod outlines;
pub mod query;
mod record;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use entry::{PlanEntry, Problems, RoomEntry};
pub use outlines::{OutlinedRoom, Outlines};

use crate::labels::Typology;
use crate::plan::RoomId;
use crate::store::FileState;

/// A folder of plans, and what is known of them. Cloning it is cheap: files are shared.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    folder: PathBuf,
    /// Sorted by path.
    files: Vec<Arc<PlanFile>>,
}

/// A file with plans, or a folder that is one.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanFile {
    /// Its path below the workspace's folder, with forward slashes.
    pub path: Arc<str>,
    pub state: FileState,
    /// Hash of its bytes when it was read; 0 of a folder and of what was not read.
    pub hash: u64,
    pub content: Content,
}

/// What is known of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// It is listed, and not read yet.
    Pending,
    /// Its plans, at least one.
    Plans(Vec<PlanEntry>),
    /// Why it cannot be read, and what to do.
    Broken(String),
    /// It is named like a plan and is something else, in words: not shown.
    Foreign(String),
}

impl PlanFile {
    /// Its plans; none while it is not read, or if it cannot be.
    pub fn plans(&self) -> &[PlanEntry] {
        match &self.content {
            Content::Plans(plans) => plans,
            _ => &[],
        }
    }

    /// Its name without folders.
    pub fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or(&self.path)
    }

    /// The title of one of its plans: its name, or else the file's.
    pub fn title_of<'a>(&'a self, plan: &'a PlanEntry) -> &'a str {
        if plan.name.is_empty() { self.name() } else { &plan.name }
    }
}

/// The path below a folder of a file that lies there, with slashes; `None` for another.
pub fn path_below(folder: &Path, path: &Path) -> Option<String> {
    let below = path.strip_prefix(folder).ok()?;
    let parts: Vec<String> = below.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    Some(parts.join("/"))
}

/// A plan of a workspace, by its places in this value of it: [`Workspace::files`], and [`PlanFile::plans`] (`None` for a
/// file that is not read, or cannot be).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PlanRow {
    pub file: u32,
    pub plan: Option<u32>,
}

/// A room of a workspace, by its places in this value of it: file, plan, and [`PlanEntry::rooms`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RoomRow {
    pub file: u32,
    pub plan: u32,
    pub room: u32,
}

impl RoomRow {
    /// The plan it is in.
    pub const fn plan_row(self) -> PlanRow {
        PlanRow { file: self.file, plan: Some(self.plan) }
    }
}

/// What a plan is known by whatever is read anew: its file, and its place in it from 0.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PlanKey {
    pub path: Arc<str>,
    pub storey: u32,
}

/// What a room is known by whatever is read anew.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RoomKey {
    pub plan: PlanKey,
    pub room: RoomId,
}

/// Counts over a workspace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    pub plans: usize,
    pub rooms: usize,
    /// Rooms that a scheme does not leave blank, and those of them with a label.
    pub to_label: usize,
    pub labelled: usize,
    /// Files that are not read yet, and those that cannot be.
    pub pending: usize,
    pub broken: usize,
}

impl Workspace {
    /// A folder with these files, in any order.
    pub fn new(folder: &Path, mut files: Vec<Arc<PlanFile>>) -> Self {
        files.sort_by(|p, q| p.path.cmp(&q.path));
        files.dedup_by(|p, q| p.path == q.path);
        Self { folder: folder.to_owned(), files }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// All files, those that are no plans included, sorted by path.
    pub fn files(&self) -> &[Arc<PlanFile>] {
        &self.files
    }

    /// Where a file lies.
    pub fn path_of(&self, file: &PlanFile) -> PathBuf {
        self.folder.join(&*file.path)
    }

    /// The place of a file by its path below the folder.
    pub fn find(&self, path: &str) -> Option<usize> {
        self.files.binary_search_by(|file| (*file.path).cmp(path)).ok()
    }

    /// Puts files in, each in the place of the one of its path.
    pub fn put(&mut self, files: impl IntoIterator<Item = PlanFile>) {
        for file in files {
            match self.files.binary_search_by(|known| known.path.cmp(&file.path)) {
                Ok(at) => self.files[at] = Arc::new(file),
                Err(at) => self.files.insert(at, Arc::new(file)),
            }
        }
    }

    /// Takes a file out, if it is there.
    pub fn remove(&mut self, path: &str) {
        if let Some(at) = self.find(path) {
            self.files.remove(at);
        }
    }

    /// A file and its plan.
    pub fn plan(&self, row: PlanRow) -> Option<(&PlanFile, Option<&PlanEntry>)> {
        let file = self.files.get(row.file as usize)?;
        Some((file, row.plan.and_then(|plan| file.plans().get(plan as usize))))
    }

    /// A room, with its file and its plan.
    pub fn room(&self, row: RoomRow) -> Option<(&PlanFile, &PlanEntry, &RoomEntry)> {
        let file = self.files.get(row.file as usize)?;
        let plan = file.plans().get(row.plan as usize)?;
        Some((file, plan, plan.rooms.get(row.room as usize)?))
    }

    /// What a plan is known by.
    pub fn plan_key(&self, row: PlanRow) -> Option<PlanKey> {
        let file = self.files.get(row.file as usize)?;
        Some(PlanKey { path: file.path.clone(), storey: row.plan.unwrap_or(0) })
    }

    /// What a room is known by.
    pub fn room_key(&self, row: RoomRow) -> Option<RoomKey> {
        let (_, _, room) = self.room(row)?;
        Some(RoomKey { plan: self.plan_key(row.plan_row())?, room: room.id })
    }

    /// The row of a plan.
    pub fn row_of(&self, key: &PlanKey) -> Option<PlanRow> {
        let file = self.find(&key.path)?;
        let plan = self.files[file].plans().get(key.storey as usize).map(|_| key.storey);
        Some(PlanRow { file: u32::try_from(file).ok()?, plan })
    }

    /// Every plan, and every file that has none because it is not read or cannot be, by path.
    pub fn plan_rows(&self) -> impl Iterator<Item = PlanRow> + '_ {
        self.files.iter().enumerate().flat_map(|(at, file)| {
            let plans = match &file.content {
                Content::Plans(plans) => plans.len(),
                Content::Pending | Content::Broken(_) => 1,
                Content::Foreign(_) => 0,
            };
            let has_plans = !file.plans().is_empty();
            (0..plans).map(move |plan| PlanRow { file: at as u32, plan: has_plans.then_some(plan as u32) })
        })
    }

    /// Every room, by path.
    pub fn room_rows(&self) -> impl Iterator<Item = RoomRow> + '_ {
        self.files.iter().enumerate().flat_map(|(at, file)| {
            file.plans().iter().enumerate().flat_map(move |(plan, entry)| {
                (0..entry.rooms.len() as u32).map(move |room| RoomRow { file: at as u32, plan: plan as u32, room })
            })
        })
    }

    /// Counts over all plans.
    pub fn totals(&self) -> Totals {
        let mut totals = Totals::default();
        for file in &self.files {
            match &file.content {
                Content::Pending => totals.pending += 1,
                Content::Broken(_) => totals.broken += 1,
                Content::Foreign(_) => {}
                Content::Plans(plans) => {
                    totals.plans += plans.len();
                    for plan in plans {
                        totals.rooms += plan.rooms.len();
                        totals.to_label += plan.to_label;
                        totals.labelled += plan.labelled;
                    }
                }
            }
        }
        totals
    }

    /// The typologies that plans state, with the number of plans of each; `None` for those that state none.
    pub fn typologies(&self) -> BTreeMap<Option<Typology>, usize> {
        let mut found = BTreeMap::new();
        for plan in self.files.iter().flat_map(|file| file.plans()) {
            *found.entry(plan.typology.clone()).or_default() += 1;
        }
        found
    }
}
