//! The dashboard: what the labelled rooms at hand are like, how well classifiers tell them, and what changed.
//! Above 500 lines: one dialog of four pages, each small, that share their charts.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::{FontId, Rect, Role, ScrollArea, Sense, Ui, WidgetInfo, vec2};

use super::chart_view;
use super::forms;
use super::forms::{choose, pick};
use crate::app::look::theme;
use crate::app::look::widgets::{
    Lead, ROW, Row, caption, colours, hairline_in, progress_bar, put_line, right, section, strong, text_button,
};
use crate::app::session::at_hand::AtHand;
use crate::app::session::measures::{ChartWanted, Measured, TESTING_SHARE, set_words};
use crate::app::state::{After, App, Dialog, Entry, dialogs};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, percent_done, sentence, thousands};
use crate::chart::rooms::{ChartKind, FEATURES};
use crate::classify::Algorithm;
use crate::dataset::sets::STANDARD;
use crate::dataset::{Row as RoomRow, Statistics};
use crate::draw::Palette;
use crate::labels::Label;
use crate::plan::ElementId;
use crate::study::paper::PaperFigures;

pub(super) const ENTRY: Entry =
    Entry { id: dialogs::DASHBOARD, make: |_, _| Box::new(Dashboard::default()), is_of_plan: false };

/// The largest size of the dialog, in points.
const LARGEST: [f32; 2] = [1180.0, 820.0];

/// A page of the dashboard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Page {
    #[default]
    Labels,
    Features,
    Accuracy,
    Changes,
}

struct Dashboard {
    page: Page,
    /// The set shown; one that is not there stands for the first.
    set: String,
    across: usize,
    up: usize,
    /// The rows brushed.
    brushed: BTreeSet<usize>,
    algorithm: Algorithm,
    /// Whether it has been shown: the first time, rooms are read.
    is_shown: bool,
    /// The chart that a file is being chosen for.
    exporting: Option<ChartWanted>,
}

impl Default for Dashboard {
    fn default() -> Self {
        Self {
            page: Page::default(),
            set: String::new(),
            across: 0,
            up: 2,
            brushed: BTreeSet::new(),
            algorithm: Algorithm::ALL[1],
            is_shown: false,
            exporting: None,
        }
    }
}

/// What is to be done after it was shown.
enum Act {
    Close,
    Calls(Vec<Call>),
    /// Shows a row's room in its plan.
    GoTo(usize),
    Export(ChartWanted),
}

/// Closes the dashboard by its command, so that a recording tells of it.
fn close(app: &mut App, ui: &Ui) -> After {
    app.act("dashboard", &["off"], ui.ctx());
    After::Close
}

impl Dialog for Dashboard {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        if app.session.question.is_some() {
            return After::Close;
        }
        if !self.is_shown {
            self.is_shown = true;
            let source = app.session.usual_source();
            app.session.read_rooms(source, true);
        }
        if let Some(path) = app.session.chosen_file.take()
            && let Some(wanted) = self.exporting.take()
        {
            let values = [kind_word(wanted.kind), Value::Path(path), Value::Text(wanted.words())];
            app.act_on(Call::new("export-chart", values), ui.ctx());
        }
        let response = forms::large_dialog(ui, "dashboard", LARGEST, |ui| self.contents(app, ui));
        let is_closed = response.should_close();
        match response.inner.or(is_closed.then_some(Act::Close)) {
            None => After::Stay,
            Some(Act::Close) => close(app, ui),
            Some(Act::Calls(calls)) => {
                calls.into_iter().for_each(|call| app.act_on(call, ui.ctx()));
                After::Stay
            }
            Some(Act::GoTo(row)) => {
                let room = app.session.at_hand.read.clone();
                if let Some((origin, id)) = room.as_ref().and_then(|at_hand| at_hand.room_of(row)) {
                    app.session.go_to_room(origin, id);
                    return close(app, ui);
                }
                After::Stay
            }
            Some(Act::Export(wanted)) => {
                let name = match wanted.kind {
                    ChartKind::Balance => "labels",
                    ChartKind::Histogram => "histogram",
                    ChartKind::Scatter => "scatter",
                    ChartKind::LearningCurve => "learning-curve",
                    ChartKind::ByBuilding => "accuracy-by-building",
                };
                self.exporting = Some(wanted);
                let path = app.session.export_folder().join(format!("{name}.png"));
                app.session.ask_where_to_put_chart(&path);
                After::Stay
            }
        }
    }
}

/// The word of a kind of chart in commands.
fn kind_word(kind: ChartKind) -> Value {
    Value::word(kind)
}

impl Dashboard {
    fn contents(&mut self, app: &mut App, ui: &mut Ui) -> Option<Act> {
        let mut act = None;
        let at_hand = app.session.at_hand.read.clone();
        ui.horizontal(|ui| {
            ui.label(strong("Dashboard", theme::TITLE));
            if let Some(at_hand) = &at_hand {
                caption(ui, told_of(app, at_hand));
            }
            right(ui, |ui| {
                if text_button(ui, "Close", false).clicked() {
                    act = Some(Act::Close);
                }
                if text_button(ui, "Read again", false).on_hover_text("Read the plans as they are saved now").clicked()
                {
                    let source = app.session.usual_source();
                    app.session.read_rooms(source, true);
                }
            });
        });
        ui.add_space(2.0);
        if app.session.at_hand.is_reading() {
            reading(app, ui);
            return act;
        }
        let Some(at_hand) = at_hand.filter(|at_hand| !at_hand.rows.is_empty()) else {
            empty(app, ui);
            return act;
        };
        let sets = at_hand.sets();
        if !sets.contains(&self.set) {
            self.set = sets.last().cloned().unwrap_or_default();
        }
        ui.horizontal(|ui| {
            let pages = [
                (Page::Labels, "Labels", "How the rooms are shared out, beside the paper's"),
                (Page::Features, "Features", "What the rooms of each label are like"),
                (Page::Accuracy, "Accuracy", "How well a classifier tells the rooms"),
                (Page::Changes, "Changes", "What changed since the dataset was exported"),
            ];
            let width = 400.0f32.min(ui.available_width() * 0.55);
            ui.allocate_ui(vec2(width, ROW), |ui| choose(ui, "page", &mut self.page, &pages));
            let options: Vec<(String, String)> =
                sets.iter().map(|set| (set.clone(), sentence(&set_words(set)))).collect();
            right(ui, |ui| {
                if pick(ui, "Rooms", 180.0, &mut self.set, &options) {
                    self.brushed.clear();
                }
            });
        });
        ui.add_space(6.0);
        let palette = app.session.palette(ui);
        let below = match self.page {
            Page::Labels => self.labels(app, ui, palette, &at_hand),
            Page::Features => self.features(app, ui, palette, &at_hand),
            Page::Accuracy => self.accuracy(app, ui, palette, &at_hand),
            Page::Changes => changes(app, ui, palette, &at_hand),
        };
        act.or(below)
    }

    fn wanted(&self, kind: ChartKind) -> ChartWanted {
        ChartWanted { kind, set: self.set.clone(), across: self.across, up: self.up }
    }

    /// A chart with a button to export it.
    fn chart(
        &self,
        app: &App,
        ui: &mut Ui,
        palette: &Palette,
        at_hand: &AtHand,
        kind: ChartKind,
        height: f32,
    ) -> Option<Act> {
        let wanted = self.wanted(kind);
        let chart = app.session.chart(at_hand, &wanted).filter(|chart| !chart.is_empty())?;
        let seen = chart_view::show(ui, palette, &chart, height, &BTreeSet::new(), None);
        export_button(ui, seen.response.rect, wanted)
    }

    // Labels.

    fn labels(&self, app: &App, ui: &mut Ui, palette: &Palette, at_hand: &AtHand) -> Option<Act> {
        let mut act = None;
        ScrollArea::vertical().id_salt("labels").auto_shrink(false).show(ui, |ui| {
            let rows = at_hand.rows_of(&self.set);
            let statistics = Statistics::of(rows.iter().map(|(_, row)| *row));
            let height = 290.0;
            act = self.chart(app, ui, palette, at_hand, ChartKind::Balance, height);
            ui.add_space(4.0);
            section(ui, "Rooms by label, with the paper's figures below (Table 2)");
            ui.add_space(2.0);
            table_2(ui, palette, &statistics, &self.set);
        });
        act
    }

    // Features.

    fn features(&mut self, app: &App, ui: &mut Ui, palette: &Palette, at_hand: &Arc<AtHand>) -> Option<Act> {
        let mut act = None;
        let features: Vec<(usize, String)> =
            FEATURES.iter().enumerate().map(|(index, name)| (index, (*name).to_owned())).collect();
        let rows = at_hand.rows_of(&self.set);
        ui.horizontal(|ui| {
            caption(ui, "Across");
            pick(ui, "Across", 190.0, &mut self.across, &features);
            caption(ui, "Up");
            pick(ui, "Up", 190.0, &mut self.up, &features);
        });
        let list = 270.0f32.min(ui.available_width() * 0.34);
        let height = ui.available_height();
        ui.horizontal_top(|ui| {
            ui.allocate_ui(vec2(ui.available_width() - list - 16.0, height), |ui| {
                ui.vertical(|ui| {
                    let part = ((height - 10.0) / 2.0).max(150.0);
                    let wanted = self.wanted(ChartKind::Scatter);
                    if let Some(chart) = app.session.chart(at_hand, &wanted) {
                        let told = |row: usize| at_hand.rows.get(row).map(told_of_row).unwrap_or_default();
                        let seen = chart_view::show(ui, palette, &chart, part * 1.15, &self.brushed, Some(&told));
                        let picked = seen.brushed.or(seen.clicked.map(|key| BTreeSet::from([key])));
                        let is_cleared = picked.is_none() && seen.response.clicked();
                        if let Some(picked) = picked.or(is_cleared.then(BTreeSet::new)) {
                            act = select_in_plan(app, at_hand, &picked);
                            self.brushed = picked;
                        }
                        let below = export_button(ui, seen.response.rect, wanted);
                        act = act.take().or(below);
                    }
                    ui.push_id("histogram", |ui| {
                        let below = self.chart(app, ui, palette, at_hand, ChartKind::Histogram, part * 0.85);
                        act = act.take().or(below);
                    });
                });
            });
            ui.vertical(|ui| {
                let picked = listed(app, ui, palette, at_hand, &rows, &mut self.brushed);
                act = act.take().or(picked);
            });
        });
        act
    }

    // Accuracy.

    fn accuracy(&mut self, app: &mut App, ui: &mut Ui, palette: &Palette, at_hand: &AtHand) -> Option<Act> {
        let mut act = None;
        let algorithms: Vec<(Algorithm, String)> =
            Algorithm::ALL.map(|it| (it, it.learner().short_title().to_owned())).to_vec();
        ui.horizontal(|ui| {
            caption(ui, "Classifier");
            pick(ui, "Classifier", 200.0, &mut self.algorithm, &algorithms);
            if app.session.measures.is_measuring() {
                if text_button(ui, "Stop", false).clicked() {
                    app.session.measures.cancel();
                }
                let share = app.session.measure_progress();
                let said = measuring(app, share);
                ui.allocate_ui(vec2(220.0, ROW), |ui| progress_bar(ui, share, &said));
                ui.add(egui::Label::new(egui::RichText::new(said).size(theme::SMALL).color(colours(ui).text_weak)));
            } else if text_button(ui, "Measure accuracy", true).clicked() {
                let word = self.algorithm.name();
                let values = [Value::Text(self.set.clone()), Value::Text(word.to_owned())];
                act = Some(Act::Calls(vec![Call::new("measure-accuracy", values)]));
            }
        });
        if let Some(error) = &app.session.measures.error {
            ui.label(egui::RichText::new(sentence(&format!("{error}."))).color(colours(ui).error));
        }
        if !app.session.has_measured(&self.set) {
            let title = if app.session.measures.is_measuring() { "Measuring" } else { "Nothing measured yet" };
            note(
                ui,
                title,
                "Measuring trains the classifier ten times, each time without some of the buildings, and asks it for the \
                 labels of these. Nothing is kept; to make a model, choose Train models.",
            );
            return act;
        }
        let measured = app.session.measures.of_sets.get(&self.set).map(Vec::as_slice).unwrap_or_default();
        ScrollArea::vertical().id_salt("accuracy").auto_shrink(false).show(ui, |ui| {
            if !measured.is_empty() {
                caption(ui, told_of_measured(measured));
                ui.add_space(2.0);
            }
            ui.columns(2, |columns| {
                let below = self.chart(app, &mut columns[0], palette, at_hand, ChartKind::LearningCurve, 340.0);
                act = act.take().or(below);
                let buildings = measured.last().map_or(0, |measured| measured.buildings.len());
                let height = (90.0 + 18.0 * buildings as f32).clamp(200.0, 2400.0);
                columns[1].push_id("buildings", |ui| {
                    let below = self.chart(app, ui, palette, at_hand, ChartKind::ByBuilding, height);
                    act = act.take().or(below);
                });
            });
        });
        act
    }
}

/// How the classifiers did, in a sentence each.
fn told_of_measured(measured: &[Measured]) -> String {
    let told: Vec<String> = measured
        .iter()
        .map(|it| {
            format!(
                "{}: {:.1} ± {:.1} % of {} right in buildings never seen, log loss {:.2}",
                it.algorithm.learner().short_title(),
                100.0 * it.scores.accuracy,
                100.0 * it.scores.accuracy_deviation,
                count(it.scores.rooms, "room"),
                it.scores.log_loss
            )
        })
        .collect();
    told.join("\n")
}

/// What is at hand, in words.
fn told_of(app: &App, at_hand: &AtHand) -> String {
    let mut told = format!(
        "{} of {} and {}, in {}",
        count(at_hand.rows.len(), "labelled room"),
        count(at_hand.plans, "plan"),
        count(at_hand.buildings, "building"),
        app.session.source_title(&at_hand.source)
    );
    if !at_hand.unreadable.is_empty() {
        told.push_str(&format!("; {} could not be read", count(at_hand.unreadable.len(), "file")));
    }
    told
}

/// What a row is, in words.
fn told_of_row(row: &RoomRow) -> String {
    let function = if row.function.is_empty() { String::new() } else { format!(", {}", row.function.to_lowercase()) };
    format!("{}{function}: {}, {:.1} m²\n{}", row.room, row.label.name(), row.features.area_m2, row.plan)
}

/// Selects the brushed rooms that are in the plan shown.
fn select_in_plan(app: &App, at_hand: &AtHand, rows: &BTreeSet<usize>) -> Option<Act> {
    let shown = &app.session.document.as_ref()?.origin;
    let plan = app.plan()?;
    let of_plan = rows.iter().filter_map(|&row| at_hand.room_of(row)).filter(|(origin, _)| *origin == shown);
    let elements: Vec<ElementId> =
        of_plan.map(|(_, id)| ElementId::Room(id)).filter(|&element| plan.has(element)).collect();
    if elements.is_empty() {
        return None;
    }
    Some(Act::Calls(vec![Call::new("select", [Value::Elements(elements)])]))
}

/// The rooms that are brushed, or a hint; a click shows a room in its plan.
fn listed(
    app: &App,
    ui: &mut Ui,
    palette: &Palette,
    at_hand: &AtHand,
    rows: &[(usize, &RoomRow)],
    brushed: &mut BTreeSet<usize>,
) -> Option<Act> {
    let mut act = None;
    if brushed.is_empty() {
        section(ui, "Rooms");
        ui.add_space(2.0);
        caption(
            ui,
            "Drag over dots to pick their rooms. By keyboard: Tab to the chart, move a box with the arrows, stretch it with \
             Shift and pick with Enter. Rooms of the open plan are selected there. Or pick by label:",
        );
        ui.add_space(2.0);
        for label in Label::ALL {
            let of_label: Vec<usize> =
                rows.iter().filter(|(_, row)| row.label == label).map(|(index, _)| *index).collect();
            let (text, number) = (sentence(label.name()), of_label.len().to_string());
            let row = Row::new(Lead::Swatch(theme::colour(palette.label(label))), &text).trail(&number);
            if !of_label.is_empty() && row.button(ui, Role::Button).clicked() {
                *brushed = of_label.into_iter().collect();
                act = select_in_plan(app, at_hand, brushed);
            }
        }
        return act;
    }
    ui.horizontal(|ui| {
        section(ui, &format!("{} picked", count(brushed.len(), "room")));
        right(ui, |ui| {
            if text_button(ui, "None", false).on_hover_text("Pick no rooms").clicked() {
                brushed.clear();
            }
        });
    });
    let picked: Vec<usize> = brushed.iter().copied().collect();
    let height = ui.available_height();
    let area = ScrollArea::vertical().id_salt("picked").auto_shrink(false).max_height(height);
    ui.spacing_mut().item_spacing.y = 0.0;
    area.show_rows(ui, ROW, picked.len(), |ui, range| {
        for &index in picked.get(range).unwrap_or_default() {
            let Some(row) = at_hand.rows.get(index) else { continue };
            let text = if row.function.is_empty() {
                row.room.clone()
            } else {
                format!("{}, {}", row.room, row.function.to_lowercase())
            };
            let area = app.units().area(row.features.area_m2);
            let lead = Lead::Swatch(theme::colour(palette.label(row.label)));
            let response = ui.push_id(index, |ui| Row::new(lead, &text).trail(&area).button(ui, Role::Button)).inner;
            let response = response.on_hover_text(format!("Show it in {}", row.plan));
            if response.clicked() {
                act = Some(Act::GoTo(index));
            }
        }
    });
    act
}

/// A button to export a chart, in its upper right corner.
fn export_button(ui: &mut Ui, chart: Rect, wanted: ChartWanted) -> Option<Act> {
    let corner = Rect::from_min_size(egui::pos2(chart.right() - 98.0, chart.top() + 7.0), vec2(90.0, 30.0));
    let help = "As a picture (PNG), a drawing (SVG) or a table (CSV), by the file's ending";
    let mut is_clicked = false;
    // Beside the layout, which goes on below the chart.
    let salt = ("export chart", wanted.words(), wanted.kind as u8);
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(corner).id_salt(salt));
    child.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        is_clicked = text_button(ui, "Export…", false).on_hover_text(help).clicked();
    });
    is_clicked.then_some(Act::Export(wanted))
}

/// What is being measured, and how far it is.
fn measuring(app: &App, share: f64) -> String {
    let of = app.session.measures.measuring().map_or("", |algorithm| algorithm.learner().short_title());
    let what = if share < TESTING_SHARE { "buildings left out" } else { "learning curve" };
    format!("{of}, {what}: {}", percent_done(share))
}

/// How far reading the rooms is.
fn reading(app: &App, ui: &mut Ui) {
    let (done, all) = app.session.rooms_progress().unwrap_or((0, 0));
    let said = if all == 0 { "Looking for plans".to_owned() } else { format!("{done} of {} read", count(all, "file")) };
    ui.add_space((ui.available_height() * 0.3).max(12.0));
    ui.vertical_centered(|ui| {
        ui.label(said.clone());
        ui.add_space(4.0);
        let share = done as f64 / all.max(1) as f64;
        ui.allocate_ui(vec2(360.0f32.min(ui.available_width()), ROW), |ui| progress_bar(ui, share, &said));
    });
}

/// What the page says where it has nothing to show.
fn note(ui: &mut Ui, title: &str, text: &str) {
    ui.add_space((ui.available_height() * 0.26).max(12.0));
    ui.vertical_centered(|ui| {
        ui.label(strong(title, theme::TITLE));
        ui.add_space(4.0);
        ui.allocate_ui(vec2(440.0f32.min(ui.available_width()), 60.0), |ui| {
            ui.vertical_centered(|ui| caption(ui, text));
        });
    });
}

/// The dashboard without rooms.
fn empty(app: &App, ui: &mut Ui) {
    match &app.session.at_hand.error {
        Some(error) => note(ui, "The rooms could not be read", error),
        None => note(
            ui,
            "No labelled rooms yet",
            "Open a folder of plans, or label the rooms of a plan. A room counts once it has a label of its own, or a \
             function that the plan's typology knows.",
        ),
    }
}

/// What changed since the last export.
fn changes(app: &App, ui: &mut Ui, palette: &Palette, at_hand: &AtHand) -> Option<Act> {
    let Some(since) = &at_hand.since_export else {
        note(
            ui,
            "No exported dataset in this folder",
            "Export the dataset into the folder of the plans. From then on this page tells what has changed since.",
        );
        return None;
    };
    let changes = &since.changes;
    caption(ui, format!("Since {} was exported:", app.session.shown_path(&since.path)));
    ui.add_space(4.0);
    let lines = [
        ("Rooms added", changes.added.len()),
        ("Rooms removed", changes.removed.len()),
        ("Labels changed", changes.relabelled.len()),
        ("Shapes or openings changed", changes.reshaped.len()),
    ];
    for (name, number) in lines {
        let number = thousands(number as u64);
        Row::new(Lead::None, name).trail(&number).inset_end((ui.available_width() - 280.0).max(0.0)).show_only(ui);
    }
    if changes.is_empty() {
        note(ui, "Nothing has changed", "The plans hold the rooms and labels of the dataset.");
        return None;
    }
    ui.add_space(8.0);
    let is_here = |row: usize, what: String| Some((Some(row), at_hand.rows.get(row)?, what));
    let relabelled = changes.relabelled.iter().map(|&(row, before)| is_here(row, format!("was {}", before.name())));
    let added = changes.added.iter().map(|&row| is_here(row, "new".to_owned()));
    let reshaped = changes.reshaped.iter().map(|&row| is_here(row, "shape or openings".to_owned()));
    let removed = changes.removed.iter().map(|&row| Some((None, since.before.get(row)?, "removed".to_owned())));
    let lines: Vec<(Option<usize>, &RoomRow, String)> =
        relabelled.chain(added).chain(reshaped).chain(removed).flatten().collect();
    let mut act = None;
    section(ui, "Rooms");
    ui.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().id_salt("changes").auto_shrink(false).show_rows(ui, ROW, lines.len(), |ui, range| {
        for (index, (at, row, what)) in lines.iter().enumerate().take(range.end).skip(range.start) {
            let lead = Lead::Swatch(theme::colour(palette.label(row.label)));
            let text = format!("{} in {}", row.room, row.plan);
            let line = Row::new(lead, &text).trail(what);
            let line = if at.is_none() { line.muted() } else { line };
            let shown = ui.push_id(index, |ui| line.button(ui, Role::Button)).inner;
            if let Some(at) = at.filter(|_| shown.clicked()) {
                act = Some(Act::GoTo(at));
            }
        }
    });
    act
}

/// The paper's Table 2 for the rooms, with the paper's own figures below each line.
fn table_2(ui: &mut Ui, palette: &Palette, statistics: &Statistics, set: &str) {
    let paper = PaperFigures::bundled();
    let of_set = paper.as_ref().and_then(|paper| paper.rooms.get(set));
    ui.spacing_mut().item_spacing.y = 0.0;
    let heads = ["Label", "Rooms", "Share", "Area, m²", "Openings", "Length over width"];
    table_line(ui, None, &heads.map(str::to_owned), Look::Head);
    hairline_in(ui);
    for line in &statistics.labels {
        let spread = |mean: f64, deviation: f64| format!("{mean:.1} ± {deviation:.1}");
        let ours = [
            sentence(line.label.name()),
            thousands(line.rooms as u64),
            format!("{:.1} %", 100.0 * line.share),
            if line.rooms > 0 { spread(line.area_m2.mean, line.area_m2.deviation) } else { "–".to_owned() },
            if line.rooms > 0 { spread(line.doors.mean, line.doors.deviation) } else { "–".to_owned() },
            if line.rooms > 0 { format!("{:.1}", line.axes_ratio.mean) } else { "–".to_owned() },
        ];
        table_line(ui, Some(theme::colour(palette.label(line.label))), &ours, Look::Ours);
        if let Some(of) = of_set.and_then(|of_set| of_set.get(line.label.letter())) {
            let theirs = [
                "in the paper".to_owned(),
                String::new(),
                format!("{:.1} %", of.share),
                spread(of.area_m2[0], of.area_m2[1]),
                spread(of.doors[0], of.doors[1]),
                format!("{:.1}", of.axes_ratio),
            ];
            table_line(ui, None, &theirs, Look::Theirs);
        }
    }
    if of_set.is_none() {
        ui.add_space(4.0);
        let of = if set == STANDARD { "all rooms together".to_owned() } else { format!("the typology '{set}'") };
        caption(
            ui,
            format!("The paper has no figures for {of}: choose houses, schools or offices to see them beside."),
        );
    }
}

/// How a line of a table looks.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    Head,
    Ours,
    Theirs,
}

/// A line of a table: the first cell at the left, the others at the right of their columns.
pub(super) fn table_line(ui: &mut Ui, swatch: Option<egui::Color32>, cells: &[String], look: Look) {
    let height = if look == Look::Theirs { 18.0 } else { 24.0 };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, cells.join(", ")));
    let colours = colours(ui);
    let (font, colour) = match look {
        Look::Head => (FontId::new(theme::SMALL, theme::semibold()), colours.text_weak),
        Look::Ours => (FontId::proportional(theme::BODY), colours.text),
        Look::Theirs => (FontId::proportional(theme::SMALL), colours.text_weak),
    };
    let first = (rect.width() * 0.3).clamp(124.0, 240.0);
    let each = (rect.width() - first) / cells.len().saturating_sub(1).max(1) as f32;
    for (index, cell) in cells.iter().enumerate() {
        if index == 0 {
            if let Some(colour) = swatch {
                crate::app::look::widgets::swatch(ui, egui::pos2(rect.left() + 7.0, rect.center().y), colour);
            }
            let cell_rect = Rect::from_x_y_ranges(rect.left() + 20.0..=rect.left() + first, rect.y_range());
            put_line(ui, cell, font.clone(), colour, cell_rect);
        } else {
            let end = rect.left() + first + each * index as f32 - 4.0;
            let galley = ui.painter().layout_no_wrap(cell.clone(), font.clone(), colour);
            crate::app::look::widgets::put(ui, galley.clone(), end - galley.rect.width(), rect.center().y);
        }
    }
}
