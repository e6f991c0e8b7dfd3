//! The difference between two plans, by element.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use imbl::OrdMap;
use imbl::ordmap::DiffItem;

use crate::base::wording::count;

use super::{CornerId, DimensionId, ElementId, OpeningId, Place, Plan, RoomId, WallId};

/// What happened to an element from one plan to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChangeKind {
    Added,
    Removed,
    Changed,
}

impl ChangeKind {
    /// Its name in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Added => "added",
            Self::Removed => "removed",
            Self::Changed => "changed",
        }
    }
}

/// The difference between two plans, one derived from the other or both from a third.
///
/// Plans that share structure, such as edits of one another, are compared in time proportional to the
/// difference, not to their size.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Difference {
    /// The elements that differ.
    pub elements: BTreeMap<ElementId, ChangeKind>,
    /// Whether the metadata differ.
    pub meta: bool,
    /// Whether the backdrop differs.
    pub backdrop: bool,
    /// Whether the guide lines differ.
    pub guides: bool,
    /// Which findings are ignored, and why.
    pub ignored: bool,
    /// Whether fields unknown to this version differ.
    pub extra: bool,
}

fn collect<K: Ord + Copy, V: PartialEq>(
    before: &OrdMap<K, V>,
    after: &OrdMap<K, V>,
    id: impl Fn(K) -> ElementId,
    elements: &mut BTreeMap<ElementId, ChangeKind>,
) {
    elements.extend(before.diff(after).map(|item| match item {
        DiffItem::Add(&key, _) => (id(key), ChangeKind::Added),
        DiffItem::Remove(&key, _) => (id(key), ChangeKind::Removed),
        DiffItem::Update { new: (&key, _), .. } => (id(key), ChangeKind::Changed),
    }));
}

impl Difference {
    /// A summary in words: '2 rooms, 1 wall and the picture'. `seen` comes from [`Self::seen`].
    pub fn in_words(&self, seen: &BTreeMap<ElementId, ChangeKind>) -> String {
        let number = |kind: &str| seen.keys().filter(|element| element.kind() == kind).count();
        let counts = ["room", "wall", "opening", "dimension"].map(|kind| (number(kind), kind));
        let mut parts: Vec<String> =
            counts.iter().filter(|(number, _)| *number > 0).map(|(number, kind)| count(*number, kind)).collect();
        if self.meta {
            parts.push("what is known of the plan".to_owned());
        }
        if self.backdrop {
            parts.push("the picture under it".to_owned());
        }
        if self.guides {
            parts.push("the guide lines".to_owned());
        }
        if self.ignored {
            parts.push("the ignored findings".to_owned());
        }
        match parts.split_last() {
            None if self.is_empty() => "nothing differs".to_owned(),
            None => "only corners and fields of another version differ".to_owned(),
            Some((last, [])) => {
                format!("{last} differ{}", if last.starts_with("1 ") || self.meta { "s" } else { "" })
            }
            Some((last, rest)) => format!("{} and {last} differ", rest.join(", ")),
        }
    }

    /// Compares two plans.
    pub fn between(before: &Plan, after: &Plan) -> Self {
        // All fields by name: a new field of `Plan` must be compared here.
        let Plan { meta, corners, walls, rooms, openings, dimensions, backdrop, guides, ignored, extra } = before;
        let mut elements = BTreeMap::new();
        collect::<CornerId, _>(corners, &after.corners, ElementId::Corner, &mut elements);
        collect::<WallId, _>(walls, &after.walls, ElementId::Wall, &mut elements);
        collect::<RoomId, _>(rooms, &after.rooms, ElementId::Room, &mut elements);
        collect::<OpeningId, _>(openings, &after.openings, ElementId::Opening, &mut elements);
        collect::<DimensionId, _>(dimensions, &after.dimensions, ElementId::Dimension, &mut elements);
        Self {
            elements,
            meta: !Arc::ptr_eq(meta, &after.meta) && *meta != after.meta,
            backdrop: *backdrop != after.backdrop,
            guides: *guides != after.guides,
            ignored: *ignored != after.ignored,
            extra: *extra != after.extra,
        }
    }

    /// Whether the plans are the same.
    pub fn is_empty(&self) -> bool {
        self.elements.is_empty() && !self.meta && !self.backdrop && !self.guides && !self.ignored && !self.extra
    }

    /// The changes a person sees: walls, rooms and openings, including those whose only change is a
    /// corner that moved. Corners themselves are left out.
    pub fn seen(&self, before: &Plan, after: &Plan) -> BTreeMap<ElementId, ChangeKind> {
        let mut seen = self.elements.clone();
        seen.retain(|element, _| !matches!(element, ElementId::Corner(_)));
        let moved: BTreeSet<CornerId> = self
            .elements
            .keys()
            .filter_map(|element| if let ElementId::Corner(id) = element { Some(*id) } else { None })
            .filter(|&id| before.position(id) != after.position(id))
            .collect();
        if moved.is_empty() {
            return seen;
        }
        let mut mark = |element, is_moved: bool| {
            if is_moved {
                seen.entry(element).or_insert(ChangeKind::Changed);
            }
        };
        for (id, wall) in after.walls() {
            mark(ElementId::Wall(id), moved.contains(&wall.from) || moved.contains(&wall.to));
        }
        for (id, room) in after.rooms() {
            mark(ElementId::Room(id), room.rings().any(|ring| ring.iter().any(|corner| moved.contains(corner))));
        }
        for (id, opening) in after.openings() {
            let is_moved =
                matches!(opening.place, Place::Hosted { from, to, .. } if moved.contains(&from) || moved.contains(&to));
            mark(ElementId::Opening(id), is_moved);
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edit;
    use crate::geometry::Point;
    use crate::plan::{Builder, Meta, Room};

    #[test]
    fn what_differs_is_told_by_element() {
        let mut builder = Builder::new(Meta::default());
        let ring = builder.ring([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| Point::new(x, y)));
        let (from, to) = (ring[0], ring[1]);
        let room = builder.room("room", Room { outer: ring, ..Room::default() });
        let before = builder.finish().expect("the plan is sound");
        assert!(Difference::between(&before, &before.clone()).is_empty());
        let (walled, wall) = edit::add_wall(&before, from, to, 0.1).expect("both corners exist");
        let moved = edit::move_corners(&walled, &[(from, Point::new(-1.0, 0.0))]).expect("it may move");
        let meta = Meta { name: "Named".to_owned(), ..Meta::default() };
        let after = edit::set_meta(&moved, meta);
        let difference = Difference::between(&before, &after);
        assert_eq!(
            difference.elements,
            BTreeMap::from([
                (ElementId::Corner(from), ChangeKind::Changed),
                (ElementId::Wall(wall), ChangeKind::Added),
            ])
        );
        assert!(difference.meta && !difference.backdrop && !difference.extra);
        // The room changed through its corner.
        assert_eq!(
            difference.seen(&before, &after),
            BTreeMap::from([(ElementId::Wall(wall), ChangeKind::Added), (ElementId::Room(room), ChangeKind::Changed),])
        );
        let back = Difference::between(&after, &before);
        assert_eq!(back.elements[&ElementId::Wall(wall)], ChangeKind::Removed);
    }
}
