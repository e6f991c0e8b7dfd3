//! Opening, saving, closing: never losing unsaved work, never overwriting silently.

use super::wishes::Wish;
use crate::app::session::Session;
use crate::app::session::origin::file_name;
use crate::app::session::picture_change::PictureUse;
use crate::app::session::tracing::plan_in_folder;
use std::path::{Path, PathBuf};

use egui::Context;

use crate::app::session::{
    document::{self, Begun, Document, Expected, Opened, SaveFailure},
    file_dialogs::{Answer, Purpose},
    ghost::Ghost,
    jobs::Kind,
    messages::{Message, Remedy, Severity},
    origin::Origin,
    plan_list::{self, Depth},
    questions::{Intent, Question},
    selection::Selection,
};
use crate::app::value::{Call, Value};
use crate::edit::storey::{Keep, copied};
use crate::formats::FileError;
use crate::plan::Plan;
use crate::store::Stamp;

impl Session {
    /// Asks which plan to open.
    pub(crate) fn choose_plan(&mut self) {
        let folder = self.document.as_ref().and_then(|document| document.origin.folder()).map(Path::to_owned);
        self.dialogs.ask(Purpose::Open, folder, String::new(), &mut self.jobs);
    }

    /// Shows an empty plan.
    pub(crate) fn new_plan(&mut self) {
        // A file still being read was requested earlier.
        self.opening = None;
        self.request(Intent::Show(Box::new(Opened::untitled())));
    }

    /// Starts a plan of another storey as a copy of this one, which is then shown below it.
    pub(crate) fn copy_storey(&mut self, storey: &str, keep: Keep) {
        let Some(below) = self.plan().cloned() else { return };
        self.opening = None;
        let begun = Begun { title: format!("Copy storey as {storey}"), plan: copied(&below, storey, keep), below };
        let opened = Opened { begun: Some(Box::new(begun)), ..Opened::untitled() };
        self.request(Intent::Show(Box::new(opened)));
    }

    /// Reads a plan and shows it once it is read.
    pub(crate) fn open(&mut self, origin: Origin) {
        self.opening = Some(origin.clone());
        let kind = Kind::new("open a plan").newest_of("plan to show").if_broken(|session| session.opening = None);
        self.jobs.start(kind, move |_| {
            let opened = document::open(origin.clone());
            move |session: &mut Session, _: &_| session.was_opened(&origin, opened)
        });
    }

    pub(crate) fn was_opened(&mut self, origin: &Origin, result: Result<Opened, FileError>) {
        // Only the latest request counts.
        if self.opening.as_ref() != Some(origin) {
            return;
        }
        self.opening = None;
        match result {
            Ok(opened) => self.request(Intent::Show(Box::new(opened))),
            Err(FileError { path, error }) => {
                self.say(Severity::Error, format!("Cannot open {}", file_name(&path)), {
                    format!("{error}\n{}", self.shown_path(&path))
                });
            }
        }
    }

    /// Opens the plan `step` places down the list.
    pub(crate) fn open_neighbour(&mut self, step: isize) {
        let current = self.document.as_ref().map(|document| &document.origin);
        if let Some(origin) = self.list.neighbour(current, step) {
            self.open(origin);
        }
    }

    /// Does what the user wants, after asking if that would lose unsaved work.
    pub(crate) fn request(&mut self, intent: Intent) {
        self.commit_field();
        if self.question.is_some() || self.jobs.is_one_to_end() {
            // One thing at a time: while saving, there is no need to ask.
            self.waiting = Some(intent);
        } else if self.has_unsaved_changes() {
            let title = self.document.as_ref().map(Document::title).unwrap_or_default();
            self.ask(Question::unsaved(&title, intent));
        } else {
            self.perform(intent);
        }
    }

    /// Continues with what waited for an answer, or for a file to be saved.
    pub(crate) fn take_waiting(&mut self) {
        if self.question.is_none()
            && !self.jobs.is_one_to_end()
            && let Some(intent) = self.waiting.take()
        {
            self.request(intent);
        }
    }

    /// Does it, regardless of unsaved work.
    pub(crate) fn perform(&mut self, intent: Intent) {
        match intent {
            Intent::Show(opened) => self.show(*opened),
            Intent::Recover(path) => self.recovering = Some(path),
            Intent::Close => {
                self.end_journal();
                self.document = None;
                self.selection = Selection::default();
                self.wishes.push(Wish::ForgetDrawing);
            }
            // The recording first, or it would be lost.
            Intent::Quit if self.is_recording => self.wishes.push(Wish::EndRecording(Intent::Quit)),
            Intent::Quit => {
                self.end_journal();
                self.quitting = true;
            }
        }
    }

    pub(crate) fn show(&mut self, opened: Opened) {
        self.end_journal();
        let folder = opened.listed.clone().map(|folder| (folder, Depth::All)).or_else(|| {
            let folder = opened.origin.folder().map(Path::to_owned)?;
            Some(self.list.listed_for(folder))
        });
        self.selection = Selection::default();
        self.fresh = None;
        self.field = None;
        self.wishes.push(Wish::ForgetPlan);
        self.status.clear();
        let notes = (!opened.notes.is_empty()).then(|| {
            let summary = crate::app::session::origin::notes_in_words(&opened.notes);
            let text = format!("Imported {}: {summary}", opened.origin.title());
            Message::new(Severity::Info, text, "").with(vec![Remedy::ShowNotes])
        });
        let below = opened.begun.as_ref().map(|begun| begun.below.clone());
        self.ghost = below.map(|below| Ghost::new(below, None, &self.schemes));
        self.documents += 1;
        self.document = Some(Document::new(self.documents, opened));
        if let Some(notes) = notes {
            self.add_message(notes);
        }
        if let Some((folder, depth)) = folder {
            self.list_folder(folder, depth);
        }
    }

    fn list_folder(&mut self, folder: PathBuf, depth: Depth) {
        self.jobs.start(Kind::new("list the plans of a folder").newest_of("list of plans"), move |_| {
            let files = plan_list::plans_in(&folder, depth);
            move |session: &mut Session, _: &_| session.list.set_folder(folder, depth, files)
        });
    }

    pub(super) fn has_own_file(&self) -> bool {
        let path = self.document.as_ref().and_then(|document| document.origin.path());
        path.is_some_and(document::is_own_file)
    }

    /// Saves the plan in its file, then does what was to follow. If it has none in Enfilade's own format,
    /// asks for one. Returns whether it did not have to ask.
    pub(crate) fn save(&mut self, then: Option<Intent>) -> bool {
        let Some(document) = &self.document else { return true };
        match document.origin.path() {
            Some(path) if document::is_own_file(path) => {
                let (path, expected) = (path.to_owned(), Expected::Seen(document.stamp));
                self.save_to(path, expected, then);
                true
            }
            _ => {
                self.ask_where_to_save(then, None);
                false
            }
        }
    }

    /// Asks for a file to save the plan in, then does what was to follow. `answering`: the answer to a
    /// question that led here.
    pub(crate) fn ask_where_to_save(&mut self, then: Option<Intent>, answering: Option<&'static str>) {
        let Some(document) = &self.document else { return };
        let folder = document.origin.folder().map(Path::to_owned);
        let name = format!("{}.plan.json", document.origin.stem());
        self.dialogs.ask(Purpose::Save { then, answering }, folder, name, &mut self.jobs);
    }

    /// Saves the plan in the file the user chose, adding the extension if it is missing.
    pub(crate) fn save_in(&mut self, mut path: PathBuf, then: Option<Intent>) {
        if document::is_own_file(&path) {
            // The save dialog already asked whether to replace it.
            self.save_to(path, Expected::Anything, then);
            return;
        }
        path.as_mut_os_string().push(".plan.json");
        if path.exists() {
            self.ask(Question::replace(path, false, then));
        } else {
            self.save_to(path, Expected::Anything, then);
        }
    }

    pub(crate) fn was_chosen(&mut self, answer: Answer, _context: &Context) {
        let Answer { purpose, path, was_shown } = answer;
        let Some(path) = path else {
            if !was_shown {
                self.say(
                    Severity::Warning,
                    "Your system offers no file dialog",
                    "Drop a file on the window, or start Enfilade with the file's path. On Linux, dialogs come from \
                     the desktop's portal or from zenity.",
                );
            }
            // Cancel means cancel: what was to follow is dropped.
            if let Purpose::Save { answering: Some(_), .. } = purpose {
                self.note_executed("answer", vec!["cancel".to_owned()]);
            }
            return;
        };
        let run = |id: &'static str| Wish::Run(Call::new(id, [Value::Path(path.clone())]));
        let word = path.to_string_lossy().into_owned();
        match purpose {
            Purpose::Open => self.wishes.push(run("open")),
            Purpose::Picture(PictureUse::Add) => self.wishes.push(run("picture")),
            Purpose::Picture(PictureUse::Relink) => self.wishes.push(run("relink-picture")),
            Purpose::Export | Purpose::Dataset => self.chosen_file = Some(path),
            Purpose::Recording(save) => self.wishes.push(Wish::Recording(save(path))),
            Purpose::Save { then: None, answering: None } => self.wishes.push(run("save-as")),
            Purpose::Save { then, answering } => {
                if let Some(answer) = answering {
                    self.note_executed("answer", vec![answer.to_owned(), word]);
                }
                self.save_in(path, then);
            }
        }
    }

    pub(crate) fn save_to(&mut self, path: PathBuf, expected: Expected, then: Option<Intent>) {
        let Some(document) = &self.document else { return };
        let plan = plan_in_folder(document.plan(), document.origin.folder(), path.parent());
        let document = document.number;
        self.begins_to_save();
        // What was to follow a save is dropped if the save panics.
        let kind = Kind::new("save the plan").must_end().if_broken(|session| session.waiting = None);
        self.jobs.start(kind, move |_| {
            let result = document::save(&path, &plan, expected);
            move |session: &mut Session, context: &Context| {
                session.was_saved(document, path, plan, result, then, context);
            }
        });
    }

    pub(crate) fn was_saved(
        &mut self,
        number: u64,
        path: PathBuf,
        plan: Plan,
        result: Result<Option<Stamp>, SaveFailure>,
        then: Option<Intent>,
        context: &Context,
    ) {
        match result {
            Ok(stamp) => {
                self.status = format!("Saved to {}", file_name(&path));
                let folder = path.parent().map(Path::to_owned);
                if let Some(document) = self.document.as_mut().filter(|document| document.number == number) {
                    let from = document.origin.folder().map(Path::to_owned);
                    document.history.rewrite(|plan| plan_in_folder(plan, from.as_deref(), folder.as_deref()));
                    document.was_saved(plan, path, stamp);
                    self.is_saved(context);
                }
                if let Some((folder, depth)) = folder.map(|folder| self.list.listed_for(folder)) {
                    self.list_folder(folder, depth);
                }
                // Asks again if there were changes since.
                if let Some(intent) = then {
                    self.request(intent);
                }
            }
            Err(SaveFailure::ChangedOnDisk) => {
                self.waiting = None;
                self.look_soon();
                self.ask(Question::replace(path, true, then));
            }
            Err(SaveFailure::Store(error)) => {
                // What was to follow a save is dropped if the save fails.
                self.waiting = None;
                self.is_not_saved(error);
            }
        }
    }
}
