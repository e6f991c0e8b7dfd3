//! What lies behind an opening that leads into unexplored space: the label of the room one would enter,
//! from what is known on this side of it. For buildings of which a part is drawn, or that a robot is
//! exploring.

use serde_json::{Map, Value};

use super::{Algorithm, Classifier, Distribution, model_file};
use crate::dataset::RoomNetwork;
use crate::dataset::table::{RoomSource, Table, Values};
use crate::labels::Label;

/// Predicts the label behind an opening. For each label of the room on this side a perceptron on its `F_r`,
/// in which the opening counts in `d` and leads nowhere yet. (Of the four algorithms the best at it: with
/// folds by building, five folds, 47.1 % of the openings of the authors' schools and offices, against 43.9 by
/// nearest neighbours, 41.7 by a decision tree, and 39.1 by the most frequent label.)
#[derive(Clone, Debug)]
pub struct Unknown {
    /// By the label of the room on this side, in the order of [`Label::ALL`]; `None` where too few
    /// openings of such rooms were seen to learn more than shares.
    by_label: [Option<Classifier>; 5],
    /// The distribution of labels behind all openings that were seen.
    anywhere: Distribution,
}

/// From fewer openings only shares are learned.
const LEAST_OPENINGS: usize = 20;

/// An opening between two labelled rooms, as seen from one of them while the other is not explored.
struct Seen {
    from: Label,
    values: Values,
    behind: Label,
    source: RoomSource,
}

impl Unknown {
    /// Learns from all openings between labelled rooms, each from both sides. `None` when there are none.
    pub fn train(networks: &[&RoomNetwork], seed: u64) -> Option<Self> {
        let seen: Vec<Seen> = networks.iter().flat_map(|network| openings(network)).collect();
        if seen.is_empty() {
            return None;
        }
        let mut counts = [0.0; 5];
        for opening in &seen {
            counts[opening.behind.index()] += 1.0;
        }
        let by_label = Label::ALL.map(|label| {
            let of_label = || seen.iter().filter(|opening| opening.from == label);
            if of_label().count() < LEAST_OPENINGS {
                return None;
            }
            let table = Table::from_columns(
                of_label().map(|opening| opening.values).collect(),
                of_label().map(|opening| opening.behind).collect(),
                of_label().map(|opening| opening.source.clone()).collect(),
            );
            Some(Classifier::train(Algorithm::Mlp, &table.ok()?, seed))
        });
        Some(Self { by_label, anywhere: Distribution::smoothed(counts, &Distribution::UNIFORM, 5.0) })
    }

    /// The distribution over the labels of the room behind an opening of a room, should there be one.
    /// `labels` are those of the network's rooms, known or predicted, one for each.
    pub fn predict(&self, network: &RoomNetwork, labels: &[Label], room: usize) -> Distribution {
        let Some(from) = labels.get(room).filter(|_| room < network.rooms.len()) else { return self.anywhere };
        match &self.by_label[from.index()] {
            Some(classifier) => classifier.predict(&network.features(room, labels).values()),
            None => self.anywhere,
        }
    }

    /// The most frequent label behind openings, wherever they are: what one says without looking.
    pub fn most_frequent(&self) -> Label {
        self.anywhere.label()
    }

    /// As data.
    pub fn to_value(&self) -> Value {
        let mut value = Map::new();
        value.insert("anywhere".to_owned(), self.anywhere.probabilities().to_vec().into());
        for (label, classifier) in Label::ALL.into_iter().zip(&self.by_label) {
            let model = classifier.as_ref().map_or(Value::Null, model_file::model_value);
            value.insert(label.letter().to_owned(), model);
        }
        value.into()
    }

    /// From data; `None` when something is missing or not what it should be.
    pub fn from_value(value: &Value) -> Option<Self> {
        let anywhere: [f64; 5] = serde_json::from_value(value.get("anywhere")?.clone()).ok()?;
        let mut by_label = [const { None }; 5];
        for label in Label::ALL {
            by_label[label.index()] = match value.get(label.letter())? {
                Value::Null => None,
                model => Some(model_file::model_of_value(model.clone())?),
            };
        }
        Some(Self { by_label, anywhere: Distribution::from_weights(anywhere) })
    }
}

/// All openings between labelled rooms, from both sides.
fn openings(network: &RoomNetwork) -> Vec<Seen> {
    let mut seen = Vec::new();
    for (index, room) in network.rooms.iter().enumerate() {
        let Some(from) = room.label else { continue };
        for door in &room.doors {
            let Some(other) = door.to.filter(|&other| other != index) else { continue };
            let Some(behind) = network.rooms[other].label else { continue };
            let source = RoomSource { plan: network.plan.as_str().into(), room: room.key.as_str().into() };
            seen.push(Seen { from, values: hidden_values(network, index, other), behind, source });
        }
    }
    seen
}

/// `F_r` of a room while one of its neighbours is not explored.
fn hidden_values(network: &RoomNetwork, room: usize, hidden: usize) -> Values {
    let mut values = [0.0; 8];
    let of = &network.rooms[room];
    values[0] = of.area_m2;
    values[1] = of.axes_ratio;
    values[2] = of.doors.len() as f64;
    for other in of.doors.iter().filter_map(|door| door.to).filter(|&other| other != hidden) {
        let seen = network.rooms[other].label.unwrap_or(network.rooms[other].temporary);
        values[3 + seen.index()] += 1.0;
    }
    values
}

/// How predictions of what lies behind the openings of a plan compare with the truth, see [`score`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanScore {
    pub building: String,
    /// Openings tested, each from both sides.
    pub openings: usize,
    /// Those rightly predicted.
    pub right: usize,
    /// Those with the most frequent label behind them.
    pub most_frequent: usize,
}

/// Tests on plans that were not learned from: each opening between two labelled rooms in turn leads into
/// unexplored space, the rest being known.
pub fn score(unknown: &Unknown, networks: &[&RoomNetwork]) -> Vec<PlanScore> {
    let of_plan = |network: &&RoomNetwork| {
        let seen = openings(network);
        let said = |opening: &Seen| match &unknown.by_label[opening.from.index()] {
            Some(classifier) => classifier.predict(&opening.values).label(),
            None => unknown.anywhere.label(),
        };
        PlanScore {
            building: network.building.clone(),
            openings: seen.len(),
            right: seen.iter().filter(|opening| said(opening) == opening.behind).count(),
            most_frequent: seen.iter().filter(|opening| opening.behind == unknown.most_frequent()).count(),
        }
    };
    networks.iter().map(of_plan).collect()
}
