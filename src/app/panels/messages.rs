//! The bars above the canvas: messages that stay until dismissed, and some that stay as long as they are
//! true.

use egui::{Color32, Frame, Label, Margin, Rect, RichText, Role, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};

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

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let first = app.session.messages.len().saturating_sub(SHOWN);
    // Lasting messages are always shown.
    let messages: Vec<Message> = app.session.messages.iter().skip(first).cloned().chain(app.session.bars()).collect();
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
    let frame = Frame::new().fill(ground).inner_margin(Margin { left: 14, right: 8, top: 6, bottom: 6 });
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
    ui.painter().hline(rect.x_range(), rect.bottom() - 0.5, Stroke::new(1.0, colours(ui).border));
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
