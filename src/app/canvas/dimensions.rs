//! Live dimensions: the clear lengths of the selected rooms beside the faces of their walls, clear area and perimeter
//! below; of selected walls the lengths along both faces. They avoid each other and room names.

use crate::app::paint::places::paper;
use std::sync::Arc;

use egui::epaint::TextShape;
use egui::{Color32, FontId, Galley, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use crate::app::look::theme::{self, Colours};
use crate::app::paint::places::on_screen;
use crate::app::session::Session;
use crate::app::session::document::Derived;
use crate::app::session::kept::Together;
use crate::base::units::Units;
use crate::draw::View;
use crate::geometry::{
    Segment,
    runs::{Run, runs},
};
use crate::plan::{DEFAULT_WALL_THICKNESS_M, WallId};
use crate::topology::NetRoom;
use crate::topology::wall_bodies::WallFaces;

/// With more rooms selected, only their totals are shown.
const MOST_ROOMS: usize = 6;

/// With more walls selected, none is measured.
const MOST_WALLS: usize = 12;

/// Along faces that differ by less from the axis, in metres, one length is enough.
const SAME_LENGTH_M: f64 = 0.005;

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
    derived: &Arc<Derived>,
    names: impl FnOnce() -> Vec<Rect>,
) {
    if !session.layers.dimensions {
        return;
    }
    let together = session.rooms_together(derived);
    let walls: Vec<WallId> = session.selection().walls().take(MOST_WALLS + 1).collect();
    if together.is_none() && walls.is_empty() {
        return;
    }
    let colours = theme::colours(&painter.ctx().global_style().visuals);
    let paper = theme::colour(paper(session.layers.colours, painter.ctx()));
    let sheet = Sheet { painter, rect, view, units: session.units(), colours, names: names() };
    let mut labels: Vec<Label> = Vec::new();
    let rooms = || session.selection().rooms().filter_map(|id| derived.analysis.net(id));
    if together.is_some_and(|together| together.rooms <= MOST_ROOMS) {
        for net in rooms() {
            sheet.clear_lengths(net, &mut labels);
        }
    }
    if walls.len() <= MOST_WALLS
        && let Some(plan) = session.plan()
    {
        for id in walls {
            let axis = plan.wall(id).and_then(|wall| plan.wall_segment(wall));
            if let Some(axis) = axis {
                sheet.wall(axis, derived.index.faces_of(id), &mut labels);
            }
        }
    }
    if let Some(together) = together {
        sheet.whole(&together, rooms().next(), &mut labels);
    }
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

    /// The clear lengths of a room, inside along the faces of its walls.
    fn clear_lengths(&self, net: &NetRoom, labels: &mut Vec<Label>) {
        let runs: Vec<Run> = net.rings().flat_map(|ring| runs(ring)).collect();
        if runs.len() > MOST_RUNS {
            return;
        }
        for run in runs {
            // Where walls bound it, there is room on the inside, which is on the left.
            let (side, off_m) = if net.has_walls { (-1.0, 0.0) } else { (1.0, DEFAULT_WALL_THICKNESS_M) };
            let off = (off_m * self.view.px_per_m) as f32;
            self.length(Segment::new(run.start, run.end), side, off.min(12.0), labels);
        }
    }

    /// The lengths of a wall along its faces, each beside its own; one, where they are the same.
    fn wall(&self, axis: Segment, faces: Option<WallFaces>, labels: &mut Vec<Label>) {
        let Some(faces) = faces else { return self.length(axis, 1.0, 0.0, labels) };
        let is_other = |face: Segment| (face.length() - axis.length()).abs() > SAME_LENGTH_M;
        if is_other(faces.left) || is_other(faces.right) {
            self.length(faces.left, -1.0, 0.0, labels);
        }
        self.length(faces.right, 1.0, 0.0, labels);
    }

    /// The length of a line beside it: on its right where `side` is 1, on its left where it is -1, `off` points away.
    fn length(&self, line: Segment, side: f32, off: f32, labels: &mut Vec<Label>) {
        let [a, b] = [line.a, line.b].map(|point| on_screen(self.rect, self.view, point));
        let along = b - a;
        let galley = self.text(self.units.length(line.length()));
        if along.length() < galley.size().x + SPARE {
            return;
        }
        // The screen's y axis points down, so the right is on the left there.
        let outwards = vec2(-along.y, along.x).normalized() * side;
        let mut angle_rad = along.angle();
        // Readable from below or from the right.
        if angle_rad > std::f32::consts::FRAC_PI_2 - 0.01 {
            angle_rad -= std::f32::consts::PI;
        } else if angle_rad < -std::f32::consts::FRAC_PI_2 - 0.01 {
            angle_rad += std::f32::consts::PI;
        }
        let off = off + GAP + galley.size().y / 2.0;
        // In the middle if that is free, otherwise nearer to an end, otherwise on the other side.
        for (part, side) in [(0.5, 1.0), (0.3, 1.0), (0.7, 1.0), (0.5, -1.0), (0.3, -1.0), (0.7, -1.0)] {
            let centre = a + along * part + outwards * off * side;
            if self.add(Label { galley: galley.clone(), centre, angle_rad }, labels) {
                return;
            }
        }
    }

    /// Clear area, and the perimeter of the `first` and only room, below the rooms, above them, or in the middle of the
    /// visible part.
    fn whole(&self, together: &Together, first: Option<&NetRoom>, labels: &mut Vec<Label>) {
        let all = together.bounds;
        let clear = if together.has_walls { " clear" } else { "" };
        let mut text = format!("{}{clear}", self.units.area(together.clear_m2));
        match first.filter(|_| together.rooms == 1) {
            Some(room) => text.push_str(&format!("  ·  {} around", self.units.length(room.perimeter_m()))),
            None => text = format!("{} rooms  ·  {text}", together.rooms),
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
            // Where it can always be found: beside the scale bar or, where the canvas is narrow, above it.
            pos2(self.rect.center().x, self.rect.bottom() - 18.0),
            pos2(self.rect.center().x, self.rect.bottom() - 42.0),
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
