//! What the check finds in the plan: a click goes to it; a fix where one is right for certain; or ignored for a reason.

use egui::text::{LayoutJob, TextFormat};
use egui::{FontId, Id, Key, Margin, Response, Role, ScrollArea, Sense, TextEdit, Ui, WidgetInfo, vec2};

use crate::app::look::{
    theme,
    widgets::{caption, colours, focus_ring, follow_focus, link, right, section},
};
use crate::app::session::findings::Checked;
use crate::app::state::{App, Height, Side, SidePanel, panels};
use crate::app::value::{Call, Value};
use crate::base::wording::{count, sentence};
use crate::check::{Finding, Severity};

/// Height in points: the initial one, and the minimum.
const USUAL_HEIGHT: f32 = 280.0;
const LEAST_HEIGHT: f32 = 170.0;

/// The most findings listed of a plan: nobody reads more, and each is laid out in every frame.
const MOST: usize = 200;

pub(super) const PANEL: SidePanel = SidePanel {
    id: panels::FINDINGS,
    title: "Findings",
    help: "What is wrong with the plan",
    side: Side::Right,
    height: Height::Dragged { usual: USUAL_HEIGHT, least: LEAST_HEIGHT },
    is_shown_at_first: false,
    needs_plan: true,
    has_own_command: true,
    show,
};

/// The colour of a severity, and the sign that tells it without colours.
pub(super) fn sign(ui: &Ui, severity: Severity) -> (&'static str, egui::Color32) {
    let colours = colours(ui);
    match severity {
        Severity::Error => ("✗", colours.error),
        Severity::Warning => ("▲", colours.warning),
        Severity::Info => ("○", colours.text_weak),
    }
}

/// A finding whose reason is being typed: its place in the list, and the text.
#[derive(Clone, Default)]
struct Reason {
    of: Option<usize>,
    text: String,
    is_new: bool,
}

/// A user action on the finding with a number.
enum Act {
    GoTo,
    Fix,
    Ignore(String),
    Heed,
}

fn show(app: &mut App, ui: &mut Ui) {
    let margin = Margin { left: 8, right: 8, top: 10, bottom: 8 };
    let mut act = None;
    egui::Frame::new().inner_margin(margin).show(ui, |ui| {
        let checked = app.session.findings();
        ui.horizontal(|ui| {
            ui.add_space(8.0);
            section(ui, "Findings");
            right(ui, |ui| {
                ui.add_space(8.0);
                caption(ui, checked.map_or_else(|| waiting(app).to_owned(), Checked::in_words));
            });
        });
        ui.add_space(2.0);
        let Some(checked) = checked else {
            // As high as with a list, or the panel would shrink and stay so.
            ui.take_available_space();
            return;
        };
        let id = Id::unique("reason of a finding");
        let mut reason = ui.data_mut(|data| data.get_temp::<Reason>(id)).unwrap_or_default();
        ScrollArea::vertical().id_salt("findings").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            let current = app.session.findings.current;
            for (index, finding) in checked.open.iter().enumerate().take(MOST) {
                let done = row(ui, finding, index, current == Some(index), None, &mut reason);
                act = done.map(|done| (index, done)).or(act.take());
            }
            if checked.open.len() > MOST {
                caption(ui, format!("and {} more of the same kinds", checked.open.len() - MOST));
            }
            if checked.open.is_empty() {
                ui.horizontal(|ui| {
                    ui.add_space(8.0);
                    caption(ui, "No findings.");
                });
            }
            if !checked.ignored.is_empty() {
                ui.add_space(8.0);
                ui.horizontal(|ui| {
                    ui.add_space(8.0);
                    section(ui, &format!("Ignored ({})", checked.ignored.len()));
                });
                for (place, (finding, why)) in checked.ignored.iter().enumerate().take(MOST) {
                    let index = checked.open.len() + place;
                    let done = row(ui, finding, index, current == Some(index), Some(why), &mut reason);
                    act = done.map(|done| (index, done)).or(act.take());
                }
            }
        });
        ui.data_mut(|data| data.insert_temp(id, reason));
    });
    if let Some((index, act)) = act {
        let number = Value::Count(index + 1);
        let call = match act {
            Act::GoTo => Call::new("go-to-finding", [number]),
            Act::Fix => Call::new("fix-finding", [number]),
            Act::Ignore(reason) => Call::new("ignore-finding", [number, Value::Text(reason)]),
            Act::Heed => Call::new("heed-finding", [number]),
        };
        app.act_on(call, ui.ctx());
    }
}

fn waiting(app: &App) -> &'static str {
    if app.session.is_check_broken() { "could not be checked" } else { "checking…" }
}

/// One finding. `why`: the reason for which it is ignored.
fn row(
    ui: &mut Ui,
    finding: &Finding,
    index: usize,
    is_current: bool,
    why: Option<&str>,
    reason: &mut Reason,
) -> Option<Act> {
    let mut act = None;
    let response = text_of(ui, finding, index, is_current, why);
    if response.clicked() {
        act = Some(Act::GoTo);
    }
    response.on_hover_text(sentence(&format!("{}.", finding.remedy())));
    let is_asked = reason.of == Some(index);
    ui.push_id(index, |ui| {
        ui.horizontal(|ui| {
            ui.add_space(26.0);
            ui.spacing_mut().item_spacing.x = 12.0;
            if why.is_some() {
                if link(ui, "Stop ignoring").clicked() {
                    act = Some(Act::Heed);
                }
                return;
            }
            if let Some(title) = finding.fix_title()
                && link(ui, title).clicked()
            {
                act = Some(Act::Fix);
            }
            if !is_asked && link(ui, "Ignore…").clicked() {
                *reason = Reason { of: Some(index), text: String::new(), is_new: true };
            }
        });
        if is_asked {
            ui.horizontal(|ui| {
                ui.add_space(26.0);
                let edit = TextEdit::singleline(&mut reason.text)
                    .id(Id::unique("reason"))
                    .hint_text("Reason, kept in the plan")
                    .desired_width(ui.available_width() - 8.0);
                let response = ui.add(edit).accessible_name("Reason to ignore it");
                if std::mem::take(&mut reason.is_new) {
                    response.request_focus();
                }
                let (enter, escape) = ui.input(|input| (input.key_pressed(Key::Enter), input.key_pressed(Key::Escape)));
                if response.lost_focus() && enter && !reason.text.trim().is_empty() {
                    act = Some(Act::Ignore(reason.text.trim().to_owned()));
                }
                if response.lost_focus() && (enter || escape) {
                    *reason = Reason::default();
                }
            });
        }
    });
    ui.add_space(4.0);
    act
}

/// What a finding says, as something to click.
fn text_of(ui: &mut Ui, finding: &Finding, index: usize, is_current: bool, why: Option<&str>) -> Response {
    let colours = colours(ui);
    let (sign, colour) = sign(ui, finding.severity());
    let is_ignored = why.is_some();
    let title_colour = if is_ignored { colours.text_weak } else { colours.text };
    let width = ui.available_width();
    let mut job = LayoutJob::default();
    let format = |font: FontId, colour| TextFormat::simple(font, colour);
    job.append(finding.kind().title, 0.0, format(FontId::new(theme::BODY, theme::semibold()), title_colour));
    let small = FontId::proportional(theme::SMALL);
    job.append(&format!("\n{}", sentence(&finding.what())), 0.0, format(small.clone(), colours.text_weak));
    if let Some(why) = why {
        job.append(&format!("\nIgnored: {why}"), 0.0, format(small, colours.text));
    }
    job.wrap.max_width = (width - 34.0).max(40.0);
    let galley = ui.painter().layout_job(job);
    let (rect, response) = ui.allocate_exact_size(vec2(width, galley.rect.height() + 8.0), Sense::click());
    follow_focus(&response);
    if ui.is_rect_visible(rect) {
        let ground = if is_current {
            Some(colours.accent_soft)
        } else if response.hovered() {
            Some(colours.hover)
        } else {
            None
        };
        if let Some(ground) = ground {
            ui.painter().rect_filled(rect, theme::RADIUS, ground);
        }
        let mark = rect.left_top() + vec2(8.0, 4.0);
        let font = FontId::proportional(theme::BODY);
        let colour = if is_ignored { colours.text_weak } else { colour };
        ui.painter().text(mark, egui::Align2::LEFT_TOP, sign, font, colour);
        ui.painter().galley(rect.left_top() + vec2(26.0, 4.0), galley, colours.text);
        focus_ring(ui, rect, &response);
    }
    let name = format!("Finding {}: {}, {}", index + 1, finding.severity().name(), finding.kind().title);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_current, &name));
    response
}

/// The badge in the status line: how many findings of each severity; a click shows or hides the panel.
pub(super) fn badge(app: &mut App, ui: &mut Ui) {
    if app.session.document.is_none() {
        return;
    }
    let font = FontId::proportional(theme::SMALL);
    let weak = colours(ui).text_weak;
    let mut job = LayoutJob::default();
    let mut put = |text: String, colour| job.append(&text, 0.0, TextFormat::simple(font.clone(), colour));
    let said = match app.session.findings() {
        None => {
            put("○ …".to_owned(), weak);
            format!("Findings: {}", waiting(app))
        }
        Some(checked) => {
            let counts: Vec<(Severity, usize)> =
                Severity::ALL.into_iter().map(|severity| (severity, checked.count(severity))).collect();
            let seen: Vec<&(Severity, usize)> = counts.iter().filter(|(_, number)| *number > 0).collect();
            if seen.is_empty() {
                put("✓".to_owned(), weak);
            }
            for (place, &&(severity, number)) in seen.iter().enumerate() {
                let (sign, colour) = sign(ui, severity);
                let gap = if place == 0 { "" } else { "   " };
                put(format!("{gap}{sign} {number}"), colour);
            }
            let ignored = checked.ignored.len();
            let ignored = if ignored > 0 { format!(", {} ignored", count(ignored, "finding")) } else { String::new() };
            format!("Findings: {}{ignored}", checked.in_words())
        }
    };
    let galley = ui.painter().layout_job(job);
    let size = vec2(galley.rect.width() + 12.0, 22.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let is_shown = app.panels.is_shown(panels::FINDINGS);
    let ground = if is_shown {
        Some(colours(ui).accent_soft)
    } else if response.hovered() {
        Some(colours(ui).hover)
    } else {
        None
    };
    if let Some(ground) = ground {
        ui.painter().rect_filled(rect, theme::RADIUS, ground);
    }
    let at = egui::pos2(rect.left() + 6.0, rect.center().y - galley.rect.height() / 2.0);
    ui.painter().galley(at, galley, weak);
    focus_ring(ui, rect, &response);
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_shown, &said));
    let clicked = response.on_hover_text(format!("{said}. Click to list them.")).clicked();
    if clicked {
        app.act_on(Call::new("findings", [Value::Switch(!is_shown)]), ui.ctx());
    }
}
