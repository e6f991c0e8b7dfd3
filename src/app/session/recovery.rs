//! Keeping work safe: the journal of the open plan, what programs that were killed left behind, and the
//! file on the disk, which somebody else may change.

use super::wishes::Wish;
use crate::app::session::Session;
use crate::app::session::origin::file_name;
use crate::app::session::words::sample_word;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use egui::Context;

use crate::app::session::{
    document::{self, Derived, Document, Opened},
    jobs::Kind,
    messages::{Message, Remedy, Severity},
    origin::{Origin, bundled},
    questions::{Intent, Question},
};
use crate::formats;
use crate::labels::Schemes;
use crate::plan::{Difference, Plan};
use crate::store::{Journal, JournalFailure, JournalStart, Leftover, Predecessor, SaveError, Stamp, leftovers};

/// The file of the open plan is looked at so often, in seconds: who comes back from another program has
/// been told before the next edit.
const LOOK_SECS: f64 = 2.0;

/// What keeps work safe.
#[derive(Default)]
pub(crate) struct Safety {
    /// Where journals are kept; none without.
    folder: Option<PathBuf>,
    /// That of the open plan, while it has changes that are in no file.
    journal: Option<Journal>,
    /// Why the journal is not being written.
    journal_failure: Option<JournalFailure>,
    /// Why the plan could not be saved when that was last tried.
    save_failure: Option<SaveError>,
    /// What can be recovered, the newest first.
    pub leftovers: Vec<Offered>,
    /// What somebody else made of the plan's file.
    pub theirs: Option<Theirs>,
    watch: Watch,
    /// Tells the time where that may be shown.
    pub clock: Option<fn() -> SystemTime>,
}

/// A journal that is offered.
pub(crate) struct Offered {
    pub leftover: Leftover,
    /// What follows from the plan that would be recovered.
    pub derived: Option<Arc<Derived>>,
}

impl Offered {
    fn new(leftover: Leftover, schemes: &Schemes) -> Self {
        let recovered = leftover.content.as_ref().ok();
        let derived = recovered.map(|recovered| Arc::new(Derived::new(recovered.history.plan(), schemes, None)));
        Self { leftover, derived }
    }

    /// What the plan is called.
    pub(crate) fn title(&self) -> String {
        let Ok(recovered) = &self.leftover.content else { return "Unreadable journal".to_owned() };
        let name = &recovered.history.plan().meta().name;
        if name.is_empty() { origin_of(&recovered.start).title() } else { name.clone() }
    }
}

/// What somebody else made of the file of the open plan.
pub(crate) struct Theirs {
    /// What the file holds; `None` when it is gone.
    stamp: Option<Stamp>,
    pub content: Content,
    /// How much differs from the open plan, and from which: worked out once for each.
    differs: Option<(Plan, String)>,
}

impl Theirs {
    fn new(stamp: Option<Stamp>, content: Content) -> Self {
        Self { stamp, content, differs: None }
    }
}

pub(crate) enum Content {
    Plan(Box<Plan>, Arc<Derived>),
    /// It is no plan any more, and why.
    Broken(String),
    Gone,
}

/// Looks at the file from time to time.
#[derive(Default)]
struct Watch {
    /// When to look again, by the window's clock.
    next_secs: f64,
    is_looking: bool,
    was_focused: bool,
    /// What the file was like when its bytes were last read.
    seen: Option<Facts>,
    /// How many saves were begun: what was seen before one does not count after it.
    saves: u64,
}

/// What tells without reading a file that it is another: size, time, number.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Facts {
    path: PathBuf,
    bytes: u64,
    modified: Option<SystemTime>,
    number: u64,
}

impl Facts {
    /// # Errors
    /// When there is no such file, or it cannot be looked at.
    fn of(path: &Path) -> std::io::Result<Self> {
        let metadata = std::fs::metadata(path)?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Ok(Self { path: path.to_owned(), bytes: metadata.len(), modified: metadata.modified().ok(), number })
    }
}

/// What a look at a file found.
pub(crate) struct Looked {
    document: u64,
    saves: u64,
    facts: Option<Facts>,
    found: Found,
}

enum Found {
    /// It cannot be looked at, or nothing is new.
    Nothing,
    /// It holds what it held when it was last read or written here.
    Same,
    Theirs(Theirs),
}

/// Looks at a file that held `stamp`, and was like `seen` when its bytes were last read.
fn look(path: &Path, stamp: Option<Stamp>, seen: Option<&Facts>, schemes: &Schemes) -> (Option<Facts>, Found) {
    let facts = match Facts::of(path) {
        Ok(facts) => facts,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let gone = Theirs::new(None, Content::Gone);
            return (None, if stamp.is_none() { Found::Nothing } else { Found::Theirs(gone) });
        }
        Err(_) => return (None, Found::Nothing),
    };
    if seen == Some(&facts) {
        return (Some(facts), Found::Nothing);
    }
    let Ok(bytes) = formats::read_bytes(path) else { return (None, Found::Nothing) };
    let now = Stamp::of_bytes(&bytes);
    if stamp == Some(now) {
        return (Some(facts), Found::Same);
    }
    let content = match formats::read_from(path, &bytes) {
        Ok(import) => import.plans.into_iter().next().map_or_else(
            || Content::Broken("it holds no plan".to_owned()),
            |plan| {
                let derived = Arc::new(Derived::new(&plan, schemes, None));
                Content::Plan(Box::new(plan), derived)
            },
        ),
        Err(error) => Content::Broken(error.error.to_string()),
    };
    (Some(facts), Found::Theirs(Theirs::new(Some(now), content)))
}

/// Where a plan that a journal keeps came from.
fn origin_of(start: &JournalStart) -> Origin {
    let sample = |sample: &String| (0..bundled().len()).find(|&index| sample_word(index) == sample.as_str());
    match (&start.file, start.sample.as_ref().and_then(sample)) {
        (Some(path), _) => Origin::File { path: path.clone(), storey: start.storey },
        (None, Some(index)) => Origin::Bundled(index),
        (None, None) => Origin::Untitled,
    }
}

fn start_of(document: &Document) -> JournalStart {
    match &document.origin {
        Origin::File { path, storey } => JournalStart {
            file: Some(std::path::absolute(path).unwrap_or_else(|_| path.clone())),
            storey: *storey,
            sample: None,
            stamp: document.stamp,
        },
        Origin::Bundled(index) => {
            JournalStart { sample: Some(sample_word(*index).to_owned()), ..JournalStart::default() }
        }
        Origin::Untitled => JournalStart::default(),
    }
}

impl Session {
    // The journal.

    /// Keeps journals in a folder from now on, and offers what is left there.
    pub fn use_journal(&mut self, folder: PathBuf) {
        self.safety.folder = Some(folder.clone());
        let schemes = self.schemes.clone();
        self.jobs.start(Kind::new("look for unsaved work"), move |_| {
            let offered = leftovers(&folder).into_iter().map(|leftover| Offered::new(leftover, &schemes));
            let offered: Vec<Offered> = offered.collect();
            move |session: &mut Session, _: &_| session.were_left_over(offered)
        });
    }

    /// Tells from now on how old things are.
    pub(crate) fn use_clock(&mut self, clock: fn() -> SystemTime) {
        self.safety.clock = Some(clock);
    }

    /// Brings the journal up to date with the open plan.
    pub(crate) fn keep_journal(&mut self, context: &Context) {
        if self.quitting {
            return;
        }
        let Some(document) = &self.document else { return };
        if self.safety.journal.is_none() && document.is_changed() {
            self.begin_journal(None, context);
        }
        let (Some(document), Some(journal)) = (&self.document, &mut self.safety.journal) else { return };
        journal.note(&document.history);
        if self.jobs.is_inline() {
            // What it says is asked below.
            let _ = journal.wait();
        }
        self.safety.journal_failure = journal.failure();
    }

    fn begin_journal(&mut self, replaces: Option<Predecessor>, context: &Context) {
        let (Some(folder), Some(document)) = (&self.safety.folder, &self.document) else { return };
        let base = document.saved().cloned().unwrap_or_default();
        let context = context.clone();
        let on_change = move || context.request_repaint();
        self.safety.journal = Some(Journal::begin(folder, start_of(document), base, replaces, on_change));
    }

    /// Takes note that the plan's file holds something else now: the journal goes on from there.
    fn journal_from_file(&mut self, context: &Context) {
        self.safety.journal_failure = None;
        let Some(journal) = self.safety.journal.take() else { return };
        if self.has_unsaved_changes() {
            self.begin_journal(Some(Predecessor::Journal(journal)), context);
            self.keep_journal(context);
        } else {
            journal.remove();
        }
    }

    /// Ends the journal of a plan that is closed: its changes are saved, or given up.
    pub(crate) fn end_journal(&mut self) {
        if let Some(journal) = self.safety.journal.take() {
            journal.remove();
        }
        let Safety { folder, leftovers, clock, .. } = std::mem::take(&mut self.safety);
        self.safety = Safety { folder, leftovers, clock, ..Safety::default() };
    }

    // Recovery.

    pub(crate) fn were_left_over(&mut self, offered: Vec<Offered>) {
        self.wishes.push(if offered.is_empty() { Wish::CloseRecovery } else { Wish::OfferRecovery });
        self.safety.leftovers = offered;
    }

    /// Recovers the Nth of what was left behind, from 1, after asking where that would lose unsaved work.
    pub(crate) fn recover(&mut self, number: usize) -> Result<(), String> {
        let offered = self.offered(number)?;
        if let Err(what) = &offered.leftover.content {
            return Err(what.clone());
        }
        let path = offered.leftover.path.clone();
        self.wishes.push(Wish::CloseRecovery);
        self.request(Intent::Recover(path));
        Ok(())
    }

    /// Asks whether to discard the Nth of what was left behind.
    pub(crate) fn ask_to_discard(&mut self, number: usize) -> Result<(), String> {
        let offered = self.offered(number)?;
        let question = Question::discard(offered.leftover.path.clone(), &offered.title());
        self.ask(question);
        Ok(())
    }

    fn offered(&self, number: usize) -> Result<&Offered, String> {
        let found = number.checked_sub(1).and_then(|index| self.safety.leftovers.get(index));
        found.ok_or_else(|| format!("there are only {} to recover", self.safety.leftovers.len()))
    }

    fn take_offered(&mut self, path: &Path) -> Option<Offered> {
        let index = self.safety.leftovers.iter().position(|offered| offered.leftover.path == *path)?;
        let offered = self.safety.leftovers.remove(index);
        if self.safety.leftovers.is_empty() {
            self.wishes.push(Wish::CloseRecovery);
        }
        Some(offered)
    }

    pub(crate) fn discard_leftover(&mut self, path: &Path) {
        let Some(offered) = self.take_offered(path) else { return };
        let title = offered.title();
        match offered.leftover.remove() {
            Ok(()) => self.status = format!("Discarded the changes to {title}"),
            Err(error) => {
                let text = format!("The journal of {title} could not be removed");
                self.say(Severity::Warning, text, format!("{error}\n{}", self.shown_path(path)));
            }
        }
    }

    /// Opens what a journal keeps, as changes of its plan that are in no file.
    pub(crate) fn show_recovered(&mut self, path: &Path, context: &Context) {
        let Some(Offered { leftover, .. }) = self.take_offered(path) else { return };
        let Ok(recovered) = &leftover.content else { return };
        let recovered = recovered.clone();
        let origin = origin_of(&recovered.start);
        let opened = Opened {
            origin: origin.clone(),
            storeys: vec![recovered.base().clone()],
            notes: Vec::new(),
            stamp: recovered.start.stamp,
            begun: None,
        };
        let changes = crate::base::wording::count(recovered.history.position(), "change");
        self.show(opened);
        if let Some(document) = &mut self.document {
            document.history = recovered.history;
        }
        let detail = match origin.path() {
            Some(path) => format!("Nothing is in the file until you save.\n{}", self.shown_path(path)),
            None => "It is in no file until you save.".to_owned(),
        };
        let title = self.document.as_ref().map(Document::title).unwrap_or_default();
        self.say(Severity::Info, format!("Recovered {changes} of {title}"), detail);
        if recovered.is_cut {
            let text = "The last change was not written completely when the program ended";
            self.say(Severity::Warning, text, "Everything before it is here.");
        }
        // What was left behind stays until the new journal holds it.
        self.begin_journal(Some(Predecessor::Leftover(leftover)), context);
        self.keep_journal(context);
    }

    // The file on the disk.

    /// Looks from time to time whether somebody else changed the plan's file.
    pub(crate) fn watch_file(&mut self, context: &Context) {
        let Some(document) = &self.document else { return };
        let Some(path) = document.origin.path().filter(|path| document::is_own_file(path)) else { return };
        let (now_secs, is_focused) = context.input(|input| (input.time, input.focused));
        let watch = &mut self.safety.watch;
        let comes_back = is_focused && !std::mem::replace(&mut watch.was_focused, is_focused);
        context.request_repaint_after_secs(LOOK_SECS as f32);
        if watch.is_looking || self.jobs.is_one_to_end() || (now_secs < watch.next_secs && !comes_back) {
            return;
        }
        watch.is_looking = true;
        watch.next_secs = now_secs + LOOK_SECS;
        let (path, stamp, seen, saves) = (path.to_owned(), document.stamp, watch.seen.clone(), watch.saves);
        let (document, schemes) = (document.number, self.schemes.clone());
        let kind = Kind::new("look at the plan's file").if_broken(move |session| {
            if session.document.as_ref().is_some_and(|open| open.number == document) {
                session.safety.watch.is_looking = false;
            }
        });
        self.jobs.start(kind, move |_| {
            let (facts, found) = look(&path, stamp, seen.as_ref(), &schemes);
            move |session: &mut Session, _: &_| session.was_looked_at(Looked { document, saves, facts, found })
        });
    }

    pub(crate) fn was_looked_at(&mut self, looked: Looked) {
        let Looked { document: number, saves, facts, found } = looked;
        let Some(document) = self.document.as_mut().filter(|document| document.number == number) else { return };
        self.safety.watch.is_looking = false;
        if saves != self.safety.watch.saves {
            return;
        }
        self.safety.watch.seen = facts;
        match found {
            Found::Nothing => {}
            Found::Same => {
                document.is_gone = false;
                self.safety.theirs = None;
            }
            // Written anew, or otherwise, with the same in it.
            Found::Theirs(Theirs { stamp, content: Content::Plan(plan, _), .. })
                if document.saved() == Some(&*plan) =>
            {
                document.is_gone = false;
                document.stamp = stamp;
                self.safety.theirs = None;
            }
            Found::Theirs(theirs) => {
                document.is_gone = matches!(theirs.content, Content::Gone);
                self.safety.theirs = Some(theirs);
            }
        }
        if self.their_plan().is_none() {
            self.wishes.push(Wish::CloseDifferences);
        }
    }

    /// Says anew how much differs from the file that somebody else changed, where the plan is another.
    pub(crate) fn compare_with_theirs(&mut self) {
        let (Some(Theirs { content: Content::Plan(theirs, _), differs, .. }), Some(document)) =
            (&mut self.safety.theirs, &self.document)
        else {
            return;
        };
        let mine = document.plan();
        if !differs.as_ref().is_some_and(|(of, _)| of.is_same_value(mine)) {
            let difference = Difference::between(mine, theirs);
            let summary = difference.in_words(&difference.seen(mine, theirs));
            *differs = Some((mine.clone(), summary));
        }
    }

    /// The plan that somebody else put in the file.
    pub(crate) fn their_plan(&self) -> Option<(&Plan, &Arc<Derived>)> {
        match &self.safety.theirs.as_ref()?.content {
            Content::Plan(plan, derived) => Some((plan, derived)),
            Content::Broken(_) | Content::Gone => None,
        }
    }

    /// Makes the plan what the file holds now, as a step that can be undone.
    pub(crate) fn load_theirs(&mut self, context: &Context) {
        let Some(Theirs { stamp, content: Content::Plan(plan, _), .. }) = self.safety.theirs.take() else { return };
        self.wishes.push(Wish::CloseDifferences);
        self.edit("Load the file as it is now", |_| Ok((*plan).clone()));
        if let Some(document) = &mut self.document {
            document.stands_in_file(Some(*plan), stamp);
            self.status = format!("Loaded {} as it is now", document.origin.title());
        }
        self.journal_from_file(context);
    }

    /// Goes on with the plan as it is here: saving it replaces what somebody else put in the file.
    pub(crate) fn keep_mine(&mut self, context: &Context) {
        let Some(Theirs { stamp, content, .. }) = self.safety.theirs.take() else { return };
        self.wishes.push(Wish::CloseDifferences);
        let plan = match content {
            Content::Plan(plan, _) => Some(*plan),
            Content::Broken(_) | Content::Gone => None,
        };
        if let Some(document) = &mut self.document {
            document.stands_in_file(plan, stamp);
            self.status = "Saving replaces what somebody else put in the file".to_owned();
        }
        self.journal_from_file(context);
    }

    // Saving.

    pub(crate) fn begins_to_save(&mut self) {
        self.safety.watch.saves += 1;
    }

    /// Takes note that the open plan stands in its file.
    pub(crate) fn is_saved(&mut self, context: &Context) {
        self.safety.save_failure = None;
        self.safety.theirs = None;
        self.safety.watch.seen = None;
        self.wishes.push(Wish::CloseDifferences);
        self.journal_from_file(context);
    }

    pub(crate) fn is_not_saved(&mut self, error: SaveError) {
        self.safety.save_failure = Some(error);
    }

    /// Why the changes are not being kept safe.
    pub(crate) fn journal_failure(&self) -> Option<&JournalFailure> {
        self.safety.journal_failure.as_ref()
    }

    /// Has the file looked at again soon.
    pub(crate) fn look_soon(&mut self) {
        self.safety.watch.next_secs = 0.0;
    }

    /// What stays above the canvas as long as it is so.
    pub(crate) fn bars(&self) -> Vec<Message> {
        let mut bars = Vec::new();
        let mut bar = |severity, text: String, detail: String, remedies: &[Remedy]| {
            bars.push(Message { severity, text, detail, remedies: remedies.to_vec(), stays: true });
        };
        if let Some(theirs) = &self.safety.theirs
            && let Some(document) = &self.document
        {
            let file = document.origin.title();
            let by_somebody = format!("{file} was changed by somebody else");
            match &theirs.content {
                Content::Plan(..) => {
                    let differ = theirs.differs.as_ref().map(|(_, differ)| differ.as_str()).unwrap_or_default();
                    let detail = match document.is_changed() {
                        true => format!("Your own changes are in no file yet. Between the two: {differ}."),
                        false => format!("What you see is what it held before. Between the two: {differ}."),
                    };
                    let remedies = [Remedy::ShowDifferences, Remedy::LoadTheirs, Remedy::KeepMine];
                    bar(Severity::Warning, by_somebody, detail, &remedies);
                }
                Content::Broken(what) => {
                    let text = format!("{by_somebody} and cannot be read any more");
                    let detail = format!("What you see is what it held before. {what}.");
                    bar(Severity::Warning, text, detail, &[Remedy::KeepMine, Remedy::SaveElsewhere]);
                }
                Content::Gone => {
                    let detail = "What you see may be the only copy. Save it to keep it.".to_owned();
                    bar(Severity::Warning, format!("{file} is gone"), detail, &[Remedy::Save, Remedy::SaveElsewhere]);
                }
            }
        }
        if let Some(JournalFailure { folder, what }) = &self.safety.journal_failure {
            let detail = format!(
                "If the program or the machine stops now, what you changed is lost: the journal cannot be written. Save \
                 the plan, and free some space.\n{}",
                self.shown_path(folder)
            );
            let text = format!("Your changes are not kept safe: {what}");
            bar(Severity::Error, text, detail, &[Remedy::Save, Remedy::SaveElsewhere]);
        }
        if let Some(SaveError { path, what, hint }) = &self.safety.save_failure {
            let text = format!("{} is not saved: {what}", file_name(path));
            let detail = format!("Your changes are still here; {hint}.\n{}", self.shown_path(path));
            bar(Severity::Error, text, detail, &[Remedy::SaveElsewhere, Remedy::Save]);
        }
        bars
    }
}
