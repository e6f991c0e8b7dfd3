//! Positions on the screen and in the plan, and the background colour.

use egui::{Context, Id, Pos2, Rect, vec2};

use crate::draw::{self, LabelColours, Palette, View};
use crate::geometry::Point;

pub(crate) fn plan_point(view: &View, rect: Rect, at: Pos2) -> Point {
    let from_corner = at - rect.min;
    view.plan_from_screen(Point::new(f64::from(from_corner.x), f64::from(from_corner.y)))
}

pub(crate) fn canvas_id() -> Id {
    Id::unique("canvas")
}

/// The background of the plan in the window's theme.
pub(crate) fn paper(colours: LabelColours, context: &Context) -> draw::Rgba {
    let theme = if context.global_style().visuals.dark_mode { draw::Theme::Dark } else { draw::Theme::Light };
    Palette::of(theme, colours).paper
}

/// The screen position of a point of the plan.
pub(crate) fn on_screen(rect: Rect, view: &View, point: Point) -> Pos2 {
    let place = view.screen_from_plan(point);
    rect.min + vec2(place.x as f32, place.y as f32)
}
