//! Questions that must be answered before anything else. Escape, and a click beside, mean cancel.

use egui::{Id, Key, Modal, Ui};

use crate::app::document::{Expected, file_name};
use crate::app::widgets::{dialog_frame, right, strong, text_button};
use crate::app::{App, Intent, Question, theme};

/// What a button of a question does.
#[derive(Clone, Copy, PartialEq)]
enum Answer {
    Yes,
    /// Go on without saving.
    GiveUp,
    /// Save in another file.
    Elsewhere,
    Cancel,
}

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(question) = &app.question else { return };
    let (title, text, buttons) = match question {
        Question::Unsaved(intent) => {
            let name = app.document.as_ref().map(crate::app::Document::title).unwrap_or_default();
            let then = match intent {
                Intent::Show(_) => "before another plan is shown",
                Intent::Close | Intent::Quit => "before it is closed",
            };
            (
                format!("Save changes to {name}?"),
                format!("They are in no file yet. Save them {then}, or they are lost."),
                vec![("Save", Answer::Yes), ("Don't save", Answer::GiveUp), ("Cancel", Answer::Cancel)],
            )
        }
        Question::Replace { path, is_changed_since, .. } => (
            format!("Replace {}?", file_name(path)),
            if *is_changed_since {
                "Somebody else has changed the file since it was opened here. Replacing it loses their changes."
                    .to_owned()
            } else {
                "There is a file of this name. Replacing it loses what it holds.".to_owned()
            },
            vec![("Save as…", Answer::Elsewhere), ("Replace", Answer::Yes), ("Cancel", Answer::Cancel)],
        ),
    };
    let response = Modal::new(Id::unique("question")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(400.0);
        ui.label(strong(&title, theme::TITLE));
        ui.add_space(2.0);
        ui.add(egui::Label::new(text).wrap());
        ui.add_space(14.0);
        let mut answer = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                for (index, (word, this)) in buttons.iter().enumerate() {
                    if text_button(ui, word, index == 0).clicked() {
                        answer = Some(*this);
                    }
                }
            });
        });
        let enter = ui.input(|input| input.key_pressed(Key::Enter)) && ui.memory(|memory| memory.focused().is_none());
        answer.or(enter.then_some(buttons[0].1))
    });
    let Some(answer) = response.inner.or(response.should_close().then_some(Answer::Cancel)) else { return };
    let Some(question) = app.question.take() else { return };
    match (question, answer) {
        (_, Answer::Cancel) => {}
        (Question::Unsaved(intent), Answer::GiveUp) => app.perform(intent),
        (Question::Unsaved(intent), Answer::Yes | Answer::Elsewhere) => app.save(Some(intent)),
        (Question::Replace { path, then, .. }, Answer::Yes) => app.save_to(path, Expected::Anything, then),
        (Question::Replace { then, .. }, Answer::Elsewhere | Answer::GiveUp) => app.save_as(then),
    }
}
