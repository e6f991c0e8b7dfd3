//! Dimension chains: what is measured, along what, and where the line lies. They are part of the drawing, not of the
//! building: no area, no feature and no check depends on them.

use super::{CornerId, Extra, OpeningId, Plan, WallId};
use crate::geometry::{Point, Vector};

/// A chain of dimensions: the distances between points one after the other, all on one line.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimension {
    /// What is measured, at least two points, in any order.
    pub points: Vec<DimensionPoint>,
    pub along: DimensionAlong,
    /// How far to the left of the first point the line lies, seen along it, in metres; to the right if negative.
    pub offset_m: f64,
    pub extra: Extra,
}

/// The direction of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DimensionAlong {
    /// From left to right.
    Horizontal,
    /// From the bottom up.
    Vertical,
    /// From the first point to the last.
    Aligned,
}

impl DimensionAlong {
    pub const ALL: [Self; 3] = [Self::Horizontal, Self::Vertical, Self::Aligned];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal",
            Self::Vertical => "vertical",
            Self::Aligned => "aligned",
        }
    }
}

impl DimensionAlong {
    /// A vector of length 1; `None` for one that follows the points.
    pub fn direction(self) -> Option<Vector> {
        match self {
            Self::Horizontal => Some(Vector::new(1.0, 0.0)),
            Self::Vertical => Some(Vector::new(0.0, 1.0)),
            Self::Aligned => None,
        }
    }

    /// The direction after a turn that sends the right to `right`: a quarter turn makes a level chain an upright one.
    pub(crate) fn turned(self, right: Vector) -> Self {
        match (self, right.x.abs() < right.y.abs()) {
            (Self::Horizontal, true) => Self::Vertical,
            (Self::Vertical, true) => Self::Horizontal,
            (along, _) => along,
        }
    }
}

/// A point that is measured. It follows what it is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DimensionPoint {
    /// What it is on; `None` for a fixed point.
    pub on: Option<DimensionHost>,
    /// Where it was when the plan was last changed: where it stays if what it is on is gone. On the 0.1 mm grid.
    pub last: Point,
}

/// What a measured point is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DimensionHost {
    Corner(CornerId),
    /// A point of a wall's axis or of one of its faces.
    Wall {
        wall: WallId,
        side: WallSide,
        /// Distance in metres from the wall's first corner along the axis; below 0 before it.
        at_m: f64,
    },
    /// An end of an opening.
    Opening {
        opening: OpeningId,
        /// Whether it is the first.
        is_start: bool,
    },
}

/// A line along a wall, seen from its first corner to its second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum WallSide {
    /// The left face.
    Left,
    /// The axis.
    #[default]
    Axis,
    /// The right face.
    Right,
}

impl WallSide {
    pub const ALL: [Self; 3] = [Self::Left, Self::Axis, Self::Right];

    /// Its name in files and in the interface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Axis => "axis",
            Self::Right => "right",
        }
    }

    /// How far to the left of the axis it is, in metres, for a wall so thick.
    pub fn off_axis_m(self, thickness_m: f64) -> f64 {
        match self {
            Self::Left => thickness_m / 2.0,
            Self::Axis => 0.0,
            Self::Right => -thickness_m / 2.0,
        }
    }
}

/// A chain as it lies in the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct DimensionLine {
    /// The measured points in order along the line, each with its place on the line; none twice.
    pub ticks: Vec<(Point, Point)>,
    /// Along the line, of length 1.
    pub along: Vector,
}

impl DimensionLine {
    /// The distances from tick to tick in metres.
    pub fn lengths_m(&self) -> impl Iterator<Item = f64> + '_ {
        self.ticks.windows(2).map(|pair| pair[0].1.distance(pair[1].1))
    }
}

/// Points nearer than this on the line, in metres, are one: rounding.
const SAME_M: f64 = 1e-3;

impl Plan {
    /// Where a measured point is now: on what it is on, or where it was last.
    pub fn dimension_point(&self, point: &DimensionPoint) -> Point {
        point.on.and_then(|host| self.on_host(host)).unwrap_or(point.last)
    }

    /// The point that a host gives; `None` if it is gone.
    pub(crate) fn on_host(&self, host: DimensionHost) -> Option<Point> {
        match host {
            DimensionHost::Corner(id) => self.position(id),
            DimensionHost::Wall { wall, side, at_m } => {
                let wall = self.wall(wall)?;
                let axis = self.wall_segment(wall)?;
                let along = axis.vector().unit()?;
                Some(axis.a + along * at_m + along.left() * side.off_axis_m(wall.thickness_m))
            }
            DimensionHost::Opening { opening, is_start } => {
                let segment = self.opening_segment(self.opening(opening)?)?;
                Some(if is_start { segment.a } else { segment.b })
            }
        }
    }

    /// A chain as it lies in the plan; `None` where all its points fall into one.
    pub fn dimension_line(&self, dimension: &Dimension) -> Option<DimensionLine> {
        let points: Vec<Point> = dimension.points.iter().map(|point| self.dimension_point(point)).collect();
        let (first, last) = (*points.first()?, *points.last()?);
        let along = dimension.along.direction().or_else(|| (last - first).unit())?;
        let origin = first + along.left() * dimension.offset_m;
        let on_line = |point: Point| origin + along * (point - origin).dot(along);
        let mut ticks: Vec<(Point, Point)> = points.into_iter().map(|point| (point, on_line(point))).collect();
        ticks.sort_by(|p, q| (p.1 - origin).dot(along).total_cmp(&(q.1 - origin).dot(along)));
        ticks.dedup_by(|next, kept| next.1.distance(kept.1) < SAME_M);
        (ticks.len() > 1).then_some(DimensionLine { ticks, along })
    }
}
