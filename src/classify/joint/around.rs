//! Evidence about a room from the labels of the other rooms, known or predicted.

use super::view::{Group, View};
use crate::classify::Distribution;
use crate::labels::Label;

/// The features of the second round, in order, after those of the first.
pub const FEATURES: &[(Group, &str)] = &[
    (Group::Labels, "first opinion: small room"),
    (Group::Labels, "first opinion: medium room"),
    (Group::Labels, "first opinion: big room"),
    (Group::Labels, "first opinion: corridor"),
    (Group::Labels, "first opinion: hall"),
    (Group::Labels, "small rooms it joins"),
    (Group::Labels, "medium rooms it joins"),
    (Group::Labels, "big rooms it joins"),
    (Group::Labels, "corridors it joins"),
    (Group::Labels, "halls it joins"),
    (Group::Labels, "share of small rooms it joins"),
    (Group::Labels, "share of medium rooms it joins"),
    (Group::Labels, "share of big rooms it joins"),
    (Group::Labels, "share of corridors it joins"),
    (Group::Labels, "share of halls it joins"),
    (Group::Labels, "small rooms off the same neighbour"),
    (Group::Labels, "medium rooms off the same neighbour"),
    (Group::Labels, "big rooms off the same neighbour"),
    (Group::Labels, "corridors off the same neighbour"),
    (Group::Labels, "halls off the same neighbour"),
    (Group::Labels, "share of small rooms in the plan"),
    (Group::Labels, "share of medium rooms in the plan"),
    (Group::Labels, "share of big rooms in the plan"),
    (Group::Labels, "share of corridors in the plan"),
    (Group::Labels, "share of halls in the plan"),
    (Group::Labels, "area against the plan's small rooms"),
    (Group::Labels, "area against the plan's medium rooms"),
    (Group::Labels, "area against the plan's big rooms"),
    (Group::Labels, "area against the plan's corridors"),
    (Group::Labels, "area against the plan's halls"),
];

/// The least total probability of a label over the other rooms of a plan, in rooms, for it to have a mean
/// area there.
const LEAST_WEIGHT: f64 = 0.05;

/// The beliefs about the rooms of a plan.
pub(super) struct Around<'a> {
    view: &'a View,
    first: &'a [Distribution],
    /// The known label, else the first round's prediction.
    believed: Vec<[f64; 5]>,
    all: Sums,
    /// The same of each flat.
    flats: Vec<Sums>,
}

impl<'a> Around<'a> {
    /// From the first round's predictions and the known labels.
    pub fn new(view: &'a View, first: &'a [Distribution], known: &[Option<Label>]) -> Self {
        let believed: Vec<[f64; 5]> = first
            .iter()
            .enumerate()
            .map(|(room, first)| match known.get(room).copied().flatten() {
                Some(label) => std::array::from_fn(|index| f64::from(u8::from(index == label.index()))),
                None => *first.probabilities(),
            })
            .collect();
        let mut all = Sums::default();
        let mut flats = vec![Sums::default(); view.flat.iter().flatten().max().map_or(0, |most| most + 1)];
        for (room, believed) in believed.iter().enumerate() {
            all.add(believed, view.log_area[room], 1.0);
            if let Some(flat) = view.flat[room] {
                flats[flat].add(believed, view.log_area[room], 1.0);
            }
        }
        Self { view, first, believed, all, flats }
    }

    fn sum(&self, rooms: &[u32]) -> Sums {
        let mut sums = Sums::default();
        for &room in rooms {
            sums.add(&self.believed[room as usize], self.view.log_area[room as usize], 1.0);
        }
        sums
    }

    /// The features of a room: as many as [`FEATURES`], all finite. They do not use its own known
    /// label.
    pub fn of_room(&self, room: usize) -> [f32; FEATURES.len()] {
        let family = self.view.family(room).map(|family| self.sum(self.view.families.of(family)));
        self.told(room, &self.sum(self.view.joined.of(room)), family)
    }

    /// The features of all rooms, in order.
    pub fn of_rooms(&self) -> impl Iterator<Item = [f32; FEATURES.len()]> {
        let families: Vec<Sums> = self.view.families.iter().map(|family| self.sum(family)).collect();
        (0..self.believed.len()).map(move |room| {
            let family = self.view.family(room).and_then(|family| families.get(family).copied());
            self.told(room, &self.sum(self.view.joined.of(room)), family)
        })
    }

    /// `family` are the sums over the room and its siblings, if it has a family.
    fn told(&self, room: usize, joined: &Sums, family: Option<Sums>) -> [f32; FEATURES.len()] {
        let (area, own) = (self.view.log_area[room], &self.believed[room]);
        let siblings = family.map_or_else(Sums::default, |mut family| {
            family.add(own, area, -1.0);
            family
        });
        let mut others = self.view.flat[room].map_or(self.all, |flat| self.flats[flat]);
        others.add(own, area, -1.0);
        let against = |label: usize| {
            let weight = others.weights[label];
            if weight > LEAST_WEIGHT { area - others.areas[label] / weight } else { 0.0 }
        };
        let against: [f64; 5] = std::array::from_fn(against);
        let numbers = [
            *self.first[room].probabilities(),
            joined.weights,
            joined.shares(),
            siblings.shares(),
            others.shares(),
            against,
        ];
        std::array::from_fn(|feature| numbers[feature / 5][feature % 5] as f32)
    }
}

/// Weights of labels over rooms, and logarithms of areas weighted by them.
#[derive(Clone, Copy, Default)]
struct Sums {
    rooms: f64,
    weights: [f64; 5],
    areas: [f64; 5],
}

impl Sums {
    fn add(&mut self, believed: &[f64; 5], log_area: f64, times: f64) {
        self.rooms += times;
        for ((weight, area), believed) in self.weights.iter_mut().zip(&mut self.areas).zip(believed) {
            *weight += times * believed;
            *area += times * believed * log_area;
        }
    }

    /// All zero if there are no rooms.
    fn shares(&self) -> [f64; 5] {
        self.weights.map(|weight| if self.rooms > 0.5 { weight / self.rooms } else { 0.0 })
    }
}
