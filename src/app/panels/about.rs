//! The About dialog.

use crate::app::state::dialogs;
use egui::{Id, Modal, Ui};

use crate::app::look::{
    theme,
    widgets::{caption, dialog_frame, right, strong, text_button},
};
use crate::app::state::App;
use crate::app::state::{After, Dialog, Entry};

pub(super) const ENTRY: Entry = Entry { id: ID, make: |_, _| Box::new(About), is_of_plan: false };

pub(crate) const ID: &str = dialogs::ABOUT;

struct About;

impl Dialog for About {
    fn show(&mut self, _: &mut App, ui: &mut Ui) -> After {
        show(ui)
    }
}

fn show(ui: &Ui) -> After {
    let response = Modal::new(Id::unique("about")).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(440.0_f32.min(ui.ctx().content_rect().width() - 80.0).max(0.0));
        ui.label(strong("Enfilade", theme::DISPLAY));
        caption(ui, concat!("Version ", env!("CARGO_PKG_VERSION")));
        ui.add_space(10.0);
        let text = "A suite of rooms whose doors stand in one line. Draws and labels floor plans, classifies \
                    their rooms by building typology, and exports datasets.";
        ui.add(egui::Label::new(text).wrap());
        ui.add_space(6.0);
        caption(
            ui,
            "The features are those of M. Luperto, A. Quattrini Li and F. Amigoni, A System for Building Semantic \
             Maps of Indoor Environments Exploiting the Concept of Building Typology.",
        );
        ui.add_space(6.0);
        caption(ui, "Licence: MIT or Apache-2.0, as you like. The font is Inter, under the SIL Open Font Licence.");
        ui.add_space(12.0);
        let mut is_done = false;
        ui.horizontal(|ui| right(ui, |ui| is_done = text_button(ui, "Close", true).clicked()));
        is_done
    });
    if response.inner || response.should_close() { After::Close } else { After::Stay }
}
