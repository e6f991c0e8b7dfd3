//! The target of labelling and naming: the selected rooms, or the one under the pointer.

use std::collections::BTreeMap;

use super::Session;
use crate::app::session::words::{self, Choice};
use crate::base::wording::count;
use crate::base::wording::or_words;
use crate::base::wording::sentence;
use crate::edit::{self, EditError};
use crate::features::RoomStatus;
use crate::labels::{Label, Meaning, Typology, normalised_function};
use crate::plan::titles::room_title;
use crate::plan::{ElementId, LabelOrigin, Plan, RoomId, RoomLabel};

/// The number of recent functions remembered.
const MOST_RECENT: usize = 12;

/// The rooms a command applies to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Target {
    pub rooms: Vec<RoomId>,
    /// Whether they are the selection, which a recording has already made.
    pub is_selection: bool,
}

impl Target {
    /// The argument that names it in a call; `None` for the selection.
    pub(crate) fn word(&self, plan: &Plan) -> Option<String> {
        self.rooms.first().filter(|_| !self.is_selection).map(|&room| words::room_word(plan, room))
    }

    /// Its title: 'Kitchen', '5 rooms'.
    pub(crate) fn title(&self, plan: &Plan) -> String {
        match self.rooms.as_slice() {
            [one] => plan.room(*one).map(room_title).unwrap_or_default(),
            several => count(several.len(), "room"),
        }
    }
}

impl Session {
    /// The rooms a command applies to: the named one, otherwise the selected ones, otherwise, if nothing
    /// is selected, the one that was just drawn while the pointer stays where it was, the one under the pointer, or
    /// the one that was just drawn. `None` if there are none.
    pub(crate) fn target(&self, named: Option<RoomId>) -> Option<Target> {
        let plan = self.plan()?;
        let drawn = || self.fresh_room();
        let meant =
            || drawn().filter(|_| self.has_pointer_stayed()).or_else(|| self.room_under_pointer()).or_else(drawn);
        if let Some(room) =
            named.or_else(|| meant().filter(|_| self.selection.is_empty())).filter(|&room| plan.room(room).is_some())
        {
            return Some(Target { rooms: vec![room], is_selection: false });
        }
        let rooms: Vec<RoomId> = self.selection.rooms().collect();
        (!rooms.is_empty()).then_some(Target { rooms, is_selection: true })
    }

    /// The room under the pointer, even if there is a wall or a door above it.
    fn room_under_pointer(&self) -> Option<RoomId> {
        if let Some(ElementId::Room(room)) = self.pointed.element {
            return Some(room);
        }
        let shapes = &self.document.as_ref()?.derived()?.analysis.shapes;
        let index = shapes.at(self.pointed.at?).into_iter().next()?;
        shapes.all().get(index).map(|shape| shape.id)
    }

    /// The label shared by all selected rooms, from any source.
    pub(crate) fn selected_label(&self) -> Option<Label> {
        let plan = self.plan()?;
        let label = |room: RoomId| RoomStatus::of(plan, &self.schemes, plan.room(room)?).label();
        let mut rooms = self.selection.rooms();
        let first = label(rooms.next()?)?;
        rooms.all(|room| label(room) == Some(first)).then_some(first)
    }

    /// Labels rooms, or removes their own labels, in one step.
    pub(crate) fn label_rooms(&mut self, target: &Target, label: Option<Label>) {
        let Some(plan) = self.plan() else { return };
        let what = label.map_or("Clear label".to_owned(), |label| format!("Label {label}"));
        let title = if target.rooms.len() == 1 { what } else { format!("{what}: {}", target.title(plan)) };
        let status = label.map_or("label cleared".to_owned(), |label| label.name().to_owned());
        let status = format!("{}: {status}", target.title(plan));
        let given = label.map(|label| RoomLabel { label, origin: LabelOrigin::Person });
        self.keeping_fresh(|session| {
            session.edit(&title, |plan| for_each(plan, &target.rooms, |plan, room| edit::set_label(plan, room, given)));
        });
        self.status = status;
    }

    /// Sets what rooms are for, in one step.
    pub(crate) fn set_function_of(&mut self, target: &Target, function: &str) {
        let Some(plan) = self.plan() else { return };
        let function = function.trim();
        let title = match target.rooms.len() {
            1 => "Set function".to_owned(),
            _ => format!("Set function: {}", target.title(plan)),
        };
        let said = if function.is_empty() { "no function" } else { function };
        let status = format!("{}: {said}", target.title(plan));
        self.keeping_fresh(|session| {
            let change = |plan: &Plan, room| edit::set_function(plan, room, function);
            session.edit(&title, |plan| for_each(plan, &target.rooms, change));
        });
        self.status = status;
        self.remember_function(function);
    }

    /// The functions that names speak for, of the rooms among these that have none.
    pub(crate) fn proposed_functions(&self, rooms: &[RoomId]) -> Vec<(RoomId, String)> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let typology = plan.meta().typology.as_ref();
        let proposed = |&id: &RoomId| {
            let room = plan.room(id).filter(|room| room.function.trim().is_empty())?;
            Some((id, self.schemes.function_of_name(typology, &room.name)?))
        };
        rooms.iter().filter_map(proposed).collect()
    }

    /// Sets the functions that the rooms' names speak for, in one step.
    pub(crate) fn accept_functions(&mut self, target: &Target) {
        let proposed = self.proposed_functions(&target.rooms);
        let title = match proposed.as_slice() {
            [] => return,
            [(_, function)] => format!("Set function: {function}"),
            several => format!("Set function: {}", count(several.len(), "room")),
        };
        self.edit(&title, |plan| {
            proposed.iter().try_fold(plan.clone(), |plan, (room, function)| edit::set_function(&plan, *room, function))
        });
        self.status = title;
    }

    /// Remembers a function for the next list.
    pub(crate) fn remember_function(&mut self, function: &str) {
        let function = normalised_function(function);
        if !function.is_empty() {
            let recent = &mut self.recent_functions;
            recent.retain(|other| *other != function);
            recent.insert(0, function);
            recent.truncate(MOST_RECENT);
        }
    }

    /// The functions of the plan and of its typology's scheme: first by how many rooms of the plan have
    /// them, then the recent ones, then in the scheme's order.
    pub(crate) fn function_choices(&self) -> Vec<Choice> {
        let Some(plan) = self.plan() else { return Vec::new() };
        let typology = plan.meta().typology.as_ref();
        let mut used: BTreeMap<String, usize> = BTreeMap::new();
        for (_, room) in plan.rooms() {
            *used.entry(normalised_function(&room.function)).or_default() += 1;
        }
        used.remove("");
        // Without a typology, what any scheme knows.
        let typologies: Vec<&Typology> = match typology {
            Some(typology) => vec![typology],
            None => self.schemes.typologies().collect(),
        };
        let mut functions: Vec<String> = Vec::new();
        for (function, _) in typologies.iter().flat_map(|typology| self.schemes.functions(typology)) {
            if !functions.iter().any(|known| known == function) {
                functions.push(function.to_owned());
            }
        }
        let more = used.keys().chain(&self.recent_functions);
        for function in more.collect::<Vec<_>>() {
            if !functions.contains(function) {
                functions.push(function.clone());
            }
        }
        let recent =
            |function: &String| self.recent_functions.iter().position(|other| other == function).unwrap_or(usize::MAX);
        let number = |function: &String| used.get(function).copied().unwrap_or(0);
        // Stable: ties keep their order.
        functions.sort_by_key(|function| (std::cmp::Reverse(number(function)), recent(function)));
        let choice = |function: String| {
            let known = |typology: &&&Typology| self.schemes.meaning(Some(typology), &function).is_some();
            let (status, detail) = match self.schemes.meaning(typology, &function) {
                Some(Meaning::Labelled(label)) => (RoomStatus::Labelled(label), label.name().to_owned()),
                Some(Meaning::NotClassified) => (RoomStatus::NotClassified, "not classified".to_owned()),
                None if typology.is_none() && typologies.iter().any(|typology| known(&typology)) => {
                    let of: Vec<&str> = typologies.iter().filter(known).map(|typology| typology.as_str()).collect();
                    (RoomStatus::Unlabelled, format!("in a plan of typology {}", or_words(&of)))
                }
                None => (RoomStatus::Unlabelled, "not in the label scheme".to_owned()),
            };
            let number = number(&function);
            Choice {
                title: sentence(&function),
                detail,
                trail: if number > 0 { count(number, "room") } else { String::new() },
                status: Some(status),
                word: function,
            }
        };
        functions.into_iter().map(choice).collect()
    }
}

/// Changes rooms one by one.
pub(crate) fn for_each(
    plan: &Plan,
    rooms: &[RoomId],
    change: impl Fn(&Plan, RoomId) -> Result<Plan, EditError>,
) -> Result<Plan, EditError> {
    rooms.iter().try_fold(plan.clone(), |plan, &room| change(&plan, room))
}
