//! Wrong labels, planted among those of plans, and how soon an order of the rooms shows them.

use std::collections::BTreeSet;

use enfilade::base::random::Random;
use enfilade::dataset::RoomNetwork;
use enfilade::edit;
use enfilade::labels::Label;
use enfilade::plan::{LabelOrigin, Plan, RoomId, RoomLabel};

/// Which wrong label a room gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// Any of the other four, each as likely.
    Random,
    /// That of the neighbouring size: small and medium, medium and big; a corridor and a hall are taken for each other.
    Neighbouring,
}

impl Wrong {
    pub const ALL: [Self; 2] = [Self::Random, Self::Neighbouring];

    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Neighbouring => "neighbouring",
        }
    }

    fn choices(self, label: Label) -> Vec<Label> {
        match (self, label) {
            (Self::Random, _) => Label::ALL.into_iter().filter(|&other| other != label).collect(),
            (_, Label::SmallRoom | Label::BigRoom) => vec![Label::MediumRoom],
            (_, Label::MediumRoom) => vec![Label::SmallRoom, Label::BigRoom],
            (_, Label::Corridor) => vec![Label::Hall],
            (_, Label::Hall) => vec![Label::Corridor],
        }
    }
}

/// What rooms say they are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Functions {
    /// What they are for: of the wrong ones only the label is wrong.
    Kept,
    /// Nothing, none of them.
    Unknown,
    /// The wrong ones something that goes with the wrong label: nothing but the drawing can tell.
    Wrong,
}

impl Functions {
    pub const ALL: [Self; 3] = [Self::Kept, Self::Unknown, Self::Wrong];

    pub fn name(self) -> &'static str {
        match self {
            Self::Kept => "kept",
            Self::Unknown => "unknown",
            Self::Wrong => "wrong too",
        }
    }
}

/// A file with its plans.
#[derive(Clone)]
pub struct File {
    pub name: String,
    pub plans: Vec<Plan>,
}

/// Gives a share of the labelled rooms of `networks`, which are those of the files, a wrong label. Returns the files with it, and
/// which rooms have one. The same seed does the same.
pub fn plant(
    files: &[File],
    networks: &[RoomNetwork],
    share: f64,
    wrong: Wrong,
    functions: Functions,
    seed: u64,
) -> (Vec<File>, BTreeSet<(String, RoomId)>) {
    let mut rooms: Vec<(&str, RoomId, Label)> = Vec::new();
    // The functions of each label, as often as they occur.
    let mut of_label: [Vec<&str>; 5] = Default::default();
    for network in networks {
        for room in network.labelled().map(|room| &network.rooms[room]) {
            let Some(label) = room.label else { continue };
            rooms.push((&network.file, room.id, label));
            if !room.function.is_empty() {
                of_label[label.index()].push(&room.function);
            }
        }
    }
    let mut random = Random::new(seed);
    let wanted = (share * rooms.len() as f64).round() as usize;
    let mut order: Vec<usize> = (0..rooms.len()).collect();
    random.shuffle(&mut order);
    let planted: BTreeSet<usize> = order.into_iter().take(wanted).collect();
    let mut changed: Vec<File> = files.to_vec();
    let mut at: std::collections::BTreeMap<(&str, RoomId), (usize, usize)> = std::collections::BTreeMap::new();
    for (file, of) in files.iter().enumerate() {
        for (plan, it) in of.plans.iter().enumerate() {
            for (id, _) in it.rooms() {
                at.entry((&of.name, id)).or_insert((file, plan));
            }
        }
    }
    let mut keys = BTreeSet::new();
    for (index, &(file, id, label)) in rooms.iter().enumerate() {
        let is_planted = planted.contains(&index);
        let choices = wrong.choices(label);
        let given = if is_planted { choices[random.below(choices.len())] } else { label };
        let Some(&(of_file, of_plan)) = at.get(&(file, id)) else { continue };
        let plan = &mut changed[of_file].plans[of_plan];
        let fitting = &of_label[given.index()];
        let function = match functions {
            Functions::Unknown => Some(""),
            Functions::Wrong if is_planted && !fitting.is_empty() => Some(fitting[random.below(fitting.len())]),
            _ => None,
        };
        if let Some(function) = function {
            *plan = edit::set_function(plan, id, function).unwrap_or_else(|_| plan.clone());
        }
        if is_planted || functions == Functions::Unknown {
            let own = RoomLabel { label: given, origin: LabelOrigin::Person };
            *plan = edit::set_label(plan, id, Some(own)).unwrap_or_else(|_| plan.clone());
        }
        if is_planted {
            keys.insert((file.to_owned(), id));
        }
    }
    (changed, keys)
}

/// The share of the planted rooms among the first `share` of an order of all.
pub fn found(order: &[(String, RoomId)], planted: &BTreeSet<(String, RoomId)>, share: f64) -> f64 {
    let first = (share * order.len() as f64).floor() as usize;
    let found = order[..first.min(order.len())].iter().filter(|key| planted.contains(*key)).count();
    found as f64 / planted.len().max(1) as f64
}
