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
        self.ask_for_file(Purpose::Open, folder, String::new());
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
        let begun =
            Begun { title: format!("Copy storey as {storey}"), plan: copied(&below, storey, keep), below: Some(below) };
        let opened = Opened { begun: Some(Box::new(begun)), ..Opened::untitled() };
        self.request(Intent::Show(Box::new(opened)));
    }

    /// Reads a plan and shows it once it is read; or shows the open plan that it is. Returns whether it is read.
    pub(crate) fn open(&mut self, origin: Origin) -> bool {
        let looked_at = if std::mem::take(&mut self.browses) { self.untouched() } else { None };
        if let Some(open) = self.open_of(&origin) {
            self.opening = None;
            self.show_open(open);
            self.note_shown();
            self.close_looked_at(looked_at);
            return false;
        }
        self.opening = Some(origin.clone());
        let kind = Kind::new("open a plan").newest_of("plan to show").if_broken(|session| session.opening = None);
        self.jobs.start(kind, move |_| {
            let opened = document::open(origin.clone());
            move |session: &mut Session, _: &_| {
                session.was_opened(&origin, opened);
                session.close_looked_at(looked_at);
            }
        });
        true
    }

    /// Reads several plans, one after the other, and shows each.
    pub(crate) fn open_several(&mut self, paths: Vec<PathBuf>) {
        for path in &paths {
            self.note_executed("open", vec![path.to_string_lossy().into_owned()]);
        }
        self.jobs.start(Kind::new("open plans"), move |_| {
            let origins = paths.into_iter().map(|path| Origin::File { path, storey: 0 });
            let read: Vec<_> = origins.map(|origin| (document::open(origin.clone()), origin)).collect();
            move |session: &mut Session, _: &_| {
                for (opened, origin) in read {
                    session.opening = Some(origin.clone());
                    session.was_opened(&origin, opened);
                }
            }
        });
    }

    /// The plan shown, where it has never been changed here.
    fn untouched(&self) -> Option<u64> {
        let untouched = self.document.as_ref().filter(|document| document.history.steps().len() == 1);
        untouched.map(|document| document.number)
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
            self.browses = true;
            self.open(origin);
        }
    }

    /// Does what the user wants, after asking if that would lose unsaved work.
    pub(crate) fn request(&mut self, intent: Intent) {
        self.commit_field();
        if self.question.is_some() || self.jobs.is_one_to_end() {
            // One thing at a time: while saving, there is no need to ask.
            self.waiting = Some(intent);
            return;
        }
        match &intent {
            // Another plan takes nothing away from this one.
            Intent::Show(_) | Intent::Recover(_) => {}
            Intent::Close(number) => {
                // What is asked about is seen.
                self.show_open(*number);
                if self.has_unsaved_changes() {
                    let title = self.document.as_ref().map(Document::title).unwrap_or_default();
                    self.ask(Question::unsaved(&title, intent));
                    return;
                }
            }
            Intent::Quit { agreed } => {
                if !self.can_quit(&agreed.clone()) {
                    return;
                }
            }
        }
        self.perform(intent);
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
            Intent::Show(opened) => self.show_read(*opened),
            Intent::Recover(path) => self.recovering = Some(path),
            Intent::Close(number) => self.close_shown(number),
            // The recording first, or it would be lost.
            Intent::Quit { .. } if self.is_recording => self.wishes.push(Wish::EndRecording(intent)),
            Intent::Quit { .. } => {
                self.remember_view();
                self.end_journals();
                self.quitting = true;
            }
        }
    }

    /// Shows a plan beside those that are open.
    pub(crate) fn show(&mut self, opened: Opened) {
        self.make_room();
        let folder = opened.listed.clone().map(|folder| (folder, Depth::All)).or_else(|| {
            let folder = opened.origin.folder().map(Path::to_owned)?;
            Some(self.list.listed_for(folder))
        });
        self.selection = Selection::default();
        self.fresh = None;
        self.field = None;
        self.wishes.push(Wish::ForgetPlan);
        self.look_as_remembered(&opened.origin);
        self.remember_opened(&opened.origin);
        self.status.clear();
        let notes = (!opened.notes.is_empty()).then(|| {
            let summary = crate::app::session::origin::notes_in_words(&opened.notes);
            let text = format!("Imported {}: {summary}", opened.origin.title());
            Message::new(Severity::Info, text, "").with(vec![Remedy::ShowNotes])
        });
        let below = opened.begun.as_ref().and_then(|begun| begun.below.clone());
        self.ghost = below.map(|below| Ghost::new(below, None, &self.schemes));
        self.documents += 1;
        self.document = Some(Document::new(self.documents, opened));
        self.set_as_remembered();
        if let Some(notes) = notes {
            self.add_message(notes);
        }
        if let Some((folder, depth)) = folder {
            self.list_folder(folder, depth);
        }
    }

    pub(super) fn list_folder(&mut self, folder: PathBuf, depth: Depth) {
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
        self.ask_for_file(Purpose::Save { then, answering }, folder, name);
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
        let Answer { purpose, path, was_shown, folder, name } = answer;
        let Some(path) = path else {
            if !was_shown {
                // The window asks by itself, now and from now on.
                if self.dialogs.show_nothing() {
                    let text = "Your system offers no file dialog; type the path instead";
                    let detail = "On Linux, dialogs come from the desktop's portal or from zenity.";
                    self.say_of_program(Severity::Info, text, detail);
                }
                self.type_path(purpose, folder, &name);
                return;
            }
            // Cancel means cancel: what was to follow is dropped.
            if let Purpose::Save { answering: Some(_), .. } = purpose {
                self.note_executed("answer", vec!["cancel".to_owned()]);
            }
            return;
        };
        self.remember_folder(&path);
        let run = |id: &'static str| Wish::Run(Call::new(id, [Value::Path(path.clone())]));
        let word = path.to_string_lossy().into_owned();
        match purpose {
            Purpose::Open => self.wishes.push(run("open")),
            Purpose::Workspace => self.wishes.push(run("open-workspace")),
            Purpose::Log => self.wishes.push(run("replay-log")),
            Purpose::Picture(PictureUse::Add) => self.wishes.push(run("picture")),
            Purpose::Picture(PictureUse::Relink) => self.wishes.push(run("relink-picture")),
            Purpose::Export | Purpose::Dataset | Purpose::Data { .. } | Purpose::Folder | Purpose::Chart => {
                self.chosen_file = Some(path);
            }
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

    /// Handles a save that ended, of the plan shown or of another open one.
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
                let saved_at = [path.clone()];
                let folder = path.parent().map(Path::to_owned);
                self.in_plan(number, |session| {
                    let Some(document) = &mut session.document else { return };
                    let from = document.origin.folder().map(Path::to_owned);
                    document.history.rewrite(|plan| plan_in_folder(plan, from.as_deref(), folder.as_deref()));
                    document.was_saved(plan, path, stamp);
                    session.is_saved(context);
                    session.remember_closes_rooms();
                });
                if let Some(origin) = self.origin_of_open(number).cloned() {
                    self.remember_opened(&origin);
                }
                if let Some((folder, depth)) = folder.map(|folder| self.list.listed_for(folder)) {
                    self.list_folder(folder, depth);
                }
                self.read_in_workspace_again(&saved_at);
                // Asks again if there were changes since.
                if let Some(intent) = then {
                    self.request(intent);
                }
            }
            Err(SaveFailure::ChangedOnDisk) => {
                self.waiting = None;
                self.show_open(number);
                self.look_soon();
                self.ask(Question::replace(path, true, then));
            }
            Err(SaveFailure::Store(error)) => {
                // What was to follow a save is dropped if the save fails.
                self.waiting = None;
                self.in_plan(number, |session| session.is_not_saved(error));
            }
        }
    }
}
