//! What the forms of the dashboard, of training and of schemes share.

use egui::{Align2, ComboBox, FontId, Id, Modal, ModalResponse, Role, Sense, TextEdit, Ui, WidgetInfo, vec2};

use crate::app::look::theme;
use crate::app::look::widgets::{Segment, colours, dialog_frame, focus_ring, follow_focus, put_line, segmented};

/// A dialog of this size, width and height in points, where the window is large enough.
pub(super) fn large_dialog<T>(
    ui: &Ui,
    name: &str,
    largest: [f32; 2],
    contents: impl FnOnce(&mut Ui) -> T,
) -> ModalResponse<T> {
    let size = ui.ctx().content_rect().size() - vec2(96.0, 96.0);
    let size = size.min(largest.into()).max(vec2(320.0, 240.0));
    Modal::new(Id::unique(name)).frame(dialog_frame(ui)).show(ui.ctx(), |ui| {
        ui.set_width(size.x);
        ui.set_height(size.y);
        contents(ui)
    })
}

/// A line of a form: a caption, and the control in the rest.
pub(super) fn line<T>(ui: &mut Ui, width: f32, name: &str, control: impl FnOnce(&mut Ui) -> T) -> T {
    ui.horizontal_top(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(width, 28.0), Sense::hover());
        put_line(ui, name, FontId::proportional(theme::BODY), colours(ui).text_weak, rect);
        ui.vertical(control).inner
    })
    .inner
}

/// A list to choose one of several from, with the name a screen reader says.
pub(super) fn pick<T: Clone + PartialEq>(
    ui: &mut Ui,
    name: &str,
    width: f32,
    value: &mut T,
    options: &[(T, String)],
) -> bool {
    let before = value.clone();
    let current = options.iter().find(|(of, _)| of == value).map(|(_, title)| title.as_str()).unwrap_or_default();
    let list = ComboBox::from_id_salt(("pick", name)).width(width).selected_text(current).truncate();
    let shown = list.show_ui(ui, |ui| {
        for (of, title) in options {
            if ui.selectable_label(of == value, title).clicked() {
                value.clone_from(of);
            }
        }
    });
    follow_focus(&shown.response);
    focus_ring(ui, shown.response.rect, &shown.response);
    let (is_enabled, said) = (ui.is_enabled(), format!("{name}: {current}"));
    shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, is_enabled, &said));
    before != *value
}

/// A choice of one of several, side by side.
pub(super) fn choose<T: Clone + PartialEq>(
    ui: &mut Ui,
    name: &str,
    value: &mut T,
    options: &[(T, &str, &str)],
) -> bool {
    let segments: Vec<Segment<'_>> = options
        .iter()
        .map(|(option, text, help)| Segment { text, name: text, help, is_on: value == option, colour: None })
        .collect();
    let clicked = ui.push_id(name, |ui| segmented(ui, &segments)).inner;
    clicked.is_some_and(|index| {
        let is_new = *value != options[index].0;
        value.clone_from(&options[index].0);
        is_new
    })
}

/// A text field. Returns whether its text changed.
pub(super) fn text(ui: &mut Ui, name: &str, value: &mut String, width: f32, hint: &str) -> egui::Response {
    let edit = TextEdit::singleline(value).desired_width(width).hint_text(hint).align(Align2::LEFT_CENTER);
    let response = ui.add(edit.id_salt(("form", name)));
    response.accessible_name(name)
}
