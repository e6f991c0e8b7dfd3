//! What given labels say of the rooms like them. Whoever labels half of a building also shows how its rooms are meant: what is a
//! medium room here, and which of two rooms alike a model takes for the wrong thing. So what was wrong about a room with a given
//! label is put right for the rooms like it.
//!
//! This is the first half of 'correct and smooth' (Huang et al. 2021), with rooms that are alike in place of rooms that are joined:
//! joined rooms seldom have the same label, and what their labels tell is known to the joint classifiers already.

use std::sync::Arc;

use super::Distribution;
use super::why::and_list;
use crate::dataset::{NetworkRoom, RoomNetwork, places_among};
use crate::labels::Label;
use crate::plan::RoomId;

/// How much a residual of 1 moves the logarithm of a label's odds.
const STRENGTH: f64 = 4.0;

/// As many rooms exactly alike count as much as what was predicted.
const DOUBT: f64 = 1.0;

/// By how much rooms that are alike differ: one standard deviation of the logarithms of areas, of lengths against widths, of one
/// more than their openings, and of one more than the rooms they open to.
const AREA: f64 = 0.15;
const SHAPE: f64 = 0.3;
const OPENINGS: f64 = 0.4;
const JOINED: f64 = 0.4;

/// Rooms further apart in area are not looked at: in standard deviations.
const WINDOW: f32 = 3.0;

/// Likeness and residuals are counted in whole steps, so many to 1: sums of whole numbers do not depend on their order, and are
/// put right to the last bit when one of many rooms has changed. The sums over a quarter of a million rooms stay below 2^53, up
/// to which a number with a fraction holds whole numbers exactly.
const LIKENESS_STEPS: f32 = 65_536.0;
const RESIDUAL_STEPS: f64 = 262_144.0;

/// What of a room decides which others are like it, each in standard deviations; the area first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Traits([f32; 4]);

impl Traits {
    fn of(room: &NetworkRoom, joined: usize) -> Self {
        let log = |number: f64| number.max(1e-9).ln();
        let shape = log(room.form.length_m) - log(room.form.width_m);
        Self([
            (log(room.area_m2) / AREA) as f32,
            (shape / SHAPE) as f32,
            (log(1.0 + room.doors.len() as f64) / OPENINGS) as f32,
            (log(1.0 + joined as f64) / JOINED) as f32,
        ])
    }

    const fn area(&self) -> f32 {
        self.0[0]
    }

    /// Whether another room of this area is looked at.
    fn is_near(&self, area: f32) -> bool {
        area >= self.area() - WINDOW && area <= self.area() + WINDOW
    }

    /// How alike two rooms are, in steps.
    fn likeness(&self, other: &Self) -> f32 {
        let [p, q, r, s] = std::array::from_fn(|of| (self.0[of] - other.0[of]) * (self.0[of] - other.0[of]));
        likeness((p + q) + (r + s))
    }
}

/// `exp(-squared / 2)` in steps, rounded. Written out because it is asked for millions of times, several at once.
#[inline]
fn likeness(squared: f32) -> f32 {
    // Adding this rounds to a whole number, which then stands in the lowest bits.
    const WHOLE: f32 = 12_582_912.0;
    let far = if squared < 60.0 { squared } else { 60.0 };
    let power = far * (-0.5 * std::f32::consts::LOG2_E);
    let rounded = power + WHOLE;
    // Two to the power of what is left, from -1/2 to 1/2, by Taylor's series.
    let left = (power - (rounded - WHOLE)) * std::f32::consts::LN_2;
    let series = 1.0
        + left
            * (1.0
                + left * (1.0 / 2.0 + left * (1.0 / 6.0 + left * (1.0 / 24.0 + left * (1.0 / 120.0 + left / 720.0)))));
    // The whole power of two is added to the exponent.
    let alike = f32::from_bits(series.to_bits().wrapping_add(rounded.to_bits() << 23));
    (alike * LIKENESS_STEPS + WHOLE) - WHOLE
}

/// A room with a given label, as the others see it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Witness {
    traits: Traits,
    label: Label,
    /// The truth less what was said, for each label, in steps.
    residuals: [f64; 5],
}

impl Witness {
    fn new(traits: Traits, label: Label, said: &Distribution) -> Self {
        let residual = |index: usize| {
            let truth = f64::from(u8::from(index == label.index()));
            ((truth - said.probabilities()[index]) * RESIDUAL_STEPS).round()
        };
        Self { traits, label, residuals: std::array::from_fn(residual) }
    }
}

/// The sum of the likenesses of witnesses, and of their residuals weighted by these; whole numbers.
const SUMS: usize = 6;

/// The labels that were given to rooms of a plan, with what they tell of the rooms like them.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// The rooms of the network; none where no label was given, nor in the other lists.
    rooms: Vec<RoomId>,
    traits: Arc<Vec<Traits>>,
    /// The rooms by area.
    by_area: Arc<Vec<u32>>,
    witnesses: Vec<Option<Witness>>,
    sums: Vec<[f64; SUMS]>,
}

/// Sums in the making: rooms by area, and a list for each of what is looked at together.
struct Sorted {
    /// The place of each room.
    place_of: Vec<u32>,
    traits: [Vec<f32>; 4],
    sums: [Vec<f64>; SUMS],
}

impl Sorted {
    /// `rooms` by area.
    fn new(rooms: &[u32], traits: &[Traits], sums: impl Fn(usize) -> [f64; SUMS]) -> Self {
        let mut place_of = vec![0; rooms.len()];
        for (place, &room) in rooms.iter().enumerate() {
            place_of[room as usize] = place as u32;
        }
        let of_traits = |of: usize| rooms.iter().map(|&room| traits[room as usize].0[of]).collect();
        let before: Vec<[f64; SUMS]> = rooms.iter().map(|&room| sums(room as usize)).collect();
        Self {
            traits: std::array::from_fn(of_traits),
            sums: std::array::from_fn(|of| before.iter().map(|sums| sums[of]).collect()),
            place_of,
        }
    }

    /// Adds what a witness tells of all rooms near it but its own, `own` being its index if it is one of these: its likeness
    /// times `weight`, and its likeness times each of `residuals`.
    fn add(&mut self, traits: &Traits, own: Option<usize>, weight: f64, residuals: &[f64; 5]) {
        let areas = &self.traits[0];
        let from = areas.partition_point(|&area| area < traits.area() - WINDOW);
        let to = areas.partition_point(|&area| area <= traits.area() + WINDOW).max(from);
        let own = own.map_or(to, |own| self.place_of[own] as usize).clamp(from, to);
        for range in [from..own, (own + 1).min(to)..to] {
            let [p, q, r, s] = std::array::from_fn(|of| &self.traits[of][range.clone()]);
            let [weights, a, b, c, d, e] = self.sums.each_mut().map(|sums| &mut sums[range.clone()]);
            let length = range.len();
            let (p, q, r, s) = (&p[..length], &q[..length], &r[..length], &s[..length]);
            let (weights, a, b) = (&mut weights[..length], &mut a[..length], &mut b[..length]);
            let (c, d, e) = (&mut c[..length], &mut d[..length], &mut e[..length]);
            for at in 0..length {
                let alike = traits.likeness(&Traits([p[at], q[at], r[at], s[at]]));
                let alike = f64::from(alike);
                weights[at] += alike * weight;
                a[at] += alike * residuals[0];
                b[at] += alike * residuals[1];
                c[at] += alike * residuals[2];
                d[at] += alike * residuals[3];
                e[at] += alike * residuals[4];
            }
        }
    }

    /// The sums in the order of the rooms.
    fn into_sums(self) -> Vec<[f64; SUMS]> {
        self.place_of.iter().map(|&place| self.sums.each_ref().map(|sums| sums[place as usize])).collect()
    }
}

impl Given {
    /// `known` as in [`super::joint::Joint::predict`], `said` what is said of the rooms while no label is known.
    pub fn of(network: &RoomNetwork, known: &[Option<Label>], said: &[Distribution]) -> Self {
        Self::after(network, known, said, None)
    }

    /// Whether these are the labels that were given.
    pub fn is_of(&self, known: &[Option<Label>]) -> bool {
        let given = |room: usize| known.get(room).copied().flatten();
        match self.witnesses.is_empty() {
            true => known.iter().all(Option::is_none),
            false => {
                let labels = self.witnesses.iter().map(|witness| witness.as_ref().map(|witness| witness.label));
                labels.enumerate().all(|(room, label)| label == given(room))
            }
        }
    }

    /// The same of the plan after an edit; `before` is what was given before it, and whether the rooms look as they did then
    /// ([`RoomNetwork::looks_like`]).
    pub fn after(
        network: &RoomNetwork,
        known: &[Option<Label>],
        said: &[Distribution],
        before: Option<(&Self, bool)>,
    ) -> Self {
        let known = |room: usize| known.get(room).copied().flatten();
        let count = network.rooms.len();
        if (0..count).all(|room| known(room).is_none()) {
            return Self::default();
        }
        let same = before.filter(|(before, is_same)| *is_same && !before.traits.is_empty()).map(|(before, _)| before);
        let (traits, by_area) = match same {
            Some(before) => (before.traits.clone(), before.by_area.clone()),
            None => {
                let traits = traits_of(network);
                let mut pairs: Vec<(f32, u32)> = traits.iter().map(Traits::area).zip(0..).collect();
                pairs.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
                (Arc::new(traits), Arc::new(pairs.into_iter().map(|(_, room)| room).collect::<Vec<u32>>()))
            }
        };
        let witness = |room: usize| Some(Witness::new(traits[room], known(room)?, said.get(room)?));
        let witnesses: Vec<Option<Witness>> = (0..count).map(witness).collect();
        let rooms: Vec<RoomId> = network.rooms.iter().map(|room| room.id).collect();
        let none = Self::default();
        let before = before.map_or(&none, |(before, _)| before);
        let places = places_among(&before.rooms, &rooms);
        // Where the room itself is as it was, its sums are put right by what has changed of others; else they are made anew.
        let earlier = |room: usize| places[room].filter(|&place| before.traits[place] == traits[room]);
        let was = |room: usize| before.witnesses[places[room]?];
        let mut stays = vec![false; before.rooms.len()];
        places.iter().flatten().for_each(|&place| stays[place] = true);
        let mut changed: Vec<usize> = (0..count).filter(|&room| was(room) != witnesses[room]).collect();
        let mut gone: Vec<usize> =
            (0..before.rooms.len()).filter(|&place| !stays[place] && before.witnesses[place].is_some()).collect();
        let is_anew = 2 * (changed.len() + gone.len()) > count;
        if is_anew {
            gone.clear();
            changed = (0..count).collect();
        }
        let earlier = |room: usize| earlier(room).filter(|_| !is_anew);
        let was = |room: usize| was(room).filter(|_| !is_anew);
        let sums = |room: usize| earlier(room).map_or([0.0; SUMS], |place| before.sums[place]);
        let mut sorted = Sorted::new(&by_area, &traits, sums);
        for place in gone {
            if let Some(Witness { traits, residuals, .. }) = &before.witnesses[place] {
                sorted.add(traits, None, -1.0, &residuals.map(|residual| -residual));
            }
        }
        for room in changed {
            match (was(room), witnesses[room]) {
                (Some(was), Some(is)) if was.traits == is.traits => {
                    let by = std::array::from_fn(|of| is.residuals[of] - was.residuals[of]);
                    sorted.add(&is.traits, Some(room), 0.0, &by);
                }
                (was, is) => {
                    if let Some(Witness { traits, residuals, .. }) = was {
                        sorted.add(&traits, Some(room), -1.0, &residuals.map(|residual| -residual));
                    }
                    if let Some(Witness { traits, residuals, .. }) = is {
                        sorted.add(&traits, Some(room), 1.0, &residuals);
                    }
                }
            }
        }
        let mut sums = sorted.into_sums();
        if !is_anew {
            for room in (0..count).filter(|&room| earlier(room).is_none()) {
                sums[room] = sums_of(room, &traits, &witnesses);
            }
        }
        Self { rooms, traits, by_area, witnesses, sums }
    }

    /// The rooms like a room that have a given label, most alike first.
    pub fn like(&self, room: usize) -> Vec<(usize, Label)> {
        let Some(own) = self.traits.get(room) else { return Vec::new() };
        let witnesses = self.witnesses.iter().enumerate().filter(|(other, _)| *other != room);
        let near = witnesses.filter_map(|(other, witness)| Some((other, witness.as_ref()?)));
        let mut like: Vec<(f32, usize, Label)> = near
            .filter(|(_, witness)| witness.traits.is_near(own.area()))
            .map(|(other, witness)| (witness.traits.likeness(own) / LIKENESS_STEPS, other, witness.label))
            .filter(|(likeness, ..)| *likeness >= MENTIONED)
            .collect();
        like.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
        like.into_iter().map(|(_, other, label)| (other, label)).collect()
    }

    /// What is said of the rooms of a plan, once the labels that were given for some have been compared with what was `said` of
    /// these while none was known. A room's own label is never used for it.
    pub fn corrected(&self, said: &[Distribution]) -> Vec<Distribution> {
        if self.sums.is_empty() {
            return said.to_vec();
        }
        let of_room = |(said, sums): (&Distribution, &[f64; SUMS])| {
            let steps = f64::from(LIKENESS_STEPS);
            let weight = sums[0] / steps;
            if sums[1..] == [0.0; 5] {
                return *said;
            }
            let moved = |index: usize| {
                let residual = sums[1 + index] / (steps * RESIDUAL_STEPS);
                (STRENGTH * residual / (DOUBT + weight)).exp()
            };
            Distribution::from_weights(std::array::from_fn(|index| said.probabilities()[index] * moved(index)))
        };
        said.iter().zip(&self.sums).map(of_room).collect()
    }
}

fn traits_of(network: &RoomNetwork) -> Vec<Traits> {
    let mut joined: Vec<usize> = Vec::new();
    let of_room = |room: &NetworkRoom| {
        joined.clear();
        joined.extend(room.doors.iter().filter_map(|door| door.to));
        joined.sort_unstable();
        joined.dedup();
        Traits::of(room, joined.len())
    };
    network.rooms.iter().map(of_room).collect()
}

/// What all witnesses tell of a room.
fn sums_of(room: usize, traits: &[Traits], witnesses: &[Option<Witness>]) -> [f64; SUMS] {
    let mut sums = [0.0; SUMS];
    let own = traits[room];
    for (_, witness) in witnesses.iter().enumerate().filter(|(other, _)| *other != room) {
        let Some(Witness { traits, residuals, .. }) = witness else { continue };
        if traits.is_near(own.area()) {
            let alike = f64::from(traits.likeness(&own));
            sums[0] += alike;
            sums[1..].iter_mut().zip(residuals).for_each(|(sum, residual)| *sum += alike * residual);
        }
    }
    sums
}

/// What such rooms tell, in words without a full stop.
pub fn words(like: &[(usize, Label)]) -> String {
    let told: Vec<String> = Label::ALL
        .into_iter()
        .filter_map(|label| {
            let rooms = like.iter().filter(|(_, of)| *of == label).count();
            (rooms > 0).then(|| format!("{rooms} {label}{}", if rooms == 1 { "" } else { "s" }))
        })
        .collect();
    match told.is_empty() {
        true => "rooms somewhat like it were labelled otherwise than the models say".to_owned(),
        false => format!("labels given to rooms like it: {}", and_list(&told)),
    }
}

/// Rooms less alike are not mentioned.
const MENTIONED: f32 = 0.3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Schemes;

    /// Four rooms alike, and one much larger.
    fn network() -> RoomNetwork {
        let (_, plan) = crate::store::bundled_plans().unwrap().into_iter().next().unwrap();
        let like = RoomNetwork::new(&plan, &Schemes::bundled());
        let mut rooms = vec![NetworkRoom { doors: Vec::new(), ..like.rooms[0].clone() }; 5];
        rooms[4].area_m2 *= 8.0;
        RoomNetwork { rooms, flats: Default::default(), ..like }
    }

    #[test]
    fn what_was_wrong_about_a_room_is_put_right_for_those_like_it() {
        let network = network();
        let medium = Distribution::from_weights([0.4, 0.6, 0.0, 0.0, 0.0]);
        let said = [medium; 5];
        assert_eq!(Given::of(&network, &[], &said).corrected(&said), said, "nothing is given");
        let known = [Some(Label::SmallRoom), Some(Label::SmallRoom)];
        let given = Given::of(&network, &known, &said);
        let corrected = given.corrected(&said);
        assert_eq!(corrected[2].label(), Label::SmallRoom);
        assert_eq!(corrected[2], corrected[3]);
        assert_eq!(corrected[4], medium, "it is like none of them");
        // Its own label does not count, the other's does.
        assert_eq!(corrected[0], corrected[1]);
        assert!(corrected[0].probability(Label::SmallRoom) < corrected[2].probability(Label::SmallRoom));
        assert_eq!(words(&given.like(2)), "labels given to rooms like it: 2 small rooms");
    }
}
