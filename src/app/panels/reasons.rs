//! Why a room gets its predicted label: what was seen, point by point. The plan shows what the pointer is on.

use egui::text::{LayoutJob, TextFormat};
use egui::{Color32, FontId, Role, Sense, Ui, WidgetInfo, vec2};

use crate::app::look::theme;
use crate::app::look::widgets::{caption, colours, focus_ring, follow_focus};
use crate::base::wording::sentence;
use crate::classify::why::{Point, Why};

/// Around the text of a point, in points.
const MARGIN: f32 = 8.0;
const GAP: f32 = 3.0;

/// From the mark before a point to its text.
const INDENT: f32 = 12.0;

/// Shows the reason; returns the point that the pointer or the keyboard is on.
pub(super) fn show<'a>(ui: &mut Ui, why: &'a Why) -> Option<&'a Point> {
    let mut pointed = None;
    for group in why.groups() {
        ui.add_space(4.0);
        caption(ui, group.title.as_str());
        ui.spacing_mut().item_spacing.y = 0.0;
        for seen in group.points {
            if point(ui, &group.title, seen) {
                pointed = Some(seen);
            }
        }
        ui.spacing_mut().item_spacing.y = 4.0;
    }
    if !why.conclusion.is_empty() {
        ui.add_space(4.0);
        caption(ui, why.conclusion.as_str());
    }
    pointed
}

/// A point; returns whether the pointer or the keyboard is on it.
fn point(ui: &mut Ui, title: &str, point: &Point) -> bool {
    let colours = colours(ui);
    let format = TextFormat::simple(FontId::proportional(theme::BODY), colours.text);
    let mut job = LayoutJob::single_section(sentence(&point.seen), format);
    job.wrap.max_width = ui.available_width() - INDENT;
    let galley = ui.painter().layout_job(job);
    let size = vec2(ui.available_width(), galley.size().y + 2.0 * GAP);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    follow_focus(&response);
    let around = rect.expand2(vec2(MARGIN, 0.0));
    let is_on = response.hovered() || response.has_focus();
    if is_on {
        ui.painter().rect_filled(around, 6.0, colours.hover);
    }
    let line = galley.rows.first().map_or(galley.size().y, |row| row.rect().height());
    ui.painter().circle_filled(rect.min + vec2(INDENT / 2.0 - 2.0, GAP + line / 2.0), 2.0, colours.text_weak);
    ui.painter().galley(rect.min + vec2(INDENT, GAP), galley, Color32::PLACEHOLDER);
    focus_ring(ui, around, &response);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{title}: {}", point.seen)));
    is_on
}
