use std::collections::BTreeMap;

use super::typology_has_no_scheme::typology_without_scheme;
use super::{Check, Context, Kind, Place, Severity};
use crate::features::RoomStatus;
use crate::labels::{Typology, normalised_function};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;
use crate::plan::titles::{first_of, printable};

/// A function that the scheme of the plan's typology does not have: its rooms get no label.
#[derive(Clone, Debug, PartialEq)]
pub struct FunctionIsUnknown {
    /// As written in the first of the rooms.
    pub function: String,
    pub typology: Typology,
    /// The rooms of this function without a label of their own, by id.
    pub rooms: Vec<RoomName>,
}

impl Check for FunctionIsUnknown {
    const KIND: Kind = Kind {
        name: "function_is_unknown",
        title: "Function is not in the label scheme",
        severity: Severity::Warning,
        remedy: "correct it, label the rooms themselves, or add it to a scheme (--scheme)",
    };

    fn find(context: &Context) -> Vec<Self> {
        let Some(typology) = context.plan.meta().typology.as_ref() else { return Vec::new() };
        if typology_without_scheme(context).is_some() {
            return Vec::new();
        }
        let mut by_function: BTreeMap<String, Vec<RoomName>> = BTreeMap::new();
        for (index, (id, room)) in context.plan.rooms().enumerate() {
            let function = normalised_function(&room.function);
            if !function.is_empty() && context.status(index) == RoomStatus::Unlabelled {
                by_function.entry(function).or_default().push(context.name_of_room(id, room));
            }
        }
        by_function
            .into_values()
            .map(|rooms| Self {
                function: rooms.first().map(|room| room.function.clone()).unwrap_or_default(),
                typology: typology.clone(),
                rooms,
            })
            .collect()
    }

    fn size(&self) -> f64 {
        self.rooms.len() as f64
    }

    fn place(&self) -> Place<'_> {
        Place {
            elements: self.rooms.iter().map(|room| ElementId::Room(room.id)).collect(),
            rooms: self.rooms.iter().collect(),
            at: None,
        }
    }

    fn what(&self) -> String {
        format!(
            "the scheme of {} has no '{}': {}",
            printable(self.typology.as_str()),
            printable(&self.function),
            first_of(&self.rooms)
        )
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("rooms", self.rooms.len() as f64)]
    }
}
