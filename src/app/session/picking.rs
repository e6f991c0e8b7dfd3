//! Picking, and going from room to room.

use super::Session;
use super::wishes::Wish;
use crate::app::session::document::Document;
use crate::app::session::selection::SelectMode;
use crate::app::session::selection::Selection;
use crate::geometry::Vector;
use crate::plan::ElementId;
use crate::plan::Room;
use crate::plan::RoomId;
impl Session {
    pub(crate) fn pick(&mut self, picked: Option<ElementId>) {
        self.commit_field();
        self.fresh = None;
        self.nudged = None;
        self.selection = Selection::of(picked);
    }

    pub(crate) fn select(&mut self, elements: impl IntoIterator<Item = ElementId>, mode: SelectMode) {
        self.commit_field();
        self.fresh = None;
        self.nudged = None;
        self.selection.select(elements, mode);
    }

    /// The picked room.
    pub(crate) fn picked_room(&self) -> Option<(RoomId, &Room)> {
        let Some(ElementId::Room(id)) = self.picked() else { return None };
        Some((id, self.plan()?.room(id)?))
    }

    /// Picks the room `step` places on in reading order: from the top left, line by line. With nothing
    /// picked, the first or the last. `false` if there is none.
    pub(crate) fn pick_neighbour(&mut self, step: isize) -> bool {
        let Some(derived) = self.document.as_ref().and_then(Document::derived) else { return false };
        let order = derived.reading_order();
        let at = match self.picked() {
            Some(ElementId::Room(id)) => order.iter().position(|&room| room == id),
            _ => None,
        };
        let next = match at {
            None if step > 0 => Some(0),
            None => order.len().checked_sub(1),
            Some(at) => at.checked_add_signed(step),
        };
        let Some(&id) = next.and_then(|next| order.get(next)) else { return false };
        self.pick(Some(ElementId::Room(id)));
        self.wishes.push(Wish::Reveal(ElementId::Room(id)));
        true
    }

    /// Picks the room nearest to the picked one in a direction of the plan; with nothing picked, the
    /// first.
    pub(crate) fn pick_towards(&mut self, direction: Vector) {
        let Some(derived) = self.document.as_ref().and_then(Document::derived) else { return };
        let Some(ElementId::Room(picked)) = self.picked() else {
            self.pick_neighbour(1);
            return;
        };
        let shapes = &derived.analysis.shapes;
        let Some(from) = shapes.get(picked).map(|shape| shape.bounds.center()) else { return };
        let nearest = shapes
            .all()
            .iter()
            .filter(|shape| shape.id != picked && !shape.bounds.is_empty())
            .filter_map(|shape| {
                let way = shape.bounds.center() - from;
                let (along, across) = (way.dot(direction), way.cross(direction).abs());
                // Within 60 degrees of the direction; sideways distance counts double.
                (along > 0.0 && across < along * 1.75).then_some((along + 2.0 * across, shape.id))
            })
            .min_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        if let Some((_, id)) = nearest {
            self.pick(Some(ElementId::Room(id)));
            self.wishes.push(Wish::Reveal(ElementId::Room(id)));
        }
    }

    pub(crate) fn zoom_to_picked(&mut self) {
        let Some((document, picked)) = self.document.as_ref().zip(self.picked()) else { return };
        if let Some(bounds) = document.bounds_of(picked) {
            self.wishes.push(Wish::ZoomTo(bounds));
        }
    }
}
