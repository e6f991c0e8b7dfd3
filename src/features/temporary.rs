//! The naive classifier on `<a, rt, d>`: the paper's hand-made rules that give an unlabelled
//! neighbour a temporary label (section 3.2).
//!
//! The paper does not publish its rules. These are read off its Table 2: a threshold between two
//! labels lies where two bell curves with the table's means and deviations, weighted by the labels'
//! shares, cross, rounded to what a person would write. They are a table so that they can be read.

use crate::labels::{Label, Typology};

/// One row of the table: when all conditions hold, the label is given. Rows are tried in order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    pub label: Label,
    /// Area in m² at least this.
    pub area_at_least_m2: f64,
    /// Area in m² below this.
    pub area_below_m2: f64,
    /// Axes ratio at least this.
    pub axes_ratio_at_least: f64,
    /// At least so many openings.
    pub doors_at_least: u32,
    /// Why: where the thresholds come from.
    pub reason: &'static str,
}

const ANY: f64 = f64::INFINITY;

const fn rule(
    label: Label,
    area_at_least_m2: f64,
    area_below_m2: f64,
    axes_ratio_at_least: f64,
    doors_at_least: u32,
    reason: &'static str,
) -> Rule {
    Rule { label, area_at_least_m2, area_below_m2, axes_ratio_at_least, doors_at_least, reason }
}

/// Rules for dwellings.
pub const HOUSE: &[Rule] = &[
    rule(Label::Hall, 45.0, ANY, 0.0, 3, "halls 61.5 ± 25.1 m² with 3.3 doors; big rooms 33.7 ± 7.8 m² with 1.8"),
    rule(Label::Corridor, 0.0, ANY, 0.0, 3, "corridors have 4.0 ± 1.8 doors, rooms 1.0 to 1.8"),
    rule(
        Label::Corridor,
        0.0,
        30.0,
        3.0,
        2,
        "corridors are 3.4 times as long as wide, rooms 1.5 to 2.0; one that ends a flat has two doors",
    ),
    rule(Label::SmallRoom, 0.0, 10.0, 0.0, 0, "small rooms 6.0 ± 2.6 m², medium rooms 17.4 ± 4.8 m²"),
    rule(Label::MediumRoom, 10.0, 25.0, 0.0, 0, "medium rooms 17.4 ± 4.8 m², big rooms 33.7 ± 7.8 m²"),
    rule(Label::BigRoom, 25.0, ANY, 0.0, 0, "what is larger"),
];

/// Rules for schools.
pub const SCHOOL: &[Rule] = &[
    rule(Label::Corridor, 0.0, ANY, 4.5, 2, "corridors are 7.4 times as long as wide, halls 2.0, rooms 1.3 to 1.7"),
    rule(Label::Hall, 120.0, ANY, 0.0, 4, "halls 205 ± 173 m² with 6.9 ± 4.5 doors; big rooms 103 ± 22 m² with 2.1"),
    rule(Label::Corridor, 0.0, ANY, 0.0, 4, "corridors have 5.7 ± 3.8 doors, rooms 1.1 to 2.1"),
    rule(Label::SmallRoom, 0.0, 30.0, 0.0, 0, "small rooms 10.0 ± 9.7 m², medium rooms 54.8 ± 14.8 m²"),
    rule(Label::MediumRoom, 30.0, 85.0, 0.0, 0, "medium rooms 54.8 ± 14.8 m², big rooms 102.9 ± 22.3 m²"),
    rule(Label::BigRoom, 85.0, ANY, 0.0, 0, "what is larger"),
];

/// Rules for offices.
pub const OFFICE: &[Rule] = &[
    rule(Label::Corridor, 0.0, ANY, 5.0, 2, "corridors are 8.1 times as long as wide, halls 2.4, rooms 1.3 to 1.9"),
    rule(Label::Hall, 60.0, ANY, 0.0, 4, "halls 106.9 ± 84.5 m² with 6.5 doors; big rooms 31.3 ± 12.2 m² with 1.4"),
    rule(Label::Corridor, 0.0, ANY, 0.0, 4, "corridors have 6.7 ± 4.8 doors, rooms 1.0 to 1.4"),
    rule(Label::SmallRoom, 0.0, 8.0, 0.0, 0, "small rooms 4.5 ± 2.3 m², medium rooms 18.5 ± 14.4 m²"),
    rule(Label::MediumRoom, 8.0, 27.0, 0.0, 0, "medium rooms 18.5 ± 14.4 m², big rooms 31.3 ± 12.2 m²"),
    rule(Label::BigRoom, 27.0, ANY, 0.0, 0, "what is larger"),
];

/// Rules where the typology is unknown or has none of its own.
pub const STANDARD: &[Rule] = &[
    rule(Label::Corridor, 0.0, ANY, 5.0, 2, "corridors are 6.5 times as long as wide, halls 2.2, rooms 1.5 to 1.8"),
    rule(Label::Hall, 70.0, ANY, 0.0, 3, "halls 110.9 ± 109.2 m² with 3.7 doors; big rooms 35.0 ± 18.0 m² with 1.6"),
    rule(Label::Corridor, 0.0, ANY, 0.0, 3, "corridors have 5.7 ± 4.1 doors, rooms 1.0 to 1.6"),
    rule(Label::SmallRoom, 0.0, 12.0, 0.0, 0, "small rooms 7.1 ± 6.9 m², medium rooms 24.5 ± 18.9 m²"),
    rule(Label::MediumRoom, 12.0, 32.0, 0.0, 0, "medium rooms 24.5 ± 18.9 m², big rooms 35.0 ± 18.0 m²"),
    rule(Label::BigRoom, 32.0, ANY, 0.0, 0, "what is larger"),
];

/// The rules for a typology; [`STANDARD`] where there are none of its own.
pub fn rules(typology: Option<&Typology>) -> &'static [Rule] {
    match typology.map(Typology::as_str) {
        Some("house") => HOUSE,
        Some("school") => SCHOOL,
        Some("office") => OFFICE,
        _ => STANDARD,
    }
}

/// The temporary label of a room from its area in m², axes ratio and number of openings: that of
/// the first rule that holds, a big room where none does (which only not-a-number can bring about).
pub fn classify(typology: Option<&Typology>, area_m2: f64, axes_ratio: f64, doors: u32) -> Label {
    rules(typology)
        .iter()
        .find(|rule| {
            area_m2 >= rule.area_at_least_m2
                && area_m2 < rule.area_below_m2
                && axes_ratio >= rule.axes_ratio_at_least
                && doors >= rule.doors_at_least
        })
        .map_or(Label::BigRoom, |rule| rule.label)
}

#[cfg(test)]
mod tests {
    use crate::features::temporary::*;

    /// The entries of D_H that the paper prints (section 3.2): label, a, d, rt.
    #[test]
    fn the_papers_entries() {
        let house = Typology::new("house");
        let agree = [
            (Label::SmallRoom, 3.0, 1, 1.0),
            (Label::BigRoom, 44.0, 2, 1.4),
            (Label::Corridor, 13.0, 8, 3.0),
            (Label::MediumRoom, 15.0, 1, 1.2),
            (Label::Corridor, 9.0, 6, 2.0),
        ];
        for (label, area_m2, doors, axes_ratio) in agree {
            assert_eq!(classify(house.as_ref(), area_m2, axes_ratio, doors), label, "{area_m2} m²");
        }
    }

    #[test]
    fn every_room_gets_a_label() {
        for typology in
            [None, Typology::new("house"), Typology::new("school"), Typology::new("office"), Typology::new("castle")]
        {
            for area_m2 in [0.01, 9.0, 50.0, 1e6] {
                for doors in [0, 1, 5] {
                    classify(typology.as_ref(), area_m2, 1.0, doors);
                }
            }
            let last = rules(typology.as_ref()).last().expect("a table has rules");
            assert_eq!((last.label, last.area_below_m2, last.doors_at_least), (Label::BigRoom, f64::INFINITY, 0));
        }
    }
}
