//! Changing many plans or rooms of a workspace at once: what would change, counted first, and the change of one plan.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::{PlanKey, PlanRow, RoomKey, RoomRow, Workspace};
use crate::base::wording::count;
use crate::edit::{self, EditError};
use crate::labels::{Label, Typology, normalised_function};
use crate::plan::{LabelOrigin, Meta, Plan, RoomId, RoomLabel};

/// A change of many plans or rooms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Change {
    /// The building that plans name; empty for none.
    Building(String),
    Typology(Option<Typology>),
    /// What rooms are for; empty for unknown.
    Function(String),
    /// The rooms' own label; `None`: the one that their functions give.
    Label(Option<Label>),
}

impl Change {
    /// Whether it changes plans, not rooms.
    pub const fn is_of_plans(&self) -> bool {
        matches!(self, Self::Building(_) | Self::Typology(_))
    }

    /// What plans or rooms get, in words: 'the typology school'.
    pub fn words(&self) -> String {
        match self {
            Self::Building(name) if name.trim().is_empty() => "no building".to_owned(),
            Self::Building(name) => format!("the building ‘{}’", name.trim()),
            Self::Typology(None) => "no typology".to_owned(),
            Self::Typology(Some(typology)) => format!("the typology {typology}"),
            Self::Function(function) if function.trim().is_empty() => "no function".to_owned(),
            Self::Function(function) => format!("the function ‘{}’", function.trim()),
            Self::Label(None) => "the label of their function".to_owned(),
            Self::Label(Some(label)) => format!("the label {label}"),
        }
    }
}

/// What a change is made to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selected {
    pub plans: BTreeSet<PlanKey>,
    /// Rooms; for a change of plans, the plans that they are in.
    pub rooms: BTreeSet<RoomKey>,
}

impl Selected {
    /// All plans in some rows.
    pub fn plans_in(workspace: &Workspace, rows: &[PlanRow]) -> Self {
        let read = rows.iter().filter(|row| row.plan.is_some());
        Self { plans: read.filter_map(|row| workspace.plan_key(*row)).collect(), rooms: BTreeSet::new() }
    }

    /// All rooms in some rows.
    pub fn rooms_in(workspace: &Workspace, rows: &[RoomRow]) -> Self {
        Self { plans: BTreeSet::new(), rooms: rows.iter().filter_map(|row| workspace.room_key(*row)).collect() }
    }

    pub fn is_empty(&self) -> bool {
        self.plans.is_empty() && self.rooms.is_empty()
    }

    /// How many there are, in words.
    pub fn counted(&self) -> String {
        match (self.plans.len(), self.rooms.len()) {
            (0, rooms) => count(rooms, "room"),
            (plans, _) => count(plans, "plan"),
        }
    }
}

/// What a change would do, before it is done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Planned {
    /// What changes, by file: the plans of a file by their place, each with the rooms that change (none for a change of
    /// the plan).
    pub files: BTreeMap<Arc<str>, BTreeMap<u32, BTreeSet<RoomId>>>,
    /// Plans or rooms that change, by what the change is of.
    pub changed: usize,
    /// Plans or rooms that are so already.
    pub same: usize,
    /// Plans or rooms in files that cannot be written.
    pub unwritable: usize,
    /// Those files.
    pub foreign: BTreeSet<Arc<str>>,
}

impl Planned {
    /// What was done, in a sentence without its full stop: '12 rooms in 3 plans got the label hall'.
    pub fn done(&self, change: &Change) -> String {
        format!("{} got {}", self.counted(change), change.words())
    }

    fn counted(&self, change: &Change) -> String {
        if change.is_of_plans() {
            return count(self.changed, "plan");
        }
        let plans: usize = self.files.values().map(BTreeMap::len).sum();
        let within = if self.changed > 0 { format!(" in {}", count(plans, "plan")) } else { String::new() };
        format!("{}{within}", count(self.changed, "room"))
    }

    /// In a sentence without its full stop: '12 rooms in 3 plans get the label hall, 2 have it already'.
    pub fn said(&self, change: &Change) -> String {
        let mut said = self.counted(change);
        said.push_str(&format!(" {} {}", if self.changed == 1 { "gets" } else { "get" }, change.words()));
        if self.same > 0 {
            said.push_str(&format!(", {} {} it already", self.same, if self.same == 1 { "has" } else { "have" }));
        }
        if self.unwritable > 0 {
            let files = count(self.foreign.len(), "file");
            said.push_str(&format!(", {} in {files} of another format stay as they are", self.unwritable));
        }
        said
    }
}

/// Whether plans are written back to a file of this name: those of Enfilade's own format are.
pub fn is_writable(path: &str) -> bool {
    path.to_lowercase().ends_with(".plan.json")
}

/// What a change would do.
pub fn planned(workspace: &Workspace, selected: &Selected, change: &Change) -> Planned {
    let mut planned = Planned::default();
    if change.is_of_plans() {
        let of_rooms = selected.rooms.iter().map(|room| &room.plan);
        let plans: BTreeSet<&PlanKey> = selected.plans.iter().chain(of_rooms).collect();
        for key in plans {
            let Some((file, Some(plan))) = workspace.row_of(key).and_then(|row| workspace.plan(row)) else { continue };
            let is_same = match change {
                Change::Building(name) => plan.building.trim() == name.trim(),
                Change::Typology(typology) => plan.typology == *typology,
                Change::Function(_) | Change::Label(_) => true,
            };
            planned.count(&file.path, key.storey, None, is_same);
        }
        return planned;
    }
    let whole = selected.plans.iter().filter_map(|key| workspace.row_of(key)).flat_map(|row| {
        let rooms = workspace.plan(row).and_then(|(_, plan)| plan).map_or(0, |plan| plan.rooms.len() as u32);
        (0..rooms).filter_map(move |room| Some(RoomRow { file: row.file, plan: row.plan?, room }))
    });
    let keys: BTreeSet<RoomKey> =
        whole.filter_map(|row| workspace.room_key(row)).chain(selected.rooms.iter().cloned()).collect();
    for key in keys {
        let Some((file, Some(plan))) = workspace.row_of(&key.plan).and_then(|row| workspace.plan(row)) else {
            continue;
        };
        let Ok(at) = plan.rooms.binary_search_by_key(&key.room, |room| room.id) else { continue };
        let room = &plan.rooms[at];
        let is_same = match change {
            Change::Function(function) => room.function.trim() == function.trim(),
            Change::Label(None) => room.origin.is_none(),
            Change::Label(Some(label)) => room.origin == Some(LabelOrigin::Person) && room.label() == Some(*label),
            Change::Building(_) | Change::Typology(_) => true,
        };
        planned.count(&file.path, key.plan.storey, Some(key.room), is_same);
    }
    planned
}

impl Planned {
    fn count(&mut self, path: &Arc<str>, storey: u32, room: Option<RoomId>, is_same: bool) {
        if is_same {
            self.same += 1;
        } else if is_writable(path) {
            self.changed += 1;
            self.files.entry(path.clone()).or_default().entry(storey).or_default().extend(room);
        } else {
            self.unwritable += 1;
            self.foreign.insert(path.clone());
        }
    }
}

/// A plan with the change made: to itself, or to those of these rooms that it has.
///
/// # Errors
/// When the edit is refused.
pub fn changed(plan: &Plan, rooms: &BTreeSet<RoomId>, change: &Change) -> Result<Plan, EditError> {
    match change {
        Change::Building(name) => {
            Ok(edit::set_meta(plan, Meta { building: name.trim().to_owned(), ..plan.meta().clone() }))
        }
        Change::Typology(typology) => {
            Ok(edit::set_meta(plan, Meta { typology: typology.clone(), ..plan.meta().clone() }))
        }
        Change::Function(function) => each(plan, rooms, |plan, room| edit::set_function(plan, room, function.trim())),
        Change::Label(label) => {
            let label = label.map(|label| RoomLabel { label, origin: LabelOrigin::Person });
            each(plan, rooms, |plan, room| edit::set_label(plan, room, label))
        }
    }
}

fn each(
    plan: &Plan,
    rooms: &BTreeSet<RoomId>,
    act: impl Fn(&Plan, RoomId) -> Result<Plan, EditError>,
) -> Result<Plan, EditError> {
    let there = rooms.iter().filter(|room| plan.room(**room).is_some());
    there.copied().try_fold(plan.clone(), |plan, room| act(&plan, room))
}

/// The functions of all rooms as schemes compare them, with the number of rooms of each, the most frequent first.
pub fn functions(workspace: &Workspace) -> Vec<(String, usize)> {
    let mut found: BTreeMap<Arc<str>, usize> = BTreeMap::new();
    for room in workspace.files().iter().flat_map(|file| file.plans()).flat_map(|plan| &plan.rooms) {
        *found.entry(room.function.clone()).or_default() += 1;
    }
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for (function, number) in found {
        *known.entry(normalised_function(&function)).or_default() += number;
    }
    let mut functions: Vec<(String, usize)> = known.into_iter().filter(|(function, _)| !function.is_empty()).collect();
    functions.sort_by(|p, q| q.1.cmp(&p.1).then(p.0.cmp(&q.0)));
    functions
}
