//! The map a robot builds: line segments, each fused from all sightings of it.

use rstar::{AABB, RTree, primitives::GeomWithData, primitives::Rectangle};

use super::LineSegment;
use crate::geometry::{Bounds, Point};

/// When two segments count as the same piece of wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusionOptions {
    /// Maximum distance of the ends of one from the line of the other, in metres.
    pub offset_m: f64,
    /// Maximum angle between them; three deviations for segments too short for a precise angle.
    pub angle_rad: f64,
    /// Maximum gap between them along the line, in metres: doors are wider.
    pub gap_m: f64,
    /// Standard deviation of a point across its line, in metres.
    pub sigma_m: f64,
}

impl Default for FusionOptions {
    /// An offset of at most half a thin wall's thickness; a gap below the paper's 30 cm for a doorway.
    fn default() -> Self {
        Self { offset_m: 0.05, angle_rad: 6_f64.to_radians(), gap_m: 0.2, sigma_m: 0.015 }
    }
}

/// However uncertain its angle, a segment at a larger angle than this is another surface.
const MOST_OBLIQUE_RAD: f64 = 0.35;

/// A segment of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapLine {
    pub line: LineSegment,
    /// The number of segments fused into it.
    pub sightings: usize,
}

type Entry = GeomWithData<Rectangle<[f64; 2]>, usize>;

/// Line segments with a spatial index: the cost of adding a segment depends on what is nearby, not on the
/// size of the map.
#[derive(Clone, Debug, Default)]
pub struct LineMap {
    /// In order of creation; `None` if a line was fused into another.
    lines: Vec<Option<MapLine>>,
    index: RTree<Entry>,
}

impl LineMap {
    /// The segments, oldest first.
    pub fn lines(&self) -> impl Iterator<Item = &MapLine> {
        self.lines.iter().flatten()
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.index.size()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The bounding box of all segments.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.lines().flat_map(|line| [line.line.start, line.line.end]))
    }

    /// The segments whose bounding boxes meet `bounds`, oldest first.
    pub fn near(&self, bounds: Bounds) -> Vec<&MapLine> {
        self.ids_near(bounds).into_iter().filter_map(|id| self.lines[id].as_ref()).collect()
    }

    fn ids_near(&self, bounds: Bounds) -> Vec<usize> {
        if bounds.is_empty() {
            return Vec::new();
        }
        let envelope = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        let mut ids: Vec<usize> =
            self.index.locate_in_envelope_intersecting(envelope).map(|entry| entry.data).collect();
        ids.sort_unstable();
        ids
    }

    /// Adds a segment in the map's frame: fused with the lines it belongs to, or as a new one.
    pub fn add(&mut self, segment: LineSegment, options: &FusionOptions) {
        let mut fused = MapLine { line: segment, sightings: 1 };
        // The fused line is longer and may reach another line.
        while let Some(id) = self
            .ids_near(fused.line.segment().bounds().inflated(options.gap_m))
            .into_iter()
            .find(|id| self.lines[*id].is_some_and(|other| union(other.line, fused.line, options).is_some()))
        {
            let Some(other) = self.remove(id) else { break };
            let Some(line) = union(other.line, fused.line, options) else { break };
            fused = MapLine { line, sightings: other.sightings + fused.sightings };
        }
        let id = self.lines.len();
        self.index.insert(entry(&fused, id));
        self.lines.push(Some(fused));
    }

    fn remove(&mut self, id: usize) -> Option<MapLine> {
        let line = self.lines[id].take()?;
        self.index.remove(&entry(&line, id));
        Some(line)
    }
}

fn entry(line: &MapLine, id: usize) -> Entry {
    let (start, end) = (line.line.start, line.line.end);
    Entry::new(Rectangle::from_corners([start.x, start.y], [end.x, end.y]), id)
}

/// Both segments as one, if they are pieces of the same wall seen from the same side: nearly parallel,
/// overlapping or nearly so, and the ends of both near the common line.
fn union(a: LineSegment, b: LineSegment, options: &FusionOptions) -> Option<LineSegment> {
    let (a_direction, b_direction) = (a.direction(), b.direction());
    let angle_rad = a_direction.cross(b_direction).atan2(a_direction.dot(b_direction)).abs();
    if angle_rad > MOST_OBLIQUE_RAD {
        return None;
    }
    let variance = |line: LineSegment| line.covariance(options.sigma_m)[(1, 1)];
    if angle_rad > options.angle_rad.max(3.0 * (variance(a) + variance(b)).sqrt()) {
        return None;
    }
    let ends = [a.start, a.end, b.start, b.end];
    let line = LineSegment::along(a.moments.and(b.moments), a_direction + b_direction, ends)?;
    let (direction, origin) = (line.direction(), line.start);
    let at = |point: Point| (point - origin).dot(direction);
    let gap_m = at(a.start).max(at(b.start)) - at(a.end).min(at(b.end));
    let is_near = ends.iter().all(|end| (*end - origin).cross(direction).abs() <= options.offset_m);
    (gap_m <= options.gap_m && is_near).then_some(line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    /// A segment with a point every 5 cm.
    fn piece(from: (f64, f64), to: (f64, f64)) -> LineSegment {
        let (from, to) = (Point::new(from.0, from.1), Point::new(to.0, to.1));
        let count = (from.distance(to) / 0.05).ceil();
        let points: Vec<Point> = (0..=count as usize).map(|i| from.lerp(to, i as f64 / count)).collect();
        LineSegment::fitted(&points).unwrap()
    }

    fn map(pieces: &[LineSegment]) -> LineMap {
        let mut map = LineMap::default();
        for piece in pieces {
            map.add(*piece, &FusionOptions::default());
        }
        map
    }

    #[test]
    fn pieces_of_a_wall_become_one_line_and_a_doorway_stays_open() {
        let map = map(&[
            piece((0.0, 0.0), (2.0, 0.02)),
            piece((4.0, 0.0), (6.0, 0.0)),
            piece((1.5, 0.0), (3.0, 0.0)),
            piece((3.9, 0.01), (5.0, 0.0)),
        ]);
        let lines: Vec<(f64, f64)> = map.lines().map(|line| (line.line.start.x, line.line.end.x)).collect();
        assert_eq!(lines.len(), 2, "{lines:?}");
        assert!((lines[0].1 - 3.0).abs() < 0.02 && (lines[1].0 - 3.9).abs() < 0.02, "{lines:?}");
    }

    #[test]
    fn both_faces_of_a_wall_stay_apart() {
        // The same place, seen from above and from below.
        let map = map(&[piece((3.0, 0.0), (0.0, 0.0)), piece((0.0, 0.0), (3.0, 0.0))]);
        assert_eq!(map.len(), 2);
    }

    #[test]
    fn a_line_that_joins_two_fuses_both() {
        let map = map(&[piece((0.0, 0.0), (1.0, 0.0)), piece((2.0, 0.0), (3.0, 0.0)), piece((0.9, 0.0), (2.1, 0.0))]);
        assert_eq!(map.lines().map(|line| line.sightings).collect::<Vec<_>>(), [3]);
        assert_eq!(map.near(Bounds::of([Point::new(0.1, -0.1), Point::new(0.2, 0.1)])).len(), 1);
    }
}
