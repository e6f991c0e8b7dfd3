//! What a point of a reason is about, marked on the plan: the room's axes, its openings, other rooms.

use std::sync::Arc;

use egui::{Align2, Painter, Rect, Shape, Stroke, vec2};

use super::Canvas;
use super::marks::{MOST_MARKED, Mark};
use crate::app::look::theme;
use crate::app::paint::places::on_screen;
use crate::app::paint::scene_painter::{earcut, outline_mesh, polygon_mesh};
use crate::app::session::document::Derived;
use crate::app::tools::tag;
use crate::base::units::Units;
use crate::draw::{Palette, View};
use crate::geometry::Segment;
use crate::geometry::runs::Run;
use crate::plan::{ElementId, Plan};

impl Canvas {
    /// Marks what was seen.
    pub(super) fn paint_evidence(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        plan: &Plan,
        derived: &Arc<Derived>,
        units: Units,
        palette: &Palette,
    ) {
        let Some(marks) = self.evidence.take() else { return };
        let ink = theme::colour(palette.selection);
        let shapes = &derived.analysis.shapes;
        let area = marks.shows_area.then_some(&marks.room);
        for &room in area.into_iter().chain(&marks.rooms).take(MOST_MARKED) {
            let Some(shape) = shapes.get(room).filter(|shape| !shape.outer.is_empty()) else { continue };
            let triangles = earcut(&shape.outer, &shape.holes);
            let fill = ink.gamma_multiply(0.28);
            painter.add(Shape::mesh(polygon_mesh(rect, view, &shape.outer, &shape.holes, &triangles, fill)));
            for ring in shape.rings() {
                painter.add(Shape::mesh(outline_mesh(rect, view, ring, Stroke::new(2.0, ink))));
            }
        }
        for (index, &opening) in marks.openings.iter().take(MOST_MARKED).enumerate() {
            self.mark(painter, rect, view, plan, derived, ElementId::Opening(opening), &Mark::picked(palette));
            let segment = plan.opening(opening).and_then(|opening| plan.opening_segment(opening));
            if let Some(segment) = segment {
                let at = on_screen(rect, view, segment.midpoint());
                let number = (index + 1).to_string();
                tag(
                    painter,
                    at + vec2(0.0, -16.0),
                    Align2::CENTER_CENTER,
                    &number,
                    theme::colour(palette.ink),
                    palette,
                );
            }
        }
        let axes = derived.analysis.room(marks.room).and_then(|room| room.axes).filter(|_| marks.shows_axes);
        if let Some(axes) = axes {
            for (name, Run { start, end }) in [("M", axes.major), ("m", axes.minor)] {
                let segment = Segment::new(start, end);
                let [from, to] = [start, end].map(|point| on_screen(rect, view, point));
                painter.line_segment([from, to], Stroke::new(4.0, ink));
                let across = (to - from).normalized().rot90() * 7.0;
                for tip in [from, to] {
                    painter.line_segment([tip - across, tip + across], Stroke::new(2.0, ink));
                }
                let at = from + (to - from) / 2.0;
                let text = format!("{name}  {}", units.length(segment.length()));
                tag(painter, at, Align2::CENTER_CENTER, &text, theme::colour(palette.ink), palette);
            }
        }
    }
}
