//! Plans as another source would have drawn them, to learn from. Sources differ in what they draw (closets, or none), and in how
//! sure their scale is; a forest that has only seen one source takes its customs for the nature of dwellings.

use std::collections::BTreeMap;

use crate::base::random::Random;
use crate::dataset::RoomNetwork;
use crate::labels::{Label, normalised_function};

/// How plans are altered while a classifier learns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alterations {
    /// Altered copies of each plan. A tree learns from one version of each plan: as drawn, or a copy.
    pub copies: usize,
    /// Share of the trees' plans that are as drawn, 0..=1.
    pub as_drawn: f64,
    /// Standard deviation of the logarithm of lengths.
    pub scale: f64,
    /// Probability that a copy leaves out a kind of small room, 0..=1.
    pub left_out: f64,
}

impl Alterations {
    /// None: every tree learns from the plans as they are drawn.
    pub const NONE: Self = Self { copies: 0, as_drawn: 1.0, scale: 0.0, left_out: 0.0 };
}

/// A version of a plan.
pub(super) struct Version {
    /// The plan's index.
    pub of: usize,
    /// 0 for the plan as it is drawn.
    pub copy: usize,
    pub network: RoomNetwork,
    /// For each room its index in the plan as it is drawn.
    pub rooms: Vec<usize>,
}

impl Version {
    /// All versions of some plans: first all as drawn, then copy by copy.
    pub fn all(networks: &[&RoomNetwork], alterations: &Alterations, seed: u64) -> Vec<Self> {
        let mut random = Random::new(seed);
        let mut versions: Vec<Self> = networks
            .iter()
            .enumerate()
            .map(|(of, &network)| Self {
                of,
                copy: 0,
                network: network.clone(),
                rooms: (0..network.rooms.len()).collect(),
            })
            .collect();
        for copy in 1..=alterations.copies {
            for (of, network) in networks.iter().enumerate() {
                let (network, rooms) = altered(network, alterations, &mut random);
                versions.push(Self { of, copy, network, rooms });
            }
        }
        versions
    }
}

/// A plan at another scale, without some kinds of small rooms that lead nowhere else: closets, washrooms.
fn altered(network: &RoomNetwork, alterations: &Alterations, random: &mut Random) -> (RoomNetwork, Vec<usize>) {
    let factor = (alterations.scale * random.normal()).exp();
    let joined = network.joined();
    let mut is_left_out: BTreeMap<String, bool> = BTreeMap::new();
    let mut keeps = |room: usize| {
        let of = &network.rooms[room];
        if of.label != Some(Label::SmallRoom) || joined[room].len() > 1 {
            return true;
        }
        let drawn = *is_left_out
            .entry(normalised_function(&of.function))
            .or_insert_with(|| random.unit() < alterations.left_out);
        !drawn
    };
    let mut rooms: Vec<usize> = (0..network.rooms.len()).filter(|&room| keeps(room)).collect();
    if rooms.is_empty() {
        rooms = (0..network.rooms.len()).collect();
    }
    let drawn = network;
    let mut network = drawn.part(&rooms);
    for (room, &index) in network.rooms.iter_mut().zip(&rooms) {
        // Where a closet is not drawn, neither is its door.
        let leads = drawn.rooms[index].doors.iter().map(|door| door.to);
        let mut is_drawn = leads.map(|to| to.is_none_or(|other| rooms.binary_search(&other).is_ok()));
        room.doors.retain(|_| is_drawn.next().unwrap_or(true));
        room.area_m2 *= factor * factor;
        room.form.perimeter_m *= factor;
        room.form.length_m *= factor;
        room.form.width_m *= factor;
    }
    (network, rooms)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::Schemes;

    #[test]
    fn what_is_not_drawn_leaves_no_door() {
        for (_, plan) in crate::store::bundled_plans().unwrap() {
            let drawn = RoomNetwork::new(&plan, &Schemes::bundled());
            let all = Alterations { copies: 1, as_drawn: 0.0, scale: 0.0, left_out: 1.0 };
            let versions = Version::all(&[&drawn], &all, 1);
            let altered = &versions[1];
            assert!(altered.network.rooms.len() < drawn.rooms.len());
            for (room, &index) in altered.network.rooms.iter().zip(&altered.rooms) {
                assert_eq!(room.key, drawn.rooms[index].key);
                assert_eq!(room.area_m2, drawn.rooms[index].area_m2);
                let outside =
                    |room: &crate::dataset::NetworkRoom| room.doors.iter().filter(|door| door.to.is_none()).count();
                assert_eq!(outside(room), outside(&drawn.rooms[index]));
            }
        }
    }

    #[test]
    fn a_scale_changes_areas_by_its_square() {
        let (_, plan) = crate::store::bundled_plans().unwrap().into_iter().next().unwrap();
        let drawn = RoomNetwork::new(&plan, &Schemes::bundled());
        let scaled = Alterations { copies: 1, as_drawn: 0.0, scale: 0.5, left_out: 0.0 };
        let version = &Version::all(&[&drawn], &scaled, 1)[1].network;
        let factor = version.rooms[0].form.length_m / drawn.rooms[0].form.length_m;
        assert!((factor - 1.0).abs() > 1e-6);
        for (room, drawn) in version.rooms.iter().zip(&drawn.rooms) {
            assert!((room.area_m2 / drawn.area_m2 - factor * factor).abs() < 1e-9);
            assert!((room.form.fill(room.area_m2) - drawn.form.fill(drawn.area_m2)).abs() < 1e-9);
        }
    }
}
