use std::collections::BTreeSet;
use std::sync::Arc;

use imbl::OrdMap;
use imbl::ordmap::DiffItem;
use rstar::{AABB, RTree, RTreeObject};

use crate::geometry::polygon::{self, Location};
use crate::geometry::{Bounds, Point, Vector};
use crate::plan::{CornerId, Plan, Room, RoomId};

/// A room's boundary as points.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomShape {
    pub id: RoomId,
    /// The outer ring; empty for a room without a boundary.
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
    pub bounds: Bounds,
}

impl RoomShape {
    /// Area in m², less holes.
    pub fn area_m2(&self) -> f64 {
        polygon::area(&self.outer, &self.holes)
    }

    /// The total length of all its rings in metres, holes included.
    pub fn perimeter_m(&self) -> f64 {
        self.rings().map(|ring| polygon::perimeter(ring)).sum()
    }

    /// Where a point lies relative to the room.
    pub fn locate(&self, point: Point) -> Location {
        if self.bounds.contains(point) { polygon::locate(&self.outer, &self.holes, point) } else { Location::Outside }
    }

    /// All rings, the outer one first.
    pub fn rings(&self) -> impl Iterator<Item = &Vec<Point>> {
        std::iter::once(&self.outer).chain(&self.holes)
    }

    /// The stretches of the ray from `origin` along the unit vector `direction` inside the room, as
    /// distances in metres from 0 to `reach_m`, in order.
    pub fn stretches(&self, origin: Point, direction: Vector, reach_m: f64) -> Vec<(f64, f64)> {
        let end = origin + direction * reach_m;
        if !self.bounds.intersects(Bounds::of([origin, end])) {
            return Vec::new();
        }
        let mut cuts = vec![0.0, reach_m];
        for edge in self.rings().flat_map(|ring| polygon::edges(ring)) {
            let across = edge.vector();
            let denominator = direction.cross(across);
            if denominator.abs() < 1e-12 {
                continue;
            }
            let to_edge = edge.a - origin;
            let along_edge = to_edge.cross(direction) / denominator;
            let along_ray = to_edge.cross(across) / denominator;
            if (-1e-9..=1.0 + 1e-9).contains(&along_edge) && along_ray > 0.0 && along_ray < reach_m {
                cuts.push(along_ray);
            }
        }
        cuts.sort_by(f64::total_cmp);
        let mut inside: Vec<(f64, f64)> = Vec::new();
        for pair in cuts.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            if to - from < 1e-9 || self.locate(origin + direction * ((from + to) / 2.0)) == Location::Outside {
                continue;
            }
            match inside.last_mut() {
                Some(last) if from - last.1 < 1e-9 => last.1 = to,
                _ => inside.push((from, to)),
            }
        }
        inside
    }
}

/// The shapes of all rooms of a plan, by id, with a spatial index.
#[derive(Debug)]
pub struct RoomShapes {
    shapes: Vec<RoomShape>,
    tree: RTree<Entry>,
}

/// With more shapes changed, the spatial index is made anew.
const FEW_CHANGED: usize = 32;

#[derive(Clone, Debug, PartialEq)]
struct Entry {
    index: usize,
    bounds: Bounds,
}

impl RTreeObject for Entry {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        AABB::from_corners([self.bounds.min.x, self.bounds.min.y], [self.bounds.max.x, self.bounds.max.y])
    }
}

impl RoomShapes {
    pub fn new(plan: &Plan) -> Self {
        Self::of_rooms(plan, plan.rooms().map(|(id, _)| id))
    }

    /// The shapes of the rooms of a plan after an edit, from those before it: the same as [`RoomShapes::new`].
    pub fn after(plan: &Plan, before: &Plan, shapes: &Arc<Self>) -> Arc<Self> {
        let changed: BTreeSet<CornerId> = changed_keys(&plan.corners, &before.corners);
        if changed.is_empty() && plan.rooms.ptr_eq(&before.rooms) {
            return Arc::clone(shapes);
        }
        let edited: BTreeSet<RoomId> = changed_keys(&plan.rooms, &before.rooms);
        let mut known = shapes.shapes.iter().peekable();
        let mut is_same = true;
        let all: Vec<RoomShape> = plan
            .rooms
            .iter()
            .map(|(&id, room)| {
                // Both are sorted by id.
                while known.next_if(|shape| shape.id < id).is_some() {}
                let has_ring = || {
                    !edited.contains(&id)
                        || before.rooms.get(&id).is_some_and(|was| was.outer == room.outer && was.holes == room.holes)
                };
                let is_moved = |ring: &Arc<[CornerId]>| ring.iter().any(|corner| changed.contains(corner));
                let has_moved = || !changed.is_empty() && (is_moved(&room.outer) || room.holes.iter().any(is_moved));
                match known.next_if(|shape| shape.id == id).filter(|_| has_ring() && !has_moved()) {
                    Some(shape) => shape.clone(),
                    None => {
                        is_same = false;
                        shape_of(plan, id, room)
                    }
                }
            })
            .collect();
        match is_same && all.len() == shapes.shapes.len() {
            true => Arc::clone(shapes),
            false => Arc::new(shapes.changed_to(all)),
        }
    }

    /// The shapes of some rooms, given by id.
    pub fn of_rooms(plan: &Plan, rooms: impl IntoIterator<Item = RoomId>) -> Self {
        let rooms = rooms.into_iter().filter_map(|id| Some((id, plan.room(id)?)));
        Self::of_shapes(rooms.map(|(id, room)| shape_of(plan, id, room)).collect())
    }

    fn of_shapes(shapes: Vec<RoomShape>) -> Self {
        let entries = shapes
            .iter()
            .enumerate()
            .filter(|(_, shape)| !shape.bounds.is_empty())
            .map(|(index, shape)| Entry { index, bounds: shape.bounds })
            .collect();
        Self { shapes, tree: RTree::bulk_load(entries) }
    }

    /// Other shapes, whose spatial index is made from this one where few have changed.
    fn changed_to(&self, shapes: Vec<RoomShape>) -> Self {
        let pairs = || self.shapes.iter().zip(&shapes).enumerate();
        if shapes.len() != self.shapes.len() || pairs().any(|(_, (before, now))| before.id != now.id) {
            return Self::of_shapes(shapes);
        }
        let changed: Vec<(Entry, Entry)> = pairs()
            .filter(|(_, (before, now))| before.bounds != now.bounds)
            .map(|(index, (before, now))| (Entry { index, bounds: before.bounds }, Entry { index, bounds: now.bounds }))
            .collect();
        if changed.len() > FEW_CHANGED {
            return Self::of_shapes(shapes);
        }
        let mut tree = self.tree.clone();
        for (before, now) in changed {
            if !before.bounds.is_empty() {
                tree.remove(&before);
            }
            if !now.bounds.is_empty() {
                tree.insert(now);
            }
        }
        Self { shapes, tree }
    }

    /// All shapes, sorted by room id.
    pub fn all(&self) -> &[RoomShape] {
        &self.shapes
    }

    /// The rooms with a boundary from the top left, line by line.
    pub fn reading_order(&self) -> Vec<RoomId> {
        self.in_lines(|bounds| (-bounds.max.y, bounds.height()), |bounds| bounds.min.x)
    }

    /// The rooms with a boundary from the top left, column by column.
    pub fn column_order(&self) -> Vec<RoomId> {
        self.in_lines(|bounds| (bounds.min.x, bounds.width()), |bounds| -bounds.max.y)
    }

    /// Rooms in lines, and in order within each. `across` returns where a room begins across the lines and how far it
    /// extends: a line is as wide as half a typical room.
    fn in_lines(&self, across: impl Fn(&Bounds) -> (f64, f64), along: impl Fn(&Bounds) -> f64) -> Vec<RoomId> {
        let mut rooms: Vec<(RoomId, Bounds)> =
            self.all().iter().filter(|shape| !shape.bounds.is_empty()).map(|shape| (shape.id, shape.bounds)).collect();
        let mut extents: Vec<f64> = rooms.iter().map(|(_, bounds)| across(bounds).1).collect();
        extents.sort_by(f64::total_cmp);
        let line_m = extents.get(extents.len() / 2).map_or(1.0, |extent| (extent / 2.0).max(0.1));
        let line = |bounds: &Bounds| (across(bounds).0 / line_m).ceil() as i64;
        rooms.sort_by(|(p, a), (q, b)| {
            let within = along(a).total_cmp(&along(b)).then(across(a).0.total_cmp(&across(b).0));
            line(a).cmp(&line(b)).then(within).then(p.cmp(q))
        });
        rooms.into_iter().map(|(id, _)| id).collect()
    }

    /// Index of a room in [`RoomShapes::all`].
    pub fn index_of(&self, id: RoomId) -> Option<usize> {
        self.shapes.binary_search_by_key(&id, |shape| shape.id).ok()
    }

    pub fn get(&self, id: RoomId) -> Option<&RoomShape> {
        self.index_of(id).map(|index| &self.shapes[index])
    }

    /// Indices of the rooms whose bounding boxes meet `bounds`, ascending.
    pub fn near(&self, bounds: Bounds) -> Vec<usize> {
        if bounds.is_empty() {
            return Vec::new();
        }
        let envelope = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let mut found: Vec<usize> =
            self.tree.locate_in_envelope_intersecting(envelope).map(|entry| entry.index).collect();
        found.sort_unstable();
        found
    }

    /// The rooms that a line passes through, in order along it.
    pub fn along(&self, line: &[Point]) -> Vec<RoomId> {
        let mut rooms: Vec<RoomId> = Vec::new();
        for pair in line.windows(2) {
            let way = pair[1] - pair[0];
            let Some(direction) = way.unit() else { continue };
            let near = self.near(Bounds::of([pair[0], pair[1]])).into_iter();
            let mut entered: Vec<(f64, RoomId)> = near
                .filter_map(|index| {
                    let shape = &self.shapes[index];
                    let (from, _) = shape.stretches(pair[0], direction, way.length()).into_iter().next()?;
                    Some((from, shape.id))
                })
                .collect();
            entered.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
            for (_, room) in entered {
                if !rooms.contains(&room) {
                    rooms.push(room);
                }
            }
        }
        rooms
    }

    /// Indices of the rooms that contain a point (boundary included), smallest first.
    pub fn at(&self, point: Point) -> Vec<usize> {
        let mut found = self.near(Bounds::of([point]));
        found.retain(|&index| self.shapes[index].locate(point) != Location::Outside);
        found.sort_by(|&p, &q| self.shapes[p].area_m2().total_cmp(&self.shapes[q].area_m2()).then(p.cmp(&q)));
        found
    }
}

fn shape_of(plan: &Plan, id: RoomId, room: &Room) -> RoomShape {
    let outer = plan.ring_points(&room.outer);
    let holes = room.holes.iter().map(|hole| plan.ring_points(hole)).collect();
    let bounds = polygon::bounds(&outer);
    RoomShape { id, outer, holes, bounds }
}

/// The keys of what differs between two maps.
pub(super) fn changed_keys<K: Copy + Ord, V: PartialEq>(map: &OrdMap<K, V>, before: &OrdMap<K, V>) -> BTreeSet<K> {
    if map.ptr_eq(before) {
        return BTreeSet::new();
    }
    let key = |item: DiffItem<'_, '_, K, V>| match item {
        DiffItem::Add(key, _) | DiffItem::Remove(key, _) => *key,
        DiffItem::Update { new: (key, _), .. } => *key,
    };
    map.diff(before).map(key).collect()
}
