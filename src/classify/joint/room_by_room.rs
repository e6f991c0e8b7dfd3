//! The first round alone, with folds by room: what all other rooms say of a room's label, those of its own building among them. So it
//! knows a building's customs (what is a medium room here), which folds by building never tell. Too kind as an estimate of how well
//! other buildings are classified, but what finds labels that are out of line.

use std::collections::BTreeSet;

use super::rows::Rows;
use super::trees::{self, Job, Samples, VersionChoice};
use super::{Classes, Looked, label, labelled};
use crate::base::random::seed_of_part;
use crate::base::work::{Cancelled, Work};
use crate::classify::Distribution;
use crate::dataset::RoomNetwork;
use crate::dataset::folds::Folds;

/// Plans are learned from as they are drawn: the room that is asked about was drawn by the same hand.
const AS_DRAWN: VersionChoice = VersionChoice { copies: 0, as_drawn: 1.0 };

/// What a forest says of each labelled room, in the order of the networks, that learned from the rooms of the other folds and knows no
/// labels of neighbours. `folds` has one fold for each of these rooms. The same seed gives the same on any number of threads.
/// Progress counts trees.
///
/// # Errors
/// When the work is cancelled.
pub fn by_other_rooms(
    networks: &[&RoomNetwork],
    folds: &Folds,
    seed: u64,
    work: &Work<'_>,
) -> Result<Vec<Distribution>, Cancelled> {
    let places = labelled(networks);
    let classes = Classes::new(networks, &places);
    let mut features: Vec<Rows> = Vec::with_capacity(networks.len());
    for network in networks {
        work.goes_on()?;
        features.push(Looked::new(network, &BTreeSet::new()).rows);
    }
    let values = |at: usize| features[places[at].network].of(places[at].room);
    let mut samples = Samples::default();
    for (at, &place) in places.iter().enumerate() {
        samples.push(values(at), label(networks, place), classes.of(networks, place));
    }
    let job = |fold: usize| {
        let rows: Vec<u32> = folds.training_rows(fold).into_iter().map(|row| row as u32).collect();
        Job { samples: &samples, rows, choice: AS_DRAWN, seed: seed_of_part(seed, fold) }
    };
    let jobs: Vec<Job<'_>> = (0..folds.count()).map(job).collect();
    let forests = trees::grow(&jobs, work)?;
    Ok(folds.of_rows().iter().enumerate().map(|(at, &fold)| forests[fold].predict(values(at))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::{Label, Schemes};

    /// The bundled plans, of whose rooms nobody knows what they are for.
    fn networks() -> Vec<RoomNetwork> {
        let schemes = Schemes::bundled();
        let plans = crate::store::bundled_plans().unwrap();
        let mut networks: Vec<RoomNetwork> = plans.iter().map(|(_, plan)| RoomNetwork::new(plan, &schemes)).collect();
        for room in networks.iter_mut().flat_map(|network| &mut network.rooms) {
            room.function.clear();
        }
        networks
    }

    #[test]
    fn a_rooms_own_label_tells_nothing_of_it() {
        let mut networks = networks();
        let refs: Vec<&RoomNetwork> = networks.iter().collect();
        let places = labelled(&refs);
        let labels: Vec<Label> = places.iter().map(|&place| label(&refs, place)).collect();
        let folds = Folds::stratified(&labels, 4, 1).unwrap();
        let say = |networks: &[RoomNetwork], threads: usize| {
            let work = Work::quiet();
            by_other_rooms(&networks.iter().collect::<Vec<_>>(), &folds, 5, &work.alone().on_threads(threads)).unwrap()
        };
        let said = say(&networks, 1);
        assert_eq!(said, say(&networks, 3), "on any number of threads");
        assert_eq!(said.len(), places.len());
        let right = said.iter().zip(&labels).filter(|(said, label)| said.label() == **label).count();
        assert!(2 * right > labels.len(), "{right} of {}", labels.len());
        let doubted = 7;
        let room = &mut networks[places[doubted].network].rooms[places[doubted].room];
        room.label = Label::ALL.into_iter().find(|label| room.label != Some(*label));
        let after = say(&networks, 2);
        assert_eq!(after[doubted], said[doubted]);
        assert_ne!(after, said, "other rooms learn from it");
    }
}
