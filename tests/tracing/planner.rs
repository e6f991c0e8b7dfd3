//! Chooses the gestures: for rows of rectangular rooms a rectangle and a split each, for the others
//! whatever takes the fewest clicks. It knows as much of the drawing as a person looking at it, and
//! checks what it drew as a person does: by the result.

use enfilade::geometry::{Bounds, Point, Segment, Vector, polygon};
use enfilade::plan::{OpeningKind, RoomId};

use super::person::{Person, Tool, View};
use super::truth::{CELL_M, Grid, Room, Truth};

/// A room whose area is off by more is drawn otherwise: the goal is 5 %.
const MOST_OFF: f64 = 0.042;

/// More rooms are not drawn before the others.
const MOST_FIRST: usize = 14;

/// By which share of its area a room may be off for the sake of fewer corners; tried in this order.
const MORE_CORNERS: [f64; 3] = [0.03, 0.015, 0.0];
const FEW_CORNERS: [f64; 4] = [0.04, 0.03, 0.015, 0.0];

/// Of a traced room at least this share lies where the room is in truth.
const LEAST_RIGHT: f64 = 0.85;

/// What is too small is looked at with so much around it, in metres.
const AROUND_M: f64 = 4.0;

/// Neighbours in a row are at most a wall apart, and about as deep, in metres.
const WALL_M: f64 = 0.5;
const STEP_M: f64 = 0.45;

/// A box: lower x and y, upper x and y.
type Box4 = [f64; 4];

fn box_of(bounds: Bounds) -> Box4 {
    [bounds.min.x, bounds.min.y, bounds.max.x, bounds.max.y]
}

fn area_of(rect: Box4) -> f64 {
    (rect[2] - rect[0]).max(0.0) * (rect[3] - rect[1]).max(0.0)
}

/// Rooms that lie side by side in one rectangle.
#[derive(Clone, Debug)]
enum Row {
    One(usize),
    /// Cut where `axis` (0: x, 1: y) is `at`; the lower part first.
    Cut {
        axis: usize,
        at: f64,
        parts: Box<[Row; 2]>,
    },
}

impl Row {
    /// Each room with its share of a box.
    fn shares(&self, rect: Box4, found: &mut Vec<(usize, Box4)>) {
        match self {
            Self::One(room) => found.push((*room, rect)),
            Self::Cut { axis, at, parts } => {
                let (mut low, mut high) = (rect, rect);
                low[axis + 2] = *at;
                high[*axis] = *at;
                parts[0].shares(low, found);
                parts[1].shares(high, found);
            }
        }
    }

    fn rooms(&self) -> Vec<usize> {
        let mut found = Vec::new();
        self.shares([0.0; 4], &mut found);
        found.into_iter().map(|(room, _)| room).collect()
    }
}

#[derive(Clone, Debug)]
struct Group {
    row: Row,
    rect: Box4,
    off: f64,
}

/// What came of an order of work.
struct Way {
    person: Person,
    /// Doors that found no place.
    doors: Vec<usize>,
    traced: Vec<Option<RoomId>>,
}

impl Way {
    /// What is left, and what it took.
    fn rank(&self) -> (usize, usize) {
        let left = self.traced.iter().filter(|room| room.is_none()).count();
        (left + self.doors.len(), self.person.count.all())
    }
}

pub struct Planner<'a> {
    truth: &'a Truth,
    grid: &'a Grid,
    /// The traced room of each room of the truth.
    pub traced: Vec<Option<RoomId>>,
    slacks: &'static [f64],
    pub talk: bool,
}

impl<'a> Planner<'a> {
    pub fn new(truth: &'a Truth, grid: &'a Grid) -> Self {
        Self { truth, grid, traced: vec![None; truth.rooms.len()], slacks: &MORE_CORNERS, talk: false }
    }

    fn say(&self, what: impl FnOnce() -> String) {
        if self.talk {
            eprintln!("{}", what());
        }
    }

    /// Traces the office; `closer` fills the screen with a part of it.
    pub fn trace(&mut self, person: Person, mut closer: impl FnMut(Bounds) -> View) -> Person {
        let Way { mut person, mut doors, traced } = self.in_one_view(&person);
        self.traced = traced;
        // A person goes nearer for what is too small to be pointed at.
        let left = |planner: &Self, doors: &[usize]| {
            let rooms = planner.left_rooms().map(|room| planner.truth.rooms[room].bounds);
            rooms.chain(doors.iter().map(|&door| Bounds::of([planner.truth.doors[door].at]))).collect::<Vec<_>>()
        };
        let mut seen: Vec<Bounds> = Vec::new();
        loop {
            let small = left(self, &doors);
            let is_new = |small: &&Bounds| !seen.iter().any(|seen| seen.contains(small.center()));
            let Some(&next) = small.iter().find(is_new) else { return person };
            let area = next.inflated(AROUND_M);
            seen.push(area);
            self.say(|| format!("  nearer: {area:?}"));
            let mut near = person.clone();
            near.look(closer(area));
            near = self.others(near.drawing_over(false));
            (person, doors) = self.doors(near, &doors);
        }
    }

    /// Of several orders of work in one view, that which leaves least and costs least.
    fn in_one_view(&mut self, person: &Person) -> Way {
        let mut ways: Vec<Way> = Vec::new();
        for slacks in [&MORE_CORNERS[..], &FEW_CORNERS[..]] {
            self.slacks = slacks;
            // What others left too little of is drawn before them the next time.
            let mut first: Vec<usize> = Vec::new();
            loop {
                self.traced.fill(None);
                let drawn = self.by_corners_first(person.clone(), &first);
                let drawn = self.rows(drawn);
                let drawn = self.others(drawn);
                let left: Vec<usize> = self.left_rooms().collect();
                // What is left is drawn over others; what that left over, too.
                let drawn = self.over_others(drawn);
                let drawn = self.others(drawn);
                let (person, doors) = self.doors(drawn, &(0..self.truth.doors.len()).collect::<Vec<_>>());
                let way = Way { person, doors, traced: self.traced.clone() };
                self.say(|| format!("  {:?}, first {first:?}", way.rank()));
                ways.push(way);
                if left.iter().all(|room| first.contains(room)) || first.len() > MOST_FIRST {
                    break;
                }
                first.extend(left);
                first.sort_unstable();
                first.dedup();
            }
        }
        ways.into_iter().min_by_key(Way::rank).expect("each number of corners is a way")
    }

    fn left_rooms(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.traced.len()).filter(|&room| self.traced[room].is_none())
    }

    /// Rooms drawn by their corners before any other.
    fn by_corners_first(&mut self, mut person: Person, rooms: &[usize]) -> Person {
        let mut is_freed = false;
        for &room in rooms {
            let covered = self.covered(&person);
            if let Some((next, id)) = self.by_corners(&person, room, &covered, is_freed) {
                is_freed |= next.lines.iter().any(|line| line == "key F8");
                person = next;
                self.traced[room] = Some(id);
            }
        }
        person
    }

    // Rows of rectangles.

    /// By how much the areas of a row in a box are off, at worst; infinite where a room would be elsewhere.
    fn off(&self, row: &Row, rect: Box4) -> f64 {
        let mut shares = Vec::new();
        row.shares(rect, &mut shares);
        let off = shares.into_iter().map(|(room, share)| {
            let room = &self.truth.rooms[room];
            let own = box_of(room.bounds);
            let is_there = (0..4).all(|side| (share[side] - own[side]).abs() <= WALL_M);
            if is_there { (area_of(share) / room.area_m2 - 1.0).abs() } else { f64::INFINITY }
        });
        off.fold(0.0, f64::max)
    }

    fn groups(&self) -> Vec<Group> {
        let mut groups: Vec<Group> = (0..self.truth.rooms.len())
            .map(|room| {
                let row = Row::One(room);
                let rect = self.without_others(&row, box_of(self.truth.rooms[room].bounds));
                Group { off: self.off(&row, rect), row, rect }
            })
            .filter(|group| group.off <= MOST_OFF && group.row.rooms().iter().all(|&room| self.traced[room].is_none()))
            .collect();
        loop {
            let mut best: Option<(usize, usize, Group)> = None;
            for i in 0..groups.len() {
                for j in (0..groups.len()).filter(|&j| j != i) {
                    for axis in 0..2 {
                        let Some(joined) = self.joined(&groups[i], &groups[j], axis) else { continue };
                        if best.as_ref().is_none_or(|(_, _, best)| joined.off < best.off) {
                            best = Some((i, j, joined));
                        }
                    }
                }
            }
            let Some((i, j, joined)) = best else { break };
            groups.remove(i.max(j));
            groups.remove(i.min(j));
            groups.push(joined);
        }
        groups
    }

    /// Two groups as one, the first before the second along an axis.
    fn joined(&self, low: &Group, high: &Group, axis: usize) -> Option<Group> {
        let (p, q) = (low.rect, high.rect);
        let gap = q[axis] - p[axis + 2];
        let across = 1 - axis;
        let is_step = |side: usize| (p[side] - q[side]).abs() > STEP_M;
        if !(-WALL_M..=WALL_M).contains(&gap) || is_step(across) || is_step(across + 2) {
            return None;
        }
        let (wide_p, wide_q) = (p[axis + 2] - p[axis], q[axis + 2] - q[axis]);
        let mean = |side: usize| (p[side] * wide_p + q[side] * wide_q) / (wide_p + wide_q);
        let mut best: Option<Group> = None;
        // The wall between them, or one of its faces where the areas ask for it; the outer sides as
        // deep as the one, the other, or between.
        for part in [0.5, 0.25, 0.75, 0.0, 1.0] {
            for depth in 0..3 {
                let side = |side: usize| [mean(side), p[side], q[side]][depth];
                let mut rect = [0.0; 4];
                (rect[axis], rect[axis + 2]) = (p[axis], q[axis + 2]);
                (rect[across], rect[across + 2]) = (side(across), side(across + 2));
                let at = p[axis + 2] + gap * part;
                let row = Row::Cut { axis, at, parts: Box::new([low.row.clone(), high.row.clone()]) };
                let off = self.off(&row, rect);
                if off <= MOST_OFF * 0.9 && best.as_ref().is_none_or(|best| off < best.off) {
                    best = Some(Group { row, rect, off });
                }
            }
        }
        best.map(|best| {
            let rect = self.without_others(&best.row, best.rect);
            Group { off: self.off(&best.row, rect), rect, ..best }
        })
    }

    /// What a box takes of rooms that are not in its row, in m².
    fn taken(&self, row: &Row, rect: Box4) -> f64 {
        let own = row.rooms();
        let [x0, y0, x1, y1] = rect;
        let ring = vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)];
        let is_others = |cell: &usize| self.grid.room[*cell].is_some_and(|room| !own.contains(&usize::from(room)));
        self.grid.cells(&[&ring]).into_iter().filter(is_others).count() as f64 * CELL_M * CELL_M
    }

    /// A box that takes less of the rooms beside its row: drawn on the inner side of what is not quite
    /// straight, as far as its own rooms let it.
    fn without_others(&self, row: &Row, mut rect: Box4) -> Box4 {
        let mut taken = self.taken(row, rect);
        for _ in 0..12 {
            let mut best: Option<(f64, Box4)> = None;
            for side in 0..4 {
                let mut next = rect;
                next[side] += if side < 2 { 0.05 } else { -0.05 };
                if self.off(row, next) > MOST_OFF * 0.7 {
                    continue;
                }
                let less = taken - self.taken(row, next);
                if less > 0.02 && best.as_ref().is_none_or(|(most, _)| less > *most) {
                    best = Some((less, next));
                }
            }
            let Some((less, next)) = best else { break };
            taken -= less;
            rect = next;
        }
        rect
    }

    /// Rectangles first, all splits afterwards: each tool is taken up once.
    fn rows(&mut self, mut person: Person) -> Person {
        let mut groups = self.groups();
        // Large ones first: smaller ones snap to them.
        groups.sort_by(|p, q| area_of(q.rect).total_cmp(&area_of(p.rect)));
        groups.reverse();
        let mut drawn: Vec<(Row, Box4, RoomId)> = Vec::new();
        while let Some(group) = groups.pop() {
            match self.draw_row(&person, &group) {
                Some((next, rect, id)) => {
                    person = next;
                    drawn.push((group.row, rect, id));
                }
                None => {
                    self.say(|| format!("  row {:?} in parts", group.row.rooms()));
                    let Row::Cut { axis, at, parts } = group.row else { continue };
                    let [low, high] = *parts;
                    let (mut p, mut q) = (group.rect, group.rect);
                    (p[axis + 2], q[axis]) = (at, at);
                    for (row, rect) in [(low, p), (high, q)] {
                        let rect = if let Row::One(room) = row { box_of(self.truth.rooms[room].bounds) } else { rect };
                        groups.push(Group { off: self.off(&row, rect), row, rect });
                    }
                }
            }
        }
        for (row, rect, id) in drawn {
            match self.split_row(&person, &row, rect, id) {
                Some((next, found)) => {
                    person = next;
                    for (room, id) in found {
                        self.traced[room] = Some(id);
                    }
                }
                None => self.say(|| format!("  cannot split {:?}", row.rooms())),
            }
        }
        person
    }

    /// Draws the rectangle of a row, if it can be split as it should then.
    fn draw_row(&self, person: &Person, group: &Group) -> Option<(Person, Box4, RoomId)> {
        let [x0, y0, x1, y1] = group.rect;
        let corners = [Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)];
        for alt in [[false, false], [false, true], [true, false], [true, true]] {
            let mut drawn: Vec<(f64, Person, Box4, RoomId)> = Vec::new();
            for first in 0..4 {
                let Some((next, id)) = person.rectangle(corners[first], corners[(first + 2) % 4], alt) else {
                    continue;
                };
                let Some(shape) = next.shapes.get(id) else { continue };
                let rect = box_of(shape.bounds);
                let off = self.off(&group.row, rect).max(self.off_in(&next, &group.row, rect, id));
                if off <= MOST_OFF {
                    // Of what is right, that which leaves others most.
                    drawn.push((self.taken(&group.row, rect), next, rect, id));
                }
            }
            drawn.sort_by(|p, q| p.0.total_cmp(&q.0));
            let is_split = |(_, next, rect, id): &(f64, Person, Box4, RoomId)| {
                self.split_row(next, &group.row, *rect, *id).is_some()
            };
            if let Some((_, next, rect, id)) = drawn.into_iter().find(is_split) {
                return Some((next, rect, id));
            }
        }
        None
    }

    /// By how much the areas of a row in a drawn room are off, at worst.
    fn off_in(&self, person: &Person, row: &Row, rect: Box4, id: RoomId) -> f64 {
        let mut shares = Vec::new();
        row.shares(rect, &mut shares);
        let outer = person.shapes.get(id).map(|shape| shape.outer.clone()).unwrap_or_default();
        let off = shares.into_iter().map(|(room, share)| {
            (polygon::signed_area(&clipped(&outer, share)).abs() / self.truth.rooms[room].area_m2 - 1.0).abs()
        });
        off.fold(0.0, f64::max)
    }

    /// Splits a drawn room as its row says.
    fn split_row(&self, person: &Person, row: &Row, rect: Box4, id: RoomId) -> Option<(Person, Vec<(usize, RoomId)>)> {
        let Row::Cut { axis, at, parts } = row else {
            let Row::One(room) = row else { return None };
            let is_right = self.is_right(person, id, &self.truth.rooms[*room], *room);
            return is_right.then(|| (person.clone(), vec![(*room, id)]));
        };
        let (axis, across) = (*axis, 1 - *axis);
        let depth = rect[across + 2] - rect[across];
        // Just inside: on the boundary itself the room beyond may be meant.
        let in_m = person.metres(4.0).min(depth / 4.0);
        let ends = [
            rect[across] + in_m,
            rect[across + 2] - in_m,
            rect[across] + 0.15 * depth,
            rect[across + 2] - 0.15 * depth,
        ];
        for alt in [false, true] {
            #[allow(clippy::type_complexity, reason = "used once")]
            let mut best: Option<(f64, Person, [(Box4, RoomId); 2])> = None;
            for end in ends {
                for aside in [0.0, 0.1, -0.1, 0.2, -0.2] {
                    let place = [*at + aside, end];
                    let Some((next, made)) = person.split(Point::new(place[axis], place[across]), alt) else {
                        continue;
                    };
                    if !made.contains(&id) {
                        continue;
                    }
                    let mut sides = made.map(|id| (next.shapes.get(id).map(|shape| box_of(shape.bounds)), id));
                    sides.sort_by(|p, q| {
                        p.0.map_or(0.0, |rect| rect[axis]).total_cmp(&q.0.map_or(0.0, |rect| rect[axis]))
                    });
                    let [(Some(low), low_id), (Some(high), high_id)] = sides else { continue };
                    let off = self
                        .off_in(&next, &parts[0], low, low_id)
                        .max(self.off_in(&next, &parts[1], high, high_id))
                        .max(self.off(&parts[0], low))
                        .max(self.off(&parts[1], high));
                    if off <= MOST_OFF && best.as_ref().is_none_or(|best| off < best.0) {
                        best = Some((off, next, [(low, low_id), (high, high_id)]));
                    }
                }
            }
            if let Some((_, next, [(low, low_id), (high, high_id)])) = best
                && let Some((next, mut found)) = self.split_row(&next, &parts[0], low, low_id)
                && let Some((next, more)) = self.split_row(&next, &parts[1], high, high_id)
            {
                found.extend(more);
                return Some((next, found));
            }
        }
        None
    }

    /// Whether a drawn room is a room of the truth, as nearly as asked for.
    fn is_right(&self, person: &Person, id: RoomId, room: &Room, index: usize) -> bool {
        let Some(shape) = person.shapes.get(id) else { return false };
        let off = (shape.area_m2() / room.area_m2 - 1.0).abs();
        let cells = self.grid.cells(&shape.rings().collect::<Vec<_>>());
        // Rooms of the truth overlap here and there: what is right is what lies in its own boundary.
        let own: std::collections::BTreeSet<usize> = self.grid.cells(&[&room.outer]).into_iter().collect();
        let is_own = |cell: &usize| own.contains(cell) || self.grid.room[*cell].map(usize::from) == Some(index);
        let here = cells.iter().filter(|cell| is_own(cell)).count();
        off <= MOST_OFF && here as f64 >= LEAST_RIGHT * cells.len() as f64
    }

    // All other rooms.

    fn others(&mut self, mut person: Person) -> Person {
        let mut is_freed = person.lines.iter().any(|line| line == "key F8");
        loop {
            let left: Vec<usize> = self.left_rooms().collect();
            if left.is_empty() {
                return person;
            }
            let covered = self.covered(&person);
            let mut found = left.iter().find_map(|&room| {
                let (next, id) = self.by_one_click(&person, room, &covered)?;
                Some((room, next, id))
            });
            found = found.or_else(|| {
                left.iter().find_map(|&room| {
                    let (next, id) = self.by_rectangle(&person, room)?;
                    Some((room, next, id))
                })
            });
            // The simplest first: what has many corners may be enclosed by then.
            let mut by_corners = left.clone();
            by_corners.sort_by_key(|&room| self.truth.rooms[room].outer.len());
            found = found.or_else(|| {
                by_corners.iter().find_map(|&room| {
                    let (next, id) = self.by_corners(&person, room, &covered, is_freed)?;
                    Some((room, next, id))
                })
            });
            let Some((room, next, id)) = found else {
                self.say(|| format!("  left over: {left:?}"));
                return person;
            };
            self.say(|| format!("  room {room} for {}", next.count.all() - person.count.all()));
            is_freed |= next.lines.iter().any(|line| line == "key F8");
            person = next;
            self.traced[room] = Some(id);
        }
    }

    /// What lies within another room and finds no place beside it is drawn over it.
    fn over_others(&mut self, mut person: Person) -> Person {
        for room in self.left_rooms().collect::<Vec<_>>() {
            if let Some((next, id)) = self.by_rectangle(&person.drawing_over(true), room) {
                person = next;
                self.traced[room] = Some(id);
            }
        }
        person
    }

    /// What is drawn, and gaps along it that belong to no room.
    fn covered(&self, person: &Person) -> Vec<bool> {
        let mut covered = vec![false; self.grid.room.len()];
        let mut drawn = Vec::new();
        for shape in person.shapes.all() {
            drawn.extend(self.grid.cells(&shape.rings().collect::<Vec<_>>()));
        }
        for &cell in &drawn {
            covered[cell] = true;
        }
        for cell in drawn {
            for near in self.grid.around(cell, 2) {
                if self.grid.room[near].is_none() {
                    covered[near] = true;
                }
            }
        }
        covered
    }

    fn right(&self, index: usize, drawn: Option<(Person, RoomId)>) -> Option<(Person, RoomId)> {
        drawn.filter(|(next, id)| self.is_right(next, *id, &self.truth.rooms[index], index))
    }

    /// A room that others enclose.
    fn by_one_click(&self, person: &Person, index: usize, covered: &[bool]) -> Option<(Person, RoomId)> {
        let inside = self.free_place(&self.truth.rooms[index], covered)?;
        self.right(index, person.fill(inside))
    }

    /// A room that is what a rectangle leaves free.
    fn by_rectangle(&self, person: &Person, index: usize) -> Option<(Person, RoomId)> {
        for alt in [[false, false], [false, true], [true, false], [true, true]] {
            for by_m in [0.0, 0.15, 0.3, -0.1] {
                let [x0, y0, x1, y1] = box_of(self.truth.rooms[index].bounds.inflated(by_m));
                let corners = [Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)];
                for first in 0..4 {
                    let drawn = person.rectangle(corners[first], corners[(first + 2) % 4], alt);
                    if let Some(found) = self.right(index, drawn) {
                        return Some(found);
                    }
                }
            }
        }
        None
    }

    /// A room by as few corners as will do.
    fn by_corners(&self, person: &Person, index: usize, covered: &[bool], is_freed: bool) -> Option<(Person, RoomId)> {
        let room = &self.truth.rooms[index];
        let mut person = person.clone();
        if !is_freed {
            // Lines may be slanted where they run through rooms.
            person.take_up(Tool::Room);
            person.key("F8");
        }
        for &slack in self.slacks {
            let corners = apart(&self.few_corners(room, covered, slack));
            for alt in [false, true] {
                let drawn = person.room(&corners, alt);
                self.say(|| {
                    let off = drawn.as_ref().and_then(|(next, id)| next.shapes.get(*id)).map(|shape| shape.area_m2());
                    format!("    room {index}, {} corners: {off:?} of {:.2} m2", corners.len(), room.area_m2)
                });
                if let Some(found) = self.right(index, drawn) {
                    return Some(found);
                }
            }
        }
        let drawn = person.room(&apart(&room.outer), true);
        self.say(|| {
            let off = drawn.as_ref().and_then(|(next, id)| next.shapes.get(*id)).map(|shape| shape.area_m2());
            let why = enfilade::edit::draw_room(&person.plan, &room.outer, None).err();
            format!("    room {index} whole: {off:?} of {:.2} m2 {why:?}", room.area_m2)
        });
        self.right(index, drawn)
    }

    /// A place in a room where nothing is drawn.
    fn free_place(&self, room: &Room, covered: &[bool]) -> Option<Point> {
        // The middle of the widest free stretch.
        let bounds = room.bounds;
        let mut best: Option<(f64, Point)> = None;
        for row in 1..8 {
            let y = bounds.min.y + bounds.height() * f64::from(row) / 8.0;
            let mut crossings: Vec<f64> = polygon::edges(&room.outer)
                .filter(|edge| (edge.a.y <= y) != (edge.b.y <= y))
                .map(|edge| edge.a.x + (y - edge.a.y) / (edge.b.y - edge.a.y) * (edge.b.x - edge.a.x))
                .collect();
            crossings.sort_by(f64::total_cmp);
            for pair in crossings.chunks_exact(2) {
                let middle = Point::new((pair[0] + pair[1]) / 2.0, y);
                let d = CELL_M / 2.0;
                let cell = self.grid.cells(&[&vec![
                    middle + Vector::new(-d, -d),
                    middle + Vector::new(d, -d),
                    middle + Vector::new(d, d),
                    middle + Vector::new(-d, d),
                ]]);
                let is_free = cell.iter().all(|&cell| !covered[cell]);
                if is_free && best.is_none_or(|best| pair[1] - pair[0] > best.0) {
                    best = Some((pair[1] - pair[0], middle));
                }
            }
        }
        best.map(|(_, place)| place)
    }

    /// The fewest corners that enclose what is free of a room and else only what is drawn.
    fn few_corners(&self, room: &Room, covered: &[bool], slack: f64) -> Vec<Point> {
        let cells = self.grid.cells(&[&room.outer]);
        let mut is_own = vec![false; covered.len()];
        for &cell in cells.iter().filter(|&&cell| !covered[cell]) {
            is_own[cell] = true;
        }
        let free = cells.iter().filter(|&&cell| is_own[cell]).count();
        let off = |corners: &Vec<Point>| {
            let (mut hit, mut beside) = (0_usize, 0_usize);
            for cell in self.grid.cells(&[corners]) {
                if is_own[cell] {
                    hit += 1;
                } else if !covered[cell] {
                    beside += 1;
                }
            }
            (free - hit + beside) as f64 / cells.len().max(1) as f64
        };
        let mut corners = without_spikes(&room.outer);
        let limit = slack + off(&corners);
        loop {
            let n = corners.len();
            if n <= 3 {
                return corners;
            }
            let mut best: Option<(f64, Vec<Point>)> = None;
            let mut offer = |corners: Vec<Point>| {
                if corners.len() >= 3 && is_simple(&corners) {
                    let off = off(&corners);
                    if off <= limit && best.as_ref().is_none_or(|best| off < best.0) {
                        best = Some((off, corners));
                    }
                }
            };
            for k in 0..n {
                let without = |gone: &[usize]| -> Vec<Point> {
                    (0..n).filter(|i| !gone.contains(i)).map(|i| corners[i]).collect()
                };
                offer(without(&[k]));
                offer(without(&[k, (k + 1) % n]));
                // The lines before and after an edge meet.
                let at = |i: usize| corners[(k + i) % n];
                if n >= 4
                    && let Some(meeting) = meeting(Segment::new(at(0), at(1)), Segment::new(at(3), at(2)))
                {
                    let mut next = corners.clone();
                    next[(k + 1) % n] = meeting;
                    next.remove((k + 2) % n);
                    offer(next);
                }
            }
            match best {
                Some((_, next)) => corners = next,
                None => return corners,
            }
        }
    }

    // Doors.

    /// Places doors, and gives those that found no place.
    fn doors(&self, mut person: Person, doors: &[usize]) -> (Person, Vec<usize>) {
        let mut left = Vec::new();
        for kind in [OpeningKind::Door, OpeningKind::Passage] {
            for &index in doors {
                let door = &self.truth.doors[index];
                if (door.kind == OpeningKind::Passage) != (kind == OpeningKind::Passage) {
                    continue;
                }
                let mut wanted = door.sides.map(|side| side.and_then(|room| self.traced[room]));
                wanted.sort_unstable();
                let mut places: Vec<Point> = Vec::new();
                for reach in 0..14 {
                    let step = f64::from(reach) * 0.1;
                    let turns = if reach == 0 { 1 } else { 16 };
                    places.extend((0..turns).map(|turn| {
                        let angle = f64::from(turn) / f64::from(turns) * std::f64::consts::TAU;
                        door.at + Vector::new(step, 0.0).rotated(angle)
                    }));
                }
                let placed = places.into_iter().find_map(|place| {
                    let (next, mut sides) = person.door(place, kind)?;
                    sides.sort_unstable();
                    (sides == wanted).then_some(next)
                });
                match placed {
                    Some(next) => person = next,
                    None => {
                        self.say(|| format!("  no door between {:?} at {:?}", door.sides, door.at));
                        left.push(index);
                    }
                }
            }
        }
        (person, left)
    }
}

/// Where two lines meet, if not far away.
fn meeting(p: Segment, q: Segment) -> Option<Point> {
    let (along, across) = (p.vector(), q.vector());
    let denominator = along.cross(across);
    if denominator.abs() < 0.05 * along.length() * across.length() {
        return None;
    }
    let t = (q.a - p.a).cross(across) / denominator;
    let point = p.a + along * t;
    (point.distance(p.b) < 30.0).then_some(point)
}

/// A boundary that touches itself, as some of the truth do, drawn a pencil's width apart there.
fn apart(corners: &[Point]) -> Vec<Point> {
    const TOUCH_M: f64 = 0.03;
    const APART_M: f64 = 0.08;
    let corners = without_spikes(corners);
    let n = corners.len();
    let edges: Vec<Segment> = polygon::edges(&corners).collect();
    (0..n)
        .map(|i| {
            let touches = (0..n).any(|j| j != i && (j + 1) % n != i && edges[j].distance(corners[i]) < TOUCH_M);
            let (before, after) = (corners[(i + n - 1) % n], corners[(i + 1) % n]);
            let way = (before.midpoint(after) - corners[i]).unit().filter(|_| touches);
            way.map_or(corners[i], |way| corners[i] + way * APART_M)
        })
        .collect()
}

/// A boundary without places where it goes to a point and back the same way.
fn without_spikes(corners: &[Point]) -> Vec<Point> {
    let mut kept = corners.to_vec();
    loop {
        let n = kept.len();
        let spike = (0..n).find(|&i| n > 3 && kept[(i + n - 1) % n].distance(kept[(i + 1) % n]) < 0.03);
        let Some(tip) = spike else { return kept };
        let again = (tip + 1) % n;
        kept.remove(tip.max(again));
        kept.remove(tip.min(again));
    }
}

fn is_simple(corners: &[Point]) -> bool {
    let edges: Vec<Segment> = polygon::edges(corners).collect();
    let n = edges.len();
    for i in 0..n {
        if edges[i].length() < 0.05 {
            return false;
        }
        for j in i + 2..n {
            if i == 0 && j == n - 1 {
                continue;
            }
            let side = |edge: Segment, point: Point| polygon::orientation(edge.a, edge.b, point);
            let crosses = side(edges[i], edges[j].a) * side(edges[i], edges[j].b) <= 0.0
                && side(edges[j], edges[i].a) * side(edges[j], edges[i].b) <= 0.0;
            if crosses {
                return false;
            }
        }
    }
    true
}

/// The part of a polygon in a box (Sutherland and Hodgman 1974).
fn clipped(outer: &[Point], rect: Box4) -> Vec<Point> {
    let mut ring = outer.to_vec();
    for (side, limit) in rect.into_iter().enumerate() {
        let inside = |point: Point| {
            let value = if side % 2 == 0 { point.x } else { point.y };
            if side < 2 { value - limit } else { limit - value }
        };
        let mut next = Vec::new();
        for edge in polygon::edges(&ring) {
            let (p, q) = (inside(edge.a), inside(edge.b));
            if p >= 0.0 {
                next.push(edge.a);
            }
            if (p >= 0.0) != (q >= 0.0) {
                next.push(edge.a.lerp(edge.b, p / (p - q)));
            }
        }
        ring = next;
    }
    ring
}
