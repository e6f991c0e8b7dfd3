//! What was drawn last: until something else is selected or changed, the next key means it.

use super::Session;
use crate::geometry::Point;
use crate::plan::{ElementId, OpeningId, RoomId};

/// A room or an opening that has just been drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fresh {
    element: ElementId,
    /// Where the pointer was then: on a corner of the room, as a rule, and maybe over another one.
    at: Option<Point>,
}

impl Session {
    /// Records what was just drawn. What was selected before is meant no more.
    pub(crate) fn has_drawn(&mut self, element: Option<ElementId>) {
        let Some(element) = element else { return };
        self.select([], super::selection::SelectMode::Replace);
        self.fresh = Some(Fresh { element, at: self.pointed.at });
    }

    /// The room that was just drawn, while it is still the last thing done.
    pub(super) fn fresh_room(&self) -> Option<RoomId> {
        match self.fresh?.element {
            ElementId::Room(id) => self.plan()?.room(id).map(|_| id),
            _ => None,
        }
    }

    /// The same of an opening.
    pub(crate) fn fresh_opening(&self) -> Option<OpeningId> {
        match self.fresh?.element {
            ElementId::Opening(id) => self.plan()?.opening(id).map(|_| id),
            _ => None,
        }
    }

    /// Whether the pointer still is where it was when that was drawn, or on no canvas.
    pub(super) fn has_pointer_stayed(&self) -> bool {
        let drawn_at = self.fresh.and_then(|fresh| fresh.at);
        drawn_at.zip(self.pointed.at).is_none_or(|(then, now)| then.distance(now) <= self.pointed.near_m)
    }

    /// Does something to what was just drawn, which leaves it the last thing drawn.
    pub(crate) fn keeping_fresh(&mut self, act: impl FnOnce(&mut Self)) {
        let fresh = self.fresh;
        act(self);
        self.fresh = fresh;
    }
}
