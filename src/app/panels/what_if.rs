//! What if: each feature of the picked room on a slider, the label that would follow, and the regions of the labels over two of
//! the features with the plan's rooms as points.

use egui::epaint::{Mesh, StrokeKind};
use egui::{Align2, FontId, Rect, Role, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

use super::live::{list, slider};
use super::prediction::kind;
use super::sides;
use crate::app::look::theme;
use crate::app::look::widgets::{caption, colours, hairline, link, section, strong};
use crate::app::session::document::Document;
use crate::app::session::live::{CELLS, Regions, Tried};
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};
use crate::base::units::Units;
use crate::base::wording::sentence;
use crate::classify::{Algorithm, Method};
use crate::draw::Palette;
use crate::features::Features;
use crate::labels::Label;
use crate::plan::ElementId;
use crate::plan::titles::room_title;

/// Height in points at first, and least.
const USUAL_HEIGHT: f32 = 470.0;
const LEAST_HEIGHT: f32 = 160.0;

/// Radius of a room's point in the picture.
const POINT: f32 = 3.5;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::WHAT_IF,
    title: "What if",
    help: "How the label of the picked room would change with its features, and the regions of the labels",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: true,
    has_own_command: true,
    show,
};

/// What a feature is called.
const NAMES: [&str; 8] =
    ["Area", "Axes ratio", "Openings", "To small rooms", "To medium rooms", "To big rooms", "To corridors", "To halls"];

fn show(app: &mut App, ui: &mut Ui) {
    let mut calls = Vec::new();
    let mut hovered = None;
    sides::scrolled(ui, "what if", |ui| {
        section(ui, "What if");
        match app.session.tried() {
            Err(why) => drop(caption(ui, why)),
            Ok(tried) => contents(app, ui, &tried, &mut calls, &mut hovered),
        }
    });
    if hovered.is_some() {
        app.canvas.hovered_in_panel = hovered;
    }
    for call in calls {
        app.act_on(call, ui.ctx());
    }
}

/// A feature's value in words.
fn in_words(feature: usize, value: f64, units: Units) -> String {
    match feature {
        0 => units.area(value),
        1 => format!("{value:.2}"),
        _ => format!("{value:.0}"),
    }
}

fn contents(app: &App, ui: &mut Ui, tried: &Tried, calls: &mut Vec<Call>, hovered: &mut Option<ElementId>) {
    let palette = app.session.palette(ui);
    let name = app
        .session
        .document
        .as_ref()
        .and_then(|document| document.plan().room(tried.room))
        .map(room_title)
        .unwrap_or_default();
    let (now, then) = (tried.said_now.label(), tried.said_then.label());
    ui.label(strong(name, theme::BODY));
    answer(ui, palette, tried);
    let is_changed = tried.now != tried.then;
    ui.spacing_mut().item_spacing.y = 0.0;
    let (values, before) = (tried.then.values(), tried.now.values());
    for feature in 0..values.len() {
        let value = values[feature];
        let most = match feature {
            0 => (before[0] * 4.0).max(100.0),
            1 => before[1].max(8.0),
            2 => before[2].max(20.0),
            _ => before[feature].max(12.0),
        };
        let (least, step) = match feature {
            0 => (1.0, 0.0),
            1 => (1.0, 0.01),
            _ => (0.0, 1.0),
        };
        let shown = in_words(feature, value, app.units());
        if let Some(value) = slider(ui, NAMES[feature], value.clamp(least, most), least..=most, step, &shown) {
            calls.push(Call::new(
                "what-if",
                [Value::Text(Features::NAMES[feature].to_owned()), Value::Text(value.to_string())],
            ));
        }
    }
    ui.spacing_mut().item_spacing.y = 4.0;
    ui.horizontal(|ui| {
        if is_changed && link(ui, "As it is").clicked() {
            calls.push(Call::new("what-if-reset", []));
        }
        let differs = if now == then { "the label stays" } else { "the label changes" };
        caption(ui, if is_changed { differs } else { "Drag a slider; the plan stays as it is." });
    });
    hairline(ui);
    section(ui, "Regions");
    let axes = app.session.live.what_if.axes;
    for (place, axis) in [("Across", 0), ("Up", 1)] {
        let choices: Vec<(String, &str)> =
            NAMES.iter().zip(Features::NAMES).map(|(title, word)| ((*title).to_owned(), word)).collect();
        if let Some(word) = list(ui, place, NAMES[axes[axis]], &choices) {
            let chosen = Features::index(word).unwrap_or(axes[axis]);
            // Never one feature on both.
            let other = if chosen == axes[1 - axis] { axes[axis] } else { axes[1 - axis] };
            let [across, up] = if axis == 0 { [chosen, other] } else { [other, chosen] };
            let words = [across, up].map(|feature| Value::Text(Features::NAMES[feature].to_owned()));
            calls.push(Call::new("regions", words));
        }
    }
    let titles: Vec<(String, &str)> =
        Algorithm::ALL.iter().map(|algorithm| (sentence(algorithm.title()), algorithm.name())).collect();
    let method = tried.model.method();
    if let Some(word) = list(ui, "By", &sentence(method.title()), &titles) {
        calls.push(Call::new("what-if-by", [Value::Text(word.to_owned())]));
    }
    ui.add_space(4.0);
    if let Some(regions) = app.session.regions(tried) {
        picture(app, ui, palette, &regions, hovered, calls);
    }
    let shown = app.session.predictions().map(|predictions| predictions.model.method());
    let why = match shown {
        Some(Method::Each(_)) => String::new(),
        Some(method) => format!(
            " The labels on the plan come from the {}, which compares all rooms of the plan: one room's features do not decide \
             there.",
            method.title()
        ),
        None => String::new(),
    };
    caption(
        ui,
        format!(
            "By the {} (models for {}), all other features as on the sliders. Points are the plan's rooms in their labels' \
             colours; the ring is this room.{why}",
            method.title(),
            kind(tried.model.set())
        ),
    );
}

/// The label that follows, with all probabilities: as it is above, as it would be below.
fn answer(ui: &mut Ui, palette: &Palette, tried: &Tried) {
    let own = colours(ui);
    for (title, said) in [("Now", &tried.said_now), ("Then", &tried.said_then)] {
        let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 24.0), Sense::hover());
        let font = FontId::proportional(theme::BODY);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, title, font.clone(), own.text_weak);
        let bar = Rect::from_min_max(
            pos2(rect.left() + 44.0, rect.top() + 3.0),
            pos2(rect.right() - 130.0, rect.bottom() - 3.0),
        );
        let mut left = bar.left();
        for label in Label::ALL {
            let right = left + bar.width() * said.probability(label) as f32;
            let part = Rect::from_min_max(pos2(left, bar.top()), pos2(right, bar.bottom()));
            ui.painter().rect_filled(part, 0.0, theme::colour(palette.label(label)));
            if part.width() > 14.0 {
                let small = FontId::proportional(theme::SMALL);
                ui.painter().text(
                    part.center(),
                    Align2::CENTER_CENTER,
                    label.letter(),
                    small,
                    theme::colour(palette.ink),
                );
            }
            left = right;
        }
        ui.painter().rect_stroke(bar, 3.0, Stroke::new(1.0, own.outline), StrokeKind::Outside);
        let label = said.label();
        let text = format!("{} {:.0} %", sentence(label.name()), 100.0 * said.probability(label));
        ui.painter().text(rect.right_center(), Align2::RIGHT_CENTER, &text, font, own.text);
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{title}: {text}")));
    }
}

/// The picture of the regions.
fn picture(
    app: &App,
    ui: &mut Ui,
    palette: &Palette,
    regions: &Regions,
    hovered: &mut Option<ElementId>,
    calls: &mut Vec<Call>,
) {
    let own = colours(ui);
    let width = ui.available_width();
    let (rect, response) = ui.allocate_exact_size(vec2(width, width * 0.66 + 18.0), Sense::click());
    let plot = Rect::from_min_max(pos2(rect.left() + 34.0, rect.top()), pos2(rect.right(), rect.bottom() - 18.0));
    let cell = vec2(plot.width() / CELLS[0] as f32, plot.height() / CELLS[1] as f32);
    let mut mesh = Mesh::default();
    for (index, (label, sure)) in regions.cells.iter().enumerate() {
        let (across, up) = (index % CELLS[0], index / CELLS[0]);
        let min = pos2(plot.left() + across as f32 * cell.x, plot.bottom() - (up + 1) as f32 * cell.y);
        let status = crate::features::RoomStatus::Labelled(*label);
        let colour = theme::colour(crate::draw::predicted_fill(palette, status, *sure));
        mesh.add_colored_rect(Rect::from_min_size(min, cell), colour);
    }
    let painter = ui.painter_at(rect.expand(2.0));
    painter.add(Shape::mesh(mesh));
    painter.rect_stroke(plot, 0.0, Stroke::new(1.0, own.outline), StrokeKind::Inside);
    let [across, up] = &regions.scales;
    let at = |values: [f64; 2]| {
        let x = across.place(values[0]).clamp(0.0, 1.0) as f32;
        let y = up.place(values[1]).clamp(0.0, 1.0) as f32;
        pos2(plot.left() + x * plot.width(), plot.bottom() - y * plot.height())
    };
    let font = FontId::proportional(theme::SMALL - 1.0);
    for tick in across.ticks() {
        let x = plot.left() + across.place(tick) as f32 * plot.width();
        let text = if across.feature == 0 { format!("{tick:.0}") } else { format!("{tick}") };
        painter.text(pos2(x, plot.bottom() + 3.0), Align2::CENTER_TOP, text, font.clone(), own.text_weak);
    }
    for tick in up.ticks() {
        let y = plot.bottom() - up.place(tick) as f32 * plot.height();
        painter.text(pos2(plot.left() - 4.0, y), Align2::RIGHT_CENTER, format!("{tick}"), font.clone(), own.text_weak);
    }
    let pointer = response.hover_pos();
    let mut nearest: Option<(f32, crate::plan::RoomId)> = None;
    for (room, values, label) in &regions.rooms {
        let point = at(*values);
        painter.circle(
            point,
            POINT,
            theme::colour(palette.label_strong(*label)),
            Stroke::new(1.0, theme::colour(palette.paper)),
        );
        if let Some(pointer) = pointer {
            let distance = pointer.distance(point);
            if distance < 8.0 && nearest.is_none_or(|(than, _)| distance < than) {
                nearest = Some((distance, *room));
            }
        }
    }
    let point = at(regions.tried);
    painter.circle_stroke(point, 6.5, Stroke::new(2.5, theme::colour(palette.ink)));
    let mut said = format!("Regions of the labels over {} and {}", NAMES[across.feature], NAMES[up.feature]);
    if let Some((_, room)) = nearest {
        *hovered = Some(ElementId::Room(room));
        let plan = app.session.document.as_ref().map(Document::plan);
        said = plan.and_then(|plan| plan.room(room)).map(room_title).unwrap_or_default();
        if response.clicked() {
            calls.push(Call::new("pick", [Value::Room(room)]));
        }
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, said.clone()));
    if nearest.is_some() {
        response.on_hover_text(said);
    }
}
