//! Readable numbers: thresholds with few digits, features in words.

use crate::dataset::table::FEATURES;

/// The number with the fewest decimals in `low..high`, nearest to the middle: a threshold between 12.331
/// and 12.452 becomes 12.4, and one between 2 and 3 openings becomes 2.
pub(super) fn readable_between(low: f64, high: f64) -> f64 {
    let middle = low + (high - low) / 2.0;
    // Beyond nine decimals of a square metre the two ends differ only by rounding.
    for decimals in 0..9 {
        let unit = 10f64.powi(-decimals);
        for step in [(middle / unit).round(), (middle / unit).floor()] {
            // Dividing by the inverse keeps 12.4 from becoming 12.400000000000002.
            let number = step / 10f64.powi(decimals);
            if low <= number && number < high {
                return number;
            }
        }
    }
    low
}

/// What each count of `F_r` is called, from the third feature on.
const COUNTS: [&str; FEATURES - 2] = [
    "openings",
    "openings to small rooms",
    "openings to medium rooms",
    "openings to big rooms",
    "openings to corridors",
    "openings to halls",
];

/// A count of openings: `no openings to halls`, `1 opening`, `3 openings`. Other features are counted as openings.
pub(super) fn count_in_words(feature: usize, count: f64) -> String {
    let name = feature.checked_sub(2).and_then(|count| COUNTS.get(count)).unwrap_or(&COUNTS[0]);
    if count == 0.0 {
        format!("no {name}")
    } else if count == 1.0 {
        format!("1 {}", name.replacen("openings", "opening", 1))
    } else {
        format!("{count} {name}")
    }
}

/// Proportions: `1.9 times as long as wide`, `as long as wide`.
pub(super) fn times(ratio: f64) -> String {
    match rounded(ratio) {
        one if one == "1" => "as long as wide".to_owned(),
        times => format!("{times} times as long as wide"),
    }
}

/// At most two decimals, fewer for large numbers, without trailing zeros.
pub(super) fn rounded(value: f64) -> String {
    let unit = if value.abs() >= 100.0 {
        1.0
    } else if value.abs() >= 10.0 {
        10.0
    } else {
        100.0
    };
    ((value * unit).round() / unit).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_have_few_digits() {
        for (low, high, expected) in [
            (2.0, 3.0, 2.0),
            (12.331, 12.452, 12.4),
            (0.0, 1.0, 0.0),
            (9.9, 10.2, 10.0),
            (1.234_567, 1.234_568, 1.234_567),
            (99.0, 151.0, 125.0),
        ] {
            let threshold = readable_between(low, high);
            assert!(low <= threshold && threshold < high);
            assert_eq!(threshold, expected);
        }
        // Between neighbouring floating-point numbers only the lower one remains.
        assert_eq!(readable_between(1.0, 1.0 + f64::EPSILON), 1.0);
    }

    #[test]
    fn values_are_short() {
        assert_eq!([12.4499, 1234.5, 1.9, 3.0].map(rounded), ["12.4", "1235", "1.9", "3"]);
        assert_eq!(
            [0.0, 1.0, 3.0].map(|count| count_in_words(7, count)),
            ["no openings to halls", "1 opening to halls", "3 openings to halls"]
        );
        assert_eq!([1.0, 1.9].map(times), ["as long as wide", "1.9 times as long as wide"]);
    }
}
