//! Pictures of plans, side by side. Only the lines on the screen are laid out.

use egui::{FontId, Rect, ScrollArea, Sense, Ui, pos2, vec2};

use super::cells;
use super::table::{clicked, describe, ground};
use super::{Act, Table, nothing, plan_in_words};
use crate::app::look::icons::Icon;
use crate::app::look::theme;
use crate::app::look::widgets::{colours, put_line};
use crate::app::session::workspace::OpenWorkspace;
use crate::app::state::App;
use crate::base::wording::count;
use crate::workspace::{Content, PlanRow};

/// The least width of a picture with its text, and its height.
const WIDE: f32 = 176.0;
const HIGH: f32 = 172.0;
const GAP: f32 = 10.0;
const TEXT: f32 = 42.0;

pub(super) fn show(table: &mut Table, app: &mut App, ui: &mut Ui) -> Option<Act> {
    let Some(OpenWorkspace { view, revision, .. }) = &app.session.workspace else { return None };
    let (length, cursor, revision) = (view.len(), view.cursor, *revision);
    if length == 0 {
        nothing(app, ui);
        return None;
    }
    let width = ui.available_width() - 12.0;
    let columns = ((width + GAP) / (WIDE + GAP)).floor().max(1.0) as usize;
    let wide = ((width + GAP) / columns as f32 - GAP).floor();
    table.columns = columns;
    let height = ui.available_height();
    table.rows_seen = (height / (HIGH + GAP)) as usize;
    let mut act = None;
    let mut area = ScrollArea::vertical().id_salt("pictures").auto_shrink(false);
    if table.follows_cursor {
        let offset: f32 = ui.data(|data| data.get_temp(egui::Id::unique("pictures scrolled"))).unwrap_or_default();
        let top = (cursor / columns) as f32 * (HIGH + GAP);
        area = area.vertical_scroll_offset(offset.clamp((top + HIGH - height).max(0.0), top));
    }
    ui.spacing_mut().item_spacing.y = GAP;
    let output = area.show_rows(ui, HIGH, length.div_ceil(columns), |ui, lines| {
        for line in lines {
            let (whole, _) = ui.allocate_exact_size(vec2(width, HIGH), Sense::hover());
            for column in 0..columns {
                let row = line * columns + column;
                let found = app.session.workspace.as_ref().and_then(|it| it.view.rows.plans.get(row).copied());
                let Some(found) = found else { break };
                let left = whole.left() + column as f32 * (wide + GAP);
                let rect = Rect::from_min_size(pos2(left, whole.top()), vec2(wide, HIGH));
                let response = ui.interact(rect, ui.scope_id().with(("picture", row)), Sense::click());
                let is_selected = app.session.workspace.as_ref().is_some_and(|it| it.view.is_selected(row));
                card(table, app, ui, rect, found, revision);
                ground_over(ui, rect, &response, is_selected, row == cursor);
                let (name, said) = plan_in_words(app, found);
                describe(&response, is_selected, &name, &said);
                act = clicked(app, ui, &response, row).or(act.take());
                response.on_hover_text(format!("{name}: {said}"));
            }
        }
    });
    ui.data_mut(|data| data.insert_temp(egui::Id::unique("pictures scrolled"), output.state.clamped_offset().y));
    act
}

/// The frame of a picture: what is selected and under the pointer is seen around it.
fn ground_over(ui: &Ui, rect: Rect, response: &egui::Response, is_selected: bool, has_cursor: bool) {
    let colours = colours(ui);
    let (width, colour) = match (is_selected, has_cursor || response.hovered()) {
        (true, _) => (2.0, colours.accent),
        (false, true) => (1.0, colours.accent),
        (false, false) => (1.0, colours.border),
    };
    let stroke = egui::Stroke::new(width, colour);
    ui.painter().rect_stroke(rect, theme::RADIUS, stroke, egui::epaint::StrokeKind::Inside);
    if response.has_focus() {
        ground(ui, rect.expand(2.0), response, false, false);
    }
}

fn card(table: &mut Table, app: &App, ui: &Ui, rect: Rect, row: PlanRow, revision: u64) {
    let Some(OpenWorkspace { view, .. }) = &app.session.workspace else { return };
    let Some((file, plan)) = view.rows.of.plan(row) else { return };
    let colours = colours(ui);
    ui.painter().rect_filled(rect, theme::RADIUS, colours.panel);
    let picture = Rect::from_min_max(rect.min, pos2(rect.right(), rect.bottom() - TEXT)).shrink(10.0);
    let text = Rect::from_min_max(pos2(rect.left(), rect.bottom() - TEXT), rect.max).shrink2(vec2(10.0, 2.0));
    let upper = text.with_max_y(text.center().y);
    let lower = text.with_min_y(text.center().y - 3.0);
    let (body, small) = (FontId::proportional(theme::BODY), FontId::proportional(theme::SMALL));
    match (plan, view.rows.of.plan_key(row)) {
        (Some(plan), Some(key)) => {
            table.thumbnails.paint(ui, picture, &key, plan, app.session.palette(ui), revision);
            put_line(ui, file.title_of(plan), body, colours.text, upper);
            let problems = plan.problems.total();
            let share = cells::percent(plan.labelled, plan.to_label);
            let mut said = format!("{} · {share}", count(plan.rooms.len(), "room"));
            if !plan.storey.is_empty() {
                said = format!("{} · {said}", plan.storey);
            }
            let mut line = lower;
            if problems > 0 {
                let mark = Rect::from_center_size(pos2(lower.right() - 8.0, lower.center().y), vec2(14.0, 14.0));
                let colour = if plan.problems.errors > 0 { colours.error } else { colours.warning };
                Icon::Warning.paint(ui.painter(), mark, colour);
                line.max.x -= 20.0;
            }
            put_line(ui, &said, small, colours.text_weak, line);
        }
        _ => {
            let (said, colour) = match file.content {
                Content::Broken(_) => ("Cannot be read", colours.error),
                _ => ("Not read yet", colours.text_weak),
            };
            let mark = Rect::from_center_size(picture.center(), vec2(24.0, 24.0));
            let icon = if matches!(file.content, Content::Broken(_)) { Icon::Warning } else { Icon::Plan };
            icon.paint(ui.painter(), mark, colour);
            put_line(ui, file.name(), body, colours.text, upper);
            put_line(ui, said, small, colour, lower);
        }
    }
}
