use std::rc::Rc;
use std::sync::Arc;

use enfilade::geometry::Point;
use enfilade::labels::Typology;
use enfilade::plan::{Builder, CornerId, Joint, Meta, Opening, OpeningId, OpeningKind, Place, Plan, Room, RoomId};

/// A plan in the making, in a few words; every point goes through `placed`.
pub struct Draft {
    pub builder: Builder,
    placed: Rc<dyn Fn(Point) -> Point>,
    pub bedroom: RoomId,
    pub living: RoomId,
    pub corridor: RoomId,
}

pub type XY = (f64, f64);

/// A rectangle's corners from its lower left and its upper right one.
pub fn rectangle((left, bottom): XY, (right, top): XY) -> [XY; 4] {
    [(left, bottom), (right, bottom), (right, top), (left, top)]
}

impl Draft {
    /// A sound flat: bedroom and living room below a corridor, bathroom and kitchen above it, each
    /// with a door to the corridor, which has one to the outside.
    pub fn flat() -> Self {
        Self::flat_placed(|point| point)
    }

    pub fn flat_placed(placed: impl Fn(Point) -> Point + 'static) -> Self {
        let mut draft = Self::empty(placed);
        draft.bedroom = draft.room("bedroom", &rectangle((0.0, 0.0), (4.0, 4.0)));
        draft.living = draft.room("living room", &rectangle((4.0, 0.0), (9.0, 4.0)));
        draft.corridor = draft.room("corridor", &rectangle((0.0, 4.0), (9.0, 5.5)));
        draft.room("bathroom", &rectangle((0.0, 5.5), (2.5, 8.0)));
        draft.room("kitchen", &rectangle((2.5, 5.5), (6.0, 8.0)));
        for (from, to) in [
            ((1.6, 4.0), (2.4, 4.0)),
            ((5.0, 4.0), (5.85, 4.0)),
            ((0.6, 5.5), (1.35, 5.5)),
            ((4.0, 5.5), (4.85, 5.5)),
            ((9.0, 4.2), (9.0, 5.2)),
        ] {
            draft.door(from, to);
        }
        draft
    }

    /// Nothing drawn, a house.
    pub fn empty(placed: impl Fn(Point) -> Point + 'static) -> Self {
        let meta = Meta { name: "Flat".into(), typology: Typology::new("house"), ..Meta::default() };
        let nowhere = RoomId::derive(&[], |_| false);
        let builder = Builder::new(meta);
        Self { builder, placed: Rc::new(placed), bedroom: nowhere, living: nowhere, corridor: nowhere }
    }

    /// Nothing drawn, with the same `placed`.
    pub fn cleared(self) -> Self {
        let placed = Rc::clone(&self.placed);
        Self::empty(move |point| placed(point))
    }

    pub fn plan(&self) -> Plan {
        self.builder.plan().clone()
    }

    pub fn point(&self, (x, y): XY) -> Point {
        (self.placed)(Point::new(x, y))
    }

    pub fn corner(&mut self, at: XY) -> CornerId {
        self.builder.corner(self.point(at))
    }

    pub fn ring(&mut self, points: &[XY]) -> Arc<[CornerId]> {
        let points: Vec<Point> = points.iter().map(|&point| self.point(point)).collect();
        self.builder.ring(points)
    }

    pub fn room(&mut self, function: &str, outer: &[XY]) -> RoomId {
        self.room_with_holes(function, outer, &[])
    }

    /// Rooms are called R1, R2, … in their source, in the order in which they are drawn.
    pub fn room_with_holes(&mut self, function: &str, outer: &[XY], holes: &[&[XY]]) -> RoomId {
        let outer = self.ring(outer);
        let holes = holes.iter().map(|hole| self.ring(hole)).collect();
        let key = format!("R{}", self.builder.plan().rooms().len() + 1);
        self.builder.room(&key, Room { outer, holes, function: function.into(), ..Room::default() })
    }

    pub fn named_room(&mut self, function: &str, name: &str, outer: &[XY]) -> RoomId {
        let outer = self.ring(outer);
        let key = format!("R{}", self.builder.plan().rooms().len() + 1);
        self.builder.room(&key, Room { outer, function: function.into(), name: name.into(), ..Room::default() })
    }

    pub fn door(&mut self, from: XY, to: XY) -> OpeningId {
        self.opening(OpeningKind::Door, from, to, None)
    }

    /// Openings are called D1, D2, … in their source, in the order in which they are drawn.
    pub fn opening(&mut self, kind: OpeningKind, from: XY, to: XY, pinned: Option<[Joint; 2]>) -> OpeningId {
        let place = Place::Free { from: self.point(from), to: self.point(to) };
        let key = format!("D{}", self.builder.plan().openings().len() + 1);
        self.builder.opening(&key, Opening { pinned, ..Opening::new(kind, place) })
    }

    pub fn wall(&mut self, from: XY, to: XY) {
        let (from, to) = (self.corner(from), self.corner(to));
        self.builder.wall(from, to, 0.1);
    }

    pub fn set_meta(&mut self, change: impl FnOnce(&mut Meta)) {
        let mut meta = self.builder.plan().meta().clone();
        change(&mut meta);
        self.builder.set_meta(meta);
    }
}
