//! What the joint classifier sees of each room before any label is known: the room in relation to the
//! other rooms of its plan. Nothing here comes from a room's name or function.

use std::collections::VecDeque;

use crate::base::numbers::{mean, quantile};
use crate::dataset::RoomNetwork;
use crate::plan::OpeningKind;

/// Related features: explained together, and left out together to measure their worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Area, mainly in relation to the other rooms of the plan.
    Size,
    /// Lengths, corners, how compact it is.
    Form,
    /// Its own openings.
    Openings,
    /// Its place in the graph of rooms.
    Place,
    /// The rooms it opens to, whatever their labels.
    Neighbours,
    /// Rooms like it in the plan.
    Alike,
    /// The plan as a whole.
    Plan,
    /// Labels of the rooms around, known or predicted: the second round's.
    Labels,
}

impl Group {
    pub const ALL: [Self; 8] =
        [Self::Size, Self::Form, Self::Openings, Self::Place, Self::Neighbours, Self::Alike, Self::Plan, Self::Labels];
}

/// The features of the first round, in their order.
pub const FEATURES: &[(Group, &str)] = &[
    (Group::Size, "area against the plan's median"),
    (Group::Size, "area against the largest room"),
    (Group::Size, "area as a share of all"),
    (Group::Size, "rank of area"),
    (Group::Size, "area"),
    (Group::Form, "axes ratio"),
    (Group::Form, "length against width"),
    (Group::Form, "perimeter against area"),
    (Group::Form, "convexity"),
    (Group::Form, "fill of its rectangle"),
    (Group::Form, "walls"),
    (Group::Form, "length against the plan's median room"),
    (Group::Form, "width against the plan's median room"),
    (Group::Form, "rank of length"),
    (Group::Form, "rank of width"),
    (Group::Openings, "openings"),
    (Group::Openings, "rooms joined"),
    (Group::Openings, "rooms joined against the most joined"),
    (Group::Openings, "rank of openings"),
    (Group::Openings, "openings along its walls"),
    (Group::Openings, "free passages"),
    (Group::Openings, "double doors"),
    (Group::Openings, "openings to what is not classified"),
    (Group::Openings, "second openings to the same room"),
    (Group::Place, "betweenness"),
    (Group::Place, "closeness"),
    (Group::Place, "rank of closeness"),
    (Group::Place, "steps to the farthest room"),
    (Group::Place, "steps to the most joined room"),
    (Group::Place, "share of rooms within reach"),
    (Group::Neighbours, "neighbours that end there"),
    (Group::Neighbours, "share of neighbours that end there"),
    (Group::Neighbours, "neighbours' mean area against its own"),
    (Group::Neighbours, "largest neighbour against its own area"),
    (Group::Neighbours, "smallest neighbour against its own area"),
    (Group::Neighbours, "largest neighbour against the plan's median"),
    (Group::Neighbours, "rooms joined by the best joined neighbour"),
    (Group::Neighbours, "rooms joined by neighbours"),
    (Group::Neighbours, "axes ratio of the longest neighbour"),
    (Group::Neighbours, "betweenness of the most passed neighbour"),
    (Group::Neighbours, "small neighbours"),
    (Group::Neighbours, "large neighbours"),
    (Group::Neighbours, "share of larger neighbours"),
    (Group::Alike, "rooms of its area"),
    (Group::Alike, "share of rooms of its area"),
    (Group::Alike, "rooms of its area and shape"),
    (Group::Alike, "share of rooms of its area and shape"),
    (Group::Alike, "area against the most common one"),
    (Group::Alike, "rooms off the same neighbour"),
    (Group::Alike, "median of these against its own area"),
    (Group::Alike, "those of its area"),
    (Group::Plan, "rooms"),
    (Group::Plan, "median area"),
    (Group::Plan, "spread of areas"),
    (Group::Plan, "smallest tenth against the median"),
    (Group::Plan, "largest tenth against the median"),
    (Group::Plan, "largest room against the median"),
    (Group::Plan, "mean openings"),
    (Group::Plan, "share of rooms that are ends"),
    (Group::Plan, "most rooms joined by one"),
    (Group::Plan, "share of long rooms"),
    (Group::Plan, "mean free passages"),
];

/// Logarithms of areas and ratios this close count as equal: half a percent is less than the error of
/// tracing, and keeps rounding from deciding ranks.
const EQUAL: f64 = 0.005;

/// Rooms are alike in area, or in shape, if the logarithms differ by at most this: 15 %.
pub(super) const ALIKE: f64 = 0.15;

/// A room is small, or large, beyond these logarithms of its ratio to the plan's median: half, and 1.65.
const SMALL: f64 = -0.7;
const LARGE: f64 = 0.5;

/// Replaces infinitely small and large values: logarithms stay within 20.
const LEAST: f64 = 1e-9;

/// Up to this many rooms, the graph is searched from every room; beyond, from this many evenly spaced
/// ones: time stays proportional to the plan.
const MOST_SEARCHES: usize = 1000;

/// Per-room lists of a plan from which features and labels around rooms are computed.
#[derive(Clone, Debug)]
pub(super) struct View {
    /// Natural logarithm of the area in m².
    pub log_area: Vec<f64>,
    /// The rooms its openings lead to, without repeats, ascending.
    pub joined: Vec<Vec<usize>>,
    /// The other rooms joined by its best connected neighbour.
    pub siblings: Vec<Vec<usize>>,
    /// The flat that each room is in, from 0; `None` outside flats, in any plan that is no storey of flats.
    pub flat: Vec<Option<usize>>,
}

impl View {
    pub fn new(network: &RoomNetwork) -> Self {
        let log_area: Vec<f64> = network.rooms.iter().map(|room| log(room.area_m2)).collect();
        let joined: Vec<Vec<usize>> = network.joined();
        let siblings = (0..joined.len())
            .map(|room| {
                // Equally connected neighbours of equal area lead to as many siblings: which is taken
                // matters little, and the rooms' order decides.
                let hub = joined[room]
                    .iter()
                    .copied()
                    .max_by(|&p, &q| joined[p].len().cmp(&joined[q].len()).then(log_area[p].total_cmp(&log_area[q])));
                hub.map_or_else(Vec::new, |hub| joined[hub].iter().copied().filter(|&other| other != room).collect())
            })
            .collect();
        let flat = vec![None; joined.len()];
        Self { log_area, joined, siblings, flat }
    }

    /// Replaces what it holds of the rooms of a flat by what the flat alone shows.
    pub fn put(&mut self, flat: &[usize], index: usize, alone: &Self) {
        let named = |rooms: &[usize]| rooms.iter().map(|&room| flat[room]).collect();
        for (place, &room) in flat.iter().enumerate() {
            self.joined[room] = named(&alone.joined[place]);
            self.siblings[room] = named(&alone.siblings[place]);
            self.flat[room] = Some(index);
        }
    }

    /// The rooms that a room is compared with, itself included: those of its flat, or of the whole plan.
    pub fn compared_with(&self, room: usize) -> Vec<usize> {
        let flat = self.flat[room];
        (0..self.flat.len()).filter(|&other| flat.is_none() || self.flat[other] == flat).collect()
    }
}

fn log(number: f64) -> f64 {
    number.max(LEAST).ln()
}

fn most(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.reduce(f64::max).unwrap_or_default()
}

fn count(items: impl Iterator<Item = bool>) -> f64 {
    items.filter(|&is| is).count() as f64
}

fn sorted(numbers: &[f64]) -> Vec<f64> {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// How many of the sorted numbers are at most this, within [`EQUAL`].
fn within(sorted: &[f64], low: f64, high: f64) -> usize {
    sorted.partition_point(|&number| number <= high).saturating_sub(sorted.partition_point(|&number| number < low))
}

/// For each number the share of the others that are smaller; ties count half.
fn ranks(numbers: &[f64]) -> Vec<f64> {
    let sorted = sorted(numbers);
    let others = (numbers.len().max(2) - 1) as f64;
    numbers
        .iter()
        .map(|&number| {
            let smaller = sorted.partition_point(|&other| other < number - EQUAL) as f64;
            let equal = within(&sorted, number - EQUAL, number + EQUAL) as f64 - 1.0;
            (smaller + equal / 2.0) / others
        })
        .collect()
}

/// Results of searching the graph, for each room.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Search {
    /// Share of the shortest paths between other rooms that pass through it (Freeman 1977).
    betweenness: f64,
    /// One over the mean number of steps to the reachable rooms.
    closeness: f64,
    farthest: f64,
    /// Share of all rooms that are reachable, itself included.
    reach: f64,
}

/// Which rooms are joined, one list after the other: quicker to go through than a list for each room.
struct Joined {
    /// Where each room's list begins, and where the last ends.
    starts: Vec<u32>,
    rooms: Vec<u32>,
}

impl Joined {
    fn new(joined: &[Vec<usize>]) -> Self {
        let mut starts = Vec::with_capacity(joined.len() + 1);
        starts.push(0);
        let mut rooms = Vec::new();
        for of_room in joined {
            rooms.extend(of_room.iter().map(|&other| other as u32));
            starts.push(rooms.len() as u32);
        }
        Self { starts, rooms }
    }

    fn of(&self, room: u32) -> &[u32] {
        let room = room as usize;
        &self.rooms[self.starts[room] as usize..self.starts[room + 1] as usize]
    }
}

/// Not reached in a search.
const NOWHERE: u32 = u32::MAX;

/// Searches the graph breadth-first from every room; betweenness after Brandes (2001).
pub(super) fn search(joined: &[Vec<usize>]) -> Vec<Search> {
    let rooms = joined.len();
    let mut found = vec![Search::default(); rooms];
    let stride = rooms.div_ceil(MOST_SEARCHES).max(1);
    let joined = Joined::new(joined);
    // Only what a search has reached is reset after it.
    let mut steps: Vec<u32> = vec![NOWHERE; rooms];
    let mut ways = vec![0.0; rooms];
    let mut from_here = vec![0.0; rooms];
    let mut order: Vec<u32> = Vec::with_capacity(rooms);
    for start in (0..rooms).step_by(stride) {
        order.clear();
        order.push(start as u32);
        (steps[start], ways[start]) = (0, 1.0);
        let mut at = 0;
        while let Some(&room) = order.get(at) {
            at += 1;
            let (next, ways_here) = (steps[room as usize] + 1, ways[room as usize]);
            for &other in joined.of(room) {
                let other_at = other as usize;
                if steps[other_at] == NOWHERE {
                    steps[other_at] = next;
                    order.push(other);
                }
                if steps[other_at] == next {
                    ways[other_at] += ways_here;
                }
            }
        }
        let reached = order.len() as f64;
        let sum: f64 = order.iter().map(|&room| f64::from(steps[room as usize])).sum();
        let farthest = order.last().map_or(0, |&room| steps[room as usize]);
        found[start].closeness = if sum > 0.0 { (reached - 1.0) / sum } else { 0.0 };
        found[start].farthest = f64::from(farthest);
        found[start].reach = reached / rooms as f64;
        let pairs = ((reached - 1.0) * (reached - 2.0)).max(1.0) / stride as f64;
        for &room in order.iter().rev() {
            let at = room as usize;
            if at == start {
                continue;
            }
            let before = steps[at] - 1;
            for &other in joined.of(room) {
                let other = other as usize;
                if steps[other] == before {
                    from_here[other] += ways[other] / ways[at] * (1.0 + from_here[at]);
                }
            }
            found[at].betweenness += from_here[at] / pairs;
        }
        for &room in &order {
            (steps[room as usize], ways[room as usize], from_here[room as usize]) = (NOWHERE, 0.0, 0.0);
        }
    }
    if stride > 1 {
        // Rooms that were not searched from take the result of the last one before them.
        for room in 0..rooms {
            let Search { closeness, farthest, reach, .. } = found[room / stride * stride];
            found[room] = Search { closeness, farthest, reach, ..found[room] };
        }
    }
    found
}

/// For each room the steps to the nearest target; one more than the longest possible path if there is
/// none.
fn steps_to(joined: &[Vec<usize>], targets: impl Iterator<Item = usize>) -> Vec<f64> {
    let mut steps = vec![None; joined.len()];
    let mut queue: VecDeque<usize> = targets.collect();
    for &target in &queue {
        steps[target] = Some(0);
    }
    while let Some(room) = queue.pop_front() {
        let next = steps[room].map(|steps: u32| steps + 1);
        for &other in &joined[room] {
            if steps[other].is_none() {
                steps[other] = next;
                queue.push_back(other);
            }
        }
    }
    steps.into_iter().map(|steps| steps.map_or(joined.len() as f64, f64::from)).collect()
}

/// For each room the number of others that are [`ALIKE`] in both numbers. Takes time proportional to n log n: rooms
/// sorted by the first number enter and leave a window, within which those near in the second are counted.
fn alike_in_both(first: &[f64], second: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..first.len()).collect();
    order.sort_by(|&p, &q| first[p].total_cmp(&first[q]));
    let seconds = sorted(second);
    let place_of = |number: f64| seconds.partition_point(|&other| other < number);
    // A binary indexed tree of how many in the window have each place (Fenwick 1994).
    let mut tree = vec![0_i64; second.len() + 1];
    let add = |tree: &mut Vec<i64>, place: usize, by: i64| {
        let mut at = place + 1;
        while at < tree.len() {
            tree[at] += by;
            at += at & at.wrapping_neg();
        }
    };
    let before = |tree: &[i64], place: usize| {
        let (mut at, mut sum) = (place, 0);
        while at > 0 {
            sum += tree[at];
            at -= at & at.wrapping_neg();
        }
        sum
    };
    let mut alike = vec![0.0; first.len()];
    let (mut enters, mut leaves) = (0, 0);
    for &room in &order {
        while enters < order.len() && first[order[enters]] <= first[room] + ALIKE {
            add(&mut tree, place_of(second[order[enters]]), 1);
            enters += 1;
        }
        while first[order[leaves]] < first[room] - ALIKE {
            add(&mut tree, place_of(second[order[leaves]]), -1);
            leaves += 1;
        }
        let low = seconds.partition_point(|&other| other - second[room] < -ALIKE);
        let high = seconds.partition_point(|&other| other - second[room] <= ALIKE);
        alike[room] = (before(&tree, high) - before(&tree, low)) as f64 - 1.0;
    }
    alike
}

/// The features of every room of a network, each list as long as [`FEATURES`]; all finite.
/// `places` are what [`search`] finds of the rooms that the view joins.
pub(super) fn features(network: &RoomNetwork, view: &View, places: &[Search]) -> Vec<Vec<f32>> {
    let View { log_area, joined, siblings, .. } = view;
    let rooms = &network.rooms;
    let all = rooms.len() as f64;
    let areas = sorted(log_area);
    let median = quantile(&areas, 0.5);
    let largest = areas.last().copied().unwrap_or_default();
    let total = log(rooms.iter().map(|room| room.area_m2).sum());
    // The side of a square of the median area.
    let side = median / 2.0;
    let log_length: Vec<f64> = rooms.iter().map(|room| log(room.form.length_m)).collect();
    let log_width: Vec<f64> = rooms.iter().map(|room| log(room.form.width_m)).collect();
    let aspect: Vec<f64> = log_length.iter().zip(&log_width).map(|(length, width)| length - width).collect();
    let doors: Vec<f64> = rooms.iter().map(|room| room.doors.len() as f64).collect();
    let degree: Vec<f64> = joined.iter().map(|joined| joined.len() as f64).collect();
    let passages: Vec<f64> =
        rooms.iter().map(|room| count(room.doors.iter().map(|door| door.kind == OpeningKind::Passage))).collect();
    let most_joined = most(degree.iter().copied());
    let (area_rank, door_rank) = (ranks(log_area), ranks(&doors));
    let (length_rank, width_rank) = (ranks(&log_length), ranks(&log_width));
    let closeness: Vec<f64> = places.iter().map(|place| place.closeness).collect();
    let closeness_rank = ranks(&closeness);
    let mean_closeness = mean(closeness.iter().copied()).unwrap_or_default();
    let hubs = (0..rooms.len()).filter(|&room| degree[room] == most_joined);
    let to_hub = steps_to(joined, hubs);
    let of_area: Vec<f64> =
        log_area.iter().map(|&area| within(&areas, area - ALIKE, area + ALIKE) as f64 - 1.0).collect();
    // The mean of equally common areas, so that the rooms' order does not matter.
    let most_common = most(of_area.iter().copied());
    let common = (0..rooms.len()).filter(|&room| of_area[room] == most_common).map(|room| log_area[room]);
    let common = mean(common).unwrap_or_default();
    let mean_area = mean(log_area.iter().copied()).unwrap_or_default();
    let spread = mean(log_area.iter().map(|area| (area - mean_area).powi(2))).unwrap_or_default().sqrt();
    let plan = [
        all,
        median,
        spread,
        quantile(&areas, 0.1) - median,
        quantile(&areas, 0.9) - median,
        largest - median,
        mean(doors.iter().copied()).unwrap_or_default(),
        count(degree.iter().map(|&degree| degree <= 1.0)) / all.max(1.0),
        most_joined,
        count(rooms.iter().map(|room| log(room.axes_ratio) > 1.0)) / all.max(1.0),
        mean(passages.iter().copied()).unwrap_or_default(),
    ];
    let of_area_and_shape = alike_in_both(log_area, &aspect);
    let others = (all - 1.0).max(1.0);
    (0..rooms.len())
        .map(|index| {
            let (room, area) = (&rooms[index], log_area[index]);
            let neighbours = || joined[index].iter().copied();
            let ends = count(neighbours().map(|other| degree[other] <= 1.0));
            let related = |pick: fn(f64, f64) -> f64| neighbours().map(|other| log_area[other]).reduce(pick);
            let (largest_neighbour, smallest_neighbour) = (related(f64::max), related(f64::min));
            let beside = |area_beside: Option<f64>| area_beside.map_or(0.0, |beside| beside - area);
            let siblings = &siblings[index];
            let sibling_areas: Vec<f64> = siblings.iter().map(|&other| log_area[other]).collect();
            let same = of_area_and_shape[index];
            let own = [
                area - median,
                area - largest,
                area - total,
                area_rank[index],
                area,
                // Size above, form below.
                log(room.axes_ratio),
                aspect[index],
                log(room.form.perimeter_m) - area / 2.0,
                room.form.convexity,
                room.form.fill(room.area_m2),
                f64::from(room.form.walls),
                log_length[index] - side,
                log_width[index] - side,
                length_rank[index],
                width_rank[index],
                // Openings.
                doors[index],
                degree[index],
                degree[index] / most_joined.max(1.0),
                door_rank[index],
                doors[index] / room.form.perimeter_m.max(LEAST) * side.exp(),
                passages[index],
                count(room.doors.iter().map(|door| door.kind == OpeningKind::DoubleDoor)),
                count(room.doors.iter().map(|door| door.to.is_none())),
                count(room.doors.iter().map(|door| door.to.is_some())) - degree[index],
                // Place.
                places[index].betweenness,
                closeness[index] - mean_closeness,
                closeness_rank[index],
                places[index].farthest,
                to_hub[index],
                places[index].reach,
                // Neighbours.
                ends,
                ends / degree[index].max(1.0),
                beside(mean(neighbours().map(|other| log_area[other]))),
                beside(largest_neighbour),
                beside(smallest_neighbour),
                largest_neighbour.map_or(0.0, |beside| beside - median),
                most(neighbours().map(|other| degree[other])),
                mean(neighbours().map(|other| degree[other])).unwrap_or_default(),
                most(neighbours().map(|other| log(rooms[other].axes_ratio))),
                most(neighbours().map(|other| places[other].betweenness)),
                count(neighbours().map(|other| log_area[other] - median < SMALL)),
                count(neighbours().map(|other| log_area[other] - median > LARGE)),
                mean(neighbours().map(|other| f64::from(u8::from(log_area[other] > area + EQUAL)))).unwrap_or(0.5),
                // Alike.
                of_area[index],
                of_area[index] / others,
                same,
                same / others,
                area - common,
                siblings.len() as f64,
                if siblings.is_empty() { 0.0 } else { quantile(&sorted(&sibling_areas), 0.5) - area },
                count(sibling_areas.iter().map(|other| (other - area).abs() <= ALIKE)),
            ];
            let numbers = own.iter().chain(&plan).map(|&number| number as f32);
            numbers.map(|number| if number.is_finite() { number } else { 0.0 }).collect()
        })
        .collect()
}
