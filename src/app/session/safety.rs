//! Keeping work safe: the journal of the open plan, and warnings while something is not safe.

use std::path::PathBuf;
use std::time::SystemTime;

use egui::Context;

use super::Session;
use crate::app::session::{
    document::Document,
    messages::{Message, Remedy, Severity},
    origin::{Origin, absolute, file_name},
    recovery::Offered,
    watch::{Content, Theirs, Watch},
    wishes::Wish,
    words::sample_word,
};
use crate::base::wording::sentence;
use crate::store::{Journal, JournalFailure, JournalStart, Predecessor, SaveError};

/// The state of keeping work safe.
#[derive(Default)]
pub(crate) struct Safety {
    /// The folder of journals; `None` to keep none.
    pub(super) folder: Option<PathBuf>,
    /// What can be recovered, newest first.
    pub leftovers: Vec<Offered>,
    /// The clock, if times may be shown.
    pub clock: Option<fn() -> SystemTime>,
    /// What keeps the plan shown safe.
    pub own: OfPlan,
}

/// What keeps one open plan safe.
#[derive(Default)]
pub(crate) struct OfPlan {
    /// Its journal, while it has unsaved changes.
    journal: Option<Journal>,
    /// Why the journal is not being written.
    journal_failure: Option<JournalFailure>,
    /// Why the last attempt to save the plan failed.
    save_failure: Option<SaveError>,
    /// The changes by somebody else to the plan's file.
    pub theirs: Option<Theirs>,
    pub(super) watch: Watch,
}

impl OfPlan {
    /// Ends the journal: what it holds is saved, or given up.
    pub(super) fn end(self) {
        if let Some(journal) = self.journal {
            journal.remove();
        }
    }

    /// The plan is shown again: its file is looked at soon.
    pub(super) fn is_shown_again(&mut self) {
        self.watch.is_shown_again();
    }
}

fn start_of(document: &Document) -> JournalStart {
    match &document.origin {
        Origin::File { path, storey } => {
            JournalStart { file: Some(absolute(path)), storey: *storey, sample: None, stamp: document.stamp }
        }
        Origin::Bundled(index) => {
            JournalStart { sample: Some(sample_word(*index).to_owned()), ..JournalStart::default() }
        }
        Origin::Untitled => JournalStart::default(),
    }
}

impl Session {
    /// From now on shows how old things are.
    pub(crate) fn use_clock(&mut self, clock: fn() -> SystemTime) {
        self.safety.clock = Some(clock);
    }

    /// Updates the journals with the open plans.
    pub(crate) fn keep_journal(&mut self, context: &Context) {
        if !self.quitting {
            self.keep_own_journal(context);
            self.keep_waiting_journals(context);
        }
    }

    /// Updates the journal of the plan shown.
    pub(super) fn keep_own_journal(&mut self, context: &Context) {
        let Some(document) = &self.document else { return };
        if self.safety.own.journal.is_none() && (document.is_changed() || self.draft.is_some()) {
            self.begin_journal(None, context);
        }
        let (Some(document), Some(journal)) = (&self.document, &mut self.safety.own.journal) else { return };
        journal.note(&document.history);
        journal.note_draft(self.draft.as_ref());
        if self.jobs.is_inline() {
            // Its result is checked below.
            let _ = journal.wait();
        }
        self.safety.own.journal_failure = journal.failure();
    }

    pub(super) fn begin_journal(&mut self, replaces: Option<Predecessor>, context: &Context) {
        let (Some(folder), Some(document)) = (&self.safety.folder, &self.document) else { return };
        let base = document.saved().cloned().unwrap_or_default();
        let context = context.clone();
        let on_change = move || context.request_repaint();
        self.safety.own.journal = Some(Journal::begin(folder, start_of(document), base, replaces, on_change));
    }

    /// Records that the plan's file has changed: the journal continues from there.
    pub(super) fn journal_from_file(&mut self, context: &Context) {
        self.safety.own.journal_failure = None;
        let Some(journal) = self.safety.own.journal.take() else { return };
        if self.has_unsaved_changes() {
            self.begin_journal(Some(Predecessor::Journal(journal)), context);
            self.keep_journal(context);
        } else {
            journal.remove();
        }
    }

    /// Ends the journal of a closed plan: its changes are saved, or discarded.
    pub(crate) fn end_journal(&mut self) {
        std::mem::take(&mut self.safety.own).end();
    }

    // Saving.

    pub(crate) fn begins_to_save(&mut self) {
        self.safety.own.watch.saves += 1;
    }

    /// Records that the open plan is saved in its file.
    pub(crate) fn is_saved(&mut self, context: &Context) {
        self.safety.own.save_failure = None;
        self.safety.own.theirs = None;
        self.safety.own.watch.seen = None;
        self.wishes.push(Wish::CloseDifferences);
        self.journal_from_file(context);
    }

    pub(crate) fn is_not_saved(&mut self, error: SaveError) {
        self.safety.own.save_failure = Some(error);
    }

    /// Why the changes are not being kept safe.
    pub(crate) fn journal_failure(&self) -> Option<&JournalFailure> {
        self.safety.own.journal_failure.as_ref()
    }

    /// The messages that stay above the canvas as long as they are true.
    pub(crate) fn bars(&self) -> Vec<Message> {
        let mut bars = Vec::new();
        let mut bar = |severity, text: String, detail: String, remedies: &[Remedy]| {
            bars.push(Message { stays: true, ..Message::new(severity, text, detail).with(remedies.to_vec()) });
        };
        let derived = self.document.as_ref().and_then(Document::derived);
        if let Some(remark) = derived.and_then(|derived| derived.drawing.remark()) {
            bar(Severity::Warning, sentence(&remark), "Measurements and exports are not affected.".to_owned(), &[]);
        }
        if let Some(theirs) = &self.safety.own.theirs
            && let Some(document) = &self.document
        {
            let file = document.origin.title();
            let by_somebody = format!("Someone else has changed {file}");
            match &theirs.content {
                Content::Plan(..) => {
                    let differ = theirs.differs.as_ref().map(|(_, differ)| differ.as_str()).unwrap_or_default();
                    let detail = match document.is_changed() {
                        true => format!("Your own changes are not saved. Differences: {differ}."),
                        false => format!("You see the earlier version. Differences: {differ}."),
                    };
                    let remedies = [Remedy::ShowDifferences, Remedy::LoadTheirs, Remedy::KeepMine];
                    bar(Severity::Warning, by_somebody, detail, &remedies);
                }
                Content::Broken(what) => {
                    let text = format!("{by_somebody}, and it can no longer be read");
                    let detail = format!("You see the earlier version. {what}.");
                    bar(Severity::Warning, text, detail, &[Remedy::KeepMine, Remedy::SaveElsewhere]);
                }
                Content::Gone => {
                    let detail = "What you see may be the only copy. Save it to keep it.".to_owned();
                    bar(Severity::Warning, format!("{file} is gone"), detail, &[Remedy::Save, Remedy::SaveElsewhere]);
                }
            }
        }
        if let Some(JournalFailure { folder, what }) = &self.safety.own.journal_failure {
            let detail = format!(
                "If Enfilade or the computer stops now, your changes are lost, because the recovery file cannot be \
                 written. Save the plan, and free some space.\n{}",
                self.shown_path(folder)
            );
            let text = format!("Your changes have no backup: {what}");
            bar(Severity::Error, text, detail, &[Remedy::Save, Remedy::SaveElsewhere]);
        }
        if let Some(SaveError { path, what, hint }) = &self.safety.own.save_failure {
            let text = format!("{} is not saved: {what}", file_name(path));
            let detail = format!("Your changes are still here; {hint}.\n{}", self.shown_path(path));
            bar(Severity::Error, text, detail, &[Remedy::SaveElsewhere, Remedy::Save]);
        }
        bars
    }
}
