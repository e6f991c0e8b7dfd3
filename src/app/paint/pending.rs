//! Changes since the last analysis, painted at once over the drawing of the previous plan, so that edits
//! are visible immediately.

use std::collections::BTreeSet;

use egui::{Color32, Painter, Rect, Shape, Stroke};

use crate::app::look::theme;
use crate::app::paint::{
    places::on_screen,
    scene_painter::{earcut, outline_mesh, polygon_mesh},
};
use crate::draw::{Fill, Style, View};
use crate::features::RoomStatus;
use crate::geometry::{Point, Segment};
use crate::labels::Schemes;
use crate::plan::{CornerId, Difference, ElementId, OpeningId, Place, Plan, Room, RoomId, Wall};

/// With more changes than this, everything is veiled until analysed: painting them would take longer than
/// a frame.
const MOST_CHANGES: usize = 1500;

/// The minimum drawn thickness of a wall, in points.
const THINNEST_WALL_PX: f64 = 1.5;

/// An outer ring, its holes, and the room now there.
type Area = (Vec<Point>, Vec<Vec<Point>>, Option<RoomId>);

/// The visible difference between two plans.
pub(crate) struct Pending {
    earlier: Plan,
    plan: Plan,
    /// Whether there are too many changes to paint them separately, or one that affects everything.
    is_all: bool,
    /// Outdated areas to paint over, each with the room whose fill it gets: `None` if there is no room
    /// now.
    areas: Vec<Area>,
    /// Walls that were removed.
    gone: Vec<(Segment, f64)>,
    /// What changed, and what stands around changed rooms, which get painted over.
    around: Around,
    /// The rooms that are there now, of the areas.
    rooms: BTreeSet<RoomId>,
}

/// Walls, with their thickness in metres, and openings.
#[derive(Default)]
pub(crate) struct Around {
    walls: Vec<(Segment, f64)>,
    openings: Vec<OpeningId>,
}

impl Around {
    /// What stands around some rooms of a plan.
    pub(crate) fn rooms(plan: &Plan, rooms: &[RoomId]) -> Self {
        let rings = rooms.iter().filter_map(|&id| plan.room(id)).flat_map(Room::rings);
        Self::between(plan, &rings.flat_map(|ring| ring.iter().copied()).collect())
    }

    /// What stands between some corners of a plan.
    fn between(plan: &Plan, corners: &BTreeSet<CornerId>) -> Self {
        if corners.is_empty() {
            return Self::default();
        }
        let is_between = |ends: [CornerId; 2]| ends.iter().all(|end| corners.contains(end));
        let walls = plan.walls().filter(|(_, wall)| is_between([wall.from, wall.to]));
        let openings = plan.openings().filter(|(_, opening)| match opening.place {
            Place::Hosted { from, to, .. } => is_between([from, to]),
            Place::Free { .. } => false,
        });
        Self {
            walls: walls.filter_map(|(_, wall)| Some((plan.wall_segment(wall)?, wall.thickness_m))).collect(),
            openings: openings.map(|(id, _)| id).collect(),
        }
    }

    /// Paints them, over what fills the rooms.
    pub(crate) fn paint(&self, plan: &Plan, painter: &Painter, rect: Rect, view: &View, style: &Style) {
        let palette = style.palette();
        let seen = view.bounds().inflated(1.0);
        let band = |segment: &Segment, width_px: f64, colour: Color32| {
            if seen.meets(*segment) {
                let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
                painter.line_segment(ends, Stroke::new(width_px as f32, colour));
            }
        };
        for (segment, thickness_m) in &self.walls {
            band(segment, (thickness_m * view.px_per_m).max(THINNEST_WALL_PX), theme::colour(palette.wall));
        }
        // A gap with a line for the door or window in it.
        let gap_px = (crate::plan::DEFAULT_WALL_THICKNESS_M * view.px_per_m).max(THINNEST_WALL_PX) + 2.0;
        for id in &self.openings {
            let segment = plan.opening(*id).and_then(|opening| plan.opening_segment(opening));
            let Some(segment) = segment else { continue };
            band(&segment, gap_px, theme::colour(palette.paper));
            band(&segment, 1.0, theme::colour(palette.leaf));
        }
    }
}

impl Pending {
    /// The difference between two plans.
    pub(crate) fn new(earlier: &Plan, plan: &Plan) -> Self {
        let mut pending = Self {
            earlier: earlier.clone(),
            plan: plan.clone(),
            is_all: true,
            areas: Vec::new(),
            gone: Vec::new(),
            around: Around::default(),
            rooms: BTreeSet::new(),
        };
        let changed = Difference::between(earlier, plan).seen(earlier, plan);
        if earlier.meta() != plan.meta() || changed.len() > MOST_CHANGES {
            return pending;
        }
        pending.is_all = false;
        let mut around: BTreeSet<CornerId> = BTreeSet::new();
        for &element in changed.keys() {
            match element {
                ElementId::Room(id) => {
                    for (of, room, now) in [(earlier, earlier.room(id), None), (plan, plan.room(id), Some(id))] {
                        let Some(room) = room else { continue };
                        let rings: Vec<Vec<Point>> = room.rings().map(|ring| of.ring_points(ring)).collect();
                        if let Some((outer, holes)) = rings.split_first().filter(|(outer, _)| outer.len() > 2) {
                            pending.areas.push((outer.clone(), holes.to_vec(), now));
                        }
                        around.extend(room.rings().flat_map(|ring| ring.iter().copied()));
                    }
                }
                ElementId::Wall(id) => {
                    let seen = |plan: &Plan, wall: &Wall| Some((plan.wall_segment(wall)?, wall.thickness_m));
                    pending.gone.extend(earlier.wall(id).and_then(|wall| seen(earlier, wall)));
                    if let Some(wall) = plan.wall(id) {
                        around.extend([wall.from, wall.to]);
                    }
                }
                ElementId::Opening(_) | ElementId::Corner(_) | ElementId::Dimension(_) => {}
            }
        }
        // What gets painted over is painted again.
        pending.around = Around::between(plan, &around);
        let openings = changed.keys().filter_map(|&element| match element {
            ElementId::Opening(id) if plan.opening(id).is_some() => Some(id),
            _ => None,
        });
        pending.around.openings.extend(openings);
        // Removed openings leave a closed wall.
        let closed = changed.keys().filter_map(|&element| match element {
            ElementId::Opening(id) if plan.opening(id).is_none() => earlier.opening_segment(earlier.opening(id)?),
            _ => None,
        });
        pending.around.walls.extend(closed.map(|segment| (segment, crate::plan::DEFAULT_WALL_THICKNESS_M)));
        // First what was removed, then what is there.
        pending.areas.sort_by_key(|(_, _, now)| now.is_some());
        pending.rooms = pending.areas.iter().filter_map(|(_, _, now)| *now).collect();
        pending
    }

    /// Whether this is the difference between these plans.
    pub(crate) fn is_between(&self, earlier: &Plan, plan: &Plan) -> bool {
        self.earlier.is_same_value(earlier) && self.plan.is_same_value(plan)
    }

    /// Whether the fill of a room is painted over.
    pub(crate) fn covers(&self, room: RoomId) -> bool {
        self.rooms.contains(&room)
    }

    /// Whether it affects everything.
    pub(crate) fn is_all(&self) -> bool {
        self.is_all
    }

    /// Paints it; if it affects everything, or predictions are shown that depend on all rooms and are not known yet
    /// (`has_labels`), a veil. Draws no names: the previous ones are covered.
    pub(crate) fn paint(
        &self,
        painter: &Painter,
        rect: Rect,
        view: &View,
        style: &Style,
        schemes: &Schemes,
        has_labels: bool,
    ) {
        let palette = style.palette();
        if self.is_all || (style.fill == Fill::Prediction && !has_labels) {
            painter.rect_filled(rect, 0.0, theme::colour(palette.paper).gamma_multiply(0.6));
            return;
        }
        for (outer, holes, now) in &self.areas {
            let triangles = earcut(outer, holes);
            let fill = now.and_then(|id| self.plan.room(id)).map_or(palette.paper, |room| match style.fill {
                Fill::Label => palette.status(RoomStatus::of(&self.plan, schemes, room)),
                Fill::Function | Fill::Prediction | Fill::None => palette.paper,
            });
            let mesh = polygon_mesh(rect, view, outer, holes, &triangles, theme::colour(fill));
            painter.add(Shape::mesh(mesh));
            if now.is_some() {
                for ring in std::iter::once(outer).chain(holes) {
                    let stroke = Stroke::new(1.0, theme::colour(palette.boundary));
                    painter.add(Shape::mesh(outline_mesh(rect, view, ring, stroke)));
                }
            }
        }
        self.paint_walls(painter, rect, view, style);
    }

    /// Paints walls and openings, over what fills the rooms.
    pub(crate) fn paint_walls(&self, painter: &Painter, rect: Rect, view: &View, style: &Style) {
        let paper = theme::colour(style.palette().paper);
        let seen = view.bounds().inflated(1.0);
        for (segment, thickness_m) in self.gone.iter().filter(|(segment, _)| seen.meets(*segment)) {
            // One pixel more on both sides, to cover the soft edges.
            let width_px = (thickness_m * view.px_per_m).max(THINNEST_WALL_PX) + 2.0;
            let ends = [segment.a, segment.b].map(|point| on_screen(rect, view, point));
            painter.line_segment(ends, Stroke::new(width_px as f32, paper));
        }
        self.around.paint(&self.plan, painter, rect, view, style);
    }
}
