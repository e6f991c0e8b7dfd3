//! Why the joint classifier gave a room its label.

use super::around::Around;
use super::{FirstRound, Group, Joint, group_of, view};
use crate::base::units::Units;
use crate::base::wording::count;
use crate::classify::Distribution;
use crate::classify::numbers::times;
use crate::classify::why::{OnPlan, Point, Why, and_list, area, nothing_stands_out, sorted, speaks};
use crate::dataset::{NetworkRoom, RoomNetwork};
use crate::labels::{Label, function_title};
use crate::plan::OpeningKind;

/// A prediction and the reasons for it.
#[derive(Clone, Debug, PartialEq)]
pub struct JointExplanation {
    /// The predicted label.
    pub label: Label,
    pub distribution: Distribution,
    /// The prediction of the first round, which knows no labels of other rooms.
    pub first: Distribution,
    /// The effect of each group of features, strongest support for the label first.
    pub groups: Vec<GroupEffect>,
    /// The effect of each room it opens to, strongest support for the label first.
    pub neighbours: Vec<NeighbourEffect>,
    seen: Seen,
}

/// The effect of a group of features: the second round is repeated with each of them at its median over
/// the training rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroupEffect {
    pub group: Group,
    /// What is predicted if the group is typical.
    pub if_typical: Distribution,
}

/// The effect of a neighbour's label, known or predicted: the second round is repeated with no belief
/// about that room.
#[derive(Clone, Debug, PartialEq)]
pub struct NeighbourEffect {
    /// Its index in the network.
    pub room: usize,
    /// Its name, or else its function; empty if it has neither.
    pub name: String,
    /// Its label: the known one, else the first round's.
    pub label: Label,
    pub is_known: bool,
    /// What is predicted if all labels are equally likely for the neighbour.
    pub if_unknown: Distribution,
}

/// What the sentences say of a room and its plan.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    area_m2: f64,
    median_m2: f64,
    /// Rooms of the plan, this one included, and how many of them are larger.
    rooms: usize,
    larger: usize,
    ratio: f64,
    walls: u32,
    convexity: f64,
    /// Its openings by kind, and how many lead to no classified room.
    doors: Vec<(OpeningKind, usize)>,
    outside: usize,
    /// Share of the shortest ways between other rooms that lead through it.
    betweenness: f64,
    /// The rooms that it opens to, their areas in m², and their most openings to other rooms.
    joined: Vec<usize>,
    joined_m2: Vec<f64>,
    most_joined: usize,
    /// The labels of these rooms, with how many have each.
    joined_labels: Vec<(Label, usize)>,
    /// Whether some of these labels were predicted, though another was given.
    are_against_given: bool,
    /// Other rooms of about its area.
    alike: Vec<usize>,
    /// The rooms it is compared with.
    compared: Vec<usize>,
    /// Whether these are a flat's.
    is_flat: bool,
}

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
        network.rooms.get(room)?;
        let FirstRound { looked, opinions: first, .. } = round;
        let values = |first: &[Distribution], known: &[Option<Label>]| {
            looked.with_labels_around(room, &Around::new(&looked.view, first, known), &self.left_out)
        };
        // What is removed for one neighbour is restored for the next.
        let (mut without, mut unsure) = (known.to_vec(), first.clone());
        let told = values(first, known);
        let distribution = self.answer(&told);
        let label = distribution.label();
        let mut groups: Vec<GroupEffect> = Group::ALL
            .into_iter()
            .map(|group| {
                let mut typical = told.clone();
                for (feature, value) in typical.iter_mut().enumerate() {
                    if group_of(feature) == Some(group) {
                        *value = self.typical[feature];
                    }
                }
                GroupEffect { group, if_typical: self.answer(&typical) }
            })
            .collect();
        groups.sort_by(|p, q| p.if_typical.probability(label).total_cmp(&q.if_typical.probability(label)));
        let mut neighbours: Vec<NeighbourEffect> = looked
            .view
            .joined(room)
            .filter(|&other| other != room)
            .map(|other| {
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
                    name: name(&network.rooms[other]),
                    label: known_label.unwrap_or_else(|| first[other].label()),
                    is_known: known_label.is_some(),
                    if_unknown: self.answer(&told),
                }
            })
            .collect();
        neighbours.sort_by(|p, q| p.if_unknown.probability(label).total_cmp(&q.if_unknown.probability(label)));
        let seen = Seen::of(network, round, room, &neighbours);
        Some(JointExplanation { label, distribution, first: first[room], groups, neighbours, seen })
    }
}

/// What people call a room.
fn name(room: &NetworkRoom) -> String {
    if room.name.is_empty() { function_title(&room.function) } else { room.name.clone() }
}

impl Seen {
    fn of(network: &RoomNetwork, round: &FirstRound, room: usize, neighbours: &[NeighbourEffect]) -> Self {
        let it = &network.rooms[room];
        let view = &round.looked.view;
        let compared = view.compared_with(room);
        let mut areas: Vec<f64> = compared.iter().map(|&room| network.rooms[room].area_m2).collect();
        let larger = areas.iter().filter(|&&area_m2| area_m2 > it.area_m2).count();
        areas.sort_by(f64::total_cmp);
        let rooms = areas.len();
        let is_alike =
            |other: &usize| *other != room && (view.log_area[*other] - view.log_area[room]).abs() <= super::view::ALIKE;
        let of_kind = |kind: OpeningKind| (kind, it.doors.iter().filter(|door| door.kind == kind).count());
        let of_label = |label: Label| (label, neighbours.iter().filter(|neighbour| neighbour.label == label).count());
        let betweenness = view::FEATURES.iter().position(|(_, name)| *name == "betweenness");
        let joined: Vec<usize> = view.joined(room).filter(|&other| other != room).collect();
        Self {
            area_m2: it.area_m2,
            median_m2: (areas[(rooms - 1) / 2] + areas[rooms / 2]) / 2.0,
            rooms,
            larger,
            ratio: it.axes_ratio.max(1.0 / it.axes_ratio.max(1e-9)),
            walls: it.form.walls,
            convexity: it.form.convexity,
            doors: OpeningKind::ALL.map(of_kind).into_iter().filter(|(_, count)| *count > 0).collect(),
            outside: it.doors.iter().filter(|door| door.to.is_none()).count(),
            betweenness: betweenness.map_or(0.0, |feature| f64::from(round.looked.rows.of(room)[feature])),
            joined_m2: joined.iter().map(|&other| network.rooms[other].area_m2).collect(),
            most_joined: joined.iter().map(|&other| view.joined(other).len()).max().unwrap_or_default(),
            joined,
            is_flat: view.flat[room].is_some(),
            joined_labels: Label::ALL.map(of_label).into_iter().filter(|(_, count)| *count > 0).collect(),
            are_against_given: false,
            alike: compared.iter().copied().filter(is_alike).collect(),
            compared,
        }
    }

    /// What is seen of a group of features, in words, and where. `itself` is the label that the room has whatever the rooms around
    /// it are, if that is worth saying.
    fn of_group(&self, group: Group, itself: Option<Label>, units: Units) -> (String, OnPlan) {
        match group {
            Group::Size => (self.size(units), OnPlan::Area),
            Group::Form => {
                let bent = if self.convexity < 0.95 { ", with a corner that points inwards" } else { "" };
                (format!("{}, {}{bent}", times(self.ratio), count(self.walls as usize, "wall")), OnPlan::Axes)
            }
            Group::Openings => (self.openings(), OnPlan::Openings(None)),
            Group::Place => (self.place(), OnPlan::Rooms(self.joined.clone())),
            Group::Neighbours => (self.neighbours(units), OnPlan::Rooms(self.joined.clone())),
            Group::Alike => {
                let words = match self.alike.len() {
                    0 => "no other room is about as large".to_owned(),
                    1 => "one other room is about as large".to_owned(),
                    others => format!("{others} other rooms are about as large"),
                };
                (words, OnPlan::Rooms(self.alike.clone()))
            }
            Group::Plan => {
                let kind = if self.is_flat { "flat" } else { "plan" };
                let words = format!(
                    "a {kind} of {}, half of them over {}",
                    count(self.rooms, "room"),
                    area(self.median_m2, units)
                );
                (words, OnPlan::Rooms(self.compared.clone()))
            }
            Group::Labels => {
                let labels: Vec<String> =
                    self.joined_labels.iter().map(|(label, rooms)| count(*rooms, label.name())).collect();
                let opens = match labels.as_slice() {
                    [] => "it opens to no other room".to_owned(),
                    labels => format!("it opens to {}", and_list(labels)),
                };
                let opens = if self.are_against_given { opens + " (as predicted)" } else { opens };
                let itself = itself.map(|label| format!("it looks like a {label} by itself, and ")).unwrap_or_default();
                (itself + &opens, OnPlan::Rooms(self.joined.clone()))
            }
        }
    }

    fn size(&self, units: Units) -> String {
        // The paper's area, not the clear one that the drawing shows.
        let own = format!("{} along axes", area(self.area_m2, units));
        let others = self.rooms - 1;
        match self.larger {
            _ if others == 0 => own,
            0 => format!("{own}, the largest of {} rooms", self.rooms),
            larger if larger == others => format!("{own}, the smallest of {} rooms", self.rooms),
            larger => {
                let kind = if self.is_flat { "flat" } else { "plan" };
                let are = if larger == 1 { "is" } else { "are" };
                format!(
                    "{own}, {:.1} times the {kind}'s median; {larger} of the {others} other rooms {are} larger",
                    self.area_m2 / self.median_m2
                )
            }
        }
    }

    fn openings(&self) -> String {
        if self.doors.is_empty() {
            return "no openings".to_owned();
        }
        let doors: Vec<String> = self.doors.iter().map(|(kind, doors)| count(*doors, kind.name())).collect();
        let rooms = match self.joined.len() {
            0 => String::new(),
            rooms => format!(", to {}", count(rooms, "room")),
        };
        let outside = match self.outside {
            0 => "",
            _ if self.joined.is_empty() => ", to the outside",
            _ => " and the outside",
        };
        format!("{}{rooms}{outside}", and_list(&doors))
    }

    fn place(&self) -> String {
        match self.joined.len() {
            0 => "no way leads to another room".to_owned(),
            1 => "a dead end: it opens to one room only".to_owned(),
            _ if self.betweenness < 0.005 => "no way between other rooms leads through it".to_owned(),
            _ => format!("{:.0} % of the ways between other rooms lead through it", 100.0 * self.betweenness),
        }
    }

    fn neighbours(&self, units: Units) -> String {
        let least_m2 = self.joined_m2.iter().copied().fold(f64::INFINITY, f64::min);
        let most_m2 = self.joined_m2.iter().copied().fold(0.0, f64::max);
        let most = count(self.most_joined, "room");
        match self.joined_m2.len() {
            0 => "it opens to no other room".to_owned(),
            1 => format!("it opens to a room of {}, which opens to {most}", area(most_m2, units)),
            _ => {
                let (least, largest) = (area(least_m2, units), area(most_m2, units));
                format!("it opens to rooms of {least} to {largest}, one of which opens to {most}")
            }
        }
    }
}

impl JointExplanation {
    /// One explanation from those of several joint classifiers of one room, each with its weight: of the label that was chosen
    /// in the end. Every probability is their weighted mean. `None` if there is none.
    pub fn pooled(of: Vec<(f64, Self)>, label: Label) -> Option<Self> {
        let weights: Vec<f64> = of.iter().map(|(weight, _)| *weight).collect();
        let pool = |pick: &dyn Fn(&Self) -> Distribution| {
            let said: Vec<Distribution> = of.iter().map(|(_, it)| pick(it)).collect();
            Distribution::mean(&said, &weights)
        };
        let (_, one) = of.first()?;
        let group = |effect: &GroupEffect| {
            let find = |it: &Self| it.groups.iter().find(|other| other.group == effect.group).map(|it| it.if_typical);
            GroupEffect { if_typical: pool(&|it| find(it).unwrap_or(it.distribution)), ..*effect }
        };
        let neighbour = |effect: &NeighbourEffect| {
            let find = |it: &Self| it.neighbours.iter().find(|other| other.room == effect.room).map(|it| it.if_unknown);
            NeighbourEffect { if_unknown: pool(&|it| find(it).unwrap_or(it.distribution)), ..effect.clone() }
        };
        Some(Self {
            label,
            distribution: pool(&|it| it.distribution),
            first: pool(&|it| it.first),
            groups: one.groups.iter().map(group).collect(),
            neighbours: one.neighbours.iter().map(neighbour).collect(),
            seen: one.seen.clone(),
        })
    }

    /// The same, which says where labels of other rooms that were predicted are not those that were given.
    pub fn beside_given(mut self, given: &[Option<Label>]) -> Self {
        let is_against =
            |it: &NeighbourEffect| given.get(it.room).copied().flatten().is_some_and(|label| label != it.label);
        self.seen.are_against_given = self.neighbours.iter().any(is_against);
        self
    }

    /// The probability of the predicted label, 0..=1.
    pub fn probability(&self) -> f64 {
        self.distribution.probability(self.label)
    }

    /// The reason as people read it, with areas in these units.
    pub fn why(&self, units: Units) -> Why {
        let (label, first) = (self.label, self.first.label());
        let gain = |without: &Distribution, of: Label| self.distribution.probability(of) - without.probability(of);
        let groups = self.groups.iter().filter_map(|effect| {
            let (speaks, change) = speaks(label, |of| gain(&effect.if_typical, of))?;
            // Under a sign of another label it would contradict itself.
            let itself = (first == label && speaks.label == label).then_some(label);
            let (seen, on_plan) = self.seen.of_group(effect.group, itself, units);
            Some((Point { seen, speaks: Some(speaks), on_plan }, change))
        });
        let neighbours = self.neighbours.iter().filter_map(|effect| {
            let (speaks, change) = speaks(label, |of| gain(&effect.if_unknown, of))?;
            let name = if effect.name.is_empty() { "an unnamed room" } else { &effect.name };
            let probably = if effect.is_known { "" } else { "probably " };
            let seen = format!("it opens to {name}, {probably}a {}", effect.label);
            Some((Point { seen, speaks: Some(speaks), on_plan: OnPlan::Rooms(vec![effect.room]) }, change))
        });
        let points = sorted(label, groups.chain(neighbours).collect());
        let mut conclusion = if points.is_empty() { nothing_stands_out(label) } else { String::new() };
        if first != label {
            let gap = if conclusion.is_empty() { "" } else { " " };
            conclusion.push_str(&format!("{gap}By itself, without the rooms around it, it would be a {first}."));
        }
        Why { label, points, conclusion }
    }
}
