//! The options of the active tool, in a bar floating over the canvas, so that nothing moves when it
//! appears.

use egui::{Area, DragValue, Frame, Id, Margin, Order, RichText, Ui, vec2};

use crate::app::commands;
use crate::app::look::{
    theme,
    widgets::{colours, toggle},
};
use crate::app::state::App;
use crate::app::tools::ToolOption;
use crate::app::value::{Call, Value};
use crate::base::units::Units;

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
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(8.0, 4.0);
                ui.label(crate::app::look::widgets::strong(tool.title, theme::BODY));
                ui.add_space(8.0);
                for option in tool.options {
                    let (id, name) = match option {
                        ToolOption::Length { command, name, least_m, most_m, now_m, is_shown } => {
                            let options = app.tools.options;
                            if is_shown(&options) {
                                length(app, ui, name, command, now_m(&options), *least_m..=*most_m);
                            }
                            continue;
                        }
                        ToolOption::Switch { command, name } => (command, name),
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
        });
    });
}

/// Distance between the bar and the canvas's edges, in points: clear of the rulers.
const SPACE: f32 = 30.0;

/// Margin left at the canvas's edges, in points.
const EDGE: f32 = 4.0;

/// The bar is at least so wide, in points, on however small a canvas.
const LEAST_WIDTH: f32 = 120.0;

/// A length that is dragged or typed, in metres.
fn length(
    app: &mut App,
    ui: &mut Ui,
    name: &str,
    command: &'static str,
    now_m: f64,
    range: std::ops::RangeInclusive<f64>,
) {
    let label = ui.label(RichText::new(name).color(colours(ui).text_weak));
    let mut value_m = now_m;
    let units = app.units();
    let field = DragValue::new(&mut value_m).speed(0.005).range(range);
    let field = match units {
        Units::Metric => field.max_decimals(3).min_decimals(2).suffix(" m"),
        Units::Imperial => field
            .custom_formatter(move |value_m, _| units.exact_length(value_m))
            .custom_parser(move |typed| units.parse_length(typed).ok()),
    };
    let response = ui.add(field).labelled_by(label.id);
    if response.changed() {
        let to_the_millimetre = Value::Number((value_m * 1000.0).round() / 1000.0);
        let context = ui.ctx().clone();
        app.act_on(Call::new(command, [to_the_millimetre]), &context);
    }
}
