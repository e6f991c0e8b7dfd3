//! The options of the active tool, in a bar floating over the canvas, so that nothing moves when it
//! appears.

use egui::{Area, Frame, Id, Margin, Order, RichText, Ui, vec2};

use crate::app::commands;
use crate::app::look::{
    length_field::LengthField,
    theme,
    widgets::{colours, toggle},
};
use crate::app::state::App;
use crate::app::tools::ToolOption;
use crate::app::value::{Call, Value};
use crate::geometry::trim_m;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let tool = app.tools.entry();
    if app.session.document.is_none() || app.tools.is_selecting() {
        return;
    }
    let Some(canvas) = app.canvas.seen_rect() else { return };
    let colours_of_bar = colours(ui);
    let frame = Frame::new()
        .fill(colours_of_bar.panel)
        .stroke(egui::Stroke::new(1.0, colours_of_bar.outline))
        .corner_radius(theme::RADIUS + 2)
        .inner_margin(Margin { left: 12, right: 8, top: 4, bottom: 4 });
    let area = Area::new(Id::unique("tool options")).order(Order::Middle).constrain_to(canvas.shrink(EDGE));
    area.fixed_pos(canvas.min + vec2(SPACE, SPACE)).show(ui.ctx(), |ui| {
        frame.show(ui, |ui| {
            // On a narrow canvas it wraps to two lines or more.
            ui.set_max_width((canvas.width() - SPACE - EDGE - frame.total_margin().sum().x).max(LEAST_WIDTH));
            let mut refused = String::new();
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(8.0, 4.0);
                ui.label(crate::app::look::widgets::strong(tool.title, theme::BODY));
                ui.add_space(8.0);
                for option in tool.options {
                    let (id, name) = match option {
                        ToolOption::Length { command, name, least_m, most_m, now_m, is_shown } => {
                            let options = app.tools.options;
                            if !is_shown(&options) {
                                continue;
                            }
                            let (range_m, units) = (*least_m..=*most_m, app.units());
                            let field = LengthField {
                                name,
                                now_m: now_m(&options),
                                range_m,
                                units,
                                width: FIELD,
                                name_width: None,
                            };
                            let entered = field.show(ui);
                            if let Some(length_m) = entered.length_m {
                                let to_the_millimetre = (length_m * 1000.0).round() / 1000.0;
                                let context = ui.ctx().clone();
                                app.act_on(Call::new(command, [Value::Number(to_the_millimetre)]), &context);
                                if trim_m(length_m) != to_the_millimetre {
                                    let taken = units.exact_length(to_the_millimetre);
                                    app.session.status = format!("{name}: {taken}, rounded to the millimetre");
                                }
                            }
                            if !entered.refused.is_empty() {
                                refused = entered.refused;
                            }
                            continue;
                        }
                        ToolOption::Switch { command, name } => (command, name),
                        ToolOption::Choice { command, name, now } => {
                            let Some(command) = commands::find(command) else { continue };
                            let response = ui.button(format!("{name}: {}", now(&app.tools.options)));
                            if response.on_hover_text(format!("{}\n{}", command.title, command.help)).clicked() {
                                // Without what it asks for, it goes on to the next.
                                app.act_on(Call::new(command.id, []), &ui.ctx().clone());
                            }
                            continue;
                        }
                    };
                    let Some(command) = commands::find(id) else { continue };
                    let is_on = command.is_on(app) == Some(true);
                    let response = toggle(ui, name, is_on);
                    let keys = app.keys_text(command, ui.ctx());
                    let keys = if keys.is_empty() { keys } else { format!("  {keys}") };
                    if response.on_hover_text(format!("{}{keys}\n{}", command.title, command.help)).clicked() {
                        let context = ui.ctx().clone();
                        app.run_command(id, &context);
                    }
                }
            });
            if !refused.is_empty() {
                let colour = colours(ui).error;
                ui.label(RichText::new(refused).size(theme::SMALL).color(colour));
            }
        });
    });
}

/// Distance between the bar and the canvas's edges, in points: clear of the rulers.
const SPACE: f32 = 30.0;

/// Margin left at the canvas's edges, in points.
const EDGE: f32 = 4.0;

/// Width of a field for a length, in points.
const FIELD: f32 = 72.0;

/// The bar is at least so wide, in points, on however small a canvas.
const LEAST_WIDTH: f32 = 120.0;
