//! Why a room gets its predicted label: what was seen, point by point. The plan shows what the pointer is on.

use egui::epaint::StrokeKind;
use egui::text::{LayoutJob, TextFormat};
use egui::{Align2, Color32, FontId, Rect, Role, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::app::look::theme;
use crate::app::look::widgets::{caption, colours, focus_ring, follow_focus};
use crate::base::units::Units;
use crate::base::wording::{sentence, unbroken};
use crate::classify::explain::NearRoom;
use crate::classify::why::{Point, Why};
use crate::draw::Palette;
use crate::features::Features;
use crate::labels::Label;

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

/// Height of the row of thumbnails, and the space of each, in points.
const THUMBNAILS: f32 = 56.0;
const THUMBNAIL: f32 = 50.0;

/// The rooms of the training data that are most like this one, as rectangles of their areas and axes ratios, all at one scale
/// with this room before them: outlines of the rooms themselves are not kept in a model.
pub(super) fn nearest(ui: &mut Ui, palette: &Palette, own: &Features, near: &[NearRoom], units: Units) {
    let sides_m = |values: &[f64; 8]| {
        let (area_m2, ratio) = (values[0].max(0.01), values[1].max(1.0));
        vec2((area_m2 * ratio).sqrt() as f32, (area_m2 / ratio).sqrt() as f32)
    };
    let fits = ((ui.available_width() / THUMBNAIL) as usize).max(2);
    let shown: Vec<&NearRoom> = near.iter().take(fits - 1).collect();
    let own = own.values();
    let longest_m = shown.iter().map(|room| sides_m(&room.values).x).fold(sides_m(&own).x, f32::max);
    let scale = (THUMBNAIL - 8.0) / longest_m.max(0.1);
    ui.add_space(4.0);
    caption(ui, "Most like it among the rooms learned from");
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        let first = std::iter::once((&own, None, String::new()));
        let others = shown.iter().map(|room| {
            let source = &room.source;
            (&room.values, Some(room.label), format!("{} in {}", source.room, source.plan))
        });
        for (values, label, name) in first.chain(others) {
            let (rect, response) = ui.allocate_exact_size(vec2(THUMBNAIL, THUMBNAILS), Sense::hover());
            let size = sides_m(values) * scale;
            let place = Rect::from_center_size(rect.center(), size.max(vec2(3.0, 3.0)));
            let ink = colours(ui).text;
            match label {
                Some(label) => {
                    ui.painter().rect_filled(place, 1.0, theme::colour(palette.label(label)));
                    ui.painter().rect_stroke(place, 1.0, Stroke::new(1.0, colours(ui).text_weak), StrokeKind::Inside);
                }
                None => drop(ui.painter().rect_stroke(place, 1.0, Stroke::new(2.0, ink), StrokeKind::Inside)),
            }
            let text = label.map_or("?", Label::letter);
            let font = FontId::proportional(theme::SMALL);
            ui.painter().text(place.center(), Align2::CENTER_CENTER, text, font, theme::colour(palette.ink));
            // Its openings, as dots below.
            let openings = (values[2].max(0.0) as usize).min(9);
            for index in 0..openings {
                let x = rect.center().x + (index as f32 - (openings as f32 - 1.0) / 2.0) * 5.0;
                ui.painter().circle_filled(pos2(x, rect.bottom() - 3.0), 1.5, colours(ui).text_weak);
            }
            let measures = format!("{}, axes ratio {:.1}, openings {:.0}", units.area(values[0]), values[1], values[2]);
            let said = match label {
                Some(label) => format!("{name}: {label}, {measures}"),
                None => format!("This room: {measures}"),
            };
            response.widget_info(|| WidgetInfo::labeled(Role::Image, true, said.clone()));
            response.on_hover_text(said);
        }
    });
}

/// A point; returns whether the pointer or the keyboard is on it.
fn point(ui: &mut Ui, title: &str, point: &Point) -> bool {
    let colours = colours(ui);
    let format = TextFormat::simple(FontId::proportional(theme::BODY), colours.text);
    let mut job = LayoutJob::single_section(unbroken(&sentence(&point.seen)), format);
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
