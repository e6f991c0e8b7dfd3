//! Guide lines on the canvas.

use egui::{Align2, FontId, Painter, Pos2, Rect, Stroke, vec2};

use crate::app::look::theme;
use crate::app::paint::places::{on_screen, plan_point};
use crate::app::session::Session;
use crate::base::units::Units;
use crate::draw::View;
use crate::geometry::{Point, trim_m};
use crate::plan::GuideAxis;

/// A guide being dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Drag {
    pub axis: GuideAxis,
    /// Its previous position; `None` for a new one.
    pub from_m: Option<f64>,
    /// Where it would be dropped; `None` if that would remove it.
    pub to_m: Option<f64>,
    /// The ruler it was dragged from, by the axis of the guides that cross it.
    pub ruler: GuideAxis,
}

/// The positions of the guides of an axis, except the one being dragged.
pub(crate) fn places(session: &Session, drag: Option<Drag>, axis: GuideAxis) -> impl Iterator<Item = f64> + '_ {
    let dragged = drag.filter(|drag| drag.axis == axis).and_then(|drag| drag.from_m);
    session
        .guides()
        .iter()
        .filter(move |guide| guide.axis == axis && Some(guide.at_m) != dragged)
        .map(|guide| guide.at_m)
}

/// How close to a guide the pointer must be to mean it, in points.
const REACH: f32 = 5.0;

/// The guide line at a point of the plan, the nearest if there are several.
pub(crate) fn guide_at(rect: Rect, view: &View, session: &Session, point: Point) -> Option<(GuideAxis, f64)> {
    let at = on_screen(rect, view, point);
    let guides = GuideAxis::ALL.into_iter().flat_map(|axis| {
        places(session, None, axis).map(move |at_m| {
            let place = on_canvas(rect, view, axis, at_m);
            let distance = match axis {
                GuideAxis::Horizontal => (place.y - at.y).abs(),
                GuideAxis::Vertical => (place.x - at.x).abs(),
            };
            (distance, axis, at_m)
        })
    });
    let near = guides.filter(|(distance, ..)| *distance <= REACH).min_by(|p, q| p.0.total_cmp(&q.0));
    near.map(|(_, axis, at_m)| (axis, at_m))
}

/// A point on a guide, on the screen.
pub(crate) fn on_canvas(rect: Rect, view: &View, axis: GuideAxis, at_m: f64) -> Pos2 {
    on_screen(
        rect,
        view,
        match axis {
            GuideAxis::Horizontal => Point::new(0.0, at_m),
            GuideAxis::Vertical => Point::new(at_m, 0.0),
        },
    )
}

/// Where a guide dragged to a screen position would be dropped: at the nearest round length that a pixel
/// resolves. `None` outside the canvas and, for a new guide, also on the ruler.
pub(crate) fn dropped_at(drag: &Drag, at: Pos2, rect: Rect, view: &View, units: Units) -> Option<f64> {
    let is_inside = match (drag.from_m, drag.axis) {
        (None, _) => rect.contains(at),
        // Along its ruler, whether on it or not.
        (Some(_), GuideAxis::Vertical) => rect.x_range().contains(at.x),
        (Some(_), GuideAxis::Horizontal) => rect.y_range().contains(at.y),
    };
    let step_m = units.round_length_at_most(1.0 / view.px_per_m);
    let at_m = drag.axis.coordinate(plan_point(view, rect, at));
    is_inside.then(|| trim_m((at_m / step_m).round() * step_m))
}

/// Paints the guides, and the dragged one with its position.
pub(crate) fn paint(painter: &Painter, rect: Rect, view: &View, session: &Session, drag: Option<Drag>) {
    let colours = theme::colours(&painter.ctx().global_style().visuals);
    let line = |axis: GuideAxis, at_m: f64, stroke: Stroke| {
        let place = on_canvas(rect, view, axis, at_m);
        match axis {
            GuideAxis::Horizontal => painter.hline(rect.x_range(), place.y, stroke),
            GuideAxis::Vertical => painter.vline(place.x, rect.y_range(), stroke),
        };
    };
    let stroke = Stroke::new(1.0, colours.accent.gamma_multiply(0.75));
    for axis in GuideAxis::ALL {
        for at_m in places(session, drag, axis) {
            line(axis, at_m, stroke);
        }
    }
    let Some((drag, to_m)) = drag.and_then(|drag| Some((drag, drag.to_m?))) else { return };
    line(drag.axis, to_m, Stroke::new(1.5, colours.accent));
    if let Some(pointer) = painter.ctx().pointer_hover_pos() {
        let name = if drag.axis == GuideAxis::Vertical { "x" } else { "y" };
        let text = format!("{name} {}", session.units().length(to_m));
        let font = FontId::new(theme::SMALL, theme::semibold());
        let galley = painter.layout_no_wrap(text, font, colours.on_accent);
        let place = Align2::LEFT_TOP.anchor_size(pointer + vec2(14.0, 14.0), galley.size() + vec2(12.0, 6.0));
        painter.rect_filled(place, 4.0, colours.accent);
        painter.galley(place.min + vec2(6.0, 3.0), galley, colours.on_accent);
    }
}
