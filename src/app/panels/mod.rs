//! The panels around the canvas, one file each.

pub(super) mod about;
pub(super) mod bulk;
mod canvas;
pub(super) mod differences;
mod history;
mod inspector;
mod layers;
mod messages;
pub(super) mod notes;
pub(super) mod palette;
mod picture;
pub(super) mod plan_picture;
mod plans;
mod prediction;
mod questions;
pub(super) mod recovery;
pub(super) mod shortcuts;
pub(super) mod status;
mod tool_options;
mod tool_strip;
mod top_bar;
pub(super) mod welcome;

use egui::{CentralPanel, Frame, Margin, Panel, ScrollArea, Ui, UiBuilder};

use crate::app::look::theme;
use crate::app::state::App;
use crate::app::state::Entry;

/// The dialogs there are; a later one lies above an earlier one.
pub(crate) const DIALOGS: &[Entry] =
    &[notes::ENTRY, differences::ENTRY, recovery::ENTRY, about::ENTRY, shortcuts::ENTRY, bulk::ENTRY, palette::ENTRY];

/// So many points at least the list of plans keeps above the layers: its title and two plans.
const LEAST_PLANS_HEIGHT: f32 = 110.0;

/// Height in points of the history below the inspector, and the least it can be made.
const HISTORY_HEIGHT: f32 = 240.0;
const LEAST_HISTORY_HEIGHT: f32 = 90.0;

/// So many points at least the inspector keeps above the history.
const LEAST_INSPECTOR_HEIGHT: f32 = 160.0;

/// The inspector, and the history below it.
fn show_right(app: &mut App, ui: &mut Ui) {
    match (app.panels.right, app.panels.history) {
        (_, false) => inspector::show(app, ui),
        (false, true) => history::show(app, ui),
        (true, true) => {
            let most = (ui.available_height() - LEAST_INSPECTOR_HEIGHT).max(LEAST_HISTORY_HEIGHT);
            Panel::bottom("history")
                .resizable(true)
                .default_size(HISTORY_HEIGHT.min(most))
                .size_range(LEAST_HISTORY_HEIGHT..=most)
                .frame(Frame::new().fill(theme::colours(ui.visuals()).panel))
                .show(ui, |ui| history::show(app, ui));
            inspector::show(app, ui);
        }
    }
}

/// Shows the window.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    let colours = theme::colours(ui.visuals());
    let frame = |margin: Margin| Frame::new().fill(colours.panel).inner_margin(margin);
    app.canvas.hovered_in_panel = None;
    Panel::top("top bar").exact_size(44.0).frame(frame(Margin::symmetric(8, 0))).show(ui, |ui| top_bar::show(app, ui));
    // Its place; what is in it comes last, as the keyboard goes.
    let status_rect = Panel::bottom("status line")
        .exact_size(30.0)
        .frame(frame(Margin::symmetric(12, 0)))
        .show(ui, |ui| ui.max_rect())
        .inner;
    (app.panels.left_rect, app.panels.right_rect) = (None, None);
    if app.panels.left {
        let shown = Panel::left("plans and layers")
            .default_size(236.0)
            .size_range(180.0..=440.0)
            .frame(frame(Margin::symmetric(8, 8)))
            .show(ui, |ui| {
                // As high as what is in it, which changes with the fill: a panel that sizes itself
                // does not grow again. In a low window it scrolls, so that the plans keep some room.
                let wanted = app.panels.layers_height;
                let given = wanted.min(ui.available_height() - LEAST_PLANS_HEIGHT).max(LEAST_PLANS_HEIGHT);
                let all = ui.available_rect_before_wrap();
                let (above, below) = all.split_top_bottom_at_y(all.bottom() - given);
                // From top to bottom, as the keyboard goes.
                plans::show(app, &mut ui.new_child(UiBuilder::new().max_rect(above).id_salt("plans")));
                let mut below = ui.new_child(UiBuilder::new().max_rect(below).id_salt("layers"));
                let area = ScrollArea::vertical().id_salt("layers").auto_shrink(false);
                let shown = area.show(&mut below, |ui| {
                    let top = ui.cursor().top();
                    layers::show(app, ui);
                    ui.cursor().top() - top
                });
                if (shown.inner - wanted).abs() > 0.5 {
                    app.panels.layers_height = shown.inner;
                    ui.request_repaint();
                }
                ui.take_available_space();
            });
        app.panels.left_rect = Some(shown.response.rect);
    }
    if (app.panels.right || app.panels.history) && app.session.document.is_some() {
        let shown = Panel::right("inspector")
            .default_size(300.0)
            .size_range(240.0..=520.0)
            .frame(frame(Margin::ZERO))
            .show(ui, |ui| show_right(app, ui));
        app.panels.right_rect = Some(shown.response.rect);
    }
    if app.session.document.is_some() {
        Panel::left("tools")
            .exact_size(tool_strip::WIDTH)
            .resizable(false)
            .frame(frame(Margin::symmetric(6, 8)))
            .show(ui, |ui| tool_strip::show(app, ui));
    }
    let shown = CentralPanel::default().frame(Frame::new()).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        messages::show(app, ui);
        if app.session.document.is_some() {
            canvas::show(app, ui);
        } else {
            welcome::show(app, ui);
        }
        welcome::show_drop_target(ui);
    });
    app.panels.middle_rect = Some(shown.response.rect);
    tool_options::show(app, ui);
    status::show(app, &mut ui.new_child(UiBuilder::new().max_rect(status_rect).id_salt("status")));
    app.show_dialogs(ui);
    questions::show(app, ui);
}
