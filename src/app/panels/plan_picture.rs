//! A thumbnail of a plan with the changes marked, for dialogs.

use std::collections::BTreeSet;
use std::sync::Arc;

use egui::epaint::StrokeKind;
use egui::{Color32, Painter, Rect, Role, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo, vec2};

use crate::app::look::theme;
use crate::app::look::widgets::colours;
use crate::app::paint::{
    places::on_screen,
    scene_painter::{ScenePainter, earcut, outline_mesh, polygon_mesh},
};
use crate::app::session::document::Derived;
use crate::draw::dimensions::segment;
use crate::draw::{self, Fill, LabelColours, Layers, Palette, Style, View};
use crate::geometry::{Bounds, Point, Segment};
use crate::plan::{ChangeKind, Difference, ElementId, Plan};

/// The most marks: more cannot be told apart in a thumbnail, and would take longer than a frame.
const MOST_MARKS: usize = 4000;

/// A picture shows at least so much around what is smaller, in metres.
const LEAST_M: f64 = 1.0;

/// Margin around the plan, in points.
const MARGIN: f64 = 14.0;

/// A thumbnail of a plan and its changes.
pub(crate) struct PlanPicture {
    derived: Arc<Derived>,
    marks: Vec<Mark>,
    bounds: Bounds,
    painter: ScenePainter,
}

/// The kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MarkKind {
    Added,
    Changed,
    /// Not in the plan any more.
    Removed,
    /// Changed on the other side too.
    Both,
}

impl MarkKind {
    pub(crate) const ALL: [Self; 4] = [Self::Added, Self::Changed, Self::Removed, Self::Both];

    /// Its name in the interface.
    pub(crate) const fn title(self) -> &'static str {
        match self {
            Self::Added => "Added",
            Self::Changed => "Changed",
            Self::Removed => "Removed",
            Self::Both => "Changed on both sides",
        }
    }

    fn colour(self, colours: &theme::Colours) -> Color32 {
        match self {
            Self::Added => colours.accent,
            Self::Changed => colours.warning,
            Self::Removed => colours.text_weak,
            Self::Both => colours.error,
        }
    }
}

struct Mark {
    kind: MarkKind,
    shape: MarkShape,
}

enum MarkShape {
    Area { outer: Vec<Point>, holes: Vec<Vec<Point>>, triangles: Vec<u32> },
    Line(Segment),
}

impl MarkShape {
    /// The position of an element; `None` if it has none.
    fn of(plan: &Plan, element: ElementId) -> Option<Self> {
        match element {
            ElementId::Corner(_) => None,
            ElementId::Dimension(id) => segment(&plan.dimension_line(plan.dimension(id)?)?).map(Self::Line),
            ElementId::Wall(id) => plan.wall_segment(plan.wall(id)?).map(Self::Line),
            ElementId::Opening(id) => plan.opening_segment(plan.opening(id)?).map(Self::Line),
            ElementId::Room(id) => {
                let room = plan.room(id)?;
                let outer = plan.ring_points(&room.outer);
                let holes: Vec<Vec<Point>> = room.holes.iter().map(|ring| plan.ring_points(ring)).collect();
                let triangles = earcut(&outer, &holes);
                (outer.len() >= 3).then_some(Self::Area { outer, holes, triangles })
            }
        }
    }

    fn bounds(&self) -> Bounds {
        match self {
            Self::Area { outer, .. } => Bounds::of(outer.iter().copied()),
            Self::Line(segment) => segment.bounds(),
        }
    }
}

impl PlanPicture {
    /// A thumbnail of a plan that was `before`, with its analysis. `both`: elements also changed on the
    /// other side.
    pub(crate) fn new(before: &Plan, plan: &Plan, derived: Arc<Derived>, both: &BTreeSet<ElementId>) -> Self {
        let seen = Difference::between(before, plan).seen(before, plan);
        let marks = seen.iter().take(MOST_MARKS).filter_map(|(&element, &kind)| {
            let (of, kind) = match kind {
                ChangeKind::Removed => (before, MarkKind::Removed),
                ChangeKind::Added => (plan, MarkKind::Added),
                ChangeKind::Changed => (plan, MarkKind::Changed),
            };
            let kind = if both.contains(&element) { MarkKind::Both } else { kind };
            Some(Mark { kind, shape: MarkShape::of(of, element)? })
        });
        let marks: Vec<Mark> = marks.collect();
        let mut bounds = derived.drawing.bounds();
        for mark in &marks {
            let shape = mark.shape.bounds();
            if !shape.is_empty() {
                bounds = bounds.with(shape.min).with(shape.max);
            }
        }
        Self { derived, marks, bounds, painter: ScenePainter::default() }
    }

    /// The same with what was half drawn: a chain of lines, or the first point of one.
    pub(crate) fn with_draft(mut self, points: &[Point]) -> Self {
        let lines = points.windows(2).map(|pair| Segment::new(pair[0], pair[1]));
        let first = points.first().filter(|_| points.len() == 1).map(|&point| Segment::new(point, point));
        let lines = lines.chain(first).take(MOST_MARKS);
        self.marks.extend(lines.map(|line| Mark { kind: MarkKind::Added, shape: MarkShape::Line(line) }));
        let drawn = Bounds::of(points.iter().copied());
        self.bounds = self.bounds.union(drawn);
        // A point alone has no size to be fitted.
        if self.bounds.width().max(self.bounds.height()) < LEAST_M {
            self.bounds = self.bounds.inflated(LEAST_M);
        }
        self
    }

    /// Paints it at this size.
    pub(crate) fn show(&mut self, ui: &mut Ui, size: Vec2, name: &str) {
        let (frame, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        let theme = if ui.visuals().dark_mode { draw::Theme::Dark } else { draw::Theme::Light };
        let palette = Palette::of(theme, LabelColours::Standard);
        let radius = f32::from(theme::RADIUS);
        ui.painter().rect_filled(frame, radius, theme::colour(palette.paper));
        let rect = frame.shrink(1.0);
        let (width_px, height_px) = (f64::from(rect.width()), f64::from(rect.height()));
        let pixel_ratio = f64::from(ui.pixels_per_point());
        let view = View { pixel_ratio, ..View::fitting(self.bounds, width_px, height_px, MARGIN) };
        let layers = Layers { names: false, areas: false, ..Layers::default() };
        let style = Style { theme, fill: Fill::None, layers, ..Style::default() };
        let painter = ui.painter_at(rect);
        self.painter.paint(&painter, rect, &self.derived, &style, &view);
        for mark in &self.marks {
            paint_mark(&painter, rect, &view, mark, mark.kind.colour(colours(ui)));
        }
        ui.painter().rect_stroke(frame, radius, Stroke::new(1.0, colours(ui).outline), StrokeKind::Inside);
    }

    /// The kinds of marks in it, in the order of [`MarkKind::ALL`].
    pub(crate) fn kinds(&self) -> impl Iterator<Item = MarkKind> + '_ {
        MarkKind::ALL.into_iter().filter(|kind| self.marks.iter().any(|mark| mark.kind == *kind))
    }
}

fn paint_mark(painter: &Painter, rect: Rect, view: &View, mark: &Mark, colour: Color32) {
    let is_gone = mark.kind == MarkKind::Removed;
    match &mark.shape {
        MarkShape::Area { outer, holes, triangles } => {
            let strength = if is_gone { 0.12 } else { 0.32 };
            let fill = colour.gamma_multiply(strength);
            painter.add(Shape::mesh(polygon_mesh(rect, view, outer, holes, triangles, fill)));
            for ring in std::iter::once(outer).chain(holes) {
                if is_gone {
                    let mut points: Vec<_> = ring.iter().map(|&point| on_screen(rect, view, point)).collect();
                    points.extend(points.first().copied());
                    painter.extend(Shape::dashed_line(&points, Stroke::new(1.5, colour), 4.0, 3.0));
                } else {
                    painter.add(Shape::mesh(outline_mesh(rect, view, ring, Stroke::new(1.5, colour))));
                }
            }
        }
        MarkShape::Line(segment) => {
            let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
            let middle = ends[0] + (ends[1] - ends[0]) / 2.0;
            let half = (ends[1] - ends[0]) / 2.0;
            // Never too short to be visible.
            let half = if half.length() < 2.0 { vec2(2.0, 0.0) } else { half };
            let line = [middle - half, middle + half];
            if is_gone {
                painter.extend(Shape::dashed_line(&line, Stroke::new(2.0, colour), 4.0, 3.0));
            } else {
                painter.line_segment(line, Stroke::new(3.5, colour));
            }
        }
    }
}

/// The meaning of the marks.
pub(crate) fn legend(ui: &mut Ui, kinds: impl Iterator<Item = MarkKind>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        for kind in kinds {
            let (square, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            let colour = kind.colour(colours(ui));
            let strength = if kind == MarkKind::Removed { 0.12 } else { 0.32 };
            ui.painter().rect_filled(square, 2.0, colour.gamma_multiply(strength));
            ui.painter().rect_stroke(square, 2.0, Stroke::new(1.5, colour), StrokeKind::Inside);
            crate::app::look::widgets::caption(ui, kind.title());
            ui.add_space(10.0);
        }
    });
}
