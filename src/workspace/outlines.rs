use crate::geometry::{Bounds, Point};
use crate::topology::RoomShapes;

/// The outlines of a plan's rooms, small enough to keep for every plan of a folder: a picture that can be drawn in any
/// size and in any colours. Coordinates are steps of 1/255 of the longer side, x to the right and y down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outlines(Box<[u8]>);

/// The rings of one room in [`Outlines`], the outer one first; empty for a room without a boundary.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OutlinedRoom {
    pub rings: Vec<Vec<[u8; 2]>>,
}

/// Rings and corners that are kept of one room: nobody sees more in a thumbnail.
const MOST_RINGS: usize = 15;
const MOST_CORNERS: usize = 250;

impl Outlines {
    /// The outlines of rooms, in their order.
    pub fn of(shapes: &RoomShapes) -> Self {
        let bounds = shapes.all().iter().fold(Bounds::EMPTY, |bounds, shape| bounds.union(shape.bounds));
        let longer_m = bounds.width().max(bounds.height());
        if !longer_m.is_finite() || longer_m <= 0.0 {
            return Self::default();
        }
        let step = |metres: f64| (255.0 * metres / longer_m).round().clamp(0.0, 255.0) as u8;
        let small = |point: &Point| [step(point.x - bounds.min.x), step(bounds.max.y - point.y)];
        let mut bytes = Vec::new();
        for shape in shapes.all() {
            let rings: Vec<Vec<[u8; 2]>> = shape
                .rings()
                .filter(|ring| ring.len() > 2)
                .map(|ring| {
                    let mut ring: Vec<[u8; 2]> = ring.iter().map(small).collect();
                    ring.dedup();
                    ring
                })
                .filter(|ring| ring.len() > 2 && ring.len() <= MOST_CORNERS)
                .take(MOST_RINGS)
                .collect();
            bytes.push(rings.len() as u8);
            for ring in rings {
                bytes.push(ring.len() as u8);
                bytes.extend(ring.iter().flatten());
            }
        }
        Self(bytes.into())
    }

    /// The rooms, in the order of [`super::PlanEntry::rooms`].
    pub fn rooms(&self) -> Vec<OutlinedRoom> {
        let mut bytes = self.0.iter().copied();
        let mut rooms = Vec::new();
        while let Some(rings) = bytes.next() {
            let mut room = OutlinedRoom::default();
            for _ in 0..rings {
                let corners = bytes.next().unwrap_or(0);
                let ring = (0..corners).filter_map(|_| Some([bytes.next()?, bytes.next()?])).collect();
                room.rings.push(ring);
            }
            rooms.push(room);
        }
        rooms
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.0
    }

    pub(super) fn of_bytes(bytes: Vec<u8>) -> Self {
        Self(bytes.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_room_of_a_plan_is_outlined_in_order() {
        for (_, plan) in crate::store::bundled_plans().unwrap() {
            let shapes = RoomShapes::new(&plan);
            let outlines = Outlines::of(&shapes);
            let rooms = outlines.rooms();
            assert_eq!(rooms.len(), plan.rooms().len());
            assert!(rooms.iter().all(|room| !room.rings.is_empty()));
            let corners = || rooms.iter().flat_map(|room| room.rings.iter().flatten());
            let wide =
                |of: usize| (corners().map(|it| it[of]).min().unwrap(), corners().map(|it| it[of]).max().unwrap());
            assert!(wide(0) == (0, 255) || wide(1) == (0, 255), "{:?} {:?}", wide(0), wide(1));
            assert_eq!(Outlines::of_bytes(outlines.bytes().to_vec()), outlines);
        }
        // Cut short anywhere, it is still read.
        let (_, plan) = &crate::store::bundled_plans().unwrap()[0];
        let bytes = Outlines::of(&RoomShapes::new(plan)).bytes().to_vec();
        for end in 0..bytes.len() {
            Outlines::of_bytes(bytes[..end].to_vec()).rooms();
        }
    }
}
