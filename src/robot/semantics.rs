//! The semantic map for robots: what the rooms of a `map_server` map are, in a YAML file beside it, as
//! navigation2's issue 1595 requests. The format is described in `docs/robot-maps.md`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::grid_map::GridMap;
use super::grid_plan::{GridDoorway, GridRoom, Known};
use super::segment::Segmentation;
use crate::geometry::{Point, polygon, trim_m};

/// The format version that is written.
pub const VERSION: u32 = 1;
/// The maximum size: a file with thousands of rooms has a few megabytes.
pub const LARGEST_BYTES: usize = 16 << 20;

/// The file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SemanticMap {
    pub version: u32,
    /// The map's YAML file, beside this one.
    pub map: String,
    /// The frame of all coordinates, which are in metres: that of the map.
    pub frame: String,
    /// As in the map's YAML file: metres per cell, and the pose [x, y, yaw] of the picture's lower left
    /// corner.
    pub resolution: f64,
    pub origin: [f64; 3],
    /// The typology the labels were predicted for: 'office'.
    pub typology: String,
    pub rooms: Vec<SemanticRoom>,
    pub doors: Vec<SemanticDoor>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SemanticRoom {
    /// Stable as long as the room exists.
    pub id: String,
    #[serde(default)]
    pub name: String,
    /// What the room is for, if the user said so: 'kitchen'.
    #[serde(default)]
    pub function: String,
    /// S, M, B, C or H.
    #[serde(default)]
    pub label: String,
    #[serde(default)]
    pub label_name: String,
    /// In m², without obstacles inside it.
    #[serde(default)]
    pub area: f64,
    /// A point inside the room, as far from walls as possible.
    #[serde(default)]
    pub centre: [f64; 2],
    pub polygon: Vec<[f64; 2]>,
    #[serde(default)]
    pub holes: Vec<Vec<[f64; 2]>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SemanticDoor {
    /// Stable as long as the door exists.
    pub id: String,
    /// Clear width in metres.
    pub width: f64,
    pub ends: [[f64; 2]; 2],
    /// The two rooms.
    pub sides: Vec<DoorSide>,
}

/// A room as seen from a door.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DoorSide {
    /// The room's id.
    pub room: String,
    /// Where a robot stands in this room before it drives through, [x, y, yaw], facing the door.
    pub pose: [f64; 3],
}

/// Why a file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SemanticsError(String);

impl std::fmt::Display for SemanticsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for SemanticsError {}

impl SemanticMap {
    /// Reads a file.
    ///
    /// # Errors
    /// When it is not such a file, has a newer version, or has coordinates that are not finite.
    pub fn from_yaml(text: &str) -> Result<Self, SemanticsError> {
        let fail = |what: String| Err(SemanticsError(what));
        if text.len() > LARGEST_BYTES {
            return fail("this is too large for a semantic map; is it another file?".to_owned());
        }
        let read: Self = match serde_saphyr::from_str(text) {
            Ok(read) => read,
            Err(error) => {
                let error = error.to_string();
                let first = error.lines().next().unwrap_or_default().trim_start_matches("error: ");
                return fail(format!("no semantic map: {first}"));
            }
        };
        if read.version > VERSION {
            return fail(format!("version {} is newer than this program; use a newer Enfilade", read.version));
        }
        let finite = |points: &[[f64; 2]]| points.iter().flatten().all(|value| value.is_finite());
        let is_sound =
            read.rooms.iter().all(|room| finite(&room.polygon) && room.holes.iter().all(|hole| finite(hole)))
                && read.doors.iter().all(|door| finite(&door.ends));
        if is_sound { Ok(read) } else { fail("no semantic map: a coordinate is not finite".to_owned()) }
    }

    /// The file's text.
    ///
    /// # Errors
    /// When it cannot be written, which no map made here causes.
    pub fn to_yaml(&self) -> Result<String, SemanticsError> {
        let body = serde_saphyr::to_string(self).map_err(|error| SemanticsError(error.to_string()))?;
        Ok(format!("# Rooms of a map, by Enfilade. Metres and radians in the frame named below.\n{body}"))
    }
}

/// The previous data of the rooms of a new segmentation: each takes over from the old room with which it
/// shares more than half of either's area; an old room is taken over once, by the room that shares the
/// most.
pub fn known_rooms(map: &GridMap, segmentation: &Segmentation, rooms: &[GridRoom], before: &SemanticMap) -> Vec<Known> {
    let mut area = vec![0u32; segmentation.rooms as usize + 1];
    for &region in segmentation.region_of_cell.iter().filter(|&&region| region <= segmentation.rooms) {
        area[region as usize] += 1;
    }
    // Shared cells of an old room (by index) and a region.
    let mut shared: Vec<(u32, usize, u32)> = Vec::new();
    for (index, old) in before.rooms.iter().enumerate() {
        let (cells, by_region) = overlap(map, segmentation, old);
        for (region, count) in by_region {
            if 2 * count > cells.min(area[region as usize]) {
                shared.push((count, index, region));
            }
        }
    }
    shared.sort_by_key(|&(count, index, region)| (std::cmp::Reverse(count), index, region));
    let mut old_of: BTreeMap<u32, usize> = BTreeMap::new();
    let mut taken = vec![false; before.rooms.len()];
    for (_, index, region) in shared {
        if !taken[index] && !old_of.contains_key(&region) {
            taken[index] = true;
            old_of.insert(region, index);
        }
    }
    let known = |room: &GridRoom| {
        let old = old_of.get(&room.region).map(|&index| &before.rooms[index]);
        old.map_or_else(Known::default, |old| Known {
            id: old.id.clone(),
            name: old.name.clone(),
            function: old.function.clone(),
        })
    };
    rooms.iter().map(known).collect()
}

/// How many cells an old room covers in the map, and how many of each new room.
fn overlap(map: &GridMap, segmentation: &Segmentation, old: &SemanticRoom) -> (u32, BTreeMap<u32, u32>) {
    let rings: Vec<Vec<(f64, f64)>> = std::iter::once(&old.polygon)
        .chain(&old.holes)
        .map(|ring| ring.iter().map(|&[x, y]| map.picture_from_map(Point::new(x, y))).collect())
        .collect();
    let mut cells = 0;
    let mut by_region = BTreeMap::new();
    let rows = rings.iter().flatten().map(|&(_, y)| y);
    let (low, high) = rows.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let clamp = |value: f64, most: usize| value.clamp(0.0, most as f64) as usize;
    if low >= high {
        return (0, by_region);
    }
    for row in clamp(low.floor(), map.height())..clamp(high.ceil(), map.height()) {
        // Where the row's centre line enters and leaves the rings.
        let y = row as f64 + 0.5;
        let mut crossings: Vec<f64> = Vec::new();
        for ring in &rings {
            for (index, &(x1, y1)) in ring.iter().enumerate() {
                let (x2, y2) = ring[(index + 1) % ring.len()];
                if (y1 <= y) != (y2 <= y) {
                    crossings.push(x1 + (y - y1) / (y2 - y1) * (x2 - x1));
                }
            }
        }
        crossings.sort_by(f64::total_cmp);
        for pair in crossings.chunks_exact(2) {
            let columns = clamp((pair[0] - 0.5).ceil(), map.width())..clamp((pair[1] - 0.5).ceil(), map.width());
            for column in columns {
                cells += 1;
                let region = segmentation.region_of_cell[row * map.width() + column];
                if (1..=segmentation.rooms).contains(&region) {
                    *by_region.entry(region).or_default() += 1;
                }
            }
        }
    }
    (cells, by_region)
}

/// The previous data of the doorways: the nearest old door between the same rooms, within half a metre.
/// `known` holds the previous data of each of `rooms`.
pub fn known_doorways(
    doorways: &[GridDoorway],
    rooms: &[GridRoom],
    known: &[Known],
    before: &SemanticMap,
) -> Vec<String> {
    /// How far a door may move between two maps, in metres.
    const MOVED_M: f64 = 0.5;
    let id_of = |region: u32| {
        let index = rooms.iter().position(|room| room.region == region)?;
        Some(known[index].id.as_str()).filter(|id| !id.is_empty())
    };
    let mut taken = vec![false; before.doors.len()];
    let mut ids = Vec::with_capacity(doorways.len());
    for doorway in doorways {
        let sides = doorway.regions.map(id_of);
        let nearest = before
            .doors
            .iter()
            .enumerate()
            .filter(|&(index, old)| {
                let has = |side: Option<&str>| side.is_some_and(|id| old.sides.iter().any(|side| side.room == id));
                !taken[index] && has(sides[0]) && has(sides[1])
            })
            .map(|(index, old)| {
                let [[x1, y1], [x2, y2]] = old.ends;
                (Point::new(x1, y1).midpoint(Point::new(x2, y2)).distance(doorway.middle()), index)
            })
            .filter(|&(distance, _)| distance <= MOVED_M)
            .min_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        ids.push(nearest.map_or_else(String::new, |(_, index)| {
            taken[index] = true;
            before.doors[index].id.clone()
        }));
    }
    ids
}

/// A point in a room as far from its rings as possible, to `CENTRE_PRECISION_M`: the best of a grid of
/// points, refined around it.
pub fn centre(room: &GridRoom) -> Point {
    const CENTRE_PRECISION_M: f64 = 0.05;
    const PLACES: u32 = 24;
    let bounds = polygon::bounds(&room.outer);
    let depth = |point: Point| {
        let inside = polygon::locate(&room.outer, &room.holes, point) == polygon::Location::Inside;
        let rings = std::iter::once(&room.outer).chain(&room.holes);
        let nearest =
            rings.flat_map(|ring| polygon::edges(ring)).map(|edge| edge.distance(point)).fold(f64::INFINITY, f64::min);
        if inside { nearest } else { -nearest }
    };
    let mut best = (f64::NEG_INFINITY, polygon::centroid(&room.outer));
    let (mut low, mut high) = (bounds.min, bounds.max);
    loop {
        let steps = Point::new((high.x - low.x) / f64::from(PLACES), (high.y - low.y) / f64::from(PLACES));
        for row in 0..PLACES {
            for column in 0..PLACES {
                let at =
                    Point::new(low.x + (f64::from(column) + 0.5) * steps.x, low.y + (f64::from(row) + 0.5) * steps.y);
                let deep = depth(at);
                if deep > best.0 {
                    best = (deep, at);
                }
            }
        }
        if steps.x.max(steps.y) <= CENTRE_PRECISION_M {
            return best.1.trimmed();
        }
        let around = |sign: f64| Point::new(best.1.x + sign * 2.0 * steps.x, best.1.y + sign * 2.0 * steps.y);
        (low, high) = (around(-1.0), around(1.0));
    }
}

/// Where a robot stands on both sides of a doorway, half a metre before it, facing it: first in the room
/// of the first region.
pub fn door_poses(doorway: &GridDoorway, rooms: [&GridRoom; 2]) -> [[f64; 3]; 2] {
    const BEFORE_M: f64 = 0.5;
    let along = (doorway.ends[1] - doorway.ends[0]).unit().unwrap_or_default();
    let side = |room: &GridRoom| {
        // The doorway's line is inside the wall: look in both directions for where the room begins.
        let inside = |aside: f64| {
            let at = doorway.middle() + along.left() * aside;
            polygon::locate(&room.outer, &room.holes, at) == polygon::Location::Inside
        };
        let share = |sign: f64| (1..=10).filter(|&step| inside(sign * BEFORE_M * f64::from(step) / 10.0)).count();
        if share(1.0) >= share(-1.0) { 1.0 } else { -1.0 }
    };
    let mut signs = rooms.map(side);
    if signs[0] == signs[1] {
        signs[1] = -signs[0];
    }
    signs.map(|sign| {
        let away = along.left() * sign;
        let at = doorway.middle() + away * BEFORE_M;
        [trim_m(at.x), trim_m(at.y), trim_m((-away).angle_rad())]
    })
}
