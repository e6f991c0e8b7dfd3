use std::collections::BTreeMap;

use rstar::primitives::{GeomWithData, Rectangle};

use super::FINDINGS_LIMIT;
use super::overlaps::{self, Region};
use super::rings::{RingFaults, ring_faults};
use super::sizes;
use crate::features::{Analysis, RoomStatus};
use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Bounds, Point, Segment, polygon};
use crate::labels::Schemes;
use crate::plan::titles::{OpeningName, RoomName, WallName, numbers_of_unnamed};
use crate::plan::{Joint, Opening, OpeningId, Plan, Room, RoomId, WallId};
use crate::topology::{RoomShape, sides_by_geometry};

/// What the checks look at: the plan, its analysis, and intermediate results shared by several checks.
pub struct Context<'a> {
    pub plan: &'a Plan,
    pub analysis: &'a Analysis,
    pub schemes: &'a Schemes,
    /// Shapes that differ by less than this, in metres, count as drawn the same.
    pub drawing_tolerance_m: f64,
    /// For each room, in the order of [`crate::topology::RoomShapes::all`], the faults of its rings.
    pub ring_faults: Vec<RingFaults>,
    /// Pairs of rooms that share more area than the drawing tolerance explains.
    pub overlaps: Vec<Overlap>,
    /// The edges of all rooms except the hopeless ones.
    pub edges: RoomEdges,
    /// The walls with a length.
    pub walls: Walls,
    /// The openings with a length.
    pub openings: Vec<PlacedOpening<'a>>,
    /// How many times too long the plan's lengths seem, judging by its rooms' areas, and from how many
    /// rooms, see `sizes::length_factor`.
    pub length_factor: Option<(f64, usize)>,
    /// The numbers of the rooms without a name.
    numbers: BTreeMap<RoomId, usize>,
}

/// Two rooms that share area.
#[derive(Clone, Copy, Debug)]
pub struct Overlap {
    /// Indices of the smaller and the larger room.
    pub smaller: usize,
    pub larger: usize,
    pub region: Region,
    /// As a share of the smaller room's area.
    pub share: f64,
    /// As a share of the area of their union.
    pub share_of_union: f64,
}

/// Edges of all rooms, each directed so that its room is on its left.
pub struct RoomEdges {
    pub index: SegmentIndex,
    /// The index of the room each edge belongs to.
    pub rooms: Vec<usize>,
}

/// Centre lines of all walls with a length.
pub struct Walls {
    pub index: SegmentIndex,
    pub ids: Vec<WallId>,
}

/// An opening and the segment it occupies.
pub struct PlacedOpening<'a> {
    pub id: OpeningId,
    pub opening: &'a Opening,
    pub segment: Segment,
}

/// What lies beside a wall is looked for so far from its face, in metres.
const BESIDE_M: f64 = 0.05;

/// The finest drawing tolerance in metres: more than snapping to the millimetre and rounding leave, less
/// than any wall finish is thick.
const FINEST_TOLERANCE_M: f64 = 0.01;

/// A point placed on a raster is up to half a step off in both directions, so two drawings of the same
/// edge are up to √2 steps apart; rounded up.
const STEPS_OF_RASTER: f64 = 1.5;

/// The coarsest raster step in metres: with a larger one, tolerances would swallow walls.
const COARSEST_RASTER_M: f64 = 0.25;

impl<'a> Context<'a> {
    pub fn new(plan: &'a Plan, analysis: &'a Analysis, schemes: &'a Schemes) -> Self {
        let shapes = analysis.shapes.all();
        let drawing_tolerance_m =
            raster_step_m(plan).map_or(FINEST_TOLERANCE_M, |step| (STEPS_OF_RASTER * step).max(FINEST_TOLERANCE_M));
        let labelled_areas = shapes
            .iter()
            .zip(&analysis.rooms)
            .filter_map(|(shape, room)| Some((room.status.label()?, shape.area_m2())));
        let ring_faults: Vec<RingFaults> = shapes.iter().map(room_faults).collect();
        Self {
            plan,
            analysis,
            schemes,
            drawing_tolerance_m,
            overlaps: overlapping_pairs(analysis, &ring_faults, drawing_tolerance_m),
            edges: room_edges(shapes, &ring_faults),
            ring_faults,
            walls: walls(plan),
            openings: plan
                .openings()
                .filter_map(|(id, opening)| {
                    let segment = plan.opening_segment(opening).filter(|segment| segment.length() > 0.0)?;
                    Some(PlacedOpening { id, opening, segment })
                })
                .collect(),
            numbers: numbers_of_unnamed(plan, &analysis.shapes.reading_order()),
            length_factor: sizes::length_factor(schemes, plan.meta().typology.as_ref(), labelled_areas),
        }
    }

    /// All rooms' shapes, by index.
    pub fn shapes(&self) -> &'a [RoomShape] {
        self.analysis.shapes.all()
    }

    /// The status of a room's label, by index.
    pub fn status(&self, room: usize) -> RoomStatus {
        self.analysis.rooms[room].status
    }

    /// A room's name, by index.
    pub fn name(&self, room: usize) -> RoomName {
        let id = self.shapes()[room].id;
        self.plan.room(id).map_or_else(
            || RoomName { id, source_id: String::new(), name: String::new(), function: String::new(), number: None },
            |room| self.name_of_room(id, room),
        )
    }

    /// A room's name, by id; `None` if there is no such room.
    pub fn name_of(&self, id: RoomId) -> Option<RoomName> {
        Some(self.name_of_room(id, self.plan.room(id)?))
    }

    /// What a room is called.
    pub fn name_of_room(&self, id: RoomId, room: &Room) -> RoomName {
        RoomName::new(id, room, self.numbers.get(&id).copied())
    }

    /// What an opening is called.
    pub fn opening_name(&self, id: OpeningId, opening: &Opening) -> OpeningName {
        let sides = opening.pinned.unwrap_or_else(|| sides_by_geometry(self.plan, &self.analysis.shapes, opening));
        let mut rooms: Vec<RoomId> = sides.into_iter().filter_map(Joint::room).collect();
        rooms.dedup();
        OpeningName::new(id, opening, rooms.into_iter().filter_map(|room| self.name_of(room)).collect())
    }

    /// What a wall is called.
    pub fn wall_name(&self, id: WallId) -> WallName {
        let wall = self.plan.wall(id);
        let found = wall.and_then(|wall| Some((self.plan.wall_segment(wall)?, wall.thickness_m)));
        let sides = found.and_then(|(axis, thickness_m)| {
            let beside = axis.vector().left().unit()? * (thickness_m / 2.0 + BESIDE_M);
            // The smallest room, where one lies in another.
            let room = |at: Point| {
                let found = self.analysis.shapes.at(at).into_iter();
                found.min_by(|&p, &q| self.shapes()[p].area_m2().total_cmp(&self.shapes()[q].area_m2()))
            };
            Some([room(axis.midpoint() + beside), room(axis.midpoint() + -beside)])
        });
        let sides = sides.unwrap_or_default();
        let mut rooms: Vec<usize> = sides.into_iter().flatten().collect();
        rooms.dedup();
        let rooms = rooms.into_iter().map(|room| self.name(room)).collect();
        WallName { id, rooms, is_outer: sides.iter().any(Option::is_none) }
    }

    /// Whether a room, by index, is one in the paper's sense: not a balcony or a shaft.
    pub fn is_classified(&self, room: usize) -> bool {
        self.status(room) != RoomStatus::NotClassified
    }

    /// Distance in metres from a point to a room; 0 inside, `None` beyond `reach_m`.
    pub fn distance_to_room(&self, from: Point, room: usize, reach_m: f64) -> Option<f64> {
        if self.shapes()[room].locate(from) != polygon::Location::Outside {
            return Some(0.0);
        }
        self.edges
            .index
            .near(Bounds::of([from]).inflated(reach_m))
            .filter(|&edge| self.edges.rooms[edge] == room)
            .map(|edge| self.edges.index.get(edge).distance(from))
            .min_by(f64::total_cmp)
            .filter(|&distance| distance <= reach_m)
    }
}

/// The step in metres of the raster the plan was digitised on, if any: the unit of its source, provided
/// all corners lie on multiples of it. Metres, feet and the like do not count.
fn raster_step_m(plan: &Plan) -> Option<f64> {
    let step = plan.meta().scale.metres_per_unit?;
    if !(step > FINEST_TOLERANCE_M / STEPS_OF_RASTER && step <= COARSEST_RASTER_M) {
        return None;
    }
    let (_, first) = plan.corners().next()?;
    // Rounding to the 0.1 mm grid moves each corner by up to half a grid step.
    let on_raster = |length: f64| (length / step - (length / step).round()).abs() * step <= crate::geometry::GRID_M;
    let all_on_raster = plan.corners().all(|(_, corner)| {
        let from_first = corner.position - first.position;
        on_raster(from_first.x) && on_raster(from_first.y)
    });
    all_on_raster.then_some(step)
}

fn room_faults(shape: &RoomShape) -> RingFaults {
    let mut all = RingFaults::default();
    for ring in shape.rings() {
        let faults = ring_faults(ring);
        all.crossings.extend(faults.crossings);
        all.touches.extend(faults.touches);
    }
    all
}

fn room_edges(shapes: &[RoomShape], faults: &[RingFaults]) -> RoomEdges {
    let (mut segments, mut rooms) = (Vec::new(), Vec::new());
    for (room, shape) in shapes.iter().enumerate().filter(|(room, _)| !faults[*room].is_hopeless()) {
        for (place, ring) in shape.rings().enumerate() {
            let counter_clockwise = polygon::signed_area(ring) >= 0.0;
            let is_hole = place > 0;
            for edge in polygon::edges(ring).filter(|edge| edge.a != edge.b) {
                segments.push(if counter_clockwise == is_hole { Segment::new(edge.b, edge.a) } else { edge });
                rooms.push(room);
            }
        }
    }
    RoomEdges { index: SegmentIndex::new(segments), rooms }
}

fn walls(plan: &Plan) -> Walls {
    let (ids, segments) = plan
        .walls()
        .filter_map(|(id, wall)| Some((id, plan.wall_segment(wall).filter(|segment| segment.a != segment.b)?)))
        .unzip();
    Walls { index: SegmentIndex::new(segments), ids }
}

/// The pairs of rooms that share a region thicker than `tolerance_m`, by index; at most
/// [`FINDINGS_LIMIT`].
fn overlapping_pairs(analysis: &Analysis, faults: &[RingFaults], tolerance_m: f64) -> Vec<Overlap> {
    let shapes = analysis.shapes.all();
    let mut found = Vec::new();
    for (index, shape) in shapes.iter().enumerate().filter(|(index, _)| !faults[*index].is_hopeless()) {
        for other in analysis.shapes.near(shape.bounds) {
            if other <= index || faults[other].is_hopeless() {
                continue;
            }
            let common = intersection(shape.bounds, shapes[other].bounds);
            if common.width().min(common.height()) <= tolerance_m {
                continue;
            }
            let Some(region) = overlaps::shared(shape.rings(), shapes[other].rings()) else { continue };
            let (area_m2, other_area_m2) = (shape.area_m2(), shapes[other].area_m2());
            if region.depth_m <= tolerance_m || area_m2 <= 0.0 || other_area_m2 <= 0.0 {
                continue;
            }
            // Of equally large rooms the first counts as the larger.
            let (smaller, larger) = if area_m2 < other_area_m2 { (index, other) } else { (other, index) };
            let union_m2 = area_m2 + other_area_m2 - region.area_m2;
            found.push(Overlap {
                smaller,
                larger,
                region,
                share: region.area_m2 / area_m2.min(other_area_m2),
                share_of_union: region.area_m2 / union_m2,
            });
            if found.len() >= FINDINGS_LIMIT {
                return found;
            }
        }
    }
    found
}

fn intersection(one: Bounds, other: Bounds) -> Bounds {
    Bounds {
        min: Point::new(one.min.x.max(other.min.x), one.min.y.max(other.min.y)),
        max: Point::new(one.max.x.min(other.max.x), one.max.y.min(other.max.y)),
    }
}

/// A spatial index of boxes.
pub type Boxes = rstar::RTree<GeomWithData<Rectangle<[f64; 2]>, usize>>;

/// A spatial index of the bounding boxes of rings.
pub fn ring_boxes(rings: &[Vec<Point>]) -> Boxes {
    let boxes = rings.iter().enumerate().filter(|(_, ring)| !ring.is_empty()).map(|(index, ring)| {
        let Bounds { min, max } = polygon::bounds(ring);
        GeomWithData::new(Rectangle::from_corners([min.x, min.y], [max.x, max.y]), index)
    });
    Boxes::bulk_load(boxes.collect())
}
