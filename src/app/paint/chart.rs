//! Paints the scene of a chart.

use egui::{Painter, Pos2, Rect, Shape, Stroke, pos2};

use super::scene_painter::paint_text_at;
use crate::app::look::theme;
use crate::draw::{Item, Length, Scene};
use crate::geometry::Point;

/// Where a point of a chart's picture is on the screen.
pub(crate) fn place(rect: Rect, point: Point) -> Pos2 {
    pos2(rect.left() + point.x as f32, rect.top() + point.y as f32)
}

/// Paints a chart with its upper left corner in that of `rect`. All its shapes are convex and on the screen's frame.
pub(crate) fn paint(painter: &Painter, rect: Rect, scene: &Scene) {
    let px = |length: Length| scene.view.px(length) as f32;
    let at = |point: &Point| place(rect, *point);
    for item in scene.groups.iter().flat_map(|group| &group.items) {
        match item {
            Item::Polygon { outer, colour, .. } => {
                let points: Vec<Pos2> = outer.iter().map(at).collect();
                let bounds = Rect::from_points(&points);
                // Bars: their edges on whole pixels, so that they are sharp.
                let sharp = |value: f32| (value * painter.pixels_per_point()).round() / painter.pixels_per_point();
                let min = pos2(sharp(bounds.min.x), sharp(bounds.min.y));
                let max = pos2(sharp(bounds.max.x).max(min.x + 1.0), sharp(bounds.max.y).max(min.y));
                painter.rect_filled(Rect::from_min_max(min, max), 0.0, theme::colour(*colour));
            }
            Item::Line { points, colour, width, .. } => {
                let stroke = Stroke::new(px(*width), theme::colour(*colour));
                match points.as_slice() {
                    [p, q] if p.y == q.y => {
                        painter.hline(at(p).x..=at(q).x, painter.round_to_pixel_center(at(p).y), stroke);
                    }
                    _ => drop(painter.add(Shape::line(points.iter().map(at).collect(), stroke))),
                }
            }
            Item::Disc { centre, radius, fill, outline } => {
                if let Some(fill) = fill {
                    painter.circle_filled(at(centre), px(*radius), theme::colour(*fill));
                }
                if let Some((colour, width)) = outline {
                    painter.circle_stroke(at(centre), px(*radius), Stroke::new(px(*width), theme::colour(*colour)));
                }
            }
            Item::Text(text) => paint_text_at(painter, place(rect, text.at), &scene.view, text),
            Item::Arc { .. } | Item::Picture(_) => {}
        }
    }
}
