//! The workspace: all plans of a folder as a list or as pictures, and all their rooms as a table; searched, filtered,
//! sorted, opened, and changed together.

mod cells;
mod change;
mod grid;
mod table;
mod thumbnails;

use std::collections::BTreeMap;

use egui::{Align2, ComboBox, Id, Key, Modal, Modifiers, TextEdit, Ui, vec2};

use crate::app::commands;
use crate::app::look::icons::Icon;
use crate::app::look::theme;
use crate::app::look::widgets::{
    Segment, caption, colours, dialog_frame, focus_ring, hairline_in, icon_button, progress_bar, right, segmented,
    strong, text_button, toggle,
};
use crate::app::session::workspace::OpenWorkspace;
use crate::app::session::workspace::shows::Shows;
use crate::app::state::{After, App, Dialog, Entry, dialogs};
use crate::base::wording::{count, sentence, thousands};
use crate::labels::Typology;
use crate::workspace::{PlanKey, PlanRow, Totals};
use thumbnails::Thumbnails;

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::WORKSPACE, make: |_, _| Box::new(Table::default()), is_of_plan: false };

/// What is kept of the window around the dialog.
const AROUND: f32 = 24.0;

/// The dialog, while it is open.
#[derive(Default)]
struct Table {
    is_shown: bool,
    thumbnails: Thumbnails,
    change: change::Form,
    /// The row that has to be scrolled to.
    follows_cursor: bool,
    /// Counts over the folder, for a revision of it.
    summary: Summary,
    /// The columns of the grid and the rows on the screen, in the last frame.
    columns: usize,
    rows_seen: usize,
}

/// Counts over a folder: made once a revision.
#[derive(Default)]
struct Summary {
    of: Option<u64>,
    totals: Totals,
    typologies: BTreeMap<Option<Typology>, usize>,
}

/// What a person asked for.
enum Act {
    Close,
    Open(usize),
    Run(&'static str),
}

impl Dialog for Table {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() {
            return After::Close;
        }
        app.session.find_workspace_rows();
        let screen = ui.ctx().content_rect();
        let response =
            Modal::new(Id::unique("workspace")).frame(dialog_frame(ui).inner_margin(16)).show(ui.ctx(), |ui| {
                let size = vec2(screen.width() - 2.0 * AROUND - 32.0, screen.height() - 2.0 * AROUND - 32.0);
                ui.set_width(size.x.max(0.0));
                ui.set_height(size.y.max(0.0));
                ui.spacing_mut().item_spacing.y = 6.0;
                self.contents(app, ui)
            });
        let is_closed = response.should_close();
        let act = response.inner.or(is_closed.then_some(Act::Close));
        match act {
            None => After::Stay,
            Some(Act::Close) => close(app, ui),
            Some(Act::Run(id)) => {
                app.act(id, &[], ui.ctx());
                After::Stay
            }
            Some(Act::Open(row)) => {
                if open(app, row) {
                    close(app, ui)
                } else {
                    After::Stay
                }
            }
        }
    }
}

/// Closes the table by its command, so that a recording tells of it.
fn close(app: &mut App, ui: &Ui) -> After {
    app.act("workspace", &["off"], ui.ctx());
    After::Close
}

/// Opens the plan of a row, and selects the room of one. Returns whether there is one that can be opened.
fn open(app: &mut App, row: usize) -> bool {
    let Some(OpenWorkspace { view, .. }) = &app.session.workspace else { return false };
    let of = view.rows.of.clone();
    let found: Option<(PlanKey, Option<_>)> = if view.shows == Shows::Rooms {
        view.rows.rooms.get(row).and_then(|row| of.room_key(*row)).map(|key| (key.plan, Some(key.room)))
    } else {
        // Of a broken file the window says what is wrong with it.
        view.rows.plans.get(row).and_then(|row| of.plan_key(*row)).map(|key| (key, None))
    };
    let Some((plan, room)) = found else { return false };
    app.session.open_of_workspace(&plan, room);
    true
}

impl Table {
    fn contents(&mut self, app: &mut App, ui: &mut Ui) -> Option<Act> {
        let mut act = None;
        if app.session.workspace.is_none() {
            return empty(ui);
        }
        if let Some(workspace) = app.session.workspace.as_ref().filter(|it| self.summary.of != Some(it.revision)) {
            let (totals, typologies) = (workspace.now.totals(), workspace.now.typologies());
            self.summary = Summary { of: Some(workspace.revision), totals, typologies };
        }
        let keys = self.take_keys(app, ui);
        act = keys.or(act);
        act = heading(app, ui, &self.summary.totals).or(act);
        self.search(app, ui);
        hairline_in(ui);
        let foot = 78.0;
        let height = (ui.available_height() - foot).max(60.0);
        let shows = app.session.workspace.as_ref().map(|workspace| workspace.view.shows).unwrap_or_default();
        let shown = ui.allocate_ui(vec2(ui.available_width(), height), |ui| {
            ui.set_min_height(height);
            ui.spacing_mut().item_spacing.y = 0.0;
            match shows {
                Shows::Grid => grid::show(self, app, ui),
                Shows::Plans | Shows::Rooms => table::show(self, app, ui),
            }
        });
        act = shown.inner.or(act);
        hairline_in(ui);
        act = self.foot(app, ui).or(act);
        self.is_shown = true;
        self.follows_cursor = false;
        act
    }

    /// The keys that move over the rows, wherever the keyboard is but in a menu.
    fn take_keys(&mut self, app: &mut App, ui: &mut Ui) -> Option<Act> {
        if egui::Popup::is_any_open(ui.ctx()) {
            return None;
        }
        let focused = ui.memory(|memory| memory.focused());
        let is_searching = focused == Some(search_id());
        // A button, or a field below, has its own keys.
        if focused.is_some() && !is_searching {
            return None;
        }
        let OpenWorkspace { view, .. } = app.session.workspace.as_mut()?;
        let length = view.len() as isize;
        let is_grid = view.shows == Shows::Grid;
        let line = if is_grid { self.columns.max(1) as isize } else { 1 };
        let page = (self.rows_seen.max(2) as isize - 1) * line;
        let mut steps =
            vec![(Key::ArrowUp, -line), (Key::ArrowDown, line), (Key::PageUp, -page), (Key::PageDown, page)];
        if !is_searching || view.query.text.is_empty() {
            steps.extend([(Key::Home, -length), (Key::End, length)]);
            if is_grid {
                steps.extend([(Key::ArrowLeft, -1), (Key::ArrowRight, 1)]);
            }
        }
        for (key, step) in steps {
            for extends in [false, true] {
                let modifiers = if extends { Modifiers::SHIFT } else { Modifiers::NONE };
                let times = ui.input_mut(|input| input.count_and_consume_key(modifiers, key)) as isize;
                if times > 0 && length > 0 {
                    let next = (view.cursor as isize + times * step).clamp(0, length - 1) as usize;
                    view.choose(next, false, extends);
                    self.follows_cursor = true;
                }
            }
        }
        if !is_searching && ui.input_mut(|input| input.consume_key(Modifiers::COMMAND, Key::A)) {
            view.choose_all();
        }
        let enters = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        (enters && length > 0).then_some(Act::Open(view.cursor))
    }

    /// The field to search in, and what is left out.
    fn search(&mut self, app: &mut App, ui: &mut Ui) {
        let Some(OpenWorkspace { view, .. }) = app.session.workspace.as_mut() else { return };
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 560.0).clamp(150.0, 420.0);
            let hint = "Search by function, name or label";
            let field = TextEdit::singleline(&mut view.query.text)
                .id(search_id())
                .hint_text(hint)
                .desired_width(width)
                .align(Align2::LEFT_CENTER);
            let response = ui.add(field).accessible_name(hint);
            if !self.is_shown {
                response.request_focus();
            }
            let typologies = &self.summary.typologies;
            let all: usize = typologies.values().sum();
            let title = |typology: &Option<Typology>, number: usize| {
                let name = typology.as_ref().map_or_else(|| "No typology".to_owned(), Typology::title);
                format!("{name} ({number})")
            };
            let chosen = match &view.query.typology {
                None => "All typologies".to_owned(),
                Some(typology) => title(typology, typologies.get(typology).copied().unwrap_or(0)),
            };
            let list = ComboBox::from_id_salt("typology").width(150.0).selected_text(chosen.clone());
            let shown = list.show_ui(ui, |ui| {
                if ui.selectable_label(view.query.typology.is_none(), format!("All typologies ({all})")).clicked() {
                    view.query.typology = None;
                }
                for (typology, number) in typologies {
                    let is_on = view.query.typology.as_ref() == Some(typology);
                    if ui.selectable_label(is_on, title(typology, *number)).clicked() {
                        view.query.typology = Some(typology.clone());
                    }
                }
            });
            focus_ring(ui, shown.response.rect, &shown.response);
            shown
                .response
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, format!("Typology: {chosen}")));
            let switches: [(&str, &str, &mut bool); 3] = [
                ("Problems", "Plans with errors or warnings, or that cannot be read", &mut view.query.has_problems),
                ("Without label", "Plans with rooms that want a label, and such rooms", &mut view.query.is_unlabelled),
                (
                    "Disagreeing",
                    "Plans with rooms whose label is not the predicted one, and such rooms",
                    &mut view.query.disagrees,
                ),
            ];
            for (text, help, is_on) in switches {
                if toggle(ui, text, *is_on).on_hover_text(help).clicked() {
                    *is_on = !*is_on;
                }
            }
            if let Some(building) = view.query.building.clone()
                && toggle(ui, &building, true).on_hover_text("Plans of this building; click to show all").clicked()
            {
                view.query.building = None;
            }
        });
    }

    /// What is selected, and what can be done with it.
    fn foot(&mut self, app: &mut App, ui: &mut Ui) -> Option<Act> {
        let mut act = None;
        let is_writing = app.session.changing_shown().is_some();
        let workspace = app.session.workspace.as_mut()?;
        let is_listing = workspace.now.files().is_empty() && workspace.indexing.is_some();
        let is_looking = is_listing || workspace.view.is_behind(workspace.revision);
        let thing = if workspace.view.shows == Shows::Rooms { "room" } else { "plan" };
        ui.horizontal(|ui| {
            let (length, selected) = (workspace.view.len(), &workspace.view.selected);
            let said = if length == 0 && is_looking {
                String::new()
            } else if selected.is_empty() {
                format!("{} shown", counted(length, thing))
            } else {
                format!("{} of {} selected", selected.counted(), thousands(length as u64))
            };
            caption(ui, said);
            right(ui, |ui| {
                if ui.add_enabled_ui(length > 0, |ui| text_button(ui, "Open", true)).inner.clicked() {
                    act = Some(Act::Open(workspace.view.cursor));
                }
                let all = ui.add_enabled_ui(length > 0, |ui| text_button(ui, "Select all", false)).inner;
                if all.on_hover_text("Select all that is shown (Ctrl+A)").clicked() {
                    workspace.view.choose_all();
                }
                if let Some(changed) = &workspace.changed {
                    let files = count(changed.files.len(), "file");
                    let help = format!("Put {files} back as before, where nobody has changed them since");
                    let undo = ui.add_enabled_ui(!is_writing, |ui| text_button(ui, "Undo change", false)).inner;
                    if undo.on_hover_text(help).clicked() {
                        act = Some(Act::Run("undo-workspace-change"));
                    }
                }
            });
        });
        self.change.show(app, ui);
        act
    }
}

fn search_id() -> Id {
    Id::unique("search the workspace")
}

/// '1,847 rooms'.
fn counted(number: usize, thing: &str) -> String {
    format!("{} {thing}{}", thousands(number as u64), if number == 1 { "" } else { "s" })
}

/// The folder, what is in it, and how it is shown.
fn heading(app: &mut App, ui: &mut Ui, totals: &Totals) -> Option<Act> {
    let mut act = None;
    let folder = app.session.workspace.as_ref().map(|workspace| workspace.now.folder().to_owned())?;
    let shown = app.session.shown_path(&folder);
    let name = folder.file_name().map_or_else(|| shown.clone(), |name| name.to_string_lossy().into_owned());
    let indexing = app.session.indexing_shown();
    let is_indexing = indexing.is_some();
    let running = app.session.changing_shown().or(indexing);
    let OpenWorkspace { view, .. } = app.session.workspace.as_mut()?;
    ui.horizontal(|ui| {
        ui.label(strong(name, theme::TITLE)).on_hover_text(shown);
        right(ui, |ui| {
            if icon_button(ui, Icon::Close, "Close", None).clicked() {
                act = Some(Act::Close);
            }
            if let Some(command) = commands::find("open-workspace")
                && icon_button(ui, Icon::Folder, command.title, None).on_hover_text(command.help).clicked()
            {
                act = Some(Act::Run(command.id));
            }
            if let Some(command) = commands::find("read-workspace-again")
                && icon_button(ui, Icon::Redo, command.title, None).on_hover_text(command.help).clicked()
            {
                act = Some(Act::Run(command.id));
            }
            ui.allocate_ui_with_layout(vec2(260.0, 28.0), egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let ways = [
                    ("Plans", Shows::Plans, "A row a plan"),
                    ("Pictures", Shows::Grid, "A picture a plan"),
                    ("Rooms", Shows::Rooms, "All rooms of all plans"),
                ];
                let segments = ways.map(|(text, shows, help)| Segment {
                    text,
                    name: text,
                    help,
                    is_on: view.shows == shows,
                    colour: None,
                });
                if let Some(at) = segmented(ui, &segments) {
                    view.show(ways[at].1);
                }
            });
        });
    });
    ui.horizontal(|ui| {
        caption(ui, said_of(totals, is_indexing));
        if let Some((share, said)) = running {
            right(ui, |ui| {
                if share > 0.0 {
                    ui.allocate_ui(vec2(120.0, 20.0), |ui| progress_bar(ui, share, &said));
                }
                caption(ui, said);
            });
        }
    });
    act
}

/// '56 plans, 1,847 rooms, 87 % labelled; 2 files cannot be read'.
fn said_of(totals: &Totals, is_indexing: bool) -> String {
    let Totals { plans, rooms, to_label, labelled, pending, broken } = *totals;
    if is_indexing && plans + broken == 0 {
        // Nothing is known of them yet.
        return if pending > 0 { counted(pending, "file") } else { String::new() };
    }
    let mut said = format!("{}, {}", counted(plans, "plan"), counted(rooms, "room"));
    if to_label > 0 {
        said.push_str(&format!(", {} labelled", cells::percent(labelled, to_label)));
    }
    if pending > 0 {
        said.push_str(&format!("; {} not read yet", counted(pending, "file")));
    }
    if broken > 0 {
        said.push_str(&format!("; {} cannot be read", counted(broken, "file")));
    }
    said
}

/// Without a folder.
fn empty(ui: &mut Ui) -> Option<Act> {
    let mut act = None;
    ui.horizontal(|ui| {
        ui.label(strong("Workspace", theme::TITLE));
        right(ui, |ui| {
            if icon_button(ui, Icon::Close, "Close", None).clicked() {
                act = Some(Act::Close);
            }
        });
    });
    ui.vertical_centered(|ui| {
        ui.add_space((ui.available_height() * 0.32).max(20.0));
        ui.label(strong("No folder of plans is open", theme::TITLE));
        ui.add_space(4.0);
        caption(
            ui,
            "A folder of plans is a dataset: see all its plans and rooms at once, search and sort them, and change many \
             together.",
        );
        ui.add_space(12.0);
        if text_button(ui, "Open a folder of plans…", true).clicked() {
            act = Some(Act::Run("open-workspace"));
        }
    });
    act
}

/// What is said where no row is shown.
fn nothing(app: &App, ui: &mut Ui) {
    let Some(OpenWorkspace { now, revision, view, indexing, .. }) = &app.session.workspace else { return };
    let is_listing = now.files().is_empty() && indexing.is_some();
    let text = if is_listing || view.is_behind(*revision) {
        "Looking…"
    } else if now.files().is_empty() {
        "There are no plans in this folder"
    } else {
        "Nothing here fits the search"
    };
    ui.vertical_centered(|ui| {
        ui.add_space((ui.available_height() * 0.35).max(10.0));
        let colour = colours(ui).text_weak;
        ui.label(strong(text, theme::BODY).color(colour));
        if text.starts_with("There are") {
            caption(ui, sentence(&crate::formats::known_formats()));
        }
    });
}

/// A plan's row in a sentence, for screen readers.
fn plan_in_words(app: &App, row: PlanRow) -> (String, String) {
    let Some(OpenWorkspace { view, .. }) = &app.session.workspace else { return Default::default() };
    let Some((file, plan)) = view.rows.of.plan(row) else { return Default::default() };
    let Some(plan) = plan else {
        let said = match &file.content {
            crate::workspace::Content::Broken(what) => format!("cannot be read: {what}"),
            _ => "not read yet".to_owned(),
        };
        return (file.name().to_owned(), said);
    };
    let mut parts = Vec::new();
    parts.extend(plan.typology.as_ref().map(ToString::to_string));
    parts.extend([&*plan.building, &*plan.storey].into_iter().filter(|it| !it.is_empty()).map(str::to_owned));
    parts.push(count(plan.rooms.len(), "room"));
    parts.push(format!("{} labelled", cells::percent(plan.labelled, plan.to_label)));
    parts.push(cells::problems_in_words(&plan.problems));
    let (same, all) = plan.agreement();
    if all > 0 {
        parts.push(format!("{} as predicted", cells::percent(same, all)));
    }
    (file.title_of(plan).to_owned(), parts.join(", "))
}
