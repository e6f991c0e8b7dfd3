//! The welcome screen, shown when no plan is open, and the drop target for dragged files.

use std::path::PathBuf;

use egui::emath::GuiRounding as _;
use egui::epaint::StrokeKind;
use egui::{
    Align, Align2, FontId, Id, Label, LayerId, Layout, Order, Rect, Response, RichText, Role, ScrollArea, Sense,
    Stroke, Ui, UiBuilder, Vec2, WidgetInfo, pos2, vec2,
};

use crate::app::commands;
use crate::app::look::{
    icons::Icon,
    theme,
    widgets::{Lead, ROW, Row, colours, follow_focus, link, section, strong, text_button},
};
use crate::app::session::origin::{Origin, bundled, file_name};
use crate::app::state::App;
use crate::app::value::{Call, Value};
use crate::base::wording::count;
use crate::draw::{Layers, Style, View};
use crate::plan::Plan;

/// Size of a sample's card, in points.
const CARD: Vec2 = vec2(208.0, 168.0);

/// How many of the files opened last are shown at once.
const SHOWN_RECENT: usize = 5;

/// Space that the words beside the buttons need, in points.
const HINT_WIDTH: f32 = 190.0;

/// Space between cards.
const GAP: f32 = 16.0;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let rect = ui.available_rect_before_wrap();
    let palette = app.session.palette(ui);
    ui.painter().rect_filled(rect, 0.0, theme::colour(palette.paper));
    let samples = bundled().len();
    let recent: Vec<PathBuf> = app.session.settings.recent();
    let recent_height = if recent.is_empty() { 0.0 } else { 54.0 + recent.len().min(SHOWN_RECENT) as f32 * ROW };
    let columns = ((rect.width() - 48.0 + GAP) / (CARD.x + GAP)).floor().clamp(1.0, 3.0);
    let rows = (samples as f32 / columns).ceil();
    let size = vec2(columns * (CARD.x + GAP) - GAP, 178.0 + recent_height + rows * (CARD.y + GAP));
    let column = Rect::from_center_size(rect.center(), size.min(rect.size())).round_to_pixels(ui.pixels_per_point());
    let mut ui = ui.new_child(UiBuilder::new().max_rect(column).layout(Layout::top_down(Align::Min)));
    ScrollArea::vertical().show(&mut ui, |ui| {
        ui.label(strong("Enfilade", theme::DISPLAY));
        ui.add_space(2.0);
        let text =
            "Draw or open a floor plan, and see its rooms, how doors connect them, and what each room is likely to be.";
        ui.add(Label::new(RichText::new(text).color(colours(ui).text_weak)).wrap());
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let buttons =
                [("new-plan", "New plan"), ("open", "Open a plan…"), ("demonstration", "Watch a demonstration")];
            for (id, title) in buttons {
                let Some(command) = commands::find(id) else { continue };
                let keys = app.keys_text(command, ui.ctx());
                let help = if keys.is_empty() { command.help.to_owned() } else { format!("{} ({keys})", command.help) };
                if text_button(ui, title, id == "new-plan").on_hover_text(help).clicked() {
                    let context = ui.ctx().clone();
                    app.run_command(command.id, &context);
                }
            }
            // In a narrow window there is no space for it.
            if ui.available_width() > HINT_WIDTH {
                ui.add_space(4.0);
                let hint = "or drop a file anywhere here";
                ui.label(RichText::new(hint).color(colours(ui).text_weak));
            }
        });
        ui.add_space(20.0);
        if !recent.is_empty() {
            section(ui, "Recent");
            ui.add_space(2.0);
            recent_rows(app, ui, &recent);
            ui.add_space(20.0);
        }
        if samples == 0 {
            return;
        }
        section(ui, "Samples");
        ui.add_space(4.0);
        ui.spacing_mut().item_spacing = Vec2::splat(GAP);
        ui.horizontal_wrapped(|ui| {
            for (index, (_, plan)) in bundled().iter().enumerate() {
                if card(app, ui, index, plan).clicked() {
                    let context = ui.ctx().clone();
                    app.open_listed(&Origin::Bundled(index), &context);
                }
            }
        });
    });
}

/// The files opened last. One that is not there is marked, and can be tried all the same.
fn recent_rows(app: &mut App, ui: &mut Ui, recent: &[PathBuf]) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut wanted = None;
    for path in recent.iter().take(SHOWN_RECENT) {
        let folder = path.parent().map(|folder| app.session.shown_path(folder)).unwrap_or_default();
        let is_missing = app.session.missing.contains(path);
        let name = file_name(path);
        let (icon, trail) = match is_missing {
            true => (Icon::Warning, format!("missing from {folder}")),
            false => (Icon::Plan, folder),
        };
        let row = Row::new(Lead::Icon(icon), &name).trail(&trail);
        let row = if is_missing { row.muted() } else { row };
        if row.button(ui, Role::Button).on_hover_text(app.session.shown_path(path)).clicked() {
            wanted = Some(path.clone());
        }
    }
    let context = ui.ctx().clone();
    if let Some(path) = wanted {
        app.act_on(Call::new("open", [Value::Path(path)]), &context);
    }
    if recent.len() > SHOWN_RECENT && link(ui, "More…").clicked() {
        app.run_command("open-recent", &context);
    }
}

/// A sample with its thumbnail.
fn card(app: &mut App, ui: &mut Ui, index: usize, plan: &Plan) -> Response {
    let (rect, response) = ui.allocate_exact_size(CARD, Sense::click());
    follow_focus(&response);
    let colours = colours(ui);
    let radius = f32::from(theme::RADIUS_LARGE);
    let ground = if response.hovered() { colours.hover } else { colours.panel };
    ui.painter().rect_filled(rect, radius, ground);
    let rim = if response.has_focus() { Stroke::new(2.0, colours.accent) } else { Stroke::new(1.0, colours.outline) };
    ui.painter().rect_stroke(rect, radius, rim, StrokeKind::Inside);
    let picture = Rect::from_min_max(rect.min + vec2(14.0, 12.0), rect.max - vec2(14.0, 50.0));
    let (theme, label_colours) = (app.session.palette(ui).theme, app.session.layers.colours);
    let sample = app.samples.get(index, plan);
    let (width_px, height_px) = (f64::from(picture.width()), f64::from(picture.height()));
    let view = View {
        pixel_ratio: f64::from(ui.pixels_per_point()),
        ..View::fitting(sample.derived.drawing.bounds(), width_px, height_px, 0.0)
    };
    let layers = Layers { names: false, areas: false, ..Layers::default() };
    let style = Style { theme, label_colours, layers, ..Style::default() };
    sample.painter.paint(&ui.painter_at(picture), picture, &sample.derived, &style, &view);
    let title = FontId::new(theme::BODY, theme::semibold());
    let at = pos2(rect.left() + 14.0, rect.bottom() - 31.0);
    ui.painter().text(at, Align2::LEFT_CENTER, &plan.meta().name, title, colours.text);
    let passable = plan.openings().filter(|(_, opening)| opening.kind.is_passable()).count();
    let contents = format!("{}, {}", count(plan.rooms().len(), "room"), count(passable, "opening"));
    let small = FontId::proportional(theme::SMALL);
    ui.painter().text(at + vec2(0.0, 16.0), Align2::LEFT_CENTER, contents, small, colours.text_weak);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &plan.meta().name));
    response
}

/// Shows that a dragged file can be dropped.
pub(super) fn show_drop_target(ui: &Ui) {
    if ui.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let colours = colours(ui);
    let rect = ui.max_rect().shrink(12.0);
    let painter = ui.ctx().layer_painter(LayerId::new(Order::Foreground, Id::unique("drop target")));
    painter.rect_filled(rect, f32::from(theme::RADIUS_LARGE), colours.accent_soft.gamma_multiply(0.92));
    painter.rect_stroke(rect, f32::from(theme::RADIUS_LARGE), Stroke::new(2.0, colours.accent), StrokeKind::Inside);
    let font = FontId::new(theme::TITLE, theme::semibold());
    painter.text(rect.center(), Align2::CENTER_CENTER, "Drop to open", font, colours.text);
}
