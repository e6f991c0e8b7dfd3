//! Usual room sizes, and what a plan's room sizes say about its scale.

use crate::base::numbers::lower_median;
use crate::labels::{Label, Schemes, Typology};

/// How many times smaller and larger than usual a room of a label may be. About one room in 200 of the
/// real plans (the authors' schools and offices, the Japanese dwellings) is outside this range, after
/// correcting for its plan's scale: big rooms include gymnasiums, halls include porches.
pub const fn tolerated_factors(label: Label) -> (f64, f64) {
    match label {
        Label::SmallRoom => (8.0, 6.0),
        Label::MediumRoom => (6.0, 4.0),
        Label::BigRoom => (6.0, 10.0),
        Label::Corridor => (8.0, 7.0),
        Label::Hall => (20.0, 5.0),
    }
}

/// By how much the areas of rooms of one label deviate from their median, as the standard deviation of the logarithm,
/// measured in schools and offices: a factor of about 2.2.
pub const ROOM_SPREAD: f64 = 0.8;

/// Fewer rooms than this say nothing about the scale: the median of five areas deviates by about 1.5 ([`ROOM_SPREAD`]),
/// and the length by 1.25.
pub const ROOMS_FOR_SCALE: usize = 5;

/// How many times too long the lengths of a plan seem, judging by its rooms (label and area in m²), and
/// from how many rooms; `None` if there are too few. Corridors and halls are ignored: they vary most.
pub fn length_factor(
    schemes: &Schemes,
    typology: Option<&Typology>,
    rooms: impl IntoIterator<Item = (Label, f64)>,
) -> Option<(f64, usize)> {
    let mut factors: Vec<f64> = rooms
        .into_iter()
        .filter(|(label, area_m2)| !matches!(label, Label::Corridor | Label::Hall) && *area_m2 > 0.0)
        .filter_map(|(label, area_m2)| Some(schemes.usual_area(typology, label)?.factor(area_m2)))
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
        let schemes = Schemes::bundled();
        let length_factor =
            |typology: Option<&Typology>, rooms: Vec<(Label, f64)>| length_factor(&schemes, typology, rooms);
        let rooms = |times: f64| [55.0, 60.0, 58.0, 62.0, 56.0].map(|area| (Label::MediumRoom, area * times));
        assert_eq!(length_factor(school.as_ref(), rooms(1.0).to_vec()), Some((1.0, 5)));
        let (factor, _) = length_factor(school.as_ref(), rooms(4.0).to_vec()).expect("enough rooms");
        assert!((1.8..2.1).contains(&factor), "{factor}");
        let (factor, _) = length_factor(school.as_ref(), rooms(0.25).to_vec()).expect("enough rooms");
        assert!((0.45..0.55).contains(&factor), "{factor}");
        assert_eq!(length_factor(school.as_ref(), rooms(1.0)[..4].to_vec()), None);
        assert_eq!(length_factor(Typology::new("castle").as_ref(), rooms(1.0).to_vec()), None);
    }
}
