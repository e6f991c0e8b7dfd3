use std::collections::BTreeSet;

use imbl::ordmap::DiffItem;

use super::{CornerId, ElementId, Place, Plan};

impl Plan {
    /// The elements in which this plan differs from an earlier one: added, changed, moved with a corner,
    /// and removed ones. Takes time in proportion to the plan only where corners moved.
    pub fn changed_since(&self, earlier: &Self) -> BTreeSet<ElementId> {
        let corners: BTreeSet<CornerId> = earlier.corners.diff(&self.corners).map(|item| *key(item)).collect();
        let mut changed: BTreeSet<ElementId> = BTreeSet::new();
        changed.extend(earlier.walls.diff(&self.walls).map(|item| ElementId::Wall(*key(item))));
        changed.extend(earlier.rooms.diff(&self.rooms).map(|item| ElementId::Room(*key(item))));
        changed.extend(earlier.openings.diff(&self.openings).map(|item| ElementId::Opening(*key(item))));
        if !corners.is_empty() {
            let is_moved = |corner: &CornerId| corners.contains(corner);
            let walls = self.walls().filter(|(_, wall)| is_moved(&wall.from) || is_moved(&wall.to));
            changed.extend(walls.map(|(id, _)| ElementId::Wall(id)));
            let rooms = self.rooms().filter(|(_, room)| room.rings().any(|ring| ring.iter().any(is_moved)));
            changed.extend(rooms.map(|(id, _)| ElementId::Room(id)));
            let is_opening_moved = |place: &Place| match place {
                Place::Hosted { from, to, .. } => is_moved(from) || is_moved(to),
                Place::Free { .. } => false,
            };
            let openings = self.openings().filter(|(_, opening)| is_opening_moved(&opening.place));
            changed.extend(openings.map(|(id, _)| ElementId::Opening(id)));
            changed.extend(corners.into_iter().map(ElementId::Corner));
        }
        changed
    }
}

fn key<'a, K, V>(item: DiffItem<'a, 'a, K, V>) -> &'a K {
    match item {
        DiffItem::Add(key, _) | DiffItem::Remove(key, _) | DiffItem::Update { new: (key, _), .. } => key,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Builder, Meta, Opening, OpeningKind, Room, edit};
    use super::*;
    use crate::geometry::Point;

    #[test]
    fn what_a_moved_corner_moves_is_changed_and_nothing_else() {
        let mut builder = Builder::new(Meta::default());
        let ring = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| builder.corner(Point::new(x, y)));
        let low = builder.wall(ring[0], ring[1], 0.1);
        let high = builder.wall(ring[2], ring[3], 0.1);
        let room = builder.room("", Room { outer: ring.into(), ..Room::default() });
        let place = Place::Hosted { from: ring[0], to: ring[1], at_m: 2.0, width_m: 0.9 };
        let door = builder.opening("", Opening::new(OpeningKind::Door, place));
        let plan = builder.plan().clone();
        assert!(plan.changed_since(&plan.clone()).is_empty());
        let moved = edit::move_corners(&plan, &[(ring[0], Point::new(-1.0, 0.0))]).unwrap();
        let moved_with = [ElementId::Wall(low), ElementId::Room(room), ElementId::Opening(door)];
        let expected: BTreeSet<ElementId> = moved_with.into_iter().chain([ElementId::Corner(ring[0])]).collect();
        assert_eq!(moved.changed_since(&plan), expected, "not {high}");
        let renamed = edit::set_name(&plan, room, "Hall").unwrap();
        assert_eq!(renamed.changed_since(&plan), BTreeSet::from([ElementId::Room(room)]));
    }
}
