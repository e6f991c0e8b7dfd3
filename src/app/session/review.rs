//! The review: from room to room of the open folder's plans, in the order in which a look is worth most.
//!
//! Corrections are edits of their plans as any other: they stand in the history, are kept by the journal, and are saved when the
//! plan is. What was decided is kept at once in a readable file beside the plans, so that the review goes on where it was left.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use super::Session;
use super::document::Document;
use super::jobs::{Kind, Wanted};
use super::messages::Severity;
use super::origin::{Origin, absolute};
use super::selection::SelectMode;
use super::wishes::Wish;
use crate::base::wording::count;
use crate::base::work::{Cancelled, Work};
use crate::classify::models::Models;
use crate::edit;
use crate::features::RoomStatus;
use crate::formats;
use crate::labels::{Label, Schemes};
use crate::plan::titles::room_title;
use crate::plan::{ElementId, LabelOrigin, Plan, RoomId, RoomLabel};
use crate::review::{
    Decision, Decisions, Entry, FILE_NAME, FileSeen, Key, Material, Queue, Reason, Verdict, differences, queue,
};
use crate::store;

/// The name of the job, by which its progress is found.
const JOB: &str = "find the rooms to review";

/// The part of the progress that reading the plans takes; judging their rooms takes longer.
pub(crate) const READING_SHARE: f64 = 0.1;

/// As the command line has it, so that both show the same queue.
const FOLDS: usize = 10;
const SEED: u64 = 1;

const NOT_STARTED: &str = "start a review of the labels first";

/// How much of the plan is seen around a room, in metres.
const AROUND_M: f64 = 6.0;

/// The review of a folder.
#[derive(Default)]
pub(crate) struct Review {
    folder: Option<PathBuf>,
    job: Option<Wanted>,
    /// Why there is no queue.
    failure: Option<String>,
    queue: Option<Arc<Queue>>,
    /// Where each room stands in the queue.
    places: BTreeMap<Key, usize>,
    /// Whether it is about the differences to another person's labels.
    is_comparison: bool,
    /// The room that is looked at.
    current: Option<usize>,
    decisions: Decisions,
    /// What was wrong with the file of decisions, until it has been kept aside.
    broken: Option<Vec<u8>>,
    /// Labels that rooms got since the queue was made, of plans that may be closed by now.
    changed: BTreeMap<usize, Label>,
    steps: Vec<Step>,
    /// The room whose plan is being opened, and what is to be taken back there.
    awaited: Option<(usize, Option<Step>)>,
    /// Where the plan shown stood when its room was shown: its document, and the step of its history.
    arrived: Option<(u64, usize)>,
    /// The document that the review opened, and closes if nothing was done to it.
    opened: Option<u64>,
    /// Whether it is opening one.
    is_opening: bool,
}

/// A decision that can be taken back.
#[derive(Clone)]
struct Step {
    entry: usize,
    /// What stood about the room before.
    before: Option<Decision>,
    /// The plan's document, and its history when the room was shown and when it was left.
    document: u64,
    from: usize,
    to: usize,
    /// The room as it was when it was shown, for a plan that was closed since.
    room: (Option<RoomLabel>, String),
}

/// How far the review is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Progress {
    pub rooms: usize,
    pub accepted: usize,
    pub corrected: usize,
    pub skipped: usize,
}

impl Progress {
    pub(crate) fn decided(self) -> usize {
        self.accepted + self.corrected
    }
}

/// What the panel shows.
pub(crate) enum Shown<'a> {
    /// Nothing was asked for.
    Idle,
    /// The plans are read and judged: the share that is done, 0..=1.
    Making(f64),
    Failed(&'a str),
    /// All rooms are decided, or there are none.
    Finished,
    Room(&'a Entry),
}

impl Review {
    fn key(entry: &Entry) -> Key {
        Key { file: entry.row.file.clone(), room: entry.row.id.clone() }
    }

    fn entry(&self, index: usize) -> Option<&Entry> {
        self.queue.as_ref()?.entries.get(index)
    }

    pub(crate) fn is_comparison(&self) -> bool {
        self.is_comparison
    }

    /// What to know of the whole queue.
    pub(crate) fn notes(&self) -> &[String] {
        self.queue.as_ref().map_or(&[], |queue| &queue.notes)
    }

    /// What was written about the room that is looked at.
    pub(crate) fn note(&self) -> &str {
        let entry = self.current.and_then(|index| self.entry(index));
        entry.and_then(|entry| self.decisions.of(&Self::key(entry))).map_or("", |decision| &decision.note)
    }

    pub(crate) fn can_go_back(&self) -> bool {
        !self.steps.is_empty()
    }
}

impl Session {
    /// Whether a room is being looked at.
    pub(crate) fn is_reviewing(&self) -> bool {
        self.review.current.is_some()
    }

    pub(crate) fn review_shown(&self) -> Shown<'_> {
        let review = &self.review;
        if review.job.is_some() {
            return Shown::Making(self.jobs.share_of(JOB));
        }
        match (&review.failure, &review.queue, review.current.and_then(|index| review.entry(index))) {
            (Some(failure), ..) => Shown::Failed(failure),
            (None, None, _) => Shown::Idle,
            (None, Some(_), Some(entry)) => Shown::Room(entry),
            (None, Some(_), None) => Shown::Finished,
        }
    }

    /// Begins with the plans of the open folder; goes on where the review of it was left.
    ///
    /// # Errors
    /// When no folder is open.
    pub(crate) fn review_labels(&mut self) -> Result<(), String> {
        self.begin_review(None)
    }

    /// Begins with the rooms that somebody else labelled otherwise.
    ///
    /// # Errors
    /// When no folder is open, or the other one holds no plan.
    pub(crate) fn review_differences(&mut self, other: PathBuf) -> Result<(), String> {
        self.begin_review(Some(other))
    }

    fn begin_review(&mut self, other: Option<PathBuf>) -> Result<(), String> {
        let Some((folder, files)) = self.review_source() else {
            return Err("open a folder of plans first".to_owned());
        };
        let open = self.open_versions();
        let schemes = self.schemes.clone();
        let is_comparison = other.is_some();
        self.review = Review { folder: Some(folder.clone()), is_comparison, ..Review::default() };
        let kind = Kind::new(JOB).newest_of("review").if_broken(|session| {
            session.review.job = None;
            session.review.failure = Some("something went wrong inside Enfilade".to_owned());
        });
        let job = self.jobs.start_wanted(kind, move |work| {
            let found = make(&folder, &files, &open, other.as_deref(), &schemes, work);
            let kept = std::fs::read(folder.join(FILE_NAME)).ok();
            move |session: &mut Session, _: &Context| session.review_was_made(found, kept)
        });
        self.review.job = Some(job);
        Ok(())
    }

    /// The folder to review, and its plans: those of the workspace, or without one those in the list.
    fn review_source(&self) -> Option<(PathBuf, Vec<PathBuf>)> {
        match &self.workspace {
            Some(workspace) if !workspace.now.files().is_empty() => {
                let now = &workspace.now;
                Some((now.folder().to_owned(), now.files().iter().map(|file| now.path_of(file)).collect()))
            }
            _ => self.dataset_source().map(|(folder, files)| (folder.to_owned(), files.to_vec())),
        }
    }

    /// Whether there is a folder to review.
    pub(crate) fn can_review(&self) -> bool {
        let has_workspace = self.workspace.as_ref().is_some_and(|workspace| !workspace.now.files().is_empty());
        has_workspace || self.dataset_source().is_some()
    }

    /// Gives up making the queue.
    pub(crate) fn cancel_review(&mut self) {
        self.review = Review::default();
    }

    /// The plans of files as they are here, changed or not: by their paths, with their places in the files.
    fn open_versions(&self) -> BTreeMap<PathBuf, Vec<(usize, Plan)>> {
        let mut versions: BTreeMap<PathBuf, Vec<(usize, Plan)>> = BTreeMap::new();
        for document in self.documents() {
            if let Origin::File { path, storey } = &document.origin {
                let path = absolute(path);
                versions.entry(path).or_default().push((*storey, document.plan().clone()));
            }
        }
        versions
    }

    fn review_was_made(&mut self, found: Result<Queue, String>, kept: Option<Vec<u8>>) {
        self.review.job = None;
        match found {
            Err(error) => self.review.failure = Some(error),
            Ok(found) => {
                let places = found.entries.iter().enumerate().map(|(index, entry)| (Review::key(entry), index));
                self.review.places = places.collect();
                self.review.queue = Some(Arc::new(found));
                if let Some(bytes) = kept {
                    let read = Decisions::read(&bytes);
                    self.review.decisions = read.decisions;
                    if let Some(what) = read.broken {
                        let detail = format!("{what}. It is kept aside before anything is written.");
                        self.say(Severity::Warning, format!("{FILE_NAME} is damaged"), detail);
                        self.review.broken = Some(bytes);
                    }
                }
                self.review_next(None);
            }
        }
    }

    // Where the review is.

    /// The open plans of the folder, by file and storey as entries name them.
    fn open_here(&self) -> OpenHere<'_> {
        let folder = self.review.folder.as_deref().map(absolute).unwrap_or_default();
        let place = |document: &Document| match &document.origin {
            Origin::File { path, storey } => Some((name_below(&folder, &absolute(path)), *storey)),
            Origin::Bundled(_) | Origin::Untitled => None,
        };
        self.documents().filter_map(|document| Some((place(document)?, document.plan()))).collect()
    }

    /// The label that a room has now: in its plan if that is open, else as it was left.
    fn label_now(&self, index: usize) -> Option<Label> {
        self.label_among(index, &self.open_here())
    }

    fn label_among(&self, index: usize, open: &OpenHere<'_>) -> Option<Label> {
        let entry = self.review.entry(index)?;
        let open = open.get(&(entry.row.file.clone(), entry.storey_of_file));
        match open.and_then(|plan| Some((plan, plan.room(entry.room)?))) {
            Some((plan, room)) => RoomStatus::of(plan, &self.schemes, room).label(),
            None => Some(self.review.changed.get(&index).copied().unwrap_or(entry.row.label)),
        }
    }

    fn origin_of_entry(&self, entry: &Entry) -> Option<Origin> {
        let folder = self.review.folder.as_ref()?;
        Some(Origin::File { path: folder.join(&entry.row.file), storey: entry.storey_of_file })
    }

    fn verdict_of(&self, index: usize, open: &OpenHere<'_>) -> Option<Verdict> {
        let entry = self.review.entry(index)?;
        self.review.decisions.of(&Review::key(entry))?.verdict_on(self.label_among(index, open)?)
    }

    /// How far the review is.
    pub(crate) fn review_progress(&self) -> Progress {
        let rooms = self.review.queue.as_ref().map_or(0, |queue| queue.entries.len());
        let mut progress = Progress { rooms, accepted: 0, corrected: 0, skipped: 0 };
        let open = self.open_here();
        for (key, _) in self.review.decisions.iter() {
            match self.review.places.get(key).and_then(|&index| self.verdict_of(index, &open)) {
                Some(Verdict::Accepted) => progress.accepted += 1,
                Some(Verdict::Corrected) => progress.corrected += 1,
                Some(Verdict::Skipped) => progress.skipped += 1,
                None => {}
            }
        }
        progress
    }

    /// The label that the room looked at has now.
    pub(crate) fn reviewed_label(&self) -> Option<Label> {
        self.label_now(self.review.current?)
    }

    /// Goes to the first room after one that nothing was decided about, then to those left for later.
    fn review_next(&mut self, after: Option<usize>) {
        let rooms = self.review.queue.as_ref().map_or(0, |queue| queue.entries.len());
        let from = after.map_or(0, |after| after + 1);
        let order = || (from..rooms).chain(0..from.min(rooms));
        let open = self.open_here();
        let next = order().find(|&index| self.verdict_of(index, &open).is_none());
        let next = next.or_else(|| {
            order().find(|&index| Some(index) != after && self.verdict_of(index, &open) == Some(Verdict::Skipped))
        });
        match next {
            Some(index) => self.review_go_to(index, None),
            None => {
                self.review.current = None;
                self.review.awaited = None;
                self.status = "The review is finished".to_owned();
            }
        }
    }

    /// Shows a room in its plan, which is opened if it is not, and then takes back what is to be.
    fn review_go_to(&mut self, index: usize, undo: Option<Step>) {
        self.review.current = Some(index);
        self.review.arrived = None;
        let Some(origin) = self.review.entry(index).and_then(|entry| self.origin_of_entry(entry)) else { return };
        self.review.awaited = Some((index, undo));
        match self.open_of(&origin) {
            Some(number) => self.show_open(number),
            None => {
                self.review.is_opening = true;
                self.open(origin);
            }
        }
        self.go_on_reviewing();
    }

    /// Once the plan of the room that is looked at is there: shows the room.
    pub(crate) fn go_on_reviewing(&mut self) {
        let Some((index, _)) = self.review.awaited else { return };
        let Some(entry) = self.review.entry(index) else { return };
        let (room, origin) = (entry.room, self.origin_of_entry(entry));
        let Some(document) = self.document.as_ref() else { return };
        if !origin.is_some_and(|origin| document.origin.is_same(&origin)) {
            return;
        }
        let number = document.number;
        let Some((_, undo)) = self.review.awaited.take() else { return };
        // A plan that was opened for one room is closed again if nothing was done to it.
        if let Some(before) = self.review.opened.take_if(|before| *before != number) {
            self.close_untouched(before);
        }
        if std::mem::take(&mut self.review.is_opening) {
            self.review.opened = Some(number);
        }
        if let Some(step) = undo {
            self.take_back(&step, room);
        }
        let Some(document) = self.document.as_ref() else { return };
        self.review.arrived = Some((number, document.history.position()));
        let Some(bounds) = document.bounds_of(ElementId::Room(room)) else {
            self.status = "The room is not in its plan any more".to_owned();
            return;
        };
        self.selection.select([ElementId::Room(room)], SelectMode::Replace);
        let short_m = bounds.width().max(bounds.height());
        self.wishes.push(Wish::ZoomTo(bounds.inflated(AROUND_M.max(short_m / 2.0))));
    }

    /// Undoes what was done to the room since it was shown.
    fn take_back(&mut self, step: &Step, room: RoomId) {
        let Some(document) = &mut self.document else { return };
        if step.from == step.to && document.number == step.document {
            return;
        }
        if document.number == step.document && document.history.position() == step.to {
            document.history.jump_to(step.from);
            return;
        }
        // The plan was changed since, or closed: the room alone gets back what it had.
        let (label, function) = step.room.clone();
        let is_same = document.plan().room(room).is_none_or(|now| now.label == label && now.function == function);
        if !is_same {
            self.edit("Take back the review of a room", |plan| {
                edit::change_room(plan, room, |room| (room.label, room.function) = (label, function))
            });
        }
    }

    // Deciding.

    /// The label stands as it is now: as it was, or as it was just changed by hand.
    ///
    /// # Errors
    /// When no room is looked at, or its plan is not there yet.
    pub(crate) fn review_accept(&mut self) -> Result<(), String> {
        let (index, label) = self.reviewed()?;
        let given = self.review.entry(index).map(|entry| entry.row.label);
        let verdict = if given == Some(label) { Verdict::Accepted } else { Verdict::Corrected };
        self.decide(index, verdict, label);
        Ok(())
    }

    /// Gives the room a label, by default the likeliest other one, or what the other person says.
    ///
    /// # Errors
    /// As [`Self::review_accept`].
    pub(crate) fn review_correct(&mut self, label: Option<Label>) -> Result<(), String> {
        let (index, _) = self.reviewed()?;
        let Some(entry) = self.review.entry(index) else { return Ok(()) };
        let (room, wanted) = (entry.room, label.unwrap_or(entry.other()));
        let theirs = match entry.reasons.first() {
            Some(Reason::OtherPerson { label: said, function }) if label.is_none() => Some((*said, function.clone())),
            _ => None,
        };
        let schemes = self.schemes.clone();
        self.edit(&format!("Label {wanted}"), |plan| {
            let mut plan = plan.clone();
            if let Some((_, function)) = &theirs {
                plan = edit::set_function(&plan, room, function)?;
            }
            // A label that the function gives already need not be pinned to the room.
            let by_function = edit::set_label(&plan, room, None)?;
            let status = |plan: &Plan| plan.room(room).and_then(|it| RoomStatus::of(plan, &schemes, it).label());
            if status(&by_function) == Some(wanted) {
                return Ok(by_function);
            }
            edit::set_label(&plan, room, Some(RoomLabel { label: wanted, origin: LabelOrigin::Person }))
        });
        match self.reviewed_label() {
            Some(label) => self.decide(index, Verdict::Corrected, label),
            None => return Err("the room has no label now; give it one".to_owned()),
        }
        Ok(())
    }

    /// Leaves the room for later.
    ///
    /// # Errors
    /// As [`Self::review_accept`].
    pub(crate) fn review_skip(&mut self) -> Result<(), String> {
        // Also where the plan cannot be opened any more.
        let Some(index) = self.review.current else { return Err(NOT_STARTED.to_owned()) };
        let given = self.review.entry(index).map(|entry| entry.row.label);
        if let Some(label) = self.label_now(index).or(given) {
            self.decide(index, Verdict::Skipped, label);
        }
        Ok(())
    }

    /// Writes something about the room.
    ///
    /// # Errors
    /// As [`Self::review_accept`].
    pub(crate) fn review_note(&mut self, note: &str) -> Result<(), String> {
        let (index, _) = self.reviewed()?;
        let Some(key) = self.review.entry(index).map(Review::key) else { return Ok(()) };
        let before = self.review.decisions.of(&key).cloned().unwrap_or_default();
        self.review.decisions.set(key, Decision { note: note.trim().to_owned(), ..before });
        self.keep_decisions();
        Ok(())
    }

    /// Goes back to the room that was decided last, and takes back what was done.
    ///
    /// # Errors
    /// When nothing was decided since the review began.
    pub(crate) fn review_back(&mut self) -> Result<(), String> {
        let Some(step) = self.review.steps.pop() else { return Err("nothing was decided yet".to_owned()) };
        if let Some(key) = self.review.entry(step.entry).map(Review::key) {
            self.review.decisions.set(key, step.before.clone().unwrap_or_default());
            self.review.changed.remove(&step.entry);
            self.keep_decisions();
        }
        self.review_go_to(step.entry, Some(step));
        Ok(())
    }

    /// The room that is looked at, and the label it has.
    fn reviewed(&mut self) -> Result<(usize, Label), String> {
        let Some(index) = self.review.current else { return Err(NOT_STARTED.to_owned()) };
        if self.review.arrived.is_none() {
            return Err("the room's plan is still being opened; skip the room if it cannot be".to_owned());
        }
        // Nobody decides about what is not seen.
        let origin = self.review.entry(index).and_then(|entry| self.origin_of_entry(entry));
        let is_seen = self.document.as_ref().zip(origin.as_ref()).is_some_and(|(shown, it)| shown.origin.is_same(it));
        if !is_seen {
            self.review_go_to(index, None);
            return Err("another plan was shown; this is the room to decide".to_owned());
        }
        let label = self.label_now(index).ok_or("the room has no label now; give it one, or skip it")?;
        Ok((index, label))
    }

    fn decide(&mut self, index: usize, verdict: Verdict, label: Label) {
        let Some(entry) = self.review.entry(index).cloned() else { return };
        let key = Review::key(&entry);
        let before = self.review.decisions.of(&key).cloned();
        let note = before.as_ref().map(|decision| decision.note.clone()).unwrap_or_default();
        let (document, from) = self.review.arrived.unwrap_or_default();
        let to = self.documents().find(|it| it.number == document).map_or(from, |it| it.history.position());
        // As it was when it was shown: from the history, if that still reaches back so far.
        let then = self.documents().find(|it| it.number == document).and_then(|it| it.history.steps().get(from));
        let room = then.and_then(|step| step.plan.room(entry.room));
        let room = room.map(|room| (room.label, room.function.clone())).unwrap_or_default();
        self.review.steps.push(Step { entry: index, before, document, from, to, room });
        self.review.decisions.set(key, Decision { verdict: Some(verdict), label: Some(label), note });
        if label != entry.row.label {
            self.review.changed.insert(index, label);
        }
        self.keep_decisions();
        let title = self.plan().and_then(|plan| plan.room(entry.room)).map(room_title).unwrap_or_default();
        self.review_next(Some(index));
        self.status = match verdict {
            Verdict::Accepted => format!("{title}: {label} is right"),
            Verdict::Corrected => format!("{title}: now {label}"),
            Verdict::Skipped => format!("{title}: left for later"),
        };
    }

    /// Writes the decisions beside the plans. A damaged file is kept aside first.
    fn keep_decisions(&mut self) {
        let Some(folder) = self.review.folder.clone() else { return };
        let aside = self.review.broken.take().map(|bytes| {
            let free = (1..).map(|number| folder.join(format!("{FILE_NAME}.damaged-{number}")));
            let path = free.into_iter().find(|path| !path.exists()).unwrap_or_else(|| folder.join("review.damaged"));
            (store::save_bytes(&path, &bytes), bytes)
        });
        if let Some((Err(error), bytes)) = aside {
            self.review.broken = Some(bytes);
            self.say(Severity::Error, "The decisions of the review are not kept", error.to_string());
            return;
        }
        if let Err(error) = store::save_bytes_fast(&folder.join(FILE_NAME), &self.review.decisions.to_bytes()) {
            self.say(Severity::Error, "The decisions of the review are not kept", error.to_string());
        }
    }

    /// In words: '12 of 340 rooms decided, 3 corrected'.
    pub(crate) fn review_in_words(&self) -> String {
        let progress = self.review_progress();
        let rooms = count(progress.rooms, "room");
        format!("{} of {rooms} decided, {} corrected", progress.decided(), progress.corrected)
    }
}

/// Open plans by file, named from the folder, and storey.
type OpenHere<'a> = BTreeMap<(String, usize), &'a Plan>;

/// How a file is named from the folder: as entries and decisions name it.
fn name_below(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// Reads the plans and makes the queue.
fn make(
    folder: &Path,
    files: &[PathBuf],
    open: &BTreeMap<PathBuf, Vec<(usize, Plan)>>,
    other: Option<&Path>,
    schemes: &Schemes,
    work: &Work<'_>,
) -> Result<Queue, String> {
    let cancelled = |_: Cancelled| "it was cancelled".to_owned();
    let read = |folder: &Path, files: &[PathBuf], open: &_, shares: Range<f64>| {
        work.within(shares, |work| material(folder, files, open, schemes, work)).map_err(cancelled)
    };
    let until = if other.is_some() { 0.5 } else { READING_SHARE };
    let first = read(folder, files, open, 0.0..until)?;
    if first.networks().is_empty() {
        return Err("no plan of the folder could be read".to_owned());
    }
    let Some(other) = other else {
        let judge = |work: &Work<'_>| queue(&first, schemes, &Models::bundled(), FOLDS, SEED, work);
        return work.within(until..1.0, judge).map_err(|error| error.to_string());
    };
    let files = super::plan_list::plans_in(other, super::plan_list::Depth::All);
    let second = read(other, &files, &BTreeMap::new(), until..1.0)?;
    let names = |material: &Material| material.networks().iter().map(|of| of.file.clone()).collect::<Vec<_>>();
    let theirs = names(&second);
    if !names(&first).iter().any(|name| theirs.contains(name)) {
        return Err("the other folder holds no plan of the same name".to_owned());
    }
    Ok(differences(&first, &second))
}

/// The plans of files, named from their folder; one that cannot be read is left out.
fn material(
    folder: &Path,
    files: &[PathBuf],
    open: &BTreeMap<PathBuf, Vec<(usize, Plan)>>,
    schemes: &Schemes,
    work: &Work<'_>,
) -> Result<Material, Cancelled> {
    let read = |index: usize| {
        let path = &files[index];
        let mut plans = formats::read_file(path).ok()?.plans;
        for (storey, plan) in open.get(&absolute(path)).into_iter().flatten() {
            if let Some(place) = plans.get_mut(*storey) {
                place.clone_from(plan);
            }
        }
        let name = name_below(folder, path);
        Some(FileSeen::new(&name, store::content_of(path), &plans, schemes))
    };
    Ok(Material::new(work.map(files.len(), read)?.into_iter().flatten()))
}
