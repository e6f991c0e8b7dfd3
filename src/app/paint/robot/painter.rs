//! Paints the robot and what it knows over the plan, which it fades.

use std::sync::Arc;

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use super::sights::Remembered;
use super::{FanSeen, Filled, FrontierSeen, MarkSeen, RobotSeen, RoomSeen, RoomsSeen, Tone};
use crate::app::look::theme;
use crate::app::paint::places::on_screen;
use crate::app::paint::preview::tag;
use crate::app::paint::scene_painter::{outline_mesh, polygon_mesh};
use crate::base::units::Units;
use crate::base::wording::sentence;
use crate::draw::{Palette, RobotColours, View};
use crate::geometry::{Bounds, Point, Segment};
use crate::robot::Pose;

/// How much of the plan the unknown hides, 0 to 1.
const VEIL: f32 = 0.86;

/// Segments shorter than this, in metres, are no walls (paper, section 3.3): drawn thinner.
const SHORTEST_WALL_M: f64 = 0.30;

/// A robot is never drawn smaller than this, in points.
const LEAST_ROBOT_PX: f32 = 7.0;

/// The fan of the laser: how opaque it is at the scanner and at its end.
const FAN: [f32; 2] = [0.30, 0.07];

/// Of two neighbouring beams the fan follows the longer one no further than this beyond the shorter, in metres.
const FAN_JUMP_M: f64 = 0.3;

/// The most frontiers that get a label; the longest are first.
const MOST_TAGS: usize = 12;

/// Frontiers shorter than this, in metres, get none.
const TAGGED_M: f64 = 0.6;

/// Paints, and remembers what costs more than a frame.
#[derive(Default)]
pub(crate) struct RobotPainter {
    sights: Remembered,
}

/// Where and how it is painted.
struct Ground<'a> {
    painter: &'a Painter,
    rect: Rect,
    view: &'a View,
    palette: &'a Palette,
    colours: &'static RobotColours,
    seen: Bounds,
}

impl Ground<'_> {
    fn at(&self, point: Point) -> Pos2 {
        on_screen(self.rect, self.view, point)
    }

    fn px(&self, metres: f64) -> f32 {
        (metres * self.view.px_per_m) as f32
    }

    fn robot_radius(&self, seen: &RobotSeen<'_>) -> f32 {
        self.px(seen.radius_m).max(LEAST_ROBOT_PX)
    }

    fn fill(&self, filled: &Filled, colour: Color32) {
        if Bounds::of(filled.outer.iter().copied()).intersects(self.seen) {
            let Filled { outer, holes, triangles } = filled;
            let mesh = polygon_mesh(self.rect, self.view, outer, holes, triangles, colour);
            self.painter.add(Shape::mesh(mesh));
        }
    }

    fn segment(&self, segment: Segment, stroke: Stroke) {
        if self.seen.meets(segment) {
            self.painter.line_segment([self.at(segment.a), self.at(segment.b)], stroke);
        }
    }

    /// The points of a path on the screen, without those closer together than can be seen.
    fn path(&self, path: &[Point], last: Option<Point>) -> Vec<Pos2> {
        const CLOSE_PX: f32 = 1.5;
        let mut points: Vec<Pos2> = Vec::with_capacity(path.len().min(4096));
        for &point in path.iter().chain(&last) {
            let at = self.at(point);
            if points.last().is_none_or(|before| before.distance(at) >= CLOSE_PX) {
                points.push(at);
            }
        }
        points
    }
}

impl RobotPainter {
    /// Paints over the plan. `pointer`: where the pointer is in the plan, for the lines of sight.
    pub(crate) fn paint(
        &mut self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        palette: &Palette,
        units: Units,
        seen: &RobotSeen<'_>,
        pointer: Option<Point>,
    ) {
        let colours = RobotColours::of(palette.theme);
        let ground = Ground { painter, rect, view, palette, colours, seen: view.bounds() };
        painter.rect_filled(rect, 0.0, theme::colour(colours.unknown).gamma_multiply(VEIL));
        for part in seen.map.free.iter() {
            ground.fill(part, theme::colour(colours.free));
        }
        let rooms = &seen.map.rooms;
        for room in &rooms.rooms {
            let fill = room.label.map_or(palette.unlabelled, |label| palette.label(label));
            let strength = if seen.shows_sights { 0.45 } else { 1.0 };
            ground.fill(&room.floor, theme::colour(fill).gamma_multiply(strength));
        }
        if !seen.is_over {
            for fan in seen.fans {
                paint_fan(&ground, fan, seen.pose);
            }
        }
        paint_doorways(&ground, rooms);
        if seen.shows_sights {
            paint_points(&ground, rooms);
        }
        for frontier in seen.map.frontiers.iter() {
            paint_frontier(&ground, frontier);
        }
        let wall = Stroke::new(2.0, theme::colour(colours.obstacle));
        let thing = Stroke::new(1.2, theme::colour(colours.obstacle).gamma_multiply(0.65));
        for &segment in seen.map.lines.iter() {
            ground.segment(segment, if segment.length() < SHORTEST_WALL_M { thing } else { wall });
        }
        for &segment in seen.map.fresh.iter() {
            ground.segment(segment, thing);
        }
        if seen.shows_sights {
            self.paint_around(&ground, rooms, &seen.map.lines, pointer.unwrap_or(seen.pose.position()));
        }
        if seen.shows_paths {
            paint_paths(&ground, seen);
        }
        if !seen.shows_sights {
            let mut taken: Vec<Rect> =
                rooms.rooms.iter().filter_map(|room| paint_label(&ground, room, units)).collect();
            if seen.marks.is_empty() {
                let radius = ground.robot_radius(seen);
                taken.push(Rect::from_center_size(ground.at(seen.pose.position()), Vec2::splat(2.0 * radius)));
            }
            paint_tags(&ground, &seen.map.frontiers, taken);
        }
        if seen.marks.is_empty() {
            paint_robot(&ground, seen);
        }
        for (index, mark) in seen.marks.iter().enumerate() {
            paint_mark(&ground, mark, seen.current == Some(index));
        }
    }

    /// The left of Fig. 3: what is directly visible from a point.
    fn paint_around(&mut self, ground: &Ground<'_>, rooms: &Arc<RoomsSeen>, lines: &[Segment], place: Point) {
        let Some(around) = self.sights.around(rooms, lines, place) else { return };
        let visible = theme::colour(ground.colours.visible);
        let hidden = theme::colour(ground.palette.ink_muted);
        let from = ground.at(around.from);
        for &(segment, is_visible) in &around.segments {
            let ends = [ground.at(segment.a), ground.at(segment.b)];
            if is_visible {
                ground.painter.line_segment([from, ends[0] + (ends[1] - ends[0]) / 2.0], {
                    Stroke::new(0.8, visible.gamma_multiply(0.35))
                });
                ground.painter.line_segment(ends, Stroke::new(3.0, visible));
            } else {
                ground.painter.extend(Shape::dotted_line(&ends, hidden, 6.0, 1.6));
            }
        }
        ground.painter.circle(from, 5.0, visible, Stroke::new(1.5, theme::colour(ground.colours.free)));
    }
}

/// A fan from the scanner to where its beams ended, fading outwards, and the hits as dots. Its ends stay where
/// they were seen, its tip moves with the robot.
fn paint_fan(ground: &Ground<'_>, fan: &FanSeen, pose: Pose) {
    let colour = theme::colour(ground.colours.laser);
    let [inner, outer] = FAN.map(|strength| colour.gamma_multiply(strength));
    // From the robot's middle, so that the fans of two scanners meet.
    let tip = pose.position();
    let mut mesh = Mesh::default();
    let vertex = |at: Pos2, color: Color32| Vertex { pos: at, uv: WHITE_UV, color };
    mesh.vertices.push(vertex(ground.at(tip), inner));
    for pair in fan.ends.windows(2) {
        let &[Some(from), Some(to)] = pair else { continue };
        // Between two things at different distances the nearer one ends the fan.
        let near_m = tip.distance(from).min(tip.distance(to)) + FAN_JUMP_M;
        let [from, to] = [from, to].map(|end| tip + (end - tip) * (near_m / tip.distance(end).max(near_m)));
        let first = mesh.vertices.len() as u32;
        mesh.vertices.push(vertex(ground.at(from), outer));
        mesh.vertices.push(vertex(ground.at(to), outer));
        mesh.indices.extend([0, first, first + 1]);
    }
    let hit = colour.gamma_multiply(0.9);
    for end in fan.ends.iter().flatten() {
        let at = ground.at(*end);
        let first = mesh.vertices.len() as u32;
        for corner in [vec2(-0.9, -0.9), vec2(0.9, -0.9), vec2(0.9, 0.9), vec2(-0.9, 0.9)] {
            mesh.vertices.push(vertex(at + corner, hit));
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    ground.painter.add(Shape::mesh(mesh));
}

fn paint_doorways(ground: &Ground<'_>, rooms: &RoomsSeen) {
    let colour = theme::colour(ground.colours.doorway);
    for &doorway in &rooms.doorways {
        ground.segment(doorway, Stroke::new(3.0, colour));
        for end in [doorway.a, doorway.b] {
            if ground.seen.contains(end) {
                ground.painter.circle_filled(ground.at(end), 3.0, colour);
            }
        }
    }
}

/// The right of Fig. 3: points that see each other are in one room.
fn paint_points(ground: &Ground<'_>, rooms: &RoomsSeen) {
    let weak = theme::colour(ground.palette.ink_muted);
    let line = Stroke::new(1.0, weak.gamma_multiply(0.45));
    for &sight in &rooms.sights {
        ground.segment(sight, line);
    }
    let radius = (ground.px(0.05)).clamp(1.6, 3.5);
    for &(point, room) in &rooms.points {
        if !ground.seen.contains(point) {
            continue;
        }
        let label = room.and_then(|room| rooms.rooms.get(room)).and_then(|room| room.label);
        let colour = label.map_or(weak, |label| theme::colour(ground.palette.label_strong(label)));
        ground.painter.circle_filled(ground.at(point), radius, colour);
    }
}

fn paint_frontier(ground: &Ground<'_>, frontier: &FrontierSeen) {
    if !Bounds::of(frontier.line.iter().copied()).intersects(ground.seen) {
        return;
    }
    let colour = theme::colour(ground.colours.frontier);
    let points: Vec<Pos2> = frontier.line.iter().map(|&point| ground.at(point)).collect();
    // A soft glow towards the unknown, then the dashed line itself.
    ground.painter.add(Shape::line(points.clone(), Stroke::new(7.0, colour.gamma_multiply(0.16))));
    ground.painter.extend(Shape::dashed_line(&points, Stroke::new(2.4, colour), 7.0, 4.0));
}

/// On frontiers the likely label of the room that has not been seen, as far as there is space.
/// `taken`: where something else is read.
fn paint_tags(ground: &Ground<'_>, frontiers: &[FrontierSeen], mut taken: Vec<Rect>) {
    let mut tagged: Vec<&FrontierSeen> =
        frontiers.iter().filter(|frontier| frontier.behind.is_some() && frontier.length_m >= TAGGED_M).collect();
    tagged.sort_by(|p, q| q.length_m.total_cmp(&p.length_m));
    for frontier in tagged.into_iter().take(MOST_TAGS) {
        let Some((label, probability)) = frontier.behind else { continue };
        let outward = vec2(frontier.outward.x as f32, -frontier.outward.y as f32);
        let half = vec2(52.0, 11.0);
        let at = ground.at(frontier.middle) + outward * (10.0 + half.x * outward.x.abs() + half.y * outward.y.abs());
        let about = Rect::from_center_size(at, 2.0 * half);
        if !ground.rect.contains_rect(about) || taken.iter().any(|other| other.intersects(about)) {
            continue;
        }
        taken.push(about);
        let text = format!("{}? {:.0} %", sentence(label.name()), 100.0 * probability);
        let ink = theme::colour(ground.colours.frontier);
        tag(ground.painter, at, Align2::CENTER_CENTER, &text, ink, ground.palette);
    }
}

/// Estimate, truth and odometry: a solid, a dashed and a dotted line.
fn paint_paths(ground: &Ground<'_>, seen: &RobotSeen<'_>) {
    let RobotColours { estimate, truth, odometry, .. } = *ground.colours;
    let odometry_path = ground.path(&seen.paths.odometry, None);
    let dots = Shape::dotted_line(&odometry_path, theme::colour(odometry).gamma_multiply(0.8), 6.0, 1.2);
    ground.painter.extend(dots);
    let path = ground.path(&seen.paths.estimate, Some(seen.pose.position()));
    ground.painter.add(Shape::line(path, Stroke::new(2.2, theme::colour(estimate).gamma_multiply(0.9))));
    let last = seen.true_pose.map(Pose::position);
    let path = ground.path(&seen.paths.truth, last);
    if path.len() > 1 {
        ground.painter.extend(Shape::dashed_line(&path, Stroke::new(1.0, theme::colour(truth)), 5.0, 4.0));
    }
    if !seen.is_over && seen.way.len() > 1 {
        let way = ground.path(seen.way, None);
        let colour = theme::colour(estimate).gamma_multiply(0.55);
        ground.painter.extend(Shape::dotted_line(&way, colour, 7.0, 1.4));
        if let Some(&goal) = way.last() {
            ground.painter.circle_stroke(goal, 4.0, Stroke::new(1.5, colour));
        }
    }
}

fn paint_robot(ground: &Ground<'_>, seen: &RobotSeen<'_>) {
    let radius = ground.robot_radius(seen);
    let body = theme::colour(ground.colours.estimate);
    let rim = theme::colour(ground.colours.free);
    let at = ground.at(seen.pose.position());
    // Where it really is, where that can be seen.
    if let Some(truth) = seen.true_pose {
        let there = ground.at(truth.position());
        if there.distance(at) > 2.0 {
            ground.painter.circle_stroke(there, radius, Stroke::new(1.2, theme::colour(ground.colours.truth)));
        }
    }
    ground.painter.circle_filled(at, radius + 2.5, body.gamma_multiply(0.22));
    ground.painter.circle(at, radius, body, Stroke::new(1.6, rim));
    let heading = vec2(seen.pose.heading_rad.cos() as f32, -seen.pose.heading_rad.sin() as f32);
    let across = heading.rot90();
    let point = |along: f32, aside: f32| at + heading * (along * radius) + across * (aside * radius);
    let arrow = [point(0.72, 0.0), point(-0.42, 0.48), point(-0.2, 0.0), point(-0.42, -0.48)];
    // Two triangles: an arrow with a notch is not convex.
    ground.painter.add(Shape::convex_polygon(vec![arrow[0], arrow[1], arrow[2]], rim, Stroke::NONE));
    ground.painter.add(Shape::convex_polygon(vec![arrow[0], arrow[2], arrow[3]], rim, Stroke::NONE));
}

/// The label of a room and its area, as far as there is space. Returns where.
fn paint_label(ground: &Ground<'_>, room: &RoomSeen, units: Units) -> Option<Rect> {
    let label = room.label?;
    if !ground.seen.contains(room.at) {
        return None;
    }
    let bounds = Bounds::of(room.floor.outer.iter().copied());
    let space = vec2(ground.px(bounds.width()), ground.px(bounds.height()));
    let ink = theme::colour(ground.palette.ink);
    let font = FontId::new(12.0, theme::semibold());
    let name = ground.painter.layout_no_wrap(sentence(label.name()), font.clone(), ink);
    let on_pixel = |at: Pos2| {
        let ratio = ground.view.pixel_ratio as f32;
        pos2((at.x * ratio).round() / ratio, (at.y * ratio).round() / ratio)
    };
    let put = |galley: Arc<egui::Galley>, middle: Pos2| {
        let corner = middle - galley.rect.size() / 2.0;
        ground.painter.galley(on_pixel(corner), galley, ink);
    };
    let middle = ground.at(room.at);
    let fits = |needed: Vec2| needed.x + 6.0 < space.x && needed.y + 4.0 < space.y;
    let area = units.area(room.area_m2);
    let area = ground.painter.layout_no_wrap(area, FontId::proportional(theme::SMALL), ink.gamma_multiply(0.8));
    let both = vec2(name.rect.width().max(area.rect.width()), name.rect.height() + area.rect.height());
    if fits(both) {
        let (above, below) = (name.rect.height(), area.rect.height());
        put(name, middle - vec2(0.0, below / 2.0));
        put(area, middle + vec2(0.0, above / 2.0));
        return Some(Rect::from_center_size(middle, both));
    }
    let letter = ground.painter.layout_no_wrap(label.letter().to_owned(), font, ink);
    let size = name.rect.size();
    if fits(size) {
        put(name, middle);
        return Some(Rect::from_center_size(middle, size));
    }
    let size = letter.rect.size();
    fits(size - vec2(4.0, 2.0)).then(|| {
        put(letter, middle);
        Rect::from_center_size(middle, size)
    })
}

fn paint_mark(ground: &Ground<'_>, mark: &MarkSeen, is_current: bool) {
    let colour = theme::colour(match mark.tone {
        Tone::Good => ground.colours.doorway,
        Tone::Bad => ground.palette.error,
        Tone::Weak => ground.palette.ink_muted,
    });
    let width = if is_current { 4.0 } else { 2.0 };
    for ring in &mark.rings {
        if Bounds::of(ring.iter().copied()).intersects(ground.seen) {
            let mesh = outline_mesh(ground.rect, ground.view, ring, Stroke::new(width, colour));
            ground.painter.add(Shape::mesh(mesh));
        }
    }
    if let Some([from, to]) = mark.link {
        let ends = [ground.at(from), ground.at(to)];
        ground.painter.extend(Shape::dashed_line(&ends, Stroke::new(width, colour), 8.0, 5.0));
        for end in ends {
            ground.painter.circle_filled(end, 4.0, colour);
        }
    }
    // What is right needs no sign unless it is looked at.
    if (mark.tone != Tone::Good || is_current) && ground.seen.contains(mark.at) {
        // Above the label of a room.
        let above = if mark.rings.is_empty() { 0.0 } else { 27.0 };
        let at = ground.at(mark.at) - vec2(0.0, above);
        ground.painter.circle(at, 9.0, theme::colour(ground.palette.paper), Stroke::new(1.5, colour));
        let font = FontId::new(theme::SMALL, theme::semibold());
        ground.painter.text(at, Align2::CENTER_CENTER, mark.sign, font, colour);
    }
}
