//! Live dimensions: the lengths of the selected rooms' walls beside their edges, area and perimeter
//! below. They avoid each other and room names.

use crate::app::paint::places::paper;
use std::sync::Arc;

use egui::epaint::TextShape;
use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::look::theme::{self, Colours};
use crate::app::paint::places::on_screen;
use crate::app::session::Session;
use crate::app::session::document::Derived;
use crate::base::units::Units;
use crate::draw::View;
use crate::geometry::{
    polygon,
    runs::{Run, runs},
};
use crate::topology::RoomShape;

/// With more rooms selected, only their totals are shown.
const MOST_ROOMS: usize = 6;

/// For a room with more walls, only area and perimeter are shown: it is round, or a scan.
const MOST_RUNS: usize = 40;

/// Gap in points between an edge and its number: outside a wall's drawn thickness.
const GAP: f32 = 5.0;

/// How much longer a wall must be than its number, in points.
const SPARE: f32 = 10.0;

/// A number and its position.
struct Label {
    galley: Arc<Galley>,
    centre: Pos2,
    /// Clockwise, as in egui; within a quarter turn of horizontal.
    angle_rad: f32,
}

impl Label {
    /// Its axis-aligned bounding box.
    fn bounds(&self) -> Rect {
        let (size, (sin, cos)) = (self.size(), self.angle_rad.sin_cos());
        let extent = vec2((size.x * cos).abs() + (size.y * sin).abs(), (size.x * sin).abs() + (size.y * cos).abs());
        Rect::from_center_size(self.centre, extent)
    }

    /// Including the text's background.
    fn size(&self) -> Vec2 {
        self.galley.size() + vec2(8.0, 2.0)
    }

    fn paint(&self, painter: &Painter, ground: Color32) {
        let turned = |offset: Vec2| {
            let (sin, cos) = self.angle_rad.sin_cos();
            self.centre + vec2(offset.x * cos - offset.y * sin, offset.x * sin + offset.y * cos)
        };
        let half = self.size() / 2.0;
        let corners = [vec2(-half.x, -half.y), vec2(half.x, -half.y), half, vec2(-half.x, half.y)].map(turned);
        painter.add(Shape::convex_polygon(corners.to_vec(), ground, Stroke::NONE));
        let at = turned(-self.galley.size() / 2.0);
        painter.add(TextShape::new(at, self.galley.clone(), Color32::PLACEHOLDER).with_angle(self.angle_rad));
    }
}

/// Paints the dimensions of the selected rooms where they do not cover `names`.
pub(crate) fn paint(
    painter: &Painter,
    rect: Rect,
    view: &View,
    session: &Session,
    derived: &Derived,
    names: impl FnOnce() -> Vec<Rect>,
) {
    if !session.layers.dimensions {
        return;
    }
    let shapes: Vec<&RoomShape> = session
        .selection()
        .rooms()
        .filter_map(|id| derived.analysis.shapes.get(id))
        .filter(|shape| !shape.outer.is_empty())
        .collect();
    let all = shapes.iter().map(|shape| shape.bounds).reduce(crate::geometry::Bounds::union);
    let Some(all) = all else { return };
    let colours = theme::colours(&painter.ctx().global_style().visuals);
    let paper = theme::colour(paper(session.layers.colours, painter.ctx()));
    let sheet = Sheet { painter, rect, view, units: session.units(), colours, names: names() };
    let mut labels: Vec<Label> = Vec::new();
    if shapes.len() <= MOST_ROOMS {
        for shape in &shapes {
            sheet.walls(shape, &mut labels);
        }
    }
    sheet.whole(&shapes, all, &mut labels);
    for label in &labels {
        label.paint(painter, paper.gamma_multiply(0.9));
    }
}

struct Sheet<'a> {
    painter: &'a Painter,
    rect: Rect,
    view: &'a View,
    units: Units,
    colours: &'a Colours,
    /// The texts on the plan.
    names: Vec<Rect>,
}

impl Sheet<'_> {
    fn text(&self, text: String) -> Arc<Galley> {
        let font = FontId::new(theme::SMALL, theme::semibold());
        self.painter.layout_no_wrap(text, font, self.colours.accent)
    }

    /// The length of each wall of a room, beside it on the outside.
    fn walls(&self, shape: &RoomShape, labels: &mut Vec<Label>) {
        let rings: Vec<(Vec<Run>, f32)> = shape
            .rings()
            .enumerate()
            .map(|(index, ring)| {
                // The inside of a counter-clockwise ring is on its left.
                let is_left_inside = (polygon::signed_area(ring) > 0.0) == (index == 0);
                (runs(ring), if is_left_inside { 1.0 } else { -1.0 })
            })
            .collect();
        if rings.iter().map(|(runs, _)| runs.len()).sum::<usize>() > MOST_RUNS {
            return;
        }
        for (runs, side) in rings {
            for run in runs {
                let [a, b] = [run.start, run.end].map(|point| on_screen(self.rect, self.view, point));
                let along = b - a;
                let galley = self.text(self.units.length(run.length_m()));
                if along.length() < galley.size().x + SPARE {
                    continue;
                }
                // The screen's y axis points down, so outside is on the left there.
                let outwards = vec2(-along.y, along.x).normalized() * side;
                let mut angle_rad = along.angle();
                // Readable from below or from the right.
                if angle_rad > std::f32::consts::FRAC_PI_2 - 0.01 {
                    angle_rad -= std::f32::consts::PI;
                } else if angle_rad < -std::f32::consts::FRAC_PI_2 - 0.01 {
                    angle_rad += std::f32::consts::PI;
                }
                let wall = (crate::plan::DEFAULT_WALL_THICKNESS_M * self.view.px_per_m) as f32;
                let off = wall.min(12.0) + GAP + galley.size().y / 2.0;
                // In the middle if that is free, otherwise nearer to an end, otherwise inside.
                for (part, side) in [(0.5, 1.0), (0.3, 1.0), (0.7, 1.0), (0.5, -1.0), (0.3, -1.0), (0.7, -1.0)] {
                    let centre = a + along * part + outwards * off * side;
                    if self.add(Label { galley: galley.clone(), centre, angle_rad }, labels) {
                        break;
                    }
                }
            }
        }
    }

    /// Area and perimeter, below the rooms, above them, or in the middle of the visible part.
    fn whole(&self, shapes: &[&RoomShape], all: crate::geometry::Bounds, labels: &mut Vec<Label>) {
        let area_m2: f64 = shapes.iter().map(|shape| shape.area_m2()).sum();
        let perimeter_m: f64 = shapes.iter().map(|shape| shape.perimeter_m()).sum();
        let mut text = self.units.area(area_m2);
        match shapes.len() {
            1 => text.push_str(&format!("  ·  {} around", self.units.length(perimeter_m))),
            several => text = format!("{several} rooms  ·  {text}"),
        }
        let galley = self.text(text);
        let corners = [all.min, all.max].map(|point| on_screen(self.rect, self.view, point));
        let on_screen = Rect::from_two_pos(corners[0], corners[1]);
        // Rooms that are just specks get none.
        if on_screen.width().max(on_screen.height()) < 24.0 {
            return;
        }
        let half = galley.size() / 2.0;
        let below = [14.0, 32.0, 50.0].into_iter().flat_map(|off| {
            [pos2(on_screen.center().x, on_screen.bottom() + off), pos2(on_screen.center().x, on_screen.top() - off)]
        });
        let beside = [
            pos2(on_screen.right() + 40.0 + half.x, on_screen.center().y),
            pos2(on_screen.left() - 40.0 - half.x, on_screen.center().y),
            // Where it can always be found.
            pos2(self.rect.center().x, self.rect.bottom() - 18.0),
        ];
        for centre in below.chain(beside) {
            if self.add(Label { galley: galley.clone(), centre, angle_rad: 0.0 }, labels) {
                return;
            }
        }
    }

    /// Adds a label if it is fully visible and covers no other label or name; returns whether it did.
    fn add(&self, label: Label, labels: &mut Vec<Label>) -> bool {
        let bounds = label.bounds();
        let is_free = self.rect.contains_rect(bounds)
            && labels.iter().all(|other| !other.bounds().intersects(bounds))
            && self.names.iter().all(|name| !name.intersects(bounds));
        if is_free {
            labels.push(label);
        }
        is_free
    }
}
