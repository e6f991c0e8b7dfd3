//! Watching the open plan's file for changes by others.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use egui::Context;

use super::Session;
use crate::app::session::{
    document::{self, Derived},
    jobs::Kind,
    wishes::Wish,
};
use crate::formats;
use crate::labels::Schemes;
use crate::plan::{Difference, Plan};
use crate::store::Stamp;

/// How often to check the file of the open plan, in seconds: a user who returns from another program is
/// told before the next edit.
const LOOK_SECS: f64 = 2.0;

/// A change by somebody else to the file of the open plan.
pub(crate) struct Theirs {
    /// The file's stamp; `None` if it is gone.
    stamp: Option<Stamp>,
    pub content: Content,
    /// How much differs from the open plan, and from which plan: computed once for each.
    pub(super) differs: Option<(Plan, String)>,
}

impl Theirs {
    fn new(stamp: Option<Stamp>, content: Content) -> Self {
        Self { stamp, content, differs: None }
    }
}

pub(crate) enum Content {
    Plan(Box<Plan>, Arc<Derived>),
    /// It is not a plan any more; the text says why.
    Broken(String),
    Gone,
}

/// Checks the file from time to time.
#[derive(Default)]
pub(super) struct Watch {
    /// When to check again, by the window's clock.
    next_secs: f64,
    is_looking: bool,
    was_focused: bool,
    /// The file's facts when its bytes were last read.
    pub(super) seen: Option<Facts>,
    /// The number of saves started: a check from before one does not count after it.
    pub(super) saves: u64,
}

impl Watch {
    /// The plan was out of sight: what was being looked at is forgotten.
    pub(super) fn is_shown_again(&mut self) {
        self.is_looking = false;
        self.next_secs = 0.0;
    }
}

/// Facts that show without reading it that a file changed: size, time, number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Facts {
    path: PathBuf,
    bytes: u64,
    modified: Option<SystemTime>,
    number: u64,
}

impl Facts {
    /// # Errors
    /// When the file does not exist, or cannot be examined.
    fn of(path: &Path) -> std::io::Result<Self> {
        let metadata = std::fs::metadata(path)?;
        #[cfg(unix)]
        let number = std::os::unix::fs::MetadataExt::ino(&metadata);
        #[cfg(not(unix))]
        let number = 0;
        Ok(Self { path: path.to_owned(), bytes: metadata.len(), modified: metadata.modified().ok(), number })
    }
}

/// The result of checking a file.
pub(crate) struct Looked {
    document: u64,
    saves: u64,
    facts: Option<Facts>,
    found: Found,
}

enum Found {
    /// It cannot be examined, or nothing is new.
    Nothing,
    /// Its contents are the same as when last read or written here.
    Same,
    Theirs(Box<Theirs>),
}

/// Checks a file that had the stamp `stamp`, and the facts `seen` when its bytes were last read.
fn look(path: &Path, stamp: Option<Stamp>, seen: Option<&Facts>, schemes: &Schemes) -> (Option<Facts>, Found) {
    let facts = match Facts::of(path) {
        Ok(facts) => facts,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let gone = Theirs::new(None, Content::Gone);
            return (None, if stamp.is_none() { Found::Nothing } else { Found::Theirs(Box::new(gone)) });
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
    (Some(facts), Found::Theirs(Box::new(Theirs::new(Some(now), content))))
}

impl Session {
    /// Checks from time to time whether somebody else changed the plan's file.
    pub(crate) fn watch_file(&mut self, context: &Context) {
        let Some(document) = &self.document else { return };
        let Some(path) = document.origin.path().filter(|path| document::is_own_file(path)) else { return };
        let (now_secs, is_focused) = context.input(|input| (input.time, input.focused));
        let watch = &mut self.safety.own.watch;
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
                session.safety.own.watch.is_looking = false;
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
        self.safety.own.watch.is_looking = false;
        if saves != self.safety.own.watch.saves {
            return;
        }
        self.safety.own.watch.seen = facts;
        match found {
            Found::Nothing => {}
            Found::Same => {
                document.is_gone = false;
                self.safety.own.theirs = None;
            }
            // Rewritten, perhaps in another form, with the same contents.
            Found::Theirs(theirs) if matches!(&theirs.content, Content::Plan(plan, _) if document.saved() == Some(&**plan)) =>
            {
                document.is_gone = false;
                document.stamp = theirs.stamp;
                self.safety.own.theirs = None;
            }
            Found::Theirs(theirs) => {
                document.is_gone = matches!(theirs.content, Content::Gone);
                self.safety.own.theirs = Some(*theirs);
            }
        }
        if self.their_plan().is_none() {
            self.wishes.push(Wish::CloseDifferences);
        }
    }

    /// Updates the summary of differences from the changed file, if the plan has changed.
    pub(crate) fn compare_with_theirs(&mut self) {
        let (Some(Theirs { content: Content::Plan(theirs, _), differs, .. }), Some(document)) =
            (&mut self.safety.own.theirs, &self.document)
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

    /// The plan that somebody else saved in the file.
    pub(crate) fn their_plan(&self) -> Option<(&Plan, &Arc<Derived>)> {
        match &self.safety.own.theirs.as_ref()?.content {
            Content::Plan(plan, derived) => Some((plan, derived)),
            Content::Broken(_) | Content::Gone => None,
        }
    }

    /// Replaces the plan by the file's contents, as a step that can be undone.
    pub(crate) fn load_theirs(&mut self, context: &Context) {
        let Some(Theirs { stamp, content: Content::Plan(plan, _), .. }) = self.safety.own.theirs.take() else { return };
        self.wishes.push(Wish::CloseDifferences);
        self.edit("Load the file as it is now", |_| Ok((*plan).clone()));
        if let Some(document) = &mut self.document {
            document.stands_in_file(Some(*plan), stamp);
            self.status = format!("Loaded the new version of {}", document.origin.title());
        }
        self.journal_from_file(context);
    }

    /// Continues with the plan as it is here: saving it will overwrite the other's changes.
    pub(crate) fn keep_mine(&mut self, context: &Context) {
        let Some(Theirs { stamp, content, .. }) = self.safety.own.theirs.take() else { return };
        self.wishes.push(Wish::CloseDifferences);
        let plan = match content {
            Content::Plan(plan, _) => Some(*plan),
            Content::Broken(_) | Content::Gone => None,
        };
        if let Some(document) = &mut self.document {
            document.stands_in_file(plan, stamp);
            self.status = "Saving overwrites what someone else saved".to_owned();
        }
        self.journal_from_file(context);
    }

    /// Has the file checked again soon.
    pub(crate) fn look_soon(&mut self) {
        self.safety.own.watch.next_secs = 0.0;
    }
}
