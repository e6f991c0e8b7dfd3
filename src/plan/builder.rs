use std::collections::HashMap;
use std::sync::Arc;

use super::{
    Backdrop, Corner, CornerId, Dimension, DimensionId, Meta, Opening, OpeningId, Plan, Room, RoomId, Violation, Wall,
    WallId,
};
use crate::geometry::{Point, trim_m};

/// Builds a plan from many elements at once, for imports and generators. Equal points become one corner.
/// To edit an existing plan, see [`crate::edit`].
#[derive(Debug, Default)]
pub struct Builder {
    plan: Plan,
    by_position: HashMap<(i64, i64), CornerId>,
}

impl Builder {
    pub fn new(meta: Meta) -> Self {
        Self { plan: Plan { meta: Arc::new(meta), ..Plan::default() }, by_position: HashMap::new() }
    }

    /// Replaces the plan's metadata.
    pub fn set_meta(&mut self, meta: Meta) {
        self.plan.meta = Arc::new(meta);
    }

    pub fn set_backdrop(&mut self, backdrop: Backdrop) {
        self.plan.backdrop = Some(Arc::new(backdrop));
    }

    /// The corner at a point, trimmed to the grid: the existing one, or a new one.
    pub fn corner(&mut self, point: Point) -> CornerId {
        let position = point.trimmed();
        let key = grid_key(position);
        if let Some(&id) = self.by_position.get(&key) {
            return id;
        }
        let id = new_corner_id(&self.plan, position);
        self.plan.corners.insert(id, Corner { position, extra: None });
        self.by_position.insert(key, id);
        id
    }

    /// The corners of a ring of points, without a repeated last point and without points that coincide
    /// with their predecessor after trimming.
    pub fn ring(&mut self, points: impl IntoIterator<Item = Point>) -> Arc<[CornerId]> {
        let mut ring: Vec<CornerId> = Vec::new();
        for point in points {
            let corner = self.corner(point);
            if ring.last() != Some(&corner) {
                ring.push(corner);
            }
        }
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring.into()
    }

    /// A wall between two corners.
    pub fn wall(&mut self, from: CornerId, to: CornerId, thickness_m: f64) -> WallId {
        self.wall_as(None, Wall { from, to, thickness_m, extra: None })
    }

    /// A wall; `id` is its identity if known and not taken.
    pub fn wall_as(&mut self, id: Option<WallId>, mut wall: Wall) -> WallId {
        let known = id.filter(|id| !self.plan.walls.contains_key(id));
        let id = known.unwrap_or_else(|| new_wall_id(&self.plan, wall.from, wall.to));
        wall.thickness_m = trim_m(wall.thickness_m);
        self.plan.walls.insert(id, wall);
        id
    }

    /// A room. `key` is its identity in the source (a UUID, 'R12') and becomes its [`Room::source_id`]; a
    /// key that is the text of a [`RoomId`] is used as that id; with an empty key the id is derived from
    /// the boundary.
    pub fn room(&mut self, key: &str, mut room: Room) -> RoomId {
        if !key.is_empty() && key.parse::<RoomId>().is_err() {
            room.source_id = key.to_owned();
        }
        let id = new_room_id(&self.plan, key, &room);
        self.plan.rooms.insert(id, Arc::new(room));
        id
    }

    /// An opening; `key` works as in [`Builder::room`].
    pub fn opening(&mut self, key: &str, opening: Opening) -> OpeningId {
        let mut opening = opening.trimmed();
        if !key.is_empty() && key.parse::<OpeningId>().is_err() {
            opening.source_id = key.to_owned();
        }
        let id = new_opening_id(&self.plan, key, &opening);
        self.plan.openings.insert(id, Arc::new(opening));
        id
    }

    /// The plan as built so far.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The finished plan.
    ///
    /// # Errors
    /// All violations of the invariants, if any: the importer passes them on.
    pub fn finish(self) -> Result<Plan, Vec<Violation>> {
        let violations = self.plan.violations();
        if violations.is_empty() { Ok(self.plan) } else { Err(violations) }
    }
}

/// A position in grid units.
pub(super) fn grid_key(position: Point) -> (i64, i64) {
    ((position.x * 1e4).round() as i64, (position.y * 1e4).round() as i64)
}

pub(crate) fn new_corner_id(plan: &Plan, position: Point) -> CornerId {
    let (x, y) = grid_key(position);
    CornerId::derive(&[x as u64, y as u64], |id| plan.corners.contains_key(&id))
}

pub(crate) fn new_dimension_id(plan: &Plan, dimension: &Dimension) -> DimensionId {
    let points = dimension.points.iter().flat_map(|point| [point.last.x.to_bits(), point.last.y.to_bits()]);
    let parts: Vec<u64> = points.chain([dimension.along as u64, dimension.offset_m.to_bits()]).collect();
    DimensionId::derive(&parts, |id| plan.dimensions.contains_key(&id))
}

pub(crate) fn new_wall_id(plan: &Plan, from: CornerId, to: CornerId) -> WallId {
    WallId::derive(&[from.bits(), to.bits()], |id| plan.walls.contains_key(&id))
}

pub(crate) fn new_room_id(plan: &Plan, key: &str, room: &Room) -> RoomId {
    let taken = |id| plan.rooms.contains_key(&id);
    if let Ok(id) = key.parse()
        && !taken(id)
    {
        return id;
    }
    let parts: Vec<u64> = if key.is_empty() {
        room.rings().flat_map(|ring| ring.iter().map(|corner| corner.bits())).collect()
    } else {
        vec![super::id::name_bits(key)]
    };
    RoomId::derive(&parts, taken)
}

pub(crate) fn new_opening_id(plan: &Plan, key: &str, opening: &Opening) -> OpeningId {
    let taken = |id| plan.openings.contains_key(&id);
    if let Ok(id) = key.parse()
        && !taken(id)
    {
        return id;
    }
    let parts: Vec<u64> = if key.is_empty() {
        use super::Place;
        let kind = opening.kind as u64;
        match opening.place {
            Place::Hosted { from, to, at_m, width_m } => {
                vec![kind, from.bits(), to.bits(), at_m.to_bits(), width_m.to_bits()]
            }
            Place::Free { from, to } => vec![kind, from.x.to_bits(), from.y.to_bits(), to.x.to_bits(), to.y.to_bits()],
        }
    } else {
        vec![super::id::name_bits(key)]
    };
    OpeningId::derive(&parts, taken)
}
