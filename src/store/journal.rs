//! The journal: every unsaved change of a plan, written to disk as soon as it is made, so that nothing is
//! lost if the program is killed. `docs/recovery.md` describes it for outsiders.
//!
//! A journal is an append-only file of records. Each record has its length and a checksum chained from
//! the previous record: a record being written when the program died is recognised and skipped, and so is
//! everything after any damage. The first record holds the plan as in its file, each further one what a
//! step of the history changes. Writing happens in order on a separate thread; finding the change costs
//! what changed, not the size of the plan.
//!
//! The writing program holds a lock on its journal. A journal with a free lock is a leftover.

use std::collections::VecDeque;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use super::stamp::Stamp;
use crate::base::hash;
use crate::formats::plan_json;
use crate::plan::{Backdrop, History, Plan, Step};

/// The environment variable for another folder for data that must survive a crash; if empty, no journals
/// are kept.
pub const STATE_VARIABLE: &str = "ENFILADE_STATE";

/// The folder of journals: below the one in the environment variable, or in the system's location; `None`
/// if there is none, or none is wanted.
pub fn journal_folder() -> Option<PathBuf> {
    use etcetera::BaseStrategy as _;
    let state = match std::env::var_os(STATE_VARIABLE) {
        Some(folder) => (!folder.is_empty()).then(|| PathBuf::from(folder))?,
        None => {
            let places = etcetera::choose_base_strategy().ok()?;
            places.state_dir().unwrap_or_else(|| places.data_dir()).join("enfilade")
        }
    };
    Some(state.join("journal"))
}

/// The first line of a journal: its format and version.
const HEADER: &str = "enfilade journal 2\n";

/// The first line of the version before, which knew of nothing half drawn.
const HEADER_BEFORE: &str = "enfilade journal 1\n";

/// What the first line starts with in every version.
const KIND: &str = "enfilade journal ";

/// The extension of journals.
const ENDING: &str = "journal";

/// The extension of a journal that does not contain its plan yet.
const UNFINISHED: &str = "new";

/// A journal that has grown by more than this is restarted, without the steps so far.
const LONGEST_BYTES: u64 = 64 << 20;

/// The largest journal: a plan file of the largest size, and changes up to [`LONGEST_BYTES`] plus a last
/// one as large as a plan.
const LARGEST_BYTES: u64 = 2 * crate::formats::FILE_LIMIT_BYTES + LONGEST_BYTES;

/// How often to retry a journal that could not be written.
const RETRY: Duration = Duration::from_secs(2);

/// The origin of a journal's plan.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct JournalStart {
    /// The plan's file; `None` if it has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The index of the plan in the file.
    #[serde(default)]
    pub storey: usize,
    /// The bundled plan it started as.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sample: Option<String>,
    /// The file's content at the time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stamp: Option<Stamp>,
}

/// The header of a record; the change it describes follows.
#[derive(Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase")]
enum Head {
    /// The plan as in its file; the plan file follows.
    Start {
        #[serde(flatten)]
        start: JournalStart,
    },
    /// A step of the history, which drops undone ones; its change follows.
    Step { title: String },
    /// Undo or redo: another step, counted from the start, becomes the current one.
    Jump { to: usize },
    /// Something is being drawn, or nothing any more. A step or a jump ends it.
    Draft {
        #[serde(flatten)]
        draft: Draft,
    },
}

/// Something half drawn: the points that a tool has so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Draft {
    /// The id of the tool's command; empty where nothing is being drawn.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub tool: String,
    /// In metres, x and y.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<[f64; 2]>,
}

/// The most points of something half drawn.
const MOST_POINTS: usize = 100_000;

// Writing.

/// Why a journal is not being written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JournalFailure {
    /// The folder where it should be.
    pub folder: PathBuf,
    /// The system's error message.
    pub what: String,
}

/// The journal of an open plan, written on a separate thread.
///
/// Dropping it leaves the file for recovery; [`Journal::remove`] deletes it.
pub struct Journal {
    sender: Option<Sender<Event>>,
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    /// The steps of the journal, beginning with the original plan.
    steps: Vec<Plan>,
    /// Which of them is current.
    at: usize,
    /// What is being drawn, as it was last noted since the last step.
    draft: Option<Draft>,
    /// The number of records sent to the thread.
    noted: u64,
}

/// The journal that another one continues.
pub enum Predecessor {
    /// Left behind by another program.
    Leftover(Leftover),
    /// Written until now by this one.
    Journal(Journal),
}

impl Predecessor {
    fn remove(self) {
        match self {
            // If it cannot be removed, it will be offered again: too much rather than too little.
            Self::Leftover(leftover) => drop(leftover.remove()),
            Self::Journal(journal) => journal.remove(),
        }
    }
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// The number of records on disk.
    written: u64,
    /// The size of the changes in bytes.
    bytes: u64,
    failure: Option<JournalFailure>,
    is_ended: bool,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // A thread that panicked while holding it only read or wrote whole fields.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

enum Event {
    Record(Box<Record>),
    Remove,
}

enum Record {
    Step {
        title: String,
        before: Plan,
        after: Plan,
    },
    Jump {
        to: usize,
    },
    Draft(Draft),
    /// A new file replaces this one, with the original plan and the current one.
    Anew {
        base: Plan,
        current: Plan,
    },
}

impl Journal {
    /// Starts the journal of a plan that is `base` in its file. Once on disk, the one it replaces is
    /// removed. `on_change` is called, on another thread, when writing starts to fail and when it works
    /// again.
    pub fn begin(
        folder: &Path,
        start: JournalStart,
        base: Plan,
        replaces: Option<Predecessor>,
        on_change: impl Fn() + Send + 'static,
    ) -> Self {
        let (sender, receiver) = channel();
        let shared = Arc::new(Shared::default());
        let mut writer = Writer {
            folder: folder.to_owned(),
            start,
            base: base.clone(),
            open: None,
            queue: VecDeque::new(),
            replaces,
            shared: shared.clone(),
        };
        let thread = std::thread::spawn(move || writer.run(&receiver, &on_change));
        let (steps, thread) = (vec![base], Some(thread));
        Self { sender: Some(sender), shared, thread, steps, at: 0, draft: None, noted: 0 }
    }

    /// Records the current state of a history; fast, and faster still if nothing happened.
    pub fn note(&mut self, history: &History) {
        if self.is_current(history.plan()) {
            return;
        }
        // Several steps may have been made since; one that was undone to stands for itself.
        let position = history.position();
        let steps = history.steps().get(..=position).unwrap_or_default();
        let first = steps.iter().rposition(|step| self.is_current(&step.plan)).map_or(position, |known| known + 1);
        for step in &steps[first..] {
            self.move_to(step);
        }
    }

    /// Records what is being drawn and is in no plan yet, or that nothing is.
    pub fn note_draft(&mut self, draft: Option<&Draft>) {
        if self.draft.as_ref() != draft {
            self.draft = draft.cloned();
            self.send(Record::Draft(draft.cloned().unwrap_or_default()));
        }
    }

    fn is_current(&self, plan: &Plan) -> bool {
        self.steps.get(self.at).is_some_and(|current| current.is_same_value(plan))
    }

    fn move_to(&mut self, step: &Step) {
        if self.is_current(&step.plan) {
            return;
        }
        if let Some(to) = self.steps.iter().rposition(|known| known.is_same_value(&step.plan)) {
            self.at = to;
            self.draft = None;
            self.send(Record::Jump { to });
            return;
        }
        let Some(before) = self.steps.get(self.at).cloned() else { return };
        self.steps.truncate(self.at + 1);
        self.steps.push(step.plan.clone());
        self.at += 1;
        self.draft = None;
        self.send(Record::Step { title: step.title.clone(), before, after: step.plan.clone() });
        if self.shared.state().bytes > LONGEST_BYTES
            && let Some(base) = self.steps.first().cloned()
        {
            self.shared.state().bytes = 0;
            self.steps = vec![base.clone(), step.plan.clone()];
            self.at = 1;
            self.send(Record::Anew { base, current: step.plan.clone() });
        }
    }

    fn send(&mut self, record: Record) {
        self.noted += 1;
        if let Some(sender) = &self.sender {
            // The thread ends only after this.
            let _ = sender.send(Event::Record(Box::new(record)));
        }
    }

    /// Waits until everything recorded is on disk, or cannot be written.
    ///
    /// # Errors
    /// When it cannot be written; the error says why.
    pub fn wait(&self) -> Result<(), JournalFailure> {
        let is_waiting = |state: &mut State| state.written < self.noted && state.failure.is_none() && !state.is_ended;
        let state = self.shared.changed.wait_while(self.shared.state(), is_waiting);
        state.unwrap_or_else(PoisonError::into_inner).failure.clone().map_or(Ok(()), Err)
    }

    /// Why it is not being written; `None` if it is.
    pub fn failure(&self) -> Option<JournalFailure> {
        self.shared.state().failure.clone()
    }

    /// Ends it and removes its file: its content has been saved or discarded.
    pub fn remove(self) {
        if let Some(sender) = &self.sender {
            let _ = sender.send(Event::Remove);
        }
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

struct Writer {
    folder: PathBuf,
    start: JournalStart,
    base: Plan,
    open: Option<OpenFile>,
    queue: VecDeque<Record>,
    replaces: Option<Predecessor>,
    shared: Arc<Shared>,
}

struct OpenFile {
    file: File,
    path: PathBuf,
    /// The length of its complete records.
    length: u64,
    checksum: u64,
}

impl Writer {
    fn run(&mut self, receiver: &Receiver<Event>, on_change: &dyn Fn()) {
        let mut is_over = false;
        while !is_over {
            // Pending writes are retried without being asked.
            let event = match self.queue.is_empty() {
                true => receiver.recv().map_err(|_| RecvTimeoutError::Disconnected),
                false => receiver.recv_timeout(RETRY),
            };
            let mut events: Vec<Event> = Vec::new();
            match event {
                Ok(event) => events.push(event),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => is_over = true,
            }
            events.extend(receiver.try_iter());
            for event in events {
                match event {
                    Event::Record(record) => self.queue.push_back(*record),
                    Event::Remove => {
                        self.remove();
                        is_over = true;
                    }
                }
            }
            if self.queue.is_empty() {
                continue;
            }
            let result = self.write();
            let failure = result.err().map(|error| JournalFailure { folder: self.folder.clone(), what: said(&error) });
            let mut state = self.shared.state();
            let is_news = state.failure != failure;
            state.failure = failure;
            drop(state);
            self.shared.changed.notify_all();
            if is_news {
                on_change();
            }
        }
        self.shared.state().is_ended = true;
        self.shared.changed.notify_all();
    }

    fn remove(&mut self) {
        self.queue.clear();
        if let Some(open) = self.open.take() {
            // If it cannot be removed, it will be offered again: too much rather than too little.
            let _ = fs::remove_file(&open.path);
        }
        if let Some(replaced) = self.replaces.take() {
            replaced.remove();
        }
    }

    /// Writes what is pending, and flushes it to disk.
    fn write(&mut self) -> io::Result<()> {
        let mut written = 0;
        let mut bytes = 0;
        while let Some(record) = self.queue.front() {
            if let Record::Anew { base, .. } = record {
                let before = self.open.take();
                self.base = base.clone();
                match self.created() {
                    Ok(open) => self.open = Some(open),
                    Err(error) => {
                        self.open = before;
                        return Err(error);
                    }
                }
                if let Some(before) = before {
                    let _ = fs::remove_file(&before.path);
                }
            }
            if self.open.is_none() {
                self.open = Some(self.created()?);
            }
            let (Some(open), Some(record)) = (&mut self.open, self.queue.front()) else { break };
            bytes += open.append(&record.payload())?;
            self.queue.pop_front();
            written += 1;
        }
        if let Some(open) = &self.open {
            open.file.sync_data()?;
        }
        // The journal that this one continues is no longer needed.
        if let Some(replaced) = self.replaces.take() {
            replaced.remove();
        }
        let mut state = self.shared.state();
        state.written += written;
        state.bytes += bytes;
        Ok(())
    }

    /// A new file containing the original plan. It gets its final name only once complete and locked, so
    /// that nobody takes it for a leftover.
    fn created(&self) -> io::Result<OpenFile> {
        fs::create_dir_all(&self.folder)?;
        let temporary = tempfile::Builder::new()
            .prefix("plan-")
            .rand_bytes(12)
            .suffix(&format!(".{UNFINISHED}"))
            .tempfile_in(&self.folder)?;
        // Without lock support, another program is offered a running one's journal: a copy too many.
        let _ = temporary.as_file().try_lock();
        let path = temporary.path().with_extension(ENDING);
        let mut bytes = HEADER.as_bytes().to_vec();
        let mut payload = head(&Head::Start { start: self.start.clone() });
        payload.extend_from_slice(&plan_json::to_bytes(&self.base));
        let checksum = frame(&mut bytes, hash::START, &payload);
        temporary.as_file().write_all(&bytes)?;
        temporary.as_file().sync_all()?;
        let file = temporary.persist(&path).map_err(|error| error.error)?;
        #[cfg(unix)]
        {
            // As in saving: some file systems cannot do this, but the file is there all the same.
            let _ = File::open(&self.folder).and_then(|folder| folder.sync_all());
        }
        Ok(OpenFile { file, path, length: bytes.len() as u64, checksum })
    }
}

impl OpenFile {
    /// Appends a record; returns its size. After an error the file is as before.
    fn append(&mut self, payload: &[u8]) -> io::Result<u64> {
        let mut bytes = Vec::with_capacity(payload.len() + 32);
        let checksum = frame(&mut bytes, self.checksum, payload);
        let written = self.file.seek(io::SeekFrom::Start(self.length)).and_then(|_| self.file.write_all(&bytes));
        if let Err(error) = written {
            // Readers skip half a record; better still if it is gone.
            let _ = self.file.set_len(self.length);
            return Err(error);
        }
        self.length += bytes.len() as u64;
        self.checksum = checksum;
        Ok(bytes.len() as u64)
    }
}

impl Record {
    fn payload(&self) -> Vec<u8> {
        let (title, before, after) = match self {
            Self::Jump { to } => return head(&Head::Jump { to: *to }),
            Self::Draft(draft) => return head(&Head::Draft { draft: draft.clone() }),
            Self::Step { title, before, after } => (title.as_str(), before, after),
            Self::Anew { base, current } => ("Earlier changes", base, current),
        };
        let mut payload = head(&Head::Step { title: title.to_owned() });
        payload.extend_from_slice(&plan_json::change_to_bytes(before, after));
        payload
    }
}

/// The line that a record starts with.
fn head(head: &Head) -> Vec<u8> {
    // A path that is not valid text is dropped: the plan is then recovered without a file.
    let line =
        serde_json::to_vec(head).or_else(|_| serde_json::to_vec(&Head::Start { start: JournalStart::default() }));
    let mut line = line.unwrap_or_default();
    line.push(b'\n');
    line
}

/// Continues the checksum of a journal: over the previous one, then over the new payload.
fn chained(before: u64, payload: &[u8]) -> u64 {
    hash::fnv1a(hash::fnv1a(before, before.to_le_bytes()), payload.iter().copied())
}

/// Appends a record: its length, its checksum, itself. Returns the checksum.
fn frame(bytes: &mut Vec<u8>, checksum: u64, payload: &[u8]) -> u64 {
    let checksum = chained(checksum, payload);
    bytes.extend_from_slice(format!("{} {checksum:016x}\n", payload.len()).as_bytes());
    bytes.extend_from_slice(payload);
    bytes.push(b'\n');
    checksum
}

/// An error of the system in words.
fn said(error: &io::Error) -> String {
    let text = error.to_string();
    text.split_once(" (os error").map_or(text.as_str(), |(words, _)| words).to_owned()
}

// Reading.

/// A journal left behind by a program. While this exists, no other program is offered it.
#[derive(Debug)]
pub struct Leftover {
    pub path: PathBuf,
    /// When it was last written.
    pub modified: Option<SystemTime>,
    /// Its content, or why it cannot be read.
    pub content: Result<Recovered, String>,
    /// Holds the lock.
    _file: File,
}

/// The content of a journal.
#[derive(Clone, Debug)]
pub struct Recovered {
    pub start: JournalStart,
    /// The plan as it was in its file, the steps since, and which is current.
    pub history: History,
    /// What was being drawn, if anything was.
    pub draft: Option<Draft>,
    /// Whether something after the last complete record was dropped: a record being written when the
    /// program ended, or damage.
    pub is_cut: bool,
    /// What is wrong with the plan of the first step that was left out, where it was written whole: no
    /// plan that breaks an invariant comes back, nor what was built on it.
    pub unsound: Option<String>,
}

impl Recovered {
    /// The plan as it was in its file.
    pub fn base(&self) -> &Plan {
        self.history.steps().first().map_or(self.history.plan(), |step| &step.plan)
    }
}

impl Leftover {
    /// Removes its file.
    ///
    /// # Errors
    /// When the file cannot be removed; it will then be offered again.
    pub fn remove(self) -> io::Result<()> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }
}

/// The journals in a folder that no running program is writing, newest first. Those without unsaved
/// changes are removed.
pub fn leftovers(folder: &Path) -> Vec<Leftover> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).map(|entries| entries.flatten().map(|entry| entry.path()).collect()).unwrap_or_default();
    paths.sort();
    let mut found: Vec<Leftover> = paths.into_iter().filter_map(leftover).collect();
    found.sort_by_key(|leftover| std::cmp::Reverse(leftover.modified));
    found
}

fn leftover(path: PathBuf) -> Option<Leftover> {
    // One that was never finished has no unsaved changes; its program may be about to finish it.
    const LONG_AGO: Duration = Duration::from_secs(24 * 60 * 60);
    let ending = path.extension()?.to_str()?;
    let modified = fs::metadata(&path).and_then(|metadata| metadata.modified()).ok();
    if ending == UNFINISHED && modified.and_then(|modified| modified.elapsed().ok()).is_some_and(|age| age > LONG_AGO) {
        let _ = fs::remove_file(&path);
    }
    if ending != ENDING {
        return None;
    }
    let mut file = File::options().read(true).write(true).open(&path).or_else(|_| File::open(&path)).ok()?;
    if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
        return None;
    }
    // Its program may have removed it since the folder was listed.
    if !path.exists() {
        return None;
    }
    let content = read_file(&mut file);
    let leftover = Leftover { path, modified, content, _file: file };
    let keeps_nothing = |it: &Recovered| it.unsound.is_none() && it.draft.is_none() && it.history.plan() == it.base();
    if leftover.content.as_ref().is_ok_and(keeps_nothing) {
        let _ = leftover.remove();
        return None;
    }
    Some(leftover)
}

fn read_file(file: &mut File) -> Result<Recovered, String> {
    let mut bytes = Vec::new();
    file.take(LARGEST_BYTES + 1).read_to_end(&mut bytes).map_err(|error| said(&error))?;
    if bytes.len() as u64 > LARGEST_BYTES {
        return Err("it is larger than any journal".to_owned());
    }
    read_journal(&bytes)
}

/// What a journal's bytes keep. Whatever stands behind the last whole record is left out, and so is a step
/// whose plan breaks an invariant, with all that follows it.
///
/// # Errors
/// When they are no journal, or one of a newer version, or not even its start is whole.
pub fn read_journal(bytes: &[u8]) -> Result<Recovered, String> {
    let rest = bytes.strip_prefix(HEADER.as_bytes()).or_else(|| bytes.strip_prefix(HEADER_BEFORE.as_bytes()));
    let Some(mut rest) = rest else {
        return Err(match bytes.starts_with(KIND.as_bytes()) {
            true => "it was written by another version of Enfilade".to_owned(),
            false => "it is no journal, or its beginning is damaged".to_owned(),
        });
    };
    let mut checksum = hash::START;
    let first = next_record(&mut rest, &mut checksum);
    let Some((Head::Start { start }, body)) = first else {
        return Err("its beginning is damaged".to_owned());
    };
    let base = plan_json::from_bytes(body).map_err(|error| format!("the plan it starts with is damaged: {error}"))?;
    let mut steps = vec![Step { title: "Open".to_owned(), plan: base }];
    let mut at = 0;
    let mut draft = None;
    let mut is_cut = false;
    let mut unsound = None;
    while !rest.is_empty() {
        let Some((head, body)) = next_record(&mut rest, &mut checksum) else {
            is_cut = true;
            break;
        };
        match head {
            Head::Jump { to } if to < steps.len() => {
                at = to;
                draft = None;
            }
            Head::Draft { draft: noted } if is_sound(&noted) => {
                draft = Some(noted).filter(|noted| !noted.points.is_empty());
            }
            Head::Step { title } => {
                let before = &steps[at].plan;
                let Ok(plan) = plan_json::apply_change(before, body) else {
                    is_cut = true;
                    break;
                };
                if let Some(what) = what_is_unsound(&plan, before) {
                    is_cut = true;
                    unsound = Some(format!("{title}: {what}"));
                    break;
                }
                steps.truncate(at + 1);
                steps.push(Step { title, plan });
                at += 1;
                draft = None;
            }
            Head::Jump { .. } | Head::Draft { .. } | Head::Start { .. } => {
                is_cut = true;
                break;
            }
        }
    }
    let history = History::of_steps(steps, at).ok_or("it holds no plan")?;
    Ok(Recovered { start, history, draft, is_cut, unsound })
}

/// Whether something half drawn lies where something can be drawn.
fn is_sound(draft: &Draft) -> bool {
    let is_within = |value: &f64| value.is_finite() && value.abs() <= crate::geometry::COORDINATE_LIMIT_M;
    draft.points.len() <= MOST_POINTS && draft.points.iter().flatten().all(is_within)
}

/// Why a plan would be refused by the file it is to be saved in; `before` would not. Costs what differs.
fn what_is_unsound(plan: &Plan, before: &Plan) -> Option<String> {
    let of_picture =
        || plan.backdrop().and_then(Backdrop::fault).map(|fault| format!("the picture under the plan {fault}"));
    plan.violations_since(before).first().map(ToString::to_string).or_else(of_picture)
}

/// Takes the next record; `None` if it is incomplete.
fn next_record<'a>(rest: &mut &'a [u8], checksum: &mut u64) -> Option<(Head, &'a [u8])> {
    // A length of at most ten digits, a space, a checksum of sixteen.
    const LONGEST_LINE: usize = 10 + 1 + 16;
    let line_end = rest.iter().take(LONGEST_LINE + 1).position(|&byte| byte == b'\n')?;
    let line = std::str::from_utf8(&rest[..line_end]).ok()?;
    let (length, sum) = line.split_once(' ')?;
    let length: usize = length.parse().ok()?;
    let sum = u64::from_str_radix(sum, 16).ok()?;
    // In any other spelling, such as with a capital digit, it is damaged.
    if format!("{length} {sum:016x}") != line {
        return None;
    }
    let behind = &rest[line_end + 1..];
    let payload = behind.get(..length)?;
    if chained(*checksum, payload) != sum || behind.get(length) != Some(&b'\n') {
        return None;
    }
    let head_end = payload.iter().position(|&byte| byte == b'\n')?;
    let head = serde_json::from_slice(&payload[..head_end]).ok()?;
    *checksum = sum;
    *rest = &behind[length + 1..];
    Some((head, &payload[head_end + 1..]))
}
