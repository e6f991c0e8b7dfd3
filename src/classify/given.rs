//! What given labels say of the rooms like them. Whoever labels half of a building also shows how its rooms are meant: what is a
//! medium room here, and which of two rooms alike a model takes for the wrong thing. So what was wrong about a room with a given
//! label is put right for the rooms like it.
//!
//! This is the first half of 'correct and smooth' (Huang et al. 2021), with rooms that are alike in place of rooms that are joined:
//! joined rooms seldom have the same label, and what their labels tell is known to the joint classifiers already.

use super::Distribution;
use super::why::and_list;
use crate::dataset::{NetworkRoom, RoomNetwork};
use crate::labels::Label;

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

/// Rooms further apart in area are not looked at.
const WINDOW: f64 = 3.0 * AREA;

/// What of a room decides which others are like it.
#[derive(Clone, Debug)]
struct Traits([f64; 4]);

impl Traits {
    fn of(room: &NetworkRoom, joined: usize) -> Self {
        let log = |number: f64| number.max(1e-9).ln();
        let shape = log(room.form.length_m) - log(room.form.width_m);
        Self([
            log(room.area_m2) / AREA,
            shape / SHAPE,
            log(1.0 + room.doors.len() as f64) / OPENINGS,
            log(1.0 + joined as f64) / JOINED,
        ])
    }

    /// How alike two rooms are, 0..=1.
    fn likeness(&self, other: &Self) -> f64 {
        let squared: f64 = self.0.iter().zip(&other.0).map(|(p, q)| (p - q).powi(2)).sum();
        (-0.5 * squared).exp()
    }
}

/// The labels that were given to rooms of a plan, with what tells which rooms are like them.
#[derive(Clone, Debug)]
pub struct Given {
    /// Of each room of the network; of none where no label was given.
    traits: Vec<Traits>,
    /// The rooms that have a label, by area.
    by_area: Vec<(usize, Label)>,
}

impl Given {
    /// `known` as in [`super::joint::Joint::predict`].
    pub fn of(network: &RoomNetwork, known: &[Option<Label>]) -> Self {
        let labels = known.iter().take(network.rooms.len()).enumerate();
        let mut by_area: Vec<(usize, Label)> = labels.filter_map(|(room, label)| Some((room, (*label)?))).collect();
        if by_area.is_empty() {
            return Self { traits: Vec::new(), by_area };
        }
        let traits: Vec<Traits> =
            network.rooms.iter().zip(network.joined()).map(|(room, joined)| Traits::of(room, joined.len())).collect();
        by_area.sort_by(|(p, _), (q, _)| traits[*p].0[0].total_cmp(&traits[*q].0[0]));
        Self { traits, by_area }
    }

    /// The other rooms with a label whose areas are near that of a room, by area, each with how alike it is.
    fn near(&self, room: usize) -> impl Iterator<Item = (f64, usize, Label)> {
        let own = self.traits.get(room);
        let area = own.map_or(0.0, |own| own.0[0]);
        let from = self.by_area.partition_point(|(other, _)| self.traits[*other].0[0] < area - WINDOW / AREA);
        let within =
            self.by_area[from..].iter().take_while(move |(other, _)| self.traits[*other].0[0] <= area + WINDOW / AREA);
        within
            .filter(move |(other, _)| *other != room)
            .filter_map(move |&(other, label)| Some((own?.likeness(&self.traits[other]), other, label)))
    }

    /// The rooms like a room that have a given label, most alike first.
    pub fn like(&self, room: usize) -> Vec<(usize, Label)> {
        let mut like: Vec<(f64, usize, Label)> =
            self.near(room).filter(|(likeness, ..)| *likeness >= MENTIONED).collect();
        like.sort_by(|p, q| q.0.total_cmp(&p.0).then(p.1.cmp(&q.1)));
        like.into_iter().map(|(_, other, label)| (other, label)).collect()
    }

    /// What is said of the rooms of a plan, once the labels that were given for some have been compared with what was `said` of
    /// these while none was known. A room's own label is never used for it.
    pub fn corrected(&self, said: &[Distribution]) -> Vec<Distribution> {
        if self.by_area.is_empty() {
            return said.to_vec();
        }
        let of_room = |(room, said_of_room): (usize, &Distribution)| {
            let mut weights = 0.0;
            let mut residuals = [0.0; 5];
            for (likeness, other, label) in self.near(room) {
                weights += likeness;
                for (index, residual) in residuals.iter_mut().enumerate() {
                    let truth = f64::from(u8::from(index == label.index()));
                    *residual += likeness * (truth - said[other].probabilities()[index]);
                }
            }
            let moved = |index: usize| (STRENGTH * residuals[index] / (DOUBT + weights)).exp();
            Distribution::from_weights(std::array::from_fn(|index| said_of_room.probabilities()[index] * moved(index)))
        };
        said.iter().enumerate().map(of_room).collect()
    }
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
const MENTIONED: f64 = 0.3;

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
        assert_eq!(Given::of(&network, &[]).corrected(&said), said, "nothing is given");
        let known = [Some(Label::SmallRoom), Some(Label::SmallRoom)];
        let given = Given::of(&network, &known);
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
