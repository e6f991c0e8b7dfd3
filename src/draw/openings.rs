//! Doors, passages and windows as architects draw them: cut out of their wall, doors with the leaf and
//! the arc of its swing.

use std::collections::BTreeMap;

use super::elements::RoomDrawing;
use super::scene::{Dash, Frame, Group, Item, Layer, Length, View};
use super::walls::Faces;
use super::{Rgba, Style};
use crate::features::{Analysis, RoomStatus};
use crate::geometry::polygon::Location;
use crate::geometry::{Bounds, Point, Segment, Vector, areas};
use crate::labels::{Label, function_title};
use crate::plan::{LeafSide, Opening, OpeningId, OpeningKind, Plan, Swing, THICKEST_WALL_M};

/// An opening as drawn.
pub(super) struct OpeningDrawing {
    pub id: OpeningId,
    kind: OpeningKind,
    /// Its middle, on the axis of its wall.
    pub centre: Point,
    /// Unit vector along the wall.
    along: Vector,
    half_width: f64,
    /// Distances of the wall's faces from `centre` along the left-hand normal: right (negative), left.
    faces: (f64, f64),
    /// The piece cut out of the wall; `None` if it is in no wall.
    pub cut: Option<Vec<[f64; 2]>>,
    /// The rooms on both sides, left first, as indices into the drawing's rooms: their floors show in the
    /// cut.
    pub sides: [Option<usize>; 2],
    leaves: Vec<Leaf>,
}

/// An opening as it is drawn: moved into its wall, its doors hung. For writers that draw it themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedOpening {
    pub id: OpeningId,
    pub kind: OpeningKind,
    /// Its middle, on the axis of its wall.
    pub centre: Point,
    /// Unit vector along the wall.
    pub along: Vector,
    /// Clear width in metres.
    pub width_m: f64,
    /// Distances of the wall's faces from `centre` along the left-hand normal: of the right one (negative), and of the
    /// left one.
    pub right_m: f64,
    pub left_m: f64,
    /// The leaves of a door: hinge, end of the closed leaf, end of the open leaf. None for one that slides.
    pub leaves: Vec<[Point; 3]>,
}

/// A door's leaf, open at 90 degrees.
#[derive(Clone, Copy)]
struct Leaf {
    hinge: Point,
    /// The free end of the open leaf.
    tip: Point,
    /// The free end of the closed leaf.
    shut: Point,
}

impl Leaf {
    /// Points spread over the quarter disc of the leaf's swing.
    fn sweep(self) -> impl Iterator<Item = Point> {
        let (open, shut) = (self.tip - self.hinge, self.shut - self.hinge);
        [(0.9, 0.1), (0.66, 0.66), (0.1, 0.9), (0.5, 0.5), (0.25, 0.25), (0.55, 0.2), (0.2, 0.55)]
            .into_iter()
            .map(move |(p, q)| self.hinge + open * p + shut * q)
    }
}

/// A single door wider than this, in metres, slides: no hinged leaf is that wide (a wheelchair needs 0.9,
/// a hospital bed 1.2).
const WIDEST_LEAF_M: f64 = 1.3;

/// How far from its given line an opening looks for its wall, in metres: imported doors lie on a room's
/// boundary, up to a wall's thickness from the neighbour's.
const SEAT_REACH_M: f64 = 0.45;

/// The wall thickness drawn for an opening in no wall, in metres.
const NO_WALL_M: f64 = 0.1;

impl OpeningDrawing {
    /// All openings by id.
    pub fn all(plan: &Plan, analysis: &Analysis, rooms: &[RoomDrawing], faces: &Faces) -> Vec<Self> {
        let mut drawn: Vec<Self> = Vec::new();
        let mut hung = Hung::default();
        for (id, opening) in plan.openings() {
            let Some(mut seated) = Self::seated(plan, id, opening, faces) else { continue };
            seated.sides = [1.0, -1.0].map(|side| seated.room_beside(side, analysis));
            seated.hang(opening, rooms, faces, &hung);
            hung.add(&seated.leaves);
            drawn.push(seated);
        }
        drawn
    }

    /// The opening in its wall, shifted along it as needed not to overhang the wall's end.
    fn seated(plan: &Plan, id: OpeningId, opening: &Opening, faces: &Faces) -> Option<Self> {
        let segment = plan.opening_segment(opening)?;
        let along = segment.vector().unit()?;
        let normal = along.left();
        let mut half_width = segment.length() / 2.0;
        let mut middle = segment.midpoint();
        // Probed at three places, since one may look along a wall that ends here. The thinnest result is
        // the wall; where it widens along the opening, all of it is taken.
        let seen: Vec<(f64, f64)> = [0.0, -0.8, 0.8]
            .into_iter()
            .filter_map(|place| faces.wall_at(middle + along * (place * half_width), normal, SEAT_REACH_M))
            .collect();
        let wall = seen.iter().copied().min_by(|p, q| (p.1 - p.0).total_cmp(&(q.1 - q.0))).map(|thinnest| {
            seen.iter().fold(thinnest, |(right, left), other| {
                let (low, high) = (right.min(other.0), left.max(other.1));
                let meets = other.0 <= left && other.1 >= right;
                if meets && high - low <= THICKEST_WALL_M { (low, high) } else { (right, left) }
            })
        });
        let (right, left) = wall.unwrap_or((-NO_WALL_M / 2.0, NO_WALL_M / 2.0));
        if wall.is_some() {
            // Just off both faces: the stretch where no other wall is in the way.
            let open = [right - OFF_FACE_M, left + OFF_FACE_M]
                .map(|offset| faces.open_at(middle + normal * offset, along, 4.0 * half_width));
            if let [Some(one), Some(other)] = open {
                let (from, to) = (one.0.max(other.0), one.1.min(other.1));
                // If there is hardly any room, as given: better visible than lost.
                if to - from > half_width {
                    half_width = half_width.min((to - from) / 2.0);
                    // Not `clamp`: rounding may have made the bounds cross.
                    middle = middle + along * 0.0_f64.max(from + half_width).min(to - half_width);
                }
            }
        }
        let centre = middle + normal * ((left + right) / 2.0);
        let half_depth = (left - right) / 2.0;
        let cut = wall.is_some().then(|| {
            let (u, v) = (along * half_width, normal * (half_depth + CUT_BEYOND_M));
            areas::ring(&[centre - u - v, centre + u - v, centre + u + v, centre - u + v])
        });
        Some(Self {
            id,
            kind: opening.kind,
            centre,
            along,
            half_width,
            faces: (-half_depth, half_depth),
            cut,
            sides: [None; 2],
            leaves: Vec::new(),
        })
    }

    /// The room just off a face: on the left for a positive side, else on the right.
    fn room_beside(&self, side: f64, analysis: &Analysis) -> Option<usize> {
        let offset = if side > 0.0 { self.faces.1 } else { self.faces.0 };
        analysis.shapes.at(self.centre + self.normal() * (offset + side * BESIDE_M)).first().copied()
    }

    /// Hangs a door's leaves: as the plan says, or else as an architect would.
    fn hang(&mut self, opening: &Opening, rooms: &[RoomDrawing], faces: &Faces, hung: &Hung) {
        let width = 2.0 * self.half_width;
        let leaf_count = match self.kind {
            OpeningKind::Door if width <= WIDEST_LEAF_M => 1.0,
            OpeningKind::DoubleDoor if width <= 2.0 * WIDEST_LEAF_M => 2.0,
            _ => return,
        };
        let is_lift = |side: Option<usize>| side.is_some_and(|index| rooms[index].is_lift());
        if opening.swing.is_none() && self.sides.into_iter().any(is_lift) {
            return;
        }
        if let Some(swing) = opening.swing {
            self.leaves = self.leaves(leaf_count, swing.hinge_at_start, swing.side);
            return;
        }
        let [left, right] = self.sides.map(|side| side.map(|index| &rooms[index]));
        let mut best: Option<(f64, Vec<Leaf>)> = None;
        for (side, room, other) in [(LeafSide::Left, left, right), (LeafSide::Right, right, left)] {
            for hinge_at_start in [true, false] {
                let leaves = self.leaves(leaf_count, hinge_at_start, side);
                let cost = swing_cost(&leaves, room, other, hung)
                    + self.hinge_cost(hinge_at_start, side, faces) * f64::from(leaf_count == 1.0);
                if best.as_ref().is_none_or(|(least, _)| cost < *least - 1e-9) {
                    best = Some((cost, leaves));
                }
            }
        }
        self.leaves = best.map(|(_, leaves)| leaves).unwrap_or_default();
    }

    /// The leaves when hung this way.
    fn leaves(&self, count: f64, hinge_at_start: bool, side: LeafSide) -> Vec<Leaf> {
        let (offset, sign) = match side {
            LeafSide::Left => (self.faces.1, 1.0),
            LeafSide::Right => (self.faces.0, -1.0),
        };
        let face = self.centre + self.normal() * offset;
        let (start, end) = (face - self.along * self.half_width, face + self.along * self.half_width);
        let length = 2.0 * self.half_width / count;
        let leaf = |hinge: Point, towards: Vector| Leaf {
            hinge,
            tip: hinge + self.normal() * (sign * length),
            shut: hinge + towards * length,
        };
        match (count > 1.0, hinge_at_start) {
            (true, _) => vec![leaf(start, self.along), leaf(end, -self.along)],
            (false, true) => vec![leaf(start, self.along)],
            (false, false) => vec![leaf(end, -self.along)],
        }
    }

    /// The cost of a hinge position. An architect hinges a door so that the open leaf rests along the
    /// nearer wall: the cost is 1 if it is hinged by the farther one.
    fn hinge_cost(&self, hinge_at_start: bool, side: LeafSide, faces: &Faces) -> f64 {
        let (offset, sign) = match side {
            LeafSide::Left => (self.faces.1, 1.0),
            LeafSide::Right => (self.faces.0, -1.0),
        };
        // Half a door's width into the room, to see past what is at the jamb.
        let from = self.centre + self.normal() * (offset + sign * self.half_width.max(OFF_FACE_M));
        // A leaf does not rest along a wall further away than this.
        const FAR_M: f64 = 4.0;
        let (to_start, to_end) = (faces.free(from, -self.along, FAR_M), faces.free(from, self.along, FAR_M));
        let (near, far) = if hinge_at_start { (to_start, to_end) } else { (to_end, to_start) };
        // Steps of 5 cm, so that rounding does not break ties.
        f64::from(((near - far) * 20.0).round() > 0.0)
    }

    /// How its first leaf is hung; `None` if it has none.
    pub fn swing(&self) -> Option<Swing> {
        let leaf = self.leaves.first()?;
        let side = if (leaf.tip - leaf.hinge).dot(self.normal()) >= 0.0 { LeafSide::Left } else { LeafSide::Right };
        Some(Swing { hinge_at_start: (leaf.shut - leaf.hinge).dot(self.along) > 0.0, side })
    }

    /// Its place and leaves.
    pub fn placed(&self) -> PlacedOpening {
        PlacedOpening {
            id: self.id,
            kind: self.kind,
            centre: self.centre,
            along: self.along,
            width_m: 2.0 * self.half_width,
            right_m: self.faces.0,
            left_m: self.faces.1,
            leaves: self.sweeps().collect(),
        }
    }

    /// Whether one can walk through it.
    pub const fn is_passable(&self) -> bool {
        self.kind.is_passable()
    }

    /// Unit vector to the left of `along`.
    pub fn normal(&self) -> Vector {
        self.along.left()
    }

    /// The bounding box of all that is drawn of it.
    pub fn bounds(&self) -> Bounds {
        let Segment { a, b } = self.segment();
        Bounds::of([a, b].into_iter().chain(self.leaves.iter().map(|leaf| leaf.tip)))
    }

    /// The areas its leaves swing through: hinge, end of the closed leaf, end of the open leaf.
    pub fn sweeps(&self) -> impl Iterator<Item = [Point; 3]> + '_ {
        self.leaves.iter().map(|leaf| [leaf.hinge, leaf.shut, leaf.tip])
    }

    /// Its segment as drawn.
    pub fn segment(&self) -> Segment {
        let u = self.along * self.half_width;
        Segment::new(self.centre - u, self.centre + u)
    }

    /// Its shapes.
    ///
    /// `floors` are the colours of the rooms' fills.
    pub fn group(&self, style: &Style, view: &View, floors: &[Rgba]) -> Group {
        let palette = style.palette();
        let fine = Length::Px(1.0);
        let mut items = Vec::new();
        let at = |u: f64, v: f64| self.centre + self.along * (u * self.half_width) + self.normal() * v;
        let line = |points: Vec<Point>, colour, width| Item::Line { points, closed: false, colour, width, dash: None };
        let (right, left) = self.faces;
        if self.cut.is_some() && self.kind == OpeningKind::Window {
            // Whatever rooms extend into the wall: a window is glass, not floor.
            let outer = vec![at(-1.0, right), at(1.0, right), at(1.0, left), at(-1.0, left)];
            items.push(Item::Polygon { outer, holes: Vec::new(), colour: palette.paper.faded(style.fill_opacity) });
        } else if self.cut.is_some() && style.layers.rooms && style.fill_opacity >= 1.0 {
            // The floor of each room extends to the middle of the wall, or all the way through if there
            // is only one. (Rooms may extend into the wall: translucent floors would show twice.)
            let [on_left, on_right] = self.sides.map(|side| side.map(|index| floors[index]));
            let halves = match (on_left, on_right) {
                (Some(colour), Some(other)) if colour != other => {
                    [Some((0.0, left, colour)), Some((right, 0.0, other))]
                }
                (Some(colour), _) | (None, Some(colour)) => [Some((right, left, colour)), None],
                (None, None) => [None; 2],
            };
            for (from, to, colour) in halves.into_iter().flatten() {
                let outer = vec![at(-1.0, from), at(1.0, from), at(1.0, to), at(-1.0, to)];
                items.push(Item::Polygon { outer, holes: Vec::new(), colour });
            }
            // The threshold of an outside door.
            for (side, face) in [(on_left, left), (on_right, right)] {
                if side.is_none() && self.kind != OpeningKind::Passage {
                    items.push(line(vec![at(-1.0, face), at(1.0, face)], palette.boundary, fine));
                }
            }
        }
        match self.kind {
            OpeningKind::Window => {
                for v in [right, left] {
                    items.push(line(vec![at(-1.0, v), at(1.0, v)], palette.leaf, fine));
                }
                let panes: &[f64] = if (left - right) * view.px_per_m >= 9.0 { &[-0.12, 0.12] } else { &[0.0] };
                for pane in panes {
                    let v = pane * (left - right);
                    items.push(line(vec![at(-1.0, v), at(1.0, v)], palette.glass, fine));
                }
                for u in [-1.0, 1.0] {
                    items.push(line(vec![at(u, right), at(u, left)], palette.leaf, fine));
                }
            }
            OpeningKind::Passage => {
                let dash = Some(Dash { dash: Length::Px(4.0), gap: Length::Px(3.0) });
                let lintels = if self.cut.is_some() { vec![right, left] } else { vec![0.0] };
                for v in lintels {
                    items.push(Item::Line {
                        points: vec![at(-1.0, v), at(1.0, v)],
                        closed: false,
                        colour: palette.boundary,
                        width: fine,
                        dash,
                    });
                }
            }
            OpeningKind::Door | OpeningKind::DoubleDoor if self.leaves.is_empty() => {
                // Two panels that slide past each other, each slightly wider than half the opening.
                let depth = ((left - right) * 0.3).min(0.05);
                for (from, to, v) in [(-1.0, 0.06, depth / 2.0), (-0.06, 1.0, -depth / 2.0)] {
                    let width = Length::Px((depth * 0.8 * view.px_per_m).max(1.2));
                    items.push(line(vec![at(from, v), at(to, v)], palette.leaf, width));
                }
                for v in [right, left] {
                    items.push(line(vec![at(-1.0, v), at(1.0, v)], palette.boundary, Length::Px(0.75)));
                }
            }
            OpeningKind::Door | OpeningKind::DoubleDoor => {
                for leaf in &self.leaves {
                    let radius_px = leaf.hinge.distance(leaf.tip) * view.px_per_m;
                    if radius_px >= SMALLEST_SWING_PX {
                        items.push(Item::Arc {
                            centre: leaf.hinge,
                            from: leaf.shut,
                            to: leaf.tip,
                            colour: palette.swing,
                            width: fine,
                        });
                    }
                    let thickness_px = LEAF_M * view.px_per_m;
                    if thickness_px < THINNEST_HOLLOW_PX {
                        items.push(line(vec![leaf.hinge, leaf.tip], palette.leaf, Length::Px(1.5)));
                    } else {
                        let back = (leaf.shut - leaf.hinge) * (LEAF_M / leaf.hinge.distance(leaf.shut));
                        let outer = vec![leaf.hinge, leaf.tip, leaf.tip + back, leaf.hinge + back];
                        items.push(Item::Polygon { outer: outer.clone(), holes: Vec::new(), colour: palette.paper });
                        items.push(Item::Line {
                            points: outer,
                            closed: true,
                            colour: palette.leaf,
                            width: fine,
                            dash: None,
                        });
                    }
                }
            }
        }
        let width_m = 2.0 * self.half_width;
        Group {
            element: self.id.to_string(),
            title: format!("{}, {width_m:.2} m", function_title(self.kind.name())),
            ..Group::new(Layer::Openings, Frame::Plan, items)
        }
    }
}

/// Thickness of a door leaf in metres.
const LEAF_M: f64 = 0.04;

/// A leaf at least this thick, in pixels, is drawn hollow.
const THINNEST_HOLLOW_PX: f64 = 3.0;

/// Below this radius in pixels a swing would be a blot: only the leaf is drawn.
const SMALLEST_SWING_PX: f64 = 5.0;

/// Just off a wall's face, in metres.
const OFF_FACE_M: f64 = 0.03;

/// Distance from a wall's face, in metres, to look for a room that should meet it but stops short.
const BESIDE_M: f64 = 0.1;

/// How far a cut extends beyond the faces, in metres, to leave no skin.
const CUT_BEYOND_M: f64 = 0.01;

/// The leaves hung so far, by position.
#[derive(Default)]
struct Hung {
    by_cell: BTreeMap<(i64, i64), Vec<Leaf>>,
}

impl Hung {
    /// Wider than the widest leaf: a leaf that sweeps over a point hangs in its cell or an adjacent one.
    const CELL_M: f64 = 1.5;

    fn cell(point: Point) -> (i64, i64) {
        ((point.x / Self::CELL_M).floor() as i64, (point.y / Self::CELL_M).floor() as i64)
    }

    fn add(&mut self, leaves: &[Leaf]) {
        for leaf in leaves {
            self.by_cell.entry(Self::cell(leaf.hinge)).or_default().push(*leaf);
        }
    }

    /// Whether any leaf swings over a point.
    fn is_swept(&self, point: Point) -> bool {
        let (column, row) = Self::cell(point);
        let near = (column - 1..=column + 1)
            .flat_map(|column| self.by_cell.range((column, row - 1)..=(column, row + 1)))
            .flat_map(|(_, leaves)| leaves);
        near.into_iter().any(|leaf| {
            let (open, shut) = (leaf.tip - leaf.hinge, leaf.shut - leaf.hinge);
            let from = point - leaf.hinge;
            from.dot(open) > 0.0 && from.dot(shut) > 0.0 && from.length() < open.length()
        })
    }
}

/// The cost of leaves opening into `room`, away from `other`.
fn swing_cost(leaves: &[Leaf], room: Option<&RoomDrawing>, other: Option<&RoomDrawing>, hung: &Hung) -> f64 {
    let Some(room) = room else {
        // Out of the building, into the way of people outside.
        return 12.0;
    };
    let through = |room: &RoomDrawing| matches!(room.status, RoomStatus::Labelled(Label::Corridor | Label::Hall));
    let mut cost = match other {
        // From outside or a balcony, it opens into the building.
        None => 0.0,
        Some(other) if room.is_open_air() != other.is_open_air() => 8.0 * f64::from(room.is_open_air()),
        // Not into a corridor, where it hits people; otherwise into the smaller room.
        Some(other) if through(room) != through(other) => 4.0 * f64::from(through(room)),
        Some(other) => 2.0 * f64::from(room.area_m2 > other.area_m2),
    };
    for leaf in leaves {
        let share = 1.0 / (leaves.len() * leaf.sweep().count()) as f64;
        for point in leaf.sweep() {
            let inside = room.bounds.contains(point)
                && crate::geometry::polygon::locate(&room.outer, &room.holes, point) != Location::Outside;
            if !inside {
                cost += 14.0 * share;
            }
            if hung.is_swept(point) {
                cost += 7.0 * share;
            }
        }
    }
    cost
}
