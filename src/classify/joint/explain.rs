//! Why the joint classifier gave a room its label.

use super::around::Around;
use super::{FirstRound, Group, Joint, group_of};
use crate::classify::Distribution;
use crate::classify::explain::readable;
use crate::classify::numbers::percent;
use crate::dataset::RoomNetwork;
use crate::labels::Label;

/// A prediction and the reasons for it.
#[derive(Clone, Debug, PartialEq)]
pub struct JointExplanation {
    /// The predicted label.
    pub label: Label,
    /// Its probability, 0..=1.
    pub probability: f64,
    /// The prediction of the first round, which knows no labels of other rooms.
    pub first: Distribution,
    /// The effect of each group of features, strongest support for the label first.
    pub groups: Vec<GroupEffect>,
    /// The effect of each room it opens to, strongest support for the label first.
    pub neighbours: Vec<NeighbourEffect>,
    /// Facts about the room in words, by group.
    facts: Vec<(Group, String)>,
}

/// The effect of a group of features: the second round is repeated with each of them at its median over
/// the training rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupEffect {
    pub group: Group,
    /// The probability of the predicted label if the group were typical.
    pub probability_if_typical: f64,
}

/// The effect of a neighbour's label, known or predicted: the second round is repeated with no belief
/// about that room.
#[derive(Clone, Debug, PartialEq)]
pub struct NeighbourEffect {
    /// Its index in the network.
    pub room: usize,
    /// Its key.
    pub key: String,
    /// Its label: the known one, else the first round's.
    pub label: Label,
    pub is_known: bool,
    /// The probability of the predicted label if all labels were equally likely for the neighbour.
    pub probability_if_unknown: f64,
}

/// Effects below this are not worth mentioning.
const MATTERS: f64 = 0.02;

/// The most groups, and neighbours, named in a sentence; the data have all.
const NAMED: usize = 3;

impl Joint {
    /// Why a room gets its label; `None` for a room that is not in the network. `known` as in
    /// [`Joint::predict`].
    pub fn explain(&self, network: &RoomNetwork, known: &[Option<Label>], room: usize) -> Option<JointExplanation> {
        self.explain_from(&self.first_round(network), network, known, room)
    }

    /// The same after the first round over the same network.
    pub fn explain_from(
        &self,
        round: &FirstRound,
        network: &RoomNetwork,
        known: &[Option<Label>],
        room: usize,
    ) -> Option<JointExplanation> {
        let it = network.rooms.get(room)?;
        let FirstRound { looked, opinions: first } = round;
        let values = |first: &[Distribution], known: &[Option<Label>]| {
            looked.with_labels_around(room, &Around::new(&looked.view, first, known), &self.left_out)
        };
        // What is removed for one neighbour is restored for the next.
        let (mut without, mut unsure) = (known.to_vec(), first.clone());
        let told = values(first, known);
        let distribution = self.answer(&told);
        let label = distribution.label();
        let probability = distribution.probability(label);
        let mut groups: Vec<GroupEffect> = Group::ALL
            .into_iter()
            .map(|group| {
                let mut typical = told.clone();
                for (feature, value) in typical.iter_mut().enumerate() {
                    if group_of(feature) == Some(group) {
                        *value = self.typical[feature];
                    }
                }
                GroupEffect { group, probability_if_typical: self.answer(&typical).probability(label) }
            })
            .collect();
        groups.sort_by(|p, q| p.probability_if_typical.total_cmp(&q.probability_if_typical));
        let mut neighbours: Vec<NeighbourEffect> = looked.view.joined[room]
            .iter()
            .filter(|&&other| other != room)
            .map(|&other| {
                let known_label = known.get(other).copied().flatten();
                if let Some(label) = without.get_mut(other) {
                    *label = None;
                }
                unsure[other] = Distribution::UNIFORM;
                let told = values(&unsure, &without);
                if let Some(label) = without.get_mut(other) {
                    *label = known_label;
                }
                unsure[other] = first[other];
                NeighbourEffect {
                    room: other,
                    key: network.rooms[other].key.clone(),
                    label: known_label.unwrap_or_else(|| first[other].label()),
                    is_known: known_label.is_some(),
                    probability_if_unknown: self.answer(&told).probability(label),
                }
            })
            .collect();
        neighbours.sort_by(|p, q| p.probability_if_unknown.total_cmp(&q.probability_if_unknown));
        // The facts that sentences name.
        let all = network.rooms.len();
        let larger = network.rooms.iter().filter(|other| other.area_m2 > it.area_m2).count();
        let mut areas: Vec<f64> = network.rooms.iter().map(|room| room.area_m2).collect();
        areas.sort_by(f64::total_cmp);
        let median_m2 = (areas[(all - 1) / 2] + areas[all / 2]) / 2.0;
        let joined = looked.view.joined[room].len();
        let alike = areas.iter().filter(|&&area| (area / it.area_m2).ln().abs() <= super::view::ALIKE).count() - 1;
        let facts = vec![
            (
                Group::Size,
                format!(
                    "{:.1} m², {:.1} times the plan's median, {} of {all} rooms are larger",
                    it.area_m2,
                    it.area_m2 / median_m2,
                    larger
                ),
            ),
            (
                Group::Form,
                format!(
                    "{:.1} times as long as wide, {} walls",
                    it.form.length_m / it.form.width_m.max(1e-9),
                    it.form.walls
                ),
            ),
            (Group::Openings, format!("{} to {joined} of the rooms", it.doors.len())),
            (Group::Alike, format!("{alike} others of about its area")),
        ];
        Some(JointExplanation { label, probability, first: first[room], groups, neighbours, facts })
    }
}

impl JointExplanation {
    /// The reason in one to three sentences.
    pub fn words(&self) -> String {
        let label = self.label.name();
        let groups = self.groups.iter().filter(|effect| effect.probability_if_typical < self.probability - MATTERS);
        let groups: Vec<String> = groups
            .take(NAMED)
            .map(|effect| {
                let fact = self.facts.iter().find(|(group, _)| *group == effect.group);
                let fact = fact.map(|(_, fact)| format!("{fact}; ")).unwrap_or_default();
                let probability = percent(effect.probability_if_typical);
                format!("{} ({fact}if typical {probability})", effect.group.words())
            })
            .collect();
        let mut words = if groups.is_empty() {
            format!("No single trait decides for {label} ({}).", percent(self.probability))
        } else {
            format!("What speaks for {label} ({}): {}.", percent(self.probability), groups.join(", "))
        };
        let neighbours: Vec<String> = self
            .neighbours
            .iter()
            .filter(|effect| effect.probability_if_unknown < self.probability - MATTERS)
            .take(NAMED)
            .map(|effect| {
                let how = if effect.is_known { "known" } else { "predicted" };
                format!("{} ({how}: {})", readable(&effect.key), effect.label.name())
            })
            .collect();
        if !neighbours.is_empty() {
            words.push_str(&format!(" So do the rooms beside it: {}.", neighbours.join(", ")));
        }
        if self.first.label() != self.label {
            words.push_str(&format!(" By itself it would be a {}.", self.first.label().name()));
        }
        words
    }
}
