//! What a robot knows, prepared to be painted: triangles and places are made beside the frames. All in the
//! plan's frame, in metres.

pub(crate) mod painter;
mod sights;

use std::sync::Arc;

use super::scene_painter::earcut;
use crate::geometry::areas::{self, Shapes};
use crate::geometry::{Point, Segment, Vector};
use crate::labels::Label;
use crate::robot::{Pose, RayGrid};

/// An area with its triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Filled {
    pub outer: Vec<Point>,
    pub holes: Vec<Vec<Point>>,
    pub triangles: Vec<u32>,
}

impl Filled {
    pub(crate) fn new(outer: Vec<Point>, holes: Vec<Vec<Point>>) -> Self {
        let triangles = earcut(&outer, &holes);
        Self { outer, holes, triangles }
    }

    /// The parts of an area, moved by a pose.
    pub(crate) fn parts(shapes: &Shapes, pose: Pose) -> Vec<Self> {
        let moved = |ring: &areas::Ring| -> Vec<Point> {
            areas::points(ring).into_iter().map(|point| pose.apply(point)).collect()
        };
        let parts = shapes.iter().filter_map(|shape| {
            let (outer, holes) = shape.split_first()?;
            Some(Self::new(moved(outer), holes.iter().map(moved).collect()))
        });
        parts.collect()
    }
}

/// A room found.
#[derive(Clone, Debug)]
pub(crate) struct RoomSeen {
    pub floor: Filled,
    pub label: Option<Label>,
    pub area_m2: f64,
    /// Where its label goes: well inside.
    pub at: Point,
}

/// A stretch of the boundary to the unknown.
#[derive(Clone, Debug)]
pub(crate) struct FrontierSeen {
    pub line: Vec<Point>,
    pub middle: Point,
    pub outward: Vector,
    pub length_m: f64,
    /// The likely label of the undiscovered room behind it, and its probability.
    pub behind: Option<(Label, f64)>,
}

/// The rooms found, and the evidence for them (Fig. 3 of the paper).
#[derive(Debug, Default)]
pub(crate) struct RoomsSeen {
    pub rooms: Vec<RoomSeen>,
    pub doorways: Vec<Segment>,
    /// The random points, and the room each is in.
    pub points: Vec<(Point, Option<usize>)>,
    /// Lines of sight that joined two sets of points.
    pub sights: Vec<Segment>,
    /// Walls and doorways: what ends a line of sight.
    pub walls: Option<RayGrid>,
}

/// The map at one moment.
#[derive(Clone, Debug, Default)]
pub(crate) struct MapSeen {
    pub free: Arc<Vec<Filled>>,
    pub known_m2: f64,
    pub frontiers: Arc<Vec<FrontierSeen>>,
    /// The segments of the line map.
    pub lines: Arc<Vec<Segment>>,
    /// Those of scans that are not in it yet.
    pub fresh: Arc<Vec<Segment>>,
    pub rooms: Arc<RoomsSeen>,
}

/// What one scanner saw.
#[derive(Clone, Debug)]
pub(crate) struct FanSeen {
    /// Where each beam ended; `None` without a return.
    pub ends: Vec<Option<Point>>,
}

/// The paths so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Paths {
    pub estimate: Vec<Point>,
    /// Empty where the truth is unknown.
    pub truth: Vec<Point>,
    pub odometry: Vec<Point>,
}

/// A mark of the comparison with the true plan.
#[derive(Clone, Debug)]
pub(crate) struct MarkSeen {
    pub rings: Vec<Vec<Point>>,
    /// The two ends of a connection.
    pub link: Option<[Point; 2]>,
    pub at: Point,
    pub sign: &'static str,
    pub tone: Tone,
}

/// How bad something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tone {
    Good,
    Bad,
    Weak,
}

/// The robot and its map, as they are shown now.
pub(crate) struct RobotSeen<'a> {
    pub map: &'a MapSeen,
    pub pose: Pose,
    pub true_pose: Option<Pose>,
    pub radius_m: f64,
    pub fans: &'a [FanSeen],
    /// The rest of the route.
    pub way: &'a [Point],
    pub paths: &'a Paths,
    pub shows_sights: bool,
    pub shows_paths: bool,
    /// It is no longer driving: no fan, no route.
    pub is_over: bool,
    /// The comparison with the true plan, and the mark looked at.
    pub marks: &'a [MarkSeen],
    pub current: Option<usize>,
}
