//! What scripts check.

use egui::Rect;

use crate::app::panels;
use crate::app::state::App;
use crate::features::RoomStatus;
use crate::geometry::{Point, Vector};
use crate::plan::{ElementId, RoomId};

impl App {
    /// The canvas's place in the last frame, in logical pixels; `None` without a plan.
    pub fn canvas_rect(&self) -> Option<Rect> {
        self.session.document.as_ref()?;
        self.canvas.seen_rect()
    }

    /// A point of the plan where a click picks this room: in the middle of the room's box, or of a
    /// stretch of the room at that height, otherwise in the middle of a stretch higher or lower.
    pub(super) fn place_in_room(&self, room: RoomId) -> Option<Point> {
        /// Heights of the room's box to try, best first.
        const HEIGHTS: [f64; 9] = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8, 0.1, 0.9];
        let derived = self.session.document.as_ref()?.derived()?;
        let shape = derived.analysis.shapes.get(room)?;
        let bounds = shape.bounds;
        let stretches = HEIGHTS.into_iter().flat_map(|height| {
            let left = Point::new(bounds.min.x, bounds.min.y + bounds.height() * height);
            let mut stretches = shape.stretches(left, Vector::new(1.0, 0.0), bounds.width());
            stretches.sort_by(|p, q| (q.1 - q.0).total_cmp(&(p.1 - p.0)));
            stretches.into_iter().map(move |(from, to)| left + Vector::new((from + to) / 2.0, 0.0))
        });
        let reach_m = self.canvas.pick_reach_m();
        let is_picked = |point: &Point| derived.at(*point, reach_m).first() == Some(&ElementId::Room(room));
        std::iter::once(bounds.center()).chain(stretches).find(is_picked)
    }

    /// The status of a room's label.
    pub(super) fn status_of(&self, room: RoomId) -> Option<RoomStatus> {
        let plan = self.plan()?;
        Some(RoomStatus::of(plan, &self.session.schemes, plan.room(room)?))
    }

    /// The text of the status line.
    pub(super) fn status_text(&self) -> String {
        panels::status::left_text(self)
    }

    /// The window's title.
    pub(super) fn window_title(&self) -> &str {
        &self.shown_title
    }
}
