//! Classifying all rooms of a plan at once: unknown labels of neighbours are predicted too, and
//! predictions repeated until none changes.

use std::sync::Arc;

use super::{Algorithm, Classifier, Distribution};
use crate::base::random::seed_of_part;
use crate::base::work::{Cancelled, Work};
use crate::dataset::folds::{Folds, Grouping};
use crate::dataset::table::Table;
use crate::dataset::{RoomNetwork, RoomPlace, Row, places_among};
use crate::features::{Features, NeighbourLabels};
use crate::labels::Label;
use crate::plan::RoomId;

/// The most rounds of prediction. Real plans settle after two to five; the few that do not alternate
/// between two states, which no number of rounds would end.
pub const MOST_ROUNDS: usize = 20;

/// The predictions for a plan's rooms, each list with one entry per room of the network.
#[derive(Clone, Debug, PartialEq)]
pub struct InPlan {
    pub distributions: Vec<Distribution>,
    /// The features the final predictions are based on.
    pub features: Vec<Features>,
    /// How many times all rooms were predicted; 1 unless predictions were repeated.
    pub rounds: usize,
    /// Whether the last round changed nothing.
    pub settled: bool,
}

/// What a classifier said of rooms, by their features: kept for the plan after an edit.
#[derive(Clone, Debug, Default)]
pub struct Said {
    rooms: Vec<RoomId>,
    of_rooms: Vec<Kept>,
}

/// The features of a room, with what was said of them: those of the last rounds first.
type Kept = Arc<[(Features, Distribution)]>;

/// More features than these are not kept of a room.
const MOST_KEPT: usize = 4;

/// Classifies the rooms of a plan. `known` holds, for each room of the network, the label that may be
/// used when it is a neighbour (never for its own prediction), if known.
pub fn classify(
    classifier: &Classifier,
    network: &RoomNetwork,
    known: &[Option<Label>],
    neighbours: NeighbourLabels,
) -> InPlan {
    classify_after(classifier, network, known, neighbours, None).0
}

/// The same of the plan after an edit, with what is to be kept for the next one: of rooms with the features that they had
/// before, the classifier is not asked again. `before` is what the same classifier said of the plan before.
pub fn classify_after(
    classifier: &Classifier,
    network: &RoomNetwork,
    known: &[Option<Label>],
    neighbours: NeighbourLabels,
    before: Option<&Said>,
) -> (InPlan, Said) {
    let rooms: Vec<RoomId> = network.rooms.iter().map(|room| room.id).collect();
    let count = rooms.len();
    let mut of_rooms: Vec<Option<Kept>> = match before {
        None => vec![None; count],
        Some(before) => {
            let places = places_among(&before.rooms, &rooms);
            places.into_iter().map(|place| before.of_rooms.get(place?).cloned()).collect()
        }
    };
    let mut ask = |room: usize, features: &Features| {
        let kept = of_rooms[room].as_deref().unwrap_or_default();
        if let Some((_, distribution)) = kept.iter().find(|(of, _)| of == features) {
            return *distribution;
        }
        let distribution = classifier.predict(&features.values());
        let others = kept.iter().copied().take(MOST_KEPT - 1);
        of_rooms[room] = Some(std::iter::once((*features, distribution)).chain(others).collect());
        distribution
    };
    let mut seen = network.seen_labels(known, neighbours);
    let features: Vec<Features> = (0..count).map(|room| network.features(room, &seen)).collect();
    let distributions = features.iter().enumerate().map(|(room, features)| ask(room, features)).collect();
    let settled = neighbours != NeighbourLabels::Predicted;
    let mut result = InPlan { distributions, features, rounds: 1, settled };
    let mut is_new = vec![false; count];
    while !result.settled && result.rounds < MOST_ROUNDS {
        let known = |room: usize| known.get(room).copied().flatten();
        for (room, is_new) in is_new.iter_mut().enumerate() {
            let next = known(room).unwrap_or_else(|| result.distributions[room].label());
            *is_new = next != seen[room];
            seen[room] = next;
        }
        if is_new.iter().all(|is_new| !is_new) {
            result.settled = true;
            break;
        }
        result.rounds += 1;
        for (room, of) in network.rooms.iter().enumerate() {
            // Of a room whose neighbours look as before, the same is said.
            if of.doors.iter().filter_map(|door| door.to).any(|other| is_new.get(other) == Some(&true)) {
                result.features[room] = network.features(room, &seen);
                result.distributions[room] = ask(room, &result.features[room]);
            }
        }
    }
    (result, Said { rooms, of_rooms: of_rooms.into_iter().map(Option::unwrap_or_default).collect() })
}

/// Folds for giving training rooms the predicted labels of their neighbours.
const INNER_FOLDS: usize = 3;

/// Training rows for use with [`NeighbourLabels::Predicted`]: the neighbours of each training room carry
/// the labels predicted by a classifier trained neither on them nor, with [`Grouping::Building`], on
/// anything in their building. That is what neighbours look like in use, mistakes included.
///
/// `rows` and `places` are all labelled rooms of the networks in the same order, as a
/// [`crate::dataset::Collection`] gives them; `training` are the indices of those that may be trained on.
/// Returns the rows at these indices, in their order.
///
/// # Errors
/// When the work is cancelled.
pub fn rows_with_predicted_neighbours(
    networks: &[RoomNetwork],
    rows: &[Row],
    places: &[RoomPlace],
    training: &[usize],
    algorithm: Algorithm,
    grouping: Grouping,
    seed: u64,
    work: &Work<'_>,
) -> Result<Vec<Row>, Cancelled> {
    let temporary: Vec<Vec<Label>> = networks
        .iter()
        .map(|network| network.seen_labels(&network.known_labels(), NeighbourLabels::Temporary))
        .collect();
    let with_neighbours = |index: usize, seen: &[Vec<Label>]| {
        let RoomPlace { network, room } = places[index];
        Row { features: networks[network].features(room, &seen[network]), ..rows[index].clone() }
    };
    let first: Vec<Row> = training.iter().map(|&index| with_neighbours(index, &temporary)).collect();
    let Some(folds) = Folds::new(&first, grouping, INNER_FOLDS, seed).ok() else { return Ok(first) };
    let mut seen = temporary;
    for fold in 0..folds.count() {
        let taught = folds.training_rows(fold).into_iter().map(|index| &first[index]);
        let Ok(table) = Table::from_rows(taught) else { continue };
        let classifier = Classifier::train(algorithm, &table, seed_of_part(seed, fold), work)?;
        let mut predicted: Vec<Option<Vec<Distribution>>> = vec![None; networks.len()];
        for index in folds.test_rows(fold) {
            let RoomPlace { network, room } = places[training[index]];
            let distributions = predicted[network].get_or_insert_with(|| {
                let nothing_known = vec![None; networks[network].rooms.len()];
                classify(&classifier, &networks[network], &nothing_known, NeighbourLabels::Predicted).distributions
            });
            seen[network][room] = distributions[room].label();
        }
    }
    Ok(training.iter().map(|&index| with_neighbours(index, &seen)).collect())
}
