//! The rooms of explored free space by the second method: the segmentation of grid maps ([`segment`]), in
//! the form in which the paper's method gives them.

use std::collections::BTreeMap;

use super::doorways::{Doorway, DoorwayOptions, walls};
use super::grid_map::{Cell, GridMap};
use super::grid_plan::{self, GridDoorway};
use super::quadrilaterals::mean_quadrilateral_m2;
use super::rooms::{FoundRoom, FoundRooms};
use super::segment::{SegmentOptions, Segmentation, segment, segment_with};
use crate::geometry::{Point, Segment, Vector, runs};

/// The largest share of a room's boundary that may lie open to unknown space, unless the robot was in it:
/// more has what is seen through a window or from far away.
const MOST_OPEN_SHARE: f64 = 0.5;

/// The rooms of the grid map of a log: without those of which hardly more than a view is known. `places` are
/// where the robot was.
pub fn log_rooms(map: &GridMap, places: &[Point], segments: &[Segment]) -> FoundRooms {
    let (width, height) = (map.width(), map.height());
    let cell_at = |&place: &Point| {
        let (x, y) = map.picture_from_map(place);
        let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
        is_inside.then(|| y as usize * width + x as usize)
    };
    let visited: Vec<usize> = places.iter().filter_map(cell_at).collect();
    let mut segmentation = segment_with(map, &SegmentOptions::LOG, &visited);
    let count = segmentation.regions as usize + 1;
    let mut is_visited = vec![false; count];
    for &cell in &visited {
        is_visited[segmentation.region_of_cell[cell] as usize] = true;
    }
    // Sides of cells towards unknown space, and towards obstacles.
    let (mut open, mut closed) = (vec![0_u32; count], vec![0_u32; count]);
    let mut count_side = |region: u32, other: usize| match map.cells()[other] {
        _ if region == 0 || segmentation.region_of_cell[other] != 0 => {}
        Cell::Unknown => open[region as usize] += 1,
        Cell::Occupied => closed[region as usize] += 1,
        Cell::Free => {}
    };
    for y in 0..height {
        for x in 0..width {
            let cell = y * width + x;
            let region = segmentation.region_of_cell[cell];
            if x + 1 < width {
                count_side(region, cell + 1);
                count_side(segmentation.region_of_cell[cell + 1], cell);
            }
            if y + 1 < height {
                count_side(region, cell + width);
                count_side(segmentation.region_of_cell[cell + width], cell);
            }
        }
    }
    let is_view = |region: u32| {
        let (open, closed) = (f64::from(open[region as usize]), f64::from(closed[region as usize]));
        !is_visited[region as usize] && open > MOST_OPEN_SHARE * (open + closed)
    };
    for region in &mut segmentation.region_of_cell {
        if is_view(*region) {
            *region = 0;
        }
    }
    segmentation.cuts.retain(|cut| !cut.regions.iter().any(|&region| is_view(region)));
    of_segmentation(map, &segmentation, segments)
}

/// The rooms of a grid map. `segments` is the line map, whose walls are reported with them.
pub fn grid_rooms(map: &GridMap, segments: &[Segment]) -> FoundRooms {
    let segmentation = segment(map);
    of_segmentation(map, &segmentation, segments)
}

/// The rooms of a segmented grid map.
pub fn of_segmentation(map: &GridMap, segmentation: &Segmentation, segments: &[Segment]) -> FoundRooms {
    let grid_rooms = grid_plan::rooms(map, segmentation);
    let index_of: BTreeMap<u32, usize> = grid_rooms.iter().enumerate().map(|(i, room)| (room.region, i)).collect();
    let found = grid_plan::doorways(map, segmentation);
    let sides = found.iter().map(|doorway| left_and_right(map, segmentation, doorway));
    let sides = sides.map(|regions| regions.map(|region| index_of.get(&region).copied())).collect();
    let doorways = found.iter().map(|doorway| Doorway {
        segment: Segment::new(doorway.ends[0], doorway.ends[1]),
        width_m: doorway.width_m(),
        depth_m: 0.0,
        is_framed: false,
    });
    let rooms = grid_rooms.into_iter().map(|room| FoundRoom {
        area_m2: mean_quadrilateral_m2(&room.outer),
        axes: runs::axes(&room.outer, &room.holes),
        outer: room.outer,
        holes: room.holes,
        points: Vec::new(),
    });
    FoundRooms {
        walls: walls(segments, &DoorwayOptions::default()),
        doorways: doorways.collect(),
        sides,
        points: Vec::new(),
        sights: Vec::new(),
        rooms: rooms.collect(),
    }
}

/// The regions to the left and right of a doorway.
fn left_and_right(map: &GridMap, segmentation: &Segmentation, doorway: &GridDoorway) -> [u32; 2] {
    let [from, to] = doorway.ends;
    let across = (to - from).left().unit().unwrap_or(Vector::new(0.0, 1.0));
    let region_at = |point: Point| {
        let (x, y) = map.picture_from_map(point);
        let inside = x >= 0.0 && y >= 0.0 && x < map.width() as f64 && y < map.height() as f64;
        inside.then(|| segmentation.region_of_cell[y as usize * map.width() + x as usize])
    };
    let left = (1..=8).find_map(|step| {
        let region = region_at(doorway.middle() + across * (0.1 * f64::from(step)))?;
        doorway.regions.contains(&region).then_some(region)
    });
    let [one, other] = doorway.regions;
    if left == Some(other) { [other, one] } else { [one, other] }
}
