//! The backdrop: what it is, its opacity, and how its scale was found.

use crate::app::session::tracing::millimetres;
use egui::{FontId, Role, Sense, Slider, Ui, WidgetInfo, pos2, vec2};

use crate::app::look::{
    icons::Icon,
    theme,
    widgets::{ROW, caption, colours, icon_button, link, put_line, section, value},
};
use crate::app::paint::backdrop::Known;
use crate::app::state::App;
use crate::base::units::Units;
use crate::edit::Calibration;
use crate::plan::{Backdrop, Measurement, ScaleOrigin};

/// A user action in the section.
pub(super) enum PictureAct {
    Command(&'static str, Vec<String>),
    /// The slider's position while it is held.
    Opacity(f64),
}

/// Measurements that agree better than this are considered equal: it is the effect of two clicks one
/// pixel off on a length of a hundred pixels.
const AGREEMENT: f64 = 0.01;

pub(super) fn show(ui: &mut Ui, app: &App, backdrop: &Backdrop) -> Option<PictureAct> {
    let mut act = None;
    section(ui, "Picture");
    let name = backdrop.path.rsplit('/').next().unwrap_or(&backdrop.path);
    value(ui, "File", name).on_hover_text(&backdrop.path);
    match app.session.backdrop.state() {
        None => {}
        Some(Known::Loading) => drop(value(ui, "Size", "Reading…")),
        Some(Known::Shown(picture)) => {
            let [width, height] = picture.levels.size_px();
            value(ui, "Size", &format!("{width} × {height} px"));
            if picture.pages > 1 {
                value(ui, "Page", &format!("{} of {}", backdrop.page, picture.pages));
            }
        }
        Some(Known::Missing(error)) => {
            ui.label(egui::RichText::new(format!("The picture {}", error.what)).color(colours(ui).warning));
        }
    }
    act = act.or(opacity(ui, app, backdrop));
    // A plan may have a scale measured before the lengths were kept.
    let is_known =
        backdrop.is_measured() || app.plan().is_some_and(|plan| plan.meta().scale.origin == ScaleOrigin::Measured);
    let scale = if is_known { "1 px is" } else { "1 px, as assumed" };
    value(ui, "Scale", &format!("{scale} {}", millimetres(backdrop.metres_per_pixel)));
    if backdrop.is_measured() {
        act = act.or(measurements(ui, app.units(), &backdrop.measurements));
    } else if !is_known {
        caption(ui, "The scale is not set. Measure a length you know, or the width of a door.");
    }
    ui.add_space(4.0);
    let measure = if backdrop.is_measured() { "Measure another…" } else { "Set scale…" };
    let rows: [&[(&str, &str)]; 2] = [
        &[(measure, "tool-calibrate"), ("By a door…", "tool-calibrate-door"), ("Straighten…", "tool-straighten")],
        &[("Relink…", "relink-picture"), ("Remove", "remove-picture")],
    ];
    for links in rows {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            for (text, id) in links {
                if link(ui, text).clicked() {
                    act = Some(PictureAct::Command(id, Vec::new()));
                }
            }
        });
    }
    act
}

/// The opacity slider: one step of the history when it is released.
fn opacity(ui: &mut Ui, app: &App, backdrop: &Backdrop) -> Option<PictureAct> {
    let before = (backdrop.opacity * 100.0).round();
    let mut percent = app.session.backdrop.opacity.map_or(before, |opacity| (opacity * 100.0).round());
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let name_width = (rect.width() * 0.42).min(110.0);
    let weak = colours(ui).text_weak;
    put_line(ui, "Opacity", FontId::proportional(theme::BODY), weak, rect);
    let text_width = 44.0;
    let from = pos2(rect.left() + name_width + 8.0, rect.top());
    let slot = egui::Rect::from_min_max(from, pos2(rect.right() - text_width, rect.bottom()));
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(slot).id_salt("opacity"));
    child.spacing_mut().slider_width = slot.width();
    let slider = Slider::new(&mut percent, 0.0..=100.0).step_by(1.0).show_value(false).trailing_fill(true);
    let response = child.add_sized(slot.size(), slider);
    response.widget_info(|| WidgetInfo::slider(true, percent, "Opacity"));
    let font = FontId::proportional(theme::BODY);
    ui.painter().text(
        rect.right_center(),
        egui::Align2::RIGHT_CENTER,
        format!("{percent:.0} %"),
        font,
        colours(ui).text,
    );
    if response.is_pointer_button_down_on() {
        return Some(PictureAct::Opacity(percent / 100.0));
    }
    (percent != before).then(|| PictureAct::Command("picture-opacity", vec![percent.to_string()]))
}

/// The measurements that determine the scale, each with how well it fits.
fn measurements(ui: &mut Ui, units: Units, measurements: &[Measurement]) -> Option<PictureAct> {
    let calibration = Calibration::of(measurements)?;
    let mut act = None;
    ui.add_space(4.0);
    section(ui, "Measured lengths");
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        for (index, (measurement, residual)) in measurements.iter().zip(&calibration.residuals).enumerate() {
            let is_worst = calibration.worst == Some(index) && residual.abs() > AGREEMENT;
            if ui.push_id(index, |ui| length(ui, units, index, measurement, *residual, is_worst)).inner {
                act = Some(PictureAct::Command("remove-measurement", vec![(index + 1).to_string()]));
            }
        }
    });
    if measurements.len() > 1 {
        let largest = calibration.residuals.iter().fold(0.0, |most: f64, residual| most.max(residual.abs()));
        let advice = if largest > AGREEMENT { "; check the one that fits worst" } else { "" };
        caption(ui, format!("They agree within {}{advice}", percent(largest)));
    }
    act
}

/// A measured length and by how much it exceeds the stated one. Returns whether it should be removed.
fn length(ui: &mut Ui, units: Units, index: usize, measurement: &Measurement, residual: f64, is_worst: bool) -> bool {
    let colours = colours(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
    let body = FontId::proportional(theme::BODY);
    let length = units.exact_length(measurement.length_m);
    let middle = rect.center().y;
    let put = |left: f32, align: egui::Align2, text: &str, colour| {
        ui.painter().text(pos2(left, middle), align, text, body.clone(), colour)
    };
    put(rect.left(), egui::Align2::LEFT_CENTER, &format!("{}", index + 1), colours.text_weak);
    put(rect.left() + 22.0, egui::Align2::LEFT_CENTER, &length, colours.text);
    let pixels = format!("{:.0} px", measurement.length_px());
    put(rect.left() + 96.0, egui::Align2::LEFT_CENTER, &pixels, colours.text_weak);
    let colour = if is_worst { colours.warning } else { colours.text };
    let sign = if residual < -0.0005 {
        "−"
    } else if residual > 0.0005 {
        "+"
    } else {
        ""
    };
    let fit = format!("{sign}{}", percent(residual.abs()));
    let right = rect.right() - ROW - 6.0;
    let drawn = put(right, egui::Align2::RIGHT_CENTER, &fit, colour);
    if is_worst {
        let square = egui::Rect::from_center_size(pos2(drawn.left() - 14.0, middle), vec2(14.0, 14.0));
        Icon::Warning.paint(ui.painter(), square, colours.warning);
    }
    let said = if is_worst { ", fits worst" } else { "" };
    response.widget_info(|| {
        WidgetInfo::labeled(Role::Label, true, format!("Measured length {}: {length}, {fit}{said}", index + 1))
    });
    response.on_hover_text("How far it is off at the scale that fits all lengths best");
    let slot = egui::Rect::from_min_max(pos2(rect.right() - ROW, rect.top()), rect.max);
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(slot).id_salt("remove"));
    let name = format!("Remove measured length {}", index + 1);
    icon_button(&mut child, Icon::Close, &name, None).on_hover_text("Remove").clicked()
}

fn percent(share: f64) -> String {
    format!("{:.1} %", share * 100.0)
}
