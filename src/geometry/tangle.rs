//! Tangles: lines that cross so often that joining them would take minutes and gigabytes. They come from
//! a fuzzer, a broken export or a scribble, never from a building, and are drawn as plain lines.

use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree};

use super::{Point, Segment};

/// The most crossings counted per line.
const MOST_COUNTED: usize = 64;

/// The most neighbours examined per line: lines whose boxes overlap without crossing cost no more.
const MOST_NEIGHBOURS: usize = 2_000;

/// A drawing is tangled if it has more crossings than this per line, plus `SOME_CROSSINGS`: walls that
/// cross like a street grid have one or two. 400 walls through one point took 9 s to join, 100 take a
/// tenth of a second.
const CROSSINGS_A_LINE: usize = 8;
const SOME_CROSSINGS: usize = 2_000;

/// In a tangled drawing, the lines with more crossings than this are left unjoined.
const MOST_OF_ONE: usize = 32;

/// Of a tangle so many lines are drawn: more would only make it blacker, at a fifth of a millisecond each.
const MOST_DRAWN: usize = 4_000;

/// Of how many tangled lines one is drawn.
pub(crate) fn one_line_in(tangled: usize) -> usize {
    tangled.div_ceil(MOST_DRAWN).max(1)
}

/// Lines by place, each with something that belongs to it.
pub(crate) type LineTree<T> = RTree<GeomWithData<Line<[f64; 2]>, T>>;

/// The entry of a segment in a [`LineTree`].
pub(crate) fn entry<T>(segment: Segment, data: T) -> GeomWithData<Line<[f64; 2]>, T> {
    GeomWithData::new(Line::new([segment.a.x, segment.a.y], [segment.b.x, segment.b.y]), data)
}

/// The segment of an entry.
pub(crate) fn segment_of<T>(entry: &GeomWithData<Line<[f64; 2]>, T>) -> Segment {
    let Line { from, to } = *entry.geom();
    Segment::new(Point::new(from[0], from[1]), Point::new(to[0], to[1]))
}

/// Which of the segments in a tree are tangled, in the order of `segments`; empty if none is, as in every real plan.
pub(crate) fn tangled<T>(segments: &[Segment], tree: &LineTree<T>) -> Vec<bool> {
    if segments.len() * segments.len().min(MOST_COUNTED) / 2 <= SOME_CROSSINGS {
        return Vec::new();
    }
    let count = |segment: &Segment| {
        let bounds = segment.bounds();
        let near = AABB::from_corners([bounds.min.x, bounds.min.y], [bounds.max.x, bounds.max.y]);
        tree.locate_in_envelope_intersecting(near)
            .take(MOST_NEIGHBOURS)
            .filter(|other| cross(*segment, segment_of(other)))
            .take(MOST_COUNTED)
            .count()
    };
    let counts: Vec<usize> = segments.iter().map(count).collect();
    if counts.iter().sum::<usize>() / 2 <= CROSSINGS_A_LINE * segments.len() + SOME_CROSSINGS {
        return Vec::new();
    }
    counts.into_iter().map(|count| count > MOST_OF_ONE).collect()
}

/// Whether the interiors of two segments cross: meeting at an end, or running along each other, does not
/// count.
fn cross(p: Segment, q: Segment) -> bool {
    let sides = |of: Segment, by: Segment| {
        let along = by.vector();
        along.cross(of.a - by.a) * along.cross(of.b - by.a) < 0.0
    };
    sides(p, q) && sides(q, p)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tangled(segments: &[Segment]) -> Vec<bool> {
        super::tangled(segments, &RTree::bulk_load(segments.iter().map(|&segment| entry(segment, ())).collect()))
    }

    /// Segments through one point.
    fn star(number: usize) -> Vec<Segment> {
        let spoke = |index: usize| {
            let angle_rad = std::f64::consts::PI * index as f64 / number as f64;
            let tip = Point::new(100.0 * angle_rad.cos(), 100.0 * angle_rad.sin());
            Segment::new(tip, Point::new(-tip.x, -tip.y))
        };
        (0..number).map(spoke).collect()
    }

    #[test]
    fn a_street_grid_is_no_tangle() {
        let line = |at: f64| {
            [
                Segment::new(Point::new(at, -1.0), Point::new(at, 201.0)),
                Segment::new(Point::new(-1.0, at), Point::new(201.0, at)),
            ]
        };
        let grid: Vec<Segment> = (0..20).flat_map(|index| line(10.0 * index as f64)).collect();
        assert!(tangled(&grid).is_empty());
    }

    #[test]
    fn a_star_is_one_and_a_house_beside_it_is_not() {
        assert!(tangled(&star(40)).is_empty());
        let mut lines = star(400);
        let house = 300.0;
        lines.push(Segment::new(Point::new(house, house), Point::new(house + 5.0, house)));
        let tangled = tangled(&lines);
        assert_eq!(tangled.iter().filter(|is| **is).count(), 400);
        assert_eq!(tangled.last(), Some(&false));
    }
}
