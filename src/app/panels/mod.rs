//! The panels around the canvas and the dialogs over it, one file each.

pub(super) mod about;
pub(super) mod bulk;
mod canvas;
mod chart_view;
mod dashboard;
mod dataset;
pub(super) mod demo;
pub(super) mod differences;
mod export;
mod findings;
mod forms;
mod here;
mod history;
mod inspector;
mod layers;
mod live;
mod menus;
mod messages;
pub(super) mod notes;
pub(super) mod palette;
mod picture;
pub(super) mod plan_picture;
mod plans;
mod prediction;
mod questions;
mod reasons;
pub(super) mod recovery;
mod review;
mod robot;
mod schemes;
pub(super) mod shortcuts;
mod sides;
pub(super) mod status;
mod tool_options;
mod tool_strip;
mod top_bar;
mod training;
pub(super) mod welcome;
mod what_if;
mod workspace;

use egui::{CentralPanel, Frame, Margin, Panel, Ui, UiBuilder};

use crate::app::look::theme;
use crate::app::state::{App, Entry, Side, SidePanel, panels};

/// All dialogs; later ones are above earlier ones.
pub(crate) const DIALOGS: &[Entry] = &[
    workspace::ENTRY,
    notes::ENTRY,
    differences::ENTRY,
    recovery::ENTRY,
    about::ENTRY,
    shortcuts::ENTRY,
    bulk::ENTRY,
    export::ENTRY,
    dataset::ENTRY,
    dashboard::ENTRY,
    training::ENTRY,
    schemes::ENTRY,
    palette::ENTRY,
];

/// All side panels, from the top.
pub(crate) const SIDE_PANELS: &[SidePanel] = &[
    plans::PANEL,
    layers::PANEL,
    review::PANEL,
    inspector::PANEL,
    live::PANEL,
    what_if::PANEL,
    robot::PANEL,
    findings::PANEL,
    history::PANEL,
];

/// Shows the window.
pub(crate) fn show(app: &mut App, ui: &mut Ui) {
    let colours = theme::colours(ui.visuals());
    let frame = |margin: Margin| Frame::new().fill(colours.panel).inner_margin(margin);
    app.session.live.is_shown = app.panels.is_shown(panels::LIVE);
    let evidence = app.session.demo_evidence();
    (app.canvas.hovered_in_panel, app.canvas.marked_in_panel, app.canvas.evidence) = (None, None, evidence);
    // The demonstration has the window for itself.
    let is_demo = app.session.demo.is_some();
    Panel::top("top bar").exact_size(44.0).frame(frame(Margin::symmetric(8, 0))).show(ui, |ui| top_bar::show(app, ui));
    // Only reserves its place: its contents come last in Tab order.
    let status_rect = Panel::bottom("status line")
        .exact_size(30.0)
        .frame(frame(Margin::symmetric(12, 0)))
        .show(ui, |ui| ui.max_rect())
        .inner;
    (app.panels.left_rect, app.panels.right_rect) = (None, None);
    let left = if is_demo { Vec::new() } else { sides::shown(app, Side::Left) };
    if !left.is_empty() {
        let shown = Panel::left("plans and layers")
            .default_size(236.0)
            .size_range(180.0..=440.0)
            .frame(frame(Margin::symmetric(8, 8)))
            .show(ui, |ui| sides::show(app, ui, &left));
        app.panels.left_rect = Some(shown.response.rect);
    }
    let right = if is_demo { Vec::new() } else { sides::shown(app, Side::Right) };
    if !right.is_empty() {
        let shown = Panel::right("inspector")
            .default_size(300.0)
            .size_range(240.0..=520.0)
            .frame(frame(Margin::ZERO))
            .show(ui, |ui| sides::show(app, ui, &right));
        app.panels.right_rect = Some(shown.response.rect);
    }
    if app.session.document.is_some() && !is_demo {
        Panel::left("tools")
            .exact_size(tool_strip::WIDTH)
            .resizable(false)
            .frame(frame(Margin::symmetric(6, 8)))
            .show(ui, |ui| tool_strip::show(app, ui));
    }
    let shown = CentralPanel::default().frame(Frame::new()).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        if app.session.document.is_some() {
            canvas::show(app, ui);
        } else {
            welcome::show(app, ui);
        }
        welcome::show_drop_target(ui);
    });
    app.panels.middle_rect = Some(shown.response.rect);
    if !is_demo {
        tool_options::show(app, ui);
    }
    demo::show(app, ui);
    messages::show(app, ui, shown.response.rect);
    status::show(app, &mut ui.new_child(UiBuilder::new().max_rect(status_rect).id_salt("status")));
    here::show(app, ui);
    menus::show_context_menu(app, ui);
    app.show_dialogs(ui);
    questions::show(app, ui);
}
