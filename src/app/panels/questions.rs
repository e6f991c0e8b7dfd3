//! Questions that must be answered before anything else. Escape, and a click beside, mean cancel.

use egui::{Id, Key, Modal, Ui};

use crate::app::look::{
    theme,
    widgets::{dialog_frame, right, strong, text_button},
};
use crate::app::session::questions::{Intent, Question};
use crate::app::state::App;
use crate::base::wording::count;
use crate::plan::ElementId;

pub(super) fn show(app: &mut App, ui: &mut Ui) {
    let Some(question) = &app.session.question else { return };
    let title = question.title(app);
    let text = match question {
        Question::Unsaved(intent) => {
            let then = match intent {
                Intent::Show(_) | Intent::Recover(_) => "before another plan is shown",
                Intent::Close | Intent::Quit => "before it is closed",
            };
            format!("They are in no file yet. Save them {then}, or they are lost.")
        }
        Question::Change(change) => change.text.clone(),
        Question::Delete { selected, gone } => {
            let others = |kind: &str| {
                let is_it = |element: &&ElementId| element.kind() == kind && !selected.contains(element);
                gone.iter().filter(is_it).count()
            };
            let counts = ["room", "wall", "opening"].map(|kind| (others(kind), kind));
            let said: Vec<String> =
                counts.iter().filter(|(number, _)| *number > 0).map(|(number, kind)| count(*number, kind)).collect();
            format!("{} cannot stand without it and would go as well: red on the plan.", said.join(", "))
        }
        Question::Replace { is_changed_since: true, .. } => {
            "Somebody else has changed the file since it was opened here. Replacing it loses their changes.".to_owned()
        }
        Question::Discard { .. } => "They are in no file and cannot be brought back.".to_owned(),
        Question::Drawing(_) => {
            "What was traced on the picture should go along, so that it stays on its lines. What was right before stays \
             where it is."
                .to_owned()
        }
        Question::Replace { .. } => "There is a file of this name. Replacing it loses what it holds.".to_owned(),
    };
    let answers = question.answers();
    let response = Modal::new(Id::unique("question")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(400.0);
        ui.label(strong(&title, theme::TITLE));
        ui.add_space(2.0);
        ui.add(egui::Label::new(text).wrap());
        ui.add_space(14.0);
        let mut answer = None;
        ui.horizontal(|ui| {
            right(ui, |ui| {
                for (index, (word, title)) in answers.iter().enumerate() {
                    if text_button(ui, title, index == 0).clicked() {
                        answer = Some(*word);
                    }
                }
            });
        });
        let enter = ui.input(|input| input.key_pressed(Key::Enter)) && ui.memory(|memory| memory.focused().is_none());
        answer.or(enter.then_some(answers[0].0))
    });
    if let Some(answer) = response.inner.or(response.should_close().then_some("cancel")) {
        app.act("answer", &[answer], ui.ctx());
    }
}
