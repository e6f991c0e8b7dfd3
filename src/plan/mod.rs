//! The document: one storey of one building as an immutable value that is cheap to clone.
//!
//! Corners are shared, like OpenStreetMap's nodes: walls and room boundaries refer to them by id, so
//! that moving one moves everything that uses it. An edit is a function from plan to plan (see
//! [`crate::edit`]); [`Plan::violations`] states the invariants; [`History`] keeps the plans for undo.

pub(crate) mod builder;
mod difference;
mod dimension;
mod element;
pub mod guides;
mod history;
mod id;
pub mod ignored;
mod invariants;
mod meta;
mod positions;
pub mod storeys;
pub mod titles;

use std::sync::Arc;

use imbl::OrdMap;

pub use crate::geometry::COORDINATE_LIMIT_M;
pub use builder::Builder;
pub use difference::{ChangeKind, Difference};
pub use dimension::{Dimension, DimensionAlong, DimensionHost, DimensionLine, DimensionPoint, WallSide};
pub use element::{
    Backdrop, Corner, Joint, LabelOrigin, LeafSide, Measurement, Opening, OpeningKind, Place, Rectification, Room,
    RoomLabel, Swing, Wall,
};
pub use guides::{Guide, GuideAxis};
pub use history::{History, Step};
pub use id::{CornerId, DimensionId, ElementId, IdError, OpeningId, RoomId, WallId, name_bits};
pub use ignored::Ignored;
pub use invariants::{METRES_PER_PIXEL, Violation};
pub use meta::{Meta, Scale, ScaleOrigin};
pub(crate) use positions::Positions;

use crate::geometry::{Bounds, Point, Segment};

/// Fields of a file that this version does not know, kept so that saving does not lose them.
pub type Extra = Option<Arc<serde_json::Map<String, serde_json::Value>>>;

/// Default width of a door in metres: the paper's authors scale their plans by a door of 90 cm.
pub const DEFAULT_DOOR_WIDTH_M: f64 = 0.9;

/// The median width of doorways in metres (167 floors of the KTH campus, 15,566 portals).
pub const MEDIAN_DOOR_M: f64 = 0.85;

/// Default thickness of a wall in metres: a masonry partition with plaster.
pub const DEFAULT_WALL_THICKNESS_M: f64 = 0.12;

/// The thickest plausible wall in metres: how far an opening looks for the rooms it joins.
pub const THICKEST_WALL_M: f64 = 0.6;

/// One storey of one building. Clones share all structure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    pub(crate) meta: Arc<Meta>,
    pub(crate) corners: OrdMap<CornerId, Corner>,
    pub(crate) walls: OrdMap<WallId, Wall>,
    pub(crate) rooms: OrdMap<RoomId, Arc<Room>>,
    pub(crate) openings: OrdMap<OpeningId, Arc<Opening>>,
    pub(crate) dimensions: OrdMap<DimensionId, Arc<Dimension>>,
    pub(crate) backdrop: Option<Arc<Backdrop>>,
    /// In the order of [`guides::sorted`].
    pub(crate) guides: Arc<[Guide]>,
    /// In the order of [`ignored::sorted`].
    pub(crate) ignored: Arc<[Ignored]>,
    pub(crate) extra: Extra,
}

impl Plan {
    pub fn meta(&self) -> &Meta {
        &self.meta
    }

    pub fn backdrop(&self) -> Option<&Backdrop> {
        self.backdrop.as_deref()
    }

    pub fn corner(&self, id: CornerId) -> Option<&Corner> {
        self.corners.get(&id)
    }

    pub fn wall(&self, id: WallId) -> Option<&Wall> {
        self.walls.get(&id)
    }

    pub fn room(&self, id: RoomId) -> Option<&Room> {
        self.rooms.get(&id).map(Arc::as_ref)
    }

    pub fn opening(&self, id: OpeningId) -> Option<&Opening> {
        self.openings.get(&id).map(Arc::as_ref)
    }

    pub fn dimension(&self, id: DimensionId) -> Option<&Dimension> {
        self.dimensions.get(&id).map(Arc::as_ref)
    }

    /// All dimension chains by id.
    pub fn dimensions(&self) -> impl ExactSizeIterator<Item = (DimensionId, &Dimension)> {
        self.dimensions.iter().map(|(&id, dimension)| (id, dimension.as_ref()))
    }

    /// All corners by id.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = (CornerId, &Corner)> {
        self.corners.iter().map(|(&id, corner)| (id, corner))
    }

    /// All walls by id.
    pub fn walls(&self) -> impl ExactSizeIterator<Item = (WallId, &Wall)> {
        self.walls.iter().map(|(&id, wall)| (id, wall))
    }

    /// All rooms by id.
    pub fn rooms(&self) -> impl ExactSizeIterator<Item = (RoomId, &Room)> {
        self.rooms.iter().map(|(&id, room)| (id, room.as_ref()))
    }

    /// All openings by id.
    pub fn openings(&self) -> impl ExactSizeIterator<Item = (OpeningId, &Opening)> {
        self.openings.iter().map(|(&id, opening)| (id, opening.as_ref()))
    }

    /// The ids of all elements, sorted.
    pub fn elements(&self) -> impl Iterator<Item = ElementId> + '_ {
        let corners = self.corners.keys().copied().map(ElementId::Corner);
        let walls = self.walls.keys().copied().map(ElementId::Wall);
        let rooms = self.rooms.keys().copied().map(ElementId::Room);
        let openings = self.openings.keys().copied().map(ElementId::Opening);
        let dimensions = self.dimensions.keys().copied().map(ElementId::Dimension);
        corners.chain(walls).chain(rooms).chain(openings).chain(dimensions)
    }

    /// Whether an element is part of the plan.
    pub fn has(&self, element: ElementId) -> bool {
        match element {
            ElementId::Corner(id) => self.corners.contains_key(&id),
            ElementId::Wall(id) => self.walls.contains_key(&id),
            ElementId::Room(id) => self.rooms.contains_key(&id),
            ElementId::Opening(id) => self.openings.contains_key(&id),
            ElementId::Dimension(id) => self.dimensions.contains_key(&id),
        }
    }

    /// Where a corner lies, if it exists.
    pub fn position(&self, id: CornerId) -> Option<Point> {
        self.corner(id).map(|corner| corner.position)
    }

    /// The points of a ring of corners. Corners that do not exist are skipped; the invariants rule them
    /// out.
    pub fn ring_points(&self, ring: &[CornerId]) -> Vec<Point> {
        ring.iter().filter_map(|&id| self.position(id)).collect()
    }

    /// A wall's centre line.
    pub fn wall_segment(&self, wall: &Wall) -> Option<Segment> {
        Some(Segment::new(self.position(wall.from)?, self.position(wall.to)?))
    }

    /// The segment an opening occupies: on its host edge, or its own.
    pub fn opening_segment(&self, opening: &Opening) -> Option<Segment> {
        match opening.place {
            Place::Free { from, to } => Some(Segment::new(from, to)),
            Place::Hosted { from, to, at_m, width_m } => {
                let edge = Segment::new(self.position(from)?, self.position(to)?);
                let direction = edge.vector().unit()?;
                let centre = edge.a + direction * at_m;
                Some(Segment::new(centre - direction * (width_m / 2.0), centre + direction * (width_m / 2.0)))
            }
        }
    }

    /// The bounding box of all corners and free openings; empty for an empty plan.
    pub fn bounds(&self) -> Bounds {
        let corners = Bounds::of(self.corners.values().map(|corner| corner.position));
        self.openings.values().fold(corners, |bounds, opening| match opening.place {
            Place::Free { from, to } => bounds.with(from).with(to),
            Place::Hosted { .. } => bounds,
        })
    }

    /// Whether nothing is drawn.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty() && self.rooms.is_empty() && self.openings.is_empty()
    }

    /// Whether both are the same value in memory: a quick test without false positives.
    pub fn is_same_value(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.meta, &other.meta)
            && self.corners.ptr_eq(&other.corners)
            && self.walls.ptr_eq(&other.walls)
            && self.rooms.ptr_eq(&other.rooms)
            && self.openings.ptr_eq(&other.openings)
            && self.dimensions.ptr_eq(&other.dimensions)
            && self.backdrop.as_ref().map(Arc::as_ptr) == other.backdrop.as_ref().map(Arc::as_ptr)
            && self.extra.as_ref().map(Arc::as_ptr) == other.extra.as_ref().map(Arc::as_ptr)
            && Arc::ptr_eq(&self.guides, &other.guides)
            && Arc::ptr_eq(&self.ignored, &other.ignored)
    }
}

/// The edges of a ring, the closing one last.
pub(crate) fn ring_edges<T: Copy>(ring: &[T]) -> impl Iterator<Item = (T, T)> + '_ {
    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

/// The corners of an edge, the smaller first: an edge has no direction.
pub(crate) fn ordered(a: CornerId, b: CornerId) -> [CornerId; 2] {
    if a < b { [a, b] } else { [b, a] }
}
