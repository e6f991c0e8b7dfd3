//! What all text fields have in common.

use egui::text::{CCursor, CCursorRange};
use egui::text_edit::TextEditState;
use egui::{Context, Id, Response, Ui};

/// Selects all that is in a field, so that what is typed takes its place.
pub(crate) fn select_all(context: &Context, id: Id, text: &str) {
    select(context, id, 0..text.chars().count());
}

/// Selects some characters of a field; of an empty range, puts the cursor there.
pub(crate) fn select(context: &Context, id: Id, range: std::ops::Range<usize>) {
    let mut state = TextEditState::load(context, id).unwrap_or_default();
    let range = CCursorRange::two(CCursor::new(range.start), CCursor::new(range.end));
    state.cursor.set_char_range(Some(range));
    state.store(context, id);
}

/// The same when a field has just got the keyboard by the keyboard: a click says itself where to write.
pub(crate) fn select_when_entered(ui: &Ui, field: &Response, text: &str) {
    let is_clicked = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_released());
    if field.gained_focus() && !is_clicked {
        select_all(ui.ctx(), field.id, text);
    }
}
