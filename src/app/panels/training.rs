//! Training models: what from and how, how far it is, and how the models did beside those before.
//! Above 500 lines: one dialog in three states, each of which is a form of its own.

use std::collections::BTreeSet;
use std::path::PathBuf;

use egui::{Color32, FontId, Id, Modal, Rect, Role, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::chart_view;
use super::dashboard::{Look, table_line};
use super::forms::{choose, line, pick, text};
use crate::app::look::theme;
use crate::app::look::widgets::{
    caption, colours, dialog_frame, hairline_in, main_button, progress_bar, right, section, strong, text_button, toggle,
};
use crate::app::session::at_hand::Source;
use crate::app::session::training::{Report, Wish};
use crate::app::state::{After, App, Dialog, Entry, dialogs};
use crate::app::value::{Call, Value};
use crate::base::file_name::component;
use crate::base::wording::{count, percent_done, sentence};
use crate::chart::{Chart, rooms};
use crate::classify::{Algorithm, Method, Scores};
use crate::dataset::folds::Grouping;
use crate::dataset::sets::{STANDARD, plans_of};
use crate::draw::Palette;
use crate::features::NeighbourLabels;
use crate::labels::Label;

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::TRAINING, make: |app, _| Box::new(Training::new(app)), is_of_plan: false };

const WIDTH: f32 = 720.0;

/// Width of the captions before the controls.
const NAMES: f32 = 96.0;

struct Training {
    /// The path of the data; empty for the open plans.
    data: String,
    wish: Wish,
    by: By,
    /// What the rooms at hand were read for.
    read_for: Option<String>,
    /// The name of the models, the folder they are kept in, and whether they become defaults.
    name: String,
    named_for: usize,
    folder: String,
    as_default: bool,
    /// The model whose figures are shown.
    picked: usize,
    /// What a file is being chosen for.
    choosing: Option<Choosing>,
    /// The number of the step that runs, when it was first seen here by the window's clock, and what was done then.
    since: (usize, f64, usize),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Choosing {
    Data,
    Folder,
}

/// What the folds do not split.
#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    Building,
    Room,
    Both,
    None,
}

/// How the dialog was closed, or what it does.
enum End {
    Leave,
    Cancel,
    Again,
    Do(Call),
}

impl Training {
    fn new(app: &App) -> Self {
        let data = match app.session.usual_source() {
            Source::Folder(path) | Source::Table(path) => {
                let shown = app.session.shown_path(&path);
                if shown.is_empty() { ".".to_owned() } else { shown }
            }
            Source::OpenPlans => String::new(),
        };
        let folder = app.session.kept_models_folder().map(|folder| app.session.shown_path(&folder));
        Self {
            data,
            wish: Wish::default(),
            by: By::Building,
            read_for: None,
            name: String::new(),
            named_for: 0,
            folder: folder.unwrap_or_default(),
            as_default: false,
            picked: 0,
            choosing: None,
            since: (0, 0.0, 0),
        }
    }
}

impl Dialog for Training {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() {
            return After::Close;
        }
        if let Some(path) = app.session.chosen_file.take() {
            match self.choosing.take() {
                Some(Choosing::Data) => self.data = app.session.shown_path(&path),
                Some(Choosing::Folder) => self.folder = app.session.shown_path(&path),
                None => {}
            }
        }
        let screen = ui.ctx().content_rect().size();
        let response = Modal::new(Id::unique("training")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
            ui.set_width(WIDTH.min(screen.x - 80.0));
            ui.label(strong("Train models", theme::TITLE));
            ui.add_space(4.0);
            if app.session.training.is_running() {
                self.progress(app, ui)
            } else if !app.session.training.reports.is_empty() {
                self.report(app, ui, screen.y - 120.0)
            } else {
                self.form(app, ui)
            }
        });
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then_some(End::Leave)) {
            None => After::Stay,
            Some(End::Leave) => After::Close,
            Some(End::Cancel) => {
                app.session.cancel_training();
                After::Stay
            }
            Some(End::Again) => {
                app.session.train_again();
                After::Stay
            }
            Some(End::Do(call)) => {
                app.act_on(call, ui.ctx());
                After::Stay
            }
        }
    }
}

impl Training {
    // What is to be trained.

    fn form(&mut self, app: &mut App, ui: &mut Ui) -> Option<End> {
        caption(
            ui,
            "A model learns the labels of rooms from plans that are labelled. It is tested on rooms that it did not learn \
             from, then it can predict the rooms of any plan.",
        );
        ui.add_space(8.0);
        let mut act = None;
        let mut is_typing = false;
        line(ui, NAMES, "Learn from", |ui| {
            ui.horizontal(|ui| {
                let width = (ui.available_width() - 160.0).max(80.0);
                is_typing = text(ui, "Learn from", &mut self.data, width, "The open plans").has_focus();
                if text_button(ui, "Folder…", false).clicked() {
                    self.choosing = Some(Choosing::Data);
                    app.session.ask_for_data(true);
                }
                if text_button(ui, "Table…", false).on_hover_text("A dataset that was exported (.csv)").clicked() {
                    self.choosing = Some(Choosing::Data);
                    app.session.ask_for_data(false);
                }
            });
        });
        // Not letter by letter while a path is typed.
        if self.read_for.as_ref() != Some(&self.data) && !(is_typing && self.read_for.is_some()) {
            self.read_for = Some(self.data.clone());
            let source = app.session.source_of(&self.data);
            app.session.read_rooms(source, true);
        }
        let source = app.session.source_of(&self.data);
        let at_hand = app.session.at_hand.read.clone().filter(|at_hand| at_hand.source == source);
        let is_read = self.read_for.as_ref() == Some(&self.data);
        line(ui, NAMES, "", |ui| {
            if app.session.at_hand.is_reading() {
                let (done, all) = app.session.rooms_progress().unwrap_or((0, 1));
                caption(ui, format!("Reading: {done} of {}", count(all, "file")));
            } else if let Some(at_hand) = &at_hand {
                let mut told = format!(
                    "{} of {} and {}",
                    count(at_hand.rows.len(), "labelled room"),
                    count(at_hand.plans, "plan"),
                    count(at_hand.buildings, "building")
                );
                if !at_hand.unreadable.is_empty() {
                    told.push_str(&format!("; {} could not be read", count(at_hand.unreadable.len(), "file")));
                }
                caption(ui, told);
            } else if let (Some(error), true) = (&app.session.at_hand.error, is_read) {
                ui.label(egui::RichText::new(error).size(theme::SMALL).color(colours(ui).error));
            }
        });
        let is_plans = at_hand.as_ref().is_none_or(|at_hand| !at_hand.collection.networks().is_empty());
        line(ui, NAMES, "For", |ui| {
            let typologies = at_hand.as_ref().map(|at_hand| at_hand.collection.typologies()).unwrap_or_default();
            let mut options: Vec<(Option<String>, String)> = vec![(None, "Each typology, and all together".to_owned())];
            if typologies.len() < 2 {
                options[0].1 = "All its rooms".to_owned();
            } else {
                let of = |name: &str, title: String| (Some(name.to_owned()), title);
                options.extend(typologies.iter().map(|it| of(it.as_str(), format!("{} plans", it.title()))));
                options.push(of(STANDARD, "Any kind of building".to_owned()));
            }
            if !options.iter().any(|(set, _)| *set == self.wish.set) {
                self.wish.set = None;
            }
            pick(ui, "For", ui.available_width(), &mut self.wish.set, &options);
        });
        line(ui, NAMES, "Method", |ui| {
            let each = Algorithm::ALL.map(|it| (Some(Method::Each(it)), it.learner().short_title().to_owned()));
            let mut options = each.to_vec();
            if is_plans {
                options.push((Some(Method::Joint), Method::Joint.short_title().to_owned()));
                options.push((None, "All of these, and the blend of them".to_owned()));
            } else {
                options.push((None, "All of these".to_owned()));
            }
            pick(ui, "Method", ui.available_width(), &mut self.wish.method, &options);
            if let Some(method) = self.wish.method {
                caption(ui, format!("Predicts by {}.", method.help()));
            } else {
                caption(ui, "Takes the longest; the blend is what predicts best.");
            }
        });
        line(ui, NAMES, "Test on", |ui| {
            let options = [
                (By::Building, "New buildings", "Folds never split a building: as the model meets new plans"),
                (
                    By::Room,
                    "New rooms",
                    "Folds deal rooms, as in the paper: other rooms of the same building are known",
                ),
                (By::Both, "Both", "One test of each kind"),
                (By::None, "Not at all", "Train without testing"),
            ];
            choose(ui, "Test on", &mut self.by, &options);
        });
        line(ui, NAMES, "Folds", |ui| {
            ui.add_enabled_ui(self.by != By::None, |ui| {
                let options: Vec<(usize, String)> = [3, 5, 10, 20].map(|folds| (folds, folds.to_string())).to_vec();
                pick(ui, "Folds", 90.0, &mut self.wish.folds, &options);
            });
        });
        line(ui, NAMES, "Neighbours", |ui| {
            ui.add_enabled_ui(is_plans && self.wish.method != Some(Method::Joint), |ui| {
                let mut mode = self.wish.neighbours.unwrap_or(NeighbourLabels::Predicted);
                let options = [
                    (NeighbourLabels::Predicted, "Predicted", "As they are in use: nobody has labelled the neighbours"),
                    (NeighbourLabels::Temporary, "First guess", "Labels guessed from size and shape alone"),
                    (NeighbourLabels::True, "True", "As in the paper: the neighbours' own labels are known"),
                ];
                if !is_plans {
                    mode = NeighbourLabels::True;
                }
                choose(ui, "Neighbours", &mut mode, &options);
                self.wish.neighbours = if is_plans { Some(mode) } else { None };
            });
        });
        ui.add_space(6.0);
        let rooms = at_hand.as_ref().map_or(0, |at_hand| at_hand.rows.len());
        if let Some(error) = &app.session.training.error {
            let text = sentence(&format!("{error}."));
            ui.add(egui::Label::new(egui::RichText::new(text).color(colours(ui).error)).wrap());
        } else if at_hand.is_some() && rooms == 0 && !app.session.at_hand.is_reading() {
            caption(ui, "No room of these plans has a label. Label some first.");
        }
        ui.horizontal(|ui| {
            right(ui, |ui| {
                if main_button(ui, "Train", rooms > 0 && is_read && !app.session.at_hand.is_reading()) {
                    let values = [Value::Text(self.data.clone()), Value::Text(self.words())];
                    act = Some(End::Do(Call::new("train", values)));
                }
                if text_button(ui, "Cancel", false).clicked() {
                    act = Some(End::Leave);
                }
            });
        });
        act
    }

    /// The form as the options of the command.
    fn words(&self) -> String {
        let (groupings, folds) = match self.by {
            By::Building => (vec![Grouping::Building], self.wish.folds),
            By::Room => (vec![Grouping::Room], self.wish.folds),
            By::Both => (Grouping::ALL.to_vec(), self.wish.folds),
            By::None => (vec![Grouping::Building], 0),
        };
        Wish { groupings, folds, ..self.wish.clone() }.words()
    }

    // While it runs.

    fn progress(&mut self, app: &App, ui: &mut Ui) -> Option<End> {
        let live = app.session.training.live();
        let now = ui.input(|input| input.time);
        // The dialog may have been opened when a part was done already.
        if self.since.0 != live.step_number {
            self.since = (live.step_number, now, live.done);
        }
        let step = sentence(&live.step);
        let steps =
            if live.steps > 1 { format!(" (step {} of {})", live.step_number, live.steps) } else { String::new() };
        let said = if step.is_empty() { "Getting ready".to_owned() } else { format!("{step}{steps}") };
        ui.horizontal(|ui| {
            ui.label(&said);
            right(ui, |ui| drop(caption(ui, percent_done(live.share()))));
        });
        progress_bar(ui, live.share(), &format!("{said}: {}", percent_done(live.share())));
        let elapsed = now - self.since.1;
        let seen = live.done.saturating_sub(self.since.2);
        let left = if seen > 0 && live.count > live.done && elapsed > 1.0 {
            let seconds = elapsed * (live.count - live.done) as f64 / seen as f64;
            format!("About {} left in this step", in_words(seconds))
        } else {
            " ".to_owned()
        };
        caption(ui, left);
        ui.add_space(4.0);
        let palette = app.session.palette(ui);
        let folds = rooms::folds(&live.folds, &plans_of(&live.set), live.fold_count);
        let rounds = rooms::rounds(&live.rounds);
        let charts: Vec<&Chart> = [&folds, &rounds].into_iter().filter(|chart| !chart.is_empty()).collect();
        if charts.is_empty() {
            let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 250.0), Sense::hover());
            ui.painter().rect_filled(rect, theme::RADIUS, colours(ui).field);
            let text = if live.fold_count > 0 {
                "The accuracy of each fold appears here once it is tested."
            } else {
                "Nothing is tested, so there are no curves."
            };
            let font = FontId::proportional(theme::BODY);
            ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, colours(ui).text_weak);
        } else {
            ui.columns(charts.len(), |columns| {
                for (ui, chart) in columns.iter_mut().zip(&charts) {
                    chart_view::show(ui, palette, chart, 250.0, &BTreeSet::new(), None);
                }
            });
        }
        ui.add_space(10.0);
        let mut act = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                if text_button(ui, "Continue in the background", true).clicked() {
                    act = Some(End::Leave);
                }
                if text_button(ui, "Stop", false).on_hover_text("Give up the training; nothing is kept").clicked() {
                    act = Some(End::Cancel);
                }
            });
        });
        act
    }

    // What came of it.

    fn report(&mut self, app: &mut App, ui: &mut Ui, height: f32) -> Option<End> {
        let mut act = None;
        let reports = app.session.training.reports.clone();
        if self.named_for != reports.first().map_or(0, |report| std::sync::Arc::as_ptr(&report.bytes) as usize) {
            self.named_for = reports.first().map_or(0, |report| std::sync::Arc::as_ptr(&report.bytes) as usize);
            self.name = app.session.offered_model_name();
            self.picked = reports.len() - 1;
            // Where no model comes with the program, the new one is the only one.
            self.as_default = app.session.chosen_defaults().iter().all(|(set, _)| is_without_models(app, set));
        }
        self.picked = self.picked.min(reports.len() - 1);
        let palette = app.session.palette(ui);
        let foot = 196.0;
        ScrollArea::vertical().id_salt("report").max_height((height - foot).max(160.0)).show(ui, |ui| {
            caption(ui, format!("Learned from {}. Choose a line to see how each label does.", app.session.training.of));
            ui.add_space(4.0);
            models(ui, &reports, &mut self.picked);
            let report = &reports[self.picked];
            if let Some(before) = &report.before {
                let on = if before.scores.is_empty() { ", tested on the rooms that it was made from" } else { "" };
                caption(ui, format!("Before: {}{on}.", before.name));
            }
            ui.add_space(8.0);
            match report.scores.last() {
                None => drop(caption(ui, "This model was not tested.")),
                Some((by, scores)) => {
                    let before = report
                        .before
                        .as_ref()
                        .and_then(|before| before.scores.iter().find(|(of, _)| of == by).map(|(_, scores)| scores));
                    ui.spacing_mut().item_spacing.x = 28.0;
                    ui.columns(2, |columns| {
                        columns.iter_mut().for_each(|column| column.spacing_mut().item_spacing.x = 8.0);
                        labels(&mut columns[0], palette, scores, before);
                        confusion(&mut columns[1], palette, scores);
                    });
                }
            }
            for remark in &app.session.training.remarks {
                caption(ui, sentence(remark));
            }
        });
        ui.add_space(6.0);
        hairline_in(ui);
        ui.add_space(8.0);
        let wrong = component(&self.name).err().map(|error| format!("The name cannot be a file's: {error}."));
        line(ui, NAMES, "Name", |ui| {
            let response = text(ui, "Name", &mut self.name, ui.available_width(), "");
            if response.lost_focus() && wrong.is_none() && !self.name.is_empty() {
                app.session.name_trained(&self.name.clone());
            }
        });
        line(ui, NAMES, "Keep in", |ui| {
            ui.horizontal(|ui| {
                text(ui, "Keep in", &mut self.folder, (ui.available_width() - 87.0).max(80.0), "A folder");
                if text_button(ui, "Choose…", false).clicked() {
                    self.choosing = Some(Choosing::Folder);
                    app.session.ask_for_folder();
                }
            });
        });
        line(ui, NAMES, "", |ui| {
            let sets: Vec<String> = app.session.chosen_defaults().into_iter().map(|(set, _)| plans_of(&set)).collect();
            let it = if reports.len() > 1 { "them" } else { "it" };
            let title = format!("Predict {} with {it} from now on", and_words(&sets));
            if toggle(ui, &title, self.as_default).clicked() {
                self.as_default = !self.as_default;
            }
        });
        match &wrong {
            Some(wrong) => drop(ui.label(egui::RichText::new(wrong).size(theme::SMALL).color(colours(ui).error))),
            None => {
                let names = app.session.names_of_trained(&self.name);
                let first = names.first().cloned().unwrap_or_default();
                let several = if names.len() > 1 { format!(" and {} more", names.len() - 1) } else { String::new() };
                caption(
                    ui,
                    format!(
                        "Until you close Enfilade, {first}{several} can be chosen under Predict > Models. Kept, it stays."
                    ),
                );
            }
        }
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            right(ui, |ui| {
                let folder = app.session.typed_path(&self.folder);
                let can = wrong.is_none() && !self.folder.trim().is_empty();
                if main_button(ui, "Keep", can) {
                    act = Some(End::Do(self.keep(folder)));
                }
                if text_button(ui, "Train again", false).clicked() {
                    act = Some(End::Again);
                }
                if text_button(ui, "Close", false).clicked() {
                    act = Some(End::Leave);
                }
            });
        });
        act
    }

    fn keep(&self, folder: PathBuf) -> Call {
        let default = if self.as_default { "on" } else { "off" };
        let values = [Value::Text(self.name.clone()), Value::Path(folder), Value::Switch(default == "on")];
        Call::new("keep-models", values)
    }
}

fn is_without_models(app: &App, set: &str) -> bool {
    app.session.models.find(set, Method::Blend).is_err() && app.session.models.default_of(set).is_none()
}

/// Several things: 'a, b and c'.
fn and_words(things: &[String]) -> String {
    match things {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A time, as people say it.
fn in_words(seconds: f64) -> String {
    let seconds = seconds.ceil().max(1.0);
    if seconds < 100.0 { format!("{seconds} s") } else { format!("{} min", (seconds / 60.0).ceil()) }
}

/// The models that were trained, beside those before; a click picks one.
fn models(ui: &mut Ui, reports: &[Report], picked: &mut usize) {
    let heads = ["Model", "New buildings", "New rooms", "Log loss", "Before"].map(str::to_owned);
    table_line(ui, None, &heads, Look::Head);
    hairline_in(ui);
    for (index, report) in reports.iter().enumerate() {
        let of = |by: Grouping| report.scores.iter().find(|(of, _)| *of == by).map(|(_, scores)| scores);
        let accuracy = |by: Grouping| {
            of(by).map_or("–".to_owned(), |scores| {
                format!("{:.1} ± {:.1} %", 100.0 * scores.accuracy, 100.0 * scores.accuracy_deviation)
            })
        };
        let main = report.scores.last();
        let log_loss = main.map_or("–".to_owned(), |(_, scores)| format!("{:.2}", scores.log_loss));
        let before = main.zip(report.before.as_ref()).and_then(|((by, _), before)| {
            let (_, accuracy, _) = before.figures.iter().find(|(of, ..)| of == by.name())?;
            Some(format!("{:.1} %", 100.0 * accuracy))
        });
        let name = format!("{} – {}", sentence(&plans_of(&report.set)), report.method.title());
        let cells = [
            name.clone(),
            accuracy(Grouping::Building),
            accuracy(Grouping::Room),
            log_loss,
            before.unwrap_or_else(|| "–".to_owned()),
        ];
        let start = ui.cursor().min;
        let rect = Rect::from_min_size(start, vec2(ui.available_width(), 24.0));
        let response = ui.interact(rect, ui.scope_id().with(("report", index)), Sense::click());
        let ground = if index == *picked {
            colours(ui).accent_soft
        } else if response.hovered() {
            colours(ui).hover
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(rect, theme::RADIUS, ground);
        crate::app::look::widgets::focus_ring(ui, rect, &response);
        response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, index == *picked, &name));
        table_line(ui, None, &cells, Look::Ours);
        let hover = report.before.as_ref().map(|before| format!("{name}\nBefore: {}", before.name));
        if response.on_hover_text(hover.unwrap_or(name)).clicked() {
            *picked = index;
        }
    }
}

/// How well each label is told, with the recall before.
fn labels(ui: &mut Ui, palette: &Palette, scores: &Scores, before: Option<&Scores>) {
    section(ui, "Each label");
    ui.add_space(2.0);
    let heads = ["", "Found", "Right", "F1"].map(str::to_owned);
    table_line(ui, None, &heads, Look::Head);
    for label in Label::ALL {
        let rates = scores.confusion.label_rates(label);
        let percent = |share: f64| if rates.rooms > 0 { format!("{:.0} %", 100.0 * share) } else { "–".to_owned() };
        let change = before.map(|before| before.confusion.label_rates(label)).filter(|of| of.rooms > 0).map(|of| {
            let points = 100.0 * (rates.recall - of.recall);
            if points.abs() < 0.5 { String::new() } else { format!(" ({points:+.0})") }
        });
        let found = percent(rates.recall) + &change.unwrap_or_default();
        let cells = [sentence(label.name()), found, percent(rates.precision), format!("{:.2}", rates.f1)];
        table_line(ui, Some(theme::colour(palette.label(label))), &cells, Look::Ours);
    }
    let told =
        "Found: of the rooms with the label, those that got it. Right: of the rooms that got it, those that have it.";
    // The columns justify text, which pulls words apart.
    ui.vertical(|ui| caption(ui, told));
}

/// What rooms of each label were taken for.
fn confusion(ui: &mut Ui, palette: &Palette, scores: &Scores) {
    section(ui, "Rooms of each label, and what they were taken for");
    ui.add_space(2.0);
    let width = ui.available_width();
    let (name, height) = (96.0f32.min(width * 0.36), 24.0);
    let each = (width - name) / 5.0;
    let (head, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    let colours = colours(ui);
    let small = FontId::new(theme::SMALL, theme::semibold());
    let middle = egui::Align2::CENTER_CENTER;
    for (column, label) in Label::ALL.into_iter().enumerate() {
        let at = pos2(head.left() + name + each * (column as f32 + 0.5), head.center().y);
        ui.painter().text(at, middle, label.letter(), small.clone(), colours.text_weak);
    }
    let shares = scores.confusion.row_shares();
    for (row, label) in Label::ALL.into_iter().enumerate() {
        let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        let counts = scores.confusion.0[row];
        let told: Vec<String> =
            Label::ALL.into_iter().zip(counts).map(|(of, count)| format!("{count} {}", of.name())).collect();
        response.widget_info(|| {
            WidgetInfo::labeled(Role::Label, true, format!("{} taken for: {}", sentence(label.name()), told.join(", ")))
        });
        let font = FontId::proportional(theme::BODY);
        let at = pos2(rect.left(), rect.center().y);
        ui.painter().text(at, egui::Align2::LEFT_CENTER, sentence(label.name()), font.clone(), colours.text);
        for (column, (count, share)) in counts.into_iter().zip(shares[row]).enumerate() {
            let cell =
                Rect::from_min_size(pos2(rect.left() + name + each * column as f32, rect.top()), vec2(each, height));
            let ink = if row == column { palette.label(label) } else { palette.label(Label::BigRoom) };
            let strength = if count == 0 { 0.0 } else { (0.12 + 0.88 * share) as f32 };
            ui.painter().rect_filled(cell.shrink(1.0), 3.0, theme::colour(ink).gamma_multiply(strength));
            let colour = if count == 0 { colours.text_weak } else { colours.text };
            ui.painter().text(cell.center(), middle, count.to_string(), font.clone(), colour);
        }
    }
}
