//! Whether one classification method beats another on the same rooms, beyond chance.

use serde::Serialize;

use crate::base::random::Random;

/// Two methods compared on the same rooms. Rooms of one building resemble each other, so chance is
/// assessed by building: both the interval and the p-value resample buildings, not rooms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    pub rooms: usize,
    pub buildings: usize,
    /// Share of rooms right by the first method, 0..=1.
    pub first: f64,
    /// Share of rooms right by the second.
    pub second: f64,
    /// First minus second.
    pub difference: f64,
    /// The 95 % interval of the difference: percentiles of a bootstrap over buildings (Efron 1979).
    pub low: f64,
    pub high: f64,
    /// Two-sided p-value of a paired permutation test that swaps the two methods building by building
    /// (Fisher 1935): how often a difference this large arises when there is none.
    pub p: f64,
}

/// Resamples of the bootstrap and of the permutation test: the p-value is accurate to about 0.002.
const RESAMPLES: usize = 10_000;

/// How right the two methods are in one building.
#[derive(Clone, Copy, Debug, Default)]
struct Building {
    rooms: f64,
    first: f64,
    second: f64,
}

impl Comparison {
    /// Compares two methods. For each room: its building, and how right each method is (0 wrong, 1 right,
    /// in between when several classifiers are averaged). `None` if there are no rooms.
    pub fn of<'a>(rooms: impl IntoIterator<Item = (&'a str, f64, f64)>, seed: u64) -> Option<Self> {
        let mut by_name: std::collections::BTreeMap<&str, Building> = Default::default();
        let mut count = 0;
        for (name, first, second) in rooms {
            let building = by_name.entry(name).or_default();
            building.rooms += 1.0;
            building.first += first;
            building.second += second;
            count += 1;
        }
        let buildings: Vec<Building> = by_name.into_values().collect();
        let all: f64 = buildings.iter().map(|building| building.rooms).sum();
        if count == 0 {
            return None;
        }
        let first = buildings.iter().map(|building| building.first).sum::<f64>() / all;
        let second = buildings.iter().map(|building| building.second).sum::<f64>() / all;
        let difference = first - second;
        let mut random = Random::new(seed);
        let mut resampled: Vec<f64> = (0..RESAMPLES)
            .map(|_| {
                let (mut gain, mut rooms) = (0.0, 0.0);
                for _ in 0..buildings.len() {
                    let building = buildings[random.below(buildings.len())];
                    gain += building.first - building.second;
                    rooms += building.rooms;
                }
                gain / rooms
            })
            .collect();
        resampled.sort_by(f64::total_cmp);
        let percentile = |share: f64| resampled[((RESAMPLES as f64 * share) as usize).min(RESAMPLES - 1)];
        // A tiny tolerance, so that summing in another order does not decide whether a difference is as
        // large.
        let as_large = (difference.abs() - 1e-12) * all;
        let flipped = (0..RESAMPLES)
            .filter(|_| {
                let sum: f64 = buildings
                    .iter()
                    .map(|building| {
                        let gain = building.first - building.second;
                        if random.bits() & 1 == 0 { gain } else { -gain }
                    })
                    .sum();
                sum.abs() >= as_large
            })
            .count();
        Some(Self {
            rooms: count,
            buildings: buildings.len(),
            first,
            second,
            difference,
            low: percentile(0.025),
            high: percentile(0.975),
            // One is added to both: the observed difference counts as a resample (Davison and Hinkley
            // 1997).
            p: (flipped + 1) as f64 / (RESAMPLES + 1) as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `buildings` of ten rooms, where the first method is right in `first` of ten and the second in
    /// `second`.
    fn compare(buildings: &[(usize, usize)]) -> Comparison {
        let names: Vec<String> = (0..buildings.len()).map(|index| format!("b{index}")).collect();
        let right = |room: usize, of_ten: usize| f64::from(u8::from(room < of_ten));
        let rooms = buildings.iter().enumerate().flat_map(|(index, &(first, second))| {
            let name = names[index].as_str();
            (0..10).map(move |room| (name, right(room, first), right(room, second)))
        });
        Comparison::of(rooms, 1).expect("rooms")
    }

    #[test]
    fn a_clear_difference_is_seen_and_none_is_not_made_up() {
        let clear = compare(&[(9, 5); 12]);
        assert!((clear.difference - 0.4).abs() < 1e-12 && clear.low > 0.39 && clear.high < 0.41, "{clear:?}");
        // 12 buildings all one way: 2 of 2^12 swaps are as large, 0.0005.
        assert!(clear.p < 0.002, "{clear:?}");
        let none = compare(&[(7, 5), (5, 7), (6, 6), (8, 6), (6, 8), (7, 7)]);
        assert!(none.difference.abs() < 1e-12 && none.low < 0.0 && none.high > 0.0 && none.p > 0.99, "{none:?}");
    }

    #[test]
    fn one_building_proves_nothing() {
        let one = compare(&[(10, 0)]);
        assert_eq!((one.difference, one.buildings), (1.0, 1));
        assert!(one.p > 0.9, "{one:?}");
        assert_eq!(Comparison::of([], 1), None);
    }

    #[test]
    fn the_interval_agrees_with_the_normal_one() {
        // Differences per building +2 and -0 of ten in turn: mean 0.1, standard error 0.1 / sqrt(40).
        let buildings: Vec<(usize, usize)> =
            (0..40).map(|index| if index % 2 == 0 { (7, 5) } else { (6, 6) }).collect();
        let comparison = compare(&buildings);
        let half = 1.96 * 0.1 / 40f64.sqrt();
        assert!((comparison.low - (0.1 - half)).abs() < 0.006, "{comparison:?}");
        assert!((comparison.high - (0.1 + half)).abs() < 0.006, "{comparison:?}");
    }
}
