//! What is missing and can be given with one click: a plan's typology, a room's function.

use super::*;

impl Inspected<'_> {
    /// The typologies to choose from, for a plan that has none.
    pub(super) fn typology_choice(&self, ui: &mut Ui) -> Option<Act> {
        if self.plan.meta().typology.is_some() {
            return None;
        }
        let mut act = None;
        ui.add_space(2.0);
        caption(ui, "What kind of building is this? Then the functions of its rooms give them labels.");
        ui.horizontal_wrapped(|ui| {
            for typology in self.app.session.schemes.typologies() {
                if text_button(ui, &typology.title(), false).clicked() {
                    act = Some(Act::Choose("set-typology", vec![typology.as_str().to_owned()]));
                }
            }
        });
        ui.add_space(4.0);
        act
    }

    /// The function that the room's name speaks for, if it has none.
    pub(super) fn proposed_function(&self, ui: &mut Ui, room: RoomId) -> Option<Act> {
        let (_, function) = self.app.session.proposed_functions(&[room]).pop()?;
        let command = commands::find("accept-function")?;
        let keys = self.app.keys_text(command, ui.ctx());
        let mut act = None;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 8.0;
            if link(ui, &format!("Set function to {function}")).on_hover_text(command.help).clicked() {
                act = Some(Act::Command(command.id));
            }
            if !keys.is_empty() {
                caption(ui, keys);
            }
        });
        act
    }
}
