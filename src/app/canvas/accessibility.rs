//! The canvas for screen readers and scripts.

use std::sync::Arc;

use egui::{Rect, Role, Sense, Ui, WidgetInfo};

use super::{Act, Canvas};
use crate::app::paint::places::{canvas_id, on_screen};
use crate::app::session::Session;
use crate::app::session::document::{Derived, Document};
use crate::base::units::Units;
use crate::draw::View;
use crate::features::RoomStatus;
use crate::labels::normalised_function;
use crate::plan::titles::title_of;
use crate::plan::{ElementId, Plan};
use crate::topology::RoomShape;

impl Canvas {
    /// Adds rooms as nodes of the accessibility tree, for screen readers and scripts: painted things are
    /// otherwise invisible to them. Returns what they ask for.
    pub(super) fn tell_screen_reader(
        &self,
        ui: &Ui,
        rect: Rect,
        view: &View,
        document: &Document,
        fresh: Option<&Arc<Derived>>,
        session: &Session,
    ) -> Option<Act> {
        if !ui.ctx().has_accesskit_node(canvas_id()) {
            return None;
        }
        let mut act = None;
        let derived = fresh?;
        for shape in derived.analysis.shapes.all().iter().filter(|shape| !shape.outer.is_empty()) {
            let corners = [shape.bounds.min, shape.bounds.max].map(|point| on_screen(rect, view, point));
            let bounds = Rect::from_two_pos(corners[0], corners[1]);
            if !bounds.intersects(rect) {
                continue;
            }
            let this = ElementId::Room(shape.id);
            let id = canvas_id().with(shape.id);
            let response = ui.interact(bounds.intersect(rect), id, Sense::hover());
            let label = title_of(document.plan(), this);
            response.widget_info(|| {
                WidgetInfo::selected(Role::ListBoxOption, true, session.picked() == Some(this), &label)
            });
            let said = said_of_room(document.plan(), derived, shape, session.units());
            ui.ctx().accesskit_node_builder(id, |node| {
                node.add_action(egui::accesskit::Action::Click);
                node.set_description(said);
            });
            if ui.input(|input| input.has_accesskit_action_request(id, egui::accesskit::Action::Click)) {
                act = Some(Act::Pick(this));
            }
        }
        act
    }
}

/// The canvas's contents, in a sentence.
pub(super) fn describe(document: &Document, picked: Option<ElementId>) -> String {
    let plan = document.plan();
    let mut text = format!("Plan {}, {} rooms", document.title(), plan.rooms().len());
    if let Some(picked) = picked {
        text.push_str(&format!("; selected: {}", title_of(plan, picked)));
    }
    text
}

/// A room's area, and that it is the clear one where walls take some of it.
fn area_in_words(derived: &Derived, shape: &RoomShape, units: Units) -> String {
    match derived.analysis.net(shape.id) {
        Some(net) if net.has_walls => format!("{} clear", units.area(net.area_m2)),
        _ => units.area(shape.area_m2()),
    }
}

/// A room's label and area, in words.
fn said_of_room(plan: &Plan, derived: &Derived, shape: &RoomShape, units: Units) -> String {
    let status = derived.analysis.room(shape.id).map(|room| room.status);
    let label = match status {
        Some(RoomStatus::Labelled(label)) => label.name(),
        Some(RoomStatus::NotClassified) => "not classified",
        Some(RoomStatus::Unlabelled) | None => "no label",
    };
    let function = plan.room(shape.id).map(|room| room.function.trim()).unwrap_or_default();
    let function = if function.is_empty() { String::new() } else { format!(", {}", normalised_function(function)) };
    format!("{label}{function}, {}", area_in_words(derived, shape, units))
}
