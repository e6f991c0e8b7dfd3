//! Generated rooms whose labels overlap about as much as in real buildings, for tests that must run where
//! the real plans are not available.

use enfilade::base::random::Random;
use enfilade::dataset::Row;
use enfilade::features::Features;
use enfilade::labels::{Label, Typology};

/// For each label its share in percent, the median area in m², the factor by which areas spread around
/// it, the median axes ratio, and the mean number of openings. After Table 2 of the paper (schools).
const LABELS: [(usize, f64, f64, f64, f64); 5] = [
    (33, 14.0, 2.0, 1.7, 1.1),
    (34, 52.0, 1.5, 1.3, 1.5),
    (11, 95.0, 1.4, 1.5, 2.1),
    (14, 60.0, 2.2, 5.5, 5.7),
    (8, 130.0, 2.2, 1.9, 5.0),
];

/// Labelled rooms in plans of about forty; three plans make a building. The scale of a plan is off by up
/// to a third, as it is in real ones.
pub fn generated_rows(rooms: usize, seed: u64) -> Vec<Row> {
    let mut random = Random::new(seed);
    let mut rows: Vec<Row> = Vec::with_capacity(rooms);
    let mut scale = 1.0;
    for index in 0..rooms {
        let (plan, room) = (index / 40, index % 40);
        if room == 0 {
            scale = (0.6 * random.unit() - 0.3).exp();
        }
        let label = label(&mut random);
        let (_, area_m2, spread, axes_ratio, doors) = LABELS[label.index()];
        let doors = 1 + (2.0 * (doors - 1.0) * random.unit()).round() as u32;
        let mut doors_to = [0; 5];
        for _ in 0..doors {
            // Most doors of rooms lead to corridors; those of corridors to rooms. One in eight leads outside.
            let other = if label == Label::Corridor || random.unit() < 0.3 {
                self::label(&mut random)
            } else {
                Label::Corridor
            };
            if random.below(8) > 0 {
                doors_to[other.index()] += 1;
            }
        }
        let rounded = |value: f64| (value * 1e4).round() / 1e4;
        let features = Features {
            area_m2: rounded(area_m2 * scale * spread.powf(bell(&mut random))),
            axes_ratio: rounded(1.0 + (axes_ratio - 1.0) * 1.5f64.powf(bell(&mut random))),
            doors,
            doors_to,
        };
        rows.push(Row {
            plan: format!("School {}, floor {}", plan / 3 + 1, plan % 3),
            building: format!("School {}", plan / 3 + 1),
            typology: Typology::new("school"),
            room: format!("Room {}", room + 1),
            ..Row::new(label, features)
        });
    }
    rows
}

fn label(random: &mut Random) -> Label {
    let mut left = random.below(100);
    for label in Label::ALL {
        let share = LABELS[label.index()].0;
        if left < share {
            return label;
        }
        left -= share;
    }
    Label::Hall
}

/// Nearly normal, mean 0 and deviation 1: twelve uniform numbers summed.
fn bell(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}
