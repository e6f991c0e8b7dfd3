//! What is painted over the plan: marks of selected and hovered elements, questions, hints, the scale
//! bar.

use std::sync::Arc;

use egui::epaint::StrokeKind;
use egui::{Color32, Painter, Rect, Shape, Stroke, Vec2, vec2};

use super::live::paint_new_labels;
use super::{Beginning, Canvas};
use crate::app::look::theme;
use crate::app::paint::pending::{Around, Pending};
use crate::app::paint::places::on_screen;
use crate::app::paint::preview::{Look, Preview};
use crate::app::paint::scene_painter::{earcut, outline_mesh, polygon_mesh};
use crate::app::session::Session;
use crate::app::session::document::{Derived, Document};
use crate::app::session::questions::Shown;
use crate::app::tools::{self, Scope, Toolbox};
use crate::base::units::Units;
use crate::draw::{Fill, Palette, Style, View, dimensions};
use crate::geometry::{Bounds, Point, Segment};
use crate::plan::{ElementId, GuideAxis, Plan};

/// The most selected elements that are marked: more would take longer than a frame.
pub(super) const MOST_MARKED: usize = 2000;

impl Canvas {
    /// Shows what changed since the last analysis.
    pub(super) fn paint_pending(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        document: &Document,
        session: &Session,
        style: &Style,
    ) {
        let Some((earlier, drawn)) = document.last_derived() else { return };
        let plan = document.plan();
        // The labels come before the rest.
        let labelled = document.labelled();
        if !self.pending.as_ref().is_some_and(|pending| pending.is_between(earlier, plan)) {
            self.pending = Some(Pending::new(earlier, plan));
        }
        if let Some(pending) = &self.pending {
            pending.paint(painter, rect, view, style, &session.schemes, labelled.is_some());
            if let Some(labelled) = labelled.filter(|_| style.fill == Fill::Prediction && !pending.is_all()) {
                let is_covered = |room| pending.covers(room);
                let palette = style.palette();
                let recoloured = paint_new_labels(painter, rect, view, &drawn.labelled, labelled, &is_covered, palette);
                Around::rooms(plan, &recoloured).paint(plan, painter, rect, view, style);
                pending.paint_walls(painter, rect, view, style);
            }
        }
    }

    /// Marks a room or an opening.
    pub(super) fn mark(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        plan: &Plan,
        derived: &Arc<Derived>,
        marked: ElementId,
        mark: &Mark,
    ) {
        match marked {
            ElementId::Room(id) => {
                let Some(shape) = derived.analysis.shapes.get(id).filter(|shape| !shape.outer.is_empty()) else {
                    return;
                };
                if mark.fill != Color32::TRANSPARENT {
                    let is_known =
                        self.marked.as_ref().is_some_and(|(of, room, _)| Arc::ptr_eq(of, derived) && *room == marked);
                    if !is_known {
                        self.marked = Some((derived.clone(), marked, earcut(&shape.outer, &shape.holes)));
                    }
                    if let Some((_, _, triangles)) = &self.marked {
                        let mesh = polygon_mesh(rect, view, &shape.outer, &shape.holes, triangles, mark.fill);
                        painter.add(Shape::mesh(mesh));
                    }
                }
                for ring in shape.rings() {
                    let stroke = Stroke::new(mark.width, mark.line);
                    painter.add(Shape::mesh(outline_mesh(rect, view, ring, stroke)));
                }
            }
            ElementId::Corner(id) => {
                let Some(place) = plan.position(id).map(|point| on_screen(rect, view, point)) else { return };
                let square = Rect::from_center_size(place, Vec2::splat(8.0));
                painter.rect(
                    square,
                    1.0,
                    mark.line.gamma_multiply(0.35),
                    Stroke::new(mark.width, mark.line),
                    StrokeKind::Middle,
                );
            }
            ElementId::Wall(id) => {
                let Some(wall) = plan.wall(id) else { return };
                let Some(segment) = plan.wall_segment(wall) else { return };
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                let width = (wall.thickness_m * view.px_per_m) as f32;
                painter.line_segment(ends, Stroke::new(width.max(2.0) + 4.0, mark.line.gamma_multiply(0.45)));
                painter.line_segment(ends, Stroke::new(mark.width, mark.line));
            }
            ElementId::Dimension(id) => {
                let line = plan.dimension(id).and_then(|dimension| plan.dimension_line(dimension));
                let Some(segment) = line.and_then(|line| dimensions::segment(&line)) else { return };
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                painter.line_segment(ends, Stroke::new(mark.width + 6.0, mark.line.gamma_multiply(0.25)));
                painter.line_segment(ends, Stroke::new(mark.width, mark.line));
            }
            ElementId::Opening(id) => {
                let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
                let Some(segment) = segment else { return };
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                let middle = ends[0] + (ends[1] - ends[0]) / 2.0;
                let half = (ends[1] - ends[0]) / 2.0;
                // Never too small to be visible.
                let half = if half.length() < 4.0 { vec2(4.0, 0.0) } else { half };
                let (from, to) = (middle - half, middle + half);
                let band = mark.width + 6.0;
                painter.line_segment([from, to], Stroke::new(band, mark.line.gamma_multiply(0.35)));
                painter.line_segment([from, to], Stroke::new(mark.width + 1.0, mark.line));
                for end in [from, to] {
                    painter.circle_filled(end, mark.width + 1.5, mark.line);
                }
            }
        }
    }
}

/// The subject of an open question.
pub(super) fn preview_question(session: &Session, plan: &Plan, preview: &mut Preview) {
    match session.question.as_ref().map(|question| &question.shown) {
        Some(Shown::Gone(gone)) => {
            for &element in gone.iter().take(MOST_MARKED) {
                match element {
                    ElementId::Room(id) => {
                        let points = plan.room(id).map(|room| plan.ring_points(&room.outer)).unwrap_or_default();
                        preview.fill(points, Vec::new(), Look::Danger);
                    }
                    ElementId::Wall(id) => {
                        let wall = plan.wall(id).and_then(|wall| Some((plan.wall_segment(wall)?, wall.thickness_m)));
                        if let Some((segment, thickness_m)) = wall {
                            preview.wall(segment, thickness_m, Look::Danger);
                        }
                    }
                    ElementId::Opening(id) => {
                        let segment = plan.opening(id).and_then(|opening| plan.opening_segment(opening));
                        if let Some(segment) = segment {
                            preview.line(vec![segment.a, segment.b], false, Look::Danger);
                        }
                    }
                    ElementId::Corner(_) | ElementId::Dimension(_) => {}
                }
            }
        }
        Some(Shown::Marks(marks)) => {
            for mark in marks.iter().take(MOST_MARKED) {
                preview.line(vec![mark.a, mark.b], false, Look::Danger);
                preview.handle(mark.b, Look::Danger);
            }
        }
        Some(Shown::Nothing) | None => {}
    }
}

/// More snap targets: guide lines, and lines of the storey below near the pointer.
pub(super) fn more_to_snap_to(session: &Session, view: &View, pointer: Point) -> (Vec<Segment>, Vec<Point>) {
    let seen = view.bounds();
    let mut lines: Vec<Segment> = session
        .guides()
        .iter()
        .map(|guide| match guide.axis {
            GuideAxis::Horizontal => {
                Segment::new(Point::new(seen.min.x, guide.at_m), Point::new(seen.max.x, guide.at_m))
            }
            GuideAxis::Vertical => Segment::new(Point::new(guide.at_m, seen.min.y), Point::new(guide.at_m, seen.max.y)),
        })
        .collect();
    // Within snapping reach, and a little more.
    let near = Bounds::of([pointer]).inflated(GHOST_REACH_PX / view.px_per_m);
    let below: Vec<Segment> = session.ghost_segments().iter().copied().filter(|line| near.meets(*line)).collect();
    let points = below.iter().flat_map(|line| [line.a, line.b]).collect();
    lines.extend(below);
    (lines, points)
}

/// Snapping reach for the storey below, in points.
const GHOST_REACH_PX: f64 = 16.0;

/// The height of what is typed with four lines of what is said about it, in points.
const REFUSAL_HEIGHT: f32 = 100.0;

/// What has been typed for the tool, beside the pointer: what is understood of it, or why it is not taken.
pub(super) fn paint_typed(
    painter: &Painter,
    rect: Rect,
    view: &View,
    palette: &Palette,
    scope: &Scope<'_>,
    toolbox: &Toolbox,
) {
    let Toolbox { typed, refused, .. } = toolbox;
    if typed.is_empty() {
        return;
    }
    let mut at = on_screen(rect, view, scope.at()) + vec2(14.0, 40.0);
    if !refused.is_empty() {
        // With room for what is said below it.
        at.y = at.y.min(rect.bottom() - REFUSAL_HEIGHT);
    }
    let ink = theme::colour(palette.ink);
    let understood = toolbox.understood(scope.units);
    let text = if understood.is_empty() { format!("{typed}|") } else { format!("{typed}|   = {understood}   Enter") };
    let tag = tools::tag(painter, at, egui::Align2::LEFT_TOP, &text, ink, palette);
    if !refused.is_empty() {
        let below = tag.left_bottom() + vec2(0.0, 4.0);
        let colour = theme::colour(palette.error);
        // What is wrong, and below it what would be right, in as many lines as a narrow canvas needs.
        let font = egui::FontId::proportional(theme::SMALL);
        let most = (rect.width() - 32.0).max(120.0);
        let parts = refused.splitn(2, "; ").map(|part| {
            let galley = painter.layout(part.to_owned(), font.clone(), colour, most);
            galley.rows.iter().map(|row| row.text().trim_end().to_owned()).collect::<Vec<_>>().join("\n")
        });
        let lines = parts.collect::<Vec<_>>().join("\n");
        tools::tag(painter, below, egui::Align2::LEFT_TOP, &lines, colour, palette);
    }
}

/// How an element is marked.
pub(super) struct Mark {
    line: Color32,
    width: f32,
    fill: Color32,
}

impl Mark {
    pub(super) fn hover(palette: &Palette) -> Self {
        Self { line: theme::colour(palette.hover), width: 2.0, fill: Color32::TRANSPARENT }
    }

    pub(super) fn picked(palette: &Palette) -> Self {
        let line = theme::colour(palette.selection);
        Self { line, width: 2.5, fill: line.gamma_multiply(0.16) }
    }
}

/// Whether a backdrop is shown.
pub(super) fn is_over_picture(session: &Session, plan: &Plan) -> bool {
    session.layers.backdrop && plan.backdrop().is_some()
}

/// A scale bar of a round length in the lower left corner.
pub(super) fn paint_scale_bar(painter: &Painter, rect: Rect, view: &View, palette: &Palette, units: Units) {
    let ScaleBar { left, width, text, ground } = scale_bar(rect, view, units);
    let ink = theme::colour(palette.ink_muted);
    let galley = painter.layout_no_wrap(text, egui::FontId::proportional(theme::SMALL), ink);
    painter.rect_filled(ground, 4.0, theme::colour(palette.paper).gamma_multiply(0.85));
    let stroke = Stroke::new(1.5, ink);
    painter.line_segment([left, left + vec2(width, 0.0)], stroke);
    for end in [left, left + vec2(width, 0.0)] {
        painter.line_segment([end + vec2(0.0, -4.0), end + vec2(0.0, 4.0)], stroke);
    }
    let beside = left + vec2(width + 6.0, -galley.rect.height() / 2.0);
    painter.galley(beside, galley, ink);
}

/// The scale bar in the lower left of the canvas.
pub(super) struct ScaleBar {
    /// Its left end.
    left: egui::Pos2,
    /// In points.
    width: f32,
    text: String,
    /// What it takes up.
    pub ground: Rect,
}

pub(super) fn scale_bar(rect: Rect, view: &View, units: Units) -> ScaleBar {
    // The maximum length of the bar, in points.
    const LONGEST: f64 = 120.0;
    let length_m = units.round_length_at_most(LONGEST / view.px_per_m);
    let width = (length_m * view.px_per_m) as f32;
    let left = rect.left_bottom() + vec2(16.0, -18.0);
    let text = units.round_length(length_m);
    let font = crate::draw::font::Font::of(crate::draw::Weight::Regular);
    let text_width = font.width_px(&text, f64::from(theme::SMALL)).ceil() as f32;
    let ground = Rect::from_min_max(left + vec2(-6.0, -8.0), left + vec2(width + 12.0 + text_width, 8.0));
    ScaleBar { left, width, text, ground }
}

/// Hints on an empty plan: the tools to begin with, and their keys.
pub(super) fn paint_beginning(painter: &Painter, rect: Rect, palette: &Palette, beginning: &Beginning) {
    let lines = [
        ("Nothing is drawn yet".to_owned(), theme::TITLE, palette.ink),
        (
            format!("{}   Draw walls; {} then makes rooms inside them", beginning.walls, beginning.fill),
            theme::BODY,
            palette.ink_muted,
        ),
        (format!("{}   Draw rectangular rooms", beginning.rectangle), theme::BODY, palette.ink_muted),
        (format!("{}   Add doors", beginning.door), theme::BODY, palette.ink_muted),
        ("Or drop a picture of a plan here to trace it".to_owned(), theme::BODY, palette.ink_muted),
    ];
    const LINE: f32 = 26.0;
    // On a small canvas the hints would hide everything.
    if rect.width() < 420.0 || rect.height() < 240.0 {
        return;
    }
    let mut at = rect.center() - vec2(0.0, LINE * lines.len() as f32 / 2.0);
    for (text, size, colour) in lines {
        painter.text(at, egui::Align2::CENTER_TOP, text, egui::FontId::proportional(size), theme::colour(colour));
        at.y += LINE;
    }
}
