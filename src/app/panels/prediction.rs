//! The predictions for the rooms, and the choice of models.

use super::reasons;
use egui::{Align2, ComboBox, FontId, Rect, Role, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2};

use crate::app::commands;
use crate::app::look::theme;
use crate::app::look::widgets::{caption, colours, focus_ring, follow_focus, section, text_button};
use crate::app::state::App;
use crate::base::wording::{sentence, thousands};
use crate::classify::why::Why;
use crate::dataset::sets::STANDARD;
use crate::draw::Palette;
use crate::features::RoomStatus;
use crate::labels::Label;
use crate::plan::RoomId;
use crate::predict::{Marks, Predictions};

/// The id of a requested command, with the word of its argument.
pub(super) type Asked = (&'static str, Option<String>);

/// The prediction for a room, with its reason. Returns the command requested.
pub(super) fn of_room(
    ui: &mut Ui,
    app: &App,
    palette: &Palette,
    predictions: &Predictions,
    room: RoomId,
    status: RoomStatus,
    why: Option<&Why>,
    evidence: &mut Option<Marks>,
) -> Option<Asked> {
    section(ui, "Prediction");
    let Some(distribution) = predictions.distribution(room) else {
        caption(ui, "No prediction: the room has no area, or the label scheme leaves it out.");
        return None;
    };
    let said = distribution.label();
    ui.add_space(2.0);
    ui.spacing_mut().item_spacing.y = 0.0;
    for label in Label::ALL {
        bar(ui, palette, label, distribution.probability(label), label == said);
    }
    ui.spacing_mut().item_spacing.y = 4.0;
    ui.add_space(4.0);
    if let Some(why) = why {
        *evidence = reasons::show(ui, why).map(|point| predictions.marks(room, &point.on_plan));
    }
    if let Some((own, near)) = predictions.nearest(room) {
        reasons::nearest(ui, palette, &own, &near, app.units());
    }
    let mut asked = None;
    match status.label() {
        Some(known) if known == said => drop(caption(ui, "Agrees with the label.")),
        Some(_) => drop(caption(ui, "Differs from the label.")),
        None => {
            ui.add_space(2.0);
            if text_button(ui, &format!("Accept {said}"), false).clicked() {
                asked = Some(("accept-prediction", None));
            }
        }
    }
    asked.or(models(ui, app, predictions))
}

/// The predictions for the plan as a whole. Returns the command requested.
pub(super) fn of_plan(ui: &mut Ui, app: &App, predictions: &Predictions) -> Option<Asked> {
    section(ui, "Prediction");
    let agreement = predictions.agreement();
    if let Some(share) = agreement.share() {
        let text = format!(
            "{} of {} known labels predicted correctly ({:.0} %)",
            agreement.right,
            agreement.known,
            100.0 * share
        );
        caption(ui, text);
    }
    if let Some(known) = predictions.acquaintance() {
        caption(ui, format!("The model {}.", known.words()));
    }
    let mut asked = None;
    if commands::find("accept-all-predictions").is_some_and(|command| command.why_not(app).is_none()) {
        let unknown = predictions.network.rooms.iter().filter(|room| room.label.is_none()).count();
        let rooms = if unknown == 1 { "room has" } else { "rooms have" };
        caption(ui, format!("{} {rooms} no label.", thousands(unknown as u64)));
        if text_button(ui, "Accept all predictions", false).clicked() {
            asked = Some(("accept-all-predictions", None));
        }
    }
    asked.or(models(ui, app, predictions))
}

/// The choice of models. Returns the command requested.
fn models(ui: &mut Ui, app: &App, predictions: &Predictions) -> Option<Asked> {
    ui.add_space(4.0);
    let mut asked = choice(ui, app, "Models", "models");
    asked = choice(ui, app, "Method", "predict-by").or(asked);
    let about = &predictions.model.about;
    let learned = format!("{} rooms in {} buildings", thousands(about.data.rooms as u64), about.data.buildings);
    let set = &predictions.choice;
    let because = if set.because == "as told" { String::new() } else { format!(" ({})", set.because) };
    let response = caption(ui, format!("Models for {}{because}, trained on {learned}", kind(&set.set)));
    if !set.reasons.is_empty() {
        response.on_hover_text(format!("{} because {}", sentence(&set.set), set.reasons_in_words(app.units())));
    }
    asked
}

/// A set of models, in words.
pub(super) fn kind(set: &str) -> &str {
    if set == STANDARD { "any kind of building" } else { set }
}

/// The choices of a command, as a drop-down list.
fn choice(ui: &mut Ui, app: &App, name: &str, id: &'static str) -> Option<Asked> {
    let (choices, set) = commands::find(id)?.settings(app)?;
    let current = choices.iter().find(|choice| choice.word == set).map_or(set, |choice| choice.title.as_str());
    let mut asked = None;
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(64.0, 28.0), Sense::hover());
        let font = FontId::proportional(theme::BODY);
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, name, font, colours(ui).text_weak);
        let list = ComboBox::from_id_salt(("models", name)).width(ui.available_width() - 8.0).selected_text(current);
        let shown = list.show_ui(ui, |ui| {
            for choice in &choices {
                let row = ui.selectable_label(choice.word == set, &choice.title);
                if row.on_hover_text(&choice.detail).clicked() {
                    asked = Some((id, Some(choice.word.clone())));
                }
            }
        });
        let detail = choices.iter().find(|choice| choice.word == set).map_or("", |choice| choice.detail.as_str());
        follow_focus(&shown.response);
        focus_ring(ui, shown.response.rect, &shown.response);
        let is_enabled = ui.is_enabled();
        let text = format!("{name}: {current}");
        shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, is_enabled, text.clone()));
        shown.response.on_hover_text(detail);
    });
    asked
}

/// A label with its probability as a bar.
pub(super) fn bar(ui: &mut Ui, palette: &Palette, label: Label, probability: f64, is_said: bool) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 22.0), Sense::hover());
    let colours = colours(ui);
    let text = if is_said { colours.text } else { colours.text_weak };
    let font = if is_said { FontId::new(theme::BODY, theme::semibold()) } else { FontId::proportional(theme::BODY) };
    let painter = ui.painter();
    let middle = rect.center().y;
    painter.text(rect.left_center(), Align2::LEFT_CENTER, sentence(label.name()), font.clone(), text);
    let percent = format!("{:.0} %", 100.0 * probability);
    painter.text(rect.right_center(), Align2::RIGHT_CENTER, &percent, font, text);
    let track = Rect::from_min_max(pos2(rect.left() + 96.0, middle - 4.0), pos2(rect.right() - 46.0, middle + 4.0));
    painter.rect_filled(track, 4, colours.field);
    let filled = track.with_max_x(track.left() + track.width() * probability as f32);
    if filled.width() >= 1.0 {
        painter.rect_filled(filled, 4, theme::colour(palette.label(label)));
        let rim = Stroke::new(1.0, colours.outline);
        painter.rect_stroke(filled, 4, rim, StrokeKind::Inside);
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("{}: {percent}", sentence(label.name()))));
}
