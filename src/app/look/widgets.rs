//! The controls used by the panels. Each has a name for screen readers and scripts.

use egui::epaint::StrokeKind;
use egui::text::{LayoutJob, TextFormat};
use egui::{
    Align, Color32, CornerRadius, FontId, Galley, Pos2, Rect, Response, RichText, Role, Sense, Stroke, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

use crate::app::look::icons::Icon;
use crate::app::look::theme::{self, Colours, RADIUS};

/// Height of rows and fields, in points.
pub(crate) const ROW: f32 = 28.0;

/// Side of an icon.
pub(crate) const ICON: f32 = 16.0;

pub(crate) fn colours(ui: &Ui) -> &'static Colours {
    theme::colours(ui.visuals())
}

/// A line of text, cut with an ellipsis at a width.
fn line(ui: &Ui, text: &str, font: FontId, colour: Color32, width: f32) -> Arc<Galley> {
    let mut job = LayoutJob::single_section(text.to_owned(), TextFormat::simple(font, colour));
    job.wrap.max_width = width.max(0.0);
    job.wrap.max_rows = 1;
    job.wrap.break_anywhere = true;
    ui.painter().layout_job(job)
}

/// Places a galley on whole pixels, vertically centred at `middle`.
pub(crate) fn put(ui: &Ui, galley: Arc<Galley>, left: f32, middle: f32) {
    let pixels_per_point = ui.pixels_per_point();
    let on_pixel = |value: f32| (value * pixels_per_point).round() / pixels_per_point;
    let at = pos2(on_pixel(left), on_pixel(middle - galley.rect.height() / 2.0));
    ui.painter().galley(at, galley, Color32::PLACEHOLDER);
}

/// Scrolls the control that has just got the keyboard into view.
pub(crate) fn follow_focus(response: &Response) {
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
}

/// The ring around the control that has the keyboard.
pub(crate) fn focus_ring(ui: &Ui, rect: Rect, response: &Response) {
    if response.has_focus() {
        let stroke = Stroke::new(2.0, colours(ui).accent);
        ui.painter().rect_stroke(rect, CornerRadius::same(RADIUS), stroke, StrokeKind::Inside);
    }
}

/// Text of a size and colour in semibold.
pub(crate) fn strong(text: impl Into<String>, size: f32) -> RichText {
    RichText::new(text).font(FontId::new(size, theme::semibold()))
}

/// The title of a section of a panel.
pub(crate) fn section(ui: &mut Ui, title: &str) {
    let colour = colours(ui).text_weak;
    ui.label(strong(title, theme::SMALL).color(colour));
}

/// Small secondary text that wraps.
pub(crate) fn caption(ui: &mut Ui, text: impl Into<String>) -> Response {
    let colour = colours(ui).text_weak;
    ui.add(egui::Label::new(RichText::new(text).size(theme::SMALL).color(colour)).wrap())
}

/// How far something is, 0..=1: a bar as wide as there is room, with a name for screen readers.
pub(crate) fn progress_bar(ui: &mut Ui, share: f64, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 10.0), Sense::hover());
    let track = rect.shrink2(vec2(0.0, 2.0));
    let (colours, radius) = (colours(ui), track.height() / 2.0);
    ui.painter().rect_filled(track, radius, colours.border);
    let share = share.clamp(0.0, 1.0);
    // A bit that has begun can be seen.
    let width = if share > 0.0 { (track.width() * share as f32).max(track.height()) } else { 0.0 };
    ui.painter().rect_filled(Rect::from_min_size(track.min, vec2(width, track.height())), radius, colours.accent);
    let name = name.to_owned();
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &name));
    response
}

/// A hairline across a panel, edge to edge.
pub(crate) fn hairline(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 15.0), Sense::hover());
    let x = ui.clip_rect().x_range();
    ui.painter().hline(x, rect.center().y, Stroke::new(1.0, colours(ui).border));
}

/// A hairline across its container, without space around it.
pub(crate) fn hairline_in(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 1.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(1.0, colours(ui).border));
}

/// A line of text at the left of a rectangle, vertically centred, cut at its right edge.
pub(crate) fn put_line(ui: &Ui, text: &str, font: FontId, colour: Color32, rect: Rect) {
    let galley = line(ui, text, font, colour, rect.width());
    put(ui, galley, rect.left(), rect.center().y);
}

/// A square button with an icon.
pub(crate) fn icon_button(ui: &mut Ui, icon: Icon, name: &str, is_on: Option<bool>) -> Response {
    let (rect, response) = ui.allocate_exact_size(Vec2::splat(ROW), Sense::click());
    if ui.is_rect_visible(rect) {
        let colours = colours(ui);
        let ground = if !ui.is_enabled() {
            Color32::TRANSPARENT
        } else if response.is_pointer_button_down_on() {
            colours.pressed
        } else if is_on == Some(true) {
            colours.accent_soft
        } else if response.hovered() {
            colours.hover
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(rect, RADIUS, ground);
        let colour = match is_on {
            _ if !ui.is_enabled() => colours.text_weak.gamma_multiply(0.5),
            Some(true) => colours.accent,
            Some(false) => colours.text_weak,
            None => colours.text,
        };
        icon.paint(ui.painter(), Rect::from_center_size(rect.center(), Vec2::splat(ICON)), colour);
        focus_ring(ui, rect, &response);
    }
    response.widget_info(|| match is_on {
        Some(is_on) => WidgetInfo::selected(Role::Button, ui.is_enabled(), is_on, name),
        None => WidgetInfo::labeled(Role::Button, ui.is_enabled(), name),
    });
    response
}

/// The leading element of a row.
#[derive(Clone, Copy)]
pub(crate) enum Lead {
    None,
    Icon(Icon),
    /// A colour swatch.
    Swatch(Color32),
    /// A tick, or the space for one.
    Tick(bool),
    /// An open or a closed eye.
    Eye(bool),
}

/// A row across a panel: a leading element, a text, and a trailing text.
pub(crate) struct Row<'a> {
    pub lead: Lead,
    pub text: &'a str,
    /// At the right, in the secondary colour.
    pub trail: &'a str,
    /// Selected in a list.
    pub is_selected: bool,
    /// For something on or off: its state.
    pub is_on: Option<bool>,
    /// In the secondary colour.
    pub is_muted: bool,
    /// Indent of its start, in points.
    pub indent: f32,
    /// Inset of its end, in points.
    pub inset: f32,
}

impl<'a> Row<'a> {
    pub(crate) fn new(lead: Lead, text: &'a str) -> Self {
        Self { lead, text, trail: "", is_selected: false, is_on: None, is_muted: false, indent: 0.0, inset: 0.0 }
    }

    pub(crate) fn trail(self, trail: &'a str) -> Self {
        Self { trail, ..self }
    }

    pub(crate) fn selected(self, is_selected: bool) -> Self {
        Self { is_selected, ..self }
    }

    pub(crate) fn on(self, is_on: bool) -> Self {
        Self { is_on: Some(is_on), ..self }
    }

    pub(crate) fn muted(self) -> Self {
        Self { is_muted: true, ..self }
    }

    /// Inset at both ends.
    pub(crate) fn inset(self, inset: f32) -> Self {
        Self { indent: inset, inset, ..self }
    }

    /// Inset at its end, for what stands there.
    pub(crate) fn inset_end(self, inset: f32) -> Self {
        Self { inset, ..self }
    }

    pub(crate) fn indent(self, indent: f32) -> Self {
        Self { indent, ..self }
    }

    /// Shows it as something to click.
    pub(crate) fn button(self, ui: &mut Ui, role: Role) -> Response {
        self.show(ui, ROW, Some(role))
    }

    /// Shows it as something to read.
    pub(crate) fn show_only(self, ui: &mut Ui) -> Response {
        self.show(ui, 22.0, None)
    }

    fn show(self, ui: &mut Ui, height: f32, role: Option<Role>) -> Response {
        let sense = if role.is_some() { Sense::click() } else { Sense::hover() };
        let (rect, mut response) = ui.allocate_exact_size(vec2(ui.available_width(), height), sense);
        let is_enabled = ui.is_enabled();
        match role {
            Some(role) => {
                response.widget_info(|| {
                    WidgetInfo::selected(role, is_enabled, self.is_on.unwrap_or(self.is_selected), self.text)
                });
            }
            None => response.widget_info(|| {
                WidgetInfo::labeled(Role::Label, is_enabled, format!("{} {}", self.text, self.trail).trim())
            }),
        }
        follow_focus(&response);
        if !ui.is_rect_visible(rect) {
            return response;
        }
        let colours = colours(ui);
        if role.is_some() {
            let ground = if self.is_selected {
                colours.accent_soft
            } else if response.is_pointer_button_down_on() {
                colours.pressed
            } else if response.hovered() {
                colours.hover
            } else {
                Color32::TRANSPARENT
            };
            ui.painter().rect_filled(rect, RADIUS, ground);
        }
        let text_colour = match (is_enabled, self.is_muted || self.is_on == Some(false)) {
            (false, _) => colours.text_weak.gamma_multiply(0.6),
            (true, true) => colours.text_weak,
            (true, false) => colours.text,
        };
        let middle = rect.center().y;
        // Something clickable has a background that extends beyond its text.
        let pad = if role.is_some() { 8.0 } else { 0.0 };
        let mut left = rect.left() + pad + self.indent;
        match self.lead {
            Lead::None => {}
            Lead::Icon(icon) => {
                let colour = if self.is_selected { colours.accent } else { colours.text_weak };
                let square = Rect::from_center_size(pos2(left + ICON / 2.0, middle), Vec2::splat(ICON));
                icon.paint(ui.painter(), square, colour.gamma_multiply(if is_enabled { 1.0 } else { 0.6 }));
                left += ICON + 8.0;
            }
            Lead::Eye(is_open) => {
                let square = Rect::from_center_size(pos2(left + ICON / 2.0, middle), Vec2::splat(ICON));
                let icon = if is_open { Icon::Eye } else { Icon::EyeOff };
                icon.paint(ui.painter(), square, text_colour);
                left += ICON + 8.0;
            }
            Lead::Swatch(colour) => {
                swatch(ui, pos2(left + 6.0, middle), colour);
                left += 12.0 + 8.0;
            }
            Lead::Tick(is_on) => {
                if is_on {
                    let square = Rect::from_center_size(pos2(left + ICON / 2.0, middle), Vec2::splat(ICON));
                    Icon::Check.paint(ui.painter(), square, text_colour);
                }
                left += ICON + 6.0;
            }
        }
        let right = rect.right() - pad - self.inset;
        let trail = line(ui, self.trail, FontId::proportional(theme::SMALL), colours.text_weak, right - left);
        let trail_width = trail.rect.width();
        put(ui, trail, right - trail_width, middle);
        let font = FontId::proportional(if self.is_muted { theme::SMALL } else { theme::BODY });
        let gap = if self.trail.is_empty() { 0.0 } else { 10.0 };
        let text = line(ui, self.text, font, text_colour, right - trail_width - gap - left);
        let is_elided = text.elided;
        put(ui, text, left, middle);
        focus_ring(ui, rect, &response);
        if is_elided {
            response = response.on_hover_text(self.text);
        }
        response
    }
}

/// A colour swatch of 12 points.
pub(crate) fn swatch(ui: &Ui, centre: Pos2, colour: Color32) {
    let square = Rect::from_center_size(centre, Vec2::splat(12.0));
    ui.painter().rect_filled(square, 3.0, colour);
    let rim = colours(ui).text.gamma_multiply(0.22);
    ui.painter().rect_stroke(square, 3.0, Stroke::new(1.0, rim), StrokeKind::Inside);
}

/// One choice of a segmented control.
pub(crate) struct Segment<'a> {
    pub text: &'a str,
    /// Its full name.
    pub name: &'a str,
    pub help: &'a str,
    pub is_on: bool,
    /// The background when on; `None` for the theme's.
    pub colour: Option<Color32>,
}

/// Alternatives side by side, one of them on. Returns the index of one that was clicked.
pub(crate) fn segmented(ui: &mut Ui, segments: &[Segment<'_>]) -> Option<usize> {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let colours = colours(ui);
    ui.painter().rect_filled(rect, RADIUS, colours.field);
    let inner = rect.shrink(2.0);
    // Each as wide as its text needs when on; the rest is shared.
    let font = |is_on: bool| {
        if is_on { FontId::new(theme::BODY, theme::semibold()) } else { FontId::proportional(theme::BODY) }
    };
    let widths: Vec<f32> = segments
        .iter()
        .map(|segment| line(ui, segment.text, font(true), colours.text, f32::INFINITY).size().x)
        .collect();
    let spare = (inner.width() - widths.iter().sum::<f32>()) / segments.len().max(1) as f32;
    let mut left = inner.left();
    let mut clicked = None;
    for (index, segment) in segments.iter().enumerate() {
        let width = (widths[index] + spare).max(0.0);
        let cell = Rect::from_min_size(pos2(left, inner.top()), vec2(width, inner.height()));
        let id = ui.scope_id().with(("segment", segment.name));
        let response = ui.interact(cell, id, Sense::click());
        let radius = RADIUS - 2;
        if segment.is_on {
            let ground = segment.colour.unwrap_or(colours.raised);
            ui.painter().rect_filled(cell, radius, ground);
            let rim = Stroke::new(1.0, colours.outline);
            ui.painter().rect_stroke(cell, radius, rim, StrokeKind::Inside);
        } else if response.hovered() {
            ui.painter().rect_filled(cell, radius, colours.hover);
        }
        let is_strong = segment.is_on;
        let colour = if is_strong { colours.text } else { colours.text_weak };
        let text = line(ui, segment.text, font(is_strong), colour, cell.width());
        let start = cell.center().x - text.rect.width() / 2.0;
        put(ui, text, start, cell.center().y);
        focus_ring(ui, cell, &response);
        response.widget_info(|| WidgetInfo::selected(Role::RadioButton, ui.is_enabled(), segment.is_on, segment.name));
        if response.on_hover_text(segment.help).clicked() {
            clicked = Some(index);
        }
        left += width;
    }
    clicked
}

/// A name on the left and a value on the right.
pub(crate) fn value(ui: &mut Ui, name: &str, value: &str) -> Response {
    let height = 22.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let colours = colours(ui);
    let name_width = (rect.width() * 0.42).min(110.0);
    let shown = line(ui, name, FontId::proportional(theme::BODY), colours.text_weak, name_width);
    put(ui, shown, rect.left(), rect.center().y);
    let left = rect.left() + name_width + 8.0;
    let text = line(ui, value, FontId::proportional(theme::BODY), colours.text, rect.right() - left);
    let is_elided = text.elided;
    put(ui, text, left, rect.center().y);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{name}: {value}")));
    if is_elided { response.on_hover_text(value) } else { response }
}

/// A text that toggles.
pub(crate) fn toggle(ui: &mut Ui, text: &str, is_on: bool) -> Response {
    let colours = colours(ui);
    let font = FontId::proportional(theme::BODY);
    let ink = if is_on { colours.accent } else { colours.text_weak };
    let galley = line(ui, text, font, ink, f32::INFINITY);
    let mark = 14.0;
    let (rect, response) = ui.allocate_exact_size(vec2(galley.size().x + mark + 18.0, 26.0), Sense::click());
    let ground = if is_on {
        colours.accent_soft
    } else if response.hovered() {
        colours.hover
    } else {
        Color32::TRANSPARENT
    };
    ui.painter().rect_filled(rect, RADIUS, ground);
    let square = Rect::from_center_size(pos2(rect.left() + 6.0 + mark / 2.0, rect.center().y), Vec2::splat(mark));
    if is_on {
        Icon::Check.paint(ui.painter(), square, colours.accent);
    } else {
        let rim = Stroke::new(1.0, colours.outline);
        ui.painter().rect_stroke(square.shrink(1.5), CornerRadius::same(2), rim, StrokeKind::Inside);
    }
    put(ui, galley, square.right() + 4.0, rect.center().y);
    focus_ring(ui, rect, &response);
    response.widget_info(|| WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), is_on, text));
    response
}

/// A small clickable text.
pub(crate) fn link(ui: &mut Ui, text: &str) -> Response {
    let response = ui.link(RichText::new(text).size(theme::SMALL));
    focus_ring(ui, response.rect.expand2(vec2(3.0, 1.0)), &response);
    response
}

/// A text button; the main one of a dialog has the accent colour.
pub(crate) fn text_button(ui: &mut Ui, text: &str, is_main: bool) -> Response {
    let colours = colours(ui);
    let (fill, stroke, colour) = if is_main {
        (colours.accent, Color32::TRANSPARENT, colours.on_accent)
    } else {
        (colours.raised, colours.outline, colours.text)
    };
    let text = RichText::new(text).color(colour);
    let text = if is_main { text.font(FontId::new(theme::BODY, theme::semibold())) } else { text };
    let button = egui::Button::new(text).fill(fill).stroke(Stroke::new(1.0, stroke)).min_size(vec2(72.0, 30.0));
    let response = ui.add(button);
    // Outside a button that has the ring's colour.
    let around = if is_main { response.rect.expand(3.0) } else { response.rect };
    focus_ring(ui, around, &response);
    response
}

/// The main button of a dialog. True if it was clicked, or if Enter was pressed while nothing else had the keys: a
/// field that Enter was typed into has let go of them by then, if it was drawn before.
pub(crate) fn main_button(ui: &mut Ui, text: &str, is_enabled: bool) -> bool {
    let is_clicked = ui.add_enabled_ui(is_enabled, |ui| text_button(ui, text, true)).inner.clicked();
    let is_entered = ui.input(|input| input.key_pressed(egui::Key::Enter)) && ui.memory(|it| it.focused().is_none());
    is_clicked || is_enabled && is_entered
}

/// The frame of a dialog.
pub(crate) fn dialog_frame(ui: &Ui) -> egui::Frame {
    egui::Frame::window(ui.style()).inner_margin(egui::Margin::same(22))
}

/// Lays out the contents from right to left in the rest of the line.
pub(crate) fn right(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    ui.with_layout(egui::Layout::right_to_left(Align::Center), contents);
}
