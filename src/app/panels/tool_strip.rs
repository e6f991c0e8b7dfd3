//! The strip of drawing tools beside the canvas.

use egui::{Align2, FontId, Sense, Stroke, Ui, vec2};

use super::top_bar::with_tooltip;
use crate::app::commands::COMMANDS;
use crate::app::look::{
    theme,
    widgets::{ROW, colours, icon_button},
};
use crate::app::state::App;

/// Space around a tool, in points.
const SPACE: f32 = 2.0;

/// How wide the strip is, in points.
pub(super) const WIDTH: f32 = ROW + 12.0;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    ui.spacing_mut().item_spacing = vec2(0.0, SPACE);
    let mut group = None;
    for command in COMMANDS.iter() {
        let Some((icon, this)) = command.strip else { continue };
        if group.is_some_and(|group| group != this) {
            let (rect, _) = ui.allocate_exact_size(vec2(ROW, 9.0), Sense::hover());
            let line = rect.shrink2(vec2(5.0, 0.0));
            ui.painter().hline(line.x_range(), rect.center().y, Stroke::new(1.0, colours(ui).outline));
        }
        group = Some(this);
        let is_on = command.is_on(app) == Some(true);
        let is_available = command.why_not(app).is_none();
        let response = ui.add_enabled_ui(is_available, |ui| icon_button(ui, icon, command.title, Some(is_on))).inner;
        // Its key is in the corner: after seeing it once, the user no longer needs the strip.
        let keys = app.keys_text(command, ui.ctx());
        if keys.chars().count() == 1 {
            let colours = colours(ui);
            let ink = if is_on { colours.accent } else { colours.text_weak };
            let at = response.rect.right_bottom() + vec2(-2.0, 0.0);
            ui.painter().text(at, Align2::RIGHT_BOTTOM, keys, FontId::proportional(theme::SMALL - 3.0), ink);
        }
        let response = with_tooltip(app, response, ui.ctx(), command);
        if response.clicked() {
            let context = ui.ctx().clone();
            app.run_command(command.id, &context);
        }
    }
}
