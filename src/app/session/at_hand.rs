//! The labelled rooms at hand: of a folder of plans, of a dataset, or of the open plans; read in the background for the
//! dashboard, for training and for the editor of schemes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use super::Session;
use crate::app::session::document::Document;
use crate::app::session::file_dialogs::Purpose;
use crate::app::session::jobs::{Kind, Wanted};
use crate::app::session::origin::Origin;
use crate::app::session::plan_list::{Depth, plans_in};
use crate::app::session::wishes::Wish;
use crate::app::value::{Call, Value};
use crate::base::work::Work;
use crate::dataset::changes::Changes;
use crate::dataset::folds::building_of;
use crate::dataset::sets::STANDARD;
use crate::dataset::{Collection, Row, csv};
use crate::features::NeighbourLabels;
use crate::formats::{self, FileError};
use crate::gather::{FileRead, PlansRead};
use crate::labels::{Meaning, Schemes, Typology, normalised_function};
use crate::plan::{ElementId, Plan, RoomId};
use crate::store;

/// The name of the job, by which its progress is found.
const JOB: &str = "read the labelled rooms";

/// Where rooms come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// All plans below a folder.
    Folder(PathBuf),
    /// A dataset (.csv).
    Table(PathBuf),
    /// The open plans, as they are now.
    OpenPlans,
}

/// Labelled rooms, and what is known of the plans they are in.
pub(crate) struct AtHand {
    pub source: Source,
    pub collection: Collection,
    /// With their neighbours' true labels.
    pub rows: Vec<Row>,
    pub plans: usize,
    pub buildings: usize,
    /// The files that could not be read.
    pub unreadable: Vec<FileError>,
    /// Rooms that a scheme labels, by typology and function: how many in each plan.
    pub by_scheme: BTreeMap<(Typology, String), BTreeMap<usize, usize>>,
    /// What changed since the dataset of the folder was exported; `None` where there is none.
    pub since_export: Option<SinceExport>,
    /// The plan of each row, by file, plan and storey.
    origins: BTreeMap<(String, String, String), Origin>,
}

/// What changed since an export.
pub(crate) struct SinceExport {
    /// The table.
    pub path: PathBuf,
    pub before: Vec<Row>,
    pub changes: Changes,
}

/// The rooms at hand, and whether they are being read.
#[derive(Default)]
pub(crate) struct RoomsAtHand {
    pub read: Option<Arc<AtHand>>,
    /// Why they could not be read.
    pub error: Option<String>,
    asked: Option<Source>,
    job: Option<Wanted>,
}

impl RoomsAtHand {
    pub(crate) fn is_reading(&self) -> bool {
        self.job.is_some()
    }
}

impl AtHand {
    /// The sets of its rooms: each typology, and all together where there are several.
    pub(crate) fn sets(&self) -> Vec<String> {
        let typologies = self.collection.typologies();
        let mut sets: Vec<String> = typologies.iter().map(|typology| typology.as_str().to_owned()).collect();
        if sets.len() != 1 {
            sets.push(STANDARD.to_owned());
        }
        sets
    }

    /// The rows of a set, with their indices.
    pub(crate) fn rows_of(&self, set: &str) -> Vec<(usize, &Row)> {
        let is_of = |row: &Row| set == STANDARD || row.typology.as_ref().is_some_and(|it| it.as_str() == set);
        self.rows.iter().enumerate().filter(|(_, row)| is_of(row)).collect()
    }

    /// The plan and the id of a row's room; `None` for a row of a table.
    pub(crate) fn room_of(&self, row: usize) -> Option<(&Origin, RoomId)> {
        let row = self.rows.get(row)?;
        let key = (row.file.clone(), row.plan.clone(), row.storey.clone());
        Some((self.origins.get(&key)?, row.id.parse().ok()?))
    }
}

/// What one plan adds to the schemes' count.
fn counted(plan: &Plan, index: usize, by_scheme: &mut BTreeMap<(Typology, String), BTreeMap<usize, usize>>) {
    let Some(typology) = plan.meta().typology.clone() else { return };
    for (_, room) in plan.rooms().filter(|(_, room)| room.label.is_none() && !room.function.is_empty()) {
        let key = (typology.clone(), normalised_function(&room.function));
        *by_scheme.entry(key).or_default().entry(index).or_default() += 1;
    }
}

/// How many rooms in how many plans would mean something else.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Affected {
    pub rooms: usize,
    pub plans: usize,
}

impl AtHand {
    /// The rooms of a typology whose label changes where schemes change.
    pub(crate) fn affected(&self, typology: &Typology, before: &Schemes, after: &Schemes) -> Affected {
        let meaning =
            |schemes: &Schemes, function: &str| -> Option<Meaning> { schemes.meaning(Some(typology), function) };
        let mut plans: BTreeSet<usize> = BTreeSet::new();
        let mut rooms = 0;
        for ((_, function), of_plans) in self.by_scheme.iter().filter(|((of, _), _)| of == typology) {
            if meaning(before, function) != meaning(after, function) {
                plans.extend(of_plans.keys());
                rooms += of_plans.values().sum::<usize>();
            }
        }
        Affected { rooms, plans: plans.len() }
    }
}

/// What is read from: files with the names they are shown by, or plans.
enum Input {
    Files(Vec<(PathBuf, String)>, Option<PathBuf>),
    Table(PathBuf, String),
    Plans(Vec<(String, Origin, Plan)>),
}

impl Session {
    /// What the dashboard and training are about unless told otherwise: the folder of plans that is open, the one that is
    /// listed, or the open plans.
    pub(crate) fn usual_source(&self) -> Source {
        if let Some(workspace) = &self.workspace {
            return Source::Folder(workspace.now.folder().to_owned());
        }
        match self.dataset_source() {
            Some((folder, _)) => Source::Folder(folder.to_owned()),
            None => Source::OpenPlans,
        }
    }

    /// What is at hand, in words: a folder's name, a file, or the open plans.
    pub(crate) fn source_title(&self, source: &Source) -> String {
        match source {
            Source::Folder(path) | Source::Table(path) => {
                let shown = self.shown_path(path);
                if shown.is_empty() || shown == "." { "this folder".to_owned() } else { shown }
            }
            Source::OpenPlans => "the open plans".to_owned(),
        }
    }

    /// The source that a typed path means; nothing for the open plans.
    pub(crate) fn source_of(&self, text: &str) -> Source {
        if text.trim().is_empty() {
            return Source::OpenPlans;
        }
        let path = self.typed_path(text);
        let is_table = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        if is_table { Source::Table(path) } else { Source::Folder(path) }
    }

    /// Reads the rooms of a source, unless they are read or being read; `again`: even then.
    pub(crate) fn read_rooms(&mut self, source: Source, again: bool) {
        if !again && self.at_hand.asked.as_ref() == Some(&source) {
            return;
        }
        let kind = Kind::new(JOB).newest_of(JOB).if_broken(|session| session.at_hand.job = None);
        let input = self.input_of(&source);
        let (schemes, asked) = (self.schemes.clone(), source.clone());
        let job = self.jobs.start_wanted(kind, move |work| {
            let read = read(source, input, &schemes, work);
            move |session: &mut Session, _: &Context| {
                session.at_hand.job = None;
                match read {
                    Ok(read) => (session.at_hand.read, session.at_hand.error) = (Some(Arc::new(read)), None),
                    Err(error) => (session.at_hand.read, session.at_hand.error) = (None, Some(error)),
                }
                session.measures.forget();
                session.train_what_waits();
            }
        });
        self.at_hand.asked = Some(asked);
        self.at_hand.job = Some(job);
    }

    /// Reads the rooms at hand again, as they or the schemes are now.
    pub(crate) fn read_rooms_again(&mut self) {
        if let Some(source) = self.at_hand.asked.clone() {
            self.read_rooms(source, true);
        }
    }

    /// Asks for a folder with plans, or for a dataset.
    pub(crate) fn ask_for_data(&mut self, is_folder: bool) {
        let folder = self.first_folder();
        self.ask_for_file(Purpose::Data { is_folder }, Some(folder), String::new());
    }

    /// Asks for a folder to write in.
    pub(crate) fn ask_for_folder(&mut self) {
        self.ask_for_file(Purpose::Folder, None, String::new());
    }

    /// How many of how many files have been read.
    pub(crate) fn rooms_progress(&self) -> Option<(usize, usize)> {
        self.jobs.progress_of(JOB)
    }

    fn input_of(&self, source: &Source) -> Input {
        match source {
            Source::Table(path) => Input::Table(path.clone(), self.shown_path(path)),
            Source::Folder(folder) => {
                let files = match self.dataset_source() {
                    Some((listed, files)) if listed == folder => files.to_vec(),
                    _ => Vec::new(),
                };
                let name = |path: PathBuf| {
                    let name = self.shown_path(&path);
                    (path, name)
                };
                Input::Files(files.into_iter().map(name).collect(), Some(folder.clone()))
            }
            Source::OpenPlans => {
                let all = self.waiting_plans.iter().map(|waiting| waiting.document()).chain(&self.document);
                let of = |document: &Document| (document.title(), document.origin.clone(), document.plan().clone());
                Input::Plans(all.map(of).collect())
            }
        }
    }

    /// Shows a room in its plan, which is opened where it is not.
    pub(crate) fn go_to_room(&mut self, origin: &Origin, room: RoomId) {
        if *origin == Origin::Untitled {
            let select = Call::new("select", [Value::Elements(vec![ElementId::Room(room)])]);
            self.wishes.push(Wish::Run(select));
            return;
        }
        self.awaited_room = Some((origin.clone(), room));
        self.wishes.push(Wish::OpenListed(origin.clone()));
    }
}

/// Reads files side by side; beside the plans what `extra` says of each file's.
///
/// # Errors
/// When it is cancelled.
pub(super) fn read_files<T: Send>(
    files: &[(PathBuf, String)],
    schemes: &Schemes,
    work: &Work<'_>,
    extra: impl Fn(usize, &[Plan]) -> T + Sync,
) -> Result<(PlansRead, Vec<T>, Vec<FileError>), String> {
    let read_one = |index: usize| {
        let (path, name) = &files[index];
        let import = formats::read_file(path)?;
        Ok((FileRead::new(name, store::content_of(path), &import.plans, schemes, false), extra(index, &import.plans)))
    };
    let results: Vec<Result<(FileRead, T), FileError>> =
        work.map(files.len(), read_one).map_err(|_| "it was cancelled".to_owned())?;
    let (mut read, mut extras, mut unreadable) = (PlansRead::default(), Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok((file, extra)) => {
                read.add(file);
                extras.push(extra);
            }
            Err(error) => unreadable.push(error),
        }
    }
    read.failed = unreadable.len();
    read.put_together();
    read.leave_out_repeats();
    Ok((read, extras, unreadable))
}

/// Reads the rooms.
fn read(source: Source, input: Input, schemes: &Schemes, work: &Work<'_>) -> Result<AtHand, String> {
    let mut origins = BTreeMap::new();
    let mut by_scheme = BTreeMap::new();
    let (mut plans, mut unreadable, mut folder) = (0, Vec::new(), None);
    let collection = match input {
        Input::Table(path, name) => {
            let bytes = std::fs::read(&path).map_err(|error| format!("{name}: {error}"))?;
            Collection::Rows(csv::read(bytes.as_slice()).map_err(|error| format!("{name}: {error}"))?)
        }
        Input::Files(files, of) => {
            let files = if files.is_empty() {
                let below = of.as_deref().map(|folder| plans_in(folder, Depth::All)).unwrap_or_default();
                below.into_iter().map(|path| (path.clone(), path.display().to_string())).collect()
            } else {
                files
            };
            folder = of;
            if files.is_empty() {
                return Err("There are no plans in this folder.".to_owned());
            }
            let extra = |index: usize, plans: &[Plan]| {
                let places: Vec<(String, String)> =
                    plans.iter().map(|plan| (plan.meta().name.clone(), plan.meta().storey.clone())).collect();
                let mut counts = BTreeMap::new();
                for (storey, plan) in plans.iter().enumerate() {
                    counted(plan, index * 64 + storey.min(63), &mut counts);
                }
                (index, places, counts)
            };
            let (mut read, extras, failed) = read_files(&files, schemes, work, extra)?;
            unreadable = failed;
            for (index, places, counts) in extras {
                let (path, name) = &files[index];
                for (storey, (plan, of)) in places.into_iter().enumerate() {
                    plans += 1;
                    origins.entry((name.clone(), plan, of)).or_insert(Origin::File { path: path.clone(), storey });
                }
                for (key, of_plans) in counts {
                    by_scheme.entry(key).or_insert_with(BTreeMap::new).extend(of_plans);
                }
            }
            Collection::Plans(std::mem::take(&mut read.networks))
        }
        Input::Plans(open) => {
            let mut read = PlansRead::default();
            plans = open.len();
            for (index, (title, origin, plan)) in open.into_iter().enumerate() {
                counted(&plan, index, &mut by_scheme);
                let meta = plan.meta();
                origins.insert((title.clone(), meta.name.clone(), meta.storey.clone()), origin);
                read.add(FileRead::new(&title, String::new(), &[plan], schemes, false));
            }
            read.put_together();
            read.leave_out_repeats();
            Collection::Plans(std::mem::take(&mut read.networks))
        }
    };
    let rows = collection.rows(NeighbourLabels::True).unwrap_or_default();
    let buildings: BTreeSet<(Option<&Typology>, &str)> =
        rows.iter().map(|row| (row.typology.as_ref(), building_of(row))).collect();
    if plans == 0 {
        let of_rows: BTreeSet<(&str, &str, &str)> =
            rows.iter().map(|row| (row.file.as_str(), row.plan.as_str(), row.storey.as_str())).collect();
        plans = of_rows.len();
    }
    let since_export = folder.and_then(|folder| since_export(&folder, &rows));
    let buildings = buildings.len();
    Ok(AtHand { source, buildings, collection, rows, plans, unreadable, by_scheme, since_export, origins })
}

/// The dataset in a folder that was exported last, and what changed since. A table counts as one if its manifest is beside it.
fn since_export(folder: &Path, rows: &[Row]) -> Option<SinceExport> {
    let entries = std::fs::read_dir(folder).ok()?;
    let is_table = |path: &PathBuf| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let tables = entries.flatten().map(|entry| entry.path()).filter(is_table);
    let exported = tables.filter(|path| crate::gather::beside(path, "manifest.json").is_file());
    let time = |path: &PathBuf| std::fs::metadata(path).and_then(|file| file.modified()).ok();
    let path = exported.max_by(|p, q| (time(p), p).cmp(&(time(q), q)))?;
    let before = csv::read(std::fs::read(&path).ok()?.as_slice()).ok()?;
    let changes = Changes::between(&before, rows);
    Some(SinceExport { path, before, changes })
}
