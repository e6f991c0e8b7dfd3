//! What sizes of rooms are usual, and what a plan's rooms say of its scale.

use crate::base::numbers::lower_median;
use crate::labels::{Label, Typology};

/// The areas in m² between which the middle of the rooms of a label lies, from source to source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usual {
    pub label: Label,
    pub from_m2: f64,
    pub to_m2: f64,
}

const fn usual(label: Label, from_m2: f64, to_m2: f64) -> Usual {
    Usual { label, from_m2, to_m2 }
}

/// Dwellings: one end is the mean of the paper's Table 2, the other the median measured on 607
/// Japanese dwellings (FloorplanTransformation), which are far smaller.
const HOUSE: &[Usual] = &[
    usual(Label::SmallRoom, 1.5, 6.0),
    usual(Label::MediumRoom, 9.4, 17.4),
    usual(Label::BigRoom, 17.2, 33.7),
    usual(Label::Corridor, 3.4, 14.0),
    usual(Label::Hall, 1.4, 61.5),
];

/// Schools: the mean of the paper's Table 2 and the median measured on the authors' 40 floors.
const SCHOOL: &[Usual] = &[
    usual(Label::SmallRoom, 10.0, 18.3),
    usual(Label::MediumRoom, 54.8, 62.6),
    usual(Label::BigRoom, 102.9, 104.0),
    usual(Label::Corridor, 36.1, 56.1),
    usual(Label::Hall, 23.1, 205.1),
];

/// Offices: the mean of the paper's Table 2 and the median measured on the authors' 16 floors,
/// their scale healed.
const OFFICE: &[Usual] = &[
    usual(Label::SmallRoom, 3.5, 4.5),
    usual(Label::MediumRoom, 12.1, 18.5),
    usual(Label::BigRoom, 24.4, 31.3),
    usual(Label::Corridor, 13.3, 30.5),
    usual(Label::Hall, 18.5, 106.9),
];

/// What is usual for a label in a typology; `None` where nothing is known of the typology.
pub fn usual_area(typology: Option<&Typology>, label: Label) -> Option<Usual> {
    let table = match typology?.as_str() {
        "house" => HOUSE,
        "school" => SCHOOL,
        "office" => OFFICE,
        _ => return None,
    };
    table.iter().find(|usual| usual.label == label).copied()
}

impl Usual {
    /// How many times larger (above 1) or smaller (below 1) an area is than what is usual; 1 within.
    pub fn factor(self, area_m2: f64) -> f64 {
        if area_m2 > self.to_m2 {
            area_m2 / self.to_m2
        } else if area_m2 < self.from_m2 {
            area_m2 / self.from_m2
        } else {
            1.0
        }
    }
}

/// How many times smaller and larger than what is usual a room of a label may be. Beyond lies about
/// one room in 200 of the real plans (the authors' schools and offices, the Japanese dwellings), in
/// the measure of its own plan: big rooms go up to gymnasiums, halls down to porches.
pub const fn tolerated_factors(label: Label) -> (f64, f64) {
    match label {
        Label::SmallRoom => (8.0, 6.0),
        Label::MediumRoom => (6.0, 4.0),
        Label::BigRoom => (6.0, 10.0),
        Label::Corridor => (8.0, 7.0),
        Label::Hall => (20.0, 5.0),
    }
}

/// Fewer rooms than this say nothing of a scale: the areas of rooms of one label deviate from their
/// middle by a factor of about 2.2 (measured: deviation of the logarithm 0.8 in schools and
/// offices), a median of five by a factor of about 1.5, the length by 1.25.
pub const ROOMS_FOR_SCALE: usize = 5;

/// How many times too long the lengths of a plan seem from the areas of its rooms (their label and
/// area in m²), and of how many rooms; `None` when there are too few. Corridors and halls take no
/// part: theirs vary most.
pub fn length_factor(
    typology: Option<&Typology>,
    rooms: impl IntoIterator<Item = (Label, f64)>,
) -> Option<(f64, usize)> {
    let mut factors: Vec<f64> = rooms
        .into_iter()
        .filter(|(label, area_m2)| !matches!(label, Label::Corridor | Label::Hall) && *area_m2 > 0.0)
        .filter_map(|(label, area_m2)| Some(usual_area(typology, label)?.factor(area_m2)))
        .collect();
    if factors.len() < ROOMS_FOR_SCALE {
        return None;
    }
    Some((lower_median(&mut factors)?.sqrt(), factors.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_of_twice_the_usual_length_say_so() {
        let school = Typology::new("school");
        let rooms = |times: f64| [55.0, 60.0, 58.0, 62.0, 56.0].map(|area| (Label::MediumRoom, area * times));
        assert_eq!(length_factor(school.as_ref(), rooms(1.0)), Some((1.0, 5)));
        let (factor, _) = length_factor(school.as_ref(), rooms(4.0)).expect("enough rooms");
        assert!((1.8..2.1).contains(&factor), "{factor}");
        let (factor, _) = length_factor(school.as_ref(), rooms(0.25)).expect("enough rooms");
        assert!((0.45..0.55).contains(&factor), "{factor}");
        assert_eq!(length_factor(school.as_ref(), rooms(1.0).into_iter().take(4)), None);
        assert_eq!(length_factor(Typology::new("castle").as_ref(), rooms(1.0)), None);
    }
}
