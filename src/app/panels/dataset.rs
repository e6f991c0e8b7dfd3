//! Exporting the dataset of the open folder's plans: where it goes, how far it is, and giving it up.

use std::path::PathBuf;

use egui::{Align2, Id, Modal, TextEdit, Ui};

use super::export::told;
use crate::app::look::{
    theme,
    widgets::{caption, dialog_frame, main_button, progress_bar, right, section, strong, text_button},
};
use crate::app::state::{After, App, Dialog, Entry, dialogs};
use crate::app::value::{Call, Value};
use crate::base::wording::count;

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::DATASET, make: |app, _| Box::new(Dataset::new(app)), is_of_plan: false };

const WIDTH: f32 = 520.0;

struct Dataset {
    path: String,
    /// Whether it has been begun from here: the dialog then stays until it is done.
    is_begun: bool,
}

impl Dataset {
    fn new(app: &App) -> Self {
        let path = app.session.shown_path(&app.session.dataset_path());
        Self { path, is_begun: app.session.is_making_dataset() }
    }

    fn target(&self, app: &App) -> Option<PathBuf> {
        app.session.typed_file(&self.path)
    }
}

/// How the dialog was closed.
enum End {
    /// Without doing anything; what runs goes on.
    Leave,
    GiveUp,
    Do(Call),
}

impl Dialog for Dataset {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() || (self.is_begun && !app.session.is_making_dataset()) {
            return After::Close;
        }
        if let Some(path) = app.session.chosen_file.take() {
            self.path = app.session.shown_path(&path);
        }
        let response = Modal::new(Id::unique("dataset")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(ui.ctx().content_rect().width() - 80.0));
            ui.label(strong("Export dataset", theme::TITLE));
            ui.add_space(4.0);
            if app.session.is_making_dataset() { progress(app, ui) } else { self.form(app, ui) }
        });
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then_some(End::Leave)) {
            None => After::Stay,
            Some(End::Leave) => After::Close,
            Some(End::GiveUp) => {
                app.session.cancel_dataset();
                After::Close
            }
            Some(End::Do(call)) => {
                app.act_on(call, ui.ctx());
                self.is_begun = true;
                After::Stay
            }
        }
    }
}

impl Dataset {
    fn form(&mut self, app: &mut App, ui: &mut Ui) -> Option<End> {
        let (folder, plans) = app
            .session
            .dataset_source()
            .map_or_else(|| (String::new(), 0), |(folder, files)| (app.session.shown_path(folder), files.len()));
        let folder = if folder.is_empty() { " in this folder".to_owned() } else { format!(" in {folder}") };
        caption(
            ui,
            format!(
                "One row for each labelled room of the {}{folder}: where it is from, its features and its label. \
                 Plans are read as they are saved. A room that is in two files counts once. Beside the table go \
                 the ways between the rooms, what the columns mean, and a manifest of how it was made.",
                if plans == 1 { "plan".to_owned() } else { count(plans, "plan") }
            ),
        );
        ui.add_space(10.0);
        section(ui, "File");
        ui.add_space(2.0);
        ui.horizontal(|ui| {
            let edit = TextEdit::singleline(&mut self.path)
                .id(Id::unique("dataset path"))
                .desired_width(ui.available_width() - 100.0)
                .align(Align2::LEFT_CENTER);
            ui.add(edit).accessible_name("File");
            if text_button(ui, "Choose…", false).clicked() {
                let path = self.target(app).unwrap_or_else(|| app.session.dataset_path());
                app.session.ask_where_to_put_dataset(&path);
            }
        });
        let target = self.target(app);
        let exists = target.as_ref().is_some_and(|path| path.is_file());
        let is_missing_folder = target.as_ref().and_then(|path| path.parent()).is_some_and(|folder| !folder.is_dir());
        let said = match &target {
            None => Err("Give the file a name.".to_owned()),
            Some(_) if is_missing_folder => Err("This folder does not exist.".to_owned()),
            Some(_) if plans == 0 => Err("Open a plan of a folder first.".to_owned()),
            Some(path) if exists => {
                let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
                Ok(format!("{name} exists and will be overwritten."))
            }
            Some(_) if app.session.has_unsaved_changes() => {
                Ok("Unsaved changes of the open plan are not included.".to_owned())
            }
            Some(_) => Ok(String::new()),
        };
        told(ui, &said);
        let mut act = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                let title = if exists { "Replace" } else { "Export" };
                let is_done = main_button(ui, title, said.is_ok());
                if let Some(path) = target.filter(|_| is_done) {
                    act = Some(End::Do(Call::new("export-dataset", [Value::Path(path)])));
                }
                if text_button(ui, "Cancel", false).clicked() {
                    act = Some(End::Leave);
                }
            });
        });
        act
    }
}

fn progress(app: &App, ui: &mut Ui) -> Option<End> {
    let mut act = None;
    let (done, all) = app.session.dataset_progress().unwrap_or((0, 1));
    let said = format!("{done} of {} read", count(all, "file"));
    caption(ui, said.clone());
    ui.add_space(4.0);
    progress_bar(ui, done as f64 / all.max(1) as f64, &said);
    ui.add_space(12.0);
    ui.horizontal(|ui| {
        right(ui, |ui| {
            if text_button(ui, "Continue in the background", true).clicked() {
                act = Some(End::Leave);
            }
            if text_button(ui, "Stop", false).clicked() {
                act = Some(End::GiveUp);
            }
        });
    });
    act
}
