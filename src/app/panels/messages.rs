//! The bars over the canvas: messages that stay until dismissed, and some that stay as long as they are true. They lie
//! over the plan, so that it does not move when one comes or goes.

use egui::{
    Align2, Area, Color32, Frame, Id, Label, Margin, Order, Rect, RichText, Role, Sense, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};

use crate::app::look::{
    icons::Icon,
    theme,
    widgets::{ICON, ROW, colours, icon_button, link, strong, text_button},
};
use crate::app::session::messages::{Message, Remedy, Severity};
use crate::app::state::App;
use crate::app::value::{Call, Value};
use crate::plan::ElementId;

/// The most messages shown at once: the newest ones.
const SHOWN: usize = 3;

/// Distance of the bars from the sides of the canvas, and from its lower end with the scale bar, in points.
const SIDE: f32 = 16.0;
const BELOW: f32 = 36.0;

/// The most that the bars are wide, in points: longer lines are hard to read.
const WIDTH: f32 = 760.0;

/// Shows the bars over the canvas, or over what stands in its place.
pub(super) fn show(app: &mut App, ui: &Ui, middle: Rect) {
    let shown = app.session.shown_messages();
    let first = shown.len().saturating_sub(SHOWN);
    // Lasting messages are always shown.
    let newest = shown.iter().skip(first).filter_map(|index| app.session.messages.get(*index).cloned());
    let messages: Vec<Message> = newest.chain(app.session.bars()).collect();
    if messages.is_empty() {
        return;
    }
    let canvas = app.canvas.seen_rect().filter(|_| app.session.document.is_some()).unwrap_or(middle);
    let width = (canvas.width() - 2.0 * SIDE).clamp(120.0, WIDTH);
    let place = pos2(canvas.center().x - width / 2.0, canvas.bottom() - BELOW);
    let area = Area::new(Id::unique("messages")).order(Order::Middle).pivot(Align2::LEFT_BOTTOM).fixed_pos(place);
    area.constrain_to(middle).show(ui.ctx(), |ui| {
        ui.set_width(width);
        ui.spacing_mut().item_spacing.y = 6.0;
        show_bars(app, ui, first, messages);
    });
}

fn show_bars(app: &mut App, ui: &mut Ui, first: usize, messages: Vec<Message>) {
    for (index, message) in messages.into_iter().enumerate() {
        let act = ui.push_id(("message", index), |ui| bar(ui, &message)).inner;
        match act {
            None => {}
            Some(Act::Dismiss) => {
                app.act_on(Call::new("dismiss-message", [Value::Count(first + index + 1)]), ui.ctx());
            }
            Some(Act::Remedy(Remedy::KeepPicture)) => {
                if let Some(path) = app.session.shown_picture_path() {
                    app.act_on(Call::new("relink-picture", [Value::Path(path)]), ui.ctx());
                }
            }
            Some(Act::Remedy(remedy)) => {
                // A dialog asks for what it takes.
                app.act_on(remedy.call(), ui.ctx());
            }
        }
    }
}

impl Remedy {
    /// The command that it is.
    fn call(self) -> Call {
        match self {
            Self::ShowNotes => Call::new("import-notes", [Value::Switch(true)]),
            Self::ShowDifferences => Call::new("differences", [Value::Switch(true)]),
            Self::LoadTheirs => Call::new("load-theirs", []),
            Self::KeepMine => Call::new("keep-mine", []),
            Self::Save => Call::new("save", []),
            Self::SaveElsewhere => Call::new("save-as", []),
            Self::ShowPicture => Call::new("show-outside-picture", []),
            Self::RelinkPicture | Self::KeepPicture => Call::new("relink-picture", []),
            Self::MergeRooms(rooms) => Call::new("merge-rooms", [Value::Elements(rooms.map(ElementId::Room).to_vec())]),
        }
    }
}

enum Act {
    Dismiss,
    Remedy(Remedy),
}

fn bar(ui: &mut Ui, message: &Message) -> Option<Act> {
    let (icon, mark, ground) = severity_colours(ui, message.severity);
    let mut act = None;
    let frame = Frame::popup(ui.style()).fill(ground).inner_margin(Margin { left: 14, right: 8, top: 4, bottom: 4 });
    let shown = frame.show(ui, |ui| {
        ui.set_width(ui.available_width().max(0.0));
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 10.0;
            let (square, _) = ui.allocate_exact_size(vec2(ICON, ROW), Sense::hover());
            icon.paint(ui.painter(), Rect::from_center_size(square.center(), Vec2::splat(ICON)), mark);
            let width = (ui.available_width() - ROW - 10.0).max(0.0);
            ui.vertical(|ui| {
                ui.set_width(width);
                ui.spacing_mut().item_spacing.y = 2.0;
                ui.add_space(6.0);
                let text = strong(&message.text, theme::BODY).color(colours(ui).text);
                ui.add(Label::new(text).wrap());
                if !message.detail.is_empty() {
                    let detail = RichText::new(&message.detail).size(theme::SMALL).color(colours(ui).text);
                    ui.add(Label::new(detail).wrap().selectable(true));
                }
                match message.remedies.as_slice() {
                    [] => {}
                    [remedy] if !message.stays => {
                        if link(ui, remedy.title()).clicked() {
                            act = Some(Act::Remedy(*remedy));
                        }
                    }
                    remedies => {
                        ui.add_space(4.0);
                        ui.horizontal_wrapped(|ui| {
                            ui.spacing_mut().item_spacing.x = 8.0;
                            for remedy in remedies {
                                if text_button(ui, remedy.title(), false).clicked() {
                                    act = Some(Act::Remedy(*remedy));
                                }
                            }
                        });
                        ui.add_space(2.0);
                    }
                }
                ui.add_space(5.0);
            });
            if !message.stays
                && icon_button(ui, Icon::Close, "Dismiss message", None).on_hover_text("Dismiss").clicked()
            {
                act = Some(Act::Dismiss);
            }
        });
    });
    let rect = shown.response.rect;
    let role = if message.severity == Severity::Error { Role::Alert } else { Role::Status };
    let said = ui.interact(rect, ui.scope_id().with("said"), Sense::hover());
    said.widget_info(|| WidgetInfo::labeled(role, true, format!("{} {}", message.text, message.detail)));
    act
}

/// The colours of a message's icon and background.
fn severity_colours(ui: &Ui, severity: Severity) -> (Icon, Color32, Color32) {
    let colours = colours(ui);
    match severity {
        Severity::Info => (Icon::Info, colours.accent, colours.info_soft),
        Severity::Warning => (Icon::Warning, colours.warning, colours.warning_soft),
        Severity::Error => (Icon::Warning, colours.error, colours.error_soft),
    }
}
