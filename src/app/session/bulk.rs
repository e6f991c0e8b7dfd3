//! Changing many rooms at once: which rooms, what change, and a preview of the numbers.

use std::collections::BTreeSet;

use super::Session;
use crate::app::session::{document::Document, labelling::for_each, words};
use crate::base::wording::count;
use crate::edit::{
    self,
    naming::{Pattern, PatternError},
};
use crate::features::RoomStatus;
use crate::geometry::Point;
use crate::labels::{Label, normalised_function};
use crate::plan::{LabelOrigin, RoomId, RoomLabel};

/// A selection of rooms by their properties.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Which {
    Selected,
    Unnamed,
    All,
    /// As schemes compare it; empty for rooms without a function.
    Function(String),
    /// By label, from any source; `None` for rooms without one.
    Label(Option<Label>),
    /// Those a line passes through, in order along it.
    Along(Vec<Point>),
}

impl Which {
    /// The accepted forms, for errors.
    pub(crate) const FORMS: &'static str = "selected, unnamed, all, 'function office', 'label big', or 'along 1,2 5,2'";

    /// Parses an argument.
    pub(crate) fn of_word(word: &str) -> Result<Self, String> {
        let word = word.trim();
        match word.split_once(' ').unwrap_or((word, "")) {
            ("selected", "") => Ok(Self::Selected),
            ("unnamed", "") => Ok(Self::Unnamed),
            ("all", "") => Ok(Self::All),
            ("function", function) => Ok(Self::Function(normalised_function(function))),
            ("label", "none") => Ok(Self::Label(None)),
            ("label", label) => label_of_word(label)
                .map(|label| Self::Label(Some(label)))
                .ok_or_else(|| not_understood(word, Self::FORMS)),
            ("along", points) => {
                let points: Option<Vec<Point>> = points.split_whitespace().map(words::point).collect();
                let points = points.filter(|points| points.len() > 1);
                points.map(Self::Along).ok_or_else(|| not_understood(word, Self::FORMS))
            }
            _ => Err(not_understood(word, Self::FORMS)),
        }
    }

    /// As an argument.
    pub(crate) fn word(&self) -> String {
        match self {
            Self::Along(points) => format!("along {}", words::points_word(points)),
            Self::Selected => "selected".to_owned(),
            Self::Unnamed => "unnamed".to_owned(),
            Self::All => "all".to_owned(),
            Self::Function(function) => format!("function {function}").trim_end().to_owned(),
            Self::Label(None) => "label none".to_owned(),
            Self::Label(Some(label)) => format!("label {}", label.name()),
        }
    }

    /// A number of such rooms, in words: '37 rooms with function ‘office’'.
    fn counted(&self, number: usize) -> String {
        let rooms = count(number, "room");
        match self {
            Self::Selected => format!("{} selected {}", number, if number == 1 { "room" } else { "rooms" }),
            Self::Along(_) => format!("{rooms} along the line"),
            Self::Unnamed => format!("{rooms} without a name"),
            Self::All if number == 1 => "The only room".to_owned(),
            Self::All => format!("All {rooms}"),
            Self::Function(function) if function.is_empty() => format!("{rooms} without a function"),
            Self::Function(function) => format!("{rooms} with function ‘{function}’"),
            Self::Label(None) => format!("{rooms} without a label"),
            Self::Label(Some(label)) => format!("{rooms} labelled {label}"),
        }
    }
}

/// The change to make to rooms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    Function(String),
    /// `None`: the one that their functions give.
    Label(Option<Label>),
}

impl Change {
    /// The accepted forms, for errors.
    pub(crate) const FORMS: &'static str = "'function meeting room', 'label hall', or 'label by-function'";

    /// Parses an argument.
    pub(crate) fn of_word(word: &str) -> Result<Self, String> {
        let word = word.trim();
        match word.split_once(' ') {
            Some(("function", function)) => Ok(Self::Function(function.trim().to_owned())),
            Some(("label", "by-function")) => Ok(Self::Label(None)),
            Some(("label", label)) => label_of_word(label)
                .map(|label| Self::Label(Some(label)))
                .ok_or_else(|| not_understood(word, Self::FORMS)),
            _ => Err(not_understood(word, Self::FORMS)),
        }
    }

    /// As an argument.
    pub(crate) fn word(&self) -> String {
        match self {
            Self::Function(function) => format!("function {function}"),
            Self::Label(None) => "label by-function".to_owned(),
            Self::Label(Some(label)) => format!("label {}", label.name()),
        }
    }

    /// The change for a number of rooms, in words: 'become ‘meeting room’'.
    fn phrase(&self, number: usize) -> String {
        let (verb, are) = if number == 1 { ("becomes", "is") } else { ("become", "are") };
        match self {
            Self::Function(function) => format!("{verb} ‘{}’", function.trim()),
            Self::Label(Some(label)) => format!("{are} labelled {label}"),
            Self::Label(None) => format!("{are} labelled by function"),
        }
    }
}

fn not_understood(word: &str, forms: &str) -> String {
    format!("'{word}' is not understood: expected {forms}")
}

/// 'big', 'big room', 'B'.
fn label_of_word(word: &str) -> Option<Label> {
    let word = word.trim().to_lowercase();
    let short = Label::ALL.into_iter().find(|label| label.name().strip_suffix(" room") == Some(word.as_str()));
    short.or_else(|| word.parse().ok())
}

/// The order in which rooms are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// In reading order: from the top left, line by line.
    Rows,
    /// From the top left, column by column.
    Columns,
}

impl Order {
    pub(crate) const WORDS: &'static [(&'static str, &'static str)] =
        &[("rows", "Row by row"), ("columns", "Column by column")];
}

/// New names for rooms.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Names {
    /// The rooms whose name would change, with the new name, in numbering order.
    pub changed: Vec<(RoomId, String)>,
    /// How many would keep theirs.
    pub kept: usize,
}

impl Session {
    /// The rooms of a selection, in reading order.
    pub(crate) fn rooms_of(&self, which: &Which) -> Vec<RoomId> {
        let Some(plan) = self.plan() else { return Vec::new() };
        if let Which::Along(points) = which {
            let derived = self.document.as_ref().and_then(Document::derived);
            return derived.map(|derived| derived.analysis.shapes.along(points)).unwrap_or_default();
        }
        let is_it = |id: RoomId| {
            let Some(room) = plan.room(id) else { return false };
            match which {
                Which::Selected => self.selection.contains(crate::plan::ElementId::Room(id)),
                Which::Unnamed => room.name.trim().is_empty(),
                Which::All | Which::Along(_) => true,
                Which::Function(function) => normalised_function(&room.function) == *function,
                Which::Label(label) => match RoomStatus::of(plan, &self.schemes, room) {
                    RoomStatus::Labelled(given) => Some(given) == *label,
                    RoomStatus::Unlabelled => label.is_none(),
                    RoomStatus::NotClassified => false,
                },
            }
        };
        let rooms = plan.rooms().map(|(id, _)| id).filter(|&id| is_it(id)).collect();
        self.ordered(rooms, Order::Rows)
    }

    /// Rooms in this order; those without a boundary last.
    fn ordered(&self, rooms: Vec<RoomId>, order: Order) -> Vec<RoomId> {
        let Some(derived) = self.document.as_ref().and_then(Document::derived) else { return rooms };
        let all = match order {
            Order::Rows => derived.reading_order().to_vec(),
            Order::Columns => derived.column_order(),
        };
        let wanted: BTreeSet<RoomId> = rooms.iter().copied().collect();
        let mut ordered: Vec<RoomId> = all.into_iter().filter(|room| wanted.contains(room)).collect();
        let placed: BTreeSet<RoomId> = ordered.iter().copied().collect();
        ordered.extend(rooms.into_iter().filter(|room| !placed.contains(room)));
        ordered
    }

    // Changing.

    /// A summary of a change, in a sentence without its full stop, and the number of rooms affected.
    pub(crate) fn said_of_change(&self, which: &Which, change: &Change) -> (String, usize) {
        let number = self.rooms_of(which).len();
        let typology = self.plan().and_then(|plan| plan.meta().typology.as_ref());
        let is_new = match change {
            Change::Function(function) => {
                typology.is_some() && !function.is_empty() && self.schemes.meaning(typology, function).is_none()
            }
            Change::Label(_) => false,
        };
        let note = if is_new { ", which the label scheme does not know" } else { "" };
        (format!("{} {}{note}", which.counted(number), change.phrase(number)), number)
    }

    /// Changes all rooms of a selection in one step.
    ///
    /// # Errors
    /// When there are none.
    pub(crate) fn change_rooms(&mut self, which: &Which, change: &Change) -> Result<(), String> {
        let rooms = self.rooms_of(which);
        if rooms.is_empty() {
            return Err(format!("there are {}", which.counted(0)));
        }
        let said = format!("{} {}", which.counted(rooms.len()), change.phrase(rooms.len()));
        match change {
            Change::Function(function) => {
                self.edit(&said, |plan| for_each(plan, &rooms, |plan, room| edit::set_function(plan, room, function)));
                self.remember_function(function);
            }
            Change::Label(label) => {
                let given = label.map(|label| RoomLabel { label, origin: LabelOrigin::Person });
                self.edit(&said, |plan| for_each(plan, &rooms, |plan, room| edit::set_label(plan, room, given)));
            }
        }
        self.status = said;
        Ok(())
    }

    // Naming.

    /// The names that a pattern gives the rooms of a selection.
    ///
    /// # Errors
    /// When the pattern is invalid; the error says why.
    pub(crate) fn names_by(
        &self,
        pattern: &str,
        which: &Which,
        order: Order,
        start: u32,
    ) -> Result<Names, PatternError> {
        let pattern: Pattern = pattern.parse()?;
        let Some(plan) = self.plan() else { return Ok(Names { changed: Vec::new(), kept: 0 }) };
        let rooms = self.rooms_of(which);
        // A line has its own order.
        let rooms = if matches!(which, Which::Along(_)) { rooms } else { self.ordered(rooms, order) };
        let label = |_, room: &crate::plan::Room| RoomStatus::of(plan, &self.schemes, room).label();
        let mut changed = pattern.names(plan, &rooms, start, label)?;
        let all = changed.len();
        changed.retain(|(id, name)| plan.room(*id).is_some_and(|room| room.name != *name));
        Ok(Names { kept: all - changed.len(), changed })
    }

    /// Names the rooms of a selection by a pattern, in one step.
    ///
    /// # Errors
    /// When the pattern is invalid, or there are no such rooms.
    pub(crate) fn name_rooms(&mut self, pattern: &str, which: &Which, order: Order, start: u32) -> Result<(), String> {
        let names = self.names_by(pattern, which, order, start).map_err(|error| error.to_string())?;
        if names.changed.is_empty() && names.kept == 0 {
            return Err(format!("there are {}", which.counted(0)));
        }
        let title = format!("Name {}", count(names.changed.len(), "room"));
        self.edit(&title, |plan| {
            names.changed.iter().try_fold(plan.clone(), |plan, (room, name)| edit::set_name(&plan, *room, name))
        });
        self.status = title;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use crate::app::session::bulk::*;

    #[test]
    fn words_of_calls_are_read_as_they_are_written() {
        for which in [
            Which::Selected,
            Which::Unnamed,
            Which::All,
            Which::Function("meeting room".to_owned()),
            Which::Function(String::new()),
            Which::Label(None),
            Which::Label(Some(Label::BigRoom)),
            Which::Along(vec![Point::new(0.5, -2.0), Point::new(3.0, 4.25)]),
        ] {
            assert_eq!(Which::of_word(&which.word()), Ok(which));
        }
        for change in [Change::Function("store".to_owned()), Change::Label(None), Change::Label(Some(Label::Corridor))]
        {
            assert_eq!(Change::of_word(&change.word()), Ok(change));
        }
        assert_eq!(Which::of_word("label big"), Ok(Which::Label(Some(Label::BigRoom))));
        assert_eq!(Change::of_word("label S"), Ok(Change::Label(Some(Label::SmallRoom))));
        assert!(Which::of_word("label huge").unwrap_err().contains("label big"));
        assert!(Change::of_word("bigger").unwrap_err().contains("label hall"));
    }
}
