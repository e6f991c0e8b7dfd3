//! What the joint classifier sees of each room before any label is known: the room in relation to the
//! other rooms of its plan. Nothing here comes from a room's name or function.

use super::places::Place;
use super::rows::Rows;
use crate::base::lists::Lists;
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

/// Per-room lists of a plan from which features and labels around rooms are computed.
#[derive(Clone, Debug)]
pub(super) struct View {
    /// Natural logarithm of the area in m².
    pub log_area: Vec<f64>,
    /// The rooms its openings lead to, without repeats, ascending.
    pub joined: Lists,
    /// The rooms that a room joins, for each room that may be another's best connected neighbour.
    pub families: Lists,
    /// For each room the family of its best connected neighbour; `None` for one without neighbours.
    family_of: Vec<Option<u32>>,
    /// The flat that each room is in, from 0; `None` outside flats, in any plan that is no storey of flats.
    pub flat: Vec<Option<usize>>,
}

impl View {
    pub fn new(network: &RoomNetwork) -> Self {
        let rooms = &network.rooms;
        let log_area: Vec<f64> = rooms.iter().map(|room| log(room.area_m2)).collect();
        let doors = rooms.iter().map(|room| room.doors.len()).sum();
        let mut joined = Lists::with_capacity(rooms.len(), doors);
        for room in rooms {
            joined.push_distinct(room.doors.iter().filter_map(|door| Some(door.to? as u32)));
        }
        let degree = |room: u32| joined.of(room as usize).len();
        let hub = |of_room: &[u32]| {
            // Equally connected neighbours of equal area lead to as many siblings: which is taken
            // matters little, and the rooms' order decides.
            let by_area = |p: u32, q: u32| log_area[p as usize].total_cmp(&log_area[q as usize]);
            of_room.iter().copied().max_by(|&p, &q| degree(p).cmp(&degree(q)).then_with(|| by_area(p, q)))
        };
        let family_of = joined.iter().map(hub).collect();
        let flat = vec![None; rooms.len()];
        Self { log_area, families: joined.clone(), joined, family_of, flat }
    }

    /// Replaces what it holds of the rooms of flats by what each flat alone shows.
    pub fn put(&mut self, flats: &[Vec<usize>], alone: &[Self]) {
        let mut place_of: Vec<Option<(usize, usize)>> = vec![None; self.flat.len()];
        for ((index, flat), alone) in flats.iter().enumerate().zip(alone) {
            let families = self.families.len() as u32;
            let named = |rooms: &[u32]| rooms.iter().map(|&room| flat[room as usize] as u32).collect::<Vec<_>>();
            for (place, &room) in flat.iter().enumerate() {
                place_of[room] = Some((index, place));
                self.families.push(named(alone.families.of(place)));
                self.family_of[room] = alone.family_of[place].map(|family| families + family);
                self.flat[room] = Some(index);
            }
        }
        let mut joined = Lists::default();
        for (room, place) in place_of.into_iter().enumerate() {
            match place {
                None => joined.push(self.joined.of(room).iter().copied()),
                Some((index, place)) => {
                    joined.push(alone[index].joined.of(place).iter().map(|&other| flats[index][other as usize] as u32));
                }
            }
        }
        self.joined = joined;
    }

    /// The rooms that a room joins.
    pub fn joined(&self, room: usize) -> impl ExactSizeIterator<Item = usize> + Clone + '_ {
        self.joined.of(room).iter().map(|&other| other as usize)
    }

    /// The family that a room is one of: by its index in [`View::families`].
    pub fn family(&self, room: usize) -> Option<usize> {
        self.family_of[room].map(|family| family as usize)
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

/// Numbers in order, and where each one stands.
struct Order {
    sorted: Vec<f64>,
    /// The places of the numbers, in the order of the numbers.
    places: Vec<u32>,
}

impl Order {
    fn new(numbers: &[f64]) -> Self {
        let mut pairs: Vec<(f64, u32)> = numbers.iter().copied().zip(0..).collect();
        pairs.sort_unstable_by(|p, q| p.0.total_cmp(&q.0));
        Self { sorted: pairs.iter().map(|pair| pair.0).collect(), places: pairs.iter().map(|pair| pair.1).collect() }
    }

    /// Goes through the numbers in order. `tell` is told of each its place, how many numbers are below it by more than
    /// `within`, and how many are above it by at most that, those below included.
    fn windows(&self, within: f64, mut tell: impl FnMut(usize, usize, usize)) {
        let (mut below, mut up_to) = (0, 0);
        for (&number, &place) in self.sorted.iter().zip(&self.places) {
            while self.sorted.get(below).is_some_and(|&other| other < number - within) {
                below += 1;
            }
            while self.sorted.get(up_to).is_some_and(|&other| other <= number + within) {
                up_to += 1;
            }
            tell(place as usize, below, up_to);
        }
    }

    /// For each number the share of the others that are smaller; those within [`EQUAL`] count half.
    fn ranks(&self) -> Vec<f64> {
        let others = (self.sorted.len().max(2) - 1) as f64;
        let mut ranks = vec![0.0; self.sorted.len()];
        self.windows(EQUAL, |place, below, up_to| {
            let equal = up_to.saturating_sub(below) as f64 - 1.0;
            ranks[place] = (below as f64 + equal / 2.0) / others;
        });
        ranks
    }

    /// For each number how many others are [`ALIKE`].
    fn alike(&self) -> Vec<f64> {
        let mut alike = vec![0.0; self.sorted.len()];
        self.windows(ALIKE, |place, below, up_to| alike[place] = up_to.saturating_sub(below) as f64 - 1.0);
        alike
    }
}

fn ranks(numbers: &[f64]) -> Vec<f64> {
    Order::new(numbers).ranks()
}

/// The areas of a family's rooms, for what each of them shows of the others.
struct Family<'a>(&'a [f64]);

impl Family<'_> {
    /// Of all but one of this area: the median, and how many are [`ALIKE`] to it.
    fn without(&self, area: f64) -> (f64, f64) {
        let at = self.0.partition_point(|&other| other < area);
        let others = self.0.len().saturating_sub(1);
        let of = |place: usize| self.0[if place < at { place } else { place + 1 }];
        let middle = 0.5 * others.saturating_sub(1) as f64;
        let below = middle.floor() as usize;
        let median = match others {
            0 => 0.0,
            _ => of(below) + (middle - below as f64) * (of((below + 1).min(others - 1)) - of(below)),
        };
        let low = self.0.partition_point(|&other| other - area < -ALIKE);
        let high = self.0.partition_point(|&other| other - area <= ALIKE);
        (median, high.saturating_sub(low) as f64 - 1.0)
    }
}

/// For each room the steps to the nearest target; one more than the longest possible path if there is
/// none.
fn steps_to(joined: &Lists, targets: impl Iterator<Item = usize>) -> Vec<f64> {
    let mut steps = vec![u32::MAX; joined.len()];
    let mut queue: Vec<u32> = targets.map(|target| target as u32).collect();
    for &target in &queue {
        steps[target as usize] = 0;
    }
    let mut at = 0;
    while let Some(&room) = queue.get(at) {
        at += 1;
        let next = steps[room as usize] + 1;
        for &other in joined.of(room as usize) {
            if steps[other as usize] == u32::MAX {
                steps[other as usize] = next;
                queue.push(other);
            }
        }
    }
    let nowhere = joined.len() as f64;
    steps.into_iter().map(|steps| if steps == u32::MAX { nowhere } else { f64::from(steps) }).collect()
}

/// For each room the number of others that are [`ALIKE`] in both numbers. Takes time proportional to n log n: rooms
/// in the order of the first number enter and leave a window, within which those near in the second are counted.
fn alike_in_both(first: &Order, second: &Order) -> Vec<f64> {
    let count = first.sorted.len();
    // For each room where its second number stands, and where those alike begin and end.
    let mut place_of = vec![0_u32; count];
    let mut window = vec![(0_u32, 0_u32); count];
    let (mut low, mut high) = (0, 0);
    for (place, (&number, &room)) in second.sorted.iter().zip(&second.places).enumerate() {
        while second.sorted.get(low).is_some_and(|&other| other - number < -ALIKE) {
            low += 1;
        }
        while second.sorted.get(high).is_some_and(|&other| other - number <= ALIKE) {
            high += 1;
        }
        place_of[room as usize] = place as u32;
        window[room as usize] = (low as u32, high as u32);
    }
    // A binary indexed tree of how many in the window have each place (Fenwick 1994).
    let mut tree = vec![0_i32; count + 1];
    let add = |tree: &mut [i32], place: u32, by: i32| {
        let mut at = place as usize + 1;
        while let Some(slot) = tree.get_mut(at) {
            *slot += by;
            at += at & at.wrapping_neg();
        }
    };
    let before = |tree: &[i32], place: u32| {
        let (mut at, mut sum) = (place as usize, 0);
        while at > 0 {
            sum += tree[at];
            at -= at & at.wrapping_neg();
        }
        sum
    };
    let mut alike = vec![0.0; count];
    let (mut enters, mut leaves) = (0, 0);
    for (&number, &room) in first.sorted.iter().zip(&first.places) {
        while enters < count && first.sorted[enters] <= number + ALIKE {
            add(&mut tree, place_of[first.places[enters] as usize], 1);
            enters += 1;
        }
        while first.sorted[leaves] < number - ALIKE {
            add(&mut tree, place_of[first.places[leaves] as usize], -1);
            leaves += 1;
        }
        let (low, high) = window[room as usize];
        alike[room as usize] = f64::from(before(&tree, high) - before(&tree, low)) - 1.0;
    }
    alike
}

/// The features of every room of a network, each row as long as [`FEATURES`]; all finite.
/// `places` are those of the rooms that the view joins.
pub(super) fn features(network: &RoomNetwork, view: &View, places: &[Place]) -> Rows {
    let View { log_area, joined, families, .. } = view;
    let rooms = &network.rooms;
    let all = rooms.len() as f64;
    let by_area = Order::new(log_area);
    let areas = &by_area.sorted;
    let median = quantile(areas, 0.5);
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
    let (area_rank, door_rank) = (by_area.ranks(), ranks(&doors));
    let (length_rank, width_rank) = (ranks(&log_length), ranks(&log_width));
    let closeness: Vec<f64> = places.iter().map(|place| place.closeness).collect();
    let closeness_rank = ranks(&closeness);
    let mean_closeness = mean(closeness.iter().copied()).unwrap_or_default();
    let hubs = (0..rooms.len()).filter(|&room| degree[room] == most_joined);
    let to_hub = steps_to(joined, hubs);
    let of_area = by_area.alike();
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
        quantile(areas, 0.1) - median,
        quantile(areas, 0.9) - median,
        largest - median,
        mean(doors.iter().copied()).unwrap_or_default(),
        count(degree.iter().map(|&degree| degree <= 1.0)) / all.max(1.0),
        most_joined,
        count(rooms.iter().map(|room| log(room.axes_ratio) > 1.0)) / all.max(1.0),
        mean(passages.iter().copied()).unwrap_or_default(),
    ];
    let of_area_and_shape = alike_in_both(&by_area, &Order::new(&aspect));
    let others = (all - 1.0).max(1.0);
    // The areas of each family, in order.
    let mut family_areas: Vec<f64> = Vec::new();
    let mut family_starts: Vec<usize> = Vec::with_capacity(families.len() + 1);
    family_starts.push(0);
    for family in families.iter() {
        let from = family_areas.len();
        family_areas.extend(family.iter().map(|&room| log_area[room as usize]));
        family_areas[from..].sort_unstable_by(f64::total_cmp);
        family_starts.push(family_areas.len());
    }
    let mut rows = Rows::with_capacity(FEATURES.len(), rooms.len());
    for (index, room) in rooms.iter().enumerate() {
        let area = log_area[index];
        let neighbours = || view.joined(index);
        let ends = count(neighbours().map(|other| degree[other] <= 1.0));
        let related = |pick: fn(f64, f64) -> f64| neighbours().map(|other| log_area[other]).reduce(pick);
        let (largest_neighbour, smallest_neighbour) = (related(f64::max), related(f64::min));
        let beside = |area_beside: Option<f64>| area_beside.map_or(0.0, |beside| beside - area);
        let family = view.family(index).map(|family| &family_areas[family_starts[family]..family_starts[family + 1]]);
        let siblings = family.map_or(0, |family| family.len() - 1);
        let (sibling_median, siblings_alike) = family.map_or((0.0, 0.0), |family| Family(family).without(area));
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
            siblings as f64,
            if siblings == 0 { 0.0 } else { sibling_median - area },
            siblings_alike,
        ];
        let numbers = own.iter().chain(&plan).map(|&number| number as f32);
        rows.push(numbers.map(|number| if number.is_finite() { number } else { 0.0 }));
    }
    rows
}
