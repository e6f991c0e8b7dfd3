//! Plans made by a seed, to explore: rooms along corridors, and houses cut out of one rectangle.

use enfilade::base::random::Random;
use enfilade::geometry::{Point, Vector};
use enfilade::plan::{Builder, Meta, Opening, OpeningKind, Place, Plan, Room};

/// The plans by name: `corridor-1` to `corridor-9` and `house-1` to `house-8`.
pub fn plans() -> Vec<(String, Plan)> {
    let corridors = (1..=9).map(|seed| (format!("corridor-{seed}"), corridor(seed)));
    let houses = (1..=8).map(|seed| (format!("house-{seed}"), house(seed)));
    corridors.chain(houses).collect()
}

const DOOR_M: f64 = 0.9;

/// A rectangle of wall centre-lines.
#[derive(Clone, Copy)]
struct Rectangle {
    low: Point,
    high: Point,
}

impl Rectangle {
    fn new(left: f64, low: f64, right: f64, high: f64) -> Self {
        Self { low: Point::new(left, low), high: Point::new(right, high) }
    }

    fn ring(self) -> [Point; 4] {
        let Self { low, high } = self;
        [low, Point::new(high.x, low.y), high, Point::new(low.x, high.y)]
    }

    /// The common stretch of wall with another rectangle, if long enough for a door.
    fn shared(self, other: Self) -> Option<(Point, Point)> {
        let across = |near: f64, far: f64| (near - far).abs() < 1e-6;
        let (left, right) = (self.low.x.max(other.low.x), self.high.x.min(other.high.x));
        let (low, high) = (self.low.y.max(other.low.y), self.high.y.min(other.high.y));
        let (from, to) = if across(self.high.x, other.low.x) || across(self.low.x, other.high.x) {
            (Point::new(left, low), Point::new(left, high))
        } else if across(self.high.y, other.low.y) || across(self.low.y, other.high.y) {
            (Point::new(left, low), Point::new(right, low))
        } else {
            return None;
        };
        let long = (to.x - from.x) + (to.y - from.y) >= DOOR_M + 0.6;
        (to.x >= from.x && to.y >= from.y && long).then_some((from, to))
    }
}

/// A plan of rectangles with walls of 12 cm around each, and doors between the given pairs.
fn plan_of(name: &str, rooms: &[Rectangle], doors: &[(usize, usize)], random: &mut Random) -> Plan {
    let mut builder = Builder::new(Meta { name: name.to_owned(), ..Meta::default() });
    for rectangle in rooms {
        let ring = rectangle.ring();
        let outer = builder.ring(ring);
        builder.room("", Room { outer, ..Room::default() });
        for i in 0..4 {
            let (from, to) = (builder.corner(ring[i]), builder.corner(ring[(i + 1) % 4]));
            builder.wall(from, to, 0.12);
        }
    }
    for &(one, other) in doors {
        let Some((from, to)) = rooms[one].shared(rooms[other]) else { continue };
        // Clear of the corners, by whole centimetres.
        let along = (to - from).unit().unwrap_or(Vector::new(1.0, 0.0));
        let spare_m = from.distance(to) - DOOR_M - 0.5;
        let at = from + along * (0.25 + (random.unit() * spare_m * 100.0).round() / 100.0);
        let place = Place::Free { from: at, to: at + along * DOOR_M };
        builder.opening("", Opening::new(OpeningKind::Door, place));
    }
    builder.finish().unwrap_or_default()
}

/// Rooms on both sides of a corridor, some of them with a room behind.
fn corridor(seed: u64) -> Plan {
    let mut random = Random::new(seed);
    let tenths = |value: f64| (value * 10.0).round() / 10.0;
    let wide_m = tenths(1.6 + 1.2 * random.unit());
    let long_m = tenths(14.0 + 16.0 * random.unit());
    let mut rooms = vec![Rectangle::new(0.0, 0.0, long_m, wide_m)];
    let mut doors = Vec::new();
    for upper in [true, false] {
        let deep_m = tenths(3.5 + 3.0 * random.unit());
        let mut left = 0.0;
        while left < long_m {
            let mut right = tenths(left + 2.4 + 4.5 * random.unit());
            if long_m - right < 2.4 {
                right = long_m;
            }
            let has_room_behind = random.unit() < 0.25;
            let split_m = if has_room_behind { tenths(deep_m * 0.55) } else { deep_m };
            let (near, far) = if upper { (wide_m, wide_m + split_m) } else { (-split_m, 0.0) };
            doors.push((0, rooms.len()));
            rooms.push(Rectangle::new(left, near, right, far));
            if has_room_behind {
                let (near, far) = if upper { (far, wide_m + deep_m) } else { (-deep_m, near) };
                doors.push((rooms.len() - 1, rooms.len()));
                rooms.push(Rectangle::new(left, near, right, far));
            }
            left = right;
        }
    }
    plan_of(&format!("corridor-{seed}"), &rooms, &doors, &mut random)
}

/// A rectangle cut in two again and again; doors along a spanning tree and some more.
fn house(seed: u64) -> Plan {
    let mut random = Random::new(100 + seed);
    let tenths = |value: f64| (value * 10.0).round() / 10.0;
    let mut rooms = Vec::new();
    let mut open = vec![Rectangle::new(0.0, 0.0, tenths(9.0 + 7.0 * random.unit()), tenths(8.0 + 5.0 * random.unit()))];
    while let Some(whole) = open.pop() {
        let (wide, high) = (whole.high.x - whole.low.x, whole.high.y - whole.low.y);
        let longest = wide.max(high);
        if longest < 4.0 || (wide * high < 22.0 && random.unit() < 0.4) || wide * high < 8.0 {
            rooms.push(whole);
            continue;
        }
        let cut = tenths((0.35 + 0.3 * random.unit()) * longest);
        let Rectangle { low, high } = whole;
        let (one, other) = if wide == longest {
            let at = low.x + cut;
            (Rectangle::new(low.x, low.y, at, high.y), Rectangle::new(at, low.y, high.x, high.y))
        } else {
            let at = low.y + cut;
            (Rectangle::new(low.x, low.y, high.x, at), Rectangle::new(low.x, at, high.x, high.y))
        };
        open.extend([one, other]);
    }
    let mut pairs: Vec<(usize, usize)> = (0..rooms.len())
        .flat_map(|i| (i + 1..rooms.len()).map(move |j| (i, j)))
        .filter(|&(i, j)| rooms[i].shared(rooms[j]).is_some())
        .collect();
    random.shuffle(&mut pairs);
    let mut part: Vec<usize> = (0..rooms.len()).collect();
    let mut doors = Vec::new();
    for (i, j) in pairs {
        let (one, other) = (part[i], part[j]);
        if one != other || random.unit() < 0.15 {
            doors.push((i, j));
            part.iter_mut().filter(|part| **part == other).for_each(|part| *part = one);
        }
    }
    plan_of(&format!("house-{seed}"), &rooms, &doors, &mut random)
}
