//! What the labels mean, for people who see them for the first time.

use super::{Label, Meaning, Schemes, Typology};
use crate::base::units::Units;
use crate::base::wording::sentence;

impl Label {
    /// What a room of this label is, without an article before it and a full stop after it.
    pub const fn meaning(self) -> &'static str {
        [
            "a side room such as a bathroom, a closet or a store",
            "an ordinary room such as a bedroom, an office or a classroom",
            "a large room such as a living room, a canteen or an open-plan office",
            "a way from room to room, mostly long and with several doors",
            "a wide space that people enter by or gather in, such as a lobby",
        ][self as usize]
    }
}

/// The most functions named as examples.
const EXAMPLES: usize = 5;

impl Schemes {
    /// What a label means in plans of a typology: its meaning, functions that have it, and how large such rooms mostly
    /// are.
    pub fn about(&self, label: Label, typology: Option<&Typology>, units: Units) -> String {
        let mut about = format!("{}: {}.", sentence(label.name()), label.meaning());
        let Some(typology) = typology else { return about };
        // A function such as 'small service' would explain small rooms by small rooms.
        let explains = |function: &&str| !["small", "medium", "big"].iter().any(|size| function.starts_with(size));
        let functions: Vec<&str> = self
            .functions(typology)
            .filter(|(_, meaning)| *meaning == Meaning::Labelled(label))
            .map(|(function, _)| function)
            .filter(explains)
            .collect();
        let area = self
            .usual_area(Some(typology), label)
            .map(|usual| format!("mostly {} to {}", units.area(usual.from_m2), units.area(usual.to_m2)));
        let named = functions.iter().take(EXAMPLES).copied().collect::<Vec<_>>().join(", ");
        let more = if functions.len() > EXAMPLES { " and others" } else { "" };
        let facts: Vec<String> = [(!named.is_empty()).then(|| named + more), area].into_iter().flatten().collect();
        if !facts.is_empty() {
            about.push_str(&format!("\n{}: {}.", typology.title(), facts.join("; ")));
        }
        about
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_explained_by_the_plan_s_typology() {
        let schemes = Schemes::bundled();
        let school = Typology::new("school");
        assert_eq!(
            schemes.about(Label::MediumRoom, school.as_ref(), Units::Metric),
            "Medium room: an ordinary room such as a bedroom, an office or a classroom.\n\
             School: classroom, staff room; mostly 54.8 m² to 62.6 m²."
        );
        let house = Typology::new("house");
        assert_eq!(
            schemes.about(Label::SmallRoom, house.as_ref(), Units::Imperial),
            "Small room: a side room such as a bathroom, a closet or a store.\n\
             House: bathroom, closet, dressing room, elevator, laundry and others; mostly 16 sq ft to 65 sq ft."
        );
        assert_eq!(schemes.about(Label::Hall, Typology::new("castle").as_ref(), Units::Metric).lines().count(), 1);
    }
}
