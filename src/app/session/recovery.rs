//! Unsaved work left behind by other runs of the program: offered, recovered or discarded.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::Context;

use super::Session;
use crate::app::session::{
    document::{Derived, Document, Opened},
    jobs::Kind,
    messages::{Lasts, Message, Severity},
    origin::{Origin, bundled},
    questions::{Intent, Question},
    wishes::Wish,
    words::sample_word,
};
use crate::labels::Schemes;
use crate::store::{JournalStart, Leftover, Predecessor, leftovers};

/// A journal offered for recovery.
pub(crate) struct Offered {
    pub leftover: Leftover,
    /// The analysis of the plan that would be recovered.
    pub derived: Option<Arc<Derived>>,
}

impl Offered {
    fn new(leftover: Leftover, schemes: &Schemes) -> Self {
        let recovered = leftover.content.as_ref().ok();
        let derived = recovered.map(|recovered| Arc::new(Derived::new(recovered.history.plan(), schemes, None)));
        Self { leftover, derived }
    }

    /// The plan's title.
    pub(crate) fn title(&self) -> String {
        let Ok(recovered) = &self.leftover.content else { return "Unreadable journal".to_owned() };
        let name = &recovered.history.plan().meta().name;
        if name.is_empty() { origin_of(&recovered.start).title() } else { name.clone() }
    }
}

/// The origin of a journal's plan.
fn origin_of(start: &JournalStart) -> Origin {
    let sample = |sample: &String| (0..bundled().len()).find(|&index| sample_word(index) == sample.as_str());
    match (&start.file, start.sample.as_ref().and_then(sample)) {
        (Some(path), _) => Origin::File { path: path.clone(), storey: start.storey },
        (None, Some(index)) => Origin::Bundled(index),
        (None, None) => Origin::Untitled,
    }
}

impl Session {
    /// Keeps journals in a folder from now on, and offers those left there.
    pub fn use_journal(&mut self, folder: PathBuf) {
        self.safety.folder = Some(folder.clone());
        let schemes = self.schemes.clone();
        self.jobs.start(Kind::new("look for unsaved work"), move |_| {
            let offered = leftovers(&folder).into_iter().map(|leftover| Offered::new(leftover, &schemes));
            let offered: Vec<Offered> = offered.collect();
            move |session: &mut Session, _: &_| session.were_left_over(offered)
        });
    }

    pub(crate) fn were_left_over(&mut self, offered: Vec<Offered>) {
        self.wishes.push(if offered.is_empty() { Wish::CloseRecovery } else { Wish::OfferRecovery });
        self.safety.leftovers = offered;
    }

    /// Recovers the Nth leftover, from 1, beside the plans that are open.
    pub(crate) fn recover(&mut self, number: usize) -> Result<(), String> {
        let offered = self.offered(number)?;
        if let Err(what) = &offered.leftover.content {
            return Err(what.clone());
        }
        let path = offered.leftover.path.clone();
        self.request(Intent::Recover(path));
        Ok(())
    }

    /// Asks whether to discard the Nth leftover.
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
                let text = format!("The recovery file of {title} could not be removed");
                self.say_of_program(Severity::Warning, text, format!("{error}\n{}", self.shown_path(path)));
            }
        }
    }

    /// Opens a journal's contents, as unsaved changes of its plan.
    pub(crate) fn show_recovered(&mut self, path: &Path, context: &Context) {
        let Some(Offered { leftover, .. }) = self.take_offered(path) else { return };
        let Ok(recovered) = leftover.content.clone() else { return };
        let origin = origin_of(&recovered.start);
        let opened = Opened {
            origin: origin.clone(),
            storeys: vec![recovered.base().clone()],
            notes: Vec::new(),
            stamp: recovered.start.stamp,
            listed: None,
            begun: None,
        };
        let changes = match (recovered.history.position(), &recovered.draft) {
            (0, Some(_)) => "what was being drawn".to_owned(),
            (number, _) => crate::base::wording::count(number, "change"),
        };
        self.show(opened);
        self.draft.clone_from(&recovered.draft);
        self.wishes.extend(recovered.draft.clone().map(Wish::Resume));
        if let Some(document) = &mut self.document {
            document.history = recovered.history;
        }
        let detail = match origin.path() {
            Some(path) => format!("The file does not change until you save.\n{}", self.shown_path(path)),
            None => "Save it to keep it.".to_owned(),
        };
        let title = self.document.as_ref().map(Document::title).unwrap_or_default();
        let said = Message::new(Severity::Info, format!("Recovered {changes} of {title}"), detail);
        let lasts = if self.has_unsaved_changes() { Lasts::Unsaved } else { Lasts::Always };
        self.add_message(said.lasting(lasts));
        // What was left behind stays until the new journal holds it; what cannot be held stays for good.
        let mut replaced = Some(Predecessor::Leftover(leftover));
        if let Some(what) = &recovered.unsound {
            let text = "One recovered change is damaged; it and the changes after it are left out";
            let detail = format!(
                "{what}\nEverything before it is here. The recovery file is kept, and you will be \
                                  asked again."
            );
            self.say(Severity::Warning, text, detail);
            replaced = None;
        } else if recovered.is_cut {
            let text = "The last change was cut off when Enfilade closed";
            self.say(Severity::Warning, text, "Everything before it is here.");
        }
        self.begin_journal(replaced, context);
        self.keep_journal(context);
    }
}
