use super::sizes::tolerated_factors;
use super::{Check, Context, Kind, Place, Severity};
use crate::geometry::Point;
use crate::labels::{Label, Typology};
use crate::plan::ElementId;
use crate::plan::titles::RoomName;
use crate::plan::titles::{printable, with_article};

/// A room whose area is far outside the usual range of its label in this typology: the function or the
/// boundary may be wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomAreaIsUnusual {
    pub room: RoomName,
    pub label: Label,
    pub typology: Typology,
    pub area_m2: f64,
    /// The usual range, scaled to this plan: where all rooms are large, large is usual.
    pub usual_m2: [f64; 2],
    pub at: Point,
}

impl Check for RoomAreaIsUnusual {
    const KIND: Kind = Kind {
        name: "room_area_is_unusual",
        title: "Room's area is unusual for its label",
        severity: Severity::Info,
        remedy: "check its function and its boundary",
    };

    fn find(context: &Context) -> Vec<Self> {
        let Some(typology) = context.plan.meta().typology.as_ref() else { return Vec::new() };
        // A wrong scale is one finding, not one per room.
        let length_factor = context.length_factor.map_or(1.0, |(factor, _)| factor);
        let area_factor = length_factor * length_factor;
        let mut found = Vec::new();
        for (index, shape) in context.shapes().iter().enumerate() {
            let area_m2 = shape.area_m2();
            let Some(label) = context.status(index).label() else { continue };
            // A boundary that encloses nothing or crosses itself is another finding.
            if area_m2 <= 0.0 || !context.ring_faults[index].crossings.is_empty() {
                continue;
            }
            let Some(usual) = context.schemes.usual_area(Some(typology), label) else { continue };
            let factor = usual.factor(area_m2 / area_factor);
            let (smaller, larger) = tolerated_factors(label);
            if factor < 1.0 / smaller || factor > larger {
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

    fn size(&self) -> f64 {
        let [from, to] = self.usual_m2;
        (self.area_m2 / to).max(from / self.area_m2)
    }

    fn place(&self) -> Place<'_> {
        Place { elements: vec![ElementId::Room(self.room.id)], rooms: vec![&self.room], at: Some(self.at) }
    }

    fn what(&self) -> String {
        let [from, to] = self.usual_m2;
        format!(
            "{} has {:.1} m²; a {} in {} of this scale usually has {from:.0} to {to:.0} m²",
            self.room,
            self.area_m2,
            self.label,
            with_article(&printable(self.typology.as_str())),
        )
    }

    fn figures(&self) -> Vec<(&'static str, f64)> {
        vec![("area_m2", self.area_m2), ("usual_from_m2", self.usual_m2[0]), ("usual_to_m2", self.usual_m2[1])]
    }
}
