//! A segmented grid map as a plan: rooms with polygons, and the doorways between them.

use std::sync::Arc;

use super::grid_map::GridMap;
use super::segment::{Segmentation, outlines, simplified};
use crate::geometry::{Point, path, polygon};

/// A room of a grid map, in the map's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct GridRoom {
    /// Its number in the segmentation.
    pub region: u32,
    pub outer: Vec<Point>,
    /// Obstacles in it: pillars, blocks of walls, large furniture.
    pub holes: Vec<Vec<Point>>,
}

/// A doorway between two rooms of a grid map, in the map's frame.
#[derive(Clone, Debug, PartialEq)]
pub struct GridDoorway {
    pub ends: [Point; 2],
    /// The numbers of its rooms in the segmentation.
    pub regions: [u32; 2],
}

impl GridDoorway {
    pub fn width_m(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    pub fn middle(&self) -> Point {
        self.ends[0].midpoint(self.ends[1])
    }
}

/// Tolerance for outlines in metres; [`STEPS_CELLS`] instead if cells are coarse.
const TOLERANCE_M: f64 = 0.1;
/// Tolerance in cells: an oblique wall is a staircase of cells, so finer detail is not real.
const STEPS_CELLS: f64 = 1.5;
/// Smaller obstacles in a room, in square metres, do not make holes in its polygon.
const SMALLEST_HOLE_M2: f64 = 1.0;
/// Rings with more corners are not tested for crossings, which takes quadratic time.
const MOST_TESTED_CORNERS: usize = 2_000;

/// The rooms, by number.
pub fn rooms(map: &GridMap, segmentation: &Segmentation) -> Vec<GridRoom> {
    let width = map.width();
    let mut windows = vec![[usize::MAX, usize::MAX, 0, 0]; segmentation.rooms as usize + 1];
    for (cell, &region) in segmentation.region_of_cell.iter().enumerate() {
        if let Some([left, top, right, bottom]) = windows.get_mut(region as usize) {
            let (x, y) = (cell % width, cell / width);
            (*left, *top) = ((*left).min(x), (*top).min(y));
            (*right, *bottom) = ((*right).max(x + 1), (*bottom).max(y + 1));
        }
    }
    (1..=segmentation.rooms).filter_map(|region| room(map, segmentation, region, windows[region as usize])).collect()
}

fn room(map: &GridMap, segmentation: &Segmentation, region: u32, window: [usize; 4]) -> Option<GridRoom> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    let inside = |x: i32, y: i32| {
        (0..width).contains(&x)
            && (0..height).contains(&y)
            && segmentation.region_of_cell[(y * width + x) as usize] == region
    };
    let cell_m2 = map.resolution_m * map.resolution_m;
    let mut outer: Option<(f64, Vec<Point>)> = None;
    let mut holes = Vec::new();
    for outline in outlines(window, inside) {
        let ring: Vec<Point> = outline.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
        // Counter-clockwise in the picture, whose y points down, is negative here.
        let area_m2 = -polygon::signed_area(&ring) * cell_m2;
        if area_m2 > 0.0 {
            // A room may have several parts that touch at corners; its polygon is the largest.
            if outer.as_ref().is_none_or(|(largest, _)| area_m2 > *largest) {
                outer = Some((area_m2, simple(map, &outline)));
            }
        } else if -area_m2 >= SMALLEST_HOLE_M2 {
            holes.push(simple(map, &outline));
        }
    }
    let (_, outer) = outer.filter(|(_, ring)| ring.len() >= 3)?;
    // Small rings may lose their corners to the tolerance.
    holes.retain(|ring| ring.len() >= 3 && polygon::locate_in_ring(&outer, ring[0]) != polygon::Location::Outside);
    Some(GridRoom { region, outer, holes })
}

/// An outline with few corners, not crossing itself, in the map's frame.
fn simple(map: &GridMap, outline: &[(i32, i32)]) -> Vec<Point> {
    let mut tolerance = (TOLERANCE_M / map.resolution_m).max(STEPS_CELLS);
    loop {
        let ring = simplified(outline, tolerance);
        tolerance /= 2.0;
        if tolerance < 0.25 || ring.len() > MOST_TESTED_CORNERS || path::is_simple_ring(&ring) {
            return ring.into_iter().map(|point| map.map_from_picture(point.x, point.y).trimmed()).collect();
        }
    }
}

/// Narrower gaps are holes in badly scanned walls: neither robots nor people pass through them.
const NARROWEST_DOORWAY_M: f64 = 0.5;

/// The doorways: of several cuts through one doorway, the shortest.
pub fn doorways(map: &GridMap, segmentation: &Segmentation) -> Vec<GridDoorway> {
    /// Doorways between the same two rooms whose middles are this close count as one.
    const NEAR_M: f64 = 0.5;
    let mut all: Vec<GridDoorway> = segmentation
        .cuts
        .iter()
        .map(|cut| GridDoorway {
            ends: cut.ends.map(|end| map.map_from_picture(end.x, end.y).trimmed()),
            regions: cut.regions,
        })
        .filter(|doorway| doorway.width_m() >= NARROWEST_DOORWAY_M)
        .collect();
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&one, &other| all[one].width_m().total_cmp(&all[other].width_m()).then(one.cmp(&other)));
    let mut kept: Vec<usize> = Vec::new();
    for index in order {
        let doorway = &all[index];
        let is_new = kept.iter().map(|&kept| &all[kept]).all(|shorter| {
            let reach = NEAR_M + doorway.width_m() / 2.0;
            shorter.regions != doorway.regions || shorter.middle().distance(doorway.middle()) > reach
        });
        if is_new {
            kept.push(index);
        }
    }
    kept.sort_by_key(|&index| (all[index].regions, index));
    kept.into_iter()
        .map(|index| std::mem::replace(&mut all[index], GridDoorway { ends: [Point::default(); 2], regions: [0; 2] }))
        .collect()
}

/// The maximum width of a doorway; wider openings are free passages (section 3.3: 30 to 150 cm).
pub const WIDEST_DOORWAY_M: f64 = 1.5;

/// What was already known of a room and is kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Known {
    /// The text of its id.
    pub id: String,
    pub name: String,
    pub function: String,
}

/// The plan: rooms in the order of `rooms`, doorways pinned to them, in the map's frame. `known` and
/// `known_doorways` hold previous data of each room and doorway.
///
/// # Errors
/// When the map lies outside the drawing area; the error says why.
pub fn plan(
    meta: crate::plan::Meta,
    rooms: &[GridRoom],
    known: &[Known],
    doorways: &[GridDoorway],
    known_doorways: &[String],
) -> Result<(crate::plan::Plan, Vec<crate::plan::RoomId>, Vec<crate::plan::OpeningId>), String> {
    use crate::plan::{Builder, Joint, Opening, OpeningKind, Place, Room};
    let mut builder = Builder::new(meta);
    let mut ids = Vec::with_capacity(rooms.len());
    for (room, known) in rooms.iter().zip(known) {
        let outer = builder.ring(room.outer.iter().copied());
        let holes: Vec<Arc<_>> = room.holes.iter().map(|hole| builder.ring(hole.iter().copied())).collect();
        let holes = holes.into_iter().filter(|hole| hole.len() >= 3).collect();
        let (name, function) = (known.name.clone(), known.function.clone());
        ids.push(builder.room(&known.id, Room { outer, holes, name, function, ..Room::default() }));
    }
    let id_of = |region: u32| rooms.iter().position(|room| room.region == region).map(|index| ids[index]);
    let mut openings = Vec::with_capacity(doorways.len());
    for (doorway, known) in doorways.iter().zip(known_doorways) {
        let kind = if doorway.width_m() <= WIDEST_DOORWAY_M { OpeningKind::Door } else { OpeningKind::Passage };
        let [from, to] = doorway.ends;
        let mut opening = Opening::new(kind, Place::Free { from, to });
        opening.pinned = Some(doorway.regions.map(|region| id_of(region).map_or(Joint::Outside, Joint::Room)));
        openings.push(builder.opening(known, opening));
    }
    let plan =
        builder.finish().map_err(|violations| violations.first().map(ToString::to_string).unwrap_or_default())?;
    Ok((plan, ids, openings))
}
