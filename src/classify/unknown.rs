//! Predicts what lies behind an opening into unexplored space: a distribution over the label of the room
//! behind it, from the known side alone.
//!
//! Counts of what lay behind such openings, from the specific to the general: openings of this kind in
//! rooms of this label with as many other openings; in rooms of this label; all. Each level is smoothed
//! towards the next, so that rare cases say little.

use serde::{Deserialize, Serialize};

use super::{Distribution, Scores};
use crate::base::random::seed_of_part;
use crate::dataset::RoomNetwork;
use crate::dataset::folds::{Folds, FoldsError};
use crate::labels::Label;
use crate::plan::OpeningKind;

/// The most other openings of a room told apart; more count as this.
const OTHERS: usize = 4;

/// How many observed openings weigh as much as the next more general counts.
const STRENGTH: f64 = 5.0;

type Counts = [f64; 5];

/// What was found behind openings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// By label of the room, other openings, and whether it is a free passage.
    behind: [[[Counts; 2]; OTHERS + 1]; 5],
}

/// A score and its baseline.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownScores {
    pub scores: Scores,
    /// The share right when always predicting the label most often found behind openings.
    pub most_frequent: f64,
}

/// The score of predictions of what lies behind the openings of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanScore {
    pub building: String,
    /// Openings between labelled rooms, each from both sides.
    pub openings: usize,
    /// Those predicted correctly.
    pub right: usize,
    /// Those behind which is the label most often found behind openings.
    pub most_frequent: usize,
}

/// An opening between two labelled rooms, seen from one of them.
#[derive(Clone, Copy)]
struct Seen {
    place: Place,
    behind: Label,
    network: usize,
}

/// What is known of an opening.
#[derive(Clone, Copy)]
struct Place {
    label: Option<Label>,
    others: usize,
    passage: usize,
}

impl Place {
    fn new(network: &RoomNetwork, label: Option<Label>, room: usize, door: usize) -> Option<Self> {
        let doors = &network.rooms.get(room)?.doors;
        let passage = usize::from(doors.get(door)?.kind == OpeningKind::Passage);
        Some(Self { label, others: (doors.len() - 1).min(OTHERS), passage })
    }
}

fn openings(networks: &[&RoomNetwork]) -> Vec<Seen> {
    let mut seen = Vec::new();
    for (index, network) in networks.iter().enumerate() {
        for (room, of) in network.rooms.iter().enumerate().filter(|(_, of)| !of.is_repeat) {
            for (door, opening) in of.doors.iter().enumerate() {
                let behind = opening.to.and_then(|to| network.rooms.get(to)?.label);
                let place = of.label.and_then(|label| Place::new(network, Some(label), room, door));
                if let (Some(behind), Some(place)) = (behind, place) {
                    seen.push(Seen { place, behind, network: index });
                }
            }
        }
    }
    seen
}

impl Unknown {
    /// Learns from openings between labelled rooms, each seen from both sides. If there are none, all
    /// labels are equally likely.
    pub fn train(networks: &[&RoomNetwork]) -> Self {
        Self::of(openings(networks).iter())
    }

    fn of<'a>(openings: impl Iterator<Item = &'a Seen>) -> Self {
        let mut behind = [[[[0.0; 5]; 2]; OTHERS + 1]; 5];
        for Seen { place, behind: label, .. } in openings {
            if let Some(room) = place.label {
                behind[room.index()][place.others][place.passage][label.index()] += 1.0;
            }
        }
        Self { behind }
    }

    /// The distribution over the label of the room behind opening `door` of a room. `known` holds the
    /// known labels of the network's rooms; if the room's own is unknown, the counts of all labels are
    /// used. `None` for an opening that does not exist.
    pub fn predict(
        &self,
        network: &RoomNetwork,
        known: &[Option<Label>],
        room: usize,
        door: usize,
    ) -> Option<Distribution> {
        let label = known.get(room).copied().flatten();
        Some(self.distribution(Place::new(network, label, room, door)?))
    }

    fn distribution(&self, place: Place) -> Distribution {
        let sum = |counts: &mut dyn Iterator<Item = &Counts>| {
            counts.fold([0.0; 5], |sum, counts| std::array::from_fn(|label| sum[label] + counts[label]))
        };
        let all = sum(&mut self.behind.iter().flatten().flatten());
        let mut belief = Distribution::smoothed(all, &Distribution::UNIFORM, STRENGTH);
        let Some(label) = place.label else { return belief };
        let of_label = &self.behind[label.index()];
        belief = Distribution::smoothed(sum(&mut of_label.iter().flatten()), &belief, STRENGTH);
        Distribution::smoothed(of_label[place.others][place.passage], &belief, STRENGTH)
    }

    /// Tests on plans not in the training set, as [`Unknown::score`] does.
    pub fn test(&self, networks: &[&RoomNetwork]) -> Vec<PlanScore> {
        let anywhere = self.anywhere().label();
        let of_plan = |network: &&RoomNetwork| {
            let seen = openings(&[*network]);
            let count = |holds: &dyn Fn(&Seen) -> bool| seen.iter().filter(|seen| holds(seen)).count();
            PlanScore {
                building: network.building.clone(),
                openings: seen.len(),
                right: count(&|seen| self.distribution(seen.place).label() == seen.behind),
                most_frequent: count(&|seen| seen.behind == anywhere),
            }
        };
        networks.iter().map(of_plan).collect()
    }

    /// The distribution behind an opening about which nothing is known.
    fn anywhere(&self) -> Distribution {
        self.distribution(Place { label: None, others: 0, passage: 0 })
    }

    /// Cross-validates with folds that never split a building: for every opening between labelled rooms,
    /// the room behind is taken to be unexplored and the other one known.
    ///
    /// # Errors
    /// When there are fewer buildings with such openings than folds.
    pub fn score(networks: &[&RoomNetwork], folds: usize, seed: u64) -> Result<UnknownScores, FoldsError> {
        let seen = openings(networks);
        let labels: Vec<Label> = seen.iter().map(|seen| seen.behind).collect();
        let buildings: Vec<&str> = seen.iter().map(|seen| networks[seen.network].group.as_str()).collect();
        let folds = Folds::grouped(&labels, &buildings, folds, seed_of_part(seed, 0))?;
        let mut predictions = vec![Distribution::UNIFORM; seen.len()];
        let mut frequent = 0;
        for fold in 0..folds.count() {
            let taught = Self::of(folds.training_rows(fold).into_iter().map(|row| &seen[row]));
            let anywhere = taught.anywhere().label();
            for row in folds.test_rows(fold) {
                predictions[row] = taught.distribution(seen[row].place);
                frequent += usize::from(seen[row].behind == anywhere);
            }
        }
        let rows = folds.of_rows().iter().zip(&predictions).zip(&labels);
        let scores = Scores::of(rows.map(|((&fold, prediction), &label)| (fold, prediction, label)));
        Ok(UnknownScores { scores, most_frequent: frequent as f64 / seen.len().max(1) as f64 })
    }
}
