//! Questions that must be answered before anything else. Escape, or a click outside, cancels.

use egui::{Id, Modal, Ui};

use crate::app::look::{
    theme,
    widgets::{dialog_frame, main_button, right, strong, text_button},
};
use crate::app::session::questions::CANCEL;
use crate::app::state::App;
use crate::app::value::{Call, Value};

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(question) = &app.session.question else { return };
    let answers = question.answers();
    let response = Modal::new(Id::unique("question")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(400.0);
        ui.label(strong(&question.title, theme::TITLE));
        ui.add_space(2.0);
        ui.add(egui::Label::new(&question.text).wrap());
        ui.add_space(14.0);
        let mut answer = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                for (index, (word, title)) in answers.iter().enumerate() {
                    let is_given =
                        if index == 0 { main_button(ui, title, true) } else { text_button(ui, title, false).clicked() };
                    if is_given {
                        answer = Some(*word);
                    }
                }
            });
        });
        answer
    });
    if let Some(answer) = response.inner.or(response.should_close().then_some(CANCEL)) {
        app.act_on(Call::new("answer", [Value::Word(answer)]), ui.ctx());
    }
}
