//! A tool's work in progress, painted over the plan.

use std::f64::consts::TAU;

use egui::epaint::StrokeKind;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};

use crate::app::look::theme;
use crate::app::paint::{
    places::on_screen,
    scene_painter::{earcut, polygon_mesh},
};
use crate::base::units;
use crate::draw::scene::arc_points;
use crate::draw::{Palette, View};
use crate::geometry::{Point, Segment, Vector};
use crate::snapping::{Snap, SnapKind};

/// The purpose of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Look {
    /// To be created.
    New,
    /// A construction line.
    Guide,
    /// To be removed, or invalid.
    Danger,
}

/// Shapes in plan coordinates.
#[derive(Default)]
pub(crate) struct Preview {
    items: Vec<Item>,
}

enum Item {
    Line {
        points: Vec<Point>,
        closed: bool,
        look: Look,
        dashed: bool,
    },
    Fill {
        outer: Vec<Point>,
        holes: Vec<Vec<Point>>,
        look: Look,
    },
    Wall {
        segment: Segment,
        thickness_m: f64,
        look: Look,
    },
    Label {
        at: Point,
        text: String,
        look: Look,
    },
    /// A text beside the middle of a segment.
    Dimension {
        segment: Segment,
        text: String,
    },
    Handle {
        at: Point,
        look: Look,
    },
}

impl Preview {
    pub(crate) fn line(&mut self, points: Vec<Point>, closed: bool, look: Look) {
        self.items.push(Item::Line { points, closed, look, dashed: false });
    }

    pub(crate) fn dashed(&mut self, points: Vec<Point>, closed: bool, look: Look) {
        self.items.push(Item::Line { points, closed, look, dashed: true });
    }

    pub(crate) fn fill(&mut self, outer: Vec<Point>, holes: Vec<Vec<Point>>, look: Look) {
        self.items.push(Item::Fill { outer, holes, look });
    }

    pub(crate) fn wall(&mut self, segment: Segment, thickness_m: f64, look: Look) {
        self.items.push(Item::Wall { segment, thickness_m, look });
    }

    /// An arc around a centre, the short way.
    pub(crate) fn arc(&mut self, centre: Point, from: Point, to: Point, look: Look) {
        self.line(arc_points(centre, from, to, 5), false, look);
    }

    pub(crate) fn label(&mut self, at: Point, text: impl Into<String>, look: Look) {
        self.items.push(Item::Label { at, text: text.into(), look });
    }

    pub(crate) fn dimension(&mut self, segment: Segment, text: impl Into<String>) {
        self.items.push(Item::Dimension { segment, text: text.into() });
    }

    pub(crate) fn handle(&mut self, at: Point, look: Look) {
        self.items.push(Item::Handle { at, look });
    }

    /// Paints everything over the plan in `rect`.
    pub(crate) fn paint(self, painter: &Painter, rect: Rect, view: &View, palette: &Palette) {
        let place = |point: Point| on_screen(rect, view, point);
        for item in self.items {
            match item {
                Item::Line { points, closed, look, dashed } => {
                    let mut points: Vec<Pos2> = points.into_iter().map(place).collect();
                    if closed {
                        points.extend(points.first().copied());
                    }
                    let stroke = stroke(look, palette);
                    if dashed {
                        painter.extend(Shape::dashed_line(&points, stroke, 5.0, 4.0));
                    } else {
                        painter.add(Shape::line(points, stroke));
                    }
                }
                Item::Fill { outer, holes, look } => {
                    let triangles = earcut(&outer, &holes);
                    let colour = colour(look, palette).gamma_multiply(0.18);
                    painter.add(Shape::mesh(polygon_mesh(rect, view, &outer, &holes, &triangles, colour)));
                }
                Item::Wall { segment, thickness_m, look } => {
                    if let Some(along) = segment.vector().unit() {
                        let half = along.left() * (thickness_m / 2.0);
                        let band = vec![segment.a + half, segment.b + half, segment.b + -half, segment.a + -half];
                        let corners: Vec<Pos2> = band.into_iter().map(place).collect();
                        let fill = colour(look, palette).gamma_multiply(0.35);
                        painter.add(Shape::convex_polygon(corners, fill, Stroke::new(1.0, colour(look, palette))));
                    }
                    painter.line_segment([place(segment.a), place(segment.b)], Stroke::new(1.5, colour(look, palette)));
                }
                Item::Label { at, text, look } => {
                    tag(painter, place(at) + vec2(14.0, 16.0), Align2::LEFT_TOP, &text, colour(look, palette), palette);
                }
                Item::Dimension { segment, text } => {
                    let (a, b) = (place(segment.a), place(segment.b));
                    // On short lines the number would hide what it measures.
                    if (b - a).length() < 28.0 {
                        continue;
                    }
                    let normal = (b - a).normalized().rot90();
                    let up = if normal.y > 0.0 || (normal.y == 0.0 && normal.x < 0.0) { -normal } else { normal };
                    tag(
                        painter,
                        a + (b - a) / 2.0 + up * 16.0,
                        Align2::CENTER_CENTER,
                        &text,
                        theme::colour(palette.ink),
                        palette,
                    );
                }
                Item::Handle { at, look } => {
                    let square = Rect::from_center_size(place(at), Vec2::splat(7.0));
                    painter.rect(
                        square,
                        1.0,
                        theme::colour(palette.paper),
                        Stroke::new(1.5, colour(look, palette)),
                        StrokeKind::Middle,
                    );
                }
            }
        }
    }
}

/// A text on a background.
pub(crate) fn tag(painter: &Painter, at: Pos2, anchor: Align2, text: &str, ink: Color32, palette: &Palette) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(theme::SMALL), ink);
    let size = galley.rect.size();
    let ground = anchor.anchor_size(at, size + vec2(10.0, 4.0));
    // Never outside the canvas.
    let clip = painter.clip_rect().shrink(2.0);
    let into = vec2(
        (clip.right() - ground.right()).min(0.0) + (clip.left() - ground.left()).max(0.0),
        (clip.bottom() - ground.bottom()).min(0.0) + (clip.top() - ground.top()).max(0.0),
    );
    let ground = ground.translate(into);
    painter.rect_filled(ground, 4.0, theme::colour(palette.paper).gamma_multiply(0.92));
    painter.rect_stroke(ground, 4.0, Stroke::new(1.0, theme::colour(palette.grid_major)), StrokeKind::Outside);
    painter.galley(ground.min + vec2(5.0, 2.0), galley, ink);
    ground
}

fn colour(look: Look, palette: &Palette) -> Color32 {
    theme::colour(match look {
        Look::New => palette.selection,
        Look::Guide => palette.snap,
        Look::Danger => palette.error,
    })
}

fn stroke(look: Look, palette: &Palette) -> Stroke {
    let width = if look == Look::Guide { 1.0 } else { 2.0 };
    Stroke::new(width, colour(look, palette))
}

/// The snap marker, with its name and the lines that explain it.
pub(crate) fn paint_snap(painter: &Painter, rect: Rect, view: &View, palette: &Palette, snap: &Snap) {
    let colour = theme::colour(palette.snap);
    let place = |point: Point| on_screen(rect, view, point);
    let at = place(snap.point);
    for guide in &snap.guides {
        let points = [place(guide.a), place(guide.b)];
        painter.extend(Shape::dashed_line(&points, Stroke::new(1.0, colour), 5.0, 4.0));
    }
    let stroke = Stroke::new(1.8, colour);
    let arm = |x: f32, y: f32| at + vec2(x, y);
    match snap.kind {
        SnapKind::Corner | SnapKind::FaceCorner | SnapKind::Jamb => {
            painter.rect_stroke(Rect::from_center_size(at, Vec2::splat(11.0)), 0.0, stroke, StrokeKind::Middle);
        }
        SnapKind::Intersection => {
            painter.line_segment([arm(-6.0, -6.0), arm(6.0, 6.0)], stroke);
            painter.line_segment([arm(-6.0, 6.0), arm(6.0, -6.0)], stroke);
        }
        SnapKind::Midpoint => {
            painter.add(Shape::closed_line(vec![arm(-6.5, 5.0), arm(6.5, 5.0), arm(0.0, -6.5)], stroke));
        }
        SnapKind::Perpendicular => {
            painter.add(Shape::line(vec![arm(-6.0, -7.0), arm(-6.0, 6.0), arm(7.0, 6.0)], stroke));
            painter.add(Shape::line(vec![arm(-6.0, 0.0), arm(0.0, 0.0), arm(0.0, 6.0)], stroke));
        }
        SnapKind::Wall | SnapKind::Face => {
            painter.add(Shape::closed_line(vec![arm(0.0, -6.5), arm(6.5, 0.0), arm(0.0, 6.5), arm(-6.5, 0.0)], stroke));
        }
        SnapKind::Alignment | SnapKind::Grid | SnapKind::Free => {
            let half = if snap.kind == SnapKind::Free { 3.0 } else { 5.0 };
            painter.line_segment([arm(-half, 0.0), arm(half, 0.0)], stroke);
            painter.line_segment([arm(0.0, -half), arm(0.0, half)], stroke);
        }
    }
    if matches!(snap.kind, SnapKind::Free | SnapKind::Grid) {
        return;
    }
    tag(painter, at + vec2(12.0, -12.0), Align2::LEFT_BOTTOM, snap.kind.name(), colour, palette);
}

/// The angle of a direction as everybody gives it: counter-clockwise from the right, from 0° on and below 360°.
pub(crate) fn angle(way: Vector) -> String {
    let turn_rad = way.angle_rad();
    // A hair below the right is no full turn.
    let text = units::angle(if turn_rad < 0.0 { turn_rad + TAU } else { turn_rad });
    if text == units::angle(TAU) { units::angle(0.0) } else { text }
}

/// The turn from one direction into another, in radians: to the left above 0, to the right below, up to half a turn.
pub(crate) fn turn_rad(along: Vector, way: Vector) -> f64 {
    // On the 0.1 degree that is shown.
    let tenths = (along.cross(way).atan2(along.dot(way)).to_degrees() * 10.0).round();
    (tenths / 10.0).to_radians()
}

/// The turn from one direction into another, as a turn: 'turn 30° left'; empty where it goes straight on.
pub(crate) fn turn(along: Vector, way: Vector) -> String {
    let turn_rad = turn_rad(along, way);
    let side = if turn_rad < 0.0 { "right" } else { "left" };
    let text = units::angle(turn_rad.abs());
    if text == units::angle(0.0) { String::new() } else { format!("turn {text} {side}") }
}

/// The angle between two directions, up to 180°; `None` where one has no length.
pub(crate) fn between(p: Vector, q: Vector) -> Option<String> {
    let (p, q) = (p.unit()?, q.unit()?);
    Some(units::angle(p.cross(q).abs().atan2(p.dot(q))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_counter_clockwise_from_the_right_and_turns_are_turns() {
        let said = |x, y| angle(Vector::new(x, y));
        assert_eq!([said(1.0, 0.0), said(0.0, 1.0), said(-1.0, 0.0), said(0.0, -1.0)], ["0°", "90°", "180°", "270°"]);
        assert_eq!([said(1.0, -1e-9), said(1.0, -1.0)], ["0°", "315°"]);
        let up = Vector::new(0.0, 1.0);
        assert_eq!(turn(up, Vector::new(-1.0, 0.0)), "turn 90° left");
        assert_eq!(turn(up, Vector::new(1.0, 1.0)), "turn 45° right");
        assert_eq!(turn(up, up), "");
        assert_eq!(between(up, Vector::new(1.0, 0.0)).as_deref(), Some("90°"));
    }
}
