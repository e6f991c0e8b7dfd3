use std::collections::BTreeSet;
use std::fmt;

use super::{
    Backdrop, ChangeKind, Corner, CornerId, Difference, Dimension, DimensionHost, DimensionId, DimensionPoint,
    ElementId, Joint, Measurement, Opening, OpeningId, Place, Plan, Rectification, Room, RoomId, Wall, WallId,
};
use crate::geometry::COORDINATE_LIMIT_M;
use crate::geometry::Point;

/// A broken invariant of the model: never a matter of taste (those are checks), always a bug in an edit
/// or a damaged file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Violation {
    pub element: ElementId,
    pub what: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.element, self.what)
    }
}

impl Plan {
    /// All broken invariants, by element; empty for every plan an edit may return:
    ///
    /// - positions are finite, within [`COORDINATE_LIMIT_M`], and on the 0.1 mm grid;
    /// - a wall joins two different corners that exist, its thickness is within 0..=10 m;
    /// - a ring is empty (the outer one of a room without holes) or has at least three corners that
    ///   exist, no two neighbours equal;
    /// - a hosted opening's corners exist and differ in place, its width is above 0 and at most
    ///   1 km, its middle lies on the edge; a free opening has a length;
    /// - a pinned room exists;
    /// - a dimension chain has two points or more, its lengths are finite. What its points are on may be gone.
    pub fn violations(&self) -> Vec<Violation> {
        let mut found = Vec::new();
        self.corners.iter().for_each(|(&id, corner)| check_corner(id, corner, &mut found));
        self.walls.iter().for_each(|(&id, wall)| self.check_wall(id, wall, &mut found));
        self.rooms.iter().for_each(|(&id, room)| self.check_room(id, room, &mut found));
        self.openings.iter().for_each(|(&id, opening)| self.check_opening(id, opening, &mut found));
        self.dimensions.iter().for_each(|(&id, dimension)| check_dimension(id, dimension, &mut found));
        found
    }

    /// As [`Plan::violations`], where `before` is known to have none: only what differs from it is looked
    /// at, and what depends on that.
    pub fn violations_since(&self, before: &Self) -> Vec<Violation> {
        let mut found = Vec::new();
        // Corners that are elsewhere or gone, rooms that are gone.
        let (mut moved, mut gone, mut unroomed) = (BTreeSet::new(), false, BTreeSet::new());
        let difference = Difference::between(before, self);
        for (&element, &kind) in &difference.elements {
            match element {
                ElementId::Corner(id) => {
                    match self.corners.get(&id) {
                        Some(corner) => check_corner(id, corner, &mut found),
                        None => gone = true,
                    }
                    if kind != ChangeKind::Added {
                        moved.insert(id);
                    }
                }
                ElementId::Wall(id) => {
                    if let Some(wall) = self.walls.get(&id) {
                        self.check_wall(id, wall, &mut found);
                    }
                }
                ElementId::Room(id) => match self.rooms.get(&id) {
                    Some(room) => self.check_room(id, room, &mut found),
                    None => drop(unroomed.insert(id)),
                },
                ElementId::Opening(id) => {
                    if let Some(opening) = self.openings.get(&id) {
                        self.check_opening(id, opening, &mut found);
                    }
                }
                ElementId::Dimension(id) => {
                    if let Some(dimension) = self.dimensions.get(&id) {
                        check_dimension(id, dimension, &mut found);
                    }
                }
            }
        }
        let is_same = |element: ElementId| !difference.elements.contains_key(&element);
        if gone {
            let depends = |corner: &CornerId| moved.contains(corner);
            for (&id, wall) in &self.walls {
                if [wall.from, wall.to].iter().any(depends) && is_same(ElementId::Wall(id)) {
                    self.check_wall(id, wall, &mut found);
                }
            }
            for (&id, room) in &self.rooms {
                if room.rings().any(|ring| ring.iter().any(depends)) && is_same(ElementId::Room(id)) {
                    self.check_room(id, room, &mut found);
                }
            }
        }
        if !moved.is_empty() || !unroomed.is_empty() {
            for (&id, opening) in &self.openings {
                let is_on = matches!(opening.place, Place::Hosted { from, to, .. } if moved.contains(&from) || moved.contains(&to));
                let joins = opening.pinned.iter().flatten().filter_map(|joint| joint.room());
                if (is_on || joins.into_iter().any(|room| unroomed.contains(&room))) && is_same(ElementId::Opening(id))
                {
                    self.check_opening(id, opening, &mut found);
                }
            }
        }
        found
    }

    fn check_wall(&self, id: WallId, wall: &Wall, found: &mut Vec<Violation>) {
        let mut say = |what: String| found.push(Violation { element: ElementId::Wall(id), what });
        for corner in [wall.from, wall.to] {
            if !self.corners.contains_key(&corner) {
                say(format!("its corner {corner} does not exist"));
            }
        }
        if wall.from == wall.to {
            say(format!("both its ends are the corner {}", wall.from));
        }
        if !(on_grid(wall.thickness_m) && (0.0..=10.0).contains(&wall.thickness_m)) {
            say(format!("thickness {} m is not within 0..=10 m", wall.thickness_m));
        }
    }

    fn check_room(&self, id: RoomId, room: &Room, found: &mut Vec<Violation>) {
        let mut say = |what: String| found.push(Violation { element: ElementId::Room(id), what });
        if !room.has_boundary() && !room.holes.is_empty() {
            say("has holes but no outer boundary".to_owned());
        }
        for ring in room.rings() {
            if ring.is_empty() && !room.has_boundary() {
                continue;
            }
            if ring.len() < 3 {
                say(format!("a ring has {} corners; at least 3 are needed", ring.len()));
            }
            for (i, corner) in ring.iter().enumerate() {
                if !self.corners.contains_key(corner) {
                    say(format!("its corner {corner} does not exist"));
                }
                if ring.len() > 1 && ring[(i + 1) % ring.len()] == *corner {
                    say(format!("the corner {corner} follows itself"));
                }
            }
        }
    }

    fn check_opening(&self, id: OpeningId, opening: &Opening, found: &mut Vec<Violation>) {
        let mut say = |what: String| found.push(Violation { element: ElementId::Opening(id), what });
        match opening.place {
            Place::Hosted { from, to, at_m, width_m } => {
                let position = |corner: CornerId| self.position(corner);
                match (position(from), position(to)) {
                    (Some(a), Some(b)) if a != b => {
                        // Half a grid step of slack: lengths of oblique edges are not on the grid.
                        let length_m = a.distance(b) + crate::geometry::GRID_M;
                        // An edge across the drawing area is longer than a coordinate may be.
                        if !(crate::geometry::trim_m(at_m) == at_m && (0.0..=length_m).contains(&at_m)) {
                            say(format!("its middle at {at_m} m lies beyond its edge of {:.4} m", a.distance(b)));
                        }
                    }
                    (Some(_), Some(_)) => say("its edge has no length".to_owned()),
                    _ => say(format!("its edge {from} {to} does not exist")),
                }
                if !(on_grid(width_m) && width_m > 0.0 && width_m <= 1000.0) {
                    say(format!("width {width_m} m is not within 0..=1000 m"));
                }
            }
            Place::Free { from, to } => {
                if !(placed(from) && placed(to)) {
                    say(format!("position is not on the grid within ±{COORDINATE_LIMIT_M} m"));
                } else if from == to {
                    say("has no length".to_owned());
                }
            }
        }
        for joint in opening.pinned.iter().flatten() {
            if let Joint::Room(room) = joint
                && !self.rooms.contains_key(room)
            {
                say(format!("is pinned to the room {room}, which does not exist"));
            }
        }
    }
}

fn on_grid(value: f64) -> bool {
    value.is_finite() && value.abs() <= COORDINATE_LIMIT_M && crate::geometry::trim_m(value) == value
}

fn placed(point: Point) -> bool {
    on_grid(point.x) && on_grid(point.y)
}

fn check_dimension(id: DimensionId, dimension: &Dimension, found: &mut Vec<Violation>) {
    let mut say = |what: &str| found.push(Violation { element: ElementId::Dimension(id), what: what.to_owned() });
    if dimension.points.len() < 2 {
        say("measures between fewer than two points");
    }
    let is_placed = |point: &DimensionPoint| {
        let at_m = if let Some(DimensionHost::Wall { at_m, .. }) = point.on { at_m } else { 0.0 };
        placed(point.last) && on_grid(at_m)
    };
    if !on_grid(dimension.offset_m) || !dimension.points.iter().all(is_placed) {
        say("a length or a point of it is not on the grid within the drawing area");
    }
}

fn check_corner(id: CornerId, corner: &Corner, found: &mut Vec<Violation>) {
    let Point { x, y } = corner.position;
    if !placed(corner.position) {
        let what = format!("position ({x}, {y}) is not on the grid within ±{COORDINATE_LIMIT_M} m");
        found.push(Violation { element: ElementId::Corner(id), what });
    }
}

/// A picture so small or so large is no plan: pixels from a nanometre to a kilometre.
pub const METRES_PER_PIXEL: std::ops::RangeInclusive<f64> = 1e-9..=1e3;

/// The sides of a picture made flat, and its pixels: those of any picture that is read.
const RECTIFIED_SIDES_PX: std::ops::RangeInclusive<u32> = 1..=65_535;
const MOST_RECTIFIED_PX: u64 = 1 << 28;

impl Rectification {
    /// As [`Backdrop::fault`].
    fn fault(&self) -> Option<String> {
        let [width_px, height_px] = self.size_px;
        let has_size = self.size_px.iter().all(|side| RECTIFIED_SIDES_PX.contains(side))
            && u64::from(width_px) * u64::from(height_px) <= MOST_RECTIFIED_PX;
        if !has_size {
            return Some(format!("is made flat with {width_px} by {height_px} pixels, which is no size of a picture"));
        }
        let is_near = |point: &Point| point.x.abs() <= 1e7 && point.y.abs() <= 1e7;
        let has_corners = self.corners.iter().chain(&self.rectangle).all(is_near) && self.source_from_shown().is_some();
        (!has_corners).then(|| "is made flat by four corners of no rectangle".to_owned())
    }
}

/// A picture lies no further off than this: what is drawn lies within [`COORDINATE_LIMIT_M`], and a picture
/// may reach there from far away.
const FARTHEST_PICTURE_M: f64 = 1e9;

impl Backdrop {
    /// What no picture under a plan can be, in the words that follow 'the picture under the plan'; `None`
    /// for one that an edit may leave.
    pub fn fault(&self) -> Option<String> {
        let (least, most) = (METRES_PER_PIXEL.start(), METRES_PER_PIXEL.end());
        if !METRES_PER_PIXEL.contains(&self.metres_per_pixel) {
            let is = self.metres_per_pixel;
            return Some(format!(
                "has pixels of {is:?} m; \"metres_per_pixel\" is at least {least:?} and at most {most}"
            ));
        }
        let Point { x, y } = self.origin;
        if !(x.abs() <= FARTHEST_PICTURE_M && y.abs() <= FARTHEST_PICTURE_M) {
            return Some(format!("lies at ({x}, {y}), too far away to be seen"));
        }
        if !self.rotation_rad.is_finite() || !self.opacity.is_finite() {
            return Some("has a turn or an opacity that is no number".to_owned());
        }
        if self.page == 0 {
            return Some("has the page 0; pages are counted from 1".to_owned());
        }
        if let Some(what) = self.rectification.as_ref().and_then(Rectification::fault) {
            return Some(what);
        }
        let is_wrong = |one: &&Measurement| {
            !(one.length_m > 0.0 && one.length_px() > 0.0 && one.length_px().is_finite() && one.length_m.is_finite())
        };
        self.measurements
            .iter()
            .find(is_wrong)
            .map(|one| format!("has a measured length of {} m over {} pixels", one.length_m, one.length_px()))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::base::random::Random;
    use crate::geometry::Point;
    use crate::plan::{Builder, Meta, OpeningKind};

    /// Rooms in a row that share corners, a wall and an opening to each, one pinned to its room.
    fn row() -> Plan {
        let mut builder = Builder::new(Meta::default());
        for i in 0..6 {
            let x = f64::from(i) * 3.0;
            let outer =
                builder.ring([(x, 0.0), (x + 3.0, 0.0), (x + 3.0, 4.0), (x, 4.0)].map(|(x, y)| Point::new(x, y)));
            let (a, b) = (outer[0], outer[1]);
            let room = builder.room(&format!("room {i}"), Room { outer, ..Room::default() });
            builder.wall(a, b, 0.1);
            let place = Place::Hosted { from: a, to: b, at_m: 1.5, width_m: 0.9 };
            let mut opening = Opening::new(OpeningKind::Door, place);
            opening.pinned = Some([Joint::Room(room), Joint::Outside]);
            builder.opening(&format!("door {i}"), opening);
        }
        builder.finish().unwrap()
    }

    #[test]
    fn what_differs_is_checked_as_if_all_were() {
        let sound = row();
        let mut random = Random::new(9);
        let mut unsound = 0;
        for _ in 0..2000 {
            let mut plan = sound.clone();
            for _ in 0..=random.below(3) {
                let corner = *plan.corners.keys().nth(random.below(plan.corners.len())).unwrap();
                let room = plan.rooms.keys().nth(random.below(plan.rooms.len().max(1))).copied();
                let opening = plan.openings.keys().nth(random.below(plan.openings.len().max(1))).copied();
                match random.below(6) {
                    0 => drop(plan.corners.remove(&corner)),
                    1 => {
                        let to = *plan.corners.keys().nth(random.below(plan.corners.len())).unwrap();
                        let position = plan.corners[&to].position;
                        plan.corners.insert(corner, Corner { position, extra: None });
                    }
                    2 => drop(room.and_then(|room| plan.rooms.remove(&room))),
                    3 => drop(opening.and_then(|opening| plan.openings.remove(&opening))),
                    4 => {
                        let Some(opening) = opening else { continue };
                        let mut changed = plan.openings[&opening].as_ref().clone();
                        changed.place = Place::Free { from: Point::new(1.0, 1.0), to: Point::new(f64::from(1u8), 1.0) };
                        plan.openings.insert(opening, Arc::new(changed));
                    }
                    _ => {
                        let Some(room) = room else { continue };
                        let mut changed = plan.rooms[&room].as_ref().clone();
                        changed.outer = changed.outer.iter().copied().take(2).collect();
                        plan.rooms.insert(room, Arc::new(changed));
                    }
                }
            }
            let key = |one: &Violation| (one.element, one.what.clone());
            let mut all: Vec<_> = plan.violations().iter().map(key).collect();
            let mut since: Vec<_> = plan.violations_since(&sound).iter().map(key).collect();
            all.sort();
            since.sort();
            assert_eq!(all, since);
            unsound += usize::from(!all.is_empty());
        }
        assert!((1000..2000).contains(&unsound), "{unsound}");
        assert_eq!(sound.violations_since(&Plan::default()), []);
    }
}
