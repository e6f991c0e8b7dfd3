//! A person at the window: every gesture is a line of the script and is counted, and its effect is
//! predicted with the same functions that the tools call.

use enfilade::edit::{self, GAP_BETWEEN_ROOMS_M, opening_at};
use enfilade::geometry::{Bounds, Point, Vector};
use enfilade::plan::{DEFAULT_DOOR_WIDTH_M, DEFAULT_WALL_THICKNESS_M, OpeningKind, Plan, RoomId};
use enfilade::snapping::{PlanIndex, Query, candidates};
use enfilade::topology::{self, RoomShapes};

/// What the canvas and its tools are like, in points: see `src/app/tools`.
const SNAP_RADIUS_PX: f64 = 10.0;
/// Of alignment over a picture, in points and in metres.
const OVER_PICTURE_PX: f64 = 3.0;
const OVER_PICTURE_M: f64 = 0.05;
const OPENING_REACH_PX: f64 = 18.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tool {
    Rectangle,
    Split,
    Room,
    Fill,
    Door,
    Passage,
}

impl Tool {
    /// The key that takes it up, and how many keys that are.
    const fn key(self) -> (&'static str, usize) {
        match self {
            Self::Rectangle => ("R", 1),
            Self::Split => ("X", 1),
            Self::Room => ("Shift+R", 2),
            Self::Fill => ("E", 1),
            Self::Door => ("D", 1),
            Self::Passage => ("O", 1),
        }
    }
}

/// What was done, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    pub clicks: usize,
    pub keys: usize,
    pub view: usize,
    /// Those for the picture and its scale.
    pub picture: usize,
}

impl Count {
    pub fn all(self) -> usize {
        self.clicks + self.keys + self.view + self.picture
    }
}

#[derive(Clone)]
pub struct Person {
    pub plan: Plan,
    pub shapes: std::rc::Rc<RoomShapes>,
    index: std::rc::Rc<PlanIndex>,
    px_per_m: f64,
    seen: Bounds,
    pixel: Point,
    tool: Option<Tool>,
    /// Whether rooms are drawn over others.
    is_over: bool,
    pub lines: Vec<String>,
    pub count: Count,
}

/// A part of the drawing on the screen, and what bringing it there took.
pub struct View {
    pub px_per_m: f64,
    pub seen: Bounds,
    /// A corner of a pixel of the screen.
    pub pixel: Point,
    pub lines: Vec<String>,
    pub count: Count,
}

/// A place for the pointer, and what it snaps to.
#[derive(Clone, Copy, Debug)]
struct Aimed {
    pointer: Point,
    got: Point,
}

impl Person {
    /// A person in front of an empty plan.
    pub fn new(view: View) -> Self {
        let plan = Plan::default();
        let (shapes, index) = (RoomShapes::new(&plan).into(), PlanIndex::new(&plan).into());
        let View { px_per_m, seen, pixel, lines, count } = view;
        Self { plan, shapes, index, px_per_m, seen, pixel, tool: None, is_over: false, lines, count }
    }

    /// Goes on in another view.
    pub fn look(&mut self, view: View) {
        (self.px_per_m, self.seen, self.pixel) = (view.px_per_m, view.seen, view.pixel);
        self.lines.extend(view.lines);
        self.count.view += view.count.view;
    }

    pub fn metres(&self, px: f64) -> f64 {
        px / self.px_per_m
    }

    fn drew(&mut self, plan: Plan) {
        self.shapes = RoomShapes::new(&plan).into();
        self.index = PlanIndex::new(&plan).into();
        self.plan = plan;
    }

    pub fn take_up(&mut self, tool: Tool) {
        if self.tool != Some(tool) {
            let (key, presses) = tool.key();
            self.lines.push(format!("key {key}"));
            self.count.keys += presses;
            self.tool = Some(tool);
        }
    }

    pub fn key(&mut self, key: &str) {
        self.lines.push(format!("key {key}"));
        self.count.keys += 1;
    }

    /// The pointer goes by whole pixels: nobody points more finely.
    pub fn on_pixel(&self, point: Point) -> Point {
        let round = |value: f64, from: f64| from + ((value - from) * self.px_per_m).round() / self.px_per_m;
        Point::new(round(point.x, self.pixel.x), round(point.y, self.pixel.y))
    }

    /// Where the pointer is for a place that is on the screen.
    fn pointer(&self, at: Point) -> Option<Point> {
        let pointer = self.on_pixel(at);
        self.seen.contains(pointer).then_some(pointer)
    }

    /// `None` where the place is not on the screen.
    fn aim(&self, at: Point, alt: bool, path: &[Point]) -> Option<Aimed> {
        let pointer = self.pointer(at)?;
        if alt {
            return Some(Aimed { pointer, got: pointer.trimmed() });
        }
        let along = match path {
            [.., before, last] => (*last - *before).unit(),
            _ => None,
        };
        let query = Query {
            pointer,
            radius_m: self.metres(SNAP_RADIUS_PX),
            alignment_m: self.metres(OVER_PICTURE_PX).min(OVER_PICTURE_M),
            seen: self.seen,
            from: path.last().copied(),
            along,
            right_angles: false,
            objects: true,
            faces: enfilade::snapping::Faces::Off,
            grid_m: None,
            points: path,
            lines: &[],
        };
        Some(Aimed { pointer, got: candidates(&self.index, &query).first().map_or(pointer, |snap| snap.point) })
    }

    fn click(&mut self, at: Point, alt: bool) {
        let with = if alt { " with Alt" } else { "" };
        let px = |metres: f64| (metres * self.px_per_m).round();
        let (x, y) = (px(at.x - self.pixel.x), px(self.pixel.y - at.y));
        self.lines.push(format!("click pixel {x},{y}{with}"));
        self.count.clicks += 1;
        self.count.keys += usize::from(alt);
    }

    /// The same person, who draws rooms over others or leaves those what they have.
    pub fn drawing_over(&self, is_over: bool) -> Self {
        let mut next = self.clone();
        if next.is_over != is_over {
            next.key("F7");
            next.is_over = is_over;
        }
        next
    }

    fn drawn(&self, corners: &[Point]) -> Option<(Plan, RoomId)> {
        let thickness_m = Some(DEFAULT_WALL_THICKNESS_M);
        if self.is_over {
            return edit::draw_room(&self.plan, corners, thickness_m).ok();
        }
        let drawn = edit::draw_room_in_free_space(&self.plan, corners, thickness_m, GAP_BETWEEN_ROOMS_M).ok()?;
        Some((drawn.plan, *drawn.rooms.first()?))
    }

    /// Draws a rectangle from corner to corner; `alt` says at which click nothing attracts.
    pub fn rectangle(&self, from: Point, to: Point, alt: [bool; 2]) -> Option<(Self, RoomId)> {
        let mut next = self.clone();
        next.take_up(Tool::Rectangle);
        let start = self.aim(from, alt[0], &[])?;
        let edges = self.index.edges_near(start.got, self.metres(1.0));
        let along = edges.first().and_then(|edge| edge.segment.vector().unit()).unwrap_or(Vector::new(1.0, 0.0));
        let end = self.aim(to, alt[1], &[])?;
        let way = end.got - start.got;
        let (x, y) = (along * way.dot(along), along.left() * way.dot(along.left()));
        if x.length() < 0.1 || y.length() < 0.1 {
            return None;
        }
        let (plan, id) = self.drawn(&[start.got, start.got + x, end.got, start.got + y])?;
        next.click(start.pointer, alt[0]);
        next.click(end.pointer, alt[1]);
        next.drew(plan);
        Some((next, id))
    }

    /// Draws a room by its corners, closed by Enter; angles are free.
    pub fn room(&self, corners: &[Point], alt: bool) -> Option<(Self, RoomId)> {
        let mut next = self.clone();
        next.take_up(Tool::Room);
        let mut path: Vec<Point> = Vec::new();
        if alt {
            next.lines.push("hold Alt".to_owned());
            next.count.keys += 1;
        }
        for &corner in corners {
            let aimed = self.aim(corner, alt, &path)?;
            // Two that attract to one place are one.
            if path.iter().any(|point| point.distance(aimed.got) < 1e-3) {
                continue;
            }
            path.push(aimed.got);
            next.click(aimed.pointer, false);
        }
        if alt {
            next.lines.push("let-go Alt".to_owned());
        }
        next.key("Enter");
        let (plan, id) = self.drawn(&path)?;
        next.drew(plan);
        Some((next, id))
    }

    /// Splits the room at a place straight across; the parts.
    pub fn split(&self, at: Point, alt: bool) -> Option<(Self, [RoomId; 2])> {
        let aimed = self.aim(at, alt, &[])?;
        let across = edit::straight_across(&self.shapes, aimed.pointer, aimed.got, self.metres(SNAP_RADIUS_PX))?;
        let walls_m = Some(DEFAULT_WALL_THICKNESS_M);
        let (plan, made) = edit::split_rooms(&self.plan, &[across.line.a, across.line.b], walls_m).ok()?;
        let [made] = made[..] else { return None };
        let mut next = self.clone();
        next.take_up(Tool::Split);
        next.click(aimed.pointer, alt);
        next.drew(plan);
        Some((next, [across.room, made]))
    }

    /// Makes a room of what is enclosed.
    pub fn fill(&self, at: Point) -> Option<(Self, RoomId)> {
        let pointer = self.pointer(at)?;
        let filled = edit::fill_at(&self.plan, pointer).ok()?;
        let [id] = filled.rooms[..] else { return None };
        let mut next = self.clone();
        next.take_up(Tool::Fill);
        next.click(pointer, false);
        next.drew(filled.plan);
        Some((next, id))
    }

    /// Puts a door or a passage where the pointer is; what it joins.
    pub fn door(&self, at: Point, kind: OpeningKind) -> Option<(Self, [Option<RoomId>; 2])> {
        let pointer = self.pointer(at)?;
        let reach_m = self.metres(OPENING_REACH_PX);
        let opening = opening_at(&self.plan, kind, pointer, DEFAULT_DOOR_WIDTH_M, reach_m, Some(pointer)).ok()?;
        let segment = self.plan.opening_segment(&opening)?;
        // The command looks for the wall anew, from the middle of what was shown.
        let (plan, id) =
            edit::place_opening(&self.plan, kind, segment.midpoint(), segment.length(), 0.1, Some(pointer)).ok()?;
        let sides = topology::sides_by_geometry(&plan, &self.shapes, plan.opening(id)?).map(|joint| joint.room());
        // A gap between walls would be bridged instead.
        let in_gap = |gap: &topology::Gap| {
            gap.segment.distance(pointer) <= reach_m && (0.02..=0.98).contains(&gap.segment.nearest_fraction(pointer))
        };
        if topology::gaps(&self.plan).iter().any(in_gap) {
            return None;
        }
        let mut next = self.clone();
        next.take_up(if kind == OpeningKind::Passage { Tool::Passage } else { Tool::Door });
        next.click(pointer, false);
        // Rooms are as they were.
        next.plan = plan;
        Some((next, sides))
    }
}
