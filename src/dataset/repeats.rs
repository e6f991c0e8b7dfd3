//! The same room read twice: a plan beside its export, a file named twice, a copy under another name. Learning from one reading
//! and testing on the other would flatter; so would two storeys that are nearly the same. Found by what rooms look like and where
//! they lie in their plans ([`RoomPrint`]), and by ids, whatever files and plans are called.
//!
//! Each plan is compared with a few earlier ones that share rare rooms with it, so the time grows with the number of rooms. One file,
//! somewhat long: what counts as the same is decided here alone, and its steps make no sense without each other.

use std::collections::{BTreeMap, HashMap};

use super::fingerprint::{Prints, RoomPrint};
use crate::features::Analysis;
use crate::formats::{self, building_name};
use crate::geometry::{Point, Vector};
use crate::labels::Label;
use crate::plan::titles::room_keys;
use crate::plan::{Plan, RoomId};

/// One reading of a plan.
#[derive(Clone, Debug)]
pub struct Sighting {
    /// Where it was read from, for people.
    pub file: String,
    /// A hash of the file's bytes; empty where unknown.
    pub content: String,
    /// Which plan of its file, from 0.
    pub storey_of_file: usize,
    /// As in the plan.
    pub plan: String,
    /// The building, however it is spelled.
    pub building: String,
    pub storey: String,
    /// Whether the file states the storey; else it was read off the file's name, where 'office2' may be a copy.
    pub is_storey_stated: bool,
    pub rooms: Vec<SightedRoom>,
}

/// A room of a [`Sighting`].
#[derive(Clone, Debug)]
pub struct SightedRoom {
    pub id: RoomId,
    pub source_id: String,
    /// What it is called in tables.
    pub key: String,
    pub function: String,
    /// Where it is known.
    pub label: Option<Label>,
    pub print: RoomPrint,
}

/// How two readings relate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Likeness {
    /// The same plan, or a part of it: each room counts once.
    Same,
    /// Different plans with many rooms of the same shape in the same places: stacked storeys, or buildings after one drawing.
    /// All their rooms count, in one fold.
    Twins,
}

/// Two readings that have rooms in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Indices of the sightings.
    pub first: usize,
    pub second: usize,
    pub likeness: Likeness,
    /// Rooms in common, by their indices in the first and in the second.
    pub rooms: Vec<(usize, usize)>,
}

/// A room by its sighting and its index there.
pub type Place = (usize, usize);

/// What was read twice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repeats {
    /// By the second of each.
    pub pairs: Vec<Pair>,
    /// Rooms that are left out, each with the reading that is kept in its place.
    pub left_out: BTreeMap<Place, Place>,
}

/// From this share of the smaller plan's rooms in common two plans are twins.
const TWIN_SHARE: f64 = 0.3;

/// From this share in common, with ids in common too, two readings are of one plan that was changed between them.
const SAME_SHARE_WITH_IDS: f64 = 0.5;

/// Without ids in common it takes this share: two storeys seldom agree in all but one room of ten.
const SAME_SHARE: f64 = 0.9;

/// Fewer rooms of equal shape may be chance, unless they are called the same.
const LEAST_ROOMS: usize = 3;

/// So many earlier plans are remembered for each hash: a room that more plans have in common tells little.
const PLANS_A_HASH: usize = 8;

/// Rooms remembered for each hash: a building may have a hundred rooms alike.
const ROOMS_A_HASH: usize = 32;

/// So many earlier plans are looked at for each plan, those that share most rooms with it first.
const PLANS_COMPARED: usize = 6;

/// Centres of rooms in the same place are not further apart, in metres.
const SAME_PLACE_M: f64 = 0.03;

/// The same where rooms need only be alike.
const NEAR_PLACE_M: f64 = 0.4;

/// An id of a source that is shorter ('R12') may be another room's in another plan.
const TELLING_ID: usize = 10;

impl Repeats {
    /// Looks for what was read twice. Of a room that was, the first reading with a label is kept; without labels, the first.
    pub fn find(sightings: &[Sighting]) -> Self {
        let mut exact = Index::default();
        let mut rough = Index::default();
        let mut by_content: HashMap<(&str, usize), usize> = HashMap::new();
        let mut pairs: Vec<Pair> = Vec::new();
        for (second, seen) in sightings.iter().enumerate() {
            let before = pairs.len();
            let content = (seen.content.as_str(), seen.storey_of_file);
            let same_bytes = by_content.get(&content).copied().filter(|_| !seen.content.is_empty());
            if let Some(first) = same_bytes {
                let rooms = (0..seen.rooms.len()).map(|room| (room, room)).collect();
                pairs.push(Pair { first, second, likeness: Likeness::Same, rooms });
                continue;
            }
            by_content.insert(content, second);
            let hashes = |hash: fn(&RoomPrint) -> Vec<u32>| seen.rooms.iter().map(move |room| hash(&room.print));
            let ids = || seen.rooms.iter().map(|room| telling_id(room).map(hash_of_text).into_iter().collect());
            let candidates: Vec<usize> = exact.candidates(hashes(RoomPrint::hashes).chain(ids()));
            for first in candidates {
                pairs.extend(compare(sightings, first, second));
                if pairs.last().is_some_and(|pair| is_whole(sightings, pair)) {
                    break;
                }
            }
            let is_known = pairs.last().is_some_and(|pair| is_whole(sightings, pair) && pair.second == second);
            if !is_known {
                for first in rough.candidates(hashes(RoomPrint::rough_hashes)) {
                    if !pairs[before..].iter().any(|pair| pair.first == first) {
                        pairs.extend(compare_roughly(sightings, first, second));
                    }
                }
                exact.add(second, seen.rooms.iter().map(|room| vec![room.print.hash()]).chain(ids()));
                rough.add(second, seen.rooms.iter().map(|room| vec![room.print.rough_hashes()[0]]));
            }
        }
        let left_out = left_out(sightings, &pairs);
        Self { pairs, left_out }
    }

    /// For each sighting a group, so that twins and readings of one plan are in one: the smallest index of its sightings.
    pub fn groups(&self, sightings: usize) -> Vec<usize> {
        let mut group: Vec<usize> = (0..sightings).collect();
        for pair in &self.pairs {
            let (p, q) = (root(&mut group, pair.first), root(&mut group, pair.second));
            group[p.max(q)] = p.min(q);
        }
        (0..sightings).map(|index| root(&mut group, index)).collect()
    }

    /// The rooms of a pair that are labelled in both readings, and otherwise in the second.
    pub fn contradictions<'a>(
        &self,
        sightings: &'a [Sighting],
        pair: &Pair,
    ) -> Vec<(&'a SightedRoom, &'a SightedRoom)> {
        let rooms = |&(p, q): &(usize, usize)| (&sightings[pair.first].rooms[p], &sightings[pair.second].rooms[q]);
        let differ =
            |(p, q): &(&SightedRoom, &SightedRoom)| p.label.is_some() && q.label.is_some() && p.label != q.label;
        pair.rooms.iter().map(rooms).filter(differ).collect()
    }
}

/// The group that an index stands for, with paths made short on the way.
fn root(group: &mut [usize], mut index: usize) -> usize {
    while group[index] != index {
        group[index] = group[group[index]];
        index = group[index];
    }
    index
}

/// Whether every room of the second was read before.
fn is_whole(sightings: &[Sighting], pair: &Pair) -> bool {
    pair.likeness == Likeness::Same && pair.rooms.len() == sightings[pair.second].rooms.len()
}

/// The source's id where it is long enough to be no other room's.
fn telling_id(room: &SightedRoom) -> Option<&str> {
    Some(room.source_id.as_str()).filter(|id| id.chars().count() >= TELLING_ID)
}

fn hash_of_text(text: &str) -> u32 {
    let hash = crate::base::hash::fnv1a(crate::base::hash::START, text.bytes());
    (hash ^ (hash >> 32)) as u32
}

/// Earlier plans by the hashes of their rooms. Only looked up, never gone through: the order of a hash map shows nowhere.
#[derive(Default)]
struct Index(HashMap<u32, Vec<usize>>);

impl Index {
    fn add(&mut self, plan: usize, rooms: impl Iterator<Item = Vec<u32>>) {
        for hash in rooms.flatten() {
            let plans = self.0.entry(hash).or_default();
            if plans.last() != Some(&plan) && plans.len() < PLANS_A_HASH {
                plans.push(plan);
            }
        }
    }

    /// The plans that share most with these rooms, most first; rare rooms count more.
    fn candidates(&self, rooms: impl Iterator<Item = Vec<u32>>) -> Vec<usize> {
        let mut shared: BTreeMap<usize, f64> = BTreeMap::new();
        for hashes in rooms {
            let mut found: BTreeMap<usize, f64> = BTreeMap::new();
            for hash in hashes {
                let plans = self.0.get(&hash).map(Vec::as_slice).unwrap_or_default();
                for plan in plans {
                    found.insert(*plan, 1.0 / plans.len() as f64);
                }
            }
            for (plan, weight) in found {
                *shared.entry(plan).or_default() += weight;
            }
        }
        let mut plans: Vec<(usize, f64)> = shared.into_iter().collect();
        plans.sort_by(|p, q| q.1.total_cmp(&p.1).then(p.0.cmp(&q.0)));
        plans.into_iter().take(PLANS_COMPARED).map(|(plan, _)| plan).collect()
    }
}

/// Whether two readings are of one plan, or of twins; `None` where they are neither.
fn compare(sightings: &[Sighting], first: usize, second: usize) -> Option<Pair> {
    let (p, q) = (&sightings[first], &sightings[second]);
    let smaller = p.rooms.len().min(q.rooms.len());
    let pair = |likeness, rooms| Some(Pair { first, second, likeness, rooms });
    let hashes = |print: &RoomPrint| print.hashes();
    let mut rooms = in_place(p, q, &seeds(p, q, &hashes), SAME_PLACE_M, 0.002);
    let by_id = by_id(p, q);
    // The same drawing at another scale has the same ids, and sizes in one proportion.
    if by_id.len() > rooms.len()
        && by_id.len() >= LEAST_ROOMS
        && by_id.len() * 2 >= smaller
        && in_proportion(p, q, &by_id)
    {
        rooms.clone_from(&by_id);
    }
    if rooms.is_empty() {
        return None;
    }
    let share = rooms.len() as f64 / smaller.max(1) as f64;
    let called_the_same = rooms.iter().filter(|&&(a, b)| is_called_the_same(&p.rooms[a], &q.rooms[b])).count();
    let telling = rooms.iter().filter(|&&(a, b)| {
        let (a, b) = (&p.rooms[a], &q.rooms[b]);
        telling_id(a).is_some() && telling_id(a) == telling_id(b) || a.source_id.is_empty() && a.id == b.id
    });
    let telling = telling.count();
    if rooms.len() < LEAST_ROOMS && (called_the_same < rooms.len() || share < 1.0) {
        return None;
    }
    let other_storey = p.building == q.building && p.storey != q.storey && !p.storey.is_empty() && !q.storey.is_empty();
    if other_storey && (p.is_storey_stated && q.is_storey_stated || called_the_same < rooms.len()) {
        return if share >= TWIN_SHARE { pair(Likeness::Twins, rooms) } else { None };
    }
    if share >= SAME_SHARE || share >= SAME_SHARE_WITH_IDS && telling * 2 >= rooms.len() {
        // Rooms that were changed between the two readings kept their ids.
        let (in_first, in_second): (Vec<usize>, Vec<usize>) = rooms.iter().copied().unzip();
        let changed = by_id.into_iter().filter(|(a, b)| !in_first.contains(a) && !in_second.contains(b));
        rooms.extend(changed.collect::<Vec<_>>());
        rooms.sort_unstable();
        return pair(Likeness::Same, rooms);
    }
    if share >= TWIN_SHARE { pair(Likeness::Twins, rooms) } else { None }
}

/// Whether two plans are twins that were drawn one by one.
fn compare_roughly(sightings: &[Sighting], first: usize, second: usize) -> Option<Pair> {
    /// From this share of the larger plan's rooms.
    const SHARE: f64 = 0.6;
    /// With fewer rooms, chance would do it.
    const LEAST: usize = 6;
    let (p, q) = (&sightings[first], &sightings[second]);
    let larger = p.rooms.len().max(q.rooms.len());
    let smaller = p.rooms.len().min(q.rooms.len());
    if smaller < LEAST || (smaller as f64) < SHARE * larger as f64 {
        return None;
    }
    let hashes = |print: &RoomPrint| print.rough_hashes();
    let rooms = in_place(p, q, &seeds(p, q, &hashes), NEAR_PLACE_M, 0.06);
    let is_twin = rooms.len() >= LEAST && rooms.len() as f64 >= SHARE * larger as f64;
    is_twin.then_some(Pair { first, second, likeness: Likeness::Twins, rooms })
}

fn is_called_the_same(a: &SightedRoom, b: &SightedRoom) -> bool {
    (a.id == b.id || !a.source_id.is_empty() && a.source_id == b.source_id || a.key == b.key)
        && a.function == b.function
}

/// Rooms that have one telling id in both.
fn by_id(p: &Sighting, q: &Sighting) -> Vec<(usize, usize)> {
    let of: BTreeMap<&str, usize> =
        p.rooms.iter().enumerate().filter_map(|(index, room)| Some((telling_id(room)?, index))).collect();
    let rooms = q.rooms.iter().enumerate();
    let mut found: Vec<(usize, usize)> =
        rooms.filter_map(|(index, room)| Some((*of.get(telling_id(room)?)?, index))).collect();
    found.sort_unstable();
    found.dedup_by_key(|(a, _)| *a);
    found
}

/// Whether most of these rooms are in one and the same proportion as the median one.
fn in_proportion(p: &Sighting, q: &Sighting, rooms: &[(usize, usize)]) -> bool {
    let mut scales: Vec<f64> =
        rooms.iter().map(|&(a, b)| (q.rooms[b].print.area_m2 / p.rooms[a].print.area_m2).sqrt()).collect();
    scales.sort_by(f64::total_cmp);
    let Some(&scale) = scales.get(scales.len() / 2) else { return false };
    let alike = rooms.iter().filter(|&&(a, b)| p.rooms[a].print.is_like(&q.rooms[b].print, scale, 0.01)).count();
    alike * 5 >= rooms.len() * 4
}

/// Pairs of rooms that may be one, by their hashes; the rarest first.
fn seeds(p: &Sighting, q: &Sighting, hashes: &dyn Fn(&RoomPrint) -> Vec<u32>) -> Vec<(usize, usize)> {
    let mut by_hash: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, room) in p.rooms.iter().enumerate() {
        by_hash.entry(hashes(&room.print)[0]).or_default().push(index);
    }
    let mut seeds: Vec<(usize, usize, usize)> = Vec::new();
    for (index, room) in q.rooms.iter().enumerate() {
        let found: Vec<usize> =
            hashes(&room.print).iter().filter_map(|hash| by_hash.get(hash)).flatten().copied().collect();
        seeds.extend(found.iter().take(ROOMS_A_HASH).map(|&other| (found.len(), other, index)));
    }
    seeds.sort_unstable();
    seeds.into_iter().map(|(_, a, b)| (a, b)).collect()
}

/// The rooms of two plans that lie on each other, and are alike, when one plan is moved, turned or mirrored as fits best.
fn in_place(p: &Sighting, q: &Sighting, seeds: &[(usize, usize)], place_m: f64, tolerance: f64) -> Vec<(usize, usize)> {
    /// Ways of laying one plan on the other that are tried.
    const TRIED: usize = 12;
    let centre = |plan: &Sighting, room: usize| plan.rooms[room].print.centre;
    let mut ways: Vec<Way> = Vec::new();
    for &(a, b) in seeds.iter().take(TRIED) {
        ways.push(Way::moved(centre(q, b) - centre(p, a)));
    }
    // Two rooms far apart fix how a plan is turned.
    for &(a, b) in seeds.iter().take(3) {
        let far = seeds.iter().take(200).filter(|&&(c, d)| c != a && d != b).max_by(|s, t| {
            let reach = |seed: &(usize, usize)| centre(p, seed.0).distance(centre(p, a));
            reach(s).total_cmp(&reach(t)).then(t.cmp(s))
        });
        if let Some(&(c, d)) = far {
            let (from, to) = (centre(p, c) - centre(p, a), centre(q, d) - centre(q, b));
            if (from.length() - to.length()).abs() <= 2.0 * place_m && from.length() > place_m {
                ways.extend([false, true].map(|mirrored| Way::turned(centre(p, a), from, centre(q, b), to, mirrored)));
            }
        }
    }
    let grid = Grid::new(q, place_m);
    let mut best: Vec<(usize, usize)> = Vec::new();
    for way in ways {
        let mut taken = vec![false; q.rooms.len()];
        let mut rooms = Vec::new();
        for (index, room) in p.rooms.iter().enumerate() {
            let at = way.of(room.print.centre);
            let fits = |&other: &usize| {
                let of = &q.rooms[other].print;
                !taken[other] && of.centre.distance(at) <= place_m && room.print.is_like(of, 1.0, tolerance)
            };
            if let Some(other) = grid.near(at).filter(fits).min() {
                taken[other] = true;
                rooms.push((index, other));
            }
        }
        if rooms.len() > best.len() {
            best = rooms;
        }
        if best.len() == p.rooms.len().min(q.rooms.len()) {
            break;
        }
    }
    best
}

/// A way to lay one plan on another.
struct Way {
    from: Point,
    to: Point,
    /// Where the unit vectors go.
    x: Vector,
    y: Vector,
}

impl Way {
    fn moved(by: Vector) -> Self {
        let from = Point::default();
        Self { from, to: from + by, x: Vector::new(1.0, 0.0), y: Vector::new(0.0, 1.0) }
    }

    fn turned(from: Point, along: Vector, to: Point, onto: Vector, mirrored: bool) -> Self {
        let angle_rad =
            if mirrored { onto.angle_rad() + along.angle_rad() } else { onto.angle_rad() - along.angle_rad() };
        let x = Vector::new(1.0, 0.0).rotated(angle_rad);
        let y = if mirrored { x.left() * -1.0 } else { x.left() };
        Self { from, to, x, y }
    }

    fn of(&self, point: Point) -> Point {
        let by = point - self.from;
        self.to + self.x * by.x + self.y * by.y
    }
}

/// Rooms by where their centres are.
struct Grid {
    cells: HashMap<(i64, i64), Vec<usize>>,
    step: f64,
}

impl Grid {
    fn new(plan: &Sighting, reach_m: f64) -> Self {
        let mut grid = Self { cells: HashMap::new(), step: 2.0 * reach_m };
        for (index, room) in plan.rooms.iter().enumerate() {
            let cell = grid.cell(room.print.centre);
            grid.cells.entry(cell).or_default().push(index);
        }
        grid
    }

    fn cell(&self, at: Point) -> (i64, i64) {
        ((at.x / self.step).floor() as i64, (at.y / self.step).floor() as i64)
    }

    /// Rooms within reach, and some more.
    fn near(&self, at: Point) -> impl Iterator<Item = usize> + '_ {
        let (x, y) = self.cell(at);
        let around = (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| (x.saturating_add(dx), y.saturating_add(dy))));
        around.filter_map(|cell| self.cells.get(&cell)).flatten().copied()
    }
}

/// Which rooms are left out: all readings of a room but one; and rooms that one plan has twice in one place.
fn left_out(sightings: &[Sighting], pairs: &[Pair]) -> BTreeMap<Place, Place> {
    let mut first_of = Vec::with_capacity(sightings.len());
    let mut all = 0;
    for seen in sightings {
        first_of.push(all);
        all += seen.rooms.len();
    }
    let mut group: Vec<usize> = (0..all).collect();
    let mut join = |p: Place, q: Place| {
        let (p, q) = (root(&mut group, first_of[p.0] + p.1), root(&mut group, first_of[q.0] + q.1));
        group[p.max(q)] = p.min(q);
    };
    for pair in pairs.iter().filter(|pair| pair.likeness == Likeness::Same) {
        for &(a, b) in &pair.rooms {
            join((pair.first, a), (pair.second, b));
        }
    }
    for (plan, seen) in sightings.iter().enumerate() {
        let grid = Grid::new(seen, SAME_PLACE_M);
        for (index, room) in seen.rooms.iter().enumerate() {
            let is_same = |&other: &usize| {
                let of = &seen.rooms[other].print;
                other < index
                    && of.centre.distance(room.print.centre) <= SAME_PLACE_M
                    && of.is_like(&room.print, 1.0, 0.002)
            };
            if let Some(other) = grid.near(room.print.centre).filter(is_same).min() {
                join((plan, other), (plan, index));
            }
        }
    }
    let places: Vec<Place> = sightings
        .iter()
        .enumerate()
        .flat_map(|(plan, seen)| (0..seen.rooms.len()).map(move |room| (plan, room)))
        .collect();
    let mut readings: BTreeMap<usize, Vec<Place>> = BTreeMap::new();
    for (index, &place) in places.iter().enumerate() {
        readings.entry(root(&mut group, index)).or_default().push(place);
    }
    let mut left_out = BTreeMap::new();
    for places in readings.into_values().filter(|places| places.len() > 1) {
        let is_labelled = |&&(plan, room): &&Place| sightings[plan].rooms[room].label.is_some();
        let kept = places.iter().find(is_labelled).or(places.first()).copied().unwrap_or_default();
        left_out.extend(places.into_iter().filter(|&place| place != kept).map(|place| (place, kept)));
    }
    left_out
}

impl Sighting {
    /// A reading of a plan. `content` is a hash of the file's bytes, `storey_of_file` which plan of its file it is, from 0.
    pub fn of(plan: &Plan, analysis: &Analysis, file: &str, content: &str, storey_of_file: usize) -> Self {
        let meta = plan.meta();
        let building = meta.building_or_name();
        let prints = Prints::new(&analysis.shapes);
        let room = |(id, key): (RoomId, String)| {
            let room = plan.room(id)?;
            let label = analysis.room(id).and_then(|room| room.status.label());
            let (source_id, function) = (room.source_id.clone(), room.function.clone());
            Some(SightedRoom { id, source_id, key, function, label, print: *prints.of(analysis.shapes.index_of(id)?)? })
        };
        Self {
            file: file.to_owned(),
            content: content.to_owned(),
            storey_of_file,
            plan: meta.name.clone(),
            building: building_name::key(building),
            storey: meta.storey.clone(),
            is_storey_stated: states_storey(file, &meta.name, &meta.storey),
            rooms: room_keys(plan).into_iter().filter_map(room).collect(),
        }
    }

    /// Where it was read, for people: the file, and the plan's name where the file has several.
    pub fn title(&self) -> String {
        match self.storey_of_file {
            0 => self.file.clone(),
            _ => format!("{} [{}]", self.file, self.plan),
        }
    }
}

/// Whether a file states the storey of its plan. A plan without a name is called after its file, and gets the storey from there.
fn states_storey(file: &str, plan: &str, storey: &str) -> bool {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let is_called_after_file = formats::file_stem(name) == plan;
    name.ends_with(".plan.json") || !is_called_after_file || building_name::split(plan).storey != storey
}
