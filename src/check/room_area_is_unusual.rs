use super::sizes::usual_area;
use super::{Check, Context, Kind, Place, RoomName, Severity};
use crate::geometry::Point;
use crate::labels::{Label, Typology};
use crate::plan::ElementId;

/// A room whose area is far outside what its typology has for its label: the function may be wrong,
/// or the boundary.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomAreaIsUnusual {
    pub room: RoomName,
    pub label: Label,
    pub typology: Typology,
    pub area_m2: f64,
    /// What is usual, in the measure of this plan: where all its rooms are large, large is usual.
    pub usual_m2: [f64; 2],
    pub at: Point,
}

/// Rooms are reported from this factor beyond what is usual for their label: three deviations of
/// the logarithm of areas within a plan, which is 0.5 to 0.7 for rooms (measured on the authors'
/// floors), is a factor of 5 to 8.
const UNUSUAL_FACTOR: f64 = 6.0;

impl Check for RoomAreaIsUnusual {
    const KIND: Kind = Kind {
        name: "room_area_is_unusual",
        title: "Room's area is unusual for its label",
        severity: Severity::Info,
        remedy: "look whether its function and its boundary are right",
    };

    fn find(context: &Context) -> Vec<Self> {
        let Some(typology) = context.plan.meta().typology.as_ref() else { return Vec::new() };
        // A scale that is off is one finding, not one for every room.
        let length_factor = context.length_factor.map_or(1.0, |(factor, _)| factor);
        let area_factor = length_factor * length_factor;
        let mut found = Vec::new();
        for (index, shape) in context.shapes().iter().enumerate() {
            let area_m2 = shape.area_m2();
            let Some(label) = context.status(index).label().filter(|_| area_m2 > 0.0) else { continue };
            let Some(usual) = usual_area(Some(typology), label) else { continue };
            let factor = usual.factor(area_m2 / area_factor);
            if !(1.0 / UNUSUAL_FACTOR..=UNUSUAL_FACTOR).contains(&factor) {
                found.push(Self {
                    room: context.name(index),
                    label,
                    typology: typology.clone(),
                    area_m2,
                    usual_m2: [usual.from_m2 * area_factor, usual.to_m2 * area_factor],
                    at: shape.bounds.center(),
                });
            }
        }
        found
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        let [from, to] = self.usual_m2;
        format!(
            "{} has {:.1} m²; a {} of a {} of this scale usually has {from:.0} to {to:.0} m²",
            self.room,
            self.area_m2,
            self.label,
            super::names::printable(self.typology.as_str()),
        )
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2), ("usual_from_m2", self.usual_m2[0]), ("usual_to_m2", self.usual_m2[1])]
    }
}
