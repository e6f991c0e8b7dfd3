//! The side panels, stacked.

use egui::{Frame, Margin, Panel, Rect, ScrollArea, Stroke, Ui, UiBuilder};

use crate::app::look::theme;
use crate::app::state::{App, Height, Side, SidePanel};

/// The panels currently shown at a side, from the top.
pub(super) fn shown(app: &App, side: Side) -> Vec<&'static SidePanel> {
    let has_plan = app.session.document.is_some();
    let is_shown =
        |panel: &&SidePanel| panel.side == side && app.panels.is_shown(panel.id) && (has_plan || !panel.needs_plan);
    app.panels.list.iter().filter(is_shown).collect()
}

/// Shows panels stacked.
pub(super) fn show(app: &mut App, ui: &mut Ui, panels: &[&'static SidePanel]) {
    // One of them gets the remaining height.
    let rest = panels.iter().position(|panel| matches!(panel.height, Height::Rest { .. })).unwrap_or(0);
    let Some(&filling) = panels.get(rest) else { return };
    let least = if let Height::Rest { least } = filling.height { least } else { 0.0 };
    let others = panels.iter().enumerate().filter(|(index, _)| *index != rest).map(|(_, panel)| *panel);
    for panel in others.clone().rev() {
        if let Height::Dragged { usual, least: own_least } = panel.height {
            let most = (ui.available_height() - least).max(own_least);
            Panel::bottom(panel.id)
                .resizable(true)
                .default_size(usual.min(most))
                .size_range(own_least..=most)
                .frame(Frame::new().fill(theme::colours(ui.visuals()).panel))
                .show(ui, |ui| (panel.show)(app, ui));
        }
    }
    let contents: Vec<(&SidePanel, f32)> = others
        .filter_map(|panel| match panel.height {
            Height::Content { usual } => {
                Some((panel, app.panels.content_heights.get(panel.id).copied().unwrap_or(usual)))
            }
            Height::Rest { .. } | Height::Dragged { .. } => None,
        })
        .collect();
    if contents.is_empty() {
        (filling.show)(app, ui);
        return;
    }
    // As high as their contents, which change: a panel that sizes itself does not grow again. In a low
    // window they scroll, so that the filling one keeps some space.
    let mut above = ui.available_rect_before_wrap();
    let mut places: Vec<(&SidePanel, f32, Rect)> = Vec::new();
    for (panel, wanted) in contents.into_iter().rev() {
        let given = wanted.min(above.height() - least).max(least);
        let (rest, place) = above.split_top_bottom_at_y(above.bottom() - given);
        places.push((panel, wanted, place));
        above = rest;
    }
    // From top to bottom, in Tab order.
    (filling.show)(app, &mut ui.new_child(UiBuilder::new().max_rect(above).id_salt(filling.id)));
    for (panel, wanted, place) in places.into_iter().rev() {
        let mut below = ui.new_child(UiBuilder::new().max_rect(place).id_salt(panel.id));
        let area = ScrollArea::vertical().id_salt(panel.id).auto_shrink(false);
        let height = area.show(&mut below, |ui| {
            let top = ui.cursor().top();
            (panel.show)(app, ui);
            ui.cursor().top() - top
        });
        if (height.inner - wanted).abs() > 0.5 {
            app.panels.content_heights.insert(panel.id, height.inner);
            ui.request_repaint();
        }
    }
    ui.take_available_space();
}

/// The contents of a panel that scrolls as a whole, with a line above.
pub(super) fn scrolled(ui: &mut Ui, name: &str, contents: impl FnOnce(&mut Ui)) {
    let line = Stroke::new(1.0, theme::colours(ui.visuals()).border);
    ui.painter().hline(ui.clip_rect().x_range(), ui.max_rect().top(), line);
    ScrollArea::vertical().id_salt(name).auto_shrink([false, false]).show(ui, |ui| {
        let margin = Margin { left: 16, right: 16, top: 12, bottom: 16 };
        Frame::new().inner_margin(margin).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 4.0;
            contents(ui);
        });
    });
}
