//! The evidence for rooms, as in Fig. 3 of the paper: on the left of the figure the segments directly visible
//! from a point, on its right points that see each other.

use std::sync::Arc;

use super::RoomsSeen;
use crate::geometry::{Point, Segment};

/// The segments around a point.
#[derive(Clone, Debug, Default)]
pub(super) struct Around {
    pub from: Point,
    /// Each segment, and whether it is directly visible from the point.
    pub segments: Vec<(Segment, bool)>,
}

/// Segments further away than this, in metres, are not looked at: the figure is of one room.
const REACH_M: f64 = 12.0;

/// The most segments looked at in one frame.
const MOST: usize = 600;

/// Places along a segment at which it is looked for.
const PLACES: [f64; 5] = [0.05, 0.275, 0.5, 0.725, 0.95];

/// The random point nearest to a place, and what is visible from it.
pub(super) fn around(rooms: &RoomsSeen, lines: &[Segment], place: Point) -> Option<Around> {
    let nearest = rooms.points.iter().min_by(|p, q| p.0.distance(place).total_cmp(&q.0.distance(place)))?;
    let (from, walls) = (nearest.0, rooms.walls.as_ref()?);
    let near = lines.iter().filter(|line| line.distance(from) < REACH_M).take(MOST);
    let is_seen = |line: &Segment| {
        PLACES.iter().any(|&place| {
            let at = line.a.lerp(line.b, place);
            // Up to just before it: the segment itself is in the way, too.
            let short_m = 0.06_f64.min(from.distance(at) / 2.0);
            (at - from).unit().is_some_and(|along| !walls.blocks(from, at - along * short_m))
        })
    };
    Some(Around { from, segments: near.map(|line| (*line, is_seen(line))).collect() })
}

/// The last answer, which holds for many frames.
#[derive(Default)]
pub(super) struct Remembered {
    of: Option<(Arc<RoomsSeen>, Point)>,
    around: Option<Around>,
}

impl Remembered {
    pub(super) fn around(&mut self, rooms: &Arc<RoomsSeen>, lines: &[Segment], place: Point) -> Option<&Around> {
        let is_same = self.of.as_ref().is_some_and(|(of, at)| Arc::ptr_eq(of, rooms) && at.distance(place) < 0.02);
        if !is_same {
            self.around = around(rooms, lines, place);
            self.of = Some((rooms.clone(), place));
        }
        self.around.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::RayGrid;

    #[test]
    fn what_is_behind_a_wall_is_not_seen() {
        let wall = |y: f64| Segment::new(Point::new(-2.0, y), Point::new(2.0, y));
        let lines = vec![wall(1.0), wall(2.0), wall(-1.0)];
        let rooms = RoomsSeen {
            points: vec![(Point::new(0.0, 0.0), Some(0)), (Point::new(9.0, 9.0), None)],
            walls: Some(RayGrid::new(lines.clone())),
            ..RoomsSeen::default()
        };
        let around = around(&rooms, &lines, Point::new(0.3, 0.1)).unwrap();
        assert_eq!(around.from, Point::new(0.0, 0.0));
        let seen: Vec<bool> = around.segments.iter().map(|(_, seen)| *seen).collect();
        assert_eq!(seen, [true, false, true]);
    }
}
