//! What an import repaired or skipped.

use crate::app::state::dialogs;
use crate::app::value::{Call, Value};
use egui::{Id, Label, Modal, RichText, ScrollArea, Ui, vec2};

use crate::app::look::{
    theme,
    widgets::{caption, colours, dialog_frame, right, strong, text_button},
};
use crate::app::session::origin::notes_in_words;
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry};
use crate::formats::NoteKind;

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, _| Box::new(Notes), is_of_plan: true };

pub(crate) const ID: &str = dialogs::NOTES;

struct Notes;

impl Dialog for Notes {
    fn show(&mut self, app: &mut App, ui: &mut Ui) -> After {
        show(app, ui);
        After::Stay
    }
}

/// The button, and other ways to close it, run the command, so that this is recorded.
fn show(app: &mut App, ui: &Ui) {
    let Some(document) = &app.session.document else { return };
    let response = Modal::new(Id::unique("import notes")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(620.0_f32.min(ui.ctx().content_rect().width() - 80.0).max(0.0));
        ui.label(strong("Import notes", theme::TITLE));
        caption(ui, format!("{}: {}", document.origin.title(), notes_in_words(&document.notes)));
        ui.add_space(8.0);
        let height = (ui.ctx().content_rect().height() - 240.0).clamp(80.0, 420.0);
        ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
            for note in &document.notes {
                let (word, colour) = match note.kind {
                    NoteKind::Healed => ("Mended", colours(ui).text_weak),
                    NoteKind::Skipped => ("Left out", colours(ui).warning),
                };
                ui.horizontal_top(|ui| {
                    let word = strong(word, theme::SMALL).color(colour);
                    ui.allocate_ui(vec2(64.0, 18.0), |ui| {
                        ui.set_width(64.0);
                        ui.label(word);
                    });
                    ui.vertical(|ui| {
                        ui.spacing_mut().item_spacing.y = 1.0;
                        ui.add(Label::new(&note.what).wrap().selectable(true));
                        let place = RichText::new(note.place.to_string()).size(theme::SMALL);
                        ui.add(Label::new(place.color(colours(ui).text_weak)).wrap().selectable(true));
                    });
                });
                ui.add_space(4.0);
            }
        });
        ui.add_space(12.0);
        let mut is_done = false;
        ui.horizontal(|ui| right(ui, |ui| is_done = text_button(ui, "Close", true).clicked()));
        is_done
    });
    if response.inner || response.should_close() {
        app.act_on(Call::new("import-notes", [Value::Switch(false)]), ui.ctx());
    }
}
