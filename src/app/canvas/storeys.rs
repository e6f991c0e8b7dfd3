//! The stairs and lifts that lead to the storey shown below.

use egui::{Painter, Rect, Shape, Stroke, vec2};

use crate::app::look::theme;
use crate::app::paint::places::on_screen;
use crate::app::session::ghost::Ghost;
use crate::draw::{Palette, View};
use crate::geometry::Point;
use crate::plan::Plan;
use crate::topology::RoomShapes;

/// A mark beside a corner of a room: half its side, in points.
const HALF: f32 = 8.0;

/// Rooms smaller than this on the screen have no place for a mark, in points.
const LEAST_PX: f32 = 30.0;

/// Marks each room whose stairs or lift lie over those below: an arrow down in its lower left corner, and a dashed line
/// around the room below.
/// `above` holds the rooms as they are drawn.
pub(super) fn paint_links(
    painter: &Painter,
    rect: Rect,
    view: &View,
    plan: &Plan,
    above: &RoomShapes,
    below: &Ghost,
    palette: &Palette,
) {
    let lower = &below.derived.analysis.shapes;
    let ink = theme::colour(palette.snap);
    for link in below.links_to(plan).iter() {
        if let Some(shape) = lower.get(link.lower) {
            let mut ring: Vec<_> = shape.outer.iter().map(|point| on_screen(rect, view, *point)).collect();
            ring.extend(ring.first().copied());
            painter.extend(Shape::dashed_line(&ring, Stroke::new(1.5, ink), 6.0, 4.0));
        }
        let Some(shape) = above.get(link.upper) else { continue };
        let (a, b) = (on_screen(rect, view, shape.bounds.min), on_screen(rect, view, shape.bounds.max));
        let seen = Rect::from_two_pos(a, b);
        if seen.width().min(seen.height()) < LEAST_PX {
            continue;
        }
        let corner = seen.left_bottom();
        // The corner of the room itself: that of its bounds may lie outside it.
        let to_corner = |point: &Point| on_screen(rect, view, *point).distance(corner);
        let Some(nearest) = shape.outer.iter().min_by(|p, q| to_corner(p).total_cmp(&to_corner(q))) else { continue };
        let centre = on_screen(rect, view, *nearest) + vec2(HALF + 6.0, -HALF - 6.0);
        paint_arrow_down(painter, centre, ink, theme::colour(palette.paper));
    }
}

/// A round mark with an arrow down.
fn paint_arrow_down(painter: &Painter, centre: egui::Pos2, ink: egui::Color32, paper: egui::Color32) {
    painter.circle(centre, HALF, paper, Stroke::new(1.5, ink));
    let (top, tip) = (centre - vec2(0.0, 4.0), centre + vec2(0.0, 4.0));
    let stroke = Stroke::new(1.5, ink);
    painter.line_segment([top, tip], stroke);
    painter.line_segment([tip - vec2(3.0, 3.0), tip], stroke);
    painter.line_segment([tip - vec2(-3.0, 3.0), tip], stroke);
}
