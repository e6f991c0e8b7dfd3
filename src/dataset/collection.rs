use std::collections::{BTreeMap, BTreeSet};

use super::folds::group_of;
use super::{LeftOut, RoomNetwork, Row};
use crate::base::random::Random;
use crate::features::NeighbourLabels;
use crate::labels::{Label, Typology};

/// Labelled rooms of many plans, to learn from and to test on.
#[derive(Clone, Debug)]
pub enum Collection {
    /// Plans, from which features can be computed for any choice of neighbours' labels.
    Plans(Vec<RoomNetwork>),
    /// Rows of a dataset file: features already computed, neighbours unknown.
    Rows(Vec<Row>),
}

/// A room of a collection of plans: the index of its network, and its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct RoomPlace {
    pub network: usize,
    pub room: usize,
}

impl Collection {
    /// The labelled rooms, in the order of the plans. `None` for a choice of neighbours' labels that the
    /// collection cannot provide: rows of a file are fixed, and count as [`NeighbourLabels::True`]. With
    /// [`NeighbourLabels::Predicted`] the rows are those that repeated prediction starts from.
    pub fn rows(&self, neighbours: NeighbourLabels) -> Option<Vec<Row>> {
        match self {
            Self::Plans(networks) => Some(networks.iter().flat_map(|network| rows_of(network, neighbours)).collect()),
            Self::Rows(rows) => (neighbours == NeighbourLabels::True).then(|| rows.clone()),
        }
    }

    /// The networks; none for rows of a file.
    pub fn networks(&self) -> &[RoomNetwork] {
        match self {
            Self::Plans(networks) => networks,
            Self::Rows(_) => &[],
        }
    }

    /// The position of each labelled room, in the order of [`Collection::rows`]; none for rows of a file.
    pub fn places(&self) -> Vec<RoomPlace> {
        let mut places = Vec::new();
        for (index, network) in self.networks().iter().enumerate() {
            places.extend(network.labelled().map(|room| RoomPlace { network: index, room }));
        }
        places
    }

    /// The choices of neighbours' labels that the collection can provide.
    pub fn neighbour_modes(&self) -> &'static [NeighbourLabels] {
        match self {
            Self::Plans(_) => &NeighbourLabels::ALL,
            Self::Rows(_) => &[NeighbourLabels::True],
        }
    }

    /// The folds that the rows carry, see [`Row::fold`]; `None` where one carries none.
    pub fn given_folds(&self) -> Option<Vec<usize>> {
        self.rows(NeighbourLabels::True)?.iter().map(|row| row.fold).collect()
    }

    /// What the plans left out.
    pub fn left_out(&self) -> LeftOut {
        let mut left_out = LeftOut::default();
        for network in self.networks() {
            left_out.add(&network.left_out);
        }
        left_out
    }

    /// The typologies that occur, sorted.
    pub fn typologies(&self) -> Vec<Typology> {
        let mut typologies: Vec<Typology> = match self {
            Self::Plans(networks) => networks.iter().filter_map(|network| network.typology.clone()).collect(),
            Self::Rows(rows) => rows.iter().filter_map(|row| row.typology.clone()).collect(),
        };
        typologies.sort_unstable();
        typologies.dedup();
        typologies
    }

    /// The part with one typology.
    #[must_use]
    pub fn of_typology(&self, typology: &Typology) -> Self {
        self.filtered(|of_part, _| of_part == Some(typology))
    }

    /// At most about `most_rooms` labelled rooms of each typology: whole buildings (with their near twins) in random order, the
    /// last one included that makes the number full. The same seed gives the same part.
    #[must_use]
    pub fn at_most(&self, most_rooms: usize, seed: u64) -> Self {
        let mut kept: BTreeSet<(Option<Typology>, String)> = BTreeSet::new();
        let mut rooms_of: BTreeMap<(Option<Typology>, String), usize> = BTreeMap::new();
        for row in self.rows(NeighbourLabels::True).unwrap_or_default() {
            *rooms_of.entry((row.typology.clone(), group_of(&row).to_owned())).or_default() += 1;
        }
        let mut typologies: Vec<Option<Typology>> = rooms_of.keys().map(|(typology, _)| typology.clone()).collect();
        typologies.dedup();
        for typology in typologies {
            let mut buildings: Vec<_> = rooms_of.iter().filter(|((of, _), _)| *of == typology).collect();
            Random::new(seed).shuffle(&mut buildings);
            let mut rooms = 0;
            for (building, count) in buildings {
                if rooms >= most_rooms {
                    break;
                }
                rooms += count;
                kept.insert(building.clone());
            }
        }
        self.filtered(|typology, building| kept.contains(&(typology.cloned(), building.to_owned())))
    }

    fn filtered(&self, keep: impl Fn(Option<&Typology>, &str) -> bool) -> Self {
        match self {
            Self::Plans(networks) => {
                let kept = |network: &&RoomNetwork| keep(network.typology.as_ref(), &network.group);
                Self::Plans(networks.iter().filter(kept).cloned().collect())
            }
            Self::Rows(rows) => {
                let kept = |row: &&Row| keep(row.typology.as_ref(), group_of(row));
                Self::Rows(rows.iter().filter(kept).cloned().collect())
            }
        }
    }
}

/// The labelled rooms of one network as rows.
fn rows_of(network: &RoomNetwork, neighbours: NeighbourLabels) -> Vec<Row> {
    let seen: Vec<Label> = network.seen_labels(&network.known_labels(), neighbours);
    network.rows_seeing(&seen).collect()
}
