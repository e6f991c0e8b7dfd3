//! The labels as they follow every edit: what kind of building it is, how many rooms of each label, accepting several at
//! once, and a second opinion beside the first.

use egui::epaint::StrokeKind;
use egui::{Align2, FontId, Rect, Response, Role, Sense, Slider, Stroke, Ui, UiBuilder, WidgetInfo, pos2, vec2};

use super::sides;
use crate::app::look::theme;
use crate::app::look::widgets::{
    Lead, ROW, Row, caption, colours, focus_ring, follow_focus, hairline, put_line, section, text_button,
};
use crate::app::session::document::Document;
use crate::app::session::live::NEIGHBOURS;
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, sentence};
use crate::classify::Method;
use crate::draw::Palette;
use crate::labels::{Label, Typology};
use crate::plan::ElementId;
use crate::plan::titles::room_title;

/// Height in points at first, and least.
const USUAL_HEIGHT: f32 = 380.0;
const LEAST_HEIGHT: f32 = 150.0;

/// The most rooms listed where two opinions differ.
const MOST_LISTED: usize = 200;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::LIVE,
    title: "Live labels",
    help: "The predicted labels as they follow every edit, how to accept several, and a second opinion",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: true,
    has_own_command: true,
    show,
};

fn show(app: &mut App, ui: &mut Ui) {
    let mut call = None;
    let mut hovered = None;
    sides::scrolled(ui, "live", |ui| call = contents(app, ui, &mut hovered));
    if hovered.is_some() {
        app.canvas.hovered_in_panel = hovered;
    }
    if let Some(call) = call {
        app.act_on(call, ui.ctx());
    }
}

fn contents(app: &App, ui: &mut Ui, hovered: &mut Option<ElementId>) -> Option<Call> {
    section(ui, "Live labels");
    let palette = app.session.palette(ui);
    let document = app.session.document.as_ref()?;
    let Some(predictions) = app.session.predictions() else {
        let is_awaited = document.last_labelled().is_some() || document.is_awaited();
        caption(ui, if is_awaited { "Being worked out…" } else { "There are no predictions for this plan." });
        return None;
    };
    if predictions.network.rooms.is_empty() {
        caption(ui, "Draw a room, and its label shows here.");
        return None;
    }
    let mut call = None;
    // The kind of building.
    if let Some(choice) = app.session.kind_of_building() {
        ui.add_space(2.0);
        kind_bar(ui, palette, &choice.posterior);
        let stated = document.plan().meta().typology.as_ref();
        match stated {
            Some(stated) => drop(caption(ui, format!("What it looks like; the plan says that it is a {stated}."))),
            None if choice.reasons.is_empty() => {}
            None => {
                let reason = choice.reasons.first().map(|reason| reason.words(app.units())).unwrap_or_default();
                caption(ui, format!("{}.", sentence(&reason)));
            }
        }
    }
    hairline(ui);
    call = labels(app, ui, palette).or(call);
    hairline(ui);
    call = second(app, ui, palette, hovered).or(call);
    call
}

/// The rooms of each predicted label; those without a label can be accepted.
fn labels(app: &App, ui: &mut Ui, palette: &Palette) -> Option<Call> {
    let mut call = None;
    let predictions = app.session.predictions()?;
    section(ui, "Predicted labels");
    ui.spacing_mut().item_spacing.y = 0.0;
    for label in Label::ALL {
        let rooms = predictions.result.distributions.iter().filter(|said| said.label() == label).count();
        let open = app.session.acceptable(Some(label), 0.0).len();
        ui.horizontal(|ui| {
            let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width() - 92.0, ROW), Sense::hover());
            let mut row = ui.new_child(UiBuilder::new().max_rect(rect).id_salt(("label", label.index())));
            let trail = if rooms == 0 { "–".to_owned() } else { rooms.to_string() };
            let name = sentence(label.name());
            Row::new(Lead::Swatch(theme::colour(palette.label(label))), &name).trail(&trail).show_only(&mut row);
            drop(response);
            if open > 0 {
                let name = format!("Accept {}: {label}", count(open, "room"));
                if small_button(ui, &format!("Accept {open}"), &name).clicked() {
                    call = Some(Call::new("accept-label", [Value::word(label)]));
                }
            }
        });
    }
    ui.spacing_mut().item_spacing.y = 4.0;
    let all = app.session.acceptable(None, 0.0).len();
    if all == 0 {
        caption(ui, "Every room has a label.");
        return call;
    }
    ui.add_space(6.0);
    let least = app.session.live.least;
    let shown = format!("{:.0} %", 100.0 * least);
    if let Some(value) = slider(ui, "At least so sure", least * 100.0, 0.0..=100.0, 1.0, &shown) {
        call = Some(Call::new("accept-threshold", [Value::Number(value)]));
    }
    let sure = app.session.acceptable(None, least).len();
    ui.add_enabled_ui(sure > 0, |ui| {
        if text_button(ui, &format!("Accept {sure} of {}", count(all, "open room")), false).clicked() {
            call = Some(Call::new("accept-above", [Value::Number(least * 100.0)]));
        }
    });
    call
}

/// A second method beside the first.
fn second(app: &App, ui: &mut Ui, palette: &Palette, hovered: &mut Option<ElementId>) -> Option<Call> {
    let mut call = None;
    section(ui, "Second opinion");
    let now = app.session.live.second;
    let title = |method: Option<Method>| method.map_or("None".to_owned(), |method| sentence(method.title()));
    let methods: Vec<Option<Method>> = std::iter::once(None).chain(Method::ALL.map(Some)).collect();
    let choices: Vec<(String, &str)> =
        methods.iter().map(|method| (title(*method), method.map_or("none", Method::name))).collect();
    let current = title(now.map(|second| second.method));
    if let Some(word) = list(ui, "Method", &current, &choices) {
        call = Some(Call::new("second-opinion", [Value::Text(word.to_owned())]));
    }
    let Some(second) = now else {
        caption(ui, "Another method, or other labels of the neighbours, beside the first.");
        return call;
    };
    if matches!(second.method, Method::Each(_)) {
        let named = |word: &str| match word {
            "trained" => "As it was trained".to_owned(),
            word => format!("{} labels", sentence(word)),
        };
        let choices: Vec<(String, &str)> = NEIGHBOURS.iter().map(|(word, _)| (named(word), *word)).collect();
        let word =
            NEIGHBOURS.iter().find(|(_, neighbours)| *neighbours == second.neighbours).map_or("trained", |it| it.0);
        if let Some(word) = list(ui, "Neighbours", &named(word), &choices) {
            call = Some(Call::new(
                "second-opinion",
                [Value::Text(second.method.name().to_owned()), Value::Text(word.to_owned())],
            ));
        }
    }
    let Some(other) = app.session.second_opinion() else {
        caption(ui, "There is no model of this method for this kind of building.");
        return call;
    };
    let differ = app.session.disagreements();
    let rooms = other.network.rooms.len();
    caption(
        ui,
        match differ.len() {
            0 => format!("Both say the same of all {}.", count(rooms, "room")),
            1 => format!("They differ about 1 of {}.", count(rooms, "room")),
            several => format!("They differ about {several} of {}.", count(rooms, "room")),
        },
    );
    let plan = app.session.document.as_ref().map(Document::plan)?;
    ui.spacing_mut().item_spacing.y = 0.0;
    for (id, one, other) in differ.into_iter().take(MOST_LISTED) {
        let name = plan.room(id).map(room_title).unwrap_or_default();
        let response = two_labels(ui, palette, &name, one, other);
        if response.hovered() || response.has_focus() {
            *hovered = Some(ElementId::Room(id));
        }
        if response.clicked() {
            call = Some(Call::new("pick", [Value::Room(id)]));
        }
    }
    call
}

/// A room with two labels beside each other.
fn two_labels(ui: &mut Ui, palette: &Palette, name: &str, one: (Label, f64), other: (Label, f64)) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    follow_focus(&response);
    let own = colours(ui);
    let around = rect.expand2(vec2(8.0, 0.0));
    if response.hovered() {
        ui.painter().rect_filled(around, theme::RADIUS, own.hover);
    }
    let chip = |ui: &Ui, left: f32, (label, sure): (Label, f64)| {
        let place = Rect::from_min_size(pos2(left, rect.center().y - 10.0), vec2(58.0, 20.0));
        ui.painter().rect_filled(place, 4.0, theme::colour(palette.label(label)));
        ui.painter().rect_stroke(place, 4.0, Stroke::new(1.0, own.outline), StrokeKind::Inside);
        let text = format!("{} {:.0} %", label.letter(), 100.0 * sure);
        let font = FontId::proportional(theme::SMALL);
        ui.painter().text(place.center(), Align2::CENTER_CENTER, text, font, theme::colour(palette.ink));
    };
    chip(ui, rect.right() - 120.0, one);
    chip(ui, rect.right() - 58.0, other);
    let text = Rect::from_min_max(rect.min, pos2(rect.right() - 128.0, rect.bottom()));
    put_line(ui, name, FontId::proportional(theme::BODY), own.text, text);
    focus_ring(ui, around, &response);
    let said = format!("{name}: {} or {}", one.0, other.0);
    response.widget_info(|| WidgetInfo::labeled(Role::Link, true, said.clone()));
    response.on_hover_text(format!(
        "{}, {:.0} % sure, or {}, {:.0} % sure",
        sentence(one.0.name()),
        100.0 * one.1,
        other.0,
        100.0 * other.1
    ))
}

/// A bar that shares its length among the kinds of building, with the likeliest named below.
pub(super) fn kind_bar(ui: &mut Ui, palette: &Palette, posterior: &[(Typology, f64)]) {
    if posterior.is_empty() {
        caption(ui, "What kind of building it is shows once there are rooms.");
        return;
    }
    // By name, so that each keeps its place while the shares move.
    let mut kinds: Vec<&(Typology, f64)> = posterior.iter().collect();
    kinds.sort_by(|p, q| p.0.cmp(&q.0));
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 12.0), Sense::hover());
    let own = colours(ui);
    let painter = ui.painter();
    painter.rect_filled(rect, 6.0, own.field);
    let mut left = rect.left();
    for (index, (_, share)) in kinds.iter().enumerate() {
        let right = if index + 1 == kinds.len() { rect.right() } else { left + rect.width() * *share as f32 };
        let part = Rect::from_min_max(pos2(left, rect.top()), pos2(right, rect.bottom()));
        if part.width() > 0.5 {
            painter.rect_filled(part, 3.0, kind_colour(palette, index));
        }
        left = right;
    }
    let words: Vec<String> = posterior.iter().map(|(kind, share)| format!("{kind} {:.0} %", 100.0 * share)).collect();
    let said = format!("Kind of building: {}", words.join(", "));
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, said.clone()));
    ui.spacing_mut().item_spacing.y = 0.0;
    for (index, (kind, share)) in kinds.into_iter().enumerate() {
        let name = sentence(kind.as_str());
        let percent = format!("{:.0} %", 100.0 * share);
        Row::new(Lead::Swatch(kind_colour(palette, index)), &name).trail(&percent).show_only(ui);
    }
    ui.spacing_mut().item_spacing.y = 4.0;
}

/// Steps of one colour: the kinds of building must not look like labels.
fn kind_colour(palette: &Palette, index: usize) -> egui::Color32 {
    let share = [0.3, 0.55, 0.85, 0.42, 0.7][index % 5];
    theme::colour(palette.paper.mixed(palette.selection, share))
}

/// A small button at the end of a row.
fn small_button(ui: &mut Ui, text: &str, name: &str) -> Response {
    let own = colours(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(84.0, 24.0), Sense::click());
    let ground = if response.hovered() { own.hover } else { own.raised };
    ui.painter().rect_filled(rect, theme::RADIUS, ground);
    ui.painter().rect_stroke(rect, theme::RADIUS, Stroke::new(1.0, own.outline), StrokeKind::Inside);
    let font = FontId::proportional(theme::SMALL);
    ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, own.text);
    focus_ring(ui, rect, &response);
    follow_focus(&response);
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    response
}

/// A drop-down list with a name before it; returns the word of what was chosen.
pub(super) fn list<'a>(ui: &mut Ui, name: &str, current: &str, choices: &[(String, &'a str)]) -> Option<&'a str> {
    let mut chosen = None;
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(78.0, ROW), Sense::hover());
        put_line(ui, name, FontId::proportional(theme::BODY), colours(ui).text_weak, rect);
        let list =
            egui::ComboBox::from_id_salt(("list", name)).width(ui.available_width() - 8.0).selected_text(current);
        let shown = list.show_ui(ui, |ui| {
            for (title, word) in choices {
                if ui.selectable_label(title == current, title).clicked() {
                    chosen = Some(*word);
                }
            }
        });
        follow_focus(&shown.response);
        focus_ring(ui, shown.response.rect, &shown.response);
        let text = format!("{name}: {current}");
        shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, text.clone()));
    });
    chosen
}

/// A slider with its name and its value in words; returns a value that was set.
pub(super) fn slider(
    ui: &mut Ui,
    name: &str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    step: f64,
    shown: &str,
) -> Option<f64> {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW - 2.0), Sense::hover());
    let name_width = (rect.width() * 0.42).min(126.0);
    let weak = colours(ui).text_weak;
    put_line(ui, name, FontId::proportional(theme::BODY), weak, rect.with_max_x(rect.left() + name_width));
    let slot =
        Rect::from_min_max(pos2(rect.left() + name_width + 8.0, rect.top()), pos2(rect.right() - 62.0, rect.bottom()));
    let mut child = ui.new_child(UiBuilder::new().max_rect(slot).id_salt(("slider", name)));
    child.spacing_mut().slider_width = slot.width();
    let mut set = value;
    let is_logarithmic = step == 0.0;
    let slider = Slider::new(&mut set, range).show_value(false).trailing_fill(true).logarithmic(is_logarithmic);
    let slider = if is_logarithmic { slider } else { slider.step_by(step) };
    let response = child.add_sized(slot.size(), slider);
    follow_focus(&response);
    response.widget_info(|| WidgetInfo::slider(true, set, name));
    let font = FontId::proportional(theme::BODY);
    ui.painter().text(rect.right_center(), Align2::RIGHT_CENTER, shown, font, colours(ui).text);
    // The value shown may be between two steps, which is nobody's doing.
    (response.changed() && (set - value).abs() > step / 2.0).then_some(set)
}
