//! The status line: counts, the last action, pointer position, zoom.

use crate::base::wording::{count, percent_done, thousands};
use egui::{Align, Layout, RichText, Sense, Ui, vec2};

use crate::app::commands;
use crate::app::look::{
    icons::Icon,
    theme,
    widgets::{colours, icon_button, link, right},
};
use crate::app::state::{App, dialogs};

/// Metres per point on a 96 dpi screen, which egui's points are meant to match.
const METRES_PER_POINT: f64 = 0.0254 / 96.0;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
        let weak = colours(ui).text_weak;
        let small = |text: String| RichText::new(text).size(theme::SMALL).color(weak);
        if app.is_recording() {
            ui.label(RichText::new("● Recording").size(theme::SMALL).color(colours(ui).error));
            ui.add_space(6.0);
        }
        if app.session.journal_failure().is_some() {
            ui.label(RichText::new("● No backup").size(theme::SMALL).color(colours(ui).error));
            ui.add_space(6.0);
        }
        super::findings::badge(app, ui);
        ui.add_space(4.0);
        if app.session.training.is_running() && !app.dialogs.is_open(dialogs::TRAINING) {
            let said = format!("Training: {}", percent_done(app.session.training.live().share()));
            if link(ui, &said).on_hover_text("Show how far the training is").clicked() {
                app.open_dialog(dialogs::TRAINING);
            }
            ui.add_space(8.0);
        }
        // Never over the right part.
        let is_narrow = ui.ctx().content_rect().width() < NARROW;
        let right_width = if is_narrow { ZOOM_WIDTH } else { RIGHT_WIDTH };
        let width = (ui.available_width() - right_width).max(0.0);
        // In the demonstration nobody is to do anything.
        let text = if app.session.demo.is_some() { String::new() } else { left_text(app) };
        let said = app.session.status.clone();
        let needed = |text: &str| {
            let font = egui::FontId::proportional(theme::SMALL);
            ui.painter().layout_no_wrap(text.to_owned(), font, weak).rect.width()
        };
        // What was said comes before what could be done; where not even that fits, it stands above in full.
        let is_too_long = !said.is_empty() && needed(&said) > width;
        let text =
            if !said.is_empty() && text.starts_with(&said) && needed(&text) > width { said.clone() } else { text };
        ui.scope(|ui| {
            ui.set_max_width(width);
            ui.add(egui::Label::new(small(text)).truncate());
        });
        if is_too_long {
            in_full(ui, &said);
        }
        right(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            let Some(px_per_m) = app.canvas.px_per_m().filter(|_| app.session.document.is_some()) else { return };
            zoom_button(app, ui, Icon::Plus, "zoom-in");
            let scale = 1.0 / (px_per_m * METRES_PER_POINT);
            let (rect, response) = ui.allocate_exact_size(vec2(60.0, 22.0), Sense::hover());
            let text = format!("1:{}", thousands(scale.round().max(1.0) as u64));
            let font = egui::FontId::proportional(theme::SMALL);
            ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, &text, font, weak);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, format!("Scale {text}")));
            response.on_hover_text("Scale on a screen with 96 points per inch");
            zoom_button(app, ui, Icon::Minus, "zoom-out");
            ui.add_space(14.0);
            if let Some(point) = app.session.pointed.at.filter(|_| !is_narrow) {
                let units = app.units();
                ui.label(small(format!("x {}    y {}", units.length(point.x), units.length(point.y))));
            }
        });
    });
}

/// Width of the coordinates and the zoom, in points.
const RIGHT_WIDTH: f32 = 290.0;

/// Width of the zoom alone.
const ZOOM_WIDTH: f32 = 140.0;

/// A window narrower than this shows no coordinates, in points.
const NARROW: f32 = 900.0;

/// Shows a text that is too long for the line above it, over the canvas.
fn in_full(ui: &Ui, text: &str) {
    let line = ui.max_rect();
    let most = (ui.ctx().content_rect().width() - 48.0).min(560.0);
    egui::Area::new(egui::Id::unique("status in full"))
        .order(egui::Order::Middle)
        .interactable(false)
        .pivot(egui::Align2::LEFT_BOTTOM)
        .fixed_pos(line.left_top() - vec2(0.0, 8.0))
        .show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).inner_margin(egui::Margin::symmetric(12, 8)).show(ui, |ui| {
                ui.set_max_width(most);
                ui.add(egui::Label::new(RichText::new(text).size(theme::SMALL).color(colours(ui).text)).wrap());
            });
        });
}

fn zoom_button(app: &mut App, ui: &mut Ui, icon: Icon, id: &str) {
    let Some(command) = commands::find(id) else { return };
    if icon_button(ui, icon, command.title, None).on_hover_text(command.title).clicked() {
        let context = ui.ctx().clone();
        app.run_command(id, &context);
    }
}

pub(crate) fn left_text(app: &App) -> String {
    if let Some(origin) = &app.session.opening {
        return format!("Opening {}…", origin.title());
    }
    let Some(document) = &app.session.document else { return String::new() };
    if let Some(name) = &app.session.reading_picture {
        return format!("Reading {name}…");
    }
    if app.session.backdrop.is_loading() {
        return "Reading the picture…".to_owned();
    }
    if document.derived().is_none() {
        return "Computing rooms and features…".to_owned();
    }
    let said: Vec<&str> =
        [app.session.status.as_str(), app.tools.hint.as_str()].into_iter().filter(|text| !text.is_empty()).collect();
    if !said.is_empty() {
        return said.join("  ·  ");
    }
    let plan = document.plan();
    let contents = app.session.contents();
    let mut text = format!("{}  ·  {}", count(plan.rooms().len(), "room"), count(contents.passable, "opening"));
    if contents.windows > 0 {
        text.push_str(&format!("  ·  {}", count(contents.windows, "window")));
    }
    text
}
