//! How far labels agree with each other: a bound on what any classifier can reach that sees what the drawing shows.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::classify::Distribution;
use crate::dataset::Row;
use crate::dataset::folds::building_of;
use crate::labels::normalised_function;

/// Functions whose names state a size that the drawings contradict: rooms of the same size and shape in the same building bear
/// another label as often as not.
pub const CONTRADICTED: [&str; 3] = ["MEDIUM SERVICE", "LAB", "SHARED OFFICE"];

/// Functions to which the authors' own vocabularies give no size: their labels are Enfilade's.
pub const WITHOUT_SIZE: [&str; 4] = ["ENTRANCE", "STAIRS", "ELEVATOR", "WASHROOM"];

/// Rooms are alike if the logarithms of their areas, and of their axes ratios, differ by at most this (10 %), and they have as
/// many openings.
const ALIKE: f64 = 0.1;

/// The labels of a set, and what the best classifier makes of them.
#[derive(Clone, Debug, Serialize)]
pub struct Noise {
    pub set: String,
    pub rooms: usize,
    /// Share of rooms with one alike in the same building that has another label.
    pub contradicted: f64,
    /// Share of rooms that would be right if all rooms alike in a building got the label most of them have.
    pub ceiling: f64,
    /// Share of rooms that the blend labels correctly: of all, and of those whose functions are not [`CONTRADICTED`].
    pub accuracy: f64,
    pub accuracy_clear: f64,
    pub rooms_clear: usize,
    /// The same of those whose functions are [`WITHOUT_SIZE`]; `None` if there are none.
    pub accuracy_without_size: Option<f64>,
    pub rooms_without_size: usize,
}

impl Noise {
    /// Of some rooms, each with what was said of it out of fold. `None` without rooms.
    pub fn of(set: &str, rooms: &[(&Row, Distribution)]) -> Option<Self> {
        if rooms.is_empty() {
            return None;
        }
        let mut buildings: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
        for (row, _) in rooms {
            buildings.entry(building_of(row)).or_default().push(row);
        }
        let (mut contradicted, mut agree) = (0.0, 0.0);
        for row in buildings.values().flat_map(|of| of.iter().map(move |row| (row, of))) {
            let (row, of) = row;
            let mut counts = [0.0; 5];
            for other in of.iter().filter(|other| is_alike(row, other)) {
                counts[other.label.index()] += 1.0;
            }
            let all: f64 = counts.iter().sum();
            contradicted += f64::from(u8::from(counts[row.label.index()] < all));
            agree += counts.iter().copied().fold(0.0, f64::max) / all;
        }
        let count = rooms.len() as f64;
        let names = |list: &[&str], row: &Row| {
            let function = normalised_function(&row.function);
            list.iter().any(|name| normalised_function(name) == function)
        };
        let accuracy = |keep: &dyn Fn(&Row) -> bool| {
            let kept: Vec<bool> =
                rooms.iter().filter(|(row, _)| keep(row)).map(|(row, said)| said.label() == row.label).collect();
            let right = kept.iter().filter(|&&right| right).count();
            (kept.len(), (!kept.is_empty()).then(|| right as f64 / kept.len() as f64))
        };
        let (_, all) = accuracy(&|_| true);
        let (rooms_clear, clear) = accuracy(&|row| !names(&CONTRADICTED, row));
        let (rooms_without_size, accuracy_without_size) = accuracy(&|row| names(&WITHOUT_SIZE, row));
        Some(Self {
            set: set.to_owned(),
            rooms: rooms.len(),
            contradicted: contradicted / count,
            ceiling: agree / count,
            accuracy: all?,
            accuracy_clear: clear.unwrap_or_default(),
            rooms_clear,
            accuracy_without_size,
            rooms_without_size,
        })
    }
}

/// Whether two rooms are about the same size and form, see [`ALIKE`].
pub(super) fn is_alike(p: &Row, q: &Row) -> bool {
    let near = |p: f64, q: f64| (p.max(1e-9).ln() - q.max(1e-9).ln()).abs() <= ALIKE;
    let (p, q) = (&p.features, &q.features);
    p.doors == q.doors && near(p.area_m2, q.area_m2) && near(p.axes_ratio, q.axes_ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::features::Features;
    use crate::labels::Label;

    #[test]
    fn rooms_alike_with_two_labels_bound_what_can_be_right() {
        let room = |label: Label, area_m2: f64, function: &str| Row {
            building: "one".to_owned(),
            function: function.to_owned(),
            ..Row::new(label, Features { area_m2, axes_ratio: 1.0, doors: 1, doors_to: [0; 5] })
        };
        let rows = [
            room(Label::MediumRoom, 20.0, "CLASSROOM"),
            room(Label::MediumRoom, 20.5, "CLASSROOM"),
            room(Label::BigRoom, 20.2, "LAB"),
            room(Label::SmallRoom, 5.0, "WASHROOM"),
        ];
        let medium = Distribution::from_weights([0.0, 1.0, 0.0, 0.0, 0.0]);
        let noise = Noise::of("school", &rows.iter().map(|row| (row, medium)).collect::<Vec<_>>()).unwrap();
        assert_eq!((noise.rooms, noise.contradicted, noise.ceiling), (4, 0.75, 0.75));
        assert_eq!((noise.accuracy, noise.rooms_clear), (0.5, 3));
        assert_eq!((noise.accuracy_without_size, noise.rooms_without_size), (Some(0.0), 1));
    }
}
