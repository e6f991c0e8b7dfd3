//! The labels that follow on the plan: what rooms would be called while something is dragged, and where a second opinion is
//! another.

use egui::{Align2, Painter, Rect, Shape, Stroke, vec2};

use super::Canvas;
use crate::app::look::theme;
use crate::app::paint::places::on_screen;
use crate::app::paint::preview::tag;
use crate::app::paint::scene_painter::{earcut, outline_mesh, polygon_mesh};
use crate::app::session::Session;
use crate::app::session::document::{Derived, Labelled};
use crate::app::session::live::changes;
use crate::classify::Distribution;
use crate::draw::{Fill, Palette, View, predicted_fill};
use crate::features::RoomStatus;
use crate::plan::{Plan, RoomId};
use crate::topology::RoomShapes;

/// The most rooms that are marked at once: more tell nobody anything.
const MOST: usize = 40;

/// Rooms smaller than this on the screen have no space for a label beside another, in points.
const SMALLEST_PX: f64 = 44.0;

impl Canvas {
    /// Shows how labels would change if the plan became this one.
    pub(super) fn paint_would_be(
        &self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        session: &Session,
        next: &Plan,
        palette: &Palette,
    ) {
        let Some(now) = session.document.as_ref().and_then(|document| document.labelled()) else { return };
        let Some(then) = session.labels_if(next) else { return };
        for changed in changes(now, &then).into_iter().take(MOST) {
            let Some(shape) = then.analysis.shapes.get(changed.room).filter(|shape| shape.outer.len() > 2) else {
                continue;
            };
            let ((before, was), (after, is)) = (changed.before, changed.after);
            if changed.is_flip() {
                let triangles = earcut(&shape.outer, &shape.holes);
                let fill = theme::colour(predicted_fill(palette, RoomStatus::Labelled(after), is)).gamma_multiply(0.85);
                painter.add(Shape::mesh(polygon_mesh(rect, view, &shape.outer, &shape.holes, &triangles, fill)));
                let stroke = Stroke::new(2.0, theme::colour(palette.selection));
                for ring in shape.rings() {
                    painter.add(Shape::mesh(outline_mesh(rect, view, ring, stroke)));
                }
            }
            let text = match changed.is_flip() {
                true => format!("{before} → {after}  {:.0} %", 100.0 * is),
                false => format!("{after}  {:.0} → {:.0} %", 100.0 * was, 100.0 * is),
            };
            let ink = theme::colour(if changed.is_flip() { palette.selection } else { palette.ink });
            let at = on_screen(rect, view, shape.bounds.center());
            tag(painter, at + vec2(0.0, 24.0), Align2::CENTER_CENTER, &text, ink, palette);
        }
    }

    /// Writes the label of the second opinion into the rooms where it is another.
    pub(super) fn paint_second_opinion(
        &self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        session: &Session,
        derived: &Derived,
        palette: &Palette,
    ) {
        if session.layers.fill != Fill::Prediction {
            return;
        }
        let seen = view.bounds();
        let shapes: &RoomShapes = &derived.analysis.shapes;
        let shown = session.disagreements().into_iter().filter_map(|(room, _, (label, sure))| {
            let shape = shapes.get(room).filter(|shape| shape.bounds.intersects(seen))?;
            let is_large = shape.bounds.width().min(shape.bounds.height()) * view.px_per_m >= SMALLEST_PX;
            is_large.then_some((shape, label, sure))
        });
        for (shape, label, sure) in shown.take(MOST) {
            let at = on_screen(rect, view, shape.bounds.center()) + vec2(0.0, 26.0);
            let text = format!("or {label} {:.0} %", 100.0 * sure);
            let ground = tag(painter, at, Align2::CENTER_CENTER, &text, theme::colour(palette.ink), palette);
            let mark = Rect::from_min_size(ground.left_top(), vec2(4.0, ground.height()));
            painter.rect_filled(mark, 2.0, theme::colour(palette.label_strong(label)));
        }
    }
}

/// A change of the sureness that is seen: by five percentage points.
const SEEN: f64 = 0.05;

/// Recolours the rooms whose predicted label is another than in the drawing below, or whose sureness has visibly changed, and those
/// whose fill was painted over. Returns these rooms: their halves of the walls around them are covered.
pub(super) fn paint_new_labels(
    painter: &Painter,
    rect: Rect,
    view: &View,
    drawn: &Labelled,
    now: &Labelled,
    is_covered: &dyn Fn(RoomId) -> bool,
    palette: &Palette,
) -> Vec<RoomId> {
    let Some((earlier, later)) = drawn.predictions.as_ref().zip(now.predictions.as_ref()) else { return Vec::new() };
    let mut recoloured = Vec::new();
    let seen = view.bounds();
    for (room, said) in later.network.rooms.iter().zip(&later.result.distributions) {
        let (label, sure) = said.likeliest();
        let before = earlier.distribution(room.id).map(Distribution::likeliest);
        let is_as_before = before.is_some_and(|(was, was_sure)| was == label && (was_sure - sure).abs() < SEEN);
        let shape = now.analysis.shapes.get(room.id).filter(|shape| shape.bounds.intersects(seen));
        let Some(shape) = shape.filter(|_| !is_as_before || is_covered(room.id)) else { continue };
        let triangles = earcut(&shape.outer, &shape.holes);
        let fill = theme::colour(predicted_fill(palette, RoomStatus::Labelled(label), sure));
        painter.add(Shape::mesh(polygon_mesh(rect, view, &shape.outer, &shape.holes, &triangles, fill)));
        recoloured.push(room.id);
    }
    recoloured
}
