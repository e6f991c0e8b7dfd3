//! What is seen when no plan is open, and when a file is dragged over the window.

use egui::epaint::StrokeKind;
use egui::{Align, Align2, FontId, Id, LayerId, Layout, Order, Rect, RichText, Role, Stroke, Ui, UiBuilder, vec2};

use crate::app::document::{BUNDLED_PLANS, Origin};
use crate::app::icons::Icon;
use crate::app::widgets::{Lead, Row, colours, section, strong, text_button};
use crate::app::{App, commands, theme};

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    let palette = crate::draw::Palette::of(
        if ui.visuals().dark_mode { crate::draw::Theme::Dark } else { crate::draw::Theme::Light },
        crate::draw::LabelColours::Standard,
    );
    ui.painter().rect_filled(rect, 0.0, theme::colour(palette.paper));
    let height = 232.0 + 28.0 * BUNDLED_PLANS.len() as f32;
    let column =
        Rect::from_center_size(rect.center(), vec2(380.0_f32.min(rect.width() - 32.0), height.min(rect.height())));
    let mut ui = ui.new_child(UiBuilder::new().max_rect(column).layout(Layout::top_down(Align::Min)));
    let ui = &mut ui;
    ui.label(strong("Enfilade", theme::DISPLAY));
    let text =
        RichText::new("Open a floor plan to see its rooms, the doors that join them, and what they say of each room.");
    ui.add(egui::Label::new(text.color(colours(ui).text_weak)).wrap());
    ui.add_space(10.0);
    ui.horizontal(|ui| {
        let Some(command) = commands::find("open") else { return };
        if text_button(ui, "Open a plan…", true).on_hover_text(command.help).clicked() {
            app.choose_plan();
        }
        let shortcut = command.shortcuts.first().map(|keys| ui.ctx().format_shortcut(keys)).unwrap_or_default();
        ui.add_space(4.0);
        let hint = RichText::new(format!("{shortcut}, or drop a file anywhere here")).color(colours(ui).text_weak);
        ui.label(hint);
    });
    ui.add_space(18.0);
    if BUNDLED_PLANS.is_empty() {
        return;
    }
    section(ui, "Samples");
    ui.spacing_mut().item_spacing.y = 0.0;
    for (index, plan) in BUNDLED_PLANS.iter().enumerate() {
        if Row::new(Lead::Icon(Icon::Plan), plan.title).button(ui, Role::Button).clicked() {
            app.open(Origin::Bundled(index));
        }
    }
}

/// Says that a dragged file can be let go.
pub(super) fn show_drop_target(ui: &Ui) {
    if ui.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let colours = colours(ui);
    let rect = ui.max_rect().shrink(12.0);
    let painter = ui.ctx().layer_painter(LayerId::unique(Order::Foreground, Id::unique("drop target")));
    painter.rect_filled(rect, f32::from(theme::RADIUS_LARGE), colours.accent_soft.gamma_multiply(0.92));
    painter.rect_stroke(rect, f32::from(theme::RADIUS_LARGE), Stroke::new(2.0, colours.accent), StrokeKind::Inside);
    let font = FontId::unique(theme::TITLE, theme::semibold());
    painter.text(rect.center(), Align2::CENTER_CENTER, "Drop to open", font, colours.text);
}
