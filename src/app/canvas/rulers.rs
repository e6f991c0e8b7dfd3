//! Rulers along the top and left edges of the canvas, in the current units. They mark the pointer's
//! position; guide lines are dragged out of them.

use std::sync::Arc;

use egui::epaint::TextShape;
use egui::{
    Color32, CursorIcon, FontId, Galley, Id, Painter, PointerButton, Pos2, Rect, Role, Sense, Shape, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::app::canvas::Canvas;
use crate::app::canvas::guides::{self, Drag};
use crate::app::look::theme::{self, Colours};
use crate::app::paint::places::{on_screen, plan_point};
use crate::app::session::Session;
use crate::app::value::{Call, Value};
use crate::base::units::Units;
use crate::draw::View;
use crate::geometry::Point;
use crate::plan::GuideAxis;

/// Width of a ruler in points.
const WIDTH: f32 = 20.0;

/// Minimum spacing of numbered ticks, in points.
const NUMBERED: f64 = 64.0;

/// Minimum spacing of ticks, in points.
const CLOSEST: f64 = 5.0;

/// Font size of the numbers, in points.
const TEXT: f32 = 10.0;

/// How close to a guide the pointer must be to take it, in points.
const REACH: f32 = 5.0;

/// The part of a rectangle that the rulers leave to the canvas.
pub(crate) fn canvas_rect(session: &Session, all: Rect) -> Rect {
    if session.layers.rulers { Rect::from_min_max(all.min + vec2(WIDTH, WIDTH), all.max) } else { all }
}

/// Shows the rulers around the canvas just shown, if they are on.
pub(crate) fn show(canvas: &mut Canvas, session: &Session, help: &str, ui: &mut Ui) -> Vec<Call> {
    let mut calls = Vec::new();
    let Some((view, rect)) = canvas.seen().filter(|_| session.layers.rulers) else { return calls };
    let colours = theme::colours(ui.visuals());
    let all = ui.available_rect_before_wrap();
    let above = Rect::from_min_max(pos2(rect.left(), all.top()), pos2(rect.right(), rect.top()));
    let beside = Rect::from_min_max(pos2(all.left(), rect.top()), pos2(rect.left(), rect.bottom()));
    // The top ruler measures x; dragging out of it makes horizontal guides, as in other programs.
    for (axis, strip) in [(GuideAxis::Vertical, above), (GuideAxis::Horizontal, beside)] {
        let painter = ui.painter_at(strip);
        painter.rect_filled(strip, 0.0, colours.panel);
        Ruler { axis, strip, view: &view, rect, units: session.units(), colours }.paint(&painter);
        mark_guides(session, canvas.guide_drag, &painter, strip, axis, &view, rect, colours);
        if let Some(pointer) = session.pointed.at {
            let place = on_screen(rect, &view, pointer);
            let stroke = Stroke::new(1.0, colours.accent);
            match axis {
                GuideAxis::Vertical => painter.vline(place.x, strip.y_range(), stroke),
                GuideAxis::Horizontal => painter.hline(strip.x_range(), place.y, stroke),
            };
        }
        calls.extend(take_pointer(canvas, session, help, ui, strip, axis, &view, rect));
    }
    let corner = Rect::from_min_max(all.min, rect.min);
    ui.painter().rect_filled(corner, 0.0, colours.panel);
    let font = FontId::proportional(TEXT);
    ui.painter().text(corner.center(), egui::Align2::CENTER_CENTER, session.units().symbol(), font, colours.text_weak);
    let line = Stroke::new(1.0, colours.border);
    ui.painter().hline(all.x_range(), rect.top(), line);
    ui.painter().vline(rect.left(), all.y_range(), line);
    calls
}

struct Ruler<'a> {
    /// The axis of the guides at its ticks.
    axis: GuideAxis,
    strip: Rect,
    view: &'a View,
    rect: Rect,
    units: Units,
    colours: &'a Colours,
}

impl Ruler<'_> {
    fn paint(&self, painter: &Painter) {
        let px_per_m = self.view.px_per_m;
        let numbered_m = self.units.round_length_at_least(NUMBERED / px_per_m);
        let tick_m = self.units.division(numbered_m, CLOSEST / px_per_m);
        let ends = [self.rect.left_bottom(), self.rect.right_top()].map(|at| plan_point(self.view, self.rect, at));
        let [from_m, to_m] = ends.map(|end| self.axis.coordinate(end));
        let per_number = (numbered_m / tick_m).round().max(1.0) as i64;
        // Half of the numbered distance, if there is a tick there.
        let half = (per_number % 2 == 0).then_some(per_number / 2);
        let (first, last) = ((from_m / tick_m).floor() as i64 - 1, (to_m / tick_m).ceil() as i64 + 1);
        // A number may start before the first visible tick.
        for index in first - per_number..=last {
            let place_m = index as f64 * tick_m;
            let is_numbered = index.rem_euclid(per_number) == 0;
            let is_half = half.is_some_and(|half| index.rem_euclid(half) == 0);
            let length = match (is_numbered, is_half) {
                (true, _) => WIDTH,
                (false, true) => 7.0,
                (false, false) => 4.0,
            };
            let strength = if is_numbered { 0.7 } else { 0.45 };
            let stroke = Stroke::new(1.0, self.colours.text_weak.gamma_multiply(strength));
            let text = is_numbered.then(|| {
                let font = FontId::proportional(TEXT);
                painter.layout_no_wrap(self.units.tick(place_m), font, self.colours.text_weak)
            });
            let place = self.place(place_m);
            match self.axis {
                GuideAxis::Vertical => {
                    painter.vline(place.x, self.strip.bottom() - length..=self.strip.bottom(), stroke);
                    if let Some(text) = text {
                        painter.galley(pos2(place.x + 3.0, self.strip.top() + 1.0), text, Color32::PLACEHOLDER);
                    }
                }
                GuideAxis::Horizontal => {
                    painter.hline(self.strip.right() - length..=self.strip.right(), place.y, stroke);
                    if let Some(text) = text {
                        painter.add(upright(text, pos2(self.strip.left() + 1.0, place.y - 3.0)));
                    }
                }
            }
        }
    }

    /// The screen position of a coordinate, on whole pixels.
    fn place(&self, at_m: f64) -> Pos2 {
        let point = match self.axis {
            GuideAxis::Vertical => Point::new(at_m, 0.0),
            GuideAxis::Horizontal => Point::new(0.0, at_m),
        };
        on_screen(self.rect, self.view, point)
    }
}

/// A text that reads from bottom to top, starting at a position.
fn upright(galley: Arc<Galley>, at: Pos2) -> Shape {
    TextShape::new(at, galley, Color32::PLACEHOLDER).with_angle(-std::f32::consts::FRAC_PI_2).into()
}

/// Marks the positions of guides on the ruler that they cross.
fn mark_guides(
    session: &Session,
    drag: Option<Drag>,
    painter: &Painter,
    strip: Rect,
    axis: GuideAxis,
    view: &View,
    rect: Rect,
    colours: &Colours,
) {
    if !session.layers.guides {
        return;
    }
    for at_m in guides::places(session, drag, axis) {
        let place = guides::on_canvas(rect, view, axis, at_m);
        let (tip, left, right) = match axis {
            GuideAxis::Vertical => {
                let tip = pos2(place.x, strip.bottom());
                (tip, tip + vec2(-4.0, -7.0), tip + vec2(4.0, -7.0))
            }
            GuideAxis::Horizontal => {
                let tip = pos2(strip.right(), place.y);
                (tip, tip + vec2(-7.0, 4.0), tip + vec2(-7.0, -4.0))
            }
        };
        painter.add(Shape::convex_polygon(vec![tip, left, right], colours.accent, Stroke::NONE));
    }
}

/// Guides are dragged out of a ruler to create them, along it to move them, and off it to remove them.
fn take_pointer(
    canvas: &mut Canvas,
    session: &Session,
    help: &str,
    ui: &Ui,
    strip: Rect,
    axis: GuideAxis,
    view: &View,
    rect: Rect,
) -> Vec<Call> {
    let mut calls = Vec::new();
    let drag = canvas.guide_drag;
    let name = match axis {
        GuideAxis::Vertical => "Ruler above",
        GuideAxis::Horizontal => "Ruler on the left",
    };
    let response = ui.interact(strip, Id::unique(name), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Unknown, true, name));
    let along = |at: Pos2| match axis {
        GuideAxis::Vertical => at.x,
        GuideAxis::Horizontal => at.y,
    };
    let near = |at: Pos2| {
        let distance = |at_m: f64| (along(guides::on_canvas(rect, view, axis, at_m)) - along(at)).abs();
        let places = guides::places(session, drag, axis).filter(|_| session.layers.guides);
        places.filter(|&at_m| distance(at_m) <= REACH).min_by(|&p, &q| distance(p).total_cmp(&distance(q)))
    };
    let under = response.hover_pos().and_then(near);
    if canvas.guide_drag.is_none() && response.hovered() {
        let grab = match axis {
            GuideAxis::Vertical if under.is_some() => CursorIcon::ResizeHorizontal,
            GuideAxis::Horizontal if under.is_some() => CursorIcon::ResizeVertical,
            GuideAxis::Vertical => CursorIcon::ResizeVertical,
            GuideAxis::Horizontal => CursorIcon::ResizeHorizontal,
        };
        ui.ctx().set_cursor_icon(grab);
    }
    if response.double_clicked()
        && let Some(at_m) = under
    {
        calls.push(Call::new("remove-guide", [Value::word(axis), Value::Number(at_m)]));
        return calls;
    }
    if response.drag_started_by(PointerButton::Primary) {
        let origin = ui.input(|input| input.pointer.press_origin());
        canvas.guide_drag = Some(match origin.and_then(near) {
            Some(at_m) => Drag { axis, from_m: Some(at_m), to_m: None, ruler: axis },
            // The top ruler is parallel to horizontal guides.
            None => Drag { axis: other(axis), from_m: None, to_m: None, ruler: axis },
        });
    }
    let Some(mut drag) = canvas.guide_drag.filter(|drag| drag.ruler == axis) else { return calls };
    if let Some(at) = response.interact_pointer_pos() {
        drag.to_m = guides::dropped_at(&drag, at, rect, view, session.units());
        canvas.guide_drag = Some(drag);
    }
    if ui.input(|input| input.key_pressed(egui::Key::Escape)) {
        canvas.guide_drag = None;
    } else if response.drag_stopped() || !response.dragged() {
        canvas.guide_drag = None;
        let way = Value::word(drag.axis);
        match (drag.from_m, drag.to_m) {
            (None, Some(to_m)) => calls.push(Call::new("add-guide", [way, Value::Number(to_m)])),
            (Some(from_m), Some(to_m)) if from_m != to_m => {
                calls.push(Call::new("move-guide", [way, Value::Number(from_m), Value::Number(to_m)]));
            }
            (Some(from_m), None) => calls.push(Call::new("remove-guide", [way, Value::Number(from_m)])),
            _ => {}
        }
    }
    if response.hovered() {
        response.on_hover_text(if under.is_some() {
            "Drag to move the guide; drag it off or double-click to remove it"
        } else {
            help
        });
    }
    calls
}

const fn other(axis: GuideAxis) -> GuideAxis {
    match axis {
        GuideAxis::Horizontal => GuideAxis::Vertical,
        GuideAxis::Vertical => GuideAxis::Horizontal,
    }
}
