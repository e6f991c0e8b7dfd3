//! The history of the plan, including undone steps: a click, or an arrow key, goes to any of them.

use egui::{EventFilter, Id, Key, Rect, Response, Role, ScrollArea, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::app::look::{
    theme,
    widgets::{colours, focus_ring, put_line, section},
};
use crate::app::session::document::Document;
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};

/// Height of a step's row, in points.
const ROW: f32 = 24.0;

/// Position of the line of dots, from the left.
const DOT_LEFT: f32 = 12.0;

/// A user action.
enum Act {
    /// Go to a step, counted from 0.
    Jump(usize),
}

/// Height in points below the inspector: the initial one, and the minimum.
const USUAL_HEIGHT: f32 = 240.0;
const LEAST_HEIGHT: f32 = 90.0;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::HISTORY,
    title: "History",
    help: "The steps that led to this plan",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: true,
    has_own_command: true,
    show,
};

fn show(app: &mut App, ui: &mut Ui) {
    let Some(document) = &app.session.document else { return };
    let margin = egui::Margin { left: 8, right: 8, top: 10, bottom: 8 };
    let act = egui::Frame::new().inner_margin(margin).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.add_space(8.0);
            section(ui, "History");
        });
        ui.add_space(2.0);
        steps(ui, document)
    });
    if let Some(Act::Jump(step)) = act.inner {
        app.act_on(Call::new("jump-to-step", [Value::Count(step + 1)]), ui.ctx());
    }
}

/// The list of steps. It gets the keyboard as a whole: the arrows go back and forth.
fn steps(ui: &mut Ui, document: &Document) -> Option<Act> {
    let history = &document.history;
    let (steps, current) = (history.steps(), history.position());
    let rect = ui.available_rect_before_wrap();
    let id = Id::unique("history");
    let list = ui.interact(rect, id, Sense::focusable_noninteractive());
    let title = format!("History, step {} of {}: {}", current + 1, steps.len(), steps[current].title);
    list.widget_info(|| WidgetInfo::labeled(Role::ListBox, true, &title));
    let mut act = take_keys(ui, &list, current, steps.len());
    // Scrolls only when the current step changes: if the user scrolls away, it stays there.
    let seen = ui.data_mut(|data| {
        let seen = data.get_temp_mut_or_default::<(u64, usize, usize)>(id);
        std::mem::replace(seen, (document.number, current, steps.len()))
    });
    let is_new = seen != (document.number, current, steps.len());
    let saved = document.saved_step();
    let area = ScrollArea::vertical().id_salt("steps").auto_shrink(false);
    area.show_viewport(ui, |ui, viewport| {
        // Lay out only what is visible: there may be thousands.
        ui.set_height(steps.len() as f32 * ROW);
        let place = |index: usize| {
            let min = ui.max_rect().min + vec2(0.0, index as f32 * ROW);
            Rect::from_min_size(min, vec2(ui.available_width(), ROW))
        };
        if is_new {
            // With its neighbours, to show the context.
            ui.scroll_to_rect(place(current).expand2(vec2(0.0, ROW)), None);
        }
        let first = (viewport.top() / ROW).floor().max(0.0) as usize;
        let last = ((viewport.bottom() / ROW).ceil().max(0.0) as usize).min(steps.len());
        for (index, step) in steps.iter().enumerate().take(last).skip(first) {
            let row = StepRow {
                title: &step.title,
                index,
                is_last: index + 1 == steps.len(),
                current,
                is_saved: saved == Some(index),
            };
            if row.show(ui, place(index)).clicked() {
                act = Some(Act::Jump(index));
                // The arrows continue from there.
                list.request_focus();
            }
        }
    });
    focus_ring(ui, rect, &list);
    act
}

/// With the keyboard on the list, the arrows go one step back or forth, Home and End to the ends.
fn take_keys(ui: &Ui, list: &Response, current: usize, number: usize) -> Option<Act> {
    if !list.has_focus() {
        return None;
    }
    let filter = EventFilter { vertical_arrows: true, ..EventFilter::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(list.id, filter));
    let to = ui.input(|input| {
        let pressed = |key: Key| input.key_pressed(key);
        match () {
            () if pressed(Key::ArrowUp) => current.checked_sub(1),
            () if pressed(Key::ArrowDown) => Some(current + 1),
            () if pressed(Key::Home) => Some(0),
            () if pressed(Key::End) => number.checked_sub(1),
            () => None,
        }
    });
    to.filter(|&to| to < number && to != current).map(Act::Jump)
}

struct StepRow<'a> {
    title: &'a str,
    index: usize,
    is_last: bool,
    /// The index of the current step.
    current: usize,
    is_saved: bool,
}

impl StepRow<'_> {
    fn show(&self, ui: &Ui, rect: Rect) -> Response {
        let response = ui.interact(rect, ui.scope_id().with(("step", self.index)), Sense::CLICK);
        let (is_current, is_undone) = (self.index == self.current, self.index > self.current);
        let mut name = format!("Step {}: {}", self.index + 1, self.title);
        for (holds, word) in [(is_undone, ", undone"), (self.is_saved, ", saved")] {
            if holds {
                name.push_str(word);
            }
        }
        response.widget_info(|| WidgetInfo::selected(Role::ListBoxOption, true, is_current, &name));
        let colours = colours(ui);
        let painter = ui.painter();
        if is_current {
            painter.rect_filled(rect, theme::RADIUS, colours.accent_soft);
        } else if response.hovered() {
            painter.rect_filled(rect, theme::RADIUS, colours.hover);
        }
        // A line with a dot for each step, filled up to the current one.
        let dot = pos2(rect.left() + DOT_LEFT, rect.center().y);
        let done = colours.text_weak.gamma_multiply(0.55);
        let coming = colours.text_weak.gamma_multiply(0.25);
        let line = |undone: bool| Stroke::new(1.5, if undone { coming } else { done });
        if self.index > 0 {
            painter.vline(dot.x, rect.top()..=dot.y, line(is_undone));
        }
        if !self.is_last {
            painter.vline(dot.x, dot.y..=rect.bottom(), line(self.index >= self.current));
        }
        let ground = if is_current { colours.accent_soft } else { colours.panel };
        match (is_current, is_undone) {
            (true, _) => painter.circle_filled(dot, 4.5, colours.accent),
            (false, false) => painter.circle_filled(dot, 3.0, colours.text_weak),
            (false, true) => painter.circle(dot, 3.0, ground, Stroke::new(1.5, coming)),
        };
        let small = egui::FontId::proportional(theme::SMALL);
        let mut right = rect.right() - 8.0;
        let mut trail = |text: &str, colour: egui::Color32| {
            let width = painter.layout_no_wrap(text.to_owned(), small.clone(), colour).rect.width();
            put_line(ui, text, small.clone(), colour, Rect::from_x_y_ranges(right - width..=right, rect.y_range()));
            right -= width + 10.0;
        };
        trail(&(self.index + 1).to_string(), colours.text_weak.gamma_multiply(if is_undone { 0.6 } else { 1.0 }));
        if self.is_saved {
            trail("saved", colours.accent);
        }
        let font = if is_current {
            egui::FontId::new(theme::BODY, theme::semibold())
        } else {
            egui::FontId::proportional(theme::BODY)
        };
        let colour = if is_undone { colours.text_weak.gamma_multiply(0.75) } else { colours.text };
        let text = Rect::from_x_y_ranges(rect.left() + DOT_LEFT + 14.0..=right, rect.y_range());
        put_line(ui, self.title, font, colour, text);
        response
    }
}
